//! Four-node tetrahedron with node-averaged volume, which does not lock.
//!
//! The volume ratio of a node is the mean of those of the adjacent elements, weighted by a quarter of their volumes.
//! The resulting mean stress (U′ at the node) acts on every adjacent element, a quarter from each corner. Nodal forces
//! are the derivative of Σ V W(E) over elements plus Σ V U(J̄) over nodes, so that momentum, angular momentum and
//! energy are conserved as for the plain element ([`crate::elements::tet4`]), whose mean stress follows from its own
//! volume.

use super::tet4::Tet4;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{
    Mat3, Sym3, cofactor, deformation_gradient, first_piola_kirchhoff, volume_change,
};

/// Contribution of an element to the volume change around each of its nodes: V(J − 1)/4, m³. The sum over the elements
/// of a node, divided by the sum of their V/4, is J̄ − 1.
#[inline(always)]
pub fn volume_change_at_nodes<T: Number>(tet: &Tet4<T>, h: &Mat3<T>) -> T {
    T::of(0.25) * tet.volume * volume_change(h)
}

/// Forces on the first three nodes, N, from the second Piola–Kirchhoff stress without its volumetric part and the mean
/// Cauchy stress, Pa: −V P ∂N/∂X with P = F S + p cof F. The fourth takes minus their sum.
#[inline(always)]
pub fn nodal_forces<T: Number>(
    tet: &Tet4<T>,
    h: &Mat3<T>,
    stress: &Sym3<T>,
    mean_stress: T,
) -> [[T; 3]; 3] {
    let mut p = first_piola_kirchhoff(h, stress);
    let volume = cofactor(&deformation_gradient(h));
    for i in 0..3 {
        for j in 0..3 {
            p[i][j] = -tet.volume * (p[i][j] + mean_stress * volume[i][j]);
        }
    }
    tet.along_gradients(&p)
}
