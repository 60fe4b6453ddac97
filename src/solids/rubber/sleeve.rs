//! Stiffness of a bonded bushing against each small rigid motion of its inner sleeve.

use crate::ch2_housing::elastomer::Elastomer;
use crate::kinematics::vec3::Vec3;
use crate::mesh::generate::Part;
use crate::mesh::{Elements, TetMesh};
use crate::numeric::profile::Profile;
use crate::solids::error::SolidError;
use crate::solids::model::Prescribed;
use crate::solids::rubber::harmonic::{ComplexStiffness, complex_stiffness};
use crate::solids::rubber::model::{RubberModel, RubberProblem, supports};

/// A motion of the inner sleeve of a bushing about the X axis; the outer one is fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SleeveMotion {
    /// Along Z; stiffness in N/m.
    Radial,
    /// Along X; stiffness in N/m.
    Axial,
    /// About X; stiffness in N·m/rad.
    Torsional,
    /// About Y through the middle of the bushing; stiffness in N·m/rad.
    Conical,
}

impl SleeveMotion {
    pub const ALL: [SleeveMotion; 4] =
        [SleeveMotion::Radial, SleeveMotion::Axial, SleeveMotion::Torsional, SleeveMotion::Conical];

    /// Displacement at a position (m) per unit of the motion, small angles.
    pub fn displacement(self, [x, y, z]: Vec3) -> Vec3 {
        match self {
            SleeveMotion::Radial => [0.0, 0.0, 1.0],
            SleeveMotion::Axial => [1.0, 0.0, 0.0],
            SleeveMotion::Torsional => [0.0, -z, y],
            SleeveMotion::Conical => [z, 0.0, -x],
        }
    }

    /// True for each of the planes X = 0 and Y = 0 whose reflection leaves the motion unchanged; otherwise it is
    /// reversed.
    fn is_even(self) -> [bool; 2] {
        match self {
            SleeveMotion::Radial => [true, true],
            SleeveMotion::Axial | SleeveMotion::Conical => [false, true],
            SleeveMotion::Torsional => [true, false],
        }
    }
}

/// Prescribed components of both sleeves of a mesh from [`bushing`](crate::mesh::generate::bushing), the inner one
/// moved by a unit, and of the planes of symmetry of a quarter.
pub fn sleeve_supports(mesh: &TetMesh, part: Part, motion: SleeveMotion) -> Vec<Prescribed> {
    const HELD: Option<Profile> = Some(Profile::ZERO);
    let set = |name: &str| mesh.node_sets.get(name).map(Vec::as_slice).unwrap_or_default();
    let mut prescribed = supports(mesh, &[("outer", [HELD; 3])]);
    let mut taken = vec![[false; 3]; mesh.nodes.len()];
    for Prescribed { node, axis, .. } in &prescribed {
        taken[*node as usize][*axis] = true;
    }
    let mut add = |node: u32, axis: usize, value: f64| {
        let of = &mut taken[node as usize][axis];
        if !*of {
            *of = true;
            prescribed.push(Prescribed { node, axis, profile: Profile::Constant(value) });
        }
    };
    for &node in set("inner") {
        let moved = motion.displacement(mesh.nodes[node as usize]);
        (0..3).for_each(|axis| add(node, axis, moved[axis]));
    }
    let planes = [(0, "x_low"), (1, "y_low")].into_iter().zip(motion.is_even());
    for ((normal, name), even) in planes.filter(|_| part == Part::Quarter) {
        for &node in set(name) {
            (0..3).filter(|axis| (*axis == normal) == even).for_each(|axis| add(node, axis, 0.0));
        }
    }
    prescribed
}

/// Stiffness of a whole bushing against a motion, at each of `pulsations` rad/s, as in [`complex_stiffness`]: N/m or
/// N·m/rad. The mesh is one of ten-node elements from [`bushing`](crate::mesh::generate::bushing), of the whole or a
/// quarter.
///
/// # Errors
///
/// Elements of four nodes; those of [`RubberModel::new`] and [`complex_stiffness`].
pub fn sleeve_stiffness(
    mesh: &TetMesh,
    part: Part,
    material: Elastomer,
    motion: SleeveMotion,
    pulsations: &[f64],
    tolerance: f64,
) -> Result<Vec<ComplexStiffness>, SolidError> {
    let Elements::Quadratic(elements) = &mesh.elements else { return Err(SolidError::FourNodes) };
    let model = RubberModel::new(RubberProblem {
        nodes: mesh.nodes.clone(),
        elements: elements.clone(),
        material,
        prescribed: sleeve_supports(mesh, part, motion),
        loads: Vec::new(),
    })?;
    let parts = if part == Part::Quarter { 4.0 } else { 1.0 };
    let mut found = complex_stiffness(&model, 0.0, pulsations, tolerance)?;
    for of in &mut found {
        (of.storage, of.loss) = (parts * of.storage, parts * of.loss);
    }
    Ok(found)
}
