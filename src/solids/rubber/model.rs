//! A solid of rubber as plain data, and its model with all constants.

use crate::ch2_housing::elastomer::Elastomer;
use crate::elements::tet10::{POINTS, Tet10, lumped_mass};
use crate::elements::tet10_nodal;
use crate::kinematics::vec3::Vec3;
use crate::mesh::TetMesh;
use crate::numeric::profile::Profile;
use crate::numeric::sparse::{FactorError, Ordering, SymmetricMatrix};
use crate::solids::error::{SolidError, at_rest};
use crate::solids::labels::Labels;
use crate::solids::model::{Load, Prescribed, add_loads, corners, take_prescribed};
use crate::solids::tangent::{Unknowns, pattern_over};

/// A solid of one rubber in ten-node elements, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct RubberProblem {
    /// Undeformed positions, m.
    pub nodes: Vec<Vec3>,
    pub elements: Vec<[u32; 10]>,
    pub material: Elastomer,
    /// Fixed or moved displacement components.
    pub prescribed: Vec<Prescribed>,
    pub loads: Vec<Load>,
}

/// A problem with all constants.
#[derive(Clone, Debug)]
pub struct RubberModel {
    pub problem: RubberProblem,
    pub tets: Vec<Tet10>,
    /// Patches for the averaged volume: one around each corner node.
    pub patches: Vec<Patch>,
    /// The patches at the corners of each element.
    pub patches_of: Vec<[u32; 4]>,
    pub unknowns: Unknowns,
    /// kg, one for each node; empty without inertia.
    pub mass: Vec<f64>,
}

/// Time of loads and prescribed displacements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// s.
    pub time: f64,
    /// Fraction of the jumps at that time: 1 is all.
    pub share: f64,
}

impl Moment {
    /// With all jumps at that time.
    pub fn at(time: f64) -> Moment {
        Moment { time, share: 1.0 }
    }

    fn value(&self, profile: &Profile) -> f64 {
        let after = profile.value(self.time);
        if self.share == 1.0 {
            return after;
        }
        let before = before(profile, self.time);
        before + self.share * (after - before)
    }
}

/// Value of a profile just before a time; zero before t = 0.
fn before(profile: &Profile, t: f64) -> f64 {
    if t > 0.0 { profile.value(t.next_down()) } else { 0.0 }
}

/// The elements around a corner node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// Element and index of its corner.
    pub elements: Vec<(u32, u8)>,
    /// Their nodes, ascending.
    pub nodes: Vec<u32>,
    /// Undeformed, m³.
    pub volume: f64,
}

impl RubberModel {
    /// # Errors
    ///
    /// Invalid material constants, a folded element, a node or axis out of range, a component prescribed twice.
    pub fn new(problem: RubberProblem) -> Result<RubberModel, SolidError> {
        problem.material.check()?;
        let count = problem.nodes.len();
        let mut tets = Vec::with_capacity(problem.elements.len());
        for (index, element) in problem.elements.iter().enumerate() {
            if let Some(&node) = element.iter().find(|node| **node as usize >= count) {
                return Err(SolidError::NoSuchNode { node, count });
            }
            let tet = Tet10::new(&corners(&problem.nodes, element)).map_err(|source| {
                let (element, at) = (index as u64 + 1, centre(&problem, index));
                SolidError::Element { element, at, source }
            })?;
            tets.push(tet);
        }
        RubberModel::of_elements(problem, tets, None)
    }

    /// From existing elements, with other patches than those around corner nodes if given.
    ///
    /// # Errors
    ///
    /// A node or axis out of range, a component prescribed twice.
    pub(crate) fn of_elements(
        problem: RubberProblem,
        tets: Vec<Tet10>,
        averaged: Option<(Vec<Patch>, Vec<[u32; 4]>)>,
    ) -> Result<RubberModel, SolidError> {
        let count = problem.nodes.len();
        let mut free = vec![[false; 3]; count];
        for node in problem.elements.as_flattened() {
            free[*node as usize] = [true; 3];
        }
        take_prescribed(&problem.prescribed, &problem.loads, &mut free)?;
        let (patches, patches_of) = averaged.unwrap_or_else(|| patches(&problem, &tets));
        let unknowns = Unknowns::over(&problem.nodes, lists(&patches), &free, Ordering::Cheapest);
        Ok(RubberModel { problem, tets, patches, patches_of, unknowns, mass: Vec::new() })
    }

    /// The same with the mass of rubber of `density` kg/m³, lumped.
    #[must_use]
    pub fn with_inertia(mut self, density: f64) -> RubberModel {
        self.mass = vec![0.0; self.problem.nodes.len()];
        for element in &self.problem.elements {
            let shares = lumped_mass(&corners(&self.problem.nodes, element), density);
            for (node, share) in element.iter().zip(shares) {
                self.mass[*node as usize] += share;
            }
        }
        self
    }

    /// Error of a factorisation of the stiffness at rest.
    pub(crate) fn at_rest(&self, error: FactorError) -> SolidError {
        at_rest(error, &self.problem.nodes, &Labels::default(), &self.unknowns)
    }

    /// An empty stiffness over the unknowns.
    pub fn pattern(&self) -> SymmetricMatrix {
        pattern_over(self.problem.nodes.len(), lists(&self.patches), &self.unknowns)
    }

    /// Returns whether a load or a prescribed displacement jumps at time `t`.
    pub fn jumps(&self, t: f64) -> bool {
        self.profiles().any(|profile| {
            let (before, after) = (before(profile, t), profile.value(t));
            // A continuous profile differs by rounding of its argument.
            (after - before).abs() > 1e-9 * (after.abs() + before.abs())
        })
    }

    fn profiles(&self) -> impl Iterator<Item = &Profile> {
        let moved = self.problem.prescribed.iter().map(|prescribed| &prescribed.profile);
        moved.chain(self.problem.loads.iter().map(|load| &load.profile))
    }

    /// Sets the prescribed components of a displacement to their values at a moment.
    pub fn prescribe(&self, at: Moment, displacement: &mut [Vec3]) {
        for Prescribed { node, axis, profile } in &self.problem.prescribed {
            displacement[*node as usize][*axis] = at.value(profile);
        }
    }

    /// Adds the loads at a moment, N.
    pub fn add_loads(&self, at: Moment, forces: &mut [Vec3]) {
        add_loads(&self.problem.loads, |profile| at.value(profile), forces);
    }

    /// Times at which a prescribed displacement or a load changes its slope, ascending.
    pub fn corners(&self) -> Vec<f64> {
        let mut corners: Vec<f64> = self.profiles().flat_map(|profile| profile.corners()).collect();
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        corners
    }
}

/// Prescribed components from node sets of a mesh, `None` for free ones. A component in several sets takes the value of
/// the first. Missing sets have no nodes.
pub fn supports(mesh: &TetMesh, sets: &[(&str, [Option<Profile>; 3])]) -> Vec<Prescribed> {
    let mut taken = vec![[false; 3]; mesh.nodes.len()];
    let mut prescribed = Vec::new();
    for (name, components) in sets {
        for &node in mesh.node_sets.get(*name).into_iter().flatten() {
            for (axis, profile) in components.iter().enumerate() {
                let Some(profile) = profile else { continue };
                if !taken[node as usize][axis] {
                    taken[node as usize][axis] = true;
                    prescribed.push(Prescribed { node, axis, profile: profile.clone() });
                }
            }
        }
    }
    prescribed
}

/// A patch for each corner node, in the order of the nodes.
fn patches(problem: &RubberProblem, tets: &[Tet10]) -> (Vec<Patch>, Vec<[u32; 4]>) {
    let mut index = vec![u32::MAX; problem.nodes.len()];
    for node in problem.elements.iter().flat_map(|element| &element[..4]) {
        index[*node as usize] = 0;
    }
    let mut count = 0;
    for of in index.iter_mut().filter(|of| **of == 0) {
        *of = count;
        count += 1;
    }
    let mut patches = vec![Patch::default(); count as usize];
    let mut patches_of = Vec::with_capacity(tets.len());
    for (element, (nodes, tet)) in (0u32..).zip(problem.elements.iter().zip(tets)) {
        let volumes = tet10_nodal::at_corners(tet, &[1.0; POINTS]);
        let of = [0, 1, 2, 3].map(|corner: usize| index[nodes[corner] as usize]);
        for (corner, (patch, volume)) in (0u8..).zip(of.into_iter().zip(volumes)) {
            let patch = &mut patches[patch as usize];
            patch.elements.push((element, corner));
            patch.volume += volume;
        }
        patches_of.push(of);
    }
    // The last patch with this node: most nodes come several times.
    let mut taken_by = vec![u32::MAX; problem.nodes.len()];
    for (patch, of) in (0u32..).zip(&mut patches) {
        for &node in
            of.elements.iter().flat_map(|(element, _)| &problem.elements[*element as usize])
        {
            if taken_by[node as usize] != patch {
                taken_by[node as usize] = patch;
                of.nodes.push(node);
            }
        }
        of.nodes.sort_unstable();
    }
    (patches, patches_of)
}

fn lists(patches: &[Patch]) -> impl Iterator<Item = &[u32]> + Clone {
    patches.iter().map(|patch| patch.nodes.as_slice())
}

/// The mean of an element's undeformed corners, m.
pub fn centre(problem: &RubberProblem, element: usize) -> Vec3 {
    let nodes = &problem.elements[element][..4];
    [0, 1, 2].map(|i: usize| {
        nodes.iter().map(|n| problem.nodes.get(*n as usize).map_or(0.0, |x| 0.25 * x[i])).sum()
    })
}
