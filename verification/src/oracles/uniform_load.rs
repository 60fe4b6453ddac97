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
