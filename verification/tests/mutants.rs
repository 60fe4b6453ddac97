//! The mutation check itself: on a small crate, where what it has to say is known.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use verification::cases;
use verification::mutants::list::{self, List};
use verification::mutants::switch;

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

#[test]
fn every_fault_of_the_list_applies_and_names_checks_that_exist() {
    let root = repository();
    let list = List::read(root).unwrap();
    switch::switched(&list::read_sources(root).unwrap(), &list.mutants).unwrap();
    assert!(list.mutants.len() >= 150, "{} faults", list.mutants.len());
    let has_test = |text: &str, name: &str| text.contains(&format!("fn {name}("));
    for check in list.mutants.iter().flat_map(|m| &m.caught_by) {
        let there = check.case().is_none_or(|id| cases::find(id).is_some())
            && check.test().is_none_or(|(name, function)| {
                let file = root.join(format!("tests/{name}.rs"));
                let parts = fs::read_dir(root.join(format!("tests/{name}"))).into_iter().flatten();
                let texts: Vec<String> = std::iter::once(file)
                    .chain(parts.map(|entry| entry.unwrap().path()))
                    .filter_map(|path| fs::read_to_string(path).ok())
                    .collect();
                let found = |name| texts.iter().any(|text| has_test(text, name));
                !texts.is_empty() && function.is_none_or(found)
            });
        assert!(there, "`{check}` does not exist");
    }
}

/// Functions that a fault may stand in, and places that can have no switch.
const LIBRARY: &str = "pub const HALF: f64 = 0.5;
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
pub fn outer(x: f64) -> f64 {
    fn inner(x: f64) -> f64 {
        x - 1.0
    }
    inner(x) * x
}
pub fn falling(n: usize) -> impl Iterator<Item = usize> {
    (0..n).map(move |i| n - i)
}
";

const TESTS: &str = "use small::*;
#[test]
fn kinds() {
    let mut sum = Sum(0.0);
    sum.add((2.0, 3.0)).add((-1.0, 7.0));
    assert_eq!((sum.0, 1.5.twice(), outer(3.0)), (4.0, 3.0, 6.0));
    assert_eq!(falling(2).collect::<Vec<_>>(), [2, 1]);
}
#[test]
fn wrong() {
    assert_eq!(outer(3.0), 5.0);
}
";

fn entry((id, find, replace): (&str, &str, &str)) -> String {
    format!(
        "[[mutant]]\nid = \"{id}\"\nfind = '{find}'\nreplace = '{replace}'\nbreaks = \"it\"\n\
         caught_by = [\"--test laws kinds\"]\n"
    )
}

/// What the runner does with a small crate of one test binary and this list of faults.
fn mutants(list: &str, more: &[&str]) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    let manifest =
        "[package]\nname = \"small\"\nversion = \"0.1.0\"\nedition = \"2021\"\n[workspace]\n";
    for (name, text) in [
        ("Cargo.toml", manifest),
        ("src/lib.rs", LIBRARY),
        ("tests/laws.rs", TESTS),
        ("verification/mutants/mutants.toml", list),
    ] {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let Output { status, stderr, .. } = Command::new(env!("CARGO_BIN_EXE_verify"))
        .args(["mutants", "--jobs", "2", "--root", folder.path().to_str().unwrap()])
        .args(more)
        .output()
        .unwrap();
    assert_eq!(fs::read_to_string(folder.path().join("src/lib.rs")).unwrap(), LIBRARY);
    (status.code(), String::from_utf8_lossy(&stderr).into_owned())
}

#[test]
fn faults_are_caught_and_a_harmless_change_survives() {
    let wrong = [
        ("early_return", "a < 0.0", "a < -2.0"),
        ("first_of_two", "a * HALF", "a / HALF"),
        ("second_of_two", "+= b", "-= b"),
        ("by_default", "2.0 * self.value()", "self.value()"),
        ("within_another", "x - 1.0", "x + 1.0"),
    ];
    // A runner that reports this as caught reports anything as caught.
    let harmless = entry(("harmless", "inner(x) * x", "x * inner(x)"));
    let list = wrong.map(entry).concat() + &harmless;
    let (code, printed) = mutants(&list, &[]);
    assert_eq!(code, Some(1), "{printed}");
    for (id, ..) in wrong {
        assert!(printed.contains(&format!(" {id} … caught by --test laws kinds\n")), "{printed}");
    }
    assert!(printed.contains(" harmless … SURVIVED\n"), "{printed}");
    assert!(printed.contains("5 of 6 seeded faults caught"), "{printed}");
    let (code, printed) = mutants(&list, &["--only", "by_default"]);
    assert_eq!(code, Some(0), "{printed}");
    assert!(printed.contains("1 of 1 seeded faults caught"), "{printed}");
}

#[test]
fn a_list_that_proves_nothing_is_refused() {
    let fault = |find, replace| entry(("it", find, replace));
    let sound = fault("+= b", "-= b");
    for (list, words) in [
        (fault("+= c", "-= c"), "fault `it`: its text does not occur in src"),
        (fault("fn value", "fn valu"), "fault `it`: its text occurs in src/lib.rs, src/lib.rs"),
        (fault("= 0.5", "= 0.25"), "fault `it`: its text is not within one function's body"),
        (fault("n - i", "n + i"), "the sources with all faults do not build"),
        (fault("+= b", "-= nothing"), "the sources with all faults do not build"),
        (fault("+= b", "+= b"), "fault `it` changes nothing"),
        (sound.repeat(2), "id `it` is used twice"),
        (sound.replace("kinds", "no_such_test"), "`--test laws no_such_test` runs no test"),
        (sound.replace("kinds", "wrong"), "`--test laws wrong` fails without any fault"),
    ] {
        let (code, printed) = mutants(&list, &[]);
        assert_eq!(code, Some(2), "{printed}");
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let (code, printed) = mutants(&sound, &["--only", "other"]);
    assert_eq!(code, Some(2), "{printed}");
}
