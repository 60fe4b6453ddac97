//! What is in equilibrium: bodies that are held or loaded, and the bearings between them.

use crate::assembly::mount::Mount;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::ch2_housing::bore_contact::Penalty;
use crate::equilibrium::start::ball_contacts;
use crate::equilibrium::statics::Condition;
use crate::kinematics::Pose;
use crate::members::connection::Connection;
use crate::members::flexible_shaft::Section;
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
    /// Their dashpots are at rest.
    pub connections: Vec<Connection>,
    pub seats: Vec<StaticSeat<'b>>,
    pub shafts: Vec<StaticShaft>,
}

/// Bending and stretching of a body: the amplitudes of its shapes are looked for beside its coordinates. What takes hold
/// of it does so at [`Place::Section`]s.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticShaft {
    /// Whose straight axis the shapes count from; its tilts turn e₂ and e₃ along.
    pub body: usize,
    /// Squares of their frequencies along e₂, e₃, and of those along the axis, 1/s²: N/m for a modal mass of 1 kg.
    pub springs: Vec<f64>,
    /// Where the search begins; unbent where it is empty.
    pub start: Vec<f64>,
    /// Along the amplitudes, N; none where it is empty.
    pub loads: Vec<f64>,
}

impl StaticShaft {
    /// Of a body with these shapes.
    pub fn new(body: usize, shapes: &ShaftShapes) -> StaticShaft {
        let ShaftShapes { frequencies, stretch_frequencies, .. } = shapes;
        let all = frequencies.iter().chain(frequencies).chain(stretch_frequencies);
        let springs = all.map(|w| w * w).collect();
        StaticShaft { body, springs, start: Vec::new(), loads: Vec::new() }
    }
}

/// A section of a body that bends: its five coordinates follow from the body's and the shapes'.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticSection {
    /// Index in [`StaticAssembly::shafts`].
    pub shaft: usize,
    pub section: Section,
    /// Along its coordinates, N and N·m.
    pub loads: [f64; 5],
}

impl StaticAssembly<'_> {
    /// Where what is mounted on a body takes hold: on a section that was made for it, if the body bends.
    pub fn hold_of(&self, mount: &Mount) -> Mount {
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
    /// As messages name it.
    pub name: String,
    pub place: Place,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// It stands there, whatever pulls at it.
    Held(Pose),
    /// Its coordinates x, y, z (m), tilt_y, tilt_z (rad) are looked for, or given one by one.
    Loaded(Loaded),
    /// Part of a body that bends.
    Section(Box<StaticSection>),
}

/// A body with five coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// What the coordinates count from, in the assembly's frame: a body at zero stands there, and its
    /// displacements, tilts and loads are along and about these axes. [`None`] is the frame itself.
    pub axes: Option<Box<Pose>>,
    pub conditions: [Condition; 5],
    /// Springs to the ground, N/m and N·m/rad, and where they are at rest.
    pub springs: [f64; 5],
    pub rest: [f64; 5],
    /// Where the search begins; [`None`] leaves it to an estimate for a bearing alone.
    pub start: Option<[f64; 5]>,
    /// How far a coordinate that is free may go from there, m (tilts over the pitch radius); a body in a bore
    /// is lost when it is beyond that.
    pub room: f64,
}

/// Balls between two races.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticBearing {
    /// As messages name it; `None` where there is one only.
    pub name: Option<String>,
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    /// Inner race, outer race.
    pub mounts: [Mount; 2],
    /// Of each ball in the outer race's frame, from +Y towards +Z, rad: [`BearingGeometry::azimuths`] where they are evenly spaced.
    pub azimuths: Vec<f64>,
    /// Of each ball, N.
    pub weight: Vector3<f64>,
    /// Centrifugal force on a ball per distance from the axis, N/m.
    pub centrifugal: f64,
}

/// A race in the bore of a flexible solid that is held.
///
/// The solid is this seat's own: the same bore given to two seats means two equal solids. A solid with two
/// bores that two races load has no place in these lists, since each bore is condensed as if it were the only one.
#[derive(Clone, Debug)]
pub struct StaticSeat<'b> {
    /// As messages name it; `None` where there is one only.
    pub name: Option<String>,
    /// Where on a body the race sits.
    pub mount: Mount,
    /// Where the race's motion is measured from, in the assembly's frame: there it stands in the bore as
    /// [`crate::solids::condensation::Reach::nominal`] says.
    pub nominal: Pose,
    pub bore: &'b CondensedBore,
    pub penalty: Penalty,
    /// The race's radius. Nothing of the bore holds the race along its axis: that is for its body's conditions to do.
    pub fit: Fit,
}

impl StaticSeat<'_> {
    /// " of bearing left", for messages; nothing where there is one only.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"))
    }
}

impl StaticBearing {
    pub(crate) fn contacts(&self) -> BallContacts {
        ball_contacts(&self.geometry, &self.inner_contact, &self.outer_contact)
    }

    /// " of bearing left", for messages; nothing where there is one only.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"))
    }
}

impl Loaded {
    /// What its coordinates count from.
    pub fn axes(&self) -> Pose {
        self.axes.as_deref().copied().unwrap_or(Pose::identity())
    }

    /// Value of coordinate `i` where it is given.
    pub fn given(&self, i: usize) -> Option<f64> {
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
