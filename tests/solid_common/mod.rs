//! Blocks of steel in irregular tetrahedra.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::mesh::measure::{Share, tributary_areas};
use bearing_dynamics::mesh::quadratic::elevate;
use bearing_dynamics::mesh::tet_mesh::{Elements, Order};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::model::{DampedMotion, Load, Prescribed, SolidProblem};

pub const YOUNG: f64 = 2.1e11;
pub const DENSITY: f64 = 7800.0;

/// A block of `size` in cells of six tetrahedra each. Nodes for which `shaken` says so, given whether
/// they are inside, are moved by up to `share` of a cell.
pub fn cut_cubes(
    size: Vec3,
    cells: [usize; 3],
    share: f64,
    shaken: impl Fn(bool) -> bool,
) -> TetMesh {
    let [a, b, c] = cells;
    let id = |i: usize, j: usize, k: usize| ((i * (b + 1) + j) * (c + 1) + k) as u32;
    let mut nodes = Vec::new();
    for i in 0..=a {
        for j in 0..=b {
            for k in 0..=c {
                let inner = i > 0 && i < a && j > 0 && j < b && k > 0 && k < c;
                let shake = |seed: f64| {
                    let by = share * (seed * (1 + i + 7 * j + 31 * k) as f64).sin();
                    if shaken(inner) { by } else { 0.0 }
                };
                nodes.push([
                    size[0] * (i as f64 + shake(12.9)) / a as f64,
                    size[1] * (j as f64 + shake(78.2)) / b as f64,
                    size[2] * (k as f64 + shake(37.7)) / c as f64,
                ]);
            }
        }
    }
    const CUT: [[usize; 4]; 6] =
        [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
    let mut linear = Vec::new();
    for i in 0..a {
        for j in 0..b {
            for k in 0..c {
                let corner = [
                    id(i, j, k),
                    id(i + 1, j, k),
                    id(i + 1, j + 1, k),
                    id(i, j + 1, k),
                    id(i, j, k + 1),
                    id(i + 1, j, k + 1),
                    id(i + 1, j + 1, k + 1),
                    id(i, j + 1, k + 1),
                ];
                linear.extend(CUT.map(|tet| tet.map(|n| corner[n])));
            }
        }
    }
    TetMesh::new(nodes, Elements::Linear(linear)).unwrap()
}

/// A free body of such a mesh in elements of this order, without load or damping.
pub fn solid(mesh: TetMesh, order: Order) -> SolidProblem {
    let mesh = match order {
        Order::Linear => mesh,
        Order::Quadratic => elevate(&mesh, &[]).unwrap().mesh,
    };
    free(&mesh, 0.3)
}

/// A free body of this mesh and Poisson's ratio, without load or damping.
pub fn free(mesh: &TetMesh, poisson: f64) -> SolidProblem {
    SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material: LinearElastic::new(YOUNG, poisson).unwrap(),
        density: DENSITY,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    }
}

/// A bar held at its lower end along X, under a force (N) spread over the other one.
pub fn end_loaded(mesh: &TetMesh, poisson: f64, force: Vec3) -> SolidProblem {
    let faces = |name: &str| mesh.surface_set(name).unwrap();
    let shares = tributary_areas(mesh, faces("x_high"), Share::Consistent);
    let total: f64 = shares.iter().sum();
    let of = |(node, share): (u32, &f64)| (node, force.map(|along| along * share / total));
    let forces = (0..).zip(&shares).filter(|(_, share)| **share != 0.0).map(of).collect();
    let hold =
        |node: &u32| [0, 1, 2].map(|axis| Prescribed { node: *node, axis, profile: Profile::ZERO });
    SolidProblem {
        prescribed: mesh.nodes_of_faces(faces("x_low")).iter().flat_map(hold).collect(),
        loads: vec![Load { forces, profile: Profile::Constant(1.0) }],
        ..free(mesh, poisson)
    }
}
