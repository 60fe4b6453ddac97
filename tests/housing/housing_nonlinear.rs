//! The condensed housing against the nonlinear solid with contact at true distances.

use crate::housing_common;

use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::bore_equilibrium::{Axial, BoreSearch, Fit};
use bearing_dynamics::solids::condensation::{Reach, condense};
use bearing_dynamics::solids::contact::{CylinderContact, CylinderPath};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium_in_contact};
use housing_common::*;

/// The race pushed aside with clearance, in transition and with interference. What is neglected is of
/// the order of displacement over radius: 2e-6 of the load where 480 N sink the race by 30 nm,
/// 7e-4 at 10 µm.
#[test]
fn differ_by_displacement_over_radius() {
    for order in [Order::Linear, Order::Quadratic] {
        let mesh = mesh_of(&RING, &COARSE, order);
        let model = model_of(&mesh, YOUNG);
        // Wider than the bore, so that no node slides over the race's rim.
        let reach = Reach { width: 1.2 * WIDTH, ..reach() };
        let bore = condense(&model, &bore_of(&mesh), &reach).unwrap();
        for (interference, y, z) in [
            (-1e-6, 1.2e-6, -0.8e-6),
            (0.0, 1e-8, -3e-8),
            (0.0, 3e-6, -1e-5),
            (1e-6, 1e-8, -3e-8),
            (1e-5, 1e-7, -3e-7),
        ] {
            let penalty = Penalty::default();
            let fit = Fit { radius: BORE + interference, axial: Axial::Fixed };
            let linear = BoreSearch::new(&bore, penalty).at_pose(&fit, [y, z, 0.0, 0.0]).unwrap();
            let first = BORE + f64::min(interference, 0.0);
            let radius = Profile::Ramp { from: first, to: fit.radius, start: 0.0, duration: 1.0 };
            let displacement = [0.0, y, z].map(Profile::Constant);
            let path = CylinderPath { start: Pose::identity(), displacement, radius };
            let nodes = bore_of(&mesh);
            let contact = CylinderContact { path, width: reach.width, penalty, nodes };
            let options = EquilibriumOptions::default();
            let found = equilibrium_in_contact(&model, 1.0, &contact, None, &options).unwrap();

            let allowed = 5.0 * interference.abs().max(y.hypot(z)) / BORE;
            let all: f64 = linear.loads.iter().sum();
            assert!((all - found.sum.radial_load).abs() <= allowed * all);
            for i in 0..2 {
                let gap = linear.load[i] + found.sum.force[1 + i];
                assert!(gap.abs() <= allowed * all, "{order:?} {interference:e} {i}: {gap}");
            }
            assert_eq!(linear.touching, found.sum.touching);
            let most = linear.loads.iter().fold(0.0, |most: f64, load| most.max(*load));
            for (node, force) in &found.nodes {
                let at = bore.nodes.iter().position(|own| own.node == node.node).unwrap();
                let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
                assert!((size - linear.loads[at]).abs() <= allowed * most);
            }
        }
    }
}
