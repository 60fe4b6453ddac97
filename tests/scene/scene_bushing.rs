//! Springs that are bonded bushings, and springs that end at races.

use bearing_dynamics::ch2_housing::elastomer::named;
use bearing_dynamics::members::connection::{Law, SpringDashpot};
use bearing_dynamics::members::prony::bushing_spring;
use bearing_dynamics::mesh::generate::{Bushing, BushingMesh, Part, bushing};
use bearing_dynamics::scene::build::assembly::{AssemblyScene, SpringAt};
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};
use std::f64::consts::TAU;

const SHIPPED: &str = include_str!("../../scenes/bearing_on_bushing.toml");

/// The shipped scene with these words changed.
fn read(changes: &[(&str, &str)]) -> Result<AssemblyScene, String> {
    let mut text = SHIPPED.to_string();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let document = Document::read_str(&text, Format::Toml, "scene").map_err(|e| e.to_string())?;
    match resolve_subject(&document).map_err(|error| error.to_string())? {
        Subject::Assembly(scene) => Ok(*scene),
        _ => Err("no assembly".into()),
    }
}

fn law(scene: &AssemblyScene) -> SpringDashpot {
    match &scene.assembly().unwrap().connections[0].law {
        Law::SpringDashpot(law) => law.clone(),
        Law::Torsion(_) => panic!("a torsion"),
    }
}

const SMALL: (&str, &str) =
    ("table = \"3.1\"", "table = \"3.1\"\ncells = { around = 5, radial = 2, axial = 2 }");

/// The bits of what the library makes of the same bushing, and what the keys are in SI units.
#[test]
fn a_bushing_is_the_springs_that_it_condenses_to() {
    let scene = read(&[
        SMALL,
        ("length = \"20 mm\"\ntable", "length = \"25 mm\"\nfastest = \"2 kHz\"\ntable"),
    ]);
    let scene = scene.unwrap();
    let body = Bushing { inner_diameter: 0.071, thickness: 0.01, length: 0.025 };
    let mesh = BushingMesh { around: 5, radial: 2, axial: 2, grading: 2.0, part: Part::Quarter };
    let given = scene.springs[0].bushing.as_ref().unwrap();
    assert!((given.body.thickness - body.thickness).abs() <= 1e-15);
    let made = bushing(&given.body, &mesh).unwrap().quadratic().unwrap().mesh;
    let own = bushing_spring(&made, Part::Quarter, &named::table_3_1(), TAU * 2000.0).unwrap();
    let wall = Some(given.body.thickness);
    assert_eq!(law(&scene), SpringDashpot { rest: [0.0; 3], wall, ..own.law });
    assert_eq!(given.misses, own.misses);
    assert!(own.misses.iter().all(|miss| *miss <= 2e-4), "{:?}", own.misses);
}

/// Every stiffness is proportional to C_R, whose multiples have the same B over C_R; without Maxwell elements there
/// is nothing that relaxes.
#[test]
fn keys_of_the_rubber_reach_the_springs() {
    let usual = law(&read(&[SMALL]).unwrap());
    let doubled = format!("{}\nrubber_modulus = \"1.294 MPa\"", SMALL.1);
    let doubled = law(&read(&[(SMALL.0, doubled.as_str())]).unwrap());
    for i in 0..6 {
        let ratio = doubled.stiffness[i] / usual.stiffness[i];
        assert!((ratio - 2.0).abs() <= 1e-9, "{i}: {ratio}");
    }
    let plain = "rubber_modulus = \"0.647 MPa\"\ncells = { around = 5, radial = 2, axial = 2 }";
    let plain = law(&read(&[(SMALL.0, plain)]).unwrap());
    assert!(plain.maxwell.is_empty() && usual.maxwell.len() > 10);
    for i in 0..6 {
        let ratio = plain.stiffness[i] / usual.stiffness[i];
        assert!((ratio - 1.0).abs() <= 1e-9, "{i}: {ratio}");
    }
    let one = "rubber_modulus = \"0.647 MPa\"\ncells = { around = 5, radial = 2, axial = 2 }\n\
               [[spring.mount.bushing.maxwell]]\ngamma = 2.0\nrelaxation_time = \"10 ms\"";
    let one = law(&read(&[(SMALL.0, one)]).unwrap());
    // Torsion changes no volume: the element is the rubber's own, γ times the relaxed stiffness, but for what five
    // cells around do to volumes and what least squares leave to the times beside it.
    let twisting = |apart: f64| -> f64 {
        let times = one.maxwell.iter().filter(|of| (of.relaxation_time / 0.01).ln().abs() <= apart);
        times.map(|of| of.stiffness[3] / one.stiffness[3]).sum()
    };
    assert!((twisting(f64::INFINITY) - 2.0).abs() <= 1e-2, "{}", twisting(f64::INFINITY));
    assert!(twisting(1e-9) >= 1.9, "{}", twisting(1e-9));
}

#[test]
fn what_cannot_be_is_told() {
    let said = |changes: &[(&str, &str)]| read(changes).unwrap_err();
    for (changes, words) in [
        ([("\"91 mm\"", "\"71 mm\"")], "no larger than the inner diameter"),
        ([("table = \"3.1\"", "chain = 8.0")], "rubber_modulus"),
        (
            [(
                "[spring.mount.bushing]",
                "[spring.mount.stiffness]\nx = \"1 N/m\"\n[spring.mount.bushing]",
            )],
            "whose stiffness follows",
        ),
        (
            [(
                "table = \"3.1\"",
                "table = \"3.1\"\ncells = { around = 50, radial = 20, axial = 20 }",
            )],
            "at most 1500",
        ),
        ([("table = \"3.1\"", "table = \"3.1\"\ncells = { radial = 3 }")], "even"),
        ([("table = \"3.1\"", "table = \"3.1\"\ncoupling_phase = 0.5")], "`method = \"explicit\"`"),
        (
            [("table = \"3.1\"", "table = \"3.1\"\nmethod = \"implicit\"\nstep_fraction = 0.5")],
            "only with `method = \"explicit\"`",
        ),
        ([("to = \"outer_race\"", "to = \"outer_rac\"")], "did you mean outer_race?"),
        (
            [("to = \"outer_race\"", "to = \"right.outer_race\"")],
            "ends are: inner_race, outer_race, ground",
        ),
        (
            [("motion = \"5-dof\"\nspeed = \"0 rpm\"", "motion = \"fixed\"")],
            "the outer race is fixed",
        ),
        ([("[bearing]\n", "[bearing]\nouter_on = \"sleeve\"\n")], "sleeve"),
    ] {
        let error = said(&changes);
        assert!(error.contains(words), "{words}: {error}");
    }
    let sits = said(&[
        (
            "[bearing]\n",
            "[body.sleeve]\ninertia = { mass = \"1 kg\", axial = \"1e-3 kg m^2\", transverse = \"1e-3 kg m^2\" }\n\
            [bearing]\nouter_on = \"sleeve\"\ninner_on = \"inner_race\"\n",
        ),
        ("[outer_race]\nmotion = \"5-dof\"\nspeed = \"0 rpm\"\n", ""),
    ]);
    assert!(sits.contains("is on body.sleeve") && sits.contains("\"sleeve\""), "{sits}");
}

/// Of several bearings by their names, at the places where their races sit; a spring begins there too.
#[test]
fn springs_end_at_races_where_those_sit() {
    let text = include_str!("../../scenes/shaft_back_to_back.toml");
    let spring = "\n[spring.brace]\nfrom = \"ground\"\nto = \"right.outer_race\"\nstiffness = { x = \"1e7 N/m\", y = \"1e7 N/m\", z = \"1e7 N/m\" }\n";
    let moving = "[outer_race.right]\nmotion = \"5-dof\"\nspeed = \"0 rpm\"\n";
    let text = text.replace("[outer_race.right]\n", moving) + spring;
    let document = Document::read_str(&text, Format::Toml, "scene").unwrap();
    let Ok(Subject::Assembly(scene)) = resolve_subject(&document) else {
        panic!("{:?}", resolve_subject(&document).err())
    };
    let [from, to] = scene.springs[0].ends;
    assert_eq!(to.at, SpringAt::Race { bearing: 1, side: 1 });
    let place = scene.bearings[1].carriers[1].at();
    assert!(place != 0.0);
    assert_eq!([from.along, to.along], [place, 0.0]);
    let assembly = scene.assembly().unwrap();
    assert_eq!(assembly.connections[0].ends[1].body, assembly.bearings[1].mounts[1].body);
    let Law::SpringDashpot(law) = &assembly.connections[0].law else { panic!() };
    assert_eq!(law.rest, [0.0; 3]);
    let alone = text.replace("right.outer_race", "outer_race");
    let document = Document::read_str(&alone, Format::Toml, "scene").unwrap();
    let error = resolve_subject(&document).unwrap_err().to_string();
    assert!(error.contains("left.outer_race, right.outer_race"), "{error}");
}

/// Rubber begins outside the race that it holds.
#[test]
fn rubber_inside_its_race_is_refused() {
    let begins = |at: &str| read(&[SMALL, ("inner_diameter = \"71 mm\"", at)]);
    let error = begins("inner_diameter = \"70.9 mm\"").unwrap_err();
    assert!(error.contains("inner_diameter") && error.contains("of 71 mm"), "{error}");
    assert!(begins("inner_diameter = \"71.0 mm\"").is_ok());
}
