//! A bearing alone as plain data.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::ball_contact::BallContactLaw;
use crate::ch2_housing::bearing::cage::CageContacts;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch5_cage::raceway_profile::RacewayProfile;
use crate::members::body::{DrivenBody, RotatingLoad};

/// The rigid cage.
#[derive(Clone, Debug, PartialEq)]
pub struct CageBody {
    pub inertia: Inertia,
    pub contacts: CageContacts,
}

/// A bearing in motion, SI units, inertial axes X axial, Y lateral, Z up.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicProblem {
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    pub ball: Inertia,
    pub inner: DrivenBody,
    /// `None`: the outer race is fixed in space and has no equations.
    pub outer: Option<DrivenBody>,
    /// Position x, y, z (m) and tilts (rad) of the outer race at the start.
    pub outer_start: [f64; 5],
    pub cage: Option<CageBody>,
    /// rad, azimuth of ball 1 from +Y towards +Z.
    pub ball_phase: f64,
    pub traction: TractionLaw,
    /// Slices across the contact ellipse.
    pub slices: usize,
    /// Points across each slice.
    pub points_across: usize,
    /// Differential sliding of a ball in its groove (Heathcote).
    pub differential_sliding: bool,
    pub damping: ContactDamping,
    /// Contact between neighbouring balls; without it interpenetrating balls end the run.
    pub ball_contact: Option<BallContactLaw>,
    /// Profiles of its races and balls.
    pub raceway_profiles: Vec<RacewayProfile>,
    /// Excess of each ball's radius, m; empty for equal balls.
    pub ball_deviations: Vec<f64>,
    /// m/s².
    pub gravity: [f64; 3],
    pub rotating_load: Option<RotatingLoad>,
    /// Unbalance of the inner race, kg·m, at its spin angle.
    pub unbalance: f64,
}

impl DynamicProblem {
    /// The bearing as lists of bodies and bearings.
    pub fn assembly(&self) -> Assembly {
        Assembly::from(self)
    }
}
