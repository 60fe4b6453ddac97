//! Telemeter of 5.2.1: its laws, and what a run of its scene writes.

use std::f64::consts::TAU;

use bearing_dynamics::ch5_cage::telemeter::{
    Telemeter, copper_resistance, mutual_inductance, natural_frequency,
};
use bearing_dynamics::ch5_cage::telemeter_array::{
    ArrayError, CageLoop, TelemeterArray, Transceiver,
};
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::spectrum::{Peak, peaks, spectrum};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::sensors::SceneSensorKind;

use crate::cage_bearing::CAGE_TELEMETER;
use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{changed_scene, done, request};
use crate::oracles::loops::{anywhere, beside};

pub const CASE: Case = Case {
    id: "telemeter_5_2",
    title: "Telemeter on a cage",
    section: "5.2.1, 5.4.4, 6.2.4",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Half way between the cage's radii of Table 5.3, m.
const RADIUS: f64 = 31.25e-3;
/// 5.2.1.2, m.
const DISTANCE: f64 = 1.78e-3;
const OFFSET: f64 = 1.27e-3;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "circuit",
        "Wire, capacitor and resistance of the telemeter are not stated.",
        "copper wire of 0.15 mm radius with its skin resistance, 100 pF, watched at the natural frequency",
    );
    context.assumption(
        "stroke",
        "The stroke of the table in Fig. 5.10 is not stated.",
        "2.54 mm there and back, a triangular wave",
    );
    laws(context);
    stated(context)?;
    tests_of_motion(context)?;
    table_5_1(context)?;
    several_transceivers(context)?;
    rows(context)
}

/// |S₁₁| of a loop that turns `turns` times a second, 0.1 mm off its axis, while its axis is `aside` (m) off that of the
/// transceiver, `rate` times a second.
fn turning_rows(turns: f64, rate: f64, count: usize, aside: impl Fn(f64) -> f64) -> Vec<f64> {
    let of = telemeter();
    let row = |row: usize| {
        let time = row as f64 / rate;
        let (sin, cos) = (TAU * turns * time).sin_cos();
        of.signal([-DISTANCE, 1e-4 * cos - aside(time), 1e-4 * sin], [1.0, 0.0, 0.0])
    };
    (0..count).map(row).collect()
}

fn highest(rows: &[f64], rate: f64, count: usize) -> Result<Vec<Peak>, CaseError> {
    let lines = spectrum(rows, 1.0 / rate).ok_or_else(|| CaseError::message("no spectrum"))?;
    let found = peaks(&lines, count, 0.0);
    if found.is_empty() { Err(CaseError::message("no line")) } else { Ok(found) }
}

/// Figs 5.3, 5.5 and 5.10.
fn tests_of_motion(context: &mut CaseContext) -> Result<(), CaseError> {
    // Fig. 5.3: least reflection over frequency, 3 mm apart, 0 to 20 mm aside.
    let of = telemeter();
    let least = |aside: f64| {
        let mutual = mutual_inductance(RADIUS, RADIUS, [-3e-3, aside, 0.0], [1.0, 0.0, 0.0]);
        let at = |i: usize| {
            let part = 0.5 + 2.5e-4 * i as f64;
            Telemeter { frequency: part * of.frequency, ..of }.reflection(mutual)
        };
        (0..4000).map(at).fold(f64::INFINITY, f64::min)
    };
    let mutual =
        |aside: f64| mutual_inductance(RADIUS, RADIUS, [-3e-3, aside, 0.0], [1.0, 0.0, 0.0]);
    let asides = [0.0, 5e-3, 10e-3, 15e-3, 20e-3];
    let fall = asides.windows(2).map(|pair| mutual(pair[0]) / mutual(pair[1]));
    context.check(
        Check::new(
            "radial_distance",
            "smallest ratio of mutual inductances 5 mm apart in radial distance, 0 to 20 mm, 3 mm along the axis",
            "1",
            fall.fold(f64::INFINITY, f64::min),
        )
        .stated(1.0, "5.2.1.1", "the signal changes as the radial distance grows from 0 to 20 mm")
        .under("circuit")
        .at_least(0.05, "monotonic; the coupling falls most near the axis distance"),
    );
    let depths = asides.map(|aside| [1e3 * aside, least(aside)]);
    let svg = xy(&XyPlot {
        title: "Least reflection over radial distance".into(),
        x: Axis::linear("radial distance", "mm"),
        y: Axis::linear("least reflection", "1"),
        style: Style::LinesAndMarkers,
        curves: vec![Curve::new("3 mm along the axis", depths.to_vec())],
    })?;
    context.figure(
        "reflection_over_distance",
        svg,
        "What Fig. 5.3 measures; the source prints no values.",
    );

    // Fig. 5.5: the cage on a shaker, 120 Hz along its axis and across it, 0.1 mm, without an offset.
    let rate = 2048.0;
    for (key, axis, order) in [("shaker_axial", 0, 1.0), ("shaker_radial", 1, 2.0)] {
        let row = |row: usize| {
            let mut centre = [-3e-3, 0.0, 0.0];
            centre[axis] += 1e-4 * (TAU * 120.0 * row as f64 / rate).sin();
            of.signal(centre, [1.0, 0.0, 0.0])
        };
        let rows: Vec<f64> = (0..2048).map(row).collect();
        let peak = highest(&rows, rate, 1)?[0];
        let (across, sentence) = match order {
            1.0 => ("along its axis", "the highest peak is at the 120 Hz of the shaker"),
            _ => (
                "across its axis, loops centred",
                "not the motion of the source: its peak is at 120 Hz",
            ),
        };
        let check = Check::new(
            key,
            &format!("frequency of the highest line of a cage that moves at 120 Hz {across}"),
            "Hz",
            peak.frequency,
        );
        context.check(
            match order {
                1.0 => check.stated(120.0, "5.2.1.1", sentence),
                _ => check.closed_form(
                    240.0,
                    "a signal even in the displacement has the double frequency",
                ),
            }
            .absolute(0.02, "a fiftieth of a bin of 1 Hz"),
        );
    }

    // Fig. 5.10: 1200 rpm, and a table that moves there and back at three feed rates.
    let (rate, stroke, cycles) = (128.0, 2.54e-3, 10.0);
    let mut lower = Vec::new();
    for feed in [0.85e-3, 1.69e-3, 3.84e-3] {
        let period = 2.0 * stroke / feed;
        let there_and_back = |time: f64| {
            let part = (time / period).rem_euclid(1.0);
            OFFSET + stroke * (1.0 - (2.0 * part - 1.0).abs())
        };
        let count = (cycles * period * rate) as usize;
        let found = highest(&turning_rows(20.0, rate, count, there_and_back), rate, 40)?;
        let below = found.iter().find(|peak| peak.frequency < 10.0);
        let above = found.iter().find(|peak| peak.frequency > 10.0);
        let (Some(below), Some(above)) = (below, above) else {
            return Err(CaseError::message("no line of feed or of turning"));
        };
        let key = format!("{:.0}", 1e5 * feed);
        context.check(
            Check::new(
                &format!("feed_{key}"),
                &format!(
                    "frequency of the secondary peak over that of the table, {:.2} mm/s",
                    1e3 * feed
                ),
                "1",
                below.frequency * period,
            )
            .stated(1.0, "5.2.1.3", "a secondary peak at low frequency indicates the translation")
            .under("stroke")
            .absolute(0.02, "a fifth of a bin, ten cycles; the line is next to that of the mean"),
        );
        context.check(
            Check::new(
                &format!("turning_{key}"),
                &format!(
                    "frequency of the highest line above 10 Hz, 1200 rpm, {:.2} mm/s",
                    1e3 * feed
                ),
                "Hz",
                above.frequency,
            )
            .stated(20.0, "5.2.1.3", "all spectra have a peak near the frequency of the spindle")
            .under("stroke")
            .absolute(1.6, "near: the feed modulates the line, up to two cycles of the table"),
        );
        lower.push(below.frequency);
    }
    let growth = lower.windows(2).map(|pair| pair[1] / pair[0]).fold(f64::INFINITY, f64::min);
    context.check(
        Check::new(
            "rises_with_feed",
            "smallest growth of the secondary peak's frequency",
            "1",
            growth,
        )
        .stated(1.0, "5.2.1.3", "its frequency increases with the feed rate")
        .under("stroke")
        .at_least(0.5, "feed rates grow by 1.99 and 2.27"),
    );
    Ok(())
}

/// Table 5.1: the telemeter's speeds are multiples of a bin of 0.2034 Hz.
fn table_5_1(context: &mut CaseContext) -> Result<(), CaseError> {
    const BIN: f64 = 0.2034;
    let rate = 256.0;
    let count = (rate / BIN).round() as usize;
    for (input, spindle, gap) in [
        (300, 295.0, None),
        (600, 613.0, Some(-24.6)),
        (900, 940.0, Some(-12.5)),
        (1200, 1260.0, Some(12.0)),
    ] {
        let turns = spindle / 60.0;
        let peak = highest(&turning_rows(turns, rate, count, |_| OFFSET), rate, 1)?[0];
        let id = format!("table_5_1_{input}");
        let interpolated = format!("spindle_{input}");
        context.check(
            Check::new(
                &interpolated,
                &format!("speed of the line of a cage that turns at {spindle} rpm"),
                "rpm",
                60.0 * peak.frequency,
            )
            .stated(spindle, "Table 5.1", "the telemeter measures the speed of the spindle")
            .absolute(0.25, "a fiftieth of a bin of 12.2 rpm"),
        );
        let check = Check::new(
            &id,
            &format!("speed of the highest bin of 0.2034 Hz, spindle at {spindle} rpm"),
            "rpm",
            60.0 * peak.bin_frequency,
        )
        .published(&id)
        .absolute(6.1, "half a bin");
        context.check(match gap {
            None => check,
            Some(gap) => check.explained(Explanation::new(
                "A measurement. Of a steady cage the highest bin is the one nearest to its speed; the printed speed is one or \
                 two bins of 12.2 rpm away. The model of the telemeter adds no error of this kind. The source reports \
                 the difference of both instruments, 1.2 to 3.4 %.",
                gap,
                0.7,
                &[&interpolated],
            )),
        });
    }
    Ok(())
}

/// 6.2.4: six coordinates from twelve transceivers and two loops, and what one loop leaves open.
fn several_transceivers(context: &mut CaseContext) -> Result<(), CaseError> {
    let transceiver = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / 12.0 + 0.1).sin_cos();
        let radius = if i.is_multiple_of(2) { 28e-3 } else { 36e-3 };
        let axis = if i.is_multiple_of(2) { [1.0, 0.0, 0.0] } else { [0.0, cos, sin] };
        Transceiver { centre: [3e-3, radius * cos, radius * sin], axis }
    };
    let loop_at = |radius: f64, centre: [f64; 3]| {
        let (wire_radius, capacitance) = (0.15e-3, 100e-12);
        let frequency = natural_frequency(radius, wire_radius, capacitance);
        let resistance = [radius, 8e-3].map(|of| copper_resistance(of, wire_radius, frequency));
        let circuit = Telemeter {
            radius,
            transceiver_radius: 8e-3,
            wire_radius,
            capacitance,
            resistance,
            frequency,
        };
        CageLoop { circuit, centre }
    };
    let great = loop_at(RADIUS, [0.0; 3]);
    let transceivers: Vec<Transceiver> = (0..12).map(transceiver).collect();
    let both = TelemeterArray {
        loops: vec![great, loop_at(10e-3, [0.0, 22e-3, 0.0])],
        transceivers: transceivers.clone(),
    };
    let one = TelemeterArray { loops: vec![great], transceivers };
    let pose = [1e-4, -2e-4, 1.5e-4, 0.02, -4e-3, 3e-3];
    let wrong = |error: ArrayError| CaseError::message(error.to_string());
    let found = both.estimate(&both.readings(&pose), [0.0; 6]).map_err(wrong)?;
    let error = found.pose.iter().zip(pose).map(|(found, of)| (found - of).abs());
    context.check(
        Check::new(
            "pose",
            "largest error of six coordinates from 24 readings (m, rad)",
            "1",
            error.fold(0.0, f64::max),
        )
        .closed_form(0.0, "the pose from which the readings were computed")
        .under("circuit")
        .absolute(1e-9, "readings are rounded to 1e-12, times the condition number"),
    );
    let blind = one.observability(&[0.0; 6]).map_err(wrong)?;
    let [first, .., last] = blind.singular_values;
    context.check(
        Check::new(
            "one_loop",
            "least over largest singular value of one centred loop",
            "1",
            last / first,
        )
        .closed_form(0.0, "a circle that turns about its own axis is the same circle")
        .absolute(1e-9, "rounding over the steps of the numerical Jacobian"),
    );
    context.finding(
        "conditioning",
        format!(
            "Six coordinates from twelve transceivers and two loops: condition number {:.0}.",
            found.observability.condition
        ),
    );
    Ok(())
}

fn laws(context: &mut CaseContext) {
    for (key, distance, offset) in
        [("coaxial", 3e-3, 0.0), ("near", DISTANCE, OFFSET), ("far", 3e-3, 20e-3)]
    {
        let at = format!("{:.2} mm apart, {:.2} mm aside", 1e3 * distance, 1e3 * offset);
        let ours = mutual_inductance(RADIUS, RADIUS, [-distance, offset, 0.0], [1.0, 0.0, 0.0]);
        context.check(
            Check::new(
                &format!("mutual_{key}"),
                &format!("mutual inductance of two loops of 31.25 mm, {at}"),
                "nH",
                1e9 * ours,
            )
            .closed_form(1e9 * beside(RADIUS, RADIUS, distance, offset), "Grover's integral")
            .relative(
                1e-9,
                "steps round the loops are halved until 1e-12 is left; digits lost in K and E",
            )
            .golden(GoldenTolerance::REORDERED),
        );
    }
}

fn telemeter() -> Telemeter {
    let (wire_radius, capacitance) = (0.15e-3, 100e-12);
    let natural = natural_frequency(RADIUS, wire_radius, capacitance);
    Telemeter {
        radius: RADIUS,
        transceiver_radius: RADIUS,
        wire_radius,
        capacitance,
        resistance: [copper_resistance(RADIUS, wire_radius, natural); 2],
        frequency: natural,
    }
}

/// Largest line (part of the amplitude) of a loop that turns about an axis 0.1 mm beside its centre, and its frequency over that
/// of the turning.
fn turning(offset: f64, direction: f64) -> Result<[f64; 2], CaseError> {
    let of = telemeter();
    // 10 turns, 64 rows a turn.
    let rows: Vec<f64> = (0..640)
        .map(|row| {
            let angle = TAU * row as f64 / 64.0;
            let y = 1e-4 * angle.cos() - offset * direction.cos();
            let z = 1e-4 * angle.sin() - offset * direction.sin();
            of.signal([-DISTANCE, y, z], [1.0, 0.0, 0.0])
        })
        .collect();
    let lines = spectrum(&rows, 1.0 / 64.0).ok_or_else(|| CaseError::message("no spectrum"))?;
    let highest = peaks(&lines, 1, 0.0);
    let peak = highest.first().ok_or_else(|| CaseError::message("no line"))?;
    Ok([peak.amplitude, peak.frequency])
}

/// |S₁₁| of loops about one axis, `distance` (m) apart, at a part of the telemeter's frequency.
fn reflection_at(of: &Telemeter, distance: f64, part: f64) -> f64 {
    let mutual = mutual_inductance(RADIUS, RADIUS, [-distance, 0.0, 0.0], [1.0, 0.0, 0.0]);
    Telemeter { frequency: part * of.frequency, ..*of }.reflection(mutual)
}

/// The sentences of 5.2.1.
fn stated(context: &mut CaseContext) -> Result<(), CaseError> {
    // Least reflection over frequency, 5 mm apart as in Fig. 5.2.
    let of = telemeter();
    let at = |part: f64| reflection_at(&of, 5e-3, part);
    let parts: Vec<f64> = (0..4000).map(|i| 0.5 + 2.5e-4 * i as f64).collect();
    let lowest = parts.iter().copied().min_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap_or(f64::NAN);
    context.check(
        Check::new(
            "least_reflection",
            "frequency of least reflection over the natural one, distance 5 mm",
            "1",
            lowest,
        )
        .stated(1.0, "5.2.1", "the most power is taken near the resonator's natural frequency")
        .under("circuit")
        .absolute(0.2, "near: coupling moves it by half its factor"),
    );
    let mut amplitudes = Vec::new();
    for offset in [0.25, 0.5, 1.0, 2.0].map(|part| part * OFFSET) {
        amplitudes.push(turning(offset, 0.0)?[0]);
    }
    let growth = amplitudes.windows(2).map(|pair| pair[1] / pair[0]).fold(f64::INFINITY, f64::min);
    context.check(
        Check::new(
            "grows_with_offset",
            "smallest growth of the line of turning where the offset doubles",
            "1",
            growth,
        )
        .stated(1.0, "5.2.1.2", "the signal grows with the offset")
        .under("circuit")
        .at_least(0.3, "factor 2 where the offset is small compared with the distance, 1.4 where it is 1.4 distances"),
    );
    let [straight, frequency] = turning(OFFSET, 0.0)?;
    let mut spread: f64 = 0.0;
    for direction in [1.0, 2.5, 4.0] {
        spread = spread.max((turning(OFFSET, direction)?[0] / straight - 1.0).abs());
    }
    context.check(
        Check::new(
            "direction",
            "largest change of that line with the direction of the offset",
            "1",
            spread,
        )
        .stated(0.0, "5.2.1.2", "the signal does not depend on the direction")
        .absolute(1e-9, "loops are round: rounding"),
    );
    context.check(
        Check::new(
            "at_cage_speed",
            "frequency of that line over the speed of the cage",
            "1",
            frequency,
        )
        .stated(1.0, "5.2.1.2", "the dominant line lies at the speed of the cage")
        .absolute(2e-3, "a fiftieth of a bin, ten turns"),
    );
    let points = parts.iter().step_by(4);
    let curve = |distance: f64| {
        let at = |part: &f64| [1e-6 * part * of.frequency, reflection_at(&of, distance, *part)];
        let points = points.clone().map(at).collect();
        Curve::new(format!("{:.0} mm", 1e3 * distance), points)
    };
    let svg = xy(&XyPlot {
        title: "Reflection over frequency".into(),
        x: Axis::linear("frequency", "MHz"),
        y: Axis::linear("reflection", "1"),
        style: Style::Lines,
        curves: [3e-3, 5e-3, 20e-3].map(curve).to_vec(),
    })?;
    context.figure(
        "reflection",
        svg,
        "What Fig. 5.2 measures at 5 mm; the source prints no values.",
    );
    Ok(())
}

/// A run of the scene, its end sooner: every reading against where the columns say that the cage is.
fn rows(context: &mut CaseContext) -> Result<(), CaseError> {
    let scene = changed_scene(
        CAGE_TELEMETER,
        &[
            ("[\"0 rpm\", \"600 rpm\"]", "[\"500 rpm\", \"600 rpm\"]"),
            ("end = \"1.5 s\"", "end = \"12 ms\""),
            ("output_interval = \"0.15 ms\"", "output_interval = \"1 us\""),
            ("window_start = \"0.3 s\"", "window_start = \"1 ms\""),
        ],
    )?;
    let circuit = circuit(&scene)?;
    let session = done(scene.assembly()?, &request(&scene)?)?;
    let series = session.series()?;
    let column = |name: &str| {
        let found = series.column(name).map(|column| column.to_vec());
        found.ok_or_else(|| CaseError::message(format!("no column {name}")))
    };
    let [read, x, y, z] = ["telemeter_reflection", "cage_x", "cage_y", "cage_z"].map(column);
    let (read, cage) = (read?, [x?, y?, z?]);
    let [x, y, z] = ["outer_x", "outer_y", "outer_z"].map(column);
    let outer = [x?, y?, z?];
    let [tilt_y, tilt_z, angle] = ["cage_tilt_y", "cage_tilt_z", "cage_angle"].map(column);
    let (tilt_y, tilt_z, angle) = (tilt_y?, tilt_z?, angle?);
    let (mut worst, mut swing): (f64, [f64; 2]) = (0.0, [f64::INFINITY, f64::NEG_INFINITY]);
    for row in (0..read.len()).step_by(600) {
        let (sin, cos) = angle[row].to_radians().sin_cos();
        let runout = [0.0, 1e-4 * cos, 1e-4 * sin];
        let offset = [3e-3, 1.27e-3, 0.0];
        let centre = [0, 1, 2].map(|i| cage[i][row] - outer[i][row] + runout[i] - offset[i]);
        let [of_y, of_z] = [tilt_y[row], tilt_z[row]].map(f64::to_radians);
        let axis = [of_z.cos() * of_y.cos(), of_z.sin(), -of_z.cos() * of_y.sin()];
        let expected = circuit.reflection(anywhere(RADIUS, RADIUS, centre, axis));
        worst = worst.max((read[row] - expected).abs());
        swing = [swing[0].min(expected), swing[1].max(expected)];
    }
    context.check(
        Check::new(
            "rows",
            "largest error of 21 rows over the change of the signal in 12 ms",
            "1",
            worst / (swing[1] - swing[0]),
        )
        .independent(0.0, "Neumann's double sum where the columns say that the cage is")
        .absolute(
            1e-3,
            "the outer race tilts by about 1e-6, which the columns of the cage do not hold",
        ),
    );
    let [felt, speed, time] = ["top_acceleration", "outer_velocity_z", "time"].map(column);
    let (felt, speed, time) = (felt?, speed?, time?);
    let (mut error, mut largest): (f64, f64) = (0.0, 0.0);
    for row in 1..felt.len() - 1 {
        let mean = (speed[row + 1] - speed[row - 1]) / (time[row + 1] - time[row - 1]);
        error = error.max((felt[row] - mean).abs());
        largest = largest.max(felt[row].abs());
    }
    context.check(
        Check::new("accelerometer", "largest error of the accelerometer over its largest value", "1", error / largest)
            .independent(0.0, "differences of the outer race's velocity over 2 us; rotation of its top adds 1e-6 of that")
            .absolute(0.02, "contacts oscillate with periods of 60 us, and close within a row"),
    );
    Ok(())
}

/// The circuit that the scene's defaults give.
fn circuit(scene: &AssemblyScene) -> Result<Telemeter, CaseError> {
    let of = scene.sensors.iter().find_map(|sensor| match sensor.kind {
        SceneSensorKind::Telemeter { circuit, .. } => Some(circuit),
        SceneSensorKind::Accelerometer { .. } => None,
    });
    of.ok_or_else(|| CaseError::message("no telemeter in the scene"))
}
