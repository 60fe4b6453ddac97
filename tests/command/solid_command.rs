//! A scene with a solid alone as a user meets it: values against closed forms, and what ParaView
//! makes of the fields.

use crate::{outside_common, solid_command_common};

use outside_common::python_with_vtk;
use serde_json::Value;
use solid_command_common::{
    DENSITY, ON_ROLLERS, Place, SHORT_RUN, YOUNG, assert_near, bar, column, command, into_folder,
    json, number, shipped, stderr, succeed,
};
use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn a_cantilever_bends_as_beam_theory_says() {
    let place = Place::new();
    let (out, scene) = (place.path("out"), shipped("cantilever.toml"));
    let said = succeed(into_folder("statics", &scene, &out, &[]));
    assert!(said.contains("tip") && said.contains("reactions"), "{said}");
    let summary = json(out.join("summary.json"));
    let [length, side, force, poisson] = [0.1, 0.01, 100.0, 0.3];
    let shear_modulus = 0.5 * YOUNG / (1.0 + poisson);
    let cowper = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson);
    let inertia = f64::powi(side, 4) / 12.0;
    let bending = force * f64::powi(length, 3) / (3.0 * YOUNG * inertia);
    let expected = bending + force * length / (cowper * shear_modulus * side * side);
    // Ten-node elements on 20 × 2 × 2 cells, and what three-dimensional theory adds at the ends.
    assert_near(-number(&summary["probes"]["tip"]["z"]), expected, 2e-3);
    // The sum of the reactions balances to the residual that Newton leaves at single nodes.
    assert!((number(&summary["reactions"]["z"]) - force).abs() <= 1e-6 * force);
    assert!(number(&summary["reactions"]["x"]).abs() <= 1e-6 * force);
    // 6 F L / h³ at the clamp, which an element half a cell away carries most of.
    let clamp = 6.0 * force * length / f64::powi(side, 3);
    assert_near(number(&summary["largest"]["von_mises_of_elements"]), clamp, 0.35);
    assert_eq!(summary["mesh"]["elements"], 480);
    assert_near(number(&summary["mass"]["of_nodes"]), DENSITY * length * side * side, 1e-12);
    for name in ["series.csv", "series.npy", "fields.pvd", "fields/fields_000000.vtu"] {
        assert!(out.join(name).exists(), "{name}");
    }

    // Four-node elements on the same cells are too stiff, as they are known to be.
    let text = fs::read_to_string(&scene).unwrap().replace("order = 2", "order = 1");
    let linear = place.scene("linear.toml", &text);
    succeed(into_folder("statics", &linear, &out, &[]));
    let stiff = -number(&json(out.join("summary.json"))["probes"]["tip"]["z"]);
    assert!(stiff > 0.3 * expected && stiff < 0.8 * expected, "{stiff:e}");
}

#[test]
fn pressure_force_and_displacement_pull_a_bar_alike() {
    let place = Place::new();
    let (stress, area, length) = (-10e6, 1e-4, 0.04);
    // The law is that of large strains: strains of 5e-5 bend the straight line by as much.
    let nonlinear = 2e-4;
    for order in [1, 2] {
        for (load, further) in [
            ("pressure = \"10 MPa\"", ""),
            ("x = \"-1000 N\"", ""),
            ("force = [\"-1 kN\", \"0 N\", \"0 N\"]", ""),
            ("", "[[solid.fixed]]\nset = \"x_high\"\nx = \"-1.904762 um\"\n"),
        ] {
            let load = match load {
                "" => String::new(),
                load => format!("[[solid.load]]\nset = \"x_high\"\n{load}\n"),
            };
            let scene =
                place.scene("scene.toml", &bar(order, &format!("{ON_ROLLERS}{load}{further}")));
            let out = place.path("out");
            succeed(into_folder("statics", &scene, &out, &[]));
            let summary = json(out.join("summary.json"));
            assert_near(number(&summary["probes"]["end"]["x"]), stress / YOUNG * length, nonlinear);
            let reaction = number(&summary["supports"]["x_low"]["x"]);
            assert_near(reaction, -stress * area, nonlinear);
            for largest in ["von_mises_of_elements", "von_mises_of_nodes"] {
                assert_near(number(&summary["largest"][largest]), -stress, nonlinear);
            }
            let energy = 0.5 * stress * stress / YOUNG * area * length;
            assert_near(number(&summary["strain_energy"]), energy, 2.0 * nonlinear);
        }
    }
}

#[test]
fn a_free_ring_has_the_modes_of_thin_ring_theory() {
    let place = Place::new();
    let out = place.path("out");
    let said = succeed(into_folder("modes", &shipped("ring_modes.toml"), &out, &[]));
    assert_eq!(said.lines().count(), 14, "{said}");
    let frequencies = column(&out, "frequency");
    assert_eq!(frequencies.len(), 12);
    // Rigid motions: rounding of the stiffness, 1e-16 of the highest frequency's square.
    assert!(frequencies[..6].iter().all(|f| f.abs() <= 1.0), "{frequencies:?}");
    let (radius, thick) = (0.05, 0.003);
    let hoppe = |n: f64| {
        let shape = n * (n * n - 1.0) / (n * n + 1.0).sqrt();
        let speed = (YOUNG / DENSITY).sqrt() * thick / 12f64.sqrt() / (radius * radius);
        shape * speed / std::f64::consts::TAU
    };
    // Shear and rotation take (h/R)² of the frequency, 0.4 %; the mesh, 48 round, adds less.
    assert_near(frequencies[6], hoppe(2.0), 4e-3);
    assert_near(frequencies[10], hoppe(3.0), 8e-3);
    for pair in [6, 8, 10] {
        assert_near(frequencies[pair], frequencies[pair + 1], 1e-3);
    }
    let list = fs::read_to_string(out.join("fields.pvd")).unwrap();
    assert!(list.contains(&format!("timestep=\"{}\"", frequencies[6])), "{list}");
    assert!(
        list.contains("file=\"fields/mode_000007.vtu\"")
            && out.join("fields/mode_000007.vtu").exists()
    );
    assert_eq!(json(out.join("summary.json"))["modes"][6]["mode"], 7);
}

#[test]
fn a_struck_bar_carries_the_wave_and_rings() {
    let place = Place::new();
    let out = place.path("out");
    let scene = shipped("bar_impact.toml");
    let said = succeed(into_folder("run", &scene, &out, &[]));
    for part in
        ["of the stability limit", "limiting element", "a row every", "fields every 40 rows"]
    {
        assert!(said.contains(part), "{part} is not in {said}");
    }
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["complete"], true);
    assert_eq!(summary["output"]["rows"], 801);
    let speed = (YOUNG / DENSITY).sqrt();
    let impulse = 1000.0 * 20e-6 * 2.0 / std::f64::consts::PI;
    let (times, far) = (column(&out, "time"), column(&out, "far_x"));
    let at = |time: f64| times.iter().position(|t| *t >= time - 1e-9).unwrap();
    // The far end moves twice as far as the wave carries, once the wave is there.
    let expected = 2.0 * speed * impulse / (YOUNG * 1e-4);
    // Before 0.1 m over the speed of pressure waves, 6002 m/s, nothing arrives at all.
    assert!(far[at(15e-6)].abs() <= 1e-3 * expected, "{:e}", far[at(15e-6)]);
    // A pulse as short as two bar widths runs apart a little: its tail moves the end by percents.
    assert_near(far[at(50e-6)], expected, 0.03);
    // Rod theory, less Rayleigh's correction for lateral motion, (π ν k/L)²/2 = 1e-4 … 4e-3.
    let bin = number(&summary["spectra"]["far_x"]["bin_width"]);
    let peaks: Vec<f64> = summary["spectra"]["far_x"]["peaks"]
        .as_array()
        .unwrap()
        .iter()
        .map(|peak| number(&peak["frequency"]))
        .collect();
    // The free bar flies off: that is the highest, in the first bin.
    assert!((peaks[0] - bin).abs() <= 1e-9 * bin, "{peaks:?}");
    let peak = peaks[1];
    assert!((peak - speed / 0.2).abs() <= bin, "{peak}");
    // The ledger of a body that hardly strains closes to a trifle.
    let energy = &summary["energy"];
    let residual = number(&energy["largest_residual"]) / number(&energy["turned_over"]);
    assert!(residual <= 1e-4, "{residual:e}");
    let fields = fs::read_dir(out.join("fields")).unwrap().count();
    assert_eq!(fields, 21);
    let list = fs::read_to_string(out.join("fields.pvd")).unwrap();
    assert_eq!(list.matches("<DataSet").count(), 21);
    for name in ["energies.svg", "probe_far.svg", "spectrum.svg", "state.json"] {
        assert!(out.join(name).exists(), "{name}");
    }
}

#[test]
fn threads_change_no_bit() {
    let place = Place::new();
    // 5184 elements: enough for two threads.
    let text = format!("{SHORT_RUN}end = \"50 us\"\noutput_interval = \"5 us\"\n");
    let fine =
        text.replace("around = 24, radial = 2, axial = 2", "around = 96, radial = 3, axial = 3");
    assert_ne!(text, fine);
    let scene = place.scene("scene.toml", &fine);
    let [one, two] = ["one", "two"].map(|name| place.path(name));
    succeed(into_folder("run", &scene, &one, &[]));
    succeed(into_folder("run", &scene, &two, &["--threads", "2"]));
    let elements = |folder: &Path| {
        json(folder.join("summary.json"))["work"]["elements_evaluated"].as_u64().unwrap()
    };
    // Elements between two threads are computed by both.
    assert!(elements(&two) > elements(&one));
    for name in ["series.csv", "fields.pvd", "fields/fields_000005.vtu"] {
        assert!(fs::read(one.join(name)).unwrap() == fs::read(two.join(name)).unwrap(), "{name}");
    }
}

#[test]
fn free_fall_and_free_spin_stay_what_they_are() {
    let place = Place::new();
    let numerics = r#"
[numerics]
end = "0.2 ms"
output_interval = "10 us"
[[solid.probe]]
name = "corner"
at = ["0 mm", "-5 mm", "-5 mm"]
"#;
    for method in ["central-differences", "runge-kutta"] {
        let gravity = "[solid]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.80665 m/s^2\"]\n";
        let text = bar(2, &format!("{numerics}[numerics.x]\n"));
        let text = text
            .replace("[numerics.x]\n", "")
            .replace("end =", &format!("method = \"{method}\"\nend ="));
        let scene = place.scene("fall.toml", &format!("{gravity}{text}"));
        let out = place.path("fall");
        succeed(into_folder("run", &scene, &out, &[]));
        for (time, z) in column(&out, "time").iter().zip(column(&out, "corner_z")).skip(1) {
            // Both methods are exact for a constant acceleration; forces of elements over some
            // ten thousand nodes' masses leave rounding.
            assert_near(z, -0.5 * 9.80665 * time * time, 1e-9);
        }
        // Damping relative to the rigid motion leaves a spinning body its energy.
        let spin = "[solid]\nspin = \"1000 rpm\"\ndamping = \"1000 1/s\"\ndamped_motion = \"relative-to-rigid\"\n";
        let scene = place.scene("spin.toml", &format!("{spin}{text}"));
        let out = place.path("spin");
        succeed(into_folder("run", &scene, &out, &[]));
        let kinetic = column(&out, "energy_kinetic");
        let first = kinetic[0];
        let speed = 1000.0 * std::f64::consts::TAU / 60.0;
        let axial = DENSITY * 4e-6 * (2.0 * 0.01f64.powi(2)) / 12.0;
        // Lumped masses of 2 × 2 cells lie further out than the body's own, by an eighth.
        assert_near(first, 0.5 * axial * speed * speed, 0.15);
        // Centrifugal strain sets it ringing by 1e-7 of the energy.
        assert!(kinetic.iter().all(|e| (e / first - 1.0).abs() <= 1e-5), "{kinetic:?}");
    }
}

#[test]
fn supports_that_move_close_the_ledger() {
    let place = Place::new();
    let scene = place
        .scene("scene.toml", &format!("{SHORT_RUN}end = \"2 ms\"\noutput_interval = \"1 us\"\n"));
    let out = place.path("out");
    succeed(into_folder("run", &scene, &out, &[]));
    let energy = &json(out.join("summary.json"))["energy"];
    let residual = number(&energy["largest_residual"]) / number(&energy["turned_over"]);
    // Strains of 1e-4 are all that keeps the discrete ledger from closing to rounding.
    assert!(residual <= 1e-3, "{residual:e}");
    assert!(number(&energy["work_damping"]) < 0.0);
    assert!(!column(&out, "reaction_x_low_z").iter().all(|force| *force == 0.0));
}

/// A body that is driven along as a whole takes its mass times the acceleration from its support.
#[test]
fn a_support_that_moves_carries_inertia() {
    let place = Place::new();
    let (way, duration) = (1e-3, 1e-3);
    let driven = r#"[[solid.set]]
name = "all"
low = ["-1 mm", "-20 mm", "-20 mm"]
high = ["50 mm", "20 mm", "20 mm"]
[[solid.fixed]]
set = "all"
x = { smooth_ramp = ["0 mm", "1 mm"], duration = "1 ms" }
[numerics]
end = "1 ms"
output_interval = "0.1 ms"
"#;
    let out = place.path("out");
    succeed(into_folder("run", &place.scene("scene.toml", &bar(1, driven)), &out, &[]));
    let mass = DENSITY * 40e-3 * 10e-3 * 10e-3;
    let largest = mass * 10.0 / 3f64.sqrt() * way / (duration * duration);
    let [times, forces] = ["time", "reaction_all_x"].map(|name| column(&out, name));
    assert!(times.len() >= 11);
    for (time, force) in times.iter().zip(forces) {
        let f = time / duration;
        let acceleration = 60.0 * f * (1.0 - f) * (1.0 - 2.0 * f) * way / (duration * duration);
        // Rows lie on steps: rounding of their times, and of element forces that sum to nothing.
        assert!((force - mass * acceleration).abs() <= 1e-6 * largest, "{time}: {force}");
    }
}

#[test]
fn paraview_opens_fields_and_modes() {
    let Some(python) = python_with_vtk("paraview_opens_fields_and_modes") else { return };
    let place = Place::new();
    let [statics, modes, run] = ["statics", "modes", "run"].map(|name| place.path(name));
    succeed(into_folder("statics", &shipped("cantilever.toml"), &statics, &[]));
    succeed(into_folder("modes", &shipped("ring_modes.toml"), &modes, &[]));
    let short = format!("{SHORT_RUN}end = \"0.1 ms\"\n");
    succeed(into_folder("run", &place.scene("run.toml", &short), &run, &[]));
    let paths = [
        statics.join("fields/fields_000000.vtu"),
        modes.join("fields/mode_000007.vtu"),
        run.join("fields/fields_000020.vtu"),
    ];
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_vtu.py");
    let output = Command::new(&python).arg(script).args(&paths).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let summary = json(statics.join("summary.json"));
    for (file, folder) in found.as_array().unwrap().iter().zip([&statics, &modes, &run]) {
        assert_eq!(file["problems"].as_array().unwrap().len(), 0);
        let mesh = &json(folder.join("summary.json"))["mesh"];
        assert_eq!((&file["points"], &file["cells"]), (&mesh["nodes"], &mesh["elements"]));
    }
    let largest = found[0]["cell_data"]["von_mises"][2][0].as_f64().unwrap();
    assert_eq!(largest, number(&summary["largest"]["von_mises_of_elements"]));
    assert_eq!(found[0]["cell_data"]["cauchy_stress"][0], 6);
    assert_eq!(found[1]["point_data"]["mode_shape"][0], 3);
    let velocity = found[2]["point_data"]["velocity"][2][0].as_f64().unwrap();
    assert!(velocity > 0.0 && velocity < 100.0, "{velocity}");
}

#[test]
fn times_of_a_run_are_written_as_people_write_them() {
    let place = Place::new();
    let numerics =
        "[numerics]\nend = \"0.4 ms\"\nstep = \"0.1 us\"\noutput_interval = \"0.1 ms\"\n";
    let scene = place.scene("scene.toml", &bar(1, &format!("{ON_ROLLERS}{numerics}")));
    let said = succeed(into_folder("run", &scene, &place.path("out"), &[]));
    // 4000 × 1e-7 and 4000 additions of it are both something else.
    assert!(4000.0 * 1e-7 != 0.0004 && (0..4000).fold(0.0, |t, _| t + 1e-7) != 0.0004);
    assert!(said.contains("4000 steps to t = 0.0004 s,"), "{said}");
    assert_eq!(column(&place.path("out"), "time"), [0.0, 0.0001, 0.0002, 0.0003, 0.0004]);
    assert_eq!(number(&json(place.path("out/summary.json"))["time"]), 0.0004);
}

/// Steps and their length, foretold and taken: of the scene that is shipped and of random ends, rows and
/// steps, given or from the limit.
#[test]
fn a_plan_foretells_the_steps_of_a_run() {
    let place = Place::new();
    let mut state = 3u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let short = fs::read_to_string(shipped("bar_impact.toml")).unwrap();
    let meshes = shipped("meshes");
    let short = short
        .replace("end = \"0.4 ms\"", "end = \"0.1 ms\"")
        .replace("\"meshes/", &format!("\"{}/", meshes.display()));
    let mut scenes = vec![place.scene("bar_impact.toml", &short)];
    for index in 0..12 {
        let order = 1 + index % 2;
        let step = 0.02 + 0.03 * random();
        let per_row = 1.0 + (9.0 * random()).floor();
        let rows = 1.0 + (9.0 * random()).floor();
        // The last row may be off the grid, by whole steps.
        let end = step * (per_row * rows + [0.0, 1.0, 0.0][index % 3]);
        let stepping = match index % 4 {
            0 => format!("step = \"{step} us\"\n"),
            1 => "step_fraction = 0.37\n".to_string(),
            2 => format!("step = \"{step} us\"\nmethod = \"runge-kutta\"\n"),
            _ => String::new(),
        };
        let numerics = format!(
            "{ON_ROLLERS}[numerics]\nend = \"{end} us\"\noutput_interval = \"{} us\"\n{stepping}",
            step * per_row
        );
        scenes.push(place.scene(&format!("{index}.toml"), &bar(order as u8, &numerics)));
    }
    for (index, scene) in scenes.iter().enumerate() {
        let plan = succeed(command("plan", scene, &[]));
        let out = place.path(&format!("out-{index}"));
        succeed(into_folder("run", scene, &out, &[]));
        let summary = json(out.join("summary.json"));
        let line = plan.lines().find(|line| line.contains(" of the stability limit ")).unwrap();
        let (before, _) = line.split_once(" steps to t = ").unwrap();
        let steps: u64 = before.rsplit(' ').next().unwrap().parse().unwrap();
        assert_eq!(summary["work"]["steps"], steps, "{plan}");
        let size = number(&summary["step"]["size"]);
        let limit = number(&summary["step"]["limit"]["step"]);
        for part in [format!("{size:.3e} s is"), format!("stability limit {limit:.3e} s")] {
            assert!(line.contains(&part), "{part}: {plan}");
        }
        let time = column(&out, "time").last().copied().unwrap();
        assert!((time / (steps as f64 * size) - 1.0).abs() <= 1e-8, "{time}: {plan}");
    }
}
