//! Orbit of the inner race under the rotating load of 2.4.2, outer race fixed.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::RotatingLoad;
use bearing_dynamics::motion::simulation::Simulation;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, OrbitPlot, Style, XyPlot, orbit, xy};

use crate::bearings::{self, DEEP_GROOVE, Hertz, Lengths};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{self, BallSet, RPM};
use crate::oracles::statics::Known;

pub const CASE: Case = Case {
    id: "rotating_load_orbit",
    title: "Orbit under a rotating load of 250 N, fixed outer race",
    section: "2.4.2, Table 2.2",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Table 2.2: its ball of 5.955 mm stands for the 5 µm interference of 3.4.3.
const BEARING: Lengths = Lengths { clearance: -5e-6, ..DEEP_GROOVE };
const LOAD: f64 = 250.0;
const LOAD_SPEED: f64 = 50.0 * RPM;
/// Points of one revolution of the load.
const POINTS: usize = 180;
/// Steps between two points: 6.7 µs.
const EVERY: usize = 1000;

/// One revolution of the load, y and z in m.
#[derive(Default)]
struct Orbit {
    dynamic: Vec<[f64; 2]>,
    fixed: Vec<[f64; 2]>,
    start: [f64; 2],
    /// Largest angle of a ball from its even place behind ball 1, rad.
    uneven: f64,
    evaluations: u64,
}

struct Shape {
    mean_radius: f64,
    /// Largest less smallest radius.
    roundness: f64,
}

fn shape(points: &[[f64; 2]]) -> Shape {
    let radii = points.iter().map(|[y, z]| y.hypot(*z));
    let (low, high) = radii
        .clone()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), r| (low.min(r), high.max(r)));
    Shape { mean_radius: radii.sum::<f64>() / points.len() as f64, roundness: high - low }
}

fn known(angle: f64) -> [Known; 5] {
    [0.0, LOAD * angle.cos(), LOAD * angle.sin(), 0.0, 0.0].map(Known::Load)
}

fn revolution(shaft: f64) -> Result<Orbit, CaseError> {
    let mut problem = motion::moving(&BEARING, 0.0, [0.0; 5], shaft)?;
    let force = Profile::Constant(LOAD);
    problem.rotating_load =
        Some(RotatingLoad { force, speed: Profile::Constant(LOAD_SPEED), phase: 0.0 });
    problem.traction = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 };
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    let step = TAU / LOAD_SPEED / (POINTS * EVERY) as f64;
    let mut simulation = Simulation::new(problem, motion::fixed_step(step))?;
    let place = |simulation: &Simulation| {
        let [_, y, z, ..] = motion::inner_coordinates(simulation);
        [y, z]
    };
    let mut orbit = Orbit { start: place(&simulation), ..Orbit::default() };
    for point in 1..=POINTS {
        motion::run(&mut simulation, EVERY)?;
        orbit.dynamic.push(place(&simulation));
        let balls = BallSet::of(&simulation);
        let angle = TAU * point as f64 / POINTS as f64;
        let still = balls.oracle(&BEARING).solve(&known(angle), None).coordinates;
        orbit.fixed.push([still[1], still[2]]);
        orbit.uneven = balls.ahead().iter().fold(orbit.uneven, |most, angle| most.max(angle.abs()));
    }
    orbit.evaluations = simulation.system.work.evaluations;
    Ok(orbit)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let (name, text, default) = motion::RACE_INERTIA;
    context.assumption(name, text, default);
    context.assumption(
        "shaft_speed",
        "2.4.2 does not say whether the inner race turns while the load does. It is at rest here; 2000 rpm as in 2.4.1 is shown as well.",
        "0",
    );
    context.assumption(
        "interference",
        "Table 2.2 prints a ball of 5.955 mm; the radial clearance is −5 µm as in case misalignment_moment.",
        "−5 µm radial",
    );
    context.assumption(
        "traction",
        "Neither friction nor damping is stated. Traction keeps the balls where they are (or rolling); without it the rotating load would move them.",
        "κ = 0.07 regularised below 0.05 m/s, Hunt–Crossley α = 0.3 s/m",
    );
    let still = revolution(0.0)?;
    let turning = revolution(2000.0 * RPM)?;
    // 2.4.2: with a fixed outer race only Hertz contacts give way. Balls at their first places.
    let elastic: Vec<[f64; 2]> = (1..=POINTS)
        .map(|point| {
            let angle = TAU * point as f64 / POINTS as f64;
            let at = bearings::oracle(&BEARING, Hertz::Fit, 0.0).solve(&known(angle), None);
            [at.coordinates[1], at.coordinates[2]]
        })
        .collect();
    let mut rows = Vec::new();
    for (tag, name, orbit) in
        [("still", "inner race at rest", &still), ("turning", "inner race at 2000 rpm", &turning)]
    {
        let [ours, theirs] = [&orbit.dynamic, &orbit.fixed].map(|points| shape(points));
        let off = orbit
            .dynamic
            .iter()
            .zip(&orbit.fixed)
            .map(|(ours, theirs)| distance(*ours, *theirs))
            .fold(0.0, f64::max);
        let origin = "independent statics at the same load and ball angles";
        let reason =
            "traction carries some 1e-4 of the load; at 0.8 Hz of the load nothing is inert";
        context.check(
            Check::new(
                &format!("radius_{tag}"),
                &format!("mean orbit radius, {name}"),
                "nm",
                1e9 * ours.mean_radius,
            )
            .independent(1e9 * theirs.mean_radius, origin)
            .relative(5e-4, reason)
            .golden(GoldenTolerance { relative: 1e-7, absolute: 0.0 }),
        );
        context.check(
            Check::new(
                &format!("off_{tag}"),
                &format!("largest distance between the orbits, over their radius, {name}"),
                "1",
                off / theirs.mean_radius,
            )
            .independent(0.0, "the orbit by independent statics, point by point")
            .absolute(5e-4, reason),
        );
        context.check(
            Check::new(
                &format!("roundness_{tag}"),
                &format!("largest less smallest radius, {name}"),
                "nm",
                1e9 * ours.roundness,
            )
            .independent(1e9 * theirs.roundness, origin)
            .relative(5e-4, "the difference of the largest and the smallest radius shares the 1e-4 that traction carries"),
        );
        context.work(&format!("force evaluations, {name}"), orbit.evaluations);
        rows.push(vec![
            name.into(),
            format!("{:.2}", 1e9 * ours.mean_radius),
            format!("{:.2}", 1e9 * theirs.mean_radius),
            format!("{:.3}", 1e9 * ours.roundness),
            format!("{:.3}", 1e9 * theirs.roundness),
            format!("{:.2e}", off / theirs.mean_radius),
            format!("{:.1e} rad", orbit.uneven),
        ]);
    }
    let elastic_shape = shape(&elastic);
    let [ours, _] = [&still.dynamic, &still.fixed].map(|points| shape(points));
    context.check(
        Check::new("only_hertz", "mean orbit radius, inner race at rest", "nm", 1e9 * ours.mean_radius)
            .independent(
                1e9 * elastic_shape.mean_radius,
                "independent statics with the balls where they began: 2.4.2 has Hertz contacts as the only cause of motion",
            )
            .relative(5e-4, "the balls creep by less than their contact ellipses; traction carries 1e-4 of the load"),
    );
    let last = still.dynamic[POINTS - 1];
    context.check(
        Check::new(
            "closes",
            "gap between the orbit's ends, over its radius, inner race at rest",
            "1",
            distance(last, still.start) / ours.mean_radius,
        )
        .consistency(0.0, "our start: an elastic body under the same load has the same displacement")
        .absolute(5e-4, "traction, which the equilibrium at the start has not yet, carries some 1e-4 of the load"),
    );
    let columns = [
        "250 N at 50 rpm",
        "mean radius, nm",
        "statics, nm",
        "roundness, nm",
        "statics, nm",
        "farthest from statics, over the radius",
        "farthest ball from its even place",
    ];
    context.table(
        "orbits",
        "Orbits of the inner race over one revolution of the load",
        &columns,
        rows,
    );
    context.finding(
        "round",
        format!(
            "With a fixed outer race the orbit is round: its radius of {:.0} nm changes by {:.1e} nm while the balls stay evenly \
             spaced (statics). With the inner race at rest the balls creep by up to {:.1e} rad \
             under regularised traction, which makes one wave of {:.2} nm. All balls carry at 5 µm interference, so that no \
             direction is weak: 2.4.2's departures from a circle come from the housings.",
            1e9 * ours.mean_radius,
            1e9 * elastic_shape.roundness,
            still.uneven,
            1e9 * ours.roundness
        ),
    );
    figures(context, &still, &turning)
}

fn figures(context: &mut CaseContext, still: &Orbit, turning: &Orbit) -> Result<(), CaseError> {
    let nanometres = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        points.iter().map(|[y, z]| [1e9 * y, 1e9 * z]).collect()
    };
    let svg = orbit(&OrbitPlot {
        title: "Inner race under 250 N at 50 rpm, outer race fixed".into(),
        unit: "nm".into(),
        curves: vec![
            Curve::new("dynamics, race at rest", nanometres(&still.dynamic)),
            Curve::new("independent statics", nanometres(&still.fixed)),
        ],
    })?;
    context.figure("orbit", svg, "As the rigid housing of Fig. 2.20: the orbit of the inner race.");
    let radius = |points: &[[f64; 2]], every: usize| -> Vec<[f64; 2]> {
        let at = |(i, [y, z]): (usize, &[f64; 2])| {
            [360.0 * (i + 1) as f64 / POINTS as f64, 1e9 * y.hypot(*z)]
        };
        points.iter().enumerate().map(at).step_by(every).collect()
    };
    let svg = xy(&XyPlot {
        title: "Radius of the orbit over the angle of the load".into(),
        x: Axis::linear("angle of the load", "deg"),
        y: Axis::linear("radius", "nm"),
        style: Style::Lines,
        curves: vec![
            Curve::new("dynamics, race at rest", radius(&still.dynamic, 1)),
            Curve::new("dynamics, race at 2000 rpm", radius(&turning.dynamic, 1)),
            Curve::separate("statics, race at rest", radius(&still.fixed, 3)),
            Curve::separate("statics, race at 2000 rpm", radius(&turning.fixed, 3)),
        ],
    })?;
    context.figure(
        "radius",
        svg,
        "The scale is 1 nm: traction, which statics leaves out, shrinks the orbit by 0.09 nm. At rest the creep of the balls \
         makes one wave; at 2000 rpm the slightly uneven ball set does, once for each of its turns against the load.",
    );
    Ok(())
}
