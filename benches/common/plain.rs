//! What plain element loops share: gradients of four-node elements, and nodes that go on by central differences.

use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::solids::explicit::ExplicitSolid;
use nalgebra::{Matrix3, Matrix3x4, Vector3};

/// Gradients of the shape functions (1/m), volume (m³), nodes.
pub type PlainElement = (Matrix3x4<f64>, f64, [usize; 4]);

pub fn plain_elements(places: &[Vec3], elements: &[[u32; 4]]) -> Vec<PlainElement> {
    elements
        .iter()
        .map(|nodes| {
            let x = nodes.map(|n| Vector3::from(places[n as usize]));
            let map = Matrix3::from_columns(&[x[1] - x[0], x[2] - x[0], x[3] - x[0]]);
            let inverse = map.try_inverse().expect("a sound element").transpose();
            let [b, c, d] = [0, 1, 2].map(|i: usize| inverse.column(i).into_owned());
            let gradients = Matrix3x4::from_columns(&[-(b + c + d), b, c, d]);
            (gradients, map.determinant() / 6.0, nodes.map(|n| n as usize))
        })
        .collect()
}

pub struct PlainNodes {
    step: f64,
    per_mass: Vec<f64>,
    pub displacement: Vec<Vector3<f64>>,
    rate: Vec<Vector3<f64>>,
    /// What of a step the next rates go on by: half of the first, whole ones after it.
    pull: f64,
    /// Of this step; [`step`](PlainNodes::step) takes it away.
    pub force: Vec<Vector3<f64>>,
}

impl PlainNodes {
    /// Displaced as the solid is, at rest.
    pub fn new(solid: &ExplicitSolid) -> PlainNodes {
        let displacement: Vec<_> =
            solid.displacement.iter().map(|u| Vector3::new(u[0], u[1], u[2])).collect();
        let rest = vec![Vector3::zeros(); displacement.len()];
        PlainNodes {
            step: solid.step_size,
            per_mass: solid.model.mass.iter().map(|mass| 1.0 / mass).collect(),
            displacement,
            rate: rest.clone(),
            pull: 0.5,
            force: rest,
        }
    }

    pub fn step(&mut self) {
        let pull = self.pull * self.step;
        self.pull = 1.0;
        for n in 0..self.rate.len() {
            self.rate[n] += self.force[n] * (pull * self.per_mass[n]);
            self.displacement[n] += self.rate[n] * self.step;
            self.force[n] = Vector3::zeros();
        }
    }
}
