//! Bytes of a file, read as lines, words or binary numbers, with positions for messages.

use crate::mesh::read::error::{Place, Problem, ReadError};
use std::cell::OnceCell;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    Text,
    Little,
    Big,
}

pub struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    pub coding: Coding,
    /// Positions of line ends, found for the first message.
    line_ends: OnceCell<Vec<usize>>,
}

/// Start of a text from a file, short enough for a one-line message.
pub fn excerpt(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    String::from_utf8_lossy(&bytes[..bytes.len().min(LONGEST)]).into_owned()
}

/// A text of a file: UTF-8, else Latin-1, as some programs write names.
pub fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_string(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Mark of UTF-8 at the start of a file, which is passed over.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

pub fn count_of(what: &str) -> &'static str {
    match what {
        "nodes" => "a count of nodes (a whole number, 0 or more)",
        _ => "a count of elements (a whole number, 0 or more)",
    }
}

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8]) -> Source<'a> {
        let at = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        Source { bytes, at, coding: Coding::Text, line_ends: OnceCell::new() }
    }

    /// The same file from another position.
    pub fn from(&self, at: usize) -> Source<'a> {
        Source { at, coding: self.coding, ..Source::new(self.bytes) }
    }

    pub fn position(&self) -> usize {
        self.at
    }

    pub fn length(&self) -> usize {
        self.bytes.len()
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Position of byte `at`, for messages.
    pub fn place(&self, at: usize) -> Place {
        match self.coding {
            Coding::Text => {
                let ends = self.line_ends.get_or_init(|| {
                    (0..self.bytes.len()).filter(|&at| self.bytes[at] == b'\n').collect()
                });
                Place::Line(1 + ends.partition_point(|&end| end < at))
            }
            _ => Place::Byte(at),
        }
    }

    pub fn error_at(&self, at: usize, problem: Problem) -> ReadError {
        ReadError { place: self.place(at), problem }
    }

    pub fn error(&self, problem: Problem) -> ReadError {
        self.error_at(self.at, problem)
    }

    /// The next line without its end; `None` at the end of the file.
    pub fn line(&mut self) -> Option<&'a [u8]> {
        if self.at >= self.bytes.len() {
            return None;
        }
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        Some(rest[..length].trim_ascii())
    }

    /// The next line that is not blank.
    pub fn full_line(&mut self) -> Option<&'a [u8]> {
        loop {
            let line = self.line()?;
            if !line.is_empty() {
                return Some(line);
            }
        }
    }

    fn word(&mut self, what: &str) -> Result<(usize, &'a [u8]), ReadError> {
        let rest = &self.bytes[self.at..];
        let blank = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let length = rest[blank..].iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
        if length == 0 {
            return Err(self.error(Problem::Truncated { what: what.to_string() }));
        }
        let start = self.at + blank;
        self.at = start + length;
        Ok((start, &self.bytes[start..self.at]))
    }

    pub fn text_number<T: std::str::FromStr>(
        &mut self,
        what: &'static str,
    ) -> Result<T, ReadError> {
        let (start, word) = self.word(what)?;
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or_else(|| self.error_at(start, Problem::Number { found: excerpt(word), what }))
    }

    fn raw<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], ReadError> {
        let Some(bytes) = self.bytes[self.at..].first_chunk::<N>() else {
            return Err(self.error(Problem::Truncated { what: what.to_string() }));
        };
        self.at += N;
        let mut bytes = *bytes;
        if self.coding == Coding::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Reads a four-byte integer, or a word.
    pub fn int(&mut self, what: &'static str) -> Result<i64, ReadError> {
        match self.coding {
            Coding::Text => self.text_number(what),
            _ => Ok(i64::from(i32::from_le_bytes(self.raw(what)?))),
        }
    }

    /// Reads an unsigned eight-byte integer, or a word.
    pub fn size(&mut self, what: &'static str) -> Result<u64, ReadError> {
        match self.coding {
            Coding::Text => self.text_number(what),
            _ => Ok(u64::from_le_bytes(self.raw(what)?)),
        }
    }

    /// Reads a finite eight-byte number, or a word.
    pub fn double(&mut self, what: &'static str) -> Result<f64, ReadError> {
        let start = self.at;
        let number: f64 = match self.coding {
            Coding::Text => self.text_number(what)?,
            _ => f64::from_le_bytes(self.raw(what)?),
        };
        if number.is_finite() {
            return Ok(number);
        }
        Err(self.error_at(start, Problem::Number { found: number.to_string(), what }))
    }

    /// Refuses a count of entries of at least `least` bytes each that exceeds the remaining bytes.
    pub fn expect_room(
        &self,
        what: &'static str,
        claimed: u64,
        least: u64,
    ) -> Result<(), ReadError> {
        let left = self.left();
        // The last number of a text needs no blank after it.
        if claimed.saturating_mul(least) <= left as u64 + 1 {
            return Ok(());
        }
        Err(self.error(Problem::Count { what, claimed, left }))
    }

    /// Skips to the end of the next line that starts with `marker`.
    pub fn skip_behind(&mut self, marker: &[u8]) -> Result<(), ReadError> {
        let start = self.at;
        let found = self.bytes[start..].windows(marker.len()).position(|bytes| bytes == marker);
        match found {
            Some(offset) => {
                self.at = start + offset;
                self.line();
                Ok(())
            }
            None => {
                let what =
                    format!("a section that should end with {}", excerpt(marker.trim_ascii()));
                Err(self.error(Problem::Truncated { what }))
            }
        }
    }
}
