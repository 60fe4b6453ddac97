//! Laws of flexible rotors.

#[path = "../common/mod.rs"]
mod common;
#[path = "../../verification/src/single_shaft.rs"]
mod single_shaft;

mod assemblies;
mod beam;
mod formulas;
mod in_elements;
mod relaxing;
mod run_ups;
mod solid_shaft;
mod statics;
mod whirl;
