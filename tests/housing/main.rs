//! Laws of bearings in flexible housings.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/dynamics.rs"]
mod dynamics;
#[path = "../../verification/src/housed.rs"]
mod housed;
#[path = "../housing_common/mod.rs"]
mod housing_common;

mod bonded_bushings;
mod bore_friction;
mod bore_friction_law;
mod bore_friction_ring;
mod exchange_reach;
mod housing_assembly;
mod housing_bore;
mod housing_courses;
mod housing_exchange;
mod housing_nonlinear;
mod housing_reduced;
mod housing_seats;
mod housing_threads;
mod modes_in_housings;
mod reduced_laws;
mod reduced_presses;
mod reduced_steps;
mod several_housings;
mod small_laws;
