//! Coupled motion of rigid bodies and solids in explicit steps: each takes its own steps, and they exchange impulses
//! once a coupling step.
//!
//! Central differences have a solid's velocities half a step before its displacements. The time of the bodies is that
//! of the velocities. In a coupling step every solid first takes its steps against races that move as free bodies, and
//! the impulses of its race-bore contacts are summed. Then the bodies take the step under the mean loads of these
//! impulses. Body and solid get the same impulse with opposite signs. This is drift, kick, drift: second order, and
//! elastic contact conserves energy in the long run. Solids do not see each other within a coupling step.

use crate::ch2_housing::bore_contact::{ContactNode, Penalty};
use crate::equilibrium::statics::StaticsError;
use crate::kinematics::vec3::Vec3;
use crate::members::rigid_body::Wrench;
use crate::members::state::Ledger;
use crate::motion::bonded_bushing::{BondedBushing, BondedSnapshot};
use crate::motion::coupling_start::is_alone;
use crate::motion::explicit_cage::CagePart;
use crate::motion::explicit_shaft::{JointSnapshot, ShaftPart};
use crate::motion::explicit_solid::{SolidSnapshot, SteppedSolid};
use crate::motion::race_in_bore::{Lost, SeatSnapshot, SeatState};
use crate::motion::simulation::{RunOptions, Simulation, SimulationError, Snapshot};
use crate::plan::Stage;
use crate::plan::counts::{Counts, StageCounts};
use crate::solids::energy::SolidLedger;
use crate::solids::error::SolidError;
use crate::solids::model::SolidModel;
use crate::solids::threads::WorkerPool;
use thiserror::Error;

/// A solid in coupled motion, at its start.
#[derive(Clone, Debug)]
pub struct SolidPart {
    /// Name in messages and columns; `None` for the only one.
    pub name: Option<String>,
    pub model: SolidModel,
    /// Displacement of each node, m.
    pub displacement: Vec<Vec3>,
    /// `None` if the solid is not a shaft.
    pub shaft: Option<ShaftPart>,
    /// `None` if the solid is not a cage.
    pub cage: Option<CagePart>,
}

impl SolidPart {
    pub fn undeformed(name: Option<String>, model: SolidModel) -> SolidPart {
        let displacement = vec![[0.0; 3]; model.mass.len()];
        SolidPart::displaced(name, model, displacement)
    }

    /// `displacement` of each node, m.
    pub fn displaced(
        name: Option<String>,
        model: SolidModel,
        displacement: Vec<Vec3>,
    ) -> SolidPart {
        SolidPart { name, model, displacement, shaft: None, cage: None }
    }
}

/// Limits of the step sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplingOptions {
    /// Step of the solids as a fraction of their stability limit with the contact closed.
    pub solid_fraction: f64,
    /// Phase ωH of a body on all of its housing fits in a coupling step; stable below 2. Bushings have phases of their
    /// own.
    pub seat_phase: f64,
    pub bearing: RunOptions,
}

impl CouplingOptions {
    /// Options for bushings and shafts without a housing.
    pub fn without_housings(bearing: RunOptions) -> CouplingOptions {
        CouplingOptions { solid_fraction: 0.9, seat_phase: 1.0, bearing }
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum CouplingError {
    #[error(transparent)]
    Bearing(#[from] SimulationError),
    #[error("{}{source}", of_solid(name))]
    Solid { name: Option<String>, source: SolidError },
    #[error("bushing {name}: {source}")]
    Bushing { name: String, source: SolidError },
    #[error("there is no static equilibrium to start from: {0}")]
    Start(#[from] StaticsError),
    #[error(
        "{race} is fixed, so it cannot move in a housing; write motion = \"5-dof\" in [outer_race]"
    )]
    FixedRace { race: String },
    #[error(
        "{race} rests on a foundation and in a housing; take one of them (outer_race.foundation)"
    )]
    Foundation { race: String },
    #[error("{name} is {value}; it must be between 0 and {most}")]
    Option { name: &'static str, value: f64, most: f64 },
    #[error(
        "no node of the housing{seat} is on a face of the bore surface; check the set of the bore"
    )]
    NoSeat { seat: String },
    #[error(
        "the coupling step would be {coupling_step} s: a body has no mass or inertia against its springs"
    )]
    NoCouplingStep { coupling_step: f64 },
    #[error(
        "{race} has left its bore at t = {time} s, step {step}: it is displaced by {distance:.3e} m \
          {way}; {allowed:.3e} m are allowed"
    )]
    LeftBore { race: String, way: &'static str, distance: f64, allowed: f64, time: f64, step: u64 },
    #[error(
        "{race} and its bore have moved by {moved:.3e} m relative to each other within {CHECK_EVERY} coupling \
         steps, at t = {time} s. The search for contact omits nodes farther than {reach:.3e} m from contact \
         until these steps are over, and a race near equilibrium moves far less. Hint: does the race start in \
         the wall of its bore (fit, solid.mesh.origin)? Is a load, or its unit, far too large?"
    )]
    Outrun { race: String, moved: f64, reach: f64, time: f64 },
}

fn of_solid(name: &Option<String>) -> String {
    name.as_ref().map_or(String::new(), |name| format!("solid {name}: "))
}

/// Coupling steps between two checks of displacements.
const CHECK_EVERY: u64 = 16;

/// Bodies and bearings with races in the bores of solids, or on bushings of rubber.
pub struct CoupledMotion<'p> {
    pub simulation: Simulation,
    /// In the order of the solids' housing fits, which is the order of every sum over them.
    pub solids: Vec<SteppedSolid>,
    pub bushings: Vec<BondedBushing<'p>>,
    /// Length of the coupling step, s.
    pub coupling_step: f64,
    pub exchanges: u64,
    /// Initial energy in the ledger, J.
    pub(crate) first: f64,
    /// True if one housing fit is the only external load on the bodies.
    is_alone: bool,
    /// Loads in the present coupling step, for each body in a bore.
    loads: Vec<(usize, Wrench)>,
    workers: WorkerPool,
}

/// Energies and loads at the present time.
#[derive(Clone, Debug)]
pub struct CouplingSnapshot {
    pub simulation: Snapshot,
    pub solids: Vec<SolidSnapshot>,
    pub bushings: Vec<BondedSnapshot>,
    /// Energy residual, J.
    pub residual: f64,
    /// Sum of stored energy, work and losses, J; reference of the residual.
    pub turned_over: f64,
}

impl<'p> CoupledMotion<'p> {
    /// The state before the first coupling step.
    pub(crate) fn of(
        simulation: Simulation,
        solids: Vec<SteppedSolid>,
        bushings: Vec<BondedBushing<'p>>,
        coupling_step: f64,
    ) -> CoupledMotion<'p> {
        CoupledMotion {
            is_alone: is_alone(&simulation.system.assembly, &solids, &bushings),
            loads: Vec::with_capacity(simulation.system.assembly.bodies.len()),
            simulation,
            solids,
            bushings,
            coupling_step,
            exchanges: 0,
            first: 0.0,
            workers: WorkerPool::default(),
        }
    }

    /// Runs the solids on this number of threads, with the same bits. Each solid gets a share of the threads
    /// proportional to its elements.
    pub fn share(&mut self, threads: usize) {
        self.workers = WorkerPool::new(threads);
        let cost = |part: &SteppedSolid| part.solid.model.problem.elements.len() * part.steps;
        let all: usize = self.solids.iter().map(cost).sum();
        for part in &mut self.solids {
            let parts = (2 * self.workers.threads() * cost(part) + all) / (2 * all).max(1);
            part.solid.share(&self.workers, parts.max(1));
        }
    }

    pub fn threads(&self) -> usize {
        self.workers.threads()
    }

    /// Starts counts, contact and energy balance from the present state.
    pub(crate) fn begin(&mut self) -> Result<(), CouplingError> {
        for part in &mut self.solids {
            part.step_in(self.coupling_step, &self.simulation);
            for seat in &mut part.seats {
                seat.grow_from(&part.solid);
            }
            part.sort(&self.simulation);
        }
        for bushing in &mut self.bushings {
            bushing.step_in(self.coupling_step);
        }
        self.first = self.balance()?.residual;
        Ok(())
    }

    /// Shortens coupling steps and steps so that a whole number of coupling steps makes `interval` (s), before the
    /// first step. Returns that number.
    ///
    /// # Errors
    ///
    /// See [`CoupledMotion::snapshot`].
    pub fn divide(&mut self, interval: f64) -> Result<u64, CouplingError> {
        // Rounding must not add a coupling step.
        let coupling_steps = (interval / self.coupling_step * (1.0 - 1e-12)).ceil().max(1.0);
        self.coupling_step = interval / coupling_steps;
        // The step of the bodies is at most a coupling step.
        if self.simulation.control.is_none() {
            self.simulation.step_size = self.simulation.step_size.min(self.coupling_step);
        }
        self.begin()?;
        Ok(coupling_steps as u64)
    }

    /// Present time, s: that of the bodies and of the solids' velocities.
    pub fn time(&self) -> f64 {
        self.simulation.time
    }

    /// Number of runs of each stage.
    pub fn ran(&self) -> StageCounts {
        let mut ran = self.simulation.system.ran.clone();
        ran.solids = self.solids.iter().map(SteppedSolid::ran).collect();
        ran.solids.extend(self.bushings.iter().map(BondedBushing::ran));
        ran.seats = self.seats().map(|_| Counts::default()).collect();
        for (tally, seat) in ran.seats.iter_mut().zip(self.seats()) {
            tally.add(Stage::Seat, seat.presses);
            tally.add(Stage::BoreFriction, seat.friction.as_ref().map_or(0, |of| of.updates));
        }
        ran
    }

    /// Resets the counts.
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

    /// Takes one coupling step.
    ///
    /// # Errors
    ///
    /// The error of a body or solid; a race outside its bore.
    pub fn advance(&mut self) -> Result<(), CouplingError> {
        if self.exchanges.is_multiple_of(CHECK_EVERY) {
            self.check()?;
        }
        for part in &mut self.solids {
            for seat in &mut part.seats {
                seat.begin_coupling_step(self.simulation.body(seat.seat.mount.body));
            }
            if let Some(shaft) = &mut part.shaft {
                shaft.begin_coupling_step(&self.simulation);
            }
            if let Some(cage) = &mut part.cage {
                cage.begin_coupling_step(&self.simulation);
            }
        }
        self.workers.each(&mut self.solids, |part| {
            let moved = part.take_coupling_step();
            moved.map_err(|source| CouplingError::Solid { name: part.name.clone(), source })
        })?;
        for bushing in &mut self.bushings {
            bushing.begin_coupling_step(&self.simulation);
            let moved = bushing.take_coupling_step();
            let named = |source| CouplingError::Bushing { name: bushing.name.clone(), source };
            moved.map_err(named)?;
        }
        self.hand_over();
        self.exchanges += 1;
        let target = self.coupling_step * self.exchanges as f64;
        let mut left = target - self.simulation.time;
        while left > 1e-9 * self.coupling_step {
            let parts = (left / self.simulation.step_size * (1.0 - 1e-9)).ceil().max(1.0);
            left -= self.simulation.step_by(left / parts)?;
        }
        self.simulation.time = target;
        self.book();
        Ok(())
    }

    /// Checks that races are in their bores and that untested nodes are out of contact.
    fn check(&mut self) -> Result<(), CouplingError> {
        let (time, step) = (self.simulation.time, self.exchanges);
        for part in &mut self.solids {
            for seat in &mut part.seats {
                let index = seat.seat.mount.body;
                let reach = seat.seat.reach;
                seat.check(&self.simulation.body(index), &part.solid).map_err(|lost| {
                    let race = self.simulation.system.assembly.bodies[index].name.clone();
                    match lost {
                        Lost::Bore(way, distance, allowed) => {
                            CouplingError::LeftBore { race, way, distance, allowed, time, step }
                        }
                        Lost::Reach(moved) => CouplingError::Outrun { race, moved, reach, time },
                    }
                })?;
            }
        }
        Ok(())
    }

    /// Applies the impulses of the coupling step to the bodies.
    fn hand_over(&mut self) {
        self.loads.clear();
        let (loads, coupling_step) = (&mut self.loads, self.coupling_step);
        let mut push =
            |body: usize, load: Wrench| match loads.iter_mut().find(|(other, _)| *other == body) {
                Some((_, sum)) => sum.add(&load),
                None => loads.push((body, load)),
            };
        for seat in self.solids.iter_mut().flat_map(|part| &mut part.seats) {
            push(seat.seat.mount.body, seat.take_mean_load(coupling_step));
        }
        for now in self.solids.iter().filter_map(|part| part.shaft.as_ref()).flat_map(|s| &s.joints)
        {
            push(now.joint.body, now.mean_load(coupling_step));
        }
        for now in self.bushings.iter().flat_map(|bushing| &bushing.sleeves) {
            push(now.sleeve.body, now.mean_load(coupling_step));
        }
        for cage in self.solids.iter().filter_map(|part| part.cage.as_ref()) {
            if let Some((race, load)) = cage.hand_over(&mut self.simulation, coupling_step) {
                push(race, load);
            }
        }
        self.simulation.set_outside_loads(&self.loads);
    }

    /// Books the work of the housing fits on their bodies in the last coupling step.
    fn book(&mut self) {
        // The ledger of the bodies integrates this work if nothing else goes into that entry.
        let integrated = self.is_alone.then(|| {
            self.simulation.state[self.simulation.system.places.ledger_entry(Ledger::Foundation)]
        });
        for seat in self.solids.iter_mut().flat_map(|part| &mut part.seats) {
            match integrated {
                Some(work) => seat.work = work,
                None => seat.book(self.coupling_step, &self.simulation.body(seat.seat.mount.body)),
            }
        }
        let shafts = self.solids.iter_mut().filter_map(|part| part.shaft.as_mut());
        for now in shafts.flat_map(|shaft| &mut shaft.joints) {
            now.book(self.coupling_step, &self.simulation.body(now.joint.body));
        }
        for now in self.bushings.iter_mut().flat_map(|bushing| &mut bushing.sleeves) {
            now.book(self.coupling_step, &self.simulation.body(now.sleeve.body));
        }
        for SteppedSolid { solid, cage, .. } in &mut self.solids {
            if let Some(cage) = cage {
                cage.book(&self.simulation, self.coupling_step);
                cage.carry(solid, &mut self.simulation);
            }
        }
    }

    /// Contact nodes of a solid with their stiffness and force, N.
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

    /// Loads, energies and energy residual.
    ///
    /// # Errors
    ///
    /// An energy residual of the bodies beyond the limit in their options.
    pub fn snapshot(&mut self) -> Result<CouplingSnapshot, CouplingError> {
        let mut snapshot = self.balance()?;
        snapshot.residual -= self.first;
        Ok(snapshot)
    }

    /// Energies. Bodies are balanced at their time, solids and contacts half a step later: the work of the contacts on
    /// the bodies in between is added.
    fn balance(&mut self) -> Result<CouplingSnapshot, CouplingError> {
        let bodies = self.simulation.snapshot();
        let CoupledMotion { simulation, solids, bushings, .. } = self;
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
        Ok(CouplingSnapshot { simulation: bodies, solids, bushings, residual, turned_over })
    }
}
