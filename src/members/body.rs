//! Rigid bodies, their loads and prescribed motions.

use crate::ch2_housing::bearing::inertia::Inertia;
use crate::numeric::profile::Profile;

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

impl DrivenBody {
    /// Profiles of prescribed coordinates and of the speed.
    pub(crate) fn given(&self) -> impl Iterator<Item = &Profile> {
        let coordinates = self.drives.iter().filter_map(|drive| match drive {
            Drive::Motion(profile) => Some(profile),
            Drive::Load(_) => None,
        });
        let speed = match &self.rotation {
            Rotation::Speed(profile) => Some(profile),
            Rotation::Torque(_) => None,
        };
        coordinates.chain(speed)
    }

    pub(crate) fn loads(&self) -> impl Iterator<Item = &Profile> {
        let coordinates = self.drives.iter().filter_map(|drive| match drive {
            Drive::Load(profile) => Some(profile),
            Drive::Motion(_) => None,
        });
        let torque = match &self.rotation {
            Rotation::Torque(profile) => Some(profile),
            Rotation::Speed(_) => None,
        };
        coordinates.chain(torque)
    }

    pub(crate) fn begin_at(&mut self, t0: f64) {
        for drive in &mut self.drives {
            let (Drive::Load(profile) | Drive::Motion(profile)) = drive;
            *profile = profile.from_time(t0);
        }
        let (Rotation::Torque(profile) | Rotation::Speed(profile)) = &mut self.rotation;
        *profile = profile.from_time(t0);
    }
}

/// An axisymmetric rigid body: a race, a shaft with all that is mounted on it, a cage.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name in messages: "the inner race".
    pub name: String,
    /// Prefix of its own columns; `None` for a race, whose columns are its bearing's.
    pub label: Option<String>,
    pub mobility: Mobility,
    /// Position x, y, z (m) and tilts (rad) at which springs to the ground are unloaded.
    pub rest: [f64; 5],
    pub rotating_load: Option<RotatingLoad>,
    /// kg·m, at the body's rotation angle.
    pub unbalance: f64,
}

/// Name of the fixed body that represents the ground.
pub const GROUND: &str = "the ground";

/// Mobility of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum Mobility {
    /// Fixed at its rest position, without equations.
    Fixed,
    /// Under loads and prescribed motions of its coordinates.
    Driven(Box<DrivenBody>),
    /// Under its contacts and its weight alone.
    Free(Inertia),
    /// Follows a solid in explicit steps; without mass of its own.
    Carried,
}

impl Body {
    /// `None` for a fixed body.
    pub fn inertia(&self) -> Option<&Inertia> {
        match &self.mobility {
            Mobility::Fixed | Mobility::Carried => None,
            Mobility::Driven(race) => Some(&race.inertia),
            Mobility::Free(inertia) => Some(inertia),
        }
    }

    pub fn driven(&self) -> Option<&DrivenBody> {
        match &self.mobility {
            Mobility::Driven(race) => Some(race),
            Mobility::Fixed | Mobility::Free(_) | Mobility::Carried => None,
        }
    }

    pub fn driven_mut(&mut self) -> Option<&mut DrivenBody> {
        match &mut self.mobility {
            Mobility::Driven(race) => Some(race),
            Mobility::Fixed | Mobility::Free(_) | Mobility::Carried => None,
        }
    }

    pub fn moves(&self) -> bool {
        self.mobility != Mobility::Fixed
    }

    /// Fixes the body at its rest position. A prescribed speed stays, since balls roll with it.
    pub fn fix(&mut self) {
        let turns = prescribed_speed(self, 0.0) != 0.0;
        match &mut self.mobility {
            Mobility::Driven(race) if turns => {
                race.drives = self.rest.map(|at| Drive::Motion(Profile::Constant(at)));
                (race.foundation_stiffness, race.foundation_damping) = ([0.0; 5], [0.0; 5]);
            }
            mobility => *mobility = Mobility::Fixed,
        }
    }
}

/// What is prescribed for one coordinate of the inner race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// Applied force (N) or moment (N·m) on the inner race; the coordinate is unknown.
    Load(f64),
    /// Prescribed displacement (m) or tilt (rad); the reaction is unknown.
    Displacement(f64),
}

/// Largest displacement of a bearing from the rest position of its outer race, m. Soft springs deflect by millimetres,
/// nothing sound by a metre.
pub const FARTHEST: f64 = 1.0;

/// Coordinates of a body if all are prescribed.
pub(crate) fn all_prescribed(race: &DrivenBody, t: f64) -> Option<[f64; 5]> {
    let mut at = [0.0; 5];
    for (at, drive) in at.iter_mut().zip(&race.drives) {
        let Drive::Motion(profile) = drive else { return None };
        *at = profile.value(t);
    }
    Some(at)
}

/// Returns whether a body has no unknown.
pub(crate) fn is_fixed(body: &Body) -> bool {
    body.driven().is_none_or(|race| all_prescribed(race, 0.0).is_some())
}

/// Prescribed speed of a body about its own axis at `t`, rad/s; zero for a torque drive or a fixed body.
pub fn prescribed_speed(body: &Body, t: f64) -> f64 {
    match body.driven().map(|race| &race.rotation) {
        Some(Rotation::Speed(profile)) => profile.value(t),
        Some(Rotation::Torque(_)) | None => 0.0,
    }
}

/// Angle of the prescribed rotation of a body since t = 0, rad.
pub(crate) fn prescribed_angle(body: &Body, t: f64) -> f64 {
    match body.driven().map(|race| &race.rotation) {
        Some(Rotation::Speed(profile)) => profile.integral(t),
        Some(Rotation::Torque(_)) | None => 0.0,
    }
}
