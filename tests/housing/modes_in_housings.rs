//! Natural motions of a bearing in a housing against those of all nodes of its mesh with the races.

use super::housing_assembly::{fit, loads, search};
use crate::housed::{HousedState, OUTER, moving};
use crate::housing_common::*;

use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::equilibrium::quasi_static_limit::{MovingBody, housing_mass, modes};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::tet_mesh::Elements;
use bearing_dynamics::reduction::fixed_interface_modes::{
    Natural, natural_modes_of, vibrating_housing,
};
use bearing_dynamics::solids::condensation::{CondensedBore, condense};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::tangent::{PRESCRIBED, pattern, stiffness};
use nalgebra::{DMatrix, DVector, SymmetricEigen, Vector3};
use std::f64::consts::TAU;

/// Squares of frequencies (1/s²) of both races and of all nodes, contact springs of the nodes that touch between them; and for
/// each the part of its modal mass that the housing has.
fn all_nodes(
    model: &SolidModel,
    bore: &CondensedBore,
    state: &HousedState,
    bodies: &[MovingBody],
) -> Vec<(f64, f64)> {
    let unknowns = bore.unknowns();
    let (races, count) = (10, 10 + unknowns.count);
    let mut whole = DMatrix::<f64>::zeros(count, count);
    whole.view_mut((0, 0), (races, races)).copy_from(&state.stiffness);
    let outer = 5 * OUTER + 1;
    // What the bore does with all its nodes eliminated.
    let mut eliminated = whole.fixed_view_mut::<4, 4>(outer, outer);
    eliminated -= state.bore.stiffness;
    let mut own = pattern(&model.problem, unknowns);
    stiffness(model, unknowns, &vec![[0.0; 3]; model.mass.len()], &mut own);
    let (mut unit, mut column) = (vec![0.0; unknowns.count], vec![0.0; unknowns.count]);
    for j in 0..unknowns.count {
        unit[j] = 1.0;
        own.multiply(&unit, &mut column);
        unit[j] = 0.0;
        column.iter().enumerate().for_each(|(i, value)| whole[(races + i, races + j)] += value);
    }
    for (node, load) in bore.nodes.iter().zip(&state.bore.loads) {
        if *load <= 0.0 {
            continue;
        }
        // How fast the gap closes: with the race outwards, n at its place a from the race's centre, and with the node inwards.
        let [ny, nz] = node.normal;
        let ax = node.arm[0];
        let mut closes = DVector::<f64>::zeros(count);
        // A turn by θ moves the place by θ × a.
        [ny, nz, -ax * nz, ax * ny]
            .into_iter()
            .enumerate()
            .for_each(|(i, lever)| closes[outer + i] = lever);
        for (axis, n) in [(1, ny), (2, nz)] {
            let at = unknowns.of[node.node as usize][axis];
            assert_ne!(at, PRESCRIBED);
            closes[races + at] = -n;
        }
        whole.ger(Penalty::default().of_node(node.area), &closes, &closes, 1.0);
    }
    let mut mass = DMatrix::<f64>::zeros(count, count);
    for (of, body) in bodies.iter().enumerate() {
        let of_body = &body.inertia;
        let (m, turning) = (of_body.mass, of_body.transverse);
        for (i, own) in [m, m, m, turning, turning].into_iter().enumerate() {
            mass[(5 * of + i, 5 * of + i)] = own;
        }
    }
    // Consistent: a tenth of an element's mass at each of its nodes, a twentieth between two.
    let Elements::Linear(list) = &model.problem.elements else { panic!("four nodes") };
    for nodes in list {
        let [a, b, c, d] = nodes.map(|node| Vector3::from(model.problem.nodes[node as usize]));
        let share = model.problem.density * (b - a).cross(&(c - a)).dot(&(d - a)).abs() / 120.0;
        for (one, other) in nodes.iter().flat_map(|one| nodes.map(|other| (*one, other))) {
            let [rows, columns] = [one, other].map(|node| unknowns.of[node as usize]);
            for (row, column) in rows.into_iter().zip(columns) {
                if row != PRESCRIBED && column != PRESCRIBED {
                    mass[(races + row, races + column)] +=
                        if one == other { 2.0 * share } else { share };
                }
            }
        }
    }
    let held = |i: &usize| *i >= races || bodies[*i / 5].free[*i % 5];
    let kept: Vec<usize> = (0..count).filter(held).collect();
    let picked = |of: &DMatrix<f64>| of.select_rows(&kept).select_columns(&kept);
    let lower = picked(&mass).cholesky().unwrap().l();
    let half = lower.solve_lower_triangular(&picked(&whole)).unwrap();
    let both = lower.solve_lower_triangular(&half.transpose()).unwrap();
    let eigen = SymmetricEigen::new((&both + both.transpose()) * 0.5);
    let first = kept.iter().position(|i| *i >= races).unwrap();
    let mut found: Vec<(f64, f64)> = (0..kept.len())
        .map(|k| {
            // No mass couples races and housing, so that the factor has two blocks.
            let shape = eigen.eigenvectors.column(k);
            (eigen.eigenvalues[k], shape.rows_range(first..).norm_squared())
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Motions are listed too fast, by less as more natural shapes take part: by two thousandths at most up to half the frequency of the first
/// one that is left out, by a hundredth up to eight tenths of it. Following the race alone, the housing is 2 % off and has no motion of
/// its own.
#[test]
fn a_bearing_swings_with_all_of_its_housing() {
    // As soft as plastic, so that it swings with the races.
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let model = model_of(&mesh, 0.01 * YOUNG);
    let bore = condense(&model, &bore_of(&mesh), &reach()).unwrap();
    let mut search = search(&bore);
    let problem = bearing(loads([0.0, 2.5, -2.5, 0.0, 0.0]));
    // Some nodes touch, or all; and how far off one of the motions is by the shapes that follow the race alone.
    for (interference, touching, number, followed) in
        [(-1e-6, 1..72, 6, 1.5e-3), (5e-6, 72..73, 4, 1e-2)]
    {
        let state = search.solve(&problem, &fit(interference), [0.0; 3]).unwrap();
        assert!(touching.contains(&state.bore.touching), "{}", state.bore.touching);
        let inner = hollow_cylinder(15e-3, 20e-3, 20e-3, 7850.0);
        let outer = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
        let bodies = moving([inner, outer], [true; 5]);
        let all = all_nodes(&model, &bore, &state, &bodies);
        let expected = &all;
        let off = |(square, _): (f64, f64), found: f64| (found / square).sqrt() - 1.0;
        let follows = housing_mass(search.bore(), &model, OUTER);
        let alone = modes(&state.stiffness, &bodies, &[follows]);
        let by_following = off(expected[number], alone[number].square);
        assert!(by_following >= followed, "{by_following:e}");
        let mut last = f64::INFINITY;
        for count in [6, 12, 24, 48] {
            let (natural, first_left_out) =
                natural_modes_of(&model, &bore, Natural::Lowest(count)).unwrap();
            let swinging = vibrating_housing(search.bore(), &model, OUTER, &natural, 0.0);
            assert_eq!(swinging.held.len(), count);
            let limit = (TAU * first_left_out).powi(2);
            let found = modes(&state.stiffness, &bodies, &[swinging]);
            let mut listed = 0;
            for (mode, expected) in found.iter().zip(expected) {
                let error = off(*expected, mode.square);
                let allowed = match expected.0 / limit {
                    part if part <= 0.25 => 2e-3,
                    part if part <= 0.64 => 1e-2,
                    _ => break,
                };
                // Contact is ten thousand times as stiff as the housing.
                assert!((-1e-9..=allowed).contains(&error), "{count}: {error:e} {expected:?}");
                let share = (mode.housings[0] - expected.1).abs();
                // An error mixes neighbours by its part of their distance.
                let apart = |near: usize| (all[near].0 / all[listed].0 - 1.0).abs() / 2.0;
                let apart =
                    if listed == 0 { apart(1) } else { apart(listed - 1).min(apart(listed + 1)) };
                let mixed = 1e-2 + 2.0 * error / apart;
                assert!(error > 2e-3 || share <= mixed, "{count}: {share} {expected:?}");
                listed += 1;
            }
            assert!(listed >= 5, "{count}: {listed}");
            let error = off(expected[number], found[number].square);
            assert!(error <= last, "{count}: {error:e} {last:e}");
            last = error;
        }
        assert!(last <= 0.1 * by_following, "{last:e} {by_following:e}");
    }
}

/// Up to a frequency there are those that a reduced housing has.
#[test]
fn natural_shapes_go_up_to_the_frequency_that_is_asked_for() {
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let model = model_of(&mesh, 0.01 * YOUNG);
    let bore = condense(&model, &bore_of(&mesh), &reach()).unwrap();
    let of = |natural| natural_modes_of(&model, &bore, natural).unwrap();
    let (lowest, first_left_out) = of(Natural::Lowest(12));
    let (up_to, beyond) = of(Natural::UpTo(first_left_out * (1.0 - 1e-6)));
    assert_eq!((lowest.len(), up_to.len()), (12, 12));
    assert!((beyond / first_left_out - 1.0).abs() <= 1e-9);
}
