//! Time series of a run: columns of all its parts, and the rows recorded so far.

mod bearing;
mod channels;
mod energy;
mod quasi_static;
mod rubber;
pub mod seat;
mod shaft;
mod solid;

pub use solid::{length, mean, probe_columns, sum};

use crate::assembly::lists::Assembly;
use crate::output::series::{Column, Series, SeriesError};
use crate::output::session::{Parts, SessionError};
use crate::plan::channels::ChannelGroup;
use crate::plan::counts::Counts;
use crate::scene::build::solid::{NamedNodes, Support};
use channels::BearingColumns;
use ndarray::Array2;

/// Rows of the time series, in memory; the memory for all rows is allocated at the start.
pub struct Recorder {
    columns: Vec<Column>,
    values: Vec<f64>,
    bearing: Option<BearingColumns>,
    /// Number of times each group of channels was recorded.
    pub ran: Counts,
    pub probes: Vec<NamedNodes>,
    pub supports: Vec<Support>,
}

impl Recorder {
    /// Columns of a run, without memory for rows.
    pub fn new(parts: &Parts, asked: &[ChannelGroup]) -> Recorder {
        let mut columns = vec![Column::new("time", "s")];
        let mut of_bearing =
            |assembly: &Assembly| BearingColumns::new(assembly, asked, &mut columns);
        let mut bearing = None;
        let (mut probes, mut supports) = (Vec::new(), Vec::new());
        match parts {
            Parts::Bearing(assembly) => bearing = Some(of_bearing(assembly)),
            Parts::Solid(parts) => {
                probes.clone_from(&parts.setup.probes);
                supports.clone_from(&parts.setup.supports);
                columns.extend(solid::columns(&probes, &supports));
            }
            Parts::Housed(parts) => {
                bearing = Some(of_bearing(&parts.assembly));
                columns.extend(seat::explicit_columns(parts));
            }
            Parts::QuasiStaticSequence(parts) => {
                let with_loads = asked.contains(&ChannelGroup::Loads);
                columns.extend(quasi_static::columns(&parts.problem, with_loads));
            }
            Parts::Rubber(parts) => {
                probes.clone_from(&parts.setup.probes);
                supports.clone_from(&parts.setup.supports);
                columns.extend(rubber::columns(&probes, &supports));
            }
        }
        let ran = Counts::default();
        Recorder { columns, values: Vec::new(), bearing, ran, probes, supports }
    }

    /// Allocates memory for `rows` rows.
    ///
    /// # Errors
    /// [`SessionError::Memory`].
    pub fn with_room(mut self, rows: usize) -> Result<Recorder, SessionError> {
        let columns = self.columns.len();
        let wanted = rows.checked_mul(columns);
        match wanted.map(|wanted| self.values.try_reserve_exact(wanted)) {
            Some(Ok(())) => Ok(self),
            _ => Err(SessionError::Memory { rows, columns }),
        }
    }

    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    pub fn rows(&self) -> usize {
        self.values.len() / self.columns.len()
    }

    pub fn capacity(&self) -> usize {
        self.values.capacity() / self.columns.len()
    }

    pub fn row(&self, row: usize) -> &[f64] {
        let width = self.columns.len();
        &self.values[row * width..(row + 1) * width]
    }

    /// The first `rows` rows as a table.
    ///
    /// # Errors
    /// Never for columns made by [`Recorder::new`].
    pub fn series(&self, rows: usize) -> Result<Series, SeriesError> {
        let width = self.columns.len();
        let values = self.values[..rows * width].to_vec();
        let data = Array2::from_shape_vec((rows, width), values)
            .expect("every row has one value a column");
        Series::new(self.columns.clone(), data)
    }

    /// Restores the first `rows` rows from a table of an earlier part of the run.
    ///
    /// Returns false if the table has other columns or fewer rows.
    pub fn restore(&mut self, series: &Series, rows: usize) -> bool {
        if series.columns() != self.columns || series.data().nrows() < rows {
            return false;
        }
        self.values.clear();
        for row in series.data().rows().into_iter().take(rows) {
            self.values.extend(row);
        }
        true
    }
}
