//! Runs of a shaft in elements as a user meets them.

use crate::housed_command_common::{self, Place, into_folder, stderr, succeed};
use crate::resume_common::{NEVER, assert_same_results, end_after, interrupted};
use serde_json::{Value, json};
use std::fs;

const SHIPPED: &str = include_str!("../../scenes/rotor_in_elements.toml");

/// Coarse cells, until `end`.
fn scene(end: &str) -> String {
    let coarse = "longest_layer = \"12.5 mm\"";
    let unbalance = "unbalance = [{ at = \"0 mm\", size = \"1e-4 kg m\" }]\nprobe = [";
    SHIPPED
        .replace("longest_layer = \"5 mm\"", coarse)
        .replace("5 ms", end)
        .replace("probe = [", unbalance)
}

#[test]
fn an_interrupted_run_ends_with_the_same_bytes() {
    let place = Place::new();
    let with_fields =
        |end: &str| scene(end).replace("[output]", "fields_interval = \"1 ms\"\n\n[output]");
    let path = place.scene("scene.toml", &with_fields(NEVER));
    let (whole, parts) = (place.path("whole"), place.path("parts"));
    let state = interrupted(into_folder("run", &path, &parts, &["--save-every", "1"]), 150, &parts);
    let attached = |state: &Value| {
        state["sound"]["checkpoint"]["Housed"][0]["solids"][0]["attached"].as_array().unwrap().len()
    };
    assert_eq!(attached(&state), 5);
    let path = place.scene("scene.toml", &with_fields(&end_after(&parts, 2.0)));
    let said = succeed(into_folder("run", &path, &parts, &["--resume"]));
    assert!(said.contains("resumed at"), "{said}");
    let said = succeed(into_folder("run", &path, &whole, &[]));
    assert!(said.contains("steps of the shaft"), "{said}");
    assert_same_results(&whole, &parts);
    // At the start, every millisecond and at the end.
    let ended = housed_command_common::json(whole.join("state.json"))["time"].as_f64().unwrap();
    let fields = 1 + (1e3 * ended).ceil() as usize;
    assert_eq!(fs::read_dir(whole.join("fields")).unwrap().count(), fields);
    let last = format!("fields/shaft_{:06}.vtu", fields - 1);
    assert!(whole.join(last).is_file() && whole.join("fields.pvd").is_file());
    let columns = fs::read_to_string(whole.join("series.csv")).unwrap();
    let head = columns.lines().next().unwrap();
    for name in [
        "shaft_mid_y [m]",
        "shaft_heat_joints [J]",
        "shaft_work_unbalance [J]",
        "left_inner_z [m]",
        "energy_coupled_residual [J]",
    ] {
        assert!(head.split(',').any(|column| column == name), "{name}: {head}");
    }
    // Another penalty is another scene; a state without its shaft is none.
    let other = with_fields(NEVER)
        .replace("method = \"explicit\"", "method = \"explicit\", race_stiffness = \"1e9 N/m\"");
    let other = place.scene("other.toml", &other);
    let output = into_folder("run", &other, &whole, &["--resume"]).output().unwrap();
    assert!(stderr(&output).contains("another scene"), "{}", stderr(&output));
    let mut state = housed_command_common::json(whole.join("state.json"));
    state["sound"]["checkpoint"]["Housed"][0]["solids"][0]["attached"] = json!([]);
    fs::write(whole.join("state.json"), state.to_string()).unwrap();
    let longer = place.scene("longer.toml", &with_fields(NEVER));
    let output = into_folder("run", &longer, &whole, &["--resume"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("damaged"), "{}", stderr(&output));
}

/// Equilibria and modes are those of the same elements reduced.
#[test]
fn statics_do_not_mind_how_a_run_steps() {
    let place = Place::new();
    let loaded = scene("3 ms").replace(
        "z = { smooth_ramp = [\"0 N\", \"-600 N\"], duration = \"2 ms\" }",
        "z = \"-600 N\"",
    );
    let [explicit, reduced] =
        [("a", loaded.clone()), ("b", loaded.replace(", method = \"explicit\"", ""))].map(
            |(name, text)| {
                let path = place.scene(&format!("{name}.toml"), &text);
                let out = place.path(name);
                succeed(into_folder("statics", &path, &out, &[]));
                housed_command_common::json(out.join("summary.json"))["bodies"].clone()
            },
        );
    assert_eq!(explicit, reduced);
    assert!(!explicit.is_null());
}

#[test]
fn what_a_shaft_in_elements_cannot_stand_beside_is_refused() {
    let place = Place::new();
    let blocks = include_str!("../../scenes/rotor_in_pillow_blocks.toml");
    let mesh = "damping = \"100 1/s\"\nmesh = { order = 1, method = \"explicit\" }\nload";
    let shaft = blocks.replacen("damping = \"100 1/s\"\nload", mesh, 1);
    let start = "method = \"explicit\"\nstart = \"equilibrium\"";
    let cases = [
        (shaft.clone(), "housing.method: refused: a shaft of the scene is solved in elements"),
        (
            shaft.replace("method = \"reduced\"", start),
            "housing.start: refused: a shaft of the scene",
        ),
    ];
    let start = "[numerics]\nstart = \"equilibrium\"";
    let own = (
        scene("3 ms").replace("[numerics]", start),
        "numerics.start: refused: a shaft of the scene",
    );
    for (text, expected) in cases.into_iter().chain([own]) {
        let path = place.scene("scene.toml", &text);
        let output = into_folder("run", &path, &place.path("out"), &[]).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
}
