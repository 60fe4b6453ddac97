//! Node order of tetrahedra, and conversion from Gmsh's order.
//!
//! Corners 0…3 are ordered such that (p₁ − p₀) × (p₂ − p₀) · (p₃ − p₀) > 0. Mid-side nodes follow in the
//! order of VTK's quadratic tetrahedron, which is also that of Abaqus and CalculiX (C3D10):
//!
//! ```text
//! node  4      5      6      7      8      9
//! edge  0-1    1-2    0-2    0-3    1-3    2-3
//! ```
//!
//! Gmsh numbers the last two edges in the opposite order (2-3, then 1-3).

use crate::mesh::tet_mesh::Order;

/// Corner pairs of the edges whose middles are nodes 4…9.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];

/// Corners of the four sides, anticlockwise seen from outside. Side s is Abaqus' face S(s + 1).
pub const SIDES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// Corners a, b, c of the four sides, followed by the mid-side nodes of the edges a-b, b-c, c-a.
const QUADRATIC_SIDES: [[usize; 6]; 4] =
    [[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [2, 0, 3, 6, 7, 9]];

/// Local nodes of a side: three corners, then for a quadratic element three mid-side nodes.
pub fn side_nodes(order: Order, side: usize) -> &'static [usize] {
    match order {
        Order::Linear => &SIDES[side],
        Order::Quadratic => &QUADRATIC_SIDES[side],
    }
}

/// Converts a ten-node element between Gmsh's order and this program's; its own inverse.
pub fn swap_gmsh<T: Copy>(nodes: [T; 10]) -> [T; 10] {
    let [a, b, c, d, e, f, g, h, i, j] = nodes;
    [a, b, c, d, e, f, g, h, j, i]
}

/// Inverts a ten-node element: swaps corners 1 and 2, and the edges accordingly.
pub fn flip<T: Copy>(nodes: [T; 10]) -> [T; 10] {
    let [a, b, c, d, ab, bc, ac, ad, bd, cd] = nodes;
    [a, c, b, d, ac, bc, ab, ad, cd, bd]
}
