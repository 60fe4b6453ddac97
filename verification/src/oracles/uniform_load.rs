//! Angular-contact ball bearing under centric axial load (Harris & Kotzalas, Advanced Concepts of
//! Bearing Technology, uniform thrust): the one case with a scalar equation.

/// Lengths in m, angles in rad, stiffness in N/m^1.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformLoad {
    pub balls: usize,
    /// r_gi + r_go − 2 r_ball: distance of the groove centres when both contacts just touch.
    pub centre_distance: f64,
    /// Contact angle when just touching.
    pub free_angle: f64,
    /// Both contacts in series, of Q = K δ^1.5.
    pub stiffness: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformLoadSolution {
    /// rad.
    pub contact_angle: f64,
    /// N per ball.
    pub ball_load: f64,
    /// Both contacts together, m.
    pub approach: f64,
    /// Of the inner race from the just touching position, m.
    pub axial_displacement: f64,
}

impl UniformLoad {
    /// State at the contact angle `free_angle + opening`. The opening is the unknown, not the
    /// angle: cos α₀ − cos α = 2 sin((α+α₀)/2) sin((α−α₀)/2) keeps the digits of a small approach.
    fn state(&self, opening: f64) -> UniformLoadSolution {
        let angle = self.free_angle + opening;
        let stretch =
            2.0 * (self.free_angle + 0.5 * opening).sin() * (0.5 * opening).sin() / angle.cos();
        let approach = self.centre_distance * stretch;
        UniformLoadSolution {
            contact_angle: angle,
            ball_load: self.stiffness * approach * approach.sqrt(),
            approach,
            axial_displacement: self.centre_distance * opening.sin() / angle.cos(),
        }
    }

    /// Solution of F = Z Q sin α for an axial load F > 0 (N), by bisection to the last bit.
    pub fn solve(&self, axial_load: f64) -> UniformLoadSolution {
        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2 - self.free_angle);
        loop {
            let opening = 0.5 * (low + high);
            let state = self.state(opening);
            if opening <= low || opening >= high {
                return state;
            }
            let carried = self.balls as f64 * state.ball_load * state.contact_angle.sin();
            if carried < axial_load {
                low = opening;
            } else {
                high = opening;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::hertz;
    use super::*;

    /// Bearing of Table 5.3, steel E 210 GPa. Race radii, which the table does not state, are
    /// where ball and race touch: pitch ∓ r cos α.
    fn table_5_3(stiffness_of: fn(hertz::RelativeRadii) -> f64) -> UniformLoad {
        let (ball, groove, pitch) = (5.953e-3_f64, 6.6e-3_f64, 30e-3_f64);
        let free_angle = 35.0_f64.to_radians();
        let inset = ball * free_angle.cos();
        let inner = hertz::ball_on_race(ball, pitch - inset, groove, 1.0);
        let outer = hertz::ball_on_race(ball, pitch + inset, groove, -1.0);
        UniformLoad {
            balls: 11,
            centre_distance: 2.0 * (groove - ball),
            free_angle,
            stiffness: hertz::in_series(stiffness_of(inner), stiffness_of(outer)),
        }
    }

    #[test]
    fn table_5_3_under_445_n() {
        let exact = table_5_3(|radii| hertz::exact(radii, 1.0, 210e9 / 0.91).stiffness);
        let found = exact.solve(445.0);
        assert!((found.contact_angle.to_degrees() - 35.26).abs() <= 0.005, "{found:?}");
        assert!((found.ball_load - 70.1).abs() <= 0.05, "{found:?}");
        // Four micrometres to three digits follow from the exact stiffness; the fit gives 4.16.
        assert!((found.approach - 4.14e-6).abs() <= 0.005e-6, "{found:?}");
        let fit = |radii| hertz::hamrock_brewe(radii, 1.0, 210e9 / 0.91).stiffness;
        assert!((table_5_3(fit).solve(445.0).approach - 4.156e-6).abs() <= 0.001e-6);
    }

    #[test]
    fn solution_satisfies_the_stretched_triangle() {
        let bearing = table_5_3(|radii| hertz::exact(radii, 1.0, 210e9 / 0.91).stiffness);
        for load in [1e-3, 1.0, 445.0, 2e4] {
            let found = bearing.solve(load);
            let carried = 11.0 * found.ball_load * found.contact_angle.sin();
            assert!((carried / load - 1.0).abs() <= 1e-13, "{load} N: {carried}");
            // Pythagoras on the groove centres, independent of the angle's formulas.
            let radial = bearing.centre_distance * bearing.free_angle.cos();
            let axial =
                bearing.centre_distance * bearing.free_angle.sin() + found.axial_displacement;
            let distance = bearing.centre_distance + found.approach;
            assert!((radial.hypot(axial) - distance).abs() <= 1e-17, "{load} N");
        }
    }
}
