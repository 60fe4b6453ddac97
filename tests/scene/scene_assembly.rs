//! Scenes of several bearings: what is written where becomes what sits where.

use crate::assembly_common::BEARING;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::connection::{Law, MaxwellElement};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::statics::static_problem;
use bearing_dynamics::scene::{Document, Format, Scene, Subject, resolve, resolve_subject};
use std::f64::consts::{PI, TAU};

fn document(text: &str) -> Document {
    Document::read_str(text, Format::Toml, "test.toml").unwrap_or_else(|error| panic!("{error}"))
}

fn scene(text: &str) -> AssemblyScene {
    match resolve_subject(&document(text)) {
        Ok(Subject::Assembly(scene)) => *scene,
        Ok(_) => panic!("no assembly"),
        Err(error) => panic!("{error}"),
    }
}

fn assembly(text: &str) -> Assembly {
    scene(text).assembly().unwrap()
}

fn index(assembly: &Assembly, name: &str) -> usize {
    let found = assembly.bodies.iter().position(|body| body.name == name);
    found.unwrap_or_else(|| panic!("no {name} in {:?}", names(assembly)))
}

fn names(assembly: &Assembly) -> Vec<&str> {
    assembly.bodies.iter().map(|body| body.name.as_str()).collect()
}

/// A shaft and a hub that turn, a bearing between them the other way round, one from the shaft to an outer race of its
/// own, and a third the other way round on nothing but its own races.
const PLACED: &str = r#"
[bearing.left]
inner_on = "shaft"
inner_at = "-40 mm"
outer_on = "hub"
outer_at = "-35 mm"
reversed = true
[bearing.right]
inner_on = "shaft"
inner_at = "50 mm"
[outer_race.right]
x = "6 um"
[bearing.apart]
inner_on = "inner_race"
inner_at = "120 mm"
outer_at = "121 mm"
reversed = true
[inner_race.apart]
x = { displacement = "-3 um" }
z = { load = "-70 N" }
[outer_race.apart]
motion = "5-dof"
x = { displacement = { table = [["0 s", "1 um"], ["1 s", "2 um"]] } }
[body.shaft]
speed = "1000 rpm"
z = { load = "-500 N" }
unbalance = "2 kg mm"
rotating_load = { force = "12 N", speed = "50 rpm", phase = "30 deg" }
foundation = { stiffness = { y = "3e4 N/m", tilt_y = "7 N m/rad" }, damping = { y = "11 N s/m", tilt_y = "13 N m s/rad" } }
inertia = { mass = "0.67 kg", axial = "7.5e-5 kg m^2", transverse = "8.4e-4 kg m^2" }
[body.hub]
speed = "-200 rpm"
inertia = { mass = "2 kg", axial = "2e-3 kg m^2", transverse = "3e-3 kg m^2" }
[spring.one]
from = "shaft"
from_at = "20 mm"
stiffness = { x = "1 N/m", y = "2 N/m", z = "3 N/m", turn_x = "4 N m/rad", turn_y = "5 N m/rad", turn_z = "6 N m/rad" }
damping = { x = "7 N s/m", y = "8 N s/m", z = "9 N s/m", turn_x = "10 N m s/rad", turn_y = "11 N m s/rad", turn_z = "12 N m s/rad" }
[spring.other]
from = "shaft"
to = "hub"
from_at = "10 mm"
to_at = "45 mm"
damping = { z = "3 N s/m" }
[[spring.other.maxwell]]
relaxation_time = "20 ms"
x = "13 N/m"
turn_z = "14 N m/rad"
[[spring.other.maxwell]]
relaxation_time = "3 s"
y = "15 N/mm"
"#;

#[test]
fn every_race_sits_where_the_scene_puts_it() {
    let all = assembly(&[BEARING, PLACED].concat());
    let at = |name: &str| index(&all, name);
    let (shaft, hub) = (at("the body shaft"), at("the body hub"));
    let own = |race: &str, bearing: &str| at(&format!("the {race} race of bearing {bearing}"));
    let mount = |body, along, reversed| Mount { body, along, reversed };
    let expected = [
        ("left", [mount(shaft, -40e-3, true), mount(hub, -35e-3, true)]),
        ("right", [mount(shaft, 50e-3, false), mount(own("outer", "right"), 0.0, false)]),
        (
            "apart",
            [mount(own("inner", "apart"), 0.0, true), mount(own("outer", "apart"), 0.0, true)],
        ),
    ];
    for (bearing, (name, mounts)) in all.bearings.iter().zip(expected) {
        assert_eq!(bearing.name.as_deref(), Some(name));
        for (found, expected) in bearing.mounts.iter().zip(mounts) {
            assert_eq!((found.body, found.reversed), (expected.body, expected.reversed), "{name}");
            assert!((found.along - expected.along).abs() <= 1e-15, "{name}: {found:?}");
        }
    }
    // Races of their own stand where their bearing is, and what is said of them counts from there.
    let rest = |body: usize| all.bodies[body].rest[0];
    for (body, expected) in [
        (shaft, 0.0),
        (hub, 0.0),
        (own("outer", "right"), 50e-3 + 6e-6),
        (own("inner", "apart"), 120e-3),
        // Where its motion begins.
        (own("outer", "apart"), 121e-3 + 1e-6),
    ] {
        assert!(
            (rest(body) - expected).abs() <= 1e-15,
            "{}: {}",
            all.bodies[body].name,
            rest(body)
        );
    }
    let drive = |body: usize, axis: usize| &all.bodies[body].driven().unwrap().drives[axis];
    for (body, t, expected) in [
        (own("inner", "apart"), 0.0, 120e-3 - 3e-6),
        (own("outer", "apart"), 0.0, 121e-3 + 1e-6),
        (own("outer", "apart"), 0.5, 121e-3 + 1.5e-6),
    ] {
        let Drive::Motion(profile) = drive(body, 0) else { panic!("no motion along X") };
        assert!((profile.value(t) - expected).abs() <= 1e-15, "{}", profile.value(t));
    }
    assert_eq!(drive(own("inner", "apart"), 2), &Drive::Load(Profile::Constant(-70.0)));
    assert_eq!(drive(shaft, 2), &Drive::Load(Profile::Constant(-500.0)));
}

#[test]
fn bodies_and_springs_are_what_their_tables_say() {
    let all = assembly(&[BEARING, PLACED].concat());
    let [shaft, hub] = ["the body shaft", "the body hub"].map(|name| index(&all, name));
    let body = &all.bodies[shaft];
    let race = body.driven().unwrap();
    assert_eq!(
        (race.inertia.mass, race.inertia.axial, race.inertia.transverse),
        (0.67, 7.5e-5, 8.4e-4)
    );
    assert_eq!(race.foundation_stiffness, [0.0, 3e4, 0.0, 7.0, 0.0]);
    assert_eq!(race.foundation_damping, [0.0, 11.0, 0.0, 13.0, 0.0]);
    for (body, rpm) in [(shaft, 1000.0), (hub, -200.0)] {
        let Rotation::Speed(speed) = &all.bodies[body].driven().unwrap().rotation else {
            panic!("no speed")
        };
        assert!((speed.value(0.0) / (rpm * TAU / 60.0) - 1.0).abs() <= 1e-15);
    }
    assert!((body.unbalance / 2e-3 - 1.0).abs() <= 1e-15, "{}", body.unbalance);
    assert_eq!(all.bodies[hub].unbalance, 0.0);
    let turning = body.rotating_load.as_ref().unwrap().force(0.0);
    let expected = [0.0, 12.0 * (PI / 6.0).cos(), 12.0 * (PI / 6.0).sin()];
    for (found, expected) in turning.into_iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-14, "{turning:?}");
    }
    assert!(all.bodies[hub].rotating_load.is_none());
    let ground = index(&all, "the ground");
    let springs: Vec<_> = all
        .connections
        .iter()
        .map(|connection| {
            let Law::SpringDashpot(law) = &connection.law else { panic!("no spring") };
            (connection, law)
        })
        .collect();
    let [(one, law), (other, second)] = springs[..] else { panic!("two springs") };
    // An end of which nothing is said is beside the other one: nothing is stretched where bodies stand at the origin.
    let ends = |connection: &bearing_dynamics::members::connection::Connection| {
        connection.ends.map(|end| (end.body, (end.along * 1e6).round()))
    };
    assert_eq!(ends(one), [(shaft, 20e3), (ground, 20e3)]);
    assert_eq!(ends(other), [(shaft, 10e3), (hub, 45e3)]);
    assert_eq!(law.stiffness, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(law.damping, [7.0, 8.0, 9.0, 10.0, 11.0, 12.0]);
    assert_eq!((second.stiffness, second.damping), ([0.0; 6], [0.0, 0.0, 3.0, 0.0, 0.0, 0.0]));
    assert_eq!(law.maxwell, []);
    let element = |stiffness, relaxation_time| MaxwellElement { stiffness, relaxation_time };
    let elements = [
        element([13.0, 0.0, 0.0, 0.0, 0.0, 14.0], 0.02),
        element([0.0, 15e3, 0.0, 0.0, 0.0, 0.0], 3.0),
    ];
    assert_eq!(second.maxwell, elements);
    assert_eq!(law.rest, [0.0; 3]);
    assert!((second.rest[0] - 35e-3).abs() <= 1e-15 && second.rest[1..] == [0.0; 2], "{second:?}");
}

/// A bearing put in the other way round somewhere is the bearing after half a turn about Z, loads and all.
#[test]
fn a_bearing_elsewhere_the_other_way_round_is_the_one_after_half_a_turn() {
    let loads = |x: f64| {
        format!(
            "x = {{ load = \"{x} N\" }}\nz = {{ load = \"-300 N\" }}\ntilt_y = {{ moment = \"1 N m\" }}\n"
        )
    };
    let outer = "motion = \"5-dof\"\nfoundation = { stiffness = { x = \"1e7 N/m\", y = \"2e7 N/m\", z = \"3e7 N/m\", tilt_y = \"1e4 N m/rad\", tilt_z = \"1e4 N m/rad\" } }\n";
    let straight = format!("{BEARING}\n[inner_race]\n{}[outer_race]\n{outer}", loads(600.0));
    let named = format!(
        "{BEARING}\n[bearing.b]\ninner_at = \"70 mm\"\nreversed = true\n[inner_race.b]\n{}[outer_race.b]\n{outer}",
        loads(-600.0).replace("1 N m", "-1 N m")
    );
    let alone: Scene = resolve(&document(&straight)).unwrap();
    let one = solve_assembly(
        &AssemblyScene::alone(alone).statics().unwrap(),
        None,
        &StaticOptions::default(),
    )
    .unwrap();
    let other =
        solve_assembly(&scene(&named).statics().unwrap(), None, &StaticOptions::default()).unwrap();
    for (race, place) in [(0, "inner"), (1, "outer")] {
        let (a, b) = (one.coordinates[race], other.coordinates[race]);
        // Half a turn about Z: along X and Y and about Y the other way round.
        let turned = [70e-3 - b[0], -b[1], b[2], -b[3], b[4]];
        for (i, (a, b)) in a.iter().zip(turned).enumerate() {
            let size = if i < 3 { 1e-5 } else { 1e-4 };
            // Statics stops at 1e-11 of its loads.
            assert!((a - b).abs() <= 1e-8 * size, "{place} {i}: {a:e} {b:e}");
        }
    }
    assert!(one.coordinates[0][0] > 1e-6, "{:?}", one.coordinates);
}

/// What a named table does not say the one without a name says, and what it says holds for it alone.
#[test]
fn a_named_table_lies_over_the_one_without_a_name() {
    let common = r#"
defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
clearance.radial = "-5 um"
ball_phase = "7 deg"
inner_race = { radius = "20 mm", groove_radius = "6.2 mm" }
outer_race = { radius = "32 mm", groove_radius = "6.2 mm" }
[inner_race]
y = { load = "5 N" }
z = { load = "-100 N" }
[outer_race]
y = "1 um"
"#;
    let text = format!(
        "{common}
[bearing.a]
balls = 7
inner_race = {{ groove_radius = \"6.3 mm\" }}
[bearing.b]
inner_at = \"200 mm\"
ball_phase = \"9 deg\"
[inner_race.a]
z = {{ load = \"-200 N\" }}
[outer_race.b]
y = \"2 um\"
"
    );
    let placed = scene(&text);
    let written = |changes: &[(&str, &str)]| {
        let mut whole = common.to_string();
        for (from, to) in changes {
            assert_eq!(whole.matches(from).count(), 1, "{from}");
            whole = whole.replace(from, to);
        }
        let scene = resolve(&document(&whole)).unwrap();
        (scene.clone(), static_problem(&scene))
    };
    let expected = [
        written(&[
            ("balls = 8", "balls = 7"),
            ("\"20 mm\", groove_radius = \"6.2 mm\"", "\"20 mm\", groove_radius = \"6.3 mm\""),
            ("-100 N", "-200 N"),
        ]),
        written(&[("7 deg", "9 deg"), ("\"1 um\"", "\"2 um\"")]),
    ];
    for (bearing, (one, problem)) in placed.bearings.iter().zip(&expected) {
        let name = &bearing.name;
        assert_eq!(&bearing.scene.geometry, &one.geometry, "{name:?}");
        assert_eq!(&bearing.scene.dynamics.inner, &one.dynamics.inner, "{name:?}");
        let own = static_problem(&bearing.scene);
        assert_eq!(format!("{own:?}"), format!("{problem:?}"), "{name:?}");
    }
}

/// Each bearing has balls and speeds of its own.
#[test]
fn every_bearings_balls_press_outwards_by_their_own_speed() {
    let text = format!(
        "{}[bearing.right.ball]\nradius = \"5.6 mm\"\n[ball_forces]\ncentrifugal = true\n",
        [BEARING, PLACED]
            .concat()
            .replace("[inner_race.apart]\n", "[inner_race.apart]\nspeed = \"700 rpm\"\n")
    );
    let still = scene(&text).statics().unwrap();
    for (bearing, (ball, inner, outer)) in still.bearings.iter().zip([
        (5.953e-3, 1000.0, -200.0),
        (5.6e-3, 1000.0, 0.0),
        (5.953e-3, 700.0, 0.0),
    ]) {
        let gamma = ball / 30e-3 * 35f64.to_radians().cos();
        let rpm = 0.5 * (1.0 - gamma) * inner + 0.5 * (1.0 + gamma) * outer;
        let density = 7850.0;
        let mass = density * 4.0 / 3.0 * PI * f64::powi(ball, 3);
        let expected = mass * (rpm * TAU / 60.0).powi(2);
        assert!(
            (bearing.centrifugal / expected - 1.0).abs() <= 1e-12,
            "{:?}: {} {expected}",
            bearing.name,
            bearing.centrifugal
        );
    }
}

/// Every cage is a body of its own, with its own size and place in the list.
#[test]
fn every_cage_is_that_of_its_bearing() {
    let cage = |mass: &str| {
        format!(
            "cage = {{ pocket_radius = \"6.5 mm\", inner_radius = \"29.125 mm\", outer_radius = \"33.375 mm\", mass = \"{mass}\", guidance = \"balls\" }}\n"
        )
    };
    let text = format!(
        "{BEARING}[bearing.a]\ninner_at = \"-50 mm\"\n{}[bearing.b]\ninner_at = \"50 mm\"\n{}[bearing.c]\n{}\
         [body.shaft]\nspeed = \"100 rpm\"\ninertia = {{ mass = \"1 kg\", axial = \"1e-3 kg m^2\", transverse = \"1e-3 kg m^2\" }}\n\
         [numerics]\nend = \"1 ms\"\n",
        cage("60 g"),
        cage("70 g"),
        cage("80 g")
    );
    let all = assembly(&text);
    for (bearing, mass) in all.bearings.iter().zip([0.06, 0.07, 0.08]) {
        let name = bearing.name.as_ref().unwrap();
        let body = &all.bodies[bearing.cage.as_ref().expect("a cage").body];
        assert!(
            body.name.contains("cage") && body.name.ends_with(&format!("of bearing {name}")),
            "{}",
            body.name
        );
        assert!((body.inertia().unwrap().mass - mass).abs() <= 1e-15);
    }
}

/// What weighs says so; statics without gravity needs no mass.
#[test]
fn a_body_that_weighs_has_a_mass() {
    let massless =
        [BEARING, "[body.shaft]\nz = { load = \"-10 N\" }\nx = { load = \"300 N\" }\n"].concat();
    let weighing =
        format!("{massless}[ball_forces]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n");
    assert_eq!(scene(&massless).bodies[0].race.inertia.mass, 0.0);
    let error = match resolve_subject(&document(&weighing)) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("a body without mass weighs nothing"),
    };
    assert!(error.contains("body.inertia.mass"), "{error}");
    let laden = weighing.replace(
        "[body.shaft]\n",
        "[body.shaft]\ninertia = { mass = \"3 kg\", axial = \"1e-3 kg m^2\", transverse = \"1e-3 kg m^2\" }\n",
    );
    assert_eq!(assembly(&laden).gravity, [0.0, 0.0, -9.81]);
}

/// Two bearings in one place of a body are refused by whichever race shares it.
#[test]
fn outer_races_do_not_share_a_place_either() {
    let text = [BEARING, PLACED].concat().replace(
        "inner_on = \"shaft\"\ninner_at = \"50 mm\"\n",
        "inner_on = \"shaft\"\ninner_at = \"50 mm\"\nouter_on = \"hub\"\nouter_at = \"-30 mm\"\n",
    );
    let text = text.replace("[outer_race.right]\nx = \"6 um\"\n", "");
    let error = match resolve_subject(&document(&text)) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("balls run in each other"),
    };
    assert!(error.contains("5.0000 mm apart") && error.contains("outer_at"), "{error}");
}

/// What relaxes at no time or has no stiffness is refused at its place; an element alone is a spring.
#[test]
fn maxwell_elements_are_whole() {
    let with = |item: &str| {
        let text = format!(
            "{BEARING}\n[body.shaft]\n[spring.rubber]\nfrom = \"ground\"\nto = \"shaft\"\n[[spring.rubber.maxwell]]\n{item}\n"
        );
        let document = Document::read_str(&text, Format::Toml, "a.toml");
        let scene = document.and_then(|document| resolve_subject(&document).map(drop));
        scene.map_err(|error| error.to_string())
    };
    for (item, part) in [
        ("x = \"1 N/m\"", "relaxation_time"),
        ("relaxation_time = \"1 s\"", "nothing relaxes"),
        ("relaxation_time = \"0 s\"\nx = \"1 N/m\"", "outside"),
        ("relaxation_time = \"-1 s\"\nx = \"1 N/m\"", "outside"),
        ("relaxation_time = \"nan s\"\nx = \"1 N/m\"", "NaN"),
        ("relaxation_time = \"1 s\"\nx = \"-1 N/m\"", "outside"),
        ("relaxation_time = \"1 s\"\nturn_x = \"1 N/m\"", "unit"),
    ] {
        let message = with(item).unwrap_err();
        assert!(message.contains(part) && message.starts_with("a.toml:"), "{item}: {message}");
    }
    assert_eq!(with("relaxation_time = \"1 s\"\nx = \"1 N/m\""), Ok(()));
}
