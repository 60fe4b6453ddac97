//! What drives the cage: its slip against rolling as traction falls, and no traction at all.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;

use crate::cage_bearing::{
    self, INTERVAL, Motion, kinematics, nominal_ratio, rolling, scale_traction, set_load, simulate,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;

pub const CASE: Case = Case {
    id: "cage_slip",
    title: "What drives the cage: slip against traction",
    section: "5.3.1, 5.3.2, Table 5.3",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// rad/s.
const SHAFT: f64 = 600.0 / 60.0 * TAU;
/// Settling and window, s.
const SETTLE: f64 = 0.05;
const WINDOW: f64 = 0.05;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "scene",
        "Everything that 5.4.1 leaves out is as in the scene scenes/cage_600rpm.toml, which names each; the \
         cage is rigid. Balls and cage start at rolling speed unless a check says otherwise.",
        "scenes/cage_600rpm.toml",
    );
    let mut steps = 0;
    driven(context, &mut steps)?;
    undriven(context, &mut steps)?;
    context.work("steps", steps);
    Ok(())
}

fn samples(seconds: f64) -> usize {
    (seconds / INTERVAL).round() as usize + 1
}

/// Slip of ball set and cage at friction levels and loads.
fn driven(context: &mut CaseContext, steps: &mut u64) -> Result<(), CaseError> {
    let variants = [
        ("full", 1.0, 445.0),
        ("hundredth", 0.01, 445.0),
        ("light", 0.01, 111.0),
        ("gross", 0.002, 445.0),
    ];
    let mut slips = Vec::new();
    let mut rows = Vec::new();
    for (name, level, load) in variants {
        let mut problem = rolling(SHAFT)?;
        set_load(&mut problem, load);
        scale_traction(&mut problem, level);
        let expected = kinematics(&problem, SHAFT)?;
        let play = Motion::largest_play(&problem);
        let motion = simulate(problem, SETTLE, samples(WINDOW))?;
        *steps += motion.steps;
        let slip = 1.0 - motion.ball_ratio() / expected.ratio;
        rows.push(vec![
            format!("{level}"),
            format!("{load:.0}"),
            format!("{:.7}", motion.ball_ratio()),
            format!("{:.7}", expected.ratio),
            format!("{slip:.2e}"),
            format!("{:.2e}", 1.0 - motion.cage_ratio() / expected.ratio),
        ]);
        if name == "full" {
            context.check(
                Check::new("rolling", "ball set over shaft, friction as assumed", "1", motion.ball_ratio())
                    .independent(
                        expected.ratio,
                        "rolling at the loaded contact angles, roll axis where spin moments balance",
                    )
                    .under("scene")
                    .relative(2e-5, "creep by which the traction carries the cage's drag: 5e-6; twice that in a short window, and twice that")
                    .golden(GoldenTolerance { relative: 1e-5, absolute: 0.0 }),
            );
        }
        context.check(
            Check::new(
                &format!("play_{name}"),
                &format!("cage against ball set, friction × {level}, {load:.0} N"),
                "rad",
                motion.cage_play(),
            )
            .closed_form(play, "twice the pocket's clearance over the pitch radius")
            .at_most(0.0, "the pockets keep the cage with the ball set"),
        );
        slips.push(slip);
    }
    context.table(
        "slip",
        "Slip against rolling over 0.05 s; the cage's moves by its play in so short a window",
        &[
            "friction ×",
            "load, N",
            "ball set over shaft",
            "rolling",
            "slip of ball set",
            "slip of cage",
        ],
        rows,
    );
    let [full, hundredth, light, gross] = slips[..] else {
        return Err(CaseError::message("four variants"));
    };
    for (id, what, ours, less, margin, reason) in [
        (
            "slip_hundredth",
            "friction × 0.01 against × 1",
            hundredth,
            full,
            1e-4,
            "ten times what rolling is known to",
        ),
        (
            "slip_gross",
            "friction × 0.002 against × 0.01",
            gross,
            hundredth,
            1e-2,
            "gross slip: a hundredth",
        ),
        (
            "slip_light",
            "111 N against 445 N, friction × 0.01",
            light,
            hundredth,
            5e-3,
            "near gross slip: half of that",
        ),
    ] {
        context.check(
            Check::new(id, &format!("slip of ball set, {what}"), "1", ours)
                .independent(less, "the run with more traction")
                .at_least(margin, reason),
        );
    }
    Ok(())
}

/// Without traction nothing takes balls and cage along.
fn undriven(context: &mut CaseContext, steps: &mut u64) -> Result<(), CaseError> {
    let length = SETTLE + WINDOW;
    let mut turned = Vec::new();
    for law in [None, Some(TractionLaw::None)] {
        let mut problem = cage_bearing::speeding_up(0.0, SHAFT, SETTLE)?;
        if let Some(law) = law {
            problem.traction = law;
        }
        let motion = simulate(problem, 0.0, samples(length))?;
        *steps += motion.steps;
        let last = |angles: &[f64]| angles.last().copied().unwrap_or(f64::NAN);
        turned.push((last(&motion.cage), last(&motion.shaft)));
    }
    let play = Motion::largest_play(&rolling(SHAFT)?);
    let (driven, shaft) = turned[0];
    let ratio = nominal_ratio();
    context.check(
        Check::new(
            "driven_from_rest",
            "cage angle 0.1 s after the shaft started from rest, traction",
            "rad",
            driven,
        )
        .closed_form(ratio * shaft, "rolling at the nominal angle")
        .under("scene")
        .absolute(play, "play in the pockets; the loaded angle makes 7e-4 of the angle, 0.001 rad"),
    );
    let (undriven, _) = turned[1];
    context.check(
        Check::new(
            "undriven_at_rest",
            "the same without traction, cage at rest at the start",
            "rad",
            undriven,
        )
        .closed_form(0.0, "nothing turns it")
        .absolute(
            0.5 * play,
            "the cage falls onto its guide and rattles within its pockets; rolling would be 2 rad",
        ),
    );

    // Without gravity the cage touches nothing: it keeps its speed while the shaft doubles its own.
    let mut problem = cage_bearing::speeding_up(SHAFT, 2.0 * SHAFT, SETTLE)?;
    problem.traction = TractionLaw::None;
    problem.gravity = [0.0; 3];
    let motion = simulate(problem, 0.0, samples(length))?;
    *steps += motion.steps;
    let speed = motion.cage.last().copied().unwrap_or(f64::NAN) / length;
    context.check(
        Check::new(
            "undriven_at_speed",
            "cage speed without traction and gravity, shaft from 10 to 20 Hz",
            "rad/s",
            speed,
        )
        .closed_form(ratio * SHAFT, "the speed at which it started")
        .relative(1e-9, "20 000 steps of rounding"),
    );
    Ok(())
}
