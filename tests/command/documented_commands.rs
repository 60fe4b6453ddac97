//! Every command that the documents show is run, in a folder that holds nothing but the scenes.
//!
//! A documented command is a line of a ```console or ```sh block that starts with `bearing`, or
//! `$ bearing`. A comment `# exit code N` at its end states another exit code than 0. Commands of
//! one document run in order, in one folder, so that a later one may use what an earlier one wrote.

use std::fs;
use std::path::Path;
use std::process::Command;

struct Documented {
    line: usize,
    arguments: Vec<String>,
    exit_code: i32,
}

#[test]
fn documented_commands_run() {
    run_all(
        "README.md",
        &["check", "plan", "statics", "modes", "run", "sweep", "pack", "compare", "schema"],
    );
    run_all("docs/scene.md", &[]);
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
}

/// Runs the commands of a page; `needed` are subcommands of which it must show at least one use.
fn run_all(page: &str, needed: &[&str]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join(page)).expect(page);
    let commands = documented(&text);
    for name in needed {
        let shown = commands.iter().any(|c| c.arguments.first().is_some_and(|a| a == name));
        assert!(shown, "{page} shows no `bearing {name}`");
    }
    let folder = tempfile::tempdir().expect("temporary folder");
    copy_scenes(&root.join("scenes"), &folder.path().join("scenes"));
    for command in commands {
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
    for (index, line) in page.lines().enumerate() {
        if let Some(language) = line.strip_prefix("```") {
            inside = !inside;
            shell = inside && ["console", "sh"].contains(&language.trim());
            continue;
        }
        let Some(rest) = line.strip_prefix("$ ").unwrap_or(line).strip_prefix("bearing ") else {
            continue;
        };
        if !shell {
            continue;
        }
        let (command, comment) = rest.split_once(" # ").unwrap_or((rest, ""));
        let exit_code = comment
            .trim()
            .strip_prefix("exit code ")
            .map_or(0, |code| code.parse().expect("an exit code"));
        found.push(Documented { line: index + 1, arguments: words(command), exit_code });
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
