//! Where rubber fails, is interrupted or is refused, and texts of its commands.

use super::rubber_command::{RUBBER, numerics};
use crate::resume_common::{signal, wait};
use crate::solid_command_common::{Place, column, command, into_folder, json, stderr, succeed};

use std::fs;
use std::process::Stdio;
use std::time::Duration;

/// A cube of rubber, free at its sides, whose end goes `moved` mm.
pub fn cube(moved: &str, further: &str) -> String {
    let held = |set: &str, axis: &str, how: &str| {
        format!("[[solid.fixed]]\nset = \"{set}\"\n{axis} = {how}\n")
    };
    format!(
        "[solid.mesh]\ngenerate = \"bar\"\nlength = \"12 mm\"\nwidth = \"12 mm\"\nheight = \"12 mm\"\norder = 2\n\
         cells = {{ along = 1, across = 1, up = 1 }}\n[solid.material]\nlaw = \"elastomer\"\ntable = \"3.1\"\n{}{}{}{}\
         [[solid.probe]]\nset = \"y_high\"\n{further}",
        held("x_low", "x", "true"),
        held("y_low", "y", "true"),
        held("z_low", "z", "true"),
        held("x_high", "x", &format!("\"{moved} mm\"")),
    )
}

#[test]
fn steps_of_a_given_length_are_counted_by_the_plan() {
    let place = Place::new();
    let numerics = "[numerics]\nend = \"0.05 s\"\noutput_interval = \"10 ms\"\nstep = \"1 ms\"\n";
    let scene = place.scene("cube.toml", &cube("-1", numerics));
    let said = succeed(command("plan", &scene, &[]));
    assert!(said.contains("50, and one more for each corner"), "{said}");
    let out = place.path("out");
    succeed(into_folder("run", &scene, &out, &[]));
    let summary = json(out.join("summary.json"));
    assert!(
        summary["work"]["steps"] == 50 || summary["work"]["steps"] == 51,
        "{}",
        summary["work"]
    );
}

/// The other table has another rubber: what was written is what is proposed.
#[test]
fn a_table_as_a_number_is_answered_with_the_same_table() {
    let place = Place::new();
    for (number, other) in [("3.1", "2.3"), ("2.3", "3.1")] {
        let text = cube("-1", "").replace("\"3.1\"", number);
        let refused = command("check", &place.scene("cube.toml", &text), &[]).output().unwrap();
        let said = stderr(&refused);
        assert!(said.contains(&format!("write table = \"{number}\"")), "{said}");
        assert!(!said.contains(&format!("write table = \"{other}\"")), "{said}");
    }
}

/// A sleeve that is held along one axis alone lets its rubber slide, which no bonded sleeve does.
#[test]
fn sleeves_that_let_rubber_slide_are_told() {
    let place = Place::new();
    let bushing = |inner: &str| {
        format!(
            "[solid.mesh]\ngenerate = \"bushing\"\npart = \"quarter\"\ninner_diameter = \"20 mm\"\n\
             outer_diameter = \"36 mm\"\nlength = \"20 mm\"\norder = 2\n\
             cells = {{ around = 3, radial = 2, axial = 1, grading = 1.5 }}\n\
             [solid.material]\nlaw = \"elastomer\"\ntable = \"3.1\"\n\
             [[solid.fixed]]\nset = \"outer\"\nx = true\ny = true\nz = true\n\
             [[solid.fixed]]\nset = \"inner\"\n{inner}\n\
             [[solid.fixed]]\nset = \"x_low\"\nx = true\n[[solid.fixed]]\nset = \"y_low\"\ny = true\n"
        )
    };
    let said =
        |inner: &str| succeed(command("check", &place.scene("b.toml", &bushing(inner)), &[]));
    let slides = said("z = \"0.1 mm\"");
    assert!(slides.contains("sleeve \"inner\" is fixed along z alone"), "{slides}");
    assert!(!slides.contains("sleeve \"outer\""), "{slides}");
    let bonded = said("x = true\ny = true\nz = \"0.1 mm\"");
    assert!(!bonded.contains("sleeve"), "{bonded}");
}

/// The last row has its fields, whether or not they are due there.
#[test]
fn the_end_of_a_run_has_fields() {
    let place = Place::new();
    let numerics = "[numerics]\nend = \"0.05 s\"\noutput_interval = \"10 ms\"\nstep = \"10 ms\"\n\
                    fields_interval = \"20 ms\"\n";
    let out = place.path("out");
    succeed(into_folder("run", &place.scene("cube.toml", &cube("-1", numerics)), &out, &[]));
    let list = std::fs::read_to_string(out.join("fields.pvd")).unwrap();
    for (time, file) in [("0.04", "fields_000002.vtu"), ("0.05", "fields_000003.vtu")] {
        assert!(list.contains(&format!("timestep=\"{time}\"")) && list.contains(file), "{list}");
        assert!(out.join("fields").join(file).exists(), "{file}");
    }
}

/// A rubber block, free at all its sides, under what its faces carry.
pub fn block(further: &str) -> String {
    let held = |axis: &str| format!("[[solid.fixed]]\nset = \"{axis}_low\"\n{axis} = true\n");
    format!(
        "[solid.mesh]\ngenerate = \"bar\"\nlength = \"10 mm\"\nwidth = \"10 mm\"\nheight = \"10 mm\"\norder = 2\n\
         cells = {{ along = 2, across = 2, up = 2 }}\n[solid.material]\nlaw = \"elastomer\"\nrubber_modulus = \"1 MPa\"\n\
         bulk_ratio = 1000\nchain = 8\n{}{}{}{further}",
        held("x"),
        held("y"),
        held("z"),
    )
}

/// Under a dead load on all faces a cube stays a cube until the load is twice its shear modulus, and then no more (Rivlin
/// 1948): the load goes on in one part, whose end is no place to stay at.
#[test]
fn rivlins_cube_is_stable_up_to_twice_its_shear_modulus() {
    let place = Place::new();
    let pulled = |pressure: &str| {
        let on = |axis: &str| {
            format!("[[solid.load]]\nset = \"{axis}_high\"\npressure = \"-{pressure} MPa\"\n")
        };
        place.scene("rivlin.toml", &block(&["x", "y", "z"].map(on).concat()))
    };
    succeed(command("statics", &pulled("2.1"), &["--dry"]));
    let refused = command("statics", &pulled("5"), &["--dry"]).output().unwrap();
    let said = stderr(&refused);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    let part: f64 =
        said.split("beyond ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    // mu = 1.0851 C_R at N = 8; a bulk modulus of 1000 C_R leaves some 1e-3 of incompressibility.
    let expected = 2.0 * 1.0851;
    assert!((0.05 * part / expected - 1.0).abs() <= 2e-3, "{part} % of 5 MPa, {expected} MPa");
}

/// A signal ends the way to an equilibrium at the end of a part of it; what was found stays.
#[test]
fn an_interrupted_equilibrium_of_rubber_keeps_its_curve() {
    let place = Place::new();
    // Some tens of parts of a tenth of a second each.
    let text = numerics("0.2 s")
        .replace("around = 3, radial = 2, axial = 1", "around = 8, radial = 4, axial = 4")
        .replace("500 um", "5000 um");
    let out = place.path("out");
    let mut command = into_folder("statics", &place.scene("s.toml", &text), &out, &[]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    signal(&child, "-INT");
    let (code, message) = wait(child);
    assert_eq!(code, Some(2), "{message}");
    assert!(message.contains("interrupted at ") && message.contains("in curve.csv"), "{message}");
    let rows = fs::read_to_string(out.join("curve.csv")).unwrap().lines().count() - 1;
    assert!(message.contains(&format!("; {rows} equilibria")) && rows > 0, "{message}");
    assert!(!out.join("summary.json").exists());
}

/// Sleeves keep the wall of their rubber between them: across, at every time, against each other.
#[test]
fn sleeves_that_would_pass_through_each_other_are_refused() {
    let place = Place::new();
    let verdict = |verb: &str, text: &str| {
        let output = command(verb, &place.scene("s.toml", text), &[]).output().unwrap();
        (output.status.code(), stderr(&output))
    };
    let by = |way: &str| numerics("0.2 s").replace("500 um", way);
    for verb in ["check", "plan", "statics", "run"] {
        let (code, message) = verdict(verb, &by("8.01 mm"));
        assert_eq!(code, Some(2), "{verb}: {message}");
        assert!(message.contains("solid.fixed.z: the inner sleeve moves 8.0100 mm"), "{message}");
        assert!(message.contains("is 8.0000 mm thick"), "{message}");
    }
    assert_eq!(verdict("check", &by("7.9 mm")).0, Some(0));
    // As far as the run goes, and both sleeves together.
    let short = by("8.01 mm").replace("0.2 s", "0.05 s");
    let short = short.replace("fields_interval = \"0.1 s\"", "fields_interval = \"10 ms\"");
    assert_eq!(verdict("check", &short), (Some(0), String::new()));
    let outer = "set = \"outer\"\nx = true\ny = true\nz = true";
    assert!(by("4 mm").contains(outer));
    let apart = by("4.1 mm").replace(outer, &outer.replace("z = true", "z = \"-4 mm\""));
    assert_eq!(verdict("check", &apart).0, Some(2));
    let along = by("4.1 mm").replace(outer, &outer.replace("z = true", "z = \"4 mm\""));
    assert_eq!(verdict("check", &along).0, Some(0));
}

#[test]
fn a_run_of_rubber_that_fails_keeps_the_last_row() {
    let place = Place::new();
    // A bar pressed to less than nothing, by chains that cannot be longer than straight.
    let held = |set: &str, x: &str| {
        format!("[[solid.fixed]]\nset = \"{set}\"\nx = {x}\ny = true\nz = true\n")
    };
    let text = format!(
        "[solid.mesh]\ngenerate = \"bar\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\nheight = \"10 mm\"\norder = 2\n\
         cells = {{ along = 2, across = 1, up = 1 }}\n[solid.material]\nlaw = \"elastomer\"\ntable = \"3.1\"\n\
         chain_force = \"inverse-langevin\"\n{}{}{}",
        held("x_low", "true"),
        held("x_high", "{ ramp = [\"0 mm\", \"-60 mm\"], duration = \"0.1 s\" }"),
        numerics("0.2 s").replace(RUBBER, "")
    );
    let out = place.path("out");
    let output = into_folder("run", &place.scene("s.toml", &text), &out, &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("no equilibrium was found after t = "), "{message}");
    assert!(message.contains("the state at the last row"), "{message}");
    let (summary, state) = (json(out.join("summary.json")), json(out.join("state.json")));
    assert_eq!((&summary["complete"], &state["stopped"]), (&false.into(), &"failed".into()));
    assert_eq!(summary["output"]["rows"], column(&out, "time").len());
    let output = command("statics", &place.scene("s.toml", &text), &[]).output().unwrap();
    let message = stderr(&output);
    assert!(message.contains("% of the given loads and displacements"), "{message}");
    assert!(message.contains("reduce loads and displacements"), "{message}");
    // What was found on the way stays, each further than the one before.
    let still = place.path("still");
    let output =
        into_folder("statics", &place.scene("s.toml", &text), &still, &[]).output().unwrap();
    assert!(stderr(&output).contains("equilibria up to there are in curve.csv"));
    let curve = fs::read_to_string(still.join("curve.csv")).unwrap();
    let first = curve.lines().filter_map(|line| line.split(',').next()?.parse().ok());
    let parts: Vec<f64> = first.collect();
    assert!(parts.len() > 1 && parts.is_sorted() && parts[parts.len() - 1] < 1.0, "{parts:?}");
    assert!(curve.contains("reaction_x_high_x") && !still.join("series.csv").exists(), "{curve}");
}

/// What has no mirror image on the other side of a plane of symmetry is not a load of a quarter.
#[test]
fn a_quarter_refuses_what_its_symmetry_forbids() {
    use super::rubber_command::RUBBER;
    let place = Place::new();
    let on = |words: &str| {
        let text = match words.starts_with("[[") {
            true => format!("{RUBBER}{words}"),
            false => RUBBER.replacen("[solid.mesh]", &format!("[solid]\n{words}\n[solid.mesh]"), 1),
        };
        command("check", &place.scene("b.toml", &text), &[]).output().unwrap()
    };
    for (words, key) in [
        ("gravity = [\"0 m/s^2\", \"1 m/s^2\", \"0 m/s^2\"]", "solid.gravity"),
        ("gravity = [\"1 m/s^2\", \"0 m/s^2\", \"0 m/s^2\"]", "solid.gravity"),
        ("[[solid.load]]\nset = \"x_high\"\ny = \"5 N\"\n", "solid.load.1.y"),
        (
            "[[solid.load]]\nset = \"x_high\"\nforce = [\"1 N\", \"0 N\", \"0 N\"]\n",
            "solid.load.1.force",
        ),
    ] {
        let refused = on(words);
        let said = stderr(&refused);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains(&format!("{key}: refused: along ")), "{said}");
    }
    for words in [
        "gravity = [\"0 m/s^2\", \"0 m/s^2\", \"1 m/s^2\"]",
        "[[solid.load]]\nset = \"x_high\"\npressure = \"1 kPa\"\n",
        "[[solid.load]]\nset = \"x_high\"\nforce = [\"0 N\", \"0 N\", \"1 N\"]\n",
    ] {
        let done = on(words);
        assert_eq!(done.status.code(), Some(0), "{words}: {}", stderr(&done));
    }
}
