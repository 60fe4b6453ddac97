//! `bearing run SCENE`: the bearing in motion, step after step, and the folder it leaves.

use super::earlier::{Writes, claimed, refuse_half_way, remove_earlier};
use super::plan::dynamic_plan_lines;
use super::run_figures::key_figures;
use super::{CommandResult, Outcome, echo, echo_run, remarks, results_folder, say};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::dynamics::foretell::{Choice, choose};
use bearing_dynamics::output::dynamics::pictures::{Picture, draw};
use bearing_dynamics::output::dynamics::session::{RunRequest, Session, Status, given_steps};
use bearing_dynamics::output::dynamics::summary::{RunReport, write_run_results};
use bearing_dynamics::output::dynamics::table::RunTable;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::output::state::{self, StateFile, StateRecord, Stopped};
use bearing_dynamics::scene::dynamics::{dynamic_problem, run_options};
use bearing_dynamics::scene::housing::HousingMethod;
use bearing_dynamics::scene::{
    Document, Plot, RunPlot, RunSettings, Scene, Subject, resolve_subject,
};
use bearing_dynamics::solver::channels::ChannelGroup;
use bearing_dynamics::solver::clock::rounded;
use bearing_dynamics::solver::dynamics::model::DynamicProblem;
use bearing_dynamics::solver::dynamics::run::{Integrator, SimulationError, Stepping};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Steps between two looks at signals and clock: under a millisecond.
const STEPS_AT_ONCE: u64 = 50;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json) with a [numerics] table
    pub(super) scene: PathBuf,
    /// Results folder [default: results/<name of the scene>]
    #[arg(long)]
    pub(super) out: Option<PathBuf>,
    /// Go on from the state in the results folder; the scene's end may be later than it was
    #[arg(long)]
    pub(super) resume: bool,
    /// Discard an unfinished run, or results of another kind, in the results folder
    #[arg(long, conflicts_with = "resume")]
    pub(super) fresh: bool,
    /// Threads the run may use, with the same bits; a bearing of rigid parts uses one
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: u16,
    /// Wall time between two states kept on the way, s
    #[arg(long, value_name = "SECONDS", default_value_t = 30, value_parser = whole_seconds,
          allow_negative_numbers = true)]
    pub(super) save_every: u64,
}

fn whole_seconds(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0 => Ok(seconds),
        _ => Err("whole seconds, 1 or more, such as 30".into()),
    }
}

/// How the stepping ended.
enum End {
    Complete,
    Interrupted,
    Failed(SimulationError),
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let document = Document::read_file(&arguments.scene)?;
    let scene = match resolve_subject(&document)? {
        Subject::Solid(solid) => {
            return super::solid::run::run(arguments, &document, &solid, start);
        }
        Subject::Housed(housed) => {
            return match housed.housing.method {
                HousingMethod::QuasiStatic => {
                    super::housed::course::run(arguments, &document, &housed)
                }
                HousingMethod::Explicit => {
                    super::housed::explicit::run(arguments, &document, &housed, start)
                }
            };
        }
        Subject::Bearing(scene) => *scene,
    };
    let settings =
        run_options(&scene).map_err(|error| format!("{}: {error}", arguments.scene.display()))?;
    let problem = dynamic_problem(&scene)?;
    let folder = results_folder(&arguments.scene, &arguments.out);
    let folder = claimed(&folder, Writes::Run { fresh: arguments.fresh })?;
    let kept = kept_state(arguments, &folder)?;
    let (request, choice) = planned_request(&scene, &settings, &problem, kept.as_ref());
    let read_seconds = start.elapsed().as_secs_f64();

    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))?;

    let start = Instant::now();
    let mut session = open(&folder, &problem, &request, kept.as_ref())?;
    let start_seconds = start.elapsed().as_secs_f64();
    let state = StateRecord {
        fingerprint: state::fingerprint(&problem, &request),
        stopped: Stopped::Running,
        error: None,
        output_interval: kept.as_ref().map_or(request.output_interval, |file| file.output_interval),
        seconds: kept.as_ref().map_or(0.0, |file| file.seconds),
    };
    say(&announcement(&session, &request, choice.as_ref(), kept.as_ref()))?;

    let start = Instant::now();
    let every = Duration::from_secs(arguments.save_every);
    let end = simulate(&mut session, &folder, &state, &interrupted, every)?;
    let seconds = state.seconds + start.elapsed().as_secs_f64();
    let (stopped, stopped_by) = match &end {
        End::Complete => (Stopped::Complete, None),
        End::Interrupted => (Stopped::Interrupted, Some("interrupted".to_string())),
        End::Failed(error) => (Stopped::Failed, Some(error.to_string())),
    };
    let error = stopped_by.clone().filter(|_| stopped == Stopped::Failed);
    // The state first: whatever goes wrong with plots and tables, the run is not lost.
    state::save(&folder, &session, &StateRecord { stopped, error, seconds, ..state })?;

    let start = Instant::now();
    let table = RunTable::new(&session, settings.window_start)?;
    let mut written = pictures(&folder, &scene, &table)?;
    let mut record = record(&scene, &problem, &request, choice.as_ref())?;
    let remarks = remarks::of_run(&scene, &problem, &session.simulation.extremes[0]);
    record.sections.push(("remarks".into(), json!(remarks)));
    record.seconds = vec![
        ("read".into(), read_seconds),
        ("start".into(), start_seconds),
        ("simulate".into(), seconds),
        ("plots".into(), start.elapsed().as_secs_f64()),
    ];
    let report = RunReport {
        record,
        stopped_by,
        stepping: Some(request.options.stepping),
        integrator: Some(request.options.integrator),
        spectra: scene.dynamics.plots.contains(&RunPlot::Spectrum),
    };
    written.extend(write_run_results(&folder, &session, &table, &report)?);
    say(&key_figures(&session, &table, seconds))?;
    say(&remarks.iter().map(|remark| format!("note: {remark}\n")).collect::<String>())?;
    // State beside them.
    say(&format!("wrote {} files to {}\n", written.len() + 1, folder.display()))?;
    outcome(arguments, &folder, &session, end)
}

fn outcome(arguments: &Arguments, folder: &Path, session: &Session, end: End) -> CommandResult {
    let simulation = &session.simulation;
    match end {
        End::Complete => Ok(Outcome::Done),
        End::Interrupted => Err(format!(
            "interrupted at t = {} s of {} s, after {} steps; what there is so far is in {}. To \
             go on: bearing run {} --out {} --resume",
            rounded(simulation.time),
            session.end,
            simulation.steps,
            folder.display(),
            arguments.scene.display(),
            folder.display(),
        )
        .into()),
        End::Failed(error) => Err(format!(
            "{error}; the rows so far and the state before that step are in {}",
            folder.display()
        )
        .into()),
    }
}

/// What the scene asks of a run.
pub fn request(scene: &Scene, settings: &RunSettings) -> RunRequest {
    let mut channels = settings.channels.clone();
    let plots = &scene.dynamics.plots;
    let mut needs = |groups: &[ChannelGroup]| channels.extend_from_slice(groups);
    if plots.contains(&RunPlot::SlipSpin) {
        needs(&[ChannelGroup::Slip, ChannelGroup::Orbits]);
    }
    channels.sort();
    channels.dedup();
    RunRequest {
        options: settings.options,
        end: settings.end,
        output_interval: settings.output_interval,
        channels,
    }
}

/// The same with the integrator that the plan chooses, where the scene leaves it to the plan. A run that
/// goes on does so as it began: a later end may let another one look better.
pub fn planned_request(
    scene: &Scene,
    settings: &RunSettings,
    problem: &DynamicProblem,
    kept: Option<&StateFile>,
) -> (RunRequest, Option<Choice>) {
    let mut request = request(scene, settings);
    if !settings.by_plan {
        return (request, None);
    }
    for integrator in [Integrator::Rosenbrock, Integrator::DormandPrince] {
        request.options.integrator = integrator;
        let same = |file: &StateFile| file.fingerprint == state::fingerprint(problem, &request);
        if kept.is_some_and(same) {
            return (request, Some(Choice { integrator, mean_steps: None }));
        }
    }
    let choice = choose(&problem.assembly(), &request);
    request.options.integrator = choice.integrator;
    (request, Some(choice))
}

/// Said where `--resume` finds nothing.
pub(super) fn no_run(folder: &Path) -> String {
    format!(
        "{} holds no run to go on with (there is no {}); name the folder of one with --out, or start \
         anew without --resume",
        folder.display(),
        state::STATE
    )
}

/// The state to go on from, if that was asked for; what an earlier run left is removed otherwise.
fn kept_state(arguments: &Arguments, folder: &Path) -> Result<Option<StateFile>, Box<dyn Error>> {
    if arguments.resume {
        return Ok(Some(state::read(folder)?.ok_or_else(|| no_run(folder))?));
    }
    if !arguments.fresh {
        refuse_half_way(folder)?;
    }
    remove_earlier(folder)?;
    Ok(None)
}

fn open(
    folder: &Path,
    problem: &DynamicProblem,
    request: &RunRequest,
    kept: Option<&StateFile>,
) -> Result<Session, Box<dyn Error>> {
    match kept {
        Some(file) => Ok(state::resume(folder, file, problem.clone(), request)?),
        None => Ok(Session::start(problem.clone(), request)?),
    }
}

fn announcement(
    session: &Session,
    request: &RunRequest,
    choice: Option<&Choice>,
    kept: Option<&StateFile>,
) -> String {
    let simulation = &session.simulation;
    let integrator = request.options.integrator.name();
    if let Stepping::Accuracy(accuracy) = request.options.stepping {
        let by_plan = match choice {
            Some(choice) => format!("chosen: {}\n", choice.reason()),
            None => String::new(),
        };
        let mut text = format!(
            "{integrator}, accuracy {accuracy}: steps follow from it, the first of {:.4e} s\n\
             to t = {} s, a row every {:.4e} s\n{by_plan}",
            simulation.step_size,
            session.end,
            session.interval()
        );
        text += &resumed(kept);
        return text;
    }
    let reason = match &simulation.limit {
        Some(limit) => format!("{} (stable up to {:.4e} s)", limit.reason(), limit.step),
        None => match simulation.step_watch.smallest {
            Some(limit) => {
                format!("given ({:.3} of the largest stable one)", simulation.step_size / limit)
            }
            None => "given".into(),
        },
    };
    let method = match request.options.integrator {
        Integrator::RungeKutta => String::new(),
        other => format!("{}, ", other.name()),
    };
    let mut text = format!("{method}step {:.4e} s: {reason}\n", simulation.step_size);
    if let Some([ratio, time]) = simulation.step_watch.exceeded {
        text += &format!(
            "WARNING: the step is {ratio:.3} times the largest stable one at t = {} s\n",
            rounded(time)
        );
    }
    let (interval, asked) = (session.interval(), request.output_interval);
    let rounded = if (interval / asked - 1.0).abs() > 1e-9 {
        format!(" ({asked} s asked for, rounded to whole steps)")
    } else {
        String::new()
    };
    let assembly = &simulation.system.assembly;
    let asked = RunRequest { end: session.end, output_interval: interval, ..request.clone() };
    let steps = given_steps(assembly, &asked, simulation.step_size);
    text += &format!(
        "{steps} steps to t = {} s, a row every {} steps = {interval:.4e} s{rounded}\n",
        session.end, session.steps_per_row
    );
    text += &resumed(kept);
    text
}

fn resumed(kept: Option<&StateFile>) -> String {
    kept.map_or(String::new(), |file| {
        format!("resumed at t = {} s, step {}\n", rounded(file.time), file.steps)
    })
}

/// Steps until the end, a signal or an error; keeps a state every now and then.
fn simulate(
    session: &mut Session,
    folder: &Path,
    state: &StateRecord,
    interrupted: &AtomicBool,
    save_every: Duration,
) -> Result<End, Box<dyn Error>> {
    let bar = progress_bar(session);
    let start = Instant::now();
    let mut saved = start;
    let end = loop {
        match session.advance(STEPS_AT_ONCE) {
            Ok(Status::Complete) => break End::Complete,
            Ok(Status::Running) => {}
            Err(error) => break End::Failed(error),
        }
        if interrupted.load(Ordering::Relaxed) {
            break End::Interrupted;
        }
        if saved.elapsed() >= save_every {
            let seconds = state.seconds + start.elapsed().as_secs_f64();
            state::save(folder, session, &StateRecord { seconds, ..state.clone() })?;
            saved = Instant::now();
        }
        if !bar.is_hidden() {
            let simulation = &session.simulation;
            bar.set_position(permille(session));
            bar.set_message(format!(
                "t = {:.5} of {} s, step {:.2e} s",
                simulation.time, session.end, simulation.step_size
            ));
        }
    };
    bar.finish_and_clear();
    Ok(end)
}

/// How much of the run is done, of a thousand.
fn permille(session: &Session) -> u64 {
    (1000.0 * session.simulation.time / session.end) as u64
}

fn progress_bar(session: &Session) -> ProgressBar {
    // Hidden by itself when standard error is not a terminal.
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}, {eta} left") {
        bar.set_style(style);
    }
    bar.set_position(permille(session));
    bar.reset_eta();
    bar
}

pub fn pictures(
    folder: &Path,
    scene: &Scene,
    table: &RunTable,
) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let title = scene.title.clone().unwrap_or_else(|| "Bearing".into());
    let mut asked: Vec<Picture> = scene
        .dynamics
        .plots
        .iter()
        .map(|plot| match plot {
            RunPlot::Orbit => Picture::Orbit,
            RunPlot::Spectrum => Picture::Spectrum,
            RunPlot::Series => Picture::Series,
            RunPlot::SlipSpin => Picture::SlipSpin,
        })
        .collect();
    if scene.plots.contains(&Plot::Polar) {
        asked.push(Picture::Polar);
    }
    let mut written = Vec::new();
    for picture in asked {
        for (name, svg) in draw(picture, &title, table)? {
            let path = folder.join(name);
            write_atomic(&path, svg.as_bytes())?;
            written.push(path);
        }
    }
    Ok(written)
}

fn record(
    scene: &Scene,
    problem: &DynamicProblem,
    request: &RunRequest,
    choice: Option<&Choice>,
) -> Result<RunRecord, Box<dyn Error>> {
    let assumptions = scene.assumptions.iter().map(|a| (a.name.clone(), a.text.clone()));
    let defaults = echo_run::defaults(scene)
        .into_iter()
        .map(|used| (used.key, format!("{} ({})", used.value, used.reason)));
    Ok(RunRecord {
        scene: echo::scene(scene)?,
        plan: dynamic_plan_lines(scene, problem, request, choice),
        assumptions: assumptions.chain(defaults).collect(),
        // All of a rigid bearing's work is done by one.
        threads: 1,
        seconds: Vec::new(),
        sections: vec![("motion".into(), echo_run::motion(problem)?)],
    })
}
