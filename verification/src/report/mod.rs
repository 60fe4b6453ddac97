//! The report as data, as JSON and as HTML.

pub mod format;
mod front;
mod html;
mod json;
pub mod totals;

use std::fs;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::case::{Case, Tier};
use crate::context::{Assumption, Figure, Finding, Table, Work};
use crate::golden::Reason;
use crate::index::Index;
use crate::judge::{CheckReport, Status};
use crate::machine::Machine;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CaseStatus {
    Passed,
    Failed,
    /// All checks hold, but a number differs from its accepted past.
    GoldenChanged,
    /// The report was written before its turn came.
    NotRun,
}

impl CaseStatus {
    pub fn word(self) -> &'static str {
        match self {
            CaseStatus::Passed => "passed",
            CaseStatus::Failed => "failed",
            CaseStatus::GoldenChanged => "golden changed",
            CaseStatus::NotRun => "not run",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum GoldenStatus {
    Unchanged,
    GoldenChanged,
    GoldenMissing,
    /// The case pins nothing.
    #[default]
    None,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct GoldenReport {
    pub status: GoldenStatus,
    /// How many numbers are pinned.
    pub values: usize,
    pub differences: Vec<String>,
    pub last_reason: Option<Reason>,
}

/// Says that a case's numbers were computed in an earlier run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cached {
    /// Date and time.
    pub computed: String,
    pub note: String,
}

impl Cached {
    pub fn computed(date: String) -> Cached {
        let note = format!(
            "computed at {date}, taken from the cache: same case, code and inputs; judged anew"
        );
        Cached { computed: date, note }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct CaseReport {
    pub id: String,
    pub title: String,
    pub section: String,
    pub tier: Tier,
    pub status: CaseStatus,
    /// Of the computation; of the one in the past where it comes from the cache.
    pub seconds: Option<f64>,
    /// Set where nothing was computed in this run.
    pub cached: Option<Cached>,
    /// The error or panic that ended the case.
    pub error: Option<String>,
    /// Misuses: unused published values, ids used twice…
    pub problems: Vec<String>,
    /// Largest error over tolerance among its checks.
    pub worst_ratio: Option<f64>,
    pub checks: Vec<CheckReport>,
    pub assumptions: Vec<Assumption>,
    pub figures: Vec<Figure>,
    pub findings: Vec<Finding>,
    pub tables: Vec<Table>,
    pub work: Vec<Work>,
    pub golden: GoldenReport,
}

impl CaseReport {
    /// A case whose turn has not come.
    pub fn pending(case: &Case) -> CaseReport {
        CaseReport {
            id: case.id.to_string(),
            title: case.title.to_string(),
            section: case.section.to_string(),
            tier: case.tier,
            status: CaseStatus::NotRun,
            seconds: None,
            cached: None,
            error: None,
            problems: Vec::new(),
            worst_ratio: None,
            checks: Vec::new(),
            assumptions: Vec::new(),
            figures: Vec::new(),
            findings: Vec::new(),
            tables: Vec::new(),
            work: Vec::new(),
            golden: GoldenReport::default(),
        }
    }

    /// The status its parts add up to.
    pub fn verdict(&self) -> CaseStatus {
        let holds = self.error.is_none()
            && self.problems.is_empty()
            && self.checks.iter().all(|check| check.status != Status::Failed);
        let as_before = matches!(self.golden.status, GoldenStatus::Unchanged | GoldenStatus::None);
        match (holds, as_before) {
            (false, _) => CaseStatus::Failed,
            (true, false) => CaseStatus::GoldenChanged,
            (true, true) => CaseStatus::Passed,
        }
    }

    /// One line a problem, the first of which says best what is wrong.
    pub fn failures(&self) -> Vec<String> {
        let checks = self.checks.iter().filter_map(|check| {
            check.failure.as_ref().map(|text| format!("check `{}`: {text}", check.id))
        });
        let golden = match self.golden.status {
            GoldenStatus::GoldenChanged | GoldenStatus::GoldenMissing => {
                self.golden.differences.iter().map(|text| format!("golden: {text}")).collect()
            }
            _ => Vec::new(),
        };
        (self.error.iter().cloned())
            .chain(self.problems.iter().cloned())
            .chain(checks)
            .chain(golden)
            .collect()
    }

    /// How many checks have each status.
    pub fn count(&self, status: Status) -> usize {
        self.checks.iter().filter(|check| check.status == status).count()
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    pub machine: Machine,
    pub tier: Tier,
    /// Lines of the source, which the cases carry.
    pub index: Index,
    pub cases: Vec<CaseReport>,
}

impl Report {
    /// All cases ran and passed.
    pub fn passed(&self) -> bool {
        self.cases.iter().all(|case| case.status == CaseStatus::Passed)
    }

    /// Every case has had its turn.
    pub fn complete(&self) -> bool {
        self.cases.iter().all(|case| case.status != CaseStatus::NotRun)
    }

    /// What all computations took, those in the past as well.
    pub fn seconds(&self) -> f64 {
        self.cases.iter().filter_map(|case| case.seconds).sum()
    }

    /// How many cases come from the cache, and the seconds of their computations.
    pub fn cached(&self) -> (usize, f64) {
        let cached = self.cases.iter().filter(|case| case.cached.is_some());
        (cached.clone().count(), cached.filter_map(|case| case.seconds).sum())
    }

    /// Write `report.json` and `report.html` into `folder`. Each file appears whole or not at all.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        write_atomically(&folder.join("report.json"), &json::render(self)?)?;
        write_atomically(&folder.join("report.html"), &html::render(self))
    }
}

/// Write a file so that a reader sees the old text or the new, never a part.
pub fn write_atomically(path: &Path, text: &str) -> io::Result<()> {
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    fs::write(&partial, text)?;
    fs::rename(&partial, path)
}
