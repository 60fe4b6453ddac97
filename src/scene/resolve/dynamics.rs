//! Part of a scene for runs: bodies of the races, rotating loads, steps.

use crate::ch2_housing::bearing::geometry::{BearingGeometry, Material};
use crate::ch2_housing::bearing::inertia::{Inertia, grooved_ring};
use crate::equilibrium::statics::COORDINATE_NAMES;
use crate::members::bearing::gap_in_pockets;
use crate::members::body::{Drive, DrivenBody, RotatingLoad, Rotation};
use crate::motion::simulation::{Integrator, RunOptions, Start, Stepping};
use crate::numeric::profile::Profile;
use crate::plan::channels::ChannelGroup;
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::Reader;
use crate::scene::resolve::resolved::{
    Cage, CageInRun, Dimensions, Dynamics, RunSettings, Shoulder,
};
use crate::scene::resolve::{cage, contact, raceway_profile};
use crate::scene::text::units::plain;
use crate::scene::text::value::Checked;

/// Resolved parts.
pub(crate) struct Parts<'p> {
    pub geometry: &'p BearingGeometry,
    pub dimensions: &'p Dimensions,
    pub inner_material: &'p Material,
    pub outer_material: &'p Material,
    pub cage: Option<&'p Cage>,
}

pub(crate) fn dynamics(
    reader: &mut Reader,
    parts: &Parts,
    inner_drives: [Drive; 5],
) -> Result<Dynamics, SceneError> {
    let inner = DrivenBody {
        inertia: race_inertia(reader, parts, &INNER)?,
        drives: inner_drives,
        rotation: rotation(reader, "inner_race"),
        foundation_stiffness: [0.0; 5],
        foundation_damping: [0.0; 5],
    };
    let [of_inner, of_outer] = [&INNER, &OUTER].map(|side| {
        let given = shoulder(reader, parts, side, &format!("{}.shoulder_radius", side.geometry))?;
        let radius = given.unwrap_or_else(|| usual_shoulder(parts.dimensions, side));
        Ok(Shoulder { radius, given: given.is_some() })
    });
    let shoulders = [of_inner?, of_outer?];
    let outer = outer_race(reader, parts)?;
    let cage = cage::in_run(reader, parts.geometry, parts.cage)?;
    let flexible_cage = cage::flexible(reader, parts.geometry, &cage)?;
    let balls_meet = match &cage {
        CageInRun::Body(body) => gap_in_pockets(parts.geometry, &body.contacts).is_none(),
        CageInRun::LeftOut(_) => true,
    };
    let unbalance = reader.given_number("inner_race.unbalance").unwrap_or(0.0);
    check_unbalance(&inner, unbalance)
        .map_err(|problem| reader.document.error("inner_race.unbalance", problem))?;
    Ok(Dynamics {
        inner,
        shoulders,
        outer,
        cage,
        flexible_cage,
        rotating_load: rotating_load(reader, "inner_race")?,
        unbalance,
        traction: contact::traction(reader)?,
        // Checked by the key table: 1 to 201.
        slices: reader.number("traction.slices") as usize,
        // 1 to 9.
        points_across: reader.number("traction.points_across") as usize,
        differential_sliding: reader.boolean("traction.differential_sliding"),
        damping: contact::damping(reader)?,
        ball_friction: contact::ball_friction(reader, balls_meet)?,
        raceway_profiles: raceway_profile::profiles(reader, parts.geometry)?,
        ball_deviations: raceway_profile::ball_deviations(reader, parts.geometry)?,
        run: run(reader)?,
        plots: Vec::new(),
        defaults_used: Vec::new(),
    })
}

/// Speed or torque of the body of a table.
pub(crate) fn rotation(reader: &mut Reader, table: &str) -> Rotation {
    if let Some(torque) = reader.profile(&format!("{table}.torque")) {
        return Rotation::Torque(torque);
    }
    let speed = format!("{table}.speed");
    Rotation::Speed(reader.profile(&speed).unwrap_or_else(|| {
        reader.note(&speed, "0 rpm", "neither a speed nor a torque is given");
        Profile::ZERO
    }))
}

/// Springs (`stiffness`) or dashpots (`damping`) between the body of a table and the ground.
pub(crate) fn foundation(reader: &Reader, table: &str, what: &str) -> [f64; 5] {
    COORDINATE_NAMES.map(|name| {
        let path = format!("{table}.foundation.{what}.{name}");
        reader.given_number(&path).unwrap_or(0.0)
    })
}

pub(crate) fn rotating_load(
    reader: &mut Reader,
    table: &str,
) -> Result<Option<RotatingLoad>, SceneError> {
    let [force, speed, phase] =
        &["force", "speed", "phase"].map(|key| format!("{table}.rotating_load.{key}"));
    if ![force, speed, phase].iter().any(|key| reader.is_given(key)) {
        return Ok(None);
    }
    let Some(profile) = reader.profile(force) else {
        return Err(reader.missing(force, ""));
    };
    let Some(turning) = reader.profile(speed) else {
        return Err(reader.missing(speed, ""));
    };
    Ok(Some(RotatingLoad { force: profile, speed: turning, phase: reader.number(phase) }))
}

fn outer_race(reader: &mut Reader, parts: &Parts) -> Result<Option<DrivenBody>, SceneError> {
    let motion = reader.choice("outer_race.motion");
    if motion == "fixed" {
        refuse_motion(reader)?;
        return Ok(None);
    }
    let foundation_stiffness = foundation(reader, "outer_race", "stiffness");
    let foundation_damping = foundation(reader, "outer_race", "damping");
    if foundation_stiffness == [0.0; 5] {
        reader.note("outer_race.foundation", "none", "no spring supports the moving outer race");
    }
    Ok(Some(DrivenBody {
        inertia: race_inertia(reader, parts, &OUTER)?,
        drives: reader.drives("outer_race", parts.geometry.ball_radius)?,
        rotation: match motion {
            "5-dof" => Rotation::Speed(reader.profile("outer_race.speed").unwrap_or(Profile::ZERO)),
            _ => Rotation::Torque(reader.profile("outer_race.torque").unwrap_or(Profile::ZERO)),
        },
        foundation_stiffness,
        foundation_damping,
    }))
}

/// Refuses prescribed motions of a fixed race.
fn refuse_motion(reader: &Reader) -> Result<(), SceneError> {
    let keys = COORDINATE_NAMES.map(|name| drive_key("outer_race", name, false));
    let moves = |key: &&String| matches!(reader.document.value(key), Some(Checked::Profile(_)));
    match keys.iter().find(moves) {
        None => Ok(()),
        Some(key) => {
            Err(reader.document.refused(key, "the outer race is fixed. Hint: write motion = \"5-dof\" in [outer_race], or leave this out"))
        }
    }
}

/// Key of the load, or of the prescribed motion, along a coordinate.
pub(crate) fn drive_key(table: &str, coordinate: &str, load: bool) -> String {
    let key = match (coordinate.starts_with("tilt"), load) {
        (true, true) => "moment",
        (true, false) => "tilt",
        (false, true) => "load",
        (false, false) => "displacement",
    };
    format!("{table}.{coordinate}.{key}")
}

/// Keys of a race, and the side of its material.
struct Side {
    table: &'static str,
    geometry: &'static str,
    plain: &'static str,
    /// +1: material inside the groove.
    sign: f64,
}

const INNER: Side = Side {
    table: "inner_race",
    geometry: "bearing.inner_race",
    plain: "bearing.inner_race.bore_radius",
    sign: 1.0,
};
const OUTER: Side = Side {
    table: "outer_race",
    geometry: "bearing.outer_race",
    plain: "bearing.outer_race.outer_radius",
    sign: -1.0,
};

/// Default sizes as fractions of the ball diameter. Wall and length are those of Table 2.2: 3.574 mm and 20 mm with
/// balls of 11.91 mm.
const WALL: f64 = 0.30;
const LENGTH: f64 = 1.68;
/// Common height of a deep-groove bearing's shoulders.
const SHOULDER: f64 = 0.20;

/// As given, or of a ring with a groove of the race's sizes.
fn race_inertia(reader: &mut Reader, parts: &Parts, side: &Side) -> Result<Inertia, SceneError> {
    let inner = side.sign > 0.0;
    let added =
        if inner { reader.given_number("inner_race.added_mass").unwrap_or(0.0) } else { 0.0 };
    let shoulder_key = format!("{}.shoulder_radius", side.geometry);
    let given_shoulder = shoulder(reader, parts, side, &shoulder_key)?;
    let keys = ["mass", "axial", "transverse"].map(|key| format!("{}.inertia.{key}", side.table));
    if keys.iter().any(|key| reader.is_given(key)) {
        let because = " with the other entries of `inertia`";
        let [mass, axial, transverse] = keys.each_ref().map(|k| reader.required_number(k, because));
        let inertia = Inertia { mass: mass? + added, axial: axial?, transverse: transverse? };
        check_inertia(inertia.axial, inertia.transverse)
            .map_err(|problem| reader.document.error(&keys[1], problem))?;
        return Ok(inertia);
    }
    let sizes = parts.dimensions;
    let (race, raceway, given_plain, density) = if inner {
        let density = parts.inner_material.density;
        (&sizes.inner_race, &parts.geometry.inner, sizes.bore_radius, density)
    } else {
        let density = parts.outer_material.density;
        (&sizes.outer_race, &parts.geometry.outer, sizes.outer_radius, density)
    };
    let diameter = 2.0 * sizes.nominal_ball_radius;
    let plain_radius = given_plain.unwrap_or_else(|| {
        let radius = (race.radius - side.sign * WALL * diameter).max(0.5 * race.radius);
        let reason = "wall of 0.3 ball diameters behind the groove, as the outer race of Table 2.2";
        reader.note(side.plain, &millimetres(radius), reason);
        radius
    });
    let land = given_shoulder.unwrap_or_else(|| {
        let radius = usual_shoulder(sizes, side);
        let reason = "shoulders as high as 20 % of the ball diameter";
        reader.note(&shoulder_key, &millimetres(radius), reason);
        radius
    });
    let length = sizes.length.unwrap_or_else(|| {
        let length = LENGTH * diameter;
        let reason = "1.68 ball diameters, as in Table 2.2";
        reader.note("bearing.length", &millimetres(length), reason);
        length
    });
    let ring = grooved_ring(
        plain_radius,
        land,
        raceway.centre_radius,
        raceway.groove_radius,
        length,
        density,
    );
    let value = format!(
        "mass {:.4e} kg, axial {:.4e} kg m^2, transverse {:.4e} kg m^2",
        ring.mass, ring.axial, ring.transverse
    );
    let [mass, axial, transverse] = &keys;
    reader
        .note(&format!("{}.inertia", side.table), &value, "a grooved ring of the race's sizes")
        .fill(mass, ring.mass)
        .fill(axial, ring.axial)
        .fill(transverse, ring.transverse);
    Ok(Inertia { mass: ring.mass + added, ..ring })
}

fn usual_shoulder(sizes: &Dimensions, side: &Side) -> f64 {
    let race = if side.sign > 0.0 { &sizes.inner_race } else { &sizes.outer_race };
    race.radius + side.sign * SHOULDER * 2.0 * sizes.nominal_ball_radius
}

/// The given shoulder radius: beyond the groove bottom, short of the balls' centres.
fn shoulder(
    reader: &Reader,
    parts: &Parts,
    side: &Side,
    key: &str,
) -> Result<Option<f64>, SceneError> {
    let Some(value) = reader.given_number(key) else { return Ok(None) };
    let inner = side.sign > 0.0;
    let sizes = parts.dimensions;
    let bottom = if inner { sizes.inner_race.radius } else { sizes.outer_race.radius };
    let pitch = parts.geometry.pitch_radius;
    let order = |relation, other_name, other| {
        let advice = "a shoulder is beside the groove, lower than the balls' centres";
        let problem = Problem::order(value, relation, (other_name, other), advice);
        Err(reader.document.error(key, problem))
    };
    let (past_bottom, past_pitch) =
        if inner { ("more than", "less than") } else { ("less than", "more than") };
    if (value - bottom) * side.sign <= 0.0 {
        order(past_bottom, "the groove bottom's radius", bottom)
    } else if (pitch - value) * side.sign <= 0.0 {
        order(past_pitch, "the pitch radius", pitch)
    } else {
        Ok(Some(value))
    }
}

/// No body has I_axial > 2 I_transverse: ∫(y² + z²) ≤ ∫(x² + y²) + ∫(x² + z²). Both are equal but for rounding for a
/// flat disc.
pub(crate) fn check_inertia(axial: f64, transverse: f64) -> Result<(), Problem> {
    match axial <= 2.0 * transverse * (1.0 + 1e-9) {
        true => Ok(()),
        false => Err(Problem::Contradiction(format!(
            "a moment of inertia of {axial} kg m^2 about the axis is more than twice that across it ({transverse} kg m^2), which \
             is impossible for a rigid body. Allowed: up to {} kg m^2. Hint: were the two exchanged?",
            2.0 * transverse
        ))),
    }
}

/// An eccentric mass m at radius r, with u = m r, has a moment of inertia m r² = u²/m, which is part of the body's. A
/// prescribed speed needs no moment of inertia, and an equilibrium no inertia at all.
pub(crate) fn check_unbalance(race: &DrivenBody, unbalance: f64) -> Result<(), Problem> {
    let Inertia { mass, axial, .. } = race.inertia;
    let given = matches!(race.rotation, Rotation::Speed(_)) || mass == 0.0;
    match given || unbalance * unbalance < mass * axial {
        true => Ok(()),
        false => Err(Problem::Contradiction(format!(
            "an unbalance of {unbalance} kg m is impossible for a torque-driven body of {mass} kg with an axial moment of inertia \
             of {axial} kg m^2. Allowed: less than {:.4e} kg m, the square root of their product. Hint: check the units",
            (mass * axial).sqrt()
        ))),
    }
}

/// A length in mm, to six digits.
pub(crate) fn millimetres(metres: f64) -> String {
    let rounded: f64 = format!("{:.5e}", metres * 1e3).parse().unwrap_or(metres * 1e3);
    format!("{} mm", plain(rounded))
}

fn run(reader: &mut Reader) -> Result<Option<RunSettings>, SceneError> {
    let Some(end) = reader.given_number("numerics.end") else {
        return match reader.document.first_below("numerics") {
            Some(_) => Err(reader.missing("numerics.end", " with a [numerics] table")),
            None => Ok(None),
        };
    };
    let usual = RunOptions::default();
    let start = match reader.choice("numerics.start") {
        "nominal" => Start::Nominal,
        _ => Start::Equilibrium,
    };
    let Steps { integrator, stepping, by_plan } = steps(reader)?;
    let energy_limit = reader.given_number("numerics.energy_limit").unwrap_or_else(|| {
        let (limit, reason) = match stepping {
            Stepping::Fixed(_) | Stepping::FractionOfLimit(_) => {
                (usual.energy_limit, "1 % of the energy turned over")
            }
            Stepping::Accuracy(_) => (
                ENERGY_LIMIT_OF_CONTROL,
                 "error control bounds the motion; long steps resolve the work of a prescribed speed less accurately",
            ),
        };
        reader.number_or("numerics.energy_limit", limit, &plain(limit), reason)
    });
    let options = RunOptions { start, integrator, stepping, energy_limit, ..usual };
    let output_interval = within(reader, "numerics.output_interval", end)?.unwrap_or_else(|| {
        let interval = end / 1000.0;
        let value = format!("{} s", plain(interval));
        let reason = "a thousandth of the run";
        reader.number_or("numerics.output_interval", interval, &value, reason)
    });
    let window_start = within(reader, "output.window_start", end)?.unwrap_or_else(|| {
        let start = 0.5 * end;
        let reason = "means and spectra are taken over the second half of the run";
        reader.number_or("output.window_start", start, &format!("{} s", plain(start)), reason)
    });
    let channels = match reader.document.value("output.channels") {
        Some(Checked::Choices(names)) => {
            names.iter().filter_map(|name| ChannelGroup::from_name(name)).collect()
        }
        _ => ChannelGroup::DEFAULT.to_vec(),
    };
    Ok(Some(RunSettings {
        options,
        by_plan,
        end,
        output_interval,
        fields_interval: within(reader, "numerics.fields_interval", end)?,
        window_start,
        channels,
    }))
}

/// Energy limit with error control, as a fraction of the energy turned over: valid runs at an accuracy of 0.01 lose up
/// to 0.02, and an unstable one comes close to 1.
const ENERGY_LIMIT_OF_CONTROL: f64 = 0.2;

struct Steps {
    integrator: Integrator,
    stepping: Stepping,
    /// True if the plan chooses the integrator.
    by_plan: bool,
}

/// Without step and integrator: error control, by the method that the plan chooses. A step, or a fraction of the
/// largest stable one, means rk4.
fn steps(reader: &mut Reader) -> Result<Steps, SceneError> {
    let [step, fraction, accuracy] = ["step", "step_fraction", "accuracy"]
        .map(|name| reader.given_number(&format!("numerics.{name}")));
    let given = match reader.choice_if_given("numerics.integrator") {
        Some("dormand-prince") => Some(Integrator::DormandPrince),
        Some("rosenbrock") => Some(Integrator::Rosenbrock),
        Some(_) => Some(Integrator::RungeKutta),
        None => None,
    };
    // Coupling steps of a housing are shorter than the steps of error control.
    let in_housing = reader.choice_if_given("housing.method") == Some("explicit");
    let by_steps = step.is_some() || fraction.is_some() || (in_housing && accuracy.is_none());
    let by_plan = given.is_none() && !by_steps;
    let integrator = match given {
        Some(integrator) => integrator,
        None if by_steps => {
            let reason = match in_housing {
                true => "a housing in explicit steps limits them",
                false => "prescribed steps, as in the source",
            };
            reader.choice_or("numerics.integrator", "rk4", reason);
            Integrator::RungeKutta
        }
        // Until the plan has chosen.
        None => Integrator::Rosenbrock,
    };
    let estimates = integrator != Integrator::RungeKutta;
    let refuse = |key: &str, reason: &str| Err(reader.document.refused(key, reason));
    if accuracy.is_some() && !estimates {
        let reason = "the integrator rk4 has no estimate of its error. Hint: leave the integrator out, write \"rosenbrock\" or \"dormand-prince\", or give a step";
        return refuse("numerics.accuracy", reason);
    }
    if fraction.is_some() && estimates {
        let reason = "the stability limit is that of rk4. Hint: give accuracy or step instead, or write integrator = \"rk4\"";
        return refuse("numerics.step_fraction", reason);
    }
    let stepping = match (step, fraction, accuracy) {
        (Some(step), _, _) => Stepping::Fixed(step),
        (_, Some(fraction), _) => Stepping::FractionOfLimit(fraction),
        (_, _, Some(accuracy)) => Stepping::Accuracy(accuracy),
        _ if estimates => {
            let reason = "error in the races' motion of a thousandth of the largest overlap";
            Stepping::Accuracy(reader.number_or("numerics.accuracy", 1e-3, "0.001", reason))
        }
        _ => {
            let reason = "half the largest stable step";
            let fraction = reader.number_or("numerics.step_fraction", 0.5, "0.5", reason);
            Stepping::FractionOfLimit(fraction)
        }
    };
    Ok(Steps { integrator, stepping, by_plan })
}

/// A time within the run; a window must begin before the end.
pub(crate) fn within(reader: &Reader, key: &str, end: f64) -> Result<Option<f64>, SceneError> {
    let may_be_equal = key != "output.window_start";
    match reader.given_number(key) {
        Some(value) if value > end || (value == end && !may_be_equal) => {
            let problem = Problem::after_the_end(value, end, may_be_equal);
            Err(reader.document.error(key, problem))
        }
        given => Ok(given),
    }
}
