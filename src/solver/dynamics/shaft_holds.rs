//! Where bearings, connections and seats take hold of bodies that bend.

use super::assembly::Assembly;
use super::ball_set::onto_body;
use super::race::{RaceLoads, RaceNow, mounted};
use super::shaft::{Bend, ElasticShaft, Section, SectionNow};
use crate::solver::mount::Mount;

/// One section, as last placed.
#[derive(Clone, Debug)]
pub struct Hold {
    /// Index in [`Assembly::shafts`].
    pub shaft: usize,
    pub section: Section,
    pub now: SectionNow,
}

/// Of every mount in an assembly; `None` on bodies that do not bend.
#[derive(Clone, Debug, Default)]
pub struct Holds {
    /// Inner and outer race of each bearing.
    pub bearings: Vec<[Option<Hold>; 2]>,
    /// Both ends.
    pub connections: Vec<[Option<Hold>; 2]>,
    pub seats: Vec<Option<Hold>>,
}

impl Holds {
    pub fn new(assembly: &Assembly, bodies: &[RaceNow]) -> Holds {
        let hold = |mount: &Mount| {
            let shaft = assembly.shafts.iter().position(|shaft| shaft.body == mount.body)?;
            let section = assembly.shafts[shaft].shapes.section(mount.along);
            let unbent = vec![0.0; assembly.shafts[shaft].entries()];
            let now = section.place(
                &bodies[mount.body],
                mount,
                &Bend::of(section.deflection.len(), &unbent),
            );
            Some(Hold { shaft, section, now })
        };
        Holds {
            bearings: assembly.bearings.iter().map(|of| of.mounts.each_ref().map(hold)).collect(),
            connections: assembly
                .connections
                .iter()
                .map(|of| of.ends.each_ref().map(hold))
                .collect(),
            seats: assembly.seats.iter().map(|of| hold(&of.race)).collect(),
        }
    }

    /// Takes all to where their bodies are, `shafts` the first entries of each in the state.
    pub fn place(
        &mut self,
        assembly: &Assembly,
        shafts: &[usize],
        bodies: &[RaceNow],
        state: &[f64],
    ) {
        let put = |hold: &mut Option<Hold>, mount: &Mount| {
            let Some(hold) = hold else { return };
            let bend = assembly.shafts[hold.shaft].bend(shafts[hold.shaft], state);
            hold.now = hold.section.place(&bodies[mount.body], mount, &bend);
        };
        for (holds, of) in self.bearings.iter_mut().zip(&assembly.bearings) {
            holds.iter_mut().zip(&of.mounts).for_each(|(hold, mount)| put(hold, mount));
        }
        for (holds, of) in self.connections.iter_mut().zip(&assembly.connections) {
            holds.iter_mut().zip(&of.ends).for_each(|(hold, mount)| put(hold, mount));
        }
        for (hold, of) in self.seats.iter_mut().zip(&assembly.seats) {
            put(hold, &of.race);
        }
    }

    /// Their sections in the order of bearings, connections and seats, with what they sit on.
    pub fn all<'h>(&'h self, assembly: &'h Assembly) -> impl Iterator<Item = (&'h Hold, Mount)> {
        let bearings = self.bearings.iter().zip(&assembly.bearings);
        let bearings = bearings.flat_map(|(holds, of)| holds.iter().zip(of.mounts));
        let connections = self.connections.iter().zip(&assembly.connections);
        let connections = connections.flat_map(|(holds, of)| holds.iter().zip(of.ends));
        let seats = self.seats.iter().zip(assembly.seats.iter().map(|seat| seat.race));
        let all = bearings.chain(connections).chain(seats);
        all.filter_map(|(hold, mount)| Some((hold.as_ref()?, mount)))
    }
}

impl ElasticShaft {
    /// How it is bent in a state, its entries from `at` on.
    pub fn bend<'s>(&self, at: usize, state: &'s [f64]) -> Bend<'s> {
        Bend::of(self.count(), &state[at..at + self.entries()])
    }

    /// Rates of its speeds among those of the whole state.
    pub fn pushes<'r>(&self, at: usize, rates: &'r mut [f64]) -> &'r mut [f64] {
        &mut rates[at + self.amplitudes()..at + self.entries()]
    }
}

/// What sits at a mount, on a section that is held or on a rigid body.
pub fn sitting(hold: &Option<Hold>, body: &RaceNow, mount: &Mount) -> RaceNow {
    hold.as_ref().map_or_else(|| mounted(body, mount), |hold| hold.now.race)
}

/// Shafts, where each begins in the state, and the state.
pub type Bent<'b> = (&'b [ElasticShaft], &'b [usize], &'b [f64]);

/// Loads at a mount as its body feels them; shapes get theirs.
pub fn handed_on(
    (hold, mount): (&Option<Hold>, &Mount),
    (sits, body): (&RaceNow, &RaceNow),
    loads: &RaceLoads,
    (shafts, at, state): Bent,
    rates: &mut [f64],
) -> RaceLoads {
    match hold {
        None => onto_body(mount, sits, body, loads),
        Some(hold) => {
            let (shaft, at) = (&shafts[hold.shaft], at[hold.shaft]);
            let bend = shaft.bend(at, state);
            hold.section.take((body, &bend), &hold.now, loads, shaft.pushes(at, rates))
        }
    }
}
