//! Index of the source: `source_index.toml`, one line for each table, figure and number in the text, and
//! its status in a run.
//!
//! The file holds no status. A line that lists published values takes it from the checks that settle
//! them; of a number that several cases hold (twins), each counted once, the least favourable counts.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::cases;
use crate::judge::Status;
use crate::published::Published;
use crate::report::{CaseReport, CaseStatus};

/// Kind of a line of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Computed by the source's model.
    Result,
    /// What a computation is given.
    Input,
    /// Read off an instrument.
    Measurement,
    /// A drawing, photograph or diagram.
    Picture,
    /// Repeats or follows from another line.
    Derived,
}

/// A table, a figure, or a number in the text.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    pub section: String,
    /// `Table 2.1` or `Fig. 2.1`; empty for a number in the text.
    #[serde(default)]
    pub at: String,
    pub role: Role,
    pub what: String,
    /// How many numbers of results the line prints.
    #[serde(default)]
    pub prints: usize,
    /// Published values compared with it, as `case/id`.
    #[serde(default)]
    pub values: Vec<String>,
    /// Cases that compute it without a printed number, or use the input.
    #[serde(default)]
    cases: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chapter {
    pub number: u32,
    pub title: String,
    /// The source numbers its tables from 1 to this.
    pub tables: usize,
    pub figures: usize,
    pub lines: Vec<Line>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Index {
    #[serde(rename = "chapter")]
    pub chapters: Vec<Chapter>,
}

/// Counts of printed numbers by status, each number once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Numbers {
    pub reproduced: usize,
    pub under_assumption: usize,
    pub fit: usize,
    pub explained: usize,
    pub failed: usize,
    pub not_run: usize,
    pub not_built: usize,
}

impl Numbers {
    /// Counts with their words, the least favourable first.
    pub fn parts(&self) -> [(usize, &'static str); 7] {
        [
            (self.failed, "failed"),
            (self.explained, "explained"),
            (self.fit, "fit"),
            (self.under_assumption, "reproduced under assumption"),
            (self.reproduced, "reproduced"),
            (self.not_run, "not run"),
            (self.not_built, "not built"),
        ]
    }

    pub fn printed(&self) -> usize {
        self.parts().iter().map(|part| part.0).sum()
    }

    pub fn add(&mut self, other: &Numbers) {
        self.reproduced += other.reproduced;
        self.under_assumption += other.under_assumption;
        self.fit += other.fit;
        self.explained += other.explained;
        self.failed += other.failed;
        self.not_run += other.not_run;
        self.not_built += other.not_built;
    }

    fn count(&mut self, status: Option<Status>) {
        *match status {
            None => &mut self.not_run,
            Some(Status::Reproduced) => &mut self.reproduced,
            Some(Status::ReproducedUnderAssumption) => &mut self.under_assumption,
            Some(Status::Fit) => &mut self.fit,
            Some(Status::Explained) => &mut self.explained,
            Some(Status::Pass | Status::Failed) => &mut self.failed,
        } += 1;
    }
}

/// Status of a line in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    pub section: String,
    pub at: String,
    pub role: Role,
    pub what: String,
    /// In words: of numbers, how many came out how.
    pub status: String,
    pub numbers: Numbers,
    /// Cases of the line.
    pub cases: Vec<String>,
    /// Published values compared with it, as `case/id`.
    pub values: Vec<String>,
}

/// Lines of a chapter with their status in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChapterEntries {
    pub number: u32,
    pub title: String,
    pub numbers: Numbers,
    pub lines: Vec<Entry>,
}

impl Index {
    /// The index of this source.
    ///
    /// # Errors
    /// The file is built in, so that an error is a mistake in it; a test reads it.
    pub fn load() -> Result<Index, toml::de::Error> {
        toml::from_str(include_str!("../source_index.toml"))
    }

    pub fn lines(&self) -> impl Iterator<Item = &Line> {
        self.chapters.iter().flat_map(|chapter| &chapter.lines)
    }

    /// Other cases that hold the same published number.
    pub fn twins(&self, case: &str, id: &str) -> Vec<&str> {
        let claim = format!("{case}/{id}");
        let line = self.lines().find(|line| line.values.contains(&claim));
        let parts = line.iter().flat_map(|line| &line.values).filter_map(|name| split(name));
        parts.filter(|part| part.1 == id && part.0 != case).map(|part| part.0).collect()
    }

    /// Status of each line from the cases of a run.
    pub fn judged(&self, cases: &[CaseReport]) -> Vec<ChapterEntries> {
        let chapter = |chapter: &Chapter| {
            let lines: Vec<Entry> = chapter.lines.iter().map(|line| line.judged(cases)).collect();
            let mut numbers = Numbers::default();
            lines.iter().for_each(|line| numbers.add(&line.numbers));
            ChapterEntries { number: chapter.number, title: chapter.title.clone(), numbers, lines }
        };
        self.chapters.iter().map(chapter).collect()
    }
}

/// Numbers of other books and programs, a line for each case and source.
pub fn outside() -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for case in cases::CASES {
        let published = Published::parse(case.published).unwrap_or_default();
        for value in published.values().iter().filter(|value| value.kind.is_some()) {
            let claim = format!("{}/{}", case.id, value.id);
            match lines.iter_mut().find(|line| line.what == value.source) {
                Some(line) => line.values.push(claim),
                None => lines.push(Line {
                    section: String::new(),
                    at: String::new(),
                    role: Role::Result,
                    what: value.source.clone(),
                    prints: 0,
                    values: vec![claim],
                    cases: Vec::new(),
                }),
            }
        }
    }
    lines
}

/// Counts of [`outside`] numbers by status in a run.
pub fn outside_numbers(cases: &[CaseReport]) -> Numbers {
    let mut numbers = Numbers::default();
    outside().iter().for_each(|line| numbers.add(&line.judged(cases).numbers));
    numbers
}

impl Line {
    /// Cases of the line, in the order of the index.
    pub fn carriers(&self) -> Vec<&str> {
        let mut cases: Vec<&str> = Vec::new();
        let claimed = self.values.iter().filter_map(|name| split(name)).map(|part| part.0);
        for case in claimed.chain(self.cases.iter().map(String::as_str)) {
            if !cases.contains(&case) {
                cases.push(case);
            }
        }
        cases
    }

    /// The published numbers that it claims, twins once.
    pub fn distinct(&self) -> usize {
        self.ids().len()
    }

    /// Ids of the published numbers, twins once.
    pub fn ids(&self) -> BTreeSet<&str> {
        self.values.iter().filter_map(|name| split(name)).map(|part| part.1).collect()
    }

    fn judged(&self, cases: &[CaseReport]) -> Entry {
        let mut numbers = Numbers::default();
        for id in self.ids() {
            let of_one = self.values.iter().filter_map(|name| split(name));
            let statuses = of_one
                .filter(|part| part.1 == id)
                .filter_map(|part| settled(cases.iter().find(|case| case.id == part.0)?, id));
            numbers.count(statuses.max_by_key(|status| severity(*status)));
        }
        numbers.not_built = self.prints.saturating_sub(self.distinct());
        Entry {
            section: self.section.clone(),
            at: self.at.clone(),
            role: self.role,
            what: self.what.clone(),
            status: self.status(&numbers, cases),
            numbers,
            cases: self.carriers().into_iter().map(String::from).collect(),
            values: self.values.clone(),
        }
    }

    fn status(&self, numbers: &Numbers, cases: &[CaseReport]) -> String {
        let carriers = self.carriers();
        match self.role {
            Role::Measurement if self.values.is_empty() => return "measurement".into(),
            Role::Picture => return "picture".into(),
            Role::Derived => return "follows from others".into(),
            Role::Input if carriers.is_empty() => return "input, not built".into(),
            Role::Input => return "input".into(),
            _ => (),
        }
        if numbers.printed() > 0 {
            let held: Vec<_> = numbers.parts().into_iter().filter(|part| part.0 > 0).collect();
            return match held[..] {
                [(_, word)] => word.into(),
                _ => {
                    let words = held.iter().map(|(count, word)| format!("{count} {word}"));
                    words.collect::<Vec<_>>().join(", ")
                }
            };
        }
        let statuses = carriers
            .iter()
            .filter_map(|id| cases.iter().find(|case| case.id == *id).map(|case| case.status));
        let statuses: Vec<CaseStatus> =
            statuses.filter(|status| *status != CaseStatus::NotRun).collect();
        match (carriers.is_empty(), statuses.is_empty()) {
            (true, _) => "not built".into(),
            (false, true) => "not run".into(),
            _ if statuses.iter().all(|status| *status == CaseStatus::Passed) => {
                "computed, no number printed".into()
            }
            _ => "failed".into(),
        }
    }
}

/// `case/id` in two.
fn split(claim: &str) -> Option<(&str, &str)> {
    claim.split_once('/')
}

/// How a case settled a published number; absent where it has not run.
pub fn settled(case: &CaseReport, id: &str) -> Option<Status> {
    if case.status == CaseStatus::NotRun {
        return None;
    }
    let checks = case.checks.iter().filter(|check| check.published_id.as_deref() == Some(id));
    let statuses = checks.map(|check| check.status).filter(|status| *status != Status::Pass);
    Some(statuses.max_by_key(|status| severity(*status)).unwrap_or(Status::Failed))
}

/// Rank of a status, the least favourable highest.
pub fn severity(status: Status) -> u8 {
    match status {
        Status::Reproduced | Status::Pass => 0,
        Status::ReproducedUnderAssumption => 1,
        Status::Fit => 2,
        Status::Explained => 3,
        Status::Failed => 4,
    }
}
