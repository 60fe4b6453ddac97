//! Every smoke case, run once for all checks of this file: each published number matters to its
//! verdict, and each golden value is what it was.

use std::convert::Infallible;
use std::sync::OnceLock;

use verification::case::{Case, Computation, Tier};
use verification::cases;
use verification::golden::{self, differences};
use verification::judge::{Status, judge, widest_tolerance};
use verification::published::Published;
use verification::readme;
use verification::runner::{Run, compute, side_by_side};

/// In order; on all cores, since the cases know nothing of each other.
fn smoke_runs() -> &'static [(Case, Run)] {
    static RUNS: OnceLock<Vec<(Case, Run)>> = OnceLock::new();
    RUNS.get_or_init(|| {
        let cases = cases::of_tier(Tier::Smoke);
        let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
        let runs =
            side_by_side(&cases, cores, |index| Ok::<_, Infallible>(compute(cases[index].run)));
        cases.into_iter().zip(runs.unwrap()).collect()
    })
}

/// Bits of every check's own number, in order.
fn ours(run: &Run) -> Vec<(String, u64)> {
    run.record.ours().into_iter().map(|(id, value)| (id, value.to_bits())).collect()
}

/// What runs a case takes a function of the record alone. Were a case's text of published numbers
/// handed over as well, this would not compile.
const _: fn(Computation) -> Run = compute;

#[test]
fn altering_any_published_number_changes_the_verdict() {
    for (case, run) in smoke_runs() {
        let published = Published::parse(case.published).unwrap();
        assert_eq!(run.error, None, "{}", case.id);
        assert!(judge(&run.record, &published).holds(), "{} fails as it is", case.id);
        for entry in published.values() {
            let shift = 10.0 * widest_tolerance(&run.record, &published, &entry.id);
            let failing = |value: f64| {
                let verdict = judge(&run.record, &published.with(&entry.id, value));
                for (check, ours) in verdict.checks.iter().zip(run.record.ours()) {
                    assert_eq!(check.value.map(f64::to_bits), Some(ours.1.to_bits()));
                }
                verdict.checks.iter().any(|check| check.status == Status::Failed)
            };
            let (up, down) = (failing(entry.value + shift), failing(entry.value - shift));
            let noticed = if entry.bound.is_some() { up || down } else { up && down };
            assert!(noticed, "{}: nothing notices an altered `{}`", case.id, entry.id);
        }
    }
}

/// A static and a moving case: a second run gives the same bits, whatever ran beside the first.
#[test]
fn a_second_run_gives_the_same_bits() {
    for id in ["misalignment_moment", "bearing_conservation"] {
        let (case, first) = smoke_runs().iter().find(|(case, _)| case.id == id).unwrap();
        assert_eq!(ours(first), ours(&compute(case.run)), "{id}");
    }
}

#[test]
fn smoke_cases_agree_with_their_past() {
    for (case, run) in smoke_runs() {
        assert_eq!(run.error, None, "{}", case.id);
        let values = run.record.golden_values();
        match golden::read(&golden::default_folder(), case.id).unwrap() {
            Some(file) => assert_eq!(differences(&file.values, values), [""; 0], "{}", case.id),
            None => assert!(values.is_empty(), "{} has no golden file", case.id),
        }
    }
}

/// Figures of accuracy in the README are those of the run; of long cases, those that are pinned.
#[test]
fn figures_of_the_readme_are_those_of_the_run() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../README.md")).unwrap();
    let figures = readme::figures(&text).unwrap();
    assert!(figures.len() > 20, "only {} figures", figures.len());
    let mut stale = Vec::new();
    for figure in &figures {
        let shown = if figure.is_pinned() {
            let file = golden::read(&golden::default_folder(), &figure.case).unwrap();
            file.ok_or_else(|| format!("no golden file of {}", figure.case))
                .and_then(|file| figure.from_golden(&file))
        } else {
            let run = smoke_runs().iter().find(|(case, _)| case.id == figure.case);
            run.ok_or_else(|| format!("no case {} in the smoke tier", figure.case)).and_then(
                |(case, run)| {
                    let published = Published::parse(case.published).unwrap();
                    figure.from_checks(&judge(&run.record, &published).checks)
                },
            )
        };
        match shown {
            Ok(text) if text == figure.text => (),
            Ok(text) => stale.push(format!(
                "{} {}: README says {}, it is {text}",
                figure.form,
                figure.source(),
                figure.text
            )),
            Err(error) => stale.push(error),
        }
    }
    assert_eq!(stale, [""; 0]);
}
