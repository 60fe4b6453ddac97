//! Order of elimination, structure of the factors and the memory that they need.

use crate::solid_common;

use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::tet_mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::numeric::sparse::dissection::nested_dissection;
use bearing_dynamics::numeric::sparse::graph::Graph;
use bearing_dynamics::numeric::sparse::separator::{Side, smallest_cuts};
use bearing_dynamics::numeric::sparse::{
    Entry, FactorError, Memory, Ordering, SymmetricMatrix, Task,
};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium_over};
use bearing_dynamics::solids::memory;
use bearing_dynamics::solids::model::{Load, Prescribed, SolidModel};
use bearing_dynamics::solids::tangent::{PRESCRIBED, Unknowns, mass_pattern, pattern, stiffness};
use solid_common::{cut_cubes, solid};
use std::collections::BTreeSet;

/// A block held at one end; some nodes of the other end are held along one axis only.
fn block(cells: [usize; 3], order: Order) -> SolidModel {
    let size: Vec3 = [0.01 * cells[0] as f64, 0.01 * cells[1] as f64, 0.01 * cells[2] as f64];
    let mut problem = solid(cut_cubes(size, cells, 0.2, |inner| inner), order);
    let hold = |node: usize, axis| Prescribed { node: node as u32, axis, profile: Profile::ZERO };
    let mut forces = Vec::new();
    for (node, x) in problem.nodes.iter().enumerate() {
        if x[0] <= 1e-9 {
            problem.prescribed.extend([0, 1, 2].map(|axis| hold(node, axis)));
        } else if x[0] >= size[0] - 1e-9 {
            forces.push((node as u32, [0.0, 0.0, -1.0]));
            if x[1] <= 1e-9 {
                problem.prescribed.push(hold(node, 1));
            }
        }
    }
    problem.loads = vec![Load { forces, profile: Profile::Constant(1.0) }];
    SolidModel::new(problem).unwrap()
}

fn stiffness_of(model: &SolidModel, unknowns: &Unknowns) -> SymmetricMatrix {
    let mut matrix = pattern(&model.problem, unknowns);
    stiffness(model, unknowns, &vec![[0.0; 3]; model.mass.len()], &mut matrix);
    matrix
}

/// Rows of each column of the factor, by elimination on paper: a column hands its rows to the first of
/// them.
fn eliminated(matrix: &SymmetricMatrix) -> Vec<BTreeSet<usize>> {
    let mut columns: Vec<BTreeSet<usize>> =
        (0..matrix.size()).map(|j| matrix.column(j).map(|(row, _)| row).collect()).collect();
    for j in 0..columns.len() {
        let below: Vec<usize> = columns[j].iter().copied().filter(|row| *row > j).collect();
        if let Some(parent) = below.first() {
            columns[*parent].extend(&below);
        }
    }
    columns
}

#[test]
fn unknowns_are_numbered_once_each() {
    let model = block([4, 3, 2], Order::Quadratic);
    for ordering in [Ordering::MinimumDegree, Ordering::NestedDissection, Ordering::Cheapest] {
        let unknowns = Unknowns::ordered(&model, ordering);
        let mut seen = vec![false; unknowns.count];
        for (of, per_mass) in unknowns.of.iter().zip(&model.per_mass) {
            for axis in 0..3 {
                assert_eq!(of[axis] == PRESCRIBED, per_mass[axis] == 0.0);
                if of[axis] != PRESCRIBED {
                    assert!(!std::mem::replace(&mut seen[of[axis]], true), "{ordering:?}");
                }
            }
        }
        assert!(seen.iter().all(|seen| *seen), "{ordering:?}");
    }
}

#[test]
fn the_structure_is_that_of_elimination() {
    for (cells, order) in [([3, 2, 2], Order::Linear), ([5, 4, 4], Order::Quadratic)] {
        let model = block(cells, order);
        for ordering in [Ordering::MinimumDegree, Ordering::NestedDissection] {
            let unknowns = Unknowns::ordered(&model, ordering);
            let elimination = &unknowns.elimination;
            let matrix = stiffness_of(&model, &unknowns);
            assert_eq!(matrix.stored(), unknowns.stored);
            assert_eq!(mass_pattern(&model.problem, &unknowns).stored(), unknowns.mass_stored);
            let columns = eliminated(&matrix);
            let nonzeros: usize = columns.iter().map(BTreeSet::len).sum();
            let mut next = 0;
            for panel in &elimination.panels {
                assert_eq!(panel.first, next);
                next += panel.columns;
                let outer = &elimination.rows[panel.outer.clone()];
                let own = panel.first..panel.first + panel.columns + panel.inner;
                let rows: BTreeSet<usize> =
                    own.chain(outer.iter().map(|row| *row as usize)).collect();
                assert_eq!(rows.len(), panel.height());
                for (column, held) in columns.iter().enumerate().take(next).skip(panel.first) {
                    assert!(held.is_subset(&rows), "{ordering:?} {column}");
                }
            }
            assert_eq!(next, unknowns.count);
            // The empty triangles of the panels and what their merging brings: much of little.
            let fill = elimination.fill;
            let most = if order == Order::Linear { 2.5 } else { 1.5 };
            assert!(fill >= nonzeros && fill as f64 <= most * nonzeros as f64, "{fill} {nonzeros}");
            let stored: usize = elimination.panels.iter().map(|p| p.height() * p.columns).sum();
            let factor = unknowns.factor(&matrix).unwrap();
            let estimated = memory::statics(&unknowns).fill;
            assert_eq!([estimated, factor.fill()], [stored, stored]);
        }
    }
}

#[test]
fn factors_solve_one_and_many_right_hand_sides() {
    let model = block([6, 4, 3], Order::Quadratic);
    for ordering in [Ordering::MinimumDegree, Ordering::NestedDissection] {
        let unknowns = Unknowns::ordered(&model, ordering);
        let matrix = stiffness_of(&model, &unknowns);
        let factor = unknowns.factor(&matrix).unwrap();
        let size = unknowns.count;
        let expected: Vec<f64> = (0..3 * size).map(|i| (0.37 * i as f64).sin()).collect();
        let mut right = vec![0.0; 3 * size];
        for (x, y) in expected.chunks_exact(size).zip(right.chunks_exact_mut(size)) {
            matrix.multiply(x, y);
        }
        let mut single = right[..size].to_vec();
        factor.solve_columns(&mut right, 3);
        factor.solve(&mut single);
        for (found, expected) in right.iter().chain(&single).zip(expected.iter().chain(&expected)) {
            // Rounding times the condition number of a short block.
            assert!((found - expected).abs() <= 1e-9, "{ordering:?} {found} {expected}");
        }
    }
}

/// The order changes nothing but the last digits.
#[test]
fn equilibria_agree_in_every_order() {
    let model = block([6, 3, 3], Order::Quadratic);
    let options = EquilibriumOptions { tolerance: 1e-12, ..Default::default() };
    let [one, other] = [Ordering::MinimumDegree, Ordering::NestedDissection].map(|ordering| {
        let unknowns = Unknowns::ordered(&model, ordering);
        equilibrium_over(&model, unknowns, 0.0, &options).unwrap().displacement
    });
    let size = one.as_flattened().iter().fold(0.0f64, |most, u| most.max(u.abs()));
    for (one, other) in one.as_flattened().iter().zip(other.as_flattened()) {
        assert!((one - other).abs() <= 1e-9 * size, "{one} {other} {size}");
    }
}

/// A block of 17 nodes along each edge: dissection has less fill and work than minimum degree.
#[test]
fn dissection_beats_minimum_degree() {
    let model = block([8, 8, 8], Order::Quadratic);
    let [degree, dissection, cheapest] =
        [Ordering::MinimumDegree, Ordering::NestedDissection, Ordering::Cheapest]
            .map(|ordering| Unknowns::ordered(&model, ordering).elimination);
    println!(
        "fill {:.2}, operations {:.2} of minimum degree's",
        dissection.fill as f64 / degree.fill as f64,
        dissection.operations / degree.operations
    );
    assert!(dissection.fill < degree.fill);
    assert!(dissection.operations < 0.8 * degree.operations);
    assert_eq!(cheapest.operations, dissection.operations);
}

#[test]
fn what_does_not_fit_into_memory_is_refused() {
    let model = block([4, 3, 2], Order::Quadratic);
    let unknowns = Unknowns::new(&model);
    let statics = memory::statics(&unknowns);
    assert!(memory::modes(&unknowns, 6).bytes() > statics.bytes());
    let held = 1e6;
    let enough = held + statics.bytes();
    assert_eq!(statics.refuse_beyond(held, enough, "test", ""), Ok(()));
    let error = statics.refuse_beyond(held, 0.99 * enough, "test", "").unwrap_err();
    assert_eq!((error.bytes, error.limit), (enough, 0.99 * enough));
    // What is not a number is not enough either.
    assert!(statics.refuse_beyond(held, f64::NAN, "test", "").is_err());
}

/// Nodes of a bar of small cubes, each a neighbour of all that share a cube.
fn lattice(along: usize, across: usize) -> (Graph, Vec<Vec3>) {
    let id = |i: usize, j: usize, k: usize| ((i * across + j) * across + k) as u32;
    let mut cubes = Vec::new();
    let mut places = Vec::new();
    for i in 0..along {
        for j in 0..across {
            for k in 0..across {
                places.push([i as f64, j as f64, k as f64]);
                if i + 1 < along && j + 1 < across && k + 1 < across {
                    let corner = |c: usize| id(i + c % 2, j + c / 2 % 2, k + c / 4);
                    cubes.push((0..8).map(corner).collect::<Vec<u32>>());
                }
            }
        }
    }
    (Graph::of_elements(places.len(), cubes.iter().map(Vec::as_slice), |_| true), places)
}

/// A bar whose band is five layers thick, of which one has a hole, the first, an inner or the last one:
/// the smallest cut is found, and it parts the sides.
#[test]
fn cuts_are_smallest_and_part_the_sides() {
    for hole in [4, 7, 8] {
        cut_at(hole);
    }
}

fn cut_at(hole: usize) {
    let (along, across) = (13, 4);
    let (whole, places) = lattice(along, across);
    let layer = |node: u32| places[node as usize][0] as usize;
    // Half of a layer is gone.
    let kept: Vec<u32> = (0..places.len() as u32)
        .filter(|node| layer(*node) != hole || places[*node as usize][1] < 2.0)
        .collect();
    let graph = whole.permuted(&kept);
    let layer = |node: u32| layer(kept[node as usize]);
    let nodes = 0..kept.len() as u32;
    let side: Vec<Side> = nodes
        .clone()
        .map(|node| match layer(node) {
            0..4 => Side::Low,
            4..9 => Side::Band,
            _ => Side::High,
        })
        .collect();
    let band: Vec<u32> = nodes.clone().filter(|n| side[*n as usize] == Side::Band).collect();
    let mut index = vec![0; kept.len()];
    for (at, node) in (0u32..).zip(&band) {
        index[*node as usize] = at;
    }
    for cut in smallest_cuts(&graph, &side, &index, &band) {
        assert_eq!(cut.separator.len(), 8);
        assert_eq!(cut.separator.len() + cut.low.len() + cut.high.len(), band.len());
        let mut of = side.clone();
        cut.low.iter().for_each(|node| of[*node as usize] = Side::Low);
        cut.high.iter().for_each(|node| of[*node as usize] = Side::High);
        for node in nodes.clone().filter(|node| of[*node as usize] == Side::Low) {
            assert!(graph.of(node).iter().all(|other| of[*other as usize] != Side::High));
        }
    }
}

#[test]
fn dissection_orders_every_node_once() {
    let (graph, places) = lattice(30, 6);
    let mut order = nested_dissection(&graph, &places);
    order.sort_unstable();
    assert!(order.iter().copied().eq(0..places.len() as u32));
    // All in one place: nothing tells the nodes apart, and an order is found all the same.
    let mut order = nested_dissection(&graph, &vec![[1.0; 3]; places.len()]);
    order.sort_unstable();
    assert!(order.iter().copied().eq(0..places.len() as u32));
}

/// A stored value of a sparse matrix has eight bytes, and four for its row.
#[test]
fn memory_of_sparse_matrices_counts_their_rows() {
    let model = block([4, 3, 2], Order::Quadratic);
    let unknowns = Unknowns::new(&model);
    let needed = memory::statics(&unknowns);
    let without = Task { matrix: 0, ..needed.task };
    let left = Memory::new(&unknowns.elimination, without).other_bytes;
    assert_eq!(needed.task.matrix, stiffness_of(&model, &unknowns).stored());
    assert_eq!(needed.other_bytes - left, 12.0 * needed.task.matrix as f64);
}

/// A matrix that is not positive is refused at the unknown where it shows, wherever that is eliminated.
#[test]
fn a_pivot_that_is_not_positive_is_named() {
    let model = block([3, 2, 2], Order::Linear);
    let unknowns = Unknowns::new(&model);
    for bad in [0, unknowns.count / 2, unknowns.count - 1] {
        let mut matrix = stiffness_of(&model, &unknowns);
        let diagonal = matrix.column(bad).find(|(row, _)| *row == bad).unwrap().1;
        matrix.add(Entry { row: bad, column: bad }, -2.0 * diagonal);
        // Unknowns are numbered as they are eliminated, and what comes before is as positive as it was.
        let refused = unknowns.factor(&matrix).err();
        assert_eq!(refused, Some(FactorError::NotPositiveDefinite { pivot: bad }));
    }
}
