//! Sensors: additional observations of a motion.

use crate::assembly::mount::Mount;
use crate::ch5_cage::telemeter::Telemeter;
use crate::kinematics::vec3::{Vec3, add, cross, dot, norm, scale, sub};
use crate::members::flexible_shaft::Section;
use crate::members::rigid_body::BodyKinematics;
use crate::motion::system::System;
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

    /// Reading for the last evaluation of the system, at this state with these rates.
    pub fn read(&self, system: &System, state: &[f64], rates: &[f64]) -> f64 {
        match &self.kind {
            SensorKind::Accelerometer(sensor) => match &sensor.mount {
                SensorMount::Body(body) => {
                    let [linear, spin] = system.acceleration_of(rates, *body);
                    sensor.read(&system.bodies[*body], linear, spin)
                }
                SensorMount::Section(shaft, section) => {
                    let (of, at) = (&system.assembly.shafts[*shaft], system.shafts[*shaft]);
                    let body = &system.bodies[of.body];
                    let bend = of.bend(at, state);
                    let of_body = system.acceleration_of(rates, of.body);
                    let of_modes = of.bend(at, rates);
                    let [linear, spin] = section.acceleration(body, &bend, of_body, &of_modes);
                    let now = section.place(body, &Mount::at_centre(of.body), &bend).race;
                    sensor.read(&now, linear, spin)
                }
            },
            SensorKind::Node(sensor) => sensor.read(system, rates),
            SensorKind::Telemeter(sensor) => sensor.read(system),
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

impl NodeAccelerometer {
    /// Acceleration, m/s²; NaN before the housing is reduced.
    fn read(&self, system: &System, rates: &[f64]) -> f64 {
        let Some((solid, modes)) = &self.modes else { return f64::NAN };
        let (_, accelerations) = system.shapes_of(rates, *solid);
        modes.iter().zip(accelerations).map(|(mode, of)| mode * of).sum()
    }
}

impl CageTelemeter {
    /// |S₁₁|.
    fn read(&self, system: &System) -> f64 {
        let set = &system.sets[self.bearing];
        // A telemeter belongs to a bearing with a cage.
        let Some(cage) = &set.cage else { return f64::NAN };
        let outer = &set.races[1].motion;
        let axis = outer.axis;
        // The axes of a reversed bearing are rotated by half a turn about Z; angles are in the scene's axes.
        let reversed = system.assembly.bearings[self.bearing].mounts[1].reversed;
        let facing = if reversed { -1.0 } else { 1.0 };
        // Axes of the outer race that do not rotate about its own.
        let flat = sub([0.0, 1.0, 0.0], scale(axis, axis[1]));
        let side = scale(flat, 1.0 / norm(flat));
        let up = scale(cross(axis, side), facing);
        let in_axes = |vector: Vec3| [dot(vector, axis), dot(vector, side), dot(vector, up)];
        let [y, z] = self.runout;
        let own: Vec3 = (cage.state.orientation * Vector3::new(0.0, facing * y, z)).into();
        let centre = add(own, sub(cage.motion.position, outer.position));
        let [x, y, z] = in_axes(centre);
        let from_transceiver = [x - self.distance, y - self.offset[0], z - self.offset[1]];
        self.circuit.signal(from_transceiver, in_axes(cage.motion.axis))
    }
}
