//! No bytes may make the reader of NumPy tables panic or take memory out of proportion.
#![no_main]

use bearing_dynamics::output::npy::parse;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match parse(bytes) {
        Ok(table) => assert!(4 * table.len() <= bytes.len()),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
