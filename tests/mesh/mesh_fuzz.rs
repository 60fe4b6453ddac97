//! A seeded fuzzer on the mesh readers that needs no tools: files that Gmsh wrote, mutated.
//!
//! No input may panic or take memory out of proportion; each gives a mesh that can be checked and
//! written, or one error of one line. `MESH_FUZZ_INPUTS=1000000 cargo test --release --test
//! mesh_fuzz` runs a million.

use crate::fuzz_common;

use bearing_dynamics::mesh::check::{Limits, faults};
use bearing_dynamics::mesh::quality::quality;
use bearing_dynamics::mesh::read::{LengthUnit, read_abaqus, read_gmsh};
use bearing_dynamics::mesh::repair::{Repair, repair};
use bearing_dynamics::mesh::write::write_vtu;
use fuzz_common::Random;
use std::fs;
use std::panic::catch_unwind;
use std::path::PathBuf;

const USUAL_INPUTS: usize = 2_000;
const SEED: u64 = 0x3e54_f11e_5eed_0001;

const WORDS: &[&str] = &[
    "0",
    "-1",
    "1",
    "4",
    "11",
    "15",
    "99",
    "2000000000",
    "18446744073709551615",
    "-9223372036854775808",
    "1e308",
    "1e-308",
    "nan",
    "inf",
    "$End",
    "$Nodes\n",
    "$EndNodes\n",
    "$Elements\n",
    "$Entities\n",
    "$PhysicalNames\n",
    "*",
    "**",
    "*ELEMENT, TYPE=C3D10, ELSET=a\n",
    "*NSET, NSET=b, GENERATE\n",
    "*ELSET, ELSET=clamped\n",
    "*SURFACE, NAME=s\n",
    "1, 4000000000, 1\n",
    ",",
    "\n",
    "\"",
    " ",
    "\u{0}",
    "\u{fc}",
];

fn mutate(random: &mut Random, bytes: &mut Vec<u8>) {
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len());
        let to = (at + 1 + random.below(40)).min(bytes.len());
        match random.below(7) {
            0 => bytes.truncate(at),
            1 => {
                bytes.drain(at..to);
            }
            2 if at < bytes.len() => bytes[at] = random.next() as u8,
            3 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            4 => {
                let word = WORDS[random.below(WORDS.len())].bytes();
                bytes.splice(at..at, word);
            }
            5 => {
                let word = WORDS[random.below(WORDS.len())].bytes();
                bytes.splice(at..to, word);
            }
            _ => {
                let copy = bytes[at..to].to_vec();
                let place = random.below(bytes.len());
                bytes.splice(place..place, copy);
            }
        }
    }
}

fn corpus() -> Vec<Vec<u8>> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the folder of mesh files")
        .map(|entry| entry.expect("a file").path())
        .filter(|path| {
            path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("box"))
        })
        .collect();
    paths.sort();
    assert_eq!(paths.len(), 10);
    paths.iter().map(|path| fs::read(path).expect("a readable file")).collect()
}

/// Whether the bytes gave a mesh.
fn run(bytes: &[u8]) -> bool {
    let mut read = false;
    for reader in [read_gmsh, read_abaqus] {
        match reader(bytes, LengthUnit::Millimetre) {
            Ok(loaded) => {
                read = true;
                assert!(
                    loaded.mesh.nodes.len() <= bytes.len()
                        && quality(&loaded.mesh).element_count > 0
                );
                for fault in faults(&loaded.mesh, &Limits::default()) {
                    assert!(!fault.to_string().contains('\n'));
                }
                assert!(write_vtu(&loaded.mesh, &[], &[]).is_ok());
                let all =
                    Repair { orient: true, merge_duplicates: Some(1e-6), drop_unreferenced: true };
                if let Ok((mesh, _)) = repair(loaded.mesh, &all) {
                    assert!(!mesh.elements.is_empty());
                }
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{error:?}"),
        }
    }
    read
}

#[test]
fn no_bytes_panic() {
    let inputs = std::env::var("MESH_FUZZ_INPUTS").ok().and_then(|n| n.parse().ok());
    let corpus = corpus();
    assert!(corpus.iter().all(|bytes| run(bytes)), "every file is read before it is spoilt");
    let mut random = Random(SEED);
    let mut read = 0;
    let inputs = inputs.unwrap_or(USUAL_INPUTS);
    for input in 0..inputs {
        let mut bytes = corpus[random.below(corpus.len())].clone();
        mutate(&mut random, &mut bytes);
        match catch_unwind(|| run(&bytes)) {
            Ok(was_read) => read += usize::from(was_read),
            Err(_) => panic!("input {input} panicked: {:?}", String::from_utf8_lossy(&bytes)),
        }
    }
    // Mutations must be neither too wild nor too tame to test anything.
    assert!(read * 100 > inputs && read * 100 < 90 * inputs, "{read} of {inputs} gave a mesh");
}
