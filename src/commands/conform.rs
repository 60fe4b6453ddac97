//! `bearing conform SET --with COMMAND`: runs a program on every pack of a set and compares its results.

use super::{CommandResult, Outcome, interruption, print};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::compare::tolerance::Tolerances;
use bearing_dynamics::output::compare::{Options, compare, report};
use bearing_dynamics::output::json;
use bearing_dynamics::output::pack::{About, MANIFEST, Manifest, RESOLVED, verify_pack};
use bearing_dynamics::output::results::pretty;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Exit code of a program that does not claim a pack.
const NOT_CLAIMED: i32 = 3;
/// Exit code for a scene that is not valid.
const REFUSED: i32 = 2;
/// Words in braces that a command may have.
const REPLACED: [&str; 4] = ["resolved", "out", "kind", "scene"];
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
    /// Folder of results and report; after an interruption packs that passed there are not run again
    #[arg(long, default_value = "results/conform")]
    out: PathBuf,
    /// Run all packs again
    #[arg(long)]
    fresh: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    Passed,
    Failed,
    #[serde(rename = "not claimed")]
    NotClaimed,
    #[serde(rename = "timed out")]
    TimedOut,
}

impl Status {
    const ALL: [(Status, &str); 4] = [
        (Status::Passed, "passed"),
        (Status::Failed, "failed"),
        (Status::NotClaimed, "not claimed"),
        (Status::TimedOut, "timed out"),
    ];

    fn name(self) -> &'static str {
        Status::ALL[self as usize].1
    }

    fn is_failure(self) -> bool {
        matches!(self, Status::Failed | Status::TimedOut)
    }
}

/// A pack and what became of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Verdict {
    name: String,
    about: About,
    status: Status,
    /// First difference, or what the program said.
    says: String,
    /// Groups of which the program has no channels.
    unclaimed: Vec<String>,
    /// Number of first rows that were compared, of a chaotic run.
    rows: Option<usize>,
    /// Wall time of the program and of this one, s.
    seconds: [f64; 2],
    /// Hash of the pack, of the command and of the files that it names.
    key: String,
    /// Taken from an earlier run.
    #[serde(skip)]
    earlier: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let all = manifests(arguments)?;
    refuse_unknown(arguments, &all)?;
    let packs = wanted(arguments, all);
    if packs.is_empty() {
        let set = arguments.set.display();
        let why = match arguments.set.join(MANIFEST).exists() {
            true => "is one case pack. Hint: name the folder that holds it",
            false => "no case packs that need only these tags, at this level",
        };
        return Err(format!("{set}: {why}").into());
    }
    // Only what an interruption has left is gone on with: behind the same command there may be another program.
    let finished = arguments.out.join("results.json");
    let goes_on = !arguments.fresh && !finished.exists();
    let _ = std::fs::remove_file(&finished);
    let interrupted = interruption(|| std::process::exit(1))?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs.into()).build()?;
    let verdicts: Result<Vec<Verdict>, String> = pool.install(|| {
        let each = packs.into_par_iter();
        each.map(|(name, manifest)| {
            let verdict = judge(arguments, &name, manifest.about, goes_on, &interrupted)
                .map_err(|e| format!("{name}: {e}"))?;
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
    let all = pretty(&serde_json::to_value(&verdicts)?);
    write_atomic(&finished, all.as_bytes())?;
    print(&format!("wrote results.json and report.md to {}\n", arguments.out.display()))?;
    Ok(if verdicts.iter().any(|of| of.status.is_failure()) {
        Outcome::Different
    } else {
        Outcome::Done
    })
}

/// Refuses tags that no pack has, and parts of the command in braces that are not replaced.
fn refuse_unknown(arguments: &Arguments, all: &[(String, Manifest)]) -> Result<(), Box<dyn Error>> {
    let known: BTreeSet<&str> =
        all.iter().flat_map(|(_, of)| &of.about.tags).map(String::as_str).collect();
    if let Some(tag) = arguments.tags.iter().find(|tag| !known.contains(tag.as_str())) {
        let known: Vec<&str> = known.into_iter().collect();
        return Err(format!("--tags {tag}: no pack has it; tags are {}", known.join(", ")).into());
    }
    // Variables of the shell are no words of ours.
    let command = arguments.with.replace("${", "");
    let words = command.split('{').skip(1).filter_map(|rest| rest.split_once('}'));
    let is_name = |word: &str| word.chars().all(|c| c.is_ascii_lowercase());
    let mut words = words.map(|(word, _)| word).filter(|word| !word.is_empty() && is_name(word));
    match words.find(|word| !REPLACED.contains(word)) {
        Some(word) => {
            let names = REPLACED.map(|name| format!("{{{name}}}")).join(", ");
            Err(format!("--with {{{word}}}: replaced are {names}").into())
        }
        None => Ok(()),
    }
}

/// Names and manifests of the packs asked for.
fn wanted(arguments: &Arguments, mut found: Vec<(String, Manifest)>) -> Vec<(String, Manifest)> {
    let claimed: BTreeSet<&String> = arguments.tags.iter().collect();
    found.retain(|(_, Manifest { about, .. })| {
        let level = arguments.level.is_none_or(|level| level == about.level);
        level && (claimed.is_empty() || about.tags.iter().all(|tag| claimed.contains(tag)))
    });
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

/// Names and manifests of all packs of the set.
fn manifests(arguments: &Arguments) -> Result<Vec<(String, Manifest)>, Box<dyn Error>> {
    let mut found = Vec::new();
    let entries = std::fs::read_dir(&arguments.set)
        .map_err(|error| format!("cannot read {}: {error}", arguments.set.display()))?;
    for entry in entries {
        let folder = entry?.path();
        if !folder.join(MANIFEST).exists() {
            continue;
        }
        let manifest =
            verify_pack(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        found.push((name, manifest));
    }
    Ok(found)
}

/// Runs the program on a pack, or takes what an earlier command found.
fn judge(
    arguments: &Arguments,
    name: &str,
    about: About,
    goes_on: bool,
    interrupted: &AtomicBool,
) -> Result<Verdict, Box<dyn Error>> {
    let pack = arguments.set.join(name);
    let folder = arguments.out.join(name);
    let path = folder.join("verdict.json");
    let key = key(arguments, &pack)?;
    let known = std::fs::read(&path).ok().filter(|_| goes_on);
    let known: Option<Verdict> = known.and_then(|bytes| serde_json::from_slice(&bytes).ok());
    // The program behind the same command may be another by now.
    let kept = |known: &Verdict| known.key == key && known.status == Status::Passed;
    if let Some(known) = known.filter(kept) {
        return Ok(Verdict { earlier: true, ..known });
    }
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder)?;
    let timeout = Duration::try_from_secs_f64(arguments.timeout)
        .map_err(|_| format!("--timeout {}: allowed are seconds from 0", arguments.timeout))?;
    let until = (timeout, interrupted);
    let run =
        |command: &str, out: &str| execute(command, &pack, &about.kind, &folder.join(out), until);
    let found = run(&arguments.with, "out")?;
    let (status, says, unclaimed) = verdict(&pack, &about.kind, &folder.join("out"), &found)?;
    let mut seconds = [found.seconds, 0.0];
    if status != Status::NotClaimed {
        let own = std::env::current_exe()?;
        let own = format!("'{}' {{kind}} {{resolved}} --out {{out}}", own.display());
        seconds[1] = run(&own, "ours")?.seconds;
        let _ = std::fs::remove_dir_all(folder.join("ours"));
    }
    let rows = Tolerances::read(&pack.join("tolerances.json"))?.rows;
    let name = name.to_string();
    let verdict =
        Verdict { name, about, status, says, unclaimed, rows, seconds, key, earlier: false };
    write_atomic(&path, pretty(&serde_json::to_value(&verdict)?).as_bytes())?;
    Ok(verdict)
}

/// Hash of a pack, of the command that is run on it, and of the files that the command names: the program may have been
/// built again.
fn key(arguments: &Arguments, pack: &Path) -> Result<String, Box<dyn Error>> {
    let manifest = std::fs::read(pack.join(MANIFEST))?;
    let mut hash = Sha256::new().chain_update(manifest).chain_update(&arguments.with);
    for word in arguments.with.split_whitespace().map(|word| word.trim_matches(['\'', '"'])) {
        if Path::new(word).is_file() {
            hash.update(std::fs::read(word)?);
        }
    }
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

impl Executed {
    fn code(&self) -> String {
        self.code.map_or("none (a signal)".into(), |code| code.to_string())
    }
}

fn execute(
    command: &str,
    pack: &Path,
    kind: &str,
    out: &Path,
    (timeout, interrupted): (Duration, &AtomicBool),
) -> Result<Executed, Box<dyn Error>> {
    let quoted = |path: &Path| format!("'{}'", path.display());
    let scene = ["scene.toml", "scene.json"].map(|name| pack.join(name));
    let scene = scene.iter().find(|path| path.exists()).cloned().unwrap_or_default();
    // A scene that is not valid has no resolved form, and is refused by any command.
    let refused = kind == "refused";
    let (resolved, kind) =
        if refused { (scene.clone(), "statics") } else { (pack.join(RESOLVED), kind) };
    let line = command
        .replace("{resolved}", &quoted(&resolved))
        .replace("{scene}", &quoted(&scene))
        .replace("{kind}", kind)
        .replace("{out}", &quoted(out));
    let log = out.with_extension("log");
    let file = std::fs::File::create(&log)?;
    let start = Instant::now();
    let mut shell = Command::new("sh");
    shell.args(["-c", &line]).stdin(Stdio::null()).stdout(file.try_clone()?).stderr(file);
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut shell, 0);
    let mut child = shell.spawn()?;
    let (code, late) = loop {
        if let Some(status) = child.try_wait()? {
            break (status.code(), false);
        }
        let ends = interrupted.load(Ordering::Relaxed);
        if ends || start.elapsed() > timeout {
            // The shell is the first of its group; what it has started ends with it.
            let group = format!("-{}", child.id());
            let _ = Command::new("kill").args(["-KILL", "--", &group]).status();
            let _ = child.kill();
            child.wait()?;
            if ends {
                return Err("interrupted; the same command continues".into());
            }
            break (None, true);
        }
        std::thread::sleep(GLANCE);
    };
    let seconds = start.elapsed().as_secs_f64();
    let said = String::from_utf8_lossy(&std::fs::read(&log)?).into_owned();
    Ok(Executed { code, late, said, seconds })
}

/// Status, first difference, and groups of channels that are left out.
fn verdict(
    pack: &Path,
    kind: &str,
    out: &Path,
    found: &Executed,
) -> Result<(Status, String, Vec<String>), Box<dyn Error>> {
    let last = found.said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let with = |status: Status, says: String| Ok((status, says, Vec::new()));
    if found.late {
        return with(Status::TimedOut, format!("after {:.0} s", found.seconds));
    }
    if found.code == Some(NOT_CLAIMED) {
        return with(Status::NotClaimed, last.into());
    }
    if kind == "refused" {
        let refused = &json::read(&pack.join("summary.json"))?["refused"];
        let key = refused["key"].as_str().unwrap_or_default();
        let line = refused["line"].as_u64();
        if found.code != Some(REFUSED) {
            let says = format!("exit code {} for a scene that is not valid", found.code());
            return with(Status::Failed, says);
        }
        let mut naming = found.said.lines().filter(|said| has_word(said, key)).peekable();
        if naming.peek().is_none() {
            return with(Status::Failed, format!("the message does not name {key}: {last}"));
        }
        let is_placed = |said: &str| {
            line.is_none_or(|line| {
                let places = [format!("scene.toml:{line}"), format!("line {line}")];
                places.iter().any(|place| has_word(said, place))
            })
        };
        return match naming.any(is_placed) {
            true => with(Status::Passed, String::new()),
            false => with(Status::Failed, format!("the message does not name the line: {last}")),
        };
    }
    if found.code != Some(0) {
        return with(Status::Failed, format!("exit code {}: {last}", found.code()));
    }
    match compare(pack, out, &Options::default()) {
        Err(error) => with(Status::Failed, error.to_string()),
        Ok(compared) if compared.equal => Ok((Status::Passed, String::new(), compared.unclaimed)),
        Ok(compared) => {
            let text = report(&compared);
            let lines: Vec<&str> = text.lines().skip(1).take(2).map(str::trim).collect();
            Ok((Status::Failed, lines.join(": "), compared.unclaimed))
        }
    }
}

/// Returns whether a text has a key (or one below it) or a number, and not as the beginning of a longer one.
fn has_word(text: &str, word: &str) -> bool {
    let goes_on = |rest: &str| rest.starts_with(|next: char| next.is_alphanumeric() || next == '_');
    text.match_indices(word).any(|(at, _)| !goes_on(&text[at + word.len()..]))
}

fn line(of: &Verdict) -> String {
    let [own, ours] = of.seconds;
    let mut text =
        format!("{:<12} {:<40} {own:>9.3} s, ours {ours:.3} s", of.status.name(), of.name);
    if !of.unclaimed.is_empty() {
        let _ = write!(text, "; without {}", of.unclaimed.join(", "));
    }
    if let Some(rows) = of.rows {
        let _ = write!(text, "; chaotic, first {rows} rows and statistics");
    }
    if of.earlier {
        text += "; of an earlier run";
    }
    if !of.says.is_empty() {
        let _ = write!(text, "\n             {}", of.says);
    }
    text + "\n"
}

/// Counts by level and by tag.
fn table(verdicts: &[Verdict], elapsed: Duration) -> String {
    let mut rows: BTreeMap<String, ([usize; 4], [f64; 2])> = BTreeMap::new();
    for of in verdicts {
        let about = &of.about;
        let tags = about.tags.iter().map(|tag| format!("tag {tag}"));
        let groups = [format!("level {}", about.level), "~ all".into()].into_iter().chain(tags);
        for group in groups {
            let (counts, seconds) = rows.entry(group).or_default();
            counts[of.status as usize] += 1;
            for (sum, own) in seconds.iter_mut().zip(of.seconds) {
                *sum += own;
            }
        }
    }
    let mut text = format!("{:<28}", "");
    Status::ALL.iter().for_each(|(_, name)| text += &format!("{name:>12}"));
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
    let earlier = verdicts.iter().filter(|of| of.earlier).count();
    if earlier > 0 {
        let _ = writeln!(text, "\n{earlier} results are of an earlier run of the same program.");
    }
    for of in verdicts {
        let Some(rows) = of.rows else { continue };
        let _ = writeln!(
            text,
            "\n{} is chaotic: its first {rows} rows are compared, and statistics.",
            of.name
        );
    }
    let mut partly = verdicts.iter().filter(|of| !of.unclaimed.is_empty()).peekable();
    if partly.peek().is_some() {
        text += "\n## Groups of channels left out\n\n| Pack | Without |\n|---|---|\n";
        for of in partly {
            let _ = writeln!(text, "| {} | {} |", of.name, of.unclaimed.join(", "));
        }
    }
    let missed: Vec<&Verdict> = verdicts.iter().filter(|of| of.status != Status::Passed).collect();
    if !missed.is_empty() {
        text +=
            "\n## Not passed\n\n| Pack | Status | First difference or reason |\n|---|---|---|\n";
        for of in missed {
            let says = of.says.replace('|', "\\|");
            let _ = writeln!(text, "| {} | {} | {says} |", of.name, of.status.name());
        }
    }
    text
}
