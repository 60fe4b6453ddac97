//! Laws of a condensed housing and of a rigid race in its bore.

use crate::housing_common;

use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::equilibrium::statics::StaticsError;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::euler::about;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::{Housing, HousingMesh, PillowBlock};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::reduction::load_patterns::race_under_load;
use bearing_dynamics::solids::bore_equilibrium::{
    Axial, BoreError, BoreSearch, BoreState, Fit, RaceLoad,
};
use bearing_dynamics::solids::condensation::{
    CondenseError, CondensedBore, Reach, condense, geometry_error,
};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::error::SolidError;
use bearing_dynamics::solids::model::{Prescribed, SolidModel};
use housing_common::*;
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_2;

fn fit(interference: f64) -> Fit {
    Fit { radius: BORE + interference, axial: Axial::Fixed }
}

fn load(y: f64, z: f64, about_y: f64, about_z: f64) -> RaceLoad {
    RaceLoad { force: [0.0, y, z], moment: [0.0, about_y, about_z] }
}

fn solve(bore: &CondensedBore, fit: &Fit, load: &RaceLoad) -> BoreState {
    race_under_load(&mut BoreSearch::new(bore, Penalty::default()), fit, load).unwrap()
}

/// What the bore says against it.
fn in_bore(found: Result<BoreState, StaticsError>) -> BoreError {
    match found.unwrap_err() {
        StaticsError::Seat { source, .. } => source,
        other => panic!("{other}"),
    }
}

fn far(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(
        0.0,
        |most, gap| {
            if gap <= most { most } else { gap }
        },
    )
}

fn largest(a: &[f64]) -> f64 {
    far(a, &vec![0.0; a.len()])
}

#[test]
fn compliance_is_symmetric_and_positive() {
    for order in [Order::Linear, Order::Quadratic] {
        let bore = condensed(&RING, &COARSE, order, YOUNG);
        // Rounding of a factorisation of condition 1e6.
        assert!(bore.asymmetry <= 1e-10, "{}", bore.asymmetry);
        let all: Vec<usize> = (0..bore.nodes.len()).collect();
        assert!(bore.compliance.factor(&all, &vec![0.0; all.len()]).is_ok());
        let sizes = bore.sizes;
        assert_eq!((sizes.kept, sizes.beside, sizes.outside_range), (sizes.bore, 0, 0));
        let areas: f64 = bore.nodes.iter().map(|node| node.area).sum();
        let bore_area = std::f64::consts::TAU * BORE * WIDTH;
        assert!((areas / bore_area - 1.0).abs() <= 5e-3, "{areas} {bore_area}");
        assert!(bore.nodes.iter().all(|node| (node.distance - BORE).abs() <= 1e-12));
    }
}

#[test]
fn loads_balance_whatever_the_fit() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let model = model_of(&mesh, YOUNG);
    let on_race = load(100.0, -250.0, 0.3, 0.1);
    for interference in [-5e-6, -1e-6, 0.0, 1e-6, 1e-5] {
        let state = solve(&bore, &fit(interference), &on_race);
        let wanted = [100.0, -250.0, 0.3, 0.1];
        for (i, wanted) in wanted.into_iter().enumerate() {
            let scale = if i < 2 { 250.0 } else { 250.0 * BORE };
            assert!((state.load[i] - wanted).abs() <= 1e-10 * scale, "{:?}", state.load);
        }
        let penalty = Penalty::default();
        for ((load, g), node) in state.loads.iter().zip(&state.penetration).zip(&bore.nodes) {
            let law = penalty.of_node(node.area) * g.max(0.0);
            assert!((load - law).abs() <= 1e-7 * largest(&state.loads), "{load} {law}");
        }
        // The whole field carries the load to the supports, and has its energy; a ten-thousandth of
        // it, in which the solid's own nonlinearity vanishes.
        const PART: f64 = 1e-4;
        let u = bore.displacement(&state.loads);
        let mut forces = vec![[0.0; 4]; u.len()];
        let padded: Vec<_> =
            u.iter().map(|u| [PART * u[0], PART * u[1], PART * u[2], 0.0]).collect();
        model.add_internal_forces(&padded, &mut forces);
        let mut sum = [0.0; 3];
        for (of, force) in model.per_mass.iter().zip(&forces) {
            for i in 0..3 {
                sum[i] += if of[i] == 0.0 { force[i] / PART } else { 0.0 };
            }
        }
        let should = [0.0, 100.0, -250.0];
        assert!(far(&sum, &should) <= 2e-3, "{sum:?}");
        let work: f64 = padded
            .iter()
            .zip(&forces)
            .map(|(u, f)| -0.5 * (u[0] * f[0] + u[1] * f[1] + u[2] * f[2]))
            .sum();
        let energy = PART * PART * state.elastic_energy;
        assert!((work / energy - 1.0).abs() <= 1e-5, "{work} {energy}");
    }
}

/// In a slender housing, whose bore wraps itself around the race.
#[test]
fn nodes_that_carry_nothing_are_clear_of_the_race() {
    let block = Housing::PillowBlock(PillowBlock::proportioned(BORE, WIDTH));
    let bore = condensed(&block, &COARSE, Order::Quadratic, YOUNG);
    let fit = fit(0.0);
    let mut search = BoreSearch::new(&bore, Penalty::default());
    for [y, z] in [[250.0, 0.0], [0.0, 250.0], [-200.0, 100.0], [0.0, -250.0]] {
        let state = race_under_load(&mut search, &fit, &load(y, z, 0.0, 0.0)).unwrap();
        let clear = state.loads.iter().zip(&state.penetration).filter(|(load, _)| **load == 0.0);
        assert!(clear.clone().count() > bore.nodes.len() / 4);
        // Some ulps of the bore's radius.
        assert!(clear.map(|(_, g)| *g).all(|g| g <= 1e-16));
        assert!(state.loads.iter().all(|load| *load >= 0.0));
    }
}

/// With neither gap nor overlap at the start everything grows with the load, and the work of the
/// load is the energy stored.
#[test]
fn transition_fit_is_proportional() {
    let bore = condensed(&RING, &COARSE, Order::Quadratic, YOUNG);
    let one = solve(&bore, &fit(0.0), &load(100.0, -250.0, 0.3, 0.1));
    let ten = solve(&bore, &fit(0.0), &load(1e3, -2.5e3, 3.0, 1.0));
    let scaled: Vec<f64> = one.loads.iter().map(|load| 10.0 * load).collect();
    assert!(far(&scaled, &ten.loads) <= 1e-7 * largest(&ten.loads));
    assert!(one.touching < bore.nodes.len() && one.touching > bore.nodes.len() / 4);
    let work: f64 = 0.5 * one.load.iter().zip(one.pose).map(|(f, q)| f * q).sum::<f64>();
    let stored = one.elastic_energy + one.contact_energy;
    assert!((work / stored - 1.0).abs() <= 1e-7, "{work} {stored}");
}

#[test]
fn stiffness_is_the_slope_of_the_load() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    for interference in [-1e-6, 0.0, 5e-6] {
        let fit = fit(interference);
        let mut search = BoreSearch::new(&bore, Penalty::default());
        let here = race_under_load(&mut search, &fit, &load(30.0, -250.0, 0.2, 0.1)).unwrap();
        for i in 0..4 {
            // So small that no node comes or goes.
            let step = if i < 2 { 1e-12 } else { 1e-11 };
            let mut pose = here.pose;
            pose[i] += step;
            let there = search.at_pose(&fit, pose).unwrap();
            for j in 0..4 {
                let slope = (there.load[j] - here.load[j]) / step;
                let metres = |k: usize| if k < 2 { 1.0 } else { BORE };
                let scale = here.stiffness[(1, 1)] * metres(i) * metres(j);
                assert!((slope - here.stiffness[(j, i)]).abs() <= 1e-3 * scale);
            }
        }
    }
}

#[test]
fn fits_rank_and_all_interferences_are_alike() {
    let bore = condensed(&RING, &COARSE, Order::Quadratic, YOUNG);
    let force = load(0.0, -250.0, 0.0, 0.0);
    let sink = |interference: f64| {
        let fit = fit(interference);
        let mut search = BoreSearch::new(&bore, Penalty::default());
        let idle = race_under_load(&mut search, &fit, &RaceLoad::default()).unwrap();
        race_under_load(&mut search, &fit, &force).unwrap().pose[1] - idle.pose[1]
    };
    let [clearance, transition, one, five, ten] = [-1e-6, 0.0, 1e-6, 5e-6, 1e-5].map(sink);
    assert!(
        clearance < 1.5 * transition && transition < 1.2 * one,
        "{clearance} {transition} {one}"
    );
    // While all nodes touch, the preload is nothing to a linear solid.
    assert!((one / ten - 1.0).abs() <= 1e-6 && (five / ten - 1.0).abs() <= 1e-6);
    assert!(ten < 0.0);
}

#[test]
fn a_loose_race_stays_without_load_and_finds_contact_with_one() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let fit = fit(-1e-5);
    let mut search = BoreSearch::new(&bore, Penalty::default());
    let idle = race_under_load(&mut search, &fit, &RaceLoad::default()).unwrap();
    assert_eq!((idle.pose, idle.touching), ([0.0; 4], 0));
    for force in [1e-3, 1.0, 1e3] {
        // Towards no node in particular.
        let state =
            race_under_load(&mut search, &fit, &load(0.3 * force, -force, 0.0, 0.0)).unwrap();
        assert!(state.touching > 0 && state.touching < bore.nodes.len() / 2);
        // Gaps round by some 1e-17 m, which is 1e-10 N in steel.
        let should = [0.3 * force, -force];
        assert!(far(&state.load[..2], &should) <= 1e-9 * force + 1e-10, "{:?}", state.load);
        let travel = state.pose[0].hypot(state.pose[1]);
        assert!(travel >= 0.999e-5, "{travel}");
    }
}

#[test]
fn what_a_smooth_bore_cannot_hold_is_an_error() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let free = Fit { axial: Axial::Free, ..fit(0.0) };
    let mut search = BoreSearch::new(&bore, Penalty::default());
    let along = RaceLoad { force: [5.0, 0.0, -250.0], moment: [0.0; 3] };
    let error = in_bore(race_under_load(&mut search, &free, &along));
    assert_eq!(error, BoreError::AxialForce { force: 5.0 });
    assert!(race_under_load(&mut search, &fit(0.0), &along).is_ok());
    let turning = RaceLoad { force: [0.0, 0.0, -250.0], moment: [0.1, 0.0, 0.0] };
    let error = in_bore(race_under_load(&mut search, &free, &turning));
    assert_eq!(error, BoreError::AxialMoment { moment: 0.1 });
    let nan = load(f64::NAN, 0.0, 0.0, 0.0);
    let error = in_bore(race_under_load(&mut search, &fit(0.0), &nan));
    assert!(matches!(error, BoreError::NotFinite { .. }));
    // Under a race so narrow that one row of nodes touches, nothing holds a tilt.
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let narrow = Reach { width: 2e-3, ..reach() };
    let row = condense(&model_of(&mesh, YOUNG), &bore_of(&mesh), &narrow).unwrap();
    assert_eq!((row.sizes.kept, row.sizes.beside), (24, 48));
    let mut search = BoreSearch::new(&row, Penalty::default());
    let error = race_under_load(&mut search, &fit(0.0), &load(0.0, -250.0, 1.0, 0.0));
    let error = in_bore(error);
    assert!(matches!(error, BoreError::NotHeld { coordinate: "tilt_y", .. }), "{error}");
    let said = error.to_string();
    assert!(said.contains("tilted it by") && said.contains("deg about y"), "{said}");
    let said =
        BoreError::NotHeld { coordinate: "z", travel: -1.939e-2, force: 2.141e-3 }.to_string();
    assert!(said.contains("moved it by -19.3900 mm along z from its nominal position"), "{said}");
    assert!(said.contains("0.00214 N"), "{said}");
}

/// A modulus in the wrong unit is no load without resistance.
#[test]
fn a_housing_that_is_too_soft_is_called_so() {
    let soft = condensed(&RING, &COARSE, Order::Linear, 1e-6 * YOUNG);
    let mut search = BoreSearch::new(&soft, Penalty::default());
    let error = race_under_load(&mut search, &fit(1e-6), &load(0.0, -2000.0, 0.0, 0.0));
    let error = in_bore(error);
    let said = error.to_string();
    let BoreError::GivesWay { coordinate, travel, load, radius, youngs_modulus } = error else {
        panic!("{said}");
    };
    assert_eq!((coordinate, load, youngs_modulus), ("z", 2000.0, 1e-6 * YOUNG));
    assert!(travel < -0.01 * BORE && radius == BORE + 1e-6, "{travel}");
    assert!(said.contains("it carries the full load of 2000 N"), "{said}");
    assert!(said.contains(&format!("moved it by {:.4} mm along z", 1e3 * travel)), "{said}");
    assert!(said.contains("youngs_modulus, which is 0.00021 GPa"), "{said}");
    assert!(!said.contains("no resistance"), "{said}");
}

#[test]
fn what_a_condensed_housing_cannot_be_is_an_error() {
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let model = model_of(&mesh, YOUNG);
    let beside = Reach {
        nominal: Pose { position: Vector3::new(1.0, 0.0, 0.0), ..Pose::identity() },
        ..reach()
    };
    let error = condense(&model, &bore_of(&mesh), &beside).err();
    assert_eq!(error, Some(CondenseError::NoNodes { bore: 72 }));
    let mut moved = model.clone();
    moved.problem.prescribed[0].profile = Profile::Constant(1e-6);
    let error = condense(&moved, &bore_of(&mesh), &reach()).err();
    assert!(matches!(error, Some(CondenseError::PrescribedSupport { .. })));
    let mut loose = model.problem.clone();
    loose.prescribed.clear();
    let loose = SolidModel::new(loose).unwrap();
    let error = condense(&loose, &bore_of(&mesh), &reach()).err();
    assert!(matches!(error, Some(CondenseError::Solid(SolidError::Free { .. }))), "{error:?}");
}

/// The housing's own weight moves its bore before anything touches.
#[test]
fn own_loads_of_the_housing() {
    let mesh = mesh_of(&RING, &COARSE, Order::Quadratic);
    let mut problem = model_of(&mesh, YOUNG).problem;
    problem.gravity = [0.0, 0.0, -9.81e3];
    let model = SolidModel::new(problem).unwrap();
    let bore = condense(&model, &bore_of(&mesh), &reach()).unwrap();
    let none = vec![0.0; bore.nodes.len()];
    let u = bore.displacement(&none);
    let should = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap().displacement;
    let size = largest(should.as_flattened());
    assert!(far(u.as_flattened(), should.as_flattened()) <= 1e-4 * size, "{size}");
    assert!(largest(bore.response(&none).as_flattened()) == 0.0);
    let loose = fit(-1e-6);
    let state = BoreSearch::new(&bore, Penalty::default()).at_pose(&loose, [0.0; 4]).unwrap();
    for (node, g) in bore.nodes.iter().zip(&state.penetration) {
        let [_, y, z] = mesh.nodes[node.node as usize];
        let [_, v, w] = u[node.node as usize];
        let outward = (v * y + w * z) / y.hypot(z);
        assert!((g + 1e-6 + outward).abs() <= 1e-9 * size, "{g} {outward}");
    }
    assert_eq!(state.touching, 0);
    // What a node moves by is that of the whole field, contact or not.
    let tight = fit(1e-6);
    let pressed = solve(&bore, &tight, &load(50.0, -250.0, 0.0, 0.0));
    assert!(pressed.touching > 0);
    for state in [&state, &pressed] {
        let u = bore.displacement(&state.loads);
        // What is stored is half the work of the elements' own forces, at so small a part that they are linear.
        const PART: f64 = 1e-4;
        let padded: Vec<_> = u.iter().map(|u| [u[0], u[1], u[2], 0.0].map(|u| PART * u)).collect();
        let mut forces = vec![[0.0; 4]; u.len()];
        model.add_internal_forces(&padded, &mut forces);
        let pairs = padded.as_flattened().iter().zip(forces.as_flattened());
        let stored = -0.5 * pairs.map(|(u, f)| u * f).sum::<f64>() / (PART * PART);
        assert!((state.elastic_energy / stored - 1.0).abs() <= 1e-5, "{stored}");
        for (node, found) in bore.nodes.iter().zip(&state.outward) {
            let [_, y, z] = mesh.nodes[node.node as usize];
            let [_, v, w] = u[node.node as usize];
            let outward = (v * y + w * z) / y.hypot(z);
            assert!((found - outward).abs() <= 1e-9 * size, "{found} {outward}");
        }
    }
}

/// What fixed normals leave out of the distance of a node from the axis of a race that has moved by δ,
/// across the node's normal by δ sin α: δ² sin² α / 2r.
#[test]
fn the_error_of_fixed_normals_is_that_of_a_chord() {
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let still = vec![[0.0; 3]; mesh.nodes.len()];
    for moved in [1e-5, 1e-4] {
        let [error, opposite] =
            [moved, -moved].map(|y| geometry_error(&bore, &still, &[y, 0.0, 0.0, 0.0]));
        // A node at right angles to the motion is among the 24.
        let chord = moved * moved / (2.0 * BORE);
        assert!((error / chord - 1.0).abs() <= 5e-3, "{error:e} {chord:e}");
        assert!((opposite / chord - 1.0).abs() <= 5e-3, "{opposite:e} {chord:e}");
        // The bore moving the same way as a whole leaves none.
        let with = vec![[0.0, moved, 0.0]; mesh.nodes.len()];
        let error = geometry_error(&bore, &with, &[moved, 0.0, 0.0, 0.0]);
        assert!(error <= 1e-16 + 1e-9 * moved, "{error:e}");
    }
}

/// The mesh turned with the load gives the same loads turned; the load turned alone, what the mesh's
/// own lack of symmetry leaves.
#[test]
fn turning_everything_turns_the_answer() {
    let before = solve(
        &condensed(&RING, &COARSE, Order::Quadratic, YOUNG),
        &fit(0.0),
        &load(100.0, -250.0, 0.3, 0.1),
    );
    let mut mesh = mesh_of(&RING, &COARSE, Order::Quadratic);
    for [_, y, z] in &mut mesh.nodes {
        (*y, *z) = (-*z, *y);
    }
    let turned = condense(&model_of(&mesh, YOUNG), &bore_of(&mesh), &reach()).unwrap();
    let after = solve(&turned, &fit(0.0), &load(250.0, 100.0, -0.1, 0.3));
    let [y, z, about_y, about_z] = before.pose;
    let should = [-z, y, -about_z, about_y];
    assert!(far(&after.pose, &should) <= 1e-8 * largest(&should), "{:?} {should:?}", after.pose);
    assert!(far(&after.loads, &before.loads) <= 1e-6 * largest(&before.loads));
    // The same mesh seen from a frame that is turned: the bore stands still, the race's axes do not.
    let mesh = mesh_of(&RING, &COARSE, Order::Quadratic);
    let nominal = Pose { orientation: about(Vector3::x(), FRAC_PI_2), position: Vector3::zeros() };
    let seen =
        condense(&model_of(&mesh, YOUNG), &bore_of(&mesh), &Reach { nominal, ..reach() }).unwrap();
    let again = solve(&seen, &fit(0.0), &load(-250.0, -100.0, 0.1, -0.3));
    let should = [z, -y, about_z, -about_y];
    assert!(far(&again.pose, &should) <= 1e-8 * largest(&should), "{:?} {should:?}", again.pose);
    // Mesh alone.
    let bore = condensed(&RING, &COARSE, Order::Quadratic, YOUNG);
    let turned = solve(&bore, &fit(0.0), &load(250.0, 0.0, 0.0, 0.0));
    let first = solve(&bore, &fit(0.0), &load(0.0, -250.0, 0.0, 0.0));
    assert!((turned.pose[0] / -first.pose[1] - 1.0).abs() <= 5e-3);
}

/// A race that is smaller than its bore and lies at the bottom: nodes above are out of its reach.
#[test]
fn nodes_out_of_reach_are_counted_and_not_missed() {
    let mesh = mesh_of(&RING, &COARSE, Order::Quadratic);
    let (model, nodes) = (model_of(&mesh, YOUNG), bore_of(&mesh));
    let clearance = 2e-5;
    let nominal = Pose { position: Vector3::new(0.0, 0.0, -clearance), ..Pose::identity() };
    let all = Reach { nominal, radius: BORE - clearance, width: WIDTH, travel: None };
    let near = Reach { travel: Some(8e-6), ..all };
    let fit = Fit { radius: BORE - clearance, ..fit(0.0) };
    let on_race = load(20.0, -250.0, 0.05, 0.0);
    let whole = condense(&model, &nodes, &all).unwrap();
    let part = condense(&model, &nodes, &near).unwrap();
    let sizes = part.sizes;
    assert!(sizes.outside_range > sizes.bore / 2, "{sizes:?}");
    assert_eq!(sizes.kept + sizes.outside_range, sizes.bore);
    for contact in &nodes {
        let [_, y, z] = contact.place;
        let gap = y.hypot(z + clearance) - (BORE - clearance);
        let kept = part.nodes.iter().any(|node| node.node == contact.node);
        assert_eq!(kept, gap <= 8e-6, "{gap}");
    }
    let (with_all, with_part) = (solve(&whole, &fit, &on_race), solve(&part, &fit, &on_race));
    assert!(far(&with_all.pose, &with_part.pose) <= 1e-9 * largest(&with_all.pose));
    assert_eq!(with_all.touching, with_part.touching);
    let (mut summed, mut largest_gap) = (0.0f64, 0.0f64);
    for (node, load) in part.nodes.iter().zip(&with_part.loads) {
        let at = whole.nodes.iter().position(|other| other.node == node.node).unwrap();
        largest_gap = largest_gap.max((with_all.loads[at] - load).abs());
        summed += load;
    }
    assert!(summed > 250.0 && largest_gap <= 1e-7 * summed, "{summed} {largest_gap}");
    // A load that takes it farther than that is refused, not answered.
    let lifted =
        BoreSearch::new(&part, Penalty::default()).at_pose(&fit, [0.0, 2.0 * clearance, 0.0, 0.0]);
    assert!(matches!(lifted, Err(BoreError::BeyondRange { .. })), "{lifted:?}");
}

/// In a rigid bore only the penalty springs give way.
#[test]
fn rigid_bore() {
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e9 * YOUNG);
    let penalty = Penalty::default();
    let fit = fit(1e-6);
    let state = BoreSearch::new(&bore, penalty).at_pose(&fit, [1e-6, 2e-6, 1e-5, 3e-5]).unwrap();
    for (node, load) in bore.nodes.iter().zip(&state.loads) {
        let [x, y, z] = node.arm;
        let place = Vector3::new(x, y, z);
        let motion = Vector3::new(0.0, 1e-6, 2e-6) + Vector3::new(0.0, 1e-5, 3e-5).cross(&place);
        let out = (motion.y * y + motion.z * z) / y.hypot(z);
        let should = penalty.of_node(node.area) * f64::max(1e-6 + out, 0.0);
        assert!((load - should).abs() <= 1e-6 * largest(&state.loads), "{load} {should}");
    }
    assert!(state.elastic_energy <= 1e-6 * state.contact_energy);
}

/// Ends held (plane strain), outside held: u = A (r − b²/r), and the pressure that goes with the
/// displacement of the bore.
#[test]
fn interference_in_a_ring_is_lames() {
    let interference = 5e-6;
    let (a, b): (f64, f64) = (BORE, 55e-3);
    let steel = LinearElastic::new(YOUNG, 0.3).unwrap();
    let (lambda, mu) = (steel.lambda, steel.shear_modulus);
    let per_displacement =
        (2.0 * (lambda + mu) + 2.0 * mu * (b / a).powi(2)) / ((b * b - a * a) / a);
    let pressure = |order: Order, cells: &HousingMesh| {
        let mesh = mesh_of(&RING, cells, order);
        let mut problem = model_of(&mesh, YOUNG).problem;
        let held: Vec<u32> = problem.prescribed.iter().map(|held| held.node).collect();
        for (node, place) in (0u32..).zip(&mesh.nodes) {
            if place[0].abs() > 0.4999 * WIDTH && !held.contains(&node) {
                problem.prescribed.push(Prescribed { node, axis: 0, profile: Profile::ZERO });
            }
        }
        let model = SolidModel::new(problem).unwrap();
        let bore = condense(&model, &bore_of(&mesh), &reach()).unwrap();
        let fit = fit(interference);
        let state = solve(&bore, &fit, &RaceLoad::default());
        assert_eq!(state.touching, bore.nodes.len());
        if order == Order::Quadratic {
            // Four-node meshes lack the symmetry that keeps the race in the middle.
            let [y, z, about_y, about_z] = state.pose;
            let off = largest(&[y, z, BORE * about_y, BORE * about_z]);
            assert!(off <= 1e-3 * interference, "{:?}", state.pose);
        }
        let area: f64 = bore.nodes.iter().map(|node| node.area).sum();
        let mean = state.loads.iter().sum::<f64>() / area;
        let sunk = state.penetration.iter().zip(&bore.nodes).map(|(g, n)| g * n.area).sum::<f64>();
        let should = per_displacement * (interference - sunk / area);
        assert!((mean / should - 1.0).abs() <= 0.02, "{order:?} {cells:?}: {mean} {should}");
        let error = geometry_error(&bore, &bore.displacement(&state.loads), &state.pose);
        assert!(error <= 1e-4 * interference, "{error}");
        mean
    };
    let cells = |around, radial, axial| HousingMesh { around, radial, axial, radial_growth: 1.3 };
    let quadratic = [cells(24, 2, 1), cells(48, 4, 1)].map(|c| pressure(Order::Quadratic, &c));
    assert!((quadratic[0] / quadratic[1] - 1.0).abs() <= 0.005, "{quadratic:?}");
    let linear = [cells(32, 4, 1), cells(64, 8, 1)].map(|c| pressure(Order::Linear, &c));
    assert!((linear[0] / linear[1] - 1.0).abs() <= 0.02, "{linear:?}");
}
