//! Equilibrium where bodies bend: from that of rigid bodies, by linearly implicit steps that start from rest each time
//! and grow to Newton's.
//!
//! A step of h adds mass over h² to the stiffness that [`Linearised`] knows, so that directions without stiffness stay where
//! they are. Balls stay at their azimuths, as in statics; nothing turns.

use super::arrow::Arrow;
use super::assembly::Assembly;
use super::contacts::{Driver, Want};
use super::linearised::Linearised;
use super::model::Rotation;
use super::state::{BODY, ORIENTATION, POSITION, SPIN, VELOCITY};
use super::system::System;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, norm, scale, sub};
use crate::solver::profile::Profile;
use crate::solver::statics::StaticsError;

/// First and longest step, s: a ball on its contacts swings within some 1e-5 s, a shaft within 1e-2 s.
const STEPS: [f64; 2] = [1e-5, 1.0];
/// Of one step to the next.
const GROWTH: f64 = 4.0;
const MOST_STEPS: usize = 200;
/// Unbalanced force over the largest that acts: what statics leaves, too.
const TOLERANCE: f64 = 1e-9;

/// `state`, an equilibrium of rigid bodies at t = 0, with bodies, balls and shapes where they rest when shafts bend; its
/// velocities stay.
///
/// # Errors
/// A search that does not end.
pub(super) fn settled(assembly: &Assembly, state: Vec<f64>) -> Result<Vec<f64>, StaticsError> {
    let mut system = System::new(at_rest(assembly), Driver::Lanes);
    let mut linearised = Linearised::new(&system);
    let mut arrow = Arrow::new(&system, &linearised);
    let [mut rates, mut change, drift] = [0, 1, 2].map(|_| vec![0.0; state.len()]);
    let mut still = state.clone();
    stop(&system, &mut still);
    let [mut step, longest] = STEPS;
    let mut before = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        system.tidy(0.0, &mut still);
        stop(&system, &mut still);
        system.evaluate_with(Want::ForcesAndSlopes, 0.0, &still, &mut rates);
        hold_azimuths(&system, &still, &mut rates);
        let (left, acting) = unbalanced(&system, &rates);
        if left <= TOLERANCE * acting {
            return Ok(joined(&system, state, &still));
        }
        step = if left < before { (GROWTH * step).min(longest) } else { 0.25 * step };
        before = left;
        linearised.update(&system, &still);
        arrow.factor(&linearised, step);
        arrow.solve(&linearised, &system.sets, &still, &drift, &rates, &mut change);
        hold_azimuths(&system, &still, &mut change);
        for (entry, change) in still.iter_mut().zip(&change) {
            *entry += step * change;
        }
    }
    let body = assembly.shafts.first().map_or(0, |shaft| shaft.body);
    let at = system.body_state(&still, body);
    Err(StaticsError::NotConverged {
        body: assembly.bodies[body].name.clone(),
        iterations: MOST_STEPS,
        residual: before,
        allowed: TOLERANCE,
        position: at.position,
        tilts: system.bodies[body].tilts(),
    })
}

/// The same without anything that turns, rubs or moves about.
fn at_rest(assembly: &Assembly) -> Assembly {
    let mut still = assembly.clone();
    for race in still.bodies.iter_mut().filter_map(|body| body.driven_mut()) {
        race.rotation = Rotation::Speed(Profile::ZERO);
    }
    for bearing in &mut still.bearings {
        (bearing.traction, bearing.cage) = (TractionLaw::None, None);
    }
    still
}

/// Takes all velocities out.
fn stop(system: &System, state: &mut [f64]) {
    for set in &system.sets {
        for component in (VELOCITY..VELOCITY + 3).chain(SPIN..SPIN + 3) {
            let at = set.layout.ball(component);
            state[at..at + set.layout.padded].fill(0.0);
        }
    }
    for body in 0..system.assembly.bodies.len() {
        let at = system.places.body(body);
        state[at + VELOCITY..at + BODY].fill(0.0);
    }
    for (shaft, at) in system.assembly.shafts.iter().zip(&system.shafts) {
        state[at + 2 * shaft.count()..at + shaft.entries()].fill(0.0);
    }
}

/// Takes out what moves balls round their bearings, and bodies that only their contacts hold.
fn hold_azimuths(system: &System, state: &[f64], rates: &mut [f64]) {
    for set in &system.sets {
        let layout = &set.layout;
        let [_, outer] = &set.races;
        let axis = outer.motion.axis;
        for ball in 0..layout.balls {
            let arm = sub(layout.ball_vector(state, POSITION, ball), outer.motion.position);
            let around = cross(axis, arm);
            let around = scale(around, 1.0 / norm(around));
            for component in [POSITION, VELOCITY] {
                let rate: Vec3 = layout.ball_vector(rates, component, ball);
                let kept = add_scaled(rate, -dot(rate, around), around);
                for (i, kept) in kept.into_iter().enumerate() {
                    rates[layout.ball(component + i) + ball] = kept;
                }
            }
        }
    }
    for (index, body) in system.assembly.bodies.iter().enumerate() {
        if body.driven().is_none() {
            let at = system.places.body(index);
            rates[at..at + BODY].fill(0.0);
        }
    }
}

/// Largest unbalanced force on a body, a ball or a section at rest, and the largest that acts, N.
fn unbalanced(system: &System, rates: &[f64]) -> (f64, f64) {
    let (mut left, mut acting) = (0.0f64, 0.0f64);
    let mut take = |force: f64| {
        // NaN stays.
        if force > left || force.is_nan() {
            left = force;
        }
    };
    for (set, bearing) in system.sets.iter().zip(&system.assembly.bearings) {
        for ball in 0..set.layout.balls {
            take(bearing.ball.mass * norm(set.layout.ball_vector(rates, VELOCITY, ball)));
        }
        acting = set.table.load.iter().fold(acting, |most, load| most.max(*load));
    }
    for (index, body) in system.assembly.bodies.iter().enumerate() {
        let Some(driven) = body.driven() else { continue };
        let at = system.places.body(index);
        let vector = |component: usize| [0, 1, 2].map(|i| rates[at + component + i]);
        take(driven.inertia.mass * norm(vector(VELOCITY)));
        // Over a tenth of a metre.
        take(10.0 * driven.inertia.transverse * norm(vector(SPIN)));
        for drive in &driven.drives {
            if let super::model::Drive::Load(profile) = drive {
                acting = acting.max(profile.value(0.0).abs());
            }
        }
        acting = acting.max(driven.inertia.mass * norm(system.assembly.gravity));
    }
    for (shaft, at) in system.assembly.shafts.iter().zip(&system.shafts) {
        let count = shaft.count();
        let rates = &rates[at + 2 * count..at + 4 * count];
        // A shape of 1 kg goes about as far where it is held as its unit says: 1/√m.
        take(rates.iter().fold(0.0f64, |most, rate| most.max(rate.abs())));
        for load in shaft.loads.iter().flat_map(|load| &load.force) {
            acting = acting.max(load.value(0.0).abs());
        }
    }
    (left, acting)
}

/// Places of one state, velocities of the other.
fn joined(system: &System, moving: Vec<f64>, still: &[f64]) -> Vec<f64> {
    let mut state = moving;
    for set in &system.sets {
        for component in POSITION..POSITION + 3 {
            let at = set.layout.ball(component);
            state[at..at + set.layout.padded].copy_from_slice(&still[at..at + set.layout.padded]);
        }
    }
    for (index, body) in system.assembly.bodies.iter().enumerate() {
        if body.driven().is_some() {
            let places = system.places.body(index) + POSITION..system.places.body(index) + VELOCITY;
            state[places.clone()].copy_from_slice(&still[places]);
        }
    }
    for (shaft, at) in system.assembly.shafts.iter().zip(&system.shafts) {
        let gone = *at..at + 2 * shaft.count();
        state[gone.clone()].copy_from_slice(&still[gone]);
    }
    debug_assert_eq!(ORIENTATION + 4, VELOCITY);
    state
}
