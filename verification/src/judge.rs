//! Verdicts: the recorded checks of a finished case against its published numbers.
//!
//! [`judge`] is a pure function of the record and the published numbers, so that the same record
//! can be judged again with one entry altered ([`entries_without_effect`]).

use std::collections::{HashMap, HashSet};

use serde::{Deserialize, Serialize};

use crate::check::{Check, Explanation, Reference, ReferenceKind, Tolerance};
use crate::context::CaseContext;
use crate::published::{Outside, Published};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// A published number, within tolerance on stated inputs alone.
    Reproduced,
    /// A published number, within tolerance once the named assumption fills a hole.
    ReproducedUnderAssumption,
    /// A published number within tolerance because something was identified from that very number.
    Fit,
    /// A published number that differs, with the difference known and shown.
    Explained,
    /// Agrees with a reference that is not a published number.
    Pass,
    Failed,
}

impl Status {
    /// The word used in reports.
    pub fn word(self) -> &'static str {
        match self {
            Status::Reproduced => "reproduced",
            Status::ReproducedUnderAssumption => "reproduced under assumption",
            Status::Fit => "fit",
            Status::Explained => "explained",
            Status::Pass => "pass",
            Status::Failed => "failed",
        }
    }
}

/// What a tolerance applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToleranceOn {
    RelativeError,
    AbsoluteError,
    /// The tolerance is a margin: ours ≥ reference + margin.
    AtLeast,
    /// The tolerance is a margin: ours ≤ reference − margin.
    AtMost,
}

/// A judged check. Numbers that are not finite appear as `null`, and `failure` says so.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct CheckReport {
    pub id: String,
    pub quantity: String,
    pub unit: String,
    /// Ours.
    pub value: Option<f64>,
    pub reference: Option<f64>,
    pub reference_kind: Option<ReferenceKind>,
    /// Table or section for a published number, else what computed the reference.
    pub reference_source: String,
    pub published_id: Option<String>,
    /// (ours − reference)/|reference|; absent where the reference is zero.
    pub error_relative: Option<f64>,
    /// Ours − reference, in the check's unit.
    pub error_absolute: Option<f64>,
    pub tolerance: Option<f64>,
    pub tolerance_on: Option<ToleranceOn>,
    pub tolerance_reason: String,
    /// |error| over tolerance; absent for one-sided checks and explained numbers.
    pub ratio: Option<f64>,
    pub status: Status,
    pub assumption: Option<String>,
    pub explanation: Option<Explanation>,
    /// What was fitted to what, where the published number was met because it was aimed at.
    pub fit: Option<String>,
    /// Why the check failed.
    pub failure: Option<String>,
}

/// The verdict on one case's checks.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    pub checks: Vec<CheckReport>,
    /// Misuses that make the case fail whatever its checks say.
    pub problems: Vec<String>,
}

impl Verdict {
    pub fn holds(&self) -> bool {
        self.problems.is_empty() && self.checks.iter().all(|check| check.status != Status::Failed)
    }
}

/// Judge every check of a record.
pub fn judge(record: &CaseContext, published: &Published) -> Verdict {
    let mut checks: Vec<CheckReport> =
        record.checks.iter().map(|check| judge_alone(check, record, published)).collect();
    let statuses: HashMap<String, Status> =
        checks.iter().map(|check| (check.id.clone(), check.status)).collect();
    for check in &mut checks {
        if check.status == Status::Explained
            && let Some(failure) = missing_evidence(check, record, &statuses)
        {
            check.status = Status::Failed;
            check.failure = Some(failure);
        }
    }
    let mut problems = misuses(record);
    problems.extend(unsettled_entries(record, published));
    Verdict { checks, problems }
}

/// A check by itself: everything but the evidence of an explanation.
fn judge_alone(check: &Check, record: &CaseContext, published: &Published) -> CheckReport {
    let mut report = CheckReport {
        id: check.id.clone(),
        quantity: check.quantity.clone(),
        unit: check.unit.clone(),
        value: finite(check.ours),
        reference: None,
        reference_kind: None,
        reference_source: String::new(),
        published_id: None,
        error_relative: None,
        error_absolute: None,
        tolerance: None,
        tolerance_on: None,
        tolerance_reason: check.reason.clone(),
        ratio: None,
        status: Status::Failed,
        assumption: check.assumption.clone(),
        explanation: check.explanation.clone(),
        fit: check.fit.clone(),
        failure: None,
    };
    match verdict_of(check, record, published, &mut report) {
        Ok(status) => report.status = status,
        Err(failure) => report.failure = Some(failure),
    }
    report
}

fn verdict_of(
    check: &Check,
    record: &CaseContext,
    published: &Published,
    report: &mut CheckReport,
) -> Result<Status, String> {
    let mut rounding = None;
    let mut states_limit = false;
    let reference = match check.reference.as_ref().ok_or("the check names no reference")? {
        Reference::Computed { kind, value, origin } => {
            report.reference_kind = Some(*kind);
            report.reference_source = origin.clone();
            if origin.trim().is_empty() {
                return Err("the reference does not say where it comes from".into());
            }
            *value
        }
        Reference::Published(id) => {
            report.published_id = Some(id.clone());
            let entry = published
                .get(id)
                .ok_or_else(|| format!("published.toml has no value with id `{id}`"))?;
            report.reference_source = entry.source.clone();
            report.reference_kind = Some(match entry.kind {
                None => ReferenceKind::Published,
                Some(Outside::Book) => ReferenceKind::Book,
                Some(Outside::OtherProgram) => ReferenceKind::OtherProgram,
            });
            rounding = entry.rounding;
            states_limit = entry.bound.is_some();
            if entry.unit != check.unit {
                return Err(format!("ours is in {}, published in {}", check.unit, entry.unit));
            }
            entry.value
        }
    };
    report.reference = finite(reference);

    let tolerance = check.tolerance.ok_or("the check has no tolerance")?;
    let (on, limit) = match tolerance {
        Tolerance::Relative(limit) => (ToleranceOn::RelativeError, limit),
        Tolerance::Absolute(limit) => (ToleranceOn::AbsoluteError, limit),
        Tolerance::Printed => (
            ToleranceOn::AbsoluteError,
            rounding.ok_or("agreement to the printed place needs `rounding` in published.toml")?
                / 2.0,
        ),
        Tolerance::AtLeast { margin } => (ToleranceOn::AtLeast, margin),
        Tolerance::AtMost { margin } => (ToleranceOn::AtMost, margin),
    };
    report.tolerance = finite(limit);
    report.tolerance_on = Some(on);
    let one_sided = matches!(on, ToleranceOn::AtLeast | ToleranceOn::AtMost);
    if report.published_id.is_some() && one_sided && !states_limit {
        report.reference_kind = Some(ReferenceKind::Evidence);
    }
    let error = check.ours - reference;
    let relative = error / reference.abs();
    report.error_absolute = finite(error);
    report.error_relative = finite(relative);

    if check.reason.trim().is_empty() {
        return Err("the tolerance has no reason".into());
    }
    if !(limit >= 0.0 && limit.is_finite()) {
        return Err(format!("the tolerance is {limit}"));
    }
    if !check.ours.is_finite() {
        return Err(format!("our value is {}", check.ours));
    }
    if !reference.is_finite() {
        return Err(format!("the reference is {reference}"));
    }
    if let Some(name) = &check.assumption
        && !record.assumptions.iter().any(|assumption| assumption.name == *name)
    {
        return Err(format!("the case declares no assumption `{name}`"));
    }

    let is_published = report.published_id.is_some();
    misuse_of_fit(check, is_published)?;
    let measured = match on {
        ToleranceOn::RelativeError if reference == 0.0 => {
            return Err("a relative tolerance needs a reference other than zero".into());
        }
        ToleranceOn::RelativeError => relative,
        ToleranceOn::AbsoluteError => error,
        ToleranceOn::AtLeast | ToleranceOn::AtMost => {
            if check.explanation.is_some() {
                return Err("a one-sided check cannot be explained".into());
            }
            let (room, word) = match on {
                ToleranceOn::AtLeast => (error - limit, "above"),
                _ => (-error - limit, "below"),
            };
            // Written so that NaN fails.
            return if room >= 0.0 {
                Ok(if is_published && states_limit { agreement(check) } else { Status::Pass })
            } else {
                Err(format!("ours is not {word} the reference by {limit:e} {}", check.unit))
            };
        }
    };

    let agrees = measured.abs() <= limit;
    match &check.explanation {
        None => {
            report.ratio = finite(if measured == 0.0 { 0.0 } else { measured.abs() / limit });
            if !agrees {
                Err(format!("error {measured:.3e} exceeds tolerance {limit:.3e}"))
            } else if is_published {
                Ok(agreement(check))
            } else {
                Ok(Status::Pass)
            }
        }
        Some(_) if !is_published => Err("only a published number can be explained".into()),
        Some(explanation) if explanation.text.trim().is_empty() => {
            Err("the explanation is empty".into())
        }
        Some(_) if agrees => Err(format!(
            "stale explanation: the difference has vanished (error {measured:.3e} within \
             tolerance {limit:.3e})"
        )),
        Some(explanation) => {
            let stray = (measured - explanation.gap).abs();
            if stray <= explanation.gap_tolerance && explanation.gap_tolerance.is_finite() {
                Ok(Status::Explained)
            } else {
                Err(format!(
                    "stale explanation: the difference is {measured:.4e}, not {:.4e} ± {:.1e}",
                    explanation.gap, explanation.gap_tolerance
                ))
            }
        }
    }
}

fn misuse_of_fit(check: &Check, is_published: bool) -> Result<(), String> {
    let one_sided =
        matches!(check.tolerance, Some(Tolerance::AtLeast { .. } | Tolerance::AtMost { .. }));
    match &check.fit {
        None => Ok(()),
        Some(what) if what.trim().is_empty() => {
            Err("the fit does not say what was fitted to what".into())
        }
        Some(_) if !is_published => Err("only a published number can be met by a fit".into()),
        Some(_) if one_sided => Err("a one-sided check cannot be a fit".into()),
        Some(_) if check.explanation.is_some() => {
            Err("a number that was fitted needs no explanation: it is met".into())
        }
        Some(_) => Ok(()),
    }
}

/// The status of a published number within its tolerance.
fn agreement(check: &Check) -> Status {
    match (&check.fit, &check.assumption) {
        (Some(_), _) => Status::Fit,
        (None, Some(_)) => Status::ReproducedUnderAssumption,
        (None, None) => Status::Reproduced,
    }
}

/// Why the evidence of an explained check does not carry it, if it does not.
fn missing_evidence(
    check: &CheckReport,
    record: &CaseContext,
    statuses: &HashMap<String, Status>,
) -> Option<String> {
    let evidence = &check.explanation.as_ref()?.evidence;
    let mut held = 0;
    for id in evidence {
        match statuses.get(id) {
            Some(Status::Failed) => {
                return Some(format!("the explanation's check `{id}` failed"));
            }
            Some(Status::Explained) => {
                return Some(format!("the explanation rests on `{id}`, itself only explained"));
            }
            // A fitted number holds by construction: it shows nothing.
            Some(Status::Fit) => (),
            Some(_) => held += 1,
            None => {
                let shown = record.figures.iter().any(|figure| figure.name == *id)
                    || record.findings.iter().any(|finding| finding.id == *id)
                    || record.tables.iter().any(|table| table.id == *id);
                if !shown {
                    return Some(format!("the explanation points at `{id}`, which does not exist"));
                }
            }
        }
    }
    (held == 0).then(|| "the explanation has no check of its own that holds".into())
}

/// Misuses of the context that no single check reports.
fn misuses(record: &CaseContext) -> Vec<String> {
    let mut problems = Vec::new();
    let mut seen = HashSet::new();
    let ids = (record.checks.iter().map(|check| &check.id))
        .chain(record.figures.iter().map(|figure| &figure.name))
        .chain(record.findings.iter().map(|finding| &finding.id))
        .chain(record.tables.iter().map(|table| &table.id));
    for id in ids {
        if id.trim().is_empty() {
            problems.push("an id is empty".into());
        } else if !seen.insert(id) {
            problems.push(format!("id `{id}` is used twice"));
        }
    }
    if record.checks.is_empty() {
        problems.push("the case states no check".into());
    }
    for assumption in &record.assumptions {
        if assumption.text.trim().is_empty() || assumption.default.trim().is_empty() {
            problems.push(format!("assumption `{}` lacks its text or value", assumption.name));
        }
    }
    for figure in &record.figures {
        let safe = figure.name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
        if !safe {
            problems.push(format!("figure name `{}` cannot be a file name", figure.name));
        }
        if !figure.svg.contains("<svg") || !figure.svg.trim_end().ends_with("</svg>") {
            problems.push(format!("figure `{}` is not a complete SVG", figure.name));
        }
    }
    for table in &record.tables {
        if table.rows.iter().any(|row| row.len() != table.columns.len()) {
            problems.push(format!("table `{}` has a row of another length", table.id));
        }
    }
    problems
}

/// Every published number must be reproduced or explained by some check; a one-sided check only
/// counts where the source itself states a limit.
fn unsettled_entries(record: &CaseContext, published: &Published) -> Vec<String> {
    let settles = |check: &Check, id: &str, limit: bool| {
        let one_sided =
            matches!(check.tolerance, Some(Tolerance::AtLeast { .. } | Tolerance::AtMost { .. }));
        check.reference == Some(Reference::Published(id.to_string())) && (limit || !one_sided)
    };
    published
        .values()
        .iter()
        .filter(|entry| {
            !record.checks.iter().any(|check| settles(check, &entry.id, entry.bound.is_some()))
        })
        .map(|entry| format!("unused published value `{}` ({})", entry.id, entry.source))
        .collect()
}

/// Published numbers that could be altered far beyond their tolerance with no check noticing.
///
/// Each entry is moved by ten times the widest tolerance any check grants it, up and down; both
/// must break a check that held (one of the two, where the source states a limit).
pub fn entries_without_effect(record: &CaseContext, published: &Published) -> Vec<String> {
    let before = judge(record, published);
    let breaks = |id: &str, value: f64| {
        let after = judge(record, &published.with(id, value));
        before
            .checks
            .iter()
            .zip(&after.checks)
            .any(|(old, new)| old.status != Status::Failed && new.status == Status::Failed)
    };
    published
        .values()
        .iter()
        .filter(|entry| {
            let shift = 10.0 * widest_tolerance(record, published, &entry.id);
            let (up, down) =
                (breaks(&entry.id, entry.value + shift), breaks(&entry.id, entry.value - shift));
            !if entry.bound.is_some() { up || down } else { up && down }
        })
        .map(|entry| entry.id.clone())
        .collect()
}

/// The widest absolute tolerance that a check grants the published number `id`.
pub fn widest_tolerance(record: &CaseContext, published: &Published, id: &str) -> f64 {
    let Some(entry) = published.get(id) else { return 0.0 };
    let smallest = entry.value.abs().max(f64::MIN_POSITIVE) * 4.0 * f64::EPSILON;
    record
        .checks
        .iter()
        .filter(|check| check.reference == Some(Reference::Published(id.to_string())))
        .map(|check| {
            let stray = check.explanation.as_ref().map_or(0.0, |text| text.gap_tolerance);
            match check.tolerance {
                Some(Tolerance::Relative(limit)) => limit.max(stray) * entry.value.abs(),
                Some(Tolerance::Absolute(limit)) => limit.max(stray),
                Some(Tolerance::Printed) => stray.max(entry.rounding.unwrap_or(0.0) / 2.0),
                Some(Tolerance::AtLeast { .. } | Tolerance::AtMost { .. })
                    if entry.bound.is_some() =>
                {
                    (check.ours - entry.value).abs()
                }
                _ => 0.0,
            }
        })
        .fold(smallest, f64::max)
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
