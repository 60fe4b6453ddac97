//! A bushing reduced to springs that relax, against its own vibrations and against implicit steps.

use crate::rubber_bodies::{bonded, bushing_mesh, network, rubber_of, scatter};
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::ch2_housing::elastomer::named;
use bearing_dynamics::members::connection::SpringDashpot;
use bearing_dynamics::members::prony::{bushing_spring, nonnegative};
use bearing_dynamics::mesh::generate::Part;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::rubber::sleeve::{SleeveMotion, sleeve_stiffness};
use bearing_dynamics::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

const CELLS: [usize; 3] = [6, 4, 3];

/// What no better choice can have: no slope down for what is held at zero, none at all for the rest.
#[test]
fn least_squares_without_negative_parts_has_no_way_down() {
    let mut seed = 4;
    for size in 1..20 {
        let rows = 2 * size + 3;
        let a = DMatrix::from_fn(rows, size, |_, _| scatter(&mut seed) + 0.3);
        let b = DVector::from_fn(rows, |_, _| scatter(&mut seed));
        let x = nonnegative(&a, &b);
        let slope = a.transpose() * (&b - &a * &x);
        let scale = a.norm() * b.norm();
        for j in 0..size {
            assert!(x[j] >= 0.0, "{}", x[j]);
            let off = if x[j] > 0.0 { slope[j].abs() } else { slope[j] };
            assert!(off <= 1e-12 * scale, "{size} {j}: {off:e}");
        }
    }
    // What none of them can approach is left alone.
    let against = nonnegative(&DMatrix::from_element(3, 2, 1.0), &DVector::from_element(3, -1.0));
    assert_eq!(against.as_slice(), [0.0, 0.0]);
}

#[test]
fn a_bushing_is_a_spring_that_relaxes() {
    let material = named::table_3_1();
    let mesh = bushing_mesh(CELLS);
    let fastest = TAU * 1000.0;
    let spring = bushing_spring(&mesh, Part::Quarter, &material, fastest).unwrap();
    let SpringDashpot { stiffness, maxwell, damping, .. } = &spring.law;
    println!("{} elements, misses {:?}", maxwell.len(), spring.misses);
    assert_eq!(*damping, [0.0; 6]);
    assert!(maxwell.len() <= 40 && maxwell.iter().all(|of| of.stiffness.iter().all(|k| *k >= 0.0)));
    // Eight times τ a decade; the axial motion is missed most, by 4e-5.
    assert!(spring.misses.iter().all(|miss| *miss <= 2e-4), "{:?}", spring.misses);
    // Another mesh of answers: at frequencies that were neither fitted nor judged.
    for (motion, component) in SleeveMotion::ALL.into_iter().zip([2, 0, 3, 4]) {
        let pulsations = [0.0, TAU * 0.137, TAU * 7.7, TAU * 313.0];
        let answers =
            sleeve_stiffness(&mesh, Part::Quarter, material.clone(), motion, &pulsations, 1e-8);
        for (answer, pulsation) in answers.unwrap().iter().zip(pulsations) {
            let (mut storage, mut loss) = (stiffness[component], 0.0);
            for of in maxwell {
                let turned = pulsation * of.relaxation_time;
                storage += of.stiffness[component] * turned * turned / (1.0 + turned * turned);
                loss += of.stiffness[component] * turned / (1.0 + turned * turned);
            }
            let error = (storage - answer.storage).hypot(loss - answer.loss);
            let size = answer.storage.hypot(answer.loss);
            assert!(error <= 2e-4 * size, "{motion:?} {pulsation}: {:e}", error / size);
        }
    }
}

/// Pushed aside by a micrometre in 10 ms and held, by implicit steps of the whole solid.
#[test]
fn a_reduced_bushing_is_pushed_aside_as_the_solid_is() {
    let material = named::table_3_1();
    let spring =
        bushing_spring(&bushing_mesh(CELLS), Part::Quarter, &material, TAU * 10e3).unwrap().law;
    let (rise, far) = (10e-3, 1e-6);
    let ramp = Profile::Ramp { from: 0.0, to: far, start: 0.0, duration: rise };
    let (model, inner) = bonded(material, CELLS, ramp);
    let options = StepOptions { stepping: Stepping::Accuracy(1e-4), ..Default::default() };
    let mut solid = RubberSolid::new(&model, options).unwrap();
    let mut worst = 0.0f64;
    for end in [2e-3, 10e-3, 15e-3, 50e-3, 0.3] {
        solid.advance(end, |_| {}).unwrap();
        let force = 4.0 * solid.support_force(&inner)[2];
        // v K τ (1 − exp(−t/τ)) while it rises, and that of a fall from its end on.
        let answer = |time: f64, relaxation_time: f64| {
            relaxation_time * (1.0 - (-time.max(0.0) / relaxation_time).exp())
        };
        let relaxing = spring.maxwell.iter().map(|of| {
            let time = of.relaxation_time;
            of.stiffness[2] * (answer(end, time) - answer(end - rise, time))
        });
        let expected = spring.stiffness[2] * end.min(rise) + relaxing.sum::<f64>();
        let expected = far / rise * expected;
        println!("{end} s: {force} N, reduced {expected} N");
        worst = worst.max((force / expected - 1.0).abs());
    }
    assert!(worst <= 5e-4, "{worst:e}");
}

/// Few elements, so that the bushing's own times lie between and beyond them: with γ of 10 up to some τ(1 + γ).
#[test]
fn a_bushing_relaxes_more_slowly_than_its_rubber() {
    for elements in
        [&[[1.0, 0.01]][..], &[[10.0, 0.01]], &[[100.0, 0.01]], &[[5.0, 0.01], [5.0, 1.3e-3]]]
    {
        let maxwell: Vec<Maxwell> =
            elements.iter().map(|[gamma, tau]| Maxwell::new(*gamma, *tau).unwrap()).collect();
        let material = rubber_of(network(64.7e6), &maxwell);
        let spring = bushing_spring(&bushing_mesh(CELLS), Part::Quarter, &material, TAU * 1e3);
        let misses = spring.unwrap().misses;
        println!("{elements:?}: {misses:?}");
        assert!(misses.iter().all(|miss| *miss <= 1e-3), "{elements:?}: {misses:?}");
    }
}

#[test]
fn pulsations_that_are_none_are_refused() {
    let material = named::table_3_1();
    let mesh = bushing_mesh([4, 2, 2]);
    for fastest in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = bushing_spring(&mesh, Part::Quarter, &material, fastest).unwrap_err();
        assert!(error.to_string().contains("fastest pulsation"), "{error}");
    }
}

#[test]
fn rubber_that_does_not_relax_is_a_spring() {
    let material = rubber_of(network(64.7e6), &[]);
    let spring = bushing_spring(&bushing_mesh([4, 2, 2]), Part::Quarter, &material, 1e3).unwrap();
    assert_eq!(spring.law.maxwell, []);
    assert!(spring.misses.iter().all(|miss| *miss <= 1e-12), "{:?}", spring.misses);
}
