//! Error control: the step size for a requested accuracy of the races' motion.
//!
//! The error of a displacement is relative to the largest overlap of a contact so far, that of a velocity to this
//! displacement times the frequency of the body on its contacts. The largest of these quotients over `accuracy` times
//! [`SHARE`] is the error norm, below one for an accepted step.

use crate::assembly::lists::Assembly;
use crate::assembly::places::Places;
use crate::ch2_housing::bearing::contact::normal_stiffness;
use crate::members::bearing::Bearing;
use crate::members::flexible_shaft::{ElasticShaft, Section};
use crate::members::state::{BODY, LANES, Layout, ORIENTATION, POSITION, SPIN, VELOCITY};
use crate::motion::system::System;
use serde::{Deserialize, Serialize};

/// An attempted step: the new state and its estimated error.
#[derive(Clone, Debug, Default)]
pub struct Attempt {
    pub state: Vec<f64>,
    pub error: Vec<f64>,
}

impl Attempt {
    pub fn new(length: usize) -> Attempt {
        Attempt { state: vec![0.0; length], error: vec![0.0; length] }
    }
}

/// Allowed error of one step over the accuracy of the run: errors of a bearing that oscillates undamped for some
/// hundred periods add up by this factor.
pub const SHARE: f64 = 0.02;
/// Smallest scale of displacements, in ball radii: some nanometres.
const FLOOR: f64 = 1e-6;
/// Steps are shorter than the estimate by this factor.
const SAFETY: f64 = 0.9;
const LEAST_ERROR: f64 = 0.02;
const SHORTEST: f64 = 0.2;
const LONGEST: f64 = 2.5;

/// Memory of the error control from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Scale of displacements: largest overlap so far, m.
    pub displacement: f64,
    /// Error norm of the previous step.
    pub previous_error: f64,
    /// Smallest accepted step, s; zero before the first.
    pub smallest: f64,
    pub largest: f64,
}

#[derive(Clone, Debug)]
pub struct Controller {
    pub memory: Memory,
    accuracy: f64,
    /// Order of the error estimate.
    order: f64,
    stiffness: f64,
    /// Of each bearing.
    balls: Vec<(Layout, Scale)>,
    /// First entry of each moving body, with its scales.
    bodies: Vec<(usize, Scale)>,
    /// Modes of reduced solids.
    shapes: Vec<ShapeScale>,
    /// First of six elongations of each Maxwell element, with the arm that turns its angles into displacements, m.
    elongations: Vec<(usize, f64)>,
}

/// Scale of a mode of a reduced solid.
#[derive(Clone, Copy, Debug)]
struct ShapeScale {
    /// Entries of its displacement and of its velocity.
    at: [usize; 2],
    /// Largest displacement of a bore surface for a unit of it.
    reach: f64,
    /// rad/s.
    frequency: f64,
    /// Scale of the lightest race in the solid.
    race: Scale,
}

/// Scales of all modes. Errors count as displacements of a bore surface; the velocity of a mode slower than the race on
/// its balls counts with the frequency of the race.
fn shapes(assembly: &Assembly, places: &Places) -> Vec<ShapeScale> {
    let mut all = Vec::new();
    for (index, (solid, at)) in assembly.solids.iter().zip(places.solids(assembly)).enumerate() {
        let mut reach = vec![0.0f64; solid.count()];
        let mut race: Option<Scale> = None;
        for seat in assembly.seats.iter().filter(|seat| seat.solid == index) {
            for (reach, here) in reach.iter_mut().zip(solid.surfaces[seat.surface].largest()) {
                *reach = reach.max(here);
            }
            let body = seat.race.body;
            if let Some(mass) = assembly.bodies[body].inertia().map(|inertia| inertia.mass)
                && race.is_none_or(|other| mass < other.mass)
            {
                race = Some(Scale { mass, arm: arm(assembly, body) });
            }
        }
        let Some(race) = race else { continue };
        let count = solid.count();
        all.extend((0..count).map(|k| ShapeScale {
            at: [at + k, at + count + k],
            reach: reach[k],
            frequency: solid.frequencies[k],
            race,
        }));
    }
    for (shaft, at) in assembly.shafts.iter().zip(places.shafts(assembly)) {
        all.extend(of_shaft(assembly, shaft, at));
    }
    all.extend(of_cages(assembly, places));
    all
}

/// Modes of cages with contact nodes, by the displacement of these nodes.
fn of_cages(assembly: &Assembly, places: &Places) -> Vec<ShapeScale> {
    let first = places.floating(assembly);
    let mut all = Vec::new();
    for cage in assembly.bearings.iter().filter_map(|bearing| bearing.cage.as_ref()) {
        let Some(nodes) = &cage.nodes else { continue };
        let (solid, at) = (&assembly.floating[nodes.floating], first[nodes.floating]);
        let race = Scale { mass: solid.frame.mass, arm: arm(assembly, cage.body) };
        let count = solid.count();
        all.extend((0..count).map(|k| ShapeScale {
            at: [at + k, at + count + k],
            reach: nodes.largest[k],
            frequency: solid.frame.frequencies[k],
            race,
        }));
    }
    all
}

/// Modes of a flexible shaft, by the displacement of its attachments.
fn of_shaft(
    assembly: &Assembly,
    shaft: &ElasticShaft,
    at: usize,
) -> impl Iterator<Item = ShapeScale> {
    let mut reach = vec![0.0f64; shaft.amplitudes()];
    let mounts = assembly.bearings.iter().flat_map(|bearing| bearing.mounts);
    let mounts = mounts.chain(assembly.connections.iter().flat_map(|of| of.ends));
    for mount in mounts.filter(|mount| mount.body == shaft.body) {
        let section = shaft.shapes.section(mount.along);
        let Section { deflection, stretch, .. } = &section;
        let all = deflection.iter().chain(deflection).chain(stretch);
        for (reach, moved) in reach.iter_mut().zip(all) {
            *reach = reach.max(moved.abs());
        }
    }
    let mass = assembly.bodies[shaft.body].inertia().map_or(1.0, |inertia| inertia.mass);
    let race = Scale { mass, arm: arm(assembly, shaft.body) };
    let count = reach.len();
    reach.into_iter().zip(shaft.frequencies()).enumerate().map(move |(k, (reach, frequency))| {
        ShapeScale { at: [at + k, at + count + k], reach, frequency, race }
    })
}

/// Maxwell elements of all connections, with the longer arm of the two joined bodies.
fn elongations(assembly: &Assembly, places: &Places) -> Vec<(usize, f64)> {
    let mut all = Vec::new();
    for (connection, at) in assembly.connections.iter().zip(places.connections(assembly)) {
        let [first, second] = connection.ends.map(|mount| arm(assembly, mount.body));
        let elements = 0..connection.maxwell().len();
        all.extend(elements.map(|k| (at + 6 * k, first.max(second))));
    }
    all
}

/// Scales of lengths and displacements of a body.
#[derive(Clone, Copy, Debug)]
struct Scale {
    mass: f64,
    /// Turns errors of angles into those of displacements, m.
    arm: f64,
}

/// Pitch radius of the first bearing of a body.
fn arm(assembly: &Assembly, body: usize) -> f64 {
    let belongs = |bearing: &&Bearing| {
        bearing.mounts.iter().any(|mount| mount.body == body)
            || bearing.cage.as_ref().is_some_and(|cage| cage.body == body)
    };
    let own = assembly.bearings.iter().find(belongs).or(assembly.bearings.first());
    own.map_or(1.0, |bearing| bearing.geometry.pitch_radius)
}

impl Controller {
    pub fn new(assembly: &Assembly, accuracy: f64, order: f64) -> Controller {
        let places = Places::of(assembly);
        let bearings = &assembly.bearings;
        let least =
            |of: &dyn Fn(&Bearing) -> f64| bearings.iter().map(of).fold(f64::INFINITY, f64::min);
        let balls = bearings.iter().zip(Layout::of(assembly)).map(|(bearing, layout)| {
            (layout, Scale { mass: bearing.ball.mass, arm: bearing.geometry.ball_radius })
        });
        let bodies = assembly.bodies.iter().enumerate().filter_map(|(index, body)| {
            let mass = body.inertia()?.mass;
            Some((places.body(index), Scale { mass, arm: arm(assembly, index) }))
        });
        Controller {
            memory: Memory {
                displacement: FLOOR * least(&|bearing| bearing.geometry.ball_radius),
                previous_error: 1.0,
                smallest: 0.0,
                largest: 0.0,
            },
            accuracy,
            order,
            stiffness: least(&|bearing| {
                bearing.inner_contact.stiffness.min(bearing.outer_contact.stiffness)
            }),
            balls: balls.collect(),
            bodies: bodies.collect(),
            shapes: shapes(assembly, &places),
            elongations: elongations(assembly, &places),
        }
    }

    /// Records the overlaps that `system` has evaluated last.
    pub fn record(&mut self, system: &System) {
        for table in system.sets.iter().map(|set| &set.table) {
            for pair in &table.active {
                let overlap = table.contact[*pair].overlap;
                self.memory.displacement = self.memory.displacement.max(overlap);
            }
        }
    }

    /// First step, far below every period.
    pub fn first_step(&self) -> f64 {
        let frequency = self.balls.iter().map(|(_, ball)| self.frequency(ball));
        libm::cbrt(self.accuracy) / frequency.fold(0.0, f64::max)
    }

    /// Frequency of a body on one contact at the largest overlap, rad/s.
    fn frequency(&self, scale: &Scale) -> f64 {
        (normal_stiffness(self.stiffness, self.memory.displacement) / scale.mass).sqrt()
    }

    /// Error norm of an attempt; accepted up to one.
    pub fn norm(&self, attempt: &Attempt) -> f64 {
        let error = &attempt.error;
        let largest = |at: usize, count: usize| {
            error[at..at + count].iter().fold(0.0f64, |largest, e| {
                // NaN is kept.
                if largest.is_nan() || e.abs() <= largest { largest } else { e.abs() }
            })
        };
        let mut norm = 0.0f64;
        let mut take = |value: f64| {
            // NaN is kept.
            if value > norm || value.is_nan() {
                norm = value;
            }
        };
        let per = 1.0 / (SHARE * self.accuracy * self.memory.displacement);
        for (layout, ball) in &self.balls {
            let per_speed = per / self.frequency(ball);
            for i in 0..3 {
                for first in (0..layout.balls).step_by(LANES) {
                    let count = LANES.min(layout.balls - first);
                    take(per * largest(layout.ball(POSITION + i) + first, count));
                    take(per_speed * largest(layout.ball(VELOCITY + i) + first, count));
                    take(per_speed * ball.arm * largest(layout.ball(SPIN + i) + first, count));
                }
            }
        }
        for (at, scale) in &self.bodies {
            let per_speed = per / self.frequency(scale);
            take(per * largest(at + POSITION, 3));
            take(per * scale.arm * 2.0 * largest(at + ORIENTATION, VELOCITY - ORIENTATION));
            take(per_speed * largest(at + VELOCITY, SPIN - VELOCITY));
            take(per_speed * scale.arm * largest(at + SPIN, BODY - SPIN));
        }
        for shape in &self.shapes {
            let frequency = shape.frequency.max(self.frequency(&shape.race));
            let [gone, speed] = shape.at;
            take(per * shape.reach * error[gone].abs());
            take(per * shape.reach * error[speed].abs() / frequency);
        }
        for &(at, arm) in &self.elongations {
            take(per * largest(at, 3));
            take(per * arm * largest(at + 3, 3));
        }
        norm
    }

    /// Step to try after an accepted one with error `norm`.
    pub fn longer(&mut self, step: f64, norm: f64, was_rejected: bool) -> f64 {
        let memory = &mut self.memory;
        memory.largest = memory.largest.max(step);
        memory.smallest = if memory.smallest == 0.0 { step } else { memory.smallest.min(step) };
        // The error of a step cut short by a row is too small to scale the next step.
        let norm = norm.max(LEAST_ERROR);
        let factor = SAFETY
            * libm::pow(norm, -0.7 / self.order)
            * libm::pow(memory.previous_error, 0.4 / self.order);
        memory.previous_error = norm;
        let most = if was_rejected { 1.0 } else { LONGEST };
        step * factor.clamp(SHORTEST, most)
    }

    /// Step to try after a rejected one.
    pub fn shorter(&self, step: f64, norm: f64) -> f64 {
        let factor = SAFETY * libm::pow(norm, -1.0 / self.order);
        // A NaN only shows that the step was far too long.
        if factor.is_finite() { step * factor.clamp(SHORTEST, SAFETY) } else { step * SHORTEST }
    }
}
