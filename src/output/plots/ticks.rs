//! Where an axis is marked, and with what.

/// An axis from `low` to `high` with marks between them.
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
            // Halved so that the largest representable range does not overflow.
            false => (value / 2.0 - self.low / 2.0) / (self.high / 2.0 - self.low / 2.0),
        }
    }
}

/// A linear axis around finite values, ends on a mark.
pub fn linear(values: impl Iterator<Item = f64>, wanted: usize) -> Scale {
    let (mut low, mut high) = range(values);
    // Values that agree to rounding are drawn as one, in the middle of the axis.
    if high - low <= 1e-12 * high.abs().max(low.abs()) {
        let margin = if high == 0.0 { 1.0 } else { 0.1 * high.abs() };
        (low, high) = (low - margin, high + margin);
    }
    let step = nice_step((high / wanted as f64) - (low / wanted as f64));
    let (first, last) = ((low / step + 1e-9).floor(), (high / step - 1e-9).ceil());
    let largest = first.abs().max(last.abs()) * step;
    let count = (last - first).round() as usize;
    let ticks = (0..=count)
        .map(|i| {
            (
                i as f64 / count as f64,
                label((first + i as f64) * step, step, largest),
            )
        })
        .collect();
    Scale {
        low: first * step,
        high: last * step,
        ticks,
        log: false,
    }
}

/// A logarithmic axis around positive values: marks at powers of ten, or at 1, 2, 5 if few.
pub fn logarithmic(values: impl Iterator<Item = f64>) -> Scale {
    let (low, high) = range(values);
    let (first, last) = (low.log10() + 1e-9, high.log10() - 1e-9);
    let mut decades = (first.floor() as i32, last.ceil() as i32);
    if decades.1 <= decades.0 {
        decades = (decades.0 - 1, decades.0 + 1);
    }
    let count = decades.1 - decades.0;
    // At most nine labels; the last mark always carries one.
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
    Scale {
        low: power(decades.0),
        high: power(decades.1),
        ticks,
        log: true,
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    })
}

/// 1, 2 or 5 times a power of ten, not below `step`.
pub fn nice_step(step: f64) -> f64 {
    let decade = 10f64.powf(step.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|f| f * decade >= step * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * decade
}

fn label(value: f64, step: f64, largest: f64) -> String {
    if (1e-3..1e5).contains(&largest) {
        let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        let text = format!("{value:.decimals$}");
        return if value.abs() < 0.5 * step {
            text.trim_start_matches('-').into()
        } else {
            text
        };
    }
    if value.abs() < 0.5 * step {
        return "0".to_string();
    }
    // As many digits as tell the marks apart.
    let digits = ((value.abs() / step).log10() + 1e-9).floor().max(0.0) as usize;
    format!("{value:.digits$e}")
}

fn log_label(factor: f64, decade: i32) -> String {
    match decade {
        -2..=4 => format!(
            "{:.*}",
            (-decade).max(0) as usize,
            factor * 10f64.powi(decade)
        ),
        _ => format!("{factor}e{decade}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: &Scale) -> Vec<&str> {
        scale
            .ticks
            .iter()
            .map(|(_, label)| label.as_str())
            .collect()
    }

    #[test]
    fn linear_axes_end_on_round_marks_around_the_values() {
        assert_eq!(
            labels(&linear([0.0, 0.15].into_iter(), 4)),
            ["0.00", "0.05", "0.10", "0.15"]
        );
        assert_eq!(
            labels(&linear([-3.0, 4.0].into_iter(), 4)),
            ["-4", "-2", "0", "2", "4"]
        );
        let micro = linear([0.0, 2.3e-6].into_iter(), 5);
        assert_eq!(labels(&micro)[..3], ["0", "5e-7", "1.0e-6"]);
        for scale in [linear([5.0].into_iter(), 5), linear([0.0].into_iter(), 5)] {
            assert!(
                scale.low < scale.high && scale.ticks.len() >= 3,
                "{scale:?}"
            );
        }
    }

    #[test]
    fn extreme_values_still_make_an_axis() {
        for values in [
            [-f64::MAX, f64::MAX],
            [1e-300, 2e-300],
            [1e300, 1.0000001e300],
        ] {
            let scale = linear(values.into_iter(), 5);
            assert!(
                scale.ticks.len() >= 2 && scale.ticks.len() <= 20,
                "{scale:?}"
            );
            for value in values {
                let position = scale.position(value);
                assert!(
                    (-1e-6..=1.0 + 1e-6).contains(&position),
                    "{value} at {position}"
                );
            }
        }
    }

    #[test]
    fn logarithmic_axes_mark_decades() {
        let scale = logarithmic([0.03, 400.0].into_iter());
        assert_eq!(labels(&scale), ["0.01", "0.1", "1", "10", "100", "1000"]);
        assert!((scale.position(1.0) - 0.4).abs() <= 1e-12);
        assert!(labels(&logarithmic([2.0, 3.0].into_iter())).contains(&"5"));
        assert!(logarithmic([1e-16, 1e3].into_iter()).ticks.len() <= 10);
    }
}
