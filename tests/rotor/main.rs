//! Laws of flexible rotors.

mod beam;
