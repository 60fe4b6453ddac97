//! What a case may do: record. Nothing recorded is judged until the case has finished.

use serde::{Deserialize, Serialize};

use crate::check::Check;
use crate::golden::{GoldenTolerance, GoldenValue};

/// Something the source leaves out and this program had to choose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Assumption {
    pub name: String,
    pub text: String,
    /// The value chosen, with its unit.
    pub default: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    pub name: String,
    /// A complete `<svg>` element.
    pub svg: String,
    pub caption: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    pub id: String,
    pub text: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    pub id: String,
    pub title: String,
    pub columns: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

/// A count of work done, the same on every machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Work {
    pub name: String,
    pub count: u64,
}

/// All that a case has recorded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CaseContext {
    pub(crate) checks: Vec<Check>,
    pub(crate) assumptions: Vec<Assumption>,
    pub(crate) figures: Vec<Figure>,
    pub(crate) findings: Vec<Finding>,
    pub(crate) tables: Vec<Table>,
    pub(crate) work: Vec<Work>,
    pub(crate) golden: Vec<GoldenValue>,
}

impl CaseContext {
    /// State a check. A misuse (no reason, unknown assumption, id used twice…) fails the case.
    pub fn check(&mut self, check: Check) {
        if let Some(tolerance) = check.golden {
            self.golden(&check.id, check.ours, &check.unit, tolerance);
        }
        self.checks.push(check);
    }

    /// Name a choice the source leaves open, and the value taken.
    pub fn assumption(&mut self, name: &str, text: &str, default: &str) {
        self.assumptions.push(Assumption {
            name: name.to_string(),
            text: text.to_string(),
            default: default.to_string(),
        });
    }

    /// Add a figure: `svg` is a complete SVG document.
    pub fn figure(&mut self, name: &str, svg: String, caption: &str) {
        self.figures.push(Figure { name: name.to_string(), svg, caption: caption.to_string() });
    }

    /// Write down something a reader should know; the id lets an explanation point at it.
    pub fn finding(&mut self, id: &str, text: impl Into<String>) {
        self.findings.push(Finding { id: id.to_string(), text: text.into() });
    }

    /// Show a table of cells already formatted; each row has one cell a column.
    pub fn table(&mut self, id: &str, title: &str, columns: &[&str], rows: Vec<Vec<String>>) {
        self.tables.push(Table {
            id: id.to_string(),
            title: title.to_string(),
            columns: columns.iter().map(|name| name.to_string()).collect(),
            rows,
        });
    }

    /// Count work done (iterations, force evaluations). Counts are pinned exactly in the golden
    /// file: a lost optimisation then shows on any machine.
    pub fn work(&mut self, name: &str, count: u64) {
        self.work.push(Work { name: name.to_string(), count });
        self.golden(&format!("work: {name}"), count as f64, "1", GoldenTolerance::EXACT);
    }

    /// Pin a number that no check holds against the world.
    pub fn golden(&mut self, name: &str, value: f64, unit: &str, tolerance: GoldenTolerance) {
        self.golden.push(GoldenValue {
            name: name.to_string(),
            value,
            unit: unit.to_string(),
            tolerance,
        });
    }

    /// Our numbers of all checks, by check id, as stated.
    pub fn ours(&self) -> Vec<(String, f64)> {
        self.checks.iter().map(|check| (check.id.clone(), check.ours)).collect()
    }

    /// The checks as stated.
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// The numbers to pin.
    pub fn golden_values(&self) -> &[GoldenValue] {
        &self.golden
    }
}
