//! Section of `state.json` with the state of bodies and bearings.

use super::entries::Refused;
use crate::assembly::ledger_watch::LedgerWatch;
use crate::assembly::lists::Assembly;
use crate::members::contacts::Work;
use crate::motion::checkpoint::Checkpoint as BearingCheckpoint;
use crate::motion::energy::Energy;
use crate::motion::energy_ledger::{Balance, ContactTurnover};
use crate::motion::error_control::Memory;
use crate::motion::extremes::Extremes;
use crate::motion::stability::StepLimit;
use crate::motion::step_watch::{StepWatch, Stiffness};
use nalgebra::Complex;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BearingEntry {
    pub steps: u64,
    pub step_size: f64,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub limit: Option<LimitEntry>,
    pub step_watch: StepWatchEntry,
    /// See [`Extremes::to_numbers`].
    pub extremes: Vec<f64>,
    pub state: Vec<f64>,
    /// Initial energies: kinetic, contact, cage contact, gravity, foundation, ball contact, J.
    pub first_energy: [f64; 6],
    /// Initial energies of reduced solids: kinetic, strain, fits, J.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub first_energy_of_solids: Option<[f64; 3]>,
    /// Initial energies of shaft bending: kinetic, strain, J.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub first_energy_of_bending: Option<[f64; 2]>,
    /// Initial strain energy of flexible cages, J.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub first_energy_of_cages: Option<f64>,
    pub largest_contact_energy: f64,
    /// See [`ContactTurnover`]: sum and last, J.
    pub contact_turnover: [f64; 2],
    /// See [`LedgerWatch`]: energy exchanged and the largest residual, J; number of checks that did not close.
    pub ledger: ([f64; 2], u32),
    /// Evaluations, distance tests, loaded contacts, slices, pocket tests, guide tests,
    /// ball tests, factorisations, rejected steps.
    pub work: [u64; 9],
    /// With error control: largest overlap (m), error of the previous step, smallest and largest
    /// step (s).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub control: Option<[f64; 4]>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitEntry {
    pub step: f64,
    /// Real and imaginary part, 1/s.
    pub eigenvalue: [f64; 2],
    /// Index in the state vector.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub component: Option<usize>,
}

/// See [`StepWatch`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepWatchEntry {
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub smallest: Option<f64>,
    /// Stiffest oscillation, 1/s², and decay, 1/s.
    pub stiffest: [f64; 2],
    pub shortened: u64,
}

impl BearingEntry {
    pub(super) fn of(checkpoint: &BearingCheckpoint) -> BearingEntry {
        let balance = &checkpoint.balance;
        let energy = &balance.first;
        let watch = &checkpoint.step_watch;
        BearingEntry {
            steps: checkpoint.steps,
            step_size: checkpoint.step_size,
            limit: checkpoint.limit.map(|limit| LimitEntry {
                step: limit.step,
                eigenvalue: [limit.eigenvalue.re, limit.eigenvalue.im],
                component: limit.component,
            }),
            step_watch: StepWatchEntry {
                smallest: watch.smallest,
                stiffest: [watch.stiffest.oscillation, watch.stiffest.decay],
                shortened: watch.shortened,
            },
            extremes: checkpoint.extremes.iter().flat_map(Extremes::to_numbers).collect(),
            state: checkpoint.state.clone(),
            first_energy: [
                energy.kinetic,
                energy.contact,
                energy.cage_contact,
                energy.gravity,
                energy.foundation,
                energy.ball_contact,
            ],
            first_energy_of_solids: Some([energy.solid_kinetic, energy.solid_strain, energy.seat])
                .filter(|of| *of != [0.0; 3]),
            first_energy_of_bending: Some([energy.bending_kinetic, energy.bending_strain])
                .filter(|of| *of != [0.0; 2]),
            first_energy_of_cages: Some(energy.cage_strain).filter(|of| *of != 0.0),
            largest_contact_energy: balance.largest_contact,
            contact_turnover: [balance.turnover.sum, balance.turnover.last],
            ledger: (
                [balance.watch.turned_over, balance.watch.largest_residual],
                balance.watch.open,
            ),
            work: checkpoint.work.clone().counts().map(|count| *count),
            control: checkpoint.control.map(|memory| {
                [memory.displacement, memory.previous_error, memory.smallest, memory.largest]
            }),
        }
    }

    /// Values that must be finite, by kind.
    pub(super) fn numbers(&self) -> Vec<(&'static str, Vec<f64>)> {
        let limit = self.limit.iter().flat_map(|l| [l.step, l.eigenvalue[0], l.eigenvalue[1]]);
        let watch = &self.step_watch;
        let limits = watch.stiffest.into_iter().chain(watch.smallest);
        let limit = limit.chain(limits);
        let energy = [self.step_size, self.largest_contact_energy].into_iter();
        let energy =
            energy.chain(self.first_energy).chain(self.contact_turnover).chain(self.ledger.0);
        let energy = energy.chain(self.first_energy_of_solids.into_iter().flatten());
        let energy = energy.chain(self.first_energy_of_bending.into_iter().flatten());
        let energy = energy.chain(self.first_energy_of_cages);
        vec![
            ("an extreme", self.extremes.clone()),
            ("a size of the error control", self.control.into_iter().flatten().collect()),
            ("a step or an energy", energy.collect()),
            ("a step limit", limit.collect()),
            ("an entry of the state", self.state.clone()),
        ]
    }

    /// # Errors
    /// Lists of the wrong length, an invalid step.
    pub(super) fn checked(
        &self,
        time: f64,
        assembly: &Assembly,
    ) -> Result<BearingCheckpoint, Refused> {
        let checkpoint = self.checkpoint(time);
        let damaged = |what| Err(Refused::Damaged(what));
        if Extremes::all_from_numbers(&self.extremes).is_none_or(|all| all.is_empty()) {
            return damaged("its extremes are not as many as a bearing has");
        }
        if !checkpoint.fits(assembly) {
            return damaged("its lists have other lengths than the bearing asks for");
        }
        if self.step_size <= 0.0 {
            return damaged("no step from one row to the next");
        }
        Ok(checkpoint)
    }

    fn checkpoint(&self, time: f64) -> BearingCheckpoint {
        let [oscillation, decay] = self.step_watch.stiffest;
        let [kinetic, contact, cage_contact, gravity, foundation, ball_contact] = self.first_energy;
        let [solid_kinetic, solid_strain, seat] = self.first_energy_of_solids.unwrap_or_default();
        let [bending_kinetic, bending_strain] = self.first_energy_of_bending.unwrap_or_default();
        let cage_strain = self.first_energy_of_cages.unwrap_or_default();
        let mut work = Work::default();
        for (count, kept) in work.counts().into_iter().zip(self.work) {
            *count = kept;
        }
        BearingCheckpoint {
            time,
            steps: self.steps,
            step_size: self.step_size,
            limit: self.limit.as_ref().map(|limit| StepLimit {
                step: limit.step,
                eigenvalue: Complex::new(limit.eigenvalue[0], limit.eigenvalue[1]),
                component: limit.component,
            }),
            step_watch: StepWatch {
                smallest: self.step_watch.smallest,
                stiffest: Stiffness { oscillation, decay },
                shortened: self.step_watch.shortened,
            },
            extremes: Extremes::all_from_numbers(&self.extremes).unwrap_or_default(),
            state: self.state.clone(),
            balance: Balance {
                first: Energy {
                    kinetic,
                    contact,
                    cage_contact,
                    gravity,
                    foundation,
                    ball_contact,
                    solid_kinetic,
                    solid_strain,
                    bending_kinetic,
                    bending_strain,
                    seat,
                    cage_strain,
                },
                before: 0.0,
                largest_contact: self.largest_contact_energy,
                turnover: ContactTurnover {
                    sum: self.contact_turnover[0],
                    last: self.contact_turnover[1],
                },
                watch: LedgerWatch {
                    first: 0.0,
                    turned_over: self.ledger.0[0],
                    largest_residual: self.ledger.0[1],
                    open: self.ledger.1,
                },
            },
            work,
            control: self.control.map(|[displacement, previous_error, smallest, largest]| Memory {
                displacement,
                previous_error,
                smallest,
                largest,
            }),
        }
    }
}
