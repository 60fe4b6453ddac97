//! Laws of the contact forces at one instant: action and reaction, frame invariance, energy.
#![allow(clippy::needless_range_loop)] // indices are the notation of components

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{CageForce, Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::{ContactDamping, normal_load};
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::{Drive, RotatingLoad, Rotation};
use bearing_dynamics::members::contacts::{Kernel, Want};
use bearing_dynamics::members::state::{BodyState, LEDGER, Ledger, SPIN, VELOCITY};
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::{full_complement, table_4_1, table_5_3};
use dynamics::*;
use nalgebra::Vector3;
use proptest::prelude::*;

/// A bearing with both races free, by the numbers of its laws.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    angular: bool,
    traction: usize,
    damping: usize,
    cage: usize,
    cylindrical: bool,
    hertz: bool,
    /// Balls that nearly fill the pitch circle, so that about half of the neighbours touch.
    crowded: bool,
}

fn any_choice() -> impl Strategy<Value = Choice> {
    let laws = (0..4usize, 0..3usize);
    let cages = (0..4usize, any::<bool>(), any::<bool>());
    (any::<bool>(), laws, cages, any::<bool>()).prop_map(|(angular, laws, cages, crowded)| {
        let (traction, damping) = laws;
        let (cage, cylindrical, hertz) = cages;
        Choice { angular, traction, damping, cage, cylindrical, hertz, crowded }
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
pub fn force_scale(system: &System) -> f64 {
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
        for driver in [Kernel::Scalar, Kernel::Simd] {
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
        let (system, rates) = evaluated(&problem, Kernel::Simd, 0.0, &state);
        let there = moved(&problem, &state, &turn, &Vector3::from(by));
        let mut other = problem.clone();
        other.gravity = (turn * Vector3::from(GRAVITY)).into();
        let (_, other_rates) = evaluated(&other, Kernel::Simd, 0.0, &there);
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
        problem.points_across = 1 + (seed % 3) as usize;
        problem.differential_sliding = seed % 2 == 0;
        let t = 0.013;
        let mut system = System::new(problem.clone(), Kernel::Simd);
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
        // Under a torque an unbalance has kinetic energy of its own: `the_ledger_balances_the_energy` has it.
        whole.unbalance = 0.0;
        let state = random_state(&whole, seed);
        let t = 0.013;
        let (system, rates) = evaluated(&whole, Kernel::Simd, t, &state);
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
                    without.rotating_load = None;
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
        let (system, rates) = evaluated(&problem, Kernel::Simd, 0.0, &state);
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
        let mut problem = choice.problem();
        problem.points_across = 1 + (seed % 3) as usize;
        problem.differential_sliding = seed % 2 == 0;
        let state = random_state(&problem, seed);
        let of = |driver| {
            let mut system = System::new(problem.clone(), driver);
            let (mut rates, mut all) = (vec![0.0; state.len()], Vec::new());
            for want in [Want::Forces, Want::ForcesAndSlopes] {
                system.evaluate_with(want, 0.0, &state, &mut rates);
                all.extend_from_slice(&rates);
            }
            let table = &system.sets[0].table;
            all.extend(table.active.iter().flat_map(|pair| table.slope[*pair]));
            all
        };
        prop_assert_eq!(bits(&of(Kernel::Scalar)), bits(&of(Kernel::Simd)));
    }
}

/// How fast the kinetic energy of all moving bodies grows, W: forces on velocities, moments on spins.
fn kinetic_power(problem: &DynamicProblem, t: f64, state: &[f64]) -> f64 {
    let (_, rates) = evaluated(problem, Kernel::Simd, t, state);
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
