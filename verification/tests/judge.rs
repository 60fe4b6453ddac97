//! Each rule of the judge, and that breaking it is noticed.

use verification::case::{Case, Computation, Tier};
use verification::check::{Check, Explanation};
use verification::context::CaseContext;
use verification::index::Index;
use verification::judge::{CheckReport, Status, entries_without_effect, judge};
use verification::machine::Machine;
use verification::published::Published;
use verification::report::{CaseReport, CaseStatus, Report};
use verification::runner::{self, Run};

const PUBLISHED: &str = r#"
[[value]]
id = "force"
quantity = "force"
value = 100.0
unit = "N"
source = "Table 1"
rounding = 0.2
"#;

const LIMIT: &str = r#"
[[value]]
id = "limit"
quantity = "largest error"
value = 4.0
unit = "%"
source = "2.3.2"
bound = "at-most"
"#;

fn force(ours: f64) -> Check {
    Check::new("force", "force", "N", ours).published("force")
}

/// The one check of a case with it.
fn verdict(check: Check) -> CheckReport {
    with_evidence(check, &[])
}

fn with_evidence(check: Check, more: &[Check]) -> CheckReport {
    let mut context = CaseContext::default();
    context.assumption("stated", "a hole", "1 mm");
    context.finding("seen", "something");
    context.check(check);
    more.iter().for_each(|check| context.check(check.clone()));
    judge(&context, &Published::parse(PUBLISHED).unwrap()).checks.remove(0)
}

fn failure(check: Check) -> String {
    let report = verdict(check);
    assert_eq!(report.status, Status::Failed);
    report.failure.unwrap()
}

#[test]
fn statuses_of_checks_that_hold() {
    assert_eq!(verdict(force(100.9).relative(0.01, "why")).status, Status::Reproduced);
    assert_eq!(verdict(force(100.1).printed("why")).status, Status::Reproduced);
    let assumed = verdict(force(99.1).relative(0.01, "why").under("stated"));
    assert_eq!(assumed.status, Status::ReproducedUnderAssumption);
    let closed = Check::new("x", "x", "N", 1.0).closed_form(1.0, "πr²").absolute(0.0, "exact");
    assert_eq!(verdict(closed).status, Status::Pass);
    // A one-sided check against a plain value is evidence, not reproduction.
    assert_eq!(verdict(force(101.0).at_least(0.5, "why")).status, Status::Pass);
    let report = verdict(force(101.0).relative(0.02, "why"));
    assert_eq!((report.error_absolute, report.error_relative), (Some(1.0), Some(0.01)));
    assert_eq!(report.ratio, Some(0.5));
}

/// A number met because something was identified from it is no reproduction, and no evidence.
#[test]
fn a_fitted_number_is_a_fit() {
    let fitted = |ours: f64| force(ours).fit("clearance fitted to this force");
    let report = verdict(fitted(100.5).relative(0.01, "why"));
    assert_eq!(report.status, Status::Fit);
    assert_eq!(report.fit.as_deref(), Some("clearance fitted to this force"));
    let assumed = verdict(fitted(100.5).relative(0.01, "why").under("stated"));
    assert_eq!(assumed.status, Status::Fit);
    // It still has to be met, to say what was fitted, and to be a published number.
    assert!(failure(fitted(101.1).relative(0.01, "why")).contains("exceeds"));
    assert!(failure(force(100.0).relative(0.1, "why").fit(" ")).contains("what was fitted"));
    let own = Check::new("a", "a", "N", 1.0).closed_form(1.0, "one").absolute(0.0, "exact");
    assert!(failure(own.fit("x to y")).contains("only a published number"));
    assert!(failure(fitted(101.0).at_least(0.5, "why")).contains("one-sided"));
    let explained = Explanation::new("text", 0.2, 0.01, &["seen"]);
    let both = fitted(120.0).relative(0.01, "why").explained(explained);
    assert!(failure(both).contains("needs no explanation"));
    // An explanation cannot rest on it alone.
    let explained = Explanation::new("text", 0.2, 0.01, &["fitted"]);
    let mut other = fitted(100.0).relative(0.01, "why");
    other.id = "fitted".into();
    let check = force(120.0).relative(0.01, "why").explained(explained);
    let report = with_evidence(check, &[other]);
    assert!(report.failure.unwrap().contains("no check of its own"));
}

#[test]
fn disagreement_and_misuse_fail() {
    assert!(failure(force(101.1).relative(0.01, "why")).contains("exceeds"));
    assert!(failure(force(98.9).absolute(1.0, "why")).contains("exceeds"));
    assert!(failure(force(100.2).printed("why")).contains("exceeds"));
    assert!(failure(force(100.4).at_least(0.5, "why")).contains("not above"));
    assert!(failure(force(99.6).at_most(0.5, "why")).contains("not below"));
    assert!(failure(force(100.0).relative(0.01, " ")).contains("no reason"));
    assert!(failure(force(100.0)).contains("no tolerance"));
    assert!(failure(force(100.0).relative(-1.0, "why")).contains("tolerance is"));
    assert!(failure(force(100.0).relative(0.1, "why").under("unstated")).contains("no assumption"));
    let milli = Check::new("a", "a", "mN", 1e5).published("force").relative(0.1, "why");
    assert!(failure(milli).contains("published in N"));
    let absent = Check::new("a", "a", "N", 1.0).published("absent").relative(0.1, "why");
    assert!(failure(absent).contains("no value with id"));
    let adrift = Check::new("a", "a", "N", 1.0).relative(0.1, "why");
    assert!(failure(adrift).contains("no reference"));
    let zero = Check::new("a", "a", "N", 1.0).closed_form(0.0, "zero").relative(0.1, "why");
    assert!(failure(zero).contains("other than zero"));
    let nameless = Check::new("a", "a", "N", 1.0).closed_form(1.0, "").relative(0.1, "why");
    assert!(failure(nameless).contains("where it comes from"));
}

#[test]
fn nan_and_infinity_fail_everywhere() {
    for bad in [f64::NAN, f64::INFINITY] {
        failure(force(bad).relative(0.1, "why"));
        failure(force(bad).absolute(f64::INFINITY, "why"));
        failure(force(bad).at_least(0.0, "why"));
        failure(force(100.0).relative(bad, "why"));
        failure(Check::new("a", "a", "N", 1.0).independent(bad, "code").absolute(0.1, "why"));
        let explained = Explanation::new("text", bad, 0.1, &["pass"]);
        failure(force(120.0).relative(0.01, "why").explained(explained));
        let explained = Explanation::new("text", 0.2, bad, &["pass"]);
        failure(force(120.0).relative(0.01, "why").explained(explained));
    }
}

#[test]
fn an_explanation_needs_its_difference_and_its_evidence() {
    let pass = Check::new("pass", "p", "1", 1.0).closed_form(1.0, "one").absolute(0.0, "exact");
    let fail = Check::new("fail", "f", "1", 2.0).closed_form(1.0, "one").absolute(0.0, "exact");
    let explained = |ours: f64, evidence: &[&str]| {
        let text = Explanation::new("clearance rounded", 0.2, 0.01, evidence);
        let check = force(ours).relative(0.01, "would-be agreement").explained(text);
        with_evidence(check, &[pass.clone(), fail.clone()])
    };
    assert_eq!(explained(120.0, &["pass", "seen"]).status, Status::Explained);
    let failing = |ours: f64, evidence: &[&str]| {
        let report = explained(ours, evidence);
        assert_eq!(report.status, Status::Failed);
        report.failure.unwrap()
    };
    assert!(failing(100.5, &["pass"]).contains("vanished"));
    assert!(failing(123.0, &["pass"]).contains("stale"));
    assert!(failing(80.0, &["pass"]).contains("stale"));
    assert!(failing(120.0, &["seen"]).contains("no check of its own"));
    assert!(failing(120.0, &[]).contains("no check of its own"));
    assert!(failing(120.0, &["pass", "fail"]).contains("failed"));
    assert!(failing(120.0, &["pass", "ghost"]).contains("does not exist"));
    // It cannot vouch for itself.
    assert!(failing(120.0, &["force"]).contains("only explained"));
}

#[test]
fn published_numbers_are_never_dropped() {
    let published = Published::parse(PUBLISHED).unwrap();
    let mut context = CaseContext::default();
    context.check(Check::new("x", "x", "1", 1.0).closed_form(1.0, "one").absolute(0.0, "exact"));
    let problems = judge(&context, &published).problems;
    assert_eq!(problems, ["unused published value `force` (Table 1)"]);
    // A one-sided check does not settle it…
    context.check(force(101.0).at_least(0.0, "why"));
    assert_eq!(judge(&context, &published).problems.len(), 1);
    context.check(Check { id: "again".into(), ..force(101.0).relative(0.1, "why") });
    assert!(judge(&context, &published).holds());
    assert_eq!(entries_without_effect(&context, &published), [""; 0]);
    // …unless the source states a limit.
    let limit = Published::parse(LIMIT).unwrap();
    let mut context = CaseContext::default();
    context.check(Check::new("e", "e", "%", 2.5).published("limit").at_most(0.0, "stated limit"));
    let verdict = judge(&context, &limit);
    assert_eq!((verdict.holds(), verdict.checks[0].status), (true, Status::Reproduced));
    assert_eq!(entries_without_effect(&context, &limit), [""; 0]);
}

#[test]
fn a_number_that_could_be_anything_is_noticed() {
    let mut context = CaseContext::default();
    // A tolerance so wide that the published number decides nothing.
    context.check(force(100.0).relative(10.0, "generous"));
    let published = Published::parse(PUBLISHED).unwrap();
    assert!(judge(&context, &published).holds());
    assert_eq!(entries_without_effect(&context, &published), ["force"]);
}

fn assess(run: fn(&mut CaseContext) -> Result<(), verification::case::CaseError>) -> CaseReport {
    let case =
        Case { id: "made_up", title: "", section: "", tier: Tier::Smoke, published: "", run };
    let folder = tempfile::tempdir().unwrap();
    runner::assess(&case, &runner::compute(case.run), folder.path())
}

#[test]
fn panics_and_errors_are_reported_and_keep_what_was_recorded() {
    let panicked = assess(|context| {
        context.finding("before", "recorded");
        let values: [f64; 0] = [];
        panic!("index {} of {values:?}", 3);
    });
    assert_eq!(panicked.status, CaseStatus::Failed);
    assert_eq!(panicked.error.as_deref(), Some("panicked: index 3 of []"));
    assert_eq!(panicked.findings.len(), 1);
    let erred = assess(|_| {
        let _: f64 = "twelve".parse()?;
        Ok(())
    });
    assert_eq!(erred.error.as_deref(), Some("invalid float literal"));
}

/// Lines of the index take their words from the run; a twin counts once, by its least favourable status.
#[test]
fn lines_of_the_index_are_judged_by_the_run() {
    let index: Index = toml::from_str(
        r#"
[[chapter]]
number = 2
title = "Title"
tables = 1
figures = 2
lines = [
  { section = "2.1", at = "Table 2.1", role = "result", what = "table", prints = 4, values = ["one/force", "two/force", "one/load"] },
  { section = "2.1", at = "Fig. 2.1", role = "result", what = "curve", cases = ["one"] },
  { section = "2.1", at = "Fig. 2.2", role = "picture", what = "drawing" },
  { section = "2.2", role = "input", what = "speed", cases = ["one"] },
  { section = "2.2", role = "result", what = "curve" },
]
"#,
    )
    .unwrap();
    let published =
        Published::parse(&[PUBLISHED, &PUBLISHED.replace("\"force\"", "\"load\"")].concat());
    let published = published.unwrap();
    let report = |id: &'static str, checks: &[Check]| {
        let case =
            Case { id, title: "", section: "", tier: Tier::Smoke, published: "", run: |_| Ok(()) };
        let mut report = CaseReport::pending(&case);
        let mut context = CaseContext::default();
        checks.iter().for_each(|check| context.check(check.clone()));
        report.checks = judge(&context, &published).checks;
        report.status = report.verdict();
        report
    };
    let load = |ours: f64| Check::new("load", "load", "N", ours).published("load");
    let close = |check: Check| check.relative(0.01, "why");
    let words = |cases: &[CaseReport]| -> Vec<String> {
        index.judged(cases)[0].lines.iter().map(|line| line.status.clone()).collect()
    };
    let rest = ["picture", "input", "not built"];
    assert_eq!(words(&[])[..2], ["2 not run, 2 not built", "not run"]);
    assert_eq!(words(&[])[2..], rest);
    let one = report("one", &[close(force(100.0)), close(load(100.5))]);
    assert_eq!(words(std::slice::from_ref(&one))[0], "2 reproduced, 2 not built");
    assert_eq!(words(std::slice::from_ref(&one))[1], "computed, no number printed");
    // The other case meets the same number by a fit: it counts once, as that.
    let two = report("two", &[close(force(100.0)).fit("a force to this force")]);
    assert_eq!(words(&[one.clone(), two.clone()])[0], "1 fit, 1 reproduced, 2 not built");
    // Evidence on one side settles nothing; a case without the check it owes fails the number.
    let poor = report("one", &[force(102.0).at_least(1.0, "why"), close(load(102.0))]);
    assert_eq!(words(&[poor, two])[..2], ["2 failed, 2 not built", "failed"]);
    assert_eq!(index.twins("one", "force"), ["two"]);
    assert!(index.twins("one", "load").is_empty());
}

/// First the counts and why few agree, then what is met, then misses by cause, then one number after the other.
#[test]
fn the_report_says_the_important_first() {
    let index: Index = toml::from_str(
        r#"
[[chapter]]
number = 2
title = "Title"
tables = 1
figures = 0
lines = [{ section = "2.1", at = "Table 2.1", role = "result", what = "table", prints = 3, values = ["one/force", "one/load", "one/push"] }]
"#,
    )
    .unwrap();
    let ids = ["force", "load", "push"];
    let published = ids.map(|id| PUBLISHED.replace("\"force\"", &format!("\"{id}\""))).concat();
    let case = Case {
        id: "one",
        title: "One",
        section: "",
        tier: Tier::Smoke,
        published: "",
        run: |_| Ok(()),
    };
    let mut one = CaseReport::pending(&case);
    let mut context = CaseContext::default();
    let check = |id: &str, ours: f64| Check::new(id, id, "N", ours).published(id);
    context.check(check("push", 100.5).relative(0.01, "why"));
    context.check(Check::new("cause", "why", "N", 1.0).closed_form(1.0, "1").relative(0.1, "why"));
    for id in &ids[..2] {
        let explained = Explanation::new("meshed too coarsely", 0.1, 0.01, &["cause"]);
        context.check(check(id, 110.0).relative(0.01, "why").explained(explained));
    }
    one.checks = judge(&context, &Published::parse(&published).unwrap()).checks;
    one.status = one.verdict();
    assert_eq!(one.status, CaseStatus::Passed, "{:?}", one.checks);
    let report = Report { machine: Machine::facts(), tier: Tier::Smoke, index, cases: vec![one] };
    let folder = tempfile::tempdir().unwrap();
    report.write(folder.path()).unwrap();
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    let mut rest = page.as_str();
    for next in [
        "Of 3 numbers that the source prints as results: 2 explained, 1 reproduced.",
        "Few agree outright",
        "1 number met",
        "meshed too coarsely</td><td class=\"number\" data-name=\"numbers\">2</td>",
        "one by one",
    ] {
        let found = rest.split_once(next);
        rest = found.unwrap_or_else(|| panic!("{next:?} is not where it belongs")).1;
    }
}

/// What runs a case takes a function of the record alone. Were a case's text of published numbers
/// handed over as well, this would not compile.
const _: fn(Computation) -> Run = runner::compute;
