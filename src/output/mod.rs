//! What a run leaves behind: results folders, plots, case packs, and the comparison of two results.
//!
//! - [`series`]: tables of numbers with named columns and units, as `.csv` and `.npy`
//! - [`results`]: the results folder of one static solution
//! - [`dynamics`]: a run, its time series, its results folder, and [`mod@state`] to resume it from
//! - [`solid`]: fields, series and runs of a flexible solid by itself
//! - [`housed`]: a bearing in a flexible housing
//! - [`folder`]: who may write into a results folder, and over what
//! - [`json`], [`npy`]: readers that take what a file promises for no more than it is
//! - [`journal`]: what the states of both kinds of runs share
//! - [`mod@spectrum`]: amplitude spectra of time series
//! - [`plots`]: SVG pictures from plain data
//! - [`compare`]: where does a candidate depart from a reference, and by how much
//! - [`visible`]: texts of files made fit for a terminal
//! - [`pack`]: a scene with its expected results, tolerances and hashes
pub mod atomic;
pub mod compare;
pub mod dynamics;
pub mod folder;
pub mod housed;
pub mod journal;
pub mod json;
pub mod npy;
pub mod pack;
pub mod plots;
pub mod results;
pub mod series;
pub mod solid;
pub mod spectrum;
pub mod state;
pub mod visible;

pub use atomic::{WriteError, write_atomic};
pub use series::{Column, Series, SeriesError};
