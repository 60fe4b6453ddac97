//! Whirl, modes and critical speeds on springs that relax, against another formulation and roots of their equations.

use crate::assemblies::{ARMS, EVEN, PLACES, SPEED, assembly, beam, two_rigid, whirl};
use crate::single_shaft::{SingleShaft, Support};
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::equilibrium::initial::{at_start, static_assembly};
use bearing_dynamics::equilibrium::quasi_static_limit::MovingBody;
use bearing_dynamics::members::connection::{Law, MaxwellElement};
use bearing_dynamics::vibrations::relaxing::Relaxing;
use bearing_dynamics::vibrations::rotor::{LinearSystem, RotorModel};
use bearing_dynamics::vibrations::small_motions::{natural_modes, whirling};
use bearing_dynamics::vibrations::whirl::Whirl;
use nalgebra::{Complex, DMatrix, Matrix4};

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

pub fn two_on_relaxing(from_ground: bool, backward: f64) -> (Assembly, Vec<MovingBody>) {
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
            let modes = natural_modes(&still, &found, &moving, &[]);
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
        let rotor =
            SingleShaft { supports: supports.to_vec(), modes: 1000, ..SingleShaft::new(beam()) };
        let mut theirs = rotor.model().unwrap();
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
                // What elements pull the shaft into is among the shapes of both; 2e-12 is left.
                assert!(apart <= 1e-9, "{apart:e}");
                assert!((own.direction - other.direction).abs() <= 1e-3);
            }
            assert!(own.len() >= 6 && other.len() >= 6);
        }
    }
}

/// What springs that relax and dashpots pull a shaft into is among its shapes, however few natural motions are kept: rubber is 34 times as stiff
/// at once as relaxed, so that slow motions are none of those of springs that have not relaxed.
#[test]
fn few_shapes_follow_what_brakes_them() {
    let matrices = beam().matrices(&PLACES).unwrap();
    let size = matrices.mass.nrows();
    let (mut stiffness, mut damping) = (matrices.stiffness.clone(), matrices.mass.clone());

    let mut relaxing = Vec::new();
    for (number, at) in PLACES.into_iter().enumerate() {
        let first =
            4 * matrices.stations.iter().position(|place| (place - at).abs() < 1e-9).unwrap();
        for i in 0..2 {
            stiffness[(first + i, first + i)] += 1e6;
            damping[(first + i, first + i)] += if number == 0 { 3e4 } else { 0.0 };
        }
        // Dashpots at one end, rubber at the other: either pulls where nothing else does.
        let elements = if number == 0 { &[][..] } else { &[(4e6, 1e-1), (9e6, 1e-2), (2e7, 1e-3)] };
        for &(k, relaxation_time) in elements {
            let mut levers = DMatrix::zeros(6, size);
            (levers[(1, first)], levers[(2, first + 1)]) = (1.0, 1.0);
            let stiffness = [0.0, k, k, 0.0, 0.0, 0.0];
            relaxing.push(Relaxing { levers, stiffness, relaxation_time, spin: 0.0 });
        }
    }
    let all = LinearSystem {
        stiffness,
        damping,
        gyroscopic: matrices.gyroscopic.clone(),
        circulating: DMatrix::zeros(size, size),
        pairs: (0..size / 2).map(|pair| [2 * pair, 2 * pair + 1]).collect(),
        free: (0..size).collect(),
        relaxing,
        mass: matrices.mass.clone(),
    };
    let whirls = |modes: usize| {
        let model = RotorModel::of(&all, modes, matrices.stations.clone(), None).unwrap();
        model.whirls(SPEED, 8).unwrap()
    };
    // Critical speeds are told by their numbers, however many shapes there are.
    let critical = |modes: usize| {
        let model = RotorModel::of(&all, modes, matrices.stations.clone(), None).unwrap();
        let found = model.critical_speeds_up_to(3.0 * SPEED).unwrap();
        found.iter().map(|of| of.speed).collect::<Vec<_>>()
    };
    let (few, whole) = (critical(18), critical(size));
    assert!(few.len() >= 2 && few.len() == whole.len(), "{few:?} {whole:?}");
    for (few, whole) in few.iter().zip(&whole) {
        assert!((few / whole - 1.0).abs() <= 1e-6, "{few} {whole}");
    }
    let (few, whole) = (whirls(18), whirls(size));
    assert!(size > 60 && whole.len() == 8, "{size}");
    for (few, whole) in few.iter().zip(&whole) {
        let apart = (few.eigenvalue - whole.eigenvalue).norm() / whole.eigenvalue.norm();
        println!("{} {} {apart:e}", few.eigenvalue, whole.eigenvalue);
        // Shapes that answer forces at rest miss by a power of frequency: the slowest by 2e-11, the eighth by 2.5e-7. Without them
        // frequencies by 8e-4 and damping by 0.9 %.
        assert!(apart <= 1e-6, "{apart:e}");
        assert!((few.damping_ratio() / whole.damping_ratio() - 1.0).abs() <= 1e-5);
    }
}
