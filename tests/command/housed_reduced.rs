//! A bearing in a reduced housing as a user meets it: beside explicit steps, its results, what it goes on from, what is
//! refused.

use crate::{housed_command_common, resume_common};

use housed_command_common::*;
use resume_common::assert_same_results;
use std::f64::consts::TAU;
use std::path::Path;

/// A blow on a bearing that grows into its fit; the housing starts undeformed, as in explicit steps.
fn blow(method: &str, end: &str, further: &str) -> String {
    let housing = format!("method = \"{method}\"\nfit.radial = \"1 um\"\nfit_ramp = \"0.1 ms\"");
    let run = format!(
        "[numerics]\nend = \"{end}\"\noutput_interval = \"20 us\"\nfields_interval = \"0.4 ms\"\n{further}"
    );
    let pulse =
        "z = { load = { half_sine = \"-500 N\", start = \"0.2 ms\", duration = \"0.4 ms\" } }";
    scene_text(&housing, &run).replace("z = { load = \"-250 N\" }", pulse)
}

const NOMINAL: &str = "start = \"nominal\"\n";
const SOURCE: &str = "integrator = \"rk4\"\nstep_fraction = 0.3\n";

fn apart(one: &Path, other: &Path, name: &str) -> [f64; 2] {
    let [a, b] = [one, other].map(|folder| column(&folder.join("series.csv"), name));
    let largest = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0f64, |most, x| most.max(x.abs()));
    let error = largest(&mut a.iter().zip(&b).map(|(a, b)| a - b));
    [error, largest(&mut b.iter().copied())]
}

#[test]
fn it_moves_as_in_explicit_steps() {
    let place = Place::new();
    let run = |name: &str, text: &str| {
        let scene = place.scene(&format!("{name}.toml"), text);
        let folder = place.path(name);
        let said = succeed(into_folder("run", &scene, &folder, &[]));
        (folder, said)
    };
    let (explicit, _) = run("explicit", &blow("explicit", "1 ms", ""));
    let (shapes, said) = run("shapes", &blow("reduced", "1 ms", NOMINAL));
    assert!(
        said.contains("natural modes up to") && said.contains("static correction modes"),
        "{said}"
    );
    assert!(said.contains("bore                   penetration up to"), "{said}");
    // Of the largest value: accuracy 1e-3, and shapes that are cut off.
    for name in ["outer_z", "inner_z", "bore_deepest_penetration", "energy_housing_strain"] {
        let [error, largest] = apart(&shapes, &explicit, name);
        println!("{name}: {:.1e}", error / largest);
        assert!(error <= 0.02 * largest, "{name}: {error:e} of {largest:e}");
    }
    let summary = json(shapes.join("summary.json"));
    assert_eq!(summary["housing_method"], "reduced");
    let reduced = &summary["reduced_housing"];
    assert!(reduced["natural_modes"].as_u64().unwrap() > 0, "{reduced}");
    assert!(reduced["compliance_left_out"]["value"].as_f64().unwrap() <= 1e-4, "{reduced}");
    assert_eq!(reduced["masses"], "lumped");
    assert!(summary["seat"]["interference"]["value"].as_f64().unwrap() > 0.0);
    assert!(summary["largest"].is_object());
    // Fields on the way and of the last row; the nodes of the bore that touch.
    for folder in [&explicit, &shapes] {
        assert_eq!(std::fs::read_dir(folder.join("fields")).unwrap().count(), 4);
    }
    let bore = column(&shapes.join("bore.csv"), "pressure");
    let peak = *column(&shapes.join("series.csv"), "bore_peak_pressure").last().unwrap();
    let largest = bore.iter().fold(0.0f64, |most, p| most.max(*p));
    assert!((largest / peak - 1.0).abs() <= 1e-9, "{largest:e} {peak:e}");
}

/// A bent shaft puts a moment on races in their housings, which know its load: shapes answer to both.
#[test]
fn under_a_bent_shaft_it_starts_in_the_common_equilibrium() {
    let place = Place::new();
    let shipped = include_str!("../../scenes/rotor_in_pillow_blocks.toml");
    let short = shipped.replace("end = \"2 ms\"", "end = \"20 us\"");
    let loose = short.replace("fit = { radial = \"2.5 um\" }", "fit = { radial = \"-2.5 um\" }");
    assert!(loose != short);
    let [reduced, course] = ["reduced", "quasi-static"].map(|method| {
        let text = loose.replace("method = \"reduced\"", &format!("method = \"{method}\""));
        let (scene, folder) = (place.scene(&format!("{method}.toml"), &text), place.path(method));
        succeed(into_folder("run", &scene, &folder, &[]));
        folder
    });
    for name in ["left_inner_z", "left_outer_z", "shaft_mid_z", "left_outer_tilt_y"] {
        let [ours, theirs] = [&reduced, &course].map(|of| column(&of.join("series.csv"), name)[0]);
        println!("{name}: {:.1e}", ours / theirs - 1.0);
        assert!((ours / theirs - 1.0).abs() <= NEAR, "{name}: {ours:e} {theirs:e}");
    }
}

/// A bearing in a finer pillow block with words changed: rows at the start of shapes and of the condensed housing.
fn starts(fit: &str, changes: &[(&str, &str)], held: &[(&str, f64)]) {
    let place = Place::new();
    let finer =
        [("housing-d", "housing-c"), ("around = 24", "around = 32"), ("order = 1", "order = 2")];
    let [reduced, course] = ["reduced", "quasi-static"].map(|method| {
        let run = "[numerics]\nend = \"20 us\"\noutput_interval = \"20 us\"\n";
        let mut text = scene_text(&format!("method = \"{method}\"\nfit.radial = \"{fit}\""), run);
        for (from, to) in finer.iter().chain(changes) {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let (scene, folder) = (place.scene(&format!("{method}.toml"), &text), place.path(method));
        succeed(into_folder("run", &scene, &folder, &[]));
        folder
    });
    for (name, most) in held {
        let [ours, theirs] = [&reduced, &course].map(|of| column(&of.join("series.csv"), name)[0]);
        println!("{name}: {:.1e}", ours / theirs - 1.0);
        assert!((ours / theirs - 1.0).abs() <= *most, "{name}: {ours:e} {theirs:e}");
    }
}

/// Shapes answer to the pressure at the start as the condensed housing does. What differs is that a run starts with the distances of its
/// steps, a course with those that normals which stay make: 1e-10 m for ways of a micrometre across nodes and tilts of a milliradian.
const NEAR: f64 = 1e-4;

/// What presses the race may come from elsewhere than its loads: here the place of the other race puts more on it. Without an answer of
/// their own to that pressure shapes have it 4 % off.
#[test]
fn a_load_on_the_race_itself_starts_in_the_common_equilibrium() {
    let changes = [
        ("\"-4 um\"", "\"-10 um\""),
        ("z = { load = \"-250 N\" }", "z = { displacement = \"0 um\" }"),
        ("\"5-dof\"\n", "\"5-dof\"\nz = { load = \"-3000 N\" }\n"),
    ];
    // In motion a race that moves aside touches a little elsewhere, by its way over the radius.
    starts("-2.5 um", &changes, &[("outer_z", NEAR), ("bore_peak_pressure", 2e-4)]);
}

/// A moment far beyond what forces with levers come to.
#[test]
fn a_moment_on_a_race_starts_in_the_common_equilibrium() {
    let changes = [
        ("\"-4 um\"", "\"-20 um\""),
        ("z = { load = \"-250 N\" }", "z = { load = \"-10 N\" }"),
        ("tilt_y = { tilt = \"0 deg\" }", "tilt_y = { moment = \"15 N m\" }"),
        ("tilt_z = { tilt = \"0 deg\" }\n", ""),
    ];
    // Equilibria are linear in the tilt. In motion a race tilted by θ stands off by R θ²/2 more.
    let held = [("outer_z", NEAR), ("outer_tilt_y", NEAR), ("bore_peak_pressure", 5e-3)];
    starts("0.5 um", &changes, &held);
}

#[test]
fn it_starts_in_the_common_equilibrium() {
    let place = Place::new();
    let still = |method: &str, further: &str| {
        let run = format!("[numerics]\nend = \"0.2 ms\"\noutput_interval = \"20 us\"\n{further}");
        scene_text(&format!("method = \"{method}\"\nfit.radial = \"1 um\""), &run)
    };
    let scene = place.scene("scene.toml", &still("reduced", ""));
    let folder = place.path("out");
    succeed(into_folder("run", &scene, &folder, &[]));
    let z = column(&folder.join("series.csv"), "outer_z");
    let course = place.scene("course.toml", &still("quasi-static", ""));
    let equilibria = place.path("course");
    succeed(into_folder("run", &course, &equilibria, &[]));
    let whole = column(&equilibria.join("series.csv"), "outer_z");
    // It stays there, and that is where the condensed housing has it.
    for z in &z {
        assert!(
            (z / z.abs().max(whole[0].abs()) - whole[0] / whole[0].abs()).abs() <= 5e-3,
            "{z:e} {:e}",
            whole[0]
        );
    }
}

#[test]
fn extended_runs_end_with_the_same_bytes() {
    for further in [NOMINAL, SOURCE] {
        let place = Place::new();
        let (longer, extended) = (place.path("longer"), place.path("extended"));
        let scene = place.scene("scene.toml", &blow("reduced", "0.5 ms", further));
        succeed(into_folder("run", &scene, &extended, &[]));
        let scene = place.scene("scene.toml", &blow("reduced", "0.9 ms", further));
        let said = succeed(into_folder("run", &scene, &extended, &["--resume"]));
        assert!(said.contains("resumed at"), "{said}");
        succeed(into_folder("run", &scene, &longer, &[]));
        assert_same_results(&longer, &extended);
        // Of other shapes it is refused.
        let text =
            blow("reduced", "1 ms", further).replace("fit_ramp", "modes_to = \"50 kHz\"\nfit_ramp");
        let other = place.scene("other.toml", &text);
        let output = into_folder("run", &other, &longer, &["--resume"]).output().unwrap();
        assert!(stderr(&output).contains("another scene"), "{}", stderr(&output));
    }
}

/// The largest of loads on bodies, races in bores among them, of those along shafts, and of moments, at any time.
#[test]
fn the_plan_says_what_presses_shapes_are_made_for() {
    let place = Place::new();
    let alone = blow("reduced", "1 ms", NOMINAL).replace(
        "\"5-dof\"\n",
        "\"5-dof\"\ny = { load = { ramp = [\"0 N\", \"900 N\"], start = \"1 s\", duration = \"1 s\" } }\n\
         tilt_z = { moment = \"3 N m\" }\n",
    );
    let shafts = include_str!("../../scenes/rotor_in_pillow_blocks.toml").replace(
        "damping = \"100 1/s\"\n",
        "damping = \"100 1/s\"\nunbalance = [{ at = \"0 mm\", size = \"0.01 kg m\" }]\n",
    );
    // m e ω² with ω = 1000 rpm.
    let unbalance = 0.01 * (1000.0 * TAU / 60.0_f64).powi(2);
    let shafts_said = format!("loads of {:.0} N", 3000.0 + unbalance);
    for (text, said) in [(alone, "loads of 900 N or 3 N m".into()), (shafts, shafts_said)] {
        let plan = succeed(command("plan", &place.scene("scene.toml", &text), &[]));
        assert!(plan.contains(&said), "{said} is not in {plan}");
    }
}

/// A place that is given presses with what that takes, which no load tells before.
#[test]
fn a_press_beyond_what_shapes_are_made_for_is_told() {
    let place = Place::new();
    let squeezed = |housing: &str| {
        let numerics = "[numerics]\nend = \"0.4 ms\"\noutput_interval = \"20 us\"\n";
        let text = scene_text(&format!("method = \"reduced\"\n{housing}"), numerics).replace(
            "z = { load = \"-250 N\" }",
            "z = { displacement = { ramp = [\"0 um\", \"-12 um\"], start = \"0 s\", duration = \"0.3 ms\" } }",
        );
        let folder = place.path(&format!("out-{}", housing.len()));
        let scene = place.scene("scene.toml", &text);
        let said = succeed(into_folder("run", &scene, &folder, &[]));
        let [y, z] = ["y", "z"].map(|axis| {
            column(&folder.join("series.csv"), &format!("housing_force_on_outer_{axis}"))
        });
        let hardest = y.iter().zip(&z).fold(0.0f64, |most, (y, z)| most.max(y.hypot(*z)));
        (said, json(folder.join("summary.json"))["warnings"].to_string(), hardest)
    };
    let beyond = "W16-beyond-kept-modes";
    let (said, warnings, hardest) = squeezed("");
    assert!(hardest > 300.0, "{hardest}");
    assert!(said.contains(beyond) && warnings.contains(beyond), "{said} {warnings}");
    let told = warnings.split("the load on the bore reaches ").nth(1).unwrap();
    let told: f64 = told.split(' ').next().unwrap().parse().unwrap();
    assert!((told / hardest - 1.0).abs() <= 1e-3, "{warnings} {hardest}");
    // Made for it, and for four fifths of it.
    for press in [format!("{hardest}"), format!("{:.1}", 0.81 * hardest)] {
        let (said, warnings, _) = squeezed(&format!("bore_load = \"{press} N\""));
        assert!(!said.contains(beyond) && !warnings.contains(beyond), "{said} {warnings}");
    }
}

#[test]
fn plan_and_check_say_what_moves_and_what_is_cut_off() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &blow("reduced", "1 ms", ""));
    let plan = succeed(command("plan", &scene, &[]));
    for said in [
        "does  reduced housing",
        "notes modes of the housing",
        "notes cut off",
        "the lowest natural mode left out is at",
        "of the response to inner_race.z",
    ] {
        assert!(plan.contains(said), "{said} is not in {plan}");
    }
    let check = succeed(command("check", &scene, &[]));
    assert!(check.contains("elements of 4; reduced"), "{check}");
}

#[test]
fn what_a_reduced_housing_cannot_have_is_refused() {
    let place = Place::new();
    let refused = |text: &str, expected: &[&str]| {
        let scene = place.scene("refused.toml", text);
        let output = into_folder("run", &scene, &place.path("none"), &[]).output().unwrap();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        for expected in expected {
            assert!(said.contains(expected), "{expected} is not in {said}");
        }
    };
    let explicit =
        blow("explicit", "1 ms", "").replace("fit_ramp", "modes_to = \"9 kHz\"\nfit_ramp");
    refused(&explicit, &["housing.modes_to", "only with `method = \"reduced\"`"]);
    refused(
        &explicit.replace("modes_to = \"9 kHz\"", "bore_load = \"9 kN\""),
        &["housing.bore_load", "only with `method = \"reduced\"`"],
    );
    let stepped = blow("reduced", "1 ms", "").replace("fit_ramp", "coupling_phase = 0.2\nfit_ramp");
    refused(&stepped, &["housing.coupling_phase"]);
    let moved = blow("reduced", "1 ms", "")
        .replace("x = true", "x = { half_sine = \"1 um\", start = \"0 s\", duration = \"1 ms\" }");
    refused(&moved, &["solid.fixed", "`reduced` need supports at zero"]);
    let tilted = blow("reduced", "1 ms", "")
        .replace("[outer_race]\n", "[outer_race]\ntilt_y = { moment = \"1 N m\" }\n");
    refused(&tilted, &["tilt_y", "not moments", "nominal"]);
}
