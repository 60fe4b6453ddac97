//! Laws of stresses: patches, objectivity, balance with the forces, convergence on the nodes.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::kinematics::strain::{Sym3, full, principal, von_mises};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::generate::bar;
use bearing_dynamics::mesh::tet_mesh::Order;
use bearing_dynamics::solver::solid::model::{DampedMotion, SolidModel, SolidProblem};
use bearing_dynamics::solver::solid::stress::{nodal_stresses, point_stresses};
use nalgebra::{Matrix3, Rotation3, Vector3};

const YOUNG: f64 = 2.1e11;
const POISSON: f64 = 0.3;
const SIZE: [f64; 3] = [0.03, 0.02, 0.01];

fn model(counts: [usize; 3], order: Order) -> SolidModel {
    let solid = bar(SIZE, counts).unwrap();
    let mesh = match order {
        Order::Linear => solid.mesh,
        Order::Quadratic => solid.quadratic().unwrap().mesh,
    };
    SolidModel::new(SolidProblem {
        nodes: mesh.nodes,
        elements: mesh.elements,
        material: LinearElastic::new(YOUNG, POISSON).unwrap(),
        density: 7800.0,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    })
    .unwrap()
}

fn moved(model: &SolidModel, field: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    model.problem.nodes.iter().map(|x| field(*x)).collect()
}

/// Largest difference of any component from `exact`, over the largest of `exact`.
fn off<'a>(found: impl Iterator<Item = &'a Sym3>, exact: &Sym3) -> f64 {
    let scale = exact.iter().fold(0.0f64, |a, b| a.max(b.abs()));
    let gaps = found.flat_map(|t| t.iter().zip(exact)).map(|(a, b)| (a - b).abs() / scale);
    // Not `f64::max`, which drops a NaN.
    let larger = |most: f64, gap: f64| if most.is_nan() || gap <= most { most } else { gap };
    gaps.fold(0.0, larger)
}

/// Uniform deformation, as large as one likes, then turned: T = Q F S Fᵀ Qᵀ/J by plain matrices.
#[test]
fn uniform_stress_turns_with_the_body() {
    let h = Matrix3::new(0.05, 0.02, -0.01, 0.03, -0.04, 0.01, 0.0, 0.02, 0.03);
    let f = Matrix3::identity() + h;
    let strain = (f.transpose() * f - Matrix3::identity()) * 0.5;
    let (lambda, mu) = (YOUNG * 0.3 / (1.3 * 0.4), YOUNG / 2.6);
    let s = Matrix3::identity() * (lambda * strain.trace()) + strain * (2.0 * mu);
    for turn in [Rotation3::identity(), Rotation3::from_euler_angles(0.7, -1.1, 2.0)] {
        let f = turn * f;
        let t = f * s * f.transpose() / f.determinant();
        let exact = [t.m11, t.m22, t.m33, t.m12, t.m23, t.m13];
        for order in [Order::Linear, Order::Quadratic] {
            let model = model([3, 2, 2], order);
            let moved = moved(&model, |x| (f * Vector3::from(x) - Vector3::from(x)).into());
            // Turned, gradients of up to 2 are sums of ten products of 1e-16 each, over strains of
            // 0.05; continuing the four points to a corner triples that.
            let raw = point_stresses(&model, &moved);
            let error = off(raw.iter().flatten(), &exact);
            assert!(error <= 1e-12, "{order:?} {error}");
            let averaged = nodal_stresses(&model, &moved);
            let error = off(averaged.iter(), &exact);
            assert!(error <= 3e-12, "{order:?} {error}");
            assert_eq!(averaged.len(), model.mass.len());
        }
    }
}

/// Pure bending has a displacement of second degree, which ten-node elements hold: their nodal
/// stresses are exact. Four-node ones come near as the mesh is refined.
#[test]
fn stresses_of_pure_bending() {
    let curvature = 1e-6;
    let field = |[x, y, z]: Vec3| {
        [
            -curvature * x * z,
            curvature * POISSON * y * z,
            0.5 * curvature * (x * x + POISSON * (z * z - y * y)),
        ]
    };
    let scale = YOUNG * curvature * 0.5 * SIZE[2];
    let worst = |counts, order| {
        let model = model(counts, order);
        let stress = nodal_stresses(&model, &moved(&model, field));
        let off = |(t, place): (&Sym3, &Vec3)| {
            let exact = [-YOUNG * curvature * place[2], 0.0, 0.0, 0.0, 0.0, 0.0];
            (0..6).map(|i| (t[i] - exact[i]).powi(2)).sum::<f64>()
        };
        let sum: f64 = stress.iter().zip(&model.problem.nodes).map(off).sum();
        (sum / stress.len() as f64).sqrt() / scale
    };
    // Squares of a gradient of 4e-8 are left.
    assert!(worst([3, 2, 2], Order::Quadratic) <= 1e-6);
    let coarse = worst([6, 4, 4], Order::Linear);
    let fine = worst([12, 8, 8], Order::Linear);
    assert!(fine <= 0.7 * coarse && fine <= 0.15, "{coarse} {fine}");
}

#[test]
fn invariants_of_a_stress() {
    let pull = [3.0e8, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert!((von_mises(&pull) - 3.0e8).abs() <= 1e-7);
    let shear = [0.0, 0.0, 0.0, 1e8, 0.0, 0.0];
    assert!((von_mises(&shear) / 1e8 - 3f64.sqrt()).abs() <= 1e-15);
    for (found, exact) in principal(&shear).into_iter().zip([1e8, 0.0, -1e8]) {
        assert!((found - exact).abs() <= 1e-7);
    }
    let pressed = [-2e8, -2e8, -2e8, 0.0, 0.0, 0.0];
    assert!(von_mises(&pressed) <= 1e-7);
    // Of principal values, von Mises is the same.
    let any = [1.2e8, -0.4e8, 0.9e8, 0.5e8, -0.7e8, 0.3e8];
    let [a, b, c] = principal(&any);
    assert!((von_mises(&any) / von_mises(&[a, b, c, 0.0, 0.0, 0.0]) - 1.0).abs() <= 1e-14);
    assert!(a >= b && b >= c);
    let trace = full(&any);
    assert!((a + b + c - trace[0][0] - trace[1][1] - trace[2][2]).abs() <= 1e-6);
}
