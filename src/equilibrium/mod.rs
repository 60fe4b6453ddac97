//! Static equilibrium of an assembly: the search, its start, its result, and quasi-static sequences.

pub mod bearing_tables;
pub mod error;
pub mod exact_gap_iteration;
pub mod follower_loads;
pub mod initial;
pub mod model;
pub mod quasi_static_sequence;
pub mod search;
pub mod sections;
pub mod start;
pub mod statics;
pub mod verdict;
pub mod warm_started_search;
