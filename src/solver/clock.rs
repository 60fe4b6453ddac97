//! Times as people read them.

/// A time without what many additions of a step leave in its last digits: twelve digits of it. A
/// run keeps the bits; this is for tables and messages.
///
/// ```
/// use bearing_dynamics::solver::clock::rounded;
/// assert_eq!(rounded(0.0010400000000000001).to_string(), "0.00104");
/// ```
pub fn rounded(time: f64) -> f64 {
    format!("{time:.11e}").parse().unwrap_or(time)
}
