//! Results: folders, tables, plots, case packs, and the comparison of two results.
//!
//! - [`series`]: tables of numbers with named columns and units, as `.csv` and `.npy`
//! - [`results`], [`assembly_results`]: results folder of a static solution
//! - [`session`]: execution of a transient or quasi-static run; [`recorder`]: its time series; [`mod@state`]: its
//!   restart files; [`table`] and [`summary`]: its evaluation
//! - [`ensemble`]: statistics of many runs and their spread
//! - [`fields`]: fields of a solid for ParaView
//! - [`warnings`]: codes of warnings, and the warnings on solids
//! - [`pictures`]: plots of a run; [`plots`]: SVG pictures from plain data
//! - [`folder`]: exclusive access to a results folder
//! - [`json`], [`npy`]: file readers with limits on memory
//! - [`mod@spectrum`]: amplitude spectra of time series
//! - [`compare`]: comparison of a candidate with a reference
//! - [`visible`]: escaping of text for a terminal; [`amounts`]: memory sizes as text
//! - [`pack`]: a scene with its expected results, tolerances and hashes
//!
//! # The folder of a run
//!
//! | file | content |
//! |---|---|
//! | `summary.json` | every scalar as `{"value", "unit"}`; written last |
//! | `series.csv`, `series.npy`, `series.columns.json` | one row per output interval |
//! | `spectrum.csv` | amplitude spectra, if requested |
//! | `spectrum_NAME.csv` | spectrum of a channel with a sampling rate of its own |
//! | `bore.csv` | for a housing: one row per node of the bore |
//! | `fields.pvd`, `fields/*.vtu` | for a solid: displacement, stress, contact force over time |
//! | `*.svg` | the requested plots |
//! | `state.json` | the state to resume from |
//!
//! Lengths in m, loads in N, angles in degrees, speeds in rad/s.
pub mod acquisition;
pub mod amounts;
pub mod assembly_results;
pub mod atomic;
pub mod compare;
pub mod defect_lines;
pub mod ensemble;
pub mod fields;
pub mod folder;
pub mod json;
pub mod natural_modes;
pub mod npy;
pub mod pack;
pub mod pictures;
pub mod plots;
pub mod recorder;
pub mod results;
pub mod run_up;
pub mod series;
pub mod session;
pub mod spectrum;
pub mod state;
pub mod summary;
pub mod table;
pub mod visible;
pub mod warnings;

pub use atomic::{WriteError, write_atomic};
pub use series::{Column, Series, SeriesError};
