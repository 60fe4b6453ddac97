//! Tetrahedral meshes: data, generators, files, quality and checks.
//!
//! | Job | Where |
//! |---|---|
//! | the mesh and its node order | [`tet_mesh`], [`node_order`] |
//! | surfaces, adjacency, volumes, areas | [`topology`], [`measure`], [`vector_area`] |
//! | sets by geometry, symmetry planes | [`select`] |
//! | quality, faults, repairs | [`quality`], [`check`], [`repair`] |
//! | numbering for speed, mid-side nodes | [`numbering`], [`quadratic`] |
//! | files in and out | [`read`], [`mod@write`] |
//! | blocks, rings, shafts, housings, cages | [`generate`] |
//!
//! Lengths are in metres, except inside the readers. Readers take bytes and writers return bytes:
//! no file is opened here, and nothing depends on scenes, materials or unit strings.
pub mod check;
pub mod cylinder_fit;
pub mod error;
pub mod generate;
pub mod layers;
pub mod measure;
pub mod node_order;
pub mod numbering;
pub mod quadratic;
pub mod quality;
pub mod read;
pub mod repair;
pub mod select;
pub mod surface;
pub mod tet_mesh;
pub mod topology;
pub mod vector_area;
pub mod write;

pub use error::{Fault, MeshError};
pub use surface::Surface;
pub use tet_mesh::{Elements, Face, Order, TetMesh};
