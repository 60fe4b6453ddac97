//! Rubber in explicit steps (2.15), (3.12): nodes without damping other than the rubber's own.
//!
//! The steps are those of any solid ([`ExplicitSolid`]); the forces are of four-node elements with the eight-chain
//! network and its Maxwell elements, whose history each step commits once (2.13).

use crate::ch2_housing::elastomer::Elastomer;
use crate::ch2_housing::elastomer::maxwell::alternating_factor;
use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet4::Tet4;
use crate::kinematics::vec3::Vec3;
use crate::mesh::Elements;
use crate::solids::error::SolidError;
use crate::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping, padded};
use crate::solids::model::{DampedMotion, Load, Prescribed, SolidModel, SolidProblem, corners};
use crate::solids::rubber::tet_forces::{History, MeanStress, RubberForces};
use crate::solids::step_limit::{
    MOST_PRODUCTS, SolidStepLimit, lanczos, roots, stability_margin, step_limit_within,
};
use crate::solids::tet4_blocks::Node;

/// A solid of one rubber in four-node elements, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct RubberBody {
    /// Undeformed positions, m.
    pub nodes: Vec<Vec3>,
    pub elements: Vec<[u32; 4]>,
    pub material: Elastomer,
    /// kg/m³.
    pub density: f64,
    pub mean_stress: MeanStress,
    /// Factor on all masses, for longer steps in slow motions; weight is unchanged. 1 is the true motion. The error in
    /// a motion of frequency f grows with this times f².
    pub mass_scale: f64,
    /// Fixed or moved displacement components.
    pub prescribed: Vec<Prescribed>,
    pub loads: Vec<Load>,
    /// m/s².
    pub gravity: Vec3,
}

/// Step limit of a rubber body, and its basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RubberStepLimit {
    pub limit: SolidStepLimit,
    /// Ratio of the deviatoric stiffness to the network's in the fastest motion of the step; 1 + Σγ for a step far
    /// shorter than every relaxation time.
    pub stiffening: f64,
    pub mass_scale: f64,
}

impl RubberBody {
    /// The body as an elastic one of its first instant at rest: with 1 + Σγ times the network's shear modulus.
    ///
    /// # Errors
    ///
    /// A mass scale that is not positive; those of [`SolidModel::new`].
    pub fn model(&self) -> Result<SolidModel, SolidError> {
        let scale = self.mass_scale;
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(SolidError::Option { what: "mass scale", value: scale });
        }
        let shear_modulus = self.material.instantaneous_shear_modulus();
        let lambda = self.material.network.bulk - 2.0 / 3.0 * shear_modulus;
        let problem = SolidProblem {
            nodes: self.nodes.clone(),
            elements: Elements::Linear(self.elements.clone()),
            material: LinearElastic { lambda, shear_modulus },
            density: scale * self.density,
            damping: 0.0,
            damped_motion: DampedMotion::Absolute,
            prescribed: self.prescribed.clone(),
            loads: self.loads.clone(),
            gravity: self.gravity.map(|g| g / scale),
        };
        SolidModel::new(problem)
    }

    /// Forces of its elements, at rest and relaxed.
    ///
    /// # Errors
    ///
    /// An element of zero volume.
    pub fn forces(&self) -> Result<RubberForces, SolidError> {
        let model = self.model()?;
        let sound = "elements were checked when the model was made";
        let tets = self.elements.iter().map(|element| {
            (Tet4::new(&corners(&model.problem.nodes, element)).expect(sound), *element)
        });
        Ok(RubberForces::new(self.material.clone(), self.mean_stress, self.nodes.len(), tets))
    }
}

impl ExplicitSolid {
    /// Rubber in central differences from t = 0, from given displacements and velocities (m, m/s), one for each node,
    /// in which it is relaxed.
    ///
    /// # Errors
    ///
    /// Those of [`RubberBody::model`]; a step beyond the stability limit.
    pub fn of_rubber(
        body: &RubberBody,
        stepping: SolidStepping,
        displacement: Vec<Vec3>,
        velocity: Vec<Vec3>,
    ) -> Result<(ExplicitSolid, RubberStepLimit), SolidError> {
        let (model, mut forces) = (body.model()?, body.forces()?);
        let displacement = padded(displacement);
        let found = rubber_step_limit(body, &model, &mut forces, &displacement);
        let limit = found.limit;
        let step = match stepping {
            SolidStepping::FractionOfLimit(fraction) => fraction * limit.step,
            SolidStepping::Fixed(step) => step,
        };
        if !(step > 0.0 && step <= limit.step) {
            let element = model.labels.element(limit.element);
            let at = limit.at;
            return Err(SolidError::Step { step, limit: limit.step, element, at });
        }
        let method = ExplicitMethod::CentralDifferences;
        let mut solid = ExplicitSolid::at_rest(model, method, step, limit);
        solid.rubber = Some(Box::new(forces));
        solid.start(displacement, padded(velocity));
        Ok((solid, found))
    }

    /// Rubber at rest with given displacements (m), in `fraction` of the longest step; its prescribed nodes move with
    /// bodies ([`ExplicitSolid::drive_nodes`]), which have their mass. Dissipation is counted.
    ///
    /// # Errors
    ///
    /// Those of [`RubberBody::model`].
    /// As [`RubberBody::model`].
    pub fn of_driven_rubber(
        body: &RubberBody,
        fraction: f64,
        displacement: Vec<Vec3>,
    ) -> Result<ExplicitSolid, SolidError> {
        let (mut model, mut forces) = (body.model()?, body.forces()?);
        let displacement = padded(displacement);
        let limit = rubber_step_limit(body, &model, &mut forces, &displacement).limit;
        for Prescribed { node, .. } in std::mem::take(&mut model.problem.prescribed) {
            model.mass[node as usize] = 0.0;
        }
        let still = vec![[0.0; 4]; displacement.len()];
        let method = ExplicitMethod::CentralDifferences;
        let mut solid = ExplicitSolid::at_rest(model, method, fraction * limit.step, limit);
        forces.count_dissipation();
        solid.rubber = Some(Box::new(forces));
        solid.start(displacement, still);
        Ok(solid)
    }

    /// Sets nodes of bodies to their present displacement and rate: node, displacement (m), rate (m/s).
    pub fn drive_nodes(&mut self, nodes: impl Iterator<Item = (u32, Vec3, Vec3)>) {
        for (node, displacement, rate) in nodes {
            self.displacement[node as usize][..3].copy_from_slice(&displacement);
            self.rate[node as usize][..3].copy_from_slice(&rate);
        }
    }

    /// Forces and history of a solid of rubber.
    pub fn rubber(&self) -> Option<&RubberForces> {
        self.rubber.as_deref()
    }
}

/// The largest stable step at given displacements. Fast Maxwell elements relax within a long step, which reduces the
/// stiffness and allows a longer step: found from below, so that every value tried is stable.
fn rubber_step_limit(
    body: &RubberBody,
    model: &SolidModel,
    forces: &mut RubberForces,
    displacement: &[Node],
) -> RubberStepLimit {
    let maxwell = &body.material.maxwell;
    let still = vec![[0.0; 4]; displacement.len()];
    // The bound holds at rest, for either mean stress: averages do not increase the stiffness.
    let mut limit = step_limit_within(model, &still, ExplicitMethod::CentralDifferences, 0);
    let mut stiffening = alternating_factor(maxwell, 0.0);
    for _ in 0..20 {
        let root = roots(model);
        let (found, products) = lanczos(&root, MOST_PRODUCTS, |now, next| {
            stiffness_product(forces, &root, displacement, stiffening, now, next);
        });
        limit.products += products;
        let Some(frequency) = found else { break };
        limit.frequency = frequency;
        limit.is_bound = false;
        limit.step = stability_margin(ExplicitMethod::CentralDifferences) / frequency;
        let next = alternating_factor(maxwell, limit.step);
        let settled = stiffening - next <= 0.01 * stiffening;
        if settled {
            break;
        }
        stiffening = next;
    }
    RubberStepLimit { limit, stiffening, mass_scale: body.mass_scale }
}

/// Adds M^(−½) K M^(−½) `x`, K the derivative of the forces with the network's deviatoric stress times `factor`, by
/// central differences with a displacement of at most a millionth of a side of the smallest element.
fn stiffness_product(
    forces: &mut RubberForces,
    root: &[Vec3],
    displacement: &[Node],
    factor: f64,
    x: &[Vec3],
    sum: &mut [Vec3],
) {
    let largest = x.iter().zip(root).flat_map(|(x, r)| [x[0] * r[0], x[1] * r[1], x[2] * r[2]]);
    let largest = largest.fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let by = 1e-6 * forces.shortest() / largest;
    let mut both = [1.0, -1.0].map(|sign: f64| {
        let mut moved = displacement.to_vec();
        for ((u, x), r) in moved.iter_mut().zip(x).zip(root) {
            for i in 0..3 {
                u[i] += sign * by * x[i] * r[i];
            }
        }
        let mut of = vec![[0.0; 4]; moved.len()];
        forces.add_forces(&moved, &mut of, History::Scaled(factor));
        of
    });
    let [after, before] = &mut both;
    for (((sum, a), b), r) in sum.iter_mut().zip(after).zip(before).zip(root) {
        for i in 0..3 {
            sum[i] -= (a[i] - b[i]) / (2.0 * by) * r[i];
        }
    }
}
