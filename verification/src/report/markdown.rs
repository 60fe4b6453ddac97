//! `report.md`: the same report as plain text, figures beside it.

use std::fmt::Write;

use crate::index::ChapterEntries;
use crate::judge::Status;
use crate::report::format::{self, optional};
use crate::report::{CaseReport, GoldenStatus, Report, figure_file, totals};

pub fn render(report: &Report) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write_report(&mut out, report);
    out
}

fn write_report(out: &mut String, report: &Report) -> std::fmt::Result {
    let source = report.index.judged(&report.cases);
    let totals = totals::totals(report, &source);
    let badge = format::badge(report, &totals.published_numbers);
    writeln!(out, "# Verification report: {badge}\n")?;
    let machine = &report.machine;
    writeln!(
        out,
        "{} · {} · {} cores · {} · version {} · commit {} · threads used: {} · in all {}\n",
        machine.date,
        machine.cpu,
        machine.cores,
        machine.rustc,
        machine.crate_version,
        machine.commit.as_deref().unwrap_or("unknown"),
        machine.threads.map_or("?".into(), |count| count.to_string()),
        format::seconds_in_all(report),
    )?;
    for sentence in format::lead(report, &totals) {
        writeln!(out, "{sentence}\n")?;
    }
    writeln!(out, "| held against | checks | one-sided | failed |\n|---|--:|--:|--:|")?;
    for kind in &totals.by_kind {
        writeln!(
            out,
            "| {}: {} | {} | {} | {} |",
            format::kind(Some(kind.kind)),
            format::meaning(kind.kind),
            kind.checks,
            kind.one_sided,
            kind.failed
        )?;
    }
    writeln!(out, "\n{HOW_TO_READ}")?;
    write_published(out, report)?;
    write_source(out, &source)?;
    write_left_out(out, report)?;
    write_assumptions(out, report)?;

    writeln!(out, "\n## Cases\n")?;
    writeln!(
        out,
        "| case | section | status | checks | reproduced | under assumption | fit | explained | \
         seconds | worst error / tolerance |\n|---|---|---|--:|--:|--:|--:|--:|--:|--:|"
    )?;
    for case in &report.cases {
        writeln!(
            out,
            "| [{}](#{}) | {} | **{}** | {} | {} | {} | {} | {} | {}{} | {} |",
            cell(&case.title),
            case.id,
            cell(&case.section),
            case.status.word(),
            case.checks.len(),
            case.count(Status::Reproduced),
            case.count(Status::ReproducedUnderAssumption),
            case.count(Status::Fit),
            case.count(Status::Explained),
            format::seconds(case.seconds),
            if case.cached.is_some() { " (cached)" } else { "" },
            optional(case.worst_ratio, 2),
        )?;
    }
    for case in &report.cases {
        write_case(out, case)?;
    }
    Ok(())
}

fn write_source(out: &mut String, source: &[ChapterEntries]) -> std::fmt::Result {
    writeln!(out, "\n## Index of the source")?;
    for chapter in source {
        writeln!(
            out,
            "\n### {} {}\n\n| section | where | what | status | case |\n|---|---|---|---|---|",
            chapter.number, chapter.title
        )?;
        for line in &chapter.lines {
            writeln!(
                out,
                "| {} | {} | {} | {} | {} |",
                line.section,
                if line.at.is_empty() { "text" } else { &line.at },
                cell(&line.what),
                line.status,
                line.cases.join(", ")
            )?;
        }
    }
    Ok(())
}

fn write_left_out(out: &mut String, report: &Report) -> std::fmt::Result {
    let left_out = totals::left_out(report);
    if left_out.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n## Cases not run\n")?;
    for case in left_out {
        writeln!(out, "- `{}`: {} ({}; {:?} tier)", case.id, case.title, case.section, case.tier)?;
    }
    Ok(())
}

fn write_assumptions(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(out, "\n## Assumptions\n")?;
    let shared = totals::assumptions(report);
    if shared.is_empty() {
        return writeln!(out, "No case needs one.");
    }
    writeln!(
        out,
        "| assumption | value | what it fills | checks that lean on it | cases |\n|---|---|---|--:|---|"
    )?;
    for entry in shared {
        let cases: Vec<&str> = entry.cases.iter().map(|case| case.id.as_str()).collect();
        writeln!(
            out,
            "| `{}` | {} | {} | {} | {} |",
            cell(&entry.assumption.name),
            cell(&entry.assumption.default),
            cell(&entry.assumption.text),
            format::leaning(entry.leaning),
            cases.join(", ")
        )?;
    }
    Ok(())
}

fn write_published(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(out, "\n## Published numbers, one by one\n")?;
    let mut listed = format::published(report).peekable();
    if listed.peek().is_none() {
        return writeln!(out, "None in this run.");
    }
    writeln!(
        out,
        "| case | quantity | status | source | published | ours | difference | allowed | why | evidence |\n\
         |---|---|---|---|--:|--:|--:|--:|---|---|"
    )?;
    for (case, check) in listed {
        let (why, evidence) = match (&check.fit, &check.explanation) {
            (Some(what), _) => (what.as_str(), String::new()),
            (None, Some(text)) => (text.text.as_str(), text.evidence.join(", ")),
            (None, None) => (check.tolerance_reason.as_str(), String::new()),
        };
        writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {evidence} |",
            case.id,
            cell(&check.quantity),
            check.status.word(),
            cell(&check.reference_source),
            format::reference(check),
            format::ours(check),
            format::error(check),
            format::tolerance(check),
            cell(why),
        )?;
    }
    Ok(())
}

fn write_case(out: &mut String, case: &CaseReport) -> std::fmt::Result {
    writeln!(out, "\n<a id=\"{}\"></a>\n\n## {}\n", case.id, case.title)?;
    writeln!(
        out,
        "`{}` · {} · {:?} tier · **{}** · {} s\n",
        case.id,
        case.section,
        case.tier,
        case.status.word(),
        format::seconds(case.seconds)
    )?;
    if let Some(cached) = &case.cached {
        writeln!(out, "*{}*\n", cached.note)?;
    }
    for failure in case.failures() {
        writeln!(out, "- **failed:** {failure}")?;
    }
    if !case.assumptions.is_empty() {
        let names: Vec<String> =
            case.assumptions.iter().map(|assumption| format!("`{}`", assumption.name)).collect();
        writeln!(out, "\nAssumptions: {}", names.join(", "))?;
    }
    if !case.checks.is_empty() {
        writeln!(
            out,
            "\n| quantity | ours | reference | kind | source | error | tolerance | reason | status \
             |\n|---|--:|--:|---|---|--:|--:|---|---|"
        )?;
    }
    for check in &case.checks {
        let assumption =
            check.assumption.as_ref().map_or(String::new(), |name| format!(" `{name}`"));
        writeln!(
            out,
            "| {} | {}{} | {} | {} | {} | {} | {} | {} | {}{} |",
            cell(&check.quantity),
            format::ours(check),
            format::unit(&check.unit),
            format::reference(check),
            format::kind(check.reference_kind),
            cell(&check.reference_source),
            format::error(check),
            format::tolerance(check),
            cell(&check.tolerance_reason),
            check.status.word(),
            assumption,
        )?;
    }
    for figure in &case.figures {
        let file = figure_file(case, figure);
        writeln!(out, "\n![{}](figures/{file})\n\n*{}*", figure.name, figure.caption)?;
    }
    for table in &case.tables {
        writeln!(out, "\n{}\n\n| {} |", table.title, table.columns.join(" | "))?;
        writeln!(out, "|{}", "---|".repeat(table.columns.len()))?;
        for row in &table.rows {
            let cells: Vec<String> = row.iter().map(|text| cell(text)).collect();
            writeln!(out, "| {} |", cells.join(" | "))?;
        }
    }
    if !case.findings.is_empty() {
        writeln!(out)?;
    }
    for finding in &case.findings {
        writeln!(out, "- finding `{}`: {}", finding.id, finding.text)?;
    }
    if !case.work.is_empty() {
        writeln!(out)?;
    }
    for work in &case.work {
        writeln!(out, "- {}: {}", work.name, work.count)?;
    }
    if case.golden.status != GoldenStatus::None {
        let reason = case.golden.last_reason.as_ref();
        let reason = reason.map_or(String::new(), |last| {
            format!("; accepted {}: {}", last.date, last.reason.trim_end_matches('.'))
        });
        writeln!(
            out,
            "\nOwn past: {} pinned{reason}.",
            format::counted(case.golden.values, "number")
        )?;
    }
    Ok(())
}

/// Text that fits a table cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}

const HOW_TO_READ: &str = "\
How to read it: *ours* is computed before any published number is opened. *Reproduced* means \
within tolerance on stated inputs; *reproduced under assumption* needs the named assumption for \
something the source leaves out; *fit* means that something was identified from that very number; *explained* means that the source prints something else, that we \
know by how much, and that the evidence named beside it holds. *Pass* is agreement with a \
reference that is no published number: the column *kind* says which, and *consistency* is another of our own ways. The error is measured as its tolerance is.";
