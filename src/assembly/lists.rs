//! The lists of a simulation: rigid bodies, bearings, reduced solids and housing fits, flexible shafts, connections,
//! gravity.
//!
//! A bearing has a [`Mount`] on each of its two bodies; several bearings may be on one body, as on a shaft. The order
//! of the lists is the order of every sum.

use crate::assembly::loads::{CageBody, Drive, DrivenBody, DynamicProblem, RotatingLoad, Rotation};
use crate::assembly::mount::Mount;
use crate::ch2_housing::bearing::ball_contact::BallContactLaw;
use crate::ch2_housing::bearing::cage::{CageContact, CageContacts, cage_stiffness};
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch5_cage::raceway_profile::RacewayProfile;
use crate::equilibrium::initial::prescribed_speed;
use crate::members::cage_nodes::CageNodes;
use crate::members::connection::Connection;
use crate::members::flexible_shaft::ElasticShaft;
use crate::members::floating_solid::FloatingSolid;
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
    /// Connections between bodies, without bearings.
    pub connections: Vec<Connection>,
    /// Flexible solids with inertia.
    pub solids: Vec<ReducedSolid>,
    /// Races in the bores of solids.
    pub seats: Vec<Seat>,
    /// Flexible bodies, at most one entry each.
    pub shafts: Vec<ElasticShaft>,
    /// Flexible solids on rotating bodies, at most one for each body.
    pub floating: Vec<FloatingSolid>,
    /// Sensors do not change the motion.
    pub sensors: Vec<Sensor>,
    /// m/s².
    pub gravity: [f64; 3],
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

/// Balls between two races, with or without a cage.
#[derive(Clone, Debug, PartialEq)]
pub struct Bearing {
    /// Name in messages; `None` for the only one.
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
    /// Differential sliding of a ball in its groove (Heathcote).
    pub differential_sliding: bool,
    pub damping: ContactDamping,
    /// Contact between neighbouring balls; without it interpenetrating balls end the run.
    pub ball_contact: Option<BallContactLaw>,
    /// Profiles of its races and balls.
    pub raceway_profiles: Vec<RacewayProfile>,
    /// Excess of each ball's radius, m; empty for equal balls.
    pub ball_deviations: Vec<f64>,
}

/// A cage and its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Caged {
    /// Index in [`Assembly::bodies`].
    pub body: usize,
    pub contacts: CageContacts,
    /// Contact by nodes of its mesh, instead of by the surfaces of `contacts`.
    pub nodes: Option<CageNodes>,
    /// True if the cage takes explicit steps of its own, contacts included; its body follows it.
    pub in_elements: bool,
}

impl Caged {
    /// Stiffness of a loaded contact, N/m; of nodes the sum of those that touch.
    pub fn stiffness(&self, contact: &CageContact) -> f64 {
        match &self.nodes {
            Some(_) => contact.normal_load / contact.penetration,
            None => cage_stiffness(&self.contacts.force, contact.penetration),
        }
    }

    /// Largest displacement of a ball from the middle of its pocket, m.
    pub fn room(&self, bearing: &Bearing) -> f64 {
        self.contacts.pocket_radius - bearing.geometry.ball_radius
    }
}

impl Bearing {
    /// Returns whether all balls have the nominal radius.
    pub fn has_equal_balls(&self) -> bool {
        self.ball_deviations.iter().all(|deviation| *deviation == 0.0)
    }

    /// Tests of profiles in one evaluation: each ball for a profile of a race, two contacts for a profile of a ball,
    /// two contacts of each ball for balls of different size.
    pub fn profile_tests(&self) -> u64 {
        let balls = self.geometry.ball_count;
        let felt = self.raceway_profiles.iter().filter(|profile| !profile.vanishes());
        let tests: usize = felt.map(|of| if of.is_on_ball() { 2 } else { balls }).sum();
        (tests + if self.has_equal_balls() { 0 } else { 2 * balls }) as u64
    }

    /// Prefix of column names: "left_"; empty for the only one.
    pub fn prefix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!("{name}_"))
    }

    /// Suffix in messages: " of bearing left"; empty for the only one.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"))
    }

    /// Returns whether neighbouring balls can meet.
    pub fn ball_meeting(&self) -> BallMeeting {
        if self.ball_contact.is_none() {
            return BallMeeting::NoLaw;
        }
        let kept =
            self.cage.as_ref().and_then(|cage| gap_in_pockets(&self.geometry, &cage.contacts));
        kept.map_or(BallMeeting::Tested, |gap| BallMeeting::KeptApart { gap })
    }
}

/// Contact between neighbouring balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BallMeeting {
    /// Tested in every evaluation.
    Tested,
    /// Without a contact law.
    NoLaw,
    /// Never: the pockets keep a gap (m).
    KeptApart { gap: f64 },
}

/// Largest displacement of a ball inside the pitch circle at which its pocket still keeps it apart, in ball radii; far
/// more than the grooves allow.
const INWARDS: f64 = 0.5;

/// Gap (m) that the pockets of a cage keep between neighbouring balls; `None` if balls may meet.
///
/// Each ball stays on its side of the plane halfway between two pockets as long as its depth in the pocket and the
/// displacement of the cage are within the limits of any run.
pub fn gap_in_pockets(geometry: &BearingGeometry, cage: &CageContacts) -> Option<f64> {
    let radius = geometry.ball_radius;
    let aside = cage.pocket_radius - radius + HERTZ_SCALE * radius;
    let pitch = geometry.pitch_radius.min(cage.pocket_pitch_radius);
    let (sin, cos) = libm::sincos(PI / geometry.ball_count as f64);
    let inmost = pitch - INWARDS * radius - aside - cage_room(geometry, cage);
    Some(2.0 * (inmost * sin - aside * cos - radius)).filter(|gap| *gap > 0.0)
}

impl DrivenBody {
    /// Profiles of prescribed coordinates and of the speed.
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
    /// Position of a bearing along X, m: that of its inner race. Positions of its parts are relative to it.
    pub fn place_of(&self, bearing: &Bearing) -> f64 {
        let [inner, _] = &bearing.mounts;
        self.bodies[inner.body].rest[0] + inner.along
    }

    /// Origin of X of a body, m: for a race that is a body of its own, its bearing's position.
    pub fn origin_of(&self, body: usize) -> f64 {
        let is_on_body = |bearing: &&Bearing| bearing.mounts.iter().any(|mount| mount.body == body);
        match self.bearings.iter().find(is_on_body) {
            Some(bearing) if self.bodies[body].label.is_none() => self.place_of(bearing),
            // A flexible body has the position of its centre of mass.
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

    /// Loads on solids, and radii of races in their bores.
    fn of_solids(&self) -> impl Iterator<Item = &Profile> {
        let loads = self.solids.iter().flat_map(|solid| &solid.loads).map(|load| &load.profile);
        loads.chain(self.seats.iter().map(|seat| &seat.radius))
    }

    /// Loads along shafts.
    fn on_shafts(&self) -> impl Iterator<Item = &Profile> {
        self.shafts.iter().flat_map(|shaft| &shaft.loads).flat_map(|load| &load.force)
    }

    /// Times after t = 0 of corners in loads and prescribed motions, ascending, without duplicates: no step should
    /// cross one.
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

    /// The assembly with loads and prescribed motions from `t0` (s) on.
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

    /// The assembly without solids, with every body in a solid fixed at its rest position: the part whose equilibrium
    /// is searched.
    pub fn with_seats_fixed(&self) -> Assembly {
        let mut held = self.clone();
        for seat in held.seats.drain(..) {
            held.bodies[seat.race.body].fix();
        }
        held.solids.clear();
        held
    }

    /// Returns whether a prescribed motion has a corner at `time`, so that velocities may jump.
    pub fn jolts_at(&self, time: f64) -> bool {
        let mut given = self.driven().flat_map(DrivenBody::given);
        given.any(|profile| profile.corners().contains(&time))
    }
}

/// Indices of the bodies of a bearing alone.
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
            Caged { body: CAGE, contacts: *contacts, nodes: None, in_elements: false }
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
            differential_sliding: problem.differential_sliding,
            damping: problem.damping,
            ball_contact: problem.ball_contact,
            raceway_profiles: problem.raceway_profiles.clone(),
            ball_deviations: problem.ball_deviations.clone(),
        };
        Assembly {
            bodies,
            bearings: vec![bearing],
            connections: Vec::new(),
            solids: Vec::new(),
            seats: Vec::new(),
            shafts: Vec::new(),
            floating: Vec::new(),
            sensors: Vec::new(),
            gravity: problem.gravity,
        }
    }
}
