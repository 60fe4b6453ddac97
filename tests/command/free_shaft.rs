//! A shaft on very soft springs: its motion from the rows that are written.

use crate::command_line_common::{done, read, text, write};
use std::f64::consts::PI;
use tempfile::tempdir;

/// kg, and m from the middle: heavy enough for the shaft's own 7 kg to count little.
const DISCS: [(f64, f64); 3] = [(3000.0, -0.7), (1000.0, -0.1), (2000.0, 0.6)];
const SHAFT: f64 = 500.0 * 0.25 * PI * 0.1 * 0.1 * 1.5;
const LOAD: [f64; 2] = [4e4, -9e4];
const DURATION: f64 = 0.02;

fn scene(speed: &str) -> String {
    let mut text = format!(
        "[body.rotor]\nx = {{ displacement = \"0 mm\" }}\nspeed = \"{speed}\"\n[body.rotor.beam]\nyoungs_modulus = \"211 GPa\"\n\
         poisson_ratio = 0.3\ndensity = \"500 kg/m^3\"\nsegments = [{{ length = \"1.5 m\", outer_diameter = \"100 mm\" }}]\n"
    );
    let [y, z] =
        LOAD.map(|load| format!("{{ half_sine = \"{load} N\", duration = \"{DURATION} s\" }}"));
    text += &format!("load = [{{ at = \"0.3 m\", y = {y}, z = {z} }}]\n");
    for (i, (mass, at)) in DISCS.iter().enumerate() {
        text += &format!(
            "[[body.rotor.beam.disc]]\nat = \"{at} m\"\nmass = \"{mass} kg\"\naxial = \"20 kg m^2\"\ntransverse = \"10 kg m^2\"\n\
             [[body.rotor.beam.probe]]\nname = \"disc{i}\"\nat = \"{at} m\"\n"
        );
    }
    // Springs that a scene needs and no number feels: 1 N/m and 6000 kg.
    for (name, at) in [("left", -0.7), ("right", 0.6)] {
        text += &format!(
            "[spring.{name}]\nfrom = \"ground\"\nto = \"rotor\"\nfrom_at = \"{at} m\"\nto_at = \"{at} m\"\nstiffness = {{ y = \"1 N/m\", z = \"1 N/m\" }}\n"
        );
    }
    text + "[numerics]\nend = \"30 ms\"\noutput_interval = \"1 ms\"\nstep = \"10 us\"\n[output]\nplots = []\n"
}

/// The centre of mass goes where the load alone takes it, however the shaft bends and spins.
#[test]
fn the_centre_of_mass_follows_the_load_alone() {
    let root = tempdir().unwrap();
    for (name, speed) in [("still", "0 rpm"), ("spinning", "6000 rpm")] {
        let path = write(root.path(), &format!("{name}.toml"), &scene(speed));
        let out = root.path().join(name);
        done(&["run", &path, "--out", &text(&out)]);
        let rows = read(&out.join("series.csv"));
        let mut rows = rows.lines().map(|row| row.split(',').collect::<Vec<_>>());
        let header = rows.next().unwrap();
        let column = |name: String| header.iter().position(|own| *own == name).unwrap();
        let total = SHAFT + DISCS.iter().map(|(mass, _)| mass).sum::<f64>();
        let (mut most_off, mut most_bent, mut farthest) = (0.0f64, 0.0f64, 0.0f64);
        for row in rows {
            let at = |column: usize| row[column].parse::<f64>().unwrap();
            let time = at(0);
            let w = PI / DURATION;
            // ∬ F of half a sine, and straight on after it.
            let path = |t: f64| t / w - (w * t).sin() / (w * w);
            let way = if time <= DURATION {
                path(time)
            } else {
                path(DURATION) + (time - DURATION) * 2.0 / w
            };
            for (axis, load) in ["y", "z"].into_iter().zip(LOAD) {
                let place: [f64; 3] =
                    [0, 1, 2].map(|i| at(column(format!("rotor_disc{i}_{axis} [m]"))));
                farthest = place.iter().fold(farthest, |most, at| most.max(at.abs()));
                let discs = DISCS.iter().zip(place).map(|((mass, _), place)| mass * place);
                most_off = most_off.max((discs.sum::<f64>() / total - load * way / total).abs());
                let [(_, a), (_, b), (_, c)] = DISCS;
                let straight = place[0] + (place[2] - place[0]) * (b - a) / (c - a);
                most_bent = most_bent.max((place[1] - straight).abs());
            }
        }
        assert!(most_bent >= 1e-3, "{name}: {most_bent}");
        // The shaft's own 6 kg of 6000 are no farther from the discs than twice what these move.
        assert!(most_off <= 2.0 * SHAFT / total * farthest, "{name}: {most_off} of {farthest} m");
    }
}
