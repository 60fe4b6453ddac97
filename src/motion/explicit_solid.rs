//! A solid in explicit steps, with the races in its bores and the attachments of its sections, between two exchanges
//! with the bodies.

use crate::assembly::lists::Assembly;
use crate::motion::explicit_cage::SteppedCage;
use crate::motion::explicit_shaft::{JointSnapshot, SteppedShaft};
use crate::motion::race_in_bore::{Seat, SeatSnapshot, SeatState};
use crate::motion::simulation::Simulation;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::energy::SolidLedger;
use crate::solids::error::SolidError;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::tet4_blocks::Node;

/// A solid in explicit steps, its housing fits, its attachments if it is a shaft, its contacts if it is a cage.
pub struct SteppedSolid {
    pub name: Option<String>,
    pub solid: ExplicitSolid,
    /// Number in a coupling step.
    pub steps: usize,
    pub seats: Vec<SeatState>,
    pub shaft: Option<Box<SteppedShaft>>,
    pub cage: Option<Box<SteppedCage>>,
}

/// A solid with its housing fits at the present time.
#[derive(Clone, Debug)]
pub struct SolidSnapshot {
    pub ledger: SolidLedger,
    pub seats: Vec<SeatSnapshot>,
    pub joints: Vec<JointSnapshot>,
    /// Work of unbalances on a shaft since the start, J.
    pub unbalance_work: f64,
}

impl SteppedSolid {
    /// Takes the steps of a coupling step, with the bodies of its housing fits as free.
    pub(crate) fn take_coupling_step(&mut self) -> Result<(), SolidError> {
        let step = self.solid.step_size;
        for k in 0..self.steps {
            // Displacements are half a step ahead of velocities, whose time is that of the bodies.
            let after = (k as f64 + 0.5) * step;
            let (seats, solid) = (&mut self.seats, &mut self.solid);
            if let Some(shaft) = &mut self.shaft {
                shaft.begin_step(solid, after);
            }
            if let Some(cage) = &mut self.cage {
                cage.begin_step(solid, after);
            }
            let (shaft, cage) = (self.shaft.as_deref_mut(), self.cage.as_deref());
            solid.step(|t, displacement, forces| {
                for seat in seats.iter_mut() {
                    seat.push_both(t, [after, step], displacement, forces);
                }
                if let Some(shaft) = &shaft {
                    shaft.add_forces(forces);
                }
                if let Some(cage) = cage {
                    cage.add_forces(forces);
                }
            })?;
            if let Some(shaft) = shaft {
                shaft.end_step(solid);
            }
        }
        Ok(())
    }

    /// Kind of the solid in messages and summaries.
    pub fn kind(&self) -> &'static str {
        match (&self.shaft, &self.cage) {
            (Some(_), _) => "shaft",
            (_, Some(_)) => "cage",
            _ => "housing",
        }
    }

    /// Number of runs of each stage, without housing fits.
    pub(crate) fn ran(&self) -> Counts {
        let mut ran = self.solid.ran;
        if let Some(shaft) = &self.shaft {
            ran.add(Stage::Joints, shaft.looks * u64::from(!shaft.joints.is_empty()));
            ran.add(Stage::Unbalance, shaft.looks * u64::from(!shaft.unbalances.is_empty()));
        }
        if let Some(cage) = &self.cage {
            ran.add(Stage::Pockets, cage.looks);
            ran.add(Stage::Guide, cage.looks * u64::from(cage.is_guided()));
        }
        ran
    }

    pub(crate) fn forget_ran(&mut self) {
        self.solid.ran = Counts::default();
        self.seats.iter_mut().for_each(SeatState::forget_ran);
        self.shaft.iter_mut().for_each(|shaft| shaft.looks = 0);
        self.cage.iter_mut().for_each(|cage| cage.looks = 0);
    }

    /// Sets the steps for a coupling step of this length (s), before the first one.
    pub(crate) fn step_in(&mut self, coupling_step: f64, simulation: &Simulation) {
        self.solid.step_size = coupling_step / self.steps as f64;
        self.solid.time = 0.5 * self.solid.step_size;
        if let Some(shaft) = &self.shaft {
            shaft.spin_up(&mut self.solid);
        }
        if let Some(cage) = &self.cage {
            cage.place(&mut self.solid, simulation);
        }
    }

    /// Energies of the solid and its housing fits, with the bodies of `simulation`.
    pub(crate) fn snapshot(&mut self, simulation: &Simulation) -> SolidSnapshot {
        let SteppedSolid { solid, seats, shaft, cage, .. } = self;
        let ahead = 0.5 * solid.step_size;
        let mut found = Vec::with_capacity(seats.len());
        let mut on_nodes: Vec<Node> = Vec::new();
        let (mut joints, mut unbalance_work) = (Vec::new(), 0.0);
        if let Some(shaft) = shaft {
            on_nodes.resize(solid.displacement.len(), [0.0; 4]);
            let now = (solid.time, &solid.displacement[..], solid.rates());
            (joints, unbalance_work) = shaft.snapshot(simulation, ahead, now, &mut on_nodes);
        }
        if let Some(cage) = cage {
            on_nodes.resize(solid.displacement.len(), [0.0; 4]);
            joints.push(cage.snapshot(simulation, ahead, solid, &mut on_nodes));
        }
        let ledger = solid.ledger_with(|t, displacement, forces| {
            for seat in seats.iter() {
                let body = simulation.body(seat.seat.mount.body);
                found.push(seat.snapshot(&body, [t, ahead], displacement, forces));
            }
            for (sum, more) in forces.iter_mut().zip(&on_nodes) {
                for (sum, more) in sum.iter_mut().zip(more) {
                    *sum += more;
                }
            }
        });
        SolidSnapshot { ledger, seats: found, joints, unbalance_work }
    }

    pub(crate) fn sort(&mut self, simulation: &Simulation) {
        for seat in &mut self.seats {
            seat.sort(&simulation.body(seat.seat.mount.body), &self.solid);
        }
    }
}

/// Assigns the housing fits to their solids, with the nodes under the races; returns them in that order.
pub(crate) fn seated(
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
