//! A section of a rotor of finite elements as what sits on it feels it (4.2.3): how far its nodes move and turn in the mean, and
//! the same mean by which forces and moments on it come to its nodes.

use crate::kinematics::strain::{Mat3, times};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};

/// Spread of nodes about an axis below this part of that about another is rounding.
const ON_A_LINE: f64 = 1e-9;

/// Nodes in one plane across the rotor, and what part of its area each carries.
#[derive(Clone, Debug, PartialEq)]
pub struct RotorSection {
    /// Of its area, undeformed, m.
    pub centre: Vec3,
    /// m².
    pub area: f64,
    /// Node, its part of the area (all: 1), and where it is from the centre, m.
    nodes: Vec<(u32, f64, Vec3)>,
    /// Σ part (r² − r rᵀ), inverted, 1/m².
    spread: Mat3,
}

impl RotorSection {
    /// Of nodes, their places (m) and areas (m²); none of nodes on one line.
    pub fn new(nodes: &[(u32, Vec3, f64)]) -> Option<RotorSection> {
        let area: f64 = nodes.iter().map(|(_, _, area)| area).sum();
        let mut centre = [0.0; 3];
        for (_, place, of) in nodes {
            centre = add_scaled(centre, of / area, *place);
        }
        let nodes: Vec<(u32, f64, Vec3)> =
            nodes.iter().map(|(node, at, of)| (*node, of / area, sub(*at, centre))).collect();
        let mut sum = [[0.0; 3]; 3];
        for (_, part, arm) in &nodes {
            for (i, row) in sum.iter_mut().enumerate() {
                for (j, value) in row.iter_mut().enumerate() {
                    let round = if i == j { dot(*arm, *arm) } else { 0.0 };
                    *value += part * (round - arm[i] * arm[j]);
                }
            }
        }
        let sum = nalgebra::Matrix3::from_fn(|i, j| sum[i][j]);
        // About the line that nodes are on nothing turns them.
        let about = sum.symmetric_eigenvalues();
        let spread = sum.try_inverse()?;
        let is_sound = area > 0.0 && about.min() > ON_A_LINE * about.max();
        let spread = [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| spread[(i, j)]));
        is_sound.then_some(RotorSection { centre, area, nodes, spread })
    }

    /// Mean displacement (m) and rotation (rad): the small one that fits the displacements of the nodes best, by least squares
    /// weighted by area.
    pub fn motion(&self, displacement: impl Fn(u32) -> Vec3) -> [Vec3; 2] {
        let (mut mean, mut swept) = ([0.0; 3], [0.0; 3]);
        for (node, part, arm) in &self.nodes {
            let of = displacement(*node);
            mean = add_scaled(mean, *part, of);
            swept = add_scaled(swept, *part, cross(*arm, of));
        }
        [mean, times(&self.spread, swept)]
    }

    /// Forces on the nodes (N) that do the work of a force (N) and a moment (N·m) on [`RotorSection::motion`].
    pub fn forces(&self, force: Vec3, moment: Vec3) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let couple = times(&self.spread, moment);
        self.nodes
            .iter()
            .map(move |(node, part, arm)| (*node, scale(add(force, cross(couple, *arm)), *part)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Any four nodes of unequal areas: a rigid motion is found exactly, and loads do the work of what they stand for on any
    /// displacements, rigid or not.
    #[test]
    fn rigid_motions_are_found_and_loads_do_their_work() {
        let nodes = [
            (3, [0.1, 0.02, 0.0], 2.0),
            (5, [0.1, -0.01, 0.01], 1.0),
            (1, [0.1, 0.0, -0.02], 0.5),
            (2, [0.1, 0.015, 0.015], 0.0),
        ];
        let section = RotorSection::new(&nodes).unwrap();
        let place = |node: u32| nodes.iter().find(|(n, ..)| *n == node).unwrap().1;
        let [shift, turn] = [[1e-3, -2e-3, 5e-4], [0.02, -0.01, 0.03]];
        let rigid = |n: u32| add(shift, cross(turn, sub(place(n), section.centre)));
        let [mean, rotation] = section.motion(rigid);
        for i in 0..3 {
            assert!((mean[i] - shift[i]).abs() <= 1e-17 && (rotation[i] - turn[i]).abs() <= 1e-15);
        }
        let [force, moment] = [[3.0, -1.0, 2.0], [0.1, 0.2, -0.4]];
        let any = |n: u32| [f64::from(n), 0.3 - f64::from(n * n), 0.7];
        let work: f64 = section.forces(force, moment).map(|(n, of)| dot(of, any(n))).sum();
        let [mean, rotation] = section.motion(any);
        let expected = dot(force, mean) + dot(moment, rotation);
        assert!((work - expected).abs() <= 1e-12 * expected.abs(), "{work} {expected}");
        // On one line there is no rotation about it.
        assert_eq!(RotorSection::new(&nodes[..2]), None);
    }
}
