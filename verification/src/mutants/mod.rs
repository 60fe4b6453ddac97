//! Mutation check: faults seeded in the physics one at a time, each of which a test must catch.
//!
//! `verification/mutants/mutants.toml` lists them. The sources are copied, so that the working
//! tree is never touched; verdicts are kept, so that an interrupted run goes on where it was.

pub mod list;
pub mod report;
pub mod workshop;

use std::path::Path;
use std::time::Instant;

use list::{Check, List, Mutant};
use report::{Outcome, Results, Verdict};
use workshop::{Ran, Workshop};

/// What became of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub caught: usize,
    pub survived: usize,
}

/// Runs the mutants of the repository at `root`, or only those named; `jobs` processors at most.
///
/// # Errors
/// In words: a list that is not sound, a fault that no longer applies or does not build, a check
/// that fails without any fault.
pub fn run(root: &Path, only: &[String], jobs: usize) -> Result<Tally, String> {
    let list = List::read(&root.join("verification/mutants/mutants.toml"))?;
    if let Some(unknown) = only.iter().find(|id| list.mutants.iter().all(|m| m.id != **id)) {
        return Err(format!("no mutant `{unknown}`"));
    }
    list.check_applies(root)?;
    let selected: Vec<&Mutant> =
        list.mutants.iter().filter(|m| only.is_empty() || only.contains(&m.id)).collect();
    let workshop = Workshop::new(root, jobs)?;
    let mut results = Results::read(workshop.folder());
    results.outcomes.retain(|outcome| list.mutants.iter().any(|m| m.id == outcome.id));
    let todo: Vec<(&Mutant, String)> = selected
        .iter()
        .map(|mutant| (*mutant, workshop.key(&mutant.caught_by, &mutant.text())))
        .filter(|(mutant, key)| !results.holds(&mutant.id, key))
        .collect();
    prove_checks(&workshop, &mut results, &list.fallback, &todo)?;
    for (index, (mutant, key)) in todo.iter().enumerate() {
        eprint!("mutant {}/{} {} … ", index + 1, todo.len(), mutant.id);
        let clock = Instant::now();
        let verdict = judge(&workshop, mutant, &list.fallback)?;
        let seconds = clock.elapsed().as_secs_f64();
        eprintln!("{} ({seconds:.0} s)", verdict.words());
        let outcome = Outcome { id: mutant.id.clone(), key: key.clone(), verdict, seconds };
        results.keep(outcome);
        results.write(workshop.folder(), &list)?;
    }
    results.write(workshop.folder(), &list)?;
    let survived = |mutant: &&&Mutant| results.verdict(&mutant.id) == Some(&Verdict::Survived);
    let survived = selected.iter().filter(survived).count();
    Ok(Tally { caught: selected.len() - survived, survived })
}

/// A check that fails anyway catches nothing, and neither does one that runs no test.
fn prove_checks(
    workshop: &Workshop,
    results: &mut Results,
    fallback: &[Check],
    todo: &[(&Mutant, String)],
) -> Result<(), String> {
    let mut seen: Vec<&Check> = Vec::new();
    for check in todo.iter().flat_map(|(mutant, _)| &mutant.caught_by) {
        let key = workshop.key(std::slice::from_ref(check), "");
        if seen.contains(&check) || results.proven.contains(&key) {
            continue;
        }
        seen.push(check);
        eprintln!("without any fault: {check}");
        match workshop.run(check)? {
            Ran::Passed { tests: 0 } => return Err(format!("`{check}` runs no test")),
            Ran::Passed { .. } => results.proven.push(key),
            Ran::DoesNotBuild(said) => return Err(format!("the sources do not build:\n{said}")),
            Ran::Failed | Ran::TimedOut => {
                return Err(format!("`{check}` fails without any fault"));
            }
        }
    }
    if fallback.is_empty() {
        return Err("the list names no fallback".into());
    }
    Ok(())
}

fn judge(workshop: &Workshop, mutant: &Mutant, fallback: &[Check]) -> Result<Verdict, String> {
    let _fault = workshop.seed(mutant)?;
    let named = mutant.caught_by.iter().map(|check| (check, true));
    let others = fallback.iter().map(|check| (check, false));
    for (check, expected) in named.chain(others) {
        let by = check.to_string();
        match workshop.run(check)? {
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
