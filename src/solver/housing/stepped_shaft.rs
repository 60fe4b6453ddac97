//! What sits on a shaft of elements in explicit steps (4.2.3): races and discs as rigid bodies on springs between their centres and
//! those of sections, and unbalances; between two exchanges with the bodies.
//!
//! A spring sees its section where the nodes have it and its body as if free for a window, as a seat does; what it does to the
//! section goes to the nodes, the impulse of it with the other sign to the body.

use super::seat::{carried_on, mean_over, work_on_way};
use crate::ch4_rotor::section::{RotorSection, SectionPlace};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale};
use crate::solver::dynamics::assembly::Assembly;
use crate::solver::dynamics::connection::{Pull, SpringDashpot, spring_dashpot};
use crate::solver::dynamics::race::{self, RaceLoads, RaceNow};
use crate::solver::dynamics::run::Simulation;
use crate::solver::dynamics::state::BodyState;
use crate::solver::profile::Profile;
use crate::solver::solid::explicit::ExplicitSolid;
use crate::solver::solid::model::SolidModel;
use crate::solver::solid::tet4_blocks::Node;
use nalgebra::{UnitQuaternion, Vector3};

/// What makes a solid a shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftPart {
    /// About X, over time, rad/s: its nodes start with it, what sits on it is driven with it.
    pub speed: Profile,
    pub joints: Vec<Joint>,
    pub unbalances: Vec<SectionUnbalance>,
    /// Sections that are recorded, by name.
    pub watched: Vec<(String, RotorSection)>,
}

/// A rigid body that sits on a section, their centres and axes joined by springs.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Index of the body.
    pub body: usize,
    pub section: RotorSection,
    /// In the section's axes.
    pub law: SpringDashpot,
}

/// A small mass beside the axis of a section.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionUnbalance {
    pub section: RotorSection,
    /// kg·m.
    pub size: f64,
    /// From the section's own Y towards its Z, rad.
    pub angle: f64,
}

impl Joint {
    /// Largest stiffness against a shift (N/m) and a turn (N·m/rad).
    pub(super) fn stiffness(&self) -> [f64; 2] {
        [0..3, 3..6].map(|axes| self.law.stiffness[axes].iter().copied().fold(0.0, f64::max))
    }

    /// Largest damping of a shift (N·s/m) and of a turn (N·m·s/rad).
    pub(super) fn damping(&self) -> [f64; 2] {
        [0..3, 3..6].map(|axes| self.law.damping[axes].iter().copied().fold(0.0, f64::max))
    }

    /// What it adds to the square of the highest frequency of the solid at most, 1/s²: by Weyl's bound, of springs that hold a
    /// node's part of the section each.
    fn added(&self, per_mass: impl Fn(u32) -> f64) -> f64 {
        self.felt(self.stiffness(), per_mass)
    }

    /// Of springs or dashpots against a shift and a turn what a mass of its nodes feels of them at most, over that mass.
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

/// The law with its body at one instant.
fn pulled(joint: &Joint, place: &SectionPlace, body: &BodyState) -> Pull {
    let section = RaceNow::new(BodyState {
        position: place.centre,
        orientation: place.orientation,
        velocity: place.velocity,
        spin: place.spin,
    });
    spring_dashpot(&joint.law, [&section, &RaceNow::new(*body)], &[])
}

/// A joint in the present window.
#[derive(Clone, Debug, PartialEq)]
pub struct JointNow {
    pub joint: Joint,
    /// On its body since the start, and lost in its dashpots, J.
    pub work: f64,
    pub heat: f64,
    /// The body at the beginning; impulse (N·s) and moment of impulse (N·m·s) on it.
    from: BodyState,
    handed: RaceLoads,
    /// Where the section is in this step, and force and moment on it.
    place: Option<SectionPlace>,
    on_section: RaceLoads,
}

/// A joint at one time, for the ledger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointSnapshot {
    /// Held by its springs, J.
    pub stored: f64,
    /// Since the start, J.
    pub heat: f64,
    pub work: f64,
    /// What it does to the body up to where the solid's displacements are, J.
    pub to_come: f64,
}

/// A shaft at the present time.
#[derive(Clone, Debug, PartialEq)]
pub struct SteppedShaft {
    pub speed: Profile,
    pub joints: Vec<JointNow>,
    pub unbalances: Vec<SectionUnbalance>,
    pub watched: Vec<(String, RotorSection)>,
    /// Of unbalances on the shaft since the start, J.
    pub unbalance_work: f64,
    /// How often sections and what sits on them were looked at.
    pub looks: u64,
    /// Of the unbalances in this step, N.
    forces: Vec<Vec3>,
    /// Of its nodes about X, kg·m².
    axial_inertia: f64,
}

impl SteppedShaft {
    pub(super) fn new(part: ShaftPart, model: &SolidModel, assembly: &Assembly) -> SteppedShaft {
        let joint = |joint: Joint| JointNow {
            work: 0.0,
            heat: 0.0,
            from: race::fixed(&assembly.bodies[joint.body].rest).state,
            handed: RaceLoads::default(),
            place: None,
            on_section: RaceLoads::default(),
            joint,
        };
        let around = |(mass, [_, y, z]): (&f64, &Vec3)| mass * (y * y + z * z);
        SteppedShaft {
            speed: part.speed,
            joints: part.joints.into_iter().map(joint).collect(),
            forces: vec![[0.0; 3]; part.unbalances.len()],
            unbalances: part.unbalances,
            watched: part.watched,
            unbalance_work: 0.0,
            looks: 0,
            axial_inertia: model.mass.iter().zip(&model.problem.nodes).map(around).sum(),
        }
    }

    /// What its joints add to the square of the solid's highest frequency at most, 1/s².
    pub(super) fn added(&self, solid: &ExplicitSolid) -> f64 {
        self.joints.iter().map(|now| now.joint.added(|node| per_mass(solid, node))).sum()
    }

    /// The longest step of the solid with which dashpots, which see velocities half a step old, do not overshoot, s.
    pub(super) fn braked(&self, solid: &ExplicitSolid) -> f64 {
        let joints = self.joints.iter().map(|now| &now.joint);
        let rates = joints.map(|joint| joint.felt(joint.damping(), |node| per_mass(solid, node)));
        BRAKED / rates.sum::<f64>()
    }

    /// Turns the nodes of a solid that has not been stepped: velocities of a rigid body at the start, displacements half a step
    /// later.
    pub(super) fn spin_up(&self, solid: &mut ExplicitSolid) {
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

    pub(super) fn begin_window(&mut self, simulation: &Simulation) {
        for now in &mut self.joints {
            now.from = simulation.body(now.joint.body);
            now.handed = RaceLoads::default();
        }
    }

    /// Looks at its sections before a step of the solid, `after` s since the window began.
    pub(super) fn begin_step(&mut self, solid: &ExplicitSolid, after: f64) {
        let step = solid.step_size;
        self.looks += 1;
        for now in &mut self.joints {
            let place = place_of(&now.joint.section, solid);
            let pull = pulled(&now.joint, &place, &carried_on(&now.from, after));
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

    /// Books what the unbalances do in half a step at the present rates.
    fn book(&mut self, solid: &ExplicitSolid) {
        let half = 0.5 * solid.step_size;
        self.unbalance_work += half * self.unbalance_power(&solid.rate);
    }

    /// Of the unbalances of this step on nodes that move so fast (m/s), W.
    fn unbalance_power(&self, rates: &[Node]) -> f64 {
        let rate = of(rates);
        let pull = |(of, force): (&SectionUnbalance, &Vec3)| -> f64 {
            let forces = of.section.forces(*force, [0.0; 3]);
            forces.map(|(node, force)| dot(force, rate(node))).sum()
        };
        self.unbalances.iter().zip(&self.forces).map(pull).sum()
    }

    /// After a step.
    pub(super) fn end_step(&mut self, solid: &ExplicitSolid) {
        self.book(solid);
    }

    /// The forces of this step on the nodes, N.
    pub(super) fn push(&self, forces: &mut [Node]) {
        for now in &self.joints {
            let Some(place) = &now.place else { continue };
            let RaceLoads { force, moment } = now.on_section;
            add_to(forces, now.joint.section.forces_at(place, force, moment));
        }
        for (of, force) in self.unbalances.iter().zip(&self.forces) {
            add_to(forces, of.section.forces(*force, [0.0; 3]));
        }
    }

    /// Of its joints `ahead` s after the bodies' time, where the solid is; adds all forces on nodes (N).
    pub(super) fn snapshot(
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
            let pull = pulled(&now.joint, &place, &carried_on(&body, ahead));
            let RaceLoads { force, moment } = pull.on[0];
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

    /// Centres of the watched sections at the bodies' time, half a step before the solid's displacements, m.
    pub fn watched_centres<'s>(
        &'s self,
        solid: &'s ExplicitSolid,
    ) -> impl Iterator<Item = Vec3> + 's {
        self.watched.iter().map(|(_, section)| {
            let place = place_of(section, solid);
            add_scaled(place.centre, -0.5 * solid.step_size, place.velocity)
        })
    }

    /// Of its nodes, which spin whatever else happens, J: no part of what a run turns over.
    pub(super) fn spin_energy(&self, time: f64) -> f64 {
        let speed = self.speed.value(time);
        0.5 * self.axial_inertia * speed * speed
    }

    /// Numbers that go with a state: of each joint work and heat, and the work of unbalances, J.
    pub(super) fn numbers(&self) -> Vec<f64> {
        let joints = self.joints.iter().flat_map(|now| [now.work, now.heat]);
        joints.chain([self.unbalance_work]).collect()
    }

    /// The same put back.
    ///
    /// # Panics
    /// If they are of another shaft.
    pub(super) fn restore(&mut self, numbers: &[f64]) {
        assert_eq!(numbers.len(), 2 * self.joints.len() + 1);
        let (joints, rest) = numbers.split_at(2 * self.joints.len());
        for (now, kept) in self.joints.iter_mut().zip(joints.chunks_exact(2)) {
            (now.work, now.heat) = (kept[0], kept[1]);
        }
        self.unbalance_work = rest[0];
    }
}

impl JointNow {
    /// What the window's impulse comes to as a load over all of it, N and N·m.
    pub(super) fn mean_load(&self, window: f64) -> RaceLoads {
        mean_over(&self.handed, window)
    }

    /// Books what that load did to the body while it came to `to`.
    pub(super) fn book(&mut self, window: f64, to: &BodyState) {
        self.work += work_on_way(&self.mean_load(window), &self.from, to);
    }
}

/// Rate of a dashpot times the step or window in which it brakes by what it saw before: stable below 1, halved.
pub(super) const BRAKED: f64 = 0.5;

/// 1/kg, along the axis where it is largest.
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

/// A section where the nodes have it, with the rates of half a step before.
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

/// Force of an unbalance at a time (s): outwards with the square of the speed, and back where the speed grows, N.
fn unbalanced(of: &SectionUnbalance, speed: &Profile, place: &SectionPlace, t: f64) -> Vec3 {
    let (sine, cosine) = libm::sincos(of.angle);
    let outwards: Vec3 = (place.orientation * Vector3::new(0.0, cosine, sine)).into();
    let axis: Vec3 = (place.orientation * Vector3::x()).into();
    let (speed, growth) = (speed.value(t), speed.rate(t));
    let out = scale(outwards, of.size * speed * speed);
    add(out, scale(cross(axis, outwards), -of.size * growth))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::vec3::norm;

    const NODES: [Vec3; 5] = [
        [0.2, 0.012, 0.0],
        [0.2, -0.004, 0.01],
        [0.2, 0.0, -0.013],
        [0.2, 0.006, 0.009],
        [0.2, -0.011, -0.002],
    ];

    fn joint() -> Joint {
        let nodes: Vec<(u32, Vec3, f64)> =
            (0..5).map(|n| (n as u32, NODES[n], 1.0 + n as f64)).collect();
        let section = RotorSection::new(&nodes).unwrap();
        let stiffness = [2e9, 2e9, 2e9, 1e6, 1e6, 1e6];
        let damping = [2e2, 2e2, 2e2, 0.2, 0.2, 0.2];
        Joint { body: 0, section, law: SpringDashpot { stiffness, damping, ..Default::default() } }
    }

    /// Nodes that have spun by `angle` about an axis through anywhere, strained and moved: displacement and rate.
    fn state(node: u32, t: f64) -> Vec3 {
        let n = f64::from(node);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 2.0 + 600.0 * t);
        let strained = Vector3::from(NODES[node as usize]) * (1.0 + 1e-4 * n)
            + Vector3::z() * 1e-6 * n * (1.0 + 50.0 * t);
        let now = turn * strained + Vector3::new(1e-6, 2e-6 + 0.03 * t, -3e-6);
        (now - Vector3::from(NODES[node as usize])).into()
    }

    fn rate(node: u32, t: f64) -> Vec3 {
        const H: f64 = 1e-7;
        let (later, before) = (state(node, t + H), state(node, t - H));
        [0, 1, 2].map(|i: usize| (later[i] - before[i]) / (2.0 * H))
    }

    fn body(t: f64) -> BodyState {
        let mut body = BodyState::at_rest([0.2 + 2e-6, 1e-6 + 0.01 * t, 5e-7]);
        let tilt = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 1e-5, 2e-5));
        body.orientation =
            tilt * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 2.0 + 600.0 * t);
        (body.velocity, body.spin) =
            ([0.0, 0.01, 0.0], (tilt * Vector3::new(600.0, 0.0, 0.0)).into());
        body
    }

    /// What a joint does to section and body sums to nothing, about any point; its power is what its springs lose and its
    /// dashpots take.
    #[test]
    fn joints_keep_momentum_and_their_power_is_stored_or_lost() {
        let joint = joint();
        let at = |t: f64| {
            let place = joint.section.place(|n| state(n, t), |n| rate(n, t));
            (place, pulled(&joint, &place, &body(t)))
        };
        let (place, pull) = at(0.0);
        let (mut force, mut moment, mut power) = ([0.0; 3], [0.0; 3], 0.0);
        for (node, of) in joint.section.forces_at(&place, pull.on[0].force, pull.on[0].moment) {
            let now = add(NODES[node as usize], state(node, 0.0));
            force = add(force, of);
            moment = add(moment, cross(now, of));
            power += dot(of, rate(node, 0.0));
        }
        let (on, body) = (pull.on[1], body(0.0));
        power += dot(on.force, body.velocity) + dot(on.moment, body.spin);
        let left = norm(add(force, on.force));
        assert!(left <= 1e-12 * norm(on.force), "{left}");
        let about = add(moment, add(on.moment, cross(body.position, on.force)));
        assert!(norm(about) <= 1e-12 * norm(on.force), "{about:?}");
        // Differences over 1e-7 s, of an energy that is a part of 1e-3 of what changes it.
        let step = 1e-7;
        let grows = (at(step).1.energy - at(-step).1.energy) / (2.0 * step);
        assert!(
            (power + grows - pull.loss).abs() <= 1e-5 * power.abs(),
            "{power} {grows} {}",
            pull.loss
        );
        assert!(pull.loss < 0.0);
    }

    /// Of a force that turns with the section: outwards with Ω², and against the sense of rotation where the speed grows.
    #[test]
    fn an_unbalance_pulls_outwards_and_lags_a_shaft_that_speeds_up() {
        let section = joint().section;
        let of = SectionUnbalance { section, size: 1e-3, angle: 0.5 };
        let place = of.section.place(|n| state(n, 0.0), |n| rate(n, 0.0));
        let angle: f64 = 2.0 + 0.5;
        let speed = Profile::SmoothRamp { from: 0.0, to: 100.0, start: -1.0, duration: 2.0 };
        let force = unbalanced(&of, &speed, &place, 0.0);
        let (value, growth) = (speed.value(0.0), speed.rate(0.0));
        assert!(growth > 1.0);
        let out = 1e-3 * value * value;
        let back = 1e-3 * growth;
        // The section's nodes are strained by 1e-4 of themselves, which turns what fits them best by as little.
        let expected =
            [out * angle.cos() + back * angle.sin(), out * angle.sin() - back * angle.cos()];
        for (part, expected) in force[1..].iter().zip(expected) {
            assert!((part - expected).abs() <= 1e-3 * out, "{force:?} {expected}");
        }
    }
}
