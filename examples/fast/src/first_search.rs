//! First search for an equilibrium in single precision: each ball is one spring between the groove centres.

use crate::lanes::{Real, solve};
use crate::statics::{Common, Lanes, Pose, Problem, any, constrain, farthest, spread};

/// Components along the axis, the radius and the orbit of a ball.
#[inline(always)]
pub fn local<R: Real>(v: [R; 3], [c, s]: [R; 2]) -> [R; 3] {
    [v[0], v[1] * c + v[2] * s, v[2] * c - v[1] * s]
}

/// Centre of the inner groove in the meridian plane of a ball, to first order: axial and radial, and its radial
/// correction by the tilt.
#[inline(always)]
pub fn inner_centre<R: Real>(l: &Lanes<R>, pose: &Pose<R>, azimuth: [R; 2]) -> ([R; 2], R) {
    let [qx, qr, qt] = local(pose.centre, azimuth);
    let [_, nr, nt] = local(pose.axis, azimuth);
    let [xi, dr, _] = l.race[0];
    let along = xi - (l.pitch + dr) * nr + qt * nt;
    let lift = (along * along - xi * xi) / (l.pitch + l.pitch);
    ([qx + along, dr + qr - lift], along / l.pitch)
}

/// Position of each ball between the groove centres; for an unloaded ball with weight, on the race that carries it.
#[inline(always)]
pub fn settle<R: Real>(common: &Common, l: &Lanes<R>, pose: &Pose<R>, azimuth: [R; 2]) -> ([R; 2], R) {
    let (inner, _) = inner_centre(l, pose, azimuth);
    let [xo, dro, go] = l.race[1];
    let line = [inner[0] - xo, inner[1] - dro];
    let length = (line[0] * line[0] + line[1] * line[1]).root();
    let overlap = length - l.race[0][2] - go;
    let at = (go + overlap * overlap.positive(l.outer_share, R::splat(0.5))) / length;
    let mut place = [xo + line[0] * at, dro + line[1] * at];
    if common.body_forces {
        let force = [l.weight[0], local(l.weight, azimuth)[1] + l.spin * l.pitch];
        let size = (force[0] * force[0] + force[1] * force[1]).root() + R::splat(1e-30);
        let pressed = |side: usize| {
            let root = size / l.stiffness[side];
            let root = R::from_lanes(|lane| root.lane(lane).cbrt());
            l.race[side][2] + root * root
        };
        let on =
            [(inner, pressed(0)), ([xo, dro], pressed(1))].map(|(base, arm)| [0, 1].map(|i| base[i] + force[i] * arm / size));
        place = [0, 1].map(|i| overlap.positive(place[i], force[1].positive(on[1][i], on[0][i])));
    }
    (place, overlap)
}

/// First search: each ball is one spring between the groove centres.
pub fn coarse<R: Real>(common: &Common, problems: &[Problem]) -> [R; 5] {
    let l = Lanes::<R>::new(problems, common.free);
    let zero = R::zero();
    let series = spread::<R>(problems, |p| {
        let sum: f64 = p.hertz.iter().map(|h| h.stiffness.cbrt().powi(-2)).sum();
        1.0 / (sum * sum.sqrt())
    });
    // Extra overlap of every ball, reduced to zero: all balls carry load at first.
    let whole = spread::<R>(problems, |p| {
        let sum: f64 = p.hertz.iter().map(|h| h.stiffness.cbrt().powi(-2)).sum();
        let force: f64 =
            (0..5).filter(|i| common.free[*i]).map(|i| p.condition[i].abs() * if i < 3 { 1.0 } else { 1.0 / p.pitch }).sum();
        let deflection = (4.0 * force / common.ring.len() as f64).cbrt().powi(2) * sum;
        let ([xi, ri, gi], [xo, ro, go]) = (p.race[0], p.race[1]);
        deflection + (gi + go - (xi - xo).hypot(ri - ro)).max(0.0)
    });
    let mut extra = whole;
    let cap = l.pitch * R::splat(2e-3);
    let mut base: [R; 5] = std::array::from_fn(|i| spread(problems, |p| p.start[i]));
    let (mut energy, mut step, mut part) = (R::splat(1e30), [zero; 5], zero);
    for _ in 0..40 {
        let at: [R; 5] = std::array::from_fn(|i| base[i] + part * step[i]);
        let pose = Pose::new(common, &at);
        let mut sum = zero;
        let (mut gradient, mut matrix) = ([zero; 5], [[zero; 5]; 5]);
        for ring in &common.ring {
            let azimuth = l.azimuth(*ring);
            let (centre, slope) = inner_centre(&l, &pose, azimuth);
            let line = [centre[0] - l.race[1][0], centre[1] - l.race[1][1]];
            let length = (line[0] * line[0] + line[1] * line[1]).root();
            let overlap = (length - l.race[0][2] - l.race[1][2] + extra).largest(zero);
            let (ux, ur) = (line[0] / length, line[1] / length);
            let root = overlap.root();
            let load = series * overlap * root;
            sum = sum + load * overlap;
            let radius = -(l.pitch + l.race[0][1]);
            let [one, two] = pose.by_tilt.map(|by| radius * local(by, azimuth)[1]);
            let (along, across) = (ux - ur * slope, -ur - ux * slope);
            let j = [ux, ur * azimuth[0], ur * azimuth[1], along * one, along * two];
            let m = [-ur, ux * azimuth[0], ux * azimuth[1], across * one, across * two];
            let (rise, turn) = (series * R::splat(1.5) * root, load / length);
            for i in 0..5 {
                gradient[i] = gradient[i] + load * j[i];
                let (rj, tm) = (rise * j[i], turn * m[i]);
                for k in 0..=i {
                    matrix[i][k] = matrix[i][k] + rj * j[k] + tm * m[k];
                }
            }
        }
        let work = (0..5).fold(zero, |w, i| w + l.load[i] * at[i]);
        let stored = sum * R::splat(0.4);
        let allowed = R::splat(1e-4) * (stored + work.size());
        let worse = stored - work - energy - allowed;
        constrain(common, &l, &mut gradient, &mut matrix);
        let (newton, _) = solve(&matrix, &gradient, 1e-5);
        let long = farthest(&newton, l.pitch);
        let limit = (cap / (long + cap * R::splat(1e-6))).smallest(R::splat(1.0));
        // A lane that got worse goes back by a quarter; one that is near reduces the extra overlap.
        for i in 0..5 {
            base[i] = worse.positive(base[i], at[i]);
            step[i] = worse.positive(step[i], -(newton[i] * limit));
        }
        part = worse.positive(part * R::splat(0.25), R::splat(1.0));
        energy = worse.positive(energy, stored - work);
        let near = worse.positive(zero, extra * R::splat(0.5) - long).positive(R::splat(1.0), zero);
        let less = extra * R::splat(0.2);
        let less = (less - whole * R::splat(0.03)).positive(less, zero);
        energy = near.positive(R::splat(1e30), energy);
        extra = near.positive(less, extra);
        let open = extra.largest((long - whole * R::splat(1e-3)).largest(zero)).largest(worse.largest(zero));
        if !any(open) {
            break;
        }
    }
    std::array::from_fn(|i| base[i] + part * step[i])
}

