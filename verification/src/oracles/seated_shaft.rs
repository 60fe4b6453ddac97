//! A rigid shaft on bearings whose outer races sit in the bores of elastic bodies of their own, in equilibrium.
//!
//! All axes are parallel, X along the shaft; places in a bore count from its own race's nominal centre. For a place of
//! an outer race the nodes of its bore are where the forces on them put them (Newton's method on all three displacements of each,
//! with the exact derivatives of [`super::seated`]); what is left over of shaft and races goes to nothing by Newton's
//! method on their coordinates together, slopes of the bearings by differences. Distances to first order.

use nalgebra::{DMatrix, DVector, Matrix4, Vector4};

use super::seated::{Seat, passed_on};
use super::statics::{Coordinates, OracleBearing};

type Vec3 = [f64; 3];

/// A bearing on the shaft and its seat.
pub struct End<'a> {
    pub bearing: OracleBearing,
    pub seat: Seat<'a>,
    /// Of the bearing from the shaft's centre, m.
    pub along: f64,
}

/// Where everything came to stand.
#[derive(Clone, Debug)]
pub struct ShaftInBores {
    pub shaft: Coordinates,
    /// y, z (m), ξ, λ (rad) of each outer race.
    pub outer: Vec<[f64; 4]>,
    /// What each race puts on its bore along these.
    pub loads: Vec<[f64; 4]>,
    /// On each bore's nodes, N.
    pub forces: Vec<Vec<Vec3>>,
    /// Largest force (moments over the race's radius) that is unbalanced, N.
    pub unbalanced: f64,
    pub iterations: usize,
}

/// A race at a place in its bore.
struct Held {
    load: Vector4<f64>,
    stiffness: Matrix4<f64>,
    forces: Vec<Vec3>,
}

/// The nodes of a bore around a race at `place`, looked for from `moved`, where they then are.
fn held(seat: &Seat, place: &[f64; 4], moved: &mut DVector<f64>) -> Held {
    let count = 3 * seat.nodes.len();
    let mut unknowns = DVector::zeros(count + 4);
    let mut last = f64::INFINITY;
    for _ in 0..60 {
        unknowns.rows_mut(0, count).copy_from(moved);
        (0..4).for_each(|i| unknowns[count + i] = place[i]);
        let (slope, curvature) = seat.contact(&unknowns);
        let gap = &*moved + seat.compliance * slope.rows(0, count);
        let mut matrix = seat.compliance * curvature.view((0, 0), (count, count));
        (0..count).for_each(|i| matrix[(i, i)] += 1.0);
        // What moves nodes besides: the race.
        let mut right = DMatrix::zeros(count, 5);
        right.column_mut(0).copy_from(&-&gap);
        let by_race = seat.compliance * curvature.view((0, count), (count, 4));
        right.columns_mut(1, 4).copy_from(&-by_race);
        let Some(step) = matrix.lu().solve(&right) else { break };
        let size = gap.amax();
        if size <= 1e-18 || (size <= 1e-13 && size >= 0.3 * last) {
            let own = curvature.view((count, count), (4, 4)).into_owned();
            let through = curvature.view((count, 0), (4, count)) * step.columns(1, 4);
            let stiffness = Matrix4::from_fn(|i, j| own[(i, j)] + through[(i, j)]);
            let load = Vector4::from_fn(|i, _| slope[count + i]);
            let force = |n: usize| std::array::from_fn(|i| -slope[3 * n + i]);
            return Held { load, stiffness, forces: (0..count / 3).map(force).collect() };
        }
        last = size;
        *moved += step.column(0);
    }
    let nothing = Vector4::repeat(f64::NAN);
    Held { load: nothing, stiffness: Matrix4::repeat(f64::NAN), forces: Vec::new() }
}

/// Loads that hold the shaft against the bearings, and what these put on the outer races (y, z, about Y and Z).
fn pulls(ends: &[End], at: &DVector<f64>) -> DVector<f64> {
    let mut loads = DVector::zeros(at.len());
    let ((sx, cx), (sl, cl)) = (at[3].sin_cos(), at[4].sin_cos());
    let axis = [cl * cx, sl, -cl * sx];
    let by = [[-cl * sx, 0.0, -cl * cx], [-sl * cx, cl, sl * sx]];
    for (k, end) in ends.iter().enumerate() {
        let first = 5 + 4 * k;
        let [y, z, xi, lambda] = [0, 1, 2, 3].map(|i| at[first + i]);
        let ((so, co), (sn, cn)) = (xi.sin_cos(), lambda.sin_cos());
        let mut bearing = end.bearing.clone();
        // Counted from the bearing's own nominal centre.
        bearing.outer_position = [0.0, y, z];
        bearing.outer_rotation = [[co * cn, -co * sn, so], [sn, cn, 0.0], [-so * cn, so * sn, co]];
        let off = [axis[0] - 1.0, axis[1], axis[2]];
        let place = [0, 1, 2].map(|i| at[i] + end.along * off[i]);
        let race = [place[0], place[1], place[2], at[3], at[4]];
        let (_, own, _) = bearing.evaluate(&race);
        for i in 0..5 {
            loads[i] += own[i];
        }
        for (tilt, by) in by.iter().enumerate() {
            loads[3 + tilt] += (0..3).map(|i| end.along * by[i] * own[i]).sum::<f64>();
        }
        let whole = passed_on(&race, &own, [0.0, y, z]);
        for (i, part) in [1, 2, 4, 5].into_iter().enumerate() {
            loads[first + i] = whole[part];
        }
    }
    loads
}

/// Equilibrium under `applied` loads on the shaft from `start`, coordinates of shaft and outer races at which these touch.
pub fn equilibrium(
    ends: &[End],
    applied: &Coordinates,
    start: (Coordinates, &[[f64; 4]]),
) -> ShaftInBores {
    let count = 5 + 4 * ends.len();
    let radius = |i: usize| ends[(i.max(5) - 5) / 4].seat.radius;
    // Lengths per unit of each coordinate, forces by unit of each load.
    let size = DVector::from_fn(count, |i, _| {
        let turns = if i < 5 { i > 2 } else { (i - 5) % 4 > 1 };
        if turns { radius(i) } else { 1.0 }
    });
    let mut at = DVector::zeros(count);
    (0..5).for_each(|i| at[i] = start.0[i]);
    for (k, race) in start.1.iter().enumerate() {
        (0..4).for_each(|i| at[5 + 4 * k + i] = race[i]);
    }
    let mut moved: Vec<DVector<f64>> =
        ends.iter().map(|end| DVector::zeros(3 * end.seat.nodes.len())).collect();
    let place = |at: &DVector<f64>, k: usize| std::array::from_fn(|i| at[5 + 4 * k + i]);
    let (mut iterations, mut last) = (0, f64::INFINITY);
    loop {
        let pull = pulls(ends, &at);
        let bores: Vec<Held> =
            (0..ends.len()).map(|k| held(&ends[k].seat, &place(&at, k), &mut moved[k])).collect();
        let mut left = DVector::from_fn(count, |i, _| {
            if i < 5 {
                applied[i] - pull[i]
            } else {
                pull[i] - bores[(i - 5) / 4].load[(i - 5) % 4]
            }
        });
        left.component_div_assign(&size);
        let unbalanced = left.amax();
        let most = applied.iter().fold(1.0, |most: f64, load| most.max(load.abs()));
        let settled = unbalanced <= 1e-5 * most && unbalanced >= 0.3 * last;
        if settled || iterations >= 60 || unbalanced.is_nan() {
            return ShaftInBores {
                shaft: std::array::from_fn(|i| at[i]),
                outer: (0..ends.len()).map(|k| place(&at, k)).collect(),
                loads: bores.iter().map(|bore| bore.load.into()).collect(),
                forces: bores.into_iter().map(|bore| bore.forces).collect(),
                unbalanced,
                iterations,
            };
        }
        last = unbalanced;
        iterations += 1;
        let mut matrix = DMatrix::zeros(count, count);
        for j in 0..count {
            let step = 1e-9 / size[j];
            let aside = |by: f64| {
                let mut at = at.clone();
                at[j] += by;
                pulls(ends, &at)
            };
            let slope = (aside(step) - aside(-step)) / (2.0 * step);
            for i in 0..count {
                let mut by = if i < 5 { slope[i] } else { -slope[i] };
                if i >= 5 && j >= 5 && (i - 5) / 4 == (j - 5) / 4 {
                    by += bores[(i - 5) / 4].stiffness[((i - 5) % 4, (j - 5) % 4)];
                }
                matrix[(i, j)] = by / (size[i] * size[j]);
            }
        }
        let Some(mut step) = matrix.lu().solve(&left) else {
            iterations = 60;
            continue;
        };
        step.component_div_assign(&size);
        at += step;
    }
}
