//! The `bearing` command: exit codes, messages, what it prints and what it leaves on disk.

use crate::command_line_common;

use command_line_common::{
    ANGULAR_CONTACT, DEEP_GROOVE, bearing, bearing_scenes, changed, command, done, files, json,
    read, refusal, refused, scene, scenes, text, write,
};
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;
use std::process::Stdio;
use tempfile::tempdir;

#[test]
fn every_scene_of_the_repository_goes_through_every_command() {
    let root = tempdir().unwrap();
    for name in files(&scenes()).iter().filter(|name| name.contains('.')) {
        let path = scene(name);
        assert!(done(&["check", &path]).contains("a valid scene"));
        assert!(done(&["plan", &path]).contains("does  "));
    }
    // Every command fits the springs of a bushing anew: one of three such scenes is enough.
    let fitted = ["bearing_on_bushing.toml", "dented_on_bushing.toml"];
    let scenes = bearing_scenes().into_iter().filter(|name| !fitted.contains(&&name[..]));
    for (index, name) in scenes.enumerate() {
        let path = scene(&name);
        let [results, pack] =
            ["results", "pack"].map(|kind| text(&root.path().join(kind).join(&name)));
        let printed = done(&["statics", &path, "--out", &results]);
        assert!(printed.contains("inner race ") && printed.contains("loaded"), "{printed}");
        // A dry solution prints the same; a few scenes show that.
        if index < 5 {
            let dry = done(&["statics", &path, "--dry"]);
            assert_eq!(printed.rsplit_once("wrote ").unwrap().0, dry);
        }
        // A pack solves its scene twice.
        if index < 8 {
            let packed = done(&["pack", &path, "--out", &pack]);
            assert!(packed.starts_with("wrote 7 files to ") && packed.ends_with(": statics\n"));
            assert!(done(&["compare", &pack, &results]).starts_with("equal: "));
        }
    }
}

/// Critical speeds are listed up to twice the scene's own.
#[test]
fn critical_speeds_are_told_up_to_twice_the_speed() {
    let folder = tempfile::tempdir().unwrap();
    let told = |top: &str| {
        let content = read(Path::new(&scene("stepped_rotor.toml")));
        let content =
            changed(&content, "[\"0 rpm\", \"9000 rpm\"]", &format!("[\"0 rpm\", \"{top} rpm\"]"));
        let printed = done(&["modes", &write(folder.path(), "rotor.toml", &content), "--dry"]);
        let speeds = printed.lines().skip_while(|line| !line.starts_with("critical speeds"));
        let speeds =
            speeds.filter_map(|line| line.split_once(" rpm")?.0.trim().parse::<f64>().ok());
        speeds.collect::<Vec<_>>()
    };
    let all = told("9000");
    assert!(!all.is_empty(), "{all:?}");
    // The lowest is told as soon as twice the speed reaches it, wherever ramps end: axial motions do not follow the speed.
    let [before, after] = [0.49, 0.51].map(|part| told(&format!("{:.3}", part * all[0])));
    assert!(before.is_empty() && after.len() == 1, "{before:?} {after:?}");
    assert!((after[0] / all[0] - 1.0).abs() <= 1e-2, "{after:?} {all:?}");
}

/// A shaft that bends, in every command: its sections in an equilibrium, its whirl among its motions.
#[test]
fn commands_take_a_shaft_that_bends() {
    for name in ["rotor_run_up.toml", "stepped_rotor.toml", "rotor_in_pillow_blocks.toml"] {
        let path = scene(name);
        assert!(done(&["check", &path]).contains("a valid scene"));
        assert!(done(&["plan", &path]).contains("does  "));
        let whirl = done(&["modes", &path, "--dry"]);
        for part in ["whirl at ", "critical speeds", "_bending_1_y"] {
            assert!(whirl.contains(part), "{name}: {part}: {whirl}");
        }
        // Those of the others stretch above 5 kHz.
        assert_eq!(whirl.contains("_stretch_1"), name == "stepped_rotor.toml", "{name}: {whirl}");
    }
    let sag = done(&["statics", &scene("rotor_in_pillow_blocks.toml"), "--dry"]);
    let middle = sag.lines().find(|line| line.starts_with("the body shaft at mid"));
    let middle: Vec<f64> = middle
        .unwrap_or_else(|| panic!("{sag}"))
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    // F L³/(48 E I) of 3000 N over 400 mm of 30 mm steel is 479 um with shear and without what bearings hold back.
    assert!(middle[2] < -440.0 && middle[2] > -490.0, "{sag}");
}

#[test]
fn help_version_and_schema_are_answers() {
    for arguments in [["--help"], ["-h"], ["help"]] {
        let help = done(&arguments);
        for part in ["check", "plan", "statics", "sweep", "pack", "compare", "schema", "Usage"] {
            assert!(help.contains(part), "{part}: {help}");
        }
    }
    for subcommand in ["check", "plan", "statics", "sweep", "pack", "compare", "schema"] {
        assert!(done(&[subcommand, "--help"]).contains("Usage: bearing "), "{subcommand}");
    }
    assert_eq!(done(&["--version"]), format!("bearing {}\n", env!("CARGO_PKG_VERSION")));
    let schema: serde_json::Value = serde_json::from_str(&done(&["schema"])).unwrap();
    assert!(schema["properties"]["bearing"].is_object());
}

#[test]
fn a_wrong_command_line_is_explained() {
    let path = scene("varying_compliance.toml");
    let cases: [(&[&str], &str); 12] = [
        (&[], "Usage: bearing"),
        (&["statcs", &path], "'statics'"),
        (&["run"], "<SCENE>"),
        (&["statics"], "<SCENE>"),
        (&["statics", &path, &path], "unexpected argument"),
        (&["statics", &path, "--ouut", "x"], "'--out'"),
        (&["statics", &path, "--dry", "--out", "x"], "cannot be used with"),
        (&["check", &path, "--out", "x"], "unexpected argument"),
        (&["sweep", &path, "--threads", "0"], "1..=1024"),
        (&["compare", &path], "<CANDIDATE>"),
        (&["compare", &path, &path, "--class", "loose"], "f64-reordered, integrated, mixed"),
        (&["schema", &path], "unexpected argument"),
    ];
    for (arguments, part) in cases {
        let run = bearing(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}");
        assert_eq!(run.stdout, "", "{arguments:?}");
        assert!(run.stderr.contains(part) && !run.stderr.contains("panicked"), "{run:#?}");
    }
}

#[test]
fn malformed_scenes_are_refused_by_every_command_that_reads_one() {
    let root = tempdir().unwrap();
    let folder = root.path();
    let bad =
        |name: &str, from: &str, to: &str| write(folder, name, &changed(DEEP_GROOVE, from, to));
    let braces = {
        let path = folder.join("braces.json");
        let mut file = std::fs::File::create(&path).unwrap();
        file.write_all(&b"{".repeat(1 << 16)).unwrap();
        file.seek(SeekFrom::Start((100 << 20) - (1 << 16))).unwrap();
        file.write_all(&b"{".repeat(1 << 16)).unwrap();
        text(&path)
    };
    let none = text(&folder.join("none.toml"));
    // File, line if there is one, parts of the message.
    let cases: [(String, &str, &[&str]); 10] = [
        (bad("unit.toml", "\"5.953 mm\"", "5.953"), ":13:", &["has no unit", "Hint: "]),
        (bad("force.toml", "\"-5 um\"", "\"-5 N\""), ":5:", &["unit of force", "length"]),
        (bad("key.toml", "balls = 8", "bals = 8"), ":4:", &["unknown key", "did you mean"]),
        (bad("nan.toml", "\"31.953 mm\"", "\"nan mm\""), ":10:", &["NaN"]),
        (bad("size.toml", "\"20.047 mm\"", "\"-20.047 mm\""), ":7:", &["outside", "Allowed: "]),
        (bad("syntax.toml", "balls = 8", "balls = = 8"), ":4:", &["not valid TOML"]),
        (write(folder, "empty.toml", ""), ": ", &["empty"]),
        (text(folder), ": ", &["folder", ".toml or .json"]),
        (braces, ": ", &["104857600 bytes"]),
        (none, ": ", &["no such file"]),
    ];
    let out = text(&folder.join("out"));
    for (path, place, parts) in &cases {
        let commands: [&[&str]; 6] = [
            &["check", path],
            &["check", path, "--json"],
            &["plan", path],
            &["statics", path, "--out", &out],
            &["pack", path, "--out", &out],
            &["sweep", path, "--out", &out, "--vary", "bearing.ball_phase=0 deg, 1 deg"],
        ];
        for arguments in commands {
            let message = refused(arguments);
            assert!(message.starts_with(&format!("{path}{place}")), "{message}");
            for part in *parts {
                assert!(message.contains(part), "{part}: {message}");
            }
        }
    }
    assert!(!folder.join("out").exists(), "nothing is written for a scene that is refused");
}

#[test]
fn a_bearing_that_nothing_holds_is_refused_and_an_indeterminate_one_is_warned_of() {
    let root = tempdir().unwrap();
    let gap = changed(DEEP_GROOVE, "-5 um", "10 um");
    let axial = "[inner_race]\ny = { displacement = \"0 um\" }\nz = { displacement = \"0 um\" }\n\
                 tilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n";
    let heavy =
        write(root.path(), "heavy.toml", &format!("{gap}{axial}x = {{ load = \"1000 MN\" }}\n"));
    let out = text(&root.path().join("out"));
    let message = refused(&["statics", &heavy, "--out", &out]);
    assert!(message.contains("no equilibrium") && message.contains("along x"), "{message}");
    assert!(!root.path().join("out").exists());

    let free = write(root.path(), "free.toml", &gap);
    let printed = done(&["statics", &free, "--out", &out]);
    assert!(printed.contains("\nwarning[W01-indeterminate-position]"), "{printed}");
    let summary = json(&root.path().join("out/summary.json"));
    assert_eq!(summary["determinacy"]["kind"], "indeterminate");
    assert_eq!(summary["warnings"][0]["code"], "W01-indeterminate-position");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let path = scene("deep_groove_tilt.toml");
    let root = tempdir().unwrap();
    let [results, pack] = ["results", "pack"].map(|name| text(&root.path().join(name)));
    let commands: [&[&str]; 8] = [
        &["statics", &path, "--dry"],
        &["statics", &path, "--out", &results],
        &["check", &path],
        &["check", &path, "--json"],
        &["plan", &path],
        &["pack", &path, "--out", &pack],
        &["schema"],
        // The pack of two lines above.
        &["compare", &pack, &pack],
    ];
    for arguments in commands {
        let mut child = command()
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Closed long before the process has come to its first line.
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
    }
    assert!(root.path().join("results/summary.json").exists());
    assert!(root.path().join("pack/manifest.json").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_an_error() {
    let path = scene("deep_groove_tilt.toml");
    for arguments in [vec!["statics", &path, "--dry"], vec!["plan", &path], vec!["schema"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let run = command().args(&arguments).stdout(full).output().unwrap().into();
        let message = refusal(&arguments, &run);
        assert!(message.starts_with("cannot write to standard output: "), "{message}");
    }
}

#[test]
fn a_results_folder_that_cannot_be_made_is_named() {
    let path = scene("deep_groove_moment.toml");
    let root = tempdir().unwrap();
    let file = write(root.path(), "file", "in the way");
    let below = text(&root.path().join("file/below"));
    for out in [&file, &below] {
        for subcommand in ["statics", "sweep", "pack"] {
            let arguments = [subcommand, &path, "--out", out];
            let run = bearing(&arguments);
            // Found before anything is computed.
            assert_eq!(run.stdout, "");
            let message = refusal(&arguments, &run);
            let said =
                format!("cannot make the results folder {out}: {file} is a file; move it away");
            assert!(message.starts_with(&said), "{message}");
        }
    }
    assert_eq!(read(Path::new(&file)), "in the way");
}

#[test]
fn results_go_to_a_folder_named_after_the_scene() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "my bearing.v2.toml", DEEP_GROOVE);
    for arguments in [
        vec!["statics", &path],
        vec!["pack", &path],
        vec!["sweep", &path, "--vary", "bearing.balls=8,9"],
    ] {
        let run = command().args(&arguments).current_dir(root.path()).output().unwrap();
        assert!(run.status.success(), "{run:?}");
    }
    for name in [
        "results/my bearing.v2-statics/summary.json",
        "results/my bearing.v2-sweep/sweep.csv",
        "packs/my bearing.v2/manifest.json",
    ] {
        assert!(root.path().join(name).is_file(), "{name}");
    }
    // `pack` also knows the scenes by name.
    let repository = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = text(&root.path().join("named"));
    let run = command()
        .args(["pack", "misaligned_radial", "--out", &out])
        .current_dir(repository)
        .output()
        .unwrap();
    assert!(run.status.success() && root.path().join("named/scene.json").is_file(), "{run:?}");
}

#[test]
fn an_older_results_folder_is_replaced() {
    let root = tempdir().unwrap();
    let [used, fresh] = ["used", "fresh"].map(|name| root.path().join(name));
    let loaded = format!("{DEEP_GROOVE}[inner_race]\nz = {{ load = \"-1 kN\" }}\n");
    let plots = |list: &str| format!("{loaded}[output]\nplots = {list}\n");
    let all = plots("[\"load-zone\", \"polar\", \"moment-tilt\"]");
    let first = write(root.path(), "a.toml", &changed(&all, "-5 um", "5 um"));
    let second = write(root.path(), "b.toml", &plots("[\"polar\"]"));
    done(&["statics", &first, "--out", &text(&used)]);
    let svgs = |folder: &Path| files(folder).into_iter().filter(|name| name.ends_with(".svg"));
    assert_eq!(svgs(&used).count(), 3);
    // The user's own file in the folder stays.
    write(&used, "notes.txt", "mine");
    done(&["statics", &second, "--out", &text(&used)]);
    done(&["statics", &second, "--out", &text(&fresh)]);
    assert_eq!(svgs(&used).collect::<Vec<_>>(), ["polar.svg"]);
    let mut expected = files(&fresh);
    expected.push("notes.txt".into());
    expected.sort();
    assert_eq!(files(&used), expected);
    for name in files(&fresh).iter().filter(|name| *name != "summary.json") {
        let [one, other] = [&used, &fresh].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(one == other, "{name}");
    }
    let outcome = done(&["compare", &text(&fresh), &text(&used), "--class", "f64-exact"]);
    assert!(outcome.starts_with("equal: "));
    let paths = ["summary.json", "series.csv", "series.npy", "series.columns.json", "polar.svg"];
    for name in paths {
        assert!(fresh.join(name).metadata().unwrap().len() > 0, "{name}");
    }
}

#[test]
fn the_printed_table_is_one_to_read() {
    let printed = done(&["statics", "--dry", &scene("angular_contact_axial.toml")]);
    assert!(!printed.contains("-0.0000 "), "{printed}");
    // Iterations and residual are the solver's affair, pinned elsewhere.
    let (table, _) = printed.rsplit_once("\n1 iterations").expect(&printed);
    insta::assert_snapshot!("angular_contact_axial", table);
}

#[test]
fn the_plan_says_what_is_done_and_why_the_rest_is_not() {
    let mut plans = String::new();
    for name in [
        "angular_contact_axial.toml",
        "deep_groove_moment.toml",
        "deep_groove_tilt.toml",
        "misaligned_radial.json",
        "varying_compliance.toml",
    ] {
        plans += &format!("# {name}\n{}\n", done(&["plan", &scene(name)]));
    }
    let root = tempdir().unwrap();
    let gravity = "[ball_forces]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-1 g\"]\n";
    let centrifugal = "[inner_race]\nspeed = \"3000 rpm\"\n[ball_forces]\ncentrifugal = true\n";
    let held = "[inner_race]\nx = { displacement = \"0 um\" }\ny = { displacement = \"0 um\" }\n\
                z = { displacement = \"-3 um\" }\ntilt_y = { tilt = \"0.1 deg\" }\n\
                tilt_z = { tilt = \"0 deg\" }\n";
    let standing = "[inner_race]\nspeed = \"0 rpm\"\n[ball_forces]\ncentrifugal = true\n";
    for (name, scene) in [
        ("gravity", format!("{DEEP_GROOVE}{gravity}")),
        ("centrifugal", format!("{DEEP_GROOVE}{centrifugal}")),
        ("standing still", format!("{DEEP_GROOVE}{standing}")),
        ("all coordinates prescribed", format!("{DEEP_GROOVE}{held}")),
        ("angular contact, all prescribed", format!("{ANGULAR_CONTACT}{held}")),
    ] {
        let path = write(root.path(), "scene.toml", &scene);
        plans += &format!("# {name}\n{}\n", done(&["plan", &path]));
    }
    insta::assert_snapshot!("plans", plans);
}

/// `modes` takes scenes of bearings as well as of solids, and its help says so.
#[test]
fn help_of_modes_names_both_kinds_of_scene() {
    let said = done(&["modes", "--help"]);
    assert!(said.contains("of a solid") && said.contains("of bearings"), "{said}");
}
