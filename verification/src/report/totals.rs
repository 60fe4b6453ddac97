//! What a report adds up to: checks by status and by kind of reference, published numbers, assumptions.

use serde::Serialize;

use crate::case::Case;
use crate::cases;
use crate::check::ReferenceKind;
use crate::context::Assumption;
use crate::index::{self, ChapterEntries, Numbers};
use crate::judge::{CheckReport, Status, ToleranceOn};
use crate::report::{CaseReport, Report};

/// Checks held against one kind of reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OfKind {
    pub kind: ReferenceKind,
    pub checks: usize,
    /// Those with a limit on one side only.
    pub one_sided: usize,
    pub failed: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OfStatus {
    pub status: Status,
    pub checks: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Totals {
    pub checks: usize,
    pub one_sided: usize,
    pub by_status: Vec<OfStatus>,
    pub by_kind: Vec<OfKind>,
    /// Numbers that the source prints, each once, however many cases hold it.
    pub published_numbers: Numbers,
    /// Numbers that other books and programs print.
    pub outside_numbers: Numbers,
    /// Checks of a published number that another case of this run holds as well.
    pub twins: usize,
}

pub const STATUSES: [Status; 6] = [
    Status::Failed,
    Status::Explained,
    Status::Fit,
    Status::ReproducedUnderAssumption,
    Status::Reproduced,
    Status::Pass,
];

const KINDS: [ReferenceKind; 9] = [
    ReferenceKind::Published,
    ReferenceKind::Book,
    ReferenceKind::OtherProgram,
    ReferenceKind::Evidence,
    ReferenceKind::ClosedForm,
    ReferenceKind::Converged,
    ReferenceKind::Independent,
    ReferenceKind::Consistency,
    ReferenceKind::Stated,
];

/// A limit on one side only.
pub fn one_sided(check: &CheckReport) -> bool {
    matches!(check.tolerance_on, Some(ToleranceOn::AtLeast | ToleranceOn::AtMost))
}

/// Add up a report whose index lines are judged.
pub fn totals(report: &Report, chapters: &[ChapterEntries]) -> Totals {
    let checks: Vec<&CheckReport> = report.cases.iter().flat_map(|case| &case.checks).collect();
    let count = |keep: &dyn Fn(&CheckReport) -> bool| checks.iter().filter(|c| keep(c)).count();
    let mut published_numbers = Numbers::default();
    chapters.iter().for_each(|chapter| published_numbers.add(&chapter.numbers));
    Totals {
        checks: checks.len(),
        one_sided: count(&one_sided),
        by_status: STATUSES
            .map(|status| OfStatus { status, checks: count(&|check| check.status == status) })
            .into(),
        by_kind: KINDS
            .map(|kind| OfKind {
                kind,
                checks: count(&|check| check.reference_kind == Some(kind)),
                one_sided: count(&|check| check.reference_kind == Some(kind) && one_sided(check)),
                failed: count(&|check| {
                    check.reference_kind == Some(kind) && check.status == Status::Failed
                }),
            })
            .into(),
        published_numbers,
        outside_numbers: index::outside_numbers(&report.cases),
        twins: twins(report),
    }
}

fn twins(report: &Report) -> usize {
    let held = |case: &str, id: &str| {
        let other = report.cases.iter().find(|other| other.id == case);
        other
            .is_some_and(|other| other.checks.iter().any(|c| c.published_id.as_deref() == Some(id)))
    };
    let is_twin = |case: &CaseReport, check: &CheckReport| {
        let Some(id) = &check.published_id else { return false };
        report.index.twins(&case.id, id).iter().any(|other| held(other, id))
    };
    let of_case = |case: &CaseReport| case.checks.iter().filter(|c| is_twin(case, c)).count();
    report.cases.iter().map(of_case).sum()
}

/// Cases of the repository that are no part of this report.
pub fn left_out(report: &Report) -> Vec<&'static Case> {
    let here = |id: &str| report.cases.iter().any(|case| case.id == id);
    cases::CASES.iter().filter(|case| !here(case.id)).collect()
}

/// An assumption, once, with the cases that make it and how many of their checks lean on it.
pub struct Shared<'a> {
    pub assumption: &'a Assumption,
    pub cases: Vec<&'a CaseReport>,
    pub leaning: usize,
}

/// Assumptions in the order of the cases; the same name, text and value is one.
pub fn assumptions(report: &Report) -> Vec<Shared<'_>> {
    let mut all: Vec<Shared<'_>> = Vec::new();
    for case in &report.cases {
        for assumption in &case.assumptions {
            let leaning = (case.checks.iter())
                .filter(|check| check.assumption.as_deref() == Some(assumption.name.as_str()))
                .count();
            match all.iter_mut().find(|shared| shared.assumption == assumption) {
                Some(shared) => {
                    shared.cases.push(case);
                    shared.leaning += leaning;
                }
                None => all.push(Shared { assumption, cases: vec![case], leaning }),
            }
        }
    }
    all
}
