//! Tolerances of a pack, measured: from how much the results differ from those of scenes next to it.

use super::Fallible;
use super::neighbours::{
    FARTHEST_START, STARTS, alike, finer, finer_meshes, has_beams, has_shafts, neighbour, starts,
};
use super::solved::{Kind, Solved};
use super::spread::Spread;
use bearing_dynamics::output::Series;
use bearing_dynamics::output::compare::tolerance::{
    ChannelTolerance, RequestedTolerance, ToleranceClass, Tolerances,
};
use bearing_dynamics::output::compare::{Options, compare};
use serde_json::Value;
use std::collections::BTreeMap;

/// Class of channels without a tolerance of their own: the same equations in double precision, or by another integrator.
fn class_of(of_runs: bool) -> ToleranceClass {
    match of_runs {
        true => ToleranceClass::Integrated,
        false => ToleranceClass::F64Reordered,
    }
}

/// Runs whose columns differ by no more than this share of their largest values are alike.
const ALIKE: f64 = 1e-3;
/// A column that is rounding and errors of steps alone.
const RESIDUAL: &str = "energy_residual";
/// Fewest rows of a trajectory that are compared.
const FEWEST_ROWS: usize = 2;
/// Tolerance over the difference to results with other rounding, finer steps or shorter elements: another program errs
/// as much, or a few times more.
const OF_ERRORS: f64 = 10.0;
/// Tolerance over the largest difference to the other starts: a further start is outside the largest of 16 now and
/// then; five times of it are about nine standard deviations, because a run has a thousand channels and few are normally
/// distributed.
const OF_STARTS: f64 = 5.0;
/// Share of the rows in which all starts were alike that is compared: a further start may part a little earlier.
const ROWS_COMPARED: f64 = 0.5;

/// Least tolerance with shafts, and of modes with housings: theories of shafts of the second order differ by 4e-7 of the
/// deflection, from linear ones by 3e-5; elements of usual rotor programs, 24 a shaft, by 2e-5; component modes by 4e-6.
const OF_SHAFTS: f64 = 1e-4;
/// Least tolerance with solids: finite-element programs print seven digits, and solve to about as many.
const OF_SOLIDS: f64 = 1e-6;
/// Least tolerance of stresses in housings: of the second order in the strain, 2.5e-4 for an interference of 5 um.
const OF_STRESSES: f64 = 1e-3;

/// Groups of channels that a program may leave out.
const GROUPS: [(&str, &[&str]); 9] = [
    ("stiffness", &["stiffness", "stiffness_to_ground"]),
    ("life", &["rating_life"]),
    ("hertz", &["hertz"]),
    ("frequencies", &["frequencies", "kinematics", "spectra"]),
    ("determinacy", &["determinacy"]),
    ("pressure", &["*peak_pressure", "*largest_pressure", "*semi_major", "*semi_minor"]),
    ("energy", &["energy", "energy_*", "work_*", "heat_*"]),
    ("statistics", &["window", "extremes", "friction", "final"]),
    ("inertia", &["inertia"]),
];

/// [`GROUPS`] as a pack has them.
pub fn groups() -> BTreeMap<String, Vec<String>> {
    let names = |names: &[&str]| names.iter().map(|name| name.to_string()).collect();
    GROUPS.iter().map(|(group, of)| (group.to_string(), names(of))).collect()
}

pub fn of(kind: Kind, solved: &Solved, files: &[(String, Vec<u8>)]) -> Fallible<Tolerances> {
    let of_runs = solved.is_of_runs(kind);
    let class = class_of(of_runs);
    let mut all = Tolerances { class: Some(class), groups: groups(), ..Tolerances::default() };
    let scene = &solved.summary["scene"];
    let again = |scene: Value| Solved::again(kind, &scene, files);
    let mut spread = Spread::new(kind, class, solved)?;
    let mut others = alike(scene).into_iter().map(again).collect::<Fallible<Vec<Solved>>>()?;
    let (mut factor, mut reason) =
        (OF_ERRORS, "times the difference to other rounding".to_string());
    if has_beams(scene) {
        reason += ", shorter elements or more modes of shafts";
    }
    if finer_meshes(scene).is_some() {
        reason += ", finer meshes of shafts and bushings";
    }
    if of_runs {
        for finer in finer(scene) {
            others.push(again(finer)?);
        }
        reason += " or finer steps";
    }
    if kind == Kind::Run {
        let neighbour = neighbour(scene).map(again).transpose()?;
        let parts = match &neighbour {
            Some(neighbour) => rows_alike(solved, neighbour)?.is_some(),
            None => false,
        };
        if parts {
            for start in starts(scene) {
                others.push(again(start)?);
            }
            let mut rows = usize::MAX;
            for other in &others {
                rows = rows.min(rows_alike(solved, other)?.unwrap_or(usize::MAX));
            }
            spread.rows = (rows < usize::MAX).then_some(rows.max(FEWEST_ROWS));
            let compared = |rows: usize| ((ROWS_COMPARED * rows as f64) as usize).max(FEWEST_ROWS);
            all.rows = spread.rows.map(compared);
            factor = OF_STARTS;
            reason =
                format!("times the largest difference to {STARTS} other starts and to finer steps");
            // Nothing else tests what follows the rows.
            if all.rows.is_some() {
                all.groups.remove("statistics");
            }
        }
    }
    others.iter().try_for_each(|other| spread.add(other))?;
    all.channels = spread.tolerances(factor, &format!("{factor} {reason}"));
    match of_runs {
        true => spread.widen_extremes(&mut all.channels)?,
        false => spread.add_floors(&mut all.channels)?,
    }
    if has_shafts(scene) || kind == Kind::Modes && scene.get("housing").is_some() {
        let reason = "shafts of other theories, elements or component modes";
        spread.add_least(&mut all.channels, |_| (OF_SHAFTS, reason))?;
    }
    if scene.get("solid").is_some() {
        let is_stress = |name: &str| name.contains("von_mises") && scene.get("housing").is_some();
        let least = |name: &str| match is_stress(name) {
            true => (OF_STRESSES, "stresses of the second order in the strain"),
            false => (OF_SOLIDS, "digits of finite-element programs"),
        };
        spread.add_least(&mut all.channels, least)?;
    }
    all.channels.extend(spread.left_out()?);
    // Another program may list more modes.
    all.partial = kind == Kind::Modes;
    Ok(all)
}

/// Number of first rows in which no column differs by more than [`ALIKE`] of its largest value; `None` for all.
fn rows_alike(one: &Solved, other: &Solved) -> Fallible<Option<usize>> {
    // Ball 1 may start at an angle of zero.
    let floors = vec![("deg".to_string(), 2.0 * FARTHEST_START.to_degrees())];
    let given = RequestedTolerance { scale_relative: ALIKE, floors };
    let [one, other] = [one, other].map(|of| of.results().join("series.csv"));
    let mut tolerances = Tolerances::default();
    if let Some(name) = Series::read_csv(&one)?.column(RESIDUAL).map(|_| RESIDUAL.to_string()) {
        let class = Some(ToleranceClass::Ignored);
        tolerances.channels.insert(name, ChannelTolerance { class, ..ChannelTolerance::default() });
    }
    let options =
        Options { given: Some(given), tolerances: Some(tolerances), ..Options::default() };
    let first = compare(&one, &other, &options)?.first_divergence;
    Ok(first.map(|first| first.row.saturating_sub(1)))
}
