//! Size of the table of a run, computed before the run.

use super::{Parts, RunRequest, SessionError};
use crate::numeric::clock::to_digits;
use crate::output::recorder::Recorder;
use std::collections::HashSet;

/// Limit on the number of values of a table: it is kept in memory, copied for the results and written twice.
pub(super) const MOST_VALUES: f64 = 1e8;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSize {
    pub rows: f64,
    pub columns: usize,
    /// Shortest permitted output interval, s, rounded up to two digits.
    pub shortest: f64,
}

impl std::fmt::Display for TableSize {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let megabytes = 8e-6 * self.rows * self.columns as f64;
        let (size, unit) =
            if megabytes < 1e3 { (megabytes, "MB") } else { (1e-3 * megabytes, "GB") };
        let size = to_digits(size, 2);
        write!(f, "{} rows of {} channels make {size} {unit}", self.rows, self.columns)
    }
}

/// Number of rows and channels of a run.
///
/// # Errors
/// More values than permitted.
pub fn table_size<'p>(
    parts: impl Into<Parts<'p>>,
    request: &RunRequest,
) -> Result<TableSize, SessionError> {
    size_of(&Recorder::new(&parts.into(), &request.channels), request)
}

pub(super) fn size_of(
    recorder: &Recorder,
    request: &RunRequest,
) -> Result<TableSize, SessionError> {
    let mut names = HashSet::new();
    let repeated = recorder.columns().iter().find(|column| !names.insert(&column.name));
    if let Some(column) = repeated {
        return Err(SessionError::SharedColumn(column.name.clone()));
    }
    let columns = recorder.columns().len();
    let rows = (request.end / request.output_interval).ceil() + 1.0;
    // There is one row more than intervals.
    let shortest = request.end / (MOST_VALUES / columns as f64 - 2.0).max(1.0);
    let digit = libm::pow(10.0, libm::log10(shortest).floor() - 1.0);
    let shortest = (shortest / digit).ceil() * digit;
    let size = TableSize { rows, columns, shortest };
    // Also rejects NaN.
    if rows * columns as f64 <= MOST_VALUES {
        Ok(size)
    } else {
        Err(SessionError::TooLarge { size })
    }
}
