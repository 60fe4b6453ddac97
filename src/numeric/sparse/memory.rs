//! Memory estimate for solutions with a factor of known structure.

use crate::numeric::sparse::elimination::{Elimination, Panel};
use thiserror::Error;

/// Bytes per value, and per value with its row.
const VALUE: f64 = 8.0;
const ENTRY: f64 = 12.0;

/// Memory of a solution in addition to its factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Name for messages, such as "statics".
    pub name: &'static str,
    /// Stored values of sparse matrices.
    pub matrix: usize,
    /// Number of vectors over all unknowns.
    pub vectors: usize,
    /// Other memory, bytes.
    pub other: usize,
    /// True if four-node elements are a (less accurate) alternative; rubber locks in them.
    pub four_nodes: bool,
}

/// Memory estimate of a solution with a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    pub task: Task,
    pub unknowns: usize,
    /// Number of values in the factor.
    pub fill: usize,
    /// Bytes of the factor, and peak bytes of all other data.
    pub factor_bytes: f64,
    pub other_bytes: f64,
}

fn for_factors(bytes: f64) -> String {
    match bytes {
        0.0 => String::new(),
        _ => format!(", {:.3} GB of it for the factors of the stiffness", 1e-9 * bytes),
    }
}

/// Error: a solution does not fit into memory.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "{what} of {unknowns} unknowns needs {:.3} GB of memory{}. Allowed: {:.3} GB ({limit_from}). Hint: use a \
     coarser mesh (twice the edge length needs about a tenth){fewer_nodes}{other}, or allow more with --memory GB",
    1e-9 * bytes, for_factors(*factor_bytes), 1e-9 * limit
)]
pub struct TooLarge {
    /// Name of the solution, such as "statics".
    pub what: &'static str,
    pub unknowns: usize,
    pub bytes: f64,
    /// Zero if the factor already exists.
    pub factor_bytes: f64,
    /// Allowed memory, bytes.
    pub limit: f64,
    /// Origin of the limit.
    pub limit_from: String,
    /// Hints: elements that need less memory, and another solution method; empty if there is none.
    pub fewer_nodes: &'static str,
    pub other: &'static str,
}

impl Memory {
    pub fn new(elimination: &Elimination, task: Task) -> Memory {
        let unknowns = elimination.unknowns as f64;
        let structure = 4.0 * elimination.rows.len() as f64
            + (elimination.panels.len() * size_of::<Panel>()) as f64;
        // Owner and row of each unknown, and the largest update product.
        let work = 8.0 * unknowns + VALUE * elimination.most_products as f64;
        let vectors = VALUE * unknowns * task.vectors as f64;
        Memory {
            task,
            unknowns: elimination.unknowns,
            fill: elimination.fill,
            factor_bytes: VALUE * elimination.fill as f64 + structure,
            other_bytes: ENTRY * task.matrix as f64 + vectors + work + task.other as f64,
        }
    }

    /// Additional memory of the solution, bytes.
    pub fn bytes(&self) -> f64 {
        self.factor_bytes + self.other_bytes
    }

    /// Checks that the solution fits into memory: the process already uses `used` bytes and may use `limit` bytes in
    /// total.
    ///
    /// # Errors
    /// [`TooLarge`] if it does not fit.
    pub fn refuse_beyond(
        &self,
        used: f64,
        limit: f64,
        limit_from: &str,
        other: &'static str,
    ) -> Result<(), TooLarge> {
        let bytes = used + self.bytes();
        if bytes <= limit {
            return Ok(());
        }
        Err(TooLarge {
            what: self.task.name,
            unknowns: self.unknowns,
            bytes,
            factor_bytes: self.factor_bytes,
            limit,
            limit_from: limit_from.into(),
            fewer_nodes: if self.task.four_nodes { ", four-node elements (order = 1)" } else { "" },
            other,
        })
    }
}
