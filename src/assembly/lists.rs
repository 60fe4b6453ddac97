//! The lists of a simulation: rigid bodies, bearings, reduced solids and housing fits, flexible shafts, connections,
//! gravity.
//!
//! A bearing has a [`Mount`] on each of its two bodies; several bearings may be on one body, as on a shaft. The order
//! of the lists is the order of every sum.

use crate::assembly::bearing_alone::{CageBody, DynamicProblem};
use crate::members::bearing::{Bearing, Caged};
use crate::members::body::{Body, DrivenBody, Mobility, RotatingLoad};
use crate::members::connection::Connection;
use crate::members::flexible_shaft::ElasticShaft;
use crate::members::floating_solid::FloatingSolid;
use crate::members::housing_fit::Seat;
use crate::members::mount::Mount;
use crate::members::reduced_solid::ReducedSolid;
use crate::members::sensor::Sensor;
use crate::numeric::profile::Profile;

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
