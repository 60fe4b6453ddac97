//! A rigid cylinder pressed on a block (2.3.2), at rest and by explicit steps; what the cases of line
//! contact share.
//!
//! The cylinder's axis is X, along the block's depth; it moves down Z onto the top at z = 0.

use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, Penalty, contact_nodes};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::strain::von_mises;
use bearing_dynamics::mesh::generate::{block, graded, uniform};
use bearing_dynamics::mesh::{MeshError, Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::contact::{CylinderContact, CylinderPath};
use bearing_dynamics::solids::error::SolidError;
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::stress::nodal_stresses;
use nalgebra::{Matrix4, UnitQuaternion, Vector3, Vector4};

use crate::solids::{Material, Vec3, free_body, mesh_of, prescribe};

/// What the faces square to the cylinder's axis may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthFaces {
    /// Both stay in their planes: plane strain.
    Held,
    /// One stays in its plane (the middle of the body), the other is free: a slab.
    Free,
}

/// A block, lengths in m.
#[derive(Clone, Copy, Debug)]
pub struct BlockShape {
    pub order: Order,
    /// Meshed is the half at y ≥ 0, its plane of symmetry held, or the whole.
    pub halved: bool,
    /// Half of the width, along Y.
    pub half_width: f64,
    pub height: f64,
    /// Depth as meshed: half of the body's with a free face.
    pub depth: f64,
    pub depth_cells: usize,
    pub faces: DepthFaces,
    /// The fine zone reaches this far along Y, and down.
    pub fine_reach: f64,
    /// Size of its cells, and their growth outside.
    pub cell: f64,
    pub growth: f64,
}

pub struct PressedBlock {
    pub shape: BlockShape,
    pub mesh: TetMesh,
    pub model: SolidModel,
    pub nodes: Vec<ContactNode>,
}

/// The block on a rigid base, at rest.
pub fn pressed_block(
    shape: &BlockShape,
    material: Material,
    damping: f64,
) -> Result<PressedBlock, BlockError> {
    let fine = |reach: f64| uniform(0.0, reach, (reach / shape.cell).round() as usize);
    let beyond = |to: f64| graded(shape.fine_reach, to, shape.cell * shape.growth, shape.growth);
    let onwards = |to: f64| -> Result<Vec<f64>, MeshError> {
        let mut all = fine(shape.fine_reach);
        all.extend(&beyond(to)?[1..]);
        Ok(all)
    };
    let mut y = onwards(shape.half_width)?;
    if !shape.halved {
        let mirrored: Vec<f64> = y[1..].iter().rev().map(|y| -y).collect();
        y = [mirrored, y].concat();
    }
    let z: Vec<f64> = onwards(shape.height)?.into_iter().rev().map(|z| -z).collect();
    let solid = block([&uniform(0.0, shape.depth, shape.depth_cells), &y, &z])?;
    let mesh = mesh_of(&solid, shape.order)?;
    let mut problem = free_body(&mesh, material);
    problem.damping = damping;
    let small = 1e-6 * shape.cell;
    let end = shape.depth - small;
    prescribe(&mut problem, |[x, y, z]| {
        let bottom = z < small - shape.height;
        let face = x < small || (x > end && shape.faces == DepthFaces::Held);
        let held = |yes: bool| yes.then_some(0.0);
        [held(bottom || face), held(bottom || (shape.halved && y < small)), held(bottom)]
    });
    let nodes = contact_nodes(&mesh, mesh.surface_set("z_high")?);
    Ok(PressedBlock { model: SolidModel::new(problem)?, mesh, nodes, shape: *shape })
}

#[derive(Debug, thiserror::Error)]
pub enum BlockError {
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    Solid(#[from] SolidError),
}

impl PressedBlock {
    /// A cylinder that just touches, and then goes down by `indentation` (m, over time).
    pub fn cylinder(
        &self,
        radius: f64,
        penalty: Penalty,
        indentation: impl Fn(f64) -> Profile,
    ) -> CylinderContact {
        let start = Pose {
            position: Vector3::new(0.0, 0.0, radius),
            orientation: UnitQuaternion::identity(),
        };
        let path = CylinderPath {
            start,
            displacement: [Profile::ZERO, Profile::ZERO, indentation(-1.0)],
            radius: Profile::Constant(radius),
        };
        // Wider than any depth in use: faces that bulge stay under it.
        CylinderContact { path, width: 0.1, penalty, nodes: self.nodes.clone() }
    }

    /// Von Mises stress over depth (m, Pa) within `across` of the plane of symmetry, mean of the nodes
    /// at each depth down to `below`.
    pub fn von_mises_below(&self, displacement: &[Vec3], across: f64, below: f64) -> Vec<[f64; 2]> {
        let stress = nodal_stresses(&self.model, displacement);
        let mut by_depth: Vec<[f64; 3]> = Vec::new();
        for (place, stress) in self.mesh.nodes.iter().zip(&stress) {
            let depth = -place[2];
            if place[1].abs() > across || depth > below {
                continue;
            }
            match by_depth.iter_mut().find(|entry| (entry[0] - depth).abs() <= 1e-9) {
                Some(entry) => {
                    entry[1] += von_mises(stress);
                    entry[2] += 1.0;
                }
                None => by_depth.push([depth, von_mises(stress), 1.0]),
            }
        }
        by_depth.sort_by(|a, b| a[0].total_cmp(&b[0]));
        by_depth.iter().map(|e| [e[0], e[1] / e[2]]).collect()
    }
}

/// Place and height of a curve's crest: of the cubic through its points from `low` to `high` by least
/// squares. One point's error hardly moves it, as it does a parabola through three.
pub fn crest(curve: &[[f64; 2]], [low, high]: [f64; 2]) -> [f64; 2] {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let powers = |x: f64| {
        let s = (x - middle) / half;
        Vector4::new(1.0, s, s * s, s * s * s)
    };
    let (mut matrix, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for [x, y] in curve.iter().filter(|p| p[0] >= low && p[0] <= high) {
        let row = powers(*x);
        matrix += row * row.transpose();
        right += *y * row;
    }
    let Some(inverse) = matrix.try_inverse() else { return [f64::NAN; 2] };
    let c = inverse * right;
    // Of the two places without slope the one that bends down: c₁ + 2 c₂ s + 3 c₃ s² = 0.
    let root = (c[2] * c[2] - 3.0 * c[1] * c[3]).sqrt();
    let at = middle + half * c[1] / (root - c[2]);
    [at, c.dot(&powers(at))]
}

/// What a pressed line shows, SI; the load and pressures are those of the whole body.
#[derive(Clone, Debug)]
pub struct LineContact {
    /// Load per depth, N/m.
    pub load: f64,
    /// Pressure over y ≥ 0, mean over the depth: nodal forces over nodal areas.
    pub profile: Vec<[f64; 2]>,
    /// Where the share of the surface of each of these nodes begins and ends. The shares lie side by
    /// side from y = 0 on.
    pub shares: Vec<[f64; 2]>,
    /// Largest of the profile.
    pub peak: f64,
    /// Where p² falls to zero, by a straight line through p² over y² down to a tenth of its peak.
    pub half_width: f64,
}

/// Reads the nodal forces of a block.
pub fn line_contact(block: &PressedBlock, forces: &[(ContactNode, Vec3)]) -> LineContact {
    let whole = if block.shape.halved { 2.0 } else { 1.0 };
    let load: f64 = forces.iter().map(|(_, force)| -whole * force[2] / block.shape.depth).sum();
    let mut rows: Vec<[f64; 3]> = Vec::new();
    let mut add = |y: f64, force: f64, area: f64| match rows
        .iter_mut()
        .find(|row| (row[0] - y).abs() <= 1e-9)
    {
        Some(row) => {
            row[1] += force;
            row[2] += area;
        }
        None => rows.push([y, force, area]),
    };
    for node in &block.nodes {
        let force = forces.iter().find(|(touching, _)| touching.node == node.node);
        add(node.place[1].abs(), force.map_or(0.0, |(_, force)| -force[2]), node.area);
    }
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let profile: Vec<[f64; 2]> = rows.iter().map(|row| [row[0], row[1] / row[2]]).collect();
    let mut end = 0.0;
    let shares = rows.iter().map(|row| {
        let begin = end;
        end += 0.5 * whole * row[2] / block.shape.depth;
        [begin, end]
    });
    let shares = shares.collect();
    let peak = profile.iter().fold(0.0, |most, p| f64::max(most, p[1]));
    let squares = profile.iter().filter(|p| p[1] * p[1] >= 0.1 * peak * peak);
    let [n, x, y, xx, xy] = squares.fold([0.0; 5], |[n, x, y, xx, xy], p| {
        let (a, b) = (p[0] * p[0], p[1] * p[1]);
        [n + 1.0, x + a, y + b, xx + a * a, xy + a * b]
    });
    let slope = (n * xy - x * y) / (n * xx - x * x);
    let half_width = ((x - y / slope) / n).sqrt();
    LineContact { load, profile, shares, peak, half_width }
}
