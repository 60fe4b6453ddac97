//! One point of a sweep and its row of the table.

use super::grid::Grid;
use super::housed::{self, Kept};
use crate::commands::assembly::housings;
use bearing_dynamics::output::Column;
use bearing_dynamics::output::assembly_results::{key, readable};
use bearing_dynamics::output::results::load_zone_of;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::scene::{Document, Subject};
use bearing_dynamics::solver::static_assembly::{Place, StaticAssembly};
use bearing_dynamics::solver::statics::{
    AssemblySolution, BallState, COORDINATE_NAMES, Determinacy, StaticOptions, StaticSolution,
    solve_assembly, solve_from,
};
use nalgebra::SVector;

pub struct Solved {
    pub row: Vec<f64>,
    /// `None` where the position is one of many and a neighbour should look for its own.
    pub start_for_neighbour: Option<Vec<SVector<f64, 5>>>,
}

/// A point's scene solved, from a neighbour's solution or, in a housing, with a neighbour's housing.
pub fn solve(
    document: &Document,
    grid: &Grid,
    point: usize,
    neighbour: Option<&[SVector<f64, 5>]>,
    housing: &mut Option<Kept>,
) -> Result<Solved, String> {
    let text = |error: &dyn std::fmt::Display| error.to_string();
    let scene = match grid.scene(document, point).map_err(|error| text(&error))? {
        Subject::Housed(scene) => {
            let row = housed::row(&scene, housing).map_err(|error| text(&error))?;
            let row = [start_of_row(grid, point), row].concat();
            return Ok(Solved { row, start_for_neighbour: None });
        }
        Subject::Bearing(scene) => *scene,
        Subject::Assembly(scene) => {
            let housings = housings::prepare(document, &scene).map_err(|error| text(&error))?;
            let bores = housings::condensed(&housings).map_err(|error| text(&error))?;
            let still = housings::statics(&scene, &housings, &bores).map_err(|e| text(&e))?;
            let solution = solve_assembly(&still, neighbour, &StaticOptions::default())
                .map_err(|error| text(&error))?;
            let determinate = solution.determinacy == Determinacy::Determinate;
            let moving = scene.assembly().map_err(|error| text(&error))?;
            let read = readable(&moving, &still, &solution);
            return Ok(Solved {
                row: [start_of_row(grid, point), of_assembly(&still, &read)].concat(),
                start_for_neighbour: determinate.then_some(solution.coordinates),
            });
        }
        Subject::Solid(_) => return Err("a solid by itself is not swept".into()),
    };
    let problem = static_problem(&scene).map_err(|error| text(&error))?;
    let near = neighbour.and_then(|near| near.first());
    let solution =
        solve_from(&problem, near, &StaticOptions::default()).map_err(|error| text(&error))?;
    let determinate = solution.determinacy == Determinacy::Determinate;
    Ok(Solved {
        row: [start_of_row(grid, point), of_bearing(&solution)].concat(),
        start_for_neighbour: determinate.then(|| vec![solution.coordinates]),
    })
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

/// Header of the table: point, varied keys, position, results, and what a housing adds.
pub fn columns(grid: &Grid, subject: Option<&Subject>) -> Vec<Column> {
    let mut columns = vec![Column::new("point", "1")];
    for axis in &grid.axes {
        columns.push(Column::new(axis.key.clone(), super::report::unit_of(axis)));
    }
    if let Some(Subject::Assembly(scene)) = subject {
        columns.extend(assembly_columns(scene));
        return columns;
    }
    for (i, name) in COORDINATE_NAMES.iter().enumerate() {
        columns.push(Column::new(*name, if i < 3 { "um" } else { "deg" }));
    }
    let housed = matches!(subject, Some(Subject::Housed(_)));
    let further: &[(&str, &str)] = if housed { &housed::RESULTS } else { &[] };
    let results = RESULTS.iter().chain(further);
    columns.extend(results.map(|(name, unit)| Column::new(*name, *unit)));
    columns
}

/// Of each body that loads may move position and what holds it, of each bearing how its balls are loaded.
fn assembly_columns(scene: &AssemblyScene) -> Vec<Column> {
    let mut columns = Vec::new();
    let Ok(still) = scene.statics() else { return columns };
    for body in still.bodies.iter().filter(|body| matches!(body.place, Place::Loaded(_))) {
        let name = key(&body.name);
        for (i, coordinate) in COORDINATE_NAMES.iter().enumerate() {
            let unit = if i < 3 { "um" } else { "deg" };
            columns.push(Column::new(format!("{name}_{coordinate}"), unit));
        }
        let loads = RESULTS[..5].iter();
        columns.extend(loads.map(|(load, unit)| Column::new(format!("{name}_{load}"), *unit)));
    }
    for placed in &scene.bearings {
        let prefix = placed.name.as_ref().map_or(String::new(), |name| format!("{name}_"));
        let of_balls = RESULTS[10..16].iter();
        columns.extend(of_balls.map(|(of, unit)| Column::new(format!("{prefix}{of}"), *unit)));
    }
    let (name, unit) = RESULTS[16];
    columns.push(Column::new(name, unit));
    columns
}

/// Position and loads of bodies, and the balls of each bearing, in the order of [`assembly_columns`].
fn of_assembly(still: &StaticAssembly, solution: &AssemblySolution) -> Vec<f64> {
    let mut row = Vec::new();
    for (index, body) in still.bodies.iter().enumerate() {
        if matches!(body.place, Place::Loaded(_)) {
            row.extend(position(&solution.coordinates[index]));
            row.extend(solution.loads[index].iter());
        }
    }
    for bearing in &solution.bearings {
        row.extend(of_balls(&bearing.balls));
    }
    row.push(free_directions(&solution.determinacy));
    row
}

fn start_of_row(grid: &Grid, point: usize) -> Vec<f64> {
    let varied = grid.axes.iter().zip(grid.indices(point));
    let varied = varied.map(|(axis, index)| super::report::number_of(axis, index));
    std::iter::once(point as f64).chain(varied).collect()
}

/// Position and results of a bearing.
pub fn of_bearing(solution: &StaticSolution) -> Vec<f64> {
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
