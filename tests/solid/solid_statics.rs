//! Laws of equilibrium and of natural modes of a solid.

use crate::solid_common;

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::kinematics::strain::{Sym3, full};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::tet_mesh::{Elements, Order};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::error::SolidError;
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{Load, Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::modes::{ModeOptions, modes};
use bearing_dynamics::solids::stress::nodal_stresses;
use bearing_dynamics::solids::tangent::MassMatrix;
use nalgebra::{Matrix3, Rotation3, Vector3};
use solid_common::{DENSITY, YOUNG, cut_cubes, solid};

/// A bar of cubes with side `size / cells`, its inner nodes shaken when asked.
fn bar(size: Vec3, cells: [usize; 3], order: Order, shaken: bool) -> SolidProblem {
    solid(cut_cubes(size, cells, 0.2, |inner| shaken && inner), order)
}

fn hold(problem: &mut SolidProblem, value: impl Fn(Vec3) -> [Option<f64>; 3]) {
    for (node, place) in problem.nodes.iter().enumerate() {
        for (axis, value) in value(*place).into_iter().enumerate() {
            if let Some(value) = value {
                let profile = Profile::Constant(value);
                problem.prescribed.push(Prescribed { node: node as u32, axis, profile });
            }
        }
    }
}

#[test]
fn patch_test() {
    let size = [0.02, 0.02, 0.02];
    let gradient = [[1e-3, 2e-4, -3e-4], [4e-4, -5e-4, 1e-4], [0.0, 3e-4, 2e-4]];
    let field =
        |x: Vec3| [0, 1, 2].map(|i: usize| (0..3).map(|j| gradient[i][j] * x[j]).sum::<f64>());
    for order in [Order::Linear, Order::Quadratic] {
        let mut problem = bar(size, [3, 3, 3], order, true);
        hold(&mut problem, |x| {
            let outside = (0..3).any(|i| x[i] < 1e-9 || x[i] > size[i] - 1e-9);
            if outside { field(x).map(Some) } else { [None; 3] }
        });
        let model = SolidModel::new(problem).unwrap();
        let options = EquilibriumOptions { tolerance: 1e-13, ..Default::default() };
        let found = equilibrium(&model, 0.0, &options).unwrap();
        for (u, x) in found.displacement.iter().zip(&model.problem.nodes) {
            let exact = field(*x);
            for i in 0..3 {
                assert!((u[i] - exact[i]).abs() <= 1e-12 * 2e-5, "{order:?} {u:?} {exact:?}");
            }
        }
    }
}

/// Supports that leave Poisson contraction free: x on the end, y and z on planes of symmetry.
#[test]
fn a_pulled_bar() {
    let size = [0.1, 0.02, 0.01];
    for order in [Order::Linear, Order::Quadratic] {
        let mut problem = bar(size, [6, 2, 1], order, true);
        hold(&mut problem, |x| {
            [0, 1, 2].map(|i: usize| if x[i] < 1e-9 { Some(0.0) } else { None })
        });
        let end: Vec<u32> = (0..problem.nodes.len() as u32)
            .filter(|n| problem.nodes[*n as usize][0] > size[0] - 1e-9)
            .collect();
        let stretch = 1e-5;
        for node in end {
            let profile = Profile::Constant(stretch);
            problem.prescribed.push(Prescribed { node, axis: 0, profile });
        }
        let model = SolidModel::new(problem).unwrap();
        let found = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap();
        let pull: f64 = found
            .reactions
            .iter()
            .zip(&model.problem.nodes)
            .filter(|(_, x)| x[0] > size[0] - 1e-9)
            .map(|(force, _)| force[0])
            .sum();
        // St. Venant–Kirchhoff: S = E e + …, P = (1 + H) S, e = H + H²/2, uniaxial stress.
        let h = stretch / size[0];
        let exact = YOUNG * (h + 0.5 * h * h) * (1.0 + h) * size[1] * size[2];
        assert!((pull / exact - 1.0).abs() <= 1e-9, "{order:?} {pull} {exact}");
    }
}

/// A bar that hangs by its end: u = ρg/E (L x − x²/2) (ν = 0), which ten-node elements hold.
#[test]
fn a_bar_under_its_own_weight() {
    let size = [0.1, 0.02, 0.02];
    let gravity = 10.0;
    for (order, tolerance) in [(Order::Linear, 0.25), (Order::Quadratic, 1e-6)] {
        let mut problem = bar(size, [5, 2, 2], order, true);
        problem.material = LinearElastic::new(YOUNG, 0.0).unwrap();
        problem.gravity = [gravity, 0.0, 0.0];
        hold(&mut problem, |x| if x[0] < 1e-9 { [Some(0.0); 3] } else { [None; 3] });
        let model = SolidModel::new(problem).unwrap();
        let found = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap();
        let per_length = DENSITY * gravity / YOUNG;
        let scale = 0.5 * per_length * size[0] * size[0];
        for (u, x) in found.displacement.iter().zip(&model.problem.nodes) {
            let exact = [per_length * (size[0] * x[0] - 0.5 * x[0] * x[0]), 0.0, 0.0];
            for i in 0..3 {
                // Cut cells load their corners unevenly, which five linear ones along leave in the
                // answer; of quadratic ones squares of a strain of 4e-8 are left.
                let error = (u[i] - exact[i]).abs() / scale;
                assert!(error <= tolerance, "{order:?} {x:?}: {error}");
            }
        }
        let weight: f64 = 7800.0 * size.iter().product::<f64>() * gravity;
        let held: f64 = found.reactions.iter().map(|force| force[0]).sum();
        assert!((held / weight + 1.0).abs() <= 1e-9, "{order:?} {held} {weight}");
    }
}

/// Large rotation: a strip bent by a force keeps equilibrium of force and moment.
#[test]
fn large_deflection_converges_in_load_steps() {
    let size = [0.2, 0.004, 0.004];
    let mut problem = bar(size, [20, 1, 1], Order::Quadratic, false);
    hold(&mut problem, |x| if x[0] < 1e-9 { [Some(0.0); 3] } else { [None; 3] });
    let end: Vec<u32> = (0..problem.nodes.len() as u32)
        .filter(|n| problem.nodes[*n as usize][0] > size[0] - 1e-9)
        .collect();
    let forces = end.iter().map(|n| (*n, [0.0, 0.0, 100.0 / end.len() as f64])).collect();
    problem.loads.push(Load { forces, profile: Profile::Constant(1.0) });
    let model = SolidModel::new(problem).unwrap();
    let found = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap();
    let tip = found.displacement[end[0] as usize];
    let inertia = size[1].powi(4) / 12.0;
    let linear = 100.0 * size[0].powi(3) / (3.0 * YOUNG * inertia);
    // The elastica's tip sinks less than the straight beam's and moves inwards: P L²/(E I) = 0.89
    // gives 0.28 L down and 0.048 L in (Bisshopp and Drucker's curves, to two digits).
    println!("{linear} {tip:?} {} {}", found.iterations, found.factorisations);
    assert!((tip[2] / size[0] - 0.274).abs() <= 0.01, "{tip:?} {linear}");
    assert!((tip[0] / size[0] + 0.046).abs() <= 0.005, "{tip:?}");
    let sum: f64 = found.reactions.iter().map(|r| r[2]).sum();
    assert!((sum + 100.0).abs() <= 1e-6);
}

#[test]
fn a_free_body_has_no_equilibrium() {
    let mut problem = bar([0.1, 0.02, 0.01], [3, 1, 1], Order::Linear, false);
    let end = problem.nodes.len() as u32 - 1;
    let forces = vec![(end, [1.0, 0.0, 0.0])];
    problem.loads.push(Load { forces, profile: Profile::Constant(1.0) });
    let model = SolidModel::new(problem).unwrap();
    let found = equilibrium(&model, 0.0, &EquilibriumOptions::default());
    assert!(
        matches!(found, Err(SolidError::Free { .. }) | Err(SolidError::Unbalanced { .. })),
        "{found:?}"
    );
}

/// A load beyond what the body bears is no lack of supports: what the first factors gave says how far off it is.
#[test]
fn a_load_that_is_far_too_large_is_called_so() {
    let bent = |force: f64| {
        let mut problem = bar([0.1, 0.01, 0.01], [10, 1, 1], Order::Linear, false);
        problem.material = LinearElastic::new(2e6, 0.49).unwrap();
        hold(&mut problem, |x| if x[0] < 1e-9 { [Some(0.0); 3] } else { [None; 3] });
        let end = (0..problem.nodes.len()).filter(|n| problem.nodes[*n][0] > 0.1 - 1e-9);
        let forces = end.map(|n| (n as u32, [0.0, 0.0, 0.25 * force])).collect();
        problem.loads.push(Load { forces, profile: Profile::Constant(1.0) });
        let model = SolidModel::new(problem).unwrap();
        equilibrium(&model, 0.0, &EquilibriumOptions::default())
    };
    let small = bent(-1e-6).unwrap().displacement;
    let small = small.iter().map(|u| u[0].hypot(u[1]).hypot(u[2])).fold(0.0, f64::max);
    let error = bent(-100.0).unwrap_err();
    let said = error.to_string();
    let SolidError::TooLarge { reached, moved, pivot, linear, size, .. } = error else {
        panic!("{said}");
    };
    assert!((linear.value / (1e8 * small) - 1.0).abs() <= 1e-3, "{linear:?} {small:e}");
    assert!((size - 0.1f64.hypot(0.01).hypot(0.01)).abs() <= 1e-12);
    assert!((0.0..1.0).contains(&reached) && moved.value < linear.value, "{reached} {moved:?}");
    assert!(pivot.node.is_some() && pivot.at[0] > 0.0, "{pivot}");
    assert!(said.contains("no part is free to move: the load is too large"), "{said}");
    assert!(said.contains(&format!("({pivot})")) && !said.contains("(pivot "), "{said}");
    let millimetres = bearing_dynamics::numeric::clock::to_digits(1e3 * linear.value, 4);
    assert!(said.contains(&format!("has a displacement of {millimetres} mm")), "{said}");
}

/// A second part that nothing holds is named by a node of its own.
#[test]
fn a_part_that_is_free_is_named_by_its_place() {
    let mut problem = bar([0.1, 0.02, 0.01], [3, 1, 1], Order::Linear, false);
    hold(&mut problem, |x| if x[0] < 1e-9 { [Some(0.0); 3] } else { [None; 3] });
    let count = problem.nodes.len() as u32;
    let Elements::Linear(elements) = &mut problem.elements else { unreachable!() };
    elements.push([0, 1, 2, 3].map(|n| count + n));
    let apart = [[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]];
    problem.nodes.extend(apart.map(|[x, y, z]| [x + 1.0, y, z]));
    problem
        .loads
        .push(Load { forces: vec![(count, [1.0, 0.0, 0.0])], profile: Profile::Constant(1.0) });
    let model = SolidModel::new(problem).unwrap();
    let error = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap_err();
    let SolidError::Free { pivot } = &error else { panic!("{error}") };
    assert!(pivot.at[0] >= 1.0 && pivot.node > Some(u64::from(count)), "{pivot}");
    let said = error.to_string();
    assert!(said.contains(&format!("({pivot}): a part is free to move")), "{said}");
}

#[test]
fn a_free_body_has_six_modes_of_no_frequency() {
    for order in [Order::Linear, Order::Quadratic] {
        for mass in [MassMatrix::Consistent, MassMatrix::Lumped] {
            let model = SolidModel::new(bar([0.1, 0.02, 0.01], [8, 2, 1], order, false)).unwrap();
            let options = ModeOptions { mass, ..ModeOptions::new(10) };
            let found = modes(&model, &options).unwrap();
            let frequency: Vec<f64> = found.modes.iter().map(|m| m.frequency).collect();
            println!("{order:?} {mass:?} {frequency:?} {}", found.solves);
            // Rounding of K x: 1e-16 of the highest ω² (about 1e13) is 30 rad²/s².
            assert!(frequency[5] <= 5.0, "{frequency:?}");
            assert!(frequency[6] >= 1000.0, "{frequency:?}");
            // Shapes are orthonormal under the mass.
            if mass == MassMatrix::Lumped {
                for a in 0..10 {
                    for b in 0..10 {
                        let product: f64 = (0..model.mass.len())
                            .map(|n| {
                                let (x, y) = (found.modes[a].shape[n], found.modes[b].shape[n]);
                                model.mass[n] * (x[0] * y[0] + x[1] * y[1] + x[2] * y[2])
                            })
                            .sum();
                        let exact = if a == b { 1.0 } else { 0.0 };
                        assert!((product - exact).abs() <= 1e-8, "{a} {b} {product}");
                    }
                }
            }
        }
    }
}

/// A rod on rollers with both ends held along its axis: f = n/(2L)·√(E/ρ) where Poisson contraction
/// is held too (ν = 0 here, so that it is one-dimensional).
#[test]
fn frequencies_of_a_rod() {
    let size = [0.1, 0.005, 0.005];
    let mut problem = bar(size, [20, 1, 1], Order::Quadratic, false);
    problem.material = LinearElastic::new(YOUNG, 0.0).unwrap();
    hold(&mut problem, |x| {
        let end = x[0] < 1e-9 || x[0] > size[0] - 1e-9;
        [end.then_some(0.0), Some(0.0), Some(0.0)]
    });
    let model = SolidModel::new(problem).unwrap();
    let found = modes(&model, &ModeOptions::new(3)).unwrap();
    for (n, mode) in found.modes.iter().enumerate() {
        let exact = (n + 1) as f64 * 0.5 / size[0] * (YOUNG / DENSITY).sqrt();
        // Quadratic elements, 20 along: (π n/20)⁴/1440.
        let bound = (0.157 * (n + 1) as f64).powi(4) / 300.0 + 1e-9;
        assert!((mode.frequency / exact - 1.0).abs() <= bound, "{} {exact}", mode.frequency);
    }
}

/// Near ν = 1/2 rounding keeps the residual above the tolerance, by how little is said.
#[test]
fn a_nearly_incompressible_bar_is_solved_to_rounding() {
    let size = [0.1, 0.01, 0.01];
    let solve = |poisson_ratio: f64, rounding: f64| {
        let mut problem = bar(size, [20, 2, 2], Order::Quadratic, false);
        problem.material = LinearElastic::new(70e9, poisson_ratio).unwrap();
        hold(&mut problem, |x| [(x[0] < 1e-9).then_some(0.0); 3]);
        let end = |x: &Vec3| x[0] > size[0] - 1e-9;
        let nodes = (0..).zip(&problem.nodes).filter(|(_, x)| end(x)).map(|(node, _)| node);
        let nodes: Vec<u32> = nodes.collect();
        let share = 1.0 / nodes.len() as f64;
        let forces = nodes.iter().map(|&node| (node, [0.0, 0.0, share])).collect();
        problem.loads.push(Load { forces, profile: Profile::Constant(-3000.0) });
        let model = SolidModel::new(problem).unwrap();
        // Load steps do not help against rounding.
        let smallest_load_step = 1.0;
        let options = EquilibriumOptions { rounding, smallest_load_step, ..Default::default() };
        let found = equilibrium(&model, 0.0, &options)?;
        let reaction: f64 = found.reactions.iter().map(|force| force[2]).sum();
        let sag = nodes.iter().map(|&n| found.displacement[n as usize][2]).sum::<f64>() * share;
        Ok::<_, SolidError>((found.residual, reaction, sag))
    };
    let usual = EquilibriumOptions::default();
    // Without the allowance there is no end to it.
    let error = solve(0.49999, usual.tolerance).unwrap_err();
    assert!(matches!(error, SolidError::Unbalanced { .. }), "{error}");
    let (residual, reaction, sag) = solve(0.49999, usual.rounding).unwrap();
    assert!(residual > usual.tolerance && residual <= usual.rounding, "{residual}");
    // The unbalanced forces are rounding, and of either sign.
    assert!((reaction / 3000.0 - 1.0).abs() <= 1e-6, "{reaction}");
    // It bends as at ν = 0.49, but for some locking.
    let (usual_residual, _, other) = solve(0.49, usual.rounding).unwrap();
    assert!(usual_residual <= usual.tolerance, "{usual_residual}");
    assert!((sag / other - 1.0).abs() <= 0.05, "{sag} {other}");
}

/// A solid turned with its supports, loads and weight: displacements, reactions and stresses turn,
/// frequencies stay, and so does a run of explicit steps.
#[test]
fn a_whole_solid_turns() {
    let size = [0.06, 0.01, 0.015];
    for order in [Order::Linear, Order::Quadratic] {
        let turned = |turn: &Rotation3<f64>| {
            let mut problem = bar(size, [4, 1, 2], order, true);
            hold(&mut problem, |x| if x[0] < 1e-9 { [Some(0.0); 3] } else { [None; 3] });
            let rotate = |v: Vec3| -> Vec3 { (turn * Vector3::from(v)).into() };
            let end = (0..problem.nodes.len() as u32)
                .filter(|n| problem.nodes[*n as usize][0] > size[0] - 1e-9);
            let forces = end.map(|n| (n, rotate([300.0, -700.0, 500.0 + f64::from(n)]))).collect();
            problem.loads.push(Load { forces, profile: Profile::Constant(1.0) });
            problem.gravity = rotate([1e5, -2e5, 3e5]);
            problem.nodes.iter_mut().for_each(|place| *place = rotate(*place));
            SolidModel::new(problem).unwrap()
        };
        let solved = |model: &SolidModel| {
            let options = EquilibriumOptions { tolerance: 1e-12, ..Default::default() };
            let found = equilibrium(model, 0.0, &options).unwrap();
            let stress = nodal_stresses(model, &found.displacement);
            let found_modes = modes(model, &ModeOptions::new(4)).unwrap();
            let still = vec![[0.0; 3]; model.mass.len()];
            let mut run = ExplicitSolid::new(
                model.clone(),
                ExplicitMethod::CentralDifferences,
                // A third of the limit or less; a part of it would be known to 1e-5 only.
                SolidStepping::Fixed(3e-8),
                still.clone(),
                still,
            )
            .unwrap();
            (0..50).for_each(|_| run.step(|_, _, _| {}).unwrap());
            let moved: Vec<Vec3> = run.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
            let frequencies: Vec<f64> = found_modes.modes.iter().map(|m| m.frequency).collect();
            (found.displacement, found.reactions, moved, stress, frequencies)
        };
        let first = solved(&turned(&Rotation3::identity()));
        let largest = |list: &[Vec3]| -> f64 {
            list.iter().map(|v| Vector3::from(*v).norm()).fold(0.0, f64::max)
        };
        for angles in [[0.7, -1.1, 2.0], [3.0, 0.2, -0.4]] {
            let turn = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
            let there = solved(&turned(&turn));
            let vectors = [
                ("displacement", &first.0, &there.0),
                ("reaction", &first.1, &there.1),
                ("explicit step", &first.2, &there.2),
            ];
            for (what, a, b) in vectors {
                let scale = largest(a);
                for (a, b) in a.iter().zip(b) {
                    let off = (turn * Vector3::from(*a) - Vector3::from(*b)).norm();
                    // Rounding of strains of 1e-4 in places of 1e-1 m, by a stiffness whose condition
                    // is some 1e5; both are sought to 1e-12.
                    assert!(
                        scale > 0.0 && off <= 1e-9 * scale,
                        "{order:?} {what}: {off} of {scale}"
                    );
                }
            }
            let matrix = |t: &Sym3| Matrix3::from(full(t)).transpose();
            let scale = first.3.iter().map(|t| matrix(t).norm()).fold(0.0, f64::max);
            for (a, b) in first.3.iter().zip(&there.3) {
                let off = (turn * matrix(a) * turn.transpose() - matrix(b)).norm();
                assert!(off <= 1e-9 * scale, "{order:?} stress: {off} of {scale}");
            }
            for (a, b) in first.4.iter().zip(&there.4) {
                assert!((a / b - 1.0).abs() <= 1e-8, "{order:?}: {a} {b}");
            }
        }
    }
}
