//! Campbell diagram: whirl frequencies of a rotor over its speed.

use super::xy::{Axis, Style, XyPlot, xy};
use super::{Curve, PlotError};
use crate::vibrations::whirl::Campbell;
use std::f64::consts::TAU;

/// Campbell diagram in Hz over rpm, with the critical speeds (rad/s). The legend gives the whirl direction at the last speed.
///
/// # Errors
/// As [`xy`].
pub fn campbell(title: &str, of: &Campbell, critical: &[f64]) -> Result<String, PlotError> {
    let rpm = |speed: f64| speed * 60.0 / TAU;
    let mut highest = 0.0f64;
    let mut curves: Vec<Curve> = Vec::new();
    for (number, line) in of.lines.iter().enumerate() {
        // The line ends at the lowest speed at which it oscillates.
        let points = of.speeds[of.speeds.len() - line.len()..].iter().zip(line);
        let points: Vec<[f64; 2]> =
            points.map(|(&speed, whirl)| [rpm(speed), whirl.frequency() / TAU]).collect();
        highest = points.iter().fold(highest, |most, point| most.max(point[1]));
        let turns = line.last().map_or("", |whirl| whirl.turns());
        curves.push(Curve::new(format!("{} {turns}", number + 1), points));
    }
    let last = of.speeds.last().copied().unwrap_or(0.0);
    let end = last.abs().min(highest * TAU);
    let turn = [rpm(end.copysign(last)), end / TAU];
    curves.push(Curve::new("1X", vec![[0.0, 0.0], turn]));
    let meet = critical.iter().filter(|speed| speed.abs() <= end);
    let meet: Vec<[f64; 2]> =
        meet.map(|speed| [rpm(speed.copysign(last)), speed.abs() / TAU]).collect();
    if !meet.is_empty() {
        curves.push(Curve::separate("critical speeds", meet));
    }
    xy(&XyPlot {
        title: format!("{title}: whirl, directions at {:.0} rpm", rpm(last)),
        x: Axis::linear("speed", "rpm"),
        y: Axis::linear("frequency", "Hz"),
        style: Style::Lines,
        curves,
    })
}
