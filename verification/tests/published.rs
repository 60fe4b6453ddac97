//! The sources of the cases: each reads its published numbers in one place, no oracle sees what it
//! judges.

use std::fs;
use std::path::{Path, PathBuf};

use verification::cases;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
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
    }
}

/// A case is computed by a function that is given no published number (`case::Computation`). Here it
/// is seen that none of them, and no helper of theirs, fetches one: the file is named once, as the
/// field of the case, and code that computes reads no file at all.
#[test]
fn our_numbers_do_not_depend_on_the_published_ones() {
    let mut pending = vec![folder()];
    let mut seen = 0;
    while let Some(place) = pending.pop() {
        for entry in fs::read_dir(&place).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                if !path.ends_with("tests") {
                    pending.push(path);
                }
                continue;
            }
            let name = path.strip_prefix(folder()).unwrap().to_string_lossy().replace('\\', "/");
            if !name.ends_with(".rs") || FRAMEWORK.iter().any(|part| name.starts_with(part)) {
                continue;
            }
            seen += 1;
            let code = fs::read_to_string(&path).unwrap();
            assert_eq!(reaches_for_published(&code, name.ends_with("/case.rs")), None, "{name}");
        }
    }
    assert!(seen > 2 * cases::CASES.len(), "only {seen} files seen");
}

/// What reads, judges and reports published numbers; none of it computes.
const FRAMEWORK: [&str; 18] = [
    // Another program's kept decks and outputs, beside which it has no published numbers.
    "calculix_comparison/files.rs",
    "build.rs",
    // Records of finished cases, and hashes of sources.
    "src/cache.rs",
    "src/sources.rs",
    "src/case.rs",
    "src/check.rs",
    "src/golden.rs",
    "src/judge.rs",
    "src/date.rs",
    "src/lib.rs",
    "src/machine.rs",
    "src/main.rs",
    "src/mutants",
    "src/pareto",
    "src/published.rs",
    "src/report",
    "src/runner.rs",
    "src/cases.rs",
];

/// The words in `code` by which it could come to a published number.
fn reaches_for_published(code: &str, is_case: bool) -> Option<&'static str> {
    const FIELD: &str = "published: include_str!(\"published.toml\")";
    let named = code.matches("published.toml").count();
    if named != usize::from(is_case) || code.matches(FIELD).count() != named {
        return Some("published.toml");
    }
    // A file read while running, another crate's field, or the framework's own reader.
    let words = [
        "CASE.published",
        ".published;",
        "Published::",
        "published::",
        "cases::",
        "fs::",
        "File::",
        "include_bytes!",
        "golden::read",
    ];
    words.into_iter().find(|word| code.contains(word))
}

#[test]
fn reaching_for_a_published_number_is_noticed() {
    let field = "published: include_str!(\"published.toml\"),";
    assert_eq!(reaches_for_published(field, true), None);
    assert_eq!(reaches_for_published("let x = 1.0;", false), None);
    for code in [
        "const SECOND: &str = include_str!(\"published.toml\");",
        "let text = CASE.published;",
        "use crate::published;\nlet p = published::Published::parse(text);",
        "let text = std::fs::read_to_string(path)?;",
    ] {
        assert!(reaches_for_published(code, false).is_some(), "{code}");
        assert!(reaches_for_published(&format!("{field}\n{code}"), true).is_some(), "{code}");
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
