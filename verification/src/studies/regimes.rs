//! Choice of the integrator on nine regimes of motion, compared with every other method at equal error.
//!
//! The reference of an implicit or Runge–Kutta run is a converged run of the explicit method with error control, and
//! the other way round. Where impacts of a cage amplify small differences, the error of one run is random: there it is
//! the median over runs under loads that differ by some permille, each with its own references.

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::motion::integrator_choice::choose;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Stepping};
use bearing_dynamics::output::session::{RunRequest, Session, Status};
use bearing_dynamics::plan::channels::ChannelGroup;
use bearing_dynamics::scene;
use bearing_dynamics::scene::Format;
use bearing_dynamics::scene::build::motion::{dynamic_problem, run_options};

use super::motion::{History, LABELS, Method, errors};
use crate::case::CaseError;
use crate::pareto::{ParetoContext, Point, Stopwatch, Study};

pub const DEFAULT: Study = Study {
    id: "default_run",
    title: "The default run on nine regimes",
    error_label: LABELS[0],
    more_errors: &[LABELS[1]],
    run,
};

const BALLS: &str = r#"defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
inner_race = { radius = "20.047 mm", groove_radius = "6.013 mm", bore_radius = "15 mm" }
outer_race = { radius = "31.953 mm", groove_radius = "6.310 mm", outer_radius = "36 mm" }
"#;

const CAGE: &str = r#"[bearing.cage]
pocket_radius = "6.1 mm"
inner_radius = "23.5 mm"
outer_radius = "28.5 mm"
race_clearance = "0.1 mm"
mass = "20 g"
guidance = "outer-race"
length = "12 mm"
contact = { law = "penalty", stiffness = "1e7 N/m" }
friction = 0.1
[ball_forces]
gravity = ["0 m/s^2", "0 m/s^2", "-9.80665 m/s^2"]
"#;

const THIN: &str = r#"defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 40
inner_race = { radius = "47.5 mm", groove_radius = "2.6 mm" }
outer_race = { radius = "52.5 mm", groove_radius = "2.6 mm" }
"#;

const TINY: &str = r#"defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 3
inner_race = { radius = "0.75 mm", groove_radius = "0.26 mm" }
outer_race = { radius = "1.25 mm", groove_radius = "0.26 mm" }
"#;

/// Name, bearing, radial clearance, cage, what moves it, end in ms, in place of `LOAD`.
type Regime = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    f64,
    &'static [&'static str],
);

const ALONE: &[&str] = &[""];
const NEIGHBOURS: [&str; 9] =
    ["1488", "1491", "1494", "1497", "1500", "1503", "1506", "1509", "1512"];

#[rustfmt::skip]
const REGIMES: [Regime; 9] = [
    ("700 rpm, 1500 N", BALLS, "-5 um", "",
     "z = { load = \"-1500 N\" }\nspeed = \"700 rpm\"", 20.0, ALONE),
    ("20 000 rpm, 500 N", BALLS, "-5 um", "",
     "z = { load = \"-500 N\" }\nspeed = \"20000 rpm\"", 10.0, ALONE),
    ("cage, 1000 rpm, 1500 N", BALLS, "5 um", CAGE,
     "z = { load = \"-LOAD N\" }\nspeed = \"1000 rpm\"", 20.0, &NEIGHBOURS),
    ("cage, 1000 to 10 000 rpm", BALLS, "5 um", CAGE,
     "z = { load = \"-500 N\" }\nunbalance = \"1e-5 kg m\"\nspeed = { ramp = [\"1000 rpm\", \"10000 rpm\"], start = \"0 s\", duration = \"8 ms\" }", 10.0, ALONE),
    ("impact of 5 kN", BALLS, "-5 um", "",
     "z = { load = { half_sine = \"-5000 N\", base = \"-250 N\", start = \"2 ms\", duration = \"2 ms\" } }\nspeed = \"1000 rpm\"", 10.0, ALONE),
    ("reversal from 2000 rpm", BALLS, "-5 um", "",
     "z = { load = \"-1000 N\" }\nspeed = { ramp = [\"2000 rpm\", \"-2000 rpm\"], start = \"2 ms\", duration = \"6 ms\" }", 10.0, ALONE),
    ("40 balls, 3000 rpm", THIN, "-1 um", "",
     "z = { load = \"-500 N\" }\nspeed = \"3000 rpm\"", 5.0, ALONE),
    ("3 balls of 0.25 mm, 30 000 rpm", TINY, "-0.5 um", "",
     "z = { load = \"-0.5 N\" }\nspeed = \"30000 rpm\"", 2.0, ALONE),
    ("5 N, clearance, 3000 rpm", BALLS, "10 um", "",
     "z = { load = \"-5 N\" }\nspeed = \"3000 rpm\"", 10.0, ALONE),
];

const ROWS: f64 = 100.0;

fn request(regime: &Regime, load: &str) -> Result<(DynamicProblem, RunRequest), CaseError> {
    let (_, bearing, clearance, cage, moved, end, _) = regime;
    let moved = moved.replace("LOAD", load);
    let text = format!(
        "{bearing}clearance = {{ radial = \"{clearance}\" }}\n{cage}[inner_race]\n{moved}\n\
         [numerics]\nend = \"{end} ms\"\noutput_interval = \"{} ms\"\n",
        end / ROWS
    );
    let message = |error: &dyn std::fmt::Display| CaseError::message(error.to_string());
    let scene = scene::read_str(&text, Format::Toml, "regime").map_err(|e| message(&e))?;
    let problem = dynamic_problem(&scene).map_err(|e| message(&e))?;
    let settings = run_options(&scene).map_err(|e| message(&e))?;
    let request = RunRequest {
        options: settings.options,
        end: settings.end,
        output_interval: settings.output_interval,
        fields_interval: None,
        channels: vec![ChannelGroup::Races],
    };
    Ok((problem, request))
}

struct Taken {
    history: History,
    steps: u64,
}

/// One run as `bearing run` steps it.
fn take(
    problem: &DynamicProblem,
    request: &RunRequest,
    method: Method,
) -> Result<Taken, CaseError> {
    let options = RunOptions {
        integrator: method.integrator,
        stepping: method.stepping,
        energy_limit: f64::INFINITY,
        ..request.options
    };
    let request = RunRequest { options, ..request.clone() };
    let message = |error: &dyn std::fmt::Display| CaseError::message(error.to_string());
    let mut session = Session::start(problem.clone(), &request).map_err(|e| message(&e))?;
    let watch = Stopwatch::start();
    while session.advance(100).map_err(|e| message(&e))? == Status::Running {}
    let seconds = watch.seconds();
    // A last row off the grid is not compared.
    let rows = session.recorder.rows().min(ROWS as usize + 1);
    let series = session.recorder.series(rows).map_err(|e| message(&e))?;
    let column = |name: &str| series.column(name).map(|c| c.to_vec()).unwrap_or_default();
    let [x, y, z] = ["inner_x", "inner_y", "inner_z"].map(column);
    let race = (0..rows).map(|row| [x[row], y[row], z[row]]).collect();
    let simulation = session.motion.bearing().expect("a bearing moves");
    let evaluations = simulation.system.work.evaluations;
    let history = History { race, evaluations, seconds };
    Ok(Taken { history, steps: simulation.steps })
}

/// A way to step under all loads of a regime.
struct Way {
    method: Method,
    point: Point,
    steps: u64,
}

/// The cheapest of so many runs under each load, the median of their errors.
fn way(draws: &[Draw], method: Method, of: &str, variant: &str) -> Result<Way, CaseError> {
    let mut errors_of: [Vec<f64>; 2] = Default::default();
    let (mut seconds, mut evaluations, mut steps, mut least) = (0.0, 0, 0, usize::MAX);
    for draw in draws {
        let (taken, repeats) = timed(&draw.problem, &draw.request, method)?;
        let explicit = method.integrator == Integrator::DormandPrince;
        let reference = if explicit { &draw.by_implicit } else { &draw.by_explicit };
        let [displacement, swing] = errors(&taken.history, reference);
        errors_of[0].push(displacement);
        errors_of[1].push(swing);
        seconds += taken.history.seconds / draw.request.end;
        evaluations += taken.history.evaluations;
        steps += taken.steps;
        least = least.min(repeats);
    }
    let count = draws.len() as u64;
    let [displacement, swing] = errors_of.map(median);
    let seconds = seconds / count as f64;
    eprintln!("  {of}: {variant}: {seconds:.3} s/s, {} steps, {displacement:.1e}", steps / count);
    let point = Point {
        repeats: least,
        more_errors: vec![swing],
        evaluations: Some(evaluations / count),
        ..Point::new(of, variant, seconds, displacement)
    };
    Ok(Way { method, point, steps: steps / count })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A regime under one load, with its references.
struct Draw {
    problem: DynamicProblem,
    request: RunRequest,
    by_explicit: History,
    by_implicit: History,
}

fn draw(regime: &Regime, load: &str) -> Result<Draw, CaseError> {
    let (problem, request) = request(regime, load)?;
    let explicit = Method::accurate(Integrator::DormandPrince, 1e-6);
    let implicit = Method::accurate(Integrator::Rosenbrock, 1e-5);
    let by_explicit = take(&problem, &request, explicit)?.history;
    let by_implicit = take(&problem, &request, implicit)?.history;
    Ok(Draw { problem, request, by_explicit, by_implicit })
}

/// The cheapest of so many runs.
fn timed(
    problem: &DynamicProblem,
    request: &RunRequest,
    method: Method,
) -> Result<(Taken, usize), CaseError> {
    let mut best = take(problem, request, method)?;
    let (mut repeats, mut spent) = (1, best.history.seconds);
    while spent < 0.3 && repeats < 5 {
        let again = take(problem, request, method)?;
        spent += again.history.seconds;
        repeats += 1;
        if again.history.seconds < best.history.seconds {
            best = again;
        }
    }
    Ok((best, repeats))
}

fn run(context: &mut ParetoContext) -> Result<(), CaseError> {
    use Integrator::{DormandPrince, Rosenbrock, RungeKutta};
    context.keep_series_apart();
    for regime in &REGIMES {
        let (name, loads) = (regime.0, regime.6);
        let draws = loads.iter().map(|load| draw(regime, load)).collect::<Result<Vec<_>, _>>()?;
        let Draw { problem, request, .. } = &draws[draws.len() / 2];
        let choice = choose(&problem.assembly());
        let default = Method { integrator: choice.integrator, stepping: request.options.stepping };
        let accuracies = [1e-2, 1e-3, 1e-4];
        let mut methods =
            vec![Method { integrator: RungeKutta, stepping: Stepping::FractionOfLimit(0.5) }];
        for integrator in [DormandPrince, Rosenbrock] {
            methods.extend(accuracies.map(|accuracy| Method::accurate(integrator, accuracy)));
        }
        let mut ways: Vec<Way> = Vec::new();
        for method in methods {
            let chosen = if method == default { ", the default" } else { "" };
            let variant = format!("{} {}{chosen}", method.integrator.name(), method.variant());
            ways.push(way(&draws, method, name, &variant)?);
        }
        let Some(Way { point: own, steps, .. }) = ways.iter().find(|way| way.method == default)
        else {
            return Err(CaseError::message("the default is none of the ways"));
        };
        // The cheapest that deliver no larger an error: of the other methods, and of all.
        let cheapest = |belongs: &dyn Fn(&Method) -> bool| {
            let rivals =
                ways.iter().filter(|way| belongs(&way.method) && way.point.error <= own.error);
            rivals.min_by(|a, b| a.point.seconds.total_cmp(&b.point.seconds))
        };
        let against = |rival: Option<&Way>| match rival {
            None => "no way is".to_string(),
            Some(Way { point, .. }) => format!(
                "{:.2} of {} ({:.2} s, {:.1e})",
                own.seconds / point.seconds,
                point.variant,
                point.seconds,
                point.error
            ),
        };
        let others = against(cheapest(&|m| m.integrator != default.integrator));
        let all = against(cheapest(&|_| true));
        let apart = draws.iter().map(|draw| errors(&draw.by_implicit, &draw.by_explicit)[0]);
        let apart = median(apart.collect());
        context.sentence(format!(
            "{name}: {}, error {:.1e} of {}, {:.2} s a simulated second. Of what is no farther off, the cheapest: of \
             the other methods {others}; of all {all}. {steps} steps; the two references are {apart:.1e} apart.",
            own.variant,
            own.error,
            "the race's displacement",
            own.seconds,
        ));
        for way in ways {
            context.push(way.point);
        }
    }
    context
        .sentence("Times are those of a simulated second, of steps and rows, without the start.");
    Ok(())
}
