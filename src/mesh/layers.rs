//! Number of elements through the walls of a mesh.

use crate::kinematics::vec3::{Vec3, add, cross, dot, norm, scale, sub};
use crate::mesh::node_order::SIDES;
use crate::mesh::tet_mesh::Elements;

/// Number of elements through a wall and its thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Number of elements along the inward normal of a face: the sum over elements of the length of the normal inside
    /// each, divided by the element's height along it. 2 for two cells, however many tetrahedra fill a cell.
    pub elements: f64,
    /// Thickness of the wall, m, and the middle of the face from which it is measured.
    pub thickness: f64,
    pub at: Vec3,
}

/// Quantile of the walls: a fraction `part` of the surface has at most as many elements beneath it. A small `part`
/// gives the thinnest wall without edges and corners. `None` for a mesh without a surface.
pub fn thinnest_wall(nodes: &[Vec3], elements: &Elements, part: f64) -> Option<Wall> {
    let neighbours = neighbours(elements);
    let mut walls: Vec<(Wall, f64)> = Vec::new();
    for (face, neighbour) in neighbours.iter().enumerate() {
        if neighbour.is_none()
            && let Some(found) = wall_under(nodes, elements, &neighbours, face)
        {
            walls.push(found);
        }
    }
    // Among walls with equally many elements the thinner first; whole numbers of elements have rounding errors.
    let order = |wall: &Wall| [(1e6 * wall.elements).round(), wall.thickness];
    walls.sort_by(|a, b| {
        let ([many, thick], [others, other]) = (order(&a.0), order(&b.0));
        many.total_cmp(&others).then(thick.total_cmp(&other))
    });
    let all: f64 = walls.iter().map(|(_, area)| area).sum();
    let mut before = 0.0;
    walls
        .iter()
        .find(|(_, area)| {
            before += area;
            before >= part * all
        })
        .map(|(wall, _)| *wall)
}

/// Neighbour element across face 4 e + s of element e.
fn neighbours(elements: &Elements) -> Vec<Option<u32>> {
    let mut faces: Vec<([u32; 3], u32)> = Vec::with_capacity(4 * elements.len());
    for element in 0..elements.len() {
        let corners = elements.corners(element);
        for (side, nodes) in SIDES.iter().enumerate() {
            let mut key = nodes.map(|n| corners[n]);
            key.sort_unstable();
            faces.push((key, (4 * element + side) as u32));
        }
    }
    faces.sort_unstable();
    let mut neighbours = vec![None; faces.len()];
    for pair in faces.windows(2) {
        if let [(a, first), (b, second)] = pair
            && a == b
        {
            neighbours[*first as usize] = Some(second / 4);
            neighbours[*second as usize] = Some(first / 4);
        }
    }
    neighbours
}

/// Wall along the inward normal from the middle of a face; and the face's area, m².
fn wall_under(
    nodes: &[Vec3],
    elements: &Elements,
    neighbours: &[Option<u32>],
    face: usize,
) -> Option<(Wall, f64)> {
    let corners = |element: usize| elements.corners(element).map(|n| nodes[n as usize]);
    let outward = |at: &[Vec3; 4], side: usize| {
        let [a, b, c] = SIDES[side].map(|n| at[n]);
        (a, cross(sub(b, a), sub(c, a)))
    };
    let (mut element, mut entered) = (face / 4, face % 4);
    let first = corners(element);
    let (_, normal) = outward(&first, entered);
    let twice_area = norm(normal);
    let along = scale(normal, -1.0 / twice_area);
    let at = SIDES[entered].map(|n| first[n]);
    let at = scale(add(add(at[0], at[1]), at[2]), 1.0 / 3.0);
    let mut wall = Wall { elements: 0.0, thickness: 0.0, at };
    // Bounds the loop: no line passes an element twice.
    for _ in 0..elements.len() {
        let here = corners(element);
        let heights = here.map(|corner| dot(sub(corner, at), along));
        let height = heights.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
            - heights.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        let mut left: Option<(f64, usize)> = None;
        for side in (0..4).filter(|side| *side != entered) {
            let (corner, normal) = outward(&here, side);
            let against = dot(normal, along);
            let far = dot(normal, sub(corner, at)) / against;
            if against > 0.0 && left.is_none_or(|(nearest, _)| far < nearest) {
                left = Some((far, side));
            }
        }
        let (far, side) = left?;
        let length = (far - wall.thickness).max(0.0);
        wall.elements += length / height;
        wall.thickness += length;
        let Some(next) = neighbours[4 * element + side] else { break };
        let next = next as usize;
        let back = (0..4).find(|s| neighbours[4 * next + s] == Some(element as u32))?;
        (element, entered) = (next, back);
    }
    let sound = wall.elements.is_finite() && wall.thickness > 0.0 && twice_area > 0.0;
    sound.then_some((wall, 0.5 * twice_area))
}
