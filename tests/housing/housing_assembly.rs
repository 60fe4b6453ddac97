//! Laws of a bearing and its housing in one equilibrium, and of quasi-static courses.

use crate::housed::{HousedSearch, HousedState};
use crate::housing_common;

use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::equilibrium::statics;
use bearing_dynamics::equilibrium::statics::{StaticProblem, StaticsError};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::recorder::seat::SeatRow;
use bearing_dynamics::solids::bore_equilibrium::{Axial, BoreError, Fit};
use bearing_dynamics::solids::condensation::{CondensedBore, Reach, condense, geometry_error};
use bearing_dynamics::solids::model::{Load, SolidModel};
use housing_common::*;
use nalgebra::{UnitQuaternion, Vector3};

pub fn fit(interference: f64) -> Fit {
    Fit { radius: BORE + interference, axial: Axial::Fixed }
}

pub fn search(bore: &CondensedBore) -> HousedSearch<'_> {
    HousedSearch::new(bore, Penalty::default())
}

pub fn solve(bore: &CondensedBore, fit: &Fit, problem: &StaticProblem) -> HousedState {
    search(bore).solve(problem, fit, [0.0; 3]).unwrap()
}

pub fn loads(of: [f64; 5]) -> [Condition; 5] {
    of.map(Condition::Load)
}

#[test]
fn both_races_balance() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    for interference in [-1e-6, 0.0, 1e-5] {
        let fit = fit(interference);
        let problem = bearing(loads([20.0, 100.0, -250.0, 0.2, -0.3]));
        let weight = [0.0, 0.0, -2.0];
        let state = search(&bore).solve(&problem, &fit, weight).unwrap();
        assert!(state.residual <= 1e-9);
        let should = [20.0, 100.0, -252.0];
        for (force, should) in state.on_outer.force.into_iter().zip(should) {
            assert!((force - should).abs() <= 1e-9 * 250.0, "{force} {should}");
        }
        for i in 0..2 {
            assert!((state.bore.load[i] - should[1 + i]).abs() <= 1e-8 * 250.0);
        }
        // Moments about the outer race's own centre: the inner race's, its force at its offset.
        let outer = nalgebra::Vector3::new(0.0, state.bore.pose[0], state.bore.pose[1]);
        let offset = state.bearing.coordinates.fixed_rows::<3>(0) - outer;
        let force = nalgebra::Vector3::new(20.0, 100.0, -250.0);
        let shifted = offset.cross(&force);
        for (i, own) in [0.2, -0.3].into_iter().enumerate() {
            let moment = own + shifted[1 + i];
            // The moments on the inner race go with Euler angles of 1e-5 rad.
            assert!((state.bore.load[2 + i] - moment).abs() <= 1e-5, "{:?}", state.bore.load);
        }
    }
}

/// What keeps balls in their orbits comes from the outer race: the bore takes what the balls put on it.
#[test]
fn both_races_balance_while_balls_go_round() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let conditions = loads([20.0, 100.0, -250.0, 0.2, -0.3]);
    let problem = StaticProblem { orbital_speed: 200.0, ..bearing(conditions) };
    let state = solve(&bore, &fit(1e-6), &problem);
    assert!(state.residual <= 1e-9, "{:e}", state.residual);
    // Displaced balls are flung more to one side than to the other.
    let more = (state.bore.load[1] + 250.0).abs();
    assert!(more >= 1e-5, "{more:e}");
}

/// Every force on a ball goes through its centre and they balance: what the
/// balls and their cage put on both races sums to no moment, about every axis.
#[test]
fn moments_on_both_races_sum_to_nothing() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let fit = fit(1e-6);
    let problem = bearing(loads([200.0, 100.0, -250.0, 1.0, -0.6]));
    let state = solve(&bore, &fit, &problem);
    let outer = nalgebra::Vector3::new(0.0, state.bore.pose[0], state.bore.pose[1]);
    let offset = state.bearing.coordinates.fixed_rows::<3>(0) - outer;
    let (force, moment) = (state.bearing.force_on_inner, state.bearing.moment_on_inner);
    let on_outer = nalgebra::Vector3::from(state.on_outer.moment);
    let sum = moment + offset.cross(&force) + on_outer;
    // Balls stand in balance to 1e-11 of their load.
    assert!(sum.amax() <= 1e-8 * 250.0 * BORE, "{sum:?} of {on_outer:?}");
    let by_cage: f64 = state.bearing.balls.iter().map(|ball| ball.cage_force.abs()).sum();
    assert!(by_cage * BORE >= 1e-5 * 250.0 * BORE, "the cage has something to do: {by_cage}");
}

/// A scene and the same one turned and moved in the world: mesh, weights, the load on the housing, the race's
/// place and the bearing's frame, by 2 rad about no axis of theirs, so that no rotation is near its inverse.
/// What is seen from the bearing stays, what is seen from the world turns. The race sits in its bore off
/// the frame's own axes already, and what the results say of its seat is the sum over the bore's nodes.
#[test]
fn turning_the_whole_scene_turns_what_the_world_sees() {
    let orientation = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 1.6, -0.9));
    let turn = Pose { position: Vector3::new(0.1, -0.2, 0.3), orientation };
    let small = Pose {
        position: Vector3::new(0.0, 2e-6, -1e-6),
        orientation: UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 2e-4, -1e-4)),
    };
    let vector = |of: [f64; 3], world: &Pose| Vec3::from(world.orientation * Vector3::from(of));
    let fit = fit(2e-6);
    let scene = |world: &Pose| {
        let mut mesh = mesh_of(&RING, &COARSE, Order::Quadratic);
        for node in &mut mesh.nodes {
            *node = world.point_to_parent(&Vector3::from(*node)).into();
        }
        let mut problem = model_of(&mesh, YOUNG).problem;
        problem.gravity = vector([200.0, 3e3, -1e4], world);
        let loaded = mesh.surface_set("bore").unwrap()[0];
        let forces = mesh.face_nodes(loaded).map(|node| (node, vector([40.0, -90.0, 60.0], world)));
        problem.loads.push(Load { forces: forces.collect(), profile: Profile::Constant(1.0) });
        let model = SolidModel::new(problem).unwrap();
        let nominal = small.seen_from_parent_of(world);
        let bore = condense(&model, &bore_of(&mesh), &Reach { nominal, ..reach() }).unwrap();
        let problem = StaticProblem {
            frame: *world,
            outer_pose: nominal,
            ..bearing(loads([20.0, 100.0, -250.0, 0.2, -0.3]))
        };
        let weight = vector([0.0, 3.0, -20.0], world);
        let state = search(&bore).solve(&problem, &fit, weight).unwrap();
        (bore, state)
    };
    let (here, there) = (scene(&Pose::identity()), scene(&turn));
    // Two factorisations in other coordinates.
    const ROUNDING: f64 = 1e-7;
    let near = |a: &[f64], b: &[f64], what: &str| {
        let size = b.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(size > 0.0, "{what}");
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= ROUNDING * size, "{what}: {a:e} {b:e}");
        }
    };
    let turned = |of: Vec3| vector(of, &turn);
    let ((bore, state), (bore_there, state_there)) = (&here, &there);
    let coordinates = |state: &HousedState, from: usize, count: usize| {
        state.bearing.coordinates.as_slice()[from..from + count].to_vec()
    };
    near(&coordinates(state_there, 0, 3), &coordinates(state, 0, 3), "inner race");
    near(&coordinates(state_there, 3, 2), &coordinates(state, 3, 2), "tilts of the inner race");
    near(&state_there.bore.pose[..2], &state.bore.pose[..2], "outer race");
    near(&state_there.bore.pose[2..], &state.bore.pose[2..], "tilts of the outer race");
    near(&state_there.on_outer.force, &state.on_outer.force, "force in the race's axes");
    near(&state_there.on_outer.moment, &state.on_outer.moment, "moment in the race's axes");
    near(&state_there.bore.loads, &state.bore.loads, "loads of nodes");
    let displaced =
        |(bore, state): &(CondensedBore, HousedState)| bore.displacement(&state.bore.loads);
    let (field, field_there) = (displaced(&here), displaced(&there));
    let should: Vec<Vec3> = field.iter().map(|u| turned(*u)).collect();
    near(field_there.as_flattened(), should.as_flattened(), "displacements");
    let [seat, seat_there] =
        [&here, &there].map(|(bore, state)| SeatRow::of_equilibrium(bore, &state.bore));
    near(&seat_there.force, &turned(seat.force), "force on the race");
    near(&seat_there.moment, &turned(seat.moment), "moment on the race");
    let place = |bore: &CondensedBore, state: &HousedState, from: usize| {
        bore.race(&state.bore.pose)[from..from + 3].to_vec()
    };
    let should = turn.point_to_parent(&Vector3::from_row_slice(&place(bore, state, 0)));
    near(&place(bore_there, state_there, 0), should.as_slice(), "place of the outer race");
    let error = geometry_error(bore, &field, &state.bore.pose);
    let error_there = geometry_error(bore_there, &field_there, &state_there.bore.pose);
    // Of the bearing's size in the world, some 1e-16 m are rounding.
    assert!((error_there - error).abs() <= 1e-3 * error, "{error_there:e} {error:e}");
    // The race gets what the nodes do not keep.
    for ((bore, state), seat) in [(&here, seat), (&there, seat_there)] {
        let centre = bore.reach.nominal.position;
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for (node, (_, load)) in bore.nodes.iter().zip(bore.nodal_forces(&state.bore.loads)) {
            let arm = bore.reach.nominal.point_to_parent(&Vector3::from(node.arm)) - centre;
            force -= Vector3::from(load);
            moment -= arm.cross(&Vector3::from(load));
        }
        near(&seat.force, force.as_slice(), "sum of forces");
        near(&seat.moment, moment.as_slice(), "sum of moments");
    }
}

/// In a linear housing under preload a thousandth of the load moves the race a thousandth as far.
#[test]
fn a_small_load_beside_a_large_one_is_not_lost() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let fit = fit(5e-6);
    let sideways = |y: f64| solve(&bore, &fit, &bearing(loads([0.0, y, -250.0, 0.0, 0.0]))).bore;
    let (none, small, large) = (sideways(0.0), sideways(0.1), sideways(100.0));
    assert!((small.load[0] / 0.1 - 1.0).abs() <= 1e-5, "{:?}", small.load);
    let (way, far) = (small.pose[0] - none.pose[0], large.pose[0] - none.pose[0]);
    assert!((1e3 * way / far - 1.0).abs() <= 1e-3, "{way:e} {far:e}");
}

/// A bore that does not give way is a fixed outer race.
#[test]
fn rigid_housing_is_a_fixed_race() {
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e7 * YOUNG);
    let fit = fit(0.0);
    let problem = bearing(loads([0.0, 100.0, -250.0, 0.0, 0.0]));
    let fixed = statics::solve(&problem).unwrap();
    let mut search = HousedSearch::new(&bore, Penalty::PerArea(1e22));
    let held = search.solve(&problem, &fit, [0.0; 3]).unwrap();
    let size = fixed.coordinates[2].abs();
    for i in 0..3 {
        let gap = held.bearing.coordinates[i] - fixed.coordinates[i];
        assert!(gap.abs() <= 1e-6 * size, "{i}: {gap}");
    }
}

/// Loads that drive the inner race make it ride on the outer one: their displacements add up.
#[test]
fn displacements_add_up() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0, 0.0, -250.0, 0.0, 0.0]));
    let fixed = statics::solve(&problem).unwrap();
    let state = solve(&bore, &fit(0.0), &problem);
    let sum = fixed.coordinates[2] + state.bore.pose[1];
    assert!((state.bearing.coordinates[2] / sum - 1.0).abs() <= 1e-5);
    assert!(state.bore.pose[1] < -1e-8 && state.iterations <= 9, "{}", state.iterations);
}

/// A given displacement of the inner race, where bearing and bore are springs in series.
#[test]
fn a_given_displacement_is_shared() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    for interference in [-1e-6, 0.0, 5e-6] {
        let mut conditions = loads([0.0; 5]);
        conditions[2] = Condition::Displacement(-1e-5);
        let state = solve(&bore, &fit(interference), &bearing(conditions));
        let force = state.bearing.loads[2];
        assert!(force < -100.0 && state.residual <= 1e-9, "{force}");
        assert!((state.bore.load[1] / force - 1.0).abs() <= 1e-8);
        // The same force gives the same displacement.
        let back = solve(&bore, &fit(interference), &bearing(loads([0.0, 0.0, force, 0.0, 0.0])));
        assert!((back.bearing.coordinates[2] / -1e-5 - 1.0).abs() <= 1e-7);
    }
}

#[test]
fn an_axial_load_needs_something_that_holds_the_race() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([50.0, 0.0, -250.0, 0.0, 0.0]));
    let free = Fit { axial: Axial::Free, ..fit(0.0) };
    let error = search(&bore).solve(&problem, &free, [0.0; 3]).unwrap_err();
    assert!(
        matches!(error, StaticsError::Seat { source: BoreError::AxialForce { .. }, .. }),
        "{error}"
    );
    assert!((solve(&bore, &fit(0.0), &problem).on_outer.force[0] - 50.0).abs() <= 1e-7);
}
