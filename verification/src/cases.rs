//! Every verification case, in the order of the source.
//!
//! To add one: make the folder, then add one `mod` and one line here.

use crate::case::{Case, Tier};

#[path = "../axial_load_closed_form/case.rs"]
mod axial_load_closed_form;
#[path = "../cage_slip/case.rs"]
mod cage_slip;
#[path = "../cage_speed_table_5_4/case.rs"]
mod cage_speed_table_5_4;
#[path = "../hertz_elliptic/case.rs"]
mod hertz_elliptic;
#[path = "../kinematic_frequencies/case.rs"]
mod kinematic_frequencies;
#[path = "../misalignment_moment/case.rs"]
mod misalignment_moment;
#[path = "../statics_independent/case.rs"]
pub mod statics_independent;
#[path = "../varying_compliance_statics/case.rs"]
mod varying_compliance_statics;

pub const CASES: &[Case] = &[
    hertz_elliptic::CASE,
    statics_independent::CASE,
    misalignment_moment::CASE,
    varying_compliance_statics::CASE,
    axial_load_closed_form::CASE,
    kinematic_frequencies::CASE,
    cage_slip::CASE,
    cage_speed_table_5_4::CASE,
];

/// Cases of a tier (the full tier contains the smoke tier).
pub fn of_tier(tier: Tier) -> Vec<Case> {
    CASES.iter().copied().filter(|case| tier == Tier::Full || case.tier == Tier::Smoke).collect()
}

/// The case with this id.
pub fn find(id: &str) -> Option<Case> {
    CASES.iter().copied().find(|case| case.id == id)
}
