//! Laws of flexible rotors.

#[path = "../common/mod.rs"]
mod common;

mod assemblies;
mod beam;
mod formulas;
mod in_elements;
mod relaxing;
mod run_ups;
mod solid_shaft;
mod statics;
mod whirl;
