//! Several bearings, bodies and springs in one scene, as a user meets them.

use crate::assembly_common::{BEARING, ENDS, RUN, SHAFT};
use crate::command_line_common::{bearing, done, json, read, refused, scene, text, write};
use serde_json::Value;
use std::path::Path;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

/// Statics of a scene, as `summary.json` has it.
fn statics(text_of: &str) -> Value {
    let folder = folder();
    let path = write(folder.path(), "scene.toml", text_of);
    let out = folder.path().join("out");
    done(&["statics", &path, "--out", &text(&out)]);
    json(&out.join("summary.json"))
}

fn value(of: &Value) -> f64 {
    of["value"].as_f64().unwrap_or_else(|| panic!("no value in {of}"))
}

fn force(summary: &Value, bearing: &str, race: &str) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| value(&summary["bearings"][bearing][race]["contact_force"][axis]))
}

fn place(summary: &Value, body: &str) -> [f64; 5] {
    ["x", "y", "z", "tilt_y", "tilt_z"]
        .map(|name| value(&summary["bodies"][body]["position"][name]))
}

#[test]
fn forces_of_both_bearings_and_the_loads_are_in_balance() {
    let summary = statics(&[BEARING, ENDS, SHAFT].concat());
    let (left, right) =
        (force(&summary, "left", "inner_race"), force(&summary, "right", "inner_race"));
    for (axis, load) in [100.0, 30.0, -500.0].into_iter().enumerate() {
        let sum: f64 = left[axis] + right[axis] + load;
        // Statics stops at 1e-11 of the largest ball load, some 600 N.
        assert!(sum.abs() <= 1e-7, "axis {axis}: {sum:e} N");
    }
    // The load stands 70 mm from the centre. Back to back, lines of contact meet the axis at 40 mm + R tan α
    // to either side; contact angles differ from the nominal one by some 0.3 deg.
    let half = 40.0 + 30.0 * 35f64.to_radians().tan();
    let expected = 500.0 * (70.0 + half) / (2.0 * half);
    assert!((right[2] / expected - 1.0).abs() <= 5e-3, "{} and {expected}", right[2]);
    assert!(left[2] < 0.0, "{}", left[2]);
    // Preloaded against each other.
    assert!(left[0] < -50.0 && right[0] > 50.0, "{left:?} {right:?}");
    assert_eq!(summary["stiffness"]["coordinates"][0], "shaft.x");
}

/// A key without a name does not reach what has its own: refused where that is everything, told where it is a part.
#[test]
fn keys_that_named_tables_have_for_themselves_are_told() {
    let folder = folder();
    let out = text(&folder.path().join("out"));
    let path = write(folder.path(), "scene.toml", &[BEARING, ENDS, SHAFT].concat());
    let load = "body.z.load=-300 N, -5000 N";
    let message = refused(&["sweep", &path, "--vary", load, "--out", &out]);
    assert!(
        message.contains("has no effect, because [body.shaft] has a value of its own"),
        "{message}"
    );
    assert!(message.contains("write body.shaft.z.load"), "{message}");
    let message = refused(&["statics", &path, "--set", "body.z.load=-300 N", "--dry"]);
    assert!(message.contains("has no effect, because [body.shaft]"), "{message}");
    done(&["statics", &path, "--set", "body.shaft.z.load=-300 N", "--dry"]);
    // Of one of two.
    let own = [BEARING, ENDS, SHAFT]
        .concat()
        .replace("[bearing.left]", "[bearing.left]\nball_phase = \"3 deg\"");
    let path = write(folder.path(), "own.toml", &own);
    let said = done(&["statics", &path, "--set", "bearing.ball_phase=5 deg", "--dry"]);
    assert!(said.contains("[bearing.left] has a value of its own, which is kept"), "{said}");
    let said = done(&["statics", &path, "--set", "bearing.right.ball_phase=5 deg", "--dry"]);
    assert!(!said.contains("which is kept"), "{said}");
}

#[test]
fn names_and_order_change_no_physics() {
    let one = statics(&[BEARING, ENDS, SHAFT].concat());
    let renamed = ENDS.replace("left", "zeta").replace("right", "alpha");
    let (second, first) = renamed.split_once("[bearing.alpha]").expect("both ends");
    let swapped = format!("[bearing.alpha]{first}{second}");
    let other = statics(&[BEARING, &SHAFT.replace("shaft", "rod"), &swapped].concat());
    let (a, b) = (place(&one, "shaft"), place(&other, "rod"));
    let size = a.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() <= 1e-9 * size, "{a:e} and {b:e}");
    }
    for (old, new) in [("left", "zeta"), ("right", "alpha")] {
        let (a, b) = (force(&one, old, "outer_race"), force(&other, new, "outer_race"));
        let size = a.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= 1e-9 * size, "{a} and {b} N");
        }
    }
}

/// A hub that carries the outer race on a spring to the ground goes by F/k; a shaft whose own race is on
/// nothing else carries the load through.
#[test]
fn a_hub_on_a_spring_goes_by_load_over_stiffness() {
    let scene = format!(
        r#"{BEARING}
inner_on = "shaft"
outer_on = "hub"
[body.shaft]
x = {{ load = "300 N" }}
y = {{ displacement = "0 um" }}
z = {{ displacement = "0 um" }}
tilt_y = {{ tilt = "0 deg" }}
tilt_z = {{ tilt = "0 deg" }}
[body.hub]
[spring.mount]
from = "hub"
stiffness = {{ x = "2e7 N/m", y = "3e7 N/m", z = "3e7 N/m", turn_y = "1e5 N m/rad", turn_z = "1e5 N m/rad" }}
"#
    );
    // The keys of [bearing] come before its subtables.
    let scene = scene
        .replace("\ninner_on = \"shaft\"\nouter_on = \"hub\"", "")
        .replace("balls = 11\n", "balls = 11\ninner_on = \"shaft\"\nouter_on = \"hub\"\n");
    let summary = statics(&scene);
    let hub = place(&summary, "hub");
    assert!((hub[0] - 300.0 / 2e7).abs() <= 1e-9 * 300.0 / 2e7, "{:e}", hub[0]);
    let shaft = place(&summary, "shaft");
    assert!(shaft[0] > hub[0], "{:e} and {:e}", shaft[0], hub[0]);
}

/// Rows of a run.
fn columns(folder: &Path) -> Vec<String> {
    let columns = json(&folder.join("series.columns.json"));
    let names = columns.as_array().expect("columns");
    names.iter().map(|c| c["name"].as_str().expect("a name").to_string()).collect()
}

/// Names of the columns and rows of `series.csv`.
fn table(folder: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let content = read(&folder.join("series.csv"));
    let numbers =
        |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (columns(folder), content.lines().skip(1).map(numbers).collect())
}

#[test]
fn a_run_settles_nowhere_else_than_statics_and_resumes_with_the_same_bytes() {
    let folder = folder();
    let whole = [BEARING, ENDS, SHAFT, RUN].concat();
    let path = write(folder.path(), "whole.toml", &whole);
    let [one, two] = ["one", "two"].map(|name| text(&folder.path().join(name)));
    done(&["run", &path, "--out", &one]);
    let half = write(folder.path(), "half.toml", &whole.replace("2 ms", "1 ms"));
    done(&["run", &half, "--out", &two]);
    done(&["run", &path, "--out", &two, "--resume"]);
    for file in ["series.npy", "series.csv"] {
        let [a, b] = [&one, &two].map(|of| std::fs::read(Path::new(of).join(file)).expect(file));
        assert!(a == b, "{file} differs after a resume");
    }
    let names = columns(Path::new(&one));
    for name in ["left_inner_x", "right_inner_z", "shaft_z", "left_ball_1_inner_load"] {
        assert!(names.iter().any(|own| own == name), "{name} is missing in {names:?}");
    }
    let summary = json(&Path::new(&one).join("summary.json"));
    assert_eq!(summary["complete"], true);
    // Of each bearing's own balls: no row shows more, and rows are dense enough to show nearly all.
    let (_, rows) = table(Path::new(&one));
    for bearing in ["left", "right"] {
        for race in ["inner", "outer"] {
            let own =
                |name: &str| name.starts_with(bearing) && name.ends_with(&format!("_{race}_load"));
            let loads = names.iter().enumerate().filter(|(_, name)| own(name));
            let shown =
                loads.flat_map(|(at, _)| rows.iter().map(move |row| row[at])).fold(0.0, f64::max);
            let of = &summary["extremes"][bearing][format!("{race}_race")]["largest_load"]["load"];
            let most = value(of);
            assert!(most >= shown && most <= 1.1 * shown, "{bearing} {race}: {most} {shown}");
        }
    }
    // It starts at the equilibrium of statics; without traction and cage nothing moves it far away.
    let still = place(&statics(&whole), "shaft");
    let shaft = value(&summary["final"]["shaft_z"]);
    assert!((shaft - still[2]).abs() <= 0.1 * still[2].abs(), "{shaft:e} and {:e}", still[2]);
    for file in ["orbit_shaft.svg", "series_left_loads.svg", "polar_right.svg"] {
        assert!(Path::new(&one).join(file).is_file(), "{file}");
    }
}

/// Balls between an inner race at rest and an outer one that turns at Ω roll round at Ω (1 + γ cos α)/2.
#[test]
fn an_outer_race_turns_at_a_given_speed() {
    let folder = folder();
    let scene = format!(
        r#"{BEARING}
[inner_race]
x = {{ load = "-400 N" }}
[outer_race]
motion = "5-dof"
x = {{ displacement = "0 um" }}
y = {{ displacement = "0 um" }}
z = {{ displacement = "0 um" }}
tilt_y = {{ tilt = "0 deg" }}
tilt_z = {{ tilt = "0 deg" }}
speed = "600 rpm"
[numerics]
end = "20 ms"
accuracy = 1e-3
[output]
plots = []
"#
    )
    .replace("x = { load = \"-400 N\" }", "x = { load = \"400 N\" }");
    let path = write(folder.path(), "turning.toml", &scene);
    let out = folder.path().join("out");
    done(&["run", &path, "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    let gamma: f64 = 5.953 / 30.0;
    let ratio = 0.5 * (1.0 + gamma * 35f64.to_radians().cos());
    let speed = value(&summary["final"]["ball_1_orbital_speed"]);
    let expected = 600.0 / 60.0 * std::f64::consts::TAU * ratio;
    // The contact angle grows by some 0.3 deg under load: 0.0003 of the ratio; slip adds 0.1 %.
    assert!((speed / expected - 1.0).abs() <= 3e-3, "{speed} and {expected} rad/s");
}

#[test]
fn a_sweep_varies_a_key_of_a_named_table() {
    let folder = folder();
    let path = write(folder.path(), "scene.toml", &[BEARING, ENDS, SHAFT].concat());
    let out = folder.path().join("sweep");
    let vary = "outer_race.left.x=-6 um, -3 um, 0 um";
    done(&["sweep", &path, "--vary", vary, "--out", &text(&out)]);
    let csv = read(&out.join("sweep.csv"));
    let header = csv.lines().next().expect("a header");
    for column in ["outer_race.left.x", "shaft_x", "left_largest_inner_load", "free_directions"] {
        assert!(header.contains(column), "{column} in {header}");
    }
    let column = header.split(',').position(|name| name.contains("left_largest_inner_load"));
    let loads: Vec<f64> = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(column.expect("the column")).expect("a cell"))
        .map(|cell| cell.parse().expect("a number"))
        .collect();
    assert!(loads.len() == 3 && loads[0] > loads[1] && loads[1] > loads[2], "{loads:?}");
    // The middle one is that of statics.
    let other = statics(&[BEARING, &ENDS.replace("-6 um", "-3 um"), SHAFT].concat());
    let largest = value(&other["bearings"]["left"]["load_zone"]["largest_inner_load"]);
    assert!((loads[1] / largest - 1.0).abs() <= 1e-8, "{} and {largest}", loads[1]);
}

#[test]
fn check_and_plan_tell_what_sits_where() {
    let path = scene("shaft_back_to_back.toml");
    let said = done(&["check", &path]);
    for words in
        ["bearing left", "body shaft", "reversed", "inner race on body.shaft at -40.0000 mm"]
    {
        assert!(said.contains(words), "{words:?} in\n{said}");
    }
    let understood: Value = serde_json::from_str(&done(&["check", &path, "--json"])).expect("JSON");
    assert_eq!(understood["scene"]["bearing"]["right"]["reversed"], true);
    assert!(value(&understood["geometry"]["right"]["ball_radius"]) > 1.0, "in mm");
    assert!((value(&understood["body_inertia"]["the body shaft"]["mass"]) - 0.67).abs() <= 1e-15);
    let planned = done(&["plan", &path]);
    for words in ["left: distance test", "right: traction", "body shaft motion"] {
        assert!(planned.contains(words), "{words:?} in\n{planned}");
    }
}

/// The scene without lines of speeds.
fn without_speed(text: &str) -> String {
    text.lines().filter(|line| !line.starts_with("speed")).map(|line| format!("{line}\n")).collect()
}

/// Each wrong scene has one message that says what, where and what to do.
#[test]
fn bad_assemblies_are_refused() {
    let folder = folder();
    let whole = [BEARING, ENDS, SHAFT].concat();
    let many: String = (0..10_000).map(|i| format!("[body.b{i}]\n")).collect();
    let cases: Vec<(&str, String, Vec<&str>)> = vec![
        (
            "a body that is not there",
            whole.replace("inner_at = \"-40 mm\"", "inner_on = \"shft\""),
            vec!["bearing.left.inner_on", "no body \"shft\"", "did you mean shaft"],
        ),
        (
            "a spring to nowhere",
            format!("{whole}\n[spring.s]\nfrom = \"axle\"\nstiffness = {{ x = \"1 N/m\" }}\n"),
            vec!["spring.s.from", "\"axle\" is no end of a spring", "ends are: shaft, ground"],
        ),
        (
            "a spring to itself",
            format!(
                "{whole}\n[spring.s]\nfrom = \"shaft\"\nto = \"shaft\"\nstiffness = {{ x = \"1 N/m\" }}\n"
            ),
            vec!["spring.s.to", "both ends are at the same body"],
        ),
        (
            "two bearings in one place",
            whole.replace("inner_at = \"-40 mm\"", "inner_at = \"39 mm\""),
            vec!["bearing.right", "inside those of bearing left", "1.0000 mm apart"],
        ),
        (
            "both races on one body",
            whole.replace("inner_at = \"-40 mm\"", "inner_on = \"shaft\"\nouter_on = \"shaft\""),
            vec!["bearing.left.outer_on", "both races"],
        ),
        (
            "a free body",
            format!(
                "{}\n[body.loose]\n",
                whole.replace("inner_at", "inner_on = \"shaft\"\ninner_at")
            ),
            vec!["body.loose", "nothing is joined to this body"],
        ),
        (
            "no speed of what carries the inner races",
            format!("{}[ball_forces]\ncentrifugal = true\n", without_speed(&whole)),
            vec!["body.shaft.speed", "missing with `ball_forces.centrifugal", "to [body.shaft]"],
        ),
        (
            "a body named as a race's columns",
            whole.replace("shaft", "left_inner"),
            vec![
                "body.left_inner",
                "columns of the inner race of bearing left begin with this name",
            ],
        ),
        (
            "a name used twice",
            format!("{whole}\n[spring.left]\nfrom = \"shaft\"\nstiffness = {{ x = \"1 N/m\" }}\n"),
            vec!["spring.left", "a bearing has this name as well"],
        ),
        (
            "a race of a bearing that is not there",
            format!("{whole}\n[outer_race.middle]\nx = \"1 um\"\n"),
            vec!["outer_race.middle", "no bearing \"middle\"", "left, right"],
        ),
        (
            "several bodies and no word of which",
            format!("{whole}\n[body.other]\n"),
            vec!["bearing.left.inner_on", "several bodies: shaft, other"],
        ),
        (
            "loads on a race that is part of a shaft",
            format!("{whole}\n[inner_race]\nz = {{ load = \"1 N\" }}\n"),
            vec!["inner_race.z", "this race is on body.shaft"],
        ),
        (
            "a name no column could have",
            whole.replace("left", "\"a-b\""),
            vec!["bearing.a-b", "letters, digits and underscores"],
        ),
        (
            "a mistyped table",
            format!("{whole}\n[bearing.cagee]\nmass = \"1 kg\"\n"),
            vec!["bearing.cage"],
        ),
        ("ten thousand bodies", format!("{whole}\n{many}"), vec!["more than 500"]),
        (
            "a shaft without mass that is to move",
            format!("{}\n{RUN}", whole.replace("inertia = { mass = \"0.67 kg\"", "#")),
            vec!["body.inertia.mass", "body.shaft"],
        ),
        (
            "an unknown key of a named table",
            whole.replace("reversed", "reversd"),
            vec!["bearing.right.reversd", "did you mean"],
        ),
    ];
    for (what, text_of, words) in cases {
        let path = write(folder.path(), "bad.toml", &text_of);
        let run = bearing(&["statics", &path, "--dry"]);
        assert_eq!(run.code, Some(2), "{what}: {}", run.stdout);
        let said = refused(&["statics", &path, "--dry"]);
        for word in words {
            assert!(said.contains(word), "{what}: {word:?} in {said:?}");
        }
    }
}

/// The squares of all natural frequencies of a shaft sum to stiffness over mass of its coordinates, as `statics` has them.
#[test]
fn modes_of_a_shaft_are_those_of_its_stiffness_and_mass() {
    let folder = folder();
    let words = format!("{BEARING}{ENDS}{SHAFT}");
    let path = write(folder.path(), "scene.toml", &words);
    let out = folder.path().join("modes");
    done(&["modes", &path, "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    let modes = summary["modes"].as_array().expect("a list");
    assert_eq!(modes.len(), 5);
    let square = |mode: &Value| (std::f64::consts::TAU * value(&mode["frequency"])).powi(2);
    let sum: f64 = modes.iter().map(square).sum();
    let stiffness = &statics(&words)["stiffness"]["matrix"];
    let own = |i: usize| stiffness[i][i].as_f64().expect("a number");
    let mass = |i: usize| if i < 3 { 0.67 } else { 8.4e-4 };
    let should: f64 = (0..5).map(|i| own(i) / mass(i)).sum();
    // Rounding of the eigenvalues.
    assert!((sum / should - 1.0).abs() <= 1e-9, "{sum:e} {should:e}");
    let rows = read(&out.join("series.csv"));
    assert!(rows.starts_with("mode") && rows.contains("shaft_tilt_y"), "{rows}");
    let held = SHAFT.replace("load", "displacement").replace("moment", "tilt");
    let held = held.replace("100 N", "0 um").replace("30 N", "0 um").replace("-500 N", "0 um");
    let held = held.replace("35 N m", "0 deg") + "tilt_z = { tilt = \"0 deg\" }\n";
    let held = held.replace("inertia =", "# inertia =");
    let path = write(folder.path(), "held.toml", &format!("{BEARING}{ENDS}{held}"));
    let said = refused(&["modes", &path]);
    assert!(said.contains("there is no mode"), "{said}");
}

/// Bending is of small turns: a thin shaft whose end bends far is told by how much, against the shaft as a whole; a thick one
/// that tilts as far, its outer race with it, is not.
#[test]
fn statics_says_where_a_shaft_bends_too_far_for_small_turns() {
    let folder = folder();
    let with = |thick: &str, tilt_stiffness: &str, moment: &str, load: &str| {
        format!(
            r#"
defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
length = "20 mm"
clearance = {{ radial = "-5 um" }}
ball = {{ radius = "5.953 mm" }}
inner_race = {{ radius = "20.047 mm", groove_radius = "6.013 mm" }}
outer_race = {{ groove_radius = "6.310 mm", outer_radius = "35.527 mm" }}
[bearing.only]
inner_at = "0 mm"
[outer_race]
motion = "5-dof"
x = {{ displacement = "0 mm" }}
y = {{ displacement = "0 mm" }}
z = {{ displacement = "0 mm" }}
foundation = {{ stiffness = {{ tilt_y = "{tilt_stiffness}", tilt_z = "{tilt_stiffness}" }} }}
[body.shaft]
tilt_y = {{ moment = "{moment}" }}
[body.shaft.beam]
start = "-30 mm"
segments = [{{ length = "60 mm", outer_diameter = "{thick}" }}]
load = [{{ at = "28 mm", z = "{load}" }}]
"#
        )
    };
    let statics = |name: &str, words: &str| {
        let out = folder.path().join(name);
        let path = write(folder.path(), &format!("{name}.toml"), words);
        let said = done(&["statics", &path, "--out", &text(&out)]);
        let summary = json(&out.join("summary.json"));
        let whole = value(&summary["bodies"]["shaft"]["position"]["tilt_y"]);
        let end = said.lines().find(|line| line.starts_with("the body shaft at its load"));
        let columns: Vec<&str> = end.expect("a section").split_whitespace().rev().collect();
        let tilt: f64 = columns[1].parse().expect("a tilt");
        (whole, tilt - whole)
    };
    let (tilted, bent) = statics("thick", &with("20 mm", "20 N m/rad", "1.5 N m", "-33 N"));
    assert!(tilted > 6.0 && bent < 0.1, "{tilted} {bent}");
    let thin = write(folder.path(), "bent.toml", &with("4 mm", "5e4 N m/rad", "0 N m", "-1000 N"));
    let message = refused(&["statics", &thin, "--out", &text(&folder.path().join("thin"))]);
    assert!(
        message.contains("the section of the body shaft at its load is tilted by"),
        "{message}"
    );
    assert!(message.contains("Allowed: up to 5.7 deg"), "{message}");
}
