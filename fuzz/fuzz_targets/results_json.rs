//! No bytes may make the reader of summaries panic or take memory out of proportion.
#![no_main]

use bearing_dynamics::output::compare::channels::leaves;
use bearing_dynamics::output::json::{MOST_VALUES, parse};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(tree) = parse(bytes) {
        assert!(leaves(&tree).is_none_or(|leaves| leaves.len() <= MOST_VALUES));
    }
});
