//! How much memory a command may take, and a sign of life while it works.

use bearing_dynamics::numeric::sparse::{Memory, TooLarge};
use bearing_dynamics::output::amounts::size;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Work that takes longer than so many seconds is announced.
const WORTH_A_WORD: f64 = 5.0;
/// How often a spinner turns.
const LOOK: Duration = Duration::from_millis(200);

/// Bytes given with `--memory`.
static GIVEN: OnceLock<f64> = OnceLock::new();

/// A number of gigabytes greater than zero.
pub fn parse_gigabytes(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(gigabytes) if gigabytes > 0.0 && gigabytes.is_finite() => Ok(gigabytes),
        _ => Err("a number of gigabytes (1e9 bytes) above zero, such as 8".into()),
    }
}

/// Sets the limit of this process, GB; the first time counts.
pub fn limit_to(gigabytes: Option<f64>) {
    if let Some(gigabytes) = gigabytes {
        let _ = GIVEN.set(1e9 * gigabytes);
    }
}

/// Bytes that this process holds now; 0 where the system does not say.
fn held() -> f64 {
    const PAGE: f64 = 4096.0;
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let resident = text.split_whitespace().nth(1).and_then(|pages| pages.parse::<f64>().ok());
    resident.map_or(0.0, |pages| PAGE * pages)
}

/// Bytes that the machine has left; nothing where the system does not say.
fn left() -> Option<f64> {
    let number = |path: &str| std::fs::read_to_string(path).ok()?.trim().parse::<f64>().ok();
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let machine = 1024.0 * line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()?;
    // A container may have less than its machine; files that it has read count, but give way.
    let stat = std::fs::read_to_string("/sys/fs/cgroup/memory.stat").unwrap_or_default();
    let files = stat.lines().find_map(|line| line.strip_prefix("inactive_file "));
    let files = files.and_then(|bytes| bytes.trim().parse::<f64>().ok()).unwrap_or(0.0);
    let group = number("/sys/fs/cgroup/memory.max")
        .zip(number("/sys/fs/cgroup/memory.current"))
        .map_or(f64::INFINITY, |(most, now)| (most - now + files).max(0.0));
    Some(machine.min(group))
}

/// Bytes this process may take in all, and who says so.
fn limit(held: f64) -> (f64, &'static str) {
    match (GIVEN.get(), left()) {
        (Some(given), _) => (*given, "--memory"),
        (None, Some(left)) => (held + left, "what this process holds and the machine has left"),
        (None, None) => (f64::INFINITY, "this system does not say what it has"),
    }
}

/// Refuses what does not fit; `other` names another method, with a leading comma.
pub fn refuse_beyond(memory: &Memory, other: &'static str) -> Result<(), TooLarge> {
    let held = held();
    let (limit, from) = limit(held);
    memory.refuse_beyond(held, limit, from, other)
}

/// Memory that a solution needs, in words.
pub fn text(memory: &Memory) -> String {
    let held = held();
    let (limit, _) = limit(held);
    let bytes = held + memory.bytes();
    let too_large = match bytes <= limit {
        true => String::new(),
        false => format!("; REFUSED: only {} may be taken", size(limit)),
    };
    format!("about {} of memory, {} unknowns{too_large}", size(bytes), memory.unknowns)
}

/// Refuses what does not fit, and does the rest.
pub fn within<T>(
    memory: &Memory,
    other: &'static str,
    work: impl FnOnce() -> T,
) -> Result<T, TooLarge> {
    refuse_beyond(memory, other)?;
    Ok(spun(memory.task.name.into(), work))
}

/// Does work that says nothing of how far it is; a terminal is told that it is on, and for how long, a log once it takes long.
pub fn spun<T>(what: String, work: impl FnOnce() -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return told_once(&what, work);
    }
    let spinner = ProgressBar::new_spinner().with_message(what);
    if let Ok(style) = ProgressStyle::with_template("{elapsed} {spinner} {msg}") {
        spinner.set_style(style);
    }
    spinner.enable_steady_tick(LOOK);
    let done = work();
    spinner.finish_and_clear();
    done
}

/// Says in a log what takes longer than some seconds.
fn told_once<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| {
            let end = Instant::now() + Duration::from_secs_f64(WORTH_A_WORD);
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
