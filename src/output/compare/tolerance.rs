//! Tolerances of a comparison.
//!
//! allowed = absolute floor + relative · |reference| + scale relative · (largest |reference| of
//! the channel; the components of one vector share theirs). With a [`RequestedTolerance`] the scale of an angle is
//! at most one turn, because the size of an angle that counts turns is arbitrary.

use crate::scene::text::input_file;
use crate::scene::text::input_file::InputError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Size limit of `tolerances.json`, bytes; it has one line per channel.
const LARGEST_FILE: u64 = 1 << 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToleranceClass {
    /// Same bits: the same program on the same path (any thread count, resumed runs).
    F64Exact,
    /// f64 arithmetic in another order: another compiler, processor, solver or summation order.
    F64Reordered,
    /// A run by another integrator, or by other steps.
    Integrated,
    /// f32 in parts of the computation, f64 where it matters.
    Mixed,
    /// Not compared, and listed as such in the report.
    Ignored,
}

impl ToleranceClass {
    pub const ALL: [ToleranceClass; 5] = [
        ToleranceClass::F64Exact,
        ToleranceClass::F64Reordered,
        ToleranceClass::Integrated,
        ToleranceClass::Mixed,
        ToleranceClass::Ignored,
    ];

    /// Name in `tolerances.json` and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            ToleranceClass::F64Exact => "f64-exact",
            ToleranceClass::F64Reordered => "f64-reordered",
            ToleranceClass::Integrated => "integrated",
            ToleranceClass::Mixed => "mixed",
            ToleranceClass::Ignored => "ignored",
        }
    }

    pub fn from_name(name: &str) -> Option<Self> {
        ToleranceClass::ALL.into_iter().find(|class| class.name() == name)
    }

    /// Tolerance of the class for a channel of this unit; `None` for [`ToleranceClass::Ignored`].
    pub fn tolerance(self, unit: &str) -> Option<Tolerance> {
        let (relative, share) = match self {
            ToleranceClass::F64Exact => (0.0, 0.0),
            // A sum of n terms in another order differs by up to n ε of the largest term: 1e-10 for the
            // 1e6 terms of a large mesh. A quantity that follows from it through a stiff contact law
            // differs by ten times as much: 1e-9.
            ToleranceClass::F64Reordered => (1e-9, 1e-10),
            // Good integrators err by 1e-7 of a channel's scale in a run of milliseconds, and by ten times as much at
            // the onset of a contact.
            ToleranceClass::Integrated => (1e-5, 1e-6),
            // f32 has a relative precision of 6e-8; some hundred operations without cancellation stay within
            // 1e-5 of the channel's scale. The load's exponent 3/2 and a safety factor of ten give 1e-4.
            ToleranceClass::Mixed => (1e-4, 1e-5),
            ToleranceClass::Ignored => return None,
        };
        // The scale term is for values that cancel (the small component of a large vector); the floor is
        // for channels that are zero except for rounding, where the other terms vanish.
        Some(Tolerance {
            absolute_floor: share * ordinary_magnitude(unit),
            relative,
            scale_relative: share,
            // Rounding grows with an angle that counts its turns.
            largest_scale: f64::INFINITY,
        })
    }
}

/// Small but ordinary value of a quantity in a bearing; the absolute floor is a fraction of it.
/// Zero for unknown units: no floor unless `tolerances.json` has one.
fn ordinary_magnitude(unit: &str) -> f64 {
    match unit {
        // A position 30 mm from the axis is rounded by up to 7e-18 m in each operation. An approach
        // or a displacement is the small result of a few hundred of them and has an error up to 1e-14 m,
        // the floor of f64-reordered, regardless of its own size.
        "m" => 1e-4,
        "mm" => 1e-1,             // the same
        "um" => 100.0,            // the same
        "N" => 100.0,             // a ball load: a load that balances to zero keeps 1e-11 of it
        "N m" => 1.0,             // that load on a centimetre
        "deg" => 1e-3,            // a small tilt
        "rad" => 1e-5,            // about the same
        "Pa" => 1e6,              // a thousandth of a Hertz pressure
        "MPa" => 1.0,             // the same
        "N/m" => 1e6,             // one newton per micrometre
        "N/rad" | "N m/m" => 1e3, // one newton per milliradian
        "N m/rad" => 1.0,         // a millinewton-metre per milliradian
        "N/m^1.5" => 1e9,         // one newton for a micrometre of approach
        "s" => 1e-6,              // about a time step
        "Hz" | "rad/s" => 1e-3,   // far below any bearing frequency
        "m/s" | "m/s^2" => 1e-3,  // a slow vibration
        "kg" | "J" => 1e-6,       // far below a ball's mass and energy
        "1" => 1e-3,              // a small ratio: damping, slip
        _ => 0.0,
    }
}

/// One turn in units of an angle; `None` for other units.
pub fn turn(unit: &str) -> Option<f64> {
    match unit {
        "deg" => Some(360.0),
        "rad" => Some(std::f64::consts::TAU),
        _ => None,
    }
}

/// Three tolerance terms and the largest scale; the floor and the scale are in the channel's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    pub absolute_floor: f64,
    pub relative: f64,
    pub scale_relative: f64,
    pub largest_scale: f64,
}

impl Tolerance {
    /// Largest difference that passes; `scale` is the largest |reference| of the channel.
    pub fn allowed(&self, reference: f64, scale: f64) -> f64 {
        let scale = scale.min(self.largest_scale);
        self.absolute_floor + self.relative * reference.abs() + self.scale_relative * scale
    }

    /// True if all three terms are zero: then bits are compared, so that −0 and 0 differ.
    pub fn is_exact(&self) -> bool {
        self.absolute_floor == 0.0 && self.relative == 0.0 && self.scale_relative == 0.0
    }
}

/// Tolerance set by the user instead of a class.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RequestedTolerance {
    /// Fraction of the channel's scale: its largest |reference|, shared by the components of one vector; for
    /// an angle at most one turn.
    pub scale_relative: f64,
    /// Floors by unit; channels of other units have a floor for rounding.
    pub floors: Vec<(String, f64)>,
}

impl RequestedTolerance {
    pub const NAME: &'static str = "given";

    /// # Errors
    /// A negative or non-finite number.
    pub fn check(&self) -> Result<(), ToleranceError> {
        let relative = ("all", "relative", self.scale_relative);
        let floors = self.floors.iter().map(|(unit, floor)| (unit.as_str(), "absolute", *floor));
        for (channel, number, value) in std::iter::once(relative).chain(floors) {
            if !(value.is_finite() && value >= 0.0) {
                let channel = channel.to_string();
                return Err(ToleranceError::Number { channel, number, value });
            }
        }
        Ok(())
    }

    pub fn tolerance(&self, unit: &str) -> Tolerance {
        // Channels that are zero except for rounding have no scale of their own. A thousandth of this fraction
        // of a small but ordinary value is negligible and above rounding.
        let least = 1e-3 * self.scale_relative * ordinary_magnitude(unit);
        let floor =
            self.floors.iter().find(|(of, _)| of == unit).map_or(least, |(_, floor)| *floor);
        Tolerance {
            absolute_floor: floor,
            relative: 0.0,
            scale_relative: self.scale_relative,
            largest_scale: turn(unit).unwrap_or(f64::INFINITY),
        }
    }
}

/// Content of `tolerances.json`, as in a case pack.
///
/// ```json
/// {
///   "class": "f64-reordered",
///   "channels": {
///     "inner_load": { "class": "mixed" },
///     "stiffness": { "relative": 1e-6 },
///     "plan": { "class": "ignored", "reason": "worded by each program" }
///   }
/// }
/// ```
/// A name applies to the channel and everything below it (`stiffness` for `stiffness.x.y`); the
/// longest matching name decides. Array indices are omitted: `balls[].inner.load`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerances {
    /// Class of channels that are not named; `f64-reordered` by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class: Option<ToleranceClass>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub channels: BTreeMap<String, ChannelTolerance>,
    /// Channels that a program may leave out, all of a group or none: names as above, or `*` and
    /// the end or the start of a name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub groups: BTreeMap<String, Vec<String>>,
    /// Only these first rows of tables are compared: later ones depend on the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<usize>,
    /// The reference has a part of the results: further entries of its lists are no difference.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub partial: bool,
}

/// A class, or numbers, or a class with some of its numbers replaced.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelTolerance {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class: Option<ToleranceClass>,
    /// In the channel's unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub absolute_floor: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale_relative: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

#[derive(Debug, Error)]
pub enum ToleranceError {
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: InputError },
    #[error("{} is not a tolerance file: {source}", path.display())]
    Json { path: PathBuf, source: serde_json::Error },
    #[error("tolerance of {channel:?}: {number} is {value}; allowed are finite numbers >= 0")]
    Number { channel: String, number: &'static str, value: f64 },
    #[error("tolerance of {channel:?} has class \"ignored\" and numbers; write one of them")]
    IgnoredWithNumbers { channel: String },
    #[error("a default class of \"ignored\" would compare nothing")]
    IgnoredByDefault,
    #[error("tolerances name {channel:?}, which is not a channel of the reference")]
    Unused { channel: String },
    #[error(
        "no compared channel has the unit {unit:?} of an absolute tolerance; \
         units are: {}", known.join(", ")
    )]
    UnusedUnit { unit: String, known: Vec<String> },
}

impl Tolerances {
    pub fn read(path: &Path) -> Result<Self, ToleranceError> {
        let bytes = input_file::read(path, LARGEST_FILE)
            .map_err(|source| ToleranceError::Read { path: path.to_path_buf(), source })?;
        let tolerances: Tolerances = serde_json::from_slice(&bytes)
            .map_err(|source| ToleranceError::Json { path: path.to_path_buf(), source })?;
        tolerances.check()?;
        Ok(tolerances)
    }

    /// # Errors
    /// A negative or non-finite number, or a combination that makes no sense.
    pub fn check(&self) -> Result<(), ToleranceError> {
        if self.class == Some(ToleranceClass::Ignored) {
            return Err(ToleranceError::IgnoredByDefault);
        }
        for (channel, given) in &self.channels {
            let numbers = [
                ("absolute_floor", given.absolute_floor),
                ("relative", given.relative),
                ("scale_relative", given.scale_relative),
            ];
            for (number, value) in numbers {
                let Some(value) = value else { continue };
                if !(value.is_finite() && value >= 0.0) {
                    return Err(ToleranceError::Number { channel: channel.clone(), number, value });
                }
                if given.class == Some(ToleranceClass::Ignored) {
                    return Err(ToleranceError::IgnoredWithNumbers { channel: channel.clone() });
                }
            }
        }
        Ok(())
    }

    /// Entry for a channel: the longest name that is the channel or a part above it.
    pub fn entry(&self, channel: &str) -> Option<(&str, &ChannelTolerance)> {
        self.channels
            .iter()
            .filter(|(name, _)| is_or_holds(name, channel))
            .max_by_key(|(name, _)| name.len())
            .map(|(name, entry)| (name.as_str(), entry))
    }

    /// The group of a channel.
    pub fn group(&self, channel: &str) -> Option<&str> {
        let fits = |name: &String| match (name.strip_prefix('*'), name.strip_suffix('*')) {
            (Some(end), _) => channel.ends_with(end),
            (None, Some(start)) => channel.starts_with(start),
            (None, None) => is_or_holds(name, channel),
        };
        let mut groups = self.groups.iter();
        groups.find(|(_, names)| names.iter().any(fits)).map(|(group, _)| group.as_str())
    }

    /// Class name and tolerance of a channel; the tolerance is `None` if the channel is not compared.
    /// `default_class` (set by the user) takes precedence over the default in the file.
    pub fn of_channel(
        &self,
        channel: &str,
        unit: &str,
        default_class: Option<ToleranceClass>,
    ) -> (ToleranceClass, Option<Tolerance>) {
        let default = default_class.or(self.class).unwrap_or(ToleranceClass::F64Reordered);
        let Some((_, entry)) = self.entry(channel) else {
            return (default, default.tolerance(unit));
        };
        let class = entry.class.unwrap_or(default);
        let tolerance = class.tolerance(unit).map(|numbers| Tolerance {
            absolute_floor: entry.absolute_floor.unwrap_or(numbers.absolute_floor),
            relative: entry.relative.unwrap_or(numbers.relative),
            scale_relative: entry.scale_relative.unwrap_or(numbers.scale_relative),
            ..numbers
        });
        (class, tolerance)
    }
}

/// Returns whether a name is that of the channel or of a part above it.
fn is_or_holds(name: &str, channel: &str) -> bool {
    let rest = channel.strip_prefix(name);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}
