//! Forces of many quadratic tetrahedra, as [`super::tet4_blocks`] does it for linear ones.

use super::tet4_blocks::{Node, to_lanes, to_nodes};
use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet10::{POINTS, Point, Tet10};
use wide::f64x4;

/// Elements a block, one a lane: loops over four lanes become vector code.
const LANES: usize = 4;

/// Four elements, one a lane.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Lane, first to tenth node.
    pub nodes: [[u32; 10]; LANES],
    points: [BlockPoint; POINTS],
}

/// One quadrature point of every element.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BlockPoint {
    gradients: [[[f64; LANES]; 3]; 10],
    volume: [f64; LANES],
}

/// Elements in their order; the last block is filled up with elements of no volume.
pub fn blocks(elements: impl ExactSizeIterator<Item = (Tet10, [u32; 10])>) -> Vec<Block> {
    let empty = BlockPoint { gradients: [[[0.0; LANES]; 3]; 10], volume: [0.0; LANES] };
    let mut blocks = Vec::with_capacity(elements.len().div_ceil(LANES));
    for (index, (element, nodes)) in elements.enumerate() {
        let lane = index % LANES;
        if lane == 0 {
            blocks.push(Block { nodes: [nodes; LANES], points: [empty; POINTS] });
        }
        let block = blocks.last_mut().expect("pushed at lane 0");
        block.nodes[lane] = nodes;
        for (to, from) in block.points.iter_mut().zip(&element.points) {
            to.volume[lane] = from.volume;
            for n in 0..10 {
                for i in 0..3 {
                    to.gradients[n][i][lane] = from.gradients[n][i];
                }
            }
        }
    }
    blocks
}

/// Adds the elements' nodal forces to `forces`, in the order of the elements.
pub fn add_forces(
    blocks: &[Block],
    material: LinearElastic,
    displacement: &[Node],
    forces: &mut [Node],
) {
    for block in blocks {
        let mut moved = [[[0.0; LANES]; 3]; 10];
        for n in 0..10 {
            let of = block.nodes.each_ref();
            moved[n] = to_lanes(of.map(|nodes| f64x4::new(displacement[nodes[n] as usize])));
        }
        let mut force = [[[0.0; LANES]; 3]; 10];
        for point in &block.points {
            for lane in 0..LANES {
                let mut gradients = [[0.0; 3]; 10];
                let mut here = [[0.0; 3]; 10];
                let mut sum = [[0.0; 3]; 10];
                for n in 0..10 {
                    for i in 0..3 {
                        gradients[n][i] = point.gradients[n][i][lane];
                        here[n][i] = moved[n][i][lane];
                        sum[n][i] = force[n][i][lane];
                    }
                }
                let of = Point { gradients, volume: point.volume[lane] };
                let law = |strain: &_| material.second_piola_kirchhoff(strain);
                of.add_forces(&here, &law, &mut sum);
                for n in 0..10 {
                    for i in 0..3 {
                        force[n][i][lane] = sum[n][i];
                    }
                }
            }
        }
        let force = force.map(to_nodes);
        // Element after element, as the plain loop adds them.
        for (lane, nodes) in block.nodes.iter().enumerate() {
            for (node, add) in nodes.iter().zip(&force) {
                let sum = &mut forces[*node as usize];
                *sum = (f64x4::new(*sum) + add[lane]).to_array();
            }
        }
    }
}
