//! Sensors: additional observations of a motion.

use crate::ch5_cage::telemeter::Telemeter;
use crate::kinematics::vec3::{Vec3, add, cross, dot};
use crate::members::flexible_shaft::Section;
use crate::members::rigid_body::BodyKinematics;
use nalgebra::Vector3;

/// A named sensor with one value for each row.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    pub name: String,
    pub kind: SensorKind,
    pub acquisition: Acquisition,
}

/// Data acquisition of a sensor, applied to its recorded column after the run. The column itself is unchanged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Acquisition {
    /// Sampling rate, Hz; `None` for every output row.
    pub sampling: Option<f64>,
    /// Cut-off frequency of the low-pass filter, Hz.
    pub low_pass: Option<f64>,
    /// Band of the envelope spectrum, Hz; `None` without an envelope spectrum.
    pub envelope_band: Option<[f64; 2]>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SensorKind {
    Accelerometer(Accelerometer),
    /// Accelerometer at a node of a reduced housing.
    Node(NodeAccelerometer),
    Telemeter(CageTelemeter),
}

/// Accelerometer on a rigid body, or on a section of a flexible shaft. It moves and rotates with its mount.
#[derive(Clone, Debug, PartialEq)]
pub struct Accelerometer {
    pub mount: SensorMount,
    /// Position in the axes of the mount, from its centre, m.
    pub place: Vec3,
    /// Unit vector in the axes of the mount, or of the scene.
    pub direction: Vec3,
    /// True if `direction` is in the scene's axes and does not rotate.
    pub fixed: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SensorMount {
    /// Index in the assembly's bodies.
    Body(usize),
    /// Index in the assembly's flexible shafts, and the section.
    Section(usize, Box<Section>),
}

/// Accelerometer at a node of a reduced housing: Σ φ_k q̈_k along its direction.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeAccelerometer {
    /// Bearing in the housing, index in the assembly's bearings.
    pub bearing: usize,
    /// Wanted position, scene's axes, m; the sensor is at the nearest node.
    pub place: Vec3,
    /// Unit vector, scene's axes.
    pub direction: Vec3,
    /// Index in the assembly's solids, and displacement of the node along the direction per unit of each mode;
    /// `None` before the housing is reduced.
    pub modes: Option<(usize, Vec<f64>)>,
}

/// Telemeter on the cage of a bearing, with its transceiver on the outer race, on the side of the bearing's +X; the
/// transceiver does not rotate about the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageTelemeter {
    /// Index in the assembly's bearings.
    pub bearing: usize,
    pub circuit: Telemeter,
    /// Distance between the planes of both loops in the nominal position, m.
    pub distance: f64,
    /// Offset of the transceiver's centre from the outer race's axis, along the scene's +Y and +Z, m.
    pub offset: [f64; 2],
    /// Offset of the loop's centre from the cage's axis, along the scene's +Y and +Z at the start; it rotates with the
    /// cage, m.
    pub runout: [f64; 2],
}

impl Sensor {
    /// Name and unit of its column.
    pub fn column(&self) -> (String, &'static str) {
        match &self.kind {
            SensorKind::Accelerometer(_) | SensorKind::Node(_) => {
                (format!("{}_acceleration", self.name), "m/s^2")
            }
            SensorKind::Telemeter(_) => (format!("{}_reflection", self.name), "1"),
        }
    }
}

impl Accelerometer {
    /// (v̇ + ω̇ × r + ω × (ω × r)) · d, m/s², for the kinematics of the mount; `linear` is v̇ and `turning` ω̇,
    /// inertial axes.
    pub fn read(&self, now: &BodyKinematics, linear: Vec3, turning: Vec3) -> f64 {
        let turned =
            |vector: Vec3| -> Vec3 { (now.state.orientation * Vector3::from(vector)).into() };
        let (arm, spin) = (turned(self.place), now.state.spin);
        let of_point = add(linear, cross(turning, arm));
        let direction = if self.fixed { self.direction } else { turned(self.direction) };
        dot(add(of_point, cross(spin, cross(spin, arm))), direction)
    }
}
