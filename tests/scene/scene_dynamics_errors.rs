//! Malformed scenes of bearings in motion: one message each, with line, allowed range or hint.

use bearing_dynamics::scene;
use bearing_dynamics::scene::Format;
use std::fmt::Write as _;

/// A correct scene; every case below changes one line of it.
const GOOD: &str = r#"[bearing]
kind = "angular-contact"
balls = 11
pitch_radius = "30 mm"
contact_angle = "35 deg"
inner_race = { groove_radius = "6.6 mm", shoulder_radius = "26.3 mm" }
outer_race = { groove_radius = "6.6 mm" }
ball.radius = "5.953 mm"
[bearing.cage]
pocket_radius = "6.5 mm"
inner_radius = "29.125 mm"
outer_radius = "33.375 mm"
pocket_pitch_radius = "30 mm"
race_clearance = "0.2 mm"
mass = "0.069 kg"
guidance = "outer-race"
contact = { law = "penalty", stiffness = "2e8 N/m" }
friction = 0.1
inertia = { axial = "6.8e-5 kg m^2", transverse = "3.6e-5 kg m^2" }
[inner_race]
x = { displacement = "7 um" }
y = { load = { table = [["0 s", "0 N"], ["0.1 s", "250 N"]] } }
z = { load = { ramp = ["0 N", "250 N"], start = "0 s", duration = "0.1 s" } }
tilt_y = { tilt = { amplitude = "1 deg", mean = "1 deg", frequency = "50 Hz" } }
tilt_z = { moment = { half_sine = "1 N m", duration = "5 ms" } }
speed = { smooth_ramp = ["0 rpm", "600 rpm"], duration = "0.3 s" }
inertia = { mass = "0.2 kg", axial = "1e-4 kg m^2", transverse = "6e-5 kg m^2" }
rotating_load = { force = "250 N", speed = "50 rpm" }
unbalance = "900 g mm"
[outer_race]
motion = "5-dof"
x = { load = "-445 N" }
foundation.stiffness = { y = "1e8 N/m", tilt_y = "1e4 N m/rad" }
[traction]
law = "slide-to-roll"
b = 22.28
slices = 15
[contact_damping]
law = "hunt-crossley"
alpha = "0.1 s/m"
[numerics]
end = "0.1 s"
step = "1 us"
output_interval = "0.1 ms"
[output]
window_start = "50 ms"
"#;

/// Name, what is replaced by what, line, what the message must contain.
type Case = (&'static str, &'static str, &'static str, usize, &'static [&'static str]);

#[rustfmt::skip]
const CASES: &[Case] = &[
    ("no duration", r#"start = "0 s", duration = "0.1 s""#, r#"start = "0 s""#, 23,
        &["inner_race.z.load.duration: missing", "duration = \"0.1 s\""]),
    ("duration of nothing", r#"start = "0 s", duration = "0.1 s""#, r#"duration = "0 s""#, 23,
        &["inner_race.z.load.duration", "more than 0 s to 10000 s", "takes time"]),
    ("duration without unit", r#"start = "0 s", duration = "0.1 s""#, r#"duration = 0.1"#, 23, &["has no unit", "ms, us"]),
    ("duration in metres", r#"start = "0 s", duration = "0.1 s""#, r#"duration = "0.1 m""#, 23,
        &["unit of length", "a time"]),
    ("start before the run", r#"start = "0 s","#, r#"start = "-1 s","#, 23, &["from 0 s to 10000 s", "counted from the start"]),
    ("profile of another dimension", r#"ramp = ["0 N", "250 N"]"#, r#"ramp = ["0 N", "250 rpm"]"#, 23,
        &["inner_race.z.load.ramp", "unit of rotation speed", "a force"]),
    ("a ramp to nowhere", r#"ramp = ["0 N", "250 N"]"#, r#"ramp = ["0 N"]"#, 23, &["a list of two values", "a list of 1"]),
    ("a ramp that is no list", r#"ramp = ["0 N", "250 N"]"#, r#"ramp = "250 N""#, 23, &["a list of two values", "250 N"]),
    ("misspelt profile", r#"ramp = ["0 N", "250 N"]"#, r#"rmap = ["0 N", "250 N"]"#, 23,
        &["inner_race.z.load.rmap: unknown key", "did you mean `ramp`"]),
    ("misspelt entry of a profile", r#"duration = "0.3 s""#, r#"durration = "0.3 s""#, 26,
        &["inner_race.speed.durration", "did you mean `duration`"]),
    ("entry of another profile", r#"duration = "0.3 s""#, r#"duration = "0.3 s", frequency = "1 Hz""#, 26,
        &["inner_race.speed.frequency: unknown key", "smooth_ramp, start, duration"]),
    ("two profiles in one", r#"ramp = ["0 N", "250 N"], start"#, r#"ramp = ["0 N", "250 N"], half_sine = "1 N", start"#, 23,
        &["together with `ramp`", "of one kind"]),
    ("profile of no kind", r#"ramp = ["0 N", "250 N"], start"#, "start", 23,
        &["nothing says what kind of profile", "`ramp` or `smooth_ramp`"]),
    ("empty profile", r#"{ half_sine = "1 N m", duration = "5 ms" }"#, "{}", 25, &["nothing says what kind of profile"]),
    ("ramp of texts", r#"ramp = ["0 N", "250 N"]"#, r#"ramp = ["0 N", true]"#, 23, &["a force with its unit", "true"]),
    ("times that go back", r#"["0.1 s", "250 N"]"#, r#"["0 s", "250 N"]"#, 22,
        &["inner_race.y.load.table", "strictly increasing"]),
    ("table of one point", r#"[["0 s", "0 N"], ["0.1 s", "250 N"]]"#, r#"[["0 s", "0 N"]]"#, 22, &["two or more pairs", "a list of 1"]),
    ("point of three values", r#"["0.1 s", "250 N"]"#, r#"["0.1 s", "250 N", "1 N"]"#, 22, &["a pair of time and value", "a list of 3"]),
    ("time and value exchanged", r#"["0.1 s", "250 N"]"#, r#"["250 N", "0.1 s"]"#, 22, &["unit of force", "a time"]),
    ("profile out of range", r#""250 N"], start"#, r#""250e9 N"], start"#, 23, &["outside the allowed range", "1e9 N"]),
    ("frequency of zero", "\"50 Hz\"", "\"0 Hz\"", 24, &["more than 0 Hz", "a frequency is positive"]),
    ("frequency as a speed", "\"50 Hz\"", "\"50 rpm\"", 24, &["unit of rotation speed", "a frequency"]),
    ("amplitude and mean too large", r#"mean = "1 deg""#, r#"mean = "4.5 deg""#, 24,
        &["inner_race.tilt_y.tilt.amplitude", "reach together", "from -5 deg to 5 deg"]),
    ("mean too low for its amplitude", r#"mean = "1 deg""#, r#"mean = "-4.5 deg""#, 24,
        &["inner_race.tilt_y.tilt.amplitude", "reach together", "from -5 deg to 5 deg"]),
    ("displacement beyond a ball", r#"x = { displacement = "7 um" }"#, r#"x = { displacement = { ramp = ["0 mm", "7 mm"], duration = "1 s" } }"#, 21,
        &["inner_race.x.displacement", "more than a ball radius"]),
    ("profile where none may be", "unbalance = \"900 g mm\"", r#"unbalance = { ramp = ["0 g mm", "1 g mm"], duration = "1 s" }"#, 29,
        &["expected an unbalance with its unit", "a table"]),
    ("speed and torque", r#"unbalance = "900 g mm""#, r#"torque = "1 N m""#, 29, &["inner_race.torque", "together with `inner_race.speed`"]),
    ("rotating load without speed", r#", speed = "50 rpm""#, "", 28, &["inner_race.rotating_load.speed: missing", "50 rpm"]),
    ("unbalance in kg", "\"900 g mm\"", "\"0.9 kg\"", 29, &["unit of mass", "an unbalance", "g mm"]),
    ("negative unbalance", "\"900 g mm\"", "\"-900 g mm\"", 29, &["from 0 kg m"]),
    ("massless race", r#"mass = "0.2 kg""#, r#"mass = "0 kg""#, 27, &["more than 0 kg", "positive mass"]),
    ("inertia without mass", r#"{ mass = "0.2 kg", axial"#, "{ axial", 27, &["inner_race.inertia.mass: missing"]),
    ("inertias exchanged by a factor", r#"transverse = "6e-5 kg m^2" }"#, r#"transverse = "6e-6 kg m^2" }"#, 27,
        &["more than twice", "no body has", "exchanged"]),
    ("more unbalance than there is inertia", r#"speed = { smooth_ramp = ["0 rpm", "600 rpm"], duration = "0.3 s" }
inertia = { mass = "0.2 kg", axial = "1e-4 kg m^2", transverse = "6e-5 kg m^2" }
rotating_load = { force = "250 N", speed = "50 rpm" }
unbalance = "900 g mm""#, r#"torque = "1 N m"
inertia = { mass = "0.2 kg", axial = "1e-4 kg m^2", transverse = "6e-5 kg m^2" }
rotating_load = { force = "250 N", speed = "50 rpm" }
unbalance = "9000 g mm""#, 29, &["inner_race.unbalance", "more than a body of 0.2 kg can have", "less than 4.4721e-3 kg m", "units"]),
    ("shoulder under the groove", "\"26.3 mm\"", "\"23 mm\"", 6, &["bearing.inner_race.shoulder_radius", "more than the groove bottom's radius"]),
    ("shoulder over the balls", "\"26.3 mm\"", "\"31 mm\"", 6, &["less than the pitch radius", "30 mm"]),
    ("unknown motion", "\"5-dof\"", "\"5dof\"", 31, &["unknown value", "did you mean `5-dof`"]),
    ("load on a fixed race", "motion = \"5-dof\"\n", "motion = \"fixed\"\n", 32, &["outer_race.x.load: refused: the outer race is fixed", "5-dof"]),
    ("position and load", r#"x = { load = "-445 N" }"#, r#"x = { load = "-445 N", displacement = "1 um" }"#, 32,
        &["together with `outer_race.x.load`"]),
    ("negative spring", "\"1e8 N/m\"", "\"-1e8 N/m\"", 33, &["from 0 N/m", "holds back"]),
    ("spring in the unit of a tilting one", "\"1e8 N/m\"", "\"1e8 N m/rad\"", 33, &["unit of tilting stiffness", "a stiffness"]),
    ("unknown traction law", "\"slide-to-roll\"", "\"slide-to-rol\"", 35, &["did you mean `slide-to-roll`"]),
    ("key of another law", "b = 22.28", "coefficient = 0.05", 36, &["traction.coefficient: refused", "law = \"constant\""]),
    ("law without its coefficient", "law = \"slide-to-roll\"\nb = 22.28", "law = \"constant\"\n", 34, &["traction.coefficient: missing", "[traction]"]),
    ("friction of three", "law = \"slide-to-roll\"\nb = 22.28", "law = \"constant\"\ncoefficient = 3", 36, &["from 0 to 2", "0.05 to 0.2"]),
    ("curve in the wrong unit", "b = 22.28", "b = \"22.28 s/m\"", 36, &["traction.b: refused", "plain number"]),
    ("slope as a length", "b = 22.28", "b = \"22.28 mm\"", 36, &["expected a plain number", "or an inverse speed"]),
    ("curve that rises too far", "b = 22.28", "b = 22280", 36, &["rises to", "up to 2"]),
    ("no slice", "slices = 15", "slices = 0", 37, &["from 1 to 201"]),
    ("202 slices", "slices = 15", "slices = 202", 37, &["from 1 to 201", "45 within 0.06 %"]),
    ("points of another law", "slices = 15", "points = [[\"1 m/s\", 0.1]]", 37, &["traction.points: refused", "law = \"table\""]),
    ("friction at rest", "law = \"slide-to-roll\"\nb = 22.28", "law = \"table\"\npoints = [[\"0 m/s\", 0.1]]", 36, &["friction at rest has no direction"]),
    ("speeds that go back", "law = \"slide-to-roll\"\nb = 22.28", "law = \"table\"\npoints = [[\"1 m/s\", 0.1], [\"1 m/s\", 0.1]]", 36, &["strictly increasing"]),
    ("no points", "law = \"slide-to-roll\"\nb = 22.28", "law = \"table\"\npoints = []", 36, &["a list of pairs", "an empty list"]),
    ("damping without its coefficient", "alpha = \"0.1 s/m\"\n", "", 38, &["contact_damping.alpha: missing", "hunt-crossley"]),
    ("restitution above one", "law = \"hunt-crossley\"\nalpha = \"0.1 s/m\"", "law = \"lankarani-nikravesh\"\nrestitution = 1.1", 40, &["more than 0 to 1", "without loss"]),
    ("Hertz stiffness for a penalty", "\"2e8 N/m\"", "\"2e8 N/m^1.5\"", 17, &["`penalty` takes a stiffness in N/m"]),
    ("Hertz law without stiffness", r#"law = "penalty", stiffness = "2e8 N/m""#, r#"law = "hertz""#, 17, &["bearing.cage.contact.stiffness: missing", "N/m^1.5"]),
    ("cage friction with a unit", "friction = 0.1", "friction = \"0.1 N\"", 18, &["a plain number", "from 0 to 2"]),
    ("half an inertia", r#"{ axial = "6.8e-5 kg m^2", transverse"#, "{ transverse", 19, &["bearing.cage.inertia.axial: missing"]),
    ("pockets far from the balls", "pocket_pitch_radius = \"30 mm\"", "pocket_pitch_radius = \"40 mm\"", 13, &["less than the pitch radius plus a ball radius"]),
    ("endless run", "end = \"0.1 s\"", "end = \"20000 s\"", 42, &["more than 0 s to 10000 s"]),
    ("run of no time", "end = \"0.1 s\"", "end = \"0 s\"", 42, &["more than 0 s"]),
    ("step of a second", "\"1 us\"", "\"1 s\"", 43, &["from 1e-12 s to 0.01 s", "follow from an accuracy"]),
    ("step and fraction", "output_interval = \"0.1 ms\"", "step_fraction = 0.5", 44, &["together with `numerics.step`"]),
    ("output after the end", "\"0.1 ms\"", "\"0.2 s\"", 44, &["numerics.output_interval", "0.2 s", "after the end", "up to 0.1 s"]),
    ("window at the end", "\"50 ms\"", "\"100 ms\"", 46, &["output.window_start", "less than 0.1 s"]),
    ("unknown integrator", "output_interval = \"0.1 ms\"", "integrator = \"rk5\"", 44, &["did you mean `rk4`"]),
    ("channels in one text", "window_start = \"50 ms\"", "channels = \"cage\"", 46, &["a list out of", "\"races\"", "\"energy\""]),
    ("misspelt channels", "window_start = \"50 ms\"", "channels = [\"races\", \"lodas\"]", 46, &["output.channels", "did you mean `loads`", "orbits"]),
    ("column for a group of channels", "window_start = \"50 ms\"", "channels = [\"ball_1_inner_load\"]", 46, &["output.channels", "forces"]),
    ("misspelt table", "[contact_damping]", "[contact_dampng]", 38, &["did you mean `contact_damping`"]),
    ("accuracy without an error estimate", "step = \"1 us\"", "integrator = \"rk4\"\naccuracy = 1e-3", 44, &["numerics.accuracy", "rk4 has no estimate", "rosenbrock"]),
    ("accuracy out of range", "step = \"1 us\"", "accuracy = 0.5", 43, &["numerics.accuracy", "from 1e-8 to 0.1"]),
    ("accuracy and step", "output_interval = \"0.1 ms\"", "accuracy = 1e-3", 44, &["numerics.accuracy", "numerics.step"]),
    ("limit of another integrator", "step = \"1 us\"", "integrator = \"rosenbrock\"\nstep_fraction = 0.5", 44, &["numerics.step_fraction", "that of rk4"]),
];

#[test]
fn the_scene_that_the_cases_change_is_correct() {
    let scene = scene::read_str(GOOD, Format::Toml, "good").unwrap();
    scene::build::motion::dynamic_problem(&scene).unwrap();
}

#[test]
fn every_malformed_scene_has_one_clear_message() {
    let mut all = String::new();
    let mut faults = Vec::new();
    for (name, from, to, line, contains) in CASES {
        assert_eq!(GOOD.matches(from).count(), 1, "{from:?} is not unique");
        let text = GOOD.replacen(from, to, 1);
        let message = match scene::read_str(&text, Format::Toml, "scene.toml") {
            Ok(_) => "accepted".to_string(),
            Err(error) => error.to_string(),
        };
        writeln!(all, "{name}\n    {message}\n").unwrap();
        let place = format!("scene.toml:{line}:");
        let complete = message.starts_with(&place)
            && contains.iter().all(|part| message.contains(part))
            && (message.contains("Hint: ") || message.contains("Allowed: "))
            && message.len() <= 500
            && !message.contains('\n');
        if !complete {
            faults.push(format!("{name} (line {line}, {contains:?}):\n    {message}"));
        }
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
    insta::assert_snapshot!("messages", all);
}
