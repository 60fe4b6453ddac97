//! The inner race as a mass on the contacts' stiffness: what inertia makes of varying compliance.
//!
//! The static path q(φ) over one ball pitch is given, with every contact's load and approach there.
//! Around it the race, its mass M increased by the balls' share, swings on the contacts in series,
//! linearised: M a + C (v + what the path itself squeezes) + K (u − q(φ)) = 0.

use std::f64::consts::TAU;

use crate::oracles::statics::OracleSolution;

type Vec2 = [f64; 2];
type Matrix2 = [[f64; 2]; 2];

/// What is known at one position of the ball set.
#[derive(Clone, Copy, Default)]
struct Place {
    path: Vec2,
    stiffness: Matrix2,
    damping: Matrix2,
    mass: Matrix2,
    /// Force per rad of the ball set by which damping answers the path's own squeezing.
    drag: Vec2,
}

pub struct Masses {
    pub race: f64,
    pub ball: f64,
    /// Hunt–Crossley factor, s/m: F = K δ^(3/2) (1 + 3/2 α dδ/dt).
    pub alpha: f64,
}

/// Contact of one ball with both races in series: stiffness, damping, ball's share of the motion.
fn in_series(solution: &OracleSolution, ball: usize, alpha: f64) -> Option<(f64, f64, f64)> {
    let ball = &solution.balls[ball];
    if ball.inner.load <= 0.0 || ball.outer.load <= 0.0 {
        return None;
    }
    let [inner, outer] = [ball.inner, ball.outer].map(|c| 1.5 * c.load / c.approach);
    let share = inner / (inner + outer);
    let damping = 1.5 * alpha * ball.inner.load;
    let damping = damping * ((1.0 - share).powi(2) + share * share);
    Some((inner * outer / (inner + outer), damping, share))
}

/// Places at evenly spaced positions over one ball pitch; the last precedes the first.
fn places(solutions: &[OracleSolution], masses: &Masses) -> Vec<Place> {
    let count = solutions.len();
    let balls = solutions[0].balls.len();
    let between = TAU / balls as f64 / count as f64;
    let squeeze = |at: usize, ball: usize| -> f64 {
        // A pitch on, each ball stands where the next one stood.
        let ball = (ball + at / count) % balls;
        let contact = &solutions[at % count].balls[ball];
        contact.inner.approach.max(0.0) + contact.outer.approach.max(0.0)
    };
    let mut places = Vec::new();
    for (at, solution) in solutions.iter().enumerate() {
        let mut place = Place {
            path: [solution.coordinates[1], solution.coordinates[2]],
            mass: [[masses.race, 0.0], [0.0, masses.race]],
            ..Place::default()
        };
        for (ball, state) in solution.balls.iter().enumerate() {
            let Some((stiffness, damping, share)) = in_series(solution, ball, masses.alpha) else {
                continue;
            };
            let (sin, cos) = state.azimuth.sin_cos();
            let normal = [cos, sin];
            let before = if at == 0 {
                squeeze(count - 1, (ball + balls - 1) % balls)
            } else {
                squeeze(at - 1, ball)
            };
            let rate = (squeeze(at + 1, ball) - before) / (2.0 * between);
            for i in 0..2 {
                // More overlap of a ball pushes the race away from it.
                place.drag[i] -= damping * rate * normal[i];
                for j in 0..2 {
                    let along = normal[i] * normal[j];
                    place.stiffness[i][j] += stiffness * along;
                    place.damping[i][j] += damping * along;
                    place.mass[i][j] += masses.ball * share * share * along;
                }
            }
        }
        places.push(place);
    }
    places
}

/// a + (b − a) · part of everything known at two places.
fn between(a: &Place, b: &Place, part: f64) -> Place {
    let mix = |a: f64, b: f64| a + (b - a) * part;
    let vector = |a: Vec2, b: Vec2| -> Vec2 { std::array::from_fn(|i| mix(a[i], b[i])) };
    let matrix = |a: Matrix2, b: Matrix2| -> Matrix2 {
        std::array::from_fn(|i| std::array::from_fn(|j| mix(a[i][j], b[i][j])))
    };
    Place {
        path: vector(a.path, b.path),
        stiffness: matrix(a.stiffness, b.stiffness),
        damping: matrix(a.damping, b.damping),
        mass: matrix(a.mass, b.mass),
        drag: vector(a.drag, b.drag),
    }
}

/// Steady path y, z of the race over one ball pitch, at the places of the static solutions, with
/// the ball set going round at `orbit` rad/s.
pub fn steady(solutions: &[OracleSolution], masses: &Masses, orbit: f64) -> Vec<Vec2> {
    let places = places(solutions, masses);
    let count = places.len();
    let time = TAU / solutions[0].balls.len() as f64 / count as f64 / orbit;
    let substeps = (time / 1e-6).ceil();
    let step = time / substeps;
    let (mut at, mut velocity) = (places[0].path, [0.0; 2]);
    // Until 50 ms have died out.
    let pitches = (50e-3 / (time * count as f64)).ceil() as usize + 1;
    let mut last = Vec::new();
    for _ in 0..pitches {
        last.clear();
        for i in 0..count {
            let (here, next) = (&places[i], &places[(i + 1) % count]);
            last.push(at);
            let path_rate: Vec2 = std::array::from_fn(|k| (next.path[k] - here.path[k]) / time);
            let acceleration = |part: f64, at: Vec2, velocity: Vec2| -> Vec2 {
                let now = between(here, next, part);
                let force: Vec2 = std::array::from_fn(|i| {
                    let mut force = now.drag[i] * orbit;
                    for j in 0..2 {
                        force -= now.stiffness[i][j] * (at[j] - now.path[j]);
                        force -= now.damping[i][j] * (velocity[j] - path_rate[j]);
                    }
                    force
                });
                let [[a, b], [c, d]] = now.mass;
                let determinant = a * d - b * c;
                [
                    (d * force[0] - b * force[1]) / determinant,
                    (a * force[1] - c * force[0]) / determinant,
                ]
            };
            let along = |a: Vec2, b: Vec2, h: f64| -> Vec2 { [a[0] + h * b[0], a[1] + h * b[1]] };
            for sub in 0..substeps as usize {
                let part = |more: f64| (sub as f64 + more) / substeps;
                let (x1, v1) = (at, velocity);
                let a1 = acceleration(part(0.0), x1, v1);
                let (x2, v2) = (along(at, v1, 0.5 * step), along(velocity, a1, 0.5 * step));
                let a2 = acceleration(part(0.5), x2, v2);
                let (x3, v3) = (along(at, v2, 0.5 * step), along(velocity, a2, 0.5 * step));
                let a3 = acceleration(part(0.5), x3, v3);
                let (x4, v4) = (along(at, v3, step), along(velocity, a3, step));
                let a4 = acceleration(part(1.0), x4, v4);
                for k in 0..2 {
                    at[k] += step / 6.0 * (v1[k] + 2.0 * (v2[k] + v3[k]) + v4[k]);
                    velocity[k] += step / 6.0 * (a1[k] + 2.0 * (a2[k] + a3[k]) + a4[k]);
                }
            }
        }
    }
    last
}
