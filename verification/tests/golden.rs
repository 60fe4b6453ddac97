//! Golden files notice any change. That they hold today is seen by `make verify`.

use std::fs;

use verification::case::Tier;
use verification::golden::{self, GoldenError, GoldenTolerance, GoldenValue, differences};
use verification::{cases, golden::GoldenFile, readme};

#[test]
fn every_golden_file_has_a_case_a_reason_and_sound_values() {
    for file in all_files() {
        assert!(cases::find(&file.case).is_some(), "no case `{}`", file.case);
        assert!(!file.values.is_empty());
        assert!(!file.history.is_empty());
        assert!(file.history.iter().all(|entry| !entry.reason.trim().is_empty()));
        golden::validate(&file.values).unwrap();
    }
}

/// Commit, compiler, version, date and reasons stand in every file, and its digest is that of what stands
/// there: nothing was edited by hand.
#[test]
fn every_golden_file_says_where_its_numbers_come_from() {
    for file in all_files() {
        assert_eq!(file.unsound(), None, "{}", file.case);
    }
}

fn all_files() -> Vec<GoldenFile> {
    let folder = golden::default_folder();
    let names = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    names
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| {
            let case = path.file_stem().unwrap().to_string_lossy().into_owned();
            golden::read(&folder, &case).unwrap().unwrap()
        })
        .collect()
}

fn value(name: &str, value: f64) -> GoldenValue {
    GoldenValue {
        name: name.into(),
        value,
        unit: "N".into(),
        tolerance: GoldenTolerance::REORDERED,
    }
}

#[test]
fn differences_name_what_moved_went_or_came() {
    let past = [value("a", 1.0), value("b", 2.0)];
    assert_eq!(differences(&past, &past), [""; 0]);
    // Within 1e-9, and beyond it.
    assert_eq!(differences(&past, &[value("a", 1.0 + 5e-10), value("b", 2.0)]), [""; 0]);
    assert_eq!(differences(&past, &[value("a", 1.0 + 5e-9), value("b", 2.0)]).len(), 1);
    assert_eq!(differences(&past, &[value("a", f64::NAN), value("b", 2.0)]).len(), 1);
    assert_eq!(differences(&past, &[value("a", 1.0)]), ["b: no longer computed"]);
    let more = [value("a", 1.0), value("b", 2.0), value("c", 3.0)];
    assert_eq!(differences(&past, &more), ["c: not in the golden file"]);
    let looser = GoldenValue { tolerance: GoldenTolerance::MIXED, ..value("a", 1.0) };
    assert_eq!(differences(&past, &[looser, value("b", 2.0)]), ["a: its tolerance changed"]);
    let other_unit = GoldenValue { unit: "kN".into(), ..value("a", 1.0) };
    assert_eq!(differences(&past, &[other_unit, value("b", 2.0)]), ["a: unit kN instead of N"]);
}

#[test]
fn files_survive_a_round_trip_and_keep_every_reason() {
    let folder = tempfile::tempdir().unwrap();
    let write =
        |values: &[GoldenValue], reason: &str| golden::write(folder.path(), "case", values, reason);
    let first = [value("third", 1.0 / 3.0), value("tiny", -4.9e-324)];
    assert!(matches!(write(&first, " \n"), Err(GoldenError::EmptyReason)));
    assert!(golden::read(folder.path(), "case").unwrap().is_none());
    assert!(write(&first, "first").unwrap());
    assert!(!write(&first, "nothing changed").unwrap());
    let second = [value("third", 0.1 + 0.2), value("tiny", 0.0)];
    assert!(write(&second, "second").unwrap());
    let file = golden::read(folder.path(), "case").unwrap().unwrap();
    for (read, written) in file.values.iter().zip(&second) {
        assert_eq!(read.value.to_bits(), written.value.to_bits());
    }
    let reasons: Vec<&str> = file.history.iter().map(|entry| entry.reason.as_str()).collect();
    assert_eq!(reasons, ["first", "second"]);
    let nan = [value("nan", f64::NAN)];
    assert!(matches!(write(&nan, "no"), Err(GoldenError::NotFinite { .. })));
    let twice = [value("a", 1.0), value("a", 1.0)];
    assert!(matches!(write(&twice, "no"), Err(GoldenError::Duplicate { .. })));
}

/// Those of the README that come from checks are of cases that `make verify` computes, where each is held.
#[test]
fn pinned_figures_of_the_readme_are_those_of_the_golden_files() {
    let figures = readme::figures(&readme::text().unwrap()).unwrap();
    assert!(figures.len() >= 10, "only {} figures", figures.len());
    let (pinned, checked): (Vec<_>, Vec<_>) = figures.iter().partition(|figure| figure.is_pinned());
    let stale: Vec<String> = pinned
        .iter()
        .filter_map(|figure| {
            let file = golden::read(&golden::default_folder(), &figure.case).unwrap();
            let file = file.ok_or_else(|| format!("no golden file of {}", figure.case));
            figure.stale(file.and_then(|file| figure.from_golden(&file)))
        })
        .collect();
    assert_eq!(stale, [""; 0]);
    for figure in checked {
        let of = cases::find(&figure.case).map(|case| case.tier);
        assert_eq!(of, Some(Tier::Smoke), "{}", figure.case);
    }
}
