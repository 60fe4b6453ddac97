//! Explicit steps of rubber with fourteen Maxwell elements against a plain element loop.
//!
//! Not a criterion bench: ratios of least times in one run, with bounds that fail. The plain loop is written here,
//! apart from the library.

mod common;
#[path = "common/plain.rs"]
mod plain;
#[path = "common/turns.rs"]
mod turns;

use bearing_dynamics::ch2_housing::elastomer::named::table_3_1;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::tet_mesh::Elements;
use bearing_dynamics::solids::explicit::{ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::rubber::explicit::RubberBody;
use bearing_dynamics::solids::rubber::tet_forces::MeanStress;
use bearing_dynamics::solids::tet4_blocks::LANES;
use common::{cube, least};
use nalgebra::{Matrix3, Matrix3x4};
use plain::{PlainElement, PlainNodes, plain_elements};
use turns::once_more;

/// Least acceptable ratio up to 50 000 elements; docs/benchmarks.md has what was measured.
const LEAST_OVER_PLAIN: f64 = if cfg!(target_feature = "avx512f") { 2.8 } else { 2.5 };

/// A cube of 100 mm of the rubber of Table 3.1.
fn body(cells: usize, mean_stress: MeanStress) -> RubberBody {
    let mesh = cube(cells);
    let Elements::Linear(elements) = mesh.elements else { panic!("linear elements") };
    RubberBody {
        nodes: mesh.nodes,
        elements,
        material: table_3_1(),
        density: 1100.0,
        mean_stress,
        mass_scale: 1.0,
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    }
}

/// It moves from a slight shear and twist on.
fn solid(body: &RubberBody) -> ExplicitSolid {
    let start: Vec<Vec3> =
        body.nodes.iter().map(|x| [1e-3 * x[1], 2e-2 * x[0] * x[2], 0.0]).collect();
    let rest = vec![[0.0; 3]; start.len()];
    let stepping = SolidStepping::FractionOfLimit(0.5);
    ExplicitSolid::of_rubber(body, stepping, start, rest).expect("a stable step").0
}

/// The element as nalgebra's matrices write (2.12) to (2.14), one after the other.
struct Plain {
    elements: Vec<PlainElement>,
    nodes: PlainNodes,
    /// Of each node, m³, a quarter of each element there, where volumes are averaged around nodes.
    around: Option<Vec<f64>>,
    /// Of every element in this step.
    gradient: Vec<Matrix3<f64>>,
    /// DEV S, and one of each Maxwell element, of every element.
    before: Vec<Matrix3<f64>>,
    history: Vec<Vec<Matrix3<f64>>>,
    /// exp(−Δt/τ), γ (1 − exp(−Δt/τ)) τ/Δt.
    factors: Vec<[f64; 2]>,
    /// Powers of Ī₁ in ∂W/∂Ī₁, over C_R; C_R, B.
    slope: [f64; 5],
    moduli: [f64; 2],
}

impl Plain {
    fn new(body: &RubberBody, solid: &ExplicitSolid) -> Plain {
        let elements = plain_elements(&body.nodes, &body.elements);
        let (maxwell, network) = (&body.material.maxwell, &body.material.network);
        let step = solid.step_size;
        let factor = |gamma: f64, tau: f64| {
            let decay = (-step / tau).exp();
            [decay, gamma * (1.0 - decay) * tau / step]
        };
        let n = network.locking;
        let around = (body.mean_stress == MeanStress::AroundNodes).then(|| {
            let mut volumes = vec![0.0; body.nodes.len()];
            for (_, volume, nodes) in &elements {
                nodes.iter().for_each(|n| volumes[*n] += 0.25 * volume);
            }
            volumes
        });
        let mut plain = Plain {
            around,
            gradient: vec![Matrix3::identity(); elements.len()],
            before: vec![Matrix3::zeros(); elements.len()],
            history: vec![vec![Matrix3::zeros(); maxwell.len()]; elements.len()],
            factors: maxwell.iter().map(|m| factor(m.gamma, m.tau)).collect(),
            slope: [
                0.5,
                0.1 / n,
                33.0 / 1050.0 / n.powi(2),
                76.0 / 7000.0 / n.powi(3),
                2595.0 / 673_750.0 / n.powi(4),
            ],
            moduli: [network.modulus, network.bulk],
            nodes: PlainNodes::new(solid),
            elements,
        };
        // What it is strained by at the start has relaxed.
        let strained = plain.elements.iter().map(|of| gradient(of, &plain.nodes));
        plain.before = strained.map(|f| isochoric(&f, &plain.slope, network.modulus).0).collect();
        plain
    }

    /// J − 1 of every node: changes of volume there over its volume.
    fn dilatations(&mut self, volumes: &[f64]) -> Vec<f64> {
        let mut changes = vec![0.0; volumes.len()];
        for ((_, volume, nodes), f) in self.elements.iter().zip(&self.gradient) {
            let change = 0.25 * volume * (f.determinant() - 1.0);
            nodes.iter().for_each(|n| changes[*n] += change);
        }
        changes.iter().zip(volumes).map(|(change, volume)| change / volume).collect()
    }

    fn step(&mut self) {
        match self.around.take() {
            None => {
                for index in 0..self.elements.len() {
                    let f = gradient(&self.elements[index], &self.nodes);
                    self.element(index, &f, None);
                }
            }
            Some(volumes) => {
                for (element, f) in self.elements.iter().zip(&mut self.gradient) {
                    *f = gradient(element, &self.nodes);
                }
                let of_nodes = self.dilatations(&volumes);
                for index in 0..self.elements.len() {
                    let sum: f64 = self.elements[index].2.iter().map(|n| of_nodes[*n]).sum();
                    let f = self.gradient[index];
                    self.element(index, &f, Some(0.25 * sum));
                }
                self.around = Some(volumes);
            }
        }
        self.nodes.step();
    }

    /// Adds the forces of one element; its own J − 1 unless another is given.
    #[inline(always)]
    fn element(&mut self, index: usize, f: &Matrix3<f64>, dilatation: Option<f64>) {
        let (own, j, inverse) = isochoric(f, &self.slope, self.moduli[0]);
        let change = own - self.before[index];
        self.before[index] = own;
        let dilatation = dilatation.unwrap_or(j - 1.0);
        let mut stress = own + inverse * (self.moduli[1] * j * dilatation);
        for (h, [decay, gain]) in self.history[index].iter_mut().zip(&self.factors) {
            *h = *h * *decay + change * *gain;
            stress += *h;
        }
        let (gradients, volume, nodes) = &self.elements[index];
        let forces = f * stress * gradients * -*volume;
        for (node, force) in nodes.iter().zip(forces.column_iter()) {
            self.nodes.force[*node] += force;
        }
    }
}

#[inline(always)]
fn gradient((gradients, _, nodes): &PlainElement, of: &PlainNodes) -> Matrix3<f64> {
    let [a, b, c, d] = nodes.map(|n| of.displacement[n]);
    Matrix3::identity() + Matrix3x4::from_columns(&[a, b, c, d]) * gradients.transpose()
}

/// DEV S without the Maxwell elements, J, C⁻¹.
#[inline(always)]
fn isochoric(
    f: &Matrix3<f64>,
    slope: &[f64; 5],
    modulus: f64,
) -> (Matrix3<f64>, f64, Matrix3<f64>) {
    let right = f.transpose() * f;
    let inverse = right.try_inverse().expect("a sound element");
    let j = f.determinant();
    let isochoric = 1.0 / (j * j).cbrt();
    let invariant = isochoric * right.trace();
    let [p, q, r, s, t] = slope;
    let slope = p + invariant * (q + invariant * (r + invariant * (s + invariant * t)));
    let own = (Matrix3::identity() - inverse * (right.trace() / 3.0))
        * (2.0 * modulus * slope * isochoric);
    (own, j, inverse)
}

/// Largest difference of a displacement after twenty steps of both, over the largest.
fn apart(body: &RubberBody) -> f64 {
    let mut solid = solid(body);
    let mut plain = Plain::new(body, &solid);
    for _ in 0..20 {
        solid.step(|_, _, _| {}).expect("stable");
        plain.step();
    }
    let of_both = solid.displacement.iter().zip(&plain.nodes.displacement);
    let (mut difference, mut size) = (0.0_f64, 0.0_f64);
    for (ours, theirs) in of_both {
        for i in 0..3 {
            difference = difference.max((ours[i] - theirs[i]).abs());
            size = size.max(theirs[i].abs());
        }
    }
    difference / size
}

fn refuse(why: &str) -> ! {
    eprintln!("{why}");
    std::process::exit(1)
}

fn main() {
    for mean_stress in [MeanStress::OfElement, MeanStress::AroundNodes] {
        let apart = apart(&body(4, mean_stress));
        println!("{mean_stress:?}: {apart:.1e} from the plain loop after twenty steps");
        // Sums of fourteen elements in another order, over twenty steps.
        let same = apart <= 1e-12;
        if !same {
            refuse("the plain loop does not compute the same motion");
        }
    }
    println!("{LANES} lanes; millions of elements and steps a second");
    println!("elements   plain   own volume   ratio   plain, around nodes   around nodes   ratio");
    let mut ratios = Vec::new();
    // 3072, 13 182, 48 000 and 118 098 elements.
    for cells in [8, 13, 20, 27] {
        let (own, around) =
            (body(cells, MeanStress::OfElement), body(cells, MeanStress::AroundNodes));
        let (mut own_solid, mut around_solid) = (solid(&own), solid(&around));
        let mut plain = Plain::new(&own, &own_solid);
        let mut plain_around = Plain::new(&around, &around_solid);
        let count = own.elements.len();
        let steps = (1_000_000 / count).max(2);
        let mut seconds = [f64::MAX; 4];
        let held = |seconds: &[f64; 4]| {
            [[0, 1], [2, 3]].iter().all(|[a, b]| seconds[*a] >= LEAST_OVER_PLAIN * seconds[*b])
        };
        // In turn, so that all see the same machine.
        let mut turn = 0;
        while once_more(turn, count > 50_000 || held(&seconds)) {
            turn += 1;
            let go = |solid: &mut ExplicitSolid, n: usize| {
                (0..n).for_each(|_| solid.step(|_, _, _| {}).expect("stable"));
            };
            let now = [
                least(2, steps, |n| (0..n).for_each(|_| plain.step())),
                least(2, steps, |n| go(&mut own_solid, n)),
                least(2, steps, |n| (0..n).for_each(|_| plain_around.step())),
                least(2, steps, |n| go(&mut around_solid, n)),
            ];
            for (least, now) in seconds.iter_mut().zip(now) {
                *least = least.min(now);
            }
        }
        let speed = seconds.map(|s| 1e-6 * count as f64 / s);
        let over_plain = [speed[1] / speed[0], speed[3] / speed[2]];
        println!(
            "{count:8}   {:5.2}   {:10.2}   {:5.2}   {:19.2}   {:12.2}   {:5.2}",
            speed[0], speed[1], over_plain[0], speed[2], speed[3], over_plain[1],
        );
        ratios.push(over_plain);
    }
    for ratio in ratios[..3].iter().flatten() {
        let held = *ratio >= LEAST_OVER_PLAIN;
        if !held {
            refuse(&format!("wanted at least {LEAST_OVER_PLAIN} times the plain loop"));
        }
    }
}
