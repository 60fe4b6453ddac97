//! A resolved scene: SI units, validated, with every default named.

use crate::assembly::bearing_alone::CageBody;
use crate::ch2_housing::bearing::cage::Guidance;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::{BearingGeometry, ClearanceThrough, Material};
use crate::ch2_housing::bearing::hertz::HertzModel;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch2_housing::bore_contact::Penalty;
use crate::ch5_cage::raceway_profile::RacewayProfile;
use crate::members::body::{Condition, DrivenBody, RotatingLoad};
use crate::mesh;
use crate::motion::simulation::RunOptions;
use crate::plan::channels::ChannelGroup;
pub use crate::scene::text::document::Assumption;
use crate::scene::text::document::Document;
use crate::scene::text::sweep::SweepAxis;
use crate::scene::text::value::Checked;

/// A default in use: reported with the results as an assumption.
#[derive(Clone, Debug, PartialEq)]
pub struct DefaultUsed {
    /// Dotted key or table that was not given.
    pub key: String,
    /// Value in use, as shown.
    pub value: String,
    pub reason: String,
    /// Keys that would give the same, and their values.
    pub fills: Vec<(String, Checked)>,
}

impl DefaultUsed {
    /// False for a value that follows from the keys next to it, such as a second position.
    pub fn is_reported(&self) -> bool {
        !self.reason.is_empty()
    }

    /// Adds a key that would give the same.
    pub(crate) fn fill(&mut self, key: &str, value: impl Into<Checked>) -> &mut DefaultUsed {
        self.fills.push((key.to_string(), value.into()));
        self
    }

    /// Names the thing that has the default: `bearing.left.hertz`.
    pub(crate) fn name(&mut self, document: &Document) {
        let keys = self.fills.iter_mut().map(|(key, _)| key).chain([&mut self.key]);
        keys.for_each(|key| *key = document.shown(key, true));
    }
}

/// Size of one raceway, in m, with the three ways to state its groove.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceDimensions {
    /// Groove-bottom radius from the axis, after the clearance has been applied.
    pub radius: f64,
    pub groove_radius: f64,
    /// Groove radius / nominal ball diameter.
    pub conformity: f64,
    /// Nominal ball diameter / (2 groove radius).
    pub osculation: f64,
}

/// End of a groove.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shoulder {
    /// From the axis, m.
    pub radius: f64,
    /// False for the default height.
    pub given: bool,
}

/// Dimensions in m, as given. The solver's are in [`BearingGeometry`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimensions {
    /// Ball radius as given, or the one in use if none was. Conformity and osculation refer to it.
    pub nominal_ball_radius: f64,
    pub clearance_through: ClearanceThrough,
    pub radial_clearance: f64,
    pub diametral_clearance: f64,
    pub inner_race: RaceDimensions,
    pub outer_race: RaceDimensions,
    pub bore_radius: Option<f64>,
    pub outer_radius: Option<f64>,
    pub length: Option<f64>,
}

/// Cage, SI units; `None` for values not given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cage {
    pub pocket_radius: Option<f64>,
    pub inner_radius: Option<f64>,
    pub outer_radius: Option<f64>,
    /// Radial gap to the guiding race.
    pub race_clearance: Option<f64>,
    pub mass: Option<f64>,
    pub guidance: Option<Guidance>,
}

/// Plots of a static solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plot {
    LoadZone,
    Polar,
    MomentTilt,
}

/// Plots of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunPlot {
    Orbit,
    Spectrum,
    Series,
    SlipSpin,
    RunUp,
}

/// The cage in a run.
#[derive(Clone, Debug, PartialEq)]
pub enum CageInRun {
    Body(CageBody),
    /// Reason for a run without a cage.
    LeftOut(String),
}

/// How a cage with a mesh moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CageMethod {
    Rigid,
    Reduced,
    Explicit,
}

/// A cage that touches by the nodes of its mesh, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct FlexibleCage {
    pub shape: mesh::generate::Cage,
    pub cells: mesh::generate::CageMesh,
    pub penalty: Penalty,
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
    pub density: f64,
    /// 1/s.
    pub damping: f64,
    pub method: CageMethod,
    /// Elements of four nodes (1) or ten (2).
    pub order: usize,
    /// Hz; zero for a rigid cage.
    pub modes_to: f64,
    /// Static correction modes for its contacts.
    pub corrections: bool,
}

/// Length, steps and output of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSettings {
    pub options: RunOptions,
    /// True if the plan chooses the integrator; the options then have one that suits every bearing.
    pub by_plan: bool,
    /// s.
    pub end: f64,
    /// Time between rows, s.
    pub output_interval: f64,
    /// Time between files of fields, s; `None`: only at the end.
    pub fields_interval: Option<f64>,
    /// Start of the window of means and spectra, s.
    pub window_start: f64,
    /// Groups of columns to write.
    pub channels: Vec<ChannelGroup>,
}

/// Part of a scene for runs, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamics {
    pub inner: DrivenBody,
    /// `None`: the outer race is fixed.
    pub outer: Option<DrivenBody>,
    pub cage: CageInRun,
    /// `None`: rigid, with contacts of its geometric surfaces.
    pub flexible_cage: Option<FlexibleCage>,
    pub rotating_load: Option<RotatingLoad>,
    /// kg·m.
    pub unbalance: f64,
    pub traction: TractionLaw,
    pub slices: usize,
    pub points_across: usize,
    pub differential_sliding: bool,
    pub damping: ContactDamping,
    /// Friction coefficient and regularisation speed (m/s) of the contact between balls.
    pub ball_friction: Option<[f64; 2]>,
    /// Dents, spalls and waves, in this order.
    pub raceway_profiles: Vec<RacewayProfile>,
    /// Excess of each ball's radius, m; empty for equal balls.
    pub ball_deviations: Vec<f64>,
    /// Beside the groove of the inner and of the outer race.
    pub shoulders: [Shoulder; 2],
    /// `None` if the scene gives no end.
    pub run: Option<RunSettings>,
    pub plots: Vec<RunPlot>,
    /// Defaults in use in addition to [`Scene::defaults_used`].
    pub defaults_used: Vec<DefaultUsed>,
}

/// A resolved scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub title: Option<String>,
    pub source: Option<String>,
    /// Assumptions of the scene about unstated inputs, as named by its author.
    pub assumptions: Vec<Assumption>,
    /// Defaults in use for keys that were not given.
    pub defaults_used: Vec<DefaultUsed>,

    pub geometry: BearingGeometry,
    pub dimensions: Dimensions,
    pub inner_material: Material,
    pub outer_material: Material,
    pub ball_material: Material,
    pub hertz: HertzModel,
    pub cage: Option<Cage>,
    /// Basic dynamic load rating as given, N.
    pub dynamic_rating: Option<f64>,
    /// Azimuth of ball 1 from +Y towards +Z, rad.
    pub ball_phase: f64,

    /// Conditions on x, y, z, tilt_y, tilt_z of the inner race, at t = 0.
    pub conditions: [Condition; 5],
    /// Position x, y, z (m) and tilt_y, tilt_z (rad) of the outer race, at t = 0.
    pub outer_race: [f64; 5],
    /// Rotation of the inner race about X at t = 0, rad/s.
    pub inner_speed: Option<f64>,
    /// Rotation of the outer race, if any.
    pub outer_speed: Option<f64>,
    /// World axes, m/s²; zero without weight.
    pub gravity: [f64; 3],
    pub centrifugal: bool,

    /// Part for runs.
    pub dynamics: Dynamics,

    /// True if the housing is rigid, so that it is not read.
    pub rigid_housing: bool,

    pub plots: Vec<Plot>,
    /// Axes of a sweep without `--vary`.
    pub sweep: Vec<SweepAxis>,
}
