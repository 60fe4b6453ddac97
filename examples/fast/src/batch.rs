//! Many points of one scene: a grid over some keys, a row of a table for each point.

use crate::scene::{COORDINATES, Hertz, Outcome, Scene, Stop, read, si};
use crate::statics::{Common, Equilibrium, Problem, solve_lanes};
use rayon::prelude::*;
use serde_json::Value;

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
                Some(values) => values.iter().map(si).collect::<Option<Vec<f64>>>().ok_or_else(wrong)?,
                None => {
                    let (from, to) = (si(&axis["from"]).ok_or_else(wrong)?, si(&axis["to"]).ok_or_else(wrong)?);
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
    let scene = read(&batch["scene"])?;
    let grid = Grid::read(&batch["vary"])?;
    let every_ball = batch["balls"] == Value::Bool(true);
    let mut table: Vec<String> = vec!["point [1]".into()];
    table.extend(grid.keys.iter().map(|(key, _)| key.clone()));
    let units = ["m", "m", "m", "rad", "rad"];
    table.extend((0..5).map(|i| format!("{} [{}]", COORDINATES[i], units[i])));
    let loads = ["load_x [N]", "load_y [N]", "load_z [N]", "moment_y [N m]", "moment_z [N m]"];
    table.extend(loads.map(String::from));
    let top = ["N/m", "N/m", "N/m", "N m/rad", "N m/rad"];
    table.extend((0..5).map(|i| format!("stiffness_{} [{}]", COORDINATES[i], top[i])));
    let rest = ["loaded_balls [1]", "largest_inner_load [N]", "largest_outer_load [N]", "largest_inner_pressure [Pa]",
        "largest_outer_pressure [Pa]"];
    table.extend(rest.map(String::from));
    for ball in (1..=scene.count).filter(|_| every_ball) {
        table.extend(["inner", "outer"].map(|race| format!("ball_{ball}_{race}_load [N]")));
    }
    table.push("status [1]\n".into());
    let common = Common::new(&scene);
    let rows: Vec<Vec<u8>> = (0..grid.points.div_ceil(8))
        .into_par_iter()
        .map(|group| {
            let points: Vec<usize> = (8 * group..(8 * group + 8).min(grid.points)).collect();
            let scenes = points.iter().map(|point| grid.scene(&scene, *point)).collect::<Outcome<Vec<_>>>()?;
            let problems: Vec<Problem> = scenes.iter().map(|(scene, _)| Problem::new(scene, &common)).collect();
            let mut rows = Vec::with_capacity(points.len() * 24 * table.len());
            for (i, found) in solve_lanes(&common, &problems).iter().enumerate() {
                append(&mut rows, [points[i] as f64]);
                append(&mut rows, scenes[i].1.iter().copied());
                row(&mut rows, found, &problems[i], every_ball);
            }
            Ok(rows)
        })
        .collect::<Outcome<Vec<Vec<u8>>>>()?;
    let mut text = table.join(",").into_bytes();
    rows.iter().for_each(|row| text.extend_from_slice(row));
    Ok(text)
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
