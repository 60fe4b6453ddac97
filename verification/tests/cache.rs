//! What long cases computed, kept for the next run: taken only while everything is the same.
//!
//! Sources lie in a small tree of their own; the cases are quick ones that say they are long.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use verification::cache::{self, Cache};
use verification::case::{Case, CaseError, Tier};
use verification::check::Check;
use verification::context::CaseContext;
use verification::golden::{self, GoldenTolerance};
use verification::report::CaseStatus;
use verification::runner::{self, Run, assess};
use verification::sources;

const LONG: Case = Case {
    id: "long_one",
    title: "A long case",
    section: "1.1",
    tier: Tier::Full,
    published: "[[value]]\nid = \"third\"\nquantity = \"a third\"\nvalue = 0.333\nunit = \"m\"\n\
                source = \"Table 1.1\"\nrounding = 0.001\n",
    run: computation,
};

/// One of everything that can be recorded.
fn computation(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption("unit", "The source names none.", "metres");
    context.check(
        Check::new("third", "a third", "m", 1.0 / 3.0)
            .published("third")
            .under("unit")
            .printed("a fraction")
            .golden(GoldenTolerance::EXACT),
    );
    context.check(
        Check::new("zero", "nothing, from below", "m", -0.0)
            .closed_form(5e-324, "the least number")
            .absolute(1e-300, "rounding"),
    );
    context.check(Check::new("above", "more", "1", 2.0).independent(1.0, "one").at_least(0.1, "a"));
    context.check(Check::new("below", "less", "1", 0.1).converged(1.0, "one").at_most(0.3, "b"));
    context.figure("picture", "<svg><text>&\u{e9}\n\"</text></svg>".into(), "A picture.");
    context.finding("word", "It is `so`.");
    context.table("rows", "Rows", &["a", "b"], vec![vec!["1".into(), "2|3".into()]]);
    context.work("evaluations", u64::MAX >> 12);
    context.golden("pi", std::f64::consts::PI, "1", GoldenTolerance::REORDERED.floor(1e-12));
    Ok(())
}

/// A repository in small, and a folder for records.
struct Place {
    folder: TempDir,
}

const FILES: [&str; 9] = [
    "src/lib.rs",
    "src/deep/er/law.rs",
    "verification/src/judge.rs",
    "verification/long_one/case.rs",
    "verification/long_one/oracle.rs",
    "scenes/one.toml",
    "Cargo.lock",
    "Cargo.toml",
    ".cargo/config.toml",
];

impl Place {
    fn new() -> Place {
        let place = Place { folder: tempfile::tempdir().unwrap() };
        for file in FILES {
            place.write(file, &format!("let x = 1; // {file}\n"));
        }
        place.write("verification/other_one/case.rs", "another case");
        place
    }

    fn root(&self) -> PathBuf {
        self.folder.path().join("tree")
    }

    fn records(&self) -> PathBuf {
        self.folder.path().join("records")
    }

    fn write(&self, file: &str, text: &str) {
        let path = self.root().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// The cache of a program just built from the tree.
    fn built(&self) -> Cache {
        self.built_as("one compiler")
    }

    fn built_as(&self, build: &str) -> Cache {
        Cache::with(&self.records(), sources::read(&self.root()).unwrap(), &self.root(), build)
    }
}

fn kept(place: &Place) -> Run {
    let (run, kept) = runner::run(&LONG, &place.built());
    assert_eq!((kept, run.error.as_ref(), run.computed.as_ref()), (Ok(()), None, None));
    run
}

#[test]
fn the_same_sources_give_the_record_back_bit_for_bit() {
    let place = Place::new();
    let first = kept(&place);
    let again = place.built().take(&LONG).expect("a record");
    assert_eq!(again.record, first.record);
    assert_eq!(again.seconds.to_bits(), first.seconds.to_bits());
    let bits = |run: &Run| run.record.ours().iter().map(|(_, x)| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&again), bits(&first));
    assert!(bits(&again).contains(&(-0.0_f64).to_bits()));
    assert!(again.computed.is_some());
    // What a reader is told, published numbers and other cases decide nothing that is computed.
    place.write("verification/long_one/README.md", "words");
    place.write("verification/long_one/published.toml", "numbers");
    place.write("verification/other_one/case.rs", "changed");
    place.write("docs/page.md", "words");
    assert!(place.built().take(&LONG).is_some());
}

#[test]
fn one_changed_character_of_any_source_misses() {
    for file in FILES {
        let place = Place::new();
        kept(&place);
        let path = place.root().join(file);
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replace('1', "2")).unwrap();
        assert!(place.built().take(&LONG).is_none(), "{file}");
        // Put back, the old record serves again.
        fs::write(&path, text).unwrap();
        assert!(place.built().take(&LONG).is_some(), "{file}");
    }
    let place = Place::new();
    kept(&place);
    assert!(place.built_as("another compiler").take(&LONG).is_none());
    place.write("src/new.rs", "");
    assert!(place.built().take(&LONG).is_none(), "a new file");
}

#[test]
fn a_cached_record_is_judged_anew() {
    let place = Place::new();
    let golden = place.folder.path().join("golden");
    let first = kept(&place);
    golden::write(&golden, LONG.id, first.record.golden_values(), "a test").unwrap();
    let again = place.built().take(&LONG).unwrap();
    let status = |case: &Case| assess(case, &again, &golden).status;
    assert_eq!(status(&LONG), CaseStatus::Passed);
    let other: &'static str = LONG.published.replace("0.333", "0.335").leak();
    assert_eq!(status(&Case { published: other, ..LONG }), CaseStatus::Failed);
    let path = golden.join("long_one.json");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("3.14159", "3.14160")).unwrap();
    assert_eq!(status(&LONG), CaseStatus::GoldenChanged);
}

/// The list that the build script put down is that of the sources here; every file of every case
/// is in it.
#[test]
fn the_program_knows_what_it_was_built_from() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let built_from = cache::built_from();
    assert_eq!(built_from, sources::read(&root).unwrap());
    for file in ["src/lib.rs", "Cargo.lock", "Cargo.toml", "verification/src/cache.rs"] {
        assert!(built_from.contains_key(file), "{file}");
    }
    for case in verification::cases::CASES {
        let path = |name: &str| format!("verification/{}/{name}", case.id);
        assert!(built_from.contains_key(&path("case.rs")), "{}", case.id);
        assert!(!built_from.contains_key(&path("published.toml")), "{}", case.id);
    }
}

/// The folder of a case stands for all that is its own only while no case reaches into another's.
#[test]
fn no_case_reaches_into_the_folder_of_another() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for case in verification::cases::CASES {
        for entry in fs::read_dir(root.join(case.id)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "rs") {
                continue;
            }
            let code = fs::read_to_string(&path).unwrap();
            assert!(!code.contains("\"../"), "{} names a file elsewhere", path.display());
            for other in verification::cases::CASES.iter().filter(|other| other.id != case.id) {
                for way in [format!("{}::", other.id), format!("super::{}", other.id)] {
                    assert!(!code.contains(&way), "{}: {way}", path.display());
                }
            }
        }
    }
}
