//! Whirl of an assembly about its equilibrium against that of the same shaft on supports.

use crate::beam::steel;
use crate::relaxing::two_on_relaxing;
use crate::single_shaft::{SingleShaft, Support, Unbalance, orbit, response};
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::equilibrium::initial::{at_start, static_assembly};
use bearing_dynamics::equilibrium::quasi_static_limit::MovingBody;
use bearing_dynamics::members::beam::{Beam, BeamDisc};
use bearing_dynamics::members::body::{Body, Drive, DrivenBody, GROUND, Mobility, Rotation};
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::flexible_shaft::ElasticShaft;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::shaft_modes::{Kept, free_shaft};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::vibrations::rotor::{RotorError, RotorModel};
use bearing_dynamics::vibrations::small_motions::{SmallMotionModel, whirling};
use nalgebra::{Complex, DMatrix, Matrix2, Matrix4, RowVector2, Vector2};

pub const SPEED: f64 = 900.0;
const DISC: BeamDisc = BeamDisc { at: 0.4, mass: 3.0, axial: 0.02, transverse: 0.011 };
const STIFFNESS: [f64; 6] = [3e7, 4e7, 2e7, 0.0, 500.0, 800.0];
const DAMPING: [f64; 6] = [10.0, 200.0, 100.0, 0.0, 0.05, 0.02];
/// Where springs hold it, and how much of it brakes bending with the shaft and without.
pub const PLACES: [f64; 2] = [0.05, 0.3];

pub fn beam() -> Beam {
    Beam { discs: vec![DISC], ..Beam::new(vec![steel(0.4, 0.03, 0.0)]) }
}

fn body(name: &str, mobility: Mobility, x: f64) -> Body {
    Body {
        name: name.into(),
        label: None,
        mobility,
        rest: [x, 0.0, 0.0, 0.0, 0.0],
        rotating_load: None,
        unbalance: 0.0,
    }
}

/// Spins as given, free otherwise.
fn spinning(inertia: Inertia, speed: f64) -> Mobility {
    let race = DrivenBody {
        inertia,
        drives: [0; 5].map(|_| Drive::Load(Profile::ZERO)),
        rotation: Rotation::Speed(Profile::Constant(speed)),
        foundation_stiffness: [0.0; 5],
        foundation_damping: [0.0; 5],
    };
    Mobility::Driven(race.into())
}

/// Springs between the ground and a shaft with an overhung disc.
pub fn assembly(internal_damping: f64) -> Assembly {
    let holds = PLACES.map(|at| (at, true));
    let (rigid, shapes) = free_shaft(&beam(), Kept::ALL, &holds, &[]).unwrap();
    let inertia = Inertia { mass: rigid.mass, axial: rigid.axial, transverse: rigid.transverse };
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
            body("the shaft", spinning(inertia, SPEED), rigid.centre),
            body(GROUND, Mobility::Fixed, 0.0),
        ],
        connections: springs.to_vec(),
        shafts: vec![ElasticShaft { shapes, internal_damping, ..ElasticShaft::default() }],
        ..Assembly::default()
    }
}

pub fn whirl(assembly: &Assembly) -> SmallMotionModel {
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
    let rotor = SingleShaft { supports: supports.to_vec(), modes: 60, ..SingleShaft::new(beam()) };
    let theirs = rotor.model().unwrap();
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
    // Rounding damps nothing, and feeds nothing: to the bit, and not as −0.
    free.shafts[0].internal_damping = 0.0;
    let whirls = whirl(&free).model.whirls(1.5 * first.speed, 30).unwrap();
    assert_eq!(whirls.len(), 30);
    for whirl in whirls {
        assert_eq!(whirl.damping_ratio().to_bits(), 0, "{}", whirl.eigenvalue);
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
        let response = response(model, &[unbalance], speed).unwrap();
        orbit(model, &response, 0).circles()
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

/// A rigid body with two springs, some way off its centre, over y + iz and tilt_y + i tilt_z of circles: the eigenvalues of
/// m r̈ + Σ (k + c (d/dt − iω)) r_a = 0 with r_a = r − i a φ, and of the moments alike; ω is the spin of what the dashpots turn with.
fn eigenvalues(rigid: &Inertia, speed: f64, turning: f64) -> Vec<Complex<f64>> {
    let [_, k, _, _, kt, _] = EVEN;
    let [_, c, _, _, ct, _] = BRAKES;
    let i = Complex::i();
    let one = |re: f64| Complex::new(re, 0.0);
    let mut stiffness = Matrix2::<Complex<f64>>::zeros();
    let mut damping = Matrix2::<Complex<f64>>::zeros();
    for a in ARMS {
        // The force at the place r_a, and its moment i a F about the centre.
        let place = RowVector2::new(one(1.0), -i * a);
        let pushes = Vector2::new(one(1.0), i * a);
        stiffness += pushes * place * (one(k) - i * turning * c);
        damping += pushes * place * one(c);
        stiffness[(1, 1)] += one(kt) - i * turning * ct;
        damping[(1, 1)] += one(ct);
    }
    damping[(1, 1)] -= i * speed * rigid.axial;
    let per_mass = Matrix2::from_diagonal(&Vector2::new(1.0 / rigid.mass, 1.0 / rigid.transverse));
    let per_mass = per_mass.map(one);
    let mut whole = DMatrix::<Complex<f64>>::zeros(4, 4);
    whole.view_mut((0, 2), (2, 2)).copy_from(&Matrix2::identity());
    whole.view_mut((2, 0), (2, 2)).copy_from(&(-per_mass * stiffness));
    whole.view_mut((2, 2), (2, 2)).copy_from(&(-per_mass * damping));
    let triangle = whole.schur().unpack().1;
    (0..4).map(|k| triangle[(k, k)]).collect()
}

pub const EVEN: [f64; 6] = [1e6, 2e5, 2e5, 0.0, 800.0, 800.0];
const BRAKES: [f64; 6] = [0.0, 100.0, 100.0, 0.0, 0.3, 0.3];
pub const ARMS: [f64; 2] = [-0.05, 0.12];

/// Two rigid bodies of which one turns the other way round and slower, each on two springs that begin at the ground, or at the body.
pub fn two_rigid(from_ground: bool, backward: f64) -> (Assembly, Vec<MovingBody>) {
    let inertia = [
        Inertia { mass: 2.0, axial: 4e-3, transverse: 5e-3 },
        Inertia { mass: 3.0, axial: 2e-3, transverse: 7e-3 },
    ];
    let springs = [0, 1].into_iter().flat_map(|of| {
        ARMS.map(|along| {
            let mut ends = [of, 2].map(|body| Mount { along, ..Mount::at_centre(body) });
            if from_ground {
                ends.reverse();
            }
            let law =
                SpringDashpot { stiffness: EVEN, damping: BRAKES, ..SpringDashpot::default() };
            Connection { name: "a spring".into(), label: None, ends, law: Law::SpringDashpot(law) }
        })
    });
    let assembly = Assembly {
        connections: springs.collect(),
        bodies: vec![
            body("one", spinning(inertia[0], SPEED), 0.0),
            body("other", spinning(inertia[1], backward * SPEED), 0.0),
            body(GROUND, Mobility::Fixed, 0.0),
        ],
        ..Assembly::default()
    };
    let moving = [0, 1].map(|body| MovingBody { body, inertia: inertia[body], free: [true; 5] });
    (assembly, moving.to_vec())
}

/// Dashpots that begin at a body turn with it; from the ground they stand still. Closed forms of rigid bodies, one of
/// which turns backward.
#[test]
fn dashpots_turn_with_the_body_that_they_begin_at() {
    let backward = -0.4;
    for from_ground in [true, false] {
        let (assembly, moving) = two_rigid(from_ground, backward);
        let still = static_assembly(&assembly, 0.0, &[]);
        let found = at_start(&assembly).unwrap();
        let ours = whirling(&assembly, &still, &found, &moving, &[]).unwrap();
        let whirls = ours.model.whirls(SPEED, 20).unwrap();
        let mut grown = 0;
        for (of, part) in moving.iter().zip([1.0, backward]) {
            let turning = if from_ground { 0.0 } else { part * SPEED };
            for expected in eigenvalues(&of.inertia, part * SPEED, turning) {
                // A motion and its conjugate are one: it is told with a positive frequency.
                let expected = Complex::new(expected.re, expected.im.abs());
                let nearest = whirls.iter().map(|of| (of.eigenvalue - expected).norm());
                let nearest = nearest.fold(f64::INFINITY, f64::min) / expected.norm();
                println!("{from_ground} {expected} {nearest:e}");
                assert!(nearest <= 1e-9, "{expected}: {nearest:e}");
                grown += usize::from(expected.re > 0.0);
            }
        }
        assert_eq!(grown > 0, !from_ground);
    }
}

/// Springs that turn and differ across have no frequencies about an equilibrium.
#[test]
fn uneven_springs_that_turn_are_refused() {
    for relaxing in [false, true] {
        let (mut assembly, moving) =
            if relaxing { two_on_relaxing(false, 0.0) } else { two_rigid(false, 0.0) };
        let Law::SpringDashpot(law) = &mut assembly.connections[1].law else { panic!("springs") };
        match relaxing {
            false => law.damping[5] *= 2.0,
            true => law.maxwell[1].stiffness[1] *= 2.0,
        }
        let still = static_assembly(&assembly, 0.0, &[]);
        let found = at_start(&assembly).unwrap();
        let refused = whirling(&assembly, &still, &found, &moving, &[]);
        assert!(matches!(refused, Err(RotorError::Uneven { .. })), "{:?}", refused.err());
        // At the body that stands still they may.
        assembly.connections[1].ends.reverse();
        assert!(whirling(&assembly, &still, &found, &moving, &[]).is_ok());
    }
}

/// The same on a shaft that bends: all stations of its beam, with what each dashpot does as it turns along.
#[test]
fn dashpots_turn_with_the_shaft_that_they_begin_at() {
    let mut own = assembly(0.0);
    for connection in &mut own.connections {
        connection.ends.reverse();
        let Law::SpringDashpot(law) = &mut connection.law else { panic!("springs") };
        (law.stiffness, law.damping) = ([3e7, 2e7, 2e7, 0.0, 500.0, 500.0], BRAKES);
        law.rest[0] = -law.rest[0];
    }
    let ours = whirl(&own).model;
    let supports = PLACES.map(|at| Support {
        at,
        stiffness: Matrix4::from_diagonal(&[2e7, 2e7, 500.0, 500.0].into()),
        damping: Matrix4::from_diagonal(&[BRAKES[1], BRAKES[1], BRAKES[4], BRAKES[4]].into()),
    });
    let rotor = SingleShaft { supports: supports.to_vec(), modes: 60, ..SingleShaft::new(beam()) };
    let mut theirs = rotor.model().unwrap();
    for at in PLACES {
        let station = theirs.stations.iter().position(|place| (place - at).abs() < 1e-9).unwrap();
        let row = |i: usize| theirs.basis.row(4 * station + i).into_owned();
        let mut along = DMatrix::zeros(theirs.natural.len(), theirs.natural.len());
        for (y, damping) in [(0, BRAKES[1]), (2, BRAKES[4])] {
            along += (row(y).transpose() * row(y + 1) - row(y + 1).transpose() * row(y)) * damping;
        }
        theirs.circulating += along;
    }
    let mut grown = 0;
    for speed in [0.3 * SPEED, 2.0 * SPEED] {
        let across = ours.whirls(speed, 12).unwrap();
        let across: Vec<_> = across.into_iter().filter(|whirl| whirl.across > 0.5).collect();
        for (own, other) in across.iter().zip(&theirs.whirls(speed, 6).unwrap()) {
            let apart = (own.eigenvalue - other.eigenvalue).norm() / other.frequency();
            println!("{} {}", own.eigenvalue, other.eigenvalue);
            // What 36 and 60 shapes leave out, more of the sixth motion.
            assert!(apart <= 2e-6, "{apart:e}");
            grown += usize::from(own.eigenvalue.re > 0.0);
        }
        assert!(across.len() >= 6);
    }
    assert!(grown > 0);
}
