//! Simulation of ball bearings, rigid or on flexible supports: housings, rubber bushings, shafts.
//!
//! The chapters contain the equations of the dissertation as functions on plain data. The solver works on one assembly:
//! lists of bodies, connections, loads and sensors. Imports have one direction: `kinematics, mesh, elements <-
//! ch2_housing <- ch3_bushing <- ch4_rotor <- ch5_cage <- numeric <- plan <- solids <- members <- assembly <-
//! equilibrium <- reduction <- motion <- vibrations <- scene <- output`. `docs/theory.md` lists the location of every equation and its verification case.
#![forbid(unsafe_code)]
// Indices denote components, as in the equations.
#![allow(clippy::needless_range_loop)]

pub mod assembly;
pub mod ch2_housing;
pub mod ch3_bushing;
pub mod ch4_rotor;
pub mod ch5_cage;
pub mod elements;
pub mod equilibrium;
pub mod kinematics;
pub mod members;
pub mod mesh;
pub mod motion;
pub mod numeric;
pub mod output;
pub mod plan;
pub mod reduction;
pub mod scene;
pub mod solids;
pub mod vibrations;
