//! What long cases computed, kept for the next run: taken only while everything is the same.
//!
//! Sources lie in a small tree of their own; the cases are quick ones that say they are long.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use verification::cache::{self, Cache};
use verification::case::{Case, CaseError, Tier};
use verification::check::{Check, Explanation};
use verification::context::CaseContext;
use verification::golden::{self, GoldenTolerance};
use verification::index::Index;
use verification::machine::Machine;
use verification::report::{CaseStatus, Report};
use verification::runner::{self, Run, assess, compute};
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

    fn only_record(&self) -> PathBuf {
        let mut files = fs::read_dir(self.records()).unwrap();
        let path = files.next().unwrap().unwrap().path();
        assert!(files.next().is_none(), "more than one record");
        path
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
fn a_program_built_from_other_sources_takes_and_keeps_nothing() {
    let place = Place::new();
    let old = place.built();
    kept(&place);
    let built_from = sources::read(&place.root()).unwrap();
    place.write("src/lib.rs", "let x = 2;");
    let stale = Cache::with(&place.records(), built_from, &place.root(), "one compiler");
    assert!(stale.take(&LONG).is_none());
    let (run, kept) = runner::run(&LONG, &stale);
    assert_eq!(run.error, None);
    assert!(kept.is_err_and(|reason| reason.starts_with("src/lib.rs")));
    place.only_record();
    // The state of the sources is that at the start of the run.
    assert!(old.take(&LONG).is_some());
}

#[test]
fn a_cut_or_altered_record_is_a_miss() {
    let place = Place::new();
    kept(&place);
    let path = place.only_record();
    let whole = fs::read(&path).unwrap();
    let cuts = (0..whole.len()).step_by(37).map(|end| whole[..end].to_vec());
    let altered = (0..whole.len()).step_by(7).map(|at| {
        let mut bytes = whole.clone();
        bytes[at] = if bytes[at] == b'7' { b'8' } else { b'7' };
        bytes
    });
    for bytes in cuts.chain(altered) {
        fs::write(&path, &bytes).unwrap();
        assert!(place.built().take(&LONG).is_none(), "{}", String::from_utf8_lossy(&bytes));
    }
    // Another case's record under this name.
    let text = String::from_utf8(whole.clone()).unwrap();
    fs::write(&path, text.replace("long_one", "other_one")).unwrap();
    assert!(place.built().take(&LONG).is_none());
    // The next run computes and puts it right.
    let run = kept(&place);
    assert_eq!(run.record, place.built().take(&LONG).unwrap().record);
}

#[test]
fn quick_cases_errors_and_no_cache_keep_nothing() {
    let place = Place::new();
    let cache = place.built();
    let quick = Case { tier: Tier::Smoke, ..LONG };
    let erring = Case { run: |_| Err(CaseError::message("no")), ..LONG };
    let panicking = Case { run: |_| panic!("no"), ..LONG };
    for case in [quick, erring, panicking] {
        assert_eq!(runner::run(&case, &cache).1, Ok(()));
    }
    assert_eq!(runner::run(&LONG, &Cache::none()).1, Ok(()));
    assert!(!place.records().exists());
    kept(&place);
    assert!(cache.take(&quick).is_none() && Cache::none().take(&LONG).is_none());
}

#[test]
fn numbers_that_are_not_finite_come_back_as_they_were() {
    let place = Place::new();
    let run = |context: &mut CaseContext| {
        for (id, value) in [("nan", -f64::NAN), ("up", f64::INFINITY), ("down", f64::NEG_INFINITY)]
        {
            let check = Check::new(id, "q", "1", value).closed_form(value, "itself");
            context.check(check.absolute(value, "none").golden(GoldenTolerance::EXACT));
        }
        Ok(())
    };
    let case = Case { run, ..LONG };
    let (first, kept) = runner::run(&case, &place.built());
    assert_eq!(kept, Ok(()));
    let again = place.built().take(&case).expect("a record");
    for ((_, one), (_, other)) in first.record.ours().iter().zip(again.record.ours()) {
        assert_eq!(one.to_bits(), other.to_bits());
    }
    for (one, other) in first.record.golden_values().iter().zip(again.record.golden_values()) {
        assert_eq!(one.value.to_bits(), other.value.to_bits());
    }
    // A gap of an explanation that JSON has no word for: computed every time.
    let run = |context: &mut CaseContext| {
        let check = Check::new("a", "q", "1", 1.0).closed_form(1.0, "itself");
        context.check(check.explained(Explanation::new("why", f64::NAN, 0.0, &[])));
        Ok(())
    };
    let place = Place::new();
    assert!(runner::run(&Case { run, ..LONG }, &place.built()).1.is_err());
    assert!(!place.records().exists());
}

/// The three forms of a report on one run.
fn forms(run: &Run, golden: &Path, out: &Path) -> [String; 3] {
    let machine = Machine { date: "a day".into(), ..Machine::facts() };
    let case = assess(&LONG, run, golden);
    assert_eq!(case.status, CaseStatus::Passed, "{:?}", case.failures());
    let index = Index::load().unwrap();
    Report { machine, tier: Tier::Full, index, cases: vec![case] }.write(out).unwrap();
    ["report.json", "report.md", "report.html"]
        .map(|name| fs::read_to_string(out.join(name)).unwrap())
}

#[test]
fn a_report_from_the_cache_differs_by_its_note_alone() {
    let place = Place::new();
    let golden = place.folder.path().join("golden");
    golden::write(&golden, LONG.id, compute(LONG.run).record.golden_values(), "a test").unwrap();
    let first = kept(&place);
    let again = place.built().take(&LONG).unwrap();
    let date = again.computed.clone().unwrap();
    let before = forms(&first, &golden, &place.folder.path().join("a"));
    let after = forms(&again, &golden, &place.folder.path().join("b"));
    let note = format!(
        "computed at {date}, taken from the cache: same case, code and inputs; judged anew"
    );
    for (before, after) in before.iter().zip(&after) {
        assert!(after.contains(&note), "no note in a form");
        assert!(!before.contains("taken from the cache"));
        let lines = |text: &str| text.lines().map(String::from).collect::<Vec<_>>();
        let added: Vec<String> =
            lines(after).into_iter().filter(|line| !lines(before).contains(line)).collect();
        // The note itself, the total of seconds, the line of the summary; an object in JSON.
        assert!(added.len() <= 5, "{added:?}");
    }
    // Without what is said of the cache, byte for byte the same.
    let told = [
        ", < 0.001 s of them in earlier runs (1 case from the cache)".to_string(),
        ", &lt; 0.001 s of them in earlier runs (1 case from the cache)".to_string(),
        format!("*{note}*\n\n"),
        format!("<p class=\"meta cached\">{note}</p>\n"),
        " (cached)".to_string(),
        "<small>cached</small>".to_string(),
    ];
    let strip =
        |text: &str| told.iter().fold(text.to_string(), |text, told| text.replace(told, ""));
    for form in 1..3 {
        assert_eq!(strip(&after[form]), before[form]);
    }
    let json = |text: &str| -> serde_json::Value { serde_json::from_str(text).unwrap() };
    let mut value = json(&after[0]);
    assert_eq!(value["cases"][0]["cached"]["computed"], date.as_str());
    value["cases"][0]["cached"] = serde_json::Value::Null;
    assert_eq!(serde_json::to_string_pretty(&value).unwrap() + "\n", before[0]);
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

#[test]
fn a_case_keeps_its_four_newest_records() {
    let place = Place::new();
    let files = || fs::read_dir(place.records()).unwrap().count();
    for version in 0..7 {
        place.write("src/lib.rs", &format!("version {version}"));
        kept(&place);
        assert_eq!(files(), (version + 1).min(4));
        assert!(place.built().take(&LONG).is_some());
    }
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
