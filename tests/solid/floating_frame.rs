//! A thin ring that spins in its plane, in component modes of a floating frame.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::ch5_cage::floating_frame::{FloatingFrame, Scratch};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
use bearing_dynamics::reduction::floating::{FloatingReduction, reduce_floating};
use bearing_dynamics::solids::model::{SolidModel, SolidProblem};
use nalgebra::DMatrix;
use std::f64::consts::TAU;

const RADIUS: f64 = 50e-3;
const THICKNESS: f64 = 1e-3;
const MODULUS: f64 = 210e9;
const DENSITY: f64 = 7850.0;

fn thin_ring() -> FloatingReduction {
    let size = Ring {
        inner_radius: RADIUS - 0.5 * THICKNESS,
        outer_radius: RADIUS + 0.5 * THICKNESS,
        width: 2e-3,
    };
    let cells = RingMesh { around: 60, radial: 1, axial: 2, radial_growth: 1.0 };
    let mesh = ring(&size, &cells).unwrap().quadratic().unwrap().mesh;
    let problem = SolidProblem {
        nodes: mesh.nodes,
        elements: mesh.elements,
        material: LinearElastic::new(MODULUS, 0.3).unwrap(),
        density: DENSITY,
        damping: 0.0,
        damped_motion: Default::default(),
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    reduce_floating(&SolidModel::new(problem).unwrap(), 3000.0, &[]).unwrap()
}

/// Modal accelerations and angular acceleration of the free ring.
fn rates(frame: &FloatingFrame, spin: [f64; 3], gone: &[f64], speeds: &[f64]) -> Vec<f64> {
    let mut accelerations = vec![0.0; frame.count()];
    let mut scratch = Scratch::new(frame.count());
    let done = frame.rates(spin, [0.0; 3], [gone, speeds], &mut accelerations, &mut scratch);
    accelerations.extend(done.spin_rate);
    accelerations
}

/// Amplitudes of the ring that spins without vibrating.
fn grown(frame: &FloatingFrame, spin: f64) -> Vec<f64> {
    let still = vec![0.0; frame.count()];
    let mut gone = still.clone();
    for _ in 0..60 {
        let left = rates(frame, [spin, 0.0, 0.0], &gone, &still);
        for ((gone, left), w) in gone.iter_mut().zip(left).zip(&frame.frequencies) {
            *gone += left / (w * w);
        }
    }
    gone
}

/// Frequencies of small vibrations about the spinning ring in its own axes, rad/s, ascending.
fn vibrations(frame: &FloatingFrame, spin: f64) -> Vec<f64> {
    let count = frame.count();
    let (gone, still) = (grown(frame, spin), vec![0.0; count]);
    let size = 2 * count + 3;
    let mut matrix = DMatrix::zeros(size, size);
    for column in 0..size {
        let shifted = |sign: f64| {
            let (mut gone, mut speeds, mut turning) =
                (gone.clone(), still.clone(), [spin, 0.0, 0.0]);
            let (step, entry) = match column {
                k if k < count => (1e-6, &mut gone[k]),
                k if k < 2 * count => (1e-3, &mut speeds[k - count]),
                k => (1e-3, &mut turning[k - 2 * count]),
            };
            *entry += sign * step;
            (rates(frame, turning, &gone, &speeds), 2.0 * step)
        };
        let ((after, twice), (before, _)) = (shifted(1.0), shifted(-1.0));
        for (row, (after, before)) in after.iter().zip(before).enumerate() {
            matrix[(count + row, column)] = (after - before) / twice;
        }
        if (count..2 * count).contains(&column) {
            matrix[(column - count, column)] = 1.0;
        }
    }
    let mut found: Vec<f64> =
        matrix.complex_eigenvalues().iter().map(|value| value.im).filter(|w| *w > 0.0).collect();
    found.sort_by(f64::total_cmp);
    found
}

#[test]
fn waves_around_a_spinning_ring_split_as_theory_says() {
    let reduction = thin_ring();
    let frame = &reduction.frame;
    for part in [0.05, 0.2] {
        let spin = part * frame.frequencies[0];
        let found = vibrations(frame, spin);
        for n in [2.0f64, 3.0] {
            // Inextensional thin ring with hoop tension (Bryan, Carrier): forward and backward waves in its own axes.
            let shape = n * n * (n * n - 1.0).powi(2) / (n * n + 1.0);
            let inertia = THICKNESS * THICKNESS / 12.0;
            let still = shape * MODULUS * inertia / (DENSITY * RADIUS.powi(4));
            let mean = (still + spin * spin * shape / (n * n + 1.0)).sqrt();
            let half = 2.0 * n * spin / (n * n + 1.0);
            // The mesh is stiffer by 1.2 % at rest; the change by spin is that of theory.
            let rest = frame.frequencies[if n == 2.0 { 0 } else { 4 }];
            let stiffer = rest / still.sqrt();
            let pair = [mean * stiffer - half, mean * stiffer + half].map(|wave| {
                let apart = |w: &&f64| (**w - wave).abs();
                *found.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap()
            });
            let split = (pair[1] - pair[0]) / (2.0 * half);
            assert!((split - 1.0).abs() <= 5e-3, "n = {n}: split {split} of theory");
            let change = 0.5 * (pair[0] + pair[1]) / (mean * stiffer);
            assert!((change - 1.0).abs() <= 1e-3, "n = {n}: mean frequency {change} of theory");
        }
    }
}

#[test]
fn a_spinning_ring_grows_as_theory_says() {
    let reduction = thin_ring();
    for part in [0.05, 0.2] {
        let spin = part * reduction.frame.frequencies[0];
        let moved = reduction.displacement(&grown(&reduction.frame, spin));
        // Mean over the nodes; all are within half the thickness of the mean radius.
        let radial: f64 = moved.iter().map(|[_, y, z]| y * y + z * z).sum::<f64>();
        let growth = (radial / moved.len() as f64).sqrt();
        let theory = DENSITY * spin * spin * RADIUS.powi(3) / MODULUS;
        assert!((growth / theory - 1.0).abs() <= 5e-3, "{growth} m for {theory} m");
    }
    assert!(reduction.frame.frequencies[0] / TAU > 250.0);
}
