//! What the moving bearing comes to rest in, and what it means over a turn, against statics.

use std::f64::consts::TAU;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::state::POSITION;
use bearing_dynamics::motion::simulation::Simulation;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, PolarPlot, Style, XyPlot, polar, xy};

use crate::bearings::{self, ANGULAR_CONTACT, DEEP_GROOVE, Hertz, Lengths};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{self, BallSet, RPM};
use crate::oracles::statics::Known;

pub const CASE: Case = Case {
    id: "settling_and_turning",
    title: "Settling into equilibrium, and means of a turning bearing",
    section: "2.2.1, 3.4.5, 4.2.1, Tables 3.5 and 5.3",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Table 3.5 with the 5 µm interference of 3.4.3.
const INTERFERENCE: Lengths = Lengths { clearance: -5e-6, ..DEEP_GROOVE };
const SPEED: f64 = 1000.0 * RPM;
const TILT: f64 = 0.15 * TAU / 360.0;
const SAMPLES: usize = 100;
const PITCHES: usize = 2;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let (name, text, default) = motion::RACE_INERTIA;
    context.assumption(name, text, default);
    context.assumption(
        "settling_aids",
        "Contact damping does not reach motions across the contacts. The balls are kept at their azimuths, as a cage would \
         and as statics has it; dashpots to the ground brake the race's softest modes and hold nothing up.",
        "Hunt–Crossley α = 3 s/m; 1000 N·s/m, 0.2 N·m·s",
    );
    context.assumption(
        "turning_bearing",
        "Speed and friction of 3.4.5 are not stated. Traction keeps the balls rolling; over three ball pitches they stay within \
         0.003 rad of even spacing without a cage.",
        "1000 rpm, κ = 0.07 regularised below 0.05 m/s, Hunt–Crossley α = 0.3 s/m",
    );
    context.assumption(
        "ball_radius_of_5_um_interference",
        "3.4.3 creates a 5 µm interference; Table 3.5 prints a ball of 5.955 mm, which makes 4 µm. The radial clearance is \
         −5 µm, through the ball radius as in 4.3.1: see case misalignment_moment, which alone claims the moment of 3.4.5.",
        "ball radius 5.9555 mm",
    );
    settling(context)?;
    turning(context)
}

/// Name, bearing, loads.
type Settled = (&'static str, &'static str, Lengths, [f64; 5]);

const SETTLED: [Settled; 5] = [
    ("radial", "Table 3.5, −500 N along Z", INTERFERENCE, [0.0, 0.0, -500.0, 0.0, 0.0]),
    ("oblique", "Table 3.5, 200, 300, −300 N", INTERFERENCE, [200.0, 300.0, -300.0, 0.0, 0.0]),
    (
        "moment",
        "Table 3.5, 100, 0, −200 N, 2, −1 N·m",
        INTERFERENCE,
        [100.0, 0.0, -200.0, 2.0, -1.0],
    ),
    ("axial", "Table 5.3, 445 N along X", ANGULAR_CONTACT, [445.0, 0.0, 0.0, 0.0, 0.0]),
    (
        "combined",
        "Table 5.3, 800, 0, −100 N, 1.5, 1 N·m",
        ANGULAR_CONTACT,
        [800.0, 0.0, -100.0, 1.5, 1.0],
    ),
];

/// Puts every ball back into the plane through the outer race's axis in which statics holds it.
fn hold_azimuths(simulation: &mut Simulation) {
    let layout = simulation.system.sets[0].layout;
    for ball in 0..layout.balls {
        let angle = simulation.system.assembly.bearings[0].ball_phase
            + TAU * ball as f64 / layout.balls as f64;
        let (sin, cos) = angle.sin_cos();
        let across = |v: [f64; 3]| {
            let along = v[2] * cos - v[1] * sin;
            [v[0], v[1] + along * sin, v[2] - along * cos]
        };
        let mut body = layout.ball_state(&simulation.state, ball);
        body.position = across(body.position);
        body.velocity = across(body.velocity);
        layout.set_ball(&mut simulation.state, ball, &body);
    }
}

/// Largest differences in position over the largest displacement, and in load over the largest.
fn settled_off(lengths: &Lengths, loads: [f64; 5]) -> Result<[f64; 2], CaseError> {
    let phase = 0.1;
    let mut problem = motion::moving(lengths, phase, loads, 0.0)?;
    // From the equilibrium of 0.8 of the load; slowly beside the balls' swing across their grooves
    // (above 5e3 rad/s), which moves no contact along its normal.
    problem.inner.drives = loads.map(|load| {
        let (start, duration) = (0.0, 60e-3);
        Drive::Load(Profile::SmoothRamp { from: 0.8 * load, to: load, start, duration })
    });
    problem.damping = ContactDamping::HuntCrossley { alpha: 3.0 };
    problem.inner.foundation_damping = [1e3, 1e3, 1e3, 0.2, 0.2];
    let mut simulation = Simulation::new(problem, motion::fixed_step(2e-6))?;
    for _ in 0..40_000 {
        simulation.step()?;
        hold_azimuths(&mut simulation);
    }
    simulation.snapshot();
    let expected =
        bearings::oracle(lengths, Hertz::Fit, phase).solve(&loads.map(Known::Load), None);
    let layout = simulation.system.sets[0].layout;
    let units = [1.0, 1.0, 1.0, lengths.pitch_radius, lengths.pitch_radius];
    let ours = motion::inner_coordinates(&simulation);
    let (mut moved, mut off) = (0.0_f64, 0.0_f64);
    for i in 0..5 {
        moved = moved.max((expected.coordinates[i] * units[i]).abs());
        off = off.max(((ours[i] - expected.coordinates[i]) * units[i]).abs());
    }
    let (mut heaviest, mut load_off) = (0.0_f64, 0.0_f64);
    for (ball, theirs) in expected.balls.iter().enumerate() {
        let table = &simulation.system.sets[0].table.load;
        for (ours, theirs) in
            [(table[ball], theirs.inner.load), (table[layout.padded + ball], theirs.outer.load)]
        {
            heaviest = heaviest.max(theirs);
            load_off = load_off.max((ours - theirs).abs());
        }
        // An unloaded ball may be anywhere in its room.
        if theirs.outer.load > 0.0 {
            let [x, y, z] = layout.ball_vector(&simulation.state, POSITION, ball);
            let [axial, radial] = theirs.position;
            off = off.max((x - axial).hypot(y.hypot(z) - radial));
        }
    }
    Ok([off / moved, load_off / heaviest])
}

fn settling(context: &mut CaseContext) -> Result<(), CaseError> {
    for (id, name, lengths, loads) in SETTLED {
        let [position, load] = settled_off(&lengths, loads)?;
        let origin = "zero: the equilibrium by energy minimised over all coordinates at once";
        let (tolerance, reason) = match id {
            "axial" => (1e-6, "residual motion 20 ms after the last change of load: 1.6e-7"),
            "combined" => (1e-7, "residual motion 20 ms after the last change of load: 1.1e-8"),
            _ => (5e-9, "residual motion 20 ms after the last change of load: up to 4e-10"),
        };
        context.check(
            Check::new(
                &format!("settled_{id}"),
                &format!("race and balls off equilibrium, over the largest displacement: {name}"),
                "1",
                position,
            )
            .independent(0.0, origin)
            .absolute(tolerance, reason),
        );
        context.check(
            Check::new(
                &format!("settled_load_{id}"),
                &format!("ball loads off equilibrium, over the largest: {name}"),
                "1",
                load,
            )
            .independent(0.0, origin)
            .absolute(2e-8, "residual motion: at most 3e-9 of the largest load"),
        );
    }
    Ok(())
}

/// A turning bearing over whole ball pitches, sample by sample.
#[derive(Default)]
struct Turn {
    /// Time over ball pass time, value: by dynamics and by statics at the same ball angles.
    dynamic: Vec<[f64; 2]>,
    fixed: Vec<[f64; 2]>,
    /// Azimuth and load between ball and outer race, N.
    loads: Vec<[f64; 2]>,
    static_loads: Vec<[f64; 2]>,
    uneven: f64,
    evaluations: u64,
}

fn mean(points: &[[f64; 2]]) -> f64 {
    points.iter().map(|point| point[1]).sum::<f64>() / points.len() as f64
}

/// Z (m) under a load, or moment about Y (N·m) under a tilt.
fn turn(problem: &DynamicProblem, known: &[Known; 5], moment: bool) -> Result<Turn, CaseError> {
    let orbit = motion::cage_ratio(problem) * SPEED;
    let time = TAU / problem.geometry.ball_count as f64 / orbit;
    let every = (time / SAMPLES as f64 / 2.5e-6).round() as usize;
    let step = time / (SAMPLES * every) as f64;
    let mut simulation = Simulation::new(problem.clone(), motion::fixed_step(step))?;
    motion::run(&mut simulation, SAMPLES * every)?;
    let mut turn = Turn::default();
    for sample in 1..=PITCHES * SAMPLES {
        motion::run(&mut simulation, every)?;
        simulation.snapshot();
        let set = &simulation.system.sets[0];
        let balls = BallSet::of(&simulation);
        let still = balls.oracle(&INTERFERENCE).solve(known, None);
        let (ours, theirs) = if moment {
            (-set.on_races[0].moment[1], still.loads[3])
        } else {
            (set.races[0].state.position[2], still.coordinates[2])
        };
        let at = sample as f64 / SAMPLES as f64;
        turn.dynamic.push([at, ours]);
        turn.fixed.push([at, theirs]);
        turn.uneven = balls.ahead().iter().fold(turn.uneven, |most, angle| most.max(angle.abs()));
        let layout = simulation.system.sets[0].layout;
        for (ball, still) in still.balls.iter().enumerate() {
            let load = simulation.system.sets[0].table.load[layout.padded + ball];
            turn.loads.push([balls.azimuths[ball], load]);
            turn.static_loads.push([balls.azimuths[ball], still.outer.load]);
        }
    }
    turn.evaluations = simulation.system.work.evaluations;
    Ok(turn)
}

fn turning_problem(loads: [f64; 5]) -> Result<DynamicProblem, CaseError> {
    let mut problem = motion::moving(&INTERFERENCE, 0.1, loads, SPEED)?;
    problem.traction = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 };
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    Ok(problem)
}

const ORIGIN: &str = "mean of independent statics, each ball at its own angle, centrifugal force";
const TURNING: &str = "traction, which statics leaves out, moves the means by 0.01 to 0.03 %";
/// Sums over 23 000 steps.
const GOLDEN: GoldenTolerance = GoldenTolerance { relative: 1e-7, absolute: 0.0 };

fn turning(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for load in [250.0, 1500.0] {
        let loads = [0.0, 0.0, -load, 0.0, 0.0];
        let turn = turn(&turning_problem(loads)?, &loads.map(Known::Load), false)?;
        let [ours, theirs] = [&turn.dynamic, &turn.fixed].map(|points| 1e6 * mean(points));
        context.check(
            Check::new(
                &format!("mean_z_{load}"),
                &format!("mean Z under {load} N at 1000 rpm"),
                "µm",
                ours,
            )
            .independent(theirs, ORIGIN)
            .relative(1e-3, TURNING)
            .golden(GOLDEN),
        );
        context.work(&format!("force evaluations under {load} N"), turn.evaluations);
        rows.push(row(&format!("Z under {load} N, µm"), ours, theirs, turn.uneven));
        let about = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
            points.iter().map(|[at, z]| [*at, 1e9 * z - 1e3 * theirs]).collect()
        };
        curves.push(Curve::new(format!("{load} N, dynamics"), about(&turn.dynamic)));
        let every = about(&turn.fixed).into_iter().step_by(5).collect();
        curves.push(Curve::separate(format!("{load} N, statics"), every));
    }
    let mut problem = turning_problem([0.0; 5])?;
    problem.inner.drives[3] = Drive::Motion(Profile::Constant(TILT));
    let mut known = [Known::Load(0.0); 5];
    known[3] = Known::Value(TILT);
    let tilted = turn(&problem, &known, true)?;
    let [ours, theirs] = [&tilted.dynamic, &tilted.fixed].map(|points| mean(points));
    context.check(
        Check::new("mean_moment", "mean moment at 0.15° tilt, 1000 rpm", "N·m", ours)
            .independent(theirs, ORIGIN)
            .relative(1e-3, TURNING)
            .golden(GOLDEN),
    );
    let still =
        bearings::oracle(&INTERFERENCE, Hertz::Fit, 11.25_f64.to_radians()).solve(&known, None);
    context.check(
        Check::new(
            "moment_beside_static",
            "mean moment at 0.15° tilt, 1000 rpm, against the bearing at rest",
            "N·m",
            ours,
        )
        .independent(still.loads[3], "independent statics at rest, balls at 11.25°")
        .relative(2e-3, "0.1 % of turning, 0.06 % of the ball phase, uneven balls"),
    );
    context.work("force evaluations at 0.15°", tilted.evaluations);
    rows.push(row("moment at 0.15°, N·m", ours, theirs, tilted.uneven));
    let columns = [
        "mean",
        "dynamics",
        "statics, same angles",
        "difference",
        "farthest ball from its even place, rad",
    ];
    context.table("means", "Means over two ball pitches at 1000 rpm", &columns, rows);
    context.table(
        "section_3_4_5",
        "The moment of 3.4.5 at 0.15° tilt",
        &["", "moment, N·m"],
        vec![
            vec!["turning at 1000 rpm, mean".into(), format!("{ours:.4}")],
            vec![
                "independent statics at the same ball angles, mean".into(),
                format!("{theirs:.4}"),
            ],
            vec!["independent statics at rest".into(), format!("{:.4}", still.loads[3])],
        ],
    );
    context.finding(
        "turning_moment",
        format!(
            "Turning changes the moment by {:+.2} % against the bearing at rest with evenly spaced balls; statics at the \
             turning bearing's ball angles has {:+.2} %. The cause is the ball positions (uneven under the tilt, by up to {:.1e} rad), not their inertia or traction.",
            100.0 * (ours / still.loads[3] - 1.0),
            100.0 * (theirs / still.loads[3] - 1.0),
            tilted.uneven
        ),
    );
    let svg = xy(&XyPlot {
        title: "Z about its static mean, 1000 rpm".into(),
        x: Axis::linear("time over ball pass time", "1"),
        y: Axis::linear("Z", "nm"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("z_over_time", svg, "Two ball pitches after one of run-in; markers: independent statics at the same ball angles.");
    let svg = polar(&PolarPlot {
        title: "Normal load between ball and outer race at 0.15° tilt, 1000 rpm".into(),
        quantity: "normal load".into(),
        unit: "N".into(),
        curves: vec![
            Curve::new("turning bearing", sorted(tilted.loads)),
            Curve::separate(
                "independent statics",
                sorted(tilted.static_loads).into_iter().step_by(40).collect(),
            ),
        ],
    })?;
    context.figure(
        "ball_load_over_azimuth",
        svg,
        "As Fig. 3.31, fixed outer race: load of a ball over one orbit, rotating bearing.",
    );
    Ok(())
}

fn row(name: &str, ours: f64, theirs: f64, uneven: f64) -> Vec<String> {
    let difference = format!("{:+.4} %", 100.0 * (ours / theirs - 1.0));
    vec![
        name.into(),
        format!("{ours:.5}"),
        format!("{theirs:.5}"),
        difference,
        format!("{uneven:.1e}"),
    ]
}

fn sorted(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}
