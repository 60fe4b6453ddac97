//! Whirl of an assembly about its equilibrium against that of the same shaft on supports.

use crate::beam::steel;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::solver::dynamics::assembly::{Assembly, Body, GROUND, Mobility};
use bearing_dynamics::solver::dynamics::connection::{
    Connection, Law, MaxwellElement, SpringDashpot,
};
use bearing_dynamics::solver::dynamics::equilibrium::{at_start, static_assembly};
use bearing_dynamics::solver::dynamics::model::{Drive, RaceBody, Rotation};
use bearing_dynamics::solver::dynamics::shaft::ElasticShaft;
use bearing_dynamics::solver::housing::inertia::MovingBody;
use bearing_dynamics::solver::mount::Mount;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::rotor::beam::{Beam, BeamDisc};
use bearing_dynamics::solver::rotor::model::{Rotor, RotorError, RotorModel, Support};
use bearing_dynamics::solver::rotor::relaxing::Relaxing;
use bearing_dynamics::solver::rotor::unbalance::Unbalance;
use bearing_dynamics::solver::rotor::whirl::Whirl;
use bearing_dynamics::solver::shaft_shapes::{Kept, free_shaft};
use bearing_dynamics::solver::vibrations::{Whirling, natural_motions, whirling};
use nalgebra::{Complex, DMatrix, Matrix2, Matrix4, RowVector2, Vector2};

const SPEED: f64 = 900.0;
const DISC: BeamDisc = BeamDisc { at: 0.4, mass: 3.0, axial: 0.02, transverse: 0.011 };
const STIFFNESS: [f64; 6] = [3e7, 4e7, 2e7, 0.0, 500.0, 800.0];
const DAMPING: [f64; 6] = [10.0, 200.0, 100.0, 0.0, 0.05, 0.02];
/// Where springs hold it, and how much of it brakes bending with the shaft and without.
const PLACES: [f64; 2] = [0.05, 0.3];

fn beam() -> Beam {
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
    let race = RaceBody {
        inertia,
        drives: [0; 5].map(|_| Drive::Load(Profile::ZERO)),
        rotation: Rotation::Speed(Profile::Constant(speed)),
        foundation_stiffness: [0.0; 5],
        foundation_damping: [0.0; 5],
    };
    Mobility::Driven(race.into())
}

/// Springs between the ground and a shaft with an overhung disc.
fn assembly(internal_damping: f64) -> Assembly {
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

const EVEN: [f64; 6] = [1e6, 2e5, 2e5, 0.0, 800.0, 800.0];
const BRAKES: [f64; 6] = [0.0, 100.0, 100.0, 0.0, 0.3, 0.3];
const ARMS: [f64; 2] = [-0.05, 0.12];

/// Two rigid bodies of which one turns the other way round and slower, each on two springs that begin at the ground, or at the body.
fn two_rigid(from_ground: bool, backward: f64) -> (Assembly, Vec<MovingBody>) {
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

const RELAXES: [(f64, f64); 2] = [(3e5, 1e-3), (1e5, 20e-3)];

/// The same with two Maxwell elements beside each spring and in the place of its dashpot, over y + iz, tilt_y + i tilt_z and the
/// elongation s of each: ṡ = ẋ − iω(x − s) − s/τ. With each eigenvalue the part that places and velocities have in it (participation).
fn relaxing_eigenvalues(rigid: &Inertia, speed: f64, turning: f64) -> Vec<(Complex<f64>, f64)> {
    let i = Complex::i();
    let one = |re: f64| Complex::new(re, 0.0);
    let [_, k, _, _, kt, _] = EVEN;
    // Along each arm, then about the centre for each arm.
    let places: Vec<[Complex<f64>; 2]> = ARMS
        .iter()
        .map(|a| [one(1.0), -i * *a])
        .chain(ARMS.iter().map(|_| [one(0.0), one(1.0)]))
        .collect();
    let size = 4 + places.len() * RELAXES.len();
    let masses = [rigid.mass, rigid.transverse];
    let mut whole = DMatrix::<Complex<f64>>::zeros(size, size);
    (0..2).for_each(|j| whole[(j, 2 + j)] = one(1.0));
    whole[(3, 3)] = i * speed * rigid.axial / rigid.transverse;
    let mut at = 4;
    for (number, place) in places.iter().enumerate() {
        let pushes = [place[0].conj(), place[1].conj()];
        let (spring, arm) = if number < 2 { (k, 1.0) } else { (kt, 0.01) };
        for (row, push) in pushes.iter().enumerate() {
            for (column, of) in place.iter().enumerate() {
                whole[(2 + row, column)] -= push * of * spring / masses[row];
            }
        }
        for (stiffness, time) in RELAXES {
            for j in 0..2 {
                whole[(2 + j, at)] = -pushes[j] * (stiffness * arm / masses[j]);
                whole[(at, 2 + j)] = place[j];
                whole[(at, j)] = -i * turning * place[j];
            }
            whole[(at, at)] = i * turning - one(1.0 / time);
            at += 1;
        }
    }
    let triangle = whole.clone().schur().unpack().1;
    let share = |value: Complex<f64>| {
        let apart = &whole - DMatrix::from_diagonal_element(size, size, value);
        let parts = apart.svd(true, true);
        let [left, right] = [parts.u.unwrap().adjoint(), parts.v_t.unwrap()];
        let part = |i: usize| (left[(size - 1, i)] * right[(size - 1, i)].conj()).norm();
        (0..4).map(part).sum::<f64>() / (0..size).map(part).sum::<f64>()
    };
    (0..size).map(|k| (triangle[(k, k)], share(triangle[(k, k)]))).collect()
}

fn two_on_relaxing(from_ground: bool, backward: f64) -> (Assembly, Vec<MovingBody>) {
    let (mut assembly, moving) = two_rigid(from_ground, backward);
    for connection in &mut assembly.connections {
        let Law::SpringDashpot(law) = &mut connection.law else { panic!("springs") };
        law.damping = [0.0; 6];
        let element = |&(k, relaxation_time): &(f64, f64)| MaxwellElement {
            stiffness: [0.0, k, k, 0.0, 0.01 * k, 0.01 * k],
            relaxation_time,
        };
        law.maxwell = RELAXES.iter().map(element).collect();
    }
    (assembly, moving)
}

/// Maxwell elements have states of their own, standing still or turning with a body; motions that only decay are not told.
#[test]
fn maxwell_elements_take_part_in_whirl() {
    let backward = -0.4;
    for from_ground in [true, false] {
        let (assembly, moving) = two_on_relaxing(from_ground, backward);
        let still = static_assembly(&assembly, 0.0, &[]);
        let found = at_start(&assembly).unwrap();
        let ours = whirling(&assembly, &still, &found, &moving, &[]).unwrap();
        let whirls = ours.model.whirls(SPEED, 100).unwrap();
        let (mut grown, mut damped): (usize, f64) = (0, 0.0);
        let mut count = 0;
        for (of, part) in moving.iter().zip([1.0, backward]) {
            let turning = if from_ground { 0.0 } else { part * SPEED };
            let all = relaxing_eigenvalues(&of.inertia, part * SPEED, turning);
            for (expected, share) in all {
                // A motion and its conjugate are one: it is told with a positive frequency.
                let expected = Complex::new(expected.re, expected.im.abs());
                let nearest = whirls.iter().map(|of| (of.eigenvalue - expected).norm());
                let nearest = nearest.fold(f64::INFINITY, f64::min) / expected.norm();
                let told = nearest <= 1e-9;
                println!("{from_ground} {expected} {share} {nearest:e}");
                // Those of the springs are not told, nor what dies out faster than it turns.
                assert!(
                    told || share < 0.6 || expected.im < -expected.re,
                    "{expected}: {nearest:e}"
                );
                assert!(!told || share > 0.4, "{expected} {share}");
                count += usize::from(told);
                grown += usize::from(told && expected.re > 0.0);
                damped = damped.max(if told { -expected.re / expected.norm() } else { 0.0 });
            }
        }
        // And nothing besides.
        let across = whirls.iter().filter(|whirl| whirl.across > 0.5).count();
        assert_eq!(across, count);
        assert!(count >= 8);
        assert_eq!(grown > 0, !from_ground);
        assert!(damped > 0.1, "{damped}");
    }
}

/// Bodies that move along Y and Z alone, by springs that relax: natural frequencies are roots of m ω² = k + Σ k_e (ωτ)²/(1 + (ωτ)²), and so
/// are critical speeds; of springs that turn by a part p of the speed with (1 − p) ω in the place of ω. Relaxed to nothing, too, and where
/// that leaves a motion that does not swing.
#[test]
fn modes_and_critical_speeds_have_what_springs_store() {
    let pair = |element: MaxwellElement, k: f64| (k, vec![element]);
    let one = |k: f64, relaxation_time: f64| MaxwellElement {
        stiffness: [0.0, k, k, 0.0, 0.0, 0.0],
        relaxation_time,
    };
    let both = RELAXES.map(|(k, time)| one(k, time)).to_vec();
    let laws = [
        (EVEN[1], both.clone()),
        (0.0, both),
        // Masses of 2 kg nearly stop swinging, by the last ones wholly.
        pair(one(4e5, 2.236e-3), 1.0),
        pair(one(4e5, 2.2e-3), 1.0),
        pair(one(2e5, 1e-3), 0.0),
    ];
    for (relaxed, elements) in laws {
        for (from_ground, part) in [(true, 0.0), (false, 0.0), (false, 0.5), (false, -0.4)] {
            let (mut assembly, mut moving) = two_on_relaxing(from_ground, part);
            for connection in &mut assembly.connections {
                // Without arms displacements and tilts are apart.
                connection.ends.iter_mut().for_each(|end| end.along = 0.0);
                let Law::SpringDashpot(law) = &mut connection.law else { panic!("springs") };
                (law.stiffness[1], law.stiffness[2]) = (relaxed, relaxed);
                law.maxwell.clone_from(&elements);
            }
            moving.iter_mut().for_each(|of| of.free = [false, true, true, false, false]);
            let still = static_assembly(&assembly, 0.0, &[]);
            let found = at_start(&assembly).unwrap();
            // The largest root, from above; two springs each.
            let root = |mass: f64, seen: f64| -> Option<f64> {
                let excess = |square: f64| {
                    let part = |of: &MaxwellElement| {
                        let turns = square * (seen * of.relaxation_time).powi(2);
                        of.stiffness[1] * turns / (1.0 + turns)
                    };
                    2.0 * (relaxed + elements.iter().map(part).sum::<f64>()) - mass * square
                };
                let (mut above, mut below) = (1e9, 1e9);
                while excess(below) <= 0.0 {
                    if below < 1e-3 {
                        return None;
                    }
                    (above, below) = (below, below * (1.0 - 1e-4));
                }
                for _ in 0..100 {
                    let middle = 0.5 * (below + above);
                    if excess(middle) > 0.0 { below = middle } else { above = middle }
                }
                Some(below.sqrt())
            };
            let masses = moving.iter().map(|of| of.inertia.mass);
            let mut expected: Vec<f64> =
                masses.flat_map(|mass| [root(mass, 1.0).unwrap_or(0.0); 2]).collect();
            expected.sort_by(f64::total_cmp);
            let modes = natural_motions(&still, &found, &moving, &[]);
            let mut swings: Vec<f64> = modes.iter().map(|mode| mode.square.sqrt()).collect();
            swings.sort_by(f64::total_cmp);
            assert_eq!(swings.len(), 4);
            for (found, expected) in swings.iter().zip(&expected) {
                // Where a motion nearly stops swinging the root is one of two that lie close.
                assert!((found - expected).abs() <= 1e-5 * expected, "{found} {expected}");
            }
            let spins = if from_ground { [0.0; 2] } else { [1.0, part] };
            let own = moving.iter().zip(spins);
            let own = own.filter_map(|(of, spin)| root(of.inertia.mass, (1.0 - spin).abs()));
            let mut expected: Vec<f64> = own.flat_map(|speed| [speed; 2]).collect();
            expected.sort_by(f64::total_cmp);
            let whirl = whirling(&assembly, &still, &found, &moving, &[]).unwrap();
            let critical = whirl.critical_speeds(1e4);
            if expected.is_empty() {
                assert!(critical.is_err() || critical.is_ok_and(|none| none.is_empty()));
                continue;
            }
            let critical = critical.unwrap();
            assert_eq!(critical.len(), expected.len(), "{expected:?} {critical:?}");
            for (found, expected) in critical.iter().zip(&expected) {
                let off = (found.speed / expected - 1.0).abs();
                assert!(off <= 1e-5, "{} {expected}", found.speed);
            }
        }
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
    let rotor = Rotor { supports: supports.to_vec(), modes: 60, ..Rotor::new(beam()) };
    let mut theirs = RotorModel::new(&rotor).unwrap();
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

/// Maxwell elements on a shaft that bends, standing still and turning along: all stations of its beam, with the elements there.
#[test]
fn maxwell_elements_take_part_in_whirl_of_a_shaft_that_bends() {
    let element =
        MaxwellElement { stiffness: [0.0, 2e7, 2e7, 0.0, 300.0, 300.0], relaxation_time: 2e-3 };
    for turns in [false, true] {
        let mut own = assembly(0.0);
        for connection in &mut own.connections {
            let Law::SpringDashpot(law) = &mut connection.law else { panic!("springs") };
            law.stiffness = [3e7, 2e7, 2e7, 0.0, 500.0, 500.0];
            law.damping = [0.0; 6];
            law.maxwell = vec![element];
            if turns {
                connection.ends.reverse();
                law.rest[0] = -law.rest[0];
            }
        }
        let ours = whirl(&own).model;
        let supports = PLACES.map(|at| Support {
            at,
            // Shapes are those of springs that have not relaxed.
            stiffness: Matrix4::from_diagonal(&[4e7, 4e7, 800.0, 800.0].into()),
            damping: Matrix4::zeros(),
        });
        let rotor = Rotor { supports: supports.to_vec(), modes: 1000, ..Rotor::new(beam()) };
        let mut theirs = RotorModel::new(&rotor).unwrap();
        for at in PLACES {
            let station =
                theirs.stations.iter().position(|place| (place - at).abs() < 1e-9).unwrap();
            let mut levers = DMatrix::zeros(6, theirs.natural.len());
            for (row, i) in [(1, 0), (2, 1), (4, 2), (5, 3)] {
                levers.row_mut(row).copy_from(&theirs.basis.row(4 * station + i));
            }
            let of = Relaxing {
                levers,
                stiffness: element.stiffness,
                relaxation_time: element.relaxation_time,
                spin: if turns { 1.0 } else { 0.0 },
            };
            theirs.stiffness -= of.storage(f64::INFINITY);
            theirs.relaxing.push(of);
        }
        for speed in [0.3 * SPEED, 2.0 * SPEED] {
            // Motions that the elements brake by more are made of what either set of shapes leaves out of their pulls.
            let swings = |whirl: &Whirl| whirl.across > 0.5 && whirl.damping_ratio() < 0.5;
            let [own, other] = [&ours, &theirs].map(|model| {
                let whirls = model.whirls(speed, 12).unwrap().into_iter();
                whirls.filter(swings).collect::<Vec<_>>()
            });
            for (own, other) in own.iter().zip(&other).take(6) {
                let apart = (own.eigenvalue - other.eigenvalue).norm() / other.frequency();
                println!("{} {} {apart:e}", own.eigenvalue, other.eigenvalue);
                // Static answers follow no pull that has a phase of its own: what our shapes leave out of all stations, most where
                // the elements brake much; 2e-5 at 0.02 of critical damping.
                assert!(apart <= 1e-3, "{apart:e}");
                assert!((own.direction - other.direction).abs() <= 1e-3);
            }
            assert!(own.len() >= 6 && other.len() >= 6);
        }
    }
}
