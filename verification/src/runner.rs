//! Runs cases, one after the other or side by side, and survives whatever they do.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use crate::cache::Cache;
use crate::case::{Case, Computation};
use crate::context::CaseContext;
use crate::golden::{self, GoldenValue};
use crate::judge::{self, Verdict};
use crate::published::Published;
use crate::report::{Cached, CaseReport, CaseStatus, GoldenReport, GoldenStatus};
use crate::{cases, page, readme};

/// What a case recorded, how it ended and how long it took.
#[derive(Clone, Debug)]
pub struct Run {
    pub record: CaseContext,
    /// The error or the panic that ended it early.
    pub error: Option<String>,
    /// Of the computation, whenever it was.
    pub seconds: f64,
    /// When it was computed, if it was not now but comes from the cache.
    pub computed: Option<String>,
}

/// Does `work` for each case, by its index: `jobs` at a time on threads of their own, since cases know nothing of each
/// other, and those that time something alone, when the others are done. One job is the caller's thread, and keeps the order.
///
/// # Errors
/// The first of `work`; no case is begun after it.
pub fn side_by_side<T: Send + Sync, E: Send + Sync>(
    cases: &[Case],
    jobs: usize,
    work: impl Fn(usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let all = 0..cases.len();
    if jobs <= 1 {
        return all.map(work).collect();
    }
    let (alone, others): (Vec<_>, Vec<_>) = all.partition(|case| cases::is_timed(cases[*case].id));
    let done: Vec<OnceLock<T>> = cases.iter().map(|_| OnceLock::new()).collect();
    let failed = OnceLock::new();
    for (jobs, queue) in [(jobs, others), (1, alone)] {
        let next = AtomicUsize::new(0);
        let go = || {
            while failed.get().is_none()
                && let Some(case) = queue.get(next.fetch_add(1, Ordering::Relaxed))
            {
                // A cell is set once: each case is one thread's, and of several errors the first stays.
                match work(*case) {
                    Ok(result) => drop(done[*case].set(result)),
                    Err(error) => drop(failed.set(error)),
                }
            }
        };
        std::thread::scope(|scope| (0..jobs).for_each(|_| drop(scope.spawn(go))));
    }
    match failed.into_inner() {
        Some(error) => Err(error),
        None => Ok(done.into_iter().filter_map(OnceLock::into_inner).collect()),
    }
}

/// A case's run: from the cache where the case is a long one and nothing has changed, else
/// computed, and kept for the next time.
///
/// # Errors
/// Beside the run, why it could not be kept.
pub fn run(case: &Case, cache: &Cache) -> (Run, Result<(), String>) {
    match cache.take(case) {
        Some(run) => (run, Ok(())),
        None => {
            let run = compute(case.run);
            let kept = cache.keep(case, &run);
            (run, kept)
        }
    }
}

/// Compute a case. The text of its published numbers does not come in here.
pub fn compute(computation: Computation) -> Run {
    let mut record = CaseContext::default();
    let start = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| computation(&mut record)));
    let seconds = start.elapsed().as_secs_f64();
    let error = match outcome {
        Ok(Ok(())) => None,
        Ok(Err(error)) => Some(error.to_string()),
        Err(payload) => Some(format!("panicked: {}", panic_message(payload.as_ref()))),
    };
    Run { record, error, seconds, computed: None }
}

fn panic_message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

/// Judge a finished run against its published numbers and its past.
pub fn assess(case: &Case, run: &Run, golden_folder: &Path) -> CaseReport {
    let record = &run.record;
    let (mut problems, verdict) = match Published::parse(case.published) {
        Ok(published) => {
            let verdict = judge::judge(record, &published);
            // Only a run that holds can show that altering a number would break it.
            let idle = match verdict.holds() && run.error.is_none() {
                true => judge::entries_without_effect(record, &published),
                false => Vec::new(),
            };
            let idle = idle.iter().map(|id| {
                format!(
                    "published value `{id}` could be altered far beyond its tolerance unnoticed"
                )
            });
            (idle.collect(), verdict)
        }
        Err(error) => (vec![error.to_string()], judge::judge(record, &Published::default())),
    };
    let Verdict { checks, problems: misuses } = verdict;
    // A case that ended early has not said all it would: what is missing says nothing new.
    if run.error.is_none() {
        problems.extend(misuses);
        problems.extend(match readme::text() {
            Ok(text) => readme::stale(&text, case.id, &checks),
            Err(error) => vec![error],
        });
        let page = std::fs::read_to_string(page::path()).unwrap_or_default();
        problems.extend(page::stale(&page, case.id, &checks));
    }
    let golden = compare_golden(case.id, &record.golden, golden_folder);
    let mut report = CaseReport {
        id: case.id.to_string(),
        title: case.title.to_string(),
        section: case.section.to_string(),
        tier: case.tier,
        status: CaseStatus::Passed,
        seconds: Some(run.seconds),
        cached: run.computed.clone().map(Cached::computed),
        error: run.error.clone(),
        problems,
        worst_ratio: worst(checks.iter().filter_map(|check| check.ratio)),
        checks,
        assumptions: record.assumptions.clone(),
        figures: record.figures.clone(),
        findings: record.findings.clone(),
        tables: record.tables.clone(),
        work: record.work.clone(),
        golden,
    };
    report.status = report.verdict();
    report
}

fn worst(ratios: impl Iterator<Item = f64>) -> Option<f64> {
    ratios.fold(None, |worst, ratio| Some(worst.map_or(ratio, |other: f64| other.max(ratio))))
}

fn compare_golden(case: &str, values: &[GoldenValue], folder: &Path) -> GoldenReport {
    let changed = |differences: Vec<String>| GoldenReport {
        status: GoldenStatus::GoldenChanged,
        values: values.len(),
        differences,
        last_reason: None,
    };
    if let Err(error) = golden::validate(values) {
        return changed(vec![error.to_string()]);
    }
    match golden::read(folder, case) {
        Err(error) => changed(vec![error.to_string()]),
        Ok(None) if values.is_empty() => {
            GoldenReport { status: GoldenStatus::None, ..GoldenReport::default() }
        }
        Ok(None) => GoldenReport {
            status: GoldenStatus::GoldenMissing,
            values: values.len(),
            differences: vec![format!("no golden file; make golden CASE={case} REASON=\"…\"")],
            last_reason: None,
        },
        Ok(Some(file)) => {
            let mut differences = golden::differences(&file.values, values);
            differences.extend(file.unsound().map(|what| format!("golden/{case}.json: {what}")));
            let status = match differences.is_empty() {
                true => GoldenStatus::Unchanged,
                false => GoldenStatus::GoldenChanged,
            };
            let last_reason = file.history.last().cloned();
            GoldenReport { status, values: values.len(), differences, last_reason }
        }
    }
}
