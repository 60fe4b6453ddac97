//! Every number of every `published.toml` matters, and none of them reaches our side.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use verification::case::{Case, Tier};
use verification::cases;
use verification::judge::{Status, judge, widest_tolerance};
use verification::published::Published;
use verification::runner::{Run, compute};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
}

/// Every smoke case, run once for all tests of this file.
fn smoke_runs() -> &'static [(Case, Run)] {
    static RUNS: OnceLock<Vec<(Case, Run)>> = OnceLock::new();
    RUNS.get_or_init(|| {
        cases::of_tier(Tier::Smoke).into_iter().map(|case| (case, compute(&case))).collect()
    })
}

/// Bits of every check's own number, in order.
fn ours(run: &Run) -> Vec<(String, u64)> {
    run.record.ours().into_iter().map(|(id, value)| (id, value.to_bits())).collect()
}

/// The text of a `published.toml` with every number replaced.
fn rewritten(text: &str) -> String {
    let alter = |line: &str| match line.split_once('=') {
        Some((key, number)) if key.trim() == "value" => {
            let number: f64 = number.split('#').next().unwrap_or("").trim().parse().unwrap();
            format!("value = {:?}", 3.0 * number + 1.0)
        }
        _ => line.to_string(),
    };
    text.lines().map(alter).collect::<Vec<_>>().join("\n")
}

#[test]
fn altering_any_published_number_changes_the_verdict() {
    for (case, run) in smoke_runs() {
        let published = Published::parse(case.published).unwrap();
        assert_eq!(run.error, None, "{}", case.id);
        assert!(judge(&run.record, &published).holds(), "{} fails as it is", case.id);
        for entry in published.values() {
            let shift = 10.0 * widest_tolerance(&run.record, &published, &entry.id);
            let failing = |value: f64| {
                let verdict = judge(&run.record, &published.with(&entry.id, value));
                for (check, ours) in verdict.checks.iter().zip(run.record.ours()) {
                    assert_eq!(check.value.map(f64::to_bits), Some(ours.1.to_bits()));
                }
                verdict.checks.iter().any(|check| check.status == Status::Failed)
            };
            let (up, down) = (failing(entry.value + shift), failing(entry.value - shift));
            let noticed = if entry.bound.is_some() { up || down } else { up && down };
            assert!(noticed, "{}: nothing notices an altered `{}`", case.id, entry.id);
        }
    }
}

/// The case is run again with a file in which every number is another one.
#[test]
fn our_numbers_do_not_depend_on_the_published_ones() {
    for (case, run) in smoke_runs() {
        let text = rewritten(case.published);
        let altered = Case { published: Box::leak(text.into_boxed_str()), ..*case };
        let before = Published::parse(case.published).unwrap();
        let after = Published::parse(altered.published).unwrap();
        for (old, new) in before.values().iter().zip(after.values()) {
            assert_ne!(old.value, new.value, "{} was not altered", old.id);
        }
        assert_eq!(ours(run), ours(&compute(&altered)), "{}", case.id);
    }
}

#[test]
fn each_case_has_its_folder_and_reads_its_published_numbers_nowhere_else() {
    for case in cases::CASES {
        let folder = folder().join(case.id);
        for file in ["README.md", "published.toml", "case.rs"] {
            assert!(folder.join(file).is_file(), "{}/{file} is missing", case.id);
        }
        let text = fs::read_to_string(folder.join("published.toml")).unwrap();
        assert_eq!(text, case.published, "{} includes another file", case.id);
        // Once, as the field of the case; a constant or a second include could leak the numbers.
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "rs") {
                continue;
            }
            let code = fs::read_to_string(&path).unwrap();
            let allowed = usize::from(path.ends_with("case.rs"));
            let named = code.matches("published.toml").count();
            let field = code.matches("published: include_str!(\"published.toml\")").count();
            assert_eq!((named, field), (allowed, allowed), "{}", path.display());
            for forbidden in ["CASE.published", "Published::parse", "crate::published"] {
                assert!(!code.contains(forbidden), "{}: {forbidden}", path.display());
            }
        }
    }
}

#[test]
fn case_ids_are_unique_and_every_folder_is_registered() {
    for (index, case) in cases::CASES.iter().enumerate() {
        assert!(cases::CASES[..index].iter().all(|other| other.id != case.id), "{}", case.id);
    }
    for entry in fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        if path.join("published.toml").is_file() {
            let id = path.file_name().unwrap().to_string_lossy();
            assert!(cases::find(&id).is_some(), "{id} is not in CASES");
        }
    }
}

/// Oracles that import the laws they judge would prove nothing.
#[test]
fn oracles_import_nothing_from_the_library() {
    let mut pending = vec![folder()];
    let mut oracles = 0;
    while let Some(place) = pending.pop() {
        for entry in fs::read_dir(&place).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                pending.push(path);
                continue;
            }
            let in_oracles = path.components().any(|part| part.as_os_str() == "oracles");
            if !(path.ends_with("oracle.rs")
                || in_oracles && path.extension().is_some_and(|e| e == "rs"))
            {
                continue;
            }
            oracles += 1;
            let code = fs::read_to_string(&path).unwrap();
            let imports = code
                .lines()
                .map(|line| line.split("//").next().unwrap_or(""))
                .any(|line| line.contains("bearing_dynamics"));
            assert!(!imports, "{} imports the library", path.display());
        }
    }
    assert!(oracles > 0, "no oracle found");
}
