//! The cage's speed of Table 5.4 from the bearing in motion, by spectrum and by angle.

use std::f64::consts::TAU;

use bearing_dynamics::output::plots::{Axis, Curve, OrbitPlot, Style, XyPlot, orbit, xy};
use bearing_dynamics::output::spectrum::{LEAKAGE, Spectrum, WINDOW, peaks, spectrum};

use crate::cage_bearing::{
    INTERVAL, Motion, Rolling, kinematics, nominal_ratio, rolling, scale_traction, set_load,
    simulate, speeding_up,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;

mod flexible;

pub const CASE: Case = Case {
    id: "cage_speed_table_5_4",
    title: "Cage speeds of Table 5.4 from the bearing in motion",
    section: "5.3.1, 5.3.2, 5.4.1, Tables 5.3 and 5.4, (5.8)",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

/// Table 5.4, shaft frequencies asked of the motor, Hz.
const SHAFT: [u32; 3] = [10, 20, 30];
/// Run-up from rest, and time from the start to the window, s.
const RUN_UP: f64 = 0.3;
const SETTLE: f64 = 0.5;
/// 2.62 s.
const SAMPLES: usize = 1 << 18;
/// Radius of the point of the cage whose displacement is looked at, m: cage outer radius.
const POINT_RADIUS: f64 = 33.375e-3;

struct Run {
    shaft: u32,
    motion: Motion,
    expected: Rolling,
    spectrum: Spectrum,
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    let mut runs = Vec::new();
    let mut steps = 0;
    for shaft in SHAFT {
        let speed = TAU * f64::from(shaft);
        let problem = speeding_up(0.0, speed, RUN_UP)?;
        let expected = kinematics(&problem, speed)?;
        let motion = simulate(problem, SETTLE, SAMPLES)?;
        steps += motion.steps;
        let spectrum = lines(&motion.point_displacement(POINT_RADIUS))?;
        let run = Run { shaft, motion, expected, spectrum };
        frequencies(context, &run)?;
        slip_at_speed(context, &run)?;
        centre(context, &run)?;
        runs.push(run);
    }
    tables(context, &runs);
    figures(context, &runs)?;
    steps += slip_over_traction(context)?;
    steps += flexible::run(context)?;
    context.work("steps", steps);
    Ok(())
}

fn assumptions(context: &mut CaseContext) {
    context.assumption(
        "scene",
        "Everything that 5.4.1 omits is as in scenes/cage_600rpm.toml, which names each assumption; the \
         cage is rigid, and all starts at rest.",
        "scenes/cage_600rpm.toml, run-up in 0.3 s, window from 0.5 s",
    );
    context.assumption(
        "window",
        "Neither length nor weights of the source's window are stated. Its printed frequencies are 5, 11 \
         and 16 lines of 100 kHz over 2¹⁷ samples; 2¹⁸ samples of 10 µs, with lines half as far apart, \
         contain that window twice.",
        "2¹⁸ samples 10 µs apart, Hann, line spacing 0.381470 Hz",
    );
    context.assumption(
        "cage_signal",
        "Fig. 5.22 is the spectrum of the cage's displacement; of which point is not stated. A point that \
         turns with the cage has its strongest line at the cage's frequency, the centre has none there.",
        "lateral displacement of a point on the cage's outer surface",
    );
}

fn lines(values: &[f64]) -> Result<Spectrum, CaseError> {
    spectrum(values, INTERVAL).ok_or_else(|| CaseError::message("too few samples"))
}

/// Frequency of the highest line, Hz.
fn highest_line(spectrum: &Spectrum) -> Result<f64, CaseError> {
    let peak = peaks(spectrum, 1, 0.0).first().copied();
    Ok(peak.ok_or_else(|| CaseError::message("a spectrum without a peak"))?.bin_frequency)
}

/// The cage's frequency against the table, and the strongest line of a window of the length that the table's numbers
/// betray.
fn frequencies(context: &mut CaseContext, run: &Run) -> Result<(), CaseError> {
    let shaft = run.shaft;
    let published = format!("simulated_cage_{shaft}");
    let turned = run.motion.cage_ratio() * f64::from(shaft);
    let check = Check::new(
        &format!("frequency_{shaft}"),
        &format!("cage frequency by its angle over 2.62 s, {shaft} Hz shaft"),
        "Hz",
        turned,
    )
    .published(&published)
    .under("scene")
    .relative(
        0.005,
        "printed to 2e-4; what play of the pockets and creep leave of an angle is less than 1e-3. What is printed is a line of a \
         spectrum: where it lies this close, as at 20 Hz, it does so by chance",
    );
    let rolling = format!("ball_set_{shaft}");
    let line = format!("line_{shaft}");
    let halves = [1, 2].map(|half| format!("line_{shaft}_half_{half}"));
    let explained = |gap: f64| {
        Explanation::new(
            "Printed is a line of a spectrum, 0.763 Hz from the next, and not the frequency: the simulated cage rolls, \
             and the lines nearest to that are the printed ones. They say nothing about slip finer than half a line.",
            gap,
            0.002,
            &[&rolling, &line, &halves[0], &halves[1]],
        )
    };
    context.check(match shaft {
        10 => check.explained(explained(0.0983)),
        30 => check.explained(explained(0.0295)),
        _ => check,
    });
    context.check(
        Check::new(
            &line,
            &format!("strongest line of the cage, {shaft} Hz shaft, 2¹⁸ samples"),
            "Hz",
            highest_line(&run.spectrum)?,
        )
        .consistency(turned, "the spectrum's line against our own angle over the window")
        .absolute(0.5 * run.spectrum.bin_width, "the nearest line: half a spacing")
        .golden(GoldenTolerance::REORDERED),
    );
    let points = run.motion.point_displacement(POINT_RADIUS);
    for (values, id) in points.chunks(SAMPLES / 2).zip(&halves) {
        context.check(
            Check::new(
                id,
                &format!("strongest line of half of the window, 2¹⁷ samples, {shaft} Hz shaft"),
                "Hz",
                highest_line(&lines(values)?)?,
            )
            .published(&published)
            .under("window")
            .fit("the spacing of lines was identified from the three printed frequencies; which line it is was not")
            .printed("a line is a line: only the printed rounding remains")
            .golden(GoldenTolerance::REORDERED),
        );
    }
    Ok(())
}

/// The angle turned over the window against rolling.
fn slip_at_speed(context: &mut CaseContext, run: &Run) -> Result<(), CaseError> {
    let Run { shaft, motion, expected, .. } = run;
    let problem = rolling(TAU * f64::from(*shaft))?;
    let play = Motion::largest_play(&problem);
    let turned = motion.cage.last().copied().unwrap_or(f64::NAN);
    context.check(
        Check::new(
            &format!("ball_set_{shaft}"),
            &format!("ball set over shaft at {shaft} Hz"),
            "1",
            motion.ball_ratio(),
        )
        .independent(
            expected.ratio,
            "rolling at the loaded contact angles, roll axis where spin moments balance; the friction curve's coefficients are the scene's",
        )
        .under("scene")
        .relative(
            2e-5,
            "creep by which the traction carries the cage's drag, 4e-6 to 6e-6; three times that",
        )
        .golden(GoldenTolerance { relative: 1e-5, absolute: 0.0 }),
    );
    context.check(
        Check::new(
            &format!("cage_slip_{shaft}"),
            &format!("slip of the cage at {shaft} Hz, by its angle over 2.62 s"),
            "1",
            1.0 - motion.cage_ratio() / expected.ratio,
        )
        .independent(0.0, "rolling, as for the ball set")
        .under("scene")
        .absolute(
            play / turned,
            "the play of the pockets over the angle turned: no less can be told. It follows from ball set and play, and stands \
             here for the cage, whose slip the section is about",
        ),
    );
    context.check(
        Check::new(
            &format!("play_{shaft}"),
            &format!("cage against ball set over the window at {shaft} Hz"),
            "rad",
            motion.cage_play(),
        )
        .closed_form(play, "twice the pocket's clearance over the pitch radius")
        .at_most(0.0, "the pockets keep the cage with the ball set"),
    );
    Ok(())
}

/// Mean of y, of z and of the distance from the outer race's axis, m.
fn mean_centre(motion: &Motion) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for [y, z] in &motion.cage_centre {
        for (sum, value) in sums.iter_mut().zip([*y, *z, y.hypot(*z)]) {
            *sum += value;
        }
    }
    sums.map(|sum| sum / motion.cage_centre.len() as f64)
}

/// Where the cage rides: down on its guide, aside by the guide's friction.
fn centre(context: &mut CaseContext, run: &Run) -> Result<(), CaseError> {
    let shaft = run.shaft;
    let problem = rolling(TAU * f64::from(shaft))?;
    let cage = problem.cage.as_ref().ok_or_else(|| CaseError::message("a cage"))?;
    let clearance = 1e3 * cage.contacts.race_clearance;
    let aside = clearance * cage.contacts.friction.atan().sin();
    let [y, _, distance] = mean_centre(&run.motion).map(|mean| 1e3 * mean);
    if shaft == 10 {
        context.check(
            Check::new(
                "cage_distance_10",
                "mean distance of the cage's centre from the axis, 10 Hz shaft",
                "mm",
                distance,
            )
            .published("cage_distance_10")
            .under("scene")
            .relative(
                0.05,
                "the cage rattles on its guide and lifts by a few percent of the clearance",
            ),
        );
    }
    context.check(
        Check::new(
            &format!("cage_aside_{shaft}"),
            &format!("mean lateral place of the cage's centre, {shaft} Hz shaft"),
            "mm",
            y,
        )
        .closed_form(-aside, "a body that slides in a round guide hangs aside by the angle of friction")
        .absolute(0.5 * aside, "pushes of the balls besides weight and guide: half of it; friction the other way or none misses"),
    );
    Ok(())
}

fn tables(context: &mut CaseContext, runs: &[Run]) {
    let rows = runs
        .iter()
        .map(|Run { shaft, motion, expected, spectrum }| {
            let hz = f64::from(*shaft);
            let [inner, outer] = expected.angles.map(f64::to_degrees);
            let [outer_control, inner_control] = expected.race_control;
            vec![
                format!("{shaft}"),
                format!("{:.4}", nominal_ratio() * hz),
                format!("{:.4}", expected.ratio * hz),
                format!("{:.4} … {:.4}", inner_control * hz, outer_control * hz),
                format!("{inner:.2}, {outer:.2}"),
                format!("{:.4}", motion.ball_ratio() * hz),
                format!("{:.4}", motion.cage_ratio() * hz),
                format!("{:.1e}", 1.0 - motion.ball_ratio() / expected.ratio),
                format!("{:.1e}", 1.0 - motion.cage_ratio() / expected.ratio),
                format!("{:.2}", motion.ball_ratio() * hz / (2.0 * spectrum.bin_width)),
            ]
        })
        .collect();
    context.table(
        "speeds",
        "Frequencies in Hz: rolling at 35° and at the loaded angles, between inner and outer race control, and as \
         simulated, by the angle over the window",
        &[
            "shaft",
            "35°",
            "loaded",
            "race control",
            "angles inner, outer, °",
            "ball set",
            "cage",
            "slip of ball set",
            "slip of cage",
            "in lines of 2¹⁷ samples",
        ],
        rows,
    );
    let rows = runs
        .iter()
        .map(|run| {
            let y: Vec<f64> = run.motion.cage_centre.iter().map(|centre| centre[0]).collect();
            let [mean_y, mean_z, distance] = mean_centre(&run.motion).map(|mean| 1e6 * mean);
            let strongest = spectrum(&y, INTERVAL)
                .and_then(|spectrum| {
                    // Slower than the window is the drift of the centre.
                    let slow = 1.5 * spectrum.bin_width;
                    let all = peaks(&spectrum, usize::MAX, 0.0);
                    all.into_iter().find(|peak| peak.bin_frequency > slow)
                })
                .map_or_else(
                    || "none".to_string(),
                    |peak| format!("{:.2} Hz, {:.1} µm", peak.bin_frequency, 1e6 * peak.amplitude),
                );
            vec![
                format!("{}", run.shaft),
                format!("{mean_y:.1}"),
                format!("{mean_z:.1}"),
                format!("{distance:.1}"),
                strongest,
            ]
        })
        .collect();
    context.table(
        "centre",
        "Centre of the cage from the outer race's axis over the window (Fig. 5.21)",
        &["shaft, Hz", "mean y, µm", "mean z, µm", "mean distance, µm", "strongest line of y"],
        rows,
    );
    context.finding(
        "lines",
        "The table's values are the lines of 2¹⁷ samples nearest to the simulated frequency, at all three speeds; of 2¹⁸ \
         samples the nearest lines are 11, 22 and 33 (4.196, 8.392 and 12.589 Hz), of which the first and the last lie one line above \
         the printed ones. So 2¹⁷ samples are the reading that the printed numbers choose, and carry. At 10 Hz the cage turns \
         at 5.49 such lines: had it been 0.2 % faster, the table would print 4.578 Hz.",
    );
    context.finding("leakage", format!("Window of all spectra here: {WINDOW}; {LEAKAGE}."));
}

/// Friction levels at 445 N, and loads at a hundredth of the friction, at 10 Hz.
fn slip_over_traction(context: &mut CaseContext) -> Result<u64, CaseError> {
    const SPEED: f64 = 10.0 * TAU;
    let levels = [1.0, 0.1, 0.03, 0.01, 0.003, 0.002].map(|level| (level, 445.0)).to_vec();
    let loads = [445.0, 222.0, 111.0, 55.0].map(|load| (0.01, load)).to_vec();
    let series = [("friction", "445 N", levels), ("load", "friction × 0.01", loads)];
    let mut steps = 0;
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for (name, kept, variants) in series {
        let mut before: Option<f64> = None;
        let mut points = Vec::new();
        for (level, load) in variants {
            let mut problem = rolling(SPEED)?;
            set_load(&mut problem, load);
            scale_traction(&mut problem, level);
            let expected = kinematics(&problem, SPEED)?;
            let motion = simulate(problem, 0.1, 20_001)?;
            steps += motion.steps;
            let slip = 1.0 - motion.ball_ratio() / expected.ratio;
            if let Some(before) = before {
                let tag = format!("{name}_{level}_{load}").replace('.', "p");
                context.check(
                    Check::new(
                        &tag,
                        &format!("slip of ball set, friction × {level}, {load} N"),
                        "1",
                        slip,
                    )
                    .consistency(before, "two runs of ours: the one with the next more traction")
                    .under("scene")
                    .at_least(
                        0.5 * before.abs(),
                        "slip grows by half and more where traction falls to a half or less",
                    ),
                );
            }
            rows.push(vec![
                format!("{level}"),
                format!("{load}"),
                format!("{slip:.2e}"),
                format!("{:.2e}", 1.0 - motion.cage_ratio() / expected.ratio),
            ]);
            points.push([level * load, slip]);
            before = Some(slip);
        }
        curves.push(Curve::new(kept, points));
    }
    context.table(
        "slip",
        "Slip against rolling at 10 Hz, over 0.2 s after 0.1 s",
        &["friction ×", "load, N", "slip of ball set", "slip of cage"],
        rows,
    );
    let svg = xy(&XyPlot {
        title: "Slip of the ball set at 10 Hz".into(),
        x: Axis::log("load × friction level", "N"),
        y: Axis::log("slip", "1"),
        style: Style::LinesAndMarkers,
        curves,
    })?;
    context.figure(
        "slip_over_traction",
        svg,
        "Slip of the ball set against rolling over load times friction level: friction lowered at 445 N, and load \
         lowered at a hundredth of the friction. Below about 2 N the balls no longer carry the cage's drag, and slip \
         grows with time; what is shown is its mean from 0.1 to 0.3 s.",
    );
    Ok(steps)
}

fn figures(context: &mut CaseContext, runs: &[Run]) -> Result<(), CaseError> {
    let curves = runs
        .iter()
        .map(|Run { shaft, spectrum, .. }| {
            let points = spectrum.amplitude.iter().enumerate().skip(1).take(60);
            let points = points.map(|(line, a)| [line as f64 * spectrum.bin_width, 1e3 * a]);
            Curve::new(format!("{shaft} Hz shaft"), points.collect())
        })
        .chain([Curve::separate(
            "rolling",
            runs.iter()
                .map(|run| [run.expected.ratio * f64::from(run.shaft), 1e3 * POINT_RADIUS])
                .collect(),
        )])
        .collect();
    let bin = runs.first().map_or(0.0, |run| run.spectrum.bin_width);
    let svg = xy(&XyPlot {
        title: "Displacement of a point of the cage".into(),
        x: Axis::linear(format!("frequency ({WINDOW} window, line spacing {bin:.4} Hz)"), "Hz"),
        y: Axis::linear("amplitude", "mm"),
        style: Style::Lines,
        curves,
    })?;
    context.figure(
        "cage_spectrum",
        svg,
        "Amplitude of the lateral displacement of a point on the cage (Fig. 5.22). Marks: rolling, at the point's radius, \
         which a line shows where it meets a frequency.",
    );
    for run in runs {
        let points =
            run.motion.cage_centre.iter().step_by(50).map(|p| p.map(|value| 1e6 * value)).collect();
        let svg = orbit(&OrbitPlot {
            title: format!("Centre of the cage, {} Hz shaft", run.shaft),
            unit: "µm".into(),
            curves: vec![Curve::new("centre, marked where it ends", points)],
        })?;
        context.figure(
            &format!("cage_centre_{}", run.shaft),
            svg,
            "Path of the cage's centre over the window (Fig. 5.21); the outer race's guide allows 200 µm.",
        );
    }
    Ok(())
}
