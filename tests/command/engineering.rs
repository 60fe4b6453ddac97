//! What an engineer meets with an ordinary bearing: all results of hundreds of catalogue bearings, defaults, friction,
//! folders, fits.

use crate::command_line_common;

use command_line_common::{DEEP_GROOVE, bearing, done, json, refused, scene, text, write};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// Bore and outside diameter of deep-groove bearings of three series, mm.
const SIZES: [[f64; 2]; 30] = [
    [10.0, 26.0],
    [12.0, 28.0],
    [15.0, 32.0],
    [17.0, 35.0],
    [20.0, 42.0],
    [25.0, 47.0],
    [30.0, 55.0],
    [35.0, 62.0],
    [40.0, 68.0],
    [50.0, 80.0],
    [10.0, 30.0],
    [12.0, 32.0],
    [15.0, 35.0],
    [17.0, 40.0],
    [20.0, 47.0],
    [25.0, 52.0],
    [30.0, 62.0],
    [35.0, 72.0],
    [40.0, 80.0],
    [50.0, 90.0],
    [10.0, 35.0],
    [12.0, 37.0],
    [15.0, 42.0],
    [17.0, 47.0],
    [20.0, 52.0],
    [25.0, 62.0],
    [30.0, 72.0],
    [35.0, 80.0],
    [40.0, 90.0],
    [50.0, 110.0],
];

fn catalogue_bearing([bore, outside]: [f64; 2], variant: usize) -> String {
    let (pitch, ball) = (0.25 * (bore + outside), 0.3 * (outside - bore));
    let balls = ((0.6 * std::f64::consts::TAU * pitch / ball) as usize).max(6);
    let clearance = [0, 5, 10, -3, 20][variant % 5];
    let phase = [-90, 0, 13][variant % 3];
    let force = 47.0
        * ball.powf(1.8)
        * (balls as f64).powf(2.0 / 3.0)
        * [0.01, 0.05, 0.1, 0.2][variant % 4];
    let mut loads = match variant % 3 {
        0 => format!("z = {{ load = \"-{force} N\" }}\n"),
        1 => format!("x = {{ load = \"{} N\" }}\nz = {{ load = \"-{force} N\" }}\n", 0.3 * force),
        _ => format!("x = {{ load = \"{force} N\" }}\n"),
    };
    if variant >= 12 {
        loads += "tilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n";
    }
    format!(
        "[bearing]\nkind = \"deep-groove\"\nballs = {balls}\nball_phase = \"{phase} deg\"\n\
         pitch_radius = \"{pitch} mm\"\nclearance = {{ radial = \"{clearance} um\" }}\n\
         inner_race = {{ conformity = 0.515 }}\nouter_race = {{ conformity = 0.525 }}\n\
         ball = {{ diameter = \"{ball} mm\" }}\n[inner_race]\n{loads}"
    )
}

/// Thirty sizes with seventeen clearances, phases and loads: every one has its results and its default pictures.
#[test]
fn catalogue_bearings_have_all_results() {
    let root = tempdir().unwrap();
    for size in SIZES {
        for variant in 0..17 {
            let path = write(root.path(), "scene.toml", &catalogue_bearing(size, variant));
            let out = root.path().join("out");
            let run = bearing(&["statics", &path, "--out", &text(&out)]);
            assert_eq!(run.code, Some(0), "{size:?} {variant}: {}", run.stderr);
            for file in ["summary.json", "series.csv", "load_zone.svg", "polar.svg"] {
                assert!(out.join(file).is_file(), "{size:?} {variant}: {file}");
            }
            fs::remove_dir_all(&out).unwrap();
        }
    }
}

/// Fails from the neighbouring position of its balls, but not from the start of its own search.
#[test]
fn the_polar_plot_searches_as_the_scene_does() {
    let root = tempdir().unwrap();
    let path = write(
        root.path(),
        "polar.toml",
        "[bearing]\nkind = \"deep-groove\"\nballs = 9\nball_phase = \"-90 deg\"\npitch_radius = \"19.25 mm\"\n\
         clearance = { radial = \"10 um\", through = \"outer-race\" }\ninner_race = { conformity = 0.515 }\n\
         outer_race = { conformity = 0.525 }\nball = { diameter = \"7.938 mm\" }\n\
         [inner_race]\nz = { load = \"-2 kN\" }\n",
    );
    let out = root.path().join("out");
    done(&["statics", &path, "--set", "defaults=dissertation", "--out", &text(&out)]);
    assert!(out.join("polar.svg").is_file());
    let none = root.path().join("none");
    done(&["statics", &path, "--set", "output.plots=[]", "--out", &text(&none)]);
    assert!(none.join("summary.json").is_file() && !none.join("load_zone.svg").exists());
    let message = refused(&["statics", &path, "--dry", "--set", "output.plots=[\"pie\"]"]);
    assert!(message.contains("pie"), "{message}");
    let turned = ["statics", &path, "--dry", "--set", "bearing.reversed=true"];
    assert!(!done(&turned).contains("note: statics draws"));
    let said = done(&[&turned[..], &["--set", "output.plots=[\"polar\"]"]].concat());
    assert!(said.contains("not `reversed`"), "{said}");
}

#[test]
fn a_set_of_defaults_decides_four_keys() {
    let root = tempdir().unwrap();
    let bare = DEEP_GROOVE.replace("defaults = \"dissertation\"\n", "");
    let path = write(root.path(), "scene.toml", &bare);
    for (set, expected) in
        [("engineering", ["exact", "3", "true"]), ("dissertation", ["hamrock-brewe", "1", "false"])]
    {
        let changes = ["numerics.end=1 ms", "inner_race.speed=100 rpm"];
        let mut arguments = vec!["check", &path];
        let of = format!("defaults={set}");
        changes.iter().for_each(|change| arguments.extend(["--set", change]));
        // The first set counts where none is named.
        if set == "dissertation" {
            arguments.extend(["--set", &of]);
        }
        let said = done(&arguments);
        let keys = ["bearing.hertz", "traction.points_across", "traction.differential_sliding"];
        for (key, value) in keys.into_iter().zip(expected) {
            let line = format!("{key} = {value} ({set} defaults: ");
            assert!(said.contains(&line), "{line}: {said}");
        }
    }
}

/// Friction of the 6205 at 1500 rpm and 2 kN: differential sliding makes its torque that of Palmgren's load-dependent
/// moment; without it friction is lower by a factor of thousands.
#[test]
fn friction_torque_is_reported() {
    let root = tempdir().unwrap();
    let shipped = scene("bearing_6205_run.toml");
    let torque = |set: &str| {
        let out = root.path().join(set);
        let of = format!("defaults={set}");
        let changes = ["--set", "numerics.end=0.04 s", "--set", "output.plots=[]", "--set", &of];
        let said = done(&[&["run", &shipped, "--out", &text(&out)][..], &changes].concat());
        assert!(said.contains("friction torque") && said.contains("power loss"), "{said}");
        let (_, power) = said.split_once("power loss ").unwrap();
        assert!(!power.split_once(" W").unwrap().0.contains('e'), "{said}");
        assert!(said.contains("BPFO") && said.contains("2 BSF"), "{said}");
        let summary = json(&out.join("summary.json"));
        let value = |key: &str| summary["friction"][key]["value"].as_f64().unwrap();
        let parts = value("balls_on_races") + value("cage");
        assert!((parts - value("power_loss")).abs() <= 1e-12 * parts.abs());
        let speed = summary["kinematics"]["inner_race_speed"]["value"].as_f64().unwrap();
        assert!((value("torque") * speed - value("power_loss")).abs() <= 1e-12 * parts.abs());
        assert!(summary["energy"]["work_traction"]["value"].as_f64().unwrap() < 0.0);
        value("torque")
    };
    let [real, flat] = ["engineering", "dissertation"].map(torque);
    // Palmgren: 0.0009 (P0/C0)^0.55 F d_m, with C0 = 7.8 kN.
    let palmgren = 0.0009 * (2.0f64 / 7.8).powf(0.55) * 2000.0 * 38.5e-3;
    assert!((0.7..1.4).contains(&(real / palmgren)), "{real} {palmgren}");
    assert!(flat.abs() <= 1e-3 * real, "{flat} {real}");
}

#[test]
fn balls_loaded_by_their_weight_alone_do_not_count() {
    let root = tempdir().unwrap();
    let scene = format!(
        "{DEEP_GROOVE}[inner_race]\nz = {{ load = \"-1 kN\" }}\ntilt_y = {{ tilt = \"0 deg\" }}\n\
         tilt_z = {{ tilt = \"0 deg\" }}\n[ball_forces]\ngravity = [\"0 g\", \"0 g\", \"-1 g\"]\n"
    );
    let path = write(root.path(), "scene.toml", &scene);
    let out = root.path().join("out");
    let loose = "bearing.clearance.radial=20 um";
    let said = done(&[
        "statics",
        &path,
        "--set",
        loose,
        "--set",
        "bearing.balls=12",
        "--out",
        &text(&out),
    ]);
    let zone = &json(&out.join("summary.json"))["load_zone"];
    let largest = zone["largest_outer_load"]["value"].as_f64().unwrap();
    let table = fs::read_to_string(out.join("series.csv")).unwrap();
    let column = |name: &str| {
        table.lines().next().unwrap().split(',').position(|c| c.starts_with(name)).unwrap()
    };
    let outer = column("outer_load");
    let loads =
        table.lines().skip(1).map(|row| row.split(',').nth(outer).unwrap().parse::<f64>().unwrap());
    let loads: Vec<f64> = loads.collect();
    let (any, counted) = (
        loads.iter().filter(|load| **load > 0.0).count(),
        loads.iter().filter(|load| **load >= 0.01 * largest).count(),
    );
    assert!(any > counted, "{loads:?}");
    assert_eq!(zone["balls_loaded_outer"], counted);
    // The printed line counts loads of the inner race, on which balls at the top rest.
    let inner = column("inner_load");
    let loads = table.lines().skip(1).map(|row| row.split(',').nth(inner).unwrap());
    let loads: Vec<f64> = loads.map(|cell| cell.parse().unwrap()).collect();
    let most = loads.iter().copied().fold(0.0, f64::max);
    let counted = loads.iter().filter(|load| **load >= 0.01 * most).count();
    assert!(loads.iter().filter(|load| **load > 0.0).count() > counted, "{loads:?}");
    assert!(said.contains(&format!("{counted} of 12 balls loaded")), "{counted}: {said}");
}

#[test]
fn a_folder_of_other_files_is_not_ours() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.toml", DEEP_GROOVE);
    let folder = root.path().join("mine");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("notes.txt"), "mine").unwrap();
    for command in ["statics", "modes"] {
        let message = refused(&[command, &path, "--out", &text(&folder)]);
        assert!(message.contains("holds notes.txt") && message.contains("--out"), "{message}");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

/// The housing's bore decides the fit, and the race's own radius must be near it.
#[test]
fn the_race_must_fit_its_bore() {
    let shipped = scene("housing_c_tet10.toml");
    let radius = |value: &str| format!("bearing.outer_race.outer_radius={value}");
    let message = refused(&["check", &shipped, "--set", &radius("34 mm")]);
    assert!(message.contains("35.527") && message.contains("34.0000"), "{message}");
    let said = done(&["check", &shipped, "--set", &radius("35.500 mm")]);
    assert!(said.contains("outer_race.outer_radius would make it -27.0000 um"), "{said}");
    let said = done(&["check", &shipped]);
    assert!(!said.contains("would make it"), "{said}");
}

/// K of bearing and housing in series: K_b − K_b (K_b + K_h)⁻¹ K_b, here by solving for unit displacements of the shaft.
#[test]
fn a_shaft_in_a_housing_is_softer_than_its_bearing() {
    let root = tempdir().unwrap();
    let out = root.path().join("out");
    let shipped = scene("housing_c_tet10.toml");
    let said = done(&["statics", &shipped, "--out", &text(&out)]);
    assert!(
        said.contains("shaft against the ground") && said.contains("from race to race"),
        "{said}"
    );
    let summary = json(&out.join("summary.json"));
    let of = |section: &str, axis: &str| {
        let value: &Value = &summary[section][axis][axis]["value"];
        value.as_f64().unwrap_or_else(|| panic!("{section} {axis}"))
    };
    for axis in ["y", "z"] {
        let [bearing, ground] = ["stiffness", "stiffness_to_ground"].map(|s| of(s, axis));
        let housing = said.split("housing stiffness ").nth(1).unwrap();
        let housing: f64 = match axis {
            "y" => housing.split(" N/um along y").next().unwrap().parse().unwrap(),
            _ => {
                let rest = housing.split("along y, ").nth(1).unwrap();
                rest.split(" N/um along z").next().unwrap().parse().unwrap()
            }
        };
        // In series, but for the coupling with tilts.
        let series = 1.0 / (1.0 / bearing + 1e-6 / housing);
        assert!(ground < bearing && (ground - series).abs() <= 0.15 * series, "{ground} {series}");
    }
    assert!(Path::new(&out.join("series.csv")).is_file());
    // A race that slides in its bore holds no shaft along its axis.
    let out = root.path().join("slides");
    done(&["statics", &shipped, "--set", "housing.axial=free", "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    let of = |section: &str, axis: &str| summary[section][axis][axis]["value"].as_f64().unwrap();
    assert!(of("stiffness", "x") > 1e6 && of("stiffness_to_ground", "x") == 0.0);
    assert!(of("stiffness_to_ground", "z") > 1e6);
}
