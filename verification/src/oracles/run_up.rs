//! A rotor with a mass in its middle that is run up on two alike bearings: half of it, as a Timoshenko beam in polynomials
//! over the half length, stepped by Newmark's rule.
//!
//! Deflection y + i z and slope count as complex numbers. Balls have no inertia across their orbits and keep their distances:
//! each lies on the line between the centres of the two grooves at its azimuth, both of its contacts in series, the outer one
//! under the centrifugal force too.

use super::dense::solve_positive_definite;
use nalgebra::Complex;
use std::f64::consts::TAU;

type C = Complex<f64>;

/// SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct RunUp {
    pub length: f64,
    pub radius: f64,
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
    pub density: f64,
    /// In the middle, kg.
    pub mass: f64,
    /// There, kg·m.
    pub unbalance: f64,
    /// Force over mass and velocity, 1/s.
    pub damping: f64,
    /// Speed over time, s and rad/s: from 0 s on, straight between these, then it stays.
    pub speed: Vec<[f64; 2]>,
    pub support: Support,
    /// s.
    pub step: f64,
}

/// What carries either end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    /// A spring across, N/m; as good as a pin where it is stiff.
    Spring(f64),
    Balls(Balls),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balls {
    pub count: usize,
    pub ball_radius: f64,
    /// Groove bottom from the axis, and groove.
    pub inner: [f64; 2],
    pub outer: [f64; 2],
    /// N/m^1.5.
    pub stiffness: [f64; 2],
    /// Azimuth of the first at 0 s, rad, and speed of all, rad/s: without friction they keep it.
    pub phase: f64,
    pub orbit: f64,
    /// Of one, kg; of no effect without orbit.
    pub mass: f64,
}

/// Where the middle of the rotor was farthest off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    pub speed: f64,
    pub height: f64,
}

/// Polynomials of the deflection and of the slope; the latter begins at nothing in the middle.
const DEGREE: usize = 8;
const SIZE: usize = 2 * DEGREE;
const GAUSS: usize = 12;

/// Legendre polynomials of 2ξ − 1 and their slopes over ξ.
fn legendre(xi: f64) -> ([f64; DEGREE], [f64; DEGREE]) {
    let x = 2.0 * xi - 1.0;
    let (mut p, mut d) = ([0.0; DEGREE], [0.0; DEGREE]);
    (p[0], p[1], d[1]) = (1.0, x, 1.0);
    for n in 1..DEGREE - 1 {
        let k = n as f64;
        p[n + 1] = ((2.0 * k + 1.0) * x * p[n] - k * p[n - 1]) / (k + 1.0);
        d[n + 1] = d[n - 1] + (2.0 * k + 1.0) * p[n];
    }
    (p, d.map(|slope| 2.0 * slope))
}

/// Points and weights of Gauss on 0 to 1, by Newton from Chebyshev's points.
fn gauss() -> Vec<(f64, f64)> {
    let n = GAUSS as f64;
    let root = |i: usize| {
        let mut x = (TAU / 2.0 * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut before, mut now) = (1.0, x);
            for k in 1..GAUSS {
                let k = k as f64;
                (before, now) = (now, ((2.0 * k + 1.0) * x * now - k * before) / (k + 1.0));
            }
            slope = n * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..GAUSS).map(root).collect()
}

/// Deflection, slope, and the slopes of both over ξ, of each unknown at a place.
fn shapes(xi: f64) -> [[f64; SIZE]; 4] {
    let (p, d) = legendre(xi);
    let mut rows = [[0.0; SIZE]; 4];
    for i in 0..DEGREE {
        rows[0][i] = p[i];
        rows[1][DEGREE + i] = xi * p[i];
        rows[2][i] = d[i];
        rows[3][DEGREE + i] = p[i] + xi * d[i];
    }
    rows
}

type Square = Vec<Vec<f64>>;

impl RunUp {
    /// Mass, gyroscopic matrix over the speed, stiffness, of one half.
    fn matrices(&self) -> [Square; 3] {
        let half = 0.5 * self.length;
        let area = TAU / 2.0 * self.radius * self.radius;
        let moment = 0.25 * area * self.radius * self.radius;
        let nu = self.poisson_ratio;
        let kappa = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
        let shear = kappa * self.youngs_modulus / (2.0 * (1.0 + nu)) * area;
        let bending = self.youngs_modulus * moment;
        let zero = vec![vec![0.0; SIZE]; SIZE];
        let [mut mass, mut gyro, mut stiffness] = [zero.clone(), zero.clone(), zero];
        for (xi, weight) in gauss() {
            let [w, s, dw, ds] = shapes(xi);
            let by = weight * half;
            for i in 0..SIZE {
                for j in 0..SIZE {
                    let turned = self.density * moment * s[i] * s[j];
                    mass[i][j] += by * (self.density * area * w[i] * w[j] + turned);
                    gyro[i][j] += by * 2.0 * turned;
                    let strain = |k: usize| dw[k] / half - s[k];
                    stiffness[i][j] += by * bending * ds[i] * ds[j] / (half * half);
                    stiffness[i][j] += by * shear * strain(i) * strain(j);
                }
            }
        }
        let [w, ..] = shapes(0.0);
        for i in 0..SIZE {
            for j in 0..SIZE {
                mass[i][j] += 0.5 * self.mass * w[i] * w[j];
            }
        }
        [mass, gyro, stiffness]
    }

    /// Angle, speed and its rate.
    fn speed(&self, t: f64) -> [f64; 3] {
        let (mut angle, mut last) = (0.0, self.speed[0]);
        for pair in self.speed.windows(2) {
            let [[from, before], [to, after]] = [pair[0], pair[1]];
            let (rate, past) = ((after - before) / (to - from), t - from);
            if t < to {
                return [angle + past * (before + 0.5 * rate * past), before + rate * past, rate];
            }
            angle += 0.5 * (before + after) * (to - from);
            last = [to, after];
        }
        [angle + last[1] * (t - last[0]), last[1], 0.0]
    }

    /// Calls `see` with the time (s), the speed (rad/s), and how far the middle is off the axis (m), after each step.
    pub fn history(&self, end: f64, mut see: impl FnMut(f64, f64, f64)) {
        let [mass, gyro, stiffness] = self.matrices();
        let dt = self.step;
        // β = 1/4, γ = 1/2.
        let factor = |i: usize, j: usize| {
            mass[i][j] * (4.0 / (dt * dt) + 2.0 * self.damping / dt) + stiffness[i][j]
        };
        let matrix: Square = (0..SIZE).map(|i| (0..SIZE).map(|j| factor(i, j)).collect()).collect();
        let unit = |i: usize| {
            let column: Vec<f64> = (0..SIZE).map(|j| f64::from(u8::from(i == j))).collect();
            solve_positive_definite(&matrix, 0.0, &column).expect("mass and stiffness are positive")
        };
        let inverse: Square = (0..SIZE).map(unit).collect();
        let [end_w, end_s, ..] = shapes(1.0);
        let [middle_w, ..] = shapes(0.0);
        let times = |of: &Square, by: &[C]| -> Vec<C> {
            of.iter().map(|row| row.iter().zip(by).map(|(a, b)| b * *a).sum()).collect()
        };
        let along =
            |row: &[f64; SIZE], by: &[C]| -> C { row.iter().zip(by).map(|(a, b)| b * *a).sum() };
        let pushed =
            [end_w, end_s].map(|row| times(&inverse, &row.map(|value| C::new(value, 0.0))));
        let gives =
            [end_w, end_s].map(|row| [along(&row, &pushed[0]).re, along(&row, &pushed[1]).re]);
        let mut now = vec![C::new(0.0, 0.0); SIZE];
        let (mut speeds, mut rates) = (now.clone(), now.clone());
        let mut load = [C::new(0.0, 0.0); 2];
        for step in 1..=(end / dt).round() as usize {
            let t = step as f64 * dt;
            let [angle, speed, acceleration] = self.speed(t);
            let turning = C::new(0.0, angle).exp();
            let unbalance = turning * C::new(speed * speed, -acceleration) * (0.5 * self.unbalance);
            let kept: Vec<C> = (0..SIZE)
                .map(|i| {
                    now[i] * (4.0 / (dt * dt) + 2.0 * self.damping / dt)
                        + speeds[i] * (4.0 / dt + self.damping)
                        + rates[i]
                })
                .collect();
            let kept = times(&mass, &kept);
            let mut next = now.clone();
            let mut ahead = speeds.clone();
            // The gyroscopic part of a step is a hundredth of the matrix: three rounds leave 1e-6 of it.
            for _ in 0..3 {
                let gyroscopic = times(&gyro, &ahead);
                let right: Vec<C> = (0..SIZE)
                    .map(|i| kept[i] + unbalance * middle_w[i] + gyroscopic[i] * C::new(0.0, speed))
                    .collect();
                let free = times(&inverse, &right);
                let free_end = [along(&end_w, &free), along(&end_s, &free)];
                load = self.held(free_end, gives, load, t);
                for i in 0..SIZE {
                    next[i] = free[i] + pushed[0][i] * load[0] + pushed[1][i] * load[1];
                    ahead[i] = (next[i] - now[i]) * (2.0 / dt) - speeds[i];
                }
            }
            for i in 0..SIZE {
                let gone = next[i] - now[i];
                let rate = gone * (4.0 / (dt * dt)) - speeds[i] * (4.0 / dt) - rates[i];
                (speeds[i], rates[i], now[i]) = (ahead[i], rate, next[i]);
            }
            see(t, speed, along(&middle_w, &now).norm());
        }
    }

    /// Force and moment on the end where it goes to free + gives · load, by Newton with differences.
    fn held(&self, free: [C; 2], gives: [[f64; 2]; 2], from: [C; 2], t: f64) -> [C; 2] {
        let place = |load: &[f64; 4]| {
            let [f, m] = [C::new(load[0], load[1]), C::new(load[2], load[3])];
            [0, 1].map(|i| free[i] + f * gives[i][0] + m * gives[i][1])
        };
        let miss = |load: &[f64; 4]| {
            let [w, s] = place(load);
            let [f, m] = self.support.load(w, s, t);
            [load[0] - f.re, load[1] - f.im, load[2] - m.re, load[3] - m.im]
        };
        let mut load = [from[0].re, from[0].im, from[1].re, from[1].im];
        for _ in 0..30 {
            let here = miss(&load);
            let size = |of: &[f64; 4]| of[0].hypot(of[1]) + (of[2].hypot(of[3])) / 0.03;
            if size(&here) <= 1e-7 {
                break;
            }
            let mut slopes = [[0.0; 5]; 4];
            for j in 0..4 {
                let by = if j < 2 { 1e-3 } else { 1e-5 };
                let mut shifted = load;
                shifted[j] += by;
                let there = miss(&shifted);
                for i in 0..4 {
                    slopes[i][j] = (there[i] - here[i]) / by;
                }
            }
            for i in 0..4 {
                slopes[i][4] = -here[i];
            }
            let change = four(slopes);
            let mut part = 1.0;
            loop {
                let tried = [0, 1, 2, 3].map(|i| load[i] + part * change[i]);
                if size(&miss(&tried)) < size(&here) || part < 1e-3 {
                    load = tried;
                    break;
                }
                part *= 0.5;
            }
        }
        [C::new(load[0], load[1]), C::new(load[2], load[3])]
    }
}

/// Four equations by elimination with row exchange, the right-hand sides in the last column.
fn four(mut rows: [[f64; 5]; 4]) -> [f64; 4] {
    for k in 0..4 {
        let pivot = (k..4).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()));
        rows.swap(k, pivot.unwrap_or(k));
        for i in 0..4 {
            if i != k {
                let factor = rows[i][k] / rows[k][k];
                for j in k..5 {
                    rows[i][j] -= factor * rows[k][j];
                }
            }
        }
    }
    [0, 1, 2, 3].map(|i| rows[i][4] / rows[i][i])
}

impl Support {
    /// Force and moment (towards the slope) on the shaft's end at this deflection and slope.
    fn load(&self, w: C, s: C, t: f64) -> [C; 2] {
        match self {
            Support::Spring(stiffness) => [w * -*stiffness, C::new(0.0, 0.0)],
            Support::Balls(balls) => balls.load(w, s, t),
        }
    }
}

impl Balls {
    fn load(&self, w: C, s: C, t: f64) -> [C; 2] {
        let [inner, outer] = [self.inner[0] + self.inner[1], self.outer[0] - self.outer[1]];
        let closed = self.inner[1] + self.outer[1] - 2.0 * self.ball_radius;
        let pitch = 0.5 * (self.inner[0] + self.outer[0]);
        let thrown = self.mass * pitch * self.orbit * self.orbit;
        let soft = |k: f64| k.powf(-2.0 / 3.0);
        let stiffness = (soft(self.stiffness[0]) + soft(self.stiffness[1])).powf(-1.5);
        let mut sum = [C::new(0.0, 0.0); 2];
        for ball in 0..self.count {
            let azimuth = self.phase + TAU * ball as f64 / self.count as f64 + self.orbit * t;
            let outwards = C::new(azimuth.cos(), azimuth.sin());
            // Of the groove's centre on the inner race against that on the outer one.
            let axial = -inner * (s * outwards.conj()).re;
            let radial = inner - outer + (w * outwards.conj()).re;
            let distance = axial.hypot(radial);
            let overlap = distance - closed;
            if overlap > 0.0 {
                let load = match thrown > 0.0 {
                    true => self.inner_load(overlap, thrown),
                    false => stiffness * overlap * overlap.sqrt(),
                };
                let load = load / distance;
                sum[0] -= outwards * (load * radial);
                // The axial part at the groove's centre turns the shaft.
                sum[1] += outwards * (load * axial * inner);
            }
        }
        sum
    }

    /// Of a ball that is thrown outwards, by halves of what both contacts overlap.
    fn inner_load(&self, overlap: f64, thrown: f64) -> f64 {
        let [inner, outer] = self.stiffness;
        let load = |stiffness: f64, overlap: f64| stiffness * overlap * overlap.sqrt();
        let (mut low, mut high) = (0.0, overlap);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let held = load(inner, middle) + thrown;
            if held < load(outer, overlap - middle) { low = middle } else { high = middle }
        }
        load(inner, low)
    }
}
