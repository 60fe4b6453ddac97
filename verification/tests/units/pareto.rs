//! Studies of run time against error: the stopwatch, the front, the cheapest ways, the files.

use std::fs;

use verification::case::CaseError;
use verification::pareto::{
    self, ParetoContext, ParetoError, Point, Stopwatch, Study, cheapest, cheapest_ways, on_front,
    processor_seconds, run,
};

fn point(seconds: f64, error: f64) -> Point {
    Point::new("s", "v", seconds, error)
}

/// A thread that sleeps works for less time than the clock says.
#[test]
fn a_stopwatch_leaves_out_what_others_take() {
    let watch = Stopwatch::start();
    let Some(begun) = processor_seconds() else { return };
    while processor_seconds().is_some_and(|now| now < begun + 0.05) {}
    std::thread::sleep(std::time::Duration::from_millis(100));
    let seconds = watch.seconds();
    assert!((0.05..0.1).contains(&seconds), "{seconds}");
}

#[test]
fn the_front_holds_what_nothing_beats() {
    let points = [point(1.0, 1.0), point(2.0, 0.1), point(2.0, 0.5), point(0.5, 3.0)];
    assert_eq!(on_front(&points), [true, true, false, true]);
    // Equals do not beat each other.
    assert_eq!(on_front(&[point(1.0, 1.0), point(1.0, 1.0)]), [true, true]);
}

fn unstable(seconds: f64, error: f64) -> Point {
    Point { unstable: true, ..point(seconds, error) }
}

#[test]
fn what_is_unstable_is_neither_on_the_front_nor_beats_anything() {
    let points = [unstable(0.1, 1e-9), point(1.0, 1.0), unstable(0.1, f64::INFINITY)];
    assert_eq!(on_front(&points), [false, true, false]);
}

#[test]
fn series_kept_apart_do_not_beat_each_other() {
    let of =
        |series: &str, seconds, error| Point { series: series.into(), ..point(seconds, error) };
    let points = vec![of("a", 1.0, 1.0), of("a", 2.0, 2.0), of("b", 3.0, 3.0)];
    let mut context = ParetoContext::default();
    points.into_iter().for_each(|point| context.push(point));
    assert_eq!(context.front(), [true, false, false]);
    context.keep_series_apart();
    assert_eq!(context.front(), [true, false, true]);
}

#[test]
fn the_cheapest_way_is_stable_accurate_and_fast() {
    let named = |variant: &str, seconds, error, further| Point {
        variant: variant.into(),
        more_errors: vec![further],
        evaluations: Some(40),
        ..point(seconds, error)
    };
    let points = [
        named("coarse", 0.002, 0.5, 0.009),
        named("middle", 0.0123, 1e-2, 9e-4),
        named("slow middle", 0.02, 2e-3, 8e-4),
        named("fine", 0.4, 1e-3, 1e-5),
        Point { unstable: true, ..named("beyond", 0.001, 1e-6, 1e-6) },
        named("lost", 0.0001, f64::NAN, f64::NAN),
    ];
    let variant = |measure, limit| cheapest(&points, measure, limit).map(|p| &p.variant[..]);
    // An error that equals the limit keeps it.
    assert_eq!(variant(0, 1e-2), Some("middle"));
    assert_eq!(variant(0, 1e-3), Some("fine"));
    assert_eq!(variant(0, 1e-4), None);
    assert_eq!(variant(1, 1e-2), Some("coarse"));
    assert_eq!(variant(1, 1e-3), Some("middle"));
    // There is no such error.
    assert_eq!(variant(2, 1.0), None);
    assert_eq!(
        cheapest_ways(&points, 0, "the swing"),
        "cheapest way, as a part of the swing, to 1 %: s, middle (12.3 ms, 40 evaluations, error \
         1.0e-2); to 0.1 %: s, fine (400 ms, 40 evaluations, error 1.0e-3); to 0.01 %: none of \
         these."
    );
    assert_eq!(
        cheapest_ways(&points[3..4], 1, "it"),
        "cheapest way, as a part of it, to 1 %, 0.1 %, 0.01 %: s, fine (400 ms, 40 evaluations, \
         error 1.0e-5)."
    );
}

#[test]
fn boundaries_and_unstable_runs_are_drawn_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    let files = |run: fn(&mut ParetoContext) -> Result<(), CaseError>| {
        let study = Study { run, more_errors: &["of the swing"], ..STUDY };
        pareto::run(&study, folder.path())?;
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        Ok::<_, ParetoError>((read("quadrature.csv"), read("quadrature.svg")))
    };
    let (table, figure) = files(|context| {
        context.push(Point { more_errors: vec![0.5], ..point(1.0, 0.1) });
        context.push(unstable(0.5, f64::INFINITY));
        context.boundary("limit of the step", 0.7);
        Ok(())
    })
    .unwrap();
    let lines: Vec<&str> = table.lines().skip(1).collect();
    assert_eq!(
        lines,
        ["\"s\",\"v\",1e0,1,,1e-1,5e-1,true,true", "\"s\",\"v\",5e-1,1,,inf,inf,false,false"]
    );
    assert!(figure.contains("limit of the step") && figure.contains("unstable"));
    // A stable run that has no error, and one without the further error.
    for run in [
        (|context| {
            context.push(Point { more_errors: vec![0.5], ..point(1.0, f64::INFINITY) });
            Ok(())
        }) as fn(&mut ParetoContext) -> Result<(), CaseError>,
        |context| {
            context.push(point(1.0, 0.1));
            Ok(())
        },
    ] {
        assert!(matches!(files(run), Err(ParetoError::Unusable { .. })));
    }
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
    more_errors: &[],
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
        .map(|line| line.rsplit(',').nth(2).unwrap().parse().unwrap())
        .collect();
    // Second order: a factor 16 for four times the panels.
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((ratio - 16.0).abs() <= 0.2, "ratio {ratio}");
    }
    assert!(read("quadrature.svg").trim_end().ends_with("</svg>"));
    assert!(read("quadrature.md").contains("a sixteenth"));
    assert!(read("quadrature.md").contains("load average"));
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
