//! `bearing check` of a bearing in its housing.

use super::{
    condensed, defaults, echo, mesh_text, prepare, refuse_moved_supports, refuse_moving, shape_text,
};
use crate::commands::check::{bearing_lines, bodies, stepping};
use crate::commands::solid::mesh_notes;
use crate::commands::{CommandResult, Outcome, echo_run, say};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::summary::housing::seat_section;
use bearing_dynamics::output::summary::solid::mesh_section;
use bearing_dynamics::output::visible::visible_line;
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::scene::housing::{HousedScene, HousingMethod};
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::solver::housing::bore_equilibrium::Axial;
use bearing_dynamics::solver::solid::support::free_motions;
use std::fmt::Write;
use std::path::Path;

pub fn run(path: &Path, document: &Document, scene: &HousedScene, json: bool) -> CommandResult {
    let prepared = prepare(document, scene)?;
    static_problem(&scene.bearing)?;
    dynamic_problem(&scene.bearing)?;
    let setup = &prepared.setup;
    if scene.housing.method == HousingMethod::QuasiStatic {
        refuse_moving(document, scene)?;
        // What cannot be condensed cannot be run.
        if free_motions(&setup.solid.problem).count > 0 {
            condensed(&prepared)?;
        }
    }
    if scene.housing.method == HousingMethod::Reduced {
        refuse_moved_supports(document, scene)?;
        if free_motions(&setup.solid.problem).count > 0 {
            condensed(&prepared)?;
        }
    }
    if json {
        let mut echo = echo::scene(scene)?;
        echo["seat"] = seat_section(setup)?;
        echo["mesh"] = mesh_section(&prepared.built)?;
        echo["output"] = echo_run::output(&scene.bearing)?;
        for (name, notes) in echo_run::notes(&scene.bearing.assumptions, &defaults(scene)) {
            echo[name] = notes;
        }
        say(&pretty(&echo))?;
        return Ok(Outcome::Done);
    }
    let mut text = format!("{}: a valid scene\n", visible_line(&path.display().to_string()));
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<22} {}", visible_line(&value));
    };
    if let Some(title) = &scene.bearing.title {
        line("title", title.clone());
    }
    bearing_lines(&scene.bearing, &mut line);
    line("housing", format!("{}; {}", mesh_text(&prepared.built), echo::method(scene)));
    for note in mesh_notes(&prepared.built) {
        line("note", note);
    }
    let mass: f64 = setup.model.mass.iter().sum();
    let held = setup.solid.problem.prescribed.len();
    line("housing mass", format!("{mass:.6} kg; {held} components held"));
    let um = 1e6 * setup.interference;
    let kind = match um {
        um if um > 0.0 => "interference",
        um if um < 0.0 => "clearance",
        _ => "transition",
    };
    line(
        "seat",
        format!(
            "bore radius {:.4} mm, {} nodes, {:.4} mm wide; {kind} {:+.4} um radial = {:+.4} um \
             diametral",
            1e3 * setup.bore_radius,
            setup.nodes.len(),
            1e3 * setup.width,
            um,
            2.0 * um
        ),
    );
    line("bore shape", shape_text(setup));
    if let Some(caution) = &setup.caution {
        line("caution", caution.clone());
    }
    let stiffness = match scene.housing.penalty {
        Penalty::PerArea(stiffness) => format!("{stiffness:e} N/m^3, by area"),
        Penalty::PerNode(stiffness) => format!("{stiffness:e} N/m for each node"),
    };
    line("seat stiffness", stiffness);
    let axial = match scene.housing.axial {
        Axial::Held => "held beside the bore",
        Axial::Free => "free",
    };
    line("outer race, axially", axial.into());
    for (label, value) in motion(scene) {
        line(label, value);
    }
    for used in defaults(scene) {
        line("default", format!("{} = {} ({})", used.key, used.value, used.reason));
    }
    for assumption in &scene.bearing.assumptions {
        line("assumption", format!("{}: {}", assumption.name, assumption.text));
    }
    say(&text)?;
    Ok(Outcome::Done)
}

/// What a run computes, and how.
fn motion(scene: &HousedScene) -> Vec<(&'static str, String)> {
    let Some(run) = &scene.bearing.dynamics.run else { return Vec::new() };
    let (end, interval) = (run.end, run.output_interval);
    let fields = match scene.housing.fields_interval {
        Some(interval) => format!("every {interval} s"),
        None => "at the end".into(),
    };
    let mut said = match scene.housing.method {
        HousingMethod::QuasiStatic => vec![
            ("run", format!("to t = {end} s, an equilibrium every {interval} s")),
            ("motion", "none but along the equilibria: inertia is left out".into()),
        ],
        HousingMethod::Reduced => {
            let mut said = vec![
                ("run", format!("to t = {end} s, a row every {interval} s")),
                ("steps", format!("{}, of bearing and housing together", stepping(run))),
            ];
            said.extend(bodies(&scene.bearing));
            said
        }
        HousingMethod::Explicit => {
            let windows = format!(
                "windows of {} of the seat's phase; the housing by central differences, {} of the \
                 largest stable step; the bearing by {}",
                scene.housing.window_phase,
                scene.housing.step_fraction,
                stepping(run)
            );
            let mut said = vec![
                ("run", format!("to t = {end} s, a row every {interval} s")),
                ("steps", windows),
            ];
            said.extend(bodies(&scene.bearing));
            said
        }
    };
    said.push(("fields", fields));
    said
}
