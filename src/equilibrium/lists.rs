//! The lists of an equilibrium: fixed or loaded bodies, and the bearings between them.

use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bore_contact::Penalty;
use crate::equilibrium::start::ball_contacts;
use crate::kinematics::Pose;
use crate::members::body::Condition;
use crate::members::connection::Connection;
use crate::members::flexible_shaft::Section;
use crate::members::mount::Mount;
use crate::members::shaft_modes::ShaftShapes;
use crate::members::static_ball::BallContacts;
use crate::solids::bore_equilibrium::Fit;
use crate::solids::condensation::CondensedBore;
use nalgebra::Vector3;

/// Bodies and bearings in one frame.
#[derive(Clone, Debug, Default)]
pub struct StaticAssembly<'b> {
    pub bodies: Vec<StaticBody>,
    pub bearings: Vec<StaticBearing>,
    /// Dashpots have no force.
    pub connections: Vec<Connection>,
    pub seats: Vec<StaticSeat<'b>>,
    pub shafts: Vec<StaticShaft>,
}

/// Bending and stretching of a body: the amplitudes of its modes are unknowns in addition to its coordinates.
/// Attachments on it are at [`Place::Section`]s.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticShaft {
    /// The body whose straight axis is the reference of the modes; its tilts rotate e₂ and e₃.
    pub body: usize,
    /// Squared frequencies along e₂ and e₃, then along the axis, 1/s²: N/m for a modal mass of 1 kg.
    pub springs: Vec<f64>,
    /// Start of the search; empty for a straight shaft.
    pub start: Vec<f64>,
    /// Modal loads, N; empty for none.
    pub loads: Vec<f64>,
}

impl StaticShaft {
    /// The shaft of a body with these modes.
    pub fn new(body: usize, shapes: &ShaftShapes) -> StaticShaft {
        let ShaftShapes { frequencies, stretch_frequencies, .. } = shapes;
        let all = frequencies.iter().chain(frequencies).chain(stretch_frequencies);
        let springs = all.map(|w| w * w).collect();
        StaticShaft { body, springs, start: Vec::new(), loads: Vec::new() }
    }
}

/// A section of a flexible body; its five coordinates follow from the body and the modes.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticSection {
    /// Index in [`StaticAssembly::shafts`].
    pub shaft: usize,
    pub section: Section,
    /// Loads along its coordinates, N and N·m.
    pub loads: [f64; 5],
}

impl StaticAssembly<'_> {
    /// Attachment of a mount: on its section if the body is flexible.
    pub fn attachment_of(&self, mount: &Mount) -> Mount {
        let is_there = |body: &StaticBody| match &body.place {
            Place::Section(of) => {
                self.shafts[of.shaft].body == mount.body && of.section.along == mount.along
            }
            _ => false,
        };
        match self.bodies.iter().position(is_there) {
            Some(body) => Mount { body, along: 0.0, ..*mount },
            None => *mount,
        }
    }
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticBody {
    /// Name in messages.
    pub name: String,
    pub place: Place,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Fixed at this pose.
    Fixed(Pose),
    /// x, y, z (m), tilt_y, tilt_z (rad) are unknown or prescribed one by one.
    Loaded(Loaded),
    /// Part of a flexible body.
    Section(Box<StaticSection>),
}

/// A body with five coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// Reference pose of the coordinates in the assembly's frame; displacements, tilts and loads are along and about
    /// its axes. `None` for the frame itself.
    pub axes: Option<Box<Pose>>,
    pub conditions: [Condition; 5],
    /// Springs to the ground, N/m and N·m/rad, and their unloaded position.
    pub springs: [f64; 5],
    pub rest: [f64; 5],
    /// Start of the search; `None`: an estimate for a bearing alone.
    pub start: Option<[f64; 5]>,
    /// Largest distance of a free coordinate from the start, m (tilts times the pitch radius), beyond which a body in a
    /// bore is lost.
    pub room: f64,
}

/// Balls between two races.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticBearing {
    /// Name in messages; `None` for the only one.
    pub name: Option<String>,
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    /// Inner race, outer race.
    pub mounts: [Mount; 2],
    /// Azimuth of each ball in the outer race's frame, from +Y towards +Z, rad; [`BearingGeometry::azimuths`] for even
    /// spacing.
    pub azimuths: Vec<f64>,
    /// Weight of a ball, N.
    pub weight: Vector3<f64>,
    /// Centrifugal force on a ball per distance from the axis, N/m.
    pub centrifugal: f64,
}

/// A race in the bore of a fixed flexible solid.
///
/// Each housing fit has a solid of its own: each bore is condensed as if it were the only one. A solid with two loaded
/// bores cannot be represented.
#[derive(Clone, Debug)]
pub struct StaticSeat<'b> {
    /// Name in messages; `None` for the only one.
    pub name: Option<String>,
    /// Position of the race on a body.
    pub mount: Mount,
    /// Reference pose of the race's motion in the assembly's frame, at which its position in the bore is
    /// [`crate::solids::condensation::Reach::nominal`].
    pub nominal: Pose,
    pub bore: &'b CondensedBore,
    pub penalty: Penalty,
    /// Fit of the race. The bore does not hold the race along its axis: the conditions of its body do.
    pub fit: Fit,
}

impl StaticSeat<'_> {
    /// Suffix in messages: " of bearing left"; empty for the only one.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"))
    }
}

impl StaticBearing {
    pub(crate) fn contacts(&self) -> BallContacts {
        ball_contacts(&self.geometry, &self.inner_contact, &self.outer_contact)
    }

    /// Suffix in messages: " of bearing left"; empty for the only one.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"))
    }
}

impl Loaded {
    /// Reference pose of its coordinates.
    pub fn axes(&self) -> Pose {
        self.axes.as_deref().copied().unwrap_or(Pose::identity())
    }

    /// Prescribed value of coordinate `i`.
    pub fn prescribed(&self, i: usize) -> Option<f64> {
        match self.conditions[i] {
            Condition::Displacement(value) => Some(value),
            Condition::Load(_) => None,
        }
    }

    pub fn load(&self, i: usize) -> f64 {
        match self.conditions[i] {
            Condition::Displacement(_) => 0.0,
            Condition::Load(load) => load,
        }
    }
}
