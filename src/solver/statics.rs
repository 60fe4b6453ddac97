//! Static equilibrium of one bearing.

use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::kinematics::Pose;
use nalgebra::{SMatrix, SVector, Vector3};

/// The five coordinates of a race, in this order: x, y, z (m), tilt_y, tilt_z (rad). The tilts are
/// the Euler angles ξ and λ of (2.16) with η = 0.
pub const COORDINATE_NAMES: [&str; 5] = ["x", "y", "z", "tilt_y", "tilt_z"];

/// What is prescribed for one coordinate of the inner race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// Applied force (N) or moment (N·m) on the inner race; the coordinate is unknown.
    Load(f64),
    /// Given displacement (m) or tilt (rad); the reaction is unknown.
    Displacement(f64),
}

/// The two contacts of a ball and what acts on a ball besides them.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticProblem {
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    /// Azimuth of ball 1 in the outer race's frame, from +Y towards +Z, rad.
    pub ball_phase: f64,
    /// kg; only used with `gravity` or `orbital_speed`.
    pub ball_mass: f64,
    /// World axes, m/s².
    pub gravity: Vector3<f64>,
    /// Speed of the ball set about the bearing axis, rad/s (centrifugal force); 0 leaves it out.
    pub orbital_speed: f64,
    /// Frame in which the inner race's five coordinates and loads are measured, in the world.
    pub frame: Pose,
    /// Pose of the outer race in the world.
    pub outer_pose: Pose,
    /// Conditions on x, y, z, tilt_y, tilt_z of the inner race in `frame`.
    pub conditions: [Condition; 5],
}

/// One loaded or unloaded contact in the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactState {
    /// N.
    pub normal_load: f64,
    /// δ of (2.1), m; zero or negative when open (negative: gap).
    pub approach: f64,
    /// Angle of the contact normal to the race's radial plane, rad.
    pub contact_angle: f64,
    /// Semi-axes of the contact ellipse, m.
    pub semi_major: f64,
    pub semi_minor: f64,
    /// Largest contact pressure, Pa.
    pub peak_pressure: f64,
    /// Force on the race, in `frame`, N.
    pub force_on_race: Vector3<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallState {
    /// rad, in the outer race's frame.
    pub azimuth: f64,
    /// Ball centre in `frame`, m.
    pub position: Vector3<f64>,
    pub inner: ContactState,
    pub outer: ContactState,
}

/// Whether the loads determine the position.
#[derive(Clone, Debug, PartialEq)]
pub enum Determinacy {
    Determinate,
    /// The position is one of many: these directions (unit vectors over the five coordinates,
    /// tilts multiplied by the pitch radius) meet no stiffness.
    Indeterminate {
        free_directions: Vec<SVector<f64, 5>>,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct StaticSolution {
    /// x, y, z (m), tilt_y, tilt_z (rad) of the inner race in `frame`.
    pub coordinates: SVector<f64, 5>,
    /// Loads that hold the inner race there: N, N, N, N·m, N·m (energy-conjugate to the coordinates).
    pub loads: SVector<f64, 5>,
    /// ∂loads/∂coordinates, symmetric, SI units.
    pub stiffness: SMatrix<f64, 5, 5>,
    /// Sum of contact forces on the inner race and their moment about its centre, in `frame`.
    pub force_on_inner: Vector3<f64>,
    pub moment_on_inner: Vector3<f64>,
    /// Sum of contact forces on the outer race and their moment about its centre, in `frame`.
    pub force_on_outer: Vector3<f64>,
    pub moment_on_outer: Vector3<f64>,
    pub balls: Vec<BallState>,
    pub determinacy: Determinacy,
    /// Newton iterations on the race's coordinates.
    pub iterations: usize,
    /// Evaluations of one ball–race contact law.
    pub contact_evaluations: usize,
    /// Largest unbalanced load over the free coordinates (moments divided by the pitch radius), N.
    pub residual: f64,
}
