//! Laws of flexible rotors.

#[path = "../common/mod.rs"]
mod common;

mod assemblies;
mod beam;
mod solid_shaft;
mod statics;
mod whirl;
