//! Sensors of a scene, and those of the solver.

use crate::assembly::lists::Assembly;
use crate::ch5_cage::telemeter::Telemeter;
use crate::kinematics::vec3::Vec3;
use crate::members::sensor::{
    Accelerometer, Acquisition, CageTelemeter, NodeAccelerometer, Sensor, SensorKind, SensorMount,
};
use crate::scene::build::assembly::AssemblyScene;
use crate::scene::tables::assembly::OWN_RACES;

#[derive(Clone, Debug, PartialEq)]
pub struct SceneSensor {
    pub name: String,
    pub kind: SceneSensorKind,
    pub acquisition: Acquisition,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SceneSensorKind {
    Accelerometer {
        at: SensorAt,
        /// Position along the body's axis and distance from it, m.
        along: f64,
        radius: f64,
        /// Angle, rad, from +Y towards +Z.
        angle: f64,
        direction: Direction,
    },
    Telemeter {
        /// Index in the scene's bearings.
        bearing: usize,
        circuit: Telemeter,
        /// m.
        distance: f64,
        /// m and rad, from +Y towards +Z.
        offset: [f64; 2],
        runout: [f64; 2],
    },
}

/// Mount of an accelerometer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorAt {
    /// Index in the scene's bodies.
    Body(usize),
    /// Inner (0) or outer (1) race of this bearing.
    Race { bearing: usize, side: usize },
    /// Cage of this bearing.
    Cage(usize),
    /// Reduced housing of this bearing.
    Housing(usize),
}

/// Measured direction of an accelerometer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    Radial,
    Tangential,
    Axial,
    /// In the scene's axes, not rotating: azimuth from +Y towards +Z and elevation towards +X, rad.
    Fixed {
        azimuth: f64,
        elevation: f64,
    },
}

impl Direction {
    /// Name in scenes.
    pub const fn name(self) -> &'static str {
        match self {
            Direction::Radial => "radial",
            Direction::Tangential => "tangential",
            Direction::Axial => "axial",
            Direction::Fixed { .. } => "fixed",
        }
    }

    /// Unit vector for a sensor at this azimuth, rad.
    fn vector(self, angle: f64) -> Vec3 {
        let (sin, cos) = libm::sincos(angle);
        match self {
            Direction::Radial => [0.0, cos, sin],
            Direction::Tangential => [0.0, -sin, cos],
            Direction::Axial => [1.0, 0.0, 0.0],
            Direction::Fixed { azimuth, elevation } => {
                let ((up, out), (sin, cos)) = (libm::sincos(elevation), libm::sincos(azimuth));
                [up, out * cos, out * sin]
            }
        }
    }
}

impl AssemblyScene {
    /// Name of a mount in scenes.
    pub fn name_of_place(&self, at: SensorAt) -> String {
        let of = |bearing: usize| {
            let name = self.bearings[bearing].name.as_ref();
            name.map_or(String::new(), |name| format!("{name}."))
        };
        match at {
            SensorAt::Body(body) => self.bodies[body].name.clone(),
            SensorAt::Race { bearing, side } => format!("{}{}", of(bearing), OWN_RACES[side]),
            SensorAt::Cage(bearing) => format!("{}cage", of(bearing)),
            SensorAt::Housing(bearing) => format!("{}housing", of(bearing)),
        }
    }
}

impl SceneSensor {
    /// Sensor of the solver, on the bodies and bearings of this assembly.
    pub(crate) fn of(&self, assembly: &Assembly) -> Sensor {
        let kind = match self.kind {
            SceneSensorKind::Accelerometer { at, along, radius, angle, direction } => {
                let (sin, cos) = libm::sincos(angle);
                let place = [along, radius * cos, radius * sin];
                let fixed = matches!(direction, Direction::Fixed { .. });
                accelerometer(assembly, at, (place, direction.vector(angle)), fixed)
            }
            SceneSensorKind::Telemeter { bearing, circuit, distance, offset, runout } => {
                let [offset, runout] = [offset, runout].map(|[far, angle]| {
                    let (sin, cos) = libm::sincos(angle);
                    [far * cos, far * sin]
                });
                SensorKind::Telemeter(CageTelemeter { bearing, circuit, distance, offset, runout })
            }
        };
        Sensor { name: self.name.clone(), kind, acquisition: self.acquisition }
    }
}

/// Accelerometer at a position from its mount's centre (m) along a unit vector, both in the scene's axes at the start.
fn accelerometer(
    assembly: &Assembly,
    at: SensorAt,
    (mut place, mut direction): (Vec3, Vec3),
    fixed: bool,
) -> SensorKind {
    let bearing = |index: usize| &assembly.bearings[index];
    let body = match at {
        SensorAt::Body(body) => body,
        SensorAt::Race { bearing: of, side } => bearing(of).mounts[side].body,
        // A missing cage is refused when the scene is read.
        SensorAt::Cage(of) => bearing(of).cage.as_ref().map_or(0, |cage| cage.body),
        SensorAt::Housing(bearing) => {
            place[0] += assembly.place_of(&assembly.bearings[bearing]);
            let of = NodeAccelerometer { bearing, place, direction, modes: None };
            return SensorKind::Node(of);
        }
    };
    if let Some(index) = assembly.shafts.iter().position(|shaft| shaft.body == body) {
        let along = place[0] - assembly.origin_of(body);
        place[0] = 0.0;
        let section = Box::new(assembly.shafts[index].shapes.section(along));
        let mount = SensorMount::Section(index, section);
        return SensorKind::Accelerometer(Accelerometer { mount, place, direction, fixed });
    }
    // The cage of a reversed bearing starts half a turn about Z away.
    if matches!(at, SensorAt::Cage(of) if bearing(of).mounts[1].reversed) {
        let own = |[x, y, z]: Vec3| [-x, -y, z];
        place = own(place);
        direction = if fixed { direction } else { own(direction) };
    }
    let mount = SensorMount::Body(body);
    SensorKind::Accelerometer(Accelerometer { mount, place, direction, fixed })
}
