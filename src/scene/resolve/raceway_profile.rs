//! Profiles of raceways and balls: dents, spalls, waviness, balls of different size.

use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch3_bushing::dent::{Dent, DentShape};
use crate::ch5_cage::raceway_profile::{RacewayProfile, Spall, Surface, Waviness};
use crate::ch5_cage::spall::SpallShape;
use crate::scene::error::SceneError;
use crate::scene::resolve::bearing::Reader;
use crate::scene::text::items::ItemRef;
use crate::scene::text::units::plain;
use crate::scene::text::value::Checked;
use std::f64::consts::TAU;

/// Default depth of a dent, as a fraction of its diameter: balls of usual bearings do not reach its bottom.
const USUAL_DEPTH: f64 = 0.05;
/// Default width of a shoulder, as a fraction of the dent's diameter.
const USUAL_WIDTH: f64 = 0.25;
/// Largest diameter over the ball radius: cells and intervals of the law's table are made for the size of contacts.
const WIDEST: f64 = 0.5;

/// Dents, spalls and waves of a bearing, in this order.
pub(crate) fn profiles(
    reader: &mut Reader,
    geometry: &BearingGeometry,
) -> Result<Vec<RacewayProfile>, SceneError> {
    let document = reader.document;
    let mut all = Vec::new();
    for item in document.items("bearing.dent") {
        all.push(RacewayProfile::Dent(dent(reader, geometry, item)?));
    }
    for item in document.items("bearing.spall") {
        all.push(RacewayProfile::Spall(spall(reader, geometry, item)?));
    }
    for item in document.items("bearing.waviness") {
        all.push(RacewayProfile::Waviness(waviness(reader, geometry, item)?));
    }
    Ok(all)
}

/// Part that has a profile.
enum Part {
    /// 0 inner, 1 outer.
    Race(usize),
    /// Index from 0.
    Ball(usize),
}

fn part(item: ItemRef, geometry: &BearingGeometry) -> Result<Part, SceneError> {
    match item.choice("on")? {
        "inner" => Ok(Part::Race(0)),
        "outer" => Ok(Part::Race(1)),
        _ => match item.number("ball").map(|number| number as usize) {
            None => Err(item.missing("ball", " with `on = \"ball\"`")),
            Some(number) if number > geometry.ball_count => {
                let reason = format!(
                    "the bearing has {} balls. Hint: give a number from 1 to {}",
                    geometry.ball_count, geometry.ball_count
                );
                Err(item.refused("ball", reason))
            }
            Some(number) => Ok(Part::Ball(number - 1)),
        },
    }
}

/// Angle of the nominal contact around the groove of a race, from its bottom towards X, rad.
fn nominal_track(geometry: &BearingGeometry, side: usize) -> f64 {
    if side == 0 { -geometry.contact_angle } else { geometry.contact_angle }
}

/// Largest length of a spall, in ball radii: the slope of its walls stays below 0.5.
const LONGEST: f64 = 1.0;

fn spall(
    reader: &mut Reader,
    geometry: &BearingGeometry,
    item: ItemRef,
) -> Result<Spall, SceneError> {
    let part = part(item, geometry)?;
    let (angle, length) = (item.required("angle")?, item.required("length")?);
    let longest = LONGEST * geometry.ball_radius;
    if length > longest {
        let reason = format!(
            "a spall longer than {} mm, the ball radius, is outside the model. Hint: the contact keeps the direction of its normal; give a shorter spall",
            plain(1e3 * longest)
        );
        return Err(item.refused("length", reason));
    }
    let groove_angle = item.number("groove_angle").unwrap_or_else(|| {
        let side = if let Part::Race(side) = part { side } else { 1 };
        let track = nominal_track(geometry, side);
        let reason = "in the nominal track of the balls";
        let value = format!("{} deg", plain(track.to_degrees()));
        let path = item.own_path("groove_angle");
        reader.note("bearing.spall.groove_angle", &value, reason).fill(&path, track);
        track
    });
    let (width, on) = match part {
        Part::Race(side) => (item.required("width")?, Surface::Race { side, angle, groove_angle }),
        Part::Ball(ball) => (f64::INFINITY, Surface::Ball { ball, angle, groove_angle }),
    };
    let edge_radius = reader.of_item(item, "edge_radius");
    let depth = match (item.number("depth"), item.number("floor_radius")) {
        (Some(depth), _) => depth,
        (None, given) => {
            let floor_radius = given.unwrap_or_else(|| {
                let path = item.own_path("floor_radius");
                reader
                    .note("bearing.spall.floor_radius", "6 mm", "R of Fig. 5.29")
                    .fill(&path, USUAL_FLOOR);
                USUAL_FLOOR
            });
            if 0.5 * length > floor_radius + edge_radius {
                let reason = format!(
                    "floor and edges are too tight for the length. Hint: floor_radius + edge_radius must be at least half of the length, {} mm",
                    plain(0.5e3 * length)
                );
                return Err(item.refused("floor_radius", reason));
            }
            SpallShape::depth_of(length, edge_radius, floor_radius)
        }
    };
    let shape = SpallShape { length, width, edge_radius, depth };
    if !shape.vanishes() && (depth > 0.5 * length || shape.floor_radius() <= 0.0) {
        let reason = "edges of this radius and length do not reach so deep. Hint: give a smaller depth or edge_radius, or a longer spall";
        return Err(item.refused("depth", reason));
    }
    Ok(Spall { shape, on })
}

/// Floor radius of the source's spall (Fig. 5.29), m.
const USUAL_FLOOR: f64 = 6e-3;

fn waviness(
    reader: &mut Reader,
    geometry: &BearingGeometry,
    item: ItemRef,
) -> Result<Waviness, SceneError> {
    let part = part(item, geometry)?;
    let (order, amplitude) = (item.required("order")?, item.required("amplitude")?);
    Ok(match part {
        Part::Race(side) => {
            let on = Surface::Race { side, angle: 0.0, groove_angle: 0.0 };
            Waviness { order, amplitude, phase: reader.of_item(item, "phase"), on }
        }
        Part::Ball(ball) => {
            let angle = item.required("angle")?;
            let groove_angle = reader.of_item(item, "groove_angle");
            let on = Surface::Ball { ball, angle, groove_angle };
            Waviness { order, amplitude, phase: 0.0, on }
        }
    })
}

/// Excess of each ball's radius, m; empty if the scene gives none.
pub(crate) fn ball_deviations(
    reader: &mut Reader,
    geometry: &BearingGeometry,
) -> Result<Vec<f64>, SceneError> {
    let balls = geometry.ball_count;
    if let Some(Checked::Quantities(given)) = reader.document.value("bearing.ball.deviations") {
        if given.len() != balls {
            let reason = format!(
                "{} values for {balls} balls. Hint: give one value for each ball",
                given.len()
            );
            return Err(reader.document.refused("bearing.ball.deviations", reason));
        }
        return Ok(given.clone());
    }
    let Some(scatter) = reader.given_number("bearing.ball.scatter") else {
        if reader.is_given("bearing.ball.seed") {
            let reason = "without `scatter` nothing is random. Hint: leave it out, or give scatter";
            return Err(reader.document.refused("bearing.ball.seed", reason));
        }
        return Ok(Vec::new());
    };
    // Checked by the key table: a whole number.
    let reason = "another number gives other deviations";
    let seed = reader.number_or("bearing.ball.seed", 1.0, "1", reason);
    Ok(normal(seed as u64, balls).into_iter().map(|value| scatter * value).collect())
}

/// Normally distributed numbers of mean 0 and deviation 1: SplitMix64, then Box and Muller.
fn normal(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^= mixed >> 31;
        // In (0, 1].
        ((mixed >> 11) + 1) as f64 / (1u64 << 53) as f64
    };
    let one = |[u, v]: [f64; 2]| (-2.0 * libm::log(u)).sqrt() * libm::cos(TAU * v);
    (0..count).map(|_| one([uniform(), uniform()])).collect()
}

fn dent(
    reader: &mut Reader,
    geometry: &BearingGeometry,
    item: ItemRef,
) -> Result<Dent, SceneError> {
    let side = usize::from(item.choice("race")? == "outer");
    let (angle, diameter) = (item.required("angle")?, item.required("diameter")?);
    let widest = WIDEST * geometry.ball_radius;
    if diameter > widest {
        let reason = format!(
            "a dent wider than {} mm, half the ball's radius, is outside the model. Hint: the law is that of a surface that is flat except for the dent; give a smaller diameter",
            plain(1e3 * widest)
        );
        return Err(item.refused("diameter", reason));
    }
    let mut follows = |name: &str, part: f64, reason: &str| {
        item.number(name).unwrap_or_else(|| {
            let value = part * diameter;
            let text = format!("{} um", plain(1e6 * value));
            reader.note(&item.path(name), &text, reason).fill(&item.own_path(name), value);
            value
        })
    };
    let reason = "a twentieth of the diameter; the source gives none";
    let depth = follows("depth", USUAL_DEPTH, reason);
    let shoulder_width = match item.number("shoulder_height") {
        Some(height) if height > 0.0 => {
            follows("shoulder_width", USUAL_WIDTH, "a quarter of the diameter")
        }
        _ => item.number("shoulder_width").unwrap_or(0.0),
    };
    let shoulder_height = reader.of_item(item, "shoulder_height");
    let shape = DentShape { diameter, depth, shoulder_height, shoulder_width };
    let groove_angle = reader.of_item(item, "groove_angle");
    Ok(Dent { shape, side, angle, groove_angle })
}
