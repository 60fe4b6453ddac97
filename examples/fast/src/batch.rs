//! Many points of one scene: a grid over some keys, a row of a table for each point.

use crate::motion::{self, tables};
use crate::scene::{COORDINATES, Hertz, Outcome, Scene, Stop, read};
use crate::statics::{Common, Equilibrium, Problem, solve_lanes};
use rayon::prelude::*;
use serde_json::Value;

/// Tolerance of equilibria, see [`Common`].
const TOLERANCE: f64 = 1e-13;

/// Step of a run without a given one, as a fraction of 1 rad of its fastest oscillation.
const FRACTION: f64 = 0.1;

const STATISTICS: [&str; 4] = ["mean", "rms", "smallest", "largest"];

/// Keys and their values in SI units; the last key varies fastest.
struct Grid {
    keys: Vec<(String, Vec<f64>)>,
    points: usize,
}

impl Grid {
    fn read(vary: &Value) -> Outcome<Grid> {
        let mut keys = Vec::new();
        for axis in vary.as_array().into_iter().flatten() {
            let key = axis["key"].as_str().unwrap_or_default();
            let wrong = || Stop::Error(format!("vary {key}: `values`, or `from`, `to` and `count`, are needed"));
            let values = match axis["values"].as_array() {
                Some(values) => values.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>().ok_or_else(wrong)?,
                None => {
                    let (from, to) = (axis["from"].as_f64().ok_or_else(wrong)?, axis["to"].as_f64().ok_or_else(wrong)?);
                    let count = axis["count"].as_u64().ok_or_else(wrong)?;
                    let share = |i: u64| i as f64 / (count - 1).max(1) as f64;
                    (0..count).map(|i| from + (to - from) * share(i)).collect()
                }
            };
            keys.push((key.to_string(), values));
        }
        let points = keys.iter().map(|(_, values)| values.len()).product();
        Ok(Grid { keys, points })
    }

    /// Values of the keys at a point.
    fn at(&self, mut point: usize) -> Vec<f64> {
        let mut values = vec![0.0; self.keys.len()];
        for (slot, (_, all)) in values.iter_mut().zip(&self.keys).rev() {
            *slot = all[point % all.len()];
            point /= all.len();
        }
        values
    }

    fn scene(&self, scene: &Scene, point: usize) -> Outcome<(Scene, Vec<f64>)> {
        let (mut changed, values) = (*scene, self.at(point));
        for ((key, _), value) in self.keys.iter().zip(&values) {
            changed.set(key, *value)?;
        }
        Ok((changed, values))
    }
}

/// Peak pressure (Pa) under a load in N, and the semi-axes (m) of the contact ellipse.
pub fn ellipse(hertz: &Hertz, load: f64) -> [f64; 3] {
    let curvature = 1.0 / hertz.rolling + 1.0 / hertz.transverse;
    let major = (6.0 * hertz.ellipticity.powi(2) * hertz.second * load.max(0.0)
        / (std::f64::consts::PI * hertz.modulus * curvature))
        .cbrt();
    let minor = major / hertz.ellipticity;
    let pressure = if load > 0.0 { 1.5 * load / (std::f64::consts::PI * major * minor) } else { 0.0 };
    [pressure, major, minor]
}

/// Appends numbers, separated by commas, each with the fewest digits that read back as the same number.
pub fn append(row: &mut Vec<u8>, values: impl IntoIterator<Item = f64>) {
    for value in values {
        // NaN, which JSON does not have, is written as `null`.
        let _ = serde_json::to_writer(&mut *row, &value);
        row.push(b',');
    }
}

/// Solves the batch and returns its table.
///
/// # Errors
///
/// An unclaimed feature, or a batch file that cannot be read.
pub fn solve(batch: &Value) -> Outcome<Vec<u8>> {
    let kind = batch["of"].as_str().unwrap_or("statics");
    let scene = read(&batch["scene"], kind)?;
    let grid = Grid::read(&batch["vary"])?;
    let common = Common::new(&scene, TOLERANCE);
    let every_ball = batch["balls"] == Value::Bool(true);
    let mut columns: Vec<String> = vec!["point [1]".into()];
    columns.extend(grid.keys.iter().map(|(key, _)| key.clone()));
    let lanes = if scene.run.is_some() {
        columns.extend(statistics(scene.count));
        8
    } else {
        columns.extend(equilibrium_columns(scene.count, every_ball));
        8
    };
    let groups: Vec<usize> = (0..grid.points).step_by(lanes).collect();
    let rows = groups.into_par_iter().map(|first| {
        let points = first..(first + lanes).min(grid.points);
        let scenes = points.clone().map(|point| grid.scene(&scene, point)).collect::<Outcome<Vec<_>>>()?;
        let mut rows = Vec::with_capacity(points.len() * 20 * columns.len());
        let start = |rows: &mut Vec<u8>, i: usize| {
            append(rows, [(first + i) as f64]);
            append(rows, scenes[i].1.iter().copied());
        };
        if scene.run.is_some() {
            let scenes: Vec<Scene> = scenes.iter().map(|(scene, _)| *scene).collect();
            for (i, table) in tables(&scenes, &common, FRACTION)?.iter().enumerate() {
                start(&mut rows, i);
                run_row(&mut rows, &scenes[i], table);
            }
        } else {
            let problems: Vec<Problem> = scenes.iter().map(|(scene, _)| Problem::new(scene, &common)).collect();
            for (i, found) in solve_lanes(&common, &problems).iter().enumerate() {
                start(&mut rows, i);
                row(&mut rows, found, &problems[i], every_ball);
            }
        }
        Ok(rows)
    });
    let rows = rows.collect::<Outcome<Vec<Vec<u8>>>>()?;
    let mut text = columns.join(",").into_bytes();
    text.push(b'\n');
    rows.iter().for_each(|row| text.extend_from_slice(row));
    Ok(text)
}

/// Columns of an equilibrium after the varied keys.
fn equilibrium_columns(count: usize, every_ball: bool) -> Vec<String> {
    let units = [["m"; 3].as_slice(), &["rad"; 2]].concat();
    let top = [["N/m"; 3].as_slice(), &["N m/rad"; 2]].concat();
    let loads = ["load_x [N]", "load_y [N]", "load_z [N]", "moment_y [N m]", "moment_z [N m]"];
    let mut columns: Vec<String> = (0..5).map(|i| format!("{} [{}]", COORDINATES[i], units[i])).collect();
    columns.extend(loads.map(String::from));
    columns.extend((0..5).map(|i| format!("stiffness_{} [{}]", COORDINATES[i], top[i])));
    columns.push("loaded_balls [1]".into());
    columns.extend(["inner", "outer"].map(|race| format!("largest_{race}_load [N]")));
    columns.extend(["inner", "outer"].map(|race| format!("largest_{race}_pressure [Pa]")));
    for ball in (1..=count).filter(|_| every_ball) {
        columns.extend(["inner", "outer"].map(|race| format!("ball_{ball}_{race}_load [N]")));
    }
    columns.push("status [1]".into());
    columns
}

/// Columns of a run: four statistics of each channel.
fn statistics(count: usize) -> Vec<String> {
    let channels = motion::columns(count).into_iter().skip(1);
    let four = |(name, unit): (String, &str)| STATISTICS.map(|kind| format!("{name}_{kind} [{unit}]"));
    channels.flat_map(four).collect()
}

/// Mean, RMS about the mean, smallest and largest value of each channel from `output.window_start` on.
fn run_row(rows: &mut Vec<u8>, scene: &Scene, table: &[Vec<f64>]) {
    let from = scene.run.map_or(0.0, |run| run.window_start - 1e-9 * run.interval);
    let first = table.iter().position(|row| row[0] >= from).unwrap_or(0);
    let window = &table[first..];
    let count = window.len() as f64;
    for channel in 1..window[0].len() {
        let values = || window.iter().map(|row| row[channel]);
        let mean = values().sum::<f64>() / count;
        let rms = (values().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
        let extremes = values().fold([f64::MAX, f64::MIN], |[low, high], value| [low.min(value), high.max(value)]);
        append(rows, [mean, rms, extremes[0], extremes[1]]);
    }
    rows.pop();
    rows.push(b'\n');
}

/// Largest load on each race.
pub fn largest(found: &Equilibrium) -> [f64; 2] {
    [0, 1].map(|side| found.ball_loads.iter().map(|load| load[side]).fold(0.0, f64::max))
}

fn row(rows: &mut Vec<u8>, found: &Equilibrium, problem: &Problem, every_ball: bool) {
    append(rows, found.position);
    append(rows, found.loads);
    append(rows, (0..5).map(|i| found.stiffness[i][i]));
    let largest = largest(found);
    append(rows, [found.ball_loads.iter().filter(|load| load[0] > 0.01 * largest[0]).count() as f64]);
    append(rows, largest);
    append(rows, [0, 1].map(|side| ellipse(&problem.hertz[side], largest[side])[0]));
    if every_ball {
        append(rows, found.ball_loads.iter().flatten().copied());
    }
    let status = if !found.converged { 2 } else { u8::from(!found.determinate) };
    rows.push(b'0' + status);
    rows.push(b'\n');
}
