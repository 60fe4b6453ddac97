//! From a resolved scene to the lists, problems and meshes of the solvers.

pub mod abilities;
pub mod about;
pub mod assembly;
pub mod bore_shape;
pub mod bushing;
pub mod cage;
pub mod deck_materials;
pub mod excitations;
pub mod housing;
pub mod motion;
pub mod rubber;
pub mod sensors;
pub mod shaft;
pub mod solid;
pub mod solid_mesh;
pub mod statics;
pub mod symmetry;
