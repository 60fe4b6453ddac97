//! From given keys to a validated scene in SI units: defaults, and checks between keys.

pub mod assembly;
pub mod bearing;
pub mod bushing;
pub mod cage;
pub mod contact;
pub mod dynamics;
pub mod geometry;
pub mod housing;
pub mod housing_scene;
pub mod places;
pub mod profile;
pub mod raceway_profile;
pub mod resolved;
pub mod rubber;
pub mod sensor;
pub mod shaft;
pub mod solid;
pub mod solid_mesh;
pub mod solid_scene;
pub mod spring;
pub mod unused;
