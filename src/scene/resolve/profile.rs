//! Profiles in scenes: `{ ramp = ["0 N", "250 N"], duration = "0.1 s" }`.

use crate::numeric::profile::Profile;
use crate::scene::error::Problem;
use crate::scene::tables::keys::{Key, Kind, Need, Range, above, closed, nearest};
use crate::scene::text::tree::{Entry, Node, Value};
use crate::scene::text::units::Dimension;
use crate::scene::text::units::Dimension::{Angle, Frequency, Time};
use crate::scene::text::value::{ValueError, described, quantity, shown};

/// A form of a profile, recognised by its first member.
pub struct Form {
    pub doc: &'static str,
    pub example: &'static str,
    pub members: &'static [Member],
}

/// An entry of a profile.
#[derive(Clone, Copy)]
pub enum Member {
    /// A quantity of the key's own dimension; absent means 0 unless it comes first.
    Own(&'static str),
    /// Two of them: from, to.
    Pair(&'static str),
    /// A list of pairs of time and quantity.
    Points(&'static str),
    /// A quantity of another dimension.
    Other(&'static Key),
}

impl Member {
    pub fn name(&self) -> &'static str {
        match self {
            Member::Own(name) | Member::Pair(name) | Member::Points(name) => name,
            Member::Other(key) => key.path,
        }
    }
}

/// Longest time in a scene.
const TIME: Range = closed(0.0, 1e4, "s");

static START: Key = Key::new(
    "start",
    Kind::Quantity(Time, TIME),
    Need::Default { value: "0 s", reason: "" },
    "Time at which it begins.",
)
.hint("time is counted from the start of the run");
static DURATION: Key = Key::new(
    "duration",
    Kind::Quantity(Time, above(0.0, 1e4, "s")),
    Need::Required,
    "Time that it takes.",
)
.hint("a change takes time; a very short one is a step");
static FREQUENCY: Key = Key::new(
    "frequency",
    Kind::Quantity(Frequency, above(0.0, 1e7, "Hz")),
    Need::Required,
    "Periods per second.",
)
.hint("a frequency is positive; write a plain quantity for a constant");
static PHASE: Key = Key::new(
    "phase",
    Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")),
    Need::Default { value: "0 deg", reason: "" },
    "Angle at t = 0.",
);

/// Every way to write a profile, in the order of the reference.
pub static FORMS: &[Form] = &[
    Form {
        doc: "Straight line from the first to the second value; constant before and after.",
        example: r#"{ ramp = ["0 N", "250 N"], start = "0 s", duration = "0.1 s" }"#,
        members: &[Member::Pair("ramp"), Member::Other(&START), Member::Other(&DURATION)],
    },
    Form {
        doc: "The same without jumps of slope and curvature: 10 f^3 - 15 f^4 + 6 f^5.",
        example: r#"{ smooth_ramp = ["0 N", "250 N"], start = "0 s", duration = "0.1 s" }"#,
        members: &[Member::Pair("smooth_ramp"), Member::Other(&START), Member::Other(&DURATION)],
    },
    Form {
        doc: "Straight lines between points; constant before the first and after the last.",
        example: r#"{ table = [["0 s", "0 N"], ["0.1 s", "250 N"]] }"#,
        members: &[Member::Points("table")],
    },
    Form {
        doc: "mean + amplitude sin(2 pi frequency t + phase).",
        example: r#"{ amplitude = "10 N", mean = "0 N", frequency = "50 Hz", phase = "0 deg" }"#,
        members: &[
            Member::Own("amplitude"),
            Member::Own("mean"),
            Member::Other(&FREQUENCY),
            Member::Other(&PHASE),
        ],
    },
    Form {
        doc: "Half a sine wave of this height on top of `base`.",
        example: r#"{ half_sine = "500 N", base = "0 N", start = "0.01 s", duration = "5 ms" }"#,
        members: &[
            Member::Own("half_sine"),
            Member::Own("base"),
            Member::Other(&START),
            Member::Other(&DURATION),
        ],
    },
];

/// Reads the entries of a profile of `dimension` with values within `range`.
pub fn read(
    key: &'static Key,
    (dimension, range): (Dimension, Range),
    entries: &[Entry],
    offset: usize,
    in_si: bool,
) -> Result<Profile, ValueError> {
    let form = form_of(entries, offset)?;
    if let Some(stray) = entries.iter().find(|entry| member(form, &entry.name).is_none()) {
        return Err(unknown(stray, names(form)));
    }
    let reader = Reader { key, dimension, range, entries, offset, in_si };
    let profile = match form.members[0].name() {
        "ramp" => {
            let [from, to] = reader.pair("ramp")?;
            let (start, duration) = (reader.other(&START)?, reader.other(&DURATION)?);
            Profile::Ramp { from, to, start, duration }
        }
        "smooth_ramp" => {
            let [from, to] = reader.pair("smooth_ramp")?;
            let (start, duration) = (reader.other(&START)?, reader.other(&DURATION)?);
            Profile::SmoothRamp { from, to, start, duration }
        }
        "table" => Profile::Table { points: reader.points("table")? },
        "amplitude" => {
            let (mean, amplitude) = (reader.own("mean")?, reader.own("amplitude")?);
            reader.limit(["amplitude", "mean"], &[mean + amplitude, mean - amplitude])?;
            let (frequency, phase) = (reader.other(&FREQUENCY)?, reader.other(&PHASE)?);
            Profile::Harmonic { mean, amplitude, frequency, phase }
        }
        _ => {
            let (base, peak) = (reader.own("base")?, reader.own("half_sine")?);
            reader.limit(["half_sine", "base"], &[base + peak])?;
            let (start, duration) = (reader.other(&START)?, reader.other(&DURATION)?);
            Profile::HalfSine { base, peak, start, duration }
        }
    };
    Ok(profile)
}

/// Largest magnitude of a profile.
pub fn largest(profile: &Profile) -> f64 {
    match profile {
        Profile::Constant(value) => value.abs(),
        Profile::Ramp { from, to, .. } | Profile::SmoothRamp { from, to, .. } => {
            from.abs().max(to.abs())
        }
        Profile::Table { points } => points.iter().map(|point| point[1].abs()).fold(0.0, f64::max),
        Profile::Harmonic { mean, amplitude, .. } => mean.abs() + amplitude.abs(),
        Profile::HalfSine { base, peak, .. } => base.abs().max((base + peak).abs()),
    }
}

fn member(form: &'static Form, name: &str) -> Option<&'static Member> {
    form.members.iter().find(|member| member.name() == name)
}

fn names(form: &'static Form) -> Vec<&'static str> {
    form.members.iter().map(Member::name).collect()
}

fn unknown(entry: &Entry, allowed: Vec<&'static str>) -> ValueError {
    ValueError {
        offset: entry.offset,
        within: entry.name.clone(),
        problem: Problem::UnknownKey {
            nearest: nearest(&entry.name, allowed.iter().copied(), 0.5).map(str::to_string),
            allowed: allowed.join(", "),
        },
    }
}

/// The form whose first member is among the entries.
fn form_of(entries: &[Entry], offset: usize) -> Result<&'static Form, ValueError> {
    let mut found = entries.iter().filter_map(|entry| {
        let form = FORMS.iter().find(|form| form.members[0].name() == entry.name);
        form.map(|form| (entry, form))
    });
    let Some((first, form)) = found.next() else {
        let anywhere =
            |entry: &&Entry| FORMS.iter().any(|form| member(form, &entry.name).is_some());
        let heads = FORMS.iter().map(|form| form.members[0].name());
        return Err(match entries.iter().find(|entry| !anywhere(entry)) {
            Some(stray) => unknown(stray, heads.collect()),
            None => {
                let because = ": its entries name no kind of profile".to_string();
                let example =
                    heads.map(|head| format!("`{head}`")).collect::<Vec<_>>().join(" or ");
                (offset, Problem::Missing { because, example }).into()
            }
        });
    };
    match found.next() {
        None => Ok(form),
        Some((second, _)) => Err(ValueError {
            offset: second.offset,
            within: second.name.clone(),
            problem: Problem::Exclusive {
                rival: first.name.clone(),
                advice: "a profile is of one kind; keep one".to_string(),
            },
        }),
    }
}

/// A profile's entries and the range of its values.
struct Reader<'e> {
    key: &'static Key,
    dimension: Dimension,
    range: Range,
    entries: &'e [Entry],
    offset: usize,
    in_si: bool,
}

impl Reader<'_> {
    fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name)
    }

    /// A value of the key's own dimension.
    fn value(&self, name: &str, node: &Node) -> Result<f64, ValueError> {
        let at = |problem| ValueError { offset: node.offset, within: name.to_string(), problem };
        match &node.value {
            Value::Text(_) | Value::Number(_) => {
                quantity(self.key, &node.value, self.dimension, self.range, self.in_si).map_err(at)
            }
            other => {
                let expected = format!("{} with its unit", self.dimension.name());
                Err(at(wrong(expected, other)))
            }
        }
    }

    fn own(&self, name: &str) -> Result<f64, ValueError> {
        self.entry(name).map_or(Ok(0.0), |entry| self.value(name, &entry.node))
    }

    fn pair(&self, name: &str) -> Result<[f64; 2], ValueError> {
        let Some(entry) = self.entry(name) else { return Ok([0.0; 2]) };
        match &entry.node.value {
            Value::List(items) if items.len() == 2 => {
                Ok([self.value(name, &items[0])?, self.value(name, &items[1])?])
            }
            other => {
                let problem = wrong("a list of two values, from and to".to_string(), other);
                Err(ValueError { offset: entry.node.offset, within: name.to_string(), problem })
            }
        }
    }

    fn points(&self, name: &str) -> Result<Vec<[f64; 2]>, ValueError> {
        let at = |node: &Node, problem| ValueError {
            offset: node.offset,
            within: name.to_string(),
            problem,
        };
        let pairs = "a list of two or more pairs of time and value";
        let Some(entry) = self.entry(name) else { return Ok(Vec::new()) };
        let items = match &entry.node.value {
            Value::List(items) if items.len() >= 2 => items,
            other => return Err(at(&entry.node, wrong(pairs.to_string(), other))),
        };
        let mut points: Vec<[f64; 2]> = Vec::with_capacity(items.len());
        for item in items {
            let pair = match &item.value {
                Value::List(pair) if pair.len() == 2 => pair,
                other => return Err(at(item, wrong("a pair of time and value".into(), other))),
            };
            let time = match &pair[0].value {
                Value::Text(_) | Value::Number(_) => {
                    quantity(&START, &pair[0].value, Time, TIME, self.in_si)
                        .map_err(|p| at(&pair[0], p))?
                }
                other => return Err(at(&pair[0], wrong("a time with its unit".into(), other))),
            };
            if points.last().is_some_and(|last| time <= last[0]) {
                return Err(at(
                    &pair[0],
                    Problem::NotIncreasing { written: shown(&pair[0].value) },
                ));
            }
            points.push([time, self.value(name, &pair[1])?]);
        }
        Ok(points)
    }

    /// A member of another dimension: given, or its default.
    fn other(&self, key: &'static Key) -> Result<f64, ValueError> {
        let Kind::Quantity(dimension, range) = key.kind else { return Ok(0.0) };
        let at = |offset, problem| ValueError { offset, within: key.path.to_string(), problem };
        match (self.entry(key.path), key.need) {
            (Some(entry), _) => quantity(key, &entry.node.value, dimension, range, self.in_si)
                .map_err(|problem| at(entry.node.offset, problem)),
            (None, Need::Required) => {
                let example = format!("`{} = {}` to the profile", key.path, key.example());
                Err(at(self.offset, Problem::Missing { because: String::new(), example }))
            }
            (None, _) => Ok(0.0),
        }
    }

    /// Checks the largest values of the sum of two members.
    fn limit(&self, [name, other]: [&str; 2], reached: &[f64]) -> Result<(), ValueError> {
        if reached.iter().all(|value| self.range.contains(*value, Some(self.dimension))) {
            return Ok(());
        }
        let problem = Problem::OutOfRange {
            written: format!("the largest value from `{name}` and `{other}` together"),
            allowed: self.range.to_string(),
            advice: self.key.hint,
        };
        let offset = self.entry(name).map_or(self.offset, |entry| entry.node.offset);
        Err(ValueError { offset, within: name.to_string(), problem })
    }
}

fn wrong(expected: String, found: &Value) -> Problem {
    let advice = format!("profiles look like {}", FORMS[0].example);
    let found = match found {
        Value::List(items) => format!("a list of {}", items.len()),
        other => described(other),
    };
    Problem::WrongKind { expected, found, advice }
}
