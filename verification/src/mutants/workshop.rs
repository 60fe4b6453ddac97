//! The copy of the sources in which faults are seeded, built and tested.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use super::list::{Check, Mutant, binary_of};
use super::switch;

/// What a check came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ran {
    Passed {
        tests: usize,
    },
    Failed,
    TimedOut,
    /// What the compiler said.
    DoesNotBuild(String),
}

/// Contents of every file of a repository, by its path from the root.
pub struct Sources(pub BTreeMap<String, Vec<u8>>);

/// A folder with a copy of the sources (`tree`), what is built from it (`target`) and what is run there.
pub struct Workshop {
    folder: PathBuf,
    processors: usize,
    /// Built from what the copy holds now, by what cargo calls them.
    programs: Mutex<BTreeMap<String, PathBuf>>,
}

/// A fault in the copy; dropping it puts the right text back.
pub struct Fault {
    path: PathBuf,
    right: String,
}

impl Drop for Fault {
    fn drop(&mut self) {
        // If this fails, the next workshop puts it right.
        let _ = fs::write(&self.path, &self.right);
    }
}

impl Sources {
    /// # Errors
    /// In words, when files cannot be read.
    pub fn read(root: &Path) -> Result<Sources, String> {
        let mut files = BTreeMap::new();
        read_into(root, "", &mut files)?;
        Ok(Sources(files))
    }

    /// Hash of all that a verdict by these checks rests on: the library, the files of the checks
    /// and `more`.
    pub fn key(&self, checks: &[Check], more: &str) -> String {
        let mut hasher = Sha256::new();
        let matters = |name: &str| {
            let by_check = |check: &Check| match check {
                Check::Test { name: test, .. } => {
                    name == format!("tests/{test}.rs")
                        || name.starts_with(&format!("tests/{test}/"))
                        || name.starts_with("tests/common")
                }
                Check::Case { id } => {
                    name.starts_with("verification/src/")
                        && !name.starts_with("verification/src/mutants/")
                        || name.starts_with(&format!("verification/{id}/"))
                        || name == format!("golden/{id}.json")
                }
            };
            name.starts_with("src/")
                || name.starts_with("scenes/")
                || name.starts_with("Cargo.")
                || name.starts_with(".cargo/")
                || checks.iter().any(by_check)
        };
        for (name, contents) in self.0.iter().filter(|(name, _)| matters(name)) {
            hasher.update(name.as_bytes());
            hasher.update((contents.len() as u64).to_le_bytes());
            hasher.update(contents);
        }
        for check in checks {
            hasher.update(check.to_string().as_bytes());
        }
        hasher.update(more.as_bytes());
        hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

impl Workshop {
    /// # Errors
    /// In words, when the folder cannot be made.
    pub fn new(folder: &Path, processors: usize) -> Result<Workshop, String> {
        let tree = folder.join("tree");
        fs::create_dir_all(&tree).map_err(|error| said(&tree, &error))?;
        Ok(Workshop { folder: folder.to_path_buf(), processors, programs: Mutex::default() })
    }

    /// Makes the copy one of these sources; files that are the same already keep their age, so that
    /// builds go on from the last ones.
    ///
    /// # Errors
    /// In words, when files cannot be read or written.
    pub fn fill(&self, sources: &Sources) -> Result<(), String> {
        self.programs().clear();
        let tree = self.folder.join("tree");
        let Sources(copied) = Sources::read(&tree)?;
        for gone in copied.keys().filter(|name| !sources.0.contains_key(*name)) {
            fs::remove_file(tree.join(gone)).map_err(|error| said(&tree.join(gone), &error))?;
        }
        for (name, contents) in &sources.0 {
            if copied.get(name) != Some(contents) {
                let path = tree.join(name);
                let made = path.parent().map_or(Ok(()), fs::create_dir_all);
                made.and_then(|()| fs::write(&path, contents))
                    .map_err(|error| said(&path, &error))?;
            }
        }
        Ok(())
    }

    fn programs(&self) -> MutexGuard<'_, BTreeMap<String, PathBuf>> {
        self.programs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts a fault into the copy.
    ///
    /// # Errors
    /// When it does not apply.
    pub fn seed(&self, mutant: &Mutant) -> Result<Fault, String> {
        let path = self.folder.join("tree").join(&mutant.file);
        let right = fs::read_to_string(&path).map_err(|error| said(&path, &error))?;
        let wrong = mutant.seeded(&right)?;
        self.programs().clear();
        let fault = Fault { path, right };
        fs::write(&fault.path, wrong).map_err(|error| said(&fault.path, &error))?;
        Ok(fault)
    }

    /// Builds what a check needs and runs it with the fault of a number (0: none) at one of several
    /// places, for as long as patience lasts; with the seconds that it ran.
    ///
    /// # Errors
    /// When cargo or the check cannot be started at all.
    pub fn run(
        &self,
        check: &Check,
        number: usize,
        place: usize,
        patience: Duration,
    ) -> Result<(Ran, f64), String> {
        let program = match self.build(check)? {
            Ok(program) => program,
            Err(compiler) => return Ok((Ran::DoesNotBuild(compiler), 0.0)),
        };
        let clock = Instant::now();
        let mut command = Command::new(&program);
        command.current_dir(self.folder.join("tree")).env(switch::VARIABLE, number.to_string());
        match check {
            Check::Case { id } => {
                let out = self.folder.join(format!("verify-{place}"));
                let golden = self.folder.join("tree/golden");
                // A cache knows the sources, not which of their faults is set off.
                command.args(["--case", id, "--no-cache", "--out"]).arg(out);
                command.arg("--golden").arg(golden);
            }
            Check::Test { name, filter } => {
                let module = name.split_once('/').map(|(_, module)| format!("{module}::"));
                command.args(filter.clone().or(module)).arg("--test-threads=1");
            }
        }
        // The same random cases every time, and no snapshot is touched.
        command.env("PROPTEST_RNG_SEED", "20").env("INSTA_UPDATE", "no");
        let log = self.folder.join(format!("check-{place}.log"));
        let file = fs::File::create(&log).map_err(|error| said(&log, &error))?;
        let other = file.try_clone().map_err(|error| said(&log, &error))?;
        // A group of its own, to be stopped with all that it has started.
        command.process_group(0).stdin(Stdio::null()).stdout(file).stderr(other);
        let child = command.spawn();
        let passed = wait(child.map_err(|error| said(&program, &error))?, patience)?;
        let ran = match passed {
            None => Ran::TimedOut,
            Some(false) => Ran::Failed,
            Some(true) => Ran::Passed { tests: tests_in(&log, check) },
        };
        Ok((ran, clock.elapsed().as_secs_f64()))
    }

    /// Builds library and command as the copy has them and as tests want them; the compiler's messages where
    /// they do not build.
    ///
    /// # Errors
    /// When cargo cannot be started at all.
    pub fn compiles(&self) -> Result<Result<(), String>, String> {
        let output = self.cargo(&["test", "--no-run", "--lib", "--bins"], "json")?;
        let messages = || String::from_utf8_lossy(&output.stdout).into_owned();
        Ok(if output.status.success() { Ok(()) } else { Err(messages()) })
    }

    /// The program of a check, or what the compiler said.
    ///
    /// An interrupted build can leave parts behind that no longer fit together: one that cannot be
    /// linked is made once more from nothing before the sources are blamed.
    fn build(&self, check: &Check) -> Result<Result<PathBuf, String>, String> {
        let mut programs = self.programs();
        if let Some(program) = programs.get(&check.program()) {
            return Ok(Ok(program.clone()));
        }
        let mut output = self.compile(check)?;
        let errors = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() && errors.contains("error: linking with") {
            let target = self.folder.join("target");
            fs::remove_dir_all(&target).map_err(|error| said(&target, &error))?;
            output = self.compile(check)?;
        }
        if !output.status.success() {
            return Ok(Err(String::from_utf8_lossy(&output.stderr).into_owned()));
        }
        let wanted = match check {
            Check::Test { name, .. } => ("test", binary_of(name)),
            Check::Case { .. } => ("bin", "verify"),
        };
        let program = String::from_utf8_lossy(&output.stdout)
            .lines()
            .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
            .find_map(|message| executable(&message, wanted))
            .ok_or_else(|| format!("cargo built nothing to run for `{check}`"))?;
        programs.insert(check.program(), program.clone());
        Ok(Ok(program))
    }

    fn compile(&self, check: &Check) -> Result<Output, String> {
        let arguments: &[&str] = match check {
            Check::Test { name, .. } => &["test", "--no-run", "--test", binary_of(name)],
            // Beside a test, as it would be for that: packages that both need are then of the same
            // features, and the library is not built twice.
            Check::Case { .. } => &[
                "test",
                "--no-run",
                "-p",
                "bearing-dynamics",
                "-p",
                "verification",
                "--test",
                "judge",
            ],
        };
        self.cargo(arguments, "json-render-diagnostics")
    }

    fn cargo(&self, arguments: &[&str], messages: &str) -> Result<Output, String> {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        Command::new(cargo)
            .args(arguments)
            .current_dir(self.folder.join("tree"))
            .args(["--release", "--quiet"])
            .arg(format!("--message-format={messages}"))
            .arg(format!("--jobs={}", self.processors))
            // Little is optimised: the same sums come of it, and most checks take less than their build.
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            .env("CARGO_INCREMENTAL", "1")
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1")
            .env("CARGO_PROFILE_RELEASE_DEBUG", "0")
            .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "256")
            .output()
            .map_err(|error| format!("cargo: {error}"))
    }
}

/// The program that a message of cargo tells of, if it is the one wanted (kind and name).
fn executable(message: &serde_json::Value, (kind, name): (&str, &str)) -> Option<PathBuf> {
    let target = &message["target"];
    let of_kind = target["kind"].as_array()?.iter().any(|k| k == kind);
    let of_name = name.is_empty() || target["name"] == name;
    let path = message["executable"].as_str()?;
    (of_kind && of_name).then(|| path.into())
}

/// Whether it succeeded; `None` if it was stopped.
fn wait(mut child: Child, patience: Duration) -> Result<Option<bool>, String> {
    let clock = Instant::now();
    loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            return Ok(Some(status.success()));
        }
        if clock.elapsed() > patience {
            let group = format!("-{}", child.id());
            let killed = Command::new("kill").args(["-KILL", "--", &group]).status();
            killed.and_then(|_| child.wait()).map_err(|error| error.to_string())?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// How many tests a check has run.
fn tests_in(log: &Path, check: &Check) -> usize {
    if matches!(check, Check::Case { .. }) {
        return 1;
    }
    let text = fs::read_to_string(log).unwrap_or_default();
    let count = |line: &str| -> Option<usize> {
        line.strip_prefix("running ")?.split(' ').next()?.parse().ok()
    };
    text.lines().filter_map(count).sum()
}

/// All files below a folder but what is built and what is hidden (cargo's settings are wanted).
fn read_into(
    root: &Path,
    below: &str,
    files: &mut BTreeMap<String, Vec<u8>>,
) -> Result<(), String> {
    let folder = root.join(below);
    for entry in fs::read_dir(&folder).map_err(|error| said(&folder, &error))? {
        let entry = entry.map_err(|error| said(&folder, &error))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name == "target" || (name.starts_with('.') && name != ".cargo") {
            continue;
        }
        let path = if below.is_empty() { name } else { format!("{below}/{name}") };
        let kind = entry.file_type().map_err(|error| said(&folder, &error))?;
        if kind.is_dir() {
            read_into(root, &path, files)?;
        } else if kind.is_file() {
            let contents = fs::read(root.join(&path)).map_err(|error| said(&folder, &error))?;
            files.insert(path, contents);
        }
    }
    Ok(())
}

fn said(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}
