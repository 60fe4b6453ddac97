//! Shards of a sweep, and the table that they make.

use crate::command_line_common::{bearing, command, done, read, refused, scene, text, write};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// Seven shards, three of them interrupted and resumed, make the table of the whole sweep: the same bytes.
#[test]
fn shards_make_the_table_of_the_whole() {
    let root = tempdir().unwrap();
    let path = scene("deep_groove_tilt.toml");
    let vary = [
        "--vary",
        "bearing.ball_phase=0 deg .. 44 deg / 23",
        "--vary",
        "inner_race.tilt_y.tilt=0.05 deg .. 0.2 deg / 7",
    ];
    let [whole, parts] = ["whole", "parts"].map(|name| root.path().join(name));
    let sweep = |out: &Path, further: &[&str]| {
        let out = text(out);
        bearing(&[&["sweep", &path, "--out", &out], &vary[..], further].concat())
    };
    assert_eq!(sweep(&whole, &[]).code, Some(0));
    let shard = |index: usize| sweep(&parts, &["--shard", &format!("{index}/7")]);
    for index in [0, 1, 2, 4, 5, 6] {
        assert_eq!(shard(index).code, Some(0), "{index}");
    }
    let refused = |further: &[&str]| {
        let run = sweep(&parts, &[&["--merge"], further].concat());
        assert_eq!(run.code, Some(2), "{run:?}");
        run.stderr
    };
    assert!(refused(&[]).contains("shard 3 of 7 is missing"));
    assert_eq!(shard(3).code, Some(0));
    // Killed within a row: the record says so, and half a line is no row.
    for index in [1, 2, 5] {
        let folder = parts.join(format!("shard-{index}-of-7"));
        let table = read(&folder.join("sweep.csv"));
        fs::write(folder.join("sweep.csv"), &table[..table.len() / 2]).unwrap();
        let record =
            read(&folder.join("sweep.json")).replace("\"complete\": true", "\"complete\": false");
        fs::write(folder.join("sweep.json"), record).unwrap();
        assert!(refused(&[]).contains("unfinished"));
        assert_eq!(shard(index).code, Some(0));
    }
    assert!(refused(&["--set", "bearing.balls=7"]).contains("another scene"));
    assert_eq!(sweep(&parts, &["--merge"]).code, Some(0));
    for name in ["sweep.csv", "sweep.npy"] {
        let [one, other] = [&whole, &parts].map(|folder| fs::read(folder.join(name)).unwrap());
        assert!(one == other, "{name}");
    }
    // A point in two shards.
    let [from, to] = [0, 1].map(|index| parts.join(format!("shard-{index}-of-7/sweep.csv")));
    let doubled = read(&to) + read(&from).lines().nth(1).unwrap() + "\n";
    fs::write(&to, doubled).unwrap();
    assert!(refused(&[]).contains("in two shards"));
    assert!(sweep(&parts, &["--shard", "7/7"]).stderr.contains("i from 0 to n - 1"));
    // The tasks of a Slurm array, counted from 1.
    let slurm = root.path().join("slurm");
    for task in 1..=2 {
        let mut command = command();
        command.args(["sweep", &path, "--out", &text(&slurm)]).args(vary);
        let variables = [("ID", task), ("COUNT", 2), ("MIN", 1), ("MAX", 2)];
        for (name, value) in variables {
            command.env(format!("SLURM_ARRAY_TASK_{name}"), value.to_string());
        }
        assert!(command.status().unwrap().success());
    }
    // One of them again.
    let mut again = command();
    again.args(["sweep", &path, "--out", &text(&slurm)]).args(vary);
    for (name, value) in [("ID", "2"), ("COUNT", "1"), ("MIN", "2"), ("MAX", "2")] {
        again.env(format!("SLURM_ARRAY_TASK_{name}"), value);
    }
    assert_eq!(again.output().unwrap().status.code(), Some(2));
    assert_eq!(sweep(&slurm, &["--merge"]).code, Some(0));
    let [one, other] = [&whole, &slurm].map(|folder| read(&folder.join("sweep.csv")));
    assert!(one == other);
}

#[test]
fn shards_of_runs_make_the_table_of_the_whole() {
    let root = tempdir().unwrap();
    let path = write(
        root.path(),
        "study.toml",
        &format!(
            "base = \"{}\"\n[numerics]\nend = \"1 ms\"\noutput_interval = \"0.05 ms\"\n[output]\nplots = []\n\
             window_start = \"0.5 ms\"\n[sweep]\nof = \"runs\"\n\"inner_race.x.load\" = \"200 N .. 300 N / 5\"\n",
            scene("settling.toml")
        ),
    );
    let [whole, parts] = ["whole", "parts"].map(|name| text(&root.path().join(name)));
    done(&["sweep", &path, "--out", &whole]);
    for shard in ["0/3", "2/3"] {
        done(&["sweep", &path, "--out", &parts, "--shard", shard]);
    }
    let merge = ["sweep", &path, "--out", &parts, "--merge"];
    assert!(refused(&merge).contains("shard 1 of 3 is missing"));
    done(&["sweep", &path, "--out", &parts, "--shard", "1/3"]);
    assert!(done(&merge).starts_with("5 runs merged: "));
    let [one, other] = [&whole, &parts].map(|folder| read(&Path::new(folder).join("series.csv")));
    assert!(one == other && one.lines().count() == 6, "{one}\n{other}");
}
