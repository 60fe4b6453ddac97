//! Printed tables of a static solution.

use bearing_dynamics::equilibrium::lists::{Place, StaticAssembly};
use bearing_dynamics::equilibrium::statics::{
    AssemblySolution, BallState, COORDINATE_NAMES, ContactState, StaticSolution,
};
use bearing_dynamics::output::results::load_zone_of;
use bearing_dynamics::output::warnings::{Warning, lines};
use nalgebra::SMatrix;
use std::fmt::Write;

/// Position, reactions, stiffness, balls, `life`, lines on the `housing`, and warnings.
pub fn render(
    solution: &StaticSolution,
    life: &str,
    housing: &str,
    warnings: &[Warning],
) -> String {
    let mut text = String::new();
    race(&mut text, solution);
    text += if housing.is_empty() { "" } else { "\nbearing, from race to race" };
    stiffness(&mut text, |i, j| solution.stiffness[(i, j)]);
    ball_lines(&mut text, &solution.balls);
    let (loaded, extent) = load_zone_of(&solution.balls);
    let _ = writeln!(
        text,
        "\n{loaded} of {} balls loaded, load zone {} deg",
        solution.balls.len(),
        fixed(extent.to_degrees(), 3)
    );
    text += life;
    let _ = writeln!(
        text,
        "{} iterations, {} ball-race evaluations, unbalanced load {:.1e} N",
        solution.iterations, solution.contact_evaluations, solution.residual
    );
    text += housing;
    text + &lines(warnings)
}

/// Stiffness of a shaft against the ground, through its bearing and the housing.
pub fn ground_stiffness(matrix: &SMatrix<f64, 5, 5>) -> String {
    let mut text = "\nshaft against the ground, through bearing and housing".to_string();
    stiffness(&mut text, |i, j| matrix[(i, j)]);
    text
}

/// [`render`] for several bodies and bearings; each bearing has its name and the line of its life, `housings` are the lines on
/// housings.
pub fn render_assembly(
    assembly: &StaticAssembly,
    bearings: &[(&str, String)],
    solution: &AssemblySolution,
    housings: &str,
    warnings: &[Warning],
) -> String {
    let mut text = String::new();
    let all = solution.bearings.iter().flat_map(|bearing| &bearing.balls);
    let largest = all.map(|ball| ball.inner.normal_load).fold(0.0, f64::max);
    let loaded = assembly.bodies.iter().enumerate();
    let loaded: Vec<usize> = loaded
        .filter(|(_, b)| matches!(b.place, Place::Loaded(_)))
        .map(|(index, _)| index)
        .collect();
    for (place, &index) in loaded.iter().enumerate() {
        let (q, loads) = (&solution.coordinates[index], &solution.loads[index]);
        let name = &assembly.bodies[index].name;
        coordinates(&mut text, name, q.as_slice(), loads.as_slice(), largest);
        stiffness(&mut text, |i, j| solution.stiffness[(5 * place + i, 5 * place + j)]);
        text.push('\n');
    }
    sections(&mut text, assembly, solution);
    if loaded.len() > 1 {
        text += "stiffness is that of each body with all others fixed; summary.json has the coupling terms\n\n";
    }
    for ((name, life), bearing) in bearings.iter().zip(&solution.bearings) {
        let [force, _] = &bearing.forces;
        let _ = write!(
            text,
            "bearing {name}: force of the balls on the inner race {}, {}, {} N",
            fixed(force.x, 6),
            fixed(force.y, 6),
            fixed(force.z, 6)
        );
        ball_lines(&mut text, &bearing.balls);
        let (loaded, extent) = load_zone_of(&bearing.balls);
        let _ = writeln!(
            text,
            "{loaded} of {} balls loaded, load zone {} deg\n{life}",
            bearing.balls.len(),
            fixed(extent.to_degrees(), 3)
        );
    }
    text += housings;
    let _ = writeln!(
        text,
        "{} iterations, {} ball-race evaluations, unbalanced load {:.1e} N",
        solution.iterations, solution.contact_evaluations, solution.residual
    );
    text + &lines(warnings)
}

fn sections(text: &mut String, assembly: &StaticAssembly, solution: &AssemblySolution) {
    let bodies = assembly.bodies.iter().zip(&solution.coordinates);
    let all: Vec<_> = bodies.filter(|(body, _)| matches!(body.place, Place::Section(_))).collect();
    if all.is_empty() {
        return;
    }
    let head = ["x, um", "y, um", "z, um", "tilt_y, deg", "tilt_z, deg"];
    let _ = write!(text, "{:<34}", "section");
    head.iter().for_each(|name| text.push_str(&format!("{name:>16}")));
    text.push('\n');
    for (body, q) in all {
        let _ = write!(text, "{:<34}", body.name);
        for i in 0..5 {
            let value = if i < 3 { 1e6 * q[i] } else { q[i].to_degrees() };
            let _ = write!(text, "{:>16}", fixed(value, 6));
        }
        text.push('\n');
    }
    text.push('\n');
}

fn race(text: &mut String, solution: &StaticSolution) {
    let largest = solution.balls.iter().map(|b| b.inner.normal_load).fold(0.0, f64::max);
    let (q, loads) = (&solution.coordinates, &solution.loads);
    coordinates(text, "inner race", q.as_slice(), loads.as_slice(), largest);
}

/// Five coordinates of a body and the loads on it; `largest` is the largest ball load, N.
fn coordinates(text: &mut String, body: &str, q: &[f64], loads: &[f64], largest: f64) {
    let _ = writeln!(text, "{body:<15} displacement, tilt      load, moment");
    for (i, name) in COORDINATE_NAMES.iter().enumerate() {
        let (value, unit, load_unit) =
            if i < 3 { (1e6 * q[i], "um ", "N") } else { (q[i].to_degrees(), "deg", "N m") };
        let load = without_noise(loads[i], largest, i);
        let (value, load) = (fixed(value, 6), fixed(load, 6));
        let _ = writeln!(text, "  {name:<10} {value:>16} {unit} {load:>18} {load_unit}");
    }
}

/// Stiffness in N and N mm per um and mrad. The matrix is symmetric in these units, because
/// 1 N um = 1 N mm mrad, and its numbers are of similar size.
fn stiffness(text: &mut String, of: impl Fn(usize, usize) -> f64) {
    let _ = write!(text, "\nstiffness  ");
    for (i, name) in COORDINATE_NAMES.iter().enumerate() {
        let _ = write!(text, "{:>14}", format!("{name}, {}", if i < 3 { "um" } else { "mrad" }));
    }
    let _ = writeln!(text);
    let size = |i: usize| if i < 3 { 1e-6 } else { 1e-3 };
    for (i, name) in COORDINATE_NAMES.iter().enumerate() {
        let _ = write!(text, "  {:<9}", format!("{name}, {}", if i < 3 { "N" } else { "N mm" }));
        for j in 0..5 {
            // One joule is 1e6 N um.
            let value = of(i, j) * size(i) * size(j) * 1e6;
            let _ = write!(text, "{:>14}", fixed(value, 4));
        }
        let _ = writeln!(text);
    }
}

fn ball_lines(text: &mut String, balls: &[BallState]) {
    let _ = writeln!(
        text,
        "\nball  azimuth      inner load      outer load  inner angle  outer angle  inner pressure  \
         outer pressure\n          deg               N               N          deg          deg    \
         \x20        MPa             MPa"
    );
    let angle = |contact: &ContactState| {
        if contact.normal_load > 0.0 {
            fixed(contact.contact_angle.to_degrees(), 4)
        } else {
            "open".into()
        }
    };
    for (index, ball) in balls.iter().enumerate() {
        let degrees = ball.azimuth.to_degrees().rem_euclid(360.0);
        let _ = writeln!(
            text,
            "{:>4} {degrees:>8.3} {:>15.6} {:>15.6} {:>12} {:>12} {:>15.2} {:>15.2}",
            index + 1,
            ball.inner.normal_load,
            ball.outer.normal_load,
            angle(&ball.inner),
            angle(&ball.outer),
            1e-6 * ball.inner.peak_pressure,
            1e-6 * ball.outer.peak_pressure,
        );
    }
}

/// `value` with `digits` decimals; zero has no sign.
fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_string(),
        _ => text,
    }
}

/// The load, or zero if it is rounding error relative to the `largest` ball load.
fn without_noise(load: f64, largest: f64, index: usize) -> f64 {
    let lever = if index < 3 { 1.0 } else { 1.0e-1 };
    if load.abs() <= 1e-9 * largest * lever { 0.0 } else { load }
}
