//! A body of a scene that bends.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::members::body::{Body, Rotation};
use bearing_dynamics::scene::build::shaft::take_shafts;
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};

const BEARINGS: &str = r#"
defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
clearance = { radial = "0 um" }
ball = { radius = "5.953 mm" }
inner_race = { radius = "20.047 mm", groove_radius = "6.013 mm" }
outer_race = { groove_radius = "6.310 mm" }
[bearing.left]
inner_at = "-200 mm"
[bearing.right]
inner_at = "100 mm"
[numerics]
end = "1 ms"
[body.shaft]
"#;

fn read(body: &str) -> Result<Assembly, String> {
    let text = format!("{BEARINGS}{body}");
    let document =
        Document::read_str(&text, Format::Toml, "scene.toml").map_err(|e| e.to_string())?;
    match resolve_subject(&document).map_err(|e| e.to_string())? {
        Subject::Assembly(scene) => scene.assembly().map_err(|e| e.to_string()),
        _ => panic!("no bearings"),
    }
}

/// A disc at one end moves the body's centre there; bearings, loads and unbalances stay where they are.
#[test]
fn the_centre_of_mass_is_the_centre_of_a_body_that_bends() {
    let beam = r#"speed = "1000 rpm"
[body.shaft.beam]
start = "-200 mm"
damping = "100 1/s"
segments = [{ length = "300 mm", outer_diameter = "30 mm" }, { length = "100 mm", outer_diameter = "20 mm", inner_diameter = "10 mm" }]
disc = [{ at = "200 mm", outer_diameter = "200 mm", inner_diameter = "20 mm", width = "20 mm" }]
load = [{ at = "0 mm", z = "-100 N" }]
unbalance = [{ at = "200 mm", size = "1e-4 kg m", angle = "90 deg" }]
probe = [{ name = "disc", at = "200 mm" }]
"#;
    let assembly = read(beam).unwrap();
    let (body, shaft) = (&assembly.bodies[0], &assembly.shafts[0]);
    let round = |outer: f64, inner: f64, width: f64| {
        7850.0 * std::f64::consts::PI / 4.0 * (outer * outer - inner * inner) * width
    };
    let parts = [
        (round(30e-3, 0.0, 0.3), -0.05),
        (round(20e-3, 10e-3, 0.1), 0.15),
        (round(0.2, 20e-3, 20e-3), 0.2),
    ];
    let mass: f64 = parts.iter().map(|(mass, _)| mass).sum();
    let centre = parts.iter().map(|(mass, at)| mass * at).sum::<f64>() / mass;
    let inertia = body.inertia().unwrap();
    assert!((inertia.mass / mass - 1.0).abs() <= 1e-12, "{} {mass}", inertia.mass);
    assert!((body.rest[0] - centre).abs() <= 1e-12, "{} {centre}", body.rest[0]);
    // (2.7) brakes all motion.
    let braked = body.driven().unwrap().foundation_damping;
    assert!((braked[1] / (100.0 * mass) - 1.0).abs() <= 1e-12, "{braked:?}");
    assert_eq!(shaft.damping, 100.0);
    for (along, at) in [
        (assembly.bearings[0].mounts[0].along, -0.2),
        (assembly.bearings[1].mounts[0].along, 0.1),
        (shaft.loads[0].section.along, 0.0),
        (shaft.unbalances[0].section.along, 0.2),
        (shaft.probes[0].1.along, 0.2),
    ] {
        assert!((centre + along - at).abs() <= 1e-12, "{along} {at}");
    }
    assert!((shaft.unbalances[0].angle - std::f64::consts::FRAC_PI_2).abs() <= 1e-15);
    // Below 5 kHz, and beside them static answers.
    let hertz = shaft.shapes.hertz();
    let natural = shaft.shapes.natural;
    assert!(hertz[..natural].iter().all(|f| *f <= 5e3) && natural < hertz.len(), "{hertz:?}");
}

#[test]
fn faults_of_beams_say_what_is_wrong() {
    let beam = |lines: &str| format!("[body.shaft.beam]\n{lines}\n");
    let whole = "segments = [{ length = \"400 mm\", outer_diameter = \"30 mm\" }]\n";
    let cases = [
        (beam("damping = \"1 1/s\""), "a flexible shaft has segments"),
        (
            format!("inertia = {{ mass = \"1 kg\" }}\n{}", beam(whole)),
            "the body is flexible (`beam`)",
        ),
        (format!("unbalance = \"1e-3 kg m\"\n{}", beam(whole)), "the body is flexible (`beam`)"),
        (
            beam(
                "segments = [{ length = \"400 mm\", outer_diameter = \"30 mm\", inner_diameter = \"30 mm\" }]",
            ),
            "no smaller than the outer diameter",
        ),
        (
            beam(&format!("{whole}load = [{{ at = \"201 mm\", z = \"1 N\" }}]")),
            "201.0000 mm is not on the shaft, which extends from -200.0000 to 200.0000 mm",
        ),
        (beam(&format!("{whole}load = [{{ at = \"0 mm\" }}]")), "there is no force"),
        // Bounds of places and sizes are in metres, drawings are not.
        (
            beam("segments = [{ length = 400, outer_diameter = \"30 mm\" }]"),
            "400 has no unit, but this is a length. Allowed units: mm, um, nm, cm, m, km, in. Hint: write for instance \"400 mm\"",
        ),
        (
            beam(&format!("{whole}load = [{{ at = \"-20\", z = \"1 N\" }}]")),
            "Hint: write for instance \"-20 mm\"",
        ),
        (
            beam(&format!(
                "{whole}disc = [{{ at = \"0 mm\", mass = \"1 kg\", width = \"1 mm\" }}]"
            )),
            "width",
        ),
        (beam(&format!("{whole}disc = [{{ at = \"0 mm\" }}]")), "outer_diameter"),
        (
            beam(&format!(
                "{whole}disc = [{{ at = \"0 mm\", mass = \"1 kg\", axial = \"2.1e-3 kg m^2\", transverse = \"1e-3 kg m^2\" }}]"
            )),
            "body.shaft.beam.disc.1.axial: a moment of inertia of 0.0021 kg m^2 about the axis is more than twice",
        ),
        (
            format!(
                "{}[spring.stay]\nfrom = \"ground\"\nto = \"shaft\"\nto_at = \"-200.1 mm\"\nstiffness = {{ z = \"1e6 N/m\" }}\n",
                beam(whole)
            ),
            "spring.stay.to_at: refused: -200.1000 mm is not on body shaft, which extends from -200.0000 to 200.0000 mm",
        ),
        // Which one of a list, counted from 1.
        (
            beam(&format!(
                "{whole}load = [{{ at = \"0 mm\", z = \"1 N\" }}, {{ at = \"20\", z = \"1 N\" }}]"
            )),
            "body.shaft.beam.load.2.at: \"20\" has no unit",
        ),
        (beam(&format!("{whole}mesh = {{ around = 16 }}")), "add order = 2"),
        (beam(&format!("{whole}mesh = {{ order = 2, around = 12 }}")), "multiple of 8"),
        (beam(&format!("{whole}mesh = {{ order = 3 }}")), "order"),
        (
            beam(
                "start = \"0 mm\"\nsegments = [{ length = \"300 mm\", outer_diameter = \"30 mm\" }]",
            ),
            "is not on body shaft",
        ),
    ];
    for (text, expected) in cases {
        let error = read(&text).unwrap_err();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

#[test]
fn faults_of_shafts_in_elements_say_what_is_wrong() {
    const ELEMENTS: &str = "mesh = { order = 1, method = \"explicit\" }";
    let whole = "[body.shaft.beam]\nstart = \"-200 mm\"\nsegments = [{ length = \"400 mm\", outer_diameter = \"30 mm\" }]\n";
    let beam = |before: &str, lines: &str| format!("{before}\n{whole}{lines}\n");
    let turning = |lines: &str| beam("speed = \"1000 rpm\"", lines);
    let in_elements = |lines: &str| turning(&format!("{ELEMENTS}\n{lines}"));
    let cases = [
        (beam("", ELEMENTS), "have a prescribed speed"),
        (beam("torque = \"1 N m\"", ELEMENTS), "body.shaft.torque: refused"),
        (
            beam("speed = \"1000 rpm\"\nz = { load = \"-100 N\" }", ELEMENTS),
            "whose loads act at sections",
        ),
        (in_elements("modes_to = \"3 kHz\""), "only with `body.beam.mesh.method = \"reduced\"`"),
        (in_elements("internal_damping = \"1 1/s\""), "body.shaft.beam.internal_damping: refused"),
        (
            in_elements("damping = \"10 1/s\"\ndamped_motion = \"relative-to-rigid\""),
            "only in axes that do not rotate",
        ),
        (in_elements("disc = [{ at = \"0 mm\", mass = \"1 kg\" }]"), "give its `axial`, above 0"),
        (
            turning("mesh = { order = 1, race_stiffness = \"1e9 N/m\" }"),
            "only with `method = \"explicit\"`",
        ),
        (turning("mesh = { order = 1, method = \"implicit\" }"), "reduced"),
        (
            format!(
                "{}\n[spring.bed]\nfrom = \"ground\"\nto = \"shaft\"\nstiffness.y = \"1e6 N/m\"\n",
                turning(ELEMENTS)
            ),
            "to which only bearings can be joined",
        ),
        (
            format!(
                "{}\n[bearing.back]\ninner_on = \"inner_race\"\nouter_on = \"shaft\"\ninner_at = \"0 mm\"\nouter_at = \"0 mm\"\n",
                turning(ELEMENTS)
            ),
            "an outer race cannot be on elements",
        ),
    ];
    for (text, expected) in cases {
        let error = read(&text).unwrap_err();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

/// In a run each race and each disc of a shaft in elements is a body of its own on a section; equilibria have the reduced shaft.
#[test]
fn a_shaft_in_elements_is_a_solid_and_what_sits_on_it() {
    let text = r#"speed = "1000 rpm"
[body.shaft.beam]
segments = [{ length = "250 mm", outer_diameter = "30 mm" }, { length = "150 mm", outer_diameter = "24 mm" }]
mesh = { order = 1, method = "explicit", race_stiffness = "1e9 N/m", race_damping = "10 N s/m" }
disc = [{ at = "-200 mm", mass = "60 g", axial = "2e-5 kg m^2", transverse = "1e-5 kg m^2" }, { at = "0 mm", mass = "1 kg", axial = "1e-3 kg m^2", transverse = "1e-3 kg m^2" }]
load = [{ at = "30 mm", z = "-100 N" }]
probe = [{ name = "mid", at = "0 mm" }]
damping = "5 1/s"
"#;
    let document =
        Document::read_str(&format!("{BEARINGS}{text}"), Format::Toml, "scene.toml").unwrap();
    let Subject::Assembly(scene) = resolve_subject(&document).unwrap() else { panic!() };
    let reduced = scene.assembly().unwrap();
    assert_eq!(reduced.shafts.len(), 1);
    let mut assembly = reduced.clone();
    let [shaft] = &take_shafts(&scene, &mut assembly).unwrap()[..] else { panic!() };
    assert!(assembly.shafts.is_empty() && !assembly.bodies[0].moves());
    let part = shaft.part.shaft.as_ref().unwrap();
    let bodies: Vec<&Body> = part.joints.iter().map(|joint| &assembly.bodies[joint.body]).collect();
    // Left race as the disc says, right race as a ring of its sizes, and the disc that no race sits on.
    assert_eq!(bodies.len(), 3);
    assert_eq!(bodies[0].inertia().unwrap().axial, 2e-5);
    assert_eq!(bodies[1].inertia().unwrap(), &scene.bearings[1].scene.dynamics.inner.inertia);
    assert_eq!(bodies[2].inertia().unwrap().mass, 1.0);
    assert_eq!([bodies[0].rest[0], bodies[1].rest[0], bodies[2].rest[0]], [-0.2, 0.1, 0.0]);
    for (bearing, joint) in assembly.bearings.iter().zip(&part.joints) {
        assert_eq!((bearing.mounts[0].body, bearing.mounts[0].along), (joint.body, 0.0));
    }
    let arms = [30e-3, 24e-3, 30e-3];
    for ((joint, body), arm) in part.joints.iter().zip(&bodies).zip(arms) {
        let law = &joint.law;
        assert_eq!((law.stiffness[1], law.damping[2]), (1e9, 10.0));
        assert!((law.stiffness[4] / (1e9 * arm * arm) - 1.0).abs() <= 1e-12);
        // (2.7) brakes shifts by the mass, tilts by the inertia about a diameter.
        let of = body.inertia().unwrap();
        let braked = body.driven().unwrap().foundation_damping;
        for (braked, inertia) in
            braked.iter().zip([of.mass, of.mass, of.mass, of.transverse, of.transverse])
        {
            assert!((braked / (5.0 * inertia) - 1.0).abs() <= 1e-15, "{braked} {inertia}");
        }
        assert!(matches!(body.driven().unwrap().rotation, Rotation::Speed(_)));
    }
    // A load's forces on the nodes of its section sum to it, about the axis.
    let problem = &shaft.part.model.problem;
    let [load] = &problem.loads[..] else { panic!() };
    let (mut sum, mut about) = (0.0, 0.0);
    for (node, force) in &load.forces {
        let [x, y, _] = problem.nodes[*node as usize];
        assert!((x - 0.03).abs() <= 1e-12 && force[0].abs() <= 1e-15, "{x} {force:?}");
        sum += force[2];
        about += y * force[2];
    }
    assert!((sum - 1.0).abs() <= 1e-12 && about.abs() <= 1e-15, "{sum} {about}");
}

/// The same scene with tetrahedra in the place of beam theory: the same body to what a mesh of that size is good to.
#[test]
fn a_body_may_be_a_mesh() {
    let body = |mesh: &str| {
        let segments = "segments = [{ length = \"300 mm\", outer_diameter = \"30 mm\" }, { length = \"100 mm\", outer_diameter = \"24 mm\" }]";
        read(&format!("[body.shaft.beam]\nstart = \"-200 mm\"\n{segments}\n{mesh}")).unwrap()
    };
    let (beam, solid) = (body(""), body("mesh = { order = 2, longest_layer = \"20 mm\" }"));
    let [of_beam, of_solid] = [&beam, &solid].map(|all| all.bodies[0].inertia().unwrap());
    // Quadratic edges of 22.5 degrees leave 1e-4 of the circle.
    for (ours, theirs) in [
        (of_solid.mass, of_beam.mass),
        (of_solid.axial, of_beam.axial),
        (of_solid.transverse, of_beam.transverse),
    ] {
        assert!((ours / theirs - 1.0).abs() <= 2e-4, "{ours} {theirs}");
    }
    // The step's corners do not bend with it: 1 % of the first frequency.
    let [first, of_solid] = [&beam, &solid].map(|all| all.shafts[0].shapes.hertz()[0]);
    assert!(first != of_solid && (of_solid / first - 1.0).abs() <= 1e-2, "{of_solid} {first}");
}

/// A bearing that is put in the other way round stays so on elements: its races face the same way as on the reduced shaft.
#[test]
fn a_bearing_on_elements_faces_the_way_it_was_put_in() {
    let text = r#"speed = "1000 rpm"
[body.shaft.beam]
start = "-200 mm"
segments = [{ length = "400 mm", outer_diameter = "30 mm" }]
mesh = { order = 1, method = "explicit" }
"#;
    let turned = BEARINGS.replace("[numerics]", "reversed = true\n[numerics]");
    let document =
        Document::read_str(&format!("{turned}{text}"), Format::Toml, "scene.toml").unwrap();
    let Subject::Assembly(scene) = resolve_subject(&document).unwrap() else { panic!() };
    let reduced = scene.assembly().unwrap();
    let mut assembly = reduced.clone();
    take_shafts(&scene, &mut assembly).unwrap();
    let facing = |of: &Assembly| -> Vec<[bool; 2]> {
        of.bearings.iter().map(|bearing| bearing.mounts.map(|mount| mount.reversed)).collect()
    };
    assert_eq!(facing(&assembly), [[false; 2], [true; 2]]);
    assert_eq!(facing(&assembly), facing(&reduced));
}

/// Masses beside the axis have more inertia than a thin shaft without a disc: under a torque, which would have to turn them, that is
/// refused; with the disc it is not, nor at a given speed.
#[test]
fn unbalances_that_a_torque_cannot_turn_are_refused() {
    let shaft = |drive: &str, size: &str, disc: &str| {
        format!(
            r#"{drive}
[body.shaft.beam]
start = "-200 mm"
segments = [{{ length = "400 mm", outer_diameter = "25 mm" }}]
{disc}
unbalance = [{{ at = "100 mm", size = "{size}" }}]
"#
        )
    };
    let torque = "torque = \"1 N m\"";
    let disc = r#"disc = [{ at = "100 mm", outer_diameter = "200 mm", inner_diameter = "25 mm", width = "20 mm" }]"#;
    let error = read(&shaft(torque, "2e-2 kg m", "")).unwrap_err();
    assert!(
        error.contains(
            "body.shaft.beam: the unbalances of a shaft driven by a torque have a moment of inertia of"
        ),
        "{error}"
    );
    assert!(error.contains("give the disc that carries them"), "{error}");
    for sound in [
        shaft(torque, "2e-2 kg m", disc),
        shaft("speed = \"1000 rpm\"", "2e-2 kg m", ""),
        shaft(torque, "1e-4 kg m", ""),
    ] {
        read(&sound).unwrap();
    }
}
