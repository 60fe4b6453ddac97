//! Scenes with a bearing in a housing that are refused: one clear message each.

use crate::housed_command_common;

use housed_command_common::*;

/// What is wrong, the scene, what the message must contain.
type Case = (&'static str, String, &'static [&'static str]);

fn good() -> String {
    scene_text("fit.radial = \"1 um\"", "[numerics]\nend = \"1 ms\"\n")
}

fn changed(from: &str, to: &str) -> String {
    let good = good();
    assert_eq!(good.matches(from).count(), 1, "{from:?} is not unique");
    good.replacen(from, to, 1)
}

fn cases() -> Vec<Case> {
    vec![
        (
            "a fixed outer race",
            changed("motion = \"5-dof\"", "motion = \"fixed\""),
            &["outer_race.motion", "does not move in its housing", "5-dof", "rigid"],
        ),
        (
            "a race that may turn",
            changed("motion = \"5-dof\"", "motion = \"6-dof\""),
            &["outer_race.motion", "no friction", "5-dof"],
        ),
        (
            "friction where equilibria follow each other",
            changed("fit.radial = \"1 um\"", "friction.law = \"stick-slip\""),
            &["housing.friction.law", "history", "method = \"explicit\""],
        ),
        (
            "friction of a housing in shapes",
            changed("fit.radial = \"1 um\"", "method = \"reduced\"\nfriction.law = \"stick-slip\""),
            &["housing.friction.law", "history", "leave `friction` out"],
        ),
        (
            "a coefficient of a smooth bore",
            changed("fit.radial = \"1 um\"", "method = \"explicit\"\nfriction.coefficient = 0.6"),
            &["housing.friction.coefficient", "smooth", "stick-slip"],
        ),
        (
            "friction that pushes",
            changed("fit.radial = \"1 um\"", "method = \"explicit\"\nfriction.coefficient = -0.6"),
            &["housing.friction.coefficient", "-0.6", "from 0 to 10"],
        ),
        (
            "a grip of no length",
            changed("fit.radial = \"1 um\"", "method = \"explicit\"\nfriction.stretch = \"0 um\""),
            &["housing.friction.stretch", "more than 0 um"],
        ),
        (
            "a race that may turn in a bore whose friction is none",
            changed(
                "fit.radial = \"1 um\"",
                "method = \"explicit\"\nfriction = { law = \"stick-slip\", coefficient = 0 }",
            )
            .replace("motion = \"5-dof\"", "motion = \"6-dof\""),
            &["outer_race.motion", "no friction", "friction.law"],
        ),
        (
            "foundation and housing",
            changed("[traction]", "foundation.stiffness.y = \"1e8 N/m\"\n[traction]"),
            &["outer_race.foundation", "not in both"],
        ),
        (
            "no solid",
            format!("{BEARING}{RACES}[housing]\nfit.radial = \"1 um\"\n"),
            &["solid", "missing", "[solid.mesh]", "rigid"],
        ),
        (
            "a solid without a housing",
            format!("{BEARING}{RACES}{RING}"),
            &["coupled by a [housing] table"],
        ),
        (
            "a bore that is not there",
            changed("fit.radial = \"1 um\"", "bore = \"hole\""),
            &["housing.bore", "\"hole\"", "bore, fixed"],
        ),
        (
            "a negative width",
            changed("fit.radial = \"1 um\"", "width = \"-20 mm\""),
            &["housing.width", "-20 mm", "more than 0 mm"],
        ),
        (
            "a width without unit",
            changed("fit.radial = \"1 um\"", "width = 20"),
            &["housing.width", "no unit", "20 mm"],
        ),
        (
            "a width that the mesh does not resolve",
            changed("fit.radial = \"1 um\"", "fit.radial = \"1 um\"\nwidth = \"2 mm\""),
            &["housing.width", "stand for", "0.6 to 1.6", "refine the mesh along the axis"],
        ),
        (
            "millimetres for metres",
            changed("bore_radius = \"35.527 mm\"", "bore_radius = \"35.527 m\"")
                .replace("\"50 mm\"", "\"50 m\""),
            &["35527.0000 mm", "35.5270 mm", "unit"],
        ),
        (
            "a fit in millimetres",
            changed("fit.radial = \"1 um\"", "fit.radial = \"1 mm\""),
            &["housing.fit.radial", "1000 um", "-319.53 um to 319.53 um"],
        ),
        (
            "radial and diametral",
            changed("fit.radial = \"1 um\"", "fit = { radial = \"1 um\", diametral = \"2 um\" }"),
            &["housing.fit.diametral", "exactly one"],
        ),
        (
            "fit and radius",
            changed("fit.radial = \"1 um\"", "fit.radial = \"1 um\"\nouter_radius = \"35.5 mm\""),
            &["housing.fit.radial", "housing.outer_radius"],
        ),
        (
            "a radius inside the groove",
            changed("fit.radial = \"1 um\"", "outer_radius = \"30 mm\""),
            &["housing.outer_radius", "more than the outer race's groove bottom"],
        ),
        (
            "a radius far beyond the bore",
            changed("fit.radial = \"1 um\"", "outer_radius = \"36.5 mm\""),
            &["973.0 um larger than the bore"],
        ),
        (
            "a speed of a race that a rigid housing fixes",
            changed("fit.radial = \"1 um\"", "method = \"rigid\"")
                .replace("motion = \"5-dof\"", "motion = \"5-dof\"\nspeed = \"100 rpm\""),
            &["outer_race.speed", "a rigid housing fixes the outer race", "another method"],
        ),
        (
            "a bore that is held",
            changed("set = \"fixed\"", "set = \"bore\""),
            &["housing.bore", "held by [[solid.fixed]]", "Hold another set", "rigid"],
        ),
        (
            "an unknown method",
            changed("fit.radial = \"1 um\"", "method = \"static\""),
            &["housing.method", "\"quasi-static\""],
        ),
        (
            "an unknown key",
            changed("fit.radial = \"1 um\"", "fits = \"1 um\""),
            &["housing.fits", "did you mean `housing.fit`"],
        ),
        (
            "a stiffness of another kind",
            changed("fit.radial = \"1 um\"", "contact.stiffness = \"1e8 N\""),
            &["housing.contact.stiffness", "N/m^3"],
        ),
        (
            "a step that the method has not",
            changed("fit.radial = \"1 um\"", "window_phase = 0.1"),
            &["housing.window_phase", "explicit"],
        ),
        (
            "a given outer race",
            changed("[traction]", "z = { displacement = \"1 um\" }\n[traction]"),
            &["outer_race.z.displacement", "the housing says where"],
        ),
        (
            "a moment on the outer race",
            changed("[traction]", "tilt_y = { moment = \"1 N m\" }\n[traction]"),
            &["outer_race.tilt_y.moment", "forces, not moments"],
        ),
        (
            "a torque without inertia",
            changed("[outer_race]", "torque = \"1 N m\"\n[outer_race]"),
            &["inner_race.torque", "no speed follows"],
        ),
        (
            "an axial load that the shoulder holds",
            changed("fit.radial = \"1 um\"", "method = \"explicit\"")
                .replace("[traction]", "x = { load = \"5 N\" }\n[traction]"),
            &["outer_race.x.load", "axial = \"free\""],
        ),
        (
            "a nominal start",
            changed("fit.radial = \"1 um\"", "method = \"explicit\"")
                .replace("end = \"1 ms\"", "end = \"1 ms\"\nstart = \"nominal\""),
            &["numerics.start", "start in equilibrium"],
        ),
        (
            "a probe of a housing",
            good() + "[[solid.probe]]\nset = \"bore\"\n",
            &["solid.probe", "a housing does not use it"],
        ),
        (
            "fields after the end",
            changed("end = \"1 ms\"", "end = \"1 ms\"\nfields_interval = \"2 ms\""),
            &["numerics.fields_interval", "after the end of the run"],
        ),
        (
            "a housing that is free",
            good().replace("x = true\n", ""),
            &["needs a housing that is held", "x"],
        ),
        (
            "a load that varies",
            good()
                + "[[solid.load]]\nset = \"x_high\"\nz = { ramp = [\"0 N\", \"1 N\"], duration = \"1 ms\" }\n",
            &["scene.toml:44:7: solid.load", "constant loads", "explicit"],
        ),
        (
            "a support that moves",
            changed("y = true", "y = { ramp = [\"0 um\", \"1 um\"], duration = \"1 ms\" }"),
            &["scene.toml:38:5: solid.fixed.y", "held at zero", "explicit"],
        ),
        (
            "a bore wider than its ring",
            changed("bore_radius = \"35.527 mm\"", "bore_radius = \"53.527 mm\""),
            &["scene.toml:30:15: solid.mesh.bore_radius", "0.053527 m", "0 to 0.05 m"],
        ),
        (
            "a ring of two cells",
            changed("around = 24", "around = 2"),
            &["scene.toml:33:20: solid.mesh.cells.around", "8 to 100000"],
        ),
        (
            "a set that is not there",
            changed("set = \"fixed\"", "set = \"foot\""),
            &["scene.toml:36:7: solid.fixed.set", "\"foot\"", "bore, fixed"],
        ),
        (
            "a set that matches nothing",
            good() + "[[solid.set]]\nname = \"cut\"\nplane = \"x\"\nat = \"12 mm\"\n",
            &["scene.toml:44:8: solid.set", "\"cut\"", "matches nothing"],
        ),
        (
            "another bearing's housing",
            changed("bore_radius = \"35.527 mm\"", "bore_radius = \"26 mm\""),
            &["scene.toml:24:2: housing.bore", "26.0000 mm"],
        ),
        (
            "a flat set as a bore",
            changed("fit.radial = \"1 um\"", "bore = \"side\"\nfit.radial = \"1 um\"")
                + "[[solid.set]]\nname = \"side\"\nplane = \"x\"\nat = \"10 mm\"\n",
            // 24 cells around, each a trapezium of two triangles.
            &[
                "housing.bore: \"side\" is flat: its 48 faces",
                "look along (1.000, 0.000, 0.000)",
                "bore, fixed, side",
            ],
        ),
        (
            "a mesh that is not there",
            changed(
                "generate = \"housing-d\"\nbore_radius = \"35.527 mm\"\nouter_radius = \"50 mm\"\n\
                     depth = \"20 mm\"\ncells = { around = 24, radial = 1, axial = 2 }\n",
                "file = \"missing.msh\"\nunit = \"mm\"\n",
            ),
            &[
                "solid.mesh.file: cannot read",
                "missing.msh",
                "scene.toml:29:8",
                "starts at the scene's folder, and this one is /",
            ],
        ),
        (
            "a probe in a housing",
            good() + "[[solid.probe]]\nset = \"fixed\"\n",
            &["solid.probe", "displacement of every node of the housing stands in the fields"],
        ),
    ]
}

#[test]
fn errors_name_what_is_wrong() {
    let place = Place::new();
    let mut faults = Vec::new();
    succeed(command("check", &place.scene("good.toml", &good()), &[]));
    for (name, text, contains) in cases() {
        let output = command("check", &place.scene("scene.toml", &text), &[]).output().unwrap();
        let message = stderr(&output);
        let named = contains.iter().all(|part| message.contains(part));
        if output.status.code() != Some(2) || !named || message.trim().lines().count() != 1 {
            faults.push(format!("{name}: {message}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn other_commands_say_what_they_take() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &good());
    let output = command("sweep", &scene, &["--vary", "housing.method=rigid,explicit"]).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("sweep the two by themselves"), "{}", stderr(&output));
    // Without an end there is nothing to run, but an equilibrium.
    let still = place.scene("still.toml", &scene_text("", ""));
    let output = command("run", &still, &[]).output().unwrap();
    assert!(stderr(&output).contains("a run needs `end`"), "{}", stderr(&output));
    succeed(command("statics", &still, &["--dry"]));
}

/// Equilibria one after the other take no steps: what is said of steps is refused, not passed over.
#[test]
fn steps_of_equilibria_are_refused() {
    let place = Place::new();
    for (key, given) in [
        ("numerics.accuracy", "accuracy = 1e-4"),
        ("numerics.step", "step = \"1 us\""),
        ("numerics.step_fraction", "step_fraction = 0.4"),
        ("numerics.integrator", "integrator = \"rk4\""),
        ("numerics.start", "start = \"nominal\""),
        ("numerics.energy_limit", "energy_limit = 0.5"),
    ] {
        let numerics = format!("end = \"1 ms\"\n{given}");
        let scene = place.scene("scene.toml", &changed("end = \"1 ms\"", &numerics));
        for name in ["check", "plan", "run"] {
            let output = command(name, &scene, &[]).output().unwrap();
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{name}, {key}: {message}");
            for part in
                [key, "refused: equilibria one after the other take no steps", "scene.toml:"]
            {
                assert!(message.contains(part), "{name}, {key}: {part:?} in {message}");
            }
        }
    }
}
