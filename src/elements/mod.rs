//! Tetrahedral elements: nodal forces and masses from a stress function, independent of material and mesh.
//!
//! Total Lagrangian: gradients of the shape functions are computed once in the undeformed state.
pub mod tet10;
pub mod tet10_nodal;
pub mod tet4;
pub mod tet4_nodal;

use thiserror::Error;

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ElementError {
    #[error(
        "its volume is {volume:.3e} m3; it must be positive: its nodes are in the wrong order or \
         in one plane"
    )]
    Volume { volume: f64 },
    #[error(
        "its Jacobian determinant at quadrature point {point} is {determinant:.3e}; it must be \
         positive: the element is folded"
    )]
    Folded { point: usize, determinant: f64 },
}
