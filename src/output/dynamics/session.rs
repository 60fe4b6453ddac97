//! A run from start to end: steps by its clock, rows of the time series, and the last state that was
//! sound.

use crate::output::dynamics::recorder::{Recorder, RecorderError};
use crate::output::series::Series;
use crate::solver::clock::Clock;
use crate::solver::dynamics::checkpoint::Checkpoint;
use crate::solver::dynamics::clocked;
use crate::solver::dynamics::model::DynamicProblem;
use crate::solver::dynamics::run::{Simulation, SimulationError};
use thiserror::Error;

pub use crate::solver::dynamics::clocked::RunRequest;

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
    pub clock: Clock,
    pub status: Status,
    /// Before the step that completed or failed, and the rows at that time.
    sound: Checkpoint,
    sound_rows: usize,
    failed: bool,
}

impl Session {
    /// Starts a run and records its first row.
    ///
    /// # Errors
    /// No equilibrium to start from, no step or one that is too long, no time to simulate, more rows than fit in memory.
    pub fn start(problem: DynamicProblem, request: &RunRequest) -> Result<Session, SessionError> {
        check(request)?;
        let (simulation, clock) = clocked::start(problem, request)?;
        let mut session = Session::new(simulation, clock, request)?;
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
        check(request)?;
        let simulation = Simulation::from_checkpoint(problem, request.options, checkpoint)?;
        let clock = Clock {
            end: request.end,
            interval: request.output_interval,
            step: if steps_per_row == 0 { 0.0 } else { simulation.step_size },
            steps_per_row,
            corners: simulation.system.problem.corners(),
            shortened: simulation.step_watch.shortened.is_some(),
            ..Clock::default()
        };
        Session::new(simulation, clock, request)
    }

    fn new(
        simulation: Simulation,
        clock: Clock,
        request: &RunRequest,
    ) -> Result<Session, SessionError> {
        // The first row, the last one off the grid, and one for rounding.
        let rows = (request.end / clock.row_interval()) as usize + 3;
        let recorder = Recorder::new(&simulation.system.problem, &request.channels, rows)?;
        Ok(Session {
            sound: simulation.checkpoint(),
            sound_rows: 0,
            failed: false,
            recorder,
            clock,
            status: Status::Running,
            simulation,
        })
    }

    /// Takes over the first `rows` rows of a table that an earlier part of the run left.
    ///
    /// Returns whether the table has these columns and as many rows.
    pub fn restore_rows(&mut self, series: &Series, rows: usize) -> bool {
        let fits = self.recorder.restore(series, rows);
        if fits && rows > 0 {
            self.clock.rows = rows as u64;
            self.clock.row_time = self.recorder.row(rows - 1)[0];
        }
        fits
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
        let arrival = clocked::step(&mut self.simulation, &self.clock)?;
        if arrival.row {
            self.record()?;
        }
        if arrival.completes {
            self.status = Status::Complete;
        }
        clocked::watch(&mut self.simulation, &mut self.clock, arrival.completes)
    }

    fn record(&mut self) -> Result<(), SimulationError> {
        let snapshot = self.simulation.snapshot()?;
        self.recorder.record(&self.simulation, &snapshot);
        self.clock.count_row(self.simulation.time);
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
        let slack = if self.clock.steps_per_row == 0 { last } else { self.clock.step };
        let whole = (last - self.clock.row_interval()).abs() <= 1e-3 * slack;
        if whole { rows } else { rows - 1 }
    }
}

fn check(request: &RunRequest) -> Result<(), SessionError> {
    if !(request.end > 0.0 && request.end.is_finite()) {
        return Err(SessionError::End(request.end));
    }
    let interval = request.output_interval;
    if !(interval > 0.0 && interval.is_finite()) {
        return Err(SessionError::Interval(interval));
    }
    Ok(())
}
