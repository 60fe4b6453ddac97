//! Forces and stiffness of a solid of rubber at the end of a step, and factors for several steps.

use crate::ch2_housing::elastomer::ElastomerError;
use crate::elements::tet10::POINTS;
use crate::elements::tet10_nodal::{self, Response, Stiffness};
use crate::kinematics::strain::Sym3;
use crate::kinematics::vec3::{Vec3, add_scaled};
use crate::numeric::sparse::{Entry, Factor, SymmetricMatrix};
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::model::corners;
use crate::solids::rubber::checkpoint::Factored;
use crate::solids::rubber::model::{Patch, RubberModel, centre};
use crate::solids::tangent::PRESCRIBED;

/// Deviatoric stress at the end of a step: (1 + `gain`) DEV S plus the relaxed history of each quadrature point, Pa.
#[derive(Clone, Copy, Debug)]
pub struct StepLaw<'a> {
    pub gain: f64,
    /// One for each point, or empty for none.
    pub carried: &'a [Sym3],
    /// Acceleration per displacement at the end of the step, 1/s²; zero without inertia.
    pub inertia: f64,
}

impl StepLaw<'_> {
    /// The network alone, with all Maxwell elements relaxed.
    pub const RELAXED: StepLaw<'static> = StepLaw { gain: 0.0, carried: &[], inertia: 0.0 };

    fn total(&self, at: usize, own: &Sym3) -> Sym3 {
        let carried = self.carried.get(at).copied().unwrap_or_default();
        std::array::from_fn(|i| (1.0 + self.gain) * own[i] + carried[i])
    }
}

/// Mean stress at every corner node from the volume around it, Pa, in the order of the patches.
///
/// # Errors
///
/// An inverted element.
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
            return Err(StepFailure::Inverted { element: index as u64 + 1, at, ratio });
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

/// Adds the forces of all elements on the nodes, N, and stores DEV S of the network at every quadrature point and the
/// [`mean_stresses`], Pa.
///
/// # Errors
///
/// An inverted element, or one beyond the material's limit.
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
pub(crate) fn at_points(model: &RubberModel, element: usize, means: &[f64]) -> [f64; POINTS] {
    tet10_nodal::at_points(&model.patches_of[element].map(|patch| means[patch as usize]))
}

pub(crate) fn in_element(
    model: &RubberModel,
    element: usize,
) -> impl Fn(ElastomerError) -> StepFailure {
    let at = centre(&model.problem, element);
    move |source| StepFailure::Material { element: element as u64 + 1, at, source }
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

/// Factors of the tangent, and their number.
pub struct Tangent {
    matrix: SymmetricMatrix,
    factor: Option<Factor>,
    /// State of the factors, and whether they are valid.
    factored: Factored,
    is_sound: bool,
    pub factorisations: usize,
    /// For the present patch: derivative of its volume by the nodes, and its unknowns, ascending.
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

    /// The last factorised stiffness, N/m.
    pub fn stiffness(&self) -> &SymmetricMatrix {
        &self.matrix
    }

    /// Returns whether the factors of a step may start another one.
    pub fn serves(&self, law: &StepLaw) -> bool {
        let Factored { gain, inertia, .. } = self.factored;
        let near = (law.gain - gain).abs() <= 0.05 * (1.0 + gain);
        self.is_sound && near && (law.inertia - inertia).abs() <= 0.05 * inertia
    }

    /// State of the present factors.
    pub fn factored(&self) -> Option<&Factored> {
        self.is_sound.then_some(&self.factored)
    }

    /// Recomputes the factors of a state; without one the next search computes its own.
    ///
    /// # Errors
    ///
    /// Those of [`Tangent::refresh`]; never in a state that was factorised before.
    pub fn restore(
        &mut self,
        model: &RubberModel,
        of: Option<&Factored>,
    ) -> Result<(), SolidError> {
        self.is_sound = false;
        let Some(Factored { gain, inertia, displacement, carried }) = of else { return Ok(()) };
        let law = StepLaw { gain: *gain, carried, inertia: *inertia };
        self.refresh(model, &law, displacement, None)
    }

    /// Drops the factors of a failed search.
    pub fn forget(&mut self) {
        self.is_sound = false;
    }

    /// Factors in a state. If `moves` are changes of the prescribed components, their forces on the unknowns are
    /// subtracted from `right`.
    ///
    /// # Errors
    ///
    /// Those of [`add_forces`]; a stiffness that is not positive definite.
    pub fn refresh(
        &mut self,
        model: &RubberModel,
        law: &StepLaw,
        displacement: &[Vec3],
        mut moves: Option<(&[Vec3], &mut [f64])>,
    ) -> Result<(), SolidError> {
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
        for (of, mass) in model.unknowns.of.iter().zip(&model.mass) {
            for unknown in of.iter().filter(|unknown| **unknown != PRESCRIBED) {
                let entry = Entry { row: *unknown, column: *unknown };
                self.matrix.add(entry, law.inertia * mass);
            }
        }
        (self.factored.gain, self.factored.inertia) = (law.gain, law.inertia);
        self.factored.displacement.clear();
        self.factored.displacement.extend_from_slice(displacement);
        self.factored.carried.clear();
        self.factored.carried.extend_from_slice(law.carried);
        self.factorisations += 1;
        let outcome = match &mut self.factor {
            Some(factor) => factor.refactor(&self.matrix),
            None => model.unknowns.factor(&self.matrix).map(|factor| self.factor = Some(factor)),
        };
        // Failed factors are invalid.
        self.is_sound = outcome.is_ok();
        Ok(outcome?)
    }

    /// Adds the stiffness of the mean stress at one corner node: the product of a vector with itself.
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
