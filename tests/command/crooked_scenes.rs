//! Scenes in which nothing is even, central or zero (`tests/data/crooked`) say what they said: every number and word
//! that their commands print and write, held against `golden/crooked`.
//!
//! The scenes of `scenes/` are of a user's kind: symmetric, at the origin, loaded along one axis, so that a lost sign or a
//! swapped index goes unseen in them. These have as many keys as go together, each with a value of its own. What is
//! right is judged by laws and cases; this only sees that something changed.
//!
//! To accept a change, its reason kept beside the numbers: `make golden CASE=crooked REASON="…"`.

use crate::command_line_common::{changed, done, files, json, read, text, write};
use bearing_dynamics::output::npy;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Of a number, against itself: what another processor's order of sums moves in a few milliseconds of motion is below
/// 1e-9, what these scenes are for is above 1e-3.
const DIFFERENCE: f64 = 1e-6;

/// Columns below this part of the largest of their unit are rounding.
const ROUNDING: f64 = 1e-11;

/// What is left of zero where metres, radians, newtons cancel.
const NOTHING: f64 = 1e-12;

/// What is nearly zero, and of which the size alone says something: within a factor of this.
const NEARLY_ZERO: [&str; 4] = ["residual", "unaccounted", "unbalanced", "out_of_round"];
const FACTOR: f64 = 1e3;

/// Of the summary: what other lines say already, and what depends on the machine.
const NOT_HELD: [&str; 10] = [
    ":plan:",
    ":stages:",
    ":final:",
    ":timings:",
    ":run:",
    ":program",
    ":version",
    ":scene",
    ":echo:",
    ":seconds:",
];

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Numbers and the text between them.
fn pieces(line: &str) -> Vec<(&str, Option<f64>)> {
    let mut found = Vec::new();
    let (mut text, mut at) = (0, 0);
    let bytes = line.as_bytes();
    while at < bytes.len() {
        let after_word = at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_');
        if after_word || !bytes[at].is_ascii_digit() {
            at += 1;
            continue;
        }
        let start = if at > 0 && matches!(bytes[at - 1], b'-' | b'+') { at - 1 } else { at };
        let mut end = at + 1;
        while end < bytes.len() {
            let exponent = matches!(bytes[end - 1], b'e') && matches!(bytes[end], b'-' | b'+');
            let e = bytes[end] == b'e'
                && bytes
                    .get(end + 1)
                    .is_some_and(|b| b.is_ascii_digit() || matches!(b, b'-' | b'+'));
            if bytes[end].is_ascii_digit() || bytes[end] == b'.' || exponent || e {
                end += 1;
            } else {
                break;
            }
        }
        let end = if line[..end].ends_with('.') { end - 1 } else { end };
        if let Ok(value) = line[start..end].parse() {
            found.push((&line[text..start], None));
            found.push((&line[start..end], Some(value)));
            text = end;
        }
        at = end.max(at + 1);
    }
    found.push((&line[text..], None));
    found
}

/// Half of the last digit that is printed, twice: two roundings.
fn last_digit(printed: &str) -> f64 {
    let (digits, exponent) = printed.split_once('e').unwrap_or((printed, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    10f64.powi(exponent.parse::<i32>().unwrap_or(0) - decimals as i32)
}

fn alike(before: &str, now: &str) -> bool {
    let (before_pieces, now_pieces) = (pieces(before), pieces(now));
    let nearly_zero = NEARLY_ZERO.iter().any(|word| before.contains(word));
    before_pieces.len() == now_pieces.len()
        && before_pieces.iter().zip(&now_pieces).all(|(a, b)| match (a.1, b.1) {
            (Some(x), Some(y)) if nearly_zero => {
                x.abs() <= FACTOR * y.abs() + 1e-12 && y.abs() <= FACTOR * x.abs() + 1e-12
            }
            (Some(x), Some(y)) => {
                let printed = if a.0.contains('.') {
                    1.01 * last_digit(a.0).max(last_digit(b.0))
                } else {
                    0.0
                };
                (x - y).abs() <= (DIFFERENCE * x.abs()).max(printed).max(NOTHING)
            }
            (None, None) => a.0 == b.0,
            _ => false,
        })
}

/// What is printed, without times of the clock and places of files.
fn words(printed: &str, out: &Path) -> String {
    let clocked = ["wrote ", "notes table"];
    let elsewhere = [" MB of memory", "wall time", "processor time", "written to"];
    let mut lines = String::new();
    for line in printed.lines() {
        let starts = |word: &&str| line.trim_start().starts_with(word);
        if clocked.iter().any(starts) || elsewhere.iter().any(|part| line.contains(part)) {
            continue;
        }
        let line = line.replace(&text(out), "OUT").replace(env!("CARGO_MANIFEST_DIR"), "");
        let line = without_time(&line);
        writeln!(lines, "{}", line.trim_end()).unwrap();
    }
    lines
}

/// A count without the time that it took: `1028 in 0.37 s` as `1028`.
fn without_time(line: &str) -> String {
    let Some((count, rest)) = line.split_once(" in ") else { return line.into() };
    match rest.split_once(" s") {
        Some((time, rest)) if time.parse::<f64>().is_ok() => format!("{count}{rest}"),
        _ => line.into(),
    }
}

/// `:place value unit` of each number and word.
fn leaves(of: &Value, at: &str, to: &mut String) {
    if NOT_HELD.iter().any(|part| format!("{at}:").contains(part)) {
        return;
    }
    match of {
        Value::Object(entries) if entries.contains_key("value") && entries.contains_key("unit") => {
            let value = entries["value"].as_f64().map_or(entries["value"].to_string(), number);
            writeln!(to, "{at} {value} {}", entries["unit"].as_str().unwrap_or_default()).unwrap();
        }
        Value::Object(entries) => {
            entries.iter().for_each(|(key, value)| leaves(value, &format!("{at}:{key}"), to))
        }
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, value)| leaves(value, &format!("{at}:{i}"), to));
        }
        Value::Number(value) => writeln!(to, "{at} {}", number(value.as_f64().unwrap())).unwrap(),
        other => writeln!(to, "{at} {other}").unwrap(),
    }
}

fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e9 {
        format!("{value}")
    } else {
        format!("{value:.9e}")
    }
}

/// Of each column the largest value and a sum whose weights tell rows that change places.
fn columns(out: &Path, to: &mut String) {
    let names = json(&out.join("series.columns.json"));
    let rows = npy::parse(&fs::read(out.join("series.npy")).unwrap()).unwrap();
    let mut largest = BTreeMap::new();
    let named: Vec<(&str, &str)> = names
        .as_array()
        .expect("a list of columns")
        .iter()
        .map(|column| {
            (column["name"].as_str().expect("a name"), column["unit"].as_str().unwrap_or("-"))
        })
        .collect();
    assert_eq!(rows.ncols(), named.len());
    let most =
        |values: &ndarray::ArrayView1<f64>| values.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    for ((_, unit), values) in named.iter().zip(rows.columns()) {
        let unit: &mut f64 = largest.entry(*unit).or_default();
        *unit = unit.max(most(&values));
    }
    for ((name, unit), values) in named.iter().zip(rows.columns()) {
        let floor = ROUNDING * largest[unit];
        let kept = |v: f64| if v.abs() <= floor { 0.0 } else { v };
        let weighed: f64 =
            values.iter().enumerate().map(|(i, v)| kept(*v) * (1.0 + (i % 7) as f64)).sum();
        let nearly_zero = if name.contains("residual") { "" } else { "column " };
        writeln!(
            to,
            "{nearly_zero}{name} {} {} {unit}",
            number(kept(most(&values))),
            number(kept(weighed))
        )
        .unwrap();
    }
}

/// The same of every other table in a folder, such as a Campbell diagram or a spectrum.
fn tables(out: &Path, to: &mut String) {
    for name in files(out).iter().filter(|name| name.ends_with(".csv") && *name != "series.csv") {
        let table = read(&out.join(name));
        let mut lines = table.lines();
        let heads: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
        let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
        for (i, head) in heads.iter().enumerate() {
            let values: Vec<f64> = rows.iter().filter_map(|row| row.get(i)?.parse().ok()).collect();
            let largest = values.iter().fold(0.0f64, |most, v| most.max(v.abs()));
            let weighed: f64 =
                values.iter().enumerate().map(|(i, v)| v * (1.0 + (i % 7) as f64)).sum();
            let weighed = if weighed.abs() <= 1e-9 * largest { 0.0 } else { weighed };
            writeln!(to, "{name} {head} {} {} {}", rows.len(), number(largest), number(weighed))
                .unwrap();
        }
    }
}

/// What is written in each picture: its heading, axes, the numbers along them, the names of its curves. Numbers beside what is
/// unaccounted for alone are rounding.
fn pictures(out: &Path, to: &mut String) {
    for name in files(out).iter().filter(|name| name.ends_with(".svg")) {
        let picture = read(&out.join(name));
        let mut parts: Vec<&str> = picture.split("</text>").collect();
        parts.pop();
        let text = |part: &&str| part.rsplit('>').next().unwrap_or_default().trim().to_string();
        let mut texts: Vec<String> = parts.iter().map(text).collect();
        assert!(!texts.is_empty(), "{name}");
        if texts.last().is_some_and(|last| last == "unaccounted for") {
            texts.retain(|text| text.parse::<f64>().is_err());
        }
        writeln!(to, "{name} {}", texts.join(" | ")).unwrap();
    }
}

/// Half a run, taken up again, has the rows of the unbroken one.
fn resumes(file: &Path, whole: &str, folder: &Path, out: &Path) {
    let content = read(file);
    let end = content.lines().find_map(|line| line.strip_prefix("end = \"")).expect("an end");
    let (value, unit) = end.split_once('"').expect("a text").0.split_once(' ').expect("a unit");
    let half = format!("{} {unit}", 0.5 * value.parse::<f64>().expect("a number"));
    let half = changed(&content, &format!("end = \"{end}"), &format!("end = \"{half}\""));
    let half = write(folder, "half.toml", &half);
    let to = text(out);
    done(&["run", &half, "--out", &to]);
    let said = done(&["run", &text(file), "--out", &to, "--resume"]);
    assert!(said.contains("resumed at"), "{}: {said}", file.display());
    let resumed = read(&out.join("series.csv"));
    let apart = whole.lines().zip(resumed.lines()).find(|(one, other)| one != other);
    assert!(apart.is_none() && whole.len() == resumed.len(), "{}: {apart:?}", file.display());
}

/// All that the commands of a scene say and write.
fn said(file: &Path) -> String {
    let commands = read(file);
    let commands = commands
        .lines()
        .next()
        .and_then(|line| line.strip_prefix("# commands: "))
        .expect("commands");
    let (mut all, mut rows) = (String::new(), String::new());
    for command in commands.split(", ") {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let (scene, to) = (text(file), text(&out));
        writeln!(all, "== {command}").unwrap();
        match command {
            "check" => {
                all += &words(&done(&["check", &scene]), &out);
                let printed = done(&["check", "--json", &scene]);
                leaves(&serde_json::from_str(&printed).expect("JSON"), "", &mut all);
            }
            "plan" => all += &words(&done(&["plan", &scene]), &out),
            "sweep" => {
                all += &words(&done(&["sweep", &scene, "--out", &to]), &out);
                all += &read(&out.join("sweep.csv"));
            }
            "resume" => resumes(file, &rows, folder.path(), &out),
            "pack" => {
                all += &words(&done(&["pack", &scene, "--out", &to]), &out);
            }
            _ => {
                all += &words(&done(&[command, &scene, "--out", &to]), &out);
                leaves(&json(&out.join("summary.json")), "", &mut all);
                columns(&out, &mut all);
                tables(&out, &mut all);
                pictures(&out, &mut all);
                if command == "run" {
                    rows = read(&out.join("series.csv"));
                }
            }
        }
    }
    all
}

#[test]
fn crooked_scenes_say_what_they_said() {
    let scenes = folder("tests/data/crooked");
    let names: Vec<String> = files(&scenes)
        .iter()
        .filter_map(|file| file.strip_suffix(".toml").map(String::from))
        .collect();
    assert!(names.len() >= 20, "{names:?}");
    let (next, results) = (Mutex::new(names.iter()), Mutex::new(BTreeMap::new()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let Some(name) = next.lock().unwrap().next() else { return };
                    let now = said(&scenes.join(name).with_extension("toml"));
                    results.lock().unwrap().insert(name.clone(), now);
                }
            });
        }
    });
    let results = results.into_inner().unwrap();
    let golden = folder("golden/crooked");
    if let Ok(reason) = std::env::var("FREEZE_REASON") {
        assert!(reason.trim().len() >= 10, "a reason for new numbers: {reason:?}");
        let reasons = golden.join("reasons.txt");
        let before = fs::read_to_string(&reasons).unwrap_or_default();
        fs::create_dir_all(&golden).unwrap();
        fs::write(reasons, format!("{before}{reason}\n")).unwrap();
        for (name, now) in results {
            fs::write(golden.join(name).with_extension("txt"), now).unwrap();
        }
        return;
    }
    let held: Vec<String> = files(&golden)
        .iter()
        .filter_map(|f| f.strip_suffix(".txt"))
        .filter(|f| *f != "reasons")
        .map(String::from)
        .collect();
    assert_eq!(held, names, "every scene is held, and every one that is held is there");
    let mut different = Vec::new();
    for (name, now) in &results {
        let before = read(&golden.join(name).with_extension("txt"));
        let (before, now): (Vec<&str>, Vec<&str>) =
            (before.lines().collect(), now.lines().collect());
        if before.len() != now.len() {
            different.push(format!("{name}: {} lines became {}", before.len(), now.len()));
        }
        for (before, now) in
            before.iter().zip(&now).filter(|(before, now)| !alike(before, now)).take(20)
        {
            different.push(format!("{name}:\n  {before}\n  {now}"));
        }
    }
    assert!(different.is_empty(), "{} differences:\n{}", different.len(), different.join("\n"));
}

#[test]
fn lines_are_alike_to_the_last_digit_that_is_printed_and_to_1e_6() {
    assert!(alike("load 12.50 N at 3 deg", "load 12.51 N at 3 deg"));
    assert!(!alike("load 12.50 N", "load 12.52 N"));
    assert!(alike("/a 1.000000000e-3 m", "/a 1.000000900e-3 m"));
    assert!(!alike("/a 1.000000000e-3 m", "/a 1.000002000e-3 m"));
    assert!(!alike("/a -1.5e0 m", "/a 1.5e0 m") && !alike("ball 3", "ball 4"));
    assert!(!alike("right inner", "left inner") && !alike("/a NaN", "/a 1.0"));
    assert!(
        alike("residual 1e-12 J", "residual 5e-11 J")
            && !alike("residual 1e-9 J", "residual 1e-5 J")
    );
    assert!(alike("/a 5e-14 N m", "/a -3e-15 N m"));
    assert_eq!(without_time("steps  1028 in 0.37 s; 2 of"), "steps  1028; 2 of");
    assert_eq!(without_time("held in the bore s"), "held in the bore s");
    assert!(!alike("bearing 6 has", "bearing 6 and 7 has"));
}
