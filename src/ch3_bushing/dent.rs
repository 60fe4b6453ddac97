//! Dent in a raceway (3.4.4): contact law F = K_H δ^n of (3.20), with an exponent that depends on the load, the dent's
//! shape and the ball's position over it.
//!
//! The dissertation prints no formula for the exponent. Here it is derived from frictionless contact of a ball on a
//! dented race. This contact stores an energy U that depends on the approach δ and on the position of the contact
//! relative to the dent's centre, s along the rolling direction and y across the groove. All its forces are derivatives
//! of U. Write U = (2/5) K_H w^{5/2} with w = δ − Δ(δ, s, y), the approach at which the undented contact stores the
//! same energy. Then
//!
//! F = K_H w^{3/2} ∂w/∂δ,  and  n = 3/2 + ln(F/(K_H δ^{3/2}))/ln(δ/1 m),
//!
//! so that (3.20) holds in SI units with a reference length of 1 m. Far from the dent Δ = 0 and n = 3/2. A table of Δ
//! is computed once with a half-space model (`members::dent_table`) from the dent and both relative radii of the
//! contact.

use std::f64::consts::{PI, TAU};

/// Shape of a dent, m: a pit of the given diameter, surrounded by a raised shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DentShape {
    pub diameter: f64,
    pub depth: f64,
    pub shoulder_height: f64,
    pub shoulder_width: f64,
}

impl DentShape {
    /// Depth below the undented surface at distance `r` (m) from the centre, m; negative on the shoulder. Half a cosine
    /// wave in the pit and a full one on the shoulder, with zero slope at the joint.
    pub fn depth_at(&self, r: f64) -> f64 {
        let radius = 0.5 * self.diameter;
        if r < radius {
            return 0.5 * self.depth * (1.0 + libm::cos(PI * r / radius));
        }
        let beyond = r - radius;
        if beyond < self.shoulder_width {
            let wave = 1.0 - libm::cos(TAU * beyond / self.shoulder_width);
            return -0.5 * self.shoulder_height * wave;
        }
        0.0
    }

    /// Radius of the dented area including the shoulder, m.
    pub fn reach(&self) -> f64 {
        let shoulder = if self.shoulder_height > 0.0 { self.shoulder_width } else { 0.0 };
        0.5 * self.diameter + shoulder
    }

    /// Returns whether the dent has neither depth nor shoulder.
    pub fn vanishes(&self) -> bool {
        self.depth == 0.0 && self.shoulder_height == 0.0
    }
}

/// A dent on one race of a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dent {
    pub shape: DentShape,
    /// Dented race: 0 inner, 1 outer.
    pub side: usize,
    /// Angle around the race from its own Y towards its own Z, rad; rotates with the race.
    pub angle: f64,
    /// Angle around the groove from its bottom towards the race's X, rad.
    pub groove_angle: f64,
}

/// Lost approach Δ and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lost {
    /// Δ, m: the approach lost to the dent.
    pub value: f64,
    /// Derivatives of Δ by the approach, along the rolling direction and across the groove, dimensionless.
    pub by_approach: f64,
    pub along: f64,
    pub across: f64,
}

/// Number of directions of a table, from the rolling direction to that across the groove.
pub const DIRECTIONS: usize = 7;

/// Squared sine of a direction's angle in the ellipse of [`DentTable`]: equal angles.
pub fn squared_sine(direction: usize) -> f64 {
    0.5 - 0.5 * libm::cos(PI * direction as f64 / (DIRECTIONS - 1) as f64)
}

/// Table of Δ over q = √(δ + shoulder) and a normalised distance σ in [0, 1] in some directions: cubic splines on a
/// uniform grid.
///
/// σ² = (s/l_s)² + (y/l_y)² with l = reach + √(2R) q; at σ = 1 the dent leaves the overlap of the ball at that
/// approach. Δ is even in s and y: between the directions it is the polynomial of the squared sine of the angle in that
/// ellipse which has their values, that is, a sum of cosines of multiples of twice the angle.
#[derive(Clone, Debug, PartialEq)]
pub struct DentTable {
    /// m.
    pub shoulder: f64,
    pub reach: f64,
    /// √(2R) of the relative radii, m^0.5: rolling direction, across the groove.
    pub spread: [f64; 2],
    /// Largest q, m^0.5; Δ is constant beyond it.
    pub deepest: f64,
    /// Intervals in q and σ.
    pub intervals: [usize; 2],
    /// Coefficients of the splines, rows of equal q.
    pub coefficients: [Vec<f64>; DIRECTIONS],
    /// Squared sine of each direction, and the factor of its polynomial.
    pub directions: [[f64; 2]; DIRECTIONS],
}

/// Squared sines, and the factors by which each direction's polynomial is one there.
pub fn directions() -> [[f64; 2]; DIRECTIONS] {
    let sines: [f64; DIRECTIONS] = std::array::from_fn(squared_sine);
    std::array::from_fn(|k| {
        let others = (0..DIRECTIONS).filter(|j| *j != k);
        [sines[k], 1.0 / others.map(|j| sines[k] - sines[j]).product::<f64>()]
    })
}

/// Values and slopes of the four nonzero cubic B-splines at the fraction `u` of an interval.
#[inline]
fn basis(u: f64) -> ([f64; 4], [f64; 4]) {
    let v = 1.0 - u;
    let value = [
        v * v * v / 6.0,
        (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0,
        (4.0 - 6.0 * v * v + 3.0 * v * v * v) / 6.0,
        u * u * u / 6.0,
    ];
    let slope = [-0.5 * v * v, u * (1.5 * u - 2.0), v * (2.0 - 1.5 * v), 0.5 * u * u];
    (value, slope)
}

/// Interval that contains `at` (in intervals) and the fraction within it.
#[inline]
fn interval(at: f64, count: usize) -> (usize, f64) {
    let index = (at as usize).min(count - 1);
    (index, at - index as f64)
}

impl DentTable {
    /// Δ and its derivatives at an approach δ (m) and a position s, y relative to the dent's centre (m); `None` if the
    /// contact does not reach the dent.
    #[inline]
    pub fn lost(&self, approach: f64, [s, y]: [f64; 2]) -> Option<Lost> {
        let square = approach + self.shoulder;
        // NaN passes through, so that it is caught.
        if square <= 0.0 {
            return None;
        }
        let q = square.sqrt();
        let lengths = self.spread.map(|spread| self.reach + spread * q);
        let (x, z) = (s / lengths[0], y / lengths[1]);
        let distance = x * x + z * z;
        if distance >= 1.0 {
            return None;
        }
        let sigma = distance.sqrt();
        let [rows, columns] = self.intervals;
        let stays = q >= self.deepest;
        let (row, u) = interval(q.min(self.deepest) / self.deepest * rows as f64, rows);
        let (column, v) = interval(sigma * columns as f64, columns);
        let (by_row, row_slope) = basis(u);
        let (by_column, column_slope) = basis(v);
        let row_scale = if stays { 0.0 } else { rows as f64 / self.deepest };
        // Value, slope by q and slope by σ for both directions.
        let of = |coefficients: &[f64]| {
            let mut sum = [0.0; 3];
            for k in 0..4 {
                let at = (row + k) * (columns + 3) + column;
                let (mut value, mut slope) = (0.0, 0.0);
                for l in 0..4 {
                    value += by_column[l] * coefficients[at + l];
                    slope += column_slope[l] * coefficients[at + l];
                }
                sum[0] += by_row[k] * value;
                sum[1] += row_slope[k] * value;
                sum[2] += by_row[k] * slope;
            }
            [sum[0], sum[1] * row_scale, sum[2] * columns as f64]
        };
        // At the centre all directions have the same Δ.
        let (part, per_square) =
            if distance > 0.0 { (z * z / distance, 1.0 / distance) } else { (0.0, 0.0) };
        let (mut mixed, mut differ) = ([0.0; 3], 0.0);
        for (k, coefficients) in self.coefficients.iter().enumerate() {
            // Weight of the direction, and its slope by the squared sine.
            let (mut weight, mut slope) = (self.directions[k][1], 0.0);
            for (_, [sine, _]) in self.directions.iter().enumerate().filter(|(j, _)| *j != k) {
                slope = slope * (part - sine) + weight;
                weight *= part - sine;
            }
            let own = of(coefficients);
            mixed.iter_mut().zip(own).for_each(|(mixed, own)| *mixed += weight * own);
            differ += slope * own[0];
        }
        let [value, slope_by_q, slope_by_sigma] = mixed;
        // Derivatives by x and z, through σ and through the weights.
        let per_sigma = if sigma > 0.0 { slope_by_sigma / sigma } else { 0.0 };
        let turn = 2.0 * differ * part * per_square;
        let by_x = x * (per_sigma - turn);
        let by_z = z * (per_sigma - turn) + 2.0 * differ * z * per_square;
        let by_q = slope_by_q
            - by_x * x * self.spread[0] / lengths[0]
            - by_z * z * self.spread[1] / lengths[1];
        Some(Lost {
            value,
            by_approach: 0.5 * by_q / q,
            along: by_x / lengths[0],
            across: by_z / lengths[1],
        })
    }

    /// Exponent n of (3.20) at an approach δ > 0 and a position (m), with lengths in metres; infinite without contact.
    #[doc(alias = "3.20")]
    pub fn exponent(&self, approach: f64, place: [f64; 2]) -> f64 {
        let share = self.lost(approach, place).map_or(1.0, |lost| {
            let w = approach - lost.value;
            let ratio = if w > 0.0 { w / approach } else { 0.0 };
            ratio * ratio.sqrt() * (1.0 - lost.by_approach)
        });
        1.5 + libm::log(share) / libm::log(approach)
    }
}

/// Load F = K_H δ^n of (3.20) at an approach δ with the exponent n, N.
#[doc(alias = "3.20")]
pub fn dented_load(stiffness: f64, approach: f64, exponent: f64) -> f64 {
    stiffness * libm::pow(approach, exponent)
}

/// Coefficients of a cubic spline through equally spaced values, two more than there are values. Zero slope at the end;
/// at the beginning zero slope if `flat_beginning`, otherwise zero curvature.
pub fn spline(values: &[f64], flat_beginning: bool) -> Vec<f64> {
    let count = values.len();
    // c₋₁ + 4c₀ + c₁ = 6f₀ and so on, c₋₁ = c₁ or c₋₁ = 2c₀ − c₁; cₙ₊₁ = cₙ₋₁.
    let (mut upper, mut c) = (vec![0.0; count], vec![0.0; count]);
    let first = if flat_beginning { [4.0, 2.0] } else { [6.0, 0.0] };
    upper[0] = first[1] / first[0];
    c[0] = 6.0 * values[0] / first[0];
    for i in 1..count {
        let lower = if i + 1 == count { 2.0 } else { 1.0 };
        let pivot = 4.0 - lower * upper[i - 1];
        upper[i] = 1.0 / pivot;
        c[i] = (6.0 * values[i] - lower * c[i - 1]) / pivot;
    }
    for i in (0..count - 1).rev() {
        c[i] -= upper[i] * c[i + 1];
    }
    let before = if flat_beginning { c[1] } else { 2.0 * c[0] - c[1] };
    let after = c[count - 2];
    [before].into_iter().chain(c).chain([after]).collect()
}
