//! Keeps `docs/theory.md` true: each numbered equation of the dissertation has one row; the doc comments of the
//! file that defines its item cite its number, or that of the equation that states the same; its cases exist.

use std::fs;
use std::path::{Path, PathBuf};

/// Numbered equations of the dissertation: chapter and its last number.
const LAST_IN_CHAPTER: [(u32, u32); 4] = [(2, 19), (3, 20), (4, 8), (5, 8)];

/// A row of the table: its cells, and names in backticks of its item and case cells.
struct Row {
    label: String,
    items: Vec<String>,
    cases: Vec<String>,
    same_as: String,
}

impl Row {
    fn is_numbered(&self) -> bool {
        self.label.starts_with('(')
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn in_backticks(text: &str) -> Vec<String> {
    text.split('`').skip(1).step_by(2).map(String::from).collect()
}

fn rows() -> Vec<Row> {
    let page = read(&root().join("docs/theory.md"));
    let (equations, _) = page.split_once("\n# Notation").expect("equations before the notation");
    let lines = equations.lines().filter(|line| line.starts_with('|'));
    let cells = lines.map(|line| line.trim_matches('|').split('|').map(str::trim).collect());
    let rows = cells.filter(|cells: &Vec<&str>| cells[0] != "Equation" && cells[0] != "---");
    rows.map(|cells| {
        let [label, meaning, items, cases, same_as] = cells[..] else { panic!("{cells:?}") };
        assert!(!meaning.is_empty(), "{label} says nothing");
        let [items, cases] = [items, cases].map(in_backticks);
        Row { label: label.into(), items, cases, same_as: same_as.into() }
    })
    .collect()
}

/// The file of an item such as `kinematics::euler::quaternion`, which defines it in public.
fn home(item: &str) -> PathBuf {
    let (modules, name) = item.rsplit_once("::").expect("a path");
    let stem = root().join("src").join(modules.replace("::", "/"));
    let files = [stem.with_extension("rs"), stem.join("mod.rs")];
    let file = files.into_iter().find(|file| file.is_file());
    let file = file.unwrap_or_else(|| panic!("{item}: no such module"));
    let kinds = ["fn", "const fn", "struct", "enum", "const", "type", "trait"];
    let defines = |line: &str| {
        let after = kinds.iter().find_map(|kind| line.strip_prefix(&format!("pub {kind} {name}")));
        after.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    };
    assert!(read(&file).lines().any(|line| defines(line.trim())), "{item}: not in {file:?}");
    file
}

/// Numbers in parentheses in doc comments, such as `(2.1)`, `(2.1, 4.1 and 5.1)` and `(3.13–3.14)`, as `(2.1)` each.
fn cited(source: &str) -> Vec<String> {
    let mut found = Vec::new();
    let comments = source.lines().map(str::trim).filter(|line| line.starts_with("//"));
    for group in comments.flat_map(|line| line.split('(').skip(1)) {
        let Some((group, _)) = group.split_once(')') else { continue };
        for part in group.replace(" and ", ",").split(',') {
            let parts = part.split(['–', '-']).map(|number| number.trim().split_once('.'));
            let ends: Option<Vec<(u32, u32)>> = parts
                .map(|pair| pair.and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?))))
                .collect();
            if let Some([(chapter, first), .., (_, last)] | [(chapter, first @ last)]) =
                ends.as_deref()
            {
                found.extend((*first..=*last).map(|index| format!("({chapter}.{index})")));
            }
        }
    }
    found
}

#[test]
fn every_numbered_equation_has_one_row() {
    let labels: Vec<String> =
        rows().into_iter().filter(Row::is_numbered).map(|row| row.label).collect();
    let of = |(chapter, last)| (1..=last).map(move |index| format!("({chapter}.{index})"));
    assert_eq!(labels, LAST_IN_CHAPTER.into_iter().flat_map(of).collect::<Vec<_>>());
}

#[test]
fn the_home_of_an_equation_cites_its_number() {
    for Row { label, items, same_as, .. } in rows().iter().filter(|row| row.is_numbered()) {
        assert!(!items.is_empty(), "{label}: no item");
        for item in items {
            let numbers = cited(&read(&home(item)));
            assert!(numbers.contains(label) || numbers.contains(same_as), "{label}: {item}");
        }
    }
    rows().iter().flat_map(|row| &row.items).for_each(|item| drop(home(item)));
}

#[test]
fn cases_of_equations_and_errata_exist() {
    let errata = read(&root().join("docs/theory.md"));
    let shown = errata.split("shown by `").skip(1).filter_map(|rest| rest.split('`').next());
    let mut cases: Vec<String> = shown.map(String::from).collect();
    assert!(!cases.is_empty());
    for Row { label, cases: of_row, .. } in rows() {
        assert!(!of_row.is_empty() || !label.starts_with('('), "{label}: no case");
        cases.extend(of_row);
    }
    for case in cases {
        let is_law = case.starts_with("tests/");
        let file = if is_law { case } else { format!("verification/{case}/case.rs") };
        assert!(root().join(&file).is_file(), "no {file}");
    }
}
