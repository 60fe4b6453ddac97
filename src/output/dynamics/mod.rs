//! A run: steps, rows of its time series, and the results folder it leaves.
//!
//! | file | content |
//! |---|---|
//! | `summary.json` | every scalar as `{"value", "unit"}`; written last |
//! | `series.csv`, `series.npy`, `series.columns.json` | one row an output interval |
//! | `spectrum.csv` | amplitude spectra, where they were asked for |
//! | `*.svg` | the plots that were asked for |
//! | `state.json` | what the run goes on from; see [`crate::output::state`] |
//!
//! Lengths in m, loads in N, angles in degrees, speeds in rad/s.
pub mod pictures;
pub mod recorder;
pub mod session;
pub mod summary;
pub mod table;
