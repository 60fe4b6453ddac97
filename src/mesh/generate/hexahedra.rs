//! Blocks of hexahedra that share nodes where they touch, cut into conforming tetrahedra.
//!
//! A quadrilateral is cut along the diagonal from its lowest-numbered node, so that both adjacent hexahedra
//! agree, whatever their blocks (Dompierre et al. 1999). A hexahedron is cut into six tetrahedra
//! from its lowest-numbered node to the triangles of the three sides that do not contain it.

use crate::mesh::error::MeshError;
use crate::mesh::measure::straight_volume;
use crate::mesh::repair::coincident_nodes;
use crate::mesh::tet_mesh::{Elements, TetMesh};
use nalgebra::Vector3;

/// Sides of a hexahedron, corners in cyclic order; 0…3 is the bottom, 4…7 the top.
const SIDES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// Distance below which nodes of different blocks are merged, divided by the body's size.
const WELD: f64 = 1e-9;

#[derive(Default)]
pub struct Hexahedra {
    points: Vec<[f64; 3]>,
    cells: Vec<[u32; 8]>,
    /// Index of the first cell of each block.
    blocks: Vec<usize>,
}

impl Hexahedra {
    /// Adds a block of `counts` cells whose node (i, j, k) is at `place([i, j, k])`.
    pub fn add_block(&mut self, counts: [usize; 3], place: impl Fn([usize; 3]) -> [f64; 3]) {
        let first = self.points.len();
        let [ni, nj, nk] = counts;
        for i in 0..=ni {
            for j in 0..=nj {
                for k in 0..=nk {
                    self.points.push(place([i, j, k]));
                }
            }
        }
        let node = |i, j, k| (first + (i * (nj + 1) + j) * (nk + 1) + k) as u32;
        self.blocks.push(self.cells.len());
        for i in 0..ni {
            for j in 0..nj {
                for k in 0..nk {
                    let floor = |k| {
                        [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)]
                    };
                    let ([a, b, c, d], [e, f, g, h]) = (floor(k), floor(k + 1));
                    self.cells.push([a, b, c, d, e, f, g, h]);
                }
            }
        }
    }

    /// Joins the blocks and cuts every cell into six tetrahedra.
    ///
    /// # Errors
    /// [`MeshError::InvertedCell`] if a cell is folded or inverted relative to the others of its block.
    pub fn into_mesh(mut self) -> Result<TetMesh, MeshError> {
        if u32::try_from(self.points.len()).is_err() {
            return Err(MeshError::TooLarge { count: self.points.len() });
        }
        self.weld();
        let mut tets = Vec::with_capacity(6 * self.cells.len());
        for (block, &start) in self.blocks.iter().enumerate() {
            let end = self.blocks.get(block + 1).copied().unwrap_or(self.cells.len());
            let mut sign = 0.0;
            for (index, &cell) in self.cells[start..end].iter().enumerate() {
                for mut tet in cut(cell) {
                    let points = tet.map(|node| Vector3::from(self.points[node as usize]));
                    let volume = straight_volume(points);
                    if sign == 0.0 {
                        sign = volume.signum();
                    }
                    let in_order = volume * sign > 0.0;
                    if !in_order {
                        return Err(MeshError::InvertedCell { block, cell: index });
                    }
                    if sign < 0.0 {
                        tet.swap(1, 2);
                    }
                    tets.push(tet);
                }
            }
        }
        TetMesh::new(self.points, Elements::Linear(tets))
    }

    fn weld(&mut self) {
        let (mut low, mut high) =
            (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        for &point in &self.points {
            low = low.inf(&Vector3::from(point));
            high = high.sup(&Vector3::from(point));
        }
        let first_at = coincident_nodes(&self.points, WELD * (high - low).norm());
        let mut new_index = vec![0; self.points.len()];
        let mut kept = Vec::new();
        for (node, &first) in first_at.iter().enumerate() {
            if first as usize == node {
                new_index[node] = kept.len() as u32;
                kept.push(self.points[node]);
            } else {
                new_index[node] = new_index[first as usize];
            }
        }
        self.points = kept;
        for cell in &mut self.cells {
            *cell = cell.map(|node| new_index[node as usize]);
        }
    }
}

/// The six tetrahedra of a cell. All have the orientation of the cell.
fn cut(cell: [u32; 8]) -> [[u32; 4]; 6] {
    let apex = cell.into_iter().fold(u32::MAX, u32::min);
    let mut tets = [[apex; 4]; 6];
    let mut next = 0;
    for (side, corners) in SIDES.into_iter().enumerate() {
        let [a, b, c, d] = corners.map(|corner| cell[corner]);
        if [a, b, c, d].contains(&apex) {
            continue;
        }
        let triangles =
            if a.min(c) < b.min(d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        for [p, q, r] in triangles {
            // The bottom is listed with inward orientation, the other sides outward.
            tets[next] = if side == 0 { [apex, p, r, q] } else { [apex, p, q, r] };
            next += 1;
        }
    }
    tets
}
