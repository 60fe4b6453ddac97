//! Watch of the stability limit. Contacts that carry more load oscillate faster, and their traction and damping decay
//! faster, than at the start.
//!
//! A run above its limit need not fail: traction that overshoots may end in a limit cycle that conserves energy. So
//! contact stiffness is compared every few steps, at little cost, and the Jacobian is evaluated when the limit may have
//! come down to the step. A prescribed step is refused then; one that follows from the limit is shortened.

use crate::ch2_housing::bearing::cage::CageContact;
use crate::ch2_housing::bearing::contact::{normal_load, normal_stiffness};
use crate::ch2_housing::bearing::traction::{TractionLaw, coefficient_and_slope};
use crate::members::ball_set::BallSet;
use crate::members::bearing::Bearing;
use crate::motion::simulation::{Integrator, Simulation, SimulationError, Stepping};
use crate::motion::stability::step_limit;
use crate::motion::system::System;
use crate::plan::Stage;
use serde::{Deserialize, Serialize};

/// Steps between two checks of the contacts.
pub const CHECK_EVERY: u64 = 16;

/// Factor by which a prescribed step may exceed the limit: the uncertainty of the limit.
pub const TOLERATED: f64 = 1.1;

/// With traction the Jacobian is evaluated after 16, 32, 64 … steps and then at this interval, whatever the contact
/// stiffness: rolling with spin keeps slip off the steep onset at the start, and reaches it within some tenths of a
/// millisecond. The cost is some per cent.
const JUDGE_EVERY: u64 = 4096;

/// A step that follows from the limit is shortened if it exceeds its fraction by this factor: at the limit itself
/// nothing decays, and the energy balance fails long before.
const ROOM: f64 = 1.5;

/// Additional factor for damped contacts: when an oscillation becomes a decay, its fast root grows more than stiffness
/// and damping.
const DAMPED: f64 = 1.5;

/// Rates of the contacts that limit the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stiffness {
    /// Largest contact stiffness over mass, 1/s².
    pub oscillation: f64,
    /// Fastest decay of a slip or of an approach, at the steep onset of traction, 1/s.
    pub decay: f64,
}

impl Stiffness {
    /// Factor by which the limit may have come down since `before`.
    fn growth(&self, before: &Stiffness) -> f64 {
        let ratio = |now: f64, before: f64| if now > 0.0 { now / before } else { 0.0 };
        let oscillation = ratio(self.oscillation, before.oscillation).sqrt();
        oscillation.max(ratio(self.decay, before.decay))
    }

    fn largest(&self, other: &Stiffness) -> Stiffness {
        Stiffness {
            oscillation: self.oscillation.max(other.oscillation),
            decay: self.decay.max(other.decay),
        }
    }
}

/// Stiffness of the contacts as they were evaluated last.
pub fn stiffness(system: &System) -> Stiffness {
    let mut most = Stiffness::default();
    for (set, bearing) in system.sets.iter().zip(&system.assembly.bearings) {
        most = most.largest(&stiffness_of(system, set, bearing));
    }
    for (seat, now) in system.assembly.seats.iter().zip(&system.seats) {
        let inertia = system.assembly.bodies[seat.race.body].inertia();
        let per_mass = inertia.map_or(0.0, |inertia| 1.0 / inertia.mass);
        let touching: f64 = now.touching.iter().map(|node| node.stiffness).sum();
        let oscillation = touching * per_mass;
        most = most.largest(&Stiffness { oscillation, decay: 0.0 });
    }
    most
}

fn stiffness_of(system: &System, set: &BallSet, bearing: &Bearing) -> Stiffness {
    let radius = set.laws.ball_radius;
    let per_mass = 1.0 / bearing.ball.mass;
    // A force at the surface moves it by translation and by rotation of the ball.
    let at_surface = per_mass + radius * radius / bearing.ball.axial;
    let mut most = Stiffness::default();
    for &pair in &set.table.active {
        let law = &set.laws.races[set.layout.race_and_ball(pair).0];
        let overlap = set.table.contact[pair].overlap.max(0.0);
        let elastic = normal_load(law.stiffness, overlap);
        let slope = match &set.laws.traction {
            TractionLaw::None => 0.0,
            law => coefficient_and_slope(law, 0.0, set.table.sliding[pair].entrainment).1,
        };
        most = most.largest(&Stiffness {
            oscillation: 1.5 * law.stiffness * overlap.sqrt() * per_mass,
            decay: (slope * set.table.load[pair] * at_surface)
                .max(set.damping * elastic * per_mass),
        });
    }
    if let Some(law) = &bearing.ball_contact {
        for meeting in set.meetings.iter().filter(|meeting| meeting.normal_load > 0.0) {
            most = most.largest(&Stiffness {
                // Both balls move.
                oscillation: 2.0 * per_mass * normal_stiffness(law.stiffness, meeting.overlap),
                decay: 2.0 * at_surface * law.friction * meeting.normal_load
                    / law.regularisation_speed,
            });
        }
    }
    let Some(cage) = &bearing.cage else { return most };
    let of_cage = |contact: &CageContact, moved: f64| Stiffness {
        oscillation: moved * cage.stiffness(contact),
        decay: cage.contacts.friction * contact.normal_load / cage.contacts.regularisation_speed
            * moved,
    };
    let per_cage =
        system.assembly.bodies[cage.body].inertia().map_or(0.0, |inertia| 1.0 / inertia.mass);
    let pockets = set.pockets.iter().map(|contact| (contact, at_surface + per_cage));
    let guides = set.guides.iter().map(|contact| (contact, per_cage));
    for (contact, moved) in pockets.chain(guides).filter(|(contact, _)| contact.normal_load > 0.0) {
        most = most.largest(&of_cage(contact, moved));
    }
    most
}

/// Limit found so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepWatch {
    /// Smallest limit found, s; `None` if nothing was stiff yet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest: Option<f64>,
    /// Largest contact rates at an evaluation of the Jacobian.
    pub stiffest: Stiffness,
    /// Number of times the step was shortened.
    pub shortened: u64,
}

impl StepWatch {
    /// Returns whether the Jacobian is due. `bound` is the fraction of the limit that the step must not exceed.
    fn is_due(&self, now: &Stiffness, step: f64, bound: f64, damped: bool) -> bool {
        let growth = now.growth(&self.stiffest);
        let margin = if damped { DAMPED } else { 1.0 } / bound;
        // Two per cent, so that a step close to its limit is not judged again and again.
        growth > 1.02 && self.smallest.is_none_or(|limit| limit < margin * growth * step)
    }
}

impl Simulation {
    /// Compares the contacts of the last evaluation, and evaluates the Jacobian if it is due. Returns the step to
    /// continue with if one that follows from the limit has exceeded it.
    ///
    /// # Errors
    ///
    /// A prescribed step above the limit.
    pub fn watch_step(&mut self) -> Result<Option<f64>, SimulationError> {
        let now = stiffness(&self.system);
        let sets = &self.system.sets;
        let damped = sets.iter().any(|set| set.damping > 0.0);
        let steps = self.steps;
        let on_schedule = sets.iter().any(|set| set.laws.traction != TractionLaw::None)
            && (steps.is_power_of_two() || steps.is_multiple_of(JUDGE_EVERY));
        let due = on_schedule || self.step_watch.is_due(&now, self.step_size, self.bound(), damped);
        if due { self.judge_step(now) } else { Ok(None) }
    }

    /// Fraction of the limit that the step must not exceed.
    fn bound(&self) -> f64 {
        match self.options.stepping {
            Stepping::FractionOfLimit(fraction) => (ROOM * fraction).min(1.0),
            Stepping::Fixed(_) | Stepping::Accuracy(_) => 1.0,
        }
    }

    /// Continues with a shorter step.
    pub fn shorten_step(&mut self, step: f64) {
        self.step_watch.shortened += 1;
        self.step_size = step;
    }

    /// Compares the step with the limit at the present state.
    ///
    /// # Errors
    ///
    /// A prescribed step above the limit.
    pub fn judge_step_now(&mut self) -> Result<Option<f64>, SimulationError> {
        self.system.evaluate(self.time, &self.state, &mut self.rates);
        self.judge_step(stiffness(&self.system))
    }

    fn judge_step(&mut self, now: Stiffness) -> Result<Option<f64>, SimulationError> {
        // The limit is that of Runge–Kutta.
        if self.options.integrator != Integrator::RungeKutta {
            return Ok(None);
        }
        // Evaluations for the Jacobian are counted as judgements, not as those of steps.
        let (work, ran) = (self.system.work, self.system.ran.clone());
        let limit = step_limit(&mut self.system, self.time, &self.state);
        (self.system.work, self.system.ran) = (work, ran);
        self.system.ran.whole.add(Stage::StabilityLimit, 1);
        let watch = &mut self.step_watch;
        watch.stiffest = watch.stiffest.largest(&now);
        let Some(limit) = limit else { return Ok(None) };
        watch.smallest = Some(watch.smallest.map_or(limit.step, |least| least.min(limit.step)));
        let ratio = self.step_size / limit.step;
        if let Stepping::FractionOfLimit(fraction) = self.options.stepping {
            if ratio <= self.bound() {
                return Ok(None);
            }
            self.limit = Some(limit);
            return Ok(Some(fraction * limit.step));
        }
        if ratio <= TOLERATED {
            return Ok(None);
        }
        Err(SimulationError::StepTooLong {
            size: self.step_size,
            limit: limit.step,
            reason: limit.reason(&self.system.assembly),
            time: self.time,
            step: self.steps,
        })
    }
}
