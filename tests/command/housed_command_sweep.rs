//! `bearing sweep` over a bearing in its housing: fits and loads, as in section 2.4.1.

use crate::housed_command_common;

use housed_command_common::*;
use std::fs;

#[test]
fn fits_and_loads_are_swept_as_statics_has_them() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &scene_text("fit.radial = \"1 um\"", ""));
    let vary = ["--vary", "housing.fit.radial=-1 um, 0 um, 5 um", "--vary"];
    let loads = "inner_race.z.load=-250 N .. -50 N / 7";
    let sweep = |name: &str, threads: &str| {
        let out = place.path(name);
        let further = [&vary[..], &[loads, "--threads", threads]].concat();
        let said = succeed(into_folder("sweep", &scene, &out, &further));
        assert!(said.starts_with("21 points in "), "{said}");
        out
    };
    // Two blocks, and housings kept within each: neither shows.
    let [one, two] = [("one", "1"), ("two", "2")].map(|(name, threads)| sweep(name, threads));
    let table = |folder: &std::path::Path| fs::read(folder.join("sweep.npy")).unwrap();
    assert!(table(&one) == table(&two));
    let csv = one.join("sweep.csv");
    let [fit, load, z, outer, force, touching] = [
        "housing.fit.radial",
        "inner_race.z.load",
        "z",
        "outer_z",
        "housing_force_on_outer_z",
        "bore_nodes_touching",
    ]
    .map(|name| column(&csv, name));
    assert_eq!(fit.len(), 21);
    for i in 0..21 {
        assert!((force[i] + load[i]).abs() <= 1e-7 * load[i].abs(), "{} {}", force[i], load[i]);
        // More load, deeper.
        assert!(i % 7 == 0 || outer[i] > outer[i - 1], "{i}: {outer:?}");
        assert_eq!(touching[i] == 72.0, fit[i] == 5.0, "{i}: {touching:?}");
    }
    // The looser, the farther it goes (Fig. 2.14).
    let way = |first: usize| z[first + 6] - z[first];
    assert!(way(0) > way(7) && way(7) > way(14), "{z:?}");
    // A point by itself, with a housing of its own, has the same numbers.
    for point in [0, 8, 16, 20] {
        let fit = format!("fit.radial = \"{} um\"", fit[point]);
        let text = scene_text(&fit, "").replace("\"-250 N\"", &format!("\"{} N\"", load[point]));
        let out = place.path(&format!("point {point}"));
        succeed(into_folder("statics", &place.scene("point.toml", &text), &out, &[]));
        let summary = json(out.join("summary.json"));
        let expected = summary["housing"]["outer_race"]["z"]["value"].as_f64().unwrap();
        assert!((1e-6 * outer[point] / expected - 1.0).abs() <= 1e-14, "{point}");
        let expected = summary["inner_race"]["position"]["z"]["value"].as_f64().unwrap();
        assert!((1e-6 * z[point] / expected - 1.0).abs() <= 1e-14, "{point}");
    }
}

#[test]
fn a_housing_that_changes_is_condensed_anew() {
    let place = Place::new();
    let text = scene_text("fit.radial = \"5 um\"", "").replace("axial = 2 }", "axial = 4 }");
    let scene = place.scene("scene.toml", &text);
    let vary = ["--vary", "solid.material.youngs_modulus=70 GPa, 210 GPa", "--vary"];
    let width = "housing.width=10 mm, 20 mm";
    let out = place.path("out");
    succeed(into_folder("sweep", &scene, &out, &[&vary[..], &[width]].concat()));
    let csv = out.join("sweep.csv");
    let stiffness = column(&csv, "housing_stiffness_z");
    // Soft and stiff, narrow and wide.
    assert!(stiffness[0] < stiffness[1] && stiffness[1] < stiffness[3], "{stiffness:?}");
    assert!(stiffness[0] < stiffness[2] && stiffness[2] < stiffness[3], "{stiffness:?}");
    let touching = column(&csv, "bore_nodes_touching");
    assert_eq!(touching, [72.0, 120.0, 72.0, 120.0]);
    // Points without a solution are listed, the others are there.
    let bad = ["--vary", "housing.width=20 mm, 0.1 um"];
    let tight = place.path("bad");
    let output = into_folder("sweep", &scene, &tight, &bad).output().unwrap();
    let rows = column(&tight.join("sweep.csv"), "point").len();
    let failed = json(tight.join("sweep.json"))["failures"].as_array().unwrap().len();
    assert_eq!(rows + failed, 2, "{}", stderr(&output));
}
