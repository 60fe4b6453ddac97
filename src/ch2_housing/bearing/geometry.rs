//! Geometry of a deep-groove or angular-contact ball bearing (Tables 2.2, 3.5, 4.1 and 5.3).

use std::f64::consts::TAU;

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

/// Raceway of one race: a torus of circular cross-section with radius `groove_radius`.
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

/// Dimension that is changed to set the internal clearance (4.3.1 changes the balls).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearanceThrough {
    Ball,
    InnerRace,
    OuterRace,
    /// Half through each race.
    Races,
}

/// Resolved bearing geometry, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BearingGeometry {
    pub kind: BearingKind,
    pub ball_count: usize,
    /// Ball radius after the clearance has been applied, m.
    pub ball_radius: f64,
    pub inner: Raceway,
    pub outer: Raceway,
    /// Distance of the ball centres from the axis in the nominal position, m.
    pub pitch_radius: f64,
    /// Contact angle of the nominal (just touching) position, rad; zero for a deep-groove bearing.
    pub contact_angle: f64,
    /// Radial internal clearance, m: radial displacement of the inner race from its nominal position until it touches;
    /// negative for interference. The diametral clearance is twice this value.
    pub radial_clearance: f64,
}

impl BearingGeometry {
    /// Azimuths of evenly spaced balls, starting at `first`, rad.
    pub fn azimuths(&self, first: f64) -> Vec<f64> {
        (0..self.ball_count)
            .map(|ball| first + TAU * ball as f64 / self.ball_count as f64)
            .collect()
    }

    /// Deep-groove bearing from the groove-bottom radii of its races (Tables 2.2, 3.5 and 4.1), all
    /// in m; the radial clearance follows as R_OR − R_IR − 2 r_ball.
    ///
    /// ```
    /// use bearing_dynamics::ch2_housing::bearing::geometry::BearingGeometry;
    /// let table_4_1 = BearingGeometry::deep_groove(
    ///     8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.953e-3);
    /// assert!(table_4_1.radial_clearance.abs() <= 1e-17);
    /// ```
    pub fn deep_groove(
        ball_count: usize,
        inner_radius: f64,
        inner_groove_radius: f64,
        outer_radius: f64,
        outer_groove_radius: f64,
        ball_radius: f64,
    ) -> Self {
        BearingGeometry {
            kind: BearingKind::DeepGroove,
            ball_count,
            ball_radius,
            inner: Raceway {
                centre_radius: inner_radius + inner_groove_radius,
                centre_axial: 0.0,
                groove_radius: inner_groove_radius,
            },
            outer: Raceway {
                centre_radius: outer_radius - outer_groove_radius,
                centre_axial: 0.0,
                groove_radius: outer_groove_radius,
            },
            pitch_radius: 0.5 * (inner_radius + outer_radius),
            contact_angle: 0.0,
            radial_clearance: outer_radius - inner_radius - 2.0 * ball_radius,
        }
    }

    /// Angular-contact bearing whose balls just touch both races at `pitch_radius` under `contact_angle` (Table 5.3);
    /// lengths in m, angle in rad. An inner-race displacement towards +X loads the balls.
    pub fn angular_contact(
        ball_count: usize,
        pitch_radius: f64,
        inner_groove_radius: f64,
        outer_groove_radius: f64,
        ball_radius: f64,
        contact_angle: f64,
    ) -> Self {
        let (sin, cos) = libm::sincos(contact_angle);
        let inner_room = inner_groove_radius - ball_radius;
        let outer_room = outer_groove_radius - ball_radius;
        BearingGeometry {
            kind: BearingKind::AngularContact,
            ball_count,
            ball_radius,
            inner: Raceway {
                centre_radius: pitch_radius + inner_room * cos,
                centre_axial: inner_room * sin,
                groove_radius: inner_groove_radius,
            },
            outer: Raceway {
                centre_radius: pitch_radius - outer_room * cos,
                centre_axial: -outer_room * sin,
                groove_radius: outer_groove_radius,
            },
            pitch_radius,
            contact_angle,
            radial_clearance: 0.0,
        }
    }

    /// The same bearing with another radial clearance (m), set by the ball radius as in 4.3.1 or by moving the
    /// grooves of one race or both. For an angular-contact bearing the distance of the groove centres is measured along the contact line.
    pub fn with_radial_clearance(&self, clearance: f64, through: ClearanceThrough) -> Self {
        let mut changed = *self;
        if clearance == self.radial_clearance {
            return changed;
        }
        changed.radial_clearance = clearance;
        let change = clearance - self.radial_clearance;
        match through {
            ClearanceThrough::Ball => {
                let axial = self.inner.centre_axial - self.outer.centre_axial;
                let radial = self.inner.centre_radius - self.outer.centre_radius + clearance;
                let grooves = self.inner.groove_radius + self.outer.groove_radius;
                changed.ball_radius = 0.5 * (grooves - libm::hypot(axial, radial));
            }
            ClearanceThrough::InnerRace => changed.inner.centre_radius -= change,
            ClearanceThrough::OuterRace => changed.outer.centre_radius += change,
            ClearanceThrough::Races => {
                changed.inner.centre_radius -= 0.5 * change;
                changed.outer.centre_radius += 0.5 * change;
            }
        }
        changed
    }

    /// Groove-bottom radii (m) of the inner and the outer race.
    pub fn race_radii(&self) -> (f64, f64) {
        (
            self.inner.centre_radius - self.inner.groove_radius,
            self.outer.centre_radius + self.outer.groove_radius,
        )
    }
}
