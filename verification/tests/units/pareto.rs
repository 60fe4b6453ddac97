//! Studies of run time against error: stopwatch, front and files.

use std::fs;

use verification::pareto::{
    ParetoContext, ParetoError, Point, Stopwatch, Study, processor_seconds, run,
};

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
fn the_front_is_that_of_all_series_or_of_each() {
    let mut context = ParetoContext::default();
    for (series, seconds, error) in [("a", 1.0, 1.0), ("a", 2.0, 2.0), ("b", 3.0, 3.0)] {
        context.push(Point::new(series, "v", seconds, error));
    }
    assert_eq!(context.front(), [true, false, false]);
    context.keep_series_apart();
    assert_eq!(context.front(), [true, false, true]);
}

#[test]
fn a_study_writes_its_files_and_refuses_nan() {
    let folder = tempfile::tempdir().unwrap();
    let study = Study {
        id: "made_up",
        title: "Made up",
        error_label: "relative error",
        more_errors: &[],
        run: |context| {
            context.push(Point::new("s", "a \"b\"", 1.0, 0.1));
            context.sentence("A sentence.");
            Ok(())
        },
    };
    run(&study, folder.path()).unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("made_up.csv").lines().nth(1), Some("\"s\",\"a \"\"b\"\"\",1e0,1,,1e-1,true"));
    assert!(read("made_up.svg").trim_end().ends_with("</svg>"));
    assert!(read("made_up.md").contains("A sentence."));
    let empty = Study { run: |_| Ok(()), ..study };
    assert!(matches!(run(&empty, folder.path()), Err(ParetoError::NoPoints)));
    let nan = Study {
        run: |context| {
            context.push(Point::new("s", "v", 1.0, f64::NAN));
            Ok(())
        },
        ..study
    };
    assert!(matches!(run(&nan, folder.path()), Err(ParetoError::Unusable(..))));
}
