//! What factors of a given structure cost: memory by counting, time by the measured speed of the machine.

use super::elimination::{Elimination, Panel};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use std::hint::black_box;
use std::time::Instant;
use thiserror::Error;

// How much slower the parts of a factorisation and a solution are than the products and the reading
// that `Speed` measures: fitted to processor times at 6000 and 52 000 nodes of ten-node elements, and
// held against 171 000 (docs/benchmarks.md).
/// Panels are of all sizes.
const SMALLER_BLOCKS: f64 = 1.7;
/// Products are spread over the rows that they belong to.
const SCATTERED: f64 = 11.0;
/// Both ways through the factors, with rows picked from the solution.
const GATHERED: f64 = 1.9;
/// Few right-hand sides.
const THIN_BLOCKS: f64 = 2.2;

/// Bytes of a value, and of a value with its row.
const VALUE: f64 = 8.0;
const ENTRY: f64 = 12.0;

/// What a solution does with factors and holds beside them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Such as "statics".
    pub name: &'static str,
    pub factorisations: usize,
    /// Whether loads may ask for further ones.
    pub repeats: bool,
    /// How often the factors are read, each time for so many right-hand sides.
    pub passes: usize,
    pub columns: usize,
    /// Stored values of sparse matrices.
    pub matrix: usize,
    /// Vectors of all unknowns.
    pub vectors: usize,
    /// Bytes of other things.
    pub other: usize,
    /// Whether elements of four nodes would do as well, if worse; rubber locks in them.
    pub four_nodes: bool,
    /// What else takes time: as much as so many multiplications and additions of dense products, and
    /// as reading so many bytes.
    pub operations: f64,
    pub traffic: f64,
}

/// What a solution by factors will take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    pub task: Task,
    pub unknowns: usize,
    /// Values of the factor.
    pub fill: usize,
    /// Multiplications and additions of one factorisation.
    pub operations: f64,
    /// Bytes of the factor, and of all that the solution holds beside it at its peak.
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
    "{what} of {unknowns} unknowns needs {:.3} GB of memory{}, and may take {:.3} GB ({limit_from}); take a \
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

impl Cost {
    pub fn new(elimination: &Elimination, task: Task) -> Cost {
        let unknowns = elimination.unknowns as f64;
        let structure = 4.0 * elimination.rows.len() as f64
            + (elimination.panels.len() * size_of::<Panel>()) as f64;
        // Owner and place of each unknown, and the largest product.
        let work = 8.0 * unknowns + VALUE * elimination.most_products as f64;
        let vectors = VALUE * unknowns * task.vectors as f64;
        Cost {
            task,
            unknowns: elimination.unknowns,
            fill: elimination.fill,
            operations: elimination.operations,
            factor_bytes: VALUE * elimination.fill as f64 + structure,
            other_bytes: ENTRY * task.matrix as f64 + vectors + work + task.other as f64,
        }
    }

    /// Beside what the process holds already.
    pub fn bytes(&self) -> f64 {
        self.factor_bytes + self.other_bytes
    }

    /// On one processor that does nothing else, s.
    pub fn seconds(&self, speed: &Speed) -> f64 {
        let Task { factorisations, passes, columns, operations, traffic, .. } = self.task;
        let fill = self.fill as f64;
        let factorise = self.seconds_of_factors(speed);
        let pass = GATHERED * 2.0 * VALUE * fill / speed.bytes
            + THIN_BLOCKS * 4.0 * fill * columns as f64 / speed.operations;
        factorisations as f64 * factorise
            + passes as f64 * pass
            + operations / speed.operations
            + traffic / speed.bytes
    }

    /// One factorisation, s.
    pub fn seconds_of_factors(&self, speed: &Speed) -> f64 {
        SMALLER_BLOCKS * self.operations / speed.operations
            + SCATTERED * VALUE * self.fill as f64 / speed.bytes
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

/// Of the machine as it is loaded now, one thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// Multiplications and additions a second in the products of panels.
    pub operations: f64,
    /// Bytes a second, read once from memory.
    pub bytes: f64,
}

impl Speed {
    /// Measures it in some hundredths of a second: the best of a few tries, since other work only
    /// slows one down.
    pub fn measured() -> Speed {
        const ROWS: usize = 768;
        const COLUMNS: usize = 128;
        const TRIES: usize = 5;
        let left = Mat::from_fn(ROWS, COLUMNS, |i, j| ((i + 2 * j) % 7) as f64);
        let right = Mat::from_fn(COLUMNS, COLUMNS, |i, j| ((3 * i + j) % 5) as f64);
        let mut product = Mat::<f64>::zeros(ROWS, COLUMNS);
        let work = 2.0 * (ROWS * COLUMNS * COLUMNS) as f64;
        let operations = fastest(TRIES, || {
            for _ in 0..4 {
                matmul(product.as_mut(), Accum::Replace, &left, &right, 1.0, Par::Seq);
            }
            black_box(&product);
        });
        let memory = vec![1.0f64; 4 << 20];
        let bytes = fastest(TRIES, || {
            let mut sums = [0.0; 8];
            for eight in black_box(&memory).chunks_exact(8) {
                (0..8).for_each(|i| sums[i] += eight[i]);
            }
            black_box(sums);
        });
        Speed { operations: 4.0 * work / operations, bytes: VALUE * memory.len() as f64 / bytes }
    }
}

/// Least seconds of some tries.
fn fastest(tries: usize, mut work: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..tries {
        let start = Instant::now();
        work();
        least = least.min(start.elapsed().as_secs_f64());
    }
    least
}
