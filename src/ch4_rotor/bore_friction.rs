//! Friction between a bore and the outer race in it (4.2.4.2).
//!
//! At every node of the bore that touches, a spring in the tangent plane joins the node to the race's surface. The
//! friction coefficient grows with the spring's stretch up to the one of slipping, and stays there: the force is the
//! coefficient times the normal load, against the stretch.
//!
//! The source calls the spring's stiffness a large penalty and prints no number. Here it is said by the stretch at
//! which slip begins, and the spring is never stiffer than the contact is along its normal: under loads above
//! `stiffness × stretch / coefficient` slip begins later. So a step that is stable with the contact closed is stable
//! with its friction.
//!
//! A force that goes with load times stretch is no gradient. Pressing harder on a stretched spring stores
//! energy in it that no motion along the surface has put there, and easing it takes some out: what two surfaces do to
//! each other is what is stored and lost, less that ([`FrictionUpdate::load_work`]). Where long springs hold a race against a
//! torque, whose radial motion changes their loads, this pushes it on in circles: a share c of what slips makes its swing grow by
//! up to ½ μ c of the swing's own rate. Springs as stiff as the contact know of no load until they slip.

use crate::kinematics::vec3::{Vec3, add, add_scaled, dot, scale, sub};

/// What the friction of a bore is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoreFriction {
    /// Of slipping.
    pub coefficient: f64,
    /// Of a spring at which it slips, m.
    pub stretch: f64,
}

/// Friction coefficient of slipping in 4.2.4.2.
pub const COEFFICIENT: f64 = 0.6;
/// Stretch at which slip begins, m. The source states none, but that the way is to be as short as can be: at its
/// contact stiffness by area springs are as stiff as the contact from 0.042 MPa on.
pub const STRETCH: f64 = 1e-10;

/// The spring of a node: its history. All components are along the race's own axes, so that a motion of both
/// bodies together is none to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spring {
    /// Where on the race its end is held, m.
    pub anchor: Vec3,
    /// Of the node from there along the surface, m.
    pub stretch: Vec3,
    /// N/m; zero where the node did not touch.
    pub stiffness: f64,
}

impl Spring {
    /// J.
    pub fn energy(&self) -> f64 {
        0.5 * self.stiffness * dot(self.stretch, self.stretch)
    }

    /// Of the node on the race, N.
    pub fn force(&self) -> Vec3 {
        scale(self.stretch, self.stiffness)
    }
}

/// A spring after a step, and what happened in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionUpdate {
    pub spring: Spring,
    pub slips: bool,
    /// Of slipping, J.
    pub heat: f64,
    /// What a changing normal load has stored in the spring, J; negative where it was eased.
    pub load_work: f64,
}

impl BoreFriction {
    /// Stretch at which slip begins under a normal load (N), with a contact of this stiffness (N/m), m.
    pub fn slip_stretch(&self, load: f64, normal_stiffness: f64) -> f64 {
        self.stretch.max(self.coefficient * load / normal_stiffness)
    }

    /// No spring is stiffer than this where the contact is as stiff (N/m) along its normal, N/m.
    pub fn stiffest(&self, normal_stiffness: f64) -> f64 {
        if self.coefficient == 0.0 { 0.0 } else { normal_stiffness }
    }

    /// The spring of a node that touches at `place` (m, from the race's centre) where the surface has this normal,
    /// under a normal load (N) that is at most what a contact of this stiffness (N/m) made of it. `before` is the spring a step
    /// ago.
    ///
    /// Work is summed by the trapezium rule over the step, which is how central differences move what it is done
    /// on: the force times the motion along the surface is then the change of the energy and the heat less the work of
    /// the load, to rounding.
    pub fn update(
        &self,
        before: &Spring,
        place: Vec3,
        normal: Vec3,
        load: f64,
        normal_stiffness: f64,
    ) -> FrictionUpdate {
        let slip_stretch = self.slip_stretch(load, normal_stiffness);
        let touched = before.stiffness > 0.0;
        let anchor = if touched { before.anchor } else { place };
        let from_anchor = sub(place, anchor);
        let trial = add_scaled(from_anchor, -dot(normal, from_anchor), normal);
        let length = dot(trial, trial).sqrt();
        let slips = length > slip_stretch;
        let stretch = if slips { scale(trial, slip_stretch / length) } else { trial };
        let stiffness = self.coefficient * load / slip_stretch;
        let anchor = if slips { sub(place, stretch) } else { anchor };
        let spring = Spring { anchor, stretch, stiffness };
        let mean = scale(add(before.force(), spring.force()), 0.5);
        let stiffer = stiffness - before.stiffness;
        FrictionUpdate {
            spring,
            slips,
            heat: if slips { dot(mean, sub(trial, stretch)) } else { 0.0 },
            load_work: 0.5 * stiffer * dot(before.stretch, stretch),
        }
    }
}
