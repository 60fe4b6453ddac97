//! `report.html`: one file, nothing fetched, readable on paper.

use std::fmt::Write;

use crate::judge::{CheckReport, Status};
use crate::report::format::{self, optional};
use crate::report::{CaseReport, CaseStatus, GoldenStatus, Report};

pub fn render(report: &Report) -> String {
    let mut out = String::with_capacity(64 * 1024);
    // Writing to a String cannot fail.
    let _ = write_report(&mut out, report);
    out
}

fn write_report(out: &mut String, report: &Report) -> std::fmt::Result {
    let (class, verdict) = match (report.passed(), report.complete()) {
        (true, _) => ("good", "passed"),
        (false, true) => ("bad", "failed"),
        (false, false) => ("open", "incomplete"),
    };
    writeln!(
        out,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Verification report: {verdict}</title>\n<style>{}</style>\n</head>\n<body>",
        include_str!("report.css")
    )?;
    writeln!(
        out,
        "<header><h1>Verification report <span class=\"chip {class}\">{verdict}</span></h1>"
    )?;
    write_machine(out, report)?;
    writeln!(out, "</header>")?;
    write_summary(out, report)?;
    writeln!(out, "{}", include_str!("how_to_read.html"))?;
    write_assumptions(out, report)?;
    write_explained(out, report)?;
    for case in &report.cases {
        write_case(out, case)?;
    }
    writeln!(out, "</body>\n</html>")
}

fn write_machine(out: &mut String, report: &Report) -> std::fmt::Result {
    let machine = &report.machine;
    let checks: usize = report.cases.iter().map(|case| case.checks.len()).sum();
    let facts = [
        ("Date", machine.date.clone()),
        ("Version", machine.crate_version.clone()),
        ("Commit", machine.commit.clone().unwrap_or_else(|| "unknown".into())),
        ("Compiler", machine.rustc.clone()),
        ("Processor", format!("{}, {} cores", machine.cpu, machine.cores)),
        ("Threads used", machine.threads.map_or("unknown".into(), |count| count.to_string())),
        ("Tier", format!("{:?}", report.tier).to_lowercase()),
        (
            "Extent",
            format!(
                "{}, {}, {}",
                format::counted(report.cases.len(), "case"),
                format::counted(checks, "check"),
                format::seconds_in_all(report)
            ),
        ),
    ];
    writeln!(out, "<dl class=\"facts\">")?;
    for (name, fact) in facts {
        writeln!(out, "<div><dt>{name}</dt><dd>{}</dd></div>", escape(&fact))?;
    }
    writeln!(out, "</dl>")
}

fn write_summary(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(
        out,
        "<section><h2>Summary</h2><table class=\"summary\"><thead><tr><th>Case</th>\
         <th>Section of the source</th><th class=\"number\">Repro&shy;duced</th>\
         <th class=\"number\">under assump&shy;tion</th><th class=\"number\">Explained</th>\
         <th class=\"number\">Other checks</th><th class=\"number\">Seconds</th>\
         <th class=\"number\">Worst error / tolerance</th><th>Status</th></tr></thead><tbody>"
    )?;
    for case in &report.cases {
        let counted = [Status::Reproduced, Status::ReproducedUnderAssumption, Status::Explained]
            .map(|status| case.count(status));
        writeln!(
            out,
            "<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td class=\"number\">{}</td>\
             <td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>\
             <td class=\"number\">{}{}</td><td class=\"number\">{}</td><td>{}</td></tr>",
            escape(&case.id),
            escape(&case.title),
            escape(&case.section),
            counted[0],
            counted[1],
            counted[2],
            case.checks.len() - counted.iter().sum::<usize>(),
            format::seconds(case.seconds),
            if case.cached.is_some() { "<small>cached</small>" } else { "" },
            optional(case.worst_ratio, 2),
            case_chip(case.status),
        )?;
    }
    writeln!(out, "</tbody></table></section>")
}

fn write_assumptions(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(out, "<section><h2>Assumptions</h2>")?;
    if report.cases.iter().all(|case| case.assumptions.is_empty()) {
        return writeln!(out, "<p>No case needs one.</p></section>");
    }
    writeln!(
        out,
        "<p>What the source leaves out, and the value taken.</p><table><thead><tr>\
         <th>Assumption</th><th>Value</th><th>What it fills</th><th>Case</th></tr></thead><tbody>"
    )?;
    for case in &report.cases {
        for assumption in &case.assumptions {
            writeln!(
                out,
                "<tr><td><code>{}</code></td><td>{}</td><td>{}</td>\
                 <td><a href=\"#{id}\">{id}</a></td></tr>",
                escape(&assumption.name),
                escape(&assumption.default),
                escape(&assumption.text),
                id = escape(&case.id),
            )?;
        }
    }
    writeln!(out, "</tbody></table></section>")
}

fn write_explained(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(out, "<section><h2>Published numbers that are explained, not reproduced</h2>")?;
    if report.cases.iter().all(|case| case.count(Status::Explained) == 0) {
        return writeln!(out, "<p>None.</p></section>");
    }
    writeln!(
        out,
        "<table><thead><tr><th>Quantity</th><th class=\"number\">Published</th>\
         <th class=\"number\">Ours</th><th class=\"number\">Difference</th><th>Explanation</th>\
         </tr></thead><tbody>"
    )?;
    for case in &report.cases {
        for check in case.checks.iter().filter(|check| check.status == Status::Explained) {
            writeln!(
                out,
                "<tr><td><a href=\"#{}\">{}</a><small>{}</small></td><td class=\"number\">{}</td>\
                 <td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td></tr>",
                check_anchor(case, check),
                escape(&check.quantity),
                escape(&check.reference_source),
                number(&format::reference(check), &check.unit),
                number(&format::ours(check), &check.unit),
                nowrap(&format::error(check)),
                explanation(case, check),
            )?;
        }
    }
    writeln!(out, "</tbody></table></section>")
}

fn write_case(out: &mut String, case: &CaseReport) -> std::fmt::Result {
    writeln!(
        out,
        "<section class=\"case\" id=\"{id}\"><h2>{} {}</h2><p class=\"meta\"><code>{id}</code> · \
         {} · {} tier · {} s</p>",
        escape(&case.title),
        case_chip(case.status),
        escape(&case.section),
        format!("{:?}", case.tier).to_lowercase(),
        format::seconds(case.seconds),
        id = escape(&case.id),
    )?;
    if let Some(cached) = &case.cached {
        writeln!(out, "<p class=\"meta cached\">{}</p>", escape(&cached.note))?;
    }
    let failures = case.failures();
    if !failures.is_empty() {
        writeln!(out, "<ul class=\"failures\">")?;
        for failure in failures {
            writeln!(out, "<li>{}</li>", escape(&failure))?;
        }
        writeln!(out, "</ul>")?;
    }
    if !case.assumptions.is_empty() {
        writeln!(out, "<h3>Assumptions</h3><dl class=\"assumptions\">")?;
        for assumption in &case.assumptions {
            writeln!(
                out,
                "<dt><code>{}</code>: {}</dt><dd>{}</dd>",
                escape(&assumption.name),
                escape(&assumption.default),
                prose(&assumption.text)
            )?;
        }
        writeln!(out, "</dl>")?;
    }
    write_checks(out, case)?;
    for figure in &case.figures {
        writeln!(
            out,
            "<figure id=\"{}\">{}<figcaption>{}</figcaption></figure>",
            anchor(case, &figure.name),
            inline_svg(&figure.svg),
            prose(&figure.caption)
        )?;
    }
    for table in &case.tables {
        writeln!(
            out,
            "<h3 id=\"{}\">{}</h3><table class=\"data\"><thead><tr>",
            anchor(case, &table.id),
            escape(&table.title)
        )?;
        for column in &table.columns {
            write!(out, "<th>{}</th>", escape(column))?;
        }
        writeln!(out, "</tr></thead><tbody>")?;
        for row in &table.rows {
            let cells: String =
                row.iter().map(|text| format!("<td>{}</td>", escape(text))).collect();
            writeln!(out, "<tr>{cells}</tr>")?;
        }
        writeln!(out, "</tbody></table>")?;
    }
    if !case.findings.is_empty() {
        writeln!(out, "<h3>Findings</h3><dl class=\"findings\">")?;
        for finding in &case.findings {
            writeln!(
                out,
                "<dt id=\"{}\"><code>{}</code></dt><dd>{}</dd>",
                anchor(case, &finding.id),
                escape(&finding.id),
                prose(&finding.text)
            )?;
        }
        writeln!(out, "</dl>")?;
    }
    if !case.work.is_empty() {
        let counts: Vec<String> =
            case.work.iter().map(|work| format!("{} {}", work.count, escape(&work.name))).collect();
        writeln!(out, "<p class=\"meta\">Work: {}</p>", counts.join(" · "))?;
    }
    if case.golden.status != GoldenStatus::None {
        let accepted = case.golden.last_reason.as_ref().map_or(String::new(), |last| {
            format!(
                "; last accepted {}: {}",
                escape(&last.date),
                escape(last.reason.trim_end_matches('.'))
            )
        });
        writeln!(
            out,
            "<p class=\"meta\">Own past: {} pinned{accepted}.</p>",
            format::counted(case.golden.values, "number")
        )?;
    }
    writeln!(out, "</section>")
}

fn write_checks(out: &mut String, case: &CaseReport) -> std::fmt::Result {
    if case.checks.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "<h3>Checks</h3><table class=\"checks\"><thead><tr><th>Quantity</th>\
         <th class=\"number\">Ours</th><th class=\"number\">Reference</th><th>Held against</th>\
         <th class=\"number\">Error</th><th>Tolerance and its reason</th><th>Status</th></tr>\
         </thead><tbody>"
    )?;
    for check in &case.checks {
        let mut note = String::new();
        if let Some(name) = &check.assumption {
            write!(note, "<small><code>{}</code></small>", escape(name))?;
        }
        if let Some(failure) = &check.failure {
            write!(note, "<small class=\"bad\">{}</small>", escape(failure))?;
        }
        writeln!(
            out,
            "<tr{} id=\"{}\"><td>{}<small><code>{}</code></small></td><td class=\"number\">{}</td>\
             <td class=\"number\">{}</td><td>{}<small>{}</small></td><td class=\"number\">{}</td>\
             <td>{}<small>{}</small></td><td>{}{note}</td></tr>",
            if check.explanation.is_some() { " class=\"continued\"" } else { "" },
            check_anchor(case, check),
            escape(&check.quantity),
            escape(&check.id),
            number(&format::ours(check), &check.unit),
            number(&format::reference(check), &check.unit),
            format::kind(check.reference_kind),
            escape(&check.reference_source),
            nowrap(&format::error(check)),
            nowrap(&format::tolerance(check)),
            escape(&check.tolerance_reason),
            chip(check.status),
        )?;
        if check.explanation.is_some() {
            writeln!(
                out,
                "<tr class=\"continuation\"><td></td><td colspan=\"6\">{}</td></tr>",
                explanation(case, check)
            )?;
        }
    }
    writeln!(out, "</tbody></table>")
}

fn explanation(case: &CaseReport, check: &CheckReport) -> String {
    let Some(explanation) = &check.explanation else { return String::new() };
    let evidence: Vec<String> = explanation
        .evidence
        .iter()
        .map(|id| format!("<a href=\"#{}\">{}</a>", anchor(case, id), escape(id)))
        .collect();
    format!(
        "{} Known difference {} ± {}. Shown by {}.",
        prose(&explanation.text),
        nowrap(&format::gap(check, explanation.gap)),
        nowrap(&format::gap(check, explanation.gap_tolerance)),
        evidence.join(", ")
    )
}

/// Checks, figures, tables and findings of a case share one space of ids.
fn anchor(case: &CaseReport, id: &str) -> String {
    format!("{}--{}", escape(&case.id), escape(id))
}

fn check_anchor(case: &CaseReport, check: &CheckReport) -> String {
    anchor(case, &check.id)
}

/// A number with its unit below it; the signs of degrees and percent stay beside it.
fn number(text: &str, unit: &str) -> String {
    let shown = escape(&format::unit(unit));
    if ["°", "%"].contains(&unit) {
        return format!("<span class=\"value\">{text}{shown}</span>");
    }
    format!("<span class=\"value\">{text}</span><small>{shown}</small>")
}

fn nowrap(text: &str) -> String {
    format!("<span class=\"value\">{}</span>", escape(text))
}

fn chip(status: Status) -> String {
    let class = match status {
        Status::Reproduced | Status::Pass => "good",
        Status::ReproducedUnderAssumption => "assumed",
        Status::Explained | Status::Fit => "open",
        Status::Failed => "bad",
    };
    format!("<span class=\"chip {class}\">{}</span>", status.word())
}

fn case_chip(status: CaseStatus) -> String {
    let class = match status {
        CaseStatus::Passed => "good",
        CaseStatus::Failed | CaseStatus::GoldenChanged => "bad",
        CaseStatus::NotRun => "open",
    };
    format!("<span class=\"chip {class}\">{}</span>", status.word())
}

/// The SVG element without the prolog that only a file needs.
fn inline_svg(svg: &str) -> &str {
    svg.find("<svg").map_or("", |start| &svg[start..])
}

/// Escaped text in which what stands between backticks is code.
fn prose(text: &str) -> String {
    let mut parts: Vec<String> = escape(text).split('`').map(String::from).collect();
    if parts.len().is_multiple_of(2) {
        return escape(text);
    }
    for code in parts.iter_mut().skip(1).step_by(2) {
        *code = format!("<code>{code}</code>");
    }
    parts.concat()
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
