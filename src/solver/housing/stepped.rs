//! A solid in explicit steps of its own with the seats in its bores, between two exchanges with the bodies.

use super::seat::{Seat, SeatSnapshot, SeatState};
use crate::solver::dynamics::assembly::Assembly;
use crate::solver::dynamics::run::Simulation;
use crate::solver::solid::energy::SolidLedger;
use crate::solver::solid::explicit::ExplicitSolid;
use crate::solver::solid::model::SolidError;

/// A solid in steps of its own, and the seats in its bores.
pub struct SteppedSolid {
    pub name: Option<String>,
    pub solid: ExplicitSolid,
    /// In a window.
    pub steps: usize,
    pub seats: Vec<SeatState>,
}

/// A solid with its seats at the present time.
#[derive(Clone, Debug)]
pub struct SolidSnapshot {
    pub ledger: SolidLedger,
    pub seats: Vec<SeatSnapshot>,
}

impl SteppedSolid {
    /// Through a window whose beginning its seats have been told, in which their bodies are as if free.
    pub(super) fn through_window(&mut self) -> Result<(), SolidError> {
        let step = self.solid.step_size;
        for k in 0..self.steps {
            // Displacements are half a step ahead of velocities, whose time is that of the bodies.
            let after = (k as f64 + 0.5) * step;
            let seats = &mut self.seats;
            self.solid.step(|t, displacement, forces| {
                for seat in seats.iter_mut() {
                    seat.push_both(t, [after, step], displacement, forces);
                }
            })?;
        }
        Ok(())
    }

    /// In windows of so many s, before the first one.
    pub(super) fn step_in(&mut self, window: f64) {
        self.solid.step_size = window / self.steps as f64;
        self.solid.time = 0.5 * self.solid.step_size;
    }

    /// Energies of solid and seats, their bodies where `simulation` has them.
    pub(super) fn snapshot(&mut self, simulation: &Simulation) -> SolidSnapshot {
        let SteppedSolid { solid, seats, .. } = self;
        let ahead = 0.5 * solid.step_size;
        let mut found = Vec::with_capacity(seats.len());
        let ledger = solid.ledger_with(|t, displacement, forces| {
            for seat in seats.iter() {
                let body = simulation.body(seat.seat.mount.body);
                found.push(seat.snapshot(&body, [t, ahead], displacement, forces));
            }
        });
        SolidSnapshot { ledger, seats: found }
    }

    pub(super) fn sort(&mut self, simulation: &Simulation) {
        for seat in &mut self.seats {
            seat.sort(&simulation.body(seat.seat.mount.body), &self.solid);
        }
    }
}

/// Puts the seats into their solids, with the nodes under the races alone; returns them in that order.
pub(super) fn seated(
    assembly: &Assembly,
    solids: &mut [SteppedSolid],
    seats: Vec<Seat>,
) -> Vec<Seat> {
    for seat in seats {
        let body = &assembly.bodies[seat.mount.body];
        solids[seat.solid].seats.push(SeatState::new(seat, body));
    }
    solids.iter().flat_map(|part| &part.seats).map(|state| state.seat.clone()).collect()
}
