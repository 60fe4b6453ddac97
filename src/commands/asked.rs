//! Arguments that `statics` and `modes` share.

use super::earlier::{Writes, claimed};
use super::results_folder;
use bearing_dynamics::output::folder::ResultsFolder;
use bearing_dynamics::scene::Document;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Scene file and results folder of a command.
pub struct Asked<'a> {
    pub path: &'a Path,
    pub document: &'a Document,
    pub out: &'a Option<PathBuf>,
    pub dry: bool,
}

impl Asked<'_> {
    /// Claims the results folder before anything is computed; `None` with `--dry`.
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
