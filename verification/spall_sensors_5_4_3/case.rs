//! Which sensors have a line of a spall: accelerometers around the outer race, and the telemeter on the cage.

use bearing_dynamics::output::spectrum::{Spectrum, spectrum};

use crate::bushings::order;
use crate::cage_bearing::{kinematics, nominal_ratio, rolling};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::RPM;
use crate::solids::largest;

use lines::{Taken, amplitudes, figures, mean, over_noise, ratios, reading, smallest, take};

mod lines;

pub const CASE: Case = Case {
    id: "spall_sensors_5_4_3",
    title: "Spall in the outer race: accelerometers and telemeter",
    section: "5.4.3, 5.4.4, Figs. 5.30 and 5.32 to 5.34",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

/// Of 5.4.3, rpm.
const SPEED: f64 = 1800.0;
const SHAFT: f64 = SPEED / 60.0;
const BALLS: f64 = 11.0;
/// Line over the median of the 60 bins around, from which on it counts as found.
const FOUND: f64 = 4.0;
const FOUND_REASON: &str =
    "of noise, the highest of three bins exceeds four medians once in 20 000 readings";
const ROLLING: &str = "balls times cage speed by pure rolling at the contact angles under load";
const ACCELEROMETERS: [&str; 4] = ["at_90", "at_45", "at_minus_45", "at_0"];

/// The highest line within `reach` (Hz) of an expected one.
fn frequency(
    context: &mut CaseContext,
    (id, text): (&str, &str),
    of: &Spectrum,
    (expected, reach): (f64, f64),
) {
    let bin = |frequency: f64| (frequency / of.bin_width).round().max(0.0) as usize;
    let range = bin(expected - reach)..=bin(expected + reach);
    let highest = range.max_by(|a, b| of.amplitude[*a].total_cmp(&of.amplitude[*b]));
    let found = highest.map_or(f64::NAN, |bin| bin as f64 * of.bin_width);
    context.check(
        Check::new(id, text, "Hz", found)
            .independent(expected, ROLLING)
            .absolute(of.bin_width, "one bin of the spectrum"),
    );
}

/// A line that the source says is found, or is not.
fn found(
    context: &mut CaseContext,
    (id, text): (&str, &str),
    ratio: f64,
    (section, sentence, is_there): (&str, &str, bool),
) {
    let check = Check::new(id, text, "1", ratio).stated(FOUND, section, sentence);
    context.check(match is_there {
        true => check.at_least(0.0, FOUND_REASON),
        false => check.at_most(0.0, FOUND_REASON),
    });
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for (name, text, value) in [
        (
            "scene",
            "all that 5.4.1 omits is as in scenes/cage_600rpm.toml; the cage is rigid",
            "scenes/spall_sensors.toml",
        ),
        (
            "spall_size",
            "the source states the radii of the spall, 6 and 1 mm, but no length and width",
            "0.8 mm long, 4 mm wide",
        ),
        (
            "contact_damping",
            "none is stated; without it balls vibrate from one pass to the next",
            "Hunt and Crossley, 0.3 s/m",
        ),
        (
            "sensors",
            "the source's accelerometers are on the housing, whose mass is not stated",
            "on the outer race",
        ),
        ("runout", "no runout of the shaft is stated", "eccentricity 2 µm"),
        (
            "transceiver",
            "the transceiver's offset in the bearing is not stated",
            "1.27 mm, along Y or along Z; cage loop 0.1 mm off the cage's axis",
        ),
    ] {
        context.assumption(name, text, value);
    }
    let speed = SPEED * RPM;
    let cage = kinematics(&rolling(speed)?, speed)?.ratio * SHAFT;
    let bpfo = BALLS * cage;
    context.finding(
        "nominal",
        format!(
            "BPFO is {bpfo:.2} Hz at the contact angles under load, {:.2} Hz at the nominal one.",
            BALLS * nominal_ratio() * SHAFT
        ),
    );
    let main = take(&[("numerics.end", "1.3 s"), ("output.window_start", "0.3 s")])?;
    accelerometers(context, &main, cage, bpfo)?;
    let telemeters = take(&[
        ("numerics.end", "8.3 s"),
        ("output.window_start", "0.3 s"),
        ("numerics.output_interval", "0.15 ms"),
    ])?;
    telemeter(context, &telemeters, cage, bpfo)?;
    variants(context, &main, bpfo)?;
    figures(context, &main, &telemeters, bpfo)
}

/// 5.4.4, Figs. 5.32 to 5.34.
fn accelerometers(
    context: &mut CaseContext,
    taken: &Taken,
    cage: f64,
    bpfo: f64,
) -> Result<(), CaseError> {
    const LINES: u32 = 4;
    let top = taken.accelerations("at_90")?;
    for line in 1..=LINES {
        let names = (format!("bpfo_{line}"), format!("accelerometer at 90°, line {line} of BPFO"));
        frequency(context, (&names.0, &names.1), top, (f64::from(line) * bpfo, 10.0));
    }
    let mut heights = Vec::new();
    let mut cage_lines = Vec::new();
    for sensor in ACCELEROMETERS {
        let of = taken.accelerations(sensor)?;
        heights.push(amplitudes(of, bpfo, LINES)?);
        cage_lines.extend(over_noise(of, cage, 2)?);
    }
    let [at_90, at_45, at_minus_45, at_0] = &heights[..] else {
        return Err(CaseError::message("four accelerometers"));
    };
    for (sensor, text, sentence, is_there) in [
        ("at_90", "90°", "the accelerometer along 90° detected a dominant BPFO frequency", true),
        ("at_45", "45°", "the ones along ±45° have also detected the BPFO frequency", true),
        ("at_minus_45", "−45°", "the ones along ±45° have also detected the BPFO frequency", true),
        (
            "at_0",
            "0°",
            "the accelerometer along 0° was not able to discern the BPFO frequency from noises",
            false,
        ),
    ] {
        let ratios = over_noise(taken.accelerations(sensor)?, bpfo, 3)?;
        let (which, ratio) = match is_there {
            true => ("smallest", smallest(&ratios)),
            false => ("largest", largest(ratios)),
        };
        let text = format!("{which} of lines 1 to 3 of BPFO over the noise around, {text}");
        found(context, (&format!("found_{sensor}"), &text), ratio, ("5.4.4", sentence, is_there));
    }
    let others = [at_45, at_minus_45, at_0].map(|other| largest(ratios(other, at_90)));
    order(
        context,
        "5.4.4",
        "90° has a dominant line; ±45° have it with a reduced signal amplitude",
        &[(
            "reduced",
            "one less the largest ratio of lines 1 to 4, other angles over 90°",
            1.0 - largest(others),
        )],
    );
    for (id, text, side) in [("sine_45", "45°", at_45), ("sine_minus_45", "−45°", at_minus_45)]
    {
        context.check(
            Check::new(
                id,
                &format!("mean ratio of lines 1 to 4, {text} over 90°"),
                "1",
                mean(&ratios(side, at_90)),
            )
            .closed_form(0.5f64.sqrt(), "a race that vibrates along Z alone: sine of the angle")
            .absolute(
                0.03,
                "at BPFO the race moves less than 2 % as far along Y; noise of a tenth of line 1",
            ),
        );
    }
    context.check(
        Check::new(
            "equal_45",
            "mean ratio of lines 1 to 4, −45° over 45°",
            "1",
            mean(&ratios(at_minus_45, at_45)),
        )
        .closed_form(1.0, "the spall is at the same angle from both")
        .absolute(0.05, "twice the motion along Y; halves of the window are in the table"),
    );
    found(
        context,
        (
            "no_cage_line",
            "largest of lines 1 and 2 of the cage over the noise around, four accelerometers",
        ),
        largest(cage_lines),
        (
            "5.4.4",
            "the accelerometers were not able to detect any signals related to the cage",
            false,
        ),
    );
    let [y, z] = [taken.spectrum("outer_y")?, taken.spectrum("outer_z")?];
    let [y, z] = [reading(y, bpfo)?.amplitude, reading(z, bpfo)?.amplitude];
    // The cage's motion is chaotic: halves of the window differ by a tenth.
    context.golden("bpfo, z", z, "m", GoldenTolerance { relative: 0.1, absolute: 0.0 });
    order(
        context,
        "5.4.4, Fig. 5.34",
        "the vibration of the outer race is much larger along Z",
        &[("z_over_y", "line at BPFO, outer race, z over y, less ten", z / y - 10.0)],
    );
    halves(context, taken, bpfo)
}

/// Line 1 of both halves of the window.
fn halves(context: &mut CaseContext, taken: &Taken, bpfo: f64) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    for sensor in ACCELEROMETERS {
        let values = taken.table.windowed(&format!("{sensor}_acceleration")).unwrap_or_default();
        let mut row = vec![sensor.to_string()];
        for half in values.chunks_exact(values.len() / 2) {
            let of =
                spectrum(half, taken.interval).ok_or_else(|| CaseError::message("too few rows"))?;
            row.extend(amplitudes(&of, bpfo, 2)?.iter().map(|line| format!("{line:.4}")));
        }
        row.extend(
            amplitudes(taken.accelerations(sensor)?, bpfo, 2)?
                .iter()
                .map(|line| format!("{line:.4}")),
        );
        row.extend(
            over_noise(taken.accelerations(sensor)?, bpfo, 2)?
                .iter()
                .map(|ratio| format!("{ratio:.1}")),
        );
        rows.push(row);
    }
    context.table(
        "halves",
        "Lines 1 and 2 of BPFO, m/s², in the halves of the window and in all of it, and over the noise around",
        &["accelerometer", "1, first half", "2, first half", "1, second half", "2, second half", "1", "2", "1 over noise", "2 over noise"],
        rows,
    );
    Ok(())
}

/// 5.4.3, Fig. 5.30.
fn telemeter(
    context: &mut CaseContext,
    taken: &Taken,
    cage: f64,
    bpfo: f64,
) -> Result<(), CaseError> {
    let sentence = "besides cage and shaft speed, BPFO was detected";
    let [y, z] = ["telemeter_y_reflection", "telemeter_z_reflection"];
    for (id, axis, channel) in [("telemeter_y_cage", "Y", y), ("telemeter_z_cage", "Z", z)] {
        let of = taken.spectrum(channel)?;
        let text = format!("telemeter with its offset along {axis}, line of the cage");
        frequency(context, (&format!("{id}_frequency"), &text), of, (cage, 1.0));
        let ratio = over_noise(of, cage, 1)?[0];
        found(
            context,
            (id, &format!("{text} over the noise around")),
            ratio,
            ("5.4.3", sentence, true),
        );
    }
    let of = taken.spectrum(z)?;
    for line in 1..=3 {
        let names = (
            format!("telemeter_z_bpfo_{line}_frequency"),
            format!("telemeter with its offset along Z, line {line} of BPFO"),
        );
        frequency(context, (&names.0, &names.1), of, (f64::from(line) * bpfo, 5.0));
    }
    let [across, along] = [over_noise(taken.spectrum(y)?, bpfo, 3)?, over_noise(of, bpfo, 3)?];
    found(
        context,
        (
            "telemeter_z_bpfo",
            "smallest of lines 1 to 3 of BPFO over the noise around, offset along Z",
        ),
        smallest(&along),
        ("5.4.3", sentence, true),
    );
    let heights = [amplitudes(taken.spectrum(y)?, bpfo, 3)?, amplitudes(of, bpfo, 3)?];
    let list =
        |ratios: &[f64]| ratios.iter().map(|r| format!("{r:.1}")).collect::<Vec<_>>().join(", ");
    context.finding(
        "telemeter_direction",
        format!(
            "With the transceiver's offset along Z, the direction of the spall, lines 1 to 3 of BPFO are {} times the noise around. With the offset \
             along Y they are {} times that noise, and lower by factors of {}. The signal follows the cage's displacement along the offset to first order \
             and across it to second order only. The source's telemeter measures along all directions simultaneously; a single \
             transceiver of this model does not.",
            list(&along),
            list(&across),
            list(&ratios(&heights[1], &heights[0])),
        ),
    );
    // A line as high as that of the cage stands for the 0.1 mm by which the cage's loop is off its axis.
    let of = taken.spectrum(y)?;
    let at_shaft = reading(of, SHAFT)?;
    let noise = at_shaft.noise.unwrap_or(f64::NAN);
    let least = FOUND * noise / reading(of, cage)?.amplitude * 100.0;
    let moved = 1e6 * reading(taken.spectrum("outer_y")?, SHAFT)?.amplitude;
    context.finding(
        "telemeter_shaft",
        format!(
            "Not found: the source's line at shaft frequency, {:.1} times the noise around. The cage, whose contacts have no \
             damping, does not come to rest: to be found, it would have to move by {least:.1} µm at that frequency relative to \
             the outer race. An eccentricity of the shaft of 2 µm moves the outer race, on which cage and transceiver are, by {moved:.2} µm.",
            at_shaft.amplitude / noise
        ),
    );
    Ok(())
}

/// Smooth races, a softer foundation, no contact damping.
fn variants(context: &mut CaseContext, main: &Taken, bpfo: f64) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    let mut row = |name: &str, taken: &Taken| -> Result<[Vec<f64>; 2], CaseError> {
        let [y, z] =
            ["outer_y", "outer_z"].map(|channel| amplitudes(taken.spectrum(channel)?, bpfo, 3));
        let (y, z) = (y?, z?);
        let noise =
            ["at_90", "at_0"].map(|sensor| over_noise(taken.accelerations(sensor)?, bpfo, 3));
        let mut cells =
            vec![name.to_string(), format!("{:.3}", 1e9 * z[0]), format!("{:.0}", z[0] / y[0])];
        for ratios in noise {
            cells.push(
                ratios?.iter().map(|ratio| format!("{ratio:.1}")).collect::<Vec<_>>().join(", "),
            );
        }
        rows.push(cells);
        Ok([y, z])
    };
    let [_, spalled] = row("as in the scene", main)?;
    let smooth = take(&[("bearing.spall.1.length", "0 mm")])?;
    let [_, without] = row("no spall", &smooth)?;
    let soft = take(&[
        ("outer_race.foundation.stiffness.y", "3e7 N/m"),
        ("outer_race.foundation.stiffness.z", "3e7 N/m"),
    ])?;
    let [soft_y, soft_z] = row("foundation of 3e7 N/m instead of 1e8 N/m", &soft)?;
    let undamped = take(&[("contact_damping.law", "none")])?;
    row("no contact damping", &undamped)?;
    context.check(
        Check::new(
            "smooth",
            "largest ratio of lines 1 to 3 of BPFO, outer race, z, no spall over spall",
            "1",
            largest(ratios(&without, &spalled)),
        )
        .closed_form(0.0, "without a spall the races are smooth")
        .absolute(
            0.05,
            "noise of the cage; the balls' weight, 0.1 % of their load, passes at BPFO",
        ),
    );
    order(
        context,
        "5.4.4, Fig. 5.34",
        "the vibration of the outer race is much larger along Z",
        &[(
            "z_over_y_soft",
            "line at BPFO, z over y, less ten, softer foundation",
            soft_z[0] / soft_y[0] - 10.0,
        )],
    );
    context.table(
        "variants",
        "Outer race and accelerometers at BPFO; bins of 1 Hz in the first row, of 2 Hz below",
        &[
            "variant",
            "line 1, z, nm",
            "z over y",
            "lines 1 to 3 at 90° over noise",
            "at 0° over noise",
        ],
        rows,
    );
    Ok(())
}
