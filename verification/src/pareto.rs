//! Run time against error: what a digit costs.
//!
//! A study times variants of the same computation (other tolerances, models, meshes) and states
//! each one's error against a reference of its own. [`run`] writes a table, a figure with the
//! front of variants that no other variant beats in both, and the study's sentences. A variant
//! beyond a stability boundary is reported as such: it is drawn, and is never on the front or in
//! a sentence.

use std::fs;
use std::path::Path;
use std::time::Instant;

use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use thiserror::Error;

use crate::case::CaseError;
use crate::report::write_atomically;

/// Measures the time of one computation by one thread: by the clock, or where it is less by the
/// processor time of the thread, as far as the system tells it, so that other processes lengthen it
/// less.
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
        // The system books processor time in ticks of up to 4 ms: rounded up, and not believed below
        // a few of them.
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
    /// What the error is, with its unit, as an axis label.
    pub error_label: &'static str,
    /// What further errors are, as heads of columns.
    pub more_errors: &'static [&'static str],
    pub run: fn(&mut ParetoContext) -> Result<(), CaseError>,
}

/// One variant: how long it took and how far off it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Variants of one series are drawn in one colour.
    pub series: String,
    pub variant: String,
    pub seconds: f64,
    /// Times it was run; the fastest counts.
    pub repeats: usize,
    /// Infinite where an unstable run did not come to its end.
    pub error: f64,
    /// As [`Study::more_errors`] names them.
    pub more_errors: Vec<f64>,
    /// Work that does not depend on the machine, where it was counted.
    pub evaluations: Option<u64>,
    pub unstable: bool,
}

impl Point {
    /// A stable variant without counted work.
    pub fn new(series: &str, variant: &str, seconds: f64, error: f64) -> Point {
        Point {
            series: series.to_string(),
            variant: variant.to_string(),
            seconds,
            repeats: 1,
            error,
            more_errors: Vec::new(),
            evaluations: None,
            unstable: false,
        }
    }

    /// The error, and after it the further ones.
    fn measure(&self, index: usize) -> f64 {
        match index.checked_sub(1) {
            None => self.error,
            Some(further) => self.more_errors.get(further).copied().unwrap_or(f64::NAN),
        }
    }
}

/// A cost below which variants of a series are unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    pub name: String,
    pub seconds: f64,
}

/// What a study records.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParetoContext {
    points: Vec<Point>,
    boundaries: Vec<Boundary>,
    series_apart: bool,
    sentences: Vec<String>,
}

impl ParetoContext {
    /// Record a variant timed by the study itself. Seconds are those of one evaluation.
    pub fn point(&mut self, series: &str, variant: &str, seconds: f64, error: f64) {
        self.points.push(Point::new(series, variant, seconds, error));
    }

    pub fn push(&mut self, point: Point) {
        self.points.push(point);
    }

    /// The series answer different questions: none of them beats another.
    pub fn keep_series_apart(&mut self) {
        self.series_apart = true;
    }

    /// For each point, whether no other of the same question beats it.
    pub fn front(&self) -> Vec<bool> {
        if !self.series_apart {
            return on_front(&self.points);
        }
        let alone = |point: &Point| {
            let rivals = self.points.iter().filter(|other| other.series == point.series);
            let rivals: Vec<Point> = rivals.cloned().collect();
            on_front(&rivals).into_iter().zip(&rivals).any(|(front, rival)| front && rival == point)
        };
        self.points.iter().map(alone).collect()
    }

    /// A vertical line in the figure.
    pub fn boundary(&mut self, name: &str, seconds: f64) {
        self.boundaries.push(Boundary { name: name.to_string(), seconds });
    }

    /// Time `compute` and record it with the error that `error` reads from its result. It is run
    /// `repeats` times (at least once) and the fastest counts: slower ones measure the machine.
    pub fn time<T>(
        &mut self,
        series: &str,
        variant: &str,
        repeats: usize,
        mut compute: impl FnMut() -> T,
        error: impl FnOnce(&T) -> f64,
    ) -> T {
        let mut timed = || {
            let start = Instant::now();
            let result = std::hint::black_box(compute());
            (start.elapsed().as_secs_f64(), result)
        };
        let (mut seconds, mut result) = timed();
        for _ in 1..repeats {
            let again = timed();
            if again.0 < seconds {
                (seconds, result) = again;
            }
        }
        let error = error(&result);
        self.push(Point { repeats: repeats.max(1), ..Point::new(series, variant, seconds, error) });
        result
    }

    /// A sentence a reader takes away.
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
    #[error(
        "{series} {variant}: {seconds} s, error {error}, further errors {more:?}; all must be there, \
         finite and not negative"
    )]
    Unusable { series: String, variant: String, seconds: f64, error: f64, more: Vec<f64> },
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
    let sound = |value: f64| value >= 0.0 && value.is_finite();
    for point in &context.points {
        let ended = point.unstable && point.error == f64::INFINITY;
        let errors = ended || sound(point.error) && point.more_errors.iter().all(|e| sound(*e));
        let complete = ended || point.more_errors.len() == study.more_errors.len();
        if !(sound(point.seconds) && errors && complete) {
            return Err(ParetoError::Unusable {
                series: point.series.clone(),
                variant: point.variant.clone(),
                seconds: point.seconds,
                error: point.error,
                more: point.more_errors.clone(),
            });
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
    text.push_str(&format!("\n\n{}\n", how_timed()));
    write_atomically(&file("md"), &text)?;
    Ok(())
}

fn how_timed() -> String {
    let load = fs::read_to_string("/proc/loadavg").ok();
    let load = load.and_then(|text| text.split(' ').next().map(String::from));
    format!(
        "One thread. A time is the least of several repetitions (column `repeats`), yet other processes of the \
         machine lengthen it, and may change which of two close variants is the cheaper one; load average at the \
         end: {}. Evaluations do not depend on the machine. A variant beyond the stability boundary is listed with \
         `stable` false.",
        load.as_deref().unwrap_or("unknown")
    )
}

/// For each point, whether it is stable and no other such point is at least as good in both and
/// better in one.
pub fn on_front(points: &[Point]) -> Vec<bool> {
    let beats = |a: &Point, b: &Point| {
        !a.unstable
            && a.seconds <= b.seconds
            && a.error <= b.error
            && (a.seconds < b.seconds || a.error < b.error)
    };
    let unbeaten = |point: &Point| !points.iter().any(|other| beats(other, point));
    points.iter().map(|point| !point.unstable && unbeaten(point)).collect()
}

/// The fastest stable point whose error of the given kind (0: the study's own, then the further
/// ones) is not above `limit`.
pub fn cheapest<'a>(
    points: impl IntoIterator<Item = &'a Point>,
    measure: usize,
    limit: f64,
) -> Option<&'a Point> {
    points
        .into_iter()
        .filter(|point| !point.unstable && point.measure(measure) <= limit)
        .min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

/// Errors that sentences name a way to.
const LIMITS: [(f64, &str); 3] = [(1e-2, "1 %"), (1e-3, "0.1 %"), (1e-4, "0.01 %")];

/// The cheapest ways to 1 %, 0.1 % and 0.01 % of `whole`; the sentence goes on after "The".
pub fn cheapest_ways<'a>(
    points: impl IntoIterator<Item = &'a Point> + Clone,
    measure: usize,
    whole: &str,
) -> String {
    let way = |limit: f64| match cheapest(points.clone(), measure, limit) {
        None => "none of these".to_string(),
        Some(point) => {
            let work = point.evaluations.map_or_else(String::new, |n| format!(", {n} evaluations"));
            let (series, variant) = (&point.series, &point.variant);
            let milliseconds = significant(1e3 * point.seconds);
            let error = point.measure(measure);
            format!("{series}, {variant} ({milliseconds} ms{work}, error {error:.1e})")
        }
    };
    // Limits that the same point serves stand together.
    let mut ways: Vec<(Vec<&str>, String)> = Vec::new();
    for (limit, percent) in LIMITS {
        let way = way(limit);
        match ways.last_mut().filter(|last| last.1 == way) {
            Some((percents, _)) => percents.push(percent),
            None => ways.push((vec![percent], way)),
        }
    }
    let said = |(percents, way): &(Vec<&str>, String)| format!("to {}: {way}", percents.join(", "));
    let said: Vec<String> = ways.iter().map(said).collect();
    format!("cheapest way, as a part of {whole}, {}.", said.join("; "))
}

/// Three digits.
fn significant(value: f64) -> String {
    let digits = if value > 0.0 { 2 - value.log10().floor() as i32 } else { 0 };
    format!("{value:.*}", digits.clamp(0, 9) as usize)
}

fn table(study: &Study, context: &ParetoContext) -> String {
    let points = &context.points;
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut text =
        format!("series,variant,seconds,repeats,evaluations,{}", quoted(study.error_label));
    for label in study.more_errors {
        text.push_str(&format!(",{}", quoted(label)));
    }
    text.push_str(",stable,on_front\n");
    for (point, front) in points.iter().zip(context.front()) {
        let Point { series, variant, seconds, repeats, error, .. } = point;
        let evaluations = point.evaluations.map_or_else(String::new, |count| count.to_string());
        let (series, variant) = (quoted(series), quoted(variant));
        text.push_str(&format!("{series},{variant},{seconds:e},{repeats},{evaluations},{error:e}"));
        for index in 0..study.more_errors.len() {
            let error = point.more_errors.get(index).copied().unwrap_or(f64::INFINITY);
            text.push_str(&format!(",{error:e}"));
        }
        text.push_str(&format!(",{},{front}\n", !point.unstable));
    }
    text
}

/// Errors below this are drawn there: a logarithmic axis has no zero.
const SMALLEST_DRAWN_ERROR: f64 = 1e-17;

/// One curve a series, in the order of its variants, over the front through all of them; beside
/// them what is unstable, and the boundaries as upright lines.
fn draw(study: &Study, context: &ParetoContext) -> Result<String, ParetoError> {
    let points = &context.points;
    // A run that did not come to its end is drawn above all others.
    let finite = points.iter().map(|point| point.error).filter(|error| error.is_finite());
    let (lowest, highest) =
        finite.fold((f64::INFINITY, SMALLEST_DRAWN_ERROR), |(l, h), e| (l.min(e), h.max(e)));
    let (lowest, highest) = (lowest.max(SMALLEST_DRAWN_ERROR).min(highest), 3.0 * highest);
    let place =
        |point: &Point| [point.seconds.max(1e-9), point.error.clamp(SMALLEST_DRAWN_ERROR, highest)];
    let mut front: Vec<[f64; 2]> = points
        .iter()
        .zip(context.front())
        .filter(|(_, front)| *front)
        .map(|(point, _)| place(point))
        .collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // Below the series, so that they stay visible where they are on it.
    let mut curves = vec![Curve::new("not beaten in both by any variant", front)];
    if context.series_apart {
        curves.clear();
    }
    for point in points.iter().filter(|point| !point.unstable) {
        match curves.iter_mut().find(|curve| curve.name == point.series) {
            Some(curve) => curve.points.push(place(point)),
            None => curves.push(Curve::new(point.series.clone(), vec![place(point)])),
        }
    }
    let unstable: Vec<[f64; 2]> = points.iter().filter(|p| p.unstable).map(place).collect();
    curves.push(Curve {
        separate: true,
        ..Curve::new("unstable (at the top: ended early)", unstable)
    });
    for Boundary { name, seconds } in &context.boundaries {
        let line = vec![[*seconds, lowest], [*seconds, highest]];
        curves.push(Curve::new(name.clone(), line));
    }
    curves.retain(|curve| !curve.points.is_empty());
    xy(&XyPlot {
        title: study.title.into(),
        x: Axis::log("time of one computation", "s"),
        y: Axis::log(study.error_label, "1"),
        style: Style::LinesAndMarkers,
        curves,
    })
    .map_err(|error| ParetoError::Drawing(error.to_string()))
}
