//! `bearing run SCENE`: steps in time or a quasi-static sequence, and the results folder.

mod changed;
mod figures;
mod prepared;
mod results;
mod texts;

pub use prepared::{check_end, planned_request, request};

use super::earlier::{Writes, claimed, refuse_unfinished_run, remove_earlier};
use super::{Changes, CommandResult, Outcome, interruption, print, results_folder};
use bearing_dynamics::motion::bonded_bushing::BondedBushing;
use bearing_dynamics::motion::explicit_solid::SteppedSolid;
use bearing_dynamics::output::session::{Motion, Session, SessionError, Status};
use bearing_dynamics::output::state::{self, StateError, StateFile, StateRecord, Stopped};
use bearing_dynamics::scene::{Document, resolve_subject};
use bearing_dynamics::solids::explicit::ExplicitSolid;
use indicatif::{ProgressBar, ProgressStyle};
use prepared::Prepared;
use results::{Seconds, write_fields_file, write_results};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Steps of a bearing between two checks of signals and clock: under a millisecond.
const STEPS_AT_ONCE: u64 = 50;
/// Usual wall time between two saved states, s.
const SAVE_EVERY: u64 = 30;
/// Elements evaluated between two checks: a few milliseconds.
const ELEMENTS_AT_ONCE: u64 = 200_000;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json) with a [numerics] table
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
    /// Results folder [default: results/<name of the scene>-run]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Resume from the state in the results folder; the scene's end may be later than before
    #[arg(long)]
    resume: bool,
    /// Discard an unfinished run, or results of another kind, in the results folder
    #[arg(long, conflicts_with = "resume")]
    fresh: bool,
    /// Number of threads, with bitwise identical results; a bearing of rigid parts uses one
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Wall time between two saved states, s
    #[arg(long, value_name = "SECONDS", default_value_t = SAVE_EVERY, value_parser = whole_seconds,
          allow_negative_numbers = true)]
    save_every: u64,
}

fn whole_seconds(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0 => Ok(seconds),
        _ => Err("whole seconds, 1 or more, such as 30".into()),
    }
}

/// How a run ended.
pub enum End {
    Complete,
    /// With the place it has reached.
    Interrupted(String),
    Failed(String),
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let document = arguments.changes.read(&arguments.scene)?;
    let subject = resolve_subject(&document)?;
    check_end(&arguments.scene, &subject)?;
    let folder = results_folder(&arguments.scene, "run", &arguments.out);
    let folder = claimed(&folder, Writes::Run { fresh: arguments.fresh })?;
    let kept = kept_state(arguments, &folder)?;
    let prepared = Prepared::new(&document, &subject)?;
    let read = start.elapsed().as_secs_f64();
    let interrupted = interruption(|| {})?;
    let job = Job {
        document: &document,
        prepared: &prepared,
        read,
        folder: &folder,
        kept,
        threads: usize::from(arguments.threads),
        save_every: Duration::from_secs(arguments.save_every),
        interrupted: &interrupted,
        is_silent: false,
    };
    match job.run()? {
        End::Complete => Ok(Outcome::Done),
        End::Interrupted(place) => Err(format!(
            "interrupted at {place}; the results so far are in {out}. To resume: bearing run {} \
             --out {out}{} --resume",
            arguments.scene.display(),
            arguments.changes.again(),
            out = folder.display(),
        )
        .into()),
        End::Failed(error) => Err(error.into()),
    }
}

/// A run into a claimed folder that prints nothing, on one thread; it resumes if the folder has a saved state.
///
/// # Errors
/// What keeps the run from starting, and files that cannot be written.
pub fn run_silently(
    document: &Document,
    folder: &Path,
    interrupted: &AtomicBool,
) -> Result<End, Box<dyn Error>> {
    let start = Instant::now();
    let subject = resolve_subject(document)?;
    check_end(Path::new(document.name()), &subject)?;
    let prepared = Prepared::new(document, &subject)?;
    let job = Job {
        document,
        prepared: &prepared,
        read: start.elapsed().as_secs_f64(),
        folder,
        kept: state::read(folder)?,
        threads: 1,
        save_every: Duration::from_secs(SAVE_EVERY),
        interrupted,
        is_silent: true,
    };
    job.run()
}

/// The saved state, with `--resume`.
fn kept_state(arguments: &Arguments, folder: &Path) -> Result<Option<StateFile>, Box<dyn Error>> {
    if arguments.resume {
        let none = || {
            format!(
                "{} holds no run to resume (there is no {}); name the folder of one with --out, or start \
                 a new run without --resume",
                folder.display(),
                state::STATE
            )
        };
        return Ok(Some(state::read(folder)?.ok_or_else(none)?));
    }
    if !arguments.fresh {
        refuse_unfinished_run(folder)?;
    }
    Ok(None)
}

/// A run into a claimed folder.
struct Job<'j> {
    document: &'j Document,
    prepared: &'j Prepared<'j>,
    /// Wall time of its preparation, s.
    read: f64,
    folder: &'j Path,
    /// The state it resumes from.
    kept: Option<StateFile>,
    threads: usize,
    /// Wall time between two saved states.
    save_every: Duration,
    interrupted: &'j AtomicBool,
    /// Prints nothing and shows no progress, as one of many runs.
    is_silent: bool,
}

impl Job<'_> {
    /// Runs to the end, a signal or an error of the run itself, and writes the results.
    ///
    /// # Errors
    /// What keeps the run from starting, and files that cannot be written.
    fn run(&self) -> Result<End, Box<dyn Error>> {
        let Job { prepared, folder, .. } = *self;
        let kept = self.kept.as_ref();
        let (request, choice) = prepared.request()?;
        let mut seconds = Seconds { read: self.read, ..Seconds::default() };
        let start = Instant::now();
        let parts = prepared.parts(self.threads)?;
        let record = StateRecord {
            fingerprint: state::fingerprint(&parts, &request),
            stopped: Stopped::Running,
            error: None,
            seconds: kept.map_or(0.0, |file| file.seconds),
        };
        let mut session = match kept {
            Some(file) => match state::resume(folder, file, parts, &request) {
                Err(error @ StateError::Scene { .. }) => {
                    let now = prepared.record(self.document, &request, None, Vec::new())?;
                    return Err(format!("{error}{}", changed::since(folder, &now)).into());
                }
                other => other?,
            },
            None => {
                if remove_earlier(folder)? {
                    let folder = folder.display();
                    self.print(&format!("the earlier results in {folder} are replaced\n"))?;
                }
                Session::start(parts, &request)?
            }
        };
        seconds.start = start.elapsed().as_secs_f64();
        for note in prepared.notes() {
            self.print(&format!("note: {note}\n"))?;
        }
        let shared = matches!(session.motion, Motion::Solid(_) | Motion::Housed(_));
        if self.threads > 1 && !shared {
            self.print(
                "note: --threads has no effect here: only explicit finite elements run in parallel\n",
            )?;
        }
        self.print(&texts::announcement(&session, prepared, &request, choice.as_ref(), kept))?;

        let start = Instant::now();
        if kept.is_none() && session.clock.fields_due() == Some(0) {
            write_fields_file(folder, prepared, &mut session, 0)?;
        }
        let stop = self.simulate(&record, &mut session)?;
        seconds.simulate = record.seconds + start.elapsed().as_secs_f64();
        let (stopped, stopped_by) = match &stop {
            Stop::Complete => (Stopped::Complete, None),
            Stop::Interrupted => (Stopped::Interrupted, Some("interrupted".to_string())),
            Stop::Failed(error) => (Stopped::Failed, Some(error.to_string())),
        };
        let error = stopped_by.clone().filter(|_| stopped == Stopped::Failed);
        // Saved first, so that an error in plots or tables does not lose the run.
        let last = StateRecord { stopped, error, seconds: seconds.simulate, ..record };
        state::save(folder, &mut session, &last)?;
        let request = (&request, choice);
        let text = write_results(
            folder,
            (self.document, prepared),
            &mut session,
            request,
            stopped_by,
            &seconds,
        )?;
        self.print(&text)?;
        Ok(match stop {
            Stop::Complete => End::Complete,
            Stop::Interrupted => End::Interrupted(texts::place(&session)),
            Stop::Failed(error) => {
                let kept = match session.motion {
                    Motion::Bearing(_) => "before that step",
                    Motion::Solid(_)
                    | Motion::Housed(_)
                    | Motion::QuasiStaticSequence(_)
                    | Motion::Rubber(_) => "at the last row",
                };
                let folder = folder.display();
                End::Failed(format!(
                    "{error}; the rows so far and the state {kept} are in {folder}"
                ))
            }
        })
    }

    fn print(&self, text: &str) -> Result<(), Box<dyn Error>> {
        if self.is_silent { Ok(()) } else { print(text) }
    }

    /// Steps until the end, a signal or an error; saves the state at intervals.
    fn simulate(
        &self,
        record: &StateRecord,
        session: &mut Session,
    ) -> Result<Stop, Box<dyn Error>> {
        let bar = if self.is_silent { ProgressBar::hidden() } else { progress_bar(session) };
        let start = Instant::now();
        let mut saved = start;
        let at_once = at_once(session);
        let stop = loop {
            match session.advance(at_once) {
                Ok(Status::Complete) => break Stop::Complete,
                Ok(Status::Running) => {}
                Ok(Status::Fields(index)) => {
                    write_fields_file(self.folder, self.prepared, session, index)?;
                }
                Err(error) => break Stop::Failed(error),
            }
            if self.interrupted.load(Ordering::Relaxed) {
                break Stop::Interrupted;
            }
            if saved.elapsed() >= self.save_every {
                let seconds = record.seconds + start.elapsed().as_secs_f64();
                state::save(self.folder, session, &StateRecord { seconds, ..record.clone() })?;
                saved = Instant::now();
            }
            if !bar.is_hidden() {
                bar.set_position(permille(session));
                bar.set_message(texts::progress(session));
            }
        };
        bar.finish_and_clear();
        Ok(stop)
    }
}

enum Stop {
    Complete,
    Interrupted,
    Failed(SessionError),
}

/// Steps, coupling steps or equilibria between two checks of signals and clock.
fn at_once(session: &Session) -> u64 {
    let elements = |solid: &ExplicitSolid| solid.model.problem.elements.len().max(1) as u64;
    match &session.motion {
        Motion::Bearing(_) => STEPS_AT_ONCE,
        Motion::QuasiStaticSequence(_) | Motion::Rubber(_) => 1,
        Motion::Solid(moving) => (ELEMENTS_AT_ONCE / elements(&moving.solid)).max(1),
        Motion::Housed(housed) => {
            let per_coupling_step = |part: &SteppedSolid| elements(&part.solid) * part.steps as u64;
            let of_solids: u64 = housed.solids.iter().map(per_coupling_step).sum();
            let of_bushings: u64 = housed.bushings.iter().map(BondedBushing::effort).sum();
            (ELEMENTS_AT_ONCE / (of_solids + of_bushings).max(1)).max(1)
        }
    }
}

/// Completed part of the run, in thousandths.
fn permille(session: &Session) -> u64 {
    (1000.0 * session.motion.time() / session.clock.end) as u64
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
