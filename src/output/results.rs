//! Results folder of a static solution.
//!
//! | file | content |
//! |---|---|
//! | `summary.json` | every scalar as `{"value", "unit"}`, the scene, the plan, the assumptions |
//! | `series.csv` | one row per ball, units in the header |
//! | `series.npy`, `series.columns.json` | the same numbers for NumPy, and their columns |
//!
//! Lengths in m, loads in N and N m, angles in degrees. `summary.json` is written last: a folder
//! with it is complete.

use crate::equilibrium::statics::{
    BallState, COORDINATE_NAMES, ContactState, Determinacy, StaticSolution,
};
use crate::output::atomic::{WriteError, write_atomic};
use crate::output::series::{Column, Series, SeriesError, columns_path};
use crate::plan::counts::StageCounts;
use crate::plan::{Item, counted};
use nalgebra::SMatrix;
use nalgebra::{SVector, Vector3};
use ndarray::Array2;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use thiserror::Error;

#[derive(Clone, Debug, Default)]
pub struct RunRecord {
    /// Resolved scene, copied to `scene`; `null` for an absent part.
    pub scene: Value,
    /// Plan of the run, with the omitted items and the reasons.
    pub plan: Vec<Item>,
    pub ran: StageCounts,
    /// Name and text of each assumption where the source is incomplete.
    pub assumptions: Vec<(String, String)>,
    pub threads: usize,
    /// Name of each stage and its wall time, s.
    pub seconds: Vec<(String, f64)>,
    /// Additional named parts of the summary (frequencies, contact stiffness, …); build their
    /// numbers with [`quantity`].
    pub sections: Vec<(String, Value)>,
}

#[derive(Debug, Error)]
pub enum ResultsError {
    #[error("{name} is {value}; only finite numbers are written")]
    NotFinite { name: String, value: f64 },
    #[error("{path} is null: a number is not finite, or the part should be omitted")]
    Null { path: String },
    #[error("the summary already has a part called {name:?}")]
    SectionName { name: String },
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// `{"value": …, "unit": …}`.
///
/// # Errors
/// A value that is not finite: JSON would turn it into `null`.
///
/// ```
/// use bearing_dynamics::output::results::quantity;
/// assert_eq!(quantity("load", 2.5, "N").unwrap()["unit"], "N");
/// assert!(quantity("load", f64::NAN, "N").is_err());
/// ```
pub fn quantity(name: &str, value: f64, unit: &str) -> Result<Value, ResultsError> {
    if !value.is_finite() {
        return Err(ResultsError::NotFinite { name: name.to_string(), value });
    }
    Ok(json!({ "value": value, "unit": unit }))
}

/// Writes the results folder and returns its files.
///
/// # Errors
/// A value that is not finite (nothing is written then), a name used twice, a file that cannot
/// be written.
pub fn write_static_results(
    folder: &Path,
    solution: &StaticSolution,
    run: &RunRecord,
) -> Result<Vec<PathBuf>, ResultsError> {
    let summary = static_summary(solution, run)?;
    let series = ball_series(solution)?;
    write_results(folder, &series, &summary)
}

/// Writes a table and its summary and returns the files.
pub(super) fn write_results(
    folder: &Path,
    series: &Series,
    summary: &Value,
) -> Result<Vec<PathBuf>, ResultsError> {
    series.check_finite()?;
    let [csv, npy, json] = ["series.csv", "series.npy", "summary.json"].map(|n| folder.join(n));
    series.write_csv(&csv)?;
    series.write_npy(&npy)?;
    write_atomic(&json, pretty(summary).as_bytes())?;
    let columns = columns_path(&npy);
    Ok(vec![csv, npy, columns, json])
}

/// Indented JSON with a final line break.
pub fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

const BALL_COLUMNS: [(&str, &str); 6] = [
    ("ball", "1"),
    ("azimuth", "deg"),
    ("position_x", "m"),
    ("position_y", "m"),
    ("position_z", "m"),
    ("cage_force", "N"),
];

const CONTACT_COLUMNS: [(&str, &str); 9] = [
    ("load", "N"),
    ("approach", "m"),
    ("contact_angle", "deg"),
    ("semi_major", "m"),
    ("semi_minor", "m"),
    ("peak_pressure", "Pa"),
    ("force_on_race_x", "N"),
    ("force_on_race_y", "N"),
    ("force_on_race_z", "N"),
];

/// Table with one row per ball: number, azimuth, position, cage force, then load, approach, contact angle, ellipse,
/// pressure and force of the inner and of the outer contact (columns `inner_load`, …,
/// `outer_force_on_race_z`).
pub fn ball_series(solution: &StaticSolution) -> Result<Series, SeriesError> {
    let columns = ball_columns();
    let values: Vec<f64> = ball_rows(&solution.balls).flatten().collect();
    let data = Array2::from_shape_vec((solution.balls.len(), columns.len()), values)
        .expect("every ball gives one value per column");
    Series::new(columns, data)
}

pub(super) fn ball_columns() -> Vec<Column> {
    let mut columns: Vec<Column> =
        BALL_COLUMNS.iter().map(|(name, unit)| Column::new(*name, *unit)).collect();
    for race in ["inner", "outer"] {
        for (name, unit) in CONTACT_COLUMNS {
            columns.push(Column::new(format!("{race}_{name}"), unit));
        }
    }
    columns
}

/// One row per ball, in the order of [`ball_columns`].
pub(super) fn ball_rows(balls: &[BallState]) -> impl Iterator<Item = Vec<f64>> {
    balls.iter().enumerate().map(|(index, ball)| {
        let mut values = vec![(index + 1) as f64, ball.azimuth.to_degrees()];
        values.extend(ball.position.iter());
        values.push(ball.cage_force);
        for contact in [&ball.inner, &ball.outer] {
            values.extend(contact_values(contact));
        }
        values
    })
}

/// Values in the order of `CONTACT_COLUMNS`.
pub(super) fn contact_values(contact: &ContactState) -> [f64; 9] {
    [
        contact.normal_load,
        contact.approach,
        contact.contact_angle.to_degrees(),
        contact.semi_major,
        contact.semi_minor,
        contact.peak_pressure,
        contact.force_on_race.x,
        contact.force_on_race.y,
        contact.force_on_race.z,
    ]
}

/// Content of `summary.json`.
///
/// # Errors
/// A value that is not finite, a `null` in a further section, a section name used twice.
pub fn static_summary(solution: &StaticSolution, run: &RunRecord) -> Result<Value, ResultsError> {
    let mut summary = Map::new();
    let mut put = |name: &str, value: Value| summary.insert(name.to_string(), value);
    put("kind", json!("static solution"));
    put("program", program());
    put("threads", json!(run.threads));
    put("seconds", seconds(&run.seconds)?);
    put(
        "determinacy",
        determinacy(
            &solution.determinacy,
            &COORDINATE_NAMES.map(str::to_string),
            "the pitch radius",
        )?,
    );
    let counts = [solution.iterations, solution.contact_evaluations, solution.saddles_left];
    put("solver", solver(counts, solution.residual)?);
    let mut inner = place_and_loads(&solution.coordinates, &solution.loads)?;
    inner["contact_force"] = vector("contact_force", &solution.force_on_inner, "N")?;
    inner["contact_moment"] = vector("contact_moment", &solution.moment_on_inner, "N m")?;
    put("inner_race", inner);
    put(
        "outer_race",
        json!({
            "contact_force": vector("contact_force", &solution.force_on_outer, "N")?,
            "contact_moment": vector("contact_moment", &solution.moment_on_outer, "N m")?,
        }),
    );
    put("stiffness", stiffness_section(&solution.stiffness)?);
    put("load_zone", load_zone(&solution.balls)?);
    let balls: Result<Vec<Value>, _> =
        solution.balls.iter().enumerate().map(|(index, b)| ball(index + 1, b)).collect();
    put("balls", json!(balls?));
    insert_echo(&mut summary, run)?;
    Ok(Value::Object(summary))
}

pub(super) fn seconds(stages: &[(String, f64)]) -> Result<Value, ResultsError> {
    let mut map = Map::new();
    for (stage, seconds) in stages {
        map.insert(stage.clone(), quantity(stage, *seconds, "s")?);
    }
    Ok(Value::Object(map))
}

fn strings(pairs: &[(String, String)]) -> Value {
    Value::Object(pairs.iter().map(|(name, text)| (name.clone(), json!(text))).collect())
}

/// Effort of the solver, and its residual in N.
pub(super) fn solver(
    [iterations, contact_evaluations, saddles_left]: [usize; 3],
    residual: f64,
) -> Result<Value, ResultsError> {
    Ok(json!({
        "iterations": iterations,
        "contact_evaluations": contact_evaluations,
        "saddles_left": saddles_left,
        "residual": quantity("residual", residual, "N")?,
    }))
}

/// Determinacy of an equilibrium; `names` are the coordinate names, `length` is the factor of tilts.
pub(super) fn determinacy(
    determinacy: &Determinacy,
    names: &[String],
    length: &str,
) -> Result<Value, ResultsError> {
    let Determinacy::Indeterminate { free_directions } = determinacy else {
        return Ok(json!({ "kind": "determinate" }));
    };
    let mut directions = Vec::new();
    for direction in free_directions {
        let mut map = Map::new();
        for (name, &component) in names.iter().zip(direction.iter()) {
            map.insert(name.clone(), quantity("free direction", component, "1")?);
        }
        directions.push(Value::Object(map));
    }
    Ok(json!({
        "kind": "indeterminate",
        "free_directions": directions,
        "note": format!("unit vectors; tilts are multiplied by {length}"),
    }))
}

/// Position of a body (m, deg) and the external loads on it in equilibrium (N, N m).
pub(super) fn place_and_loads(
    coordinates: &SVector<f64, 5>,
    loads: &SVector<f64, 5>,
) -> Result<Value, ResultsError> {
    let mut position = Map::new();
    let mut load_entries = Map::new();
    for (index, name) in COORDINATE_NAMES.iter().enumerate() {
        let coordinate = coordinates[index];
        let (given, unit, load_unit) = match index < 3 {
            true => (coordinate, "m", "N"),
            false => (coordinate.to_degrees(), "deg", "N m"),
        };
        position.insert(name.to_string(), quantity(name, given, unit)?);
        load_entries.insert(name.to_string(), quantity(name, loads[index], load_unit)?);
    }
    Ok(json!({ "position": position, "loads": load_entries }))
}

/// Stiffness matrix. Row: load; column: coordinate of differentiation.
pub fn stiffness_section(stiffness: &SMatrix<f64, 5, 5>) -> Result<Value, ResultsError> {
    let mut rows = Map::new();
    for (i, row_name) in COORDINATE_NAMES.iter().enumerate() {
        let mut row = Map::new();
        for (j, column_name) in COORDINATE_NAMES.iter().enumerate() {
            let unit = match (i < 3, j < 3) {
                (true, true) => "N/m",
                (true, false) => "N/rad",
                (false, true) => "N m/m",
                (false, false) => "N m/rad",
            };
            let name = format!("stiffness {row_name} {column_name}");
            row.insert(column_name.to_string(), quantity(&name, stiffness[(i, j)], unit)?);
        }
        rows.insert(row_name.to_string(), Value::Object(row));
    }
    Ok(Value::Object(rows))
}

/// Share of the largest load from which a ball counts as loaded: its own weight alone does not load it.
const LOADED: f64 = 0.01;

fn largest_load(balls: &[BallState], load: fn(&BallState) -> f64) -> f64 {
    balls.iter().map(load).fold(0.0, |a: f64, b| if b > a { b } else { a })
}

/// Number of balls loaded by the inner race (by 1 % of the largest load or more), and the arc from the first to the
/// last of them in rad: the full circle minus the widest gap between neighbouring loaded balls.
pub fn load_zone_of(balls: &[BallState]) -> (usize, f64) {
    let tau = std::f64::consts::TAU;
    let largest = largest_load(balls, |ball| ball.inner.normal_load);
    let is_loaded = |load: f64| load > 0.0 && load >= LOADED * largest;
    let mut azimuths: Vec<f64> = balls
        .iter()
        .filter(|ball| is_loaded(ball.inner.normal_load))
        .map(|ball| ball.azimuth.rem_euclid(tau))
        .collect();
    azimuths.sort_by(f64::total_cmp);
    if azimuths.len() == balls.len() {
        return (azimuths.len(), tau);
    }
    let Some((&first, &last)) = azimuths.first().zip(azimuths.last()) else { return (0, 0.0) };
    let widest =
        azimuths.windows(2).map(|pair| pair[1] - pair[0]).fold(first + tau - last, f64::max);
    (azimuths.len(), tau - widest)
}

pub(super) fn load_zone(balls: &[BallState]) -> Result<Value, ResultsError> {
    let largest = |load| largest_load(balls, load);
    let loaded = |load: fn(&BallState) -> f64| {
        let least = LOADED * largest(load);
        balls.iter().filter(|ball| load(ball) > 0.0 && load(ball) >= least).count()
    };
    let (_, extent) = load_zone_of(balls);
    Ok(json!({
        "extent": quantity("load zone", extent.to_degrees(), "deg")?,
        "balls_loaded_inner": loaded(|ball| ball.inner.normal_load),
        "balls_loaded_outer": loaded(|ball| ball.outer.normal_load),
        "largest_inner_load": quantity("load", largest(|ball| ball.inner.normal_load), "N")?,
        "largest_outer_load": quantity("load", largest(|ball| ball.outer.normal_load), "N")?,
        "largest_pressure": quantity(
            "pressure",
            largest(|ball| ball.inner.peak_pressure.max(ball.outer.peak_pressure)),
            "Pa",
        )?,
    }))
}

pub(super) fn ball(number: usize, ball: &BallState) -> Result<Value, ResultsError> {
    let named = |name: &str| format!("ball {number} {name}");
    Ok(json!({
        "ball": number,
        "azimuth": quantity(&named("azimuth"), ball.azimuth.to_degrees(), "deg")?,
        "position": vector(&named("position"), &ball.position, "m")?,
        "cage_force": quantity(&named("cage_force"), ball.cage_force, "N")?,
        "inner": contact(&named("inner"), &ball.inner)?,
        "outer": contact(&named("outer"), &ball.outer)?,
    }))
}

fn contact(name: &str, contact: &ContactState) -> Result<Value, ResultsError> {
    let mut map = Map::new();
    let values = contact_values(contact);
    for ((column, unit), value) in CONTACT_COLUMNS.iter().zip(values).take(6) {
        map.insert(column.to_string(), quantity(&format!("{name} {column}"), value, unit)?);
    }
    let force = vector(&format!("{name} force_on_race"), &contact.force_on_race, "N")?;
    map.insert("force_on_race".to_string(), force);
    Ok(Value::Object(map))
}

pub(super) fn vector(name: &str, vector: &Vector3<f64>, unit: &str) -> Result<Value, ResultsError> {
    Ok(json!({
        "x": quantity(&format!("{name} x"), vector.x, unit)?,
        "y": quantity(&format!("{name} y"), vector.y, unit)?,
        "z": quantity(&format!("{name} z"), vector.z, unit)?,
    }))
}

pub(super) fn program() -> Value {
    json!({ "name": "bearing-dynamics", "version": env!("CARGO_PKG_VERSION") })
}

/// Inserts the parts common to all summaries: program, threads, seconds, and the content of the record.
///
/// # Errors
/// A time that is not finite, a `null` in a further section, a section name used twice.
pub fn insert_record(
    summary: &mut Map<String, Value>,
    run: &RunRecord,
) -> Result<(), ResultsError> {
    summary.insert("program".into(), program());
    summary.insert("threads".into(), json!(run.threads));
    summary.insert("seconds".into(), seconds(&run.seconds)?);
    insert_echo(summary, run)
}

/// Inserts assumptions, plan, scene and additional sections of a record.
fn insert_echo(summary: &mut Map<String, Value>, run: &RunRecord) -> Result<(), ResultsError> {
    summary.insert("assumptions".into(), strings(&run.assumptions));
    let plan: Vec<String> = run.plan.iter().map(Item::to_string).collect();
    summary.insert("plan".into(), json!(plan));
    let stages = counted(&run.plan, &run.ran).into_iter();
    let stages = stages.map(|of| json!({ "stage": of.name, "does": of.does, "ran": of.ran }));
    summary.insert("stages".into(), stages.collect());
    summary.insert("scene".into(), run.scene.clone());
    for (name, section) in &run.sections {
        refuse_null(name, section)?;
        if summary.insert(name.clone(), section.clone()).is_some() {
            return Err(ResultsError::SectionName { name: name.clone() });
        }
    }
    Ok(())
}

fn refuse_null(path: &str, value: &Value) -> Result<(), ResultsError> {
    match value {
        Value::Null => Err(ResultsError::Null { path: path.to_string() }),
        Value::Array(items) => items
            .iter()
            .enumerate()
            .try_for_each(|(index, item)| refuse_null(&format!("{path}[{index}]"), item)),
        Value::Object(map) => {
            map.iter().try_for_each(|(key, item)| refuse_null(&format!("{path}.{key}"), item))
        }
        _ => Ok(()),
    }
}
