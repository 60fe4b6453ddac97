//! A run from start to end: what moves, by its clock; rows of the time series, the energy ledger, and
//! the last state that was sound.

pub mod motion;
pub mod rubber;
pub mod size;

pub use crate::assembly::ledger_watch::LedgerWatch;
pub use crate::motion::clocked::RunRequest;
pub use motion::{Checkpoint, CourseParts, HousedParts, Motion, Parts, SolidParts};
pub use rubber::{MovingRubber, RubberParts};
pub use size::{TableSize, table_size};

use crate::assembly::plan::counts::{Counts, StageCounts};
use crate::equilibrium::quasi_static_sequence::QuasiStaticError;
use crate::kinematics::vec3::Vec3;
use crate::motion::clocked;
use crate::motion::coupling::ExchangeError;
use crate::motion::simulation::SimulationError;
use crate::numeric::clock::{Clock, rounded};
use crate::output::recorder::Recorder;
use crate::output::series::{Series, SeriesError};
use crate::output::table::readable;
use crate::solids::bore_equilibrium::BoreError;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::model::SolidError;
use crate::solids::rubber::error::RubberError;
use thiserror::Error;

#[derive(Debug, Error)]
pub enum SessionError {
    #[error("the run ends at {0} s; it must be positive and finite")]
    End(f64),
    #[error("the output interval is {0} s; it must be positive and finite")]
    Interval(f64),
    #[error(
        "{size}, more than {most} GB: take a longer numerics.output_interval ({interval:.1e} s would do), a shorter \
         numerics.end, or fewer output.channels",
        most = 8e-9 * size::MOST_VALUES,
        interval = size.shortest
    )]
    TooLarge { size: TableSize },
    #[error(
        "two columns would be called {0:?}: name the bodies, bearings, springs or places otherwise of which they are"
    )]
    SharedColumn(String),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Solid(#[from] SolidError),
    #[error(transparent)]
    Exchange(#[from] ExchangeError),
    #[error(transparent)]
    QuasiStaticSequence(#[from] QuasiStaticError),
    #[error(transparent)]
    Bore(#[from] BoreError),
    #[error(transparent)]
    Rubber(#[from] RubberError),
    #[error(
        "{residual:.3e} J are unaccounted for at t = {} s, step {step}, more than {limit} of \
         the {turned_over:.3e} J turned over; take a smaller step",
        rounded(*time)
    )]
    Energy { residual: f64, turned_over: f64, limit: f64, time: f64, step: u64 },
    #[error(
        "{residual:.3e} J of bearing and housing or bushings are unaccounted for at t = {at} s, window {window}, \
         more than {limit} of the {turned_over:.3e} J turned over; take shorter steps \
         (step_fraction and window_phase of [housing] or of the bushing, numerics.step)", at = rounded(*time)
    )]
    EnergyOfBoth { residual: f64, turned_over: f64, limit: f64, time: f64, window: u64 },
    #[error(
        "{rows} rows of {columns} channels do not fit in memory; take a longer output interval or \
         fewer channels"
    )]
    Memory { rows: usize, columns: usize },
    #[error("the state is that of a run of another kind")]
    OtherKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Running,
    /// File of fields number so and so is due at the present state.
    Fields(u64),
    /// At the end, with the last row recorded.
    Complete,
}

pub struct Session<'p> {
    pub motion: Motion<'p>,
    pub clock: Clock,
    pub recorder: Recorder,
    pub watch: LedgerWatch,
    /// Part of the energy turned over that may go missing where a solid moves.
    pub energy_limit: f64,
    pub status: Status,
    /// How often each stage ran before the session began.
    before: StageCounts,
    /// Counts of the motion and of the recorder as of `sound`.
    kept_ran: (StageCounts, Counts),
    sound: Sound,
    failed: bool,
}

/// What a later run goes on from.
#[derive(Clone, Debug, PartialEq)]
pub struct Sound {
    pub checkpoint: Checkpoint,
    pub watch: LedgerWatch,
    /// Rows that belong to it.
    pub rows: usize,
    /// How often each stage of the run had run.
    pub ran: StageCounts,
}

impl<'p> Session<'p> {
    /// Starts a run and records its first row; that of equilibria is still to be found.
    ///
    /// # Errors
    /// No equilibrium to start from, no step or one that is too long, no time to simulate, more rows
    /// than fit in memory.
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
            checkpoint: motion.room(),
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

    /// Goes on from a sound state, whose rows are in `series`, by the `clock` of the kept run; `None` if
    /// these are not the rows of this run.
    ///
    /// # Errors
    /// As [`Session::start`].
    ///
    /// # Panics
    /// If the checkpoint has other numbers of balls or nodes.
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

    /// At most `steps` steps, windows or equilibria, fewer where fields are due or the end comes.
    ///
    /// # Errors
    /// What ends the motion, or an energy ledger that does not close; [`Session::resumable`] then is
    /// the last sound state.
    pub fn advance(&mut self, steps: u64) -> Result<Status, SessionError> {
        let target = self.motion.done() + steps;
        while self.status != Status::Complete && self.motion.done() < target {
            let rows = self.clock.rows;
            let moved = self.go_to_next_stop(target - self.motion.done());
            if moved.is_err() {
                self.failed = true;
                // What the failed step left of a solid is of no use to anybody.
                match (&mut self.motion, &self.sound.checkpoint) {
                    (Motion::Solid(moving), Checkpoint::Solid(kept, _)) => {
                        moving.solid.restore(kept);
                    }
                    // One that stood before stands again.
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

    /// To the next row, the end, or so many steps before them.
    fn go_to_next_stop(&mut self, most: u64) -> Result<(), SessionError> {
        // A bearing goes on from before a step that failed or was shortened by the end, equilibria from
        // before the last one, so that it is found again; others from their rows.
        let keeps_rows =
            matches!(self.motion, Motion::Solid(_) | Motion::Housed(_) | Motion::Rubber(_));
        if !keeps_rows {
            self.keep();
        }
        let arrival = self.motion.advance(&mut self.clock, most)?;
        if arrival.row {
            let on_grid = keeps_rows && self.clock.is_on_grid(self.motion.done());
            if keeps_rows && !on_grid {
                // A longer run would not look here: it goes on from before.
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
            Motion::QuasiStaticSequence(course) => recorder.record_equilibrium(course),
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

    /// How often each stage of the run has run, before it was resumed as well.
    pub fn ran(&self) -> StageCounts {
        self.with_before(&self.motion.ran(), &self.recorder.ran)
    }

    fn with_before(&self, motion: &StageCounts, recorder: &Counts) -> StageCounts {
        let mut all = self.before.clone();
        all.absorb(motion);
        all.whole.absorb(recorder);
        all
    }

    /// What a later run goes on from: the last sound state of a run that is complete or has failed, and of
    /// those whose state is that of their rows; the present one of a run under way.
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

    /// Time of a row as people write it, s.
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

    /// Displacements of a solid, m; empty where there is none of that number. In a window they are half a
    /// step of its own ahead of the bodies' time.
    pub fn displacement(&self, solid: usize) -> Vec<Vec3> {
        let of = |solid: &&ExplicitSolid| {
            solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect()
        };
        match &self.motion {
            Motion::QuasiStaticSequence(course) => course.displacement(solid),
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
