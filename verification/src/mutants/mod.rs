//! Mutation check: faults seeded in the physics one at a time, each of which a test must catch.
//!
//! `verification/mutants/mutants.toml` lists them. The sources are copied, so that the working
//! tree is never touched; verdicts are kept, so that an interrupted run goes on where it was.

pub mod list;
pub mod report;
pub mod switch;
pub mod workshop;

use std::collections::VecDeque;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use list::{Check, List, Mutant};
use report::{Outcome, Proof, Results, Verdict};
use switch::Switched;
use workshop::{Ran, Sources, Workshop};

/// What became of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub caught: usize,
    pub survived: usize,
}

/// A check without any fault may take minutes on a slow machine.
const LONGEST: Duration = Duration::from_secs(900);

/// A fault can keep a check from ever ending: it is given up after ten times what it takes without
/// one, and a minute, since the machine may have become busy meanwhile.
fn patience(without_fault: f64) -> Duration {
    Duration::from_secs_f64(60.0 + 10.0 * without_fault.max(0.0)).min(LONGEST)
}

/// A fault to judge.
struct Task<'a> {
    mutant: &'a Mutant,
    /// Of what its verdict rests on.
    key: String,
    /// Sets it off in the one build; 0 where it has to be built alone.
    number: usize,
}

/// What the workers share.
struct Work<'a> {
    tasks: VecDeque<Task<'a>>,
    results: Results,
    done: usize,
    /// The first one ends the run.
    error: Option<String>,
}

/// What stays the same for all workers.
struct Frame<'a> {
    list: &'a List,
    sources: &'a Sources,
    workshop: &'a Workshop,
    folder: &'a Path,
    todo: usize,
}

/// Runs the mutants of the repository at `root`, or only those named: first all that one build holds
/// behind switches, side by side on `jobs` processors, then the others, each with a build of its own.
///
/// # Errors
/// In words: a list that is not sound, a fault that no longer applies or does not build, a check
/// that fails without any fault.
pub fn run(root: &Path, only: &[String], jobs: usize) -> Result<Tally, String> {
    let list = List::read(&root.join("verification/mutants/mutants.toml"))?;
    if let Some(unknown) = only.iter().find(|id| list.mutants.iter().all(|m| m.id != **id)) {
        return Err(format!("no mutant `{unknown}`"));
    }
    if list.fallback.is_empty() {
        return Err("the list names no fallback".into());
    }
    list.check_applies(root)?;
    let selected: Vec<&Mutant> =
        list.mutants.iter().filter(|m| only.is_empty() || only.contains(&m.id)).collect();
    let sources = Sources::read(root)?;
    let folder = std::path::absolute(root.join("target/mutants")).map_err(|e| e.to_string())?;
    let mut results = Results::read(&folder);
    results.outcomes.retain(|outcome| list.mutants.iter().any(|m| m.id == outcome.id));
    let key = |mutant: &Mutant| sources.key(&mutant.caught_by, &mutant.text());
    let mut tasks: Vec<Task> = selected
        .iter()
        .map(|mutant| Task { mutant, key: key(mutant), number: 0 })
        .filter(|task| !results.holds(&task.mutant.id, &task.key))
        .collect();
    let todo = tasks.len();
    let workshop = Workshop::new(&folder, jobs)?;
    number(&workshop, &sources, &list.mutants, &mut tasks)?;
    // Program by program: the next one is built when the verdicts of the last one are kept.
    tasks.sort_by_key(|task| task.mutant.caught_by.first().map(Check::program));
    let (switched, alone): (VecDeque<_>, VecDeque<_>) =
        tasks.into_iter().partition(|task| task.number != 0);
    let frame =
        Frame { list: &list, sources: &sources, workshop: &workshop, folder: &folder, todo };
    let mut work = Mutex::new(Work { tasks: switched, results, done: 0, error: None });
    for (workers, next) in [(jobs, alone), (1, VecDeque::new())] {
        std::thread::scope(|scope| {
            for place in 0..workers {
                let (frame, work) = (&frame, &work);
                scope.spawn(move || {
                    if let Err(error) = work_off(frame, work, place) {
                        lock(work).error.get_or_insert(error);
                    }
                });
            }
        });
        let shared = work.get_mut().unwrap_or_else(PoisonError::into_inner);
        if let Some(error) = shared.error.take() {
            return Err(error);
        }
        if !next.is_empty() {
            workshop.fill(&sources)?;
        }
        shared.tasks = next;
    }
    let results = &lock(&work).results;
    results.write(&folder, &list)?;
    let survives = |m: &&&Mutant| results.verdict(&m.id) == Some(&Verdict::Survived);
    let survived = selected.iter().filter(survives).count();
    Ok(Tally { caught: selected.len() - survived, survived })
}

/// Numbers the tasks whose faults stand behind switches in the workshop's copy. A function in which the
/// compiler takes no switch is left as it is.
fn number(
    workshop: &Workshop,
    sources: &Sources,
    mutants: &[Mutant],
    tasks: &mut [Task],
) -> Result<(), String> {
    let mut barred = Vec::new();
    loop {
        let switched = Switched::new(sources, mutants, &barred)?;
        for task in &mut *tasks {
            task.number = switched.numbers.get(&task.mutant.id).copied().unwrap_or(0);
        }
        if tasks.iter().all(|task| task.number == 0) {
            return workshop.fill(sources);
        }
        workshop.fill(&switched.sources)?;
        let Err(messages) = workshop.compiles()? else { return Ok(()) };
        let blamed = switched.blamed(&messages);
        if blamed.is_empty() {
            return Err(format!("the sources do not build:\n{}", switch::rendered(&messages)));
        }
        barred.extend(blamed);
    }
}

fn lock<'a, 'b>(work: &'a Mutex<Work<'b>>) -> MutexGuard<'a, Work<'b>> {
    work.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A worker's whole work: task after task, until none is left or something went wrong.
fn work_off(frame: &Frame, work: &Mutex<Work>, place: usize) -> Result<(), String> {
    loop {
        let mut shared = lock(work);
        let task = if shared.error.is_none() { shared.tasks.pop_front() } else { None };
        drop(shared);
        let Some(Task { mutant, key, number }) = task else { return Ok(()) };
        prove_checks(frame, work, place, mutant)?;
        let clock = Instant::now();
        let fault = (number == 0).then(|| frame.workshop.seed(mutant)).transpose()?;
        let verdict = judge(frame, work, place, mutant, number)?;
        drop(fault);
        let seconds = clock.elapsed().as_secs_f64();
        let mut shared = lock(work);
        shared.done += 1;
        let (done, todo, id, words) = (shared.done, frame.todo, &mutant.id, verdict.words());
        let how = if number == 0 { ", built alone" } else { "" };
        eprintln!("mutant {done}/{todo} {id} … {words} ({seconds:.0} s{how})");
        shared.results.keep(Outcome { id: id.clone(), key, verdict, seconds });
        shared.results.write(frame.folder, frame.list)?;
    }
}

/// A check that fails anyway catches nothing, and neither does one that runs no test.
fn prove_checks(
    frame: &Frame,
    work: &Mutex<Work>,
    place: usize,
    mutant: &Mutant,
) -> Result<(), String> {
    for check in &mutant.caught_by {
        let key = frame.sources.key(std::slice::from_ref(check), "");
        if lock(work).results.proof(&key).is_some() {
            continue;
        }
        eprintln!("without any fault: {check}");
        let (ran, seconds) = frame.workshop.run(check, 0, place, LONGEST)?;
        match ran {
            Ran::Passed { tests: 0 } => return Err(format!("`{check}` runs no test")),
            Ran::Passed { .. } => {
                let mut shared = lock(work);
                if shared.results.proof(&key).is_none() {
                    shared.results.proven.push(Proof { key, seconds });
                }
            }
            Ran::DoesNotBuild(said) => return Err(format!("the sources do not build:\n{said}")),
            Ran::Failed | Ran::TimedOut => {
                return Err(format!("`{check}` fails without any fault"));
            }
        }
    }
    Ok(())
}

fn judge(
    frame: &Frame,
    work: &Mutex<Work>,
    place: usize,
    mutant: &Mutant,
    number: usize,
) -> Result<Verdict, String> {
    let named = mutant.caught_by.iter().map(|check| (check, true));
    let others = frame.list.fallback.iter().map(|check| (check, false));
    for (check, expected) in named.chain(others) {
        let by = check.to_string();
        let key = frame.sources.key(std::slice::from_ref(check), "");
        let proof = lock(work).results.proof(&key).map(|proof| proof.seconds);
        let patience = proof.map_or(LONGEST, patience);
        match frame.workshop.run(check, number, place, patience)?.0 {
            Ran::Passed { .. } => {}
            Ran::Failed if expected => return Ok(Verdict::Caught { by }),
            Ran::TimedOut if expected => return Ok(Verdict::Caught { by: by + " (never ends)" }),
            // That these checks pass without the fault is shown only now, as they are many.
            Ran::Failed | Ran::TimedOut => {
                return Ok(Verdict::CaughtElsewhere { by });
            }
            Ran::DoesNotBuild(said) => {
                return Err(format!("mutant `{}` does not build:\n{said}", mutant.id));
            }
        }
    }
    Ok(Verdict::Survived)
}
