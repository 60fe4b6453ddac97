//! Lines of an input deck: keywords with parameters, words, labels, numbers.

use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::{Source, decode, excerpt};

/// A keyword line: `*ELEMENT, TYPE=C3D4, ELSET=all`.
pub struct Keyword {
    pub name: String,
    /// Names in capitals, values as written.
    parameters: Vec<(String, String)>,
    pub at: usize,
}

impl Keyword {
    /// A value as written, with its quotes.
    pub fn word(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    /// A value in capitals.
    pub fn choice(&self, name: &str) -> Option<String> {
        self.word(name).map(|word| word.trim_matches('"').trim().to_ascii_uppercase())
    }

    pub fn required(&self, source: &Source, name: &'static str) -> Result<&str, ReadError> {
        self.word(name).filter(|value| !value.is_empty()).ok_or_else(|| {
            let expected = format!("{name}= after *{}", self.name);
            source.error_at(self.at, Problem::Expected { expected, found: String::new() })
        })
    }

    /// The line for messages: `*ELASTIC, TYPE=ORTHO`.
    pub fn text(&self) -> String {
        let mut text = format!("*{}", self.name);
        for (key, value) in &self.parameters {
            text += &format!(", {key}{}{value}", if value.is_empty() { "" } else { "=" });
        }
        excerpt(text.as_bytes())
    }
}

/// Parses a keyword line; a comma at its end continues it on the next line.
pub fn keyword(source: &mut Source, line: &[u8], at: usize) -> Keyword {
    let mut text = decode(line);
    while text.ends_with(',') {
        match source.line() {
            Some(more) => text.push_str(&decode(more)),
            None => break,
        }
    }
    let mut words = words(&text[1..]).into_iter();
    let squeeze =
        |word: &str| word.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
    let name = squeeze(words.next().unwrap_or_default());
    let parameter = |word: &str| {
        let (key, value) = word.split_once('=').unwrap_or((word, ""));
        (squeeze(key), value.trim().to_string())
    };
    Keyword { name, parameters: words.filter(|w| !w.is_empty()).map(parameter).collect(), at }
}

/// Words between commas, without an empty one at the end; a comma within quotes belongs to its word.
pub fn words(text: &str) -> Vec<&str> {
    let mut quoted = false;
    let between = |c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    let mut words: Vec<&str> = text.split(between).map(str::trim).collect();
    if words.len() > 1 && words.last() == Some(&"") {
        words.pop();
    }
    words
}

/// Form in which labels are compared: quotes keep the case of letters, which counts only there.
pub fn key(word: &str) -> String {
    let mut quoted = false;
    let mut key = String::new();
    for c in word.chars() {
        match c {
            '"' => quoted = !quoted,
            c if quoted => key.push(c),
            c => key.push(c.to_ascii_uppercase()),
        }
    }
    key
}

/// A label without its quotes.
pub fn unquoted(word: &str) -> String {
    word.replace('"', "")
}

pub fn label(source: &Source, at: usize, word: &str, what: &'static str) -> Result<u64, ReadError> {
    word.parse().map_err(|_| not_a_number(source, at, word, what))
}

fn not_a_number(source: &Source, at: usize, word: &str, what: &'static str) -> ReadError {
    source.error_at(at, Problem::Number { found: excerpt(word.as_bytes()), what })
}

pub fn coordinate(source: &Source, at: usize, word: &str) -> Result<f64, ReadError> {
    real(word).ok_or_else(|| not_a_number(source, at, word, "a coordinate"))
}

/// A finite number as Fortran reads it: `2.5`, `25D-1`, `25d-1`, `25-1`. A blank is zero.
pub fn real(word: &str) -> Option<f64> {
    if word.is_empty() {
        return Some(0.0);
    }
    word.parse().ok().or_else(|| fortran(word)).filter(|number: &f64| number.is_finite())
}

fn fortran(word: &str) -> Option<f64> {
    let mut text = String::new();
    let mut exponent = false;
    for c in word.chars() {
        let sign = matches!(c, '+' | '-');
        if !exponent && !text.is_empty() && (sign || matches!(c, 'D' | 'd' | 'E' | 'e')) {
            exponent = true;
            text.push('e');
            if sign {
                text.push(c);
            }
        } else if sign || c == '.' || c.is_ascii_digit() {
            text.push(c);
        } else {
            return None;
        }
    }
    text.parse().ok()
}
