//! The plan of a run: what each scene computes, what it leaves out, and why.

use crate::command_line_common::{DEEP_GROOVE, done, read, scene as scene_file, write};
use crate::run_common;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::plan::channels::ChannelGroup;

use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::motion::integrator_choice::choose;
use bearing_dynamics::motion::plan::{self, Planned};
use bearing_dynamics::motion::simulation::{Integrator, Simulation};
use bearing_dynamics::numeric::clock::given_steps;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{RunRequest, Session, SessionError, Status, table_size};
use bearing_dynamics::scene;
use bearing_dynamics::scene::build::motion::{dynamic_problem, run_options};
use bearing_dynamics::scene::{CageInRun, Format};
use run_common::{frictionless, jolted, pressed, rattling, request, simulation};

const BEARING: &str = r#"
defaults = "dissertation"
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

const END: &str = "[numerics]\nend = \"1 ms\"\nintegrator = \"rk4\"\n";
const DEFAULT: &str = "[numerics]\nend = \"1 ms\"\n";

fn planned(text: &str, channels: &[ChannelGroup]) -> String {
    let scene = scene::read_str(text, Format::Toml, "scene.toml").unwrap();
    let (problem, settings) = (dynamic_problem(&scene).unwrap(), run_options(&scene).unwrap());
    let left_out = match &scene.dynamics.cage {
        CageInRun::Body(_) => None,
        CageInRun::LeftOut(reason) => Some(reason.as_str()),
    };
    let planned = Planned {
        assembly: &problem.assembly(),
        options: &settings.options,
        channels,
        cage_left_out: &[left_out],
        solids: Vec::new(),
    };
    plan::items(planned).iter().map(|item| format!("{item}\n")).collect()
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
[contact_damping]
law = "hunt-crossley"
alpha = "0.1 s/m"
"#;
    let cage = guided("outer-race");
    let text =
        format!("{BEARING}{cage}{GRAVITY}{races}{END}start = \"nominal\"\nstep = \"1 us\"\n");
    insta::assert_snapshot!(planned(&text, &ChannelGroup::ALL));
}

#[test]
fn defaults() {
    insta::assert_snapshot!(planned(&format!("{BEARING}{DEFAULT}"), &ChannelGroup::DEFAULT));
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

fn taken(problem: &DynamicProblem, request: &RunRequest) -> u64 {
    let mut session = Session::start(problem.clone(), request).unwrap();
    while session.advance(1000).unwrap() == Status::Running {}
    simulation(&session).steps
}

#[test]
fn given_steps_are_counted_as_the_run_takes_them() {
    let step = 1e-6;
    for problem in [frictionless(), jolted(), pressed(step)] {
        for interval in [1e-6, 10e-6, 12.34e-6, 37e-6, 1e-3] {
            for end in [203.4e-6, 200e-6, 55.31e-6, 0.4e-6, 74e-6] {
                let wanted = RunRequest { end, output_interval: interval, ..request(step, 1) };
                let (foretold, taken) = (
                    given_steps(
                        &problem.assembly().corners(),
                        wanted.output_interval,
                        wanted.end,
                        step,
                    ),
                    taken(&problem, &wanted),
                );
                assert_eq!(foretold, taken, "rows {interval}, end {end}");
            }
        }
    }
}

/// Rows of a nanosecond are refused before anything is computed, with an interval that would do.
#[test]
fn a_table_that_is_too_large_is_refused_with_its_size() {
    let wanted = RunRequest { end: 20e-3, output_interval: 1e-9, ..request(1e-6, 20) };
    let error = Session::start(frictionless(), &wanted).err().unwrap();
    let SessionError::TooLarge { size } = &error else { panic!("{error}") };
    assert!((size.rows - 20_000_001.0).abs() <= 1.0, "{size:?}");
    let columns =
        Session::start(frictionless(), &request(1e-6, 20)).unwrap().recorder.columns().len();
    assert_eq!(size.columns, columns);
    let told = error.to_string();
    assert!(told.contains(" make ") && told.contains("more than 0.8 GB"), "{told}");
    assert!(told.contains("numerics.output_interval ("), "{told}");
    // What would do does, as it is written, and hardly less would.
    let (_, would_do) = told.split_once("numerics.output_interval (").unwrap();
    let would_do: f64 = would_do.split(' ').next().unwrap().parse().unwrap();
    let fits = RunRequest { output_interval: would_do, ..wanted.clone() };
    let size = table_size(frictionless().assembly(), &fits).unwrap();
    assert!(size.rows * columns as f64 * 8.0 <= 0.8e9, "{size:?}");
    let less = RunRequest { output_interval: 0.9 * would_do, ..wanted };
    assert!(table_size(frictionless().assembly(), &less).is_err());
}

/// Implicit where friction is steep, explicit where nothing is.
#[test]
fn stiff_traction_asks_for_the_implicit_method() {
    let steep = DynamicProblem {
        traction: TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 5e-4 },
        ..frictionless()
    };
    let mut reversed = steep.clone();
    reversed.inner.rotation =
        Rotation::Speed(Profile::Ramp { from: 200.0, to: -200.0, start: 5e-3, duration: 10e-3 });
    for (problem, integrator) in [
        (steep, Integrator::Rosenbrock),
        (reversed, Integrator::Rosenbrock),
        (rattling(), Integrator::DormandPrince),
        (frictionless(), Integrator::DormandPrince),
    ] {
        let choice = choose(&problem.assembly());
        assert_eq!(choice.integrator, integrator, "{}", choice.reason);
    }
}

/// Races and cage at rest: friction that stands still is stiff.
#[test]
fn a_nominal_start_is_judged_in_equilibrium() {
    let axes = |values: [&str; 5]| {
        let named = ["x", "y", "z", "tilt_y", "tilt_z"].into_iter().zip(values);
        named.map(|(axis, value)| format!("{axis} = \"{value}\"\n")).collect::<String>()
    };
    let stiffness = axes(["1e5 N/m", "1e5 N/m", "1e5 N/m", "1e3 N m/rad", "1e3 N m/rad"]);
    let damping = axes(["100 N s/m", "20 N s/m", "20 N s/m", "0.1 N m s/rad", "0.1 N m s/rad"]);
    let text = format!(
        "defaults = \"dissertation\"
[bearing]
kind = \"deep-groove\"
balls = 9
clearance = {{ radial = \"100 um\" }}
ball = {{ diameter = \"12 mm\" }}
inner_race = {{ radius = \"24 mm\", groove_radius = \"6.24 mm\", bore_radius = \"20 mm\" }}
outer_race = {{ groove_radius = \"6.36 mm\" }}
[bearing.cage]
pocket_radius = \"6.2 mm\"
inner_radius = \"27 mm\"
outer_radius = \"33 mm\"
race_clearance = \"0.2 mm\"
mass = \"0.05 kg\"
guidance = \"outer-race\"
[inner_race]
z = {{ load = \"-1500 N\" }}
[outer_race]
motion = \"5-dof\"
[outer_race.foundation.stiffness]
{stiffness}[outer_race.foundation.damping]
{damping}[numerics]
end = \"0.1 s\"
start = \"nominal\"
"
    );
    let folder = tempfile::tempdir().unwrap();
    let said = done(&["plan", &write(folder.path(), "scene.toml", &text)]);
    let chosen = said.lines().find(|line| line.contains("choice of the integrator")).unwrap();
    assert!(chosen.contains(" rosenbrock: slip decay rate over contact frequency is "), "{chosen}");
}

/// Below, a little above and far above the limit that the plan itself tells.
#[test]
fn a_given_step_is_held_against_the_largest_stable_one() {
    let folder = tempfile::tempdir().unwrap();
    let said = |step: &str| {
        let numerics = "integrator = \"rk4\"\nend = \"10 us\"\noutput_interval = \"1 us\"";
        let text = format!("{DEEP_GROOVE}[numerics]\n{numerics}\n{step}");
        done(&["plan", &write(folder.path(), "scene.toml", &text)])
    };
    const LIMIT: &str = "of the largest stable one at the start, ";
    let chosen = said("");
    let (_, limit) = chosen.split_once(LIMIT).unwrap();
    let limit: f64 = limit.split(' ').next().unwrap().parse().unwrap();
    for (part, verdict) in [
        (0.5, "): stable at the start; "),
        (1.05, "): longer than stable; "),
        (1.2, "): too long, the run will be refused; "),
    ] {
        let said = said(&format!("step = \"{:e} s\"\n", part * limit));
        let line = said.lines().find(|line| line.starts_with("notes given step")).unwrap();
        assert!(line.contains(&format!("is {part:.3} {LIMIT}")), "{line}");
        assert!(line.contains(verdict), "{line}");
    }
}

/// Lines of a plan that are items: mark, name and reason.
fn item_lines(text: &str) -> Vec<[String; 3]> {
    let folder = tempfile::tempdir().unwrap();
    let said = done(&["plan", &write(folder.path(), "scene.toml", text)]);
    let items = said.lines().filter(|line| line.starts_with("does ") || line.starts_with("skips"));
    let parts = |line: &str| [&line[..5], line[6..34].trim(), &line[35..]].map(String::from);
    items.map(parts).collect()
}

/// What a bearing and a solid say alone they say of a bearing in its housing.
#[test]
fn the_plan_of_a_housed_scene_is_made_of_the_items_of_its_parts() {
    let text = read(std::path::Path::new(&scene_file("housing_impact.toml")));
    let (bearing, rest) = text.split_once("[housing]").unwrap();
    let (housing, numerics) = rest.split_once("[numerics]").unwrap();
    let (_, solid) = housing.split_once("[solid]").unwrap();
    let bearing = format!("{bearing}[numerics]\nintegrator = \"rk4\"{numerics}");
    let solid = format!("[solid]{solid}[numerics]\nend = \"1 ms\"\noutput_interval = \"5 us\"\n");
    let whole = item_lines(&text);
    let alone = item_lines(&bearing);
    // In a housing the outer race is held along its axis.
    let others = ["flexible bodies", "outer race motion"];
    let of_bearing = alone.iter().filter(|[_, name, _]| !others.contains(&name.as_str()));
    let mut found = 0;
    for item in of_bearing {
        assert!(whole.contains(item), "{item:?} of {whole:?}");
        found += 1;
    }
    // Its mesh is said in other words, and how it is solved for is another question.
    for [mark, name, why] in item_lines(&solid) {
        if ["supports", "loads", "gravity", "damping"].contains(&name.as_str()) {
            let named = [mark, format!("housing {name}"), why];
            assert!(whole.contains(&named), "{named:?} of {whole:?}");
            found += 1;
        }
    }
    // Besides them the outer race, the mesh, explicit steps, the seat and what it hands over.
    assert_eq!(found + 5, whole.len(), "{whole:?}");
}
