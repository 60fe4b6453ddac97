//! `bearing check SCENE`.

use super::{CommandResult, Outcome, echo, echo_run, say};
use bearing_dynamics::ch2_housing::bearing::geometry::BearingKind;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::scene::{self, Scene, Subject, statics::static_problem};
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
    let scene = match scene::read_subject(&arguments.scene)? {
        Subject::Solid(solid) => {
            return super::solid::check::run(&arguments.scene, &solid, arguments.json);
        }
        Subject::Bearing(scene) => *scene,
    };
    static_problem(&scene)?;
    if arguments.json {
        let mut understood = echo::scene(&scene)?;
        if scene.dynamics.run.is_some() {
            understood["motion"] = echo_run::motion(&dynamic_problem(&scene)?)?;
        }
        say(&pretty(&understood))?;
    } else {
        say(&summary(&arguments.scene.display().to_string(), &scene))?;
    }
    Ok(Outcome::Done)
}

fn summary(name: &str, scene: &Scene) -> String {
    let (geometry, sizes) = (&scene.geometry, &scene.dimensions);
    let mut text = format!("{name}: a valid scene\n");
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<22} {value}");
    };
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
    for used in &scene.defaults_used {
        line("default", format!("{} = {} ({})", used.key, used.value, used.reason));
    }
    for assumption in &scene.assumptions {
        line("assumption", format!("{}: {}", assumption.name, assumption.text));
    }
    text
}
