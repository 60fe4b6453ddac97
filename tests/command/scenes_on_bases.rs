//! Scenes on a base at the command line: what is read, packed, swept and gone on with.

use crate::command_line_common::{changed, done, read, refused, scene, text, write};
use std::fs;
use tempfile::tempdir;

#[test]
fn check_names_the_base_and_takes_its_keys() {
    let loose = done(&["check", &scene("rotor_in_loose_pillow_blocks.toml")]);
    assert!(loose.contains("base                   rotor_in_pillow_blocks.toml"), "{loose}");
    // What it says itself, and what it takes from there.
    let echo: serde_json::Value = serde_json::from_str(&done(&[
        "check",
        "--json",
        &scene("rotor_in_loose_pillow_blocks.toml"),
    ]))
    .unwrap();
    assert_eq!(echo["scene"]["title"], "Flexible rotor on two bearings in two loose pillow blocks");
    assert_eq!(echo["scene"]["source"], "Table 4.1, sections 4.2 and 4.3");
}

/// A pack holds what its scene is on, and can be solved where it lies.
#[test]
fn a_pack_holds_the_bases() {
    let root = tempdir().unwrap();
    let base = fs::read_to_string(scene("deep_groove_tilt.toml")).unwrap();
    fs::create_dir(root.path().join("parts")).unwrap();
    write(root.path(), "parts/base.toml", &base);
    let path = write(root.path(), "study.toml", "base = \"parts/base.toml\"\ntitle = \"study\"\n");
    let [pack, out] = ["pack", "out"].map(|name| text(&root.path().join(name)));
    assert!(done(&["pack", &path, "--out", &pack]).starts_with("wrote 8 files to "));
    fs::remove_dir_all(root.path().join("parts")).unwrap();
    done(&["statics", &format!("{pack}/scene.toml"), "--out", &out]);
    assert!(done(&["compare", &pack, &out]).starts_with("equal: "));
    // With a base elsewhere, or named from the root, the pack has the whole scene.
    fs::create_dir(root.path().join("deep")).unwrap();
    let inside = write(root.path(), "base.toml", &base);
    let shipped = scene("deep_groove_tilt.toml");
    for (name, base) in [
        ("shipped.toml", shipped.as_str()),
        ("rooted.toml", &inside),
        ("deep/study.toml", "../base.toml"),
    ] {
        let path = write(root.path(), name, &format!("base = \"{base}\"\n"));
        let pack = root.path().join(format!("{name}-pack"));
        assert!(done(&["pack", &path, "--out", &text(&pack)]).starts_with("wrote 7 files to "));
        let whole = text(&pack.join("scene.json"));
        let out = text(&root.path().join(format!("{name}-out")));
        done(&["statics", &whole, "--out", &out]);
        assert!(done(&["compare", &text(&pack), &out]).starts_with("equal: "), "{name}");
    }
}

/// A run goes on from its state where base and scene are what they were, and is refused where the base is not.
#[test]
fn a_run_on_a_base_goes_on() {
    let root = tempdir().unwrap();
    let base = fs::read_to_string(scene("settling.toml")).unwrap();
    write(root.path(), "base.toml", &base);
    let text_of = |end: &str| format!("base = \"base.toml\"\n[numerics]\nend = \"{end}\"\n");
    let path = write(root.path(), "study.toml", &text_of("1 ms"));
    let out = text(&root.path().join("out"));
    done(&["run", &path, "--out", &out]);
    write(root.path(), "study.toml", &text_of("2 ms"));
    done(&["run", &path, "--out", &out, "--resume"]);
    let last = read(&root.path().join("out/series.csv"));
    assert!(last.lines().last().unwrap().starts_with("0.002,"), "{last}");
    let other = changed(&base, "balls = 8", "balls = 9");
    write(root.path(), "base.toml", &other);
    write(root.path(), "study.toml", &text_of("3 ms"));
    let said = refused(&["run", &path, "--out", &out, "--resume"]);
    assert!(said.contains("balls"), "{said}");
}
