//! Forces and stiffness of a solid of rubber at the end of a step, and Newton's method for its
//! equilibrium there.

use super::checkpoint::Factored;
use super::error::{RubberError, StepFailure, at_rest};
use super::model::{Moment, Patch, RubberModel, centre};
use crate::ch2_housing::elastomer::ElastomerError;
use crate::elements::tet10::POINTS;
use crate::elements::tet10_nodal::{self, Response, Stiffness};
use crate::kinematics::strain::Sym3;
use crate::kinematics::vec3::{Vec3, add_scaled};
use crate::solver::plan::{Stage, tally::Tally};
use crate::solver::solid::model::corners;
use crate::solver::solid::tangent::PRESCRIBED;
use crate::solver::sparse::{Entry, Factor, FactorError, SymmetricMatrix};

/// What the deviatoric stress at the end of a step is made of: (1 + `gain`) DEV S plus what each
/// quadrature point carries over, Pa.
#[derive(Clone, Copy, Debug)]
pub struct StepLaw<'a> {
    pub gain: f64,
    /// One for each point, or empty for none.
    pub carried: &'a [Sym3],
}

impl StepLaw<'_> {
    /// The network alone: long after every Maxwell element has relaxed.
    pub const RELAXED: StepLaw<'static> = StepLaw { gain: 0.0, carried: &[] };

    fn total(&self, at: usize, own: &Sym3) -> Sym3 {
        let carried = self.carried.get(at).copied().unwrap_or_default();
        std::array::from_fn(|i| (1.0 + self.gain) * own[i] + carried[i])
    }
}

/// Mean stress at every corner node from the volume around it, Pa, in the order of the patches.
///
/// # Errors
/// An element turned inside out.
pub fn mean_stresses(
    model: &RubberModel,
    displacement: &[Vec3],
    stresses: &mut [f64],
) -> Result<(), StepFailure> {
    stresses.fill(0.0);
    for (index, (tet, nodes)) in model.tets.iter().zip(&model.problem.elements).enumerate() {
        let (_, changes, inverted) = tet10_nodal::strains(tet, &corners(displacement, nodes));
        if let Some(ratio) = inverted {
            let at = centre(&model.problem, index);
            return Err(StepFailure::Inverted { element: index + 1, at, ratio });
        }
        let sums = tet10_nodal::at_corners(tet, &changes);
        for (patch, sum) in model.patches_of[index].iter().zip(sums) {
            stresses[*patch as usize] += sum;
        }
    }
    for (stress, patch) in stresses.iter_mut().zip(&model.patches) {
        *stress = model.problem.material.network.mean_stress(*stress / patch.volume);
    }
    Ok(())
}

/// Adds the forces of all elements on the nodes, N, and notes DEV S of the network at every
/// quadrature point and the [`mean_stresses`], Pa.
///
/// # Errors
/// An element turned inside out, or beyond what its material can bear.
pub fn add_forces(
    model: &RubberModel,
    law: &StepLaw,
    displacement: &[Vec3],
    forces: &mut [Vec3],
    deviatoric: &mut [Sym3],
    means: &mut [f64],
) -> Result<(), StepFailure> {
    mean_stresses(model, displacement, means)?;
    let network = &model.problem.material.network;
    for (index, (tet, nodes)) in model.tets.iter().zip(&model.problem.elements).enumerate() {
        let moved = corners(displacement, nodes);
        let (strains, ..) = tet10_nodal::strains(tet, &moved);
        let mut stresses = [[0.0; 6]; POINTS];
        for point in 0..POINTS {
            let at = POINTS * index + point;
            let own =
                network.isochoric_stress(&strains[point]).map_err(in_element(model, index))?;
            deviatoric[at] = own;
            stresses[point] = law.total(at, &own);
        }
        let of = tet10_nodal::nodal_forces(tet, &moved, &stresses, &at_points(model, index, means));
        for (node, of) in nodes.iter().zip(of) {
            for i in 0..3 {
                forces[*node as usize][i] += of[i];
            }
        }
    }
    Ok(())
}

/// Mean stress at the quadrature points of an element, Pa.
pub(super) fn at_points(model: &RubberModel, element: usize, means: &[f64]) -> [f64; POINTS] {
    tet10_nodal::at_points(&model.patches_of[element].map(|patch| means[patch as usize]))
}

pub(super) fn in_element(
    model: &RubberModel,
    element: usize,
) -> impl Fn(ElastomerError) -> StepFailure {
    let at = centre(&model.problem, element);
    move |source| StepFailure::Material { element: element + 1, at, source }
}

/// Stiffness of one element in a state at given mean stresses, N/m.
fn element_stiffness(
    model: &RubberModel,
    law: &StepLaw,
    displacement: &[Vec3],
    means: &[f64],
    index: usize,
) -> Result<Stiffness, StepFailure> {
    let network = &model.problem.material.network;
    let tet = &model.tets[index];
    let moved = corners(displacement, &model.problem.elements[index]);
    let (strains, ..) = tet10_nodal::strains(tet, &moved);
    let mut responses = [Response { stress: [0.0; 6], tangent: [[0.0; 6]; 6] }; POINTS];
    for (point, response) in responses.iter_mut().enumerate() {
        let of = network.isochoric_tangent(&strains[point]).map_err(in_element(model, index))?;
        response.stress = law.total(POINTS * index + point, &of.0);
        response.tangent = of.1.map(|row| row.map(|x| (1.0 + law.gain) * x));
    }
    Ok(tet10_nodal::stiffness(tet, &moved, &responses, &at_points(model, index, means)))
}

/// The tangent's factors, and how many were made.
pub struct Tangent {
    matrix: SymmetricMatrix,
    factor: Option<Factor>,
    /// What the factors are of, and whether there are sound ones.
    factored: Factored,
    is_sound: bool,
    pub factorisations: usize,
    /// Of the patch at work: how its volume follows the nodes, and its unknowns with that, ascending.
    slopes: Vec<Vec3>,
    along: Vec<(usize, f64)>,
    means: Vec<f64>,
}

impl Tangent {
    pub fn new(model: &RubberModel) -> Tangent {
        Tangent {
            matrix: model.pattern(),
            factor: None,
            factored: Factored::default(),
            is_sound: false,
            factorisations: 0,
            slopes: vec![[0.0; 3]; model.problem.nodes.len()],
            along: Vec::new(),
            means: vec![0.0; model.patches.len()],
        }
    }

    /// The stiffness that was last factorised, N/m.
    pub fn stiffness(&self) -> &SymmetricMatrix {
        &self.matrix
    }

    /// Whether factors of a step with this gain are near enough to begin with.
    pub fn serves(&self, gain: f64) -> bool {
        let made = self.factored.gain;
        self.is_sound && (gain - made).abs() <= 0.05 * (1.0 + made)
    }

    /// The state that the factors at hand are of.
    pub fn factored(&self) -> Option<&Factored> {
        self.is_sound.then_some(&self.factored)
    }

    /// Makes the factors of such a state again; with none the next search makes its own.
    ///
    /// # Errors
    /// As [`Tangent::refresh`]; never in a state that factors were made of before.
    pub fn restore(&mut self, model: &RubberModel, of: Option<&Factored>) -> Result<(), Stop> {
        self.is_sound = false;
        let Some(Factored { gain, displacement, carried }) = of else { return Ok(()) };
        let law = StepLaw { gain: *gain, carried };
        self.refresh(model, &law, displacement, None)?.map_err(at_rest).map_err(Stop::All)
    }

    /// Factors made on the way to where no equilibrium was found serve nobody.
    pub fn forget(&mut self) {
        self.is_sound = false;
    }

    /// Factors in a state. If `moves` are changes of the prescribed components, `right` loses the
    /// forces that they make on the unknowns.
    ///
    /// # Errors
    /// As [`add_forces`]; a stiffness that is not positive definite.
    pub fn refresh(
        &mut self,
        model: &RubberModel,
        law: &StepLaw,
        displacement: &[Vec3],
        mut moves: Option<(&[Vec3], &mut [f64])>,
    ) -> Result<Result<(), FactorError>, StepFailure> {
        self.matrix.clear();
        mean_stresses(model, displacement, &mut self.means)?;
        for (index, nodes) in model.problem.elements.iter().enumerate() {
            let k = element_stiffness(model, law, displacement, &self.means, index)?;
            let unknown = |at: usize| model.unknowns.of[nodes[at / 3] as usize][at % 3];
            for row in 0..k.len() {
                for column in 0..=row {
                    let (a, b) = (unknown(row), unknown(column));
                    let value = k[row][column];
                    if a != PRESCRIBED && b != PRESCRIBED {
                        let entry = Entry { row: a.max(b), column: a.min(b) };
                        self.matrix.add(entry, value);
                    } else if let Some((moves, right)) = &mut moves {
                        let moved = |at: usize| moves[nodes[at / 3] as usize][at % 3];
                        if a != PRESCRIBED {
                            right[a] -= value * moved(column);
                        } else if b != PRESCRIBED {
                            right[b] -= value * moved(row);
                        }
                    }
                }
            }
        }
        for patch in &model.patches {
            self.add_volume(model, displacement, patch, &mut moves);
        }
        self.factored.gain = law.gain;
        self.factored.displacement.clear();
        self.factored.displacement.extend_from_slice(displacement);
        self.factored.carried.clear();
        self.factored.carried.extend_from_slice(law.carried);
        self.factorisations += 1;
        let outcome = match &mut self.factor {
            Some(factor) => factor.refactor(&self.matrix),
            None => model.unknowns.factor(&self.matrix).map(|factor| self.factor = Some(factor)),
        };
        // Factors that failed are of nothing.
        self.is_sound = outcome.is_ok();
        Ok(outcome)
    }

    /// Adds what the mean stress at one corner node changes: a product of one vector with itself.
    fn add_volume(
        &mut self,
        model: &RubberModel,
        displacement: &[Vec3],
        patch: &Patch,
        moves: &mut Option<(&[Vec3], &mut [f64])>,
    ) {
        for node in &patch.nodes {
            self.slopes[*node as usize] = [0.0; 3];
        }
        for (element, corner) in &patch.elements {
            let nodes = &model.problem.elements[*element as usize];
            let tet = &model.tets[*element as usize];
            let of =
                tet10_nodal::volume_slopes(tet, &corners(displacement, nodes), *corner as usize);
            for (node, slope) in nodes.iter().zip(of) {
                let sum = &mut self.slopes[*node as usize];
                *sum = add_scaled(*sum, 1.0, slope);
            }
        }
        let factor = model.problem.material.network.bulk / patch.volume;
        self.along.clear();
        let mut given = 0.0;
        for node in &patch.nodes {
            let (slope, of) = (self.slopes[*node as usize], model.unknowns.of[*node as usize]);
            for i in 0..3 {
                if of[i] != PRESCRIBED {
                    self.along.push((of[i], slope[i]));
                } else if let Some((moves, _)) = moves {
                    given += slope[i] * moves[*node as usize][i];
                }
            }
        }
        self.along.sort_unstable_by_key(|(unknown, _)| *unknown);
        self.matrix.add_square(factor, &self.along);
        if let Some((_, right)) = moves {
            for (unknown, slope) in &self.along {
                right[*unknown] -= factor * given * slope;
            }
        }
    }

    pub fn solve(&self, right: &mut [f64]) {
        if let Some(factor) = &self.factor {
            factor.solve(right);
        }
    }
}

/// What the forces left unbalanced.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unbalanced {
    /// Largest on an unknown, N.
    pub largest: f64,
    /// Largest force at work, N.
    pub scale: f64,
}

/// A search for equilibrium: displacements, and what it works with.
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
    right: Vec<f64>,
    moves: Vec<Vec3>,
    pub iterations: usize,
    /// How often each stage ran.
    pub ran: Tally,
}

/// When a search has converged, and when it gives up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Largest unbalanced force over the largest force at work.
    pub tolerance: f64,
    /// As much where it falls no further: rounding.
    pub rounding: f64,
    pub most_iterations: usize,
}

impl Default for Convergence {
    fn default() -> Self {
        // Forces of a step are good to 1e-3; what rounding leaves at B = 1e5 C_R is some 1e-9.
        Convergence { tolerance: 1e-9, rounding: 1e-7, most_iterations: 20 }
    }
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
            right: vec![0.0; model.unknowns.count],
            moves: vec![[0.0; 3]; count],
            iterations: 0,
            ran: Tally::default(),
            model,
        }
    }

    /// Adds the solution to the unknowns.
    fn advance(&mut self) {
        for (u, of) in self.displacement.iter_mut().zip(&self.model.unknowns.of) {
            for i in 0..3 {
                if of[i] != PRESCRIBED {
                    u[i] += self.right[of[i]];
                }
            }
        }
    }

    /// Moves the prescribed components to where they are at a moment, and the others along as the
    /// tangent in the present state has it.
    ///
    /// # Errors
    /// As [`Search::converge`].
    pub fn predict(&mut self, at: Moment, law: &StepLaw) -> Result<(), Stop> {
        let unbalanced = self.balance(at, law)?;
        let before = std::mem::take(&mut self.displacement);
        self.moves.copy_from_slice(&before);
        self.model.prescribe(at, &mut self.moves);
        for (moved, before) in self.moves.iter_mut().zip(&before) {
            *moved = std::array::from_fn(|i| moved[i] - before[i]);
        }
        let outcome =
            self.tangent.refresh(self.model, law, &before, Some((&self.moves, &mut self.right)));
        self.displacement = before;
        self.check_factor(outcome?, unbalanced.scale == 0.0)?;
        self.model.prescribe(at, &mut self.displacement);
        self.tangent.solve(&mut self.right);
        self.advance();
        self.iterations += 1;
        Ok(())
    }

    /// Forces in the present state, and the right-hand side.
    fn balance(&mut self, at: Moment, law: &StepLaw) -> Result<Unbalanced, StepFailure> {
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
        let mut found = Unbalanced::default();
        let mut finite = true;
        for (n, of) in self.model.unknowns.of.iter().enumerate() {
            for i in 0..3 {
                let (inner, outer) = (self.internal[n][i], self.loads[n][i]);
                found.scale = found.scale.max(inner.abs()).max(outer.abs());
                finite &= inner.is_finite() && outer.is_finite();
                if of[i] != PRESCRIBED {
                    self.right[of[i]] = inner + outer;
                    found.largest = found.largest.max((inner + outer).abs());
                }
            }
        }
        if finite { Ok(found) } else { Err(StepFailure::NotFinite) }
    }

    fn check_factor(&self, outcome: Result<(), FactorError>, rest: bool) -> Result<(), Stop> {
        match outcome {
            Ok(()) => Ok(()),
            Err(FactorError::NotPositiveDefinite { .. }) if !rest => {
                Err(Stop::Step(StepFailure::Unstable))
            }
            Err(error) => Err(Stop::All(at_rest(error))),
        }
    }

    /// Newton's iterations at a moment from the present displacements, with the factors of an earlier
    /// state as long as they bring the residual down tenfold a step.
    ///
    /// # Errors
    /// No convergence, an element turned inside out or beyond its material, an unstable state.
    pub fn converge(
        &mut self,
        at: Moment,
        law: &StepLaw,
        options: &Convergence,
    ) -> Result<(), Stop> {
        self.model.prescribe(at, &mut self.displacement);
        self.ran.add(Stage::Supports, self.model.problem.prescribed.len() as u64);
        let mut last = f64::INFINITY;
        let mut fresh = false;
        for iteration in 0..=options.most_iterations {
            let Unbalanced { largest, scale } = self.balance(at, law)?;
            let stagnates = fresh && largest > 0.5 * last && largest <= options.rounding * scale;
            if largest <= options.tolerance * scale || stagnates {
                return Ok(());
            }
            let diverged = iteration > 3 && largest > 1e3 * last;
            if iteration == options.most_iterations || diverged {
                let (residual, iterations) = (largest, iteration);
                return Err(StepFailure::NotConverged { residual, scale, iterations }.into());
            }
            fresh = !self.tangent.serves(law.gain) || largest > 0.1 * last;
            if fresh {
                let displacement = std::mem::take(&mut self.displacement);
                let outcome = self.tangent.refresh(self.model, law, &displacement, None);
                self.displacement = displacement;
                self.check_factor(outcome?, false)?;
            }
            last = largest;
            self.tangent.solve(&mut self.right);
            self.advance();
            self.iterations += 1;
        }
        unreachable!("the loop returns at its last iteration")
    }

    /// Forces in a state that was in equilibrium at a moment, after a search for another one.
    pub fn return_to(&mut self, at: Moment, law: &StepLaw) {
        // It was found before, so that nothing can be wrong with it.
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

/// Whether smaller steps might help.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    Step(StepFailure),
    All(RubberError),
}

impl From<RubberError> for Stop {
    fn from(error: RubberError) -> Stop {
        Stop::All(error)
    }
}

impl From<StepFailure> for Stop {
    fn from(failure: StepFailure) -> Stop {
        Stop::Step(failure)
    }
}
