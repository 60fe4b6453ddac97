//! A run of bearing and housing in explicit steps: windows, rows of the time series, the last sound
//! state.
//!
//! Windows and rows never change on the way, and a run ends at a row, so that one that was
//! interrupted, or is extended, goes on with the same bits. What it goes on from is its last row.

use crate::kinematics::vec3::{Vec3, dot};
use crate::output::dynamics::recorder::{Recorder, RecorderError};
use crate::output::housed::fields::BoreNodeState;
use crate::output::housed::rows::{SeatRow, seat_columns};
use crate::output::series::{Column, Series, SeriesError};
use crate::solver::channels::ChannelGroup;
use crate::solver::clock::rounded;
use crate::solver::dynamics::state::Ledger;
use crate::solver::housing::checkpoint::HousedCheckpoint;
use crate::solver::housing::exchange::{ExchangeError, HousedBearing};
use crate::solver::solid::model::SolidError;
use crate::solver::solid::stress::first_inverted;
use ndarray::Array2;
use thiserror::Error;

#[derive(Debug, Error)]
pub enum HousedRunError {
    #[error(transparent)]
    Exchange(#[from] ExchangeError),
    #[error(transparent)]
    Housing(#[from] SolidError),
    #[error(
        "{residual:.3e} J of bearing and housing are unaccounted for at t = {at} s, window {window}, \
         more than {limit} of the {turned_over:.3e} J turned over; take shorter steps \
         (housing.step_fraction, housing.window_phase, numerics.step)", at = rounded(*time)
    )]
    Energy { residual: f64, turned_over: f64, limit: f64, time: f64, window: u64 },
    #[error(transparent)]
    Recorder(#[from] RecorderError),
    #[error(transparent)]
    Series(#[from] SeriesError),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    Running,
    /// File of fields number so and so is due at the present state.
    Fields(usize),
    Complete,
}

/// The grid of windows, rows and files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowGrid {
    pub windows_per_row: u64,
    /// Rows after the first.
    pub rows: u64,
    /// Rows from one file of fields to the next.
    pub rows_per_fields: u64,
}

/// What the ledger knows at a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Watch {
    /// Largest energy held or exchanged so far, J.
    pub turned_over: f64,
    /// Largest energy unaccounted for so far, J.
    pub largest_residual: f64,
    /// Rows on end whose ledger did not close.
    pub rows_open: u32,
}

/// A ledger that does not close at this many rows on end fails a run; see the solids'.
const MOST_ROWS_OPEN: u32 = 5;

pub struct HousedSession {
    pub housed: HousedBearing,
    pub grid: RowGrid,
    pub energy_limit: f64,
    pub watch: Watch,
    recorder: Recorder,
    /// Columns of the housing, row after row.
    columns: Vec<Column>,
    values: Vec<f64>,
    sound: HousedCheckpoint,
    sound_watch: Watch,
}

impl HousedSession {
    /// Records the first row.
    ///
    /// # Errors
    /// More rows than fit in memory, a start that is not sound.
    pub fn start(
        housed: HousedBearing,
        grid: RowGrid,
        channels: &[ChannelGroup],
        energy_limit: f64,
    ) -> Result<HousedSession, HousedRunError> {
        let mut session = HousedSession::new(housed, grid, channels, energy_limit)?;
        session.record()?;
        session.keep();
        Ok(session)
    }

    /// Goes on from a row; `None` if `series` does not hold the rows of this run.
    ///
    /// # Errors
    /// More rows than fit in memory.
    pub fn resume(
        housed: HousedBearing,
        grid: RowGrid,
        channels: &[ChannelGroup],
        energy_limit: f64,
        watch: Watch,
        series: &Series,
    ) -> Result<Option<HousedSession>, HousedRunError> {
        let mut session = HousedSession::new(housed, grid, channels, energy_limit)?;
        let rows = (session.housed.exchanges / grid.windows_per_row) as usize + 1;
        let of_bearing = session.recorder.columns().len();
        let all: Vec<&Column> = session.recorder.columns().iter().chain(&session.columns).collect();
        let fits = series.columns().iter().eq(all) && series.data().nrows() >= rows;
        if !fits {
            return Ok(None);
        }
        let data = series.data();
        let data = Array2::from_shape_fn((rows, of_bearing), |at| data[at]);
        let bearing = Series::new(series.columns()[..of_bearing].to_vec(), data)?;
        session.recorder.restore(&bearing, rows);
        for row in series.data().rows().into_iter().take(rows) {
            session.values.extend(row.iter().skip(of_bearing));
        }
        session.watch = watch;
        session.keep_without_sorting();
        Ok(Some(session))
    }

    fn new(
        housed: HousedBearing,
        grid: RowGrid,
        channels: &[ChannelGroup],
        energy_limit: f64,
    ) -> Result<HousedSession, HousedRunError> {
        let rows = grid.rows as usize + 2;
        let recorder = Recorder::new(&housed.bearing.system.assembly, channels, rows)?;
        Ok(HousedSession {
            housed,
            grid,
            energy_limit,
            watch: Watch::default(),
            recorder,
            columns: columns(),
            values: Vec::new(),
            sound: HousedCheckpoint::default(),
            sound_watch: Watch::default(),
        })
    }

    /// Time between rows, s.
    pub fn interval(&self) -> f64 {
        self.grid.windows_per_row as f64 * self.housed.window
    }

    pub fn rows(&self) -> usize {
        self.recorder.rows()
    }

    /// Windows of the whole run.
    pub fn windows(&self) -> u64 {
        self.grid.rows * self.grid.windows_per_row
    }

    pub fn is_complete(&self) -> bool {
        self.housed.exchanges >= self.windows()
    }

    /// At most `windows` windows, fewer where fields are due or the end comes.
    ///
    /// # Errors
    /// What ends bearing or housing; [`HousedSession::kept`] then is the state at the last row.
    pub fn advance(&mut self, windows: u64) -> Result<Progress, HousedRunError> {
        for _ in 0..windows {
            if self.is_complete() {
                return Ok(Progress::Complete);
            }
            self.housed.exchange()?;
            if !self.housed.exchanges.is_multiple_of(self.grid.windows_per_row) {
                continue;
            }
            let shorter = self.housed.bearing.watch_step().map_err(ExchangeError::from)?;
            if let Some(step) = shorter {
                self.housed.bearing.shorten_step(step);
            }
            self.record()?;
            self.keep();
            let row = self.housed.exchanges / self.grid.windows_per_row;
            if row.is_multiple_of(self.grid.rows_per_fields) {
                return Ok(Progress::Fields((row / self.grid.rows_per_fields) as usize));
            }
        }
        Ok(Progress::Running)
    }

    fn record(&mut self) -> Result<(), HousedRunError> {
        let (time, window) = (self.housed.time(), self.housed.exchanges);
        let displacement = self.displacement();
        if let Some(node) = displacement.iter().position(|u| !u.iter().all(|x| x.is_finite())) {
            return Err(self.housed.solid.model.not_finite(node, time, window).into());
        }
        if let Some((element, ratio)) = first_inverted(&self.housed.solid.model, &displacement) {
            return Err(self.housed.solid.model.inverted(element, ratio, time, window).into());
        }
        let snapshot = self.housed.snapshot()?;
        let residual = snapshot.residual;
        let watch = &mut self.watch;
        watch.turned_over = watch.turned_over.max(snapshot.turned_over);
        watch.largest_residual = watch.largest_residual.max(residual.abs());
        let closes = residual.abs() <= self.energy_limit * watch.turned_over;
        watch.rows_open = if closes { 0 } else { watch.rows_open + 1 };
        // Written as it is so that a residual that is not a number is refused as well.
        let sound = watch.rows_open < MOST_ROWS_OPEN && residual.is_finite();
        if !sound {
            let (turned_over, limit) = (watch.turned_over, self.energy_limit);
            return Err(HousedRunError::Energy { residual, turned_over, limit, time, window });
        }
        self.recorder.record(&self.housed.bearing, &snapshot.bearing);
        let solid = &snapshot.solid;
        self.values.extend(SeatRow::of_contact(&snapshot.contact).values());
        self.values.extend([
            solid.energy.strain,
            solid.energy.kinetic,
            snapshot.contact.energy,
            snapshot.bearing.ledger[Ledger::Foundation as usize],
            solid.external_work,
            solid.damping_work,
            snapshot.growth_work,
            residual,
        ]);
        self.values.extend(self.housed.impulse);
        Ok(())
    }

    fn keep(&mut self) {
        self.housed.checkpoint_into(&mut self.sound);
        self.sound_watch = self.watch;
    }

    /// After a restart, whose nodes are as sorted as they were.
    fn keep_without_sorting(&mut self) {
        let sorts = self.housed.sorts;
        self.keep();
        self.housed.sorts = sorts;
        self.sound.sorts = sorts;
    }

    /// What a later run goes on from: the last row.
    pub fn kept(&self) -> (&HousedCheckpoint, Watch) {
        (&self.sound, self.sound_watch)
    }

    /// Rows that belong to the state that is kept.
    pub fn kept_rows(&self) -> usize {
        (self.sound.exchanges / self.grid.windows_per_row) as usize + 1
    }

    /// Displacements of the housing, m: half a step of its own ahead of the bearing's time.
    pub fn displacement(&self) -> Vec<Vec3> {
        self.housed.solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect()
    }

    /// Nodes of the bore that touch.
    pub fn bore_nodes(&self) -> Vec<BoreNodeState> {
        let penalty = self.housed.seat.penalty;
        let state = |(node, force): (crate::ch2_housing::bore_contact::ContactNode, Vec3)| {
            let load = dot(force, force).sqrt();
            BoreNodeState {
                node: node.node,
                place: node.place,
                area: node.area,
                penetration: load / penalty.of_node(node.area),
                force,
            }
        };
        self.housed.nodal_forces().into_iter().map(state).collect()
    }

    /// All rows as a table.
    ///
    /// # Errors
    /// Never for these columns.
    pub fn series(&self) -> Result<Series, SeriesError> {
        let rows = self.rows().min(self.values.len() / self.columns.len());
        let bearing = self.recorder.series(rows)?;
        let width = self.columns.len();
        let own = Array2::from_shape_vec((rows, width), self.values[..rows * width].to_vec())
            .expect("every row gives one value per column");
        let data = ndarray::concatenate![ndarray::Axis(1), *bearing.data(), own];
        let columns = bearing.columns().iter().chain(&self.columns).cloned().collect();
        Series::new(columns, data)
    }
}

fn columns() -> Vec<Column> {
    let mut columns = seat_columns();
    for name in [
        "energy_housing_strain",
        "energy_housing_kinetic",
        "energy_seat",
        "work_housing_on_outer",
        "work_on_housing",
        "work_housing_damping",
        "work_fit",
        "energy_coupled_residual",
    ] {
        columns.push(Column::new(name, "J"));
    }
    columns.extend(
        ["x", "y", "z"].map(|a| Column::new(format!("housing_impulse_on_outer_{a}"), "N s")),
    );
    columns
}
