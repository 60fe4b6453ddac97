//! Balls over a dent of the outer race, which is fixed or sits in a bushing.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch3_bushing::dent::{Dent, DentShape, dented_load};
use bearing_dynamics::mesh::generate::{Bushing, Part};
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::spectrum::spectrum;
use bearing_dynamics::solver::dynamics::assembly::Assembly;
use bearing_dynamics::solver::dynamics::connection::SpringDashpot;
use bearing_dynamics::solver::dynamics::model::Rotation;
use bearing_dynamics::solver::dynamics::run::{Integrator, RunOptions, Simulation, Stepping};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::rubber::prony::bushing_spring;

use crate::bearings::{DEEP_GROOVE, Lengths};
use crate::bushings::{quarter, rubber, spring_to_ground};
use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::motion::{self, RPM, race};

pub const CASE: Case = Case {
    id: "dent_3_4_4",
    title: "Balls over a dent, outer race fixed or in a bushing",
    section: "3.4.4, (3.20), Figs. 3.24 to 3.30",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const INTERFERENCE: Lengths = Lengths { clearance: -5e-6, ..DEEP_GROOVE };
const SPEED: f64 = 100.0;
const BALLS: usize = 8;
const DIAMETER: f64 = 500e-6;
/// A twentieth of the diameter, m.
const DEPTH: f64 = 25e-6;
/// Between samples, s.
const SAMPLE: f64 = 0.5e-3;
const PASSES: usize = 5;
/// C_R of Table 3.1, Pa, and the fastest vibration that the bushing's spring is fitted to, Hz.
const MODULUS: f64 = 0.647e6;
const FASTEST: f64 = 20e3;

fn dent(side: usize) -> Dent {
    let shape =
        DentShape { diameter: DIAMETER, depth: DEPTH, shoulder_height: 0.0, shoulder_width: 0.0 };
    Dent { shape, side, angle: 270f64.to_radians(), groove_angle: 0.0 }
}

/// The bushing of 10 mm around Table 3.5's bearing, every γ of Table 3.1 times a factor.
fn bushing(gammas: f64) -> Result<SpringDashpot, CaseError> {
    let body = Bushing { inner_diameter: 71e-3, thickness: 10e-3, length: 20e-3 };
    let mesh = quarter(&body, [8, 4, 3], 1.5)?;
    let material = rubber(MODULUS, gammas, ChainPull::FiveTerms)?;
    Ok(bushing_spring(&mesh, Part::Quarter, &material, TAU * FASTEST)?.law)
}

/// All stiffnesses in proportion to C_R, as B is to it.
fn stiffer(law: &SpringDashpot, factor: f64) -> SpringDashpot {
    let mut law = law.clone();
    let all = law.maxwell.iter_mut().flat_map(|element| &mut element.stiffness);
    all.chain(&mut law.stiffness).for_each(|stiffness| *stiffness *= factor);
    law
}

/// Table 3.5's bearing with dents, a ball 15° before the bottom; outer race fixed or on a spring to the ground.
fn bearing(dents: Vec<Dent>, support: Option<&SpringDashpot>) -> Result<Assembly, CaseError> {
    let phase = 255f64.to_radians();
    let mut problem = motion::moving(&INTERFERENCE, phase, [0.0; 5], SPEED * RPM)?;
    problem.traction =
        TractionLaw::SlideToRoll { curve: ExponentialCurve::BOUNDARY, entrainment_floor: 0.01 };
    problem.dents = dents;
    if support.is_some() {
        let mut outer = race([0.0; 5], Rotation::Speed(Profile::ZERO));
        outer.inertia = inertia::hollow_cylinder(31.953e-3, 35.5e-3, 20e-3, 7850.0);
        problem.outer = Some(outer);
    }
    let mut assembly = problem.assembly();
    if let Some(law) = support {
        spring_to_ground(&mut assembly, law.clone());
    }
    Ok(assembly)
}

/// Rows of equal times, and what lies between them.
#[derive(Default)]
struct History {
    times: Vec<f64>,
    /// Of the inner race, m.
    height: Vec<f64>,
    /// Between ball 1 and the outer race, and of all balls on it, N.
    load: Vec<f64>,
    loads: Vec<f64>,
    /// Largest |z| of all steps, m; least and largest load of ball 1, N.
    vibration: f64,
    least: f64,
    most: f64,
    residual: f64,
    steps: u64,
}

fn roll(assembly: Assembly, end: f64, accuracy: f64) -> Result<History, CaseError> {
    let options = RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Accuracy(accuracy),
        ..RunOptions::default()
    };
    let mut simulation = Simulation::new(assembly, options)?;
    let mut history = History { least: f64::INFINITY, ..History::default() };
    let rows = (end / SAMPLE).round() as usize;
    let mut turned_over = 0.0f64;
    for row in 1..=rows {
        let time = row as f64 * SAMPLE;
        loop {
            let left = time - simulation.time;
            let reached = left <= simulation.step_size * (1.0 + 1e-6);
            let taken = simulation.step_by(if reached {
                left
            } else {
                simulation.step_size.min(0.6 * left)
            })?;
            let set = &simulation.system.sets[0];
            let load = set.table.load[set.layout.padded];
            history.least = history.least.min(load);
            history.most = history.most.max(load);
            let height = simulation.body(0).position[2].abs();
            history.vibration = history.vibration.max(height);
            if taken == left {
                simulation.time = time;
                break;
            }
        }
        let set = &simulation.system.sets[0];
        let outer = &set.table.load[set.layout.padded..set.layout.padded + BALLS];
        history.times.push(time);
        history.load.push(outer[0]);
        history.loads.push(outer.iter().sum());
        history.height.push(simulation.body(0).position[2]);
        if row % 50 == 0 {
            let now = simulation.snapshot()?;
            turned_over = turned_over.max(now.energy.contact);
            history.residual = history.residual.max(now.residual.abs());
        }
    }
    history.residual /= turned_over;
    history.steps = simulation.steps;
    Ok(history)
}

fn rms(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / values.len() as f64)
        .sqrt()
}

/// Orbital speed over the shaft's by pure rolling, from the radii alone.
fn orbit_ratio() -> f64 {
    let ball = DEEP_GROOVE.ball_radius + 2.5e-6;
    0.5 * (1.0 - ball / DEEP_GROOVE.pitch_radius)
}

/// The highest line near each of the first harmonics, against where rolling has it.
fn lines(
    context: &mut CaseContext,
    name: &str,
    values: &[f64],
    rate: f64,
) -> Result<(), CaseError> {
    let found = spectrum(values, SAMPLE).ok_or_else(|| CaseError::message("too few rows"))?;
    for harmonic in 1..=4 {
        let expected = f64::from(harmonic) * rate;
        let near = |k: f64| (k * rate / found.bin_width).round() as usize;
        let range = near(f64::from(harmonic) - 0.4)..=near(f64::from(harmonic) + 0.4);
        let highest = range.max_by(|a, b| found.amplitude[*a].total_cmp(&found.amplitude[*b]));
        let line = highest.map_or(f64::NAN, |bin| bin as f64 * found.bin_width);
        context.check(
            Check::new(
                &format!("{name}_{harmonic}"),
                &format!("line {harmonic} of the balls' loads, dent in the {name} race"),
                "Hz",
                line,
            )
            .closed_form(expected, "balls times relative speed of race and orbit, by pure rolling")
            .absolute(found.bin_width, "one bin of the spectrum"),
        );
    }
    Ok(())
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let (name, text, default) = motion::RACE_INERTIA;
    context.assumption(name, text, default);
    context.assumption(
        "dent",
        "3.4.4 states the diameter. Depth and profile are not: half a wave of a cosine without a shoulder, as deep as a \
         twentieth of the diameter, so that no ball reaches its bottom.",
        "25 µm deep",
    );
    context.assumption(
        "load",
        "3.4.4 states none: none acts but the interference, 5 µm of radius (ball of 5.9555 mm). Without gravity and cage.",
        "0 N",
    );
    context.assumption(
        "friction",
        "The source's curve is not printed; the common boundary set over the slide-to-roll ratio.",
        "floor 0.01 m/s",
    );
    context.assumption(
        "bushing",
        "10 mm thick as stated, inner diameter 71 mm and length 20 mm of Table 3.5, rubber of Table 3.1, condensed to a \
         spring with Maxwell elements up to 20 kHz; outer race a steel ring 31.953 to 35.5 mm, 20 mm wide.",
        "0.119 kg",
    );
    let shaft = SPEED / 60.0;
    let orbit = orbit_ratio() * shaft;
    // Ball 1 comes to the dent after 15°, then once an orbit; any ball eight times as often.
    let pitch = 1.0 / (BALLS as f64 * orbit);
    let end = ((PASSES as f64 - 1.0 + 0.75) / orbit / SAMPLE).round() * SAMPLE;
    let law = bushing(1.0)?;
    let fixed = roll(bearing(vec![dent(1)], None)?, end, 1e-4)?;
    let soft = roll(bearing(vec![dent(1)], Some(&law))?, end, 1e-4)?;
    context.finding(
        "quasi_static",
        format!(
            "In {} and {} steps of five passes the load of ball 1 stays between {:.1} and {:.1} N with the outer race fixed, {:.1} and {:.1} N in \
             the bushing. Stiffer and more viscous rubber moves the inner race a little less, in the order of Figs. 3.29 and 3.30; there is no \
             oscillation left between passes whose decay could be compared.",
            fixed.steps, soft.steps, fixed.least, fixed.most, soft.least, soft.most
        ),
    );
    context.check(
        Check::new(
            "reduction",
            "part of the inner race's largest vibration that the bushing takes",
            "%",
            100.0 * (1.0 - soft.vibration / fixed.vibration),
        )
        .published("reduction")
        .under("dent")
        .absolute(1.0, "two printed digits")
        .explained(Explanation::new(
            "The largest displacement of the inner race along Z. At 100 rpm a ball takes some 4 ms to cross the dent, hundreds of \
             periods of the bearing: its load dips smoothly, the race follows, nothing rings, and the bushing has nothing to take (figures, table of \
             rubbers). The published race rings from one pass to the next, so that its law of the dent is steeper than that of elastic bodies \
             over a pit of this size; the source prints neither exponent, depth, load nor masses.",
            GAP,
            0.5,
            &["dip", "ball_load", "inner_race", "materials", "quasi_static"],
        )),
    );
    for (id, history) in [("ledger_fixed", &fixed), ("ledger_bushing", &soft)] {
        context.check(
            Check::new(
                id,
                "energy that no entry names over what contacts hold",
                "1",
                history.residual,
            )
            .closed_form(0.0, "conservation")
            .absolute(1e-3, "steps of an accuracy of 1e-4"),
        );
    }
    lines(context, "outer", &fixed.loads, BALLS as f64 * orbit)?;
    let inner = roll(bearing(vec![dent(0)], None)?, 12.0 * pitch, 1e-4)?;
    lines(context, "inner", &inner.loads, BALLS as f64 * (shaft - orbit))?;
    dip(context, pitch)?;
    materials(context, &law, pitch)?;
    figures(context, &fixed, &soft)
}

/// One pass, at two accuracies: the ball's least load beside (3.20) at the depth of the interference.
fn dip(context: &mut CaseContext, pitch: f64) -> Result<(), CaseError> {
    let pass = |accuracy| roll(bearing(vec![dent(1)], None)?, 0.55 * pitch, accuracy);
    let [coarse, fine] = [pass(1e-4)?, pass(1e-6)?];
    context.check(
        Check::new("dip", "least load of a ball in its first pass", "N", coarse.least)
            .converged(fine.least, "the same pass at a hundredth of the error")
            .relative(5e-3, "ringing of the pass, steps of an accuracy of 1e-4"),
    );
    let mut simulation = Simulation::new(
        bearing(vec![dent(1)], None)?,
        RunOptions {
            integrator: Integrator::Rosenbrock,
            stepping: Stepping::Accuracy(1e-4),
            ..RunOptions::default()
        },
    )?;
    simulation.snapshot()?;
    let set = &simulation.system.sets[0];
    let (stiffness, table) = (set.laws.races[1].stiffness, &set.laws.dents[0].table);
    let mut rows = Vec::new();
    for approach in [1e-6, 2e-6, 3e-6, 5e-6, 10e-6, 20e-6] {
        let mut row = vec![format!("{:.0}", 1e6 * approach)];
        for along in [0.0, 100e-6, 200e-6, 300e-6] {
            let n = table.exponent(approach, [along, 0.0]);
            row.push(format!("{n:.4} ({:.1} N)", dented_load(stiffness, approach, n)));
        }
        rows.push(row);
    }
    context.table(
        "exponent",
        "Exponent n of (3.20) and load over approach and distance along the rolling direction, outer race",
        &["δ, µm", "at the centre", "100 µm away", "200 µm", "300 µm"],
        rows,
    );
    Ok(())
}

/// Table 3.2's rubbers: how far the ball's load is from its mean in the second half between two passes.
fn materials(context: &mut CaseContext, law: &SpringDashpot, pitch: f64) -> Result<(), CaseError> {
    let (less, more) = (bushing(0.5)?, bushing(2.0)?);
    let all = [
        ("C_R, γ", law.clone()),
        ("2 C_R", stiffer(law, 2.0)),
        ("0.5 C_R", stiffer(law, 0.5)),
        ("2 γ", more),
        ("0.5 γ", less),
    ];
    let mut rows = Vec::new();
    for (name, law) in all {
        let found = roll(bearing(vec![dent(1)], Some(&law))?, 1.3 * pitch, 1e-4)?;
        let at = |pitches: f64| (pitches * pitch / SAMPLE) as usize;
        let left = rms(&found.load[at(0.85)..at(1.25)]);
        rows.push(vec![
            name.into(),
            format!("{:.3}", 1e6 * found.vibration),
            format!("{:.2} to {:.2}", found.least, found.most),
            format!("{left:.4}"),
        ]);
    }
    context.table(
        "materials",
        "Rubbers of Table 3.2",
        &[
            "rubber",
            "largest |z| of the inner race, µm",
            "ball's load, N",
            "left of it after half a pitch, rms, N",
        ],
        rows,
    );
    Ok(())
}

fn figures(context: &mut CaseContext, fixed: &History, soft: &History) -> Result<(), CaseError> {
    let drawn = |title: &str, y: Axis, of: &dyn Fn(&History) -> Vec<[f64; 2]>| {
        xy(&XyPlot {
            title: title.into(),
            x: Axis::linear("time", "s"),
            y,
            style: Style::Lines,
            curves: vec![
                Curve::new("fixed outer race", of(fixed)),
                Curve::new("in a bushing", of(soft)),
            ],
        })
    };
    let over = |history: &History, values: &[f64], scale: f64| -> Vec<[f64; 2]> {
        history.times.iter().zip(values).step_by(4).map(|(t, v)| [*t, scale * v]).collect()
    };
    let svg = drawn("Load of ball 1 on the outer race", Axis::linear("load", "N"), &|of| {
        over(of, &of.load, 1.0)
    })?;
    context.figure("ball_load", svg, "As in Figs. 3.24 and 3.25, five passes of one ball.");
    let svg = drawn("Inner race", Axis::linear("z", "um"), &|of| over(of, &of.height, 1e6))?;
    context.figure("inner_race", svg, "As in Figs. 3.26 and 3.27.");
    let lines = |of: &History| -> Vec<[f64; 2]> {
        let Some(found) = spectrum(&of.height, SAMPLE) else { return Vec::new() };
        let bins = found
            .amplitude
            .iter()
            .enumerate()
            .take_while(|(k, _)| *k as f64 * found.bin_width < 100.0);
        bins.map(|(k, a)| [k as f64 * found.bin_width, 1e9 * a]).collect()
    };
    let svg = xy(&XyPlot {
        title: "Spectrum of the inner race's z".into(),
        x: Axis::linear("frequency", "Hz"),
        y: Axis::linear("amplitude", "nm"),
        style: Style::Lines,
        curves: vec![
            Curve::new("fixed outer race", lines(fixed)),
            Curve::new("in a bushing", lines(soft)),
        ],
    })?;
    context.figure("spectrum", svg, "As in Fig. 3.28.");
    Ok(())
}

/// Ours less the published part, per cent.
const GAP: f64 = -68.939;
