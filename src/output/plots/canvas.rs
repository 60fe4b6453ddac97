//! Drawing primitives of all plots: text, lines, markers, legend.

use crate::mesh::write::is_xml_character;
use crate::output::plots::{Curve, PlotError};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub type Point = (i32, i32);
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub const WIDTH: u32 = 900;
pub const BLACK_TEXT: RGBColor = RGBColor(30, 30, 30);
pub const GRID: RGBColor = RGBColor(222, 222, 222);
/// Vertical lines at marked values, and their labels.
pub const MARK: RGBColor = RGBColor(150, 150, 150);
pub const MARK_TEXT: RGBColor = RGBColor(90, 90, 90);
/// Text sizes at a width of 900 px; at 700 px the smallest text is 13 px high.
const TITLE_SIZE: i32 = 25;
pub const TEXT_SIZE: i32 = 21;

/// Okabe and Ito's colours without yellow, which is hard to see on white.
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

/// Colour of curve number `index`: the seven colours, then their darker and then their paler variants.
pub fn colour(index: usize) -> RGBColor {
    let RGBColor(red, green, blue) = COLOURS[index % COLOURS.len()];
    let shade = |part: u8| match index / COLOURS.len() % 3 {
        0 => part,
        1 => part / 2,
        _ => 110 + (u32::from(part) * 120 / 255) as u8,
    };
    match (index / COLOURS.len() % 3, red) {
        (1, 0) if green == 0 && blue == 0 => RGBColor(120, 120, 120),
        _ => RGBColor(shade(red), shade(green), shade(blue)),
    }
}

/// Calls `paint` with an empty white drawing of this size and returns the SVG.
pub fn draw(
    height: u32,
    paint: impl FnOnce(&Area) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (WIDTH, height)).into_drawing_area();
        area.fill(&WHITE).map_err(failed)?;
        paint(&area)?;
        area.present().map_err(failed)?;
    }
    Ok(svg)
}

pub fn failed(reason: impl std::fmt::Display) -> PlotError {
    PlotError::Draw { reason: reason.to_string() }
}

#[derive(Clone, Copy)]
pub enum Align {
    Left,
    Centre,
    Right,
    /// Centred, rotated to read upwards.
    Upwards,
}

pub fn text(
    area: &Area,
    content: &str,
    at: Point,
    size: i32,
    align: Align,
    colour: RGBColor,
) -> Result<(), PlotError> {
    let content: String =
        content.chars().filter(|c| !c.is_control() && is_xml_character(*c)).collect();
    let horizontal = match align {
        Align::Left => HPos::Left,
        Align::Centre | Align::Upwards => HPos::Center,
        Align::Right => HPos::Right,
    };
    let turn = match align {
        Align::Upwards => FontTransform::Rotate270,
        _ => FontTransform::None,
    };
    let font = FontDesc::from(("sans-serif", size)).transform(turn);
    let style = TextStyle::from(font).color(&colour).pos(Pos::new(horizontal, VPos::Center));
    area.draw_text(&content, &style, at).map_err(failed)
}

pub fn title(area: &Area, content: &str) -> Result<(), PlotError> {
    let fitting = (WIDTH as i32 - 40) * 19 / (10 * content.chars().count().max(1) as i32);
    let size = TITLE_SIZE.min(fitting).max(12);
    let at = (WIDTH as i32 / 2, 28);
    text(area, content, at, size, Align::Centre, BLACK_TEXT)
}

pub fn line(
    area: &Area,
    points: Vec<Point>,
    colour: RGBColor,
    width: u32,
) -> Result<(), PlotError> {
    area.draw(&PathElement::new(points, colour.stroke_width(width))).map_err(failed)
}

pub fn polygon(area: &Area, points: Vec<Point>, colour: RGBColor) -> Result<(), PlotError> {
    area.draw(&Polygon::new(points, colour.filled())).map_err(failed)
}

pub fn disc(
    area: &Area,
    centre: Point,
    radius: i32,
    fill: RGBColor,
    edge: RGBColor,
) -> Result<(), PlotError> {
    area.draw(&Circle::new(centre, radius, fill.filled())).map_err(failed)?;
    area.draw(&Circle::new(centre, radius, edge.stroke_width(2))).map_err(failed)
}

/// Arrow; lines shorter than 1 px are not drawn.
pub fn arrow(area: &Area, from: Point, to: Point, colour: RGBColor) -> Result<(), PlotError> {
    let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let length = dx.hypot(dy);
    if length < 1.0 {
        return Ok(());
    }
    let (ux, uy) = (dx / length, dy / length);
    let head = length.min(16.0);
    let at = |along: f64, across: f64| {
        let x = f64::from(to.0) - along * ux - across * uy;
        let y = f64::from(to.1) - along * uy + across * ux;
        (x.round() as i32, y.round() as i32)
    };
    line(area, vec![from, at(0.8 * head, 0.0)], colour, 4)?;
    polygon(area, vec![to, at(head, 0.45 * head), at(head, -0.45 * head)], colour)
}

/// Marker of curve number `index`; shapes differ as well as colours.
pub fn marker(area: &Area, index: usize, (x, y): Point) -> Result<(), PlotError> {
    let colour = colour(index);
    let r = 6;
    match index % 5 {
        0 => area.draw(&Circle::new((x, y), r, colour.filled())).map_err(failed),
        1 => polygon(area, vec![(x, y - r - 1), (x + r + 1, y + r), (x - r - 1, y + r)], colour),
        2 => polygon(
            area,
            vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)],
            colour,
        ),
        3 => {
            let d = r + 2;
            polygon(area, vec![(x, y - d), (x + d, y), (x, y + d), (x - d, y)], colour)
        }
        _ => {
            line(area, vec![(x - r, y - r), (x + r, y + r)], colour, 3)?;
            line(area, vec![(x - r, y + r), (x + r, y - r)], colour, 3)
        }
    }
}

/// Largest number of markers of a curve, spaced evenly by index.
const MARKERS: usize = 24;

pub fn markers(area: &Area, index: usize, points: &[Point]) -> Result<(), PlotError> {
    let every = points.len().div_ceil(MARKERS).max(1);
    points.iter().step_by(every).try_for_each(|&point| marker(area, index, point))
}

pub struct Legend {
    /// Curve number, column start and row of each entry.
    entries: Vec<(usize, i32, i32)>,
    rows: i32,
}

const LEGEND_ROW: i32 = 32;
const LEGEND_SAMPLE: i32 = 58;

impl Legend {
    pub fn new(curves: &[Curve]) -> Self {
        let margin = 60;
        let (mut x, mut row) = (margin, 0);
        let mut entries = Vec::new();
        for (index, curve) in curves.iter().enumerate() {
            let wide = LEGEND_SAMPLE + text_width(&curve.name) + 30;
            if x > margin && x + wide > WIDTH as i32 - 20 {
                (x, row) = (margin, row + 1);
            }
            entries.push((index, x, row));
            x += wide;
        }
        Legend { entries, rows: row + 1 }
    }

    pub fn height(&self) -> i32 {
        self.rows * LEGEND_ROW + 12
    }

    pub fn draw(
        &self,
        area: &Area,
        curves: &[Curve],
        top: i32,
        line_and_marker: impl Fn(&Curve) -> (bool, bool),
    ) -> Result<(), PlotError> {
        for &(index, x, row) in &self.entries {
            let (with_line, with_marker) = line_and_marker(&curves[index]);
            let y = top + row * LEGEND_ROW + LEGEND_ROW / 2;
            let colour = colour(index);
            if with_line {
                line(area, vec![(x, y), (x + LEGEND_SAMPLE - 14, y)], colour, 3)?;
            }
            if with_marker {
                marker(area, index, (x + (LEGEND_SAMPLE - 14) / 2, y))?;
            }
            let at = (x + LEGEND_SAMPLE, y);
            text(area, &curves[index].name, at, TEXT_SIZE, Align::Left, BLACK_TEXT)?;
        }
        Ok(())
    }
}

/// Width of a text of size `TEXT_SIZE`, px, with a margin for common fonts.
fn text_width(content: &str) -> i32 {
    content.chars().count() as i32 * 11
}
