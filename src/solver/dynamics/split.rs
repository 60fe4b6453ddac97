//! Linearly implicit traction: the step is no longer bound by the onset of traction.
//!
//! Sliding dies out within 1e-7 s in a rolling contact, a hundred times faster than anything else
//! moves. So each step is split: Runge–Kutta moves everything without traction; then traction acts
//! for the whole step on velocities alone, contacts and normal loads held, by one linearly
//! implicit Euler step per ball: first order in the step, with a small constant. On the bearing of
//! Table 3.5 at 1000 rpm and 1500 N steps of 1, 2 and 4 µs move the inner race by 1.2, 2.2 and
//! 4.2e-10 m over 10 ms, where Runge–Kutta with explicit traction needs steps below 0.18 µs.
//!
//! The moments by which a curved contact (Heathcote) brakes the ball are not in it; a run that asks
//! for both is refused.
//!
//! Each ball is solved on its own: 6 × 6, symmetric and positive definite, since traction never
//! feeds energy. Races keep their velocity during the solve and then take the opposite impulses.

use super::contacts;
use super::rk4::RungeKutta;
use super::state::{BODY, BodyState, LANES, Ledger, POSITION, SPIN, VELOCITY};
use super::system::System;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::{
    Motion, Slices, Sliding, TractionLaw, TractionTangent, add_slice_tangent,
    coefficient_and_slope, per_entrainment, regularised, sliding,
};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};

/// Velocity of a ball (m/s) and its spin (rad/s), or force and moment, or impulses.
type Six = [f64; 6];

/// Runge–Kutta without traction, and what the traction step needs.
pub struct Split {
    runge_kutta: RungeKutta,
    law: TractionLaw,
    slices: Slices,
    tangents: Vec<TractionTangent>,
}

impl Split {
    /// Takes the traction law out of the system's own evaluation.
    pub fn new(system: &mut System) -> Split {
        let law = std::mem::replace(&mut system.laws.traction, TractionLaw::None);
        Split {
            runge_kutta: RungeKutta::new(system.layout.len()),
            law,
            slices: system.laws.slices.clone(),
            tangents: vec![TractionTangent::default(); 2 * system.layout.padded],
        }
    }

    pub fn step(&mut self, system: &mut System, t: f64, step: f64, state: &mut [f64]) {
        self.runge_kutta.step(system, t, step, state);
        self.traction_step(system, t + step, step, state);
    }

    fn traction_step(&mut self, system: &mut System, t: f64, step: f64, state: &mut [f64]) {
        let layout = system.layout;
        let (inner, outer) = system.races(t, state);
        let races = [&inner, &outer];
        contacts::evaluate(
            system.driver,
            &system.laws,
            &layout,
            state,
            races,
            &system.damping,
            &mut system.table,
            &mut system.work,
        );
        let slices = self.slices.middle.len() as u64;
        system.work.slices += slices * system.table.active.len() as u64;
        let motions = races.map(|now| Motion {
            position: now.motion.position,
            velocity: now.motion.velocity,
            spin: now.motion.spin,
        });
        let axes = races.map(|now| now.motion.axis);
        tangents(&self.law, &self.slices, &motions, &axes, system, state, &mut self.tangents);
        let inertia = system.problem.ball;
        let mut before = 0.0;
        let mut after = 0.0;
        let mut impulse_on_races = [([0.0; 3], [0.0; 3]); 2];
        for ball in 0..layout.balls {
            let pairs = [ball, layout.padded + ball];
            let loads = pairs.map(|pair| system.table.load[pair]);
            if loads[0] == 0.0 && loads[1] == 0.0 {
                continue;
            }
            let motion = Motion {
                position: layout.ball_vector(state, POSITION, ball),
                velocity: layout.ball_vector(state, VELOCITY, ball),
                spin: layout.ball_vector(state, SPIN, ball),
            };
            let mut matrix = [[0.0; 6]; 6];
            for i in 0..3 {
                matrix[i][i] = inertia.mass;
                matrix[3 + i][3 + i] = inertia.axial;
            }
            let mut impulse: Six = [0.0; 6];
            let mut maps = [[[0.0; 6]; 3]; 2];
            for race in 0..2 {
                let (pair, load) = (pairs[race], loads[race]);
                if load == 0.0 {
                    continue;
                }
                let normal = system.table.contact[pair].normal;
                maps[race] = lever(&system.table.sliding[pair], normal);
                add_contact(
                    &self.tangents[pair],
                    &maps[race],
                    step * load,
                    &mut matrix,
                    &mut impulse,
                );
            }
            let change = solve_symmetric(matrix, impulse);
            before += kinetic(&inertia, &motion);
            let moved = Motion {
                position: motion.position,
                velocity: add(motion.velocity, [change[0], change[1], change[2]]),
                spin: add(motion.spin, [change[3], change[4], change[5]]),
            };
            after += kinetic(&inertia, &moved);
            for i in 0..3 {
                state[layout.ball(VELOCITY + i) + ball] = moved.velocity[i];
                state[layout.ball(SPIN + i) + ball] = moved.spin[i];
            }
            for race in 0..2 {
                let (pair, load) = (pairs[race], loads[race]);
                if load == 0.0 {
                    continue;
                }
                let here = &system.table.sliding[pair];
                let impulse =
                    contact_impulse(&self.tangents[pair], &maps[race], step * load, &change);
                let linear = add_scaled(
                    scale(here.rolling_direction, impulse[0]),
                    impulse[1],
                    here.transverse_direction,
                );
                let normal = system.table.contact[pair].normal;
                let angular = add(cross(here.arm_on_race, linear), scale(normal, impulse[2]));
                let (force, moment) = &mut impulse_on_races[race];
                *force = sub(*force, linear);
                *moment = sub(*moment, angular);
            }
        }
        let (race_change, drive_work) = self.push_races(system, t, state, impulse_on_races);
        let at = layout.ledger_entry(Ledger::Drives);
        state[at] += drive_work;
        let at = layout.ledger_entry(Ledger::Traction);
        state[at] += after - before + race_change - drive_work;
    }

    /// Gives the races their impulses; returns the change of their kinetic energy and the work of
    /// the drives that hold prescribed rates.
    fn push_races(
        &self,
        system: &System,
        t: f64,
        state: &mut [f64],
        impulses: [(Vec3, Vec3); 2],
    ) -> (f64, f64) {
        let layout = system.layout;
        let mut change = 0.0;
        let mut drive_work = 0.0;
        let bodies = [
            (Some(&system.problem.inner), layout.inner()),
            (system.problem.outer.as_ref(), layout.outer()),
        ];
        for ((body, at), (force, moment)) in bodies.into_iter().zip(impulses) {
            let Some(body) = body else { continue };
            let old = super::race::now(body, t, BodyState::from_slice(&state[at..at + BODY])).state;
            let axis = old.axis();
            let about_axis = dot(moment, axis);
            let across = add_scaled(moment, -about_axis, axis);
            let inertia = &body.inertia;
            let mut pushed = old;
            pushed.velocity = add_scaled(old.velocity, 1.0 / inertia.mass, force);
            pushed.spin = add_scaled(
                add_scaled(old.spin, about_axis / inertia.axial, axis),
                1.0 / inertia.transverse,
                across,
            );
            let new = super::race::now(body, t, pushed).state;
            let energy = |race: &BodyState| {
                let spin = dot(race.spin, axis);
                0.5 * inertia.mass * dot(race.velocity, race.velocity)
                    + 0.5 * inertia.transverse * dot(race.spin, race.spin)
                    + 0.5 * (inertia.axial - inertia.transverse) * spin * spin
            };
            let gained = energy(&new) - energy(&old);
            change += gained;
            // Contacts do the work impulse · mean rate; what the race did not gain of it the
            // drives took.
            let mean = |a: Vec3, b: Vec3| scale(add(a, b), 0.5);
            let done = dot(force, mean(old.velocity, new.velocity))
                + dot(moment, mean(old.spin, new.spin));
            drive_work += gained - done;
            state[at..at + BODY].copy_from_slice(&new.to_array());
        }
        (change, drive_work)
    }
}

/// From velocity and spin of the ball to slip along t and s and spin about n; its transpose takes
/// traction to force and moment.
fn lever(here: &Sliding, normal: Vec3) -> [[f64; 6]; 3] {
    let joined = |a: Vec3, b: Vec3| [a[0], a[1], a[2], b[0], b[1], b[2]];
    [
        joined(here.rolling_direction, cross(here.arm_on_ball, here.rolling_direction)),
        joined(here.transverse_direction, cross(here.arm_on_ball, here.transverse_direction)),
        joined([0.0; 3], normal),
    ]
}

/// The tangent's 3 × 3 slope.
fn full(slope: &[f64; 6]) -> [[f64; 3]; 3] {
    let [tt, ts, tn, ss, sn, nn] = *slope;
    [[tt, ts, tn], [ts, ss, sn], [tn, sn, nn]]
}

/// Adds mapᵀ·slope·map to the upper triangle and mapᵀ·force to the impulse, times `weight` (step
/// times normal load).
fn add_contact(
    tangent: &TractionTangent,
    map: &[[f64; 6]; 3],
    weight: f64,
    matrix: &mut [[f64; 6]; 6],
    impulse: &mut Six,
) {
    let slope = full(&tangent.slope);
    let mut product = [[0.0; 6]; 3];
    for i in 0..3 {
        for j in 0..6 {
            product[i][j] = weight
                * (slope[i][0] * map[0][j] + slope[i][1] * map[1][j] + slope[i][2] * map[2][j]);
        }
    }
    for i in 0..6 {
        for j in i..6 {
            matrix[i][j] +=
                map[0][i] * product[0][j] + map[1][i] * product[1][j] + map[2][i] * product[2][j];
        }
        impulse[i] += weight
            * (map[0][i] * tangent.force[0]
                + map[1][i] * tangent.force[1]
                + map[2][i] * tangent.force[2]);
    }
}

/// Impulse along t and s and about n that a contact gives while the ball changes by `change`.
fn contact_impulse(
    tangent: &TractionTangent,
    map: &[[f64; 6]; 3],
    weight: f64,
    change: &Six,
) -> [f64; 3] {
    let slope = full(&tangent.slope);
    let slip = [0, 1, 2].map(|i: usize| (0..6).map(|j| map[i][j] * change[j]).sum::<f64>());
    [0, 1, 2].map(|i: usize| {
        let fall = slope[i][0] * slip[0] + slope[i][1] * slip[1] + slope[i][2] * slip[2];
        weight * (tangent.force[i] - fall)
    })
}

/// Solves a symmetric positive definite system given by its upper triangle, by LDLᵀ.
fn solve_symmetric(mut matrix: [[f64; 6]; 6], mut right: Six) -> Six {
    for k in 0..6 {
        let per_pivot = 1.0 / matrix[k][k];
        for i in k + 1..6 {
            let factor = matrix[k][i] * per_pivot;
            for j in i..6 {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..6).rev() {
        for j in k + 1..6 {
            right[k] -= matrix[k][j] * right[j];
        }
        right[k] /= matrix[k][k];
    }
    right
}

fn kinetic(inertia: &Inertia, motion: &Motion) -> f64 {
    0.5 * inertia.mass * dot(motion.velocity, motion.velocity)
        + 0.5 * inertia.axial * dot(motion.spin, motion.spin)
}

/// Sliding and tangents of all loaded contacts.
fn tangents(
    law: &TractionLaw,
    slices: &Slices,
    races: &[Motion; 2],
    axes: &[Vec3; 2],
    system: &mut System,
    state: &[f64],
    tangents: &mut [TractionTangent],
) {
    // One instance of the loop for each law, so that nothing is decided inside it.
    match law {
        TractionLaw::None => {}
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            let (coefficient, speed) = (*coefficient, *regularisation_speed);
            let friction = |slip, _| regularised(coefficient, speed, slip);
            over_lanes(slices, races, axes, system, state, tangents, |_| 0.0, friction);
        }
        TractionLaw::SlideToRoll { curve, entrainment_floor } => {
            let (curve, floor) = (*curve, *entrainment_floor);
            let prepare = |entrainment| per_entrainment(entrainment, floor);
            let friction = |slip: f64, per_rolling: f64| {
                let (value, slope) = curve.coefficient_and_slope(slip * per_rolling);
                (value, slope * per_rolling)
            };
            over_lanes(slices, races, axes, system, state, tangents, prepare, friction);
        }
        TractionLaw::SlipSpeed { curve } => {
            let curve = *curve;
            let friction = |slip, _| curve.coefficient_and_slope(slip);
            over_lanes(slices, races, axes, system, state, tangents, |_| 0.0, friction);
        }
        table @ TractionLaw::Table { .. } => {
            let friction = |slip, entrainment| coefficient_and_slope(table, slip, entrainment);
            over_lanes(slices, races, axes, system, state, tangents, |speed| speed, friction);
        }
    }
}

#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn over_lanes(
    slices: &Slices,
    races: &[Motion; 2],
    axes: &[Vec3; 2],
    system: &mut System,
    state: &[f64],
    tangents: &mut [TractionTangent],
    prepare: impl Fn(f64) -> f64,
    friction: impl Fn(f64, f64) -> (f64, f64) + Copy,
) {
    let layout = system.layout;
    let System { laws, table, .. } = system;
    for block in table.active.chunks(LANES) {
        let mut slip = [[0.0; LANES]; 2];
        let mut spin = [[0.0; LANES]; 3];
        let mut width = [0.0; LANES];
        let mut curvature = [0.0; LANES];
        let mut prepared = [1.0; LANES];
        for (l, &pair) in block.iter().enumerate() {
            let (race, ball) = (pair / layout.padded, pair % layout.padded);
            let contact = &table.contact[pair];
            let motion = Motion {
                position: layout.ball_vector(state, POSITION, ball),
                velocity: layout.ball_vector(state, VELOCITY, ball),
                spin: layout.ball_vector(state, SPIN, ball),
            };
            let reach = laws.ball_radius - 0.5 * contact.overlap;
            let here =
                sliding(&motion, &races[race], axes[race], contact.outward, contact.normal, reach);
            slip[0][l] = here.slip[0];
            slip[1][l] = here.slip[1];
            for i in 0..3 {
                spin[i][l] = here.relative_spin[i];
            }
            width[l] = laws.races[race].semi_major_factor * contact.overlap.sqrt();
            curvature[l] = laws.curvature[race];
            prepared[l] = prepare(here.entrainment);
            table.sliding[pair] = here;
        }
        let sums = tangent_lanes(slices, &slip, &spin, &width, &curvature, &prepared, friction);
        for (l, &pair) in block.iter().enumerate() {
            tangents[pair] = sums[l];
        }
    }
}

/// All slices of a block of contacts. One array for each sum: an array of arrays would keep the
/// loop over lanes from becoming vector code.
#[inline(always)]
fn tangent_lanes(
    slices: &Slices,
    slip: &[[f64; LANES]; 2],
    spin: &[[f64; LANES]; 3],
    width: &[f64; LANES],
    curvature: &[f64; LANES],
    prepared: &[f64; LANES],
    friction: impl Fn(f64, f64) -> (f64, f64) + Copy,
) -> [TractionTangent; LANES] {
    let mut force_t = [0.0; LANES];
    let mut force_s = [0.0; LANES];
    let mut moment = [0.0; LANES];
    let mut tt = [0.0; LANES];
    let mut ts = [0.0; LANES];
    let mut tn = [0.0; LANES];
    let mut ss = [0.0; LANES];
    let mut sn = [0.0; LANES];
    let mut nn = [0.0; LANES];
    for (middle, share) in slices.middle.iter().zip(&slices.share) {
        for l in 0..LANES {
            let y = middle * width[l];
            let before = TractionTangent {
                force: [force_t[l], force_s[l], moment[l]],
                slope: [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]],
            };
            let after = add_slice_tangent(
                &before,
                [slip[0][l], slip[1][l]],
                [spin[0][l], spin[1][l], spin[2][l]],
                y,
                y * y * curvature[l],
                *share,
                |speed| friction(speed, prepared[l]),
            );
            force_t[l] = after.force[0];
            force_s[l] = after.force[1];
            moment[l] = after.force[2];
            tt[l] = after.slope[0];
            ts[l] = after.slope[1];
            tn[l] = after.slope[2];
            ss[l] = after.slope[3];
            sn[l] = after.slope[4];
            nn[l] = after.slope[5];
        }
    }
    let mut sums = [TractionTangent::default(); LANES];
    for (l, sum) in sums.iter_mut().enumerate() {
        *sum = TractionTangent {
            force: [force_t[l], force_s[l], moment[l]],
            slope: [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]],
        };
    }
    sums
}
