//! Lines of bearing defects in spectra: kinematic frequencies at the mean speed of a window, and amplitudes at them.

use crate::ch2_housing::bearing::frequencies::ratios;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::output::spectrum::Spectrum;
use std::f64::consts::TAU;

/// A kinematic frequency of a bearing or one of its harmonics.
#[derive(Clone, Debug, PartialEq)]
pub struct DefectLine {
    /// Such as `BPFO`; with several bearings `left BPFO`.
    pub name: String,
    /// Multiple of the frequency of that name.
    pub order: u32,
    /// Hz.
    pub frequency: f64,
}

impl DefectLine {
    /// Such as `2 BPFO`.
    pub fn label(&self) -> String {
        if self.order == 1 { self.name.clone() } else { format!("{} {}", self.order, self.name) }
    }
}

/// Lines of one bearing, and the means over the window from which they follow.
#[derive(Clone, Debug, PartialEq)]
pub struct BearingLines {
    /// Column prefix of the bearing; empty for a single one.
    pub prefix: String,
    /// Mean speeds of inner and outer race, rad/s.
    pub speeds: [f64; 2],
    /// Largest less smallest difference of the speeds over the mean difference.
    pub speed_change: f64,
    /// Contact angle of pure rolling, rad, and its origin.
    pub contact_angle: f64,
    pub angle_is: &'static str,
    pub lines: Vec<DefectLine>,
}

/// Orders of all lines but those of a ball, and of a ball: it meets a race twice per turn.
const ORDERS: [u32; 3] = [1, 2, 3];
const BALL_ORDERS: [u32; 4] = [1, 2, 4, 6];

/// Speed over the relative speed of the races below which a part stands still.
const ROUNDING: f64 = 1e-9;

/// Lines for pure rolling, with the speeds of inner and outer race in rad/s and the contact angle in rad.
///
/// FTF, shaft, BPFO, BPFI and BSF with their harmonics; parts that stand still have none.
pub fn lines(
    prefix: &str,
    geometry: &BearingGeometry,
    [inner, outer]: [f64; 2],
    contact_angle: f64,
) -> Vec<DefectLine> {
    let BearingGeometry { ball_count, ball_radius, pitch_radius, .. } = *geometry;
    let ratios = ratios(ball_count, ball_radius, pitch_radius, contact_angle);
    let relative = inner - outer;
    let cage = outer + ratios.cage * relative;
    let named = [
        ("FTF", cage, &ORDERS[..]),
        ("shaft", inner, &ORDERS),
        ("outer race", outer, &ORDERS),
        ("BPFO", ratios.ball_pass_outer * relative, &ORDERS),
        ("BPFI", ratios.ball_pass_inner * relative, &ORDERS),
        ("BSF", ratios.ball_spin * relative, &BALL_ORDERS),
    ];
    let of = prefix.replace('_', " ");
    let mut lines = Vec::new();
    for (name, speed, orders) in named {
        let frequency = speed.abs() / TAU;
        let of_order = |order: &u32| DefectLine {
            name: format!("{of}{name}"),
            order: *order,
            frequency: f64::from(*order) * frequency,
        };
        if speed.abs() > ROUNDING * relative.abs() {
            lines.extend(orders.iter().map(of_order));
        }
    }
    lines
}

/// Amplitude of a spectrum at a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineReading {
    /// The highest of the bin nearest to the line and its two neighbours, and its distance from the nearest bin.
    pub bin: usize,
    pub offset: i32,
    pub amplitude: f64,
    /// Median amplitude of the bins around; `None` with fewer than [`FEWEST_NOISE_BINS`] of them.
    pub noise: Option<f64>,
}

/// Half width of the main lobe of the window and of the search for the highest bin, in bins.
const LOBE: usize = 3;
/// Bins on each side of a line from which the noise is taken; those within the main lobe are excluded.
pub const NOISE_BINS: usize = 30;
pub const FEWEST_NOISE_BINS: usize = 10;

/// Reads a spectrum at a frequency, Hz; `None` beyond the spectrum, or within the main lobe of the mean.
pub fn read_line(spectrum: &Spectrum, frequency: f64) -> Option<LineReading> {
    let bins = &spectrum.amplitude;
    let position = (frequency / spectrum.bin_width).round();
    if !(position >= LOBE as f64 && position + 1.0 < bins.len() as f64) {
        return None;
    }
    let nearest = position as usize;
    // The nearest bin is preferred if equal.
    let bin = [nearest - 1, nearest + 1]
        .into_iter()
        .fold(nearest, |best, bin| if bins[bin] > bins[best] { bin } else { best });
    let around =
        (nearest.saturating_sub(NOISE_BINS)).max(LOBE)..(nearest + NOISE_BINS + 1).min(bins.len());
    let mut noise: Vec<f64> =
        around.filter(|other| other.abs_diff(bin) > LOBE).map(|bin| bins[bin]).collect();
    noise.sort_by(f64::total_cmp);
    let median = match noise.len() {
        count if count < FEWEST_NOISE_BINS => None,
        count if count % 2 == 1 => Some(noise[count / 2]),
        count => Some(0.5 * (noise[count / 2 - 1] + noise[count / 2])),
    };
    let offset = bin as i32 - nearest as i32;
    Some(LineReading { bin, offset, amplitude: bins[bin], noise: median })
}

/// Returns whether two frequencies (Hz) cannot be separated: nearer than the main lobe and the searched bins.
pub fn overlap(one: f64, other: f64, bin_width: f64) -> bool {
    (one - other).abs() < LOBE as f64 * bin_width
}

/// Defect lines of the bearing to which a channel belongs, or of all bearings.
pub fn lines_for<'l>(
    lines: &'l [BearingLines],
    channel: &str,
) -> impl Iterator<Item = &'l DefectLine> {
    let of = |of: &&BearingLines| !of.prefix.is_empty() && channel.starts_with(&of.prefix);
    let own = lines.iter().position(|bearing| of(&bearing));
    let own = own.map_or(lines, |own| &lines[own..=own]);
    own.iter().flat_map(|bearing| &bearing.lines)
}
