//! `bearing check SCENE`.

use super::remarks::of_springs;
use super::run::{planned_request, request};
use super::{CommandResult, Outcome, assembly, echo, echo_run, say};
use bearing_dynamics::ch2_housing::bearing::geometry::BearingKind;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::session::table_size;
use bearing_dynamics::output::visible::visible_line;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::{
    CageInRun, Document, RunSettings, Scene, Subject, resolve_subject, statics::static_problem,
};
use bearing_dynamics::solver::dynamics::run::Stepping;
use bearing_dynamics::solver::plan::motion::race_freedom;
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
        Subject::Bearing(scene) => AssemblyScene::alone(*scene),
        Subject::Assembly(scene) => *scene,
    };
    for placed in &scene.bearings {
        static_problem(&placed.scene)?;
    }
    let housings = assembly::housings::prepare(&document, &scene)?;
    if let Some(settings) = scene.run().cloned() {
        // Bearings that are to move have to make bodies, too.
        let assembly = scene.assembly()?;
        let mut request = request(scene.common(), &settings);
        if scene.housing_method().is_none() {
            (request, _) = planned_request(&scene, &settings, &assembly, None);
            table_size(assembly, &request)?;
        }
        let run = RunSettings { options: request.options, ..settings };
        scene.bearings[0].scene.dynamics.run = Some(run);
    }
    let scene = &scene;
    if arguments.json {
        let mut understood = assembly::echo(scene)?;
        if let Some(run) = scene.run() {
            understood["motion"] = assembly::motion(scene)?;
            understood["numerics"] = echo_run::numerics(run)?;
        }
        understood["output"] = echo_run::output(scene.common())?;
        for (name, notes) in
            echo_run::notes(&scene.common().assumptions, &assembly::defaults(scene))
        {
            understood[name] = notes;
        }
        say(&pretty(&understood))?;
    } else {
        say(&summary(&arguments.scene.display().to_string(), scene))?;
        for housing in &housings {
            say(&housing.text())?;
        }
    }
    Ok(Outcome::Done)
}

fn summary(name: &str, scene: &AssemblyScene) -> String {
    let mut text = format!("{}: a valid scene\n", visible_line(name));
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<22} {}", visible_line(&value));
    };
    if let Some(title) = &scene.common().title {
        line("title", title.clone());
    }
    for placed in &scene.bearings {
        if let Some(name) = &placed.name {
            line("bearing", format!("\"{name}\""));
        }
        bearing_lines(&placed.scene, &mut line);
    }
    match scene.only() {
        Some(alone) if alone.dynamics.run.is_some() => {
            for (label, value) in motion(alone) {
                line(label, value);
            }
        }
        Some(_) => {}
        None => {
            for (label, value) in assembly::lines(scene) {
                line(&label, value);
            }
            if let Some(run) = scene.run() {
                line("run", format!("to t = {} s by {}", run.end, stepping(run)));
            }
            for remark in of_springs(scene) {
                line("note", remark);
            }
        }
    }
    for used in assembly::defaults(scene) {
        line("default", format!("{} = {} ({})", used.key, used.value, used.reason));
    }
    for assumption in &scene.common().assumptions {
        line("assumption", format!("{}: {}", assumption.name, assumption.text));
    }
    text
}

/// Title and geometry, a line each.
pub fn bearing_lines(scene: &Scene, line: &mut impl FnMut(&str, String)) {
    let (geometry, sizes) = (&scene.geometry, &scene.dimensions);
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
