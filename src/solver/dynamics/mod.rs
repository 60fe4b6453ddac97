//! The bearing in motion: every part a rigid body with six degrees of freedom (2.2.1, 4.2.1).
//!
//! `assembly` says what is simulated (a bearing alone is written as a `model`), `state` where it lies, `contacts`
//! (with `contact_traction`) and `race` turn states into loads, `seat` and `reduced_solid` those of bodies in flexible solids, each bearing's `ball_set` into loads on its bodies, `system` into rates, `energy` into energies, which `balance` holds against what has come and gone; `rk4`, `dormand_prince` and `rosenbrock`
//! integrate (the last through `linearised` contacts, the `arrow` matrix, each ball's `orbit_frame` and each body's `turning_frame`),
//! `held` says whether anything holds a bearing against its loads, `bounds` where a state has lost its meaning,
//! `control` chooses steps for an accuracy, `extremes` remembers the largest loads, `run` takes a simulation from step to step,
//! `clocked` up to what is due next, `foretell` for a while. `equilibrium` says where all stand still, under loads that `following`
//! takes along.
pub mod arrow;
mod arrow_solids;
mod arrow_terms;
pub mod assembly;
pub mod balance;
pub mod ball_set;
mod body_rates;
pub mod bounds;
pub mod checkpoint;
pub mod clocked;
pub mod connection;
mod contact_traction;
pub mod contacts;
pub mod control;
pub mod dents;
pub mod dormand_prince;
pub mod elimination;
pub mod energy;
pub mod equilibrium;
pub mod extremes;
pub mod failure;
mod following;
pub mod foretell;
pub mod held;
pub mod linearised;
mod linearised_contacts;
mod linearised_shafts;
pub mod model;
pub mod orbit_frame;
pub mod quasi_static;
pub mod race;
pub mod reduced_solid;
pub mod rk4;
pub mod rosenbrock;
pub mod run;
pub mod seat;
pub mod sensor;
pub mod shaft;
pub mod shaft_holds;
pub mod stability;
pub mod start;
pub mod state;
mod static_sections;
pub mod step_watch;
pub mod system;
pub mod turning_frame;
pub mod unbalance;
