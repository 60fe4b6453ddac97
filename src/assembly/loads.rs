//! Loads and prescribed motions of bodies, and a bearing alone as plain data.

use crate::assembly::lists::{Assembly, INNER};
use crate::ch2_housing::bearing::ball_contact::BallContactLaw;
use crate::ch2_housing::bearing::cage::CageContacts;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch5_cage::raceway_profile::RacewayProfile;
use crate::equilibrium::initial::{conditions, orbital_speed};
use crate::equilibrium::statics::StaticProblem;
use crate::kinematics::Pose;
use crate::kinematics::euler::quaternion;
use crate::numeric::profile::Profile;
use nalgebra::Vector3;

/// One degree of freedom of a race, with a load or a prescribed motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// Force (N) or moment (N·m).
    Load(Profile),
    /// Displacement (m) or tilt (rad) over time.
    Motion(Profile),
}

/// Rotation of a race about its own axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Rotation {
    /// Moment about the axis, N·m.
    Torque(Profile),
    /// Speed, rad/s.
    Speed(Profile),
}

/// A rotating radial force on the inner race, starting at +Y and turning towards +Z.
#[derive(Clone, Debug, PartialEq)]
pub struct RotatingLoad {
    /// N.
    pub force: Profile,
    /// rad/s.
    pub speed: Profile,
    /// rad, at t = 0.
    pub phase: f64,
}

impl RotatingLoad {
    /// Direction at time `t`, rad from +Y towards +Z: the phase and the integral of the speed.
    pub fn angle(&self, t: f64) -> f64 {
        self.phase + self.speed.integral(t)
    }

    /// Force on X, Y, Z at time `t`, N.
    pub fn force(&self, t: f64) -> [f64; 3] {
        let (sin, cos) = libm::sincos(self.angle(t));
        let size = self.force.value(t);
        [0.0, size * cos, size * sin]
    }
}

/// A race with six degrees of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenBody {
    pub inertia: Inertia,
    /// x, y, z, tilt_y, tilt_z.
    pub drives: [Drive; 5],
    pub rotation: Rotation,
    /// Spring to the ground on x, y, z (N/m) and the tilts (N·m/rad).
    pub foundation_stiffness: [f64; 5],
    /// Dashpot to the ground on x, y, z (N·s/m) and the tilts (N·m·s/rad).
    pub foundation_damping: [f64; 5],
}

/// The rigid cage.
#[derive(Clone, Debug, PartialEq)]
pub struct CageBody {
    pub inertia: Inertia,
    pub contacts: CageContacts,
}

/// A bearing in motion, SI units, inertial axes X axial, Y lateral, Z up.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicProblem {
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    pub ball: Inertia,
    pub inner: DrivenBody,
    /// `None`: the outer race is fixed in space and has no equations.
    pub outer: Option<DrivenBody>,
    /// Position x, y, z (m) and tilts (rad) of the outer race at the start.
    pub outer_start: [f64; 5],
    pub cage: Option<CageBody>,
    /// rad, azimuth of ball 1 from +Y towards +Z.
    pub ball_phase: f64,
    pub traction: TractionLaw,
    /// Slices across the contact ellipse.
    pub slices: usize,
    /// Points across each slice.
    pub points_across: usize,
    /// Differential sliding of a ball in its groove (Heathcote).
    pub differential_sliding: bool,
    pub damping: ContactDamping,
    /// Contact between neighbouring balls; without it interpenetrating balls end the run.
    pub ball_contact: Option<BallContactLaw>,
    /// Profiles of its races and balls.
    pub raceway_profiles: Vec<RacewayProfile>,
    /// Excess of each ball's radius, m; empty for equal balls.
    pub ball_deviations: Vec<f64>,
    /// m/s².
    pub gravity: [f64; 3],
    pub rotating_load: Option<RotatingLoad>,
    /// Unbalance of the inner race, kg·m, at its spin angle.
    pub unbalance: f64,
}

impl DynamicProblem {
    /// The bearing as lists of bodies and bearings.
    pub fn assembly(&self) -> Assembly {
        Assembly::from(self)
    }

    /// The bearing at time `t` with its outer race fixed at its start; a rotating load has its present direction,
    /// unbalance is omitted.
    pub fn statics(&self, t: f64) -> StaticProblem {
        let assembly = self.assembly();
        let [x, y, z, xi, lambda] = self.outer_start;
        StaticProblem {
            geometry: self.geometry,
            inner_contact: self.inner_contact,
            outer_contact: self.outer_contact,
            ball_phase: self.ball_phase,
            ball_mass: self.ball.mass,
            gravity: Vector3::from(self.gravity),
            orbital_speed: orbital_speed(&assembly, &assembly.bearings[0], t),
            frame: Pose::identity(),
            outer_pose: Pose {
                position: Vector3::new(x, y, z),
                orientation: quaternion(0.0, xi, lambda),
            },
            conditions: conditions(&assembly, &assembly.bodies[INNER], &self.inner, t),
        }
    }
}

/// First of the sorted `corners` after `time`.
pub fn next_corner(corners: &[f64], time: f64) -> Option<f64> {
    corners.get(corners.partition_point(|corner| *corner <= time)).copied()
}
