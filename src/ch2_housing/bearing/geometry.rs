//! Geometry of a deep-groove or angular-contact ball bearing (Tables 2.2, 3.5, 4.1 and 5.3).

/// Isotropic linear elastic material of one bearing part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// E, Pa.
    pub youngs_modulus: f64,
    /// ν, dimensionless.
    pub poisson_ratio: f64,
    /// ρ, kg/m³.
    pub density: f64,
}

impl Material {
    /// Bearing steel as in Table 2.3.
    pub const STEEL: Material =
        Material { youngs_modulus: 210e9, poisson_ratio: 0.3, density: 7850.0 };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BearingKind {
    DeepGroove,
    AngularContact,
}

/// Raceway of one race: a torus whose cross-section is a circle of `groove_radius`.
///
/// Lengths in m, in the race's own frame: X along its axis, origin at the bearing centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raceway {
    /// Radius of the circle on which the groove's centres of curvature lie.
    pub centre_radius: f64,
    /// Axial position of that circle.
    pub centre_axial: f64,
    /// Radius of the groove's cross-section.
    pub groove_radius: f64,
}

/// How the internal clearance enters the geometry (4.3.1 varies the balls).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearanceThrough {
    Ball,
    InnerRace,
    OuterRace,
}

/// Resolved geometry, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BearingGeometry {
    pub kind: BearingKind,
    pub ball_count: usize,
    /// Ball radius in use, after the clearance has been applied.
    pub ball_radius: f64,
    pub inner: Raceway,
    pub outer: Raceway,
    /// Distance of ball centres from the axis in the nominal position.
    pub pitch_radius: f64,
    /// Contact angle of the nominal (just touching) position, rad; zero for a deep-groove bearing.
    pub contact_angle: f64,
    /// Radial internal clearance, m: how far the inner race moves radially from its nominal
    /// position until it touches; negative is interference. The diametral clearance is twice it.
    pub radial_clearance: f64,
}
