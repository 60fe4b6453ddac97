//! A scene with a bearing in a flexible housing, resolved; the housing's mesh is not read.

use crate::ch2_housing::bore_contact::Penalty;
use crate::ch4_rotor::bore_friction::BoreFriction;
use crate::scene::resolve::resolved::{DefaultUsed, Scene};
use crate::scene::resolve::solid_scene::SolidScene;
use crate::solids::bore_equilibrium::Axial;

/// How bearing and housing are solved together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HousingMethod {
    /// One equilibrium after the other, the housing condensed onto its bore.
    QuasiStatic,
    /// Both in explicit steps that exchange impulses.
    Explicit,
    /// The housing reduced to some shapes, which move with the bearing.
    Reduced,
}

/// Size of the outer race in its bore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitSize {
    /// Radial interference, m; negative is clearance.
    Interference(f64),
    /// Radius of the race, m.
    OuterRadius(f64),
}

/// What `[housing]` says, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct HousingSettings {
    pub method: HousingMethod,
    /// Surface set of the solid.
    pub bore: String,
    pub fit: FitSize,
    /// Whether explicit steps start in the equilibrium of all, the race grown into its fit.
    pub from_equilibrium: bool,
    /// Time over which an interference grows in, s.
    pub fit_ramp: Option<f64>,
    /// Of the seat, m; `None`: as wide as the bore.
    pub width: Option<f64>,
    pub axial: Axial,
    pub penalty: Penalty,
    /// `None`: the bore is smooth.
    pub friction: Option<BoreFriction>,
    /// Steps of the housing over their limit, and phase of the seat in a window.
    pub step_fraction: f64,
    pub window_phase: f64,
    /// Natural shapes of a reduced housing up to this frequency, Hz; `None`: by what the bearing pushes with.
    pub modes_to: Option<f64>,
    /// Force on the race in its bore that shapes are made for, N; `None`: the largest load.
    pub press: Option<f64>,
    pub defaults_used: Vec<DefaultUsed>,
}

/// A bearing and the housing of its outer race. The solid has no run of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct HousedScene {
    pub bearing: Scene,
    pub housing: HousingSettings,
    pub solid: SolidScene,
}
