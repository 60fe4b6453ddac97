//! The bearing in motion: every part a rigid body with six degrees of freedom (2.2.1, 4.2.1).
//!
//! `model` says what is simulated, `state` where it lies, `contacts` and `race` turn states into
//! loads, `system` into rates, `energy` into energies; `rk4` integrates, `run` drives a simulation
//! from start to end.
pub mod checkpoint;
pub mod contacts;
pub mod energy;
pub mod equilibrium;
pub mod model;
pub mod race;
pub mod rk4;
pub mod run;
pub mod split;
pub mod stability;
pub mod start;
pub mod state;
pub mod step_watch;
pub mod system;
