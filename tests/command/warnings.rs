//! Each warning: a scene that raises it, and one next to it that does not.

use super::rubber_limits::{block, cube};
use super::run_command::scene;
use super::turning_springs::disc;
use crate::command_line_common::{
    ANGULAR_CONTACT, DEEP_GROOVE, bearing, changed, done, json, read, refusal, scene as shipped,
    text, write,
};
use crate::housed_command_common::scene_text;

use bearing_dynamics::output::warnings::TABLE;
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

/// Codes that a command prints, by their first three characters; its summary has the same warnings.
fn codes(command: &str, scene: &str) -> Vec<String> {
    let folder = tempdir().unwrap();
    let path = write(folder.path(), "scene.toml", scene);
    let out = folder.path().join("out");
    let out_text = text(&out);
    let writes = command != "plan";
    let further = if writes { vec!["--out", &out_text] } else { Vec::new() };
    let run = bearing(&[&[command, &path], &further[..]].concat());
    assert_eq!(run.code, Some(0), "{command}: {run:#?}");
    let printed: Vec<(&str, &str)> = run
        .stdout
        .lines()
        .filter_map(|line| line.strip_prefix("warning[")?.split_once("]: "))
        .collect();
    if writes {
        let summary = json(&out.join("summary.json"));
        let kept = summary["warnings"].as_array().expect("a list").iter();
        let of = |warning: &Value, key: &str| warning[key].as_str().unwrap().to_string();
        let kept: Vec<_> = kept.map(|one| (of(one, "code"), of(one, "text"))).collect();
        let printed: Vec<_> =
            printed.iter().map(|(code, text)| (code.to_string(), text.to_string())).collect();
        assert_eq!(kept, printed, "{command}");
    }
    for (code, _) in &printed {
        assert!(TABLE.iter().any(|entry| entry.name == *code), "{code}");
    }
    printed.iter().map(|(code, _)| code[..3].to_string()).collect()
}

/// The pairs whose `raising` scene has a code and whose `quiet` one has not.
fn assert_raised(code: &str, command: &str, raising: &str, quiet: &str) {
    let [found, none] = [raising, quiet].map(|scene| codes(command, scene));
    assert!(found.iter().any(|of| of == code), "{code} of {command}: {found:?}");
    assert!(none.iter().all(|of| of != code), "{code} of {command}: {none:?}");
}

/// One bearing that is pushed along its axis and else fixed, with what follows its races.
fn one_angular_contact(load: &str, rest: &str) -> String {
    let fixed = "y = { displacement = \"0 um\" }\nz = { displacement = \"0 um\" }\ntilt_y = { tilt = \"0 deg\" }\n\
                 tilt_z = { tilt = \"0 deg\" }\n";
    format!(
        "{ANGULAR_CONTACT}[inner_race]\nspeed = \"15000 rpm\"\nx = {{ load = \"{load}\" }}\n{fixed}{rest}"
    )
}

/// A bar of 100 × 10 × 10 mm, clamped at one end and bent at the other.
fn bar(order: u8, poisson: &str, force: &str) -> String {
    format!(
        "[solid.mesh]\ngenerate = \"bar\"\nlength = \"100 mm\"\nwidth = \"10 mm\"\nheight = \"10 mm\"\n\
         cells = {{ along = 24, across = 4, up = 4 }}\norder = {order}\n[solid.material]\npoisson_ratio = {poisson}\n\
         [[solid.fixed]]\nset = \"x_low\"\nx = true\ny = true\nz = true\n[[solid.load]]\nset = \"x_high\"\nz = \"{force}\"\n"
    )
}

/// A shipped scene with one text changed.
fn with(name: &str, from: &str, to: &str) -> String {
    changed(&read(Path::new(&shipped(name))), from, to)
}

#[test]
fn of_equilibria_of_bearings() {
    let gap = changed(DEEP_GROOVE, "-5 um", "10 um");
    assert_raised("W01", "statics", &gap, DEEP_GROOVE);
    // Loose balls that the load does not meet on its line: the race goes to one side.
    let loose = |balls: &str| {
        let scene = changed(&gap, "balls = 8", &format!("balls = {balls}"));
        scene + "[inner_race]\nz = { load = \"-250 N\" }\n"
    };
    let pressed = format!("{DEEP_GROOVE}[inner_race]\nz = {{ load = \"-250 N\" }}\n");
    assert_raised("W02", "statics", &loose("9"), &pressed);
    let short = scene("end = \"0.1 ms\"", "");
    let pressed = changed(&short, "\"-250 N\"", "\"-100 kN\"");
    // A shoulder hardly higher than the groove, and a tilt that lets the balls climb.
    let low = changed(&short, "bore_radius", "shoulder_radius = \"20.1 mm\", bore_radius");
    let low = changed(&low, "0.05 deg", "0.3 deg");
    let reversed = one_angular_contact("-445 N", "[numerics]\nend = \"0.5 ms\"\n");
    let forward = changed(&reversed, "-445 N", "445 N");
    for command in ["statics", "run"] {
        assert_raised("W03", command, &pressed, &short);
        assert_raised("W04", command, &low, &short);
        assert_raised("W05", command, &reversed, &forward);
    }
    let turned = changed(&reversed, "[bearing]\n", "[bearing]\nreversed = true\n");
    let turned = changed(&turned, "-445 N", "445 N");
    let root = tempdir().unwrap();
    for (content, remedy) in [(&reversed, "preload it along +x"), (&turned, "preload it along -x")]
    {
        let said = done(&["statics", &write(root.path(), "scene.toml", content), "--dry"]);
        assert!(said.contains(remedy), "{said}");
    }
    let flung = |counts: &str| {
        one_angular_contact("200 N", &format!("[ball_forces]\ncentrifugal = {counts}\n"))
    };
    assert_raised("W06", "statics", &flung("false"), &flung("true"));
    assert_raised("W06", "modes", &(flung("false") + MASS), &(flung("true") + MASS));
}

const MASS: &str = "[inner_race.inertia]\nmass = \"0.5 kg\"\naxial = \"2e-4 kg m^2\"\ntransverse = \"1.5e-4 kg m^2\"\n";

/// By whatever drives: a load on either race, a displacement of a solid, balls passing by where spectra are drawn; not by what comes once.
#[test]
fn of_rows() {
    let cycle = "{ load = { mean = \"-250 N\", amplitude = \"50 N\", frequency = \"1000 Hz\" } }";
    let once =
        "{ load = { ramp = [\"-250 N\", \"-300 N\"], start = \"1 ms\", duration = \"0.1 ms\" } }";
    let rows = |interval: &str, load: &str| {
        let numerics = format!("end = \"2 ms\"\nstep = \"2 us\"\noutput_interval = \"{interval}\"");
        changed(&scene(&numerics, "plots = []"), "{ load = \"-250 N\" }", load)
    };
    assert_raised("W07", "run", &rows("0.6 ms", cycle), &rows("0.4 ms", cycle));
    assert!(codes("run", &rows("0.6 ms", once)).is_empty());
    let outer = format!(
        "[outer_race]\nmotion = \"5-dof\"\nz = {cycle}\nfoundation = {{ stiffness = {{ x = \"1e8 N/m\", y = \"1e8 N/m\", \
         z = \"1e8 N/m\", tilt_y = \"1e5 N m/rad\", tilt_z = \"1e5 N m/rad\" }} }}\n[ball_forces]"
    );
    let outer =
        |interval: &str| changed(&rows(interval, "{ load = \"-250 N\" }"), "[ball_forces]", &outer);
    assert_raised("W07", "run", &outer("0.6 ms"), &outer("0.4 ms"));
    // An outer race that turns takes the balls along, past a load that stands still, 49 times a second.
    let turning = "[outer_race]\nmotion = \"5-dof\"\nspeed = \"600 rpm\"\nx = { displacement = \"0 um\" }\ny = { displacement = \"0 um\" }\n\
                   z = { displacement = \"0 um\" }\ntilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n[ball_forces]";
    let passing = |plots: &str| {
        let numerics = "end = \"40 ms\"\nstep = \"2 us\"\noutput_interval = \"20 ms\"";
        let text = changed(&scene(numerics, plots), "1000 rpm", "0 rpm");
        changed(&text, "[ball_forces]", turning)
    };
    assert_raised("W07", "run", &passing("plots = [\"spectrum\"]"), &passing("plots = []"));
    let solid = |interval: &str| {
        let numerics = format!("[numerics]\nend = \"2 ms\"\noutput_interval = \"{interval}\"\n");
        let load = "{ mean = \"0 N\", amplitude = \"1 N\", frequency = \"1000 Hz\" }";
        changed(&bar(1, "0.3", "-1 N"), "\"-1 N\"", load) + &numerics
    };
    assert_raised("W07", "run", &solid("0.6 ms"), &solid("0.4 ms"));
}

#[test]
fn of_solids() {
    let fine = bar(2, "0.3", "-100 N");
    let coarse = changed(&bar(1, "0.3", "-100 N"), "across = 4, up = 4", "across = 1, up = 1");
    for command in ["statics", "modes"] {
        assert_raised("W08", command, &coarse, &fine);
        // Modes of a nearly incompressible solid are hard to tell apart.
        let poisson = if command == "modes" { "0.46" } else { "0.4999" };
        assert_raised("W09", command, &bar(1, poisson, "-100 N"), &bar(2, poisson, "-100 N"));
    }
    assert_raised("W10", "statics", &bar(2, "0.3", "-150 kN"), &fine);
    assert_raised("W11", "statics", &cube("-11.2", ""), &cube("-6", ""));
    let pulled = |by: &str| block(&format!("[[solid.fixed]]\nset = \"x_high\"\nx = \"{by} mm\"\n"));
    // Incompressible rubber pulled to five times its length: chains of sqrt((25 + 2/5)/3)/sqrt(8) = 1.03; at three times 0.63.
    assert_raised("W12", "statics", &pulled("40"), &pulled("20"));
    let exact =
        changed(&pulled("40"), "chain = 8", "chain = 8\nchain_force = \"inverse-langevin\"");
    let exact = changed(&exact, "40 mm", "22 mm");
    assert!(!codes("statics", &exact).contains(&"W12".to_string()));
}

#[test]
fn of_housings() {
    // All 72 nodes touch, or those below the race.
    let fit = |fit: &str| scene_text(&format!("fit.radial = \"{fit}\""), "");
    assert_raised("W13", "statics", &fit("-1 um"), &fit("2 um"));
}

#[test]
fn of_bushings() {
    let name = "bearing_on_bushing.toml";
    let blow = "z = { load = { half_sine = \"-500 N\", base = \"0 N\", start = \"20 ms\", duration = \"0.5 ms\" } }";
    let under = |load: &str| with(name, blow, &format!("z = {{ load = \"{load}\" }}"));
    // Some 1.7e6 N/m across, a wall of 10 mm.
    assert_raised("W14", "statics", &under("-8000 N"), &under("-1000 N"));
    let short = |load: &str| {
        let text = changed(&under(load), "end = \"120 ms\"", "end = \"1 ms\"");
        changed(&text, "window_start = \"15 ms\"", "window_start = \"0 s\"")
    };
    assert_raised("W14", "run", &short("-2500 N"), &short("-150 N"));
    let cycle = "z = { load = { mean = \"-300 N\", amplitude = \"1 N\", frequency = \"200 Hz\" } }";
    let fitted = |fastest: &str| {
        let text = with(name, blow, cycle);
        changed(&text, "table = \"3.1\"", &format!("table = \"3.1\"\nfastest = \"{fastest}\""))
    };
    assert_raised("W15", "plan", &fitted("100 Hz"), &fitted("1 kHz"));
    let elements = |method: &str| {
        let cells = "cells = { around = 6, radial = 2, axial = 2 }";
        with(name, "table = \"3.1\"", &format!("table = \"3.1\"\nmethod = \"{method}\"\n{cells}"))
    };
    assert_raised("W09", "plan", &elements("explicit"), &elements("implicit"));
}

/// Through its wall there is nothing but springs: neither an equilibrium nor a run from there.
#[test]
fn a_bushing_through_its_wall_is_refused() {
    let folder = tempdir().unwrap();
    let blow = "z = { load = { half_sine = \"-500 N\", base = \"0 N\", start = \"20 ms\", duration = \"0.5 ms\" } }";
    let text_of = with("bearing_on_bushing.toml", blow, "z = { load = \"-20000 N\" }");
    let text_of = changed(&text_of, "end = \"120 ms\"", "end = \"1 ms\"");
    let text_of = changed(&text_of, "window_start = \"15 ms\"", "window_start = \"0 s\"");
    let path = write(folder.path(), "scene.toml", &text_of);
    for command in ["statics", "run"] {
        let out = folder.path().join(command);
        let out_text = text(&out);
        let arguments = [command, &path, "--out", &out_text];
        let message = refusal(&arguments, &bearing(&arguments));
        assert!(message.contains("is pushed through the wall of its bushing"), "{message}");
        assert!(!out.join("summary.json").exists(), "{command}");
    }
}

/// Three loose balls under next to no load: not every position of theirs has an equilibrium that is found.
#[test]
fn of_pictures() {
    let loose = |load: &str| {
        format!(
            "[bearing]\nkind = \"deep-groove\"\nballs = 3\npitch_radius = \"19.25 mm\"\nclearance = {{ radial = \"20 um\" }}\n\
             inner_race = {{ conformity = 0.515 }}\nouter_race = {{ conformity = 0.525 }}\n\
             ball = {{ diameter = \"7.938 mm\" }}\n[inner_race]\nz = {{ load = \"{load}\" }}\n"
        )
    };
    assert_raised("W18", "statics", &loose("-1e-9 N"), &loose("-100 N"));
}

/// An outer race that follows a step of the load with a time constant of 50 ms, and one that does in a millisecond.
#[test]
fn of_windows() {
    let step =
        "{ load = { ramp = [\"-250 N\", \"-300 N\"], start = \"0 s\", duration = \"1 ms\" } }";
    let settling = |damping: &str, speed: &str| {
        let outer = format!(
            "[outer_race]\nmotion = \"5-dof\"\nfoundation = {{ stiffness = {{ x = \"1e8 N/m\", y = \"1e8 N/m\", z = \"2e6 N/m\", \
             tilt_y = \"1e5 N m/rad\", tilt_z = \"1e5 N m/rad\" }}, damping = {{ z = \"{damping}\" }} }}\n[ball_forces]"
        );
        let numerics = "end = \"60 ms\"\nstep = \"2 us\"\noutput_interval = \"0.1 ms\"";
        let text = scene(numerics, "plots = []\nwindow_start = \"25 ms\"");
        let text = changed(&text, "{ load = \"-250 N\" }", step);
        changed(&changed(&text, "[ball_forces]", &outer), "1000 rpm", speed)
    };
    let slow = settling("1e5 N s/m", "20000 rpm");
    assert_raised("W19", "run", &slow, &settling("1000 N s/m", "20000 rpm"));
    // In two turns nobody takes means.
    assert_raised("W19", "run", &slow, &settling("1e5 N s/m", "3000 rpm"));
}

#[test]
fn of_reduced_housings() {
    let numerics = "[numerics]\nend = \"0.4 ms\"\noutput_interval = \"20 us\"\n";
    let pressed = |bore_load: &str| {
        let housing = format!("method = \"reduced\"\n{bore_load}");
        let pressing = "z = { displacement = { ramp = [\"0 um\", \"-12 um\"], start = \"0 s\", duration = \"0.3 ms\" } }";
        changed(&scene_text(&housing, numerics), "z = { load = \"-250 N\" }", pressing)
    };
    assert_raised("W16", "run", &pressed(""), &pressed("bore_load = \"5 kN\""));
}

#[test]
fn of_modes() {
    let damped = "{ y = \"100 N s/m\", z = \"100 N s/m\" }";
    let on = |ends: &str| disc(ends, damped, "end = \"1 ms\"");
    assert_raised("W17", "modes", &on("from = \"disc\""), &on("from = \"ground\"\nto = \"disc\""));
}

/// `docs/warnings.md` is made of the table; WARNINGS=write writes it.
#[test]
fn the_page_of_warnings_is_that_of_the_table() {
    let mut page = String::from(
        "# Warnings\n\nMade by `WARNINGS=write cargo test --test command warnings`; do not edit by hand.\n\n\
         A warning is printed as `warning[CODE]: text`. `summary.json` has a list `warnings` of `{\"code\", \"text\"}`. `sweep.json` lists each code once, \
         with the first point that has it and the number of such points. The column `warnings` of `sweep.csv` has one integer: the two-digit numbers \
         of all codes, one after the other. A zero at its start is dropped: W03 and W05 give 0305, written as 305. Scripts should look at the code; texts may change.\n",
    );
    for entry in &TABLE {
        page += &format!(
            "\n## {}\n\n**{}.** {}\n\n**What to do.** {}\n",
            entry.name, entry.title, entry.meaning, entry.action
        );
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/warnings.md");
    if std::env::var_os("WARNINGS").is_some_and(|mode| mode == "write") {
        std::fs::write(path, &page).expect("docs/warnings.md can be written");
    }
    let committed = read(Path::new(path));
    assert!(
        committed == page,
        "docs/warnings.md is out of date: run WARNINGS=write cargo test --test command warnings"
    );
}

/// Numbers in codes count up, so that a column of a sweep can hold them.
#[test]
fn codes_are_numbered_and_explained() {
    for (index, entry) in TABLE.iter().enumerate() {
        assert!(entry.name.starts_with(&format!("W{:02}-", index + 1)), "{}", entry.name);
        for text in [entry.title, entry.meaning, entry.action] {
            assert!(!text.is_empty() && !text.contains("  "), "{}: {text}", entry.name);
        }
    }
}
