//! The first pages of `report.html`: what holds and what does not, the index of the source, numbers that
//! are not reproduced, cases that did not run, assumptions.

use std::collections::BTreeSet;
use std::fmt::{Result, Write};

use crate::index::{self, ChapterEntries, Entry, Role};
use crate::judge::{CheckReport, Status};
use crate::report::html::{check_anchor, chip, escape, explanation, nowrap, number, prose};
use crate::report::{CaseReport, CaseStatus, Report, format, totals};

/// The verdict in sentences, and the counts.
pub fn write_totals(out: &mut String, report: &Report, source: &[ChapterEntries]) -> Result {
    let totals = totals::totals(report, source);
    writeln!(out, "<div class=\"lead\">")?;
    for sentence in format::lead(report, &totals) {
        writeln!(out, "<p>{}</p>", escape(&sentence))?;
    }
    writeln!(out, "</div><div class=\"totals\">")?;

    writeln!(
        out,
        "<table><thead><tr><th>Numbers the source prints as results</th>\
         <th class=\"number\">Count</th></tr></thead><tbody>"
    )?;
    for (count, word) in totals.published_numbers.parts() {
        writeln!(out, "<tr><td>{word}</td><td class=\"number\">{count}</td></tr>")?;
    }
    writeln!(
        out,
        "<tr class=\"sum\"><td>in all, each counted once<small>{} of numbers that two cases hold</small></td>\
         <td class=\"number\">{}</td></tr></tbody></table>",
        format::counted(totals.twins, "check"),
        totals.published_numbers.printed()
    )?;

    writeln!(
        out,
        "<table><thead><tr><th>Checks by status</th><th class=\"number\">Count</th></tr></thead>\
         <tbody>"
    )?;
    for status in &totals.by_status {
        writeln!(
            out,
            "<tr><td>{}</td><td class=\"number\">{}</td></tr>",
            chip(status.status),
            status.checks
        )?;
    }
    writeln!(
        out,
        "<tr class=\"sum\"><td>in all</td><td class=\"number\">{}</td></tr></tbody></table>",
        totals.checks
    )?;

    writeln!(
        out,
        "<table><thead><tr><th>Checks by kind of reference</th>\
         <th class=\"number\">Count</th><th class=\"number\">One-sided</th>\
         <th class=\"number\">Failed</th></tr></thead><tbody>"
    )?;
    for kind in &totals.by_kind {
        writeln!(
            out,
            "<tr><td>{}<small>{}</small></td><td class=\"number\">{}</td>\
             <td class=\"number\">{}</td><td class=\"number\">{}</td></tr>",
            format::kind(Some(kind.kind)),
            format::meaning(kind.kind),
            kind.checks,
            kind.one_sided,
            kind.failed
        )?;
    }
    writeln!(
        out,
        "<tr class=\"sum\"><td>in all</td><td class=\"number\">{}</td><td class=\"number\">{}</td>\
         <td class=\"number\">{}</td></tr></tbody></table></div>",
        totals.checks,
        totals.one_sided,
        totals.by_kind.iter().map(|kind| kind.failed).sum::<usize>()
    )
}

/// What failed, case by case; nothing where nothing did.
pub fn write_failures(out: &mut String, report: &Report) -> Result {
    let failed = |case: &&crate::report::CaseReport| {
        matches!(case.status, CaseStatus::Failed | CaseStatus::GoldenChanged)
    };
    if !report.cases.iter().any(|case| failed(&case)) {
        return Ok(());
    }
    writeln!(out, "<section><h2>What failed</h2><ul class=\"failures\">")?;
    for case in report.cases.iter().filter(failed) {
        for failure in case.failures() {
            writeln!(
                out,
                "<li><a href=\"#{id}\">{id}</a>: {}</li>",
                escape(&failure),
                id = escape(&case.id)
            )?;
        }
    }
    writeln!(out, "</ul></section>")
}

/// Tables, figures and numbers of the source in its order; closed on screen, open on paper.
pub fn write_source(out: &mut String, source: &[ChapterEntries]) -> Result {
    writeln!(
        out,
        "<section class=\"source\"><h2>Index of the source</h2><p>Every table, every figure and every \
         number in the text, in the source's order, with its status in this run and its cases.</p>"
    )?;
    for chapter in source {
        let counts: Vec<String> = (chapter.numbers.parts().iter())
            .filter(|part| part.0 > 0)
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        let curves = |keep: &dyn Fn(&Entry) -> bool| {
            let results = chapter.lines.iter().filter(|line| line.role == Role::Result);
            results.filter(|line| line.numbers.printed() == 0 && keep(line)).count()
        };
        let built = curves(&|line| !line.cases.is_empty());
        writeln!(
            out,
            "<details class=\"chapter\"><summary><b>{} {}</b> <span>{} printed: {}; {} of {} of results computed</span>\
             </summary><table class=\"index\"><thead><tr><th>Section</th><th>Where</th><th>What</th>\
             <th>Status</th><th>Case</th></tr></thead><tbody>",
            chapter.number,
            escape(&chapter.title),
            format::counted(chapter.numbers.printed(), "number"),
            counts.join(", "),
            built,
            format::counted(curves(&|_| true), "figure"),
        )?;
        for line in &chapter.lines {
            write_line(out, line)?;
        }
        writeln!(out, "</tbody></table></details>")?;
    }
    writeln!(out, "</section>")
}

fn write_line(out: &mut String, line: &Entry) -> Result {
    let class = match line.role {
        Role::Result | Role::Measurement if !line.cases.is_empty() => format::worst_class(line),
        _ => "dim",
    };
    let cases: Vec<String> = line
        .cases
        .iter()
        .map(|id| format!("<a href=\"#{id}\">{id}</a>", id = escape(id)))
        .collect();
    writeln!(
        out,
        "<tr class=\"{class}\"><td>{}</td><td>{}</td><td>{}</td><td class=\"{class}\">{}</td>\
         <td>{}</td></tr>",
        escape(&line.section),
        escape(if line.at.is_empty() { "text" } else { &line.at }),
        escape(&line.what),
        escape(&line.status),
        cases.join(", ")
    )
}

/// Published numbers: those that are met by case, those that are missed by cause.
pub fn write_met_and_missed(out: &mut String, report: &Report) -> Result {
    // A number with several checks counts once.
    let met = |case: &CaseReport| {
        let ids: BTreeSet<&str> =
            case.checks.iter().filter_map(|check| check.published_id.as_deref()).collect();
        let statuses = ids.into_iter().filter_map(|id| index::settled(case, id));
        let agree = [Status::Reproduced, Status::ReproducedUnderAssumption];
        statuses.filter(|status| agree.contains(status)).count()
    };
    writeln!(out, "<section><h2>What is met, and what is missed</h2><ul class=\"met\">")?;
    for case in report.cases.iter().filter(|case| met(case) > 0) {
        writeln!(
            out,
            "<li><a href=\"#{id}\">{}</a>: {} met</li>",
            escape(&case.title),
            format::counted(met(case), "number"),
            id = escape(&case.id)
        )?;
    }
    // Misses with one explanation in one case are one line.
    let mut causes: Vec<(&CaseReport, &CheckReport, usize)> = Vec::new();
    for (case, check) in format::published(report).filter(|(_, of)| of.status == Status::Explained)
    {
        let text = |of: &CheckReport| of.explanation.as_ref().map(|of| of.text.clone());
        let same = |(other, first, _): &&mut (&CaseReport, &CheckReport, usize)| {
            other.id == case.id && text(first) == text(check)
        };
        match causes.iter_mut().find(same) {
            Some((_, _, count)) => *count += 1,
            None => causes.push((case, check, 1)),
        }
    }
    writeln!(
        out,
        "</ul><table class=\"causes\"><thead><tr><th>Cause of a miss</th><th class=\"number\">Numbers</th><th>Case</th></tr></thead><tbody>"
    )?;
    for (case, check, count) in causes {
        let text = check.explanation.as_ref().map_or("", |of| of.text.as_str());
        writeln!(
            out,
            "<tr><td>{}</td><td class=\"number\" data-name=\"numbers\">{count}</td><td><a href=\"#{id}\">{id}</a></td></tr>",
            prose(text),
            id = escape(&case.id)
        )?;
    }
    writeln!(out, "</tbody></table></section>")
}

/// Published numbers one by one, those that are not reproduced first; closed on screen, open on paper.
pub fn write_published(out: &mut String, report: &Report) -> Result {
    writeln!(out, "<section><h2>Published numbers, one by one</h2>")?;
    let mut listed = format::published(report).peekable();
    if listed.peek().is_none() {
        return writeln!(out, "<p>None in this run.</p></section>");
    }
    writeln!(out, "<details class=\"chapter\"><summary>All numbers</summary>")?;
    writeln!(
        out,
        "<p>Explained and fitted numbers are not reproduced. Where measurements of the source scatter by some per cent, \
         the tolerance is that scatter.</p>\
         <table class=\"explained\"><thead><tr><th>Quantity</th><th>Status</th>\
         <th class=\"number\">Published</th><th class=\"number\">Ours</th>\
         <th class=\"number\">Difference</th><th class=\"number\">Allowed</th><th>Why</th></tr></thead><tbody>"
    )?;
    for (case, check) in listed {
        let why = match (&check.fit, &check.explanation) {
            (Some(what), _) => format!("Fitted: {}", prose(what)),
            (None, Some(_)) => explanation(case, check),
            (None, None) => prose(&check.tolerance_reason),
        };
        writeln!(
            out,
            "<tr><td><a href=\"#{}\">{}</a><small>{}; {}</small></td><td>{}</td>\
             <td class=\"number\" data-name=\"published\">{}</td><td class=\"number\" data-name=\"ours\">{}</td>\
             <td class=\"number\" data-name=\"difference\">{}</td>\
             <td class=\"number\" data-name=\"allowed\">{}</td><td>{why}</td></tr>",
            check_anchor(case, check),
            escape(&check.quantity),
            escape(&check.reference_source),
            escape(&case.id),
            chip(check.status),
            number(&format::reference(check), &check.unit),
            number(&format::ours(check), &check.unit),
            nowrap(&format::error(check)),
            nowrap(&format::tolerance(check)),
        )?;
    }
    writeln!(out, "</tbody></table></details></section>")
}

/// Cases that are no part of this report.
pub fn write_left_out(out: &mut String, report: &Report) -> Result {
    let left_out = totals::left_out(report);
    if left_out.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "<section><h2>Cases not run</h2><p>{} of this repository {} not part of this run. <code>make verify-full</code> runs all cases.</p><ul class=\"left-out\">",
        format::counted(left_out.len(), "case"),
        if left_out.len() == 1 { "is" } else { "are" },
    )?;
    for case in left_out {
        writeln!(
            out,
            "<li>{} <small><code>{}</code> · {} · {} tier</small></li>",
            escape(case.title),
            escape(case.id),
            escape(case.section),
            format!("{:?}", case.tier).to_lowercase()
        )?;
    }
    writeln!(out, "</ul></section>")
}

/// Each assumption once, with the cases that make it.
pub fn write_assumptions(out: &mut String, report: &Report) -> Result {
    let shared = totals::assumptions(report);
    if shared.is_empty() {
        return writeln!(
            out,
            "<section id=\"assumptions\"><h2>Assumptions</h2><p>No case needs one.</p></section>"
        );
    }
    writeln!(
        out,
        "<section id=\"assumptions\"><h2>Assumptions</h2><p>Inputs that the source omits, and the values used. \
         An assumption that no check names affects all numbers of its cases.</p><table class=\"assumed\"><thead><tr><th>Assumption</th><th>Value</th>\
         <th>Omitted input</th><th class=\"number\">Checks that depend on it</th><th>Cases</th></tr></thead><tbody>"
    )?;
    for entry in shared {
        let cases: Vec<String> = (entry.cases.iter())
            .map(|case| format!("<a href=\"#{id}\">{id}</a>", id = escape(&case.id)))
            .collect();
        writeln!(
            out,
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td class=\"number\" data-name=\"checks that depend on it:\">{}</td><td>{}</td></tr>",
            escape(&entry.assumption.name),
            escape(&entry.assumption.default),
            prose(&entry.assumption.text),
            format::leaning(entry.leaning),
            cases.join(", "),
        )?;
    }
    writeln!(out, "</tbody></table></section>")
}
