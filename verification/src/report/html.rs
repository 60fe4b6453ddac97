//! `report.html`: one file, nothing fetched, readable on paper.

use std::fmt::Write;

use crate::judge::{CheckReport, Status};
use crate::report::format::{self, optional};
use crate::report::{CaseReport, CaseStatus, GoldenStatus, Report, front, totals};

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
    let source = report.index.judged(&report.cases);
    writeln!(
        out,
        "<header><h1>Verification report <span class=\"chip {class}\">{}</span></h1>",
        escape(&format::badge(report, &totals::totals(report, &source).published_numbers))
    )?;
    front::write_totals(out, report, &source)?;
    writeln!(out, "</header>")?;
    front::write_failures(out, report)?;
    front::write_met_and_missed(out, report)?;
    front::write_published(out, report)?;
    front::write_source(out, &source)?;
    front::write_left_out(out, report)?;
    front::write_assumptions(out, report)?;
    write_summary(out, report)?;
    writeln!(out, "{}", include_str!("how_to_read.html"))?;
    for case in &report.cases {
        write_case(out, report, case)?;
    }
    write_machine(out, report)?;
    writeln!(out, "</body>\n</html>")
}

fn write_machine(out: &mut String, report: &Report) -> std::fmt::Result {
    let machine = &report.machine;
    let facts = [
        ("Date", machine.date.clone()),
        ("Version", machine.crate_version.clone()),
        ("Commit", machine.commit.clone().unwrap_or_else(|| "unknown".into())),
        ("Compiler", machine.rustc.clone()),
        ("Processor", format!("{}, {} cores", machine.cpu, machine.cores)),
        ("Threads used", machine.threads.map_or("unknown".into(), |count| count.to_string())),
        ("Tier", format!("{:?}", report.tier).to_lowercase()),
        ("Seconds", format::seconds_in_all(report)),
    ];
    writeln!(out, "<section><h2>The run</h2><dl class=\"facts\">")?;
    for (name, fact) in facts {
        writeln!(out, "<div><dt>{name}</dt><dd>{}</dd></div>", escape(&fact))?;
    }
    writeln!(out, "</dl></section>")
}

fn write_summary(out: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(
        out,
        "<section><h2>Cases</h2><table class=\"summary\"><thead><tr><th>Case</th>\
         <th>Section of the source</th><th class=\"number\">Repro&shy;duced</th>\
         <th class=\"number\">under assump&shy;tion</th><th class=\"number\">Fit</th>\
         <th class=\"number\">Explained</th><th class=\"number\">Other checks</th>\
         <th class=\"number\">One-sided</th><th class=\"number\">Seconds</th>\
         <th class=\"number\">Worst error / tolerance</th><th>Status</th></tr></thead><tbody>"
    )?;
    for case in &report.cases {
        let counted =
            [Status::Reproduced, Status::ReproducedUnderAssumption, Status::Fit, Status::Explained]
                .map(|status| case.count(status));
        writeln!(
            out,
            "<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td class=\"number\" data-name=\"reproduced\">{}</td>\
             <td class=\"number\" data-name=\"under assumption\">{}</td>\
             <td class=\"number\" data-name=\"fit\">{}</td><td class=\"number\" data-name=\"explained\">{}</td>\
             <td class=\"number\" data-name=\"other checks\">{}</td>\
             <td class=\"number\" data-name=\"one-sided\">{}</td>\
             <td class=\"number\" data-name=\"seconds\">{}{}</td>\
             <td class=\"number\" data-name=\"worst error / tolerance\">{}</td><td>{}</td></tr>",
            escape(&case.id),
            escape(&case.title),
            escape(&case.section),
            counted[0],
            counted[1],
            counted[2],
            counted[3],
            case.checks.len() - counted.iter().sum::<usize>(),
            case.checks.iter().filter(|check| totals::one_sided(check)).count(),
            format::seconds(case.seconds),
            if case.cached.is_some() { "<small>cached</small>" } else { "" },
            optional(case.worst_ratio, 2),
            case_chip(case.status),
        )?;
    }
    writeln!(out, "</tbody></table></section>")
}

fn write_case(out: &mut String, report: &Report, case: &CaseReport) -> std::fmt::Result {
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
        let names: Vec<String> = (case.assumptions.iter())
            .map(|assumption| {
                let name = escape(&assumption.name);
                format!("<a href=\"#assumptions\"><code>{name}</code></a>")
            })
            .collect();
        writeln!(out, "<p class=\"meta\">Assumptions: {}</p>", names.join(", "))?;
    }
    write_checks(out, report, case)?;
    write_figures(out, case)?;
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
    write_tables(out, case)?;
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
            "<p class=\"meta\">Golden values: {}{accepted}.</p>",
            format::counted(case.golden.values, "number")
        )?;
    }
    writeln!(out, "</section>")
}

fn write_figures(out: &mut String, case: &CaseReport) -> std::fmt::Result {
    if case.figures.is_empty() {
        return Ok(());
    }
    writeln!(out, "<div class=\"figures\">")?;
    for figure in &case.figures {
        writeln!(
            out,
            "<figure id=\"{}\">{}<figcaption>{}</figcaption></figure>",
            anchor(case, &figure.name),
            inline_svg(&figure.svg),
            prose(&figure.caption)
        )?;
    }
    writeln!(out, "</div>")
}

fn write_tables(out: &mut String, case: &CaseReport) -> std::fmt::Result {
    for table in &case.tables {
        writeln!(
            out,
            "<details class=\"data\" id=\"{}\"><summary>Table: {}</summary><table class=\"data\">\
             <thead><tr>",
            anchor(case, &table.id),
            escape(&table.title)
        )?;
        for column in &table.columns {
            write!(out, "<th>{}</th>", escape(column))?;
        }
        writeln!(out, "</tr></thead><tbody>")?;
        for row in &table.rows {
            write!(out, "<tr>")?;
            for text in row {
                write!(out, "<td>{}</td>", escape(text))?;
            }
            writeln!(out, "</tr>")?;
        }
        writeln!(out, "</tbody></table></details>")?;
    }
    Ok(())
}

fn write_checks(out: &mut String, report: &Report, case: &CaseReport) -> std::fmt::Result {
    if case.checks.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "<h3 class=\"label\">Checks</h3><table class=\"checks\"><thead><tr><th>Quantity</th>\
         <th class=\"number\">Ours</th><th class=\"number\">Reference</th><th>Kind of reference</th>\
         <th class=\"number\">Error</th><th>Tolerance and its reason</th><th>Status</th></tr>\
         </thead><tbody>"
    )?;
    for check in &case.checks {
        let mut note = String::new();
        if let Some(name) = &check.assumption {
            write!(note, "<small><code>{}</code></small>", escape(name))?;
        }
        if let Some(id) = &check.published_id {
            let twins = report.index.twins(&case.id, id);
            if !twins.is_empty() {
                write!(note, "<small>also in {}</small>", escape(&twins.join(", ")))?;
            }
        }
        if let Some(what) = &check.fit {
            write!(note, "<small>{}</small>", prose(what))?;
        }
        if let Some(failure) = &check.failure {
            write!(note, "<small class=\"bad\">{}</small>", escape(failure))?;
        }
        writeln!(
            out,
            "<tr{} id=\"{}\"><td>{}<small><code>{}</code></small></td><td class=\"number\" data-name=\"ours\">{}</td>\
             <td class=\"number\" data-name=\"reference\">{}</td><td>{}<small>{}</small></td>\
             <td class=\"number\" data-name=\"error\">{}</td>\
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

pub(super) fn explanation(case: &CaseReport, check: &CheckReport) -> String {
    let Some(explanation) = &check.explanation else { return String::new() };
    let evidence: Vec<String> = explanation
        .evidence
        .iter()
        .map(|id| format!("<a href=\"#{}\">{}</a>", anchor(case, id), escape(id)))
        .collect();
    format!(
        "{} Known difference {} ± {}, shown by {}.",
        prose(&explanation.text),
        nowrap(&format::gap(check, explanation.gap)),
        nowrap(&format::gap(check, explanation.gap_tolerance)),
        evidence.join(", ")
    )
}

/// Checks, figures, tables and findings of a case share one space of ids.
pub(super) fn anchor(case: &CaseReport, id: &str) -> String {
    format!("{}--{}", escape(&case.id), escape(id))
}

pub(super) fn check_anchor(case: &CaseReport, check: &CheckReport) -> String {
    anchor(case, &check.id)
}

/// A number with its unit below it; the signs of degrees and percent stay beside it.
pub(super) fn number(text: &str, unit: &str) -> String {
    let shown = escape(&format::unit(unit));
    if ["°", "%"].contains(&unit) {
        return format!("<span class=\"value\">{text}{shown}</span>");
    }
    format!("<span class=\"value\">{text}</span><small>{shown}</small>")
}

pub(super) fn nowrap(text: &str) -> String {
    format!("<span class=\"value\">{}</span>", escape(text))
}

pub(super) fn chip(status: Status) -> String {
    let class = match status {
        Status::Reproduced | Status::Pass => "good",
        Status::ReproducedUnderAssumption => "assumed",
        Status::Explained | Status::Fit => "open",
        Status::Failed => "bad",
    };
    format!("<span class=\"chip {class}\">{}</span>", status.word())
}

pub(super) fn case_chip(status: CaseStatus) -> String {
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
pub(super) fn prose(text: &str) -> String {
    let mut parts: Vec<String> = escape(text).split('`').map(String::from).collect();
    if parts.len().is_multiple_of(2) {
        return escape(text);
    }
    for code in parts.iter_mut().skip(1).step_by(2) {
        *code = format!("<code>{code}</code>");
    }
    parts.concat()
}

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
