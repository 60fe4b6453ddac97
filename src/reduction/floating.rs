//! A free linear solid reduced to component modes in a floating frame: natural modes up to a frequency, and static
//! correction modes for patches of load and for the centrifugal force of a spin about X.
//!
//! The natural modes leave out the part of the static response that is beyond them. A correction mode is this part for
//! one patch, and the Rayleigh–Ritz method makes all of them orthogonal (residual attachment modes, MacNeal 1971, Rubin
//! 1975). All modes are orthogonal to the rigid motions. Masses are lumped, as in explicit steps.

use crate::ch5_cage::floating_frame::FloatingFrame;
use crate::kinematics::strain::{Sym3, full, green_lagrange};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};
use crate::reduction::component_modes::{Answer, combine, superposed, work};
use crate::solids::model::SolidModel;
use crate::solids::modes::{FreeFactor, ModeError, ModeOptions, Wanted, spread};
use crate::solids::stress::each_point;
use crate::solids::tangent::{MassMatrix, Unknowns};
use std::f64::consts::TAU;

/// Forces on nodes, N.
pub type Patch = Vec<(u32, Vec3)>;

/// A solid in component modes of a floating frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FloatingReduction {
    pub frame: FloatingFrame,
    /// Centre of mass in the mesh, m.
    pub centre: Vec3,
    /// Displacements of all nodes per unit of each mode.
    pub shapes: Vec<Vec<Vec3>>,
    /// Number of natural modes; the others are static correction modes.
    pub natural: usize,
    /// Lowest natural frequency that is left out, Hz; infinite if none is.
    pub first_left_out: f64,
}

impl FloatingReduction {
    /// Displacements of all nodes in axes of the frame for these amplitudes (m), m.
    pub fn displacement(&self, amplitudes: &[f64]) -> Vec<Vec3> {
        superposed(&self.shapes, amplitudes)
    }
}

/// Largest number of natural modes.
const MOST: usize = 200;
/// Residual of natural modes: their frequencies are accurate to its square.
const RESIDUAL: f64 = 1e-7;
/// Solves for a static response. Each reduces the error by the ratio of the shift to the square of the first frequency
/// that is left out, at most a third.
const SOLVES: usize = 16;

/// Rigid motions about `centre`, orthonormal under the mass.
fn rigid_motions(model: &SolidModel, centre: Vec3) -> Vec<Vec<Vec3>> {
    let mut motions: Vec<Vec<Vec3>> = Vec::with_capacity(6);
    for axis in 0..6 {
        let mut unit = [0.0; 3];
        unit[axis % 3] = 1.0;
        let at = |place: &Vec3| if axis < 3 { unit } else { cross(unit, sub(*place, centre)) };
        let mut motion: Vec<Vec3> = model.problem.nodes.iter().map(at).collect();
        remove(&mut motion, &motions, &model.mass);
        normalise(&mut motion, &model.mass);
        motions.push(motion);
    }
    motions
}

/// ∫ a·b dm.
fn product(a: &[Vec3], b: &[Vec3], mass: &[f64]) -> f64 {
    a.iter().zip(b).zip(mass).map(|((a, b), mass)| mass * dot(*a, *b)).sum()
}

/// Removes the components along `known`, orthonormal under the mass; twice, against rounding.
fn remove(shape: &mut [Vec3], known: &[Vec<Vec3>], mass: &[f64]) {
    for _ in 0..2 {
        for other in known {
            let share = product(shape, other, mass);
            for (to, from) in shape.iter_mut().zip(other) {
                *to = add_scaled(*to, -share, *from);
            }
        }
    }
}

fn normalise(shape: &mut [Vec3], mass: &[f64]) {
    let per = 1.0 / product(shape, shape, mass).sqrt();
    shape.iter_mut().for_each(|at| *at = scale(*at, per));
}

/// Reduces a free solid: natural modes up to `modes_to` (Hz) and correction modes for `patches`. With `modes_to` = 0
/// the solid is rigid.
///
/// # Errors
///
/// A mesh in parts without stiffness, too many modes, no memory.
pub fn reduce_floating(
    model: &SolidModel,
    modes_to: f64,
    patches: &[Patch],
) -> Result<FloatingReduction, ModeError> {
    let mass = &model.mass;
    let total: f64 = mass.iter().sum();
    let sum = |sum, (place, mass): (&Vec3, &f64)| add_scaled(sum, mass / total, *place);
    let centre = model.problem.nodes.iter().zip(mass).fold([0.0; 3], sum);
    let places: Vec<Vec3> = model.problem.nodes.iter().map(|at| sub(*at, centre)).collect();
    let mut reduction = FloatingReduction {
        frame: FloatingFrame {
            mass: total,
            inertia: second_moment(&places, &places, mass),
            damping: model.problem.damping,
            ..FloatingFrame::default()
        },
        centre,
        first_left_out: 0.0,
        ..FloatingReduction::default()
    };
    if modes_to == 0.0 {
        return Ok(reduction);
    }
    let unknowns = Unknowns::new(model);
    let free = FreeFactor::new(model, &unknowns, MassMatrix::Lumped)?;
    let wanted = Wanted::UpTo { frequency: modes_to, most: MOST + 6 };
    let options = ModeOptions { wanted, mass: MassMatrix::Lumped, tolerance: RESIDUAL };
    let mut modes = free.modes(model, &unknowns, &options)?.modes;
    reduction.first_left_out = match modes.last() {
        Some(mode) if mode.frequency > modes_to => modes.pop().map_or(0.0, |mode| mode.frequency),
        _ => f64::INFINITY,
    };
    // The rigid motions come first; the exact ones replace them.
    let mut known = rigid_motions(model, centre);
    let rigid = known.len();
    let mut frequencies = Vec::new();
    for mut mode in modes.into_iter().skip(rigid) {
        remove(&mut mode.shape, &known, mass);
        normalise(&mut mode.shape, mass);
        frequencies.push(TAU * mode.frequency);
        known.push(mode.shape);
    }
    reduction.natural = frequencies.len();
    let solver = Beyond { model, unknowns: &unknowns, free: &free, known: &known };
    // Forces of a unit squared speed about X: their response is a mode of its own, so that the solid grows exactly.
    let unit_spin: Patch = (0u32..)
        .zip(places.iter().zip(mass))
        .map(|(node, (at, mass))| (node, [0.0, mass * at[1], mass * at[2]]))
        .collect();
    let mut answers = vec![solver.answer(&unit_spin)];
    let mut stretched = answers[0].shape.clone();
    answers.extend(patches.iter().map(|patch| solver.answer(patch)));
    for (shape, frequency) in known[rigid..].iter().zip(&frequencies) {
        let share = work(&unit_spin, shape) / (frequency * frequency);
        for (to, from) in stretched.iter_mut().zip(shape) {
            *to = add_scaled(*to, share, *from);
        }
    }
    let mut shapes = known.split_off(rigid);
    for (frequency, mut shape) in combine(&answers, mass) {
        remove(&mut shape, &known, mass);
        remove(&mut shape, &shapes, mass);
        normalise(&mut shape, mass);
        frequencies.push(frequency);
        shapes.push(shape);
    }
    reduction.frame.frequencies = frequencies;
    couple(&mut reduction.frame, &places, mass, &shapes);
    stiffen(&mut reduction.frame, model, &shapes, &stretched);
    reduction.shapes = shapes;
    Ok(reduction)
}

/// Static responses beyond known modes.
struct Beyond<'s> {
    model: &'s SolidModel,
    unknowns: &'s Unknowns,
    free: &'s FreeFactor,
    known: &'s [Vec<Vec3>],
}

impl Beyond<'_> {
    /// Response to a patch less its part in the known modes, and the force that has it.
    fn answer(&self, patch: &Patch) -> Answer {
        let mass = &self.model.mass;
        let mut force = vec![[0.0; 3]; mass.len()];
        for (node, part) in patch {
            force[*node as usize] = add(force[*node as usize], *part);
        }
        for mode in self.known {
            let share = work(patch, mode);
            for ((to, at), mass) in force.iter_mut().zip(mode).zip(mass) {
                *to = add_scaled(*to, -share * mass, *at);
            }
        }
        // K x = f by (K + s M) x' = f + s M x.
        let mut shape = vec![[0.0; 3]; mass.len()];
        let mut right = vec![0.0; self.unknowns.count];
        for _ in 0..SOLVES {
            for ((of, force), (at, mass)) in
                self.unknowns.of.iter().zip(&force).zip(shape.iter().zip(mass))
            {
                for i in 0..3 {
                    right[of[i]] = force[i] - self.free.shift * mass * at[i];
                }
            }
            self.free.factor.solve(&mut right);
            shape = spread(self.unknowns, &right);
            remove(&mut shape, self.known, mass);
        }
        let forces = (0u32..).zip(force).collect();
        Answer { forces, shape }
    }
}

/// ∫ (a·b 1 − ½ (a bᵀ + b aᵀ)) dm.
fn second_moment(a: &[Vec3], b: &[Vec3], mass: &[f64]) -> Sym3 {
    let mut sum = [0.0; 6];
    for ((a, b), m) in a.iter().zip(b).zip(mass) {
        let trace = dot(*a, *b);
        let cross = |i: usize, j: usize| -0.5 * (a[i] * b[j] + a[j] * b[i]);
        for i in 0..3 {
            sum[i] += m * (trace + cross(i, i));
        }
        sum[3] += m * cross(0, 1);
        sum[4] += m * cross(1, 2);
        sum[5] += m * cross(2, 0);
    }
    sum
}

/// Fills the inertia of the modes.
fn couple(frame: &mut FloatingFrame, places: &[Vec3], mass: &[f64], shapes: &[Vec<Vec3>]) {
    let count = shapes.len();
    frame.slope = vec![0.0; 6 * count];
    frame.curvature = vec![0.0; 6 * count * count];
    frame.gyroscopic = vec![0.0; 3 * count * count];
    for (k, one) in shapes.iter().enumerate() {
        for (c, value) in second_moment(places, one, mass).into_iter().enumerate() {
            frame.slope[c * count + k] = 2.0 * value;
        }
        for (l, other) in shapes.iter().enumerate().skip(k) {
            for (c, value) in second_moment(one, other, mass).into_iter().enumerate() {
                frame.curvature[(c * count + k) * count + l] = value;
                frame.curvature[(c * count + l) * count + k] = value;
            }
            let mut turn = [0.0; 3];
            for ((a, b), m) in one.iter().zip(other).zip(mass) {
                turn = add_scaled(turn, *m, cross(*a, *b));
            }
            for (c, value) in turn.into_iter().enumerate() {
                frame.gyroscopic[(c * count + k) * count + l] = value;
                frame.gyroscopic[(c * count + l) * count + k] = -value;
            }
        }
    }
}

/// Adds the stiffening by spin about X, with the displacement under a unit squared speed.
fn stiffen(frame: &mut FloatingFrame, model: &SolidModel, shapes: &[Vec<Vec3>], unit: &[Vec3]) {
    let mut stresses = Vec::new();
    each_point(model, unit, |_, volume, h| {
        let stress = model.problem.material.second_piola_kirchhoff(&green_lagrange(h));
        stresses.push(full(&stress).map(|row| scale(row, volume)));
    });
    let gradients: Vec<Vec<[Vec3; 3]>> = shapes
        .iter()
        .map(|shape| {
            let mut all = Vec::with_capacity(stresses.len());
            each_point(model, shape, |_, _, h| all.push(*h));
            all
        })
        .collect();
    let count = shapes.len();
    for (l, of_l) in gradients.iter().enumerate() {
        let stressed: Vec<[Vec3; 3]> = of_l
            .iter()
            .zip(&stresses)
            .map(|(h, s)| h.map(|row| [0, 1, 2].map(|j: usize| dot(row, s[j]))))
            .collect();
        for (k, of_k) in gradients.iter().enumerate().take(l + 1) {
            let pairs = of_k.iter().zip(&stressed);
            let sum: f64 = pairs.map(|(h, s)| (0..3).map(|i| dot(h[i], s[i])).sum::<f64>()).sum();
            frame.curvature[k * count + l] -= sum;
            if k != l {
                frame.curvature[l * count + k] -= sum;
            }
        }
    }
}
