//! Tick marks of axes and their labels.

#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    pub low: f64,
    pub high: f64,
    /// Position along the axis from 0 (low) to 1 (high), and the label.
    pub ticks: Vec<(f64, String)>,
    log: bool,
}

impl Scale {
    /// Position of a value along the axis, 0 at the low end and 1 at the high end.
    pub fn position(&self, value: f64) -> f64 {
        match self.log {
            true => (value / self.low).log10() / (self.high / self.low).log10(),
            false => (value - self.low) / (self.high - self.low),
        }
    }
}

/// Magnitudes that an axis can have; beyond them the computation of tick marks could overflow.
pub const MAGNITUDES: std::ops::RangeInclusive<f64> = 1e-200..=1e200;

/// Linear axis around values within [`MAGNITUDES`] or zero; its ends are on tick marks.
pub fn linear(values: impl Iterator<Item = f64>, wanted: usize) -> Scale {
    let (mut low, mut high) = range(values);
    // Values that agree to rounding are drawn as one, in the middle of the axis.
    let largest = high.abs().max(low.abs());
    if high - low <= 1e-12 * largest {
        let margin = if largest == 0.0 { 1.0 } else { 0.1 * largest };
        (low, high) = (low - margin, high + margin);
    }
    let step = nice_step((high - low) / wanted as f64);
    let (first, last) = ((low / step + 1e-9).floor(), (high / step - 1e-9).ceil());
    let largest = first.abs().max(last.abs()) * step;
    let count = (last - first).round() as usize;
    let ticks = (0..=count)
        .map(|i| (i as f64 / count as f64, label((first + i as f64) * step, step, largest)))
        .collect();
    Scale { low: first * step, high: last * step, ticks, log: false }
}

/// Logarithmic axis around positive values within [`MAGNITUDES`]: tick marks at powers of ten, and
/// at 2 and 5 times them if there are few.
pub fn logarithmic(values: impl Iterator<Item = f64>) -> Scale {
    let (low, high) = range(values);
    let (first, last) = (low.log10() + 1e-9, high.log10() - 1e-9);
    let mut decades = (first.floor() as i32, last.ceil() as i32);
    if decades.1 <= decades.0 {
        decades = (decades.0 - 1, decades.0 + 1);
    }
    let count = decades.1 - decades.0;
    // At most nine labels; the last mark always has one.
    let every = (count + 8) / 9;
    let factors: &[f64] = if count <= 2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let power = |exponent: i32| 10f64.powi(exponent);
    let mut ticks = Vec::new();
    for decade in decades.0..=decades.1 {
        for &factor in factors {
            let position = (f64::from(decade - decades.0) + factor.log10()) / f64::from(count);
            if position <= 1.0 + 1e-9 && (decades.1 - decade) % every == 0 {
                ticks.push((position, log_label(factor, decade)));
            }
        }
    }
    Scale { low: power(decades.0), high: power(decades.1), ticks, log: true }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

/// 1, 2 or 5 times a power of ten, not below `step`.
pub fn nice_step(step: f64) -> f64 {
    let decade = 10f64.powf(step.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * decade >= step * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * decade
}

fn label(value: f64, step: f64, largest: f64) -> String {
    if (1e-3..1e5).contains(&largest) {
        let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        let text = format!("{value:.decimals$}");
        return if value.abs() < 0.5 * step { text.trim_start_matches('-').into() } else { text };
    }
    if value.abs() < 0.5 * step {
        return "0".to_string();
    }
    // Enough digits to distinguish the marks.
    let exponent = |x: f64| (x.log10() + 1e-9).floor();
    let digits = (exponent(value.abs()) - exponent(step)).clamp(0.0, 16.0) as usize;
    format!("{value:.digits$e}")
}

fn log_label(factor: f64, decade: i32) -> String {
    match decade {
        -2..=4 => format!("{:.*}", (-decade).max(0) as usize, factor * 10f64.powi(decade)),
        _ => format!("{factor}e{decade}"),
    }
}
