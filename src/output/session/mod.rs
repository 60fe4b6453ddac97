//! Execution of a run: time stepping by a clock, rows of the time series, energy balance, and the last valid state for a
//! restart.

pub mod motion;
pub mod rubber;
pub mod size;

pub use crate::assembly::ledger_watch::LedgerWatch;
pub use crate::motion::clocked::RunRequest;
pub use motion::{Checkpoint, HousedParts, Motion, Parts, SequenceParts, SolidParts};
pub use rubber::{MovingRubber, RubberParts};
pub use size::{TableSize, table_size};

use crate::equilibrium::quasi_static_sequence::QuasiStaticError;
use crate::kinematics::vec3::Vec3;
use crate::motion::clocked;
use crate::motion::coupling::CouplingError;
use crate::motion::simulation::SimulationError;
use crate::numeric::clock::{Clock, rounded};
use crate::output::recorder::Recorder;
use crate::output::series::{Series, SeriesError};
use crate::output::table::readable;
use crate::plan::counts::{Counts, StageCounts};
use crate::solids::bore_equilibrium::BoreError;
use crate::solids::error::SolidError;
use crate::solids::explicit::ExplicitSolid;
use serde::{Deserialize, Serialize};
use thiserror::Error;

#[derive(Debug, Error)]
pub enum SessionError {
    #[error("the run ends at {0} s; it must be positive and finite")]
    End(f64),
    #[error("the output interval is {0} s; it must be positive and finite")]
    Interval(f64),
    #[error(
        "{size}, more than {most} GB: use a longer numerics.output_interval ({interval:.1e} s is enough), a shorter \
         numerics.end, or fewer output.channels",
        most = 8e-9 * size::MOST_VALUES,
        interval = size.shortest
    )]
    TooLarge { size: TableSize },
    #[error(
        "two columns would have the name {0:?}: rename the bodies, bearings, springs or positions concerned"
    )]
    SharedColumn(String),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Solid(#[from] SolidError),
    #[error(transparent)]
    CoupledMotion(#[from] CouplingError),
    #[error(transparent)]
    QuasiStaticSequence(#[from] QuasiStaticError),
    #[error(transparent)]
    Bore(#[from] BoreError),
    #[error(
        "{residual:.3e} J are unaccounted for at t = {} s, step {step}, more than {limit} of \
         the {turned_over:.3e} J exchanged; take a smaller step",
        rounded(*time)
    )]
    Energy { residual: f64, turned_over: f64, limit: f64, time: f64, step: u64 },
    #[error(
        "{residual:.3e} J of bearing and housing or bushings are unaccounted for at t = {at} s, coupling step {coupling_step}, \
         more than {limit} of the {turned_over:.3e} J exchanged; take shorter steps \
         (step_fraction and coupling_phase of [housing] or of the bushing, numerics.step)", at = rounded(*time)
    )]
    EnergyOfBoth { residual: f64, turned_over: f64, limit: f64, time: f64, coupling_step: u64 },
    #[error(
        "{rows} rows of {columns} channels do not fit in memory; use a longer output interval or \
         fewer channels"
    )]
    Memory { rows: usize, columns: usize },
    #[error("the state belongs to another kind of run")]
    OtherKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Running,
    /// Field file with this number is due at the present state.
    Fields(u64),
    /// The end is reached and the last row is recorded.
    Complete,
}

pub struct Session<'p> {
    pub motion: Motion<'p>,
    pub clock: Clock,
    pub recorder: Recorder,
    pub watch: LedgerWatch,
    /// Largest energy residual of a run with a solid, as a fraction of the energy exchanged.
    pub energy_limit: f64,
    pub status: Status,
    /// Number of executions of each stage before this session.
    before: StageCounts,
    /// Execution counts of the motion and of the recorder at the time of `sound`.
    kept_ran: (StageCounts, Counts),
    sound: Sound,
    failed: bool,
}

/// State from which a later run resumes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sound {
    pub checkpoint: Checkpoint,
    pub watch: LedgerWatch,
    pub rows: usize,
    /// Number of executions of each stage up to this state.
    pub ran: StageCounts,
}

impl<'p> Session<'p> {
    /// Starts a run and records its first row; the first row of a quasi-static sequence is computed later.
    ///
    /// # Errors
    /// No initial equilibrium, no valid time step, a zero duration, more rows than fit in memory.
    pub fn start(
        parts: impl Into<Parts<'p>>,
        request: &RunRequest,
    ) -> Result<Session<'p>, SessionError> {
        check(request)?;
        let parts = parts.into();
        let columns = Recorder::new(&parts, &request.channels);
        size::size_of(&columns, request)?;
        let (motion, clock) = Motion::start(parts, request)?;
        let recorder = columns.with_room(clock.rows_in_all())?;
        let sound = Sound {
            checkpoint: motion.empty_checkpoint(),
            watch: LedgerWatch::default(),
            rows: 0,
            ran: StageCounts::default(),
        };
        let mut session = Session::new(motion, clock, recorder, sound, request);
        if let Motion::Solid(moving) = &mut session.motion {
            session.watch.first = moving.solid.ledger().balance();
        }
        if !matches!(session.motion, Motion::QuasiStaticSequence(_)) {
            session.record(false)?;
            session.keep();
        }
        Ok(session)
    }

    /// Resumes from a valid state, whose rows are in `series`, with the `clock` of the stored run; `None` if
    /// the rows do not belong to this run.
    ///
    /// # Errors
    /// As [`Session::start`].
    ///
    /// # Panics
    /// If the checkpoint has another number of balls or nodes.
    pub fn resume(
        parts: impl Into<Parts<'p>>,
        request: &RunRequest,
        mut clock: Clock,
        sound: Sound,
        series: &Series,
    ) -> Result<Option<Session<'p>>, SessionError> {
        check(request)?;
        let parts = parts.into();
        let columns = Recorder::new(&parts, &request.channels);
        let mut motion = Motion::resume(parts, request, &sound.checkpoint, &mut clock)?;
        motion.forget_ran();
        let mut recorder = columns.with_room(clock.rows_in_all())?;
        if !recorder.restore(series, sound.rows) {
            return Ok(None);
        }
        if let Some(last) = sound.rows.checked_sub(1) {
            clock.rows = sound.rows as u64;
            clock.row_time = recorder.row(last)[0];
        }
        let mut session = Session::new(motion, clock, recorder, sound, request);
        let done = session.motion.done();
        if session.clock.last.is_some_and(|last| done >= last) {
            session.status = Status::Complete;
            if !session.clock.is_on_grid(done) {
                session.record(false)?;
            }
        }
        Ok(Some(session))
    }

    fn new(
        motion: Motion<'p>,
        clock: Clock,
        recorder: Recorder,
        sound: Sound,
        request: &RunRequest,
    ) -> Session<'p> {
        Session {
            motion,
            clock,
            recorder,
            watch: sound.watch,
            before: sound.ran.clone(),
            kept_ran: Default::default(),
            energy_limit: request.options.energy_limit,
            status: Status::Running,
            sound,
            failed: false,
        }
    }

    /// Advances by at most `steps` steps, coupling steps or equilibria; stops early when fields are due or at the end.
    ///
    /// # Errors
    /// A failed step, or an energy balance that does not close; [`Session::resumable`] then returns the last valid state.
    pub fn advance(&mut self, steps: u64) -> Result<Status, SessionError> {
        let target = self.motion.done() + steps;
        while self.status != Status::Complete && self.motion.done() < target {
            let rows = self.clock.rows;
            let moved = self.advance_to_next_event(target - self.motion.done());
            if moved.is_err() {
                self.failed = true;
                // Discard the invalid state that a failed step leaves in a solid.
                match (&mut self.motion, &self.sound.checkpoint) {
                    (Motion::Solid(moving), Checkpoint::Solid(kept, _)) => {
                        moving.solid.restore(kept);
                    }
                    // This restore succeeded before with the same state.
                    (Motion::Rubber(moving), Checkpoint::Rubber(kept, rows)) => {
                        let _ = moving.restore(kept, *rows);
                    }
                    _ => {}
                }
            }
            moved?;
            if let Some(index) = self.clock.fields_due()
                && self.clock.rows > rows
                && (matches!(self.motion, Motion::Bearing(_))
                    || self.clock.is_on_grid(self.motion.done()))
            {
                return Ok(Status::Fields(index));
            }
        }
        Ok(self.status)
    }

    /// Advances to the next row, the end, or by at most `most` steps.
    fn advance_to_next_event(&mut self, most: u64) -> Result<(), SessionError> {
        // A bearing resumes from the state before a failed step or a step shortened by the end, and a quasi-static sequence
        // from before its last equilibrium, which is then computed again; other runs resume from their rows.
        let keeps_rows =
            matches!(self.motion, Motion::Solid(_) | Motion::Housed(_) | Motion::Rubber(_));
        if !keeps_rows {
            self.keep();
        }
        let arrival = self.motion.advance(&mut self.clock, most)?;
        if arrival.row {
            let on_grid = keeps_rows && self.clock.is_on_grid(self.motion.done());
            if keeps_rows && !on_grid {
                // A longer run has no row at this time: it resumes from the state before.
                self.keep();
            }
            self.record(arrival.completes)?;
            if on_grid {
                self.keep();
            }
        }
        if arrival.completes {
            self.status = Status::Complete;
        }
        if let Motion::Bearing(simulation) = &mut self.motion {
            clocked::watch(simulation, &mut self.clock, arrival.completes)?;
        }
        Ok(())
    }

    fn record(&mut self, completes: bool) -> Result<(), SessionError> {
        let Session { motion, recorder, watch, energy_limit, .. } = self;
        match motion {
            Motion::Bearing(simulation) => {
                let snapshot = simulation.snapshot();
                recorder.record(simulation, &snapshot);
                if completes {
                    simulation.close(&snapshot)?;
                }
            }
            Motion::Solid(moving) => {
                recorder.record_solid(&mut moving.solid, watch, *energy_limit)?;
            }
            Motion::Housed(housed) => recorder.record_housed(housed, watch, *energy_limit)?,
            Motion::QuasiStaticSequence(sequence) => recorder.record_equilibrium(sequence),
            Motion::Rubber(moving) => recorder.record_rubber(&moving.solid)?,
        }
        self.clock.count_row(self.motion.time());
        Ok(())
    }

    fn keep(&mut self) {
        self.motion.checkpoint_into(&mut self.sound.checkpoint);
        self.sound.watch = self.watch;
        self.sound.rows = self.recorder.rows();
        self.motion.ran_into(&mut self.kept_ran.0);
        self.kept_ran.1 = self.recorder.ran;
    }

    /// Number of executions of each stage, including those before the run was resumed.
    pub fn ran(&self) -> StageCounts {
        self.with_before(&self.motion.ran(), &self.recorder.ran)
    }

    fn with_before(&self, motion: &StageCounts, recorder: &Counts) -> StageCounts {
        let mut all = self.before.clone();
        all.absorb(motion);
        all.whole.absorb(recorder);
        all
    }

    /// State to resume from: the last valid state if the run is complete or has failed, or if it resumes from its rows;
    /// otherwise the present state.
    pub fn resumable(&mut self) -> Sound {
        let by_rows = matches!(
            self.motion,
            Motion::Housed(_) | Motion::QuasiStaticSequence(_) | Motion::Rubber(_)
        );
        if by_rows || self.failed || self.status == Status::Complete {
            let ran = self.with_before(&self.kept_ran.0, &self.kept_ran.1);
            return Sound { ran, ..self.sound.clone() };
        }
        let rows = self.recorder.rows();
        Sound { checkpoint: self.motion.checkpoint(), watch: self.watch, rows, ran: self.ran() }
    }

    /// Number of rows at equal intervals: all except a last one that the end of the run has moved off the grid.
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

    /// Rounded time of a row, s.
    pub fn row_time(&self, row: usize) -> f64 {
        readable(row, self.recorder.row(row)[0], self.clock.row_interval())
    }

    /// All rows as a table.
    ///
    /// # Errors
    /// Never for a session's own columns.
    pub fn series(&self) -> Result<Series, SeriesError> {
        self.recorder.series(self.recorder.rows())
    }

    /// Displacements of a solid, m; empty if there is no solid with this number. In a coupled run they are half a step of the
    /// solid ahead of the bodies' time.
    pub fn displacement(&self, solid: usize) -> Vec<Vec3> {
        let of = |solid: &&ExplicitSolid| {
            solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect()
        };
        match &self.motion {
            Motion::QuasiStaticSequence(sequence) => sequence.displacement(solid),
            Motion::Rubber(moving) if solid == 0 => moving.solid.displacement().to_vec(),
            motion => motion.solids().get(solid).map_or_else(Vec::new, of),
        }
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
