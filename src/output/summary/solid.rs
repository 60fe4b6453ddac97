//! Summary of a solid: mesh, statics, modes and time steps.

use super::{PEAKS, Part, RunReport};
use crate::kinematics::vec3::Vec3;
use crate::mesh::quality::{Quality, Worst};
use crate::mesh::{Order, TetMesh};
use crate::output::fields::Stresses;
use crate::output::recorder::{length, mean, probe_columns, sum};
use crate::output::results::{ResultsError, RunRecord, insert_record, quantity};
use crate::output::series::{Series, SeriesError};
use crate::output::spectrum::{LEAKAGE, Spectrum, WINDOW, peaks};
use crate::plan::counts::Counts;
use crate::scene::build::solid::{NamedNodes, SolidSetup, Support};
use crate::scene::build::solid_mesh::BuiltMesh;
use crate::solids::energy::strain_energy;
use crate::solids::equilibrium::Equilibrium;
use crate::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping, padded};
use crate::solids::labels::Labels;
use crate::solids::model::SolidModel;
use crate::solids::modes::Modes;
use crate::solids::step_limit::SolidStepLimit;
use ndarray::Array2;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;

pub(super) fn vector(name: &str, of: Vec3, unit: &str) -> Part {
    let part = |axis: &str, value: f64| quantity(&format!("{name} {axis}"), value, unit);
    Ok(json!({ "x": part("x", of[0])?, "y": part("y", of[1])?, "z": part("z", of[2])? }))
}

/// Nodes, elements, sets, volume, quality, repairs and notes.
///
/// # Errors
/// A value that is not finite.
pub fn mesh_section(built: &BuiltMesh) -> Part {
    let mesh = &built.mesh;
    let (low, high) = mesh.bounding_box();
    let mut sets = Map::new();
    for (name, nodes) in &mesh.node_sets {
        sets.insert(name.clone(), json!({ "nodes": nodes.len() }));
    }
    for (name, elements) in &mesh.element_sets {
        let entry = sets.entry(name.clone()).or_insert_with(|| json!({}));
        entry["elements"] = json!(elements.len());
    }
    for (name, faces) in &mesh.surface_sets {
        let entry = sets.entry(name.clone()).or_insert_with(|| json!({}));
        entry["faces"] = json!(faces.len());
    }
    let repaired = &built.repaired;
    Ok(json!({
        "nodes": mesh.nodes.len(),
        "elements": mesh.elements.len(),
        "nodes_of_an_element": if mesh.order() == Order::Linear { 4 } else { 10 },
        "volume": quantity("volume", built.quality.total_volume, "m^3")?,
        "low": vector("low", low, "m")?,
        "high": vector("high", high, "m")?,
        "quality": quality_section(&built.quality, &built.labels)?,
        "sets": sets,
        "repaired": {
            "turned_elements": repaired.turned_elements,
            "merged_nodes": repaired.merged_nodes,
            "dropped_nodes": repaired.dropped_nodes,
        },
        "middles_off_curved_surfaces": built.moved_back,
        "notes": built.notes,
    }))
}

fn quality_section(quality: &Quality, labels: &Labels) -> Part {
    let worst = |name: &str, worst: Worst, factor: f64, unit: &str| -> Part {
        let mut entry = quantity(name, worst.value * factor, unit)?;
        entry["element"] = json!(labels.element(worst.element as usize));
        Ok(entry)
    };
    let degrees = 360.0 / TAU;
    Ok(json!({
        "largest_aspect": worst("aspect", quality.aspect, 1.0, "1")?,
        "least_radius_ratio": worst("radius ratio", quality.radius_ratio, 1.0, "1")?,
        "least_dihedral_angle": worst("dihedral", quality.least_dihedral, degrees, "deg")?,
        "greatest_dihedral_angle": worst("dihedral", quality.greatest_dihedral, degrees, "deg")?,
        "shortest_edge": worst("edge", quality.shortest_edge, 1.0, "m")?,
        "longest_edge": quantity("edge", quality.longest_edge, "m")?,
        "least_volume": worst("volume", quality.least_volume, 1.0, "m^3")?,
    }))
}

/// Mass from nodes, and from density and volume.
///
/// # Errors
/// A value that is not finite.
pub fn mass_section(model: &SolidModel, built: &BuiltMesh) -> Part {
    let by_volume = model.problem.density * built.quality.total_volume;
    Ok(json!({
        "of_nodes": quantity("mass", model.mass.iter().sum(), "kg")?,
        "of_volume": quantity("mass", by_volume, "kg")?,
    }))
}

fn head(kind: &str, model: &SolidModel, built: &BuiltMesh, record: &RunRecord) -> Part {
    let mut summary = Map::new();
    summary.insert("kind".into(), json!(kind));
    insert_record(&mut summary, record)?;
    summary.insert("mesh".into(), mesh_section(built)?);
    summary.insert("mass".into(), mass_section(model, built)?);
    Ok(Value::Object(summary))
}

/// Largest displacement and von Mises stresses, with their positions.
pub(super) fn extremes(mesh: &TetMesh, displacement: &[Vec3], stresses: &Stresses) -> Part {
    let largest = |values: &mut dyn Iterator<Item = f64>| {
        let mut best = (0, 0.0);
        for (index, value) in values.enumerate() {
            if value > best.1 {
                best = (index, value);
            }
        }
        best
    };
    let (moved, displaced) = largest(&mut displacement.iter().map(length));
    let (cell, of_cell) = largest(&mut stresses.cell_von_mises.iter().copied());
    let (node, of_node) = largest(&mut stresses.node_von_mises.iter().copied());
    let centre = |cell: usize| {
        let points = mesh.corner_points(cell);
        Vec3::from((points[0] + points[1] + points[2] + points[3]) / 4.0)
    };
    let place = |value: f64, unit: &str, at: Vec3| -> Part {
        let mut entry = quantity("largest value", value, unit)?;
        entry["at"] = vector("place", at, "m")?;
        Ok(entry)
    };
    Ok(json!({
        "displacement": place(displaced, "m", mesh.nodes[moved])?,
        "von_mises_of_elements": place(of_cell, "Pa", centre(cell))?,
        "von_mises_of_nodes": place(of_node, "Pa", mesh.nodes[node])?,
    }))
}

/// Mean displacements of probes, and sums of reactions of supports.
pub(super) fn named(
    of_probes: &[NamedNodes],
    of_supports: &[Support],
    displacement: &[Vec3],
    reactions: &[Vec3],
) -> Result<[Value; 2], ResultsError> {
    let (mut probes, mut supports) = (Map::new(), Map::new());
    for probe in of_probes {
        let mut entry = vector(&probe.name, mean(displacement, &probe.nodes), "m")?;
        entry["nodes"] = json!(probe.nodes.len());
        probes.insert(probe.name.clone(), entry);
    }
    for support in of_supports {
        let mut reaction = Map::new();
        for (axis, force) in support.axes().into_iter().zip(support.total(reactions)) {
            let name = ["x", "y", "z"][axis];
            reaction.insert(name.into(), quantity(name, force, "N")?);
        }
        supports.insert(support.name.clone(), Value::Object(reaction));
    }
    Ok([Value::Object(probes), Value::Object(supports)])
}

/// Summary and one-row series of an equilibrium at t = 0.
///
/// # Errors
/// A value that is not finite.
pub fn statics(
    model: &SolidModel,
    setup: &SolidSetup,
    built: &BuiltMesh,
    solution: &Equilibrium,
    stresses: &Stresses,
    record: &RunRecord,
) -> Result<(Value, Series), ResultsError> {
    let mut summary = head("static solution of a solid", model, built, record)?;
    let all: Vec<u32> = (0..model.mass.len() as u32).collect();
    let mut loads = vec![[0.0; 4]; model.mass.len()];
    model.add_external_forces(model.acting(), 0.0, &mut loads, &mut Counts::default());
    let loads: Vec<Vec3> = loads.iter().map(|f| [f[0], f[1], f[2]]).collect();
    let (displacement, reactions) = (&solution.displacement, &solution.reactions);
    let [probes, supports] = named(&setup.probes, &setup.supports, displacement, reactions)?;
    summary["solver"] = json!({
        "iterations": solution.iterations,
        "factorisations": solution.factorisations,
        "unknowns": 3 * model.mass.len() - setup.problem.prescribed.len(),
        "residual": quantity("residual", solution.residual, "1")?,
    });
    summary["loads"] = vector("loads", sum(&loads, &all), "N")?;
    summary["reactions"] = vector("reactions", sum(&solution.reactions, &all), "N")?;
    summary["supports"] = supports;
    summary["probes"] = probes;
    summary["largest"] = extremes(&built.mesh, &solution.displacement, stresses)?;
    let energy = strain_energy(model, &padded(solution.displacement.clone()));
    summary["strain_energy"] = quantity("strain energy", energy, "J")?;
    let series = static_series(&setup.probes, &setup.supports, displacement, reactions)?;
    Ok((summary, series))
}

pub(super) fn static_series(
    probes: &[NamedNodes],
    supports: &[Support],
    displacement: &[Vec3],
    reactions: &[Vec3],
) -> Result<Series, SeriesError> {
    let mut columns = probe_columns(probes, supports);
    columns.insert(0, crate::output::series::Column::new("largest_displacement", "m"));
    let largest = displacement.iter().map(length).fold(0.0, f64::max);
    let mut values = vec![largest];
    for probe in probes {
        values.extend(mean(displacement, &probe.nodes));
    }
    for support in supports {
        values.extend(support.total(reactions));
    }
    let data =
        Array2::from_shape_vec((1, columns.len()), values).expect("one value for each column");
    Series::new(columns, data)
}

/// Summary and table of natural modes.
///
/// # Errors
/// A value that is not finite.
pub fn modes(
    model: &SolidModel,
    built: &BuiltMesh,
    found: &Modes,
    record: &RunRecord,
) -> Result<(Value, Series), ResultsError> {
    let mut summary = head("natural modes of a solid", model, built, record)?;
    summary["solver"] = json!({ "unknowns": found.unknowns, "solves": found.solves });
    let mut list = Vec::new();
    let mut values = Vec::new();
    for (index, mode) in found.modes.iter().enumerate() {
        list.push(json!({
            "mode": index + 1,
            "frequency": quantity("frequency", mode.frequency, "Hz")?,
            "residual": quantity("residual", mode.residual, "1")?,
        }));
        values.extend([(index + 1) as f64, mode.frequency, mode.residual]);
    }
    summary["modes"] = json!(list);
    let columns = [("mode", "1"), ("frequency", "Hz"), ("residual", "1")];
    let columns = columns.map(|(name, unit)| crate::output::series::Column::new(name, unit));
    let data =
        Array2::from_shape_vec((found.modes.len(), 3), values).expect("three values for each mode");
    Ok((summary, Series::new(columns.to_vec(), data)?))
}

pub(crate) fn limit_section(limit: &SolidStepLimit, labels: &Labels) -> Part {
    Ok(json!({
        "step": quantity("step limit", limit.step, "s")?,
        "highest_frequency": quantity("frequency", limit.frequency / TAU, "Hz")?,
        "is_bound": limit.is_bound,
        "products": limit.products,
        "element": {
            "number": labels.element(limit.element),
            "highest_frequency": quantity("frequency", limit.element_frequency / TAU, "Hz")?,
            "at": vector("place", limit.at, "m")?,
        },
    }))
}

pub(super) fn step(solid: &ExplicitSolid, report: &RunReport) -> Part {
    let chosen = match report.solid_stepping {
        Some(SolidStepping::FractionOfLimit(part)) => format!("{part} of the limit, in whole rows"),
        Some(SolidStepping::Fixed(_)) | None => "given".to_string(),
    };
    Ok(json!({
        "method": match solid.method {
            ExplicitMethod::CentralDifferences => "central-differences",
            ExplicitMethod::RungeKutta => "runge-kutta",
        },
        "size": quantity("step", solid.step_size, "s")?,
        "chosen": chosen,
        "of_limit": quantity("step over limit", solid.step_size / solid.limit.step, "1")?,
        "limit": limit_section(&solid.limit, &solid.model.labels)?,
    }))
}

pub(super) fn work(solid: &ExplicitSolid) -> Value {
    json!({
        "steps": solid.steps,
        "force_evaluations": solid.work.evaluations,
        "elements_evaluated": solid.work.elements,
    })
}

/// Sections of the mesh and of the largest displacement and stresses.
///
/// # Errors
/// A value that is not finite.
pub fn field_sections(
    built: &BuiltMesh,
    displacement: &[Vec3],
    stresses: &Stresses,
) -> Result<Vec<(String, Value)>, ResultsError> {
    let largest = extremes(&built.mesh, displacement, stresses)?;
    Ok(vec![("mesh".into(), mesh_section(built)?), ("largest".into(), largest)])
}

pub(super) fn spectra_section(spectra: &[(String, Spectrum)]) -> Part {
    let mut section = Map::new();
    section.insert("window".into(), json!(WINDOW));
    section.insert("leakage".into(), json!(LEAKAGE));
    for (column, spectrum) in spectra {
        let found = peaks(spectrum, PEAKS, 0.0).into_iter().map(|peak| {
            Ok(json!({
                "frequency": quantity("frequency", peak.frequency, "Hz")?,
                "amplitude": quantity("amplitude", peak.amplitude, "m")?,
                "bin": quantity("bin", peak.bin_frequency, "Hz")?,
            }))
        });
        let found: Vec<Value> = found.collect::<Result<_, ResultsError>>()?;
        section.insert(
            column.clone(),
            json!({
                "bin_width": quantity("bin width", spectrum.bin_width, "Hz")?,
                "peaks": found,
            }),
        );
    }
    Ok(Value::Object(section))
}
