//! Forces of many four-node elements of rubber in explicit steps, one element a lane.
//!
//! The laws are those of one element ([`FiveTerms`], [`tet4_nodal`]), for all lanes of a block at once. History
//! stresses of a block are stored together in the order of reading: DEV S of the last step, then Hⱼ of every Maxwell
//! element. They are most of the memory traffic of a step.

use crate::ch2_housing::elastomer::Elastomer;
use crate::ch2_housing::elastomer::five_terms::FiveTerms;
use crate::ch2_housing::elastomer::maxwell::{
    DashpotFactors, StepFactors, beyond_small_strain, commit, spring_energy, summed,
};
use crate::elements::tet4::{Tet4, relative};
use crate::elements::tet4_nodal;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{Sym3, green_lagrange, volume_change};
use crate::kinematics::vec3::Vec3;
use crate::solids::error::SolidError;
use crate::solids::model::{SolidModel, centre};
use crate::solids::tet4_blocks::{Block, LANES, Lanes, Node, blocks};
use std::cell::Cell;

/// Source of an element's mean stress.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeanStress {
    /// Its own volume, as in the source: locks for nearly incompressible rubber.
    OfElement,
    /// Volumes averaged around its nodes.
    #[default]
    AroundNodes,
}

/// Treatment of the Maxwell stresses in an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum History {
    /// Advances them to the present state and stores them: once in an accepted step.
    Commit,
    /// Advances them without storing.
    Trial,
    /// Omits them; the deviatoric stress is that of the network times a factor.
    Scaled(f64),
}

/// Elements in the blocks of the force loop, and their history.
#[derive(Clone, Debug)]
pub struct RubberForces {
    pub material: Elastomer,
    pub mean_stress: MeanStress,
    chain: Option<FiveTerms>,
    blocks: Vec<Block>,
    /// s.
    step: f64,
    factors: StepFactors,
    /// Counts the dissipation of the dashpots, at some cost in speed.
    dashpots: Option<DashpotFactors>,
    /// Dissipation since then, by the law of small strain, and work of the elements' stresses beyond it, J.
    pub dissipated: f64,
    pub beyond: f64,
    /// DEV S, then Hⱼ, of each block, Pa.
    memory: Vec<[Lanes; 6]>,
    /// Strain of each block at that time; empty if dissipation is not counted.
    strains: Vec<[Lanes; 6]>,
    /// Undeformed volume around each node, a quarter of each element there, m³.
    volumes: Vec<f64>,
    /// Mean stress at each node, Pa.
    means: Vec<f64>,
    /// Smallest J − 1 of the last evaluation.
    lowest: f64,
}

impl RubberForces {
    /// At rest, relaxed; elements must be valid.
    pub fn new(
        material: Elastomer,
        mean_stress: MeanStress,
        nodes: usize,
        elements: impl ExactSizeIterator<Item = (Tet4, [u32; 4])>,
    ) -> RubberForces {
        let blocks: Vec<Block> = blocks(elements);
        let mut volumes = vec![0.0; nodes];
        for block in &blocks {
            for (lane, nodes) in block.nodes.iter().enumerate() {
                let share = 0.25 * block.element_of(lane).volume;
                nodes.iter().for_each(|node| volumes[*node as usize] += share);
            }
        }
        let zero = [Lanes::of(0.0); 6];
        RubberForces {
            memory: vec![zero; blocks.len() * (material.maxwell.len() + 1)],
            chain: FiveTerms::of(&material.network),
            factors: StepFactors::sudden(&material.maxwell),
            dashpots: None,
            dissipated: 0.0,
            beyond: 0.0,
            strains: Vec::new(),
            means: vec![0.0; nodes],
            step: 0.0,
            lowest: 0.0,
            volumes,
            blocks,
            mean_stress,
            material,
        }
    }

    /// Sets the step to `dt` s.
    pub fn set_step(&mut self, dt: f64) {
        if dt != self.step {
            self.step = dt;
            self.factors.fill(&self.material.maxwell, dt);
            if let Some(dashpots) = &mut self.dashpots {
                dashpots.set(&self.material.maxwell, dt);
            }
        }
    }

    /// Counts the dissipation of the dashpots from the next rest on.
    pub fn count_dissipation(&mut self) {
        let mut dashpots = DashpotFactors::default();
        dashpots.set(&self.material.maxwell, self.step);
        self.dashpots = Some(dashpots);
        self.strains = vec![[Lanes::of(0.0); 6]; self.blocks.len()];
    }

    /// Energy in the springs of the Maxwell elements, dissipation of their dashpots since counting began, both by the
    /// law of small strain, and work of the elements' stresses beyond it, J: for a state one step ahead of the history,
    /// as after an explicit step.
    pub fn maxwell_ledger(&self, displacement: &[Node]) -> [f64; 3] {
        let material = &self.material;
        let (terms, shear_modulus) = (material.maxwell.len(), material.network.shear_modulus());
        let mut dashpots = DashpotFactors::default();
        dashpots.set(&material.maxwell, self.step);
        let (mut springs, mut taken, mut beyond) = (0.0, self.dissipated, self.beyond);
        let mut history = vec![[0.0; 6]; terms];
        let remembered = self.memory.chunks_exact(terms + 1).zip(&self.strains);
        for (block, (memory, strained)) in self.blocks.iter().zip(remembered) {
            for (lane, nodes) in block.nodes.iter().enumerate() {
                let tet = block.element_of(lane);
                let strain =
                    green_lagrange(&tet.displacement_gradient(&apart(nodes, displacement)));
                let own = material.network.isochoric_stress(&strain).unwrap_or([f64::NAN; 6]);
                let of_lane = |part: &Sym3<Lanes>| part.map(|lanes| lanes.as_array()[lane]);
                let [before, strained] = [&memory[0], strained].map(of_lane);
                let change: Sym3 = std::array::from_fn(|i| own[i] - before[i]);
                let strain = std::array::from_fn(|i| strain[i] - strained[i]);
                for (to, from) in history.iter_mut().zip(&memory[1..]) {
                    *to = of_lane(from);
                }
                taken += tet.volume * dashpots.energy(&history, &change, shear_modulus);
                let held = summed(&history);
                commit(&mut history, &change, &self.factors);
                let sums = [&held, &summed(&history)];
                beyond += tet.volume * beyond_small_strain(sums, &strain, &change, shear_modulus);
                springs += tet.volume * spring_energy(&material.maxwell, &history, shear_modulus);
            }
        }
        [springs, taken, beyond]
    }

    /// Approximate side of the smallest element, m.
    pub fn shortest(&self) -> f64 {
        let volumes = self.elements().map(|(_, tet)| tet.volume);
        libm::cbrt(volumes.fold(f64::INFINITY, f64::min))
    }

    /// Every element with its nodes.
    fn elements(&self) -> impl Iterator<Item = (&[u32; 4], Tet4)> {
        let lanes = |block: &Block, lane: usize| block.element_of(lane);
        let all = self.blocks.iter().flat_map(move |block| {
            block.nodes.iter().enumerate().map(move |(lane, nodes)| (nodes, lanes(block, lane)))
        });
        // Padding has no volume.
        all.filter(|(_, tet)| tet.volume > 0.0)
    }

    /// Energy of the network, J, without that of the Maxwell elements.
    pub fn network_energy(&self, displacement: &[Node]) -> f64 {
        let network = &self.material.network;
        let (mut energy, mut around) = (0.0, vec![0.0; self.volumes.len()]);
        for (nodes, tet) in self.elements() {
            let h = tet.displacement_gradient(&apart(nodes, displacement));
            let chains = network.isochoric_energy(&green_lagrange(&h)).unwrap_or(f64::NAN);
            energy += tet.volume * chains;
            match self.mean_stress {
                MeanStress::OfElement => {
                    energy += tet.volume * network.volume_energy(volume_change(&h));
                }
                MeanStress::AroundNodes => {
                    let share = tet4_nodal::volume_change_at_nodes(&tet, &h);
                    nodes.iter().for_each(|node| around[*node as usize] += share);
                }
            }
        }
        let pairs = around.iter().zip(&self.volumes);
        energy + pairs.map(|(v, of)| of * network.volume_energy(v / of)).sum::<f64>()
    }

    /// Error of an invalid state.
    pub fn failure(
        &self,
        model: &SolidModel,
        displacement: &[Node],
        time: f64,
        step: u64,
    ) -> SolidError {
        for (index, (nodes, tet)) in self.elements().enumerate() {
            let h = tet.displacement_gradient(&apart(nodes, displacement));
            let ratio = 1.0 + volume_change(&h);
            if ratio <= 0.0 {
                return model.inverted(index, ratio, time, step);
            }
            if let Err(source) = self.material.network.isochoric_stress(&green_lagrange(&h)) {
                let at = centre(&model.problem, index);
                let element = model.labels.element(index);
                return SolidError::Material { element, at, source, time, step };
            }
        }
        let bad = |u: &Node| !(u[0] + u[1] + u[2]).is_finite();
        model.not_finite(displacement.iter().position(bad).unwrap_or(0), time, step)
    }

    /// Takes the present state as relaxed: no stress in the Maxwell elements.
    pub fn relax(&mut self, displacement: &[Node]) {
        let zero = [Lanes::of(0.0); 6];
        self.memory.fill(zero);
        let network = &self.material.network;
        let terms = self.material.maxwell.len() + 1;
        let all = self.blocks.iter().zip(self.memory.chunks_exact_mut(terms)).enumerate();
        for (index, (block, memory)) in all {
            for (lane, nodes) in block.nodes.iter().enumerate() {
                let h = block.element_of(lane).displacement_gradient(&apart(nodes, displacement));
                let e = green_lagrange(&h);
                if let Some(strained) = self.strains.get_mut(index) {
                    strained.iter_mut().zip(e).for_each(|(to, e)| to.as_mut_array()[lane] = e);
                }
                let s = match self.chain {
                    Some(chain) => chain.isochoric_stress(&e),
                    None => network.isochoric_stress(&e).unwrap_or([f64::NAN; 6]),
                };
                for (to, s) in memory[0].iter_mut().zip(s) {
                    to.as_mut_array()[lane] = s;
                }
            }
        }
    }

    /// Adds the forces of all elements on the nodes, N, in the order of the elements.
    pub fn add_forces(&mut self, displacement: &[Node], forces: &mut [Node], history: History) {
        self.lowest = f64::INFINITY;
        if self.mean_stress == MeanStress::AroundNodes {
            self.average(displacement);
        }
        match self.chain {
            Some(chain) => {
                self.pass(displacement, forces, history, |e| chain.isochoric_stress(e));
            }
            None => {
                let (network, beyond) = (self.material.network, Cell::new(false));
                let law = |e: &Sym3| {
                    network.isochoric_stress(e).unwrap_or_else(|_| {
                        beyond.set(true);
                        [f64::NAN; 6]
                    })
                };
                self.pass(displacement, forces, history, |e| {
                    let mut lanes = *e;
                    for lane in 0..LANES {
                        let one = law(&e.map(|e| e.as_array()[lane]));
                        for (to, s) in lanes.iter_mut().zip(one) {
                            to.as_mut_array()[lane] = s;
                        }
                    }
                    lanes
                });
                if beyond.get() {
                    self.lowest = f64::NEG_INFINITY;
                }
            }
        }
    }

    /// Mean stresses at the nodes.
    #[inline(never)]
    fn average(&mut self, displacement: &[Node]) {
        self.means.fill(0.0);
        let mut lowest = Lanes::of(f64::INFINITY);
        let displacement = &displacement[..self.means.len()];
        for block in &self.blocks {
            let h = block.element.displacement_gradient(&block.relative(displacement));
            lowest = lowest.min(volume_change(&h));
            let shares = tet4_nodal::volume_change_at_nodes(&block.element, &h).to_array();
            for (nodes, share) in block.nodes.iter().zip(shares) {
                nodes.iter().for_each(|node| self.means[*node as usize] += share);
            }
        }
        for (mean, volume) in self.means.iter_mut().zip(&self.volumes) {
            *mean = self.material.network.mean_stress(*mean / volume);
        }
        self.lowest = lowest.to_array().into_iter().fold(self.lowest, f64::min);
    }

    #[inline(never)]
    fn pass(
        &mut self,
        displacement: &[Node],
        forces: &mut [Node],
        history: History,
        law: impl Fn(&Sym3<Lanes>) -> Sym3<Lanes>,
    ) {
        let terms = self.material.maxwell.len() + 1;
        let network = self.material.network;
        let around = self.mean_stress == MeanStress::AroundNodes;
        let mut lowest = Lanes::of(f64::INFINITY);
        let [mut taken, mut beyond] = [Lanes::of(0.0); 2];
        let mut strains = self.strains.iter_mut();
        let shear_modulus = network.shear_modulus();
        // One bound for all, so that it is checked once.
        let displacement = &displacement[..forces.len()];
        let means = &self.means[..forces.len()];
        for (block, memory) in self.blocks.iter().zip(self.memory.chunks_exact_mut(terms)) {
            let h = block.element.displacement_gradient(&block.relative(displacement));
            let strain = green_lagrange(&h);
            let own = law(&strain);
            let total = match history {
                History::Commit => match (&self.dashpots, strains.next()) {
                    (Some(dashpots), Some(strained)) => {
                        let change = std::array::from_fn(|i| own[i] - memory[0][i]);
                        let density = dashpots.energy(&memory[1..], &change, shear_modulus);
                        taken += block.element.volume * density;
                        let by = std::array::from_fn(|i| strain[i] - strained[i]);
                        *strained = strain;
                        let before = summed(&memory[1..]);
                        let sum = remember(memory, own, &self.factors);
                        let after = std::array::from_fn(|i| sum[i] - own[i]);
                        let sums = [&before, &after];
                        let density = beyond_small_strain(sums, &by, &change, shear_modulus);
                        beyond += block.element.volume * density;
                        sum
                    }
                    _ => remember(memory, own, &self.factors),
                },
                History::Trial => foresee(memory, own, &self.factors),
                History::Scaled(factor) => scaled(own, factor),
            };
            let mean = if around {
                let mut mean = [0.0; LANES];
                for (mean, nodes) in mean.iter_mut().zip(&block.nodes) {
                    let [a, b, c, d] = nodes.map(|node| means[node as usize]);
                    *mean = 0.25 * ((a + b) + (c + d));
                }
                Lanes::new(mean)
            } else {
                let change = volume_change(&h);
                lowest = lowest.min(change);
                network.mean_stress(change)
            };
            let force = tet4_nodal::nodal_forces(&block.element, &h, &total, mean);
            block.add(force, forces);
        }
        self.lowest = lowest.to_array().into_iter().fold(self.lowest, f64::min);
        self.dissipated += taken.to_array().iter().sum::<f64>();
        self.beyond += beyond.to_array().iter().sum::<f64>();
    }

    /// Returns whether at the last evaluation no element was inverted or beyond the material's limit.
    pub fn is_sound(&self) -> bool {
        self.lowest > -1.0
    }

    /// DEV S and Hⱼ of every element, one after the other (Pa), and strains if they are counted: the history of a
    /// checkpoint.
    pub fn memory(&self) -> Vec<f64> {
        self.memory
            .iter()
            .chain(&self.strains)
            .flatten()
            .flat_map(|lanes| lanes.to_array())
            .collect()
    }

    /// Restores [`RubberForces::memory`].
    ///
    /// # Panics
    ///
    /// If it has another length.
    pub fn remember(&mut self, values: &[f64]) {
        let count = self.memory.len() + self.strains.len();
        assert_eq!(values.len(), 6 * LANES * count, "of another body");
        let all = self.memory.iter_mut().chain(&mut self.strains);
        for (to, from) in all.flatten().zip(values.chunks_exact(LANES)) {
            to.as_mut_array().copy_from_slice(from);
        }
    }
}

/// Displacements of an element's first three nodes relative to the fourth.
fn apart(nodes: &[u32; 4], displacement: &[Node]) -> [Vec3; 3] {
    relative(&nodes.map(|node| {
        let u = displacement[node as usize];
        [u[0], u[1], u[2]]
    }))
}

#[inline(always)]
fn scaled(mut stress: Sym3<Lanes>, factor: f64) -> Sym3<Lanes> {
    for s in &mut stress {
        *s *= Lanes::of(factor);
    }
    stress
}

/// (2.13) and (2.14): advances Hⱼ in place, and returns the total deviatoric stress.
#[inline(always)]
fn remember(memory: &mut [[Lanes; 6]], own: Sym3<Lanes>, factors: &StepFactors) -> Sym3<Lanes> {
    let Some((before, terms)) = memory.split_first_mut() else { return own };
    let mut change = own;
    for i in 0..6 {
        change[i] = own[i] - before[i];
    }
    *before = own;
    let mut total = own;
    for ((h, decay), gain) in terms.iter_mut().zip(&factors.decay).zip(&factors.gain) {
        let (decay, gain) = (Lanes::of(*decay), Lanes::of(*gain));
        for i in 0..6 {
            h[i] = decay * h[i] + gain * change[i];
            total[i] += h[i];
        }
    }
    total
}

/// As [`remember`], without changing the memory.
fn foresee(memory: &[[Lanes; 6]], own: Sym3<Lanes>, factors: &StepFactors) -> Sym3<Lanes> {
    let Some((before, terms)) = memory.split_first() else { return own };
    let mut total = own;
    for ((h, decay), gain) in terms.iter().zip(&factors.decay).zip(&factors.gain) {
        let (decay, gain) = (Lanes::of(*decay), Lanes::of(*gain));
        for i in 0..6 {
            total[i] += decay * h[i] + gain * (own[i] - before[i]);
        }
    }
    total
}
