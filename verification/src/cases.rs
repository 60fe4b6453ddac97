//! Every verification case, in the order of the source.
//!
//! To add one: make the folder, then add one `mod` and one line here.

use crate::case::{Case, Tier};

#[path = "../axial_load_closed_form/case.rs"]
mod axial_load_closed_form;
#[path = "../cage_modes_table_5_3/case.rs"]
mod cage_modes_table_5_3;
#[path = "../cantilever_timoshenko/case.rs"]
mod cantilever_timoshenko;
#[path = "../free_ring_modes/case.rs"]
mod free_ring_modes;
#[path = "../hertz_elliptic/case.rs"]
mod hertz_elliptic;
#[path = "../kinematic_frequencies/case.rs"]
mod kinematic_frequencies;
#[path = "../misalignment_moment/case.rs"]
mod misalignment_moment;
#[path = "../rod_wave/case.rs"]
mod rod_wave;
#[path = "../solid_elements/case.rs"]
mod solid_elements;
#[path = "../solid_energy_and_steps/case.rs"]
mod solid_energy_and_steps;
#[path = "../statics_independent/case.rs"]
pub mod statics_independent;
#[path = "../thick_ring_lame/case.rs"]
mod thick_ring_lame;
#[path = "../varying_compliance_statics/case.rs"]
mod varying_compliance_statics;

pub const CASES: &[Case] = &[
    hertz_elliptic::CASE,
    statics_independent::CASE,
    misalignment_moment::CASE,
    varying_compliance_statics::CASE,
    axial_load_closed_form::CASE,
    kinematic_frequencies::CASE,
    solid_elements::CASE,
    solid_energy_and_steps::CASE,
    rod_wave::CASE,
    thick_ring_lame::CASE,
    cantilever_timoshenko::CASE,
    free_ring_modes::CASE,
    cage_modes_table_5_3::CASE,
];

/// Cases of a tier (the full tier contains the smoke tier).
pub fn of_tier(tier: Tier) -> Vec<Case> {
    CASES.iter().copied().filter(|case| tier == Tier::Full || case.tier == Tier::Smoke).collect()
}

/// The case with this id.
pub fn find(id: &str) -> Option<Case> {
    CASES.iter().copied().find(|case| case.id == id)
}
