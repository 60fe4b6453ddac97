//! What a digit of a static solution costs, and what a varying-compliance amplitude costs.

use std::f64::consts::TAU;

use bearing_dynamics::equilibrium::statics::{
    Condition, StaticOptions, StaticSolution, solve_from,
};
use nalgebra::SVector;

use crate::bearings::{self, DEEP_GROOVE, Hertz, Lengths, known};
use crate::case::CaseError;
use crate::pareto::{ParetoContext, Study};

pub const TOLERANCE: Study = Study {
    id: "statics_tolerance",
    title: "One static solution, combined load, bearing of Table 4.1 at −5 µm",
    error_label: "largest ball load error over largest ball load",
    more_errors: &[],
    run: tolerance,
};

pub const POSITIONS: Study = Study {
    id: "varying_compliance_positions",
    title: "Vertical varying-compliance amplitude at 0 µm and 1500 N",
    error_label: "error of the amplitude over the amplitude",
    more_errors: &[],
    run: positions,
};

/// Each variant is repeated so often that its time is that of a quiet machine.
const REPEATS: usize = 2000;

fn combined_load() -> [Condition; 5] {
    [300.0, 100.0, -1500.0, 1.0, -2.0].map(Condition::Load)
}

fn tolerance(context: &mut ParetoContext) -> Result<(), CaseError> {
    let lengths = Lengths { clearance: -5e-6, ..DEEP_GROOVE };
    let phase = 0.1;
    for (model, name) in [(Hertz::Fit, "hamrock-brewe"), (Hertz::Exact, "exact")] {
        // Both models are held against the truth, the exact contact solved independently.
        let truth =
            bearings::oracle(&lengths, Hertz::Exact, phase).solve(&known(&combined_load()), None);
        let own = bearings::oracle(&lengths, model, phase).solve(&known(&combined_load()), None);
        let problem = bearings::problem(&lengths, model, phase, combined_load())?;
        let error = |solution: &StaticSolution, reference: &[f64]| {
            let largest = reference.iter().copied().fold(0.0, f64::max);
            solution
                .balls
                .iter()
                .zip(reference)
                .map(|(ball, reference)| (ball.inner.normal_load - reference).abs() / largest)
                .fold(0.0, f64::max)
        };
        let loads = |solution: &crate::oracles::statics::OracleSolution| -> Vec<f64> {
            solution.balls.iter().map(|ball| ball.inner.load).collect()
        };
        let (truth, own) = (loads(&truth), loads(&own));
        let default = StaticOptions::default();
        let start = solve_from(&problem, None, &default)?.coordinates;
        // The neighbour in a sweep: a degree of cage rotation away.
        let mut neighbour = problem.clone();
        neighbour.ball_phase -= 1f64.to_radians();
        let neighbour = solve_from(&neighbour, Some(&start), &default)?.coordinates;
        for exponent in [1, 2, 4, 6, 8, 11] {
            let options = StaticOptions { tolerance: 10f64.powi(-exponent), ..default };
            let variant = format!("1e-{exponent}");
            let solve = |guess: Option<&SVector<f64, 5>>| solve_from(&problem, guess, &options);
            for (start, guess) in [("cold", None), ("warm", Some(&neighbour))] {
                // Fails loudly below if a variant has no solution.
                solve(guess)?;
                let solved = context.time(
                    &format!("{name}, {start}, against its own model"),
                    &variant,
                    REPEATS,
                    || solve(guess),
                    |solution| solution.as_ref().map_or(f64::NAN, |s| error(s, &own)),
                )?;
                if exponent == 11 && start == "cold" && model == Hertz::Fit {
                    let seconds = context.points().last().map_or(f64::NAN, |point| point.seconds);
                    context.point(
                        "hamrock-brewe, cold, against the exact contact",
                        "1e-11",
                        seconds,
                        error(&solved, &truth),
                    );
                }
            }
        }
    }
    let cheapest = |points: &[crate::pareto::Point], series: &str, limit: f64| {
        points
            .iter()
            .filter(|point| point.series.starts_with(series) && point.error <= limit)
            .min_by(|a, b| a.seconds.total_cmp(&b.seconds))
            .map(|point| (point.variant.clone(), 1e6 * point.seconds, point.error))
    };
    let mut sentences = Vec::new();
    for (limit, name) in [(1e-2, "1 %"), (1e-3, "0.1 %")] {
        for start in ["cold", "warm"] {
            let series = format!("hamrock-brewe, {start}");
            if let Some((variant, micros, error)) = cheapest(context.points(), &series, limit) {
                sentences.push(format!(
                    "Cheapest way to {name} of the model's own solution from a {start} start: tolerance \
                     {variant}, {micros:.1} µs, error {error:.1e}."
                ));
            }
        }
    }
    sentences.push(
        "Newton converges quadratically, so the last eight digits cost one or two iterations: the \
         default tolerance of 1e-11 is kept. The choice between the fit and the exact contact moves the \
         ball loads far more than any tolerance, and costs nothing, since K_H is computed once."
            .into(),
    );
    for sentence in sentences {
        context.sentence(sentence);
    }
    Ok(())
}

fn positions(context: &mut ParetoContext) -> Result<(), CaseError> {
    let (zero, upright) = (Condition::Load(0.0), Condition::Displacement(0.0));
    let conditions = [zero, zero, Condition::Load(-1500.0), upright, upright];
    let pitch = TAU / DEEP_GROOVE.balls as f64;
    let height = |position: f64, start: &mut Option<SVector<f64, 5>>| -> Result<f64, CaseError> {
        let problem = bearings::problem(&DEEP_GROOVE, Hertz::Fit, position, conditions)?;
        let solution = solve_from(&problem, start.as_ref(), &StaticOptions::default())?;
        *start = Some(solution.coordinates);
        Ok(solution.coordinates[2])
    };
    // Positions from a quarter step on, so that no variant has the extremes by luck of symmetry.
    let amplitude = |count: usize| -> Result<f64, CaseError> {
        let mut start = None;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for step in 0..count {
            let z = height(pitch * (step as f64 + 0.25) / count as f64, &mut start)?;
            (low, high) = (low.min(z), high.max(z));
        }
        Ok(0.5 * (high - low))
    };
    let reference = {
        let oracle = |position: f64| {
            bearings::oracle(&DEEP_GROOVE, Hertz::Fit, position)
                .solve(&known(&conditions), None)
                .coordinates[2]
        };
        // The oracle's amplitude from a grid fine enough that its own error is below 1e-6.
        let values: Vec<f64> = (0..2000).map(|step| oracle(pitch * step as f64 / 2000.0)).collect();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        0.5 * (high - low)
    };
    for count in [4, 8, 16, 32, 64, 128, 256, 512] {
        amplitude(count)?;
        context.time(
            "equidistant positions, warm starts",
            &format!("{count}"),
            20,
            || amplitude(count),
            |value| value.as_ref().map_or(f64::NAN, |value| (value / reference - 1.0).abs()),
        )?;
    }
    let best = |limit: f64| {
        context
            .points()
            .iter()
            .filter(|point| point.error <= limit)
            .map(|p| p.seconds)
            .fold(f64::INFINITY, f64::min)
    };
    let (percent, tenth) = (best(1e-2), best(1e-3));
    let named = |seconds: f64| {
        context
            .points()
            .iter()
            .find(|point| point.seconds == seconds)
            .map_or_else(String::new, |point| point.variant.clone())
    };
    let text = format!(
        "Cheapest way to 1 % of the amplitude: {} positions a pitch, {:.2} ms; to 0.1 %: {} positions, \
         {:.2} ms.",
        named(percent),
        1e3 * percent,
        named(tenth),
        1e3 * tenth
    );
    context.sentence(text);
    Ok(())
}
