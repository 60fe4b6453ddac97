//! Benchmarks of the source, each judged against something that is not this program.
//!
//! A [`case::Case`] computes numbers and states checks; it never sees a published number. Only
//! when it has finished does [`judge`] open the case's `published.toml` and compare. The report
//! shows every number beside its reference, error, tolerance and the tolerance's reason.
//!
//! `verification/README.md` tells how a case is written and how the report is read.
#![forbid(unsafe_code)]
// Indices are the notation of components, as in the equations.
#![allow(clippy::needless_range_loop)]

pub mod bearings;
pub mod bushings;
pub mod cache;
pub mod cage_bearing;
pub mod case;
pub mod cases;
pub mod check;
pub mod contact_picture;
pub mod context;
pub mod date;
pub mod golden;
pub mod housed;
pub mod housed_shaft;
pub mod housing_turn;
pub mod housings;
pub mod index;
pub mod judge;
pub mod machine;
pub mod motion;
pub mod mutants;
mod number;
pub mod oracles;
pub mod outside;
pub mod page;
pub mod pareto;
pub mod pressed_block;
pub mod published;
pub mod readme;
pub mod report;
pub mod rotor_run_up;
pub mod runner;
pub mod single_shaft;
pub mod solid_bodies;
pub mod solids;
pub mod sources;
pub mod studies;
pub mod surface_picture;
