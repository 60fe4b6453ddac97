//! A rigid race in the bore of a reduced solid: contact on one side only and without friction, (2.16) to (2.19).
//!
//! Nodes of the bore move along their normals; what that leaves out of a displacement, its part across the normal,
//! changes a node's distance from the race's axis by its square over the diameter. Forces are the gradient of the
//! energy in these coordinates: whatever the race gets the shapes get too, with the other sign.

use crate::assembly::mount::Mount;
use crate::ch2_housing::bore_contact::{
    ContactNode, ContactSum, Cylinder, Frame, Penalty, contact,
};
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, dot, scale};
use crate::members::reduced_solid::ReducedSolid;
use crate::members::rigid_body::{BodyKinematics, Wrench};
use crate::numeric::profile::Profile;

/// What sits in what.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    /// As messages name it: "the bore".
    pub name: String,
    /// Before the names of its columns; `None` for the only one.
    pub label: Option<String>,
    /// Middle of the seat on a body, whose axis is the race's.
    pub race: Mount,
    /// Index in [`crate::assembly::lists::Assembly::solids`], and of the surface in that.
    pub solid: usize,
    pub surface: usize,
    /// Of the race's outside, m; an interference grows in by it.
    pub radius: Profile,
    /// Of the race, m.
    pub width: f64,
    /// How far nodes may slide over each rim and still be touched, m.
    pub rim: f64,
    pub penalty: Penalty,
    /// Centre of the race before anything moves, m.
    pub nominal: Vec3,
    /// Of the race there, a unit vector.
    pub axis: Vec3,
}

impl Seat {
    /// The race at time `t`.
    pub fn cylinder(&self, t: f64) -> Cylinder {
        Cylinder { radius: self.radius.value(t), width: self.width + 2.0 * self.rim }
    }
}

/// A node that touches, as linearised contacts need it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TouchingNode {
    /// In the surface.
    pub node: usize,
    /// N/m.
    pub stiffness: f64,
    /// Of the race, outwards, inertial axes.
    pub normal: Vec3,
    /// From the race's centre, m.
    pub arm: Vec3,
    /// Its part along the node's own normal, and the contact's force along that, N.
    pub along: f64,
    pub load: f64,
}

/// A seat with room to work in, as last evaluated.
#[derive(Clone, Debug)]
pub struct SeatNow {
    pub contact: ContactSum,
    /// Displacement of each node along its normal, m.
    pub outward: Vec<f64>,
    pub touching: Vec<TouchingNode>,
    /// Shapes node by node.
    pub by_node: Vec<f64>,
    nodes: Vec<ContactNode>,
}

impl SeatNow {
    pub fn new(seat: &Seat, solid: &ReducedSolid) -> SeatNow {
        let surface = &solid.surfaces[seat.surface];
        let count = surface.nodes.len();
        let local = |(node, at): (u32, &crate::members::reduced_solid::SurfaceNode)| ContactNode {
            node,
            place: at.place,
            area: at.area,
        };
        SeatNow {
            contact: ContactSum::default(),
            outward: vec![0.0; count],
            touching: Vec::with_capacity(count),
            by_node: surface.by_node(),
            nodes: (0u32..).zip(&surface.nodes).map(local).collect(),
        }
    }

    /// Loads on the race about its centre, where it lies now and the shapes have gone so far (m); adds the forces on
    /// the shapes (N) to `pushes`.
    pub fn evaluate(
        &mut self,
        seat: &Seat,
        solid: &ReducedSolid,
        race: &BodyKinematics,
        t: f64,
        gone: &[f64],
        pushes: &mut [f64],
    ) -> Wrench {
        let surface = &solid.surfaces[seat.surface];
        let SeatNow { outward, touching, nodes, by_node, .. } = self;
        surface.along_normals(gone, outward);
        touching.clear();
        let pose =
            Pose { position: race.state.position.into(), orientation: race.state.orientation };
        let moved = |n: u32| scale(surface.nodes[n as usize].normal, outward[n as usize]);
        let shapes = solid.count();
        self.contact = contact(
            &seat.cylinder(t),
            &Frame::new(&pose),
            seat.penalty,
            nodes,
            moved,
            |node, touch, stiffness, force| {
                let node = node.node as usize;
                let own = surface.nodes[node].normal;
                let load = dot(force, own);
                for (push, shape) in pushes.iter_mut().zip(&by_node[node * shapes..]) {
                    *push += load * shape;
                }
                let (normal, arm) = (touch.normal, touch.arm);
                let along = dot(normal, own);
                touching.push(TouchingNode { node, stiffness, normal, arm, along, load });
            },
        );
        Wrench { force: self.contact.force, moment: self.contact.moment }
    }
}
