//! The bushing of 3.4.1: what its relaxed stiffness and its cycles cost, by elements, meshes and steps.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch3_bushing::hysteresis::{
    Hysteresis, first_harmonic, of_complex_stiffness, of_loop, of_steps,
};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::sleeve::SleeveMotion;

use crate::bushings::{
    BUSHING, MODULUS, bonded, exact, four_nodes, of_quarter, quarter, rubber, shear_over_modulus,
    steady_loop,
};
use crate::case::CaseError;
use crate::pareto::{ParetoContext, Point, Stopwatch, Study, cheapest_ways};

pub const RELAXED: Study = Study {
    id: "rubber_relaxed_stiffness",
    title: "Bushing of 3.4.1, relaxed radial stiffness",
    error_label: "error of the stiffness",
    more_errors: &[],
    run: relaxed,
};

pub const SLOW: Study = Study {
    id: "rubber_cycle_0p1_hz",
    title: "Bushing of 3.4.1, steady cycle at 0.1 Hz",
    error_label: "error of the dynamic stiffness",
    more_errors: &["error of the damping ratio", "the larger of both"],
    run: |context| cycle(context, 0.1),
};

pub const FAST: Study = Study {
    id: "rubber_cycle_10_hz",
    title: "Bushing of 3.4.1, steady cycle at 10 Hz",
    error_label: "error of the dynamic stiffness",
    more_errors: &["error of the damping ratio", "the larger of both"],
    run: |context| cycle(context, 10.0),
};

const MESHES: [[usize; 3]; 5] = [[4, 2, 1], [6, 4, 2], [8, 4, 3], [12, 6, 4], [16, 8, 5]];
const GRADING: f64 = 2.0;
/// Small, so that the oracle's linear cycle is the truth; m.
const AMPLITUDE: f64 = 1e-5;

fn off(ours: f64, exact: f64) -> f64 {
    (ours / exact - 1.0).abs()
}

fn timed<T>(mut compute: impl FnMut() -> Result<T, CaseError>) -> Result<(f64, T), CaseError> {
    let (mut best, mut spent, mut result) = (f64::INFINITY, 0.0, None);
    for _ in 0..3 {
        let watch = Stopwatch::start();
        result = Some(compute()?);
        let taken = watch.seconds();
        (best, spent) = (best.min(taken), spent + taken);
        if spent > 2.0 {
            break;
        }
    }
    result.map(|result| (best, result)).ok_or_else(|| CaseError::message("nothing was timed"))
}

/// From the geometry to the number, mesh and factorisation too.
fn relaxed(context: &mut ParetoContext) -> Result<(), CaseError> {
    let truth = exact(&BUSHING, 0.0, 0.0, 6).dynamic_stiffness;
    for cells in MESHES {
        let (seconds, found) = timed(|| {
            let mesh = quarter(&BUSHING, cells, GRADING)?;
            let material = rubber(MODULUS, 0.0, ChainPull::FiveTerms)?;
            let (model, _) = bonded(&mesh, material, Profile::Constant(1.0))?;
            let answers = complex_stiffness(&model, 0.0, &[0.0], 1e-6)?;
            Ok(of_quarter(&answers[0]).dynamic_stiffness)
        })?;
        context.point(
            "ten nodes, continuous mean stress",
            &name(cells),
            seconds,
            off(found, truth),
        );
    }
    let mu = shear_over_modulus() * MODULUS;
    for cells in [[8, 4, 2], [12, 4, 3], [24, 8, 6]] {
        let (seconds, found) = timed(|| four_nodes(&BUSHING, cells, mu, SleeveMotion::Radial))?;
        context.point("four nodes", &name(cells), seconds, off(found, truth));
    }
    let ways = cheapest_ways(context.points(), 0, "stiffness");
    context.sentence(format!("The {ways}"));
    Ok(())
}

fn name([around, radial, axial]: [usize; 3]) -> String {
    format!("{around} x {radial} x {axial}")
}

/// Small vibrations on five meshes, and steady loops in steps of small amplitude: two cycles, of which the second
/// is read; by its largest force and its area as (3.13) and (3.14) have it, by its first harmonic, and by that with
/// what the recursion of the steps is known to make of it.
fn cycle(context: &mut ParetoContext, frequency: f64) -> Result<(), CaseError> {
    let truth = exact(&BUSHING, 1.0, frequency, 6);
    let material = rubber(MODULUS, 1.0, ChainPull::FiveTerms)?;
    let mut push = |series: &str, cells, seconds, found: Hysteresis| {
        let of_stiffness = off(found.dynamic_stiffness, truth.dynamic_stiffness);
        let of_damping = off(found.damping_ratio, truth.damping_ratio);
        context.push(Point {
            more_errors: vec![of_damping, of_damping.max(of_stiffness)],
            ..Point::new(series, &name(cells), seconds, of_stiffness)
        });
    };
    for cells in MESHES {
        let (seconds, found) = timed(|| {
            let mesh = quarter(&BUSHING, cells, GRADING)?;
            let (model, _) = bonded(&mesh, material.clone(), Profile::Constant(1.0))?;
            let answers = complex_stiffness(&model, 0.0, &[TAU * frequency], 1e-6)?;
            Ok(of_quarter(&answers[0]))
        })?;
        push("small vibrations", cells, seconds, found);
    }
    // Three readings of the same loops.
    for per in [8, 12, 24, 48, 96] {
        for cells in &MESHES[1..3] {
            let (seconds, points) = timed(|| {
                let mesh = quarter(&BUSHING, *cells, GRADING)?;
                Ok(steady_loop(&mesh, material.clone(), AMPLITUDE, frequency, per)?.points)
            })?;
            let none = || CaseError::message("a loop without force");
            let first = first_harmonic(&points).ok_or_else(none)?;
            let corrected = of_steps(&points, &material.maxwell, 1.0 / frequency)?;
            for (reading, found) in [
                ("peak and area", of_loop(&points).ok_or_else(none)?),
                ("first harmonic", of_complex_stiffness(first.re, first.im)),
                ("first harmonic, corrected", corrected.ok_or_else(none)?),
            ] {
                push(&format!("{per} steps a cycle, {reading}"), *cells, seconds, found);
            }
        }
    }
    for (measure, whole) in
        [(0, "dynamic stiffness"), (1, "damping ratio"), (2, "both, the larger counting")]
    {
        let ways = cheapest_ways(context.points(), measure, whole);
        context.sentence(format!("The {ways}"));
        let steps = context.points().iter().filter(|point| point.series.contains("a cycle"));
        let ways = cheapest_ways(steps, measure, whole);
        context.sentence(format!("Of steps the {ways}"));
    }
    Ok(())
}
