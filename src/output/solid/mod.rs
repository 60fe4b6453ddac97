//! What a solid by itself leaves behind: fields, series, summaries, and a run that resumes.
//!
//! | file | content |
//! |---|---|
//! | `summary.json` | every scalar as `{"value", "unit"}`; written last |
//! | `series.csv`, `series.npy`, `series.columns.json` | one row an output interval, or a mode |
//! | `fields.pvd`, `fields/*.vtu` | displacements and stresses over time, or a file a mode |
//! | `*.svg` | energies, probes, spectra |
//! | `state.json`, `state-N.npy` | what a run goes on from |
pub mod fields;
pub mod pictures;
pub mod remarks;
pub mod session;
pub mod state;
pub mod summary;
