//! Sections of `state.json` as plain numbers.

use super::{
    StateFile,
    arrays::{arrays_name, bushings_name, read_arrays, read_touching, table},
    friction_entry::{self, FrictionEntry},
};
use crate::equilibrium::quasi_static_sequence::{Effort, QuasiStaticCheckpoint};
use crate::equilibrium::warm_started_search::SearchMemory;
use crate::motion::checkpoint::Checkpoint as BearingCheckpoint;
use crate::motion::coupled_checkpoint::{
    CouplingCheckpoint, CouplingSteps, SeatCheckpoint, SteppedCheckpoint,
};
use crate::motion::race_in_bore::Growth;
use crate::output::series::SeriesError;
use crate::output::session::{Checkpoint, HousedParts, Parts};
use crate::solids::checkpoint::SolidCheckpoint;
use crate::solids::explicit::SolidWork;
use crate::solids::step_limit::SolidStepLimit;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::path::Path;

pub(super) enum Refused {
    Damaged(&'static str),
    Series(SeriesError),
}

impl From<SeriesError> for Refused {
    fn from(error: SeriesError) -> Self {
        Refused::Series(error)
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidEntry {
    /// File with one row per node, all solids in sequence: displacement (m), rate (m/s), work of
    /// loads and of damping (J).
    pub arrays: String,
    /// s.
    pub time: f64,
    pub steps: u64,
    pub limit: SolidLimitEntry,
    /// Number of force evaluations and of evaluated elements.
    pub work: [u64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidLimitEntry {
    pub step: f64,
    pub frequency: f64,
    pub is_bound: bool,
    pub element: usize,
    pub element_frequency: f64,
    pub at: [f64; 3],
    pub products: usize,
}

impl SolidLimitEntry {
    fn of(limit: &SolidStepLimit) -> SolidLimitEntry {
        SolidLimitEntry {
            step: limit.step,
            frequency: limit.frequency,
            is_bound: limit.is_bound,
            element: limit.element,
            element_frequency: limit.element_frequency,
            at: limit.at,
            products: limit.products,
        }
    }

    fn to_limit(self) -> SolidStepLimit {
        SolidStepLimit {
            step: self.step,
            frequency: self.frequency,
            is_bound: self.is_bound,
            element: self.element,
            element_frequency: self.element_frequency,
            at: self.at,
            products: self.products,
        }
    }
}

/// State of the coupling between bodies and solids.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExchangeEntry {
    /// Number of steps of each solid in a coupling step.
    pub steps_per_coupling_step: Vec<usize>,
    pub seats: Vec<Vec<SeatEntry>>,
    /// File with the values of all bushings in one column, and the number of values of each.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub bushings: Option<(String, Vec<usize>)>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub friction: Option<FrictionEntry>,
    /// For each shaft in elements: work and heat of its joints, work of its unbalances, J; empty for other solids.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub shafts: Vec<Vec<f64>>,
    /// Initial value of the total energy balance, J.
    pub first: f64,
}

/// See [`SeatCheckpoint`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeatEntry {
    /// N·s.
    pub impulse: [f64; 3],
    /// Work on the body, J.
    pub work: f64,
    /// Work (J), radius (m) and load (N) of an interference that is applied gradually.
    pub growth: [f64; 3],
    pub tested: u64,
    pub sorts: u64,
}

/// State of a quasi-static sequence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SequenceEntry {
    /// File with one row per node of all bores in sequence: 1 for a contact node.
    pub arrays: String,
    pub largest_residual: f64,
    pub iterations: usize,
    pub contact_changes: usize,
    /// Body coordinates of the last equilibrium (m, rad).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub places: Option<Vec<[f64; 5]>>,
}

impl SolidEntry {
    pub(super) fn of(kept: &SolidCheckpoint, limit: &SolidStepLimit, number: u64) -> SolidEntry {
        SolidEntry {
            arrays: arrays_name(number),
            time: kept.time,
            steps: kept.steps,
            limit: SolidLimitEntry::of(limit),
            work: [kept.work.evaluations, kept.work.elements],
        }
    }

    /// Checkpoint of this solid, whose arrays are `rows` of a file with `nodes` rows in total.
    fn checkpoint(
        &self,
        folder: &Path,
        nodes: usize,
        rows: Range<usize>,
    ) -> Result<SolidCheckpoint, Refused> {
        Ok(SolidCheckpoint {
            time: self.time,
            steps: self.steps,
            work: SolidWork { evaluations: self.work[0], elements: self.work[1] },
            ..read_arrays(folder, &self.arrays, nodes, rows)?
        })
    }
}

impl ExchangeEntry {
    pub(super) fn of(kept: &CouplingCheckpoint, coupling_steps: &CouplingSteps) -> ExchangeEntry {
        let lengths: Vec<usize> = kept.bushings.iter().map(Vec::len).collect();
        let shafts: Vec<Vec<f64>> = kept.solids.iter().map(|part| part.attached.clone()).collect();
        let file = || bushings_name(kept.exchanges);
        let seats = |part: &SteppedCheckpoint| part.seats.iter().map(SeatEntry::of).collect();
        ExchangeEntry {
            steps_per_coupling_step: coupling_steps
                .solids
                .iter()
                .map(|(steps, _)| *steps)
                .collect(),
            seats: kept.solids.iter().map(seats).collect(),
            bushings: (!lengths.is_empty()).then(|| (file(), lengths)),
            friction: FrictionEntry::of(kept),
            shafts: if shafts.iter().all(Vec::is_empty) { Vec::new() } else { shafts },
            first: kept.first,
        }
    }

    pub(super) fn numbers(&self) -> Vec<f64> {
        let of = |seat: &SeatEntry| seat.impulse.into_iter().chain(seat.growth).chain([seat.work]);
        let friction = self.friction.iter().flat_map(FrictionEntry::numbers);
        let shafts = self.shafts.iter().flatten().copied();
        let seats = self.seats.iter().flatten().flat_map(of);
        seats.chain([self.first]).chain(friction).chain(shafts).collect()
    }
}

impl SeatEntry {
    fn of(kept: &SeatCheckpoint) -> SeatEntry {
        SeatEntry {
            impulse: kept.impulse,
            work: kept.work,
            growth: [kept.growth.work, kept.growth.radius, kept.growth.load],
            tested: kept.tested,
            sorts: kept.sorts,
        }
    }

    fn checkpoint(&self) -> SeatCheckpoint {
        let [work, radius, load] = self.growth;
        SeatCheckpoint {
            impulse: self.impulse,
            work: self.work,
            growth: Growth { work, radius, load },
            tested: self.tested,
            sorts: self.sorts,
            friction: None,
        }
    }
}

impl SequenceEntry {
    pub(super) fn of(kept: &QuasiStaticCheckpoint) -> SequenceEntry {
        SequenceEntry {
            arrays: arrays_name(kept.found),
            largest_residual: kept.effort.largest_residual,
            iterations: kept.effort.iterations,
            contact_changes: kept.effort.contact_changes,
            places: kept.memory.places.clone(),
        }
    }
}

/// Time (s) and number of steps, coupling steps or equilibria of a checkpoint.
pub(super) fn place(checkpoint: &Checkpoint) -> (f64, u64) {
    match checkpoint {
        Checkpoint::Bearing(kept) => (kept.time, kept.steps),
        Checkpoint::Solid(kept, _) => (kept.time, kept.steps),
        Checkpoint::Housed(kept, _) => (kept.simulation.time, kept.exchanges),
        Checkpoint::QuasiStaticSequence(kept) => (kept.time, kept.found),
        Checkpoint::Rubber(kept, rows) => (kept.state.time, *rows),
    }
}

const MISSING_PART: Refused = Refused::Damaged("a part of the scene is missing");

/// Checkpoint from a state file in `folder` for these parts.
pub(super) fn checkpoint(
    folder: &Path,
    file: &StateFile,
    parts: &Parts,
) -> Result<Checkpoint, Refused> {
    let bearing = || file.bearing.as_deref().ok_or(MISSING_PART);
    Ok(match parts {
        Parts::Bearing(assembly) => {
            Checkpoint::Bearing(Box::new(bearing()?.checked(file.time, assembly)?))
        }
        Parts::Solid(parts) => {
            let [solid] = file.solids.as_slice() else { return Err(MISSING_PART) };
            let nodes = parts.setup.problem.nodes.len();
            let kept = solid.checkpoint(folder, nodes, 0..nodes)?;
            Checkpoint::Solid(Box::new(kept), solid.limit.to_limit())
        }
        Parts::Housed(parts) => {
            let simulation = bearing()?.checked(file.time, &parts.assembly)?;
            let (kept, coupling_steps) = exchange(folder, file, parts, simulation)?;
            Checkpoint::Housed(Box::new(kept), coupling_steps)
        }
        Parts::QuasiStaticSequence(parts) => {
            let sequence = file.sequence.as_ref().ok_or(MISSING_PART)?;
            let problem = &parts.problem;
            let nodes: Vec<usize> = problem.seats.iter().map(|s| s.bore.nodes.len()).collect();
            let touching = read_touching(folder, &sequence.arrays, &nodes)?;
            let places = sequence.places.clone();
            if places.as_ref().is_some_and(|at| at.len() != problem.assembly.bodies.len()) {
                return Err(MISSING_PART);
            }
            Checkpoint::QuasiStaticSequence(QuasiStaticCheckpoint {
                time: file.time,
                found: file.steps,
                effort: Effort {
                    largest_residual: sequence.largest_residual,
                    iterations: sequence.iterations,
                    contact_changes: sequence.contact_changes,
                },
                memory: SearchMemory { places, touching },
                nodes,
            })
        }
        Parts::Rubber(parts) => {
            let kept = file.rubber.as_ref().ok_or(MISSING_PART)?;
            Checkpoint::Rubber(Box::new(kept.checkpoint(folder, file.time, parts)?), file.steps)
        }
    })
}

/// Checkpoint of bodies, given in `simulation`, and solids with the fits between them.
fn exchange(
    folder: &Path,
    file: &StateFile,
    parts: &HousedParts,
    simulation: BearingCheckpoint,
) -> Result<(CouplingCheckpoint, CouplingSteps), Refused> {
    let exchange = file.exchange.as_ref().ok_or(MISSING_PART)?;
    let ExchangeEntry { steps_per_coupling_step, seats, .. } = exchange;
    let count = parts.solids.len();
    if [file.solids.len(), steps_per_coupling_step.len(), seats.len()] != [count; 3] {
        return Err(MISSING_PART);
    }
    if steps_per_coupling_step.contains(&0) {
        return Err(Refused::Damaged("no step from one row to the next"));
    }
    let nodes: Vec<usize> = parts.solids.iter().map(|part| part.model.mass.len()).collect();
    let mut solids = Vec::with_capacity(count);
    for (index, (entry, seats)) in file.solids.iter().zip(seats).enumerate() {
        if seats.len() != parts.seats.iter().filter(|seat| seat.solid == index).count() {
            return Err(MISSING_PART);
        }
        let attached = exchange.shafts.get(index).cloned().unwrap_or_default();
        let part = &parts.solids[index];
        let of_shaft = part.shaft.as_ref().map(|of| 2 * of.joints.len() + 1);
        if attached.len() != of_shaft.or(part.cage.as_ref().map(|_| 2)).unwrap_or(0) {
            return Err(MISSING_PART);
        }
        let from: usize = nodes[..index].iter().sum();
        let rows = from..from + nodes[index];
        solids.push(SteppedCheckpoint {
            solid: entry.checkpoint(folder, nodes.iter().sum(), rows)?,
            seats: seats.iter().map(SeatEntry::checkpoint).collect(),
            attached,
        });
    }
    let mut seats: Vec<_> = solids.iter_mut().flat_map(|part| &mut part.seats).collect();
    friction_entry::read(folder, exchange.friction.as_ref(), parts, &mut seats)?;
    let limits = file.solids.iter().map(|entry| entry.limit.to_limit());
    let coupling_steps = CouplingSteps {
        coupling_step: file.step,
        solids: steps_per_coupling_step.iter().copied().zip(limits).collect(),
    };
    let (exchanges, first) = (file.steps, exchange.first);
    let bushings = read_bushings(folder, exchange, parts)?;
    Ok((CouplingCheckpoint { simulation, solids, bushings, exchanges, first }, coupling_steps))
}

fn read_bushings(
    folder: &Path,
    exchange: &ExchangeEntry,
    parts: &HousedParts,
) -> Result<Vec<Vec<f64>>, Refused> {
    let none = (String::new(), Vec::new());
    let (file, lengths) = exchange.bushings.as_ref().unwrap_or(&none);
    if lengths.len() != parts.bushings.len() {
        return Err(MISSING_PART);
    }
    if lengths.is_empty() {
        return Ok(Vec::new());
    }
    for (length, part) in lengths.iter().zip(&parts.bushings) {
        if !part.may_have(*length) {
            return Err(Refused::Damaged("its arrays have another shape than the mesh asks for"));
        }
    }
    let column = table(folder, file, (lengths.iter().sum(), 1))?;
    let mut all = column.data().iter().copied();
    Ok(lengths.iter().map(|length| all.by_ref().take(*length).collect()).collect())
}
