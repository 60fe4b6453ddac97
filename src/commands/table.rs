//! A static solution as a person reads it on a terminal.

use bearing_dynamics::solver::statics::{Determinacy, StaticSolution};
use std::fmt::Write;

/// Position, reactions, balls and what to beware of.
pub fn render(solution: &StaticSolution) -> String {
    let mut text = String::new();
    let q = &solution.coordinates;
    let loads = &solution.loads;
    let _ = writeln!(text, "inner race      displacement, tilt      load, moment");
    for (i, name) in ["x", "y", "z", "tilt_y", "tilt_z"].into_iter().enumerate() {
        let (value, unit, load_unit) =
            if i < 3 { (1e6 * q[i], "um ", "N") } else { (q[i].to_degrees(), "deg", "N m") };
        let load = without_noise(loads[i], solution, i);
        let _ = writeln!(text, "  {name:<10} {value:>16.6} {unit} {load:>18.6} {load_unit}");
    }
    let _ = writeln!(
        text,
        "\nball  azimuth      inner load      outer load  inner angle  outer angle  inner pressure  \
         outer pressure\n         deg               N               N          deg          deg    \
                  MPa             MPa"
    );
    for (index, ball) in solution.balls.iter().enumerate() {
        let degrees = ball.azimuth.to_degrees().rem_euclid(360.0);
        let angle = |contact: &bearing_dynamics::solver::statics::ContactState| {
            if contact.normal_load > 0.0 {
                format!("{:.4}", contact.contact_angle.to_degrees())
            } else {
                "open".into()
            }
        };
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
    let _ = writeln!(
        text,
        "\n{} iterations, {} ball-race evaluations, unbalanced load {:.1e} N",
        solution.iterations, solution.contact_evaluations, solution.residual
    );
    for remark in remarks(solution) {
        let _ = writeln!(text, "note: {remark}");
    }
    text
}

/// A load that only rounding keeps from zero is shown as zero.
fn without_noise(load: f64, solution: &StaticSolution, index: usize) -> f64 {
    let largest = solution.balls.iter().map(|b| b.inner.normal_load).fold(0.0, f64::max);
    let lever = if index < 3 { 1.0 } else { 1.0e-1 };
    if load.abs() <= 1e-9 * largest * lever { 0.0 } else { load }
}

/// What a reader of the numbers should know.
pub fn remarks(solution: &StaticSolution) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Determinacy::Indeterminate { free_directions } = &solution.determinacy {
        remarks.push(format!(
            "indeterminate: {} of the race's directions meet no stiffness, the position shown is one \
             of many; load the bearing, preload it, or hold these coordinates",
            free_directions.len()
        ));
    }
    if solution.saddles_left > 0 {
        remarks.push(
            "the symmetric position is unstable and was left; its mirror image is an equilibrium too"
                .into(),
        );
    }
    remarks
}
