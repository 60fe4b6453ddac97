//! Forces of many linear tetrahedra: blocks of [`LANES`] elements, one element a lane.
//!
//! The law of one element is [`Tet4::nodal_forces`], written once; here it is called for every
//! lane of a block, which the compiler turns into vector code with the same bits. What an element
//! needs lies lane by lane in the order in which it is read.

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet4::{Tet4, relative};

/// Elements a block.
pub const LANES: usize = 4;

/// A vector at a node, padded to a power of two: it is read and written in one go.
pub type Node = [f64; 4];

/// [`LANES`] elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// First to fourth node, lane.
    pub nodes: [[u32; LANES]; 4],
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
            blocks.push(Block { nodes: nodes.map(|n| [n; LANES]), ..Block::default() });
        }
        let block = blocks.last_mut().expect("pushed at lane 0");
        for n in 0..4 {
            block.nodes[n][lane] = nodes[n];
        }
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
        let [a, b, c, d] = &block.nodes;
        let moved = [
            gather(displacement, a),
            gather(displacement, b),
            gather(displacement, c),
            gather(displacement, d),
        ];
        let mut force = [[[0.0; LANES]; 3]; 3];
        for lane in 0..LANES {
            let vector = |of: &[[f64; LANES]; 3]| [of[0][lane], of[1][lane], of[2][lane]];
            let [a, b, c] = &block.gradients;
            let element =
                Tet4 { gradients: [vector(a), vector(b), vector(c)], volume: block.volume[lane] };
            let [a, b, c, d] = &moved;
            let apart = relative(&[vector(a), vector(b), vector(c), vector(d)]);
            let of = element.nodal_forces(&apart, |strain| material.second_piola_kirchhoff(strain));
            for n in 0..3 {
                for i in 0..3 {
                    force[n][i][lane] = of[n][i];
                }
            }
        }
        for lane in 0..LANES {
            let [a, b, c] = &force;
            let vector = |of: &[[f64; LANES]; 3]| [of[0][lane], of[1][lane], of[2][lane], 0.0];
            let (a, b, c) = (vector(a), vector(b), vector(c));
            let of = &block.nodes;
            for (n, add) in [(0, a), (1, b), (2, c)] {
                let sum = &mut forces[of[n][lane] as usize];
                for i in 0..4 {
                    sum[i] += add[i];
                }
            }
            let sum = &mut forces[of[3][lane] as usize];
            for i in 0..4 {
                sum[i] -= a[i] + b[i] + c[i];
            }
        }
    }
}

/// One node of every element, component by component.
#[inline(always)]
fn gather(values: &[Node], nodes: &[u32; LANES]) -> [[f64; LANES]; 3] {
    let mut at = [[0.0; 4]; LANES];
    for lane in 0..LANES {
        at[lane] = values[nodes[lane] as usize];
    }
    let mut components = [[0.0; LANES]; 3];
    for i in 0..3 {
        for lane in 0..LANES {
            components[i][lane] = at[lane][i];
        }
    }
    components
}
