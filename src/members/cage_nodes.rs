//! Contacts of a cage by the nodes of its mesh (5.3.2): pockets with balls, rails with the land of the guiding race.
//!
//! Everything is evaluated in axes of the cage, at displaced nodes. Only nodes near a ball, or near the land, are tested:
//! a pocket is passed over while its ball is farther from the wall than its nodes can be displaced, and of the land only
//! the sectors towards which the cage is displaced are searched.

use crate::ch2_housing::bearing::cage::{AxisMotion, CageContact};
use crate::ch5_cage::node_contact::{
    Friction, NodeContact, depth_in_ball, depth_in_land, node_contact, surface_velocity,
};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use crate::members::floating_solid::{into_frame, out_of_frame};
use crate::members::rigid_body::{BodyKinematics, Wrench};
use crate::members::state::BodyState;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// Nodes of one contact surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeGroup {
    /// Undeformed positions from the cage's centre of mass, m.
    pub places: Vec<Vec3>,
    /// Index of each in the mesh.
    pub nodes: Vec<u32>,
    /// K of each node, N/m.
    pub stiffness: Vec<f64>,
    /// Displacements per unit of each mode: all modes along X of the first node, along Y, along Z, of the second node, …
    pub shapes: Vec<f64>,
    /// Number of modes.
    pub modes: usize,
}

/// Contact nodes of a cage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CageNodes {
    /// Index in [`crate::assembly::lists::Assembly::floating`]; without meaning for a cage in elements.
    pub floating: usize,
    /// Largest displacement of a contact node per unit of each mode.
    pub largest: Vec<f64>,
    pub pockets: Vec<PocketNodes>,
    /// Nodes of the rails, ascending by azimuth.
    pub land: NodeGroup,
    /// First node of each of [`SECTORS`] sectors of azimuth, and the end.
    pub sectors: Vec<usize>,
    /// Distance of the outermost node from the axis (guidance by the outer race) or of the innermost one (inner), m.
    pub rim: f64,
    /// Largest axial distance of a node from the centre, m.
    pub half_length: f64,
    pub land_radius: f64,
    /// 1 for a land around the cage, −1 for one inside it.
    pub outward: f64,
    pub friction: f64,
    pub regularisation_speed: f64,
}

/// Nodes of the wall of a pocket.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PocketNodes {
    pub group: NodeGroup,
    /// Unit vector from the cage's centre to the pocket, perpendicular to its axis.
    pub towards: Vec3,
    /// Smallest distance of a node from the line along `towards`, m.
    pub innermost: f64,
}

/// Sectors of azimuth in the search of nodes near the land.
pub const SECTORS: usize = 64;

/// Azimuth of a place from its Y towards its Z, in [0, 2π).
pub fn azimuth(place: Vec3) -> f64 {
    let angle = libm::atan2(place[2], place[1]);
    if angle < 0.0 { angle + TAU } else { angle }
}

impl NodeGroup {
    /// Nodes of a mesh: positions from the centre, stiffness, and displacements by mode.
    pub fn new(
        nodes: &[u32],
        place: impl Fn(u32) -> Vec3,
        stiffness: impl Fn(u32) -> f64,
        shapes: &[Vec<Vec3>],
    ) -> NodeGroup {
        let by_node = nodes.iter().flat_map(|&node| {
            (0..3).flat_map(move |axis| shapes.iter().map(move |s| s[node as usize][axis]))
        });
        NodeGroup {
            places: nodes.iter().map(|&node| place(node)).collect(),
            nodes: nodes.to_vec(),
            stiffness: nodes.iter().map(|&node| stiffness(node)).collect(),
            shapes: by_node.collect(),
            modes: shapes.len(),
        }
    }

    fn shape(&self, node: usize, axis: usize) -> &[f64] {
        let first = (3 * node + axis) * self.modes;
        &self.shapes[first..first + self.modes]
    }

    /// Largest displacement of a node in a mode, m per unit.
    pub fn largest(&self, mode: usize) -> f64 {
        let of = |node: usize| norm([0, 1, 2].map(|axis| self.shape(node, axis)[mode]));
        (0..self.places.len()).map(of).fold(0.0, f64::max)
    }

    /// Σ of a node's modes with these amplitudes.
    fn at(&self, node: usize, amplitudes: &[f64]) -> Vec3 {
        [0, 1, 2].map(|axis| {
            self.shape(node, axis).iter().zip(amplitudes).map(|(shape, of)| shape * of).sum()
        })
    }

    /// Place of a node from the cage's centre, m, and its velocity relative to this centre, m/s, in axes of the cage.
    pub(crate) fn motion(&self, node: usize, now: &CageNow, spin: Vec3) -> [Vec3; 2] {
        match now.deformation {
            Deformation::Modes([amplitudes, rates]) => {
                let place = add(self.places[node], self.at(node, amplitudes));
                [place, add(cross(spin, place), self.at(node, rates))]
            }
            Deformation::Elements(elements) => {
                let BodyState { position, velocity, orientation, .. } = &now.body.state;
                let at = self.nodes[node] as usize;
                let [moved, rate] =
                    [elements.displacement[at], elements.rate[at]].map(|[x, y, z, _]| [x, y, z]);
                let place = add(add(self.places[node], elements.centre), moved);
                [sub(place, *position), sub(rate, *velocity)].map(|v| into_frame(orientation, v))
            }
        }
    }

    /// Adds the modal or nodal forces of a force at a node, given in axes of the cage.
    fn project(&self, node: usize, force: Vec3, now: &CageNow, forces: &mut [f64]) {
        if let Deformation::Elements(_) = now.deformation {
            let at = 4 * self.nodes[node] as usize;
            let force = out_of_frame(&now.body.state.orientation, force);
            for (to, force) in forces[at..at + 3].iter_mut().zip(force) {
                *to += force;
            }
            return;
        }
        for (axis, force) in force.into_iter().enumerate() {
            for (to, shape) in forces.iter_mut().zip(self.shape(node, axis)) {
                *to += force * shape;
            }
        }
    }
}

/// How a cage deforms.
#[derive(Clone, Copy)]
pub enum Deformation<'s> {
    /// Amplitudes (m) and rates (m/s) of its modes.
    Modes([&'s [f64]; 2]),
    Elements(ElementsNow<'s>),
}

/// A cage in elements; the fourth number of a node is padding.
#[derive(Clone, Copy)]
pub struct ElementsNow<'s> {
    /// Displacement of each node, m.
    pub displacement: &'s [[f64; 4]],
    /// Velocity of each node, m/s.
    pub rate: &'s [[f64; 4]],
    /// Mass of each node, kg.
    pub mass: &'s [f64],
    /// Undeformed centre of mass, m.
    pub centre: Vec3,
    /// Step of the elements, s.
    pub step: f64,
}

/// The cage at one instant.
pub struct CageNow<'s> {
    pub body: &'s BodyKinematics,
    pub deformation: Deformation<'s>,
    /// Upper bound of the displacement of any contact node, m.
    pub bound: f64,
}

/// Sum of the contacts of one body with the cage.
#[derive(Clone, Copy, Debug, Default)]
pub struct Touched {
    /// Largest penetration, total load, total force on the other body, the load's centre, in inertial axes.
    pub contact: CageContact,
    /// Load on the other body about its centre.
    pub on_other: Wrench,
    /// Load on the cage about its centre.
    pub on_cage: Wrench,
    /// Stored energy, J.
    pub energy: f64,
    /// Number of nodes tested and in contact.
    pub tested: u64,
    pub touching: u64,
}

/// A rigid body relative to the cage, in axes of the cage.
struct Relative {
    position: Vec3,
    velocity: Vec3,
    spin: Vec3,
    axis: Vec3,
}

impl Relative {
    fn new(cage: &BodyKinematics, other: &AxisMotion) -> Relative {
        let own = &cage.state;
        let turned = |vector: Vec3| into_frame(&own.orientation, vector);
        Relative {
            position: turned(sub(other.position, own.position)),
            velocity: turned(sub(other.velocity, own.velocity)),
            spin: turned(other.spin),
            axis: turned(other.axis),
        }
    }
}

/// Sum in axes of the cage.
#[derive(Default)]
struct Sum {
    touched: Touched,
    /// Σ load · place, Σ load · direction and Σ load · sliding velocity.
    moment_of_load: Vec3,
    push: Vec3,
    slip: Vec3,
}

impl CageNodes {
    /// Upper bound of the displacement of any contact node, m, for these amplitudes (m).
    pub fn bound(&self, gone: &[f64]) -> f64 {
        self.largest.iter().zip(gone).map(|(largest, gone)| largest * gone.abs()).sum()
    }

    /// Largest displacement of a contact node in axes of the cage, m.
    pub fn farthest(&self, now: &CageNow) -> f64 {
        let turn = now.body.state.orientation.inverse().to_rotation_matrix();
        let Deformation::Elements(elements) = now.deformation else { return now.bound };
        let groups = self.pockets.iter().map(|pocket| &pocket.group).chain([&self.land]);
        let mut most = 0.0f64;
        for group in groups {
            for (place, node) in group.places.iter().zip(&group.nodes) {
                let [x, y, z, _] = elements.displacement[*node as usize];
                let there = add(add(*place, elements.centre), [x, y, z]);
                let seen = turn * Vector3::from(sub(there, now.body.state.position));
                let off = sub(seen.into(), *place);
                most = most.max(dot(off, off));
            }
        }
        most.sqrt()
    }

    /// Friction of a node. In elements it stops the slip of the node's own mass within two steps at the earliest, as
    /// explicit steps with more would reverse it.
    fn friction_of(&self, group: &NodeGroup, node: usize, now: &CageNow) -> Friction {
        let most = match now.deformation {
            Deformation::Modes(_) => f64::INFINITY,
            Deformation::Elements(ElementsNow { mass, step, .. }) => {
                0.5 * mass[group.nodes[node] as usize] / step
            }
        };
        Friction {
            coefficient: self.friction,
            regularisation_speed: self.regularisation_speed,
            most_per_speed: most,
        }
    }

    /// Tests one node against `depth`, the penetration and the direction of the force on the other body at a place.
    #[allow(clippy::too_many_arguments)]
    fn test(
        &self,
        group: &NodeGroup,
        node: usize,
        now: &CageNow,
        cage_spin: Vec3,
        other: &Relative,
        depth: impl Fn(Vec3) -> (f64, Vec3),
        sum: &mut Sum,
        forces: &mut [f64],
        normal: &mut [f64],
    ) {
        let [place, own] = group.motion(node, now, cage_spin);
        let found = depth(place);
        let Touched { contact, on_other, on_cage: loads, energy, touching, .. } = &mut sum.touched;
        contact.penetration = contact.penetration.max(found.0);
        // NaN passes through, so that it is caught.
        if found.0 <= 0.0 {
            return;
        }
        let surface = surface_velocity(other.position, other.velocity, other.spin, place);
        let NodeContact { normal_load, force, power, .. } = node_contact(
            group.stiffness[node],
            self.friction_of(group, node, now),
            found,
            sub(surface, own),
        );
        let on_cage = scale(force, -1.0);
        group.project(node, on_cage, now, forces);
        if !normal.is_empty() {
            group.project(node, scale(found.1, normal_load), now, normal);
        }
        on_other.add_at(other.position, place, force);
        loads.add_at([0.0; 3], place, on_cage);
        *energy += 0.5 * normal_load * found.0;
        *touching += 1;
        contact.normal_load += normal_load;
        contact.force = add(contact.force, force);
        contact.power += power;
        sum.moment_of_load = add_scaled(sum.moment_of_load, normal_load, place);
        sum.push = add_scaled(sum.push, normal_load, found.1);
        sum.slip = add_scaled(sum.slip, normal_load, sub(surface, own));
    }

    /// Contact of a ball with its pocket; adds modal forces to `forces`.
    pub fn pocket(
        &self,
        pocket: usize,
        now: &CageNow,
        ball: &AxisMotion,
        ball_radius: f64,
        forces: &mut [f64],
    ) -> Touched {
        let PocketNodes { group, towards, innermost } = &self.pockets[pocket];
        let other = Relative::new(now.body, ball);
        let mut sum = Sum::default();
        let aside = add_scaled(other.position, -dot(other.position, *towards), *towards);
        let nearest = innermost - norm(aside) - ball_radius - now.bound;
        sum.touched.contact.penetration = -nearest;
        if nearest > 0.0 {
            return sum.touched;
        }
        sum.touched.contact.penetration = f64::NEG_INFINITY;
        let spin = into_frame(&now.body.state.orientation, now.body.state.spin);
        let reach = (ball_radius + now.bound) * (ball_radius + now.bound);
        for (node, place) in group.places.iter().enumerate() {
            let arm = sub(*place, other.position);
            if dot(arm, arm) > reach {
                continue;
            }
            let depth = |place: Vec3| depth_in_ball(sub(place, other.position), ball_radius);
            self.test(group, node, now, spin, &other, depth, &mut sum, forces, &mut []);
        }
        sum.touched.tested = group.places.len() as u64;
        sum.finish(now.body)
    }

    /// Contact of the rails with the land of a race, for the ends −X and +X; adds modal forces to `forces`. `normal`
    /// receives those of the normal loads on the race, for each end.
    pub fn land(
        &self,
        now: &CageNow,
        race: &AxisMotion,
        forces: &mut [f64],
        normal: &mut [Vec<f64>; 2],
    ) -> [Touched; 2] {
        let other = Relative::new(now.body, race);
        let group = &self.land;
        // Displacement of the cage from the race's axis, at both ends.
        let ends = [-self.half_length, self.half_length].map(|x| {
            let arm = sub([x, 0.0, 0.0], other.position);
            add_scaled(arm, -dot(arm, other.axis), other.axis)
        });
        let room = self.outward * (self.land_radius - self.rim) - now.bound;
        let farthest = norm(ends[0]).max(norm(ends[1]));
        let mut sums = [Sum::default(), Sum::default()];
        for sum in &mut sums {
            sum.touched.contact.penetration = farthest - room;
        }
        if farthest < room {
            return sums.map(|sum| sum.touched);
        }
        let spin = into_frame(&now.body.state.orientation, now.body.state.spin);
        for (sum, normal) in sums.iter_mut().zip(&mut *normal) {
            sum.touched.contact.penetration = f64::NEG_INFINITY;
            normal.fill(0.0);
        }
        let half_sector = 0.5 * TAU / SECTORS as f64;
        for sector in 0..SECTORS {
            let (sin, cos) = libm::sincos((2.0 * sector as f64 + 1.0) * half_sector);
            let towards = ends.map(|[_, y, z]| self.outward * (y * cos + z * sin));
            if towards[0].max(towards[1]) + farthest * half_sector < room {
                continue;
            }
            for node in self.sectors[sector]..self.sectors[sector + 1] {
                let end = usize::from(group.places[node][0] > 0.0);
                let sum = &mut sums[end];
                sum.touched.tested += 1;
                let depth = |place: Vec3| {
                    let arm = sub(place, other.position);
                    depth_in_land(arm, other.axis, self.land_radius, self.outward)
                };
                let normal = &mut normal[end];
                self.test(group, node, now, spin, &other, depth, sum, forces, normal);
            }
        }
        sums.map(|sum| sum.finish(now.body))
    }
}

impl Sum {
    /// In inertial axes.
    fn finish(self, cage: &BodyKinematics) -> Touched {
        let Sum { mut touched, moment_of_load, push, slip } = self;
        let turn: &UnitQuaternion<f64> = &cage.state.orientation;
        let load = touched.contact.normal_load;
        if load > 0.0 {
            let centre = out_of_frame(turn, scale(moment_of_load, 1.0 / load));
            touched.contact.point = add(cage.state.position, centre);
            let push = out_of_frame(turn, scale(push, 1.0 / norm(push)));
            let slip = out_of_frame(turn, scale(slip, 1.0 / load));
            touched.contact.push = push;
            touched.contact.slip = add_scaled(slip, -dot(slip, push), push);
        }
        touched.contact.force = out_of_frame(turn, touched.contact.force);
        for wrench in [&mut touched.on_other, &mut touched.on_cage] {
            wrench.force = out_of_frame(turn, wrench.force);
            wrench.moment = out_of_frame(turn, wrench.moment);
        }
        touched
    }
}
