//! The command as a user meets it.

#[path = "../assembly_common/mod.rs"]
mod assembly_common;
#[path = "../command_line_common/mod.rs"]
mod command_line_common;
#[path = "../common/mod.rs"]
mod common;
#[path = "../deck_common/mod.rs"]
mod deck_common;
#[path = "../common/dynamics.rs"]
mod dynamics;
#[path = "../housed_command_common/mod.rs"]
mod housed_command_common;
#[path = "../outside_common/mod.rs"]
mod outside_common;
#[path = "../resume_common/mod.rs"]
mod resume_common;
#[path = "../run_common/mod.rs"]
mod run_common;
#[path = "../solid_command_common/mod.rs"]
mod solid_command_common;

mod assembly_command;
mod assembly_housings;
mod assembly_reading;
mod asymmetric_scenes;
mod bad_scenes;
mod bearing_laws;
mod cages;
mod command_line;
mod command_line_check;
mod command_line_compare;
mod command_line_files;
mod command_line_sweep;
mod conform;
mod documented_commands;
mod engineering;
mod features;
mod force_balance;
mod free_shaft;
mod housed_bore_shape;
mod housed_command;
mod housed_command_check;
mod housed_command_numbers;
mod housed_command_resume;
mod housed_command_sweep;
mod housed_friction;
mod housed_reduced;
mod housed_starts;
mod housing_meshes;
mod modes_of_housings;
mod plan_words;
mod rating_life;
mod rotor_laws;
mod rotors_on_springs;
mod rubber_command;
mod rubber_limits;
mod run_command;
mod run_command_resume;
mod run_extremes;
mod run_plan;
mod run_recorder;
mod run_resume;
mod run_speeds;
mod run_step_watch;
mod run_texts;
mod scenes_on_bases;
mod sensors;
mod shaft_in_elements;
mod solid_command;
mod solid_command_errors;
mod solid_command_numbers;
mod solid_command_resume;
mod solid_decks;
mod sweep_of_runs;
mod sweep_resume;
mod sweep_shards;
mod turning_springs;
mod warnings;
mod whirl_laws;
