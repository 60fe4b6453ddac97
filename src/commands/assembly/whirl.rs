//! Spinning bodies in `bearing modes`: whirl at the scene's speed, critical speeds, Campbell diagram.

use super::Fallible;
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::plots::campbell;
use bearing_dynamics::output::series::{Column, Series};
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use bearing_dynamics::vibrations::critical_speeds::Critical;
use bearing_dynamics::vibrations::rotor::RotorError;
use bearing_dynamics::vibrations::small_motions::SmallMotionModel;
use bearing_dynamics::vibrations::whirl::{Campbell, Whirl};
use ndarray::Array2;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Number of speeds of the diagram, from zero.
const SPEEDS: usize = 51;
/// Ratio to the scene's speed up to which modes are in the diagram; the two lowest always are.
const FAR: f64 = 3.0;
/// Number of modes that are followed.
const LINES: usize = 8;
/// Relative difference up to which two frequencies are equal.
const EQUAL: f64 = 1e-6;
/// Smallest radial part of a mode's inertia for which it is reported. Unbalance does not excite axial modes.
const ACROSS: f64 = 0.01;

pub struct Spinning {
    pub whirling: SmallMotionModel,
    /// Whirl modes at the scene's speed.
    whirls: Vec<Whirl>,
    /// Critical speeds up to twice the scene's speed and within the listed modes, or the reason for none.
    critical: Result<Vec<Critical>, RotorError>,
    /// Highest critical speed that is listed, rad/s.
    critical_to: f64,
    campbell: Campbell,
    /// True if flexible housings take part.
    housed: bool,
}

/// Mode of a Campbell line at a row; `None` at lower speeds, where it is overdamped.
fn whirl_at(line: &[Whirl], row: usize, rows: usize) -> Option<&Whirl> {
    Some(&line[row.checked_sub(rows - line.len())?])
}

fn rpm(speed: f64) -> f64 {
    speed * 60.0 / TAU
}

fn is_whirl(whirl: &Whirl) -> bool {
    whirl.across > ACROSS
}

impl Spinning {
    /// Whirl with frequencies up to `limit`, rad/s.
    pub fn new(whirling: SmallMotionModel, housed: bool, limit: f64) -> Fallible<Spinning> {
        let top = whirling.top_speed;
        let model = &whirling.model;
        let count = if top == 0.0 { 0 } else { SPEEDS };
        let speeds: Vec<f64> = (0..count).map(|i| top * i as f64 / (SPEEDS - 1) as f64).collect();
        let mut whirls = model.whirls(top, 2 * LINES)?;
        whirls.retain(|whirl| is_whirl(whirl) && whirl.frequency() <= limit);
        whirls.truncate(LINES);
        let fastest = limit.min(2.0 * top.abs());
        let within = |of: &Critical| of.speed <= fastest && is_whirl(&of.whirl);
        let critical = whirling.critical_speeds(fastest);
        let critical = critical.map(|all| all.into_iter().filter(within).collect());
        let mut campbell = model.campbell(&speeds, LINES)?;
        // An axial and a radial mode are coupled near their crossing.
        let across = |line: &Vec<Whirl>| line.iter().filter(|whirl| is_whirl(whirl)).count();
        let listed = |line: &Vec<Whirl>| line.iter().all(|whirl| whirl.frequency() <= limit);
        campbell.lines.retain(|line| 2 * across(line) > line.len() && listed(line));
        let first = campbell.lines.len().min(2);
        let near =
            |line: &Vec<Whirl>| line.iter().any(|whirl| whirl.frequency() <= FAR * top.abs());
        let shown = campbell.lines.iter().enumerate().filter(|(i, line)| *i < first || near(line));
        campbell.lines = shown.map(|(_, line)| line.clone()).collect();
        Ok(Spinning { whirls, critical, critical_to: fastest, campbell, whirling, housed })
    }

    /// Returns whether nothing rotates; then there are no critical speeds and no Campbell diagram.
    fn at_rest(&self) -> bool {
        self.whirling.top_speed == 0.0
    }

    /// Suffix of a line for a mode that is not purely radial.
    fn kind(&self, whirl: &Whirl) -> &'static str {
        match whirl.across < 0.5 {
            true if self.housed => ", mostly along the axis or of a housing",
            true => ", mostly along the axis",
            false => "",
        }
    }

    /// Name of the place with the largest displacement of a mode.
    fn most<'s>(&'s self, whirl: &Whirl) -> &'s str {
        let size = |place: &usize| {
            let [y, z, ..] = whirl.shape[*place];
            y.norm_sqr() + z.norm_sqr()
        };
        let all = 0..whirl.shape.len();
        let most = all.max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
        let name = &self.whirling.places[most];
        name.strip_prefix("the ").unwrap_or(name)
    }

    pub fn text(&self) -> String {
        let of = self.whirling.fastest.as_deref();
        let of = of
            .map_or(String::new(), |body| format!(" of {body}, the others at a fixed ratio to it"));
        let mut text = format!(
            "\nwhirl at {:.1} rpm{of}\nmode        frequency, Hz  damping ratio  direction  moves most\n",
            rpm(self.whirling.top_speed)
        );
        for (index, whirl) in self.whirls.iter().enumerate() {
            let _ = writeln!(
                text,
                "{:>4} {:>20.6} {:>14.6}  {:<9}  {}{}",
                index + 1,
                whirl.frequency() / TAU,
                whirl.damping_ratio(),
                whirl.turns(),
                self.most(whirl),
                self.kind(whirl)
            );
        }
        if self.at_rest() {
            return text;
        }
        let _ = writeln!(
            text,
            "\ncritical speeds up to {:.1} rpm, without damping",
            rpm(self.critical_to)
        );
        match &self.critical {
            Err(why) => {
                let _ = writeln!(text, "not computed: {why}");
            }
            Ok(none) if none.is_empty() => text.push_str("none\n"),
            Ok(all) => all.iter().for_each(|of| {
                let _ = writeln!(
                    text,
                    "{:>25.3} rpm  {:<9}  {}{}",
                    rpm(of.speed),
                    of.whirl.turns(),
                    self.most(&of.whirl),
                    self.kind(&of.whirl)
                );
            }),
        }
        text
    }

    pub fn warnings(&self) -> Vec<Warning> {
        let loose = self.whirling.model.is_loose().then(|| {
            let text = "the rotor has no radial support by a bearing load or a spring, so that whirl and critical speeds are those of a free rotor: add \
                        gravity, a load or preload";
            Warning::new(WarningCode::IndeterminatePosition, text)
        });
        let grows = self.whirls.iter().filter(|whirl| whirl.damping_ratio() < -1e-9);
        let reduce = if self.at_rest() { "" } else { "the speed, the internal damping or " };
        let grows = grows.map(|whirl| {
            let text = format!(
                "the whirl of {:.3} Hz grows at {:.1} rpm: reduce {reduce}the difference between `yz` and `zy` of a spring, or add damping that does not rotate",
                whirl.frequency() / TAU,
                rpm(self.whirling.top_speed)
            );
            Warning::new(WarningCode::WhirlUnstable, text)
        });
        loose.into_iter().chain(grows).collect()
    }

    pub fn section(&self) -> Value {
        let whirl = |whirl: &Whirl| {
            json!({
                "frequency": { "value": whirl.frequency() / TAU, "unit": "Hz" },
                "damping_ratio": { "value": whirl.damping_ratio(), "unit": "1" },
                "direction": { "value": whirl.direction, "unit": "1" },
                "across": { "value": whirl.across, "unit": "1" },
                "moves_most": self.most(whirl),
            })
        };
        let critical = |of: &Critical| {
            json!({
                "speed": { "value": of.speed, "unit": "rad/s" },
                "direction": { "value": of.whirl.direction, "unit": "1" },
                "across": { "value": of.whirl.across, "unit": "1" },
                "moves_most": self.most(&of.whirl),
            })
        };
        let mut section = json!({
            "speed": { "value": self.whirling.top_speed, "unit": "rad/s" },
            "whirl": self.whirls.iter().map(whirl).collect::<Vec<_>>(),
        });
        if let Some(body) = &self.whirling.fastest {
            section["speed_of"] = json!(body);
        }
        match &self.critical {
            _ if self.at_rest() => (),
            Ok(all) => section["critical_speeds"] = all.iter().map(critical).collect(),
            Err(why) => section["no_critical_speeds"] = json!(why.to_string()),
        }
        section
    }

    pub fn write(&self, folder: &Path, title: &str) -> Fallible<Vec<PathBuf>> {
        if self.at_rest() {
            return Ok(Vec::new());
        }
        let picture = folder.join("campbell.svg");
        let critical = self.critical.iter().flatten().map(|critical| critical.speed);
        let critical: Vec<f64> = critical.collect();
        write_atomic(&picture, campbell(title, &self.campbell, &critical)?.as_bytes())?;
        let mut columns = vec![Column::new("speed", "rad/s")];
        columns.extend((1..=self.campbell.lines.len()).flat_map(|line| {
            [
                Column::new(format!("frequency_{line}"), "Hz"),
                Column::new(format!("direction_{line}"), "1"),
                Column::new(format!("damping_ratio_{line}"), "1"),
            ]
        }));
        let value = |(row, column): (usize, usize)| {
            let Some(column) = column.checked_sub(1) else { return self.campbell.speeds[row] };
            let (lines, rows) = (&self.campbell.lines, self.campbell.speeds.len());
            let Some(whirl) = whirl_at(&lines[column / 3], row, rows) else {
                return [0.0, 0.0, 1.0][column % 3];
            };
            let equals = |other: &&Whirl| {
                (other.frequency() - whirl.frequency()).abs() <= EQUAL * whirl.frequency()
            };
            // At rest two modes of one frequency have no sense of rotation.
            let is_of_pair = self.campbell.speeds[row] == 0.0
                && lines.iter().filter_map(|line| whirl_at(line, row, rows)).filter(equals).count()
                    > 1;
            let direction = if is_of_pair { 0.0 } else { whirl.direction };
            [whirl.frequency() / TAU, direction, whirl.damping_ratio()][column % 3]
        };
        let data = Array2::from_shape_fn((self.campbell.speeds.len(), columns.len()), value);
        let table = folder.join("campbell.csv");
        Series::new(columns, data)?.write_csv(&table)?;
        Ok(vec![picture, table])
    }
}
