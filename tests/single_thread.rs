//! One thread unless asked: counted by the system, in the library and in the running command.
//!
//! A file with a single test: another test beside it would be another thread.
#![cfg(target_os = "linux")]

use bearing_dynamics::equilibrium::statics::solve;
use bearing_dynamics::scene;
use bearing_dynamics::scene::Format;
use bearing_dynamics::scene::build::statics::static_problem;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A slewing ring with so many balls that a solution and its plots take tens of milliseconds.
const LARGE: &str = r#"defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 190
clearance = { radial = "2 um" }
inner_race = { radius = "494 mm", groove_radius = "6.1 mm" }
outer_race = { radius = "506 mm", groove_radius = "6.2 mm" }
[inner_race]
x = { load = "1 kN" }
z = { load = "-20 kN" }
speed = "1000 rpm"
[ball_forces]
gravity = ["0 m/s^2", "0 m/s^2", "-1 g"]
centrifugal = true
[output]
plots = ["polar", "moment-tilt"]
"#;

#[test]
fn one_thread_unless_asked() {
    the_library_starts_no_thread();
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("large.toml");
    fs::write(&path, LARGE).unwrap();
    statics_runs_on_one_thread(&path, root.path());
    a_sweep_runs_on_the_threads_it_was_given(&path, root.path());
    only_the_sweep_knows_of_threads();
}

/// A pool, once started, stays: it would still be counted after the solution.
fn the_library_starts_no_thread() {
    let threads = || fs::read_dir("/proc/self/task").unwrap().count();
    let before = threads();
    let problem =
        static_problem(&scene::read_str(LARGE, Format::Toml, "large.toml").unwrap()).unwrap();
    assert_eq!(solve(&problem).unwrap().balls.len(), 190);
    assert_eq!(threads(), before);
}

/// Sampled as fast as the system answers, over as many runs as it takes: the process has one
/// thread in every sample.
fn statics_runs_on_one_thread(path: &Path, folder: &Path) {
    let out = folder.join("statics");
    let start = Instant::now();
    let mut samples = 0;
    while samples < 1000 {
        assert!(start.elapsed() <= Duration::from_secs(60), "{samples} samples");
        let mut child = bearing(&["statics"], path, &out);
        while child.try_wait().unwrap().is_none() {
            let Some(threads) = threads_of(&child) else { continue };
            assert_eq!(threads, 1, "bearing statics");
            samples += 1;
        }
        assert!(child.wait().unwrap().success());
    }
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(summary.contains("\"threads\": 1,"), "{summary}");
}

/// While points are solved there are the main thread, which waits, the one that waits for an
/// interruption, and the workers. This also shows that the sampling above sees threads.
fn a_sweep_runs_on_the_threads_it_was_given(path: &Path, folder: &Path) {
    const WAITING: usize = 2;
    let cores = std::thread::available_parallelism().unwrap().get();
    for (given, workers) in [(Some(1), 1), (Some(2), 2), (Some(5), 5), (None, cores)] {
        let out = folder.join(format!("sweep {workers} {}", given.is_some()));
        let mut arguments = vec!["sweep", "--vary", "bearing.ball_phase=0 deg .. 1 deg / 100000"];
        let text = workers.to_string();
        if given.is_some() {
            arguments.extend(["--threads", &text]);
        }
        let mut child = bearing(&arguments, path, &out);
        let start = Instant::now();
        // A row in the table: the workers are at it.
        let csv = out.join("sweep.csv");
        while fs::read(&csv).map_or(0, |text| text.iter().filter(|b| **b == b'\n').count()) < 2 {
            assert!(start.elapsed() <= Duration::from_secs(60), "no rows");
            assert!(child.try_wait().unwrap().is_none(), "over too soon");
            std::thread::sleep(Duration::from_millis(1));
        }
        let counted: Vec<_> = (0..100).filter_map(|_| threads_of(&child)).collect();
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(counted, [workers + WAITING; 100], "--threads {given:?}");
    }
}

/// What the samples could miss: a thread that comes and goes. The words for one appear in no
/// source file of the library, the command or the verification but those named here.
fn only_the_sweep_knows_of_threads() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sources = Vec::new();
    for folder in ["src", "verification/src"] {
        rust_files(&root.join(folder), &mut sources);
    }
    assert!(sources.len() > 50, "{}", sources.len());
    let words = ["rayon", "thread::spawn", "thread::scope", "thread::Builder", "par_iter", "tokio"];
    let knows = |path: &PathBuf| {
        let text = fs::read_to_string(path).unwrap();
        words.iter().any(|word| text.contains(word))
    };
    let mut found: Vec<_> = sources.into_iter().filter(knows).collect();
    found.sort();
    // Programs on packs and packs of a set side by side; what watches a long factorisation and sleeps between its looks; a sweep, a solid that is asked for
    // threads, seeded faults and cases side by side.
    let known = [
        "src/commands/conform.rs",
        "src/commands/memory.rs",
        "src/commands/pack/set.rs",
        "src/commands/sweep/mod.rs",
        "src/commands/sweep/runs.rs",
        "src/solids/threads.rs",
        "verification/src/mutants/mod.rs",
        "verification/src/runner.rs",
    ];
    assert_eq!(found, known.map(|path| root.join(path)));
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

fn bearing(arguments: &[&str], scene: &Path, out: &Path) -> Child {
    Command::new(env!("CARGO_BIN_EXE_bearing"))
        .args(arguments)
        .arg(scene)
        .arg("--out")
        .arg(out)
        .env_remove("RAYON_NUM_THREADS")
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

/// Threads of a running process; `None` before it has become the command and after its end.
fn threads_of(child: &Child) -> Option<usize> {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
    let field = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name))?;
        line[name.len()..].split_whitespace().next()
    };
    let running = field("Name:")? == "bearing" && !matches!(field("State:")?, "Z" | "X");
    let threads = field("Threads:")?.parse().ok()?;
    // A process on its way out has given its memory back before it is counted out.
    (running && field("VmSize:").is_some()).then_some(threads)
}
