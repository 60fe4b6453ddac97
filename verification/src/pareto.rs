//! Run time against error.
//!
//! A study times variants of the same computation (other tolerances, models, meshes) and states
//! each one's error against a reference of its own. [`run`] writes a table, a figure with the
//! front of variants that no other variant beats in both, and the study's sentences.

use std::fs;
use std::path::Path;
use std::time::Instant;

use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use thiserror::Error;

use crate::case::CaseError;
use crate::report::write_atomically;

/// Time of one computation on one thread: the smaller of wall-clock time and, where the system reports
/// it, processor time of the thread, so that other processes lengthen it less.
pub struct Stopwatch {
    begun: Instant,
    processor: Option<f64>,
}

impl Stopwatch {
    pub fn start() -> Stopwatch {
        Stopwatch { processor: processor_seconds(), begun: Instant::now() }
    }

    /// s.
    pub fn seconds(&self) -> f64 {
        // The system counts processor time in ticks of up to 4 ms: rounded up, and ignored below five ticks.
        const TICK: f64 = 0.004;
        let clock = self.begun.elapsed().as_secs_f64();
        match (self.processor, processor_seconds()) {
            (Some(before), Some(now)) if now - before > 5.0 * TICK => {
                clock.min(now - before + TICK)
            }
            _ => clock,
        }
    }
}

/// Processor time of this thread so far, s.
pub fn processor_seconds() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split(' ').next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

/// One study of run time against error.
#[derive(Clone, Copy, Debug)]
pub struct Study {
    /// Name of its files: lower case, digits and underscores.
    pub id: &'static str,
    pub title: &'static str,
    /// Axis label of the error, with its unit.
    pub error_label: &'static str,
    /// Column heads of further errors.
    pub more_errors: &'static [&'static str],
    pub run: fn(&mut ParetoContext) -> Result<(), CaseError>,
}

/// One variant: its run time and its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Variants of one series are drawn in one colour.
    pub series: String,
    pub variant: String,
    pub seconds: f64,
    /// Number of runs; the fastest counts.
    pub repeats: usize,
    pub error: f64,
    /// In the order of [`Study::more_errors`].
    pub more_errors: Vec<f64>,
    /// Work that does not depend on the machine, where it was counted.
    pub evaluations: Option<u64>,
}

impl Point {
    /// A variant without counted work.
    pub fn new(series: &str, variant: &str, seconds: f64, error: f64) -> Point {
        Point {
            series: series.to_string(),
            variant: variant.to_string(),
            seconds,
            repeats: 1,
            error,
            more_errors: Vec::new(),
            evaluations: None,
        }
    }
}

/// Points and sentences of a study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParetoContext {
    points: Vec<Point>,
    series_apart: bool,
    sentences: Vec<String>,
}

impl ParetoContext {
    pub fn push(&mut self, point: Point) {
        self.points.push(point);
    }

    /// The series answer different questions: the front is that of each series.
    pub fn keep_series_apart(&mut self) {
        self.series_apart = true;
    }

    /// For each point, whether no comparable point is at least as good in both and better in one.
    pub fn front(&self) -> Vec<bool> {
        let beats = |a: &Point, b: &Point| {
            (!self.series_apart || a.series == b.series)
                && a.seconds <= b.seconds
                && a.error <= b.error
                && (a.seconds < b.seconds || a.error < b.error)
        };
        self.points
            .iter()
            .map(|point| !self.points.iter().any(|other| beats(other, point)))
            .collect()
    }

    /// A conclusion of the study.
    pub fn sentence(&mut self, text: impl Into<String>) {
        self.sentences.push(text.into());
    }

    pub fn points(&self) -> &[Point] {
        &self.points
    }
}

#[derive(Debug, Error)]
pub enum ParetoError {
    #[error("{0}")]
    Study(String),
    #[error("a study needs at least one point")]
    NoPoints,
    #[error("{0} {1}: time and errors must be finite and not negative")]
    Unusable(String, String),
    #[error("drawing failed: {0}")]
    Drawing(String),
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// Run a study and write `<id>.csv`, `<id>.svg` and `<id>.md` into `folder`.
pub fn run(study: &Study, folder: &Path) -> Result<(), ParetoError> {
    let mut context = ParetoContext::default();
    (study.run)(&mut context).map_err(|error| ParetoError::Study(error.to_string()))?;
    if context.points.is_empty() {
        return Err(ParetoError::NoPoints);
    }
    for point in &context.points {
        let values = [point.seconds, point.error].into_iter().chain(point.more_errors.clone());
        let sound = values.into_iter().all(|value| value >= 0.0 && value.is_finite());
        if !sound || point.more_errors.len() != study.more_errors.len() {
            return Err(ParetoError::Unusable(point.series.clone(), point.variant.clone()));
        }
    }
    fs::create_dir_all(folder)?;
    let file = |extension: &str| folder.join(format!("{}.{extension}", study.id));
    write_atomically(&file("csv"), &table(study, &context))?;
    write_atomically(&file("svg"), &draw(study, &context)?)?;
    let mut text = format!("# {}\n\n![{}]({}.svg)\n", study.title, study.title, study.id);
    for sentence in &context.sentences {
        text.push_str(&format!("\n- {sentence}"));
    }
    text.push_str(
        "\n\nOne thread. A time is the least of several runs (column `repeats`). Other processes of the machine \
         lengthen it; evaluations do not depend on the machine.\n",
    );
    write_atomically(&file("md"), &text)?;
    Ok(())
}

/// Errors for which [`cheapest_ways`] names a variant.
const LIMITS: [(f64, &str); 3] = [(1e-2, "1 %"), (1e-3, "0.1 %"), (1e-4, "0.01 %")];

/// The fastest variants with an error of at most 1 %, 0.1 % and 0.01 % of `whole`; the sentence goes on
/// after "The".
pub fn cheapest_ways(points: &[Point], whole: &str) -> String {
    let cheapest = LIMITS.map(|(limit, percent)| {
        let within = points.iter().filter(|point| point.error <= limit);
        let best = within.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let variant = best.map_or("none of these".to_string(), |point| {
            let Point { series, variant, seconds, error, .. } = point;
            format!("{series}, {variant} ({:.3e} s, error {error:.1e})", seconds)
        });
        format!("to {percent}: {variant}")
    });
    format!("cheapest variants, error relative to {whole}, {}.", cheapest.join("; "))
}

fn table(study: &Study, context: &ParetoContext) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut text =
        format!("series,variant,seconds,repeats,evaluations,{}", quoted(study.error_label));
    for label in study.more_errors {
        text.push_str(&format!(",{}", quoted(label)));
    }
    text.push_str(",on_front\n");
    for (point, front) in context.points.iter().zip(context.front()) {
        let Point { series, variant, seconds, repeats, error, .. } = point;
        let evaluations = point.evaluations.map_or_else(String::new, |count| count.to_string());
        let (series, variant) = (quoted(series), quoted(variant));
        text.push_str(&format!("{series},{variant},{seconds:e},{repeats},{evaluations},{error:e}"));
        for error in &point.more_errors {
            text.push_str(&format!(",{error:e}"));
        }
        text.push_str(&format!(",{front}\n"));
    }
    text
}

/// Errors below this are drawn there: a logarithmic axis has no zero.
const SMALLEST_DRAWN_ERROR: f64 = 1e-17;

/// One curve a series, in the order of its variants, and the front through all of them.
fn draw(study: &Study, context: &ParetoContext) -> Result<String, ParetoError> {
    let points = &context.points;
    let place = |point: &Point| [point.seconds.max(1e-9), point.error.max(SMALLEST_DRAWN_ERROR)];
    let front = points.iter().zip(context.front()).filter(|(_, front)| *front);
    let mut front: Vec<[f64; 2]> = front.map(|(point, _)| place(point)).collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // Drawn first, so that series on the front stay visible.
    let mut curves = vec![Curve::new("not beaten in both by any variant", front)];
    if context.series_apart {
        curves.clear();
    }
    for point in points {
        match curves.iter_mut().find(|curve| curve.name == point.series) {
            Some(curve) => curve.points.push(place(point)),
            None => curves.push(Curve::new(point.series.clone(), vec![place(point)])),
        }
    }
    xy(&XyPlot {
        title: study.title.into(),
        x: Axis::log("time of one computation", "s"),
        y: Axis::log(study.error_label, "1"),
        style: Style::LinesAndMarkers,
        curves,
    })
    .map_err(|error| ParetoError::Drawing(error.to_string()))
}
