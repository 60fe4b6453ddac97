//! Numbers and words for people; the JSON keeps full precision.

use crate::check::ReferenceKind;
use crate::index::{Entry, Numbers};
use crate::judge::{CheckReport, Status, ToleranceOn};
use crate::report::totals::{self, Totals};
use crate::report::{CaseReport, CaseStatus, Report};

/// `digits` significant digits, in plain notation where that is short.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    if value == 0.0 {
        return "0".into();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    // The exponent after rounding, so that 9.9999 counts as 10.
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return format!("{value:.decimals$}").replace('-', "−");
    }
    let mantissa = if mantissa.contains('.') {
        mantissa.trim_end_matches('0').trim_end_matches('.')
    } else {
        mantissa
    };
    format!("{mantissa}e{exponent}").replace('-', "−")
}

pub fn optional(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".into(), |value| significant(value, digits))
}

/// A fraction as a percentage where that reads well, else as a plain number.
pub fn fraction(value: f64) -> String {
    if value.abs() >= 1e-5 && value.abs() < 10.0 {
        format!("{} %", significant(100.0 * value, 3))
    } else {
        significant(value, 3)
    }
}

/// A limit that a person chose: no zeros to pad it.
pub fn limit_text(value: f64) -> String {
    let text = significant(value, 3);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text,
    }
}

/// [`fraction`] for a limit.
pub fn limit_fraction(value: f64) -> String {
    match (1e-5..10.0).contains(&value) {
        true => format!("{} %", limit_text(100.0 * value)),
        false => limit_text(value),
    }
}

/// The reference: a published number with the digits it is written with, any other with six.
pub fn reference(check: &CheckReport) -> String {
    match check.reference {
        Some(value) if check.published_id.is_some() && (1e-4..1e6).contains(&value.abs()) => {
            value.to_string().replace('-', "−")
        }
        value => six_digits(value, &check.unit),
    }
}

/// Our value.
pub fn ours(check: &CheckReport) -> String {
    six_digits(check.value, &check.unit)
}

/// A count as the integer it is, any other number with six digits.
pub fn six_digits(value: Option<f64>, unit: &str) -> String {
    match value {
        Some(count) if unit == "1" && count.fract() == 0.0 && count.abs() < 1e6 => {
            count.to_string().replace('-', "−")
        }
        value => optional(value, 6),
    }
}

/// The unit after a number; nothing for a pure number, no space before a sign of degrees.
pub fn unit(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        "°" => "°".into(),
        _ => format!(" {unit}"),
    }
}

pub fn kind(kind: Option<ReferenceKind>) -> &'static str {
    match kind {
        Some(ReferenceKind::Published) => "published",
        Some(ReferenceKind::Book) => "book",
        Some(ReferenceKind::OtherProgram) => "other program",
        Some(ReferenceKind::Evidence) => "evidence",
        Some(ReferenceKind::ClosedForm) => "closed form",
        Some(ReferenceKind::Converged) => "converged",
        Some(ReferenceKind::Independent) => "independent",
        Some(ReferenceKind::Consistency) => "consistency",
        Some(ReferenceKind::Stated) => "stated",
        None => "none",
    }
}

/// What a kind of reference is, in a few words.
pub fn meaning(kind: ReferenceKind) -> &'static str {
    match kind {
        ReferenceKind::Published => "a number that the source prints",
        ReferenceKind::Book => "a number of another book, paper or standard",
        ReferenceKind::OtherProgram => "published output of another program",
        ReferenceKind::Evidence => "why a printed number differs",
        ReferenceKind::ClosedForm => "a formula evaluated separately",
        ReferenceKind::Converged => "the limit of a refinement",
        ReferenceKind::Independent => "another method or program",
        ReferenceKind::Consistency => "another method of this program",
        ReferenceKind::Stated => "a sentence of the source",
    }
}

/// The verdict, and how much of the source it speaks of.
pub fn badge(report: &Report, numbers: &Numbers) -> String {
    let verdict = match (report.passed(), report.complete()) {
        (true, _) => "passed",
        (false, true) => "failed",
        (false, false) => "incomplete",
    };
    format!(
        "{verdict}; {} of {} numbers of the source reproduced, {} under assumption, {} not run",
        numbers.reproduced,
        numbers.printed(),
        numbers.under_assumption,
        numbers.not_run
    )
}

/// Checks that settle a published number, least favourable statuses first.
pub fn published(report: &Report) -> impl Iterator<Item = (&CaseReport, &CheckReport)> {
    let of = |status: Status| {
        report.cases.iter().flat_map(move |case| {
            let checks = case.checks.iter();
            checks.filter(move |check| check.status == status).map(move |check| (case, check))
        })
    };
    let settled =
        [Status::Explained, Status::Fit, Status::ReproducedUnderAssumption, Status::Reproduced];
    settled.into_iter().flat_map(of)
}

/// Checks that name an assumption; one that none names shapes the whole case.
pub fn leaning(checks: usize) -> String {
    if checks == 0 { "all".to_string() } else { checks.to_string() }
}

const WHY_SO_FEW: &str = "Few agree outright, because the source seldom prints the inputs behind a number: a number met with an input of ours is \
    reproduced under assumption, and one that a converged computation misses is explained.";

/// What holds and what does not, in sentences.
pub fn lead(report: &Report, totals: &Totals) -> Vec<String> {
    let with = |status: CaseStatus| report.cases.iter().filter(move |case| case.status == status);
    let in_words = |parts: &[(usize, &str)]| {
        let parts = parts.iter().filter(|part| part.0 > 0);
        parts.map(|(count, word)| format!("{count} {word}")).collect::<Vec<_>>().join(", ")
    };
    let mut cases = format!(
        "{} of {} hold",
        with(CaseStatus::Passed).count(),
        counted(report.cases.len(), "case")
    );
    for status in [CaseStatus::Failed, CaseStatus::GoldenChanged, CaseStatus::NotRun] {
        let ids: Vec<&str> = with(status).map(|case| case.id.as_str()).collect();
        match status {
            _ if ids.is_empty() => (),
            CaseStatus::NotRun => cases += &format!("; {} not run yet", ids.len()),
            _ => cases += &format!("; {}: {}", status.word(), ids.join(", ")),
        }
    }
    let statuses: Vec<(usize, &str)> =
        totals.by_status.iter().map(|of| (of.checks, of.status.word())).collect();
    let mut sentences = vec![
        format!(
            "Of {} that the source prints as results: {}.",
            counted(totals.published_numbers.printed(), "number"),
            in_words(&totals.published_numbers.parts())
        ),
        WHY_SO_FEW.to_string(),
        format!(
            "Of {} of other books and programs: {}.",
            counted(totals.outside_numbers.printed(), "number"),
            in_words(&totals.outside_numbers.parts())
        ),
        format!("{cases}."),
        format!(
            "{}: {}. One-sided: {}.",
            counted(totals.checks, "check"),
            in_words(&statuses),
            totals.one_sided
        ),
    ];
    let left_out = totals::left_out(report).len();
    if left_out > 0 {
        sentences.push(format!(
            "{} of this repository, listed below, {} not part of this run.",
            counted(left_out, "case"),
            if left_out == 1 { "is" } else { "are" }
        ));
    }
    sentences
}

/// The colour of an index line: that of its least favourable number.
pub fn worst_class(line: &Entry) -> &'static str {
    let numbers = &line.numbers;
    if numbers.failed > 0 || line.status == "failed" {
        "bad"
    } else if numbers.explained + numbers.fit > 0 {
        "open"
    } else if numbers.under_assumption > 0 {
        "assumed"
    } else if line.status == "not run" {
        "dim"
    } else {
        "good"
    }
}

/// The error, in the measure its tolerance applies to.
pub fn error(check: &CheckReport) -> String {
    match check.tolerance_on {
        Some(ToleranceOn::RelativeError) => check.error_relative.map_or("–".into(), fraction),
        Some(_) => format!("{}{}", optional(check.error_absolute, 3), unit(&check.unit)),
        None => "–".into(),
    }
}

pub fn tolerance(check: &CheckReport) -> String {
    let Some(limit) = check.tolerance else { return "–".into() };
    let margin = |sign: &str| match limit == 0.0 {
        true => format!("{sign} reference"),
        false => format!("{sign} reference, margin {}{}", limit_text(limit), unit(&check.unit)),
    };
    match check.tolerance_on {
        Some(ToleranceOn::RelativeError) => format!("± {}", limit_fraction(limit)),
        Some(ToleranceOn::AtLeast) => margin("≥"),
        Some(ToleranceOn::AtMost) => margin("≤"),
        _ => format!("± {}{}", limit_text(limit), unit(&check.unit)),
    }
}

pub fn seconds(value: Option<f64>) -> String {
    match value {
        None => "–".into(),
        Some(value) if value < 0.001 => "< 0.001".into(),
        Some(value) => significant(value, if value < 10.0 { 2 } else { 3 }),
    }
}

/// The seconds of all computations, and how many of them passed in earlier runs.
pub fn seconds_in_all(report: &Report) -> String {
    let all = format!("{} s", seconds(Some(report.seconds())));
    match report.cached() {
        (0, _) => all,
        (count, before) => format!(
            "{all}, {} s of them in earlier runs ({} from the cache)",
            seconds(Some(before)),
            counted(count, "case")
        ),
    }
}

/// Gap of an explanation, in the measure of the check's tolerance.
pub fn gap(check: &CheckReport, value: f64) -> String {
    let sign = if value < 0.0 { "−" } else { "" };
    match check.tolerance_on {
        Some(ToleranceOn::RelativeError) => format!("{sign}{}", limit_fraction(value.abs())),
        _ => format!("{sign}{}{}", limit_text(value.abs()), unit(&check.unit)),
    }
}

/// A count with its noun.
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
