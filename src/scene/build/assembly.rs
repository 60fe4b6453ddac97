//! A scene of bearings, rigid bodies and springs, resolved, and the lists that the solver takes.

use crate::assembly::lists::{Assembly, Body, CAGE, GROUND, INNER, Mobility, OUTER};
use crate::assembly::loads::{Drive, DrivenBody, RotatingLoad, Rotation};
use crate::assembly::mount::Mount;
use crate::assembly::static_lists::StaticAssembly;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::elastomer::Elastomer;
use crate::members::beam::Beam;
use crate::members::connection::{Connection, Law, MaxwellElement, SpringDashpot};
use crate::members::flexible_shaft::{ElasticShaft, ShaftLoad, Unbalance};
use crate::members::shaft_modes::{FreeShaftError, Kept, RigidPart, free_shaft};
use crate::members::unbalance::least_inertia;
use crate::mesh::generate::{Bushing, BushingMesh};
use crate::numeric::profile::Profile;
use crate::scene::build::motion::{DynamicsError, dynamic_problem};
use crate::scene::build::sensors::SceneSensor;
use crate::scene::build::statics::still_lists;
use crate::scene::resolve::housing_scene::{HousedScene, HousingMethod, HousingSettings};
use crate::scene::resolve::resolved::{DefaultUsed, RunSettings, Scene};
use crate::scene::resolve::solid_scene::SolidScene;
use crate::scene::tables::assembly::OWN_RACES;
use thiserror::Error;

/// An equilibrium is asked for where a bore has friction.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "housing{of}.friction: refused: what friction holds depends on how the race came to its place, and an equilibrium \
     knows nothing of that. Hint: `bearing run` takes it along; leave `friction` out for an equilibrium of smooth bores"
)]
pub struct RoughBore {
    /// ".left", of a housing with a name.
    of: String,
}

/// Bearings and what they sit on, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyScene {
    /// One at least; the first one's scene has what all share: title, run, outputs, gravity.
    pub bearings: Vec<PlacedBearing>,
    pub bodies: Vec<SceneBody>,
    pub springs: Vec<Spring>,
    pub sensors: Vec<SceneSensor>,
    /// Of bodies, springs, sensors and places.
    pub defaults_used: Vec<DefaultUsed>,
}

/// A bearing and the bodies that carry its races.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedBearing {
    /// `None` for the only one.
    pub name: Option<String>,
    /// Of the inner and of the outer race.
    pub carriers: [Carrier; 2],
    pub reversed: bool,
    pub scene: Scene,
    /// What the outer race sits in, if it is flexible.
    pub housing: Option<PlacedHousing>,
}

/// A flexible housing about a bearing's place.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedHousing {
    pub settings: HousingSettings,
    pub solid: SolidScene,
}

impl PlacedBearing {
    /// Whether it has no name and stands where a bearing alone does.
    fn is_alone(&self) -> bool {
        let at_origin = self.carriers == [Carrier::Own { at: 0.0 }; 2];
        self.name.is_none() && !self.reversed && at_origin
    }

    /// The bearing with its flexible housing as a scene of the two where they stand.
    pub fn housed(&self) -> Option<HousedScene> {
        let PlacedHousing { settings, solid } = self.housing.clone()?;
        let at = self.carriers[1].at();
        let mut housed = HousedScene { bearing: self.scene.clone(), housing: settings, solid };
        housed.solid.mesh.place.at = at;
        housed.bearing.outer_race[0] += at;
        if let Some(outer) = &mut housed.bearing.dynamics.outer {
            move_drive(outer, at);
        }
        Some(housed)
    }
}

/// What carries a race, and where along X from there the race sits, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carrier {
    /// It is a body of its own.
    Own { at: f64 },
    /// Index in [`AssemblyScene::bodies`].
    Body { index: usize, at: f64 },
}

impl Carrier {
    pub fn at(&self) -> f64 {
        match self {
            Carrier::Own { at } | Carrier::Body { at, .. } => *at,
        }
    }
}

/// A rigid body besides races and cages.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBody {
    pub name: String,
    pub race: DrivenBody,
    pub rotating_load: Option<RotatingLoad>,
    /// kg·m.
    pub unbalance: f64,
    /// How it bends, if it does; then its inertia is that of the beam.
    pub beam: Option<Box<SceneBeam>>,
}

/// How a body bends; places count from the body's centre along its axis, m.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBeam {
    pub beam: Beam,
    /// Of its first end.
    pub start: f64,
    pub kept: Kept,
    /// 1/s.
    pub damping: f64,
    /// Whether it brakes the rigid motion, too.
    pub absolute: bool,
    pub internal_damping: f64,
    /// Where, and along X, Y, Z, N.
    pub loads: Vec<(f64, [Profile; 3])>,
    /// Where, kg·m, and rad from Y towards Z.
    pub unbalances: Vec<(f64, f64, f64)>,
    pub watched: Vec<(String, f64)>,
    /// Where a run steps its elements themselves.
    pub in_elements: Option<RaceJoint>,
}

/// What joins a race, or a disc, to its section of a shaft in elements (4.2.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceJoint {
    /// N/m.
    pub stiffness: f64,
    /// N·s/m.
    pub damping: f64,
}

/// Displacements and turns along and about the axes of a spring's first body.
pub const SIX: [&str; 6] = ["x", "y", "z", "turn_x", "turn_y", "turn_z"];

/// What a spring ends at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringAt {
    Ground,
    /// Index in [`AssemblyScene::bodies`].
    Body(usize),
    /// A race that is a body of its own; index in [`AssemblyScene::bearings`], inner (0) or outer (1).
    Race {
        bearing: usize,
        side: usize,
    },
}

/// One end of a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringEnd {
    pub at: SpringAt,
    /// Place along the body's axis from its centre, of the ground along X, m.
    pub along: f64,
}

/// Springs and dashpots between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    pub name: String,
    pub ends: [SpringEnd; 2],
    pub stiffness: [f64; 6],
    pub damping: [f64; 6],
    pub maxwell: Vec<MaxwellElement>,
    /// What the stiffness and the Maxwell elements stand for.
    pub bushing: Option<Box<BushingOfSpring>>,
}

/// A bonded bushing between two bodies, reduced to springs that relax.
#[derive(Clone, Debug, PartialEq)]
pub struct BushingOfSpring {
    pub body: Bushing,
    pub mesh: BushingMesh,
    pub material: Elastomer,
    /// Table of the source that the rubber is of.
    pub table: Option<&'static str>,
    /// Up to which frequency the springs were fitted, Hz.
    pub fastest: f64,
    /// Largest error of the complex stiffness over its magnitude, of each of
    /// [`SleeveMotion::ALL`](crate::solids::rubber::sleeve::SleeveMotion::ALL).
    pub misses: [f64; 4],
    /// Where its elements move beside the bodies in place of the springs.
    pub elements: Option<BushingInElements>,
}

/// How the elements of a bushing are stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BushingInElements {
    /// kg/m³.
    pub density: f64,
    pub stepping: BushingStepping,
    /// How far a body may swing on it between two exchanges, rad.
    pub window_phase: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BushingStepping {
    /// Four-node elements, by this part of the longest stable step.
    Explicit { fraction: f64 },
    /// Ten-node elements, by at most so many seconds, or as long as bodies and rubber go without each other.
    Implicit { step: Option<f64> },
}

impl AssemblyScene {
    /// A bearing alone.
    pub fn alone(scene: Scene) -> AssemblyScene {
        let carriers = [Carrier::Own { at: 0.0 }; 2];
        let bearing = PlacedBearing { name: None, carriers, reversed: false, scene, housing: None };
        AssemblyScene {
            bearings: vec![bearing],
            bodies: Vec::new(),
            springs: Vec::new(),
            sensors: Vec::new(),
            defaults_used: Vec::new(),
        }
    }

    /// One bearing and what its outer race sits in, if that is flexible.
    pub(crate) fn of_one(scene: Scene, housing: Option<PlacedHousing>) -> AssemblyScene {
        let mut alone = AssemblyScene::alone(scene);
        alone.bearings[0].housing = housing;
        alone
    }

    /// The bearing of a scene of one without a name where a bearing alone stands, with or without a housing; `None`
    /// where there is more.
    pub fn one(&self) -> Option<&PlacedBearing> {
        match &self.bearings[..] {
            [one] if one.is_alone() && self.bodies.is_empty() && self.springs.is_empty() => {
                Some(one)
            }
            _ => None,
        }
    }

    /// The scene of a bearing alone; `None` where there is more.
    pub fn only(&self) -> Option<&Scene> {
        self.one().filter(|one| one.housing.is_none()).map(|one| &one.scene)
    }

    /// What all bearings share.
    pub fn common(&self) -> &Scene {
        &self.bearings[0].scene
    }

    /// The bearing alone, or in its housing, whose equilibrium is that of its inner race under what the scene writes for it:
    /// where an outer race moves by itself, or a foundation holds a race, there is more to solve.
    pub fn one_still(&self) -> Option<&PlacedBearing> {
        self.one().filter(|one| {
            let of = &one.scene.dynamics;
            let stands = one.housing.is_some() || of.outer.is_none();
            stands && of.inner.foundation_stiffness == [0.0; 5]
        })
    }

    /// How the housings are solved, where there are any: all the same way.
    pub fn housing_method(&self) -> Option<HousingMethod> {
        let mut housings = self.bearings.iter().filter_map(|placed| placed.housing.as_ref());
        housings.next().map(|housing| housing.settings.method)
    }

    /// That no bore has friction, of which an equilibrium knows nothing.
    ///
    /// # Errors
    /// The first bore that has.
    pub fn check_smooth(&self) -> Result<(), RoughBore> {
        let rough = |placed: &&PlacedBearing| {
            placed.housing.as_ref().is_some_and(|of| of.settings.friction.is_some())
        };
        let Some(rough) = self.bearings.iter().find(rough) else { return Ok(()) };
        let of = rough.name.as_ref().map_or(String::new(), |name| format!(".{name}"));
        Err(RoughBore { of })
    }

    /// Whether elements of rubber move beside the bearings.
    pub fn has_bushings_in_elements(&self) -> bool {
        let mut bushings = self.springs.iter().filter_map(|spring| spring.bushing.as_deref());
        bushings.any(|of| of.elements.is_some())
    }

    /// Whether elements of a shaft move beside the bearings.
    pub fn has_shafts_in_elements(&self) -> bool {
        let mut beams = self.bodies.iter().filter_map(|body| body.beam.as_deref());
        beams.any(|beam| beam.in_elements.is_some())
    }

    pub fn run(&self) -> Option<&RunSettings> {
        self.common().dynamics.run.as_ref()
    }

    /// The lists of the solver, with the scene's sensors.
    ///
    /// # Errors
    /// Radii from which no contact, mass or cage can be built.
    pub fn assembly(&self) -> Result<Assembly, DynamicsError> {
        let mut all = self.bodies_and_bearings()?;
        all.sensors = self.sensors.iter().map(|sensor| sensor.of(&all)).collect();
        Ok(all)
    }

    /// Bodies, bearings and connections in the order of the scene: its bodies, then of each bearing the races
    /// that are bodies of their own and its cage, then the ground where a spring ends at it.
    ///
    /// # Errors
    /// Radii from which no contact, mass or cage can be built.
    fn bodies_and_bearings(&self) -> Result<Assembly, DynamicsError> {
        if let Some(scene) = self.only() {
            return Ok(dynamic_problem(scene)?.assembly());
        }
        let mut all = Assembly { gravity: self.common().gravity, ..Assembly::default() };
        all.bodies.extend(self.bodies.iter().map(|body| Body {
            name: format!("the body {}", body.name),
            label: Some(body.name.clone()),
            mobility: Mobility::Driven(Box::new(body.race.clone())),
            rest: [0.0; 5],
            rotating_load: body.rotating_load.clone(),
            unbalance: body.unbalance,
        }));
        for placed in &self.bearings {
            add_bearing(&mut all, placed)?;
        }
        let ground = all.bodies.len();
        if self.springs.iter().flat_map(|spring| spring.ends).any(|end| end.at == SpringAt::Ground)
        {
            all.bodies.push(Body {
                name: GROUND.into(),
                label: None,
                mobility: Mobility::Fixed,
                rest: [0.0; 5],
                rotating_load: None,
                unbalance: 0.0,
            });
        }
        let joints = self.springs.iter().map(|spring| {
            let ends = spring.ends.map(|SpringEnd { at, along }| {
                let body = match at {
                    SpringAt::Ground => ground,
                    SpringAt::Body(body) => body,
                    SpringAt::Race { bearing, side } => all.bearings[bearing].mounts[side].body,
                };
                Mount { body, along, reversed: false }
            });
            let [from, to] = spring.ends.map(|end| self.place(end));
            let Spring { stiffness, damping, .. } = *spring;
            let (maxwell, rest) = (spring.maxwell.clone(), [to - from, 0.0, 0.0]);
            let wall = spring.bushing.as_ref().map(|of| of.body.thickness);
            let law = Law::SpringDashpot(SpringDashpot { stiffness, damping, maxwell, rest, wall });
            let label = Some(spring.name.clone());
            Connection { name: format!("the spring {}", spring.name), label, ends, law }
        });
        all.connections = joints.collect();
        for (index, body) in self.bodies.iter().enumerate() {
            if let Some(beam) = &body.beam {
                bend(&mut all, index, beam)
                    .map_err(|error| DynamicsError::Beam { body: body.name.clone(), error })?;
            }
        }
        Ok(all)
    }

    /// X of the place where an end of a spring stands at first, m.
    pub(crate) fn place(&self, end: SpringEnd) -> f64 {
        end.along + race_at(&self.bearings, end.at)
    }

    /// As scenes name it.
    pub fn name_of_end(&self, at: SpringAt) -> String {
        match at {
            SpringAt::Ground => "ground".into(),
            SpringAt::Body(body) => format!("body.{}", self.bodies[body].name),
            SpringAt::Race { bearing, side } => {
                let race = OWN_RACES[side];
                match &self.bearings[bearing].name {
                    Some(name) => format!("{name}.{race}"),
                    None => race.into(),
                }
            }
        }
    }

    /// What is in equilibrium at t = 0: as a motion would start, without the centrifugal force of the balls
    /// unless it is asked for.
    ///
    /// # Errors
    /// As [`AssemblyScene::assembly`].
    pub fn statics(&self) -> Result<StaticAssembly<'static>, DynamicsError> {
        Ok(still_lists(self, &self.assembly()?))
    }
}

/// X of the centre at first of what a spring ends at, m: bodies and the ground stand at the origin.
pub(crate) fn race_at(bearings: &[PlacedBearing], at: SpringAt) -> f64 {
    match at {
        SpringAt::Race { bearing, side } => bearings[bearing].carriers[side].at(),
        SpringAt::Ground | SpringAt::Body(_) => 0.0,
    }
}

fn add_bearing(all: &mut Assembly, placed: &PlacedBearing) -> Result<(), DynamicsError> {
    let mut alone = dynamic_problem(&placed.scene)?.assembly();
    let mut bearing = alone.bearings.remove(0);
    bearing.name.clone_from(&placed.name);
    let of = placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
    for (side, carrier) in [INNER, OUTER].into_iter().zip(placed.carriers) {
        let reversed = placed.reversed;
        bearing.mounts[side] = match carrier {
            Carrier::Body { index, at } => Mount { body: index, along: at, reversed },
            Carrier::Own { at } => {
                let mut body = alone.bodies[side].clone();
                body.name += &of;
                move_along(&mut body, at);
                all.bodies.push(body);
                Mount { body: all.bodies.len() - 1, along: 0.0, reversed }
            }
        };
    }
    if let Some(cage) = &mut bearing.cage {
        let mut body = alone.bodies[CAGE].clone();
        body.name += &of;
        cage.body = all.bodies.len();
        all.bodies.push(body);
    }
    all.bearings.push(bearing);
    Ok(())
}

/// Lets a body bend. Its centre is that of its mass from now on.
fn bend(all: &mut Assembly, index: usize, of: &SceneBeam) -> Result<(), FreeShaftError> {
    let of_index = |mount: &&Mount| mount.body == index;
    let bearings = || all.bearings.iter().flat_map(|bearing| &bearing.mounts).filter(of_index);
    let springs = || all.connections.iter().flat_map(|joint| &joint.ends).filter(of_index);
    let turned = bearings().chain(springs()).map(|mount| (mount.along, true));
    let pushed = of.loads.iter().map(|(at, _)| *at);
    let pushed = pushed.chain(of.unbalances.iter().map(|(at, ..)| *at)).map(|at| (at, false));
    let holds: Vec<(f64, bool)> =
        turned.chain(pushed).map(|(at, turns)| (at - of.start, turns)).collect();
    let watched: Vec<f64> = of.watched.iter().map(|(_, at)| at - of.start).collect();
    let (rigid, shapes) = free_shaft(&of.beam, of.kept, &holds, &watched)?;
    let centre = of.start + rigid.centre;
    move_along(&mut all.bodies[index], centre);
    if let Some(race) = all.bodies[index].driven_mut() {
        let RigidPart { mass, axial, transverse, .. } = rigid;
        race.inertia = Inertia { mass, axial, transverse };
        if of.absolute {
            let dashpots =
                [mass, mass, mass, transverse, transverse].map(|of_mass| of.damping * of_mass);
            race.foundation_damping.iter_mut().zip(dashpots).for_each(|(to, more)| *to += more);
        }
    }
    let mounts = all.bearings.iter_mut().flat_map(|bearing| &mut bearing.mounts);
    let mounts = mounts.chain(all.connections.iter_mut().flat_map(|joint| &mut joint.ends));
    mounts.filter(|mount| mount.body == index).for_each(|mount| mount.along -= centre);
    let section = |at: f64| shapes.section(at - centre);
    let loads = of.loads.iter();
    let loads = loads.map(|(at, force)| ShaftLoad { section: section(*at), force: force.clone() });
    let unbalances = of.unbalances.iter().map(|&(at, size, angle)| Unbalance {
        section: section(at),
        size,
        angle,
    });
    let watched = of.watched.iter().map(|(name, at)| (name.clone(), section(*at)));
    let shaft = ElasticShaft {
        body: index,
        damping: of.damping,
        internal_damping: of.internal_damping,
        loads: loads.collect(),
        unbalances: unbalances.collect(),
        watched: watched.collect(),
        shapes: shapes.clone(),
    };
    let by_torque =
        all.bodies[index].driven().is_some_and(|race| matches!(race.rotation, Rotation::Torque(_)));
    let least = least_inertia(&shaft, rigid.mass, rigid.transverse);
    let possible = least < rigid.axial;
    if by_torque && !possible {
        return Err(FreeShaftError::Unbalances { least, axial: rigid.axial });
    }
    all.shafts.push(shaft);
    Ok(())
}

/// A body as it was at X = 0, at `at`.
fn move_along(body: &mut Body, at: f64) {
    body.rest[0] += at;
    if let Some(race) = body.driven_mut() {
        move_drive(race, at);
    }
}

/// A motion given along X, at `at` in place of X = 0.
fn move_drive(race: &mut DrivenBody, at: f64) {
    if let Drive::Motion(profile) = &mut race.drives[0] {
        *profile = profile.shifted(at);
    }
}

/// Mass of a body whose inertia nobody needs.
pub const NO_INERTIA: Inertia = Inertia { mass: 0.0, axial: 0.0, transverse: 0.0 };
