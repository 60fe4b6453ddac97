//! Rigid bodies with their bearings, and solids in explicit steps, in motion together, each in steps of its
//! own; what they exchange is momentum.
//!
//! Central differences know a solid's velocities half a step before its displacements. The bodies' time
//! is that of the velocities. From there on all go through a window of equal length: the races as if
//! their bodies were free, while every solid takes its steps against them and the impulses of its seats
//! are summed; then the bodies, under the means of these impulses. Whatever a solid gets the body gets
//! too, with the other sign. Drift, kick, drift: of second order, and an elastic contact between the two
//! neither makes nor loses energy in the long run. Within a window no solid knows of another.

use crate::assembly::plan::Stage;
use crate::assembly::plan::counts::{Counts, StageCounts};
use crate::assembly::state::Ledger;
use crate::ch2_housing::bore_contact::{ContactNode, Penalty};
use crate::equilibrium::statics::StaticsError;
use crate::kinematics::vec3::Vec3;
use crate::members::rigid_body::Wrench;
use crate::motion::bonded_bushing::{BondedBushing, BondedSnapshot};
use crate::motion::coupling_start::is_alone;
use crate::motion::explicit_shaft::{JointSnapshot, ShaftPart};
use crate::motion::explicit_solid::{SolidSnapshot, SteppedSolid};
use crate::motion::race_in_bore::{Lost, SeatSnapshot, SeatState};
use crate::motion::simulation::{RunOptions, Simulation, SimulationError, Snapshot};
use crate::solids::energy::SolidLedger;
use crate::solids::model::{SolidError, SolidModel};
use crate::solids::rubber::error::RubberError;
use crate::solids::threads::WorkerPool;
use thiserror::Error;

/// A solid that takes part, as it starts.
#[derive(Clone, Debug)]
pub struct SolidPart {
    /// As messages and columns name it; `None` for the only one.
    pub name: Option<String>,
    pub model: SolidModel,
    /// m, one for each node.
    pub displacement: Vec<Vec3>,
    /// Where it is a shaft.
    pub shaft: Option<ShaftPart>,
}

impl SolidPart {
    pub fn undeformed(name: Option<String>, model: SolidModel) -> SolidPart {
        let displacement = vec![[0.0; 3]; model.mass.len()];
        SolidPart::displaced(name, model, displacement)
    }

    /// `displacement` in m, one for each node.
    pub fn displaced(
        name: Option<String>,
        model: SolidModel,
        displacement: Vec<Vec3>,
    ) -> SolidPart {
        SolidPart { name, model, displacement, shaft: None }
    }
}

/// How far to go in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExchangeOptions {
    /// Steps of the solids, as a fraction of their stability limit with the contact closed.
    pub solid_fraction: f64,
    /// Windows, as ωH of a body on all of its seats; stable below 2. Bushings have phases of their own.
    pub seat_phase: f64,
    pub bearing: RunOptions,
}

impl ExchangeOptions {
    /// Of bushings and shafts without a housing beside them.
    pub fn without_housings(bearing: RunOptions) -> ExchangeOptions {
        ExchangeOptions { solid_fraction: 0.9, seat_phase: 1.0, bearing }
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExchangeError {
    #[error(transparent)]
    Bearing(#[from] SimulationError),
    #[error("{}{source}", of_solid(name))]
    Solid { name: Option<String>, source: SolidError },
    #[error("bushing {name}: {source}")]
    Bushing { name: String, source: RubberError },
    #[error("the start has no equilibrium: {0}")]
    Start(#[from] StaticsError),
    #[error(
        "{race} is fixed: it needs equations of its own to move in a housing (outer_race.motion)"
    )]
    FixedRace { race: String },
    #[error(
        "{race} rests on a foundation and in a housing; take one of them (outer_race.foundation)"
    )]
    Foundation { race: String },
    #[error("{name} is {value}; it must be between 0 and {most}")]
    Option { name: &'static str, value: f64, most: f64 },
    #[error(
        "no node of the housing{seat} carries a part of the bore's surface; check the set of the bore"
    )]
    NoSeat { seat: String },
    #[error(
        "windows between bodies and solids would be {window} s: a body has no mass or inertia against the springs that it sits on"
    )]
    NoWindow { window: f64 },
    #[error(
        "{race} has left its bore at t = {time} s, step {step}: it is {distance:.3e} m off \
         {way}, where {allowed:.3e} m are left of its seat"
    )]
    LeftBore { race: String, way: &'static str, distance: f64, allowed: f64, time: f64, step: u64 },
    #[error(
        "{race} and its bore have moved by {moved:.3e} m at t = {time} s since nodes farther than {reach:.3e} m from touching \
         were left out, within {LOOK} windows: far more than what is in equilibrium there moves. Hint: does the race start in the wall of \
         its bore (fit, solid.mesh.origin)? Is a load, or its unit, far too large?"
    )]
    Outrun { race: String, moved: f64, reach: f64, time: f64 },
}

fn of_solid(name: &Option<String>) -> String {
    name.as_ref().map_or(String::new(), |name| format!("solid {name}: "))
}

/// Windows between two looks at how far things have moved.
const LOOK: u64 = 16;

/// An assembly of bodies and bearings with its races in the bores of solids, or on bushings of rubber.
pub struct Exchange<'p> {
    pub simulation: Simulation,
    /// The seats lie with their solids; that is the order of every sum over them.
    pub solids: Vec<SteppedSolid>,
    pub bushings: Vec<BondedBushing<'p>>,
    /// In which all are taken on, s.
    pub window: f64,
    pub exchanges: u64,
    /// What the ledger of all held at the start, J.
    pub(crate) first: f64,
    /// Whether one seat is all that pushes or brakes the bodies from outside.
    is_alone: bool,
    /// Of the present window, for each body in a seat.
    loads: Vec<(usize, Wrench)>,
    crew: WorkerPool,
}

/// Everything at the present time.
#[derive(Clone, Debug)]
pub struct ExchangeSnapshot {
    pub simulation: Snapshot,
    pub solids: Vec<SolidSnapshot>,
    pub bushings: Vec<BondedSnapshot>,
    /// Energy unaccounted for in all together, J.
    pub residual: f64,
    /// Energy held in all and all work and losses, J: what the residual is a part of.
    pub turned_over: f64,
}

impl<'p> Exchange<'p> {
    /// Before its first window.
    pub(crate) fn of(
        simulation: Simulation,
        solids: Vec<SteppedSolid>,
        bushings: Vec<BondedBushing<'p>>,
        window: f64,
    ) -> Exchange<'p> {
        Exchange {
            is_alone: is_alone(&simulation.system.assembly, &solids, &bushings),
            loads: Vec::with_capacity(simulation.system.assembly.bodies.len()),
            simulation,
            solids,
            bushings,
            window,
            exchanges: 0,
            first: 0.0,
            crew: WorkerPool::default(),
        }
    }

    /// From now on steps its solids on so many threads, with the same bits: each solid in as many parts as
    /// its share of all elements that are evaluated comes to.
    pub fn share(&mut self, threads: usize) {
        self.crew = WorkerPool::new(threads);
        let cost = |part: &SteppedSolid| part.solid.model.problem.elements.len() * part.steps;
        let all: usize = self.solids.iter().map(cost).sum();
        for part in &mut self.solids {
            let parts = (2 * self.crew.threads() * cost(part) + all) / (2 * all).max(1);
            part.solid.share(&self.crew, parts.max(1));
        }
    }

    pub fn threads(&self) -> usize {
        self.crew.threads()
    }

    /// Steps of the windows as they are now; contact and balance count from the present state.
    pub(crate) fn begin(&mut self) -> Result<(), ExchangeError> {
        for part in &mut self.solids {
            part.step_in(self.window);
            for seat in &mut part.seats {
                seat.grow_from(&part.solid);
            }
            part.sort(&self.simulation);
        }
        for bushing in &mut self.bushings {
            bushing.step_in(self.window);
        }
        self.first = self.balance()?.residual;
        Ok(())
    }

    /// Shortens windows and steps so that a whole number of windows makes `interval` (s), before the
    /// first exchange; returns how many.
    ///
    /// # Errors
    /// As [`Exchange::snapshot`].
    pub fn divide(&mut self, interval: f64) -> Result<u64, ExchangeError> {
        // A ratio that is whole but for rounding is whole.
        let windows = (interval / self.window * (1.0 - 1e-12)).ceil().max(1.0);
        self.window = interval / windows;
        // No step of the bodies is longer than its window, whatever it might be by itself.
        if self.simulation.control.is_none() {
            self.simulation.step_size = self.simulation.step_size.min(self.window);
        }
        self.begin()?;
        Ok(windows as u64)
    }

    /// Present time: that of the bodies and of the solids' velocities, s.
    pub fn time(&self) -> f64 {
        self.simulation.time
    }

    /// How often each stage has run in all.
    pub fn ran(&self) -> StageCounts {
        let mut ran = self.simulation.system.ran.clone();
        ran.solids = self.solids.iter().map(SteppedSolid::ran).collect();
        ran.solids.extend(self.bushings.iter().map(BondedBushing::ran));
        ran.seats = self.seats().map(|_| Counts::default()).collect();
        for (tally, seat) in ran.seats.iter_mut().zip(self.seats()) {
            tally.add(Stage::Seat, seat.presses);
            tally.add(Stage::BoreFriction, seat.friction.as_ref().map_or(0, |of| of.pulls));
        }
        ran
    }

    /// Counts anew.
    pub fn forget_ran(&mut self) {
        self.simulation.system.ran.clear();
        for part in &mut self.solids {
            part.forget_ran();
        }
        self.bushings.iter_mut().for_each(BondedBushing::forget_ran);
    }

    pub fn seats(&self) -> impl Iterator<Item = &SeatState> {
        self.solids.iter().flat_map(|part| &part.seats)
    }

    /// Takes all through one window.
    ///
    /// # Errors
    /// What ends one of them, or a race that has left its bore.
    pub fn advance(&mut self) -> Result<(), ExchangeError> {
        if self.exchanges.is_multiple_of(LOOK) {
            self.check()?;
        }
        for part in &mut self.solids {
            for seat in &mut part.seats {
                seat.begin_window(self.simulation.body(seat.seat.mount.body));
            }
            if let Some(shaft) = &mut part.shaft {
                shaft.begin_window(&self.simulation);
            }
        }
        self.crew.each(&mut self.solids, |part| {
            let moved = part.through_window();
            moved.map_err(|source| ExchangeError::Solid { name: part.name.clone(), source })
        })?;
        for bushing in &mut self.bushings {
            bushing.begin_window(&self.simulation);
            let moved = bushing.through_window();
            let named = |source| ExchangeError::Bushing { name: bushing.name.clone(), source };
            moved.map_err(named)?;
        }
        self.hand_over();
        self.exchanges += 1;
        let target = self.window * self.exchanges as f64;
        let mut left = target - self.simulation.time;
        while left > 1e-9 * self.window {
            let parts = (left / self.simulation.step_size * (1.0 - 1e-9)).ceil().max(1.0);
            left -= self.simulation.step_by(left / parts)?;
        }
        self.simulation.time = target;
        self.book();
        Ok(())
    }

    /// Whether the races are still in their bores, and nodes out of reach still are.
    fn check(&mut self) -> Result<(), ExchangeError> {
        let (time, step) = (self.simulation.time, self.exchanges);
        for part in &mut self.solids {
            for seat in &mut part.seats {
                let index = seat.seat.mount.body;
                let reach = seat.seat.reach;
                seat.check(&self.simulation.body(index), &part.solid).map_err(|lost| {
                    let race = self.simulation.system.assembly.bodies[index].name.clone();
                    match lost {
                        Lost::Bore(way, distance, allowed) => {
                            ExchangeError::LeftBore { race, way, distance, allowed, time, step }
                        }
                        Lost::Reach(moved) => ExchangeError::Outrun { race, moved, reach, time },
                    }
                })?;
            }
        }
        Ok(())
    }

    /// The bodies get what their seats have summed up in the window.
    fn hand_over(&mut self) {
        self.loads.clear();
        let (loads, window) = (&mut self.loads, self.window);
        let mut push =
            |body: usize, load: Wrench| match loads.iter_mut().find(|(other, _)| *other == body) {
                Some((_, sum)) => sum.add(&load),
                None => loads.push((body, load)),
            };
        for seat in self.solids.iter_mut().flat_map(|part| &mut part.seats) {
            push(seat.seat.mount.body, seat.take_mean_load(window));
        }
        for now in self.solids.iter().filter_map(|part| part.shaft.as_ref()).flat_map(|s| &s.joints)
        {
            push(now.joint.body, now.mean_load(window));
        }
        for now in self.bushings.iter().flat_map(|bushing| &bushing.sleeves) {
            push(now.sleeve.body, now.mean_load(window));
        }
        self.simulation.set_outside_loads(&self.loads);
    }

    /// Work of the seats on their bodies in the window behind.
    fn book(&mut self) {
        // The bodies' own ledger has it integrated with their motion, where nothing else goes into that entry.
        let integrated = self.is_alone.then(|| {
            self.simulation.state[self.simulation.system.places.ledger_entry(Ledger::Foundation)]
        });
        for seat in self.solids.iter_mut().flat_map(|part| &mut part.seats) {
            match integrated {
                Some(work) => seat.work = work,
                None => seat.book(self.window, &self.simulation.body(seat.seat.mount.body)),
            }
        }
        let shafts = self.solids.iter_mut().filter_map(|part| part.shaft.as_mut());
        for now in shafts.flat_map(|shaft| &mut shaft.joints) {
            now.book(self.window, &self.simulation.body(now.joint.body));
        }
        for now in self.bushings.iter_mut().flat_map(|bushing| &mut bushing.sleeves) {
            now.book(self.window, &self.simulation.body(now.sleeve.body));
        }
    }

    /// Nodes of a solid that touch now, how stiff their contact is, and the force on each, N.
    pub fn nodal_forces(&self, solid: usize) -> Vec<(ContactNode, Penalty, Vec3)> {
        let part = &self.solids[solid];
        let mut found = Vec::new();
        for seat in &part.seats {
            let body = self.simulation.body(seat.seat.mount.body);
            let touching = seat.nodal_forces(&body, &part.solid).into_iter();
            found.extend(touching.map(|(node, force)| (node, seat.seat.penalty, force)));
        }
        found
    }

    /// Loads, energies and what is unaccounted for.
    ///
    /// # Errors
    /// More energy unaccounted for in the bodies than their options allow.
    pub fn snapshot(&mut self) -> Result<ExchangeSnapshot, ExchangeError> {
        let mut snapshot = self.balance()?;
        snapshot.residual -= self.first;
        Ok(snapshot)
    }

    /// The bodies are balanced where their time is, solids and contacts half a step later: what the
    /// contacts do to the bodies in between is added.
    fn balance(&mut self) -> Result<ExchangeSnapshot, ExchangeError> {
        let bodies = self.simulation.snapshot();
        let Exchange { simulation, solids, bushings, .. } = self;
        let solids: Vec<SolidSnapshot> =
            solids.iter_mut().map(|part| part.snapshot(simulation)).collect();
        let bushings: Vec<BondedSnapshot> =
            bushings.iter_mut().map(|part| part.snapshot(simulation)).collect();
        let of_bushings = |of: fn(&BondedSnapshot) -> f64| -> f64 { bushings.iter().map(of).sum() };
        let of_seats = |of: fn(&SeatSnapshot) -> f64| -> f64 {
            solids.iter().flat_map(|solid| &solid.seats).map(of).sum()
        };
        let of_joints = |of: fn(&JointSnapshot) -> f64| -> f64 {
            solids.iter().flat_map(|solid| &solid.joints).map(of).sum()
        };
        let of_solids = |of: fn(&SolidSnapshot) -> f64| -> f64 { solids.iter().map(of).sum() };
        let held = of_solids(|solid| {
            let SolidLedger { energy, .. } = solid.ledger;
            let seats: f64 = solid.seats.iter().map(|seat| seat.contact.energy).sum();
            let springs: f64 = solid.seats.iter().map(|seat| seat.friction.stored).sum();
            let joints: f64 = solid.joints.iter().map(|joint| joint.stored).sum();
            energy.strain + energy.kinetic + seats + springs + joints
        });
        let residual =
            bodies.residual + of_seats(|seat| seat.work) + of_seats(|seat| seat.to_come) + held
                - of_solids(|solid| solid.ledger.external_work)
                - of_solids(|solid| solid.ledger.damping_work)
                - of_seats(|seat| seat.growth_work)
                + of_seats(|seat| seat.friction.heat - seat.friction.load_work)
                + of_joints(|joint| joint.work + joint.to_come + joint.heat)
                - of_solids(|solid| solid.unbalance_work)
                + of_bushings(|of| of.work + of.to_come + of.held() + of.dissipated + of.beyond);
        let work: f64 = bodies.ledger.iter().map(|entry| entry.abs()).sum();
        let shafts = self.solids.iter().filter_map(|part| part.shaft.as_ref());
        let spinning: f64 = shafts.map(|shaft| shaft.spin_energy(self.simulation.time)).sum();
        let turned_over = bodies.energy.contact
            + (held - spinning).max(0.0)
            + work
            + of_solids(|solid| solid.ledger.external_work.abs())
            + of_solids(|solid| solid.ledger.damping_work.abs())
            + of_seats(|seat| seat.growth_work.abs())
            + of_seats(|seat| seat.friction.heat + seat.friction.load_work.abs())
            + of_joints(|joint| joint.heat)
            + of_solids(|solid| solid.unbalance_work.abs())
            + of_bushings(|of| of.held() + of.dissipated);
        Ok(ExchangeSnapshot { simulation: bodies, solids, bushings, residual, turned_over })
    }
}
