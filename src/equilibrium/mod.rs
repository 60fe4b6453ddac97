//! Static equilibrium of an assembly: the search, its start, its result, and quasi-static sequences.

pub mod bearing;
pub mod bearing_tables;
pub mod connection;
pub mod error;
pub mod exact_gap_iteration;
pub mod follower_loads;
pub mod housing_fit;
pub mod initial;
pub mod lists;
pub mod model;
pub mod plan;
pub mod quasi_static_limit;
pub mod quasi_static_sequence;
pub mod search;
pub mod sections;
pub mod shaft;
pub mod start;
pub mod statics;
pub mod verdict;
pub mod warm_started_search;
