//! Memory limit of a command, and a spinner for work of unknown length.

use bearing_dynamics::numeric::sparse::{Memory, TooLarge};
use bearing_dynamics::output::amounts::size;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Time after which running work is reported in a log, s.
const REPORTED_AFTER: f64 = 5.0;
/// Interval between two frames of a spinner.
const SPINNER_INTERVAL: Duration = Duration::from_millis(200);

/// Limit of `--memory`, bytes.
static LIMIT: OnceLock<f64> = OnceLock::new();

/// A number of gigabytes greater than zero.
pub fn parse_gigabytes(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(gigabytes) if gigabytes > 0.0 && gigabytes.is_finite() => Ok(gigabytes),
        _ => Err("a number of gigabytes (1e9 bytes) above zero, such as 8".into()),
    }
}

/// Sets the memory limit of this process, GB; later calls have no effect.
pub fn limit_to(gigabytes: Option<f64>) {
    if let Some(gigabytes) = gigabytes {
        let _ = LIMIT.set(1e9 * gigabytes);
    }
}

/// Resident memory of this process, bytes; 0 if the system does not report it.
fn resident_memory() -> f64 {
    const PAGE: f64 = 4096.0;
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let resident = text.split_whitespace().nth(1).and_then(|pages| pages.parse::<f64>().ok());
    resident.map_or(0.0, |pages| PAGE * pages)
}

/// Free memory of the machine, bytes; `None` if the system does not report it.
fn free_memory() -> Option<f64> {
    let number = |path: &str| std::fs::read_to_string(path).ok()?.trim().parse::<f64>().ok();
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let machine = 1024.0 * line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()?;
    // A container may have a lower limit. Its file cache counts as used but is released on demand.
    let stat = std::fs::read_to_string("/sys/fs/cgroup/memory.stat").unwrap_or_default();
    let files = stat.lines().find_map(|line| line.strip_prefix("inactive_file "));
    let files = files.and_then(|bytes| bytes.trim().parse::<f64>().ok()).unwrap_or(0.0);
    let group = number("/sys/fs/cgroup/memory.max")
        .zip(number("/sys/fs/cgroup/memory.current"))
        .map_or(f64::INFINITY, |(most, now)| (most - now + files).max(0.0));
    Some(machine.min(group))
}

/// Total memory that this process may use, bytes, and the source of this limit.
fn limit(resident: f64) -> (f64, &'static str) {
    match (LIMIT.get(), free_memory()) {
        (Some(given), _) => (*given, "--memory"),
        (None, Some(free)) => {
            (resident + free, "memory of this process and free memory of the machine")
        }
        (None, None) => (f64::INFINITY, "the system does not report its memory"),
    }
}

/// Returns an error if the memory does not suffice; `other` names another method, with a leading comma.
pub fn refuse_beyond(memory: &Memory, other: &'static str) -> Result<(), TooLarge> {
    let resident = resident_memory();
    let (limit, from) = limit(resident);
    memory.refuse_beyond(resident, limit, from, other)
}

pub fn text(memory: &Memory) -> String {
    let resident = resident_memory();
    let (limit, _) = limit(resident);
    let bytes = resident + memory.bytes();
    let too_large = match bytes <= limit {
        true => String::new(),
        false => format!("; REFUSED: only {} available", size(limit)),
    };
    format!("about {} of memory, {} unknowns{too_large}", size(bytes), memory.unknowns)
}

/// Does work that needs this memory, or returns an error if it does not suffice.
pub fn within<T>(
    memory: &Memory,
    other: &'static str,
    work: impl FnOnce() -> T,
) -> Result<T, TooLarge> {
    refuse_beyond(memory, other)?;
    Ok(spun(memory.task.name.into(), work))
}

/// Does work of unknown length: a terminal shows a spinner and the elapsed time, a log gets one line if it takes long.
pub fn spun<T>(what: String, work: impl FnOnce() -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return logged(&what, work);
    }
    let spinner = ProgressBar::new_spinner().with_message(what);
    if let Ok(style) = ProgressStyle::with_template("{elapsed} {spinner} {msg}") {
        spinner.set_style(style);
    }
    spinner.enable_steady_tick(SPINNER_INTERVAL);
    let done = work();
    spinner.finish_and_clear();
    done
}

/// Does work; logs one line if it takes longer than [`REPORTED_AFTER`].
fn logged<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| {
            let end = Instant::now() + Duration::from_secs_f64(REPORTED_AFTER);
            while !done.load(Ordering::Relaxed) {
                match end.checked_duration_since(Instant::now()) {
                    Some(left) => std::thread::park_timeout(left),
                    None => {
                        let _ = writeln!(std::io::stderr(), "{what} …");
                        return;
                    }
                }
            }
        });
        let found = work();
        done.store(true, Ordering::Relaxed);
        waiting.thread().unpark();
        found
    })
}
