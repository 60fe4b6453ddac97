//! Time profiles of loads, speeds and displacements.

use std::f64::consts::{PI, TAU};

/// Quantity as a function of time, SI units.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    Constant(f64),
    /// Linear from `from` to `to` between `start` and `start + duration`.
    Ramp {
        from: f64,
        to: f64,
        start: f64,
        duration: f64,
    },
    /// Like `Ramp`, with zero slope and curvature at both ends: 10τ³ − 15τ⁴ + 6τ⁵.
    SmoothRamp {
        from: f64,
        to: f64,
        start: f64,
        duration: f64,
    },
    /// Linear interpolation between (time, value) points, constant before the first and after the last.
    Table {
        points: Vec<[f64; 2]>,
    },
    /// mean + amplitude · sin(2π frequency · t + phase); phase in rad.
    Harmonic {
        mean: f64,
        amplitude: f64,
        frequency: f64,
        phase: f64,
    },
    /// Half sine wave of height `peak` added to `base`, from `start` for `duration`.
    HalfSine {
        base: f64,
        peak: f64,
        start: f64,
        duration: f64,
    },
}

impl Profile {
    pub const ZERO: Profile = Profile::Constant(0.0);

    /// The profile with `by` added at all times.
    pub fn shifted(&self, by: f64) -> Profile {
        let mut shifted = self.clone();
        match &mut shifted {
            Profile::Constant(value) => *value += by,
            Profile::Ramp { from, to, .. } | Profile::SmoothRamp { from, to, .. } => {
                *from += by;
                *to += by;
            }
            Profile::Table { points } => points.iter_mut().for_each(|point| point[1] += by),
            Profile::Harmonic { mean, .. } => *mean += by,
            Profile::HalfSine { base, .. } => *base += by,
        }
        shifted
    }

    /// Returns whether the profile is zero at all times.
    pub fn is_zero(&self) -> bool {
        match self {
            Profile::Constant(value) => *value == 0.0,
            Profile::Ramp { from, to, .. } | Profile::SmoothRamp { from, to, .. } => {
                *from == 0.0 && *to == 0.0
            }
            Profile::Table { points } => points.iter().all(|point| point[1] == 0.0),
            Profile::Harmonic { mean, amplitude, .. } => *mean == 0.0 && *amplitude == 0.0,
            Profile::HalfSine { base, peak, .. } => *base == 0.0 && *peak == 0.0,
        }
    }

    /// Frequency of a periodic profile, Hz; 0 for all others.
    pub fn cycles(&self) -> f64 {
        match self {
            Profile::Harmonic { frequency, .. } => frequency.abs(),
            _ => 0.0,
        }
    }

    /// The profile with its time counted from `t0` (s).
    pub fn from_time(&self, t0: f64) -> Profile {
        let mut later = self.clone();
        match &mut later {
            Profile::Constant(_) => {}
            Profile::Ramp { start, .. }
            | Profile::SmoothRamp { start, .. }
            | Profile::HalfSine { start, .. } => *start -= t0,
            Profile::Table { points } => points.iter_mut().for_each(|point| point[0] -= t0),
            Profile::Harmonic { frequency, phase, .. } => *phase += TAU * *frequency * t0,
        }
        later
    }

    /// Value at time `t` (s).
    pub fn value(&self, t: f64) -> f64 {
        match self {
            Profile::Constant(value) => *value,
            Profile::Ramp { from, to, start, duration } => {
                from + (to - from) * fraction(t, *start, *duration)
            }
            Profile::SmoothRamp { from, to, start, duration } => {
                let f = fraction(t, *start, *duration);
                from + (to - from) * f * f * f * (10.0 + f * (6.0 * f - 15.0))
            }
            Profile::Table { points } => table(points, t).0,
            Profile::Harmonic { mean, amplitude, frequency, phase } => {
                mean + amplitude * libm::sin(TAU * frequency * t + phase)
            }
            Profile::HalfSine { base, peak, start, duration } => {
                let f = (t - start) / duration;
                if (0.0..=1.0).contains(&f) { base + peak * libm::sin(PI * f) } else { *base }
            }
        }
    }

    /// Rate of change at time `t` (s), per second.
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            Profile::Constant(_) => 0.0,
            Profile::Ramp { from, to, start, duration } => {
                let inside = is_inside(t, *start, *duration);
                if inside { (to - from) / duration } else { 0.0 }
            }
            Profile::SmoothRamp { from, to, start, duration } => {
                let f = fraction(t, *start, *duration);
                let rise = 30.0 * f * f * (1.0 - f) * (1.0 - f);
                if rise == 0.0 { 0.0 } else { (to - from) * rise / duration }
            }
            Profile::Table { points } => table(points, t).1,
            Profile::Harmonic { amplitude, frequency, phase, .. } => {
                let pulsation = TAU * frequency;
                amplitude * pulsation * libm::cos(pulsation * t + phase)
            }
            Profile::HalfSine { peak, start, duration, .. } => {
                let f = (t - start) / duration;
                let inside = is_inside(t, *start, *duration);
                if inside { peak * PI / duration * libm::cos(PI * f) } else { 0.0 }
            }
        }
    }

    /// Second derivative at time `t` (s), per second²; jumps of the slope are not included.
    pub fn acceleration(&self, t: f64) -> f64 {
        match self {
            Profile::Constant(_) | Profile::Ramp { .. } | Profile::Table { .. } => 0.0,
            Profile::SmoothRamp { from, to, start, duration } => {
                let f = fraction(t, *start, *duration);
                let bend = 60.0 * f * (1.0 - f) * (1.0 - 2.0 * f);
                if bend == 0.0 { 0.0 } else { (to - from) * bend / (duration * duration) }
            }
            Profile::Harmonic { amplitude, frequency, phase, .. } => {
                let pulsation = TAU * frequency;
                -amplitude * pulsation * pulsation * libm::sin(pulsation * t + phase)
            }
            Profile::HalfSine { peak, start, duration, .. } => {
                let f = (t - start) / duration;
                let inside = is_inside(t, *start, *duration);
                let pulsation = PI / duration;
                if inside { -peak * pulsation * pulsation * libm::sin(PI * f) } else { 0.0 }
            }
        }
    }

    /// ∫ value dt from 0 to `t` (s), in closed form: the angle of rotation for a speed.
    pub fn integral(&self, t: f64) -> f64 {
        match self {
            Profile::Constant(value) => value * t,
            Profile::Ramp { from, to, start, duration } => {
                // In terms of the fraction f = (t − start)/duration: f²/2 within the ramp, and 1/2 + (f − 1) beyond.
                let rise = ramp_integral(t, *start, *duration, |f| 0.5 * f * f);
                from * t + (to - from) * rise
            }
            Profile::SmoothRamp { from, to, start, duration } => {
                let quartic = |f: f64| f * f * f * f * (2.5 + f * (f - 3.0));
                from * t + (to - from) * ramp_integral(t, *start, *duration, quartic)
            }
            Profile::Table { points } => table_integral(points, t) - table_integral(points, 0.0),
            Profile::Harmonic { mean, amplitude, frequency, phase } => {
                let pulsation = TAU * frequency;
                let cosines = libm::cos(*phase) - libm::cos(pulsation * t + phase);
                mean * t + amplitude / pulsation * cosines
            }
            Profile::HalfSine { base, peak, start, duration } => {
                let area = |t: f64| {
                    let f = ((t - start) / duration).clamp(0.0, 1.0);
                    duration / PI * (1.0 - libm::cos(PI * f))
                };
                base * t + peak * (area(t) - area(0.0))
            }
        }
    }

    /// Times at which value or slope jumps, s; steps should end there.
    pub fn corners(&self) -> Vec<f64> {
        match self {
            Profile::Constant(_) | Profile::Harmonic { .. } => Vec::new(),
            Profile::Ramp { start, duration, .. }
            | Profile::SmoothRamp { start, duration, .. }
            | Profile::HalfSine { start, duration, .. } => vec![*start, start + duration],
            Profile::Table { points } => points.iter().map(|point| point[0]).collect(),
        }
    }
}

/// Returns whether `t` is within an interval. The end is excluded, because a run that has reached it continues beyond.
fn is_inside(t: f64, start: f64, duration: f64) -> bool {
    t >= start && t < start + duration
}

/// Completed fraction of a ramp, 0 to 1; a ramp of zero duration is a step.
fn fraction(t: f64, start: f64, duration: f64) -> f64 {
    if duration > 0.0 {
        ((t - start) / duration).clamp(0.0, 1.0)
    } else if t >= start {
        1.0
    } else {
        0.0
    }
}

/// ∫ of [`fraction`] from 0 to `t`; `part` is its integral over the fraction itself, with `part(1)` = 1/2.
fn ramp_integral(t: f64, start: f64, duration: f64, part: impl Fn(f64) -> f64) -> f64 {
    let end = start + duration;
    let from_start = |t: f64| duration * part(fraction(t, start, duration)) + (t - end).max(0.0);
    from_start(t) - from_start(0.0)
}

/// Integral of a table from its first point to `t`.
fn table_integral(points: &[[f64; 2]], t: f64) -> f64 {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return 0.0 };
    let mut sum = first[1] * (t - first[0]).min(0.0) + last[1] * (t - last[0]).max(0.0);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let inside = t.clamp(a[0], b[0]) - a[0];
        let slope = (b[1] - a[1]) / (b[0] - a[0]);
        sum += inside * (a[1] + 0.5 * slope * inside);
    }
    sum
}

/// Value and slope of a table.
fn table(points: &[[f64; 2]], t: f64) -> (f64, f64) {
    let after = points.partition_point(|point| point[0] <= t);
    match (after.checked_sub(1).and_then(|i| points.get(i)), points.get(after)) {
        (Some(a), Some(b)) => {
            let slope = (b[1] - a[1]) / (b[0] - a[0]);
            (a[1] + slope * (t - a[0]), slope)
        }
        (Some(end), None) | (None, Some(end)) => (end[1], 0.0),
        (None, None) => (0.0, 0.0),
    }
}

/// First of the sorted `corners` after `time`.
pub fn next_corner(corners: &[f64], time: f64) -> Option<f64> {
    corners.get(corners.partition_point(|corner| *corner <= time)).copied()
}
