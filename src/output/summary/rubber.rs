//! Summary of a rubber solid: relaxed equilibrium, vibrations and time steps.

use super::Part;
use super::solid::{extremes, mesh_section, named, static_series, vector};
use crate::kinematics::vec3::Vec3;
use crate::output::fields::Stresses;
use crate::output::recorder::sum;
use crate::output::results::{ResultsError, RunRecord, insert_record, quantity};
use crate::output::series::{Column, Series, SeriesError};
use crate::output::session::MovingRubber;
use crate::scene::build::rubber::RubberSetup;
use crate::scene::build::solid_mesh::BuiltMesh;
use crate::solids::rubber::model::Moment;
use crate::solids::rubber::relaxed::{Reached, Relaxed};
use crate::solids::rubber::steps::Stepping;
use crate::solids::rubber::vibration::Answer;
use ndarray::Array2;
use serde_json::{Map, Value, json};

/// Mass from density and volume.
///
/// # Errors
/// A value that is not finite.
pub fn rubber_mass(setup: &RubberSetup, built: &BuiltMesh) -> Part {
    let mass = setup.density * built.quality.total_volume;
    Ok(json!({ "of_volume": quantity("mass", mass, "kg")? }))
}

/// Summary and one-row series of a relaxed equilibrium under the supports and loads at time `t` (s).
///
/// # Errors
/// A value that is not finite.
pub fn rubber_statics(
    setup: &RubberSetup,
    built: &BuiltMesh,
    (t, found): (f64, &Relaxed),
    stresses: &Stresses,
    vibrations: Option<Value>,
    record: &RunRecord,
) -> Result<(Value, Series), ResultsError> {
    let mut summary = Map::new();
    summary.insert("kind".into(), json!("static solution of a solid of rubber, relaxed"));
    insert_record(&mut summary, record)?;
    summary.insert("mesh".into(), mesh_section(built)?);
    summary.insert("mass".into(), rubber_mass(setup, built)?);
    let mut summary = Value::Object(summary);
    let model = &setup.model;
    let displacement = &found.state.displacement;
    let all: Vec<u32> = (0..displacement.len() as u32).collect();
    let mut loads: Vec<Vec3> = vec![[0.0; 3]; displacement.len()];
    model.add_loads(Moment::at(t), &mut loads);
    let [probes, supports] = named(&setup.probes, &setup.supports, displacement, &found.reactions)?;
    summary["solver"] = json!({
        "steps": found.steps,
        "iterations": found.iterations,
        "factorisations": found.factorisations,
        "unknowns": model.unknowns.count,
    });
    summary["loads_of"] = quantity("time", t, "s")?;
    summary["loads"] = vector("loads", sum(&loads, &all), "N")?;
    summary["reactions"] = vector("reactions", sum(&found.reactions, &all), "N")?;
    summary["supports"] = supports;
    summary["probes"] = probes;
    summary["largest"] = extremes(&built.mesh, displacement, stresses)?;
    summary["strain_energy"] = quantity("strain energy", found.energy, "J")?;
    if let Some(vibrations) = vibrations {
        summary["harmonic"] = vibrations;
    }
    let series = static_series(&setup.probes, &setup.supports, displacement, &found.reactions)?;
    Ok((summary, series))
}

/// Intermediate equilibria as a table: the fraction of supports and loads applied, and the columns of statics.
///
/// # Errors
/// A value that is not finite.
pub fn reached_series(setup: &RubberSetup, reached: &[Reached]) -> Result<Series, SeriesError> {
    let mut columns = vec![Column::new("part", "1")];
    let mut values = Vec::new();
    for Reached { part, displacement, reactions } in reached {
        let row = static_series(&setup.probes, &setup.supports, displacement, reactions)?;
        if values.is_empty() {
            columns.extend(row.columns().iter().cloned());
        }
        values.push(*part);
        values.extend(row.data());
    }
    let data = Array2::from_shape_vec((reached.len(), columns.len()), values)
        .expect("one value for each column");
    Series::new(columns, data)
}

/// Frequency response for the summary.
///
/// # Errors
/// A value that is not finite.
pub fn harmonic_section(set: &str, axis: &str, answers: &[Answer]) -> Part {
    let entry = |answer: &Answer| {
        Ok(json!({
            "frequency": quantity("frequency", answer.frequency, "Hz")?,
            "storage_stiffness": quantity("storage", answer.stiffness.storage, "N/m")?,
            "loss_stiffness": quantity("loss", answer.stiffness.loss, "N/m")?,
            "dynamic_stiffness": quantity("K_d", answer.hysteresis.dynamic_stiffness, "N/m")?,
            "damping_ratio": quantity("eta_d", answer.hysteresis.damping_ratio, "1")?,
        }))
    };
    let answers: Vec<Value> = answers.iter().map(entry).collect::<Result<_, ResultsError>>()?;
    Ok(json!({ "set": set, "axis": axis, "about": "rest, small", "answers": answers }))
}

/// Frequency response as a table.
///
/// # Errors
/// Never for finite answers.
pub fn harmonic_series(answers: &[Answer]) -> Result<Series, SeriesError> {
    let columns = [
        ("frequency", "Hz"),
        ("storage_stiffness", "N/m"),
        ("loss_stiffness", "N/m"),
        ("dynamic_stiffness", "N/m"),
        ("damping_ratio", "1"),
    ];
    let columns = columns.map(|(name, unit)| Column::new(name, unit));
    let values = answers.iter().flat_map(|answer| {
        let (stiffness, of) = (&answer.stiffness, &answer.hysteresis);
        let moduli = [answer.frequency, stiffness.storage, stiffness.loss];
        moduli.into_iter().chain([of.dynamic_stiffness, of.damping_ratio])
    });
    let data = Array2::from_shape_vec((answers.len(), columns.len()), values.collect())
        .expect("five values for each frequency");
    Series::new(columns.to_vec(), data)
}

pub(super) fn work(moving: &MovingRubber) -> Value {
    let (iterations, factorisations) = moving.solid.work();
    json!({
        "steps": moving.solid.counts.accepted,
        "steps_undone": moving.solid.counts.undone,
        "iterations": iterations,
        "factorisations": factorisations,
    })
}

pub(super) fn step(moving: &MovingRubber) -> Part {
    Ok(match moving.stepping {
        Stepping::Fixed(step) => json!({
            "method": "implicit",
            "size": quantity("step", step, "s")?,
            "chosen": "fixed, shortened at rows and at corners of loads and supports",
        }),
        Stepping::Accuracy(accuracy) => json!({
            "method": "implicit",
            "accuracy": quantity("accuracy", accuracy, "1")?,
            "chosen": "by the estimated error of the stress, shortened at rows and at corners of loads and supports",
        }),
    })
}
