//! Readings of sensors in a motion.

use crate::kinematics::vec3::{Vec3, add, cross, dot, norm, scale, sub};
use crate::members::mount::Mount;
use crate::members::sensor::{CageTelemeter, NodeAccelerometer, Sensor, SensorKind, SensorMount};
use crate::motion::system::System;
use nalgebra::Vector3;

impl Sensor {
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
