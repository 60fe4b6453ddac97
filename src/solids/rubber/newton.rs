//! Newton's method for the equilibrium of a solid of rubber at the end of a step.

use crate::elements::tet10::POINTS;
use crate::kinematics::strain::Sym3;
use crate::kinematics::vec3::Vec3;
use crate::numeric::sparse::FactorError;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::newton::{Convergence, Unbalanced, add_solution, converge};
use crate::solids::rubber::model::{Moment, RubberModel};
use crate::solids::rubber::tangent::{StepLaw, Tangent, add_forces};

/// A search for equilibrium: displacements and working memory.
pub struct Search<'a> {
    pub model: &'a RubberModel,
    pub tangent: Tangent,
    pub displacement: Vec<Vec3>,
    /// DEV S of the network at the present displacements, Pa.
    pub deviatoric: Vec<Sym3>,
    /// Mean stress at the corner nodes, Pa.
    pub means: Vec<f64>,
    /// Forces of the elements on the nodes, and loads, N.
    pub internal: Vec<Vec3>,
    pub loads: Vec<Vec3>,
    /// Displacements of nodes of bodies, m.
    pub driven: Vec<(u32, Vec3)>,
    /// Positions of the nodes without acceleration at the end of the step, m; with inertia only.
    pub newmark_predictor: Vec<Vec3>,
    right: Vec<f64>,
    moves: Vec<Vec3>,
    pub iterations: usize,
    /// Number of runs of each stage.
    pub ran: Counts,
}

impl<'a> Search<'a> {
    /// At rest.
    pub fn new(model: &'a RubberModel) -> Search<'a> {
        let count = model.problem.nodes.len();
        Search {
            tangent: Tangent::new(model),
            displacement: vec![[0.0; 3]; count],
            deviatoric: vec![[0.0; 6]; POINTS * model.tets.len()],
            means: vec![0.0; model.patches.len()],
            internal: vec![[0.0; 3]; count],
            loads: vec![[0.0; 3]; count],
            driven: Vec::new(),
            newmark_predictor: vec![[0.0; 3]; model.mass.len()],
            right: vec![0.0; model.unknowns.count],
            moves: vec![[0.0; 3]; count],
            iterations: 0,
            ran: Counts::default(),
            model,
        }
    }

    /// Moves the prescribed components to their values at a moment, and the others by the tangent in the present state.
    ///
    /// # Errors
    ///
    /// Those of [`Search::converge`].
    pub fn predict(&mut self, at: Moment, law: &StepLaw) -> Result<(), SolidError> {
        let unbalanced = self.balance(at, law)?;
        let before = std::mem::take(&mut self.displacement);
        self.moves.copy_from_slice(&before);
        prescribe(self.model, at, &self.driven, &mut self.moves);
        for (moved, before) in self.moves.iter_mut().zip(&before) {
            *moved = std::array::from_fn(|i| moved[i] - before[i]);
        }
        let outcome =
            self.tangent.refresh(self.model, law, &before, Some((&self.moves, &mut self.right)));
        self.displacement = before;
        self.check_factor(outcome, unbalanced.scale == 0.0)?;
        prescribe(self.model, at, &self.driven, &mut self.displacement);
        self.step();
        Ok(())
    }

    /// Forces in the present state, and the right-hand side.
    fn balance(&mut self, at: Moment, law: &StepLaw) -> Result<Unbalanced, SolidError> {
        self.internal.fill([0.0; 3]);
        self.loads.fill([0.0; 3]);
        add_forces(
            self.model,
            law,
            &self.displacement,
            &mut self.internal,
            &mut self.deviatoric,
            &mut self.means,
        )?;
        self.model.add_loads(at, &mut self.loads);
        self.ran.add(Stage::Elements, self.model.tets.len() as u64);
        self.ran.add(Stage::Loads, self.model.problem.loads.len() as u64);
        if law.inertia > 0.0 {
            // Their inertia is a load on the nodes.
            let nodes = self.displacement.iter().zip(&self.newmark_predictor);
            for ((load, mass), (u, free)) in self.loads.iter_mut().zip(&self.model.mass).zip(nodes)
            {
                for i in 0..3 {
                    load[i] -= law.inertia * mass * (u[i] - free[i]);
                }
            }
        }
        let forces = [&self.internal[..], &self.loads];
        Ok(Unbalanced::of(&self.model.unknowns, forces, 1.0, &mut self.right)?)
    }

    pub fn check_factor(
        &self,
        outcome: Result<(), SolidError>,
        rest: bool,
    ) -> Result<(), SolidError> {
        outcome.map_err(|error| match error {
            SolidError::Factor(FactorError::NotPositiveDefinite { .. }) if !rest => {
                StepFailure::Unstable.into()
            }
            SolidError::Factor(error) => self.model.at_rest(error),
            error => error,
        })
    }

    /// Newton iterations at a moment from the present displacements, with the factors of an earlier state as long as
    /// they reduce the residual tenfold a step.
    ///
    /// # Errors
    ///
    /// No convergence, an inverted element or one beyond the material's limit, an unstable state.
    pub fn converge(
        &mut self,
        at: Moment,
        law: &StepLaw,
        options: &Convergence,
    ) -> Result<(), SolidError> {
        prescribe(self.model, at, &self.driven, &mut self.displacement);
        self.ran.add(Stage::Supports, self.model.problem.prescribed.len() as u64);
        let factorise = |search: &mut Self| {
            let displacement = std::mem::take(&mut search.displacement);
            let outcome = search.tangent.refresh(search.model, law, &displacement, None);
            search.displacement = displacement;
            search.check_factor(outcome, false)
        };
        let serves = |search: &Self| search.tangent.serves(law);
        let balance = |search: &mut Self| search.balance(at, law);
        converge(self, options, balance, serves, factorise, Search::step).map(|_| ())
    }

    fn step(&mut self) {
        self.tangent.solve(&mut self.right);
        add_solution(&self.model.unknowns, &self.right, &mut self.displacement);
        self.iterations += 1;
    }

    /// Forces in a state that was in equilibrium at a moment, after a search for another one.
    pub fn return_to(&mut self, at: Moment, law: &StepLaw) {
        // The state was found before, so that it is valid.
        let _ = self.balance(at, law);
    }

    /// Sum of the forces of the supports on some nodes as of the last [`Search::converge`], N.
    pub fn support_force(&self, nodes: &[u32]) -> Vec3 {
        let mut sum = [0.0; 3];
        for node in nodes {
            let (inner, outer) = (self.internal[*node as usize], self.loads[*node as usize]);
            for i in 0..3 {
                sum[i] -= inner[i] + outer[i];
            }
        }
        sum
    }
}

/// Sets prescribed components, and nodes of bodies, to their values at a moment.
fn prescribe(model: &RubberModel, at: Moment, driven: &[(u32, Vec3)], displacement: &mut [Vec3]) {
    model.prescribe(at, displacement);
    for (node, place) in driven {
        displacement[*node as usize] = *place;
    }
}
