//! Laws of a bearing and its housing in one equilibrium, and of quasi-static courses.

use crate::housing_common;

use bearing_dynamics::ch2_housing::bearing::inertia::{Inertia, hollow_cylinder};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::output::recorder::seat::SeatRow;
use bearing_dynamics::solver::dynamics::model::RotatingLoad;
use bearing_dynamics::solver::housing::bore_equilibrium::{Axial, BoreError, Fit};
use bearing_dynamics::solver::housing::condensed::{
    CondensedBore, Reach, condense, geometry_error,
};
use bearing_dynamics::solver::housing::course_inertia::{
    CourseInertia, CourseLooks, SeatLooks, course_inertia,
};
use bearing_dynamics::solver::housing::housed::{HousedSearch, HousedState, OUTER, lists, moving};
use bearing_dynamics::solver::housing::inertia::{
    InertiaEstimate, Mode, estimate, housing_mass, modes,
};
use bearing_dynamics::solver::housing::quasi_static::{Course, history};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::model::{Load, SolidModel};
use bearing_dynamics::solver::statics::{self, Condition, StaticProblem, StaticsError};
use housing_common::*;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_4, TAU};

fn fit(interference: f64) -> Fit {
    Fit { radius: BORE + interference, axial: Axial::Held }
}

fn search(bore: &CondensedBore) -> HousedSearch<'_> {
    HousedSearch::new(bore, Penalty::default())
}

fn solve(bore: &CondensedBore, fit: &Fit, problem: &StaticProblem) -> HousedState {
    search(bore).solve(problem, fit, [0.0; 3]).unwrap()
}

fn loads(of: [f64; 5]) -> [Condition; 5] {
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

fn one_turn(points: usize) -> Course {
    let speed = 50.0 / 60.0 * TAU;
    Course {
        times: (0..=points).map(|i| 1.2 * i as f64 / points as f64).collect(),
        conditions: [0; 5].map(|_| Profile::ZERO),
        rotating_load: Some(RotatingLoad {
            force: Profile::Constant(250.0),
            speed: Profile::Constant(speed),
            phase: 0.0,
        }),
        shaft_speed: Profile::ZERO,
        interference: Profile::ZERO,
        weight: [0.0; 3],
        centrifugal: false,
    }
}

/// In a ring, under a load that goes round, the eight balls meet it alike in every eighth of a turn.
#[test]
fn a_turning_load_in_a_ring() {
    let bore = condensed(&RING, &COARSE, Order::Quadratic, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let fit = fit(0.0);
    let moments = history(&mut search(&bore), &problem, &fit, &one_turn(8)).unwrap();
    let radii: Vec<f64> =
        moments.iter().map(|m| m.state.bore.pose[0].hypot(m.state.bore.pose[1])).collect();
    for (i, (moment, radius)) in moments.iter().zip(&radii).enumerate() {
        assert!(moment.state.residual <= 1e-9);
        // What the mesh's own lack of symmetry leaves.
        assert!((radius / radii[0] - 1.0).abs() <= 5e-3, "{radii:?}");
        let direction = libm::atan2(moment.state.bore.pose[1], moment.state.bore.pose[0]);
        let off = (direction - FRAC_PI_4 * i as f64).rem_euclid(TAU);
        assert!(off.min(TAU - off) <= 5e-3, "{i}: {off}");
    }
    assert!((radii[8] / radii[0] - 1.0).abs() <= 1e-7, "{radii:?}");
}

/// In steel the path does not know how fast it is gone, and an interference grown in stays.
#[test]
fn rate_and_history_do_not_matter() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let fit = fit(0.0);
    let paths = [0.01, 0.1, 1.0].map(|duration| {
        let mut course = one_turn(1);
        course.rotating_load = None;
        let ramp = |from, to, start: f64, length: f64| Profile::Ramp {
            from,
            to,
            start: start * duration,
            duration: length * duration,
        };
        course.interference = ramp(0.0, 1e-6, 0.0, 0.2);
        course.conditions[2] = ramp(0.0, -250.0, 0.2, 0.8);
        course.times = (0..=5).map(|i| 0.2 * f64::from(i) * duration).collect();
        let moments = history(&mut search(&bore), &problem, &fit, &course).unwrap();
        moments.iter().map(|moment| moment.state.bore.pose[1]).collect::<Vec<f64>>()
    });
    let last = paths[0][5];
    for path in &paths[1..] {
        for (one, other) in path.iter().zip(&paths[0]) {
            assert!((one - other).abs() <= 1e-9 * last.abs(), "{paths:?}");
        }
    }
    let grown = Fit { radius: fit.radius + 1e-6, ..fit };
    let mut pushed = problem.clone();
    pushed.conditions[2] = Condition::Load(-250.0);
    let at_once = solve(&bore, &grown, &pushed);
    assert!((at_once.bore.pose[1] / last - 1.0).abs() <= 1e-8);
}

#[test]
fn balls_roll_with_the_cage() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let fit = fit(0.0);
    let mut course = one_turn(2);
    course.shaft_speed = Profile::Constant(10.0);
    course.centrifugal = true;
    let moments = history(&mut search(&bore), &problem, &fit, &course).unwrap();
    let gamma = problem.geometry.ball_radius / problem.geometry.pitch_radius;
    for moment in &moments {
        let should = 0.5 * (1.0 - gamma) * 10.0 * moment.time;
        assert!((moment.ball_phase - should).abs() <= 1e-12);
    }
    let sums = moments[0]
        .state
        .bearing
        .balls
        .iter()
        .map(|ball| (ball.outer.normal_load, ball.inner.normal_load));
    assert!(sums.clone().all(|(outer, inner)| outer > inner), "{sums:?}");
}

/// With both races of these masses, the inner one free.
fn estimate_of(search: &HousedSearch, state: &HousedState, races: [Inertia; 2]) -> InertiaEstimate {
    let housing = housing_mass(search.bore(), OUTER);
    estimate(&state.stiffness, &moving(races, [true; 5]), &[housing])
}

/// Heavy bodies swing slowly: on one spring with the square root of stiffness over mass. The housing
/// is soft, so that the slowest swing is that of both races in it.
#[test]
fn inertia_of_races_that_outweigh_the_housing() {
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e-4 * YOUNG);
    let problem = bearing(loads([0.0, 0.0, -2.5, 0.0, 0.0]));
    let fit = fit(5e-6);
    let mut search = search(&bore);
    let state = search.solve(&problem, &fit, [0.0; 3]).unwrap();
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let of = |factor: f64| {
        let mut inner = steel;
        inner.mass *= factor;
        inner.transverse *= factor;
        estimate_of(&search, &state, [inner, steel])
    };
    let (one, hundred) = (of(1.0), of(1e4));
    assert!(one.lowest > 50.0 && one.lowest < 1e4, "{one:?}");
    assert!(one.housing_share > 0.0, "{one:?}");
    // The inner race on bearing and housing in series, a matrix of its own.
    let k = state.bearing.stiffness;
    let mut soft = k.try_inverse().unwrap();
    let give = state.bore.stiffness.try_inverse().unwrap();
    for i in 0..4 {
        for j in 0..4 {
            soft[(1 + i, 1 + j)] += give[(i, j)];
        }
    }
    let masses = [1.0, 1.0, 1.0, 0.0, 0.0].map(|m: f64| m * 1e4 * steel.mass);
    let turning = 1e4 * steel.transverse;
    let root = nalgebra::Vector5::from_fn(|i, _| if i < 3 { masses[i] } else { turning }.sqrt());
    let swings = nalgebra::Matrix5::from_fn(|i, j| root[i] * soft[(i, j)] * root[j]);
    let slowest = swings.symmetric_eigenvalues().max();
    let should = 1.0 / slowest.sqrt() / TAU;
    assert!((hundred.lowest / should - 1.0).abs() <= 1e-3, "{} {should}", hundred.lowest);
    let half = hundred.error_at(0.5 * hundred.lowest);
    assert!((half - 0.25).abs() <= 1e-12);
}

/// A load that goes round in a soft ring which never lets go: a circle, slow against its natural motion.
fn circle(turn: f64, damping: f64, corners: Vec<f64>) -> CourseInertia {
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e-2 * YOUNG);
    let fit = fit(5e-6);
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let bodies = moving([steel; 2], [false, true, true, true, true]);
    let seats = vec![SeatLooks { race: OUTER, damping }];
    let looks = CourseLooks { start: 0.0, end: turn, count: 360, corners, bodies, seats };
    let found = course_inertia(&looks, &mut search(&bore).search, |search, time| {
        let angle = TAU * time / turn;
        let problem = bearing(loads([0.0, 2.5 * angle.cos(), 2.5 * angle.sin(), 0.0, 0.0]));
        search.solve(&lists(&problem, &bore, Penalty::default(), &fit, [0.0; 3]))
    });
    found.unwrap()[OUTER]
}

#[test]
fn inertia_along_a_circle_is_that_of_one_mass_on_a_spring() {
    let (slow, fast) = (circle(0.2, 0.0, Vec::new()), circle(0.1, 0.0, Vec::new()));
    for (found, turn) in [(&slow, 0.2), (&fast, 0.1)] {
        let ratio = 1.0 / (turn * found.frequency);
        assert!(ratio < 0.1 && found.kinks == 0, "{found:?}");
        // The other natural motions take some of it, and a period is not nothing of a turn.
        let steady = found.steady / (ratio * ratio * found.swing);
        assert!((0.8..=1.3).contains(&steady), "{steady} {found:?}");
        // Sizes are added: of two equal modes across up to √2, and of the races against each other.
        let start = found.start / (ratio * found.swing);
        assert!((0.9..=2.1).contains(&start), "{start} {found:?}");
        assert_eq!(found.ringing, found.start);
        let bound = found.start + 2.0 * found.steady;
        assert!((found.bound / bound - 1.0).abs() <= 1e-12, "{found:?}");
    }
    // First and second power of the speed.
    assert!((fast.start / slow.start - 2.0).abs() <= 1e-3, "{slow:?} {fast:?}");
    assert!((fast.steady / slow.steady - 4.0).abs() <= 0.2, "{slow:?} {fast:?}");
    // A corner of the load is a kink, though nothing jumps at this one but by what an interval turns.
    let cornered = circle(0.1, 0.0, vec![0.05]);
    assert_eq!(cornered.kinks, 1);
    assert!(cornered.largest_kink > 0.0 && cornered.largest_kink < 0.1 * fast.start);
    // Damping takes the start's ringing before the corner adds to it.
    let damped = circle(0.1, 1e4, vec![0.05]);
    assert!(damped.bound < cornered.bound, "{damped:?}");
    // So little that start and corner together are the most. Mass-proportional, of the housing's part p of what rings: by
    // half of α p, as a swing on a dashpot.
    let damping = 0.2;
    let gently = circle(0.1, damping, vec![0.05]);
    let left = (gently.bound - 2.0 * gently.steady - gently.largest_kink) / gently.start;
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e-2 * YOUNG);
    let mut search = search(&bore);
    let problem = bearing(loads([0.0, 2.5, 0.0, 0.0, 0.0]));
    let state = search.solve(&problem, &fit(5e-6), [0.0; 3]).unwrap();
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let bodies = moving([steel; 2], [false, true, true, true, true]);
    let found = modes(&state.stiffness, &bodies, &[housing_mass(search.bore(), OUTER)]);
    let off = |mode: &Mode| (mode.square.sqrt() / TAU / gently.frequency - 1.0).abs();
    let rings = found.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    assert!(off(rings) <= 1e-6 && rings.housings[0] > 0.0, "{rings:?} {gently:?}");
    let decay = -left.ln() / 0.05;
    let should = 0.5 * damping * rings.housings[0];
    // Of a part in a thousand that is left out of 1, to rounding of 1e-13.
    assert!((decay / should - 1.0).abs() <= 1e-6, "{decay} {should}");
}

/// Balls are where the shaft has rolled them, not where its present speed would have: a shaft that runs up has turned
/// by half of that.
#[test]
fn balls_roll_with_a_shaft_that_runs_up() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let mut course = one_turn(3);
    course.shaft_speed = Profile::Ramp { from: 0.0, to: 12.0, start: 0.0, duration: 1.2 };
    let moments = history(&mut search(&bore), &problem, &fit(0.0), &course).unwrap();
    let gamma = problem.geometry.ball_radius / problem.geometry.pitch_radius;
    for moment in &moments {
        let should = problem.ball_phase + 0.5 * (1.0 - gamma) * 5.0 * moment.time * moment.time;
        // Rounding.
        assert!((moment.ball_phase - should).abs() <= 1e-12, "{} {should}", moment.ball_phase);
    }
}

/// The estimate's coordinates are places and tilts: what a race has about its own axis takes no part. A race hard to tilt
/// swings slowly about either axis across.
#[test]
fn inertia_about_the_axis_is_no_inertia_of_tilts() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0, 0.0, -2.5, 0.0, 0.0]));
    let mut search = search(&bore);
    let state = search.solve(&problem, &fit(5e-6), [0.0; 3]).unwrap();
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let of = |axial: f64, transverse: f64| {
        let mut outer = steel;
        outer.axial *= axial;
        outer.transverse *= transverse;
        estimate_of(&search, &state, [steel, outer])
    };
    assert_eq!(of(1e6, 1.0), of(1.0, 1.0));
    // So heavy that it tilts by itself: a quarter of the frequency for sixteen times the inertia.
    let ratio = of(1.0, 1e6).lowest / of(1.0, 16e6).lowest;
    assert!((ratio - 4.0).abs() <= 1e-3, "{ratio}");
}
