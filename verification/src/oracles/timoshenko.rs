//! Timoshenko's beam: tip deflection, and natural frequencies by a transfer matrix.

/// A straight beam of uniform section, SI.
#[derive(Clone, Copy)]
pub struct Beam {
    pub length: f64,
    pub area: f64,
    /// Second moment of area, m⁴.
    pub inertia: f64,
    pub young: f64,
    pub poisson: f64,
    pub density: f64,
    pub shear_coefficient: f64,
}

/// Shear coefficient of a rectangle, `height` along the force, from the exact field of a tip-loaded
/// bar (Hutchinson 2001, the value for which the beam equations agree with three-dimensional
/// elasticity to second order in height over wave length).
pub fn shear_coefficient(width: f64, height: f64, poisson: f64) -> f64 {
    let (a, b) = (0.5 * height, 0.5 * width);
    let polynomial = -12.0 * a * a - 15.0 * poisson * a * a + 5.0 * poisson * b * b;
    let mut c4 = 4.0 / 45.0 * a.powi(3) * b * polynomial;
    for n in 1..200 {
        let wave = std::f64::consts::PI * f64::from(n);
        let along = wave * a;
        let term = 16.0 * poisson * poisson * b.powi(5) * (along - b * (along / b).tanh());
        c4 += term / (wave.powi(5) * (1.0 + poisson));
    }
    let bracket = 9.0 * c4 / (4.0 * a.powi(5) * b) + poisson * (1.0 - b * b / (a * a));
    -2.0 * (1.0 + poisson) / bracket
}

impl Beam {
    fn shear_stiffness(&self) -> f64 {
        self.shear_coefficient * self.area * 0.5 * self.young / (1.0 + self.poisson)
    }

    /// Deflection under a force of 1 N at the tip, m.
    pub fn tip_deflection(&self) -> f64 {
        self.length.powi(3) / (3.0 * self.young * self.inertia)
            + self.length / self.shear_stiffness()
    }

    /// Zero where a clamped–free beam vibrates freely at ω: the two-by-two determinant of moment and
    /// shear force at the free end by those at the clamp.
    fn determinant(&self, omega: f64) -> f64 {
        // State: deflection/L, slope, moment·L/(EI), shear·L²/(EI) over x/L.
        let bending = self.young * self.inertia;
        let shear = bending / (self.shear_stiffness() * self.length.powi(2));
        let translation = self.density * self.area * omega * omega * self.length.powi(4) / bending;
        let rotation = self.density * self.inertia * omega * omega * self.length.powi(2) / bending;
        let rate = [
            [0.0, 1.0, 0.0, shear],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, -rotation, 0.0, -1.0],
            [-translation, 0.0, 0.0, 0.0],
        ];
        let t = exponential(rate);
        t[2][2] * t[3][3] - t[2][3] * t[3][2]
    }

    /// The lowest `count` natural frequencies, Hz, by scanning and bisection.
    pub fn frequencies(&self, count: usize) -> Vec<f64> {
        let slender =
            (self.young * self.inertia / (self.density * self.area)).sqrt() / self.length.powi(2);
        let mut found = Vec::new();
        let step = 0.2 * slender;
        let (mut low, mut at_low) = (step, self.determinant(step));
        while found.len() < count {
            let high = low + step;
            let at_high = self.determinant(high);
            if at_low * at_high <= 0.0 {
                let (mut a, mut b) = (low, high);
                for _ in 0..80 {
                    let middle = 0.5 * (a + b);
                    let inside = self.determinant(middle) * at_low > 0.0;
                    if inside { a = middle } else { b = middle }
                }
                found.push(0.5 * (a + b) / std::f64::consts::TAU);
            }
            (low, at_low) = (high, at_high);
        }
        found
    }
}

type Matrix = [[f64; 4]; 4];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut out = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            out[i][j] = (0..4).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    out
}

/// e^A by its series on A/2¹⁰, squared ten times.
fn exponential(a: Matrix) -> Matrix {
    let small = a.map(|row| row.map(|x| x / 1024.0));
    let mut sum = [[0.0; 4]; 4];
    for (i, row) in sum.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    let mut term = sum;
    for n in 1..12 {
        term = product(&term, &small).map(|row| row.map(|x| x / f64::from(n)));
        for i in 0..4 {
            for j in 0..4 {
                sum[i][j] += term[i][j];
            }
        }
    }
    for _ in 0..10 {
        sum = product(&sum, &sum);
    }
    sum
}
