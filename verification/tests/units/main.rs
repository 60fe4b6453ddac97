//! Single functions of the verification crate, and its oracles against what is known of them.

mod case_oracles;
mod date;
mod oracles;
mod pareto;
mod pictures;
mod published_file;
mod report_format;
mod solids;
mod studies;
