//! A housing reduced to shapes: what the shapes are, what the seat does, how shapes and race swing, and limits that are
//! known.
#![allow(clippy::needless_range_loop)] // indices are the notation of components

use crate::{common, dynamics, housing_common};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::{Assembly, OUTER};
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::kinematics::vec3::{add, cross, dot, scale};
use bearing_dynamics::members::body::{Drive, DrivenBody, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::reduced_solid::ReducedSolid;
use bearing_dynamics::members::state::{ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::motion::reduced_start::{add_housing, put_in_equilibrium};
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Start, Stepping,
};
use bearing_dynamics::motion::system::System;
use bearing_dynamics::motion::{reduced_start, start};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::plan::counts::Counts;
use bearing_dynamics::reduction::component_modes::{
    CutOff, ReduceError, ReduceOptions, Reduction, reduce,
};
use bearing_dynamics::reduction::load_patterns::{LargestLoads, LoadPatterns, pressed};
use bearing_dynamics::solids::bore_equilibrium::{Axial, Fit};
use bearing_dynamics::solids::condensation::{CondensedBore, condense};
use bearing_dynamics::solids::model::{Load, SolidModel};
use bearing_dynamics::solids::plan::SolidSteps;
use bearing_dynamics::solids::tangent::{Unknowns, pattern, stiffness};
use common::table_4_1;
use dynamics::*;
use housing_common::{BORE, COARSE, RING, WIDTH, YOUNG, bore_of, mesh_of, model_of, reach};
use std::f64::consts::TAU;

const PENALTY: fn() -> Penalty = Penalty::default;

pub(crate) fn fit(interference: f64) -> Fit {
    Fit { radius: BORE + interference, axial: Axial::Fixed }
}

/// The ring of housing D on a coarse mesh, condensed, and reduced.
pub(crate) struct Housing {
    pub(crate) model: SolidModel,
    pub(crate) bore: CondensedBore,
    pub(crate) reduction: Reduction,
}

fn reduced_model(model: SolidModel, bore: CondensedBore, modes_to: f64, left_out: f64) -> Housing {
    let loads = pressed(
        &bore,
        PENALTY(),
        &fit(0.0),
        &LargestLoads { force: 250.0, ..LargestLoads::default() },
    )
    .unwrap();
    let options = ReduceOptions { modes_to, left_out };
    let reduction = reduce(&model, &bore, PENALTY(), &loads, &options).unwrap();
    Housing { model, bore, reduction }
}

pub(crate) fn ring(
    young: f64,
    change: impl FnOnce(&mut SolidModel),
    modes_to: f64,
    left_out: f64,
) -> Housing {
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let mut model = model_of(&mesh, young);
    change(&mut model);
    let bore = condense(&model, &bore_of(&mesh), &reach()).unwrap();
    reduced_model(model, bore, modes_to, left_out)
}

pub(crate) fn plain() -> Housing {
    ring(YOUNG, |_| {}, 60e3, 1e-3)
}

/// Table 2.2's bearing whose outer race moves in a housing.
pub(crate) fn mounted(load: f64) -> DynamicProblem {
    let mut outer = DrivenBody {
        inertia: inertia::hollow_cylinder(32e-3, BORE, WIDTH, 7850.0),
        ..race([0.0; 5], Rotation::Speed(Profile::ZERO))
    };
    outer.drives[0] = Drive::Motion(Profile::ZERO);
    let loads = [0.0, 0.3 * load, load, 0.0, 0.0];
    DynamicProblem { outer: Some(outer), ..bearing(table_4_1(-5e-6), loads, 0.0) }
}

pub(crate) fn seated(housing: &Housing, problem: &DynamicProblem, radius: Profile) -> Assembly {
    let mut assembly = problem.assembly();
    add_housing(&mut assembly, OUTER, &housing.reduction, &housing.bore, radius, PENALTY());
    assembly
}

/// In equilibrium, with this interference.
pub(crate) fn settled(
    housing: &mut Housing,
    problem: &DynamicProblem,
    interference: f64,
) -> Assembly {
    let fit = fit(interference);
    let mut assembly = seated(housing, problem, Profile::Constant(fit.radius));
    let Housing { bore, reduction, .. } = housing;
    let housing = reduced_start::Housing { reduction, bore, fit, penalty: PENALTY() };
    put_in_equilibrium(&mut assembly, &mut [housing]).unwrap();
    assembly
}

pub fn options(integrator: Integrator, stepping: Stepping) -> RunOptions {
    RunOptions { integrator, stepping, ..RunOptions::default() }
}

pub(crate) fn state_of(assembly: &Assembly) -> (System, Vec<f64>) {
    let state = start::at_equilibrium(assembly).unwrap();
    (System::new(assembly.clone(), Kernel::Simd), state)
}

pub(crate) fn rates_of(system: &mut System, t: f64, state: &[f64]) -> Vec<f64> {
    let mut rates = vec![0.0; state.len()];
    system.evaluate(t, state, &mut rates);
    rates
}

/// Shakes bodies and shapes of a state so that everything moves and some nodes touch.
pub(crate) fn shaken_state(system: &System, state: &[f64], noise: &mut Noise) -> Vec<f64> {
    let mut shaken = state.to_vec();
    let at = system.places.body(OUTER);
    for i in 0..3 {
        shaken[at + POSITION + i] += [0.0, 1e-6, 1e-6][i] * noise.next();
        shaken[at + VELOCITY + i] += [0.0, 1e-2, 1e-2][i] * noise.next();
        shaken[at + SPIN + i] += [0.0, 0.1, 0.1][i] * noise.next();
    }
    let solid = &system.assembly.solids[0];
    let (gone, count) = (system.solids[0], solid.count());
    for k in 0..count {
        let size = solid.surfaces[0].largest().nth(k).unwrap();
        shaken[gone + k] += 1e-7 / size * noise.next();
        shaken[gone + count + k] += 1e-2 / size * noise.next();
    }
    shaken
}

#[test]
fn shapes_are_orthogonal_under_mass_and_stiffness() {
    let housing = ring(
        YOUNG,
        |model| {
            model.problem.gravity = [0.0, 0.0, -9.81];
            let nodes = model.problem.nodes.len() as u32;
            let forces = (0..nodes).step_by(7).map(|node| (node, [0.1, 0.2, -0.3])).collect();
            model.problem.loads.push(Load { forces, profile: Profile::Constant(2.0) });
        },
        60e3,
        1e-3,
    );
    let (model, reduction) = (&housing.model, &housing.reduction);
    let cut = &reduction.cut_off;
    assert!(cut.natural >= 3 && cut.patterns >= 5 && cut.own == 2, "{cut:?}");
    let unknowns = Unknowns::new(model);
    let mut matrix = pattern(&model.problem, &unknowns);
    stiffness(model, &unknowns, &vec![[0.0; 3]; model.mass.len()], &mut matrix);
    let flat = |shape: &Vec<[f64; 3]>| {
        let mut flat = vec![0.0; unknowns.count];
        for (of, u) in unknowns.of.iter().zip(shape) {
            for i in 0..3 {
                if of[i] < flat.len() {
                    flat[of[i]] = u[i];
                }
            }
        }
        flat
    };
    let shapes: Vec<Vec<f64>> = reduction.shapes.iter().map(flat).collect();
    let w = &reduction.solid.frequencies;
    for (j, shape) in shapes.iter().enumerate() {
        let mut force = vec![0.0; shape.len()];
        matrix.multiply(shape, &mut force);
        for i in 0..shapes.len() {
            let stiff: f64 = shapes[i].iter().zip(&force).map(|(a, b)| a * b).sum();
            let pairs = reduction.shapes[i].iter().zip(&reduction.shapes[j]).zip(&model.mass);
            let mass: f64 = pairs.map(|((a, b), m)| m * dot(*a, *b)).sum();
            let unit = if i == j { 1.0 } else { 0.0 };
            // Natural shapes are known to 1e-8 of their residual, which goes into what they leave.
            assert!((mass - unit).abs() <= 1e-6, "mass {i} {j}: {mass:e}");
            assert!((stiff / (w[i] * w[j]) - unit).abs() <= 1e-6, "stiffness {i} {j}: {stiff:e}");
        }
    }
    // Statically exact for weight and loads.
    let own = housing.bore.displacement(&vec![0.0; housing.bore.nodes.len()]);
    let found = reduction.displacement(&reduction.rest(&vec![0.0; housing.bore.nodes.len()]));
    let largest = own.iter().flatten().fold(0.0f64, |most, u| most.max(u.abs()));
    for (found, own) in found.iter().flatten().zip(own.iter().flatten()) {
        assert!((found - own).abs() <= 1e-6 * largest, "{found:e} {own:e}");
    }
    // So is how far they move the bore outwards.
    let bore = &housing.bore;
    let largest = bore.own.iter().fold(0.0f64, |most, u| most.max(u.abs()));
    for (found, own) in reduction.own().iter().zip(&bore.own) {
        assert!((found - own).abs() <= 1e-6 * largest, "{found:e} {own:e}");
    }
}

/// A ball between its races by Hertz: springs 1.5 K δ½ on either side, under five times the mean load and what an
/// interference presses it with. A clearance presses nothing.
#[test]
fn the_frequency_of_a_ball_knows_load_and_interference() {
    let problem = bearing(table_4_1(0.0), [0.0; 5], 0.0);
    let found = |clearance: f64, force: f64| {
        let mut bearing = problem.assembly().bearings[0].clone();
        bearing.geometry.radial_clearance = clearance;
        reduced_start::ball_frequency(&bearing, force)
    };
    let [inner, outer] = [problem.inner_contact.stiffness, problem.outer_contact.stiffness];
    let expected = |load: f64| {
        let slope = |k: f64| 1.5 * (k * k * load).cbrt();
        ((slope(inner) + slope(outer)) / problem.ball.mass).sqrt() / std::f64::consts::TAU
    };
    // δ = δ_i + δ_o of equal loads: F = (δ/(K_i^−⅔ + K_o^−⅔))^1.5.
    let soft = |k: f64| (1.0 / (k * k)).cbrt();
    let pressed = (8e-6 / (soft(inner) + soft(outer))).powf(1.5);
    let carried = 5.0 * 250.0 / 8.0;
    for (clearance, force, load) in [
        (0.0, 250.0, carried),
        (8e-6, 250.0, carried),
        (-8e-6, 0.0, pressed),
        (-8e-6, 250.0, pressed + carried),
    ] {
        let [found, expected] = [found(clearance, force), expected(load)];
        assert!((found / expected - 1.0).abs() <= 1e-12, "{clearance} {force}: {found} {expected}");
    }
}

#[test]
fn frequencies_that_are_none_and_too_many_shapes_are_refused() {
    let mesh = mesh_of(&RING, &COARSE, Order::Linear);
    let model = model_of(&mesh, YOUNG);
    let bore = condense(&model, &bore_of(&mesh), &reach()).unwrap();
    for modes_to in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = ReduceOptions { modes_to, left_out: 1e-3 };
        let refused = reduce(&model, &bore, PENALTY(), &LoadPatterns::default(), &options);
        assert!(matches!(refused, Err(ReduceError::Frequency { .. })), "{modes_to}");
    }
    // No natural shape below: all is static answers.
    let loads = pressed(
        &bore,
        PENALTY(),
        &fit(0.0),
        &LargestLoads { force: 250.0, ..LargestLoads::default() },
    )
    .unwrap();
    let options = ReduceOptions { modes_to: 1.0, left_out: 1e-3 };
    let stiff = reduce(&model, &bore, PENALTY(), &loads, &options).unwrap();
    assert_eq!(stiff.cut_off.natural, 0);
    assert!(stiff.cut_off.first_left_out > 1e3);
}

#[test]
fn without_overlap_nothing_pushes() {
    let housing = plain();
    let assembly = seated(&housing, &mounted(0.0), Profile::Constant(BORE - 1e-6));
    let (mut system, state) = state_of(&assembly);
    let rates = rates_of(&mut system, 0.0, &state);
    assert_eq!(system.seats[0].contact.touching, 0);
    let at = system.solids[0];
    assert!(rates[at..at + 2 * assembly.solids[0].count()].iter().all(|rate| *rate == 0.0));
    assert_eq!(system.energy(&state).seat, 0.0);
    // With one it does.
    let tight = seated(&housing, &mounted(0.0), Profile::Constant(BORE + 1e-6));
    let mut system = System::new(tight, Kernel::Simd);
    rates_of(&mut system, 0.0, &state);
    assert_eq!(system.seats[0].contact.touching, housing.bore.nodes.len());
    assert!(system.energy(&state).seat > 0.0);
}

/// Work of the seat along any motion of race and shapes is what its energy loses: whatever the race gets the shapes get.
#[test]
fn forces_are_the_slopes_of_the_energy() {
    let mut housing = plain();
    let assembly = settled(&mut housing, &mounted(400.0), 0.2e-6);
    let (mut system, state) = state_of(&assembly);
    let mut noise = Noise(3);
    let state = shaken_state(&system, &state, &mut noise);
    let rates = rates_of(&mut system, 0.0, &state);
    let touching = system.seats[0].touching.len();
    assert!(touching > 5 && touching < housing.bore.nodes.len(), "{touching}");
    let loads = system.seats[0].contact;
    let solid = assembly.solids[0].clone();
    let (at, count) = (system.solids[0], solid.count());
    let mut own = vec![0.0; count];
    let now = [&state[at..at + count], &state[at + count..at + 2 * count]];
    let all = SolidSteps { supports: true, loads: true, gravity: true, damping: true };
    solid.accelerations(all, 0.0, now, &mut own, &mut Counts::default());
    let body = system.places.body(OUTER);
    for _ in 0..8 {
        let (shift, turn) = (noise.vector(1.0), noise.vector(1.0 / BORE));
        let moved: Vec<f64> = (0..count).map(|_| noise.next()).collect();
        let mut work = dot(loads.force, shift) + dot(loads.moment, turn);
        for k in 0..count {
            work += (rates[at + count + k] - own[k]) * moved[k];
        }
        let energy = |system: &mut System, by: f64| {
            let mut there = state.clone();
            for i in 0..3 {
                there[body + POSITION + i] += by * shift[i];
            }
            let q = [0, 1, 2, 3].map(|i| state[body + ORIENTATION + i]);
            for (i, change) in quaternion_rate(q, scale(turn, by)).into_iter().enumerate() {
                there[body + ORIENTATION + i] += change;
            }
            for k in 0..count {
                there[at + k] += by * moved[k];
            }
            rates_of(system, 0.0, &there);
            system.energy(&there).seat
        };
        let step = 1e-10;
        let lost = (energy(&mut system, -step) - energy(&mut system, step)) / (2.0 * step);
        // Nodes on the verge of touching bend the energy: 1e-10 m of overlaps of 1e-7 m.
        assert!((work - lost).abs() <= 1e-4 * work.abs().max(1.0), "{work:e} {lost:e}");
    }
}

#[test]
fn what_the_shapes_get_the_race_gets() {
    let mut housing = plain();
    let assembly = settled(&mut housing, &mounted(400.0), 0.2e-6);
    let (mut system, state) = state_of(&assembly);
    let state = shaken_state(&system, &state, &mut Noise(5));
    rates_of(&mut system, 0.0, &state);
    // Forces on the nodes along their own normals, summed about the race's centre.
    let now = &system.seats[0];
    let surface = &assembly.solids[0].surfaces[0];
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for touching in &now.touching {
        // The contact's force; the part along the node's own normal moves the shapes.
        let push = scale(touching.normal, touching.load / touching.along);
        force = add(force, push);
        moment = add(moment, cross(touching.arm, push));
        let own = dot(push, surface.nodes[touching.node].normal);
        assert!((own - touching.load).abs() <= 1e-12 * own.abs());
    }
    for i in 0..3 {
        assert!((force[i] + now.contact.force[i]).abs() <= 1e-9 * 400.0, "{force:?}");
        assert!((moment[i] + now.contact.moment[i]).abs() <= 1e-9 * 400.0 * BORE, "{moment:?}");
    }
}

/// The body that sits there accelerates and turns by what the seat says.
#[test]
fn the_race_moves_by_the_force_and_the_moment_of_its_seat() {
    let mut housing = plain();
    let assembly = settled(&mut housing, &mounted(400.0), 0.2e-6);
    let (mut system, state) = state_of(&assembly);
    let state = shaken_state(&system, &state, &mut Noise(7));
    let held = rates_of(&mut system, 0.0, &state);
    let contact = system.seats[0].contact;
    assert!(contact.moment[1].abs() + contact.moment[2].abs() > 1e-2, "{contact:?}");
    let mut loose = assembly.clone();
    loose.seats[0].radius = Profile::Constant(BORE - 1e-4);
    let free = rates_of(&mut System::new(loose, Kernel::Simd), 0.0, &state);
    let inertia = *assembly.bodies[OUTER].inertia().unwrap();
    let at = system.places.body(OUTER);
    for i in 1..3 {
        let change = |entry: usize| held[at + entry + i] - free[at + entry + i];
        let (force, moment) = (inertia.mass * change(VELOCITY), inertia.transverse * change(SPIN));
        // Along the world's axes: the race is tilted by some 1e-6.
        assert!((force - contact.force[i]).abs() <= 1e-6 * contact.force[2].abs(), "{force}");
        let scale = contact.force[2].abs() * BORE;
        assert!((moment - contact.moment[i]).abs() <= 1e-6 * scale, "{moment} {contact:?}");
    }
}

/// A solid a million times stiffer, in a seat a hundred times stiffer: the race stands where a fixed bore holds it.
#[test]
fn a_stiff_solid_is_a_fixed_bore() {
    let mut housing = ring(1e6 * YOUNG, |_| {}, 1e5, 1e-3);
    let problem = mounted(400.0);
    let assembly = settled(&mut housing, &problem, 1e-6);
    let fixed = DynamicProblem { outer: None, ..problem }.assembly();
    let options = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let mut seated = Simulation::new(assembly.clone(), options).unwrap();
    let mut alone = Simulation::new(fixed, options).unwrap();
    // Struck alike.
    for simulation in [&mut seated, &mut alone] {
        let at = simulation.system.places.body(0);
        simulation.state[at + VELOCITY + 2] += 5e-3;
        let (time, state) = (simulation.time, simulation.state.clone());
        let assembly = simulation.system.assembly.clone();
        *simulation = Simulation::from_state(assembly, options, state, time).unwrap();
    }
    let first = alone.state[alone.system.places.body(0) + 2];
    let (mut apart, mut swing) = (0.0f64, 0.0f64);
    for time in (1..=40).map(|i| 5e-6 * f64::from(i)) {
        let [a, b] = [&mut seated, &mut alone].map(|simulation| {
            while simulation.time < time {
                let left = time - simulation.time;
                simulation.step_by(simulation.step_size.min(left)).unwrap();
            }
            simulation.state[simulation.system.places.body(0) + 2]
        });
        apart = if (a - b).abs() <= apart { apart } else { (a - b).abs() };
        swing = swing.max((b - first).abs());
    }
    println!("apart {apart:.2e} of a swing of {swing:.2e}");
    // The penalty of the seat is left: 400 N over 5.6e11 N/m and more of the blow, 1e-9 m.
    assert!(apart <= 0.01 * swing, "{apart:e} of {swing:e}");
}

/// A shape alone under a constant force from rest: (f/ω²)(1 − e^(−αt/2)(cos νt + α/2ν sin νt)), ν² = ω² − α²/4.
#[test]
fn one_shape_under_a_constant_force_swings_as_it_must() {
    let (frequency, damping, force) = (4e4, 6e3, 3.0);
    let problem = DynamicProblem { outer: None, ..mounted(400.0) };
    let mut assembly = problem.assembly();
    assembly.solids.push(ReducedSolid {
        name: "an oscillator".into(),
        frequencies: vec![frequency],
        damping,
        weight: vec![force],
        loads: Vec::new(),
        surfaces: Vec::new(),
        start: vec![0.0],
    });
    let end: f64 = 2e-4;
    let nu = (frequency * frequency - 0.25 * damping * damping).sqrt();
    let fading = libm::exp(-0.5 * damping * end);
    let exact = force / (frequency * frequency)
        * (1.0 - fading * ((nu * end).cos() + 0.5 * damping / nu * (nu * end).sin()));
    let run = |integrator, step: f64| {
        let steps = (end / step).round() as usize;
        let options =
            RunOptions { start: Start::Equilibrium, ..options(integrator, Stepping::Fixed(step)) };
        let mut simulation = Simulation::new(assembly.clone(), options).unwrap();
        (0..steps).for_each(|_| simulation.step().unwrap());
        (simulation.state[simulation.system.solids[0]] - exact).abs()
            / (force / (frequency * frequency))
    };
    // Errors fall with the order of each.
    for (integrator, order) in
        [(Integrator::RungeKutta, 4), (Integrator::DormandPrince, 5), (Integrator::Rosenbrock, 3)]
    {
        let [coarse, fine] = [1e-6, 5e-7].map(|step| run(integrator, step));
        println!("{}: {coarse:.1e} {fine:.1e}", integrator.name());
        assert!(coarse <= 1e-3, "{coarse:e}");
        assert!(fine <= coarse / f64::from(1 << order) * 1.6 + 1e-12, "{coarse:e} {fine:e}");
    }
}

/// Everything stays where the equilibrium of bearing and shapes puts it.
#[test]
fn it_starts_in_equilibrium() {
    let mut housing = ring(YOUNG, |model| model.problem.gravity = [0.0, 0.0, -9.81], 60e3, 1e-2);
    let problem = DynamicProblem { gravity: [0.0, 0.0, -9.81], ..mounted(400.0) };
    let assembly = settled(&mut housing, &problem, 0.5e-6);
    let options = options(Integrator::DormandPrince, Stepping::Accuracy(1e-4));
    let mut simulation = Simulation::new(assembly, options).unwrap();
    let at = simulation.system.places.body(OUTER);
    let first = simulation.state.clone();
    let gone = |state: &[f64]| {
        first[at + 1].hypot(first[at + 2]).max((state[at + 2] - first[at + 2]).abs())
    };
    assert!(gone(&first) > 1e-9, "the race has sunk into its bore");
    while simulation.time < 1e-4 {
        simulation.step().unwrap();
        let now = &simulation.state;
        let away = (now[at + 1] - first[at + 1]).hypot(now[at + 2] - first[at + 2]);
        // What fixed normals leave out, and steps: their accuracy is of overlaps of micrometres.
        assert!(away <= 5e-3 * gone(&first), "{away:e} of {:e}", gone(&first));
    }
}

#[test]
fn a_race_beside_its_seat_and_a_shape_that_is_no_number_end_the_run() {
    let mut housing = plain();
    let assembly = settled(&mut housing, &mounted(400.0), 0.5e-6);
    let options = options(Integrator::RungeKutta, Stepping::Fixed(1e-8));
    let mut beside = assembly.clone();
    beside.seats[0].nominal[0] = 2.0 * beside.seats[0].rim;
    let error = Simulation::new(beside, options).err().expect("refused");
    assert!(matches!(error, SimulationError::LeftSeat { way: "along the axis", .. }), "{error}");
    assert!(error.to_string().contains("the outer race has left its bore"), "{error}");
    let leaning = |tilt: f64| {
        let mut leaning = assembly.clone();
        leaning.seats[0].axis = [libm::cos(tilt), libm::sin(tilt), 0.0];
        Simulation::new(leaning, options)
    };
    let error = leaning(0.11).err().expect("refused");
    let SimulationError::TiltedInSeat { tilt, allowed, time, .. } = error else {
        panic!("{error}")
    };
    // The race itself stands by some 1e-6 rad off.
    assert!((tilt - 0.11).abs() <= 1e-4 && allowed == 0.1 && time == 0.0, "{error}");
    assert!(
        error.to_string().contains("the outer race has tilted by 1.100e-1 rad in its bore"),
        "{error}"
    );
    assert!(leaning(-0.09).is_ok());
    let mut lost = assembly;
    lost.solids[0].start[0] = f64::NAN;
    let error = Simulation::new(lost, options).err().expect("refused");
    assert!(error.to_string().contains("not finite"), "{error}");
}

/// A natural shape that is left out follows by its compliance alone; at a frequency it would swing by 1/(1 − (f/f₁)²) of
/// that. What no shape has at all is another part.
#[test]
fn what_is_left_out_swings_by_its_own_compliance() {
    let shape = CutOff {
        natural: 3,
        patterns: 5,
        own: 0,
        modes_to: 900.0,
        lowest: 300.0,
        first_left_out: 1000.0,
        highest: 1e5,
        static_left_out: 1e-6,
        by_patterns: 0.02,
        nodes: 72,
    };
    for frequency in [1.0, 100.0, 500.0] {
        let (k, m) = (1.0, 1.0 / (TAU * shape.first_left_out).powi(2));
        let w = TAU * frequency;
        let grown = 1.0 / (k - m * w * w) - 1.0 / k;
        let found = shape.dynamic_error(frequency);
        // Rounding of a difference of a millionth.
        assert!((found / (shape.by_patterns * grown) - 1.0).abs() <= 1e-9, "{frequency}: {found}");
    }
}
