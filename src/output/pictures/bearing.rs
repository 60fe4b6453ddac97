//! Plots of a run with bearings.

use crate::numeric::clock::to_digits;
use crate::output::defect_lines::{BearingLines, DefectLine, lines_for};
use crate::output::plots::{
    Axis, Curve, Mark, OrbitPlot, PlotError, PolarPlot, Style, XyPlot, orbit, polar, xy, xy_marked,
};
use crate::output::run_up::{Turn, turns};
use crate::output::spectrum::{MAIN_LOBE, SIDE_LOBES, Spectrum, WINDOW};
use crate::output::table::{Moving, RunTable};

/// Plots that a run can draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Displacements of races and cage, loads of the most loaded ball and energy residual over time.
    Series,
    /// Races and cage in the Y–Z plane, over the window.
    Orbit,
    /// Amplitude spectra of races and cage, over the window.
    Spectrum,
    /// Slip and spin of a ball's contacts over its azimuth, as in Figs 3.32 and 3.33.
    SlipSpin,
    /// Normal load over ball azimuth, as in Fig. 3.31.
    Polar,
    /// Distance of races, bodies and sections from the axis over their speed, as in Fig. 4.19, and their amplitudes.
    RunUp,
}

/// Number of points of a thinned curve: two per pixel.
pub(super) const POINTS: usize = 1500;
/// Sector of azimuth over which the loads of all balls are averaged for the polar plot, deg.
const SECTOR: usize = 3;
/// Relative change below which a speed is constant.
const STEADY: f64 = 0.05;
/// Change relative to the fastest speed below which it is rounding.
const ROUNDING: f64 = 1e-9;
/// Amplitude relative to the highest below which bins are rounding and not drawn.
const SPECTRUM_FLOOR: f64 = 1e-9;

/// File names and SVG text of a plot. Parts whose channels were not recorded, or that have no row yet, are omitted.
///
/// # Errors
/// A value that is not finite.
pub fn draw(
    picture: Picture,
    title: &str,
    table: &RunTable,
) -> Result<Vec<(String, String)>, PlotError> {
    match picture {
        Picture::Series => series(title, table),
        Picture::Orbit => orbits(title, table),
        Picture::Spectrum => spectra(title, table),
        Picture::SlipSpin => each_bearing(title, table, slip_spin),
        Picture::Polar => each_bearing(title, table, loads_over_azimuth),
        Picture::RunUp => run_ups(title, table),
    }
}

/// Point of a curve; values below 1e-150, left by decayed vibrations, are drawn as zero.
fn point(x: f64, y: f64) -> [f64; 2] {
    [x, y].map(|value| if value.abs() < 1e-150 { 0.0 } else { value })
}

/// Curves `[time, scale · value]` of the recorded channels.
pub(super) fn over_time(table: &RunTable, channels: &[(&str, &str)], scale: f64) -> Vec<Curve> {
    let Some(times) = table.all("time").filter(|times| !times.is_empty()) else {
        return Vec::new();
    };
    let curve = |&(channel, name): &(&str, &str)| {
        let values = table.all(channel)?;
        let points = times.iter().zip(values).map(|(&t, value)| point(t, scale * value)).collect();
        Some(Curve::new(name, thin(points, POINTS)))
    };
    channels.iter().filter_map(curve).collect()
}

fn series(title: &str, table: &RunTable) -> Result<Vec<(String, String)>, PlotError> {
    let displacement = ["x", "y", "z"];
    let mut drawn = Vec::new();
    for Moving { column: body, title: name, .. } in &table.bodies {
        let channels = displacement.map(|axis| (format!("{body}_{axis}"), axis));
        let channels = channels.each_ref().map(|(channel, axis)| (channel.as_str(), *axis));
        let curves = over_time(table, &channels, 1e6);
        let file = format!("series_{}.svg", name.replace(' ', "_"));
        add_series(&mut drawn, file, format!("{title}: {name}"), "displacement", "um", curves)?;
    }
    for prefix in &table.bearings {
        let ball = most_loaded(table, prefix);
        let loads = [
            (format!("ball_{ball}_inner_load"), format!("ball {ball} on inner race")),
            (format!("ball_{ball}_outer_load"), format!("ball {ball} on outer race")),
            (format!("ball_{ball}_pocket_load"), format!("ball {ball} in its pocket")),
            ("cage_guide_load".into(), "cage on its guide".into()),
        ];
        let loads = loads.map(|(channel, name)| (format!("{prefix}{channel}"), name));
        let loads = loads.each_ref().map(|(channel, name)| (channel.as_str(), name.as_str()));
        let curves = over_time(table, &loads, 1.0);
        let heading = format!("{title}: {}loads, most loaded ball", prefix.replace('_', " "));
        let file = format!("series_{prefix}loads.svg");
        add_series(&mut drawn, file, heading, "normal load", "N", curves)?;
    }
    for sensor in &table.sensors {
        let (name, column) = (&sensor.name, &sensor.column);
        let curves = over_time(table, &[(column, name)], 1.0);
        let (file, heading) = (format!("series_sensor_{name}.svg"), format!("{title}: {name}"));
        add_series(&mut drawn, file, heading, sensor.quantity(), table.unit(column), curves)?;
    }
    let residuals =
        [("energy_coupled_residual", "of all parts"), ("energy_residual", "of bearings")];
    let curves = over_time(table, &residuals, 1.0);
    let heading = format!("{title}: energy residual");
    add_series(&mut drawn, "series_energy.svg".into(), heading, "energy", "J", curves)?;
    let names = table.works();
    let works: Vec<(&str, &str)> =
        names.iter().map(|name| (name.as_str(), name.as_str())).collect();
    let heading = format!("{title}: work and heat since the start");
    let curves = over_time(table, &works, 1.0);
    add_series(&mut drawn, "series_work.svg".into(), heading, "energy", "J", curves)?;
    Ok(drawn)
}

/// Number of the ball with the largest load on a race in all rows; 1 without loads.
fn most_loaded(table: &RunTable, prefix: &str) -> usize {
    let largest = |ball: usize| {
        let races = ["inner", "outer"];
        let loads = races.map(|race| table.all(&format!("{prefix}ball_{ball}_{race}_load")));
        let largest = |load: Vec<f64>| load.into_iter().fold(0.0, f64::max);
        loads.into_iter().flatten().map(largest).reduce(f64::max)
    };
    let balls = (1..).map_while(|ball| Some((ball, largest(ball)?)));
    balls.reduce(|most, next| if next.1 > most.1 { next } else { most }).map_or(1, |most| most.0)
}

pub(super) fn add_series(
    drawn: &mut Vec<(String, String)>,
    file: String,
    title: String,
    quantity: &str,
    unit: &str,
    curves: Vec<Curve>,
) -> Result<(), PlotError> {
    if curves.is_empty() {
        return Ok(());
    }
    let (x, y) = (Axis::linear("time", "s"), Axis::linear(quantity, unit));
    drawn.push((file, xy(&XyPlot { title, x, y, style: Style::Lines, curves })?));
    Ok(())
}

fn orbits(title: &str, table: &RunTable) -> Result<Vec<(String, String)>, PlotError> {
    let mut drawn = Vec::new();
    for Moving { column: body, title: name, .. } in &table.bodies {
        let path = [format!("{body}_y"), format!("{body}_z")];
        let (Some(y), Some(z)) = (table.windowed(&path[0]), table.windowed(&path[1])) else {
            continue;
        };
        if y.is_empty() {
            continue;
        }
        let every = y.len().div_ceil(4 * POINTS).max(1);
        let points =
            y.iter().zip(&z).map(|(y, z)| point(1e6 * y, 1e6 * z)).step_by(every).collect();
        let svg = orbit(&OrbitPlot {
            title: format!("{title}: orbit of the {name}"),
            unit: "um".into(),
            curves: vec![Curve::new(format!("{name}, marker at the end"), points)],
        })?;
        drawn.push((format!("orbit_{}.svg", name.replace(' ', "_")), svg));
    }
    Ok(drawn)
}

/// Speeds, in all rows, of the bodies whose speed changes by more than [`STEADY`] and by more than rounding of the
/// fastest.
fn changing_speeds(table: &RunTable) -> Vec<(&Moving, Vec<f64>)> {
    let bodies = table.bodies.iter();
    let all: Vec<_> = bodies.filter_map(|body| Some((body, table.all(&body.speed)?))).collect();
    let top = |speed: &[f64]| speed.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    let fastest = all.iter().map(|(_, speed)| top(speed)).fold(0.0, f64::max);
    let changes = |speed: &[f64]| {
        let end = |of: fn(f64, f64) -> f64| speed.iter().copied().reduce(of).unwrap_or(0.0);
        let rise = end(f64::max) - end(f64::min);
        rise > STEADY * top(speed) && rise > ROUNDING * fastest
    };
    all.into_iter().filter(|(_, speed)| changes(speed)).collect()
}

/// Warning that run-up plots were requested but no speed changes.
pub fn without_run_up(table: &RunTable) -> Option<String> {
    changing_speeds(table).is_empty().then(|| {
        format!(
            "output.plots: `run-up` draws nothing, because no race, body or cage changes its speed by more than {:.0} %; give \
             a speed that rises, such as {{ ramp = [\"0 rpm\", \"3000 rpm\"], start = \"0 s\", duration = \"1 s\" }}",
            100.0 * STEADY
        )
    })
}

/// Run-up plots of all bodies whose speed changes.
fn run_ups(title: &str, table: &RunTable) -> Result<Vec<(String, String)>, PlotError> {
    let mut drawn = Vec::new();
    for (Moving { column, title: name, .. }, speed) in changing_speeds(table) {
        let (y, z) = (table.all(&format!("{column}_y")), table.all(&format!("{column}_z")));
        let (Some(y), Some(z)) = (y, z) else { continue };
        let rpm = 60.0 / std::f64::consts::TAU;
        let points = speed.iter().zip(y.iter().zip(&z));
        let points = points.map(|(speed, (y, z))| point(rpm * speed, 1e6 * libm::hypot(*y, *z)));
        let svg = xy(&XyPlot {
            title: format!("{title}: run-up of the {name}"),
            x: Axis::linear("speed", "rpm"),
            y: Axis::linear("distance from the axis", "um"),
            style: Style::Lines,
            curves: vec![Curve::new(name.clone(), thin(points.collect(), POINTS))],
        })?;
        let file = name.replace(' ', "_");
        drawn.push((format!("run_up_{file}.svg"), svg));
        let mut curves = Vec::new();
        for (axis, values) in [("Y", &y), ("Z", &z)] {
            let turns = turns(&speed, values, table.interval);
            let of = |value: fn(&Turn) -> f64| {
                let points = turns.iter().map(|of| point(rpm * of.speed, 1e6 * value(of)));
                thin(points.collect(), POINTS)
            };
            if !turns.is_empty() {
                let half = of(|of| of.half_peak_to_peak);
                curves.push(Curve::new(format!("{axis}, half peak-to-peak"), half));
                curves.push(Curve::new(format!("{axis}, 1X"), of(|of| of.once_per_turn)));
            }
        }
        if curves.is_empty() {
            continue;
        }
        let svg = xy(&XyPlot {
            title: format!("{title}: amplitude of the {name} over its speed"),
            x: Axis::linear("speed", "rpm"),
            y: Axis::linear("amplitude over a turn", "um"),
            style: Style::Lines,
            curves,
        })?;
        drawn.push((format!("run_up_amplitude_{file}.svg"), svg));
    }
    Ok(drawn)
}

fn spectra(title: &str, table: &RunTable) -> Result<Vec<(String, String)>, PlotError> {
    let spectra = table.spectra();
    let Some((_, first)) = spectra.first() else { return Ok(Vec::new()) };
    let axis_of = |spectrum: &Spectrum| {
        let bin = to_digits(spectrum.bin_width, 4);
        format!(
            "frequency ({WINDOW} window, bin {bin} Hz, main lobe {MAIN_LOBE} bins, side lobes {SIDE_LOBES} dB)"
        )
    };
    let axis = axis_of(first);
    let lines = table.defect_lines();
    let mut drawn = Vec::new();
    for Moving { column: body, title: name, .. } in &table.bodies {
        let mut curves = Vec::new();
        for (channel, spectrum) in &spectra {
            let own = channel.strip_prefix(body.as_str()).and_then(|c| c.strip_prefix('_'));
            let Some(coordinate) = own.filter(|axis| axis.len() == 1) else { continue };
            curves.extend(lines_of(coordinate, spectrum, 1e6));
        }
        let what = format!("the {name}");
        let marks = marks(&lines, body);
        add_spectrum(&mut drawn, (title, &what, name), &axis, ("amplitude", "um"), curves, &marks)?;
    }
    for sensor in &table.sensors {
        let (name, unit) = (&sensor.name, table.unit(&sensor.column));
        let marks = marks(&lines, &sensor.column);
        let filter = sensor.acquisition.low_pass;
        let filter = filter.map(|cut_off| format!(", low-pass at {} Hz", to_digits(cut_off, 4)));
        let filter = filter.unwrap_or_default();
        let spectrum_of = |wanted: &str| spectra.iter().find(|(channel, _)| channel == wanted);
        let mut add = |channel: &str, what: &str, file: String, quantity: String| {
            let Some((_, spectrum)) = spectrum_of(channel) else { return Ok(()) };
            let curves = lines_of(name, spectrum, 1.0).into_iter().collect();
            let axis = axis_of(spectrum);
            let what = format!("{what}{filter}");
            add_spectrum(
                &mut drawn,
                (title, &what, &file),
                &axis,
                (&quantity, unit),
                curves,
                &marks,
            )
        };
        add(&sensor.column, name, format!("sensor_{name}"), sensor.quantity().into())?;
        let Some([low, high]) = sensor.acquisition.envelope_band else { continue };
        let [low, high] = [low, high].map(|frequency| to_digits(frequency, 4));
        let what = format!("the envelope of {name}, {low} to {high} Hz");
        let quantity = format!("envelope of {}", sensor.quantity());
        add(&sensor.envelope(), &what, format!("envelope_{name}"), quantity)?;
    }
    Ok(drawn)
}

/// Defect lines for the spectrum of a channel: of its bearing, or of all bearings. The lowest orders first.
fn marks(lines: &[BearingLines], channel: &str) -> Vec<Mark> {
    let mut lines: Vec<&DefectLine> = lines_for(lines, channel).collect();
    lines.sort_by_key(|line| line.order);
    lines.into_iter().map(|line| Mark { at: line.frequency, label: line.label() }).collect()
}

/// Amplitudes times `scale` over frequency, without bins that are rounding.
fn lines_of(name: &str, spectrum: &Spectrum, scale: f64) -> Option<Curve> {
    let highest = spectrum.amplitude.iter().copied().fold(0.0, f64::max);
    let bins = spectrum.amplitude.iter().enumerate().skip(1);
    let points: Vec<[f64; 2]> = bins
        .filter(|(_, amplitude)| **amplitude > SPECTRUM_FLOOR * highest)
        .map(|(bin, amplitude)| [bin as f64 * spectrum.bin_width, scale * amplitude])
        .collect();
    // Low frequencies take the most room on a logarithmic axis; they are drawn bin by bin.
    let (low, high) = points.split_at(points.len().min(POINTS));
    let points = [low.to_vec(), thin(high.to_vec(), 3 * POINTS)].concat();
    (!points.is_empty()).then(|| Curve::new(name, points))
}

/// `title`, description and file name part of the spectrum; quantity and unit of the amplitudes.
fn add_spectrum(
    drawn: &mut Vec<(String, String)>,
    (title, what, name): (&str, &str, &str),
    frequency: &str,
    (quantity, unit): (&str, &str),
    curves: Vec<Curve>,
    marks: &[Mark],
) -> Result<(), PlotError> {
    if curves.is_empty() {
        return Ok(());
    }
    let plot = XyPlot {
        title: format!("{title}: spectrum of {what}"),
        x: Axis::log(frequency, "Hz"),
        y: Axis::log(quantity, unit),
        style: Style::Lines,
        curves,
    };
    let svg = xy_marked(&plot, marks)?;
    drawn.push((format!("spectrum_{}.svg", name.replace(' ', "_")), svg));
    Ok(())
}

/// Azimuth of ball `ball` at every row of the window, 0 to 360 deg.
fn azimuths(table: &RunTable, prefix: &str, ball: usize) -> Option<Vec<f64>> {
    let angles = table.windowed(&format!("{prefix}ball_{ball}_angle"))?;
    Some(angles.into_iter().map(|angle| angle.rem_euclid(360.0)).collect())
}

/// Plots of each bearing; with several bearings, file names and titles contain the bearing's name.
fn each_bearing(
    title: &str,
    table: &RunTable,
    of: impl Fn(&str, &RunTable, &str) -> Result<Vec<(String, String)>, PlotError>,
) -> Result<Vec<(String, String)>, PlotError> {
    let mut drawn = Vec::new();
    for prefix in &table.bearings {
        let Some(name) = prefix.strip_suffix('_') else {
            drawn.extend(of(title, table, prefix)?);
            continue;
        };
        for (file, svg) in of(&format!("{title}, {name}"), table, prefix)? {
            drawn.push((file.replace(".svg", &format!("_{name}.svg")), svg));
        }
    }
    Ok(drawn)
}

/// Slip and spin of ball 1 over its last turn, or the part of it in the window. Every ball passes every azimuth.
fn slip_spin(
    title: &str,
    table: &RunTable,
    prefix: &str,
) -> Result<Vec<(String, String)>, PlotError> {
    let Some(angle) = table.windowed(&format!("{prefix}ball_1_angle")) else {
        return Ok(Vec::new());
    };
    let Some(last) = angle.last() else { return Ok(Vec::new()) };
    let over_last_turn = |values: Vec<f64>| {
        let turn = angle.iter().zip(values).filter(|(angle, _)| (**angle - last).abs() < 360.0);
        let mut points: Vec<[f64; 2]> =
            turn.map(|(angle, value)| point(angle.rem_euclid(360.0), value)).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        thin(points, POINTS)
    };
    let mut slip = Vec::new();
    let mut spin = Vec::new();
    for race in ["inner", "outer"] {
        let channel = |part: &str| table.windowed(&format!("{prefix}ball_1_{race}_{part}"));
        let (Some(rolling), Some(transverse), Some(about_normal)) =
            (channel("slip_rolling"), channel("slip_transverse"), channel("spin"))
        else {
            return Ok(Vec::new());
        };
        let size = rolling.iter().zip(&transverse).map(|(a, b)| libm::hypot(*a, *b)).collect();
        let name = format!("ball 1 on {race} race");
        slip.push(Curve::new(name.clone(), over_last_turn(size)));
        spin.push(Curve::new(name, over_last_turn(about_normal)));
    }
    let mut drawn = Vec::new();
    for (file, what, axis, curves) in [
        ("slip.svg", "slip", Axis::linear("slip at the middle of the contact", "m/s"), slip),
        ("spin.svg", "spin", Axis::linear("spin about the contact normal", "rad/s"), spin),
    ] {
        let svg = xy(&XyPlot {
            title: format!("{title}: {what} over azimuth"),
            x: Axis::linear("azimuth", "deg"),
            y: axis,
            style: Style::Lines,
            curves,
        })?;
        drawn.push((file.into(), svg));
    }
    Ok(drawn)
}

/// Normal load of all balls, averaged over sectors of azimuth.
fn loads_over_azimuth(
    title: &str,
    table: &RunTable,
    prefix: &str,
) -> Result<Vec<(String, String)>, PlotError> {
    let sectors = 360 / SECTOR;
    let mut curves = Vec::new();
    for race in ["outer", "inner"] {
        let mut sums = vec![(0.0, 0usize); sectors];
        for ball in 1.. {
            let load = table.windowed(&format!("{prefix}ball_{ball}_{race}_load"));
            let (Some(load), Some(azimuth)) = (load, azimuths(table, prefix, ball)) else { break };
            for (load, azimuth) in load.iter().zip(&azimuth) {
                let (sum, count) = &mut sums[(azimuth / SECTOR as f64) as usize % sectors];
                *sum += load;
                *count += 1;
            }
        }
        let middle = |sector: usize| ((sector as f64 + 0.5) * SECTOR as f64).to_radians();
        let points: Vec<[f64; 2]> = sums
            .iter()
            .enumerate()
            .filter(|(_, (_, count))| *count > 0)
            .map(|(sector, (sum, count))| [middle(sector), sum / *count as f64])
            .collect();
        if !points.is_empty() {
            curves.push(Curve::new(format!("ball on {race} race"), points));
        }
    }
    if curves.is_empty() {
        return Ok(Vec::new());
    }
    let svg = polar(&PolarPlot {
        title: format!("{title}: normal load over ball azimuth"),
        quantity: format!("mean normal load over {SECTOR} deg"),
        unit: "N".into(),
        curves,
    })?;
    Ok(vec![("polar.svg".into(), svg)])
}

/// Thins a curve to about `wanted` points: the lowest and the highest of each segment in their order, so that peaks are
/// preserved.
pub fn thin(points: Vec<[f64; 2]>, wanted: usize) -> Vec<[f64; 2]> {
    if points.len() <= wanted {
        return points;
    }
    let stretch = (2 * points.len()).div_ceil(wanted);
    let mut kept = Vec::with_capacity(wanted + 2);
    for part in points.chunks(stretch) {
        let by_value = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let (Some(low), Some(high)) = (part.iter().min_by(by_value), part.iter().max_by(by_value))
        else {
            continue;
        };
        let (first, second) = if low[0] <= high[0] { (low, high) } else { (high, low) };
        kept.extend([*first, *second]);
    }
    kept
}
