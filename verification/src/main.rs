//! `verify`: runs the benchmarks and writes the report.
//!
//! Exit codes: 0 all held, 1 something differs, 2 could not run.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use clap::{Parser, Subcommand};
use verification::cache::Cache;
use verification::case::{Case, Tier};
use verification::index::Index;
use verification::machine::{self, Machine};
use verification::report::{self, CaseReport, CaseStatus, Report};
use verification::{cases, golden, mutants, outside, page, pareto, runner};

#[derive(Parser)]
#[command(name = "verify", about, version, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    action: Option<Action>,
    /// Which cases: `smoke` takes seconds, `full` runs all of them.
    #[arg(long, value_enum, default_value = "smoke")]
    tier: Tier,
    /// Only this case, whatever its tier; may be given again.
    #[arg(long = "case", value_name = "ID")]
    cases: Vec<String>,
    /// Folder of the report.
    #[arg(long, value_name = "DIR", default_value = "target/verify")]
    out: PathBuf,
    /// Folder of the golden files.
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Folder of what long cases have computed; used while case, code and inputs are the same.
    #[arg(long, value_name = "DIR", default_value = "target/verify-cache")]
    cache: PathBuf,
    /// Compute long cases anew whatever the cache holds.
    #[arg(long)]
    no_cache: bool,
    /// Cases to compute at a time, one a processor; those that time something run by themselves.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..))]
    jobs: u8,
}

#[derive(Subcommand)]
enum Action {
    /// Accept the present numbers of a case as its past, with the reason.
    Golden {
        /// Case id, or `all`.
        #[arg(long = "case", value_name = "ID")]
        case: String,
        /// Why the numbers changed; kept in the file.
        #[arg(long)]
        reason: String,
        /// Folder of the golden files.
        #[arg(long, value_name = "DIR")]
        golden: Option<PathBuf>,
    },
    /// Write docs/verification.md from reports.
    Page {
        /// A report.json; may be given again, a later one replaces cases of an earlier one.
        #[arg(long, value_name = "FILE", default_value = "target/verify/report.json")]
        from: Vec<PathBuf>,
    },
    /// Run time against error, for each study.
    Pareto {
        /// Folder of the tables and figures.
        #[arg(long, value_name = "DIR", default_value = "target/pareto")]
        out: PathBuf,
        /// Only this study.
        #[arg(long, value_name = "ID")]
        study: Option<String>,
    },
    /// Seed faults in the physics, one at a time, and run the checks that have to fail.
    Mutants {
        /// Only this fault; may be given again.
        #[arg(long, value_name = "ID")]
        only: Vec<String>,
        /// Processors to use.
        #[arg(long, value_name = "N", default_value_t = 1)]
        jobs: usize,
        /// The repository.
        #[arg(long, value_name = "DIR")]
        root: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.action {
        None => verify(&arguments),
        Some(Action::Golden { case, reason, golden }) => {
            accept(&case, &reason, &golden.unwrap_or_else(golden::default_folder))
        }
        Some(Action::Page { from }) => write_page(&from),
        Some(Action::Pareto { out, study }) => studies(&out, study.as_deref()),
        Some(Action::Mutants { only, jobs, root }) => {
            let here = || Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
            seeded_faults(&root.unwrap_or_else(here), &only, jobs.max(1))
        }
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => {
            eprintln!("verify: {message}");
            ExitCode::from(2)
        }
    }
}

/// The cases asked for, in the registry's order.
fn select(ids: &[String], tier: Tier) -> Result<Vec<Case>, String> {
    if ids.is_empty() {
        return Ok(cases::of_tier(tier));
    }
    if let Some(unknown) = ids.iter().find(|id| cases::find(id).is_none()) {
        let known: Vec<&str> = cases::CASES.iter().map(|case| case.id).collect();
        return Err(format!("no case `{unknown}`; there are: {}", known.join(", ")));
    }
    Ok(cases::CASES.iter().copied().filter(|case| ids.iter().any(|id| id == case.id)).collect())
}

fn verify(arguments: &Arguments) -> Result<bool, String> {
    let selected = select(&arguments.cases, arguments.tier)?;
    let skipped = outside::skipped(&selected)?;
    let golden_folder = arguments.golden.clone().unwrap_or_else(golden::default_folder);
    let report = Report {
        machine: Machine::facts(),
        tier: arguments.tier,
        index: Index::load().map_err(|error| format!("source_index.toml: {error}"))?,
        cases: selected.iter().map(CaseReport::pending).collect(),
    };
    let save = |report: &Report| {
        report
            .write(&arguments.out)
            .map_err(|error| format!("{}: {error}", arguments.out.display()))
    };
    save(&report)?;
    let cache = match arguments.no_cache {
        true => Cache::none(),
        false => Cache::open(&arguments.cache),
    };
    let (start, shared) = (Instant::now(), Mutex::new(report));
    runner::side_by_side(&selected, arguments.jobs.into(), |index| {
        let case = &selected[index];
        let begun = format!("case {}/{} {} … ", index + 1, selected.len(), case.id);
        if arguments.jobs == 1 {
            eprint!("{begun}");
        }
        let (run, kept) = runner::run(case, &cache);
        let outcome = runner::assess(case, &run, &golden_folder);
        let mut report = shared.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = if arguments.jobs == 1 { "" } else { &begun };
        say(begun, &outcome, run.seconds);
        if let Err(reason) = kept {
            eprintln!("    not cached: {reason}");
        }
        report.cases[index] = outcome;
        report.machine.threads = report.machine.threads.max(machine::threads());
        save(&report)
    })?;
    let report = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    let held = report.cases.iter().filter(|case| case.status == CaseStatus::Passed).count();
    let (cached, before) = report.cached();
    let cached = match cached {
        0 => String::new(),
        count => format!(" (and {before:.1} s in earlier runs: {count} from the cache)"),
    };
    eprintln!(
        "{held} of {} cases passed in {:.1} s{cached}; report: {}",
        report.cases.len(),
        start.elapsed().as_secs_f64(),
        arguments.out.join("report.html").display()
    );
    skipped.iter().for_each(|line| eprintln!("{line}"));
    Ok(report.passed())
}

/// One line of a case, and what failed in it.
fn say(begun: &str, outcome: &CaseReport, seconds: f64) {
    let cached =
        outcome.cached.as_ref().map_or(String::new(), |cached| format!("; {}", cached.note));
    eprintln!(
        "{begun}{} ({} checks, {seconds:.2} s{cached})",
        outcome.status.word(),
        outcome.checks.len()
    );
    if outcome.status != CaseStatus::Passed {
        for failure in outcome.failures().iter().take(8) {
            eprintln!("    {failure}");
        }
    }
}

/// Write golden files; a case that does not hold against the world is not accepted as a past.
fn accept(case: &str, reason: &str, folder: &Path) -> Result<bool, String> {
    if reason.trim().is_empty() {
        return Err(golden::GoldenError::EmptyReason.to_string());
    }
    let all = case == "all";
    let ids = if all { Vec::new() } else { vec![case.to_string()] };
    let mut accepted = true;
    for case in select(&ids, Tier::Full)? {
        let run = runner::compute(case.run);
        let outcome = runner::assess(&case, &run, folder);
        if outcome.status == CaseStatus::Failed {
            eprintln!("{}: not accepted, the case fails:", case.id);
            outcome.failures().iter().for_each(|failure| eprintln!("    {failure}"));
            accepted = false;
            continue;
        }
        let values = run.record.golden_values();
        if values.is_empty() && all {
            continue;
        }
        match golden::write(folder, case.id, values, reason) {
            Ok(true) => eprintln!("{}: {} numbers accepted", case.id, values.len()),
            Ok(false) => eprintln!("{}: unchanged, nothing written", case.id),
            Err(error) => return Err(error.to_string()),
        }
    }
    Ok(accepted)
}

fn write_page(from: &[PathBuf]) -> Result<bool, String> {
    let named = |path: &Path, error: String| format!("{}: {error}", path.display());
    let read =
        |path: &PathBuf| std::fs::read_to_string(path).map_err(|e| named(path, e.to_string()));
    let reports = from.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let index = Index::load().map_err(|error| format!("source_index.toml: {error}"))?;
    let text = page::render(&reports, &index)?;
    report::write_atomically(&page::path(), &text)
        .map_err(|e| named(&page::path(), e.to_string()))?;
    Ok(true)
}

fn seeded_faults(root: &Path, only: &[String], jobs: usize) -> Result<bool, String> {
    let tally = mutants::run(root, only, jobs)?;
    let all = tally.caught + tally.survived;
    eprintln!("{} of {all} seeded faults caught", tally.caught);
    Ok(tally.survived == 0)
}

fn studies(out: &Path, only: Option<&str>) -> Result<bool, String> {
    let selected: Vec<_> = verification::studies::STUDIES
        .iter()
        .filter(|study| only.is_none_or(|id| id == study.id))
        .collect();
    if let (Some(id), true) = (only, selected.is_empty()) {
        return Err(format!("no study `{id}`"));
    }
    for (index, study) in selected.iter().enumerate() {
        eprintln!("study {}/{} {}", index + 1, selected.len(), study.id);
        pareto::run(study, out).map_err(|error| format!("study {}: {error}", study.id))?;
    }
    eprintln!("{} studies; results: {}", selected.len(), out.display());
    Ok(true)
}
