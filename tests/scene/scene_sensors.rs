//! Sensors: what they sit on, what they need, and what is refused.

use bearing_dynamics::ch5_cage::telemeter::{copper_resistance, natural_frequency};
use bearing_dynamics::members::sensor::{SensorKind, SensorMount};
use bearing_dynamics::scene::build::sensors::{Direction, SceneSensorKind, SensorAt};
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};

const CAGED: &str = include_str!("../../scenes/cage_telemeter.toml");
const SHAFT: &str = include_str!("../../scenes/shaft_in_two_housings.toml");
const STEPPED: &str = include_str!("../../scenes/stepped_rotor.toml");
const QUASI_STATIC: &str = include_str!("../../scenes/housing_c_tet10.toml");
const IN_ELEMENTS: &str = include_str!("../../scenes/rotor_in_elements.toml");
const EXPLICIT: &str = include_str!("../../scenes/housing_impact.toml");
const SOLID: &str = include_str!("../../scenes/cantilever.toml");

fn understood(text: &str) -> Result<Subject, String> {
    let document = Document::read_str(text, Format::Toml, "scene.toml");
    document.and_then(|document| resolve_subject(&document)).map_err(|error| error.to_string())
}

/// The scene without its sensors, and with these.
fn with(scene: &str, sensors: &str) -> Result<Subject, String> {
    let mut text = scene.to_string();
    if let (Some(first), Some(end)) = (text.find("[sensor."), text.find("[numerics]")) {
        text.replace_range(first..end, "");
    }
    understood(&format!("{text}\n{sensors}\n"))
}

#[test]
fn a_telemeter_fills_what_it_is_not_told() {
    let Ok(Subject::Assembly(scene)) = understood(CAGED) else { panic!("no bearing") };
    let [telemeter, top] = &scene.sensors[..] else { panic!("{:?}", scene.sensors) };
    let SceneSensorKind::Telemeter { bearing, circuit, distance, offset, runout } = telemeter.kind
    else {
        panic!("{telemeter:?}")
    };
    assert_eq!((bearing, distance, offset, runout), (0, 3e-3, [1.27e-3, 0.0], [1e-4, 0.0]));
    // Half way between 29.125 and 33.375 mm.
    assert!(
        (circuit.radius - 31.25e-3).abs() <= 1e-12 && circuit.transceiver_radius == circuit.radius
    );
    assert_eq!((circuit.wire_radius, circuit.capacitance), (0.15e-3, 100e-12));
    let natural = natural_frequency(circuit.radius, 0.15e-3, 100e-12);
    assert_eq!(circuit.frequency, natural);
    assert_eq!(circuit.resistance, [copper_resistance(circuit.radius, 0.15e-3, natural); 2]);
    let SceneSensorKind::Accelerometer { at, radius, direction, .. } = top.kind else {
        panic!("{top:?}")
    };
    assert_eq!((at, radius), (SensorAt::Race { bearing: 0, side: 1 }, 39.6e-3));
    assert_eq!(direction, Direction::Radial);
    // At the top, upwards.
    let assembly = scene.assembly().unwrap();
    let SensorKind::Accelerometer(of) = &assembly.sensors[1].kind else { panic!("{assembly:?}") };
    assert_eq!(of.mount, SensorMount::Body(assembly.bearings[0].mounts[1].body));
    let [x, y, z] = of.place;
    assert!(x == 0.0 && y.abs() <= 1e-17 && z == 39.6e-3, "{:?}", of.place);
    assert!(of.direction[2] == 1.0 && of.direction[1].abs() <= 1e-15);
    assert_eq!(assembly.sensors[1].column(), ("top_acceleration".to_string(), "m/s^2"));
}

/// Places and directions are the scene's, whichever way round the bearing is put in.
#[test]
fn a_sensor_on_the_cage_of_a_reversed_bearing_counts_as_the_scene_does() {
    let sensors = "[sensor.a]\nkind = \"accelerometer\"\non = \"cage\"\nat = \"13 mm\"\nradius = \"30 mm\"\n\
                   direction = \"tangential\"";
    let reversed =
        CAGED.replace("kind = \"angular-contact\"", "kind = \"angular-contact\"\nreversed = true");
    for (scene, turned) in [(CAGED, 1.0), (&reversed, -1.0)] {
        let Ok(Subject::Assembly(scene)) = with(scene, sensors) else { panic!("refused") };
        let assembly = scene.assembly().unwrap();
        let SensorKind::Accelerometer(of) = &assembly.sensors[0].kind else { panic!() };
        assert_eq!(of.place, [turned * 13e-3, turned * 30e-3, 0.0]);
        assert!(of.direction[2] == 1.0 && of.direction[1] == 0.0, "{:?}", of.direction);
    }
}

#[test]
fn a_sensor_that_cannot_be_is_refused() {
    let on = |place: &str| format!("[sensor.a]\nkind = \"accelerometer\"\non = \"{place}\"");
    let telemeter = "[sensor.t]\nkind = \"telemeter\"";
    let fixed = CAGED
        .replace("motion = \"5-dof\"\nx = { load = \"-445 N\" }", "")
        .replace("[outer_race.foundation.stiffness]\nx = \"1e8 N/m\"\ny = \"1e8 N/m\"\nz = \"1e8 N/m\"\ntilt_y = \"1e5 N m/rad\"\ntilt_z = \"1e5 N m/rad\"", "")
        .replace("[outer_race.foundation.damping]\nx = \"1200 N s/m\"\ny = \"1200 N s/m\"\nz = \"1200 N s/m\"\ntilt_y = \"1 N m s/rad\"\ntilt_z = \"1 N m s/rad\"", "");
    for (scene, sensors, words) in [
        (CAGED, "[sensor]\nkind = \"telemeter\"", &["sensor", "write [sensor.NAME]"][..]),
        (CAGED, "[sensor.a]\non = \"cage\"", &["sensor.a.kind", "missing"]),
        (CAGED, "[sensor.a]\nkind = \"accelerometer\"", &["sensor.a.on", "missing"]),
        (CAGED, &on("outer_rase"), &["inner_race, outer_race, cage", "did you mean outer_race?"]),
        (&fixed, &on("outer_race"), &["mounts are: inner_race, cage"]),
        (
            CAGED,
            &format!("{}\noffset = \"1 mm\"", on("cage")),
            &["sensor.a.offset", "only with `kind = \"telemeter\"`"],
        ),
        (
            CAGED,
            &format!("{telemeter}\nangle = \"3 deg\""),
            &["sensor.t.angle", "only with `kind = \"accelerometer\"`"],
        ),
        (
            CAGED,
            &format!("{telemeter}\nbearing = \"left\""),
            &["sensor.t.bearing", "there is no bearing \"left\""],
        ),
        (
            CAGED,
            &format!("{telemeter}\ndistance = \"0 mm\""),
            &["sensor.t.distance", "more than 0 mm"],
        ),
        (CAGED, &format!("{telemeter}\ncapacitance = \"100 uH\""), &["sensor.t.capacitance", "pF"]),
        (STEPPED, &format!("{}\nat = \"2 m\"", on("rotor")), &["sensor.a.at", "is not on rotor"]),
        (IN_ELEMENTS, &on("shaft"), &["sensor.a.on", "stepped in elements", "probe"]),
        (EXPLICIT, &on("housing"), &["sensor.a.on", "needs its modes", "method = \"reduced\""]),
        (
            CAGED,
            &format!("{}\nazimuth = \"3 deg\"", on("cage")),
            &["sensor.a.azimuth", "direction = \"fixed\""],
        ),
        (
            CAGED,
            &format!("{}\nsampling = \"7 kHz\"", on("cage")),
            &["sensor.a.sampling", "faster than the output rows, 6666.67 Hz"],
        ),
        (
            CAGED,
            &format!("{}\nlow_pass = \"3.4 kHz\"", on("cage")),
            &["sensor.a.low_pass", "3333.33 Hz"],
        ),
        (
            CAGED,
            &format!("{}\nenvelope_band = [\"1 kHz\"]", on("cage")),
            &["sensor.a.envelope_band", "two frequencies, not 1"],
        ),
        (
            CAGED,
            &format!(
                "{}\nsampling = \"2 kHz\"\nenvelope_band = [\"0.5 kHz\", \"1.1 kHz\"]",
                on("cage")
            ),
            &["sensor.a.envelope_band", "above half the sampling rate, 1000 Hz"],
        ),
        (
            CAGED,
            &format!("{}\nenvelope_band = [\"2 kHz\", \"1 kHz\"]", on("cage")),
            &["sensor.a.envelope_band", "increas"],
        ),
        (SOLID, &on("a"), &["sensor.a", "[[solid.probe]]"]),
    ] {
        let said = with(scene, sensors).expect_err(sensors);
        assert!(words.iter().all(|word| said.contains(word)), "{sensors}: {said}");
    }
    // Equilibria have no accelerations.
    let said = with(QUASI_STATIC, &on("inner_race")).expect_err("quasi-static");
    assert!(said.contains("no accelerations"), "{said}");
    // A race in a bore moves.
    let Ok(Subject::Assembly(scene)) = with(SHAFT, &on("left.outer_race")) else {
        panic!("refused")
    };
    let SceneSensorKind::Accelerometer { at, .. } = scene.sensors[0].kind else { panic!() };
    assert_eq!(scene.name_of_place(at), "left.outer_race");
}

/// 0°, ±45° and 90° on the outer race, as in Fig. 5.31, and directions that stay.
#[test]
fn the_outer_race_carries_accelerometers_all_around() {
    let angles = [0.0f64, 45.0, -45.0, 90.0];
    let sensors: String = angles
        .into_iter()
        .enumerate()
        .map(|(i, angle)| {
            format!(
                "[sensor.s{i}]\nkind = \"accelerometer\"\non = \"outer_race\"\nradius = \"39.6 mm\"\nangle = \"{angle} deg\"\n\
                 [sensor.f{i}]\nkind = \"accelerometer\"\non = \"outer_race\"\ndirection = \"fixed\"\n\
                 azimuth = \"{angle} deg\"\nelevation = \"30 deg\"\n"
            )
        })
        .collect();
    let Ok(Subject::Assembly(scene)) = with(CAGED, &sensors) else { panic!("refused") };
    let assembly = scene.assembly().unwrap();
    let accelerometer = |name: String| {
        let of = assembly.sensors.iter().find(|of| of.name == name).unwrap();
        let SensorKind::Accelerometer(of) = &of.kind else { panic!("{of:?}") };
        of.clone()
    };
    for (i, angle) in angles.into_iter().enumerate() {
        let (sin, cos) = angle.to_radians().sin_cos();
        let near = |found: [f64; 3], expected: [f64; 3]| {
            assert!((0..3).all(|k| (found[k] - expected[k]).abs() <= 1e-15), "{angle}: {found:?}");
        };
        let radial = accelerometer(format!("s{i}"));
        near(radial.place, [0.0, 39.6e-3 * cos, 39.6e-3 * sin]);
        near(radial.direction, [0.0, cos, sin]);
        assert!(!radial.fixed);
        let fixed = accelerometer(format!("f{i}"));
        let out = 0.75f64.sqrt();
        near(fixed.direction, [0.5, out * cos, out * sin]);
        assert!(fixed.fixed);
    }
}

#[test]
fn a_sensor_on_a_flexible_shaft_is_on_its_section() {
    let sensors =
        "[sensor.a]\nkind = \"accelerometer\"\non = \"rotor\"\nat = \"50 mm\"\nradius = \"10 mm\"";
    let Ok(Subject::Assembly(scene)) = with(STEPPED, sensors) else { panic!("refused") };
    let assembly = scene.assembly().unwrap();
    let SensorKind::Accelerometer(of) = &assembly.sensors[0].kind else { panic!() };
    let SensorMount::Section(0, section) = &of.mount else { panic!("{of:?}") };
    let centre = assembly.bodies[assembly.shafts[0].body].rest[0];
    assert!((section.along + centre - 50e-3).abs() <= 1e-12, "{} {centre}", section.along);
    assert_eq!(of.place, [0.0, 10e-3, 0.0]);
}
