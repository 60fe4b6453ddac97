//! What a verification case is: plain data and one function.

use std::error::Error;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::context::CaseContext;

/// How long a case may take, hence when it runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Tier {
    /// Seconds; part of every `make verify` and of `cargo test`.
    Smoke,
    /// Minutes; `make verify-full` only.
    Full,
}

/// What a case computes. It is given a place to record in and nothing else, so that no published
/// number is in its reach.
pub type Computation = fn(&mut CaseContext) -> Result<(), CaseError>;

/// One benchmark. The folder `verification/<id>` holds its README, its published numbers and
/// the file that defines this constant.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The folder's name: lower case, digits and underscores.
    pub id: &'static str,
    pub title: &'static str,
    /// Sections, tables and equations of the source, such as `"2.2.1, Table 2.2, (2.1)"`.
    pub section: &'static str,
    pub tier: Tier,
    /// Text of the case's `published.toml`.
    pub published: &'static str,
    /// Computes, and states checks.
    pub run: Computation,
}

/// Why a case could not be computed. Any error converts into it, so that `?` works on whatever
/// the laws return; a check that does not hold is *not* an error of this kind.
#[derive(Debug)]
pub struct CaseError(Box<dyn Error + Send + Sync>);

impl CaseError {
    /// An error of the case's own, in words.
    pub fn message(text: impl Into<String>) -> CaseError {
        CaseError(text.into().into())
    }
}

// `CaseError` does not implement `Error` itself: that would clash with this conversion.
impl<E: Error + Send + Sync + 'static> From<E> for CaseError {
    fn from(error: E) -> CaseError {
        CaseError(Box::new(error))
    }
}

impl fmt::Display for CaseError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.0)?;
        let mut source = self.0.source();
        while let Some(cause) = source {
            write!(formatter, ": {cause}")?;
            source = cause.source();
        }
        Ok(())
    }
}
