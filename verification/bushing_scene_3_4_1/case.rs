//! The bushing of 3.4.1 as its shipped scene has it: relaxed, in small vibrations, and row by row through a
//! cycle that begins at rest.

use std::f64::consts::{PI, TAU};

use bearing_dynamics::ch3_bushing::hysteresis::of_loop;
use bearing_dynamics::motion::simulation::RunOptions;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::session::{Motion, Parts, RubberParts, RunRequest, Session, Status};
use bearing_dynamics::plan::counts::Counts;
use bearing_dynamics::scene::build::rubber::{RubberSetup, rubber_setup, vibrating};
use bearing_dynamics::scene::build::solid_mesh::build;
use bearing_dynamics::scene::resolve::solid_scene::{Law, RunSteps, SolidRun};
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};
use bearing_dynamics::solids::rubber::relaxed::relaxed;
use bearing_dynamics::solids::rubber::vibration::vibrations;
use nalgebra::Complex;

use crate::bushings::{
    BULK_RATIO, BUSHING, BUSHING_RADIAL, MAXWELL, MODULUS, complex_factor, section,
    shear_over_modulus,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::bonded_bushing::radial_stiffness;
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "bushing_scene_3_4_1",
    title: "Bushing of 3.4.1 from its scene",
    section: "3.4.1, Table 3.1, (2.13), (3.13), (3.14)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const FREQUENCY: f64 = 10.0;
/// m.
const AMPLITUDE: f64 = 1e-3;
/// The mesh is a quarter.
const PARTS: f64 = 4.0;
/// Nodes of the contour, of which half are looked at: e⁻¹·³⁶ᴺ of error in exact arithmetic.
const NODES: usize = 14;

type C = Complex<f64>;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let document = Document::read_str(BUSHING_RADIAL, Format::Toml, "bushing_radial.toml")?;
    let Subject::Solid(scene) = resolve_subject(&document)? else {
        return Err(CaseError::message("no solid in the scene"));
    };
    let (Law::Elastomer(rubber), Some(settings)) = (&scene.law, scene.run) else {
        return Err(CaseError::message("no rubber, or no end in the scene"));
    };
    for assumption in &scene.assumptions {
        let at = "scenes/bushing_radial.toml";
        context.assumption(&assumption.name, &assumption.text, at);
    }
    let setup = rubber_setup(&scene, rubber, &build(&scene.mesh)?)?;
    context.work("unknowns", setup.model.unknowns.count as u64);
    let asked = rubber.harmonic.as_ref().ok_or_else(|| CaseError::message("no vibrations"))?;
    let model = vibrating(&setup, asked)?;
    let answers = vibrations(&model, &asked.frequencies, &mut Counts::default())?;
    for answer in answers.iter().filter(|answer| [0.0, FREQUENCY].contains(&answer.frequency)) {
        let exact = stiffness(C::new(0.0, TAU * answer.frequency));
        let of = answer.hysteresis;
        let key = if answer.frequency > 0.0 { "10hz" } else { "still" };
        let at = format!("at {} Hz", answer.frequency);
        let (tolerance, reason) = match answer.frequency > 0.0 {
            true => (4e-3, "errors of mesh and singular corners partly cancel: 0.15 %"),
            false => (0.012, "error at the singular corners on this mesh: 0.9 %"),
        };
        let kd = PARTS * of.dynamic_stiffness;
        context.check(
            Check::new(&format!("kd_{key}"), &format!("dynamic stiffness {at}"), "N/m", kd)
                .independent(exact.norm(), "one Fourier component, polynomials of degree 5")
                .under("quarter")
                .relative(tolerance, reason)
                .golden(GoldenTolerance::MIXED),
        );
        if answer.frequency > 0.0 {
            let damping = exact.im / exact.norm();
            context.check(
                Check::new("eta_10hz", &format!("damping ratio {at}"), "1", of.damping_ratio)
                    .independent(damping, "one Fourier component, polynomials of degree 5")
                    .under("quarter")
                    .relative(0.012, "as of the stiffness, of which it is a part")
                    .golden(GoldenTolerance::MIXED),
            );
        }
    }
    statics(context, &setup, settings.end)?;
    cycle(context, &setup, &settings)
}

/// The relaxed force at the end of the run, where the sleeve stands at its amplitude.
fn statics(context: &mut CaseContext, setup: &RubberSetup, end: f64) -> Result<(), CaseError> {
    let found = relaxed(&setup.model, end)?;
    let support = setup.supports.iter().find(|support| support.name == "inner");
    let support = support.ok_or_else(|| CaseError::message("no inner sleeve"))?;
    let force = support.total(&found.reactions).pop().unwrap_or(f64::NAN);
    context.check(
        Check::new("static_others", "relaxed force over 1 mm", "N/m", PARTS * force / AMPLITUDE)
            .independent(9.3155e5, "two locking-free codes by others, 0.2 % apart")
            .under("quarter")
            .relative(0.015, "0.9 % of singular corners, 0.2 % of 1 mm in 20 mm")
            .golden(GoldenTolerance::MIXED),
    );
    Ok(())
}

/// Every row of the run against the linear force.
fn cycle(
    context: &mut CaseContext,
    setup: &RubberSetup,
    settings: &SolidRun,
) -> Result<(), CaseError> {
    let RunSteps::Implicit(stepping) = settings.steps else {
        return Err(CaseError::message("no implicit steps in the scene"));
    };
    let request = RunRequest {
        options: RunOptions::default(),
        end: settings.end,
        output_interval: settings.output_interval,
        fields_interval: Some(settings.fields_interval),
        channels: Vec::new(),
    };
    let mut session = Session::start(Parts::Rubber(RubberParts { setup, stepping }), &request)?;
    while session.advance(1)? != Status::Complete {}
    if let Motion::Rubber(moving) = &session.motion {
        context.work("steps", moving.solid.counts.accepted);
        let (iterations, factors) = moving.solid.work();
        context.work("iterations", iterations as u64);
        context.work("factorisations", factors as u64);
    }
    let series = session.series()?;
    let column = |name: &str| {
        let found = series.column(name).map(|column| column.to_vec());
        found.ok_or_else(|| CaseError::message(format!("no column {name}")))
    };
    let (times, ways) = (column("time")?, column("inner_z")?);
    let forces: Vec<f64> = column("reaction_inner_z")?.iter().map(|f| PARTS * f).collect();
    // One contour for all of the second cycle, to where the run ends.
    let transient = Transient::new(0.16);
    let window = |time: f64| time > 0.099 && time < 0.2251;
    let exact: Vec<f64> = times.iter().map(|time| transient.force(*time)).collect();
    let peak = largest(exact.iter().zip(&times).filter(|(_, t)| window(**t)).map(|(f, _)| f.abs()));
    let rows = (0..times.len()).filter(|row| window(times[*row]));
    let apart = largest(rows.map(|row| (forces[row] - exact[row]).abs() / peak));
    context.check(
        Check::new(
            "rows",
            "largest difference of a row's force from 0.1 s on, over the peak",
            "1",
            apart,
        )
        .independent(0.0, "Laplace transform of the linear force, degree 5")
        .under("quarter")
        .absolute(5e-3, "0.2 % of the mesh, 0.3 % of the non-linearity, 0.1 % a step's stress")
        .golden(GoldenTolerance::MIXED),
    );
    let second = |forces: &[f64]| {
        let rows = (0..times.len()).filter(|row| times[*row] > 0.0999 && times[*row] < 0.1999);
        of_loop(&rows.map(|row| [ways[row], forces[row]]).collect::<Vec<_>>())
            .ok_or_else(|| CaseError::message("no loop"))
    };
    let (ours, theirs) = (second(&forces)?, second(&exact)?);
    for (id, text, unit, ours, theirs, tolerance) in [
        (
            "kd_second",
            "dynamic stiffness of the second cycle",
            "N/m",
            ours.dynamic_stiffness,
            theirs.dynamic_stiffness,
            5e-3,
        ),
        (
            "eta_second",
            "damping ratio of the second cycle",
            "1",
            ours.damping_ratio,
            theirs.damping_ratio,
            0.012,
        ),
    ] {
        context.check(
            Check::new(id, text, unit, ours)
                .independent(theirs, "Laplace transform of the linear force, degree 5")
                .under("quarter")
                .relative(tolerance, "mesh, non-linearity and steps as of rows and vibrations")
                .golden(GoldenTolerance::MIXED),
        );
    }
    let points = |forces: &[f64]| -> Vec<[f64; 2]> {
        ways.iter().zip(forces).map(|(x, f)| [1e3 * x, 1e-3 * f]).collect()
    };
    let svg = xy(&XyPlot {
        title: "Bushing of 3.4.1 at 10 Hz, from rest".into(),
        x: Axis::linear("radial displacement", "mm"),
        y: Axis::linear("radial force", "kN"),
        style: Style::Lines,
        curves: vec![
            Curve::new("run of the scene", points(&forces)),
            Curve::new("linear, oracle", points(&exact)),
        ],
    })?;
    context.figure(
        "cycle",
        svg,
        "Force over displacement from rest through two and a quarter cycles.",
    );
    Ok(())
}

/// K at the shear modulus that Laplace's s gives, N/m.
fn stiffness(s: C) -> C {
    let one = C::new(1.0, 0.0);
    // Along the imaginary axis that of the other cases, which is written apart.
    let factor = if s.re == 0.0 {
        complex_factor(1.0, s.im / TAU)
    } else {
        MAXWELL.iter().fold(one, |sum, [gamma, tau]| sum + s * *tau / (one + s * *tau) * *gamma)
    };
    let shear = factor * (shear_over_modulus() * MODULUS);
    radial_stiffness(section(&BUSHING), shear, BULK_RATIO * MODULUS, 5, 3)
}

/// The linear force of a sine that begins at rest.
struct Transient {
    steady: C,
    /// Places of the contour, and what stands before the exponential there.
    nodes: Vec<(C, C)>,
}

impl Transient {
    /// With a contour for times about `about` s.
    fn new(about: f64) -> Transient {
        let pulsation = TAU * FREQUENCY;
        let steady = stiffness(C::new(0.0, pulsation));
        // Weideman's contour (2006).
        let nodes = (0..NODES / 2).map(|k| {
            let angle = (2 * k + 1) as f64 * PI / NODES as f64;
            let scale = NODES as f64 / about;
            let turned = 0.6407 * angle;
            let cotangent = turned.cos() / turned.sin();
            let place = C::new(0.5017 * angle * cotangent - 0.6122, 0.2645 * angle) * scale;
            let slope = C::new(
                0.5017 * cotangent - 0.5017 * turned / (turned.sin() * turned.sin()),
                0.2645,
            ) * scale;
            // Both poles of the sine's transform are taken out: they are the steady cycle.
            let [up, down] = [C::new(0.0, pulsation), C::new(0.0, -pulsation)];
            let half = C::new(0.0, -0.5);
            let poles = steady * half / (place - up) + steady.conj() * half.conj() / (place - down);
            let whole = stiffness(place) * pulsation / (place * place + pulsation * pulsation);
            (place, (whole - poles) * slope * (2.0 / NODES as f64))
        });
        Transient { nodes: nodes.collect(), steady }
    }

    /// N.
    fn force(&self, time: f64) -> f64 {
        let turn = C::new(0.0, TAU * FREQUENCY * time).exp();
        let fading: f64 = self.nodes.iter().map(|(s, of)| ((s * time).exp() * of).im).sum();
        AMPLITUDE * ((self.steady * turn).im + fading)
    }
}
