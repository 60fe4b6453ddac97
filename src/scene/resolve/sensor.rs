//! From the keys of sensors to their mounts and readings.

use crate::ch5_cage::telemeter::{Telemeter, copper_resistance, natural_frequency};
use crate::members::sensor::Acquisition;
use crate::numeric::clock::to_digits;
use crate::scene::build::assembly::{AssemblyScene, Carrier};
use crate::scene::build::sensors::{Direction, SceneSensor, SceneSensorKind, SensorAt};
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::{Reader, text};
use crate::scene::resolve::housing_scene::HousingMethod;
use crate::scene::resolve::resolved::CageInRun;
use crate::scene::resolve::shaft::beside;
use crate::scene::resolve::unused::refuse_unused;
use crate::scene::tables::keys::nearest;
use crate::scene::tables::sensor::SENSORS;
use crate::scene::text::document::Document;
use crate::scene::text::scopes::no_such;
use crate::scene::text::value::Checked;

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
            let reason = "a quasi-static sequence has no accelerations and no moving cage. Hint: leave it out, or write method = \"reduced\" or \"explicit\" in [housing]";
            let problem = Problem::refused(reason);
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
    let reason = "a sensor is for bearings and the bodies under them. Hint: record places of a solid with [[solid.probe]]";
    Err(document.error_of_name("sensor", name, Problem::refused(reason)))
}

fn refuse_nameless(document: &Document) -> Result<(), SceneError> {
    if document.names("sensor").next().is_none() && document.first_below("sensor").is_some() {
        return Err(document.refused("sensor", "a sensor has a name. Hint: write [sensor.NAME]"));
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
    refuse_unused(&scoped, &["sensor"])?;
    let of_telemeter = match reader.choice_if_given("sensor.kind") {
        Some(kind) => kind == SENSORS[1],
        None => return Err(reader.missing("sensor.kind", "")),
    };
    let kind = match of_telemeter {
        true => telemeter(&mut reader, scene)?,
        false => accelerometer(&mut reader, scene)?,
    };
    let acquisition = acquisition(&mut reader, scene)?;
    reader.note_named(&mut scene.defaults_used);
    Ok(SceneSensor { name: name.into(), kind, acquisition })
}

/// Sampling, filter and envelope of a sensor, checked against the rate of the output rows.
fn acquisition(reader: &mut Reader, scene: &AssemblyScene) -> Result<Acquisition, SceneError> {
    let rows = scene.run().map_or(f64::INFINITY, |run| 1.0 / run.output_interval);
    let [sampling, low_pass] =
        ["sensor.sampling", "sensor.low_pass"].map(|key| reader.given_number(key));
    let refuse = |key: &str, reason: String| Err(reader.document.refused(key, reason));
    let hertz = |frequency: f64| format!("{} Hz", to_digits(frequency, 6));
    if let Some(rate) = sampling.filter(|rate| *rate > rows * (1.0 + 1e-9)) {
        let reason = format!(
            "{} is faster than the output rows, {}. Hint: sample more slowly, or shorten numerics.output_interval",
            hertz(rate),
            hertz(rows)
        );
        return refuse("sensor.sampling", reason);
    }
    if let Some(cut_off) = low_pass.filter(|cut_off| *cut_off >= 0.5 * rows) {
        let half = hertz(0.5 * rows);
        let reason = format!(
            "{} is not below half the rate of the output rows, {half}. Hint: filter lower, or shorten numerics.output_interval",
            hertz(cut_off)
        );
        return refuse("sensor.low_pass", reason);
    }
    let envelope_band = match reader.document.value("sensor.envelope_band") {
        Some(Checked::Quantities(band)) => match band[..] {
            [low, high] if high <= 0.5 * sampling.unwrap_or(rows) => Some([low, high]),
            [_, high] => {
                let half = hertz(0.5 * sampling.unwrap_or(rows));
                let reason = format!(
                    "{} is above half the sampling rate, {half}. Hint: choose a lower band, or sample faster",
                    hertz(high)
                );
                return refuse("sensor.envelope_band", reason);
            }
            _ => {
                let reason = format!(
                    "a band has two frequencies, not {}. Hint: write envelope_band = [\"1 kHz\", \"4 kHz\"]",
                    band.len()
                );
                return refuse("sensor.envelope_band", reason);
            }
        },
        _ => None,
    };
    Ok(Acquisition { sampling, low_pass, envelope_band })
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
    if matches!(at, SensorAt::Housing(_)) && scene.housing_method() != Some(HousingMethod::Reduced)
    {
        let reason = "an accelerometer on a housing needs its modes. Hint: write method = \"reduced\" in [housing], or put the sensor on the outer race";
        return Err(reader.document.refused("sensor.on", reason));
    }
    let mut number = |key: &str| reader.number(key);
    let (along, radius) = (number("sensor.at"), number("sensor.radius"));
    let angle = number("sensor.angle");
    if let SensorAt::Body(body) = at
        && let Some(beam) = &scene.bodies[*body].beam
    {
        if beam.in_elements.is_some() {
            let reason = format!(
                "{on} is stepped in elements, which carry no accelerometer. Hint: record its sections with `probe`, or write method = \"reduced\" in its beam.mesh"
            );
            return Err(reader.document.refused("sensor.on", reason));
        }
        let ends = [beam.start, beam.start + beam.beam.length()];
        if let Some(problem) = beside(along, ends, &on) {
            return Err(reader.document.error("sensor.at", problem));
        }
    }
    let direction = direction(reader);
    Ok(SceneSensorKind::Accelerometer { at: *at, along, radius, angle, direction })
}

fn direction(reader: &mut Reader) -> Direction {
    match reader.choice("sensor.direction") {
        "fixed" => {
            let [azimuth, elevation] = ["sensor.azimuth", "sensor.elevation"]
                .map(|key| reader.given_number(key).unwrap_or_default());
            reader.follow("sensor.azimuth", azimuth);
            reader.follow("sensor.elevation", elevation);
            Direction::Fixed { azimuth, elevation }
        }
        "tangential" => Direction::Tangential,
        "axial" => Direction::Axial,
        _ => Direction::Radial,
    }
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
        if placed.housing.is_some() {
            places.push(SensorAt::Housing(bearing));
        }
    }
    places.into_iter().map(|at| (scene.name_of_place(at), at)).collect()
}

fn no_such_place(on: &str, places: &[(String, SensorAt)]) -> Problem {
    let known: Vec<&str> = places.iter().map(|(name, _)| name.as_str()).collect();
    let hint = match nearest(on, known.iter().copied(), 0.5) {
        Some(nearest) => format!("did you mean {nearest}?"),
        None => "write one of them; an outer race is one where it moves by itself".into(),
    };
    let mounts = known.join(", ");
    Problem::refused(format!("{on:?} is no mount of a sensor; mounts are: {mounts}. Hint: {hint}"))
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
            let reason = format!(
                "a telemeter is mounted on a cage, and there is none: {why}. Hint: give the bearing a cage with its mass, or leave the telemeter out"
            );
            return Err(reader.document.refused("sensor.kind", reason));
        }
    };
    let [inner, outer] = cage.contacts.ring;
    let mut number = |key: &str| reader.number(key);
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
    reader.follow("sensor.loop_radius", radius);
    reader.follow("sensor.transceiver_radius", transceiver_radius);
    reader.follow("sensor.frequency", frequency);
    reader.follow("sensor.resistance", own);
    let circuit =
        Telemeter { radius, transceiver_radius, wire_radius, capacitance, resistance, frequency };
    Ok(SceneSensorKind::Telemeter { bearing, circuit, distance, offset, runout })
}
