//! SVG plots from plain data; every function returns the SVG text.
//!
//! - [`campbell()`]: whirl frequencies of a rotor over its speed
//! - [`load_zone()`]: balls between the races with an arrow for each load, as in Fig. 4.8
//! - [`orbit()`]: paths in the Y–Z plane, both axes to the same scale
//! - [`polar()`]: values over azimuth
//! - [`xy()`]: curves over linear or logarithmic axes
//!
//! Designed for a width of at least 700 px, with the colour-blind safe colours of Okabe and Ito and a different marker for
//! every curve.
pub mod campbell;
mod canvas;
pub mod load_zone;
pub mod orbit;
pub mod polar;
pub mod ticks;
pub mod xy;

pub use campbell::campbell;
pub use canvas::{COLOURS, colour};
pub use load_zone::{LoadZone, load_zone};
pub use orbit::{OrbitPlot, orbit};
pub use polar::{PolarPlot, polar};
pub use xy::{Axis, Mark, Style, XyPlot, xy, xy_marked};

use thiserror::Error;

#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    pub name: String,
    /// `[x, y]` in the units of the axes; for a polar plot azimuth in rad and value.
    pub points: Vec<[f64; 2]>,
    /// True if the points are never joined by lines, whatever the style of the plot.
    pub separate: bool,
}

impl Curve {
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Curve { name: name.into(), points, separate: false }
    }

    /// Separate values, such as published ones: every point has a marker, none are joined.
    pub fn separate(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Curve { separate: true, ..Curve::new(name, points) }
    }
}

#[derive(Debug, Error)]
pub enum PlotError {
    #[error("plot {title:?} has no curve")]
    NoCurve { title: String },
    #[error("curve {curve:?} has no point")]
    NoPoint { curve: String },
    #[error(
        "point {point} of curve {curve:?} is ({x:?}, {y:?}); allowed are 0 and magnitudes \
         from 1e-200 to 1e200"
    )]
    NotDrawable { curve: String, point: usize, x: f64, y: f64 },
    #[error("point {point} of curve {curve:?} is {value} on a logarithmic axis; allowed is > 0")]
    NotPositive { curve: String, point: usize, value: f64 },
    #[error("point {point} of curve {curve:?} has the value {value}; a polar plot needs >= 0")]
    Negative { curve: String, point: usize, value: f64 },
    #[error("{what} is {value}; allowed is > 0 and at most the outer raceway radius")]
    Size { what: &'static str, value: f64 },
    #[error("ball {ball} has {what} = {value}; allowed is a finite number >= 0")]
    Ball { ball: usize, what: &'static str, value: f64 },
    #[error("a load zone needs at least one ball")]
    NoBall,
    #[error("cannot draw: {reason}")]
    Draw { reason: String },
}

fn check_curves(title: &str, curves: &[Curve]) -> Result<(), PlotError> {
    if curves.is_empty() {
        return Err(PlotError::NoCurve { title: title.to_string() });
    }
    for curve in curves {
        if curve.points.is_empty() {
            return Err(PlotError::NoPoint { curve: curve.name.clone() });
        }
        for (point, &[x, y]) in curve.points.iter().enumerate() {
            let drawable = |v: f64| v == 0.0 || ticks::MAGNITUDES.contains(&v.abs());
            if !(drawable(x) && drawable(y)) {
                let curve = curve.name.clone();
                return Err(PlotError::NotDrawable { curve, point, x, y });
            }
        }
    }
    Ok(())
}
