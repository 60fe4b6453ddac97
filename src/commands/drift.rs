//! Warning about means over the window of a motion that is still settling.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::numeric::clock::to_digits;
use bearing_dynamics::output::table::RunTable;
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use std::f64::consts::TAU;

/// Turns of the inner race after which a window is there for its means.
const TURNS: f64 = 10.0;
/// Smallest change of a mean that counts, over the mean.
const CHANGE: f64 = 1e-3;

/// Warnings about inner races whose mean position changes within the window by more than their oscillation, under loads
/// and speeds that no longer change.
pub fn drifting(assembly: &Assembly, table: &RunTable) -> Vec<Warning> {
    let rows = table.window.clone();
    if rows.len() < 2 {
        return Vec::new();
    }
    let start = table.time(rows.start);
    if assembly.corners().last().is_some_and(|last| *last > start) {
        return Vec::new();
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let of = |name: &String| {
        let column = |of: &str| table.windowed(&format!("{name}inner_{of}"));
        let turns = mean(&column("speed")?).abs() * (table.time(rows.end - 1) - start) / TAU;
        let position: Option<Vec<Vec<f64>>> = ["x", "y", "z"].into_iter().map(column).collect();
        let [mut whole, mut change, mut oscillation] = [0.0; 3];
        for values in position? {
            let (first, second) = values.split_at(values.len() / 2);
            let own = mean(&values);
            whole += own * own;
            change += (mean(second) - mean(first)).powi(2);
            oscillation +=
                values.iter().map(|x| (x - own).powi(2)).sum::<f64>() / values.len() as f64;
        }
        let drifts = change > oscillation && change > CHANGE * CHANGE * whole;
        (turns >= TURNS && drifts).then(|| {
            let of_bearing = match name.strip_suffix('_') {
                Some(name) => format!("bearing {name}: "),
                None => String::new(),
            };
            let text = format!(
                "the motion is still settling: the mean position of the inner race changes by {} um, {} % of it, from the first half of the window to \
                 the second. Lengthen the run (numerics.end) and start the window later (output.window_start)",
                to_digits(1e6 * change.sqrt(), 2),
                to_digits(100.0 * (change / whole).sqrt(), 2)
            );
            Warning::new(WarningCode::StillSettling, text).named(&of_bearing)
        })
    };
    table.bearings.iter().filter_map(of).collect()
}
