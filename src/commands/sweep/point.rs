//! One point of a sweep and its row of the table.

use super::grid::Grid;
use super::housings::{self, Kept};
use crate::commands::assembly::housings::{Equilibrium, equilibrium, grown};
use crate::commands::assembly::lists::Lists;
use crate::commands::warnings::of_equilibrium;
use bearing_dynamics::equilibrium::lists::{Place, StaticAssembly};
use bearing_dynamics::equilibrium::statics::{
    AssemblySolution, BallState, COORDINATE_NAMES, Determinacy, StaticSolution,
};
use bearing_dynamics::output::Column;
use bearing_dynamics::output::assembly_results::{key, readable};
use bearing_dynamics::output::results::load_zone_of;
use bearing_dynamics::output::warnings::Warning;
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use nalgebra::SVector;
use std::collections::BTreeSet;
use std::error::Error;

/// Row of a point. In housings, those of the point before are taken again.
pub fn solve(
    document: &Document,
    grid: &Grid,
    (point, header): (usize, &[Column]),
    kept: &mut Kept,
) -> Result<Vec<f64>, String> {
    let scene = grid.scene(document, point).map_err(|error| error.to_string())?;
    // A race beside the middle of its bearing, or one that moves, makes an assembly of a bearing alone.
    if columns(grid, Some(&scene)) != header {
        return Err("bodies are loaded here that are not at the first point, or the other way round, and its results have other columns: \
                    sweep what has one kind of results by itself"
            .into());
    }
    let solved = solve_scene(&scene, kept).map_err(|error| error.to_string())?;
    let row = [start_of_row(grid, point), solved].concat();
    match row.iter().position(|value| !value.is_finite()) {
        None => Ok(row),
        Some(column) => Err(format!("{} is not finite", header[column].name)),
    }
}

fn solve_scene(scene: &AssemblyScene, kept: &mut Kept) -> Result<Vec<f64>, Box<dyn Error>> {
    scene.check_statics()?;
    *kept = std::mem::take(kept).take(scene)?;
    let (housings, bores) = kept.parts();
    let lists = Lists::of(scene);
    let Equilibrium { still, moment, .. } = equilibrium(&lists, grown(housings, bores), None)?;
    let solution = moment.solution;
    let mut warnings = of_equilibrium(scene, &still, &solution)?;
    let (of_housings, said) = kept.row(&solution.seats);
    warnings.extend(said);
    let mut row = match scene.one_still() {
        Some(_) => of_bearing(&StaticSolution::from(solution)),
        None => of_assembly(&still, &readable(lists.assembly()?, &still, &solution)),
    };
    row.extend(of_housings);
    row.push(codes(&warnings));
    Ok(row)
}

/// Codes of warnings as one number, two digits each: 305 for W03 and W05. The first seven, which a number of a table holds exactly.
fn codes(warnings: &[Warning]) -> f64 {
    let numbers: BTreeSet<usize> = warnings.iter().map(|of| of.code.number()).collect();
    numbers.into_iter().take(7).fold(0.0, |codes, number| 100.0 * codes + number as f64)
}

/// Columns that follow those of the varied keys.
const RESULTS: [(&str, &str); 17] = [
    ("load_x", "N"),
    ("load_y", "N"),
    ("load_z", "N"),
    ("moment_y", "N m"),
    ("moment_z", "N m"),
    ("stiffness_x", "N/m"),
    ("stiffness_y", "N/m"),
    ("stiffness_z", "N/m"),
    ("stiffness_tilt_y", "N m/rad"),
    ("stiffness_tilt_z", "N m/rad"),
    ("loaded_balls", "1"),
    ("load_zone", "deg"),
    ("largest_inner_load", "N"),
    ("largest_outer_load", "N"),
    ("largest_inner_pressure", "MPa"),
    ("largest_outer_pressure", "MPa"),
    ("free_directions", "1"),
];

/// Force of the balls on the inner race of each bearing of an assembly.
const FORCES: [(&str, &str); 3] =
    [("force_on_inner_x", "N"), ("force_on_inner_y", "N"), ("force_on_inner_z", "N")];

/// Header of the table: point, varied keys, positions and results.
pub fn columns(grid: &Grid, scene: Option<&AssemblyScene>) -> Vec<Column> {
    let mut columns = start_of_columns(grid);
    match scene.filter(|scene| scene.one_still().is_none()) {
        Some(scene) => columns.extend(assembly_columns(scene)),
        None => {
            for (i, name) in COORDINATE_NAMES.iter().enumerate() {
                columns.push(Column::new(*name, if i < 3 { "um" } else { "deg" }));
            }
            columns.extend(RESULTS.map(|(name, unit)| Column::new(name, unit)));
        }
    }
    columns.extend(scene.map_or_else(Vec::new, housings::columns));
    columns.push(Column::new("warnings", "1"));
    columns
}

/// Point and varied keys.
pub fn start_of_columns(grid: &Grid) -> Vec<Column> {
    let keys = grid.axes.iter();
    let keys = keys.map(|axis| Column::new(axis.key.clone(), super::report::unit_of(axis)));
    std::iter::once(Column::new("point", "1")).chain(keys).collect()
}

/// Position, loads and stiffness of each loaded body; force and loads of the balls of each bearing.
fn assembly_columns(scene: &AssemblyScene) -> Vec<Column> {
    let mut columns = Vec::new();
    let Ok(still) = scene.statics() else { return columns };
    for body in still.bodies.iter().filter(|body| matches!(body.place, Place::Loaded(_))) {
        let name = key(&body.name);
        for (i, coordinate) in COORDINATE_NAMES.iter().enumerate() {
            let unit = if i < 3 { "um" } else { "deg" };
            columns.push(Column::new(format!("{name}_{coordinate}"), unit));
        }
        // Loads, then the stiffness of the body with all others fixed.
        let results = RESULTS[..10].iter();
        columns.extend(results.map(|(load, unit)| Column::new(format!("{name}_{load}"), *unit)));
    }
    for placed in &scene.bearings {
        let prefix = placed.name.as_ref().map_or(String::new(), |name| format!("{name}_"));
        let force = FORCES.iter();
        columns.extend(force.map(|(of, unit)| Column::new(format!("{prefix}{of}"), *unit)));
        let of_balls = RESULTS[10..16].iter();
        columns.extend(of_balls.map(|(of, unit)| Column::new(format!("{prefix}{of}"), *unit)));
    }
    let (name, unit) = RESULTS[16];
    columns.push(Column::new(name, unit));
    columns
}

/// Position, loads and stiffness of bodies, and the balls of each bearing, in the order of [`assembly_columns`].
fn of_assembly(still: &StaticAssembly, solution: &AssemblySolution) -> Vec<f64> {
    let mut row = Vec::new();
    let bodies = still.bodies.iter().enumerate();
    let loaded = bodies.filter(|(_, body)| matches!(body.place, Place::Loaded(_)));
    for (place, (index, _)) in loaded.enumerate() {
        row.extend(position(&solution.coordinates[index]));
        row.extend(solution.loads[index].iter());
        row.extend((0..5).map(|i| solution.stiffness[(5 * place + i, 5 * place + i)]));
    }
    for bearing in &solution.bearings {
        let [force, _] = &bearing.forces;
        row.extend(force.iter());
        row.extend(of_balls(&bearing.balls));
    }
    row.push(free_directions(&solution.determinacy));
    row
}

pub fn start_of_row(grid: &Grid, point: usize) -> Vec<f64> {
    let varied = grid.axes.iter().zip(grid.indices(point));
    let varied = varied.map(|(axis, index)| super::report::number_of(axis, index));
    std::iter::once(point as f64).chain(varied).collect()
}

/// Position and results of a bearing.
fn of_bearing(solution: &StaticSolution) -> Vec<f64> {
    let mut row = position(&solution.coordinates).to_vec();
    row.extend(solution.loads.iter());
    row.extend((0..5).map(|i| solution.stiffness[(i, i)]));
    row.extend(of_balls(&solution.balls));
    row.push(free_directions(&solution.determinacy));
    row
}

/// In um and deg.
fn position(q: &SVector<f64, 5>) -> [f64; 5] {
    std::array::from_fn(|i| if i < 3 { 1e6 * q[i] } else { q[i].to_degrees() })
}

fn of_balls(balls: &[BallState]) -> [f64; 6] {
    let (loaded, extent) = load_zone_of(balls);
    let largest = |of: &dyn Fn(&BallState) -> f64| balls.iter().map(of).fold(0.0, f64::max);
    [
        loaded as f64,
        extent.to_degrees(),
        largest(&|ball| ball.inner.normal_load),
        largest(&|ball| ball.outer.normal_load),
        1e-6 * largest(&|ball| ball.inner.peak_pressure),
        1e-6 * largest(&|ball| ball.outer.peak_pressure),
    ]
}

fn free_directions(determinacy: &Determinacy) -> f64 {
    match determinacy {
        Determinacy::Determinate => 0.0,
        Determinacy::Indeterminate { free_directions } => free_directions.len() as f64,
    }
}
