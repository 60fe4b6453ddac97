//! Traction and damping between balls and races, friction between balls.

use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::Reader;
use crate::scene::text::units::plain;
use crate::scene::text::value::Checked;

pub(crate) fn traction(reader: &mut Reader) -> Result<TractionLaw, SceneError> {
    let law = reader.choice("traction.law");
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
            entrainment_floor: reader.number("traction.entrainment_floor"),
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
                let reason = format!("{unit}. Hint: write {name} = {example}");
                return Err(reader.document.refused(path, reason));
            }
            None if kind == 1 => {
                return Err(
                    reader.missing(path, " with `law = \"slip-speed\"`, whose b and c are in s/m")
                );
            }
            None => {
                let reason = "common boundary-lubrication set; the source's curve is not printed";
                let value = *value;
                reader.note(path, &plain(value), reason).fill(path, value);
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
        let problem = Problem::Contradiction(format!(
            "the friction curve rises to {peak:.3}. Allowed: up to 2. Hint: the rise `b` is too large for the decay `c`"
        ));
        Err(reader.document.error("traction.b", problem))
    }
}

pub(crate) fn damping(reader: &mut Reader) -> Result<ContactDamping, SceneError> {
    let law = reader.choice("contact_damping.law");
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
    Ok(Some([reader.number(friction), reader.number(speed)]))
}
