//! Friction torque of ten catalogue bearings, next to Palmgren's load-dependent moment.

use std::f64::consts::TAU;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::motion::{changed_scene, ran};

pub const CASE: Case = Case {
    id: "friction_torque",
    title: "Friction torque of catalogue bearings next to Palmgren's moment",
    section: "2.2.1 (not in the source)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Designation, bore and outside diameter, mm, and static rating, kN, of deep-groove bearings in catalogues.
const BEARINGS: [(&str, f64, f64, f64); 10] = [
    ("6004", 20.0, 42.0, 5.0),
    ("6205", 25.0, 52.0, 7.8),
    ("6206", 30.0, 62.0, 11.2),
    ("6207", 35.0, 72.0, 15.3),
    ("6208", 40.0, 80.0, 19.0),
    ("6304", 20.0, 52.0, 7.8),
    ("6305", 25.0, 62.0, 11.6),
    ("6306", 30.0, 72.0, 16.0),
    ("6308", 40.0, 90.0, 24.0),
    ("6310", 50.0, 110.0, 38.0),
];

const SCENE: &str = r#"
[bearing]
kind = "deep-groove"
balls = BALLS
pitch_radius = "PITCH mm"
clearance = { radial = "5 um" }
inner_race = { conformity = 0.52 }
outer_race = { conformity = 0.52 }
ball = { diameter = "BALL mm" }
[inner_race]
speed = "1500 rpm"
z = { load = "-LOAD N" }
x = { displacement = "0 um" }
tilt_y = { tilt = "0 deg" }
tilt_z = { tilt = "0 deg" }
[numerics]
end = "0.04 s"
output_interval = "0.1 ms"
[output]
plots = []
"#;

/// Share of the static rating.
const LOADING: f64 = 0.1;
const SPEED: f64 = 1500.0 / 60.0 * TAU;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "sizes",
        "Catalogues state bore, outside diameter and static rating. Ball diameter 0.3 (D - d), as many balls as fill 60 % of the \
         pitch circle, conformities 0.52, radial clearance 5 um.",
        "f 0.52",
    );
    context.assumption(
        "friction",
        "The default traction curve, boundary lubrication with a coefficient of about 0.1 where the contact slides.",
        "b 22.28, c 181.46, d 0.1",
    );
    for (name, bore, outside, rating) in BEARINGS {
        let (pitch, ball) = (0.25 * (bore + outside), 0.3 * (outside - bore));
        let balls = (0.6 * TAU * pitch / ball).floor();
        let load = 1e3 * LOADING * rating;
        let values = [
            ("BALLS", balls.to_string()),
            ("PITCH", pitch.to_string()),
            ("BALL", ball.to_string()),
            ("LOAD", load.to_string()),
        ];
        let changes: Vec<(&str, &str)> = values.iter().map(|(k, v)| (*k, v.as_str())).collect();
        let scene = changed_scene(SCENE, &changes)?;
        let [time, traction, meeting] =
            ran(&scene, &["time", "work_traction", "work_ball_friction"])?
                .try_into()
                .map_err(|_| CaseError::message("three columns"))?;
        let (first, last) = (time.len() / 2, time.len() - 1);
        let lost = |work: &[f64]| work[first] - work[last];
        let power = (lost(&traction) + lost(&meeting)) / (time[last] - time[first]);
        let torque = power / SPEED;
        let palmgren = 0.0009 * LOADING.powf(0.55) * load * 2e-3 * pitch;
        context.check(
            Check::new(
                &format!("ratio_{name}"),
                &format!("friction torque of a {name} over Palmgren's moment, 0.1 C0, 1500 rpm"),
                "1",
                torque / palmgren,
            )
            .independent(
                1.0,
                "f1 F d_m with f1 = 0.0009 (P0/C0)^0.55 (Harris and Kotzalas, Rolling Bearing Analysis), fitted to lubricated bearings",
            )
            .under("friction")
            .absolute(
                0.75,
                "Palmgren's moment is measured: conformity, film and elastic hysteresis of those bearings differ; \
                 differential sliding grows with the 5/3 power of the ball load, Palmgren's with the 1.55",
            ),
        );
    }
    Ok(())
}
