//! What `statics` and `modes` are asked for, whatever the scene is of.

use super::earlier::{Writes, claimed};
use super::results_folder;
use bearing_dynamics::output::folder::ResultsFolder;
use bearing_dynamics::scene::Document;
use std::error::Error;
use std::path::{Path, PathBuf};

/// A scene's file, and where its results go.
pub struct Asked<'a> {
    pub path: &'a Path,
    pub document: &'a Document,
    pub out: &'a Option<PathBuf>,
    pub dry: bool,
}

impl Asked<'_> {
    /// The folder for results, claimed before anything is computed; `None` where they are only to be said.
    ///
    /// # Errors
    /// Those of [`claimed`].
    pub fn folder(&self, writes: Writes) -> Result<Option<ResultsFolder>, Box<dyn Error>> {
        if self.dry {
            return Ok(None);
        }
        let kind = if writes == Writes::Modes { "modes" } else { "statics" };
        let folder = results_folder(self.path, kind, self.out);
        claimed(&folder, writes).map(Some)
    }
}
