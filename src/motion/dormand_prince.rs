//! Dormand and Prince's explicit method of seven stages (J. Comp. Appl. Math. 6, 1980): fifth order,
//! fourth embedded, the last stage the first of the next step.

use crate::motion::error_control::Attempt;
use crate::motion::rosenbrock::add_scaled;
use crate::motion::system::System;

pub const STAGES: usize = 7;
/// Stage i is evaluated at y + h Σ a_ij k_j; the last row is the step itself.
pub const A: [[f64; 6]; STAGES] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
pub const C: [f64; STAGES] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
/// Fifth order less fourth.
pub const DIFFERENCE: [f64; STAGES] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];
/// Order of the error estimate in the step.
pub const ERROR_ORDER: f64 = 5.0;

/// Working memory of the stages; allocated once.
pub struct DormandPrince {
    rates: [Vec<f64>; STAGES],
    stage: Vec<f64>,
}

impl DormandPrince {
    pub fn new(length: usize) -> DormandPrince {
        let room = || vec![0.0; length];
        DormandPrince { rates: std::array::from_fn(|_| room()), stage: room() }
    }

    /// Sets the rates at the beginning of the next step.
    pub fn begin(&mut self, rates: &[f64]) {
        self.rates[0].copy_from_slice(rates);
    }

    /// Makes the last stage of an accepted attempt the first of the next step.
    pub fn accept(&mut self) {
        self.rates.swap(0, STAGES - 1);
    }

    /// Attempts one step; `state` does not change. The new state has its prescribed parts and unit quaternions, so that
    /// the last stage is the first of the next step to the bit.
    pub fn attempt(
        &mut self,
        system: &mut System,
        t: f64,
        step: f64,
        state: &[f64],
        to: &mut Attempt,
    ) {
        for i in 1..STAGES {
            let (before, rest) = self.rates.split_at_mut(i);
            let last = i == STAGES - 1;
            let stage = if last { &mut to.state } else { &mut self.stage };
            stage.copy_from_slice(state);
            for (j, k) in before.iter().enumerate() {
                add_scaled(stage, step * A[i][j], k);
            }
            if last {
                system.tidy(t + step, stage);
            }
            system.evaluate(t + C[i] * step, stage, &mut rest[0]);
        }
        to.error.fill(0.0);
        for (j, k) in self.rates.iter().enumerate() {
            add_scaled(&mut to.error, step * DIFFERENCE[j], k);
        }
    }
}
