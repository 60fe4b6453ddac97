//! `report.json`: every number in full precision; what is not finite is `null` with a reason.

use std::io;

use serde::Serialize;

use crate::case::Tier;
use crate::context::{Assumption, Finding, Table, Work};
use crate::index::ChapterEntries;
use crate::judge::CheckReport;
use crate::machine::Machine;
use crate::report::totals::{self, Totals};
use crate::report::{Cached, CaseReport, CaseStatus, GoldenReport, Report};

#[derive(Serialize)]
struct Document<'a> {
    format: &'static str,
    passed: bool,
    complete: bool,
    tier: Tier,
    seconds: f64,
    machine: &'a Machine,
    totals: Totals,
    /// Cases of the repository that are no part of this run.
    not_run: Vec<LeftOut>,
    /// The source's tables, figures and numbers in the text, in its order.
    source: Vec<ChapterEntries>,
    cases: Vec<CaseEntry<'a>>,
}

#[derive(Serialize)]
struct LeftOut {
    id: &'static str,
    title: &'static str,
    section: &'static str,
    tier: Tier,
}

#[derive(Serialize)]
struct CaseEntry<'a> {
    id: &'a str,
    title: &'a str,
    section: &'a str,
    tier: Tier,
    status: CaseStatus,
    seconds: Option<f64>,
    cached: &'a Option<Cached>,
    worst_error_over_tolerance: Option<f64>,
    error: &'a Option<String>,
    problems: &'a [String],
    assumptions: &'a [Assumption],
    checks: &'a [CheckReport],
    findings: &'a [Finding],
    tables: &'a [Table],
    figures: Vec<FigureEntry<'a>>,
    work: &'a [Work],
    golden: &'a GoldenReport,
}

#[derive(Serialize)]
struct FigureEntry<'a> {
    name: &'a str,
    caption: &'a str,
}

pub fn render(report: &Report) -> io::Result<String> {
    let source = report.index.judged(&report.cases);
    let left_out = totals::left_out(report).into_iter();
    let document = Document {
        format: "bearing-dynamics verification report 1",
        passed: report.passed(),
        complete: report.complete(),
        tier: report.tier,
        seconds: report.seconds(),
        machine: &report.machine,
        totals: totals::totals(report, &source),
        not_run: left_out
            .map(|case| LeftOut {
                id: case.id,
                title: case.title,
                section: case.section,
                tier: case.tier,
            })
            .collect(),
        source,
        cases: report.cases.iter().map(entry).collect(),
    };
    let mut text = serde_json::to_string_pretty(&document)?;
    text.push('\n');
    Ok(text)
}

fn entry(case: &CaseReport) -> CaseEntry<'_> {
    CaseEntry {
        id: &case.id,
        title: &case.title,
        section: &case.section,
        tier: case.tier,
        status: case.status,
        seconds: case.seconds,
        cached: &case.cached,
        worst_error_over_tolerance: case.worst_ratio,
        error: &case.error,
        problems: &case.problems,
        assumptions: &case.assumptions,
        checks: &case.checks,
        findings: &case.findings,
        tables: &case.tables,
        figures: case
            .figures
            .iter()
            .map(|figure| FigureEntry { name: &figure.name, caption: &figure.caption })
            .collect(),
        work: &case.work,
        golden: &case.golden,
    }
}
