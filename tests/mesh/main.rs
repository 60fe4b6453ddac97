//! Meshes: files, generators, faults, numbering.

#[path = "../deck_common/mod.rs"]
mod deck_common;
#[path = "../fuzz_common/mod.rs"]
mod fuzz_common;
#[path = "../outside_common/mod.rs"]
mod outside_common;

mod mesh_faults;
mod mesh_files;
mod mesh_fuzz;
mod mesh_generators;
mod mesh_variants;
mod mesh_vtu;
mod vector_areas;
