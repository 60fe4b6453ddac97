//! Trustworthy dynamic simulation of rolling bearings on flexible supports.
//!
//! One module per chapter of the source dissertation; chapters are pure laws on plain data.
//! Imports run one way only:
//! `kinematics, mesh, elements <- ch2 <- ch3 <- ch4 <- ch5 <- solver <- scene, output <- main`.
//! `docs/theory.md` maps every equation to its item here and to its verification case.
#![forbid(unsafe_code)]
// Indices are the notation of components, as in the equations.
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
pub mod scene;
pub mod solids;
pub mod vibrations;
