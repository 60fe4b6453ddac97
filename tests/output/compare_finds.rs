//! `compare` finds what is different and names it, and passes what is not.

#[allow(dead_code)]
use crate::output_common;

use bearing_dynamics::output::compare::tolerance::{GivenTolerance, ToleranceClass, Tolerances};
use bearing_dynamics::output::compare::{
    CompareError, Comparison, DivergenceKind, Options, compare, is_ignored_by_name, report, to_json,
};
use bearing_dynamics::output::npy::{self, NpyError};
use bearing_dynamics::output::results::write_static_results;
use bearing_dynamics::output::series::Series;
use output_common::{run, solution};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Beyond any tolerance of any channel here.
const GROSS: f64 = 1e30;
const CLASSES: [ToleranceClass; 2] = [ToleranceClass::F64Reordered, ToleranceClass::Mixed];

/// Two identical results folders.
fn pair() -> (TempDir, PathBuf, PathBuf) {
    let root = tempfile::tempdir().unwrap();
    let [reference, candidate] = ["reference", "candidate"].map(|name| root.path().join(name));
    for folder in [&reference, &candidate] {
        write_static_results(folder, &solution(), &run()).unwrap();
    }
    (root, reference, candidate)
}

fn with_class(class: ToleranceClass) -> Options {
    Options { default_class: Some(class), ..Options::default() }
}

fn compared(reference: &Path, candidate: &Path, class: ToleranceClass) -> Comparison {
    compare(reference, candidate, &with_class(class)).unwrap()
}

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// JSON pointers of all leaves; a quantity's value is a leaf, its unit another.
fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(key, item)| pointers(item, &format!("{at}/{key}"), found));
        }
        Value::Array(items) => {
            items
                .iter()
                .enumerate()
                .for_each(|(i, item)| pointers(item, &format!("{at}/{i}"), found));
        }
        _ => found.push(at.to_string()),
    }
}

/// `/balls/2/inner/load/value` → `balls[2].inner.load`.
fn path_of(pointer: &str) -> String {
    let pointer =
        pointer.strip_suffix("/value").or(pointer.strip_suffix("/unit")).unwrap_or(pointer);
    let mut path = String::new();
    for part in pointer.split('/').skip(1) {
        match part.parse::<usize>() {
            Ok(index) => path += &format!("[{index}]"),
            Err(_) if path.is_empty() => path += part,
            Err(_) => path += &format!(".{part}"),
        }
    }
    path
}

/// What is allowed at a place, as the comparison says when it is handed a gross error there.
fn allowed_at(comparison: &Comparison) -> f64 {
    match comparison.first_divergence.as_ref().unwrap().kind {
        DivergenceKind::Value { allowed, .. } => allowed,
        ref other => panic!("expected a difference in value, got {other:?}"),
    }
}

/// The load of both contacts of the ball of a row, and of a path in the summary.
fn carries_nothing(series: &Series, row: usize) -> bool {
    series.column("inner_load").unwrap()[row] == 0.0
        && series.column("outer_load").unwrap()[row] == 0.0
}

/// Whether a column or a path says only where a ball is.
fn says_where(name: &str) -> bool {
    ["position", "approach", "contact_angle"].iter().any(|part| name.contains(part))
}

#[test]
fn identical_folders_are_equal_in_every_class() {
    let (_root, reference, candidate) = pair();
    for class in [CLASSES[0], CLASSES[1], ToleranceClass::F64Exact] {
        let result = compared(&reference, &candidate, class);
        assert!(result.equal, "{}", report(&result));
        assert!(result.first_divergence.is_none());
        // 24 columns × 8 balls, less the place of 5 balls, twice; a summary of more than 200 values.
        assert!(result.checked > 2 * (24 * 8 - 7 * 5) + 200, "only {} values", result.checked);
        assert!(report(&result).starts_with("equal: "));
    }
}

#[test]
fn every_cell_of_the_series_is_watched_in_csv_and_npy() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let mut left_out = 0;
    for class in CLASSES {
        for name in ["series.csv", "series.npy"] {
            let (expected, given) = (reference.join(name), candidate.join(name));
            for ((row, column), &value) in series.data().indexed_iter() {
                let check = |changed: f64| {
                    let mut data = series.data().clone();
                    data[(row, column)] = changed;
                    match name {
                        "series.csv" => {
                            let altered = Series::new(series.columns().to_vec(), data).unwrap();
                            fs::write(&given, altered.to_csv().unwrap()).unwrap();
                        }
                        _ => ndarray_npy::write_npy(&given, &data).unwrap(),
                    }
                    compared(&expected, &given, class)
                };
                if carries_nothing(&series, row) && says_where(&series.columns()[column].name) {
                    assert!(check(value + GROSS).equal);
                    left_out += 1;
                    continue;
                }
                let allowed = allowed_at(&check(value + GROSS));
                let found = check(value + 10.0 * allowed);
                let first = found.first_divergence.as_ref().expect("10 × tolerance is found");
                assert!(!found.equal && found.differing == 1);
                assert_eq!(first.channel, series.columns()[column].name);
                assert_eq!(first.place, format!("row {0} (ball {0})", row + 1));
                assert!(report(&found).contains(&first.channel));
                let passed = check(value + 0.1 * allowed);
                assert!(passed.equal, "{}", report(&passed));
            }
        }
    }
    // Seven columns of five balls, in two files and two classes.
    assert_eq!(left_out, 7 * 5 * 2 * 2);
}

#[test]
fn every_leaf_of_the_summary_is_watched() {
    let (_root, reference, candidate) = pair();
    let (expected, given) = (reference.join("summary.json"), candidate.join("summary.json"));
    let summary = read_json(&expected);
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let mut leaves = Vec::new();
    pointers(&summary, "", &mut leaves);
    assert!(leaves.len() > 400);
    for class in CLASSES {
        let (mut ignored, mut left_out) = (0, 0);
        for pointer in &leaves {
            let check = |changed: Value| {
                let mut altered = summary.clone();
                *altered.pointer_mut(pointer).unwrap() = changed;
                fs::write(&given, altered.to_string()).unwrap();
                compared(&expected, &given, class)
            };
            let path = path_of(pointer);
            let changed = match summary.pointer(pointer).unwrap() {
                Value::Number(n) if n.is_f64() => {
                    let value = n.as_f64().unwrap();
                    let gross = check(json!(value + GROSS));
                    let ball = path.strip_prefix("balls[").map(|rest| rest[..1].parse().unwrap());
                    if ball.is_some_and(|ball| carries_nothing(&series, ball)) && says_where(&path)
                    {
                        assert!(gross.equal, "{}", report(&gross));
                        left_out += 1;
                        continue;
                    }
                    if is_ignored_by_name(&path) {
                        gross
                    } else {
                        let allowed = allowed_at(&gross);
                        let passed = check(json!(value + 0.1 * allowed));
                        assert!(passed.equal, "{}", report(&passed));
                        check(json!(value + 10.0 * allowed))
                    }
                }
                Value::Number(n) => check(json!(n.as_u64().unwrap() + 1)),
                Value::String(text) => check(json!(format!("{text}."))),
                Value::Bool(value) => check(json!(!value)),
                _ => check(json!("something")),
            };
            if is_ignored_by_name(&path) {
                ignored += 1;
                assert!(changed.equal, "{path} is ignored by name");
                continue;
            }
            let first = changed.first_divergence.as_ref().expect(&path);
            assert!(!changed.equal && changed.differing == 1, "{}", report(&changed));
            assert!(first.place == path || first.place.starts_with(&format!("{path} (ball ")));
            assert_eq!(first.file, "summary.json");
        }
        // version, name, threads, and value and unit of two times.
        assert_eq!(ignored, 7);
        // Seven values of five balls.
        assert_eq!(left_out, 7 * 5);
    }
}

#[test]
fn a_folder_comparison_names_file_row_and_channel_of_the_earliest_difference() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let mut data = series.data().clone();
    data[(5, 3)] += 1.0;
    data[(2, 9)] += 1.0;
    data[(2, 14)] += 1.0;
    Series::new(series.columns().to_vec(), data)
        .unwrap()
        .write_csv(&candidate.join("series.csv"))
        .unwrap();
    let result = compared(&reference, &candidate, ToleranceClass::F64Reordered);
    let first = result.first_divergence.clone().unwrap();
    assert_eq!((first.file.as_str(), first.place.as_str()), ("series.csv", "row 3 (ball 3)"));
    assert_eq!(first.channel, series.columns()[9].name);
    assert_eq!(result.differing, 3);
    let worst: Vec<_> = result.channels.iter().filter(|channel| channel.differing > 0).collect();
    assert_eq!(worst.len(), 3);
    let json = to_json(&result);
    assert_eq!(json["equal"], false);
    assert_eq!(json["first_divergence"]["place"], "row 3 (ball 3)");
    assert!(json["first_divergence"]["detail"]["allowed"].is_f64());
}

#[test]
fn nan_and_infinity_differ_even_from_themselves() {
    let root = tempfile::tempdir().unwrap();
    let [good, bad] = ["good.csv", "bad.csv"].map(|name| root.path().join(name));
    for text in ["NaN", "inf", "-inf"] {
        fs::write(&good, "time [s],load [N]\n0.0,1.0\n0.5,2.0\n").unwrap();
        fs::write(&bad, format!("time [s],load [N]\n0.0,1.0\n0.5,{text}\n")).unwrap();
        for class in [CLASSES[0], CLASSES[1], ToleranceClass::F64Exact] {
            for (reference, candidate) in [(&good, &bad), (&bad, &good), (&bad, &bad)] {
                let result = compared(reference, candidate, class);
                assert!(!result.equal);
                let first = result.first_divergence.unwrap();
                assert_eq!(first.place, "row 2 (time = 0.5 s)");
                assert_eq!(first.channel, "load");
            }
        }
    }
    // A quantity of a tree whose number became null.
    let tree = root.path().join("summary.json");
    fs::write(&tree, r#"{"load": {"value": null, "unit": "N"}}"#).unwrap();
    assert!(!compared(&tree, &tree, ToleranceClass::Mixed).equal);
}

#[test]
fn nan_in_a_npy_candidate_fails() {
    use ndarray_npy::write_npy;
    let (_root, reference, candidate) = pair();
    let mut data = Series::read_npy(&reference.join("series.npy")).unwrap().data().clone();
    data[(7, 22)] = f64::NAN;
    write_npy(candidate.join("series.npy"), &data).unwrap();
    let result = compared(&reference, &candidate, ToleranceClass::Mixed);
    let first = result.first_divergence.unwrap();
    assert_eq!((first.file.as_str(), first.place.as_str()), ("series.npy", "row 8 (ball 8)"));
}

#[test]
fn exact_means_the_same_bits() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    for (one, other) in [(0.0, -0.0), (1.0, 1.0 + f64::EPSILON), (5e-324, 0.0)] {
        fs::write(&a, format!("load [N]\n{one:?}\n")).unwrap();
        fs::write(&b, format!("load [N]\n{other:?}\n")).unwrap();
        assert!(!compared(&a, &b, ToleranceClass::F64Exact).equal);
        assert!(compared(&a, &a, ToleranceClass::F64Exact).equal);
        assert!(compared(&a, &b, ToleranceClass::F64Reordered).equal);
    }
}

#[test]
fn the_allowed_difference_is_the_documented_sum() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    // Row 2 of a channel in N: value, largest of the channel, and what may differ.
    let check = |header: &str, rows: [&str; 2], class: ToleranceClass, expected: f64| {
        fs::write(&a, format!("{header}\n{}\n{}\n", rows[0], rows[1])).unwrap();
        let changed = rows[1].replacen("2.0", "1e30", 1);
        fs::write(&b, format!("{header}\n{}\n{changed}\n", rows[0])).unwrap();
        let allowed = allowed_at(&compared(&a, &b, class));
        assert!((allowed / expected - 1.0).abs() <= 1e-12, "{allowed:e} against {expected:e}");
    };
    let [reordered, mixed] = CLASSES;
    // floor share · 100 N + relative · 2 N + share · 500 N
    check("load [N]", ["-500.0", "2.0"], reordered, 100e-10 + 2e-9 + 500e-10);
    check("load [N]", ["-500.0", "2.0"], mixed, 100e-5 + 2e-4 + 500e-5);
    // The components of a vector share the largest; other units and other names do not.
    let row = ["3.0,7.0,9.0,8.0", "2.0,-700.0,9e9,9e9"];
    // Rounding at a radius of 30 mm, whatever the size of what it leaves.
    check("approach [m]", ["3.0", "2.0"], reordered, 1e-14 + 2e-9 + 3e-10);
    check("approach [um]", ["3.0", "2.0"], reordered, 1e-8 + 2e-9 + 3e-10);
    check("approach [mm]", ["3.0", "2.0"], reordered, 1e-11 + 2e-9 + 3e-10);
    check("f_x [N],f_z [N],f_y [N m],load [N]", row, mixed, 100e-5 + 2e-4 + 700e-5);
    // No floor where the unit tells nothing.
    check("ratio [1]", ["0.0", "2.0"], mixed, 2e-4 + 2e-5);
}

#[test]
fn missing_and_further_parts_are_told_apart() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    let kind = |reference: &str, candidate: &str| {
        fs::write(&a, reference).unwrap();
        fs::write(&b, candidate).unwrap();
        let result = compared(&a, &b, ToleranceClass::Mixed);
        result.first_divergence.map(|first| (first.kind, first.place))
    };
    let two = "x [m],y [m]\n1,2\n3,4\n";
    assert_eq!(kind(two, "y [m],x [m]\n2,1\n4,3\n"), None, "order of columns does not matter");
    assert_eq!(kind(two, "x [m],y [m],z [m]\n1,2,0\n3,4,0\n"), None, "a further column");
    let missing = Some((DivergenceKind::MissingChannel, String::new()));
    assert_eq!(kind(two, "x [m]\n1\n3\n"), missing);
    let length = |candidate| DivergenceKind::Length { reference: 2, candidate };
    assert_eq!(kind(two, "x [m],y [m]\n1,2\n"), Some((length(1), "row 2".into())));
    assert_eq!(kind(two, &format!("{two}5,6\n")), Some((length(3), "row 3".into())));
    let unit = DivergenceKind::Unit { reference: "m".into(), candidate: "mm".into() };
    assert_eq!(kind(two, "x [m],y [mm]\n1,2\n3,4\n"), Some((unit, String::new())));
    // An earlier wrong value goes before the missing row.
    let Some((DivergenceKind::Value { .. }, place)) = kind(two, "x [m],y [m]\n1,3\n") else {
        panic!("a value first");
    };
    assert_eq!(place, "row 1");
}

#[test]
fn trees_of_another_shape_differ() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.json", "b.json"].map(|name| root.path().join(name));
    let kind = |reference: Value, candidate: Value| {
        fs::write(&a, reference.to_string()).unwrap();
        fs::write(&b, candidate.to_string()).unwrap();
        let result = compared(&a, &b, ToleranceClass::Mixed);
        result.first_divergence.map(|first| (first.kind, first.place))
    };
    let list = |loads: &[f64]| json!({ "loads": loads, "count": 2 });
    let shorter = kind(list(&[1.0, 2.0]), list(&[1.0]));
    assert_eq!(shorter, Some((DivergenceKind::MissingChannel, "loads[1]".into())));
    let longer = kind(list(&[1.0]), list(&[1.0, 2.0]));
    assert_eq!(longer, Some((DivergenceKind::OnlyInCandidate, "loads[1]".into())));
    assert_eq!(
        kind(json!({"a": []}), json!({"a": [1]})).unwrap().0,
        DivergenceKind::MissingChannel
    );
    assert_eq!(kind(json!({"a": 1.5}), json!({"a": 1.5, "b": 2})), None);
    assert_eq!(kind(json!({"a": 2}), json!({"a": 2.0})), None);
    for other in [json!("2"), json!(2.5), json!(null), json!({"value": 2, "unit": "N"})] {
        assert!(kind(json!({"a": 2}), json!({ "a": other })).is_some());
    }
    assert!(kind(json!({"a": {"value": 1.0, "unit": "N"}}), json!({"a": 1.0})).is_some());
}

#[test]
fn a_missing_file_is_a_difference_and_a_damaged_one_an_error() {
    let (_root, reference, candidate) = pair();
    let options = Options::default();
    for name in ["series.csv", "series.npy", "summary.json"] {
        let path = candidate.join(name);
        let bytes = fs::read(&path).unwrap();
        fs::remove_file(&path).unwrap();
        let result = compare(&reference, &candidate, &options).unwrap();
        if name == "series.npy" {
            // The same table is there as .csv.
            assert!(result.equal, "{}", report(&result));
            assert!(result.ignored.iter().any(|what| what.starts_with("series.npy: not in the")));
        } else {
            let first = result.first_divergence.as_ref().unwrap();
            assert_eq!((&first.kind, first.file.as_str()), (&DivergenceKind::MissingFile, name));
        }
        // Half of the file; a CSV is cut inside a row.
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        assert!(compare(&reference, &candidate, &options).is_err(), "half of {name}");
        fs::write(&path, b"\x00\xff\xfe").unwrap();
        assert!(compare(&reference, &candidate, &options).is_err(), "noise in {name}");
        fs::write(&path, bytes).unwrap();
    }
    // Without the .csv, or where the reference has none, the .npy is missed.
    for name in ["series.csv", "series.npy"] {
        fs::rename(candidate.join(name), candidate.join(format!("{name}.away"))).unwrap();
    }
    let result = compare(&reference, &candidate, &options).unwrap();
    assert_eq!(result.differing, 2, "{}", report(&result));
    fs::rename(candidate.join("series.csv.away"), candidate.join("series.csv")).unwrap();
    fs::rename(reference.join("series.csv"), reference.join("series.csv.away")).unwrap();
    let result = compare(&reference, &candidate, &options).unwrap();
    let first = result.first_divergence.as_ref().unwrap();
    assert_eq!((&first.kind, first.file.as_str()), (&DivergenceKind::MissingFile, "series.npy"));
    fs::rename(reference.join("series.csv.away"), reference.join("series.csv")).unwrap();
    fs::rename(candidate.join("series.npy.away"), candidate.join("series.npy")).unwrap();
    let missing = reference.join("nothing.csv");
    assert!(matches!(compare(&missing, &missing, &options), Err(CompareError::Series(_))));
    let file = reference.join("series.csv");
    assert!(matches!(compare(&reference, &file, &options), Err(CompareError::KindMismatch { .. })));
    let summary = reference.join("summary.json");
    assert!(matches!(compare(&file, &summary, &options), Err(CompareError::KindMismatch { .. })));
}

/// What holds no results on either side is no difference of results.
#[test]
fn what_holds_no_results_is_an_error_and_not_a_difference() {
    let (root, reference, candidate) = pair();
    let options = Options::default();
    let refused = |a: &Path, b: &Path| compare(a, b, &options).unwrap_err().to_string();
    let other = root.path().join("other");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("notes.txt"), "mine").unwrap();
    for (a, b) in [(&other, &candidate), (&reference, &other), (&other, &other)] {
        let message = refused(a, b);
        let expected = format!("{} is no results folder: it has no summary.json", other.display());
        assert!(message.starts_with(&expected), "{message}");
    }
    // A folder of another kind of results.
    fs::write(other.join("sweep.csv"), "x [m]\n1\n").unwrap();
    let message = refused(&reference, &other);
    let expected = "the first has series.csv, series.npy, summary.json, the second sweep.csv";
    assert!(message.contains(expected), "{message}");
    // JSON without a named value.
    for text in ["{}", "[]", "[1.0]", "null", "3", "\"text\""] {
        for folder in [&reference, &candidate] {
            let path = folder.join("summary.json");
            let before = fs::read(&path).unwrap();
            fs::write(&path, text).unwrap();
            let message = refused(&reference, &candidate);
            let expected = format!("{} holds no named values", path.display());
            assert!(message.starts_with(&expected), "{text}: {message}");
            fs::write(&path, before).unwrap();
        }
    }
    // Nothing but what is never compared.
    let [a, b] = ["a.json", "b.json"].map(|name| root.path().join(name));
    for path in [&a, &b] {
        fs::write(path, r#"{"program": {"name": "bearing", "version": "1"}, "threads": 2}"#)
            .unwrap();
    }
    assert!(refused(&a, &b).contains("a.json holds nothing to compare: only what says who"));
}

/// A part of an angle's scale: after 20 turns 1e-3 of it would pass a ball that is 4 degrees off.
#[test]
fn an_angle_that_counts_turns_has_the_scale_of_one() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    let given = GivenTolerance { scale_relative: 1e-3, floors: Vec::new() };
    let options = Options { given: Some(given), ..Options::default() };
    let turns = 6994.0;
    for (unit, degree) in [("deg", 1.0), ("rad", 1f64.to_radians())] {
        let compare_shifted = |last: f64, by: f64| {
            let header = format!("time [s],ball_1_angle [{unit}]");
            let row =
                |of: f64| format!("{header}\n0,{}\n1,{}\n", of * degree, (last + of) * degree);
            fs::write(&a, row(0.0)).unwrap();
            fs::write(&b, row(by)).unwrap();
            compare(&a, &b, &options).unwrap()
        };
        let off = compare_shifted(turns, 4.0);
        assert_eq!(off.differing, 2, "{unit}: {}", report(&off));
        let expected = 1e-3 * 360.0 * degree;
        let allowed = allowed_at(&off);
        assert!((allowed / expected - 1.0).abs() <= 1e-4, "{unit}: {allowed}");
        assert!(compare_shifted(turns, 0.3).equal);
        // A tilt keeps its own scale: 4 thousandths of 0.15 degrees are found.
        assert!(!compare_shifted(0.15, 0.0006).equal);
        assert!(compare_shifted(0.15, 0.0001).equal);
    }
    // And so does what is no angle.
    fs::write(&a, "x [m]\n6994\n").unwrap();
    fs::write(&b, "x [m]\n6998\n").unwrap();
    assert!(compare(&a, &b, &options).unwrap().equal);
}

/// Hundreds of names are no line.
#[test]
fn long_lists_of_names_are_wrapped_and_cut() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.json", "b.json"].map(|name| root.path().join(name));
    fs::write(&a, r#"{"x": 1.0, "threads": 2}"#).unwrap();
    let further: String = (0..300).map(|i| format!(r#", "channel_number_{i}": 1.0"#)).collect();
    fs::write(&b, format!(r#"{{"x": 1.0, "threads": 3{further}}}"#)).unwrap();
    let result = compared(&a, &b, ToleranceClass::Mixed);
    assert_eq!(result.only_in_candidate.len(), 300);
    let text = report(&result);
    assert!(text.contains("not compared:\n  a.json: threads\n"), "{text}");
    assert!(
        text.contains("\nonly in the candidate:\n  a.json: channel_number_0, channel_number_1, ")
    );
    assert!(text.ends_with("\n  and 280 more, in the form of --json\n"), "{text}");
    let longest = text.lines().map(str::len).max().unwrap();
    assert!(longest <= 110 && text.lines().count() <= 12, "{longest}: {text}");
}

#[test]
fn a_header_that_promises_too_much_is_refused_without_allocating() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("huge.npy");
    let nested = "(".repeat(9000);
    for shape in [
        "(1000000000000, 8)",
        "(18446744073709551615, 8)",
        "(99999999999999999999, 8)",
        // No numbers at all, and a name for each column of them.
        "(0, 4611686018427387904)",
        "(0, 100000)",
        &nested,
    ] {
        let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        while !(header.len() + 11).is_multiple_of(64) {
            header.push(' ');
        }
        header.push('\n');
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        fs::write(&path, bytes).unwrap();
        assert!(compare(&path, &path, &Options::default()).is_err());
    }
    // A header of four gigabytes.
    for version in [2, 3] {
        let mut bytes = b"\x93NUMPY".to_vec();
        bytes.extend([version, 0, 255, 255, 255, 255]);
        bytes.extend(b"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1), }\n");
        fs::write(&path, bytes).unwrap();
        let error = compare(&path, &path, &Options::default()).unwrap_err().to_string();
        assert!(error.contains("header claims 4294967295 bytes"), "{error}");
    }
}

/// Tables as NumPy writes them, to the byte but for the padding of the header.
#[test]
fn npy_is_read_in_both_orders_precisions_and_versions() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("t.npy");
    let file = |version: u8, header: &str, data: &[u8]| {
        let mut bytes = b"\x93NUMPY".to_vec();
        bytes.extend([version, 0]);
        match version {
            1 => bytes.extend((header.len() as u16).to_le_bytes()),
            _ => bytes.extend((header.len() as u32).to_le_bytes()),
        }
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        fs::write(&path, bytes).unwrap();
        Series::read_npy(&path).map(|series| series.data().clone())
    };
    let rows: [f64; 6] = [1.5, -2.0, 0.25, 1e3, 7.0, -0.5];
    let columns = [rows[0], rows[3], rows[1], rows[4], rows[2], rows[5]];
    let expected = ndarray::arr2(&[[1.5, -2.0, 0.25], [1e3, 7.0, -0.5]]);
    let bytes = |values: &[f64], of: &dyn Fn(f64) -> Vec<u8>| -> Vec<u8> {
        values.iter().flat_map(|value| of(*value)).collect()
    };
    type Code = fn(f64) -> Vec<u8>;
    let codes: [(&str, Code); 4] = [
        ("<f8", |x| x.to_le_bytes().to_vec()),
        (">f8", |x| x.to_be_bytes().to_vec()),
        ("<f4", |x| (x as f32).to_le_bytes().to_vec()),
        (">f4", |x| (x as f32).to_be_bytes().to_vec()),
    ];
    for (descr, code) in codes {
        for version in [1, 2, 3] {
            for (order, values) in [("False", &rows), ("True", &columns)] {
                let header = format!(
                    "{{'descr': '{descr}', 'fortran_order': {order}, 'shape': (2, 3), }}    \n"
                );
                assert_eq!(file(version, &header, &bytes(values, &code)).unwrap(), expected);
                let cut = bytes(&values[..5], &code);
                assert!(file(version, &header, &cut).is_err(), "{header}");
            }
        }
    }
    let header = "{\"shape\":(6,),\"fortran_order\":False,\"descr\":\"<f8\"}";
    let column = file(1, header, &bytes(&rows, &codes[0].1)).unwrap();
    assert_eq!(column, ndarray::Array2::from_shape_vec((6, 1), rows.to_vec()).unwrap());
    for wrong in [
        "{'descr': '<i8', 'fortran_order': False, 'shape': (6,)}",
        "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (6,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2, 3)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': ()}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-6,)}",
        "{'descr': '<f8', 'fortran_order': False}",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (6,)}",
        "{'descr': '<f8', 'fortran_order': No, 'shape': (6,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (6,)} more",
        "",
    ] {
        assert!(file(1, wrong, &bytes(&rows, &codes[0].1)).is_err(), "{wrong}");
    }
}

/// A small but ordinary value of each unit, put together from forces of 100 N, levers of a centimetre,
/// lengths of 0.1 mm and the like; a tolerance class takes its share of it.
#[test]
fn the_floor_of_every_unit_is_its_share_of_a_small_ordinary_value() {
    const UM: f64 = 1e-6;
    const MRAD: f64 = 1e-3;
    let length = 1e-4;
    let table = [
        ("m", length),
        ("mm", length / 1e-3),
        ("um", length / UM),
        ("N", 100.0),
        ("N m", 100.0 * 0.01),
        ("deg", 1e-3),
        ("rad", 1e-5),
        ("Pa", 1e6),
        ("MPa", 1.0),
        ("N/m", 1.0 / UM),
        ("N/rad", 1.0 / MRAD),
        ("N m/m", 1.0 / MRAD),
        ("N m/rad", 1e-3 / MRAD),
        ("N/m^1.5", 1.0 / (UM * UM.sqrt())),
        ("s", 1e-6),
        ("Hz", 1e-3),
        ("rad/s", 1e-3),
        ("m/s", 1e-3),
        ("m/s^2", 1e-3),
        ("kg", 1e-6),
        ("J", 1e-6),
        ("1", 0.0),
        ("", 0.0),
        ("furlong", 0.0),
    ];
    let root = tempfile::tempdir().unwrap();
    let [reference, candidate] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    let column = |path: &Path, unit: &str, value: f64| {
        let header = if unit.is_empty() { "x".into() } else { format!("x [{unit}]") };
        fs::write(path, format!("{header}\n0\n{value:?}\n")).unwrap();
    };
    for (unit, ordinary) in table {
        column(&reference, unit, 0.0);
        let equal = |options: &Options, value: f64| {
            column(&candidate, unit, value);
            compare(&reference, &candidate, options).unwrap().equal
        };
        let given = GivenTolerance { scale_relative: 1e-2, floors: Vec::new() };
        let given = Options { given: Some(given), ..Options::default() };
        for (options, share) in [
            (with_class(ToleranceClass::F64Reordered), 1e-10),
            (with_class(ToleranceClass::Mixed), 1e-5),
            (given, 1e-3 * 1e-2),
        ] {
            let floor = share * ordinary;
            assert!(equal(&options, 0.99 * floor), "{unit}: {floor:e}");
            assert!(!equal(&options, 1.01 * floor + 1e-300), "{unit}: {floor:e}");
        }
    }
}

#[test]
fn a_tolerance_file_beside_the_reference_decides_per_channel() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let column = series.columns().iter().position(|c| c.name == "inner_peak_pressure").unwrap();
    let mut data = series.data().clone();
    data[(6, column)] *= 1.0 + 1e-6;
    let altered = Series::new(series.columns().to_vec(), data).unwrap();
    altered.write_csv(&candidate.join("series.csv")).unwrap();
    let outcome = |text: &str| {
        fs::write(reference.join("tolerances.json"), text).unwrap();
        compare(&reference, &candidate, &Options::default())
    };
    assert!(!outcome("{}").unwrap().equal);
    assert!(outcome(r#"{"class": "mixed"}"#).unwrap().equal);
    let named = |entry: &str| format!(r#"{{"channels": {{"inner_peak_pressure": {entry}}}}}"#);
    assert!(outcome(&named(r#"{"class": "mixed"}"#)).unwrap().equal);
    assert!(outcome(&named(r#"{"relative": 2e-6}"#)).unwrap().equal);
    assert!(!outcome(&named(r#"{"relative": 5e-7}"#)).unwrap().equal);
    let ignored = outcome(&named(r#"{"class": "ignored"}"#)).unwrap();
    assert!(ignored.equal && ignored.ignored.contains(&"series.csv: inner_peak_pressure".into()));
    // The user's own choice of a default goes before the file's.
    fs::write(reference.join("tolerances.json"), r#"{"class": "mixed"}"#).unwrap();
    assert!(!compared(&reference, &candidate, ToleranceClass::F64Exact).equal);

    for refused in [
        r#"{"class": "loose"}"#,
        r#"{"class": "ignored"}"#,
        r#"{"tolerance": 1}"#,
        r#"{"channels": {"inner_peak_presure": {"class": "mixed"}}}"#,
        r#"{"channels": {"inner_load": {"relative": -1}}}"#,
        r#"{"channels": {"inner_load": {"relative": 1e-3, "class": "ignored"}}}"#,
    ] {
        assert!(matches!(outcome(refused), Err(CompareError::Tolerance(_))), "{refused}");
    }
}

#[test]
fn where_a_ball_without_load_is_shown_is_its_programs_choice() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let number = |name: &str| series.columns().iter().position(|c| c.name == name).unwrap();
    let idle = (0..8).find(|&row| carries_nothing(&series, row)).unwrap();
    let loaded = (0..8).find(|&row| !carries_nothing(&series, row)).unwrap();
    let given = candidate.join("series.csv");
    let outcome = |cells: &[(usize, &str, f64)], class: ToleranceClass| {
        let mut data = series.data().clone();
        cells.iter().for_each(|(row, name, value)| data[(*row, number(name))] = *value);
        fs::write(&given, Series::new(series.columns().to_vec(), data).unwrap().to_csv().unwrap())
            .unwrap();
        compared(&reference.join("series.csv"), &given, class)
    };
    let [reordered, _] = CLASSES;
    let elsewhere = [(idle, "position_y", 0.03), (idle, "inner_approach", -1e-6)];
    let result = outcome(&elsewhere, reordered);
    assert!(result.equal, "{}", report(&result));
    assert!(report(&result).contains("balls without load"), "{}", report(&result));
    // Not so for the same program, for a loaded ball, for what is no number, or with a load.
    assert!(!outcome(&elsewhere, ToleranceClass::F64Exact).equal);
    assert!(!outcome(&[(loaded, "position_y", 0.03)], reordered).equal);
    outcome(&[(idle, "position_y", 123.25)], reordered);
    fs::write(&given, fs::read_to_string(&given).unwrap().replace("123.25", "NaN")).unwrap();
    assert!(!compared(&reference.join("series.csv"), &given, reordered).equal);
    assert!(!outcome(&[(idle, "inner_load", 1e-3)], reordered).equal);
    // One loaded contact determines where the ball is.
    let mut data = series.data().clone();
    data[(idle, number("outer_load"))] = 0.07;
    let weighs = Series::new(series.columns().to_vec(), data.clone()).unwrap();
    fs::write(reference.join("series.csv"), weighs.to_csv().unwrap()).unwrap();
    data[(idle, number("inner_approach"))] -= 1e-6;
    fs::write(&given, Series::new(series.columns().to_vec(), data).unwrap().to_csv().unwrap())
        .unwrap();
    let result = compared(&reference.join("series.csv"), &given, reordered);
    assert_eq!(result.first_divergence.unwrap().channel, "inner_approach");
}

/// In a summary as in a table: one loaded contact determines where the ball is.
#[test]
fn a_summary_leaves_out_where_balls_without_load_are_shown_and_nothing_else() {
    let (_root, reference, candidate) = pair();
    let (expected, given) = (reference.join("summary.json"), candidate.join("summary.json"));
    let summary = read_json(&expected);
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let idle = (0..8).find(|&row| carries_nothing(&series, row)).unwrap();
    let loaded = (0..8).find(|&row| !carries_nothing(&series, row)).unwrap();
    let at = |ball: usize, what: &str| format!("/balls/{ball}/{what}/value");
    let put = |value: &Value, changes: &[(String, Value)]| {
        let mut altered = value.clone();
        for (pointer, to) in changes {
            *altered.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = to.clone();
        }
        altered
    };
    let outcome = |from: &Value, changes: &[(String, Value)], class| {
        fs::write(&expected, from.to_string()).unwrap();
        fs::write(&given, put(from, changes).to_string()).unwrap();
        compared(&expected, &given, class)
    };
    let [reordered, _] = CLASSES;
    let elsewhere = [
        (at(idle, "position/y"), json!(0.03)),
        (at(idle, "inner/approach"), json!(-1e-6)),
        (at(idle, "outer/contact_angle"), json!(12.5)),
    ];
    let result = outcome(&summary, &elsewhere, reordered);
    assert!(result.equal && report(&result).contains("balls without load"), "{}", report(&result));
    assert!(!outcome(&summary, &elsewhere, ToleranceClass::F64Exact).equal);
    assert!(!outcome(&summary, &[(at(idle, "position/y"), Value::Null)], reordered).equal);
    assert!(!outcome(&summary, &[(at(idle, "inner/load"), json!(1e-3))], reordered).equal);
    assert!(!outcome(&summary, &[(at(loaded, "position/y"), json!(0.03))], reordered).equal);
    for race in ["inner", "outer"] {
        let held = put(&summary, &[(at(idle, &format!("{race}/load")), json!(0.07))]);
        for change in &elsewhere {
            let result = outcome(&held, std::slice::from_ref(change), reordered);
            assert!(!result.equal && result.differing == 1, "{race}: {}", report(&result));
        }
    }
}

#[test]
fn npy_without_names_takes_those_of_the_reference() {
    let (_root, reference, candidate) = pair();
    fs::remove_file(candidate.join("series.columns.json")).unwrap();
    assert!(compared(&reference, &candidate, ToleranceClass::F64Exact).equal);
    let csv = reference.join("series.csv");
    let npy = candidate.join("series.npy");
    assert!(compared(&csv, &npy, ToleranceClass::F64Exact).equal);
    // f32, as a graphics processor would write it.
    let single = Series::read_npy(&npy).unwrap().data().mapv(|value| value as f32);
    ndarray_npy::write_npy(&npy, &single).unwrap();
    assert!(compared(&csv, &npy, ToleranceClass::Mixed).equal);
    assert!(!compared(&csv, &npy, ToleranceClass::F64Reordered).equal);
}

#[test]
fn tolerances_read_back_as_written() {
    let text = r#"{"class":"mixed","channels":{"a":{"class":"ignored","reason":"why"}}}"#;
    let tolerances: Tolerances = serde_json::from_str(text).unwrap();
    assert_eq!(serde_json::to_string(&tolerances).unwrap(), text);
}

#[test]
fn a_direction_is_the_same_a_turn_further() {
    let write = |name: &str, values: [f64; 3], unit: &str| {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join(name);
        let rows: String =
            values.iter().enumerate().map(|(i, value)| format!("{i},{value:?}\n")).collect();
        fs::write(&path, format!("time [s],cage_angle [{unit}]\n{rows}")).unwrap();
        (root, path)
    };
    let differing = |reference: [f64; 3], candidate: [f64; 3], unit: &str, class| {
        let (_a, reference) = write("a.csv", reference, unit);
        let (_b, candidate) = write("b.csv", candidate, unit);
        compared(&reference, &candidate, class).differing
    };
    let usual = ToleranceClass::F64Reordered;
    assert_eq!(differing([-45.0, 0.0, 180.0], [315.0, 360.0, -180.0], "deg", usual), 0);
    let tau = std::f64::consts::TAU;
    assert_eq!(differing([-1.0, 0.0, 3.0], [tau - 1.0, -tau, 3.0], "rad", usual), 0);
    // Not half a turn, not two, not in metres, and not to the bit.
    assert_eq!(differing([-45.0, 0.0, 1.0], [135.0, 720.0, 1.0], "deg", usual), 2);
    assert_eq!(differing([-45.0, 0.0, 1.0], [315.0, 0.0, 1.0], "m", usual), 1);
    let exact = ToleranceClass::F64Exact;
    assert_eq!(differing([-45.0, 0.0, 1.0], [315.0, 0.0, 1.0], "deg", exact), 1);
}

/// Rows may be many, columns not.
#[test]
fn npy_has_more_room_for_rows_than_for_columns() {
    let file = |rows: usize, columns: usize| {
        let header =
            format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(std::iter::repeat_n(0u8, 8 * rows * columns));
        npy::parse(&bytes)
    };
    let most = npy::MOST_COLUMNS;
    assert_eq!(file(most + 1, 2).unwrap().dim(), (most + 1, 2));
    assert_eq!(file(2, most).unwrap().dim(), (2, most));
    assert!(matches!(file(2, most + 1), Err(NpyError::Columns { columns }) if columns == most + 1));
}

/// Means and extremes over time of the components of one vector share a scale.
#[test]
fn extremes_over_time_share_the_scale_of_their_vector() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    for of in ["mean", "smallest", "largest", "peak_to_peak"] {
        let header = format!("inner_y.{of} [m],inner_z.{of} [m]");
        fs::write(&a, format!("{header}\n2.0,-500.0\n")).unwrap();
        fs::write(&b, format!("{header}\n1e30,-500.0\n")).unwrap();
        let allowed = allowed_at(&compared(&a, &b, CLASSES[0]));
        // Floor, relative part, and a share of the larger component.
        let expected = 1e-14 + 2e-9 + 500e-10;
        assert!((allowed / expected - 1.0).abs() <= 1e-12, "{of}: {allowed:e}");
    }
}
