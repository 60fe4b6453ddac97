//! A housing of a mesh generator, condensed.
#![allow(dead_code)]

use bearing_dynamics::ch2_housing::bearing::geometry::{
    BearingGeometry, ClearanceThrough, Material,
};
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzModel, RaceSide, contact};
use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, contact_nodes};
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::equilibrium::statics::StaticProblem;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::mesh::generate::{Housing, HousingMesh};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::condensation::{CondensedBore, Reach, condense};
use bearing_dynamics::solids::model::{DampedMotion, Prescribed, SolidModel, SolidProblem};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const YOUNG: f64 = 2.1e11;
pub const BORE: f64 = 35.527e-3;
pub const WIDTH: f64 = 20e-3;

pub const RING: Housing = Housing::Annulus { bore_radius: BORE, outer_radius: 55e-3, depth: WIDTH };
pub const COARSE: HousingMesh = HousingMesh { around: 24, radial: 2, axial: 2, radial_growth: 1.3 };

pub fn mesh_of(housing: &Housing, mesh: &HousingMesh, order: Order) -> TetMesh {
    let solid = housing.solid(mesh).unwrap();
    match order {
        Order::Linear => solid.mesh,
        Order::Quadratic => solid.quadratic().unwrap().mesh,
    }
}

/// The solid held on its set `fixed`.
pub fn model_of(mesh: &TetMesh, young: f64) -> SolidModel {
    let held = mesh.nodes_of_faces(mesh.surface_set("fixed").unwrap());
    let hold =
        |node: &u32| [0, 1, 2].map(|axis| Prescribed { node: *node, axis, profile: Profile::ZERO });
    SolidModel::new(SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material: LinearElastic::new(young, 0.3).unwrap(),
        density: 7850.0,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed: held.iter().flat_map(hold).collect(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    })
    .unwrap()
}

pub fn bore_of(mesh: &TetMesh) -> Vec<ContactNode> {
    contact_nodes(mesh, mesh.surface_set("bore").unwrap())
}

pub fn reach() -> Reach {
    Reach { nominal: Pose::identity(), radius: BORE, width: WIDTH, travel: None }
}

pub fn condensed(housing: &Housing, mesh: &HousingMesh, order: Order, young: f64) -> CondensedBore {
    let mesh = mesh_of(housing, mesh, order);
    condense(&model_of(&mesh, young), &bore_of(&mesh), &reach()).unwrap()
}

/// The bearing of Table 2.2 with −5 µm radial clearance.
pub fn bearing(conditions: [Condition; 5]) -> StaticProblem {
    let nominal =
        BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.953e-3);
    let geometry = nominal.with_radial_clearance(-5e-6, ClearanceThrough::Ball);
    let steel = Material::STEEL;
    let side = |side| contact(HertzModel::HamrockBrewe, side, &geometry, &steel, &steel).unwrap();
    StaticProblem {
        geometry,
        inner_contact: side(RaceSide::Inner),
        outer_contact: side(RaceSide::Outer),
        ball_phase: 0.0,
        ball_mass: steel.density * 4.0 / 3.0 * PI * geometry.ball_radius.powi(3),
        gravity: Vector3::zeros(),
        orbital_speed: 0.0,
        frame: Pose::identity(),
        outer_pose: Pose::identity(),
        conditions,
    }
}
