//! Equilibrium of one ball bearing as the minimum of its potential energy over all coordinates.
//!
//! V = Σ (2/5) K δ₊^(5/2) over both contacts of every ball − loads · coordinates − ball forces ·
//! ball positions, with δ = e + r_ball − r_groove and e the distance of the ball centre from the
//! race's circle of groove centres. The unknowns are the inner race's five coordinates *and* two
//! coordinates of each ball (axial, radial) in the plane at its azimuth, all minimised together.
//!
//! Axes: the frame in which the inner race's coordinates count; the ball planes are fixed in the
//! outer race, azimuth from +Y towards +Z. Tilts ξ, λ: the inner race's orientation (body to
//! frame) is Ry(ξ)·Rz(λ), so their conjugate loads are the moment about the frame's Y and the
//! moment about the inner race's own Z.

use super::dense::Matrix;
use super::hyperdual::Jet;
use super::trust_region::{Expansion, minimise};
use std::f64::consts::TAU;

type Vec3 = [f64; 3];

/// The five coordinates of the inner race, x, y, z (m), ξ, λ (rad).
pub type Coordinates = [f64; 5];

/// Lengths in m, stiffness in N/m^1.5, angles in rad.
#[derive(Clone, Debug, PartialEq)]
pub struct OracleBearing {
    pub balls: usize,
    pub ball_radius: f64,
    /// `[centre_radius, centre_axial, groove_radius]` of the circle of groove centres.
    pub inner: [f64; 3],
    pub outer: [f64; 3],
    pub stiffness_inner: f64,
    pub stiffness_outer: f64,
    /// Azimuth of ball 0.
    pub phase: f64,
    /// How far each ball is ahead of its even place, rad; empty: evenly spaced.
    pub ahead: Vec<f64>,
    pub outer_position: Vec3,
    /// Outer race's body axes to the frame, row by row.
    pub outer_rotation: [Vec3; 3],
    /// Constant force on each ball (its weight), in the frame, N.
    pub ball_force: Vec3,
    /// Constant radial force on each ball (positive outward from the outer race's axis), N.
    pub ball_radial_force: f64,
    /// mω²: radial force per distance of the ball centre from the outer race's axis, N/m.
    pub centrifugal: f64,
}

/// What is known about one coordinate of the inner race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// Conjugate load, N or N·m.
    Load(f64),
    /// Coordinate itself, m or rad.
    Value(f64),
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OracleContact {
    /// N.
    pub load: f64,
    /// δ, m; negative when open.
    pub approach: f64,
    /// atan2(axial, radial), in the race's own axes, of the direction from the outer groove's
    /// centre to the ball (outer contact) or from the ball to the inner groove's centre (inner
    /// contact): positive when the inner race is displaced towards +X.
    pub angle: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OracleBall {
    /// rad.
    pub azimuth: f64,
    /// Axial and radial coordinate of the centre in the outer race's frame, m.
    pub position: [f64; 2],
    pub inner: OracleContact,
    pub outer: OracleContact,
}

#[derive(Clone, Debug, PartialEq)]
pub struct OracleSolution {
    pub coordinates: Coordinates,
    /// Loads that hold the inner race there, conjugate to the coordinates.
    pub loads: Coordinates,
    pub balls: Vec<OracleBall>,
    /// Norm of the energy's gradient over all free unknowns, moments divided by the pitch
    /// radius, N.
    pub residual: f64,
    pub iterations: usize,
}

/// One contact's share: derivatives over x, y, z, ξ, λ and the ball's axial and radial coordinate.
type Term = Jet<7>;

impl OracleBearing {
    /// Outer race at the origin, no forces on the balls.
    pub fn at_origin(
        balls: usize,
        ball_radius: f64,
        inner: [f64; 3],
        outer: [f64; 3],
        stiffness: [f64; 2],
        phase: f64,
    ) -> Self {
        OracleBearing {
            balls,
            ball_radius,
            inner,
            outer,
            stiffness_inner: stiffness[0],
            stiffness_outer: stiffness[1],
            phase,
            ahead: Vec::new(),
            outer_position: [0.0; 3],
            outer_rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            ball_force: [0.0; 3],
            ball_radial_force: 0.0,
            centrifugal: 0.0,
        }
    }

    pub fn azimuth(&self, ball: usize) -> f64 {
        let ahead = self.ahead.get(ball).copied().unwrap_or(0.0);
        self.phase + TAU * ball as f64 / self.balls as f64 + ahead
    }

    /// Length by which tilts are multiplied, so that all unknowns are lengths.
    fn lever(&self) -> f64 {
        0.5 * (self.inner[0] + self.outer[0])
    }

    /// The same coordinates with the position counted from the outer race's. Everything private
    /// here takes them so: a bearing a metre from the origin would lose four digits otherwise.
    fn relative_to_outer(&self, coordinates: &Coordinates) -> Coordinates {
        let [x, y, z] = self.outer_position;
        let offset = [x, y, z, 0.0, 0.0];
        std::array::from_fn(|i| coordinates[i] - offset[i])
    }

    fn outer_components(&self, v: Vec3) -> Vec3 {
        let r = &self.outer_rotation;
        std::array::from_fn(|i| r[0][i] * v[0] + r[1][i] * v[1] + r[2][i] * v[2])
    }

    /// (offset along the inner race's axis from its groove circle's plane, distance from the
    /// axis minus that circle's radius) of a ball centre.
    fn seen_from_inner(&self, race: &Coordinates, azimuth: f64, ball: [f64; 2]) -> [f64; 2] {
        let (sin_xi, cos_xi) = race[3].sin_cos();
        let (sin_lambda, cos_lambda) = race[4].sin_cos();
        let axis = self.outer_components([cos_xi * cos_lambda, sin_lambda, -sin_xi * cos_lambda]);
        let centre = self.outer_components([race[0], race[1], race[2]]);
        let point = [ball[0], ball[1] * azimuth.cos(), ball[1] * azimuth.sin()];
        let arm: Vec3 = std::array::from_fn(|i| point[i] - centre[i]);
        let axial = axis[0] * arm[0] + axis[1] * arm[1] + axis[2] * arm[2];
        let across: Vec3 = std::array::from_fn(|i| arm[i] - axial * axis[i]);
        let radial = across.iter().map(|c| c * c).sum::<f64>().sqrt();
        [axial - self.inner[1], radial - self.inner[0]]
    }

    /// How far a ball reaches into the inner groove, m; negative when apart.
    pub fn approach_inner(&self, race: &Coordinates, azimuth: f64, ball: [f64; 2]) -> f64 {
        let [axial, radial] = self.seen_from_inner(race, azimuth, ball);
        (axial * axial + radial * radial).sqrt() + (self.ball_radius - self.inner[2])
    }

    /// How far a ball reaches into the outer groove, m; negative when apart.
    pub fn approach_outer(&self, ball: [f64; 2]) -> f64 {
        let (axial, radial) = (ball[0] - self.outer[1], ball[1] - self.outer[0]);
        (axial * axial + radial * radial).sqrt() + (self.ball_radius - self.outer[2])
    }

    /// Energy of the inner contact; `None` when open.
    pub fn inner_term(&self, race: &Coordinates, azimuth: f64, ball: [f64; 2]) -> Option<Term> {
        if self.approach_inner(race, azimuth, ball) <= 0.0 {
            return None;
        }
        let (xi, lambda) = (Term::variable(race[3], 3), Term::variable(race[4], 4));
        let to_outer = |v: [Term; 3]| -> [Term; 3] {
            let r = &self.outer_rotation;
            std::array::from_fn(|i| v[0].scale(r[0][i]) + v[1].scale(r[1][i]) + v[2].scale(r[2][i]))
        };
        let cos_lambda = lambda.cos();
        let axis =
            to_outer([xi.cos() * cos_lambda, lambda.sin(), (xi.sin() * cos_lambda).scale(-1.0)]);
        let centre = to_outer(std::array::from_fn(|i| Term::variable(race[i], i)));
        let (along, out) = (Term::variable(ball[0], 5), Term::variable(ball[1], 6));
        let point = [along, out.scale(azimuth.cos()), out.scale(azimuth.sin())];
        let arm: [Term; 3] = std::array::from_fn(|i| point[i] - centre[i]);
        let axial = axis[0] * arm[0] + axis[1] * arm[1] + axis[2] * arm[2];
        let across: [Term; 3] = std::array::from_fn(|i| arm[i] - axial * axis[i]);
        let radial = (across[0].square() + across[1].square() + across[2].square()).sqrt();
        let distance = axial.shift(-self.inner[1]).square() + radial.shift(-self.inner[0]).square();
        Some(hertz_energy(
            distance.sqrt().shift(self.ball_radius - self.inner[2]),
            self.stiffness_inner,
        ))
    }

    /// Energy of the outer contact; `None` when open.
    pub fn outer_term(&self, ball: [f64; 2]) -> Option<Term> {
        if self.approach_outer(ball) <= 0.0 {
            return None;
        }
        let axial = Term::variable(ball[0], 5).shift(-self.outer[1]);
        let radial = Term::variable(ball[1], 6).shift(-self.outer[0]);
        let distance = (axial.square() + radial.square()).sqrt();
        Some(hertz_energy(distance.shift(self.ball_radius - self.outer[2]), self.stiffness_outer))
    }

    /// Energy of the forces on a ball.
    fn ball_force_term(&self, azimuth: f64, ball: [f64; 2]) -> Option<Term> {
        if self.ball_force == [0.0; 3] && self.ball_radial_force == 0.0 && self.centrifugal == 0.0 {
            return None;
        }
        let force = self.outer_components(self.ball_force);
        let radial = force[1] * azimuth.cos() + force[2] * azimuth.sin() + self.ball_radial_force;
        let (along, out) = (Term::variable(ball[0], 5), Term::variable(ball[1], 6));
        // Heights count from the pitch circle, so that the energy stays small.
        Some(
            along.scale(-force[0])
                + out.shift(-self.lever()).scale(-radial)
                + out.square().scale(-0.5 * self.centrifugal),
        )
    }

    /// Rounding of a term's energy: that of the approach, found from positions a pitch radius
    /// from the axis, times the load.
    fn noise(&self, term: &Term) -> f64 {
        let load = term.gradient[5].hypot(term.gradient[6]);
        f64::EPSILON * (term.value.abs() + 4.0 * load * self.lever())
    }

    fn ball_terms(&self, race: &Coordinates, azimuth: f64, ball: [f64; 2]) -> Vec<Term> {
        [
            self.inner_term(race, azimuth, ball),
            self.outer_term(ball),
            self.ball_force_term(azimuth, ball),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Where the two contacts of a ball would be equally squeezed: on the segment between the two
    /// groove centres seen in the ball's plane.
    fn ball_start(&self, race: &Coordinates, azimuth: f64) -> [f64; 2] {
        // The inner groove centre in the ball's plane, by following the ball plane's offset; two
        // passes suffice for a start.
        let mut inner = [self.inner[1] + self.outer[1], self.inner[0]];
        for _ in 0..3 {
            let [axial, radial] = self.seen_from_inner(race, azimuth, inner);
            inner = [inner[0] - axial, inner[1] - radial];
        }
        let apart = [inner[0] - self.outer[1], inner[1] - self.outer[0]];
        let distance = apart[0].hypot(apart[1]);
        let free = [self.inner[2] - self.ball_radius, self.outer[2] - self.ball_radius];
        let squeeze = distance - free[0] - free[1];
        let share = if squeeze > 0.0 {
            let soft = [self.stiffness_inner, self.stiffness_outer].map(|k| k.powf(-2.0 / 3.0));
            soft[1] / (soft[0] + soft[1])
        } else {
            0.5
        };
        let along = (free[1] + share * squeeze) / distance.max(f64::MIN_POSITIVE);
        [self.outer[1] + along * apart[0], self.outer[0] + along * apart[1]]
    }

    /// Minimum of one ball's energy between held races.
    fn relax_ball(&self, race: &Coordinates, ball: usize) -> [f64; 2] {
        let azimuth = self.azimuth(ball);
        let start = self.ball_start(race, azimuth);
        let minimum = minimise(&start, 1e-6, |p| {
            let mut all = Expansion {
                value: 0.0,
                noise: 0.0,
                gradient: vec![0.0; 2],
                hessian: vec![vec![0.0; 2]; 2],
            };
            for term in self.ball_terms(race, azimuth, [p[0], p[1]]) {
                all.value += term.value;
                all.noise += self.noise(&term);
                for i in 0..2 {
                    all.gradient[i] += term.gradient[5 + i];
                    for j in 0..2 {
                        all.hessian[i][j] += term.hessian[5 + i][5 + j];
                    }
                }
            }
            all
        });
        [minimum.point[0], minimum.point[1]]
    }

    /// Energy of the bearing and the loads that hold the inner race at given coordinates: the
    /// gradient of the energy with the balls where they come to rest.
    pub fn evaluate(&self, coordinates: &Coordinates) -> (f64, Coordinates, Vec<OracleBall>) {
        let race = self.relative_to_outer(coordinates);
        let positions: Vec<[f64; 2]> =
            (0..self.balls).map(|ball| self.relax_ball(&race, ball)).collect();
        let (energy, loads) = self.energy_and_loads(&race, &positions);
        (energy, loads, self.report_balls(&race, &positions))
    }

    fn energy_and_loads(&self, race: &Coordinates, balls: &[[f64; 2]]) -> (f64, Coordinates) {
        let (mut energy, mut loads) = (0.0, [0.0; 5]);
        for (ball, &position) in balls.iter().enumerate() {
            for term in self.ball_terms(race, self.azimuth(ball), position) {
                energy += term.value;
                for (load, slope) in loads.iter_mut().zip(term.gradient) {
                    *load += slope;
                }
            }
        }
        (energy, loads)
    }

    fn report_balls(&self, race: &Coordinates, balls: &[[f64; 2]]) -> Vec<OracleBall> {
        let hertz = |stiffness: f64, approach: f64| {
            stiffness * approach.max(0.0) * approach.max(0.0).sqrt()
        };
        let report = |(ball, &position): (usize, &[f64; 2])| {
            let azimuth = self.azimuth(ball);
            let [axial, radial] = self.seen_from_inner(race, azimuth, position);
            let approach_inner = self.approach_inner(race, azimuth, position);
            let approach_outer = self.approach_outer(position);
            OracleBall {
                azimuth,
                position,
                inner: OracleContact {
                    load: hertz(self.stiffness_inner, approach_inner),
                    approach: approach_inner,
                    angle: (-axial).atan2(-radial),
                },
                outer: OracleContact {
                    load: hertz(self.stiffness_outer, approach_outer),
                    approach: approach_outer,
                    angle: (position[0] - self.outer[1]).atan2(position[1] - self.outer[0]),
                },
            }
        };
        balls.iter().enumerate().map(report).collect()
    }

    /// Coordinates at which the races are concentric and parallel.
    pub fn aligned(&self) -> Coordinates {
        let axis =
            [self.outer_rotation[0][0], self.outer_rotation[1][0], self.outer_rotation[2][0]];
        let [x, y, z] = self.outer_position;
        [x, y, z, (-axis[2]).atan2(axis[0]), axis[1].asin()]
    }

    /// Equilibrium under `known`, from `start` or from aligned races.
    ///
    /// Where clearance leaves room the energy can have more than one minimum: `start` chooses.
    pub fn solve(&self, known: &[Known; 5], start: Option<Coordinates>) -> OracleSolution {
        let origin = self.aligned();
        let lever = self.lever();
        let unit = |i: usize| if i < 3 { 1.0 } else { lever };
        let mut coordinates = start.unwrap_or(origin);
        for (coordinate, what) in coordinates.iter_mut().zip(known) {
            if let Known::Value(value) = what {
                *coordinate = *value;
            }
        }
        let race = self.relative_to_outer(&coordinates);
        let origin = self.relative_to_outer(&origin);
        let free: Vec<usize> = (0..5).filter(|&i| matches!(known[i], Known::Load(_))).collect();
        let size = free.len() + 2 * self.balls;

        // Unknowns are lengths, counted from the start, so that they keep their digits.
        let ball_starts: Vec<[f64; 2]> =
            (0..self.balls).map(|ball| self.ball_start(&race, self.azimuth(ball))).collect();
        let unpack = |unknowns: &[f64]| {
            let mut moved = race;
            for (slot, &i) in free.iter().enumerate() {
                moved[i] += unknowns[slot] / unit(i);
            }
            let balls: Vec<[f64; 2]> = (0..self.balls)
                .map(|ball| {
                    let at = free.len() + 2 * ball;
                    [ball_starts[ball][0] + unknowns[at], ball_starts[ball][1] + unknowns[at + 1]]
                })
                .collect();
            (moved, balls)
        };
        let expand = |unknowns: &[f64]| {
            let (moved, balls) = unpack(unknowns);
            let mut hessian: Matrix = vec![vec![0.0; size]; size];
            let mut gradient = vec![0.0; size];
            let (mut value, mut noise) = (0.0_f64, 0.0_f64);
            for (slot, &i) in free.iter().enumerate() {
                if let Known::Load(load) = known[i] {
                    let work = load * (moved[i] - origin[i]);
                    value -= work;
                    noise += f64::EPSILON * work.abs();
                    gradient[slot] -= load / unit(i);
                }
            }
            for (ball, &position) in balls.iter().enumerate() {
                let own = free.len() + 2 * ball;
                let terms = self.ball_terms(&moved, self.azimuth(ball), position);
                if terms.is_empty() {
                    // Nothing acts on this ball: any stiffness keeps it where it is.
                    hessian[own][own] = 1e8;
                    hessian[own + 1][own + 1] = 1e8;
                }
                // (variable of the term, unknown, unit of the variable)
                let mut places: Vec<(usize, usize, f64)> =
                    free.iter().enumerate().map(|(slot, &i)| (i, slot, unit(i))).collect();
                places.extend([(5, own, 1.0), (6, own + 1, 1.0)]);
                for term in &terms {
                    value += term.value;
                    noise += self.noise(term);
                    for &(i, row, unit_i) in &places {
                        gradient[row] += term.gradient[i] / unit_i;
                        for &(j, column, unit_j) in &places {
                            hessian[row][column] += term.hessian[i][j] / (unit_i * unit_j);
                        }
                    }
                }
            }
            Expansion { value, noise, gradient, hessian }
        };

        let minimum = minimise(&vec![0.0; size], 1e-5, expand);
        let (race, balls) = unpack(&minimum.point);
        let (_, loads) = self.energy_and_loads(&race, &balls);
        for &i in &free {
            coordinates[i] = race[i] + if i < 3 { self.outer_position[i] } else { 0.0 };
        }
        OracleSolution {
            coordinates,
            loads,
            balls: self.report_balls(&race, &balls),
            residual: minimum.gradient_norm,
            iterations: minimum.iterations,
        }
    }
}

/// (2/5) K δ^(5/2) with its derivatives.
fn hertz_energy(approach: Term, stiffness: f64) -> Term {
    let delta = approach.value.max(0.0);
    let root = delta.sqrt();
    approach.chain(
        0.4 * stiffness * delta * delta * root,
        stiffness * delta * root,
        1.5 * stiffness * root,
    )
}
