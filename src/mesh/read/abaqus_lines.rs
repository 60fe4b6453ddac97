//! Lines of an input deck: keywords with parameters, numbers, members of sets.

use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::{Source, excerpt};
use std::collections::BTreeMap;

/// A keyword line: `*ELEMENT, TYPE=C3D4, ELSET=all`.
pub struct Keyword {
    pub name: String,
    pub parameters: Vec<(String, String)>,
    pub at: usize,
}

impl Keyword {
    pub fn parameter(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    pub fn required(&self, source: &Source, name: &'static str) -> Result<&str, ReadError> {
        self.parameter(name).filter(|value| !value.is_empty()).ok_or_else(|| {
            let expected = format!("{name}= after *{}", self.name);
            source.error_at(self.at, Problem::Expected { expected, found: String::new() })
        })
    }
}

/// Parses a keyword line; a comma at its end continues it on the next line.
pub fn keyword(source: &mut Source, line: &[u8], at: usize) -> Keyword {
    let mut text = String::from_utf8_lossy(line).into_owned();
    while text.ends_with(',') {
        match source.line() {
            Some(more) => text.push_str(&String::from_utf8_lossy(more)),
            None => break,
        }
    }
    let mut words = text[1..].split(',').map(str::trim);
    let squeeze =
        |word: &str| word.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
    let name = squeeze(words.next().unwrap_or_default());
    let parameter = |word: &str| {
        let (key, value) = word.split_once('=').unwrap_or((word, ""));
        (squeeze(key), value.trim().trim_matches('"').to_string())
    };
    Keyword { name, parameters: words.filter(|w| !w.is_empty()).map(parameter).collect(), at }
}

pub fn number<T: std::str::FromStr>(
    source: &Source,
    at: usize,
    word: &str,
    what: &'static str,
) -> Result<T, ReadError> {
    word.parse()
        .map_err(|_| source.error_at(at, Problem::Number { found: excerpt(word.as_bytes()), what }))
}

pub type Sets = BTreeMap<String, Vec<u64>>;

/// Number of members that a line of a set defines: numbers, names of sets, or with GENERATE first, last and
/// step. Computed before any is stored.
pub fn member_count(
    source: &Source,
    at: usize,
    words: &[&str],
    generate: bool,
    sets: &Sets,
) -> Result<usize, ReadError> {
    if !generate {
        let count = |word: &&str| match (word.parse::<u64>(), sets.get(*word)) {
            (Ok(_), _) => Ok(1),
            (Err(_), Some(members)) => Ok(members.len()),
            (Err(_), None) => {
                let problem = Problem::UnknownSet { name: excerpt(word.as_bytes()) };
                Err(source.error_at(at, problem))
            }
        };
        return words.iter().map(count).try_fold(0usize, |sum, n| Ok(sum.saturating_add(n?)));
    }
    for word in words {
        number::<u64>(source, at, word, "a number of GENERATE")?;
    }
    let [first, last, step] = range(words);
    // A range cannot have more members than a file of this size can define.
    let count = last.saturating_sub(first) / step.max(1);
    if step == 0 || last < first || count > source.length() as u64 {
        let found = format!("{first}, {last}, {step}");
        let what = "a range (first, last, step) of numbers in this file";
        return Err(source.error_at(at, Problem::Number { found, what }));
    }
    Ok(count as usize + 1)
}

fn range(words: &[&str]) -> [u64; 3] {
    let mut bounds = [0, 0, 1];
    for (bound, word) in bounds.iter_mut().zip(words) {
        *bound = word.parse().unwrap_or_default();
    }
    bounds
}

/// Adds the members of a line that [`member_count`] has checked.
pub fn extend_set(words: &[&str], generate: bool, name: &str, sets: &mut Sets) {
    let mut tags = Vec::new();
    if generate {
        let [first, last, step] = range(words);
        tags.extend((first..=last).step_by(step as usize));
    } else {
        for word in words {
            match word.parse() {
                Ok(tag) => tags.push(tag),
                Err(_) => tags.extend(sets.get(*word).into_iter().flatten()),
            }
        }
    }
    sets.entry(name.to_string()).or_default().extend(tags);
}
