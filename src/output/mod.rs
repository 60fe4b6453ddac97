//! What a run leaves behind: results folders, plots, case packs, and the comparison of two results.
//!
//! - [`series`]: tables of numbers with named columns and units, as `.csv` and `.npy`
//! - [`results`]: the results folder of one static solution
//! - [`dynamics`]: a run, its time series, its results folder, and [`mod@state`] to resume it from
//! - [`solid`]: fields, series and runs of a flexible solid by itself
//! - [`housed`]: a bearing in a flexible housing
//! - [`journal`]: what the states of both kinds of runs share
//! - [`mod@spectrum`]: amplitude spectra of time series
//! - [`plots`]: SVG pictures from plain data
//! - [`compare`]: where does a candidate depart from a reference, and by how much
//! - [`pack`]: a scene with its expected results, tolerances and hashes
pub mod atomic;
pub mod compare;
pub mod dynamics;
pub mod housed;
pub mod journal;
pub mod pack;
pub mod plots;
pub mod results;
pub mod series;
pub mod solid;
pub mod spectrum;
pub mod state;

pub use atomic::{WriteError, write_atomic};
pub use series::{Column, Series, SeriesError};
