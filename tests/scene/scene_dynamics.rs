//! Scenes of bearings in motion: what is written becomes what is simulated.

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{CageForce, Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::members::body::{Condition, Drive, Rotation};
use bearing_dynamics::motion::simulation::{Integrator, Simulation, Start, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::scene;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::excitations::{Excitation, excitations};
use bearing_dynamics::scene::build::motion::{DynamicsError, dynamic_problem, run_options};
use bearing_dynamics::scene::build::statics::static_problem;
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::tables::keys::Need;
use bearing_dynamics::scene::{CageInRun, Document, Format, RunPlot, Scene, Subject};
use std::f64::consts::PI;
use std::path::Path;

fn shipped(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    scene::read_file(&path).unwrap_or_else(|error| panic!("{error}"))
}

pub const BEARING: &str = r#"
defaults = "dissertation"
bearing.kind = "deep-groove"
bearing.balls = 8
bearing.clearance.radial = "-5 um"
bearing.inner_race.radius = "20 mm"
bearing.inner_race.groove_radius = "6.2 mm"
bearing.inner_race.bore_radius = "15 mm"
bearing.outer_race = { radius = "32 mm", groove_radius = "6.2 mm" }
"#;

fn document(lines: &str) -> Document {
    let text = format!("{BEARING}{lines}");
    Document::read_str(&text, Format::Toml, "test.toml").unwrap_or_else(|error| panic!("{error}"))
}

pub fn resolved(document: &Document) -> Scene {
    scene::resolve(document).unwrap_or_else(|error| panic!("{error}"))
}

fn problem(lines: &str) -> DynamicProblem {
    dynamic_problem(&resolved(&document(lines))).unwrap()
}

#[test]
fn every_shipped_scene_makes_a_problem_of_usable_numbers() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut runs = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        // Fits of springs on rubber take a second each.
        if path.is_dir()
            || ["bushing", "rubber"].iter().any(|of| path.display().to_string().contains(of))
        {
            continue;
        }
        let Subject::Assembly(scene) = scene::read_subject(&path).unwrap() else { continue };
        let Some(scene) = scene.only() else { continue };
        static_problem(scene).unwrap();
        let problem = dynamic_problem(scene).unwrap();
        let parts = [Some(&problem.inner), problem.outer.as_ref()];
        for inertia in parts.into_iter().flatten().map(|race| race.inertia) {
            // Steel rings of a palm-sized bearing.
            assert!(inertia.mass > 0.03 && inertia.mass < 0.5, "{inertia:?}");
            assert!(inertia.axial > inertia.transverse && inertia.axial < 2.0 * inertia.transverse);
        }
        match run_options(scene) {
            Ok(run) => {
                assert!(run.window_start < run.end && run.output_interval < run.end);
                runs += 1;
            }
            Err(error) => assert_eq!(error, DynamicsError::NoEnd),
        }
    }
    assert!(runs >= 5);
}

#[test]
fn the_settling_scene_runs_into_its_static_equilibrium() {
    let scene = shipped("settling.toml");
    let problem = dynamic_problem(&scene).unwrap();
    assert_eq!(problem.traction, TractionLaw::None);
    assert_eq!(problem.damping, ContactDamping::HuntCrossley { alpha: 3.0 });
    let run = run_options(&scene).unwrap();
    assert_eq!((run.end, run.output_interval, run.window_start), (0.2, 2e-4, 0.1));
    assert_eq!(run.options.start, Start::Nominal);
    assert_eq!(run.options.stepping, Stepping::Fixed(1e-6));
    let at_rest = bearing_dynamics::equilibrium::statics::solve(&static_problem(&scene).unwrap());
    let expected = at_rest.unwrap().coordinates[0];
    let mut simulation = Simulation::new(problem, run.options).unwrap();
    while simulation.time < run.end {
        simulation.step().unwrap();
    }
    simulation.snapshot();
    let reached = simulation.system.sets[0].races[0].state.position[0];
    // The oscillation decays by e in 13 ms: 6e-9 of the way is left, seen to fall on to 1e-13.
    assert!((reached / expected - 1.0).abs() <= 1e-8, "{reached} {expected}");
}

#[test]
fn the_cage_of_table_5_3_gets_its_length_from_its_mass() {
    let scene = shipped("cage_600rpm.toml");
    let CageInRun::Body(cage) = &scene.dynamics.cage else { panic!("no cage") };
    // Volume of the ring less eleven pockets, by a midpoint sum over the pocket's circle.
    let (pocket, inner, outer): (f64, f64, f64) = (6.5e-3, 29.125e-3, 33.375e-3);
    let count = 200_000;
    let volume: f64 = (0..count)
        .map(|i| {
            let y = pocket * (2.0 * (i as f64 + 0.5) / count as f64 - 1.0);
            let wall = (outer * outer - y * y).sqrt() - (inner * inner - y * y).sqrt();
            2.0 * (pocket * pocket - y * y).sqrt() * wall * 2.0 * pocket / count as f64
        })
        .sum();
    let length = (0.069 / 7850.0 + 11.0 * volume) / (PI * (outer * outer - inner * inner));
    // The midpoint sum is good to 1e-8 at the circle's ends.
    assert!(
        (cage.contacts.length / length - 1.0).abs() <= 1e-7,
        "{} {length}",
        cage.contacts.length
    );
    assert_eq!(cage.inertia.mass, 0.069);
    let axial = 0.5 * 0.069 * (inner * inner + outer * outer);
    assert!((cage.inertia.axial / axial - 1.0).abs() <= 1e-14);
    assert_eq!(cage.contacts.pocket, Pocket::Cylindrical);
    assert_eq!((cage.contacts.guidance, cage.contacts.guide_radius), (Guidance::OuterRace, outer));
    assert_eq!(cage.contacts.pocket_pitch_radius, 30e-3);
    assert_eq!(cage.contacts.force, CageForce::Penalty { stiffness: 2e8 });
    let named = |key: &str| scene.dynamics.defaults_used.iter().any(|used| used.key == key);
    assert!(named("bearing.cage.length") && named("bearing.cage.inertia"));
    assert_eq!(scene.dynamics.plots, [RunPlot::Orbit, RunPlot::Spectrum, RunPlot::Series]);
}

#[test]
fn an_incomplete_cage_is_left_out_and_the_reason_says_what_is_missing() {
    for (lines, missing) in [
        ("", "the scene has no cage"),
        (
            "bearing.cage.pocket_radius = \"6.2 mm\"",
            "no inner_radius, outer_radius, mass, guidance",
        ),
        (
            "bearing.cage = { pocket_radius = \"6.2 mm\", inner_radius = \"25 mm\", \
             outer_radius = \"28 mm\", mass = \"40 g\", guidance = \"inner-race\" }",
            "no race_clearance",
        ),
    ] {
        let scene = resolved(&document(lines));
        let CageInRun::LeftOut(reason) = &scene.dynamics.cage else { panic!("{lines}: a cage") };
        assert!(reason.contains(missing), "{reason}");
        assert!(dynamic_problem(&scene).unwrap().cage.is_none());
    }
    let lines = "bearing.cage = { pocket_radius = \"6.2 mm\", inner_radius = \"25 mm\", \
         outer_radius = \"28 mm\", mass = \"40 g\", guidance = \"balls\" }";
    assert!(problem(lines).cage.is_some());
}

#[test]
fn profiles_are_what_they_say() {
    let problem = problem(
        r#"
        [inner_race]
        x = { load = { ramp = ["1 N", "250 N"], start = "5 ms", duration = "0.1 s" } }
        y = { load = { table = [["0 s", "0 N"], ["10 ms", "0.1 kN"], ["1 s", "-1 N"]] } }
        z = { displacement = { amplitude = "5 um", mean = "-3 um", frequency = "2 kHz", phase = "90 deg" } }
        tilt_y = { moment = { half_sine = "2 N m", duration = "5 ms" } }
        tilt_z = { tilt = "0.1 deg" }
        torque = { smooth_ramp = ["0 N m", "1 N m"], duration = "1 s" }
        added_mass = "0.5 kg"
        inertia = { mass = "0.2 kg", axial = "10 kg mm^2", transverse = "1e-5 kg m^2" }
        unbalance = "900 g mm"
        "#,
    );
    let inner = &problem.inner;
    let expected = [
        Drive::Load(Profile::Ramp { from: 1.0, to: 250.0, start: 5e-3, duration: 0.1 }),
        Drive::Load(Profile::Table { points: vec![[0.0, 0.0], [1e-2, 100.0], [1.0, -1.0]] }),
        Drive::Motion(Profile::Harmonic {
            mean: -3e-6,
            amplitude: 5e-6,
            frequency: 2000.0,
            phase: 0.5 * PI,
        }),
        Drive::Load(Profile::HalfSine { base: 0.0, peak: 2.0, start: 0.0, duration: 5e-3 }),
        Drive::Motion(Profile::Constant(0.1 * (PI / 180.0))),
    ];
    assert_eq!(inner.drives, expected);
    let ramp = Profile::SmoothRamp { from: 0.0, to: 1.0, start: 0.0, duration: 1.0 };
    assert_eq!(inner.rotation, Rotation::Torque(ramp));
    let inertia = (inner.inertia.mass, inner.inertia.axial, inner.inertia.transverse);
    assert_eq!(inertia, (0.7, 1e-5, 1e-5));
    assert_eq!(problem.unbalance, 9e-4);
}

#[test]
fn statics_takes_profiles_at_the_start() {
    let scene = resolved(&document(
        r#"
        [inner_race]
        x = { load = { ramp = ["10 N", "250 N"], duration = "0.1 s" } }
        z = { displacement = { amplitude = "5 um", mean = "1 um", frequency = "1 Hz" } }
        speed = { smooth_ramp = ["300 rpm", "600 rpm"], start = "1 s", duration = "1 s" }
        "#,
    ));
    assert_eq!(scene.conditions[0], Condition::Load(10.0));
    assert_eq!(scene.conditions[2], Condition::Displacement(1e-6));
    assert_eq!(scene.inner_speed, Some(300.0 * (PI / 30.0)));
}

#[test]
fn the_outer_race_is_fixed_or_moves() {
    let fixed = problem("outer_race = { x = \"3 um\", y = { displacement = \"2 um\" } }");
    assert!(fixed.outer.is_none());
    assert_eq!(fixed.outer_start, [3e-6, 2e-6, 0.0, 0.0, 0.0]);
    let moving = |motion: &str| {
        problem(&format!(
            "[outer_race]\nmotion = \"{motion}\"\nz = \"1 um\"\nx.load = \"-445 N\"\n\
             tilt_y.tilt = {{ ramp = [\"0.1 deg\", \"1 deg\"], duration = \"1 s\" }}\n\
             foundation.stiffness = {{ x = \"100 N/um\", tilt_z = \"1e4 N m/rad\" }}\n\
             foundation.damping = {{ y = \"7 N s/m\", tilt_y = \"2 N m s/rad\" }}\n"
        ))
    };
    let five = moving("5-dof");
    assert_eq!(five.outer_start, [0.0, 0.0, 1e-6, 0.1 * (PI / 180.0), 0.0]);
    let outer = five.outer.unwrap();
    assert_eq!(outer.rotation, Rotation::Speed(Profile::ZERO));
    assert_eq!(outer.drives[0], Drive::Load(Profile::Constant(-445.0)));
    assert_eq!(outer.drives[2], Drive::Load(Profile::ZERO));
    assert!(matches!(outer.drives[3], Drive::Motion(Profile::Ramp { .. })));
    assert_eq!(outer.foundation_stiffness, [1e8, 0.0, 0.0, 0.0, 1e4]);
    assert_eq!(outer.foundation_damping, [0.0, 7.0, 0.0, 2.0, 0.0]);
    assert_eq!(moving("6-dof").outer.unwrap().rotation, Rotation::Torque(Profile::ZERO));
}

/// Mass and moments of a body of revolution, x from −half to half, by a midpoint sum over its
/// inner and outer radius at x.
fn revolved(half: f64, density: f64, radii: impl Fn(f64) -> [f64; 2]) -> [f64; 3] {
    let count = 100_000;
    let width = 2.0 * half / count as f64;
    let mut sums = [0.0; 3];
    for i in 0..count {
        let x = -half + width * (i as f64 + 0.5);
        let [inner, outer] = radii(x);
        let mass = density * PI * (outer * outer - inner * inner) * width;
        let squares = outer * outer + inner * inner;
        sums[0] += mass;
        sums[1] += 0.5 * mass * squares;
        sums[2] += mass * (0.25 * squares + x * x);
    }
    sums
}

#[test]
fn races_weigh_what_their_sizes_say() {
    let own = problem(
        "bearing.length = \"18 mm\"\nbearing.inner_race.shoulder_radius = \"22 mm\"\n\
         bearing.inner_race.material.density = \"8 g/cm^3\"\nouter_race.motion = \"5-dof\"\n",
    );
    let ball = 2.0 * 6.0025e-3;
    let groove = |x: f64| (6.2e-3_f64.powi(2) - x * x).max(0.0).sqrt();
    let inner = revolved(9e-3, 8000.0, |x| {
        let land = 22e-3;
        let groove = if x.abs() < 6.2e-3 { 26.2e-3 - groove(x) } else { land };
        [15e-3, groove.min(land)]
    });
    let outer = revolved(9e-3, 7850.0, |x| {
        let land = 32e-3 - 0.20 * ball;
        let groove = if x.abs() < 6.2e-3 { 25.8e-3 + groove(x) } else { land };
        [groove.max(land), 32e-3 + 0.30 * ball]
    });
    let races = [(own.inner.inertia, inner), (own.outer.unwrap().inertia, outer)];
    for (ours, expected) in races {
        for (ours, expected) in [ours.mass, ours.axial, ours.transverse].iter().zip(expected) {
            // The profile has a corner at the groove's edge, which the midpoint sum meets to 1e-5
            // of its length; the groove itself is smooth there.
            assert!((ours / expected - 1.0).abs() <= 1e-5, "{ours} {expected}");
        }
    }
}

#[test]
fn laws_take_their_coefficients() {
    let law = |lines: &str| problem(&format!("[traction]\n{lines}")).traction;
    assert_eq!(
        law(""),
        TractionLaw::SlideToRoll { curve: ExponentialCurve::BOUNDARY, entrainment_floor: 0.01 }
    );
    assert_eq!(
        law("law = \"slip-speed\"\nb = \"2 s/m\"\nc = \"0.5 s/mm\"\nd = 0.07"),
        TractionLaw::SlipSpeed { curve: ExponentialCurve { b: 2.0, c: 500.0, d: 0.07 } }
    );
    assert_eq!(
        law("law = \"constant\"\ncoefficient = 0.05\nregularisation_speed = \"20 mm/s\""),
        TractionLaw::Constant { coefficient: 0.05, regularisation_speed: 0.02 }
    );
    // Off is off, whatever else is given.
    assert_eq!(law("law = \"none\"\ncoefficient = 0.05\nb = 1"), TractionLaw::None);
    let lines = "[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"0.1 s/m\"";
    let damping = ContactDamping::HuntCrossley { alpha: 0.1 };
    assert_eq!(problem(lines).damping, damping);
}

/// (b x − d) e^(−c x) + d with b = 39, c = 10, d = 1 is greatest at x = 1/c + d/b = 0.1256, 2.11 there; with b = 33, 1.95 at 0.1303.
#[test]
fn curves_with_a_coefficient_above_2_are_refused() {
    let curve = |b: f64| {
        let lines =
            format!("[traction]\nlaw = \"slip-speed\"\nb = \"{b} s/m\"\nc = \"10 s/m\"\nd = 1");
        let x = 0.1 + 1.0 / b;
        ((b * x - 1.0) * (-10.0 * x).exp() + 1.0, scene::resolve(&document(&lines)))
    };
    let (peak, refused) = curve(39.0);
    assert!(peak > 2.05 && refused.is_err(), "{peak}");
    let (peak, taken) = curve(33.0);
    assert!(peak < 1.99 && taken.is_ok(), "{peak}");
}

#[test]
fn setting_a_profile_replaces_it_by_a_constant() {
    let mut document = document(
        "[inner_race]\nz.load = { ramp = [\"0 N\", \"250 N\"], duration = \"1 s\" }\n\
         speed = { ramp = [\"0 rpm\", \"60 rpm\"], duration = \"1 s\" }\n\
         [outer_race]\nmotion = \"5-dof\"\nx = { load = \"5 N\" }\n\
         [traction]\nlaw = \"slip-speed\"\nb = \"1 s/m\"\nc = \"100 s/m\"\nd = 0.1\n\
         [numerics]\nend = \"1 s\"\nstep = \"1 us\"\n",
    );
    for (key, value) in [
        ("inner_race.z.displacement", "-3 um"),
        ("inner_race.torque", "2 N m"),
        ("outer_race.x", "4 um"),
        ("traction.b", "3 s/m"),
        ("traction.c", "200 s/m"),
        ("numerics.step_fraction", "0.25"),
    ] {
        document.set(key, value).unwrap_or_else(|error| panic!("{error}"));
    }
    let scene = resolved(&document);
    let problem = dynamic_problem(&scene).unwrap();
    assert_eq!(problem.inner.drives[2], Drive::Motion(Profile::Constant(-3e-6)));
    assert_eq!(problem.inner.rotation, Rotation::Torque(Profile::Constant(2.0)));
    assert_eq!(problem.outer_start[0], 4e-6);
    assert_eq!(problem.outer.unwrap().drives[0], Drive::Load(Profile::ZERO));
    let curve = ExponentialCurve { b: 3.0, c: 200.0, d: 0.1 };
    assert_eq!(problem.traction, TractionLaw::SlipSpeed { curve });
    let run = run_options(&scene).unwrap();
    assert_eq!(run.options.stepping, Stepping::FractionOfLimit(0.25));
    assert_eq!(run.options.integrator, Integrator::RungeKutta);
    // And back: a load takes the place of a position.
    document.set("outer_race.x.load", "1 N").unwrap();
    assert_eq!(resolved(&document).outer_race[0], 0.0);
    let values = |key: &str, text: &str| {
        let axis = document.axis(key, text).unwrap_or_else(|error| panic!("{error}"));
        (0..axis.len()).map(|index| axis.value(index).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(values("inner_race.speed", "0 rpm .. 600 rpm / 3"), ["0 rpm", "300 rpm", "600 rpm"]);
    assert_eq!(values("traction.b", "1 s/m .. 3 s/m / 2"), ["1 s/m", "3 s/m"]);
    assert_eq!(values("traction.b", "1 .. 3 / 2"), ["1", "3"]);
}

#[test]
fn json_and_toml_of_the_same_motion_resolve_equally() {
    for name in ["cage_600rpm.toml", "impact.toml", "rotating_load_orbit.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        let value: serde_json::Value =
            toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let json = scene::read_str(&value.to_string(), Format::Json, "a.json").unwrap();
        let toml = shipped(name);
        assert_eq!(json.dynamics, toml.dynamics);
        assert_eq!(json.conditions, toml.conditions);
    }
}

#[test]
fn a_scene_without_an_end_says_so_when_it_is_to_run() {
    let error = run_options(&resolved(&document(""))).unwrap_err().to_string();
    assert!(error.contains("numerics.end") && error.contains("Hint: add"), "{error}");
}

#[test]
fn an_accuracy_takes_the_place_of_a_step() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let text = std::fs::read_to_string(folder.join("settling.toml")).unwrap();
    for (keys, integrator, stepping) in [
        ("step = \"2 us\"", Integrator::Rosenbrock, Stepping::Fixed(2e-6)),
        ("accuracy = 1e-4", Integrator::Rosenbrock, Stepping::Accuracy(1e-4)),
        ("accuracy = 0.01", Integrator::DormandPrince, Stepping::Accuracy(0.01)),
        ("", Integrator::Rosenbrock, Stepping::Accuracy(1e-3)),
    ] {
        let keys = format!("integrator = \"{}\"\n{keys}", integrator.name());
        let changed = text.replacen("step = \"1 us\"", &keys, 1);
        assert_ne!(changed, text);
        let scene = scene::read_str(&changed, scene::Format::Toml, "changed").unwrap();
        let run = run_options(&scene).unwrap();
        assert_eq!((run.options.integrator, run.options.stepping), (integrator, stepping));
    }
}

#[test]
fn without_a_step_error_control_takes_it_and_the_plan_the_integrator() {
    use Integrator::{Rosenbrock, RungeKutta};
    for (keys, integrator, stepping, by_plan) in [
        ("", Rosenbrock, Stepping::Accuracy(1e-3), true),
        ("accuracy = 1e-4", Rosenbrock, Stepping::Accuracy(1e-4), true),
        ("step = \"2 us\"", RungeKutta, Stepping::Fixed(2e-6), false),
        ("step_fraction = 0.25", RungeKutta, Stepping::FractionOfLimit(0.25), false),
        ("integrator = \"rk4\"", RungeKutta, Stepping::FractionOfLimit(0.5), false),
        ("integrator = \"rosenbrock\"", Rosenbrock, Stepping::Accuracy(1e-3), false),
    ] {
        let scene = resolved(&document(&format!("[numerics]\nend = \"1 s\"\n{keys}\n")));
        let run = run_options(&scene).unwrap();
        let found = (run.options.integrator, run.options.stepping, run.by_plan);
        assert_eq!(found, (integrator, stepping, by_plan), "{keys}");
        // What fills the hole is said.
        let defaults = &scene.dynamics.defaults_used;
        let said = defaults.iter().any(|used| used.key == "numerics.accuracy");
        assert_eq!(said, stepping == Stepping::Accuracy(1e-3), "{defaults:?}");
    }
}

#[test]
fn energy_limits_are_those_that_the_reference_states() {
    let (_, key) = keys::find("numerics.energy_limit").unwrap();
    assert_eq!(key.need, Need::Depends("0.01; with an `accuracy` 0.2"));
    for (lines, limit) in [
        ("step = \"1 us\"", 0.01),
        ("integrator = \"rk4\"", 0.01),
        ("integrator = \"dormand-prince\"", 0.2),
        ("accuracy = 0.01", 0.2),
        ("", 0.2),
        ("energy_limit = 0.5", 0.5),
        ("step = \"1 us\"\nenergy_limit = 1", 1.0),
    ] {
        let scene = resolved(&document(&format!("[numerics]\nend = \"1 s\"\n{lines}\n")));
        assert_eq!(run_options(&scene).unwrap().options.energy_limit, limit, "{lines}");
        let defaults = &scene.dynamics.defaults_used;
        let said = defaults.iter().find(|used| used.key == "numerics.energy_limit");
        let said = said.map(|used| used.value.parse::<f64>().unwrap());
        assert_eq!(said, (!lines.contains("energy_limit")).then_some(limit));
    }
}

/// Mass added to the inner race adds to its mass alone, whether its inertia is given or follows from the geometry.
#[test]
fn added_mass_adds_to_the_mass_alone() {
    let given =
        "inertia = { mass = \"0.2 kg\", axial = \"1 kg mm^2\", transverse = \"1 kg mm^2\" }\n";
    for [inner, outer] in [["", ""], ["", given], [given, ""], [given, given]] {
        let rest = format!("{inner}[outer_race]\nmotion = \"5-dof\"\n{outer}");
        let of = |added: &str| problem(&format!("[inner_race]\n{added}{rest}"));
        let (plain, laden) = (of(""), of("added_mass = \"0.75 kg\"\n"));
        let (was, is) = (plain.inner.inertia, laden.inner.inertia);
        assert_eq!(is.mass, was.mass + 0.75);
        assert_eq!((is.axial, is.transverse), (was.axial, was.transverse));
        let outer = |of: &DynamicProblem| of.outer.as_ref().expect("a moving outer race").inertia;
        assert_eq!(outer(&plain), outer(&laden));
    }
}

/// A change drives as fast as it is, however it is written: a ramp, and a table of its two ends.
#[test]
fn a_table_drives_as_fast_as_the_ramp_that_it_draws() {
    let of = |profile: &str| {
        let scene = resolved(&document(&format!("[inner_race]\nz = {{ load = {profile} }}\n")));
        excitations(&AssemblyScene::alone(scene))
    };
    let ramp = of(r#"{ ramp = ["0 N", "250 N"], start = "5 ms", duration = "0.1 s" }"#);
    let table = of(r#"{ table = [["5 ms", "0 N"], ["105 ms", "250 N"], ["2 s", "250 N"]] }"#);
    // Half a period of a swing up and down.
    assert_eq!((ramp.len(), ramp[0].what.as_str()), (1, "inner_race.z"));
    assert!((ramp[0].frequency - 5.0).abs() <= 1e-14, "{ramp:?}");
    assert_eq!((table.len(), &table[0].what), (1, &ramp[0].what));
    assert!((table[0].frequency / ramp[0].frequency - 1.0).abs() <= 1e-14, "{table:?}");
}

/// Balls roll between both races: an outer race that turns takes them along, past a load that stands still.
#[test]
fn balls_pass_the_load_as_both_races_turn() {
    let passing = |inner: &str, outer: &str| {
        let lines = format!(
            "inner_race.speed = \"{inner}\"\n[outer_race]\nmotion = \"5-dof\"\nspeed = \"{outer}\"\n"
        );
        let all = excitations(&AssemblyScene::alone(resolved(&document(&lines))));
        let of_balls =
            |all: &[Excitation]| all.iter().find(|one| one.is_ripple).map(|of| of.frequency);
        of_balls(&all).unwrap_or(0.0)
    };
    // Balls of 12 mm in diameter less 5 um on a pitch radius of 26 mm.
    let cage = 0.5 * (1.0 - 6.005 / 26.0);
    for (inner, outer, turns) in [
        (0.0, 600.0, (1.0 - cage) * 600.0),
        (600.0, 1000.0, cage * 600.0 + (1.0 - cage) * 1000.0),
        (600.0, -1000.0, (1.0 - cage) * 1000.0 - cage * 600.0),
        (600.0, 0.0, cage * 600.0),
    ] {
        let found = passing(&format!("{inner} rpm"), &format!("{outer} rpm"));
        let expected: f64 = 8.0 * turns / 60.0;
        assert!((found / expected - 1.0).abs() <= 1e-3, "{inner} {outer}: {found} {expected}");
    }
}
