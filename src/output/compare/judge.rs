//! Comparison of the values of file pairs, with a record of the differences.

use crate::output::compare::channels::{Content, Leaf, LeafValue};
use crate::output::compare::tolerance::{
    RequestedTolerance, Tolerance, ToleranceClass, ToleranceError, Tolerances, turn,
};
use crate::output::compare::{
    ChannelResult, CompareError, Comparison, Divergence, DivergenceKind, Options, Spread, Worst,
    is_about_steps, is_default_of_key, is_ignored_by_name, unloaded,
};
use crate::output::series::Series;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::path::Path;

/// Common part of the names of a vector's components: `loads.` for `loads.x` and `loads.y`. A mean
/// or an extreme over time belongs to its channel.
fn vector_stem(channel: &str) -> &str {
    const OVER_TIME: [&str; 5] = [".mean", ".rms", ".smallest", ".largest", ".peak_to_peak"];
    let channel = OVER_TIME.iter().find_map(|end| channel.strip_suffix(end)).unwrap_or(channel);
    for component in ["tilt_y", "tilt_z", "x", "y", "z"] {
        if let Some(stem) = channel.strip_suffix(component)
            && (stem.is_empty() || stem.ends_with(['.', '_']))
        {
            return stem;
        }
    }
    channel
}

/// Difference of two angles, where one whole turn counts as zero: 315° and −45° are the same direction.
/// More than one turn is not removed, because turns are counted in such channels. Extents are no directions.
fn folded(difference: f64, channel: &str, unit: &str) -> f64 {
    let Some(turn) = turn(unit).filter(|_| !channel.ends_with("extent")) else { return difference };
    if difference < 1.5 * turn { difference.min((difference - turn).abs()) } else { difference }
}

/// Position of a difference: row (or position in the tree) and column; 0 comes before all rows.
pub type Order = (usize, usize);

pub struct Judge<'a> {
    pub file: String,
    tolerances: &'a Tolerances,
    default_class: Option<ToleranceClass>,
    given: Option<&'a RequestedTolerance>,
    /// Names in the tolerances that no channel has used yet.
    unused: BTreeSet<&'a str>,
    earliest_in_file: Option<(Order, Divergence)>,
    first: Option<Divergence>,
    differing: usize,
    channels: Vec<ChannelResult>,
    ignored: Vec<String>,
    unclaimed: BTreeSet<String>,
    pub(super) only_in_candidate: Vec<String>,
}

impl<'a> Judge<'a> {
    pub fn new(tolerances: &'a Tolerances, options: &'a Options) -> Self {
        Judge {
            file: String::new(),
            tolerances,
            default_class: options.default_class,
            given: options.given.as_ref(),
            unused: tolerances.channels.keys().map(String::as_str).collect(),
            earliest_in_file: None,
            first: None,
            differing: 0,
            channels: Vec::new(),
            ignored: Vec::new(),
            unclaimed: BTreeSet::new(),
            only_in_candidate: Vec::new(),
        }
    }

    pub fn finish_file(&mut self) {
        let earliest = self.earliest_in_file.take().map(|(_, divergence)| divergence);
        if self.first.is_none() {
            self.first = earliest;
        }
    }

    pub fn finish(self, reference: &Path) -> Result<Comparison, CompareError> {
        if let Some(channel) = self.unused.first() {
            return Err(ToleranceError::Unused { channel: channel.to_string() }.into());
        }
        self.refuse_unused_units()?;
        let checked = self.channels.iter().map(|channel| channel.checked).sum();
        if checked == 0 && self.differing == 0 {
            return Err(CompareError::NothingToCompare { reference: reference.to_path_buf() });
        }
        Ok(Comparison {
            equal: self.differing == 0,
            checked,
            differing: self.differing,
            first_divergence: self.first,
            channels: self.channels,
            ignored: self.ignored,
            unclaimed: self.unclaimed.into_iter().collect(),
            only_in_candidate: self.only_in_candidate,
        })
    }

    /// Rejects floors for units that no channel has: misspelt, or of another scale (`mm` for `m`).
    fn refuse_unused_units(&self) -> Result<(), ToleranceError> {
        let units: BTreeSet<&str> = self.channels.iter().map(|c| c.unit.as_str()).collect();
        for (unit, _) in self.given.iter().flat_map(|given| &given.floors) {
            if !units.contains(unit.as_str()) {
                let known = units.iter().filter(|unit| !unit.is_empty());
                let known = known.map(|unit| unit.to_string()).collect();
                return Err(ToleranceError::UnusedUnit { unit: unit.clone(), known });
            }
        }
        Ok(())
    }

    /// Marks the tolerances that a file uses.
    pub fn note_names(&mut self, content: &Content) {
        let names: Vec<&str> = match content {
            Content::Table(series) => series.columns().iter().map(|c| c.name.as_str()).collect(),
            Content::Tree(leaves) => leaves.iter().map(|leaf| leaf.channel.as_str()).collect(),
        };
        for name in names {
            if let Some((used, _)) = self.tolerances.entry(name) {
                self.unused.remove(used);
            }
        }
    }

    /// Lists a part of the present file as not compared.
    pub fn leave_out(&mut self, what: &str) {
        self.ignored.push(format!("{}: {what}", self.file));
    }

    fn open(&mut self, channel: &str, unit: &str) -> Option<Tolerance> {
        let named = self.tolerances.entry(channel);
        if let Some((used, _)) = named {
            self.unused.remove(used);
        }
        let given = self.given.filter(|_| named.is_none());
        let (class, tolerance) = match given {
            Some(given) => (RequestedTolerance::NAME, Some(given.tolerance(unit))),
            None => {
                let of = self.tolerances.of_channel(channel, unit, self.default_class);
                (of.0.name(), of.1)
            }
        };
        let left_out = is_ignored_by_name(channel) || (given.is_some() && is_about_steps(channel));
        let tolerance = tolerance.filter(|_| !left_out);
        if tolerance.is_none() {
            self.leave_out(channel);
            return None;
        }
        self.channels.push(ChannelResult {
            file: self.file.clone(),
            channel: channel.to_string(),
            unit: unit.to_string(),
            class,
            checked: 0,
            differing: 0,
            worst: None,
            spread: Spread::default(),
        });
        tolerance
    }

    /// Groups of which the present file of the candidate has no channel.
    fn absent_groups<'n>(&self, names: impl Iterator<Item = &'n str>) -> BTreeSet<&'a str> {
        let mut absent: BTreeSet<&str> =
            self.tolerances.groups.keys().map(String::as_str).collect();
        for group in names.filter_map(|name| self.tolerances.group(name)) {
            absent.remove(group);
        }
        absent
    }

    /// Notes a missing channel as not claimed if all of its group are missing.
    fn is_unclaimed(&mut self, channel: &str, absent: &BTreeSet<&str>) -> bool {
        let group = self.tolerances.group(channel).filter(|group| absent.contains(group));
        self.unclaimed.extend(group.map(str::to_string));
        group.is_some()
    }

    pub fn diverge(
        &mut self,
        order: Order,
        channel: &str,
        unit: &str,
        place: String,
        kind: DivergenceKind,
    ) {
        self.differing += 1;
        if self.earliest_in_file.as_ref().is_none_or(|(earliest, _)| order < *earliest) {
            let divergence = Divergence {
                file: self.file.clone(),
                channel: channel.to_string(),
                unit: unit.to_string(),
                row: order.0,
                place,
                kind,
            };
            self.earliest_in_file = Some((order, divergence));
        }
    }

    /// Notes a difference of channel number `index` that is none of two numbers.
    fn unequal(&mut self, index: usize, order: Order, place: String, kind: DivergenceKind) {
        let result = &mut self.channels[index];
        result.differing += 1;
        result.spread.unlike += 1;
        let (channel, unit) = (result.channel.clone(), result.unit.clone());
        self.diverge(order, &channel, &unit, place, kind);
    }

    /// Compares two numbers of channel number `index` in `self.channels`.
    fn real(
        &mut self,
        index: usize,
        order: Order,
        place: &dyn Fn() -> String,
        reference: f64,
        candidate: f64,
        (tolerance, scale): (Tolerance, f64),
    ) {
        let mut difference = (candidate - reference).abs();
        if !tolerance.is_exact() {
            let of = &self.channels[index];
            difference = folded(difference, &of.channel, &of.unit);
        }
        let allowed = tolerance.allowed(reference, scale);
        let finite = reference.is_finite() && candidate.is_finite();
        let same_bits = reference.to_bits() == candidate.to_bits();
        let within = match tolerance.is_exact() {
            true => finite && same_bits,
            false => finite && difference <= allowed,
        };
        let ratio = match (finite, difference == 0.0) {
            (true, true) => 0.0,
            (true, false) => difference / allowed,
            (false, _) => f64::INFINITY,
        };
        let result = &mut self.channels[index];
        result.checked += 1;
        result.spread.scale = scale;
        result.spread.add(reference, difference);
        if result.worst.as_ref().is_none_or(|worst| ratio > worst.ratio) {
            result.worst = Some(Worst { place: place(), difference, allowed, ratio });
        }
        if !within {
            result.differing += 1;
            let (channel, unit) = (result.channel.clone(), result.unit.clone());
            let kind = DivergenceKind::Value { reference, candidate, difference, allowed };
            self.diverge(order, &channel, &unit, place(), kind);
        }
    }

    pub fn tables(&mut self, reference: &Series, candidate: &Series) {
        let (rows, found_rows) = (reference.data().nrows(), candidate.data().nrows());
        let mut scales: HashMap<(&str, &str), f64> = HashMap::new();
        for (column, values) in reference.columns().iter().zip(reference.data().columns()) {
            let scale = scales.entry((vector_stem(&column.name), &column.unit)).or_default();
            *scale = values.iter().fold(*scale, larger_finite);
        }
        let label = |row: usize| row_label(reference, row);
        let compared = self.tolerances.rows.map_or(rows, |first| rows.min(first));
        let absent = self.absent_groups(candidate.columns().iter().map(|c| c.name.as_str()));
        let unloaded = unloaded::unloaded_rows(reference);
        let mut left_out = false;
        for (position, column) in reference.columns().iter().enumerate() {
            let (name, unit) = (column.name.as_str(), column.unit.as_str());
            let Some(tolerance) = self.open(name, unit) else {
                continue;
            };
            let index = self.channels.len() - 1;
            let found = candidate.columns().iter().position(|other| other.name == name);
            if found.is_none() && self.is_unclaimed(name, &absent) {
                continue;
            }
            let kind = match found.map(|found| &candidate.columns()[found].unit) {
                None => Some(DivergenceKind::MissingChannel),
                Some(other) if other != unit => {
                    Some(DivergenceKind::Unit { reference: unit.into(), candidate: other.clone() })
                }
                Some(_) => None,
            };
            if let Some(kind) = kind {
                self.unequal(index, (0, position), String::new(), kind);
                continue;
            }
            let scale = scales[&(vector_stem(name), unit)];
            let values = candidate.column(name).expect("the column was found above");
            for (row, (&expected, &value)) in
                reference.data().column(position).iter().zip(values).take(compared).enumerate()
            {
                let order = (row + 1, position);
                let is_idle = unloaded.as_ref().is_some_and(|rows| rows[row]);
                if is_idle && unloaded::is_place(name) && is_arbitrary(tolerance, expected, value) {
                    left_out = true;
                    continue;
                }
                self.real(index, order, &|| label(row), expected, value, (tolerance, scale));
            }
            let is_cut = self.tolerances.rows.is_some() && found_rows >= compared;
            if rows != found_rows && !is_cut {
                let shorter = rows.min(found_rows);
                let kind = DivergenceKind::Length { reference: rows, candidate: found_rows };
                self.unequal(index, (shorter + 1, position), format!("row {}", shorter + 1), kind);
            }
        }
        if left_out {
            self.leave_out(unloaded::NOTE);
        }
        for column in candidate.columns() {
            if reference.column(&column.name).is_none() {
                self.only_in_candidate.push(format!("{}: {}", self.file, column.name));
            }
        }
    }

    pub fn trees(&mut self, reference: &[Leaf], candidate: &[Leaf]) {
        let found: HashMap<&str, &Leaf> =
            candidate.iter().map(|leaf| (leaf.path.as_str(), leaf)).collect();
        let mut scales: HashMap<(&str, &str), f64> = HashMap::new();
        for leaf in reference {
            if let Some(value) = leaf.value.as_real() {
                let scale = scales.entry((vector_stem(&leaf.channel), &leaf.unit)).or_default();
                *scale = larger_finite(*scale, &value);
            }
        }
        let places = unloaded::unloaded_places(reference);
        let absent = self.absent_groups(candidate.iter().map(|leaf| leaf.channel.as_str()));
        let mut left_out = false;
        // Channel → its number in `self.channels` and its tolerance, `None` if it is not compared.
        let mut opened: BTreeMap<&str, Option<(usize, Tolerance)>> = BTreeMap::new();
        for (position, leaf) in reference.iter().enumerate() {
            let channel = leaf.channel.as_str();
            if !opened.contains_key(channel) {
                let tolerance = self.open(channel, &leaf.unit);
                opened.insert(channel, tolerance.map(|t| (self.channels.len() - 1, t)));
            }
            let Some((index, tolerance)) = opened[channel] else {
                continue;
            };
            let order = (position + 1, 0);
            let place = || tree_label(&leaf.path);
            let Some(other) = found.get(leaf.path.as_str()) else {
                if is_default_of_key(channel) {
                    self.leave_out(&format!(
                        "{channel}, default of a key that the candidate's scene sets"
                    ));
                    continue;
                }
                if self.is_unclaimed(channel, &absent) {
                    continue;
                }
                self.unequal(index, order, place(), DivergenceKind::MissingChannel);
                continue;
            };
            if let Some(kind) = self.unlike(leaf, other) {
                self.channels[index].checked += 1;
                self.unequal(index, order, place(), kind);
                continue;
            }
            match (&leaf.value, other.value.as_real()) {
                (LeafValue::Real(expected), Some(value))
                    if places.contains(leaf.path.as_str())
                        && is_arbitrary(tolerance, *expected, value) =>
                {
                    left_out = true;
                }
                (LeafValue::Real(expected), Some(value)) => {
                    let scale = scales[&(vector_stem(channel), leaf.unit.as_str())];
                    self.real(index, order, &place, *expected, value, (tolerance, scale));
                }
                _ => self.channels[index].checked += 1,
            }
        }
        if left_out {
            self.leave_out(unloaded::NOTE);
        }
        self.further_leaves(reference, candidate, &opened);
    }

    /// Difference other than a numerical one: unit, kind of value, string, integer.
    fn unlike(&self, reference: &Leaf, candidate: &Leaf) -> Option<DivergenceKind> {
        if reference.unit != candidate.unit {
            let (reference, candidate) = (reference.unit.clone(), candidate.unit.clone());
            return Some(DivergenceKind::Unit { reference, candidate });
        }
        let same = match (&reference.value, &candidate.value) {
            (LeafValue::Real(_), other) => other.as_real().is_some(),
            (LeafValue::Integer(expected), LeafValue::Real(value)) => *expected as f64 == *value,
            (expected, value) => expected == value,
        };
        (!same).then(|| DivergenceKind::Exact {
            reference: reference.value.to_string(),
            candidate: candidate.value.to_string(),
        })
    }

    /// A list that is longer in the candidate is a difference; an additional channel is only listed.
    fn further_leaves(
        &mut self,
        reference: &[Leaf],
        candidate: &[Leaf],
        opened: &BTreeMap<&str, Option<(usize, Tolerance)>>,
    ) {
        let known: HashSet<&str> = reference.iter().map(|leaf| leaf.path.as_str()).collect();
        let mut listed = HashSet::new();
        for leaf in candidate.iter().filter(|leaf| !known.contains(leaf.path.as_str())) {
            match opened.get(leaf.channel.as_str()) {
                Some(Some((index, _))) if !self.tolerances.partial => {
                    let order = (reference.len() + 1, 0);
                    let kind = DivergenceKind::OnlyInCandidate;
                    self.unequal(*index, order, tree_label(&leaf.path), kind);
                }
                Some(_) => {}
                None if listed.insert(leaf.channel.as_str()) => {
                    self.only_in_candidate.push(format!("{}: {}", self.file, leaf.channel));
                }
                None => {}
            }
        }
    }
}

/// Returns whether any finite value passes because the program was free to choose it; never for exact tolerances.
fn is_arbitrary(tolerance: Tolerance, reference: f64, candidate: f64) -> bool {
    !tolerance.is_exact() && reference.is_finite() && candidate.is_finite()
}

fn larger_finite(largest: f64, value: &f64) -> f64 {
    match value.is_finite() {
        true => largest.max(value.abs()),
        false => largest,
    }
}

/// `row 3 (time = 0.2 s, ball 3)`.
fn row_label(series: &Series, row: usize) -> String {
    let mut known = Vec::new();
    for column in series.columns() {
        let value = || series.column(&column.name).map_or(f64::NAN, |values| values[row]);
        match column.name.as_str() {
            "time" => known.push(format!("time = {} {}", value(), column.unit)),
            "ball" | "element" | "node" => known.push(format!("{} {}", column.name, value())),
            _ => {}
        }
    }
    match known.is_empty() {
        true => format!("row {}", row + 1),
        false => format!("row {} ({})", row + 1, known.join(", ")),
    }
}

/// `balls[2].inner.load (ball 3)`.
fn tree_label(path: &str) -> String {
    let ball = path
        .strip_prefix("balls[")
        .and_then(|rest| rest.split_once(']'))
        .and_then(|(index, _)| index.parse::<usize>().ok());
    match ball {
        Some(index) => format!("{path} (ball {})", index + 1),
        None => path.to_string(),
    }
}
