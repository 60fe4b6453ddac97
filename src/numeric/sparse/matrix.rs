//! Sparse symmetric matrices.

use std::sync::Arc;

/// Position of an entry on or below the diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    pub row: usize,
    pub column: usize,
}

/// Sparsity pattern of the lower triangle, column by column; shared by matrices.
#[derive(Debug, PartialEq)]
struct Pattern {
    starts: Vec<usize>,
    rows: Vec<u32>,
}

/// Lower triangle of a symmetric matrix, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricMatrix {
    pattern: Arc<Pattern>,
    values: Vec<f64>,
}

impl SymmetricMatrix {
    /// Zero matrix. `rows_of` appends the rows of a column to a list, ascending from the diagonal.
    pub fn new(size: usize, mut rows_of: impl FnMut(usize, &mut Vec<u32>)) -> SymmetricMatrix {
        let mut starts = Vec::with_capacity(size + 1);
        starts.push(0);
        let mut rows = Vec::new();
        for column in 0..size {
            rows_of(column, &mut rows);
            starts.push(rows.len());
        }
        rows.shrink_to_fit();
        let values = vec![0.0; rows.len()];
        SymmetricMatrix { pattern: Arc::new(Pattern { starts, rows }), values }
    }

    pub fn size(&self) -> usize {
        self.pattern.starts.len() - 1
    }

    /// Number of stored values.
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// # Panics
    /// If the entry is not in the pattern.
    pub fn add(&mut self, Entry { row, column }: Entry, value: f64) {
        let start = self.pattern.starts[column];
        let of_column = &self.pattern.rows[start..self.pattern.starts[column + 1]];
        let at = of_column.binary_search(&(row as u32)).expect("the entry is in the pattern");
        self.values[start + at] += value;
    }

    /// Adds `factor` times the outer product of a sparse vector (unknowns, ascending, and values) with itself.
    ///
    /// # Panics
    /// If an entry is not in the pattern.
    pub fn add_square(&mut self, factor: f64, vector: &[(usize, f64)]) {
        for (at, &(column, value)) in vector.iter().enumerate() {
            let start = self.pattern.starts[column];
            let rows = &self.pattern.rows[start..self.pattern.starts[column + 1]];
            let mut place = 0;
            for &(row, other) in &vector[at..] {
                // Both lists are ascending.
                while rows[place] as usize != row {
                    place += 1;
                }
                self.values[start + place] += factor * value * other;
            }
        }
    }

    /// Adds `factor` times a matrix whose pattern is contained in this one's.
    ///
    /// # Panics
    /// If an entry is not in the pattern.
    pub fn add_scaled(&mut self, factor: f64, other: &SymmetricMatrix) {
        for column in 0..self.size() {
            for (row, value) in other.column(column) {
                self.add(Entry { row, column }, factor * value);
            }
        }
    }

    /// Rows and values of a column, starting at the diagonal.
    pub fn column(&self, column: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let of = self.pattern.starts[column]..self.pattern.starts[column + 1];
        let rows = self.pattern.rows[of.clone()].iter().map(|row| *row as usize);
        rows.zip(self.values[of].iter().copied())
    }

    /// y = A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for column in 0..self.size() {
            let mut sum = 0.0;
            for (row, value) in self.column(column) {
                y[row] += value * x[column];
                if row != column {
                    sum += value * x[row];
                }
            }
            y[column] += sum;
        }
    }
}
