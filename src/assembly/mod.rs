//! The lists that make an assembly: bodies, bearings, connections, loads, state layout, plan and counts.

pub mod channels;
pub mod ledger_watch;
pub mod lists;
pub mod loads;
pub mod mount;
pub mod plan;
pub mod state;
pub mod static_lists;
