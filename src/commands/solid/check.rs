//! `bearing check` of a solid: mesh, sets, supports and loads as understood.

use super::{echo, mesh_notes, prepare};
use crate::commands::{CommandResult, Outcome, echo_run, say};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::output::recorder::sum;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::summary::solid::mesh_section;
use bearing_dynamics::output::visible::visible_line;
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solver::plan::tally::Tally;
use bearing_dynamics::solver::solid::model::SolidModel;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

pub fn run(path: &Path, document: &Document, scene: &SolidScene, json: bool) -> CommandResult {
    let prepared = prepare(document, scene)?;
    let model =
        SolidModel::labelled(prepared.setup.problem.clone(), prepared.setup.labels.clone())?;
    if json {
        let mut echo = echo::scene(scene)?;
        echo["mesh"] = mesh_section(&prepared.built)?;
        let drawn = [(scene.draw_series, "series"), (scene.draw_spectrum, "spectrum")];
        let drawn: Vec<&str> = drawn.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
        echo["output"] = json!({ "plots": drawn });
        for (name, notes) in echo_run::notes(&scene.assumptions, &scene.defaults_used) {
            echo[name] = notes;
        }
        say(&pretty(&echo))?;
        return Ok(Outcome::Done);
    }
    let mut text = format!("{}: a valid scene\n", visible_line(&path.display().to_string()));
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<22} {}", visible_line(&value));
    };
    if let Some(title) = &scene.title {
        line("title", title.clone());
    }
    let (mesh, quality) = (&prepared.built.mesh, &prepared.built.quality);
    let nodes_each = if mesh.order() == Order::Linear { 4 } else { 10 };
    line(
        "mesh",
        format!("{} nodes, {} elements of {nodes_each}", mesh.nodes.len(), mesh.elements.len()),
    );
    let (low, high) = mesh.bounding_box();
    let span = |i: usize| format!("{:.4} to {:.4}", 1e3 * low[i], 1e3 * high[i]);
    line("extent", format!("x {}, y {}, z {} mm", span(0), span(1), span(2)));
    let mass: f64 = model.mass.iter().sum();
    line("volume, mass", format!("{:.6e} m^3, {mass:.6e} kg", quality.total_volume));
    line(
        "quality",
        format!(
            "aspect up to {:.2}, dihedral angles {:.1} to {:.1} deg, edges {:.4} to {:.4} mm",
            quality.aspect.value,
            quality.least_dihedral.value.to_degrees(),
            quality.greatest_dihedral.value.to_degrees(),
            1e3 * quality.shortest_edge.value,
            1e3 * quality.longest_edge
        ),
    );
    for note in mesh_notes(&prepared.built) {
        line("note", note);
    }
    let sets: Vec<String> =
        mesh.node_sets.iter().map(|(name, nodes)| format!("{name} ({})", nodes.len())).collect();
    line("sets (nodes)", if sets.is_empty() { "none".into() } else { sets.join(", ") });
    line("held components", prepared.setup.problem.prescribed.len().to_string());
    line(
        "free motions",
        match prepared.free.count {
            0 => "none: statics can solve it".to_string(),
            count => format!("{count}: {}", prepared.free.names()),
        },
    );
    let mut forces = vec![[0.0; 4]; model.mass.len()];
    model.add_external_forces(model.acting(), 0.0, &mut forces, &mut Tally::default());
    let forces: Vec<[f64; 3]> = forces.iter().map(|f| [f[0], f[1], f[2]]).collect();
    let all: Vec<u32> = (0..forces.len() as u32).collect();
    let [x, y, z] = sum(&forces, &all);
    line("loads at t = 0", format!("{x:.6} N along x, {y:.6} N along y, {z:.6} N along z"));
    for used in &scene.defaults_used {
        line("default", format!("{} = {} ({})", used.key, used.value, used.reason));
    }
    for assumption in &scene.assumptions {
        line("assumption", format!("{}: {}", assumption.name, assumption.text));
    }
    say(&text)?;
    Ok(Outcome::Done)
}
