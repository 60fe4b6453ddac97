//! The bearing of Table 2.2 in the housings of Fig. 2.11, for the cases of 2.4.

use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, contact_nodes};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::mesh::generate::{Housing, HousingMesh, PillowBlock};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solver::dynamics::model::{DynamicProblem, RaceBody, Rotation};
use bearing_dynamics::solver::housing::condensed::Reach;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::model::{Prescribed, SolidModel};

use crate::bearings::{DEEP_GROOVE, Lengths};
use crate::case::CaseError;
use crate::motion;
use crate::solids::{STEEL, free_body, mesh_of};

/// Table 2.2: raceway of 31.953 mm, 3.574 mm thick.
pub const RACE_RADIUS: f64 = 35.527e-3;
/// Table 2.2, bearing depth.
pub const DEPTH: f64 = 20e-3;
/// Table 2.2: its ball of 5.955 mm stands for the 5 µm interference of 3.4.3.
pub const BEARING: Lengths = Lengths { clearance: -5e-6, ..DEEP_GROOVE };

/// Letter of Fig. 2.11 and what it shows, in proportions of ours.
pub fn housings() -> [(&'static str, Housing); 3] {
    let block = PillowBlock::proportioned(RACE_RADIUS, DEPTH);
    let square =
        Housing::Square { bore_radius: RACE_RADIUS, side: 2.8 * RACE_RADIUS, depth: DEPTH };
    [("A", square), ("B", Housing::MirroredPillowBlock(block)), ("C", Housing::PillowBlock(block))]
}

/// A housing held where the source holds it, and the nodes of its bore.
pub struct HousingBody {
    pub mesh: TetMesh,
    pub model: SolidModel,
    pub nodes: Vec<ContactNode>,
}

/// Of steel; `damping` in 1/s.
pub fn body(
    housing: &Housing,
    cells: &HousingMesh,
    order: Order,
    damping: f64,
) -> Result<HousingBody, CaseError> {
    let mesh = mesh_of(&housing.solid(cells)?, order)?;
    let mut problem = free_body(&mesh, STEEL);
    problem.damping = damping;
    for node in mesh.nodes_of_faces(mesh.surface_set("fixed")?) {
        for axis in 0..3 {
            problem.prescribed.push(Prescribed { node, axis, profile: Profile::ZERO });
        }
    }
    let nodes = contact_nodes(&mesh, mesh.surface_set("bore")?);
    Ok(HousingBody { model: SolidModel::new(problem)?, nodes, mesh })
}

/// Where the race sits in the bore.
pub fn reach() -> Reach {
    Reach { nominal: Pose::identity(), radius: RACE_RADIUS, width: DEPTH, travel: None }
}

/// An outer race of Table 2.2's dimensions that does not turn, as a body.
pub fn outer_race() -> RaceBody {
    RaceBody {
        inertia: inertia::hollow_cylinder(31.953e-3, RACE_RADIUS, DEPTH, STEEL.density),
        ..motion::race([0.0; 5], Rotation::Speed(Profile::ZERO))
    }
}

/// The bearing with its outer race free to move in a housing.
pub fn mounted(loads: [f64; 5], speed: f64) -> Result<DynamicProblem, CaseError> {
    let bearing = motion::moving(&BEARING, 0.0, loads, speed)?;
    Ok(DynamicProblem { outer: Some(outer_race()), ..bearing })
}
