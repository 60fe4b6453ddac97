//! Orbit plot: paths seen along the axis, +Y to the right, +Z up, both to the same scale.

use crate::output::plots::canvas::{self, Align, BLACK_TEXT, GRID, Legend, Point};
use crate::output::plots::{Curve, PlotError, check_curves, ticks};

#[derive(Clone, Debug, PartialEq)]
pub struct OrbitPlot {
    pub title: String,
    /// Unit of both axes, drawn as `Y [unit]` and `Z [unit]`.
    pub unit: String,
    /// Points `[y, z]`; the last point has a marker.
    pub curves: Vec<Curve>,
}

const LEFT: i32 = 170;
const TOP: i32 = 60;
/// Side of the square, px.
const SIDE: i32 = 600;

/// Draws the paths, with the legend below.
///
/// # Errors
/// No curve, a curve without points, a value that is not finite.
pub fn orbit(plot: &OrbitPlot) -> Result<String, PlotError> {
    check_curves(&plot.title, &plot.curves)?;
    let extent = |component: usize| {
        let values = plot.curves.iter().flat_map(|c| c.points.iter().map(move |p| p[component]));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    };
    let extents = [extent(0), extent(1)];
    let half = extents.iter().map(|[low, high]| 0.5 * (high - low)).fold(0.0, f64::max);
    let scales = extents.map(|[low, high]| {
        let middle = 0.5 * (low + high);
        ticks::linear([middle - half, middle + half].into_iter(), 6)
    });
    // The ends of an axis are on tick marks, so that its length differs slightly from the requested one.
    let length = scales.iter().map(|scale| scale.high - scale.low).fold(0.0, f64::max);
    let px = |scale: &ticks::Scale, position: f64| {
        let part = (scale.high - scale.low) / length;
        ((0.5 + (position - 0.5) * part) * f64::from(SIDE)).round() as i32
    };
    let across = |position: f64| LEFT + px(&scales[0], position);
    let up = |position: f64| TOP + SIDE - px(&scales[1], position);
    let bottom = TOP + SIDE;
    let legend = Legend::new(&plot.curves);
    let legend_top = bottom + 75;
    canvas::draw((legend_top + legend.height()) as u32, |area| {
        let size = canvas::TEXT_SIZE;
        canvas::title(area, &plot.title)?;
        for (position, label) in &scales[0].ticks {
            let column = across(*position);
            canvas::line(area, vec![(column, TOP), (column, bottom)], GRID, 1)?;
            canvas::text(area, label, (column, bottom + 18), size, Align::Centre, BLACK_TEXT)?;
        }
        for (position, label) in &scales[1].ticks {
            let row = up(*position);
            canvas::line(area, vec![(LEFT, row), (LEFT + SIDE, row)], GRID, 1)?;
            canvas::text(area, label, (LEFT - 10, row), size, Align::Right, BLACK_TEXT)?;
        }
        let corners = vec![(LEFT, TOP), (LEFT, bottom), (LEFT + SIDE, bottom)];
        canvas::line(area, corners, BLACK_TEXT, 2)?;
        let at = (LEFT + SIDE / 2, bottom + 50);
        canvas::text(area, &format!("Y [{}]", plot.unit), at, size, Align::Centre, BLACK_TEXT)?;
        let at = (22, TOP + SIDE / 2);
        canvas::text(area, &format!("Z [{}]", plot.unit), at, size, Align::Upwards, BLACK_TEXT)?;
        for (index, curve) in plot.curves.iter().enumerate() {
            let points: Vec<Point> = curve
                .points
                .iter()
                .map(|&[y, z]| (across(scales[0].position(y)), up(scales[1].position(z))))
                .collect();
            let last = points.last().copied();
            canvas::line(area, points, canvas::colour(index), 2)?;
            if let Some(last) = last {
                canvas::marker(area, index, last)?;
            }
        }
        legend.draw(area, &plot.curves, legend_top, |_| (true, true))
    })
}
