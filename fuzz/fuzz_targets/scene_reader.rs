//! No bytes may make the scene reader panic, in either format.
#![no_main]

use bearing_dynamics::scene;
use bearing_dynamics::scene::{Document, Format};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for format in [Format::Toml, Format::Json] {
        match Document::read_bytes(bytes.to_vec(), format, "fuzz") {
            Ok(document) => match scene::resolve(&document) {
                Ok(scene) => assert!(scene.geometry.ball_radius > 0.0),
                Err(error) => assert!(!error.to_string().contains('\n')),
            },
            Err(error) => assert!(!error.to_string().contains('\n')),
        }
    }
});
