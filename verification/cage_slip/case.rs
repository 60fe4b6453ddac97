//! What drives the cage: its slip against rolling as traction falls, and no traction at all.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::CageForce;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::state::{Layout, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, Stepping};
use bearing_dynamics::motion::system::System;

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
    section: "5.3.1, 5.3.2, Table 5.3, (5.8)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// rad/s.
const SHAFT: f64 = 600.0 / 60.0 * TAU;
/// What the ball set is held against.
const ROLLING: &str = "rolling at the loaded contact angles, roll axis where spin moments balance; the friction curve's coefficients are the scene's";
/// Settling and window, s.
const SETTLE: f64 = 0.05;
const WINDOW: f64 = 0.05;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "scene",
        "Everything that 5.4.1 omits is as in scenes/cage_600rpm.toml, which names each assumption; the \
         cage is rigid. Balls and cage start at rolling speed unless a check states otherwise.",
        "scenes/cage_600rpm.toml",
    );
    let mut steps = 0;
    bare(context, &mut steps)?;
    driven(context, &mut steps)?;
    undriven(context, &mut steps)?;
    impacts(context)?;
    context.work("steps", steps);
    Ok(())
}

fn samples(seconds: f64) -> usize {
    (seconds / INTERVAL).round() as usize + 1
}

/// Balls alone, at the speed where centrifugal force opens the contact angles most.
fn bare(context: &mut CaseContext, steps: &mut u64) -> Result<(), CaseError> {
    const FASTEST: f64 = 3.0 * SHAFT;
    let mut problem = rolling(FASTEST)?;
    problem.cage = None;
    problem.gravity = [0.0; 3];
    let expected = kinematics(&problem, FASTEST)?;
    let motion = simulate(problem, SETTLE, samples(WINDOW))?;
    *steps += motion.steps;
    context.check(
        Check::new("bare", "ball set over shaft at 30 Hz, no cage, no gravity", "1", motion.ball_ratio())
            .independent(expected.ratio, ROLLING)
            .under("scene")
            .relative(3e-6, "the step of 5 µs makes 1e-6; gyroscopic sliding, left out there, changes the spin moments by less than 1e-3 and the ratio by 1e-7; the rest is reserve")
            .golden(GoldenTolerance { relative: 1e-6, absolute: 0.0 }),
    );
    Ok(())
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
                        ROLLING,
                    )
                    .under("scene")
                    .relative(2e-5, "creep that balances the cage's drag, 6e-6, and as much again from rattling in a short window; rounded up")
                    .golden(GoldenTolerance { relative: 1e-5, absolute: 0.0 }),
            );
        }
        // The others slip so little that the cage would stay by itself.
        if name == "gross" {
            context.check(
                Check::new(
                    "play",
                    &format!("cage against ball set, friction × {level}, {load:.0} N"),
                    "rad",
                    motion.cage_play(),
                )
                .closed_form(play, "twice the pocket's clearance over the pitch radius")
                .at_most(0.0, "the pockets keep the cage with the ball set"),
            );
        }
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
            "ten times the error of the rolling solution",
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
                .consistency(less, "two runs of ours: the one with more traction")
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
        .closed_form(0.0, "no moment acts")
        .absolute(
            0.5 * play,
            "the cage falls onto its guide and rattles within its pockets; rolling would be 2 rad",
        ),
    );

    coasting(context, steps)?;

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
        .relative(1e-13, "20 000 steps that add nothing: rounding of the last digits"),
    );
    Ok(())
}

/// Without traction the guide's friction brakes cage and balls.
fn coasting(context: &mut CaseContext, steps: &mut u64) -> Result<(), CaseError> {
    const START: f64 = 0.02;
    const LENGTH: f64 = 0.18;
    let mut problem = rolling(SHAFT)?;
    problem.traction = TractionLaw::None;
    let cage = problem.cage.clone().ok_or_else(|| CaseError::message("a cage"))?;
    let (balls, ball) = (problem.geometry.ball_count as f64, problem.ball);
    let gravity = -problem.gravity[2];
    let radius = problem.geometry.pitch_radius;
    let inertia = cage.inertia.axial + balls * ball.mass * radius * radius;
    // A ball that nothing else holds leans on its pocket with its weight along the orbit, m g |cos θ|:
    // half of all of it acts downwards, and 2/π of it rubs on the balls, which spin against the orbit.
    let ball_weight = balls * ball.mass * gravity;
    let on_guide = cage.inertia.mass * gravity + 0.5 * ball_weight;
    let on_balls = ball_weight / FRAC_PI_2;
    let lever = problem.geometry.ball_radius * problem.geometry.contact_angle.cos();
    let contacts = &cage.contacts;
    let guide = contacts.guide_radius + contacts.race_clearance;
    let moment = contacts.friction * (on_guide * guide + on_balls * lever);
    let motion = simulate(problem, START, samples(LENGTH))?;
    *steps += motion.steps;
    // Angles of both halves of the window differ by deceleration times half the window squared.
    let middle = motion.cage.get(motion.cage.len() / 2).copied().unwrap_or(f64::NAN);
    let end = motion.cage.last().copied().unwrap_or(f64::NAN);
    let halves = [middle, end - middle];
    let deceleration = (halves[0] - halves[1]) / (0.25 * LENGTH * LENGTH);
    context.check(
        Check::new("coasting", "deceleration of the cage without traction", "rad/s²", deceleration)
            .closed_form(moment / inertia, "friction of the guide under the weight of cage and balls, and of the balls in their pockets")
            .relative(0.12, "balls that rattle press on both sides of their pockets, not on one"),
    );
    Ok(())
}

/// The penalty force by what it does: frictionless blows of the cage on its guide and on the balls.
fn impacts(context: &mut CaseContext) -> Result<(), CaseError> {
    const SPEED: f64 = 1.0;
    let mut problem = rolling(0.0)?;
    problem.traction = TractionLaw::None;
    problem.gravity = [0.0; 3];
    // A guide that does not yield.
    problem.outer = None;
    let cage = problem.cage.as_mut().ok_or_else(|| CaseError::message("a cage"))?;
    cage.contacts.friction = 0.0;
    let (inertia, contacts) = (cage.inertia, cage.contacts);
    let CageForce::Penalty { stiffness } = contacts.force else {
        return Err(CaseError::message("the scene's cage contacts are penalty ones"));
    };
    let (balls, ball_mass) = (problem.geometry.ball_count as f64, problem.ball.mass);
    let pitch = contacts.pocket_pitch_radius;

    // Sideways onto the guide, which it meets with both its ends; then turning, onto all balls at
    // once, which only their pockets move.
    let own = inertia.axial / (pitch * pitch);
    let others = balls * ball_mass;
    let blows = [
        Blow {
            what: "guide",
            entry: VELOCITY + 1,
            lever: 1.0,
            mass: inertia.mass,
            spring: 2.0 * stiffness,
            rebound: -1.0,
            off: (
                3e-5,
                "steps of 0.1 µs in 41 µs miss the deepest point by up to (π/2 · 0.1/41)²/2 = 7e-6",
            ),
            penetration: |system| system.sets[0].guides[0].penetration,
        },
        Blow {
            what: "pockets",
            entry: SPIN,
            lever: pitch,
            mass: own * others / (own + others),
            spring: balls * stiffness,
            rebound: (own - others) / (own + others),
            off: (
                1e-3,
                "the pockets meet the balls 0.018 rad askew, whose cosine is 1.6e-4 less than one; steps of 0.1 µs in 13",
            ),
            penetration: |system| system.sets[0].pockets[0].penetration,
        },
    ];
    for blow in blows {
        let what = blow.what;
        let [depth, time, after] = strike(&problem, &blow, SPEED)?;
        let period = (blow.mass / blow.spring).sqrt();
        let (off, why) = blow.off;
        for (id, quantity, unit, ours, closed, tolerance, reason) in [
            (
                "depth",
                "deepest penetration",
                "µm",
                1e6 * depth,
                1e6 * SPEED * period,
                off * 1e6 * SPEED * period,
                why,
            ),
            (
                "time",
                "time in contact",
                "µs",
                1e6 * time,
                1e6 * PI * period,
                0.2,
                "two steps of 0.1 µs",
            ),
            (
                "after",
                "speed of the cage afterwards",
                "m/s",
                after,
                SPEED * blow.rebound,
                off * SPEED,
                why,
            ),
        ] {
            context.check(
                Check::new(
                    &format!("{what}_{id}"),
                    &format!("impact of the cage on its {what} at 1 m/s, {quantity}"),
                    unit,
                    ours,
                )
                .closed_form(closed, "two masses and a unilateral linear spring")
                .absolute(tolerance, reason),
            );
        }
    }
    Ok(())
}

/// A moving cage that meets something: which rate starts it, and the equivalent mass and spring.
struct Blow {
    what: &'static str,
    /// Entry of the cage's state that is set.
    entry: usize,
    /// Speed at the contact over that entry, m/s.
    lever: f64,
    mass: f64,
    spring: f64,
    /// Speed afterwards over that before.
    rebound: f64,
    /// What the contacts' lie and the steps leave, as a part, and why.
    off: (f64, &'static str),
    penetration: fn(&System) -> f64,
}

/// Deepest penetration (m), time in contact (s), speed of the cage afterwards (m/s).
fn strike(problem: &DynamicProblem, blow: &Blow, speed: f64) -> Result<[f64; 3], CaseError> {
    const STEP: f64 = 1e-7;
    let options = RunOptions { stepping: Stepping::Fixed(STEP), ..RunOptions::default() };
    let mut state = Simulation::new(problem.clone(), options)?.state;
    let cage = Layout::new(problem.geometry.ball_count, true).cage();
    state[cage + blow.entry] = speed / blow.lever;
    let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0)?;
    let (mut depth, mut touching) = (f64::NEG_INFINITY, 0u32);
    for _ in 0..10_000 {
        simulation.step()?;
        simulation.snapshot();
        let penetration = (blow.penetration)(&simulation.system);
        depth = depth.max(penetration);
        if penetration > 0.0 {
            touching += 1;
        } else if touching > 0 {
            break;
        }
    }
    let after = simulation.state[cage + blow.entry] * blow.lever;
    Ok([depth, f64::from(touching) * STEP, after])
}
