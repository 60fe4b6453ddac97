//! Everything that a bearing and its housing in explicit steps need to go on with the same bits.

use super::exchange::{ExchangeError, ExchangeOptions, Growth, HousedBearing, Seat};
use crate::ch2_housing::bore_contact::{ContactSum, Cylinder, Frame};
use crate::kinematics::Pose;
use crate::kinematics::vec3::Vec3;
use crate::solver::dynamics::checkpoint::Checkpoint;
use crate::solver::dynamics::model::DynamicProblem;
use crate::solver::dynamics::run::Simulation;
use crate::solver::solid::checkpoint::SolidCheckpoint;
use crate::solver::solid::explicit::{ExplicitMethod, ExplicitSolid};
use crate::solver::solid::model::SolidModel;
use crate::solver::solid::step_limit::SolidStepLimit;

/// Both at the end of a window, as plain numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HousedCheckpoint {
    pub bearing: Checkpoint,
    pub solid: SolidCheckpoint,
    pub exchanges: u64,
    /// On the outer race since the start, N·s.
    pub impulse: Vec3,
    pub growth: Growth,
    pub tested: u64,
    pub sorts: u64,
    /// What the ledgers of the bearing and of both held at the start, J.
    pub first: [f64; 2],
}

/// Sizes that were chosen at the start and stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windows {
    /// s.
    pub window: f64,
    pub solid_steps: usize,
    pub limit: SolidStepLimit,
}

impl HousedBearing {
    /// Where both are now. Nodes are sorted by reach first, so that going on from here and going on
    /// from the checkpoint tests the same ones.
    pub fn checkpoint_into(&mut self, checkpoint: &mut HousedCheckpoint) {
        self.sort();
        self.bearing.checkpoint_into(&mut checkpoint.bearing);
        self.solid.checkpoint_into(&mut checkpoint.solid);
        checkpoint.exchanges = self.exchanges;
        checkpoint.impulse = self.impulse;
        checkpoint.growth = self.growth;
        checkpoint.tested = self.tested;
        checkpoint.sorts = self.sorts;
        checkpoint.first = [self.first_bearing, self.first];
    }

    pub fn windows(&self) -> Windows {
        let Self { window, solid_steps, .. } = *self;
        Windows { window, solid_steps, limit: self.solid.limit }
    }

    /// Goes on where a checkpoint of the same problem, seat and options was taken.
    ///
    /// # Errors
    /// A step size that is no step.
    ///
    /// # Panics
    /// If the checkpoint has other numbers of balls or nodes.
    pub fn from_checkpoint(
        problem: DynamicProblem,
        model: SolidModel,
        mut seat: Seat,
        options: &ExchangeOptions,
        windows: &Windows,
        checkpoint: &HousedCheckpoint,
    ) -> Result<HousedBearing, ExchangeError> {
        let rim = seat.keep_under(&problem.outer_start);
        let bearing = Simulation::from_checkpoint(problem, options.bearing, &checkpoint.bearing)?;
        let method = ExplicitMethod::CentralDifferences;
        let step = windows.window / windows.solid_steps as f64;
        let mut solid = ExplicitSolid::at_rest(model, method, step, windows.limit);
        solid.restore(&checkpoint.solid);
        let cylinder = Cylinder { radius: seat.radius.value(0.0), width: seat.width };
        let [first_bearing, first] = checkpoint.first;
        let mut housed = HousedBearing {
            bearing,
            solid,
            seat,
            rim,
            window: windows.window,
            solid_steps: windows.solid_steps,
            exchanges: checkpoint.exchanges,
            contact: ContactSum::default(),
            impulse: checkpoint.impulse,
            growth: checkpoint.growth,
            tested: checkpoint.tested,
            sorts: 0,
            near: Vec::new(),
            far: Vec::new(),
            sorted_at: (cylinder, Frame::new(&Pose::identity())),
            first_bearing,
            first,
        };
        housed.sort();
        housed.sorts = checkpoint.sorts;
        Ok(housed)
    }
}
