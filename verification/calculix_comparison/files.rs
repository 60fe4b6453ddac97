//! The files of this folder, their hashes, and CalculiX run anew on them where it is installed.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use sha2::{Digest, Sha256};

use crate::case::CaseError;

macro_rules! files {
    ($($name:literal)*) => { [$(($name, include_str!($name))),*] };
}

const HASHES: &str = include_str!("SHA256SUMS");

const FILES: [(&str, &str); 30] = files![
    "bracket.py"
    "keep.sh" "bracket_c3d4.msh" "bracket_c3d10.msh" "steel.inp"
    "bracket_c3d4_mesh.inp" "bracket_c3d10_mesh.inp" "bracket_c3d4_loads.inp" "bracket_c3d10_loads.inp"
    "c3d4_static.inp" "c3d4_held.inp" "c3d4_free.inp" "c3d4_element.inp"
    "c3d10_static.inp" "c3d10_held.inp" "c3d10_free.inp" "c3d10_element.inp"
    "kept/c3d4_static.dat" "kept/c3d4_held.dat" "kept/c3d4_free.dat"
    "kept/c3d4_element.mas" "kept/c3d4_element.sti" "kept/c3d4_element.dof"
    "kept/c3d10_static.dat" "kept/c3d10_held.dat" "kept/c3d10_free.dat"
    "kept/c3d10_element.mas" "kept/c3d10_element.sti" "kept/c3d10_element.dof"
    "kept/version.txt"
];

/// Decks that are run.
const JOBS: [&str; 8] = [
    "c3d4_static",
    "c3d4_held",
    "c3d4_free",
    "c3d4_element",
    "c3d10_static",
    "c3d10_held",
    "c3d10_free",
    "c3d10_element",
];

pub fn text(name: &str) -> Result<&'static str, CaseError> {
    let found = FILES.iter().find(|file| file.0 == name);
    found.map(|file| file.1).ok_or_else(|| CaseError::message(format!("no file {name}")))
}

/// Files that are missing in SHA256SUMS or whose content is not the one noted there.
pub fn altered() -> Vec<&'static str> {
    let noted: BTreeMap<&str, &str> = HASHES
        .lines()
        .filter_map(|line| line.split_once("  "))
        .map(|(hash, name)| (name, hash))
        .collect();
    let hash = |text: &str| {
        Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect::<String>()
    };
    let differs =
        |(name, text): &(&'static str, &str)| noted.get(name) != Some(&hash(text).as_str());
    FILES.iter().filter(|file| differs(file)).map(|file| file.0).collect()
}

/// What CalculiX says about itself and what it wrote, by the names of the kept files.
pub struct Rerun {
    pub version: String,
    pub outputs: BTreeMap<String, String>,
}

/// Runs CalculiX on every deck in a folder of its own; `None` where there is no `ccx` on the path.
pub fn rerun() -> Result<Option<Rerun>, CaseError> {
    let version = match Command::new("ccx").arg("-v").output() {
        Ok(output) => String::from_utf8_lossy(&output.stdout).trim().to_string(),
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    let folder = Folder::new()?;
    for (name, text) in FILES.iter().filter(|file| file.0.ends_with(".inp")) {
        fs::write(folder.0.join(name), text)?;
    }
    let mut outputs = BTreeMap::new();
    for job in JOBS {
        run(&folder.0, job)?;
        for (name, _) in FILES {
            let Some(output) =
                name.strip_prefix("kept/").filter(|name| name.starts_with(&format!("{job}.")))
            else {
                continue;
            };
            outputs.insert(name.to_string(), fs::read_to_string(folder.0.join(output))?);
        }
    }
    Ok(Some(Rerun { version, outputs }))
}

fn run(folder: &Path, job: &str) -> Result<(), CaseError> {
    let output = Command::new("ccx")
        .args(["-i", job])
        .current_dir(folder)
        .env("OMP_NUM_THREADS", "1")
        .output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stdout);
        return Err(CaseError::message(format!(
            "ccx -i {job} ended with {}: {said}",
            output.status
        )));
    }
    Ok(())
}

/// A temporary folder, removed with everything in it.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Folder, Error> {
        let base = env::temp_dir();
        for attempt in 0..1000 {
            let path = base.join(format!("calculix-comparison-{}-{attempt}", std::process::id()));
            match fs::create_dir(&path) {
                Ok(()) => return Ok(Folder(path)),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(Error::new(ErrorKind::AlreadyExists, "no free name for a temporary folder"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Nothing is lost if a temporary folder stays.
        let _ = fs::remove_dir_all(&self.0);
    }
}
