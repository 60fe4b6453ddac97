//! The few numbers of a run that `bearing run` ends with.

use bearing_dynamics::output::dynamics::session::Session;
use bearing_dynamics::output::dynamics::table::RunTable;
use bearing_dynamics::solver::clock::told;
use std::fmt::Write;

/// Where the inner race was, the largest load of a ball, what is missing of the energy, and the
/// effort. A mean is one over the rows of the window, an extreme one over all steps.
pub fn key_figures(session: &Session, table: &RunTable, seconds: f64) -> String {
    let mut text = String::new();
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "{label:<22} {value}");
    };
    let names = ["inner_x", "inner_y", "inner_z"];
    if let [Some(x), Some(y), Some(z)] = names.map(|name| table.windowed(name))
        && !x.is_empty()
    {
        let mean = [x, y, z].map(|values| 1e6 * values.iter().sum::<f64>() / values.len() as f64);
        let [x, y, z] = mean.map(|value| format!("{value:.6}"));
        line("inner race, mean", format!("{x}, {y}, {z} um (x, y, z over the window)"));
    }
    let simulation = &session.simulation;
    for (extremes, bearing) in simulation.extremes.iter().zip(&simulation.system.assembly.bearings)
    {
        let of = bearing.name.as_ref().map_or(String::new(), |name| format!("{name} "));
        let farthest = &extremes.farthest;
        let at = told(farthest.time);
        let place = format!("{:.6} um at t = {at} s", 1e6 * farthest.value);
        line(&format!("{of}inner race, farthest"), place);
        let [inner, outer] = extremes.races.map(|race| race.load);
        let (load, race) =
            if outer.value > inner.value { (outer, "outer") } else { (inner, "inner") };
        if load.value > 0.0 {
            let (ball, at) = (load.ball + 1, told(load.time));
            let value = format!("{:.6} N, ball {ball}, {race} race, at t = {at} s", load.value);
            line(&format!("{of}largest ball load"), value);
        }
        let between = &extremes.between_balls;
        if between.value > 0.0 {
            let balls = bearing.geometry.ball_count;
            let (one, other) = (between.ball + 1, (between.ball + 1) % balls + 1);
            let at = told(between.time);
            let value = format!("{:.6} N, balls {one} and {other}, at t = {at} s", between.value);
            line(&format!("{of}largest between balls"), value);
        }
    }
    if let Some((_, most)) =
        table.all("energy_residual").and_then(|values| largest(values.into_iter().map(f64::abs)))
    {
        line("energy unaccounted for", format!("{most:.3e} J at most"));
    }
    if let Some(shortened) = simulation.step_watch.shortened {
        line(
            "step",
            format!(
                "shortened {} times where contacts got stiffer, from {:.4e} s to {:.4e} s, last at \
                 t = {} s",
                shortened.times,
                shortened.from,
                simulation.step_size,
                told(shortened.last)
            ),
        );
    }
    line("steps", format!("{} in {seconds:.2} s", simulation.steps));
    text
}

/// The first largest value and its row.
fn largest(values: impl IntoIterator<Item = f64>) -> Option<(usize, f64)> {
    values.into_iter().enumerate().fold(None, |found: Option<(usize, f64)>, (row, value)| {
        if found.is_none_or(|(_, most)| value > most) { Some((row, value)) } else { found }
    })
}
