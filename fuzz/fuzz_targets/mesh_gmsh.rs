//! No bytes may make the reader of Gmsh files panic or take memory out of proportion.
#![no_main]

use bearing_dynamics::mesh::check::{Limits, faults};
use bearing_dynamics::mesh::read::{LengthUnit, read_gmsh};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read_gmsh(bytes, LengthUnit::Millimetre) {
        Ok(loaded) => {
            assert!(loaded.mesh.nodes.len() <= bytes.len());
            faults(&loaded.mesh, &Limits::default());
        }
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
});
