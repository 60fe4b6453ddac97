//! Three rates of load on a bearing in a steel bushing: the displacement knows the load alone.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::bearing::geometry::Material;
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solver::housing::inertia::{Masses, estimate};
use bearing_dynamics::solver::housing::quasi_static::{Course, history};
use bearing_dynamics::solver::profile::Profile;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::housings::{
    BORE_RADIUS, WIDTH, assumptions, bearing, condensed, fit, mesh, search, solid,
};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "steel_load_rates_2_4_3",
    title: "Steel bushing under three rates of load",
    section: "2.4.3, Figs. 2.21 and 2.22",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const LOAD: f64 = 250.0;
/// s, of the three ramps.
const DURATIONS: [f64; 3] = [0.1, 1.0, 10.0];
const STEPS: usize = 20;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    context.assumption(
        "ramps",
        "Fig. 2.21 with the durations is lost. Straight ramps from 0 to 250 N along −Z, the inner race at rest.",
        "0.1, 1 and 10 s",
    );
    let mesh = mesh('D', Order::Quadratic, [32, 2, 2])?;
    let solid = solid(&mesh)?;
    let bore = condensed(&mesh, &solid)?;
    let bearing = bearing()?;
    let mut paths = Vec::new();
    let mut errors = Vec::new();
    for duration in DURATIONS {
        let mut search = search(&bore);
        let zero = Profile::ZERO;
        let ramp = Profile::Ramp { from: 0.0, to: -LOAD, start: 0.0, duration };
        let course = Course {
            // To the end of the ramp, and as long again.
            times: (0..=2 * STEPS).map(|i| duration * i as f64 / STEPS as f64).collect(),
            conditions: [zero.clone(), zero.clone(), ramp, zero.clone(), zero.clone()],
            rotating_load: None,
            shaft_speed: Profile::ZERO,
            interference: Profile::ZERO,
            weight: [0.0; 3],
            centrifugal: false,
        };
        let moments = history(&mut search, &bearing, &fit(0.0), &course)?;
        let ring = |inner: f64, outer: f64, width: f64| {
            hollow_cylinder(inner, outer, width, Material::STEEL.density)
        };
        let masses =
            Masses { inner: ring(15e-3, 22e-3, 12e-3), outer: ring(31.953e-3, BORE_RADIUS, WIDTH) };
        let last = &moments[2 * STEPS].state;
        // A ramp's swing is at most that of its corner: 2/(ω_n T) of the displacement.
        let frequency = estimate(&bearing, &search, last, &masses).lowest;
        errors.push((frequency, 2.0 / (TAU * frequency * duration)));
        let path: Vec<[f64; 2]> =
            moments.iter().map(|moment| [moment.time, -moment.state.bore.pose[1]]).collect();
        paths.push(path);
    }
    let whole = paths[0][STEPS][1];
    let gaps = |others: &[Vec<[f64; 2]>]| {
        let pairs = others.iter().flat_map(|path| path.iter().zip(&paths[0]));
        largest(pairs.map(|(one, other)| (one[1] - other[1]).abs())) / whole
    };
    context.check(
        Check::new(
            "rate",
            "largest difference of the three paths at the same load, over the displacement",
            "1",
            gaps(&paths[1..]),
        )
        .independent(0.0, "2.4.3 in words: \"the same profiles regardless of the rate\"")
        .absolute(1e-9, "the paths start from where they were last; an elastic body forgets it"),
    );
    // At the same time instead of the same load: the fastest ramp's end against the slowest one's first steps.
    let early =
        paths[2].iter().rfind(|point| point[0] <= DURATIONS[0] * 2.0).map_or(0.0, |point| point[1]);
    context.check(
        Check::new(
            "rate_swapped",
            "the same at the same time instead of the same load",
            "1",
            (whole - early) / whole,
        )
        .independent(0.0, "the same limit")
        .at_least(0.5, "the ramps differ: what agrees is the displacement over the load"),
    );
    let follows = paths[0].iter().enumerate().map(|(i, point)| {
        let load = (i as f64 / STEPS as f64).min(1.0);
        (point[1] / whole - load).abs()
    });
    context.check(
        Check::new(
            "profile",
            "displacement against the load's profile, both over their last values",
            "1",
            largest(follows),
        )
        .closed_form(0.0, "in transition everything is proportional to the load")
        .absolute(1e-5, "moments of the load at the inner race's offset: displacement over radius"),
    );
    for (i, (frequency, error)) in errors.iter().enumerate() {
        context.check(
            Check::new(
                &format!("inertia_{}", i + 1),
                &format!(
                    "swing that a ramp of {} s would add at its corner, over the displacement",
                    DURATIONS[i]
                ),
                "1",
                *error,
            )
            .closed_form(
                0.0,
                &format!("2/(ω T) at the lowest natural frequency of {frequency:.0} Hz"),
            )
            .absolute(0.01, "quasi-static steps are to be within 1 %"),
        );
    }
    let svg = xy(&XyPlot {
        title: "Outer race in a steel bushing".into(),
        x: Axis::log("time", "s"),
        y: Axis::linear("displacement along −Z", "nm"),
        style: Style::Lines,
        curves: DURATIONS
            .iter()
            .zip(&paths)
            .map(|(duration, path)| {
                let points = path[1..].iter().map(|[t, z]| [*t, 1e9 * z]).collect();
                Curve::new(format!("250 N in {duration} s"), points)
            })
            .collect(),
    })?;
    context.figure(
        "paths",
        svg,
        "As Fig. 2.22: displacement of the outer race under three rates of load.",
    );
    Ok(())
}
