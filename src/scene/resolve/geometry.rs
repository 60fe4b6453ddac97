//! Bearing geometry from whichever dimensions were given: Tables 2.2, 3.5 and 4.1 state both race
//! radii and the ball (deep-groove), Table 5.3 the pitch radius and contact angle (angular-contact).
//!
//! Radial clearance C = R_outer − R_inner − 2 r_ball, negative for interference.

use crate::ch2_housing::bearing::geometry::{
    BearingGeometry, BearingKind, ClearanceThrough, Raceway,
};
use crate::scene::error::{Problem, SceneError, mm, um};
use crate::scene::resolve::bearing::Reader;
use crate::scene::resolve::resolved::{Dimensions, RaceDimensions};

const INNER: &str = "bearing.inner_race.radius";
const OUTER: &str = "bearing.outer_race.radius";
const THROUGH: &str = "bearing.clearance.through";

/// Largest clearance, as a fraction of the ball radius: real ones are below 1 %.
const LARGEST_CLEARANCE: f64 = 0.05;
/// Largest rounding of a nominal size, as a fraction of the ball radius: more is another size.
const ROUNDED: f64 = 0.01;

pub(crate) fn geometry(
    reader: &mut Reader,
    kind: BearingKind,
) -> Result<(BearingGeometry, Dimensions), SceneError> {
    let balls = reader.required_number("bearing.balls", "")?;
    let sizes = match kind {
        BearingKind::DeepGroove => deep_groove(reader)?,
        BearingKind::AngularContact => angular_contact(reader)?,
    };
    // Checked by the key table: 3 to 200.
    let ball_count = balls as usize;
    check_ball_count(reader, ball_count, &sizes)?;
    check_bore(reader, &sizes)?;
    let geometry = BearingGeometry {
        kind,
        ball_count,
        ball_radius: sizes.ball,
        inner: sizes.inner,
        outer: sizes.outer,
        pitch_radius: sizes.pitch,
        contact_angle: sizes.contact_angle,
        radial_clearance: sizes.clearance,
    };
    let race = |radius: f64, raceway: &Raceway| RaceDimensions {
        radius,
        groove_radius: raceway.groove_radius,
        conformity: raceway.groove_radius / (2.0 * sizes.nominal_ball),
        osculation: sizes.nominal_ball / raceway.groove_radius,
    };
    let dimensions = Dimensions {
        nominal_ball_radius: sizes.nominal_ball,
        clearance_through: sizes.through,
        radial_clearance: sizes.clearance,
        diametral_clearance: 2.0 * sizes.clearance,
        inner_race: race(sizes.inner_radius, &sizes.inner),
        outer_race: race(sizes.outer_radius, &sizes.outer),
        bore_radius: reader.given_number("bearing.inner_race.bore_radius"),
        outer_radius: reader.given_number("bearing.outer_race.outer_radius"),
        length: reader.given_number("bearing.length"),
    };
    Ok((geometry, dimensions))
}

/// Lengths in m, after the clearance has been applied.
struct Sizes {
    ball: f64,
    nominal_ball: f64,
    inner: Raceway,
    outer: Raceway,
    /// Groove-bottom radii.
    inner_radius: f64,
    outer_radius: f64,
    pitch: f64,
    contact_angle: f64,
    clearance: f64,
    through: ClearanceThrough,
}

/// The given radius or half the given diameter.
fn given_ball(reader: &Reader) -> Option<f64> {
    let radius = reader.given_number("bearing.ball.radius");
    radius.or_else(|| reader.given_number("bearing.ball.diameter").map(|diameter| 0.5 * diameter))
}

/// The key of the ball's size.
fn ball_key(reader: &Reader) -> &'static str {
    if reader.is_given("bearing.ball.diameter") {
        "bearing.ball.diameter"
    } else {
        "bearing.ball.radius"
    }
}

/// Radial clearance, if given.
fn given_clearance(reader: &Reader) -> Option<f64> {
    let radial = reader.given_number("bearing.clearance.radial");
    radial.or_else(|| {
        reader.given_number("bearing.clearance.diametral").map(|diametral| 0.5 * diametral)
    })
}

fn clearance_key(reader: &Reader) -> &'static str {
    if reader.is_given("bearing.clearance.diametral") {
        "bearing.clearance.diametral"
    } else {
        "bearing.clearance.radial"
    }
}

fn through_of(word: &str) -> ClearanceThrough {
    match word {
        "inner-race" => ClearanceThrough::InnerRace,
        "outer-race" => ClearanceThrough::OuterRace,
        "races" => ClearanceThrough::Races,
        _ => ClearanceThrough::Ball,
    }
}

/// Groove radius from `groove_radius`, `conformity` or `osculation`; exactly one is given.
fn groove(reader: &Reader, race: &str, ball: f64, nominal: f64) -> Result<f64, SceneError> {
    let keys = ["groove_radius", "conformity", "osculation"].map(|k| format!("{race}.{k}"));
    let values = keys.each_ref().map(|key| reader.given_number(key));
    let (key, radius) = match values {
        [Some(radius), _, _] => (&keys[0], radius),
        [_, Some(conformity), _] => (&keys[1], conformity * 2.0 * nominal),
        [_, _, Some(osculation)] => (&keys[2], nominal / osculation),
        [None, None, None] => {
            return Err(reader.missing(&keys[0], " (or `conformity`, or `osculation`)"));
        }
    };
    let largest_ball = ball.max(nominal);
    if radius > largest_ball && radius <= 1.2 * ball {
        Ok(radius)
    } else {
        let (groove, ball) = (mm(radius), mm(largest_ball));
        contradiction(
            reader,
            key,
            format!(
                "the groove radius {groove} does not fit a ball radius of {ball}. Allowed: more than {ball} to {}. Hint: a groove \
             radius is 1.01 to 1.08 times the ball radius; was a diameter given?",
                mm(1.2 * largest_ball)
            ),
        )
    }
}

fn deep_groove(reader: &mut Reader) -> Result<Sizes, SceneError> {
    let through = deep_groove_through(reader)?;
    let (ball_given, clearance_given) = (given_ball(reader), given_clearance(reader));
    let (mut inner_given, mut outer_given) =
        (reader.given_number(INNER), reader.given_number(OUTER));
    // A catalogue gives pitch and ball: races that just touch the ball, then the clearance.
    let pitch_given = reader.given_number("bearing.pitch_radius");
    if let (None, None, Some(pitch), Some(ball)) =
        (inner_given, outer_given, pitch_given, ball_given)
    {
        inner_given = Some(pitch - ball);
        outer_given = Some(pitch + ball);
    }
    if let (Some(inner), Some(outer)) = (inner_given, outer_given)
        && outer <= inner
    {
        let (inner, outer) = (mm(inner), mm(outer));
        return contradiction(
            reader,
            OUTER,
            format!(
                "the groove bottom of the outer race ({outer}) is not outside that of the inner race ({inner}). Allowed: outer \
             radius more than {inner}. Hint: the radii are measured from the bearing axis; were they exchanged?"
            ),
        );
    }
    let need = |path: &str, because: &str| match path {
        INNER if inner_given.is_some() => Ok(inner_given.unwrap_or_default()),
        OUTER if outer_given.is_some() => Ok(outer_given.unwrap_or_default()),
        _ => reader.required_number(path, because),
    };
    let need_ball =
        |because: &str| ball_given.ok_or_else(|| reader.missing("bearing.ball.radius", because));
    let (inner, outer, ball, clearance);
    match (clearance_given, through) {
        (None, _) => {
            let because = " (needed together with the other radii, as no clearance is given)";
            inner = need(INNER, because)?;
            outer = need(OUTER, because)?;
            ball = need_ball(because)?;
            clearance = outer - inner - 2.0 * ball;
            let what = if clearance < 0.0 {
                "the ball is larger than the gap between the races: "
            } else {
                "the ball is much smaller than the gap between the races: "
            };
            let advice = "was a diameter given as a radius, or a wrong unit?";
            limit_clearance(reader, ball_key(reader), what, clearance, ball, advice)?;
        }
        (Some(given), ClearanceThrough::Ball) => {
            let because = " (both race radii are needed when the clearance sets the ball)";
            clearance = given;
            inner = need(INNER, because)?;
            outer = need(OUTER, because)?;
            ball = 0.5 * (outer - inner - clearance);
            if ball <= 0.0 {
                return no_room(reader, clearance_key(reader), outer - inner, clearance);
            }
        }
        (Some(given), ClearanceThrough::InnerRace) => {
            let because = " (needed when the clearance sets the inner race)";
            clearance = given;
            outer = need(OUTER, because)?;
            ball = need_ball(because)?;
            inner = outer - 2.0 * ball - clearance;
            if inner <= 0.0 {
                return no_room(reader, ball_key(reader), outer, clearance);
            }
        }
        (Some(given), ClearanceThrough::OuterRace) => {
            let because = " (needed when the clearance sets the outer race)";
            clearance = given;
            inner = need(INNER, because)?;
            ball = need_ball(because)?;
            outer = inner + 2.0 * ball + clearance;
        }
        (Some(given), ClearanceThrough::Races) => {
            let because = " (needed when the clearance sets both races)";
            clearance = given;
            ball = need_ball(because)?;
            let middle = 0.5 * (need(INNER, because)? + need(OUTER, because)?);
            inner = middle - ball - 0.5 * clearance;
            outer = middle + ball + 0.5 * clearance;
            if inner <= 0.0 {
                return no_room(reader, ball_key(reader), middle, clearance);
            }
        }
    }
    let advice = "check its unit and whether it is radial";
    limit_clearance(reader, clearance_key(reader), "", clearance, ball, advice)?;
    let nominal_sizes = [
        (ball_key(reader), ball_given, ball),
        (INNER, inner_given, inner),
        (OUTER, outer_given, outer),
    ];
    for (key, nominal, derived) in nominal_sizes {
        let nominal = nominal.unwrap_or(derived);
        let allowed = clearance.abs() + ROUNDED * ball;
        let is_near = (nominal - derived).abs() <= allowed;
        if !is_near {
            return contradiction(
                reader,
                key,
                format!(
                    "the nominal size {} differs from the {} that follows from the other sizes and the clearance. Allowed: \
                     {} to {}. Hint: check it, or leave it out so that it follows",
                    mm(nominal),
                    mm(derived),
                    mm(derived - allowed),
                    mm(derived + allowed)
                ),
            );
        }
    }
    let nominal_ball = ball_given.unwrap_or(ball);
    let inner_groove = groove(reader, "bearing.inner_race", ball, nominal_ball)?;
    let outer_groove = groove(reader, "bearing.outer_race", ball, nominal_ball)?;
    let pitch = reader.given_number("bearing.pitch_radius").unwrap_or(0.5 * (inner + outer));
    // A twentieth of the ball's radius is far more than clearance or rounding of a catalogue.
    let (half_way, slack) = (0.5 * (inner + outer), 0.05 * ball);
    let (least, most) = (half_way - slack, half_way + slack);
    if !(least..=most).contains(&pitch) {
        return contradiction(
            reader,
            "bearing.pitch_radius",
            format!(
                "the pitch radius {} is not half way between the races. Allowed: {} to {}. Hint: leave it out to place it half way",
                mm(pitch),
                mm(least),
                mm(most)
            ),
        );
    }
    reader.follow(INNER, inner_given.unwrap_or(inner));
    reader.follow(OUTER, outer_given.unwrap_or(outer));
    reader.follow("bearing.ball.radius", nominal_ball);
    reader.follow("bearing.pitch_radius", pitch);
    let raceway = |centre_radius: f64, groove_radius: f64| Raceway {
        centre_radius,
        centre_axial: 0.0,
        groove_radius,
    };
    Ok(Sizes {
        ball,
        nominal_ball,
        inner: raceway(inner + inner_groove, inner_groove),
        outer: raceway(outer - outer_groove, outer_groove),
        inner_radius: inner,
        outer_radius: outer,
        pitch,
        contact_angle: 0.0,
        clearance,
        through,
    })
}

/// The part that the clearance sets: as given; else the one part without size; else the ball.
fn deep_groove_through(reader: &mut Reader) -> Result<ClearanceThrough, SceneError> {
    if let Some(word) = reader.choice_if_given(THROUGH) {
        return Ok(through_of(word));
    }
    let (inner, outer) = (reader.is_given(INNER), reader.is_given(OUTER));
    let ball = given_ball(reader).is_some();
    let clearance = given_clearance(reader).is_some();
    let (word, reason) = match (clearance, inner, outer, ball) {
        (true, false, true, true) => ("inner-race", "the inner race is the part without a radius"),
        (true, true, false, true) => ("outer-race", "the outer race is the part without a radius"),
        (true, true, true, false) => ("ball", "the ball is the part without a size"),
        (true, ..) => {
            return Ok(through_of(reader.choice(THROUGH)));
        }
        // With all radii the clearance follows.
        (false, ..) => return Ok(ClearanceThrough::Ball),
    };
    Ok(through_of(reader.choice_or(THROUGH, word, reason)))
}

fn angular_contact(reader: &mut Reader) -> Result<Sizes, SceneError> {
    let because = " (an angular-contact bearing needs it)";
    let pitch = reader.required_number("bearing.pitch_radius", because)?;
    let angle = reader.required_number("bearing.contact_angle", because)?;
    let Some(nominal) = given_ball(reader) else {
        return Err(reader.missing("bearing.ball.radius", because));
    };
    let clearance = given_clearance(reader).unwrap_or_else(|| {
        let reason = "the parts just touch at the contact angle";
        reader.number_or("bearing.clearance.radial", 0.0, "0 um", reason)
    });
    let through = if clearance == 0.0 && !reader.is_given(THROUGH) {
        ClearanceThrough::Ball
    } else {
        through_of(reader.choice(THROUGH))
    };
    let advice = "check its unit and whether it is radial";
    limit_clearance(reader, clearance_key(reader), "", clearance, nominal, advice)?;

    // Grooves first fit the nominal ball; the ball in use is checked below.
    let inner_groove = groove(reader, "bearing.inner_race", nominal, nominal)?;
    let outer_groove = groove(reader, "bearing.outer_race", nominal, nominal)?;
    // Distance of the groove centres when the nominal ball touches both races.
    let centre_distance = inner_groove + outer_groove - 2.0 * nominal;
    // Beyond this the groove centres pass each other and the gap opens again.
    let least = -centre_distance * libm::cos(angle);
    if clearance <= least {
        return contradiction(
            reader,
            clearance_key(reader),
            format!(
                "the clearance {} is smaller than the contact angle allows. Allowed: more than {}. Hint: check its unit and sign",
                um(clearance),
                um(least)
            ),
        );
    }
    // The sizes do not depend on the number of balls; it is checked against them later.
    let touching =
        BearingGeometry::angular_contact(1, pitch, inner_groove, outer_groove, nominal, angle);
    let bearing = touching.with_radial_clearance(clearance, through);
    let ball = bearing.ball_radius;
    let (inner_radius, outer_radius) = bearing.race_radii();
    groove(reader, "bearing.inner_race", ball, nominal)?;
    groove(reader, "bearing.outer_race", ball, nominal)?;
    let sizes = Sizes {
        ball,
        nominal_ball: nominal,
        inner: bearing.inner,
        outer: bearing.outer,
        inner_radius,
        outer_radius,
        pitch,
        contact_angle: angle,
        clearance,
        through,
    };
    if !(sizes.inner_radius > 0.0 && sizes.outer.centre_radius > 0.0) {
        let least = pitch - sizes.inner_radius.min(sizes.outer.centre_radius);
        let other = ("the smallest for this ball and groove", least);
        let problem =
            Problem::order(pitch, "more than", other, "check the pitch radius and the ball");
        return Err(reader.document.error("bearing.pitch_radius", problem));
    }
    Ok(sizes)
}

fn limit_clearance(
    reader: &Reader,
    key: &str,
    what: &'static str,
    clearance: f64,
    ball_radius: f64,
    advice: &'static str,
) -> Result<(), SceneError> {
    if clearance.abs() <= LARGEST_CLEARANCE * ball_radius {
        return Ok(());
    }
    let limit = LARGEST_CLEARANCE * ball_radius;
    contradiction(
        reader,
        key,
        format!(
            "{what}radial clearance {} is beyond 5 % of the ball radius ({}). Allowed: {} to {}. Hint: {advice}",
            um(clearance),
            mm(ball_radius),
            um(-limit),
            um(limit)
        ),
    )
}

/// Neighbouring ball centres are 2 R_pitch sin(π/Z) apart, which must exceed a ball diameter.
fn check_ball_count(reader: &Reader, count: usize, sizes: &Sizes) -> Result<(), SceneError> {
    let fits =
        |count: usize| sizes.ball < sizes.pitch * libm::sin(std::f64::consts::PI / count as f64);
    if fits(count) {
        return Ok(());
    }
    let largest = (1..count).rev().find(|&count| fits(count)).unwrap_or(0);
    contradiction(
        reader,
        "bearing.balls",
        format!(
            "{count} balls of radius {} do not fit on a pitch radius of {}. Allowed: up to {largest} balls. Hint: fewer or smaller \
         balls, or check the races' radii",
            mm(sizes.ball),
            mm(sizes.pitch)
        ),
    )
}

fn check_bore(reader: &Reader, sizes: &Sizes) -> Result<(), SceneError> {
    const GROOVE: &str = "the groove bottom's radius";
    let [bore, rim] = ["bearing.inner_race.bore_radius", "bearing.outer_race.outer_radius"];
    if let Some(value) = reader.given_number(bore).filter(|bore| *bore >= sizes.inner_radius) {
        let other = (GROOVE, sizes.inner_radius);
        let problem = Problem::order(value, "less than", other, "was a diameter given?");
        return Err(reader.document.error(bore, problem));
    }
    if let Some(value) = reader.given_number(rim).filter(|rim| *rim <= sizes.outer_radius) {
        let other = (GROOVE, sizes.outer_radius);
        let problem = Problem::order(value, "more than", other, "the race surrounds its groove");
        return Err(reader.document.error(rim, problem));
    }
    Ok(())
}

fn contradiction<T>(reader: &Reader, key: &str, text: String) -> Result<T, SceneError> {
    Err(reader.document.error(key, Problem::Contradiction(text)))
}

fn no_room<T>(reader: &Reader, key: &str, gap: f64, clearance: f64) -> Result<T, SceneError> {
    contradiction(
        reader,
        key,
        format!(
            "the gap between the races ({}) leaves no room for a ball at a radial clearance of {}. Allowed: clearance less than the \
         gap. Hint: check the unit of the clearance",
            mm(gap),
            um(clearance)
        ),
    )
}
