//! A run from start to end: steps, rows of the time series, and the last state that was sound.
//!
//! Without error control the step never changes on the way, and with it steps follow from the state,
//! from what the control remembers and from the time of the next row: either way a run that was
//! interrupted goes on with the same bits. Only the very last step is shortened to end at the end.

use crate::output::dynamics::recorder::{Recorder, RecorderError};
use crate::solver::channels::ChannelGroup;
use crate::solver::dynamics::checkpoint::Checkpoint;
use crate::solver::dynamics::model::DynamicProblem;
use crate::solver::dynamics::run::{RunOptions, Simulation, SimulationError, Stepping};
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

#[derive(Debug, Error)]
pub enum SessionError {
    #[error("the run ends at {0} s; it must be positive and finite")]
    End(f64),
    #[error("the output interval is {0} s; it must be positive and finite")]
    Interval(f64),
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
    /// Steps from one row to the next; zero with error control, where steps end at the rows' times.
    pub steps_per_row: u64,
    pub status: Status,
    /// Before the step that completed or failed, and the rows at that time.
    sound: Checkpoint,
    sound_rows: usize,
    failed: bool,
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
    /// No equilibrium to start from, no step, no time to simulate, more rows than fit in memory.
    pub fn start(problem: DynamicProblem, request: &RunRequest) -> Result<Session, SessionError> {
        if !(request.end > 0.0 && request.end.is_finite()) {
            return Err(SessionError::End(request.end));
        }
        let interval = request.output_interval;
        if !(interval > 0.0 && interval.is_finite()) {
            return Err(SessionError::Interval(interval));
        }
        let mut simulation = Simulation::new(problem, request.options)?;
        let steps = interval / simulation.step_size;
        let steps_per_row = match request.options.stepping {
            // A ratio that is whole but for rounding is whole.
            Stepping::FractionOfLimit(_) => {
                let steps = (steps * (1.0 - 1e-12)).ceil().max(1.0);
                simulation.step_size = interval / steps;
                steps
            }
            Stepping::Fixed(_) => steps.round().max(1.0),
            Stepping::Accuracy(_) => 0.0,
        };
        let mut session = Session::new(simulation, request, steps_per_row as u64)?;
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
        problem: DynamicProblem,
        request: &RunRequest,
        checkpoint: &Checkpoint,
        steps_per_row: u64,
    ) -> Result<Session, SessionError> {
        if !(request.end > 0.0 && request.end.is_finite()) {
            return Err(SessionError::End(request.end));
        }
        let simulation = Simulation::from_checkpoint(problem, request.options, checkpoint)?;
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
        let recorder = Recorder::new(&simulation.system.problem, &request.channels, rows)?;
        Ok(Session {
            sound: simulation.checkpoint(),
            sound_rows: 0,
            failed: false,
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
            if let Err(error) = self.step() {
                self.failed = true;
                return Err(error);
            }
        }
        Ok(self.status)
    }

    fn step(&mut self) -> Result<(), SimulationError> {
        let by_time = self.steps_per_row == 0;
        let row_time = self.recorder.rows() as f64 * self.output_interval;
        let mut step = self.simulation.step_size;
        if by_time {
            step = towards(step, row_time - self.simulation.time);
        }
        let left = self.end - self.simulation.time;
        // A last step that is whole but for rounding of the time is taken whole, so that no step
        // of nearly nothing follows it.
        if left <= step * (1.0 + 1e-6) {
            if self.simulation.step_by(left)? < left {
                return Ok(());
            }
            self.simulation.time = self.end;
            self.record()?;
            self.status = Status::Complete;
            return Ok(());
        }
        if by_time {
            let to_row = row_time - self.simulation.time;
            if self.simulation.step_by(step)? == to_row {
                self.simulation.time = row_time;
                self.record()?;
            }
            return Ok(());
        }
        self.simulation.step()?;
        if self.simulation.steps.is_multiple_of(self.steps_per_row) {
            self.record()?;
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
