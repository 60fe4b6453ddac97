//! Figures of the repository's README that come from a run: between `<!-- FORM SOURCE DIGITS -->` and
//! `<!-- -->`, neither of which a reader sees. Each run of a case holds those of its checks, a test those of
//! `golden/`, so that none goes stale.
//!
//! | form | source | shows |
//! |---|---|---|
//! | `error` | `case/check` | relative error, signed, in percent; the largest where the id ends in `*` |
//! | `size` | `case/check` | the same without sign |
//! | `below` | `case/check` | the power of ten above the error: rounding differs between machines |
//! | `miss` | `case/check` | size of the error in the check's unit |
//! | `value` | `case/name` | the pinned number and its unit |
//! | `ratio` | `case/name~other` | one pinned number over another, less one, signed, in percent |
//!
//! An error of a check against zero is the check's own number.

use crate::golden::GoldenFile;
use crate::judge::CheckReport;
use crate::report::format::{significant, unit};

/// A figure as the text holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    pub form: String,
    pub case: String,
    /// A check, or a pinned number; `*` at its end stands for any rest.
    pub name: String,
    pub digits: usize,
    pub text: String,
}

const END: &str = "<!-- -->";
const FORMS: [&str; 6] = ["error", "size", "below", "miss", "value", "ratio"];

/// The repository's README as it is now.
///
/// # Errors
/// Why it cannot be read.
pub fn text() -> Result<String, String> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../README.md");
    std::fs::read_to_string(path).map_err(|error| format!("README.md: {error}"))
}

/// The figures of a text, in its order.
///
/// # Errors
/// A mark that is not closed, or whose source or digits cannot be read.
pub fn figures(text: &str) -> Result<Vec<Figure>, String> {
    let mut found = Vec::new();
    for piece in text.split("<!-- ").skip(1) {
        let Some((mark, rest)) = piece.split_once(" -->") else { continue };
        let words: Vec<&str> = mark.split(' ').collect();
        if !words.first().is_some_and(|word| FORMS.contains(word)) {
            continue;
        }
        let [form, source, digits] = words[..] else {
            return Err(format!("`{mark}` is not a form, a source and digits"));
        };
        let (case, name) =
            source.split_once('/').ok_or_else(|| format!("`{source}` is not case/name"))?;
        let digits = digits.parse().map_err(|_| format!("`{digits}` digits in `{mark}`"))?;
        found.push(Figure {
            form: form.into(),
            case: case.into(),
            name: name.into(),
            digits,
            text: rest.into(),
        });
    }
    // What stands between a mark and its end; `split` has cut the end's own opening off.
    let ends = text.matches(END).count();
    if ends != found.len() {
        return Err(format!("{} figures begin, {ends} end", found.len()));
    }
    Ok(found)
}

/// What a text says of a case's checks and is not so, or not so any more.
pub fn stale(text: &str, case: &str, checks: &[CheckReport]) -> Vec<String> {
    let figures = match figures(text) {
        Ok(figures) => figures,
        Err(error) => return vec![format!("README: {error}")],
    };
    let own = figures.iter().filter(|figure| figure.case == case && !figure.is_pinned());
    own.filter_map(|figure| figure.stale(figure.from_checks(checks))).collect()
}

impl Figure {
    /// What is wrong, where `now` should stand there.
    pub fn stale(&self, now: Result<String, String>) -> Option<String> {
        match now {
            Ok(text) if text == self.text => None,
            Ok(text) => Some(format!(
                "{} {}: README says {}, it is {text}",
                self.form,
                self.source(),
                self.text
            )),
            Err(error) => Some(format!("README: {error}")),
        }
    }

    /// Whether the figure comes from `golden/`, else from checks of a run.
    pub fn is_pinned(&self) -> bool {
        ["value", "ratio"].contains(&self.form.as_str())
    }

    /// What should stand there, by a case's checks.
    ///
    /// # Errors
    /// No check of that name, or one without an error.
    pub fn from_checks(&self, checks: &[CheckReport]) -> Result<String, String> {
        let named = |check: &&CheckReport| match self.name.strip_suffix('*') {
            Some(start) => check.id.starts_with(start),
            None => check.id == self.name,
        };
        let mut largest: Option<(f64, &CheckReport)> = None;
        for check in checks.iter().filter(named) {
            let error = match (self.form.as_str(), check.reference) {
                ("miss", _) | (_, Some(0.0)) => check.error_absolute,
                _ => check.error_relative,
            };
            let error = error.ok_or_else(|| format!("{} has no error", self.source()))?;
            if largest.is_none_or(|(other, _)| error.abs() > other.abs()) {
                largest = Some((error, check));
            }
        }
        let (error, check) = largest.ok_or_else(|| format!("no check {}", self.source()))?;
        Ok(match self.form.as_str() {
            "below" => format!("< {}", power_above(error.abs())),
            "miss" => format!("{}{}", significant(error.abs(), self.digits), unit(&check.unit)),
            "size" => self.percent(error.abs()),
            _ => self.signed_percent(error),
        })
    }

    /// What should stand there, by a case's pinned numbers.
    ///
    /// # Errors
    /// No number of that name.
    pub fn from_golden(&self, file: &GoldenFile) -> Result<String, String> {
        let pinned = |name: &str| {
            let value = file.values.iter().find(|value| value.name == name);
            value.ok_or_else(|| format!("{}/{name} is not pinned", self.case))
        };
        match self.name.split_once('~') {
            Some((one, other)) => {
                Ok(self.signed_percent(pinned(one)?.value / pinned(other)?.value - 1.0))
            }
            None => {
                let value = pinned(&self.name)?;
                Ok(format!("{}{}", significant(value.value, self.digits), unit(&value.unit)))
            }
        }
    }

    pub fn source(&self) -> String {
        format!("{}/{}", self.case, self.name)
    }

    fn percent(&self, fraction: f64) -> String {
        format!("{} %", significant(100.0 * fraction, self.digits))
    }

    fn signed_percent(&self, fraction: f64) -> String {
        format!("{}{}", if fraction > 0.0 { "+" } else { "" }, self.percent(fraction))
    }
}

/// The power of ten above a size; zero counts as below rounding.
fn power_above(size: f64) -> String {
    let exponent = if size > 0.0 { size.log10().floor() as i32 + 1 } else { -15 };
    format!("1e{exponent}")
}
