//! One point of a sweep and its row of the table.

use super::grid::Grid;
use super::housed::{self, Kept};
use bearing_dynamics::output::Column;
use bearing_dynamics::output::results::load_zone_of;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::scene::{Document, Subject};
use bearing_dynamics::solver::statics::{
    COORDINATE_NAMES, Determinacy, StaticOptions, StaticSolution, solve_from,
};
use nalgebra::SVector;

pub struct Solved {
    pub row: Vec<f64>,
    /// `None` where the position is one of many and a neighbour should look for its own.
    pub start_for_neighbour: Option<SVector<f64, 5>>,
}

/// A point's scene solved, from a neighbour's solution or, in a housing, with a neighbour's housing.
pub fn solve(
    document: &Document,
    grid: &Grid,
    point: usize,
    neighbour: Option<&SVector<f64, 5>>,
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
        Subject::Solid(_) => return Err("a solid by itself is not swept".into()),
    };
    let problem = static_problem(&scene).map_err(|error| text(&error))?;
    let solution =
        solve_from(&problem, neighbour, &StaticOptions::default()).map_err(|error| text(&error))?;
    let determinate = solution.determinacy == Determinacy::Determinate;
    Ok(Solved {
        row: [start_of_row(grid, point), of_bearing(&solution)].concat(),
        start_for_neighbour: determinate.then_some(solution.coordinates),
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
pub fn columns(grid: &Grid, housed: bool) -> Vec<Column> {
    let mut columns = vec![Column::new("point", "1")];
    for axis in &grid.axes {
        columns.push(Column::new(axis.key, super::report::unit_of(axis)));
    }
    for (i, name) in COORDINATE_NAMES.iter().enumerate() {
        columns.push(Column::new(*name, if i < 3 { "um" } else { "deg" }));
    }
    let further: &[(&str, &str)] = if housed { &housed::RESULTS } else { &[] };
    let results = RESULTS.iter().chain(further);
    columns.extend(results.map(|(name, unit)| Column::new(*name, *unit)));
    columns
}

fn start_of_row(grid: &Grid, point: usize) -> Vec<f64> {
    let varied = grid.axes.iter().zip(grid.indices(point));
    let varied = varied.map(|(axis, index)| super::report::number_of(axis, index));
    std::iter::once(point as f64).chain(varied).collect()
}

/// Position and results of a bearing.
pub fn of_bearing(solution: &StaticSolution) -> Vec<f64> {
    let mut row = Vec::new();
    let q = &solution.coordinates;
    row.extend((0..3).map(|i| 1e6 * q[i]));
    row.extend((3..5).map(|i| q[i].to_degrees()));
    row.extend(solution.loads.iter());
    row.extend((0..5).map(|i| solution.stiffness[(i, i)]));
    let (loaded, extent) = load_zone_of(solution);
    row.extend([loaded as f64, extent.to_degrees()]);
    let largest = |of: &dyn Fn(usize) -> f64| (0..solution.balls.len()).map(of).fold(0.0, f64::max);
    let balls = &solution.balls;
    row.push(largest(&|j| balls[j].inner.normal_load));
    row.push(largest(&|j| balls[j].outer.normal_load));
    row.push(1e-6 * largest(&|j| balls[j].inner.peak_pressure));
    row.push(1e-6 * largest(&|j| balls[j].outer.peak_pressure));
    row.push(match &solution.determinacy {
        Determinacy::Determinate => 0.0,
        Determinacy::Indeterminate { free_directions } => free_directions.len() as f64,
    });
    row
}
