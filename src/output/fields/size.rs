//! Number and size of the field files of a run, estimated before the run.

use crate::mesh::{Order, TetMesh};
use crate::numeric::clock::to_digits;
use std::fmt;

/// Number of files and bytes above which a longer interval is recommended.
const MANY: f64 = 1e4;
const LARGE: f64 = 1e10;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldsSize {
    /// Time between files, s, a multiple of the output interval; `None` if fields are written at the end only.
    pub interval: Option<f64>,
    /// True if an interval shorter than the output interval was requested.
    pub shortened: bool,
    /// Total number for all solids.
    pub files: f64,
    /// Estimated total size, bytes; 0 if the meshes are not known.
    pub bytes: f64,
}

/// Field files of a run to `end` with rows every `row`, s; `solids` holds the bytes of one file of each solid. Fields are written
/// with rows, every `wanted` s rounded to a whole number of rows, and at the end.
pub fn fields_size(end: f64, row: f64, wanted: Option<f64>, solids: &[f64]) -> FieldsSize {
    let every = wanted.map(|wanted| (wanted / row).round().max(1.0));
    // The factor keeps rounding from removing the last row.
    let rows = (end / row * (1.0 + 1e-9)).floor();
    let times = every.map_or(1.0, |every| {
        let whole = (rows / every).floor();
        let ends_there = end - whole * every * row <= 1e-6 * row;
        whole + if ends_there { 1.0 } else { 2.0 }
    });
    FieldsSize {
        interval: every.map(|every| every * row),
        shortened: wanted.is_some_and(|wanted| wanted < (1.0 - 1e-9) * row),
        files: times * solids.len() as f64,
        bytes: times * solids.iter().sum::<f64>(),
    }
}

/// Bytes of one file: displacement, velocity, stress and position of each node, contact force and pressure if there is a bore;
/// stress and nodes of each element.
pub fn file_bytes(mesh: &TetMesh, has_bore: bool) -> f64 {
    let of_node = if has_bore { 14.0 } else { 10.0 };
    let nodes_of_element = match mesh.order() {
        Order::Linear => 4.0,
        Order::Quadratic => 10.0,
    };
    let of_element = 8.0 * (7.0 + nodes_of_element + 1.0) + 1.0;
    8.0 * of_node * mesh.nodes.len() as f64 + of_element * mesh.elements.len() as f64
}

impl fmt::Display for FieldsSize {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Some(interval) = self.interval else { return write!(f, "at the end") };
        write!(f, "every {} s: {} files", to_digits(interval, 6), self.files)?;
        if self.bytes > 0.0 {
            let megabytes = 1e-6 * self.bytes;
            let (size, unit) =
                if megabytes < 1e3 { (megabytes, "MB") } else { (1e-3 * megabytes, "GB") };
            write!(f, ", about {} {unit}", to_digits(size, 2))?;
        }
        if self.shortened {
            write!(
                f,
                "; numerics.fields_interval is shorter than the time between rows: fields are written with each row"
            )?;
        }
        if self.files > MANY || self.bytes > LARGE {
            write!(
                f,
                "; WARNING: this is a large amount, choose a longer numerics.fields_interval"
            )?;
        }
        Ok(())
    }
}
