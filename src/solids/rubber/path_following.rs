//! Checks that a step of rubber follows the path of equilibria from the one before it, for statics that start from
//! rest.

use crate::kinematics::strain::{Sym3, double_dot, green_lagrange};
use crate::kinematics::vec3::{Vec3, dot};
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::model::corners;
use crate::solids::rubber::measures::network_energy;
use crate::solids::rubber::steps::RubberSolid;
use crate::solids::rubber::tangent::StepLaw;

/// Limits of a step along the path of equilibria.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathLimits {
    /// Largest change of Green's strain in a step, root mean square over the body.
    pub strain: f64,
    /// Step below which changes of strain are not limited, s.
    pub short: f64,
    /// Largest fraction of the work of a step that may be missing in the energy after it: a jump loses some however
    /// short the step is.
    pub lost: f64,
}

impl RubberSolid<'_> {
    /// Checks that the solution of [`RubberSolid::equilibrium`] is close, without a jump, and stable.
    pub(crate) fn check_path(&mut self, way: PathLimits, step: f64) -> Result<(), SolidError> {
        let strain = self.strain_of_step();
        let near = strain <= way.strain || step <= way.short;
        if !near {
            return Err(StepFailure::Far { strain }.into());
        }
        let work = self.work_of_step();
        let [before, after] = [&self.state.displacement, &self.search.displacement]
            .map(|displaced| network_energy(self.search.model, displaced));
        let lost = work - (after? - before?);
        let held = lost <= way.lost * work.abs();
        if !held {
            return Err(StepFailure::Jump { part: lost / work.abs() }.into());
        }
        let law = StepLaw { gain: self.factors.total_gain, carried: &self.carried, inertia: 0.0 };
        let (model, displacement) = (self.search.model, &self.search.displacement);
        let outcome = self.search.tangent.refresh(model, &law, displacement, None);
        self.search.check_factor(outcome, false)
    }

    /// Change of Green's strain, root mean square over the body.
    fn strain_of_step(&self) -> f64 {
        let model = self.search.model;
        let mut sum = 0.0;
        for (tet, nodes) in model.tets.iter().zip(&model.problem.elements) {
            let [from, to] = [&self.state.displacement, &self.search.displacement]
                .map(|displaced| corners(displaced, nodes));
            for point in &tet.points {
                let [from, to] =
                    [&from, &to].map(|at| green_lagrange(&point.displacement_gradient(at)));
                let change: Sym3 = std::array::from_fn(|i| to[i] - from[i]);
                sum += point.volume * double_dot(&change, &change);
            }
        }
        (sum / self.volume).sqrt()
    }

    /// Work of loads and supports by the trapezoidal rule, J.
    fn work_of_step(&self) -> f64 {
        let nodes = self.state.displacement.iter().zip(&self.search.displacement);
        let forces = self.state.forces.iter().zip(&self.search.internal);
        let of_node = |((from, to), (before, after)): ((&Vec3, &Vec3), (&Vec3, &Vec3))| {
            let gone = std::array::from_fn(|i| to[i] - from[i]);
            -0.5 * (dot(*before, gone) + dot(*after, gone))
        };
        nodes.zip(forces).map(of_node).sum()
    }
}
