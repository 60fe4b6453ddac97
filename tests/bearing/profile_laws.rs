//! Profiles over time: where they jump or bend, and that a problem knows all of these times.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::members::body::{Drive, DrivenBody, RotatingLoad, Rotation};
use bearing_dynamics::numeric::profile::Profile;
use common::table_4_1;
use dynamics::*;

const SEEN_TO: f64 = 3e-5;

/// Every kind of profile, twice and more, with the number of times at which value or slope jumps.
fn profiles() -> Vec<(Profile, usize)> {
    let (from, to, start, duration) = (1.0, 3.0, 0.2, 0.5);
    vec![
        (Profile::Constant(3.0), 0),
        (Profile::Ramp { from, to, start, duration }, 2),
        (Profile::Ramp { from, to, start: -0.2, duration }, 2),
        // A ramp of no duration is a step.
        (Profile::Ramp { from, to, start, duration: 0.0 }, 1),
        (Profile::SmoothRamp { from, to, start, duration }, 0),
        (Profile::Table { points: vec![[-0.1, 1.0], [0.3, 2.0], [0.31, 2.0], [0.9, -1.0]] }, 4),
        (Profile::Harmonic { mean: 2.0, amplitude: 0.5, frequency: 3.0, phase: 0.4 }, 0),
        (Profile::HalfSine { base: 1.0, peak: 5.0, start: 0.3, duration: 0.4 }, 2),
        (Profile::HalfSine { base: -1.0, peak: -5.0, start: -0.1, duration: 0.4 }, 2),
    ]
}

/// A new kind of profile does not compile until it has a number here, and fails until it is among
/// `profiles`.
fn kind(profile: &Profile) -> usize {
    match profile {
        Profile::Constant(_) => 0,
        Profile::Ramp { .. } => 1,
        Profile::SmoothRamp { .. } => 2,
        Profile::Table { .. } => 3,
        Profile::Harmonic { .. } => 4,
        Profile::HalfSine { .. } => 5,
    }
}

/// Times in (−0.5, 1.5) at which the value jumps or bends, by second differences of the value alone.
fn jumps(value: impl Fn(f64) -> f64) -> Vec<f64> {
    const STEP: f64 = 1e-5;
    let at = |k: i32| 1.234e-6 + STEP * f64::from(k);
    let mut found: Vec<f64> = Vec::new();
    for k in -50_000..150_000 {
        let bend = value(at(k + 1)) - 2.0 * value(at(k)) + value(at(k - 1));
        // A curvature of 400 1/s² leaves 4e-3 of a step, the least jump of a slope above 2 of one.
        let jumps = bend.abs() > 0.1 * STEP;
        if jumps && found.last().is_none_or(|last| at(k) - last > 3.0 * STEP) {
            found.push(at(k));
        }
    }
    found
}

/// No step should cross a jump of a load or a motion, or of its slope: each one that the values show is
/// in the list of corners.
#[test]
fn every_jump_of_a_profile_or_of_its_slope_is_a_corner() {
    let mut kinds: Vec<usize> = profiles().iter().map(|(profile, _)| kind(profile)).collect();
    kinds.sort_unstable();
    kinds.dedup();
    assert_eq!(kinds, [0, 1, 2, 3, 4, 5]);
    for (profile, expected) in profiles() {
        let found = jumps(|t| profile.value(t));
        assert_eq!(found.len(), expected, "{profile:?}: {found:?}");
        let corners = profile.corners();
        for jump in found {
            let near = corners.iter().any(|corner| (corner - jump).abs() <= SEEN_TO);
            assert!(near, "{profile:?}: nothing near {jump} among {corners:?}");
        }
    }
}

/// Wherever a profile stands in a problem, its corners are the problem's; alone and with all others.
#[test]
fn every_profile_of_a_problem_has_its_corners_there() {
    type Put = Box<dyn Fn(&mut DynamicProblem, Profile)>;
    let still = || bearing(table_4_1(-5e-6), [0.0; 5], 100.0);
    let mut places: Vec<Put> = Vec::new();
    for is_outer in [false, true] {
        let body = move |problem: &mut DynamicProblem, change: &dyn Fn(&mut DrivenBody)| {
            if is_outer {
                change(problem.outer.get_or_insert_with(free_race));
            } else {
                change(&mut problem.inner);
            }
        };
        for i in 0..5 {
            places.push(Box::new(move |problem, profile| {
                body(problem, &|race| race.drives[i] = Drive::Load(profile.clone()));
            }));
            places.push(Box::new(move |problem, profile| {
                body(problem, &|race| race.drives[i] = Drive::Motion(profile.clone()));
            }));
        }
        places.push(Box::new(move |problem, profile| {
            body(problem, &|race| race.rotation = Rotation::Speed(profile.clone()));
        }));
        places.push(Box::new(move |problem, profile| {
            body(problem, &|race| race.rotation = Rotation::Torque(profile.clone()));
        }));
    }
    let turning = || RotatingLoad { force: Profile::ZERO, speed: Profile::ZERO, phase: 0.0 };
    places.push(Box::new(move |problem, profile| {
        problem.rotating_load.get_or_insert_with(turning).force = profile;
    }));
    places.push(Box::new(move |problem, profile| {
        problem.rotating_load.get_or_insert_with(turning).speed = profile;
    }));
    assert_eq!(places.len(), 2 * 12 + 2);
    assert!(still().assembly().corners().is_empty());
    let check = |problem: &DynamicProblem, profile: &Profile| {
        let corners = problem.assembly().corners();
        assert!(corners.windows(2).all(|pair| pair[0] < pair[1]), "{corners:?}");
        for jump in jumps(|t| profile.value(t)).into_iter().filter(|jump| *jump > SEEN_TO) {
            let near = corners.iter().any(|corner| (corner - jump).abs() <= SEEN_TO);
            assert!(near, "{profile:?}: nothing near {jump} among {corners:?}");
        }
    };
    for (index, put) in places.iter().enumerate() {
        let start = 0.1 + 0.01 * index as f64;
        let profile = Profile::HalfSine { base: 0.5, peak: 2.0, start, duration: 0.3 };
        let mut alone = still();
        put(&mut alone, profile.clone());
        check(&alone, &profile);
        // Beside one in every other place that can have one at the same time.
        let mut beside = still();
        let ramp = Profile::Ramp { from: 0.0, to: 1.0, start: 0.05, duration: 0.9 };
        places.iter().step_by(2).for_each(|other| other(&mut beside, ramp.clone()));
        put(&mut beside, profile.clone());
        check(&beside, &profile);
        check(&beside, &ramp);
    }
}

/// At a corner rate and acceleration are those of what follows: a run that has come there goes on with them, and books the jump.
#[test]
fn at_a_corner_rates_are_of_what_follows() {
    let corners = [(0.3, 0.4), (3e-3, 7e-3), (4e-3, 13e-3), (0.1, 0.2), (1e-3, 0.5e-3)];
    for (start, duration) in corners {
        let (from, to) = (1.0, 3.0);
        for profile in [
            Profile::Ramp { from, to, start, duration },
            Profile::SmoothRamp { from, to, start, duration },
            Profile::HalfSine { base: from, peak: to, start, duration },
            Profile::Table { points: vec![[start, from], [start + duration, to], [1.0, 0.0]] },
        ] {
            for corner in profile.corners() {
                let after = corner + 1e-9 * duration;
                let steep = (to / duration, to / duration.powi(2));
                let rate = (profile.rate(corner) - profile.rate(after)).abs() / steep.0;
                let bend = (profile.acceleration(corner) - profile.acceleration(after)).abs();
                // What changes smoothly does so by a billionth of its way.
                assert!(
                    rate <= 1e-7 && bend / steep.1 <= 1e-6,
                    "{profile:?} at {corner}: {rate:e} {bend:e}"
                );
            }
        }
    }
}
