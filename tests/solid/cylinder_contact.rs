//! Equilibrium of solids in contact with a rigid cylinder.

use super::bore_contact::pose;
use crate::solid_common::free;

use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, Penalty, contact_nodes};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::vec3::{add, norm, sub};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, bar, ring};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::contact::{CylinderContact, CylinderPath};
use bearing_dynamics::solids::equilibrium::{
    EquilibriumOptions, equilibrium, equilibrium_in_contact,
};
use bearing_dynamics::solids::error::SolidError;
use bearing_dynamics::solids::model::{Prescribed, SolidModel, SolidProblem};

/// A steel block of 20 × 10 × 10 mm, its top at z = 0.
fn block(order: Order) -> (TetMesh, SolidProblem, Vec<ContactNode>) {
    let mut solid = bar([0.02, 0.01, 0.01], [4, 4, 3]).unwrap();
    for place in &mut solid.mesh.nodes {
        *place = [place[0] - 0.01, place[1], place[2] - 0.005];
    }
    let mesh = match order {
        Order::Linear => solid.mesh.clone(),
        Order::Quadratic => solid.quadratic().unwrap().mesh,
    };
    let nodes = contact_nodes(&mesh, mesh.surface_set("z_high").unwrap());
    let problem = SolidProblem { density: 7850.0, ..free(&mesh, 0.3) };
    (mesh, problem, nodes)
}

fn hold_bottom(mesh: &TetMesh, problem: &mut SolidProblem) {
    for &node in mesh.node_set("z_low").unwrap() {
        for axis in 0..3 {
            problem.prescribed.push(Prescribed { node, axis, profile: Profile::ZERO });
        }
    }
}

/// A cylinder of 30 mm that starts `gap` above the block and goes down.
fn above(nodes: Vec<ContactNode>, gap: f64, down: Profile, penalty: Penalty) -> CylinderContact {
    let path = CylinderPath {
        start: pose([0.0, 0.0, 0.03 + gap], [0.0; 3]),
        displacement: [Profile::ZERO, Profile::ZERO, down],
        radius: Profile::Constant(0.03),
    };
    CylinderContact { path, width: 0.018, penalty, nodes }
}

/// Forces of cylinder and base balance in equilibrium.
#[test]
fn forces_balance_in_equilibrium() {
    for order in [Order::Linear, Order::Quadratic] {
        let (mesh, mut problem, nodes) = block(order);
        hold_bottom(&mesh, &mut problem);
        let down = |profile: Profile| above(nodes.clone(), 0.0, profile, Penalty::PerArea(1e14));
        let at_rest = down(Profile::Constant(-5e-6));
        let model = SolidModel::new(problem.clone()).unwrap();
        let options = EquilibriumOptions::default();
        let found = equilibrium_in_contact(&model, 0.0, &at_rest, None, &options).unwrap();
        assert!(found.sum.touching > 0 && found.sum.touching == found.nodes.len());
        let base: f64 = found.solid.reactions.iter().map(|f| f[2]).sum();
        assert!((base / found.sum.force[2] - 1.0).abs() <= 1e-8, "{base} {:?}", found.sum.force);
        // From its own result it is found at once.
        let start = Some(found.solid.displacement.as_slice());
        let again = equilibrium_in_contact(&model, 0.0, &at_rest, start, &options).unwrap();
        assert_eq!(again.solid.iterations, 0);
    }
}

/// A cylinder that does not touch leaves the solid alone; a thousandfold stiffness still converges.
#[test]
fn no_contact_and_hard_contact() {
    let (mesh, mut problem, nodes) = block(Order::Linear);
    hold_bottom(&mesh, &mut problem);
    problem.gravity = [0.0, 0.0, -9.81];
    let model = SolidModel::new(problem).unwrap();
    let options = EquilibriumOptions::default();
    let away = above(nodes.clone(), 1e-3, Profile::ZERO, Penalty::default());
    let found = equilibrium_in_contact(&model, 0.0, &away, None, &options).unwrap();
    assert_eq!(found.solid, equilibrium(&model, 0.0, &options).unwrap());
    assert_eq!(found.sum.touching, 0);
    let Penalty::PerArea(normal) = Penalty::default() else { panic!("area-weighted by default") };
    let down = |factor: f64| {
        let penalty = Penalty::PerArea(factor * normal);
        let contact = above(nodes.clone(), 0.0, Profile::Constant(-5e-6), penalty);
        equilibrium_in_contact(&model, 0.0, &contact, None, &options).unwrap().sum
    };
    let loads = [1.0, 1e3, 1e6].map(|factor| down(factor).force[2]);
    assert!(loads[0] < loads[1] && (loads[2] / loads[1] - 1.0).abs() <= 1e-2, "{loads:?}");
    assert!(down(1e6).deepest <= 1e-5 * down(1.0).deepest);
}

/// A node on the axis has no normal: an error, not a number.
#[test]
fn a_node_on_the_axis_is_an_error() {
    let (mesh, mut problem, nodes) = block(Order::Linear);
    hold_bottom(&mesh, &mut problem);
    let model = SolidModel::new(problem).unwrap();
    let mut contact = above(nodes, 0.0, Profile::ZERO, Penalty::default());
    contact.path.start = pose([0.0; 3], [0.0; 3]);
    let options = EquilibriumOptions { smallest_load_step: 0.5, ..EquilibriumOptions::default() };
    let found = equilibrium_in_contact(&model, 0.0, &contact, None, &options);
    assert!(matches!(found, Err(SolidError::Unbalanced { .. })), "{found:?}");
}

/// A cylinder that grows in a ring's bore: pressure by Lamé for the interference less penetration.
#[test]
fn interference_grows_in() {
    let (inner, outer, growth) = (0.02, 0.03, 4e-6);
    let shape = Ring { inner_radius: inner, outer_radius: outer, width: 2e-3 };
    let cells = RingMesh { around: 32, radial: 4, axial: 1, radial_growth: 1.1 };
    let mesh = ring(&shape, &cells).unwrap().quadratic().unwrap().mesh;
    let (young, poisson) = (2.1e11, 0.3);
    let mut problem = SolidProblem { density: 7850.0, ..free(&mesh, poisson) };
    for (node, place) in mesh.nodes.iter().enumerate() {
        let planes = [place[0] + 1e-3, place[1], place[2]];
        for (axis, off) in planes.into_iter().enumerate() {
            if off.abs() < 1e-9 {
                let (node, profile) = (node as u32, Profile::ZERO);
                problem.prescribed.push(Prescribed { node, axis, profile });
            }
        }
    }
    let nodes = contact_nodes(&mesh, mesh.surface_set("inner").unwrap());
    let area: f64 = nodes.iter().map(|node| node.area).sum();
    let fit = |radius: Profile, stiffness: f64| CylinderContact {
        path: CylinderPath {
            start: Pose::identity(),
            displacement: [Profile::ZERO, Profile::ZERO, Profile::ZERO],
            radius,
        },
        width: 0.01,
        penalty: Penalty::PerArea(stiffness),
        nodes: nodes.clone(),
    };
    let squares = (inner * inner + outer * outer) / (outer * outer - inner * inner);
    let lame = |opening: f64| opening * young / (inner * (squares + poisson));
    let model = SolidModel::new(problem.clone()).unwrap();
    let options = EquilibriumOptions::default();
    let ramp = Profile::SmoothRamp { from: inner, to: inner + growth, start: 0.0, duration: 20e-6 };
    // Times the default: with it penetration is a twentieth of the growth.
    for factor in [1.0, 30.0] {
        let contact = fit(ramp.clone(), factor * 2.5e14);
        let found = equilibrium_in_contact(&model, 1.0, &contact, None, &options).unwrap();
        let pressure = found.sum.radial_load / area;
        let penetration = pressure / (factor * 2.5e14);
        let should = lame(growth - penetration);
        // A bore of 32 curved sides, four elements through the wall.
        assert!((pressure / should - 1.0).abs() <= 2e-3, "{pressure} {should}");
        assert_eq!(found.sum.touching, nodes.len());
        let held = found.solid.reactions.iter().fold([0.0; 3], |sum, f| add(sum, *f));
        assert!(norm(sub(held, found.sum.force)) <= 1e-8 * found.sum.radial_load);
    }
}
