//! Times as people read them.

/// A number to so many digits.
///
/// ```
/// use bearing_dynamics::solver::clock::to_digits;
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

/// A time as remarks and errors tell it: six digits.
pub fn told(time: f64) -> f64 {
    to_digits(time, 6)
}
