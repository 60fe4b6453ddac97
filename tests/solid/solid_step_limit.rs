//! The step limit of a deformed solid against dense matrices: every element's stiffness by numerical
//! differences of its nodal forces, put together and solved without the code under test. And its mass
//! matrices against integrals by a rule of the test's own.

use crate::solid_common;

use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, Penalty};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::tet_mesh::{Elements, Order};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::contact::closed_limit;
use bearing_dynamics::solids::explicit::ExplicitMethod;
use bearing_dynamics::solids::model::{Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::step_limit::{step_limit, step_limit_within};
use bearing_dynamics::solids::tangent::{MassMatrix, Unknowns, mass, pattern};
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
    dense_with(model, displacement, &[])
}

/// A node that a surface holds along a direction.
struct Spring {
    node: usize,
    along: Vector3<f64>,
    /// N/m.
    stiffness: f64,
}

fn dense_with(model: &SolidModel, displacement: &[Vec3], springs: &[Spring]) -> Dense {
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
    for Spring { node, along, stiffness } in springs {
        for (i, j) in (0..9).map(|at| (at / 3, at % 3)) {
            let (row, column) = (3 * node + i, 3 * node + j);
            if !held(row) && !held(column) {
                whole[(row, column)] += stiffness * along[i] * along[j] / model.mass[*node];
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

/// A contact that is closed at every node, along whatever normals: the limit is never above that of
/// the assembled matrix, never below what the largest spring can do to it, and the matrix' own where
/// springs are all that counts.
#[test]
fn the_limit_with_a_closed_contact_is_that_of_the_assembled_matrix() {
    for order in [Order::Linear, Order::Quadratic] {
        for method in [METHOD, ExplicitMethod::RungeKutta] {
            let mut problem = block(order);
            let low = (0..problem.nodes.len() as u32).filter(|n| n % 5 == 0);
            hold(&mut problem, low.map(|node| (node, node as usize % 3)));
            let model = SolidModel::new(problem).unwrap();
            let still = vec![[0.0; 3]; model.mass.len()];
            let own = step_limit(&model, &padded(&still), method);
            let alone = dense(&model, &still).highest;
            // Nodes that are free, or nodes that are held along one axis each; with shares of a surface
            // and normals of all kinds, none of them along a component that is held.
            for are_held in [false, true] {
                let touched: Vec<ContactNode> = (0..model.mass.len() as u32)
                    .filter(|node| {
                        if are_held {
                            *node > 0 && node % 5 == 0
                        } else {
                            node % 3 == 1 && node % 5 != 0
                        }
                    })
                    .map(|node| {
                        let place = model.problem.nodes[node as usize];
                        ContactNode { node, place, area: 1e-6 * (1.0 + f64::from(node % 7)) }
                    })
                    .collect();
                let lightest = touched.iter().map(|n| n.area / model.mass[n.node as usize]);
                let per_stiffness = lightest.fold(0.0, f64::max);
                // Springs of a hundredth of the body's own stiffness, as stiff, and far stiffer.
                for share in [0.0, 0.01, 1.0, 1e4] {
                    let stiffness = share * alone * alone / per_stiffness;
                    let per_area = Penalty::PerArea(stiffness);
                    let per_node = Penalty::PerNode(stiffness * 2e-6);
                    for penalty in [per_area, per_node] {
                        let of_node = |node: &ContactNode| match penalty {
                            Penalty::PerArea(k) => k * node.area,
                            Penalty::PerNode(k) => k,
                        };
                        let springs: Vec<Spring> = touched
                            .iter()
                            .map(|node| {
                                let turn = 0.9 * f64::from(node.node);
                                let along =
                                    Vector3::new(turn.cos(), turn.sin(), 0.7 * (3.0 * turn).sin());
                                let node_at = node.node as usize;
                                let mut along = along;
                                if are_held {
                                    along[node_at % 3] = 0.0;
                                }
                                let along = along.normalize();
                                Spring { node: node_at, along, stiffness: of_node(node) }
                            })
                            .collect();
                        let exact = dense_with(&model, &still, &springs).highest;
                        let found = closed_limit(&model, &touched, penalty, &own);
                        let (low, high) = (exact * (1.0 - 1e-4), {
                            let added = springs.iter().map(|s| s.stiffness / model.mass[s.node]);
                            let added = added.fold(0.0, f64::max);
                            (alone * alone + added).sqrt() * (1.0 + 1e-12)
                        });
                        let frequency = found.frequency;
                        let said = format!("{order:?} {share} {penalty:?}: {frequency} of {exact}");
                        // The body's own part is known to 1e-4, from below.
                        assert!(frequency >= low && frequency <= high, "{said}");
                        if share == 1e4 {
                            assert!((frequency / exact - 1.0).abs() <= 1e-3, "{said}");
                        }
                        let reach = own.step * own.frequency;
                        assert!((found.step * frequency / reach - 1.0).abs() <= 1e-14, "{said}");
                    }
                }
            }
        }
    }
}

/// Gauss' points and weights on 0 … 1, by Newton's method on the Legendre polynomial.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    let point = |k: usize| {
        let n = count as f64;
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut now, mut before) = (x, 1.0);
            for degree in 2..=count {
                let d = degree as f64;
                (now, before) = (((2.0 * d - 1.0) * x * now - (d - 1.0) * before) / d, now);
            }
            slope = n * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(point).collect()
}

/// Shape functions of a tetrahedron of four or ten nodes at barycentric coordinates.
fn shapes(nodes: usize, l: [f64; 4]) -> Vec<f64> {
    if nodes == 4 {
        return l.to_vec();
    }
    const BETWEEN: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    let corners = l.iter().map(|l| l * (2.0 * l - 1.0));
    corners.chain(BETWEEN.iter().map(|[a, b]| 4.0 * l[*a] * l[*b])).collect()
}

/// ρ∫NᵢNⱼ dV of one element: a cube of Gauss' points folded onto the tetrahedron, places by the shape
/// functions, their slopes by differences.
fn integrals(places: &[Vec3], density: f64) -> DMatrix<f64> {
    let count = places.len();
    let mut sum = DMatrix::zeros(count, count);
    let corners = |r: [f64; 3]| [1.0 - r[0] - r[1] - r[2], r[0], r[1], r[2]];
    let place = |r: [f64; 3]| -> Vector3<f64> {
        let n = shapes(count, corners(r));
        places.iter().zip(&n).map(|(x, n)| Vector3::from(*x) * *n).sum()
    };
    let rule = gauss(8);
    for at in 0..512 {
        let [(u, a), (v, b), (w, c)] = [rule[at / 64], rule[at / 8 % 8], rule[at % 8]];
        let r = [u, v * (1.0 - u), w * (1.0 - u) * (1.0 - v)];
        let fold = (1.0 - u) * (1.0 - u) * (1.0 - v);
        // Places are of second degree, so that central differences are exact but for rounding.
        let slope = |i: usize| {
            let by =
                |sign: f64| std::array::from_fn(|j| if i == j { r[j] + sign * 0.1 } else { r[j] });
            (place(by(1.0)) - place(by(-1.0))) / 0.2
        };
        let volume = slope(0).dot(&slope(1).cross(&slope(2)));
        let n = shapes(count, corners(r));
        for i in 0..count {
            for j in 0..count {
                sum[(i, j)] += density * a * b * c * fold * volume * n[i] * n[j];
            }
        }
    }
    sum
}

/// Both mass matrices of a whole body, of straight and of curved elements, against ρ∫NᵢNⱼ dV.
#[test]
fn masses_are_the_integrals_of_the_shape_functions() {
    let weights = gauss(8).iter().map(|(x, w)| w * x.powi(15)).sum::<f64>();
    assert!((weights * 16.0 - 1.0).abs() <= 1e-13, "{weights}");
    for (order, bulge) in [(Order::Linear, 0.0), (Order::Quadratic, 0.0), (Order::Quadratic, 0.03)]
    {
        let mut problem = block(order);
        // Every node, those between corners too, goes along a bulge that is no quadratic.
        for x in &mut problem.nodes {
            let push = bulge * 0.01 * (250.0 * x[0] + 180.0 * x[1] + 320.0 * x[2]).sin();
            x.iter_mut().for_each(|x| *x += push);
        }
        let count = problem.nodes.len();
        let mut exact = DMatrix::<f64>::zeros(count, count);
        let mut lumped = vec![0.0; count];
        for element in 0..problem.elements.len() {
            let nodes = problem.elements.nodes(element);
            let places: Vec<Vec3> = nodes.iter().map(|n| problem.nodes[*n as usize]).collect();
            let own = integrals(&places, problem.density);
            // Hinton, Rock and Zienkiewicz: the diagonal, scaled to the whole.
            let scale = own.sum() / own.trace();
            for (i, a) in nodes.iter().enumerate() {
                lumped[*a as usize] += scale * own[(i, i)];
                for (j, b) in nodes.iter().enumerate() {
                    exact[(*a as usize, *b as usize)] += own[(i, j)];
                }
            }
        }
        let model = SolidModel::new(problem).unwrap();
        let unknowns = Unknowns::new(&model);
        let mut matrix = pattern(&model.problem, &unknowns);
        mass(&model, &unknowns, MassMatrix::Consistent, &mut matrix);
        let largest = exact.amax();
        // Products are of fourth degree, which the rule of straight elements takes exactly; a curved
        // one's volume adds up to three degrees, which the rule sees to a part in 1e4 here.
        let allowed = if bulge == 0.0 { 1e-12 } else { 1e-3 };
        let (mut x, mut y) = (vec![0.0; unknowns.count], vec![0.0; unknowns.count]);
        for b in 0..count {
            for axis in 0..3 {
                x.fill(0.0);
                x[unknowns.of[b][axis]] = 1.0;
                matrix.multiply(&x, &mut y);
                for a in 0..count {
                    for other in 0..3 {
                        let expected = if axis == other { exact[(a, b)] } else { 0.0 };
                        let off = (y[unknowns.of[a][other]] - expected).abs() / largest;
                        assert!(off <= allowed, "{order:?} {bulge} {a} {b}: {off}");
                    }
                }
            }
            // A whole row is ∫ρNᵢ dV: fifth degree, exact for curved elements too.
            let row: f64 = y.iter().sum();
            let expected = exact.row(b).sum();
            assert!((row - expected).abs() <= 1e-12 * largest, "{order:?} {bulge} {b}: {row}");
            let off = (model.mass[b] - lumped[b]).abs() / largest;
            assert!(off <= allowed, "{order:?} {bulge} {b}: lumped off by {off}");
        }
        let whole: f64 = model.mass.iter().sum();
        assert!((whole / exact.sum() - 1.0).abs() <= 1e-13, "{order:?} {bulge}: {whole}");
    }
}
