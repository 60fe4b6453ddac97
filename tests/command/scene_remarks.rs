//! What commands say of what a scene asks for: dents at the start, rows beside what turns, what statics have and have not.

use super::run_command::{bearing, code, run, said, scene};
use super::run_remarks::HELD;
use crate::solid_command_common::{Place, json, stderr};

use std::fs;

/// A start in the equilibrium of races without dents drops a ball that stands at one.
#[test]
fn a_run_that_begins_with_a_ball_on_a_dent_says_so() {
    let place = Place::new();
    let said_in = |groove: &str, angle: &str, start: &str| {
        let numerics = format!("end = \"0.1 ms\"\nstep = \"2 us\"\nstart = \"{start}\"");
        let dent = format!(
            "[[bearing.dent]]\nrace = \"outer\"\nangle = \"{angle}\"\ndiameter = \"500 um\"\n\
             groove_angle = \"{groove}\"\n"
        );
        let text = scene(&numerics, "plots = []")
            .replace("[bearing.cage]", &format!("{dent}[bearing.cage]"));
        let output = run(&place.scene("scene.toml", &text), &place.path("out"), &[]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        said(&output).contains("a ball stands at the dent of the outer race")
    };
    let said_at = |angle: &str, start: &str| said_in("0 deg", angle, start);
    // A groove of 6.3 mm: 15 deg are 1.7 mm beside its bottom, where contacts reach, 30 deg are 3.3 mm.
    assert!(said_in("15 deg", "270 deg", "equilibrium"));
    assert!(!said_in("30 deg", "270 deg", "equilibrium"));
    // Balls every 45 deg from Y on; a dent of 0.25 mm to either side at 32 mm reaches 0.45 deg, half a contact 0.2 more.
    for (angle, near) in
        [("270 deg", true), ("270.5 deg", true), ("-89.5 deg", true), ("271 deg", false)]
    {
        assert_eq!(said_at(angle, "equilibrium"), near, "{angle}");
    }
    assert!(!said_at("270 deg", "nominal"));
}

/// Rows beat with what turns: a window of them says nothing of it.
#[test]
fn rows_that_are_too_far_apart_are_told() {
    let place = Place::new();
    let said_with = |interval: &str, load: &str| {
        let numerics = format!("end = \"2 ms\"\nstep = \"2 us\"\noutput_interval = \"{interval}\"");
        let text = scene(&numerics, "plots = []").replace("{ load = \"-250 N\" }", load);
        let output = run(&place.scene("scene.toml", &text), &place.path("out"), &[]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        said(&output)
    };
    let swing = "{ load = { mean = \"-250 N\", amplitude = \"50 N\", frequency = \"1000 Hz\" } }";
    let told = said_with("0.6 ms", swing);
    assert!(told.contains("half a period of inner_race.z (1000 Hz)"), "{told}");
    assert!(!said_with("0.4 ms", swing).contains("half a period"));
    assert!(!said_with("0.6 ms", "{ load = \"-250 N\" }").contains("half a period"));
    // An outer race that moves by itself is driven, too.
    let outer = format!(
        "[outer_race]\nmotion = \"5-dof\"\nz = {swing}\nfoundation = {{ stiffness = {{ x = \"1e8 N/m\", y = \"1e8 N/m\", \
         z = \"1e8 N/m\", tilt_y = \"1e5 N m/rad\", tilt_z = \"1e5 N m/rad\" }} }}\n[ball_forces]"
    );
    let text = scene("end = \"2 ms\"\nstep = \"2 us\"\noutput_interval = \"0.6 ms\"", "plots = []");
    let text = text.replace("[ball_forces]", &outer);
    let output = run(&place.scene("scene.toml", &text), &place.path("out"), &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(said(&output).contains("half a period of outer_race.z (1000 Hz)"), "{}", said(&output));
    // An outer race that turns takes the balls along, past a load that stands still.
    let turning = "[outer_race]\nmotion = \"5-dof\"\nspeed = \"600 rpm\"\nx = { displacement = \"0 um\" }\ny = { displacement = \"0 um\" }\n\
                   z = { displacement = \"0 um\" }\ntilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n[ball_forces]";
    let numerics = "end = \"40 ms\"\nstep = \"2 us\"\noutput_interval = \"20 ms\"";
    let text = scene(numerics, "plots = [\"spectrum\"]").replace("1000 rpm", "0 rpm");
    let text = text.replace("[ball_forces]", turning);
    let output = run(&place.scene("scene.toml", &text), &place.path("out"), &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let told = said(&output);
    assert!(told.contains("half a period of balls passing the load (49.1"), "{told}");
    // What comes once has no period, however fast it comes.
    let once =
        "{ load = { ramp = [\"-250 N\", \"-300 N\"], start = \"1 ms\", duration = \"0.1 ms\" } }";
    assert!(!said_with("0.6 ms", once).contains("half a period"));
}

/// What a run has on the inner race and an equilibrium has not.
#[test]
fn statics_say_what_runs_have_besides() {
    let place = Place::new();
    let said_of = |mass: &str| {
        let text = scene("end = \"1 ms\"", "plots = []").replace(
            "speed = \"1000 rpm\"",
            &format!("speed = \"1000 rpm\"\nadded_mass = \"{mass}\""),
        );
        let path = place.scene("scene.toml", &text);
        said(&bearing(&["statics", path.to_str().unwrap(), "--dry"]))
    };
    let heavy = said_of("20 kg");
    assert!(heavy.contains("in a run is left out: its weight, 19"), "{heavy}");
    assert!(!said_of("0.1 kg").contains("in a run is left out"));
}

/// An outer race that moves by itself is part of the equilibrium, as it is where a run starts.
#[test]
fn statics_of_a_moving_outer_race_are_the_start_of_its_run() {
    let place = Place::new();
    let outer = "[outer_race]\nmotion = \"5-dof\"\nz = { load = \"-1000 N\" }\n[outer_race.foundation]\n\
                 stiffness = { x = \"1e7 N/m\", y = \"1e7 N/m\", z = \"1e7 N/m\", tilt_y = \"1e4 N m/rad\", tilt_z = \"1e4 N m/rad\" }\n";
    let text = scene("end = \"20 us\"\nstep = \"2 us\"\noutput_interval = \"10 us\"", "plots = []")
        .replace(
            "gravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.80665 m/s^2\"]",
            "gravity = [\"0 m/s^2\", \"0 m/s^2\", \"0 m/s^2\"]",
        )
        .replace("[traction]", &format!("{outer}[traction]"));
    let path = place.scene("scene.toml", &text);
    let (still, moving) = (place.path("still"), place.path("moving"));
    let [path, still_text] = [&path, &still].map(|path| path.to_str().unwrap());
    let output = bearing(&["statics", path, "--out", still_text]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(code(&run(path.as_ref(), &moving, &[])), 0);
    let rows = fs::read_to_string(moving.join("series.csv")).unwrap();
    let header: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
    let first: Vec<&str> = rows.lines().nth(1).unwrap().split(',').collect();
    let at = |name: &str| {
        let column = header.iter().position(|column| column.starts_with(name)).unwrap();
        first[column].parse::<f64>().unwrap()
    };
    let summary = json(still.join("summary.json"));
    // 1250 N on 1e7 N/m; balls that go round push besides, 0.04 N here.
    assert!((at("outer_z") + 125e-6).abs() <= 1e-8, "{}", at("outer_z"));
    for (body, column) in [("inner_race", "inner_z"), ("outer_race", "outer_z")] {
        let still = &summary["bodies"][body]["position"]["z"];
        assert_eq!(still["unit"], "m");
        let off = still["value"].as_f64().unwrap() - at(column);
        assert!(off.abs() <= 1e-8, "{body}: {off:e}");
    }
    let said = said(&bearing(&[
        "sweep",
        path,
        "--vary",
        "outer_race.z.load=-1000 N, 0 N",
        "--out",
        place.path("sweep").to_str().unwrap(),
    ]));
    assert!(said.contains("2 points"), "{said}");
    let table = fs::read_to_string(place.path("sweep").join("sweep.csv")).unwrap();
    let [one, other] = [1, 2].map(|row| table.lines().nth(row).unwrap().split_once(',').unwrap().1);
    assert_ne!(one.split_once(',').unwrap().1, other.split_once(',').unwrap().1);
}

/// Springs of a bushing know nothing of its wall.
#[test]
fn statics_say_how_far_a_bushing_is_pushed() {
    let shipped = crate::command_line_common::scene("bearing_on_bushing.toml");
    let said_under = |load: &str| {
        let set = format!("inner_race.z.load={load}");
        let output = bearing(&["statics", &shipped, "--dry", "--set", &set]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        said(&output)
    };
    // Some 1.7e6 N/m across, a wall of 10 mm.
    assert!(!said_under("-1000 N").contains("is pushed by"));
    let far = said_under("-8000 N");
    assert!(far.contains("bushing mount is pushed by") && !far.contains("beyond it"), "{far}");
    assert!(said_under("-20000 N").contains("its wall is 10.000 mm, beyond it"));
}

/// A load that has just begun would move the equilibrium at once.
#[test]
fn a_load_that_changes_from_the_start_on_is_told() {
    let place = Place::new();
    let ramp = |start: &str| {
        format!("{{ load = {{ ramp = [\"0 N\", \"-250 N\"], duration = \"10 ms\"{start} }} }}")
    };
    let told = |load: &str, start: &str| {
        let numerics = format!("end = \"0.1 ms\"\nstep = \"2 us\"\nstart = \"{start}\"");
        let text = scene(&numerics, "plots = []").replace("{ load = \"-250 N\" }", load);
        let output = run(&place.scene("scene.toml", &text), &place.path("out"), &[]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        said(&output).contains("the load inner_race.z changes from t = 0 on")
    };
    assert!(told(&ramp(""), "equilibrium"));
    assert!(!told(&ramp(", start = \"1 ms\""), "equilibrium"));
    assert!(!told(&ramp(""), "nominal"));
    assert!(!told("{ load = \"-250 N\" }", "equilibrium"));
}

/// A loose race that spins is held by nothing: there are no motions to tell, which is no error.
#[test]
fn modes_of_a_loose_race_that_spins_are_none() {
    let place = Place::new();
    let text = scene("end = \"1 ms\"", "plots = []")
        .replace("\"-5 um\"", "\"10 um\"")
        .replace("z = { load = \"-250 N\" }\n", "")
        .replace("tilt_y = { tilt = \"0.05 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n", "")
        .replace("\"-9.80665 m/s^2\"", "\"0 m/s^2\"");
    let scene = place.scene("scene.toml", &text);
    let output = bearing(&["modes", scene.to_str().unwrap(), "--dry"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(said(&output).contains("nothing holds what spins in this equilibrium"));
}

/// Ratios to the shaft are those of the frequencies beside them, where the outer race turns too.
#[test]
fn frequencies_over_the_shaft_are_that() {
    let place = Place::new();
    let frequencies = |inner: f64, outer: f64| {
        let turning =
            format!("[outer_race]\nmotion = \"5-dof\"\nspeed = \"{outer} rpm\"\n{HELD}[traction]");
        let text = scene("end = \"1 ms\"", "plots = []")
            .replace("1000 rpm", &format!("{inner} rpm"))
            .replace("[traction]", &turning);
        let out = place.path("out");
        let path = place.scene("scene.toml", &text);
        let arguments = ["statics", path.to_str().unwrap(), "--out", out.to_str().unwrap()];
        let output = bearing(&arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let summary = json(out.join("summary.json"));
        let all = &summary["bearings"]["bearing"]["frequencies"];
        if all.is_null() { summary["frequencies"].clone() } else { all.clone() }
    };
    for (inner, outer) in [(1000.0, 0.0), (1000.0, 400.0), (1000.0, -400.0), (0.0, 400.0)] {
        let all = frequencies(inner, outer);
        let (name, turns) =
            if inner == 0.0 { ("over_outer_race", outer) } else { ("over_shaft", inner) };
        for of in ["cage", "ball_pass_outer", "ball_pass_inner", "ball_spin"] {
            let value = |name: &str| all[of][name]["value"].as_f64();
            let expected = value("frequency").unwrap() / (turns / 60.0);
            let found = value(name).unwrap_or_else(|| panic!("{name}: {all}"));
            assert!((found / expected - 1.0).abs() <= 1e-12, "{inner} {outer} {of}: {all}");
        }
    }
}
