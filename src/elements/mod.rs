//! Tetrahedra: forces and masses of elements from a stress function; no material, no mesh.
//!
//! Everything refers to the undeformed state (total Lagrangian): gradients of the shape functions
//! are taken once.
pub mod tet10;
pub mod tet10_nodal;
pub mod tet4;
pub mod tet4_nodal;

use thiserror::Error;

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ElementError {
    #[error(
        "its volume is {volume:.3e} m3, not positive: its nodes are in the wrong order or flat"
    )]
    Volume { volume: f64 },
    #[error(
        "at quadrature point {point} its map has the determinant {determinant:.3e}: it is folded"
    )]
    Folded { point: usize, determinant: f64 },
}
