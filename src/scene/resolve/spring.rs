//! From the keys of a spring to its ends and its law.

use crate::members::connection::{CrossCoupling, MaxwellElement};
use crate::scene::build::assembly::{
    Carrier, PlacedBearing, SIX, Spring, SpringAt, SpringEnd, race_at,
};
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::{Reader, text};
use crate::scene::resolve::bushing::bushing;
use crate::scene::resolve::resolved::DefaultUsed;
use crate::scene::resolve::unused::refuse_unused;
use crate::scene::tables::assembly::{GROUND, OWN_RACES};
use crate::scene::tables::keys::nearest;
use crate::scene::text::document::Document;
use crate::scene::text::items::ItemRef;

/// A spring between two bodies, a body and the ground, or a race that is a body of its own.
pub(crate) fn spring(
    document: &Document,
    name: &str,
    (bodies, bearings): (&[&str], &[PlacedBearing]),
    defaults: &mut Vec<DefaultUsed>,
) -> Result<Spring, SceneError> {
    let scoped = document.scoped(name);
    refuse_unused(&scoped, &["spring"])?;
    let mut reader = Reader::new(&scoped);
    let end = |reader: &Reader, key: &str| -> Result<SpringAt, SceneError> {
        match text(reader.document, key).as_deref() {
            None if key == "spring.from" => Err(reader.missing(key, "")),
            None | Some(GROUND) => Ok(SpringAt::Ground),
            Some(name) => match bodies.iter().position(|other| *other == name) {
                Some(index) => Ok(SpringAt::Body(index)),
                None => race(reader, key, name, bodies, bearings),
            },
        }
    };
    let from = end(&reader, "spring.from")?;
    let to = end(&reader, "spring.to")?;
    if text(&scoped, "spring.to").is_none() {
        reader.note_default("spring.to");
    }
    if from == to {
        let reason = "both ends are at the same body. Hint: a spring joins two bodies, or a body and the ground";
        return Err(scoped.refused("spring.to", reason));
    }
    // Both ends at one position; at that of a race if one end is a race.
    let [from_x, to_x] = [from, to].map(|at| race_at(bearings, at));
    let along = match from {
        SpringAt::Race { .. } => reader.number("spring.from_at"),
        _ if to_x != 0.0 => reader.given_number("spring.from_at").unwrap_or(to_x),
        _ => reader.number("spring.from_at"),
    };
    let to_along = reader.given_number("spring.to_at").unwrap_or(from_x + along - to_x);
    reader.follow("spring.from_at", along);
    reader.follow("spring.to_at", to_along);
    let six = |what: &str| {
        SIX.map(|name| reader.given_number(&format!("spring.{what}.{name}")).unwrap_or(0.0))
    };
    let (stiffness, damping) = (six("stiffness"), six("damping"));
    let pair = |what: &str| {
        ["yz", "zy"]
            .map(|name| reader.given_number(&format!("spring.{what}.{name}")).unwrap_or(0.0))
    };
    let cross = CrossCoupling { stiffness: pair("stiffness"), damping: pair("damping") };
    let maxwell = scoped.items("spring.maxwell").map(maxwell).collect::<Result<Vec<_>, _>>()?;
    let ends = [SpringEnd { at: from, along }, SpringEnd { at: to, along: to_along }];
    let name = name.into();
    let mut spring = Spring { name, ends, stiffness, damping, cross, maxwell, bushing: None };
    match bushing(&mut reader)? {
        Some((bushing, law)) => {
            (spring.stiffness, spring.maxwell) = (law.stiffness, law.maxwell);
            spring.bushing = Some(Box::new(bushing));
        }
        None if stiffness == [0.0; 6]
            && damping == [0.0; 6]
            && cross == CrossCoupling::default()
            && spring.maxwell.is_empty() =>
        {
            return Err(reader.missing("spring.stiffness.x", " or another spring or dashpot"));
        }
        None => {}
    }
    reader.note_named(defaults);
    Ok(spring)
}

/// A race that is a body of its own, `outer_race` or `left.outer_race`.
fn race(
    reader: &Reader,
    key: &str,
    name: &str,
    bodies: &[&str],
    bearings: &[PlacedBearing],
) -> Result<SpringAt, SceneError> {
    let refused = |reason: String| reader.document.refused(key, reason);
    let (of, race) = name.split_once('.').map_or((None, name), |(of, race)| (Some(of), race));
    let side = OWN_RACES.iter().position(|own| *own == race);
    let bearing = match of {
        None if bearings.len() == 1 => Some(0),
        None => None,
        Some(of) => bearings.iter().position(|placed| placed.name.as_deref() == Some(of)),
    };
    let (Some(side), Some(bearing)) = (side, bearing) else {
        if side.is_some() && of.is_none() {
            let each = bearings.iter().filter_map(|placed| placed.name.as_ref());
            let each: Vec<String> = each.map(|name| format!("{name}.{race}")).collect();
            return Err(refused(format!(
                "there are several bearings. Hint: write one of {}",
                each.join(", ")
            )));
        }
        return Err(reader.document.error(key, no_such_end(name, bodies, bearings)));
    };
    let placed = &bearings[bearing];
    if let Carrier::Body { index, .. } = placed.carriers[side] {
        return Err(refused(format!("this race is on body.{0}. Hint: write {0:?}", bodies[index])));
    }
    if side == 1 && placed.housing.is_some() {
        return Err(refused("the outer race is in the bore of its housing. Hint: join the spring to a body, or leave the housing out".into()));
    }
    if side == 1 && placed.scene.dynamics.outer.is_none() {
        return Err(refused(
            "the outer race is fixed. Hint: write `motion = \"5-dof\"` in [outer_race]".into(),
        ));
    }
    Ok(SpringAt::Race { bearing, side })
}

/// Refuses an end that does not exist, with the valid ones.
fn no_such_end(name: &str, bodies: &[&str], bearings: &[PlacedBearing]) -> Problem {
    let mut known: Vec<String> = bodies.iter().map(|body| body.to_string()).collect();
    for placed in bearings {
        let moves = [true, placed.scene.dynamics.outer.is_some() && placed.housing.is_none()];
        for (side, race) in OWN_RACES.iter().enumerate() {
            if moves[side] && matches!(placed.carriers[side], Carrier::Own { .. }) {
                let of = placed.name.as_ref().map_or(String::new(), |name| format!("{name}."));
                known.push(format!("{of}{race}"));
            }
        }
    }
    known.push(GROUND.into());
    let hint = match nearest(name, known.iter().map(String::as_str), 0.5) {
        Some(nearest) => format!("did you mean {nearest}?"),
        None => "write one of them; a race is named if it moves by itself".into(),
    };
    let ends = known.join(", ");
    Problem::refused(format!("{name:?} is no end of a spring; ends are: {ends}. Hint: {hint}"))
}

fn maxwell(item: ItemRef) -> Result<MaxwellElement, SceneError> {
    let relaxation_time = item.required("relaxation_time")?;
    let stiffness = SIX.map(|name| item.number(name).unwrap_or(0.0));
    if stiffness == [0.0; 6] {
        return Err(item.missing("z", ", nothing relaxes"));
    }
    Ok(MaxwellElement { stiffness, relaxation_time })
}
