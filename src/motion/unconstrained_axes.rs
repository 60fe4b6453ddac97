//! Whether something holds each bearing against the loads of all times.
//!
//! Races that nothing holds along an axis, neither a given coordinate nor a spring, fly off as soon as a load
//! acts there. At t = 0 the search for the equilibrium finds that; here it is found for later times.

use crate::assembly::lists::{Assembly, Body, Mobility};
use crate::assembly::loads::Drive;
use crate::equilibrium::initial::given_speed;
use crate::equilibrium::statics::{COORDINATE_NAMES, StaticsError};

/// Loads are looked at so many times between two corners; a harmonic or rotating one is not missed between them.
const LOOKS: usize = 16;
/// And for so long after the last corner, s.
const AFTER: f64 = 1.0;
/// Loads that balance but for this part of the largest one are held by each other.
const BALANCED: f64 = 1e-9;

/// # Errors
/// Bodies joined by bearings that nothing holds along one of the axes X, Y, Z while their loads there do
/// not balance, now or later.
pub fn check_unconstrained_axes(assembly: &Assembly) -> Result<(), StaticsError> {
    let times = times(assembly);
    for i in 0..3 {
        for group in groups(assembly, i) {
            let of = |index: &usize| &assembly.bodies[*index];
            if group.iter().map(of).any(|body| is_held_along(body, i)) {
                continue;
            }
            for t in &times {
                let loads: Vec<f64> =
                    group.iter().map(|body| load_on(assembly, *body, i, *t)).collect();
                let sum = loads.iter().sum::<f64>() + weight_of_balls(assembly, &group, i);
                let largest = loads.iter().fold(0.0f64, |most, load| most.max(load.abs()));
                if sum.abs() > BALANCED * largest {
                    // The outer race comes after the inner one.
                    let last = group.iter().rev().map(of).find(|body| body.driven().is_some());
                    return Err(StaticsError::Unheld {
                        body: last.map_or(String::new(), |body| body.name.clone()),
                        coordinate: COORDINATE_NAMES[i],
                        load: sum,
                        time: *t,
                    });
                }
            }
        }
    }
    Ok(())
}

fn is_held_along(body: &Body, i: usize) -> bool {
    match &body.mobility {
        Mobility::Fixed => true,
        Mobility::Free(_) => false,
        Mobility::Driven(race) => {
            matches!(race.drives[i], Drive::Motion(_)) || race.foundation_stiffness[i] != 0.0
        }
    }
}

/// Bodies that bearings, or springs along an axis, join: each in one group.
fn groups(assembly: &Assembly, axis: usize) -> Vec<Vec<usize>> {
    let mut of: Vec<usize> = (0..assembly.bodies.len()).collect();
    let mut join = |one: usize, other: usize| {
        let (from, to) = (of[other], of[one]);
        of.iter_mut().filter(|group| **group == from).for_each(|group| *group = to);
    };
    for bearing in &assembly.bearings {
        let [inner, outer] = bearing.mounts.map(|mount| mount.body);
        join(inner, outer);
        if let Some(cage) = &bearing.cage {
            join(inner, cage.body);
        }
    }
    for connection in assembly.connections.iter().filter(|of| of.holds_along(axis)) {
        let [one, other] = connection.ends.map(|mount| mount.body);
        join(one, other);
    }
    let members = |group| (0..of.len()).filter(|body| of[*body] == group).collect::<Vec<_>>();
    (0..of.len()).map(members).filter(|members| !members.is_empty()).collect()
}

fn times(assembly: &Assembly) -> Vec<f64> {
    let mut ends = vec![0.0];
    ends.extend(assembly.corners());
    ends.push(ends.last().copied().unwrap_or(0.0) + AFTER);
    let between = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        (0..LOOKS).map(move |k| from + (to - from) * k as f64 / LOOKS as f64).collect::<Vec<_>>()
    };
    ends.windows(2).flat_map(between).chain(ends.last().copied()).collect()
}

/// Given load, weight, rotating load and unbalance of a body along an axis, N.
fn load_on(assembly: &Assembly, index: usize, i: usize, t: f64) -> f64 {
    let body = &assembly.bodies[index];
    let weight = body.inertia().map_or(0.0, |inertia| inertia.mass * assembly.gravity[i]);
    let given = match body.driven().map(|race| &race.drives[i]) {
        Some(Drive::Load(profile)) => profile.value(t),
        Some(Drive::Motion(_)) | None => 0.0,
    };
    let turning = body.rotating_load.as_ref().map_or(0.0, |load| load.force(t)[i]);
    let speed = given_speed(body, t);
    let unbalance = if i == 0 { 0.0 } else { body.unbalance * speed * speed };
    weight + given + turning + unbalance
}

fn weight_of_balls(assembly: &Assembly, group: &[usize], i: usize) -> f64 {
    let inside = assembly.bearings.iter().filter(|bearing| group.contains(&bearing.mounts[0].body));
    inside
        .map(|bearing| bearing.geometry.ball_count as f64 * bearing.ball.mass * assembly.gravity[i])
        .sum()
}
