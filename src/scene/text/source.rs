//! The text of a scene: reading, early checks and positions.

use crate::scene::error::{Place, Problem, SceneError};
use crate::scene::text::input_file;
use crate::scene::text::input_file::InputError;
use std::path::Path;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Toml,
    Json,
}

/// Size limit of a scene file, bytes; larger files are refused unread.
pub const LARGEST_FILE: u64 = 16 << 20;

/// Nesting limit of tables and lists. Checked before parsing, so that no parser can overflow the stack.
pub const DEEPEST_NESTING: usize = 64;

#[derive(Clone, Debug)]
pub struct Source {
    pub name: String,
    pub text: String,
    /// Base of the scene; its offsets continue at the end of this text.
    pub base: Option<Arc<Source>>,
    /// True if a scene names this file, its base, by an absolute path.
    pub is_fixed: bool,
}

impl Source {
    /// Offset at which a base begins.
    pub fn length(&self) -> usize {
        self.text.len() + 1
    }

    /// Line and column, counted in characters from 1, of a byte offset.
    pub fn place(&self, offset: usize) -> Place {
        if let Some(base) = self.base.as_ref().filter(|_| offset >= self.length()) {
            return base.place(offset - self.length());
        }
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let before = &self.text[..offset];
        let line = before.bytes().filter(|&b| b == b'\n').count() + 1;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let column = before[line_start..].chars().count() + 1;
        Place { file: self.name.clone(), line_and_column: Some((line, column)) }
    }

    pub fn error(&self, offset: usize, key: &str, problem: Problem) -> SceneError {
        SceneError::new(self.place(offset), key, problem)
    }
}

/// Reads a scene file; the format follows from its name.
pub fn read(path: &Path) -> Result<(Source, Format), SceneError> {
    let name = path.display().to_string();
    let fail = |problem| SceneError::new(Place::file(&name), "", problem);
    let bytes = input_file::read(path, LARGEST_FILE).map_err(|error| {
        fail(match error {
            error if error.is_missing() => Problem::NoSuchFile,
            InputError::Io(error) => Problem::Unreadable { reason: error.to_string() },
            InputError::Folder => Problem::IsFolder,
            InputError::NotRegular => Problem::NotRegularFile,
            InputError::TooLarge { bytes, limit } => Problem::TooLarge { bytes, limit },
        })
    })?;
    let format = format_of(path).ok_or_else(|| fail(Problem::UnknownFormat))?;
    Ok((decode(name, bytes)?, format))
}

fn format_of(path: &Path) -> Option<Format> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "toml" => Some(Format::Toml),
        "json" => Some(Format::Json),
        _ => None,
    }
}

pub fn decode(name: String, bytes: Vec<u8>) -> Result<Source, SceneError> {
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Source { name, text, base: None, is_fixed: false }),
        Err(error) => {
            let valid = error.utf8_error().valid_up_to();
            let bytes = error.into_bytes();
            let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
            let text = String::from_utf8_lossy(&bytes[..valid]).into_owned();
            let source = Source { name, text, base: None, is_fixed: false };
            Err(source.error(valid, "", Problem::NotUtf8 { utf16 }))
        }
    }
}

/// Refuses texts that are too large, empty, binary or nested too deeply, and removes a byte-order mark.
pub fn check(mut source: Source, format: Format) -> Result<Source, SceneError> {
    let bytes = source.text.len() as u64;
    if bytes > LARGEST_FILE {
        let problem = Problem::TooLarge { bytes, limit: LARGEST_FILE };
        return Err(SceneError::new(Place::file(&source.name), "", problem));
    }
    if source.text.starts_with('\u{feff}') {
        source.text.drain(..'\u{feff}'.len_utf8());
    }
    if source.text.trim().is_empty() {
        return Err(SceneError::new(Place::file(&source.name), "", Problem::Empty));
    }
    if let Some(offset) = source.text.find('\0') {
        return Err(source.error(offset, "", Problem::NulByte));
    }
    if let Some(offset) = too_deep(&source.text, format) {
        return Err(source.error(offset, "", Problem::TooDeep { limit: DEEPEST_NESTING }));
    }
    Ok(source)
}

/// Offset at which brackets, or the parts of a dotted TOML key, first exceed [`DEEPEST_NESTING`].
///
/// A linear scan that skips strings and comments. In a malformed text it may find strings where the
/// parser does not; the parsers' own limits, far below the stack size, then apply.
fn too_deep(text: &str, format: Format) -> Option<usize> {
    let bytes = text.as_bytes();
    let toml = format == Format::Toml;
    let mut depth = 0_usize;
    let mut dots = 0;
    let mut at = 0;
    while at < bytes.len() {
        match bytes[at] {
            b'"' => at = string_end(bytes, at, b'"', toml, true),
            b'\'' if toml => at = string_end(bytes, at, b'\'', toml, false),
            b'#' if toml => {
                at += bytes[at..].iter().position(|&b| b == b'\n').unwrap_or(bytes.len() - at);
                dots = 0;
                continue;
            }
            b'[' | b'{' => {
                depth += 1;
                dots = 0;
            }
            b']' | b'}' => depth = depth.saturating_sub(1),
            b'.' if toml => dots += 1,
            b',' | b'=' | b'\n' => dots = 0,
            _ => {}
        }
        if depth > DEEPEST_NESTING || dots > DEEPEST_NESTING {
            return Some(at);
        }
        at += 1;
    }
    None
}

/// Position of the last byte of the string that opens at `start`.
fn string_end(bytes: &[u8], start: usize, quote: u8, multiline: bool, escapes: bool) -> usize {
    let triple = multiline && bytes[start..].starts_with(&[quote; 3]);
    let mut at = start + if triple { 3 } else { 1 };
    while at < bytes.len() {
        match bytes[at] {
            b'\\' if escapes => at += 1,
            b'\n' if !triple => return at - 1,
            b if b == quote && !triple => return at,
            b if b == quote && bytes[at..].starts_with(&[quote; 3]) => return at + 2,
            _ => {}
        }
        at += 1;
    }
    bytes.len() - 1
}
