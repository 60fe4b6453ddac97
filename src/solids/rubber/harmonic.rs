//! Small vibrations of a solid of rubber about rest, at any number of frequencies with one factorisation.
//!
//! At small amplitude the stiffness of a body of one rubber is g D + V: D the deviatoric part of the network, V the
//! volumetric part, both real, and g(ω) the complex factor of the Maxwell elements. All derivatives of u(g), the
//! response to a unit motion of the supports, at one real g₀ follow from the same factors, each by one solve. The
//! stationary value of the energy over their span is the complex stiffness: its error is the square of the error of the
//! span, and falls by the same ratio with each vector.

use crate::ch2_housing::elastomer::maxwell::complex_factor;
use crate::elements::tet10::POINTS;
use crate::elements::tet10_nodal;
use crate::kinematics::strain::green_lagrange_change;
use crate::kinematics::vec3::{Vec3, add_scaled, dot};
use crate::solids::error::SolidError;
use crate::solids::model::corners;
use crate::solids::rubber::model::{Moment, RubberModel};
use crate::solids::rubber::tangent::{StepLaw, Tangent};
use crate::solids::tangent::PRESCRIBED;
use nalgebra::{Complex, DMatrix, DVector};

/// Stiffness against one motion of the supports, N/m for a unit motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexStiffness {
    /// In phase with the displacement.
    pub storage: f64,
    /// A quarter of a cycle ahead of the displacement.
    pub loss: f64,
    /// Relative change by the last vector; the next would change less. Zero if the first vector is exact.
    pub change: f64,
}

/// Largest number of vectors.
const MOST_VECTORS: usize = 40;

/// Response to the motion of the prescribed components at time `t`, at each of `pulsations` rad/s; zero is the relaxed
/// network, infinity a sudden motion. Vectors are added until none of the responses changes by more than `tolerance` of
/// itself, or until there is no further vector.
///
/// # Errors
///
/// A body that is free to move; no memory; a negative pulsation; responses that do not converge.
pub fn complex_stiffness(
    model: &RubberModel,
    t: f64,
    pulsations: &[f64],
    tolerance: f64,
) -> Result<Vec<ComplexStiffness>, SolidError> {
    let maxwell = &model.problem.material.maxwell;
    if let Some(bad) = pulsations.iter().find(|pulsation| !matches!(**pulsation, 0.0..)) {
        return Err(SolidError::Pulsation(*bad));
    }
    let factors: Vec<Complex<f64>> = pulsations
        .iter()
        .map(|pulsation| {
            let [storage, loss] = complex_factor(maxwell, *pulsation);
            Complex::new(storage, loss)
        })
        .collect();
    let sizes = factors.iter().map(|g| (g.re * g.re + g.im * g.im).sqrt());
    let [low, high] = sizes.fold([f64::INFINITY, 1.0], |[low, high], g| [low.min(g), high.max(g)]);
    let middle = (low.min(high) * high).sqrt();
    let mut space = Space::new(model, t, middle)?;
    let mut answers = space.answers(&factors);
    for _ in 0..MOST_VECTORS {
        if !space.grow() {
            return Ok(answers);
        }
        let better = space.answers(&factors);
        let mut settled = true;
        for (old, new) in answers.iter_mut().zip(better) {
            let size = (new.storage * new.storage + new.loss * new.loss).sqrt();
            let (a, b) = (new.storage - old.storage, new.loss - old.loss);
            let change = (a * a + b * b).sqrt() / size;
            settled &= change <= tolerance;
            *old = ComplexStiffness { change, ..new };
        }
        if settled {
            return Ok(answers);
        }
    }
    let change = answers.iter().map(|answer| answer.change).fold(0.0, f64::max);
    Err(SolidError::NotSettled { vectors: MOST_VECTORS, change, tolerance })
}

/// The motion and its derivatives by g, with the forces of both parts of the stiffness.
struct Space<'a> {
    model: &'a RubberModel,
    tangent: Tangent,
    middle: f64,
    /// The first vector moves the supports, the others do not; those are orthonormal under the stiffness at g₀.
    vectors: Vec<Vec<Vec3>>,
    shear: Vec<Vec<Vec3>>,
    volume: Vec<Vec<Vec3>>,
}

impl<'a> Space<'a> {
    fn new(model: &'a RubberModel, t: f64, middle: f64) -> Result<Space<'a>, SolidError> {
        let mut tangent = Tangent::new(model);
        let law = StepLaw { gain: middle - 1.0, carried: &[], inertia: 0.0 };
        let rest = vec![[0.0; 3]; model.problem.nodes.len()];
        let mut moved = rest.clone();
        model.prescribe(Moment::at(t), &mut moved);
        let mut right = vec![0.0; model.unknowns.count];
        tangent.refresh(model, &law, &rest, Some((&moved, &mut right))).map_err(
            |error| match error {
                SolidError::Factor(error) => model.at_rest(error),
                error => error,
            },
        )?;
        let mut space = Space {
            model,
            tangent,
            middle,
            vectors: Vec::new(),
            shear: Vec::new(),
            volume: Vec::new(),
        };
        space.tangent.solve(&mut right);
        scatter(model, &right, &mut moved);
        space.take(moved);
        Ok(space)
    }

    fn take(&mut self, vector: Vec<Vec3>) {
        let (shear, volume) = forces_at_rest(self.model, &vector);
        self.vectors.push(vector);
        self.shear.push(shear);
        self.volume.push(volume);
    }

    /// Adds the next derivative; returns whether it was new.
    fn grow(&mut self) -> bool {
        let Some(last) = self.shear.last() else { return false };
        let mut right = vec![0.0; self.model.unknowns.count];
        for (of, force) in self.model.unknowns.of.iter().zip(last) {
            for i in 0..3 {
                if of[i] != PRESCRIBED {
                    right[of[i]] = force[i];
                }
            }
        }
        self.tangent.solve(&mut right);
        let mut vector = vec![[0.0; 3]; last.len()];
        scatter(self.model, &right, &mut vector);
        let whole = |space: &Self, k: usize, with: &[Vec3]| {
            space.middle * times_sum(&space.shear[k], with) + times_sum(&space.volume[k], with)
        };
        let norm = |vector: &[Vec3]| {
            let (shear, volume) = forces_at_rest(self.model, vector);
            (self.middle * times_sum(&shear, vector) + times_sum(&volume, vector)).max(0.0).sqrt()
        };
        let before = norm(&vector);
        // Twice is enough.
        for _ in 0..2 {
            for k in 1..self.vectors.len() {
                let part = whole(self, k, &vector);
                for (v, u) in vector.iter_mut().zip(&self.vectors[k]) {
                    *v = add_scaled(*v, -part, *u);
                }
            }
        }
        let after = norm(&vector);
        let nothing_new = after <= 1e-12 * before;
        if nothing_new {
            return false;
        }
        vector.iter_mut().for_each(|v| *v = v.map(|x| x / after));
        self.take(vector);
        true
    }

    /// Stationary energies over the span.
    fn answers(&self, factors: &[Complex<f64>]) -> Vec<ComplexStiffness> {
        let count = self.vectors.len();
        let gram = |forces: &[Vec<Vec3>]| {
            DMatrix::from_fn(count, count, |i, j| {
                let (i, j) = (i.min(j), i.max(j));
                times_sum(&forces[i], &self.vectors[j])
            })
        };
        let (shear, volume) = (gram(&self.shear), gram(&self.volume));
        let answer = |g: &Complex<f64>| {
            let entry = |i: usize, j: usize| *g * shear[(i, j)] + volume[(i, j)];
            if count == 1 {
                return entry(0, 0);
            }
            let inner = DMatrix::from_fn(count - 1, count - 1, |i, j| entry(i + 1, j + 1));
            let coupled = DVector::from_fn(count - 1, |i, _| entry(i + 1, 0));
            // Real parts are positive definite, so that there is a solution.
            let along =
                inner.lu().solve(&coupled).unwrap_or_else(|| coupled.map(|_| f64::NAN.into()));
            let relieved: Complex<f64> = coupled.iter().zip(along.iter()).map(|(a, b)| a * b).sum();
            entry(0, 0) - relieved
        };
        let of = |k: Complex<f64>| ComplexStiffness { storage: k.re, loss: k.im, change: 0.0 };
        factors.iter().map(|g| of(answer(g))).collect()
    }
}

/// Σ a · b over all nodes.
fn times_sum(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| dot(*a, *b)).sum()
}

fn scatter(model: &RubberModel, unknowns: &[f64], displacement: &mut [Vec3]) {
    for (u, of) in displacement.iter_mut().zip(&model.unknowns.of) {
        for i in 0..3 {
            if of[i] != PRESCRIBED {
                u[i] = unknowns[of[i]];
            }
        }
    }
}

/// Forces for small displacements from rest, N, of the network's deviatoric part and of the volumetric part.
fn forces_at_rest(model: &RubberModel, displacement: &[Vec3]) -> (Vec<Vec3>, Vec<Vec3>) {
    let network = &model.problem.material.network;
    let double = 2.0 * network.shear_modulus();
    let mut shear = vec![[0.0; 3]; displacement.len()];
    let mut volume = shear.clone();
    let still = [[0.0; 3]; 10];
    let mut means = vec![0.0; model.patches.len()];
    for ((tet, nodes), patches) in
        model.tets.iter().zip(&model.problem.elements).zip(&model.patches_of)
    {
        let moved = corners(displacement, nodes);
        let mut of_shear = [[0.0; 3]; 10];
        let mut traces = [0.0; POINTS];
        for (point, trace) in tet.points.iter().zip(&mut traces) {
            let h = point.displacement_gradient(&moved);
            let e = green_lagrange_change(&[[0.0; 3]; 3], &h);
            *trace = e[0] + e[1] + e[2];
            let factor = double * point.volume;
            let third = *trace / 3.0;
            let d = [e[0] - third, e[1] - third, e[2] - third];
            for (n, g) in point.gradients.iter().enumerate() {
                let row = |a: f64, b: f64, c: f64| factor * (a * g[0] + b * g[1] + c * g[2]);
                let force = [row(d[0], e[3], e[5]), row(e[3], d[1], e[4]), row(e[5], e[4], d[2])];
                of_shear[n] = add_scaled(of_shear[n], 1.0, force);
            }
        }
        for (patch, sum) in patches.iter().zip(tet10_nodal::at_corners(tet, &traces)) {
            means[*patch as usize] += sum;
        }
        for (node, force) in nodes.iter().zip(of_shear) {
            shear[*node as usize] = add_scaled(shear[*node as usize], 1.0, force);
        }
    }
    for (mean, patch) in means.iter_mut().zip(&model.patches) {
        *mean = network.mean_stress(*mean / patch.volume);
    }
    for ((tet, nodes), patches) in
        model.tets.iter().zip(&model.problem.elements).zip(&model.patches_of)
    {
        let stresses = tet10_nodal::at_points(&patches.map(|patch| means[patch as usize]));
        let of = tet10_nodal::nodal_forces(tet, &still, &[[0.0; 6]; POINTS], &stresses);
        for (node, force) in nodes.iter().zip(of) {
            volume[*node as usize] = add_scaled(volume[*node as usize], -1.0, force);
        }
    }
    (shear, volume)
}
