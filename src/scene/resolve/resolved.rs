//! A scene as the program uses it: SI units, validated, every default named.

use crate::assembly::channels::ChannelGroup;
use crate::assembly::loads::{CageBody, DrivenBody, RotatingLoad};
use crate::ch2_housing::bearing::cage::Guidance;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::{BearingGeometry, ClearanceThrough, Material};
use crate::ch2_housing::bearing::hertz::HertzModel;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch3_bushing::dent::Dent;
use crate::equilibrium::statics::Condition;
use crate::motion::simulation::RunOptions;
pub use crate::scene::text::document::Assumption;
use crate::scene::text::sweep::SweepAxis;

/// A default that fills a hole of the scene: shown with the results as an assumption.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DefaultUsed {
    /// Dotted key that was not given.
    pub key: String,
    /// Value used, as it would be written.
    pub value: String,
    pub reason: String,
}

/// Size of one raceway, in m, with the three ways to state its groove.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceDimensions {
    /// Groove-bottom radius from the axis, after the clearance has been applied.
    pub radius: f64,
    /// The groove-bottom radius as given, if it was.
    pub nominal_radius: Option<f64>,
    pub groove_radius: f64,
    /// Groove radius / nominal ball diameter.
    pub conformity: f64,
    /// Nominal ball diameter / (2 groove radius).
    pub osculation: f64,
}

/// Where a groove ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shoulder {
    /// From the axis, m.
    pub radius: f64,
    /// Or else of a usual height.
    pub given: bool,
}

/// Sizes as a person states them, in m. What the solver needs is in [`BearingGeometry`].
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

/// Cage, SI units; what was not given is `None`.
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
    /// Why the run has no cage.
    LeftOut(String),
}

/// How long a run is, how it steps, and what it writes.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSettings {
    pub options: RunOptions,
    /// Whether the plan is to choose the integrator; the options have one that goes with any bearing.
    pub by_plan: bool,
    /// s.
    pub end: f64,
    /// Time from one written row to the next, s.
    pub output_interval: f64,
    /// Time from one file of fields to the next, s; `None`: at the end alone.
    pub fields_interval: Option<f64>,
    /// Time from which means and spectra are taken, s.
    pub window_start: f64,
    /// Groups of columns to write.
    pub channels: Vec<ChannelGroup>,
}

/// What only a run needs, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamics {
    pub inner: DrivenBody,
    /// `None`: the outer race is fixed.
    pub outer: Option<DrivenBody>,
    pub cage: CageInRun,
    pub rotating_load: Option<RotatingLoad>,
    /// kg·m.
    pub unbalance: f64,
    pub traction: TractionLaw,
    pub slices: usize,
    pub points_across: usize,
    pub damping: ContactDamping,
    /// Friction coefficient and regularisation speed (m/s) of the contact between balls.
    pub ball_friction: Option<[f64; 2]>,
    pub dents: Vec<Dent>,
    /// Beside the groove of the inner and of the outer race.
    pub shoulders: [Shoulder; 2],
    /// `None` where the scene gives no end.
    pub run: Option<RunSettings>,
    pub plots: Vec<RunPlot>,
    /// Defaults in use besides those of [`Scene::defaults_used`].
    pub defaults_used: Vec<DefaultUsed>,
}

/// A resolved scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub title: Option<String>,
    pub source: Option<String>,
    /// Holes in the source that the scene fills, as its author named them.
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
    /// Azimuth of ball 1 from +Y towards +Z, rad.
    pub ball_phase: f64,

    /// Conditions on x, y, z, tilt_y, tilt_z of the inner race, at t = 0.
    pub conditions: [Condition; 5],
    /// Position x, y, z (m) and tilt_y, tilt_z (rad) of the outer race, at t = 0.
    pub outer_race: [f64; 5],
    /// Rotation of the inner race about X at t = 0, rad/s.
    pub inner_speed: Option<f64>,
    /// Of the outer race, where it turns.
    pub outer_speed: Option<f64>,
    /// World axes, m/s²; zero leaves the weight out.
    pub gravity: [f64; 3],
    pub centrifugal: bool,

    /// What a run needs besides.
    pub dynamics: Dynamics,

    /// Whether a housing is there and counts as rigid, so that nothing of it is read.
    pub rigid_housing: bool,

    pub plots: Vec<Plot>,
    /// What a sweep varies unless it is told otherwise.
    pub sweep: Vec<SweepAxis>,
}
