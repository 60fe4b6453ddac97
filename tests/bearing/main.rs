//! Laws of bearings at rest and in motion.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/dynamics.rs"]
mod dynamics;

mod bending;
mod bent_at_rest;
mod bent_shafts;
mod clock_laws;
mod connected_bodies;
mod connections;
mod dents;
mod dynamics_balls;
mod dynamics_cage;
mod dynamics_contacts;
mod dynamics_integrators;
mod dynamics_laws;
mod dynamics_leaving;
mod dynamics_ledger;
mod dynamics_linearised;
mod dynamics_motion;
mod dynamics_plan;
mod dynamics_settling;
mod dynamics_stability;
mod dynamics_starts;
mod dynamics_step_limit;
mod dynamics_traction;
mod explicit_cage;
mod flexible_cage;
mod formulas;
mod free_balls;
mod geometry_laws;
mod plan_and_step;
mod profile_laws;
mod raceway_profiles;
mod rating_life;
mod relaxing;
mod rolling_starts;
mod sensors;
mod shaft_stiffness;
mod shafts;
mod small_laws;
mod statics_edges;
mod statics_laws;
mod telemeter_laws;
mod torque_and_unbalance;
mod turning_frames;
mod work_counts;
