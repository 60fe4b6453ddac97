//! Whirl of an assembly about its equilibrium against that of the same shaft on supports.

use crate::beam::steel;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::solver::dynamics::assembly::{Assembly, Body, GROUND, Mobility};
use bearing_dynamics::solver::dynamics::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::solver::dynamics::equilibrium::{at_start, static_assembly};
use bearing_dynamics::solver::dynamics::model::{Drive, RaceBody, Rotation};
use bearing_dynamics::solver::dynamics::shaft::ElasticShaft;
use bearing_dynamics::solver::housing::inertia::MovingBody;
use bearing_dynamics::solver::mount::Mount;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::rotor::beam::{Beam, BeamDisc};
use bearing_dynamics::solver::rotor::model::{Rotor, RotorModel, Support};
use bearing_dynamics::solver::rotor::unbalance::Unbalance;
use bearing_dynamics::solver::shaft_shapes::{Kept, free_shaft};
use bearing_dynamics::solver::vibrations::{Whirling, whirling};
use nalgebra::Matrix4;

const SPEED: f64 = 900.0;
const DISC: BeamDisc = BeamDisc { at: 0.4, mass: 3.0, axial: 0.02, transverse: 0.011 };
const STIFFNESS: [f64; 6] = [3e7, 4e7, 2e7, 0.0, 500.0, 800.0];
const DAMPING: [f64; 6] = [10.0, 200.0, 100.0, 0.0, 0.05, 0.02];
/// Where springs hold it, and how much of it brakes bending with the shaft and without.
const PLACES: [f64; 2] = [0.05, 0.3];

fn beam() -> Beam {
    Beam { discs: vec![DISC], ..Beam::new(vec![steel(0.4, 0.03, 0.0)]) }
}

/// Springs between the ground and a shaft with an overhung disc.
fn assembly(internal_damping: f64) -> Assembly {
    let holds = PLACES.map(|at| (at, true));
    let (rigid, shapes) = free_shaft(&beam(), Kept::ALL, &holds, &[]).unwrap();
    let body = |name: &str, mobility, x: f64| Body {
        name: name.into(),
        label: None,
        mobility,
        rest: [x, 0.0, 0.0, 0.0, 0.0],
        rotating_load: None,
        unbalance: 0.0,
    };
    let spinning = RaceBody {
        inertia: Inertia { mass: rigid.mass, axial: rigid.axial, transverse: rigid.transverse },
        drives: [0; 5].map(|_| Drive::Load(Profile::ZERO)),
        rotation: Rotation::Speed(Profile::Constant(SPEED)),
        foundation_stiffness: [0.0; 5],
        foundation_damping: [0.0; 5],
    };
    let springs = PLACES.map(|at| Connection {
        name: "a spring".into(),
        label: None,
        ends: [
            Mount { along: at, ..Mount::at_centre(1) },
            Mount { along: at - rigid.centre, ..Mount::at_centre(0) },
        ],
        law: Law::SpringDashpot(SpringDashpot {
            stiffness: STIFFNESS,
            damping: DAMPING,
            ..SpringDashpot::default()
        }),
    });
    Assembly {
        bodies: vec![
            body("the shaft", Mobility::Driven(spinning.into()), rigid.centre),
            body(GROUND, Mobility::Fixed, 0.0),
        ],
        connections: springs.to_vec(),
        shafts: vec![ElasticShaft { shapes, internal_damping, ..ElasticShaft::default() }],
        ..Assembly::default()
    }
}

fn whirl(assembly: &Assembly) -> Whirling {
    let still = static_assembly(assembly, 0.0, &[]);
    let found = at_start(assembly).unwrap();
    let inertia = *assembly.bodies[0].inertia().unwrap();
    let shaft = MovingBody { body: 0, inertia, free: [true; 5] };
    whirling(assembly, &still, &found, &[shaft], &[]).unwrap()
}

/// Frequencies, damping and directions of a damped, unequally held, spinning shaft with its disc are those of all stations
/// of its beam on the same springs.
#[test]
fn an_assembly_whirls_as_its_shaft_on_supports() {
    let ours = whirl(&assembly(0.0));
    assert_eq!(ours.top_speed, SPEED);
    let [_, ky, kz, _, ty, tz] = STIFFNESS;
    let [_, cy, cz, _, dy, dz] = DAMPING;
    let supports = PLACES.map(|at| Support {
        at,
        stiffness: Matrix4::from_diagonal(&[ky, kz, ty, tz].into()),
        damping: Matrix4::from_diagonal(&[cy, cz, dy, dz].into()),
    });
    let rotor = Rotor { supports: supports.to_vec(), modes: 60, ..Rotor::new(beam()) };
    let theirs = RotorModel::new(&rotor).unwrap();
    for speed in [0.0, SPEED] {
        let across: Vec<_> = ours.model.whirls(speed, 12).unwrap();
        let across: Vec<_> = across.into_iter().filter(|whirl| whirl.across > 0.5).collect();
        for (own, other) in across.iter().zip(&theirs.whirls(speed, 6).unwrap()) {
            let apart = (own.eigenvalue - other.eigenvalue).norm() / other.frequency();
            println!("{} {} {}", own.eigenvalue, other.eigenvalue, own.direction);
            // What 36 and 60 shapes leave out.
            assert!(apart <= 1e-6, "{apart:e}");
            assert!((own.direction - other.direction).abs() <= 1e-3 || speed == 0.0);
        }
        assert!(across.len() >= 6);
    }
    let criticals = |model: &RotorModel| -> Vec<f64> {
        let all = model.critical_speeds().unwrap();
        all.iter().filter(|of| of.whirl.across > 0.5).map(|of| of.speed).take(3).collect()
    };
    for (own, other) in criticals(&ours.model).iter().zip(criticals(&theirs)) {
        assert!((own / other - 1.0).abs() <= 1e-6, "{own} {other}");
    }
}

/// Damping that turns with the shaft brakes its whirl below the critical speed and feeds it above.
#[test]
fn damping_that_turns_along_feeds_whirl_above_the_critical_speed() {
    let mut free = assembly(0.0);
    for connection in &mut free.connections {
        let Law::SpringDashpot(law) = &mut connection.law else { panic!("springs") };
        law.damping = [0.0; 6];
        // Alike either way, so that whirls are circles.
        law.stiffness = [3e7, 3e7, 3e7, 0.0, 500.0, 500.0];
    }
    free.shafts[0].internal_damping = 40.0;
    let ours = whirl(&free);
    let critical = ours.model.critical_speeds().unwrap();
    let first = critical.iter().find(|of| of.whirl.across > 0.5 && of.whirl.is_forward()).unwrap();
    for (part, grows) in [(0.9, false), (0.999, false), (1.001, true), (1.5, true)] {
        let whirls = ours.model.whirls(part * first.speed, 12).unwrap();
        let same = whirls
            .iter()
            .max_by(|a, b| first.whirl.likeness(a).total_cmp(&first.whirl.likeness(b)))
            .unwrap();
        assert_eq!(same.damping_ratio() < 0.0, grows, "{part}: {}", same.eigenvalue);
    }
}

/// A shaft that goes round as it spins does not bend to and fro: what brakes its bending as its spinning material feels it, is not
/// felt by the orbit of an unbalance.
#[test]
fn an_orbit_that_turns_with_the_shaft_feels_no_damping_inside_it() {
    let mut alike = assembly(0.0);
    for connection in &mut alike.connections {
        let Law::SpringDashpot(law) = &mut connection.law else { panic!("springs") };
        law.stiffness = [3e7, 3e7, 3e7, 0.0, 500.0, 500.0];
        law.damping = [10.0, 150.0, 150.0, 0.0, 0.05, 0.05];
    }
    let without = whirl(&alike).model;
    alike.shafts[0].internal_damping = 400.0;
    let with = whirl(&alike).model;
    let (at, speed) = (without.stations[0], 0.8 * SPEED);
    let unbalance = Unbalance { at, moment: 1e-3, angle: 0.4 };
    let orbits = [&without, &with].map(|model| {
        let response = model.response(&[unbalance], speed).unwrap();
        model.orbit(&response, 0).circles()
    });
    let [[forward, backward], [same, _]] = orbits;
    assert!(backward <= 1e-8 * forward, "{backward} {forward} {same}");
    assert!((same / forward - 1.0).abs() <= 1e-9, "{same} {forward}");
}

/// A shaft on springs of its own body, some of its coordinates given: a mass on a spring, whose shapes nothing pushes.
#[test]
fn given_coordinates_take_no_part() {
    let mut shaft = assembly(0.0);
    shaft.connections.clear();
    let race = shaft.bodies[0].driven_mut().unwrap();
    for drive in [0, 3, 4] {
        race.drives[drive] = Drive::Motion(Profile::ZERO);
    }
    race.foundation_stiffness = [0.0, 2e6, 3e6, 0.0, 0.0];
    let mass = race.inertia.mass;
    let still = static_assembly(&shaft, 0.0, &[]);
    let found = at_start(&shaft).unwrap();
    let inertia = *shaft.bodies[0].inertia().unwrap();
    let moving = MovingBody { body: 0, inertia, free: [false, true, true, false, false] };
    let found = whirling(&shaft, &still, &found, &[moving], &[]).unwrap();
    for (natural, stiffness) in found.model.natural.iter().zip([2e6, 3e6f64]) {
        assert!((natural / (stiffness / mass).sqrt() - 1.0).abs() <= 1e-9, "{natural}");
    }
}
