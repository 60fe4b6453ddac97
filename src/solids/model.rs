//! A flexible solid as plain data, and its model with all constants.

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::elements::tet4::Tet4;
use crate::elements::tet10::{self, Tet10};
use crate::kinematics::vec3::Vec3;
use crate::mesh::tet_mesh::Elements;
use crate::numeric::profile::Profile;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::error::SolidError;
use crate::solids::labels::Labels;
use crate::solids::plan::{Method, SolidSteps};
use crate::solids::tet4_blocks::Node;
use crate::solids::{tet4_blocks, tet10_blocks};

/// Damped part of the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DampedMotion {
    /// All motion (2.7).
    #[default]
    Absolute,
    /// Motion relative to the body's own mean translation and rotation, for a rotating body.
    RelativeToRigid,
}

/// Proportional forces on nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Node, force in N at profile value 1.
    pub forces: Vec<(u32, Vec3)>,
    pub profile: Profile,
}

/// A prescribed displacement component.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    pub node: u32,
    /// 0, 1 or 2 for X, Y, Z.
    pub axis: usize,
    /// Displacement over time, m.
    pub profile: Profile,
}

/// A solid of one material, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidProblem {
    /// Undeformed positions, m.
    pub nodes: Vec<Vec3>,
    pub elements: Elements,
    pub material: LinearElastic,
    /// kg/m³.
    pub density: f64,
    /// Damping force per mass and velocity, 1/s: the coefficient of (2.7) divided by the mass.
    pub damping: f64,
    pub damped_motion: DampedMotion,
    /// Fixed or moved displacement components.
    pub prescribed: Vec<Prescribed>,
    pub loads: Vec<Load>,
    /// m/s².
    pub gravity: Vec3,
}

/// Elements in the blocks of the force loop.
#[derive(Clone, Debug, PartialEq)]
pub enum Blocks {
    Linear(Vec<tet4_blocks::Block>),
    Quadratic(Vec<tet10_blocks::Block>),
}

/// A problem with all constants.
#[derive(Clone, Debug)]
pub struct SolidModel {
    pub problem: SolidProblem,
    /// Numbers of elements and nodes in messages.
    pub labels: Labels,
    pub blocks: Blocks,
    /// Lumped mass of each node, kg.
    pub mass: Vec<f64>,
    /// Reciprocal of the mass by component; zero where the displacement is prescribed.
    pub per_mass: Vec<Node>,
}

/// Takes the prescribed components from the free ones of each node, and checks the nodes of the loads.
pub(crate) fn take_prescribed(
    prescribed: &[Prescribed],
    loads: &[Load],
    free: &mut [[bool; 3]],
) -> Result<(), SolidError> {
    let count = free.len();
    for &Prescribed { node, axis, .. } in prescribed {
        let of = free.get_mut(node as usize).ok_or(SolidError::NoSuchNode { node, count })?;
        let of = of.get_mut(axis).ok_or(SolidError::NoSuchAxis { node, axis })?;
        if !std::mem::take(of) {
            return Err(SolidError::PrescribedTwice { node, axis });
        }
    }
    let mut nodes = loads.iter().flat_map(|load| &load.forces).map(|(node, _)| *node);
    let missing = nodes.find(|node| *node as usize >= count);
    missing.map_or(Ok(()), |node| Err(SolidError::NoSuchNode { node, count }))
}

/// Adds loads, each at the factor of its profile, N.
pub(crate) fn add_loads<const N: usize>(
    loads: &[Load],
    factor: impl Fn(&Profile) -> f64,
    forces: &mut [[f64; N]],
) {
    for load in loads {
        let factor = factor(&load.profile);
        for (node, force) in &load.forces {
            for i in 0..3 {
                forces[*node as usize][i] += factor * force[i];
            }
        }
    }
}

/// The undeformed corners of an element.
pub fn corners<const N: usize>(nodes: &[Vec3], element: &[u32; N]) -> [Vec3; N] {
    element.map(|node| nodes[node as usize])
}

/// The mean of an element's undeformed corners, m.
pub fn centre(problem: &SolidProblem, element: usize) -> Vec3 {
    let nodes = problem.elements.corners(element);
    [0, 1, 2].map(|i: usize| nodes.iter().map(|n| 0.25 * problem.nodes[*n as usize][i]).sum())
}

impl SolidModel {
    /// # Errors
    /// An element of no volume, a node without mass, a node or axis out of range, a component
    /// prescribed twice, a material constant out of range.
    pub fn new(problem: SolidProblem) -> Result<SolidModel, SolidError> {
        SolidModel::labelled(problem, Labels::default())
    }

    /// As [`SolidModel::new`], with numbers for elements and nodes.
    ///
    /// # Errors
    ///
    /// The same.
    pub fn labelled(problem: SolidProblem, labels: Labels) -> Result<SolidModel, SolidError> {
        if !(problem.density > 0.0 && problem.density.is_finite()) {
            return Err(SolidError::Density(problem.density));
        }
        if !(problem.damping >= 0.0 && problem.damping.is_finite()) {
            return Err(SolidError::Damping(problem.damping));
        }
        let nodes = &problem.nodes;
        let count = nodes.len();
        if let Some(&node) = problem.elements.all_nodes().iter().find(|n| **n as usize >= count) {
            return Err(SolidError::NoSuchNode { node, count });
        }
        let mut mass = vec![0.0; count];
        let at = |index: usize| {
            let (element, at) = (labels.element(index), centre(&problem, index));
            move |source| SolidError::Element { element, at, source }
        };
        let blocks = match &problem.elements {
            Elements::Linear(list) => {
                let mut built = Vec::with_capacity(list.len());
                for (index, element) in list.iter().enumerate() {
                    let tet = Tet4::new(&corners(nodes, element)).map_err(at(index))?;
                    for node in element {
                        mass[*node as usize] += tet.nodal_mass(problem.density);
                    }
                    built.push((tet, *element));
                }
                Blocks::Linear(tet4_blocks::blocks(built.into_iter()))
            }
            Elements::Quadratic(list) => {
                let mut built = Vec::with_capacity(list.len());
                for (index, element) in list.iter().enumerate() {
                    let places = corners(nodes, element);
                    let tet = Tet10::new(&places).map_err(at(index))?;
                    let shares = tet10::lumped_mass(&places, problem.density);
                    for (node, share) in element.iter().zip(shares) {
                        mass[*node as usize] += share;
                    }
                    built.push((tet, *element));
                }
                Blocks::Quadratic(tet10_blocks::blocks(built.into_iter()))
            }
        };
        if let Some(node) = mass.iter().position(|m| *m == 0.0) {
            return Err(SolidError::NoMass { node: labels.node(node) });
        }
        let mut free = vec![[true; 3]; count];
        take_prescribed(&problem.prescribed, &problem.loads, &mut free)?;
        let of = |(m, free): (&f64, &[bool; 3])| {
            let [x, y, z] = free.map(|free| if free { 1.0 / m } else { 0.0 });
            [x, y, z, 0.0]
        };
        let per_mass = mass.iter().zip(&free).map(of).collect();
        Ok(SolidModel { problem, labels, blocks, mass, per_mass })
    }

    /// A value at a node that is not finite.
    pub fn not_finite(&self, node: usize, time: f64, step: u64) -> SolidError {
        let at = self.problem.nodes[node];
        SolidError::NotFinite { node: self.labels.node(node), at, time, step }
    }

    /// An inverted element, with its volume ratio.
    pub fn inverted(&self, element: usize, ratio: f64, time: f64, step: u64) -> SolidError {
        let at = centre(&self.problem, element);
        SolidError::Inverted { element: self.labels.element(element), at, ratio, time, step }
    }

    /// Adds the forces of all elements on the nodes, N.
    pub fn add_internal_forces(&self, displacement: &[Node], forces: &mut [Node]) {
        let material = self.problem.material;
        match &self.blocks {
            Blocks::Linear(blocks) => {
                tet4_blocks::add_forces(blocks, material, displacement, forces);
            }
            Blocks::Quadratic(blocks) => {
                tet10_blocks::add_forces(blocks, material, displacement, forces);
            }
        }
    }

    /// Adds loads and gravity at time `t`, N, gravity by the lumped masses: all nodes of a free body then have the same
    /// acceleration.
    pub fn add_external_forces(
        &self,
        steps: SolidSteps,
        t: f64,
        forces: &mut [Node],
        ran: &mut Counts,
    ) {
        self.add_loads(steps, t, forces, ran);
        if steps.gravity {
            self.add_gravity(forces, self.mass.iter().copied().enumerate(), ran);
        }
    }

    /// Adds loads and gravity at time `t`, N, gravity as ∫Nρg dV, as equilibrium requires. For four-node elements this
    /// is the same as by lumped masses. For ten-node elements lumped masses are positive everywhere, as explicit steps
    /// require, but as a load they would cost an order of convergence; the consistent load acts upwards at corners.
    pub fn add_static_forces(&self, t: f64, forces: &mut [Node], ran: &mut Counts) {
        let steps = self.acting();
        self.add_loads(steps, t, forces, ran);
        if steps.gravity {
            self.add_weight(forces, ran);
        }
    }

    /// Part of gravity in [`SolidModel::add_static_forces`], N.
    pub fn add_weight(&self, forces: &mut [Node], ran: &mut Counts) {
        match &self.problem.elements {
            Elements::Linear(_) => {
                self.add_gravity(forces, self.mass.iter().copied().enumerate(), ran);
            }
            Elements::Quadratic(list) => {
                for element in list {
                    let shares = tet10::consistent_mass(
                        &corners(&self.problem.nodes, element),
                        self.problem.density,
                    );
                    let sums = shares.map(|row| row.iter().sum());
                    self.add_gravity(forces, element.iter().map(|n| *n as usize).zip(sums), ran);
                }
            }
        }
    }

    /// Planned loads and damping.
    pub fn acting(&self) -> SolidSteps {
        SolidSteps::new(&self.problem, &Method::Explicit)
    }

    fn add_loads(&self, steps: SolidSteps, t: f64, forces: &mut [Node], ran: &mut Counts) {
        if !steps.loads {
            return;
        }
        ran.add(Stage::Loads, self.problem.loads.len() as u64);
        add_loads(&self.problem.loads, |profile| profile.value(t), forces);
    }

    /// Weight of masses at nodes.
    fn add_gravity(
        &self,
        forces: &mut [Node],
        masses: impl Iterator<Item = (usize, f64)>,
        ran: &mut Counts,
    ) {
        ran.add(Stage::Gravity, 1);
        let gravity = self.problem.gravity;
        for (node, mass) in masses {
            for i in 0..3 {
                forces[node][i] += mass * gravity[i];
            }
        }
    }

    /// The same element by element with the scalar law: oracle of the blocks.
    pub fn add_internal_forces_plain(&self, displacement: &[Node], forces: &mut [Node]) {
        let material = self.problem.material;
        let law = |strain: &_| material.second_piola_kirchhoff(strain);
        let vector = |node: u32| {
            let u = displacement[node as usize];
            [u[0], u[1], u[2]]
        };
        let nodes = &self.problem.nodes;
        let mut add = |node: u32, force: Vec3| {
            for i in 0..3 {
                forces[node as usize][i] += force[i];
            }
        };
        let sound = "elements were checked when the model was made";
        match &self.problem.elements {
            Elements::Linear(list) => {
                for element in list {
                    let tet = Tet4::new(&corners(nodes, element)).expect(sound);
                    let of = tet
                        .nodal_forces(&crate::elements::tet4::relative(&element.map(vector)), law);
                    for n in 0..3 {
                        add(element[n], of[n]);
                    }
                    let last = [0, 1, 2].map(|i: usize| -(of[0][i] + of[1][i] + of[2][i]));
                    add(element[3], last);
                }
            }
            Elements::Quadratic(list) => {
                for element in list {
                    let tet = Tet10::new(&corners(nodes, element)).expect(sound);
                    let of = tet.nodal_forces(&element.map(vector), law);
                    for n in 0..10 {
                        add(element[n], of[n]);
                    }
                }
            }
        }
    }
}
