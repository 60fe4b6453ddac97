//! The first cycle of the bushing of 3.4.1 at 10 Hz in explicit steps, with true and with scaled masses, against implicit
//! steps of the same elements: what the step in time alone does.

use std::time::Instant;

use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch3_bushing::hysteresis::of_complex_stiffness;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::explicit::{ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::rubber::explicit::{RubberBody, RubberStepLimit};
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};
use bearing_dynamics::solids::rubber::tet_forces::MeanStress;

use crate::bushings::{BULK_RATIO, BUSHING, MODULUS, bonded_tets, complex_shear, rubber, section};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::bonded_bushing::radial_stiffness;

pub const CASE: Case = Case {
    id: "rubber_explicit",
    title: "Bushing at 10 Hz: explicit against implicit steps, scaled masses",
    section: "2.2.3, 3.4.1, (2.13), (2.15), (3.12)",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const FREQUENCY: f64 = 10.0;
/// Half of the way there and back, m.
const AMPLITUDE: f64 = 0.5e-3;
const CELLS: [usize; 3] = [8, 4, 4];
const GRADING: f64 = 1.0;
/// Rows a cycle.
const ROWS: usize = 200;
const SCALES: [f64; 5] = [1.0, 10.0, 100.0, 1e3, 1e4];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption("density", "1100 kg/m³", "the source states none");
    // From rest and back to it, without a jump of speed.
    let moved = Profile::Harmonic {
        mean: AMPLITUDE,
        amplitude: AMPLITUDE,
        frequency: FREQUENCY,
        phase: -0.5 * std::f64::consts::PI,
    };
    let material = rubber(MODULUS, 1.0, ChainPull::FiveTerms)?;
    let (mut body, inner) =
        bonded_tets(&BUSHING, CELLS, GRADING, material, MeanStress::AroundNodes, moved)?;
    let coarse = implicit(&body, &inner, ROWS)?;
    let middle = implicit(&body, &inner, 2 * ROWS)?;
    let fine = implicit(&body, &inner, 4 * ROWS)?;
    let largest = fine.forces.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    let apart = |way: &Way| -> f64 {
        let pairs = way.forces.iter().zip(&fine.forces);
        pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / largest
    };
    let mut rows = vec![
        row("implicit", 1.0, &coarse, apart(&coarse)),
        row("implicit", 1.0, &middle, apart(&middle)),
        row("implicit", 1.0, &fine, 0.0),
    ];
    let curve = |name: &str, way: &Way| {
        let at = |row: usize| 2.0 * AMPLITUDE * 1e3 * travel(row);
        let points = way.forces.iter().enumerate();
        Curve::new(name, points.map(|(row, f)| [at(row), 1e-3 * f]).collect())
    };
    let mut curves = vec![curve("implicit", &fine)];
    let mut errors = Vec::new();
    let mut limits = Vec::new();
    for scale in SCALES {
        body.mass_scale = scale;
        let (way, found) = explicit(&body, &inner)?;
        limits.push(vec![
            scale.to_string(),
            format!("{:.3e}", found.limit.step),
            format!("{:.2}", found.stiffening),
        ]);
        errors.push(apart(&way));
        rows.push(row("explicit", scale, &way, apart(&way)));
        context.work(&format!("steps, masses times {scale}"), way.steps);
        if [1.0, 1e3].contains(&scale) {
            curves.push(curve(&format!("explicit, masses times {scale}"), &way));
        }
    }
    context.table(
        "ways",
        "One cycle of the same elements: what each way costs, and how far its force strays from the finest implicit one",
        &["way", "masses times", "times f², Hz²", "steps", "seconds", "largest difference over largest force"],
        rows,
    );
    context.table(
        "limits",
        "Largest stable steps: the longer, the less of the fast Maxwell elements they meet",
        &["masses times", "step, s", "deviatoric stiffness over the network's"],
        limits,
    );
    context.golden("force", largest, "N", GoldenTolerance::MIXED);
    let svg = xy(&XyPlot {
        title: "First cycle at 10 Hz, 1 mm".into(),
        x: Axis::linear("displacement", "mm"),
        y: Axis::linear("radial force", "kN"),
        style: Style::Lines,
        curves,
    })?;
    context.figure(
        "cycle",
        svg,
        "The first cycle from rest. Masses a thousandfold bring waves into it.",
    );
    checks(context, &errors, [apart(&coarse), apart(&middle)]);
    mesh(context, &body)
}

/// Part of the way at a row.
fn travel(row: usize) -> f64 {
    0.5 * (1.0 - (std::f64::consts::TAU * row as f64 / ROWS as f64).cos())
}

/// Force of the whole bushing on its inner sleeve at every row, N.
struct Way {
    forces: Vec<f64>,
    steps: u64,
    seconds: f64,
}

fn row(name: &str, scale: f64, way: &Way, error: f64) -> Vec<String> {
    vec![
        name.to_string(),
        scale.to_string(),
        format!("{:.0e}", scale * FREQUENCY * FREQUENCY),
        way.steps.to_string(),
        format!("{:.2}", way.seconds),
        format!("{error:.2e}"),
    ]
}

fn implicit(body: &RubberBody, inner: &[u32], steps: usize) -> Result<Way, CaseError> {
    let clock = Instant::now();
    let model = body.implicit()?;
    let stepping = Stepping::Fixed(1.0 / (FREQUENCY * steps as f64));
    let mut solid = RubberSolid::new(&model, StepOptions { stepping, ..Default::default() })?;
    let mut forces = vec![0.0];
    for row in 1..=ROWS {
        solid.advance(row as f64 / (FREQUENCY * ROWS as f64), |_| {})?;
        forces.push(4.0 * solid.support_force(inner)[2]);
    }
    Ok(Way { forces, steps: solid.counts.accepted, seconds: clock.elapsed().as_secs_f64() })
}

fn explicit(body: &RubberBody, inner: &[u32]) -> Result<(Way, RubberStepLimit), CaseError> {
    let clock = Instant::now();
    let still = || vec![[0.0; 3]; body.nodes.len()];
    let stepping = SolidStepping::FractionOfLimit(0.9);
    let (_, found) = ExplicitSolid::of_rubber(body, stepping, still(), still())?;
    let interval = 1.0 / (FREQUENCY * ROWS as f64);
    let (step, each) = stepping.divide(interval, found.limit.step);
    let (mut solid, _) =
        ExplicitSolid::of_rubber(body, SolidStepping::Fixed(step), still(), still())?;
    let mut forces = vec![0.0];
    for _ in 0..ROWS {
        for _ in 0..each {
            solid.step(|_, _, _| {})?;
        }
        // Evaluates the forces of this time.
        solid.velocity();
        let sum: f64 = inner.iter().map(|node| solid.forces()[*node as usize][2]).sum();
        forces.push(-4.0 * sum);
    }
    let seconds = clock.elapsed().as_secs_f64();
    Ok((Way { forces, steps: solid.steps, seconds }, found))
}

fn checks(context: &mut CaseContext, errors: &[f64], implicit: [f64; 2]) {
    let text = "largest difference of the force over a cycle, over the largest force";
    let ways = "explicit against implicit steps of the same elements, which share the law but neither forces, nor steps, nor inertia";
    for (k, (key, tolerance, reason)) in [
        (
            "true",
            3e-5,
            "twice what the error of 800 implicit steps and the waves of true masses come to",
        ),
        (
            "scaled_10",
            2e-4,
            "inertia of tenfold masses, 1e3 Hz² of mass scale times f²; others found 1e-3",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        context.check(
            Check::new(
                &format!("explicit_{key}"),
                &format!("{text}, masses times {}", SCALES[k]),
                "1",
                errors[k],
            )
            .consistency(0.0, ways)
            .absolute(tolerance, reason),
        );
    }
    context.check(
        Check::new(
            "growth",
            "that difference with masses a hundredfold over that with masses tenfold",
            "1",
            errors[2] / errors[1],
        )
        .consistency(10.0, "inertia grows with the masses")
        .relative(0.25, "and the waves that it lets through with it: 1.6 more"),
    );
    context.check(
        Check::new(
            "order",
            "difference of 200 implicit steps from 800 over that of 400",
            "1",
            implicit[0] / implicit[1],
        )
        .closed_form(5.0, "second order: (16 − 1)/(4 − 1)")
        .relative(0.15, "the first step of the cycle, and the third order: 10 %"),
    );
}

/// What the elements leave: the steady cycle of small amplitude.
fn mesh(context: &mut CaseContext, body: &RubberBody) -> Result<(), CaseError> {
    let pulsation = std::f64::consts::TAU * FREQUENCY;
    let mut unit = body.clone();
    for prescribed in &mut unit.prescribed {
        if let Profile::Harmonic { .. } = prescribed.profile {
            prescribed.profile = Profile::Constant(1.0);
        }
    }
    let answer = complex_stiffness(&unit.implicit()?, 0.0, &[pulsation], 1e-6)?[0];
    let ours = of_complex_stiffness(4.0 * answer.storage, 4.0 * answer.loss);
    let shear = complex_shear(1.0, FREQUENCY);
    let exact = radial_stiffness(section(&BUSHING), shear, BULK_RATIO * MODULUS, 5, 3);
    context.check(
        Check::new(
            "mesh",
            "steady dynamic stiffness at 10 Hz of these elements",
            "N/m",
            ours.dynamic_stiffness,
        )
        .independent(exact.norm(), "one Fourier component, polynomials of degree 5")
        .relative(0.12, "a coarse mesh: the comparison above is of steps in time")
        .golden(GoldenTolerance::MIXED),
    );
    Ok(())
}
