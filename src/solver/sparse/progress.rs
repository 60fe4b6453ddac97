//! How far a factorisation is, for whoever looks from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Shared: clones tell of the same work.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<Counts>);

#[derive(Debug, Default)]
struct Counts {
    begun: AtomicU64,
    finished: AtomicU64,
    /// Multiplications and additions of the factorisation at work.
    operations: AtomicU64,
    solves: AtomicU64,
}

impl Progress {
    /// Factorisations begun so far, and those that are finished.
    pub fn factorisations(&self) -> (u64, u64) {
        (self.0.begun.load(Relaxed), self.0.finished.load(Relaxed))
    }

    /// Multiplications and additions done of the factorisation at work.
    pub fn operations(&self) -> u64 {
        self.0.operations.load(Relaxed)
    }

    /// Right-hand sides solved for.
    pub fn solves(&self) -> u64 {
        self.0.solves.load(Relaxed)
    }

    pub(super) fn begin(&self) {
        self.0.operations.store(0, Relaxed);
        self.0.begun.fetch_add(1, Relaxed);
    }

    pub(super) fn add(&self, operations: f64) {
        self.0.operations.fetch_add(operations as u64, Relaxed);
    }

    pub(super) fn finish(&self) {
        self.0.finished.fetch_add(1, Relaxed);
    }

    pub(super) fn solved(&self, columns: usize) {
        self.0.solves.fetch_add(columns as u64, Relaxed);
    }
}
