//! A bearing in a flexible housing (2.2.4), in three ways.
//!
//! Plain: [`exchange`] takes bodies with their bearings and any number of solids through explicit steps of
//! their own; they exchange impulses through [`seat`]s.
//!
//! Cheap, for linear housings and slow loads: the housing is condensed onto the radial motion of its
//! bore, contact is solved there, and bearing and bore share one equilibrium. What that takes for
//! granted, against the nonlinear solid with contact: strains so small that the solid is linear,
//! and motions so small beside the bore's radius that a node keeps its normal
//! ([`condensed::geometry_error`] measures that). No inertia: [`inertia`] has the frequencies that its part follows from.
//!
//! With inertia, for linear housings: [`reduce`] makes of the housing some shapes that move with the bodies of the bearing
//! (`solver::dynamics`), from [`reduced_start`] on. What a condensed housing takes for granted it takes too.
pub mod bonded;
pub mod bonded_state;
pub mod bore_equilibrium;
pub mod checkpoint;
pub mod condensed;
pub mod course;
pub mod course_search;
pub mod exchange;
mod exchange_start;
mod exchange_window;
pub mod held_motions;
pub mod inertia;
pub mod presses;
pub mod reduce;
pub mod reduced_start;
pub mod seat;
pub mod seat_friction;
pub mod stepped;
pub mod stepped_shaft;
pub mod true_distances;
