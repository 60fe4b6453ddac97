//! The step limit against the observed one, and against the state that it follows from.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::{BodyState, Layout, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Simulation, Start};
use bearing_dynamics::motion::stability::step_limit;
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::Vector3;

/// How far two runs at the same step, one of them nudged at the start, are apart at the end: m/s.
fn nudged_apart(problem: &DynamicProblem, state: &[f64], step: f64, steps: usize) -> f64 {
    let mut nudged = state.to_vec();
    let mut noise = Noise(5);
    let size = 1e-8;
    for (_, at) in bodies(problem) {
        let mut body = BodyState::from_slice(&entries(state, at));
        for i in 0..3 {
            body.velocity[i] += size * noise.next();
            body.spin[i] += size / problem.geometry.ball_radius * noise.next();
        }
        match at {
            BodyAt::Ball(layout, ball) => layout.set_ball(&mut nudged, ball, &body),
            BodyAt::At(at) => nudged[at..at + 13].copy_from_slice(&body.to_array()),
        }
    }
    let [a, b] = [state, &nudged].map(|state| {
        let options = fixed_step(step, Start::Nominal);
        let mut simulation =
            Simulation::from_state(problem.clone(), options, state.to_vec(), 0.0).unwrap();
        for _ in 0..steps {
            if simulation.step().is_err() {
                break;
            }
        }
        simulation.state
    });
    let mut apart = 0.0_f64;
    for (_, at) in bodies(problem) {
        let (a, b) = (entries(&a, at), entries(&b, at));
        let speed = (part(&a, VELOCITY) - part(&b, VELOCITY)).norm();
        let spin = (part(&a, SPIN) - part(&b, SPIN)).norm() * problem.geometry.ball_radius;
        apart = apart.max(speed).max(spin);
        if !(speed.is_finite() && spin.is_finite()) {
            return f64::INFINITY;
        }
    }
    apart / size
}

/// Largest step at which a nudge does not grow, found by bisection, over the predicted one.
fn observed_over_predicted(problem: &DynamicProblem) -> f64 {
    // Past the first slips: those that pure rolling leaves (mm/s) saturate a diverging traction,
    // nudged or not, before the nudge has grown.
    let mut settled = simulation(problem, 0.1e-6, Start::Equilibrium);
    run(&mut settled, 10_000);
    let state = settled.state;
    let mut system = System::new(problem.clone(), Kernel::Simd);
    let limit = step_limit(&mut system, 0.0, &state).unwrap();
    let (mut low, mut high) = (0.6, 1.7);
    for _ in 0..7 {
        let middle = f64::sqrt(low * high);
        // Above the limit by 1 % a mode grows by some 3 % a step: e⁶ in 200 steps. Below it the
        // nudge stays about what it was.
        if nudged_apart(problem, &state, middle * limit.step, 200) <= 10.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let reason = limit.reason(&system.assembly);
    println!("{reason}: limit {:e} s, observed/predicted {low:.4}", limit.step);
    low
}

#[test]
fn the_step_limit_is_where_runs_begin_to_grow() {
    let mut cases = Vec::new();
    let radial = [50.0, 0.0, -1500.0, 0.0, 0.0];
    let axial = [445.0, 0.0, 0.0, 0.0, 0.0];
    cases.push(bearing(table_4_1(-5e-6), radial, 0.0));
    cases.push(bearing(table_5_3(), axial, 1000.0 * RPM));
    // The onset of traction is stiffer than the contacts.
    let gentle = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 };
    let steep = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.005 };
    for law in [gentle.clone(), steep, traction_laws()[2].clone()] {
        let mut problem = bearing(table_4_1(-5e-6), radial, 1000.0 * RPM);
        problem.traction = law;
        cases.push(problem);
    }
    // A race so light about its diameters that its tilting is the fastest motion.
    let mut tilting = bearing(table_5_3(), [2000.0, 0.0, 0.0, 0.0, 0.0], 0.0);
    tilting.inner.inertia = Inertia { mass: 0.1, axial: 2e-8, transverse: 1e-7 };
    cases.push(tilting);
    // The same for a stiff foundation of a free outer race.
    let mut founded = bearing(table_4_1(-5e-6), radial, 1000.0 * RPM);
    let mut outer = free_race();
    outer.rotation = Rotation::Speed(Profile::ZERO);
    outer.foundation_stiffness = [1e10, 1e10, 1e10, 1e8, 1e8];
    founded.outer = Some(outer);
    cases.push(founded);
    for problem in &cases {
        let ratio = observed_over_predicted(problem);
        assert!((ratio - 1.0).abs() <= 0.1, "{ratio}");
    }
}

#[test]
fn the_reason_names_what_binds_the_step() {
    let radial = [50.0, 0.0, -1500.0, 0.0, 0.0];
    let turning = || bearing(table_4_1(-5e-6), radial, 1000.0 * RPM);
    let founded = |stiffness: f64, damping: f64| {
        let mut problem = turning();
        let mut outer = free_race();
        outer.rotation = Rotation::Speed(Profile::ZERO);
        outer.foundation_stiffness = [1e8, 1e8, stiffness, 1e5, 1e5];
        outer.foundation_damping = [500.0, 500.0, damping, 0.5, 0.5];
        problem.outer = Some(outer);
        problem
    };
    let mut sliding = turning();
    sliding.traction = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.005 };
    let mut damped = turning();
    damped.damping = ContactDamping::HuntCrossley { alpha: 200.0 };
    // Both, one of them far slower than the other.
    let mut both = sliding.clone();
    both.damping = ContactDamping::HuntCrossley { alpha: 0.1 };
    for (problem, rate, part) in [
        (turning(), "oscillation at ", "ball "),
        (sliding, "decay at ", "ball "),
        (both, "decay at ", "ball "),
        (damped, "decay at ", "ball "),
        (founded(1e8, 1e6), "decay at ", "the outer race along z"),
        (founded(1e12, 0.0), "oscillation at ", "the outer race along z"),
    ] {
        let state = start::at_equilibrium(&problem.assembly()).unwrap();
        let mut system = System::new(problem.clone(), Kernel::Simd);
        let limit = step_limit(&mut system, 0.0, &state).unwrap();
        let reason = limit.reason(&system.assembly);
        println!("{reason}: {:e} s", limit.step);
        assert!(reason.starts_with(rate), "{reason} instead of {rate}");
        assert!(reason.contains(&format!(", mainly of {part}")), "{reason} instead of {part}");
        assert_eq!(step_limit(&mut system, 0.0, &state), Some(limit));
    }
}

/// Everything given but what `free` frees; interference so light that contacts are 50 nm deep.
fn held(free: impl Fn(&mut DynamicProblem)) -> (DynamicProblem, Vec<f64>) {
    let mut problem = bearing(table_4_1(-0.1e-6), [0.0; 5], 0.0);
    for drive in &mut problem.inner.drives {
        *drive = Drive::Motion(Profile::ZERO);
    }
    free(&mut problem);
    let state = start::nominal(&problem.assembly());
    (problem, state)
}

fn limit_at(problem: &DynamicProblem, state: &[f64]) -> f64 {
    let mut system = System::new(problem.clone(), Kernel::Simd);
    step_limit(&mut system, 0.0, state).unwrap().step
}

/// Ends of the stability region of classical Runge–Kutta: a swing at ω h = √8, a decay at 2.785.
const DECAYS: f64 = 2.785_293_563_405_282;

#[test]
fn the_step_limit_of_a_ball_follows_from_the_state_itself() {
    // Contacts so light that a displacement of 1 % of their depth in the Jacobian would show.
    let (problem, state) = held(|_| {});
    let (system, ..) = evaluated(&problem, Kernel::Scalar, 0.0, &state);
    let per_mass = 1.0 / problem.ball.mass;
    let layout = system.sets[0].layout;
    let sum: f64 = [0, 1]
        .map(|side| {
            let overlap = system.sets[0].table.contact[side * layout.padded].overlap;
            assert!(overlap > 20e-9 && overlap < 100e-9, "{overlap}");
            1.5 * system.sets[0].laws.races[side].stiffness * overlap.sqrt()
        })
        .iter()
        .sum();
    let expected = 8.0_f64.sqrt() / (sum * per_mass).sqrt();
    let found = limit_at(&problem, &state);
    // Differences over 0.2 % of the depth, of second order: 2e-7; growth of 1e-6 a step passes.
    assert!((found / expected - 1.0).abs() <= 2e-5, "{found} {expected}");

    // A slip at rest decays by rolling the ball on the spot: 2 κ' W r²/I, steeper than any swing.
    let u0 = 1e-4;
    let law = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: u0 };
    let (problem, state) = held(|problem| problem.traction = law.clone());
    let (system, ..) = evaluated(&problem, Kernel::Scalar, 0.0, &state);
    let inertia = problem.ball.axial;
    // Slip of each contact is v ± ρ ω: two equations of shift and roll, symmetric in v √m and ω √I.
    let [mut shift, mut both, mut roll] = [0.0; 3];
    for (side, sign) in [(0, -1.0), (1, 1.0)] {
        let pair = side * layout.padded;
        let reach = problem.geometry.ball_radius - 0.5 * system.sets[0].table.contact[pair].overlap;
        let slope = 0.07 / u0 * system.sets[0].table.load[pair];
        shift += slope * per_mass;
        both += sign * slope * reach * (per_mass / inertia).sqrt();
        roll += slope * reach * reach / inertia;
    }
    let decay = 0.5 * (shift + roll) + libm::hypot(0.5 * (roll - shift), both);
    let found = limit_at(&problem, &state);
    // Differences over 6e-6 of the onset's width; swings, a tenth as fast, turn with it by 1e-2 of that.
    assert!((found * decay / DECAYS - 1.0).abs() <= 1e-3, "{found} {}", DECAYS / decay);
}

#[test]
fn the_step_limit_of_a_bearing_that_moves_as_a_whole_is_that_of_one_at_rest() {
    let law = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 1e-4 };
    let (problem, state) = held(|problem| {
        problem.traction = law.clone();
        problem.inner = free_race();
        problem.outer = Some(free_race());
    });
    let layout = Layout::new(problem.geometry.ball_count, false);
    let resting = limit_at(&problem, &state);
    // Travelling in any direction, m/s, and turning about the axis, rad/s: nothing slides on anything.
    for (travel, turn, tolerance) in [
        // Differences over 1e-7 of the speed: 1 % of the onset's width at 10 m/s, squared.
        ([5.0, -6.0, 6.0], 0.0, 3e-4),
        // Besides, gyroscopic moments and the turning of what slides: 300 of 2.5e5 1/s.
        ([0.0; 3], 300.0, 5e-3),
    ] {
        let mut moving = state.clone();
        let along = Vector3::from(travel);
        let about = Vector3::x() * turn;
        for ball in 0..layout.balls {
            let mut body = layout.ball_state(&state, ball);
            body.velocity = (along + about.cross(&Vector3::from(body.position))).into();
            body.spin = about.into();
            layout.set_ball(&mut moving, ball, &body);
        }
        for at in [layout.inner(), layout.outer()] {
            for i in 0..3 {
                moving[at + VELOCITY + i] = along[i];
                moving[at + SPIN + i] = about[i];
            }
        }
        let found = limit_at(&problem, &moving);
        println!("{travel:?}, {turn}: {}", found / resting - 1.0);
        assert!((found / resting - 1.0).abs() <= tolerance, "{travel:?} {turn}: {found} {resting}");
    }
}

#[test]
fn the_step_limit_of_a_tilting_race_follows_from_the_state_itself() {
    // Balls too heavy to move; the race swings about its diameters alone.
    let (problem, state) = held(|problem| {
        problem.ball.mass = 1e6;
        for k in [3, 4] {
            problem.inner.drives[k] = Drive::Load(Profile::ZERO);
        }
        problem.inner.inertia.transverse = 1e-9;
        problem.inner.inertia.axial = 1e-9;
    });
    let layout = Layout::new(problem.geometry.ball_count, false);
    let mut system = System::new(problem.clone(), Kernel::Scalar);
    let mut rates = vec![0.0; state.len()];
    let mut spin_rate = |angle: f64| {
        let mut turned = state.clone();
        let mut body = BodyState::from_slice(&state[layout.inner()..]);
        body.orientation = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::y() * angle);
        turned[layout.inner()..layout.inner() + 13].copy_from_slice(&body.to_array());
        system.evaluate(0.0, &turned, &mut rates);
        rates[layout.inner() + SPIN + 1]
    };
    // Shifts of 3e-12 m at the pitch circle: 1e-4 of the depth.
    let angle = 1e-10;
    let squared = -(spin_rate(angle) - spin_rate(-angle)) / (2.0 * angle);
    assert!(squared > 0.0, "{squared}");
    let expected = 8.0_f64.sqrt() / squared.sqrt();
    let found = limit_at(&problem, &state);
    // Rounding of 1e-17 m in shifts of 3e-12 m; eight balls hold both tilts alike.
    assert!((found / expected - 1.0).abs() <= 1e-3, "{found} {expected}");
}
