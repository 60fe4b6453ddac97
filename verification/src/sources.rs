//! Hashes of the files that decide what a case computes. The build script includes this file as
//! well: it puts down the hashes of what it builds from.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// Path below the repository's root, with `/` → sha256 of its bytes, in hexadecimal.
pub type Sources = BTreeMap<String, String>;

/// Files and folders that every case is built from, below the repository's root. The folders of
/// the cases come on top ([`case_folders`]).
pub const SHARED: [&str; 9] = [
    ".cargo",
    "Cargo.lock",
    "Cargo.toml",
    "rust-toolchain.toml",
    "scenes",
    "src",
    "verification/Cargo.toml",
    "verification/build.rs",
    "verification/src",
];

/// Hash every source below `root`. What a case prints and is judged by (`published.toml`) or tells
/// a reader (`*.md`) is no source: nothing is computed from it.
///
/// # Errors
/// A file that is there and cannot be read.
pub fn read(root: &Path) -> io::Result<Sources> {
    let mut sources = Sources::new();
    for place in SHARED.map(PathBuf::from).into_iter().chain(case_folders(root)?) {
        add(root, &place, &mut sources)?;
    }
    Ok(sources)
}

/// Folders that hold a `case.rs`, below `root`.
pub fn case_folders(root: &Path) -> io::Result<Vec<PathBuf>> {
    let mut folders = Vec::new();
    for entry in fs::read_dir(root.join("verification"))? {
        let entry = entry?;
        if entry.path().join("case.rs").is_file() {
            folders.push(Path::new("verification").join(entry.file_name()));
        }
    }
    Ok(folders)
}

fn add(root: &Path, place: &Path, sources: &mut Sources) -> io::Result<()> {
    let path = root.join(place);
    if path.is_dir() {
        for entry in fs::read_dir(&path)? {
            add(root, &place.join(entry?.file_name()), sources)?;
        }
    } else if path.is_file() && is_source(place) {
        let name = place.to_string_lossy().replace('\\', "/");
        sources.insert(name, sha256(&fs::read(&path)?));
    }
    Ok(())
}

fn is_source(place: &Path) -> bool {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    name != "published.toml" && !name.ends_with(".md")
}

/// Sha256 of `bytes`, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
