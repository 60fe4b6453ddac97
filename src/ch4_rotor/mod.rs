//! Chapter 4: the flexible rotor. Laws of the shaft as a beam and of what sits on it.
pub mod beam;
pub mod disc;
pub mod section;
