//! Verdicts: kept from run to run, and written for people.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::list::List;

/// What became of a fault.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// By a check that the list names for it.
    Caught { by: String },
    /// By one of the fallback's checks: the list should name it.
    CaughtElsewhere { by: String },
    /// By none.
    Survived,
}

impl Verdict {
    pub fn words(&self) -> String {
        match self {
            Verdict::Caught { by } => format!("caught by {by}"),
            Verdict::CaughtElsewhere { by } => format!("caught, but only by {by}"),
            Verdict::Survived => "SURVIVED".into(),
        }
    }
}

/// A verdict and what it rests on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    pub id: String,
    /// Hash of the library, the fault and the checks named for it.
    pub key: String,
    pub verdict: Verdict,
    pub seconds: f64,
}

/// All verdicts so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Results {
    pub outcomes: Vec<Outcome>,
    /// Checks that pass without any fault.
    pub proven: Vec<Proof>,
}

/// A check that passes without any fault.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Proof {
    /// Hash of the library and the check.
    pub key: String,
    /// What its program took to run.
    pub seconds: f64,
}

impl Results {
    /// Those of an earlier run; none where there is nothing usable.
    pub fn read(folder: &Path) -> Results {
        fs::read_to_string(folder.join("results.json"))
            .ok()
            .and_then(|text| serde_json::from_str(&text).ok())
            .unwrap_or_default()
    }

    /// Whether this fault has been caught already, in these very sources. Other verdicts rest on
    /// all checks there are, and are not kept.
    pub fn holds(&self, id: &str, key: &str) -> bool {
        self.outcomes.iter().any(|outcome| {
            outcome.id == id
                && outcome.key == key
                && matches!(outcome.verdict, Verdict::Caught { .. })
        })
    }

    pub fn proof(&self, key: &str) -> Option<&Proof> {
        self.proven.iter().find(|proof| proof.key == key)
    }

    pub fn verdict(&self, id: &str) -> Option<&Verdict> {
        self.outcomes.iter().find(|outcome| outcome.id == id).map(|outcome| &outcome.verdict)
    }

    pub fn keep(&mut self, outcome: Outcome) {
        self.outcomes.retain(|other| other.id != outcome.id);
        self.outcomes.push(outcome);
    }

    /// Writes `results.json` and `report.md`, each whole or not at all.
    ///
    /// # Errors
    /// In words, when a file cannot be written.
    pub fn write(&self, folder: &Path, list: &List) -> Result<(), String> {
        let json = serde_json::to_string_pretty(self).map_err(|error| error.to_string())?;
        for (name, text) in [("results.json", json), ("report.md", self.markdown(list))] {
            let partial = folder.join(format!("{name}.partial"));
            fs::write(&partial, text)
                .and_then(|()| fs::rename(&partial, folder.join(name)))
                .map_err(|error| format!("{}: {error}", partial.display()))?;
        }
        Ok(())
    }

    fn markdown(&self, list: &List) -> String {
        let of = |wanted: fn(&Verdict) -> bool| {
            let found = |id: &str| self.verdict(id).is_some_and(wanted);
            list.mutants.iter().filter(|mutant| found(&mutant.id)).count()
        };
        let survived = of(|verdict| *verdict == Verdict::Survived);
        let elsewhere = of(|verdict| matches!(verdict, Verdict::CaughtElsewhere { .. }));
        let caught = of(|verdict| matches!(verdict, Verdict::Caught { .. })) + elsewhere;
        let all = list.mutants.len();
        let mut text = String::from("# Seeded faults\n\n");
        let _ = writeln!(
            text,
            "{caught} of {all} caught ({elsewhere} of them by a check the list does not name), \
             {survived} survived, {} not run yet.\n",
            all - caught - survived
        );
        text += "| fault | in | what is wrong | verdict | s |\n|---|---|---|---|---|\n";
        for mutant in &list.mutants {
            let outcome = self.outcomes.iter().find(|outcome| outcome.id == mutant.id);
            let (verdict, seconds) = outcome.map_or(("not run yet".into(), String::new()), |o| {
                (o.verdict.words(), format!("{:.0}", o.seconds))
            });
            let (id, file, breaks) = (&mutant.id, &mutant.file, &mutant.breaks);
            let _ = writeln!(text, "| {id} | {file} | {breaks} | {verdict} | {seconds} |");
        }
        text
    }
}
