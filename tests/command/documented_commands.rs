//! Every command of the README and of the guides is run, in a folder that contains nothing but the scenes.
//!
//! A documented command is a line of a ```console or ```sh block that starts with `bearing`, or
//! `$ bearing`. A comment `# exit code N` at its end states another exit code than 0. Commands of
//! one document run in order, in one folder, so that a later one may use what an earlier one wrote.
//!
//! What follows a command up to the next one, or to the end of its block, is what it prints: line by line, where `…`
//! stands for any number of lines. Numbers hold to the last digit but one, counts exactly; seconds of wall time and
//! megabytes are the machine's.

use crate::command_line_common::{done, json, scene, text};
use crate::outside_common::python_with_vtk;
use std::fs;
use std::path::Path;
use std::process::Command;

struct Documented {
    line: usize,
    arguments: Vec<String>,
    exit_code: i32,
    /// Lines shown below it.
    prints: Vec<String>,
}

#[test]
fn documented_commands_run() {
    run_all("README.md", &["statics", "run"]);
}

#[test]
fn commands_of_guides_run() {
    let mut uses = Vec::new();
    for page in pages_of_guide() {
        uses.extend(run_all(&page, &[]));
    }
    for name in ["check", "plan", "statics", "modes", "run", "sweep", "pack", "compare"] {
        assert!(uses.iter().any(|used| used == name), "no guide shows `bearing {name}`");
    }
}

fn pages_of_guide() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide");
    let names = fs::read_dir(folder).expect("docs/guide").map(|entry| entry.unwrap().file_name());
    let mut pages: Vec<String> =
        names.map(|name| format!("docs/guide/{}", name.to_string_lossy())).collect();
    pages.sort();
    assert!(pages.len() >= 9, "{pages:?}");
    pages
}

/// What docs/guide/run.md shows of Python reads what a run wrote.
#[test]
fn documented_python_reads_a_run() {
    // VTK brings NumPy.
    let Some(python) = python_with_vtk("documented_python_reads_a_run") else { return };
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results/settling-run");
    done(&["run", &scene("settling.toml"), "--out", &text(&out)]);
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/run.md");
    let page = fs::read_to_string(page).unwrap();
    let (_, block) = page.split_once("```python\n").expect("a block of Python");
    let (block, _) = block.split_once("```").unwrap();
    let ran = Command::new(python).args(["-c", block]).current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout);
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let words: Vec<&str> = said.split_whitespace().collect();
    let csv = fs::read_to_string(out.join("series.csv")).unwrap();
    let rows: Vec<&str> = csv.lines().collect();
    let at = rows[0].split(',').position(|name| name.starts_with("inner_z ")).unwrap();
    let last: f64 = rows[rows.len() - 1].split(',').nth(at).unwrap().parse().unwrap();
    assert_eq!(words[..2], ["True", &(rows.len() - 1).to_string()[..]], "{said}");
    assert_eq!(words[2].parse::<f64>().unwrap(), last, "{said}");
    assert_eq!(json(&out.join("summary.json"))["complete"], true);
}

#[test]
fn lines_are_read_as_a_shell_would() {
    let page = "text\n```console\n$ bearing sweep a.toml --vary \"k=1 um, 2 um\"  # exit code 2\n\
                output\n```\n```toml\nbearing = 1\n```\n    bearing indented\n";
    let found = documented(page);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].line, 3);
    assert_eq!(found[0].arguments, ["sweep", "a.toml", "--vary", "k=1 um, 2 um"]);
    assert_eq!(found[0].exit_code, 2);
    assert_eq!(found[0].prints, ["output"]);
}

/// Runs the commands of a page and returns their subcommands; `needed` must be among them.
fn run_all(page: &str, needed: &[&str]) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join(page)).expect(page);
    let commands = documented(&text);
    for name in needed {
        let shown = commands.iter().any(|c| c.arguments.first().is_some_and(|a| a == name));
        assert!(shown, "{page} shows no `bearing {name}`");
    }
    let folder = tempfile::tempdir().expect("temporary folder");
    copy_scenes(&root.join("scenes"), &folder.path().join("scenes"));
    for command in &commands {
        let output = Command::new(env!("CARGO_BIN_EXE_bearing"))
            .args(&command.arguments)
            .current_dir(folder.path())
            .output()
            .expect("the command starts");
        assert_eq!(
            output.status.code(),
            Some(command.exit_code),
            "{page}:{}: bearing {}\n{}",
            command.line,
            command.arguments.join(" "),
            String::from_utf8_lossy(&output.stderr)
        );
        let said = String::from_utf8_lossy(&output.stdout);
        if let Some(missing) = first_not_printed(&command.prints, &said) {
            panic!(
                "{page}:{}: bearing {} does not print, in this place,\n{missing}\nbut\n{said}",
                command.line,
                command.arguments.join(" ")
            );
        }
    }
    commands.into_iter().map(|command| command.arguments[0].clone()).collect()
}

/// The first of the shown lines that is not where it should be.
fn first_not_printed<'a>(shown: &'a [String], said: &str) -> Option<&'a str> {
    let said: Vec<&str> = said.lines().collect();
    let (mut next, mut gap) = (0, false);
    for line in shown {
        if line.trim() == "…" {
            gap = true;
            continue;
        }
        let last = if gap { said.len() } else { said.len().min(next + 1) };
        match (next..last).find(|at| is_the_same(line, said[*at])) {
            Some(at) => (next, gap) = (at + 1, false),
            None => return Some(line),
        }
    }
    None
}

/// Word by word.
fn is_the_same(shown: &str, printed: &str) -> bool {
    let words = |line: &str| -> Vec<String> { line.split_whitespace().map(String::from).collect() };
    let (shown, printed) = (words(shown), words(printed));
    let of_the_machine = |at: usize| {
        let unit = shown.get(at + 1).map_or("", String::as_str);
        unit == "MB" || (unit == "s" && shown.get(at + 2).is_some_and(|word| word == "on"))
    };
    shown.len() == printed.len()
        && shown.iter().zip(&printed).enumerate().all(|(at, (a, b))| {
            let bare = |word: &str| word.trim_end_matches([',', ';', ':']).to_string();
            let is_decimal = |word: &str| word.contains('.') && bare(word).parse::<f64>().is_ok();
            a == b
                || (of_the_machine(at) && b.parse::<f64>().is_ok())
                || (is_decimal(a) && is_decimal(b) && is_near(&bare(a), &bare(b)))
        })
}

/// Two decimals of one form that differ by one in the last digit at most.
fn is_near(a: &str, b: &str) -> bool {
    let (mantissa, exponent) = a.split_once('e').unwrap_or((a, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |parts| parts.1.len());
    let last = 10f64.powi(exponent.parse::<i32>().unwrap_or(0) - decimals as i32);
    let numbers = [a, b].map(|text| text.parse::<f64>().unwrap_or(f64::NAN));
    a.len() == b.len() && (numbers[0] - numbers[1]).abs() <= 1.5 * last
}

#[test]
fn shown_lines_are_held_to_their_numbers() {
    let shown = |lines: &[&str]| lines.iter().map(|line| line.to_string()).collect::<Vec<_>>();
    let said = "200000 steps to t = 0.2 s\nmoment  6.418743 N m\nplan 14 MB of\n9 points in 0.14 s on 2\nend\n";
    let good = [
        &["200000 steps to t = 0.2 s", "moment 6.418743 N m"][..],
        &["…", "  moment 6.418744 N m", "plan 15 MB of", "9 points in 0.20 s on 2"],
        &["…", "end"],
    ];
    for lines in good {
        assert_eq!(first_not_printed(&shown(lines), said), None);
    }
    let bad = [
        &["200001 steps to t = 0.2 s"][..],
        &["moment 6.418743 N m"],
        &["…", "moment 6.418745 N m"],
        &["…", "8 points in 0.14 s on 2"],
        &["200000 steps to t = 0.2 s", "…", "end", "end"],
        &["…", "plan 14 GB of"],
    ];
    for lines in bad {
        assert!(first_not_printed(&shown(lines), said).is_some(), "{lines:?}");
    }
}

fn copy_scenes(from: &Path, to: &Path) {
    fs::create_dir(to).expect("scenes folder");
    for entry in fs::read_dir(from).expect("scenes") {
        let path = entry.expect("scene").path();
        let copy = to.join(path.file_name().expect("file name"));
        if path.is_file() {
            fs::copy(&path, copy).expect("scene copied");
        } else {
            copy_scenes(&path, &copy);
        }
    }
}

fn documented(page: &str) -> Vec<Documented> {
    let mut found = Vec::new();
    let mut shell = false;
    let mut inside = false;
    let mut below = false;
    for (index, line) in page.lines().enumerate() {
        if let Some(language) = line.strip_prefix("```") {
            inside = !inside;
            shell = inside && ["console", "sh"].contains(&language.trim());
            continue;
        }
        if !shell {
            below = false;
            continue;
        }
        let Some(rest) = line.strip_prefix("$ ").unwrap_or(line).strip_prefix("bearing ") else {
            // Another shell's command shows what that prints.
            below &= !line.starts_with("$ ");
            if let (true, Some(command)) = (below, found.last_mut()) {
                let command: &mut Documented = command;
                command.prints.push(line.to_string());
            }
            continue;
        };
        below = true;
        let (command, comment) = rest.split_once(" # ").unwrap_or((rest, ""));
        let exit_code = comment
            .trim()
            .strip_prefix("exit code ")
            .map_or(0, |code| code.parse().expect("an exit code"));
        let arguments = words(command);
        found.push(Documented { line: index + 1, arguments, exit_code, prints: Vec::new() });
    }
    found
}

/// Words of a command line; double quotes keep spaces. Nothing else of a shell is needed here.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (index, part) in line.split('"').enumerate() {
        let quoted = index % 2 == 1;
        let mut pieces: Vec<String> =
            if quoted { vec![part.into()] } else { part.split(' ').map(String::from).collect() };
        // What touches a quote belongs to the same word.
        let first = pieces.remove(0);
        match words.last_mut() {
            Some(last) => *last += first.as_str(),
            None => words.push(first),
        }
        words.extend(pieces);
    }
    words.retain(|word| !word.is_empty());
    words
}
