//! Reading and writing of NumPy `.npy` files of real numbers. The reader allocates no more memory than the file holds,
//! whatever its header claims.
//!
//! Not a crate: the available one allocates the claimed header length before reading it and recurses without limit into its
//! brackets.

use ndarray::{Array2, ShapeBuilder};
use thiserror::Error;

/// Length limit of a header, bytes; the same as in NumPy.
const LONGEST_HEADER: usize = 10_000;

/// Largest number of columns. A run of 200 balls that records everything has about 3000.
pub const MOST_COLUMNS: usize = 20_000;

#[derive(Clone, Debug, Error, PartialEq)]
pub enum NpyError {
    #[error("it is not a .npy file")]
    Magic,
    #[error("format version {major}.{minor} is not supported; use 1.0, 2.0 or 3.0")]
    Version { major: u8, minor: u8 },
    #[error(
        "its header claims {claimed} bytes; {left} follow, and at most {LONGEST_HEADER} are supported"
    )]
    HeaderLength { claimed: usize, left: usize },
    #[error("its header is damaged at byte {at}: expected {expected}")]
    Header { at: usize, expected: &'static str },
    #[error("its numbers have type {descr:?}; supported are <f8, <f4, >f8 and >f4")]
    Type { descr: String },
    #[error("it has {dimensions} dimensions; a table has one or two")]
    Dimensions { dimensions: usize },
    #[error("it has {columns} columns; at most {MOST_COLUMNS} are supported")]
    Columns { columns: usize },
    #[error("{rows} rows and {columns} columns do not match the {bytes} bytes of data")]
    Length { rows: usize, columns: usize, bytes: usize },
}

/// Alignment of the data, bytes, for memory mapping.
const ALIGNED: usize = 64;

/// Content of a `.npy` file: version 1.0, little-endian f64, row by row.
///
/// ```
/// use bearing_dynamics::output::npy;
/// let table = ndarray::array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
/// let file = npy::file(&table);
/// assert_eq!(file.len(), 128 + 6 * 8);
/// assert_eq!(npy::parse(&file).unwrap(), table);
/// ```
pub fn file(table: &Array2<f64>) -> Vec<u8> {
    let (rows, columns) = table.dim();
    let header =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    let start = b"\x93NUMPY\x01\x00";
    let before = start.len() + size_of::<u16>();
    // The header is padded with blanks and ends with a line break.
    let length = (before + header.len() + 1).next_multiple_of(ALIGNED) - before;
    let mut bytes = Vec::with_capacity(before + length + 8 * table.len());
    bytes.extend_from_slice(start);
    // The shape has two numbers of at most twenty digits, so the length fits into u16.
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(format!("{header:<0$}\n", length - 1).bytes());
    for value in table {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    bytes
}

/// Parses a table of one (then a column) or two dimensions, f64 or f32, in either memory order.
///
/// # Errors
/// [`NpyError`].
pub fn parse(bytes: &[u8]) -> Result<Array2<f64>, NpyError> {
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or(NpyError::Magic)?;
    let ([major, minor], rest) = rest.split_first_chunk().ok_or(NpyError::Magic)?;
    let (claimed, rest) = match major {
        1 => rest.split_first_chunk().map(|(n, rest)| (usize::from(u16::from_le_bytes(*n)), rest)),
        2 | 3 => rest.split_first_chunk().map(|(n, rest)| (u32::from_le_bytes(*n) as usize, rest)),
        _ => return Err(NpyError::Version { major: *major, minor: *minor }),
    }
    .ok_or(NpyError::Magic)?;
    if claimed > LONGEST_HEADER || claimed > rest.len() {
        return Err(NpyError::HeaderLength { claimed, left: rest.len() });
    }
    let (header, data) = rest.split_at(claimed);
    let Header { descr, fortran_order, shape } = Reader { text: header, at: 0 }.header()?;
    let [rows, columns] = match shape[..] {
        [rows] => [rows, 1],
        [rows, columns] => [rows, columns],
        _ => return Err(NpyError::Dimensions { dimensions: shape.len() }),
    };
    if columns > MOST_COLUMNS {
        return Err(NpyError::Columns { columns });
    }
    let (size, number): (usize, fn(&[u8]) -> f64) = match descr.as_str() {
        "<f8" => (8, |b| f64::from_le_bytes(fixed(b))),
        ">f8" => (8, |b| f64::from_be_bytes(fixed(b))),
        "<f4" => (4, |b| f64::from(f32::from_le_bytes(fixed(b)))),
        ">f4" => (4, |b| f64::from(f32::from_be_bytes(fixed(b)))),
        _ => return Err(NpyError::Type { descr }),
    };
    let wanted = rows.checked_mul(columns).and_then(|count| count.checked_mul(size));
    let wrong = NpyError::Length { rows, columns, bytes: data.len() };
    if wanted != Some(data.len()) {
        return Err(wrong);
    }
    let values = data.chunks_exact(size).map(number).collect();
    Array2::from_shape_vec((rows, columns).set_f(fortran_order), values).map_err(|_| wrong)
}

/// Chunk of N bytes as an array.
fn fixed<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes[i])
}

struct Header {
    descr: String,
    fortran_order: bool,
    shape: Vec<usize>,
}

/// Parser of a header: a Python dictionary of three entries in any order.
struct Reader<'t> {
    text: &'t [u8],
    at: usize,
}

impl Reader<'_> {
    fn header(mut self) -> Result<Header, NpyError> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        self.expect(b'{', "{")?;
        while !self.take(b'}') {
            let key = self.string()?;
            self.expect(b':', ":")?;
            match key.as_str() {
                "descr" if descr.is_none() => descr = Some(self.string()?),
                "fortran_order" if fortran_order.is_none() => fortran_order = Some(self.boolean()?),
                "shape" if shape.is_none() => shape = Some(self.tuple()?),
                _ => return Err(self.wrong("one each of descr, fortran_order and shape")),
            }
            if !self.take(b',') {
                self.expect(b'}', "} or a comma")?;
                break;
            }
        }
        self.blanks();
        match (descr, fortran_order, shape) {
            (Some(descr), Some(fortran_order), Some(shape)) if self.at == self.text.len() => {
                Ok(Header { descr, fortran_order, shape })
            }
            _ => Err(self.wrong("one each of descr, fortran_order and shape, and no more")),
        }
    }

    fn wrong(&self, expected: &'static str) -> NpyError {
        NpyError::Header { at: self.at, expected }
    }

    fn blanks(&mut self) {
        self.at += self.text[self.at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// Skips this byte if it comes next.
    fn take(&mut self, byte: u8) -> bool {
        self.blanks();
        let found = self.text.get(self.at) == Some(&byte);
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, byte: u8, name: &'static str) -> Result<(), NpyError> {
        if self.take(byte) { Ok(()) } else { Err(self.wrong(name)) }
    }

    /// Parses a string without escapes: neither names nor types have any.
    fn string(&mut self) -> Result<String, NpyError> {
        self.blanks();
        let quote = match self.text.get(self.at) {
            Some(quote @ (b'\'' | b'"')) => *quote,
            // A list of types: a table of named fields.
            Some(b'[') => return Err(self.wrong("one type for all numbers")),
            _ => return Err(self.wrong("a string")),
        };
        let inside = &self.text[self.at + 1..];
        let length = inside.iter().position(|&byte| byte == quote);
        let inside = &inside[..length.ok_or_else(|| self.wrong("a string with an end"))?];
        self.at += inside.len() + 2;
        Ok(String::from_utf8_lossy(inside).into_owned())
    }

    fn boolean(&mut self) -> Result<bool, NpyError> {
        self.blanks();
        for (word, value) in [("True", true), ("False", false)] {
            if self.text[self.at..].starts_with(word.as_bytes()) {
                self.at += word.len();
                return Ok(value);
            }
        }
        Err(self.wrong("True or False"))
    }

    fn tuple(&mut self) -> Result<Vec<usize>, NpyError> {
        let mut numbers = Vec::new();
        self.expect(b'(', "(")?;
        while !self.take(b')') {
            self.blanks();
            let rest = &self.text[self.at..];
            let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
            let number = std::str::from_utf8(&rest[..digits]).ok().and_then(|n| n.parse().ok());
            numbers.push(number.ok_or_else(|| self.wrong("a whole number of rows or columns"))?);
            self.at += digits;
            if !self.take(b',') {
                self.expect(b')', ") or a comma")?;
                break;
            }
        }
        Ok(numbers)
    }
}
