//! Errors that are found with the mesh, when positions in the file are no longer known: the document looks up the part of
//! the scene that they are about.

use std::fmt::Display;
use thiserror::Error;

/// Part of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum About {
    /// A key or a table, dotted.
    Key(String),
    /// A key of one entry of a list of tables; entries are counted from 0.
    Item { table: &'static str, index: usize, key: &'static str },
}

impl About {
    pub fn key(path: impl Into<String>) -> About {
        About::Key(path.into())
    }
}

/// A contradiction of a scene and its mesh, or a mesh that cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{text}")]
pub struct SetupError {
    about: Option<About>,
    text: String,
}

impl SetupError {
    /// An error of a key or table, whose path begins the message.
    pub(crate) fn key(path: &str, text: impl Display) -> SetupError {
        SetupError { about: Some(About::key(path)), text: format!("{path}: {text}") }
    }

    /// An error of a key of one entry of a list.
    pub(crate) fn item(
        table: &'static str,
        index: usize,
        key: &'static str,
        text: impl Display,
    ) -> SetupError {
        let text = format!("{table}.{key}: {text}");
        SetupError { about: Some(About::Item { table, index, key }), text }
    }

    /// The error of a part below, about a part of the scene or, with `None`, of a file.
    pub(crate) fn of(about: Option<&str>, error: impl Display) -> SetupError {
        SetupError { about: about.map(About::key), text: error.to_string() }
    }

    pub fn about(&self) -> Option<About> {
        self.about.clone()
    }
}

/// Names for a message.
pub(crate) fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}
