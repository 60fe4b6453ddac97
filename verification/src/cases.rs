//! Every verification case, in the order of the source.
//!
//! To add one: make the folder, then add one `mod` and one line here.

use crate::case::{Case, Tier};

#[path = "../assembly_fits_2_4_1/case.rs"]
pub mod assembly_fits_2_4_1;
#[path = "../axial_load_closed_form/case.rs"]
mod axial_load_closed_form;
#[path = "../bearing_conservation/case.rs"]
mod bearing_conservation;
#[path = "../bearing_on_bushing_3_4_3/case.rs"]
mod bearing_on_bushing_3_4_3;
#[path = "../bore_friction_4_2_4_2/case.rs"]
mod bore_friction_4_2_4_2;
#[path = "../bushing_bulging_3_4_2/case.rs"]
mod bushing_bulging_3_4_2;
#[path = "../bushing_geometries_3_4_2/case.rs"]
mod bushing_geometries_3_4_2;
#[path = "../bushing_loops_3_3/case.rs"]
mod bushing_loops_3_3;
#[path = "../bushing_materials_3_4_1/case.rs"]
mod bushing_materials_3_4_1;
#[path = "../bushing_relaxation_3_3_1/case.rs"]
mod bushing_relaxation_3_3_1;
#[path = "../bushing_scene_3_4_1/case.rs"]
mod bushing_scene_3_4_1;
#[path = "../bushing_sleeve_motions/case.rs"]
mod bushing_sleeve_motions;
#[path = "../cage_modes_table_5_3/case.rs"]
mod cage_modes_table_5_3;
#[path = "../cage_slip/case.rs"]
mod cage_slip;
#[path = "../cage_speed_table_5_4/case.rs"]
mod cage_speed_table_5_4;
#[path = "../calculix_comparison/case.rs"]
mod calculix_comparison;
#[path = "../cantilever_timoshenko/case.rs"]
mod cantilever_timoshenko;
#[path = "../critical_speed_4_3_4/case.rs"]
mod critical_speed_4_3_4;
#[path = "../cylinder_on_block_table_2_1/case.rs"]
pub mod cylinder_on_block_table_2_1;
#[path = "../dent_3_4_4/case.rs"]
mod dent_3_4_4;
#[path = "../dent_half_space/case.rs"]
mod dent_half_space;
#[path = "../flexible_shaft_4_3_3/case.rs"]
mod flexible_shaft_4_3_3;
#[path = "../free_ring_modes/case.rs"]
mod free_ring_modes;
#[path = "../free_spin_4_2_2/case.rs"]
mod free_spin_4_2_2;
#[path = "../friction_torque/case.rs"]
mod friction_torque;
#[path = "../hertz_elliptic/case.rs"]
mod hertz_elliptic;
#[path = "../housing_equilibrium/case.rs"]
mod housing_equilibrium;
#[path = "../housing_orbits_2_4_2/case.rs"]
mod housing_orbits_2_4_2;
#[path = "../housing_settling/case.rs"]
mod housing_settling;
#[path = "../kinematic_frequencies/case.rs"]
mod kinematic_frequencies;
#[path = "../line_contact_plane_strain/case.rs"]
pub mod line_contact_plane_strain;
#[path = "../misalignment_moment/case.rs"]
mod misalignment_moment;
#[path = "../misalignment_on_bushing_3_4_5/case.rs"]
mod misalignment_on_bushing_3_4_5;
#[path = "../outside_bearings/case.rs"]
pub mod outside_bearings;
#[path = "../outside_rotors/case.rs"]
mod outside_rotors;
#[path = "../raceway_profiles/case.rs"]
mod raceway_profiles;
#[path = "../reduced_housing/case.rs"]
mod reduced_housing;
#[path = "../rod_wave/case.rs"]
mod rod_wave;
#[path = "../ross_comparison/case.rs"]
mod ross_comparison;
#[path = "../rotating_load_orbit/case.rs"]
mod rotating_load_orbit;
#[path = "../rotor_in_elements_4_2/case.rs"]
mod rotor_in_elements_4_2;
#[path = "../rotor_in_housings_4_3/case.rs"]
mod rotor_in_housings_4_3;
#[path = "../rotor_resonance_4_3_4/case.rs"]
mod rotor_resonance_4_3_4;
#[path = "../rotor_run_up_4_3_4/case.rs"]
mod rotor_run_up_4_3_4;
#[path = "../rubber_cube_2_3_1/case.rs"]
mod rubber_cube_2_3_1;
#[path = "../rubber_explicit/case.rs"]
mod rubber_explicit;
#[path = "../rubber_load_rates_2_4_3/case.rs"]
mod rubber_load_rates_2_4_3;
#[path = "../rubber_locking/case.rs"]
mod rubber_locking;
#[path = "../settling_and_turning/case.rs"]
mod settling_and_turning;
#[path = "../shaft_beam/case.rs"]
mod shaft_beam;
#[path = "../shaft_in_two_housings/case.rs"]
mod shaft_in_two_housings;
#[path = "../shaft_on_two_bearings/case.rs"]
mod shaft_on_two_bearings;
#[path = "../shaft_solid_4_2_2/case.rs"]
mod shaft_solid_4_2_2;
#[path = "../slip_and_spin_3_4_5/case.rs"]
mod slip_and_spin_3_4_5;
#[path = "../solid_elements/case.rs"]
mod solid_elements;
#[path = "../solid_energy_and_steps/case.rs"]
mod solid_energy_and_steps;
#[path = "../spall_sensors_5_4_3/case.rs"]
mod spall_sensors_5_4_3;
#[path = "../statics_independent/case.rs"]
pub mod statics_independent;
#[path = "../steel_impact_2_4_3/case.rs"]
mod steel_impact_2_4_3;
#[path = "../steel_load_rates_2_4_3/case.rs"]
mod steel_load_rates_2_4_3;
#[path = "../telemeter_5_2/case.rs"]
mod telemeter_5_2;
#[path = "../thick_ring_lame/case.rs"]
mod thick_ring_lame;
#[path = "../varying_compliance_dynamics/case.rs"]
mod varying_compliance_dynamics;
#[path = "../varying_compliance_statics/case.rs"]
mod varying_compliance_statics;

pub const CASES: &[Case] = &[
    hertz_elliptic::CASE,
    outside_bearings::CASE,
    rotating_load_orbit::CASE,
    statics_independent::CASE,
    shaft_on_two_bearings::CASE,
    shaft_beam::CASE,
    shaft_solid_4_2_2::CASE,
    rotor_in_elements_4_2::CASE,
    free_spin_4_2_2::CASE,
    ross_comparison::CASE,
    outside_rotors::CASE,
    flexible_shaft_4_3_3::CASE,
    critical_speed_4_3_4::CASE,
    misalignment_moment::CASE,
    misalignment_on_bushing_3_4_5::CASE,
    dent_3_4_4::CASE,
    dent_half_space::CASE,
    bore_friction_4_2_4_2::CASE,
    rotor_in_housings_4_3::CASE,
    rotor_resonance_4_3_4::CASE,
    rotor_run_up_4_3_4::CASE,
    settling_and_turning::CASE,
    varying_compliance_statics::CASE,
    varying_compliance_dynamics::CASE,
    axial_load_closed_form::CASE,
    bearing_conservation::CASE,
    kinematic_frequencies::CASE,
    cage_slip::CASE,
    raceway_profiles::CASE,
    cage_speed_table_5_4::CASE,
    spall_sensors_5_4_3::CASE,
    solid_elements::CASE,
    solid_energy_and_steps::CASE,
    rod_wave::CASE,
    thick_ring_lame::CASE,
    cantilever_timoshenko::CASE,
    friction_torque::CASE,
    free_ring_modes::CASE,
    cage_modes_table_5_3::CASE,
    telemeter_5_2::CASE,
    calculix_comparison::CASE,
    line_contact_plane_strain::CASE,
    cylinder_on_block_table_2_1::CASE,
    housing_equilibrium::CASE,
    housing_settling::CASE,
    assembly_fits_2_4_1::CASE,
    housing_orbits_2_4_2::CASE,
    reduced_housing::CASE,
    shaft_in_two_housings::CASE,
    steel_load_rates_2_4_3::CASE,
    steel_impact_2_4_3::CASE,
    rubber_cube_2_3_1::CASE,
    bushing_relaxation_3_3_1::CASE,
    bushing_loops_3_3::CASE,
    bushing_materials_3_4_1::CASE,
    bushing_scene_3_4_1::CASE,
    bushing_geometries_3_4_2::CASE,
    bushing_bulging_3_4_2::CASE,
    bushing_sleeve_motions::CASE,
    rubber_load_rates_2_4_3::CASE,
    bearing_on_bushing_3_4_3::CASE,
    slip_and_spin_3_4_5::CASE,
    rubber_locking::CASE,
    rubber_explicit::CASE,
];

/// Cases of a tier (the full tier contains the smoke tier).
pub fn of_tier(tier: Tier) -> Vec<Case> {
    CASES.iter().copied().filter(|case| tier == Tier::Full || case.tier == Tier::Smoke).collect()
}

/// Cases that tell how long something took.
const TIMED: [&str; 5] = [
    "housing_orbits_2_4_2",
    "housing_settling",
    "reduced_housing",
    "rubber_explicit",
    "shaft_in_two_housings",
];

/// Whether a case times something, so that it runs by itself.
pub fn is_timed(id: &str) -> bool {
    TIMED.contains(&id)
}

/// The case with this id.
pub fn find(id: &str) -> Option<Case> {
    CASES.iter().copied().find(|case| case.id == id)
}
