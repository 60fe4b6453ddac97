//! Scenes on a base: another file with the scene's own keys laid over it.

use bearing_dynamics::scene::{Document, Subject, SweepValues, resolve_subject};
use std::fs;
use std::path::Path;
use tempfile::{TempDir, tempdir};

const SHIPPED: &str = "rotor_in_pillow_blocks.toml";

fn shipped() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(SHIPPED)).unwrap()
}

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let root = tempdir().unwrap();
    for (name, text) in files {
        let path = root.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    root
}

fn read(root: &TempDir, name: &str) -> Result<Subject, String> {
    let document = Document::read_file(&root.path().join(name)).map_err(|e| e.to_string())?;
    resolve_subject(&document).map_err(|e| e.to_string())
}

/// What is wrong, with the test's folder left out.
fn wrong(root: &TempDir, name: &str) -> String {
    let folder = format!("{}/", root.path().display());
    read(root, name).unwrap_err().replace(&folder, "")
}

fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_string(), |text, (from, to)| {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text.replace(from, to)
    })
}

/// Whatever a short scene says, the long one that says it in its own text is the same.
#[test]
fn a_scene_on_a_base_is_the_scene_written_out() {
    let base = shipped();
    for (own, changes) in [
        (
            "title = \"Loose\"\n",
            vec![(
                "title = \"Flexible rotor on two bearings in two pillow blocks\"",
                "title = \"Loose\"",
            )],
        ),
        // A key that excludes what the base says.
        (
            "[bearing]\nclearance = { diametral = \"4 um\" }\n",
            vec![("clearance = { radial = \"0 um\" }", "clearance = { diametral = \"4 um\" }")],
        ),
        (
            "[housing]\nfit = { radial = \"-2.5 um\" }\n",
            vec![("fit = { radial = \"2.5 um\" } ", "fit = { radial = \"-2.5 um\" } ")],
        ),
        // A name of its own, and one of the base.
        (
            "[housing.left]\nfit = { radial = \"1 um\" }\n",
            vec![("[solid]\n", "[housing.left]\nfit = { radial = \"1 um\" }\n[solid]\n")],
        ),
        (
            "[bearing.left]\ninner_at = \"-190 mm\"\n",
            vec![("inner_at = \"-200 mm\"", "inner_at = \"-190 mm\"")],
        ),
        // A list in place of the base's, one that is taken away, a profile in place of a value.
        (
            "[body.shaft.beam]\nload = [{ at = \"10 mm\", y = \"5 N\" }, { at = \"20 mm\", z = \"7 N\" }]\n",
            vec![(
                "load = [{ at = \"0 mm\", z = \"-3000 N\" }]",
                "load = [{ at = \"10 mm\", y = \"5 N\" }, { at = \"20 mm\", z = \"7 N\" }]",
            )],
        ),
        (
            "[body.shaft.beam]\nload = []\nunbalance = [{ at = \"0 mm\", size = \"1e-4 kg m\" }]\n",
            vec![(
                "load = [{ at = \"0 mm\", z = \"-3000 N\" }]",
                "unbalance = [{ at = \"0 mm\", size = \"1e-4 kg m\" }]",
            )],
        ),
        (
            "[body.shaft]\nspeed = { ramp = [\"0 rpm\", \"500 rpm\"], start = \"0 s\", duration = \"1 ms\" }\n",
            vec![(
                "speed = \"1000 rpm\"",
                "speed = { ramp = [\"0 rpm\", \"500 rpm\"], start = \"0 s\", duration = \"1 ms\" }",
            )],
        ),
        // Assumptions by their names.
        (
            "[assumptions]\nraces = \"light\"\n",
            vec![(
                "races = \"inner races have no mass of their own; the bores hold outer races along the axis\"\n",
                "races = \"light\"\n",
            )],
        ),
    ] {
        let long = changed(&base, &changes);
        let short = format!("base = \"parts/base.toml\"\n{own}");
        let root =
            folder(&[("parts/base.toml", &base), ("short.toml", &short), ("long.toml", &long)]);
        let [short, long] = ["short.toml", "long.toml"].map(|name| read(&root, name).unwrap());
        assert!(short == long, "{own}");
    }
}

#[test]
fn bases_have_bases_and_may_be_json() {
    let json = "{ \"base\": \"b.toml\", \"housing\": { \"fit\": { \"radial\": \"1 um\" } }, \"title\": \"middle\" }";
    let root = folder(&[
        ("b.toml", &shipped()),
        ("a.json", json),
        ("scene.toml", "base = \"a.json\"\nsource = \"top\"\n[housing]\nmodes_to = \"9 kHz\"\n"),
        (
            "long.toml",
            &changed(
                &shipped(),
                &[
                    (
                        "title = \"Flexible rotor on two bearings in two pillow blocks\"",
                        "title = \"middle\"",
                    ),
                    ("source = \"Table 4.1, sections 4.2 and 4.3\"", "source = \"top\""),
                    (
                        "fit = { radial = \"2.5 um\" } ",
                        "modes_to = \"9 kHz\"\nfit = { radial = \"1 um\" } ",
                    ),
                ],
            ),
        ),
    ]);
    assert!(read(&root, "scene.toml").unwrap() == read(&root, "long.toml").unwrap());
    let document = Document::read_file(&root.path().join("scene.toml")).unwrap();
    let names: Vec<String> = document.bases().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["a.json", "b.toml"]);
}

/// Axes of the base hold unless the scene has some of its own; a mesh lies beside the file that names it.
#[test]
fn sweeps_and_meshes_of_a_base() {
    let base = format!("{}\n[sweep]\n\"housing.fit.radial\" = [\"1 um\", \"2 um\"]\n", shipped());
    let mesh = "[solid.mesh]\nfile = \"part.msh\"\nunit = \"mm\"\n";
    let root = folder(&[
        ("base.toml", &base),
        ("same.toml", "base = \"base.toml\"\n"),
        ("own.toml", "base = \"base.toml\"\n[sweep]\n\"body.shaft.speed\" = [\"1 rpm\"]\n"),
        ("no.toml", "base = \"base.toml\"\n[sweep]\n"),
        ("parts/part.toml", mesh),
        ("part.toml", "base = \"parts/part.toml\"\n"),
    ]);
    for (name, key, values) in
        [("same.toml", "housing.fit.radial", 2), ("own.toml", "body.shaft.speed", 1)]
    {
        let document = Document::read_file(&root.path().join(name)).unwrap();
        let [axis] = &document.sweep()[..] else { panic!("one axis") };
        let SweepValues::List(list) = &axis.values else { panic!("a list") };
        assert_eq!((axis.key.as_str(), list.len()), (key, values));
    }
    assert!(Document::read_file(&root.path().join("no.toml")).unwrap().sweep().is_empty());
    let Subject::Solid(solid) = read(&root, "part.toml").unwrap() else { panic!("a solid") };
    let source = format!("{:?}", solid.mesh.source);
    let path = root.path().join("parts/part.msh");
    assert!(source.contains(&format!("name: \"parts/part.msh\", path: {path:?}")), "{source}");
}

/// Tables with names over those of a base: empty lists last, what reaches a new name is heard, what reaches nothing is refused.
#[test]
fn lists_of_names_over_those_of_a_base() {
    let load = "load = [{ at = \"0 mm\", z = \"-3000 N\" }]\n";
    let base = changed(
        &shipped(),
        &[(load, ""), ("[body.shaft.beam]\n", &format!("[body.beam]\n{load}[body.shaft.beam]\n"))],
    );
    let long = changed(&shipped(), &[(load, "")]);
    let own = shipped();
    let mid = "[bearing]\ninner_at = \"0 mm\"\n[bearing.mid]\nballs = 9\n";
    let root = folder(&[
        ("base.toml", &base),
        ("own.toml", &own),
        ("long.toml", &long),
        ("empty.toml", "base = \"base.toml\"\n[body.shaft.beam]\nload = []\n"),
        (
            "list.toml",
            "base = \"own.toml\"\n[body.beam]\nload = [{ at = \"0 mm\", z = \"-1 N\" }]\n",
        ),
        ("none.toml", "base = \"own.toml\"\n[body.beam]\nload = []\n"),
        ("mid.toml", &format!("base = \"own.toml\"\n{mid}")),
        (
            "mid_long.toml",
            &own.replace(
                "[bearing.left]\n",
                "inner_at = \"0 mm\"\n[bearing.mid]\nballs = 9\n[bearing.left]\n",
            ),
        ),
        ("bare.toml", "base = \"empty.toml\"\nwithout = \"base\"\n"),
        ("bodies.toml", "base = \"base.toml\"\nwithout = \"body\"\n"),
    ]);
    assert!(read(&root, "empty.toml").unwrap() == read(&root, "long.toml").unwrap());
    for name in ["list.toml", "none.toml"] {
        let said = wrong(&root, name);
        assert!(
            said.contains(
                "body.beam.load: refused: it has no effect, because [body.shaft] override it"
            ),
            "{said}"
        );
    }
    // It is heard by the bearing that is new; its place among the others is the order's.
    let places = |name: &str| {
        let Subject::Assembly(scene) = read(&root, name).unwrap() else { panic!("bearings") };
        let mut all: Vec<_> =
            scene.bearings.iter().map(|of| format!("{:?} {:?}", of.name, of.carriers[0])).collect();
        all.sort();
        all
    };
    assert_eq!(places("mid.toml"), places("mid_long.toml"));
    assert!(wrong(&root, "bare.toml").contains("does not contain \"base\""));
    // With its names: nothing is left for the bearings to sit on, and they are held where they are.
    let Subject::Assembly(scene) = read(&root, "bodies.toml").unwrap() else { panic!("bearings") };
    assert!(scene.bodies.is_empty());
}

/// What a scene leaves out of its base, by key, table, list, name and assumption.
#[test]
fn a_base_without_some_of_it() {
    let base = shipped();
    let left_out = changed(
        &base,
        &[
            ("stations = \"the bearings sit at the rotor's ends, as Table 4.3 asks for\"\n", ""),
            ("load = [{ at = \"0 mm\", z = \"-3000 N\" }]\n", ""),
            ("plots = [\"series\", \"orbit\"]\n", ""),
            ("[solid]\ndamping = \"77 1/s\"\n", ""),
            (
                "cells = { around = 16, radial = 1, axial = 1, growth = 1.0 }\n",
                "cells = { around = 12, radial = 1, axial = 1 }\n",
            ),
        ],
    );
    let more =
        format!("{base}\n[sensor.top]\nkind = \"accelerometer\"\non = \"left.outer_race\"\n");
    let short = "base = \"base.toml\"\nwithout = \"sensor.top, assumptions.stations, body.shaft.beam.load, output,solid.damping, solid.mesh.cells\"\n\
                 [solid.mesh.cells]\naround = 12\nradial = 1\naxial = 1\n";
    let root = folder(&[("base.toml", &more), ("long.toml", &left_out), ("short.toml", short)]);
    assert!(read(&root, "short.toml").unwrap() == read(&root, "long.toml").unwrap());
    let named = changed(
        &base,
        &[(
            "[solid]\n",
            "[housing.left]\nfit = { radial = \"1 um\" }\nwidth = \"18 mm\"\n[solid]\n",
        )],
    );
    let kept = changed(&named, &[("fit = { radial = \"1 um\" }\n", "")]);
    for (path, expected) in [("housing.left.fit", &kept), ("housing.left", &base)] {
        let short = format!("base = \"base.toml\"\nwithout = \"{path}\"\n");
        let root =
            folder(&[("base.toml", &named), ("long.toml", expected), ("short.toml", &short)]);
        assert!(read(&root, "short.toml").unwrap() == read(&root, "long.toml").unwrap(), "{path}");
    }
}

/// What all names have, one may be without.
#[test]
fn an_empty_list_takes_the_common_one_away() {
    let common = changed(
        &shipped(),
        &[(
            "[body.shaft.beam]\n",
            "[[solid.load]]\nset = \"fixed\"\nforce = [\"0 N\", \"0 N\", \"1 N\"]\n[solid.left]\nload = []\n[body.shaft.beam]\n",
        )],
    );
    let root = folder(&[("scene.toml", &common)]);
    let Subject::Assembly(scene) = read(&root, "scene.toml").unwrap() else { panic!("bearings") };
    let loads: Vec<usize> = scene
        .bearings
        .iter()
        .map(|placed| placed.housing.as_ref().unwrap().solid.loads.len())
        .collect();
    assert_eq!(loads, [0, 1]);
}

/// Every error says in which of the files it is.
#[test]
fn errors_name_the_file_that_is_wrong() {
    let base = shipped();
    let bad = changed(&base, &[("balls = 8", "balls = 2")]);
    let unfinished = changed(&base, &[("balls = 8\n", "")]);
    let own_clearance = changed(
        &base,
        &[
            ("inner_at = \"-200 mm\"", "inner_at = \"-200 mm\"\nclearance = { radial = \"1 um\" }"),
            ("inner_at = \"200 mm\"", "inner_at = \"200 mm\"\nclearance = { radial = \"1 um\" }"),
        ],
    );
    let root = folder(&[
        ("base.toml", &base),
        ("bad.toml", &bad),
        ("unfinished.toml", &unfinished),
        ("own.toml", &own_clearance),
        ("on_bad.toml", "base = \"bad.toml\"\n"),
        ("on_unfinished.toml", "base = \"unfinished.toml\"\n"),
        ("unknown.toml", "base = \"base.toml\"\n\n[bearing]\nbals = 9\n"),
        ("range.toml", "base = \"base.toml\"\n[bearing]\nballs = 9000\n"),
        ("late.toml", "base = \"base.toml\"\n[bearing.left]\ninner_on = \"shat\"\n"),
        ("nowhere.toml", "title = \"x\"\nbase = \"bse.toml\"\n"),
        ("text.toml", "base = \"notes.txt\"\n"),
        ("notes.txt", "a"),
        ("folder.toml", "base = \".\"\n"),
        ("number.toml", "base = 3\n"),
        ("round.toml", "base = \"round_too.toml\"\n"),
        ("round_too.toml", "base = \"round.toml\"\n"),
        ("unheard.toml", "base = \"own.toml\"\n[bearing]\nclearance = { radial = \"3 um\" }\n"),
        ("empty.toml", "base = \"nothing.toml\"\n"),
        ("without.toml", "base = \"base.toml\"\nwithout = \"traction, solid.msh\"\n"),
        ("baseless.toml", "without = \"traction\"\n"),
        ("nothing.toml", "\n"),
    ]);
    let line = |text: &str, of: &str| 1 + text[..text.find(of).unwrap()].matches('\n').count();
    for (name, expected) in [
        ("on_bad.toml", format!("bad.toml:{}:9: bearing.balls: 2 is outside", line(&bad, "balls = 2"))),
        ("on_unfinished.toml", format!("unfinished.toml:{}:10: bearing.left.balls: missing", line(&unfinished, "[bearing.left]"))),
        ("unknown.toml", "unknown.toml:4:1: bearing.bals: unknown key".into()),
        ("range.toml", "range.toml:3:9: bearing.balls: 9000 is outside".into()),
        ("late.toml", "late.toml:3:12: bearing.left.inner_on: ".into()),
        ("nowhere.toml", "nowhere.toml:2:8: base: refused: bse.toml cannot be read: there is no such file".into()),
        ("text.toml", "text.toml:1:8: base: refused: notes.txt cannot be read: unknown kind of scene file".into()),
        ("folder.toml", "folder.toml:1:8: base: refused: ".into()),
        ("number.toml", "number.toml:1:8: base: expected ".into()),
        ("round.toml", "round.toml:1:8: base: refused: this is base number 9; at most 8 are read. Hint: is the chain of bases circular?".into()),
        ("unheard.toml", "unheard.toml:3:24: bearing.clearance.radial: refused: it has no effect, because [bearing.left], \
                          [bearing.right] override it. Hint: write bearing.left.clearance.radial".into()),
        ("empty.toml", "nothing.toml: the file is empty".into()),
        ("without.toml", "without.toml:2:11: without: refused: base.toml does not contain \"solid.msh\"".into()),
        ("baseless.toml", "baseless.toml:1:11: without: refused: there is no base".into()),
    ] {
        let said = wrong(&root, name);
        assert!(said.starts_with(&expected), "{name}: {said}");
    }
    let document = Document::read_file(&root.path().join("base.toml"));
    let mut document = document.unwrap();
    assert!(document.set("base", "other.toml").is_err());
    assert!(document.set("without", "traction").is_err());
}
