//! Bearings of the source's tables as lengths, and what the program and the oracles make of them.
//!
//! Both sides start from the printed lengths and go their own way from there.

use std::f64::consts::PI;

use bearing_dynamics::ch2_housing::bearing::geometry::{
    BearingGeometry, ClearanceThrough, Material,
};
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzError, HertzModel, RaceSide, contact};
use bearing_dynamics::equilibrium::statics::StaticProblem;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::Condition;
use nalgebra::Vector3;

use crate::oracles::hertz::{self, ball_on_race};
use crate::oracles::statics::{Known, OracleBearing};

/// Lengths of a bearing in m, angle in rad, as a table gives them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    pub balls: usize,
    /// Distance of ball centres from the axis when both contacts just touch.
    pub pitch_radius: f64,
    pub inner_groove_radius: f64,
    pub outer_groove_radius: f64,
    /// Ball that just touches both races.
    pub ball_radius: f64,
    /// Zero for a deep-groove bearing.
    pub contact_angle: f64,
    /// Radial clearance.
    pub clearance: f64,
    /// The part whose size makes the clearance.
    pub through: ClearanceThrough,
}

/// Tables 2.2, 3.5 and 4.1: races of 20.047 and 31.953 mm; a ball of 5.953 mm just touches.
pub const DEEP_GROOVE: Lengths = Lengths {
    balls: 8,
    pitch_radius: 26.0e-3,
    inner_groove_radius: 6.013e-3,
    outer_groove_radius: 6.310e-3,
    ball_radius: 5.953e-3,
    contact_angle: 0.0,
    clearance: 0.0,
    through: ClearanceThrough::Ball,
};

/// Table 5.3.
pub const ANGULAR_CONTACT: Lengths = Lengths {
    balls: 11,
    pitch_radius: 30.0e-3,
    inner_groove_radius: 6.6e-3,
    outer_groove_radius: 6.6e-3,
    ball_radius: 5.953e-3,
    contact_angle: 35.0 * PI / 180.0,
    clearance: 0.0,
    through: ClearanceThrough::Ball,
};

/// Which Hertz solution both sides use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hertz {
    Fit,
    Exact,
}

/// What the program makes of the lengths: steel of 210 GPa and 0.3 throughout.
pub fn problem(
    lengths: &Lengths,
    model: Hertz,
    ball_phase: f64,
    conditions: [Condition; 5],
) -> Result<StaticProblem, HertzError> {
    let nominal = if lengths.contact_angle > 0.0 {
        BearingGeometry::angular_contact(
            lengths.balls,
            lengths.pitch_radius,
            lengths.inner_groove_radius,
            lengths.outer_groove_radius,
            lengths.ball_radius,
            lengths.contact_angle,
        )
    } else {
        BearingGeometry::deep_groove(
            lengths.balls,
            lengths.pitch_radius - lengths.ball_radius,
            lengths.inner_groove_radius,
            lengths.pitch_radius + lengths.ball_radius,
            lengths.outer_groove_radius,
            lengths.ball_radius,
        )
    };
    let geometry = nominal.with_radial_clearance(lengths.clearance, lengths.through);
    let model = match model {
        Hertz::Fit => HertzModel::HamrockBrewe,
        Hertz::Exact => HertzModel::Exact,
    };
    let steel = Material::STEEL;
    let side = |side| contact(model, side, &geometry, &steel, &steel);
    Ok(StaticProblem {
        geometry,
        inner_contact: side(RaceSide::Inner)?,
        outer_contact: side(RaceSide::Outer)?,
        ball_phase,
        ball_mass: steel.density * 4.0 / 3.0 * PI * geometry.ball_radius.powi(3),
        gravity: Vector3::zeros(),
        orbital_speed: 0.0,
        frame: Pose::identity(),
        outer_pose: Pose::identity(),
        conditions,
    })
}

/// What the independent solver makes of the same lengths, by formulas of its own.
pub fn oracle(lengths: &Lengths, model: Hertz, ball_phase: f64) -> OracleBearing {
    let Lengths { pitch_radius, inner_groove_radius: gi, outer_groove_radius: go, .. } = *lengths;
    let (nominal, angle) = (lengths.ball_radius, lengths.contact_angle);
    let mut inner = [pitch_radius + (gi - nominal) * angle.cos(), (gi - nominal) * angle.sin(), gi];
    let mut outer = [pitch_radius - (go - nominal) * angle.cos(), (nominal - go) * angle.sin(), go];
    let mut ball = nominal;
    // Radial travel by the clearance must stretch the line of groove centres to gi + go − 2 r.
    match lengths.through {
        ClearanceThrough::Ball => {
            let line = [inner[0] - outer[0] + lengths.clearance, inner[1] - outer[1]];
            ball = 0.5 * (gi + go - (line[0] * line[0] + line[1] * line[1]).sqrt());
        }
        ClearanceThrough::InnerRace => inner[0] -= lengths.clearance,
        ClearanceThrough::OuterRace => outer[0] += lengths.clearance,
        ClearanceThrough::Races => {
            inner[0] -= 0.5 * lengths.clearance;
            outer[0] += 0.5 * lengths.clearance;
        }
    }
    // Radii of the races along the contact normal at the nominal contact angle.
    let race = [inner[0] / angle.cos() - gi, outer[0] / angle.cos() + go];
    let modulus = hertz::effective_modulus(210e9, 0.3, 210e9, 0.3);
    let stiffness = |radii| match model {
        Hertz::Fit => hertz::hamrock_brewe(radii, 1.0, modulus).stiffness,
        Hertz::Exact => hertz::exact(radii, 1.0, modulus).stiffness,
    };
    let stiffnesses = [
        stiffness(ball_on_race(ball, race[0], gi, 1.0)),
        stiffness(ball_on_race(ball, race[1], go, -1.0)),
    ];
    OracleBearing::at_origin(lengths.balls, ball, inner, outer, stiffnesses, ball_phase)
}

/// The conditions as the independent solver reads them.
pub fn known(conditions: &[Condition; 5]) -> [Known; 5] {
    conditions.map(|condition| match condition {
        Condition::Load(load) => Known::Load(load),
        Condition::Displacement(value) => Known::Value(value),
    })
}
