//! The key table: every key of a scene with its unit, range and meaning; source of schema and manual.

pub mod assembly;
pub mod bearing;
pub mod dynamics;
pub mod housing;
pub mod keys;
pub mod manual;
pub mod schema;
pub mod sensor;
pub mod shaft;
pub mod solid;
