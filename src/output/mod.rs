//! What a run leaves behind: results folders, plots, case packs, and the comparison of two results.
//!
//! - [`series`]: tables of numbers with named columns and units, as `.csv` and `.npy`
//! - [`results`]: the results folder of one static solution
//! - [`plots`]: SVG pictures from plain data
//! - [`compare`]: where does a candidate depart from a reference, and by how much
//! - [`pack`]: a scene with its expected results, tolerances and hashes
pub mod atomic;
pub mod compare;
pub mod pack;
pub mod plots;
pub mod results;
pub mod series;

pub use atomic::{WriteError, write_atomic};
pub use series::{Column, Series, SeriesError};
