//! `compare` finds what is different and names it, and passes what is not.

#[allow(dead_code)]
use crate::output_common;

use bearing_dynamics::output::compare::tolerance::ToleranceClass;
use bearing_dynamics::output::compare::{
    CompareError, Comparison, DivergenceKind, Options, compare, is_ignored_by_name, report, to_json,
};
use bearing_dynamics::output::npy;
use bearing_dynamics::output::results::write_static_results;
use bearing_dynamics::output::series::Series;
use output_common::{run, solution};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Beyond any tolerance of any channel here.
pub const GROSS: f64 = 1e30;
pub const CLASSES: [ToleranceClass; 2] = [ToleranceClass::F64Reordered, ToleranceClass::Mixed];

/// Two identical results folders.
pub fn pair() -> (TempDir, PathBuf, PathBuf) {
    let root = tempfile::tempdir().unwrap();
    let [reference, candidate] = ["reference", "candidate"].map(|name| root.path().join(name));
    for folder in [&reference, &candidate] {
        write_static_results(folder, &solution(), &run()).unwrap();
    }
    (root, reference, candidate)
}

pub fn with_class(class: ToleranceClass) -> Options {
    Options { default_class: Some(class), ..Options::default() }
}

pub fn compared(reference: &Path, candidate: &Path, class: ToleranceClass) -> Comparison {
    compare(reference, candidate, &with_class(class)).unwrap()
}

pub fn read_json(path: &Path) -> Value {
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

/// The load of both contacts of the ball of a row, and of a path in the summary.
/// What is allowed at a place, as the comparison says when it is handed a gross error there.
pub fn allowed_at(comparison: &Comparison) -> f64 {
    match comparison.first_divergence.as_ref().unwrap().kind {
        DivergenceKind::Value { allowed, .. } => allowed,
        ref other => panic!("expected a difference in value, got {other:?}"),
    }
}

pub fn carries_nothing(series: &Series, row: usize) -> bool {
    series.column("inner_load").unwrap()[row] == 0.0
        && series.column("outer_load").unwrap()[row] == 0.0
}

/// Whether a column or a path says only where a ball is, or is of its contact ellipse.
pub fn says_where(name: &str) -> bool {
    let parts = ["position", "approach", "contact_angle", "semi_m", "peak_pressure"];
    parts.iter().any(|part| name.contains(part))
}

#[test]
fn identical_folders_are_equal_in_every_class() {
    let (_root, reference, candidate) = pair();
    for class in [CLASSES[0], CLASSES[1], ToleranceClass::F64Exact] {
        let result = compared(&reference, &candidate, class);
        assert!(result.equal, "{}", report(&result));
        assert!(result.first_divergence.is_none());
        // 24 columns × 8 balls, less places and ellipses of 5 balls, twice; a summary of more than 190 values.
        assert!(result.checked > 2 * (24 * 8 - 13 * 5) + 190, "only {} values", result.checked);
        assert!(report(&result).starts_with("equal: "));
    }
}

#[test]
fn every_cell_of_the_series_is_watched_in_csv_and_npy() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let mut left_out = 0;
    for (class, name) in CLASSES.into_iter().zip(["series.csv", "series.npy"]) {
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
                    _ => fs::write(&given, npy::file(&data)).unwrap(),
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
    // Seven columns of five balls, in two files.
    assert_eq!(left_out, 13 * 5 * 2);
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
                ignored += usize::from(!path.starts_with("scene."));
                assert!(changed.equal, "{path} is ignored by name");
                continue;
            }
            let first = changed.first_divergence.as_ref().expect(&path);
            assert!(!changed.equal && changed.differing == 1, "{}", report(&changed));
            assert!(first.place == path || first.place.starts_with(&format!("{path} (ball ")));
            assert_eq!(first.file, "summary.json");
        }
        // version, name, threads, and value and unit of two times; and the scene but for its title.
        assert_eq!(ignored, 7);
        // Thirteen values of five balls.
        assert_eq!(left_out, 13 * 5);
    }
}

#[test]
fn a_folder_comparison_names_file_row_and_channel_of_the_earliest_difference() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let mut data = series.data().clone();
    data[(5, 3)] += 1.0;
    data[(2, 12)] += 1.0;
    data[(2, 14)] += 1.0;
    Series::new(series.columns().to_vec(), data)
        .unwrap()
        .write_csv(&candidate.join("series.csv"))
        .unwrap();
    let result = compared(&reference, &candidate, ToleranceClass::F64Reordered);
    let first = result.first_divergence.clone().unwrap();
    assert_eq!((first.file.as_str(), first.place.as_str()), ("series.csv", "row 3 (ball 3)"));
    assert_eq!(first.channel, series.columns()[12].name);
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
    let (_root, reference, candidate) = pair();
    let mut data = Series::read_npy(&reference.join("series.npy")).unwrap().data().clone();
    data[(7, 22)] = f64::NAN;
    fs::write(candidate.join("series.npy"), npy::file(&data)).unwrap();
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
    assert!(matches!(compare(&missing, &missing, &options), Err(CompareError::Missing { .. })));
    let file = reference.join("series.csv");
    assert!(matches!(compare(&reference, &file, &options), Err(CompareError::KindMismatch { .. })));
    let summary = reference.join("summary.json");
    assert!(matches!(compare(&file, &summary, &options), Err(CompareError::KindMismatch { .. })));
}

/// A reference that lacks a table says nothing of the candidate's, and the report says so.
#[test]
fn files_that_only_the_candidate_has_are_named() {
    let (_root, reference, candidate) = pair();
    for name in ["series.csv", "series.npy"] {
        fs::remove_file(reference.join(name)).unwrap();
    }
    let result = compare(&reference, &candidate, &Options::default()).unwrap();
    assert!(result.equal, "{}", report(&result));
    assert_eq!(result.only_in_candidate, ["series.csv: whole file"]);
    assert!(report(&result).contains("only in the candidate:\n  series.csv: whole file"));
    // Without its .csv the .npy is the table.
    fs::remove_file(candidate.join("series.csv")).unwrap();
    let result = compare(&reference, &candidate, &Options::default()).unwrap();
    assert_eq!(result.only_in_candidate, ["series.npy: whole file"]);
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
        let expected =
            format!("{} is not a results folder: it has no summary.json", other.display());
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
    assert!(refused(&a, &b).contains("a.json holds nothing to compare: only the program"));
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
    assert!(text.ends_with("\n  and 280 more, see --json\n"), "{text}");
    let longest = text.lines().map(str::len).max().unwrap();
    assert!(longest <= 110 && text.lines().count() <= 12, "{longest}: {text}");
}

/// What ParaView reads is not compared, and that is said.
#[test]
fn fields_are_not_compared_and_that_is_said() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a", "b"].map(|name| root.path().join(name));
    for folder in [&a, &b] {
        fs::create_dir(folder).unwrap();
        fs::write(folder.join("summary.json"), r#"{"x": 1.0}"#).unwrap();
    }
    let said = |a: &Path, b: &Path| {
        let result = compared(a, b, ToleranceClass::Mixed);
        assert!(result.equal);
        result.ignored
    };
    assert!(said(&a, &b).is_empty());
    fs::create_dir(a.join("fields")).unwrap();
    let not_compared = "fields: fields in .vtu files are not compared";
    assert_eq!(said(&a, &b), [format!("{not_compared}; the candidate has none")]);
    assert_eq!(said(&b, &a), [format!("{not_compared}; the reference has none")]);
    fs::create_dir(b.join("fields")).unwrap();
    assert_eq!(said(&a, &b), [not_compared]);
}
