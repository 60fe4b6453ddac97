//! Spall in a raceway or on a ball (5.4.3): loss of approach of a ball over a pit with rounded edges and a round floor.
//!
//! The source describes the spall's profile along the rolling direction as a floor arc of radius R between two rounded
//! corners of radius r. A ball of radius r_b in such a pit moves its centre on the envelope of its contacts: arcs of
//! radius r_b + r about the centres of the corners, joined at the bottom by an arc of radius R − r_b about the centre of
//! the floor. The arcs meet with equal slope. The corners begin at s = ±l/2, where the slope is zero.
//!
//! The loss of approach Δ(s, y) is the depth of this envelope below the undamaged raceway. At most it is
//! R + r − √((R + r)² − l²/4), and never more than r_b − √(r_b² − l²/4), the loss over two sharp edges.
//!
//! Approximations:
//! - The pit is described on the developed (flat) raceway. The raceway's own curvature over the length l is omitted. It
//!   would change the depth by about the fraction (R + r)/R_race: deeper on an inner race, shallower on an outer one.
//! - K_H, the contact ellipse and the direction of the normal are those of the undamaged contact. The force along the
//!   walls is the gradient of the energy.
//! - Δ at the middle of the contact applies to the whole contact: a spall smaller than the contact ellipse is felt
//!   fully.
//! - A floor that is tighter than the ball is not touched: the ball bridges both edges. Its envelope has a kink at
//!   s = 0, which is rounded with the radius [`ROUNDED`] r_b.
//! - Across the rolling direction the loss is constant in the middle half of the width and falls to zero at the sides
//!   with half a cosine wave.
//! - On a ball the pit is round, and Δ depends on the arc between its middle and the contact. The race counts as flat.

use std::f64::consts::PI;

use crate::ch3_bushing::dent::Lost;

/// Shape of a spall, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpallShape {
    /// Length l in the rolling direction between the beginnings of the rounded corners; diameter on a ball.
    pub length: f64,
    /// Width across the rolling direction; infinite on a ball.
    pub width: f64,
    /// Radius r of the rounded corners.
    pub edge_radius: f64,
    /// Depth of the floor.
    pub depth: f64,
}

impl SpallShape {
    /// Depth of a floor arc of radius `floor_radius` (m) between corners of radius `edge_radius` (m), m.
    pub fn depth_of(length: f64, edge_radius: f64, floor_radius: f64) -> f64 {
        below(0.5 * length, floor_radius + edge_radius)
    }

    /// Radius R of the floor arc, m; infinite without depth.
    pub fn floor_radius(&self) -> f64 {
        self.radii() - self.edge_radius
    }

    /// R + r, m.
    fn radii(&self) -> f64 {
        let half = 0.5 * self.length;
        0.5 * (half * half + self.depth * self.depth) / self.depth
    }

    /// Returns whether the spall has no length, width or depth.
    pub fn vanishes(&self) -> bool {
        self.length == 0.0 || self.width == 0.0 || self.depth == 0.0
    }
}

/// Smallest radius of the envelope's bottom, in ball radii.
pub const ROUNDED: f64 = 0.005;

/// Drop of a circle of this `radius` at a distance from its top: radius − √(radius² − distance²), m.
fn below(distance: f64, radius: f64) -> f64 {
    let square = distance * distance;
    square / (radius + (radius * radius - square).sqrt())
}

/// Loss of approach of a ball over a spall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpallLaw {
    /// l/2 and half of the width, m.
    half_length: f64,
    half_width: f64,
    /// r_b + r, m: radius of the envelope about the centre of a corner.
    corner: f64,
    /// Radius of the envelope about the centre of the floor, m.
    bottom: f64,
    /// Distance from the middle at which both arcs meet, m.
    joint: f64,
    /// Loss in the middle, m.
    deepest: f64,
}

impl SpallLaw {
    /// Law of a spall that does not vanish for a ball of `ball_radius` (m).
    pub fn new(shape: &SpallShape, ball_radius: f64) -> SpallLaw {
        let half_length = 0.5 * shape.length;
        let corner = ball_radius + shape.edge_radius;
        // R + r of a floor that the ball touches.
        let radii = shape.radii().max(corner + ROUNDED * ball_radius);
        let bottom = radii - corner;
        SpallLaw {
            half_length,
            half_width: 0.5 * shape.width,
            corner,
            bottom,
            joint: half_length * bottom / radii,
            deepest: below(half_length, radii),
        }
    }

    /// l/2, m.
    pub fn half_length(&self) -> f64 {
        self.half_length
    }

    /// Largest loss, m.
    pub fn deepest(&self) -> f64 {
        self.deepest
    }

    /// Loss at a distance s (m) from the middle along the rolling direction, m, and its slope; `None` outside the spall.
    #[inline]
    pub fn along(&self, s: f64) -> Option<[f64; 2]> {
        let distance = s.abs();
        // NaN passes through, so that it is caught.
        if distance >= self.half_length {
            return None;
        }
        if distance < self.joint {
            let root = (self.bottom * self.bottom - s * s).sqrt();
            return Some([self.deepest - s * s / (self.bottom + root), -s / root]);
        }
        let inside = self.half_length - distance;
        let square = inside * inside;
        let root = (self.corner * self.corner - square).sqrt();
        let slope = inside / root;
        Some([square / (self.corner + root), if s < 0.0 { slope } else { -slope }])
    }

    /// Part of the loss at a distance y (m) from the middle across the rolling direction, and its slope, 1/m; `None`
    /// outside the spall.
    #[inline]
    fn across(&self, y: f64) -> Option<[f64; 2]> {
        let distance = y.abs();
        let flat = 0.5 * self.half_width;
        if distance >= self.half_width {
            return None;
        }
        if distance <= flat {
            return Some([1.0, 0.0]);
        }
        let (sin, cos) = libm::sincos(PI * (distance - flat) / flat);
        let slope = -0.5 * PI / flat * sin;
        Some([0.5 * (1.0 + cos), if y < 0.0 { -slope } else { slope }])
    }

    /// Loss of approach and its derivatives at a position s, y (m) relative to the spall's middle; `None` outside it.
    #[inline]
    pub fn lost(&self, [s, y]: [f64; 2]) -> Option<Lost> {
        let ([value, slope], [part, part_slope]) = (self.along(s)?, self.across(y)?);
        Some(Lost {
            value: value * part,
            by_approach: 0.0,
            along: slope * part,
            across: value * part_slope,
        })
    }
}
