//! Housings A to D of 2.4 around the bearing of Table 2.2, for the cases: what is assumed about
//! them, and how they are solved.

use std::f64::consts::TAU;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, Penalty, contact_nodes};
use bearing_dynamics::equilibrium::statics::StaticProblem;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::{Condition, DrivenBody, Rotation};
use bearing_dynamics::mesh::generate::{Housing, HousingMesh, PillowBlock};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::bore_equilibrium::{Axial, BoreState, Fit};
use bearing_dynamics::solids::condensation::{CondensedBore, Reach, condense};
use bearing_dynamics::solids::model::{Prescribed, SolidModel};

use crate::bearings::{self, DEEP_GROOVE, Hertz, Lengths};
use crate::case::CaseError;
use crate::contact_picture::Panel;
use crate::context::CaseContext;
use crate::housed::HousedSearch;
use crate::motion;
use crate::solids::{STEEL, Vec3, free_body, mesh_of};

/// The scene of a shaft on two bearings, each in a housing of its own.
pub const SHAFT_IN_TWO_HOUSINGS: &str = include_str!("../../scenes/shaft_in_two_housings.toml");

/// Table 2.2: outer race of 31.953 mm and a thickness of 3.574 mm. The bore has the same radius.
pub const BORE_RADIUS: f64 = 31.953e-3 + 3.574e-3;
/// Table 2.2, the bearing's depth; the housings are taken as deep.
pub const WIDTH: f64 = 20e-3;
/// Table 2.2: its ball of 5.955 mm stands for the 5 µm interference of 3.4.3.
pub const BEARING: Lengths = Lengths { clearance: -5e-6, ..DEEP_GROOVE };

/// The housings of Fig. 2.11 with the assumed proportions.
pub fn housing(letter: char) -> Housing {
    let (bore_radius, depth) = (BORE_RADIUS, WIDTH);
    let block = PillowBlock::proportioned(bore_radius, depth);
    match letter {
        'A' => Housing::Square { bore_radius, side: 2.0 * block.outer_radius, depth },
        'B' => Housing::MirroredPillowBlock(block),
        'C' => Housing::PillowBlock(block),
        _ => Housing::Annulus { bore_radius, outer_radius: block.outer_radius, depth },
    }
}

/// Records what every case of these housings takes for granted.
pub fn assumptions(context: &mut CaseContext) {
    context.assumption(
        "housing_dimensions",
        "Fig. 2.11 with the dimensions is lost. Pillow block in multiples of the bore's radius: annulus 1.4, centre height 1.8, \
         base 4.2 × 0.55, necks 2.5 apart, fillets 0.35; the cuboid's side and the bushing's outer diameter are the annulus' \
         diameter; all as deep as the bearing.",
        "PillowBlock::proportioned, 20 mm deep",
    );
    context.assumption(
        "interference_in_bearing",
        "Table 2.2 prints a ball of 5.955 mm; the radial clearance is −5 µm as in case misalignment_moment.",
        "−5 µm radial",
    );
    context.assumption(
        "outer_race_held_axially",
        "A smooth bore without friction holds the outer race neither along nor about its axis; both are taken as held.",
        "held",
    );
    context.assumption(
        "penalty",
        "K of 2.2.4 is for a node, and the mesh is not stated. Here it belongs to 1 mm² of the bore, so that pressure does not \
         depend on the mesh.",
        "2.5e8 N/m per mm²",
    );
}

/// Mesh of a housing: cells around, radial and axial.
pub fn mesh(letter: char, order: Order, cells: [usize; 3]) -> Result<TetMesh, CaseError> {
    let [around, radial, axial] = cells;
    let cells = HousingMesh { around, radial, axial, radial_growth: 1.3 };
    Ok(mesh_of(&housing(letter).solid(&cells)?, order)?)
}

/// The mesh as a solid of Table 2.3's steel, held where 2.4 holds it.
pub fn solid(mesh: &TetMesh) -> Result<SolidModel, CaseError> {
    let mut problem = free_body(mesh, STEEL);
    for node in mesh.nodes_of_faces(mesh.surface_set("fixed")?) {
        let held = [0, 1, 2].map(|axis| Prescribed { node, axis, profile: Profile::ZERO });
        problem.prescribed.extend(held);
    }
    Ok(SolidModel::new(problem)?)
}

/// Nodes of the bore that may touch the race.
pub fn bore_nodes(mesh: &TetMesh) -> Result<Vec<ContactNode>, CaseError> {
    Ok(contact_nodes(mesh, mesh.surface_set("bore")?))
}

/// The solid condensed onto its bore under the race.
pub fn condensed(mesh: &TetMesh, solid: &SolidModel) -> Result<CondensedBore, CaseError> {
    let nodes = bore_nodes(mesh)?;
    let nominal = Pose::identity();
    let reach = Reach { nominal, radius: BORE_RADIUS, width: WIDTH, travel: None };
    Ok(condense(solid, &nodes, &reach)?)
}

/// Interference (m; negative for a clearance) between race and bore.
pub fn fit(interference: f64) -> Fit {
    let radius = BORE_RADIUS + interference;
    Fit { radius, axial: Axial::Fixed }
}

pub fn search(bore: &CondensedBore) -> HousedSearch<'_> {
    HousedSearch::new(bore, Penalty::default())
}

/// The bearing with all coordinates of its inner race driven by loads, zero until a course sets them.
pub fn bearing() -> Result<StaticProblem, CaseError> {
    Ok(bearings::problem(&BEARING, Hertz::Fit, 0.0, [Condition::Load(0.0); 5])?)
}

/// The bearing in motion with its outer race, of Table 2.2's dimensions, free to move but for its
/// rotation; loads on the inner race, which stands still.
pub fn mounted(loads: [f64; 5]) -> Result<DynamicProblem, CaseError> {
    let outer = DrivenBody {
        inertia: inertia::hollow_cylinder(31.953e-3, BORE_RADIUS, WIDTH, STEEL.density),
        ..motion::race([0.0; 5], Rotation::Speed(Profile::ZERO))
    };
    Ok(DynamicProblem { outer: Some(outer), ..motion::moving(&BEARING, 0.0, loads, 0.0)? })
}

/// Sum of the nodal loads on the bore from where its nodes are, N on X, Y, Z.
pub fn sum_of_loads(mesh: &TetMesh, bore: &CondensedBore, state: &BoreState) -> Vec3 {
    let mut sum = [0.0; 3];
    for (node, load) in bore.nodes.iter().zip(&state.loads) {
        let [_, y, z] = mesh.nodes[node.node as usize];
        let radius = y.hypot(z);
        sum[1] += load * y / radius;
        sum[2] += load * z / radius;
    }
    sum
}

/// Part of the bore's surface that the race touches.
pub fn touched_part(bore: &CondensedBore, state: &BoreState) -> f64 {
    let all: f64 = bore.nodes.iter().map(|node| node.area).sum();
    let pairs = bore.nodes.iter().zip(&state.loads);
    pairs.map(|(node, load)| if *load > 0.0 { node.area } else { 0.0 }).sum::<f64>() / all
}

/// A panel of the contact picture: the housing deformed by what its bore carries.
pub fn panel<'a>(
    title: String,
    mesh: &'a TetMesh,
    bore: &CondensedBore,
    state: &BoreState,
    magnification: f64,
) -> Panel<'a> {
    let displacement: Vec<Vec3> =
        bore.displacement(&state.loads).iter().map(|u| u.map(|x| magnification * x)).collect();
    let forces = bore.nodal_forces(&state.loads).collect();
    Panel { title, mesh, forces, displacement }
}

/// Distance from the origin of each point.
pub fn radii(points: &[[f64; 2]]) -> Vec<f64> {
    points.iter().map(|[y, z]| y.hypot(*z)).collect()
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Angles of a full turn, its end left out, rad.
pub fn angles(points: usize) -> impl Iterator<Item = f64> {
    (0..points).map(move |i| TAU * i as f64 / points as f64)
}
