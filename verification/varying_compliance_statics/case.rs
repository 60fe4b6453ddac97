//! Varying compliance over one ball pitch at four clearances, quasi-static.

use std::f64::consts::{PI, TAU};

use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_from};
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};

use crate::bearings::{self, DEEP_GROOVE, Hertz, Lengths, known};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;

pub const CASE: Case = Case {
    id: "varying_compliance_statics",
    title: "Varying compliance at four radial clearances, 1500 N",
    section: "4.3.1, Table 4.1",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Radial clearances of 4.3.1 in µm, loose to tight.
const CLEARANCES: [f64; 4] = [5.0, 0.0, -5.0, -10.0];
const POSITIONS: usize = 90;

/// The inner race's motion over one ball pitch.
struct Motion {
    /// Position of the ball set, as a fraction of the pitch.
    phase: Vec<f64>,
    /// m.
    y: Vec<f64>,
    z: Vec<f64>,
    fewest_loaded: usize,
    most_loaded: usize,
}

/// Half the peak-to-peak value.
fn amplitude(values: &[f64]) -> f64 {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    0.5 * (high - low)
}

/// A clearance in µm as printed.
fn shown(clearance: f64) -> String {
    let sign = if clearance < 0.0 {
        "−"
    } else if clearance > 0.0 {
        "+"
    } else {
        ""
    };
    format!("{sign}{} µm", clearance.abs())
}

fn conditions() -> [Condition; 5] {
    let (zero, upright) = (Condition::Load(0.0), Condition::Displacement(0.0));
    [zero, zero, Condition::Load(-1500.0), upright, upright]
}

fn motion(
    clearance: f64,
    mut solve_at: impl FnMut(&Lengths, f64) -> Result<([f64; 2], usize), CaseError>,
) -> Result<Motion, CaseError> {
    let lengths = Lengths { clearance: clearance * 1e-6, ..DEEP_GROOVE };
    let pitch = TAU / lengths.balls as f64;
    let mut motion = Motion {
        phase: Vec::new(),
        y: Vec::new(),
        z: Vec::new(),
        fewest_loaded: usize::MAX,
        most_loaded: 0,
    };
    for step in 0..=POSITIONS {
        let fraction = step as f64 / POSITIONS as f64;
        // A ball starts at the bottom, under the load.
        let ([y, z], loaded) = solve_at(&lengths, -0.5 * PI + fraction * pitch)?;
        motion.phase.push(fraction);
        motion.y.push(y);
        motion.z.push(z);
        motion.fewest_loaded = motion.fewest_loaded.min(loaded);
        motion.most_loaded = motion.most_loaded.max(loaded);
    }
    Ok(motion)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "upright_inner_race",
        "4.3.1 has a bending rotor in flexible housings; here the outer race is fixed and the inner race \
         keeps upright, so that the bearing's own varying compliance is left.",
        "tilts held at 0, axial position free",
    );
    let mut ours = Vec::new();
    let mut oracle = Vec::new();
    let (mut iterations, mut evaluations) = (0, 0);
    for clearance in CLEARANCES {
        let mut start = None;
        ours.push(motion(clearance, |lengths, phase| {
            let problem = bearings::problem(lengths, Hertz::Fit, phase, conditions())?;
            let solution = solve_from(&problem, start.as_ref(), &StaticOptions::default())?;
            start = Some(solution.coordinates);
            iterations += solution.iterations;
            evaluations += solution.contact_evaluations;
            let loaded = solution.balls.iter().filter(|b| b.inner.normal_load > 0.0).count();
            Ok(([solution.coordinates[1], solution.coordinates[2]], loaded))
        })?);
        let mut start = None;
        oracle.push(motion(clearance, |lengths, phase| {
            let bearing = bearings::oracle(lengths, Hertz::Fit, phase);
            let solution = bearing.solve(&known(&conditions()), start);
            start = Some(solution.coordinates);
            let loaded = solution.balls.iter().filter(|b| b.inner.load > 0.0).count();
            Ok(([solution.coordinates[1], solution.coordinates[2]], loaded))
        })?);
    }
    let origin = "same positions by the independent solver";
    for (i, clearance) in CLEARANCES.into_iter().enumerate() {
        let tag = format!("{}{}", if clearance < 0.0 { "minus_" } else { "" }, clearance.abs());
        for (axis, ours, theirs) in
            [("y", &ours[i].y, &oracle[i].y), ("z", &ours[i].z, &oracle[i].z)]
        {
            context.check(
                Check::new(
                    &format!("amplitude_{axis}_{tag}"),
                    &format!("{} amplitude at {}", axis.to_uppercase(), shown(clearance)),
                    "nm",
                    1e9 * amplitude(ours),
                )
                .independent(1e9 * amplitude(theirs), origin)
                .absolute(
                    3e-8,
                    "10 µm positions, good to 3e-13 of them on both sides: 3e-9 nm; ten times that",
                )
                .golden(GoldenTolerance::REORDERED.floor(1e-4)),
            );
            if i > 0 {
                let looser = if axis == "y" { &oracle[i - 1].y } else { &oracle[i - 1].z };
                context.check(
                    Check::new(
                        &format!("order_{axis}_{tag}"),
                        &format!(
                            "{} amplitude at {} below that at {}",
                            axis.to_uppercase(),
                            shown(clearance),
                            shown(CLEARANCES[i - 1])
                        ),
                        "nm",
                        1e9 * amplitude(ours),
                    )
                    .stated(
                        1e9 * amplitude(looser),
                        "4.3.1",
                        "less clearance, less amplitude; the looser bearing is the independent solver's",
                    )
                    .at_most(1.0, "a nanometre, as far as a figure could show"),
                );
            }
        }
        for (which, ours, theirs) in [
            ("fewest", ours[i].fewest_loaded, oracle[i].fewest_loaded),
            ("most", ours[i].most_loaded, oracle[i].most_loaded),
        ] {
            context.check(
                Check::new(
                    &format!("{which}_loaded_{tag}"),
                    &format!("{which} balls carrying at {}", shown(clearance)),
                    "1",
                    ours as f64,
                )
                .independent(theirs as f64, origin)
                .absolute(0.0, "a count"),
            );
        }
    }
    context.work("Newton iterations, 364 warm positions", iterations as u64);
    context.work("ball–race evaluations, 364 warm positions", evaluations as u64);
    figures(context, &ours)
}

fn figures(context: &mut CaseContext, motions: &[Motion]) -> Result<(), CaseError> {
    for (axis, name) in [("y", "Y"), ("z", "Z")] {
        let curves = motions
            .iter()
            .zip(CLEARANCES)
            .map(|(motion, clearance)| {
                let values = if axis == "y" { &motion.y } else { &motion.z };
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                let points = motion
                    .phase
                    .iter()
                    .zip(values)
                    .map(|(phase, value)| [*phase, 1e6 * (value - mean)])
                    .collect();
                Curve::new(shown(clearance), points)
            })
            .collect();
        let svg = xy(&XyPlot {
            title: format!("Inner race, {name} about its mean"),
            x: Axis::linear("ball set position over ball pitch", "1"),
            y: Axis::linear(format!("{name} displacement"), "µm"),
            style: Style::Lines,
            curves,
        })?;
        context.figure(
            &format!("varying_compliance_{axis}"),
            svg,
            &format!(
                "{name} motion of the inner race over one ball pitch at four radial clearances, a ball under the \
                 load at both ends. The amplitude in the checks is half the peak-to-peak motion; at −10 µm \
                 it is too small to be seen."
            ),
        );
    }
    Ok(())
}
