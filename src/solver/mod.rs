//! What computes: equilibria, motions, solids.
//!
//! - [`statics`] and the `static_*` files: one search for equilibria of any bodies, bearings, springs, seats and shafts; [`ball`] and [`ball_on_race`]
//!   eliminate each ball.
//! - [`dynamics`]: bodies, bearings, reduced solids in motion, one state and one step.
//! - [`solid`]: flexible solids by themselves (explicit steps, equilibrium, modes); [`sparse`] their factors.
//! - [`housing`]: bearings in flexible solids: exchange with explicit ones, condensed bores, reduction to shapes.
//! - [`rotor`]: a flexible shaft as a beam.
//! - [`ledger_watch`]: whether energy adds up.
//! - [`plan`]: what is done and what is left out; [`clock`] and [`profile`]: time; [`channels`]: what is recorded.
pub mod ball;
pub mod ball_on_race;
mod ball_start;
pub mod channels;
pub mod clock;
pub mod dense;
pub mod dent_table;
pub mod dynamics;
pub mod free_shapes;
pub mod half_space;
pub mod housing;
pub mod ledger_watch;
pub mod mount;
pub mod plan;
pub mod profile;
pub mod race_position;
pub mod rotor;
pub mod shaft_shapes;
pub mod solid;
pub mod sparse;
pub mod static_assembly;
mod static_bearing;
mod static_connection;
mod static_error;
mod static_model;
mod static_search;
pub mod static_seat;
pub mod static_shaft;
mod static_start;
pub mod static_tables;
mod static_verdict;
pub mod statics;
pub mod vibrations;
