//! When rows, corners and the end of a run are due, and times as people read them.
//!
//! A bearing alone steps up to its rows, to the corners of its loads and given motions, and to the
//! end of the run: [`Clock::next_stop`]. With a fixed step the step does not change on the way, but
//! where there is a corner: steps end there, and the way from one row to the next is divided evenly
//! between its corners. A step that follows from the stability limit is shortened where the limit
//! comes down to it; what is left to the next row is divided evenly as well. With error control
//! steps follow from the state, from what the control remembers and from the time of the next row or
//! corner. The very last step is shortened to end at the end.
//!
//! A solid's steps, the windows of a bearing and its housing, and equilibria are taken whole:
//! [`Clock::ahead`]. Such a run ends at the whole one nearest to its end.
//!
//! Either way the next step follows from what is kept, so that a run that was interrupted, or is
//! extended, goes on with the same bits.

use crate::assembly::loads::next_corner;

/// A number to so many digits.
///
/// ```
/// use bearing_dynamics::numeric::clock::to_digits;
/// assert_eq!(to_digits(0.0010400000000000001, 12).to_string(), "0.00104");
/// ```
pub fn to_digits(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A time without what many additions of a step leave in its last digits, for messages: nine of them
/// are sound after 1e8 additions. A run keeps the bits.
pub fn rounded(time: f64) -> f64 {
    to_digits(time, 9)
}

/// What is due in a run, and when.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clock {
    /// When the run ends, s.
    pub end: f64,
    /// Wanted time between rows, s.
    pub interval: f64,
    /// A step that divides rows, a window, or the time between equilibria, s; zero with error
    /// control.
    pub step: f64,
    /// So many make a row; zero with error control, where steps end at the rows' times.
    pub steps_per_row: u64,
    /// How many there are in all, where only whole ones are taken.
    pub last: Option<u64>,
    /// Times of corners, ascending, s; none where only whole steps are taken.
    pub corners: Vec<f64>,
    /// Whether the step has been shortened on the way.
    pub shortened: bool,
    /// Wanted time between files of fields, s, and rows from one to the next, where there are any on
    /// the way.
    pub fields_interval: Option<f64>,
    pub rows_per_fields: Option<u64>,
    /// Rows so far, and the time of the last one, s.
    pub rows: u64,
    pub row_time: f64,
}

/// The next step of a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// s.
    pub size: f64,
    /// Time to be at after it, s, where that is given.
    pub at: Option<f64>,
    /// The corner that is crossed there.
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

    /// Rows of the whole run, with the first, a last one off the grid, and one for rounding.
    pub fn rows_in_all(&self) -> usize {
        ((self.end / self.row_interval()) as usize).saturating_add(3)
    }

    /// Counts a row at `time` (s).
    pub fn count_row(&mut self, time: f64) {
        self.rows += 1;
        self.row_time = time;
    }

    /// Number of the file of fields that is due at the last row.
    pub fn fields_due(&self) -> Option<u64> {
        let (every, row) = (self.rows_per_fields?, self.rows.checked_sub(1)?);
        row.is_multiple_of(every).then_some(row / every)
    }

    /// Goes on with steps no longer than `step` (s) that divide an interval.
    pub fn shorten(&mut self, step: f64) {
        self.steps_per_row = whole_steps(self.interval, step);
        self.step = self.interval / self.steps_per_row as f64;
        self.shortened = true;
    }

    /// How many whole steps to take after `done` of them: up to the next row, and no more than `most`.
    pub fn ahead(&self, done: u64, most: u64) -> u64 {
        let row = (done / self.steps_per_row + 1) * self.steps_per_row;
        row.min(self.last.unwrap_or(row)).saturating_sub(done).min(most)
    }

    /// Whether a row is due after `done` whole steps, and whether they are all.
    pub fn after(&self, done: u64) -> (bool, bool) {
        let completes = self.last.is_some_and(|last| done >= last);
        (completes || self.is_on_grid(done), completes)
    }

    /// Whether `done` whole steps make whole rows.
    pub fn is_on_grid(&self, done: u64) -> bool {
        done.is_multiple_of(self.steps_per_row)
    }

    /// The next step at `time` (s); with error control one that the control wants to be `wanted` (s).
    pub fn next_stop(&self, time: f64, wanted: f64) -> Stop {
        if self.steps_per_row == 0 {
            return self.controlled_stop(time, wanted);
        }
        let step = self.step;
        let row_end = self.row_time + self.row_interval();
        // Rounding of times is far below this, and nobody means a step so short.
        let slack = 1e-6 * step;
        let corner = next_corner(&self.corners, self.row_time);
        // A row in which the step was shortened is no whole number of steps.
        if self.shortened || corner.is_some_and(|corner| corner <= row_end + slack) {
            return self.even_stop(time, row_end, slack);
        }
        let left = self.end - time;
        // A last step that is whole but for rounding of the time is taken whole, so that no step
        // of nearly nothing follows it.
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

    /// A step on the way to a corner or a row: an equal part of what is left, whatever the end of
    /// the run is.
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

    /// A step whose size follows from the error, on the way to the next row, corner or the end.
    fn controlled_stop(&self, time: f64, wanted: f64) -> Stop {
        // Rows by count, so that rounding does not add up.
        let row_time = self.rows as f64 * self.interval;
        // Nobody means a step so short.
        let slack = 1e-9 * self.interval;
        let corner = next_corner(&self.corners, time).filter(|corner| *corner <= row_time + slack);
        // Never before the corner, or it would be there to cross again.
        let at_row =
            |corner: f64| if corner >= row_time - slack { row_time.max(corner) } else { corner };
        let mut stop = corner.map_or(row_time, at_row);
        let mut left = stop - time;
        let mut size = towards(wanted, left);
        // The end changes the last step only, so that a run can be extended with the same bits.
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

/// Steps that a run of given steps takes, as [`Clock::next_stop`] takes them: rows of whole steps, the
/// way to the next row divided evenly between its `corners`, a last step that ends at the end. Times in s.
pub fn given_steps(corners: &[f64], interval: f64, end: f64, step: f64) -> u64 {
    let interval = (interval / step).round().max(1.0) * step;
    let slack = 1e-6 * step;
    // Steps of about `step` to a time that is `left` away, and the last of a run.
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
            // Rows without a corner in one go.
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

/// How many steps, or rows, of this length come nearest to the `end` (s); one at least.
pub fn whole_number(end: f64, length: f64) -> u64 {
    (end / length).round().max(1.0) as u64
}

/// Steps no longer than `step` that make an interval.
pub fn whole_steps(interval: f64, step: f64) -> u64 {
    // A ratio that is whole but for rounding is whole.
    (interval / step * (1.0 - 1e-12)).ceil().max(1.0) as u64
}

/// A step no longer than `step` on the way to a row that is `left` away: there if it can be
/// reached, half of the way if it could be reached in two, so that no tiny step comes last.
fn towards(step: f64, left: f64) -> f64 {
    if left <= step * (1.0 + 1e-6) {
        left
    } else if left < 2.0 * step {
        0.5 * left
    } else {
        step
    }
}

/// A time as warnings and errors print it: six digits.
pub fn display_time(time: f64) -> f64 {
    to_digits(time, 6)
}
