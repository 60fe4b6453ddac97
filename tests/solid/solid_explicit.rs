//! Laws of explicit steps of a solid.

use crate::solid_common;

use bearing_dynamics::kinematics::vec3::{Vec3, cross};
use bearing_dynamics::mesh::tet_mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::energy::strain_energy;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::error::SolidError;
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{DampedMotion, Load, Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::step_limit::{step_limit, step_limit_within};
use bearing_dynamics::solids::tangent::MassMatrix;
use bearing_dynamics::solids::threads::WorkerPool;
use proptest::prelude::*;
use solid_common::{DENSITY, cut_cubes, solid};

/// A block of a × b × c cubes of side 10 mm, all its nodes shaken.
fn block(cells: [usize; 3], order: Order) -> SolidProblem {
    solid(cut_cubes(cells.map(|n| 0.01 * n as f64), cells, 0.1, |_| true), order)
}

fn still(problem: &SolidProblem) -> Vec<Vec3> {
    vec![[0.0; 3]; problem.nodes.len()]
}

/// A smooth deformation of some size.
fn bent(problem: &SolidProblem, size: f64) -> Vec<Vec3> {
    problem
        .nodes
        .iter()
        .map(|x| {
            [
                size * ((40.0 * x[0]).sin() * 0.01 + 0.3 * x[1]),
                size * (0.2 * x[2] - 0.4 * x[0] + 20.0 * x[0] * x[1]),
                size * (0.3 * x[2] + 10.0 * x[1] * x[2]),
            ]
        })
        .collect()
}

fn pad(list: &[Vec3]) -> Vec<[f64; 4]> {
    list.iter().map(|v| [v[0], v[1], v[2], 0.0]).collect()
}

#[test]
fn blocks_and_the_plain_loop_give_the_same_bits() {
    for order in [Order::Linear, Order::Quadratic] {
        // 3 · 2 · 2 · 6 = 72 elements and 30: the latter does not fill its last block.
        for cells in [[3, 2, 2], [5, 1, 1]] {
            let model = SolidModel::new(block(cells, order)).unwrap();
            let moved = pad(&bent(&model.problem, 0.05));
            let mut lanes = vec![[0.0; 4]; moved.len()];
            let mut plain = lanes.clone();
            model.add_internal_forces(&moved, &mut lanes);
            model.add_internal_forces_plain(&moved, &mut plain);
            for (a, b) in lanes.iter().zip(&plain) {
                for i in 0..3 {
                    assert!(a[i].to_bits() == b[i].to_bits(), "{order:?} {cells:?} {a:?} {b:?}");
                }
            }
        }
    }
}

#[test]
fn forces_are_minus_the_slope_of_the_energy() {
    for order in [Order::Linear, Order::Quadratic] {
        let model = SolidModel::new(block([2, 1, 1], order)).unwrap();
        let moved = pad(&bent(&model.problem, 0.1));
        let mut forces = vec![[0.0; 4]; moved.len()];
        model.add_internal_forces(&moved, &mut forces);
        let scale = forces.iter().flatten().fold(0.0f64, |a, b| a.max(b.abs()));
        let step = 1e-6 * 0.01;
        for node in 0..moved.len() {
            for i in 0..3 {
                let at = |by: f64| {
                    let mut shifted = moved.clone();
                    shifted[node][i] += by;
                    strain_energy(&model, &shifted)
                };
                let slope = (at(step) - at(-step)) / (2.0 * step);
                let error = (forces[node][i] + slope).abs() / scale;
                // Rounding of energies of about 1e-16 · 3 · W/(h F L); seen 1e-9.
                assert!(error <= 1e-8, "{order:?} {node} {i}: {error}");
            }
        }
    }
}

#[test]
fn free_fall() {
    for order in [Order::Linear, Order::Quadratic] {
        for method in [ExplicitMethod::CentralDifferences, ExplicitMethod::RungeKutta] {
            let mut problem = block([2, 2, 1], order);
            problem.gravity = [0.3, -2.0, -9.81];
            let start = still(&problem);
            let model = SolidModel::new(problem).unwrap();
            let volume: f64 = model.mass.iter().sum::<f64>() / DENSITY;
            let mut solid = ExplicitSolid::new(
                model,
                method,
                SolidStepping::FractionOfLimit(0.5),
                start.clone(),
                start,
            )
            .unwrap();
            for _ in 0..100 {
                solid.step(|_, _, _| {}).unwrap();
            }
            let t = solid.time;
            for (velocity, place) in solid.velocity().iter().zip(solid.displacement.clone()) {
                for (i, g) in [0.3, -2.0, -9.81].into_iter().enumerate() {
                    assert!((velocity[i] / (g * t) - 1.0).abs() <= 1e-12);
                    assert!((place[i] / (0.5 * g * t * t) - 1.0).abs() <= 1e-12, "{method:?}");
                }
            }
            assert!(volume > 0.0);
        }
    }
}

#[test]
fn energy_is_kept() {
    for order in [Order::Linear, Order::Quadratic] {
        for (method, fraction, limit) in [
            (ExplicitMethod::CentralDifferences, 0.5, 1e-9),
            // Runge–Kutta damps (ωh)⁶/72 a step of a mode: 9e-7 over this run of the fastest.
            (ExplicitMethod::RungeKutta, 0.02, 1e-6),
        ] {
            let problem = block([4, 1, 1], order);
            // So small that the body is linear, where central differences keep their energy exactly.
            let (start, rest) = (bent(&problem, 1e-9), still(&problem));
            let mut solid = ExplicitSolid::new(
                SolidModel::new(problem).unwrap(),
                method,
                SolidStepping::FractionOfLimit(fraction),
                start,
                rest,
            )
            .unwrap();
            let first = solid.energy();
            let first = first.strain + first.kinetic;
            let mut worst = 0.0f64;
            for _ in 0..2000 {
                solid.step(|_, _, _| {}).unwrap();
            }
            let now = solid.energy();
            worst = worst.max(((now.strain + now.kinetic) / first - 1.0).abs());
            println!("{order:?} {method:?} {worst:e} limit {:?}", solid.limit);
            assert!(worst <= limit, "{order:?} {method:?}: {worst}");
        }
    }
}

#[test]
fn steps_end_where_the_limit_says() {
    for order in [Order::Linear, Order::Quadratic] {
        for method in [ExplicitMethod::CentralDifferences, ExplicitMethod::RungeKutta] {
            let problem = block([4, 1, 1], order);
            let rest = still(&problem);
            let start = bent(&problem, 1e-9);
            let grows = |ratio: f64| {
                let model = SolidModel::new(problem.clone()).unwrap();
                let mut solid = ExplicitSolid::new(
                    model,
                    method,
                    SolidStepping::FractionOfLimit(1.0),
                    start.clone(),
                    rest.clone(),
                )
                .unwrap();
                solid.step_size *= ratio;
                let first = solid.energy().strain;
                for _ in 0..3000 {
                    if solid.step(|_, _, _| {}).is_err() {
                        return true;
                    }
                }
                let now = strain_energy(&solid.model, &solid.displacement);
                now.is_nan() || now > 100.0 * first
            };
            assert!(!grows(0.99), "{order:?} {method:?}");
            assert!(grows(1.01), "{order:?} {method:?}");
        }
    }
}

#[test]
fn a_step_beyond_the_limit_is_refused() {
    let problem = block([1, 1, 1], Order::Linear);
    let rest = still(&problem);
    let make = |stepping| {
        let model = SolidModel::new(problem.clone()).unwrap();
        let method = ExplicitMethod::CentralDifferences;
        ExplicitSolid::new(model, method, stepping, rest.clone(), rest.clone())
    };
    let limit = make(SolidStepping::FractionOfLimit(0.9)).unwrap().limit.step;
    assert!(make(SolidStepping::Fixed(0.99 * limit)).is_ok());
    assert!(matches!(make(SolidStepping::Fixed(1.01 * limit)), Err(SolidError::Step { .. })));
    assert!(make(SolidStepping::Fixed(f64::NAN)).is_err());
}

/// What moves a clamp does the work that the body then holds, its own inertia included.
#[test]
fn a_moving_clamp_does_the_work_that_the_body_holds() {
    // Central differences close to rounding but for strains of 1e-5; Runge–Kutta by its order.
    for (method, allowed) in
        [(ExplicitMethod::CentralDifferences, 1e-7), (ExplicitMethod::RungeKutta, 1e-7)]
    {
        let mut problem = block([4, 1, 1], Order::Linear);
        let profile = Profile::SmoothRamp { from: 0.0, to: 1e-6, start: 0.0, duration: 2e-5 };
        for node in 0..4 {
            problem.prescribed.push(Prescribed { node, axis: 0, profile: profile.clone() });
        }
        let rest = still(&problem);
        let model = SolidModel::new(problem).unwrap();
        let stepping = SolidStepping::FractionOfLimit(0.2);
        let mut solid = ExplicitSolid::new(model, method, stepping, rest.clone(), rest).unwrap();
        while solid.time < 1e-5 {
            solid.step(|_, _, _| {}).unwrap();
        }
        let ledger = solid.ledger();
        let held = ledger.energy.strain + ledger.energy.kinetic;
        let error = (ledger.external_work / held - 1.0).abs();
        println!("{method:?} {error:e}");
        assert!(held > 0.0 && error <= allowed, "{method:?}: {error:e}");
    }
}

/// Damping of what is left of rigid motion takes nothing from a fall.
#[test]
fn a_fall_is_not_braked_by_damping_relative_to_rigid_motion() {
    for order in [Order::Linear, Order::Quadratic] {
        for method in [ExplicitMethod::CentralDifferences, ExplicitMethod::RungeKutta] {
            let mut problem = block([2, 1, 1], order);
            problem.gravity = [1.0, -2.0, -9.81];
            problem.damping = 1e4;
            problem.damped_motion = DampedMotion::RelativeToRigid;
            let rest = still(&problem);
            let model = SolidModel::new(problem.clone()).unwrap();
            let stepping = SolidStepping::FractionOfLimit(0.9);
            let mut solid =
                ExplicitSolid::new(model, method, stepping, rest.clone(), rest).unwrap();
            for _ in 0..300 {
                solid.step(|_, _, _| {}).unwrap();
            }
            for u in &solid.displacement {
                for (u, g) in u.iter().zip(problem.gravity) {
                    let exact = 0.5 * g * solid.time * solid.time;
                    let error = (u / exact - 1.0).abs();
                    assert!(error <= 1e-9, "{order:?} {method:?}: {error:e}");
                }
            }
        }
    }
}

/// A body that spins about X as if rigid, stretched by nothing.
#[test]
fn damping_leaves_rotation_alone_where_asked() {
    for (damped_motion, kept) in
        [(DampedMotion::RelativeToRigid, 1.0), (DampedMotion::Absolute, f64::NAN)]
    {
        let mut problem = block([2, 2, 2], Order::Linear);
        problem.damping = 1e4;
        problem.damped_motion = damped_motion;
        let spin = [200.0, 0.0, 0.0];
        let velocity: Vec<Vec3> = problem.nodes.iter().map(|x| cross(spin, *x)).collect();
        let nodes = problem.nodes.clone();
        let mass = SolidModel::new(problem.clone()).unwrap().mass;
        let momentum = |displacement: &[[f64; 4]], velocity: &[Vec3]| -> f64 {
            (0..mass.len())
                .map(|n| {
                    let place = [0, 1, 2].map(|i: usize| nodes[n][i] + displacement[n][i]);
                    mass[n] * cross(place, velocity[n])[0]
                })
                .sum()
        };
        let mut solid = ExplicitSolid::new(
            SolidModel::new(problem).unwrap(),
            ExplicitMethod::CentralDifferences,
            SolidStepping::FractionOfLimit(0.5),
            vec![[0.0; 3]; nodes.len()],
            velocity.clone(),
        )
        .unwrap();
        let first = momentum(&solid.displacement, &velocity);
        while solid.time < 1e-4 {
            solid.step(|_, _, _| {}).unwrap();
        }
        let now = solid.velocity();
        let last = momentum(&solid.displacement, &now);
        // Damping in the body's own frame has no net force and moment; in space it brakes by
        // e^(−αt).
        let expected = if kept == 1.0 { first } else { first * (-1e4 * solid.time).exp() };
        // Relative damping has no moment but for rounding; the brake is of second order in αh.
        let allowed = if kept == 1.0 { 1e-9 } else { 1e-3 };
        assert!((last / expected - 1.0).abs() <= allowed, "{damped_motion:?} {last} {expected}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// A turn of the deformed body turns its forces.
    #[test]
    fn forces_turn_with_the_body(angles in prop::array::uniform3(-3.0f64..3.0), size in 0.0f64..0.2) {
        for order in [Order::Linear, Order::Quadratic] {
            let model = SolidModel::new(block([2, 1, 1], order)).unwrap();
            let moved = bent(&model.problem, size);
            let turn = nalgebra::Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
            let turned: Vec<Vec3> = (0..moved.len())
                .map(|n| {
                    let x = nalgebra::Vector3::from(model.problem.nodes[n]);
                    (turn * (x + nalgebra::Vector3::from(moved[n])) - x).into()
                })
                .collect();
            let forces = |moved: &[Vec3]| {
                let mut sum = vec![[0.0; 4]; moved.len()];
                model.add_internal_forces(&pad(moved), &mut sum);
                sum
            };
            let (before, after) = (forces(&moved), forces(&turned));
            let mut sum = [0.0; 3];
            let mut moment = [0.0; 3];
            for n in 0..before.len() {
                let b = nalgebra::Vector3::new(before[n][0], before[n][1], before[n][2]);
                let a = nalgebra::Vector3::new(after[n][0], after[n][1], after[n][2]);
                // Stresses of E times rounding of strains (1e-16 of a displacement gradient of up
                // to 2), over faces of 1e-4 m².
                prop_assert!((turn * b - a).norm() <= 2e11 * 1e-4 * 1e-14, "{}", (turn * b - a).norm());
                let place: Vec3 = std::array::from_fn(|i| model.problem.nodes[n][i] + turned[n][i]);
                let arm = cross(place, a.into());
                for i in 0..3 {
                    sum[i] += a[i];
                    moment[i] += arm[i];
                }
            }
            for i in 0..3 {
                prop_assert!(sum[i].abs() <= 2e11 * 1e-4 * 1e-14);
                prop_assert!(moment[i].abs() <= 2e11 * 1e-6 * 1e-14);
            }
        }
    }
}

/// Two and three threads: every bit of state and ledger is that of one.
#[test]
fn threads_change_no_bit() {
    for order in [Order::Linear, Order::Quadratic] {
        let mut problem = block([14, 12, 12], order);
        problem.damping = 300.0;
        problem.gravity = [1.0, -2.0, -9.81];
        problem.loads.push(Load {
            forces: (0..200).map(|n| (7 * n, [10.0, -3.0, f64::from(n)])).collect(),
            profile: Profile::Harmonic { mean: 1.0, amplitude: 1.0, frequency: 1e4, phase: 0.3 },
        });
        for node in 0..100 {
            let profile = Profile::Constant(0.0);
            problem.prescribed.push(Prescribed { node, axis: 1, profile });
        }
        let start = bent(&problem, 1e-5);
        let rest = still(&problem);
        let make = || {
            ExplicitSolid::new(
                SolidModel::new(problem.clone()).unwrap(),
                ExplicitMethod::CentralDifferences,
                SolidStepping::FractionOfLimit(0.8),
                start.clone(),
                rest.clone(),
            )
            .unwrap()
        };
        let mut alone = make();
        for _ in 0..30 {
            alone.step(|_, _, _| {}).unwrap();
        }
        for threads in [2, 3] {
            let mut shared = make();
            shared.share(&WorkerPool::new(threads), threads);
            assert!(shared.elements_a_step() > shared.model.problem.elements.len());
            for _ in 0..30 {
                shared.step(|_, _, _| {}).unwrap();
            }
            assert!(shared.steps == 30 && shared.time.to_bits() == alone.time.to_bits());
            for (a, b) in shared.displacement.iter().zip(&alone.displacement) {
                assert!(a[..3].iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()));
            }
            for (a, b) in [
                (shared.external_work(), alone.external_work()),
                (shared.damping_work(), alone.damping_work()),
            ] {
                assert!(a != 0.0 && a.to_bits() == b.to_bits(), "{a} {b}");
            }
            assert!(shared.velocity() == alone.velocity());
        }
    }
}

/// Without enough products the limit is a bound: safe, said to be one, and not far below the limit.
#[test]
fn a_limit_that_does_not_settle_is_a_safe_bound() {
    for order in [Order::Linear, Order::Quadratic] {
        let mut problem = block([3, 2, 2], order);
        let profile = Profile::ZERO;
        problem.prescribed.push(Prescribed { node: 4, axis: 1, profile });
        let model = SolidModel::new(problem).unwrap();
        let moved = pad(&bent(&model.problem, 0.02));
        let method = ExplicitMethod::CentralDifferences;
        let settled = step_limit(&model, &moved, method);
        assert!(!settled.is_bound && settled.products > 8);
        let bound = step_limit_within(&model, &moved, method, settled.products - 1);
        assert!(bound.is_bound && bound.products == settled.products - 1);
        let ratio = bound.step / settled.step;
        // Rows add sizes where the true forces cancel; in ten-node elements more of them do.
        assert!(ratio > 0.3 && ratio < 1.0, "{order:?}: {ratio}");
    }
}

#[test]
fn axes_are_three() {
    for axis in [3, 4, usize::MAX] {
        let mut problem = block([1, 1, 1], Order::Linear);
        problem.prescribed.push(Prescribed { node: 0, axis, profile: Profile::ZERO });
        let refused = SolidModel::new(problem).unwrap_err();
        assert_eq!(refused, SolidError::NoSuchAxis { node: 0, axis });
    }
}

/// A block on the ground under its weight, started from equilibrium: it stays at rest where
/// gravity pulled at the masses that explicit steps have. Elsewhere nodes swing by what the two loads
/// differ by in an element: with the square of its size.
#[test]
fn a_start_in_equilibrium_under_weight_stays_at_rest() {
    let size = [0.02, 0.02, 0.02];
    let mut swings = Vec::new();
    for (order, gravity, cells) in [
        (Order::Linear, MassMatrix::Consistent, 2),
        (Order::Quadratic, MassMatrix::Lumped, 2),
        (Order::Quadratic, MassMatrix::Consistent, 2),
        (Order::Quadratic, MassMatrix::Consistent, 4),
    ] {
        let mut problem = solid(cut_cubes(size, [cells; 3], 0.0, |_| false), order);
        problem.gravity = [0.0, 0.0, -9.81];
        for (node, place) in (0..).zip(&problem.nodes) {
            if place[2] == 0.0 {
                let profile = Profile::ZERO;
                problem.prescribed.extend([0, 1, 2].map(|axis| Prescribed {
                    node,
                    axis,
                    profile: profile.clone(),
                }));
            }
        }
        let model = SolidModel::new(problem).unwrap();
        let options = EquilibriumOptions { gravity, ..Default::default() };
        let start = equilibrium(&model, 0.0, &options).unwrap().displacement;
        let sag = start.iter().map(|u| u[2].abs()).fold(0.0, f64::max);
        let still = still(&model.problem);
        let (method, stepping) =
            (ExplicitMethod::CentralDifferences, SolidStepping::FractionOfLimit(0.9));
        let mut run = ExplicitSolid::new(model, method, stepping, start.clone(), still).unwrap();
        let mut swing = 0.0f64;
        for _ in 0..200 * cells {
            run.step(|_, _, _| {}).unwrap();
            for (now, start) in run.displacement.iter().zip(&start) {
                swing = swing.max((now[2] - start[2]).abs() / sag);
            }
        }
        swings.push(swing);
    }
    println!("swing over sag: {swings:?}");
    // Unbalanced forces of 1e-10, as equilibrium leaves them.
    assert!(swings[0] <= 1e-8 && swings[1] <= 1e-8, "{swings:?}");
    assert!(swings[2] > 0.1 && swings[2] < 1.0, "{swings:?}");
    assert!(swings[3] < 0.4 * swings[2], "{swings:?}");
}

/// Damping relative to rigid motion takes what swings and nothing of what flies: the ledger closes for a body in flight.
#[test]
fn the_work_of_relative_damping_is_that_of_what_swings() {
    for method in [ExplicitMethod::CentralDifferences, ExplicitMethod::RungeKutta] {
        let mut problem = block([2, 1, 1], Order::Linear);
        problem.damping = 2e4;
        problem.damped_motion = DampedMotion::RelativeToRigid;
        let flight = [3.0, -20.0, 10.0];
        let velocity: Vec<Vec3> = problem
            .nodes
            .iter()
            .map(|x| [flight[0] + 100.0 * x[0], flight[1], flight[2] - 50.0 * x[1]])
            .collect();
        let rest = still(&problem);
        let model = SolidModel::new(problem).unwrap();
        let stepping = SolidStepping::FractionOfLimit(0.1);
        let mut solid = ExplicitSolid::new(model, method, stepping, rest, velocity).unwrap();
        let first = solid.ledger();
        while solid.time < 1e-4 {
            solid.step(|_, _, _| {}).unwrap();
        }
        let last = solid.ledger();
        // e^(−αt) of what swings is a seventh.
        let lost = -last.damping_work;
        let missing = last.balance() - first.balance();
        println!("{method:?}: {lost:e} J lost, {missing:e} J missing of {first:?}");
        assert!(lost > 0.0 && lost < 0.1 * first.energy.kinetic, "{method:?} {last:?}");
        // The balance of central differences is of second order in the step, (ωh)² of 0.04 at the most.
        assert!(missing.abs() <= 0.02 * lost, "{method:?}: {missing:e} J of {lost:e} J");
    }
}
