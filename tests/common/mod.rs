//! Bearings of the source's tables and random ones around them.
#![allow(dead_code)]

use bearing_dynamics::ch2_housing::bearing::geometry::{
    BearingGeometry, ClearanceThrough, Material,
};
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzModel, RaceSide, contact};
use bearing_dynamics::equilibrium::statics::StaticProblem;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::Condition;
use nalgebra::Vector3;

pub const FREE: [Condition; 5] = [Condition::Load(0.0); 5];

/// Tables 2.2, 3.5 and 4.1: the deep-groove bearing at a radial clearance in m.
pub fn table_4_1(clearance: f64) -> BearingGeometry {
    BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.953e-3)
        .with_radial_clearance(clearance, ClearanceThrough::Ball)
}

/// Table 5.3: the angular-contact bearing.
pub fn table_5_3() -> BearingGeometry {
    BearingGeometry::angular_contact(11, 30e-3, 6.6e-3, 6.6e-3, 5.953e-3, 35f64.to_radians())
}

pub fn problem(geometry: BearingGeometry, conditions: [Condition; 5]) -> StaticProblem {
    let steel = Material::STEEL;
    let side = |side| contact(HertzModel::HamrockBrewe, side, &geometry, &steel, &steel).unwrap();
    StaticProblem {
        geometry,
        inner_contact: side(RaceSide::Inner),
        outer_contact: side(RaceSide::Outer),
        ball_phase: 0.1,
        ball_mass: 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * geometry.ball_radius.powi(3),
        gravity: Vector3::zeros(),
        orbital_speed: 0.0,
        frame: Pose::identity(),
        outer_pose: Pose::identity(),
        conditions,
    }
}

/// A deep-groove bearing whose balls nearly fill the pitch circle: neighbours are `gap` (m) apart.
pub fn full_complement(balls: usize, gap: f64, clearance: f64) -> BearingGeometry {
    let radius = 5.953e-3;
    let pitch = (radius + 0.5 * gap) / (std::f64::consts::PI / balls as f64).sin();
    let (inner, outer) = (pitch - radius, pitch + radius);
    let through = ClearanceThrough::OuterRace;
    BearingGeometry::deep_groove(balls, inner, 6.013e-3, outer, 6.310e-3, radius)
        .with_radial_clearance(clearance, through)
}
