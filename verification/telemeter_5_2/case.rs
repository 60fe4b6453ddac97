//! Telemeter of 5.2.1: its laws, and what a run of its scene writes.

use std::f64::consts::TAU;

use bearing_dynamics::ch5_cage::telemeter::{
    Telemeter, copper_resistance, mutual_inductance, natural_frequency,
};
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::spectrum::{peaks, spectrum};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::sensors::SceneSensorKind;

use crate::cage_bearing::CAGE_TELEMETER;
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{changed_scene, done, request};
use crate::oracles::loops::{anywhere, beside};

pub const CASE: Case = Case {
    id: "telemeter_5_2",
    title: "Telemeter on a cage",
    section: "5.2.1, 5.2.1.2, 5.4.4",
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
    laws(context);
    stated(context)?;
    rows(context)
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
