//! Laws of the contact forces at one instant: action and reaction, frame invariance, energy.
#![allow(clippy::needless_range_loop)] // indices are the notation of components

use crate::common;
use crate::dynamics;

use bearing_dynamics::ch2_housing::bearing::cage::{CageForce, Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::{ContactDamping, normal_load};
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::solver::dynamics::contacts::Driver;
use bearing_dynamics::solver::dynamics::model::{Drive, DynamicProblem, RotatingLoad, Rotation};
use bearing_dynamics::solver::dynamics::start;
use bearing_dynamics::solver::dynamics::state::{
    BodyState, LEDGER, Layout, Ledger, SPIN, VELOCITY,
};
use bearing_dynamics::solver::dynamics::system::System;
use bearing_dynamics::solver::profile::Profile;
use common::{full_complement, table_4_1, table_5_3};
use dynamics::*;
use nalgebra::Vector3;
use proptest::prelude::*;

/// A bearing with both races free, by the numbers of its laws.
#[derive(Clone, Copy, Debug)]
struct Choice {
    angular: bool,
    traction: usize,
    heathcote: bool,
    damping: usize,
    cage: usize,
    cylindrical: bool,
    hertz: bool,
    /// Balls that nearly fill the pitch circle, so that about half of the neighbours touch.
    crowded: bool,
}

fn any_choice() -> impl Strategy<Value = Choice> {
    let laws = (0..5usize, any::<bool>(), 0..3usize);
    let cages = (0..4usize, any::<bool>(), any::<bool>());
    (any::<bool>(), laws, cages, any::<bool>()).prop_map(|(angular, laws, cages, crowded)| {
        let (traction, heathcote, damping) = laws;
        let (cage, cylindrical, hertz) = cages;
        Choice { angular, traction, heathcote, damping, cage, cylindrical, hertz, crowded }
    })
}

impl Choice {
    fn problem(&self) -> DynamicProblem {
        let geometry = match (self.crowded, self.angular) {
            (true, _) => full_complement(9, 10e-6, -5e-6),
            (false, true) => table_5_3(),
            (false, false) => table_4_1(-5e-6),
        };
        let mut problem = bearing(geometry, [0.0; 5], 0.0);
        problem.inner = free_race();
        problem.outer = Some(free_race());
        problem.traction = traction_laws()[self.traction].clone();
        problem.heathcote = self.heathcote;
        problem.damping = [
            ContactDamping::None,
            ContactDamping::HuntCrossley { alpha: 0.3 },
            // Loses more than it stores when it separates fast: the load is cut off at zero.
            ContactDamping::HuntCrossley { alpha: 3.0 },
        ][self.damping];
        let pocket = if self.cylindrical { Pocket::Cylindrical } else { Pocket::Spherical };
        let guidance =
            [None, Some(Guidance::Balls), Some(Guidance::InnerRace), Some(Guidance::OuterRace)];
        problem.cage = guidance[self.cage].map(|guidance| {
            let mut cage = cage(&geometry, pocket, guidance);
            if self.hertz {
                cage.contacts.force = CageForce::Hertz { stiffness: 1e9 };
            }
            cage
        });
        problem
    }
}

/// Sum of all normal loads at the last evaluation, N; where damping has cut a load off, what the
/// overlap alone would carry.
fn force_scale(system: &System) -> f64 {
    let layout = system.sets[0].layout;
    let mut races = 0.0;
    for (side, law) in system.sets[0].laws.races.iter().enumerate() {
        for pair in (0..layout.balls).map(|ball| side * layout.padded + ball) {
            let elastic = normal_load(law.stiffness, system.sets[0].table.contact[pair].overlap);
            races += elastic.max(system.sets[0].table.load[pair]);
        }
    }
    let cage: f64 = system.sets[0]
        .pockets
        .iter()
        .chain(&system.sets[0].guides)
        .map(|contact| contact.normal_load)
        .sum();
    let balls: f64 = system.sets[0].meetings.iter().map(|meeting| meeting.normal_load).sum();
    races + cage + balls + 1.0
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forces_and_moments_inside_the_bearing_cancel(choice in any_choice(), seed: u64) {
        let problem = choice.problem();
        let state = random_state(&problem, seed);
        for driver in [Driver::Plain, Driver::Lanes] {
            let (system, rates) = evaluated(&problem, driver, 0.0, &state);
            let (force, moment) = load_sums(&problem, &state, &rates);
            let scale = force_scale(&system);
            // Rounding of some thirty contacts: 30 · 2⁻⁵³ · a few operations each. The gyroscopic
            // terms of races and cage (some N·m at 100 rad/s) add as much rounding to the moment.
            prop_assert!(force.norm() <= 1e-13 * scale, "force {} of {scale}", force.norm());
            let arm = problem.geometry.pitch_radius;
            prop_assert!(
                moment.norm() <= 1e-13 * scale * arm + 1e-13,
                "moment {} of {}", moment.norm(), scale * arm
            );
        }
    }

    #[test]
    fn forces_turn_with_the_frame(
        choice in any_choice(), seed: u64, by in prop::array::uniform3(-0.57..0.57f64),
    ) {
        let mut problem = choice.problem();
        problem.gravity = GRAVITY;
        let state = random_state(&problem, seed);
        let turn = Noise(seed ^ 1).turn(1.7);
        let (system, rates) = evaluated(&problem, Driver::Lanes, 0.0, &state);
        let there = moved(&problem, &state, &turn, &Vector3::from(by));
        let mut other = problem.clone();
        other.gravity = (turn * Vector3::from(GRAVITY)).into();
        let (_, other_rates) = evaluated(&other, Driver::Lanes, 0.0, &there);
        let layout = system.sets[0].layout;
        // Rounding of a position at 1 m is 1e-16 m; the stiffest contact, 1e8 N/m, makes 2e-8 N of
        // it, and the slips of 1 m/s change by 1e-16.
        let scale = force_scale(&system);
        for (inertia, at) in bodies(&problem) {
            let (here, there) = (entries(&rates, at), entries(&other_rates, at));
            let force = (turn * part(&here, VELOCITY) - part(&there, VELOCITY)) * inertia.mass;
            prop_assert!(force.norm() <= 1e-9 * scale, "force off by {} of {scale}", force.norm());
            let moment = (turn * part(&here, SPIN) - part(&there, SPIN)) * inertia.transverse;
            let arm = problem.geometry.pitch_radius;
            prop_assert!(moment.norm() <= 1e-9 * scale * arm, "moment off by {}", moment.norm());
        }
        for entry in 0..LEDGER {
            let at = layout.ledger() + entry;
            // Powers: forces times speeds of the order of 1 m/s.
            prop_assert!((rates[at] - other_rates[at]).abs() <= 1e-9 * scale);
        }
    }

    /// dE/dt along the motion equals the powers in the ledger, whatever acts.
    #[test]
    fn the_ledger_balances_the_energy(choice in any_choice(), drives in any_drives(), seed: u64) {
        let mut problem = choice.problem();
        problem.gravity = GRAVITY;
        problem.outer_start = [1e-6, -2e-6, 1e-6, 1e-4, -2e-4];
        drives.apply(&mut problem);
        let t = 0.013;
        let mut system = System::new(problem.clone(), Driver::Lanes);
        let mut state = random_state(&problem, seed);
        system.tidy(t, &mut state);
        let mut rates = vec![0.0; state.len()];
        system.evaluate(t, &state, &mut rates);
        let at = system.sets[0].layout.ledger();
        let power: f64 = rates[at..at + LEDGER].iter().sum();
        let scale = force_scale(&system);
        let step = 1e-9;
        let mut shifted = |sign: f64| {
            let mut there: Vec<f64> =
                state.iter().zip(&rates).map(|(s, r)| s + sign * step * r).collect();
            system.tidy(t + sign * step, &mut there);
            energy(&mut system, t + sign * step, &there).total()
        };
        let slope = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
        // Energies of some J round to 1e-16 J, divided by 2e-9 s; contacts of 1e-6 m that close at
        // 1 m/s bend the energy by (1e-3)² over the two steps.
        let allowed = 2e-6 * scale + 1e-5;
        prop_assert!((slope - power).abs() <= allowed, "{slope} W against {power} W, {allowed}");
    }

    /// Each entry by itself is the power of its own forces: what the bodies' kinetic energy gains by
    /// them, with each cause switched off in turn.
    #[test]
    fn each_entry_of_the_ledger_is_the_power_of_its_forces(
        choice in any_choice(), drives in any_drives(), seed: u64,
    ) {
        let mut whole = choice.problem();
        drives.apply(&mut whole);
        // Races that follow their loads: given motions need forces of their own.
        for body in [Some(&mut whole.inner), whole.outer.as_mut()].into_iter().flatten() {
            for (i, drive) in body.drives.iter_mut().enumerate() {
                *drive = Drive::Load(Profile::Constant(20.0 + i as f64));
            }
            body.rotation = Rotation::Torque(Profile::Constant(0.1));
        }
        let state = random_state(&whole, seed);
        let t = 0.013;
        let (system, rates) = evaluated(&whole, Driver::Lanes, t, &state);
        let booked = &rates[system.sets[0].layout.ledger()..][..LEDGER];
        let scale = force_scale(&system);
        let mut before = whole.clone();
        for entry in [
            Ledger::Traction,
            Ledger::ContactDamping,
            Ledger::CageFriction,
            Ledger::BallFriction,
            Ledger::Foundation,
            Ledger::Drives,
        ] {
            // Traction first: it goes with normal loads, of which damping is a part.
            let mut without = before.clone();
            let bodies = [Some(&mut without.inner), without.outer.as_mut()];
            match entry {
                Ledger::Traction => without.traction = TractionLaw::None,
                Ledger::ContactDamping => without.damping = ContactDamping::None,
                Ledger::CageFriction => {
                    without.cage.iter_mut().for_each(|cage| cage.contacts.friction = 0.0);
                }
                Ledger::BallFriction => {
                    without.ball_contact.iter_mut().for_each(|law| law.friction = 0.0);
                }
                Ledger::Foundation => {
                    bodies.into_iter().flatten().for_each(|body| body.foundation_damping = [0.0; 5]);
                }
                Ledger::Drives => {
                    for body in bodies.into_iter().flatten() {
                        body.drives = [0.0; 5].map(|zero| Drive::Load(Profile::Constant(zero)));
                        body.rotation = Rotation::Torque(Profile::ZERO);
                    }
                    (without.rotating_load, without.unbalance) = (None, 0.0);
                }
            }
            let power = kinetic_power(&before, t, &state) - kinetic_power(&without, t, &state);
            let off = (power - booked[entry as usize]).abs();
            // Forces of `scale` on parts that move at a few m/s, rounded; tilting moments act on
            // rates of tilts, which are those of the spin but for the tilt of 2e-3, squared.
            let allowed = 1e-11 * scale + 1e-8;
            prop_assert!(off <= allowed, "{entry:?}: {power} W, booked {booked:?}");
            before = without;
        }
    }

    #[test]
    fn traction_and_friction_only_take_energy(choice in any_choice(), seed: u64) {
        let problem = choice.problem();
        let state = random_state(&problem, seed);
        let (system, rates) = evaluated(&problem, Driver::Lanes, 0.0, &state);
        let at = system.sets[0].layout.ledger();
        // Traction, damping, cage friction, foundation: none may drive.
        for entry in 0..4 {
            prop_assert!(rates[at + entry] <= 0.0, "entry {entry}: {} W", rates[at + entry]);
        }
        for &pair in &system.sets[0].table.active {
            prop_assert!(system.sets[0].table.traction[pair].power <= 0.0);
        }
    }

    #[test]
    fn both_drivers_have_the_same_bits(choice in any_choice(), seed: u64) {
        let problem = choice.problem();
        let state = random_state(&problem, seed);
        let (_, plain) = evaluated(&problem, Driver::Plain, 0.0, &state);
        let (_, lanes) = evaluated(&problem, Driver::Lanes, 0.0, &state);
        prop_assert_eq!(bits(&plain), bits(&lanes));
    }
}

/// How fast the kinetic energy of all moving bodies grows, W: forces on velocities, moments on spins.
fn kinetic_power(problem: &DynamicProblem, t: f64, state: &[f64]) -> f64 {
    let (_, rates) = evaluated(problem, Driver::Lanes, t, state);
    let of_body = |(inertia, at): (Inertia, BodyAt)| {
        let (all, rate) = (entries(state, at), entries(&rates, at));
        let axis = Vector3::from(BodyState::from_slice(&all).axis());
        let (spin, spin_rate) = (part(&all, SPIN), part(&rate, SPIN));
        inertia.mass * part(&all, VELOCITY).dot(&part(&rate, VELOCITY))
            + inertia.transverse * spin.dot(&spin_rate)
            + (inertia.axial - inertia.transverse) * axis.dot(&spin) * axis.dot(&spin_rate)
    };
    bodies(problem).into_iter().map(of_body).sum()
}

/// What drives the races: loads, histories, foundations.
#[derive(Clone, Copy, Debug)]
struct Drives {
    inner: u8,
    outer: u8,
    turning: bool,
}

fn any_drives() -> impl Strategy<Value = Drives> {
    (0..128u8, 0..128u8, any::<bool>()).prop_map(|(inner, outer, turning)| Drives {
        inner,
        outer,
        turning,
    })
}

impl Drives {
    fn apply(&self, problem: &mut DynamicProblem) {
        let amplitudes = [10e-6, 10e-6, 10e-6, 1e-3, 1e-3];
        let history = |mean: f64, amplitude: f64, phase: f64| Profile::Harmonic {
            mean,
            amplitude,
            frequency: 300.0,
            phase,
        };
        let outer = problem.outer.as_mut();
        for (body, choice) in [(Some(&mut problem.inner), self.inner), (outer, self.outer)] {
            let Some(body) = body else { continue };
            for i in 0..5 {
                body.drives[i] = if choice & (1 << i) != 0 {
                    Drive::Motion(history(0.0, amplitudes[i], i as f64))
                } else {
                    Drive::Load(history(20.0, 10.0, i as f64))
                };
            }
            body.rotation = if choice & 32 != 0 {
                Rotation::Speed(history(200.0, 50.0, 0.3))
            } else {
                Rotation::Torque(history(0.1, 0.05, 0.3))
            };
            if choice & 64 != 0 {
                body.foundation_stiffness = [1e7, 2e7, 3e7, 1e3, 2e3];
                body.foundation_damping = [100.0, 200.0, 300.0, 0.1, 0.2];
            }
        }
        if self.turning {
            let force = Profile::Constant(100.0);
            problem.rotating_load =
                Some(RotatingLoad { force, speed: Profile::Constant(30.0), phase: 0.4 });
            problem.unbalance = 1e-4;
        }
    }
}

/// A preloaded bearing in its nominal position, everything at rest.
fn preloaded(law: TractionLaw) -> (DynamicProblem, Layout, Vec<f64>) {
    let mut problem = bearing(table_4_1(-10e-6), [0.0; 5], 0.0);
    problem.traction = law;
    let layout = Layout::new(8, false);
    let state = start::nominal(&problem.assembly());
    (problem, layout, state)
}

/// Moment on ball 1 about its contact line.
fn spin_moment(problem: &DynamicProblem, layout: &Layout, state: &[f64]) -> (f64, System) {
    let (system, rates) = evaluated(problem, Driver::Lanes, 0.0, state);
    let normal = Vector3::from(system.sets[0].table.contact[layout.padded].normal);
    let moment = Vector3::from(layout.ball_vector(&rates, SPIN, 0)) * problem.ball.axial;
    (moment.dot(&normal), system)
}

#[test]
fn pure_spin_of_a_ball_is_braked_by_three_eighths() {
    let law = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 1e-9 };
    let (mut problem, layout, mut state) = preloaded(law);
    let (sin, cos) = problem.ball_phase.sin_cos();
    let mut ball = layout.ball_state(&state, 0);
    ball.spin = [0.0, 40.0 * cos, 40.0 * sin];
    layout.set_ball(&mut state, 0, &ball);
    let mut errors = Vec::new();
    for slices in [15, 45, 135, 405] {
        problem.slices = slices;
        let (moment, system) = spin_moment(&problem, &layout, &state);
        let exact: f64 = [0, layout.padded]
            .map(|pair| {
                let hertz = [&problem.inner_contact, &problem.outer_contact][pair / layout.padded];
                let load = system.sets[0].table.load[pair];
                let ellipse =
                    bearing_dynamics::ch2_housing::bearing::hertz::contact_ellipse(hertz, load);
                -3.0 * 0.07 * load * ellipse.semi_major / 8.0
            })
            .iter()
            .sum();
        assert!(exact < -0.01);
        errors.push((moment / exact - 1.0).abs());
    }
    // Slices of equal width: second order. An odd number has one slice astride the middle, where
    // the slip turns round, with an error of 1/(2n²) of 3/8 …: 5.9e-3 for fifteen.
    assert!(errors[0] <= 6e-3, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).ln() / 3f64.ln();
        assert!((order - 2.0).abs() <= 0.1, "{errors:?}");
    }
}

#[test]
fn slices_converge_where_the_whole_contact_slides() {
    // Rolling, sliding and spinning at once, away from the corner of pure spin.
    let (mut problem, layout, mut state) = preloaded(CONSTANT);
    problem.heathcote = true;
    let mut ball = layout.ball_state(&state, 0);
    ball.spin = [300.0, 80.0, 40.0];
    ball.velocity = [0.02, 0.1, 0.2];
    layout.set_ball(&mut state, 0, &ball);
    let mut loads = |slices: usize| {
        problem.slices = slices;
        let (_, rates) = evaluated(&problem, Driver::Lanes, 0.0, &state);
        let force = Vector3::from(layout.ball_vector(&rates, VELOCITY, 0)) * problem.ball.mass;
        let moment = Vector3::from(layout.ball_vector(&rates, SPIN, 0)) * problem.ball.axial;
        (force, moment)
    };
    let fine = loads(2001);
    let errors = [15, 45, 135].map(|slices| {
        let (force, moment) = loads(slices);
        (force - fine.0).norm() / fine.0.norm() + (moment - fine.1).norm() / fine.1.norm()
    });
    assert!(errors[0] <= 2e-3, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).ln() / 3f64.ln();
        assert!((order - 2.0).abs() <= 0.1, "{errors:?}");
    }
}

#[test]
fn heathcote_brakes_a_ball_that_rolls_without_slip_in_the_middle() {
    let (mut problem, layout, _) = preloaded(CONSTANT);
    problem.inner.rotation = Rotation::Speed(Profile::Constant(1000.0 * RPM));
    let state = start::nominal(&problem.assembly());
    let mut braking = |heathcote: bool| {
        problem.heathcote = heathcote;
        let (system, rates) = evaluated(&problem, Driver::Lanes, 0.0, &state);
        let power = rates[layout.ledger_entry(Ledger::Traction)];
        (system.sets[0].laws.curvature, power)
    };
    let (flat, without) = braking(false);
    let (curved, with) = braking(true);
    assert_eq!(flat, [0.0; 2]);
    // R = 2 r_g r_b/(r_g + r_b), 6.0 mm for the inner groove.
    let radius =
        2.0 * 6.013e-3 * problem.geometry.ball_radius / (6.013e-3 + problem.geometry.ball_radius);
    assert!((2.0 * radius * curved[0] - 1.0).abs() <= 1e-14);
    assert!(with < 0.0 && with < 10.0 * without, "{with} W with, {without} W without");
}

#[test]
fn slide_to_roll_takes_the_mean_surface_speed_through_the_contact() {
    let curve = ExponentialCurve::BOUNDARY;
    let law = TractionLaw::SlideToRoll { curve, entrainment_floor: 0.01 };
    let (mut problem, layout, _) = preloaded(law);
    let speed = 1000.0 * RPM;
    problem.inner.rotation = Rotation::Speed(Profile::Constant(speed));
    let mut state = start::nominal(&problem.assembly());
    // The ball turns in place, 1 % too fast for the outer race and against nothing else.
    let mut ball = layout.ball_state(&state, 0);
    let g = problem.geometry;
    let orbit = Vector3::from(ball.velocity).norm() / g.pitch_radius;
    let (system, _) = evaluated(&problem, Driver::Lanes, 0.0, &state);
    let overlap = system.sets[0].table.contact[layout.padded].overlap;
    let reach = g.ball_radius - 0.5 * overlap;
    let at_contact = orbit * (g.pitch_radius + reach);
    // No slip at the outer race: spin · reach equals the speed of the ball's centre.
    let rolling = -orbit * g.pitch_radius / reach;
    ball.spin = [rolling * 1.01, 0.0, 0.0];
    layout.set_ball(&mut state, 0, &ball);
    let (system, _) = evaluated(&problem, Driver::Lanes, 0.0, &state);
    let sliding = system.sets[0].table.sliding[layout.padded];
    let slip = 0.01 * rolling * reach;
    // Race and ball pass the contact at these speeds.
    let entrainment = 0.5 * (at_contact + (at_contact - slip));
    // Differences of speeds of 1 m/s.
    assert!((sliding.slip[0] - slip).abs() <= 1e-14, "{} {slip}", sliding.slip[0]);
    assert!((sliding.entrainment / entrainment - 1.0).abs() <= 1e-12);
    let s = slip.abs() / entrainment;
    let expected = (-0.1 + 22.28 * s) * (-181.46 * s).exp() + 0.1;
    let traction = system.sets[0].table.traction[layout.padded];
    let measured = Vector3::from(traction.force).norm() / system.sets[0].table.load[layout.padded];
    assert!((measured / expected - 1.0).abs() <= 1e-10, "{measured} {expected}");
    // At rest nothing is divided by zero: the floor takes over.
    let (_, layout, mut state) = preloaded(problem.traction.clone());
    problem.inner.rotation = Rotation::Speed(Profile::ZERO);
    ball.velocity = [0.0; 3];
    ball.spin = [1.0, 0.0, 0.0];
    layout.set_ball(&mut state, 0, &ball);
    let (system, rates) = evaluated(&problem, Driver::Lanes, 0.0, &state);
    assert!(rates.iter().all(|rate| rate.is_finite()));
    let sliding = system.sets[0].table.sliding[layout.padded];
    assert!((sliding.slip[0].abs() - reach).abs() <= 1e-15 && sliding.entrainment > 0.002);
}

#[test]
fn turning_the_whole_bearing_about_its_axis_changes_no_traction() {
    // Slip and entrainment are relative to the surfaces and to the travelling contact.
    let law =
        TractionLaw::SlideToRoll { curve: ExponentialCurve::BOUNDARY, entrainment_floor: 0.01 };
    for seed in 0..20 {
        let mut problem = bearing(table_5_3(), [0.0; 5], 0.0);
        problem.inner = free_race();
        problem.outer = Some(free_race());
        problem.traction = law.clone();
        let layout = Layout::new(11, false);
        let mut state = random_state(&problem, seed);
        // Parallel axes: the contact's travel is measured about each race's own.
        for at in [layout.inner(), layout.outer()] {
            state[at + QUATERNION..at + QUATERNION + 4].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
        }
        let mut turning = state.clone();
        for (_, at) in bodies(&problem) {
            let mut body = BodyState::from_slice(&entries(&state, at));
            let orbit = Vector3::x().cross(&Vector3::from(body.position)) * 100.0;
            for i in 0..3 {
                body.velocity[i] += orbit[i];
            }
            body.spin[0] += 100.0;
            match at {
                BodyAt::Ball(layout, ball) => layout.set_ball(&mut turning, ball, &body),
                BodyAt::At(at) => turning[at..at + 13].copy_from_slice(&body.to_array()),
            }
        }
        let (still, _) = evaluated(&problem, Driver::Lanes, 0.0, &state);
        let (orbiting, _) = evaluated(&problem, Driver::Lanes, 0.0, &turning);
        assert!(!still.sets[0].table.active.is_empty());
        assert_eq!(still.sets[0].table.active, orbiting.sets[0].table.active);
        for &pair in &still.sets[0].table.active {
            let [a, b] = [&still, &orbiting]
                .map(|system| Vector3::from(system.sets[0].table.traction[pair].force));
            let load = still.sets[0].table.load[pair];
            // Speeds of 3 m/s are added and taken away again: 5e-16 of slips of 1 m/s, times the
            // slope of the friction curve (40 over the entrainment of a few tenths of a m/s).
            assert!((a - b).norm() <= 1e-12 * load, "{a} {b}");
        }
    }
}

#[test]
fn without_traction_no_ball_spin_changes() {
    for seed in 0..20 {
        let problem = bearing(table_5_3(), [0.0; 5], 0.0);
        let layout = Layout::new(11, false);
        let state = random_state(&problem, seed);
        let (system, rates) = evaluated(&problem, Driver::Lanes, 0.0, &state);
        assert!(!system.sets[0].table.active.is_empty());
        for ball in 0..layout.balls {
            let moment = Vector3::from(layout.ball_vector(&rates, SPIN, ball)) * problem.ball.axial;
            // Rounding of arm × (−load · normal).
            assert!(moment.norm() <= 1e-15 * force_scale(&system) * problem.geometry.ball_radius);
        }
    }
}
