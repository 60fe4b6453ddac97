//! Energy of the network and stresses of a solid of rubber.

use crate::ch2_housing::elastomer::maxwell::spring_energy;
use crate::elements::tet10::{POINTS, Tet10};
use crate::elements::tet10_nodal;
use crate::kinematics::strain::{Sym3, cauchy};
use crate::kinematics::vec3::Vec3;
use crate::solids::error::StepFailure;
use crate::solids::model::corners;
use crate::solids::rubber::checkpoint::RubberState;
use crate::solids::rubber::model::RubberModel;
use crate::solids::rubber::tangent::{at_points, in_element, mean_stresses};
use crate::solids::stress::{at_ten_nodes, average_at_nodes};

/// Energy of the network at given displacements, J: of the chains at the quadrature points and of volume around the
/// corner nodes. Its derivatives are the forces.
///
/// # Errors
///
/// An inverted element, or one beyond the material's limit.
pub fn network_energy(model: &RubberModel, displacement: &[Vec3]) -> Result<f64, StepFailure> {
    let network = &model.problem.material.network;
    let mut energy = 0.0;
    for (index, (tet, nodes)) in model.tets.iter().zip(&model.problem.elements).enumerate() {
        let (strains, ..) = tet10_nodal::strains(tet, &corners(displacement, nodes));
        for (point, strain) in tet.points.iter().zip(&strains) {
            let density = network.isochoric_energy(strain).map_err(in_element(model, index))?;
            energy += point.volume * density;
        }
    }
    let mut means = vec![0.0; model.patches.len()];
    mean_stresses(model, displacement, &mut means)?;
    for (mean, patch) in means.iter().zip(&model.patches) {
        energy += patch.volume * network.volume_energy(mean / network.bulk);
    }
    Ok(energy)
}

/// Smallest and largest volume around a corner node, relative to that at rest, less one.
///
/// # Errors
///
/// An inverted element.
pub fn volume_changes(model: &RubberModel, displacement: &[Vec3]) -> Result<[f64; 2], StepFailure> {
    let mut means = vec![0.0; model.patches.len()];
    mean_stresses(model, displacement, &mut means)?;
    let changes = means.iter().map(|mean| mean / model.problem.material.network.bulk);
    Ok(changes.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], change| {
        [least.min(change), most.max(change)]
    }))
}

/// Length of the longest chain of the network, relative to a straight one.
///
/// # Errors
///
/// An inverted element.
pub fn longest_chain(model: &RubberModel, displacement: &[Vec3]) -> Result<f64, StepFailure> {
    let network = &model.problem.material.network;
    let mut longest = 0.0f64;
    for (index, (tet, nodes)) in model.tets.iter().zip(&model.problem.elements).enumerate() {
        let (strains, ..) = tet10_nodal::strains(tet, &corners(displacement, nodes));
        for strain in &strains {
            let length = network.chain_length(strain).map_err(in_element(model, index))?;
            longest = longest.max(length);
        }
    }
    Ok(longest)
}

/// Energy in the springs of the Maxwell elements by the law of small strain, J.
pub fn maxwell_energy(model: &RubberModel, state: &RubberState) -> f64 {
    let material = &model.problem.material;
    let (terms, shear_modulus) = (material.maxwell.len(), material.network.shear_modulus());
    // A relaxed state has no history.
    let points = model.tets.iter().flat_map(|tet| &tet.points);
    points.zip(state.history.chunks_exact(terms.max(1))).fold(0.0, |sum, (point, history)| {
        sum + point.volume * spring_energy(&material.maxwell, history, shear_modulus)
    })
}

/// Energy balance of the work of loads and supports, J. Energy and dissipation of Maxwell elements are known at small
/// strain only; the work of their stresses beyond that is a separate term, and the rest is the error of the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RubberLedger {
    /// Stored by the network.
    pub network: f64,
    /// Stored by the springs of the Maxwell elements.
    pub springs: f64,
    /// Dissipated by their dashpots.
    pub dissipated: f64,
    /// Work of the Maxwell stresses beyond both.
    pub beyond: f64,
    pub work: f64,
}

impl RubberLedger {
    /// # Errors
    ///
    /// Those of [`network_energy`].
    pub fn of(model: &RubberModel, state: &RubberState) -> Result<RubberLedger, StepFailure> {
        Ok(RubberLedger {
            network: network_energy(model, &state.displacement)?,
            springs: maxwell_energy(model, state),
            dissipated: state.dissipated,
            beyond: state.beyond,
            work: state.work,
        })
    }

    /// Stored and dissipated energy, less the work put in.
    pub fn residual(&self) -> f64 {
        self.network + self.springs + self.dissipated + self.beyond - self.work
    }
}

/// Cauchy stresses, Pa: XX YY ZZ XY YZ ZX.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RubberStresses {
    /// Means of the elements by undeformed volume.
    pub cells: Vec<Sym3>,
    /// Extrapolated from the quadrature points and averaged over the elements at a node.
    pub nodes: Vec<Sym3>,
}

/// Cauchy stress at the quadrature points of every element, Pa: of network, Maxwell elements and volume.
///
/// # Errors
///
/// An inverted element.
pub fn point_stresses(
    model: &RubberModel,
    state: &RubberState,
) -> Result<Vec<[Sym3; POINTS]>, StepFailure> {
    let mut means = vec![0.0; model.patches.len()];
    mean_stresses(model, &state.displacement, &mut means)?;
    // A relaxed state has no history.
    let terms = state.history.len() / state.deviatoric.len().max(1);
    let of = |index: usize| {
        let moved = corners(&state.displacement, &model.problem.elements[index]);
        let means = at_points(model, index, &means);
        std::array::from_fn(|point| {
            let at = POINTS * index + point;
            let mut second = state.deviatoric[at];
            for held in &state.history[terms * at..terms * (at + 1)] {
                second.iter_mut().zip(held).for_each(|(sum, part)| *sum += part);
            }
            let h = model.tets[index].points[point].displacement_gradient(&moved);
            let mut stress = cauchy(&h, &second);
            stress[..3].iter_mut().for_each(|normal| *normal += means[point]);
            stress
        })
    };
    Ok((0..model.tets.len()).map(of).collect())
}

/// Stresses of elements and at nodes.
///
/// # Errors
///
/// An inverted element.
pub fn stresses(model: &RubberModel, state: &RubberState) -> Result<RubberStresses, StepFailure> {
    let at_points = point_stresses(model, state)?;
    let mean = |(stresses, tet): (&[Sym3; POINTS], &Tet10)| {
        let mut sum = [0.0; 6];
        for (stress, point) in stresses.iter().zip(&tet.points) {
            sum.iter_mut().zip(stress).for_each(|(sum, s)| *sum += point.volume * s);
        }
        sum.map(|sum| sum / tet.volume())
    };
    let cells = at_points.iter().zip(&model.tets).map(mean).collect();
    let elements = model.problem.elements.iter().zip(&model.tets).zip(&at_points);
    let elements = elements
        .map(|((nodes, tet), stresses)| (nodes.as_slice(), at_ten_nodes(stresses), tet.volume()));
    Ok(RubberStresses { cells, nodes: average_at_nodes(model.problem.nodes.len(), elements) })
}
