//! Seeded faults: each changes one text of `src`, and a test or a case has to fail with it.
//!
//! `verification/mutants/mutants.toml` lists them. One build holds all of them behind switches, in a
//! copy of the repository in `target/mutants`.

pub mod list;
pub mod programs;
pub mod switch;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use list::{Check, List, Mutant};
use programs::{Programs, StageCounts};

/// Numbers of faults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub caught: usize,
    pub survived: usize,
}

/// Time limit of a check without a fault.
const LONGEST: Duration = Duration::from_secs(900);

/// Time limit of a check with a fault, which may keep it from ending: a minute and ten times what the check
/// takes without a fault.
fn time_limit(without_fault: f64) -> Duration {
    Duration::from_secs_f64(60.0 + 10.0 * without_fault.max(0.0)).min(LONGEST)
}

/// Runs the faults of the repository at `root`, or only those named, on `jobs` processors, and prints a line
/// for each.
///
/// # Errors
/// When the list is not sound, a text does not occur exactly once, the sources do not build, or a
/// check fails or runs no test without a fault.
pub fn run(root: &Path, only: &[String], jobs: usize) -> Result<Counts, String> {
    let list = List::read(root)?;
    if let Some(unknown) = only.iter().find(|id| list.mutants.iter().all(|m| m.id != **id)) {
        return Err(format!("no fault `{unknown}`"));
    }
    let sources = switch::switched(&list::read_sources(root)?, &list.mutants)?;
    let selected: Vec<(usize, &Mutant)> = (1..)
        .zip(&list.mutants)
        .filter(|(_, mutant)| only.is_empty() || only.contains(&mutant.id))
        .collect();
    let checks: Vec<&Check> = selected
        .iter()
        .flat_map(|(_, mutant)| &mutant.caught_by)
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    let programs = Programs::build(root, &sources, &checks, jobs)?;
    let proven = on_threads(jobs, &checks, |thread, check| prove(&programs, check, thread))?;
    let seconds: BTreeMap<&Check, f64> = checks.iter().copied().zip(proven).collect();
    let done = AtomicUsize::new(0);
    let caught = on_threads(jobs, &selected, |thread, (number, mutant)| {
        let by = judge(&programs, &seconds, mutant, *number, thread)?;
        let verdict = by.as_ref().map_or("SURVIVED".into(), |by| format!("caught by {by}"));
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        eprintln!("fault {done}/{} {} … {verdict}", selected.len(), mutant.id);
        Ok(by.is_some())
    })?;
    let caught = caught.into_iter().filter(|caught| *caught).count();
    Ok(Counts { caught, survived: selected.len() - caught })
}

/// Seconds that a check takes without a fault. A check that fails anyway, or runs no test, catches nothing.
fn prove(programs: &Programs, check: &Check, thread: usize) -> Result<f64, String> {
    match programs.run(check, 0, thread, LONGEST)? {
        (StageCounts::Passed { tests: 0 }, _) => Err(format!("`{check}` runs no test")),
        (StageCounts::Passed { .. }, seconds) => Ok(seconds),
        (StageCounts::Failed | StageCounts::TimedOut, _) => {
            Err(format!("`{check}` fails without any fault"))
        }
    }
}

/// The first check that fails with a fault.
fn judge(
    programs: &Programs,
    seconds: &BTreeMap<&Check, f64>,
    mutant: &Mutant,
    number: usize,
    thread: usize,
) -> Result<Option<String>, String> {
    for check in &mutant.caught_by {
        match programs.run(check, number, thread, time_limit(seconds[check]))?.0 {
            StageCounts::Passed { .. } => {}
            StageCounts::Failed => return Ok(Some(check.to_string())),
            StageCounts::TimedOut => return Ok(Some(format!("{check} (does not end)"))),
        }
    }
    Ok(None)
}

/// Results of `work` for every item, in their order, on `jobs` threads. The first error ends the work.
fn on_threads<T: Sync, R: Send>(
    jobs: usize,
    items: &[T],
    work: impl Fn(usize, &T) -> Result<R, String> + Sync,
) -> Result<Vec<R>, String> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(BTreeMap::new());
    std::thread::scope(|scope| {
        for thread in 0..jobs {
            let (next, results, work) = (&next, &results, &work);
            scope.spawn(move || {
                while let Some((index, item)) = Some(next.fetch_add(1, Ordering::Relaxed))
                    .and_then(|i| Some((i, items.get(i)?)))
                {
                    let result = work(thread, item);
                    if result.is_err() {
                        next.store(items.len(), Ordering::Relaxed);
                    }
                    results.lock().unwrap_or_else(PoisonError::into_inner).insert(index, result);
                }
            });
        }
    });
    results.into_inner().unwrap_or_else(PoisonError::into_inner).into_values().collect()
}
