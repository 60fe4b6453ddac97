//! A scene with a solid alone as a user meets it: values against closed forms, results folders,
//! signals and resuming, errors.

use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

const YOUNG: f64 = 210e9;
const DENSITY: f64 = 7850.0;

struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Place {
        Place { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn scene(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).unwrap();
        path
    }
}

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

fn command(name: &str, scene: &Path, further: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bearing"));
    command.arg(name).arg(scene).args(further);
    command
}

fn into_folder(name: &str, scene: &Path, out: &Path, further: &[&str]) -> Command {
    let mut command = command(name, scene, further);
    command.arg("--out").arg(out);
    command
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn succeed(mut command: Command) -> String {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn json(path: PathBuf) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value["value"].as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

fn assert_near(ours: f64, expected: f64, relative: f64) {
    let error = (ours / expected - 1.0).abs();
    assert!(error <= relative, "{ours:e} is {error:e} off {expected:e}");
}

/// A column of a run's `series.csv`.
fn column(folder: &Path, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("series.csv")).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    let at = header.split(',').position(|head| head.starts_with(&format!("{name} [")));
    let at = at.unwrap_or_else(|| panic!("{name} is not in {header}"));
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

/// A steel bar of 40 × 10 × 10 mm.
fn bar(order: u8, further: &str) -> String {
    format!(
        r#"
[solid.mesh]
generate = "bar"
length = "40 mm"
width = "10 mm"
height = "10 mm"
cells = {{ along = 4, across = 2, up = 2 }}
order = {order}
[solid.material]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
{further}
"#
    )
}

const ON_ROLLERS: &str = r#"
[[solid.held]]
set = "x_low"
x = true
[[solid.held]]
set = "y_low"
y = true
[[solid.held]]
set = "z_low"
z = true
[[solid.probe]]
set = "x_high"
name = "end"
"#;

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
            ("", "[[solid.held]]\nset = \"x_high\"\nx = \"-1.904762 um\"\n"),
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
    for part in ["of the stability limit", "fastest element", "a row every", "fields every 40 rows"]
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
    let peak = number(&summary["spectra"]["far_x"]["peaks"][0]["frequency"]);
    let bin = number(&summary["spectra"]["far_x"]["bin_width"]);
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

const SHORT_RUN: &str = r#"
[solid]
damping = "100 1/s"
[solid.mesh]
generate = "ring"
inner_radius = "20 mm"
outer_radius = "25 mm"
width = "10 mm"
cells = { around = 24, radial = 2, axial = 2 }
order = 1
[[solid.held]]
set = "x_low"
x = true
y = true
z = { amplitude = "1 um", frequency = "5 kHz" }
[[solid.load]]
set = "outer"
pressure = { half_sine = "20 MPa", duration = "0.1 ms" }
[[solid.probe]]
set = "x_high"
[numerics]
"#;

/// Every file of two folders to the byte, but for wall times.
fn assert_same_results(expected: &Path, found: &Path) {
    let names = |folder: &Path| {
        let list = |folder: PathBuf, before: &str| {
            let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
            let files = entries.filter(|entry| entry.path().is_file());
            let names =
                files.map(|entry| format!("{before}{}", entry.file_name().to_string_lossy()));
            names.collect::<Vec<_>>()
        };
        let mut names = list(folder.to_path_buf(), "");
        names.extend(list(folder.join("fields"), "fields/"));
        // A process that was killed leaves the file that it was writing, under a name of its own.
        names.retain(|name| !name.ends_with(".partial"));
        names.sort();
        names
    };
    assert_eq!(names(expected), names(found));
    for name in names(expected) {
        let [a, b] = [expected, found].map(|folder| folder.join(&name));
        if ["summary.json", "state.json"].contains(&name.as_str()) {
            let [mut a, mut b] = [a, b].map(json);
            for tree in [&mut a, &mut b] {
                assert!(tree.as_object_mut().unwrap().remove("seconds").is_some(), "{name}");
            }
            assert_eq!(a.to_string(), b.to_string(), "{name}");
        } else {
            assert!(fs::read(a).unwrap() == fs::read(b).unwrap(), "{name} differs");
        }
    }
}

/// Starts a run and waits until it steps.
fn start(mut command: Command) -> Child {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.as_mut().unwrap());
    let mut line = String::new();
    while !line.contains("a row every") {
        line.clear();
        assert!(lines.read_line(&mut line).unwrap() > 0, "it ended before it stepped");
    }
    child
}

fn signal(child: &Child, name: &str) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args([name, &id]).status().unwrap().success());
}

fn wait(mut child: Child) -> (Option<i32>, String) {
    let mut text = String::new();
    child.stderr.as_mut().unwrap().read_to_string(&mut text).unwrap();
    (child.wait().unwrap().code(), text)
}

#[test]
fn interrupted_killed_and_extended_runs_end_with_the_same_bytes() {
    for method in ["central-differences", "runge-kutta"] {
        let place = Place::new();
        let numerics = |end: &str| {
            let fixed = "output_interval = \"10 us\"\nfields_interval = \"0.5 ms\"";
            format!("{SHORT_RUN}method = \"{method}\"\nend = \"{end}\"\n{fixed}\n")
        };
        // A second or so; the end lies off the grid of rows.
        let scene = place.scene("scene.toml", &numerics("4.003 ms"));
        let (whole, parts) = (place.path("whole"), place.path("parts"));
        let child = start(into_folder("run", &scene, &parts, &["--save-every", "1"]));
        std::thread::sleep(std::time::Duration::from_millis(100));
        signal(&child, "-TERM");
        let (code, message) = wait(child);
        assert_eq!(code, Some(2), "{message}");
        assert!(
            message.contains("interrupted at t = ") && message.contains("--resume"),
            "{message}"
        );
        let summary = json(parts.join("summary.json"));
        assert_eq!(
            (&summary["complete"], &summary["stopped_by"]),
            (&false.into(), &"interrupted".into())
        );

        // Without a word about it nothing is overwritten.
        let refused = into_folder("run", &scene, &parts, &[]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2));
        assert!(stderr(&refused).contains("--resume") && stderr(&refused).contains("--fresh"));
        assert_eq!(json(parts.join("summary.json")), summary);

        // Killed outright it goes on from the state kept before.
        let child = start(into_folder("run", &scene, &parts, &["--resume"]));
        std::thread::sleep(std::time::Duration::from_millis(50));
        signal(&child, "-KILL");
        assert_eq!(wait(child).0, None);
        let said = succeed(into_folder("run", &scene, &parts, &["--resume"]));
        assert!(said.contains("resumed at t = "), "{said}");
        succeed(into_folder("run", &scene, &whole, &[]));
        assert_same_results(&whole, &parts);

        // A complete run goes on to a later end.
        let longer = place.scene("scene.toml", &numerics("5 ms"));
        succeed(into_folder("run", &longer, &parts, &["--resume"]));
        succeed(into_folder("run", &longer, &whole, &["--fresh"]));
        assert_same_results(&whole, &parts);

        // Another scene does not go on from there.
        let text = numerics("6 ms").replace("20 MPa", "21 MPa");
        let other = place.scene("other.toml", &text);
        let refused = into_folder("run", &other, &parts, &["--resume"]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2));
        assert!(stderr(&refused).contains("another scene"), "{}", stderr(&refused));
    }
}

#[test]
fn a_run_that_fails_says_where_and_keeps_its_state() {
    let place = Place::new();
    let numerics = "end = \"1 ms\"\noutput_interval = \"1 us\"\n";
    let text = format!("{SHORT_RUN}{numerics}").replace("20 MPa", "200 GPa");
    let scene = place.scene("scene.toml", &text);
    let out = place.path("out");
    let output = into_folder("run", &scene, &out, &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("t = ") && message.contains("step "), "{message}");
    assert!(message.contains("the rows so far and the state at the last row"), "{message}");
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["complete"], false);
    assert!(message.contains(summary["stopped_by"].as_str().unwrap()), "{message}");
    let state = json(out.join("state.json"));
    assert_eq!(state["stopped"], "failed");
    assert_eq!(state["time"], summary["time"]["value"]);
    assert_eq!(summary["output"]["rows"], column(&out, "time").len());
    // It may be looked at, and a gentler scene may take its folder.
    succeed(into_folder(
        "run",
        &place.scene("g.toml", &format!("{SHORT_RUN}{numerics}")),
        &out,
        &[],
    ));
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

#[test]
fn meshes_from_files_are_repaired_only_when_asked() {
    let place = Place::new();
    fs::copy(shipped("meshes/bar.msh"), place.path("bar.msh")).unwrap();
    // Two corners of the first tetrahedron exchanged turn it inside out.
    let text = fs::read_to_string(place.path("bar.msh")).unwrap();
    let at = text.find("\n3 1 4 ").expect("the block of tetrahedra");
    let line_start = at + 1 + text[at + 1..].find('\n').unwrap() + 1;
    let line_end = line_start + text[line_start..].find('\n').unwrap();
    let words: Vec<&str> = text[line_start..line_end].split_whitespace().collect();
    let turned = [words[0], words[1], words[3], words[2], words[4]].join(" ");
    let broken = format!("{}{turned}{}", &text[..line_start], &text[line_end..]);
    fs::write(place.path("broken.msh"), broken).unwrap();
    let scene = |name: &str, further: &str| {
        let text = format!("[solid.mesh]\nfile = \"{name}\"\nunit = \"mm\"\n{further}");
        place.scene("scene.toml", &text)
    };
    let output = command("check", &scene("broken.msh", ""), &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("1 of 1798 elements are inverted"), "{}", stderr(&output));
    let said = succeed(command("check", &scene("broken.msh", "repair = [\"orient\"]\n"), &[]));
    assert!(said.contains("1 elements turned"), "{said}");
    // In metres it would be a hundred of them: said, not refused.
    let said = succeed(command(
        "check",
        &place.scene("m.toml", "[solid.mesh]\nfile = \"bar.msh\"\nunit = \"m\"\n"),
        &[],
    ));
    assert!(said.contains("as millimetres it would be"), "{said}");
    // An Abaqus file, its order raised.
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    fs::copy(data.join("box_o1.inp"), place.path("box.inp")).unwrap();
    let said = succeed(command("check", &scene("box.inp", "order = 2\n"), &[]));
    assert!(said.contains("elements of 10"), "{said}");
}

#[test]
fn every_generator_makes_a_solid() {
    let place = Place::new();
    let cases = [
        (
            "block",
            "half_width = \"0.1 mm\"\ncells = { per_half_width = 2, deep = 1, growth = 1.3 }",
        ),
        (
            "shaft",
            "radius = \"10 mm\"\nstations = [\"0 mm\", \"30 mm\", \"80 mm\"]\ncells = { along = 8, around = 8, radial = 1 }",
        ),
        (
            "shaft",
            "radius = \"10 mm\"\nlength = \"80 mm\"\ncells = { along = 8, around = 8, radial = 1 }",
        ),
        (
            "cage",
            "pockets = 8\npocket_radius = \"6.1 mm\"\ninner_radius = \"24 mm\"\nouter_radius = \"28 mm\"\nwidth = \"16 mm\"\nrelief = { depth = \"0.5 mm\", belt_width = \"13 mm\" }\ncells = { quarter = 2, bar = 1, wall = 1 }",
        ),
        (
            "housing-a",
            "bore_radius = \"26 mm\"\nside = \"80 mm\"\ndepth = \"15 mm\"\ncells = { around = 16, radial = 2, axial = 1 }",
        ),
        (
            "housing-b",
            "bore_radius = \"26 mm\"\ndepth = \"15 mm\"\ncells = { around = 16, radial = 2, axial = 1 }",
        ),
        (
            "housing-c",
            "bore_radius = \"26 mm\"\ndepth = \"15 mm\"\nouter_radius = \"37 mm\"\ncells = { around = 16, radial = 2, axial = 1 }",
        ),
        (
            "housing-d",
            "bore_radius = \"26 mm\"\nouter_radius = \"37 mm\"\ndepth = \"15 mm\"\ncells = { around = 16, radial = 2, axial = 1, growth = 1.2 }",
        ),
    ];
    for (generator, dimensions) in cases {
        for order in [1, 2] {
            let text = format!(
                "[solid.mesh]\ngenerate = \"{generator}\"\norder = {order}\n{dimensions}\n"
            );
            let scene = place.scene("scene.toml", &text);
            let said = succeed(command("check", &scene, &[]));
            assert!(said.contains("a valid scene"), "{generator}: {said}");
            if generator == "shaft" {
                let summary = succeed(command("check", &scene, &["--json"]));
                let echo: Value = serde_json::from_str(&summary).unwrap();
                assert_eq!(number(&echo["mesh"]["high"]["x"]), 0.08);
            }
        }
    }
}

#[test]
fn errors_name_what_is_wrong() {
    let place = Place::new();
    fs::copy(shipped("meshes/bar.msh"), place.path("bar.msh")).unwrap();
    fs::write(place.path("half.msh"), &fs::read(place.path("bar.msh")).unwrap()[..20_000]).unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    fs::copy(data.join("box_o2.inp"), place.path("box_o2.inp")).unwrap();
    let file = |name: &str| format!("[solid.mesh]\nfile = \"{name}\"\nunit = \"mm\"\n");
    let held = |further: &str| bar(1, &format!("{ON_ROLLERS}{further}"));
    let numerics = "[numerics]\nend = \"1 ms\"\n";
    let cases: &[(&str, &str, String)] = &[
        ("a bearing too", "check", bar(1, "[bearing]\nkind = \"deep-groove\"\n")),
        ("conditions of a bearing", "check", bar(1, "[inner_race]\nspeed = \"1 rpm\"\n")),
        ("no mesh", "check", "[solid]\ndamping = \"1 1/s\"\n".to_string()),
        ("file and generator", "check", bar(1, "").replace("order", "file = \"a.msh\"\norder")),
        ("no unit", "check", "[solid.mesh]\nfile = \"bar.msh\"\n".to_string()),
        ("no such mesh", "check", file("missing.msh")),
        ("format unknown", "check", file("bar.stl")),
        ("cut off", "check", file("half.msh")),
        ("order lowered", "check", format!("{}order = 1\n", file("box_o2.inp"))),
        ("no order", "check", bar(1, "").replace("order = 1\n", "")),
        ("no length", "check", bar(1, "").replace("length = \"40 mm\"\n", "")),
        ("key of another generator", "check", bar(1, "").replace("order", "pockets = 8\norder")),
        ("size of a file", "check", format!("{}length = \"1 mm\"\n", file("bar.msh"))),
        ("misspelt", "check", bar(1, "[[solid.held]]\nsets = \"x_low\"\n")),
        ("not a list", "check", bar(1, "[solid.held]\nset = \"x_low\"\nx = true\n")),
        ("nothing held", "check", bar(1, "[[solid.held]]\nset = \"x_low\"\n")),
        ("no such set", "check", bar(1, "[[solid.held]]\nset = \"left\"\nx = true\n")),
        ("two ways", "check", held("[[solid.held]]\nset = \"z_high\"\nx = \"1 um\"\n")),
        ("no load", "check", held("[[solid.load]]\nset = \"x_high\"\n")),
        (
            "two loads",
            "check",
            held("[[solid.load]]\nset = \"x_high\"\nz = \"1 N\"\npressure = \"1 MPa\"\n"),
        ),
        (
            "pressure on nodes",
            "check",
            held(
                "[[solid.set]]\nname = \"corner\"\nlow = [\"0 mm\", \"-5 mm\", \"-5 mm\"]\nhigh = [\"0 mm\", \"-5 mm\", \"-5 mm\"]\n[[solid.load]]\nset = \"corner\"\npressure = \"1 MPa\"\n",
            ),
        ),
        (
            "empty set",
            "check",
            bar(1, "[[solid.set]]\nname = \"cut\"\nplane = \"x\"\nat = \"41 mm\"\n"),
        ),
        (
            "set twice",
            "check",
            bar(1, "[[solid.set]]\nname = \"x_low\"\nplane = \"x\"\nat = \"0 mm\"\n"),
        ),
        ("set nowhere", "check", bar(1, "[[solid.set]]\nname = \"cut\"\n")),
        ("plane without place", "check", bar(1, "[[solid.set]]\nname = \"cut\"\nplane = \"x\"\n")),
        ("probe of nothing", "check", bar(1, "[[solid.probe]]\nname = \"tip\"\n")),
        ("incompressible", "check", bar(1, "").replace("0.3", "0.5")),
        (
            "damping as a time",
            "check",
            bar(1, "").replace("[solid.mesh]", "[solid]\ndamping = \"77 s\"\n[solid.mesh]"),
        ),
        ("free in statics", "statics", bar(1, "[[solid.held]]\nset = \"x_low\"\nx = true\n")),
        ("no end", "run", held("")),
        ("step beyond the limit", "run", held("[numerics]\nend = \"1 ms\"\nstep = \"10 us\"\n")),
        (
            "interval beyond the end",
            "run",
            held("[numerics]\nend = \"1 ms\"\nfields_interval = \"2 ms\"\n"),
        ),
        ("bearing's numerics", "run", held(&format!("{numerics}start = \"nominal\"\n"))),
        ("bearing's plot", "run", held(&format!("{numerics}[output]\nplots = [\"polar\"]\n"))),
        ("swept", "sweep", held("[sweep]\n\"solid.damping\" = [\"1 1/s\"]\n")),
        ("swept by the command", "sweep", held("")),
        (
            "too fine",
            "check",
            bar(1, "").replace("across = 2", "across = 100000").replace("up = 2", "up = 100000"),
        ),
        ("more modes than motions", "modes", bar(1, "[modes]\ncount = 500\n")),
    ];
    let mut messages = String::new();
    for (name, verb, text) in cases {
        let scene = place.scene("scene.toml", text);
        let output = command(verb, &scene, &[]).current_dir(&place.folder).output().unwrap();
        let message = stderr(&output).replace(&format!("{}/", place.folder.path().display()), "");
        assert_eq!(output.status.code(), Some(2), "{name}: {message}");
        assert_eq!(message.lines().count(), 1, "{name}: {message}");
        messages += &format!("{name}\n    {message}");
    }
    let modes = command("modes", &shipped("deep_groove_tilt.toml"), &[]).output().unwrap();
    assert_eq!(modes.status.code(), Some(2));
    assert!(stderr(&modes).contains("modes takes a solid"), "{}", stderr(&modes));
    insta::assert_snapshot!(messages);
}

#[test]
fn paraview_opens_fields_and_modes() {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let has_vtk = Command::new(&python).args(["-c", "import vtk"]).output();
    if !has_vtk.is_ok_and(|output| output.status.success()) {
        assert!(std::env::var("REQUIRE_VTK").is_err(), "{python} has no vtk");
        eprintln!("SKIPPED paraview_opens_fields_and_modes: {python} has no vtk (pip install vtk)");
        return;
    }
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
