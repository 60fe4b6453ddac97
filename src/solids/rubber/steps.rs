//! Steps of a solid of rubber in time, without inertia: each ends in equilibrium.
//!
//! The error of a step is that DEV S is not linear within it. Its second difference gives the error of the Maxwell
//! stresses, and with that the length of the next step. Steps end at the corners of loads and prescribed displacements;
//! behind a corner there is no second difference, so that a pair of steps is taken and judged together.

use crate::ch2_housing::elastomer::maxwell::{DashpotFactors, StepFactors};
use crate::elements::tet10::POINTS;
use crate::kinematics::strain::Sym3;
use crate::kinematics::vec3::Vec3;
use crate::plan::counts::Counts;
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::newton::Convergence;
use crate::solids::rubber::checkpoint::{RubberCheckpoint, RubberState};
use crate::solids::rubber::model::{Moment, RubberModel};
use crate::solids::rubber::newton::Search;
use crate::solids::rubber::path_following::PathLimits;
use crate::solids::rubber::tangent::StepLaw;
use serde::{Deserialize, Serialize};

/// Choice of the step size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// s; halved if no equilibrium is found otherwise.
    Fixed(f64),
    /// The estimated error of a step's Maxwell stresses stays below this fraction of the largest total stress so far,
    /// root mean square over the body.
    Accuracy(f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepOptions {
    pub stepping: Stepping,
    /// Smallest step, as a fraction of the time to the next corner.
    pub smallest: f64,
    /// Limits of steps that must follow the path of equilibria.
    pub way: Option<PathLimits>,
    pub convergence: Convergence,
}

impl Default for StepOptions {
    fn default() -> Self {
        // Forces of a step are accurate to 1e-3; rounding at B = 1e5 C_R is some 1e-9.
        let convergence = Convergence { tolerance: 1e-9, rounding: 1e-7, most_iterations: 20 };
        let stepping = Stepping::Accuracy(1e-4);
        StepOptions { stepping, smallest: 1e-9, way: None, convergence }
    }
}

/// Number of steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StepCounts {
    pub accepted: u64,
    /// Rejected for want of an equilibrium or for a large error.
    pub undone: u64,
}

/// A solid of rubber at the present time.
pub struct RubberSolid<'a> {
    pub(crate) search: Search<'a>,
    pub(crate) options: StepOptions,
    pub(crate) state: RubberState,
    pub(crate) factors: StepFactors,
    pub(crate) dashpots: DashpotFactors,
    pub(crate) carried: Vec<Sym3>,
    corners: Vec<f64>,
    /// Length of the next step, s; zero if unknown.
    next: f64,
    /// Largest total deviatoric stress so far, root mean square over the body, Pa.
    pub(crate) scale: f64,
    pub(crate) volume: f64,
    pub counts: StepCounts,
}

impl<'a> RubberSolid<'a> {
    /// At rest at t = 0.
    ///
    /// # Errors
    /// Steps or an accuracy that are not positive.
    pub fn new(
        model: &'a RubberModel,
        options: StepOptions,
    ) -> Result<RubberSolid<'a>, SolidError> {
        let (what, value) = match options.stepping {
            Stepping::Fixed(step) => ("step", step),
            Stepping::Accuracy(accuracy) => ("accuracy", accuracy),
        };
        if !(value > 0.0 && value.is_finite()) {
            return Err(SolidError::Option { what, value });
        }
        let state = RubberState::rest(model);
        Ok(RubberSolid {
            search: Search::new(model),
            options,
            state,
            factors: StepFactors::default(),
            dashpots: DashpotFactors::default(),
            carried: vec![[0.0; 6]; POINTS * model.tets.len()],
            corners: model.corners(),
            next: 0.0,
            scale: 0.0,
            volume: model.tets.iter().map(|tet| tet.volume()).sum(),
            counts: StepCounts::default(),
        })
    }

    /// s.
    pub fn time(&self) -> f64 {
        self.state.time
    }

    pub fn model(&self) -> &'a RubberModel {
        self.search.model
    }

    /// The present state.
    pub fn state(&self) -> &RubberState {
        &self.state
    }

    /// Checkpoint for the steps to come.
    pub fn checkpoint(&self) -> RubberCheckpoint {
        let (iterations, factorisations) = self.work();
        RubberCheckpoint {
            state: self.state.clone(),
            next: self.next,
            scale: self.scale,
            counts: self.counts,
            iterations,
            factorisations,
            factored: self.search.tangent.factored().cloned(),
        }
    }

    /// Continues from a checkpoint, with the same bits as the steps that followed it.
    ///
    /// # Errors
    ///
    /// No memory for the factors; a state of another body.
    ///
    /// # Panics
    ///
    /// If the checkpoint has another number of nodes or points.
    pub fn restore(&mut self, kept: &RubberCheckpoint) -> Result<(), SolidError> {
        self.state.clone_from(&kept.state);
        (self.next, self.scale, self.counts) = (kept.next, kept.scale, kept.counts);
        self.restore_forces();
        let outcome = self.search.tangent.restore(self.search.model, kept.factored.as_ref());
        self.search.iterations = kept.iterations;
        self.search.tangent.factorisations = kept.factorisations;
        outcome.map_err(|error| self.refused(error, 0.0))
    }

    /// Number of runs of each stage.
    pub fn ran(&self) -> &Counts {
        &self.search.ran
    }

    /// Resets the counts.
    pub fn forget_ran(&mut self) {
        self.search.ran = Counts::default();
    }

    /// Forces of the supports on all nodes, N.
    pub fn support_forces(&self) -> Vec<Vec3> {
        let all = self.search.internal.iter().zip(&self.search.loads);
        all.map(|(inner, outer)| std::array::from_fn(|i| 0.0 - (inner[i] + outer[i]))).collect()
    }

    /// Displacement of each node, m.
    pub fn displacement(&self) -> &[Vec3] {
        &self.state.displacement
    }

    /// Sum of the forces of the supports on some nodes, N.
    pub fn support_force(&self, nodes: &[u32]) -> Vec3 {
        self.search.support_force(nodes)
    }

    /// Iterations and factorisations so far.
    pub fn work(&self) -> (usize, usize) {
        (self.search.iterations, self.search.tangent.factorisations)
    }

    /// Advances to the time `until` (s), and calls back with every accepted state; for the pair of steps behind a
    /// corner with the second. At a jump there are two: before it and after it.
    ///
    /// # Errors
    ///
    /// [`SolidError::NoEquilibrium`] if no step however small ends in equilibrium; the state is then that of the last
    /// step that did. An end that is not finite.
    pub fn advance(
        &mut self,
        until: f64,
        mut watch: impl FnMut(&RubberSolid),
    ) -> Result<(), SolidError> {
        self.advance_while(until, |solid| {
            watch(solid);
            true
        })
    }

    /// As [`RubberSolid::advance`]; stops when the function that is called with each state returns `false`.
    ///
    /// # Errors
    ///
    /// The same; [`SolidError::Stopped`].
    pub fn advance_while(
        &mut self,
        until: f64,
        mut watch: impl FnMut(&RubberSolid) -> bool,
    ) -> Result<(), SolidError> {
        if !until.is_finite() {
            return Err(SolidError::Option { what: "end of the run", value: until });
        }
        if self.counts == StepCounts::default() {
            self.sudden_change(&mut watch)?;
        }
        while self.state.time < until {
            let corner = self.corners.iter().copied().find(|corner| *corner > self.state.time);
            let end = corner.map_or(until, |corner| corner.min(until));
            self.advance_smoothly(end, &mut watch)?;
            if corner == Some(end) {
                (self.state.last, self.next) = (0.0, 0.0);
                self.sudden_change(&mut watch)?;
            }
        }
        Ok(())
    }

    /// At a jump of a load or a prescribed displacement the body follows with its instantaneous stiffness, in no time:
    /// at once, or in parts if the search for the whole fails.
    fn sudden_change(
        &mut self,
        watch: &mut impl FnMut(&RubberSolid) -> bool,
    ) -> Result<(), SolidError> {
        let time = self.state.time;
        if !self.search.model.jumps(time) {
            return Ok(());
        }
        let (mut done, mut part) = (0.0, 1.0);
        let mut reached = self.state.displacement.clone();
        while done < 1.0 {
            let share = if done + part > 1.0 - 1e-9 { 1.0 } else { done + part };
            match self.sudden_part(Moment { time, share }, &reached) {
                Ok(()) => {
                    done = share;
                    part *= 2.0;
                    reached.copy_from_slice(&self.search.displacement);
                }
                Err(SolidError::Failed(failure)) => {
                    self.counts.undone += 1;
                    self.search.tangent.forget();
                    part *= 0.5;
                    let gone = part >= self.options.smallest;
                    if !gone {
                        self.restore_forces();
                        return Err(SolidError::NoEquilibrium { time, step: 0.0, failure });
                    }
                }
                Err(error) => return Err(error),
            }
        }
        self.accept(0.0, time);
        self.shown(watch)
    }

    /// Equilibrium at a fraction of a jump, from the one before. Nothing relaxes meanwhile, so that the path is
    /// irrelevant.
    fn sudden_part(&mut self, at: Moment, from: &[Vec3]) -> Result<(), SolidError> {
        self.set_history(0.0)?;
        let law = StepLaw { gain: self.factors.total_gain, carried: &self.carried, inertia: 0.0 };
        self.search.displacement.copy_from_slice(from);
        self.search.predict(at, &law)?;
        self.search.converge(at, &law, &self.options.convergence)
    }

    /// Advances to a time before which no slope changes.
    fn advance_smoothly(
        &mut self,
        end: f64,
        watch: &mut impl FnMut(&RubberSolid) -> bool,
    ) -> Result<(), SolidError> {
        let smallest = self.options.smallest * (end - self.state.time);
        let mut longest = f64::INFINITY;
        // Failure of a step, and the end of that step.
        let mut stopped: Option<(f64, StepFailure)> = None;
        while self.state.time < end {
            let rest = end - self.state.time;
            let wanted = match self.options.stepping {
                Stepping::Fixed(step) if self.next == 0.0 => step,
                // A fiftieth; halved if it is too long.
                Stepping::Accuracy(_) if self.next == 0.0 => rest / 50.0,
                _ => self.next,
            };
            let wanted = wanted.min(longest);
            // Two equal steps instead of a long and a very short one.
            let step = if wanted > rest * (1.0 - 1e-9) {
                rest
            } else if 2.0 * wanted > rest && self.judges() {
                0.5 * rest
            } else {
                wanted
            };
            let to = if step == rest { end } else { self.state.time + step };
            match self.attempt(step, to) {
                Ok(longer) => {
                    stopped = stopped.filter(|(at, _)| self.state.time < *at);
                    longest *= 1.2;
                    self.next = match self.options.stepping {
                        Stepping::Fixed(fixed) => fixed.min(2.0 * step),
                        Stepping::Accuracy(_) => longer * step,
                    };
                    self.shown(watch)?;
                }
                Err(SolidError::Failed(failure)) => {
                    self.counts.undone += 1;
                    self.search.tangent.forget();
                    self.next = 0.5 * step;
                    if let (StepFailure::Far { strain }, Some(way)) = (&failure, self.options.way) {
                        // Strains grow about in proportion to the step.
                        longest = step * (0.9 * way.strain / strain).max(0.25);
                        self.next = longest;
                    }
                    // The material's limit is more informative than iterations that fail just below it.
                    if !matches!(stopped, Some((_, StepFailure::Material { .. }))) {
                        stopped = Some((to, failure.clone()));
                    }
                    let gone = self.next >= smallest;
                    if !gone {
                        self.restore_forces();
                        let time = self.state.time;
                        let failure = stopped.map_or(failure, |(_, failure)| failure);
                        return Err(SolidError::NoEquilibrium { time, step, failure });
                    }
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn shown(&self, watch: &mut impl FnMut(&RubberSolid) -> bool) -> Result<(), SolidError> {
        if watch(self) { Ok(()) } else { Err(SolidError::Stopped { time: self.state.time }) }
    }

    pub(crate) fn judges(&self) -> bool {
        matches!(self.options.stepping, Stepping::Accuracy(_))
    }
}
