//! What cases of flexible solids share: problems from meshes, consistent loads, errors of fields.
//!
//! Loads and errors are integrated here with rules of their own (products of Gauss' rule on the
//! collapsed cube), not with those of the elements that they judge.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::mesh::generate::Solid;
use bearing_dynamics::mesh::node_order::EDGES;
use bearing_dynamics::mesh::{Elements, Face, MeshError, Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::model::{DampedMotion, Load, Prescribed, SolidProblem};

pub type Vec3 = [f64; 3];

/// Elastic constants and density of a body, SI.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    pub young: f64,
    pub poisson: f64,
    pub density: f64,
}

/// The steel of Table 2.3.
pub const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

/// The mesh of a generated body in elements of this order.
pub fn mesh_of(solid: &Solid, order: Order) -> Result<TetMesh, MeshError> {
    match order {
        Order::Linear => Ok(solid.mesh.clone()),
        Order::Quadratic => Ok(solid.quadratic()?.mesh),
    }
}

pub fn name_of(order: Order) -> &'static str {
    match order {
        Order::Linear => "tet4",
        Order::Quadratic => "tet10",
    }
}

/// A free body at rest, without load or damping.
pub fn free_body(mesh: &TetMesh, material: Material) -> SolidProblem {
    SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material: LinearElastic::new(material.young, material.poisson)
            .expect("constants of a case are in range"),
        density: material.density,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    }
}

/// Gives the displacement components of `axes` at nodes where `wanted` says so.
pub fn prescribe(problem: &mut SolidProblem, wanted: impl Fn(Vec3) -> [Option<f64>; 3]) {
    for (node, &place) in problem.nodes.iter().enumerate() {
        for (axis, value) in wanted(place).into_iter().enumerate() {
            if let Some(value) = value {
                let profile = Profile::Constant(value);
                problem.prescribed.push(Prescribed { node: node as u32, axis, profile });
            }
        }
    }
}

pub fn constant_load(forces: Vec<(u32, Vec3)>) -> Load {
    Load { forces, profile: Profile::Constant(1.0) }
}

/// The largest of some sizes, 0 of none; once not a number, always so (`f64::max` would drop it).
pub fn largest(sizes: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |most: f64, size: f64| if most.is_nan() || size <= most { most } else { size };
    sizes.into_iter().fold(0.0, larger)
}

/// Abscissas on (0, 1) and weights of Gauss' four-point rule.
fn gauss() -> [(f64, f64); 4] {
    let root = (6f64 / 5.0).sqrt();
    let (near, far) = ((3.0 - 2.0 * root) / 7.0, (3.0 + 2.0 * root) / 7.0);
    let (inner, outer) = ((18.0 + 30f64.sqrt()) / 36.0, (18.0 - 30f64.sqrt()) / 36.0);
    [(-far.sqrt(), outer), (-near.sqrt(), inner), (near.sqrt(), inner), (far.sqrt(), outer)]
        .map(|(x, w)| (0.5 + 0.5 * x, 0.5 * w))
}

/// Barycentric places and weights (sum 1) on a tetrahedron, exact to degree five.
pub fn tetrahedron_rule() -> Vec<([f64; 4], f64)> {
    let mut rule = Vec::new();
    for (a, wa) in gauss() {
        for (b, wb) in gauss() {
            for (c, wc) in gauss() {
                let (x, y, z) = (a, (1.0 - a) * b, (1.0 - a) * (1.0 - b) * c);
                let jacobian = (1.0 - a) * (1.0 - a) * (1.0 - b);
                rule.push(([1.0 - x - y - z, x, y, z], 6.0 * wa * wb * wc * jacobian));
            }
        }
    }
    rule
}

/// Barycentric places and weights (sum 1) on a triangle, exact to degree six.
fn triangle_rule() -> Vec<([f64; 3], f64)> {
    let mut rule = Vec::new();
    for (a, wa) in gauss() {
        for (b, wb) in gauss() {
            let (x, y) = (a, (1.0 - a) * b);
            rule.push(([1.0 - x - y, x, y], 2.0 * wa * wb * (1.0 - a)));
        }
    }
    rule
}

/// Shape functions of an element at barycentric coordinates, as many as it has nodes.
pub fn shape_functions(order: Order, l: [f64; 4]) -> Vec<f64> {
    match order {
        Order::Linear => l.to_vec(),
        Order::Quadratic => {
            let corners = l.iter().map(|x| x * (2.0 * x - 1.0));
            corners.chain(EDGES.iter().map(|&[a, b]| 4.0 * l[a] * l[b])).collect()
        }
    }
}

fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn straight_volume(mesh: &TetMesh, element: usize) -> f64 {
    let [a, b, c, d] = mesh.elements.corners(element).map(|n| mesh.nodes[n as usize]);
    let normal = cross(sub(b, a), sub(c, a));
    let up = sub(d, a);
    (normal[0] * up[0] + normal[1] * up[1] + normal[2] * up[2]) / 6.0
}

/// Calls `visit` with element nodes, shape functions, place and volume share of every quadrature
/// point of a mesh with straight edges.
fn for_each_point(mesh: &TetMesh, mut visit: impl FnMut(&[u32], &[f64], Vec3, f64)) {
    let order = mesh.order();
    let rule: Vec<_> = tetrahedron_rule()
        .into_iter()
        .map(|(l, weight)| (l, shape_functions(order, l), weight))
        .collect();
    for element in 0..mesh.elements.len() {
        let volume = straight_volume(mesh, element);
        let corners = mesh.elements.corners(element).map(|n| mesh.nodes[n as usize]);
        for (l, shapes, weight) in &rule {
            let place = [0, 1, 2].map(|i: usize| (0..4).map(|c| l[c] * corners[c][i]).sum());
            visit(mesh.elements.nodes(element), shapes, place, weight * volume);
        }
    }
}

/// Nodal forces of a force per undeformed volume (N/m³) on a mesh with straight edges: ∫N b dV.
pub fn body_force(mesh: &TetMesh, density: impl Fn(Vec3) -> Vec3) -> Vec<(u32, Vec3)> {
    let mut forces = vec![[0.0; 3]; mesh.nodes.len()];
    for_each_point(mesh, |nodes, shapes, place, volume| {
        let b = density(place);
        for (node, shape) in nodes.iter().zip(shapes) {
            for i in 0..3 {
                forces[*node as usize][i] += shape * volume * b[i];
            }
        }
    });
    forces.into_iter().enumerate().map(|(node, force)| (node as u32, force)).collect()
}

/// √(∫|u − exact|² dV / ∫|exact|² dV) on a mesh with straight edges.
pub fn field_error(mesh: &TetMesh, u: &[Vec3], exact: impl Fn(Vec3) -> Vec3) -> f64 {
    let (mut gap, mut whole) = (0.0, 0.0);
    for_each_point(mesh, |nodes, shapes, place, volume| {
        let should = exact(place);
        for i in 0..3 {
            let is: f64 = nodes.iter().zip(shapes).map(|(n, s)| s * u[*n as usize][i]).sum();
            gap += volume * (is - should[i]).powi(2);
            whole += volume * should[i].powi(2);
        }
    });
    (gap / whole).sqrt()
}

/// Nodal forces of a traction on faces, ∫N t dA, curved faces as they are; `traction` (Pa) gets the
/// place and the outward unit normal.
pub fn surface_force(
    mesh: &TetMesh,
    faces: &[Face],
    traction: impl Fn(Vec3, Vec3) -> Vec3,
) -> Vec<(u32, Vec3)> {
    let mut forces = vec![[0.0; 3]; mesh.nodes.len()];
    for &face in faces {
        let nodes: Vec<u32> = mesh.face_nodes(face).collect();
        let at: Vec<Vec3> = nodes.iter().map(|n| mesh.nodes[*n as usize]).collect();
        for ([u, v, w], weight) in triangle_rule() {
            // Shape functions and their derivatives by v and w, u following.
            let (shapes, by_v, by_w) = if nodes.len() == 3 {
                (vec![u, v, w], vec![-1.0, 1.0, 0.0], vec![-1.0, 0.0, 1.0])
            } else {
                let corner = |x: f64| x * (2.0 * x - 1.0);
                let slope = |x: f64| 4.0 * x - 1.0;
                (
                    vec![corner(u), corner(v), corner(w), 4.0 * u * v, 4.0 * v * w, 4.0 * w * u],
                    vec![-slope(u), slope(v), 0.0, 4.0 * (u - v), 4.0 * w, -4.0 * w],
                    vec![-slope(u), 0.0, slope(w), -4.0 * v, 4.0 * v, 4.0 * (u - w)],
                )
            };
            let sum = |shares: &[f64]| -> Vec3 {
                [0, 1, 2].map(|i: usize| shares.iter().zip(&at).map(|(s, x)| s * x[i]).sum())
            };
            let normal = cross(sum(&by_v), sum(&by_w));
            let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
            let t = traction(sum(&shapes), normal.map(|x| x / length));
            let area = 0.5 * weight * length;
            for (node, shape) in nodes.iter().zip(&shapes) {
                for i in 0..3 {
                    forces[*node as usize][i] += shape * area * t[i];
                }
            }
        }
    }
    let loaded = forces.into_iter().enumerate().filter(|(_, force)| *force != [0.0; 3]);
    loaded.map(|(node, force)| (node as u32, force)).collect()
}

/// How many nodes and elements, as tables say it.
pub fn size_of(mesh: &TetMesh) -> String {
    let elements = match &mesh.elements {
        Elements::Linear(list) => list.len(),
        Elements::Quadratic(list) => list.len(),
    };
    format!("{} nodes, {elements} elements", mesh.nodes.len())
}
