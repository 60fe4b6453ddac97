//! State of a bushing bonded between bodies as one list of numbers, from which it continues with the same bits.

use crate::elements::tet10::POINTS;
use crate::kinematics::vec3::Vec3;
use crate::members::rigid_body::Wrench;
use crate::motion::bonded_bushing::{
    BondedBushing, BondedElements, BondedPart, BondedRubber, SleeveNow,
};
use crate::solids::checkpoint::SolidCheckpoint;
use crate::solids::rubber::checkpoint::{Factored, RubberCheckpoint, RubberState};
use crate::solids::rubber::steps::StepCounts;
use crate::solids::tet4_blocks::{LANES, Node};

/// Number of entries of [`BondedBushing::numbers`] before the nodes.
const OF_IMPLICIT: usize = 13;
const OF_EXPLICIT: usize = 4;
const OF_SLEEVE: usize = 19;

impl BondedPart<'_> {
    /// Returns whether this may be the length of this bushing's state ([`BondedBushing::numbers`]).
    pub fn may_have(&self, count: usize) -> bool {
        let sleeves = 1 + OF_SLEEVE * self.sleeves.len();
        match &self.elements {
            BondedElements::Explicit { body, .. } => {
                let blocks = body.elements.len().div_ceil(LANES);
                let memory = 6 * LANES * blocks * (body.material.maxwell.len() + 2);
                count == sleeves + OF_EXPLICIT + 6 * body.nodes.len() + memory
            }
            BondedElements::Implicit { model, .. } => {
                let problem = &model.problem;
                let (nodes, points) = (problem.nodes.len(), POINTS * problem.elements.len());
                let sizes = [nodes, points, problem.material.maxwell.len()];
                let mut bare = RubberCheckpoint::default();
                let own = sleeves + OF_IMPLICIT + 6 * nodes;
                let without = own + bare.length(sizes);
                bare.factored = Some(Factored::default());
                count == without || count == own + bare.length(sizes)
            }
        }
    }
}

impl BondedBushing<'_> {
    /// All numbers on which its further steps depend.
    pub fn numbers(&self) -> Vec<f64> {
        let mut all = vec![self.most.unwrap_or(0.0)];
        self.sleeves.iter().for_each(|now| all.extend(of_sleeve(now)));
        match &self.rubber {
            BondedRubber::Explicit(solid) => {
                let kept = solid.checkpoint();
                all.extend([kept.time, kept.steps as f64, kept.dissipated, kept.beyond]);
                for part in [&kept.displacement, &kept.rate] {
                    all.extend(part.iter().flat_map(|v| [v[0], v[1], v[2]]));
                }
                all.extend(kept.memory);
            }
            BondedRubber::Implicit(solid) => {
                let kept = solid.checkpoint();
                let RubberState { speed, acceleration, .. } = &kept.state;
                let RubberState { time, last, work, dissipated, beyond, .. } = &kept.state;
                let StepCounts { accepted, undone } = kept.counts;
                let counts = [accepted, undone, kept.iterations as u64, kept.factorisations as u64];
                let factored = kept.factored.as_ref();
                let [gain, inertia] = factored.map_or([-1.0; 2], |of| [of.gain, of.inertia]);
                all.extend([
                    *time,
                    *last,
                    *work,
                    *dissipated,
                    *beyond,
                    kept.next,
                    kept.scale,
                    gain,
                    inertia,
                ]);
                all.extend(counts.map(|count| count as f64));
                all.extend(speed.as_flattened());
                all.extend(acceleration.as_flattened());
                all.extend(kept.numbers());
            }
        }
        all
    }

    /// Continues in coupling steps of this length (s) from [`BondedBushing::numbers`] of the same bushing; `None` if
    /// they are of another one.
    #[must_use]
    pub fn restore(&mut self, coupling_step: f64, numbers: &[f64]) -> Option<()> {
        let mut rest = numbers;
        self.most = Some(rest.split_off(..1)?[0]).filter(|most| *most > 0.0);
        self.step_in(coupling_step);
        for now in &mut self.sleeves {
            let own = rest.split_off(..OF_SLEEVE)?;
            let mut threes = own.as_chunks::<3>().0.iter().copied();
            let mut next = || threes.next();
            for load in &mut now.loads {
                *load = Wrench { force: next()?, moment: next()? };
            }
            (now.from.velocity, now.from.spin) = (next()?, next()?);
            now.work = own[OF_SLEEVE - 1];
        }
        match &mut self.rubber {
            BondedRubber::Explicit(solid) => {
                let nodes = solid.displacement.len();
                let [time, steps, dissipated, beyond] = *rest.split_off(..OF_EXPLICIT)? else {
                    return None;
                };
                let mut next = || -> Option<Vec<Node>> {
                    let part = rest.split_off(..3 * nodes)?.as_chunks::<3>().0;
                    Some(part.iter().map(|v| [v[0], v[1], v[2], 0.0]).collect())
                };
                let (displacement, rate) = (next()?, next()?);
                let (memory, still) = (rest.to_vec(), vec![0.0; nodes]);
                solid.restore(&SolidCheckpoint {
                    time,
                    steps: steps as u64,
                    displacement,
                    rate,
                    external_work: still.clone(),
                    damping_work: still,
                    work: solid.work,
                    memory,
                    dissipated,
                    beyond,
                });
            }
            BondedRubber::Implicit(solid) => {
                let problem = &solid.model().problem;
                let (nodes, points) = (problem.nodes.len(), POINTS * problem.elements.len());
                let sizes = [nodes, points, problem.material.maxwell.len()];
                let [time, last, work, dissipated, beyond, ref after @ ..] =
                    *rest.split_off(..OF_IMPLICIT)?
                else {
                    return None;
                };
                let [next, scale, gain, inertia, ref counts @ ..] = *after else { return None };
                let [accepted, undone, iterations, factorisations] = *counts else { return None };
                let mut nodal = || -> Option<Vec<Vec3>> {
                    Some(rest.split_off(..3 * nodes)?.as_chunks::<3>().0.to_vec())
                };
                let (speed, acceleration) = (nodal()?, nodal()?);
                let factored = Factored { gain, inertia, ..Factored::default() };
                let bare = RubberCheckpoint {
                    state: RubberState {
                        time,
                        last,
                        work,
                        dissipated,
                        beyond,
                        speed,
                        acceleration,
                        ..RubberState::default()
                    },
                    next,
                    scale,
                    counts: StepCounts { accepted: accepted as u64, undone: undone as u64 },
                    iterations: iterations as usize,
                    factorisations: factorisations as usize,
                    factored: (gain >= 0.0).then_some(factored),
                };
                solid.restore(&bare.with_numbers(sizes, rest)?).ok()?;
            }
        }
        Some(())
    }
}

fn of_sleeve(now: &SleeveNow) -> impl Iterator<Item = f64> + '_ {
    let loads = now.loads.iter().flat_map(|load| load.force.into_iter().chain(load.moment));
    loads.chain(now.from.velocity).chain(now.from.spin).chain([now.work])
}
