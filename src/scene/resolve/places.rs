//! Checks of the positions of bearings.

use crate::members::body::Drive;
use crate::motion::validity::race_limit;
use crate::numeric::clock::display_time;
use crate::scene::build::assembly::{Carrier, PlacedBearing, SceneBody, Spring, SpringAt};
use crate::scene::error::{Problem, SceneError};
use crate::scene::text::document::Document;

/// Refuses two bearings whose balls are at one position of a body.
pub(crate) fn refuse_shared_places(
    document: &Document,
    bearings: &[PlacedBearing],
) -> Result<(), SceneError> {
    for (index, one) in bearings.iter().enumerate() {
        for other in &bearings[..index] {
            for side in [0, 1] {
                let (Carrier::Body { index: a, at }, Carrier::Body { index: b, at: there }) =
                    (one.carriers[side], other.carriers[side])
                else {
                    continue;
                };
                let room = one.scene.geometry.ball_radius + other.scene.geometry.ball_radius;
                let (Some(name), Some(second)) = (&one.name, &other.name) else { continue };
                if a == b && (at - there).abs() < room {
                    let reason = format!(
                        "its balls would be inside those of bearing {second}: they are {:.4} mm apart on the same body, less \
                         than a ball diameter. Hint: give each its own position, such as {} = \"60 mm\"",
                        1e3 * (at - there).abs(),
                        ["inner_at", "outer_at"][side]
                    );
                    return Err(document.error_of_name("bearing", name, Problem::refused(reason)));
                }
            }
        }
    }
    Ok(())
}

/// Refuses races too far apart along the axis for the balls to touch both.
pub(crate) fn refuse_races_apart(
    document: &Document,
    bearings: &[PlacedBearing],
    bodies: &[SceneBody],
) -> Result<(), SceneError> {
    for placed in bearings {
        // Bodies are at the origin, or at their fixed position.
        let [inner, outer] = placed.carriers.map(|carrier| match carrier {
            Carrier::Own { at } => at,
            Carrier::Body { index, at } => match &bodies[index].race.drives[0] {
                Drive::Motion(motion) => motion.value(0.0) + at,
                Drive::Load(_) => at,
            },
        });
        let (apart, allowed) = ((inner - outer).abs(), race_limit(&placed.scene.geometry));
        if apart <= allowed {
            continue;
        }
        let reason = format!(
            "its inner race is at {:.4} mm along the axis and its outer one at {:.4} mm, which is {:.4} mm apart; balls touch \
             both within {:.4} mm. Hint: positions count from the centre of the body under a race: give both the same `inner_at` and \
                      `outer_at`, or leave `outer_at` out",
            1e3 * inner,
            1e3 * outer,
            1e3 * apart,
            1e3 * allowed
        );
        let problem = Problem::refused(reason);
        return Err(document.error_of(placed.name.as_deref(), "bearing.outer_at", problem));
    }
    Ok(())
}

/// Refuses shafts thicker than the groove of an inner race on them.
pub(crate) fn refuse_thick_shafts(
    document: &Document,
    bearings: &[PlacedBearing],
    bodies: &[SceneBody],
) -> Result<(), SceneError> {
    for placed in bearings {
        let Carrier::Body { index, at } = placed.carriers[0] else { continue };
        let Some(beam) = &bodies[index].beam else { continue };
        let mut end = beam.start;
        let here = beam.beam.segments.iter().filter(|segment| {
            let start = end;
            end += segment.length;
            start <= at && at <= end
        });
        // At a shoulder the race may be on the thinner side.
        let Some(diameter) = here.map(|segment| segment.outer_diameter).reduce(f64::min) else {
            continue;
        };
        let groove = 2.0 * placed.scene.geometry.race_radii().0;
        if diameter <= groove {
            continue;
        }
        let reason = format!(
            "body.{} is {} mm thick here, more than the {} mm of the inner race's groove. Hint: check segments, `inner_at` and \
             their units",
            bodies[index].name,
            display_time(1e3 * diameter),
            display_time(1e3 * groove)
        );
        let problem = Problem::refused(reason);
        return Err(document.error_of(placed.name.as_deref(), "bearing.inner_at", problem));
    }
    Ok(())
}

/// Refuses bushings whose rubber begins inside their outer race.
pub(crate) fn refuse_rubber_in_races(
    document: &Document,
    bearings: &[PlacedBearing],
    springs: &[Spring],
) -> Result<(), SceneError> {
    for spring in springs {
        let Some(of) = &spring.bushing else { continue };
        let mut ends = spring.ends.iter();
        let race = ends.find_map(|end| match end.at {
            SpringAt::Race { bearing, side: 1 } => Some(&bearings[bearing].scene),
            _ => None,
        });
        let Some(race) = race else { continue };
        let radius = race.dimensions.outer_radius.unwrap_or(race.geometry.race_radii().1);
        if of.body.inner_diameter >= 2.0 * radius * (1.0 - 1e-9) {
            continue;
        }
        let reason = format!(
            "the rubber begins at {} mm, inside the outer race in it, of {} mm. Hint: give it the diameter of the race, or more",
            display_time(1e3 * of.body.inner_diameter),
            display_time(2e3 * radius)
        );
        return Err(document.scoped(&spring.name).refused("spring.bushing.inner_diameter", reason));
    }
    Ok(())
}
