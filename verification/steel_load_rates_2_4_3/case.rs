//! Rates of load on a bearing in a steel bushing: in motion, the displacement knows the load alone as
//! long as the load takes many periods of the lowest vibration.

use std::f64::consts::TAU;

use bearing_dynamics::assembly::lists::OUTER;
use bearing_dynamics::members::body::{Condition, Drive};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::motion::coupling::{CoupledMotion, SolidPart};
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::condensation::CondensedBore;
use bearing_dynamics::solids::model::SolidModel;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housed::{HousedState, QuasiStaticSequence, history};
use crate::housings::{self, BORE_RADIUS, assumptions, condensed, fit, mesh, search, solid};
use crate::solids::largest;
use crate::{housing_turn, motion};

pub const CASE: Case = Case {
    id: "steel_load_rates_2_4_3",
    title: "Steel bushing under three rates of load",
    section: "2.4.3, Figs. 2.21 and 2.22",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const LOAD: f64 = 250.0;
/// s, of the ramps in motion.
const RAMPS: [f64; 3] = [2e-3, 4e-3, 8e-3];
/// s: of the same order as the lowest period, so that the displacement cannot follow.
const SHORT: f64 = 5e-5;
/// The run goes on after the ramp by this part of it, and lasts at least so long, s.
const AFTER: f64 = 0.25;
const LEAST: f64 = 0.6e-3;
const INTERFERENCE: f64 = 1e-6;
/// Coarse: motion and equilibrium share the mesh.
const CELLS: [usize; 3] = [24, 1, 1];
/// Part by which the two ways to equilibrium may differ.
const STILL_GAP: f64 = 2e-3;
/// CouplingSteps between two samples.
const EVERY: u64 = 4;
/// Loads at which curves are compared.
const STEPS: usize = 20;

/// Load (N), and how far the outer race has gone along −Z since there was none (m).
type Path = Vec<[f64; 2]>;

struct Motion {
    path: Path,
    /// Energy unaccounted for, over all that was turned over.
    residual: f64,
    coupling_steps: u64,
}

fn drop_of(first: &HousedState, state: &HousedState) -> f64 {
    first.bore.pose[1] - state.bore.pose[1]
}

/// Equilibria under growing loads, and a frequency (Hz) below which bearing and bushing do not vibrate along the load:
/// Dunkerley's 1/ω² ≤ Σ m u/F over the masses, each with its own compliance, the softest on the way. The
/// balls count as much as the inner race moves.
fn equilibria(bore: &CondensedBore) -> Result<(HousedState, Path, f64), CaseError> {
    let mut search = search(bore);
    let mut bearing = housings::bearing()?;
    let mut solve = |load: f64| {
        bearing.conditions[2] = Condition::Load(-load);
        search.solve(&bearing, &fit(INTERFERENCE), [0.0; 3])
    };
    let first = solve(0.0)?;
    let (mut path, mut inner) = (Vec::new(), Vec::new());
    for i in 0..=STEPS {
        let load = LOAD * i as f64 / STEPS as f64;
        let state = solve(load)?;
        path.push([load, drop_of(&first, &state)]);
        inner.push([load, first.bearing.coordinates[2] - state.bearing.coordinates[2]]);
    }
    let problem = housings::mounted([0.0; 5])?;
    let outer_mass = problem.outer.as_ref().map_or(f64::NAN, |outer| outer.inertia.mass);
    let ball_mass = problem.geometry.ball_count as f64 * problem.ball.mass;
    let softest = |path: &Path| {
        largest(path.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])))
    };
    let square =
        (problem.inner.inertia.mass + ball_mass) * softest(&inner) + outer_mass * softest(&path);
    Ok((first, path, 1.0 / (TAU * square.sqrt())))
}

/// Bearing and bushing by explicit steps, without damping, from equilibrium without load.
fn moved(
    mesh: &TetMesh,
    model: &SolidModel,
    bore: &CondensedBore,
    first: &HousedState,
    duration: f64,
) -> Result<Motion, CaseError> {
    let rise = Profile::SmoothRamp { from: 0.0, to: LOAD, start: 0.0, duration };
    let down = Profile::SmoothRamp { from: 0.0, to: -LOAD, start: 0.0, duration };
    let mut problem = housings::mounted([0.0; 5])?;
    problem.inner.drives[2] = Drive::Load(down);
    let [y, z, about_y, about_z] = first.bore.pose;
    problem.outer_start = [0.0, y, z, about_y, about_z];
    let radius = Profile::Constant(BORE_RADIUS + INTERFERENCE);
    let seat = Seat { radius, ..housing_turn::seat(mesh)? };
    let displacement = bore.displacement(&first.bore.loads);
    let options = housing_turn::options();
    let mut housed = CoupledMotion::new(
        problem,
        vec![SolidPart::displaced(None, model.clone(), displacement)],
        vec![seat],
        &options,
    )?;
    let mut path = vec![[0.0, 0.0]];
    let end = f64::max((1.0 + AFTER) * duration, LEAST);
    while housed.time() < end {
        for _ in 0..EVERY {
            housed.advance()?;
        }
        let [_, _, now] = housed.simulation.body(OUTER).position;
        path.push([rise.value(housed.time()), z - now]);
    }
    let snapshot = housed.snapshot()?;
    Ok(Motion {
        path,
        residual: snapshot.residual.abs() / snapshot.turned_over,
        coupling_steps: housed.exchanges,
    })
}

/// Displacement at a load, by straight lines between points of growing load.
fn at_load(path: &[[f64; 2]], load: f64) -> f64 {
    let next = path.iter().position(|point| point[0] >= load);
    match next {
        Some(0) => path[0][1],
        Some(i) => {
            let ([f0, u0], [f1, u1]) = (path[i - 1], path[i]);
            u0 + (u1 - u0) * (load - f0) / (f1 - f0)
        }
        // Rounding at the very end of the ramp.
        None => path[path.len() - 1][1],
    }
}

/// Largest distance of a path from equilibrium under the load of each moment, over the whole displacement.
fn off(path: &[[f64; 2]], still: &[[f64; 2]]) -> f64 {
    let gaps = path.iter().map(|[load, u]| (u - at_load(still, *load)).abs());
    largest(gaps) / still[STEPS][1]
}

/// How far the race moves before there is a load to speak of, over the whole displacement.
fn ringing(path: &[[f64; 2]], whole: f64) -> f64 {
    largest(path.iter().take_while(|p| p[0] <= 1e-4 * LOAD).map(|p| p[1].abs())) / whole
}

/// Largest distance between any two of the paths at the same load, over the whole displacement.
fn apart(paths: &[&Motion], whole: f64) -> f64 {
    let at = |motion: &Motion, i: usize| at_load(&motion.path, LOAD * i as f64 / STEPS as f64);
    let mut gaps = Vec::new();
    for (n, one) in paths.iter().enumerate() {
        for other in &paths[n + 1..] {
            gaps.extend((1..STEPS).map(|i| (at(one, i) - at(other, i)).abs()));
        }
    }
    largest(gaps) / whole
}

/// What a smooth ramp may leave of an undamped oscillator: the lag F″/ω², and as much again ringing on
/// from the ends; 60/(ωT)³ is by the jump of F‴ there.
fn bound(frequency: f64, duration: f64) -> f64 {
    let periods = TAU * frequency * duration;
    2.0 * (5.8 / periods.powi(2) + 60.0 / periods.powi(3))
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    let (name, text, default) = motion::RACE_INERTIA;
    context.assumption(name, text, default);
    context.assumption(
        "ramps",
        "Fig. 2.21 with the durations is lost; Fig. 2.23 shows 30 s of them. Smooth ramps from 0 to 250 N along −Z, thousands of times \
         shorter: what follows these follows slower ones.",
        "2, 4 and 8 ms",
    );
    context.assumption(
        "interference",
        "The fit is not stated; an interference, as for the impact of the same section, so that the race does not lift off.",
        "1 µm radial",
    );
    let mesh = mesh('D', Order::Linear, CELLS)?;
    let model = solid(&mesh)?;
    let bore = condensed(&mesh, &model)?;
    let (first, still, frequency) = equilibria(&bore)?;
    let whole = still[STEPS][1];
    let ramps = RAMPS
        .iter()
        .map(|duration| moved(&mesh, &model, &bore, &first, *duration))
        .collect::<Result<Vec<Motion>, _>>()?;
    let short = moved(&mesh, &model, &bore, &first, SHORT)?;

    let all: Vec<&Motion> = ramps.iter().collect();
    let words = "load–displacement profiles are the same whatever the rate of the load";
    context.check(
        Check::new(
            "rate",
            "in motion: largest distance between load–displacement curves of 2, 4 and 8 ms, over the displacement",
            "1",
            apart(&all, whole),
        )
        .stated(0.0, "2.4.3", words)
        .absolute(
            0.01,
            "1 % would not be seen in a figure; inertia leaves 12/(ω T)² of the shortest ramp, some parts in a thousand",
        )
        .golden(GoldenTolerance::MIXED.floor(1e-5)),
    );
    context.check(
        Check::new(
            "rate_swapped",
            "the same with the ramp of 0.05 ms in place of the longest",
            "1",
            apart(&[&ramps[0], &ramps[1], &short], whole),
        )
        .stated(0.0, "2.4.3", words)
        .at_least(
            0.1,
            "a ramp of the order of the lowest period cannot be followed; ten times the limit",
        ),
    );
    for ((duration, motion), id) in RAMPS.iter().zip(&ramps).zip(["2", "4", "8"]) {
        context.check(
            Check::new(
                &format!("follows_{id}_ms"),
                &format!("ramp of {id} ms: largest distance from equilibrium under the load of each moment, over the displacement"),
                "1",
                off(&motion.path, &still),
            )
            .consistency(0.0, "explicit steps under a ramp against our own equilibrium of bearing and condensed bushing, the same mesh")
            .absolute(
                STILL_GAP + bound(frequency, *duration),
                &format!(
                    "the lag of an undamped oscillator of {frequency:.0} Hz behind a smooth ramp, twice F″/ω² and what the jump of F‴ excites; \
                     and 0.2 %: equilibrium of the linear condensed bushing, the start, is not quite that in motion, and nothing damps what rings from it"
                ),
            )
            .golden(GoldenTolerance::MIXED.floor(1e-5)),
        );
    }
    let overshoot = largest(short.path.iter().map(|point| point[1])) / whole;
    context.check(
        Check::new(
            "overshoot",
            "ramp of 0.05 ms: largest displacement over that in equilibrium",
            "1",
            overshoot,
        )
        .consistency(1.0, "explicit steps under a short ramp against our own equilibrium: a displacement that knows the load alone")
        .at_least(
            0.2,
            "a sudden load sends an undamped oscillator twice as far; a fifth is no rounding",
        ),
    );
    for (duration, motion) in RAMPS.iter().zip(&ramps) {
        context.work(&format!("windows, {} ms", 1e3 * duration), motion.coupling_steps);
    }
    transition(context)?;
    let row = |name: &str, motion: &Motion, duration: f64| {
        vec![
            name.to_string(),
            format!("{:.1}", frequency * duration),
            format!("{:.3}", 100.0 * off(&motion.path, &still)),
            format!("{:.3}", 100.0 * bound(frequency, duration)),
            format!("{:.3}", 100.0 * ringing(&motion.path, whole)),
            format!("{:.1e}", motion.residual),
            motion.coupling_steps.to_string(),
        ]
    };
    let mut rows: Vec<Vec<String>> = RAMPS
        .iter()
        .zip(&ramps)
        .map(|(t, motion)| row(&format!("{} ms", 1e3 * t), motion, *t))
        .collect();
    rows.push(row("0.05 ms", &short, SHORT));
    context.table(
        "ramps",
        &format!(
            "Outer race in a steel bushing, explicit steps without damping; it sinks by {:.1} nm in equilibrium, lowest frequency along the load at least {frequency:.0} Hz",
            1e9 * whole
        ),
        &["ramp", "periods in it", "off equilibrium, %", "lag may be, %", "rings before, %", "energy off", "windows"],
        rows,
    );
    figure(context, &still, &ramps, &short)
}

/// With neither gap nor overlap the bushing is linear: equilibria under a ramp follow its profile.
fn transition(context: &mut CaseContext) -> Result<(), CaseError> {
    let mesh = mesh('D', Order::Quadratic, [32, 2, 2])?;
    let solid = solid(&mesh)?;
    let bore = condensed(&mesh, &solid)?;
    let mut search = search(&bore);
    let zero = Profile::ZERO;
    let ramp = Profile::Ramp { from: 0.0, to: -LOAD, start: 0.0, duration: 1.0 };
    let course = QuasiStaticSequence {
        times: (0..=STEPS).map(|i| i as f64 / STEPS as f64).collect(),
        conditions: [zero.clone(), zero.clone(), ramp, zero.clone(), zero.clone()],
        rotating_load: None,
        shaft_speed: Profile::ZERO,
        interference: Profile::ZERO,
        centrifugal: false,
    };
    let moments = history(&mut search, &housings::bearing()?, &fit(0.0), &course)?;
    let sunk = |i: usize| -moments[i].state.bore.pose[1] / -moments[STEPS].state.bore.pose[1];
    context.check(
        Check::new(
            "profile",
            "transition, at rest: displacement against the load's profile, both over their last values",
            "1",
            largest((0..=STEPS).map(|i| (sunk(i) - i as f64 / STEPS as f64).abs())),
        )
        .closed_form(0.0, "in transition everything is proportional to the load")
        .absolute(2e-9, "moments of the load at the inner race's offset, of second order in displacement over radius: 2e-10"),
    );
    Ok(())
}

fn figure(
    context: &mut CaseContext,
    still: &[[f64; 2]],
    ramps: &[Motion],
    short: &Motion,
) -> Result<(), CaseError> {
    let nano = |path: &[[f64; 2]]| path.iter().map(|[f, u]| [*f, 1e9 * u]).collect();
    let mut curves = vec![Curve::new("equilibrium", nano(still))];
    for (duration, motion) in RAMPS.iter().zip(ramps) {
        curves.push(Curve::new(format!("250 N in {} ms", 1e3 * duration), nano(&motion.path)));
    }
    curves.push(Curve::new(format!("250 N in {} ms", 1e3 * SHORT), nano(&short.path)));
    let svg = xy(&XyPlot {
        title: "Outer race in a steel bushing".into(),
        x: Axis::linear("load", "N"),
        y: Axis::linear("displacement along −Z", "nm"),
        style: Style::Lines,
        curves,
    })?;
    context.figure(
        "paths",
        svg,
        "As Fig. 2.22, over the load instead of time: the outer race in motion under three rates of load lies on equilibrium; under a ramp of the \
         order of the lowest period it lags, then overshoots and rings (upright at the right).",
    );
    Ok(())
}
