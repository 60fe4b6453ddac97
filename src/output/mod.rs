//! What a run leaves behind: results folders, plots, case packs, and the comparison of two results.
//!
//! - [`series`]: tables of numbers with named columns and units, as `.csv` and `.npy`
//! - [`results`], [`assembly_results`]: the results folder of one static solution
//! - [`session`]: a run of whatever moves; [`recorder`] keeps its rows, [`mod@state`] is what it resumes from,
//!   [`table`] and [`summary`] say what came of it
//! - [`fields`]: a solid as ParaView opens it
//! - [`warnings`]: codes of warnings, and the warnings on solids
//! - [`pictures`]: plots of a run; [`plots`]: SVG pictures from plain data
//! - [`folder`]: who may write into a results folder, and over what
//! - [`json`], [`npy`]: readers that take what a file promises for no more than it is
//! - [`journal`]: how the file of a state is read and written
//! - [`mod@spectrum`]: amplitude spectra of time series
//! - [`compare`]: where does a candidate depart from a reference, and by how much
//! - [`visible`]: texts of files made fit for a terminal; [`amounts`]: memory as people write it
//! - [`pack`]: a scene with its expected results, tolerances and hashes
//!
//! # The folder of a run
//!
//! | file | content |
//! |---|---|
//! | `summary.json` | every scalar as `{"value", "unit"}`; written last |
//! | `series.csv`, `series.npy`, `series.columns.json` | one row an output interval |
//! | `spectrum.csv` | amplitude spectra, where they were asked for |
//! | `bore.csv` | of a housing: one row a node of the bore |
//! | `fields.pvd`, `fields/*.vtu` | of a solid: displacement, stress, contact force over time |
//! | `*.svg` | the plots that were asked for |
//! | `state.json`, `state-N.npy` | what the run goes on from |
//!
//! Lengths in m, loads in N, angles in degrees, speeds in rad/s.
pub mod amounts;
pub mod assembly_results;
pub mod atomic;
pub mod compare;
pub mod fields;
pub mod folder;
pub mod journal;
pub mod json;
pub mod natural_motions;
pub mod npy;
pub mod pack;
pub mod pictures;
pub mod plots;
pub mod recorder;
pub mod results;
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
