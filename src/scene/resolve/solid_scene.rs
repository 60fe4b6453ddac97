//! A resolved scene with a flexible solid alone: SI units, defaults filled in, its mesh not read.

use crate::ch2_housing::elastomer::Elastomer;
use crate::mesh::generate::{
    Bushing, BushingMesh, Cage, CageMesh, ContactBlock, Housing, HousingMesh, Part, Ring, RingMesh,
};
use crate::mesh::read::LengthUnit;
use crate::mesh::{Order, Surface};
use crate::numeric::profile::Profile;
use crate::scene::build::assembly::AssemblyScene;
use crate::scene::resolve::resolved::{Assumption, DefaultUsed};
use crate::solids::explicit::{ExplicitMethod, SolidStepping};
use crate::solids::model::DampedMotion;
use crate::solids::rubber::steps::Stepping;
use crate::solids::tangent::MassMatrix;
use std::path::PathBuf;

/// Subject of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// Bearings, with or without bodies and housings.
    Assembly(Box<AssemblyScene>),
    /// A solid alone.
    Solid(Box<SolidScene>),
}

/// Source of the mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshSource {
    File {
        /// As in the scene, and relative to the folder of the command.
        name: String,
        path: PathBuf,
        unit: LengthUnit,
    },
    /// Sizes along X, Y, Z and cells.
    Bar {
        size: [f64; 3],
        cells: [usize; 3],
    },
    Block(ContactBlock),
    Ring(Ring, RingMesh),
    Shaft {
        radius: f64,
        stations: Vec<f64>,
        longest_layer: f64,
        around: usize,
        radial: usize,
    },
    Cage(Cage, CageMesh),
    Housing(Housing, HousingMesh),
    Bushing(Bushing, BushingMesh),
}

/// Position of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshPlace {
    /// Point of the mesh's own coordinates that is moved onto the axis X, m.
    pub origin: [f64; 3],
    /// Axis of the mesh that becomes X: 0, 1 or 2; the others follow in their order.
    pub axis: usize,
    /// Position of that point on X, m.
    pub at: f64,
}

impl MeshPlace {
    /// Moves nodes; those of a mesh that is not moved keep their bits.
    pub fn put(&self, nodes: &mut [[f64; 3]]) {
        if *self == MeshPlace::default() {
            return;
        }
        for node in nodes {
            let from: [f64; 3] = std::array::from_fn(|i| node[i] - self.origin[i]);
            *node = std::array::from_fn(|i| from[(i + self.axis) % 3]);
            node[0] += self.at;
        }
    }
}

/// The mesh of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshRequest {
    pub source: MeshSource,
    pub place: MeshPlace,
    /// `None`: as in the file.
    pub order: Option<Order>,
    pub renumber: bool,
    /// Repairs of a file's mesh. Duplicates are joined within the distance that finds them.
    pub orient: bool,
    pub merge_duplicates: bool,
    pub drop_unreferenced: bool,
    pub cavities: usize,
    pub largest_aspect: f64,
    pub sets: Vec<SetRequest>,
    /// Names of sets in supports, loads, probes and vibrations.
    pub used_sets: Vec<String>,
}

impl MeshRequest {
    /// Returns whether forces, stiffness and energies are a quarter of those of the whole.
    pub fn is_quarter(&self) -> bool {
        matches!(&self.source, MeshSource::Bushing(_, cells) if cells.part == Part::Quarter)
    }
}

/// A set by geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct SetRequest {
    pub name: String,
    pub place: SetPlace,
    /// m; `None` for a fraction of the mesh's size.
    pub tolerance: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SetPlace {
    Surface(Surface),
    Box { low: [f64; 3], high: [f64; 3] },
}

/// A set that is fixed or moved along some axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    pub set: String,
    /// m.
    pub motion: [Option<Profile>; 3],
}

#[derive(Clone, Debug, PartialEq)]
pub struct SetLoad {
    pub set: String,
    pub kind: LoadKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum LoadKind {
    /// Total force along each axis, N.
    Force([Option<Profile>; 3]),
    /// Pa, into the body.
    Pressure(Profile),
}

/// A set or position whose mean displacement is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    pub name: String,
    pub of: ProbeOf,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ProbeOf {
    Set(String),
    /// The node nearest to this position, m.
    Place([f64; 3]),
}

/// Integration of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRun {
    pub steps: RunSteps,
    /// s.
    pub end: f64,
    /// Time from one row to the next and from one file of fields to the next, s.
    pub output_interval: f64,
    pub fields_interval: f64,
}

/// Steps of a run: with inertia, or from equilibrium to equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunSteps {
    Explicit {
        method: ExplicitMethod,
        stepping: SolidStepping,
        /// Largest energy residual over the energy turned over.
        energy_limit: f64,
    },
    Implicit(Stepping),
}

/// Material of a solid.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Young's modulus in Pa.
    LinearElastic {
        youngs_modulus: f64,
        poisson_ratio: f64,
    },
    Elastomer(Box<RubberScene>),
}

/// A rubber, and outputs of solids of rubber only.
#[derive(Clone, Debug, PartialEq)]
pub struct RubberScene {
    pub material: Elastomer,
    /// Table of the source with this rubber.
    pub table: Option<&'static str>,
    pub harmonic: Option<Harmonic>,
}

/// Small vibrations: of a set along an axis (0, 1 or 2), with all other supports at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonic {
    pub set: String,
    pub axis: usize,
    /// Hz.
    pub frequencies: Vec<f64>,
}

/// A resolved scene with a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidScene {
    pub title: Option<String>,
    pub source: Option<String>,
    pub assumptions: Vec<Assumption>,
    pub defaults_used: Vec<DefaultUsed>,
    pub mesh: MeshRequest,
    pub law: Law,
    /// kg/m³.
    pub density: f64,
    /// 1/s.
    pub damping: f64,
    pub damped_motion: DampedMotion,
    /// m/s².
    pub gravity: [f64; 3],
    /// At the start of a run, m/s, and the rotation about X, rad/s.
    pub velocity: [f64; 3],
    pub spin: f64,
    pub held: Vec<Held>,
    pub loads: Vec<SetLoad>,
    pub probes: Vec<Probe>,
    pub mode_count: usize,
    pub mode_mass: MassMatrix,
    /// `None` if the scene gives no end.
    pub run: Option<SolidRun>,
    /// True if series and spectra are drawn.
    pub draw_series: bool,
    pub draw_spectrum: bool,
}
