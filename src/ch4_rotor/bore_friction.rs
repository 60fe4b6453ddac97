//! Friction between a housing bore and the outer race (4.2.4.2).
//!
//! At every contact node of the bore, a tangential spring connects the node to the race's surface. The friction
//! coefficient is proportional to the spring's stretch up to the slip limit and constant beyond it. The force is the
//! coefficient times the normal load, opposite to the stretch.
//!
//! The dissertation describes the spring stiffness as a large penalty and gives no value. Here it is set by the stretch
//! at which slip begins. The spring is never stiffer than the normal contact: at loads above `stiffness × stretch /
//! coefficient` slip begins at a larger stretch. A time step that is stable for the normal contact is therefore stable
//! with friction.
//!
//! A force proportional to load times stretch is not conservative. Raising the load on a stretched spring stores energy
//! without tangential displacement, lowering it releases energy; the energy balance subtracts this as
//! [`FrictionUpdate::load_work`]. Where long springs hold a race against a torque, its radial oscillation changes their
//! loads and can be self-excited: if a fraction c of the contact slips, the oscillation grows at up to ½ μ c of its own
//! frequency. Springs as stiff as the contact do not depend on the load until they slip.

use crate::kinematics::vec3::{Vec3, add, add_scaled, dot, scale, sub};
use serde::{Deserialize, Serialize};

/// Friction law of a bore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoreFriction {
    /// Coefficient of sliding friction.
    pub coefficient: f64,
    /// Stretch of a spring at which it slips, m.
    pub stretch: f64,
}

/// Coefficient of sliding friction in 4.2.4.2.
pub const COEFFICIENT: f64 = 0.6;
/// Stretch at which slip begins, m. The dissertation only requires it to be as small as possible. With its
/// area-weighted contact stiffness, springs are as stiff as the contact from 0.042 MPa on.
pub const STRETCH: f64 = 1e-10;

/// State of the friction spring of a node. All components are in the race's own axes, so that a common rigid motion of
/// both bodies does not change it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spring {
    /// Position of the spring's end on the race, m.
    pub anchor: Vec3,
    /// Tangential displacement of the node from the anchor, m.
    pub stretch: Vec3,
    /// N/m; zero if the node had no contact.
    pub stiffness: f64,
}

impl Spring {
    /// Stored energy, J.
    pub fn energy(&self) -> f64 {
        0.5 * self.stiffness * dot(self.stretch, self.stretch)
    }

    /// Force of the node on the race, N.
    pub fn force(&self) -> Vec3 {
        scale(self.stretch, self.stiffness)
    }
}

/// Spring after a step, and the energy exchanged in the step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionUpdate {
    pub spring: Spring,
    pub slips: bool,
    /// Heat dissipated by slip, J.
    pub heat: f64,
    /// Energy stored in the spring by a changing normal load, J; negative if the load decreased.
    pub load_work: f64,
}

impl BoreFriction {
    /// Stretch at which slip begins under a normal load (N) with a normal contact stiffness (N/m), m.
    pub fn slip_stretch(&self, load: f64, normal_stiffness: f64) -> f64 {
        self.stretch.max(self.coefficient * load / normal_stiffness)
    }

    /// Upper bound of the spring stiffness for a normal contact stiffness (N/m), N/m.
    pub fn stiffest(&self, normal_stiffness: f64) -> f64 {
        if self.coefficient == 0.0 { 0.0 } else { normal_stiffness }
    }

    /// Spring of a contact node at `place` (m, from the race's centre) with surface normal `normal`. The normal load
    /// (N) must not exceed that of a contact with `normal_stiffness` (N/m). `before` is the spring one step earlier.
    ///
    /// Work is summed by the trapezium rule over the step, consistent with central differences: force times tangential
    /// displacement equals the change of energy plus heat minus `load_work`, to rounding.
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
