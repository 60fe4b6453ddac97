//! Number of runs of each stage, counted by the code that does its work: once an evaluation and stage, never once a
//! contact.

use crate::plan::{Stage, Subject};
use serde::{Deserialize, Serialize};

/// Counts of one subject's stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "Vec<u64>", try_from = "Vec<u64>")]
pub struct Counts([u64; Stage::COUNT]);

impl Default for Counts {
    fn default() -> Counts {
        Counts([0; Stage::COUNT])
    }
}

impl From<Counts> for Vec<u64> {
    fn from(counts: Counts) -> Vec<u64> {
        counts.0.to_vec()
    }
}

impl TryFrom<Vec<u64>> for Counts {
    type Error = &'static str;

    fn try_from(counts: Vec<u64>) -> Result<Counts, &'static str> {
        counts.try_into().map(Counts).map_err(|_| "as many counts as there are stages")
    }
}

impl Counts {
    #[inline]
    pub fn add(&mut self, stage: Stage, times: u64) {
        self.0[stage as usize] += times;
    }

    /// Removes a count, to be booked elsewhere.
    #[inline]
    pub fn take(&mut self, stage: Stage) -> u64 {
        std::mem::take(&mut self.0[stage as usize])
    }

    pub fn of(&self, stage: Stage) -> u64 {
        self.0[stage as usize]
    }

    pub fn absorb(&mut self, other: &Counts) {
        self.0.iter_mut().zip(&other.0).for_each(|(to, more)| *to = to.saturating_add(*more));
    }
}

/// Counts of all stages, in the lists of an assembly.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StageCounts {
    pub whole: Counts,
    pub bearings: Vec<Counts>,
    pub bodies: Vec<Counts>,
    pub solids: Vec<Counts>,
    pub seats: Vec<Counts>,
}

impl StageCounts {
    pub fn new(bearings: usize, bodies: usize, solids: usize, seats: usize) -> StageCounts {
        let room = |count| vec![Counts::default(); count];
        StageCounts {
            whole: Counts::default(),
            bearings: room(bearings),
            bodies: room(bodies),
            solids: room(solids),
            seats: room(seats),
        }
    }

    /// Resets all counts.
    pub fn clear(&mut self) {
        let StageCounts { whole, bearings, bodies, solids, seats } = self;
        *whole = Counts::default();
        [bearings, bodies, solids, seats].into_iter().for_each(|list| list.fill(Counts::default()));
    }

    /// Copies counts without allocating if there is room.
    pub fn copy_from(&mut self, other: &StageCounts) {
        self.whole = other.whole;
        self.bearings.clone_from(&other.bearings);
        self.bodies.clone_from(&other.bodies);
        self.solids.clone_from(&other.solids);
        self.seats.clone_from(&other.seats);
    }

    /// Adds the counts of another part of the solution.
    pub fn absorb(&mut self, other: &StageCounts) {
        self.whole.absorb(&other.whole);
        let lists = [
            (&mut self.bearings, &other.bearings),
            (&mut self.bodies, &other.bodies),
            (&mut self.solids, &other.solids),
            (&mut self.seats, &other.seats),
        ];
        for (to, more) in lists {
            to.resize(to.len().max(more.len()), Counts::default());
            to.iter_mut().zip(more).for_each(|(to, more)| to.absorb(more));
        }
    }

    pub fn of(&self, stage: Stage, subject: Subject) -> u64 {
        let in_list = |list: &[Counts], at: usize| list.get(at).map_or(0, |tally| tally.of(stage));
        match subject {
            Subject::Whole => self.whole.of(stage),
            Subject::Bearing(at) => in_list(&self.bearings, at),
            Subject::Body(at) => in_list(&self.bodies, at),
            Subject::Solid(at) => in_list(&self.solids, at),
            Subject::Seat(at) => in_list(&self.seats, at),
        }
    }

    /// Adds to a count.
    pub fn add(&mut self, stage: Stage, subject: Subject, times: u64) {
        let (list, at) = match subject {
            Subject::Whole => return self.whole.add(stage, times),
            Subject::Bearing(at) => (&mut self.bearings, at),
            Subject::Body(at) => (&mut self.bodies, at),
            Subject::Solid(at) => (&mut self.solids, at),
            Subject::Seat(at) => (&mut self.seats, at),
        };
        list.resize(list.len().max(at + 1), Counts::default());
        list[at].add(stage, times);
    }

    /// Stages with at least one run.
    pub fn list(&self) -> Vec<(Stage, Subject, u64)> {
        let subjects = std::iter::once(Subject::Whole)
            .chain((0..self.bearings.len()).map(Subject::Bearing))
            .chain((0..self.bodies.len()).map(Subject::Body))
            .chain((0..self.solids.len()).map(Subject::Solid))
            .chain((0..self.seats.len()).map(Subject::Seat));
        let of = |subject| {
            Stage::ALL.into_iter().map(move |stage| (stage, subject, self.of(stage, subject)))
        };
        subjects.flat_map(of).filter(|(_, _, count)| *count > 0).collect()
    }
}
