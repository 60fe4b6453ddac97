//! Reduction of solids to few coordinates: component modes, floating frames, load patterns of bores.

pub mod component_modes;
pub mod fixed_interface_modes;
pub mod floating;
pub mod load_patterns;
