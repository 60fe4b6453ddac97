//! Malformed scenes: each gives one message with file, line and column (where a line exists), the
//! allowed range or a hint, and the wording is kept in a snapshot to be reviewed.

use bearing_dynamics::scene;
use bearing_dynamics::scene::{Document, Format};
use std::fmt::Write as _;
use std::io::{Seek, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

/// A correct scene; every case below changes one line of it.
const GOOD: &str = r#"title = "Table 4.1"
[bearing]
kind = "deep-groove"
balls = 8
clearance = { radial = "-5 um" }
[bearing.inner_race]
radius = "20.047 mm"
groove_radius = "6.013 mm"
material = { poisson_ratio = 0.3 }
[bearing.outer_race]
radius = "31.953 mm"
groove_radius = "6.310 mm"
[bearing.ball]
radius = "5.953 mm"
[bearing.cage]
pocket_radius = "6.2 mm"
[inner_race]
x = { load = "250 N" }
tilt_y = { tilt = "0.15 deg" }
[ball_forces]
centrifugal = false
[output]
plots = ["polar"]
"#;

const ANGULAR: &str = r#"[bearing]
kind = "angular-contact"
balls = 11
pitch_radius = "30 mm"
contact_angle = "35 deg"
ball.radius = "5.953 mm"
inner_race.groove_radius = "6.6 mm"
outer_race.groove_radius = "6.6 mm"
"#;

/// What a message must contain besides the place.
struct Case {
    name: &'static str,
    text: String,
    format: Format,
    /// Line of the error; `None` where the file as a whole is meant.
    line: Option<usize>,
    contains: &'static [&'static str],
}

/// `good` with `from`, which must occur in it once, replaced.
fn changed(good: &str, from: &str, to: &str) -> String {
    assert_eq!(good.matches(from).count(), 1, "{from:?} is not unique");
    good.replacen(from, to, 1)
}

fn toml(
    name: &'static str,
    from: &str,
    to: &str,
    line: usize,
    contains: &'static [&'static str],
) -> Case {
    let text = changed(GOOD, from, to);
    Case { name, text, format: Format::Toml, line: Some(line), contains }
}

fn angular(
    name: &'static str,
    from: &str,
    to: &str,
    line: usize,
    contains: &'static [&'static str],
) -> Case {
    let text = changed(ANGULAR, from, to);
    Case { name, text, format: Format::Toml, line: Some(line), contains }
}

fn json(name: &'static str, text: &str, line: usize, contains: &'static [&'static str]) -> Case {
    Case { name, text: text.to_string(), format: Format::Json, line: Some(line), contains }
}

fn cases() -> Vec<Case> {
    vec![
        toml("missing unit", "\"5.953 mm\"", "5.953", 14, &["has no unit", "mm, um", "5.953 mm"]),
        toml(
            "missing unit in a text",
            "\"5.953 mm\"",
            "\"5.953\"",
            14,
            &["has no unit", "5.953 mm"],
        ),
        toml(
            "unit of another dimension",
            "\"5.953 mm\"",
            "\"5.953 N\"",
            14,
            &["unit of force", "a length", "mm, um"],
        ),
        toml(
            "length for a force",
            "\"250 N\"",
            "\"250 mm\"",
            18,
            &["unit of length", "a force", "kN"],
        ),
        toml(
            "unknown unit",
            "\"5.953 mm\"",
            "\"5.953 MM\"",
            14,
            &["unknown unit `MM`", "did you mean `mm`"],
        ),
        toml("decimal comma", "\"5.953 mm\"", "\"5,953 mm\"", 14, &["comma", "decimal point"]),
        toml(
            "no number",
            "\"5.953 mm\"",
            "\"about 6 mm\"",
            14,
            &["not a number", "more than 0 mm"],
        ),
        toml("empty text", "\"5.953 mm\"", "\"\"", 14, &["not a number", "more than 0 mm"]),
        toml(
            "not a number",
            "\"5.953 mm\"",
            "\"nan mm\"",
            14,
            &["NaN, infinite", "more than 0 mm"],
        ),
        toml("too large for a double", "\"250 N\"", "\"1e999 N\"", 18, &["NaN, infinite"]),
        toml(
            "NaN in a table",
            "poisson_ratio = 0.3",
            "poisson_ratio = nan",
            9,
            &["NaN, infinite", "from 0 to less than 0.5"],
        ),
        toml(
            "infinity in a table",
            "poisson_ratio = 0.3",
            "poisson_ratio = -inf",
            9,
            &["NaN, infinite"],
        ),
        toml(
            "NaN in a list",
            "centrifugal = false",
            "gravity = [\"0 m/s^2\", \"nan m/s^2\", \"0 m/s^2\"]",
            21,
            &["NaN, infinite", "m/s^2"],
        ),
        toml(
            "two values for three",
            "centrifugal = false",
            "gravity = [\"0 m/s^2\", \"1 g\"]",
            21,
            &["three values", "found 2"],
        ),
        toml(
            "unknown key",
            "groove_radius = \"6.013 mm\"",
            "grove_radius = \"6.013 mm\"",
            8,
            &["unknown key", "did you mean `bearing.inner_race.groove_radius`"],
        ),
        toml(
            "key of another table",
            "balls = 8",
            "balls = 8\npoisson_ratio = 0.3",
            5,
            &["unknown key", "poisson_ratio`"],
        ),
        toml(
            "unknown key like no other",
            "balls = 8",
            "colour = \"red\"",
            4,
            &["unknown key", "Allowed here: kind, balls", "see docs"],
        ),
        toml(
            "unknown table",
            "[output]",
            "[outputs]",
            22,
            &["unknown key", "did you mean `output`"],
        ),
        toml(
            "negative radius",
            "\"20.047 mm\"",
            "\"-20.047 mm\"",
            7,
            &["outside", "more than 0 mm", "positive radius"],
        ),
        toml("zero radius", "\"20.047 mm\"", "\"0 mm\"", 7, &["outside", "more than 0 mm"]),
        toml(
            "radius in the wrong unit",
            "\"20.047 mm\"",
            "\"20.047 m\"",
            7,
            &["outside", "less than 10000 mm"],
        ),
        toml(
            "ball larger than its pocket",
            "\"6.2 mm\"",
            "\"5.9 mm\"",
            16,
            &["pocket", "5.9555 mm"],
        ),
        toml(
            "pockets that run into each other",
            "\"6.2 mm\"",
            "\"10 mm\"",
            16,
            &["pocket", "9.94976924 mm", "no bar between them"],
        ),
        Case {
            name: "ball larger than the gap",
            text: changed(
                &changed(GOOD, "clearance = { radial = \"-5 um\" }\n", ""),
                "\"5.953 mm\"",
                "\"6.5 mm\"",
            ),
            format: Format::Toml,
            line: Some(13),
            contains: &["larger than the gap", "-1094 um", "diameter"],
        },
        toml(
            "diameter for the nominal ball radius",
            "\"5.953 mm\"",
            "\"11.906 mm\"",
            14,
            &["nominal", "5 %", "5.9555 mm"],
        ),
        toml(
            "groove smaller than the ball",
            "\"6.013 mm\"",
            "\"5.5 mm\"",
            8,
            &["groove radius", "more than 5.9555 mm"],
        ),
        toml(
            "groove far too wide",
            "\"6.013 mm\"",
            "\"60.13 mm\"",
            8,
            &["groove radius", "less than 59.555 mm"],
        ),
        toml(
            "races exchanged",
            "\"31.953 mm\"",
            "\"19 mm\"",
            11,
            &["more than 20.047 mm", "exchanged"],
        ),
        toml("clearance in the wrong unit", "\"-5 um\"", "\"-5 mm\"", 5, &["5 %", "radial"]),
        toml(
            "clearance wider than the gap",
            "\"-5 um\"",
            "\"12 mm\"",
            5,
            &["from -10000 um to 10000 um"],
        ),
        toml(
            "outer groove up to the axis",
            "groove_radius = \"6.310 mm\"",
            "groove_radius = \"31.953 mm\"",
            12,
            &["reaches the bearing axis", "less than the race's own radius, 31.953 mm"],
        ),
        Case {
            name: "no room for a ball",
            text: changed(
                &changed(GOOD, "\"-5 um\"", "\"100 um\""),
                "\"31.953 mm\"",
                "\"20.1 mm\"",
            ),
            format: Format::Toml,
            line: Some(5),
            contains: &["no room", "0.053 mm", "100 um"],
        },
        toml(
            "clearance without saying which",
            "clearance = { radial = \"-5 um\" }",
            "clearance = \"-5 um\"",
            5,
            &["diametral", "radial"],
        ),
        toml(
            "radial and diametral",
            "radial = \"-5 um\"",
            "radial = \"-5 um\", diametral = \"-10 um\"",
            5,
            &["together", "exactly one"],
        ),
        toml(
            "too many balls for the pitch circle",
            "balls = 8",
            "balls = 14",
            4,
            &["do not fit", "up to 13 balls"],
        ),
        toml("too many balls for anything", "balls = 8", "balls = 201", 4, &["from 3 to 200"]),
        toml("two balls", "balls = 8", "balls = 2", 4, &["from 3 to 200", "one or two balls"]),
        toml("half a ball", "balls = 8", "balls = 8.5", 4, &["whole", "from 3 to 200"]),
        toml("balls as text", "balls = 8", "balls = \"8\"", 4, &["whole number", "the text \"8\""]),
        toml(
            "kind misspelt",
            "\"deep-groove\"",
            "\"deep groove\"",
            3,
            &["did you mean `deep-groove`", "angular-contact"],
        ),
        toml("kind missing", "kind = \"deep-groove\"\n", "", 2, &["missing", "kind = "]),
        toml(
            "groove missing",
            "groove_radius = \"6.310 mm\"\n",
            "",
            10,
            &["missing", "conformity"],
        ),
        toml(
            "both groove and conformity",
            "groove_radius = \"6.013 mm\"",
            "groove_radius = \"6.013 mm\"\nconformity = 0.505",
            9,
            &["together", "groove_radius"],
        ),
        toml(
            "load and displacement",
            "load = \"250 N\"",
            "load = \"250 N\", displacement = \"1 um\"",
            18,
            &["together", "inner_race.x.load"],
        ),
        toml(
            "coordinate without load or displacement",
            "x = { load = \"250 N\" }",
            "x = \"250 N\"",
            18,
            &["a table", "load = "],
        ),
        toml(
            "load by another word",
            "x = { load = \"250 N\" }",
            "x = { force = \"250 N\" }",
            18,
            &["unknown key", "did you mean `inner_race.x.load`"],
        ),
        toml(
            "displacement of a tilt",
            "tilt = \"0.15 deg\"",
            "displacement = \"1 um\"",
            19,
            &["unknown key", "Allowed here: moment, tilt"],
        ),
        toml(
            "tilt too large",
            "\"0.15 deg\"",
            "\"0.15 rad\"",
            19,
            &["from -5 deg to 5 deg", "minutes of arc"],
        ),
        toml(
            "displacement too large",
            "load = \"250 N\"",
            "displacement = \"25 mm\"",
            18,
            &["ball radius", "-5.9555 mm"],
        ),
        toml("load too large", "\"250 N\"", "\"-1e4 MN\"", 18, &["from -1e9 N to 1e9 N"]),
        toml(
            "Poisson's ratio of a fluid",
            "poisson_ratio = 0.3",
            "poisson_ratio = 0.5",
            9,
            &["from 0 to less than 0.5"],
        ),
        toml(
            "Poisson's ratio as text",
            "poisson_ratio = 0.3",
            "poisson_ratio = \"0.3\"",
            9,
            &["plain number", "the text"],
        ),
        toml(
            "modulus in Pa as if in GPa",
            "poisson_ratio = 0.3",
            "youngs_modulus = \"210 Pa\"",
            9,
            &["from 0.001 GPa"],
        ),
        toml("unknown plot", "\"polar\"", "\"polr\"", 23, &["did you mean `polar`", "load-zone"]),
        toml("the same plot twice", "\"polar\"", "\"polar\", \"polar\"", 23, &["twice"]),
        toml(
            "centrifugal force without speed",
            "centrifugal = false",
            "centrifugal = true",
            17,
            &["missing", "centrifugal", "rpm"],
        ),
        toml(
            "number for true or false",
            "centrifugal = false",
            "centrifugal = 1",
            21,
            &["true or false", "the number 1"],
        ),
        toml(
            "date",
            "title = \"Table 4.1\"",
            "title = 2024-01-01",
            1,
            &["a text in quotes", "a date"],
        ),
        toml(
            "contact angle of a deep-groove bearing",
            "balls = 8",
            "balls = 8\ncontact_angle = \"35 deg\"",
            5,
            &["emerges", "angular-contact"],
        ),
        toml(
            "bore outside the groove",
            "radius = \"20.047 mm\"",
            "radius = \"20.047 mm\"\nbore_radius = \"30 mm\"",
            8,
            &["less than 20.047 mm", "diameter"],
        ),
        toml(
            "rim inside the groove",
            "radius = \"31.953 mm\"",
            "radius = \"31.953 mm\"\nouter_radius = \"30 mm\"",
            12,
            &["more than 31.953 mm"],
        ),
        toml(
            "cage inside out",
            "pocket_radius = \"6.2 mm\"",
            "inner_radius = \"33 mm\"\nouter_radius = \"29 mm\"",
            16,
            &["less than 29 mm", "exchanged"],
        ),
        toml(
            "pitch circle inside the inner race",
            "balls = 8",
            "balls = 8\npitch_radius = \"52 mm\"",
            5,
            &["between the races", "25.702225 mm to 26.297775 mm"],
        ),
        toml("duplicate key", "balls = 8", "balls = 8\nballs = 9", 5, &["twice"]),
        toml("duplicate table", "[output]", "[bearing]", 22, &["twice"]),
        toml("unclosed quote", "\"5.953 mm\"", "\"5.953 mm", 14, &["not valid TOML", "quote"]),
        toml(
            "quantity without quotes",
            "\"5.953 mm\"",
            "5.953 mm",
            14,
            &["not valid TOML", "quotes"],
        ),
        toml("no equals sign", "balls = 8", "balls 8", 4, &["not valid TOML", "key = value"]),
        toml(
            "assumption that is no text",
            "[output]",
            "[assumptions]\nmaterial = 3\n[output]",
            23,
            &["a text in quotes"],
        ),
        toml(
            "sweep of an unknown key",
            "[output]",
            "[sweep]\n\"bearing.clearance.radal\" = [\"5 um\"]\n[output]",
            23,
            &["did you mean `bearing.clearance.radial`"],
        ),
        toml(
            "sweep without unit",
            "[output]",
            "[sweep]\n\"bearing.clearance.radial\" = [\"5 um\", 3]\n[output]",
            23,
            &["no unit", "3 um"],
        ),
        toml(
            "sweep range without count",
            "[output]",
            "[sweep]\n\"bearing.ball_phase\" = \"0 deg .. 45 deg\"\n[output]",
            23,
            &["no number of values", "0 deg .. 45 deg / 91"],
        ),
        toml(
            "sweep of a title",
            "[output]",
            "[sweep]\n\"title\" = [\"a\"]\n[output]",
            23,
            &["cannot be varied"],
        ),
        toml("NUL byte", "Table 4.1", "Table\u{0}4.1", 1, &["NUL", "not a text file"]),
        angular(
            "contact angle missing",
            "contact_angle = \"35 deg\"\n",
            "",
            1,
            &["missing", "contact_angle"],
        ),
        angular(
            "contact angle too steep",
            "\"35 deg\"",
            "\"85 deg\"",
            5,
            &["more than 0 deg to less than 80 deg"],
        ),
        angular(
            "race radius of an angular-contact bearing",
            "balls = 11",
            "balls = 11\ninner_race.radius = \"24 mm\"",
            4,
            &["refused", "follows from pitch radius"],
        ),
        angular(
            "ball wider than the pitch circle",
            "pitch_radius = \"30 mm\"",
            "pitch_radius = \"5 mm\"",
            4,
            &["more than"],
        ),
        angular(
            "interference beyond the contact angle",
            "inner_race.groove_radius = \"6.6 mm\"\nouter_race.groove_radius = \"6.6 mm\"",
            "inner_race.conformity = 0.505\nouter_race.conformity = 0.505\nclearance.radial = \"-150 um\"",
            9,
            &["contact angle", "more than -97"],
        ),
        json(
            "JSON trailing comma",
            "{\n  \"bearing\": {\n    \"balls\": 8,\n  }\n}\n",
            3,
            &["not valid JSON", "comma"],
        ),
        json(
            "JSON comment",
            "{\n  // note\n  \"bearing\": {}\n}\n",
            2,
            &["not valid JSON", "comment"],
        ),
        json(
            "JSON wrong type",
            "{\n  \"bearing\": {\n    \"kind\": 3\n  }\n}\n",
            3,
            &["one of \"deep-groove\"", "the number 3"],
        ),
        json("JSON null", "{\n  \"bearing\": {\n    \"kind\": null\n  }\n}\n", 3, &["found null"]),
        json(
            "JSON duplicate key",
            "{\n  \"title\": \"a\",\n  \"title\": \"b\"\n}\n",
            3,
            &["twice"],
        ),
        json("JSON list as scene", "[1, 2]\n", 1, &["a scene is a table", "a list"]),
        json(
            "JSON leading zero",
            "{\n  \"bearing\": {\n    \"balls\": 08\n  }\n}\n",
            3,
            &["not valid JSON"],
        ),
        json(
            "JSON cut off",
            "{\n  \"bearing\": {\n    \"balls\": 8",
            2,
            &["not valid JSON", "bracket"],
        ),
        json(
            "JSON NaN",
            "{\n  \"bearing\": {\n    \"balls\": NaN\n  }\n}\n",
            3,
            &["not valid JSON", "numbers are decimal"],
        ),
        json("JSON unknown key", "{\n  \"bering\": {}\n}\n", 2, &["did you mean `bearing`"]),
        json(
            "JSON text in quotes of the other kind",
            "{\n  'bearing': {}\n}\n",
            2,
            &["double quotes"],
        ),
        Case {
            name: "deep nesting",
            text: format!("a = {}", "[".repeat(100)),
            format: Format::Toml,
            line: Some(1),
            contains: &["deeper than 64", "unclosed"],
        },
        Case {
            name: "deep nesting by dots",
            text: format!("a{} = 1", ".a".repeat(100)),
            format: Format::Toml,
            line: Some(1),
            contains: &["deeper than 64"],
        },
        Case {
            name: "JSON deep nesting",
            text: "{\"a\":".repeat(100),
            format: Format::Json,
            line: Some(1),
            contains: &["deeper than 64"],
        },
        Case {
            name: "empty scene",
            text: String::new(),
            format: Format::Toml,
            line: None,
            contains: &["empty", "[bearing]"],
        },
        Case {
            name: "only white space",
            text: " \n\t\n".to_string(),
            format: Format::Json,
            line: None,
            contains: &["empty"],
        },
        Case {
            name: "no bearing",
            text: "title = \"nothing\"\n".to_string(),
            format: Format::Toml,
            line: None,
            contains: &["bearing.kind", "missing"],
        },
    ]
}

fn file_name(format: Format) -> &'static str {
    match format {
        Format::Toml => "scene.toml",
        Format::Json => "scene.json",
    }
}

/// What the message lacks, if anything.
fn fault(message: &str, file: &str, line: Option<usize>, contains: &[&str]) -> Option<String> {
    let place = match line {
        Some(line) => format!("{file}:{line}:"),
        None => format!("{file}: "),
    };
    if !message.starts_with(&place) {
        return Some(format!("does not begin with {place}"));
    }
    if let Some(part) = contains.iter().find(|part| !message.contains(**part)) {
        return Some(format!("does not contain {part:?}"));
    }
    if !message.contains("Hint: ") && !message.contains("Allowed: ") {
        return Some("has neither range nor hint".to_string());
    }
    if message.contains('\n') || message.len() > 500 {
        return Some("is not one short line".to_string());
    }
    None
}

#[test]
fn the_scene_that_the_cases_change_is_correct() {
    scene::read_str(GOOD, Format::Toml, "good").unwrap();
    scene::read_str(ANGULAR, Format::Toml, "good").unwrap();
}

#[test]
fn every_malformed_scene_has_one_clear_message() {
    let mut all = String::new();
    let mut faults = Vec::new();
    let mut record = |name: &str, message: &str, shown: &str, fault: Option<String>| {
        faults.extend(fault.map(|fault| format!("{name}: {message}\n    {fault}")));
        writeln!(all, "{name}\n    {shown}\n").unwrap();
    };
    for case in cases() {
        let file = file_name(case.format);
        let message = match scene::read_str(&case.text, case.format, file) {
            Ok(_) => "accepted".to_string(),
            Err(error) => error.to_string(),
        };
        record(case.name, &message, &message, fault(&message, file, case.line, case.contains));
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, path, line, contains) in files(folder.path()) {
        let message = scene::read_file(&path).unwrap_err().to_string();
        let shown = message.replace(&folder.path().display().to_string(), "FOLDER");
        let fault = fault(&message, &path.display().to_string(), line, contains);
        record(name, &message, &shown, fault);
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    insta::assert_snapshot!("messages", all);
}

type FileCase = (&'static str, PathBuf, Option<usize>, &'static [&'static str]);

/// Things that are no scene before their text is looked at.
fn files(folder: &Path) -> Vec<FileCase> {
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let mut latin1 = GOOD.replacen("balls", "# K\u{e4}fig\nballs", 1).into_bytes();
    let at = latin1.iter().position(|&b| b == 0xc3).unwrap();
    latin1.splice(at..at + 2, [0xe4]);
    let utf16: Vec<u8> =
        "\u{feff}balls = 8".encode_utf16().flat_map(|unit| unit.to_le_bytes()).collect();
    vec![
        ("missing file", folder.join("none.toml"), None, &["no such file", "path"]),
        ("folder as file", folder.to_path_buf(), None, &["folder", ".toml or .json"]),
        ("unknown ending", write("scene.yaml", b"a: 1"), None, &[".toml or .json"]),
        ("empty file", write("empty.toml", b""), None, &["empty"]),
        ("100 MB of braces", braces(folder), None, &["104857600 bytes", "16777216 bytes"]),
        ("not UTF-8", write("latin1.toml", &latin1), Some(4), &["not UTF-8", "save"]),
        ("UTF-16", write("utf16.toml", &utf16), Some(1), &["UTF-16"]),
        ("binary", write("binary.toml", b"a = 1\n\0\0\0"), Some(2), &["NUL"]),
        (
            "16 MB of braces",
            write("many.json", &b"{".repeat(16 << 20)),
            Some(1),
            &["deeper than 64"],
        ),
    ]
}

/// 100 MB of braces: a few at the start, then a hole, which takes no time to write.
fn braces(folder: &Path) -> PathBuf {
    let path = folder.join("braces.json");
    let mut file = std::fs::File::create(&path).unwrap();
    file.write_all(&b"{".repeat(1 << 16)).unwrap();
    file.seek(SeekFrom::Start((100 << 20) - (1 << 16))).unwrap();
    file.write_all(&b"{".repeat(1 << 16)).unwrap();
    path
}

#[test]
fn a_huge_file_is_refused_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = braces(folder.path());
    // Only who asks the file system knows the size: read as text, the file would be refused for
    // its first 64 braces.
    let message = scene::read_file(&path).unwrap_err().to_string();
    assert!(message.contains(&format!("{} bytes", 100 << 20)), "{message}");
}

#[test]
fn the_same_text_gives_the_same_message() {
    let two_faults = GOOD.replacen("balls = 8", "balls = 0\nbals = 3", 1);
    let message = || scene::read_str(&two_faults, Format::Toml, "a").unwrap_err().to_string();
    assert!(message().starts_with("a:4:9: bearing.balls"), "{}", message());
    assert_eq!(message(), message());
}

#[test]
fn columns_count_characters_and_lines_end_at_newlines() {
    let text = "{\r\n\"title\": \"\u{e4}\u{20ac}\u{1F980}\", \"bearing\": 3}";
    let error = Document::read_str(text, Format::Json, "a.json").unwrap_err();
    let before = "\"title\": \"xxx\", \"bearing\": ";
    assert_eq!(error.place.line_and_column, Some((2, before.len() + 1)));
}
