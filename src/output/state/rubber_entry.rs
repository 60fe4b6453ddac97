//! Rubber solid in `state.json`.

use super::arrays::{arrays_name, table};
use super::entries::Refused;
use crate::elements::tet10::POINTS;
use crate::kinematics::vec3::Vec3;
use crate::motion::bonded_bushing::{BondedElements, BondedPart};
use crate::output::session::RubberParts;
use crate::solids::rubber::checkpoint::{Factored, RubberCheckpoint, RubberState};
use crate::solids::rubber::steps::StepCounts;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::Path;

/// See [`RubberCheckpoint`]. The array file has all its long parts in one column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RubberEntry {
    pub arrays: String,
    /// Last step and proposed next step, s.
    pub last: f64,
    pub next: f64,
    /// Largest total deviatoric stress so far, Pa.
    pub scale: f64,
    /// Work done on the solid and energy dissipated so far, J.
    pub work: f64,
    pub dissipated: f64,
    /// Work of the Maxwell stresses beyond the law of small strain, J.
    #[serde(default)]
    pub beyond: f64,
    /// Number of accepted and rejected steps, iterations and factorisations.
    pub counts: [u64; 4],
    /// Gain of the step for which the stored factors were computed.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub factored: Option<f64>,
}

impl RubberEntry {
    pub(super) fn of(kept: &RubberCheckpoint, number: u64) -> RubberEntry {
        let StepCounts { accepted, undone } = kept.counts;
        RubberEntry {
            arrays: arrays_name(number),
            last: kept.state.last,
            next: kept.next,
            scale: kept.scale,
            work: kept.state.work,
            dissipated: kept.state.dissipated,
            beyond: kept.state.beyond,
            counts: [accepted, undone, kept.iterations as u64, kept.factorisations as u64],
            factored: kept.factored.as_ref().map(|factored| factored.gain),
        }
    }

    pub(super) fn numbers(&self) -> Vec<f64> {
        let gain = self.factored.into_iter();
        [self.last, self.next, self.scale, self.work, self.dissipated, self.beyond]
            .into_iter()
            .chain(gain)
            .collect()
    }

    /// Checkpoint at `time` (s), with the arrays from `folder`.
    pub(super) fn checkpoint(
        &self,
        folder: &Path,
        time: f64,
        parts: &RubberParts,
    ) -> Result<RubberCheckpoint, Refused> {
        let problem = &parts.setup.model.problem;
        let (nodes, points) = (problem.nodes.len(), POINTS * problem.elements.len());
        let terms = problem.material.maxwell.len();
        let [accepted, undone, iterations, factorisations] = self.counts;
        let bare = RubberCheckpoint {
            state: RubberState {
                time,
                last: self.last,
                work: self.work,
                dissipated: self.dissipated,
                beyond: self.beyond,
                ..RubberState::default()
            },
            next: self.next,
            scale: self.scale,
            counts: StepCounts { accepted, undone },
            iterations: iterations as usize,
            factorisations: factorisations as usize,
            factored: self.factored.map(|gain| Factored { gain, ..Factored::default() }),
        };
        let sizes = [nodes, points, terms];
        let column = table(folder, &self.arrays, (bare.length(sizes), 1))?;
        let all: Vec<f64> = column.data().iter().copied().collect();
        let damaged = Refused::Damaged("its arrays have another shape than the mesh asks for");
        bare.with_numbers(sizes, &all).ok_or(damaged)
    }
}

/// Hashes node positions and element connectivity.
fn hash_mesh<const N: usize>(hash: &mut Sha256, nodes: &[Vec3], elements: &[[u32; N]]) {
    for value in nodes.iter().flatten() {
        hash.update(value.to_bits().to_le_bytes());
    }
    for node in elements.as_flattened() {
        hash.update(node.to_le_bytes());
    }
}

/// Hashes everything that determines the bits of a bushing in elements.
pub(super) fn hash_bushing(hash: &mut Sha256, part: &BondedPart) {
    match &part.elements {
        BondedElements::Explicit { body, fraction } => {
            hash_mesh(hash, &body.nodes, &body.elements);
            hash.update(format!("{:?} {} {fraction}", body.material, body.density));
        }
        BondedElements::Implicit { model, step } => {
            hash_mesh(hash, &model.problem.nodes, &model.problem.elements);
            let mass: f64 = model.mass.iter().sum();
            hash.update(format!("{:?} {mass} {step:?}", model.problem.material));
        }
    }
    hash.update(format!("{} {:?} {:?}", part.name, part.sleeves, part.spring));
}

/// Hashes everything that determines the bits of a rubber solid.
pub(super) fn hash_rubber(hash: &mut Sha256, parts: &RubberParts) {
    let problem = &parts.setup.model.problem;
    hash_mesh(hash, &problem.nodes, &problem.elements);
    hash.update(format!("{:?} {:?}", problem.material, problem.prescribed));
    hash.update(format!("{:?} {:?}", problem.loads, parts.stepping));
    hash.update(format!("{:?} {:?}", parts.setup.probes, parts.setup.supports));
}
