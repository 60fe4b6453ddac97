//! `bearing conform SET --with COMMAND`: runs a program on every pack of a set and compares its results.

use super::{CommandResult, Outcome, print};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::compare::{Options, compare, report};
use bearing_dynamics::output::json;
use bearing_dynamics::output::pack::{MANIFEST, Manifest, RESOLVED, verify_pack};
use bearing_dynamics::output::results::pretty;
use rayon::prelude::*;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Exit code of a program that does not claim a pack.
const NOT_CLAIMED: i32 = 3;
/// Exit code for a scene that is not valid.
const REFUSED: i32 = 2;
/// How often a running program is looked at.
const GLANCE: Duration = Duration::from_millis(5);

#[derive(clap::Args)]
pub struct Arguments {
    /// Folder of case packs
    set: PathBuf,
    /// Command of the program; {resolved}, {out}, {kind} and {scene} are replaced
    #[arg(long = "with", value_name = "COMMAND")]
    with: String,
    /// Only packs that need nothing but these tags
    #[arg(long, value_delimiter = ',')]
    tags: Vec<String>,
    /// Only packs of this level
    #[arg(long)]
    level: Option<u8>,
    /// Packs at a time
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
    /// Longest time for one pack, s
    #[arg(long, default_value_t = 600.0)]
    timeout: f64,
    /// Folder of results and report; packs that are done there are not run again
    #[arg(long, default_value = "results/conform")]
    out: PathBuf,
    /// Run all packs again
    #[arg(long)]
    fresh: bool,
}

/// A pack and what became of it.
struct Verdict {
    name: String,
    manifest: Manifest,
    /// `passed`, `failed`, `not claimed`, `timed out`.
    status: String,
    /// First difference, or what the program said.
    says: String,
    unclaimed: Vec<String>,
    /// Wall time of the program and of this one, s.
    seconds: [f64; 2],
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let packs = packs(arguments)?;
    if packs.is_empty() {
        return Err(format!(
            "{}: no case packs with these tags and level",
            arguments.set.display()
        )
        .into());
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs.into()).build()?;
    let verdicts: Result<Vec<Verdict>, String> = pool.install(|| {
        let each = packs.into_par_iter();
        each.map(|(name, manifest)| {
            let verdict = judge(arguments, &name, manifest).map_err(|e| format!("{name}: {e}"))?;
            print(&line(&verdict)).map_err(|error| error.to_string())?;
            Ok(verdict)
        })
        .collect()
    });
    let verdicts = verdicts?;
    let text = table(&verdicts, start.elapsed());
    print(&format!("\n{text}"))?;
    let report = arguments.out.join("report.md");
    write_atomic(&report, page(arguments, &verdicts, &text).as_bytes())?;
    let all: Vec<Value> = verdicts.iter().map(as_json).collect();
    write_atomic(&arguments.out.join("results.json"), pretty(&json!(all)).as_bytes())?;
    print(&format!("wrote results.json and report.md to {}\n", arguments.out.display()))?;
    let wrong = |of: &Verdict| of.status == "failed" || of.status == "timed out";
    Ok(if verdicts.iter().any(wrong) { Outcome::Different } else { Outcome::Done })
}

/// Names and manifests of the packs asked for.
fn packs(arguments: &Arguments) -> Result<Vec<(String, Manifest)>, Box<dyn Error>> {
    let mut found = Vec::new();
    let entries = std::fs::read_dir(&arguments.set)
        .map_err(|error| format!("cannot read {}: {error}", arguments.set.display()))?;
    let claimed: BTreeSet<&String> = arguments.tags.iter().collect();
    for entry in entries {
        let folder = entry?.path();
        if !folder.join(MANIFEST).exists() {
            continue;
        }
        let manifest =
            verify_pack(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let about = &manifest.about;
        let level = arguments.level.is_none_or(|level| level == about.level);
        let tagged = claimed.is_empty() || about.tags.iter().all(|tag| claimed.contains(tag));
        if level && tagged {
            let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            found.push((name, manifest));
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(found)
}

/// Runs the program on a pack, or takes what an earlier command found.
fn judge(arguments: &Arguments, name: &str, manifest: Manifest) -> Result<Verdict, Box<dyn Error>> {
    let pack = arguments.set.join(name);
    let folder = arguments.out.join(name);
    let path = folder.join("verdict.json");
    let key = key(arguments, &pack)?;
    if !arguments.fresh
        && let Ok(known) = json::read(&path)
        && known["key"] == json!(key)
    {
        let text = |part: &str| known[part].as_str().unwrap_or_default().to_string();
        let list = known["unclaimed"].as_array().into_iter().flatten();
        let unclaimed = list.filter_map(|tag| tag.as_str().map(str::to_string)).collect();
        let seconds = [0, 1].map(|i| known["seconds"][i].as_f64().unwrap_or(0.0));
        let (status, says) = (text("status"), text("says"));
        return Ok(Verdict { name: name.into(), manifest, status, says, unclaimed, seconds });
    }
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder)?;
    let timeout = Duration::from_secs_f64(arguments.timeout);
    let own =
        format!("'{}' {{kind}} {{resolved}} --out {{out}}", std::env::current_exe()?.display());
    let ours = folder.join("ours");
    let [found, reference] = [(&arguments.with, folder.join("out")), (&own, ours.clone())]
        .map(|(command, out)| execute(command, &pack, &manifest.about.kind, &out, timeout));
    let (found, reference) = (found?, reference?);
    let _ = std::fs::remove_dir_all(ours);
    let (status, says, unclaimed) = verdict(&pack, &manifest, &folder.join("out"), &found)?;
    let seconds = [found.seconds, reference.seconds];
    let verdict = Verdict { name: name.into(), manifest, status, says, unclaimed, seconds };
    let mut known = as_json(&verdict);
    known["key"] = json!(key);
    write_atomic(&path, pretty(&known).as_bytes())?;
    Ok(verdict)
}

/// Hash of a pack and of the command that is run on it.
fn key(arguments: &Arguments, pack: &Path) -> Result<String, Box<dyn Error>> {
    let manifest = std::fs::read(pack.join(MANIFEST))?;
    let hash = Sha256::new().chain_update(manifest).chain_update(&arguments.with);
    let hash = hash.chain_update(arguments.timeout.to_le_bytes()).finalize();
    Ok(hash.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// A finished program; `code` is `None` if it took too long or was ended by a signal.
struct Executed {
    code: Option<i32>,
    late: bool,
    said: String,
    seconds: f64,
}

fn execute(
    command: &str,
    pack: &Path,
    kind: &str,
    out: &Path,
    timeout: Duration,
) -> Result<Executed, Box<dyn Error>> {
    let quoted = |path: &Path| format!("'{}'", path.display());
    let scene = ["scene.toml", "scene.json"].map(|name| pack.join(name));
    let scene = scene.iter().find(|path| path.exists()).cloned().unwrap_or_default();
    // A scene that is refused has no resolved form.
    let resolved = if kind == "refused" { scene.clone() } else { pack.join(RESOLVED) };
    let word = if kind == "refused" { "check" } else { kind };
    let mut line = command
        .replace("{resolved}", &quoted(&resolved))
        .replace("{scene}", &quoted(&scene))
        .replace("{kind}", word);
    line = match kind {
        "refused" => line.replace("--out {out}", "").replace("{out}", &quoted(out)),
        _ => line.replace("{out}", &quoted(out)),
    };
    let log = out.with_extension("log");
    let file = std::fs::File::create(&log)?;
    let start = Instant::now();
    let mut child = Command::new("sh")
        .args(["-c", &line])
        .stdin(Stdio::null())
        .stdout(file.try_clone()?)
        .stderr(file)
        .spawn()?;
    let (code, late) = loop {
        if let Some(status) = child.try_wait()? {
            break (status.code(), false);
        }
        if start.elapsed() > timeout {
            child.kill()?;
            child.wait()?;
            break (None, true);
        }
        std::thread::sleep(GLANCE);
    };
    let seconds = start.elapsed().as_secs_f64();
    let said = String::from_utf8_lossy(&std::fs::read(&log)?).into_owned();
    Ok(Executed { code, late, said, seconds })
}

/// Status, first difference, and tags that are not claimed.
fn verdict(
    pack: &Path,
    manifest: &Manifest,
    out: &Path,
    found: &Executed,
) -> Result<(String, String, Vec<String>), Box<dyn Error>> {
    let last = found.said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let with = |status: &str, says: String| Ok((status.to_string(), says, Vec::new()));
    if found.late {
        return with("timed out", format!("after {:.0} s", found.seconds));
    }
    if found.code == Some(NOT_CLAIMED) {
        return with("not claimed", last.into());
    }
    if manifest.about.kind == "refused" {
        let expected = json::read(&pack.join("summary.json"))?;
        let key = expected["refused"]["key"].as_str().unwrap_or_default().to_string();
        let line = expected["refused"]["line"].as_u64().map(|line| format!(":{line}"));
        let named = found.said.contains(&key);
        let placed = line.is_none_or(|line| found.said.contains(&line));
        return match (found.code == Some(REFUSED), named, placed) {
            (true, true, true) => with("passed", String::new()),
            (false, ..) => {
                with("failed", format!("exit code {:?} for a scene that is not valid", found.code))
            }
            (true, false, _) => with("failed", format!("the message does not name {key}: {last}")),
            (true, true, false) => {
                with("failed", format!("the message does not name the line: {last}"))
            }
        };
    }
    if found.code != Some(0) {
        return with("failed", format!("exit code {:?}: {last}", found.code));
    }
    match compare(pack, out, &Options::default()) {
        Err(error) => with("failed", error.to_string()),
        Ok(compared) if compared.equal => Ok(("passed".into(), String::new(), compared.unclaimed)),
        Ok(compared) => {
            let text = report(&compared);
            let lines: Vec<&str> = text.lines().skip(1).take(2).map(str::trim).collect();
            Ok(("failed".into(), lines.join(": "), compared.unclaimed))
        }
    }
}

fn line(of: &Verdict) -> String {
    let [own, ours] = of.seconds;
    let mut text = format!("{:<12} {:<40} {own:>9.3} s, ours {ours:.3} s", of.status, of.name);
    if !of.unclaimed.is_empty() {
        let _ = write!(text, "; without {}", of.unclaimed.join(", "));
    }
    if !of.says.is_empty() {
        let _ = write!(text, "\n             {}", of.says);
    }
    text + "\n"
}

fn as_json(of: &Verdict) -> Value {
    json!({
        "name": of.name,
        "about": of.manifest.about,
        "status": of.status,
        "says": of.says,
        "unclaimed": of.unclaimed,
        "seconds": of.seconds,
    })
}

/// Counts by level and by tag.
fn table(verdicts: &[Verdict], elapsed: Duration) -> String {
    const STATUS: [&str; 4] = ["passed", "failed", "not claimed", "timed out"];
    let mut rows: BTreeMap<String, ([usize; 4], [f64; 2])> = BTreeMap::new();
    for of in verdicts {
        let about = &of.manifest.about;
        let tags = about.tags.iter().map(|tag| format!("tag {tag}"));
        let groups = [format!("level {}", about.level), "~ all".into()].into_iter().chain(tags);
        for group in groups {
            let (counts, seconds) = rows.entry(group).or_default();
            if let Some(at) = STATUS.iter().position(|status| *status == of.status) {
                counts[at] += 1;
            }
            for (sum, own) in seconds.iter_mut().zip(of.seconds) {
                *sum += own;
            }
        }
    }
    let mut text = format!("{:<28}", "");
    STATUS.iter().for_each(|status| text += &format!("{status:>12}"));
    text += &format!("{:>12}{:>12}\n", "time, s", "ours, s");
    for (group, (counts, [own, ours])) in rows {
        let _ = write!(text, "{:<28}", group.trim_start_matches("~ "));
        counts.iter().for_each(|count| text += &format!("{count:>12}"));
        let _ = writeln!(text, "{own:>12.3}{ours:>12.3}");
    }
    let _ = writeln!(text, "{:.1} s in all", elapsed.as_secs_f64());
    text
}

/// The report, to be published.
fn page(arguments: &Arguments, verdicts: &[Verdict], table: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let mut text = format!(
        "# Conformance report\n\nProgram: `{}`\n\nReference: bearing-dynamics {version}; {} packs. Times are those of one \
         machine, the reference's next to the program's.\n\n```\n{table}```\n",
        arguments.with,
        verdicts.len()
    );
    let missed: Vec<&Verdict> = verdicts.iter().filter(|of| of.status != "passed").collect();
    if !missed.is_empty() {
        text +=
            "\n## Not passed\n\n| Pack | Status | First difference or reason |\n|---|---|---|\n";
        for of in missed {
            let says = of.says.replace('|', "\\|");
            let _ = writeln!(text, "| {} | {} | {says} |", of.name, of.status);
        }
    }
    text
}
