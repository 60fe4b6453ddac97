//! Traction and damping between balls and races, friction between balls.

use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::Reader;
use crate::scene::text::value::Checked;

/// Keys of some laws only.
const TRACTION_KEYS: &[(&str, &[&str])] = &[
    ("traction.coefficient", &["constant"]),
    ("traction.regularisation_speed", &["constant"]),
    ("traction.b", &["slide-to-roll", "slip-speed"]),
    ("traction.c", &["slide-to-roll", "slip-speed"]),
    ("traction.d", &["slide-to-roll", "slip-speed"]),
    ("traction.entrainment_floor", &["slide-to-roll"]),
];
const DAMPING_KEYS: &[(&str, &[&str])] = &[("contact_damping.alpha", &["hunt-crossley"])];

/// Refuses keys of another law or method than the chosen one.
pub(crate) fn refuse_without_effect_on(
    reader: &Reader,
    (what, chosen): (&str, &str),
    keys: &[(&str, &[&str])],
) -> Result<(), SceneError> {
    for (key, users) in keys {
        if chosen != "none" && reader.is_given(key) && !users.contains(&chosen) {
            let own = users.iter().map(|user| format!("`{what} = \"{user}\"`"));
            let own: Vec<String> = own.collect();
            let advice = format!("leave it out, or choose {}", own.join(" or "));
            let reason = match what {
                "law" => "the chosen law does not use it",
                _ => "the chosen method does not use it",
            };
            return Err(reader.document.refused(key, reason, advice));
        }
    }
    Ok(())
}

pub(crate) fn traction(reader: &mut Reader) -> Result<TractionLaw, SceneError> {
    let law = reader.choice("traction.law").unwrap_or("slide-to-roll");
    refuse_without_effect_on(reader, ("law", law), TRACTION_KEYS)?;
    let because = format!(" with `law = \"{law}\"`");
    Ok(match law {
        "constant" => TractionLaw::Constant {
            coefficient: reader.required_number("traction.coefficient", &because)?,
            regularisation_speed: reader
                .required_number("traction.regularisation_speed", &because)?,
        },
        "slide-to-roll" => TractionLaw::SlideToRoll {
            curve: curve(
                reader,
                0,
                "this curve is over the slide-to-roll ratio, a plain number",
                "22.28",
            )?,
            entrainment_floor: reader.number("traction.entrainment_floor").unwrap_or(0.01),
        },
        "slip-speed" => TractionLaw::SlipSpeed {
            curve: curve(reader, 1, "this curve is over the sliding speed, in s/m", "\"20 s/m\"")?,
        },
        _ => TractionLaw::None,
    })
}

/// The exponential curve; its slopes must be of kind number `kind` of their key.
fn curve(
    reader: &mut Reader,
    kind: usize,
    unit: &'static str,
    example: &str,
) -> Result<ExponentialCurve, SceneError> {
    let common = ExponentialCurve::BOUNDARY;
    let mut values = [common.b, common.c, common.d];
    for (value, path) in values.iter_mut().zip(["traction.b", "traction.c", "traction.d"]) {
        match reader.document.value(path) {
            Some(Checked::Number(given)) => *value = *given,
            Some(Checked::Either(index, given)) if *index == kind => *value = *given,
            Some(_) => {
                let name = path.rsplit('.').next().unwrap_or(path);
                let advice = format!("write {name} = {example}");
                return Err(reader.document.refused(path, unit, advice));
            }
            None if kind == 1 => {
                return Err(
                    reader.missing(path, " with `law = \"slip-speed\"`, whose b and c are in s/m")
                );
            }
            None => {
                let reason = "common boundary-lubrication set; the source's curve is not printed";
                reader.note(path, &crate::scene::text::units::plain(*value), reason);
            }
        }
    }
    let [b, c, d] = values;
    let curve = ExponentialCurve { b, c, d };
    // dκ/dx = 0 at x = (1 + c d/b)/c.
    let peak = if b > 0.0 { curve.coefficient((1.0 + c * d / b) / c).max(d) } else { d };
    if peak <= 2.0 {
        Ok(curve)
    } else {
        Err(reader.document.error("traction.b", Problem::FrictionTooLarge { peak }))
    }
}

pub(crate) fn damping(reader: &mut Reader) -> Result<ContactDamping, SceneError> {
    let law = reader.choice("contact_damping.law").unwrap_or("none");
    refuse_without_effect_on(reader, ("law", law), DAMPING_KEYS)?;
    let because = format!(" with `law = \"{law}\"`");
    Ok(match law {
        "hunt-crossley" => ContactDamping::HuntCrossley {
            alpha: reader.required_number("contact_damping.alpha", &because)?,
        },
        _ => ContactDamping::None,
    })
}

/// Friction coefficient and regularisation speed (m/s) between balls; defaults count as used if balls can meet.
pub(crate) fn ball_friction(
    reader: &mut Reader,
    balls_meet: bool,
) -> Result<Option<[f64; 2]>, SceneError> {
    let given = reader.choice_if_given("ball_contact.law");
    if given == Some("none") {
        return Ok(None);
    }
    let [friction, speed] = ["ball_contact.friction", "ball_contact.regularisation_speed"];
    if !balls_meet {
        let value = |path, usual| reader.given_number(path).unwrap_or(usual);
        return Ok(Some([value(friction, 0.1), value(speed, 0.01)]));
    }
    if given.is_none() {
        reader.note_default("ball_contact.law");
    }
    Ok(Some([reader.number(friction).unwrap_or(0.1), reader.number(speed).unwrap_or(0.01)]))
}
