//! Small vibrations, bending and run-ups of rotors against closed forms, from written numbers.

use crate::command_line_common::{done, json, read, scene, text, write};
use nalgebra::{DMatrix, Matrix2, Matrix2x4, Matrix4};
use std::f64::consts::{PI, TAU};
use std::path::Path;
use tempfile::tempdir;

/// Frequency (Hz), damping ratio and direction of each whirl mode.
fn whirl(content: &str) -> Vec<[f64; 3]> {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.toml", content);
    let out = root.path().join("out");
    done(&["modes", &path, "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    let modes = summary["rotor"]["whirl"].as_array().unwrap().iter();
    let numbers = ["frequency", "damping_ratio", "direction"];
    modes.map(|of| numbers.map(|key| of[key]["value"].as_f64().unwrap())).collect()
}

fn assert_whirl(found: &[[f64; 3]], expected: &mut [[f64; 2]], tolerance: f64) {
    expected.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        for (found, expected) in found.iter().zip(expected.iter()) {
            assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} {expected}");
        }
    }
}

/// A rigid body on one spring whose planes are coupled, stiffness and damping each their own way.
#[test]
fn coupled_planes_whirl_as_their_matrices_have_it() {
    let mass = 10.0;
    let damping = [[300.0, 900.0], [-200.0, 500.0]];
    let rotor = |stiffness: [[f64; 2]; 2], damping: [[f64; 2]; 2]| {
        let list = |[[y, yz], [zy, z]]: [[f64; 2]; 2], unit: &str| {
            format!(
                "{{ y = \"{y} {unit}\", z = \"{z} {unit}\", yz = \"{yz} {unit}\", zy = \"{zy} {unit}\" }}"
            )
        };
        whirl(&format!(
            "[body.rotor]\nx = {{ displacement = \"0 mm\" }}\ntilt_y = {{ tilt = \"0 deg\" }}\ntilt_z = {{ tilt = \"0 deg\" }}\n\
             speed = \"1000 rpm\"\ninertia = {{ mass = \"{mass} kg\", axial = \"0.1 kg m^2\", transverse = \"0.1 kg m^2\" }}\n\
             [spring.mount]\nfrom = \"ground\"\nto = \"rotor\"\nstiffness = {}\ndamping = {}\n",
            list(stiffness, "N/m"),
            list(damping, "N s/m"),
        ))
    };
    // The second has no stiffness along Z but the coupled one, whose mean is zero: the equilibrium has none.
    for stiffness in [[[4e6, 1e6], [-5e5, 6e6]], [[4e6, 1e6], [-1e6, 0.0]]] {
        let found = rotor(stiffness, damping);
        let mut rates = Matrix4::zeros();
        for i in 0..2 {
            rates[(i, i + 2)] = 1.0;
            for j in 0..2 {
                rates[(i + 2, j)] = -stiffness[i][j] / mass;
                rates[(i + 2, j + 2)] = -damping[i][j] / mass;
            }
        }
        let values = rates.complex_eigenvalues();
        let upper = values.iter().filter(|value| value.im > 0.0);
        let mut expected: Vec<_> =
            upper.map(|value| [value.im / TAU, -value.re / value.norm()]).collect();
        assert_whirl(&found, &mut expected, 1e-9);
    }
    // F_y = −K_yz z and F_z = −K_zy y push along a turn from Y towards Z where K_yz > 0 > K_zy: forward whirl grows.
    let growing = |yz: f64| {
        let modes = rotor([[4e6, yz], [-yz, 4e6]], [[0.0; 2]; 2]);
        modes.into_iter().find(|mode| mode[1] < 0.0).unwrap()[2]
    };
    assert!(growing(1e5) > 0.9 && growing(-1e5) < -0.9);
}

/// At each critical speed of a rigid disc beside a spring with coupled planes, an undamped mode has the frequency of
/// the spin.
#[test]
fn circulatory_springs_shift_critical_speeds() {
    let (mass, [axial, transverse], aside) = (10.0, [0.05, 0.2], 0.1);
    let (spring, tilting) = ([[4e6, 1.5e6], [-1e6, 5e6]], 3e5);
    let [[y, yz], [zy, z]] = spring;
    let root = tempdir().unwrap();
    let content = format!(
        "[body.rotor]\nx = {{ displacement = \"0 mm\" }}\nspeed = \"20000 rpm\"\n\
         inertia = {{ mass = \"{mass} kg\", axial = \"{axial} kg m^2\", transverse = \"{transverse} kg m^2\" }}\n\
         [body.rotor.foundation]\nstiffness = {{ tilt_y = \"{tilting} N m/rad\", tilt_z = \"{tilting} N m/rad\" }}\n\
         [spring.mount]\nfrom = \"ground\"\nto = \"rotor\"\nto_at = \"{aside} m\"\nfrom_at = \"{aside} m\"\n\
         stiffness = {{ y = \"{y} N/m\", z = \"{z} N/m\", yz = \"{yz} N/m\", zy = \"{zy} N/m\" }}\n"
    );
    let path = write(root.path(), "scene.toml", &content);
    let out = root.path().join("out");
    done(&["modes", &path, "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    let found = summary["rotor"]["critical_speeds"].as_array().unwrap();
    // y, z, tilt_y, tilt_z: a tilt about Z lifts the end of the spring along Y, one about Y lowers it along Z.
    let at_spring = Matrix2x4::new(1.0, 0.0, 0.0, aside, 0.0, 1.0, -aside, 0.0);
    let stiffness = at_spring.transpose() * Matrix2::new(y, yz, zy, z) * at_spring
        + Matrix4::from_diagonal(&[0.0, 0.0, tilting, tilting].into());
    let inertia = [mass, mass, transverse, transverse];
    for critical in found {
        let speed = critical["speed"]["value"].as_f64().unwrap();
        let mut rates = DMatrix::zeros(8, 8);
        for i in 0..4 {
            rates[(i, i + 4)] = 1.0;
            (0..4).for_each(|j| rates[(i + 4, j)] = -stiffness[(i, j)] / inertia[i]);
        }
        rates[(6, 7)] = -speed * axial / transverse;
        rates[(7, 6)] = speed * axial / transverse;
        let values = rates.complex_eigenvalues();
        let off = values.iter().map(|of| (of.im - speed).abs() / speed);
        let off = off.fold(f64::INFINITY, f64::min);
        assert!(off <= 1e-8, "{speed}: {off:e}");
    }
    // Two circles of the centre, two of the tilts.
    assert_eq!(found.len(), 4, "{found:?}");
}

/// Each coordinate of a foundation vibrates with its own spring and dashpot.
#[test]
fn springs_and_dashpots_of_a_foundation_act_on_their_coordinates() {
    let stiffness = [2e6, 4e6, 3e5, 5e5];
    let damping = [300.0, 500.0, 20.0, 40.0];
    let [k, c] = [stiffness, damping].map(|of| {
        let units = if of == stiffness { ["N/m", "N m/rad"] } else { ["N s/m", "N m s/rad"] };
        let names = ["y", "z", "tilt_y", "tilt_z"];
        let keys = names.iter().zip(of).enumerate();
        keys.map(|(i, (name, value))| format!("{name} = \"{value} {}\"", units[i / 2]))
            .collect::<Vec<_>>()
            .join(", ")
    });
    let found = whirl(&format!(
        "[body.rotor]\nx = {{ displacement = \"0 mm\" }}\nspeed = \"0.001 rpm\"\n\
         inertia = {{ mass = \"10 kg\", axial = \"0.05 kg m^2\", transverse = \"0.2 kg m^2\" }}\n\
         [body.rotor.foundation]\nstiffness = {{ {k} }}\ndamping = {{ {c} }}\n\
         [spring.mount]\nfrom = \"ground\"\nto = \"rotor\"\nstiffness = {{ y = \"1e-3 N/m\" }}\n"
    ));
    let inertia = [10.0f64, 10.0, 0.2, 0.2];
    let mut expected: Vec<_> = (0..4)
        .map(|i| {
            let natural = (stiffness[i] / inertia[i]).sqrt();
            let ratio = 0.5 * damping[i] / (stiffness[i] * inertia[i]).sqrt();
            [natural * (1.0 - ratio * ratio).sqrt() / TAU, ratio]
        })
        .collect();
    // A turn of 1e-4 rad/s.
    assert_whirl(&found, &mut expected, 1e-6);
}

/// Damping in proportion to the mass takes α/2 from every rate, of rigid motion and of bending.
#[test]
fn absolute_damping_of_a_shaft_damps_all_motion_alike() {
    let shipped = read(Path::new(&scene("rotor_on_springs.toml")));
    let dense = "density = \"7810 kg/m^3\"";
    let modes = |damping: &str| {
        whirl(
            &shipped.replace("4000 rpm", "0.001 rpm").replace(dense, &format!("{dense}{damping}")),
        )
    };
    let (free, damped) = (modes(""), modes("\ndamping = \"50 1/s\""));
    assert!(free.len() >= 8);
    let mut expected: Vec<_> = free
        .iter()
        .map(|[frequency, ..]| {
            let ratio = 25.0 / (TAU * frequency);
            [frequency * (1.0 - ratio * ratio).sqrt(), ratio]
        })
        .collect();
    assert_whirl(&damped, &mut expected, 1e-6);
}

/// Damping that does not rotate takes energy out of every motion, at any speed.
#[test]
fn damping_against_the_ground_destabilises_no_whirl() {
    let shipped = read(Path::new(&scene("rotor_on_springs.toml")));
    let dense = "density = \"7810 kg/m^3\"";
    for moved in ["absolute", "relative-to-rigid"] {
        let damping = format!("{dense}\ndamping = \"50 1/s\"\ndamped_motion = \"{moved}\"");
        for speed in ["6000 rpm", "-9000 rpm"] {
            let found = whirl(&shipped.replace("4000 rpm", speed).replace(dense, &damping));
            assert!(found.len() >= 6, "{found:?}");
            assert!(found.iter().all(|[_, ratio, _]| *ratio > 0.0), "{moved} {speed}: {found:?}");
        }
    }
}

/// A shaft of 1 m × 20 mm at rest on two springs, its left end held along the axis, with 100 N in the middle.
fn bent_shaft(rest: &str) -> String {
    let spring = |name: &str, at: f64, along: &str| {
        format!(
            "[spring.{name}]\nfrom = \"ground\"\nto = \"rotor\"\nto_at = \"{at} m\"\nfrom_at = \"{at} m\"\n\
             stiffness = {{ {along}y = \"1e8 N/m\", z = \"1e8 N/m\" }}\n"
        )
    };
    format!(
        "[body.rotor]\nx = {{ load = \"0 N\" }}\nspeed = \"0 rpm\"\n[body.rotor.beam]\nyoungs_modulus = \"211 GPa\"\n\
         poisson_ratio = 0.3\ndensity = \"7810 kg/m^3\"\nsegments = [{{ length = \"1 m\", outer_diameter = \"20 mm\" }}]\n\
         load = [{{ at = \"0 mm\", z = \"-100 N\" }}]\n{}{}{rest}",
        spring("left", -0.5, "x = \"1e6 N/m\", "),
        spring("right", 0.5, "")
    )
}

/// A run begins in equilibrium: the energy of bending is all strain, F² L³/(96 E I).
#[test]
fn the_energy_of_a_shaft_bent_at_rest_is_strain() {
    let root = tempdir().unwrap();
    let run = "[numerics]\nend = \"1 ms\"\noutput_interval = \"0.1 ms\"\n[output]\nplots = []\n";
    let path = write(root.path(), "scene.toml", &bent_shaft(run));
    let out = root.path().join("out");
    done(&["run", &path, "--out", &text(&out)]);
    let rows = read(&out.join("series.csv"));
    let mut lines = rows.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let (names, first) = (lines.next().unwrap(), lines.next().unwrap());
    let value = |name: &str| {
        let at = names.iter().position(|own| own.starts_with(name)).expect(name);
        first[at].parse::<f64>().unwrap()
    };
    let strain = 100.0f64.powi(2) / (96.0 * 211e9 * PI * 0.02f64.powi(4) / 64.0);
    let (found, kinetic) = (value("energy_bending_strain"), value("energy_bending_kinetic"));
    // Shear, and the modes kept.
    assert!((found / strain - 1.0).abs() <= 2e-2, "{found} {strain}");
    assert!(kinetic.abs() <= 1e-9 * strain, "{kinetic}");
}

/// A bent shaft shortens towards its centre of mass: with its left end held along the axis and its load in the middle,
/// the middle moves by ½ ∫ w'² of the left half, w' = F (L² − 4 x²)/(16 E I).
#[test]
fn a_bent_shaft_shortens_towards_its_centre_of_mass() {
    let root = tempdir().unwrap();
    let (length, diameter, young, force) = (1.0f64, 0.02f64, 211e9, 100.0);
    let path = write(root.path(), "scene.toml", &bent_shaft(""));
    let out = root.path().join("out");
    done(&["statics", &path, "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    let found = summary["bodies"]["rotor"]["position"]["x"]["value"].as_f64().unwrap();
    let slope = force * length * length * 64.0 / (16.0 * young * PI * diameter.powi(4));
    let expected = -0.5 * slope * slope * length * 4.0 / 15.0;
    // Shear, (d/L)² of the deflection.
    assert!((found / expected - 1.0).abs() <= 5e-3, "{found} {expected}");
}

/// Pixel of the axis of the speed.
const AXIS: f64 = 500.0;

/// Over a run-up the amplitude along Z is that of Z, along Y that of Y.
#[test]
fn amplitudes_of_a_run_up_are_drawn_axis_by_axis() {
    let root = tempdir().unwrap();
    let path = write(
        root.path(),
        "scene.toml",
        "[body.rotor]\nx = { displacement = \"0 mm\" }\ntilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n\
         speed = { ramp = [\"600 rpm\", \"3000 rpm\"], duration = \"1 s\" }\nunbalance = \"1e-3 kg m\"\n\
         inertia = { mass = \"10 kg\", axial = \"0.1 kg m^2\", transverse = \"0.1 kg m^2\" }\n\
         [spring.mount]\nfrom = \"ground\"\nto = \"rotor\"\nstiffness = { y = \"4e6 N/m\", z = \"1e6 N/m\" }\n\
         damping = { y = \"300 N s/m\", z = \"500 N s/m\" }\n\
         [numerics]\nend = \"1 s\"\noutput_interval = \"0.5 ms\"\nstep = \"50 us\"\n[output]\nplots = [\"run-up\"]\n",
    );
    let out = root.path().join("out");
    done(&["run", &path, "--out", &text(&out)]);
    let picture = read(&out.join("run_up_amplitude_rotor.svg"));
    let heights = |part: &str| -> Vec<f64> {
        let points = part.split_once("points=\"").unwrap().1.split('"').next().unwrap();
        points
            .split_whitespace()
            .map(|point| point.split_once(',').unwrap().1.parse().unwrap())
            .collect()
    };
    let lines: Vec<Vec<f64>> = picture.split("<polyline").skip(1).map(heights).collect();
    let curves: Vec<f64> = lines
        .iter()
        .filter(|line| line.len() > 10)
        .map(|line| AXIS - line.iter().copied().fold(f64::INFINITY, f64::min))
        .collect();
    let rows = read(&out.join("series.csv"));
    let mut rows = rows.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let header = rows.next().unwrap();
    let [y, z] = ["rotor_y [m]", "rotor_z [m]"]
        .map(|name| header.iter().position(|of| *of == name).unwrap());
    let most = rows.fold([0.0f64; 2], |most, row| {
        let at = |column: usize| row[column].parse::<f64>().unwrap().abs();
        [most[0].max(at(y)), most[1].max(at(z))]
    });
    let [half_y, _, half_z, _] = curves[..] else { panic!("{curves:?}") };
    let (drawn, written) = (half_z / half_y, most[1] / most[0]);
    // A pixel of 27, and the vibration of a turn about its middle.
    assert!((drawn / written - 1.0).abs() <= 0.15, "{drawn} {written}");
}

/// An unbalance pulls a resting shaft to its own side: as a beam, and in elements that take steps of their own.
#[test]
fn an_unbalance_pulls_where_its_angle_points() {
    let shipped = read(Path::new(&scene("rotor_in_elements.toml")));
    let root = tempdir().unwrap();
    let elements = "mesh = { order = 1, method = \"explicit\", longest_layer = \"5 mm\" }\n";
    assert!(shipped.contains(elements));
    let coarse = elements.replace("5 mm", "25 mm");
    for (name, mesh) in [("elements", coarse.as_str()), ("beam", "")] {
        let kept: Vec<&str> =
            shipped.lines().filter(|line| !line.starts_with("load = [")).collect();
        let content = (kept.join("\n") + "\n")
            .replace(elements, mesh)
            .replace("probe = [", "unbalance = [{ at = \"0 mm\", size = \"1e-2 kg m\", angle = \"30 deg\" }]\nprobe = [")
            .replace("end = \"5 ms\"", "end = \"20 us\"\nstart = \"nominal\"")
            .replace("output_interval = \"20 us\"", "output_interval = \"2 us\"");
        let content =
            if name == "elements" { content.replace("\nstart = \"nominal\"", "") } else { content };
        let path = write(root.path(), &format!("{name}.toml"), &content);
        let out = root.path().join(name);
        done(&["run", &path, "--out", &text(&out), "--set", "output.plots=[]"]);
        let rows = read(&out.join("series.csv"));
        let header: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
        let last: Vec<&str> = rows.lines().last().unwrap().split(',').collect();
        let [y, z] = ["shaft_mid_y [m]", "shaft_mid_z [m]"].map(|name| {
            let column = header.iter().position(|of| *of == name).unwrap();
            last[column].parse::<f64>().unwrap()
        });
        let angle = z.atan2(y).to_degrees();
        // It turns by 0.7° in 20 µs.
        assert!(y.hypot(z) > 1e-7 && (angle - 30.0).abs() <= 1.0, "{name}: {angle} {y} {z}");
    }
}

/// A shaft that bends, with damping in both axes and an unbalance, on springs that couple both planes: with side = 1, or its
/// mirror image, y to −y, with side = −1.
fn on_coupled_springs(side: f64) -> String {
    let spring = |name: &str, at: f64| {
        format!(
            "[spring.{name}]\nfrom = \"ground\"\nto = \"rotor\"\nto_at = \"{at} mm\"\nfrom_at = \"{at} mm\"\n\
             stiffness = {{ y = \"1e6 N/m\", z = \"2e6 N/m\", yz = \"{} N/m\", zy = \"{} N/m\" }}\n\
             damping = {{ y = \"300 N s/m\", z = \"500 N s/m\", yz = \"{} N s/m\" }}\n",
            side * 1e5,
            side * 1e5,
            side * 100.0
        )
    };
    // Angles count from Y, which the mirror reverses.
    let angle = 90.0 - side * 60.0;
    format!(
        "[body.rotor]\nx = {{ displacement = \"0 mm\" }}\nspeed = \"{} rpm\"\n[body.rotor.beam]\n\
         segments = [{{ length = \"1 m\", outer_diameter = \"30 mm\" }}]\ninternal_damping = \"300 1/s\"\ndamping = \"20 1/s\"\n\
         load = [{{ at = \"100 mm\", y = \"{} N\", z = \"-400 N\" }}]\nprobe = [{{ name = \"mid\", at = \"0 mm\" }}]\n\
         unbalance = [{{ at = \"200 mm\", size = \"1e-3 kg m\", angle = \"{angle} deg\" }}]\n{}{}\
         [numerics]\nend = \"2 ms\"\noutput_interval = \"0.1 ms\"\nstep = \"5 us\"\nstart = \"equilibrium\"\n[output]\nplots = []\n",
        side * 3000.0,
        side * 60.0,
        spring("left", -500.0),
        spring("right", 500.0)
    )
}

/// Sign of a column in the mirror: vectors along Y and rotations about X and Z are reversed.
fn mirror_sign(name: &str) -> f64 {
    let rotates = ["tilt", "moment", "speed"].iter().any(|word| name.contains(word));
    if rotates != name.ends_with('y') { -1.0 } else { 1.0 }
}

/// A number and its mirror image are equal to rounding, relative to the largest number of the column.
fn assert_mirrored(name: &str, [found, image]: [f64; 2], size: f64) {
    let error = (mirror_sign(name) * image - found).abs();
    assert!(error <= 1e-9 * size + 1e-12, "{name}: {found} {image}");
}

/// A shaft that turns backwards is the mirror image of one that turns forwards, at rest and in each column of a run from
/// its equilibrium.
#[test]
fn a_shaft_that_turns_backwards_is_the_mirror_image() {
    let root = tempdir().unwrap();
    let both = |command: &str| {
        [1.0, -1.0].map(|side| {
            let path = write(root.path(), "scene.toml", &on_coupled_springs(side));
            let out = root.path().join(format!("{command} {side}"));
            done(&[command, &path, "--out", &text(&out)]);
            out
        })
    };
    let sections = both("statics").map(|out| {
        let summary = json(&out.join("summary.json"));
        let mut all = summary["sections"].as_array().unwrap().clone();
        all.push(summary["bodies"]["rotor"]["position"].clone());
        all
    });
    assert!(sections[0].len() >= 4 && sections[0].len() == sections[1].len());
    for (one, image) in sections[0].iter().zip(&sections[1]) {
        for key in ["x", "y", "z", "tilt_y", "tilt_z"] {
            let values = [one, image].map(|of| of[key]["value"].as_f64().unwrap());
            assert_mirrored(key, values, values[0].abs());
        }
    }
    let [mut found, mut images] = [1.0, -1.0].map(|side| whirl(&on_coupled_springs(side)));
    assert!(found.len() >= 4 && found.len() == images.len(), "{found:?} {images:?}");
    for modes in [&mut found, &mut images] {
        modes.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    for (one, image) in found.iter().zip(&images) {
        // Directions count from the sense of the speed.
        for (one, image) in one.iter().zip(image) {
            assert!((one - image).abs() <= 1e-6 * one.abs(), "{found:?} {images:?}");
        }
    }
    let [found, images] = both("run").map(|out| {
        let table = read(&out.join("series.csv"));
        let rows: Vec<Vec<String>> =
            table.lines().map(|row| row.split(',').map(String::from).collect()).collect();
        rows
    });
    assert!(found[0] == images[0] && found.len() == images.len() && found.len() > 20);
    let mut reversed = 0;
    for (i, column) in found[0].iter().enumerate() {
        let name = column.split(' ').next().unwrap();
        let values = |rows: &[Vec<String>]| -> Vec<f64> {
            rows[1..].iter().map(|row| row[i].parse().unwrap()).collect()
        };
        let [found, images] = [&found, &images].map(|rows| values(rows));
        let size = found.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        reversed += usize::from(size > 1e-6 && mirror_sign(name) < 0.0);
        for (found, image) in found.into_iter().zip(images) {
            assert_mirrored(name, [found, image], size);
        }
    }
    // Position, tilt, velocity, speed, probe and two forces.
    assert!(reversed >= 7, "{reversed}: {:?}", found[0]);
}
