//! Explicit steps of linear tetrahedra against a plain element loop, against what the processor can
//! do without fused operations, and over two threads; quadratic ones beside them.
//!
//! Not a criterion bench: ratios of least times in one run, with bounds that fail. Plain loop and
//! roof are written here, apart from the library.

mod common;
#[path = "common/plain.rs"]
mod plain;
#[path = "common/steel.rs"]
mod steel;
#[path = "common/turns.rs"]
mod turns;

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::mesh::numbering::reverse_cuthill_mckee;
use bearing_dynamics::mesh::quadratic::elevate;
use bearing_dynamics::mesh::tet_mesh::Elements;
use bearing_dynamics::solids::explicit::ExplicitSolid;
use bearing_dynamics::solids::threads::WorkerPool;
use common::{cube, least};
use nalgebra::{Matrix3, Matrix3x4};
use plain::{PlainElement, PlainNodes, plain_elements};
use std::hint::black_box;
use steel::solid;
use turns::once_more;

/// Least acceptable ratios up to 50 000 elements; docs/benchmarks.md has what was measured.
const LEAST_OVER_PLAIN: f64 = if cfg!(target_feature = "avx512f") { 2.5 } else { 2.2 };
const LEAST_OF_ROOF: f64 = 0.35;

/// Additions and multiplications of an element: relative displacements 9, displacement gradient 45,
/// strain 45, stress 13, scaling 6, first Piola–Kirchhoff stress 54, forces 45, the fourth node 9,
/// sums at the nodes 12.
const FLOPS: f64 = 238.0;

/// The element as nalgebra's matrices write it, one after the other.
struct Plain {
    elements: Vec<PlainElement>,
    nodes: PlainNodes,
    material: LinearElastic,
}

impl Plain {
    fn new(solid: &ExplicitSolid) -> Plain {
        let problem = &solid.model.problem;
        let Elements::Linear(list) = &problem.elements else { panic!("linear elements") };
        Plain {
            elements: plain_elements(&problem.nodes, list),
            nodes: PlainNodes::new(solid),
            material: problem.material,
        }
    }

    fn step(&mut self) {
        let (lambda, double) = (self.material.lambda, 2.0 * self.material.shear_modulus);
        for (gradients, volume, nodes) in &self.elements {
            let [a, b, c, d] = nodes.map(|n| self.nodes.displacement[n]);
            let h = Matrix3x4::from_columns(&[a, b, c, d]) * gradients.transpose();
            let strain = (h + h.transpose() + h.transpose() * h) * 0.5;
            let stress = strain * double + Matrix3::identity() * (lambda * strain.trace());
            let forces = (Matrix3::identity() + h) * stress * gradients * -*volume;
            for (node, force) in nodes.iter().zip(forces.column_iter()) {
                self.nodes.force[*node] += force;
            }
        }
        self.nodes.step();
    }
}

#[cfg(target_feature = "avx512f")]
type Widest = wide::f64x8;
#[cfg(not(target_feature = "avx512f"))]
type Widest = wide::f64x4;

/// Multiplications and additions a second without fused operations, all in registers of the widest
/// kind: as many chains as keep every port busy and still fit into 16 registers.
fn roof() -> f64 {
    const CHAINS: usize = 12;
    let lanes = size_of::<Widest>() / size_of::<f64>();
    let rounds = 2_000_000;
    let mut values = [Widest::splat(1.0); CHAINS];
    let factor = Widest::splat(black_box(0.999_999));
    let add = Widest::splat(black_box(1e-7));
    let seconds = least(8, 1, |_| {
        let mut now = values;
        for _ in 0..rounds {
            for chain in &mut now {
                *chain = *chain * factor + add;
            }
        }
        values = black_box(now);
    });
    (rounds * CHAINS * lanes * 2) as f64 / seconds
}

fn main() {
    let roof = roof();
    println!("multiplications and additions without fusing: {:.1} G/s", roof * 1e-9);
    println!("elements   plain M/s   lanes M/s   ratio   of roof   two threads M/s   ratio");
    let mut ratios = Vec::new();
    let mut speeds = Vec::new();
    // 3072 to 48 000 elements, 55 566 and 511 104.
    for cells in [8, 13, 20, 21, 44] {
        let mut solid = solid(&cube(cells));
        let count = solid.model.problem.elements.len();
        let steps = (4_000_000 / count).max(2);
        let mut plain = Plain::new(&solid);
        let mut team = self::solid(&cube(cells));
        team.share(&WorkerPool::new(2), 2);
        // In turn, so that all see the same machine.
        let (mut of_plain, mut of_lanes, mut of_two) = (f64::MAX, f64::MAX, f64::MAX);
        let mut turn = 0;
        let held = |plain: f64, lanes: f64| {
            let of_roof = count as f64 / lanes * FLOPS / roof;
            count > 50_000 || (plain >= LEAST_OVER_PLAIN * lanes && of_roof >= LEAST_OF_ROOF)
        };
        while once_more(turn, held(of_plain, of_lanes)) {
            turn += 1;
            of_plain = of_plain.min(least(2, steps, |n| (0..n).for_each(|_| plain.step())));
            of_lanes = of_lanes.min(least(2, steps, |n| {
                (0..n).for_each(|_| solid.step(|_, _, _| {}).expect("stable"));
            }));
            of_two = of_two.min(least(2, steps, |n| {
                (0..n).for_each(|_| team.step(|_, _, _| {}).expect("stable"));
            }));
        }
        let speed = count as f64 / of_lanes;
        let of_roof = speed * FLOPS / roof;
        println!(
            "{count:8}   {:9.1}   {:9.1}   {:5.2}   {of_roof:7.2}   {:15.1}   {:5.2}",
            count as f64 / of_plain * 1e-6,
            speed * 1e-6,
            of_plain / of_lanes,
            count as f64 / of_two * 1e-6,
            of_lanes / of_two,
        );
        ratios.push((of_plain / of_lanes, of_roof));
        speeds.push(speed);
    }
    println!(
        "an element of the largest mesh costs {:.2} times one of the third",
        speeds[2] / speeds[4]
    );
    let mesh = elevate(&cube(13), &[]).expect("straight edges").mesh;
    let mut quadratic = solid(&reverse_cuthill_mckee(mesh).mesh);
    let count = quadratic.model.problem.elements.len();
    let seconds = least(6, 40, |n| {
        (0..n).for_each(|_| quadratic.step(|_, _, _| {}).expect("stable"));
    });
    println!(
        "quadratic: {:.2} M/s ({count} elements, {} nodes), {:.1} times the time of a linear element",
        count as f64 / seconds * 1e-6,
        quadratic.model.mass.len(),
        seconds / count as f64 * speeds[1],
    );
    for (ratio, of_roof) in &ratios[..3] {
        let held = *ratio >= LEAST_OVER_PLAIN && *of_roof >= LEAST_OF_ROOF;
        if !held {
            eprintln!(
                "wanted at least {LEAST_OVER_PLAIN} times the plain loop and {LEAST_OF_ROOF} of the roof"
            );
            std::process::exit(1);
        }
    }
}
