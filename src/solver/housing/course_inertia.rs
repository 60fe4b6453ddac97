//! What inertia adds along a course of equilibria.
//!
//! With x(t) the equilibria, what explicit steps find is x + δ, and δ obeys M δ̈ + K δ = −M ẍ: the
//! course's own acceleration drives it, through K, M of the equilibrium it is at. For one natural motion of
//! ω started at rest, δ(t) = −(1/ω) ∫ sin ω(t − s) ẍ(s) ds.
//!
//! - Acceleration that is slow against 1/ω: |δ| = |ẍ|/ω², for a turning load (f/f_n)² of its swing, a second power of the
//!   speed. One that sets in suddenly swings to twice that.
//! - A velocity that jumps by Δv leaves a ringing of Δv/ω, a first power, which only damping takes
//!   away. It jumps at the start, where explicit steps begin at rest, at corners of the loads, and each time
//!   a node of the bore enters or leaves contact: the race is held by another stiffness from then
//!   on, so that the course has a kink there.
//!
//! Ringings add at most as their sizes, and like their squares if their phases fall at random. Each is counted
//! with the size that it has where it arises. Left out: the balls' mass, motions of the housing beyond the natural shapes that take part,
//! what loads do that jump themselves, and how balls without a cage stray.

use super::course_search::CourseSearch;
use super::held_motions::swinging_housing;
use super::inertia::{Coordinates, HousingMass, Mode, MovingBody, modes};
use crate::solver::solid::modes::Mode as NaturalShape;
use crate::solver::statics::AssemblySolution;
use std::f64::consts::TAU;

/// When to look at a course, and what moves.
#[derive(Clone, Debug, PartialEq)]
pub struct CourseLooks {
    /// s.
    pub start: f64,
    pub end: f64,
    /// Equal intervals in between: where several nodes change within one of them, only what they do
    /// to the velocity together is seen.
    pub count: usize,
    /// When loads and motions change their rates at once, s.
    pub corners: Vec<f64>,
    pub bodies: Vec<MovingBody>,
    pub seats: Vec<SeatLooks>,
}

/// A race in a housing.
#[derive(Clone, Debug, PartialEq)]
pub struct SeatLooks {
    /// Place of its body in the list of those that take part.
    pub race: usize,
    /// Natural shapes of the housing that take part beside those which follow the race.
    pub natural: Vec<NaturalShape>,
    /// Damping of the housing per mass and velocity, 1/s. No other is counted.
    pub damping: f64,
}

/// How far a course of equilibria is from the same with inertia, for the place of one body
/// across its axis; m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CourseInertia {
    /// The body's largest distance from the middle of its course.
    pub swing: f64,
    /// The body's largest distance from its nominal place: what its displacement is read as.
    pub displacement: f64,
    /// Largest |ẍ|/ω², the acceleration a mean over one period of what it drives.
    pub steady: f64,
    /// Ringing of a start at rest in the first equilibrium of a course that moves from the outset.
    pub start: f64,
    /// Intervals within which other nodes came to touch or a load has a corner, and the largest
    /// ringing of one of them.
    pub kinks: usize,
    pub largest_kink: f64,
    /// All that rings, the start included, at random phases: about this, at the end of the looks or
    /// where damping has left most of it.
    pub ringing: f64,
    /// Twice the steady part and all ringings in step: no more than this.
    pub bound: f64,
    /// Of the motion that the largest ringing is of, Hz.
    pub frequency: f64,
}

impl CourseInertia {
    /// The steady part and the ringing, as far as can be told.
    pub fn expected(&self) -> f64 {
        self.steady + self.ringing
    }

    /// What is expected, as a part of the displacement.
    pub fn of_displacement(&self) -> f64 {
        self.expected() / self.displacement.max(self.swing)
    }

    /// A length as a part of the swing; 0 of a course that does not move.
    pub fn part(&self, length: f64) -> f64 {
        if length == 0.0 { 0.0 } else { length / self.swing }
    }
}

/// Time until the second equilibrium of a look, as a part of the interval: what is between gives the
/// velocity. Rounding of positions, 1e-17 m, is nothing beside it.
const AHEAD: f64 = 0.02;
/// The housing's mass is found anew after so many looks.
const SAME_MASS: usize = 30;

/// An equilibrium of the course, and how it moves on.
struct Look {
    /// Of the bodies, and amplitudes of what bends behind them. What housings do beside following their races stands still along a
    /// course.
    place: Coordinates,
    velocity: Coordinates,
    /// In each bore.
    touching: Vec<Vec<bool>>,
    modes: Vec<Mode>,
    /// Corners of the loads that lie behind.
    corners: usize,
}

/// Whether the velocity jumps between two looks.
fn jumps(pair: &[Look]) -> bool {
    pair[0].touching != pair[1].touching || pair[0].corners != pair[1].corners
}

/// Looks along a course, what it comes to for each body that takes part; `at` solves for the equilibrium of a time.
///
/// # Errors
/// Those of `at`.
pub fn course_inertia<'b, E>(
    looks: &CourseLooks,
    search: &mut CourseSearch<'b>,
    mut at: impl FnMut(&mut CourseSearch<'b>, f64) -> Result<AssemblySolution, E>,
) -> Result<Vec<CourseInertia>, E> {
    let interval = (looks.end - looks.start) / looks.count as f64;
    let mut found = Vec::with_capacity(looks.count + 1);
    let mut housings: Vec<HousingMass> = Vec::new();
    let places = |found: &AssemblySolution| {
        let bodies = looks.bodies.iter().flat_map(|of| found.coordinates[of.body].iter());
        Coordinates::from_vec(bodies.chain(found.amplitudes.iter().flatten()).copied().collect())
    };
    for i in 0..=looks.count {
        let time = looks.start + interval * i as f64;
        let now = at(search, time)?;
        if i % SAME_MASS == 0 {
            let seats = search.bores().iter().zip(&looks.seats);
            let swinging = |(bore, of): (_, &SeatLooks)| {
                swinging_housing(bore, of.race, &of.natural, of.damping)
            };
            housings = seats.map(swinging).collect();
        }
        let later = at(search, time + AHEAD * interval)?;
        let place = places(&now);
        let touching = |loads: &[f64]| loads.iter().map(|load| *load > 0.0).collect();
        found.push(Look {
            velocity: (places(&later) - &place) / (AHEAD * interval),
            place,
            touching: now.seats.iter().map(|seat| touching(&seat.loads)).collect(),
            modes: modes(&now.with_shapes, &looks.bodies, &housings),
            corners: looks.corners.iter().filter(|corner| **corner <= time).count(),
        });
    }
    let damping: Vec<f64> = looks.seats.iter().map(|seat| seat.damping).collect();
    let bodies = 0..looks.bodies.len();
    Ok(bodies.map(|body| judge(&found, interval, &Of { body, damping: &damping })).collect())
}

/// Whose place is judged, and the damping of each housing.
struct Of<'d> {
    body: usize,
    damping: &'d [f64],
}

impl Of<'_> {
    /// y and z of the body.
    fn across(&self, of: &Coordinates) -> [f64; 2] {
        [of[5 * self.body + 1], of[5 * self.body + 2]]
    }

    fn decay(&self, mode: &Mode) -> f64 {
        let parts = self.damping.iter().zip(&mode.housings);
        0.5 * parts.map(|(damping, part)| damping * part).sum::<f64>()
    }
}

fn judge(looks: &[Look], interval: f64, of: &Of) -> CourseInertia {
    let first = ring(&looks[0], &looks[0].velocity, of);
    let (mut sum, mut squares) = (first.size, first.size * first.size);
    let (mut most, mut together, mut largest) = (sum, squares, first);
    let after = |pair: &[Look]| {
        jumps(pair).then(|| ring(&pair[1], &(&pair[1].velocity - &pair[0].velocity), of))
    };
    let rings: Vec<Option<Ring>> = looks.windows(2).map(after).collect();
    let (mut kinks, mut largest_kink) = (0, 0.0f64);
    for new in rings.iter().flatten() {
        kinks += 1;
        largest_kink = largest_kink.max(new.size);
        if new.size > largest.size {
            largest = *new;
        }
    }
    // Each dies out at the rate of the largest.
    let left = libm::exp(-largest.decay * interval);
    for new in &rings {
        (sum, squares) = (sum * left, squares * left * left);
        if let Some(Ring { size, .. }) = new {
            (sum, squares) = (sum + size, squares + size * size);
        }
        (most, together) = (most.max(sum), together.max(squares));
    }
    let steady = steady(looks, interval, largest.square, of);
    CourseInertia {
        swing: swing(looks, of),
        displacement: looks.iter().map(|look| length(of.across(&look.place))).fold(0.0, f64::max),
        steady,
        start: first.size,
        kinks,
        largest_kink,
        ringing: together.sqrt(),
        bound: 2.0 * steady + most,
        frequency: largest.square.max(0.0).sqrt() / TAU,
    }
}

/// What a jump of velocity leaves.
#[derive(Clone, Copy)]
struct Ring {
    /// Of the body across its axis, m.
    size: f64,
    /// ω² and decay (1/s) of the motion that rings most.
    square: f64,
    decay: f64,
}

/// The natural motions after a jump of velocity, all at their largest at once.
fn ring(look: &Look, jump: &Coordinates, of: &Of) -> Ring {
    let (mut size, mut most) = (0.0, -1.0);
    let (mut square, mut decay) = (f64::NAN, 0.0);
    for mode in &look.modes {
        let part = length(of.across(&mode.shape)) * along(mode, jump).abs();
        // Nothing holds it: what moves does not come back.
        let amplitude = if part == 0.0 { 0.0 } else { part / mode.square.max(0.0).sqrt() };
        size += amplitude;
        if amplitude > most {
            (most, square, decay) = (amplitude, mode.square, of.decay(mode));
        }
    }
    Ring { size: if look.modes.is_empty() { f64::NAN } else { size }, square, decay }
}

/// Largest displacement under the acceleration between looks one period apart.
fn steady(looks: &[Look], interval: f64, square: f64, of: &Of) -> f64 {
    let period = TAU / square.sqrt() / interval;
    let apart = if period > 1.0 { period.round() as usize } else { 1 };
    let apart = apart.min(looks.len() - 1);
    let time = apart as f64 * interval;
    (0..looks.len() - apart).fold(0.0, |largest: f64, i| {
        let acceleration = (&looks[i + apart].velocity - &looks[i].velocity) / time;
        let modes = &looks[i + apart / 2].modes;
        let moved = modes.iter().fold([0.0; 2], |[y, z], mode| {
            let part = along(mode, &acceleration) / mode.square;
            let [shape_y, shape_z] = of.across(&mode.shape);
            [y + part * shape_y, z + part * shape_z]
        });
        largest.max(length(moved))
    })
}

/// Part of a mode in rates of all that a course moves.
fn along(mode: &Mode, rates: &Coordinates) -> f64 {
    mode.momentum.rows(0, rates.len()).dot(rates)
}

fn length([y, z]: [f64; 2]) -> f64 {
    libm::hypot(y, z)
}

fn swing(looks: &[Look], of: &Of) -> f64 {
    let ends = |i: usize| {
        let places = looks.iter().map(|look| of.across(&look.place)[i]);
        let [low, high] = places
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        0.5 * (low + high)
    };
    let middle = [ends(0), ends(1)];
    let away = |look: &Look| {
        let [y, z] = of.across(&look.place);
        length([y - middle[0], z - middle[1]])
    };
    looks.iter().map(away).fold(0.0, f64::max)
}
