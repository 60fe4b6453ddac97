//! Contacts of a cage in explicit elements (5.3.2) with the balls and the guiding race of its bearing, between two
//! exchanges with the bodies.
//!
//! Balls and race move as free bodies in a coupling step, as races in bores do. The cage's body in the assembly has no
//! mass: it follows the mean motion of the elements.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::cage::{AxisMotion, CageContact};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use crate::members::ball_set::guiding_side;
use crate::members::cage_nodes::{CageNodes, CageNow, Deformation, ElementsNow, Touched};
use crate::members::rigid_body::{BodyKinematics, Wrench};
use crate::members::state::{BODY, BodyState, POSITION, SPIN, VELOCITY};
use crate::motion::explicit_shaft::JointSnapshot;
use crate::motion::race_in_bore::{in_free_motion, mean_over};
use crate::motion::simulation::Simulation;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::model::SolidModel;
use crate::solids::rigid_motion::mean_motion;
use crate::solids::tet4_blocks::Node;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// A solid that is the cage of a bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct CagePart {
    /// Index of the bearing.
    pub bearing: usize,
    pub nodes: CageNodes,
    /// Undeformed centre of mass, m.
    pub centre: Vec3,
}

/// A ball or race in the present coupling step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Touching {
    from: AxisMotion,
    /// Impulse (N·s) and angular impulse (N·m·s) on it.
    handed: Wrench,
}

impl Touching {
    fn new(from: AxisMotion) -> Touching {
        Touching { from, handed: Wrench::default() }
    }

    /// After `time` s of free motion.
    fn after(&self, time: f64) -> AxisMotion {
        let AxisMotion { position, velocity, spin, axis } = self.from;
        let axis = add_scaled(axis, time, cross(spin, axis));
        AxisMotion { position: add_scaled(position, time, velocity), axis, ..self.from }
    }

    fn take(&mut self, load: &Wrench, step: f64) {
        self.handed.force = add_scaled(self.handed.force, step, load.force);
        self.handed.moment = add_scaled(self.handed.moment, step, load.moment);
    }

    /// Work of the mean load up to the motion `to`, J.
    fn work(&self, coupling_step: f64, to: &AxisMotion) -> f64 {
        let load = mean_over(&self.handed, coupling_step);
        let turn = scale(add(self.from.spin, to.spin), 0.5 * coupling_step);
        dot(load.force, sub(to.position, self.from.position)) + dot(load.moment, turn)
    }
}

/// A cage at the present time.
#[derive(Clone, Debug)]
pub struct SteppedCage {
    pub part: CagePart,
    /// Work on balls and race, and heat of friction, since the start, J.
    pub work: f64,
    pub heat: f64,
    /// Evaluations of its contacts.
    pub looks: u64,
    /// Its contacts with each ball and with the guiding race as last evaluated.
    pub pockets: Vec<CageContact>,
    pub guides: [CageContact; 2],
    body: usize,
    ball_radius: f64,
    /// Side of the guiding race and its body.
    guide: Option<(usize, usize)>,
    /// In the present coupling step.
    cage: BodyState,
    balls: Vec<Touching>,
    race: Option<Touching>,
    /// Nodal forces of the present step, N; four numbers a node.
    forces: Vec<f64>,
    is_touching: bool,
}

impl SteppedCage {
    /// # Panics
    ///
    /// If its bearing has no cage.
    pub(crate) fn new(part: CagePart, model: &SolidModel, assembly: &Assembly) -> SteppedCage {
        let bearing = &assembly.bearings[part.bearing];
        let caged = bearing.cage.as_ref().expect("the bearing has a cage");
        let side = guiding_side(caged.contacts.guidance);
        SteppedCage {
            work: 0.0,
            heat: 0.0,
            looks: 0,
            pockets: vec![CageContact::default(); bearing.geometry.ball_count],
            guides: [CageContact::default(); 2],
            body: caged.body,
            ball_radius: bearing.geometry.ball_radius,
            guide: side.map(|side| (side, bearing.mounts[side].body)),
            cage: BodyState::at_rest([0.0; 3]),
            balls: Vec::with_capacity(bearing.geometry.ball_count),
            race: None,
            forces: vec![0.0; 4 * model.mass.len()],
            is_touching: false,
            part,
        }
    }

    pub(crate) fn is_guided(&self) -> bool {
        self.guide.is_some()
    }

    /// Largest stiffness of a contact over the mass of its node, 1/s².
    pub(crate) fn added(&self, solid: &ExplicitSolid) -> f64 {
        let CageNodes { pockets, land, .. } = &self.part.nodes;
        let groups = pockets.iter().map(|pocket| &pocket.group).chain([land]);
        let nodes = groups.flat_map(|group| group.nodes.iter().zip(&group.stiffness));
        nodes.map(|(n, k)| k / solid.model.mass[*n as usize]).fold(0.0, f64::max)
    }

    /// Places the undeformed elements before the first step: the motion of the cage's body, displacements half a step
    /// later.
    pub(crate) fn place(&self, solid: &mut ExplicitSolid, simulation: &Simulation) {
        let body = simulation.body(self.body);
        let ahead = in_free_motion(&body, 0.5 * solid.step_size);
        let places = &solid.model.problem.nodes;
        for ((place, moved), rate) in
            places.iter().zip(&mut solid.displacement).zip(&mut solid.rate)
        {
            let arm = Vector3::from(sub(*place, self.part.centre));
            let there = add(ahead.position, (ahead.orientation * arm).into());
            let now: Vec3 = (body.orientation * arm).into();
            let velocity = add(body.velocity, cross(body.spin, now));
            for i in 0..3 {
                moved[i] = there[i] - place[i];
                rate[i] = velocity[i];
            }
        }
    }

    pub(crate) fn begin_coupling_step(&mut self, simulation: &Simulation) {
        let Simulation { system, state, .. } = simulation;
        self.cage = simulation.body(self.body);
        let set = &system.sets[self.part.bearing];
        self.balls.clear();
        self.balls
            .extend((0..set.layout.balls).map(|ball| Touching::new(ball_of(set, state, ball))));
        self.race = self
            .guide
            .map(|(side, _)| Touching::new(system.race_motion(state, self.part.bearing, side)));
    }

    /// Forces of the contacts at displaced nodes `after` s from the beginning of the coupling step.
    fn touch(
        &mut self,
        solid: &ExplicitSolid,
        after: f64,
        mut found: impl FnMut(&mut Self, Place, &Touched),
    ) {
        if self.is_touching {
            self.forces.fill(0.0);
            self.is_touching = false;
        }
        self.looks += 1;
        let body = BodyKinematics::new(in_free_motion(&self.cage, after));
        let elements = ElementsNow {
            displacement: &solid.displacement,
            rate: &solid.rate,
            mass: &solid.model.mass,
            centre: self.part.centre,
            step: solid.step_size,
        };
        let mut now =
            CageNow { body: &body, deformation: Deformation::Elements(elements), bound: 0.0 };
        now.bound = self.part.nodes.farthest(&now);
        for ball in 0..self.balls.len() {
            let motion = self.balls[ball].after(after);
            let of =
                self.part.nodes.pocket(ball, &now, &motion, self.ball_radius, &mut self.forces);
            self.is_touching |= of.touching > 0;
            self.pockets[ball] = of.contact;
            found(self, Place::Pocket(ball), &of);
        }
        let Some(race) = &self.race else { return };
        let motion = race.after(after);
        let mut none = [Vec::new(), Vec::new()];
        let ends = self.part.nodes.land(&now, &motion, &mut self.forces, &mut none);
        for (end, of) in ends.iter().enumerate() {
            self.is_touching |= of.touching > 0;
            self.guides[end] = of.contact;
            found(self, Place::Land, of);
        }
    }

    /// Before a step of the elements.
    pub(crate) fn begin_step(&mut self, solid: &ExplicitSolid, after: f64) {
        let step = solid.step_size;
        self.touch(solid, after, |cage, place, of| {
            cage.heat -= step * of.contact.power;
            match (place, &mut cage.race) {
                (Place::Pocket(ball), _) => cage.balls[ball].take(&of.on_other, step),
                (Place::Land, Some(race)) => race.take(&of.on_other, step),
                (Place::Land, None) => {}
            }
        });
    }

    /// Adds the forces of this step to those of the nodes, N.
    pub(crate) fn add_forces(&self, forces: &mut [Node]) {
        if self.is_touching {
            for (sum, force) in forces.as_flattened_mut().iter_mut().zip(&self.forces) {
                *sum += force;
            }
        }
    }

    /// Mean load on the guiding race's body over the coupling step; sets those on the balls.
    pub(crate) fn hand_over(
        &self,
        simulation: &mut Simulation,
        coupling_step: f64,
    ) -> Option<(usize, Wrench)> {
        let loads = self.balls.iter().map(|ball| mean_over(&ball.handed, coupling_step));
        let outside = &mut simulation.system.sets[self.part.bearing].outside;
        outside.clear();
        outside.extend(loads);
        let (race, (_, body)) = (self.race.as_ref()?, self.guide?);
        let mut load = mean_over(&race.handed, coupling_step);
        let arm = sub(race.from.position, simulation.body(body).position);
        load.moment = add(load.moment, cross(arm, load.force));
        Some((body, load))
    }

    /// Books the work on balls and race after a coupling step.
    pub(crate) fn book(&mut self, simulation: &Simulation, coupling_step: f64) {
        let Simulation { system, state, .. } = simulation;
        let set = &system.sets[self.part.bearing];
        for (ball, of) in self.balls.iter().enumerate() {
            self.work += of.work(coupling_step, &ball_of(set, state, ball));
        }
        let is_driven = |body: usize| system.assembly.bodies[body].driven().is_some();
        if let (Some((side, body)), Some(race)) = (self.guide, &self.race)
            && is_driven(body)
        {
            let to = system.race_motion(state, self.part.bearing, side);
            self.work += race.work(coupling_step, &to);
        }
    }

    /// Moves the cage's body to the mean motion of the elements, and shows their contacts in the bearing's.
    pub(crate) fn carry(&self, solid: &ExplicitSolid, simulation: &mut Simulation) {
        let SolidModel { problem, mass, .. } = &solid.model;
        let mean = mean_motion(&problem.nodes, mass, &solid.displacement, &solid.rate);
        let mut spread = Matrix3::zeros();
        for ((place, moved), mass) in problem.nodes.iter().zip(&solid.displacement).zip(mass) {
            let from = Vector3::from(sub(*place, self.part.centre));
            let to = Vector3::from(sub(add(*place, [moved[0], moved[1], moved[2]]), mean.centre));
            spread += to * from.transpose() * *mass;
        }
        let guess = simulation.body(self.body).orientation;
        let turned = UnitQuaternion::from_matrix_eps(&spread, 1e-15, 50, guess);
        // Displacements are half a step ahead of velocities.
        let there = BodyState {
            position: mean.centre,
            orientation: turned,
            velocity: mean.translation,
            spin: mean.spin,
        };
        let now = in_free_motion(&there, -0.5 * solid.step_size);
        let at = simulation.system.places.body(self.body);
        simulation.state[at..at + BODY].copy_from_slice(&now.to_array());
        let set = &mut simulation.system.sets[self.part.bearing];
        set.pockets.copy_from_slice(&self.pockets);
        set.guides = self.guides;
    }

    /// Energies at the displacements of the solid, `ahead` s after the time of the bodies; adds all forces to those of
    /// the nodes (N).
    pub(crate) fn snapshot(
        &mut self,
        simulation: &Simulation,
        ahead: f64,
        solid: &ExplicitSolid,
        forces: &mut [Node],
    ) -> JointSnapshot {
        self.begin_coupling_step(simulation);
        let (mut stored, mut to_come) = (0.0, 0.0);
        self.touch(solid, ahead, |cage, place, of| {
            stored += of.energy;
            let other = match place {
                Place::Pocket(ball) => Some(cage.balls[ball].from),
                Place::Land => cage.race.map(|race| race.from),
            };
            let Some(AxisMotion { velocity, spin, .. }) = other else { return };
            let load = &of.on_other;
            to_come += ahead * (dot(load.force, velocity) + dot(load.moment, spin));
        });
        self.looks -= 1;
        self.add_forces(forces);
        JointSnapshot { stored, heat: self.heat, work: self.work, to_come }
    }

    /// Numbers of the state: work and heat, J.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        vec![self.work, self.heat]
    }

    /// Restores [`SteppedCage::numbers`].
    pub(crate) fn restore(&mut self, numbers: &[f64]) {
        (self.work, self.heat) = (numbers[0], numbers[1]);
    }
}

/// Where a contact is.
#[derive(Clone, Copy)]
enum Place {
    Pocket(usize),
    Land,
}

fn ball_of(set: &crate::members::ball_set::BallSet, state: &[f64], ball: usize) -> AxisMotion {
    let [position, velocity, spin] =
        [POSITION, VELOCITY, SPIN].map(|part| set.layout.ball_vector(state, part, ball));
    AxisMotion { position, velocity, spin, axis: [1.0, 0.0, 0.0] }
}

/// Squared phase of a ball in its pocket per squared coupling step, 1/s²: all nodes within a quarter of the ball's
/// radius are in contact.
pub(crate) fn stiffest(cage: &CageNodes, ball_radius: f64, ball_mass: f64) -> f64 {
    let reach = 0.25 * ball_radius;
    let mut most = 0.0f64;
    for pocket in &cage.pockets {
        let group = &pocket.group;
        for place in &group.places {
            let near = group.places.iter().zip(&group.stiffness);
            let near = near.filter(|(other, _)| norm(sub(**other, *place)) <= reach);
            most = most.max(near.map(|(_, stiffness)| stiffness).sum());
        }
    }
    most / ball_mass
}
