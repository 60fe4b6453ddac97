//! One point of rubber under uniaxial load, apart from the library in every part: stresses are exact
//! derivatives of the energy in principal stretches, and the Maxwell elements are integrated as
//! differential equations by backward differences of second order.

use super::hyperdual::Jet;

/// C_R, N, B of the eight-chain energy in its five-term form; Pa.
#[derive(Clone, Copy)]
pub struct Chains {
    pub modulus: f64,
    pub locking: f64,
    pub bulk: f64,
}

/// Energies of the chains and of the volume, of the stretches along and across (two equal ones).
fn energies(chains: Chains, along: f64, across: f64) -> [Jet<2>; 2] {
    let (a, b) = (Jet::variable(along, 0), Jet::variable(across, 1));
    let j = a * b.square();
    let two_thirds = 2.0 / 3.0;
    let per = j.value.powf(-two_thirds);
    let per = j.chain(
        per,
        -two_thirds * per / j.value,
        two_thirds * (two_thirds + 1.0) * per / (j.value * j.value),
    );
    let invariant = (a.square() + b.square().scale(2.0)) * per;
    let mut sum = Jet::constant(0.0);
    let mut power = Jet::constant(1.0);
    let (mut scale, mut rest) = (1.0, 1.0);
    for coefficient in [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0] {
        power = power * invariant;
        rest *= 3.0;
        sum = sum + power.shift(-rest).scale(coefficient * scale);
        scale /= chains.locking;
    }
    [sum.scale(chains.modulus), j.shift(-1.0).square().scale(0.5 * chains.bulk)]
}

/// Second Piola–Kirchhoff stresses along and across and the derivative of the second by the stretch across:
/// of the chains, of the volume.
fn stresses(chains: Chains, along: f64, across: f64) -> [[f64; 3]; 2] {
    energies(chains, along, across).map(|w| {
        // The stretch across counts for both sides.
        let [first, second] = [w.gradient[0] / along, 0.5 * w.gradient[1] / across];
        let bend = 0.5 * (w.hessian[1][1] / across - w.gradient[1] / (across * across));
        [first, second, bend]
    })
}

/// True strain and Cauchy stress (Pa) along the axis, over time.
pub type QuasiStaticSequence = Vec<[f64; 2]>;

/// A course of true strains at equal steps of `dt` s, free across. `turns` are the indices at which the
/// rate jumps; 0 is one. Without Maxwell elements (γ, τ in s) it is the equilibrium curve.
pub fn uniaxial(
    chains: Chains,
    maxwell: &[[f64; 2]],
    strains: &[f64],
    dt: f64,
    turns: &[usize],
) -> QuasiStaticSequence {
    let mut across = 1.0;
    let mut last = [[0.0; 2]; 2];
    let mut elements = vec![[[0.0; 2]; 2]; maxwell.len()];
    let mut course = vec![[strains[0], 0.0]];
    for n in 1..strains.len() {
        let along = strains[n].exp();
        // Backward Euler behind a turn: (s − s₁)/h; otherwise (3s − 4s₁ + s₂)/2h.
        let [now, one, two] =
            if turns.contains(&(n - 1)) { [1.0, -1.0, 0.0] } else { [1.5, -2.0, 0.5] };
        let mut gain = 1.0;
        let mut past = [0.0; 2];
        for ([gamma, tau], h) in maxwell.iter().zip(&elements) {
            let per = 1.0 / (now + dt / tau);
            gain += gamma * now * per;
            for i in 0..2 {
                let driven = gamma * (one * last[0][i] + two * last[1][i]);
                past[i] += per * (driven - one * h[0][i] - two * h[1][i]);
            }
        }
        for _ in 0..50 {
            let [chain, volume] = stresses(chains, along, across);
            let side = gain * chain[1] + volume[1] + past[1];
            let step = -side / (gain * chain[2] + volume[2]);
            across += step;
            if step.abs() <= 1e-15 {
                break;
            }
        }
        let [chain, volume] = stresses(chains, along, across);
        for ([gamma, tau], h) in maxwell.iter().zip(&mut elements) {
            let per = 1.0 / (now + dt / tau);
            let next = [0, 1].map(|i: usize| {
                let driven = gamma * (now * chain[i] + one * last[0][i] + two * last[1][i]);
                per * (driven - one * h[0][i] - two * h[1][i])
            });
            *h = [next, h[0]];
        }
        last = [[chain[0], chain[1]], last[0]];
        let total = gain * chain[0] + volume[0] + past[0];
        course.push([strains[n], total * along / (across * across)]);
    }
    course
}
