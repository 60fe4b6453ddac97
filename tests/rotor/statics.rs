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
    let matrices = Beam::new(vec![segment])
        .matrices(&[bearings_at[0], bearings_at[1], load_at])
        .unwrap();
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

#[test]
fn look() {
    for (c, k) in [(0.0, 1.0), (-5e-6, 1.0), (-10e-6, 1.0), (-15e-6, 1.0), (0.0, 1.055), (-5e-6, 1.055), (-10e-6, 1.055), (-15e-6, 1.055)] {
        let s = solve(&assembly(c, k, [0.0, 0.4], 0.2, 3000.0));
        let b = &s.bearings[0];
        eprintln!("{c} {k} {} OR {:?} {:?}", s.iterations, b.forces[1], b.moments[1]);
    }
    for k in [1.0, 1.045] {
        let s = solve(&assembly(0.0, k, [0.0, 0.3], 0.4, 3000.0));
        eprintln!("{} iterations", s.iterations);
        for (i, b) in s.bearings.iter().enumerate() {
            eprintln!("OR {:?} {:?}  IR at {:?}", b.forces[1], b.moments[1], s.coordinates[i]);
        }
    }
}
