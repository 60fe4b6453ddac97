//! What is simulated: bodies, contacts, loads and prescribed motions, as plain data.

use crate::ch2_housing::bearing::cage::CageContacts;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::solver::profile::Profile;

/// One degree of freedom of a race: driven by a load, or its motion given.
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
    /// rad/s; the angle is its integral, so that a speed may ramp.
    pub speed: f64,
    /// rad.
    pub phase: f64,
}

/// A race with six degrees of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct RaceBody {
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
    pub inner: RaceBody,
    /// `None`: the outer race is fixed in space and has no equations.
    pub outer: Option<RaceBody>,
    /// Position x, y, z (m) and tilts (rad) of the outer race at the start.
    pub outer_start: [f64; 5],
    pub cage: Option<CageBody>,
    /// rad, azimuth of ball 1 from +Y towards +Z.
    pub ball_phase: f64,
    pub traction: TractionLaw,
    /// Slices across the contact ellipse.
    pub slices: usize,
    /// Whether the curvature of the contact surface across the groove makes its edges slide.
    pub heathcote: bool,
    pub damping: ContactDamping,
    /// m/s².
    pub gravity: [f64; 3],
    pub rotating_load: Option<RotatingLoad>,
    /// Unbalance of the inner race, kg·m, at its spin angle.
    pub unbalance: f64,
}
