//! Friction springs of bores in a state: `state-N.friction.npy`, one row per contact node.

use super::StateError;
use super::arrays::{table, write_table};
use super::entries::Refused;
use crate::ch4_rotor::bore_friction::Spring;
use crate::motion::bore_friction::NodeSpring;
use crate::motion::coupled_checkpoint::{CouplingCheckpoint, FrictionCheckpoint, SeatCheckpoint};
use crate::output::session::HousedParts;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Values per node: number, anchor of the spring on the race (m), elongation (m), stiffness (N/m).
const WIDTH: usize = 8;

/// See [`FrictionCheckpoint`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionEntry {
    /// File with the springs of all fits in sequence.
    pub arrays: String,
    /// For each fit with friction, in order: number of springs, frictional heat and energy stored by the normal load, J.
    pub seats: Vec<(usize, [f64; 2])>,
}

fn name(coupling_steps: u64) -> String {
    format!("state-{coupling_steps}.friction.npy")
}

fn kept(checkpoint: &CouplingCheckpoint) -> impl Iterator<Item = &FrictionCheckpoint> {
    let seats = checkpoint.solids.iter().flat_map(|solid| &solid.seats);
    seats.filter_map(|seat| seat.friction.as_ref())
}

pub(super) fn write(folder: &Path, checkpoint: &CouplingCheckpoint) -> Result<(), StateError> {
    let row = |(node, spring): &NodeSpring| -> [f64; WIDTH] {
        let ([a, b, c], [x, y, z]) = (spring.anchor, spring.stretch);
        [f64::from(*node), a, b, c, x, y, z, spring.stiffness]
    };
    let rows: Vec<f64> = kept(checkpoint).flat_map(|of| &of.springs).flat_map(row).collect();
    if kept(checkpoint).next().is_none() {
        return Ok(());
    }
    write_table(folder, &name(checkpoint.exchanges), WIDTH, rows)
}

impl FrictionEntry {
    /// `None` if all bores are frictionless.
    pub(super) fn of(checkpoint: &CouplingCheckpoint) -> Option<FrictionEntry> {
        let of = |seat: &FrictionCheckpoint| (seat.springs.len(), [seat.heat, seat.load_work]);
        let seats: Vec<_> = kept(checkpoint).map(of).collect();
        let arrays = name(checkpoint.exchanges);
        (!seats.is_empty()).then_some(FrictionEntry { arrays, seats })
    }

    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        self.seats.iter().flat_map(|(_, energies)| *energies)
    }
}

/// Restores the friction of the fits that have it: those of each solid, in the order of the solids.
pub(super) fn read(
    folder: &Path,
    entry: Option<&FrictionEntry>,
    parts: &HousedParts,
    seats: &mut [&mut SeatCheckpoint],
) -> Result<(), Refused> {
    const OTHER_FRICTION: Refused =
        Refused::Damaged("the friction of its bores differs from the scene");
    let by_solid = (0..parts.solids.len())
        .flat_map(|solid| parts.seats.iter().filter(move |seat| seat.solid == solid));
    let rough = seats.iter_mut().zip(by_solid).filter(|(_, seat)| seat.friction.is_some());
    let rough: Vec<_> = rough.collect();
    let Some(FrictionEntry { arrays, seats }) = entry else {
        return if rough.is_empty() { Ok(()) } else { Err(OTHER_FRICTION) };
    };
    if seats.len() != rough.len() {
        return Err(OTHER_FRICTION);
    }
    let rows = table(folder, arrays, (seats.iter().map(|(springs, _)| springs).sum(), WIDTH))?;
    let mut rows = rows.data().rows().into_iter();
    for ((kept, seat), (springs, [heat, load_work])) in rough.into_iter().zip(seats) {
        let mut list: Vec<NodeSpring> = Vec::with_capacity(*springs);
        for row in rows.by_ref().take(*springs) {
            let known = seat.nodes.iter().find(|node| f64::from(node.node) == row[0]);
            let follows = |node: u32| list.last().is_none_or(|(last, _)| *last < node);
            let Some(node) = known.map(|node| node.node).filter(|node| follows(*node)) else {
                return Err(Refused::Damaged("a friction spring is not at a node of its bore"));
            };
            let vector = |from: usize| [row[from], row[from + 1], row[from + 2]];
            let (anchor, stretch, stiffness) = (vector(1), vector(4), row[7]);
            list.push((node, Spring { anchor, stretch, stiffness }));
        }
        let (heat, load_work) = (*heat, *load_work);
        kept.friction = Some(FrictionCheckpoint { springs: list, heat, load_work });
    }
    Ok(())
}
