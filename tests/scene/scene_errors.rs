//! Files that are no scene, and scenes in JSON that are refused: one message each. Other bad scenes are in `tests/data/bad`.

use bearing_dynamics::scene::{self, Document, Format};
use std::io::{Seek, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

/// Text in JSON, line, and a part of the message.
const JSON: [(&str, usize, &str); 11] = [
    ("{\n  \"bearing\": {\n    \"balls\": 8,\n  }\n}\n", 3, "comma"),
    ("{\n  // note\n  \"bearing\": {}\n}\n", 2, "comment"),
    ("{\n  \"bearing\": {\n    \"kind\": 3\n  }\n}\n", 3, "the number 3"),
    ("{\n  \"bearing\": {\n    \"kind\": null\n  }\n}\n", 3, "null"),
    ("{\n  \"title\": \"a\",\n  \"title\": \"b\"\n}\n", 3, "twice"),
    ("[1, 2]\n", 1, "a list"),
    ("{\n  \"bearing\": {\n    \"balls\": 08\n  }\n}\n", 3, "not valid JSON"),
    ("{\n  \"bearing\": {\n    \"balls\": 8", 2, "bracket"),
    ("{\n  \"bearing\": {\n    \"balls\": NaN\n  }\n}\n", 3, "not valid JSON"),
    ("{\n  \"bering\": {}\n}\n", 2, "did you mean `bearing`"),
    ("{\n  'bearing': {}\n}\n", 2, "double quotes"),
];

#[test]
fn scenes_in_json_that_are_refused_have_one_clear_message() {
    let nested = "{\"a\":".repeat(100);
    for (text, line, part) in JSON.into_iter().chain([(nested.as_str(), 1, "64")]) {
        let message = scene::read_str(text, Format::Json, "a.json").unwrap_err().to_string();
        let place = format!("a.json:{line}:");
        assert!(message.starts_with(&place) && message.contains(part), "{text}: {message}");
        assert!(!message.contains('\n') && message.len() <= 500, "{message}");
    }
}

#[test]
fn files_that_are_no_scene_have_one_clear_message() {
    let folder = tempfile::tempdir().unwrap();
    for (path, line, parts) in files(folder.path()) {
        let message = scene::read_file(&path).unwrap_err().to_string();
        let path = path.display();
        let place = line.map_or(format!("{path}: "), |line: usize| format!("{path}:{line}:"));
        assert!(message.starts_with(&place), "{message}");
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        assert!(!message.contains('\n') && message.len() <= 500, "{message}");
    }
}

type FileCase = (PathBuf, Option<usize>, &'static [&'static str]);

/// Files that are refused before or while their text is read.
fn files(folder: &Path) -> Vec<FileCase> {
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let mut latin1 = "[bearing]\n\n\n# K\u{e4}fig\nballs = 8\n".to_string().into_bytes();
    let at = latin1.iter().position(|&b| b == 0xc3).unwrap();
    latin1.splice(at..at + 2, [0xe4]);
    let utf16: Vec<u8> =
        "\u{feff}balls = 8".encode_utf16().flat_map(|unit| unit.to_le_bytes()).collect();
    vec![
        (folder.join("none.toml"), None, &["no such file", "path"]),
        (folder.to_path_buf(), None, &["folder", ".toml or .json"]),
        (write("scene.yaml", b"a: 1"), None, &[".toml or .json"]),
        (write("empty.toml", b""), None, &["empty"]),
        (write("blank.json", b" \n\t\n"), None, &["empty"]),
        (braces(folder), None, &["104857600 bytes", "16777216 bytes"]),
        (write("latin1.toml", &latin1), Some(4), &["not valid UTF-8", "save"]),
        (write("utf16.toml", &utf16), Some(1), &["UTF-16"]),
        (write("binary.toml", b"a = 1\n\0\0\0"), Some(2), &["NUL"]),
        (write("many.json", &b"{".repeat(16 << 20)), Some(1), &["deeper than 64"]),
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
    let two_faults = "[bearing]\nkind = \"deep-groove\"\nballs = 0\nbals = 3\n";
    let message = || scene::read_str(two_faults, Format::Toml, "a").unwrap_err().to_string();
    assert!(message().starts_with("a:3:9: bearing.balls"), "{}", message());
    assert_eq!(message(), message());
}

#[test]
fn columns_count_characters_and_lines_end_at_newlines() {
    let text = "{\r\n\"title\": \"\u{e4}\u{20ac}\u{1F980}\", \"bearing\": 3}";
    let error = Document::read_str(text, Format::Json, "a.json").unwrap_err();
    let before = "\"title\": \"xxx\", \"bearing\": ";
    assert_eq!(error.place.line_and_column, Some((2, before.len() + 1)));
}
