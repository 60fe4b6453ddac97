//! A resolved scene with a bearing in a flexible housing; the housing's mesh is not read.

use crate::ch2_housing::bore_contact::Penalty;
use crate::ch4_rotor::bore_friction::BoreFriction;
use crate::scene::resolve::resolved::{DefaultUsed, Scene};
use crate::scene::resolve::solid_scene::SolidScene;
use crate::solids::bore_equilibrium::Axial;

/// Solution of bearing and housing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HousingMethod {
    /// A sequence of equilibria, with the housing condensed onto its bore.
    QuasiStatic,
    /// Both in explicit steps, exchanging impulses.
    Explicit,
    /// The housing reduced to modes, which move with the bearing.
    Reduced,
}

/// Fit of the outer race in its bore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitSize {
    /// Radial interference, m; negative is clearance.
    Interference(f64),
    /// Radius of the race, m.
    OuterRadius(f64),
}

/// `[housing]`, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct HousingSettings {
    pub method: HousingMethod,
    /// Surface set of the solid.
    pub bore: String,
    pub fit: FitSize,
    /// True if explicit steps start in equilibrium, with the fit.
    pub from_equilibrium: bool,
    /// Time over which an interference grows in, s.
    pub fit_ramp: Option<f64>,
    /// Width of the race in the bore, m; `None`: as wide as the bore.
    pub width: Option<f64>,
    pub axial: Axial,
    pub penalty: Penalty,
    /// `None` for a smooth bore.
    pub friction: Option<BoreFriction>,
    /// Steps of the housing over their limit, and phase of the race in a coupling step.
    pub step_fraction: f64,
    pub coupling_phase: f64,
    /// Highest natural frequency of a reduced housing, Hz; `None`: from the frequencies of the bearing.
    pub modes_to: Option<f64>,
    /// Force on the race in its bore for the correction modes, N; `None`: the largest load.
    pub bore_load: Option<f64>,
    pub defaults_used: Vec<DefaultUsed>,
}

/// A bearing and the housing of its outer race. The solid has no run of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct HousedScene {
    pub bearing: Scene,
    pub housing: HousingSettings,
    pub solid: SolidScene,
}
