//! The invariants of ARCHITECTURE.md that a reader of the source can check: which module may know
//! which, who may print and touch files, what the oracles may not see, what the repository holds.
//!
//! Comments and string literals are blanked before anything is looked for, so prose is free.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Modules of the library and the command from the innermost outwards; each may import only those
/// before it.
const LAYERS: [&str; 20] = [
    "kinematics",
    "mesh",
    "elements",
    "ch2_housing",
    "ch3_bushing",
    "ch4_rotor",
    "ch5_cage",
    "numeric",
    "plan",
    "solids",
    "members",
    "assembly",
    "equilibrium",
    "reduction",
    "motion",
    "vibrations",
    "scene",
    "output",
    "commands",
    "main",
];

/// Folders of the solver.
const SOLVER: [&str; 9] = [
    "numeric",
    "plan",
    "solids",
    "members",
    "assembly",
    "equilibrium",
    "reduction",
    "motion",
    "vibrations",
];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|name| *name == module)
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// `source` with comments, strings and character literals blanked; lines keep their numbers.
fn code_only(source: &str) -> String {
    let chars: Vec<char> = source.chars().collect();
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    let mut code = String::with_capacity(source.len());
    let mut i = 0;
    while i < chars.len() {
        let end = match (at(i), at(i + 1)) {
            ('/', '/') => (i..chars.len()).find(|&j| at(j) == '\n').unwrap_or(chars.len()),
            ('/', '*') => end_of_block_comment(&chars, i),
            ('"', _) => end_of_string(&chars, i),
            ('r', '"' | '#') if i == 0 || !is_word(at(i - 1)) || at(i - 1) == 'b' => {
                end_of_raw_string(&chars, i).unwrap_or(i)
            }
            // A character literal; anything else after an apostrophe is a lifetime.
            ('\'', '\\') => (i + 3..chars.len()).find(|&j| at(j) == '\'').map_or(i, |j| j + 1),
            ('\'', _) if at(i + 2) == '\'' => i + 3,
            _ => i,
        };
        if end == i {
            code.push(at(i));
            i += 1;
        } else {
            code.extend(chars[i..end].iter().map(|&c| if c == '\n' { '\n' } else { ' ' }));
            i = end;
        }
    }
    code
}

fn end_of_block_comment(chars: &[char], start: usize) -> usize {
    let mut depth = 0;
    let mut i = start;
    while i + 1 < chars.len() {
        match (chars[i], chars[i + 1]) {
            ('/', '*') => (depth, i) = (depth + 1, i + 2),
            ('*', '/') => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            return i;
        }
    }
    chars.len()
}

fn end_of_string(chars: &[char], start: usize) -> usize {
    let mut i = start + 1;
    while i < chars.len() && chars[i] != '"' {
        i += if chars[i] == '\\' { 2 } else { 1 };
    }
    (i + 1).min(chars.len())
}

/// `None` when `start` does not open a raw string (a raw identifier, for example).
fn end_of_raw_string(chars: &[char], start: usize) -> Option<usize> {
    let hashes = chars[start + 1..].iter().take_while(|&&c| c == '#').count();
    let open = start + 1 + hashes;
    if chars.get(open) != Some(&'"') {
        return None;
    }
    let close = (open + 1..chars.len()).find(|&j| {
        chars[j] == '"'
            && chars[j + 1..].iter().take(hashes).filter(|&&c| c == '#').count() == hashes
    });
    Some(close.map_or(chars.len(), |j| j + 1 + hashes))
}

/// Byte offsets at which `word` stands in `code`, not as a part of a longer name.
fn words<'a>(code: &'a str, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    code.match_indices(word).map(|(at, _)| at).filter(move |&at| {
        let before = code[..at].chars().next_back();
        let after = code[at + word.len()..].chars().next();
        let ends_in_word = word.ends_with(is_word);
        let continues = ends_in_word && after.is_some_and(is_word);
        !(before.is_some_and(is_word) || continues)
    })
}

fn line_of(code: &str, at: usize) -> usize {
    code[..at].matches('\n').count() + 1
}

/// First names of the paths that follow a `::`: `["a"]` for `a::b`, `["a", "c"]` for `{a::b, c}`.
fn first_names(rest: &str) -> Vec<String> {
    let rest = rest.trim_start();
    let Some(group) = rest.strip_prefix('{') else {
        let rest = rest.strip_prefix("r#").unwrap_or(rest);
        let name: String = rest.chars().take_while(|&c| is_word(c) || c == '*').collect();
        return if name.is_empty() { Vec::new() } else { vec![name] };
    };
    let mut names = Vec::new();
    let mut depth = 0;
    let mut start = 0;
    for (at, c) in group.char_indices() {
        match c {
            ',' if depth == 0 => {
                names.extend(first_names(&group[start..at]));
                start = at + 1;
            }
            '}' if depth == 0 => {
                names.extend(first_names(&group[start..at]));
                break;
            }
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
    }
    names
}

/// Names reached through `root::` (or through `use {root::…}`), with their lines.
fn reached<'a>(code: &'a str, root: &'a str) -> impl Iterator<Item = (usize, String)> + 'a {
    words(code, root).flat_map(move |at| {
        let rest = code[at + root.len()..].trim_start().strip_prefix("::").unwrap_or("");
        first_names(rest).into_iter().map(move |name| (line_of(code, at), name))
    })
}

/// Names a file reaches at the root of its crate by climbing: `super::super::solver` in `a/b.rs`.
fn climbed(code: &str, depth: usize) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for at in words(code, "super") {
        if code[..at].trim_end().ends_with("super::") {
            continue;
        }
        let (mut rest, mut levels) = (&code[at..], 0);
        while let Some(next) = rest.strip_prefix("super::") {
            (rest, levels) = (next, levels + 1);
        }
        // An inline module adds a level, so a longer climb may also end at the root.
        if levels >= depth {
            found.extend(first_names(rest).into_iter().map(|name| (line_of(code, at), name)));
        }
    }
    found
}

/// Modules from the crate root to `file` (relative to `src`): `["a", "b"]` for `a/b.rs`, `a/b/mod.rs`.
fn module_path(file: &Path) -> Vec<String> {
    let mut parts: Vec<String> =
        file.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    parts
}

/// Imports of one source file (path relative to `src`) that go against the order.
fn wrong_imports(file: &Path, source: &str) -> Vec<String> {
    let modules = module_path(file);
    let own = modules[0].as_str();
    if own == "lib" {
        return Vec::new();
    }
    let Some(own_layer) = layer(own) else {
        return vec![format!("{}: `{own}` has no place in LAYERS", file.display())];
    };
    let code = code_only(source);
    let mut problems = Vec::new();
    let mut check = |line: usize, name: &str| match layer(name) {
        _ if name == own => {}
        Some(other) if other < own_layer => {}
        Some(_) => problems.push(format!("{}:{line}: `{own}` imports `{name}`", file.display())),
        None if name == "*" || name == "self" => {
            problems.push(format!("{}:{line}: imports the crate root", file.display()));
        }
        None => {}
    };
    for (line, name) in reached(&code, "crate") {
        check(line, &name);
    }
    // Only names of layers count here: the climb of an inline module may end below the root.
    for (line, name) in climbed(&code, modules.len()) {
        if layer(&name).is_some() {
            check(line, &name);
        }
    }
    // Inside the library its own name is no way around.
    if !is_command(file) {
        for (line, name) in reached(&code, "bearing_dynamics") {
            check(line, &name);
        }
    }
    problems
}

fn is_command(file: &Path) -> bool {
    file == Path::new("main.rs") || file.starts_with("commands")
}

/// Ways of writing to the terminal.
fn prints(source: &str) -> Vec<String> {
    const FORBIDDEN: [&str; 8] =
        ["println!", "eprintln!", "print!", "eprint!", "dbg!", "stdout", "stderr", "indicatif"];
    let code = code_only(source);
    let find = |word| words(&code, word).map(move |at| (at, word)).collect::<Vec<_>>();
    FORBIDDEN
        .iter()
        .flat_map(|word| find(word))
        .map(|(at, word)| format!("{}: `{word}`", line_of(&code, at)))
        .collect()
}

/// Modules of `std` that a file of this layer may not reach.
fn forbidden_std(own: &str) -> &'static [&'static str] {
    match own {
        solver if SOLVER.contains(&solver) => &["fs"],
        "kinematics" | "elements" => &["fs", "io"],
        chapter if chapter.starts_with("ch") => &["fs", "io"],
        _ => &[],
    }
}

fn reaches_files(file: &Path, source: &str) -> Vec<String> {
    let modules = module_path(file);
    let forbidden = forbidden_std(&modules[0]);
    let code = code_only(source);
    reached(&code, "std")
        .filter(|(_, name)| forbidden.contains(&name.as_str()))
        .map(|(line, name)| format!("{}:{line}: `std::{name}`", file.display()))
        .collect()
}

/// First folder or file name below `src`.
fn layer_of(file: &Path) -> String {
    module_path(file).into_iter().next().unwrap_or_default()
}

/// Fused multiply-add rounds once where other processors round twice.
fn fused(source: &str) -> Vec<String> {
    let code = code_only(source);
    words(&code, "mul_add").map(|at| format!("{}: `mul_add`", line_of(&code, at))).collect()
}

/// Functions of the system's mathematics library, which picks its code by processor.
fn system_functions(source: &str) -> Vec<String> {
    let code = code_only(source);
    ["sin", "cos", "tan", "sin_cos", "asin", "acos", "atan2", "exp", "ln", "powf", "cbrt", "hypot"]
        .iter()
        .flat_map(|name| {
            words(&code, name)
                .filter(|&at| at > 0 && code.as_bytes()[at - 1] == b'.')
                .map(|at| format!("{}: `.{name}`", line_of(&code, at)))
                .collect::<Vec<_>>()
        })
        .collect()
}

/// Libraries and commands are compiled without a harness: a test among them would never run.
fn tests_inside(source: &str) -> Vec<String> {
    let code = code_only(source);
    let attributes = ["#[test]", "cfg(test)"];
    attributes
        .iter()
        .flat_map(|attribute| code.match_indices(attribute))
        .map(|(at, found)| format!("{}: `{found}` belongs into tests/", line_of(&code, at)))
        .collect()
}

fn unsafe_words(source: &str) -> Vec<usize> {
    let code = code_only(source);
    words(&code, "unsafe").map(|at| line_of(&code, at)).collect()
}

/// What an oracle of the verification crate may not see: the library it judges, and anything of
/// its own crate that could hand the library over.
fn oracle_leaks(source: &str) -> Vec<String> {
    let code = code_only(source);
    let library = words(&code, "bearing_dynamics").map(|at| (line_of(&code, at), "the library"));
    let siblings = reached(&code, "crate").filter(|(_, name)| name != "oracles");
    library
        .map(|(line, what)| format!("{line}: {what}"))
        .chain(siblings.map(|(line, name)| format!("{line}: `crate::{name}`")))
        .collect()
}

/// Traces of a particular machine, and unfinished work. Split so that this file passes itself.
fn traces(text: &str) -> Vec<String> {
    let paths = [concat!("/", "work/"), concat!("/", "root/"), concat!("/", "farm/")];
    let marks = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("unimple", "mented!")];
    let mut found: Vec<(usize, &str)> =
        paths.iter().flat_map(|path| text.match_indices(path)).collect();
    for mark in marks {
        found.extend(words(text, mark).map(|at| (at, mark)));
    }
    found.into_iter().map(|(at, what)| format!("{}: `{what}`", line_of(text, at))).collect()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Files of the repository, relative to its root: tracked ones and new ones that are not ignored.
fn repository_files() -> Vec<PathBuf> {
    let list = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(root())
        .output();
    let files: Vec<PathBuf> = match list {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout)
            .split_terminator('\0')
            .map(PathBuf::from)
            .filter(|path| root().join(path).is_file())
            .collect(),
        // An unpacked archive without a repository: everything but build products and results.
        _ => walk(root()).into_iter().filter(|path| !is_product(path)).collect(),
    };
    assert!(files.contains(&PathBuf::from("src/lib.rs")), "the list of files is wrong: {files:?}");
    files
}

fn is_product(path: &Path) -> bool {
    ["target", "results", ".git"].iter().any(|folder| path.starts_with(folder))
}

fn walk(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for path in entries.map(|entry| entry.expect("a readable folder entry").path()) {
        let relative = path.strip_prefix(root()).expect("a path under the root").to_path_buf();
        if path.is_dir() && !is_product(&relative) {
            files.extend(walk(&path));
        } else if path.is_file() {
            files.push(relative);
        }
    }
    files
}

fn rust_files(under: &str) -> Vec<PathBuf> {
    let is_rust =
        |path: &PathBuf| path.starts_with(under) && path.extension() == Some("rs".as_ref());
    repository_files().into_iter().filter(is_rust).collect()
}

/// Runs `check` on every Rust file under `src`, with its path relative to `src`.
fn in_source(check: impl Fn(&Path, &str) -> Vec<String>) -> Vec<String> {
    let files = rust_files("src");
    let check_one = |path: &PathBuf| {
        check(path.strip_prefix("src").expect("a path under src"), &read(&root().join(path)))
    };
    files.iter().flat_map(check_one).collect()
}

fn assert_none(problems: Vec<String>) {
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

#[test]
fn imports_run_one_way() {
    assert_none(in_source(wrong_imports));
}

#[test]
fn library_never_prints() {
    assert_none(in_source(|file, source| {
        let found = if is_command(file) { Vec::new() } else { prints(source) };
        found.into_iter().map(|what| format!("{}:{what}", file.display())).collect()
    }));
}

#[test]
fn laws_and_solver_know_no_files() {
    assert_none(in_source(reaches_files));
}

#[test]
fn results_do_not_depend_on_the_processor() {
    assert_none(in_source(|file, source| {
        let named = |what: Vec<String>| {
            what.into_iter().map(|what| format!("{}:{what}", file.display())).collect::<Vec<_>>()
        };
        let mut found = named(fused(source));
        if ["kinematics", "mesh", "elements", "scene"].contains(&layer_of(file).as_str())
            || SOLVER.contains(&layer_of(file).as_str())
            || layer_of(file).starts_with("ch")
        {
            found.extend(named(system_functions(source)));
        }
        found
    }));
}

#[test]
fn tests_stand_in_their_folder() {
    let compiled_once = |path: &PathBuf| {
        path.starts_with("src")
            || path.starts_with("verification") && !path.starts_with("verification/tests")
    };
    let files: Vec<PathBuf> = rust_files("").into_iter().filter(compiled_once).collect();
    for place in ["src/lib.rs", "verification/src/lib.rs", "verification/hertz_elliptic/case.rs"] {
        assert!(files.contains(&place.into()), "{place} is not looked at");
    }
    let found = |path: &PathBuf| {
        let found = tests_inside(&read(&root().join(path)));
        found.into_iter().map(|what| format!("{}:{what}", path.display())).collect::<Vec<_>>()
    };
    assert_none(files.iter().flat_map(found).collect());
    assert_eq!(tests_inside("fn a() {}\n#[cfg(test)]\nmod tests {\n#[test]\nfn b() {} }").len(), 2);
}

#[test]
fn nothing_is_unsafe() {
    let library = code_only(&read(&root().join("src/lib.rs")));
    assert!(library.contains("#![forbid(unsafe_code)]"), "src/lib.rs does not forbid unsafe code");
    let lines_in = |path: &PathBuf| {
        let lines = unsafe_words(&read(&root().join(path)));
        lines.into_iter().map(|line| format!("{}:{line}", path.display())).collect::<Vec<_>>()
    };
    // An allocator that counts, and functions that C calls, cannot be written otherwise.
    let exceptions =
        [Path::new("tests/no_allocation.rs"), Path::new("examples/fmu/src/c_interface.rs")];
    let files = rust_files("");
    let safe = files.iter().filter(|path| !exceptions.contains(&path.as_path()));
    assert_none(safe.flat_map(lines_in).collect());
}

#[test]
fn oracles_do_not_see_the_library() {
    let is_oracle = |path: &PathBuf| {
        path.starts_with("verification/src/oracles")
            || path == Path::new("verification/src/oracles.rs")
            || path.file_stem().is_some_and(|stem| stem.to_string_lossy().starts_with("oracle"))
    };
    let oracles: Vec<PathBuf> = rust_files("verification").into_iter().filter(is_oracle).collect();
    assert!(!oracles.is_empty(), "no oracle found under verification/");
    let leaks = |path: &PathBuf| {
        let found = oracle_leaks(&read(&root().join(path)));
        found.into_iter().map(|what| format!("{}:{what}", path.display())).collect::<Vec<_>>()
    };
    assert_none(oracles.iter().flat_map(leaks).collect());
}

#[test]
fn repository_holds_no_traces() {
    let found = |path: &PathBuf| {
        let found = traces(&read(&root().join(path)));
        found.into_iter().map(|what| format!("{}:{what}", path.display())).collect::<Vec<_>>()
    };
    assert_none(repository_files().iter().flat_map(found).collect());
}

mod scanner_catches {
    use super::*;

    fn imports(file: &str, source: &str) -> usize {
        wrong_imports(Path::new(file), source).len()
    }

    #[test]
    fn imports_against_the_order() {
        let file = "ch2_housing/bearing/hertz.rs";
        for bad in [
            "use crate::equilibrium::statics;",
            "use crate::{kinematics::Pose, scene};",
            "use crate::{kinematics::{Pose, euler}, ch3_bushing::x};",
            "pub use crate::ch5_cage as cage;",
            "fn f() { crate::output::write() }",
            "use super::super::super::motion;",
            "mod tests { use super::super::super::super::motion; }",
            "use crate::*;",
            "use bearing_dynamics::motion;",
            "use {crate::motion::x, std::fmt};",
            "use crate::\n    motion;",
            "const C: char = '\"'; use crate::motion; const D: char = '\"';",
        ] {
            assert_eq!(imports(file, bad), 1, "{bad}");
        }
        for good in [
            "use crate::kinematics::Pose;",
            "use crate::{kinematics, mesh::{a, b}, elements};",
            "use crate::ch2_housing::bearing::geometry;",
            "use super::geometry; use super::super::linear_elastic;",
            "//! `use crate::motion` would be wrong\n",
            "const TEXT: &str = \"use crate::motion\"; const RAW: &str = r#\"\"crate::motion\"#;",
            "/* crate::motion /* nested */ crate::scene */ fn f<'a>(x: &'a str) {}",
            "use my_crate::motion;",
        ] {
            assert_eq!(imports(file, good), 0, "{good}");
        }
    }

    #[test]
    fn every_step_of_the_order() {
        for (own_layer, own) in LAYERS.iter().enumerate() {
            for (other_layer, other) in LAYERS.iter().enumerate() {
                let source = format!("use crate::{other}::thing;");
                let expected = usize::from(other_layer > own_layer);
                assert_eq!(imports(&format!("{own}/mod.rs"), &source), expected, "{own} {other}");
            }
        }
        assert_eq!(imports("newcomer.rs", ""), 1, "a module without a place in the order");
    }

    #[test]
    fn printing() {
        for bad in [
            "println!(\"a\")",
            "eprintln!()",
            "print!(\"a\")",
            "eprint!(\"a\")",
            "dbg!(x)",
            "std::io::stdout().write_all(b\"\")",
            "use indicatif::ProgressBar;",
        ] {
            assert_eq!(prints(bad).len(), 1, "{bad}");
        }
        for good in ["/// println!(\"example\")", "\"print!\"", "pretty_print!()", "footprint(x)"] {
            assert_eq!(prints(good), Vec::<String>::new(), "{good}");
        }
    }

    #[test]
    fn files_in_laws_and_solver() {
        let found = |file: &str, source: &str| reaches_files(Path::new(file), source).len();
        assert_eq!(found("ch2_housing/bearing/contact.rs", "use std::fs::File;"), 1);
        assert_eq!(found("ch4_rotor.rs", "use std::{fmt, io::Write, fs};"), 2);
        assert_eq!(found("equilibrium/statics.rs", "fn f() { std::fs::read(\"a\"); }"), 1);
        assert_eq!(found("equilibrium/statics.rs", "use std::fmt; // std::fs\n"), 0);
        assert_eq!(found("output/mod.rs", "use std::fs;"), 0);
    }

    #[test]
    fn fused_multiply_add() {
        assert_eq!(fused("let x = a.mul_add(b, c);").len(), 1);
        assert!(fused("let x = a * b + c; // not mul_add\n").is_empty());
    }

    #[test]
    fn functions_of_the_system() {
        assert_eq!(system_functions("let x = a.sin() + b.powf(2.0);").len(), 2);
        assert!(system_functions("let x = libm::sin(a); // a.sin()\n").is_empty());
    }

    #[test]
    fn unsafe_code() {
        assert_eq!(unsafe_words("fn f() {\n    unsafe { g() }\n}"), [2]);
        assert!(unsafe_words("#![forbid(unsafe_code)] // unsafe\n").is_empty());
    }

    #[test]
    fn oracles_that_look() {
        assert_eq!(oracle_leaks("use bearing_dynamics::kinematics;").len(), 1);
        assert_eq!(oracle_leaks("use crate::cases::hertz;").len(), 1);
        assert!(oracle_leaks("use crate::oracles::agm; // not bearing_dynamics\n").is_empty());
    }

    #[test]
    fn traces_of_machines_and_of_unfinished_work() {
        for bad in [
            concat!("see /", "work/x"),
            concat!("/", "root/x"),
            concat!("/", "farm/x"),
            concat!("// TO", "DO: later"),
            concat!("FIX", "ME"),
            concat!("unimple", "mented!()"),
        ] {
            assert_eq!(traces(bad).len(), 1, "{bad}");
        }
        assert_eq!(traces("framework/x, MASTODON, an unimplemented idea"), Vec::<String>::new());
    }

    #[test]
    fn nothing_between_quotes_or_in_comments() {
        let source = "a \"b \\\" c\" d 'e' '\\'' f::<'g> r\"h\" br#\"i\"j\"# k // l\nm /* n\n*/ o";
        let code = code_only(source);
        let rest: String = code.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(rest, "a d f::<'g> b k m o");
        assert_eq!(code.lines().count(), source.lines().count());
    }
}
