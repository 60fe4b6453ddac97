//! Rates of one body of an assembly under the sum of its loads.

use crate::kinematics::vec3::{Vec3, add, add_scaled, dot, scale};
use crate::members::body::{Body, Mobility, Rotation};
use crate::members::rigid_body;
use crate::members::rigid_body::BodyKinematics;
use crate::members::state::{
    BodyState, LEDGER, Ledger, ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate,
};
use crate::members::steps::BodySteps;
use crate::members::unbalance::{bent_of, directions, turning_momentum};
use crate::motion::system::System;
use crate::plan::Stage;
use crate::plan::counts::Counts;

impl System {
    /// Rates of one body under the sum of its loads.
    pub(crate) fn body_rates(
        &mut self,
        index: usize,
        t: f64,
        state: &[f64],
        rates: &mut [f64],
        ledger: &mut [f64; LEDGER],
    ) {
        let body = &self.assembly.bodies[index];
        let now = &self.bodies[index];
        let steps = self.steps.bodies[index];
        let own = &mut self.ran.bodies[index];
        let mut loads = self.loads[index];
        if let (true, Some(inertia)) = (self.steps.gravity, body.inertia()) {
            loads.force = add_scaled(loads.force, inertia.mass, self.assembly.gravity);
            self.ran.whole.add(Stage::Gravity, 1);
        }
        let (acceleration, spin_rate) = match (&body.mobility, steps.floating) {
            (Mobility::Fixed, _) => return,
            (Mobility::Carried, _) => ([0.0; 3], [0.0; 3]),
            (Mobility::Free(inertia), Some(of)) => {
                let (solid, at) = (&self.assembly.floating[of], self.floating[of]);
                let entries = at..at + 2 * solid.count();
                let (spin_rate, damped) = solid.rates(
                    now,
                    loads.moment,
                    &state[entries.clone()],
                    &mut self.floating_now[of],
                    &mut rates[entries],
                );
                ledger[Ledger::Foundation as usize] += damped;
                own.add(Stage::Reduced, 1);
                (scale(loads.force, 1.0 / inertia.mass), spin_rate)
            }
            (Mobility::Free(inertia), None) => {
                let (axis, spin) = (now.motion.axis, now.motion.spin);
                rigid_body::free_rates(inertia, axis, spin, loads.force, loads.moment)
            }
            (Mobility::Driven(driven), _) => {
                let t = t.min(self.latest);
                let BodyState { velocity, spin, .. } = now.state;
                if let Some([turning, within]) = turning_force(body, now, t, steps, own) {
                    loads.force = add(loads.force, add(turning, within));
                    ledger[Ledger::Drives as usize] += dot(turning, velocity);
                }
                if let Some(outside) = &self.outside[index] {
                    loads.add(outside);
                    ledger[Ledger::Foundation as usize] +=
                        dot(outside.force, velocity) + dot(outside.moment, spin);
                    own.add(Stage::Impulses, 1);
                }
                let rest = steps.foundation.then_some(&body.rest);
                if steps.unbalance_coupled {
                    let bent = bent_of(&self.assembly.shafts, &self.shafts, index, state);
                    let pushes = match bent {
                        Some((at, (shaft, _))) => {
                            &mut rates[at + shaft.amplitudes()..at + shaft.entries()]
                        }
                        None => &mut [],
                    };
                    let bent = bent.map(|(_, bent)| bent);
                    let gravity = self.assembly.gravity;
                    self.unbalance_coupling.update((body, now), bent, gravity, pushes, &mut loads);
                    let mut uncounted = Counts::default();
                    let free = rigid_body::rates(driven, t, now, rest, &loads, &mut uncounted);
                    self.unbalance_coupling.add_to((driven, now), &free, pushes, &mut loads);
                }
                let result = rigid_body::rates(driven, t, now, rest, &loads, own);
                ledger[Ledger::Drives as usize] += result.drive_power;
                ledger[Ledger::Foundation as usize] += result.foundation_power;
                (result.acceleration, result.spin_rate)
            }
        };
        write_body(rates, self.places.body(index), &now.state, acceleration, spin_rate);
        own.add(Stage::Motion, 1);
    }
}

/// Rotating load and centrifugal force of a body's unbalance, N, and the unbalance of a body driven by a torque; `None`
/// if neither is planned.
fn turning_force(
    body: &Body,
    now: &BodyKinematics,
    t: f64,
    steps: BodySteps,
    ran: &mut Counts,
) -> Option<[Vec3; 2]> {
    if !(steps.rotating_load || steps.unbalance) {
        return None;
    }
    let mut turning = [0.0; 3];
    if let (true, Some(load)) = (steps.rotating_load, &body.rotating_load) {
        turning = load.force(t);
        ran.add(Stage::RotatingLoad, 1);
    }
    let mut within = [0.0; 3];
    if steps.unbalance {
        ran.add(Stage::Unbalance, 1);
        // m e Ω² along the body's own Y, which rotates with it, and m e dΩ/dt against its Z.
        let [outwards, forward] = directions(&now.state.orientation, 0.0);
        let speed = dot(now.state.spin, now.motion.axis);
        let centrifugal = body.unbalance * speed * speed;
        match body.driven().map(|driven| &driven.rotation) {
            Some(Rotation::Torque(_)) => {
                within = turning_momentum(body.unbalance, speed, now.state.spin, forward);
            }
            given => {
                turning = add_scaled(turning, centrifugal, outwards);
                if let Some(Rotation::Speed(profile)) = given {
                    let lagging = body.unbalance * profile.rate(t);
                    turning = add_scaled(turning, -lagging, forward);
                }
            }
        }
    }
    Some([turning, within])
}

fn write_body(
    rates: &mut [f64],
    at: usize,
    state: &BodyState,
    acceleration: Vec3,
    spin_rate: Vec3,
) {
    let q = state.orientation;
    rates[at + POSITION..at + POSITION + 3].copy_from_slice(&state.velocity);
    rates[at + ORIENTATION..at + ORIENTATION + 4]
        .copy_from_slice(&quaternion_rate([q.w, q.i, q.j, q.k], state.spin));
    rates[at + VELOCITY..at + VELOCITY + 3].copy_from_slice(&acceleration);
    rates[at + SPIN..at + SPIN + 3].copy_from_slice(&spin_rate);
}
