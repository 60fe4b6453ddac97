//! Cauchy stresses of a deformed solid: where they are computed, and averaged to the nodes.

use super::model::{SolidModel, corners};
use crate::elements::tet4::{Tet4, relative};
use crate::elements::tet10::{POINTS, Tet10, from_points};
use crate::kinematics::strain::{Mat3, Sym3, cauchy, green_lagrange};
use crate::kinematics::vec3::Vec3;
use crate::mesh::node_order::EDGES;
use crate::mesh::tet_mesh::Elements;

/// Cauchy stress (2.5) at the quadrature points, Pa, one row an element: the one stress of a
/// four-node element, or the four of a ten-node element. These are the stresses that the nodal
/// forces are made of.
///
/// `displacement` has one vector for each node, m.
pub fn point_stresses(model: &SolidModel, displacement: &[Vec3]) -> Vec<Vec<Sym3>> {
    let problem = &model.problem;
    let of = |h: &Mat3| cauchy(h, &problem.material.second_piola_kirchhoff(&green_lagrange(h)));
    let moved = |node: u32| displacement[node as usize];
    let sound = "elements were checked when the model was made";
    match &problem.elements {
        Elements::Linear(list) => list
            .iter()
            .map(|element| {
                let tet = Tet4::new(&corners(&problem.nodes, element)).expect(sound);
                vec![of(&tet.displacement_gradient(&relative(&element.map(moved))))]
            })
            .collect(),
        Elements::Quadratic(list) => list
            .iter()
            .map(|element| {
                let tet = Tet10::new(&corners(&problem.nodes, element)).expect(sound);
                let moved = element.map(moved);
                (0..POINTS).map(|p| of(&tet.displacement_gradient(p, &moved))).collect()
            })
            .collect(),
    }
}

/// Cauchy stress at the nodes, Pa: each element's stress, for ten-node elements continued linearly
/// from its quadrature points, averaged over the elements at the node by their undeformed volume.
///
/// Smoother and closer than the raw stresses inside the body; across an edge of two bodies or a
/// jump of the load it smears the jump over an element.
pub fn nodal_stresses(model: &SolidModel, displacement: &[Vec3]) -> Vec<Sym3> {
    let problem = &model.problem;
    let mut sums = vec![[0.0; 6]; problem.nodes.len()];
    let mut volumes = vec![0.0; problem.nodes.len()];
    let sound = "elements were checked when the model was made";
    for (element, at_points) in point_stresses(model, displacement).iter().enumerate() {
        let (at_nodes, volume) = match &problem.elements {
            Elements::Linear(list) => {
                let tet = Tet4::new(&corners(&problem.nodes, &list[element])).expect(sound);
                ([at_points[0]; 10], tet.volume)
            }
            Elements::Quadratic(list) => {
                let tet = Tet10::new(&corners(&problem.nodes, &list[element])).expect(sound);
                (at_ten_nodes(at_points), tet.volume())
            }
        };
        for (node, stress) in problem.elements.nodes(element).iter().zip(at_nodes) {
            volumes[*node as usize] += volume;
            for (sum, component) in sums[*node as usize].iter_mut().zip(stress) {
                *sum += volume * component;
            }
        }
    }
    sums.iter().zip(volumes).map(|(sum, volume)| sum.map(|component| component / volume)).collect()
}

/// The linear field through the values at four quadrature points, at the ten nodes.
fn at_ten_nodes(at_points: &[Sym3]) -> [Sym3; 10] {
    let mut nodes = [[0.0; 6]; 10];
    for corner in 0..4 {
        let mut place = [0.0; 4];
        place[corner] = 1.0;
        for (share, stress) in from_points(&place).iter().zip(at_points) {
            for i in 0..6 {
                nodes[corner][i] += share * stress[i];
            }
        }
    }
    for (middle, [a, b]) in EDGES.into_iter().enumerate() {
        for i in 0..6 {
            nodes[4 + middle][i] = 0.5 * (nodes[a][i] + nodes[b][i]);
        }
    }
    nodes
}
