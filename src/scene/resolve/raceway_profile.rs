//! Profiles of raceways and balls: dents, spalls, waviness, balls of different size.

use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch3_bushing::dent::{Dent, DentShape};
use crate::ch5_cage::raceway_profile::{RacewayProfile, Spall, Surface, Waviness};
use crate::ch5_cage::spall::SpallShape;
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::Reader;
use crate::scene::resolve::solid::{item_number, missing};
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
    let side = match item.value("on") {
        Some(Checked::Choice("inner")) => Some(0),
        Some(Checked::Choice("outer")) => Some(1),
        Some(Checked::Choice(_)) => None,
        _ => return Err(missing(item, "on", "", "on = \"outer\"")),
    };
    let number = match item.value("ball") {
        Some(Checked::Integer(number)) => Some(*number as usize),
        _ => None,
    };
    match (side, number) {
        (Some(_), Some(_)) => Err(refused(item, "ball", "a race")),
        (Some(side), None) => Ok(Part::Race(side)),
        (None, None) => Err(missing(item, "ball", " with `on = \"ball\"`", "ball = 1")),
        (None, Some(number)) if number > geometry.ball_count => {
            let reason = format!("the bearing has {} balls", geometry.ball_count);
            let advice = format!("give a number from 1 to {}", geometry.ball_count);
            Err(item.error("ball", Problem::refused(reason, advice)))
        }
        (None, Some(number)) => Ok(Part::Ball(number - 1)),
    }
}

/// A key that a profile of this part does not use.
fn refused(item: ItemRef, name: &str, part: &str) -> SceneError {
    let reason = format!("a profile of {part} does not use it");
    item.error(name, Problem::refused(reason, "leave it out, or change `on`"))
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
    let required = |name: &str, example: &str| {
        item_number(item, name).ok_or_else(|| missing(item, name, "", example))
    };
    let part = part(item, geometry)?;
    let angle = required("angle", "angle = \"270 deg\"")?;
    let length = required("length", "length = \"2 mm\"")?;
    let longest = LONGEST * geometry.ball_radius;
    if length > longest {
        let reason = format!(
            "a spall longer than {} mm, the ball radius, is outside the model",
            plain(1e3 * longest)
        );
        let advice = "the contact keeps the direction of its normal; give a shorter spall";
        return Err(item.error("length", Problem::refused(reason, advice)));
    }
    let groove_angle = item_number(item, "groove_angle").unwrap_or_else(|| {
        let side = if let Part::Race(side) = part { side } else { 1 };
        let track = nominal_track(geometry, side);
        let reason = "in the nominal track of the balls";
        let value = format!("{} deg", plain(track.to_degrees()));
        reader.note("bearing.spall.groove_angle", &value, reason);
        track
    });
    let (width, on) = match part {
        Part::Race(side) => {
            let width = required("width", "width = \"4 mm\"")?;
            (width, Surface::Race { side, angle, groove_angle })
        }
        Part::Ball(_) if item.value("width").is_some() => {
            return Err(refused(item, "width", "a ball"));
        }
        Part::Ball(ball) => (f64::INFINITY, Surface::Ball { ball, angle, groove_angle }),
    };
    let edge_radius = item_number(item, "edge_radius").unwrap_or_else(|| {
        reader.note_default("bearing.spall.edge_radius");
        USUAL_EDGE
    });
    let depth = match (item_number(item, "depth"), item_number(item, "floor_radius")) {
        (Some(_), Some(_)) => {
            let rival = "floor_radius".to_string();
            let advice = "keep `floor_radius` or `depth`".to_string();
            return Err(item.error("depth", Problem::Exclusive { rival, advice }));
        }
        (Some(depth), None) => depth,
        (None, given) => {
            let floor_radius = given.unwrap_or_else(|| {
                let reason = "R of Fig. 5.29";
                reader.note("bearing.spall.floor_radius", "6 mm", reason);
                USUAL_FLOOR
            });
            if 0.5 * length > floor_radius + edge_radius {
                let reason = "floor and edges are too tight for the length";
                let advice = format!(
                    "floor_radius + edge_radius must be at least half of the length, {} mm",
                    plain(0.5e3 * length)
                );
                return Err(item.error("floor_radius", Problem::refused(reason, advice)));
            }
            SpallShape::depth_of(length, edge_radius, floor_radius)
        }
    };
    let shape = SpallShape { length, width, edge_radius, depth };
    if !shape.vanishes() && (depth > 0.5 * length || shape.floor_radius() <= 0.0) {
        let reason = "edges of this radius and length do not reach so deep";
        let advice = "give a smaller depth or edge_radius, or a longer spall";
        return Err(item.error("depth", Problem::refused(reason, advice)));
    }
    Ok(Spall { shape, on })
}

/// Radii of the source's spall (Fig. 5.29), m.
const USUAL_EDGE: f64 = 1e-3;
const USUAL_FLOOR: f64 = 6e-3;

fn waviness(
    reader: &mut Reader,
    geometry: &BearingGeometry,
    item: ItemRef,
) -> Result<Waviness, SceneError> {
    let part = part(item, geometry)?;
    let order = match item.value("order") {
        Some(Checked::Integer(order)) => *order as f64,
        _ => return Err(missing(item, "order", "", "order = 12")),
    };
    let amplitude = item_number(item, "amplitude")
        .ok_or_else(|| missing(item, "amplitude", "", "amplitude = \"0.5 um\""))?;
    let unused: &[&str] = match part {
        Part::Race(_) => &["angle", "groove_angle"],
        Part::Ball(_) => &["phase"],
    };
    let on = if let Part::Race(_) = part { "a race" } else { "a ball" };
    if let Some(name) = unused.iter().find(|name| item.value(name).is_some()) {
        return Err(refused(item, name, on));
    }
    let mut usual = |name: &str| {
        item_number(item, name).unwrap_or_else(|| {
            reader.note_default(&format!("bearing.waviness.{name}"));
            0.0
        })
    };
    Ok(match part {
        Part::Race(side) => {
            let on = Surface::Race { side, angle: 0.0, groove_angle: 0.0 };
            Waviness { order, amplitude, phase: usual("phase"), on }
        }
        Part::Ball(ball) => {
            let because = " with `on = \"ball\"`";
            let angle = item_number(item, "angle")
                .ok_or_else(|| missing(item, "angle", because, "angle = \"0 deg\""))?;
            let on = Surface::Ball { ball, angle, groove_angle: usual("groove_angle") };
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
            let reason = format!("{} values for {balls} balls", given.len());
            let advice = "give one value for each ball";
            return Err(reader.document.refused("bearing.ball.deviations", reason, advice));
        }
        return Ok(given.clone());
    }
    let Some(scatter) = reader.given_number("bearing.ball.scatter") else {
        if reader.is_given("bearing.ball.seed") {
            let reason = "without `scatter` nothing is random";
            let advice = "leave it out, or give scatter";
            return Err(reader.document.refused("bearing.ball.seed", reason, advice));
        }
        return Ok(Vec::new());
    };
    // Checked by the key table: a whole number.
    let seed = reader.given_number("bearing.ball.seed").unwrap_or_else(|| {
        reader.note("bearing.ball.seed", "1", "another number gives other deviations");
        1.0
    });
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
    let required = |name: &str, example: &str| {
        item_number(item, name).ok_or_else(|| missing(item, name, "", example))
    };
    let side = match item.value("race") {
        Some(Checked::Choice("inner")) => 0,
        Some(Checked::Choice(_)) => 1,
        _ => return Err(missing(item, "race", "", "race = \"outer\"")),
    };
    let (angle, diameter) =
        (required("angle", "angle = \"270 deg\"")?, required("diameter", "diameter = \"500 um\"")?);
    let widest = WIDEST * geometry.ball_radius;
    if diameter > widest {
        let reason = format!(
            "a dent wider than {} mm, half the ball's radius, is outside the model",
            plain(1e3 * widest)
        );
        let advice = "the law is that of a surface that is flat except for the dent; give a smaller diameter";
        return Err(item.error("diameter", Problem::refused(reason, advice)));
    }
    let depth = item_number(item, "depth").unwrap_or_else(|| {
        let depth = USUAL_DEPTH * diameter;
        let reason = "a twentieth of the diameter; the source gives none";
        reader.note("bearing.dent.depth", &format!("{} um", plain(1e6 * depth)), reason);
        depth
    });
    let shoulder_height = item_number(item, "shoulder_height").unwrap_or_else(|| {
        reader.note_default("bearing.dent.shoulder_height");
        0.0
    });
    let shoulder_width = match item_number(item, "shoulder_width") {
        Some(width) => width,
        None if shoulder_height > 0.0 => {
            let width = USUAL_WIDTH * diameter;
            let reason = "a quarter of the diameter";
            reader.note(
                "bearing.dent.shoulder_width",
                &format!("{} um", plain(1e6 * width)),
                reason,
            );
            width
        }
        None => 0.0,
    };
    let shape = DentShape { diameter, depth, shoulder_height, shoulder_width };
    let groove_angle = item_number(item, "groove_angle").unwrap_or(0.0);
    Ok(Dent { shape, side, angle, groove_angle })
}
