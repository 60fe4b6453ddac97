//! Cauchy stresses of a deformed solid at quadrature points, over an element, and averaged at the nodes; inverted
//! elements.

use crate::elements::tet4::{Tet4, relative};
use crate::elements::tet10::{Tet10, from_points};
use crate::kinematics::strain::{Mat3, Sym3, cauchy, green_lagrange, volume_change, von_mises};
use crate::kinematics::vec3::Vec3;
use crate::mesh::node_order::EDGES;
use crate::mesh::tet_mesh::Elements;
use crate::solids::model::{Blocks, SolidModel, corners};
use crate::solids::{tet4_blocks, tet10_blocks};

/// Calls `visit` with element, undeformed volume and displacement gradient of every quadrature
/// point.
pub(crate) fn each_point(
    model: &SolidModel,
    displacement: &[Vec3],
    mut visit: impl FnMut(usize, f64, &Mat3),
) {
    let count = model.problem.elements.len();
    match &model.blocks {
        Blocks::Linear(blocks) => {
            for (index, (tet, nodes)) in tet4_blocks::elements(blocks).take(count).enumerate() {
                let h = tet.displacement_gradient(&relative(&corners(displacement, nodes)));
                visit(index, tet.volume, &h);
            }
        }
        Blocks::Quadratic(blocks) => {
            for (index, (tet, nodes)) in tet10_blocks::elements(blocks).take(count).enumerate() {
                let moved = corners(displacement, nodes);
                for (p, point) in tet.points.iter().enumerate() {
                    visit(index, point.volume, &tet.displacement_gradient(p, &moved));
                }
            }
        }
    }
}

/// Cauchy stress (2.5) at the quadrature points, Pa, one row an element: one stress of a four-node element, four of a
/// ten-node element. Nodal forces follow from these stresses.
///
/// `displacement` has one vector for each node, m.
pub fn point_stresses(model: &SolidModel, displacement: &[Vec3]) -> Vec<Vec<Sym3>> {
    let problem = &model.problem;
    let mut stresses = vec![Vec::new(); problem.elements.len()];
    each_point(model, displacement, |element, _, h| {
        let second = problem.material.second_piola_kirchhoff(&green_lagrange(h));
        stresses[element].push(cauchy(h, &second));
    });
    stresses
}

/// Cauchy stress of each element, Pa: the mean over its quadrature points by undeformed volume.
pub fn element_stresses(model: &SolidModel, displacement: &[Vec3]) -> Vec<Sym3> {
    let problem = &model.problem;
    let mut sums = vec![([0.0; 6], 0.0); problem.elements.len()];
    each_point(model, displacement, |element, volume, h| {
        let second = problem.material.second_piola_kirchhoff(&green_lagrange(h));
        let (sum, whole) = &mut sums[element];
        *whole += volume;
        for (sum, s) in sum.iter_mut().zip(cauchy(h, &second)) {
            *sum += volume * s;
        }
    });
    sums.into_iter().map(|(sum, whole)| sum.map(|s| s / whole)).collect()
}

/// The first element with an inverted quadrature point, and its volume ratio there.
pub fn first_inverted(model: &SolidModel, displacement: &[Vec3]) -> Option<(usize, f64)> {
    let mut found = None;
    each_point(model, displacement, |element, _, h| {
        let ratio = 1.0 + volume_change(h);
        let sound = ratio > 0.0;
        if !sound && found.is_none() {
            found = Some((element, ratio));
        }
    });
    found
}

/// Results of a check of a moving solid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StressCheck {
    /// See [`first_inverted`].
    pub inverted: Option<(usize, f64)>,
    /// Largest von Mises stress at a quadrature point, Pa.
    pub von_mises: f64,
}

/// [`first_inverted`] and the largest stress in one pass.
pub fn check(model: &SolidModel, displacement: &[Vec3]) -> StressCheck {
    let mut found = StressCheck::default();
    each_point(model, displacement, |element, _, h| {
        let ratio = 1.0 + volume_change(h);
        let sound = ratio > 0.0;
        if !sound && found.inverted.is_none() {
            found.inverted = Some((element, ratio));
        }
        let second = model.problem.material.second_piola_kirchhoff(&green_lagrange(h));
        found.von_mises = found.von_mises.max(von_mises(&cauchy(h, &second)));
    });
    found
}

/// Cauchy stress at the nodes, Pa: each element's stress, for ten-node elements extrapolated linearly from its
/// quadrature points, averaged over the elements at the node by their undeformed volume.
///
/// Smoother and more accurate than element stresses inside the body; a jump across an edge of two bodies or of the load
/// is smeared over an element.
pub fn nodal_stresses(model: &SolidModel, displacement: &[Vec3]) -> Vec<Sym3> {
    let problem = &model.problem;
    let sound = "elements were checked when the model was made";
    let at_points = point_stresses(model, displacement);
    let of = |(element, at_points): (usize, &Vec<Sym3>)| {
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
        (problem.elements.nodes(element), at_nodes, volume)
    };
    average_at_nodes(problem.nodes.len(), at_points.iter().enumerate().map(of))
}

/// Means at this number of nodes of element values at their nodes, weighted by volumes.
pub fn average_at_nodes<'a>(
    count: usize,
    elements: impl Iterator<Item = (&'a [u32], [Sym3; 10], f64)>,
) -> Vec<Sym3> {
    let mut sums = vec![[0.0; 6]; count];
    let mut volumes = vec![0.0; count];
    for (nodes, at_nodes, volume) in elements {
        for (node, stress) in nodes.iter().zip(at_nodes) {
            volumes[*node as usize] += volume;
            for (sum, component) in sums[*node as usize].iter_mut().zip(stress) {
                *sum += volume * component;
            }
        }
    }
    sums.iter().zip(volumes).map(|(sum, volume)| sum.map(|component| component / volume)).collect()
}

/// The linear field through the values at four quadrature points, at the ten nodes.
pub fn at_ten_nodes(at_points: &[Sym3]) -> [Sym3; 10] {
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
