//! One step of a solid of rubber: its equilibrium, its error, and its commit.

use crate::ch2_housing::elastomer::maxwell::{
    beyond_small_strain, commit, curvature_error, relaxed_history, summed,
};
use crate::elements::tet10::POINTS;
use crate::kinematics::strain::{Sym3, double_dot, green_lagrange};
use crate::kinematics::vec3::dot;
use crate::plan::Stage;
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::model::corners;
use crate::solids::rubber::model::Moment;
use crate::solids::rubber::steps::{RubberSolid, Stepping};
use crate::solids::rubber::tangent::StepLaw;

impl RubberSolid<'_> {
    /// Takes one step that can be judged, or a pair behind a corner. Returns the factor for the length of the next;
    /// leaves the state unchanged if it fails.
    pub(crate) fn attempt(&mut self, step: f64, end: f64) -> Result<f64, SolidError> {
        let viscous = !self.search.model.problem.material.maxwell.is_empty();
        if !(self.judges() && viscous) {
            self.equilibrium(step, end)?;
            if let Some(way) = self.options.way {
                self.check_path(way, step)?;
            }
            self.accept(step, end);
            return Ok(3.0);
        }
        if self.state.last > 0.0 {
            self.equilibrium(step, end)?;
            let longer = self.judged(step)?;
            self.accept(step, end);
            return Ok(longer);
        }
        let anchor = (self.state.clone(), self.scale);
        let half = 0.5 * step;
        let pair = self.pair(half, end);
        if pair.is_err() {
            (self.state, self.scale) = anchor;
        }
        // Relative to a half; the next one is a whole.
        pair.map(|longer| (0.5 * longer).max(0.5))
    }

    fn pair(&mut self, half: f64, end: f64) -> Result<f64, SolidError> {
        let middle = self.state.time + half;
        self.equilibrium(half, middle)?;
        self.accept(half, middle);
        let second = self.equilibrium(half, end).and_then(|()| self.judged(half));
        match second {
            Ok(longer) => {
                self.accept(half, end);
                Ok(longer)
            }
            Err(stop) => {
                self.counts.accepted -= 1;
                Err(stop)
            }
        }
    }

    /// Finds the equilibrium at the end of a step without any other change. A step that ends at a jump ends before it.
    pub(crate) fn equilibrium(&mut self, step: f64, end: f64) -> Result<(), SolidError> {
        let end = if step > 0.0 { end.next_down() } else { end };
        self.set_history(step)?;
        let at = Moment::at(end);
        let inertia = self.newmark_predictor(step);
        let law = StepLaw { gain: self.factors.total_gain, carried: &self.carried, inertia };
        let state = &self.state;
        if state.last > 0.0 {
            self.search.displacement.copy_from_slice(&state.displacement);
            for (u, v) in self.search.displacement.iter_mut().zip(&state.velocity) {
                *u = std::array::from_fn(|i| u[i] + step * v[i]);
            }
            match self.search.converge(at, &law, &self.options.convergence) {
                // Nearly incompressible rubber follows its tangent where it does not follow a straight line.
                Err(SolidError::Failed(_)) => self.search.tangent.forget(),
                outcome => return outcome,
            }
        }
        self.search.displacement.copy_from_slice(&state.displacement);
        self.search.predict(at, &law)?;
        self.search.converge(at, &law, &self.options.convergence)
    }

    /// Sets the part of the stress that depends on the state before a step of `step` s.
    pub(crate) fn set_history(&mut self, step: f64) -> Result<(), SolidError> {
        let maxwell = &self.search.model.problem.material.maxwell;
        self.factors.set(maxwell, step)?;
        if !maxwell.is_empty() {
            let terms = self.state.history.chunks_exact(maxwell.len());
            for ((to, history), before) in
                self.carried.iter_mut().zip(terms).zip(&self.state.deviatoric)
            {
                *to = relaxed_history(history, before, &self.factors);
            }
        }
        Ok(())
    }

    /// Factor for the length of the next step, from the estimated error of the step just solved.
    fn judged(&mut self, step: f64) -> Result<f64, SolidError> {
        let Stepping::Accuracy(accuracy) = self.options.stepping else { return Ok(3.0) };
        let model = self.search.model;
        let maxwell = &model.problem.material.maxwell;
        let (mut bend, mut largest) = (0.0, 0.0);
        for (index, tet) in model.tets.iter().enumerate() {
            for (point, of) in tet.points.iter().enumerate() {
                let at = POINTS * index + point;
                let (new, old) = (&self.search.deviatoric[at], &self.state.deviatoric[at]);
                let rate = &self.state.rate[at];
                let second: Sym3 = std::array::from_fn(|i| {
                    ((new[i] - old[i]) / step - rate[i]) / (0.5 * (step + self.state.last))
                });
                let total: Sym3 = std::array::from_fn(|i| {
                    (1.0 + self.factors.total_gain) * new[i] + self.carried[at][i]
                });
                bend += of.volume * double_dot(&second, &second);
                largest += of.volume * double_dot(&total, &total);
            }
        }
        let scale = self.scale.max((largest / self.volume).sqrt());
        let error = curvature_error(maxwell, step) * (bend / self.volume).sqrt();
        let allowed = accuracy * scale;
        let within = error <= allowed;
        if !within {
            return Err(StepFailure::Inaccurate.into());
        }
        self.scale = scale;
        // Nine tenths of the length allowed by a second-order error, at most threefold.
        let little = error <= 0.09 * allowed;
        Ok(if little { 3.0 } else { 0.9 * (allowed / error).sqrt() })
    }

    /// Takes the solution of [`RubberSolid::equilibrium`] as the state.
    pub(crate) fn accept(&mut self, step: f64, end: f64) {
        let model = self.search.model;
        let material = &model.problem.material;
        let (terms, shear_modulus) = (material.maxwell.len(), material.network.shear_modulus());
        self.dashpots.set(&material.maxwell, step);
        let state = &mut self.state;
        // Behind a sudden change the rates to come are unknown.
        let per = if step > 0.0 { 1.0 / step } else { 0.0 };
        for (at, (new, old)) in self.search.deviatoric.iter().zip(&mut state.deviatoric).enumerate()
        {
            let change: Sym3 = std::array::from_fn(|i| new[i] - old[i]);
            let history = &mut state.history[terms * at..terms * (at + 1)];
            let (index, nodes) = (at / POINTS, &model.problem.elements[at / POINTS]);
            let point = &model.tets[index].points[at % POINTS];
            let [from, to] = [&state.displacement, &self.search.displacement].map(|displaced| {
                green_lagrange(&point.displacement_gradient(&corners(displaced, nodes)))
            });
            let strain = std::array::from_fn(|i| to[i] - from[i]);
            let volume = point.volume;
            state.dissipated += volume * self.dashpots.energy(history, &change, shear_modulus);
            let before = summed(history);
            commit(history, &change, &self.factors);
            let sums = [&before, &summed(history)];
            state.beyond += volume * beyond_small_strain(sums, &strain, &change, shear_modulus);
            state.rate[at] = change.map(|c| per * c);
            *old = *new;
        }
        // Work of loads and supports, which balance the forces of the elements.
        let moves = state.displacement.iter().zip(&self.search.displacement);
        let forces = state.forces.iter_mut().zip(&self.search.internal);
        for ((before, after), (old, new)) in moves.zip(forces) {
            let way = std::array::from_fn(|i| after[i] - before[i]);
            state.work -= 0.5 * (dot(*old, way) + dot(*new, way));
            *old = *new;
        }
        for ((u, v), new) in
            state.displacement.iter_mut().zip(&mut state.velocity).zip(&self.search.displacement)
        {
            *v = std::array::from_fn(|i| per * (new[i] - u[i]));
            *u = *new;
        }
        self.search.ran.add(Stage::Implicit, 1);
        self.search.ran.add(Stage::Maxwell, terms as u64);
        state.last = step;
        state.time = end;
        self.accelerate(step);
        self.counts.accepted += 1;
    }

    /// Restores the forces of the present state after a failed search.
    pub(crate) fn restore_forces(&mut self) {
        self.search.displacement.copy_from_slice(&self.state.displacement);
        // A zero step is never refused.
        let _ = self.set_history(0.0);
        let law = StepLaw { gain: self.factors.total_gain, carried: &self.carried, inertia: 0.0 };
        self.search.return_to(Moment::at(self.state.time), &law);
    }
}
