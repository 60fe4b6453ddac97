//! A cube of steel in explicit steps.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::mesh::tet_mesh::TetMesh;
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{DampedMotion, SolidModel, SolidProblem};

/// It moves from a slight shear and twist on.
pub fn solid(mesh: &TetMesh) -> ExplicitSolid {
    let start = mesh.nodes.iter().map(|x| [1e-6 * x[1], 2e-7 * x[0] * x[2], 0.0]).collect();
    let rest = vec![[0.0; 3]; mesh.nodes.len()];
    let problem = SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material: LinearElastic::new(2.1e11, 0.3).expect("steel"),
        density: 7800.0,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    let model = SolidModel::new(problem).expect("a sound mesh");
    let stepping = SolidStepping::FractionOfLimit(0.5);
    ExplicitSolid::new(model, ExplicitMethod::CentralDifferences, stepping, start, rest)
        .expect("a stable step")
}
