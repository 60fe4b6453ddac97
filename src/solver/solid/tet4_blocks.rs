//! Forces of many linear tetrahedra: blocks of [`LANES`] elements, one element a lane.
//!
//! The law of one element is [`Tet4::nodal_forces`], written once; here it is called for every
//! lane of a block, which the compiler turns into vector code with the same bits. What an element
//! needs lies lane by lane in the order in which it is read. Only the turning of nodes into lanes
//! and back is written in vectors: left to the compiler it costs a fifth of the step.

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet4::Tet4;
use wide::f64x4;

/// Elements a block of an elastic solid.
pub const LANES: usize = 4;

/// A vector at a node, padded to a power of two: it is read and written in one go.
pub type Node = [f64; 4];

/// `L` elements, a multiple of four.
#[derive(Clone, Debug, PartialEq)]
pub struct Block<const L: usize> {
    /// Lane, first to fourth node.
    pub nodes: [[u32; 4]; L],
    /// Of the first three nodes, component, lane.
    gradients: [[[f64; L]; 3]; 3],
    volume: [f64; L],
}

/// Elements in their order, cut into blocks; the last block is filled up with elements of no
/// volume, whose forces are zero.
pub fn blocks<const L: usize>(
    elements: impl ExactSizeIterator<Item = (Tet4, [u32; 4])>,
) -> Vec<Block<L>> {
    let mut blocks: Vec<Block<L>> = Vec::with_capacity(elements.len().div_ceil(L));
    for (index, (element, nodes)) in elements.enumerate() {
        let lane = index % L;
        if lane == 0 {
            let (gradients, volume) = ([[[0.0; L]; 3]; 3], [0.0; L]);
            blocks.push(Block { nodes: [nodes; L], gradients, volume });
        }
        let block = blocks.last_mut().expect("pushed at lane 0");
        block.nodes[lane] = nodes;
        for n in 0..3 {
            for i in 0..3 {
                block.gradients[n][i][lane] = element.gradients[n][i];
            }
        }
        block.volume[lane] = element.volume;
    }
    blocks
}

impl<const L: usize> Block<L> {
    /// The element in one lane.
    #[inline(always)]
    pub fn element(&self, lane: usize) -> Tet4 {
        let [a, b, c] = &self.gradients;
        Tet4 {
            gradients: [in_lane(a, lane), in_lane(b, lane), in_lane(c, lane)],
            volume: self.volume[lane],
        }
    }

    /// Displacements of the first three nodes relative to the fourth: node, component, lane.
    #[inline(always)]
    pub fn relative(&self, displacement: &[Node]) -> [[[f64; L]; 3]; 3] {
        let mut relative = [[f64x4::ZERO; L]; 3];
        for lane in 0..L {
            let [a, b, c, d] = self.nodes[lane].map(|node| f64x4::new(displacement[node as usize]));
            relative[0][lane] = a - d;
            relative[1][lane] = b - d;
            relative[2][lane] = c - d;
        }
        [to_lanes(relative[0]), to_lanes(relative[1]), to_lanes(relative[2])]
    }

    /// Adds forces on the first three nodes (node, component, lane), and minus their sum on the fourth.
    #[inline(always)]
    pub fn add(&self, force: [[[f64; L]; 3]; 3], forces: &mut [Node]) {
        let [a, b, c] = [to_nodes(force[0]), to_nodes(force[1]), to_nodes(force[2])];
        for lane in 0..L {
            let of = &self.nodes[lane];
            for (node, add) in of.iter().zip([a[lane], b[lane], c[lane]]) {
                let sum = &mut forces[*node as usize];
                *sum = (f64x4::new(*sum) + add).to_array();
            }
            let sum = &mut forces[of[3] as usize];
            *sum = (f64x4::new(*sum) - (a[lane] + b[lane] + c[lane])).to_array();
        }
    }
}

/// Components of one lane.
#[inline(always)]
pub fn in_lane<const L: usize, const N: usize>(of: &[[f64; L]; N], lane: usize) -> [f64; N] {
    let mut one = [0.0; N];
    for i in 0..N {
        one[i] = of[i][lane];
    }
    one
}

/// Adds the elements' nodal forces to `forces`, in the order of the elements.
#[inline(never)]
pub fn add_forces(
    blocks: &[Block<LANES>],
    material: LinearElastic,
    displacement: &[Node],
    forces: &mut [Node],
) {
    // One bound for both, so that it is checked once.
    let displacement = &displacement[..forces.len()];
    for block in blocks {
        let apart = block.relative(displacement);
        let mut force = [[[0.0; LANES]; 3]; 3];
        for lane in 0..LANES {
            let [a, b, c] = &apart;
            let relative = [in_lane(a, lane), in_lane(b, lane), in_lane(c, lane)];
            let of = block
                .element(lane)
                .nodal_forces(&relative, |strain| material.second_piola_kirchhoff(strain));
            for n in 0..3 {
                for i in 0..3 {
                    force[n][i][lane] = of[n][i];
                }
            }
        }
        block.add(force, forces);
    }
}

/// Vectors of one node of every lane, component by component.
#[inline(always)]
pub fn to_lanes<const L: usize>(vectors: [f64x4; L]) -> [[f64; L]; 3] {
    let mut components = [[0.0; L]; 3];
    for four in 0..L / 4 {
        let at = 4 * four;
        let turned =
            f64x4::transpose([vectors[at], vectors[at + 1], vectors[at + 2], vectors[at + 3]]);
        for i in 0..3 {
            components[i][at..at + 4].copy_from_slice(&turned[i].to_array());
        }
    }
    components
}

/// Components lane by lane as one vector a lane.
#[inline(always)]
pub fn to_nodes<const L: usize>(components: [[f64; L]; 3]) -> [f64x4; L] {
    let mut vectors = [f64x4::ZERO; L];
    for four in 0..L / 4 {
        let at = 4 * four;
        let part = |i: usize| {
            let of = &components[i];
            f64x4::new([of[at], of[at + 1], of[at + 2], of[at + 3]])
        };
        let turned = f64x4::transpose([part(0), part(1), part(2), f64x4::ZERO]);
        vectors[at..at + 4].copy_from_slice(&turned);
    }
    vectors
}
