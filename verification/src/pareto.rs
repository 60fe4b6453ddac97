//! Run time against error: what a digit costs.
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

/// One study of run time against error.
#[derive(Clone, Copy, Debug)]
pub struct Study {
    /// Name of its files: lower case, digits and underscores.
    pub id: &'static str,
    pub title: &'static str,
    /// What the error is, with its unit, as an axis label.
    pub error_label: &'static str,
    pub run: fn(&mut ParetoContext) -> Result<(), CaseError>,
}

/// One variant: how long it took and how far off it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Variants of one series are drawn in one colour.
    pub series: String,
    pub variant: String,
    pub seconds: f64,
    pub error: f64,
}

/// What a study records.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParetoContext {
    points: Vec<Point>,
    sentences: Vec<String>,
}

impl ParetoContext {
    /// Record a variant timed by the study itself. Seconds are those of one evaluation.
    pub fn point(&mut self, series: &str, variant: &str, seconds: f64, error: f64) {
        self.points.push(Point {
            series: series.to_string(),
            variant: variant.to_string(),
            seconds,
            error,
        });
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
        self.point(series, variant, seconds, error);
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
    #[error("{series} {variant}: {seconds} s, error {error}; both must be finite, not negative")]
    Unusable { series: String, variant: String, seconds: f64, error: f64 },
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
    for Point { series, variant, seconds, error } in &context.points {
        let sound = |value: f64| value >= 0.0 && value.is_finite();
        if !(sound(*seconds) && sound(*error)) {
            return Err(ParetoError::Unusable {
                series: series.clone(),
                variant: variant.clone(),
                seconds: *seconds,
                error: *error,
            });
        }
    }
    fs::create_dir_all(folder)?;
    let file = |extension: &str| folder.join(format!("{}.{extension}", study.id));
    write_atomically(&file("csv"), &table(study, &context.points))?;
    write_atomically(&file("svg"), &draw(study, &context.points)?)?;
    let mut text = format!("# {}\n\n![{}]({}.svg)\n", study.title, study.title, study.id);
    for sentence in &context.sentences {
        text.push_str(&format!("\n- {sentence}"));
    }
    text.push('\n');
    write_atomically(&file("md"), &text)?;
    Ok(())
}

/// For each point, whether no other point is at least as good in both and better in one.
pub fn on_front(points: &[Point]) -> Vec<bool> {
    let beats = |a: &Point, b: &Point| {
        a.seconds <= b.seconds && a.error <= b.error && (a.seconds < b.seconds || a.error < b.error)
    };
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}

fn table(study: &Study, points: &[Point]) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut text = format!("series,variant,seconds,{},on_front\n", quoted(study.error_label));
    for (point, front) in points.iter().zip(on_front(points)) {
        text.push_str(&format!(
            "{},{},{:e},{:e},{front}\n",
            quoted(&point.series),
            quoted(&point.variant),
            point.seconds,
            point.error
        ));
    }
    text
}

/// Errors below this are drawn there: a logarithmic axis has no zero.
const SMALLEST_DRAWN_ERROR: f64 = 1e-17;

/// One curve a series, in the order of its variants, and the front through all of them.
fn draw(study: &Study, points: &[Point]) -> Result<String, ParetoError> {
    let place = |point: &Point| [point.seconds.max(1e-9), point.error.max(SMALLEST_DRAWN_ERROR)];
    let mut curves: Vec<Curve> = Vec::new();
    for point in points {
        match curves.iter_mut().find(|curve| curve.name == point.series) {
            Some(curve) => curve.points.push(place(point)),
            None => curves.push(Curve::new(point.series.clone(), vec![place(point)])),
        }
    }
    let mut front: Vec<[f64; 2]> = points
        .iter()
        .zip(on_front(points))
        .filter(|(_, front)| *front)
        .map(|(point, _)| place(point))
        .collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    curves.push(Curve::new("not beaten in both by any variant", front));
    xy(&XyPlot {
        title: study.title.into(),
        x: Axis::log("time of one evaluation", "s"),
        y: Axis::log(study.error_label, "1"),
        style: Style::LinesAndMarkers,
        curves,
    })
    .map_err(|error| ParetoError::Drawing(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(seconds: f64, error: f64) -> Point {
        Point { series: "s".into(), variant: "v".into(), seconds, error }
    }

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [point(1.0, 1.0), point(2.0, 0.1), point(2.0, 0.5), point(0.5, 3.0)];
        assert_eq!(on_front(&points), [true, true, false, true]);
        // Equals do not beat each other.
        assert_eq!(on_front(&[point(1.0, 1.0), point(1.0, 1.0)]), [true, true]);
    }

    /// Trapezoidal rule on exp over [0, 1], whose integral is e − 1.
    fn quadrature(context: &mut ParetoContext) -> Result<(), CaseError> {
        for panels in [4, 16, 64] {
            let rule = || {
                let height = |k: usize| (k as f64 / panels as f64).exp();
                let inner: f64 = (1..panels).map(height).sum();
                (inner + 0.5 * (height(0) + height(panels))) / panels as f64
            };
            let exact = std::f64::consts::E - 1.0;
            context.time("trapezoid", &format!("{panels} \"panels\""), 3, rule, |value| {
                (value - exact).abs() / exact
            });
        }
        context.sentence("Four times the panels, a sixteenth of the error.");
        Ok(())
    }

    const STUDY: Study = Study {
        id: "quadrature",
        title: "Trapezoidal rule",
        error_label: "relative error",
        run: quadrature,
    };

    #[test]
    fn a_study_writes_its_table_figure_and_sentences() {
        let folder = tempfile::tempdir().unwrap();
        run(&STUDY, folder.path()).unwrap();
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        let table = read("quadrature.csv");
        assert_eq!(table.lines().count(), 4);
        let errors: Vec<f64> = table
            .lines()
            .skip(1)
            .map(|line| line.rsplit(',').nth(1).unwrap().parse().unwrap())
            .collect();
        // Second order: a factor 16 for four times the panels.
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!((ratio - 16.0).abs() <= 0.2, "ratio {ratio}");
        }
        assert!(read("quadrature.svg").trim_end().ends_with("</svg>"));
        assert!(read("quadrature.md").contains("a sixteenth"));
    }

    #[test]
    fn a_study_without_points_or_with_nan_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let empty = Study { run: |_| Ok(()), ..STUDY };
        assert!(matches!(run(&empty, folder.path()), Err(ParetoError::NoPoints)));
        let nan = Study {
            run: |context| {
                context.point("s", "v", 1.0, f64::NAN);
                Ok(())
            },
            ..STUDY
        };
        assert!(matches!(run(&nan, folder.path()), Err(ParetoError::Unusable { .. })));
    }
}
