//! Scenes: what a person describes in TOML or JSON, and what the program makes of it.
//!
//! text → tree of values with their places → [`Document`] (given keys, checked one by one
//! against the key table in [`keys`]) → [`Scene`] (SI, validated as a whole, every default named).
//!
//! ```
//! use bearing_dynamics::scene::{self, Format};
//! let text = r#"
//!     [bearing]
//!     kind = "deep-groove"
//!     balls = 8
//!     clearance = { radial = "-5 um" }
//!     inner_race = { radius = "20.047 mm", groove_radius = "6.013 mm" }
//!     outer_race = { radius = "31.953 mm", groove_radius = "6.310 mm" }
//! "#;
//! let scene = scene::read_str(text, Format::Toml, "example.toml")?;
//! assert!((scene.geometry.ball_radius - 5.9555e-3).abs() <= 1e-15);
//! # Ok::<(), scene::SceneError>(())
//! ```
pub mod about;
pub mod assembly;
mod base;
pub mod bore_shape;
pub mod bushing_problem;
pub mod bushing_reach;
mod deck_materials;
pub mod document;
pub mod dynamics;
pub mod error;
pub mod excitations;
pub mod housing;
pub mod housing_error;
pub mod housing_problem;
pub mod input_file;
mod items;
mod key_table;
mod key_table_assembly;
mod key_table_dynamics;
mod key_table_housing;
mod key_table_sensor;
mod key_table_shaft;
mod key_table_solid;
pub mod keys;
mod profile;
pub mod reference;
mod resolve;
mod resolve_assembly;
mod resolve_bushing;
mod resolve_cage;
mod resolve_contact;
mod resolve_dynamics;
mod resolve_geometry;
mod resolve_housing;
mod resolve_places;
mod resolve_rubber;
mod resolve_sensor;
mod resolve_shaft;
mod resolve_solid;
mod resolve_solid_mesh;
mod resolve_spring;
pub mod resolved;
pub mod rubber_problem;
pub mod schema;
mod scopes;
pub mod sensors;
pub mod shaft_problem;
pub mod solid;
pub mod solid_mesh;
pub mod solid_problem;
mod source;
pub mod statics;
pub mod sweep;
mod symmetry;
mod tree;
pub mod units;
mod value;

pub use document::Document;
pub use error::{Place, Problem, SceneError};
pub use housing::HousedScene;
pub use resolve::resolve;
pub use resolve_solid::resolve_subject;
pub use resolve_solid_mesh::{KEY_OF_DIMENSION, key_of_dimension};
pub use resolved::{
    Assumption, Cage, CageInRun, DefaultUsed, Dimensions, Dynamics, Plot, RaceDimensions, RunPlot,
    RunSettings, Scene,
};
pub use schema::json_schema;
pub use solid::{SolidScene, Subject};
pub use source::{Format, LARGEST_FILE};
pub use sweep::{SweepAxis, SweepValues};

use std::path::Path;

/// Reads a scene file of any kind: bearings on their bodies and in their housings, or a solid by itself.
///
/// # Errors
/// The first thing wrong with the file or its contents, with its place. The solid's mesh is not
/// read yet: that is [`solid_mesh::build`].
pub fn read_subject(path: &Path) -> Result<Subject, SceneError> {
    resolve_subject(&Document::read_file(path)?)
}

/// Reads a scene file with a bearing; the name's ending (`.toml`, `.json`) tells the format.
///
/// # Errors
/// The first thing wrong with the file or its contents, with its place.
pub fn read_file(path: &Path) -> Result<Scene, SceneError> {
    resolve(&Document::read_file(path)?)
}

/// Reads a scene with a bearing from text; `name` stands for the file in messages.
///
/// # Errors
/// The first thing wrong with the text, with its place.
pub fn read_str(text: &str, format: Format, name: &str) -> Result<Scene, SceneError> {
    resolve(&Document::read_str(text, format, name)?)
}
