//! Strain energy of a solid.

use super::model::{SolidModel, corners};
use super::tet4_blocks::Node;
use crate::elements::tet4::{Tet4, relative};
use crate::elements::tet10::{POINTS, Tet10};
use crate::kinematics::strain::green_lagrange;
use crate::mesh::tet_mesh::Elements;

/// J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolidEnergy {
    pub strain: f64,
    pub kinetic: f64,
}

/// Energy held, and work done since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolidLedger {
    pub energy: SolidEnergy,
    /// Of loads and of drives.
    pub external_work: f64,
    /// ≤ 0 but for a body that damping carries along.
    pub damping_work: f64,
}

impl SolidLedger {
    /// Energy held less all work done: what it was at the start, if all is accounted for.
    pub fn balance(&self) -> f64 {
        let SolidEnergy { strain, kinetic } = self.energy;
        strain + kinetic - self.external_work - self.damping_work
    }
}

/// ∫W dV from the displacements, J.
pub fn strain_energy(model: &SolidModel, displacement: &[Node]) -> f64 {
    let problem = &model.problem;
    let vector = |node: u32| {
        let u = displacement[node as usize];
        [u[0], u[1], u[2]]
    };
    let sound = "elements were checked when the model was made";
    match &problem.elements {
        Elements::Linear(list) => list
            .iter()
            .map(|element| {
                let tet = Tet4::new(&corners(&problem.nodes, element)).expect(sound);
                let h = tet.displacement_gradient(&relative(&element.map(vector)));
                tet.volume * problem.material.energy_density(&green_lagrange(&h))
            })
            .sum(),
        Elements::Quadratic(list) => list
            .iter()
            .map(|element| {
                let tet = Tet10::new(&corners(&problem.nodes, element)).expect(sound);
                let moved = element.map(vector);
                (0..POINTS)
                    .map(|point| {
                        let h = tet.displacement_gradient(point, &moved);
                        tet.points[point].volume
                            * problem.material.energy_density(&green_lagrange(&h))
                    })
                    .sum::<f64>()
            })
            .sum(),
    }
}
