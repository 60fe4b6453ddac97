//! Sensors of a scene, and those of the solver.

use crate::assembly::lists::Assembly;
use crate::ch5_cage::telemeter::Telemeter;
use crate::members::sensor::{Accelerometer, CageTelemeter, Sensor, SensorKind};
use crate::scene::build::assembly::AssemblyScene;
use crate::scene::tables::assembly::OWN_RACES;

#[derive(Clone, Debug, PartialEq)]
pub struct SceneSensor {
    pub name: String,
    pub kind: SceneSensorKind,
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
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Radial,
    Tangential,
    Axial,
}

impl Direction {
    pub const ALL: [Direction; 3] = [Direction::Radial, Direction::Tangential, Direction::Axial];

    /// Name in scenes.
    pub const fn name(self) -> &'static str {
        match self {
            Direction::Radial => "radial",
            Direction::Tangential => "tangential",
            Direction::Axial => "axial",
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
        }
    }
}

impl SceneSensor {
    /// Sensor of the solver, on the bodies and bearings of this assembly.
    pub(crate) fn of(&self, assembly: &Assembly) -> Sensor {
        let kind = match self.kind {
            SceneSensorKind::Accelerometer { at, along, radius, angle, direction } => {
                let bearing = |index: usize| &assembly.bearings[index];
                let body = match at {
                    SensorAt::Body(body) => body,
                    SensorAt::Race { bearing: of, side } => bearing(of).mounts[side].body,
                    // A missing cage is refused when the scene is read.
                    SensorAt::Cage(of) => bearing(of).cage.as_ref().map_or(0, |cage| cage.body),
                };
                let (sin, cos) = libm::sincos(angle);
                let place = [along, radius * cos, radius * sin];
                let direction = match direction {
                    Direction::Radial => [0.0, cos, sin],
                    Direction::Tangential => [0.0, -sin, cos],
                    Direction::Axial => [1.0, 0.0, 0.0],
                };
                // The cage of a reversed bearing starts half a turn about Z away.
                let turned = matches!(at, SensorAt::Cage(of) if bearing(of).mounts[1].reversed);
                let own = |[x, y, z]: [f64; 3]| if turned { [-x, -y, z] } else { [x, y, z] };
                let (place, direction) = (own(place), own(direction));
                SensorKind::Accelerometer(Accelerometer { body, place, direction })
            }
            SceneSensorKind::Telemeter { bearing, circuit, distance, offset, runout } => {
                let [offset, runout] = [offset, runout].map(|[far, angle]| {
                    let (sin, cos) = libm::sincos(angle);
                    [far * cos, far * sin]
                });
                SensorKind::Telemeter(CageTelemeter { bearing, circuit, distance, offset, runout })
            }
        };
        Sensor { name: self.name.clone(), kind }
    }
}
