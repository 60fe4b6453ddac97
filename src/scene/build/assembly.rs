//! A resolved scene of bearings, rigid bodies and springs, and the lists of the solver.

use crate::assembly::lists::{Assembly, CAGE, INNER, OUTER};
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::elastomer::Elastomer;
use crate::equilibrium::lists::StaticAssembly;
use crate::members::beam::Beam;
use crate::members::body::{Body, Drive, DrivenBody, GROUND, Mobility, RotatingLoad, Rotation};
use crate::members::connection::{Connection, CrossCoupling, Law, MaxwellElement, SpringDashpot};
use crate::members::flexible_shaft::{ElasticShaft, ShaftLoad, Unbalance};
use crate::members::mount::Mount;
use crate::members::shaft_modes::{FreeShaftError, Kept, RigidPart, free_shaft};
use crate::members::unbalance::least_inertia;
use crate::mesh::generate::{Bushing, BushingMesh};
use crate::numeric::profile::Profile;
use crate::scene::build::cage::{BuiltCage, CageMeshError, add_cage_nodes};
use crate::scene::build::motion::{DynamicsError, dynamic_problem};
use crate::scene::build::sensors::SceneSensor;
use crate::scene::build::statics::still_lists;
use crate::scene::resolve::housing_scene::{HousedScene, HousingMethod, HousingSettings};
use crate::scene::resolve::resolved::{DefaultUsed, RunSettings, Scene};
use crate::scene::resolve::solid_scene::SolidScene;
use crate::scene::tables::assembly::OWN_RACES;

/// Bearings and their bodies, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyScene {
    /// The scene of the first has the common part: title, run, outputs, gravity.
    pub bearings: Vec<PlacedBearing>,
    /// The common part of a scene without bearings.
    pub plain: Option<Box<Scene>>,
    pub bodies: Vec<SceneBody>,
    pub springs: Vec<Spring>,
    pub sensors: Vec<SceneSensor>,
    /// Defaults of bodies, springs, sensors and positions.
    pub defaults_used: Vec<DefaultUsed>,
}

/// A bearing and the bodies under its races.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedBearing {
    /// `None` for the only one.
    pub name: Option<String>,
    /// Carriers of the inner and of the outer race.
    pub carriers: [Carrier; 2],
    pub reversed: bool,
    pub scene: Scene,
    /// Flexible housing of the outer race.
    pub housing: Option<PlacedHousing>,
}

/// A flexible housing at a bearing's position.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedHousing {
    pub settings: HousingSettings,
    pub solid: SolidScene,
}

impl PlacedBearing {
    /// Returns whether it has no name and the position of a bearing alone.
    fn is_alone(&self) -> bool {
        let at_origin = self.carriers == [Carrier::Own { at: 0.0 }; 2];
        self.name.is_none() && !self.reversed && at_origin
    }

    /// The bearing with its flexible housing as a scene of the two at their position.
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

/// Body of a race, and the race's position on it along X, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carrier {
    /// A body of its own.
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

/// A rigid body in addition to races and cages.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBody {
    pub name: String,
    pub race: DrivenBody,
    pub rotating_load: Option<RotatingLoad>,
    /// kg·m.
    pub unbalance: f64,
    /// Beam of a flexible body, whose inertia is that of the beam.
    pub beam: Option<Box<SceneBeam>>,
}

/// Beam of a body; positions are relative to the body's centre along its axis, m.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBeam {
    pub beam: Beam,
    /// Position of its first end.
    pub start: f64,
    pub kept: Kept,
    /// 1/s.
    pub damping: f64,
    /// True if damping acts on the rigid motion too.
    pub absolute: bool,
    pub internal_damping: f64,
    /// Position, and force along X, Y, Z, N.
    pub loads: Vec<(f64, [Profile; 3])>,
    /// Position, kg·m, and angle in rad from Y towards Z.
    pub unbalances: Vec<(f64, f64, f64)>,
    pub probes: Vec<(String, f64)>,
    /// `None` unless a run steps its elements.
    pub in_elements: Option<RaceJoint>,
}

/// Spring between a race, or a disc, and its section of a shaft in elements (4.2.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceJoint {
    /// N/m.
    pub stiffness: f64,
    /// N·s/m.
    pub damping: f64,
}

/// Displacements and rotations along and about the axes of a spring's first body.
pub const SIX: [&str; 6] = ["x", "y", "z", "turn_x", "turn_y", "turn_z"];

/// What a spring is attached to.
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
    /// Position along the body's axis from its centre, of the ground along X, m.
    pub along: f64,
}

/// Springs and dashpots between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    pub name: String,
    pub ends: [SpringEnd; 2],
    pub stiffness: [f64; 6],
    pub damping: [f64; 6],
    pub cross: CrossCoupling,
    pub maxwell: Vec<MaxwellElement>,
    /// Bushing whose stiffness and Maxwell elements these are.
    pub bushing: Option<Box<BushingOfSpring>>,
}

/// A bonded bushing between two bodies, fitted by springs and Maxwell elements.
#[derive(Clone, Debug, PartialEq)]
pub struct BushingOfSpring {
    pub body: Bushing,
    pub mesh: BushingMesh,
    pub material: Elastomer,
    /// Table of the source with the rubber.
    pub table: Option<&'static str>,
    /// Highest frequency of the fit, Hz.
    pub fastest: f64,
    /// Largest error of the complex stiffness over its magnitude, of each of
    /// [`SleeveMotion::ALL`](crate::solids::rubber::sleeve::SleeveMotion::ALL).
    pub misses: [f64; 4],
    /// Elements in a run instead of the springs.
    pub elements: Option<BushingInElements>,
}

/// Integration of the elements of a bushing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BushingInElements {
    /// kg/m³.
    pub density: f64,
    pub stepping: BushingStepping,
    /// Phase of a body on the bushing in a coupling step, rad.
    pub coupling_phase: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BushingStepping {
    /// Four-node elements, with this fraction of the longest stable step.
    Explicit { fraction: f64 },
    /// Ten-node elements, with steps of at most this length (s); `None`: of a coupling step.
    Implicit { step: Option<f64> },
}

impl AssemblyScene {
    /// A bearing alone.
    pub fn alone(scene: Scene) -> AssemblyScene {
        let carriers = [Carrier::Own { at: 0.0 }; 2];
        let bearing = PlacedBearing { name: None, carriers, reversed: false, scene, housing: None };
        AssemblyScene {
            bearings: vec![bearing],
            plain: None,
            bodies: Vec::new(),
            springs: Vec::new(),
            sensors: Vec::new(),
            defaults_used: Vec::new(),
        }
    }

    /// One bearing and its flexible housing, if any.
    pub(crate) fn of_one(scene: Scene, housing: Option<PlacedHousing>) -> AssemblyScene {
        let mut alone = AssemblyScene::alone(scene);
        alone.bearings[0].housing = housing;
        alone
    }

    /// The bearing of a scene with one unnamed bearing at the usual position, with or without a housing; `None` for
    /// other scenes.
    pub fn one(&self) -> Option<&PlacedBearing> {
        match &self.bearings[..] {
            [one] if one.is_alone() && self.bodies.is_empty() && self.springs.is_empty() => {
                Some(one)
            }
            _ => None,
        }
    }

    /// The scene of a bearing alone; `None` for other scenes.
    pub fn only(&self) -> Option<&Scene> {
        self.one().filter(|one| one.housing.is_none()).map(|one| &one.scene)
    }

    /// The scene with the common part.
    pub fn common(&self) -> &Scene {
        match (&self.plain, self.bearings.first()) {
            (Some(plain), _) => plain,
            (None, Some(first)) => &first.scene,
            (None, None) => unreachable!("a scene without bearings has a common part"),
        }
    }

    /// The bearing, alone or in its housing, whose equilibrium is that of its inner race under the scene's conditions;
    /// `None` if an outer race moves by itself or a race has a foundation.
    pub fn one_still(&self) -> Option<&PlacedBearing> {
        self.one().filter(|one| {
            let of = &one.scene.dynamics;
            let stands = one.housing.is_some() || of.outer.is_none();
            stands && of.inner.foundation_stiffness == [0.0; 5]
        })
    }

    /// Method of the housings; the same for all.
    pub fn housing_method(&self) -> Option<HousingMethod> {
        let mut housings = self.bearings.iter().filter_map(|placed| placed.housing.as_ref());
        housings.next().map(|housing| housing.settings.method)
    }

    pub fn run(&self) -> Option<&RunSettings> {
        self.common().dynamics.run.as_ref()
    }

    /// The lists of the solver, with the scene's sensors.
    ///
    /// # Errors
    ///
    /// Radii without a valid contact, mass or cage.
    pub fn assembly(&self) -> Result<Assembly, DynamicsError> {
        let mut all = self.bodies_and_bearings()?;
        all.sensors = self.sensors.iter().map(|sensor| sensor.of(&all)).collect();
        Ok(all)
    }

    /// Replaces the contacts of cages that touch by their nodes in the solver's lists; equilibria do not need it.
    ///
    /// # Errors
    ///
    /// See [`CageMeshError`].
    pub fn add_cage_nodes(&self, all: &mut Assembly) -> Result<Vec<BuiltCage>, CageMeshError> {
        add_cage_nodes(all, self.bearings.iter().map(|placed| &placed.scene.dynamics))
    }

    /// Bodies, bearings and connections in the order of the scene: its bodies, then of each bearing the races that are
    /// bodies of their own and its cage, then the ground if a spring ends at it.
    ///
    /// # Errors
    ///
    /// Radii without a valid contact, mass or cage.
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
            let Spring { stiffness, damping, cross, .. } = *spring;
            let (maxwell, rest) = (spring.maxwell.clone(), [to - from, 0.0, 0.0]);
            let wall = spring.bushing.as_ref().map(|of| of.body.thickness);
            let law = SpringDashpot { stiffness, damping, cross, maxwell, rest, wall };
            let law = Law::SpringDashpot(law);
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

    /// Initial X of an end of a spring, m.
    pub(crate) fn place(&self, end: SpringEnd) -> f64 {
        end.along + race_at(&self.bearings, end.at)
    }

    /// Name in scenes.
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

    /// Equilibrium at t = 0, as at the start of a motion, without the centrifugal force of the balls unless requested.
    ///
    /// # Errors
    ///
    /// See [`AssemblyScene::assembly`].
    /// As [`AssemblyScene::assembly`].
    pub fn statics(&self) -> Result<StaticAssembly<'static>, DynamicsError> {
        Ok(still_lists(self, &self.assembly()?))
    }
}

/// Initial X of the centre of what a spring ends at, m: bodies and the ground are at the origin.
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

/// Makes a body flexible. Its centre is then that of its mass.
fn bend(all: &mut Assembly, index: usize, of: &SceneBeam) -> Result<(), FreeShaftError> {
    let of_index = |mount: &&Mount| mount.body == index;
    let bearings = || all.bearings.iter().flat_map(|bearing| &bearing.mounts).filter(of_index);
    let springs = || all.connections.iter().flat_map(|joint| &joint.ends).filter(of_index);
    let turned = bearings().chain(springs()).map(|mount| (mount.along, true));
    let pushed = of.loads.iter().map(|(at, _)| *at);
    let pushed = pushed.chain(of.unbalances.iter().map(|(at, ..)| *at)).map(|at| (at, false));
    let holds: Vec<(f64, bool)> =
        turned.chain(pushed).map(|(at, turns)| (at - of.start, turns)).collect();
    let probes: Vec<f64> = of.probes.iter().map(|(_, at)| at - of.start).collect();
    let (rigid, shapes) = free_shaft(&of.beam, of.kept, &holds, &probes)?;
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
    let sections = of.probes.iter().map(|(name, at)| (name.clone(), section(*at)));
    let shaft = ElasticShaft {
        body: index,
        damping: of.damping,
        internal_damping: of.internal_damping,
        loads: loads.collect(),
        unbalances: unbalances.collect(),
        probes: sections.collect(),
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

/// Moves a body from X = 0 to `at`.
fn move_along(body: &mut Body, at: f64) {
    body.rest[0] += at;
    if let Some(race) = body.driven_mut() {
        move_drive(race, at);
    }
}

/// Moves a prescribed motion along X from X = 0 to `at`.
fn move_drive(race: &mut DrivenBody, at: f64) {
    if let Drive::Motion(profile) = &mut race.drives[0] {
        *profile = profile.shifted(at);
    }
}

/// Inertia of a body in an equilibrium.
pub const NO_INERTIA: Inertia = Inertia { mass: 0.0, axial: 0.0, transverse: 0.0 };
