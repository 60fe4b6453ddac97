//! Largest differences of results to others that are equally right, and the tolerances that follow.

use super::Fallible;
use super::solved::{Kind, Solved};
use bearing_dynamics::output::compare::tolerance::{ChannelTolerance, ToleranceClass, Tolerances};
use bearing_dynamics::output::compare::{self, Options, compare};
use bearing_dynamics::output::pack::expected;
use bearing_dynamics::output::results::pretty;
use std::collections::BTreeMap;
use std::path::Path;

/// Least tolerance of forces over the largest force, of moments over that times the largest length, and so for
/// stiffnesses: ten times the residual at which the search ends.
const OF_SEARCH: f64 = 1e-10;
/// Least tolerance of tilts, deg: what a moment of 1e-10 of 5 kN on 50 mm turns a race on 5 kN m/rad.
const OF_TILT: f64 = 3e-10;
/// Least tolerance of the positions of balls with shafts and solids, m.
const OF_BALLS: f64 = 1e-8;
/// Least tolerances of damping ratios and of directions of whirl: what eigenvalues and vectors of other solvers have.
const OF_DAMPING: f64 = 1e-8;
const OF_DIRECTION: f64 = 1e-3;
/// A relative tolerance is written where it is at most this many times the share of the scale that would do: then it
/// is tighter for the small values of a list, and not much wider for the large ones.
const RELATIVE_UP_TO: f64 = 3.0;
/// A channel is left out if its tolerance would be more than this share of its scale: half a value says nothing.
const WIDEST: f64 = 0.5;
/// Relative tolerance of largest values over accepted steps: between the steps of another integrator a peak was up to
/// 4e-4 higher.
const BETWEEN_STEPS: f64 = 1e-3;
/// Sections of a run's summary over its window or its whole time.
const STATISTICS: [&str; 5] = ["window", "energy", "spectra", "friction", "kinematics"];
/// Least tolerance of statistics of a chaotic run over the channel's scale: what grows from rounding differs by orders
/// of magnitude from start to start.
const GROWN: f64 = 1e-4;
/// A channel this small next to the largest value of its unit is zero but for rounding; it is compared with a floor.
const NEARLY_ZERO: f64 = 1e-3;

type Channels = BTreeMap<String, ChannelTolerance>;

/// Largest differences of a channel, and their largest ratio to the tolerance of the class.
#[derive(Clone, Default)]
struct Found {
    unit: String,
    ratio: f64,
    spread: compare::Spread,
    /// Its tolerance is a share of the scale even where the class would do.
    is_share: bool,
}

/// Largest differences to other results, channel by channel.
pub struct Spread {
    class: ToleranceClass,
    kind: Kind,
    /// First rows of tables that count; `None` for all.
    pub rows: Option<usize>,
    reference: tempfile::TempDir,
    largest: BTreeMap<String, Found>,
    magnitudes: Magnitudes,
    /// Modes without rotation.
    is_at_rest: bool,
}

impl Spread {
    pub fn new(kind: Kind, class: ToleranceClass, solved: &Solved) -> Fallible<Spread> {
        let reference = tempfile::tempdir()?;
        lay(kind, solved, reference.path())?;
        let mut magnitudes = Magnitudes::default();
        for channel in compare(reference.path(), reference.path(), &Options::default())?.channels {
            // A load rating and the radii of Hertz contacts are no loads and no levers.
            let section = channel.channel.split('.').next().unwrap_or_default();
            if ["rating_life", "hertz", "geometry"].contains(&section) {
                continue;
            }
            let largest = magnitudes.0.entry(channel.unit).or_default();
            *largest = channel.spread.scale.max(*largest);
        }
        let largest = BTreeMap::new();
        let is_at_rest = solved.summary["rotor"]["speed"]["value"] == 0.0;
        Ok(Spread { class, kind, rows: None, reference, largest, magnitudes, is_at_rest })
    }

    pub fn add(&mut self, other: &Solved) -> Fallible<()> {
        let folder = tempfile::tempdir()?;
        lay(self.kind, other, folder.path())?;
        let tolerances = Tolerances {
            class: Some(self.class),
            rows: self.rows,
            partial: true,
            ..Tolerances::default()
        };
        let options = Options { tolerances: Some(tolerances), ..Options::default() };
        for channel in compare(self.reference.path(), folder.path(), &options)?.channels {
            let found = self.largest.entry(channel.channel).or_default();
            found.unit = channel.unit;
            found.ratio = channel.worst.map_or(0.0, |worst| worst.ratio).max(found.ratio);
            found.spread = found.spread.or(channel.spread);
        }
        Ok(())
    }

    /// Channels that another program cannot be expected to meet: measures of the solution process; which of several
    /// nearly equal values was the largest, which rounding decides; the last moment of a chaotic run.
    pub fn left_out(&self) -> Fallible<Channels> {
        let is_chaotic = self.rows.is_some();
        let why = |channel: &str| {
            let place = ["ball", "time", "contact_angle"];
            let last = channel.rsplit('.').next().unwrap_or_default();
            if channel.contains("residual") || channel.contains("solver") {
                Some("a measure of the solution process")
            } else if channel == "warnings" {
                Some("warnings are those of this program")
            } else if channel == "sections[].section" {
                Some("a name for readers")
            } else if channel == "rotor.whirl[].direction" && self.is_at_rest {
                Some("at rest a mode has no direction")
            } else if channel.starts_with("extremes.") && place.contains(&last)
                || channel.contains(".at.")
            {
                Some("rounding decides which of several nearly equal values is the largest")
            } else if channel.contains(".lines.")
                && ["bin_frequency", "bins_from_nearest"].contains(&last)
            {
                Some("rounding decides which of neighbouring bins is the highest")
            } else if is_chaotic && channel.contains(".peaks[].") && last.ends_with("frequency") {
                Some("rounding decides which of several peaks is the higher")
            } else if is_chaotic && channel.starts_with("final.") {
                Some("neighbouring runs part before")
            } else {
                None
            }
        };
        let all = self.channels()?.into_iter();
        Ok(all.filter_map(|(name, _)| why(&name).map(|why| (name, ignored(why.into())))).collect())
    }

    /// Tolerances of the channels that differ by more than the class allows, divided by `factor`.
    pub fn tolerances(&self, factor: f64, reason: &str) -> Channels {
        // The balls of a chaotic run are alike: what one does another may do in the next run.
        let mut of_alike: BTreeMap<String, Found> = BTreeMap::new();
        if self.rows.is_some() {
            for (channel, found) in &self.largest {
                let all = of_alike.entry(of_any_ball(channel)).or_default();
                (all.ratio, all.spread) = (all.ratio.max(found.ratio), all.spread.or(found.spread));
            }
        }
        let of = |(channel, own): (&String, &Found)| {
            let mut found = own.clone();
            if let Some(all) = of_alike.get(&of_any_ball(channel)) {
                found.ratio = all.ratio;
                found.spread = compare::Spread { scale: own.spread.scale, ..all.spread };
                let section = channel.split('.').next().unwrap_or_default();
                if STATISTICS.contains(&section) && found.spread.largest > 0.0 {
                    let least = GROWN / factor * found.spread.scale;
                    found.spread.largest = found.spread.largest.max(least);
                    found.is_share = true;
                }
            }
            Some((channel.clone(), self.tolerance(&found, factor, reason)?))
        };
        self.largest.iter().filter_map(of).collect()
    }

    /// Raises tolerances to this share: relative, and but for frequencies and matrices of several units also of the scale,
    /// so that a small component of a vector needs no more digits than the largest. Sizes and inputs keep theirs.
    pub fn add_least<'r>(
        &self,
        channels: &mut Channels,
        least: impl Fn(&str) -> (f64, &'r str),
    ) -> Fallible<()> {
        for (name, unit) in self.channels()? {
            let Some(class) = self.class.tolerance(&unit) else { continue };
            let is_matrix = name.contains("matrix");
            if is_given(&name) || unit.is_empty() && !is_matrix {
                continue;
            }
            let (least, reason) = least(&name);
            let mut own = channels.get(&name).cloned().unwrap_or_default();
            let relative = own.relative.unwrap_or(class.relative);
            let share = own.scale_relative.unwrap_or(class.scale_relative);
            let is_alone = is_matrix || ["Hz", "rad/s"].contains(&unit.as_str());
            let is_wide = relative >= least && (is_alone || share >= least);
            if own.class == Some(ToleranceClass::Ignored) || is_wide {
                continue;
            }
            if name.contains("balls[].position") || name.starts_with("position_") {
                // They are as large as the bearing.
                own.absolute_floor = Some(own.absolute_floor.unwrap_or(0.0).max(OF_BALLS));
            } else {
                own.relative = Some(relative.max(least));
                if !is_alone {
                    own.scale_relative = Some(share.max(least));
                }
            }
            let measured = own.reason.map_or(String::new(), |reason| format!("{reason}; "));
            own.reason = Some(format!("{measured}{least:e} or more for {reason}"));
            channels.insert(name, own);
        }
        Ok(())
    }

    /// Widens the tolerances of the largest values of runs, which are those of accepted steps.
    pub fn widen_extremes(&self, channels: &mut Channels) -> Fallible<()> {
        for (name, unit) in self.channels()? {
            if name.starts_with("extremes.") && self.class.tolerance(&unit).is_some() {
                let own = channels.entry(name).or_default();
                if own.class != Some(ToleranceClass::Ignored) {
                    own.relative = Some(own.relative.unwrap_or(0.0).max(BETWEEN_STEPS));
                    own.reason = Some("a peak may be between two steps".into());
                }
            }
        }
        Ok(())
    }

    fn tolerance(&self, found: &Found, factor: f64, reason: &str) -> Option<ChannelTolerance> {
        let compare::Spread { unlike, scale, largest, of_small, relative } = found.spread;
        let class = self.class.tolerance(&found.unit)?;
        if unlike > 0 {
            return Some(ignored("it differs between results that are equally right".into()));
        }
        if factor * found.ratio <= 1.0 && !found.is_share {
            return None;
        }
        let needed = factor * largest;
        let nearly_zero = NEARLY_ZERO * self.magnitudes.of(&found.unit);
        let mut own = ChannelTolerance { reason: Some(reason.into()), ..Default::default() };
        if scale <= nearly_zero && needed <= nearly_zero {
            // In a chaotic run it grows from rounding, over orders of magnitude.
            let least = if self.rows.is_some() { nearly_zero } else { class.absolute_floor };
            own.absolute_floor = Some(needed.max(least));
        } else if needed > WIDEST * scale {
            let percent = 100.0 * largest / scale;
            return Some(ignored(format!(
                "not determined: {percent:.0} % of its scale between results that are equally right"
            )));
        } else if relative * scale <= RELATIVE_UP_TO * largest && !found.is_share {
            own.relative = Some((factor * relative).max(class.relative));
            let floor = (factor * of_small).max(class.absolute_floor);
            own.absolute_floor = (floor > class.absolute_floor).then_some(floor);
        } else {
            own.scale_relative = Some((needed / scale).max(class.scale_relative));
        }
        Some(own)
    }

    /// Raises the floors of forces, moments, stiffnesses and tilts to what a search leaves.
    pub fn add_floors(&self, channels: &mut Channels) -> Fallible<()> {
        for (name, unit) in self.channels()? {
            let floor = match unit.as_str() {
                "N" | "N m" | "N/m" | "N/rad" | "N m/m" | "N m/rad" => {
                    OF_SEARCH * self.magnitudes.of(&unit)
                }
                "deg" => OF_TILT,
                _ if name.contains("damping_ratio") => OF_DAMPING,
                _ if name.contains("direction") => OF_DIRECTION,
                _ => continue,
            };
            let class = self.class.tolerance(&unit).map_or(0.0, |class| class.absolute_floor);
            let own = channels.get(&name).and_then(|own| own.absolute_floor).unwrap_or(class);
            if floor > own {
                let own = channels.entry(name).or_default();
                if own.class != Some(ToleranceClass::Ignored) {
                    own.absolute_floor = Some(floor);
                    own.reason
                        .get_or_insert_with(|| "residuals of searches and of eigenvalues".into());
                }
            }
        }
        Ok(())
    }

    /// Channels of the reference with their units.
    fn channels(&self) -> Fallible<Vec<(String, String)>> {
        let of = self.reference.path();
        let all = compare(of, of, &Options::default())?.channels.into_iter();
        Ok(all.map(|channel| (channel.channel, channel.unit)).collect())
    }
}

/// Returns whether a channel follows from sizes and inputs alone.
fn is_given(channel: &str) -> bool {
    let section = channel.split('.').next().unwrap_or_default();
    let inputs = ["time", "end", "speed", "rotor.speed"];
    ["geometry", "hertz", "frequencies", "body_inertia"].contains(&section)
        || inputs.contains(&channel)
}

/// The name of a channel with `#` for the number of a ball.
fn of_any_ball(channel: &str) -> String {
    let Some((before, after)) = channel.split_once("ball_") else { return channel.into() };
    let rest = after.trim_start_matches(|digit: char| digit.is_ascii_digit());
    match rest.len() < after.len() {
        true => format!("{before}ball_#{rest}"),
        false => channel.into(),
    }
}

fn ignored(reason: String) -> ChannelTolerance {
    ChannelTolerance {
        class: Some(ToleranceClass::Ignored),
        reason: Some(reason),
        ..ChannelTolerance::default()
    }
}

/// Largest value of each unit.
#[derive(Default)]
struct Magnitudes(BTreeMap<String, f64>);

impl Magnitudes {
    /// Largest value of this unit, or of what units of it are made of: a moment is a force on the largest length.
    fn of(&self, unit: &str) -> f64 {
        let largest = |unit: &str| self.0.get(unit).copied().unwrap_or(0.0);
        let length = largest("m").max(1e-3 * largest("mm"));
        let made = match unit {
            "N m" => largest("N") * length,
            "N/rad" | "N m/m" => largest("N/m") * length,
            "N m/rad" => largest("N/m") * length * length,
            _ => 0.0,
        };
        largest(unit).max(made)
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
