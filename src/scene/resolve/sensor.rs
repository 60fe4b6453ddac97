//! From the keys of sensors to their mounts and readings.

use crate::ch5_cage::telemeter::{Telemeter, copper_resistance, natural_frequency};
use crate::scene::build::assembly::{AssemblyScene, Carrier};
use crate::scene::build::sensors::{Direction, SceneSensor, SceneSensorKind, SensorAt};
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::{Reader, text};
use crate::scene::resolve::housing_scene::HousingMethod;
use crate::scene::resolve::resolved::CageInRun;
use crate::scene::tables::keys::nearest;
use crate::scene::tables::sensor::SENSORS;
use crate::scene::text::document::Document;
use crate::scene::text::scopes::no_such;

/// Keys of accelerometers only.
const OF_AN_ACCELEROMETER: [&str; 5] = ["on", "at", "radius", "angle", "direction"];
const OF_A_TELEMETER: [&str; 12] = [
    "bearing",
    "distance",
    "offset",
    "offset_angle",
    "runout",
    "runout_angle",
    "loop_radius",
    "transceiver_radius",
    "wire_radius",
    "capacitance",
    "resistance",
    "frequency",
];

/// Adds the sensors of a scene.
///
/// # Errors
///
/// Missing keys; a mount that does not exist or does not move by itself.
pub(crate) fn add_sensors(
    document: &Document,
    scene: &mut AssemblyScene,
) -> Result<(), SceneError> {
    refuse_nameless(document)?;
    for name in document.names("sensor") {
        if scene.housing_method() == Some(HousingMethod::QuasiStatic) {
            let reason = "a quasi-static sequence has no accelerations and no moving cage";
            let advice = "leave it out, or write method = \"reduced\" or \"explicit\" in [housing]";
            let problem = Problem::refused(reason, advice);
            return Err(document.error_of_name("sensor", name, problem));
        }
        let sensor = sensor(document, name, scene)?;
        scene.sensors.push(sensor);
    }
    Ok(())
}

/// Refuses sensors without a moving bearing.
pub(crate) fn refuse_sensors(document: &Document) -> Result<(), SceneError> {
    refuse_nameless(document)?;
    let Some(name) = document.names("sensor").next() else { return Ok(()) };
    let reason = "a sensor is for bearings and the bodies under them";
    let advice = "record places of a solid with [[solid.probe]]";
    Err(document.error_of_name("sensor", name, Problem::refused(reason, advice)))
}

fn refuse_nameless(document: &Document) -> Result<(), SceneError> {
    if document.names("sensor").next().is_none() && document.first_below("sensor").is_some() {
        return Err(document.refused("sensor", "a sensor has a name", "write [sensor.NAME]"));
    }
    Ok(())
}

fn sensor(
    document: &Document,
    name: &str,
    scene: &mut AssemblyScene,
) -> Result<SceneSensor, SceneError> {
    let scoped = document.scoped(name);
    let mut reader = Reader::new(&scoped);
    let of_telemeter = match reader.choice_if_given("sensor.kind") {
        Some(kind) => kind == SENSORS[1],
        None => return Err(reader.missing("sensor.kind", "")),
    };
    let others: &[&str] = if of_telemeter { &OF_AN_ACCELEROMETER } else { &OF_A_TELEMETER };
    let mut others = others.iter().map(|key| format!("sensor.{key}"));
    if let Some(other) = others.find(|key| reader.is_given(key)) {
        let kind = SENSORS[usize::from(of_telemeter)];
        let reason = format!("not of kind = \"{kind}\"");
        let advice = "leave it out, or write the other kind of sensor";
        return Err(scoped.refused(&other, reason, advice));
    }
    let kind = match of_telemeter {
        true => telemeter(&mut reader, scene)?,
        false => accelerometer(&mut reader, scene)?,
    };
    reader.note_named(&mut scene.defaults_used);
    Ok(SceneSensor { name: name.into(), kind })
}

fn accelerometer(
    reader: &mut Reader,
    scene: &AssemblyScene,
) -> Result<SceneSensorKind, SceneError> {
    let Some(on) = text(reader.document, "sensor.on") else {
        return Err(reader.missing("sensor.on", " for an accelerometer"));
    };
    let places = places(scene);
    let Some((_, at)) = places.iter().find(|(name, _)| *name == on) else {
        return Err(reader.document.error("sensor.on", no_such_place(&on, &places)));
    };
    if let SensorAt::Body(body) = at
        && scene.bodies[*body].beam.is_some()
    {
        let reason = format!("{on} is flexible: an accelerometer is mounted on a rigid body");
        let advice = "record its sections with `probe` in its beam, or put the sensor on a race or a housing's race";
        return Err(reader.document.refused("sensor.on", reason, advice));
    }
    let mut number = |key: &str| reader.number(key).unwrap_or(0.0);
    let (along, radius) = (number("sensor.at"), number("sensor.radius"));
    let angle = number("sensor.angle");
    let direction = reader.choice("sensor.direction");
    let direction = Direction::ALL.into_iter().find(|of| Some(of.name()) == direction);
    let direction = direction.unwrap_or(Direction::Radial);
    Ok(SceneSensorKind::Accelerometer { at: *at, along, radius, angle, direction })
}

/// Mounts of sensors, by their names in scenes.
fn places(scene: &AssemblyScene) -> Vec<(String, SensorAt)> {
    let mut places: Vec<SensorAt> = (0..scene.bodies.len()).map(SensorAt::Body).collect();
    for (bearing, placed) in scene.bearings.iter().enumerate() {
        let dynamics = &placed.scene.dynamics;
        let moves = [true, dynamics.outer.is_some() || placed.housing.is_some()];
        for side in 0..2 {
            if moves[side] && matches!(placed.carriers[side], Carrier::Own { .. }) {
                places.push(SensorAt::Race { bearing, side });
            }
        }
        if matches!(dynamics.cage, CageInRun::Body(_)) {
            places.push(SensorAt::Cage(bearing));
        }
    }
    places.into_iter().map(|at| (scene.name_of_place(at), at)).collect()
}

fn no_such_place(on: &str, places: &[(String, SensorAt)]) -> Problem {
    let known: Vec<&str> = places.iter().map(|(name, _)| name.as_str()).collect();
    let advice = match nearest(on, known.iter().copied(), 0.5) {
        Some(nearest) => format!("did you mean {nearest}?"),
        None => "write one of them; an outer race is one where it moves by itself".into(),
    };
    let reason = format!("{on:?} is no mount of a sensor; mounts are: {}", known.join(", "));
    Problem::refused(reason, advice)
}

fn telemeter(reader: &mut Reader, scene: &AssemblyScene) -> Result<SceneSensorKind, SceneError> {
    let names = || scene.bearings.iter().filter_map(|placed| placed.name.as_deref());
    let bearing = match text(reader.document, "sensor.bearing") {
        None if scene.bearings.len() == 1 => 0,
        None => return Err(reader.missing("sensor.bearing", " where there are several bearings")),
        Some(name) => match names().position(|other| other == name) {
            Some(bearing) => bearing,
            None => {
                let problem = no_such(&name, "bearing", names());
                return Err(reader.document.error("sensor.bearing", problem));
            }
        },
    };
    let cage = match &scene.bearings[bearing].scene.dynamics.cage {
        CageInRun::Body(cage) => cage,
        CageInRun::LeftOut(why) => {
            let reason = format!("a telemeter is mounted on a cage, and there is none: {why}");
            let advice = "give the bearing a cage with its mass, or leave the telemeter out";
            return Err(reader.document.refused("sensor.kind", reason, advice));
        }
    };
    let [inner, outer] = cage.contacts.ring;
    let mut number = |key: &str| reader.number(key).unwrap_or(0.0);
    let distance = number("sensor.distance");
    let offset = [number("sensor.offset"), number("sensor.offset_angle")];
    let runout = [number("sensor.runout"), number("sensor.runout_angle")];
    let (wire_radius, capacitance) = (number("sensor.wire_radius"), number("sensor.capacitance"));
    let given = |key: &str| reader.given_number(key);
    let radius = given("sensor.loop_radius").unwrap_or(0.5 * (inner + outer));
    let transceiver_radius = given("sensor.transceiver_radius").unwrap_or(radius);
    let natural = natural_frequency(radius, wire_radius, capacitance);
    let frequency = given("sensor.frequency").unwrap_or(natural);
    let copper = |radius: f64| copper_resistance(radius, wire_radius, frequency);
    let own = given("sensor.resistance").unwrap_or_else(|| copper(radius));
    let resistance = [own, copper(transceiver_radius)];
    let circuit =
        Telemeter { radius, transceiver_radius, wire_radius, capacitance, resistance, frequency };
    Ok(SceneSensorKind::Telemeter { bearing, circuit, distance, offset, runout })
}
