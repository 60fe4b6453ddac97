//! Memory that factors of a given structure need.

use crate::numeric::sparse::elimination::{Elimination, Panel};
use thiserror::Error;

/// Bytes of a value, and of a value with its row.
const VALUE: f64 = 8.0;
const ENTRY: f64 = 12.0;

/// What a solution holds next to its factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Such as "statics".
    pub name: &'static str,
    /// Stored values of sparse matrices.
    pub matrix: usize,
    /// Vectors of all unknowns.
    pub vectors: usize,
    /// Bytes of other things.
    pub other: usize,
    /// Whether elements of four nodes would do as well, if worse; rubber locks in them.
    pub four_nodes: bool,
}

/// Memory that a solution by factors needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    pub task: Task,
    pub unknowns: usize,
    /// Values of the factor.
    pub fill: usize,
    /// Bytes of the factor, and of all that the solution holds next to it at its peak.
    pub factor_bytes: f64,
    pub other_bytes: f64,
}

fn for_factors(bytes: f64) -> String {
    match bytes {
        0.0 => String::new(),
        _ => format!(", {:.3} GB of it for the factors of the stiffness", 1e-9 * bytes),
    }
}

/// A solution that does not fit into memory.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "{what} of {unknowns} unknowns needs {:.3} GB of memory{}. Allowed: {:.3} GB ({limit_from}). Hint: take a \
     coarser mesh (edges twice as long need about a tenth){fewer_nodes}{other}, or allow more with --memory GB",
    1e-9 * bytes, for_factors(*factor_bytes), 1e-9 * limit
)]
pub struct TooLarge {
    /// Such as "statics".
    pub what: &'static str,
    pub unknowns: usize,
    pub bytes: f64,
    /// None of factors that are there already.
    pub factor_bytes: f64,
    /// Bytes that may be used.
    pub limit: f64,
    /// Who set the limit.
    pub limit_from: String,
    /// Elements that need less, where they would do, and another way to solve it, where there is one.
    pub fewer_nodes: &'static str,
    pub other: &'static str,
}

impl Memory {
    pub fn new(elimination: &Elimination, task: Task) -> Memory {
        let unknowns = elimination.unknowns as f64;
        let structure = 4.0 * elimination.rows.len() as f64
            + (elimination.panels.len() * size_of::<Panel>()) as f64;
        // Owner and place of each unknown, and the largest product.
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

    /// In addition to what the process holds already.
    pub fn bytes(&self) -> f64 {
        self.factor_bytes + self.other_bytes
    }

    /// Refuses what does not fit, where the process holds `held` bytes already and may take `limit`
    /// in all.
    ///
    /// # Errors
    /// [`TooLarge`].
    pub fn refuse_beyond(
        &self,
        held: f64,
        limit: f64,
        limit_from: &str,
        other: &'static str,
    ) -> Result<(), TooLarge> {
        let bytes = held + self.bytes();
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
