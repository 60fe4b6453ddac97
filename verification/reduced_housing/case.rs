//! A housing reduced to shapes against explicit steps of the whole one.

use std::f64::consts::TAU;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::{Assembly, OUTER};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::members::body::{Drive, RotatingLoad};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::reduced_solid::ReducedSolid;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingOptions, SolidPart};
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::motion::reduced_start::{
    Housing, add_housing, ball_frequency, put_in_equilibrium,
};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::reduction::component_modes::{LEFT_OUT, ReduceOptions, Reduction, reduce};
use bearing_dynamics::reduction::load_patterns::{LargestLoads, pressed};
use bearing_dynamics::solids::bore_equilibrium::BoreState;
use bearing_dynamics::solids::condensation::CondensedBore;
use bearing_dynamics::solids::model::SolidModel;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housing_turn::{equilibria, outer_place};
use crate::housings::{self, BORE_RADIUS, WIDTH, assumptions};
use crate::motion;
use crate::pareto::Stopwatch;
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "reduced_housing",
    title: "A reduced housing against explicit steps of all its elements",
    section: "2.2.4, 2.4.2, 2.4.3",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Coarse, so that explicit steps take seconds.
const CELLS: [usize; 3] = [16, 1, 1];
/// m, with which no node of the bore lets go.
const TIGHT: f64 = 1e-6;
/// 1/s, of Table 2.3.
const DAMPING: f64 = 77.0;
/// N.
const BLOW: f64 = 500.0;
const TURNING: f64 = 250.0;
/// Parts of the default frequency up to which natural shapes are kept, the default last.
const PARTS: [f64; 3] = [0.25, 0.5, 1.0];
const DEFAULT: usize = 2;
/// Of the turning load, over the lowest frequency at which the housing moves the race across its axis.
const OF_LOWEST: f64 = 0.3;
/// Between rows, s.
const INTERVAL: f64 = 10e-6;

/// Housing, whole and condensed.
struct Whole {
    mesh: TetMesh,
    model: SolidModel,
    bore: CondensedBore,
}

/// y and z of the outer race at even times, m.
type Places = Vec<[f64; 2]>;

struct Motion {
    places: Places,
    seconds: f64,
    steps: u64,
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    let (what, text, default) = motion::RACE_INERTIA;
    context.assumption(what, text, default);
    let mesh = housings::mesh('C', Order::Quadratic, CELLS)?;
    let mut model = housings::solid(&mesh)?;
    model.problem.damping = DAMPING;
    let bore = housings::condensed(&mesh, &model)?;
    let mut whole = Whole { mesh, model, bore };
    one_shape(context)?;

    let still = housings::mounted([0.0; 5])?;
    let modes_to = 2.0 * ball_frequency(&still.assembly().bearings[0], BLOW);
    let mut reductions = Vec::new();
    for part in PARTS {
        reductions.push(reduced(&whole, part * modes_to)?);
    }
    statics(context, &mut whole, &reductions[DEFAULT])?;

    let mut struck = mounted()?;
    struck.inner.drives[2] =
        Drive::Load(Profile::HalfSine { base: 0.0, peak: BLOW, start: 0.1e-3, duration: 0.4e-3 });
    let blow = compare(&mut whole, &struck, &reductions, 1.0e-3)?;
    judge(context, "blow", "impact of 500 N over 0.4 ms", &blow, 0.01);
    context.check(
        Check::new(
            "blow_runge_kutta",
            "the same in steps of half the stability limit",
            "1",
            blow.errors[DEFAULT + 1],
        )
        .consistency(2e-3, WAYS)
        .at_most(
            0.0,
            "what rings as fast as the limit dies in such steps, and the race does not follow it; without answers to what natural shapes push the race with it is 1.1 %",
        ),
    );
    converges(context, &blow);

    let speed = TAU * OF_LOWEST * lowest_across(&reductions[DEFAULT])?;
    let mut turned = mounted()?;
    let rise = Profile::SmoothRamp { from: 0.0, to: speed, start: 0.0, duration: 0.5e-3 };
    turned.rotating_load =
        Some(RotatingLoad { force: Profile::Constant(TURNING), speed: rise, phase: 0.0 });
    let turn = compare(&mut whole, &turned, &reductions, 1.5e-3)?;
    judge(context, "turn", "250 N rotating at 0.3 of the lowest lateral frequency", &turn, 0.01);
    inertia(context, &whole, &turned, &turn)?;

    table(context, &[("blow", &blow), ("turning load", &turn)], &reductions);
    figure(context, &blow)
}

/// The bearing of Table 2.2 whose outer race is held along its axis.
fn mounted() -> Result<DynamicProblem, CaseError> {
    let mut problem = housings::mounted([0.0; 5])?;
    if let Some(outer) = &mut problem.outer {
        outer.drives[0] = Drive::Motion(Profile::ZERO);
    }
    Ok(problem)
}

/// Frequency of the lowest natural shape that moves the bore as a whole across its axis, Hz; others bend it along the
/// axis, where the race slides.
fn lowest_across(reduction: &Reduction) -> Result<f64, CaseError> {
    let surface = &reduction.solid.surfaces[0];
    let area: f64 = surface.nodes.iter().map(|node| node.area).sum();
    let is_across = |shape: &[f64]| {
        let (mut mean, mut square) = ([0.0; 2], 0.0);
        for (along, node) in shape.iter().zip(&surface.nodes) {
            let part = node.area / area * along;
            square += part * along;
            mean = [mean[0] + part * node.normal[1], mean[1] + part * node.normal[2]];
        }
        // One for a shift of a round bore, nothing for what bends it.
        2.0 * (mean[0] * mean[0] + mean[1] * mean[1]) > 0.5 * square
    };
    let mut shapes = surface.shapes.chunks_exact(surface.nodes.len());
    let found = shapes.position(is_across).filter(|k| *k < reduction.cut_off.natural);
    let k = found.ok_or_else(|| CaseError::message("no natural shape moves the bore across"))?;
    Ok(reduction.solid.frequencies[k] / TAU)
}

fn reduced(whole: &Whole, modes_to: f64) -> Result<Reduction, CaseError> {
    let penalty = Penalty::default();
    let loads = pressed(
        &whole.bore,
        penalty,
        &housings::fit(TIGHT),
        &LargestLoads { force: BLOW, ..LargestLoads::default() },
    )?;
    let options = ReduceOptions { modes_to, left_out: LEFT_OUT };
    Ok(reduce(&whole.model, &whole.bore, penalty, &loads, &options)?)
}

/// The bearing in a reduced housing, in equilibrium.
fn seated(
    whole: &mut Whole,
    problem: &DynamicProblem,
    reduction: &Reduction,
) -> Result<(Assembly, BoreState), CaseError> {
    let (fit, penalty) = (housings::fit(TIGHT), Penalty::default());
    let radius = Profile::Constant(fit.radius);
    let mut assembly = problem.assembly();
    add_housing(&mut assembly, OUTER, reduction, &whole.bore, radius, penalty);
    let housing = Housing { reduction, bore: &mut whole.bore, fit, penalty };
    let mut found = put_in_equilibrium(&mut assembly, &mut [housing])?;
    Ok((assembly, found.seats.remove(0)))
}

/// (f/ω²)(1 − e^(−αt/2)(cos νt + α/(2ν) sin νt)), ν² = ω² − α²/4.
fn one_shape(context: &mut CaseContext) -> Result<(), CaseError> {
    let (frequency, damping, force, end) = (4e4f64, 6e3, 3.0, 2e-4);
    let mut assembly = DynamicProblem { outer: None, ..housings::mounted([0.0; 5])? }.assembly();
    assembly.solids.push(ReducedSolid {
        name: "one shape".into(),
        frequencies: vec![frequency],
        damping,
        weight: vec![force],
        start: vec![0.0],
        ..ReducedSolid::default()
    });
    let options = RunOptions { integrator: Integrator::RungeKutta, ..motion::fixed_step(5e-7) };
    let mut simulation = Simulation::new(assembly, options)?;
    while simulation.time < end - 1e-7 {
        simulation.step()?;
    }
    let ours = simulation.state[simulation.system.solids[0]];
    let nu = (frequency * frequency - 0.25 * damping * damping).sqrt();
    let swing = (nu * end).cos() + 0.5 * damping / nu * (nu * end).sin();
    let exact = force / (frequency * frequency) * (1.0 - (-0.5 * damping * end).exp() * swing);
    context.check(
        Check::new(
            "one_shape",
            "one shape under a constant force from rest, after 1.3 periods",
            "nm",
            1e9 * ours,
        )
        .closed_form(1e9 * exact, "damped oscillator under a step")
        .relative(1e-7, "fourth order, 310 steps a period"),
    );
    Ok(())
}

/// The race's place in equilibrium under 250 N, with the compliance that shapes have and with all of it.
fn statics(
    context: &mut CaseContext,
    whole: &mut Whole,
    reduction: &Reduction,
) -> Result<(), CaseError> {
    let problem = DynamicProblem {
        rotating_load: Some(RotatingLoad {
            force: Profile::Constant(TURNING),
            speed: Profile::ZERO,
            phase: 0.7,
        }),
        ..mounted()?
    };
    let exact = {
        let mut search = housings::search(&whole.bore);
        search.solve(&problem.statics(0.0), &housings::fit(TIGHT), [0.0; 3])?.bore
    };
    let across = 2.0 * whole.bore.reach.radius;
    let (assembly, state) = seated(whole, &problem, reduction)?;
    let size = |state: &BoreState| state.pose[0].hypot(state.pose[1]);
    context.check(
        Check::new("static_place", "outer race under 250 N, from its place", "nm", 1e9 * size(&state))
            .consistency(1e9 * size(&exact), "equilibrium with the compliance of the modes, and with that of the condensed housing")
            .absolute(
                1e9 * size(&exact).powi(2) / across,
                "a bore that lets no node go has static answers of its own; what is left is the chord of the race's way across nodes, δ²/2r, \
                 which starts have and condensed bores have not (decision 61)",
            )
            .golden(GoldenTolerance { relative: 1e-4, absolute: 0.0 }),
    );
    let mut simulation = Simulation::new(assembly, options())?;
    let first = place(&simulation);
    let mut away = 0.0f64;
    while simulation.time < 2e-4 {
        simulation.step()?;
        let now = place(&simulation);
        away = largest([away, (now[0] - first[0]).hypot(now[1] - first[1])]);
    }
    context.check(
        Check::new("stays", "in motion from there: largest distance in 0.2 ms", "nm", 1e9 * away)
            .consistency(0.0, "our equilibrium against our motion")
            .absolute(
                1e-3 * 1e9 * size(&exact),
                "second-order terms of the race's rotations and displacements, omitted by a linear bore",
            ),
    );
    Ok(())
}

fn options() -> RunOptions {
    RunOptions {
        integrator: Integrator::DormandPrince,
        stepping: Stepping::Accuracy(1e-3),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    }
}

fn place(simulation: &Simulation) -> [f64; 2] {
    let at = simulation.system.places.body(OUTER);
    [simulation.state[at + 1], simulation.state[at + 2]]
}

fn in_shapes(assembly: Assembly, options: RunOptions, end: f64) -> Result<Motion, CaseError> {
    let watch = Stopwatch::start();
    let mut simulation = Simulation::new(assembly, options)?;
    let mut places = vec![place(&simulation)];
    let rows = (end / INTERVAL).round() as usize;
    for row in 1..=rows {
        let time = row as f64 * INTERVAL;
        while simulation.time < time {
            let left = time - simulation.time;
            if simulation.step_by(left.min(simulation.step_size))? == left {
                simulation.time = time;
            }
        }
        places.push(place(&simulation));
    }
    Ok(Motion { places, seconds: watch.seconds(), steps: simulation.steps })
}

fn explicit(
    whole: &Whole,
    problem: &DynamicProblem,
    start: &BoreState,
    end: f64,
) -> Result<Motion, CaseError> {
    let [y, z, tilt_y, tilt_z] = start.pose;
    let problem = DynamicProblem { outer_start: [0.0, y, z, tilt_y, tilt_z], ..problem.clone() };
    let seat = Seat {
        name: None,
        mount: Mount::at_centre(OUTER),
        solid: 0,
        radius: Profile::Constant(BORE_RADIUS + TIGHT),
        width: WIDTH,
        penalty: Penalty::default(),
        friction: None,
        nodes: housings::bore_nodes(&whole.mesh)?,
        reach: f64::INFINITY,
    };
    let options = CouplingOptions {
        solid_fraction: 0.9,
        seat_phase: 0.25,
        bearing: RunOptions { integrator: Integrator::RungeKutta, ..motion::fixed_step(1e-6) },
    };
    let displacement = whole.bore.displacement(&start.loads);
    let watch = Stopwatch::start();
    let solid = SolidPart::displaced(None, whole.model.clone(), displacement);
    let mut housed = CoupledMotion::new(problem, vec![solid], vec![seat], &options)?;
    let coupling_steps = housed.divide(INTERVAL)?;
    let place = |housed: &CoupledMotion| {
        let [_, y, z] = housed.simulation.body(OUTER).position;
        [y, z]
    };
    let mut places = vec![place(&housed)];
    for _ in 0..(end / INTERVAL).round() as usize {
        for _ in 0..coupling_steps {
            housed.advance()?;
        }
        places.push(place(&housed));
    }
    Ok(Motion { places, seconds: watch.seconds(), steps: housed.solids[0].solid.steps })
}

/// The same motion both ways.
struct Compared {
    explicit: Motion,
    shapes: Vec<Motion>,
    swing: f64,
    /// Largest distance of the outer race, for each reduction, over the swing.
    errors: Vec<f64>,
}

fn apart(one: &Places, other: &Places) -> f64 {
    largest(one.iter().zip(other).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])))
}

fn swing(places: &Places) -> f64 {
    let side = |i: usize| {
        let all = places.iter().map(|place| place[i]);
        let (low, high) = all
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    side(0).max(side(1))
}

fn compare(
    whole: &mut Whole,
    problem: &DynamicProblem,
    reductions: &[Reduction],
    end: f64,
) -> Result<Compared, CaseError> {
    let start = {
        let mut search = housings::search(&whole.bore);
        search.solve(&problem.statics(0.0), &housings::fit(TIGHT), [0.0; 3])?.bore
    };
    let explicit = explicit(whole, problem, &start, end)?;
    let mut shapes = Vec::new();
    for reduction in reductions {
        let (assembly, _) = seated(whole, problem, reduction)?;
        shapes.push(in_shapes(assembly, options(), end)?);
    }
    // The last one by the source's integrator too, whose step the seat sets.
    let (assembly, _) = seated(whole, problem, &reductions[DEFAULT])?;
    let by_limit = RunOptions {
        integrator: Integrator::RungeKutta,
        stepping: Stepping::FractionOfLimit(0.5),
        ..options()
    };
    shapes.push(in_shapes(assembly, by_limit, end)?);
    let swing = swing(&explicit.places);
    let errors = shapes.iter().map(|of| apart(&of.places, &explicit.places) / swing).collect();
    Ok(Compared { explicit, shapes, swing, errors })
}

const WAYS: &str = "modes and bearing in one state, against explicit steps of all elements";

fn judge(context: &mut CaseContext, id: &str, what: &str, found: &Compared, most: f64) {
    context.check(
        Check::new(
            &format!("{id}_default"),
            &format!("{what}: largest distance of the outer race from the explicit run, over its peak-to-peak motion"),
            "1",
            found.errors[DEFAULT],
        )
        .consistency(most, WAYS)
        .at_most(0.0, "component modes up to twice the frequency of a ball between its races: 1 % is required"),
    );
}

/// Of the blow, which drives what is left out.
fn converges(context: &mut CaseContext, blow: &Compared) {
    context.check(
        Check::new(
            "blow_more_shapes",
            "impact of 500 N over 0.4 ms: the same with a quarter of these frequencies over that",
            "1",
            blow.errors[0] / blow.errors[DEFAULT],
        )
        .consistency(3.0, WAYS)
        .at_least(0.0, "the square of the first frequency left out would be sixteenfold; static answers and steps, which stay, leave less to gain"),
    );
}

/// What equilibria, which have no inertia, are away.
fn inertia(
    context: &mut CaseContext,
    whole: &Whole,
    problem: &DynamicProblem,
    found: &Compared,
) -> Result<(), CaseError> {
    let mut turning = crate::housing_turn::Turning::steady(1.0);
    if let Some(load) = &problem.rotating_load {
        turning.load = load.clone();
    }
    turning.interference = TIGHT;
    let times: Vec<f64> = (0..found.explicit.places.len()).map(|i| i as f64 * INTERVAL).collect();
    let mut search = housings::search(&whole.bore);
    let moments = equilibria(&mut search, &turning, &times, |_, _| {})?;
    let places: Places = moments.iter().map(|moment| outer_place(&moment.state)).collect();
    let missed = apart(&places, &found.explicit.places) / found.swing;
    context.check(
        Check::new(
            "quasi_static",
            "the rotating load by equilibria: largest distance of the outer race from the explicit run, over its peak-to-peak motion",
            "1",
            missed,
        )
        .consistency(5.0 * found.errors[DEFAULT], "equilibria of the condensed housing against explicit steps")
        .at_least(0.0, "they omit inertia, which a reduced housing has")
        .golden(GoldenTolerance { relative: 1e-2, absolute: 0.0 }),
    );
    Ok(())
}

fn table(context: &mut CaseContext, all: &[(&str, &Compared)], reductions: &[Reduction]) {
    let mut rows = Vec::new();
    for (name, found) in all {
        rows.push(vec![
            name.to_string(),
            "explicit".into(),
            String::new(),
            found.explicit.steps.to_string(),
            format!("{:.3}", found.explicit.seconds),
            String::new(),
            "1".into(),
        ]);
        for (index, motion) in found.shapes.iter().enumerate() {
            let cut = &reductions[index.min(DEFAULT)].cut_off;
            let way = if index > DEFAULT { "rk4" } else { "dormand-prince" };
            rows.push(vec![
                name.to_string(),
                format!("{:.0} Hz, {way}", cut.modes_to),
                format!("{} + {}", cut.natural, cut.patterns),
                motion.steps.to_string(),
                format!("{:.4}", motion.seconds),
                format!("{:.2e}", found.errors[index]),
                format!("{:.0}", found.explicit.seconds / motion.seconds),
            ]);
        }
    }
    context.table(
        "cost",
        "Explicit steps and component modes up to a frequency: number of modes and static correction modes, steps, processor time (s), largest distance from the explicit run over its peak-to-peak motion, speed-up",
        &["motion", "housing", "shapes", "steps", "s", "error", "faster"],
        rows,
    );
}

fn figure(context: &mut CaseContext, blow: &Compared) -> Result<(), CaseError> {
    let curve = |name: &str, motion: &Motion| {
        let points = motion.places.iter().enumerate();
        let points = points.map(|(i, [_, z])| [1e3 * INTERVAL * i as f64, 1e9 * z]).collect();
        Curve::new(name.to_string(), points)
    };
    let plot = XyPlot {
        title: "A blow on the bearing, housing C pressed in by 1 µm".into(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("outer race, z", "nm"),
        style: Style::Lines,
        curves: vec![
            curve("explicit steps", &blow.explicit),
            curve("shapes, a quarter of the frequencies", &blow.shapes[0]),
            curve("shapes, default", &blow.shapes[DEFAULT]),
        ],
    };
    context.figure(
        "blow",
        xy(&plot)?,
        "Height of the outer race over time: explicit steps of all elements, and modes.",
    );
    Ok(())
}
