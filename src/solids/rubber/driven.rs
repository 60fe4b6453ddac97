//! Implicit steps of rubber with inertia whose bonded nodes move with bodies.
//!
//! Newmark's average acceleration: the mean of the accelerations at both ends acts over a step. It conserves energy in
//! an elastic solid and is stable in steps of any length; damping is that of the rubber.

use crate::kinematics::vec3::Vec3;
use crate::solids::error::SolidError;
use crate::solids::rubber::model::Moment;
use crate::solids::rubber::steps::RubberSolid;
use crate::solids::rubber::tangent::StepLaw;

impl RubberSolid<'_> {
    /// Relaxed and at rest with the nodes of bodies displaced (m).
    ///
    /// # Errors
    ///
    /// [`SolidError::NoEquilibrium`].
    pub fn rest_with(
        &mut self,
        driven: impl IntoIterator<Item = (u32, Vec3)>,
    ) -> Result<(), SolidError> {
        self.drive(driven);
        let at = Moment::at(self.state.time);
        self.search.displacement.copy_from_slice(&self.state.displacement);
        let search = &mut self.search;
        let found = search
            .predict(at, &StepLaw::RELAXED)
            .and_then(|()| search.converge(at, &StepLaw::RELAXED, &self.options.convergence));
        found.map_err(|stop| self.refused(stop, 0.0))?;
        self.state.displacement.copy_from_slice(&self.search.displacement);
        self.state.deviatoric.copy_from_slice(&self.search.deviatoric);
        self.state.forces.copy_from_slice(&self.search.internal);
        Ok(())
    }

    /// One step of `step` s to displacements (m) of the nodes of bodies.
    ///
    /// # Errors
    ///
    /// [`SolidError::NoEquilibrium`]; the state is then that before the step.
    pub fn driven_step(
        &mut self,
        step: f64,
        driven: impl IntoIterator<Item = (u32, Vec3)>,
    ) -> Result<(), SolidError> {
        self.drive(driven);
        let end = self.state.time + step;
        if let Err(stop) = self.equilibrium(step, end) {
            self.restore_forces();
            return Err(self.refused(stop, step));
        }
        self.accept(step, end);
        Ok(())
    }

    fn drive(&mut self, driven: impl IntoIterator<Item = (u32, Vec3)>) {
        self.search.driven.clear();
        self.search.driven.extend(driven);
    }

    pub(crate) fn refused(&self, error: SolidError, step: f64) -> SolidError {
        match error {
            SolidError::Failed(failure) => {
                SolidError::NoEquilibrium { time: self.state.time, step, failure }
            }
            error => error,
        }
    }

    /// Positions after a step of `step` s without the acceleration at its end, and the acceleration per displacement
    /// from there, 1/s²; zero without inertia.
    pub(crate) fn newmark_predictor(&mut self, step: f64) -> f64 {
        if self.search.model.mass.is_empty() || step == 0.0 {
            return 0.0;
        }
        let state = &self.state;
        let before = state.displacement.iter().zip(&state.speed).zip(&state.acceleration);
        for (to, ((u, v), a)) in self.search.newmark_predictor.iter_mut().zip(before) {
            *to = std::array::from_fn(|i| u[i] + step * (v[i] + 0.25 * step * a[i]));
        }
        4.0 / (step * step)
    }

    /// Velocities and accelerations at the end of a converged step of `step` s.
    pub(crate) fn accelerate(&mut self, step: f64) {
        if self.search.model.mass.is_empty() || step == 0.0 {
            return;
        }
        let per = 4.0 / (step * step);
        let ends = self.search.displacement.iter().zip(&self.search.newmark_predictor);
        let rates = self.state.speed.iter_mut().zip(&mut self.state.acceleration);
        for ((v, a), (u, free)) in rates.zip(ends) {
            for i in 0..3 {
                let after = per * (u[i] - free[i]);
                v[i] += 0.5 * step * (a[i] + after);
                a[i] = after;
            }
        }
    }

    /// Kinetic energy of the nodes with inertia, J.
    pub fn kinetic_energy(&self) -> f64 {
        let squares = self.state.speed.iter().map(|v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        0.5 * self.search.model.mass.iter().zip(squares).map(|(m, square)| m * square).sum::<f64>()
    }
}
