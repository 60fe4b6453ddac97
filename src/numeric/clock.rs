//! Times of output rows, corners and the end of a run, and rounded times for messages.
//!
//! A bearing alone steps to its rows, to the corners of its loads and prescribed motions, and to the end of the run:
//! [`Clock::next_stop`]. A fixed step is constant except near a corner: the time from one row to the next is divided
//! evenly between its corners. A step set by the stability limit is shortened when the limit falls to it; the time left
//! to the next row is again divided evenly. With error control, steps follow from the state, the controller and the
//! time of the next row or corner. The last step is shortened to end at the end of the run.
//!
//! Steps of a solid, coupling steps of a bearing and its housing, and quasi-static increments have a fixed length:
//! [`Clock::ahead`]. Such a run ends at the whole step nearest to its end.
//!
//! In both cases the next step follows from stored values, so that a resumed or extended run gives the same bits.

use crate::numeric::profile::next_corner;
use serde::{Deserialize, Serialize};

/// Rounds a number to `digits` significant digits.
///
/// ```
/// use bearing_dynamics::numeric::clock::to_digits;
/// assert_eq!(to_digits(0.0010400000000000001, 12).to_string(), "0.00104");
/// ```
pub fn to_digits(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// Rounds a time to nine digits for messages, to hide accumulated rounding errors (valid up to 1e8 additions of a
/// step).
pub fn rounded(time: f64) -> f64 {
    to_digits(time, 9)
}

/// Output rows, corners and end of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// End time of the run, s.
    pub end: f64,
    /// Requested time between rows, s.
    pub interval: f64,
    /// Step that divides rows, coupling step, or quasi-static increment, s; zero with error control.
    pub step: f64,
    /// Steps per row; zero with error control, where steps end at the rows' times.
    pub steps_per_row: u64,
    /// Total number of steps if only whole steps are taken; otherwise `None`.
    #[serde(skip)]
    pub last: Option<u64>,
    /// Times of corners, ascending, s; empty if only whole steps are taken.
    #[serde(skip)]
    pub corners: Vec<f64>,
    /// True if the step has been shortened during the run.
    #[serde(skip)]
    pub shortened: bool,
    /// Requested time between field files, s, and rows between them; `None` without field files during the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fields_interval: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rows_per_fields: Option<u64>,
    /// Rows so far, and the time of the last one, s.
    #[serde(skip)]
    pub rows: u64,
    #[serde(skip)]
    pub row_time: f64,
}

/// Next step of a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Step size, s.
    pub size: f64,
    /// Exact time at the end of the step, s, if prescribed.
    pub at: Option<f64>,
    /// Corner at the end of the step.
    pub corner: Option<f64>,
    pub row: bool,
    pub completes: bool,
}

impl Clock {
    /// Time between rows, s.
    pub fn row_interval(&self) -> f64 {
        match self.steps_per_row {
            0 => self.interval,
            steps => steps as f64 * self.step,
        }
    }

    /// Upper bound of the rows of the whole run: includes the first row, a last row off the grid, and one for rounding.
    pub fn rows_in_all(&self) -> usize {
        ((self.end / self.row_interval()) as usize).saturating_add(3)
    }

    /// Counts a row at `time` (s).
    pub fn count_row(&mut self, time: f64) {
        self.rows += 1;
        self.row_time = time;
    }

    /// Number of the field file due at the last row.
    pub fn fields_due(&self) -> Option<u64> {
        let (every, row) = (self.rows_per_fields?, self.rows.checked_sub(1)?);
        row.is_multiple_of(every).then_some(row / every)
    }

    /// Continues with steps no longer than `step` (s) that divide an interval.
    pub fn shorten(&mut self, step: f64) {
        self.steps_per_row = whole_steps(self.interval, step);
        self.step = self.interval / self.steps_per_row as f64;
        self.shortened = true;
    }

    /// Number of whole steps to take after `done` steps: up to the next row, and at most `most`.
    pub fn ahead(&self, done: u64, most: u64) -> u64 {
        let row = (done / self.steps_per_row + 1) * self.steps_per_row;
        row.min(self.last.unwrap_or(row)).saturating_sub(done).min(most)
    }

    /// Returns whether a row is due after `done` whole steps, and whether the run is complete.
    pub fn after(&self, done: u64) -> (bool, bool) {
        let completes = self.last.is_some_and(|last| done >= last);
        (completes || self.is_on_grid(done), completes)
    }

    /// Returns whether `done` whole steps end at a row.
    pub fn is_on_grid(&self, done: u64) -> bool {
        done.is_multiple_of(self.steps_per_row)
    }

    /// Next step at `time` (s); `wanted` (s) is the step requested by the error control.
    pub fn next_stop(&self, time: f64, wanted: f64) -> Stop {
        if self.steps_per_row == 0 {
            return self.controlled_stop(time, wanted);
        }
        let step = self.step;
        let row_end = self.row_time + self.row_interval();
        // Larger than rounding errors of times, smaller than any intended step.
        let slack = 1e-6 * step;
        let corner = next_corner(&self.corners, self.row_time);
        // If the step was shortened within this row, the row is not a whole number of steps.
        if self.shortened || corner.is_some_and(|corner| corner <= row_end + slack) {
            return self.even_stop(time, row_end, slack);
        }
        let left = self.end - time;
        // A last step that is whole apart from rounding is taken whole, to avoid a tiny step after it.
        if left <= step * (1.0 + 1e-6) {
            return Stop {
                size: left,
                at: Some(self.end),
                corner: None,
                row: true,
                completes: true,
            };
        }
        let taken = ((time + step - self.row_time) / step).round();
        let row = taken as u64 == self.steps_per_row;
        Stop { size: step, at: None, corner: None, row, completes: false }
    }

    /// Step towards a corner or a row: an equal part of the remaining time, independent of the end of the run.
    fn even_stop(&self, time: f64, row_end: f64, slack: f64) -> Stop {
        let corner = next_corner(&self.corners, time).filter(|corner| *corner <= row_end + slack);
        let stop = corner.unwrap_or(row_end);
        let left = stop - time;
        let steps = (left / self.step * (1.0 - 1e-9)).ceil().max(1.0);
        let size = left / steps;
        let completes = self.end - time <= size * (1.0 + 1e-6);
        let stop = if completes { self.end } else { stop };
        if steps > 1.0 && !completes {
            return Stop { size, at: None, corner: None, row: false, completes };
        }
        let corner = corner.filter(|corner| *corner <= stop + slack);
        let row = completes || stop >= row_end - slack;
        Stop { size: stop - time, at: Some(stop), corner, row, completes }
    }

    /// Step with a size from the error control, towards the next row, corner or end.
    fn controlled_stop(&self, time: f64, wanted: f64) -> Stop {
        // Row times by count, so that rounding errors do not accumulate.
        let row_time = self.rows as f64 * self.interval;
        // Shorter steps are rounding errors.
        let slack = 1e-9 * self.interval;
        let corner = next_corner(&self.corners, time).filter(|corner| *corner <= row_time + slack);
        // Never before the corner, to avoid crossing it again.
        let at_row =
            |corner: f64| if corner >= row_time - slack { row_time.max(corner) } else { corner };
        let mut stop = corner.map_or(row_time, at_row);
        let mut left = stop - time;
        let mut size = towards(wanted, left);
        // The end changes only the last step, so that a run can be extended with the same bits.
        let completes = self.end - time <= size * (1.0 + 1e-6);
        if completes {
            stop = self.end;
            left = stop - time;
            size = left;
        }
        if size != left {
            return Stop { size, at: None, corner: None, row: false, completes: false };
        }
        let corner = corner.filter(|corner| *corner <= stop + slack);
        let row = completes || stop >= row_time;
        Stop { size, at: Some(stop), corner, row, completes }
    }
}

/// Number of steps that [`Clock::next_stop`] takes with a fixed step: whole steps per row, the time to the next row
/// divided evenly between its `corners`, and a last step that ends at the end. Times in s.
pub fn given_steps(corners: &[f64], interval: f64, end: f64, step: f64) -> u64 {
    let interval = (interval / step).round().max(1.0) * step;
    let slack = 1e-6 * step;
    // Steps of about `step` over a time `left`.
    let to_stop = |left: f64| (left / step * (1.0 - 1e-9)).ceil().max(1.0);
    let mut steps = 0.0;
    let mut row = 0.0;
    loop {
        let row_end = row + interval;
        let has_corner =
            |from: f64| next_corner(corners, from).filter(|corner| *corner <= row_end + slack);
        let Some(mut corner) = has_corner(row) else {
            let left = end - row;
            if left <= interval + slack {
                return (steps + (left / step - 1e-6).ceil().max(1.0)) as u64;
            }
            // Skips all rows without a corner.
            let next = next_corner(corners, row).unwrap_or(f64::INFINITY).min(end);
            let rows = ((next - row - slack) / interval).floor().max(1.0);
            steps += rows * (interval / step).round();
            row += rows * interval;
            continue;
        };
        let mut time = row;
        loop {
            let count = to_stop(corner - time);
            let size = (corner - time) / count;
            if end <= corner + 1e-6 * size {
                return (steps + ((end - time) / size - 1e-6).ceil().max(1.0)) as u64;
            }
            steps += count;
            time = corner;
            if time >= row_end - slack {
                break;
            }
            corner = has_corner(time).unwrap_or(row_end);
        }
        row = time;
    }
}

/// Number of intervals of `length` (s) that is nearest to `end` (s); at least one.
pub fn whole_number(end: f64, length: f64) -> u64 {
    (end / length).round().max(1.0) as u64
}

/// Number of equal steps no longer than `step` in an interval.
pub fn whole_steps(interval: f64, step: f64) -> u64 {
    // Tolerates rounding of a whole ratio.
    (interval / step * (1.0 - 1e-12)).ceil().max(1.0) as u64
}

/// Step of at most `step` towards a row after the time `left`: the whole time if possible, half of it if two steps
/// suffice, to avoid a tiny last step.
fn towards(step: f64, left: f64) -> f64 {
    if left <= step * (1.0 + 1e-6) {
        left
    } else if left < 2.0 * step {
        0.5 * left
    } else {
        step
    }
}

/// Rounds a time to the six digits printed in warnings and errors.
pub fn display_time(time: f64) -> f64 {
    to_digits(time, 6)
}
