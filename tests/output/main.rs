//! Results: files, plots, comparison.

#[path = "../common/mod.rs"]
mod common;
#[path = "../output_common/mod.rs"]
mod output_common;

mod compare_finds;
mod compare_npy;
mod compare_tolerances;
mod output_files;
mod output_plots;
mod run_up;
mod small_laws;
mod spectrum_laws;
