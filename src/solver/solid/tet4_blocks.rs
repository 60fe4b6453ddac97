//! Forces of many linear tetrahedra: blocks of [`LANES`] elements, one element a lane.
//!
//! The law of one element is [`Tet4::nodal_forces`], written once; here it is called for every
//! lane of a block, which the compiler turns into vector code with the same bits. What an element
//! needs lies lane by lane in the order in which it is read. Only the turning of nodes into lanes
//! and back is written in vectors: left to the compiler it costs a fifth of the step.

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet4::Tet4;
use wide::f64x4;

/// Elements a block.
pub const LANES: usize = 4;

/// A vector at a node, padded to a power of two: it is read and written in one go.
pub type Node = [f64; 4];

/// [`LANES`] elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// Lane, first to fourth node.
    pub nodes: [[u32; 4]; LANES],
    /// Of the first three nodes, component, lane.
    gradients: [[[f64; LANES]; 3]; 3],
    volume: [f64; LANES],
}

/// Elements in their order, cut into blocks; the last block is filled up with elements of no
/// volume, whose forces are zero.
pub fn blocks(elements: impl ExactSizeIterator<Item = (Tet4, [u32; 4])>) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::with_capacity(elements.len().div_ceil(LANES));
    for (index, (element, nodes)) in elements.enumerate() {
        let lane = index % LANES;
        if lane == 0 {
            blocks.push(Block { nodes: [nodes; LANES], ..Block::default() });
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

/// Adds the elements' nodal forces to `forces`, in the order of the elements.
#[inline(never)]
pub fn add_forces(
    blocks: &[Block],
    material: LinearElastic,
    displacement: &[Node],
    forces: &mut [Node],
) {
    // One bound for both, so that it is checked once.
    let displacement = &displacement[..forces.len()];
    for block in blocks {
        // Of the first three nodes relative to the fourth: node, lane.
        let mut relative = [[f64x4::ZERO; LANES]; 3];
        for lane in 0..LANES {
            let [a, b, c, d] =
                block.nodes[lane].map(|node| f64x4::new(displacement[node as usize]));
            relative[0][lane] = a - d;
            relative[1][lane] = b - d;
            relative[2][lane] = c - d;
        }
        let apart = [to_lanes(relative[0]), to_lanes(relative[1]), to_lanes(relative[2])];
        let mut force = [[[0.0; LANES]; 3]; 3];
        for lane in 0..LANES {
            let vector = |of: &[[f64; LANES]; 3]| [of[0][lane], of[1][lane], of[2][lane]];
            let [a, b, c] = &block.gradients;
            let element =
                Tet4 { gradients: [vector(a), vector(b), vector(c)], volume: block.volume[lane] };
            let [a, b, c] = &apart;
            let of = element.nodal_forces(&[vector(a), vector(b), vector(c)], |strain| {
                material.second_piola_kirchhoff(strain)
            });
            for n in 0..3 {
                for i in 0..3 {
                    force[n][i][lane] = of[n][i];
                }
            }
        }
        let [a, b, c] = [to_nodes(force[0]), to_nodes(force[1]), to_nodes(force[2])];
        for lane in 0..LANES {
            let of = &block.nodes[lane];
            for (node, add) in of.iter().zip([a[lane], b[lane], c[lane]]) {
                let sum = &mut forces[*node as usize];
                *sum = (f64x4::new(*sum) + add).to_array();
            }
            let sum = &mut forces[of[3] as usize];
            *sum = (f64x4::new(*sum) - (a[lane] + b[lane] + c[lane])).to_array();
        }
    }
}

/// Vectors of one node of every lane, component by component.
#[inline(always)]
pub fn to_lanes(vectors: [f64x4; LANES]) -> [[f64; LANES]; 3] {
    let [x, y, z, _] = f64x4::transpose(vectors);
    [x.to_array(), y.to_array(), z.to_array()]
}

/// Components lane by lane as one vector a lane.
#[inline(always)]
pub fn to_nodes(components: [[f64; LANES]; 3]) -> [f64x4; LANES] {
    let [x, y, z] = components;
    f64x4::transpose([f64x4::new(x), f64x4::new(y), f64x4::new(z), f64x4::ZERO])
}
