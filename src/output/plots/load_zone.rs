//! Load zone: loads of the balls around the bearing, as in Fig. 4.8.

use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::equilibrium::statics::BallState;
use crate::output::plots::PlotError;
use crate::output::plots::canvas::{self, Align, Area, BLACK_TEXT, Point};
use crate::output::plots::ticks::nice_step;
use plotters::style::RGBColor;

/// Cross-section of the bearing in its Y–Z plane. Balls are drawn at their azimuth on the pitch circle, because
/// displacements are too small to be visible.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadZone {
    pub title: String,
    /// Radii of groove bottoms, pitch circle and ball, m.
    pub inner_raceway_radius: f64,
    pub outer_raceway_radius: f64,
    pub pitch_radius: f64,
    pub ball_radius: f64,
    pub balls: Vec<LoadZoneBall>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadZoneBall {
    /// Azimuth from +Y towards +Z, rad.
    pub azimuth: f64,
    /// True if the ball is in contact with the inner race.
    pub loaded: bool,
    /// Normal load on the outer race, N, drawn as an arrow.
    pub outer_load: f64,
}

impl LoadZone {
    pub fn new(title: impl Into<String>, geometry: &BearingGeometry, balls: &[BallState]) -> Self {
        let ball = |ball: &BallState| LoadZoneBall {
            azimuth: ball.azimuth,
            loaded: ball.inner.normal_load > 0.0,
            outer_load: ball.outer.normal_load,
        };
        LoadZone {
            title: title.into(),
            inner_raceway_radius: geometry.inner.centre_radius - geometry.inner.groove_radius,
            outer_raceway_radius: geometry.outer.centre_radius + geometry.outer.groove_radius,
            pitch_radius: geometry.pitch_radius,
            ball_radius: geometry.ball_radius,
            balls: balls.iter().map(ball).collect(),
        }
    }
}

const CENTRE: Point = (450, 400);
const HEIGHT: u32 = 850;
/// Radius of the outer race's outer edge, and length of the longest arrow beyond the outer raceway, px.
const EDGE: f64 = 215.0;
const LONGEST: f64 = 125.0;

const LOADED: RGBColor = RGBColor(213, 60, 40);
const OPEN: RGBColor = RGBColor(205, 205, 205);
const RACE: RGBColor = RGBColor(226, 233, 240);
const EDGE_COLOUR: RGBColor = RGBColor(90, 100, 110);
const ARROW: RGBColor = RGBColor(0, 90, 160);

/// Draws the cross-section, an arrow for the load of each ball on the outer race, and their scale.
///
/// # Errors
/// No ball, a radius that is not positive, an azimuth that is not finite, a load that is negative
/// or not finite.
pub fn load_zone(zone: &LoadZone) -> Result<String, PlotError> {
    check(zone)?;
    let px_per_metre = 0.88 * EDGE / zone.outer_raceway_radius;
    let px = |length: f64| (length * px_per_metre).round() as i32;
    let largest = zone.balls.iter().map(|ball| ball.outer_load).fold(0.0, f64::max);

    canvas::draw(HEIGHT, |area| {
        canvas::title(area, &zone.title)?;
        let white = RGBColor(255, 255, 255);
        let rings = [
            (EDGE.round() as i32, RACE),
            (px(zone.outer_raceway_radius), white),
            (px(zone.inner_raceway_radius), RACE),
            (px(0.72 * zone.inner_raceway_radius), white),
        ];
        for (radius, fill) in rings {
            canvas::disc(area, CENTRE, radius, fill, EDGE_COLOUR)?;
        }
        for (index, ball) in zone.balls.iter().enumerate() {
            let at = place(ball.azimuth, zone.pitch_radius * px_per_metre);
            let radius = px(zone.ball_radius).max(2);
            canvas::disc(area, at, radius, if ball.loaded { LOADED } else { OPEN }, EDGE_COLOUR)?;
            if radius >= 13 {
                let colour = if ball.loaded { white } else { BLACK_TEXT };
                let number = (index + 1).to_string();
                canvas::text(area, &number, at, canvas::TEXT_SIZE, Align::Centre, colour)?;
            }
        }
        if largest > 0.0 {
            arrows(area, zone, largest, zone.outer_raceway_radius * px_per_metre)?;
        }
        axes(area)?;
        key(area, largest)
    })
}

fn check(zone: &LoadZone) -> Result<(), PlotError> {
    let sizes = [
        ("inner raceway radius", zone.inner_raceway_radius),
        ("outer raceway radius", zone.outer_raceway_radius),
        ("pitch radius", zone.pitch_radius),
        ("ball radius", zone.ball_radius),
    ];
    for (what, value) in sizes {
        if !(value.is_finite() && value > 0.0 && value <= zone.outer_raceway_radius) {
            return Err(PlotError::Size { what, value });
        }
    }
    if zone.balls.is_empty() {
        return Err(PlotError::NoBall);
    }
    for (index, ball) in zone.balls.iter().enumerate() {
        let ball_number = index + 1;
        if !ball.azimuth.is_finite() {
            let value = ball.azimuth;
            return Err(PlotError::Ball {
                ball: ball_number,
                what: "azimuth (of any sign)",
                value,
            });
        }
        if !(ball.outer_load.is_finite() && ball.outer_load >= 0.0) {
            let value = ball.outer_load;
            return Err(PlotError::Ball { ball: ball_number, what: "load", value });
        }
    }
    Ok(())
}

/// Load arrows, which start at the outer raceway, with the values at their tips.
fn arrows(area: &Area, zone: &LoadZone, largest: f64, raceway: f64) -> Result<(), PlotError> {
    for ball in zone.balls.iter().filter(|ball| ball.outer_load > 0.0) {
        let tip = raceway + LONGEST * ball.outer_load / largest;
        canvas::arrow(area, place(ball.azimuth, raceway), place(ball.azimuth, tip), ARROW)?;
        // More labels would overlap; the results table has all values.
        if zone.balls.len() <= 24 {
            let at = place(ball.azimuth, tip.max(EDGE) + 20.0);
            let align = match at.0 - CENTRE.0 {
                60.. => Align::Left,
                ..=-60 => Align::Right,
                _ => Align::Centre,
            };
            let label = short(ball.outer_load);
            canvas::text(area, &label, at, canvas::TEXT_SIZE, align, BLACK_TEXT)?;
        }
    }
    Ok(())
}

fn axes(area: &Area) -> Result<(), PlotError> {
    let (x, y) = CENTRE;
    let length = 62;
    let size = canvas::TEXT_SIZE;
    canvas::arrow(area, CENTRE, (x + length, y), BLACK_TEXT)?;
    canvas::arrow(area, CENTRE, (x, y - length), BLACK_TEXT)?;
    canvas::text(area, "Y", (x + length + 12, y), size, Align::Centre, BLACK_TEXT)?;
    canvas::text(area, "Z", (x + 14, y - length), size, Align::Centre, BLACK_TEXT)
}

fn key(area: &Area, largest: f64) -> Result<(), PlotError> {
    let size = canvas::TEXT_SIZE;
    let entries = [(60, LOADED, "in contact with the inner race"), (410, OPEN, "open")];
    let y = HEIGHT as i32 - 65;
    for (x, colour, label) in entries {
        canvas::disc(area, (x, y), 11, colour, EDGE_COLOUR)?;
        canvas::text(area, label, (x + 22, y), size, Align::Left, BLACK_TEXT)?;
    }
    let y = HEIGHT as i32 - 28;
    if largest == 0.0 {
        return canvas::text(area, "no ball is loaded", (50, y), size, Align::Left, BLACK_TEXT);
    }
    // A round load of at least a quarter of the largest; its arrow is drawn to scale.
    let round = nice_step(0.25 * largest);
    let end = 50 + (LONGEST * round / largest).round() as i32;
    canvas::arrow(area, (50, y), (end, y), ARROW)?;
    let label = format!("{} N; at the balls: load on the outer race [N]", short(round));
    canvas::text(area, &label, (end + 14, y), size, Align::Left, BLACK_TEXT)
}

fn place(azimuth: f64, radius: f64) -> Point {
    let x = f64::from(CENTRE.0) + radius * azimuth.cos();
    let y = f64::from(CENTRE.1) - radius * azimuth.sin();
    (x.round() as i32, y.round() as i32)
}

fn short(value: f64) -> String {
    match value {
        v if !(1e-3..1e6).contains(&v) => format!("{v:.2e}"),
        v if v >= 99.95 => format!("{v:.0}"),
        v if v >= 9.995 => format!("{v:.1}"),
        v if v >= 0.9995 => format!("{v:.2}"),
        v => format!("{v:.3}"),
    }
}
