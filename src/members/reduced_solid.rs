//! A flexible solid in component modes: natural modes and static correction modes.
//!
//! Displacements are u = Σ φ_k q_k. The modes are orthogonal in mass and stiffness and have a modal mass of 1 kg, so
//! that under forces f
//!
//! q̈_k + α q̇_k + ω_k² q_k = φ_kᵀ f,
//!
//! α the coefficient of (2.7) over the mass. `solids::reduction` computes the modes.

use crate::kinematics::vec3::Vec3;
use crate::numeric::profile::Profile;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::plan::SolidSteps;

/// Modes in the equations of motion; displacements of all nodes are kept elsewhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReducedSolid {
    /// Name in messages: "the housing".
    pub name: String,
    /// Natural frequencies ω, rad/s.
    pub frequencies: Vec<f64>,
    /// α, 1/s.
    pub damping: f64,
    /// Modal weight, N.
    pub weight: Vec<f64>,
    pub loads: Vec<ModalLoad>,
    /// Surfaces for housing fits.
    pub surfaces: Vec<Surface>,
    /// Modal coordinates at the start of a run, m.
    pub start: Vec<f64>,
}

/// Proportional forces on a solid, projected onto its modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalLoad {
    /// Modal forces, N at profile value 1.
    pub forces: Vec<f64>,
    pub profile: Profile,
}

/// Nodes with a normal each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    pub nodes: Vec<SurfaceNode>,
    /// Displacement along the normal per unit of each mode: all nodes of the first mode, of the second, …
    pub shapes: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceNode {
    /// Index in the mesh.
    pub node: u32,
    /// Undeformed position, m.
    pub place: Vec3,
    /// Outward normal of the race, inertial axes.
    pub normal: Vec3,
    /// Share of the surface, m².
    pub area: f64,
}

impl Surface {
    /// Displacement of each node along its normal (m) for modal coordinates (m).
    pub fn along_normals(&self, gone: &[f64], to: &mut [f64]) {
        to.fill(0.0);
        for (shape, gone) in self.shapes.chunks_exact(self.nodes.len()).zip(gone) {
            for (to, along) in to.iter_mut().zip(shape) {
                *to += gone * along;
            }
        }
    }

    /// The modes node by node: all modes at the first node, at the second, …
    pub fn by_node(&self) -> Vec<f64> {
        let (nodes, shapes) = (self.nodes.len(), self.shapes.len() / self.nodes.len().max(1));
        let at = |i: usize| self.shapes[(i % shapes) * nodes + i / shapes];
        (0..self.shapes.len()).map(at).collect()
    }

    /// Largest displacement along a normal per unit of each mode.
    pub fn largest(&self) -> impl Iterator<Item = f64> + '_ {
        let shapes = self.shapes.chunks_exact(self.nodes.len().max(1));
        shapes.map(|shape| shape.iter().fold(0.0f64, |most, along| most.max(along.abs())))
    }
}

/// Energy of a reduced solid, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModalEnergy {
    pub kinetic: f64,
    pub strain: f64,
    /// Energy of its weight.
    pub gravity: f64,
}

impl ReducedSolid {
    /// Number of modes.
    pub fn count(&self) -> usize {
        self.frequencies.len()
    }

    /// Modal accelerations under weight, loads, springs and damping at time `t`, for modal coordinates (m) and rates
    /// (m/s). Returns the power of damping and that of the loads, W.
    pub fn accelerations(
        &self,
        steps: SolidSteps,
        t: f64,
        [gone, speeds]: [&[f64]; 2],
        to: &mut [f64],
        ran: &mut Counts,
    ) -> [f64; 2] {
        let (mut damped, mut driven) = (0.0, 0.0);
        to.fill(0.0);
        if steps.gravity {
            to.copy_from_slice(&self.weight);
            ran.add(Stage::Gravity, 1);
        }
        for (k, to) in to.iter_mut().enumerate() {
            let frequency = self.frequencies[k];
            *to -= frequency * frequency * gone[k];
        }
        ran.add(Stage::Reduced, 1);
        if steps.damping {
            for (to, speed) in to.iter_mut().zip(speeds) {
                *to -= self.damping * speed;
                damped -= self.damping * speed * speed;
            }
            ran.add(Stage::Damping, 1);
        }
        let loads: &[ModalLoad] = if steps.loads { &self.loads } else { &[] };
        ran.add(Stage::Loads, loads.len() as u64);
        for load in loads {
            let factor = load.profile.value(t);
            for ((to, force), speed) in to.iter_mut().zip(&load.forces).zip(speeds) {
                *to += factor * force;
                driven += factor * force * speed;
            }
        }
        [damped, driven]
    }

    pub fn energy(&self, gone: &[f64], speeds: &[f64]) -> ModalEnergy {
        let mut energy = ModalEnergy::default();
        for (k, (gone, speed)) in gone.iter().zip(speeds).enumerate() {
            let spring = self.frequencies[k] * gone;
            energy.kinetic += 0.5 * speed * speed;
            energy.strain += 0.5 * spring * spring;
            energy.gravity -= self.weight[k] * gone;
        }
        energy
    }

    /// Modal coordinates under constant modal forces (N), m.
    pub fn rest(&self, forces: &[f64]) -> Vec<f64> {
        forces.iter().zip(&self.frequencies).map(|(force, w)| force / (w * w)).collect()
    }
}
