//! A spinning shaft that whirls in circles, by transfer matrices: no elements, no modes, no matrices over a shaft.
//!
//! Along a length of one section deflection, turn, moment and shear force of a motion r e^{iωt} (r = y + i z) follow from
//! those at its beginning by e^{A x}; ω above 0 whirls the way the shaft spins. Discs and springs jump in moment and force.
//! Frequencies are the roots of what is left at the far end.

/// Uniform length, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length {
    pub length: f64,
    /// EI, κGA, ρA, ρI.
    pub bending: f64,
    pub shear: f64,
    pub line_mass: f64,
    pub line_inertia: f64,
}

impl Length {
    /// A round steel section (210 GPa, 0.3, 7850 kg/m³) with Cowper's shear coefficient of a full one.
    pub fn steel(length: f64, diameter: f64) -> Length {
        let area = std::f64::consts::FRAC_PI_4 * diameter * diameter;
        let moment = area * diameter * diameter / 16.0;
        let (e, nu, rho) = (210e9, 0.3, 7850.0);
        let shear = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * e / (2.0 + 2.0 * nu) * area;
        Length {
            length,
            bending: e * moment,
            shear,
            line_mass: rho * area,
            line_inertia: rho * moment,
        }
    }
}

/// What is met along the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    Length(Length),
    /// Mass, inertia about the axis and about a diameter.
    Disc {
        mass: f64,
        axial: f64,
        transverse: f64,
    },
    /// N/m, the same in all directions.
    Spring(f64),
}

/// How an end is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    Free,
    Pinned,
    Clamped,
}

type State = [f64; 4];

impl End {
    /// Independent motions [w, s, M, V] of this end; as equations at the far end, the two that vanish.
    fn motions(self) -> [State; 2] {
        match self {
            End::Free => [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
            End::Pinned => [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
            End::Clamped => [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
        }
    }

    fn vanish(self) -> [usize; 2] {
        match self {
            End::Free => [2, 3],
            End::Pinned => [0, 2],
            End::Clamped => [0, 1],
        }
    }
}

impl Part {
    fn carry(&self, state: State, spin: f64, omega: f64) -> State {
        let [w, s, moment, force] = state;
        match *self {
            Part::Disc { mass, axial, transverse } => {
                let turn = transverse * omega * omega - axial * spin * omega;
                [w, s, moment - turn * s, force - mass * omega * omega * w]
            }
            Part::Spring(stiffness) => [w, s, moment, force + stiffness * w],
            Part::Length(of) => {
                // w' = s + V/κGA, s' = M/EI, M' = −V − (ρI ω² − 2ρI Ω ω) s, V' = −ρA ω² w.
                let turn = of.line_inertia * (omega * omega - 2.0 * spin * omega);
                let rate = |[w, s, moment, force]: State| -> State {
                    [
                        s + force / of.shear,
                        moment / of.bending,
                        -force - turn * s,
                        -of.line_mass * omega * omega * w,
                    ]
                };
                // Taylor's series over pieces so short that it ends in rounding.
                let pieces = 64;
                let h = of.length / f64::from(pieces);
                let mut state = state;
                for _ in 0..pieces {
                    let (mut term, mut sum) = (state, state);
                    for n in 1..=14 {
                        term = rate(term).map(|value| value * h / f64::from(n));
                        sum = std::array::from_fn(|i| sum[i] + term[i]);
                    }
                    state = sum;
                }
                state
            }
        }
    }
}

/// What is left at the far end; zero at a frequency ω (rad/s, below 0 backward) of the shaft at spin Ω (rad/s).
pub fn left(parts: &[Part], ends: [End; 2], spin: f64, omega: f64) -> f64 {
    let columns = ends[0]
        .motions()
        .map(|start| parts.iter().fold(start, |state, part| part.carry(state, spin, omega)));
    let [a, b] = ends[1].vanish();
    columns[0][a] * columns[1][b] - columns[0][b] * columns[1][a]
}

/// The root of `of` nearest to `near`, looked for within a hundredth of it by halves.
pub fn root(of: impl Fn(f64) -> f64, near: f64) -> f64 {
    let mut width = 1e-9 * near.abs();
    let (mut low, mut high) = loop {
        let (low, high) = (near - width, near + width);
        if of(low) * of(high) <= 0.0 {
            break (low, high);
        }
        width *= 1.5;
        if width > 1e-2 * near.abs() {
            return f64::NAN;
        }
    };
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if of(middle) * of(low) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Largest distance from the axis while a rotor of one motion (frequency `natural`, rad/s, damping `rate`, 1/s, forced
/// as if its whole mass were at the unbalance: eccentricity `offset`, m) is run up from rest at a constant rate to `speed`
/// (rad/s) in `time` (s), and the speed at that instant. Runge–Kutta of fourth order.
pub fn run_up(natural: f64, rate: f64, offset: f64, speed: f64, time: f64) -> [f64; 2] {
    let gain = speed / time;
    let steps = 40_000;
    let h = time / f64::from(steps);
    // r̈ + c ṙ + ω² r = e (Ω² − iΩ̇) e^{iφ}, over [Re r, Im r, Re ṙ, Im ṙ].
    let rates = |t: f64, at: State| -> State {
        let (spin, turn) = (gain * t, 0.5 * gain * t * t);
        let (sin, cos) = turn.sin_cos();
        let push =
            [offset * (spin * spin * cos + gain * sin), offset * (spin * spin * sin - gain * cos)];
        let pull = |i: usize| push[i] - rate * at[2 + i] - natural * natural * at[i];
        [at[2], at[3], pull(0), pull(1)]
    };
    let step =
        |at: State, by: State, h: f64| -> State { std::array::from_fn(|i| at[i] + h * by[i]) };
    let mut at = [0.0; 4];
    let mut peak = [0.0, 0.0];
    for n in 0..steps {
        let t = f64::from(n) * h;
        let k1 = rates(t, at);
        let k2 = rates(t + 0.5 * h, step(at, k1, 0.5 * h));
        let k3 = rates(t + 0.5 * h, step(at, k2, 0.5 * h));
        let k4 = rates(t + h, step(at, k3, h));
        at = std::array::from_fn(|i| at[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        let radius = at[0].hypot(at[1]);
        if radius > peak[1] {
            peak = [gain * (t + h), radius];
        }
    }
    peak
}
