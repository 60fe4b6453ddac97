//! Lines of spalls and waves in the motion of the outer race, and what the source's figure of a spall shows.

use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::spectrum::{Spectrum, spectrum};

use crate::bearings::{ANGULAR_CONTACT, Lengths};
use crate::bushings::order;
use crate::cage_bearing::{CAGE_600RPM, Rolling, kinematics, rolling};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{RPM, changed_scene, column, done, request};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "raceway_profiles",
    title: "Spalls and waves of races and balls: lines of the outer race",
    section: "5.4.3, 5.4.4, Figs. 5.29 and 5.34",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

/// Of 5.4.3, rpm.
const SPEED: f64 = 1800.0;
const BALLS: f64 = 11.0;
/// Between samples, and before the first of them that counts, s.
const SAMPLE: f64 = 50e-6;
const SETTLE: f64 = 0.05;
const END: f64 = 0.35;

/// Displacements of the outer race after settling, m.
struct History {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Energy that no entry names over the largest energy of the contacts.
    residual: f64,
    steps: u64,
}

/// The scene of 5.4.1 at 1800 rpm without its cage, with these profiles.
fn roll(profiles: &str) -> Result<History, CaseError> {
    let cut = |from: &str, to: &str| {
        let start = CAGE_600RPM.find(from)?;
        let end = start + CAGE_600RPM[start..].find(to)?;
        Some(&CAGE_600RPM[start..end])
    };
    let words = || CaseError::message("the shipped scene has other tables");
    let cage = cut("[bearing.cage]", "[inner_race]").ok_or_else(words)?;
    let speed = cut("speed = {", "\n").ok_or_else(words)?;
    let end = format!("end = \"{END} s\"");
    let interval = format!("output_interval = \"{SAMPLE} s\"");
    let damped = "[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"0.3 s/m\"\n\n[numerics]";
    let profiles = format!("{profiles}\n");
    let scene = changed_scene(
        CAGE_600RPM,
        &[
            (cage, profiles.as_str()),
            (speed, &format!("speed = \"{SPEED} rpm\"")),
            ("end = \"3.12144 s\"", end.as_str()),
            ("output_interval = \"10 us\"", interval.as_str()),
            ("integrator = \"rk4\"", "integrator = \"rosenbrock\"\naccuracy = 2e-4"),
            ("[numerics]", damped),
            ("window_start = \"0.5 s\"", "channels = [\"races\", \"energy\"]"),
        ],
    )?;
    let session = done(scene.assembly()?, &request(&scene)?)?;
    let series = session.series()?;
    let from = (SETTLE / SAMPLE).round() as usize;
    let of = |name: &str| -> Result<Vec<f64>, CaseError> {
        Ok(column(&series, name)?.into_iter().skip(from).collect())
    };
    let most = |name: &str| -> Result<f64, CaseError> {
        Ok(largest(column(&series, name)?.into_iter().map(f64::abs)))
    };
    Ok(History {
        x: of("outer_x")?,
        y: of("outer_y")?,
        z: of("outer_z")?,
        residual: most("energy_residual")? / most("energy_contact")?,
        steps: session.motion.bearing().map_or(0, |moving| moving.steps),
    })
}

/// Frequencies by pure rolling at the contact angles under load, Hz.
struct Rates {
    shaft: f64,
    outer: f64,
    inner: f64,
    /// Of the ball about its own axis, relative to its orbit.
    ball: f64,
}

impl Rates {
    fn of(Rolling { ratio, angles, .. }: Rolling) -> Rates {
        let shaft = SPEED / 60.0;
        let Lengths { ball_radius, pitch_radius, .. } = ANGULAR_CONTACT;
        let angle = 0.5 * (angles[0] + angles[1]);
        let gamma = ball_radius / pitch_radius * angle.cos();
        Rates {
            shaft,
            outer: BALLS * ratio * shaft,
            inner: BALLS * (1.0 - ratio) * shaft,
            ball: 0.5 * pitch_radius / ball_radius * (1.0 - gamma * gamma) * shaft,
        }
    }
}

const ROLLING: &str =
    "balls times speed relative to the race, by pure rolling at the angles under load";

fn spectrum_of(values: &[f64]) -> Result<Spectrum, CaseError> {
    spectrum(values, SAMPLE).ok_or_else(|| CaseError::message("too few rows"))
}

/// The highest line within `reach` (Hz) of an expected one.
fn line(
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
            .closed_form(expected, ROLLING)
            .absolute(of.bin_width, "one bin of the spectrum"),
    );
}

/// Lines 1 to 4 of a repetition rate.
fn harmonics(
    context: &mut CaseContext,
    (id, text): (&str, &str),
    values: &[f64],
    (rate, reach): (f64, f64),
) -> Result<(), CaseError> {
    let found = spectrum_of(values)?;
    for harmonic in 1..=4 {
        let at = f64::from(harmonic) * rate;
        let names = (format!("{id}_{harmonic}"), format!("{text}, line {harmonic}"));
        line(context, (&names.0, &names.1), &found, (at, reach * rate));
    }
    Ok(())
}

fn spall(on: &str) -> String {
    format!(
        "[[bearing.spall]]\non = \"{on}\"\nangle = \"270 deg\"\nlength = \"0.8 mm\"\nwidth = \"4 mm\"\n"
    )
}

fn wave(on: &str, order: u32) -> String {
    format!("[[bearing.waviness]]\non = \"{on}\"\norder = {order}\namplitude = \"0.2 um\"\n")
}

fn ledger(context: &mut CaseContext, id: &str, history: &History) {
    context.check(
        Check::new(
            id,
            "energy error over the strain energy of the contacts",
            "1",
            history.residual,
        )
        .closed_form(0.0, "conservation")
        .absolute(5e-3, "steps of an accuracy of 2e-4, some fifty impacts; the error is proportional to the accuracy"),
    );
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for (name, text, value) in [
        (
            "spall_size",
            "the source states the radii of the spall, 6 and 1 mm, but no length and width",
            "0.8 mm long, 4 mm wide",
        ),
        (
            "contact_damping",
            "no contact damping is stated; it is needed for the vibration to decay between passes",
            "Hunt and Crossley, 0.3 s/m",
        ),
        ("no_cage", "left out; the balls keep their distances", "no cage"),
    ] {
        context.assumption(name, text, value);
    }
    let speed = SPEED * RPM;
    let rates = Rates::of(kinematics(&rolling(speed)?, speed)?);

    let outer = roll(&spall("outer"))?;
    ledger(context, "ledger_outer", &outer);
    harmonics(
        context,
        ("bpfo", "spall in the outer race, z of the outer race"),
        &outer.z,
        (rates.outer, 0.4),
    )?;
    let found = [&outer.y, &outer.z].map(|values| spectrum_of(values));
    let [y, z] = found;
    let (y, z) = (y?, z?);
    let bin = (rates.outer / z.bin_width).round() as usize;
    let at = |of: &Spectrum| largest(of.amplitude[bin - 1..=bin + 1].iter().copied());
    context.golden("bpfo, z", at(&z), "m", GoldenTolerance::MIXED.floor(1e-11));
    order(
        context,
        "5.4.4",
        "the bearing outer race vibration was much larger along the +Z direction",
        &[("z_over_y", "line at BPFO, z over y, less three", at(&z) / at(&y) - 3.0)],
    );

    let inner = roll(&spall("inner"))?;
    ledger(context, "ledger_inner", &inner);
    harmonics(
        context,
        ("bpfi", "spall in the inner race, x of the outer race"),
        &inner.x,
        (rates.inner, 0.4),
    )?;
    // Radially the spall rotates with the shaft.
    let radial = spectrum_of(&inner.z)?;
    for (id, sign) in [("bpfi_below", -1.0), ("bpfi_above", 1.0)] {
        let text =
            "spall in the inner race, z of the outer race, beside line 1 by the shaft's speed";
        line(context, (id, text), &radial, (rates.inner + sign * rates.shaft, 0.4 * rates.shaft));
    }

    // In the middle between the tracks of both races, a quarter of a turn away from them.
    let on_ball = "[[bearing.spall]]\non = \"ball\"\nball = 1\nangle = \"90 deg\"\ngroove_angle = \"0 deg\"\nlength = \"2 mm\"\n";
    let ball = roll(on_ball)?;
    ledger(context, "ledger_ball", &ball);
    // Both races meet it once a turn; lines of single turns are in between.
    harmonics(
        context,
        ("ball", "spall on a ball, x of the outer race, twice the ball's speed"),
        &ball.x,
        (2.0 * rates.ball, 0.2),
    )?;

    let orders = [("outer", 11), ("outer", 12), ("inner", 10), ("inner", 11), ("inner", 12)];
    let waves: Vec<String> = orders.iter().map(|(on, order)| wave(on, *order)).collect();
    let waved = roll(&waves.concat())?;
    ledger(context, "ledger_waves", &waved);
    let (axial, radial) = (spectrum_of(&waved.x)?, spectrum_of(&waved.z)?);
    for (id, text, of, expected) in [
        ("wave_outer_11", "11 waves of the outer race, x", &axial, rates.outer),
        ("wave_inner_11", "11 waves of the inner race, x", &axial, rates.inner),
        ("wave_outer_12", "12 waves of the outer race, z", &radial, rates.outer),
        ("wave_inner_10", "10 waves of the inner race, z", &radial, rates.inner - rates.shaft),
        ("wave_inner_12", "12 waves of the inner race, z", &radial, rates.inner + rates.shaft),
    ] {
        line(context, (id, text), of, (expected, 10.0));
    }
    // Other orders cancel over the balls. Contact forces are not linear, so that sums, differences and doubles of the
    // orders must be no multiples of the balls and not next to one either: 14 and 15 waves give 1.4 % radially.
    let silent = roll(&[wave("outer", 15), wave("inner", 20)].concat())?;
    for (id, text, quiet, loud) in [
        ("silent_x", "x under 15 and 20 waves over that under 11", &silent.x, &waved.x),
        ("silent_z", "z under 15 and 20 waves over that under 10 and 12", &silent.z, &waved.z),
    ] {
        let most = |of: &Spectrum| largest(of.amplitude[1..].iter().copied());
        let ratio = most(&spectrum_of(quiet)?) / most(&spectrum_of(loud)?);
        context.check(
            Check::new(id, text, "1", ratio)
                .closed_form(0.0, "sums of cosines over equally spaced balls")
                .absolute(5e-3, "third order of the waves: (0.2 µm over 4 µm)², 0.25 %, twice"),
        );
    }
    context.finding(
        "steps",
        format!(
            "{}, {} and {} steps with a spall in the outer race, the inner race and on a ball; {} with waves.",
            outer.steps, inner.steps, ball.steps, waved.steps
        ),
    );
    figures(context, &outer, &z, &y)
}

fn figures(
    context: &mut CaseContext,
    outer: &History,
    z: &Spectrum,
    y: &Spectrum,
) -> Result<(), CaseError> {
    let rows = (3.0 * 60.0 / SPEED / SAMPLE) as usize;
    let over_time = |values: &[f64]| -> Vec<[f64; 2]> {
        let some = values.iter().take(rows).enumerate().step_by(2);
        some.map(|(i, v)| [1e3 * (SETTLE + i as f64 * SAMPLE), 1e9 * v]).collect()
    };
    let svg = xy(&XyPlot {
        title: "Outer race with a spall at −Z".into(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("displacement", "nm"),
        style: Style::Lines,
        curves: vec![Curve::new("z", over_time(&outer.z)), Curve::new("y", over_time(&outer.y))],
    })?;
    context.figure("displacement", svg, "As Fig. 5.34.");
    let lines = |of: &Spectrum| -> Vec<[f64; 2]> {
        let bins = of.amplitude.iter().enumerate();
        let bins = bins.take_while(|(k, _)| *k as f64 * of.bin_width < 1000.0);
        bins.map(|(k, a)| [k as f64 * of.bin_width, 1e9 * a]).collect()
    };
    let svg = xy(&XyPlot {
        title: "Spectrum of the outer race with a spall at −Z".into(),
        x: Axis::linear("frequency", "Hz"),
        y: Axis::linear("amplitude", "nm"),
        style: Style::Lines,
        curves: vec![Curve::new("z", lines(z)), Curve::new("y", lines(y))],
    })?;
    context.figure("spectrum", svg, "Lines at BPFO and its multiples.");
    Ok(())
}
