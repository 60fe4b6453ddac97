//! Chapter 4: the flexible rotor. Laws of the shaft as a beam and of what sits on it, and friction of outer races in
//! their bores.
pub mod beam;
pub mod bore_friction;
pub mod disc;
pub mod section;
