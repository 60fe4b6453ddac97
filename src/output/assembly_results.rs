//! Results folder of the equilibrium of several bodies: `summary.json` with a section for each body and each
//! bearing, and `series.csv` with a row for each ball of each bearing.

use crate::assembly::lists::Assembly;
use crate::equilibrium::bearing_tables::BearingState;
use crate::equilibrium::lists::{Place, StaticAssembly};
use crate::equilibrium::statics::{AssemblySolution, COORDINATE_NAMES};
use crate::output::results::{
    ResultsError, RunRecord, ball, ball_columns, ball_rows, determinacy, insert_record, load_zone,
    place_and_loads, quantity, solver, vector, write_results,
};
use crate::output::series::{Column, Series};
use ndarray::Array2;
use serde_json::{Map, Value, json};
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

/// Equilibrium as returned by [`readable`], and the names of its bearings.
#[derive(Clone, Copy)]
pub struct Solved<'s> {
    pub assembly: &'s StaticAssembly<'s>,
    pub names: &'s [&'s str],
    pub solution: &'s AssemblySolution,
}

/// Rounding error of a displacement (m) or tilt (rad) that is zero: 64 ulps of a pitch radius of 30 mm.
const ROUNDING: f64 = 4e-16;

/// Solution in the scene's axes, also for reversed bearings: azimuth from +Y towards +Z, cage force positive towards
/// larger azimuth. The x of races, balls and centres is measured from the position of their bearing in `moving`, the
/// assembly that `assembly` is the static model of.
pub fn readable(
    moving: &Assembly,
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> AssemblySolution {
    let mut read = solution.clone();
    for (body, coordinates) in read.coordinates.iter_mut().enumerate() {
        coordinates[0] -= match &assembly.bodies[body].place {
            Place::Section(of) => {
                let body = moving.shafts[of.shaft].body;
                moving.bodies[body].rest[0] + of.section.along
            }
            _ => moving.origin_of(body),
        };
        for coordinate in coordinates.iter_mut().filter(|q| q.abs() <= ROUNDING) {
            *coordinate = 0.0;
        }
    }
    let bearings = moving.bearings.iter().zip(&assembly.bearings);
    for ((own, still), state) in bearings.zip(&mut read.bearings) {
        let place = moving.place_of(own);
        state.centres.iter_mut().for_each(|centre| centre.x -= place);
        for ball in &mut state.balls {
            ball.position.x -= place;
            if still.mounts[1].reversed {
                // Half a turn about Z.
                ball.azimuth = (PI - ball.azimuth).rem_euclid(TAU);
                ball.cage_force = -ball.cage_force;
            }
        }
    }
    read
}

/// Writes the results folder and returns its files.
///
/// # Errors
/// A value that is not finite (nothing is written then), a name used twice, a file that cannot be written.
pub fn write(
    folder: &Path,
    solved: &Solved,
    record: &RunRecord,
) -> Result<Vec<PathBuf>, ResultsError> {
    let summary = summary(solved, record)?;
    let series = series(solved)?;
    write_results(folder, &series, &summary)
}

/// One row per ball, bearing after bearing: number of the bearing, then the columns of a single bearing.
fn series(solved: &Solved) -> Result<Series, ResultsError> {
    let mut columns = vec![Column::new("bearing", "1")];
    columns.extend(ball_columns());
    let mut values = Vec::new();
    for (index, bearing) in solved.solution.bearings.iter().enumerate() {
        for row in ball_rows(&bearing.balls) {
            values.push((index + 1) as f64);
            values.extend(row);
        }
    }
    let rows = values.len() / columns.len();
    let data = Array2::from_shape_fn((rows, columns.len()), |(i, j)| values[i * columns.len() + j]);
    Ok(Series::new(columns, data)?)
}

/// Content of `summary.json`.
///
/// # Errors
/// A value that is not finite, a `null` in a further section, a section name used twice.
pub fn summary(solved: &Solved, record: &RunRecord) -> Result<Value, ResultsError> {
    let solution = solved.solution;
    let mut summary = Map::new();
    summary.insert("kind".into(), json!("static solution"));
    let names = coordinate_names(solved.assembly);
    summary.insert(
        "determinacy".into(),
        determinacy(&solution.determinacy, &names, "a pitch radius")?,
    );
    summary.insert(
        "solver".into(),
        solver(
            [solution.iterations, solution.contact_evaluations, solution.saddles_left],
            solution.residual,
        )?,
    );
    let mut bodies = Map::new();
    for (index, body) in solved.assembly.bodies.iter().enumerate() {
        if matches!(body.place, Place::Loaded(_)) {
            let part = place_and_loads(&solution.coordinates[index], &solution.loads[index])?;
            bodies.insert(key(&body.name), part);
        }
    }
    summary.insert("bodies".into(), Value::Object(bodies));
    let sections = sections(solved)?;
    if !sections.is_empty() {
        summary.insert("sections".into(), json!(sections));
    }
    summary.insert("stiffness".into(), stiffness(solved)?);
    let mut bearings = Map::new();
    for (name, state) in solved.names.iter().zip(&solution.bearings) {
        bearings.insert((*name).into(), bearing(state)?);
    }
    summary.insert("bearings".into(), Value::Object(bearings));
    insert_record(&mut summary, record)?;
    Ok(Value::Object(summary))
}

/// Displacements of the sections of flexible bodies relative to the undeformed body (m, rad).
fn sections(solved: &Solved) -> Result<Vec<Value>, ResultsError> {
    let mut all = Vec::new();
    for (index, body) in solved.assembly.bodies.iter().enumerate() {
        if !matches!(body.place, Place::Section(_)) {
            continue;
        }
        let mut part = Map::new();
        part.insert("section".into(), json!(body.name));
        for (i, name) in COORDINATE_NAMES.iter().enumerate() {
            let unit = if i < 3 { "m" } else { "rad" };
            let value = quantity(name, solved.solution.coordinates[index][i], unit)?;
            part.insert((*name).into(), value);
        }
        all.push(Value::Object(part));
    }
    Ok(all)
}

/// Name of a body as a JSON key: `outer_race_of_bearing_left` for "the outer race of bearing left".
pub fn key(name: &str) -> String {
    let name = name.strip_prefix("the ").unwrap_or(name);
    name.strip_prefix("body ").unwrap_or(name).replace(' ', "_")
}

fn bearing(state: &BearingState) -> Result<Value, ResultsError> {
    let mut part = Map::new();
    for (side, race) in ["inner_race", "outer_race"].into_iter().enumerate() {
        let section = json!({
            "centre": vector("centre", &state.centres[side], "m")?,
            "contact_force": vector("contact_force", &state.forces[side], "N")?,
            "contact_moment": vector("contact_moment", &state.moments[side], "N m")?,
        });
        part.insert(race.into(), section);
    }
    part.insert("load_zone".into(), load_zone(&state.balls)?);
    let balls: Result<Vec<Value>, _> =
        state.balls.iter().enumerate().map(|(index, b)| ball(index + 1, b)).collect();
    part.insert("balls".into(), json!(balls?));
    Ok(Value::Object(part))
}

/// Names of the coordinates of all loaded bodies, in the order of the stiffness matrix.
fn coordinate_names(assembly: &StaticAssembly) -> Vec<String> {
    let loaded = assembly.bodies.iter().filter(|body| matches!(body.place, Place::Loaded(_)));
    loaded
        .flat_map(|body| COORDINATE_NAMES.map(|name| format!("{}.{name}", key(&body.name))))
        .collect()
}

/// Stiffness matrix. Row: load; column: coordinate of differentiation. N and N m over m and rad.
fn stiffness(solved: &Solved) -> Result<Value, ResultsError> {
    let names = coordinate_names(solved.assembly);
    let matrix = &solved.solution.stiffness;
    let mut rows = Vec::with_capacity(names.len());
    for i in 0..names.len() {
        let row: Vec<f64> = (0..names.len()).map(|j| matrix[(i, j)]).collect();
        for (value, name) in row.iter().zip(&names) {
            quantity(&format!("stiffness {} {name}", names[i]), *value, "SI")?;
        }
        rows.push(row);
    }
    Ok(json!({ "coordinates": names, "matrix": rows, "unit": "N, N m over m, rad" }))
}
