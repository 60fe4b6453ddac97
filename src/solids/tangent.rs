//! Tangent stiffness and consistent mass of a solid as sparse matrices over its free components.

use crate::elements::tet4::{Tet4, relative};
use crate::elements::tet10::{self, Tet10};
use crate::kinematics::strain::Mat3;
use crate::kinematics::vec3::{Vec3, add_scaled};
use crate::mesh::tet_mesh::Elements;
use crate::numeric::sparse;
use crate::numeric::sparse::elimination::Elimination;
use crate::numeric::sparse::graph::Graph;
use crate::numeric::sparse::{Entry, Factor, FactorError, Ordering, SymmetricMatrix};
use crate::solids::model::{SolidModel, SolidProblem, corners};
use std::sync::Arc;

/// Marks a prescribed component.
pub const PRESCRIBED: usize = usize::MAX;

/// Unknown of each displacement component: three for each node, [`PRESCRIBED`] for prescribed ones. Unknowns are in the
/// order of elimination.
#[derive(Clone, Debug)]
pub struct Unknowns {
    pub of: Vec<[usize; 3]>,
    pub count: usize,
    /// Structure of the factors of a stiffness.
    pub elimination: Arc<Elimination>,
    /// Number of stored values of a stiffness, and of masses.
    pub stored: usize,
    pub mass_stored: usize,
}

impl Unknowns {
    /// Number of fixed and prescribed components.
    pub fn held(&self) -> usize {
        self.of.iter().flatten().filter(|index| **index == PRESCRIBED).count()
    }

    pub fn new(model: &SolidModel) -> Unknowns {
        Unknowns::ordered(model, Ordering::Cheapest)
    }

    /// Cholesky factors of a matrix over these unknowns.
    ///
    /// # Errors
    /// A matrix that is not positive definite; no memory.
    pub fn factor(&self, matrix: &SymmetricMatrix) -> Result<Factor, FactorError> {
        Factor::new(&self.elimination, matrix)
    }

    /// With a given ordering.
    pub fn ordered(model: &SolidModel, ordering: Ordering) -> Unknowns {
        let problem = &model.problem;
        let elements = (0..problem.elements.len()).map(|element| problem.elements.nodes(element));
        let free: Vec<_> = model.per_mass.iter().map(|m| [0, 1, 2].map(|i| m[i] != 0.0)).collect();
        Unknowns::over(&problem.nodes, elements, &free, ordering)
    }

    /// For any elements over `nodes`, with the free components of each node.
    pub fn over<'a>(
        nodes: &[Vec3],
        elements: impl Iterator<Item = &'a [u32]> + Clone,
        is_free: &[[bool; 3]],
        ordering: Ordering,
    ) -> Unknowns {
        let free = |node: u32| is_free[node as usize].iter().filter(|free| **free).count();
        let graph = Graph::of_elements(nodes.len(), elements, |node| free(node) > 0);
        let (order, elimination) = sparse::ordered(&graph, nodes, free, ordering);
        let (stored, mass_stored) = stored(&graph, is_free);
        drop(graph);
        let mut count = 0;
        let mut of = vec![[PRESCRIBED; 3]; nodes.len()];
        for node in order {
            for i in 0..3 {
                if is_free[node as usize][i] {
                    of[node as usize][i] = count;
                    count += 1;
                }
            }
        }
        let elimination = Arc::new(elimination);
        Unknowns { of, count, elimination, stored, mass_stored }
    }
}

/// Values of the lower triangle of a stiffness and of a mass matrix.
fn stored(graph: &Graph, is_free: &[[bool; 3]]) -> (usize, usize) {
    let free = |node: u32| is_free[node as usize].map(usize::from);
    let (mut stiffness, mut mass) = (0, 0);
    for node in 0..graph.nodes() as u32 {
        let own = free(node);
        let weight: usize = own.iter().sum();
        stiffness += weight * (weight + 1) / 2;
        mass += weight;
        for other in graph.of(node).iter().filter(|other| **other > node).map(|o| free(*o)) {
            stiffness += weight * other.iter().sum::<usize>();
            mass += (0..3).map(|i| own[i] * other[i]).sum::<usize>();
        }
    }
    (stiffness, mass)
}

fn graph(problem: &SolidProblem) -> Graph {
    let elements = (0..problem.elements.len()).map(|element| problem.elements.nodes(element));
    Graph::of_elements(problem.nodes.len(), elements, |_| true)
}

/// An empty matrix with room for every pair of components that share an element.
pub fn pattern(problem: &SolidProblem, unknowns: &Unknowns) -> SymmetricMatrix {
    places(&graph(problem), unknowns, |_, _| true)
}

/// The same for any elements over `count` nodes.
pub fn pattern_over<'a>(
    count: usize,
    elements: impl Iterator<Item = &'a [u32]> + Clone,
    unknowns: &Unknowns,
) -> SymmetricMatrix {
    places(&Graph::of_elements(count, elements, |_| true), unknowns, |_, _| true)
}

/// An empty matrix for every pair of equal components that share an element: masses.
pub fn mass_pattern(problem: &SolidProblem, unknowns: &Unknowns) -> SymmetricMatrix {
    places(&graph(problem), unknowns, |i, j| i == j)
}

fn places(
    graph: &Graph,
    unknowns: &Unknowns,
    together: impl Fn(usize, usize) -> bool,
) -> SymmetricMatrix {
    let mut places = vec![(0, 0); unknowns.count];
    for (node, of) in (0u32..).zip(&unknowns.of) {
        for axis in 0..3 {
            if of[axis] != PRESCRIBED {
                places[of[axis]] = (node, axis);
            }
        }
    }
    SymmetricMatrix::new(unknowns.count, |column, rows| {
        let (node, axis) = places[column];
        let from = rows.len();
        for other in graph.of(node).iter().chain([&node]) {
            for (other_axis, row) in unknowns.of[*other as usize].into_iter().enumerate() {
                if row != PRESCRIBED && row >= column && together(axis, other_axis) {
                    rows.push(row as u32);
                }
            }
        }
        rows[from..].sort_unstable();
    })
}

/// Fills `matrix` with the tangent stiffness at given displacements, N/m.
pub fn stiffness(
    model: &SolidModel,
    unknowns: &Unknowns,
    displacement: &[Vec3],
    matrix: &mut SymmetricMatrix,
) {
    matrix.clear();
    let problem = &model.problem;
    let law = |strain: &_| problem.material.second_piola_kirchhoff(strain);
    let sound = "elements were checked when the model was made";
    match &problem.elements {
        Elements::Linear(list) => {
            for nodes in list {
                let tet = Tet4::new(&corners(&problem.nodes, nodes)).expect(sound);
                let moved = relative(&corners(displacement, nodes));
                add_element(unknowns, nodes, matrix, |node, axis| {
                    let mut change = [[0.0; 3]; 4];
                    change[node][axis] = -1.0;
                    let [a, b, c] = tet.force_change(&moved, &relative(&change), law);
                    [a, b, c, [0, 1, 2].map(|i: usize| -(a[i] + b[i] + c[i]))]
                });
            }
        }
        Elements::Quadratic(list) => {
            for nodes in list {
                let tet = Tet10::new(&corners(&problem.nodes, nodes)).expect(sound);
                let moved = corners(displacement, nodes);
                add_element(unknowns, nodes, matrix, |node, axis| {
                    let mut change = [[0.0; 3]; 10];
                    change[node][axis] = -1.0;
                    tet.force_change(&moved, &change, law)
                });
            }
        }
    }
}

/// Adds an element given by its columns: forces per unit of minus one component.
fn add_element<const N: usize>(
    unknowns: &Unknowns,
    nodes: &[u32; N],
    matrix: &mut SymmetricMatrix,
    column_of: impl Fn(usize, usize) -> [Vec3; N],
) {
    for b in 0..N {
        for j in 0..3 {
            let column = unknowns.of[nodes[b] as usize][j];
            if column == PRESCRIBED {
                continue;
            }
            let values = column_of(b, j);
            for a in 0..N {
                for i in 0..3 {
                    let row = unknowns.of[nodes[a] as usize][i];
                    if row != PRESCRIBED && row >= column {
                        matrix.add(Entry { row, column }, values[a][i]);
                    }
                }
            }
        }
    }
}

/// Adds a symmetric stiffness at one node.
pub fn add_at_node(unknowns: &Unknowns, node: u32, stiffness: &Mat3, matrix: &mut SymmetricMatrix) {
    let of = unknowns.of[node as usize];
    for i in 0..3 {
        for j in 0..=i {
            if of[i] != PRESCRIBED && of[j] != PRESCRIBED {
                matrix.add(Entry { row: of[i], column: of[j] }, stiffness[i][j]);
            }
        }
    }
}

/// Kind of mass matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassMatrix {
    #[default]
    Consistent,
    /// Diagonal, as in explicit steps.
    Lumped,
}

/// Fills `matrix` with masses, kg.
pub fn mass(
    model: &SolidModel,
    unknowns: &Unknowns,
    kind: MassMatrix,
    matrix: &mut SymmetricMatrix,
) {
    matrix.clear();
    if kind == MassMatrix::Lumped {
        for (of, mass) in unknowns.of.iter().zip(&model.mass) {
            for &row in of.iter().filter(|row| **row != PRESCRIBED) {
                matrix.add(Entry { row, column: row }, *mass);
            }
        }
        return;
    }
    consistent_shares(&model.problem, |a, b, share| {
        for i in 0..3 {
            let (row, column) = (unknowns.of[a][i], unknowns.of[b][i]);
            if row != PRESCRIBED && column != PRESCRIBED && row >= column {
                matrix.add(Entry { row, column }, share);
            }
        }
    });
}

/// Consistent mass times a displacement of all nodes (m), kg·m.
pub fn consistent_momentum(model: &SolidModel, shape: &[Vec3]) -> Vec<Vec3> {
    let mut momentum = vec![[0.0; 3]; shape.len()];
    consistent_shares(&model.problem, |a, b, share| {
        momentum[a] = add_scaled(momentum[a], share, shape[b]);
    });
    momentum
}

/// Calls `add` with two nodes of each element and the consistent mass between them, kg.
fn consistent_shares(problem: &SolidProblem, mut add: impl FnMut(usize, usize, f64)) {
    let sound = "elements were checked when the model was made";
    match &problem.elements {
        Elements::Linear(list) => {
            for nodes in list {
                let tet = Tet4::new(&corners(&problem.nodes, nodes)).expect(sound);
                for a in 0..4 {
                    for b in 0..4 {
                        let share = tet.consistent_mass(problem.density, a, b);
                        add(nodes[a] as usize, nodes[b] as usize, share);
                    }
                }
            }
        }
        Elements::Quadratic(list) => {
            for nodes in list {
                let shares =
                    tet10::consistent_mass(&corners(&problem.nodes, nodes), problem.density);
                for a in 0..10 {
                    for b in 0..10 {
                        add(nodes[a] as usize, nodes[b] as usize, shares[a][b]);
                    }
                }
            }
        }
    }
}
