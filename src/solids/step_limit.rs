//! Stability limit of explicit steps: from the highest frequency of the whole body by Lanczos' power iteration, or a
//! bound on it if that does not converge; and the element with the highest frequency of its own.

use crate::elements::tet4::{Tet4, relative};
use crate::elements::tet10::{self, Tet10};
use crate::kinematics::vec3::Vec3;
use crate::mesh::tet_mesh::Elements;
use crate::solids::explicit::ExplicitMethod;
use crate::solids::model::{SolidModel, centre, corners};
use crate::solids::tet4_blocks::Node;
use serde::{Deserialize, Serialize};

/// Stability limit of an explicit method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolidStepLimit {
    /// Largest stable step, s.
    pub step: f64,
    /// Highest angular frequency of the body, rad/s.
    pub frequency: f64,
    /// True if the iteration did not converge: `frequency` is then an upper bound, and the step shorter than necessary.
    pub is_bound: bool,
    /// The element with the highest frequency of its own, counted from 0, that frequency (rad/s; an upper bound of the
    /// body's), and its centre (m).
    pub element: usize,
    pub element_frequency: f64,
    pub at: Vec3,
    /// Number of products with the stiffness.
    pub products: usize,
}

impl SolidStepLimit {
    /// Limit of the same solid with springs that add at most `added` (1/s²) to the square of its highest frequency.
    pub fn with(&self, added: f64) -> SolidStepLimit {
        let frequency = (self.frequency * self.frequency + added).sqrt();
        SolidStepLimit { step: self.step * self.frequency / frequency, frequency, ..*self }
    }
}

/// ωh at the stability limit without damping: √8 for Runge–Kutta. Damping changes either limit by less than αh.
pub(crate) fn stability_margin(method: ExplicitMethod) -> f64 {
    match method {
        ExplicitMethod::CentralDifferences => 2.0,
        ExplicitMethod::RungeKutta => 8f64.sqrt(),
    }
}

/// Products with the stiffness after which [`step_limit`] takes the bound instead. Meshes of this program take 8 to
/// some 60.
pub(crate) const MOST_PRODUCTS: usize = 200;

/// The largest stable step at given displacements.
pub fn step_limit(
    model: &SolidModel,
    displacement: &[Node],
    method: ExplicitMethod,
) -> SolidStepLimit {
    step_limit_within(model, displacement, method, MOST_PRODUCTS)
}

/// As [`step_limit`], with a limit on the products with the stiffness.
pub fn step_limit_within(
    model: &SolidModel,
    displacement: &[Node],
    method: ExplicitMethod,
    most: usize,
) -> SolidStepLimit {
    let elements = ElementTangents::new(model, displacement);
    let (found, products) = highest_frequency(model, &elements, most);
    let frequency = found.unwrap_or_else(|| frequency_bound(model, &elements));
    let (element, element_frequency) = elements.fastest();
    let at = centre(&model.problem, element);
    let step = stability_margin(method) / frequency;
    let is_bound = found.is_none();
    SolidStepLimit { step, frequency, is_bound, element, element_frequency, at, products }
}

/// Element tangents for products with the stiffness.
struct ElementTangents<'a> {
    model: &'a SolidModel,
    displacement: &'a [Node],
    linear: Vec<Tet4>,
    quadratic: Vec<Tet10>,
}

impl<'a> ElementTangents<'a> {
    fn new(model: &'a SolidModel, displacement: &'a [Node]) -> Self {
        let nodes = &model.problem.nodes;
        let sound = "elements were checked when the model was made";
        let (mut linear, mut quadratic) = (Vec::new(), Vec::new());
        match &model.problem.elements {
            Elements::Linear(list) => {
                linear = list.iter().map(|e| Tet4::new(&corners(nodes, e)).expect(sound)).collect();
            }
            Elements::Quadratic(list) => {
                quadratic =
                    list.iter().map(|e| Tet10::new(&corners(nodes, e)).expect(sound)).collect();
            }
        }
        ElementTangents { model, displacement, linear, quadratic }
    }

    /// Nodes of an element and its forces for a change of displacement, −K_e x.
    fn product(&self, element: usize, x: impl Fn(usize, u32) -> Vec3) -> Product {
        let law = |strain: &_| self.model.problem.material.second_piola_kirchhoff(strain);
        let at = |node: u32| {
            let u = self.displacement[node as usize];
            [u[0], u[1], u[2]]
        };
        match &self.model.problem.elements {
            Elements::Linear(list) => {
                let nodes = list[element];
                let change = relative(&[0, 1, 2, 3].map(|n: usize| x(n, nodes[n])));
                let [a, b, c] =
                    self.linear[element].force_change(&relative(&nodes.map(at)), &change, law);
                let last = [0, 1, 2].map(|i: usize| -(a[i] + b[i] + c[i]));
                let mut forces = [[0.0; 3]; 10];
                forces[..4].copy_from_slice(&[a, b, c, last]);
                Product { count: 4, forces }
            }
            Elements::Quadratic(list) => {
                let nodes = list[element];
                let mut change = [[0.0; 3]; 10];
                for n in 0..10 {
                    change[n] = x(n, nodes[n]);
                }
                let forces = self.quadratic[element].force_change(&nodes.map(at), &change, law);
                Product { count: 10, forces }
            }
        }
    }

    /// The element with the highest frequency under its own lumped mass, by power iteration to a few percent.
    fn fastest(&self) -> (usize, f64) {
        let problem = &self.model.problem;
        let mut best = (0, 0.0);
        for element in 0..problem.elements.len() {
            let masses = match &problem.elements {
                Elements::Linear(_) => {
                    let mut masses = [0.0; 10];
                    masses[..4].fill(self.linear[element].nodal_mass(problem.density));
                    masses
                }
                Elements::Quadratic(list) => {
                    tet10::lumped_mass(&corners(&problem.nodes, &list[element]), problem.density)
                }
            };
            let mut x = start_vector();
            let mut square = 0.0;
            for _ in 0..20 {
                let Product { count, forces } = self.product(element, |n, _| x[n]);
                let mut largest = 0.0f64;
                for n in 0..count {
                    for i in 0..3 {
                        x[n][i] = -forces[n][i] / masses[n];
                        largest = largest.max(x[n][i].abs());
                    }
                }
                square = largest;
                for v in x.iter_mut().flatten() {
                    *v /= largest;
                }
            }
            if square > best.1 {
                best = (element, square);
            }
        }
        (best.0, best.1.sqrt())
    }
}

struct Product {
    count: usize,
    forces: [Vec3; 10],
}

/// An element displacement with components of all modes.
fn start_vector() -> [Vec3; 10] {
    let mut x = [[0.0; 3]; 10];
    for (k, v) in x.iter_mut().flatten().enumerate() {
        *v = libm::sin(1.0 + 2.7 * k as f64);
    }
    x
}

/// Highest angular frequency of the body, rad/s (`None` without convergence), and the number of products with the
/// stiffness.
fn highest_frequency(
    model: &SolidModel,
    elements: &ElementTangents,
    most: usize,
) -> (Option<f64>, usize) {
    let root = roots(model);
    lanczos(&root, most, |now, next| {
        for element in 0..model.problem.elements.len() {
            let nodes = model.problem.elements.nodes(element);
            let Product { count, forces } = elements.product(element, |_, node| {
                let (x, r) = (now[node as usize], root[node as usize]);
                [x[0] * r[0], x[1] * r[1], x[2] * r[2]]
            });
            for n in 0..count {
                let (sum, r) = (&mut next[nodes[n] as usize], root[nodes[n] as usize]);
                for i in 0..3 {
                    sum[i] -= forces[n][i] * r[i];
                }
            }
        }
    })
}

/// Square roots of the reciprocal masses.
pub(crate) fn roots(model: &SolidModel) -> Vec<Vec3> {
    model.per_mass.iter().map(|m| [m[0].sqrt(), m[1].sqrt(), m[2].sqrt()]).collect()
}

/// Square root of the largest eigenvalue of a symmetric matrix, whose product with its first argument `product` adds to
/// its second, by Lanczos' recurrence from a fixed start without components where `root` is zero (`None` without
/// convergence); and the number of products.
pub(crate) fn lanczos(
    root: &[Vec3],
    most: usize,
    mut product: impl FnMut(&[Vec3], &mut [Vec3]),
) -> (Option<f64>, usize) {
    let count = root.len();
    let dot = |a: &[Vec3], b: &[Vec3]| -> f64 {
        a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).sum()
    };
    // An alternating displacement: in the fastest modes neighbours move against each other.
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut now: Vec<Vec3> = (0..count)
        .map(|n| [0, 1, 2].map(|i: usize| if root[n][i] == 0.0 { 0.0 } else { random() }))
        .collect();
    let length = dot(&now, &now).sqrt();
    if length == 0.0 {
        return (Some(f64::MIN_POSITIVE), 0);
    }
    now.iter_mut().flatten().for_each(|v| *v /= length);
    let mut before = vec![[0.0; 3]; count];
    let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut largest = 0.0;
    for taken in 1..=most {
        let mut next = vec![[0.0; 3]; count];
        product(&now, &mut next);
        let alpha = dot(&next, &now);
        let last = beside.last().copied().unwrap_or(0.0);
        for n in 0..count {
            for i in 0..3 {
                next[n][i] -= alpha * now[n][i] + last * before[n][i];
            }
        }
        diagonal.push(alpha);
        let found = largest_of_tridiagonal(&diagonal, &beside);
        let beta = dot(&next, &next).sqrt();
        let settled = (found - largest).abs() <= 1e-5 * found && taken >= 8;
        largest = found;
        if settled || beta <= 1e-12 * found {
            return (Some(largest.sqrt()), taken);
        }
        beside.push(beta);
        next.iter_mut().flatten().for_each(|v| *v /= beta);
        before = std::mem::replace(&mut now, next);
    }
    (None, most)
}

/// Upper bound of the body's angular frequencies, rad/s: square root of the largest row sum of magnitudes of the
/// inverse mass times the stiffness (Gershgorin), with magnitudes taken element by element.
fn frequency_bound(model: &SolidModel, elements: &ElementTangents) -> f64 {
    let mut sums = vec![[0.0; 3]; model.mass.len()];
    for element in 0..model.problem.elements.len() {
        let nodes = model.problem.elements.nodes(element);
        for column in 0..3 * nodes.len() {
            if model.per_mass[nodes[column / 3] as usize][column % 3] == 0.0 {
                continue;
            }
            let unit = |n: usize, _| {
                let mut x = [0.0; 3];
                if n == column / 3 {
                    x[column % 3] = 1.0;
                }
                x
            };
            let Product { count, forces } = elements.product(element, unit);
            for n in 0..count {
                for i in 0..3 {
                    sums[nodes[n] as usize][i] += forces[n][i].abs();
                }
            }
        }
    }
    // `f64::max` would drop NaN.
    let larger = |most: f64, sum: f64| if most.is_nan() || sum <= most { most } else { sum };
    let rows = sums.iter().zip(&model.per_mass);
    let rows = rows.flat_map(|(sum, per_mass)| [0, 1, 2].map(|i: usize| sum[i] * per_mass[i]));
    rows.fold(f64::MIN_POSITIVE, larger).sqrt()
}

/// Largest eigenvalue of a symmetric tridiagonal matrix, by bisection on the signs of its pivots.
fn largest_of_tridiagonal(diagonal: &[f64], beside: &[f64]) -> f64 {
    let bound = |i: usize| {
        let left = if i > 0 { beside[i - 1].abs() } else { 0.0 };
        let right = beside.get(i).map_or(0.0, |b| b.abs());
        diagonal[i] + left + right
    };
    let mut high = (0..diagonal.len()).map(bound).fold(f64::MIN, f64::max);
    let mut low = diagonal.iter().copied().fold(f64::MIN, f64::max);
    let above_all = |x: f64| {
        let mut pivot = diagonal[0] - x;
        for i in 1..diagonal.len() {
            if pivot >= 0.0 {
                return false;
            }
            pivot = diagonal[i] - x - beside[i - 1] * beside[i - 1] / pivot;
        }
        pivot < 0.0
    };
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if above_all(middle) { high = middle } else { low = middle }
    }
    high
}
