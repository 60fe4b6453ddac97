//! Small vibrations of an assembly about its equilibrium: modes, whirl, critical speeds.

pub mod critical_speeds;
pub mod relaxing;
pub mod rotor;
pub mod small_motions;
pub mod whirl;
