//! Forces of many quadratic tetrahedra, as in [`crate::solids::tet4_blocks`].

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet10::{POINTS, Point, Tet10};
use crate::kinematics::number::Number;
use crate::solids::tet4_blocks::{LANES, Lanes, Node, to_lanes, to_nodes};
use wide::f64x4;

/// [`LANES`] elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Lane, first to tenth node.
    pub nodes: [[u32; 10]; LANES],
    points: [Point<Lanes>; POINTS],
}

/// Elements in their order; the last block is padded with elements of zero volume.
pub fn blocks(elements: impl ExactSizeIterator<Item = (Tet10, [u32; 10])>) -> Vec<Block> {
    let zero = Lanes::of(0.0);
    let empty = Point { gradients: [[zero; 3]; 10], volume: zero };
    let mut blocks: Vec<Block> = Vec::with_capacity(elements.len().div_ceil(LANES));
    for (index, (element, nodes)) in elements.enumerate() {
        let lane = index % LANES;
        if lane == 0 {
            blocks.push(Block { nodes: [nodes; LANES], points: [empty; POINTS] });
        }
        let block = blocks.last_mut().expect("pushed at lane 0");
        block.nodes[lane] = nodes;
        for (to, from) in block.points.iter_mut().zip(&element.points) {
            to.volume.as_mut_array()[lane] = from.volume;
            for n in 0..10 {
                for i in 0..3 {
                    to.gradients[n][i].as_mut_array()[lane] = from.gradients[n][i];
                }
            }
        }
    }
    blocks
}

/// The elements of the blocks, padding included.
pub fn elements(blocks: &[Block]) -> impl Iterator<Item = (Tet10, &[u32; 10])> {
    blocks.iter().flat_map(|block| (0..LANES).map(|lane| (block.element(lane), &block.nodes[lane])))
}

impl Block {
    fn element(&self, lane: usize) -> Tet10 {
        let of = |lanes: &Lanes| lanes.as_array()[lane];
        let points = self.points.each_ref().map(|point| Point {
            gradients: point.gradients.each_ref().map(|g| g.each_ref().map(of)),
            volume: of(&point.volume),
        });
        Tet10 { points }
    }
}

/// Adds the elements' nodal forces to `forces`, in the order of the elements.
#[inline(never)]
pub fn add_forces(
    blocks: &[Block],
    material: LinearElastic,
    displacement: &[Node],
    forces: &mut [Node],
) {
    let law = |strain: &_| material.second_piola_kirchhoff(strain);
    for block in blocks {
        let mut moved = [[Lanes::of(0.0); 3]; 10];
        for n in 0..10 {
            let mut vectors = [f64x4::ZERO; LANES];
            for lane in 0..LANES {
                vectors[lane] = f64x4::new(displacement[block.nodes[lane][n] as usize]);
            }
            let components = to_lanes(vectors);
            for i in 0..3 {
                moved[n][i] = Lanes::new(components[i]);
            }
        }
        let mut force = [[Lanes::of(0.0); 3]; 10];
        for point in &block.points {
            point.add_forces(&moved, &law, &mut force);
        }
        let mut of_nodes = [[f64x4::ZERO; LANES]; 10];
        for n in 0..10 {
            let [x, y, z] = force[n];
            of_nodes[n] = to_nodes([x.to_array(), y.to_array(), z.to_array()]);
        }
        // Element after element, in the order of the plain loop.
        for (lane, nodes) in block.nodes.iter().enumerate() {
            for (node, add) in nodes.iter().zip(&of_nodes) {
                let sum = &mut forces[*node as usize];
                *sum = (f64x4::new(*sum) + add[lane]).to_array();
            }
        }
    }
}
