//! The four-node tetrahedron with the mean stress apart from the rest of the stress: where its volume is
//! averaged around nodes, it does not lock.
//!
//! The volume ratio of a node is the mean of those of the elements around it, weighted by a quarter of their
//! volumes; the mean stress that follows from it (U′ at the node) acts on every element there, a quarter from each
//! corner. Nodal forces are the derivative of Σ V W(E) over elements plus Σ V U(J̄) over nodes, so that momentum,
//! angular momentum and energy hold as they do for the plain element, whose mean stress is that of its own
//! volume ([`crate::elements::tet4`]). One more pass over the elements is all that it costs.

use super::tet4::Tet4;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{
    Mat3, Sym3, cofactor, deformation_gradient, first_piola_kirchhoff, volume_change,
};

/// What an element adds to the change of volume around each of its nodes: V(J − 1)/4, m³. Summed over the
/// elements of a node and divided by the sum of their V/4 it is J̄ − 1.
#[inline(always)]
pub fn volume_change_at_nodes<T: Number>(tet: &Tet4<T>, h: &Mat3<T>) -> T {
    T::of(0.25) * tet.volume * volume_change(h)
}

/// Forces on the first three nodes, N, from the second Piola–Kirchhoff stress without the part of volume and the
/// mean Cauchy stress, Pa: −V P ∂N/∂X with P = F S + p cof F. The fourth takes minus their sum.
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
