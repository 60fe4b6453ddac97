//! Parts of a run and their time integration: bodies with bearings, a solid, bodies and solids coupled by impulses, or a
//! quasi-static sequence.

use super::SessionError;
use super::rubber::{MovingRubber, RubberParts};
use crate::assembly::bearing_alone::DynamicProblem;
use crate::assembly::lists::Assembly;
use crate::equilibrium::quasi_static_sequence::{
    QuasiStaticCheckpoint, QuasiStaticProblem, QuasiStaticSequence,
};
use crate::motion::bonded_bushing::BondedPart;
use crate::motion::checkpoint::Checkpoint as BearingCheckpoint;
use crate::motion::clocked;
use crate::motion::clocked::{Arrival, RunRequest};
use crate::motion::coupled_checkpoint::{CouplingCheckpoint, CouplingSteps};
use crate::motion::coupling::{CoupledMotion, CouplingError, CouplingOptions, SolidPart};
use crate::motion::race_in_bore::Seat;
use crate::motion::simulation::{RunOptions, Simulation};
use crate::numeric::clock::{Clock, whole_number};
use crate::plan::counts::{Counts, StageCounts};
use crate::scene::build::solid::SolidSetup;
use crate::solids::checkpoint::SolidCheckpoint;
use crate::solids::error::SolidError;
use crate::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping, padded};
use crate::solids::model::SolidModel;
use crate::solids::rubber::checkpoint::RubberCheckpoint;
use crate::solids::step_limit::{SolidStepLimit, step_limit};
use crate::solids::threads::WorkerPool;
use serde::{Deserialize, Serialize};

pub enum Parts<'p> {
    Bearing(Box<Assembly>),
    Solid(SolidParts<'p>),
    Housed(Box<HousedParts<'p>>),
    QuasiStaticSequence(Box<SequenceParts<'p>>),
    Rubber(RubberParts<'p>),
}

impl From<Assembly> for Parts<'_> {
    fn from(assembly: Assembly) -> Self {
        Parts::Bearing(Box::new(assembly))
    }
}

impl From<DynamicProblem> for Parts<'_> {
    fn from(problem: DynamicProblem) -> Self {
        problem.assembly().into()
    }
}

#[derive(Clone, Copy)]
pub struct SolidParts<'p> {
    pub setup: &'p SolidSetup,
    pub method: ExplicitMethod,
    pub stepping: SolidStepping,
    /// Number of threads for the solid; results are the same bits.
    pub threads: usize,
}

/// Bodies with their bearings, solids in explicit steps with the fits between them, and bushings with their own steps.
#[derive(Clone, Debug)]
pub struct HousedParts<'p> {
    pub assembly: Assembly,
    pub solids: Vec<SolidPart>,
    pub seats: Vec<Seat>,
    pub bushings: Vec<BondedPart<'p>>,
    pub options: CouplingOptions,
    /// Number of threads for the solids; results are the same bits.
    pub threads: usize,
}

impl<'p> HousedParts<'p> {
    /// Shafts and bushings in elements with fixed outer races, on one thread. The energy limit of `options` applies to the
    /// whole, not to the bearings alone.
    pub fn without_housings(
        assembly: Assembly,
        solids: Vec<SolidPart>,
        bushings: Vec<BondedPart<'p>>,
        options: &RunOptions,
    ) -> HousedParts<'p> {
        let bearing = RunOptions { energy_limit: f64::INFINITY, ..*options };
        let options = CouplingOptions::without_housings(bearing);
        HousedParts { assembly, solids, seats: Vec::new(), bushings, options, threads: 1 }
    }
}

/// Bodies, bearings and condensed housings of a quasi-static sequence, and the solid models of the housings.
#[derive(Clone)]
pub struct SequenceParts<'p> {
    pub problem: QuasiStaticProblem<'p>,
    /// One model per housing fit.
    pub models: Vec<&'p SolidModel>,
}

/// Present state of a run, by kind.
pub enum Motion<'p> {
    Bearing(Box<Simulation>),
    Solid(Box<MovingSolid>),
    Housed(Box<CoupledMotion<'p>>),
    QuasiStaticSequence(Box<QuasiStaticSequence<'p>>),
    Rubber(Box<MovingRubber<'p>>),
}

/// A solid and the number of threads that step it.
pub struct MovingSolid {
    pub solid: ExplicitSolid,
    pub threads: usize,
}

impl Motion<'_> {
    /// Number of executions of each stage since this session began.
    pub fn ran(&self) -> StageCounts {
        match self {
            Motion::Bearing(simulation) => simulation.system.ran.clone(),
            Motion::Solid(moving) => {
                StageCounts { solids: vec![moving.solid.ran], ..StageCounts::default() }
            }
            Motion::Housed(housed) => housed.ran(),
            Motion::QuasiStaticSequence(sequence) => sequence.ran.clone(),
            Motion::Rubber(moving) => {
                StageCounts { solids: vec![*moving.solid.ran()], ..StageCounts::default() }
            }
        }
    }

    /// Like [`Motion::ran`], into existing counts.
    pub(super) fn ran_into(&self, to: &mut StageCounts) {
        match self {
            Motion::Bearing(simulation) => to.copy_from(&simulation.system.ran),
            _ => *to = self.ran(),
        }
    }

    /// Resets the counts; earlier executions are counted elsewhere.
    pub(super) fn forget_ran(&mut self) {
        match self {
            Motion::Bearing(simulation) => simulation.system.ran.clear(),
            Motion::Solid(moving) => moving.solid.ran = Counts::default(),
            Motion::Housed(housed) => housed.forget_ran(),
            Motion::QuasiStaticSequence(sequence) => sequence.ran.clear(),
            Motion::Rubber(moving) => moving.solid.forget_ran(),
        }
    }
}

/// Complete state of a motion, to resume with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Checkpoint {
    Bearing(Box<BearingCheckpoint>),
    Solid(Box<SolidCheckpoint>, SolidStepLimit),
    Housed(Box<CouplingCheckpoint>, CouplingSteps),
    QuasiStaticSequence(QuasiStaticCheckpoint),
    /// State, and the number of rows after the first.
    Rubber(Box<RubberCheckpoint>, u64),
}

impl<'p> Motion<'p> {
    /// Initial motion, with the clock of the run.
    pub(super) fn start(
        parts: Parts<'p>,
        request: &RunRequest,
    ) -> Result<(Motion<'p>, Clock), SessionError> {
        let interval = request.output_interval;
        let (motion, mut clock) = match parts {
            Parts::Bearing(assembly) => {
                let (simulation, clock) = clocked::start(*assembly, request)?;
                (Motion::Bearing(Box::new(simulation)), clock)
            }
            Parts::Solid(parts) => {
                let model = parts.model()?;
                let still = vec![[0.0; 4]; model.mass.len()];
                let limit = step_limit(&model, &still, parts.method);
                let (step, steps_per_row) = parts.stepping.divide(interval, limit.step);
                let solid = parts.solid(model, limit, step)?;
                (Motion::Solid(solid), Clock { step, steps_per_row, ..Clock::default() })
            }
            Parts::Housed(parts) => {
                let (housed, steps_per_row) = parts.started(interval)?;
                let step = housed.coupling_step;
                let clock = Clock { step, steps_per_row, ..Clock::default() };
                (Motion::Housed(Box::new(housed)), clock)
            }
            Parts::QuasiStaticSequence(parts) => {
                let sequence = QuasiStaticSequence::new(parts.problem, interval);
                let clock = Clock { step: interval, steps_per_row: 1, ..Clock::default() };
                (Motion::QuasiStaticSequence(Box::new(sequence)), clock)
            }
            Parts::Rubber(parts) => {
                let moving = parts.started(interval)?;
                let clock = Clock { step: interval, steps_per_row: 1, ..Clock::default() };
                (Motion::Rubber(Box::new(moving)), clock)
            }
        };
        (clock.end, clock.interval) = (request.end, interval);
        clock.fields_interval = request.fields_interval;
        let row = clock.row_interval();
        clock.rows_per_fields =
            request.fields_interval.map(|fields| (fields / row).round().max(1.0) as u64);
        clock.last = motion.last(&clock);
        Ok((motion, clock))
    }

    /// Motion at a checkpoint; `clock` is that of the stored run.
    pub(super) fn resume(
        parts: Parts<'p>,
        request: &RunRequest,
        checkpoint: &Checkpoint,
        clock: &mut Clock,
    ) -> Result<Motion<'p>, SessionError> {
        let motion = match (parts, checkpoint) {
            (Parts::Bearing(assembly), Checkpoint::Bearing(kept)) => {
                let simulation = Simulation::from_checkpoint(*assembly, request.options, kept)?;
                clock.corners = simulation.system.assembly.corners();
                clock.shortened = simulation.step_watch.shortened > 0;
                Motion::Bearing(Box::new(simulation))
            }
            (Parts::Solid(parts), Checkpoint::Solid(kept, limit)) => {
                let mut moving = parts.solid(parts.model()?, *limit, clock.step)?;
                moving.solid.restore(kept);
                Motion::Solid(moving)
            }
            (Parts::Housed(parts), Checkpoint::Housed(kept, coupling_steps)) => {
                let HousedParts { assembly, solids, seats, bushings, options, threads } = *parts;
                let mut housed = CoupledMotion::from_checkpoint(
                    assembly,
                    solids,
                    seats,
                    bushings,
                    &options,
                    coupling_steps,
                    kept,
                )?;
                housed.share(threads);
                Motion::Housed(Box::new(housed))
            }
            (Parts::QuasiStaticSequence(parts), Checkpoint::QuasiStaticSequence(kept)) => {
                let mut sequence = QuasiStaticSequence::new(parts.problem, clock.interval);
                sequence.restore(kept)?;
                Motion::QuasiStaticSequence(Box::new(sequence))
            }
            (Parts::Rubber(parts), Checkpoint::Rubber(kept, rows)) => {
                let mut moving = parts.at_rest(clock.interval)?;
                moving.restore(kept, *rows)?;
                Motion::Rubber(Box::new(moving))
            }
            _ => return Err(SessionError::OtherKind),
        };
        clock.last = motion.last(clock);
        Ok(motion)
    }

    /// Number of whole steps to the end: for a solid to the nearest step, for others to the nearest row.
    fn last(&self, clock: &Clock) -> Option<u64> {
        match self {
            Motion::Bearing(_) => None,
            Motion::Solid(_) | Motion::Rubber(_) => Some(whole_number(clock.end, clock.step)),
            Motion::Housed(_) => {
                Some(whole_number(clock.end, clock.interval) * clock.steps_per_row)
            }
            Motion::QuasiStaticSequence(_) => Some(whole_number(clock.end, clock.interval) + 1),
        }
    }

    /// Bodies and bearings; `None` for a single solid.
    pub fn assembly(&self) -> Option<&Assembly> {
        match self {
            Motion::QuasiStaticSequence(sequence) => Some(&sequence.problem.assembly),
            motion => motion.bearing().map(|simulation| &simulation.system.assembly),
        }
    }

    /// Simulation of bodies and bearings; `None` if they are not integrated in time.
    pub fn bearing(&self) -> Option<&Simulation> {
        match self {
            Motion::Bearing(simulation) => Some(simulation),
            Motion::Housed(housed) => Some(&housed.simulation),
            Motion::Solid(_) | Motion::QuasiStaticSequence(_) | Motion::Rubber(_) => None,
        }
    }

    pub fn bearing_mut(&mut self) -> Option<&mut Simulation> {
        match self {
            Motion::Bearing(simulation) => Some(simulation),
            Motion::Housed(housed) => Some(&mut housed.simulation),
            Motion::Solid(_) | Motion::QuasiStaticSequence(_) | Motion::Rubber(_) => None,
        }
    }

    /// Returns whether the energy balance covers all parts, including solids.
    pub fn is_balanced_whole(&self) -> bool {
        matches!(self, Motion::Solid(_) | Motion::Housed(_))
    }

    pub fn solids(&self) -> Vec<&ExplicitSolid> {
        match self {
            Motion::Solid(moving) => vec![&moving.solid],
            Motion::Housed(housed) => housed.solids.iter().map(|part| &part.solid).collect(),
            Motion::Bearing(_) | Motion::QuasiStaticSequence(_) | Motion::Rubber(_) => Vec::new(),
        }
    }

    /// Present time, s.
    pub fn time(&self) -> f64 {
        match self {
            Motion::Bearing(simulation) => simulation.time,
            Motion::Solid(moving) => moving.solid.time,
            Motion::Housed(housed) => housed.time(),
            Motion::QuasiStaticSequence(sequence) => sequence.time(),
            Motion::Rubber(moving) => moving.solid.time(),
        }
    }

    /// Number of steps, coupling steps or equilibria so far.
    pub fn done(&self) -> u64 {
        match self {
            Motion::Bearing(simulation) => simulation.steps,
            Motion::Solid(moving) => moving.solid.steps,
            Motion::Housed(housed) => housed.exchanges,
            Motion::QuasiStaticSequence(sequence) => sequence.found,
            Motion::Rubber(moving) => moving.rows,
        }
    }

    /// Advances to the next event of the clock, in at most `most` steps.
    pub(super) fn advance(
        &mut self,
        clock: &mut Clock,
        most: u64,
    ) -> Result<Arrival, SessionError> {
        let count = match self {
            Motion::Bearing(simulation) => return Ok(clocked::step(simulation, clock)?),
            _ => clock.ahead(self.done(), most),
        };
        match self {
            Motion::Bearing(_) => {}
            Motion::Solid(moving) => {
                (0..count).try_for_each(|_| moving.solid.step(|_, _, _| {}))?;
            }
            Motion::Housed(housed) => {
                (0..count).try_for_each(|_| housed.advance())?;
                if clock.is_on_grid(housed.exchanges) {
                    let bearing = &mut housed.simulation;
                    if let Some(step) = bearing.watch_step().map_err(CouplingError::from)? {
                        bearing.shorten_step(step);
                    }
                }
            }
            Motion::QuasiStaticSequence(sequence) => sequence.find_next()?,
            Motion::Rubber(moving) => {
                (0..count).try_for_each(|_| moving.go_to_next_row())?;
            }
        }
        let (row, completes) = clock.after(self.done());
        Ok(Arrival { row, completes })
    }

    pub(super) fn checkpoint(&mut self) -> Checkpoint {
        let mut kept = self.empty_checkpoint();
        self.checkpoint_into(&mut kept);
        kept
    }

    /// Empty checkpoint for [`Motion::checkpoint_into`].
    pub(super) fn empty_checkpoint(&self) -> Checkpoint {
        match self {
            Motion::Bearing(_) => Checkpoint::Bearing(Box::default()),
            Motion::Solid(moving) => Checkpoint::Solid(Box::default(), moving.solid.limit),
            Motion::Housed(housed) => Checkpoint::Housed(Box::default(), housed.coupling_steps()),
            Motion::QuasiStaticSequence(_) => {
                Checkpoint::QuasiStaticSequence(QuasiStaticCheckpoint::default())
            }
            Motion::Rubber(_) => Checkpoint::Rubber(Box::default(), 0),
        }
    }

    /// Like [`Motion::checkpoint`], but without allocation for a bearing, which is stored before each step.
    pub(super) fn checkpoint_into(&mut self, kept: &mut Checkpoint) {
        match (self, kept) {
            (Motion::Bearing(simulation), Checkpoint::Bearing(kept)) => {
                simulation.checkpoint_into(kept);
            }
            (Motion::Solid(moving), Checkpoint::Solid(kept, _)) => {
                moving.solid.checkpoint_into(kept);
            }
            (Motion::Housed(housed), Checkpoint::Housed(kept, _)) => housed.checkpoint_into(kept),
            (Motion::QuasiStaticSequence(sequence), Checkpoint::QuasiStaticSequence(kept)) => {
                *kept = sequence.checkpoint()
            }
            (Motion::Rubber(moving), Checkpoint::Rubber(kept, rows)) => {
                (**kept, *rows) = (moving.solid.checkpoint(), moving.rows);
            }
            (motion, kept) => {
                *kept = motion.empty_checkpoint();
                motion.checkpoint_into(kept);
            }
        }
    }
}

impl SolidParts<'_> {
    fn model(&self) -> Result<SolidModel, SolidError> {
        SolidModel::labelled(self.setup.problem.clone(), self.setup.labels.clone())
    }

    fn solid(
        &self,
        model: SolidModel,
        limit: SolidStepLimit,
        step: f64,
    ) -> Result<Box<MovingSolid>, SolidError> {
        let still = vec![[0.0; 4]; model.mass.len()];
        let velocity = padded(self.setup.velocity.clone());
        let stepping = SolidStepping::Fixed(step);
        let mut solid =
            ExplicitSolid::with_limit(model, self.method, stepping, limit, still, velocity)?;
        solid.share(&WorkerPool::new(self.threads), self.threads);
        Ok(Box::new(MovingSolid { solid, threads: self.threads }))
    }
}

impl<'p> HousedParts<'p> {
    /// Initial exchange, with coupling steps that divide the output interval `interval` (s), and their number per row.
    ///
    /// # Errors
    /// As [`CoupledMotion::new`].
    pub fn started(self, interval: f64) -> Result<(CoupledMotion<'p>, u64), CouplingError> {
        let HousedParts { assembly, solids, seats, bushings, options, threads } = self;
        let mut housed = CoupledMotion::with_bushings(assembly, solids, seats, bushings, &options)?;
        housed.share(threads);
        let coupling_steps = housed.divide(interval)?;
        Ok((housed, coupling_steps))
    }
}
