//! What is simulated, as lists: rigid bodies, the bearings that join them, solids reduced to some shapes and the
//! seats in them, shafts that bend, gravity.
//!
//! A bearing takes hold of its two bodies at a place along each (a [`Mount`]); several may take hold of
//! one body, as two bearings of a shaft do. The order of the lists is the order of every sum.

use crate::assembly::loads::{CageBody, Drive, DrivenBody, DynamicProblem, RotatingLoad, Rotation};
use crate::assembly::mount::Mount;
use crate::ch2_housing::bearing::ball_contact::BallContactLaw;
use crate::ch2_housing::bearing::cage::CageContacts;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch3_bushing::dent::Dent;
use crate::equilibrium::initial::given_speed;
use crate::members::connection::Connection;
use crate::members::flexible_shaft::ElasticShaft;
use crate::members::housing_fit::Seat;
use crate::members::reduced_solid::ReducedSolid;
use crate::members::sensor::Sensor;
use crate::motion::validity::{HERTZ_SCALE, cage_room};
use crate::numeric::profile::Profile;
use std::f64::consts::PI;

/// SI units, inertial axes X axial, Y lateral, Z up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assembly {
    pub bodies: Vec<Body>,
    pub bearings: Vec<Bearing>,
    /// Between bodies, besides the bearings.
    pub connections: Vec<Connection>,
    /// Flexible solids with inertia.
    pub solids: Vec<ReducedSolid>,
    /// Rigid bodies in the bores of solids.
    pub seats: Vec<Seat>,
    /// Bodies that bend, at most one entry each.
    pub shafts: Vec<ElasticShaft>,
    /// They watch a motion and change nothing of it.
    pub sensors: Vec<Sensor>,
    /// m/s².
    pub gravity: [f64; 3],
}

/// A rigid body with an axis of symmetry: a race, a shaft with all that sits on it, a cage.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// As messages name it: "the inner race".
    pub name: String,
    /// Before the names of its own columns; `None` for a race, whose columns are its bearing's.
    pub label: Option<String>,
    pub mobility: Mobility,
    /// Position x, y, z (m) and tilts (rad) at which springs to the ground are at rest.
    pub rest: [f64; 5],
    pub rotating_load: Option<RotatingLoad>,
    /// kg·m, at the body's spin angle.
    pub unbalance: f64,
}

/// Name of a body that stands for what does not move.
pub const GROUND: &str = "the ground";

/// How a body may move.
#[derive(Clone, Debug, PartialEq)]
pub enum Mobility {
    /// Not at all: it stands at its rest position and has no equations.
    Fixed,
    /// Under loads and given motions of its coordinates.
    Driven(Box<DrivenBody>),
    /// Under its contacts and its weight alone.
    Free(Inertia),
}

impl Body {
    /// `None` where it is fixed.
    pub fn inertia(&self) -> Option<&Inertia> {
        match &self.mobility {
            Mobility::Fixed => None,
            Mobility::Driven(race) => Some(&race.inertia),
            Mobility::Free(inertia) => Some(inertia),
        }
    }

    pub fn driven(&self) -> Option<&DrivenBody> {
        match &self.mobility {
            Mobility::Driven(race) => Some(race),
            Mobility::Fixed | Mobility::Free(_) => None,
        }
    }

    pub fn driven_mut(&mut self) -> Option<&mut DrivenBody> {
        match &mut self.mobility {
            Mobility::Driven(race) => Some(race),
            Mobility::Fixed | Mobility::Free(_) => None,
        }
    }

    pub fn moves(&self) -> bool {
        self.mobility != Mobility::Fixed
    }

    /// Holds it where it rests. One that turns at a given speed goes on turning, since balls roll with it.
    pub fn hold(&mut self) {
        let turns = given_speed(self, 0.0) != 0.0;
        match &mut self.mobility {
            Mobility::Driven(race) if turns => {
                race.drives = self.rest.map(|at| Drive::Motion(Profile::Constant(at)));
                (race.foundation_stiffness, race.foundation_damping) = ([0.0; 5], [0.0; 5]);
            }
            mobility => *mobility = Mobility::Fixed,
        }
    }
}

/// Balls between two races, and perhaps a cage.
#[derive(Clone, Debug, PartialEq)]
pub struct Bearing {
    /// As messages name it; `None` where there is one only.
    pub name: Option<String>,
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    pub ball: Inertia,
    /// Inner race, outer race.
    pub mounts: [Mount; 2],
    pub cage: Option<Caged>,
    /// rad, azimuth of ball 1 in the outer race's axes, from +Y towards +Z.
    pub ball_phase: f64,
    pub traction: TractionLaw,
    /// Slices across the contact ellipse.
    pub slices: usize,
    /// Points across each slice.
    pub points_across: usize,
    pub damping: ContactDamping,
    /// Between neighbouring balls; `None` lets them pass into each other, which ends the run.
    pub ball_contact: Option<BallContactLaw>,
    /// In its races.
    pub dents: Vec<Dent>,
}

/// The body that keeps balls apart, and its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Caged {
    /// Index in [`Assembly::bodies`].
    pub body: usize,
    pub contacts: CageContacts,
}

impl Caged {
    /// How far a ball may be off the middle of its pocket, m.
    pub fn room(&self, bearing: &Bearing) -> f64 {
        self.contacts.pocket_radius - bearing.geometry.ball_radius
    }
}

impl Bearing {
    /// "left_", before the names of columns; nothing where there is one only.
    pub fn prefix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!("{name}_"))
    }

    /// " of bearing left", for messages; nothing where there is one only.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"))
    }

    /// Whether neighbouring balls can meet.
    pub fn ball_meeting(&self) -> BallMeeting {
        if self.ball_contact.is_none() {
            return BallMeeting::NoLaw;
        }
        let kept =
            self.cage.as_ref().and_then(|cage| gap_in_pockets(&self.geometry, &cage.contacts));
        kept.map_or(BallMeeting::Tested, |gap| BallMeeting::KeptApart { gap })
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
/// in its pocket's wall, and the cage no farther off the axis, than any run goes on with.
pub fn gap_in_pockets(geometry: &BearingGeometry, cage: &CageContacts) -> Option<f64> {
    let radius = geometry.ball_radius;
    let aside = cage.pocket_radius - radius + HERTZ_SCALE * radius;
    let pitch = geometry.pitch_radius.min(cage.pocket_pitch_radius);
    let (sin, cos) = libm::sincos(PI / geometry.ball_count as f64);
    let inmost = pitch - INWARDS * radius - aside - cage_room(geometry, cage);
    Some(2.0 * (inmost * sin - aside * cos - radius)).filter(|gap| *gap > 0.0)
}

impl DrivenBody {
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

    fn begin_at(&mut self, t0: f64) {
        for drive in &mut self.drives {
            let (Drive::Load(profile) | Drive::Motion(profile)) = drive;
            *profile = profile.from_time(t0);
        }
        let (Rotation::Torque(profile) | Rotation::Speed(profile)) = &mut self.rotation;
        *profile = profile.from_time(t0);
    }
}

impl Assembly {
    /// Where a bearing sits along X, m: where its inner race does. What is said of its parts counts from there.
    pub fn place_of(&self, bearing: &Bearing) -> f64 {
        let [inner, _] = &bearing.mounts;
        self.bodies[inner.body].rest[0] + inner.along
    }

    /// From where X of a body counts, m: a race that is a body of its own from its bearing's place, as all of it.
    pub fn origin_of(&self, body: usize) -> f64 {
        let sits = |bearing: &&Bearing| bearing.mounts.iter().any(|mount| mount.body == body);
        match self.bearings.iter().find(sits) {
            Some(bearing) if self.bodies[body].label.is_none() => self.place_of(bearing),
            // One that bends stands where its mass has its centre.
            _ if self.shafts.iter().any(|shaft| shaft.body == body) => self.bodies[body].rest[0],
            _ => 0.0,
        }
    }

    fn driven(&self) -> impl Iterator<Item = &DrivenBody> {
        self.bodies.iter().filter_map(Body::driven)
    }

    fn rotating_loads(&self) -> impl Iterator<Item = &RotatingLoad> {
        self.bodies.iter().filter_map(|body| body.rotating_load.as_ref())
    }

    /// Loads on solids, and radii of races in their seats.
    fn of_solids(&self) -> impl Iterator<Item = &Profile> {
        let loads = self.solids.iter().flat_map(|solid| &solid.loads).map(|load| &load.profile);
        loads.chain(self.seats.iter().map(|seat| &seat.radius))
    }

    /// Loads at places along shafts.
    fn on_shafts(&self) -> impl Iterator<Item = &Profile> {
        self.shafts.iter().flat_map(|shaft| &shaft.loads).flat_map(|load| &load.force)
    }

    /// Times after t = 0 at which a load or a given motion has a corner, in order, each once: no
    /// step should cross them.
    pub fn corners(&self) -> Vec<f64> {
        let turning = self.rotating_loads().flat_map(|load| [&load.force, &load.speed]);
        let profiles = self.driven().flat_map(|race| race.loads().chain(race.given()));
        let profiles = profiles.chain(turning).chain(self.of_solids()).chain(self.on_shafts());
        let mut corners: Vec<f64> = profiles.flat_map(Profile::corners).collect();
        corners.retain(|time| *time > 0.0 && time.is_finite());
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        corners
    }

    /// The same with loads and given motions as they are from `t0` (s) on.
    pub fn from_time(&self, t0: f64) -> Assembly {
        let mut later = self.clone();
        for body in &mut later.bodies {
            if let Some(race) = body.driven_mut() {
                race.begin_at(t0);
            }
            if let Some(load) = &mut body.rotating_load {
                *load = RotatingLoad {
                    phase: load.angle(t0),
                    force: load.force.from_time(t0),
                    speed: load.speed.from_time(t0),
                };
            }
        }
        for load in later.solids.iter_mut().flat_map(|solid| &mut solid.loads) {
            load.profile = load.profile.from_time(t0);
        }
        for load in later.shafts.iter_mut().flat_map(|shaft| &mut shaft.loads) {
            load.force.iter_mut().for_each(|profile| *profile = profile.from_time(t0));
        }
        for seat in &mut later.seats {
            seat.radius = seat.radius.from_time(t0);
        }
        later
    }

    /// The same with every body that sits in a solid held where it rests, and no solid: what is left to find an
    /// equilibrium of.
    pub fn with_seats_held(&self) -> Assembly {
        let mut held = self.clone();
        for seat in held.seats.drain(..) {
            held.bodies[seat.race.body].hold();
        }
        held.solids.clear();
        held
    }

    /// Whether a given motion has a corner at `time`, so that velocities may jump.
    pub fn jolts_at(&self, time: f64) -> bool {
        let mut given = self.driven().flat_map(DrivenBody::given);
        given.any(|profile| profile.corners().contains(&time))
    }
}

/// Bodies of a bearing alone, in this order.
pub const INNER: usize = 0;
pub const OUTER: usize = 1;
pub const CAGE: usize = 2;

impl From<DynamicProblem> for Assembly {
    fn from(problem: DynamicProblem) -> Assembly {
        Assembly::from(&problem)
    }
}

impl From<&DynamicProblem> for Assembly {
    /// A bearing alone: inner race, outer race, and the cage if there is one.
    fn from(problem: &DynamicProblem) -> Assembly {
        let body = |name: &str, mobility| Body {
            name: name.into(),
            label: None,
            mobility,
            rest: [0.0; 5],
            rotating_load: None,
            unbalance: 0.0,
        };
        let inner = Body {
            rotating_load: problem.rotating_load.clone(),
            unbalance: problem.unbalance,
            ..body("the inner race", Mobility::Driven(problem.inner.clone().into()))
        };
        let mobility =
            problem.outer.clone().map_or(Mobility::Fixed, |outer| Mobility::Driven(outer.into()));
        let outer = Body { rest: problem.outer_start, ..body("the outer race", mobility) };
        let mut bodies = vec![inner, outer];
        let cage = problem.cage.as_ref().map(|CageBody { inertia, contacts }| {
            bodies.push(body("the cage", Mobility::Free(*inertia)));
            Caged { body: CAGE, contacts: *contacts }
        });
        let bearing = Bearing {
            name: None,
            geometry: problem.geometry,
            inner_contact: problem.inner_contact,
            outer_contact: problem.outer_contact,
            ball: problem.ball,
            mounts: [INNER, OUTER].map(Mount::at_centre),
            cage,
            ball_phase: problem.ball_phase,
            traction: problem.traction.clone(),
            slices: problem.slices,
            points_across: problem.points_across,
            damping: problem.damping,
            ball_contact: problem.ball_contact,
            dents: problem.dents.clone(),
        };
        Assembly {
            bodies,
            bearings: vec![bearing],
            connections: Vec::new(),
            solids: Vec::new(),
            seats: Vec::new(),
            shafts: Vec::new(),
            sensors: Vec::new(),
            gravity: problem.gravity,
        }
    }
}
