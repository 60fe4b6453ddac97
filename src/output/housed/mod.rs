//! What a bearing in a flexible housing leaves behind, by equilibria or by explicit steps.
//!
//! | file | content |
//! |---|---|
//! | `summary.json` | every scalar as `{"value", "unit"}`; written last |
//! | `series.csv`, `series.npy`, `series.columns.json` | one row an output interval; of statics one row a ball |
//! | `bore.csv` | one row a node of the bore: place, penetration, load, pressure |
//! | `fields.pvd`, `fields/*.vtu` | displacement, stress and contact force of the housing |
//! | `*.svg` | the plots that were asked for |
//! | `state.json`, `state-N.npy` | of explicit steps: what the run goes on from |
pub mod course;
pub mod fields;
pub mod rows;
pub mod session;
pub mod state;
pub mod summary;
