//! Scenes: TOML or JSON files that describe bearings or a solid, and their conversion to SI data.
//!
//! [`text`] (files, tree of values with positions, units) → [`Document`] (given keys, checked against [`tables`]) →
//! [`Scene`] (SI, validated, every default named; [`mod@resolve`]) → lists and meshes for the solver ([`build`]).
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
pub mod build;
pub mod error;
pub mod resolve;
pub mod tables;
pub mod text;

pub use error::{Place, Problem, SceneError};
pub use resolve::bearing::resolve;
pub use resolve::housing_scene::HousedScene;
pub use resolve::resolved::{
    Assumption, Cage, CageInRun, CageMethod, DefaultUsed, Dimensions, Dynamics, Plot,
    RaceDimensions, RunPlot, RunSettings, Scene,
};
pub use resolve::solid::resolve_subject;
pub use resolve::solid_mesh::{KEY_OF_DIMENSION, key_of_dimension};
pub use resolve::solid_scene::{SolidScene, Subject};
pub use tables::schema::json_schema;
pub use text::document::Document;
pub use text::source::{Format, LARGEST_FILE};
pub use text::sweep::{SweepAxis, SweepValues};

use std::path::Path;

/// Reads a scene file of any kind: bearings with bodies and housings, or a solid by itself.
///
/// # Errors
/// The first error of the file or its contents, with its position. The solid's mesh is read later, by
/// [`build::solid_mesh::build`].
pub fn read_subject(path: &Path) -> Result<Subject, SceneError> {
    resolve_subject(&Document::read_file(path)?)
}

/// Reads a scene file with a bearing; the extension (`.toml`, `.json`) determines the format.
///
/// # Errors
/// The first error of the file or its contents, with its position.
pub fn read_file(path: &Path) -> Result<Scene, SceneError> {
    resolve(&Document::read_file(path)?)
}

/// Reads a scene with a bearing from text; messages use `name` as the file name.
///
/// # Errors
/// The first error of the text, with its position.
pub fn read_str(text: &str, format: Format, name: &str) -> Result<Scene, SceneError> {
    resolve(&Document::read_str(text, format, name)?)
}
