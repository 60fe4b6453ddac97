//! Rubber and bonded bushings for cases: inputs as the source states them, and quarter models.

use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::ch2_housing::elastomer::{Elastomer, ElastomerError};
use bearing_dynamics::mesh::generate::{Bushing, BushingMesh, Part, bushing};
use bearing_dynamics::mesh::{Elements, TetMesh};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::model::Prescribed;
use bearing_dynamics::solver::solid::rubber::explicit::RubberBody;
use bearing_dynamics::solver::solid::rubber::model::{RubberModel, RubberProblem, supports};
use bearing_dynamics::solver::solid::rubber::tet_forces::MeanStress;

use crate::case::CaseError;

/// γ and τ (s) of Table 3.1.
pub const MAXWELL: [[f64; 2]; 14] = [
    [0.492, 10.0],
    [0.687, 2.42],
    [1.153, 0.59],
    [1.286, 0.14],
    [1.804, 0.0346],
    [1.944, 0.0084],
    [2.116, 0.002],
    [2.304, 4.92e-4],
    [2.485, 1.19e-4],
    [2.764, 2.89e-5],
    [2.798, 7.02e-6],
    [3.704, 1.7e-6],
    [1.912, 4.12e-7],
    [8.226, 1e-7],
];

/// N and B/C_R of Tables 2.3 and 3.1.
pub const LOCKING: f64 = 8.0;
pub const BULK_RATIO: f64 = 100.0;

/// kg/m³: the source states none.
pub const DENSITY: f64 = 1100.0;

/// With C_R in Pa, and every γ times a factor; 0 is the network alone.
pub fn rubber(modulus: f64, gammas: f64, pull: ChainPull) -> Result<Elastomer, ElastomerError> {
    let network = EightChain::new(modulus, LOCKING, BULK_RATIO * modulus, pull)?;
    let all = MAXWELL.iter().filter(|_| gammas > 0.0);
    let maxwell =
        all.map(|[gamma, tau]| Maxwell::new(gammas * gamma, *tau)).collect::<Result<_, _>>()?;
    Ok(Elastomer { network, maxwell })
}

/// 1 + Σ γ iωτ/(1 + iωτ), written for oracles.
pub fn complex_factor(gammas: f64, frequency: f64) -> nalgebra::Complex<f64> {
    let one = nalgebra::Complex::new(1.0, 0.0);
    MAXWELL.iter().fold(one, |sum, [gamma, tau]| {
        let x = nalgebra::Complex::new(0.0, std::f64::consts::TAU * frequency * tau);
        sum + x / (one + x) * (gammas * gamma)
    })
}

/// Shear modulus over C_R at N = 8: the slope of (2.8) at rest, twice.
pub fn shear_over_modulus() -> f64 {
    let x = 3.0 / LOCKING;
    let sum: f64 = [1.0 / 2.0, 1.0 / 10.0, 33.0 / 1050.0, 76.0 / 7000.0, 2595.0 / 673_750.0]
        .iter()
        .enumerate()
        .map(|(k, c)| c * x.powi(k as i32))
        .sum();
    2.0 * sum
}

/// A quarter of a bushing in `cells` around, across the wall and along half of the length.
pub fn quarter(body: &Bushing, cells: [usize; 3], grading: f64) -> Result<TetMesh, CaseError> {
    let [around, radial, axial] = cells;
    let mesh = BushingMesh { around, radial, axial, grading, part: Part::Quarter };
    Ok(bushing(body, &mesh)?.quadratic()?.mesh)
}

/// The quarter with its outer face held and its inner one moved along Z; and the nodes of that one. Forces
/// on them count four times.
pub fn bonded(
    mesh: &TetMesh,
    material: Elastomer,
    moved: Profile,
) -> Result<(RubberModel, Vec<u32>), CaseError> {
    let prescribed = held(mesh, moved);
    let Elements::Quadratic(elements) = mesh.elements.clone() else {
        return Err(CaseError::message("elements of ten nodes are needed"));
    };
    let nodes = mesh.nodes.clone();
    let problem = RubberProblem { nodes, elements, material, prescribed, loads: Vec::new() };
    Ok((RubberModel::new(problem)?, mesh.node_sets["inner"].clone()))
}

/// The same quarter in four-node elements, for explicit steps of rubber of 1100 kg/m³; and the nodes that move.
pub fn bonded_tets(
    body: &Bushing,
    cells: [usize; 3],
    grading: f64,
    material: Elastomer,
    mean_stress: MeanStress,
    moved: Profile,
) -> Result<(RubberBody, Vec<u32>), CaseError> {
    let [around, radial, axial] = cells;
    let mesh = BushingMesh { around, radial, axial, grading, part: Part::Quarter };
    let mesh = bushing(body, &mesh)?.mesh;
    let Elements::Linear(elements) = mesh.elements.clone() else {
        return Err(CaseError::message("elements of four nodes are needed"));
    };
    let rubber = RubberBody {
        nodes: mesh.nodes.clone(),
        elements,
        material,
        density: DENSITY,
        mean_stress,
        mass_scale: 1.0,
        prescribed: held(&mesh, moved),
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    Ok((rubber, mesh.node_sets["inner"].clone()))
}

fn held(mesh: &TetMesh, moved: Profile) -> Vec<Prescribed> {
    const HELD: Option<Profile> = Some(Profile::ZERO);
    supports(
        mesh,
        &[
            ("outer", [HELD; 3]),
            ("inner", [HELD, HELD, Some(moved)]),
            ("x_low", [HELD, None, None]),
            ("y_low", [None, HELD, None]),
        ],
    )
}
