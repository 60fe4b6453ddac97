//! `bearing check SCENE`.

use super::run::planned_request;
use super::{CommandResult, Outcome, echo, echo_run, say};
use bearing_dynamics::ch2_housing::bearing::geometry::BearingKind;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::session::table_size;
use bearing_dynamics::output::visible::visible_line;
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::scene::{
    CageInRun, Document, RunSettings, Scene, Subject, resolve_subject, statics::static_problem,
};
use bearing_dynamics::solver::dynamics::run::Stepping;
use bearing_dynamics::solver::plan::race_freedom;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    /// Print everything that was understood, in SI-based units, as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let document = Document::read_file(&arguments.scene)?;
    let mut scene = match resolve_subject(&document)? {
        Subject::Solid(solid) => {
            return super::solid::check::run(&arguments.scene, &document, &solid, arguments.json);
        }
        Subject::Housed(housed) => {
            return super::housed::check::run(&arguments.scene, &document, &housed, arguments.json);
        }
        Subject::Bearing(scene) => *scene,
    };
    static_problem(&scene)?;
    // A bearing that is to move has to make bodies, too.
    let in_motion = match scene.dynamics.run {
        Some(_) => Some(dynamic_problem(&scene)?),
        None => None,
    };
    if let (Some(problem), Some(settings)) = (&in_motion, scene.dynamics.run.clone()) {
        let (request, _) = planned_request(&scene, &settings, problem, None);
        table_size(problem.assembly(), &request)?;
        scene.dynamics.run = Some(RunSettings { options: request.options, ..settings });
    }
    if arguments.json {
        let mut understood = echo::scene(&scene)?;
        if let Some(problem) = &in_motion {
            understood["motion"] = echo_run::motion(problem)?;
        }
        if let Some(run) = &scene.dynamics.run {
            understood["numerics"] = echo_run::numerics(run)?;
        }
        understood["output"] = echo_run::output(&scene)?;
        for (name, notes) in echo_run::notes(&scene.assumptions, &echo_run::defaults(&scene)) {
            understood[name] = notes;
        }
        say(&pretty(&understood))?;
    } else {
        say(&summary(&arguments.scene.display().to_string(), &scene))?;
    }
    Ok(Outcome::Done)
}

fn summary(name: &str, scene: &Scene) -> String {
    let mut text = format!("{}: a valid scene\n", visible_line(name));
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<22} {}", visible_line(&value));
    };
    bearing_lines(scene, &mut line);
    if scene.dynamics.run.is_some() {
        for (label, value) in motion(scene) {
            line(label, value);
        }
    }
    for used in echo_run::defaults(scene) {
        line("default", format!("{} = {} ({})", used.key, used.value, used.reason));
    }
    for assumption in &scene.assumptions {
        line("assumption", format!("{}: {}", assumption.name, assumption.text));
    }
    text
}

/// Title and geometry, a line each.
pub fn bearing_lines(scene: &Scene, line: &mut impl FnMut(&str, String)) {
    let (geometry, sizes) = (&scene.geometry, &scene.dimensions);
    if let Some(title) = &scene.title {
        line("title", title.clone());
    }
    let kind = match geometry.kind {
        BearingKind::DeepGroove => "deep-groove",
        BearingKind::AngularContact => "angular-contact",
    };
    line("bearing", format!("{kind}, {} balls", geometry.ball_count));
    line(
        "ball radius",
        format!(
            "{:.6} mm in use, {:.6} mm nominal",
            1e3 * geometry.ball_radius,
            1e3 * sizes.nominal_ball_radius
        ),
    );
    line(
        "clearance",
        format!(
            "{:+.4} um radial = {:+.4} um diametral, made through the {}",
            1e6 * sizes.radial_clearance,
            1e6 * sizes.diametral_clearance,
            echo::through(sizes.clearance_through).replace('-', " ")
        ),
    );
    for (label, race) in [("inner race", &sizes.inner_race), ("outer race", &sizes.outer_race)] {
        line(
            label,
            format!(
                "radius {:.4} mm, groove {:.4} mm = {:.5} of the ball diameter = osculation {:.5}",
                1e3 * race.radius,
                1e3 * race.groove_radius,
                race.conformity,
                race.osculation
            ),
        );
    }
    line("pitch radius", format!("{:.4} mm", 1e3 * geometry.pitch_radius));
    line("contact angle", format!("{:.4} deg (nominal)", geometry.contact_angle.to_degrees()));
}

/// What moves, and how it is computed.
fn motion(scene: &Scene) -> Vec<(&'static str, String)> {
    let dynamics = &scene.dynamics;
    let mut said = Vec::new();
    if let Some(run) = &dynamics.run {
        said.push(("run", format!("to t = {} s by {}", run.end, stepping(run))));
    }
    said.extend(bodies(scene));
    said
}

/// Integrator of the bearing and its steps.
pub fn stepping(run: &RunSettings) -> String {
    let steps = match run.options.stepping {
        Stepping::Fixed(step) => format!("a step of {step:e} s"),
        Stepping::FractionOfLimit(part) => format!("{part} of the largest stable step"),
        Stepping::Accuracy(accuracy) => format!("steps for an accuracy of {accuracy}"),
    };
    format!("{}, {steps}", run.options.integrator.name())
}

/// How each body moves in steps.
pub fn bodies(scene: &Scene) -> Vec<(&'static str, String)> {
    let dynamics = &scene.dynamics;
    let mut said = Vec::new();
    let outer = match &dynamics.outer {
        Some(body) => race_freedom(body),
        None => "fixed in space".into(),
    };
    said.push(("inner race motion", race_freedom(&dynamics.inner)));
    said.push(("outer race motion", outer));
    let balls = "six coordinates each; gyroscopic and centrifugal effects by themselves";
    said.push(("ball motion", balls.into()));
    let cage = match &dynamics.cage {
        CageInRun::Body(_) => "a rigid body with six coordinates".into(),
        CageInRun::LeftOut(reason) => format!("left out: {reason}"),
    };
    said.push(("cage motion", cage));
    said
}
