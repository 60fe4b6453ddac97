//! Forces of many linear tetrahedra: blocks of [`LANES`] elements, one element a lane.
//!
//! The law of one element is [`Tet4::nodal_forces`], written once for numbers and lanes; here it is called for all
//! lanes of a block at once, with the same bits as one by one. Data of a block are stored lane by lane in the order of
//! reading.

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet4::Tet4;
use crate::kinematics::number::Number;
use wide::f64x4;

/// Elements in a block: the width of the processor's vectors.
#[cfg(target_feature = "avx512f")]
pub type Lanes = wide::f64x8;
#[cfg(not(target_feature = "avx512f"))]
pub type Lanes = f64x4;

pub const LANES: usize = size_of::<Lanes>() / size_of::<f64>();

/// A vector at a node, padded to a power of two for one load or store.
pub type Node = [f64; 4];

/// [`LANES`] elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Lane, first to fourth node.
    pub nodes: [[u32; 4]; LANES],
    pub element: Tet4<Lanes>,
}

/// Elements in their order, in blocks; the last block is padded with elements of zero volume and force.
pub fn blocks(elements: impl ExactSizeIterator<Item = (Tet4, [u32; 4])>) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::with_capacity(elements.len().div_ceil(LANES));
    for (index, (element, nodes)) in elements.enumerate() {
        let lane = index % LANES;
        if lane == 0 {
            let zero = Lanes::of(0.0);
            let element = Tet4 { gradients: [[zero; 3]; 3], volume: zero };
            blocks.push(Block { nodes: [nodes; LANES], element });
        }
        let block = blocks.last_mut().expect("pushed at lane 0");
        block.nodes[lane] = nodes;
        for n in 0..3 {
            for i in 0..3 {
                block.element.gradients[n][i].as_mut_array()[lane] = element.gradients[n][i];
            }
        }
        block.element.volume.as_mut_array()[lane] = element.volume;
    }
    blocks
}

/// The elements of the blocks, padding included.
pub fn elements(blocks: &[Block]) -> impl Iterator<Item = (Tet4, &[u32; 4])> {
    blocks
        .iter()
        .flat_map(|block| (0..LANES).map(|lane| (block.element_of(lane), &block.nodes[lane])))
}

impl Block {
    /// The element in one lane.
    pub fn element_of(&self, lane: usize) -> Tet4 {
        let gradients = self.element.gradients.map(|g| g.map(|g| g.as_array()[lane]));
        Tet4 { gradients, volume: self.element.volume.as_array()[lane] }
    }

    /// Displacements of the first three nodes relative to the fourth: node, component.
    #[inline(always)]
    pub fn relative(&self, displacement: &[Node]) -> [[Lanes; 3]; 3] {
        let mut relative = [[f64x4::ZERO; LANES]; 3];
        for lane in 0..LANES {
            let [a, b, c, d] = self.nodes[lane].map(|node| f64x4::new(displacement[node as usize]));
            relative[0][lane] = a - d;
            relative[1][lane] = b - d;
            relative[2][lane] = c - d;
        }
        let [a, b, c] = relative;
        [joined(a), joined(b), joined(c)]
    }

    /// Adds forces on the first three nodes, and minus their sum on the fourth.
    #[inline(always)]
    pub fn add(&self, force: [[Lanes; 3]; 3], forces: &mut [Node]) {
        let [a, b, c] = force;
        let [a, b, c] = [parted(a), parted(b), parted(c)];
        for lane in 0..LANES {
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
        let apart = block.relative(displacement);
        let of =
            block.element.nodal_forces(&apart, |strain| material.second_piola_kirchhoff(strain));
        block.add(of, forces);
    }
}

// Closures are not always inlined: no `map` or `from_fn` below.
#[inline(always)]
fn joined(vectors: [f64x4; LANES]) -> [Lanes; 3] {
    let [x, y, z] = to_lanes(vectors);
    [Lanes::new(x), Lanes::new(y), Lanes::new(z)]
}

#[inline(always)]
fn parted(components: [Lanes; 3]) -> [f64x4; LANES] {
    let [x, y, z] = components;
    to_nodes([x.to_array(), y.to_array(), z.to_array()])
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
