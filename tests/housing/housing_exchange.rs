//! Bearing and housing in explicit steps that exchange impulses: momentum, energy, the balance that
//! they settle in, and what is refused.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::OUTER;
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, Penalty, contact_nodes};
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::{Drive, DrivenBody, Rotation};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::state::{POSITION, SPIN, VELOCITY};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
use bearing_dynamics::motion::coupling::{
    CoupledMotion, CouplingError, CouplingOptions, SolidPart,
};
use bearing_dynamics::motion::race_in_bore::{Seat, SeatState};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::contact::{CylinderContact, CylinderPath};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium_in_contact};
use bearing_dynamics::solids::model::{DampedMotion, Prescribed, SolidModel, SolidProblem};
use common::table_4_1;
use dynamics::*;
use nalgebra::Vector3;

/// Outside of the outer race in Table 2.2: raceway 31.953 mm, 3.574 mm thick; 20 mm deep.
pub const RADIUS: f64 = 35.527e-3;
pub const WIDTH: f64 = 20e-3;
pub const WALL: f64 = 15e-3;

/// A ring around the race, as wide as the race, its outside held or free.
pub fn housing(held: bool, damping: f64) -> (SolidModel, Vec<ContactNode>) {
    let shape = Ring { inner_radius: RADIUS, outer_radius: RADIUS + WALL, width: WIDTH };
    let cells = RingMesh { around: 32, radial: 3, axial: 3, radial_growth: 1.3 };
    let mesh = ring(&shape, &cells).unwrap().mesh;
    let nodes = contact_nodes(&mesh, &mesh.surface_sets["inner"]);
    let mut prescribed = Vec::new();
    if held {
        for &node in &mesh.node_sets["outer"] {
            for axis in 0..3 {
                prescribed.push(Prescribed { node, axis, profile: Profile::ZERO });
            }
        }
    }
    let problem = SolidProblem {
        nodes: mesh.nodes,
        elements: mesh.elements,
        material: LinearElastic::new(2.1e11, 0.3).unwrap(),
        density: 7850.0,
        damping,
        damped_motion: DampedMotion::Absolute,
        prescribed,
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    (SolidModel::new(problem).unwrap(), nodes)
}

/// The outer race as a body that does not turn about its axis.
pub fn outer_race() -> DrivenBody {
    DrivenBody {
        inertia: inertia::hollow_cylinder(32e-3, RADIUS, WIDTH, 7850.0),
        ..race([0.0; 5], Rotation::Speed(Profile::ZERO))
    }
}

/// Table 2.2's bearing with a little interference between balls and races.
pub fn mounted(loads: [f64; 5]) -> DynamicProblem {
    DynamicProblem { outer: Some(outer_race()), ..bearing(table_4_1(-5e-6), loads, 0.0) }
}

pub fn seat(nodes: Vec<ContactNode>, reach: f64) -> Seat {
    Seat {
        name: None,
        mount: Mount::at_centre(OUTER),
        solid: 0,
        radius: Profile::Constant(RADIUS),
        width: WIDTH,
        penalty: Penalty::default(),
        friction: None,
        nodes,
        reach,
    }
}

pub fn rated(solid_fraction: f64, seat_phase: f64, step: f64) -> CouplingOptions {
    let bearing = RunOptions {
        integrator: Integrator::RungeKutta,
        stepping: Stepping::Fixed(step),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    };
    CouplingOptions { solid_fraction, seat_phase, bearing }
}

pub fn options() -> CouplingOptions {
    rated(0.8, 0.25, 2e-6)
}

pub fn joined(
    problem: DynamicProblem,
    model: SolidModel,
    seat: Seat,
    options: &CouplingOptions,
) -> Result<CoupledMotion<'static>, CouplingError> {
    CoupledMotion::new(problem, vec![SolidPart::undeformed(None, model)], vec![seat], options)
}

pub fn only<'h>(housed: &'h CoupledMotion<'_>) -> &'h SeatState {
    &housed.solids[0].seats[0]
}

pub fn start(
    problem: DynamicProblem,
    held: bool,
    damping: f64,
    reach: f64,
) -> CoupledMotion<'static> {
    start_with(problem, held, damping, reach, &options())
}

fn start_with(
    problem: DynamicProblem,
    held: bool,
    damping: f64,
    reach: f64,
    options: &CouplingOptions,
) -> CoupledMotion<'static> {
    let (model, nodes) = housing(held, damping);
    joined(problem, model, seat(nodes, reach), options).unwrap()
}

pub fn total_momentum(housed: &mut CoupledMotion) -> Vector3<f64> {
    let bearing = momenta(housed.simulation.system.assembly.clone(), &housed.simulation.state).0;
    // Between kicks the rates of central differences are those of the bearing's time.
    let mut sum = bearing;
    for (rate, mass) in
        housed.solids[0].solid.rates().iter().zip(&housed.solids[0].solid.model.mass)
    {
        sum += Vector3::new(rate[0], rate[1], rate[2]) * *mass;
    }
    sum
}

#[test]
fn what_the_housing_gets_the_race_gets() {
    // Nothing is held: a bearing that flies against a free ring.
    let mut housed = start(mounted([0.0; 5]), false, 0.0, f64::INFINITY);
    let layout = housed.simulation.system.sets[0].layout;
    for i in 0..layout.balls {
        housed.simulation.state[layout.ball(VELOCITY + 2) + i] += 0.05;
    }
    for at in [layout.inner(), layout.outer()] {
        housed.simulation.state[at + VELOCITY + 2] += 0.05;
        housed.simulation.state[at + VELOCITY + 1] += 0.02;
    }
    let before = total_momentum(&mut housed);
    let mut largest = 0.0f64;
    for _ in 0..4000 {
        housed.advance().unwrap();
        let error = (total_momentum(&mut housed) - before).norm() / before.norm();
        largest = if error <= largest { largest } else { error };
    }
    assert!(Vector3::from(only(&housed).impulse).norm() > 0.1 * before.norm(), "they have met");
    println!("momentum {largest:.1e}");
    assert!(largest <= 1e-9, "{largest:e}");
}

/// Of races, balls and housing about the origin, a point that stands still.
pub fn total_angular_momentum(housed: &CoupledMotion) -> Vector3<f64> {
    let mut sum = momenta(housed.simulation.system.assembly.clone(), &housed.simulation.state).1;
    // Places half a step ahead of the rates: along them, which is no lever.
    let model = &housed.solids[0].solid.model;
    let places = model.problem.nodes.iter().zip(&housed.solids[0].solid.displacement);
    for ((rate, mass), (place, u)) in
        housed.solids[0].solid.rates().iter().zip(&model.mass).zip(places)
    {
        let place = Vector3::new(place[0] + u[0], place[1] + u[1], place[2] + u[2]);
        sum += place.cross(&Vector3::new(rate[0], rate[1], rate[2])) * *mass;
    }
    sum
}

#[test]
fn a_tilting_race_turns_the_housing_as_much_as_it_is_held_back() {
    // Nothing is held: the outer race tilts and flies against a free ring.
    let mut housed = start(mounted([0.0; 5]), false, 0.0, f64::INFINITY);
    let at = housed.simulation.system.sets[0].layout.outer();
    for (entry, value) in
        [(VELOCITY + 2, 0.05), (VELOCITY + 1, -0.03), (SPIN + 1, 2.0), (SPIN + 2, 1.0)]
    {
        housed.simulation.state[at + entry] = value;
    }
    let of_races = |housed: &CoupledMotion| {
        momenta(housed.simulation.system.assembly.clone(), &housed.simulation.state).1
    };
    let (before, races_before) = (total_angular_momentum(&housed), of_races(&housed));
    let (mut largest, mut handed) = (0.0f64, 0.0f64);
    for _ in 0..1000 {
        housed.advance().unwrap();
        let change = total_angular_momentum(&housed) - before;
        // About its own axis the race is kept from turning by what holds it there.
        let error = change.y.hypot(change.z) / before.norm();
        largest = if error <= largest { largest } else { error };
        handed = handed.max((of_races(&housed) - races_before).norm());
    }
    println!("angular momentum {largest:.1e}, handed over {:.2}", handed / before.norm());
    assert!(handed > 0.2 * before.norm(), "the housing has turned");
    assert!(largest <= 1e-9, "{largest:e}");
}

/// A blow of ten times the load, 1 ms long.
pub fn blow(problem: DynamicProblem) -> DynamicProblem {
    let mut struck = problem;
    struck.inner.drives[2] =
        Drive::Load(Profile::HalfSine { base: -250.0, peak: -2500.0, start: 1e-4, duration: 1e-3 });
    struck
}

#[test]
fn the_energy_of_a_blow_balances() {
    // One step of the housing a coupling step, and five; the bearing's own steps longer and shorter.
    let rates = [(0.0, 0.8, 0.25, 2e-6), (77.0, 0.1, 0.5, 2e-6), (77.0, 0.8, 0.25, 3e-8)];
    for (damping, solid_fraction, seat_phase, step) in rates {
        let options = rated(solid_fraction, seat_phase, step);
        let mut housed =
            start_with(blow(mounted([0.0; 5])), true, damping, f64::INFINITY, &options);
        assert_eq!(housed.solids[0].steps, if solid_fraction == 0.1 { 5 } else { 1 });
        let mut worst = 0.0f64;
        while housed.time() < 1.5e-3 {
            for _ in 0..50 {
                housed.advance().unwrap();
            }
            let snapshot = housed.snapshot().unwrap();
            let part = snapshot.residual.abs() / snapshot.turned_over;
            worst = if part <= worst { worst } else { part };
        }
        let parts = (housed.coupling_step / step * (1.0 - 1e-9)).ceil().max(1.0) as u64;
        assert_eq!(housed.simulation.steps, parts * housed.exchanges);
        println!("damping {damping}: {worst:.1e}");
        // Measured: 7e-6, 1.6e-5, 1.2e-5, and growing with the square of the coupling step.
        assert!(worst <= 5e-5, "{worst:e}");
    }
}

/// At the start there is nothing but what balls and races were pressed together with, by Hertz.
#[test]
fn what_is_turned_over_at_the_start_is_the_preload() {
    let mut housed = start(mounted([0.0; 5]), true, 0.0, f64::INFINITY);
    let snapshot = housed.snapshot().unwrap();
    let problem = &housed.simulation.system.assembly.bearings[0];
    let [inner, outer] = [problem.inner_contact.stiffness, problem.outer_contact.stiffness];
    // One load: overlaps as stiffness to the power −2/3, 5 µm in sum on either side of a ball.
    let shares = [inner, outer].map(|k: f64| k.powf(-2.0 / 3.0));
    let energy: f64 = [inner, outer]
        .iter()
        .zip(shares)
        .map(|(k, share)| 0.4 * k * (5e-6 * share / (shares[0] + shares[1])).powf(2.5))
        .sum();
    let preload = 8.0 * energy;
    // Rounding of the equilibrium, and grooves a little out of the meridian planes.
    let part = snapshot.turned_over / preload;
    assert!((part - 1.0).abs() <= 1e-3, "{part}");
    assert!(snapshot.residual.abs() <= 1e-12 * preload, "{:e}", snapshot.residual);
}

/// Halve the coupling step, and a quarter of the energy is unaccounted for: both are balanced at one time.
#[test]
fn the_balance_is_of_second_order() {
    let worst = |seat_phase: f64| {
        let options = rated(0.8, seat_phase, 2e-6);
        let task = blow(mounted([0.0; 5]));
        let mut housed = start_with(task, true, 0.0, f64::INFINITY, &options);
        assert_eq!(housed.solids[0].steps, 1);
        let mut worst = 0.0f64;
        while housed.time() < 4e-4 {
            housed.advance().unwrap();
            let residual = housed.snapshot().unwrap().residual.abs();
            worst = if residual <= worst { worst } else { residual };
        }
        worst
    };
    let (long, short) = (worst(0.25), worst(0.125));
    println!("{long:.2e} {short:.2e} {:.2}", long / short);
    assert!((long / short - 4.0).abs() <= 1.0, "{long:e} {short:e}");
}

#[test]
fn it_settles_where_the_forces_balance() {
    let load = 1000.0;
    let mut task = DynamicProblem {
        damping: ContactDamping::HuntCrossley { alpha: 2.0 },
        ..mounted([0.0; 5])
    };
    task.inner.drives[2] =
        Drive::Load(Profile::SmoothRamp { from: 0.0, to: -load, start: 0.0, duration: 2e-3 });
    let mut housed = start(task, true, 4000.0, f64::INFINITY);
    while housed.time() < 8e-3 {
        housed.advance().unwrap();
    }
    let contact = housed.snapshot().unwrap().solids[0].seats[0].contact;
    assert!((contact.force[2] / load - 1.0).abs() <= 1e-3, "{:?}", contact);
    // The housing by Newton's method, pressed by the race where it has settled.
    let race = housed.simulation.body(OUTER);
    let (model, nodes) = housing(true, 0.0);
    let pressed = CylinderContact {
        path: CylinderPath {
            start: Pose { position: Vector3::zeros(), orientation: race.orientation },
            displacement: race.position.map(Profile::Constant),
            radius: Profile::Constant(RADIUS),
        },
        width: 1.002 * WIDTH,
        penalty: Penalty::default(),
        nodes,
    };
    let options = EquilibriumOptions::default();
    let still = equilibrium_in_contact(&model, 0.0, &pressed, None, &options).unwrap();
    assert_eq!(still.sum.touching, contact.touching);
    let force = still.sum.force[2];
    assert!((contact.force[2] / force - 1.0).abs() <= 1e-3, "{force}");
    let lowest = |list: &[[f64; 3]]| list.iter().map(|u| u[2]).fold(0.0, f64::min);
    let moving: Vec<[f64; 3]> =
        housed.solids[0].solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
    let part = lowest(&moving) / lowest(&still.solid.displacement);
    assert!((part - 1.0).abs() <= 2e-3, "{part}");
}

#[test]
fn a_contact_a_thousand_times_as_stiff_takes_shorter_windows_and_balances() {
    let run = |factor: f64, end: f64| {
        let (model, nodes) = housing(true, 77.0);
        let Penalty::PerArea(stiffness) = Penalty::default() else { panic!("by area") };
        let seat =
            Seat { penalty: Penalty::PerArea(factor * stiffness), ..seat(nodes, f64::INFINITY) };
        let mut struck = blow(mounted([0.0; 5]));
        struck.inner.drives[2] = Drive::Load(Profile::Constant(-2500.0));
        let mut housed = joined(struck, model, seat, &options()).unwrap();
        let mut worst = 0.0f64;
        while housed.time() < end {
            for _ in 0..500 {
                housed.advance().unwrap();
            }
            let snapshot = housed.snapshot().unwrap();
            let part = snapshot.residual.abs() / snapshot.turned_over;
            worst = if part <= worst { worst } else { part };
        }
        (housed, worst)
    };
    // The load starts at once: the first contacts of the race with its bore.
    let (soft, _) = run(1.0, 5e-5);
    let (hard, worst) = run(1000.0, 5e-5);
    let shorter = soft.coupling_step / hard.coupling_step;
    assert!((shorter / 1000f64.sqrt() - 1.0).abs() <= 0.01, "{shorter}");
    assert!(
        only(&hard).contact.touching > 0
            && only(&hard).contact.deepest < 0.1 * only(&soft).contact.deepest
    );
    println!("residual {worst:.1e}");
    assert!(worst <= 1e-4, "{worst:e}");
}

/// Where both races turn alike, all turns as one.
#[test]
fn balls_start_rolling_with_a_race_that_turns_in_its_bore() {
    let speed = 100.0;
    let mut problem = mounted([0.0; 5]);
    let outer = problem.outer.as_mut().expect("the outer race moves");
    for race in [&mut problem.inner, outer] {
        race.rotation = Rotation::Speed(Profile::Constant(speed));
    }
    let housed = start(problem, true, 0.0, f64::INFINITY);
    let layout = housed.simulation.system.sets[0].layout;
    let state = &housed.simulation.state;
    for ball in 0..layout.balls {
        let [_, y, z] = layout.ball_vector(state, POSITION, ball);
        let [_, v_y, v_z] = layout.ball_vector(state, VELOCITY, ball);
        let orbital = (y * v_z - z * v_y) / (y * y + z * z);
        // Places of the balls in an equilibrium without loads: 1e-9 of their radius.
        assert!((orbital / speed - 1.0).abs() <= 1e-8, "ball {ball}: {orbital}");
    }
}

#[test]
fn what_cannot_be_run_is_refused_by_name() {
    let (model, nodes) = housing(true, 0.0);
    let try_with = |problem: DynamicProblem, nodes: &[ContactNode], options: CouplingOptions| {
        let seat = seat(nodes.to_vec(), f64::INFINITY);
        joined(problem, model.clone(), seat, &options).err().expect("an error")
    };
    let fixed = bearing(table_4_1(-5e-6), [0.0; 5], 0.0);
    let race = "the outer race".to_string();
    assert_eq!(try_with(fixed, &nodes, options()), CouplingError::FixedRace { race: race.clone() });
    let mut sprung = mounted([0.0; 5]);
    sprung.outer.as_mut().unwrap().foundation_damping[2] = 1.0;
    assert_eq!(try_with(sprung, &nodes, options()), CouplingError::Foundation { race });
    assert_eq!(
        try_with(mounted([0.0; 5]), &[], options()),
        CouplingError::NoSeat { seat: String::new() }
    );
    for phase in [0.0, 2.0, f64::NAN] {
        let refused = try_with(mounted([0.0; 5]), &nodes, rated(0.8, phase, 2e-6));
        assert!(matches!(refused, CouplingError::Option { .. }), "{refused}");
    }
}
