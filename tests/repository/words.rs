//! Pages stay short, and pages and sources use the field's words: none contains the private vocabulary that the glossary replaces.

use std::fs;
use std::path::{Path, PathBuf};

/// Words that have a standard term instead, in lower case. Words with a legitimate technical use are not in the list.
const PRIVATE_WORDS: [(&str, &str); 29] = [
    ("told", "reported, printed"),
    ("tells", "reports, prints"),
    ("speaks", "prints"),
    ("foretold", "estimated"),
    ("foretell", "estimate"),
    ("foretells", "estimates"),
    ("crooked", "asymmetric"),
    ("sways", "oscillates"),
    ("swing", "oscillation"),
    ("swings", "oscillates"),
    ("swinging", "oscillating"),
    ("sits", "is mounted on"),
    ("hardly", "a number"),
    ("whence", "from which"),
    ("nowhere", "a range"),
    ("handed on", "wrench on the body"),
    ("takes hold", "attachment"),
    ("take hold", "attachment"),
    ("natural shape", "mode"),
    ("natural shapes", "modes"),
    ("so many times", "factor, ratio"),
    ("in the place of", "instead of"),
    ("of no real part", "a number"),
    ("without a word", "without a warning"),
    ("course", "quasi-static sequence"),
    ("crew", "thread pool"),
    ("sway", "oscillate"),
    ("remark", "warning"),
    ("remarks", "warnings"),
];

/// Most lines of a page. Guides have 120.
const MOST_LINES: [(&str, usize); 4] = [
    ("README.md", 150),
    ("docs/benchmarks.md", 150),
    ("docs/results.md", 150),
    ("docs/decisions.md", 300),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn markdown_in(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).expect(folder);
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "md"));
    files.sort();
    files
}

/// Private words in `text` between characters that are no part of a word, with line numbers.
fn private_words(text: &str) -> Vec<(usize, &'static str, &'static str)> {
    let in_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.to_lowercase();
        for (word, instead) in PRIVATE_WORDS {
            let whole = |(at, _): (usize, &str)| {
                !line[..at].ends_with(in_word) && !line[at + word.len()..].starts_with(in_word)
            };
            if line.match_indices(word).any(whole) {
                found.push((number + 1, word, instead));
            }
        }
    }
    found
}

fn rust_files_in(folder: &Path, to: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("src").map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            rust_files_in(&entry, to);
        } else {
            to.push(entry);
        }
    }
}

/// Pages, and all of `src`: comments, messages and names that are a word of their own.
#[test]
fn pages_and_sources_use_the_words_of_the_field() {
    let mut files = vec![root().join("README.md"), root().join("ARCHITECTURE.md")];
    files.extend(markdown_in("docs"));
    files.extend(markdown_in("docs/guide"));
    rust_files_in(&root().join("src"), &mut files);
    let mut faults = Vec::new();
    for file in files {
        for (line, word, instead) in private_words(&fs::read_to_string(&file).unwrap()) {
            faults.push(format!("{}:{line}: \"{word}\": write {instead}", file.display()));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn private_words_are_found_whole() {
    let found = private_words("Stolds.\nIt is Told, and retold; natural shapes");
    let words: Vec<_> = found.iter().map(|(line, word, _)| (*line, *word)).collect();
    assert_eq!(words, [(2, "told"), (2, "natural shapes")]);
}

#[test]
fn pages_are_short() {
    let guides = markdown_in("docs/guide").into_iter().map(|page| (page, 120));
    let others = MOST_LINES.into_iter().map(|(page, most)| (root().join(page), most));
    for (page, most) in others.chain(guides) {
        let lines = fs::read_to_string(&page).unwrap().lines().count();
        assert!(lines <= most, "{}: {lines} lines, at most {most}", page.display());
    }
}

/// The README has the counts of published numbers that docs/verification.md has, each before its status: `(*fit*)`.
#[test]
fn counts_of_published_numbers_agree() {
    let [page, readme] = ["docs/verification.md", "README.md"]
        .map(|file| fs::read_to_string(root().join(file)).expect(file));
    let counts = page.lines().find_map(|line| line.strip_prefix("The source prints "));
    let counts = counts.expect("a line of counts in docs/verification.md");
    for count in counts.split_once(": ").expect("counts").1.trim_end_matches('.').split(", ") {
        let (number, status) = count.split_once(' ').expect("a number and a status");
        let before = readme.split(&format!("(*{status}*)")).next().expect("text");
        let clause = before.rsplit("*)").next().expect("text");
        let last = clause.split_whitespace().rfind(|word| word.parse::<u32>().is_ok());
        assert_eq!(last, Some(number), "README.md, {status}");
    }
    let total = counts.split(' ').next().expect("a total");
    assert!(readme.contains(&format!("The dissertation prints {total} numbers as results.")));
}
