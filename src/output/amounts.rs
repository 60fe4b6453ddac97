//! Memory and time as people say them.

/// So many bytes.
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

/// So many seconds, in a unit that suits them.
///
/// ```
/// use bearing_dynamics::output::amounts::duration;
/// let told = [0.3, 42.4, 600.0, 7140.0, 9000.0].map(duration);
/// assert_eq!(told, ["a second or less", "42 s", "10 min", "119 min", "2.5 h"]);
/// ```
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "a second or less".into(),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
