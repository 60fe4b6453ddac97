//! Every command on small scenes of every kind of body. docs/features.md has the table, which this test compares with
//! what the commands did.

use crate::assembly_common::{BEARING, ENDS, SHAFT};
use crate::command_line_common::{self as files, Run, bearing, changed, json, read, scene, text};
use crate::housed_command_common::scene_text;
use crate::rubber_command::RUBBER;
use crate::solid_command_common::SHORT_RUN;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Limits that a successful command reported, or the reason why it refused.
type Cell = Result<String, String>;

/// One kind of body, its scene without `[numerics]` and `[output]`, and a key to sweep.
struct Body {
    name: &'static str,
    scene: String,
    vary: &'static str,
}

/// A row of the table: its name, what a yes requires, and the check.
type Feature = (&'static str, &'static str, fn(&Place) -> Cell);

const FEATURES: [Feature; 16] = [
    ("check", "the scene is reported as valid", check),
    ("check --json", "the output is one JSON object", check_json),
    ("plan", "stages are listed, and no refusal is announced", plan),
    ("statics", "`summary.json` and `series.csv` exist", statics),
    ("run", "the run is complete, and the last row is at its end", run),
    ("resume", "half a run, resumed, has the `series.csv` of an unbroken one", resume),
    ("threads", "`run --threads 2` has the `series.csv` of one thread", threads),
    ("sweep", "both of two points are in `sweep.csv`", sweep),
    ("sweep --of runs", "both of two points are in `series.csv`", sweep_of_runs),
    ("modes", "`series.csv` has frequencies", modes),
    ("pack", "`compare` finds the pack equal to results of its command", pack),
    ("compare", "results of two equal runs (of statics where nothing runs) are equal", compare),
    ("fields", "with `fields_interval`, `fields.pvd` lists files that exist", fields),
    ("spectrum", "`spectrum.csv` exists with `plots = [\"spectrum\"]`, and has rows", spectrum),
    ("plots", "`plots = [\"series\"]` gives a picture", plots),
    (
        "error control",
        "with `numerics.accuracy` the run is complete, and its steps follow from the accuracy",
        error_control,
    ),
];

const END: &str = "20 us";
const HALF: &str = "10 us";

/// Without friction, whose short steps say nothing here.
const SMOOTH: &str = "[traction]\nlaw = \"none\"\n";

const ALONE: &str = r#"
[inner_race]
x = { load = "445 N" }
z = { load = "-100 N" }
speed = "1000 rpm"
"#;

const FIT: &str = "housing.fit.radial=0 um, 1 um";
const CLEARANCE: &str = "bearing.clearance.radial=0 um, 1 um";

fn bodies() -> Vec<Body> {
    let housed = |method: &str| {
        // An explicit run that is resumed to another end has its ramp written.
        let ramp = if method == "explicit" { "fit_ramp = \"10 us\"\n" } else { "" };
        scene_text(&format!("method = \"{method}\"\nfit.radial = \"1 um\"\n{ramp}"), "")
    };
    let shipped = read(Path::new(&scene("shaft_in_two_housings.toml")));
    let several = |method: &str| {
        let start = if method == "explicit" { "\nstart = \"equilibrium\"" } else { "" };
        let method = format!("method = \"{method}\"{start}");
        let mut words = changed(&shipped, "method = \"reduced\"", &method);
        for (from, to) in [
            ("order = 2", "order = 1"),
            ("[numerics]\nend = \"2 ms\"\noutput_interval = \"5 us\"\n", ""),
            ("[output]\nplots = [\"load-zone\", \"series\", \"orbit\"]", ""),
        ] {
            words = changed(&words, from, to);
        }
        words
    };
    // Without what every scene here is given.
    let bent = read(Path::new(&scene("rotor_in_elements.toml")));
    let (bent, _) = bent.split_once("[numerics]").expect("a run");
    let mut elements = bent.to_string();
    for (from, to) in [
        ("longest_layer = \"5 mm\"", "longest_layer = \"25 mm\""),
        ("{ smooth_ramp = [\"0 N\", \"-600 N\"], duration = \"2 ms\" }", "\"-600 N\""),
    ] {
        elements = changed(&elements, from, to);
    }
    let mesh = "mesh = { order = 1, method = \"explicit\", longest_layer = \"25 mm\" }\n";
    let bends = changed(&elements, mesh, "");
    let body = |name, scene, vary| Body { name, scene, vary };
    vec![
        body("bearing alone", [BEARING, SMOOTH, ALONE].concat(), "inner_race.x.load=445 N, 400 N"),
        body(
            "solid alone",
            changed(SHORT_RUN, "[numerics]\n", ""),
            "solid.material.youngs_modulus=200 GPa, 210 GPa",
        ),
        body(
            "solid of rubber",
            changed(RUBBER, "duration = \"0.1 s\"", "duration = \"1 ms\""),
            "solid.material.chain=8, 9",
        ),
        body("bearing in a housing, quasi-static", housed("quasi-static"), FIT),
        body("bearing in a housing, explicit", housed("explicit"), FIT),
        body("bearing in a housing, reduced", housed("reduced"), FIT),
        body(
            "several bearings on a shaft",
            [BEARING, SMOOTH, ENDS, SHAFT].concat(),
            "outer_race.left.x=-6 um, -3 um",
        ),
        body("several in housings, quasi-static", several("quasi-static"), FIT),
        body("several in housings, reduced", several("reduced"), FIT),
        body("several in housings, explicit", several("explicit"), FIT),
        body("shaft that bends", bends, CLEARANCE),
        body("shaft in elements", elements, CLEARANCE),
    ]
}

/// Where one body is tried, and results that several features look at.
struct Place {
    folder: tempfile::TempDir,
    body: Body,
    still: Cell,
    whole: Cell,
    other: Cell,
}

impl Place {
    fn new(body: Body) -> Place {
        let folder = tempfile::tempdir().expect("a folder");
        let nothing = || Ok(String::new());
        let mut place =
            Place { folder, body, still: nothing(), whole: nothing(), other: nothing() };
        let path = place.scene("scene", END, "");
        place.still = place.done(&["statics", &path, "--out", &place.out("still")]);
        place.whole = place.done(&["run", &path, "--out", &place.out("whole")]);
        place.other = place.done(&["run", &path, "--out", &place.out("other"), "--threads", "2"]);
        place
    }

    /// A scene file of this body.
    fn scene(&self, name: &str, end: &str, numerics: &str) -> String {
        let run = format!(
            "\n[numerics]\nend = \"{end}\"\noutput_interval = \"1 us\"\n{numerics}\n\
             [output]\nplots = [\"series\", \"spectrum\"]\n"
        );
        files::write(self.folder.path(), &format!("{name}.toml"), &(self.body.scene.clone() + &run))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn out(&self, name: &str) -> String {
        text(&self.path(name))
    }

    /// What a command printed, or its reason for refusing. A refusal must be one line of its own.
    fn done(&self, arguments: &[&str]) -> Cell {
        let run: Run = bearing(arguments);
        match run.code {
            Some(0) => Ok(run.stdout),
            _ => Err(clause(&files::refusal(arguments, &run))),
        }
    }

    fn series(&self, of: &str) -> String {
        read(&self.path(of).join("series.csv"))
    }

    fn fail(&self, what: &str) -> ! {
        panic!("{}: {what}", self.body.name)
    }

    /// A plain yes where this holds.
    fn yes(&self, holds: bool, what: &str) -> Cell {
        if holds { Ok(String::new()) } else { self.fail(what) }
    }
}

/// The first clause of a message: without file and line, hints, and what stands behind a semicolon.
fn clause(message: &str) -> String {
    let mut rest = message;
    if let Some((place, after)) = message.split_once(": ")
        && place.contains(".toml")
    {
        rest = after;
    }
    let end = ["; ", ". Hint: ", " ("].iter().filter_map(|mark| rest.find(mark)).min();
    rest[..end.unwrap_or(rest.len())].replace(": refused: ", ": ")
}

fn check(place: &Place) -> Cell {
    let said = place.done(&["check", &place.out("scene.toml")])?;
    place.yes(said.contains("a valid scene"), &said)
}

fn check_json(place: &Place) -> Cell {
    let said = place.done(&["check", &place.out("scene.toml"), "--json"])?;
    let tree: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    place.yes(tree.as_object().is_some_and(|object| !object.is_empty()), &said)
}

fn plan(place: &Place) -> Cell {
    let said = place.done(&["plan", &place.out("scene.toml")])?;
    // An announced refusal comes true.
    match (said.split_once("the run will be refused: "), &place.whole) {
        (None, Ok(_)) => place.yes(said.contains("does  "), &said),
        (Some((_, reason)), Err(refused)) => {
            let reason = clause(reason.lines().next().unwrap_or(""));
            assert_eq!(&reason, refused, "{}", place.body.name);
            Ok(format!("the run will be refused: {reason}"))
        }
        _ => place.fail(&said),
    }
}

fn statics(place: &Place) -> Cell {
    place.still.clone()?;
    let there = ["summary.json", "series.csv"].map(|name| place.path("still").join(name).is_file());
    place.yes(there == [true; 2], "statics")
}

fn run(place: &Place) -> Cell {
    place.whole.clone()?;
    let complete = json(&place.path("whole/summary.json"))["complete"] == true;
    let series = place.series("whole");
    let last = series.lines().last().and_then(|row| row.split(',').next());
    let end = last.and_then(|time| time.parse::<f64>().ok()).unwrap_or(f64::NAN);
    place.yes(complete && (end - 20e-6).abs() <= 1e-12, &series)
}

fn resume(place: &Place) -> Cell {
    let half = place.scene("half", HALF, "");
    let out = place.out("parts");
    place.done(&["run", &half, "--out", &out])?;
    let said = place.done(&["run", &place.out("scene.toml"), "--out", &out, "--resume"])?;
    let same = place.series("parts") == place.series("whole");
    place.yes(same && said.contains("resumed at"), &said)
}

fn threads(place: &Place) -> Cell {
    place.other.clone()?;
    let used = json(&place.path("other/summary.json"))["threads"].clone();
    place.yes(place.series("other") == place.series("whole"), "threads")?;
    Ok(if used == 2 { String::new() } else { format!("`summary.json`: threads {used}") })
}

fn sweep(place: &Place) -> Cell {
    let scene = place.out("scene.toml");
    let said =
        place.done(&["sweep", &scene, "--vary", place.body.vary, "--out", &place.out("sweep")])?;
    let rows = read(&place.path("sweep/sweep.csv"));
    place.yes(rows.lines().count() == 3, &rows)?;
    Ok(said.lines().nth(1).unwrap_or("").to_string())
}

fn sweep_of_runs(place: &Place) -> Cell {
    let (scene, out) = (place.out("scene.toml"), place.out("runs"));
    place.done(&["sweep", &scene, "--vary", place.body.vary, "--of", "runs", "--out", &out])?;
    let rows = place.series("runs");
    place.yes(rows.lines().count() == 3, &rows)
}

fn modes(place: &Place) -> Cell {
    place.done(&["modes", &place.out("scene.toml"), "--out", &place.out("modes")])?;
    let rows = place.series("modes");
    place.yes(rows.contains("frequency [") && rows.lines().count() > 1, &rows)
}

fn pack(place: &Place) -> Cell {
    let said = place.done(&["pack", &place.out("scene.toml"), "--out", &place.out("pack")])?;
    let kind = said.trim_end().rsplit(": ").next().unwrap_or_default();
    let results = if kind == "run" { "whole" } else { "still" };
    let found = place.done(&["compare", &place.out("pack"), &place.out(results)])?;
    place.yes(found.starts_with("equal: "), &found)?;
    Ok(format!("results of `{kind}`"))
}

fn compare(place: &Place) -> Cell {
    // By one thread: two evaluate elements between them twice, and say so.
    let (command, first) =
        if place.whole.is_ok() { ("run", "whole") } else { ("statics", "still") };
    let again = place.out("again");
    place.done(&[command, &place.out("scene.toml"), "--out", &again])?;
    let said = place.done(&["compare", &place.out(first), &again])?;
    place.yes(said.starts_with("equal: "), &said)
}

fn fields(place: &Place) -> Cell {
    let path = place.scene("fields", END, "fields_interval = \"10 us\"");
    place.done(&["run", &path, "--out", &place.out("fields")])?;
    let list = read(&place.path("fields/fields.pvd"));
    let names: Vec<&str> =
        list.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let there = names.iter().all(|name| place.path("fields").join(name).is_file());
    // At the start, half way and at the end, of each solid.
    place.yes(there && names.len() >= 3 && names.len().is_multiple_of(3), &list)
}

fn spectrum(place: &Place) -> Cell {
    place.whole.clone()?;
    let rows = read(&place.path("whole/spectrum.csv"));
    place.yes(rows.starts_with("frequency [") && rows.lines().count() > 2, &rows)
}

fn plots(place: &Place) -> Cell {
    place.whole.clone()?;
    let names = files::files(&place.path("whole"));
    let drawn = |name: &&String| name.ends_with(".svg") && !name.starts_with("spectrum");
    place.yes(names.iter().find(drawn).is_some(), &names.join(" "))
}

fn error_control(place: &Place) -> Cell {
    let path = place.scene("accuracy", END, "accuracy = 1e-4");
    let said = place.done(&["run", &path, "--out", &place.out("accuracy")])?;
    let complete = json(&place.path("accuracy/summary.json"))["complete"] == true;
    let Some((_, rest)) = said.split_once("accuracy 0.0001: ") else { place.fail(&said) };
    let words = rest.lines().next().unwrap_or("");
    place.yes(complete && words.contains("adaptive steps"), &said)?;
    // What stands for the whole run begins with the steps, what does not with whose they are.
    Ok(if words.starts_with("steps") { String::new() } else { words.to_string() })
}

fn page(columns: &BTreeMap<usize, (&'static str, Vec<Cell>)>) -> String {
    let mut page = String::from(
        "# Commands and kinds of scene\n\n\
         A cell is *yes*, or the first clause of the message with which the command refuses. A limit follows a yes. The table\n\
         is made by running the command on small scenes: `FEATURES=write cargo test --release --test command features`.\n\n|",
    );
    for (name, _) in columns.values() {
        page += &format!(" | {name}");
    }
    page += " |\n|---|";
    page += &"---|".repeat(columns.len());
    for (at, (name, ..)) in FEATURES.iter().enumerate() {
        page += &format!("\n| **{name}** |");
        for (_, cells) in columns.values() {
            let cell = match &cells[at] {
                Ok(limits) if limits.is_empty() => "yes".to_string(),
                Ok(limits) => format!("yes; {limits}"),
                Err(reason) => reason.clone(),
            };
            page += &format!(" {} |", cell.replace('|', "\\|"));
        }
    }
    page += "\n\nA yes requires:\n\n";
    for (name, looked_at, _) in FEATURES {
        page += &format!("- **{name}**: {looked_at}.\n");
    }
    page
}

/// `FEATURES=write cargo test --release --test command features` rewrites the table.
#[test]
fn the_table_of_features_is_what_the_commands_do() {
    let columns = std::thread::scope(|scope| {
        let tried = bodies().into_iter().enumerate().map(|(at, body)| {
            scope.spawn(move || {
                let place = Place::new(body);
                let cells = FEATURES.iter().map(|(.., look)| look(&place)).collect::<Vec<_>>();
                (at, (place.body.name, cells))
            })
        });
        let tried: Vec<_> = tried.collect();
        tried.into_iter().map(|body| body.join().expect("a column")).collect::<BTreeMap<_, _>>()
    });
    let made = page(&columns);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/features.md");
    if std::env::var_os("FEATURES").is_some_and(|mode| mode == "write") {
        std::fs::write(path, &made).expect("docs/features.md can be written");
    }
    let committed = std::fs::read_to_string(path).expect("docs/features.md exists");
    assert!(
        committed == made,
        "docs/features.md is out of date: run FEATURES=write cargo test --release --test command features\n{made}"
    );
}

#[test]
fn a_reason_is_the_first_clause_of_a_message() {
    let cases = [
        (
            "/tmp/a.toml: modes takes a solid, and this is none; see there",
            "modes takes a solid, and this is none",
        ),
        ("a.toml:2:3: solid: refused: not here. Hint: leave it out", "solid: not here"),
        ("it cannot (there is no file)", "it cannot"),
    ];
    for (message, expected) in cases {
        assert_eq!(clause(message), expected);
    }
}
