//! The mutation check itself: on a small crate, where what it has to say is known.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use verification::cases;
use verification::mutants::list::{Check, List};

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

#[test]
fn every_fault_of_the_list_applies_and_names_checks_that_exist() {
    let root = repository();
    let list = List::read(&root.join("verification/mutants/mutants.toml")).unwrap();
    list.check_applies(root).unwrap();
    assert!(list.mutants.len() >= 40, "{} faults", list.mutants.len());
    let has_test = |text: &str, name: &str| text.contains(&format!("fn {name}("));
    for check in list.mutants.iter().flat_map(|m| &m.caught_by).chain(&list.fallback) {
        let there = match check {
            Check::Test { name, filter } => {
                let file = root.join(format!("tests/{name}.rs"));
                let parts = fs::read_dir(root.join(format!("tests/{name}"))).into_iter().flatten();
                let texts: Vec<String> = std::iter::once(file)
                    .chain(parts.map(|entry| entry.unwrap().path()))
                    .filter_map(|path| fs::read_to_string(path).ok())
                    .collect();
                let found = |name| texts.iter().any(|text| has_test(text, name));
                !texts.is_empty() && filter.as_deref().is_none_or(found)
            }
            Check::Case { id } => cases::find(id).is_some(),
        };
        assert!(there, "`{check}` does not exist");
    }
}

const LIBRARY: &str = "/// Twice its argument.\npub fn twice(x: f64) -> f64 {\n    2.0 * x\n}\n";

const TESTS: &str =
    "#[test]\nfn twice_is_a_sum() {\n    assert_eq!(small::twice(1.5), 1.5 + 1.5);\n}\n";

const WRONG_FACTOR: &str = "[[mutant]]\nid = \"wrong_factor\"\nfile = \"src/lib.rs\"\n\
    find = \"2.0 * x\"\nreplace = \"3.0 * x\"\nbreaks = \"a factor\"\ncaught_by = [\"--test laws\"]\n";

/// A change of a comment: whoever reports this as caught reports anything as caught.
const HARMLESS: &str = "[[mutant]]\nid = \"harmless\"\nfile = \"src/lib.rs\"\n\
    find = \"/// Twice\"\nreplace = \"/// Two times\"\nbreaks = \"nothing\"\n\
    caught_by = [\"--test laws twice_is_a_sum\"]\n";

/// A crate of one function and one test, with a list of faults.
fn crate_with(mutants: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let list = format!("fallback = [\"--test laws\"]\n{}", mutants.concat());
    let manifest = "[package]\nname = \"small\"\nversion = \"0.1.0\"\nedition = \"2021\"\n\
        [workspace]\n";
    for (name, text) in [
        ("Cargo.toml", manifest),
        ("src/lib.rs", LIBRARY),
        ("tests/laws.rs", TESTS),
        ("verification/mutants/mutants.toml", &list),
    ] {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn mutants(root: &Path, more: &[&str]) -> (Option<i32>, String) {
    let Output { status, stderr, .. } = Command::new(env!("CARGO_BIN_EXE_verify"))
        .args(["mutants", "--root", root.to_str().unwrap()])
        .args(more)
        .output()
        .unwrap();
    (status.code(), String::from_utf8_lossy(&stderr).into_owned())
}

#[test]
fn a_fault_is_caught_and_a_harmless_change_survives() {
    let folder = crate_with(&[WRONG_FACTOR, HARMLESS]);
    let root = folder.path();
    let (code, said) = mutants(root, &["--only", "wrong_factor"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("wrong_factor … caught by --test laws"), "{said}");
    // What is caught stays caught and is not built again; what survives fails the check.
    let (code, said) = mutants(root, &[]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("harmless … SURVIVED") && !said.contains("wrong_factor"), "{said}");
    assert!(said.contains("1 of 2 seeded faults caught"), "{said}");
    let report = fs::read_to_string(root.join("target/mutants/report.md")).unwrap();
    assert!(report.contains("1 of 2 caught") && report.contains("1 survived"), "{report}");
    // The sources were never touched, and the copy has no fault left in it.
    for place in ["src/lib.rs", "target/mutants/tree/src/lib.rs"] {
        assert_eq!(fs::read_to_string(root.join(place)).unwrap(), LIBRARY);
    }
    // Other sources, other verdicts.
    fs::write(root.join("src/lib.rs"), format!("{LIBRARY}\n")).unwrap();
    let (_, said) = mutants(root, &["--only", "wrong_factor"]);
    assert!(said.contains("wrong_factor … caught"), "{said}");
}

/// Functions of all kinds that a fault may stand in; each test holds one of them.
const KINDS: &str = "pub const HALF: f64 = 0.5;
pub struct Sum(pub f64);
impl Sum {
    pub fn add(&mut self, (a, b): (f64, f64)) -> &mut Self {
        if a < 0.0 {
            return self;
        }
        self.0 += a * HALF;
        self.0 += b;
        self
    }
    pub fn into_parts<T: From<f64>>(self, parts: impl Fn(f64) -> f64) -> Vec<T> {
        let of = |x: f64| T::from(parts(x) + 1.0);
        vec![of(self.0)]
    }
}
impl std::fmt::Display for Sum {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, \"{} m\", self.0)
    }
}
pub trait Twice {
    fn value(&self) -> f64;
    fn twice(&self) -> f64 {
        2.0 * self.value()
    }
}
impl Twice for f64 {
    fn value(&self) -> f64 {
        *self
    }
}
pub const fn three() -> f64 {
    3.0
}
pub fn falling(n: usize) -> impl Iterator<Item = usize> {
    (0..n).map(move |i| n - i)
}
pub fn outer(x: f64) -> f64 {
    fn inner(x: f64) -> f64 {
        x - 1.0
    }
    inner(x) * x
}
";

const TESTS_OF_KINDS: &str = "use small::*;
#[test]
fn kinds() {
    let mut sum = Sum(0.0);
    sum.add((2.0, 3.0)).add((-1.0, 7.0));
    assert_eq!((sum.0, sum.to_string().as_str()), (4.0, \"4 m\"));
    assert_eq!(sum.into_parts::<f64>(|x| 2.0 * x), [9.0]);
    assert_eq!((1.5.twice(), three(), outer(3.0)), (3.0, 3.0, 6.0));
    assert_eq!(falling(2).collect::<Vec<_>>(), [2, 1]);
}
";

#[test]
fn a_fault_in_a_function_of_any_kind_is_switched_or_built_alone() {
    // What is wrong in the one build, and what cannot be there: constants, what is computed when it is
    // compiled, and values of a type without a name.
    let switched = [
        ("early_return", "a < 0.0", "a < -2.0"),
        ("first_of_two", "a * HALF", "a / HALF"),
        ("second_of_two", "+= b", "-= b"),
        ("in_a_closure", "parts(x) + 1.0", "parts(x) - 1.0"),
        ("of_a_trait", "{} m", "{} mm"),
        ("by_default", "2.0 * self.value()", "self.value()"),
        ("within_another", "x - 1.0", "x + 1.0"),
    ];
    let alone = [
        ("a_constant", "= 0.5", "= 0.25"),
        ("when_compiled", "    3.0", "    4.0"),
        ("without_a_name", "n - i", "n + i"),
        ("a_signature", "(a, b): (f64, f64)", "(b, a): (f64, f64)"),
    ];
    let entry = |(id, find, replace): (&str, &str, &str)| {
        format!(
            "[[mutant]]\nid = \"{id}\"\nfile = \"src/lib.rs\"\nfind = '{find}'\nreplace = '{replace}'\n\
             breaks = \"it\"\ncaught_by = [\"--test laws kinds\"]\n"
        )
    };
    // In the body of a function that has faults, and none itself.
    let same = entry(("same", "inner(x) * x", "x * inner(x)"));
    let texts: Vec<String> = switched.into_iter().chain(alone).map(entry).chain([same]).collect();
    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    let folder = crate_with(&texts);
    fs::write(folder.path().join("src/lib.rs"), KINDS).unwrap();
    fs::write(folder.path().join("tests/laws.rs"), TESTS_OF_KINDS).unwrap();
    let (code, said) = mutants(folder.path(), &[]);
    assert_eq!(code, Some(1), "{said}");
    let line = |id: &str| said.lines().find(|line| line.contains(&format!(" {id} … "))).unwrap();
    for (ids, built_alone) in [(&switched[..], false), (&alone[..], true)] {
        for (id, ..) in ids {
            assert!(line(id).contains("… caught by --test laws kinds"), "{said}");
            assert_eq!(line(id).contains("built alone"), built_alone, "{said}");
        }
    }
    assert!(line("same").contains("SURVIVED") && !line("same").contains("alone"), "{said}");
}

#[test]
fn a_list_that_proves_nothing_is_refused() {
    let gone = WRONG_FACTOR.replace("2.0 * x", "2.0 * y");
    let broken = WRONG_FACTOR.replace("3.0 * x", "3.0 * nothing");
    let no_test = HARMLESS.replace("twice_is_a_sum", "no_such_test");
    let failing = WRONG_FACTOR.replace("--test laws", "--test laws twice");
    for (mutant, words) in [
        (gone, "mutant `wrong_factor` no longer applies: its text stands 0 times"),
        (broken, "mutant `wrong_factor` does not build"),
        (no_test, "`--test laws no_such_test` runs no test"),
        (failing, "`--test laws twice` fails without any fault"),
    ] {
        let folder = crate_with(&[&mutant]);
        if words.contains("without any fault") {
            let tests = TESTS.replace("1.5 + 1.5", "4.0");
            fs::write(folder.path().join("tests/laws.rs"), tests).unwrap();
        }
        let (code, said) = mutants(folder.path(), &[]);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(words), "{said}");
    }
    let twice = crate_with(&[HARMLESS, HARMLESS]);
    let (code, said) = mutants(twice.path(), &[]);
    assert_eq!(code, Some(2));
    assert!(said.contains("id `harmless` is used twice"), "{said}");
    let (code, said) = mutants(twice.path(), &["--only", "other"]);
    assert_eq!(code, Some(2), "{said}");
}
