//! Single functions of the verification crate, and its oracles against what is known of them.

mod case_oracles;
mod oracles;
mod pareto;
mod published_file;
mod solids;
