//! A seeded fuzzer on the scene reader that needs no tools: shipped scenes, mutated, in both formats.
//!
//! No input may panic; each either resolves to a scene of usable numbers or gives one error that
//! names the file. `SCENE_FUZZ_INPUTS=1000000 cargo test --release --test scene scene_fuzz` runs a million.

use crate::fuzz_common;

use bearing_dynamics::ch2_housing::bearing::traction::coefficient;
use bearing_dynamics::members::body::{Condition, Drive, Rotation};
use bearing_dynamics::motion::simulation::Stepping;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::scene;
use bearing_dynamics::scene::build::motion::{dynamic_problem, run_options};
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::tables::keys::Kind;
use bearing_dynamics::scene::text::units::Dimension;
use bearing_dynamics::scene::{Document, Format, Scene, SceneError};
use fuzz_common::Random;
use std::collections::HashSet;
use std::panic::catch_unwind;

const USUAL_INPUTS: usize = 5_000;
const SEED: u64 = 0x5ce2_e5ee_d000_0001;

/// Numbers at the edges of doubles, integers, ranges and syntax.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "8",
    "3",
    "200",
    "201",
    "1e308",
    "-1e308",
    "1e309",
    "5e-324",
    "1e-400",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "9223372036854775808",
    "0x7fff",
    "1_000",
    "0.5",
    "0.499999999999999999",
    "1.",
    ".5",
    "+3",
    "--3",
    "1e",
    "1e+",
    "1e99999999999999999999",
    "1e-99999999999999999999",
    "\u{2212}5",
    "5,953",
    "00012",
    "5.955",
    "20.047",
    "1979-05-27",
];

const FRAGMENTS: &[&str] = &[
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "\"\"\"",
    "'''",
    "=",
    ".",
    ",",
    ":",
    "\n",
    "\r\n",
    "\t",
    "#",
    "\\",
    "\\u0000",
    "\\uD800",
    "\\UFFFFFFFF",
    "\u{0}",
    "\u{feff}",
    "\u{2028}",
    "\u{1F980}",
    "[[",
    "]]",
    "//",
    "/*",
    "null",
    "true",
    "false",
    " .. ",
    "..",
    "/ 5",
    "/ 10000001",
    "a.b.c",
    "\"a b\" = 1",
    "= {}",
    "= []",
];

/// Profiles, whole and in pieces, in both formats.
const PROFILES: &[&str] = &[
    "{ ramp = [\"0 N\", \"250 N\"], start = \"0 s\", duration = \"0.1 s\" }",
    "{ smooth_ramp = [\"0 rpm\", \"1000 rpm\"], duration = \"0.1 s\" }",
    "{ table = [[\"0 s\", \"0 N\"], [\"0.1 s\", \"250 N\"]] }",
    "{ mean = \"0 N\", amplitude = \"10 N\", frequency = \"50 Hz\", phase = \"0 deg\" }",
    "{ half_sine = \"500 N\", base = \"0 N\", start = \"0.01 s\", duration = \"5 ms\" }",
    "{ \"ramp\": [\"0 N\", \"250 N\"], \"duration\": \"1 ms\" }",
    "{ \"table\": [[\"0 s\", \"0 m/s\"], [\"1 s\", \"1 deg\"]] }",
    "[[\"0 m/s\", 0.0], [\"0.1 m/s\", 0.05]]",
    "ramp",
    "smooth_ramp",
    "table",
    "amplitude",
    "half_sine",
    "duration",
    "start",
    "frequency",
];

/// Pieces a mutation may put in: keys, words and units the reader knows.
fn vocabulary() -> Vec<String> {
    let mut words = HashSet::new();
    for key in keys::KEYS {
        words.insert(key.path.to_string());
        words.extend(key.path.split('.').map(str::to_string));
        words.insert(format!("\n{} = {}\n", key.path, key.example()));
    }
    words.extend(keys::TABLES.iter().map(|table| match table.list {
        true => format!("\n[[{}]]\n", table.path),
        false => format!("\n[{}]\n", table.path),
    }));
    for key in keys::KEYS {
        if let Kind::Choice(list) | Kind::Choices(list) = key.kind {
            words.extend(list.iter().map(|word| format!("\"{word}\"")));
        }
    }
    for profile in PROFILES {
        words.insert(profile.to_string());
    }
    for dimension in Dimension::ALL {
        for unit in dimension.units() {
            words.extend(unit.spellings.iter().map(|spelling| spelling.to_string()));
        }
    }
    let mut words: Vec<String> = words.into_iter().collect();
    words.sort();
    words
}

/// Every shipped scene; a JSON one is also a seed for the TOML reader and the other way round.
fn seeds() -> Vec<(String, Format)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    // To read a bushing is to solve its vibrations, up to seconds for a thousand cells.
    paths.retain(|path| path.is_file() && !path.ends_with("bearing_on_bushing.toml"));
    paths.sort();
    let mut seeds = Vec::new();
    for path in paths {
        let text = std::fs::read_to_string(&path).unwrap();
        if path.extension().is_some_and(|extension| extension == "json") {
            seeds.push((text, Format::Json));
        } else {
            let value: serde_json::Value = toml::from_str(&text).unwrap();
            seeds.push((serde_json::to_string_pretty(&value).unwrap(), Format::Json));
            seeds.push((text, Format::Toml));
        }
    }
    assert!(seeds.len() >= 9);
    seeds
}

/// Start and end of a random run of bytes that are all digits and dots, or all letters.
fn token(random: &mut Random, bytes: &[u8]) -> (usize, usize) {
    if bytes.is_empty() {
        return (0, 0);
    }
    let class = |byte: u8| match byte {
        b'0'..=b'9' | b'.' | b'-' | b'+' => 1,
        b'a'..=b'z' | b'A'..=b'Z' | b'_' => 2,
        b' ' | b'\n' => 3,
        _ => 4,
    };
    let at = random.below(bytes.len());
    let wanted = class(bytes[at]);
    let start = bytes[..at].iter().rposition(|&b| class(b) != wanted).map_or(0, |i| i + 1);
    let end = bytes[at..].iter().position(|&b| class(b) != wanted).map_or(bytes.len(), |i| at + i);
    (start, end)
}

/// Start and end of a random line, with its newline.
fn line(random: &mut Random, bytes: &[u8]) -> (usize, usize) {
    if bytes.is_empty() {
        return (0, 0);
    }
    let at = random.below(bytes.len());
    let start = bytes[..at].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
    let end = bytes[at..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |i| at + i + 1);
    (start, end)
}

fn number_token(random: &mut Random, bytes: &[u8]) -> (usize, usize) {
    for _ in 0..20 {
        let (start, end) = token(random, bytes);
        if bytes.get(start).is_some_and(u8::is_ascii_digit) {
            return (start, end);
        }
    }
    token(random, bytes)
}

/// Applies one random change.
fn mutate(random: &mut Random, bytes: &mut Vec<u8>, words: &[String], seeds: &[(String, Format)]) {
    let at = random.below(bytes.len() + 1);
    match random.below(12) {
        0 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        1 => bytes.insert(at, random.below(256) as u8),
        2 => bytes.truncate(at),
        3 => {
            let (start, end) = number_token(random, bytes);
            bytes.splice(start..end, random.pick(NUMBERS).bytes());
        }
        4 => {
            let (start, end) = token(random, bytes);
            let word = words[random.below(words.len())].clone();
            bytes.splice(start..end, word.into_bytes());
        }
        5 => {
            bytes.splice(at..at, random.pick(FRAGMENTS).bytes());
        }
        6 => {
            let (start, end) = line(random, bytes);
            bytes.drain(start..end);
        }
        7 => {
            let (start, end) = line(random, bytes);
            let copy = bytes[start..end].to_vec();
            let (to, _) = line(random, bytes);
            bytes.splice(to..to, copy);
        }
        8 => {
            let (start, end) = token(random, bytes);
            bytes.drain(start..end);
        }
        9 => {
            let depth = 1 << random.below(12);
            let bracket = random.pick(&["[", "{", "{\"a\":", "a.", "\n[a", "a={", "[["]);
            bytes.splice(at..at, bracket.repeat(depth).into_bytes());
        }
        10 => {
            let (other, _) = &seeds[random.below(seeds.len())];
            let (start, end) = line(random, other.as_bytes());
            let (to, _) = line(random, bytes);
            bytes.splice(to..to, other.as_bytes()[start..end].to_vec());
        }
        _ => {
            let (a, b) = (number_token(random, bytes), number_token(random, bytes));
            let copy = bytes[a.0..a.1].to_vec();
            bytes.splice(b.0..b.1, copy);
        }
    }
}

/// What must hold for every scene that the reader lets through.
fn check_scene(scene: &Scene) {
    let g = &scene.geometry;
    let material = [scene.inner_material, scene.outer_material, scene.ball_material];
    let numbers = [
        g.ball_radius,
        g.pitch_radius,
        g.inner.centre_radius,
        g.outer.centre_radius,
        g.inner.groove_radius,
        g.outer.groove_radius,
    ];
    let positive =
        numbers.iter().chain(material.iter().flat_map(|m| [&m.youngs_modulus, &m.density]));
    for number in positive {
        assert!(*number > 0.0 && number.is_finite(), "{scene:?}");
    }
    let numbers = [g.inner.centre_axial, g.outer.centre_axial, g.contact_angle, g.radial_clearance];
    let others =
        numbers.iter().chain([&scene.ball_phase]).chain(&scene.outer_race).chain(&scene.gravity);
    assert!(others.copied().all(f64::is_finite), "{scene:?}");
    for condition in scene.conditions {
        let (Condition::Load(value) | Condition::Displacement(value)) = condition;
        assert!(value.is_finite(), "{scene:?}");
    }
    assert!((3..=200).contains(&g.ball_count), "{scene:?}");
    check_motion(scene);
    assert!(g.ball_radius < g.inner.groove_radius && g.ball_radius < g.outer.groove_radius);
    assert!(g.radial_clearance.abs() <= 0.05 * g.ball_radius * 1.06, "{scene:?}");
}

/// What must hold for every run that a scene makes.
fn check_motion(scene: &Scene) {
    let times = [0.0, 1e-3, 1.0, 1e4];
    let finite = |profile: &Profile| times.iter().all(|t| profile.value(*t).is_finite());
    // A bearing whose parts have no mass is refused with a message.
    let Ok(problem) = dynamic_problem(scene) else { return };
    for race in [Some(&problem.inner), problem.outer.as_ref()].into_iter().flatten() {
        let inertia = race.inertia;
        for value in [inertia.mass, inertia.axial, inertia.transverse] {
            assert!(value > 0.0 && value.is_finite(), "{scene:?}");
        }
        for drive in &race.drives {
            let (Drive::Load(profile) | Drive::Motion(profile)) = drive;
            assert!(finite(profile), "{scene:?}");
        }
        let (Rotation::Speed(profile) | Rotation::Torque(profile)) = &race.rotation;
        assert!(finite(profile), "{scene:?}");
        let foundation = race.foundation_stiffness.iter().chain(&race.foundation_damping);
        assert!(foundation.copied().all(|value| value >= 0.0 && value.is_finite()), "{scene:?}");
    }
    if let Some(cage) = &problem.cage {
        assert!(cage.inertia.mass > 0.0 && cage.contacts.length > 0.0, "{scene:?}");
        assert!(cage.contacts.regularisation_speed > 0.0, "{scene:?}");
    }
    for slip in [0.0, 1e-6, 0.1, 1e3] {
        let friction = coefficient(&problem.traction, slip, 1.0);
        assert!((0.0..=2.0 + 1e-12).contains(&friction), "{friction} {scene:?}");
    }
    assert!((1..=201).contains(&problem.slices), "{scene:?}");
    if let Ok(run) = run_options(scene) {
        assert!(run.end > 0.0 && run.window_start < run.end && run.output_interval > 0.0);
        let (Stepping::Fixed(step) | Stepping::FractionOfLimit(step) | Stepping::Accuracy(step)) =
            run.options.stepping;
        assert!(step > 0.0, "{scene:?}");
    }
}

fn check_error(error: &SceneError) {
    let message = error.to_string();
    assert!(message.starts_with("fuzz"), "{message}");
    assert!(message.len() <= 1000 && !message.contains('\n'), "{message}");
}

/// Reads one input and, if it is a scene, runs the ends of its sweep. Says whether it was one.
fn run(random: &mut Random, bytes: &[u8], format: Format, words: &[String]) -> bool {
    let mut document = match Document::read_bytes(bytes.to_vec(), format, "fuzz") {
        Ok(document) => document,
        Err(error) => {
            check_error(&error);
            return false;
        }
    };
    if let Err(error) = scene::resolve_subject(&document) {
        check_error(&error);
    }
    let resolved = scene::resolve(&document);
    match &resolved {
        Ok(scene) => check_scene(scene),
        Err(error) => check_error(error),
    }
    for axis in document.sweep() {
        for index in [0, axis.len() - 1] {
            let value = axis.value(index).expect("the sweep has this value");
            document.set(&axis.key, &value).unwrap_or_else(|error| panic!("{error}"));
        }
    }
    let key = &keys::KEYS[random.below(keys::KEYS.len())];
    let number = random.pick(NUMBERS);
    let value = format!("{number} {}", words[random.below(words.len())]);
    for text in [value.as_str(), number, key.example().trim_matches('"')] {
        if let Err(error) = document.set(key.path, text) {
            check_error(&error);
        }
        let range = format!("{text}..{text}/{number}");
        if let Err(error) = document.axis(key.path, &range) {
            check_error(&error);
        }
    }
    match scene::resolve(&document) {
        Ok(scene) => check_scene(&scene),
        Err(error) => check_error(&error),
    }
    resolved.is_ok()
}

#[test]
fn no_input_makes_the_reader_panic() {
    let inputs = std::env::var("SCENE_FUZZ_INPUTS")
        .map_or(USUAL_INPUTS, |count| count.parse().expect("SCENE_FUZZ_INPUTS is a whole number"));
    let seeds = seeds();
    let words = vocabulary();
    let mut scenes = 0;
    let start = std::time::Instant::now();
    for index in 0..inputs {
        let mut random = Random(SEED.wrapping_add(index as u64));
        let (text, own_format) = &seeds[random.below(seeds.len())];
        // One in sixteen goes to the wrong reader.
        let format = match (random.below(16), own_format) {
            (0, Format::Toml) => Format::Json,
            (0, Format::Json) => Format::Toml,
            (_, format) => *format,
        };
        let mut bytes = text.clone().into_bytes();
        for _ in 0..1 + random.below(4) {
            mutate(&mut random, &mut bytes, &words, &seeds);
        }
        let outcome = catch_unwind(|| run(&mut Random(random.0), &bytes, format, &words));
        match outcome {
            Ok(accepted) => scenes += usize::from(accepted),
            Err(_) => panic!("input {index} ({format:?}):\n{}", String::from_utf8_lossy(&bytes)),
        }
    }
    println!("{inputs} inputs, {scenes} of them scenes, in {:?}", start.elapsed());
    // A fuzzer whose inputs all fail early, or all pass, tests little.
    assert!(scenes * 50 >= inputs && scenes * 2 <= inputs, "{scenes} of {inputs} are scenes");
}
