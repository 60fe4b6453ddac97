//! Laws of flexible rotors.

mod beam;
mod whirl;
