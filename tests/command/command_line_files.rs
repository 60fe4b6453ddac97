//! Files and folders that are not what they should be: pipes, devices, folders of others, two
//! processes at once, texts that command a terminal.

use crate::command_line_common;

use bearing_dynamics::output::compare::tolerance::ToleranceClass;
use bearing_dynamics::output::compare::{Options, compare};
use command_line_common::{
    DEEP_GROOVE, Run, bearing, changed, command, done, files, json, read, refusal, refused, scene,
    text, write,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::tempdir;

/// Runs the command, which must refuse within seconds and without much memory.
fn refused_soon(arguments: &[&str]) -> String {
    let mut child = command()
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(30) {
            child.kill().unwrap();
            panic!("bearing {arguments:?} reads for ever");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let run = Run::from(child.wait_with_output().unwrap());
    assert_eq!(run.stdout, "", "bearing {arguments:?}");
    refusal(arguments, &run)
}

/// A name, and what puts it there.
#[cfg(unix)]
type Made<'a> = (&'static str, Box<dyn Fn() + 'a>);

/// Makes what nobody should read: a pipe that nobody writes to, a link to a device without end, a
/// folder.
#[cfg(unix)]
fn unreadable(path: &Path) -> [Made<'_>; 3] {
    [
        (
            "regular file",
            Box::new(move || assert!(Command::new("mkfifo").arg(path).status().unwrap().success())),
        ),
        ("regular file", Box::new(move || std::os::unix::fs::symlink("/dev/zero", path).unwrap())),
        ("folder", Box::new(move || fs::create_dir(path).unwrap())),
    ]
}

#[cfg(unix)]
#[test]
fn only_regular_files_are_read() {
    let root = tempdir().unwrap();
    let meshed = write(
        root.path(),
        "meshed.toml",
        &read(Path::new(&scene("bar_impact.toml"))).replace("meshes/bar.msh", "bar.msh"),
    );
    assert!(read(Path::new(&meshed)).contains("\"bar.msh\""));
    let bearing_scene = write(root.path(), "bearing.toml", DEEP_GROOVE);
    let [results, other, pack] = ["results", "other", "pack"].map(|name| root.path().join(name));
    for folder in [&results, &other] {
        done(&["statics", &bearing_scene, "--out", &text(folder)]);
    }
    done(&["pack", &bearing_scene, "--out", &text(&pack)]);
    let [out, of, packed] = [&results, &other, &pack].map(|folder| text(folder));
    let file = |name: &str| root.path().join(name);
    let checked = text(&file("scene.toml"));
    let cases: [(PathBuf, Vec<&str>); 9] = [
        (file("scene.toml"), vec!["check", &checked]),
        (file("bar.msh"), vec!["check", &meshed]),
        (results.join("series.npy"), vec!["compare", &of, &out]),
        (results.join("series.csv"), vec!["compare", &of, &out]),
        (results.join("summary.json"), vec!["compare", &out, &of]),
        (results.join("series.columns.json"), vec!["compare", &out, &of]),
        (results.join("tolerances.json"), vec!["compare", &out, &of]),
        (pack.join("manifest.json"), vec!["compare", &packed, &of]),
        (pack.join("scene.toml"), vec!["compare", &packed, &of]),
    ];
    for (path, arguments) in cases {
        let whole = fs::read(&path).ok();
        for (what, make) in unreadable(&path) {
            let _ = fs::remove_file(&path);
            make();
            let message = refused_soon(&arguments);
            let name = path.file_name().unwrap().to_string_lossy();
            assert!(message.contains(&*name) && message.contains(what), "{message}");
            // A link goes as a file does.
            fs::remove_file(&path).or_else(|_| fs::remove_dir(&path)).unwrap();
        }
        if let Some(whole) = whole {
            fs::write(&path, whole).unwrap();
        }
    }
    // A device without end in place of a folder's record; a file of a size that nothing here has.
    std::os::unix::fs::symlink("/dev/zero", root.path().join("huge.toml")).unwrap();
    let huge = text(&root.path().join("sparse.toml"));
    fs::File::create(&huge).and_then(|file| file.set_len(1 << 40)).unwrap();
    assert!(refused_soon(&["check", &huge]).contains("Allowed: up to 16777216 bytes"));
}

/// A bearing in motion for some tenths of a second of wall time.
fn short_run(folder: &Path, name: &str, load: &str) -> String {
    let scene = read(Path::new(&scene("settling.toml")));
    let scene =
        changed(&scene, "x = { load = \"250 N\" }", &format!("x = {{ load = \"{load}\" }}"));
    write(folder, name, &changed(&scene, "end = \"0.2 s\"", "end = \"0.01 s\""))
}

fn start(arguments: &[&str]) -> Child {
    let started = command().args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    started.expect("the command starts")
}

/// Two processes start on one folder at once: one is refused, or comes after the other; the folder
/// never holds something of both. `FOLDER_TRIALS=50` takes fifty trials.
#[test]
fn two_processes_never_mix_in_one_folder() {
    let trials = std::env::var("FOLDER_TRIALS").ok().and_then(|n| n.parse().ok()).unwrap_or(6);
    let root = tempdir().unwrap();
    let scenes = [("a.toml", "250 N"), ("b.toml", "300 N")]
        .map(|(name, load)| short_run(root.path(), name, load));
    let alone = ["a", "b"].map(|name| root.path().join(name));
    for (scene, folder) in scenes.iter().zip(&alone) {
        done(&["run", scene, "--out", &text(folder)]);
    }
    let exact = Options { default_class: Some(ToleranceClass::F64Exact), ..Options::default() };
    let equal = |one: &Path, other: &Path| {
        let names = files(one);
        names == files(other)
            && compare(one, other, &exact).is_ok_and(|comparison| comparison.equal)
            && names.iter().filter(|name| name.ends_with(".svg")).all(|name| {
                fs::read(one.join(name)).unwrap() == fs::read(other.join(name)).unwrap()
            })
    };
    assert!(!equal(&alone[0], &alone[1]));
    let mut refusals = 0;
    for trial in 0..trials {
        let out = root.path().join(format!("out{trial}"));
        let out_text = text(&out);
        // Of two runs, or of a run and a solution.
        let commands = if trial % 3 == 2 { ["run", "statics"] } else { ["run", "run"] };
        let order = if trial % 2 == 0 { [0, 1] } else { [1, 0] };
        let arguments = order.map(|i| [commands[i], scenes[i].as_str(), "--out", &out_text]);
        let children = arguments.each_ref().map(|arguments| start(arguments));
        let runs = children.map(|child| Run::from(child.wait_with_output().unwrap()));
        let mut finished = Vec::new();
        for ((run, arguments), of) in runs.iter().zip(&arguments).zip(order) {
            if run.code == Some(0) {
                finished.push(of);
                continue;
            }
            let message = refusal(arguments, run);
            let busy = message.contains("another bearing process is writing to");
            assert!(busy || message.contains("name another folder with --out"), "{message}");
            assert!(message.contains(&out_text), "{message}");
            refusals += usize::from(busy);
        }
        assert!(!finished.is_empty(), "trial {trial}: {runs:?}");
        if commands[1] == "statics" && finished.contains(&1) {
            let alone = root.path().join("statics");
            done(&["statics", &scenes[1], "--out", &text(&alone)]);
            assert!(equal(&alone, &out), "trial {trial}: {:?}", files(&out));
            continue;
        }
        let whole = finished.iter().filter(|of| equal(&alone[**of], &out)).count();
        assert_eq!(whole, 1, "trial {trial}, {finished:?} finished: {:?}", files(&out));
        let fingerprint = |folder: &Path| json(&folder.join("state.json"))["fingerprint"].clone();
        let of = usize::from(fingerprint(&out) == fingerprint(&alone[1]));
        assert!(fingerprint(&out) == fingerprint(&alone[of]) && equal(&alone[of], &out));
    }
    println!("{refusals} of {trials} trials ended in a refusal");
    assert!(2 * refusals >= trials, "{refusals} of {trials}: the processes did not overlap");
}

/// Every command that writes claims its folder; what held it goes with the process.
#[test]
fn every_command_that_writes_claims_its_folder() {
    let root = tempdir().unwrap();
    let bearing_scene = short_run(root.path(), "a.toml", "250 N");
    let slow = read(Path::new(&bearing_scene)).replace("end = \"0.01 s\"", "end = \"100 s\"");
    let slow = write(root.path(), "slow.toml", &slow);
    let out = root.path().join("out");
    let out_text = text(&out);
    let mut child = start(&["run", &slow, "--out", &out_text, "--save-every", "1"]);
    let begun = Instant::now();
    while !out.join("state.json").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no state");
        assert!(child.try_wait().unwrap().is_none(), "over too early");
        std::thread::sleep(Duration::from_millis(5));
    }
    let ring = scene("ring_modes.toml");
    let vary = ["--vary", "bearing.balls=8,9"];
    for arguments in [
        vec!["run", &bearing_scene],
        vec!["run", &bearing_scene, "--fresh"],
        vec!["run", &slow, "--resume"],
        vec!["statics", &bearing_scene],
        vec!["modes", &ring],
        vec!["sweep", &bearing_scene, vary[0], vary[1]],
        vec!["pack", &bearing_scene],
    ] {
        let message = refused(&[&arguments[..], &["--out", &out_text]].concat());
        assert!(message.contains("another bearing process is writing to"), "{message}");
    }
    // Killed, it holds nothing any more.
    child.kill().unwrap();
    child.wait().unwrap();
    done(&["run", &bearing_scene, "--out", &out_text, "--fresh"]);
}

/// A folder that cannot be written to is named before anything is computed, and so before anything is
/// printed.
#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_to_is_found_before_computing() {
    use std::os::unix::fs::PermissionsExt;
    let root = tempdir().unwrap();
    let path = short_run(root.path(), "a.toml", "250 N");
    let closed = root.path().join("closed");
    fs::create_dir(&closed).unwrap();
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).unwrap();
    let mut folders = vec![closed.clone(), closed.join("below")];
    // Who may write everywhere cannot write there.
    let anyway = fs::File::create(closed.join("try")).is_ok();
    if anyway {
        folders.clear();
    }
    folders.extend(
        ["/proc", "/proc/below"]
            .map(PathBuf::from)
            .into_iter()
            .filter(|_| Path::new("/proc/self").exists()),
    );
    folders.push(root.path().join("n".repeat(300)));
    for folder in &folders {
        let ring = scene("ring_modes.toml");
        for arguments in [
            vec!["run", &path],
            vec!["statics", &path],
            vec!["modes", &ring],
            vec!["sweep", &path, "--vary", "bearing.balls=8,9"],
            vec!["pack", &path],
        ] {
            let out = text(folder);
            let message = refused(&[&arguments[..], &["--out", &out]].concat());
            assert!(message.contains(&out) && message.contains("--out"), "{message}");
        }
    }
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o755)).unwrap();
}

/// What this program did not write, and what another command of it wrote, is not replaced.
#[test]
fn only_results_of_the_same_command_are_replaced() {
    let root = tempdir().unwrap();
    let path = short_run(root.path(), "a.toml", "250 N");
    let ring = scene("ring_modes.toml");
    let commands: [(&str, Vec<&str>); 5] = [
        ("a run", vec!["run", &path]),
        ("another kind (static solution)", vec!["statics", &path]),
        ("another kind (natural modes of a solid)", vec!["modes", &ring]),
        ("a sweep", vec!["sweep", &path, "--vary", "bearing.balls=8,9"]),
        ("a case pack", vec!["pack", &path]),
    ];
    let out = |name: &str| text(&root.path().join(name));
    for (index, (_, arguments)) in commands.iter().enumerate() {
        let own = out(&format!("{index}"));
        for _ in 0..2 {
            done(&[&arguments[..], &["--out", &own]].concat());
        }
        // Left half written by a process that was killed.
        fs::write(Path::new(&own).join(".summary.json.4294967294.partial"), "{").unwrap();
    }
    for (index, (holds, _)) in commands.iter().enumerate() {
        let folder = out(&format!("{index}"));
        for (other, (_, arguments)) in commands.iter().enumerate().filter(|(o, _)| *o != index) {
            let message = refused(&[&arguments[..], &["--out", &folder]].concat());
            assert!(message.contains(&folder) && message.contains("--out"), "{message}");
            assert!(message.contains(holds), "{other} over {index}: {message}");
        }
        let left = files(Path::new(&folder));
        assert!(left.iter().all(|name| !name.ends_with(".partial")), "{left:?}");
    }
    done(&["run", &path, "--out", &out("1"), "--fresh"]);
    for foreign in [
        ("summary.json", "{\"program\": {\"name\": \"other\"}, \"kind\": \"static solution\"}"),
        ("summary.json", "{\"rows\": 3}"),
        ("summary.json", "not JSON"),
        ("state.json", "{}"),
        ("series.csv", "time [s],x [m]\n0,0\n"),
        ("sweep.json", "[]"),
    ] {
        let (name, content) = foreign;
        let folder = root.path().join("theirs");
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join(name), content).unwrap();
        for (_, arguments) in &commands {
            for fresh in [&[][..], &["--fresh"]] {
                if !fresh.is_empty() && !["run", "sweep"].contains(&arguments[0]) {
                    continue;
                }
                let message =
                    refused(&[&arguments[..], &["--out", &text(&folder)], fresh].concat());
                assert!(message.contains(name) && message.contains("move it away"), "{message}");
            }
        }
        assert_eq!(files(&folder), [name]);
        assert_eq!(read(&folder.join(name)), content);
        fs::remove_dir_all(&folder).unwrap();
    }
    // A folder made for a command that then fails goes again.
    let held = "y = { displacement = \"0 um\" }\nz = { displacement = \"0 um\" }\n\
                tilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n";
    let gap = changed(DEEP_GROOVE, "-5 um", "10 um");
    let heavy = format!("{gap}[inner_race]\n{held}x = {{ load = \"1000 MN\" }}\n");
    let heavy = write(root.path(), "heavy.toml", &heavy);
    assert!(refused(&["statics", &heavy, "--out", &out("new/below")]).contains("no equilibrium"));
    assert!(!root.path().join("new").exists());
}

#[test]
fn a_pack_without_its_manifest_is_no_reference() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "a.toml", DEEP_GROOVE);
    let [pack, results] = ["pack", "results"].map(|name| root.path().join(name));
    done(&["pack", &path, "--out", &text(&pack)]);
    done(&["statics", &path, "--out", &text(&results)]);
    fs::remove_file(pack.join("manifest.json")).unwrap();
    let message = refused(&["compare", &text(&pack), &text(&results)]);
    assert!(message.contains("no manifest.json") && message.contains(&text(&pack)), "{message}");
    // Its files can be compared by name, and the pack written anew.
    let [expected, found] = [&pack, &results].map(|folder| text(&folder.join("summary.json")));
    let run = bearing(&["compare", &expected, &found]);
    assert!(run.code == Some(0) || run.code == Some(1), "{run:?}");
    done(&["pack", &path, "--out", &text(&pack)]);
    done(&["compare", &text(&pack), &text(&results)]);
}

/// Titles, names, keys and paths reach the terminal without what it would obey.
#[test]
fn nothing_from_a_file_commands_the_terminal() {
    let root = tempdir().unwrap();
    let hostile = "\\u001b[2J\\u009b31m\\u0007\\u202e";
    let quoted = format!("title = \"a{hostile}\\r\\nequal: 2 values\"\n");
    let noted = format!("[assumptions]\nnote = \"x{hostile}\\r\"\n");
    let path = write(
        root.path(),
        "a.toml",
        &format!("{quoted}{DEEP_GROOVE}{noted}[output]\nplots = [\"polar\"]\n"),
    );
    let named = write(root.path(), "b\u{1b}[2J\nequal: 1 values.toml", DEEP_GROOVE);
    let [one, other] = ["one", "two"].map(|name| root.path().join(name));
    for folder in [&one, &other] {
        done(&["statics", &path, "--out", &text(folder)]);
    }
    let mut summary = json(&one.join("summary.json"));
    summary["\u{1b}]0;x\u{7}\u{9b}\nequal: 5 values in 1 channels"] = serde_json::json!(1.5);
    fs::write(one.join("summary.json"), summary.to_string()).unwrap();
    let [one, other] = [one, other].map(|folder| text(&folder));
    let mut said = String::new();
    for arguments in [
        vec!["check", &path],
        vec!["check", &path, "--json"],
        vec!["plan", &path],
        vec!["compare", &one, &other],
        vec!["compare", &other, &one],
        vec!["compare", &one, &other, "--json"],
        vec!["check", &named],
        vec!["check", "no\u{1b}[2J such.toml"],
        vec!["statics", &named, "--out", &format!("{one}/summary.json/\u{1b}[2J")],
    ] {
        let run = bearing(&arguments);
        assert!(run.code.is_some_and(|code| code <= 2), "{run:?}");
        let of = run.stdout.clone() + &run.stderr;
        let obeyed = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
        assert!(!of.contains(obeyed), "bearing {arguments:?}: {of:?}");
        assert!(
            !of.lines().any(|line| line.starts_with("equal: ")) || arguments[1] == other,
            "{of}"
        );
        if arguments.contains(&"--json") {
            serde_json::from_str::<serde_json::Value>(&run.stdout).expect("JSON");
        }
        said += &of;
    }
    // Seen as what it is.
    assert!(said.contains("\\u001b[2J") && said.contains("\\u009b"), "{said}");
}

/// The points of a sweep that was killed are not written over by another command.
#[test]
fn an_unfinished_sweep_keeps_its_folder() {
    let root = tempdir().unwrap();
    let path = short_run(root.path(), "a.toml", "250 N");
    let folder = root.path().join("killed");
    fs::create_dir(&folder).unwrap();
    let record = "{\"program\":\"bearing-dynamics\",\"complete\":false}";
    fs::write(folder.join("sweep.json"), record).unwrap();
    for verb in ["run", "statics", "pack"] {
        let message = refused(&[verb, &path, "--out", &text(&folder)]);
        assert!(message.contains("holds a sweep"), "{verb}: {message}");
    }
    assert_eq!(files(&folder), ["sweep.json"]);
}

/// Pictures that earlier results left and later ones do not draw would be taken for theirs; those of others stay.
#[test]
fn pictures_of_results_that_are_replaced_go() {
    let root = tempdir().unwrap();
    let out = root.path().join("out");
    let pictures = || {
        let all = files(&out);
        all.into_iter().filter(|name| name.ends_with(".svg")).collect::<Vec<_>>()
    };
    let others = ["load_zone_mine.svg", "picture.svg", "series_mine.svg", "spectrum_2024.svg"];
    let moving = |plots: &str| {
        let numerics = "end = \"2 ms\"\nstep = \"2 us\"\noutput_interval = \"10 us\"";
        let text = super::run_command::scene(numerics, &format!("plots = [{plots}]"));
        write(root.path(), "scene.toml", &text)
    };
    let all = "\"orbit\", \"spectrum\", \"series\", \"slip-spin\", \"polar\"";
    let said = done(&["run", &moving(all), "--out", &text(&out)]);
    assert!(!said.contains("replaced") && pictures().len() >= 9, "{said} {:?}", pictures());
    for name in others {
        write(&out, name, "<svg/>");
    }
    let said = done(&["run", &moving(""), "--out", &text(&out)]);
    assert!(said.contains("the earlier results in"), "{said}");
    assert_eq!(pictures(), others);
    // Of several bearings each has its own, in a run and in an equilibrium.
    let several = read(Path::new(&scene("shaft_back_to_back.toml")));
    let start = several.find("plots = [").expect("plots");
    let end = start + several[start..].find(']').expect("a list") + 1;
    for (command, plots) in [("statics", "\"load-zone\""), ("run", all)] {
        fs::remove_dir_all(&out).unwrap();
        let drawn = |plots: &str| {
            let text = several.replace(&several[start..end], &format!("plots = [{plots}]"));
            write(root.path(), "several.toml", &text)
        };
        let path = drawn(plots);
        let short = ["--set", "numerics.end=2 ms"];
        let folder = text(&out);
        let arguments = [&[command, &path, "--out", &folder][..], &short].concat();
        done(&arguments);
        assert!(pictures().len() >= 2, "{:?}", pictures());
        for name in others {
            write(&out, name, "<svg/>");
        }
        drawn("");
        done(&arguments);
        assert_eq!(pictures(), others, "{command}");
    }
}
