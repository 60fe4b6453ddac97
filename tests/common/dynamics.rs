//! Bearings in motion for the tests: problems, random states, sums over bodies.
#![allow(dead_code)]

use crate::common::{FREE, problem};
use bearing_dynamics::assembly::bearing_alone::{CageBody, DynamicProblem};
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::assembly::places::Places;
use bearing_dynamics::ch2_housing::bearing::ball_contact::{BallContactLaw, equal_spheres};
use bearing_dynamics::ch2_housing::bearing::cage::{CageContacts, CageForce, Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::geometry::{BearingGeometry, Material};
use bearing_dynamics::ch2_housing::bearing::hertz::effective_modulus;
use bearing_dynamics::ch2_housing::bearing::inertia::{self, Inertia};
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::members::body::{Drive, DrivenBody, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::{
    BodyState, Layout, Ledger, ORIENTATION, POSITION, SPIN, VELOCITY,
};
use bearing_dynamics::motion::energy::Energy;
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use nalgebra::{UnitQuaternion, Vector3};

pub const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

pub const RPM: f64 = std::f64::consts::TAU / 60.0;

pub fn race(loads: [f64; 5], rotation: Rotation) -> DrivenBody {
    DrivenBody {
        inertia: inertia::hollow_cylinder(15e-3, 22e-3, 12e-3, 7850.0),
        drives: loads.map(|load| Drive::Load(Profile::Constant(load))),
        rotation,
        foundation_stiffness: [0.0; 5],
        foundation_damping: [0.0; 5],
    }
}

/// A race that nothing holds and nothing drives.
pub fn free_race() -> DrivenBody {
    race([0.0; 5], Rotation::Torque(Profile::ZERO))
}

/// The bearing with given constant loads on an inner race of constant speed (rad/s); fixed outer
/// race, no cage, no traction, no damping, no gravity.
pub fn bearing(geometry: BearingGeometry, loads: [f64; 5], speed: f64) -> DynamicProblem {
    let hertz = problem(geometry, FREE);
    DynamicProblem {
        geometry,
        inner_contact: hertz.inner_contact,
        outer_contact: hertz.outer_contact,
        ball: inertia::ball(geometry.ball_radius, 7850.0),
        inner: race(loads, Rotation::Speed(Profile::Constant(speed))),
        outer: None,
        outer_start: [0.0; 5],
        cage: None,
        ball_phase: 0.1,
        traction: TractionLaw::None,
        slices: 15,
        points_across: 1,
        differential_sliding: false,
        damping: ContactDamping::None,
        raceway_profiles: Vec::new(),
        ball_deviations: Vec::new(),
        ball_contact: Some(ball_law(&geometry)),
        gravity: [0.0; 3],
        rotating_load: None,
        unbalance: 0.0,
    }
}

/// Steel balls with friction.
pub fn ball_law(geometry: &BearingGeometry) -> BallContactLaw {
    let modulus = effective_modulus(&Material::STEEL, &Material::STEEL);
    BallContactLaw {
        stiffness: equal_spheres(modulus, geometry.ball_radius),
        friction: 0.1,
        regularisation_speed: 0.01,
    }
}

/// A cage for either of the tables' bearings, with little room in its pockets.
pub fn cage(geometry: &BearingGeometry, pocket: Pocket, guidance: Guidance) -> CageBody {
    let pitch = geometry.pitch_radius;
    CageBody {
        inertia: inertia::hollow_cylinder(pitch - 2.5e-3, pitch + 2.5e-3, 15e-3, 1400.0),
        contacts: CageContacts {
            pocket,
            pocket_radius: geometry.ball_radius + 0.2e-3,
            pocket_pitch_radius: pitch,
            guidance,
            ring: [pitch - 2.5e-3, pitch + 2.5e-3],
            guide_radius: match guidance {
                Guidance::InnerRace => pitch - 2.5e-3,
                _ => pitch + 2.5e-3,
            },
            race_clearance: 0.15e-3,
            length: 15e-3,
            force: CageForce::Penalty { stiffness: 1e7 },
            friction: 0.1,
            regularisation_speed: 0.01,
        },
    }
}

pub const CONSTANT: TractionLaw =
    TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 };

pub fn traction_laws() -> Vec<TractionLaw> {
    vec![
        TractionLaw::None,
        CONSTANT,
        TractionLaw::SlideToRoll { curve: ExponentialCurve::BOUNDARY, entrainment_floor: 0.01 },
        TractionLaw::SlipSpeed { curve: ExponentialCurve { b: 0.5, c: 8.0, d: 0.1 } },
    ]
}

/// Numbers in [−1, 1] from a seed (splitmix64).
pub struct Noise(pub u64);

impl Noise {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, size: f64) -> [f64; 3] {
        [size * self.next(), size * self.next(), size * self.next()]
    }

    pub fn turn(&mut self, size: f64) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(Vector3::from(self.vector(size)))
    }
}

fn shaken(
    body: BodyState,
    noise: &mut Noise,
    far: f64,
    turn: f64,
    fast: f64,
    spin: f64,
) -> BodyState {
    let sum = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    BodyState {
        position: sum(body.position, noise.vector(far)),
        orientation: noise.turn(turn) * body.orientation,
        velocity: sum(body.velocity, noise.vector(fast)),
        spin: sum(body.spin, noise.vector(spin)),
    }
}

/// Nominal positions shaken so that about half the contacts are closed, everything in motion.
pub fn random_state(problem: &DynamicProblem, seed: u64) -> Vec<f64> {
    let layout = Layout::new(problem.geometry.ball_count, problem.cage.is_some());
    let mut state = start::nominal(&problem.assembly());
    let mut noise = Noise(seed);
    for ball in 0..layout.balls {
        let body = shaken(layout.ball_state(&state, ball), &mut noise, 15e-6, 3.0, 0.5, 300.0);
        layout.set_ball(&mut state, ball, &body);
    }
    let mut shake = |state: &mut [f64], at: usize, far: f64, turn: f64, spin: f64| {
        let body = shaken(BodyState::from_slice(&state[at..]), &mut noise, far, turn, 0.1, spin);
        state[at..at + 13].copy_from_slice(&body.to_array());
    };
    shake(&mut state, layout.inner(), 20e-6, 2e-3, 100.0);
    if problem.outer.is_some() {
        shake(&mut state, layout.outer(), 20e-6, 2e-3, 100.0);
    }
    if layout.has_cage {
        shake(&mut state, layout.cage(), 300e-6, 1e-2, 100.0);
    }
    state
}

/// A system as evaluated at a state, and the rates.
pub fn evaluated(
    problem: &DynamicProblem,
    driver: Kernel,
    t: f64,
    state: &[f64],
) -> (System, Vec<f64>) {
    let mut system = System::new(problem.clone(), driver);
    let mut rates = vec![0.0; state.len()];
    system.evaluate(t, state, &mut rates);
    (system, rates)
}

/// Energy of a state.
pub fn energy(system: &mut System, t: f64, state: &[f64]) -> Energy {
    let mut rates = vec![0.0; state.len()];
    system.evaluate(t, state, &mut rates);
    system.energy(state)
}

/// Inertia and place in the state vector of every body that moves.
pub fn bodies(of: impl Into<Assembly>) -> Vec<(Inertia, BodyAt)> {
    let assembly = of.into();
    let mut all = Vec::new();
    for (bearing, layout) in assembly.bearings.iter().zip(Layout::of(&assembly)) {
        all.extend((0..layout.balls).map(|i| (bearing.ball, BodyAt::Ball(layout, i))));
    }
    let places = Places::of(&assembly);
    for (index, body) in assembly.bodies.iter().enumerate() {
        all.extend(body.inertia().map(|inertia| (*inertia, BodyAt::At(places.body(index)))));
    }
    all
}

#[derive(Clone, Copy, Debug)]
pub enum BodyAt {
    Ball(Layout, usize),
    At(usize),
}

/// A body's entries of a state vector or of its rates.
pub fn entries(vector: &[f64], at: BodyAt) -> [f64; 13] {
    std::array::from_fn(|i| match at {
        BodyAt::Ball(layout, ball) => vector[layout.ball(i) + ball],
        BodyAt::At(at) => vector[at + i],
    })
}

pub fn part(entries: &[f64; 13], at: usize) -> Vector3<f64> {
    Vector3::new(entries[at], entries[at + 1], entries[at + 2])
}

/// Momentum and angular momentum about the origin of all moving bodies.
pub fn momenta(of: impl Into<Assembly>, state: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
    let mut sums = (Vector3::zeros(), Vector3::zeros());
    for (inertia, at) in bodies(of) {
        let all = entries(state, at);
        let body = BodyState::from_slice(&all);
        let momentum = part(&all, VELOCITY) * inertia.mass;
        let (axis, spin) = (Vector3::from(body.axis()), part(&all, SPIN));
        let own = spin * inertia.transverse
            + axis * ((inertia.axial - inertia.transverse) * axis.dot(&spin));
        sums.0 += momentum;
        sums.1 += part(&all, POSITION).cross(&momentum) + own;
    }
    sums
}

/// Force and moment about the origin that the rates say act on all moving bodies: d/dt of
/// [`momenta`], with the axis of each body turning with it.
pub fn load_sums(
    problem: &DynamicProblem,
    state: &[f64],
    rates: &[f64],
) -> (Vector3<f64>, Vector3<f64>) {
    let mut sums = (Vector3::zeros(), Vector3::zeros());
    for (inertia, at) in bodies(problem) {
        let all = entries(state, at);
        let rate = entries(rates, at);
        let force = part(&rate, VELOCITY) * inertia.mass;
        let axis = Vector3::from(BodyState::from_slice(&all).axis());
        let (spin, spin_rate) = (part(&all, SPIN), part(&rate, SPIN));
        let difference = inertia.axial - inertia.transverse;
        let own = spin_rate * inertia.transverse
            + axis * (difference * axis.dot(&spin_rate))
            + spin.cross(&axis) * (difference * axis.dot(&spin));
        sums.0 += force;
        sums.1 += part(&all, POSITION).cross(&force) + own;
    }
    sums
}

/// All bodies turned and then moved; the ledger and padding stay.
pub fn moved(
    problem: &DynamicProblem,
    state: &[f64],
    turn: &UnitQuaternion<f64>,
    by: &Vector3<f64>,
) -> Vec<f64> {
    let mut all = state.to_vec();
    for (_, at) in bodies(problem) {
        let body = BodyState::from_slice(&entries(state, at));
        let rotate = |v: [f64; 3]| -> [f64; 3] { (turn * Vector3::from(v)).into() };
        let body = BodyState {
            position: (turn * Vector3::from(body.position) + by).into(),
            orientation: turn * body.orientation,
            velocity: rotate(body.velocity),
            spin: rotate(body.spin),
        };
        for (i, value) in body.to_array().into_iter().enumerate() {
            match at {
                BodyAt::Ball(layout, ball) => all[layout.ball(i) + ball] = value,
                BodyAt::At(at) => all[at + i] = value,
            }
        }
    }
    all
}

pub fn fixed_step(step: f64, start: Start) -> RunOptions {
    RunOptions {
        start,
        stepping: Stepping::Fixed(step),
        driver: Kernel::Simd,
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    }
}

pub fn simulation(problem: &DynamicProblem, step: f64, start: Start) -> Simulation {
    Simulation::new(problem.clone(), fixed_step(step, start)).unwrap()
}

pub fn run(simulation: &mut Simulation, steps: usize) {
    for _ in 0..steps {
        simulation.step().unwrap();
    }
}

pub fn inner_state(simulation: &Simulation) -> BodyState {
    BodyState::from_slice(&simulation.state[simulation.system.sets[0].layout.inner()..])
}

pub fn ledger(simulation: &Simulation, entry: Ledger) -> f64 {
    simulation.state[simulation.system.sets[0].layout.ledger_entry(entry)]
}

/// Bits of a state vector, without the orientation of the padding.
pub fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

pub const QUATERNION: usize = ORIENTATION;
