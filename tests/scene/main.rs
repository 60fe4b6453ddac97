//! Scenes: reading, errors, keys, documents, hostile input.

#[path = "../assembly_common/mod.rs"]
mod assembly_common;
#[path = "../fuzz_common/mod.rs"]
mod fuzz_common;

mod key_reach;
mod quantities;
mod scene_assembly;
mod scene_base;
mod scene_bushing;
mod scene_defaults;
mod scene_docs;
mod scene_dynamics;
mod scene_errors;
mod scene_excitations;
mod scene_fuzz;
mod scene_lists;
mod scene_places;
mod scene_read;
mod scene_sensors;
mod scene_shaft;
mod scene_to_problem;
mod scene_units;
