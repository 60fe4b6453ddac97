//! Random bearings with random conditions, and how far two solvers differ on them.

use bearing_dynamics::solver::statics::{Condition, StaticSolution};

use crate::bearings::{self, Hertz, Lengths, known};

/// A bearing and what is prescribed for its inner race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub lengths: Lengths,
    /// rad.
    pub phase: f64,
    pub conditions: [Condition; 5],
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
            pitch_radius: ball_radius * spacing / (std::f64::consts::PI / balls as f64).sin(),
            inner_groove_radius: ball_radius * between(1.01, 1.12),
            outer_groove_radius: ball_radius * between(1.02, 1.12),
            ball_radius,
            contact_angle: if angular { between(12.0, 45.0).to_radians() } else { 0.0 },
            clearance: between(-20e-6, 40e-6),
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
        Sample { lengths, phase: between(0.0, std::f64::consts::TAU), conditions }
    }
}

/// Largest differences, loads over the largest ball load, positions over the largest overlap.
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
    let oracle = bearings::oracle(&sample.lengths, Hertz::Fit, sample.phase);
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
