//! Random shafts on two bearings each against a solver that shares nothing with the program.

use bearing_dynamics::ch2_housing::bearing::geometry::ClearanceThrough;
use bearing_dynamics::equilibrium::lists::{
    Loaded, Place, StaticAssembly, StaticBearing, StaticBody,
};
use bearing_dynamics::equilibrium::statics::{AssemblySolution, StaticOptions, solve_assembly};
use bearing_dynamics::kinematics::{Pose, euler};
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::members::mount::Mount;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

use crate::bearings::{self, Hertz, Lengths};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::oracles::shaft::{self, Seat};

pub const CASE: Case = Case {
    id: "shaft_on_two_bearings",
    title: "Fifty random shafts on two bearings against an independent solver",
    section: "2.2.1, 4.2.1, (2.1), (2.16)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const SAMPLES: usize = 50;

/// One end of a shaft.
struct End {
    lengths: Lengths,
    phase: f64,
    /// Of the inner race along the shaft, m.
    along: f64,
    reversed: bool,
    /// x, y, z (m), tilts (rad) of the outer race.
    outer: [f64; 5],
}

struct Shaft {
    ends: [End; 2],
    loads: [f64; 5],
    /// m/s², on the balls.
    gravity: [f64; 3],
}

/// SplitMix64 (Steele, Lea and Flood, 2014), between 0 and 1.
fn unit_numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / u64::MAX as f64
    }
}

/// Of either kind and any size, with clearance or interference.
fn lengths(between: &mut impl FnMut(f64, f64) -> f64) -> Lengths {
    let balls = between(6.0, 15.0) as usize;
    let ball_radius = between(3e-3, 7e-3);
    let spacing = between(1.3, 2.0);
    let angular = between(0.0, 1.0) < 0.6;
    Lengths {
        balls,
        pitch_radius: ball_radius * spacing / (PI / balls as f64).sin(),
        inner_groove_radius: ball_radius * between(1.01, 1.12),
        outer_groove_radius: ball_radius * between(1.02, 1.12),
        ball_radius,
        contact_angle: if angular { between(12.0, 45.0).to_radians() } else { 0.0 },
        clearance: between(-20e-6, 40e-6),
        through: ClearanceThrough::Ball,
    }
}

impl Shaft {
    fn seeded(seed: u64) -> Shaft {
        let mut unit = unit_numbers(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * unit();
        let ends = [-1.0, 1.0].map(|side: f64| {
            let lengths = lengths(&mut between);
            let phase = between(0.0, TAU);
            let along = side * between(20e-3, 150e-3);
            let mut outer = [0.0; 5];
            for (i, coordinate) in outer.iter_mut().enumerate() {
                let reach = if i < 3 { 10e-6 } else { 0.2f64.to_radians() };
                *coordinate = between(-reach, reach);
            }
            outer[0] += along;
            let reversed = between(0.0, 1.0) < 0.5;
            End { lengths, phase, along, reversed, outer }
        });
        let radius = ends[0].lengths.ball_radius.min(ends[1].lengths.ball_radius);
        let force = radius * radius * 4e7;
        let moment = force * 50e-3;
        let loads = [force, force, force, moment, moment].map(|size| size * between(-1.0, 1.0));
        let heavy = between(0.0, 1.0) < 0.5;
        let gravity = [(); 3].map(|()| {
            let value = between(-1e3, 1e3);
            if heavy { value } else { 0.0 }
        });
        Shaft { ends, loads, gravity }
    }

    /// What the program makes of it.
    fn assembly(&self) -> Result<StaticAssembly<'static>, CaseError> {
        let [left, right] = &self.ends;
        let radius = left.lengths.ball_radius.min(right.lengths.ball_radius);
        let loaded = Loaded {
            axes: None,
            conditions: self.loads.map(Condition::Load),
            springs: [0.0; 5],
            rest: [0.0; 5],
            start: Some([0.0; 5]),
            room: radius,
        };
        let mut bodies = vec![StaticBody { name: "shaft".into(), place: Place::Loaded(loaded) }];
        let mut bearings = Vec::new();
        for (index, end) in self.ends.iter().enumerate() {
            let [x, y, z, xi, lambda] = end.outer;
            let pose = Pose {
                position: Vector3::new(x, y, z),
                orientation: euler::quaternion(0.0, xi, lambda),
            };
            bodies.push(StaticBody { name: "outer race".into(), place: Place::Fixed(pose) });
            let free = [Condition::Load(0.0); 5];
            let alone = bearings::problem(&end.lengths, Hertz::Fit, end.phase, free)?;
            let (body, reversed) = (index + 1, end.reversed);
            bearings.push(StaticBearing {
                name: Some(["left", "right"][index].into()),
                geometry: alone.geometry,
                inner_contact: alone.inner_contact,
                outer_contact: alone.outer_contact,
                mounts: [
                    Mount { body: 0, along: end.along, reversed },
                    Mount { body, along: 0.0, reversed },
                ],
                azimuths: alone.geometry.azimuths(end.phase),
                weight: Vector3::from(self.gravity) * alone.ball_mass,
                centrifugal: 0.0,
            });
        }
        Ok(StaticAssembly { bodies, bearings, ..StaticAssembly::default() })
    }

    /// What the independent solver makes of it.
    fn seats(&self) -> Vec<Seat> {
        let seat = |end: &End| {
            let mut bearing = bearings::oracle(&end.lengths, Hertz::Fit, end.phase);
            let [x, y, z, xi, lambda] = end.outer;
            // Half a turn about Z takes tilts about Y the other way.
            let turned = if end.reversed { -1.0 } else { 1.0 };
            bearing.outer_position = [turned * x, turned * y, z];
            let ((sx, cx), (sl, cl)) = ((turned * xi).sin_cos(), lambda.sin_cos());
            bearing.outer_rotation =
                [[cx * cl, -cx * sl, sx], [sl, cl, 0.0], [-sx * cl, sx * sl, cx]];
            let mass = 7850.0 * 4.0 / 3.0 * PI * bearing.ball_radius.powi(3);
            let [gx, gy, gz] = self.gravity.map(|g| mass * g);
            bearing.ball_force = [turned * gx, turned * gy, gz];
            Seat { bearing, along: end.along, reversed: end.reversed }
        };
        self.ends.iter().map(seat).collect()
    }
}

/// Largest differences over the largest load; NaN stays.
#[derive(Default)]
struct Worst {
    ball_loads: f64,
    unbalanced: f64,
    sum: f64,
}

fn take(worst: &mut f64, value: f64) {
    if !(value <= *worst || worst.is_nan()) {
        *worst = value;
    }
}

fn compare(sample: &Shaft, ours: &AssemblySolution, worst: &mut Worst) {
    let seats = sample.seats();
    let at: [f64; 5] = ours.coordinates[0].into();
    let lever = 50e-3;
    let theirs = shaft::solve(&seats, &sample.loads, at, lever);
    let (_, loads, _) = shaft::evaluate(&seats, &at);
    let balls = theirs.balls.iter().flatten();
    let largest = balls.clone().fold(1.0, |most: f64, ball| most.max(ball.outer.load));
    let ours_balls = ours.bearings.iter().flat_map(|bearing| &bearing.balls);
    for (ours, theirs) in ours_balls.zip(balls) {
        take(&mut worst.ball_loads, (ours.inner.normal_load - theirs.inner.load).abs() / largest);
        take(&mut worst.ball_loads, (ours.outer.normal_load - theirs.outer.load).abs() / largest);
    }
    let unit = [1.0, 1.0, 1.0, lever, lever];
    for i in 0..5 {
        take(&mut worst.unbalanced, (loads[i] - sample.loads[i]).abs() / (unit[i] * largest));
    }
    let sum = ours.bearings.iter().fold(Vector3::zeros(), |sum, bearing| sum + bearing.forces[0]);
    for i in 0..3 {
        take(&mut worst.sum, (sum[i] + sample.loads[i]).abs() / largest);
    }
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut worst = Worst::default();
    let (mut solved, mut without, mut iterations, mut seed) = (0, 0u64, 0, 0);
    while solved < SAMPLES {
        seed += 1;
        let sample = Shaft::seeded(seed);
        // Some loads pull a shaft out of bearings that face the same way.
        let Ok(solution) = solve_assembly(&sample.assembly()?, None, &StaticOptions::default())
        else {
            without += 1;
            if without > SAMPLES as u64 {
                return Err(CaseError::message("more than half of the shafts have no equilibrium"));
            }
            continue;
        };
        solved += 1;
        iterations += solution.iterations;
        compare(&sample, &solution, &mut worst);
    }
    let origin =
        "energies by automatic differentiation, summed over the seats with a chain rule of its own";
    for (id, quantity, worst) in [
        ("ball_loads", "ball load, over the largest", worst.ball_loads),
        (
            "unbalanced",
            "unbalanced load at our position, over the largest ball load",
            worst.unbalanced,
        ),
    ] {
        let reason = "a place is known to an ulp of 0.1 m, 1e-17 m: of an overlap of 1 µm 1e-11; up to ten such in a row of balls";
        context.check(
            Check::new(id, &format!("largest difference in {quantity}, 50 shafts"), "1", worst)
                .independent(0.0, origin)
                .absolute(1e-10, reason),
        );
    }
    let reason = "rounding of coordinates: some ulps of the pitch radius times the stiffness of two bearings, 1e-8 N of some 100 N";
    context.check(
        Check::new(
            "sum",
            "loads of both bearings and applied ones, summed, over the largest",
            "1",
            worst.sum,
        )
        .consistency(0.0, "our ball loads against the applied loads")
        .absolute(5e-11, reason),
    );
    context.work("Newton iterations, 50 cold starts", iterations as u64);
    context.work("shafts without equilibrium", without);
    Ok(())
}
