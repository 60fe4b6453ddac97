//! `report.md`: the same report as plain text, figures beside it.

use std::fmt::Write;

use crate::judge::Status;
use crate::report::format::{self, optional};
use crate::report::{CaseReport, GoldenStatus, Report, figure_file};

pub fn render(report: &Report) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write_report(&mut out, report);
    out
}

fn write_report(out: &mut String, report: &Report) -> std::fmt::Result {
    let verdict = match (report.passed(), report.complete()) {
        (true, _) => "passed",
        (false, true) => "failed",
        (false, false) => "incomplete",
    };
    writeln!(out, "# Verification report: {verdict}\n")?;
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
    writeln!(out, "{HOW_TO_READ}\n")?;

    writeln!(out, "## Summary\n")?;
    writeln!(
        out,
        "| case | section | status | checks | reproduced | under assumption | explained | \
         seconds | worst error / tolerance |\n|---|---|---|--:|--:|--:|--:|--:|--:|"
    )?;
    for case in &report.cases {
        writeln!(
            out,
            "| [{}](#{}) | {} | **{}** | {} | {} | {} | {} | {}{} | {} |",
            cell(&case.title),
            case.id,
            cell(&case.section),
            case.status.word(),
            case.checks.len(),
            case.count(Status::Reproduced),
            case.count(Status::ReproducedUnderAssumption),
            case.count(Status::Explained),
            format::seconds(case.seconds),
            if case.cached.is_some() { " (cached)" } else { "" },
            optional(case.worst_ratio, 2),
        )?;
    }

    write_assumptions(out, report)?;
    write_explained(out, report)?;
    for case in &report.cases {
        write_case(out, case)?;
    }
    Ok(())
}

fn write_assumptions(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(out, "\n## Assumptions\n")?;
    if report.cases.iter().all(|case| case.assumptions.is_empty()) {
        return writeln!(out, "No case needs one.");
    }
    writeln!(out, "| case | assumption | value | what it fills |\n|---|---|---|---|")?;
    for case in &report.cases {
        for assumption in &case.assumptions {
            writeln!(
                out,
                "| {} | `{}` | {} | {} |",
                case.id,
                cell(&assumption.name),
                cell(&assumption.default),
                cell(&assumption.text)
            )?;
        }
    }
    Ok(())
}

fn write_explained(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(out, "\n## Published numbers that are explained, not reproduced\n")?;
    if report.cases.iter().all(|case| case.count(Status::Explained) == 0) {
        return writeln!(out, "None.");
    }
    writeln!(
        out,
        "| case | quantity | source | published | ours | difference | explanation | evidence |\n\
         |---|---|---|--:|--:|--:|---|---|"
    )?;
    for case in &report.cases {
        for check in case.checks.iter().filter(|check| check.status == Status::Explained) {
            let Some(explanation) = &check.explanation else { continue };
            writeln!(
                out,
                "| {} | {} | {} | {} | {} | {} | {} | {} |",
                case.id,
                cell(&check.quantity),
                cell(&check.reference_source),
                format::reference(check),
                format::ours(check),
                format::error(check),
                cell(&explanation.text),
                explanation.evidence.join(", "),
            )?;
        }
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
    for assumption in &case.assumptions {
        writeln!(
            out,
            "- assumption `{}`: {}. {}",
            assumption.name, assumption.default, assumption.text
        )?;
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
something the source leaves out; *explained* means that the source prints something else, that we \
know by how much, and that the evidence named beside it holds. *Pass* is agreement with a closed \
form, a converged solution or an independent method. The error is measured as its tolerance is.";
