//! Keeps `docs/equations.md` true: every equation of the dissertation once, every item and every
//! verification case it names in its place, every case with a way of calls to the item, and nothing
//! called "not yet" that the code cites.

use crate::call_graph;

use call_graph::{CallGraph, Reached};
use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// Numbered equations of the dissertation: chapter and its last number.
const LAST_IN_CHAPTER: [(u32, u32); 4] = [(2, 19), (3, 20), (4, 8), (5, 8)];
const NOT_YET: &str = "not yet";

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Number {
    chapter: u32,
    index: u32,
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}.{})", self.chapter, self.index)
    }
}

/// One row of the table; empty lists stand for "not yet".
#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    line: usize,
    label: String,
    number: Option<Number>,
    items: Vec<String>,
    cases: Vec<String>,
    same_as: Option<Number>,
}

fn parse_number(text: &str) -> Option<Number> {
    let (chapter, index) = text.split_once('.')?;
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    if !digits(chapter) || !digits(index) {
        return None;
    }
    Some(Number { chapter: chapter.parse().ok()?, index: index.parse().ok()? })
}

/// `(2.1)` and nothing else.
fn parse_label(text: &str) -> Option<Number> {
    parse_number(text.strip_prefix('(')?.strip_suffix(')')?)
}

/// A cell is either `not yet` or a comma-separated list of names in backticks.
fn parse_names(cell: &str) -> Result<Vec<String>, String> {
    if cell == NOT_YET {
        return Ok(Vec::new());
    }
    cell.split(',')
        .map(|part| {
            part.trim()
                .strip_prefix('`')
                .and_then(|p| p.strip_suffix('`'))
                .filter(|name| !name.is_empty())
                .map(str::to_owned)
                .ok_or_else(|| format!("`{cell}` is neither \"{NOT_YET}\" nor names in backticks"))
        })
        .collect()
}

fn parse_table(markdown: &str) -> Result<Vec<Row>, Vec<String>> {
    let mut rows = Vec::new();
    let mut problems = Vec::new();
    for (index, text) in markdown.lines().enumerate() {
        let line = index + 1;
        let Some(inner) = text.strip_prefix('|') else { continue };
        let cells: Vec<&str> =
            inner.trim_end().trim_end_matches('|').split('|').map(str::trim).collect();
        if cells[0] == "Equation" || cells[0].starts_with("---") {
            continue;
        }
        let [label, meaning, items, cases, same_as] = cells[..] else {
            problems.push(format!("line {line}: {} cells instead of 5", cells.len()));
            continue;
        };
        if meaning.is_empty() {
            problems.push(format!("line {line}: {label} says nothing"));
        }
        if label.starts_with('(') && parse_label(label).is_none() {
            problems.push(format!("line {line}: {label} is not an equation number"));
        }
        if same_as != "–" && parse_label(same_as).is_none() {
            problems.push(format!("line {line}: \"same as\" is {same_as:?}, not a number or –"));
        }
        match (parse_names(items), parse_names(cases)) {
            (Ok(items), Ok(cases)) => rows.push(Row {
                line,
                label: label.to_owned(),
                number: parse_label(label),
                items,
                cases,
                same_as: parse_label(same_as),
            }),
            (items, cases) => {
                let both = [items.err(), cases.err()];
                problems.extend(both.into_iter().flatten().map(|e| format!("line {line}: {e}")));
            }
        }
    }
    if problems.is_empty() { Ok(rows) } else { Err(problems) }
}

/// Numbers the dissertation has and the table has not, has twice, or has in excess.
fn check_numbers(rows: &[Row]) -> Vec<String> {
    let mut count: BTreeMap<Number, usize> = BTreeMap::new();
    for number in rows.iter().filter_map(|row| row.number) {
        *count.entry(number).or_default() += 1;
    }
    let mut problems = Vec::new();
    for (chapter, last) in LAST_IN_CHAPTER {
        for index in 1..=last {
            let number = Number { chapter, index };
            match count.remove(&number) {
                Some(1) => {}
                Some(times) => problems.push(format!("{number} appears {times} times")),
                None => problems.push(format!("{number} is missing")),
            }
        }
    }
    problems.extend(count.keys().map(|number| format!("{number} is not in the dissertation")));
    problems
}

/// A restated law points straight at its first statement and shares its item.
fn check_same_as(rows: &[Row]) -> Vec<String> {
    let mut problems = Vec::new();
    for row in rows {
        let Some(target) = row.same_as else { continue };
        let Some(first) = rows.iter().find(|r| r.number == Some(target)) else {
            problems.push(format!("{}: same as {target}, which has no row", row.label));
            continue;
        };
        if row.number.is_none_or(|number| number <= target) {
            problems.push(format!("{}: same as {target}, which does not come before", row.label));
        }
        if first.same_as.is_some() {
            problems.push(format!("{}: same as {target}, itself a restatement", row.label));
        }
        if first.items != row.items {
            problems.push(format!("{}: another item than {target}", row.label));
        }
    }
    problems
}

/// Whether `source` defines `name` publicly as a function, type or constant.
fn defines(source: &str, name: &str) -> bool {
    const KINDS: [&str; 6] =
        ["pub fn ", "pub const fn ", "pub struct ", "pub enum ", "pub const ", "pub type "];
    source.lines().any(|line| {
        KINDS.iter().any(|kind| {
            line.trim_start()
                .strip_prefix(kind)
                .and_then(|rest| rest.strip_prefix(name))
                .is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        })
    })
}

/// The file of a module path such as `["ch2_housing", "bearing", "hertz"]`, under `src`.
fn module_file(src: &Path, modules: &[&str]) -> Option<PathBuf> {
    let stem = modules.iter().fold(src.to_path_buf(), |path, module| path.join(module));
    [stem.with_extension("rs"), stem.join("mod.rs")].into_iter().find(|path| path.is_file())
}

fn check_item(root: &Path, item: &str) -> Result<PathBuf, String> {
    let parts: Vec<&str> = item.split("::").collect();
    let [modules @ .., name] = &parts[..] else { return Err("empty path".into()) };
    let file = module_file(&root.join("src"), modules)
        .ok_or_else(|| format!("`{item}`: no such module"))?;
    let source = read(&file);
    if defines(&source, name) {
        Ok(file)
    } else {
        Err(format!("`{item}`: {} defines no public `{name}`", relative(root, &file)))
    }
}

/// Where a case starts: its `case.rs`, or the file of a law's tests itself.
fn start_file(root: &Path, case: &str) -> PathBuf {
    match case.starts_with("tests/") {
        true => root.join(case),
        false => root.join("verification").join(case).join("case.rs"),
    }
}

/// The calls of the library, of the verification and of the tests that rows name.
fn call_graph(root: &Path, rows: &[Row]) -> CallGraph {
    let mut files = rust_files(&root.join("src"));
    files.extend(rust_files(&root.join("verification")));
    let laws = rows.iter().flat_map(|row| &row.cases).filter(|case| case.starts_with("tests/"));
    files.extend(laws.map(|law| root.join(law)));
    files.sort();
    files.dedup();
    let mut graph = CallGraph::default();
    for file in files {
        let path = relative(root, &file);
        if !path.contains("/target/") && !path.starts_with("verification/tests") {
            graph.add(&path, &read(&file));
        }
    }
    graph
}

/// Cases from which no call leads to the item that they are said to verify.
fn check_calls(root: &Path, rows: &[Row]) -> Vec<String> {
    let mut graph = call_graph(root, rows);
    let mut known: BTreeMap<&String, Reached> = BTreeMap::new();
    let mut problems = Vec::new();
    for row in rows {
        for case in &row.cases {
            let start = relative(root, &start_file(root, case));
            let is_law = case.starts_with("tests/");
            let reached = known.entry(case).or_insert_with(|| {
                graph.reached(|file, name| file == start && (is_law || name == "run"))
            });
            for item in &row.items {
                let mut parts = item.rsplit("::");
                let name = parts.next().unwrap_or_default();
                let module = parts.next().unwrap_or_default();
                if !reached.has(module, name) {
                    problems.push(format!("{}: `{case}` never calls `{item}`", row.label));
                }
            }
        }
    }
    problems
}

fn check_places(root: &Path, rows: &[Row]) -> Vec<String> {
    let mut problems = Vec::new();
    for row in rows {
        for item in &row.items {
            match check_item(root, item) {
                Err(problem) => problems.push(format!("{}: {problem}", row.label)),
                Ok(file) => {
                    let cited = citations(&read(&file));
                    let known = [row.number, row.same_as];
                    if row.number.is_some() && !known.iter().flatten().any(|n| cited.contains(n)) {
                        let file = relative(root, &file);
                        problems.push(format!("{}: no doc comment of {file} cites it", row.label));
                    }
                }
            }
        }
        for case in &row.cases {
            if !start_file(root, case).is_file() {
                let file = relative(root, &start_file(root, case));
                problems.push(format!("{}: no {file}", row.label));
            }
        }
        if row.items.is_empty() != row.cases.is_empty() {
            problems.push(format!("{}: an item and a case come together", row.label));
        }
    }
    problems
}

/// Equation numbers in the doc comments of `source`: `(2.1)`, `(3.13–3.14)`, `(2.1, 4.1 and 5.1)`.
fn citations(source: &str) -> Vec<Number> {
    let mut found = Vec::new();
    for line in source.lines().map(str::trim_start) {
        if !line.starts_with("///") && !line.starts_with("//!") {
            continue;
        }
        for group in line.split('(').skip(1).filter_map(|rest| rest.split_once(')')) {
            found.extend(numbers_in_parentheses(group.0));
        }
    }
    found
}

fn numbers_in_parentheses(text: &str) -> Vec<Number> {
    let mut numbers = Vec::new();
    for part in text.replace(" and ", ",").replace('–', "-").split(',') {
        let ends: Vec<Option<Number>> =
            part.split('-').map(|end| parse_number(end.trim())).collect();
        match ends[..] {
            [Some(one)] => numbers.push(one),
            [Some(first), Some(last)] if first.chapter == last.chapter => {
                let chapter = first.chapter;
                numbers.extend((first.index..=last.index).map(|index| Number { chapter, index }));
            }
            // Prose, a section number, a value: not a citation.
            _ => return Vec::new(),
        }
    }
    numbers
}

/// Equations that code cites although their row says "not yet".
fn check_citations(file: &str, source: &str, rows: &[Row]) -> Vec<String> {
    citations(source)
        .into_iter()
        .filter(|n| rows.iter().any(|row| row.number == Some(*n) && row.items.is_empty()))
        .map(|n| format!("{file} cites {n}, which docs/equations.md calls \"{NOT_YET}\""))
        .collect()
}

/// Cases that an erratum says it is "shown by".
fn shown_by(errata: &str) -> Vec<String> {
    let after = errata.split("shown by `").skip(1);
    after.filter_map(|rest| Some(rest.split_once('`')?.0.to_owned())).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn relative(root: &Path, file: &Path) -> String {
    file.strip_prefix(root).unwrap_or(file).display().to_string()
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for path in entries.map(|entry| entry.expect("a readable folder entry").path()) {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn rows() -> Vec<Row> {
    parse_table(&read(&root().join("docs/equations.md")))
        .unwrap_or_else(|problems| panic!("docs/equations.md\n{}", problems.join("\n")))
}

fn assert_none(problems: Vec<String>) {
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

#[test]
fn every_numbered_equation_appears_once() {
    assert_none(check_numbers(&rows()));
}

#[test]
fn restated_equations_share_the_first_ones_item() {
    assert_none(check_same_as(&rows()));
}

#[test]
fn named_items_and_cases_exist() {
    assert_none(check_places(root(), &rows()));
}

#[test]
fn every_case_calls_the_items_of_its_rows() {
    assert_none(check_calls(root(), &rows()));
}

#[test]
fn errata_are_shown_by_cases_that_exist() {
    let cases = shown_by(&read(&root().join("docs/errata.md")));
    assert!(!cases.is_empty(), "no \"shown by\" found: the scanner is blind");
    let exists = |case: &String| root().join("verification").join(case).join("case.rs").is_file();
    assert_none(cases.into_iter().filter(|case| !exists(case)).collect());
}

#[test]
fn code_cites_no_equation_called_not_yet() {
    let rows = rows();
    let files = rust_files(&root().join("src"));
    let cited: usize = files.iter().map(|file| citations(&read(file)).len()).sum();
    assert!(cited > 0, "no citation found in {} files: the scanner is blind", files.len());
    let check = |file: &PathBuf| check_citations(&relative(root(), file), &read(file), &rows);
    assert_none(files.iter().flat_map(check).collect());
}

mod checks_catch {
    use super::*;

    fn table(lines: &[&str]) -> Vec<Row> {
        parse_table(&lines.join("\n")).expect("a well-formed table")
    }

    #[test]
    fn malformed_rows() {
        let bad = [
            "| (2.1) | law | not yet | not yet |",
            "| (2.x) | law | not yet | not yet | – |",
            "| (2.1) | law | maybe | not yet | – |",
            "| (2.1) | law | not yet | `` | – |",
            "| (2.1) | law | not yet | not yet | 2.1 |",
            "| (2.1) |  | not yet | not yet | – |",
        ];
        for line in bad {
            assert!(parse_table(line).is_err(), "{line}");
        }
    }

    #[test]
    fn a_missing_a_double_and_an_invented_number() {
        let full: Vec<String> = LAST_IN_CHAPTER
            .iter()
            .flat_map(|&(chapter, last)| (1..=last).map(move |index| Number { chapter, index }))
            .map(|number| format!("| {number} | law | not yet | not yet | – |"))
            .collect();
        assert_eq!(full.len(), 55);
        let mut lines: Vec<&str> = full.iter().map(String::as_str).collect();
        assert!(check_numbers(&table(&lines)).is_empty());
        lines.push("| (2.20) | law | not yet | not yet | – |");
        lines[1] = lines[0];
        let expected = ["(2.1) appears 2 times", "(2.2) is missing", "(2.20) is not in the"];
        let problems = check_numbers(&table(&lines));
        assert_eq!(problems.len(), expected.len(), "{problems:?}");
        for (problem, start) in problems.iter().zip(expected) {
            assert!(problem.starts_with(start), "{problem}");
        }
    }

    #[test]
    fn wrong_restatements() {
        let first = "| (2.1) | law | `a::b` | `c` | – |";
        let second = "| (4.1) | law | `a::b` | `c` | (2.1) |";
        assert!(check_same_as(&table(&[first, second])).is_empty());
        let wrong = [
            "| (4.2) | another item | not yet | not yet | (2.1) |",
            "| (4.2) | a chain | `a::b` | `c` | (4.1) |",
            "| (4.2) | no such row | `a::b` | `c` | (2.9) |",
            "| (1.9) | later one | `a::b` | `c` | (2.1) |",
        ];
        for line in wrong {
            let problems = check_same_as(&table(&[first, second, line]));
            assert_eq!(problems.len(), 1, "{line}: {problems:?}");
        }
    }

    #[test]
    fn items_and_cases_that_do_not_exist() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |path: &str, text: &str| {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
            fs::write(path, text).expect("a file");
        };
        write("src/a.rs", "/// Law (2.1).\npub fn law() {}\nfn hidden() {}\n");
        write("src/b/mod.rs", "pub struct Thing;\n");
        write("verification/good/case.rs", "");
        write("verification/empty/README.md", "");
        let problems = |line: &str| check_places(folder.path(), &table(&[line]));
        for good in [
            "| (2.1) | law | `a::law` | `good` | – |",
            "| (4.1) | law | `a::law` | `good` | (2.1) |",
            "| clearance | law | `b::Thing` | `good` | – |",
            "| (2.2) | law | not yet | not yet | – |",
        ] {
            assert_eq!(problems(good), Vec::<String>::new(), "{good}");
        }
        for bad in [
            "| (2.1) | no module | `z::law` | `good` | – |",
            "| (2.1) | no name | `a::lawful` | `good` | – |",
            "| (2.1) | a prefix | `a::la` | `good` | – |",
            "| (2.1) | private | `a::hidden` | `good` | – |",
            "| (2.2) | not cited there | `a::law` | `good` | – |",
            "| (2.1) | no folder | `a::law` | `absent` | – |",
            "| (2.1) | no case.rs | `a::law` | `empty` | – |",
            "| (2.1) | no case | `a::law` | not yet | – |",
            "| (2.1) | no item | not yet | `good` | – |",
        ] {
            assert_eq!(problems(bad).len(), 1, "{bad}: {:?}", problems(bad));
        }
    }

    #[test]
    fn cases_that_never_call_their_item() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |path: &str, text: &str| {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
            fs::write(path, text).expect("a file");
        };
        write(
            "src/laws.rs",
            "pub fn law() -> f64 { 1.0 }\npub fn other() { let s = \"law()\"; /* */ }\n\
             pub struct Thing;\nimpl Thing { pub fn new() -> Thing { inner(); Thing }\n\
             pub fn weigh(&self) { law(); } }\nfn inner() { hidden() }\nfn hidden() {}\n\
             pub fn unused() {}\n#[cfg(test)]\nmod tests { fn run() { super::unused(); } }\n",
        );
        write("src/same.rs", "pub fn law() {}\npub fn weigh() {}\n");
        let case = |id: &str, text: &str| write(&format!("verification/{id}/case.rs"), text);
        case("bare", "use lib::laws::law;\nfn run() { law(); }\n");
        case("path", "use lib::laws;\nfn run() { helper() }\nfn helper() { laws::law(); }\n");
        case("method", "use lib::laws::Thing;\nfn run() { let t = Thing::new(); t.weigh(); }\n");
        case("field", "use lib::laws::other;\nfn run() { other(); let x = thing.law; }\n");
        case("comment", "use lib::laws::law;\n// law()\nfn run() { print(\"law()\"); }\n");
        case("unreached", "use lib::laws::law;\nfn run() {}\nfn never() { law(); }\n");
        case("namesake", "use lib::same::law;\nfn run() { law(); }\n");
        write("tests/laws.rs", "use lib::laws::law;\n#[test]\nfn it_holds() { law(); }\n");
        let problems = |item: &str, case: &str| {
            let row = format!("| (2.1) | law | `laws::{item}` | `{case}` | – |");
            check_calls(folder.path(), &table(&[&row])).len()
        };
        for good in ["bare", "path", "method", "tests/laws.rs"] {
            assert_eq!(problems("law", good), 0, "{good}");
        }
        for bad in ["field", "comment", "unreached", "namesake"] {
            assert_eq!(problems("law", bad), 1, "{bad}");
        }
        assert_eq!((problems("Thing", "method"), problems("Thing", "bare")), (0, 1));
        // Through a function of a type, and through a private one; not through a module of tests.
        assert_eq!((problems("hidden", "method"), problems("unused", "method")), (0, 1));
    }

    #[test]
    fn cases_named_in_errata() {
        let text = "| shown by `one`; noted | and shown by `two` | not shown |";
        assert_eq!(shown_by(text), ["one", "two"]);
    }

    #[test]
    fn citations_of_equations_not_yet_there() {
        let rows = table(&[
            "| (2.1) | law | `a::b` | `c` | – |",
            "| (3.13) | law | not yet | not yet | – |",
            "| (3.14) | law | not yet | not yet | – |",
        ]);
        let count = |source: &str| check_citations("file", source, &rows).len();
        assert_eq!(count("/// Stiffness (3.13)."), 1);
        assert_eq!(count("    //! Both (3.13–3.14)."), 2);
        assert_eq!(count("/// Several (2.1, 3.13 and 3.14)."), 2);
        assert_eq!(count("/// Fine (2.1), prose (4.3.1 varies it), a value (3.5 mm)."), 0);
        assert_eq!(count("let x = f(3.13); // (3.14)"), 0);
    }
}
