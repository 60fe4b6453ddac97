//! Closed forms and small models beside the moving bearing: a free top, the stiffest mode of a
//! preloaded bearing, a mass that bounces off a Hertz spring.

use std::f64::consts::PI;

type Vec3 = [f64; 3];

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `v` turned by `angle` about the unit vector `about` (Rodrigues).
fn turned(v: Vec3, about: Vec3, angle: f64) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    let (along, across) = (dot(v, about), cross(about, v));
    std::array::from_fn(|i| v[i] * cos + across[i] * sin + about[i] * along * (1.0 - cos))
}

/// A body of revolution that nothing touches.
#[derive(Clone, Copy, Debug)]
pub struct Top {
    pub axial: f64,
    pub transverse: f64,
}

impl Top {
    /// A ring of two radii and a length (m), kg/m³.
    pub fn ring(inner: f64, outer: f64, length: f64, density: f64) -> Top {
        let mass = PI * density * length * (outer - inner) * (outer + inner);
        let squares = inner * inner + outer * outer;
        Top {
            axial: mass * squares / 2.0,
            transverse: mass * (3.0 * squares + length * length) / 12.0,
        }
    }

    pub fn energy(&self, axis: Vec3, spin: Vec3) -> f64 {
        let along = dot(axis, spin);
        0.5 * (self.transverse * (dot(spin, spin) - along * along) + self.axial * along * along)
    }

    pub fn momentum(&self, axis: Vec3, spin: Vec3) -> Vec3 {
        let along = dot(axis, spin);
        std::array::from_fn(|i| {
            self.transverse * spin[i] + (self.axial - self.transverse) * along * axis[i]
        })
    }

    /// Axis and spin after `time`: both go round the angular momentum L at L/It.
    pub fn later(&self, axis: Vec3, spin: Vec3, time: f64) -> (Vec3, Vec3) {
        let momentum = self.momentum(axis, spin);
        let size = dot(momentum, momentum).sqrt();
        let about = momentum.map(|component| component / size);
        let angle = size / self.transverse * time;
        (turned(axis, about, angle), turned(spin, about, angle))
    }
}

/// Overlaps of both contacts of a ball that is squeezed by `squeeze` in all, and their slopes
/// dF/dδ, N/m: equal loads.
pub fn squeezed(stiffness: [f64; 2], squeeze: f64) -> [f64; 2] {
    let soft = stiffness.map(|k| k.powf(-2.0 / 3.0));
    [0, 1].map(|i| {
        let overlap = squeeze * soft[i] / (soft[0] + soft[1]);
        1.5 * stiffness[i] * overlap.sqrt()
    })
}

/// Pulsation (rad/s) of the fastest motion of a preloaded bearing with both races free: balls move
/// radially by cos θ against both races. Three coordinates (balls, inner, outer race), one of them
/// a common translation, so that a quadratic is left.
pub fn stiffest(slopes: [f64; 2], balls: f64, ball_mass: f64, race_mass: f64) -> f64 {
    let [inner, outer] = slopes.map(|slope| 0.5 * balls * slope);
    let mass = 0.5 * balls * ball_mass;
    let sum = (inner + outer) / mass + (inner + outer) / race_mass;
    let product = inner * outer * (2.0 / (mass * race_mass) + 1.0 / (race_mass * race_mass));
    (0.5 * (sum + (sum * sum - 4.0 * product).sqrt())).sqrt()
}

/// Relative speed error after a bounce of a unit mass off a spring of force x^(3/2), by Runge–Kutta
/// with step `step`: mean of the logarithms (base 2) over speeds and starts, so that contacts begin
/// and end anywhere in a step. Exact: it leaves as fast as it came.
pub fn bounce_error_log2(step: f64) -> f64 {
    const STARTS: usize = 20;
    const SPEEDS: usize = 20;
    let force = |x: f64| if x > 0.0 { -x * x.sqrt() } else { 0.0 };
    let mut sum = 0.0;
    for case in 0..STARTS * SPEEDS {
        let before = 1.0 + 0.5 * (case / STARTS) as f64 / SPEEDS as f64;
        let place = ((case % STARTS) as f64 + 0.5) / STARTS as f64;
        let (mut x, mut v) = (-place * step * before, before);
        while x >= 0.0 || v > 0.0 {
            let rate = |x: f64, v: f64| (v, force(x));
            let (a1, b1) = rate(x, v);
            let (a2, b2) = rate(x + 0.5 * step * a1, v + 0.5 * step * b1);
            let (a3, b3) = rate(x + 0.5 * step * a2, v + 0.5 * step * b2);
            let (a4, b4) = rate(x + step * a3, v + step * b3);
            x += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
            v += step / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
        }
        sum += ((v + before) / before).abs().log2() / (STARTS * SPEEDS) as f64;
    }
    sum
}
