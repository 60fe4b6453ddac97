//! An impact on a bearing in a steel bushing, by explicit steps of both.

use bearing_dynamics::assembly::lists::{INNER, OUTER};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::state::{BODY, BodyState, VELOCITY};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingOptions, SolidPart};
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::reduction::load_patterns::race_under_load;
use bearing_dynamics::solids::bore_equilibrium::{BoreSearch, RaceLoad};
use bearing_dynamics::solids::model::SolidModel;

use crate::bearings::{self, Hertz};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housings::{
    self, BEARING, WIDTH, assumptions, bore_nodes, condensed, mesh, mounted, solid,
};
use crate::motion;
use crate::oracles::statics::Known;
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "steel_impact_2_4_3",
    title: "An impact on a bearing in a steel bushing",
    section: "2.4.3, Figs. 2.25 and 2.26",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// N, and s.
const PEAK: f64 = 2500.0;
const START: f64 = 2e-4;
const DURATION: f64 = 1e-3;
const END: f64 = 10e-3;
const INTERFERENCE: f64 = 1e-6;
/// Young's modulus of Table 2.3's steel and its damping, 1/s; and a bushing that gives way and damps.
const STEEL: [f64; 2] = [210e9, 77.0];
const DAMPER: [f64; 2] = [2e9, 2e4];
/// CouplingSteps between two samples.
const EVERY: u64 = 20;

fn impact() -> Profile {
    Profile::HalfSine { base: 0.0, peak: -PEAK, start: START, duration: DURATION }
}

#[derive(Default)]
struct History {
    times: Vec<f64>,
    /// Of the balls on the outer race along Z, N.
    force: Vec<f64>,
    /// Momentum of inner race and balls along Z at the end, N·s, and ∫ force dt.
    momentum: f64,
    impulse: f64,
    /// Largest, over all that was turned over.
    residual: f64,
    coupling_steps: u64,
    /// kg, N/m: what the lumped model takes.
    masses: [f64; 3],
    support: f64,
}

fn run_with([young, damping]: [f64; 2]) -> Result<History, CaseError> {
    let mesh = mesh('D', Order::Linear, [32, 2, 2])?;
    let mut problem = solid(&mesh)?.problem;
    problem.damping = damping;
    problem.material = LinearElastic::new(young, 0.3)?;
    let model = SolidModel::new(problem)?;
    let bore = condensed(&mesh, &model)?;
    let fit = housings::fit(INTERFERENCE);
    let fitted = race_under_load(
        &mut BoreSearch::new(&bore, Penalty::default()),
        &fit,
        &RaceLoad::default(),
    )?;
    let mut problem = mounted([0.0; 5])?;
    problem.inner.drives[2] = Drive::Load(impact());
    let outer = problem.outer.as_ref().map_or(f64::NAN, |outer| outer.inertia.mass);
    let balls = problem.geometry.ball_count as f64 * problem.ball.mass;
    let mut history = History {
        masses: [problem.inner.inertia.mass, balls, outer],
        support: fitted.stiffness[(1, 1)],
        ..History::default()
    };
    let seat = Seat {
        name: None,
        mount: Mount::at_centre(OUTER),
        solid: 0,
        radius: Profile::Constant(fit.radius),
        width: WIDTH,
        penalty: Penalty::default(),
        friction: None,
        nodes: bore_nodes(&mesh)?,
        reach: f64::INFINITY,
    };
    let options = CouplingOptions {
        solid_fraction: 0.9,
        seat_phase: 0.25,
        bearing: motion::fixed_step(2e-6),
    };
    let displacement = bore.displacement(&fitted.loads);
    let mut housed = CoupledMotion::new(
        problem,
        vec![SolidPart::displaced(None, model, displacement)],
        vec![seat],
        &options,
    )?;
    while housed.time() < END {
        let before = history.force.last().copied().unwrap_or(0.0);
        for _ in 0..EVERY {
            housed.advance()?;
        }
        housed.simulation.snapshot();
        let force = housed.simulation.system.sets[0].on_races[1].force[2];
        history.impulse += 0.5 * (force + before) * EVERY as f64 * housed.coupling_step;
        history.times.push(housed.time());
        history.force.push(force);
        if housed.exchanges.is_multiple_of(64 * EVERY) {
            let both = housed.snapshot()?;
            let part = both.residual.abs() / both.turned_over;
            history.residual = largest([history.residual, part]);
        }
    }
    history.coupling_steps = housed.exchanges;
    let bearing = &housed.simulation;
    let layout = bearing.system.sets[0].layout;
    let inner = BodyState::from_slice(&bearing.state[layout.inner()..layout.inner() + BODY]);
    let ball = |i| layout.ball_vector(&bearing.state, VELOCITY, i)[2];
    let balls: f64 = (0..layout.balls).map(ball).sum();
    let mass = bearing.system.assembly.bodies[INNER].inertia().map_or(0.0, |inertia| inertia.mass);
    history.momentum =
        mass * inner.velocity[2] + bearing.system.assembly.bearings[0].ball.mass * balls;
    Ok(history)
}

/// Load of the bearing over the displacement of its inner race along −Z, by the independent statics.
fn bearing_curve() -> Vec<[f64; 2]> {
    let oracle = bearings::oracle(&BEARING, Hertz::Fit, 0.0);
    let at = |i: i32| {
        let z = 0.5e-6 * f64::from(i);
        let known = [
            Known::Load(0.0),
            Known::Load(0.0),
            Known::Value(z),
            Known::Load(0.0),
            Known::Load(0.0),
        ];
        [z, oracle.solve(&known, None).loads[2]]
    };
    (-50..=50).map(at).collect()
}

fn between(curve: &[[f64; 2]], z: f64) -> f64 {
    let place = (z - curve[0][0]) / (curve[1][0] - curve[0][0]);
    let i = (place as usize).min(curve.len() - 2);
    let part = place - i as f64;
    curve[i][1] + part * (curve[i + 1][1] - curve[i][1])
}

/// Two masses in a row: inner race with half the balls, outer race with the other half. Leapfrog.
fn lumped(history: &History) -> Vec<[f64; 2]> {
    let curve = bearing_curve();
    let [inner, balls, outer] = history.masses;
    let masses = [inner + 0.5 * balls, outer + 0.5 * balls];
    let (impact, step) = (impact(), 1e-8);
    let (mut place, mut rate, mut rows) = ([0.0f64; 2], [0.0f64; 2], Vec::new());
    for n in 0..(END / step) as u64 {
        let t = n as f64 * step;
        let spring = between(&curve, place[0] - place[1]);
        rate[0] += step * (impact.value(t) - spring) / masses[0];
        rate[1] += step * (spring - history.support * place[1]) / masses[1];
        for i in 0..2 {
            place[i] += step * rate[i];
        }
        if n % 100 == 0 {
            rows.push([t, spring]);
        }
    }
    rows
}

fn lowest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

/// Half the range of the force in a stretch of time, N.
fn swing(history: &History, from: f64, to: f64) -> f64 {
    let inside = history.times.iter().zip(&history.force).filter(|(t, _)| **t >= from && **t < to);
    let (low, high) = inside.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, f)| {
        (low.min(*f), high.max(*f))
    });
    0.5 * (high - low)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    let (name, text, default) = motion::RACE_INERTIA;
    context.assumption(name, text, default);
    context.assumption(
        "impact",
        "Figs. 2.25 and 2.26 are lost. Half a sine wave along −Z on the inner race, ten times the 250 N of the section's other studies.",
        "2500 N, 1 ms",
    );
    context.assumption(
        "interference",
        "The fit is not stated beyond being one of interference.",
        "1 µm radial",
    );
    let steel = run_with(STEEL)?;
    let strong = run_with(DAMPER)?;
    let put_in = -PEAK * DURATION * 2.0 / std::f64::consts::PI;
    context.check(
        Check::new(
            "momentum",
            "momentum of inner race and balls plus that passed to the outer race, over the impulse",
            "1",
            (steel.momentum + steel.impulse) / put_in,
        )
        .closed_form(
            1.0,
            "Newton's law for inner race and balls; ∫ of half a sine wave is 2/π of its box",
        )
        .absolute(4e-5, "error of the trapezoidal rule over samples every 20 coupling steps, 4e-6"),
    );
    context.check(
        Check::new(
            "energy",
            "energy unaccounted for, over all that was turned over",
            "1",
            steel.residual,
        )
        .closed_form(0.0, "the ledger of both together closes")
        .absolute(4e-8, "of second order in the coupling_step, 5e-9 in this run"),
    );
    let model = lumped(&steel);
    let peak = lowest(steel.force.iter().copied());
    context.check(
        Check::new("peak", "largest force of the balls on the outer race", "N", peak)
            .consistency(
                lowest(model.iter().map(|[_, force]| *force)),
                "the full model against two lumped masses on the curve of the independent statics and our own condensed support",
            )
            .relative(0.02, "the balls, 0.055 kg of 0.4 kg, are not lumped halves; the bushing's own mass is left out")
            .golden(GoldenTolerance { relative: 1e-6, absolute: 0.0 }),
    );
    let spans = [(START + DURATION, START + DURATION + 2e-3), (END - 2e-3, END)];
    let kept = |history: &History| {
        let [first, last] = spans.map(|(from, to)| swing(history, from, to));
        last / first
    };
    context.check(
        Check::new(
            "slow_decay",
            "amplitude of the force in the last 2 ms over that just after the impact",
            "1",
            kept(&steel),
        )
        .stated(1.0, "2.4.3", "in steel the oscillation decays slowly, over much longer than 0.1 s")
        .absolute(
            0.3,
            "8 ms are a twelfth of 0.1 s, in which little is lost; beats of the two masses change the amplitude",
        ),
    );
    context.check(
        Check::new(
            "swapped_decay",
            "distance of the same from 1 with a soft bushing that damps",
            "1",
            1.0 - kept(&strong),
        )
        .stated(0.3, "2.4.3", "in steel the oscillation decays slowly, over much longer than 0.1 s")
        .at_least(
            0.1,
            "the statement must not hold of a bushing that damps, whose material is made up for this: beyond what the check above \
             allows steel",
        ),
    );
    context.finding(
        "who_damps",
        format!(
            "At the end, ten durations of the impact after its start, {:.0} % of the amplitude is left in steel, which deforms and damps little, and {:.0} % in a compliant, damping bushing.",
            100.0 * kept(&steel),
            100.0 * kept(&strong)
        ),
    );
    context.work("windows", steel.coupling_steps + strong.coupling_steps);
    context.table(
        "impact",
        "Force of the balls on the outer race",
        &[
            "bushing",
            "largest, N",
            "lumped model, N",
            "swing after the impact, N",
            "swing at the end, N",
            "windows",
        ],
        [("steel, 77 1/s", &steel), ("2 GPa, 20 000 1/s", &strong)]
            .into_iter()
            .map(|(name, history)| {
                vec![
                    name.to_string(),
                    format!("{:.1}", lowest(history.force.iter().copied())),
                    format!("{:.1}", lowest(model.iter().map(|[_, force]| *force))),
                    format!("{:.1}", swing(history, spans[0].0, spans[0].1)),
                    format!("{:.1}", swing(history, spans[1].0, spans[1].1)),
                    history.coupling_steps.to_string(),
                ]
            })
            .collect(),
    );
    let curve = |history: &History| -> Vec<[f64; 2]> {
        history.times.iter().zip(&history.force).map(|(t, f)| [1e3 * t, *f]).collect()
    };
    let svg = xy(&XyPlot {
        title: "Force of the balls on the outer race after an impact".into(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("force along Z", "N"),
        style: Style::Lines,
        curves: vec![
            Curve::new("steel", curve(&steel)),
            Curve::new("soft bushing that damps", curve(&strong)),
            Curve::new("two lumped masses", model.iter().map(|[t, f]| [1e3 * t, *f]).collect()),
        ],
    })?;
    context.figure(
        "force",
        svg,
        "As Fig. 2.26 for steel: after the impact the force keeps oscillating. The lumped model is undamped.",
    );
    Ok(())
}
