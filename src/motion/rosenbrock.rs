//! ROS34PW2, a linearly implicit Runge–Kutta method of four stages (Rang and Angermann, BIT 45, 2005): third order with
//! any matrix instead of the Jacobian, stiffly accurate and L-stable with the exact one, second order embedded.
//!
//! Sliding in a rolling contact decays within 1e-7 s, a hundred times faster than any other motion, and limits explicit
//! steps. Here contacts and traction are implicit through [`Linearised`], one matrix a step; balls are described in
//! [`OrbitFrames`], rotations of bodies in [`TurningFrames`].

use crate::members::contacts::Want;
use crate::members::state::Ledger;
use crate::motion::block_arrow::BlockArrowMatrix;
use crate::motion::error_control::Attempt;
use crate::motion::linearised::Linearised;
use crate::motion::orbit_frame::OrbitFrames;
use crate::motion::system::System;
use crate::motion::turning_frame::TurningFrames;

pub const STAGES: usize = 4;
pub const GAMMA: f64 = 0.435_866_521_508_459_67;
/// Stage i is evaluated at y + h Σ α_ij k_j.
pub const ALPHA: [[f64; 3]; STAGES] = [
    [0.0, 0.0, 0.0],
    [0.871_733_043_016_918, 0.0, 0.0],
    [0.844_570_600_153_694_2, -0.112_990_642_363_484_86, 0.0],
    [0.0, 0.0, 1.0],
];
/// Off the diagonal, which is [`GAMMA`].
pub const GAMMAS: [[f64; 3]; STAGES] = [
    [0.0, 0.0, 0.0],
    [-0.871_733_043_016_918, 0.0, 0.0],
    [-0.903_380_570_130_440_8, 0.054_180_672_388_095_326, 0.0],
    [0.242_123_807_060_953_46, -1.223_250_583_904_514_7, 0.545_260_255_335_102_1],
];
pub const WEIGHTS: [f64; STAGES] = [
    0.242_123_807_060_953_46,
    -1.223_250_583_904_514_7,
    1.545_260_255_335_102,
    0.435_866_521_508_459_67,
];
/// Of second order.
pub const EMBEDDED: [f64; STAGES] =
    [0.378_109_031_458_193_7, -0.096_042_292_212_423_18, 0.5, 0.217_933_260_754_229_84];
/// Order of the error estimate in the step.
pub const ERROR_ORDER: f64 = 3.0;

/// Room for the stages; allocated once.
pub struct Rosenbrock {
    linearised: Linearised,
    arrow: BlockArrowMatrix,
    /// Of each bearing.
    frames: Vec<OrbitFrames>,
    turning: TurningFrames,
    first: Vec<f64>,
    stages: [Vec<f64>; STAGES],
    stage: Vec<f64>,
    rates: Vec<f64>,
    shift: Vec<f64>,
    drift: Vec<f64>,
}

impl Rosenbrock {
    pub fn new(system: &System) -> Rosenbrock {
        let linearised = Linearised::new(system);
        let room = || vec![0.0; system.places.state_len()];
        Rosenbrock {
            arrow: BlockArrowMatrix::new(system, &linearised),
            linearised,
            frames: system.sets.iter().map(|set| OrbitFrames::new(&set.layout)).collect(),
            turning: TurningFrames::new(&system.places, system.steps.moving.iter().copied()),
            first: room(),
            stages: std::array::from_fn(|_| room()),
            stage: room(),
            rates: room(),
            shift: room(),
            drift: room(),
        }
    }

    /// Evaluates the first stage and the contacts, common to all attempts of a step from `state` at `t`.
    pub fn begin(&mut self, system: &mut System, t: f64, state: &[f64]) {
        system.evaluate_with(Want::ForcesAndSlopes, t, state, &mut self.first);
        self.linearised.update(system, state);
        for (frames, set) in self.frames.iter_mut().zip(&system.sets) {
            frames.follow(&set.layout, state);
        }
        self.turning.follow(state);
    }

    /// Continues from `state`, reached by an accepted step at `t`.
    ///
    /// Losses are quadratic in sliding, which both ends of the step resolve better than the stages: the ledger takes
    /// them by the trapezoidal rule.
    pub fn accept(
        &mut self,
        system: &mut System,
        t: f64,
        step: f64,
        before: &[f64],
        state: &mut [f64],
    ) {
        let entries =
            [Ledger::Traction, Ledger::ContactDamping, Ledger::CageFriction, Ledger::BallFriction]
                .map(|e| system.places.ledger_entry(e));
        let first = entries.map(|at| self.first[at]);
        self.begin(system, t, state);
        for (at, first) in entries.into_iter().zip(first) {
            state[at] = before[at] + 0.5 * step * (first + self.first[at]);
        }
    }

    /// Attempts one step from its beginning; `state` does not change.
    pub fn attempt(
        &mut self,
        system: &mut System,
        t: f64,
        step: f64,
        state: &[f64],
        to: &mut Attempt,
    ) {
        let Rosenbrock {
            linearised,
            arrow,
            frames,
            turning,
            first,
            stages,
            stage,
            rates,
            shift,
            drift,
        } = self;
        arrow.factor(linearised, GAMMA * step);
        system.work.factorisations += 1;
        rates.copy_from_slice(first);
        for (frames, set) in frames.iter_mut().zip(&system.sets) {
            frames.turn(0.0);
            frames.rates_to_frame(&set.layout, state, rates);
            frames.drift(&set.layout, 1.0, state, drift);
        }
        turning.turn(0.0);
        turning.rates_to_frame(state, rates);
        turning.drift(1.0, state, drift);
        arrow.solve(linearised, &system.sets, state, drift, rates, &mut stages[0]);
        for i in 1..STAGES {
            let (before, rest) = stages.split_at_mut(i);
            stage.copy_from_slice(state);
            shift.fill(0.0);
            for (j, k) in before.iter().enumerate() {
                add_scaled(stage, step * ALPHA[i][j], k);
                add_scaled(shift, GAMMAS[i][j] / GAMMA, k);
            }
            let after = step * ALPHA[i].iter().sum::<f64>();
            for (frames, set) in frames.iter_mut().zip(&system.sets) {
                frames.turn(after);
                frames.to_inertial(&set.layout, stage);
            }
            turning.turn(after);
            turning.to_inertial(stage);
            system.evaluate(t + after, stage, rates);
            // Time has rate 1 in every stage.
            let going = 1.0 + GAMMAS[i].iter().sum::<f64>() / GAMMA;
            for (frames, set) in frames.iter().zip(&system.sets) {
                frames.rates_to_frame(&set.layout, stage, rates);
                frames.drift(&set.layout, going, state, drift);
            }
            turning.rates_to_frame(stage, rates);
            turning.drift(going, state, drift);
            add_scaled(rates, 1.0, shift);
            arrow.solve(linearised, &system.sets, state, drift, rates, &mut rest[0]);
            add_scaled(&mut rest[0], -1.0, shift);
        }
        to.state.copy_from_slice(state);
        to.error.fill(0.0);
        for (j, k) in stages.iter().enumerate() {
            add_scaled(&mut to.state, step * WEIGHTS[j], k);
            add_scaled(&mut to.error, step * (WEIGHTS[j] - EMBEDDED[j]), k);
        }
        for (frames, set) in frames.iter_mut().zip(&system.sets) {
            frames.turn(step);
            frames.to_inertial(&set.layout, &mut to.state);
        }
        turning.turn(step);
        turning.to_inertial(&mut to.state);
    }
}

/// to += factor · by.
pub(crate) fn add_scaled(to: &mut [f64], factor: f64, by: &[f64]) {
    if factor == 0.0 {
        return;
    }
    for (to, by) in to.iter_mut().zip(by) {
        *to += factor * by;
    }
}
