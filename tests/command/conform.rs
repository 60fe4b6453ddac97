//! Sets of case packs, and programs that are run on them.

use crate::command_line_common::{command, done, json, read, scene, text, write};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::{TempDir, tempdir};

const CLAIM_ALL: &str = "mkdir -p {out} && cp \"$(dirname {resolved})\"/*.csv \"$(dirname {resolved})\"/summary.json {out}";

/// A set of one case of each kind.
fn set() -> (TempDir, PathBuf) {
    let root = tempdir().unwrap();
    let bad = "[bearing]\nkind = \"deep-groove\"\nballs = 8\nball = { radius = \"6 mm\" }\ncolour = \"red\"\n";
    write(root.path(), "bad.toml", bad);
    let case = |name: &str, scene: &str, of: &str, level: u8, rest: &str| {
        format!(
            "[[case]]\nname = \"{name}\"\nscene = \"{scene}\"\nof = \"{of}\"\ntags = [\"{of}\"]\nlevel = {level}\n{rest}\n"
        )
    };
    let list = [
        case("tilted", &scene("deep_groove_tilt.toml"), "statics", 1, ""),
        case(
            "settling",
            &scene("settling.toml"),
            "run",
            2,
            "set = [\"numerics.end=2 ms\", \"numerics.output_interval=0.1 ms\"]",
        ),
        case("moments", &scene("deep_groove_moment.toml"), "sweep", 1, ""),
        case(
            "runs",
            &scene("varying_compliance_run.toml"),
            "sweep",
            2,
            "set = [\"sweep.of=runs\", \"numerics.end=2 ms\", \"output.window_start=1 ms\"]",
        ),
        case("whirl", &scene("rotor_on_springs.toml"), "modes", 4, ""),
        case("colour", "bad.toml", "refused", 1, "line = 5\nkey = \"bearing.colour\""),
    ];
    let list = write(root.path(), "list.toml", &list.concat());
    let folder = root.path().join("set");
    let said = done(&["pack", &list, "--out", &text(&folder)]);
    assert!(said.contains("wrote 6 packs"), "{said}");
    (root, folder)
}

/// Runs `conform` and returns its exit code and the statuses by name.
fn conform(
    set: &Path,
    with: &str,
    out: &Path,
    further: &[&str],
) -> (i32, Vec<(String, String, String)>) {
    let (set, out_text) = (text(set), text(out));
    let mut all = vec!["conform", &set, "--with", with, "--out", &out_text];
    all.extend(further);
    let output = command().args(&all).output().unwrap();
    let results = json(&out.join("results.json"));
    let part = |of: &Value, key: &str| of[key].as_str().unwrap().to_string();
    let rows = results.as_array().unwrap().iter();
    let rows = rows.map(|of| (part(of, "name"), part(of, "status"), part(of, "says"))).collect();
    (output.status.code().unwrap(), rows)
}

#[test]
fn this_program_passes_its_own_set() {
    let (root, set) = set();
    let own = format!("'{}' {{kind}} {{resolved}} --out {{out}}", env!("CARGO_BIN_EXE_bearing"));
    let out = root.path().join("out");
    let (code, rows) = conform(&set, &own, &out, &[]);
    assert!(rows.iter().all(|(_, status, _)| status == "passed"), "{rows:?}");
    assert_eq!((code, rows.len()), (0, 6));
    let page = read(&out.join("report.md"));
    assert!(page.contains("level 1") && page.contains("tag modes"), "{page}");
    // After an interruption what is done is not done again.
    let verdict = |name: &str| read(&out.join(name).join("verdict.json"));
    let before = verdict("settling");
    fs::remove_file(out.join("results.json")).unwrap();
    conform(&set, &own, &out, &[]);
    assert_eq!(before, verdict("settling"));
    let (_, of_level) = conform(&set, &own, &out, &["--level", "1"]);
    assert_eq!(of_level.len(), 3);
    let (_, tagged) = conform(&set, &own, &out, &["--tags", "modes,statics"]);
    assert_eq!(tagged.len(), 2);
}

/// A program that is built anew is another one, although its command is the same.
#[test]
fn a_changed_program_is_run_again() {
    let (root, set) = set();
    let program = write(
        root.path(),
        "program.sh",
        &CLAIM_ALL.replace("{out}", "\"$2\"").replace("{resolved}", "\"$1\""),
    );
    let (with, out) = (format!("sh '{program}' {{resolved}} {{out}}"), root.path().join("out"));
    let run = || conform(&set, &with, &out, &["--tags", "statics"]);
    let of_earlier = "of an earlier run";
    assert_eq!(run().1[0].1, "passed");
    assert!(!read(&out.join("report.md")).contains(of_earlier));
    // Not finished, it goes on with what it has; finished, it starts again.
    fs::remove_file(out.join("results.json")).unwrap();
    assert_eq!(run().1[0].1, "passed");
    assert!(read(&out.join("report.md")).contains(of_earlier));
    assert_eq!(run().1[0].1, "passed");
    assert!(!read(&out.join("report.md")).contains(of_earlier));
    fs::remove_file(out.join("results.json")).unwrap();
    write(root.path(), "program.sh", "exit 1");
    assert_eq!(run().1[0].1, "failed");

    let refused = |set: &Path, further: &[&str]| {
        let (set, out) = (text(set), text(&out));
        let with: &[&str] = if further.contains(&"--with") { &[] } else { &["--with", "true"] };
        let all = [&["conform", &set, "--out", &out], with, further].concat();
        crate::command_line_common::refused(&all)
    };
    let said = refused(&set, &["--tags", "static"]);
    assert!(said.contains("tags are modes, refused, run, statics, sweep"), "{said}");
    let said = refused(&set, &["--tags", "statics,tlit"]);
    assert!(said.contains("--tags tlit: no pack has it"), "{said}");
    let said = refused(&set, &["--with", "program {output}"]);
    assert!(said.contains("{output}: replaced are {resolved}, {out}, {kind}, {scene}"), "{said}");
    let said = refused(&set.join("tilted"), &[]);
    assert!(said.contains("is one case pack"), "{said}");
}

/// What explains or describes our way to the results is not asked of another program; shafts of other theories pass.
#[test]
fn packs_ask_for_results_alone() {
    let (_root, set) = set();
    let of = |pack: &str, file: &str| read(&set.join(pack).join(file));
    for name in ["across", "moves_most", "housings_share"] {
        assert!(!of("whirl", "summary.json").contains(name), "{name}");
    }
    for name in ["rolling_at", "slip_is", "every accepted step"] {
        assert!(!of("settling", "summary.json").contains(name), "{name}");
    }
    let tolerances: Value = serde_json::from_str(&of("whirl", "tolerances.json")).unwrap();
    let whirl = &tolerances["channels"]["rotor.whirl[].frequency"];
    assert!(whirl["relative"].as_f64().unwrap() >= 1e-4, "{whirl}");
    // A share of the highest frequency would be too much for the lowest.
    assert!(whirl["scale_relative"].as_f64().unwrap_or(0.0) <= 1e-9, "{whirl}");
    let tilted: Value = serde_json::from_str(&of("tilted", "tolerances.json")).unwrap();
    let channels = tilted["channels"].as_object().unwrap();
    assert!(!channels.is_empty());
    assert!(channels.values().all(|of| of["relative"].as_f64().unwrap_or(0.0) <= 1e-6));
}

/// The message has key and line in one line, each as a word.
#[test]
fn refusals_name_key_and_line() {
    let (root, set) = set();
    let out = root.path().join("out");
    for (message, expected) in [
        ("scene.toml:5:1: bearing.colour: unknown", "passed"),
        ("line 5: bearing.colour.tone: unknown", "passed"),
        ("scene.toml:50:1: bearing.colour", "failed"),
        ("scene.toml:1:5: bearing.colour", "failed"),
        ("scene.toml:5:1: bearing.colours", "failed"),
        ("scene.toml:5:1: bearing'; echo 'scene.toml:1:1: bearing.colour", "failed"),
    ] {
        let with = format!("echo '{message}'; exit 2");
        let (_, rows) = conform(&set, &with, &out, &["--tags", "refused"]);
        assert_eq!(rows[0].1, expected, "{message}: {}", rows[0].2);
    }
}

/// Frequencies of a list, as a book prints them; in the second case one is 2e-3 off.
#[test]
fn printed_entries_of_lists_are_compared() {
    let root = tempdir().unwrap();
    let case = |name: &str, second: f64| {
        format!(
            "[[case]]\nname = \"{name}\"\nscene = \"{}\"\nof = \"modes\"\ntags = [\"whirl\"]\nlevel = 4\n\
             expected = {{ \"rotor.whirl.0.frequency\" = [13.59024, 1e-3], \"rotor.whirl.1.frequency\" = [{second}, 1e-3] }}\n",
            scene("rotor_on_springs.toml")
        )
    };
    let list = [case("printed", 13.9738), case("misprinted", 13.9738 * 1.002)];
    let list = write(root.path(), "list.toml", &list.concat());
    let set = root.path().join("set");
    done(&["pack", &list, "--out", &text(&set)]);
    let own = format!("'{}' {{kind}} {{resolved}} --out {{out}}", env!("CARGO_BIN_EXE_bearing"));
    let (code, rows) = conform(&set, &own, &root.path().join("out"), &[]);
    assert_eq!(code, 1);
    for (name, status, says) in rows {
        let expected = if name == "printed" { "passed" } else { "failed" };
        assert_eq!(status, expected, "{name}: {says}");
        assert!(name == "printed" || says.contains("rotor.whirl[].frequency"), "{says}");
    }
}

#[test]
fn programs_that_leave_out_or_take_too_long_are_named() {
    let (root, set) = set();
    let status = |with: &str, further: &[&str]| {
        let out = root.path().join("other");
        let _ = fs::remove_dir_all(&out);
        let (code, rows) = conform(&set, with, &out, &[&["--tags", "statics"], further].concat());
        (code, rows[0].1.clone(), rows[0].2.clone())
    };
    assert_eq!(
        status("echo no housings; exit 3", &[]),
        (0, "not claimed".into(), "no housings".into())
    );
    assert_eq!(status("sleep 30", &["--timeout", "0.2"]).1, "timed out");
    let (code, failed, says) = status("echo out of luck; exit 4", &[]);
    assert_eq!((code, failed.as_str()), (1, "failed"));
    assert!(says.contains("out of luck"), "{says}");
    let nan =
        "mkdir -p {out} && echo '{\"x\": NaN}' > {out}/summary.json && touch {out}/series.csv";
    let (_, _, says) = status(nan, &["--tags", "modes"]);
    assert!(says.contains("has no NaN"), "{says}");
    let (_, status, says) = status("mkdir -p {out}", &[]);
    assert_eq!(status, "failed", "{says}");
    // All channels of a group may be absent, one alone not.
    let pack = set.join("tilted");
    let without = |parts: &[&str]| {
        let out = root.path().join("candidate");
        let _ = fs::remove_dir_all(&out);
        fs::create_dir(&out).unwrap();
        let mut summary = json(&pack.join("summary.json"));
        for path in parts {
            let (above, name) = path.rsplit_once('/').unwrap();
            summary.pointer_mut(above).unwrap().as_object_mut().unwrap().remove(name).unwrap();
        }
        fs::write(out.join("summary.json"), summary.to_string()).unwrap();
        fs::copy(pack.join("series.csv"), out.join("series.csv")).unwrap();
        let output = command().args(["compare", &text(&pack), &text(&out)]).output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
    };
    let (code, said) = without(&["/rating_life", "/stiffness"]);
    assert!(code == 0 && said.contains("not claimed: life, stiffness"), "{said}");
    assert_eq!(without(&["/stiffness/x"]).0, 1);
    assert_eq!(without(&["/inner_race"]).0, 1);
    // An extent is no direction: a turn less is another one.
    let out = root.path().join("candidate");
    let mut summary = json(&pack.join("summary.json"));
    let extent = summary.pointer_mut("/load_zone/extent/value").unwrap();
    *extent = (extent.as_f64().unwrap() - 360.0).into();
    fs::write(out.join("summary.json"), summary.to_string()).unwrap();
    let output = command().args(["compare", &text(&pack), &text(&out)]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
}

/// An interrupted comparison leaves no program behind, and names no pack as judged.
#[test]
fn an_interruption_ends_the_program_that_runs() {
    let (root, set) = set();
    let (set, out) = (text(&set), text(&root.path().join("out")));
    let pid = root.path().join("pid");
    let with = format!("echo $$ > '{}'; exec sleep 100", text(&pid));
    let mut conform = command()
        .args(["conform", &set, "--with", &with, "--out", &out, "--tags", "statics"])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let written = || fs::read_to_string(&pid).is_ok_and(|text| text.ends_with('\n'));
    while !written() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let is_alive = |pid: &str| {
        let found = std::process::Command::new("kill").args(["-0", pid]).output().unwrap();
        found.status.success()
    };
    let program = read(&pid).trim().to_string();
    assert!(is_alive(&program));
    let id = conform.id().to_string();
    std::process::Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert_eq!(conform.wait().unwrap().code(), Some(2));
    assert!(!is_alive(&program));
    assert!(!Path::new(&out).join("results.json").exists());
}

/// A number that is wrong by ten times its tolerance is found and its channel named: signs, axes, units, stiffness,
/// stale and shifted rows.
#[test]
fn a_wrong_number_is_found_and_named() {
    let (root, set) = set();
    let candidate = root.path().join("candidate");
    let first_difference = |pack: &Path| {
        let output = command().args(["compare", &text(pack), &text(&candidate)]).output().unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        said.lines().nth(1).unwrap().to_string()
    };
    let lay = |pack: &Path| {
        let _ = fs::remove_dir_all(&candidate);
        fs::create_dir(&candidate).unwrap();
        for name in ["summary.json", "series.csv", "campbell.csv"] {
            if pack.join(name).exists() {
                fs::copy(pack.join(name), candidate.join(name)).unwrap();
            }
        }
    };
    let mut errors = 0;
    // Tolerance of a channel where it is tightest.
    let allowed = |name: &str, file: &str, channel: &str| {
        let pack = text(&set.join(name));
        let output = command().args(["compare", &pack, &pack, "--json"]).output().unwrap();
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        let mut channels = found["channels"].as_array().unwrap().iter();
        let of = channels.find(|of| of["file"] == file && of["channel"] == channel).unwrap();
        of["worst"]["allowed"].as_f64().unwrap()
    };
    let mut in_summary = |name: &str, path: &str, change: &dyn Fn(f64, f64) -> f64| {
        let pack = set.join(name);
        lay(&pack);
        let parts = path.trim_start_matches('/').split('/').filter(|part| *part != "value");
        let channel = parts.fold(String::new(), |all, part| match part.parse::<usize>() {
            Ok(_) => all + "[]",
            Err(_) if all.is_empty() => part.into(),
            Err(_) => all + "." + part,
        });
        let tolerance = allowed(name, "summary.json", &channel);
        let mut summary = json(&pack.join("summary.json"));
        let value = summary.pointer_mut(path).unwrap();
        *value = change(value.as_f64().unwrap(), 10.0 * tolerance).into();
        fs::write(candidate.join("summary.json"), summary.to_string()).unwrap();
        let said = first_difference(&pack);
        let named: String = said.chars().filter(|c| !c.is_ascii_digit()).collect();
        assert!(named.contains(&channel), "{channel}: {said}");
        errors += 1;
    };
    for path in [
        "/inner_race/position/x/value",
        "/inner_race/loads/tilt_y/value",
        "/inner_race/contact_moment/y/value",
        "/stiffness/x/x/value",
        "/stiffness/tilt_z/y/value",
        "/balls/0/inner/load/value",
        "/balls/3/outer/peak_pressure/value",
        "/rating_life/revolutions/value",
        "/frequencies/cage/over_shaft/value",
    ] {
        in_summary("tilted", path, &|value, wrong| value + wrong);
    }
    for path in ["/inner_race/loads/tilt_y/value", "/balls/2/inner/contact_angle/value"] {
        in_summary("tilted", path, &|value, _| -value);
        in_summary("tilted", path, &|value, _| value * 1e3);
    }
    // K_H as of another fit; a moment of the gyroscopes left out.
    in_summary("tilted", "/hertz/inner_race/stiffness/value", &|value, _| 1.01 * value);
    for path in [
        "/rotor/whirl/0/frequency/value",
        "/rotor/whirl/1/direction/value",
        "/rotor/critical_speeds/0/speed/value",
    ] {
        in_summary("whirl", path, &|value, wrong| value - wrong);
    }
    let mut in_table = |name: &str,
                        table: &str,
                        column: &str,
                        row: usize,
                        change: &dyn Fn(&[f64], usize, f64) -> f64| {
        let pack = set.join(name);
        lay(&pack);
        let wrong = 10.0 * allowed(name, table, column);
        let content = read(&pack.join(table));
        let mut lines: Vec<String> = content.lines().map(str::to_string).collect();
        let at = lines[0].split(',').position(|of| of.split(' ').next() == Some(column)).unwrap();
        let cell = |line: &String| line.split(',').nth(at).unwrap().parse::<f64>().unwrap();
        let values: Vec<f64> = lines[1..].iter().map(cell).collect();
        let mut cells: Vec<String> = lines[row + 1].split(',').map(str::to_string).collect();
        cells[at] = format!("{:e}", change(&values, row, wrong));
        lines[row + 1] = cells.join(",");
        fs::write(candidate.join(table), lines.join("\n") + "\n").unwrap();
        let said = first_difference(&pack);
        assert!(said.contains(column), "{column}: {said}");
        assert!(said.contains(&format!("row {}", row + 1)), "{column}: {said}");
        errors += 1;
    };
    for (column, row) in [
        ("position_x", 2),
        ("inner_load", 0),
        ("inner_semi_major", 4),
        ("outer_force_on_race_y", 1),
        ("cage_force", 6),
    ] {
        in_table("tilted", "series.csv", column, row, &|values, row, wrong| values[row] + wrong);
    }
    for (column, row) in [("inner_x", 7), ("inner_velocity_x", 3), ("energy_kinetic", 12)] {
        // Stale, of the next row, and with the other sign.
        in_table("settling", "series.csv", column, row, &|values, row, _| values[row - 1]);
        in_table("settling", "series.csv", column, row, &|values, row, _| values[row + 1]);
        in_table("settling", "series.csv", column, row, &|values, row, _| -values[row]);
    }
    in_table("whirl", "campbell.csv", "frequency_1", 5, &|values, row, wrong| values[row] + wrong);
    assert!(errors >= 30, "{errors}");
    // The same through the command.
    let stale = "awk 'NR==3{print p; next} {p=$0; print}' {out}/series.csv > {out}/t && mv {out}/t {out}/series.csv";
    let spoilt = format!("{CLAIM_ALL} && {stale}");
    let (code, rows) = conform(&set, &spoilt, &root.path().join("out"), &["--tags", "run"]);
    assert_eq!((code, rows[0].1.as_str()), (1, "failed"));
    assert!(rows[0].2.contains("row 2"), "{rows:?}");
    let (code, _) = conform(&set, CLAIM_ALL, &root.path().join("out"), &["--tags", "run"]);
    assert_eq!(code, 0);
}

/// A cage that strikes its pockets: two starts part after some milliseconds. Their statistics agree; those of a contact
/// that is 2 % stiffer do not.
#[test]
fn a_chaotic_run_is_compared_by_its_statistics() {
    let root = tempdir().unwrap();
    let list = format!(
        "[[case]]\nname = \"cage\"\nscene = \"{}\"\nof = \"run\"\ntags = [\"cage\"]\nlevel = 2\n\
         set = [\"numerics.end=40 ms\", \"numerics.output_interval=1 ms\", \"output.window_start=20 ms\", \"output.plots=[]\"]\n",
        scene("bearing_6205_run.toml")
    );
    let list = write(root.path(), "list.toml", &list);
    let set = text(&root.path().join("set"));
    done(&["pack", &list, "--out", &set]);
    let pack = root.path().join("set/cage");
    let rows = json(&pack.join("tolerances.json"))["rows"].as_u64().unwrap();
    assert!((2..40).contains(&rows), "{rows}");
    let resolved = json(&pack.join("resolved.json"));
    let differs = |name: &str, change: &dyn Fn(&mut Value)| {
        let mut other = resolved.clone();
        change(&mut other);
        let path = write(root.path(), &format!("{name}.json"), &other.to_string());
        let out = text(&root.path().join(name));
        done(&["run", &path, "--out", &out]);
        let output = command().args(["compare", &text(&pack), &out]).output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
    };
    let (code, said) = differs("start", &|scene| {
        let phase = &mut scene["bearing"]["ball_phase"];
        *phase = (phase.as_f64().unwrap_or(0.0) + 9.5e-6).into();
    });
    assert_eq!(code, 0, "{said}");
    let (code, said) = differs("stiffer", &|scene| {
        for part in ["ball", "inner_race", "outer_race"] {
            let modulus = &mut scene["bearing"][part]["material"]["youngs_modulus"];
            *modulus = (1.02 * modulus.as_f64().unwrap()).into();
        }
    });
    assert!(code == 1 && said.contains("window.channels.inner_z.mean"), "{said}");
    let out = root.path().join("out");
    assert_eq!(conform(Path::new(&set), CLAIM_ALL, &out, &[]).0, 0);
    let page = read(&out.join("report.md"));
    assert!(page.contains(&format!("its first {rows} rows are compared")), "{page}");
}

/// The speed of a race that may tilt freely is rounding: there is no friction torque and no slip to divide by it. The
/// ball and the time of the largest load are those of one of equal balls, and not compared.
#[test]
fn a_race_at_rest_has_no_speed_and_equal_balls_no_first() {
    let root = tempdir().unwrap();
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance/scenes/level2/free_tilting.toml");
    let list = format!(
        "[[case]]\nname = \"tilting\"\nscene = {:?}\nof = \"run\"\ntags = []\nlevel = 2\nset = [\"numerics.end=1 ms\"]\n",
        text(&path)
    );
    let list = write(root.path(), "list.toml", &list);
    let set = root.path().join("set");
    done(&["pack", &list, "--out", &text(&set)]);
    let summary = json(&set.join("tilting/summary.json"));
    assert!(summary["friction"]["power_loss"]["value"].as_f64().unwrap() > 0.0, "{summary}");
    assert!(summary["friction"]["torque"].is_null() && summary["kinematics"].is_null());
    let channels = &json(&set.join("tilting/tolerances.json"))["channels"];
    for place in ["ball", "time"] {
        let channel = format!("extremes.inner_race.largest_load.{place}");
        assert_eq!(channels[&channel]["class"], "ignored", "{channel}");
    }
    assert!(channels["extremes.inner_race.largest_load.load"]["class"].is_null());
}
