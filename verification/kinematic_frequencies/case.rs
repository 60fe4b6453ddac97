//! Kinematic frequencies of two bearings against pure rolling solved from contact velocities,
//! and the detected cage frequencies of Table 5.4.

use bearing_dynamics::ch2_housing::bearing::frequencies::ratios;
use plotters::prelude::*;

use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;

mod oracle;

pub const CASE: Case = Case {
    id: "kinematic_frequencies",
    title: "Kinematic frequencies and the detected cage speeds of Table 5.4",
    section: "5.4.1, Tables 2.2, 5.3 and 5.4",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

struct Bearing {
    name: &'static str,
    key: &'static str,
    ball_count: usize,
    /// m
    ball_radius: f64,
    /// m
    pitch_radius: f64,
    /// rad
    contact_angle: f64,
}

/// Table 2.2; the pitch radius is midway between the races (20.047 and 31.953 mm).
const DEEP_GROOVE: Bearing = Bearing {
    name: "Table 2.2",
    key: "table_2_2",
    ball_count: 8,
    ball_radius: 5.955e-3,
    pitch_radius: 26.0e-3,
    contact_angle: 0.0,
};

/// Table 5.3.
const ANGULAR_CONTACT: Bearing = Bearing {
    name: "Table 5.3",
    key: "table_5_3",
    ball_count: 11,
    ball_radius: 5.953e-3,
    pitch_radius: 30.0e-3,
    contact_angle: 35.0 * std::f64::consts::PI / 180.0,
};

/// Table 5.4, inputs: shaft frequency asked of the motor, and the one detected, Hz.
const SHAFT: [(u32, f64); 3] = [(10, 10.22), (20, 19.48), (30, 29.90)];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    ratios_against_pure_rolling(context);
    detected_cage(context);
    figure(context)?;
    Ok(())
}

fn cage_ratio(bearing: &Bearing) -> f64 {
    ratios(bearing.ball_count, bearing.ball_radius, bearing.pitch_radius, bearing.contact_angle)
        .cage
}

fn ratios_against_pure_rolling(context: &mut CaseContext) {
    for bearing in [&DEEP_GROOVE, &ANGULAR_CONTACT] {
        let Bearing { name, key, ball_count, ball_radius, pitch_radius, contact_angle } = *bearing;
        let ours = ratios(ball_count, ball_radius, pitch_radius, contact_angle);
        let rolling = oracle::pure_rolling(ball_radius, pitch_radius, contact_angle);
        let count = ball_count as f64;
        let quantities = [
            ("cage", "cage (FTF)", ours.cage, rolling.orbit),
            ("outer", "outer race (BPFO)", ours.ball_pass_outer, count * rolling.orbit),
            ("inner", "inner race (BPFI)", ours.ball_pass_inner, count * (1.0 - rolling.orbit)),
            ("ball", "ball (BSF)", ours.ball_spin, rolling.spin),
        ];
        for (part, quantity, ours, theirs) in quantities {
            context.check(
                Check::new(
                    &format!("{key}_{part}"),
                    &format!("{name}, {quantity} over shaft"),
                    "1",
                    ours,
                )
                .independent(theirs, "contact velocities of pure rolling, 4 × 4 system")
                .relative(5e-15, "same kinematics; rounding of a 4 × 4 elimination, 6e-16")
                .golden(GoldenTolerance { relative: 1e-13, absolute: 0.0 }),
            );
        }
    }
}

fn detected_cage(context: &mut CaseContext) {
    let reason = "both frequencies are read from the telemeter, which departs from the spindle sensor \
                  by up to 3.6 % in Table 5.1 (634.8 against 613 rpm): √2 × 3.6 %";
    let ratio = cage_ratio(&ANGULAR_CONTACT);
    for (label, detected_shaft) in SHAFT {
        let id = format!("detected_cage_{label}");
        let check = Check::new(
            &id,
            &format!("cage frequency at the detected shaft frequency {detected_shaft:.2} Hz"),
            "Hz",
            ratio * detected_shaft,
        )
        .published(&id)
        .relative(0.05, reason)
        .golden(GoldenTolerance::REORDERED);
        context.check(match label {
            30 => check.explained(Explanation::new(
                "The detected cage is slower than pure rolling allows at any contact angle, so \
                 balls or cage slipped in this measurement, or the line read is not the cage's; \
                 the text does not say which.",
                0.087,
                0.003,
                &["slowest_cage_30", "slowest_cage_ratio", "cage_over_contact_angle"],
            )),
            _ => check,
        });
    }

    // The slowest cage that pure rolling allows, searched over contact angles.
    let angles = (0..=900).map(|tenth| f64::from(tenth) / 10.0);
    let slowest = angles
        .map(|degrees| {
            cage_ratio(&Bearing { contact_angle: degrees.to_radians(), ..ANGULAR_CONTACT })
        })
        .fold(f64::INFINITY, f64::min);
    let radial =
        oracle::pure_rolling(ANGULAR_CONTACT.ball_radius, ANGULAR_CONTACT.pitch_radius, 0.0);
    context.check(
        Check::new(
            "slowest_cage_ratio",
            "slowest cage over shaft, contact angles 0 to 90°",
            "1",
            slowest,
        )
        .independent(radial.orbit, "pure rolling at zero contact angle, 4 × 4 system")
        .relative(5e-15, "the search meets zero exactly; rounding only, as for the ratios"),
    );
    let (_, detected_shaft) = SHAFT[2];
    context.check(
        Check::new(
            "slowest_cage_30",
            "slowest cage by pure rolling at 29.90 Hz, any contact angle",
            "Hz",
            slowest * detected_shaft,
        )
        .published("detected_cage_30")
        .at_least(
            0.3,
            "one and a half spacings of 0.2034 Hz, the telemeter's line spacing in Table 5.1",
        ),
    );
}

/// Cage over shaft against contact angle, by the law and by the oracle.
fn figure(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut svg = String::new();
    draw(&mut svg).map_err(|error| CaseError::message(format!("drawing failed: {error}")))?;
    context.figure(
        "cage_over_contact_angle",
        svg,
        "Cage over shaft frequency by pure rolling, bearing of Table 5.3, against contact angle: the law \
         (line) and the solved contact velocities (points). The cage is slowest at zero angle; no \
         angle brings it below that.",
    );
    Ok(())
}

fn draw(svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::with_string(svg, (760, 360)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(0f64..90f64, 0.39f64..0.51f64)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 229, 234))
        .x_desc("contact angle, °")
        .y_desc("cage over shaft frequency")
        .x_label_formatter(&|value| format!("{value:.0}"))
        .y_label_formatter(&|value| format!("{value:.2}"))
        .label_style(("sans-serif", 14))
        .draw()?;
    let law = (0..=180).map(|half| {
        let degrees = f64::from(half) / 2.0;
        let bearing = Bearing { contact_angle: degrees.to_radians(), ..ANGULAR_CONTACT };
        (degrees, cage_ratio(&bearing))
    });
    let blue = RGBColor(0, 114, 178);
    let orange = RGBColor(213, 94, 0);
    chart
        .draw_series(LineSeries::new(law, blue.stroke_width(2)))?
        .label("law")
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], blue.stroke_width(2)));
    let solved = (0..=9).map(|ten| {
        let degrees = 10.0 * f64::from(ten);
        let Bearing { ball_radius, pitch_radius, .. } = ANGULAR_CONTACT;
        let rolling = oracle::pure_rolling(ball_radius, pitch_radius, degrees.to_radians());
        Circle::new((degrees, rolling.orbit), 4, orange.filled())
    });
    chart
        .draw_series(solved)?
        .label("contact velocities")
        .legend(move |(x, y)| Circle::new((x + 9, y), 4, orange.filled()));
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE)
        .border_style(RGBColor(217, 222, 229))
        .label_font(("sans-serif", 14))
        .draw()?;
    root.present()?;
    Ok(())
}
