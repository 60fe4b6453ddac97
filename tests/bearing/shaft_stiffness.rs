//! Stiffness of bearings on one rigid shaft: closed forms of duplex pairs, slopes of loads.

use crate::common;

use bearing_dynamics::ch2_housing::bearing::geometry::BearingGeometry;
use bearing_dynamics::ch2_housing::bearing::hertz::series_stiffness;
use bearing_dynamics::equilibrium::lists::{
    Loaded, Place, StaticAssembly, StaticBearing, StaticBody,
};
use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::members::mount::Mount;
use common::{FREE, problem, table_5_3};
use nalgebra::{Matrix2, Vector2, Vector3};

/// The static pair of angular-contact bearings, half the spacing apart from the shaft's centre, that share
/// a closing of `preload` (m) each; `reversed` tells which of the two is put in the other way round.
fn pair(
    half: f64,
    preload: [f64; 2],
    reversed: [bool; 2],
    conditions: [Condition; 5],
) -> StaticAssembly<'static> {
    let geometry = table_5_3();
    let still = problem(geometry, FREE);
    let loaded = Loaded {
        axes: None,
        conditions,
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: geometry.ball_radius,
    };
    let held =
        |x: f64| Place::Fixed(Pose { position: Vector3::new(x, 0.0, 0.0), ..Pose::identity() });
    let named = |name: &str, place| StaticBody { name: name.into(), place };
    let at = [-half, half];
    let bearings = [0, 1].map(|side| StaticBearing {
        name: Some(["left", "right"][side].into()),
        geometry,
        inner_contact: still.inner_contact,
        outer_contact: still.outer_contact,
        mounts: [
            Mount { body: 0, along: at[side], reversed: reversed[side] },
            Mount { body: 1 + side, along: 0.0, reversed: reversed[side] },
        ],
        azimuths: geometry.azimuths(0.1),
        weight: Vector3::zeros(),
        centrifugal: 0.0,
    });
    StaticAssembly {
        bodies: vec![
            named("the shaft", Place::Loaded(loaded)),
            named("the left outer race", held(at[0] + preload[0])),
            named("the right outer race", held(at[1] + preload[1])),
        ],
        bearings: bearings.into(),
        ..StaticAssembly::default()
    }
}

/// Load and stiffnesses along and across the line of contact of one ball when its inner groove's centre
/// goes by `axial` from where contacts just close: closed form of two Hertz contacts in a row.
struct Squeezed {
    load: f64,
    /// Axial, radial.
    normal: Vector2<f64>,
    stiffness: Matrix2<f64>,
}

fn squeezed(geometry: &BearingGeometry, axial: f64) -> Squeezed {
    let still = problem(*geometry, FREE);
    let k = series_stiffness(still.inner_contact.stiffness, still.outer_contact.stiffness);
    let room =
        geometry.inner.groove_radius + geometry.outer.groove_radius - 2.0 * geometry.ball_radius;
    let between = Vector2::new(
        geometry.inner.centre_axial - geometry.outer.centre_axial + axial,
        geometry.inner.centre_radius - geometry.outer.centre_radius,
    );
    let normal = between.normalize();
    let overlap = between.norm() - room;
    let load = k * overlap * overlap.sqrt();
    let along = 1.5 * k * overlap.sqrt();
    let across = load / between.norm();
    let outer = normal * normal.transpose();
    Squeezed { load, normal, stiffness: outer * along + (Matrix2::identity() - outer) * across }
}

/// Balls unevenly spaced, races closed along the axis: each pushes across it where it is, as much as any other.
#[test]
fn balls_stand_where_they_are_said_to() {
    let geometry = table_5_3();
    let closing = 5e-6;
    let held = [Condition::Displacement(0.0); 5];
    let mut given = pair(12e-3, [-closing, -closing], [false, false], held);
    let azimuths: Vec<f64> =
        (0..geometry.ball_count).map(|ball| 0.02 * (ball * ball) as f64).collect();
    given.bearings[0].azimuths.clone_from(&azimuths);
    let found = solve_assembly(&given, None, &StaticOptions::default()).unwrap();
    let one = squeezed(&geometry, closing);
    let force = found.bearings[0].forces[0];
    // Inwards.
    let across = -one.load * one.normal[1].abs();
    let expected = azimuths.iter().fold([0.0; 2], |[y, z], azimuth| {
        let (sin, cos) = libm::sincos(*azimuth);
        [y + across * cos, z + across * sin]
    });
    let error = (force.y - expected[0]).hypot(force.z - expected[1]);
    // Closed forms of the same contacts; an even spacing would add up to nothing.
    assert!(error <= 1e-8 * expected[0].hypot(expected[1]), "{force} {expected:?}");
}

/// Back to back, face to face and in tandem: axial and tilting stiffness of the pair follow from one ball's
/// stiffness, the contact angle, the pitch and the distance.
#[test]
fn duplex_pairs_have_the_stiffness_of_their_contact_angles_and_distances() {
    let geometry = table_5_3();
    let half = 12e-3;
    let closing = 5e-6;
    // The inner race of a bearing that is not reversed is pushed towards +X, against its outer one, and
    // its lines of contact meet the axis on the side of −X.
    let back_to_back = ([-closing, closing], [false, true]);
    let face_to_face = ([closing, -closing], [true, false]);
    let tandem = ([-closing, -closing], [false, false]);
    let balls = geometry.ball_count as f64;
    let one = squeezed(&geometry, closing);
    let radius = geometry.inner.centre_radius;
    for (name, (preload, reversed)) in
        [("back to back", back_to_back), ("face to face", face_to_face), ("tandem", tandem)]
    {
        let given = pair(half, preload, reversed, [Condition::Displacement(0.0); 5]);
        let found = solve_assembly(&given, None, &StaticOptions::default()).unwrap();
        // What each bearing carries along its axis, on the side that its angle faces.
        let axial = balls * one.load * one.normal[0];
        for (bearing, reversed) in found.bearings.iter().zip(reversed) {
            let expected = if reversed { axial } else { -axial };
            let error = (bearing.forces[0].x - expected).abs() / axial;
            println!("{name}: {} N of {expected}", bearing.forces[0].x);
            // Both are closed forms of the same two contacts; positions are rounded at 1e-12 of overlaps.
            assert!(error <= 1e-9, "{name}: {error:e}");
        }
        let stiffness = |i: usize| found.stiffness[(i, i)];
        let expected = 2.0 * balls * one.stiffness[(0, 0)];
        let error = (stiffness(0) / expected - 1.0).abs();
        println!("{name}: {} of {expected} N/m along the axis", stiffness(0));
        assert!(error <= 1e-9, "{name}: {error:e}");
        // A tilt θ moves the groove's centre over the ball at azimuth φ by θ cos φ along (R, ±half); what
        // its curved path adds to that is the moment of the preload: some δ/R of it.
        let tilting: f64 = [-half, half]
            .into_iter()
            .zip(reversed)
            .map(|(at, reversed)| {
                let facing = if reversed { -1.0 } else { 1.0 };
                let lever = Vector2::new(radius, -facing * at - geometry.inner.centre_axial);
                0.5 * balls * lever.dot(&(one.stiffness * lever))
            })
            .sum();
        let error = (stiffness(4) / tilting - 1.0).abs();
        println!("{name}: {} of {tilting} N m/rad, {error:.1e}", stiffness(4));
        // 7.6e-5, 9.7e-4 and 1.4e-4 of it.
        assert!(error <= 1.2e-3, "{name}: {error:e}");
        assert!((stiffness(3) / stiffness(4) - 1.0).abs() <= 1e-3, "alike about Y and Z");
    }
    // The one thing a pair is chosen for.
    let tilting = |(preload, reversed): ([f64; 2], [bool; 2])| {
        let given = pair(half, preload, reversed, [Condition::Displacement(0.0); 5]);
        solve_assembly(&given, None, &StaticOptions::default()).unwrap().stiffness[(4, 4)]
    };
    assert!(tilting(back_to_back) > 2.0 * tilting(face_to_face));
}

/// Stiffness of the pair against differences of loads, all coordinates shaken.
#[test]
fn the_stiffness_of_a_shaft_is_the_slope_of_its_loads() {
    let at = [2e-6, -3e-6, 4e-6, 1e-4, -1.5e-4];
    let step = [1e-9, 1e-9, 1e-9, 3e-8, 3e-8];
    let load = |q: [f64; 5]| {
        let given = pair(25e-3, [-4e-6, 5e-6], [false, true], q.map(Condition::Displacement));
        solve_assembly(&given, None, &StaticOptions::default()).unwrap()
    };
    let here = load(at);
    for column in 0..5 {
        let moved = |sign: f64| {
            let mut q = at;
            q[column] += sign * step[column];
            load(q).loads[0]
        };
        let slope = (moved(1.0) - moved(-1.0)) / (2.0 * step[column]);
        for row in 0..5 {
            let exact = here.stiffness[(row, column)];
            let scale = (here.stiffness[(row, row)] * here.stiffness[(column, column)]).sqrt();
            let error = (slope[row] - exact).abs() / scale;
            // Differences: (step/overlap)² of the curvature, and rounding of loads over the step.
            assert!(error <= 1e-6, "({row}, {column}): {error:e}");
        }
    }
}
