//! A seeded fuzzer on what `compare` reads from other programs: `.npy` tables, the names of their
//! columns, summaries and tolerances.
//!
//! No input may panic or take memory out of proportion; each gives a comparison, or one error.
//! `RESULTS_FUZZ_INPUTS=1000000 cargo test --release --test results_fuzz` runs a million. All in one
//! test, so that the memory of the process is that of the readers.

mod fuzz_common;
#[allow(dead_code)]
mod output_common;

use bearing_dynamics::output::compare::{Options, compare, report, to_json};
use bearing_dynamics::output::json::MOST_VALUES;
use bearing_dynamics::output::results::write_static_results;
use fuzz_common::Random;
use std::fs;
use std::panic::catch_unwind;
use std::path::Path;

const USUAL_INPUTS: usize = 1_500;
const SEED: u64 = 0x0f11_e5f0_5eed_0001;

/// What the process may take at most, bytes; it is told by Linux alone.
const MOST_MEMORY: u64 = 256 << 20;

const NPY_WORDS: &[&[u8]] = &[
    b"\xff\xff\xff\xff",
    b"\x00\x00\x00\x00",
    b"\x01\x00",
    b"\x02\x00",
    b"\x03\x00",
    b"\x93NUMPY",
    b"(((((((((((((((((((((((((((((((((((((((((",
    b"{'a': {'a': {'a': ",
    b"(0, 4611686018427387904)",
    b"(18446744073709551615, 8)",
    b"(2, 3, 4)",
    b"()",
    b"(7,)",
    b"'<f4'",
    b"'>f8'",
    b"'|O'",
    b"True",
    b"'shape': ",
    b"}",
    b",",
    b"-1",
    b"\x00\x00\x00\x00\x00\x00\xf0\x7f",
];

const JSON_WORDS: &[&[u8]] = &[
    b"[",
    b"{",
    b"]",
    b"}",
    b",",
    b":",
    b"\"",
    b"null",
    b"1e400",
    b"-0",
    b"18446744073709551616",
    b"{\"value\": null, \"unit\": \"m\"}",
    b"{\"value\": 1e308, \"unit\": \"N m\"}",
    b"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
    b"{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":",
    b"\"balls\": [",
    b"\"channels\": {",
    b"\"class\": \"ignored\"",
    b"\\u001b[2J",
    b"\\ud800",
    b"\xf0\x9f",
    b"\x00",
];

fn mutate(random: &mut Random, bytes: &mut Vec<u8>, words: &[&[u8]]) {
    for _ in 0..1 + random.below(2) {
        let at = random.below(bytes.len());
        let to = (at + 1 + random.below(40)).min(bytes.len());
        match random.below(9) {
            0 => bytes.truncate(at),
            1 => {
                bytes.drain(at..to);
            }
            2 if at < bytes.len() => bytes[at] = random.next() as u8,
            // Another number: what follows is compared.
            3 => {
                if let Some(digit) = bytes[at..].iter().position(u8::is_ascii_digit) {
                    bytes[at + digit] = b'0' + random.below(10) as u8;
                }
            }
            4 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            5 => {
                let word = words[random.below(words.len())];
                bytes.splice(at..at, word.iter().copied());
            }
            6 => {
                let word = words[random.below(words.len())];
                bytes.splice(at..to, word.iter().copied());
            }
            // Now and then a part is repeated until it is large.
            7 if random.below(500) == 0 => {
                let copies = bytes[at..to].repeat((1 << 20) / (to - at).max(1));
                bytes.splice(at..at, copies);
            }
            _ => {
                let copy = bytes[at..to].to_vec();
                let place = random.below(bytes.len());
                bytes.splice(place..place, copy);
            }
        }
    }
}

/// Whether the two could be compared.
fn run(reference: &Path, candidate: &Path) -> bool {
    match compare(reference, candidate, &Options::default()) {
        Ok(comparison) => {
            let text = report(&comparison);
            assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text:?}");
            assert!(to_json(&comparison).is_object());
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// Largest memory that the process has taken so far, bytes; 0 where the system does not tell.
fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes =
        line.and_then(|rest| rest.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok());
    1024 * kilobytes.unwrap_or(0)
}

/// Files that take as much memory as the limits let them.
fn largest(file: &Path) {
    const HALF: usize = MOST_VALUES / 2 - 2;
    let list = |part: &str, count: usize| format!("[{}0]", part.repeat(count));
    let nested = format!("{}0{},", "[".repeat(120), "]".repeat(120));
    for case in 0.. {
        // Made one after the other, so that they do not count as memory of the readers.
        let text = match case {
            0 => list("0,", 2 * HALF),
            1 => list("\"\",", 2 * HALF),
            2 => list("[0],", HALF),
            3 => list("{\"\":0},", HALF),
            4 => list("{\"value\":0,\"unit\":\"m\"},", HALF / 2),
            5 => list("0,", 7 << 20),
            6 => format!("{{\"{}\": {}}}", "n".repeat(1 << 20), list("0,", HALF)),
            7 => format!("\"{}\"", "x".repeat((16 << 20) - 2)),
            8 => list(&nested, MOST_VALUES / 121 - 1),
            _ => break,
        };
        fs::write(file, text).unwrap();
        run(file, file);
    }
    // As large as a summary that once took 3.9 GB.
    fs::File::create(file).and_then(|file| file.set_len(225 << 20)).unwrap();
    assert!(!run(file, file));
}

#[test]
fn no_results_panic_or_take_much_memory() {
    let inputs = std::env::var("RESULTS_FUZZ_INPUTS").ok().and_then(|n| n.parse().ok());
    let inputs = inputs.unwrap_or(USUAL_INPUTS);
    // In memory where there is such a place: a disk would take most of the time.
    let memory = Path::new("/dev/shm");
    let root = match memory.is_dir() {
        true => tempfile::tempdir_in(memory),
        false => tempfile::tempdir(),
    }
    .unwrap();
    let [reference, candidate] = ["reference", "candidate"].map(|name| root.path().join(name));
    let (solution, record) = (output_common::solution(), output_common::run());
    for folder in [&reference, &candidate] {
        write_static_results(folder, &solution, &record).unwrap();
    }
    let tolerances = br#"{"class": "mixed", "channels": {"balls": {"relative": 1e-6}}}"#;
    let small =
        br#"{"kind": "run", "balls": [{"load": {"value": 1.5, "unit": "N"}}, 3, "a", null]}"#;
    let read = |name: &str| fs::read(candidate.join(name)).unwrap();
    let corpus = [
        ("series.npy", read("series.npy"), NPY_WORDS),
        ("series.npy", read("series.npy")[..136 + 64].to_vec(), NPY_WORDS),
        ("series.columns.json", read("series.columns.json"), JSON_WORDS),
        ("summary.json", read("summary.json"), JSON_WORDS),
        ("summary.json", small.to_vec(), JSON_WORDS),
        ("summary.json", small.to_vec(), JSON_WORDS),
        ("tolerances.json", tolerances.to_vec(), JSON_WORDS),
    ];
    assert!(run(&reference, &candidate), "the files are compared before they are spoilt");
    let mut random = Random(SEED);
    let mut compared = 0;
    for input in 0..inputs {
        let (name, whole, words) = &corpus[random.below(corpus.len())];
        let mut bytes = whole.clone();
        mutate(&mut random, &mut bytes, words);
        // In the reference or in the candidate; tolerances and names count with the table beside them.
        let (spoilt, other) = match *name == "tolerances.json" || random.below(2) == 0 {
            true => (&reference, &candidate),
            false => (&candidate, &reference),
        };
        let file = spoilt.join(name);
        let before = fs::read(&file).ok();
        fs::write(&file, &bytes).unwrap();
        let table = name.replace("columns.json", "npy");
        let pair = match *name {
            "tolerances.json" => [spoilt.clone(), other.clone()],
            _ if spoilt == &reference => [spoilt.join(&table), other.join(&table)],
            _ => [other.join(&table), spoilt.join(&table)],
        };
        match catch_unwind(|| run(&pair[0], &pair[1])) {
            Ok(was_compared) => compared += usize::from(was_compared),
            Err(_) => {
                panic!("input {input}, {name}, panicked: {:?}", String::from_utf8_lossy(&bytes))
            }
        }
        match before {
            Some(before) => fs::write(&file, before).unwrap(),
            None => fs::remove_file(&file).unwrap(),
        }
    }
    let fuzzed = peak_memory();
    largest(&root.path().join("largest.json"));
    println!(
        "{compared} of {inputs} compared; {} MB at most, {} MB with the largest files that are read",
        fuzzed >> 20,
        peak_memory() >> 20
    );
    // Mutations must be neither too wild nor too tame to test anything.
    assert!(compared * 100 > 5 * inputs && compared * 100 < 90 * inputs, "{compared} of {inputs}");
    assert!(peak_memory() <= MOST_MEMORY, "{} MB", peak_memory() >> 20);
}
