//! Tolerances of a pack: of rounding for equilibria, measured; of a run from how much it differs from runs next to it.

use super::Fallible;
use super::solved::{Kind, Solved};
use bearing_dynamics::output::Series;
use bearing_dynamics::output::compare::tolerance::{
    ChannelTolerance, RequestedTolerance, ToleranceClass, Tolerances,
};
use bearing_dynamics::output::compare::{Options, compare};
use bearing_dynamics::output::pack::expected;
use bearing_dynamics::output::results::pretty;
use serde_json::Value;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

/// Class of channels without a tolerance of their own: the same equations in double precision, or by another integrator.
fn class_of(kind: Kind) -> ToleranceClass {
    match kind {
        Kind::Run => ToleranceClass::Integrated,
        Kind::Statics | Kind::Modes | Kind::Sweep => ToleranceClass::F64Reordered,
    }
}

/// Shift of the balls that shows how neighbouring runs part, rad, and the share of a channel's largest value up to
/// which they are alike.
const NEIGHBOUR: f64 = 1e-9;
const ALIKE: f64 = 1e-3;
/// A column that is rounding and errors of steps alone.
const RESIDUAL: &str = "energy_residual";
/// Fewest rows of a trajectory that are compared.
const FEWEST_ROWS: usize = 2;
/// Other starts of a chaotic run, and the shift of the balls from one to the next, rad.
const STARTS: usize = 16;
const NEXT_START: f64 = 1e-6;
/// Tolerance over the difference to the same equilibrium with other rounding.
const OF_ROUNDING: f64 = 10.0;
/// Least tolerance of forces over the largest force, and of moments over it times the largest length: ten times the
/// residual at which the search ends.
const OF_SEARCH: f64 = 1e-10;
/// Tolerance over the difference to a run of finer steps: another integrator errs as much, or a few times more.
const OF_STEPS: f64 = 10.0;
/// Tolerance over the largest difference to the other starts: a further start is outside the largest of 16 now and
/// then, outside three times of it never in a million (normal distribution: 5.3 standard deviations).
const OF_STARTS: f64 = 3.0;

/// Channels that a program may leave out, by what it then does not claim.
const TAGS: [(&str, &[&str]); 9] = [
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

/// [`TAGS`] as a pack has them.
pub fn tags() -> BTreeMap<String, Vec<String>> {
    let names = |names: &[&str]| names.iter().map(|name| name.to_string()).collect();
    TAGS.iter().map(|(tag, of)| (tag.to_string(), names(of))).collect()
}

pub fn of(kind: Kind, solved: &Solved, files: &[(String, Vec<u8>)]) -> Fallible<Tolerances> {
    let mut all = Tolerances { class: Some(class_of(kind)), tags: tags(), ..Tolerances::default() };
    let scene = &solved.summary["scene"];
    let mut spread = Spread::new(kind, solved)?;
    if kind != Kind::Run {
        if let Some(turned) = shifted(scene, TAU) {
            spread.add(&Solved::again(kind, &turned, files)?)?;
        }
        let reason = format!("{OF_ROUNDING} times the difference to the balls a whole turn on");
        all.channels = spread.tolerances(OF_ROUNDING, &reason);
        spread.add_floors(&solved.summary, &mut all.channels)?;
        return Ok(all);
    }
    let finer = match finer(scene) {
        Some(finer) => vec![Solved::again(kind, &finer, files)?],
        None => Vec::new(),
    };
    let neighbour = shifted(scene, NEIGHBOUR);
    let neighbour = neighbour.map(|of| Solved::again(kind, &of, files)).transpose()?;
    let is_chaotic = match &neighbour {
        Some(neighbour) => rows_alike(solved, neighbour)?.is_some(),
        None => false,
    };
    if !is_chaotic {
        finer.iter().try_for_each(|finer| spread.add(finer))?;
        let reason = format!("{OF_STEPS} times the difference to a run with finer steps");
        all.channels = spread.tolerances(OF_STEPS, &reason);
        all.channels.extend(spread.residuals()?);
        return Ok(all);
    }
    let mut others = finer;
    let mut rows = usize::MAX;
    for start in 1..=STARTS {
        let other = shifted(scene, start as f64 * NEXT_START).unwrap_or_default();
        let other = Solved::again(kind, &other, files)?;
        rows = rows.min(rows_alike(solved, &other)?.unwrap_or(usize::MAX));
        others.push(other);
    }
    spread.rows = (rows < usize::MAX).then_some(rows.max(FEWEST_ROWS));
    all.rows = spread.rows;
    others.iter().try_for_each(|other| spread.add(other))?;
    let reason = format!(
        "{OF_STARTS} times the largest difference to {STARTS} other starts and to finer steps"
    );
    all.channels = spread.tolerances(OF_STARTS, &reason);
    all.channels.extend(spread.residuals()?);
    Ok(all)
}

/// The scene with half the steps, or a tenth of the accuracy; `None` without steps.
fn finer(scene: &Value) -> Option<Value> {
    const STEPS: [(&str, f64); 4] =
        [("step", 0.5), ("step_fraction", 0.5), ("coupling_phase", 0.5), ("accuracy", 0.1)];
    fn refine(value: &mut Value) -> bool {
        let Some(table) = value.as_object_mut() else { return false };
        let mut any = false;
        for (key, value) in table {
            let factor = STEPS.iter().find(|(name, _)| name == key).map(|(_, factor)| factor);
            match (factor, value.as_f64()) {
                (Some(factor), Some(step)) => (*value, any) = ((factor * step).into(), true),
                _ => any |= refine(value),
            }
        }
        any
    }
    let mut finer = scene.clone();
    let tables = ["numerics", "housing", "solid"];
    let refined = tables.map(|table| finer.get_mut(table).is_some_and(refine));
    refined.contains(&true).then_some(finer)
}

/// The scene with the balls of all bearings shifted; `None` without bearings.
fn shifted(scene: &Value, by: f64) -> Option<Value> {
    fn shift(value: &mut Value, by: f64) -> bool {
        let Some(table) = value.as_object_mut() else { return false };
        let mut any = false;
        if table.contains_key("balls") {
            let phase = table.get("ball_phase").and_then(Value::as_f64).unwrap_or(0.0);
            // Forth or back, so that a whole turn stays within a turn of zero.
            let shifted = if phase > 0.0 { phase - by } else { phase + by };
            table.insert("ball_phase".into(), shifted.into());
            any = true;
        }
        table.values_mut().fold(any, |any, value| shift(value, by) | any)
    }
    let mut other = scene.clone();
    other.get_mut("bearing").is_some_and(|of| shift(of, by)).then_some(other)
}

/// Number of first rows in which no column differs by more than [`ALIKE`] of its largest value; `None` for all.
fn rows_alike(one: &Solved, other: &Solved) -> Fallible<Option<usize>> {
    // Ball 1 may start at an angle of zero.
    let floors = vec![("deg".to_string(), 2.0 * (STARTS as f64 * NEXT_START).to_degrees())];
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

/// Largest differences to other results, channel by channel.
struct Spread {
    kind: Kind,
    /// First rows of tables that count; `None` for all.
    rows: Option<usize>,
    reference: tempfile::TempDir,
    /// Largest ratio of a difference to the tolerance of the class, and the largest difference; infinite where texts
    /// or numbers of entries differ.
    largest: BTreeMap<String, (String, f64, f64)>,
}

impl Spread {
    fn new(kind: Kind, solved: &Solved) -> Fallible<Spread> {
        let reference = tempfile::tempdir()?;
        lay(kind, solved, reference.path())?;
        Ok(Spread { kind, rows: None, reference, largest: BTreeMap::new() })
    }

    fn add(&mut self, other: &Solved) -> Fallible<()> {
        let folder = tempfile::tempdir()?;
        lay(self.kind, other, folder.path())?;
        let tolerances = Tolerances {
            class: Some(class_of(self.kind)),
            rows: self.rows,
            ..Tolerances::default()
        };
        let options = Options { tolerances: Some(tolerances), ..Options::default() };
        for channel in compare(self.reference.path(), folder.path(), &options)?.channels {
            let found = match &channel.worst {
                Some(worst) => (worst.ratio, worst.difference),
                None if channel.differing == 0 => continue,
                None => (f64::INFINITY, f64::INFINITY),
            };
            let entry = self.largest.entry(channel.channel).or_insert((channel.unit, 0.0, 0.0));
            (entry.1, entry.2) = (entry.1.max(found.0), entry.2.max(found.1));
        }
        Ok(())
    }

    /// Channels of the reference with their units.
    fn channels(&self) -> Fallible<Vec<(String, String)>> {
        let of = self.reference.path();
        let all = compare(of, of, &Options::default())?.channels.into_iter();
        Ok(all.map(|channel| (channel.channel, channel.unit)).collect())
    }

    /// Residuals are measures of the solution process.
    fn residuals(&self) -> Fallible<BTreeMap<String, ChannelTolerance>> {
        let ignored = || ChannelTolerance {
            class: Some(ToleranceClass::Ignored),
            reason: Some("a measure of the steps".into()),
            ..ChannelTolerance::default()
        };
        let names = self.channels()?.into_iter().map(|(name, _)| name);
        Ok(names.filter(|name| name.contains("residual")).map(|name| (name, ignored())).collect())
    }

    /// Raises the floors of forces and moments to what a search leaves.
    fn add_floors(
        &self,
        summary: &Value,
        channels: &mut BTreeMap<String, ChannelTolerance>,
    ) -> Fallible<()> {
        let (force, length) = (largest(summary, "N"), largest(summary, "m"));
        for (name, unit) in self.channels()? {
            let floor = match unit.as_str() {
                "N" => OF_SEARCH * force,
                "N m" => OF_SEARCH * force * length,
                _ => continue,
            };
            let class =
                class_of(self.kind).tolerance(&unit).map_or(0.0, |class| class.absolute_floor);
            let own = channels.get(&name).and_then(|own| own.absolute_floor).unwrap_or(class);
            if floor > own {
                let own = channels.entry(name).or_default();
                own.absolute_floor = Some(floor);
                own.reason.get_or_insert_with(|| "ten times the residual of a search".into());
            }
        }
        Ok(())
    }

    /// Tolerances of the channels that differ by more than rounding.
    fn tolerances(&self, factor: f64, reason: &str) -> BTreeMap<String, ChannelTolerance> {
        let of = |(channel, (unit, ratio, difference)): (&String, &(String, f64, f64))| {
            if factor * ratio <= 1.0 {
                return None;
            }
            let mut own = ChannelTolerance::default();
            let class = class_of(self.kind).tolerance(unit)?;
            if difference.is_infinite() {
                own.class = Some(ToleranceClass::Ignored);
                own.reason = Some("it differs between runs that are next to each other".into());
            } else if ratio.is_infinite() {
                own.absolute_floor = Some(factor * difference);
                own.reason = Some(reason.into());
            } else {
                own.absolute_floor = Some(factor * ratio * class.absolute_floor);
                own.relative = Some(factor * ratio * class.relative);
                own.scale_relative = Some(factor * ratio * class.scale_relative);
                own.reason = Some(reason.into());
            }
            Some((channel.clone(), own))
        };
        self.largest.iter().filter_map(of).collect()
    }
}

/// Largest value of this unit in a summary.
fn largest(summary: &Value, unit: &str) -> f64 {
    match summary {
        Value::Object(map) if map.get("unit").is_some_and(|own| own == unit) => {
            map.get("value").and_then(Value::as_f64).map_or(0.0, f64::abs)
        }
        Value::Object(map) => map.values().map(|part| largest(part, unit)).fold(0.0, f64::max),
        Value::Array(list) => list.iter().map(|part| largest(part, unit)).fold(0.0, f64::max),
        _ => 0.0,
    }
}

/// What a pack would have of these results.
fn lay(kind: Kind, solved: &Solved, folder: &Path) -> Fallible<()> {
    if let Some(summary) = expected(&solved.summary) {
        std::fs::write(folder.join("summary.json"), pretty(&summary))?;
    }
    for (name, content) in solved.tables(kind)? {
        std::fs::write(folder.join(name), content)?;
    }
    Ok(())
}
