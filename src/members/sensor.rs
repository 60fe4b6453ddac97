//! Sensors: what a motion is watched by besides the channels of its parts.

use crate::ch5_cage::telemeter::Telemeter;
use crate::kinematics::vec3::{Vec3, add, cross, dot, norm, scale, sub};
use crate::members::rigid_body::BodyKinematics;
use crate::motion::system::System;
use nalgebra::Vector3;

/// Something with a name that gives a number at each row.
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

/// Sits on a rigid body and turns with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerometer {
    /// Index in the assembly's bodies.
    pub body: usize,
    /// In the body's axes, from its centre, m.
    pub place: Vec3,
    /// Unit vector in the body's axes.
    pub direction: Vec3,
}

/// On the cage of a bearing, its transceiver beside it on the outer race, on the side of the bearing's own +X; the
/// transceiver does not turn about the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageTelemeter {
    /// Index in the assembly's bearings.
    pub bearing: usize,
    pub circuit: Telemeter,
    /// Between the planes of both loops while cage and outer race are in their places, m.
    pub distance: f64,
    /// Of the transceiver's centre from the outer race's axis, along the scene's +Y and +Z, m.
    pub offset: [f64; 2],
    /// Of the loop's centre from the cage's axis, along the scene's +Y and +Z at the start; it turns with the cage, m.
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

    /// What it reads where the system was evaluated last, which gave these rates.
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
        // A telemeter is of a bearing that has a cage.
        let Some(cage) = &set.cage else { return f64::NAN };
        let outer = &set.races[1].motion;
        let axis = outer.axis;
        // Races and cage of a bearing that is put in the other way round have their own axes turned by half a turn about Z;
        // angles count in the scene's.
        let reversed = system.assembly.bearings[self.bearing].mounts[1].reversed;
        let facing = if reversed { -1.0 } else { 1.0 };
        // Axes of the outer race that do not turn about its own.
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
