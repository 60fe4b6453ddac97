//! Rubber step by step: cycles against complex stiffness, and how long steps are.

use super::rubber_bodies::{bonded, fixed, network, rubber_of};
use bearing_dynamics::ch2_housing::elastomer::maxwell::{Maxwell, curvature_error};
use bearing_dynamics::ch2_housing::elastomer::named;
use bearing_dynamics::ch3_bushing::hysteresis::{
    Hysteresis, of_complex_stiffness, of_loop, of_steps,
};
use bearing_dynamics::kinematics::strain::{Sym3, double_dot};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};
use std::f64::consts::TAU;

/// A cycle in steps tends with second order to what the complex stiffness says.
#[test]
fn cycles_in_steps_are_the_complex_stiffness() {
    let rubber = rubber_of(network(64.7e6), &[Maxwell { gamma: 2.0, tau: 0.02 }]);
    let amplitude = 1e-7;
    let wave = Profile::Harmonic { mean: 0.0, amplitude, frequency: 10.0, phase: 0.0 };
    let unit = bonded(rubber.clone(), [4, 2, 1], Profile::Constant(1.0)).0;
    let exact = complex_stiffness(&unit, 0.0, &[TAU * 10.0], 1e-10).unwrap()[0];
    let (model, inner) = bonded(rubber, [4, 2, 1], wave);
    let read = |per: usize| {
        let mut solid = RubberSolid::new(&model, fixed(0.1 / per as f64)).unwrap();
        // Seven cycles are thirty-five relaxation times.
        solid.advance(0.7, |_| {}).unwrap();
        let (mut sine, mut cosine) = (0.0, 0.0);
        solid
            .advance(0.8, |solid| {
                let force = solid.support_force(&inner)[2];
                let phase = TAU * 10.0 * solid.time();
                sine += 2.0 / per as f64 * force * phase.sin();
                cosine += 2.0 / per as f64 * force * phase.cos();
            })
            .unwrap();
        assert_eq!(solid.counts.undone, 0);
        [sine / amplitude / exact.storage - 1.0, cosine / amplitude / exact.loss - 1.0]
    };
    let (coarse, fine) = (read(24), read(48));
    for (coarse, fine) in coarse.iter().zip(fine) {
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() <= 0.1, "{coarse:e} {fine:e}");
        assert!(fine.abs() <= 2e-2, "{fine:e}");
    }
}

/// The error of adaptive steps follows what is asked for, and holding still costs little.
#[test]
fn adaptive_steps_keep_their_accuracy() {
    let rubber = named::table_3_1();
    let table = Profile::Ramp { from: 0.0, to: 2e-3, start: 0.0, duration: 1.0 };
    let (model, inner) = bonded(rubber, [4, 2, 1], table);
    let run = |options: StepOptions| {
        let mut solid = RubberSolid::new(&model, options).unwrap();
        let mut read = Vec::new();
        for until in [0.3, 1.0, 2.0, 15.0] {
            solid.advance(until, |_| {}).unwrap();
            read.push(solid.support_force(&inner)[2]);
        }
        (read, solid.counts)
    };
    let accuracy = |a| StepOptions { stepping: Stepping::Accuracy(a), ..Default::default() };
    let (exact, _) = run(accuracy(1e-7));
    let mut counts = Vec::new();
    for asked in [1e-3, 1e-5] {
        let (found, count) = run(accuracy(asked));
        for (found, exact) in found.iter().zip(&exact) {
            // Errors of some ten steps may add up.
            assert!((found / exact - 1.0).abs() <= 10.0 * asked, "{asked}: {found} {exact}");
        }
        counts.push(count.accepted);
    }
    assert!(counts[1] > counts[0] && counts[0] <= 60, "{counts:?}");
}

/// Behind a corner nothing is known of how fast stresses change: the first two steps are judged as one pair, of which only the
/// second is shown.
#[test]
fn a_pair_of_steps_follows_each_corner() {
    let table = vec![[0.0, 0.0], [0.3, 1e-3], [0.8, 2e-3], [1.1, 0.5e-3]];
    let (corners, profile) = (table.len() - 1, Profile::Table { points: table });
    let (model, _) = bonded(named::table_3_1(), [4, 2, 1], profile);
    let options = StepOptions { stepping: Stepping::Accuracy(1e-4), ..Default::default() };
    let mut solid = RubberSolid::new(&model, options).unwrap();
    let mut shown = 0;
    solid.advance(2.0, |_| shown += 1).unwrap();
    // The start is behind a corner too.
    assert_eq!(solid.counts.accepted, shown + corners as u64 + 1);
    assert!(shown > 3 * corners as u64, "{shown}");
}

/// Steps are as long as what they were asked allows and no longer, by the second differences of the stresses at their ends.
#[test]
fn no_step_is_longer_than_its_accuracy_allows() {
    let material = rubber_of(network(100.0e6), &[Maxwell::new(0.7, 0.1).unwrap()]);
    let profile = Profile::Harmonic { mean: 0.0, amplitude: 1e-3, frequency: 1.0, phase: 0.0 };
    let (model, _) = bonded(material, [4, 2, 1], profile);
    let elements = &model.problem.material.maxwell;
    let volumes = || model.tets.iter().flat_map(|tet| tet.points.iter().map(|of| of.volume));
    let mean = |stresses: &mut dyn Iterator<Item = Sym3>| -> f64 {
        let squares = stresses.zip(volumes()).map(|(s, volume)| volume * double_dot(&s, &s));
        (squares.sum::<f64>() / volumes().sum::<f64>()).sqrt()
    };
    let asked = 1e-4;
    let options = StepOptions { stepping: Stepping::Accuracy(asked), ..Default::default() };
    let mut seen: Vec<(f64, Vec<Sym3>)> = Vec::new();
    let (mut scale, mut largest) = (0.0f64, 0.0f64);
    RubberSolid::new(&model, options)
        .unwrap()
        .advance(1.0, |solid| {
            let state = solid.state();
            let total = state.deviatoric.iter().zip(&state.history);
            let total = mean(&mut total.map(|(s, h)| std::array::from_fn(|i| s[i] + h[i])));
            scale = scale.max(total);
            if let [.., (t0, s0), (t1, s1)] = &seen[..] {
                let step = state.time - t1;
                let divided = |k: usize, i: usize| {
                    let slope = (state.deviatoric[k][i] - s1[k][i]) / step;
                    2.0 * (slope - (s1[k][i] - s0[k][i]) / (t1 - t0)) / (state.time - t0)
                };
                let bend = (0..s1.len()).map(|k| std::array::from_fn(|i| divided(k, i)));
                let error = curvature_error(elements, step) * mean(&mut bend.into_iter());
                largest = largest.max(error / (asked * scale));
            }
            seen.push((state.time, state.deviatoric.clone()));
        })
        .unwrap();
    // Times of steps end a last digit before their corners.
    assert!(seen.len() > 20 && largest > 0.5 && largest <= 1.0 + 1e-6, "{largest}, {}", seen.len());
}

/// A second cycle in twelve steps, read by its first harmonic less what the recursion is known to make of it, beside
/// small vibrations of the same mesh; by its largest force and area it is 1 and 8 % off.
#[test]
fn twelve_steps_tell_a_steady_cycle() {
    for frequency in [0.1, 10.0] {
        let (per, amplitude) = (12, 1e-5);
        let wave = Profile::Harmonic { mean: 0.0, amplitude, frequency, phase: 0.25 * TAU };
        let rubber = named::table_3_1();
        let (model, inner) = bonded(rubber.clone(), [4, 2, 1], wave);
        let mut solid =
            RubberSolid::new(&model, fixed(1.0 / (frequency * f64::from(per)))).unwrap();
        let mut points = Vec::new();
        for n in 1..=2 * per {
            let cycles = f64::from(n) / f64::from(per);
            solid.advance(cycles / frequency, |_| {}).unwrap();
            points.push([amplitude * (TAU * cycles).cos(), solid.support_force(&inner)[2]]);
        }
        let second = &points[per as usize..];
        let (unit, _) = bonded(rubber.clone(), [4, 2, 1], Profile::Constant(1.0));
        let answer = complex_stiffness(&unit, 0.0, &[TAU * frequency], 1e-9).unwrap()[0];
        let exact = of_complex_stiffness(answer.storage, answer.loss);
        let off = |found: Hysteresis| {
            let stiffness = found.dynamic_stiffness / exact.dynamic_stiffness - 1.0;
            [stiffness, found.damping_ratio / exact.damping_ratio - 1.0].map(f64::abs)
        };
        let corrected = of_steps(second, &rubber.maxwell, 1.0 / frequency).unwrap().unwrap();
        // The slowest elements' start, and a stiffness that is not quite proportional to the shear modulus.
        let [stiffness, damping] = off(corrected);
        assert!(stiffness <= 5e-3 && damping <= 5e-3, "{frequency}: {stiffness} {damping}");
        let [_, damping] = off(of_loop(second).unwrap());
        assert!(damping > 0.05, "{frequency}: {damping}");
    }
}
