//! Polar plot: values over azimuth, seen along the axis, +Y to the right, +Z up.

use crate::equilibrium::statics::{BallState, StaticSolution};
use crate::output::plots::canvas::{self, Align, BLACK_TEXT, GRID, Legend, Point};
use crate::output::plots::{Curve, PlotError, check_curves, ticks};
use std::f64::consts::TAU;

#[derive(Clone, Debug, PartialEq)]
pub struct PolarPlot {
    pub title: String,
    /// Quantity and unit along the radius, drawn as `quantity [unit]`.
    pub quantity: String,
    pub unit: String,
    /// Azimuth from +Y towards +Z in rad, value >= 0. Points are joined in order of azimuth; the closed
    /// curve is interrupted at gaps wider than three times the usual distance.
    pub curves: Vec<Curve>,
}

impl PolarPlot {
    /// Normal load of every ball on the inner and on the outer race.
    pub fn ball_loads(title: impl Into<String>, solution: &StaticSolution) -> Self {
        let curve = |name: &str, load: fn(&BallState) -> f64| {
            let point = |ball: &BallState| [ball.azimuth, load(ball)];
            Curve::new(name, solution.balls.iter().map(point).collect())
        };
        PolarPlot {
            title: title.into(),
            quantity: "normal load".into(),
            unit: "N".into(),
            curves: vec![
                curve("on the inner race", |ball| ball.inner.normal_load),
                curve("on the outer race", |ball| ball.outer.normal_load),
            ],
        }
    }
}

const CENTRE: Point = (450, 375);
const RADIUS: f64 = 265.0;

/// Ratio of a gap to the median distance of neighbouring azimuths above which a curve is interrupted.
const GAP: f64 = 3.0;

/// Indices of the points of each connected piece, from ascending azimuths.
fn pieces(azimuths: &[f64]) -> Vec<Vec<usize>> {
    let count = azimuths.len();
    let after = |at: usize| (azimuths[(at + 1) % count] - azimuths[at]).rem_euclid(TAU);
    let mut gaps: Vec<f64> = (0..count).map(after).collect();
    gaps.sort_by(f64::total_cmp);
    let wide = |at: &usize| after(*at) > GAP * gaps[count / 2];
    let Some(last) = (0..count).find(wide) else { return vec![(0..count).chain([0]).collect()] };
    let around: Vec<usize> = (1..=count).map(|next| (last + next) % count).collect();
    around.split_inclusive(wide).map(<[usize]>::to_vec).collect()
}

/// Draws the curves around a circle, with the legend below.
///
/// # Errors
/// No curve, a curve without points, a value that is negative or not finite.
pub fn polar(plot: &PolarPlot) -> Result<String, PlotError> {
    check_curves(&plot.title, &plot.curves)?;
    for curve in &plot.curves {
        for (point, &[_, value]) in curve.points.iter().enumerate() {
            if value < 0.0 {
                return Err(PlotError::Negative { curve: curve.name.clone(), point, value });
            }
        }
    }
    let values = plot.curves.iter().flat_map(|curve| curve.points.iter().map(|point| point[1]));
    let largest = values.fold(0.0, f64::max);
    let range = if largest > 0.0 { [0.0, largest] } else { [0.0, 1.0] };
    let scale = ticks::linear(range.into_iter(), 5);

    let legend = Legend::new(&plot.curves);
    let legend_top = CENTRE.1 + RADIUS as i32 + 90;
    canvas::draw((legend_top + legend.height()) as u32, |area| {
        let size = canvas::TEXT_SIZE;
        canvas::title(area, &plot.title)?;
        for (position, _) in &scale.ticks {
            let ring = (0..=180).map(|i| place(f64::from(i) / 180.0 * TAU, *position)).collect();
            canvas::line(area, ring, if *position < 1.0 { GRID } else { BLACK_TEXT }, 1)?;
        }
        for degrees in (0..360).step_by(30) {
            let azimuth = f64::from(degrees).to_radians();
            canvas::line(area, vec![CENTRE, place(azimuth, 1.0)], GRID, 1)?;
            let label = match degrees {
                0 => "0° (+Y)".to_string(),
                90 => "90° (+Z)".to_string(),
                _ => format!("{degrees}°"),
            };
            let (x, y) = place(azimuth, 1.0);
            let (dx, dy) = place(azimuth, 26.0 / RADIUS);
            let align = match dx - CENTRE.0 {
                12.. => Align::Left,
                ..=-12 => Align::Right,
                _ => Align::Centre,
            };
            // Text at the sides of the circle needs less distance than text above or below.
            let x = x + (dx - CENTRE.0) * 2 / 5;
            canvas::text(area, &label, (x, y + dy - CENTRE.1), size, align, BLACK_TEXT)?;
        }
        for (index, curve) in plot.curves.iter().enumerate() {
            let mut sorted = curve.points.clone();
            for point in &mut sorted {
                point[0] = point[0].rem_euclid(TAU);
            }
            sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let points: Vec<Point> = sorted
                .iter()
                .map(|&[azimuth, value]| place(azimuth, scale.position(value)))
                .collect();
            if curve.separate {
                points.iter().try_for_each(|&point| canvas::marker(area, index, point))?;
                continue;
            }
            for piece in pieces(&sorted.iter().map(|point| point[0]).collect::<Vec<_>>()) {
                let piece: Vec<Point> = piece.into_iter().map(|at| points[at]).collect();
                match piece[..] {
                    [alone] => canvas::marker(area, index, alone)?,
                    _ => canvas::line(area, piece, canvas::colour(index), 3)?,
                }
            }
            // On a dense curve markers could be mistaken for balls.
            if points.len() <= 40 {
                canvas::markers(area, index, &points)?;
            }
        }
        // Ring labels are drawn over the curves, between two spokes, to stay readable.
        for (position, label) in scale.ticks.iter().skip(1) {
            let at = place(15f64.to_radians(), *position - 24.0 / RADIUS);
            canvas::text(area, label, at, size, Align::Centre, BLACK_TEXT)?;
        }
        let caption = format!("radius: {} [{}]; angle: azimuth [deg]", plot.quantity, plot.unit);
        let at = (canvas::WIDTH as i32 / 2, legend_top - 18);
        canvas::text(area, &caption, at, size, Align::Centre, BLACK_TEXT)?;
        legend.draw(area, &plot.curves, legend_top, |curve| (!curve.separate, true))
    })
}

fn place(azimuth: f64, fraction: f64) -> Point {
    let radius = fraction * RADIUS;
    let x = f64::from(CENTRE.0) + radius * azimuth.cos();
    let y = f64::from(CENTRE.1) - radius * azimuth.sin();
    (x.round() as i32, y.round() as i32)
}
