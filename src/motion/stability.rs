//! The step that Runge–Kutta can take: from the Jacobian's eigenvalues at a state.

use crate::assembly::lists::{Bearing, Body};
use crate::assembly::loads::DrivenBody;
use crate::assembly::state::{ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate};
use crate::ch2_housing::bearing::cage::CageForce;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch2_housing::bore_contact::Penalty;
use crate::members::ball_set::BallSet;
use crate::motion::system::System;
use nalgebra::{Complex, DMatrix, Quaternion, Schur};

/// Where the step of an explicit method ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimit {
    /// Largest stable step of classical Runge–Kutta, s.
    pub step: f64,
    /// The eigenvalue that sets it, 1/s.
    pub eigenvalue: Complex<f64>,
    pub cause: Cause,
}

/// What makes the eigenvalue what it is: without it the step could be longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    Contact,
    CageContact,
    BallContact,
    FoundationSpring,
    Traction,
    ContactDamping,
    CageFriction,
    BallFriction,
    FoundationDashpot,
    ConnectionSpring,
    ConnectionDashpot,
    Seat,
    Solid,
}

impl Cause {
    pub const ALL: [Cause; 13] = [
        Cause::Contact,
        Cause::CageContact,
        Cause::BallContact,
        Cause::FoundationSpring,
        Cause::Traction,
        Cause::ContactDamping,
        Cause::CageFriction,
        Cause::BallFriction,
        Cause::FoundationDashpot,
        Cause::ConnectionSpring,
        Cause::ConnectionDashpot,
        Cause::Seat,
        Cause::Solid,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Cause::Contact => "stiffest contact",
            Cause::CageContact => "contact of the cage",
            Cause::BallContact => "contact between balls",
            Cause::FoundationSpring => "spring of the foundation",
            Cause::Traction => "traction onset",
            Cause::ContactDamping => "contact damping",
            Cause::CageFriction => "friction onset of the cage",
            Cause::BallFriction => "friction onset between balls",
            Cause::FoundationDashpot => "dashpot of the foundation",
            Cause::ConnectionSpring => "spring between bodies",
            Cause::ConnectionDashpot => "dashpot between bodies",
            Cause::Seat => "seat in a solid",
            Cause::Solid => "shape of a reduced solid",
        }
    }

    /// Takes it out of the equations; whether there was anything to take out.
    fn remove(self, system: &mut System) -> bool {
        let foundations = |system: &mut System, pick: fn(&mut DrivenBody) -> &mut [f64; 5]| {
            let mut any = false;
            for race in system.assembly.bodies.iter_mut().filter_map(Body::driven_mut) {
                any |= *pick(race) != [0.0; 5];
                *pick(race) = [0.0; 5];
            }
            any
        };
        let bearings = |system: &mut System, take: &dyn Fn(&mut BallSet, &mut Bearing) -> bool| {
            let System { sets, assembly, .. } = system;
            let mut any = false;
            for (set, bearing) in sets.iter_mut().zip(&mut assembly.bearings) {
                any |= take(set, bearing);
            }
            any
        };
        match self {
            // What is left when it is nothing else.
            Cause::Contact => false,
            Cause::Traction => bearings(system, &|set, _| {
                set.steps.traction = false;
                std::mem::replace(&mut set.laws.traction, TractionLaw::None) != TractionLaw::None
            }),
            Cause::ContactDamping => bearings(system, &|set, _| {
                let any = set.damping.iter().any(|factor| *factor != 0.0);
                set.damping.fill(0.0);
                any
            }),
            Cause::CageContact => bearings(system, &|_, bearing| {
                bearing.cage.as_mut().is_some_and(|cage| {
                    cage.contacts.force = CageForce::Penalty { stiffness: 0.0 };
                    true
                })
            }),
            Cause::CageFriction => bearings(system, &|_, bearing| {
                let cage = bearing.cage.as_mut();
                cage.is_some_and(|cage| std::mem::replace(&mut cage.contacts.friction, 0.0) != 0.0)
            }),
            Cause::BallContact | Cause::BallFriction => bearings(system, &|set, bearing| {
                let touching = set.meetings.iter().any(|meeting| meeting.normal_load > 0.0);
                let Some(law) = bearing.ball_contact.as_mut().filter(|_| touching) else {
                    return false;
                };
                let part = match self {
                    Cause::BallContact => &mut law.stiffness,
                    _ => &mut law.friction,
                };
                std::mem::replace(part, 0.0) != 0.0
            }),
            Cause::FoundationSpring => foundations(system, |race| &mut race.foundation_stiffness),
            Cause::FoundationDashpot => foundations(system, |race| &mut race.foundation_damping),
            Cause::Seat => {
                for seat in &mut system.assembly.seats {
                    seat.penalty = Penalty::PerArea(0.0);
                }
                !system.assembly.seats.is_empty()
            }
            Cause::Solid => {
                // Without springs and forces shapes swing at no frequency.
                for solid in &mut system.assembly.solids {
                    solid.frequencies.fill(0.0);
                    for surface in &mut solid.surfaces {
                        surface.shapes.fill(0.0);
                    }
                }
                !system.assembly.solids.is_empty()
            }
            Cause::ConnectionSpring | Cause::ConnectionDashpot => {
                let mut any = false;
                for connection in &mut system.assembly.connections {
                    any |= connection.take_out(self == Cause::ConnectionSpring);
                }
                any
            }
        }
    }
}

impl StepLimit {
    fn decays(eigenvalue: Complex<f64>) -> bool {
        eigenvalue.re.abs() > eigenvalue.im.abs()
    }

    /// What sets the step, and how fast it is.
    pub fn reason(&self) -> String {
        let (re, im) = (self.eigenvalue.re, self.eigenvalue.im);
        let name = self.cause.name();
        if !StepLimit::decays(self.eigenvalue) {
            return format!("{name}: oscillation at {:.0} Hz", im.abs() / std::f64::consts::TAU);
        }
        let what = match self.cause {
            Cause::Traction | Cause::CageFriction | Cause::BallFriction => "slip",
            _ => "motion",
        };
        format!("{name}: {what} decays at {:.2e} 1/s", -re)
    }
}

/// |1 + z + z²/2 + z³/6 + z⁴/24|, the growth of one step.
pub fn growth(z: Complex<f64>) -> f64 {
    let one = Complex::new(1.0, 0.0);
    (one + z * (one + z / 2.0 * (one + z / 3.0 * (one + z / 4.0)))).norm()
}

/// One direction in which a state may be moved.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Direction {
    /// An entry of the state vector that is a position (m).
    Position(usize),
    /// An entry that is a velocity or a spin (m/s, rad/s).
    Rate(usize),
    /// Rotation (rad) of the body whose 13 entries start at `body` about inertial axis `axis`.
    Turn { body: usize, axis: usize },
}

impl Direction {
    fn step(self, state: &[f64], ball_radius: f64) -> f64 {
        match self {
            // Far below an overlap of 1 µm, at the races' radius too, and a creep of 1e-5 of the
            // rolling speed.
            Direction::Position(_) => 1e-10,
            Direction::Turn { .. } => 1e-9,
            Direction::Rate(entry) => 1e-7 * state[entry].abs().max(ball_radius),
        }
    }

    fn shift(self, state: &mut [f64], by: f64) {
        match self {
            Direction::Position(entry) | Direction::Rate(entry) => state[entry] += by,
            Direction::Turn { body, axis } => {
                // dq = ½ dθ q.
                let mut turn = [0.0; 3];
                turn[axis] = by;
                let q = [0, 1, 2, 3].map(|i| state[body + ORIENTATION + i]);
                for (i, change) in quaternion_rate(q, turn).into_iter().enumerate() {
                    state[body + ORIENTATION + i] += change;
                }
            }
        }
    }

    /// How fast the rates move the state in this direction.
    fn rate(self, state: &[f64], rates: &[f64]) -> f64 {
        match self {
            Direction::Position(entry) | Direction::Rate(entry) => rates[entry],
            Direction::Turn { body, axis } => {
                // ω = 2 dq/dt q*, vector part.
                let quaternion = |of: &[f64]| {
                    let q = [0, 1, 2, 3].map(|i| of[body + ORIENTATION + i]);
                    Quaternion::new(q[0], q[1], q[2], q[3])
                };
                2.0 * (quaternion(rates) * quaternion(state).conjugate()).imag()[axis]
            }
        }
    }
}

/// Jacobian of the rates by central differences, over the directions that matter: the orientation
/// of a ball and the energy ledger do not feed back on the motion, padding does not move.
pub fn jacobian(system: &mut System, t: f64, state: &[f64]) -> DMatrix<f64> {
    let directions = directions(system);
    let mut rates = vec![0.0; state.len()];
    let mut shifted = state.to_vec();
    let mut matrix = DMatrix::zeros(directions.len(), directions.len());
    let radii = system.assembly.bearings.iter().map(|bearing| bearing.geometry.ball_radius);
    let radius = Some(radii.fold(f64::INFINITY, f64::min)).filter(|radius| radius.is_finite());
    // Of bodies on springs alone some length serves as well.
    let radius = radius.unwrap_or(1e-2);
    for (column, direction) in directions.iter().enumerate() {
        let step = direction.step(state, radius);
        for sign in [1.0, -1.0] {
            shifted.copy_from_slice(state);
            direction.shift(&mut shifted, sign * step);
            system.evaluate(t, &shifted, &mut rates);
            for (row, direction) in directions.iter().enumerate() {
                matrix[(row, column)] += sign * direction.rate(&shifted, &rates) / (2.0 * step);
            }
        }
    }
    matrix
}

fn directions(system: &System) -> Vec<Direction> {
    let mut directions = Vec::new();
    let mut add = |of: &dyn Fn(usize) -> usize| {
        for i in 0..3 {
            directions.push(Direction::Position(of(POSITION + i)));
            directions.push(Direction::Rate(of(VELOCITY + i)));
            directions.push(Direction::Rate(of(SPIN + i)));
        }
    };
    for layout in system.sets.iter().map(|set| set.layout) {
        for ball in 0..layout.balls {
            add(&|component| layout.ball(component) + ball);
        }
    }
    let bodies = system.assembly.bodies.iter().enumerate();
    let moving: Vec<usize> = bodies
        .filter(|(_, body)| body.moves())
        .map(|(index, _)| system.places.body(index))
        .collect();
    for body in &moving {
        add(&|component| body + component);
    }
    for body in moving {
        directions.extend((0..3).map(|axis| Direction::Turn { body, axis }));
    }
    for (solid, at) in system.assembly.solids.iter().zip(&system.solids) {
        for shape in 0..solid.count() {
            directions.push(Direction::Position(at + shape));
            directions.push(Direction::Rate(at + solid.count() + shape));
        }
    }
    for (shaft, at) in system.assembly.shafts.iter().zip(&system.shafts) {
        let half = shaft.amplitudes();
        directions.extend((0..half).map(|k| Direction::Position(at + k)));
        directions.extend((half..2 * half).map(|k| Direction::Rate(at + k)));
    }
    for (connection, at) in system.assembly.connections.iter().zip(&system.connections) {
        directions.extend((0..6 * connection.maxwell().len()).map(|k| Direction::Position(at + k)));
    }
    directions
}

/// Largest stable step at a state; `None` where nothing is stiff (no contact at all).
pub fn step_limit(system: &mut System, t: f64, state: &[f64]) -> Option<StepLimit> {
    let (step, eigenvalue) = limiting(system, t, state)?;
    let cause = cause(system, t, state, step, eigenvalue);
    Some(StepLimit { step, eigenvalue, cause })
}

/// The part of the equations without which the step could grow most; the contacts, if none makes
/// a tenth of difference.
fn cause(system: &mut System, t: f64, state: &[f64], step: f64, eigenvalue: Complex<f64>) -> Cause {
    let candidates: &[Cause] = if StepLimit::decays(eigenvalue) {
        &[
            Cause::Traction,
            Cause::ContactDamping,
            Cause::CageFriction,
            Cause::BallFriction,
            Cause::FoundationDashpot,
            Cause::ConnectionDashpot,
        ]
    } else {
        &[
            Cause::CageContact,
            Cause::BallContact,
            Cause::FoundationSpring,
            Cause::ConnectionSpring,
            Cause::Seat,
            Cause::Solid,
        ]
    };
    let mut found = (1.1 * step, Cause::Contact);
    for &candidate in candidates {
        let assembly = system.assembly.clone();
        let sets: Vec<_> =
            system.sets.iter().map(|s| (s.laws.clone(), s.damping.clone(), s.steps)).collect();
        let longer = if candidate.remove(system) {
            system.renew_seats();
            limiting(system, t, state).map_or(f64::INFINITY, |limit| limit.0)
        } else {
            step
        };
        system.assembly = assembly;
        system.renew_seats();
        for (set, (laws, damping, steps)) in system.sets.iter_mut().zip(sets) {
            (set.laws, set.damping, set.steps) = (laws, damping, steps);
        }
        if longer > found.0 {
            found = (longer, candidate);
        }
    }
    found.1
}

/// The largest stable step and the eigenvalue that sets it.
fn limiting(system: &mut System, t: f64, state: &[f64]) -> Option<(f64, Complex<f64>)> {
    let matrix = jacobian(system, t, state);
    let eigenvalues = eigenvalues(&matrix)?;
    let largest = eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    eigenvalues
        .iter()
        // Slow modes may grow physically (a pendulum upside down) and set no step.
        .filter(|value| value.norm() > 1e-2 * largest)
        .map(|&eigenvalue| (limit_of(eigenvalue), eigenvalue))
        .filter(|limit| limit.0.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Eigenvalues by the QR algorithm, which stalls on some matrices of high symmetry (a preloaded
/// bearing at rest): then with a small uneven shift of the diagonal, which breaks the tie.
fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let size = matrix.nrows();
    let scale = matrix.amax();
    for attempt in 0..4 {
        let mut tried = matrix.clone();
        for i in 0..size {
            // Far below what the finite differences of the Jacobian are good to.
            tried[(i, i)] += 1e-9 * scale * f64::from(attempt) * i as f64 / size as f64;
        }
        if let Some(schur) = Schur::try_new(tried, f64::EPSILON, 200 * size) {
            return Some(schur.complex_eigenvalues().iter().copied().collect());
        }
    }
    None
}

/// Largest h at which a step grows no faster than the motion itself (|R(hλ)| ≤ e^(h·Re λ) for a
/// growing one), by a march to the first excess and bisection.
fn limit_of(eigenvalue: Complex<f64>) -> f64 {
    let size = eigenvalue.norm();
    if size == 0.0 {
        return f64::INFINITY;
    }
    // Rounding of undamped modes: growth of 1e-6 a step is no instability of the method.
    let own = eigenvalue.re.max(0.0);
    let stable = |h: f64| growth(eigenvalue * h) <= libm::exp(own * h) + 1e-6;
    let mut low = 1e-3 / size;
    if !stable(low) {
        return f64::INFINITY;
    }
    let mut high = low;
    while stable(high) && high * size < 10.0 {
        low = high;
        high *= 1.05;
    }
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if stable(middle) { low = middle } else { high = middle }
    }
    low
}
