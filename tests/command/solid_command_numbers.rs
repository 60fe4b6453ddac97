//! Elements and nodes of a mesh file are called by the file's own numbers, repairs are said, and an
//! element turned inside out is no equilibrium.

use crate::solid_command_common;

use serde_json::Value;
use solid_command_common::{
    Place, assert_near, column, command, into_folder, json, number, shipped, stderr, succeed,
};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// A box of cubes of 10 mm in six tetrahedra each, numbered as no program would do it.
struct Deck {
    /// By their numbers, mm.
    nodes: BTreeMap<u64, [f64; 3]>,
    elements: BTreeMap<u64, [u64; 4]>,
}

impl Deck {
    fn new(cells: [u64; 3]) -> Deck {
        let [a, b, c] = cells;
        // Backwards, with gaps.
        let node = |i: u64, j: u64, k: u64| {
            10 + 7 * ((a + 1) * (b + 1) * (c + 1) - ((i * (b + 1) + j) * (c + 1) + k))
        };
        const CUT: [[usize; 4]; 6] =
            [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
        let mut deck = Deck { nodes: BTreeMap::new(), elements: BTreeMap::new() };
        for i in 0..=a {
            for j in 0..=b {
                for k in 0..=c {
                    // A little uneven, so that one element is the fastest.
                    let x = 10.0 * i as f64 + 0.3 * (j as f64 * 1.3 + k as f64 * 2.1).sin();
                    deck.nodes.insert(node(i, j, k), [x, 10.0 * j as f64, 10.0 * k as f64]);
                    if i == a || j == b || k == c {
                        continue;
                    }
                    let corner = [
                        node(i, j, k),
                        node(i + 1, j, k),
                        node(i + 1, j + 1, k),
                        node(i, j + 1, k),
                        node(i, j, k + 1),
                        node(i + 1, j, k + 1),
                        node(i + 1, j + 1, k + 1),
                        node(i, j + 1, k + 1),
                    ];
                    for tet in CUT {
                        let number = 90_000 - 5 * deck.elements.len() as u64;
                        deck.elements.insert(number, tet.map(|n| corner[n]));
                    }
                }
            }
        }
        deck
    }

    fn text(&self) -> String {
        let mut text = "*Node\n".to_string();
        for (number, [x, y, z]) in &self.nodes {
            writeln!(text, "{number}, {x}, {y}, {z}").unwrap();
        }
        text += "*Element, type=C3D4\n";
        for (number, [a, b, c, d]) in &self.elements {
            writeln!(text, "{number}, {a}, {b}, {c}, {d}").unwrap();
        }
        text
    }

    /// m.
    fn centre(&self, element: u64) -> [f64; 3] {
        let corners = self.elements[&element].map(|node| self.nodes[&node]);
        [0, 1, 2].map(|i: usize| corners.iter().map(|at| 0.25e-3 * at[i]).sum())
    }
}

const ENDS: &str = r#"
[[solid.set]]
name = "low"
low = ["-1 mm", "-1 mm", "-1 mm"]
high = ["1 mm", "1 m", "1 m"]
[[solid.set]]
name = "top"
plane = "z"
at = "20 mm"
[[solid.fixed]]
set = "low"
x = true
y = true
z = true
"#;

fn scene(place: &Place, further: &str) -> PathBuf {
    let mesh = "[solid.mesh]\nfile = \"deck.inp\"\nunit = \"mm\"\n";
    place.scene("scene.toml", &format!("{mesh}{further}"))
}

fn pressed(pressure: &str, numerics: &str) -> String {
    format!("{ENDS}[[solid.load]]\nset = \"top\"\npressure = {pressure}\n{numerics}")
}

/// The number after `before`.
fn after(message: &str, before: &str) -> u64 {
    let rest =
        message.split(before).nth(1).unwrap_or_else(|| panic!("{before} is not in {message}"));
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    digits.parse().unwrap_or_else(|_| panic!("no number after {before} in {message}"))
}

/// The first place in metres, `(x, y, z) m`, that stands after `from`.
fn place_after(message: &str, from: &str) -> [f64; 3] {
    let rest = message.split(from).nth(1).unwrap().split('(').nth(1).unwrap();
    let numbers: Vec<f64> =
        rest.split(')').next().unwrap().split(", ").map(|x| x.parse().unwrap()).collect();
    numbers.try_into().unwrap()
}

fn assert_at(found: [f64; 3], expected: [f64; 3], rounding: f64) {
    for i in 0..3 {
        assert!((found[i] - expected[i]).abs() <= rounding, "{found:?} {expected:?}");
    }
}

/// Six digits after the point of metres.
const MICROMETRE: f64 = 0.51e-6;

#[test]
fn a_step_and_its_element() {
    let place = Place::new();
    let deck = Deck::new([2, 2, 2]);
    std::fs::write(place.path("deck.inp"), deck.text()).unwrap();
    for (order, renumber) in [(1, true), (1, false), (2, true)] {
        let mesh = format!("order = {order}\nrenumber = {renumber}\n");
        let numerics = "[numerics]\nend = \"1 ms\"\nstep = \"10 us\"\n";
        let path = scene(&place, &format!("{mesh}{}", pressed("\"1 MPa\"", numerics)));
        let refused = command("run", &path, &[]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2));
        let message = stderr(&refused);
        let element = after(&message, "set by element ");
        assert_at(place_after(&message, "set by element"), deck.centre(element), MICROMETRE);
        // The same in the plan, whose places are in mm to three digits.
        let planned = succeed(command("plan", &path, &[]));
        assert_eq!(after(&planned, "the limiting element is "), element);

        let quiet = "[numerics]\nend = \"10 us\"\n";
        let path = scene(&place, &format!("{mesh}{}", pressed("\"1 MPa\"", quiet)));
        let out = place.path("out");
        let said = succeed(into_folder("run", &path, &out, &["--fresh"]));
        assert_eq!(after(&said, "the limiting element, "), element);
        let summary = json(out.join("summary.json"));
        let named: &Value = &summary["step"]["limit"]["element"];
        assert_eq!(named["number"].as_u64(), Some(element), "{}", summary["step"]);
        // The worst of the quality report is one of the file's, too.
        let checked = succeed(command("check", &path, &["--json"]));
        let echo: Value = serde_json::from_str(&checked).unwrap();
        let worst = echo["mesh"]["quality"]["largest_aspect"]["element"].as_u64().unwrap();
        assert!(deck.elements.contains_key(&worst), "{worst}");
    }
}

#[test]
fn an_element_that_turns_inside_out() {
    let place = Place::new();
    let deck = Deck::new([2, 2, 2]);
    std::fs::write(place.path("deck.inp"), deck.text()).unwrap();
    for order in [1, 2] {
        let numerics = "[numerics]\nend = \"0.1 ms\"\noutput_interval = \"0.5 us\"\n";
        let text = pressed("{ half_sine = \"500 GPa\", duration = \"0.1 ms\" }", numerics);
        let path = scene(&place, &format!("order = {order}\n{text}"));
        let failed = into_folder("run", &path, &place.path("out"), &["--fresh"]).output().unwrap();
        assert_eq!(failed.status.code(), Some(2));
        let message = stderr(&failed);
        assert!(message.contains("is inverted at t = "), "{message}");
        let element = after(&message, "element ");
        assert_at(place_after(&message, "element"), deck.centre(element), MICROMETRE);
    }
}

/// One end pushed through the other: every node is told where to be, and no body can look so.
#[test]
fn no_equilibrium_has_an_element_inside_out() {
    let place = Place::new();
    let deck = Deck::new([1, 1, 1]);
    std::fs::write(place.path("deck.inp"), deck.text()).unwrap();
    let ends = ENDS.replace(
        "plane = \"z\"\nat = \"20 mm\"",
        "low = [\"5 mm\", \"-1 mm\", \"-1 mm\"]\nhigh = [\"1 m\", \"1 m\", \"1 m\"]",
    );
    let pushed = |by: &str| {
        let end = format!("[[solid.fixed]]\nset = \"top\"\nx = \"{by}\"\ny = true\nz = true\n");
        scene(&place, &format!("{ends}{end}"))
    };
    succeed(command("statics", &pushed("-5 mm"), &["--dry"]));
    let refused = command("statics", &pushed("-30 mm"), &["--dry"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    let message = stderr(&refused);
    for part in ["no equilibrium found", "is inverted", "apply less load, or check"] {
        assert!(message.contains(part), "{part} is not in {message}");
    }
    let element = after(&message, "element ");
    assert_at(place_after(&message, "element"), deck.centre(element), MICROMETRE);
}

/// Rows far apart, so that values overflow before an element is looked at; also where threads have
/// shared out the nodes and count their own.
#[test]
fn a_node_without_a_finite_value() {
    let place = Place::new();
    let deck = Deck::new([10, 10, 9]);
    assert_eq!(deck.elements.len(), 5400);
    std::fs::write(place.path("deck.inp"), deck.text()).unwrap();
    let numerics = "[numerics]\nend = \"1 ms\"\noutput_interval = \"1 ms\"\n";
    let text = pressed("\"1000000 MPa\"", numerics).replace("20 mm", "90 mm");
    let path = scene(&place, &text);
    for threads in ["1", "2"] {
        let run = into_folder("run", &path, &place.path("out"), &["--fresh", "--threads", threads]);
        let failed = { run }.output().unwrap();
        assert_eq!(failed.status.code(), Some(2));
        let message = stderr(&failed);
        assert!(message.contains("has a value that is not finite"), "{message}");
        let node = after(&message, "node ");
        let at = deck.nodes[&node].map(|x| 1e-3 * x);
        assert_at(place_after(&message, "node"), at, MICROMETRE);
    }
}

/// Two halves that touch without sharing nodes: refused with a hint, joined when asked and said, and
/// then as stiff as a body in one piece.
#[test]
fn duplicate_nodes_are_joined_when_asked() {
    let place = Place::new();
    let whole = Deck::new([2, 2, 2]);
    let mut halves = Deck::new([2, 2, 2]);
    for (number, nodes) in &mut halves.elements {
        let right = whole.centre(*number)[0] > 10.3e-3;
        for node in nodes.iter_mut().filter(|_| right) {
            let at = whole.nodes[node];
            // The nodes between the two halves, twice.
            if (at[0] - 10.0).abs() < 1.0 {
                halves.nodes.insert(*node + 3, at);
                *node += 3;
            }
        }
    }
    assert_eq!(halves.nodes.len(), whole.nodes.len() + 9);
    std::fs::write(place.path("deck.inp"), halves.text()).unwrap();
    let load = pressed("\"2 MPa\"", "[[solid.probe]]\nset = \"top\"\n");
    let refused = command("check", &scene(&place, &load), &[]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    let message = stderr(&refused);
    let hint = "the repair `merge-duplicates` merges them";
    for part in ["deck.inp: 9 pairs of nodes coincide", hint, "2 bodies that share no face"] {
        assert!(message.contains(part), "{part} is not in {message}");
    }
    let first = after(&message, "(first: ");
    let second = after(&message, &format!("(first: {first} and "));
    assert_eq!(first.abs_diff(second), 3);
    assert_at(halves.nodes[&first], halves.nodes[&second], 0.0);

    let asked =
        |further: &str| scene(&place, &format!("repair = [\"merge-duplicates\"]\n{further}"));
    let note = "repaired: 0 elements turned, 9 nodes joined, 0 nodes dropped";
    for verb in ["check", "plan"] {
        let said = succeed(command(verb, &asked(&load), &[]));
        assert!(said.contains(note), "{said}");
    }
    let out = place.path("joined");
    let said = succeed(into_folder("statics", &asked(&load), &out, &[]));
    assert!(said.contains(note), "{said}");
    let joined = json(out.join("summary.json"));
    assert_eq!(joined["mesh"]["repaired"]["merged_nodes"], 9);
    assert_eq!(joined["mesh"]["nodes"], 27);
    std::fs::write(place.path("deck.inp"), whole.text()).unwrap();
    let out = place.path("whole");
    let said = succeed(into_folder("statics", &scene(&place, &load), &out, &[]));
    assert!(!said.contains("repaired"), "{said}");
    let in_one_piece = json(out.join("summary.json"));
    for axis in ["x", "y", "z"] {
        let at = |summary: &Value| number(&summary["probes"]["top"][axis]);
        // The same equations in another order.
        assert_near(at(&joined), at(&in_one_piece), 1e-9);
    }

    // Two nodes of one element at one place cannot be joined.
    let [a, _, c, d] = whole.elements[&90_000];
    let twin = whole.nodes[&a];
    halves = Deck::new([2, 2, 2]);
    halves.nodes.insert(5, twin);
    halves.elements.insert(4711, [a, 5, c, d]);
    std::fs::write(place.path("deck.inp"), halves.text()).unwrap();
    let refused = command("check", &asked(""), &[]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    let message = stderr(&refused);
    assert!(message.contains("would collapse element 4711"), "{message}");
    assert!(message.contains("deck.inp"), "{message}");
}

/// Metres read as millimetres: every command that gives numbers says so before them.
#[test]
fn an_unlikely_size_is_said() {
    let place = Place::new();
    let deck = Deck::new([1, 1, 1]);
    std::fs::write(place.path("deck.inp"), deck.text()).unwrap();
    let path = place.scene(
        "scene.toml",
        "[solid.mesh]\nfile = \"deck.inp\"\nunit = \"m\"\n[[solid.set]]\nname = \"foot\"\nplane = \"z\"\nat = \"0 m\"\n\
         [[solid.fixed]]\nset = \"foot\"\nx = true\ny = true\nz = true\n[numerics]\nend = \"10 ms\"\n",
    );
    let out = place.path("out");
    for verb in ["check", "plan", "statics", "modes", "run"] {
        let said = match verb {
            "run" => succeed(into_folder(verb, &path, &out, &[])),
            "statics" | "modes" => succeed(command(verb, &path, &["--dry"])),
            _ => succeed(command(verb, &path, &[])),
        };
        assert!(said.contains("in millimetres it would be"), "{verb}: {said}");
    }
}

/// A bar of 100 × 10 × 10 mm, clamped and bent by a force, as `statics` sees it.
fn bent(cells: [u8; 3], order: u8, poisson: &str, force: &str) -> String {
    let [along, across, up] = cells;
    format!(
        "[solid.mesh]\ngenerate = \"bar\"\nlength = \"100 mm\"\nwidth = \"10 mm\"\nheight = \"10 mm\"\n\
         cells = {{ along = {along}, across = {across}, up = {up} }}\norder = {order}\n\
         [solid.material]\nyoungs_modulus = \"210 GPa\"\npoisson_ratio = {poisson}\n\
         [[solid.fixed]]\nset = \"x_low\"\nx = true\ny = true\nz = true\n\
         [[solid.load]]\nset = \"x_high\"\nz = \"{force}\"\n"
    )
}

/// Warnings of `statics`, as its summary has them and it prints them.
fn warnings(place: &Place, scene: &str) -> Vec<(String, String)> {
    let path = place.scene("bent.toml", scene);
    let out = place.path("bent");
    let said = succeed(into_folder("statics", &path, &out, &[]));
    let all = json(out.join("summary.json"))["warnings"].as_array().unwrap().clone();
    let of = |warning: &Value, key: &str| warning[key].as_str().unwrap().to_string();
    let all: Vec<_> = all.iter().map(|one| (of(one, "code"), of(one, "text"))).collect();
    for (code, text) in &all {
        assert!(said.contains(&format!("warning[{code}]: {text}\n")), "{text} is not in {said}");
    }
    assert_eq!(said.matches("warning[").count(), all.len(), "{said}");
    all
}

const COARSE: &str = "W08-mesh-too-coarse";
const LOCKS: &str = "W09-four-node-locking";

/// Per cent, the only one with this code.
fn percent(found: &[(String, String)]) -> f64 {
    assert!(found.len() == 1 && found[0].0 == COARSE, "{found:?}");
    up_to(&found[0].1)
}

/// "may be up to 15 % too".
fn up_to(text: &str) -> f64 {
    text.split_once("may be up to ").unwrap().1.split_once(" % too").unwrap().0.parse().unwrap()
}

#[test]
fn meshes_that_lock_or_are_too_coarse_are_warned_of() {
    let place = Place::new();
    for (poisson, code) in [("0.3", COARSE), ("0.4999", LOCKS)] {
        let found = warnings(&place, &bent([10, 2, 2], 1, poisson, "-100 N"));
        assert!(found.len() == 1 && found[0].0 == code, "{found:?}");
        let found = warnings(&place, &bent([24, 4, 4], 2, poisson, "-100 N"));
        if poisson == "0.3" {
            assert!(found.is_empty(), "{found:?}");
        } else {
            // 2 % are missing there.
            assert!((2.0..4.0).contains(&percent(&found)), "{found:?}");
        }
    }
    // One element each way, two, and one through a thin bar: 13.6, 3.9 and 2.7 % are missing.
    let cube = |count: u8| bent([count; 3], 2, "0.3", "-10 N").replace("100 mm", "10 mm");
    let thin =
        bent([10, 1, 1], 2, "0.3", "-0.01 N").replace("height = \"10 mm\"", "height = \"2 mm\"");
    for (scene, missing, wall) in [
        (cube(1), 13.6, "have 1 element through 10 mm (at x "),
        (cube(2), 3.9, "have 2 elements through 10 mm (at x "),
        (thin, 2.7, "have 1 element through 2 mm (at x "),
    ] {
        let found = warnings(&place, &scene);
        let most = percent(&found);
        assert!(missing <= most && most <= 5.0 * missing, "{found:?}");
        assert!(found[0].1.contains(wall), "{wall}: {found:?}");
    }
    // A stiff bar has a high lowest frequency.
    let modes = |cells, order| {
        let scene = bent(cells, order, "0.3", "-100 N");
        succeed(command("modes", &place.scene("modes.toml", &scene), &["--dry"]))
    };
    assert!(modes([10, 2, 2], 1).contains(COARSE));
    assert!(!modes([24, 4, 4], 2).contains("warning["));
    // Of a free ring with one element through its wall: finer meshes settle at 764.05 Hz.
    let ring = std::fs::read_to_string(shipped("ring_modes.toml")).unwrap();
    let coarse = ring.replace("around = 48", "around = 24");
    let out = place.path("ring");
    let said = succeed(into_folder("modes", &place.scene("ring.toml", &coarse), &out, &[]));
    let missing = 100.0 * (column(&out, "frequency")[6] / 764.05 - 1.0);
    assert!(missing <= up_to(&said), "{missing}: {said}");
    // Without supports the first six are no vibrations.
    let free = bent([10, 2, 2], 2, "0.3", "-100 N");
    let free = free.split_once("[[solid.fixed]]").unwrap().0.to_string() + "[modes]\ncount = 8\n";
    let said = succeed(command("modes", &place.scene("free.toml", &free), &["--dry"]));
    let rigid: Vec<bool> =
        said.lines().skip(1).take(8).map(|line| line.contains("rigid-body mode")).collect();
    assert_eq!(rigid, [true, true, true, true, true, true, false, false], "{said}");
    // The cause, not the load.
    let scene = place.scene("nearly.toml", &bent([10, 2, 2], 2, "0.4999999999", "-100 N"));
    let output = command("statics", &scene, &["--dry"]).output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("so near to 1/2") && !said.contains("less load"), "{said}");
}

#[test]
fn stresses_beyond_a_linear_law_are_warned_of() {
    const STRAINED: &str = "W10-stress-above-elastic";
    let place = Place::new();
    let found = warnings(&place, &bent([24, 2, 2], 2, "0.3", "-150 kN"));
    let strained = found.iter().find(|(code, _)| code == STRAINED);
    assert!(strained.is_some_and(|(_, text)| text.contains("at x ")), "{found:?}");
    // A run is judged by all its rows: this blow is over long before its end.
    let run = bent([10, 1, 1], 1, "0.3", "-100 N")
        .replace("z = \"-100 N\"", "x = { half_sine = \"700 kN\", duration = \"10 us\" }");
    let damped = run.replacen("[solid.mesh]", "[solid]\ndamping = \"3e5 1/s\"\n[solid.mesh]", 1);
    let text = format!("{damped}[numerics]\nend = \"60 us\"\noutput_interval = \"1 us\"\n");
    let out = place.path("blow");
    let said = succeed(into_folder("run", &place.scene("blow.toml", &text), &out, &[]));
    assert!(said.contains(STRAINED) && said.contains(" at t = "), "{said}");
    assert_eq!(json(out.join("summary.json"))["warnings"][0]["code"], STRAINED);
    let gentle = text.replace("700 kN", "7 kN");
    let said = succeed(into_folder(
        "run",
        &place.scene("gentle.toml", &gentle),
        &place.path("gentle"),
        &[],
    ));
    assert!(!said.contains("warning["), "{said}");
}
