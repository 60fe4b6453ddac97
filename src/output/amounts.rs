//! Memory sizes as text.

/// Size in bytes as text, in MB or GB.
///
/// ```
/// use bearing_dynamics::output::amounts::size;
/// assert_eq!([15.2e6, 999.4e6, 2.5e9].map(size), ["15 MB", "999 MB", "2.50 GB"]);
/// ```
pub fn size(bytes: f64) -> String {
    match bytes {
        bytes if bytes < 1e9 => format!("{:.0} MB", 1e-6 * bytes),
        bytes => format!("{:.2} GB", 1e-9 * bytes),
    }
}
