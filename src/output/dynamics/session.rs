//! A run from start to end: steps, rows of the time series, and the last state that was sound.
//!
//! With a fixed step the step does not change on the way but where loads or given motions have a
//! corner: steps end there, and the way from one row to the next is divided evenly between its
//! corners. A step that follows from the stability limit is shortened where the limit comes down to
//! it; what is left to the next row is divided evenly as well. With error control steps follow from the state, from what the control remembers and
//! from the time of the next row or corner. Either way the next step follows from what is kept, so
//! that a run that was interrupted goes on with the same bits. The very last step is shortened to
//! end at the end.

use crate::output::dynamics::recorder::{Recorder, RecorderError};
use crate::solver::channels::ChannelGroup;
use crate::solver::clock::to_digits;
use crate::solver::dynamics::assembly::Assembly;
use crate::solver::dynamics::checkpoint::Checkpoint;
use crate::solver::dynamics::model::next_corner;
use crate::solver::dynamics::run::{RunOptions, Simulation, SimulationError, Stepping};
use crate::solver::dynamics::step_watch::LOOK_EVERY;
use thiserror::Error;

/// What a run is asked for besides its problem.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRequest {
    pub options: RunOptions,
    /// s.
    pub end: f64,
    /// Wanted time between rows, s.
    pub output_interval: f64,
    pub channels: Vec<ChannelGroup>,
}

impl RunRequest {
    /// Rows a run has unless its scene says otherwise.
    const DEFAULT_ROWS: f64 = 1000.0;

    /// Whether `interval` may take the place of the wanted one: it is the same, or both follow
    /// from the end of their run (at `end`).
    pub fn accepts_interval(&self, interval: f64, end: f64) -> bool {
        let follows = |interval: f64, end: f64| interval == end / Self::DEFAULT_ROWS;
        interval == self.output_interval
            || (follows(interval, end) && follows(self.output_interval, self.end))
    }
}

/// Most values of a table: kept in memory, copied for the results and written twice.
const MOST_VALUES: f64 = 1e8;

/// How large the table of a run becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSize {
    pub rows: f64,
    pub columns: usize,
    /// Shortest output interval that is not refused, s.
    pub shortest: f64,
}

impl std::fmt::Display for TableSize {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let megabytes = 8e-6 * self.rows * self.columns as f64;
        let (size, unit) =
            if megabytes < 1e3 { (megabytes, "MB") } else { (1e-3 * megabytes, "GB") };
        let size = to_digits(size, 2);
        write!(f, "{} rows of {} channels make {size} {unit}", self.rows, self.columns)
    }
}

/// Rows and channels that a run is going to write.
///
/// # Errors
/// More than are taken.
pub fn table_size(assembly: &Assembly, request: &RunRequest) -> Result<TableSize, SessionError> {
    let columns = Recorder::new(assembly, &request.channels, 0)?.columns().len();
    let rows = (request.end / request.output_interval).ceil() + 1.0;
    let shortest = request.end * columns as f64 / MOST_VALUES;
    let size = TableSize { rows, columns, shortest };
    // NaN is too much.
    if rows * columns as f64 <= MOST_VALUES {
        Ok(size)
    } else {
        Err(SessionError::TooLarge { size })
    }
}

#[derive(Debug, Error)]
pub enum SessionError {
    #[error("the run ends at {0} s; it must be positive and finite")]
    End(f64),
    #[error("the output interval is {0} s; it must be positive and finite")]
    Interval(f64),
    #[error(
        "{size}, more than {most} GB: take a longer numerics.output_interval ({interval:.1e} s would do), a shorter \
         numerics.end, or fewer output.channels",
        most = 8e-9 * MOST_VALUES,
        interval = size.shortest
    )]
    TooLarge { size: TableSize },
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Recorder(#[from] RecorderError),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Running,
    /// At the end, with the last row recorded.
    Complete,
}

pub struct Session {
    pub simulation: Simulation,
    pub recorder: Recorder,
    pub end: f64,
    /// Steps from one row to the next, of the present size; zero with error control, where steps
    /// end at the rows' times.
    pub steps_per_row: u64,
    pub status: Status,
    /// Before the step that completed or failed, and the rows at that time.
    sound: Checkpoint,
    sound_rows: usize,
    failed: bool,
    /// Times of corners; see [`Assembly::corners`].
    corners: Vec<f64>,
    /// Time between rows as asked for, s.
    output_interval: f64,
}

impl Session {
    /// Starts a run and records its first row.
    ///
    /// A step that follows from the stability limit is shortened so that a whole number of steps
    /// makes an output interval; with a given step the interval is rounded to whole steps.
    ///
    /// # Errors
    /// No equilibrium to start from, no step or one that is too long, no time to simulate, more rows than fit in memory.
    pub fn start(
        assembly: impl Into<Assembly>,
        request: &RunRequest,
    ) -> Result<Session, SessionError> {
        if !(request.end > 0.0 && request.end.is_finite()) {
            return Err(SessionError::End(request.end));
        }
        let interval = request.output_interval;
        if !(interval > 0.0 && interval.is_finite()) {
            return Err(SessionError::Interval(interval));
        }
        let assembly = assembly.into();
        table_size(&assembly, request)?;
        let mut simulation = Simulation::new(assembly, request.options)?;
        let steps_per_row = match request.options.stepping {
            Stepping::FractionOfLimit(_) => {
                let steps = whole_steps(interval, simulation.step_size);
                simulation.step_size = interval / steps as f64;
                steps
            }
            Stepping::Fixed(step) => {
                simulation.judge_step_now()?;
                (interval / step).round().max(1.0) as u64
            }
            Stepping::Accuracy(_) => 0,
        };
        let mut session = Session::new(simulation, request, steps_per_row)?;
        session.record()?;
        Ok(session)
    }

    /// Goes on from a checkpoint; the caller restores the rows.
    ///
    /// # Errors
    /// As [`Session::start`].
    ///
    /// # Panics
    /// If the checkpoint does not [fit](Checkpoint::fits) the problem.
    pub fn from_checkpoint(
        assembly: impl Into<Assembly>,
        request: &RunRequest,
        checkpoint: &Checkpoint,
        steps_per_row: u64,
    ) -> Result<Session, SessionError> {
        if !(request.end > 0.0 && request.end.is_finite()) {
            return Err(SessionError::End(request.end));
        }
        let simulation = Simulation::from_checkpoint(assembly, request.options, checkpoint)?;
        Session::new(simulation, request, steps_per_row)
    }

    fn new(
        simulation: Simulation,
        request: &RunRequest,
        steps_per_row: u64,
    ) -> Result<Session, SessionError> {
        let interval = match steps_per_row {
            0 => request.output_interval,
            steps => steps as f64 * simulation.step_size,
        };
        // The first row, the last one off the grid, and one for rounding.
        let rows = (request.end / interval) as usize + 3;
        let recorder = Recorder::new(&simulation.system.assembly, &request.channels, rows)?;
        Ok(Session {
            sound: simulation.checkpoint(),
            sound_rows: 0,
            failed: false,
            corners: simulation.system.assembly.corners(),
            output_interval: request.output_interval,
            recorder,
            end: request.end,
            steps_per_row,
            status: Status::Running,
            simulation,
        })
    }

    /// Time between rows, s.
    pub fn interval(&self) -> f64 {
        match self.steps_per_row {
            0 => self.output_interval,
            steps => steps as f64 * self.simulation.step_size,
        }
    }

    /// At most `steps` steps.
    ///
    /// # Errors
    /// What the simulation's watchdog finds; [`Session::resumable`] then is the state before.
    pub fn advance(&mut self, steps: u64) -> Result<Status, SimulationError> {
        for _ in 0..steps {
            if self.status == Status::Complete {
                break;
            }
            self.simulation.checkpoint_into(&mut self.sound);
            self.sound_rows = self.recorder.rows();
            if let Err(error) = self.step().and_then(|()| self.watch()) {
                self.failed = true;
                return Err(error);
            }
        }
        Ok(self.status)
    }

    /// The step against what the contacts have become, every few steps.
    fn watch(&mut self) -> Result<(), SimulationError> {
        if !self.simulation.steps.is_multiple_of(LOOK_EVERY) {
            return Ok(());
        }
        let shorter = self.simulation.watch_step()?;
        // A complete run goes on, if at all, from before its last step.
        if let Some(step) = shorter.filter(|_| self.status == Status::Running) {
            self.steps_per_row = whole_steps(self.output_interval, step);
            self.simulation.shorten_step(self.output_interval / self.steps_per_row as f64);
        }
        Ok(())
    }

    /// Time of the last row, s.
    fn row_start(&self) -> f64 {
        self.recorder.rows().checked_sub(1).map_or(0.0, |last| self.recorder.row(last)[0])
    }

    fn step(&mut self) -> Result<(), SimulationError> {
        if self.steps_per_row == 0 {
            return self.controlled_step();
        }
        let step = self.simulation.step_size;
        let row_start = self.row_start();
        let row_end = row_start + self.interval();
        // Rounding of times is far below this, and nobody means a step so short.
        let slack = 1e-6 * step;
        let corner = next_corner(&self.corners, row_start);
        // A row in which the step was shortened is no whole number of steps.
        let was_shortened = self.simulation.step_watch.shortened.is_some();
        if was_shortened || corner.is_some_and(|corner| corner <= row_end + slack) {
            return self.step_to_stop(row_end, slack);
        }
        let left = self.end - self.simulation.time;
        // A last step that is whole but for rounding of the time is taken whole, so that no step
        // of nearly nothing follows it.
        if left <= step * (1.0 + 1e-6) {
            self.simulation.step_by(left)?;
            self.simulation.time = self.end;
            self.record()?;
            self.status = Status::Complete;
            return Ok(());
        }
        self.simulation.step()?;
        let taken = ((self.simulation.time - row_start) / step).round();
        if taken as u64 == self.steps_per_row {
            self.record()?;
        }
        Ok(())
    }

    /// A step whose size follows from the error, on the way to the next row, corner or the end.
    fn controlled_step(&mut self) -> Result<(), SimulationError> {
        let simulation = &mut self.simulation;
        let time = simulation.time;
        // Rows by count, so that rounding does not add up.
        let row_time = self.recorder.rows() as f64 * self.output_interval;
        // Nobody means a step so short.
        let slack = 1e-9 * self.output_interval;
        let corner = next_corner(&self.corners, time).filter(|corner| *corner <= row_time + slack);
        // Never before the corner, or it would be there to cross again.
        let at_row =
            |corner: f64| if corner >= row_time - slack { row_time.max(corner) } else { corner };
        let mut stop = corner.map_or(row_time, at_row);
        let mut left = stop - time;
        let mut step = towards(simulation.step_size, left);
        // The end changes the last step only, so that a run can be extended with the same bits.
        let completes = self.end - time <= step * (1.0 + 1e-6);
        if completes {
            stop = self.end;
            left = stop - time;
            step = left;
        }
        let crossed = corner.filter(|corner| step == left && *corner <= stop + slack);
        if let Some(corner) = crossed {
            simulation.system.latest = corner.next_down();
        }
        let taken = simulation.step_by(step);
        if !matches!(taken, Ok(taken) if taken == left) {
            simulation.system.latest = f64::INFINITY;
            return taken.map(|_| ());
        }
        simulation.time = stop;
        if let Some(corner) = crossed {
            simulation.cross_corner(corner);
        }
        if completes || stop >= row_time {
            self.record()?;
        }
        if completes {
            self.status = Status::Complete;
        }
        Ok(())
    }

    /// A step on the way to a corner or a row: an equal part of what is left, whatever the end of
    /// the run is.
    fn step_to_stop(&mut self, row_end: f64, slack: f64) -> Result<(), SimulationError> {
        let simulation = &mut self.simulation;
        let time = simulation.time;
        let corner = next_corner(&self.corners, time).filter(|corner| *corner <= row_end + slack);
        let stop = corner.unwrap_or(row_end);
        let left = stop - time;
        let steps = (left / simulation.step_size * (1.0 - 1e-9)).ceil().max(1.0);
        let size = left / steps;
        let completes = self.end - time <= size * (1.0 + 1e-6);
        let stop = if completes { self.end } else { stop };
        if steps > 1.0 && !completes {
            return simulation.step_by(size).map(|_| ());
        }
        let crossed = corner.filter(|corner| *corner <= stop + slack);
        if let Some(corner) = crossed {
            simulation.system.latest = corner.next_down();
        }
        simulation.step_by(stop - time)?;
        simulation.time = stop;
        if let Some(corner) = crossed {
            simulation.cross_corner(corner);
        }
        if completes || stop >= row_end - slack {
            self.record()?;
        }
        if completes {
            self.status = Status::Complete;
        }
        Ok(())
    }

    fn record(&mut self) -> Result<(), SimulationError> {
        let snapshot = self.simulation.snapshot()?;
        self.recorder.record(&self.simulation, &snapshot);
        Ok(())
    }

    /// What a later run goes on from, and the rows that belong to it: the present state of a run
    /// under way; of a completed one the state before its shortened last step, so that it can be
    /// extended; of a failed one the state before the step that failed.
    pub fn resumable(&self) -> (Checkpoint, usize) {
        if self.status == Status::Complete || self.failed {
            (self.sound.clone(), self.sound_rows)
        } else {
            (self.simulation.checkpoint(), self.recorder.rows())
        }
    }

    /// Rows at equal intervals: all but a last one that the end of the run has put off the grid.
    pub fn rows_on_grid(&self) -> usize {
        let rows = self.recorder.rows();
        if rows < 2 {
            return rows;
        }
        let last = self.recorder.row(rows - 1)[0] - self.recorder.row(rows - 2)[0];
        let slack = if self.steps_per_row == 0 { last } else { self.simulation.step_size };
        let whole = (last - self.interval()).abs() <= 1e-3 * slack;
        if whole { rows } else { rows - 1 }
    }
}

/// Steps that a run with a given step takes, as [`Session`] takes them: rows of whole steps, the way to
/// the next row divided evenly between its corners, a last step that ends at the end.
pub fn given_steps(assembly: &Assembly, request: &RunRequest, step: f64) -> u64 {
    let interval = (request.output_interval / step).round().max(1.0) * step;
    let corners = assembly.corners();
    let slack = 1e-6 * step;
    // Steps of about `step` to a time that is `left` away, and the last of a run.
    let to_stop = |left: f64| (left / step * (1.0 - 1e-9)).ceil().max(1.0);
    let mut steps = 0.0;
    let mut row = 0.0;
    loop {
        let row_end = row + interval;
        let has_corner =
            |from: f64| next_corner(&corners, from).filter(|corner| *corner <= row_end + slack);
        let Some(mut corner) = has_corner(row) else {
            let left = request.end - row;
            if left <= interval + slack {
                return (steps + (left / step - 1e-6).ceil().max(1.0)) as u64;
            }
            // Rows without a corner in one go.
            let next = next_corner(&corners, row).unwrap_or(f64::INFINITY).min(request.end);
            let rows = ((next - row - slack) / interval).floor().max(1.0);
            steps += rows * (interval / step).round();
            row += rows * interval;
            continue;
        };
        let mut time = row;
        loop {
            let count = to_stop(corner - time);
            let size = (corner - time) / count;
            if request.end <= corner + 1e-6 * size {
                return (steps + ((request.end - time) / size - 1e-6).ceil().max(1.0)) as u64;
            }
            steps += count;
            time = corner;
            if time >= row_end - slack {
                break;
            }
            corner = has_corner(time).unwrap_or(row_end);
        }
        row = time;
    }
}

/// Steps no longer than `step` that make an interval.
pub fn whole_steps(interval: f64, step: f64) -> u64 {
    // A ratio that is whole but for rounding is whole.
    (interval / step * (1.0 - 1e-12)).ceil().max(1.0) as u64
}

/// A step no longer than `step` on the way to a row that is `left` away: there if it can be
/// reached, half of the way if it could be reached in two, so that no tiny step comes last.
fn towards(step: f64, left: f64) -> f64 {
    if left <= step * (1.0 + 1e-6) {
        left
    } else if left < 2.0 * step {
        0.5 * left
    } else {
        step
    }
}
