//! What people read of several bearings: one frame, one place to count from, and what a bearing alone has as well.

use crate::assembly_common::{BEARING, ENDS, RUN, SHAFT};
use crate::command_line_common::{
    DEEP_GROOVE, changed, done, json, read, refused, scene, text, write,
};
use serde_json::Value;
use std::path::Path;

fn value(of: &Value) -> f64 {
    of["value"].as_f64().unwrap_or_else(|| panic!("no value in {of}"))
}

/// What `statics` says and writes of a scene.
fn statics(scene: &str) -> (String, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(folder.path(), "scene.toml", scene);
    let out = folder.path().join("out");
    let said = done(&["statics", &path, "--out", &text(&out)]);
    (said, json(&out.join("summary.json")))
}

/// Summary of a run.
fn run(scene: &str) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(folder.path(), "scene.toml", scene);
    let out = folder.path().join("out");
    done(&["run", &path, "--out", &text(&out)]);
    json(&out.join("summary.json"))
}

/// The first row of a run.
fn first_row(scene: &str) -> impl Fn(&str) -> f64 + use<> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(folder.path(), "scene.toml", scene);
    let out = folder.path().join("out");
    done(&["run", &path, "--out", &text(&out)]);
    let csv = read(&out.join("series.csv"));
    let mut lines = csv.lines().map(str::to_string);
    let header = lines.next().expect("a header");
    let row = lines.next().expect("a row");
    move |name| {
        let at = header.split(',').position(|own| own.split(' ').next() == Some(name));
        let at = at.unwrap_or_else(|| panic!("{name} in {header}"));
        row.split(',').nth(at).expect("a cell").parse().expect("a number")
    }
}

/// Degrees from one angle to another, from −180 to 180.
fn turn(from: f64, to: f64) -> f64 {
    (to - from + 180.0).rem_euclid(360.0) - 180.0
}

const PHASE: &str = "ball_phase = \"20 deg\"\n";

/// Both bearings with ball 1 at 20 deg of their own.
fn phased() -> String {
    changed(BEARING, "balls = 11\n", &format!("balls = 11\n{PHASE}"))
}

#[test]
fn azimuths_of_a_reversed_bearing_are_those_of_the_scene() {
    let (said, summary) = statics(&[&phased(), ENDS, SHAFT].concat());
    for name in ["left", "right"] {
        let bearing = &summary["bearings"][name];
        for ball in bearing["balls"].as_array().expect("balls") {
            let [y, z] = ["y", "z"].map(|axis| value(&ball["position"][axis]));
            let seen = z.atan2(y).to_degrees();
            let told = value(&ball["azimuth"]);
            // Balls go a few micrometres, 0.01 deg of a pitch radius, off their meridian's middle.
            assert!(turn(seen, told).abs() <= 0.02, "{name}: {told} deg, at {seen} deg");
            assert!((0.0..360.0 + 20.0).contains(&told), "{told}");
        }
    }
    let azimuth = |name: &str| value(&summary["bearings"][name]["balls"][0]["azimuth"]);
    assert!(turn(azimuth("left"), 20.0).abs() <= 1e-9, "{}", azimuth("left"));
    assert!(turn(azimuth("right"), 160.0).abs() <= 1e-9, "{}", azimuth("right"));
    let table = said.split("bearing right").nth(1).expect("the right bearing");
    assert!(table.contains("   1  160.000"), "{table}");
    // A run places them alike, and races of one shaft have its tilts and speed.
    let row = first_row(&[&phased(), ENDS, SHAFT, RUN].concat());
    for (name, at) in [("left", 20.0), ("right", 160.0)] {
        let told = row(&format!("{name}_ball_1_angle"));
        assert!(turn(told, at).abs() <= 0.02, "{name}: {told} deg");
        for of in ["tilt_y", "tilt_z", "speed"] {
            let [race, shaft] =
                [format!("{name}_inner_{of}"), format!("shaft_{of}")].map(|column| row(&column));
            assert!((race - shaft).abs() <= 1e-9 * shaft.abs().max(1e-3), "{of}: {race}, {shaft}");
        }
    }
}

/// What carries the load lies where it is, whichever way round a bearing without a side is put in.
#[test]
fn a_symmetric_bearing_reads_alike_both_ways_round() {
    let scene = |reversed: &str| {
        let shaft = changed(SHAFT, "y = { load = \"30 N\" }", "y = { load = \"300 N\" }");
        let ends = format!(
            "[bearing.left]\ninner_at = \"-40 mm\"\n[bearing.right]\ninner_at = \"40 mm\"\n{reversed}\n"
        );
        [DEEP_GROOVE, &ends, &shaft].concat()
    };
    let loads = |summary: &Value| {
        let mut loads: Vec<[f64; 2]> = summary["bearings"]["right"]["balls"]
            .as_array()
            .expect("balls")
            .iter()
            .map(|ball| [value(&ball["azimuth"]), value(&ball["inner"]["load"])])
            .map(|[azimuth, load]| [(azimuth + 0.5).rem_euclid(360.0).round(), load])
            .collect();
        loads.sort_by(|a, b| a[0].total_cmp(&b[0]));
        loads
    };
    let [one, other] = ["", "reversed = true"].map(|way| loads(&statics(&scene(way)).1));
    let largest = one.iter().fold(0.0f64, |most, [_, load]| most.max(*load));
    assert!(largest > 100.0 && one.len() == 8, "{one:?}");
    for ([at, load], [there, same]) in one.iter().zip(&other) {
        // Statics stops at 1e-11 of the largest load; stiff directions lose some digits of the place.
        assert!(at == there && (load - same).abs() <= 1e-7 * largest, "{one:?} and {other:?}");
    }
}

/// A cage has the angle and the speed of its bearing's balls whichever way round.
#[test]
fn the_cage_of_a_reversed_bearing_turns_as_its_balls_do() {
    const CAGE: &str = r#"
[bearing.cage]
pocket_radius = "6.2 mm"
inner_radius = "28.5 mm"
outer_radius = "32 mm"
race_clearance = "0.3 mm"
mass = "0.05 kg"
guidance = "outer-race"
"#;
    let short = changed(RUN, "\"2 ms\"", "\"0.1 ms\"");
    let row = first_row(&[BEARING, CAGE, ENDS, SHAFT, &short].concat());
    for name in ["left", "right"] {
        let [speed, ball] =
            ["cage_speed", "ball_1_orbital_speed"].map(|of| row(&format!("{name}_{of}")));
        assert!((speed / ball - 1.0).abs() <= 0.01, "{name}: {speed} and {ball} rad/s");
        assert!(row(&format!("{name}_cage_angle")).abs() <= 1e-9, "{name}");
        assert!(row(&format!("{name}_cage_tilt_y")).abs() <= 1.0, "{name}");
    }
}

/// One rule: X counts from where the bearing sits, in the table, the summary and the run.
#[test]
fn given_places_of_outer_races_count_from_their_bearing() {
    const MOVING: &str = "motion = \"5-dof\"\nfoundation = { stiffness = { y = \"1e8 N/m\", z = \"1e8 N/m\", \
         tilt_y = \"1e5 N m/rad\", tilt_z = \"1e5 N m/rad\" } }\n";
    let given = |um: &str| format!("x = {{ displacement = \"{um} um\" }}\n{MOVING}");
    let ends = changed(ENDS, "x = \"-6 um\"\n", &given("-6"));
    let ends = changed(&ends, "x = \"6 um\"\n", &given("6"));
    let whole = [BEARING, &ends, SHAFT].concat();
    let (said, summary) = statics(&whole);
    let row = first_row(&[&whole, RUN].concat());
    for (name, um) in [("left", -6.0), ("right", 6.0)] {
        let body = format!("the outer race of bearing {name}");
        let table = said.split(&body).nth(1).expect("the race").lines().nth(1).expect("x");
        let shown: f64 = table.split_whitespace().nth(1).expect("x").parse().expect("a number");
        assert!((shown - um).abs() <= 1e-6, "{shown} um in {table:?}");
        let body = &summary["bodies"][body.trim_start_matches("the ").replace(' ', "_")];
        let written = 1e6 * value(&body["position"]["x"]);
        // 40 mm and 6 um in one number are good to 1e-11 um.
        assert!((written - um).abs() <= 1e-9, "{written} um");
        let centre = 1e6 * value(&summary["bearings"][name]["outer_race"]["centre"]["x"]);
        assert!((centre - um).abs() <= 1e-9, "{centre} um");
        let moved = 1e6 * row(&format!("{name}_outer_x"));
        assert!((moved - um).abs() <= 1e-9, "{moved} um");
    }
}

#[test]
fn named_bearings_have_what_a_bearing_alone_has() {
    let (said, summary) = statics(&[BEARING, ENDS, SHAFT].concat());
    let (_, alone) = statics(&format!(
        "{BEARING}[inner_race]\nspeed = \"1000 rpm\"\nx = {{ load = \"400 N\" }}\n"
    ));
    for section in ["hertz", "frequencies"] {
        for name in ["left", "right"] {
            assert_eq!(summary[section][name], alone[section], "{section} of {name}");
        }
    }
    assert!(said.contains("stiffness           x, um"), "{said}");
    assert_eq!(said.matches("  tilt_z, N mm").count(), 1, "{said}");
}

/// An axle and a hub on two bearings, at these speeds in rpm.
fn on_a_hub(hub: f64, axle: f64) -> String {
    let on_hub =
        changed(BEARING, "balls = 11\n", "balls = 11\nouter_on = \"hub\"\ninner_on = \"axle\"\n");
    format!(
        r#"{on_hub}
[bearing.left]
inner_at = "-30 mm"
outer_at = "-30.005 mm"
[bearing.right]
inner_at = "30 mm"
outer_at = "30.005 mm"
reversed = true
[body.axle]
x = {{ displacement = "0 um" }}
y = {{ displacement = "0 um" }}
z = {{ displacement = "0 um" }}
tilt_y = {{ tilt = "0 deg" }}
tilt_z = {{ tilt = "0 deg" }}
speed = "{axle} rpm"
inertia = {{ mass = "1 kg", axial = "1e-4 kg m^2", transverse = "1e-3 kg m^2" }}
[body.hub]
speed = "{hub} rpm"
z = {{ load = "300 N" }}
inertia = {{ mass = "3 kg", axial = "5e-3 kg m^2", transverse = "5e-3 kg m^2" }}
[numerics]
end = "5 ms"
output_interval = "0.1 ms"
[traction]
law = "none"
[output]
plots = []
"#
    )
}

/// An axle that stands and a hub that turns: frequencies go by the difference of the speeds.
#[test]
fn a_hub_that_turns_has_the_frequencies_of_its_speed_against_the_axle() {
    let gamma = 5.953 / 30.0 * 35f64.to_radians().cos();
    for (hub, axle) in [(600.0, 0.0), (600.0, 1500.0)] {
        let [hub_hz, axle_hz] = [hub / 60.0, axle / 60.0];
        let cage = 0.5 * (1.0 - gamma) * axle_hz + 0.5 * (1.0 + gamma) * hub_hz;
        let text = on_a_hub(hub, axle);
        let (_, still) = statics(&text);
        let outer = 5.5 * (1.0 - gamma) * (axle_hz - hub_hz).abs();
        let moving = run(&text);
        for name in ["left", "right"] {
            let told = |what: &str| value(&still["frequencies"][name][what]["frequency"]);
            assert!((told("cage") / cage - 1.0).abs() <= 1e-12, "{} and {cage} Hz", told("cage"));
            assert!((told("ball_pass_outer") / outer - 1.0).abs() <= 1e-12, "{outer} Hz");
            let section = &moving["kinematics"][name];
            let turned = value(&section["outer_race_frequency"]);
            assert!((turned / hub_hz - 1.0).abs() <= 1e-9, "{turned} Hz");
            let nominal = value(&section["rolling_cage_speed_at_nominal_angle"]);
            assert!((nominal / (cage * std::f64::consts::TAU) - 1.0).abs() <= 1e-9, "{nominal}");
            // Balls start rolling; without friction nothing changes that in a fifth of a turn.
            let slip = value(&section["ball_set_slip"]);
            assert!(slip.abs() <= 0.01, "{slip}");
        }
    }
}

/// A hub whose load has no part along X and Y stands at zero there, not at what rounding leaves.
#[test]
fn rounding_is_no_displacement() {
    let (_, summary) = statics(&changed(&on_a_hub(600.0, 0.0), "300 N", "900 N"));
    for (axis, place) in summary["bodies"]["hub"]["position"].as_object().expect("a position") {
        let at = value(place).abs();
        assert!(at == 0.0 || at > 1e-14, "{axis}: {at:e}");
    }
    assert!(value(&summary["bodies"]["hub"]["position"]["z"]) > 1e-7);
}

/// The shipped scene of two housings, with these words changed.
fn housings(changes: &[(&str, &str)]) -> String {
    let shipped = read(Path::new(&scene("shaft_in_two_housings.toml")));
    changes.iter().fold(shipped, |text, (from, to)| changed(&text, from, to))
}

#[test]
fn keys_of_tables_that_are_not_there_are_varied_by_the_names_of_bearings() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(folder.path(), "scene.toml", &[BEARING, ENDS, SHAFT].concat());
    let in_housings =
        write(folder.path(), "housings.toml", &housings(&[("order = 2", "order = 1")]));
    let sweep = |path: &str, name: &str, vary: &str| {
        let out = folder.path().join(name);
        done(&["sweep", path, "--vary", vary, "--out", &text(&out)]);
        let csv = read(&out.join("sweep.csv"));
        let rows: Vec<String> = csv.lines().skip(1).map(str::to_string).collect();
        assert!(rows.len() == 2 && rows[0].split_once(',') != rows[1].split_once(','), "{csv}");
    };
    sweep(&path, "of_balls", "bearing.left.ball_phase=0 deg, 5 deg");
    sweep(&path, "of_race", "outer_race.left.y=0 um, 1 um");
    sweep(&in_housings, "of_housing", "housing.left.fit.radial=0 um, 1 um");
    sweep(&in_housings, "of_solid", "solid.left.material.youngs_modulus=70 GPa, 210 GPa");
    for (vary, words) in [
        ("bearing.lft.ball_phase=0 deg, 5 deg", "did you mean left?"),
        ("outer_race.lft.x=0 um, 1 um", "there are: left, right"),
        ("body.shft.z.load=0 N, 1 N", "no body \"shft\"; there are: shaft"),
    ] {
        let said = refused(&["sweep", &path, "--vary", vary, "--out", "none"]);
        assert!(said.contains(words), "{words:?} in {said:?}");
    }
}

/// One row of nodes resists no tilt: refused before anything is computed, whatever the method.
#[test]
fn a_race_on_one_row_of_nodes_is_refused_everywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    for method in ["reduced", "explicit", "quasi-static"] {
        let method = format!("method = \"{method}\"");
        // Rows at 0 and 10 mm from the middle.
        let one = housings(&[
            ("order = 2", "order = 1"),
            ("axial = 1", "axial = 2"),
            ("width = \"20 mm\"", "width = \"14 mm\""),
            ("method = \"reduced\"", &method),
        ]);
        let path = write(folder.path(), "row.toml", &one);
        for command in ["check", "plan", "statics", "run"] {
            let mut arguments = vec![command, &path];
            let out = text(&folder.path().join(command));
            if matches!(command, "statics" | "run") {
                arguments.extend(["--out", &out]);
            }
            let said = refused(&arguments);
            for word in ["housing.width", "in one row around it", "at least two rows", "row.toml:"]
            {
                assert!(said.contains(word), "{command}, {method}: {word:?} in {said:?}");
            }
        }
    }
}

#[test]
fn what_is_refused_of_a_body_or_a_housing_names_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let massless = [BEARING, ENDS, SHAFT, RUN].concat().replace("inertia = {", "# inertia = {");
    let path = write(folder.path(), "massless.toml", &massless);
    let said = refused(&["run", &path]);
    assert!(said.contains("to [body.shaft]") && !said.contains("[body.inertia]"), "{said}");
    for method in ["reduced", "quasi-static"] {
        let method = format!("method = \"{method}\"");
        let loose = housings(&[("method = \"reduced\"", &method)]);
        let (before, held) = loose.split_once("[[solid.fixed]]").expect("a support");
        let after = held.split_once("\n[").expect("a table after it").1;
        let path = write(folder.path(), "loose.toml", &format!("{before}[{after}"));
        for command in ["check", "statics"] {
            let mut arguments = vec![command, &path];
            if command == "statics" {
                arguments.push("--dry");
            }
            let said = refused(&arguments);
            assert!(said.contains("housing left: ") && said.contains("[[solid.fixed]]"), "{said}");
        }
    }
}

#[test]
fn a_default_that_is_written_is_no_difference() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = [BEARING, ENDS, SHAFT, RUN].concat();
    let results = ["", "output_interval = \"2 us\"\n"].map(|written| {
        let scene = changed(&whole, "output_interval = \"0.1 ms\"\n", written);
        let name = if written.is_empty() { "left" } else { "said" };
        let path = write(folder.path(), &format!("{name}.toml"), &scene);
        let out = text(&folder.path().join(name));
        done(&["run", &path, "--out", &out]);
        out
    });
    let [left, said] = &results;
    let told = done(&["compare", left, said]);
    assert!(told.contains("assumptions.numerics.output_interval"), "{told}");
    done(&["compare", said, left]);
}

#[test]
fn threads_that_change_nothing_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let short = changed(RUN, "\"2 ms\"", "\"0.1 ms\"");
    let path = write(folder.path(), "scene.toml", &[BEARING, ENDS, SHAFT, &short].concat());
    let out = text(&folder.path().join("out"));
    let said = done(&["run", &path, "--out", &out, "--threads", "2"]);
    assert!(said.contains("--threads has no effect here"), "{said}");
}
