//! A shaft on two bearings in two housings, by equilibrium, in shapes and in explicit steps.

use crate::command_line_common::{changed, done, json, read, refused, scene, text, write};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The shipped scene, cut to 1 ms, with these words changed.
fn variant(folder: &Path, name: &str, changes: &[(&str, &str)]) -> String {
    let mut words = read(Path::new(&scene("shaft_in_two_housings.toml")));
    for (from, to) in [("end = \"2 ms\"", "end = \"1 ms\"")].iter().chain(changes) {
        words = changed(&words, from, to);
    }
    write(folder, &format!("{name}.toml"), &words)
}

fn run(folder: &Path, name: &str, changes: &[(&str, &str)], further: &[&str]) -> PathBuf {
    let (path, out) = (variant(folder, name, changes), folder.join(name));
    let out_text = text(&out);
    let arguments = [&["run", &path, "--out", &out_text], further].concat();
    let said = done(&arguments);
    assert!(said.contains("left bore") && said.contains("right bore"), "{said}");
    out
}

/// One column of a run.
fn column(folder: &Path, name: &str) -> Vec<f64> {
    let csv = read(&folder.join("series.csv"));
    let mut lines = csv.lines();
    let header = lines.next().expect("a header");
    let at = header.split(',').position(|own| own.split(' ').next() == Some(name));
    let at = at.unwrap_or_else(|| panic!("{name} in {header}"));
    lines.map(|row| row.split(',').nth(at).expect("a cell").parse().expect("a number")).collect()
}

fn swing(of: &[f64]) -> f64 {
    let low = of.iter().copied().fold(f64::INFINITY, f64::min);
    of.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
}

fn farthest(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

const EXPLICIT: [(&str, &str); 1] =
    [("method = \"reduced\"", "method = \"explicit\"\nstart = \"equilibrium\"")];

#[test]
fn a_blow_in_shapes_and_in_explicit_steps_is_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let shapes = run(folder.path(), "shapes", &[], &[]);
    let steps = run(folder.path(), "steps", &EXPLICIT, &[]);
    // Both start from one equilibrium: 0.004 % of the compliance has no shape.
    // Of what moves: the shaft on its balls hardly feels the housings; races move with what shapes leave out.
    for (name, most) in
        [("shaft_z", 1e-4), ("shaft_tilt_y", 1e-3), ("left_outer_z", 0.01), ("right_outer_z", 0.01)]
    {
        let [one, other] = [&shapes, &steps].map(|folder| column(folder, name));
        let swing = swing(&other);
        assert!(
            (one[0] - other[0]).abs() <= 1e-3 * swing,
            "{name} starts at {} and {}",
            one[0],
            other[0]
        );
        let off = farthest(&one, &other);
        assert!(off <= most * swing, "{name}: {off:e} of {swing:e} m");
    }
    for run in [&shapes, &steps] {
        let summary = json(&run.join("summary.json"));
        assert_eq!(summary["complete"], true);
        for file in ["fields.pvd", "bore_left.csv", "bore_right.csv"] {
            assert!(run.join(file).is_file(), "{file}");
        }
        let list = read(&run.join("fields.pvd"));
        assert!(list.contains("part=\"0\" file=\"fields/left_"), "{list}");
        assert!(list.contains("part=\"1\" file=\"fields/right_"), "{list}");
    }
    // The balance of shapes: what is missing, of the energy of the blow.
    let summary = json(&shapes.join("summary.json"));
    let missing = summary["energy"]["largest_residual"]["value"].as_f64().expect("a number");
    let held = column(&shapes, "energy_contact").into_iter().fold(0.0, f64::max);
    assert!(missing <= 1e-4 * held, "{missing:e} of {held:e} J");
}

/// The equilibrium of `statics` is where a run in shapes starts, but for the compliance they leave out.
#[test]
fn statics_is_where_a_run_starts() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = variant(folder.path(), "still", &[]);
    let out = folder.path().join("still");
    let said = done(&["statics", &path, "--out", &text(&out)]);
    assert!(
        said.contains("housing left: outer race") && said.contains("bore nodes in contact"),
        "{said}"
    );
    let summary = json(&out.join("summary.json"));
    let shapes = run(folder.path(), "shapes", &[("end = \"1 ms\"", "end = \"10 us\"")], &[]);
    for (column_name, body) in [
        ("left_outer_z", "outer_race_of_bearing_left"),
        ("right_outer_z", "outer_race_of_bearing_right"),
        ("shaft_z", "shaft"),
    ] {
        let still = value(&summary["bodies"][body]["position"]["z"]);
        let start = column(&shapes, column_name)[0];
        assert!((start - still).abs() <= 0.005 * still.abs(), "{body}: {start:e} and {still:e}");
    }
    // What the housings hold is the load.
    let held: f64 = ["left", "right"]
        .map(|name| value(&summary["housings"][name]["housing_force_on_outer_z"]))
        .iter()
        .sum();
    assert!((held - 300.0).abs() <= 1e-6, "{held}");
}

fn value(of: &Value) -> f64 {
    of["value"].as_f64().unwrap_or_else(|| panic!("no value in {of}"))
}

const EQUILIBRIA: (&str, &str) = ("method = \"reduced\"", "method = \"quasi-static\"");
const BLOW: &str = "z = { load = { half_sine = \"-2000 N\", base = \"-300 N\", start = \"0.2 ms\", duration = \"0.5 ms\" } }";

/// Equilibria one after the other: each is that of statics under its load, races in both housings found together.
#[test]
fn a_course_in_two_housings_is_statics_row_by_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let still = [EQUILIBRIA, ("speed = \"1000 rpm\"\n", ""), ("5 us", "0.5 ms")];
    let loads = ["-300 N", "-900 N", "-500 N"];
    let [a, b, c] = loads;
    let slow = format!(
        "z = {{ load = {{ table = [[\"0 s\", \"{a}\"], [\"0.5 ms\", \"{b}\"], [\"1 ms\", \"{c}\"]] }} }}"
    );
    let course = run(folder.path(), "course", &[&still[..], &[(BLOW, &slow)]].concat(), &[]);
    for (row, load) in loads.iter().enumerate() {
        let load = format!("z = {{ load = \"{load}\" }}");
        let path = variant(folder.path(), "one", &[&still[..], &[(BLOW, &load)]].concat());
        let out = folder.path().join(format!("one-{row}"));
        done(&["statics", &path, "--out", &text(&out)]);
        let summary = json(&out.join("summary.json"));
        for (name, body) in [
            ("left_outer_z", "outer_race_of_bearing_left"),
            ("right_outer_z", "outer_race_of_bearing_right"),
            ("shaft_z", "shaft"),
        ] {
            let at = value(&summary["bodies"][body]["position"]["z"]);
            let here = column(&course, name)[row];
            // Both end at 1e-11 of the load.
            assert!((here - at).abs() <= 1e-9 * at.abs(), "{body} in row {row}: {here:e} {at:e}");
        }
        let held = value(&summary["housings"]["left"]["housing_force_on_outer_z"]);
        let here = column(&course, "left_housing_force_on_outer_z")[row];
        assert!((here - held).abs() <= 1e-8 * held.abs(), "{here} {held}");
    }
    let summary = json(&course.join("summary.json"));
    assert_eq!(summary["housing_method"], "quasi-static");
    let inertia = &summary["inertia"];
    let ratio = value(&inertia["fastest_frequency"]) / value(&inertia["lowest_frequency"]);
    let squared = value(&inertia["frequency_ratio_squared"]);
    assert!((squared / (ratio * ratio) - 1.0).abs() <= 1e-12, "{inertia}");
    for file in ["fields.pvd", "bore_left.csv", "bore_right.csv", "series_left_outer_race.svg"] {
        assert!(course.join(file).is_file(), "{file}");
    }
}

/// A shaft that bends and whose centre of mass is off the origin: it, too, stands in the rows where statics puts it.
#[test]
fn a_course_of_a_bending_shaft_is_told_from_its_centre_of_mass() {
    let folder = tempfile::tempdir().expect("a folder");
    let changes = [
        EQUILIBRIA,
        ("speed = \"1000 rpm\"\n", ""),
        ("5 us", "0.5 ms"),
        (BLOW, "z = { load = \"-300 N\" }"),
        ("x = { displacement = \"0 um\" }", "x = { load = \"20 N\" }"),
        (
            "inertia = { mass = \"1.39 kg\", axial = \"1.56e-4 kg m^2\", transverse = \"7.3e-3 kg m^2\" }",
            "beam = { start = \"-100 mm\", segments = [{ length = \"250 mm\", outer_diameter = \"30 mm\" }] }",
        ),
    ];
    let course = run(folder.path(), "course", &changes, &[]);
    let path = variant(folder.path(), "one", &changes);
    let out = folder.path().join("still");
    done(&["statics", &path, "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    for axis in ["x", "z"] {
        let at = value(&summary["bodies"]["shaft"]["position"][axis]);
        let here = column(&course, &format!("shaft_{axis}"))[0];
        // Both end at 1e-11 of the load.
        assert!((here - at).abs() <= 1e-9 * at.abs(), "{axis}: {here:e} {at:e}");
        assert!(at.abs() < 1e-5, "{axis}: {at}");
    }
}

/// Items of a plan are told apart by the names of their seats.
#[test]
fn no_two_items_of_a_plan_have_one_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let course = [("method = \"reduced\"", "method = \"quasi-static\"")];
    for (name, changes) in [("shapes", &[][..]), ("steps", &EXPLICIT), ("course", &course)] {
        let said = done(&["plan", &variant(folder.path(), name, changes)]);
        let items = said.lines().filter(|line| !line.starts_with("notes"));
        let mut names: Vec<&str> = items.map(|line| line[6..34].trim()).collect();
        assert!(names.contains(&"left: seat") && names.contains(&"right: seat"), "{said}");
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "{name}: {said}");
    }
}

#[test]
fn threads_and_a_break_change_no_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let short = [EXPLICIT[0], ("end = \"1 ms\"", "end = \"60 us\"")];
    let one = run(folder.path(), "one", &short, &[]);
    let first = [EXPLICIT[0], ("end = \"1 ms\"", "end = \"30 us\"")];
    let two = run(folder.path(), "two", &first, &["--threads", "2"]);
    let path = variant(folder.path(), "two", &short);
    done(&["run", &path, "--out", &text(&two), "--resume", "--threads", "2"]);
    for file in ["series.csv", "bore_left.csv", "bore_right.csv"] {
        let [a, b] = [&one, &two].map(|folder| read(&folder.join(file)));
        assert!(a == b, "{file} differs");
    }
    for way in [&[][..], &[EQUILIBRIA][..]] {
        let to = |end| [way, &[("end = \"1 ms\"", end)]].concat();
        let whole = run(folder.path(), "whole", &to("end = \"60 us\""), &["--fresh"]);
        let part = run(folder.path(), "part", &to("end = \"30 us\""), &["--fresh"]);
        let path = variant(folder.path(), "part", &to("end = \"60 us\""));
        done(&["run", &path, "--out", &text(&part), "--resume"]);
        for file in ["series.csv", "bore_left.csv", "bore_right.csv"] {
            let [a, b] = [&whole, &part].map(|folder| read(&folder.join(file)));
            assert!(a == b, "{way:?}: {file} differs");
        }
    }
}

#[test]
fn what_several_housings_cannot_do_is_refused_before_anything_is_solved() {
    let folder = tempfile::tempdir().expect("a folder");
    for (words, part) in [
        ("torque = \"1 N m\"", "no speed follows from a torque"),
        ("speed = \"1000 rpm\"\nunbalance = \"1e-5 kg m\"", "an unbalance needs inertia"),
    ] {
        let changes = [EQUILIBRIA, ("speed = \"1000 rpm\"", words)];
        let said = refused(&["check", &variant(folder.path(), "inert", &changes)]);
        assert!(said.contains("body.shaft") && said.contains(part), "{said}");
    }
    let bends = read(Path::new(&scene("rotor_in_pillow_blocks.toml")));
    let probe = "probe = [{ name = \"mid\"";
    let unbalance = "unbalance = [{ at = \"0 mm\", size = \"1e-5 kg m\" }]\n";
    let bends = changed(&bends, probe, &format!("{unbalance}{probe}"));
    let bends = changed(&bends, "method = \"reduced\"", "method = \"quasi-static\"");
    let said = refused(&["check", &write(folder.path(), "bends.toml", &bends)]);
    assert!(
        said.contains("body.shaft.beam.unbalance.1.size: refused: an unbalance needs"),
        "{said}"
    );
    let slides = [
        ("width = \"20 mm\"", "width = \"20 mm\"\naxial = \"free\""),
        ("x = { displacement = \"0 um\" }", "x = { load = \"1 N\" }"),
    ];
    let slides = variant(folder.path(), "slides", &slides);
    let said = refused(&["run", &slides, "--out", &text(&folder.path().join("slides"))]);
    assert!(said.contains("to let them slide write start = \"nominal\" in [numerics]"), "{said}");
    let mixed = variant(
        folder.path(),
        "mixed",
        &[("[solid]\n", "[housing.right]\nmethod = \"explicit\"\n\n[solid]\n")],
    );
    let said = refused(&["check", &mixed]);
    assert!(said.contains("housing.right.method") && said.contains("different ways"), "{said}");
    let strange =
        variant(folder.path(), "strange", &[("[solid.right.mesh]", "[solid.wrong.mesh]")]);
    let said = refused(&["check", &strange]);
    assert!(said.contains("solid.wrong") && said.contains("no bearing \"wrong\""), "{said}");
    let beside =
        variant(folder.path(), "beside", &[("[outer_race]\n", "[outer_race]\nx = \"30 mm\"\n")]);
    assert!(!refused(&["check", &beside]).is_empty());
}

/// What steps let pass of a race's place is a force in its stiff seat: steps that the plan chooses leave it quiet.
#[test]
fn the_force_of_a_bore_does_not_swing_from_row_to_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = run(folder.path(), "quiet", &[], &[]);
    for name in ["left", "right"] {
        let force = column(&out, &format!("{name}_housing_force_on_outer_z"));
        let bends: Vec<f64> = force.windows(3).map(|row| row[0] - 2.0 * row[1] + row[2]).collect();
        let bend = (bends.iter().map(|x| x * x).sum::<f64>() / bends.len() as f64).sqrt();
        // The blow of 2000 N in 0.5 ms bends by 10 N in three rows of 5 us; what rings after it by as much.
        assert!(bend <= 40.0 && swing(&force) > 1000.0, "{name}: {bend} N of {} N", swing(&force));
    }
}

/// Where nothing pushes a race along its axis, a smooth bore that leaves it free there holds it as one that does not: tilted too, when
/// its tilting moment has a part about X.
#[test]
fn a_tilted_race_that_nothing_pushes_along_is_free_as_it_is_held() {
    let folder = tempfile::tempdir().unwrap();
    let asymmetric = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/asymmetric/housing_quasi_static.toml");
    let rows = ["free", "fixed"].map(|axial| {
        let content =
            changed(&read(&asymmetric), "axial = \"free\"", &format!("axial = \"{axial}\""));
        let out = folder.path().join(axial);
        done(&["statics", &write(folder.path(), "scene.toml", &content), "--out", &text(&out)]);
        let summary = json(&out.join("summary.json"));
        ["x", "y", "z", "tilt_y", "tilt_z"]
            .map(|name| summary["inner_race"]["position"][name]["value"].as_f64().unwrap())
    });
    let [free, held] = rows;
    assert!(free[3].abs() > 1e-5 && free[4].abs() > 1e-5, "{free:?}");
    for (free, held) in free.iter().zip(&held) {
        // Both searches end at 1e-10 of the load.
        assert!((free - held).abs() <= 1e-8 * held.abs(), "{free:?} {held:?}");
    }
}

/// A loose race rolls in its bore from one row of nodes to the next: in a valley of the energy that is flat along and as steep as contacts
/// across, over saddles between rows, and with a bend where the next row begins to touch. One search of a hundred ended in none of them.
#[test]
fn loose_races_of_any_fit_find_their_equilibrium() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = text(&folder.path().join("out"));
    let fits = "housing.fit.radial=-10 um, -9.48717948717949 um, -8.97435897435897 um, -8.46153846153846 um, -4.78260869565217 um, \
                -3.91304347826087 um, -2.82051282051282 um";
    let clearances = "bearing.left.clearance.radial=12.1739130434783 um, 12.3076923076923 um, 12.8205128205128 um, \
                      13.0434782608696 um, 13.3333333333333 um";
    let path = scene("shaft_in_two_housings.toml");
    let said = done(&["sweep", &path, "--vary", fits, "--vary", clearances, "--out", &out]);
    assert!(said.contains("35 points in"), "{said}");
}

/// A bearing without a housing of its own and without a common one has none, whatever others have; what is wrong is said of the
/// bearing that it is about.
#[test]
fn one_bearing_in_a_housing_and_one_without() {
    let folder = tempfile::tempdir().expect("a folder");
    let own =
        [("[housing]", "[housing.left]"), ("[solid.right.mesh]\ngenerate = \"housing-d\"", "")];
    let with = |name: &str, more: &[(&str, &str)]| {
        variant(folder.path(), name, &[&own[..], more].concat())
    };
    let fixed = [("[outer_race]", "[outer_race.left]")];
    // The right one stands fixed, or is called rigid.
    let out = text(&folder.path().join("out"));
    let none = with("none", &fixed);
    done(&["statics", &none, "--out", &out]);
    let summary = json(&Path::new(&out).join("summary.json"));
    let housings = &summary["housings"];
    assert!(housings["left"].is_object() && housings["right"].is_null(), "{housings}");
    let rigid = ("[numerics]", "[housing.right]\nmethod = \"rigid\"\n[numerics]");
    let rigid = with("rigid", &[fixed[0], rigid]);
    for path in [&none, &rigid] {
        done(&["check", path]);
        done(&["plan", path]);
    }
    // A common housing is that of both.
    let common = [own[1], fixed[0]];
    let message = refused(&["check", &variant(folder.path(), "common", &common)]);
    let place = "common.toml:25:";
    for part in [
        "outer_race.right.motion: refused",
        place,
        "[outer_race.right], or method = \"rigid\" in [housing.right]",
    ] {
        assert!(message.contains(part), "{part}: {message}");
    }
    // A solid of its own asks for a housing.
    let message = refused(&["check", &variant(folder.path(), "solid", &[own[0], fixed[0]])]);
    assert!(message.contains("solid.right") && message.contains("[housing.right]"), "{message}");
}
