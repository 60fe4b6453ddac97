//! Checks of the energy ledger of a run: at each row of a run with a solid, otherwise at intervals of its own.

use serde::{Deserialize, Serialize};

/// Consecutive checks with an energy residual beyond the limit that end a run. A single one may be an impact on a body
/// at rest, whose residual is large compared with the little energy turned over.
pub const MOST_OPEN: u32 = 5;

/// Energy below which nothing is checked, J: some hundred times the thermal energy of an atom at room temperature.
const NOTHING: f64 = 1e-18;

/// The same, as a part of all energy that is held: rounding in a system at rest.
const ROUNDING: f64 = 1e-12;

/// State of the energy ledger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LedgerWatch {
    /// Initial energy less work done, J: reference of the ledger of a solid alone.
    pub first: f64,
    /// Largest energy held or exchanged so far, J: reference of the residual.
    pub turned_over: f64,
    /// Largest energy residual so far, J.
    pub largest_residual: f64,
    /// Consecutive checks beyond the limit.
    pub open: u32,
}

impl LedgerWatch {
    /// Records a check with `residual`, `turned_over` and the energy `held` (J). Returns false if the run has to end: the residual has
    /// exceeded `limit` of the energy turned over for too long.
    pub fn record(&mut self, residual: f64, turned_over: f64, held: f64, limit: f64) -> bool {
        let closes = self.closes(residual, turned_over, held, limit);
        self.open = if closes { 0 } else { self.open.saturating_add(1) };
        // NaN ends the run too.
        self.open < MOST_OPEN && residual.is_finite()
    }

    /// Returns whether a single check is within the limit.
    pub fn closes(&mut self, residual: f64, turned_over: f64, held: f64, limit: f64) -> bool {
        self.turned_over = self.turned_over.max(turned_over);
        self.largest_residual = self.largest_residual.max(residual.abs());
        residual.abs() <= (limit * self.turned_over).max(NOTHING).max(ROUNDING * held)
    }
}
