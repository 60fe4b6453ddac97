//! Every entry of the linearised contacts against differences of the very quantity it is the
//! derivative of, one direction at a time: levers, stiffness, damping, slopes of friction, what the
//! contact point carries along. Sums over a whole bearing, as in the tests beside, hide an entry that is
//! small in them.

use super::*;
use crate::common::table_4_1;
use bearing_dynamics::assembly::lists::CAGE;
use bearing_dynamics::ch2_housing::bearing::cage::{
    CageContact, CageForce, cage_energy, cage_load, cage_stiffness,
};
use bearing_dynamics::ch2_housing::bearing::slices::{
    Patch, Slices, Sliding, integrate, integrate_slope,
};
use bearing_dynamics::ch2_housing::bearing::traction::ExponentialCurve;
use bearing_dynamics::members::state::LANES;

/// What one contact between a ball and a race is made of: δ̇, slip along t and s, spin about n.
fn motion_of(point: &Point, pair: usize) -> [f64; 4] {
    let table = &point.system.sets[0].table;
    let sliding = &table.sliding[pair];
    let [along, across] = sliding.slip;
    [table.contact[pair].closing_speed, along, across, sliding.relative_spin[2]]
}

/// Traction along t and s and moment about n on the ball.
fn pushes_of(point: &Point, pair: usize, before: &Sliding, normal: Vec3) -> [f64; 3] {
    let traction = &point.system.sets[0].table.traction[pair];
    [
        dot(traction.force, before.rolling_direction),
        dot(traction.force, before.transverse_direction),
        dot(traction.moment, normal),
    ]
}

impl Point {
    /// Central difference of `what` as `shift` moves the state by ± `step`.
    fn slope<const N: usize>(
        &mut self,
        step: f64,
        shift: impl Fn(&mut [f64], f64),
        what: impl Fn(&Point) -> [f64; N],
    ) -> [f64; N] {
        let [plus, minus] = [1.0, -1.0].map(|side| {
            let mut there = self.state.clone();
            shift(&mut there, side * step);
            let mut rates = vec![0.0; there.len()];
            self.system.evaluate_with(Want::ForcesAndSlopes, 0.0, &there, &mut rates);
            what(self)
        });
        let state = self.state.clone();
        self.system.evaluate_with(Want::ForcesAndSlopes, 0.0, &state, &mut vec![0.0; state.len()]);
        std::array::from_fn(|i| (plus[i] - minus[i]) / (2.0 * step))
    }
}

/// Entry of a ball's linear (0..3) or angular (3..6) velocity.
fn ball_rate(layout: &Layout, ball: usize, i: usize) -> usize {
    layout.ball(if i < 3 { VELOCITY + i } else { SPIN + i - 3 }) + ball
}

fn close(found: f64, expected: f64, scale: f64, tolerance: f64, what: &dyn Fn() -> String) {
    assert!(
        (found - expected).abs() <= tolerance * scale,
        "{}: {found:e} for {expected:e}",
        what()
    );
}

/// All entries of the contacts of balls with races at a point.
fn races_hold(name: &str, point: &mut Point) {
    let layout = point.system.sets[0].layout;
    let geometry = point.system.assembly.bearings[0].geometry;
    let mut judged = 0;
    for pair in point.system.sets[0].table.active.clone() {
        let (side, ball) = layout.race_and_ball(pair);
        let (block, lane) = (ball / LANES, ball % LANES);
        let contact = point.linearised.blocks[block].contacts[side].clone();
        let here = point.system.sets[0].table.sliding[pair];
        let normal = point.system.sets[0].table.contact[pair].normal;
        let what = |part: &str| format!("{name}, race {side}, ball {}, {part}", ball + 1);
        judged += 1;
        // Levers: motions of a contact are linear in the velocities.
        for i in 0..6 {
            let entry = ball_rate(&layout, ball, i);
            let found =
                point.slope(1.0, |state, by| state[entry] += by, |point| motion_of(point, pair));
            // m/s for m/s, or m for rad/s: to rounding of speeds of 1 m/s at an arm of 6 mm.
            for row in 0..contact.rows {
                let expected = contact.on_ball[row][i][lane];
                close(found[row], expected, 1.0, 1e-11, &|| what(&format!("on ball {row} {i}")));
            }
        }
        if let Some(hub) = contact.hub.map(|hub| point.linearised.hubs[hub]) {
            for i in 0..6 {
                let shift = |state: &mut [f64], by: f64| {
                    let mut six = [0.0; 6];
                    six[i] = by;
                    let [a, b, c] = hub.basis;
                    let turning = add(add(scale(a, six[3]), scale(b, six[4])), scale(c, six[5]));
                    for k in 0..3 {
                        state[hub.at + VELOCITY + k] += six[k];
                        state[hub.at + SPIN + k] += turning[k];
                    }
                };
                let found = point.slope(1.0, shift, |point| motion_of(point, pair));
                for row in 0..contact.rows {
                    let expected = contact.on_hub[row][i][lane];
                    close(found[row], expected, 1.0, 1e-11, &|| what(&format!("on hub {row} {i}")));
                }
            }
        }
        // Stiffness and dashpot along the normal. Overlaps of 1 µm, moved by 1e-4 of themselves.
        let along = |size: Vec3, at: usize| {
            move |state: &mut [f64], by: f64| {
                for i in 0..3 {
                    state[layout.ball(at + i) + ball] += by * size[i];
                }
            }
        };
        let load = |point: &Point| [point.system.sets[0].table.load[pair]];
        let [found] = point.slope(1e-11, along(normal, POSITION), load);
        let stiffness = contact.stiffness[lane];
        // δ̇ changes as well where the race turns, by ω for a unit of displacement.
        close(found, stiffness, stiffness, 1e-3, &|| what("stiffness"));
        let [found] = point.slope(1e-4, along(normal, VELOCITY), load);
        let damping = contact.damping[lane];
        close(found, damping, damping.max(1e-6), 1e-6, &|| what("damping"));
        if contact.rows < 4 {
            continue;
        }
        // What the contact point carries along, against differences of slips and spin. Left out: how the
        // directions of the slip turn, slip over radius.
        let slips = |point: &Point| {
            let [_, along, across, about] = motion_of(point, pair);
            [along, across, about * 1e-3]
        };
        let size: f64 =
            contact.slip_change[0].iter().map(|row| row[lane] * row[lane]).sum::<f64>().sqrt();
        let spun: f64 =
            contact.slip_change[2].iter().map(|row| row[lane] * row[lane]).sum::<f64>().sqrt();
        for i in 0..3 {
            let entry = layout.ball(POSITION + i) + ball;
            let found = point.slope(1e-8, |state, by| state[entry] += by, slips);
            for row in 0..3 {
                let (per, of) = if row == 2 { (1e-3, spun) } else { (1.0, size) };
                let expected = per * contact.slip_change[row][i][lane];
                close(found[row], expected, per * of, 5e-3, &|| {
                    what(&format!("carried {row} {i}"))
                });
            }
        }
        // Slopes of traction, by slips and spin of the ball; the race feels the opposite.
        let slope = contact.slope;
        let [tt, ts, tn, ss, sn, nn] = slope.map(|of| of[lane]);
        let rows = [[tt, ts, tn], [ts, ss, sn], [tn, sn, nn]];
        let width = geometry.ball_radius * 1e-2;
        for (row, direction) in
            [here.rolling_direction, here.transverse_direction, normal].into_iter().enumerate()
        {
            let at = if row < 2 { VELOCITY } else { SPIN };
            let step = if row < 2 { 1e-6 } else { 1e-6 / width };
            let found = point
                .slope(step, along(direction, at), |point| pushes_of(point, pair, &here, normal));
            for column in 0..3 {
                let expected = -rows[column][row];
                // Moments about n and their spin by the contact's half width.
                let arm = |index: usize| if index == 2 { width } else { 1.0 };
                let scale = tt.max(ss) * arm(row) * arm(column);
                close(found[column], expected, scale, 1e-4, &|| {
                    what(&format!("slope {column} {row}"))
                });
            }
        }
    }
    assert!(judged > 0, "{name}: nothing is loaded");
}

/// A friction law whose coefficient hangs on the slip alone, so that nothing of its slope is left out.
fn by_slip_alone(law: TractionLaw) -> TractionLaw {
    match law {
        TractionLaw::SlideToRoll { .. } => TractionLaw::SlideToRoll {
            curve: ExponentialCurve::BOUNDARY,
            // Above every entrainment here.
            entrainment_floor: 1e3,
        },
        other => other,
    }
}

#[test]
fn entries_of_race_contacts_in_every_configuration() {
    let deep = |speed| bearing(table_4_1(-1e-6), [3.0, 4.0, -20.0, 0.0, 0.0], speed);
    let tilted = |mut problem: DynamicProblem| {
        problem.outer_start = [2e-6, -1e-6, 3e-6, 2e-3, -3e-3];
        problem
    };
    let moving = |mut problem: DynamicProblem| {
        let mut outer = free_race();
        outer.foundation_stiffness = [3e7, 5e7, 4e7, 3e4, 2e4];
        problem.outer = Some(outer);
        problem
    };
    let given = |mut problem: DynamicProblem| {
        problem.inner.drives[1] = Drive::Motion(Profile::ZERO);
        problem.inner.drives[3] = Drive::Motion(Profile::Constant(1e-5));
        problem
    };
    let cases: Vec<(&str, DynamicProblem)> = vec![
        ("angular", light(FAST)),
        ("angular, moving outer race", moving(light(FAST))),
        ("angular, tilted", tilted(moving(light(FAST)))),
        ("deep groove", deep(FAST)),
        ("deep groove, moving outer race, tilted", tilted(moving(deep(FAST)))),
        ("deep groove, motion given", given(deep(FAST))),
    ];
    let dampings = [ContactDamping::None, ContactDamping::HuntCrossley { alpha: 0.2 }];
    for (name, problem) in cases {
        for (index, law) in traction_laws().into_iter().enumerate() {
            let mut problem = DynamicProblem {
                traction: by_slip_alone(law),
                damping: dampings[index % 2],
                ..problem.clone()
            };
            // Hardly: what closes at 1 cm/s would turn with the normal, which is left out.
            let state = shaken(&problem, 1e-5, &mut Noise(index as u64));
            let turned = |body: &mut bearing_dynamics::members::body::DrivenBody| {
                body.rotation = Rotation::Torque(Profile::ZERO);
            };
            turned(&mut problem.inner);
            let mut point = linearised(&problem, state);
            races_hold(&format!("{name}, law {index}"), &mut point);
        }
    }
}

#[test]
fn given_velocities_drive_contacts_along_their_rows() {
    let mut problem = light(FAST);
    problem.traction = CONSTANT;
    let layout = Layout::new(problem.geometry.ball_count, false);
    let state = start::at_equilibrium(&problem.assembly()).unwrap();
    for i in 0..3 {
        let (from, rate) = (state[layout.inner() + POSITION + i], [1e-3, -2e-3, 3e-3][i]);
        problem.inner.drives[i] =
            Drive::Motion(Profile::Table { points: vec![[-1.0, from - rate], [1.0, from + rate]] });
    }
    let point = linearised(&problem, state.clone());
    // The same race, standing still.
    let mut still = problem.clone();
    for i in 0..3 {
        still.inner.drives[i] =
            Drive::Motion(Profile::Constant(state[layout.inner() + POSITION + i]));
    }
    still.inner.rotation = Rotation::Speed(Profile::ZERO);
    let resting = linearised(&still, state);
    for &pair in point.system.sets[0].table.active.iter().filter(|pair| **pair < layout.padded) {
        let contact = &point.linearised.blocks[pair / LANES].contacts[0];
        let (moved, rested) = (motion_of(&point, pair), motion_of(&resting, pair));
        for row in 0..4 {
            let driven = contact.driven[row][pair % LANES];
            let difference = moved[row] - rested[row];
            let scale = if row == 3 { 100.0 } else { 2.0 };
            close(difference, driven, scale, 1e-9, &|| format!("driven {row} of pair {pair}"));
        }
    }
}

#[test]
fn laws_of_the_cage_are_derivatives_of_each_other() {
    for force in [CageForce::Penalty { stiffness: 2e8 }, CageForce::Hertz { stiffness: 3e10 }] {
        for depth in [1e-8, 1e-6, 3e-5] {
            let step = 1e-4 * depth;
            let slope =
                |of: &dyn Fn(f64) -> f64| (of(depth + step) - of(depth - step)) / (2.0 * step);
            let load = cage_load(&force, depth);
            let stiffness = cage_stiffness(&force, depth);
            // Differences over 1e-4 of the depth, of the second order.
            assert!((slope(&|d| cage_energy(&force, d)) / load - 1.0).abs() <= 1e-7);
            assert!((slope(&|d| cage_load(&force, d)) / stiffness - 1.0).abs() <= 1e-7);
        }
        assert_eq!(cage_load(&force, -1e-6) + cage_stiffness(&force, -1e-6), 0.0);
    }
}

/// Penetration rate and sliding along two directions that stay where they are.
fn cage_motion(contact: &CageContact, other: Vec3, own: Vec3, rows: &[Vec3; 3]) -> [f64; 3] {
    let _ = contact;
    let relative = add(other, scale(own, -1.0));
    rows.map(|row| dot(relative, row))
}

#[test]
fn entries_of_cage_contacts_with_either_law() {
    for (pocket, guidance) in
        [(Pocket::Cylindrical, Guidance::OuterRace), (Pocket::Spherical, Guidance::InnerRace)]
    {
        for hertz in [false, true] {
            let (mut problem, state) = caged(pocket, guidance, 0.1, FAST);
            if hertz {
                // As stiff as the penalty at 1 µm, but not its slope.
                problem.cage.as_mut().unwrap().contacts.force =
                    CageForce::Hertz { stiffness: 1e10 };
            }
            let mut point = linearised(&problem, state);
            let layout = point.system.sets[0].layout;
            let cage_at = layout.cage();
            let cage_hub = point.linearised.hubs[point.linearised.hub_of[CAGE].unwrap()];
            let mut judged = 0;
            for ball in 0..layout.balls {
                let contact = point.system.sets[0].pockets[ball];
                if contact.normal_load == 0.0 {
                    continue;
                }
                judged += 1;
                let (block, lane) = (ball / LANES, ball % LANES);
                let row = point.linearised.blocks[block].contacts[2].clone();
                let what =
                    |part: &str| format!("{pocket:?} hertz {hertz} ball {}: {part}", ball + 1);
                // Load over penetration, as the ball moves along the push.
                let push = contact.push;
                let shift = move |state: &mut [f64], by: f64| {
                    for i in 0..3 {
                        state[layout.ball(POSITION + i) + ball] += by * push[i];
                    }
                };
                let [load, depth] = point.slope(1e-10, shift, |point| {
                    let pocket = &point.system.sets[0].pockets[ball];
                    [pocket.normal_load, pocket.penetration]
                });
                let stiffness = row.stiffness[lane];
                close(load / depth, stiffness, stiffness, 1e-6, &|| what("stiffness"));
                // Motion along the three rows, from levers on ball and cage.
                let directions: [Vec3; 3] =
                    [0, 1, 2].map(|r: usize| [0, 1, 2].map(|i: usize| row.on_ball[r][i][lane]));
                close(dot(directions[0], push), 1.0, 1.0, 1e-12, &|| what("push"));
                let arm_ball = {
                    let place = layout.ball_vector(&point.state, POSITION, ball);
                    add(contact.point, scale(place, -1.0))
                };
                let arm_cage = add(contact.point, scale(vector(&point.state, cage_at), -1.0));
                for i in 0..6 {
                    let mut six = [0.0; 6];
                    six[i] = 1.0;
                    let (linear, turning) = ([six[0], six[1], six[2]], [six[3], six[4], six[5]]);
                    let moved = add(linear, cross(turning, arm_ball));
                    let expected = cage_motion(&contact, moved, [0.0; 3], &directions);
                    let [a, b, c] = cage_hub.basis;
                    let turning = add(add(scale(a, six[3]), scale(b, six[4])), scale(c, six[5]));
                    let moved = add(linear, cross(turning, arm_cage));
                    let of_cage = cage_motion(&contact, [0.0; 3], moved, &directions);
                    for r in 0..3 {
                        close(row.on_ball[r][i][lane], expected[r], 1.0, 1e-12, &|| {
                            what("on ball")
                        });
                        close(row.on_hub[r][i][lane], of_cage[r], 1.0, 1e-12, &|| what("on hub"));
                    }
                }
                // Friction along both tangents, by the ball's velocity.
                for (r, entry) in [(1, 0), (2, 3)] {
                    let direction = directions[r];
                    let shift = move |state: &mut [f64], by: f64| {
                        for i in 0..3 {
                            state[layout.ball(VELOCITY + i) + ball] += by * direction[i];
                        }
                    };
                    let [found] = point.slope(1e-4, shift, |point| {
                        [dot(point.system.sets[0].pockets[ball].force, direction)]
                    });
                    let slope = row.slope[entry][lane];
                    close(-found, slope, slope, 1e-6, &|| what(&format!("friction {r}")));
                }
            }
            assert!(judged > 0);
            for (end, guide) in point.linearised.joints.clone().into_iter().enumerate() {
                let contact = point.system.sets[0].guides[end];
                assert_eq!(guide.count, 3);
                let push = contact.push;
                let along = move |at: usize, direction: Vec3| {
                    move |state: &mut [f64], by: f64| {
                        for i in 0..3 {
                            state[cage_at + at + i] -= by * direction[i];
                        }
                    }
                };
                let [load, depth] = point.slope(1e-10, along(POSITION, push), |point| {
                    let guide = &point.system.sets[0].guides[end];
                    [guide.normal_load, guide.penetration]
                });
                let what = |part: &str| format!("{guidance:?} hertz {hertz} end {end}: {part}");
                close(
                    load / depth,
                    guide.rows[0].stiffness,
                    guide.rows[0].stiffness,
                    1e-6,
                    &|| what("stiffness"),
                );
                for r in 1..3 {
                    let direction: Vec3 = [0, 1, 2].map(|i: usize| -guide.rows[r].levers[1][i]);
                    let shift = along(VELOCITY, direction);
                    let [found] = point.slope(1e-4, shift, |point| {
                        [dot(point.system.sets[0].guides[end].force, direction)]
                    });
                    let slope = guide.rows[r].damping;
                    close(-found, slope, slope, 1e-6, &|| what(&format!("friction {r}")));
                }
            }
        }
    }
}

#[test]
fn slopes_of_all_slices_are_those_of_their_sum() {
    let mut noise = Noise(9);
    let directions = Sliding {
        rolling_direction: [1.0, 0.0, 0.0],
        transverse_direction: [0.0, 1.0, 0.0],
        entrainment: 2.0,
        ..Sliding::default()
    };
    for (index, law) in traction_laws().into_iter().enumerate().skip(1) {
        for (count, across) in [(1, 1), (5, 1), (15, 1), (1, 2), (5, 3), (15, 4)] {
            let slices = Slices::new(count, across);
            for _ in 0..20 {
                // Before the peak of every law; beyond it a falling slope counts as none.
                let size = [0.0, 0.03, 3e-3, 0.03][index];
                let mut sliding = directions;
                sliding.slip = [size * noise.next(), size * noise.next()];
                let width = 1e-3;
                let patch =
                    Patch { semi_major: width, semi_minor: 0.4 * width, half_curvature: 0.0 };
                sliding.relative_spin = [0.0, 0.0, 0.3 * size / width * noise.next()];
                let at = |shift: [f64; 3]| {
                    let mut moved = sliding;
                    moved.slip[0] += shift[0];
                    moved.slip[1] += shift[1];
                    moved.relative_spin[2] += shift[2];
                    let sum = integrate(&law, &slices, &moved, &patch);
                    [sum.rolling, sum.transverse, sum.moment]
                };
                let [tt, ts, tn, ss, sn, nn] = integrate_slope(&law, &slices, &sliding, &patch);
                let expected = [[tt, ts, tn], [ts, ss, sn], [tn, sn, nn]];
                for row in 0..3 {
                    let arm = |i: usize| if i == 2 { width } else { 1.0 };
                    let step = 1e-5 * size / arm(row);
                    let mut shift = [0.0; 3];
                    shift[row] = step;
                    let (plus, minus) = (at(shift), at(shift.map(|s| -s)));
                    for column in 0..3 {
                        let found = -(plus[column] - minus[column]) / (2.0 * step);
                        let scale = tt.max(ss) * arm(row) * arm(column);
                        let error = (found - expected[row][column]).abs();
                        // Steps of 1e-5 of the slip.
                        assert!(
                            error <= 1e-4 * scale,
                            "law {index}, {count} slices of {across}, {row} {column}: {found:e} for {:e}",
                            expected[row][column]
                        );
                    }
                }
            }
        }
    }
}
