//! The energy ledger of a run, look by look: of a run with a solid in it at each row, of bearings alone whatever the rows are.

/// A ledger that does not close at this many looks on end fails a run. One alone may be a blow to a
/// body at rest: what a step leaves of it is much of the little that has been turned over.
pub const MOST_OPEN: u32 = 5;

/// Energy that is nothing to any body of a scene, J: some hundred times what heat gives one atom at room temperature. What
/// rounding makes of a system at rest, before its load comes, is far below.
const NOTHING: f64 = 1e-18;

/// What the ledger has come to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LedgerWatch {
    /// Energy held less work done at the start, J: what the ledger of a solid by itself is held against.
    pub first: f64,
    /// Largest energy held or exchanged so far, J: what is unaccounted for is measured by it.
    pub turned_over: f64,
    /// Largest energy unaccounted for so far, J.
    pub largest_residual: f64,
    /// Looks on end at which it did not close.
    pub open: u32,
}

impl LedgerWatch {
    /// Looks where `residual` is unaccounted for and `turned_over` held or exchanged (J); false
    /// where the run has to end, having missed more than `limit` of it for too long.
    pub fn record(&mut self, residual: f64, turned_over: f64, limit: f64) -> bool {
        let closes = self.closes(residual, turned_over, limit);
        self.open = if closes { 0 } else { self.open.saturating_add(1) };
        // A residual that is not a number is refused as well.
        self.open < MOST_OPEN && residual.is_finite()
    }

    /// Whether it closes at one look by itself.
    pub fn closes(&mut self, residual: f64, turned_over: f64, limit: f64) -> bool {
        self.turned_over = self.turned_over.max(turned_over);
        self.largest_residual = self.largest_residual.max(residual.abs());
        residual.abs() <= (limit * self.turned_over).max(NOTHING)
    }
}
