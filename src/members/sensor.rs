//! Sensors: additional observations of a motion.

use crate::ch5_cage::telemeter::Telemeter;
use crate::kinematics::vec3::{Vec3, add, cross, dot, norm, scale, sub};
use crate::members::rigid_body::BodyKinematics;
use crate::motion::system::System;
use nalgebra::Vector3;

/// A named sensor with one value for each row.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    pub name: String,
    pub kind: SensorKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SensorKind {
    Accelerometer(Accelerometer),
    Telemeter(CageTelemeter),
}

/// Accelerometer mounted on a rigid body, rotating with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerometer {
    /// Index in the assembly's bodies.
    pub body: usize,
    /// Position in the body's axes, from its centre, m.
    pub place: Vec3,
    /// Unit vector in the body's axes.
    pub direction: Vec3,
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
            SensorKind::Accelerometer(_) => (format!("{}_acceleration", self.name), "m/s^2"),
            SensorKind::Telemeter(_) => (format!("{}_reflection", self.name), "1"),
        }
    }

    /// Reading for the last evaluation of the system, with these rates.
    pub fn read(&self, system: &System, rates: &[f64]) -> f64 {
        match &self.kind {
            SensorKind::Accelerometer(sensor) => {
                let [linear, spin] = system.acceleration_of(rates, sensor.body);
                sensor.read(&system.bodies[sensor.body], linear, spin)
            }
            SensorKind::Telemeter(sensor) => sensor.read(system),
        }
    }
}

impl Accelerometer {
    /// (v̇ + ω̇ × r + ω × (ω × r)) · d, m/s²; `linear` is v̇ and `turning` ω̇, inertial axes.
    pub fn read(&self, now: &BodyKinematics, linear: Vec3, turning: Vec3) -> f64 {
        let turned =
            |vector: Vec3| -> Vec3 { (now.state.orientation * Vector3::from(vector)).into() };
        let (arm, spin) = (turned(self.place), now.state.spin);
        let of_point = add(linear, cross(turning, arm));
        dot(add(of_point, cross(spin, cross(spin, arm))), turned(self.direction))
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
