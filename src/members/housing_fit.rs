//! A rigid race in the bore of a reduced solid: unilateral contact without friction, (2.16) to (2.19).
//!
//! Bore nodes move along their normals; the omitted lateral displacement changes a node's distance from the race's axis
//! by its square over the diameter. Forces are the gradient of the energy in these coordinates: race and modes get
//! opposite forces.

use crate::ch2_housing::bore_contact::{
    ContactNode, ContactSum, Cylinder, Frame, Penalty, contact,
};
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, dot, scale};
use crate::members::mount::Mount;
use crate::members::reduced_solid::ReducedSolid;
use crate::members::rigid_body::{BodyKinematics, Wrench};
use crate::numeric::profile::Profile;

/// A housing fit: a race and a bore.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    /// Name in messages: "the bore".
    pub name: String,
    /// Prefix of its columns; `None` for the only one.
    pub label: Option<String>,
    /// Mount of the race's centre and axis on a body.
    pub race: Mount,
    /// Index in [`crate::assembly::lists::Assembly::solids`], and of the surface in that solid.
    pub solid: usize,
    pub surface: usize,
    /// Outside radius of the race, m; a growing interference changes it.
    pub radius: Profile,
    /// Width of the race, m.
    pub width: f64,
    /// Axial displacement beyond each rim within which nodes stay in contact, m.
    pub rim: f64,
    pub penalty: Penalty,
    /// Centre of the race before any motion, m.
    pub nominal: Vec3,
    /// Axis of the race there, a unit vector.
    pub axis: Vec3,
}

impl Seat {
    /// The race at time `t`.
    pub fn cylinder(&self, t: f64) -> Cylinder {
        Cylinder { radius: self.radius.value(t), width: self.width + 2.0 * self.rim }
    }
}

/// A contact node, for linearised contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactNodeState {
    /// Index in the surface.
    pub node: usize,
    /// N/m.
    pub stiffness: f64,
    /// Outward normal of the race, inertial axes.
    pub normal: Vec3,
    /// Position from the race's centre, m.
    pub arm: Vec3,
    /// Component of the normal along the node's own normal, and the contact force along that, N.
    pub along: f64,
    pub load: f64,
}

/// A housing fit with working memory, as last evaluated.
#[derive(Clone, Debug)]
pub struct SeatNow {
    pub contact: ContactSum,
    /// Displacement of each node along its normal, m.
    pub outward: Vec<f64>,
    pub touching: Vec<ContactNodeState>,
    /// Modes node by node.
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

    /// Loads on the race about its centre at its present position and these modal coordinates (m); adds the modal
    /// forces (N) to `pushes`.
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
                touching.push(ContactNodeState { node, stiffness, normal, arm, along, load });
            },
        );
        Wrench { force: self.contact.force, moment: self.contact.moment }
    }
}
