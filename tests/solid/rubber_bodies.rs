//! Cubes and bushings of rubber for tests.

use bearing_dynamics::ch2_housing::elastomer::Elastomer;
use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::mesh::generate::{Bushing, BushingMesh, Part, bar, bushing};
use bearing_dynamics::mesh::{Elements, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::model::{RubberModel, RubberProblem, supports};
use bearing_dynamics::solids::rubber::steps::{StepOptions, Stepping};

pub const HELD: Option<Profile> = Some(Profile::ZERO);

/// Numbers without pattern in (−1, 1).
pub fn scatter(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

pub fn network(bulk: f64) -> EightChain {
    EightChain::new(0.647e6, 8.0, bulk, ChainPull::FiveTerms).unwrap()
}

pub fn quadratic(mesh: &TetMesh) -> Vec<[u32; 10]> {
    let Elements::Quadratic(list) = &mesh.elements else { panic!("of ten nodes") };
    list.clone()
}

/// A cube of 12 mm with corners inside shaken.
pub fn cube(cells: usize) -> TetMesh {
    let side = 0.012;
    let mut solid = bar([side; 3], [cells; 3]).unwrap();
    let mut seed = 9;
    for place in &mut solid.mesh.nodes {
        place[1] += 0.5 * side;
        place[2] += 0.5 * side;
        let inside = place.iter().all(|x| *x > 1e-9 && *x < side - 1e-9);
        for x in place.iter_mut() {
            let by = 0.2 * side / cells as f64 * scatter(&mut seed);
            *x += if inside { by } else { 0.0 };
        }
    }
    // Sets were named on the planes as they were; shifted, they are still right.
    solid.quadratic().unwrap().mesh
}

pub fn rubber_of(network: EightChain, maxwell: &[Maxwell]) -> Elastomer {
    Elastomer { network, maxwell: maxwell.to_vec() }
}

/// Stretched along X by a profile, free at the sides, an eighth of a body.
pub fn pulled_cube(material: Elastomer, profile: Profile, cells: usize) -> RubberModel {
    let mesh = cube(cells);
    let prescribed = supports(
        &mesh,
        &[
            ("x_low", [HELD, None, None]),
            ("y_low", [None, HELD, None]),
            ("z_low", [None, None, HELD]),
            ("x_high", [Some(profile), None, None]),
        ],
    );
    let (elements, nodes) = (quadratic(&mesh), mesh.nodes);
    let loads = Vec::new();
    RubberModel::new(RubberProblem { nodes, elements, material, prescribed, loads }).unwrap()
}

pub fn fixed(step: f64) -> StepOptions {
    StepOptions { stepping: Stepping::Fixed(step), ..Default::default() }
}

pub const BUSHING: Bushing = Bushing { inner_diameter: 0.04, thickness: 0.02, length: 0.04 };

pub fn quarter(cells: [usize; 3]) -> BushingMesh {
    let [around, radial, axial] = cells;
    BushingMesh { around, radial, axial, grading: 1.4, part: Part::Quarter }
}

pub fn bushing_mesh(cells: [usize; 3]) -> TetMesh {
    bushing(&BUSHING, &quarter(cells)).unwrap().quadratic().unwrap().mesh
}

/// A quarter whose inner sleeve moves along Z.
pub fn bonded(material: Elastomer, cells: [usize; 3], profile: Profile) -> (RubberModel, Vec<u32>) {
    let mesh = bushing_mesh(cells);
    let prescribed = supports(
        &mesh,
        &[
            ("outer", [HELD; 3]),
            ("inner", [HELD, HELD, Some(profile)]),
            ("x_low", [HELD, None, None]),
            ("y_low", [None, HELD, None]),
        ],
    );
    let (elements, inner, nodes) =
        (quadratic(&mesh), mesh.node_sets["inner"].clone(), mesh.nodes.clone());
    let loads = Vec::new();
    let problem = RubberProblem { nodes, elements, material, prescribed, loads };
    (RubberModel::new(problem).unwrap(), inner)
}

pub fn with_bulk(ratio: f64) -> Elastomer {
    let network = EightChain::new(0.647e6, 8.0, ratio * 0.647e6, ChainPull::FiveTerms).unwrap();
    rubber_of(network, &[])
}

pub fn static_stiffness(material: Elastomer, cells: [usize; 3]) -> f64 {
    let (model, _) = bonded(material, cells, Profile::Constant(1.0));
    4.0 * complex_stiffness(&model, 0.0, &[0.0], 1e-6).unwrap()[0].storage
}
