//! Random bearings with random conditions, and how far two solvers differ on them.

use std::f64::consts::{PI, TAU};

use bearing_dynamics::ch2_housing::bearing::geometry::ClearanceThrough;
use bearing_dynamics::ch2_housing::bearing::hertz::HertzError;
use bearing_dynamics::equilibrium::statics::{StaticProblem, StaticSolution};
use bearing_dynamics::kinematics::{Pose, euler};
use bearing_dynamics::members::body::Condition;
use nalgebra::Vector3;

use crate::bearings::{self, Hertz, Lengths, known};
use crate::oracles::statics::OracleBearing;

/// A bearing, where its outer race stands, what acts on its balls and what is prescribed for its
/// inner race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub lengths: Lengths,
    /// rad.
    pub phase: f64,
    pub conditions: [Condition; 5],
    /// x, y, z (m), tilt_y, tilt_z (rad) of the outer race.
    pub outer_race: [f64; 5],
    /// Acceleration that acts on the balls, m/s²: gravity, or shaking in mid-swing.
    pub gravity: [f64; 3],
    /// Speed of the ball set, rad/s.
    pub orbital_speed: f64,
}

impl Sample {
    /// The sample of a seed.
    pub fn seeded(seed: u64) -> Sample {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        // SplitMix64 (Steele, Lea and Flood, 2014): passes as random for any seed.
        Sample::from_unit_numbers(|| {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            (z ^ (z >> 31)) as f64 / u64::MAX as f64
        })
    }

    /// A sample from a source of numbers between 0 and 1.
    pub fn from_unit_numbers(mut unit: impl FnMut() -> f64) -> Sample {
        let mut between = |low: f64, high: f64| low + (high - low) * unit();
        let angular = between(0.0, 1.0) < 0.5;
        let balls = between(6.0, 15.0) as usize;
        let ball_radius = between(3e-3, 7e-3);
        let spacing = between(1.3, 2.0);
        let lengths = Lengths {
            balls,
            pitch_radius: ball_radius * spacing / (PI / balls as f64).sin(),
            inner_groove_radius: ball_radius * between(1.01, 1.12),
            outer_groove_radius: ball_radius * between(1.02, 1.12),
            ball_radius,
            contact_angle: if angular { between(12.0, 45.0).to_radians() } else { 0.0 },
            clearance: between(-20e-6, 40e-6),
            through: match between(0.0, 4.0) {
                part if part < 1.0 => ClearanceThrough::InnerRace,
                part if part < 2.0 => ClearanceThrough::OuterRace,
                _ => ClearanceThrough::Ball,
            },
        };
        // Loads that make overlaps of some µm, whatever the size of the bearing.
        let force = ball_radius * ball_radius * 4e7;
        let moment = force * lengths.pitch_radius;
        let axial = if angular { between(0.5, 2.0) } else { between(-2.0, 2.0) };
        let mut conditions = [
            Condition::Load(force * axial),
            Condition::Load(force * between(-2.0, 2.0)),
            Condition::Load(force * between(-2.0, 2.0)),
            Condition::Load(moment * between(-0.3, 0.3)),
            Condition::Load(moment * between(-0.3, 0.3)),
        ];
        for (i, condition) in conditions.iter_mut().enumerate() {
            if between(0.0, 1.0) < 0.35 {
                *condition = Condition::Displacement(match i {
                    0 => between(-5e-6, 15e-6),
                    1 | 2 => between(-10e-6, 10e-6),
                    _ => between(-0.5, 0.5).to_radians(),
                });
            }
        }
        let phase = between(0.0, TAU);
        // Half of the samples each: a moved outer race, weight, rotation. At 1000 m/s² a ball
        // weighs some newtons; at 1000 rad/s it pulls with hundreds.
        let [moved, heavy, turning] = [(); 3].map(|()| between(0.0, 1.0) < 0.5);
        let mut only_if = |wanted: bool, low: f64, high: f64| {
            let value = between(low, high);
            if wanted { value } else { 0.0 }
        };
        let mut outer_race = [0.0; 5];
        for (i, coordinate) in outer_race.iter_mut().enumerate() {
            let reach = if i < 3 { 50e-6 } else { 0.5f64.to_radians() };
            *coordinate = only_if(moved, -reach, reach);
            // Given displacements of the inner race count from the outer one.
            if let Condition::Displacement(value) = &mut conditions[i] {
                *value += *coordinate;
            }
        }
        let gravity = [(); 3].map(|()| only_if(heavy, -1e3, 1e3));
        let orbital_speed = only_if(turning, 50.0, 1e3);
        Sample { lengths, phase, conditions, outer_race, gravity, orbital_speed }
    }

    /// What the program makes of the sample.
    pub fn problem(&self) -> Result<StaticProblem, HertzError> {
        let mut problem =
            bearings::problem(&self.lengths, Hertz::Fit, self.phase, self.conditions)?;
        let [x, y, z, tilt_y, tilt_z] = self.outer_race;
        problem.outer_pose = Pose {
            position: Vector3::new(x, y, z),
            orientation: euler::quaternion(0.0, tilt_y, tilt_z),
        };
        problem.gravity = Vector3::from(self.gravity);
        problem.orbital_speed = self.orbital_speed;
        Ok(problem)
    }

    /// What the independent solver makes of it.
    pub fn oracle(&self) -> OracleBearing {
        let mut oracle = bearings::oracle(&self.lengths, Hertz::Fit, self.phase);
        let [x, y, z, xi, lambda] = self.outer_race;
        oracle.outer_position = [x, y, z];
        // Ry(ξ) Rz(λ), multiplied out.
        let ((sx, cx), (sl, cl)) = (xi.sin_cos(), lambda.sin_cos());
        oracle.outer_rotation = [[cx * cl, -cx * sl, sx], [sl, cl, 0.0], [-sx * cl, sx * sl, cx]];
        let mass = ball_mass(oracle.ball_radius);
        oracle.ball_force = self.gravity.map(|g| mass * g);
        oracle.centrifugal = mass * self.orbital_speed * self.orbital_speed;
        oracle
    }

    /// Weight or centrifugal force of a ball, whichever is larger, N.
    fn body_force(&self) -> f64 {
        let mass = ball_mass(self.lengths.ball_radius);
        let [x, y, z] = self.gravity;
        let weight = mass * (x * x + y * y + z * z).sqrt();
        weight.max(mass * self.orbital_speed * self.orbital_speed * self.lengths.pitch_radius)
    }
}

/// Of steel, 7850 kg/m³; kg.
fn ball_mass(radius: f64) -> f64 {
    7850.0 * 4.0 / 3.0 * PI * radius * radius * radius
}

/// Largest differences, loads over the largest ball load or body force, positions over the largest overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disagreement {
    pub ball_loads: f64,
    /// Reported loads against the oracle's gradient at our position.
    pub loads_at_ours: f64,
    /// Prescribed loads against the oracle's gradient at our position.
    pub unbalanced: f64,
    pub position: f64,
}

impl Disagreement {
    /// Larger of both, entry by entry; NaN stays.
    pub fn max(self, other: Disagreement) -> Disagreement {
        let larger = |a: f64, b: f64| if a >= b || a.is_nan() { a } else { b };
        Disagreement {
            ball_loads: larger(self.ball_loads, other.ball_loads),
            loads_at_ours: larger(self.loads_at_ours, other.loads_at_ours),
            unbalanced: larger(self.unbalanced, other.unbalanced),
            position: larger(self.position, other.position),
        }
    }
}

/// How far the oracle's equilibrium, and its loads at our position, are from ours.
pub fn disagreement(sample: &Sample, ours: &StaticSolution) -> Disagreement {
    let oracle = sample.oracle();
    let known = known(&sample.conditions);
    let at: [f64; 5] = std::array::from_fn(|i| ours.coordinates[i]);
    let theirs = oracle.solve(&known, Some(at));
    let (_, loads, _) = oracle.evaluate(&at);

    let lever = sample.lengths.pitch_radius;
    let unit = [1.0, 1.0, 1.0, lever, lever];
    let applied = sample.conditions.iter().zip(unit).map(|(condition, unit)| match condition {
        Condition::Load(load) => (load / unit).abs(),
        Condition::Displacement(_) => 0.0,
    });
    let largest = theirs
        .balls
        .iter()
        .flat_map(|ball| [ball.inner.load, ball.outer.load])
        .chain(applied)
        .chain([sample.body_force()])
        .fold(f64::MIN_POSITIVE, f64::max);
    let overlap = theirs
        .balls
        .iter()
        .map(|ball| ball.inner.approach + ball.outer.approach)
        .fold(1e-6, f64::max);

    let mut worst = Disagreement::default();
    for (ours, theirs) in ours.balls.iter().zip(&theirs.balls) {
        for difference in
            [ours.inner.normal_load - theirs.inner.load, ours.outer.normal_load - theirs.outer.load]
        {
            let ball_loads = difference.abs() / largest;
            worst = worst.max(Disagreement { ball_loads, ..Default::default() });
        }
    }
    for i in 0..5 {
        let scale = unit[i] * largest;
        let unbalanced = match sample.conditions[i] {
            Condition::Load(load) => (loads[i] - load).abs() / scale,
            Condition::Displacement(value) => (at[i] - value).abs() / value.abs().max(1e-12),
        };
        worst = worst.max(Disagreement {
            ball_loads: 0.0,
            loads_at_ours: (ours.loads[i] - loads[i]).abs() / scale,
            unbalanced,
            position: (at[i] - theirs.coordinates[i]).abs() * unit[i] / overlap,
        });
    }
    worst
}
