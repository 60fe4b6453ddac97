//! Laws of spalls (5.4.3), waviness and balls of different size: the envelope against the ball's circle on the profile, forces
//! against the energy, a bearing against its books.

use super::dynamics_integrators::{motion, started};
use crate::dynamics::{self, Noise, RPM, free_race};
use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::geometry::BearingGeometry;
use bearing_dynamics::ch5_cage::raceway_profile::{RacewayProfile, Spall, Surface, Waviness};
use bearing_dynamics::ch5_cage::spall::{ROUNDED, SpallLaw, SpallShape};
use bearing_dynamics::kinematics::vec3::{Vec3, add, cross, norm, scale};
use bearing_dynamics::members::contacts::{Kernel, Want};
use bearing_dynamics::members::state::{ORIENTATION, POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Integrator, Stepping};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use nalgebra::{Quaternion, UnitQuaternion};

const BALL: f64 = 5.953e-3;

fn table_3_5() -> BearingGeometry {
    BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.9555e-3)
}

/// Lengths in mm.
fn shape(length: f64, edge: f64, floor: f64) -> SpallShape {
    let [length, edge_radius, floor_radius] = [length, edge, floor].map(|of| 1e-3 * of);
    let depth = SpallShape::depth_of(length, edge_radius, floor_radius);
    SpallShape { length, width: 4e-3, edge_radius, depth }
}

/// Shapes whose floor the ball touches, the source's radii among them.
fn shapes() -> Vec<SpallShape> {
    let all =
        [(0.5, 1.0, 6.0), (2.0, 1.0, 6.0), (5.0, 1.0, 6.0), (2.0, 0.1, 9.0), (1.0, 0.0, 30.0)];
    all.into_iter().map(|(length, edge, floor)| shape(length, edge, floor)).collect()
}

/// The ball's circle lowered onto corners and floor, point by point.
#[test]
fn the_envelope_is_that_of_the_ball_on_the_profile() {
    for shape in shapes() {
        let (c, r) = (0.5 * shape.length, shape.edge_radius);
        let floor = shape.floor_radius();
        let middle = ((floor + r) * (floor + r) - c * c).sqrt() - r;
        let joint = c * floor / (floor + r);
        let height = |x: f64| {
            let x = x.abs();
            if x >= c {
                0.0
            } else if x >= joint {
                (r * r - (c - x) * (c - x)).sqrt() - r
            } else {
                middle - (floor * floor - x * x).sqrt()
            }
        };
        let law = SpallLaw::new(&shape, BALL);
        for step in 0..=40 {
            let s = -c + c * f64::from(step) / 20.0;
            let points = (-40_000..=40_000).map(|i| s + 0.9 * BALL * f64::from(i) / 40_000.0);
            let top = |x: f64| height(x) + (BALL * BALL - (x - s) * (x - s)).sqrt();
            let expected = BALL - points.map(top).fold(f64::NEG_INFINITY, f64::max);
            let found = law.along(s).map_or(0.0, |[value, _]| value);
            // Points 0.13 µm apart on circles of millimetres.
            assert!((found - expected).abs() <= 2e-9, "{shape:?} {s}: {found:e} {expected:e}");
        }
    }
}

/// Never deeper than the ball between two sharp edges, and as deep as the formula where it touches the floor.
#[test]
fn a_ball_drops_no_deeper_than_between_sharp_edges() {
    for length in [0.2, 1.0, 3.0, 5.9] {
        let half = 0.5e-3 * length;
        let sharp = BALL - (BALL * BALL - half * half).sqrt();
        for edge in [0.0, 0.01, 0.3, 1.0, 5.0] {
            // A floor that is tighter than the ball is bridged.
            for floor in [3.0, 5.9, 6.0, 8.0, 100.0] {
                if floor + edge < 0.5 * length {
                    continue;
                }
                let given = shape(length, edge, floor);
                let deepest = SpallLaw::new(&given, BALL).deepest();
                assert!(deepest > 0.0 && deepest <= sharp, "{given:?}: {deepest} {sharp}");
                let both = 1e-3 * (floor + edge);
                if 1e-3 * floor > BALL * (1.0 + ROUNDED) {
                    let expected = both - (both * both - half * half).sqrt();
                    // Cancellation in a millimetre less a millimetre.
                    assert!((deepest / expected - 1.0).abs() <= 1e-9, "{given:?}");
                    assert!((deepest - given.depth).abs() <= 1e-12 * given.length);
                }
            }
        }
        let bridged = SpallLaw::new(&shape(length, 0.0, 4.0), BALL).deepest();
        // The rounding of the kink takes its share of the radius.
        assert!((bridged / sharp - 1.0).abs() <= 1.2 * ROUNDED, "{bridged} {sharp}");
    }
}

/// Loss and slope are continuous where corners begin, where they meet the floor and at the sides, and slopes are the
/// differences of the loss.
#[test]
fn the_loss_over_a_spall_is_smooth() {
    let mut noise = Noise(3);
    for shape in shapes() {
        let law = SpallLaw::new(&shape, BALL);
        let c = 0.5 * shape.length;
        let lost = |s: f64, y: f64| law.lost([s, y]).unwrap_or_default();
        let corner = BALL + shape.edge_radius;
        let joint = c * (1.0 - corner / (shape.floor_radius() + shape.edge_radius));
        let sides = 0.5 * shape.width;
        for s in [-c, c, -joint, joint, 0.0] {
            let h = 1e-10;
            let (before, after) = (lost(s - h, 0.0), lost(s + h, 0.0));
            // Curvatures of up to one over the radius of the bottom.
            let largest = 4.0 * h / (shape.floor_radius() - BALL).min(corner);
            assert!((before.along - after.along).abs() <= largest, "{shape:?} {s}");
            assert!((before.value - after.value).abs() <= h, "{shape:?} {s}");
        }
        for y in [-sides, sides, 0.5 * sides, -0.5 * sides] {
            let h = 1e-9;
            let (before, after) = (lost(0.0, y - h), lost(0.0, y + h));
            // Curvature of the cosine wave over a quarter of the width.
            let wave = std::f64::consts::PI / (0.5 * sides);
            let largest = 1.1 * h * law.deepest() * wave * wave;
            assert!((before.across - after.across).abs() <= largest, "{shape:?} {y}");
        }
        let edge = |s: f64| [0.0, joint, c].iter().any(|at| (s.abs() - at).abs() <= 1e-8);
        for _ in 0..2000 {
            let [s, y] = [1.2 * c * noise.next(), 1.2 * sides * noise.next()];
            if edge(s) {
                continue;
            }
            let (h, found) = (1e-9, lost(s, y));
            let along = (lost(s + h, y).value - lost(s - h, y).value) / (2.0 * h);
            let across = (lost(s, y + h).value - lost(s, y - h).value) / (2.0 * h);
            // Rounding of parts of a millimetre, and steep curvature at the bottom.
            assert!((found.along - along).abs() <= 1e-6, "{shape:?} {s} {y}: {found:?} {along}");
            assert!((found.across - across).abs() <= 1e-6, "{shape:?} {s} {y}: {found:?} {across}");
        }
    }
}

/// 3 µm deep, so that balls keep touching it.
fn shallow(length: f64) -> SpallShape {
    SpallShape { length, width: 2e-3, edge_radius: 1e-3, depth: 3e-6 }
}

fn on_race(side: usize, angle: f64, groove_angle: f64) -> RacewayProfile {
    let on = Surface::Race { side, angle, groove_angle };
    RacewayProfile::Spall(Spall { shape: shallow(0.5e-3), on })
}

fn on_ball(ball: usize, angle: f64, groove_angle: f64) -> RacewayProfile {
    let shape = SpallShape { width: f64::INFINITY, ..shallow(0.5e-3) };
    RacewayProfile::Spall(Spall { shape, on: Surface::Ball { ball, angle, groove_angle } })
}

fn waves(on: Surface, order: f64) -> RacewayProfile {
    let ball = matches!(on, Surface::Ball { .. });
    let phase = if ball { 0.0 } else { 0.4 };
    RacewayProfile::Waviness(Waviness { order, amplitude: 0.8e-6, phase, on })
}

fn race(side: usize) -> Surface {
    Surface::Race { side, angle: 0.0, groove_angle: 0.0 }
}

fn problem_of(profiles: Vec<RacewayProfile>) -> DynamicProblem {
    let mut problem = dynamics::bearing(table_3_5(), [0.0, 0.0, -300.0, 0.0, 0.0], 1000.0 * RPM);
    (problem.raceway_profiles, problem.ball_phase) = (profiles, 0.0);
    problem
}

/// Every kind at once; ball 0 is over the spalls of both races and its own at both contacts.
fn all_kinds() -> DynamicProblem {
    let pole = Surface::Ball { ball: 0, angle: 1.0, groove_angle: 0.3 };
    let mut problem = problem_of(vec![
        on_race(1, 0.003, 0.02),
        on_race(0, -0.004, -0.01),
        on_ball(0, 0.02, 0.015),
        on_ball(0, std::f64::consts::PI - 0.025, 0.01),
        waves(race(0), 7.0),
        waves(race(1), 12.0),
        waves(pole, 9.0),
    ]);
    problem.ball_deviations = vec![0.3e-6, -0.2e-6, 0.0, 0.1e-6, 0.5e-6, 0.0, -0.4e-6, 0.2e-6];
    (problem.inner, problem.outer) = (free_race(), Some(free_race()));
    problem
}

/// Nominal positions with ball 0 aside in its grooves and a little turned.
fn state_of(problem: &DynamicProblem, system: &System) -> Vec<f64> {
    let mut state = start::nominal(&problem.assembly());
    let layout = &system.sets[0].layout;
    for (i, by) in [1e-6, 1e-6, 20e-6].into_iter().enumerate() {
        state[layout.ball(POSITION + i)] += by;
    }
    turn(&mut state, system, [0.01, 0.006, -0.008]);
    state
}

/// Rotates ball 0, rad, inertial axes.
fn turn(state: &mut [f64], system: &System, by: Vec3) {
    let at = |i: usize| system.sets[0].layout.ball(ORIENTATION + i);
    let q = Quaternion::new(state[at(0)], state[at(1)], state[at(2)], state[at(3)]);
    let turned = UnitQuaternion::from_scaled_axis(by.into()) * UnitQuaternion::new_normalize(q);
    for (i, value) in [turned.w, turned.i, turned.j, turned.k].into_iter().enumerate() {
        state[at(i)] = value;
    }
}

/// Force and moment on a ball are the negative slopes of the contact energy by its position and orientation.
#[test]
fn forces_over_profiles_are_the_gradient_of_the_energy() {
    let problem = all_kinds();
    let mut system = System::new(&problem, Kernel::Simd);
    let state = state_of(&problem, &system);
    let mut rates = vec![0.0; state.len()];
    let mut energy = |state: &[f64]| {
        system.evaluate(0.0, state, &mut rates);
        system.energy(state).contact
    };
    let mut slopes = [0.0; 6];
    for (i, slope) in slopes.iter_mut().enumerate() {
        let h = if i < 3 { 1e-9 } else { 1e-7 };
        let mut at = |by: f64| {
            let mut moved = state.clone();
            if i < 3 {
                moved[layout_of(&problem, POSITION + i)] += by;
            } else {
                let mut axis = [0.0; 3];
                axis[i - 3] = by;
                let system = System::new(problem_of(Vec::new()), Kernel::Simd);
                turn(&mut moved, &system, axis);
            }
            energy(&moved)
        };
        *slope = (at(h) - at(-h)) / (2.0 * h);
    }
    system.evaluate(0.0, &state, &mut rates);
    let set = &system.sets[0];
    let felt = set.table.profiled.iter().filter(|of| of.pair % set.layout.padded == 0);
    assert!(felt.clone().count() == 2 && felt.clone().all(|of| norm(of.couple) > 5e-4), "{felt:?}");
    let force = scale(set.layout.ball_vector(&rates, VELOCITY, 0), problem.ball.mass);
    let moment = scale(set.layout.ball_vector(&rates, SPIN, 0), problem.ball.axial);
    for i in 0..3 {
        // Differences over a nanometre, a thousandth of the overlap: 3e-7.
        assert!((force[i] + slopes[i]).abs() <= 1e-6 * norm(force), "force {i}");
        assert!((moment[i] + slopes[i + 3]).abs() <= 1e-7 * norm(moment), "moment {i}");
    }
    assert!(norm(force) > 10.0 && norm(moment) > 1e-3);
}

fn layout_of(problem: &DynamicProblem, component: usize) -> usize {
    System::new(problem, Kernel::Simd).sets[0].layout.ball(component)
}

/// Both races free: forces on all bodies sum to nothing, and so do their moments, those of balls about their centres
/// among them.
#[test]
fn profiles_make_no_momentum() {
    let problem = all_kinds();
    for driver in [Kernel::Scalar, Kernel::Simd] {
        let mut system = System::new(&problem, driver);
        let state = state_of(&problem, &system);
        let mut rates = vec![0.0; state.len()];
        system.evaluate(0.0, &state, &mut rates);
        let set = &system.sets[0];
        let couple = set.table.profiled.iter().map(|of| norm(of.couple)).fold(0.0, f64::max);
        assert!(couple > 1e-3, "{couple}");
        let (mut force, mut moment, mut largest) = ([0.0; 3], [0.0; 3], 0.0f64);
        for ball in 0..8 {
            let at = set.layout.ball_vector(&state, POSITION, ball);
            let pushed = scale(set.layout.ball_vector(&rates, VELOCITY, ball), problem.ball.mass);
            let spun = scale(set.layout.ball_vector(&rates, SPIN, ball), problem.ball.axial);
            largest = largest.max(norm(pushed));
            force = add(force, pushed);
            moment = add(moment, add(cross(at, pushed), spun));
        }
        for (loads, race) in set.on_races.iter().zip(&set.races) {
            force = add(force, loads.force);
            moment = add(moment, add(loads.moment, cross(race.motion.position, loads.force)));
        }
        // Sums of forces of `largest`; moments over the pitch radius of 26 mm.
        assert!(largest > 1.0 && norm(force) <= 1e-11 * largest, "{force:?} of {largest}");
        assert!(norm(moment) <= 1e-12 * largest, "{moment:?}");
    }
}

/// Over spalls of either race and of a ball, and over waves, without friction: the loss falls with the step.
#[test]
fn a_pass_of_a_spall_makes_no_energy() {
    // Ball 0 starts on the Y axis and rolls towards Z: about half a turn and more of it is in the run.
    let cases = [
        ("outer", vec![on_race(1, 0.03, 0.0)], 3e-3),
        ("inner", vec![on_race(0, -0.03, 0.0)], 3e-3),
        ("ball", vec![on_ball(0, -0.3, 0.0), on_ball(0, 0.3, 0.0)], 3e-3),
        ("waves", vec![waves(race(0), 16.0), waves(race(1), 11.0)], 3e-3),
    ];
    for (name, profiles, end) in cases {
        let problem = problem_of(profiles);
        let drift = |step: f64| {
            let mut simulation = started(&problem, Integrator::RungeKutta, Stepping::Fixed(step));
            let (mut felt, mut coupled, mut held) = (0u64, false, 0.0f64);
            while simulation.time < end {
                simulation.step().unwrap();
                let profiled = &simulation.system.sets[0].table.profiled;
                felt += u64::from(!profiled.is_empty());
                coupled |= profiled.iter().any(|of| norm(of.couple) > 1e-5);
                held = held.max(simulation.system.energy(&simulation.state).contact);
            }
            assert!(felt > 20 && coupled == (name == "ball"), "{name}: {felt} {coupled}");
            (simulation.snapshot().residual / held).abs()
        };
        let found = [2e-6, 1e-6, 0.5e-6].map(drift);
        let order = libm::log2(found[0] / found[2]) / 2.0;
        println!("{name}: {found:?}, order {order:.2}");
        // A profile has jumps of its curvature, which take two of the four orders. Waves start with a jump of the
        // loads: Runge-Kutta damps the vibration of balls between races, 24 kHz, with the fifth power of the step.
        let allowed = if name == "waves" { 2e-6 } else { 1e-7 };
        assert!(found[2] <= allowed && order >= 2.0, "{name}: {found:?}");
    }
}

/// A spall without length, depth or width, a wave without amplitude and equal balls are none: every bit as without them.
#[test]
fn vanishing_profiles_are_hertz() {
    let run = |profiles: Vec<RacewayProfile>, deviations: Vec<f64>| {
        let mut problem = problem_of(profiles);
        problem.ball_deviations = deviations;
        let mut simulation = started(&problem, Integrator::RungeKutta, Stepping::Fixed(1e-6));
        for _ in 0..500 {
            simulation.step().unwrap();
        }
        simulation.state.iter().map(|value| value.to_bits()).collect::<Vec<u64>>()
    };
    let without = run(Vec::new(), Vec::new());
    let vanishing = |change: fn(&mut SpallShape)| {
        let mut all = vec![on_race(1, 0.01, 0.0), on_race(0, -0.01, 0.0), on_ball(0, 0.01, 0.0)];
        for profile in &mut all {
            if let RacewayProfile::Spall(spall) = profile {
                change(&mut spall.shape);
            }
        }
        all
    };
    assert!(without == run(vanishing(|shape| shape.length = 0.0), Vec::new()));
    assert!(without == run(vanishing(|shape| shape.depth = 0.0), Vec::new()));
    assert!(without == run(vanishing(|shape| shape.width = 0.0), Vec::new()));
    let RacewayProfile::Waviness(wave) = waves(race(1), 9.0) else { unreachable!() };
    let flat = RacewayProfile::Waviness(Waviness { amplitude: 0.0, ..wave });
    assert!(without == run(vec![flat], vec![0.0; 8]));
    for profile in [on_race(1, 0.01, 0.0), on_race(0, -0.01, 0.0), on_ball(0, 0.01, 0.0)] {
        assert!(without != run(vec![profile], Vec::new()), "{profile:?}");
    }
    assert!(without != run(vec![RacewayProfile::Waviness(wave)], Vec::new()));
    assert!(without != run(Vec::new(), vec![0.0, 1e-7, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
}

/// A larger ball overlaps both races more; crests of waves of either race add their amplitude.
#[test]
fn deviations_and_crests_add_to_the_overlap() {
    let overlaps = |problem: &DynamicProblem| {
        let mut system = System::new(problem, Kernel::Scalar);
        let state = start::nominal(&problem.assembly());
        let mut rates = vec![0.0; state.len()];
        system.evaluate_with(Want::ForcesAndSlopes, 0.0, &state, &mut rates);
        let set = &system.sets[0];
        let of =
            |side: usize, ball: usize| set.table.contact[side * set.layout.padded + ball].overlap;
        [0, 1].map(|side| [0, 1, 2].map(|ball| of(side, ball)))
    };
    let ideal = overlaps(&problem_of(Vec::new()));
    let mut sized = problem_of(Vec::new());
    sized.ball_deviations = vec![0.5e-6, 0.0, -0.25e-6, 0.0, 0.0, 0.0, 0.0, 0.0];
    let waved = problem_of(vec![waves(race(0), 3.0), waves(race(1), 5.0)]);
    let (sized_overlaps, waved_overlaps) = (overlaps(&sized), overlaps(&waved));
    for side in 0..2 {
        for ball in 0..3 {
            let more = sized_overlaps[side][ball] - ideal[side][ball];
            assert!((more - sized.ball_deviations[ball]).abs() <= 1e-15, "{side} {ball}: {more}");
            // Eight balls from the race's own Y.
            let theta = std::f64::consts::TAU * ball as f64 / 8.0;
            let expected = 0.8e-6 * libm::cos([3.0, 5.0][side] * theta + 0.4);
            let more = waved_overlaps[side][ball] - ideal[side][ball];
            assert!((more - expected).abs() <= 1e-15, "{side} {ball}: {more} {expected}");
        }
    }
}

/// Balls of a tight bearing that carries nothing stand still in the frames of linearly implicit steps: no error says
/// that a spall of a race or of a ball is near, and yet none is passed over.
#[test]
fn no_step_passes_over_a_spall() {
    let geometry =
        BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.963e-3);
    let cases = [
        ("outer", on_race(1, 4.363, 0.0), 1e-3),
        ("outer", on_race(1, 4.38, 0.0), 1e-6),
        ("inner", on_race(0, 4.0, 0.0), 1e-4),
        ("ball", on_ball(0, 2.0, 0.0), 1e-3),
        ("ball", on_ball(0, 2.0, 0.0), 1e-5),
    ];
    for (name, profile, accuracy) in cases {
        let mut problem = dynamics::bearing(geometry, [0.0; 5], 10_000.0 * RPM);
        (problem.raceway_profiles, problem.ball_phase) = (vec![profile], 0.0);
        let place = |integrator, stepping| {
            let (rows, simulation) = motion(&problem, integrator, stepping, 2e-3, 1);
            (rows[0], simulation.steps, simulation.control.unwrap().memory.displacement)
        };
        let (exact, ..) = place(Integrator::DormandPrince, Stepping::Accuracy(1e-7));
        let (found, steps, overlap) = place(Integrator::Rosenbrock, Stepping::Accuracy(accuracy));
        let miss = (0..3).map(|i| (found[i] - exact[i]).abs()).fold(0.0, f64::max) / overlap;
        println!("{name}, {accuracy}: {steps} steps, {miss:e} of the overlap off, {exact:?}");
        assert!(norm(exact) >= 1e-8, "{name}: the spall is felt: {exact:?}");
        assert!(miss <= accuracy, "{name}, {accuracy}: {miss:e}");
    }
}
