//! A solid of rubber that goes from row to row in implicit steps.

use super::SessionError;
use crate::scene::build::rubber::RubberSetup;
use crate::solids::rubber::checkpoint::RubberCheckpoint;
use crate::solids::rubber::error::RubberError;
use crate::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};

/// A solid of rubber by itself.
#[derive(Clone, Copy)]
pub struct RubberParts<'p> {
    pub setup: &'p RubberSetup,
    pub stepping: Stepping,
}

/// A solid of rubber on its way, by rows.
pub struct MovingRubber<'p> {
    pub solid: RubberSolid<'p>,
    pub stepping: Stepping,
    /// Rows behind the first, and the time between them, s.
    pub rows: u64,
    pub interval: f64,
}

impl<'p> RubberParts<'p> {
    /// At rest at t = 0, or where a jump there takes it.
    pub(super) fn started(&self, interval: f64) -> Result<MovingRubber<'p>, SessionError> {
        let mut moving = self.at_rest(interval)?;
        moving.go_to(0.0)?;
        Ok(moving)
    }

    /// Before anything has happened.
    pub(super) fn at_rest(&self, interval: f64) -> Result<MovingRubber<'p>, RubberError> {
        let options = StepOptions { stepping: self.stepping, ..StepOptions::default() };
        let solid = RubberSolid::new(&self.setup.model, options)?;
        Ok(MovingRubber { solid, stepping: self.stepping, rows: 0, interval })
    }
}

impl MovingRubber<'_> {
    /// On to the next row.
    pub(super) fn go_to_next_row(&mut self) -> Result<(), RubberError> {
        self.go_to((self.rows + 1) as f64 * self.interval)?;
        self.rows += 1;
        Ok(())
    }

    fn go_to(&mut self, time: f64) -> Result<(), RubberError> {
        self.solid.advance(time, |_| {})
    }

    pub(super) fn restore(
        &mut self,
        kept: &RubberCheckpoint,
        rows: u64,
    ) -> Result<(), RubberError> {
        self.rows = rows;
        self.solid.restore(kept)
    }
}
