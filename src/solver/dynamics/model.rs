//! What is simulated: bodies, contacts, loads and prescribed motions, as plain data.

use super::bounds::HERTZ_SCALE;
use crate::ch2_housing::bearing::ball_contact::BallContactLaw;
use crate::ch2_housing::bearing::cage::CageContacts;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::solver::profile::Profile;
use std::f64::consts::PI;

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

impl RaceBody {
    /// Profiles of what is given, not loaded: coordinates and the speed.
    fn given(&self) -> impl Iterator<Item = &Profile> {
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

    fn loads(&self) -> impl Iterator<Item = &Profile> {
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
    /// Between neighbouring balls; `None` lets them pass into each other, which ends the run.
    pub ball_contact: Option<BallContactLaw>,
    /// m/s².
    pub gravity: [f64; 3],
    pub rotating_load: Option<RotatingLoad>,
    /// Unbalance of the inner race, kg·m, at its spin angle.
    pub unbalance: f64,
}

impl DynamicProblem {
    fn races(&self) -> impl Iterator<Item = &RaceBody> {
        std::iter::once(&self.inner).chain(&self.outer)
    }

    /// Times after t = 0 at which a load or a given motion has a corner, in order, each once: no
    /// step should cross them.
    pub fn corners(&self) -> Vec<f64> {
        let turning = self.rotating_load.iter().flat_map(|load| [&load.force, &load.speed]);
        let profiles =
            self.races().flat_map(|race| race.loads().chain(race.given())).chain(turning);
        let mut corners: Vec<f64> = profiles.flat_map(Profile::corners).collect();
        corners.retain(|time| *time > 0.0 && time.is_finite());
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        corners
    }

    /// The same with loads and given motions as they are from `t0` (s) on.
    pub fn from_time(&self, t0: f64) -> DynamicProblem {
        let mut later = self.clone();
        for race in std::iter::once(&mut later.inner).chain(&mut later.outer) {
            for drive in &mut race.drives {
                match drive {
                    Drive::Load(profile) | Drive::Motion(profile) => {
                        *profile = profile.from_time(t0)
                    }
                }
            }
            match &mut race.rotation {
                Rotation::Torque(profile) | Rotation::Speed(profile) => {
                    *profile = profile.from_time(t0);
                }
            }
        }
        if let Some(load) = &mut later.rotating_load {
            let phase = load.angle(t0);
            *load = RotatingLoad {
                force: load.force.from_time(t0),
                speed: load.speed.from_time(t0),
                phase,
            };
        }
        later
    }

    /// Whether a load or a given motion changes over time; one that turns at a speed of its own does.
    pub fn changes(&self) -> bool {
        let mut own = self.races().flat_map(|race| race.loads().chain(race.given()));
        own.any(|profile| !matches!(profile, Profile::Constant(_))) || self.rotating_load.is_some()
    }

    /// Whether a given motion has a corner at `time`, so that velocities may jump.
    pub fn jolts_at(&self, time: f64) -> bool {
        let mut given = self.races().flat_map(RaceBody::given);
        given.any(|profile| profile.corners().contains(&time))
    }
}

/// Whether neighbouring balls can meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BallMeeting {
    /// Their contact is part of every evaluation.
    Tested,
    /// No law is given for it.
    NoLaw,
    /// The pockets keep them apart by at least `gap` (m).
    KeptApart { gap: f64 },
}

/// How far inside the pitch circle a ball may come for its pocket to keep it apart, in ball radii:
/// more than the grooves leave it, by far.
const INWARDS: f64 = 0.5;

/// The gap (m) that the pockets of a cage keep between neighbouring balls; `None` where they may meet.
///
/// Each ball stays on its side of the plane halfway between two pockets as long as it lies no deeper
/// in its pocket's wall than any run goes on with.
pub fn gap_in_pockets(geometry: &BearingGeometry, cage: &CageContacts) -> Option<f64> {
    let radius = geometry.ball_radius;
    let aside = cage.pocket_radius - radius + HERTZ_SCALE * radius;
    let pitch = geometry.pitch_radius.min(cage.pocket_pitch_radius);
    let (sin, cos) = libm::sincos(PI / geometry.ball_count as f64);
    let inmost = pitch - INWARDS * radius - aside;
    Some(2.0 * (inmost * sin - aside * cos - radius)).filter(|gap| *gap > 0.0)
}

impl DynamicProblem {
    pub fn ball_meeting(&self) -> BallMeeting {
        if self.ball_contact.is_none() {
            return BallMeeting::NoLaw;
        }
        let kept =
            self.cage.as_ref().and_then(|cage| gap_in_pockets(&self.geometry, &cage.contacts));
        kept.map_or(BallMeeting::Tested, |gap| BallMeeting::KeptApart { gap })
    }
}

/// First of the sorted `corners` after `time`.
pub fn next_corner(corners: &[f64], time: f64) -> Option<f64> {
    corners.get(corners.partition_point(|corner| *corner <= time)).copied()
}
