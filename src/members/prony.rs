//! Equivalent springs of a bonded bushing: six springs with parallel Maxwell elements.
//!
//! At small amplitude K(ω) of a bushing is no multiple of the rubber's own factor, since its volume does not relax. It
//! still is a relaxed stiffness and a sum of k iωτ/(1 + iωτ) with k ≥ 0: the k are fitted on a grid of τ by least
//! squares of the error over |K|, none of them negative. Confined rubber relaxes more slowly than free rubber: the
//! poles are where the shear modulus μ(s) is −λB with λ ≥ 0, for one Maxwell element at times from τ to τ(1 + γ).

use crate::ch2_housing::elastomer::Elastomer;
use crate::members::connection::{MaxwellElement, SpringDashpot};
use crate::mesh::TetMesh;
use crate::mesh::generate::Part;
use crate::solids::error::SolidError;
use crate::solids::rubber::harmonic::ComplexStiffness;
use crate::solids::rubber::sleeve::{SleeveMotion, sleeve_stiffness};
use nalgebra::{Complex, DMatrix, DVector};

/// A bushing reduced to a connection about its middle, axis X.
#[derive(Clone, Debug, PartialEq)]
pub struct BushingSpring {
    pub law: SpringDashpot,
    /// Largest error of K over |K| of each of [`SleeveMotion::ALL`], at pulsations between the fitted ones.
    pub misses: [f64; 4],
}

/// Relaxation times tried, and pulsations fitted, in a decade.
const PER_DECADE: f64 = 8.0;
/// Tolerance of the bushing's responses.
const SETTLED: f64 = 1e-8;

/// The equivalent spring of a bushing of a rubber, from `fastest` rad/s down to rest. The mesh is as in
/// [`sleeve_stiffness`].
///
/// # Errors
///
/// Those of [`sleeve_stiffness`]; a pulsation that is not positive and finite.
pub fn bushing_spring(
    mesh: &TetMesh,
    part: Part,
    material: &Elastomer,
    fastest: f64,
) -> Result<BushingSpring, SolidError> {
    let in_range = fastest > 0.0 && fastest.is_finite();
    if !in_range {
        return Err(SolidError::Option { what: "fastest pulsation", value: fastest });
    }
    let gain: f64 = material.maxwell.iter().map(|term| term.gamma).sum();
    let slowest_term = material.maxwell.iter().map(|term| term.tau).fold(0.0, f64::max);
    let longest = slowest_term * (1.0 + gain);
    let slowest = if longest > 0.0 { (0.1 / longest).min(fastest) } else { fastest };
    // Fitted at every other one, judged at those between.
    let pulsations = spread(slowest, fastest, 2.0 * PER_DECADE);
    // Relaxation faster than any vibration of interest acts as a dashpot.
    let mut times = spread(0.03 / fastest, longest.max(0.03 / fastest), PER_DECADE);
    // The rubber's own times are those of torsion, which changes no volume.
    let shortest = times[0];
    times.extend(material.maxwell.iter().map(|term| term.tau).filter(|tau| *tau > shortest));
    times.sort_by(f64::total_cmp);
    times.dedup();
    let asked: Vec<f64> = std::iter::once(0.0).chain(pulsations.iter().copied()).collect();
    let element = |time: &f64| MaxwellElement { stiffness: [0.0; 6], relaxation_time: *time };
    let maxwell = times.iter().map(element).collect();
    let mut law = SpringDashpot { maxwell, ..SpringDashpot::default() };
    let mut misses = [0.0; 4];
    for (motion, miss) in SleeveMotion::ALL.into_iter().zip(&mut misses) {
        let answers = sleeve_stiffness(mesh, part, material.clone(), motion, &asked, SETTLED)?;
        let (relaxed, answers) = (answers[0].storage, &answers[1..]);
        let fit = fitted(&times, relaxed, &pulsations, answers);
        *miss = largest_miss(&times, relaxed, &fit, &pulsations, answers);
        for &component in components(motion) {
            law.stiffness[component] = relaxed;
            for (element, stiffness) in law.maxwell.iter_mut().zip(&fit) {
                element.stiffness[component] = *stiffness;
            }
        }
    }
    law.maxwell.retain(|element| element.stiffness != [0.0; 6]);
    Ok(BushingSpring { law, misses })
}

/// Coordinates of a connection for a motion of the sleeve.
fn components(motion: SleeveMotion) -> &'static [usize] {
    match motion {
        SleeveMotion::Axial => &[0],
        SleeveMotion::Radial => &[1, 2],
        SleeveMotion::Torsional => &[3],
        SleeveMotion::Conical => &[4, 5],
    }
}

/// Logarithmic grid from `low` to `high`, with both ends.
fn spread(low: f64, high: f64, per_decade: f64) -> Vec<f64> {
    let decades = libm::log10(high / low);
    let steps = (decades * per_decade).ceil().max(1.0);
    (0..=steps as usize).map(|k| low * libm::pow(10.0, decades * k as f64 / steps)).collect()
}

/// iωτ/(1 + iωτ).
fn element(time: f64, pulsation: f64) -> Complex<f64> {
    let turned = Complex::new(0.0, time * pulsation);
    turned / (turned + 1.0)
}

/// Stiffness of each element, none negative.
fn fitted(
    times: &[f64],
    relaxed: f64,
    pulsations: &[f64],
    answers: &[ComplexStiffness],
) -> Vec<f64> {
    let picked: Vec<_> = pulsations.iter().zip(answers).step_by(2).collect();
    let mut matrix = DMatrix::zeros(2 * picked.len(), times.len());
    let mut right = DVector::zeros(2 * picked.len());
    for (row, (pulsation, answer)) in picked.into_iter().enumerate() {
        let size = (answer.storage * answer.storage + answer.loss * answer.loss).sqrt();
        for (column, time) in times.iter().enumerate() {
            let one = element(*time, *pulsation) * (relaxed / size);
            (matrix[(2 * row, column)], matrix[(2 * row + 1, column)]) = (one.re, one.im);
        }
        right[2 * row] = (answer.storage - relaxed) / size;
        right[2 * row + 1] = answer.loss / size;
    }
    nonnegative(&matrix, &right).iter().map(|share| share * relaxed).collect()
}

fn largest_miss(
    times: &[f64],
    relaxed: f64,
    fit: &[f64],
    pulsations: &[f64],
    answers: &[ComplexStiffness],
) -> f64 {
    let miss = |(pulsation, answer): (&f64, &ComplexStiffness)| {
        let exact = Complex::new(answer.storage, answer.loss);
        let parts = times.iter().zip(fit).map(|(time, k)| element(*time, *pulsation) * *k);
        (parts.sum::<Complex<f64>>() + relaxed - exact).norm() / exact.norm()
    };
    // NaN is kept.
    let larger = |most: f64, here: f64| if here <= most { most } else { here };
    pulsations.iter().zip(answers).skip(1).step_by(2).map(miss).fold(0.0, larger)
}

/// The x ≥ 0 with the least |A x − b| (Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23).
pub fn nonnegative(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let count = a.ncols();
    let mut x = DVector::zeros(count);
    let mut free: Vec<usize> = Vec::new();
    // Gradients below rounding are zero.
    let small = 1e-12 * a.norm() * b.norm();
    // Each set of free components occurs once; far fewer do.
    for _ in 0..10 * count {
        let slope = a.transpose() * (b - a * &x);
        let held = (0..count).filter(|j| !free.contains(j));
        let Some(next) = held.max_by(|j, k| slope[*j].total_cmp(&slope[*k])) else { break };
        if slope[next] <= small {
            break;
        }
        free.push(next);
        loop {
            let columns = a.select_columns(&free);
            let Ok(best) = columns.svd(true, true).solve(b, 1e-14) else { return x };
            // Fraction of the step to the optimum at which a component becomes zero.
            let way = |(&j, best): (&usize, &f64)| {
                if *best > 0.0 { None } else { Some((x[j] / (x[j] - best), j)) }
            };
            let stop = free.iter().zip(&best).filter_map(way).min_by(|a, b| a.0.total_cmp(&b.0));
            let part = stop.map_or(1.0, |(part, _)| part);
            for (&j, best) in free.iter().zip(&best) {
                x[j] += part * (best - x[j]);
            }
            let Some((_, left)) = stop else { break };
            x[left] = 0.0;
            free.retain(|j| *j != left);
            if left == next && part == 0.0 {
                // It became free by rounding alone.
                return x;
            }
        }
    }
    x
}
