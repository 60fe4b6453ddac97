//! Equilibria of many scenes, one in each vector lane.
//!
//! A first search in single precision takes each ball as two springs in series on the line between the groove centres.
//! Newton's method in double precision over race and balls finishes it with exact derivatives. Ball unknowns are
//! eliminated at each step.

use crate::first_search::{coarse, local, settle};
use crate::lanes::{Real, cross, dot, solve};
use crate::scene::{Hertz, Scene};
use std::f64::consts::TAU;
use wide::{f32x8, f64x4};

/// Data that all scenes of a batch share.
pub struct Common {
    /// Cosine and sine of the angle from ball 1 to each ball.
    pub ring: Vec<[f64; 2]>,
    pub free: [bool; 5],
    /// Axes of the outer race as columns, and its centre in m.
    pub frame: [[f64; 3]; 3],
    pub centre: [f64; 3],
    /// The outer race is at the origin without tilt.
    pub plain: bool,
    /// Last Newton step as a fraction of the pitch radius.
    pub tolerance: f64,
    /// Balls carry weight or centrifugal force.
    pub body_forces: bool,
}

/// Numbers of one scene: geometry relative to the pitch radius, contacts, forces.
#[derive(Clone, Copy)]
pub struct Problem {
    pub pitch: f64,
    /// Groove centre, axial and radial from the pitch circle, and groove radius minus ball radius, m: inner, outer.
    pub race: [[f64; 3]; 2],
    pub hertz: [Hertz; 2],
    /// Cosine and sine of the azimuth of ball 1.
    pub phase: [f64; 2],
    pub condition: [f64; 5],
    pub start: [f64; 5],
    /// Ball mass times the square of the orbital speed, N/m.
    pub spin: f64,
    /// Weight of a ball in the axes of the outer race, N.
    pub weight: [f64; 3],
}

/// Equilibrium of one scene.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    pub position: [f64; 5],
    pub loads: [f64; 5],
    pub stiffness: [[f64; 5]; 5],
    /// Axial and radial position of each ball from the pitch circle in the frame of the outer race, m.
    pub balls: Vec<[f64; 2]>,
    /// Normal load of each ball on the inner and the outer race, N.
    pub ball_loads: Vec<[f64; 2]>,
    pub converged: bool,
    /// False for a position that the loads do not determine.
    pub determinate: bool,
}

/// Axes of a race with these tilts, as columns.
pub fn axes([_, _, _, xi, lambda]: [f64; 5]) -> [[f64; 3]; 3] {
    let ((sy, cy), (sz, cz)) = (xi.sin_cos(), lambda.sin_cos());
    [[cy * cz, sz, -sy * cz], [-cy * sz, cz, sy * sz], [sy, 0.0, cy]]
}

impl Common {
    pub fn new(scene: &Scene, tolerance: f64) -> Common {
        let ring = (0..scene.count).map(|ball| (TAU * ball as f64 / scene.count as f64).sin_cos());
        Common {
            ring: ring.map(|(sin, cos)| [cos, sin]).collect(),
            free: scene.free,
            frame: axes(scene.outer_at),
            centre: [scene.outer_at[0], scene.outer_at[1], scene.outer_at[2]],
            tolerance,
            plain: scene.outer_at == [0.0; 5],
            body_forces: scene.gravity != [0.0; 3] || scene.centrifugal,
        }
    }
}

impl Problem {
    pub fn new(scene: &Scene, common: &Common) -> Problem {
        let place = |race: &crate::scene::Race| [race.axial, race.radial - scene.pitch, race.groove - scene.ball_radius];
        let (sin, cos) = scene.phase.sin_cos();
        let start = std::array::from_fn(|i| if scene.free[i] { scene.outer_at[i] } else { scene.condition[i] });
        Problem {
            pitch: scene.pitch,
            race: [place(&scene.inner), place(&scene.outer)],
            hertz: scene.hertz(),
            phase: [cos, sin],
            condition: scene.condition,
            start,
            spin: if scene.centrifugal { scene.ball_mass * scene.orbital().powi(2) } else { 0.0 },
            weight: common.frame.map(|axis| (0..3).map(|i| axis[i] * scene.gravity[i] * scene.ball_mass).sum()),
        }
    }
}

/// One number of each scene in the lanes; the last scene fills empty lanes.
pub fn spread<R: Real>(problems: &[Problem], value: impl Fn(&Problem) -> f64) -> R {
    R::from_lanes(|lane| value(&problems[lane.min(problems.len() - 1)]))
}

/// The problems in lanes.
pub struct Lanes<R> {
    pub pitch: R,
    pub race: [[R; 3]; 2],
    pub stiffness: [R; 2],
    pub phase: [R; 2],
    pub load: [R; 5],
    pub spin: R,
    pub weight: [R; 3],
    /// Share of the outer race in the overlap of two contacts in series.
    pub outer_share: R,
}

impl<R: Real> Lanes<R> {
    pub fn new(problems: &[Problem], free: [bool; 5]) -> Self {
        let of = |value: &dyn Fn(&Problem) -> f64| spread::<R>(problems, value);
        Lanes {
            pitch: of(&|p| p.pitch),
            race: [0, 1].map(|side| [0, 1, 2].map(|i| of(&|p| p.race[side][i]))),
            stiffness: [0, 1].map(|side| of(&|p| p.hertz[side].stiffness)),
            phase: [0, 1].map(|i| of(&|p| p.phase[i])),
            load: [0, 1, 2, 3, 4].map(|i| of(&|p| if free[i] { p.condition[i] } else { 0.0 })),
            spin: of(&|p| p.spin),
            weight: [0, 1, 2].map(|i| of(&|p| p.weight[i])),
            outer_share: of(&|p| 1.0 / (1.0 + (p.hertz[1].stiffness / p.hertz[0].stiffness).cbrt().powi(2))),
        }
    }

    /// Cosine and sine of a ball's azimuth.
    #[inline(always)]
    pub fn azimuth(&self, [c, s]: [f64; 2]) -> [R; 2] {
        let (c, s, [pc, ps]) = (R::splat(c), R::splat(s), self.phase);
        [pc * c - ps * s, ps * c + pc * s]
    }
}

/// Inner race in the frame of the outer one: centre, axis, and derivatives of the axis by the tilts.
pub struct Pose<R> {
    pub centre: [R; 3],
    pub axis: [R; 3],
    pub by_tilt: [[R; 3]; 2],
    /// Second derivative of the axis by both tilts and by the first; that by the second is its negative.
    pub mixed: [R; 3],
    pub by_first: [R; 3],
}

impl<R: Real> Pose<R> {
    #[inline(always)]
    pub fn new(common: &Common, q: &[R; 5]) -> Self {
        let ((sy, cy), (sz, cz)) = (q[3].sin_cos_small(), q[4].sin_cos_small());
        let vectors = [
            [0, 1, 2].map(|i| q[i] - R::splat(common.centre[i])),
            [cy * cz, sz, -sy * cz],
            [-sy * cz, R::zero(), -cy * cz],
            [-cy * sz, cz, sy * sz],
            [sy * sz, R::zero(), cy * sz],
            [-cy * cz, R::zero(), sy * cz],
        ];
        let turned = |v: [R; 3]| common.frame.map(|axis| dot(v, axis.map(R::splat)));
        let [centre, axis, one, two, mixed, by_first] = if common.plain { vectors } else { vectors.map(turned) };
        Pose { centre, axis, by_tilt: [one, two], mixed, by_first }
    }
}

/// True if a lane is positive.
pub fn any<R: Real>(value: R) -> bool {
    (0..R::LANES).any(|lane| value.lane(lane) > 0.0)
}

/// Largest of displacements and tilts times the pitch radius.
#[inline(always)]
pub fn farthest<R: Real>(q: &[R; 5], pitch: R) -> R {
    let of = |i: usize| if i < 3 { q[i].size() } else { q[i].size() * pitch };
    of(0).largest(of(1)).largest(of(2)).largest(of(3)).largest(of(4))
}

/// Subtracts the loads, and takes prescribed coordinates out of the linear system.
#[inline(always)]
pub fn constrain<R: Real>(common: &Common, l: &Lanes<R>, gradient: &mut [R; 5], matrix: &mut [[R; 5]; 5]) {
    for i in 0..5 {
        gradient[i] = gradient[i] - l.load[i];
        if !common.free[i] {
            gradient[i] = R::zero();
            for k in 0..5 {
                let (row, column) = (i.max(k), i.min(k));
                matrix[row][column] = R::splat(if i == k { 1.0 } else { 0.0 });
            }
        }
    }
}

/// Newton step of a ball, `own` − `back` · (step of the race), and its loads.
#[derive(Clone, Copy)]
struct Ball<R> {
    own: [R; 2],
    back: [[R; 5]; 2],
    load: [R; 2],
}

/// Energy, gradient and stiffness with the balls eliminated; lower triangles only.
struct System<R> {
    energy: R,
    gradient: [R; 5],
    stiffness: [[R; 5]; 5],
    balls: Vec<Ball<R>>,
}

/// Hertz law: load, its slope and its energy.
#[inline(always)]
fn hertz<R: Real>(stiffness: R, overlap: R) -> (R, R, R) {
    let overlap = overlap.largest(R::zero());
    let rise = stiffness * overlap.root();
    let load = rise * overlap;
    (load, R::splat(1.5) * rise, R::splat(0.4) * load * overlap)
}

/// Evaluates energy and its derivatives of all lanes at race positions `q` and ball positions `places`.
#[inline(always)]
fn evaluate<R: Real>(common: &Common, l: &Lanes<R>, q: &[R; 5], places: &mut [[R; 2]], system: &mut System<R>) {
    let (zero, one) = (R::zero(), R::splat(1.0));
    let pose = Pose::new(common, q);
    let (mut energy, mut gradient, mut stiffness) = (zero, [zero; 5], [[zero; 5]; 5]);
    system.balls.clear();
    for (ring, place) in common.ring.iter().zip(places) {
        let azimuth = l.azimuth(*ring);
        if !common.body_forces {
            let (free, overlap) = settle(common, l, &pose, azimuth);
            *place = [0, 1].map(|i| overlap.positive(place[i], free[i]));
        }
        let [a, r] = *place;
        // Contact with the outer race in the meridian plane.
        let (dx, dr) = (a - l.race[1][0], r - l.race[1][1]);
        let length = (dx * dx + dr * dr).root();
        let (ux, ur) = (dx / length, dr / length);
        let (outer, slope, stored) = hertz(l.stiffness[1], length - l.race[1][2]);
        let turn = outer / length;
        let force = [l.weight[0], local(l.weight, azimuth)[1] + l.spin * (l.pitch + r)];
        energy = energy + stored - force[0] * a - (force[1] - l.spin * R::splat(0.5) * r) * r;
        let mut own = [outer * ux - force[0], outer * ur - force[1]];
        let mut own_stiffness = [slope * ux * ux + turn * ur * ur, (slope - turn) * ux * ur, slope * ur * ur + turn * ux * ux];
        // Contact with the inner race: distances from the groove circle as sums of small terms.
        let [qx, qr, qt] = local(pose.centre, azimuth);
        let [nx, nr, nt] = local(pose.axis, azimuth);
        let (alpha, s, t) = (a - qx, r - qr, -qt);
        let far = l.pitch + s;
        let axial = alpha * nx + far * nr + t * nt;
        let rest = alpha * alpha + t * t - axial * axial;
        let distance = (far * far + rest).root();
        let (dx, dr) = (axial - l.race[0][0], s + rest / (distance + far) - l.race[0][1]);
        let length = (dx * dx + dr * dr).root();
        let (c1, c2, per) = (dx / length, dr / length, one / distance);
        let (inner, slope, stored) = hertz(l.stiffness[0], length - l.race[0][2]);
        energy = energy + stored;
        let n = [nx, nr, nt];
        let w = [(alpha - axial * nx) * per, (far - axial * nr) * per, (t - axial * nt) * per];
        let tangent = cross(n, w);
        let normal = [0, 1, 2].map(|i| c1 * n[i] + c2 * w[i]);
        let across = [0, 1, 2].map(|i| c1 * w[i] - c2 * n[i]);
        let arm = [alpha, far, t];
        let by_tilt = pose.by_tilt.map(|by| local(by, azimuth));
        let lever = by_tilt.map(|by| dot(arm, by));
        let lean = axial * per;
        let (sigma, kappa) = (c1 - c2 * lean, c2 * per);
        let (delta, cross) = (lever.map(|b| b * sigma), lever.map(|b| -(b * (c2 + c1 * lean))));
        let turn = inner / length;
        let at = |i: usize, k: usize| {
            slope * normal[i] * normal[k] + turn * across[i] * across[k] + inner * kappa * tangent[i] * tangent[k]
        };
        let (xx, xr, xt, rr, rt, tt) = (at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2));
        // By ball position and tilt; by race position it is the negative.
        let mixed: [[R; 3]; 2] = std::array::from_fn(|k| {
            std::array::from_fn(|i| {
                slope * normal[i] * delta[k]
                    + turn * across[i] * cross[k]
                    + inner * (sigma * by_tilt[k][i] - kappa * lever[k] * (n[i] - w[i] * lean))
            })
        });
        let bend = one + lean * lean;
        let second = [dot(arm, local(pose.by_first, azimuth)), dot(arm, local(pose.mixed, azimuth)), -axial];
        let tilts = [(0, 0), (1, 0), (1, 1)].map(|(i, k): (usize, usize)| {
            slope * delta[i] * delta[k]
                + turn * cross[i] * cross[k]
                + inner * (sigma * second[i + k] - kappa * lever[i] * lever[k] * bend)
        });
        // Eliminate the ball.
        own = [own[0] + inner * normal[0], own[1] + inner * normal[1]];
        own_stiffness = [own_stiffness[0] + xx, own_stiffness[1] + xr, own_stiffness[2] + rr];
        let loaded = own_stiffness[0] + own_stiffness[2];
        let centrifugal = loaded.positive(-l.spin, l.spin);
        let tiny = R::splat(1e-8);
        let [daa, dar, drr] = [own_stiffness[0] + tiny, own_stiffness[1], own_stiffness[2] + centrifugal + tiny];
        let per = one / (daa * drr - dar * dar);
        let inverse = |v: [R; 2]| [(drr * v[0] - dar * v[1]) * per, (daa * v[1] - dar * v[0]) * per];
        let ball_race = [[-xx, -xr, -xt, mixed[0][0], mixed[1][0]], [-xr, -rr, -rt, mixed[0][1], mixed[1][1]]];
        let back: [[R; 2]; 5] = std::array::from_fn(|i| inverse([ball_race[0][i], ball_race[1][i]]));
        let moved = inverse(own);
        let raw = [-(inner * normal[0]), -(inner * normal[1]), -(inner * normal[2]), inner * delta[0], inner * delta[1]];
        let g: [R; 5] = std::array::from_fn(|i| raw[i] - ball_race[0][i] * moved[0] - ball_race[1][i] * moved[1]);
        let direct = [
            [xx, zero, zero, zero, zero],
            [xr, rr, zero, zero, zero],
            [xt, rt, tt, zero, zero],
            [-mixed[0][0], -mixed[0][1], -mixed[0][2], tilts[0], zero],
            [-mixed[1][0], -mixed[1][1], -mixed[1][2], tilts[1], tilts[2]],
        ];
        let h = |i: usize, k: usize| direct[i][k] - ball_race[0][i] * back[k][0] - ball_race[1][i] * back[k][1];
        // From radius and orbit to Y and Z.
        let [c, s] = azimuth;
        gradient[0] = gradient[0] + g[0];
        gradient[1] = gradient[1] + g[1] * c - g[2] * s;
        gradient[2] = gradient[2] + g[1] * s + g[2] * c;
        stiffness[0][0] = stiffness[0][0] + h(0, 0);
        let (rr, rt, tt) = (h(1, 1), h(2, 1), h(2, 2));
        let (cc, cs, ss) = (c * c, c * s, s * s);
        stiffness[1][1] = stiffness[1][1] + rr * cc - (rt + rt) * cs + tt * ss;
        stiffness[2][1] = stiffness[2][1] + (rr - tt) * cs + rt * (cc - ss);
        stiffness[2][2] = stiffness[2][2] + rr * ss + (rt + rt) * cs + tt * cc;
        let (xr, xt) = (h(1, 0), h(2, 0));
        stiffness[1][0] = stiffness[1][0] + xr * c - xt * s;
        stiffness[2][0] = stiffness[2][0] + xr * s + xt * c;
        for i in 3..5 {
            gradient[i] = gradient[i] + g[i];
            let (r, t) = (h(i, 1), h(i, 2));
            stiffness[i][0] = stiffness[i][0] + h(i, 0);
            stiffness[i][1] = stiffness[i][1] + r * c - t * s;
            stiffness[i][2] = stiffness[i][2] + r * s + t * c;
            for k in 3..=i {
                stiffness[i][k] = stiffness[i][k] + h(i, k);
            }
        }
        let back = [0, 1].map(|b| {
            let v: [R; 5] = std::array::from_fn(|i| back[i][b]);
            [v[0], v[1] * c - v[2] * s, v[1] * s + v[2] * c, v[3], v[4]]
        });
        system.balls.push(Ball { own: moved.map(|v| -v), back, load: [inner, outer] });
    }
    if !common.plain {
        // From the axes of the outer race to those of the scene.
        let e = common.frame.map(|axis| axis.map(R::splat));
        let turned = |v: [R; 3]| [0, 1, 2].map(|i| e[0][i] * v[0] + e[1][i] * v[1] + e[2][i] * v[2]);
        let full = |i: usize, k: usize| stiffness[i.max(k)][i.min(k)];
        let half = [0, 1, 2].map(|i| turned([full(i, 0), full(i, 1), full(i, 2)]));
        let columns = [0, 1, 2].map(|k| turned([half[0][k], half[1][k], half[2][k]]));
        for i in 0..3 {
            for k in 0..=i {
                stiffness[i][k] = columns[k][i];
            }
        }
        for row in &mut stiffness[3..5] {
            let v = turned([row[0], row[1], row[2]]);
            row[..3].copy_from_slice(&v);
        }
        let v = turned([gradient[0], gradient[1], gradient[2]]);
        gradient[..3].copy_from_slice(&v);
        for ball in &mut system.balls {
            for row in &mut ball.back {
                let v = turned([row[0], row[1], row[2]]);
                row[..3].copy_from_slice(&v);
            }
        }
    }
    (system.energy, system.gradient, system.stiffness) = (energy, gradient, stiffness);
}

/// Solves up to eight problems.
pub fn solve_lanes(common: &Common, problems: &[Problem]) -> Vec<Equilibrium> {
    let first = coarse::<f32x8>(common, problems);
    let mut found = Vec::with_capacity(problems.len());
    for (group, four) in problems.chunks(4).enumerate() {
        let start = first.map(|value| f64x4::from_lanes(|lane| value.lane((4 * group + lane).min(7))));
        let start = std::array::from_fn(|i| if common.free[i] { start[i] } else { spread(four, |p| p.start[i]) });
        let mut equilibria = finish(common, four, start);
        if common.body_forces && equilibria.iter().any(|one| !one.converged) {
            // Weight and centrifugal force grow from a small part of their values.
            let (mut at, mut grown) = (start, Vec::new());
            for part in [0.01, 0.03, 0.1, 0.3, 0.5, 0.7, 0.85, 1.0] {
                let scaled = |p: &Problem| Problem { spin: part * p.spin, weight: p.weight.map(|w| part * w), ..*p };
                grown = finish(common, &four.iter().map(scaled).collect::<Vec<_>>(), at);
                at = std::array::from_fn(|i| f64x4::from_lanes(|lane| grown[lane.min(four.len() - 1)].position[i]));
            }
            equilibria.iter_mut().zip(grown).filter(|(old, _)| !old.converged).for_each(|(old, new)| *old = new);
        }
        if equilibria.iter().any(|one| !one.determinate) {
            // A saddle between two mirrored equilibria: start again neighbour it.
            let neighbour: [f64x4; 5] = std::array::from_fn(|i| {
                let place = |lane: usize| &equilibria[lane.min(four.len() - 1)];
                let aside = if common.free[i] { if i < 3 { -1e-5 * four[0].pitch } else { 1e-5 } } else { 0.0 };
                f64x4::from_lanes(|lane| place(lane).position[i] + if place(lane).determinate { 0.0 } else { aside })
            });
            let moved = finish(common, four, neighbour);
            equilibria.iter_mut().zip(moved).filter(|(old, _)| !old.determinate).for_each(|(old, new)| *old = new);
        }
        found.extend(equilibria);
    }
    found
}

/// Newton's method in double precision from a first position.
fn finish(common: &Common, problems: &[Problem], start: [f64x4; 5]) -> Vec<Equilibrium> {
    type R = f64x4;
    let l = Lanes::<R>::new(problems, common.free);
    let (zero, count) = (R::zero(), common.ring.len());
    let pose = Pose::new(common, &start);
    let mut base = start;
    let mut base_balls: Vec<[R; 2]> = common.ring.iter().map(|ring| settle(common, &l, &pose, l.azimuth(*ring)).0).collect();
    let (mut step, mut ball_step, mut part) = ([zero; 5], vec![[zero; 2]; count], R::splat(1.0));
    let (mut energy, mut places) = (R::splat(1e300), base_balls.clone());
    let mut system = System { energy, gradient: [zero; 5], stiffness: [[zero; 5]; 5], balls: Vec::with_capacity(count) };
    let (cap, ball_cap) = (l.pitch * R::splat(2e-3), l.pitch * R::splat(5e-4));
    let enough = R::splat(common.tolerance) * l.pitch;
    let (mut at, mut left, mut sound) = (base, zero, zero);
    for _ in 0..200 {
        for i in 0..5 {
            at[i] = base[i] + part * step[i];
        }
        for ((place, base), step) in places.iter_mut().zip(&base_balls).zip(&ball_step) {
            *place = [base[0] + part * step[0], base[1] + part * step[1]];
        }
        evaluate(common, &l, &at, &mut places, &mut system);
        let work = (0..5).fold(zero, |w, i| w + l.load[i] * at[i]);
        let now = system.energy - work;
        let worse = now - energy - R::splat(1e-10) * (system.energy.size() + work.size());
        let (mut gradient, mut matrix) = (system.gradient, system.stiffness);
        constrain(common, &l, &mut gradient, &mut matrix);
        let (newton, positive) = solve(&matrix, &gradient, 1e-9);
        let long = farthest(&newton, l.pitch);
        let limit = (cap / (long + cap * R::splat(1e-6))).smallest(R::splat(1.0));
        for i in 0..5 {
            base[i] = worse.positive(base[i], at[i]);
            step[i] = worse.positive(step[i], -(newton[i] * limit));
        }
        left = long;
        for (i, ball) in system.balls.iter().enumerate() {
            for k in 0..2 {
                let follow = (0..5).fold(ball.own[k], |sum, j| sum - ball.back[k][j] * step[j]);
                left = left.largest(follow.size());
                let follow = follow.smallest(ball_cap).largest(-ball_cap);
                base_balls[i][k] = worse.positive(base_balls[i][k], places[i][k]);
                ball_step[i][k] = worse.positive(ball_step[i][k], follow);
            }
        }
        left = worse.positive(R::splat(1.0), left);
        energy = worse.positive(energy, now);
        part = worse.positive(part * R::splat(0.3), R::splat(1.0));
        let stalled = R::splat(0.01) - part;
        if any(stalled) {
            // The direction does not descend: start again from settled balls.
            let pose = Pose::new(common, &base);
            for (place, ring) in base_balls.iter_mut().zip(&common.ring) {
                let settled = settle(common, &l, &pose, l.azimuth(*ring)).0;
                *place = [0, 1].map(|i| stalled.positive(settled[i], place[i]));
            }
            ball_step.iter_mut().flatten().chain(&mut step).for_each(|value| *value = stalled.positive(zero, *value));
            energy = stalled.positive(R::splat(1e300), energy);
            part = stalled.positive(R::splat(1.0), part);
        }
        sound = positive;
        if !any(left - enough) {
            break;
        }
    }
    let converged = left - R::splat(1e-11) * l.pitch;
    (0..problems.len())
        .map(|lane| Equilibrium {
            position: at.map(|value| value.lane(lane)),
            loads: system.gradient.map(|value| value.lane(lane)),
            stiffness: std::array::from_fn(|i| std::array::from_fn(|k| system.stiffness[i.max(k)][i.min(k)].lane(lane))),
            balls: places.iter().map(|place| place.map(|value| value.lane(lane))).collect(),
            ball_loads: system.balls.iter().map(|ball| ball.load.map(|value| value.lane(lane))).collect(),
            converged: converged.lane(lane) <= 0.0,
            determinate: sound.lane(lane) > 0.0,
        })
        .collect()
}
