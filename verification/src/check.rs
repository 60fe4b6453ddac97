//! A check as a case states it: our number, its reference, the tolerance and its reason.

use serde::{Deserialize, Serialize};

use crate::golden::GoldenTolerance;
use crate::number;

/// Reference of our number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reference {
    /// An entry of the case's `published.toml`, by id; its value is looked up after the run.
    Published(String),
    /// Anything the case can compute or cite itself, with a word on where it comes from.
    Computed {
        kind: ReferenceKind,
        #[serde(with = "number")]
        value: f64,
        origin: String,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReferenceKind {
    /// Printed in the source.
    Published,
    /// Printed in another book, a paper or a standard.
    Book,
    /// Published output of another program.
    OtherProgram,
    /// A published number; a one-sided limit shows why our number differs.
    Evidence,
    /// A formula evaluated separately from the law it judges.
    ClosedForm,
    /// The limit of a refinement, or a solution fine enough to count as one.
    Converged,
    /// Another method or program that shares no code with ours.
    Independent,
    /// Another method of this program: both may be wrong.
    Consistency,
    /// A threshold or an order taken from a sentence of the source, which prints no number for it.
    Stated,
}

/// How closely our number must agree. The error is ours − reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Tolerance {
    /// |error| ≤ tolerance · |reference|.
    Relative(#[serde(with = "number")] f64),
    /// |error| ≤ tolerance, in the check's unit.
    Absolute(#[serde(with = "number")] f64),
    /// |error| ≤ half of the last printed place (`rounding` of the published value).
    Printed,
    /// ours ≥ reference + margin, in the check's unit.
    AtLeast {
        #[serde(with = "number")]
        margin: f64,
    },
    /// ours ≤ reference − margin, in the check's unit.
    AtMost {
        #[serde(with = "number")]
        margin: f64,
    },
}

/// Why a published number differs from ours, and what shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    /// What the published number is instead.
    pub text: String,
    /// The difference as we know it, signed (ours − published): relative to the published value
    /// where the check's tolerance is relative, else in the check's unit.
    pub gap: f64,
    /// How far the difference may stray from `gap` before the explanation counts as stale.
    pub gap_tolerance: f64,
    /// Ids of checks, figures, tables and findings of the same case; at least one is a check,
    /// and all checks among them must hold.
    pub evidence: Vec<String>,
}

impl Explanation {
    pub fn new(text: &str, gap: f64, gap_tolerance: f64, evidence: &[&str]) -> Explanation {
        Explanation {
            text: text.to_string(),
            gap,
            gap_tolerance,
            evidence: evidence.iter().map(|id| id.to_string()).collect(),
        }
    }
}

/// A check under construction. It needs an id, a reference and a tolerance with its reason;
/// anything missing fails the case.
///
/// ```
/// use verification::check::Check;
/// use verification::golden::GoldenTolerance;
///
/// let check = Check::new("moment_0p15", "moment at 0.15° tilt", "N·m", 6.421)
///     .published("moment_0p15")
///     .under("radial_clearance")
///     .relative(0.005, "three printed digits; clearance identified to 0.1 µm")
///     .golden(GoldenTolerance::REORDERED);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[must_use = "hand it to CaseContext::check"]
pub struct Check {
    pub id: String,
    pub quantity: String,
    pub unit: String,
    #[serde(with = "number")]
    pub ours: f64,
    pub reference: Option<Reference>,
    pub tolerance: Option<Tolerance>,
    pub reason: String,
    pub assumption: Option<String>,
    pub explanation: Option<Explanation>,
    /// What was fitted to what, where our number meets the published one because it was made to.
    pub fit: Option<String>,
    pub golden: Option<GoldenTolerance>,
}

impl Check {
    /// `id` is unique within the case; `unit` is `"1"` for a pure number.
    pub fn new(id: &str, quantity: &str, unit: &str, ours: f64) -> Check {
        Check {
            id: id.to_string(),
            quantity: quantity.to_string(),
            unit: unit.to_string(),
            ours,
            reference: None,
            tolerance: None,
            reason: String::new(),
            assumption: None,
            explanation: None,
            fit: None,
            golden: None,
        }
    }

    /// Compares it with an entry of the case's `published.toml`.
    pub fn published(mut self, id: &str) -> Check {
        self.reference = Some(Reference::Published(id.to_string()));
        self
    }

    /// Compares it with a formula; `origin` says which.
    pub fn closed_form(self, value: f64, origin: &str) -> Check {
        self.computed(ReferenceKind::ClosedForm, value, origin)
    }

    /// Compares it with a converged solution; `origin` says of what.
    pub fn converged(self, value: f64, origin: &str) -> Check {
        self.computed(ReferenceKind::Converged, value, origin)
    }

    /// Compares it with another method or code that shares none of ours; `origin` says which.
    pub fn independent(self, value: f64, origin: &str) -> Check {
        self.computed(ReferenceKind::Independent, value, origin)
    }

    /// Compares it with another of our own ways; `ways` says which two: "explicit run, settled, against our
    /// own equilibrium".
    pub fn consistency(self, value: f64, ways: &str) -> Check {
        self.computed(ReferenceKind::Consistency, value, ways)
    }

    /// Compares it with what a sentence of the source says without a number: a threshold or an order.
    /// `section` is where it stands, `sentence` what it says in our own words: "thinner is stiffer".
    pub fn stated(self, value: f64, section: &str, sentence: &str) -> Check {
        let blank = section.trim().is_empty() || sentence.trim().is_empty();
        let origin = if blank { String::new() } else { format!("{section}: {sentence}") };
        self.computed(ReferenceKind::Stated, value, &origin)
    }

    fn computed(mut self, kind: ReferenceKind, value: f64, origin: &str) -> Check {
        self.reference = Some(Reference::Computed { kind, value, origin: origin.to_string() });
        self
    }

    /// Tolerance relative to the reference, and its reason.
    pub fn relative(self, tolerance: f64, reason: &str) -> Check {
        self.within(Tolerance::Relative(tolerance), reason)
    }

    /// Tolerance in the check's unit, and its reason.
    pub fn absolute(self, tolerance: f64, reason: &str) -> Check {
        self.within(Tolerance::Absolute(tolerance), reason)
    }

    /// Agreement to the last printed place of the published number, and why so close.
    pub fn printed(self, reason: &str) -> Check {
        self.within(Tolerance::Printed, reason)
    }

    /// Ours must exceed the reference by `margin` or more.
    pub fn at_least(self, margin: f64, reason: &str) -> Check {
        self.within(Tolerance::AtLeast { margin }, reason)
    }

    /// Ours must stay below the reference by `margin` or more.
    pub fn at_most(self, margin: f64, reason: &str) -> Check {
        self.within(Tolerance::AtMost { margin }, reason)
    }

    fn within(mut self, tolerance: Tolerance, reason: &str) -> Check {
        self.tolerance = Some(tolerance);
        self.reason = reason.to_string();
        self
    }

    /// The agreement rests on this assumption of the case.
    pub fn under(mut self, assumption: &str) -> Check {
        self.assumption = Some(assumption.to_string());
        self
    }

    /// The published number is known to differ; the tolerance is then what agreement *would* be.
    pub fn explained(mut self, explanation: Explanation) -> Check {
        self.explanation = Some(explanation);
        self
    }

    /// The published number is met because something was identified from that very number; `what`
    /// says what was fitted to what. Its status is then `fit`, never `reproduced`.
    pub fn fit(mut self, what: &str) -> Check {
        self.fit = Some(what.to_string());
        self
    }

    /// Also pin our number in `golden/<case>.json`.
    pub fn golden(mut self, tolerance: GoldenTolerance) -> Check {
        self.golden = Some(tolerance);
        self
    }
}
