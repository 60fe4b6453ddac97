//! The copy of the repository with all faults, and the programs built from it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::list::{Check, Sources};
use super::switch;

/// Result of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageCounts {
    Passed { tests: usize },
    Failed,
    TimedOut,
}

/// Programs that run checks.
pub struct Programs {
    /// `tree` is the copy, `target` what is built from it.
    folder: PathBuf,
    /// By name of the test binary; `None` for `verify`.
    paths: BTreeMap<Option<String>, PathBuf>,
}

impl Programs {
    /// Copies the repository at `root` with other `sources` to `target/mutants`, and builds what the checks
    /// need.
    ///
    /// # Errors
    /// When a file cannot be copied or the sources do not build.
    pub fn build(
        root: &Path,
        sources: &Sources,
        checks: &[&Check],
        jobs: usize,
    ) -> Result<Programs, String> {
        let folder = root.join("target/mutants");
        fs::create_dir_all(&folder).map_err(|error| at(&folder, &error))?;
        let folder = folder.canonicalize().map_err(|error| at(&folder, &error))?;
        let tree = folder.join("tree");
        copy(root, &tree, Path::new(""), sources).map_err(|error| at(&tree, &error))?;
        let binaries: BTreeSet<Option<&str>> = checks.iter().map(|check| check.binary()).collect();
        let mut command =
            Command::new(std::env::var("CARGO").unwrap_or_else(|_| String::from("cargo")));
        command.args(["test", "--no-run", "--release", "--quiet"]);
        command.arg("--message-format=json-render-diagnostics").arg(format!("--jobs={jobs}"));
        for binary in &binaries {
            match binary {
                Some(name) => command.args(["--test", name]),
                // A test of the package builds `verify` with the features that the other tests have.
                None => command.args("-p bearing-dynamics -p verification --test judge".split(' ')),
            };
        }
        // Level 1 computes the same numbers, and most checks take less time than their build.
        let output = command
            .current_dir(&tree)
            .env("CARGO_TARGET_DIR", folder.join("target"))
            .env("CARGO_INCREMENTAL", "1")
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1")
            .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "256")
            .stderr(Stdio::inherit())
            .output()
            .map_err(|error| format!("cargo: {error}"))?;
        if !output.status.success() {
            return Err("the sources with all faults do not build".into());
        }
        let messages: Vec<serde_json::Value> = String::from_utf8_lossy(&output.stdout)
            .lines()
            .filter_map(|line| serde_json::from_str(line).ok())
            .collect();
        let mut paths = BTreeMap::new();
        for binary in binaries {
            let (kind, name) = binary.map_or(("bin", "verify"), |name| ("test", name));
            let path = messages
                .iter()
                .find_map(|message| executable(message, kind, name))
                .ok_or_else(|| format!("cargo built no {kind} `{name}`"))?;
            paths.insert(binary.map(String::from), path);
        }
        Ok(Programs { folder, paths })
    }

    /// Runs a check with the fault of a number (0: none) on one of several threads; with the seconds
    /// that it took.
    ///
    /// # Errors
    /// When the check cannot be started.
    pub fn run(
        &self,
        check: &Check,
        number: usize,
        thread: usize,
        time_limit: Duration,
    ) -> Result<(StageCounts, f64), String> {
        let program = &self.paths[&check.binary().map(String::from)];
        let clock = Instant::now();
        let mut command = Command::new(program);
        command.current_dir(self.folder.join("tree")).env(switch::VARIABLE, number.to_string());
        if let Some((name, function)) = check.test() {
            let module = name.split_once('/').map(|(_, module)| format!("{module}::"));
            command.args(function.map(String::from).or(module)).arg("--test-threads=1");
        }
        if let Some(id) = check.case() {
            // The cache knows the sources, not the fault.
            let out = self.folder.join(format!("verify-{thread}"));
            command.args(["--case", id, "--no-cache", "--out"]).arg(out);
            command.arg("--golden").arg(self.folder.join("tree/golden"));
        }
        // The same random inputs every time, and no snapshot is written.
        command.env("PROPTEST_RNG_SEED", "20").env("INSTA_UPDATE", "no");
        let log = self.folder.join(format!("check-{thread}.log"));
        let file = File::create(&log).map_err(|error| at(&log, &error))?;
        let other = file.try_clone().map_err(|error| at(&log, &error))?;
        // A group of its own, to be stopped with all that it has started.
        command.process_group(0).stdin(Stdio::null()).stdout(file).stderr(other);
        let child = command.spawn().map_err(|error| at(program, &error))?;
        let ran = match wait(child, time_limit)? {
            None => StageCounts::TimedOut,
            Some(false) => StageCounts::Failed,
            Some(true) => StageCounts::Passed { tests: tests_in(&log, check) },
        };
        Ok((ran, clock.elapsed().as_secs_f64()))
    }
}

/// The program of a cargo message, if it is of this kind and name. Checks are tests of the library, and the package of the
/// verification may have one of the same name.
fn executable(message: &serde_json::Value, kind: &str, name: &str) -> Option<PathBuf> {
    let target = &message["target"];
    let of_verification = message["manifest_path"].as_str()?.ends_with("verification/Cargo.toml");
    let wanted = target["name"] == name
        && target["kind"].as_array()?.iter().any(|k| k == kind)
        && of_verification == (kind == "bin");
    let path = message["executable"].as_str()?;
    wanted.then(|| path.into())
}

/// Whether a program succeeded; `None` if it was stopped.
fn wait(mut child: Child, time_limit: Duration) -> Result<Option<bool>, String> {
    let clock = Instant::now();
    loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            return Ok(Some(status.success()));
        }
        if clock.elapsed() > time_limit {
            let group = format!("-{}", child.id());
            let killed = Command::new("kill").args(["-KILL", "--", &group]).status();
            killed.and_then(|_| child.wait()).map_err(|error| error.to_string())?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Number of tests that a check has run.
fn tests_in(log: &Path, check: &Check) -> usize {
    if check.binary().is_none() {
        return 1;
    }
    let text = fs::read_to_string(log).unwrap_or_default();
    let count = |line: &str| -> Option<usize> {
        line.strip_prefix("running ")?.split(' ').next()?.parse().ok()
    };
    text.lines().filter_map(count).sum()
}

/// Makes the folder `below` of `tree` that of `root` with other `sources`, without what is built or hidden but for the
/// settings of cargo. A file that is the same stays, so that cargo does not build it again.
fn copy(root: &Path, tree: &Path, below: &Path, sources: &Sources) -> std::io::Result<()> {
    let (from, to) = (root.join(below), tree.join(below));
    fs::create_dir_all(&to)?;
    for entry in fs::read_dir(&to)? {
        let (path, name) = entry.map(|entry| (entry.path(), entry.file_name()))?;
        if !from.join(name).exists() {
            if path.is_dir() { fs::remove_dir_all(path)? } else { fs::remove_file(path)? }
        }
    }
    for entry in fs::read_dir(&from)? {
        let (path, name) = entry.map(|entry| (entry.path(), entry.file_name()))?;
        let hidden = name.to_string_lossy().starts_with('.') && name != ".cargo";
        let below = below.join(&name);
        if path.is_dir() && name != "target" && !hidden {
            copy(root, tree, &below, sources)?;
        } else if path.is_file() && !hidden {
            let source = below.to_str().and_then(|name| sources.get(name));
            let contents =
                source.map_or_else(|| fs::read(&path), |text| Ok(text.clone().into()))?;
            if fs::read(to.join(&name)).ok().as_ref() != Some(&contents) {
                fs::write(to.join(&name), contents)?;
            }
        }
    }
    Ok(())
}

fn at(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}
