//! The sources of the cases: each reads its published numbers in one place, no oracle sees what it
//! judges.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use verification::index::{self, Index, Line, Role};
use verification::published::{Published, PublishedValue};
use verification::report::format;
use verification::{cases, golden, page};

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

#[test]
fn what_reads_a_clock_runs_by_itself() {
    for case in cases::CASES {
        let sources = fs::read_dir(folder().join(case.id)).unwrap();
        let sources = sources.map(|entry| entry.unwrap().path());
        let reads = |path: &Path| {
            let text = fs::read_to_string(path).unwrap();
            ["Instant", "Stopwatch", ".seconds"].iter().any(|word| text.contains(word))
        };
        let times = sources
            .filter(|path| path.extension().is_some_and(|ending| ending == "rs"))
            .any(|path| reads(&path));
        assert_eq!(times, cases::is_timed(case.id), "{}", case.id);
    }
}

/// A case is computed by a function that is given no published number (`case::Computation`). Here it
/// is seen that none of them, and no helper of theirs, fetches one: the file is named once, as the
/// field of the case, and code that computes reads no file at all.
#[test]
fn our_numbers_do_not_depend_on_the_published_ones() {
    let sources = sources_of_cases();
    for (name, code) in &sources {
        assert_eq!(reaches_for_published(code, name.ends_with("/case.rs")), None, "{name}");
    }
    let seen = sources.len();
    assert!(seen > 2 * cases::CASES.len(), "only {seen} files seen");
}

/// Name and text of every file that computes.
fn sources_of_cases() -> Vec<(String, String)> {
    let mut pending = vec![folder()];
    let mut found = Vec::new();
    while let Some(place) = pending.pop() {
        for entry in fs::read_dir(&place).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder()).unwrap().to_string_lossy().replace('\\', "/");
            if path.is_dir() {
                if !path.ends_with("tests") {
                    pending.push(path);
                }
            } else if name.ends_with(".rs") && !FRAMEWORK.iter().any(|of| name.starts_with(of)) {
                found.push((name, fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found
}

/// What reads, judges and reports published numbers; none of it computes.
const FRAMEWORK: [&str; 21] = [
    // Runs another program; the case has no published numbers.
    "calculix_comparison/program.rs",
    "build.rs",
    // Records of finished cases, and hashes of sources.
    "src/cache.rs",
    "src/sources.rs",
    "src/case.rs",
    "src/check.rs",
    "src/golden.rs",
    // The index of the source, and figures of the README.
    "src/index.rs",
    "src/readme.rs",
    "src/judge.rs",
    "src/date.rs",
    "src/lib.rs",
    "src/machine.rs",
    "src/main.rs",
    "src/mutants",
    "src/page.rs",
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

/// Every published value by `case/id`.
fn published_values() -> BTreeMap<String, PublishedValue> {
    let values = cases::CASES.iter().flat_map(|case| {
        let published = Published::parse(case.published).unwrap();
        let named = |value: &PublishedValue| (format!("{}/{}", case.id, value.id), value.clone());
        published.values().iter().map(named).collect::<Vec<_>>()
    });
    values.collect()
}

/// What breaks the source's own numbering: each table and figure once, from 1 without a gap, sections in
/// order.
fn out_of_order(index: &Index) -> Vec<String> {
    let mut problems = Vec::new();
    for chapter in &index.chapters {
        for (word, count) in [("Table", chapter.tables), ("Fig.", chapter.figures)] {
            let there: Vec<&str> = chapter
                .lines
                .iter()
                .map(|line| line.at.as_str())
                .filter(|at| at.starts_with(word))
                .collect();
            let all: Vec<String> =
                (1..=count).map(|n| format!("{word} {}.{n}", chapter.number)).collect();
            if there != all {
                problems.push(format!("{word}s of chapter {}: {there:?}", chapter.number));
            }
        }
        let section = |line: &Line| -> Vec<u32> {
            line.section.split('.').map(|part| part.parse().unwrap_or(0)).collect()
        };
        for (line, next) in chapter.lines.iter().zip(chapter.lines.iter().skip(1)) {
            if section(next) < section(line) {
                problems.push(format!("{} after {}", next.section, line.section));
            }
        }
        for line in &chapter.lines {
            let known =
                line.at.is_empty() || line.at.starts_with("Table ") || line.at.starts_with("Fig. ");
            if !known || section(line).first() != Some(&chapter.number) || line.what.is_empty() {
                problems.push(format!("line `{}` {} {}", line.at, line.section, line.what));
            }
        }
    }
    problems
}

#[test]
fn the_index_follows_the_numbering_of_the_source() {
    let index = Index::load().unwrap();
    assert_eq!(out_of_order(&index), [""; 0]);
    let chapters: Vec<(u32, usize, usize)> =
        index.chapters.iter().map(|c| (c.number, c.tables, c.figures)).collect();
    // Captions of the printed text; chapters 1 and 6 have none.
    assert_eq!(chapters, [(2, 4, 27), (3, 7, 34), (4, 3, 23), (5, 4, 34)]);
}

/// What is wrong with the claims of the index on published values.
fn wrong_claims(index: &Index, values: &BTreeMap<String, PublishedValue>) -> Vec<String> {
    let mut problems = Vec::new();
    let mut claimed = BTreeSet::new();
    for line in index.lines() {
        let place = format!("{} {} {}", line.section, line.at, line.what);
        for case in line.carriers() {
            if cases::find(case).is_none() {
                problems.push(format!("{place}: there is no case `{case}`"));
            }
        }
        let may_print = matches!(line.role, Role::Result | Role::Measurement);
        if line.distinct() > line.prints || line.prints > 0 && !may_print {
            problems.push(format!("{place}: prints {}, claims {}", line.prints, line.distinct()));
        }
        for claim in &line.values {
            if !claimed.insert(claim.clone()) {
                problems.push(format!("{place}: `{claim}` is claimed twice"));
            }
            if !values.contains_key(claim) {
                problems.push(format!("{place}: there is no published value `{claim}`"));
            }
        }
        // Twins: one number in two cases has one id, one value, one unit and one source.
        let here = || line.values.iter().filter_map(|claim| Some((claim, values.get(claim)?)));
        for (one, value) in here() {
            for (other, twin) in here().filter(|(other, _)| *other > one) {
                let same_number = (value.value, &value.unit, &value.source, &value.quantity)
                    == (twin.value, &twin.unit, &twin.source, &twin.quantity);
                if same_number != (value.id == twin.id) {
                    problems
                        .push(format!("{place}: `{one}` and `{other}`: the same number or not?"));
                }
            }
        }
    }
    let own = values.iter().filter(|(_, value)| value.kind.is_none()).map(|(name, _)| name);
    let unclaimed = own.filter(|name| !claimed.contains(*name));
    problems.extend(unclaimed.map(|name| format!("no line of the index claims `{name}`")));
    problems
}

#[test]
fn each_published_value_stands_on_one_line_of_the_index() {
    let index = Index::load().unwrap();
    let values = published_values();
    assert!(values.len() > 20);
    assert_eq!(wrong_claims(&index, &values), [""; 0]);
}

/// Published numbers that stand in code, and why they may: case or helper, number, reason. An entry that
/// nothing needs is an error.
const TYPED: &[(&str, f64, &str)] = &[
    (
        "rubber_cube_2_3_1/case.rs",
        1245.0,
        "a stress of Bergström and Boyce's model, not a speed of Table 5.1",
    ),
    (
        "cage_speed_table_5_4/case.rs",
        -29.5,
        "how far a cage's speed is from the printed one, not a displacement of Table 4.3",
    ),
    (
        "rubber_load_rates_2_4_3/case.rs",
        30.0,
        "where the run of the scene ends, an input; computed is when the courses come together",
    ),
    (
        "cylinder_on_block_table_2_1/case.rs",
        0.134,
        "another program's -27.8 and 13.4 %, not a tilt of Table 3.7",
    ),
    (
        "cylinder_on_block_table_2_1/case.rs",
        0.203,
        "a gap of 20.3 % between two states of stress, not a displacement of Table 4.3",
    ),
    (
        "kinematic_frequencies/case.rs",
        0.217,
        "217 of 255: a colour, not a damping ratio of Table 3.3",
    ),
    ("src/surface_picture.rs", 0.132, "132 of 255: a colour, not a damping ratio of Table 3.3"),
    ("outside_bearings/case.rs", 1.0, "ones of formulas, not coefficients of a circular contact"),
    ("outside_bearings/oracle.rs", 1.0, "ones of formulas, not coefficients of a circular contact"),
    (
        "src/bushings.rs",
        2.42e6,
        "2.42 s, a relaxation time of Table 3.1, not a stiffness of Table 3.3",
    ),
];

/// Number literals of code, without comments and text, with their lines.
fn literals(code: &str) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    let mut text = code.chars().peekable();
    let (mut line, mut word) = (1, String::new());
    let mut keep = |word: &mut String, line: usize| {
        let bare = word.replace('_', "");
        let bare = ["f64", "usize", "u32", "i32", "u64"]
            .iter()
            .find_map(|end| bare.strip_suffix(end))
            .unwrap_or(&bare);
        if word.starts_with(|c: char| c.is_ascii_digit())
            && let Ok(value) = bare.trim_end_matches('.').parse::<f64>()
        {
            found.push((line, value));
        }
        word.clear();
    };
    while let Some(c) = text.next() {
        let exponent = word.starts_with(|c: char| c.is_ascii_digit()) && word.ends_with(['e', 'E']);
        match c {
            '/' if text.peek() == Some(&'/') => {
                keep(&mut word, line);
                while text.peek().is_some_and(|c| *c != '\n') {
                    text.next();
                }
            }
            '"' => {
                keep(&mut word, line);
                while let Some(c) = text.next() {
                    match c {
                        '\\' => line += usize::from(text.next() == Some('\n')),
                        '"' => break,
                        _ => line += usize::from(c == '\n'),
                    }
                }
            }
            '.' if !word.starts_with(|c: char| c.is_ascii_digit())
                || word.contains('.')
                || text.peek() == Some(&'.') =>
            {
                keep(&mut word, line);
            }
            _ if c.is_ascii_alphanumeric() || c == '_' || c == '.' => word.push(c),
            '+' | '-' if exponent => word.push(c),
            _ => {
                keep(&mut word, line);
                line += usize::from(c == '\n');
            }
        }
    }
    keep(&mut word, line);
    found
}

/// Where published numbers stand in a file's code, as they are or in another unit. Numbers of less than
/// three digits are too common to tell: they count in the case that publishes them only, and as printed.
fn typed(
    name: &str,
    code: &str,
    values: &BTreeMap<String, PublishedValue>,
) -> Vec<(usize, f64, String)> {
    let mut found = Vec::new();
    for (line, literal) in literals(code) {
        for (claim, value) in values {
            let digits =
                value.value.to_string().chars().filter(char::is_ascii_digit).collect::<String>();
            let scales: &[f64] = match digits.trim_start_matches('0').trim_end_matches('0').len() {
                0..3 if name.split('/').next() != claim.split('/').next() => &[],
                0..3 => &[1.0],
                _ => &[1.0, 1e3, 1e6, 1e9, 1e-3, 1e-6, 1e-9],
            };
            let meets = |scale: &f64| {
                let there = scale * value.value.abs();
                (literal - there).abs() <= 4.0 * f64::EPSILON * there
            };
            if scales.iter().any(meets) {
                found.push((line, value.value, claim.clone()));
            }
        }
    }
    found
}

/// A case computes without knowing what is published: no such number stands in its code.
#[test]
fn no_published_number_is_typed_into_a_case() {
    let values = published_values();
    let mut used = BTreeSet::new();
    let mut problems = Vec::new();
    for (name, code) in sources_of_cases() {
        for (line, value, claim) in typed(&name, &code, &values) {
            match TYPED.iter().position(|entry| entry.0 == name && entry.1 == value) {
                Some(entry) => drop(used.insert(entry)),
                None => problems.push(format!("{name}:{line}: {value} is `{claim}`")),
            }
        }
    }
    assert_eq!(problems, [""; 0]);
    for (index, (name, value, reason)) in TYPED.iter().enumerate() {
        assert!(used.contains(&index), "{name}: {value} ({reason}) stands there no longer");
        assert!(!reason.is_empty());
    }
}

/// Every published number has its row in docs/verification.md, with the printed value, and with the accepted
/// number where a golden file holds it.
#[test]
fn the_page_holds_every_published_number() {
    let page = std::fs::read_to_string(page::path()).unwrap();
    let rows = page::rows(&page);
    let index = Index::load().unwrap();
    let values = published_values();
    let mut shown = 0;
    let outside = index::outside();
    for line in index.lines().chain(&outside) {
        for id in line.ids() {
            let claims = line.values.iter().filter(|claim| claim.ends_with(&format!("/{id}")));
            let named: Vec<&String> = claims.filter(|claim| rows.contains_key(*claim)).collect();
            let [claim] = named[..] else { panic!("{id}: {} rows in the page", named.len()) };
            let (row, value) = (&rows[claim], &values[claim]);
            let unit = format::unit(&value.unit);
            let number = |text: &str| -> f64 {
                let text = text.strip_suffix(&unit).unwrap_or(text).replace('−', "-");
                text.parse().unwrap_or_else(|_| panic!("{claim}: `{text}`"))
            };
            let near = |text: &str, value: f64| (number(text) - value).abs() <= 6e-4 * value.abs();
            assert!(near(&row.published, value.value), "{claim}: {row:?}");
            let case = claim.split('/').next().unwrap();
            let golden = golden::read(&golden::default_folder(), case).unwrap();
            // A number that the case pins under its id is pinned as the page shows it, whichever check that is.
            let pinned = golden.map_or(Vec::new(), |file| file.values);
            let holds = |value: f64| near(&row.ours, value);
            let named = pinned.iter().any(|v| v.name == id && v.unit == value.unit);
            assert!(!named || pinned.iter().any(|v| holds(v.value)), "{claim}: {row:?}");
            shown += 1;
        }
    }
    assert_eq!(rows.len(), shown, "rows without a number of the source");
}
