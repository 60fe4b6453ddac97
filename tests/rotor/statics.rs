//! An elastic shaft on bearings at rest.

use crate::beam::{E, full, steel};
use crate::common::table_4_1;
use bearing_dynamics::ch2_housing::bearing::geometry::Material;
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzModel, RaceSide, contact};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::solver::mount::Mount;
use bearing_dynamics::solver::rotor::beam::Beam;
use bearing_dynamics::solver::rotor::condensed::StationLoad;
use bearing_dynamics::solver::static_assembly::{
    Loaded, Place, StaticAssembly, StaticBearing, StaticBody, StaticShaft,
};
use bearing_dynamics::solver::statics::{
    AssemblySolution, Condition, StaticOptions, solve_assembly,
};
use nalgebra::{UnitQuaternion, Vector3};

fn at(x: f64) -> Pose {
    Pose { position: Vector3::new(x, 0.0, 0.0), orientation: UnitQuaternion::identity() }
}

fn on_shaft(name: &str, x: f64, conditions: [Condition; 5]) -> StaticBody {
    let place = Place::Loaded(Loaded {
        axes: Some(Box::new(at(x))),
        conditions,
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: None,
        room: 5e-3,
    });
    StaticBody { name: name.into(), place }
}

const FREE: [Condition; 5] = [Condition::Load(0.0); 5];

fn down(force: f64) -> [Condition; 5] {
    let mut loads = FREE;
    loads[2] = Condition::Load(-force);
    loads
}

/// The shaft of Table 4.1 on its bearings at two places, loaded downwards at a third.
fn assembly(
    clearance: f64,
    stiffer: f64,
    bearings_at: [f64; 2],
    load_at: f64,
    force: f64,
) -> StaticAssembly<'static> {
    let mut segment = steel(0.4, 0.03, 0.0);
    segment.youngs_modulus *= stiffer;
    let matrices =
        Beam::new(vec![segment]).matrices(&[bearings_at[0], bearings_at[1], load_at]).unwrap();
    let places = [bearings_at[0], bearings_at[1], load_at];
    let stations = places.map(|x| matrices.station(x).unwrap());
    let condensed = matrices.condensed(&stations, &[]).unwrap();
    let geometry = table_4_1(clearance);
    let side = |side| {
        contact(HertzModel::HamrockBrewe, side, &geometry, &Material::STEEL, &Material::STEEL)
            .unwrap()
    };
    let bearing = |index: usize| StaticBearing {
        name: Some(["left", "right"][index].into()),
        geometry,
        inner_contact: side(RaceSide::Inner),
        outer_contact: side(RaceSide::Outer),
        mounts: [Mount::at_centre(index), Mount::at_centre(3 + index)],
        ball_phase: 0.0,
        weight: Vector3::zeros(),
        centrifugal: 0.0,
    };
    let held = |x| StaticBody { name: "an outer race".into(), place: Place::Held(at(x)) };
    StaticAssembly {
        bodies: vec![
            on_shaft("the left inner race", bearings_at[0], FREE),
            on_shaft("the right inner race", bearings_at[1], FREE),
            on_shaft("the loaded section", load_at, down(force)),
            held(bearings_at[0]),
            held(bearings_at[1]),
        ],
        bearings: vec![bearing(0), bearing(1)],
        shafts: vec![StaticShaft {
            bodies: vec![0, 1, 2],
            stiffness: condensed.stiffness,
            loads: condensed.loads,
        }],
        ..StaticAssembly::default()
    }
}

fn solve(assembly: &StaticAssembly) -> AssemblySolution {
    solve_assembly(assembly, None, &StaticOptions::default()).unwrap()
}

/// A shaft on two springs, loaded at mid-span: springs, bending and shear in series.
#[test]
fn a_shaft_on_springs_bends_as_beam_theory_says() {
    let mut on_springs = assembly(0.0, 1.0, [0.0, 0.4], 0.2, 3000.0);
    on_springs.bearings.clear();
    for body in &mut on_springs.bodies[..2] {
        let Place::Loaded(loaded) = &mut body.place else { panic!("loaded") };
        loaded.springs = [1e8, 1e8, 5e7, 0.0, 0.0];
    }
    let solution = solve(&on_springs);
    let [_, moment, shear] = full(0.03);
    let ends = -1500.0 / 5e7;
    let bent = -3000.0 * (0.4f64.powi(3) / (48.0 * E * moment) + 0.4 / (4.0 * shear));
    let turn = 3000.0 * 0.4 * 0.4 / (16.0 * E * moment);
    // Without bearings tilts are over a metre, and the search ends earlier in what is soft.
    for (ours, theirs) in [
        (solution.coordinates[0][2], ends),
        (solution.coordinates[2][2], ends + bent),
        (solution.coordinates[0][3], turn),
        (solution.coordinates[1][3], -turn),
    ] {
        assert!((ours / theirs - 1.0).abs() <= 1e-8, "{ours} {theirs}");
    }
}

/// The forces of both bearings on the shaft and its load cancel, and a load between the stations that were kept does what
/// it does at one.
#[test]
fn loads_between_stations_are_felt_at_them() {
    let kept = assembly(0.0, 1.0, [0.0, 0.3], 0.4, 3000.0);
    let solution = solve(&kept);
    let forces = |of: &AssemblySolution| [0, 1].map(|i| of.bearings[i].forces[0]);
    let [left, right] = forces(&solution);
    assert!((left.z + right.z - 3000.0).abs() <= 1e-6 && (left.x + right.x).abs() <= 1e-6);

    let matrices = Beam::new(vec![steel(0.4, 0.03, 0.0)]).matrices(&[0.3]).unwrap();
    let stations = [0.0, 0.3].map(|x| matrices.station(x).unwrap());
    let load =
        StationLoad { station: matrices.stations.len() - 1, load: [0.0, 0.0, -3000.0, 0.0, 0.0] };
    let condensed = matrices.condensed(&stations, &[load]).unwrap();
    let mut gone = kept.clone();
    gone.shafts[0] =
        StaticShaft { bodies: vec![0, 1], stiffness: condensed.stiffness, loads: condensed.loads };
    // The section keeps its place in the list, held, on no shaft.
    gone.bodies[2].place = Place::Held(at(0.4));
    let other = solve(&gone);
    for (one, other) in forces(&solution).iter().zip(forces(&other)) {
        assert!((one - other).norm() <= 1e-6, "{one} {other}");
    }
    // Nothing holds a shaft of which no station is kept.
    assert_eq!(matrices.condensed(&[], &[]), None);
}

/// A shaft that bends ten thousand times less carries its bearings as a rigid body does.
#[test]
fn a_stiff_shaft_is_a_rigid_body() {
    let stiff = solve(&assembly(-5e-6, 1e4, [0.0, 0.3], 0.4, 3000.0));
    let mut rigid = assembly(-5e-6, 1.0, [0.0, 0.3], 0.4, 3000.0);
    rigid.shafts.clear();
    let mut conditions = down(3000.0);
    // About the left race: a force down at 0.4 m turns towards +Y.
    conditions[3] = Condition::Load(3000.0 * 0.4);
    rigid.bodies[0] = on_shaft("the shaft", 0.0, conditions);
    for section in [1, 2] {
        rigid.bodies[section].place = Place::Held(at(0.0));
    }
    rigid.bearings[1].mounts[0] = Mount { body: 0, along: 0.3, reversed: false };
    let rigid = solve(&rigid);
    for i in 0..2 {
        let [stiff, rigid] = [&stiff, &rigid].map(|of| &of.bearings[i]);
        let force = (stiff.forces[1] - rigid.forces[1]).norm() / rigid.forces[1].norm();
        let moment = (stiff.moments[1] - rigid.moments[1]).norm() / rigid.moments[1].norm();
        assert!(force <= 1e-3 && moment <= 1e-2, "{i}: {force:e} {moment:e}");
    }
}
