//! Curves over two axes.

use crate::output::plots::canvas::{self, Align, Area, BLACK_TEXT, GRID, Legend, Point};
use crate::output::plots::ticks::{self, Scale};
use crate::output::plots::{Curve, PlotError, check_curves};

/// Axis, drawn as `label [unit]`; `unit` is `1` for a dimensionless quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub label: String,
    pub unit: String,
    pub log: bool,
}

impl Axis {
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Axis { label: label.into(), unit: unit.into(), log: false }
    }

    pub fn log(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Axis { label: label.into(), unit: unit.into(), log: true }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Lines,
    /// Curves of many points have markers at some of them.
    LinesAndMarkers,
    /// Markers at all points, without lines.
    Markers,
}

impl Style {
    fn of(self, curve: &Curve) -> Style {
        if curve.separate { Style::Markers } else { self }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct XyPlot {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub style: Style,
    pub curves: Vec<Curve>,
}

/// Labelled vertical line at a value of x.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub at: f64,
    pub label: String,
}

const LEFT: i32 = 115;
const RIGHT: i32 = 870;
const TOP: i32 = 60;
const BOTTOM: i32 = 500;

/// Draws the curves, with the legend below the axes.
///
/// # Errors
/// No curve, a curve without points, a value that is not finite, or not positive on a logarithmic
/// axis.
///
/// ```
/// use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
/// let svg = xy(&XyPlot {
///     title: "Moment over tilt".into(),
///     x: Axis::linear("tilt", "deg"),
///     y: Axis::linear("moment", "N m"),
///     style: Style::LinesAndMarkers,
///     curves: vec![Curve::new("computed", vec![[0.0, 0.0], [0.1, 3.2]])],
/// });
/// assert!(svg.unwrap().contains("moment [N m]"));
/// ```
pub fn xy(plot: &XyPlot) -> Result<String, PlotError> {
    xy_marked(plot, &[])
}

/// Size of the labels of marks, px, and the smallest distance between two of them.
const MARK_SIZE: i32 = 15;
const MARK_GAP: i32 = 17;

/// As [`xy()`], with thin vertical lines behind the curves. Marks beyond the axis are omitted. A label that would cover
/// that of an earlier mark is omitted, its line is not.
///
/// # Errors
/// As [`xy()`].
pub fn xy_marked(plot: &XyPlot, marks: &[Mark]) -> Result<String, PlotError> {
    check_curves(&plot.title, &plot.curves)?;
    let x = scale(&plot.x, &plot.curves, 0, 7)?;
    let y = scale(&plot.y, &plot.curves, 1, 6)?;
    let legend = Legend::new(&plot.curves);
    let legend_top = BOTTOM + 75;
    canvas::draw((legend_top + legend.height()) as u32, |area| {
        let middle = (LEFT + RIGHT) / 2;
        canvas::title(area, &plot.title)?;
        let size = canvas::TEXT_SIZE;
        for (position, label) in &x.ticks {
            let column = across(*position);
            canvas::line(area, vec![(column, TOP), (column, BOTTOM)], GRID, 1)?;
            canvas::text(area, label, (column, BOTTOM + 18), size, Align::Centre, BLACK_TEXT)?;
        }
        for (position, label) in &y.ticks {
            let row = up(*position);
            canvas::line(area, vec![(LEFT, row), (RIGHT, row)], GRID, 1)?;
            canvas::text(area, label, (LEFT - 10, row), size, Align::Right, BLACK_TEXT)?;
        }
        mark(area, &x, marks)?;
        let corners = vec![(LEFT, TOP), (LEFT, BOTTOM), (RIGHT, BOTTOM)];
        canvas::line(area, corners, BLACK_TEXT, 2)?;
        let at = (middle, BOTTOM + 50);
        canvas::text(area, &axis_title(&plot.x), at, size, Align::Centre, BLACK_TEXT)?;
        let at = (22, (TOP + BOTTOM) / 2);
        canvas::text(area, &axis_title(&plot.y), at, size, Align::Upwards, BLACK_TEXT)?;

        for (index, curve) in plot.curves.iter().enumerate() {
            let points: Vec<Point> = curve
                .points
                .iter()
                .map(|&[a, b]| (across(x.position(a)), up(y.position(b))))
                .collect();
            let style = plot.style.of(curve);
            if style != Style::Markers {
                let colour = canvas::colour(index);
                canvas::line(area, points.clone(), colour, 3)?;
            }
            match style {
                Style::Lines => {}
                Style::LinesAndMarkers => canvas::markers(area, index, &points)?,
                Style::Markers => {
                    points.iter().try_for_each(|&point| canvas::marker(area, index, point))?;
                }
            }
        }
        legend.draw(area, &plot.curves, legend_top, |curve| {
            let style = plot.style.of(curve);
            (style != Style::Markers, style != Style::Lines)
        })
    })
}

fn mark(area: &Area, x: &Scale, marks: &[Mark]) -> Result<(), PlotError> {
    let mut labelled: Vec<i32> = Vec::new();
    for mark in marks {
        let position = x.position(mark.at);
        if !(0.0..=1.0).contains(&position) {
            continue;
        }
        let column = across(position);
        canvas::line(area, vec![(column, TOP), (column, BOTTOM)], canvas::MARK, 1)?;
        if labelled.iter().all(|other| (other - column).abs() >= MARK_GAP) {
            labelled.push(column);
            // Centred on the column, so that the line passes through the middle of the label: beside it instead.
            let length = 8 * mark.label.chars().count() as i32;
            let at = (column - MARK_SIZE / 2, TOP + 4 + length / 2);
            canvas::text(area, &mark.label, at, MARK_SIZE, Align::Upwards, canvas::MARK_TEXT)?;
        }
    }
    Ok(())
}

fn scale(
    axis: &Axis,
    curves: &[Curve],
    component: usize,
    wanted: usize,
) -> Result<Scale, PlotError> {
    let values = || curves.iter().flat_map(|c| c.points.iter().map(move |p| p[component]));
    if !axis.log {
        return Ok(ticks::linear(values(), wanted));
    }
    for curve in curves {
        for (point, value) in curve.points.iter().map(|p| p[component]).enumerate() {
            if value <= 0.0 {
                return Err(PlotError::NotPositive { curve: curve.name.clone(), point, value });
            }
        }
    }
    Ok(ticks::logarithmic(values()))
}

fn across(position: f64) -> i32 {
    LEFT + (position * f64::from(RIGHT - LEFT)).round() as i32
}

fn up(position: f64) -> i32 {
    BOTTOM - (position * f64::from(BOTTOM - TOP)).round() as i32
}

fn axis_title(axis: &Axis) -> String {
    format!("{} [{}]", axis.label, axis.unit)
}
