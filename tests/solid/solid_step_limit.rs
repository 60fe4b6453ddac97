//! The step limit of a deformed solid against dense matrices: every element's stiffness by numerical
//! differences of its nodal forces, put together and solved without the code under test.

use crate::solid_common;

use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, Penalty};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::tet_mesh::{Elements, Order};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::contact::closed_limit;
use bearing_dynamics::solver::solid::explicit::ExplicitMethod;
use bearing_dynamics::solver::solid::model::{Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solver::solid::step_limit::{step_limit, step_limit_within};
use nalgebra::{DMatrix, Rotation3, Vector3};
use solid_common::{cut_cubes, solid};

const METHOD: ExplicitMethod = ExplicitMethod::CentralDifferences;

/// Two cubes of 10 mm in twelve irregular elements.
fn block(order: Order) -> SolidProblem {
    solid(cut_cubes([0.02, 0.01, 0.01], [2, 1, 1], 0.1, |_| true), order)
}

fn hold(problem: &mut SolidProblem, components: impl Iterator<Item = (u32, usize)>) {
    let zero = |(node, axis)| Prescribed { node, axis, profile: Profile::ZERO };
    problem.prescribed.extend(components.map(zero));
}

fn padded(list: &[Vec3]) -> Vec<[f64; 4]> {
    list.iter().map(|v| [v[0], v[1], v[2], 0.0]).collect()
}

/// Displacements of a body that is stretched, uniformly and a little unevenly, and then turned.
fn stretched(problem: &SolidProblem, stretch: [f64; 3], turn: [f64; 3]) -> Vec<Vec3> {
    let turn = Rotation3::from_euler_angles(turn[0], turn[1], turn[2]);
    let moved = |x: &Vec3| {
        let mut place: Vector3<f64> = Vector3::from(*x);
        for i in 0..3 {
            place[i] *= 1.0 + stretch[i] * (1.0 + 10.0 * x[(i + 1) % 3]);
        }
        (turn * place - Vector3::from(*x)).into()
    };
    problem.nodes.iter().map(moved).collect()
}

/// The element alone, its nodes in its own order.
fn alone(problem: &SolidProblem, element: usize) -> SolidModel {
    let nodes = problem.elements.nodes(element);
    let elements = match problem.elements {
        Elements::Linear(_) => Elements::Linear(vec![[0, 1, 2, 3]]),
        Elements::Quadratic(_) => Elements::Quadratic(vec![[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]]),
    };
    SolidModel::new(SolidProblem {
        nodes: nodes.iter().map(|n| problem.nodes[*n as usize]).collect(),
        elements,
        prescribed: Vec::new(),
        ..problem.clone()
    })
    .unwrap()
}

/// Stiffness of every element over its own components, by central differences of its nodal forces.
fn stiffnesses(problem: &SolidProblem, displacement: &[Vec3]) -> Vec<DMatrix<f64>> {
    // Forces are cubic in displacements: of 1e-9 m, a part in 1e7 of an edge, nothing but rounding is
    // left, 1e-16 of strains of up to 2 over 1e-7.
    const BY: f64 = 1e-9;
    let of = |element: usize| {
        let model = alone(problem, element);
        let nodes = problem.elements.nodes(element);
        let start: Vec<Vec3> = nodes.iter().map(|n| displacement[*n as usize]).collect();
        let forces = |column: usize, by: f64| {
            let mut moved = padded(&start);
            moved[column / 3][column % 3] += by;
            let mut forces = vec![[0.0; 4]; moved.len()];
            model.add_internal_forces_plain(&moved, &mut forces);
            forces
        };
        let size = 3 * nodes.len();
        let mut matrix = DMatrix::zeros(size, size);
        for column in 0..size {
            let (ahead, behind) = (forces(column, BY), forces(column, -BY));
            for row in 0..size {
                let (n, i) = (row / 3, row % 3);
                matrix[(row, column)] = (behind[n][i] - ahead[n][i]) / (2.0 * BY);
            }
        }
        matrix
    };
    (0..problem.elements.len()).map(of).collect()
}

/// Frequency and bound by dense matrices, rad/s.
struct Dense {
    /// Highest of the free components.
    highest: f64,
    /// From the largest sum of sizes along a row, element by element.
    bound: f64,
}

fn dense(model: &SolidModel, displacement: &[Vec3]) -> Dense {
    dense_on_springs(model, displacement, &[])
}

/// With springs from nodes to the ground: node, direction (a unit vector), N/m.
fn dense_on_springs(
    model: &SolidModel,
    displacement: &[Vec3],
    springs: &[(u32, Vec3, f64)],
) -> Dense {
    let problem = &model.problem;
    let size = 3 * problem.nodes.len();
    let held = |row: usize| {
        let at = ((row / 3) as u32, row % 3);
        problem.prescribed.iter().any(|held| (held.node, held.axis) == at)
    };
    let mut whole = DMatrix::<f64>::zeros(size, size);
    let mut sums = vec![0.0; size];
    for (element, matrix) in stiffnesses(problem, displacement).iter().enumerate() {
        let nodes = problem.elements.nodes(element);
        let place = |own: usize| 3 * nodes[own / 3] as usize + own % 3;
        for a in 0..matrix.nrows() {
            for b in 0..matrix.ncols() {
                let (row, column) = (place(a), place(b));
                if !held(row) && !held(column) {
                    let scale = (model.mass[row / 3] * model.mass[column / 3]).sqrt();
                    whole[(row, column)] += matrix[(a, b)] / scale;
                    sums[row] += matrix[(a, b)].abs() / model.mass[row / 3];
                }
            }
        }
    }
    for (node, direction, stiffness) in springs {
        for i in 0..3 {
            for j in 0..3 {
                let (row, column) = (3 * *node as usize + i, 3 * *node as usize + j);
                if !held(row) && !held(column) {
                    let added = stiffness * direction[i] * direction[j];
                    whole[(row, column)] += added / model.mass[*node as usize];
                }
            }
        }
    }
    let symmetric = (&whole + whole.transpose()) * 0.5;
    let highest = symmetric.symmetric_eigenvalues().max().sqrt();
    Dense { highest, bound: sums.into_iter().fold(0.0, f64::max).sqrt() }
}

/// Unloaded, stretched, compressed, and turned far: the limit is that of the tangent stiffness there,
/// initial stress and all.
#[test]
fn the_limit_of_a_deformed_solid_is_that_of_its_tangent() {
    let cases = [
        ([0.0; 3], [0.0; 3]),
        ([0.25, -0.02, 0.01], [0.0; 3]),
        ([-0.2, -0.15, -0.2], [0.0; 3]),
        ([0.2, 0.15, 0.25], [0.7, -1.1, 2.0]),
    ];
    for order in [Order::Linear, Order::Quadratic] {
        for (stretch, turn) in cases {
            let mut problem = block(order);
            let low = (0..problem.nodes.len() as u32).filter(|n| n % 5 == 0);
            hold(&mut problem, low.map(|node| (node, node as usize % 3)));
            let model = SolidModel::new(problem).unwrap();
            let displacement = stretched(&model.problem, stretch, turn);
            let found = step_limit(&model, &padded(&displacement), METHOD);
            let exact = dense(&model, &displacement);
            let off = found.frequency / exact.highest - 1.0;
            assert!(!found.is_bound);
            // The iteration ends where the square moves by 1e-5 a product, some products before its
            // end; it comes from below.
            assert!(off.abs() <= 1e-4, "{order:?} {stretch:?}: {off}");
            assert!((found.step * found.frequency / 2.0 - 1.0).abs() <= 1e-15);
        }
    }
}

/// Where the iteration does not settle: sums of sizes along rows, which no frequency exceeds and which
/// equal it where a single component is free.
#[test]
fn the_bound_is_the_largest_sum_along_a_row() {
    for order in [Order::Linear, Order::Quadratic] {
        let count = block(order).nodes.len() as u32;
        // All free; one node of a corner and one inside a side; one component.
        let free: [&dyn Fn(u32, usize) -> bool; 3] =
            [&|_, _| true, &|node, _| node == 5, &|node, axis| node == 5 && axis == 1];
        for (case, is_free) in free.into_iter().enumerate() {
            let mut problem = block(order);
            let all = (0..count).flat_map(|node| [0, 1, 2].map(|axis| (node, axis)));
            hold(&mut problem, all.filter(|(node, axis)| !is_free(*node, *axis)));
            let model = SolidModel::new(problem).unwrap();
            let displacement = stretched(&model.problem, [0.1, -0.05, 0.08], [0.3, 0.2, -0.4]);
            let found = step_limit_within(&model, &padded(&displacement), METHOD, 0);
            let exact = dense(&model, &displacement);
            assert!(found.is_bound);
            // Rounding of the differences, 1e-9 of a term.
            let off = found.frequency / exact.bound - 1.0;
            assert!(off.abs() <= 1e-7, "{order:?} {case}: {off}");
            assert!(found.frequency >= exact.highest * (1.0 - 1e-7), "{order:?} {case}");
            if case == 2 {
                assert!((exact.bound / exact.highest - 1.0).abs() <= 1e-14);
            }
        }
    }
}

/// A contact closed at every node: never slower than the solid on all its springs, and no faster than it
/// must be where a spring outdoes the solid, or where a single component is free.
#[test]
fn the_limit_with_a_closed_contact_is_that_of_the_solid_on_its_springs() {
    let places = |model: &SolidModel| -> Vec<ContactNode> {
        let touched = (0..model.problem.nodes.len() as u32).filter(|node| node % 4 == 1);
        let area = |node: u32| 1e-6 * f64::from(1 + node % 3);
        touched
            .map(|node| ContactNode {
                node,
                place: model.problem.nodes[node as usize],
                area: area(node),
            })
            .collect()
    };
    let direction = |node: u32| {
        let (sin, cos) = f64::from(node).sin_cos();
        [0.6, 0.8 * cos, 0.8 * sin]
    };
    for order in [Order::Linear, Order::Quadratic] {
        let model = SolidModel::new(block(order)).unwrap();
        let still = vec![[0.0; 3]; model.problem.nodes.len()];
        let alone = step_limit(&model, &padded(&still), METHOD);
        for penalty in [Penalty::PerNode(2.5e8), Penalty::PerArea(2.5e14), Penalty::PerArea(1e18)] {
            let nodes = places(&model);
            let springs: Vec<(u32, Vec3, f64)> = nodes
                .iter()
                .map(|node| (node.node, direction(node.node), penalty.of_node(node.area)))
                .collect();
            let exact = dense_on_springs(&model, &still, &springs).highest;
            let found = closed_limit(&model, &nodes, penalty, &alone);
            // The solid's own limit comes from below by 1e-4 at most.
            assert!(found.frequency >= exact * (1.0 - 1e-4), "{order:?} {penalty:?}");
            // The fastest motion has at least a spring's: ω² ≤ ω_solid² + K/m is off by ω_solid² at most.
            let over = found.frequency * found.frequency - exact * exact;
            assert!(over <= alone.frequency * alone.frequency, "{order:?} {penalty:?}: {over}");
            assert!((found.step * found.frequency / 2.0 - 1.0).abs() <= 1e-14);
        }
        // One node free along one axis, with its spring along it: the sum itself.
        let mut problem = block(order);
        let count = problem.nodes.len() as u32;
        let all = (0..count).flat_map(|node| [0, 1, 2].map(|axis| (node, axis)));
        hold(&mut problem, all.filter(|at| *at != (5, 1)));
        let model = SolidModel::new(problem).unwrap();
        let alone = step_limit(&model, &padded(&still), METHOD);
        let node = ContactNode { node: 5, place: model.problem.nodes[5], area: 3e-6 };
        let penalty = Penalty::PerArea(2.5e14);
        let springs = [(5, [0.0, 1.0, 0.0], penalty.of_node(node.area))];
        let exact = dense_on_springs(&model, &still, &springs).highest;
        let found = closed_limit(&model, &[node], penalty, &alone).frequency;
        assert!((found / exact - 1.0).abs() <= 1e-6, "{order:?}: {found} {exact}");
    }
}
