//! Implicit time integration of a rubber solid from row to row.

use super::SessionError;
use crate::scene::build::rubber::RubberSetup;
use crate::solids::error::SolidError;
use crate::solids::rubber::checkpoint::RubberCheckpoint;
use crate::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};

#[derive(Clone, Copy)]
pub struct RubberParts<'p> {
    pub setup: &'p RubberSetup,
    pub stepping: Stepping,
}

pub struct MovingRubber<'p> {
    pub solid: RubberSolid<'p>,
    pub stepping: Stepping,
    /// Number of rows after the first, and the output interval, s.
    pub rows: u64,
    pub interval: f64,
}

impl<'p> RubberParts<'p> {
    /// State at t = 0, including a step of the loads or supports there.
    pub(super) fn started(&self, interval: f64) -> Result<MovingRubber<'p>, SessionError> {
        let mut moving = self.at_rest(interval)?;
        moving.go_to(0.0)?;
        Ok(moving)
    }

    /// State at rest, before t = 0.
    pub(super) fn at_rest(&self, interval: f64) -> Result<MovingRubber<'p>, SolidError> {
        let options = StepOptions { stepping: self.stepping, ..StepOptions::default() };
        let solid = RubberSolid::new(&self.setup.model, options)?;
        Ok(MovingRubber { solid, stepping: self.stepping, rows: 0, interval })
    }
}

impl MovingRubber<'_> {
    pub(super) fn go_to_next_row(&mut self) -> Result<(), SolidError> {
        self.go_to((self.rows + 1) as f64 * self.interval)?;
        self.rows += 1;
        Ok(())
    }

    fn go_to(&mut self, time: f64) -> Result<(), SolidError> {
        self.solid.advance(time, |_| {})
    }

    pub(super) fn restore(&mut self, kept: &RubberCheckpoint, rows: u64) -> Result<(), SolidError> {
        self.rows = rows;
        self.solid.restore(kept)
    }
}
