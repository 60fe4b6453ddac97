//! Static equilibrium of a solid by Newton's method.

use crate::ch2_housing::bore_contact::{ContactNode, ContactSum, contact};
use crate::kinematics::strain::Mat3;
use crate::kinematics::vec3::{Vec3, norm};
use crate::numeric::sparse::{Factor, FactorError, SymmetricMatrix};
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::contact::CylinderContact;
use crate::solids::error::{Pivot, SolidError, StepFailure, at_rest};
use crate::solids::model::{Prescribed, SolidModel, centre};
use crate::solids::newton::{Convergence, Unbalanced, add_solution, converge};
use crate::solids::stress::first_inverted;
use crate::solids::tangent::{MassMatrix, PRESCRIBED, Unknowns, add_at_node, pattern, stiffness};
use crate::solids::trust::{Placed, farthest, size};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquilibriumOptions {
    /// Largest force residual, as a fraction of the largest force.
    pub tolerance: f64,
    /// The same if rounding prevents further reduction; see [`EquilibriumOptions::default`].
    pub rounding: f64,
    pub most_iterations: usize,
    /// Load steps are halved until they converge, down to this fraction of the load.
    pub smallest_load_step: f64,
    /// Mass matrix of gravity. Lumped masses give the state in which explicit steps stay at rest, for ten-node elements
    /// at the price of an order of convergence.
    pub gravity: MassMatrix,
}

impl Default for EquilibriumOptions {
    fn default() -> Self {
        EquilibriumOptions {
            // Rounding of nodal forces of stiff elements under small loads leaves about 1e-11.
            tolerance: 1e-10,
            // Towards ν = 1/2 the stresses of an element grow as 1/(1 − 2ν) while their sum at a node does not, and
            // rounding grows in proportion: 7e-10 for a bent bar at ν = 0.49999. 1e-8 is still far below the error of
            // meshes.
            rounding: 1e-8,
            most_iterations: 30,
            smallest_load_step: 1.0 / 1024.0,
            gravity: MassMatrix::Consistent,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Displacement of each node, m.
    pub displacement: Vec<Vec3>,
    /// Forces of the supports on the nodes, N; zero on free components.
    pub reactions: Vec<Vec3>,
    /// Largest force residual over the largest force.
    pub residual: f64,
    pub iterations: usize,
    pub factorisations: usize,
    /// Number of runs of each stage.
    pub ran: Counts,
}

/// Equilibrium under the loads and prescribed displacements at time `t`.
///
/// # Errors
///
/// A body that is free to move, no convergence, or an inverted element.
pub fn equilibrium(
    model: &SolidModel,
    t: f64,
    options: &EquilibriumOptions,
) -> Result<Equilibrium, SolidError> {
    equilibrium_over(model, Unknowns::new(model), t, options)
}

/// The same over given unknowns.
///
/// # Errors
///
/// See [`equilibrium`].
pub fn equilibrium_over(
    model: &SolidModel,
    unknowns: Unknowns,
    t: f64,
    options: &EquilibriumOptions,
) -> Result<Equilibrium, SolidError> {
    Ok(solve(Newton::new(model, unknowns, t, options))?.finish())
}

/// Equilibrium of a solid with a rigid cylinder.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactEquilibrium {
    pub solid: Equilibrium,
    pub sum: ContactSum,
    /// Contact nodes and the force on each, N.
    pub nodes: Vec<(ContactNode, Vec3)>,
}

/// Equilibrium under the loads, prescribed displacements and cylinder at time `t`, from the displacements `start` (m,
/// one for each node), or undeformed.
///
/// # Errors
///
/// See [`equilibrium`].
pub fn equilibrium_in_contact(
    model: &SolidModel,
    t: f64,
    contact: &CylinderContact,
    start: Option<&[Vec3]>,
    options: &EquilibriumOptions,
) -> Result<ContactEquilibrium, SolidError> {
    let mut newton = Newton::new(model, Unknowns::new(model), t, options);
    if let Some(start) = start {
        newton.displacement.copy_from_slice(start);
    }
    newton.contact = Some(contact);
    let newton = solve(newton)?;
    let sum = newton.sum;
    let nodes = newton.touching.iter().map(|touching| (touching.node, touching.force)).collect();
    Ok(ContactEquilibrium { solid: newton.finish(), sum, nodes })
}

fn solve(mut newton: Newton) -> Result<Newton, SolidError> {
    let options = newton.options;
    let (mut reached, mut step) = (0.0, 1.0);
    while reached < 1.0 {
        let wanted = f64::min(reached + step, 1.0);
        let before = newton.displacement.clone();
        let outcome = newton.converge(wanted).and_then(|()| newton.refuse_inverted());
        let Err(error) = outcome else {
            reached = wanted;
            continue;
        };
        newton.displacement = before;
        // Without memory, or with a part that is free to move, smaller steps do not help.
        match &error {
            SolidError::Factor(FactorError::NoMemory { .. }) => return Err(error),
            SolidError::Factor(_) => newton.refuse_free()?,
            _ => {}
        }
        if 0.5 * step < options.smallest_load_step {
            return Err(newton.with_cause(error, reached));
        }
        newton.stale = true;
        step *= 0.5;
    }
    Ok(newton)
}

/// A node under the cylinder.
struct Touching {
    node: ContactNode,
    force: Vec3,
    stiffness: Mat3,
}

struct Newton<'a> {
    model: &'a SolidModel,
    options: &'a EquilibriumOptions,
    t: f64,
    unknowns: Unknowns,
    matrix: SymmetricMatrix,
    factor: Option<Factor>,
    /// True if the factors are of another state than the last one solved for.
    stale: bool,
    /// True if the stiffness at rest has been factorised: no part is free to move.
    held: bool,
    /// Largest displacement by the first stiffness under the whole load, m.
    linear: Option<Placed>,
    displacement: Vec<Vec3>,
    external: Vec<[f64; 4]>,
    /// Fraction of the loads, and residuals of the unknowns, N.
    fraction: f64,
    right: Vec<f64>,
    contact: Option<&'a CylinderContact>,
    /// Contact nodes of the last evaluation.
    touching: Vec<Touching>,
    sum: ContactSum,
    residual: f64,
    iterations: usize,
    factorisations: usize,
    ran: Counts,
}

impl<'a> Newton<'a> {
    fn new(
        model: &'a SolidModel,
        unknowns: Unknowns,
        t: f64,
        options: &'a EquilibriumOptions,
    ) -> Self {
        let mut external = vec![[0.0; 4]; model.mass.len()];
        let mut ran = Counts::default();
        match options.gravity {
            MassMatrix::Consistent => model.add_static_forces(t, &mut external, &mut ran),
            MassMatrix::Lumped => {
                model.add_external_forces(model.acting(), t, &mut external, &mut ran);
            }
        }
        Newton {
            matrix: pattern(&model.problem, &unknowns),
            fraction: 0.0,
            right: vec![0.0; unknowns.count],
            unknowns,
            factor: None,
            stale: true,
            held: false,
            linear: None,
            displacement: vec![[0.0; 3]; model.mass.len()],
            external,
            contact: None,
            touching: Vec::new(),
            sum: ContactSum::default(),
            residual: f64::NAN,
            iterations: 0,
            factorisations: 0,
            ran,
            model,
            options,
            t,
        }
    }

    /// Forces may balance on an inverted element, which is an invalid state.
    fn refuse_inverted(&self) -> Result<(), SolidError> {
        first_inverted(self.model, &self.displacement).map_or(Ok(()), |(index, ratio)| {
            let at = centre(&self.model.problem, index);
            let element = self.model.labels.element(index);
            Err(StepFailure::Inverted { element, at, ratio }.into())
        })
    }

    /// Internal forces at the present displacements, N.
    fn internal(&mut self) -> Vec<[f64; 4]> {
        self.ran.add(Stage::Elements, self.model.problem.elements.len() as u64);
        let padded: Vec<_> = self.displacement.iter().map(|u| [u[0], u[1], u[2], 0.0]).collect();
        let mut forces = vec![[0.0; 4]; padded.len()];
        self.model.add_internal_forces(&padded, &mut forces);
        forces
    }

    /// Adds the forces of the cylinder at a fraction of its displacement, N. Returns whether the contact nodes have
    /// changed, and the rounding of the forces.
    fn add_contact(&mut self, fraction: f64, forces: &mut [[f64; 4]]) -> (bool, f64) {
        let Some(of) = self.contact else { return (false, 0.0) };
        let (cylinder, frame) = of.part_way(self.t, fraction);
        let displacement = &self.displacement;
        let mut found = Vec::new();
        let mut stiffest = 0.0f64;
        self.sum = contact(
            &cylinder,
            &frame,
            of.penalty,
            &of.nodes,
            |n| displacement[n as usize],
            |node, touch, stiffness, force| {
                for i in 0..3 {
                    forces[node.node as usize][i] += force[i];
                }
                stiffest = stiffest.max(stiffness);
                // The neglected penetration over radius is some 1e-7 where it matters.
                let stiffness = touch.normal_stiffness(stiffness);
                found.push(Touching { node: *node, force, stiffness });
            },
        );
        let same = found.len() == self.touching.len()
            && found.iter().zip(&self.touching).all(|(a, b)| a.node.node == b.node.node);
        self.touching = found;
        // A penetration is a difference of lengths of this size.
        let lengths = cylinder.radius + norm(frame.centre);
        (!same, 8.0 * f64::EPSILON * lengths * stiffest)
    }

    /// Newton iterations at a fraction of the load.
    fn converge(&mut self, fraction: f64) -> Result<(), SolidError> {
        self.fraction = fraction;
        for Prescribed { node, axis, profile } in &self.model.problem.prescribed {
            self.displacement[*node as usize][*axis] = fraction * profile.value(self.t);
        }
        let EquilibriumOptions { tolerance, rounding, most_iterations, .. } = *self.options;
        let options = Convergence { tolerance, rounding, most_iterations };
        let serves = |newton: &Newton| !newton.stale;
        let Unbalanced { largest, scale, .. } =
            converge(self, &options, Newton::balance, serves, Newton::refactor, Newton::step)?;
        self.residual = if scale > 0.0 { largest / scale } else { 0.0 };
        Ok(())
    }

    fn balance(&mut self) -> Result<Unbalanced, SolidError> {
        let mut internal = self.internal();
        let (changed, rounding) = self.add_contact(self.fraction, &mut internal);
        self.stale |= changed;
        let forces = [&internal[..], &self.external];
        let found = Unbalanced::of(&self.unknowns, forces, self.fraction, &mut self.right)?;
        Ok(Unbalanced { rounding, changed, ..found })
    }

    fn step(&mut self) {
        self.factor.as_ref().expect("factorised before").solve(&mut self.right);
        add_solution(&self.unknowns, &self.right, &mut self.displacement);
        self.iterations += 1;
        if self.linear.is_none() {
            let Placed { value, at } = farthest(self.model, &self.displacement);
            self.linear = Some(Placed { value: value / self.fraction, at });
        }
    }

    fn refactor(&mut self) -> Result<(), SolidError> {
        stiffness(self.model, &self.unknowns, &self.displacement, &mut self.matrix);
        for touching in &self.touching {
            let Touching { node, stiffness, .. } = touching;
            add_at_node(&self.unknowns, node.node, stiffness, &mut self.matrix);
        }
        match &mut self.factor {
            Some(factor) => factor.refactor(&self.matrix)?,
            None => self.factor = Some(self.unknowns.factor(&self.matrix)?),
        }
        self.held |= self.displacement.iter().all(|u| *u == [0.0; 3]);
        self.stale = false;
        self.factorisations += 1;
        Ok(())
    }

    /// Factorises the stiffness at rest, unless that has been done.
    fn refuse_free(&mut self) -> Result<(), SolidError> {
        if self.held {
            return Ok(());
        }
        let rest = vec![[0.0; 3]; self.displacement.len()];
        let before = std::mem::replace(&mut self.displacement, rest);
        let outcome = self.refactor();
        self.displacement = before;
        let SolidModel { problem, labels, .. } = self.model;
        outcome.map_err(|error| match error {
            SolidError::Factor(error) => at_rest(error, &problem.nodes, labels, &self.unknowns),
            other => other,
        })
    }

    /// Cause of the failure of the last step, from the displacements before it; at rest the body is valid.
    fn with_cause(&self, error: SolidError, reached: f64) -> SolidError {
        let SolidModel { problem, labels, .. } = self.model;
        let poisson_ratio = problem.material.poisson_ratio();
        match error {
            SolidError::Factor(FactorError::NotPositiveDefinite { pivot }) => {
                SolidError::TooLarge {
                    reached,
                    moved: farthest(self.model, &self.displacement).into(),
                    pivot: Pivot::of(&problem.nodes, labels, &self.unknowns, pivot).into(),
                    linear: self.linear.unwrap_or_default().into(),
                    size: size(self.model),
                    poisson_ratio,
                }
            }
            SolidError::Failed(failure) => {
                SolidError::Unbalanced { fraction: self.fraction, failure, poisson_ratio }
            }
            other => other,
        }
    }

    fn finish(mut self) -> Equilibrium {
        let mut internal = self.internal();
        for Touching { node, force, .. } in &self.touching {
            for i in 0..3 {
                internal[node.node as usize][i] += force[i];
            }
        }
        let reactions = (0..self.displacement.len())
            .map(|n| {
                [0, 1, 2].map(|i: usize| {
                    let held = self.unknowns.of[n][i] == PRESCRIBED;
                    if held { -internal[n][i] - self.external[n][i] } else { 0.0 }
                })
            })
            .collect();
        self.ran.add(Stage::Supports, self.unknowns.held() as u64);
        self.ran.add(Stage::SolidStatics, self.factorisations as u64);
        Equilibrium {
            ran: self.ran,
            reactions,
            displacement: self.displacement,
            residual: self.residual,
            iterations: self.iterations,
            factorisations: self.factorisations,
        }
    }
}
