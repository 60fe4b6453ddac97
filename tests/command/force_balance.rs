//! Force balance of every race from the numbers that are written, with balls that are heavy compared with the loads.

use crate::command_line_common;

use command_line_common::{done, json, text, write};
use serde_json::Value;
use std::f64::consts::PI;
use tempfile::tempdir;

const STIFFNESS: [f64; 3] = [2e7, 3e7, 1e7];
const GRAVITY: [f64; 3] = [3.0, -20.0, -90.0];

fn scene(reversed: bool, speed: &str) -> String {
    let [x, y, z] = STIFFNESS;
    let [g, h, k] = GRAVITY;
    format!(
        "[bearing]\nkind = \"deep-groove\"\nballs = 9\nball_phase = \"7 deg\"\npitch_radius = \"19.25 mm\"\nreversed = {reversed}\n\
         clearance = {{ radial = \"-3 um\" }}\ninner_race = {{ conformity = 0.515 }}\nouter_race = {{ conformity = 0.525 }}\n\
         ball = {{ diameter = \"7.938 mm\", material = {{ density = \"19 g/cm^3\" }} }}\n[inner_race]\n{speed}\n\
         inertia = {{ mass = \"0.1 kg\", axial = \"1e-5 kg m^2\", transverse = \"1e-5 kg m^2\" }}\n\
         x = {{ load = \"3 N\" }}\nz = {{ load = \"-5 N\" }}\n[outer_race]\nmotion = \"5-dof\"\n\
         inertia = {{ mass = \"0.2 kg\", axial = \"1e-4 kg m^2\", transverse = \"1e-4 kg m^2\" }}\ny = {{ load = \"2 N\" }}\n\
         [spring.mount]\nfrom = \"ground\"\nto = \"outer_race\"\n\
         stiffness = {{ x = \"{x} N/m\", y = \"{y} N/m\", z = \"{z} N/m\", turn_y = \"1e4 N m/rad\", turn_z = \"1e4 N m/rad\" }}\n\
         [ball_forces]\ngravity = [\"{g} m/s^2\", \"{h} m/s^2\", \"{k} m/s^2\"]\n"
    )
}

fn vector(of: &Value) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| of[axis]["value"].as_f64().unwrap())
}

#[test]
fn written_forces_balance_on_both_races() {
    let root = tempdir().unwrap();
    let ball_mass = 4.0 / 3.0 * PI * (0.5 * 7.938e-3f64).powi(3) * 19e3;
    let weight = GRAVITY.map(|g| g * ball_mass);
    for reversed in [false, true] {
        let path = write(root.path(), "scene.toml", &scene(reversed, ""));
        let out = root.path().join(reversed.to_string());
        done(&["statics", &path, "--out", &text(&out)]);
        let summary = json(&out.join("summary.json"));
        let (bodies, bearing) = (&summary["bodies"], &summary["bearings"]["bearing"]);
        // Loads have the weight of the body in them.
        let inner = [&bodies["inner_race"]["loads"], &bearing["inner_race"]["contact_force"]];
        let [load, contact] = inner.map(vector);
        for axis in 0..3 {
            assert!((load[axis] + contact[axis]).abs() <= 1e-8, "{load:?} {contact:?}");
        }
        assert!((load[0] - (3.0 + 0.1 * GRAVITY[0])).abs() <= 1e-8);
        let [load, contact, place] = [
            &bodies["outer_race"]["loads"],
            &bearing["outer_race"]["contact_force"],
            &bodies["outer_race"]["position"],
        ]
        .map(vector);
        // The part of a ball's weight along its orbit is held at its azimuth, by the outer race.
        let mut held = [0.0; 3];
        for ball in bearing["balls"].as_array().unwrap() {
            let azimuth = ball["azimuth"]["value"].as_f64().unwrap().to_radians();
            let along = [0.0, -azimuth.sin(), azimuth.cos()];
            let part: f64 = (0..3).map(|i| along[i] * weight[i]).sum();
            (0..3).for_each(|i| held[i] += part * along[i]);
        }
        assert!(held[2].abs() > 1.0, "the balls are heavy: {held:?}");
        for axis in 0..3 {
            let spring = -STIFFNESS[axis] * place[axis];
            let sum = load[axis] + contact[axis] + held[axis] + spring;
            // The same constraint takes what the inner race's offset of 0.2 um over 15 mm turns the nine ball loads of 50 N.
            assert!(sum.abs() <= 6e-3, "{axis}: {sum} of {spring}, reversed {reversed}");
        }
    }
}

/// In motion: the momentum of each race changes by the impulse of all written forces on it.
#[test]
fn written_forces_change_the_momentum_of_the_races() {
    let root = tempdir().unwrap();
    let scene = scene(false, "speed = \"3000 rpm\"")
        + "[traction]\nlaw = \"none\"\n[numerics]\nend = \"2 ms\"\noutput_interval = \"1 us\"\nstep = \"0.5 us\"\nstart = \"nominal\"\n\
           [output]\nplots = []\nchannels = [\"races\", \"forces\"]\n";
    let path = write(root.path(), "scene.toml", &scene);
    let out = root.path().join("run");
    done(&["run", &path, "--out", &text(&out)]);
    let table = std::fs::read_to_string(out.join("series.csv")).unwrap();
    let mut lines = table.lines();
    let names: Vec<&str> =
        lines.next().unwrap().split(',').map(|name| name.split(' ').next().unwrap()).collect();
    let rows: Vec<Vec<f64>> =
        lines.map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let column = |name: &str| {
        let at =
            names.iter().position(|of| *of == name).unwrap_or_else(|| panic!("{name}: {names:?}"));
        rows.iter().map(|row| row[at]).collect::<Vec<f64>>()
    };
    let impulse = |values: &[f64]| -> f64 {
        values.windows(2).map(|pair| 0.5e-6 * (pair[0] + pair[1])).sum()
    };
    for (race, mass, own) in [("inner", 0.1, [3.0, 0.0, -5.0]), ("outer", 0.2, [0.0, 2.0, 0.0])] {
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let velocity = column(&format!("{race}_velocity_{axis}"));
            let contact = column(&format!("contact_force_on_{race}_{axis}"));
            let mut all = impulse(&contact) + 2e-3 * (own[i] + mass * GRAVITY[i]);
            let mut size = impulse(&contact.iter().map(|f| f.abs()).collect::<Vec<_>>());
            if race == "outer" {
                let spring = column(&format!("mount_force_{axis}"));
                all += impulse(&spring);
                size += impulse(&spring.iter().map(|f| f.abs()).collect::<Vec<_>>());
            }
            let momentum = mass * (velocity[velocity.len() - 1] - velocity[0]);
            // The trapezoidal rule over rows of 1 us, for contacts of some 2 kHz and rounding of nine digits.
            assert!(
                (momentum - all).abs() <= 1e-3 * size + 1e-9,
                "{race} {axis}: {momentum} {all}"
            );
        }
    }
}
