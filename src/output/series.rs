//! Tables of numbers with named columns and units: time series, one row per ball, one row per sweep point.
//!
//! Two files hold the same numbers bit for bit: `NAME.csv` (header `azimuth [deg]`, shortest
//! decimal that reads back to the same bits) and `NAME.npy` (rows × columns, little-endian f64)
//! with its column names in `NAME.columns.json`, a list of `{"name", "unit"}`.

use crate::output::atomic::{WriteError, write_atomic};
use crate::output::npy::{self, MOST_COLUMNS, NpyError};
use crate::scene::text::input_file;
use crate::scene::text::input_file::{InputError, LARGEST_DATA, LARGEST_JSON};
use ndarray::Array2;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Name and unit of one column; the unit is `1` for a dimensionless column and empty when unknown.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Column {
    pub name: String,
    pub unit: String,
}

impl Column {
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Column { name: name.into(), unit: unit.into() }
    }

    /// `name [unit]`, or the bare name when the unit is unknown.
    pub fn header(&self) -> String {
        if self.unit.is_empty() {
            self.name.clone()
        } else {
            format!("{} [{}]", self.name, self.unit)
        }
    }

    /// The inverse of [`Column::header`].
    pub fn from_header(header: &str) -> Self {
        let header = header.trim();
        match header.strip_suffix(']').and_then(|open| open.rsplit_once('[')) {
            Some((name, unit)) => Column::new(name.trim_end(), unit.trim()),
            None => Column::new(header, ""),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    columns: Vec<Column>,
    data: Array2<f64>,
}

#[derive(Debug, Error)]
pub enum SeriesError {
    #[error("{columns} column names for a table of {width} columns")]
    ColumnCount { columns: usize, width: usize },
    #[error("{columns} columns; at most {MOST_COLUMNS} are supported")]
    Columns { columns: usize },
    #[error("column name {name:?}: {reason}")]
    ColumnName { name: String, reason: &'static str },
    #[error("row {row} of column {column:?} is {value}; only finite numbers are written")]
    NotFinite { row: usize, column: String, value: f64 },
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: InputError },
    #[error("{} is not a CSV table: {source}", path.display())]
    Csv { path: PathBuf, source: csv::Error },
    #[error("{} line {line}, column {column:?}: {text:?} is not a number", path.display())]
    Number { path: PathBuf, line: u64, column: String, text: String },
    #[error("{} is not a NumPy table of real numbers: {source}", path.display())]
    Npy { path: PathBuf, source: NpyError },
    #[error("{} is not a list of column names and units: {source}", path.display())]
    ColumnsFile { path: PathBuf, source: serde_json::Error },
    #[error("{}: {reason}", path.display())]
    Table { path: PathBuf, reason: Box<SeriesError> },
}

impl Series {
    /// # Errors
    /// Names that do not match the data: their number, an empty or repeated name, a name or
    /// unit with brackets, a line break or outer spaces (the CSV header could not be read back).
    pub fn new(columns: Vec<Column>, data: Array2<f64>) -> Result<Self, SeriesError> {
        if columns.len() != data.ncols() {
            return Err(SeriesError::ColumnCount { columns: columns.len(), width: data.ncols() });
        }
        if columns.len() > MOST_COLUMNS {
            return Err(SeriesError::Columns { columns: columns.len() });
        }
        let mut names = HashSet::new();
        for column in &columns {
            let refused = |reason| SeriesError::ColumnName { name: column.name.clone(), reason };
            if column.name.is_empty() {
                return Err(refused("a name is required"));
            }
            for text in [&column.name, &column.unit] {
                if text.contains(['[', ']', '\n', '\r']) || text.trim() != text {
                    return Err(refused(
                        "name and unit have no brackets, line breaks or outer spaces",
                    ));
                }
            }
            if !names.insert(column.name.as_str()) {
                return Err(refused("the name is used twice"));
            }
        }
        Ok(Series { columns, data })
    }

    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    pub fn data(&self) -> &Array2<f64> {
        &self.data
    }

    /// Values of a column, or `None` if there is no column with this name.
    pub fn column(&self, name: &str) -> Option<ndarray::ArrayView1<'_, f64>> {
        let index = self.columns.iter().position(|column| column.name == name)?;
        Some(self.data.column(index))
    }

    /// # Errors
    /// The first value that is NaN or infinite.
    pub fn check_finite(&self) -> Result<(), SeriesError> {
        for ((row, column), &value) in self.data.indexed_iter() {
            if !value.is_finite() {
                let column = self.columns[column].name.clone();
                return Err(SeriesError::NotFinite { row, column, value });
            }
        }
        Ok(())
    }

    /// CSV text; every number reads back to the same bits.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn to_csv(&self) -> Result<String, SeriesError> {
        self.check_finite()?;
        let mut text = csv_line(self.columns.iter().map(|column| csv_field(&column.header())));
        for row in self.data.rows() {
            // {:?} is the shortest decimal that reads back to the same bits, with an exponent
            // if the plain form would be long.
            text += &csv_line(row.iter().map(|value| format!("{value:?}")));
        }
        Ok(text)
    }

    /// # Errors
    /// A value that is not finite (nothing is written), or a file that cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), SeriesError> {
        Ok(write_atomic(path, self.to_csv()?.as_bytes())?)
    }

    /// Reads a CSV table. Values that are not finite (`NaN`, `inf`) are kept, so that a
    /// comparison can point at them.
    pub fn read_csv(path: &Path) -> Result<Self, SeriesError> {
        let bytes = read(path)?;
        let csv_error = |source| SeriesError::Csv { path: path.to_path_buf(), source };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(&bytes[..]);
        let columns: Vec<Column> =
            reader.headers().map_err(csv_error)?.iter().map(Column::from_header).collect();
        let mut values = Vec::new();
        let mut rows = 0;
        for record in reader.records() {
            let record = record.map_err(csv_error)?;
            for (text, column) in record.iter().zip(&columns) {
                values.push(text.parse::<f64>().map_err(|_| SeriesError::Number {
                    path: path.to_path_buf(),
                    line: record.position().map_or(0, csv::Position::line),
                    column: column.name.clone(),
                    text: text.to_string(),
                })?);
            }
            rows += 1;
        }
        let data = Array2::from_shape_vec((rows, columns.len()), values)
            .expect("the CSV reader refuses rows of another length");
        Series::new(columns, data).map_err(|reason| in_file(path, reason))
    }

    /// Writes `path` (`.npy`) and its column names ([`columns_path`]).
    ///
    /// # Errors
    /// As [`Series::write_csv`].
    pub fn write_npy(&self, path: &Path) -> Result<(), SeriesError> {
        self.check_finite()?;
        let columns_path = columns_path(path);
        let columns = serde_json::to_string_pretty(&self.columns)
            .map_err(|source| SeriesError::ColumnsFile { path: columns_path.clone(), source })?;
        write_atomic(&columns_path, columns.as_bytes())?;
        Ok(write_atomic(path, &npy::file(&self.data))?)
    }

    /// Reads a NumPy file of one or two dimensions, f64 or f32, in either memory order. Without
    /// a columns file the columns are called `column 0`, `column 1`, … with unknown units.
    /// Values that are not finite are kept.
    pub fn read_npy(path: &Path) -> Result<Self, SeriesError> {
        let bytes = read(path)?;
        let data = npy::parse(&bytes)
            .map_err(|source| SeriesError::Npy { path: path.to_path_buf(), source })?;
        let columns_path = columns_path(path);
        let columns = if columns_path.exists() {
            let bytes = input_file::read(&columns_path, LARGEST_JSON)
                .map_err(|source| SeriesError::Read { path: columns_path.clone(), source })?;
            serde_json::from_slice(&bytes)
                .map_err(|source| SeriesError::ColumnsFile { path: columns_path.clone(), source })?
        } else {
            (0..data.ncols()).map(|index| Column::new(format!("column {index}"), "")).collect()
        };
        Series::new(columns, data).map_err(|reason| in_file(path, reason))
    }
}

/// Path of the column names of a `.npy` file: `series.npy` → `series.columns.json`.
pub fn columns_path(npy: &Path) -> PathBuf {
    npy.with_extension("columns.json")
}

fn read(path: &Path) -> Result<Vec<u8>, SeriesError> {
    input_file::read(path, LARGEST_DATA)
        .map_err(|source| SeriesError::Read { path: path.to_path_buf(), source })
}

fn in_file(path: &Path, reason: SeriesError) -> SeriesError {
    SeriesError::Table { path: path.to_path_buf(), reason: Box::new(reason) }
}

fn csv_line(fields: impl Iterator<Item = String>) -> String {
    fields.collect::<Vec<_>>().join(",") + "\n"
}

fn csv_field(text: &str) -> String {
    if text.contains([',', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_string()
    }
}
