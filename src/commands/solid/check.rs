//! `bearing check` of a solid: mesh, sets, supports and loads.

use super::{mesh_notes, prepare};
use crate::commands::check::{Line, print_json, print_lines};
use crate::commands::check_mesh::{MeshFile, print_written};
use crate::commands::{CommandResult, placed, rubber};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::numeric::clock::to_digits;
use bearing_dynamics::output::recorder::sum;
use bearing_dynamics::output::summary::solid::mesh_section;
use bearing_dynamics::plan::counts::Counts;
use bearing_dynamics::scene::build::rubber::vibrating;
use bearing_dynamics::scene::build::solid_mesh::BuiltMesh;
use bearing_dynamics::scene::resolve::solid_scene::{Law, RubberScene};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::rubber::model::Moment;
use bearing_dynamics::solids::support::FreeMotions;
use serde_json::json;
use std::error::Error;

struct Facts {
    built: BuiltMesh,
    free: FreeMotions,
    /// Number of fixed components.
    fixed: usize,
    /// Mass, kg.
    mass: f64,
    /// Total load at t = 0, N.
    loads: Vec3,
    law: Vec<(&'static str, String)>,
}

pub fn run(
    document: &Document,
    scene: &SolidScene,
    json: bool,
    mesh: Option<MeshFile>,
) -> CommandResult {
    let facts = match &scene.law {
        Law::LinearElastic { .. } => elastic(document, scene)?,
        Law::Elastomer(rubber) => of_rubber(document, scene, rubber)?,
    };
    let written = mesh.map(|file| file.write(&[(None, &facts.built.mesh)])).transpose()?;
    if json {
        let echo = json!({ "mesh": mesh_section(&facts.built)? });
        return print_json(document, echo, &scene.assumptions, &scene.defaults_used);
    }
    let lines = |line: &mut Line| facts.lines(line);
    print_lines(document, &scene.title, lines, &scene.assumptions, &scene.defaults_used)?;
    print_written(written)
}

impl Facts {
    fn lines(self, line: &mut Line) {
        let Facts { built, free, fixed, mass, loads, law } = self;
        let (mesh, quality) = (&built.mesh, &built.quality);
        let nodes_each = if mesh.order() == Order::Linear { 4 } else { 10 };
        line(
            "mesh",
            format!("{} nodes, {} elements of {nodes_each}", mesh.nodes.len(), mesh.elements.len()),
        );
        let (low, high) = mesh.bounding_box();
        let span = |i: usize| format!("{:.4} to {:.4}", 1e3 * low[i], 1e3 * high[i]);
        line("extent", format!("x {}, y {}, z {} mm", span(0), span(1), span(2)));
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
        for note in mesh_notes(&built) {
            line("note", note);
        }
        let sets: Vec<String> = mesh
            .node_sets
            .iter()
            .map(|(name, nodes)| format!("{name} ({})", nodes.len()))
            .collect();
        line("sets (nodes)", if sets.is_empty() { "none".into() } else { sets.join(", ") });
        line("fixed components", fixed.to_string());
        line(
            "free motions",
            match free.count {
                0 => "none: statics can solve it".to_string(),
                count => format!("{count}: {}", free.names()),
            },
        );
        for (label, value) in law {
            line(label, value);
        }
        let [x, y, z] = loads;
        line("loads at t = 0", format!("{x:.6} N along x, {y:.6} N along y, {z:.6} N along z"));
    }
}

fn elastic(document: &Document, scene: &SolidScene) -> Result<Facts, Box<dyn Error>> {
    let prepared = prepare(document, scene)?;
    let setup = prepared.setup;
    let model = SolidModel::labelled(setup.problem, setup.labels)?;
    let mut forces = vec![[0.0; 4]; model.mass.len()];
    model.add_external_forces(model.acting(), 0.0, &mut forces, &mut Counts::default());
    let forces: Vec<Vec3> = forces.iter().map(|f| [f[0], f[1], f[2]]).collect();
    Ok(Facts {
        fixed: model.problem.prescribed.len(),
        mass: model.mass.iter().sum(),
        loads: total(&forces),
        built: prepared.built,
        free: prepared.free,
        law: Vec::new(),
    })
}

fn of_rubber(
    document: &Document,
    scene: &SolidScene,
    rubber: &RubberScene,
) -> Result<Facts, Box<dyn Error>> {
    let rubber::Prepared { built, setup, free, .. } = rubber::prepare(document, scene, rubber)?;
    let mut forces = vec![[0.0; 3]; setup.model.problem.nodes.len()];
    setup.model.add_loads(Moment::at(0.0), &mut forces);
    let (network, terms) = (&rubber.material.network, rubber.material.maxwell.len());
    let text = format!(
        "C_R {} MPa, N {}, bulk modulus {} MPa; shear modulus {:.4} MPa relaxed, {:.4} MPa instantaneous; {terms} Maxwell \
         elements",
        to_digits(1e-6 * network.modulus, 6),
        network.locking,
        to_digits(1e-6 * network.bulk, 6),
        1e-6 * network.shear_modulus(),
        1e-6 * rubber.material.instantaneous_shear_modulus(),
    );
    let mut law = vec![("rubber", text)];
    if let Some(asked) = &rubber.harmonic {
        vibrating(&setup, asked).map_err(|error| placed(document, error.about(), error))?;
        let count = asked.frequencies.len();
        law.push(("small vibrations", format!("{} at {count} frequencies", asked.set)));
    }
    Ok(Facts {
        fixed: setup.model.problem.prescribed.len(),
        mass: setup.density * built.quality.total_volume,
        loads: total(&forces),
        built,
        free,
        law,
    })
}

fn total(forces: &[Vec3]) -> Vec3 {
    let all: Vec<u32> = (0..forces.len() as u32).collect();
    sum(forces, &all)
}
