//! Rigid part of a body's motion, which damping may leave out.

use crate::kinematics::vec3::{Vec3, add, cross, sub};
use crate::solids::model::{DampedMotion, SolidProblem};
use crate::solids::tet4_blocks::Node;
use nalgebra::{Matrix3, Vector3};

/// Mean motion of a body: that of a rigid body with the same momenta.
#[derive(Clone, Copy, Debug, Default)]
pub struct RigidMotion {
    pub centre: Vec3,
    pub translation: Vec3,
    pub spin: Vec3,
}

impl RigidMotion {
    pub fn velocity(&self, place: Vec3, displacement: Node) -> Vec3 {
        let now = add(place, [displacement[0], displacement[1], displacement[2]]);
        add(self.translation, cross(self.spin, sub(now, self.centre)))
    }
}

/// The undamped motion; zero for absolute damping.
pub fn rigid_motion(
    problem: &SolidProblem,
    mass: &[f64],
    displacement: &[Node],
    rate: &[Node],
) -> RigidMotion {
    if problem.damped_motion == DampedMotion::Absolute {
        return RigidMotion::default();
    }
    mean_motion(&problem.nodes, mass, displacement, rate)
}

/// Mean motion of nodes at `places` (m).
pub(crate) fn mean_motion(
    places: &[Vec3],
    mass: &[f64],
    displacement: &[Node],
    rate: &[Node],
) -> RigidMotion {
    let vector = |v: &Node| Vector3::new(v[0], v[1], v[2]);
    let place = |n: usize| Vector3::from(places[n]) + vector(&displacement[n]);
    let total: f64 = mass.iter().sum();
    let mut centre = Vector3::zeros();
    let mut translation = Vector3::zeros();
    for (n, mass) in mass.iter().enumerate() {
        centre += place(n) * (mass / total);
        translation += vector(&rate[n]) * (mass / total);
    }
    let mut inertia = Matrix3::zeros();
    let mut angular_momentum = Vector3::zeros();
    for (n, &mass) in mass.iter().enumerate() {
        let arm = place(n) - centre;
        inertia += (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * mass;
        angular_momentum += arm.cross(&vector(&rate[n])) * mass;
    }
    let spin = inertia.try_inverse().map_or(Vector3::zeros(), |inverse| inverse * angular_momentum);
    RigidMotion { centre: centre.into(), translation: translation.into(), spin: spin.into() }
}
