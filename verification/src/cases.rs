//! Every verification case, in the order of the source.
//!
//! To add one: make the folder, then add one `mod` and one line here.

use crate::case::{Case, Tier};

#[path = "../kinematic_frequencies/case.rs"]
mod kinematic_frequencies;

pub const CASES: &[Case] = &[kinematic_frequencies::CASE];

/// Cases of a tier (the full tier contains the smoke tier).
pub fn of_tier(tier: Tier) -> Vec<Case> {
    CASES.iter().copied().filter(|case| tier == Tier::Full || case.tier == Tier::Smoke).collect()
}

/// The case with this id.
pub fn find(id: &str) -> Option<Case> {
    CASES.iter().copied().find(|case| case.id == id)
}
