//! A deep-groove ball bearing by the formulas of ISO/TS 16281, A.2: each ball feels the axial and radial displacement of
//! the inner race at its azimuth, and nothing of what a moved or tilted race does out of the ball's plane. Exact Hertz
//! contact by quadrature, equilibrium as the minimum of an energy.

use crate::oracles::hertz::{ball_on_race, effective_modulus, exact, in_series};
use crate::oracles::hyperdual::Jet;
use crate::oracles::trust_region::{Expansion, minimise};
use std::f64::consts::TAU;

/// Lengths in m.
pub struct IsoBearing {
    pub balls: usize,
    pub ball_diameter: f64,
    pub pitch_diameter: f64,
    /// Groove radius over ball diameter, inner and outer race.
    pub conformities: [f64; 2],
    pub diametral_clearance: f64,
    /// Pa.
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
    /// C, N.
    pub dynamic_rating: f64,
}

pub struct IsoSolution {
    /// x, y, z, m; tilts about y and z, rad.
    pub coordinates: [f64; 5],
    /// 10⁶ revolutions, inner race rotating.
    pub life: f64,
}

impl IsoBearing {
    fn gamma(&self) -> f64 {
        self.ball_diameter / self.pitch_diameter
    }

    /// N/m^1.5 of both contacts of a ball.
    fn stiffness(&self) -> f64 {
        let modulus = effective_modulus(
            self.youngs_modulus,
            self.poisson_ratio,
            self.youngs_modulus,
            self.poisson_ratio,
        );
        let ball = 0.5 * self.ball_diameter;
        let side = |conformity: f64, sign: f64| {
            let race = ball * (1.0 / self.gamma() - sign);
            let radii = ball_on_race(ball, race, conformity * self.ball_diameter, sign);
            exact(radii, 1.0, modulus).stiffness
        };
        in_series(side(self.conformities[0], 1.0), side(self.conformities[1], -1.0))
    }

    /// Equilibrium under forces along x, y, z (N) and moments about y and z (N·m). Ball 1 is on y.
    pub fn solve(&self, loads: [f64; 5]) -> IsoSolution {
        let grooves = (self.conformities[0] + self.conformities[1] - 1.0) * self.ball_diameter;
        let radial = grooves - 0.5 * self.diametral_clearance;
        let (lever, stiffness) = (0.5 * self.pitch_diameter, self.stiffness());
        let units = [1.0, 1.0, 1.0, lever, lever];
        // Approach of a ball; tilts times the lever.
        let approach = |ball: usize, at: &[f64]| {
            let q: [Jet<5>; 5] = std::array::from_fn(|i| Jet::variable(at[i], i));
            let (sin, cos) = (TAU * ball as f64 / self.balls as f64).sin_cos();
            let along = q[0] + q[3].scale(sin) - q[4].scale(cos);
            let out = (q[1].scale(cos) + q[2].scale(sin)).shift(radial);
            (along.square() + out.square()).sqrt().shift(-grooves)
        };
        let minimum = minimise(&[0.0; 5], 1e-6, |at| {
            let mut all = Expansion {
                value: 0.0,
                noise: 0.0,
                gradient: vec![0.0; 5],
                hessian: vec![vec![0.0; 5]; 5],
            };
            let squeezed = (0..self.balls).map(|ball| approach(ball, at));
            for squeeze in squeezed.filter(|squeeze| squeeze.value > 0.0) {
                let root = squeeze.value.sqrt();
                let load = stiffness * squeeze.value * root;
                let energy =
                    squeeze.chain(0.4 * load * squeeze.value, load, 1.5 * stiffness * root);
                all.value += energy.value;
                all.noise += f64::EPSILON * (energy.value + load * grooves);
                for i in 0..5 {
                    all.gradient[i] += energy.gradient[i];
                    (0..5).for_each(|j| all.hessian[i][j] += energy.hessian[i][j]);
                }
            }
            for i in 0..5 {
                let load = loads[i] / units[i];
                all.value -= load * at[i];
                all.noise += f64::EPSILON * (load * at[i]).abs();
                all.gradient[i] -= load;
            }
            all
        });
        let load = |ball| {
            let squeeze = approach(ball, &minimum.point).value.max(0.0);
            stiffness * squeeze * squeeze.sqrt()
        };
        let ball_loads: Vec<f64> = (0..self.balls).map(load).collect();
        IsoSolution {
            coordinates: std::array::from_fn(|i| minimum.point[i] / units[i]),
            life: self.life(&ball_loads),
        }
    }

    /// L₁₀ᵣ from (Q_e/Q_c)^(10/3) of the rotating inner and the still outer race.
    fn life(&self, loads: &[f64]) -> f64 {
        let gamma = self.gamma();
        let [inner, outer] = self.conformities;
        let grooves = inner * (2.0 * outer - 1.0) / (outer * (2.0 * inner - 1.0));
        let ratio = 1.044 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * grooves.powf(0.41);
        let each = self.dynamic_rating / self.balls as f64;
        let [of_inner, of_outer] = [
            each / 0.407 * (1.0 + ratio.powf(10.0 / 3.0)).powf(0.3),
            each / 0.389 * (1.0 + ratio.powf(-10.0 / 3.0)).powf(0.3),
        ];
        let mean = |exponent: f64| {
            let sum: f64 = loads.iter().map(|load| load.powf(exponent)).sum();
            (sum / loads.len() as f64).powf(1.0 / exponent)
        };
        let harm = (mean(3.0) / of_inner).powf(10.0 / 3.0)
            + (mean(10.0 / 3.0) / of_outer).powf(10.0 / 3.0);
        harm.powf(-0.9)
    }
}
