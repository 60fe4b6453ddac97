//! Balls between two races, with or without a cage.

use crate::ch2_housing::bearing::ball_contact::BallContactLaw;
use crate::ch2_housing::bearing::cage::{CageContact, CageContacts, Guidance, cage_stiffness};
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch5_cage::raceway_profile::RacewayProfile;
use crate::members::cage_nodes::CageNodes;
use crate::members::mount::Mount;
use std::f64::consts::PI;

/// Balls between two races, with or without a cage.
#[derive(Clone, Debug, PartialEq)]
pub struct Bearing {
    /// Name in messages; `None` for the only one.
    pub name: Option<String>,
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    pub ball: Inertia,
    /// Inner race, outer race.
    pub mounts: [Mount; 2],
    pub cage: Option<Caged>,
    /// rad, azimuth of ball 1 in the outer race's axes, from +Y towards +Z.
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
}

/// A cage and its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Caged {
    /// Index in [`Assembly::bodies`](crate::assembly::lists::Assembly::bodies).
    pub body: usize,
    pub contacts: CageContacts,
    /// Contact by nodes of its mesh, instead of by the surfaces of `contacts`.
    pub nodes: Option<CageNodes>,
    /// True if the cage takes explicit steps of its own, contacts included; its body follows it.
    pub in_elements: bool,
}

impl Caged {
    /// Stiffness of a loaded contact, N/m; of nodes the sum of those that touch.
    pub fn stiffness(&self, contact: &CageContact) -> f64 {
        match &self.nodes {
            Some(_) => contact.normal_load / contact.penetration,
            None => cage_stiffness(&self.contacts.force, contact.penetration),
        }
    }

    /// Largest displacement of a ball from the middle of its pocket, m.
    pub fn room(&self, bearing: &Bearing) -> f64 {
        self.contacts.pocket_radius - bearing.geometry.ball_radius
    }
}

impl Bearing {
    /// Returns whether all balls have the nominal radius.
    pub fn has_equal_balls(&self) -> bool {
        self.ball_deviations.iter().all(|deviation| *deviation == 0.0)
    }

    /// Tests of profiles in one evaluation: each ball for a profile of a race, two contacts for a profile of a ball,
    /// two contacts of each ball for balls of different size.
    pub fn profile_tests(&self) -> u64 {
        let balls = self.geometry.ball_count;
        let felt = self.raceway_profiles.iter().filter(|profile| !profile.vanishes());
        let tests: usize = felt.map(|of| if of.is_on_ball() { 2 } else { balls }).sum();
        (tests + if self.has_equal_balls() { 0 } else { 2 * balls }) as u64
    }

    /// Prefix of column names: "left_"; empty for the only one.
    pub fn prefix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!("{name}_"))
    }

    /// Suffix in messages: " of bearing left"; empty for the only one.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"))
    }

    /// Returns whether neighbouring balls can meet.
    pub fn ball_meeting(&self) -> BallMeeting {
        if self.ball_contact.is_none() {
            return BallMeeting::NoLaw;
        }
        let kept =
            self.cage.as_ref().and_then(|cage| gap_in_pockets(&self.geometry, &cage.contacts));
        kept.map_or(BallMeeting::Tested, |gap| BallMeeting::KeptApart { gap })
    }
}

/// Contact between neighbouring balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BallMeeting {
    /// Tested in every evaluation.
    Tested,
    /// Without a contact law.
    NoLaw,
    /// Never: the pockets keep a gap (m).
    KeptApart { gap: f64 },
}

/// Largest displacement of a ball inside the pitch circle at which its pocket still keeps it apart, in ball radii; far
/// more than the grooves allow.
const INWARDS: f64 = 0.5;

/// Gap (m) that the pockets of a cage keep between neighbouring balls; `None` if balls may meet.
///
/// Each ball stays on its side of the plane halfway between two pockets as long as its depth in the pocket and the
/// displacement of the cage are within the limits of any run.
pub fn gap_in_pockets(geometry: &BearingGeometry, cage: &CageContacts) -> Option<f64> {
    let radius = geometry.ball_radius;
    let aside = cage.pocket_radius - radius + HERTZ_SCALE * radius;
    let pitch = geometry.pitch_radius.min(cage.pocket_pitch_radius);
    let (sin, cos) = libm::sincos(PI / geometry.ball_count as f64);
    let inmost = pitch - INWARDS * radius - aside - cage_room(geometry, cage);
    Some(2.0 * (inmost * sin - aside * cos - radius)).filter(|gap| *gap > 0.0)
}

/// Largest interpenetration, in ball radii. The pressure of a Hertz contact of balls depends on δ/r alone. At this
/// depth steel on steel would carry 20 GPa, five times the limit of permanent deformation (ISO 76), on a contact a
/// fifth of the ball wide: neither elasticity nor the half-space holds. Cage contacts, whose stiffness is a choice,
/// have the same limit.
pub const HERTZ_SCALE: f64 = 0.1;

/// Largest displacement of a cage's centre from the axis of its outer race (m): its ring meets the bottom of the
/// groove, or its guiding surface the guiding race, at the largest contact depth. Pockets limit it in the other
/// directions.
pub fn cage_room(geometry: &BearingGeometry, cage: &CageContacts) -> f64 {
    let bottom = geometry.outer.centre_radius + geometry.outer.groove_radius;
    let ring = (bottom - cage.ring[1]).max(0.0);
    let room = match cage.guidance {
        Guidance::OuterRace => cage.race_clearance.min(ring),
        // The inner race may be displaced too.
        Guidance::InnerRace | Guidance::Balls => ring,
    };
    room + HERTZ_SCALE * geometry.ball_radius
}
