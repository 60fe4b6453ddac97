//! Chapter 4: the flexible rotor. Shaft beams, discs and rotor sections, and friction of outer races in their bores.
pub mod beam;
pub mod bore_friction;
pub mod disc;
pub mod section;
