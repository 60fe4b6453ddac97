//! Strain energy of a solid.

use crate::elements::tet4::relative;
use crate::elements::tet10::POINTS;
use crate::kinematics::strain::green_lagrange;
use crate::solids::model::{Blocks, SolidModel};
use crate::solids::tet4_blocks::Node;
use crate::solids::{tet4_blocks, tet10_blocks};

/// J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolidEnergy {
    pub strain: f64,
    pub kinetic: f64,
}

/// Stored energy, and work since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolidLedger {
    pub energy: SolidEnergy,
    /// Work of loads and drives.
    pub external_work: f64,
    /// ≤ 0 unless damping moves the body.
    pub damping_work: f64,
}

impl SolidLedger {
    /// Stored energy less all work: constant if the balance holds.
    pub fn balance(&self) -> f64 {
        let SolidEnergy { strain, kinetic } = self.energy;
        strain + kinetic - self.external_work - self.damping_work
    }
}

/// ∫W dV for these displacements, J.
pub fn strain_energy(model: &SolidModel, displacement: &[Node]) -> f64 {
    let law = model.problem.material;
    let count = model.problem.elements.len();
    let vector = |node: u32| {
        let u = displacement[node as usize];
        [u[0], u[1], u[2]]
    };
    match &model.blocks {
        Blocks::Linear(blocks) => tet4_blocks::elements(blocks)
            .take(count)
            .map(|(tet, nodes)| {
                let h = tet.displacement_gradient(&relative(&nodes.map(vector)));
                tet.volume * law.energy_density(&green_lagrange(&h))
            })
            .sum(),
        Blocks::Quadratic(blocks) => tet10_blocks::elements(blocks)
            .take(count)
            .map(|(tet, nodes)| {
                let moved = nodes.map(vector);
                let of = |point: usize| {
                    let h = tet.displacement_gradient(point, &moved);
                    tet.points[point].volume * law.energy_density(&green_lagrange(&h))
                };
                (0..POINTS).map(of).sum::<f64>()
            })
            .sum(),
    }
}
