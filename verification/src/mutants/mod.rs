//! Mutation check: faults seeded in the physics one at a time, each of which a test must catch.
//!
//! `verification/mutants/mutants.toml` lists them. The sources are copied, so that the working
//! tree is never touched; verdicts are kept, so that an interrupted run goes on where it was.

pub mod list;
pub mod report;
pub mod workshop;

use std::collections::{BTreeMap, VecDeque};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use list::{Check, List, Mutant};
use report::{Outcome, Proof, Results, Verdict};
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

/// Faults that the same program is to catch, with their keys.
type Group<'a> = Vec<(&'a Mutant, String)>;

/// What the workers share.
struct Work<'a> {
    groups: VecDeque<Group<'a>>,
    results: Results,
    done: usize,
    /// The first one ends the run.
    error: Option<String>,
}

/// What stays the same for all workers.
struct Frame<'a> {
    list: &'a List,
    sources: &'a Sources,
    folder: &'a Path,
    todo: usize,
}

/// Runs the mutants of the repository at `root`, or only those named, side by side on `jobs`
/// processors: each worker has a copy of the sources and a folder of what is built from it, and takes
/// all faults that one program is to catch, so that this program is built from nothing only once.
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
    let todo: Group = selected
        .iter()
        .map(|mutant| (*mutant, sources.key(&mutant.caught_by, &mutant.text())))
        .filter(|(mutant, key)| !results.holds(&mutant.id, key))
        .collect();
    let frame = Frame { list: &list, sources: &sources, folder: &folder, todo: todo.len() };
    let groups = grouped(todo);
    let workers = jobs.clamp(1, groups.len().max(1));
    let work = Mutex::new(Work { groups, results, done: 0, error: None });
    std::thread::scope(|scope| {
        for worker in 0..workers {
            let (frame, work) = (&frame, &work);
            scope.spawn(move || {
                if let Err(error) = run_groups(frame, work, worker, (jobs / workers).max(1)) {
                    lock(work).error.get_or_insert(error);
                }
            });
        }
    });
    let work = work.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(error) = work.error {
        return Err(error);
    }
    work.results.write(&folder, &list)?;
    let verdict = |mutant: &Mutant| work.results.verdict(&mutant.id);
    let survived = selected.iter().filter(|m| verdict(m) == Some(&Verdict::Survived)).count();
    Ok(Tally { caught: selected.len() - survived, survived })
}

/// By the program of the check named first; the largest groups first, so that workers end together.
fn grouped(todo: Group) -> VecDeque<Group> {
    let mut by_program: BTreeMap<String, Group> = BTreeMap::new();
    for (mutant, key) in todo {
        let program = mutant.caught_by.first().map(Check::program).unwrap_or_default();
        by_program.entry(program).or_default().push((mutant, key));
    }
    let mut groups: Vec<Group> = by_program.into_values().collect();
    // File by file: putting one fault right and the next one in then changes a single module.
    groups.iter_mut().for_each(|group| group.sort_by(|a, b| a.0.file.cmp(&b.0.file)));
    groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
    groups.into()
}

fn lock<'a, 'b>(work: &'a Mutex<Work<'b>>) -> MutexGuard<'a, Work<'b>> {
    work.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A worker's whole work: group after group, until none is left or something went wrong.
fn run_groups(
    frame: &Frame,
    work: &Mutex<Work>,
    worker: usize,
    processors: usize,
) -> Result<(), String> {
    let place = match worker {
        0 => frame.folder.to_path_buf(),
        other => frame.folder.join(format!("worker-{}", other + 1)),
    };
    let workshop = Workshop::new(frame.sources, &place, processors)?;
    loop {
        let mut shared = lock(work);
        let group = if shared.error.is_none() { shared.groups.pop_front() } else { None };
        drop(shared);
        let Some(group) = group else { return Ok(()) };
        prove_checks(frame, &workshop, work, &group)?;
        for (mutant, key) in &group {
            if lock(work).error.is_some() {
                return Ok(());
            }
            let clock = Instant::now();
            let verdict = judge(frame, &workshop, work, mutant)?;
            let seconds = clock.elapsed().as_secs_f64();
            let mut shared = lock(work);
            shared.done += 1;
            let (done, todo, id, words) = (shared.done, frame.todo, &mutant.id, verdict.words());
            eprintln!("mutant {done}/{todo} {id} … {words} ({seconds:.0} s)");
            shared.results.keep(Outcome { id: id.clone(), key: key.clone(), verdict, seconds });
            shared.results.write(frame.folder, frame.list)?;
        }
    }
}

/// A check that fails anyway catches nothing, and neither does one that runs no test.
fn prove_checks(
    frame: &Frame,
    workshop: &Workshop,
    work: &Mutex<Work>,
    group: &Group,
) -> Result<(), String> {
    for check in group.iter().flat_map(|(mutant, _)| &mutant.caught_by) {
        let key = frame.sources.key(std::slice::from_ref(check), "");
        if lock(work).results.proof(&key).is_some() {
            continue;
        }
        eprintln!("without any fault: {check}");
        let (ran, seconds) = workshop.run(check, LONGEST)?;
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
    workshop: &Workshop,
    work: &Mutex<Work>,
    mutant: &Mutant,
) -> Result<Verdict, String> {
    let _fault = workshop.seed(mutant)?;
    let named = mutant.caught_by.iter().map(|check| (check, true));
    let others = frame.list.fallback.iter().map(|check| (check, false));
    for (check, expected) in named.chain(others) {
        let by = check.to_string();
        let key = frame.sources.key(std::slice::from_ref(check), "");
        let proof = lock(work).results.proof(&key).map(|proof| proof.seconds);
        match workshop.run(check, proof.map_or(LONGEST, patience))?.0 {
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
