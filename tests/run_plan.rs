//! The plan of a run: what each scene computes, what it leaves out, and why.

use bearing_dynamics::scene::dynamics::{dynamic_problem, run_options};
use bearing_dynamics::scene::{self, CageInRun, Format};
use bearing_dynamics::solver::channels::ChannelGroup;
use bearing_dynamics::solver::dynamics::run::Simulation;
use bearing_dynamics::solver::plan;

const BEARING: &str = r#"
[bearing]
kind = "deep-groove"
balls = 8
clearance = { radial = "-5 um" }
inner_race = { radius = "20.047 mm", groove_radius = "6.013 mm", bore_radius = "15 mm" }
outer_race = { radius = "31.953 mm", groove_radius = "6.310 mm", outer_radius = "36 mm" }
"#;

const CAGE: &str = r#"
[bearing.cage]
pocket_radius = "6.1 mm"
inner_radius = "23.5 mm"
outer_radius = "28.5 mm"
mass = "20 g"
length = "12 mm"
"#;

const GRAVITY: &str = r#"
[ball_forces]
gravity = ["0 m/s^2", "0 m/s^2", "-9.80665 m/s^2"]
"#;

const END: &str = "[numerics]\nend = \"1 ms\"\n";

fn planned(text: &str, channels: &[ChannelGroup]) -> String {
    let scene = scene::read_str(text, Format::Toml, "scene.toml").unwrap();
    let (problem, settings) = (dynamic_problem(&scene).unwrap(), run_options(&scene).unwrap());
    let left_out = match &scene.dynamics.cage {
        CageInRun::Body(_) => None,
        CageInRun::LeftOut(reason) => Some(reason.as_str()),
    };
    let stages = plan::dynamics(&problem, &settings.options, channels, left_out);
    stages
        .iter()
        .map(|stage| {
            let mark = if stage.included { "does " } else { "skips" };
            format!("{mark} {:<28} {}\n", stage.name, stage.reason)
        })
        .collect()
}

fn guided(by: &str) -> String {
    format!("{CAGE}guidance = \"{by}\"\nrace_clearance = \"0.1 mm\"\n")
}

#[test]
fn everything_left_out() {
    let traction = "[traction]\nlaw = \"none\"\nslices = 15\n";
    insta::assert_snapshot!(planned(&format!("{BEARING}{traction}{END}"), &[]));
}

#[test]
fn everything_at_once() {
    let races = r#"
[inner_race]
z = { load = "-250 N" }
speed = "1000 rpm"
unbalance = "1e-4 kg m"
rotating_load = { force = "10 N", speed = "50 rpm" }
[outer_race]
motion = "5-dof"
foundation = { stiffness = { y = "1e8 N/m", z = "1e8 N/m" } }
[traction]
heathcote = true
[contact_damping]
law = "lankarani-nikravesh"
restitution = 0.9
slowest = "1e-3 m/s"
"#;
    let cage = guided("outer-race");
    let text =
        format!("{BEARING}{cage}{GRAVITY}{races}{END}start = \"nominal\"\nstep = \"1 us\"\n");
    insta::assert_snapshot!(planned(&text, &ChannelGroup::ALL));
}

#[test]
fn defaults() {
    insta::assert_snapshot!(planned(&format!("{BEARING}{END}"), &ChannelGroup::DEFAULT));
}

#[test]
fn cage_guided_by_balls() {
    let text = format!("{BEARING}{CAGE}guidance = \"balls\"\n{END}step_fraction = 0.25\n");
    insta::assert_snapshot!(planned(&text, &ChannelGroup::DEFAULT));
}

#[test]
fn cage_that_lacks_a_key() {
    let cage = CAGE.replace("mass = \"20 g\"\n", "");
    let damping = "[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"0.1 s/m\"\n";
    let constant = "[traction]\nlaw = \"constant\"\ncoefficient = 0.1\nslices = 5\n\
        regularisation_speed = \"0.01 m/s\"\n";
    let text = format!("{BEARING}{cage}{damping}{constant}{END}");
    insta::assert_snapshot!(planned(&text, &[ChannelGroup::Loads, ChannelGroup::Cage]));
}

#[test]
fn all_motion_given() {
    let inner = r#"
[inner_race]
x = { displacement = "0 um" }
y = { displacement = "0 um" }
z = { displacement = "-2 um" }
tilt_y = { tilt = "0.1 deg" }
tilt_z = { tilt = "0 deg" }
speed = "1000 rpm"
[outer_race]
motion = "6-dof"
"#;
    let text = format!("{BEARING}{inner}{END}");
    insta::assert_snapshot!(planned(&text, &[ChannelGroup::Races, ChannelGroup::Slip]));
}

/// What the plan says is skipped is not counted either.
#[test]
fn skipped_stages_do_no_work() {
    let counted = |text: &str| {
        let scene = scene::read_str(text, Format::Toml, "scene.toml").unwrap();
        let settings = run_options(&scene).unwrap();
        let mut simulation =
            Simulation::new(dynamic_problem(&scene).unwrap(), settings.options).unwrap();
        for _ in 0..10 {
            simulation.step().unwrap();
        }
        simulation.system.work
    };
    let load = "[inner_race]\nz = { load = \"-250 N\" }\nspeed = \"100 rpm\"\n";
    let step = "step = \"0.1 us\"\n";
    let bare = format!("{BEARING}{load}[traction]\nlaw = \"none\"\n{END}{step}");
    let work = counted(&bare);
    assert_eq!((work.slices, work.pocket_tests, work.guide_tests), (0, 0, 0));
    let balls = format!("{BEARING}{CAGE}guidance = \"balls\"\n{load}{END}{step}");
    let work = counted(&balls);
    assert!(work.slices > 0 && work.pocket_tests > 0, "{work:?}");
    assert_eq!(work.guide_tests, 0);
    let guided = format!("{BEARING}{}{load}{END}{step}", guided("inner-race"));
    assert_eq!(counted(&guided).guide_tests, 2 * counted(&guided).evaluations);
}
