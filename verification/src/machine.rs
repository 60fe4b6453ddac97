//! Facts about the machine and the build that made a report.

use std::fs;
use std::process::Command;

use serde::Serialize;

use crate::date;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Machine {
    pub cpu: String,
    pub cores: usize,
    pub rustc: String,
    pub crate_version: String,
    /// Commit, with `+changes` where the work tree differs from it; absent outside git.
    pub commit: Option<String>,
    /// When the run began.
    pub date: String,
    /// Threads this process had when the facts were taken (Linux only).
    pub threads: Option<usize>,
}

impl Machine {
    pub fn facts() -> Machine {
        Machine {
            cpu: cpu_model().unwrap_or_else(|| std::env::consts::ARCH.to_string()),
            cores: std::thread::available_parallelism().map_or(1, |count| count.get()),
            rustc: env!("VERIFICATION_RUSTC").to_string(),
            crate_version: env!("CARGO_PKG_VERSION").to_string(),
            commit: commit(),
            date: date::now(),
            threads: threads(),
        }
    }
}

/// Threads of this process right now.
pub fn threads() -> Option<usize> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("Threads:"))?.trim().parse().ok()
}

/// The processor, where the system tells.
pub fn cpu_model() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_string())
}

fn commit() -> Option<String> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_string())
    };
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let changes = git(&["status", "--porcelain"]).is_some_and(|text| !text.is_empty());
    Some(if changes { format!("{commit}+changes") } else { commit })
}
