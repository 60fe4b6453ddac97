//! How much memory a command may take, and what is said of it before and while it works.

use super::say;
use bearing_dynamics::output::amounts::{duration, size};
use bearing_dynamics::solver::solid::tangent::Unknowns;
use bearing_dynamics::solver::sparse::{Cost, Progress, Speed, TooLarge};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::error::Error;
use std::io::{IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Solutions that take longer than so many seconds are announced.
const WORTH_A_WORD: f64 = 5.0;
/// How often a progress bar looks.
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

/// Refuses what does not fit; `other` names another way out, with a leading comma.
pub fn refuse_beyond(cost: &Cost, other: &'static str) -> Result<(), TooLarge> {
    let held = held();
    let (limit, from) = limit(held);
    cost.refuse_beyond(held, limit, from, other)
}

/// What a solution takes, in words: memory, and processor time as fast as the machine is now.
pub fn text(cost: &Cost) -> String {
    let held = held();
    let (limit, _) = limit(held);
    let bytes = held + cost.bytes();
    let too_large = match bytes <= limit {
        true => String::new(),
        false => format!("; REFUSED: only {} may be taken", size(limit)),
    };
    let speed = Speed::measured();
    let (seconds, further) = (cost.seconds(&speed), cost.seconds_of_factors(&speed));
    // Loads that bend a body visibly change its stiffness.
    let repeated = match cost.task.repeats && seconds >= 1.0 {
        true => format!(" with one factorisation, {} more for each further one", duration(further)),
        false => String::new(),
    };
    format!(
        "{} unknowns, {} values in the factors; {} of memory in all, about {} of processor time here{repeated}{too_large}",
        cost.unknowns,
        cost.fill,
        size(bytes),
        duration(seconds)
    )
}

/// Refuses or announces a long piece of work; whether it is long.
pub fn announced(cost: &Cost, other: &'static str) -> Result<bool, Box<dyn Error>> {
    refuse_beyond(cost, other)?;
    // As fast as any machine is: no need to measure for what is quick on all.
    let quick = Speed { operations: 1e10, bytes: 5e9 };
    let is_long = cost.seconds(&quick) >= WORTH_A_WORD;
    if is_long {
        say(&format!("{}: {}\n", cost.task.name, text(cost)))?;
    }
    Ok(is_long)
}

/// Refuses, announces and does a long piece of work, with a bar on a terminal.
pub fn watched<T>(
    cost: &Cost,
    unknowns: &Unknowns,
    other: &'static str,
    work: impl FnOnce() -> T,
) -> Result<T, Box<dyn Error>> {
    if !announced(cost, other)? || !std::io::stderr().is_terminal() {
        return Ok(work());
    }
    let (done, progress) = (AtomicBool::new(false), unknowns.progress.clone());
    Ok(std::thread::scope(|scope| {
        scope.spawn(|| draw(cost, &progress, &done));
        // Also where the work panics: the scope waits for the thread.
        let _told = Told(&done);
        work()
    }))
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

struct Told<'a>(&'a AtomicBool);

impl Drop for Told<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

fn draw(cost: &Cost, progress: &Progress, done: &AtomicBool) {
    let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{elapsed} {bar:30} {percent} % {msg}") {
        bar.set_style(style);
    }
    while !done.load(Ordering::Relaxed) {
        let (begun, finished) = progress.factorisations();
        let part = progress.operations() as f64 / cost.operations;
        bar.set_position((1000.0 * part.min(1.0)) as u64);
        bar.set_message(match (begun, progress.solves()) {
            (0, _) => "assembling the stiffness".to_string(),
            (_, _) if begun > finished => format!("of factorisation {begun}"),
            (_, solves) => format!("factorised; {solves} right-hand sides solved"),
        });
        std::thread::sleep(LOOK);
    }
    bar.finish_and_clear();
}
