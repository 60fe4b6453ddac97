//! Left-looking Cholesky factorisation by panels: each panel subtracts the updates of earlier panels and is then
//! factorised as a dense block (faer, one thread).

use crate::numeric::sparse::FactorError;
use crate::numeric::sparse::elimination::{Elimination, Panel};
use crate::numeric::sparse::matrix::SymmetricMatrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::prelude::{MatMut, MatRef, Reborrow, ReborrowMut};
use faer::{Accum, Par, Spec};
use std::sync::Arc;

const NONE: u32 = u32::MAX;

/// Cholesky factor; rows and columns in elimination order.
pub struct Factor {
    elimination: Arc<Elimination>,
    values: Vec<f64>,
}

impl Factor {
    /// Factorises a matrix with the analysed pattern.
    ///
    /// # Errors
    /// If the matrix is not positive definite, or if memory is insufficient.
    pub fn new(
        elimination: &Arc<Elimination>,
        matrix: &SymmetricMatrix,
    ) -> Result<Factor, FactorError> {
        let mut values = Vec::new();
        values
            .try_reserve_exact(elimination.fill)
            .map_err(|_| FactorError::NoMemory { bytes: 8.0 * elimination.fill as f64 })?;
        values.resize(elimination.fill, 0.0);
        let mut factor = Factor { elimination: elimination.clone(), values };
        factor.refactor(matrix)?;
        Ok(factor)
    }

    /// Number of stored values.
    pub fn fill(&self) -> usize {
        self.values.len()
    }

    /// Factorises a matrix with the same pattern.
    ///
    /// # Errors
    /// See [`Factor::new`]; the factor is then unusable.
    pub fn refactor(&mut self, matrix: &SymmetricMatrix) -> Result<(), FactorError> {
        let elimination = self.elimination.clone();
        let mut pending = PendingUpdates::new(&elimination);
        for (index, panel) in elimination.panels.iter().enumerate() {
            let (before, from_here) = self.values.split_at_mut(panel.values);
            let block = &mut from_here[..panel.stored()];
            block.fill(0.0);
            pending.locate(index);
            pending.gather(matrix, block);
            pending.apply(before, block);
            dense(panel, block)?;
            pending.enqueue_finished(index);
        }
        Ok(())
    }

    /// Solves in place.
    pub fn solve(&self, right: &mut [f64]) {
        self.solve_columns(right, 1);
    }

    /// Solves in place for `columns` right-hand sides, stored one after the other in `right`. The factor is read once
    /// for all of them.
    pub fn solve_columns(&self, right: &mut [f64], columns: usize) {
        let size = right.len() / columns;
        let tallest = self.elimination.panels.iter().map(Panel::height).max().unwrap_or(0);
        let mut below = vec![0.0; tallest * columns];
        for panel in &self.elimination.panels {
            let (diagonal, lower) = self.parts(panel);
            let mut x = MatMut::from_column_major_slice_mut(right, size, columns);
            let mut top = x.rb_mut().subrows_mut(panel.first, panel.columns);
            solve_lower_triangular_in_place(diagonal, top.rb_mut(), Par::Seq);
            let rows = lower.nrows();
            let mut product =
                MatMut::from_column_major_slice_mut(&mut below[..rows * columns], rows, columns);
            matmul(product.rb_mut(), Accum::Replace, lower, top.rb(), 1.0, Par::Seq);
            for column in 0..columns {
                let x = &mut right[column * size..(column + 1) * size];
                let products = &below[column * rows..(column + 1) * rows];
                for (row, product) in self.rows_below(panel).zip(products) {
                    x[row] -= product;
                }
            }
        }
        for panel in self.elimination.panels.iter().rev() {
            let (diagonal, lower) = self.parts(panel);
            let rows = lower.nrows();
            for column in 0..columns {
                let x = &right[column * size..(column + 1) * size];
                let known = &mut below[column * rows..(column + 1) * rows];
                for (row, known) in self.rows_below(panel).zip(known) {
                    *known = x[row];
                }
            }
            let known = MatRef::from_column_major_slice(&below[..rows * columns], rows, columns);
            let x = MatMut::from_column_major_slice_mut(right, size, columns);
            let mut top = x.subrows_mut(panel.first, panel.columns);
            matmul(top.rb_mut(), Accum::Add, lower.transpose(), known, -1.0, Par::Seq);
            solve_upper_triangular_in_place(diagonal.transpose(), top, Par::Seq);
        }
    }

    fn parts(&self, panel: &Panel) -> (MatRef<'_, f64>, MatRef<'_, f64>) {
        let block = &self.values[panel.values..panel.values + panel.stored()];
        MatRef::from_column_major_slice(block, panel.height(), panel.columns)
            .split_at_row(panel.columns)
    }

    fn rows_below(&self, panel: &Panel) -> impl Iterator<Item = usize> + '_ {
        let end = panel.first + panel.columns;
        let outer = self.elimination.rows[panel.outer.clone()].iter().map(|row| *row as usize);
        (end..end + panel.inner).chain(outer)
    }
}

/// Factorises a panel to which all updates have been applied.
fn dense(panel: &Panel, block: &mut [f64]) -> Result<(), FactorError> {
    let whole = MatMut::from_column_major_slice_mut(block, panel.height(), panel.columns);
    let (mut diagonal, lower) = whole.split_at_row_mut(panel.columns);
    let mut memory =
        MemBuffer::new(cholesky_in_place_scratch::<f64>(panel.columns, Par::Seq, Spec::default()));
    cholesky_in_place(
        diagonal.rb_mut(),
        Default::default(),
        Par::Seq,
        MemStack::new(&mut memory),
        Spec::default(),
    )
    .map_err(|LltError::NonPositivePivot { index }| FactorError::NotPositiveDefinite {
        pivot: panel.first + index,
    })?;
    solve_lower_triangular_in_place(diagonal.rb(), lower.transpose_mut(), Par::Seq);
    Ok(())
}

/// Pending updates of panels by earlier panels, and the row positions of the current panel.
struct PendingUpdates<'a> {
    elimination: &'a Elimination,
    /// Panel of each unknown.
    owner: Vec<u32>,
    /// Linked lists of pending updates: first source panel of each panel, and the next one after each.
    first: Vec<u32>,
    next: Vec<u32>,
    /// First row, among all rows of a panel, whose updates are pending.
    reached: Vec<u32>,
    /// Row of each unknown in the current panel.
    local: Vec<u32>,
    panel: usize,
    /// Target rows and values of one update.
    places: Vec<u32>,
    products: Vec<f64>,
}

impl<'a> PendingUpdates<'a> {
    fn new(elimination: &'a Elimination) -> Self {
        let count = elimination.panels.len();
        let mut owner = vec![0; elimination.unknowns];
        for (index, panel) in (0u32..).zip(&elimination.panels) {
            owner[panel.first..panel.first + panel.columns].fill(index);
        }
        PendingUpdates {
            elimination,
            owner,
            first: vec![NONE; count],
            next: vec![NONE; count],
            reached: vec![0; count],
            local: vec![0; elimination.unknowns],
            panel: 0,
            places: Vec::new(),
            products: Vec::new(),
        }
    }

    fn panel(&self) -> &'a Panel {
        &self.elimination.panels[self.panel]
    }

    /// Unknown of a panel's row.
    fn unknown(&self, panel: &Panel, row: usize) -> usize {
        let own = panel.columns + panel.inner;
        if row < own {
            panel.first + row
        } else {
            self.elimination.rows[panel.outer.start + row - own] as usize
        }
    }

    /// Selects a panel and marks its rows.
    fn locate(&mut self, index: usize) {
        self.panel = index;
        let panel = self.panel();
        for row in 0..panel.height() {
            let unknown = self.unknown(panel, row);
            self.local[unknown] = row as u32;
        }
    }

    fn gather(&self, matrix: &SymmetricMatrix, block: &mut [f64]) {
        let panel = self.panel();
        let height = panel.height();
        for column in 0..panel.columns {
            for (row, value) in matrix.column(panel.first + column) {
                block[column * height + self.local[row] as usize] += value;
            }
        }
    }

    /// Subtracts all pending updates of the current panel and enqueues their sources for later panels.
    fn apply(&mut self, before: &[f64], block: &mut [f64]) {
        let panel = self.panel();
        let end = panel.first + panel.columns;
        let mut source = std::mem::replace(&mut self.first[self.panel], NONE);
        while source != NONE {
            let index = source as usize;
            source = self.next[index];
            let from = &self.elimination.panels[index];
            let start = self.reached[index] as usize;
            let height = from.height();
            let mut columns = 1;
            while start + columns < height && self.unknown(from, start + columns) < end {
                columns += 1;
            }
            let values = &before[from.values..from.values + from.stored()];
            let whole = MatRef::from_column_major_slice(values, height, from.columns);
            let lower = whole.subrows(start, height - start);
            self.subtract(from, start, lower, columns, block);
            self.enqueue(index, start + columns);
        }
    }

    /// Subtracts `lower` times the transpose of its first `columns` rows.
    fn subtract(
        &mut self,
        from: &Panel,
        start: usize,
        lower: MatRef<'_, f64>,
        columns: usize,
        block: &mut [f64],
    ) {
        let height = self.panel().height();
        let rows = lower.nrows();
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        places.extend((start..start + rows).map(|row| self.local[self.unknown(from, row)]));
        let first = places[0] as usize;
        let right = lower.subrows(0, columns).transpose();
        if places[rows - 1] as usize - first + 1 == rows {
            // Contiguous rows: subtracted in place.
            let width = self.panel().columns;
            let whole = MatMut::from_column_major_slice_mut(block, height, width);
            let place = whole.subcols_mut(first, columns).subrows_mut(first, rows);
            multiply(place, Accum::Add, lower, right, -1.0);
        } else {
            self.products.resize(self.products.len().max(rows * columns), 0.0);
            let products = &mut self.products[..rows * columns];
            let place = MatMut::from_column_major_slice_mut(products, rows, columns);
            multiply(place, Accum::Replace, lower, right, 1.0);
            for (column, of_products) in products.chunks_exact(rows).enumerate() {
                let at = places[column] as usize;
                let of_block = &mut block[at * height..(at + 1) * height];
                for (place, product) in places[column..].iter().zip(&of_products[column..]) {
                    of_block[*place as usize] -= product;
                }
            }
        }
        self.places = places;
    }

    /// Enqueues a finished panel for the panel of its first row below.
    fn enqueue_finished(&mut self, index: usize) {
        let columns = self.elimination.panels[index].columns;
        self.enqueue(index, columns);
    }

    fn enqueue(&mut self, index: usize, row: usize) {
        let panel = &self.elimination.panels[index];
        if row < panel.height() {
            let to = self.owner[self.unknown(panel, row)] as usize;
            self.reached[index] = row as u32;
            self.next[index] = std::mem::replace(&mut self.first[to], index as u32);
        }
    }
}

/// Product of two blocks; the upper triangle of the first rows is not needed.
fn multiply(
    place: MatMut<'_, f64>,
    accum: Accum,
    left: MatRef<'_, f64>,
    right: MatRef<'_, f64>,
    factor: f64,
) {
    let columns = right.ncols();
    let (square, rest) = place.split_at_row_mut(columns);
    let (top, bottom) = left.split_at_row(columns);
    use triangular::BlockStructure::{Rectangular, TriangularLower};
    triangular::matmul(
        square,
        TriangularLower,
        accum,
        top,
        Rectangular,
        right,
        Rectangular,
        factor,
        Par::Seq,
    );
    matmul(rest, accum, bottom, right, factor, Par::Seq);
}
