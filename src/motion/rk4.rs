//! Classical fourth-order Runge–Kutta, the integrator of 2.2.1 and 4.2.1.2.

use crate::motion::system::System;

/// Working memory of the stages; allocated once.
pub struct RungeKutta {
    rates: [Vec<f64>; 4],
    stage: Vec<f64>,
}

impl RungeKutta {
    pub fn new(length: usize) -> RungeKutta {
        RungeKutta { rates: std::array::from_fn(|_| vec![0.0; length]), stage: vec![0.0; length] }
    }

    /// Advances `state` from `t` to `t + step`; calls `seen` with the system as evaluated at `t`.
    pub fn step(
        &mut self,
        system: &mut System,
        t: f64,
        step: f64,
        state: &mut [f64],
        seen: impl FnOnce(&System, &[f64]),
    ) {
        let RungeKutta { rates: [k1, k2, k3, k4], stage } = self;
        system.evaluate(t, state, k1);
        seen(system, state);
        advance(stage, state, 0.5 * step, k1);
        system.evaluate(t + 0.5 * step, stage, k2);
        advance(stage, state, 0.5 * step, k2);
        system.evaluate(t + 0.5 * step, stage, k3);
        advance(stage, state, step, k3);
        system.evaluate(t + step, stage, k4);
        let sixth = step / 6.0;
        for i in 0..state.len() {
            state[i] += sixth * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
        system.tidy(t + step, state);
    }
}

/// stage = state + step · rates.
fn advance(stage: &mut [f64], state: &[f64], step: f64, rates: &[f64]) {
    for ((stage, state), rate) in stage.iter_mut().zip(state).zip(rates) {
        *stage = state + step * rate;
    }
}
