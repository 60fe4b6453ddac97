//! Attachments of a shaft of elements in explicit steps (4.2.3): races and discs as rigid bodies on springs between
//! their centres and those of sections, and unbalances; between two exchanges with the bodies.
//!
//! A spring takes its section from the nodes and its body as free during a coupling step, as a housing fit does. Its
//! force acts on the nodes, its impulse with the opposite sign on the body.

use crate::assembly::lists::Assembly;
use crate::ch4_rotor::section::{RotorSection, SectionPlace};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale};
use crate::members::connection::{SpringDashpot, SpringForces, spring_dashpot};
use crate::members::rigid_body;
use crate::members::rigid_body::{BodyKinematics, Wrench};
use crate::members::state::BodyState;
use crate::motion::race_in_bore::{in_free_motion, mean_over, work_on_way};
use crate::motion::simulation::Simulation;
use crate::numeric::profile::Profile;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::model::SolidModel;
use crate::solids::tet4_blocks::Node;
use nalgebra::{UnitQuaternion, Vector3};

/// Shaft properties of a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftPart {
    /// Rotation speed about X over time, rad/s: initial speed of the nodes, and drive of the attached bodies.
    pub speed: Profile,
    pub joints: Vec<Joint>,
    pub unbalances: Vec<SectionUnbalance>,
    /// Sections that are recorded, by name.
    pub probes: Vec<(String, RotorSection)>,
}

/// A rigid body on a section, joined to it by springs between centres and axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Index of the body.
    pub body: usize,
    pub section: RotorSection,
    /// In the axes of the section.
    pub law: SpringDashpot,
}

/// An unbalance of a section.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionUnbalance {
    pub section: RotorSection,
    /// Mass times eccentricity, kg·m.
    pub size: f64,
    /// Angle from the section's Y towards its Z, rad.
    pub angle: f64,
}

impl Joint {
    /// Largest stiffness against a shift (N/m) and a turn (N·m/rad).
    pub(crate) fn stiffness(&self) -> [f64; 2] {
        [0..3, 3..6].map(|axes| self.law.stiffness[axes].iter().copied().fold(0.0, f64::max))
    }

    /// Largest damping of a shift (N·s/m) and of a turn (N·m·s/rad).
    pub(crate) fn damping(&self) -> [f64; 2] {
        [0..3, 3..6].map(|axes| self.law.damping[axes].iter().copied().fold(0.0, f64::max))
    }

    /// Largest addition to the square of the solid's highest frequency, 1/s²: Weyl's bound for springs on the nodes of
    /// the section.
    fn added(&self, per_mass: impl Fn(u32) -> f64) -> f64 {
        self.felt(self.stiffness(), per_mass)
    }

    /// Largest stiffness or damping of a displacement and a rotation over the mass of a node.
    fn felt(&self, [shift, turn]: [f64; 2], per_mass: impl Fn(u32) -> f64) -> f64 {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let of = |force: Vec3, moment: Vec3| -> f64 {
            let forces = self.section.forces(force, moment);
            forces.map(|(node, force)| dot(force, force) * per_mass(node)).sum()
        };
        let none = [0.0; 3];
        let turns = [x, y, z].map(|about| of(none, about)).into_iter().fold(0.0, f64::max);
        shift * of(x, none) + turn * turns
    }
}

/// Forces of the spring with its body at one instant.
pub fn pulled(joint: &Joint, place: &SectionPlace, body: &BodyState) -> SpringForces {
    let section = BodyKinematics::new(BodyState {
        position: place.centre,
        orientation: place.orientation,
        velocity: place.velocity,
        spin: place.spin,
    });
    spring_dashpot(&joint.law, [&section, &BodyKinematics::new(*body)], &[])
}

/// A joint in the present coupling step.
#[derive(Clone, Debug, PartialEq)]
pub struct JointNow {
    pub joint: Joint,
    /// Work on its body, and heat in its dashpots, since the start, J.
    pub work: f64,
    pub heat: f64,
    /// The body at the beginning of the coupling step; impulse (N·s) and angular impulse (N·m·s) on it.
    from: BodyState,
    handed: Wrench,
    /// Position of the section in this step; force and moment on it.
    place: Option<SectionPlace>,
    on_section: Wrench,
}

/// Energies of a joint at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointSnapshot {
    /// Stored by its springs, J.
    pub stored: f64,
    /// Since the start, J.
    pub heat: f64,
    pub work: f64,
    /// Work on the body up to the time of the solid's displacements, J.
    pub to_come: f64,
}

/// A shaft at the present time.
#[derive(Clone, Debug, PartialEq)]
pub struct SteppedShaft {
    pub speed: Profile,
    pub joints: Vec<JointNow>,
    pub unbalances: Vec<SectionUnbalance>,
    pub probes: Vec<(String, RotorSection)>,
    /// Work of unbalances on the shaft since the start, J.
    pub unbalance_work: f64,
    /// Number of evaluations of sections and attachments.
    pub looks: u64,
    /// Forces of the unbalances in this step, N.
    forces: Vec<Vec3>,
    /// Moment of inertia of its nodes about X, kg·m².
    axial_inertia: f64,
}

impl SteppedShaft {
    pub(crate) fn new(part: ShaftPart, model: &SolidModel, assembly: &Assembly) -> SteppedShaft {
        let joint = |joint: Joint| JointNow {
            work: 0.0,
            heat: 0.0,
            from: rigid_body::fixed(&assembly.bodies[joint.body].rest).state,
            handed: Wrench::default(),
            place: None,
            on_section: Wrench::default(),
            joint,
        };
        let around = |(mass, [_, y, z]): (&f64, &Vec3)| mass * (y * y + z * z);
        SteppedShaft {
            speed: part.speed,
            joints: part.joints.into_iter().map(joint).collect(),
            forces: vec![[0.0; 3]; part.unbalances.len()],
            unbalances: part.unbalances,
            probes: part.probes,
            unbalance_work: 0.0,
            looks: 0,
            axial_inertia: model.mass.iter().zip(&model.problem.nodes).map(around).sum(),
        }
    }

    /// Largest addition of its joints to the square of the solid's highest frequency, 1/s².
    pub(crate) fn added(&self, solid: &ExplicitSolid) -> f64 {
        self.joints.iter().map(|now| now.joint.added(|node| per_mass(solid, node))).sum()
    }

    /// Longest step of the solid, s, at which dashpots, which lag half a step, do not overshoot.
    pub(crate) fn braked(&self, solid: &ExplicitSolid) -> f64 {
        let joints = self.joints.iter().map(|now| &now.joint);
        let rates = joints.map(|joint| joint.felt(joint.damping(), |node| per_mass(solid, node)));
        BRAKED / rates.sum::<f64>()
    }

    /// Sets the nodes of a solid before its first step to rotate: velocities of a rigid body at the start,
    /// displacements half a step later.
    pub(crate) fn spin_up(&self, solid: &mut ExplicitSolid) {
        let speed = self.speed.value(0.0);
        let spin = Vector3::x() * speed;
        let turn = UnitQuaternion::from_scaled_axis(spin * (0.5 * solid.step_size));
        let nodes = solid.displacement.iter_mut().zip(&mut solid.rate);
        for ((displacement, rate), place) in nodes.zip(&solid.model.problem.nodes) {
            let place = Vector3::from(*place);
            let (moved, velocity) = (turn * place - place, spin.cross(&place));
            *displacement = [moved.x, moved.y, moved.z, 0.0];
            *rate = [velocity.x, velocity.y, velocity.z, 0.0];
        }
    }

    pub(crate) fn begin_coupling_step(&mut self, simulation: &Simulation) {
        for now in &mut self.joints {
            now.from = simulation.body(now.joint.body);
            now.handed = Wrench::default();
        }
    }

    /// Evaluates its sections before a step of the solid, `after` s from the beginning of the coupling step.
    pub(crate) fn begin_step(&mut self, solid: &ExplicitSolid, after: f64) {
        let step = solid.step_size;
        self.looks += 1;
        for now in &mut self.joints {
            let place = place_of(&now.joint.section, solid);
            let pull = pulled(&now.joint, &place, &in_free_motion(&now.from, after));
            now.handed.force = add_scaled(now.handed.force, step, pull.on[1].force);
            now.handed.moment = add_scaled(now.handed.moment, step, pull.on[1].moment);
            now.heat -= step * pull.loss;
            (now.place, now.on_section) = (Some(place), pull.on[0]);
        }
        for (of, force) in self.unbalances.iter().zip(&mut self.forces) {
            *force = unbalanced(of, &self.speed, &place_of(&of.section, solid), solid.time);
        }
        self.book(solid);
    }

    /// Books the work of the unbalances in half a step at the present rates.
    fn book(&mut self, solid: &ExplicitSolid) {
        let half = 0.5 * solid.step_size;
        self.unbalance_work += half * self.unbalance_power(&solid.rate);
    }

    /// Power of the unbalances of this step at these rates of the nodes (m/s), W.
    fn unbalance_power(&self, rates: &[Node]) -> f64 {
        let rate = of(rates);
        let pull = |(of, force): (&SectionUnbalance, &Vec3)| -> f64 {
            let forces = of.section.forces(*force, [0.0; 3]);
            forces.map(|(node, force)| dot(force, rate(node))).sum()
        };
        self.unbalances.iter().zip(&self.forces).map(pull).sum()
    }

    /// After a step.
    pub(crate) fn end_step(&mut self, solid: &ExplicitSolid) {
        self.book(solid);
    }

    /// Adds the forces of this step to those of the nodes, N.
    pub(crate) fn add_forces(&self, forces: &mut [Node]) {
        for now in &self.joints {
            let Some(place) = &now.place else { continue };
            let Wrench { force, moment } = now.on_section;
            add_to(forces, now.joint.section.forces_at(place, force, moment));
        }
        for (of, force) in self.unbalances.iter().zip(&self.forces) {
            add_to(forces, of.section.forces(*force, [0.0; 3]));
        }
    }

    /// Energies of its joints `ahead` s after the time of the bodies; adds all forces to those of the nodes (N).
    pub(crate) fn snapshot(
        &self,
        simulation: &Simulation,
        ahead: f64,
        (t, displacement, rates): (f64, &[Node], &[Node]),
        forces: &mut [Node],
    ) -> (Vec<JointSnapshot>, f64) {
        let [u, v] = [displacement, rates].map(of);
        let joint = |now: &JointNow| {
            let place = now.joint.section.place(&u, &v);
            let body = simulation.body(now.joint.body);
            let pull = pulled(&now.joint, &place, &in_free_motion(&body, ahead));
            let Wrench { force, moment } = pull.on[0];
            add_to(forces, now.joint.section.forces_at(&place, force, moment));
            let load = pull.on[1];
            let power = dot(load.force, body.velocity) + dot(load.moment, body.spin);
            JointSnapshot {
                stored: pull.energy,
                heat: now.heat,
                work: now.work,
                to_come: ahead * power,
            }
        };
        let joints = self.joints.iter().map(joint).collect();
        // Booked half a step late, as loads of the solid are.
        let mut work = self.unbalance_work;
        for unbalance in &self.unbalances {
            let place = unbalance.section.place(&u, &v);
            let force = unbalanced(unbalance, &self.speed, &place, t);
            work += ahead * dot(force, place.velocity);
            add_to(forces, unbalance.section.forces(force, [0.0; 3]));
        }
        (joints, work)
    }

    /// Centres of the recorded sections at the time of the bodies, half a step before the solid's displacements, m.
    pub fn probe_centres<'s>(
        &'s self,
        solid: &'s ExplicitSolid,
    ) -> impl Iterator<Item = Vec3> + 's {
        self.probes.iter().map(|(_, section)| {
            let place = place_of(section, solid);
            add_scaled(place.centre, -0.5 * solid.step_size, place.velocity)
        })
    }

    /// Kinetic energy of the steady spin of its nodes, J, which a run does not turn over.
    pub(crate) fn spin_energy(&self, time: f64) -> f64 {
        let speed = self.speed.value(time);
        0.5 * self.axial_inertia * speed * speed
    }

    /// Numbers of the state: work and heat of each joint, and work of unbalances, J.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let joints = self.joints.iter().flat_map(|now| [now.work, now.heat]);
        joints.chain([self.unbalance_work]).collect()
    }

    /// Restores [`ShaftState::numbers`].
    ///
    /// # Panics
    ///
    /// If they are of another shaft.
    pub(crate) fn restore(&mut self, numbers: &[f64]) {
        assert_eq!(numbers.len(), 2 * self.joints.len() + 1);
        let (joints, rest) = numbers.split_at(2 * self.joints.len());
        for (now, kept) in self.joints.iter_mut().zip(joints.chunks_exact(2)) {
            (now.work, now.heat) = (kept[0], kept[1]);
        }
        self.unbalance_work = rest[0];
    }
}

impl JointNow {
    /// Mean load of the impulse over the coupling step, N and N·m.
    pub(crate) fn mean_load(&self, coupling_step: f64) -> Wrench {
        mean_over(&self.handed, coupling_step)
    }

    /// Books the work of that load on the body up to its state `to`.
    pub(crate) fn book(&mut self, coupling_step: f64, to: &BodyState) {
        self.work += work_on_way(&self.mean_load(coupling_step), &self.from, to);
    }
}

/// Damping rate times the step or coupling step: stable below 1, halved for safety.
pub(crate) const BRAKED: f64 = 0.5;

/// Inverse mass of a node, 1/kg, along the axis where it is largest.
fn per_mass(solid: &ExplicitSolid, node: u32) -> f64 {
    let of = solid.model.per_mass[node as usize];
    of[0].max(of[1]).max(of[2])
}

fn of(list: &[Node]) -> impl Fn(u32) -> Vec3 + '_ {
    |node| {
        let v = &list[node as usize];
        [v[0], v[1], v[2]]
    }
}

/// Position of a section from the nodes, with the rates of half a step before.
fn place_of(section: &RotorSection, solid: &ExplicitSolid) -> SectionPlace {
    section.place(of(&solid.displacement), of(&solid.rate))
}

fn add_to(forces: &mut [Node], more: impl Iterator<Item = (u32, Vec3)>) {
    for (node, force) in more {
        let sum = &mut forces[node as usize];
        for (sum, part) in sum.iter_mut().zip(force) {
            *sum += part;
        }
    }
}

/// Force of an unbalance at a time (s), N: outwards with the square of the speed, and backwards as the speed grows.
pub fn unbalanced(of: &SectionUnbalance, speed: &Profile, place: &SectionPlace, t: f64) -> Vec3 {
    let (sine, cosine) = libm::sincos(of.angle);
    let outwards: Vec3 = (place.orientation * Vector3::new(0.0, cosine, sine)).into();
    let axis: Vec3 = (place.orientation * Vector3::x()).into();
    let (speed, growth) = (speed.value(t), speed.rate(t));
    let out = scale(outwards, of.size * speed * speed);
    add(out, scale(cross(axis, outwards), -of.size * growth))
}
