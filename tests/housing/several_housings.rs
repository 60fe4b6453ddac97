//! A shaft on two bearings in two housings, all in explicit steps: momentum and energy over the coupling steps, mirrored
//! halves, the order of lists, where it settles, and what a housing comes to that is as good as rigid.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bore_contact::{
    ContactNode, ContactSum, Penalty, STEEL_NODE_STIFFNESS, contact_nodes,
};
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::bearing::Bearing;
use bearing_dynamics::members::body::{Body, Drive, DrivenBody, Mobility, Rotation};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::state::{BODY, BodyState, SPIN, VELOCITY};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
use bearing_dynamics::mesh::tet_mesh::Elements;
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingOptions, SolidPart};
use bearing_dynamics::motion::race_in_bore::{Seat, SeatState};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::contact::{CylinderContact, CylinderPath};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium_in_contact};
use bearing_dynamics::solids::model::{DampedMotion, Prescribed, SolidModel, SolidProblem};
use common::table_4_1;
use dynamics::*;
use nalgebra::Vector3;

/// Outside of Table 2.2's outer race, its width, and how far the bearings are off the middle of the shaft.
const RADIUS: f64 = 35.527e-3;
const WIDTH: f64 = 20e-3;
const HALF: f64 = 40e-3;
const SHAFT: usize = 0;

/// A ring round a race.
#[derive(Clone, Copy)]
pub struct Housing {
    pub name: &'static str,
    /// Of its middle along X, m.
    pub at: f64,
    pub wall: f64,
    pub held: bool,
    pub damping: f64,
    /// Modulus, density and stiffness of the contact as multiples of steel's.
    pub times: [f64; 3],
    pub around: usize,
}

pub fn left(held: bool) -> Housing {
    // Hard rubber, so that housings give way by as much as bearings do.
    let (wall, damping, times, around) = (15e-3, 0.0, [1e-3, 1.0, 1e-3], 16);
    Housing { name: "left", at: -HALF, wall, held, damping, times, around }
}

pub fn right(held: bool) -> Housing {
    Housing { name: "right", at: HALF, ..left(held) }
}

/// Its model and the nodes of its bore. To the right of the middle the mesh is the mirror image of that to the left.
fn made(housing: &Housing) -> (SolidModel, Vec<ContactNode>) {
    let shape = Ring { inner_radius: RADIUS, outer_radius: RADIUS + housing.wall, width: WIDTH };
    let cells = RingMesh { around: housing.around, radial: 2, axial: 2, radial_growth: 1.3 };
    let mesh = ring(&shape, &cells).unwrap().mesh;
    let mirror = if housing.at > 0.0 { -1.0 } else { 1.0 };
    let place = |[x, y, z]: [f64; 3]| [housing.at + mirror * x, y, z];
    let bore = contact_nodes(&mesh, &mesh.surface_sets["inner"]);
    let bore = bore.into_iter().map(|node| ContactNode { place: place(node.place), ..node });
    let Elements::Linear(elements) = mesh.elements else { panic!("linear") };
    let turned = |[a, b, c, d]: [u32; 4]| if mirror < 0.0 { [b, a, c, d] } else { [a, b, c, d] };
    let profile = Profile::ZERO;
    let held =
        |&node: &u32| [0, 1, 2].map(|axis| Prescribed { node, axis, profile: profile.clone() });
    let outer = mesh.node_sets["outer"].iter().filter(|_| housing.held);
    let problem = SolidProblem {
        nodes: mesh.nodes.iter().map(|node| place(*node)).collect(),
        elements: Elements::Linear(elements.into_iter().map(turned).collect()),
        material: LinearElastic::new(housing.times[0] * 2.1e11, 0.3).unwrap(),
        density: housing.times[1] * 7850.0,
        damping: housing.damping,
        damped_motion: DampedMotion::Absolute,
        prescribed: outer.flat_map(held).collect(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    (SolidModel::new(problem).unwrap(), bore.collect())
}

/// The race on a body at a mount, in the bore of a housing.
pub fn fitted(housing: &Housing, solid: usize, mount: Mount) -> (SolidPart, Seat) {
    let (model, nodes) = made(housing);
    let Penalty::PerArea(steel) = Penalty::default() else { panic!("by area") };
    let seat = Seat {
        name: Some(housing.name.into()),
        mount,
        solid,
        radius: Profile::Constant(RADIUS),
        width: WIDTH,
        penalty: Penalty::PerArea(housing.times[2] * steel),
        friction: None,
        nodes,
        reach: f64::INFINITY,
    };
    (SolidPart::undeformed(Some(housing.name.into()), model), seat)
}

pub fn body(name: &str, mobility: Mobility, x: f64) -> Body {
    Body {
        name: name.into(),
        label: None,
        mobility,
        rest: [x, 0.0, 0.0, 0.0, 0.0],
        rotating_load: None,
        unbalance: 0.0,
    }
}

pub fn shaft() -> DrivenBody {
    DrivenBody {
        inertia: inertia::hollow_cylinder(0.0, 15e-3, 120e-3, 7850.0),
        ..race([0.0; 5], Rotation::Speed(Profile::Constant(100.0)))
    }
}

fn outer_race() -> DrivenBody {
    DrivenBody {
        inertia: inertia::hollow_cylinder(32e-3, RADIUS, WIDTH, 7850.0),
        ..race([0.0; 5], Rotation::Speed(Profile::ZERO))
    }
}

/// A shaft on two bearings with a little interference between balls and races; body 1 is the left outer race,
/// body 2 the right one.
pub fn on_two(shaft: DrivenBody, damping: ContactDamping) -> Assembly {
    let race = |name: &str, x| body(name, Mobility::Driven(outer_race().into()), x);
    let template = bearing(table_4_1(-5e-6), [0.0; 5], 0.0).assembly().bearings.remove(0);
    let seated = |name: &str, along: f64, outer: usize| Bearing {
        name: Some(name.into()),
        mounts: [Mount { along, ..Mount::at_centre(SHAFT) }, Mount::at_centre(outer)],
        damping,
        ..template.clone()
    };
    Assembly {
        bodies: vec![
            body("the shaft", Mobility::Driven(shaft.into()), 0.0),
            race("the left outer race", -HALF),
            race("the right outer race", HALF),
        ],
        bearings: vec![seated("left", -HALF, 1), seated("right", HALF, 2)],
        ..Assembly::default()
    }
}

pub fn options(solid_fraction: f64, seat_phase: f64) -> CouplingOptions {
    let bearing = RunOptions {
        integrator: Integrator::RungeKutta,
        stepping: Stepping::Fixed(2e-6),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    };
    CouplingOptions { solid_fraction, seat_phase, bearing }
}

/// The two outer races in these housings.
pub fn housed(
    assembly: Assembly,
    housings: [Housing; 2],
    options: &CouplingOptions,
) -> CoupledMotion<'static> {
    let (solids, seats) = [0, 1]
        .map(|index| fitted(&housings[index], index, Mount::at_centre(1 + index)))
        .into_iter()
        .unzip();
    CoupledMotion::new(assembly, solids, seats, options).unwrap()
}

/// A blow of 2 kN against the shaft, 1 ms long, `off` its middle (m).
pub fn struck(off: f64) -> DrivenBody {
    let blow = |peak| Profile::HalfSine { base: 0.0, peak, start: 1e-5, duration: 1e-3 };
    let mut struck = shaft();
    struck.drives[2] = Drive::Load(blow(-2000.0));
    // A force along −Z to the right of the middle turns +X down: about +Y.
    struck.drives[3] = Drive::Load(blow(2000.0 * off));
    struck
}

/// Everything in storey 1 but what stands still from then on has this velocity more, m/s.
fn throw(housed: &mut CoupledMotion, velocity: [f64; 3]) {
    let bodies = housed.simulation.system.assembly.bodies.len();
    for (axis, speed) in velocity.into_iter().enumerate() {
        for body in 0..bodies {
            let at = housed.simulation.system.places.body(body);
            housed.simulation.state[at + VELOCITY + axis] += speed;
        }
        for set in 0..housed.simulation.system.sets.len() {
            let layout = housed.simulation.system.sets[set].layout;
            for ball in 0..layout.balls {
                housed.simulation.state[layout.ball(VELOCITY + axis) + ball] += speed;
            }
        }
    }
}

/// Momentum and angular momentum about the origin. Places of nodes are half a step ahead of the rates: along
/// them, which is no lever.
fn total(housed: &CoupledMotion) -> [Vector3<f64>; 2] {
    let simulation = &housed.simulation;
    let (mut momentum, mut angular) =
        momenta(simulation.system.assembly.clone(), &simulation.state);
    for part in &housed.solids {
        let model = &part.solid.model;
        let places = model.problem.nodes.iter().zip(&part.solid.displacement);
        for ((rate, mass), (place, u)) in part.solid.rates().iter().zip(&model.mass).zip(places) {
            let place = Vector3::new(place[0] + u[0], place[1] + u[1], place[2] + u[2]);
            let of_node = Vector3::new(rate[0], rate[1], rate[2]) * *mass;
            momentum += of_node;
            angular += place.cross(&of_node);
        }
    }
    [momentum, angular]
}

fn worst(so_far: f64, error: f64) -> f64 {
    // Not a number must not pass.
    if error <= so_far { so_far } else { error }
}

/// A shaft with its bearings flies against two housings that are held outside: what it loses, the supports get.
#[test]
fn shaft_housings_and_supports_keep_the_momentum() {
    let housings = [left(true), Housing { wall: 8e-3, ..right(true) }];
    let mut housed = housed(on_two(shaft(), ContactDamping::None), housings, &options(0.8, 0.1));
    throw(&mut housed, [0.0, 0.02, -0.05]);
    let [before, _] = total(&housed);
    let mut supports = Vector3::zeros();
    let mut largest = 0.0f64;
    for _ in 0..3000 {
        housed.advance().unwrap();
        for part in &housed.solids {
            // Whatever a coupling step has in it, the forces of its one step are those that were last evaluated.
            assert_eq!(part.steps, 1);
            for held in &part.solid.model.problem.prescribed {
                let force = part.solid.forces()[held.node as usize][held.axis];
                supports[held.axis] -= part.solid.step_size * force;
            }
        }
        let [now, _] = total(&housed);
        largest = worst(largest, (now - supports - before).norm() / before.norm());
    }
    println!(
        "momentum {largest:.1e}, of it to the supports {:.2}",
        supports.norm() / before.norm()
    );
    assert!(supports.norm() > 0.1 * before.norm(), "nothing has come to the supports");
    assert!(housed.seats().all(|seat| Vector3::from(seat.impulse).norm() > 0.05 * before.norm()));
    assert!(largest <= 1e-9, "{largest:e}");
}

/// Races at the ends of a shaft, one put on the other way round, in two free rings.
fn in_two_bores(options: &CouplingOptions) -> CoupledMotion<'static> {
    let assembly = Assembly {
        bodies: vec![body("the shaft", Mobility::Driven(free_race().into()), 0.0)],
        ..Assembly::default()
    };
    let housings = [left(false), Housing { around: 40, wall: 6e-3, ..right(false) }];
    let mounts = [
        Mount { along: -HALF, ..Mount::at_centre(SHAFT) },
        Mount { along: HALF, reversed: true, ..Mount::at_centre(SHAFT) },
    ];
    let (solids, seats) =
        [0, 1].map(|index| fitted(&housings[index], index, mounts[index])).into_iter().unzip();
    let mut housed = CoupledMotion::new(assembly, solids, seats, options).unwrap();
    throw(&mut housed, [0.0, 0.01, -0.006]);
    let at = housed.simulation.system.places.body(SHAFT);
    (housed.simulation.state[at + SPIN + 1], housed.simulation.state[at + SPIN + 2]) = (0.3, 0.2);
    housed
}

/// Nothing is held; coupling steps have several steps, of the two housings not the same number. The shaft turns the
/// rings as much as they hold it back.
#[test]
fn a_shaft_in_two_bores_keeps_both_momenta() {
    let mut housed = in_two_bores(&options(0.02, 0.4));
    // Both seats together hold the body.
    let stiffness = housed.seats().map(|seat| {
        let area = |along: fn(f64) -> f64| -> f64 {
            seat.seat.nodes.iter().map(|node| along(node.place[0]) * node.area).sum()
        };
        let steel = 1e-3 * 1e6 * STEEL_NODE_STIFFNESS;
        [steel * area(|_| 1.0), steel * area(|x| x * x)]
    });
    let [shift, tilt] = stiffness.fold([0.0; 2], |sum, k| [sum[0] + k[0], sum[1] + k[1]]);
    let inertia = housed.simulation.system.assembly.bodies[SHAFT].inertia().unwrap();
    let longest = 0.4 / (shift / inertia.mass).max(tilt / inertia.transverse).sqrt();
    assert!(
        housed.coupling_step <= longest * (1.0 + 1e-12) && housed.coupling_step > 0.5 * longest
    );
    let steps = [housed.solids[0].steps, housed.solids[1].steps];
    assert!(steps[0] > 1 && steps[1] > steps[0], "{steps:?}");
    let before = total(&housed);
    let of_shaft = |housed: &CoupledMotion| {
        momenta(housed.simulation.system.assembly.clone(), &housed.simulation.state).1
    };
    let first = of_shaft(&housed);
    let mut largest = [0.0f64; 2];
    for _ in 0..1000 {
        housed.advance().unwrap();
        let now = total(&housed);
        for i in 0..2 {
            largest[i] = worst(largest[i], (now[i] - before[i]).norm() / before[i].norm());
        }
    }
    let handed = (of_shaft(&housed) - first).norm() / before[1].norm();
    println!("momenta {largest:?}, handed over {handed:.2}");
    assert!(handed > 0.1, "the rings have not turned");
    assert!(largest[0] <= 1e-12, "{largest:?}");
    // Of several steps each has the shaft a little farther, of which the mean load knows nothing.
    assert!(largest[1] <= 1e-9, "{largest:?}");
}

/// Halve the coupling step, and a quarter of the energy is unaccounted for: work is booked over the arms it acts on.
#[test]
fn the_balance_over_arms_is_of_second_order() {
    let worst_of = |phase: f64| {
        let mut housed = in_two_bores(&options(0.8, phase));
        let first = housed.snapshot().unwrap().residual;
        let (mut largest, mut turned_over) = (0.0f64, 0.0f64);
        while housed.time() < 2e-3 {
            housed.advance().unwrap();
            let snapshot = housed.snapshot().unwrap();
            largest = worst(largest, (snapshot.residual - first).abs());
            turned_over = turned_over.max(snapshot.turned_over);
        }
        largest / turned_over
    };
    let (long, short) = (worst_of(0.1), worst_of(0.05));
    println!("{long:.2e} {short:.2e} {:.2}", long / short);
    assert!((long / short - 4.0).abs() <= 1.0, "{long:e} {short:e}");
    assert!(short <= 1e-4, "{short:e}");
}

/// A blow off the middle; the shaft has a dashpot to the ground as well, whose loss lies in the same entry
/// of the bodies' ledger as the work of the seats. With one housing and with two.
#[test]
fn the_energy_of_a_blow_balances_beside_dashpots() {
    let mut braked = struck(10e-3);
    braked.foundation_damping = [0.0, 50.0, 50.0, 0.0, 0.0];
    let damped = |housing: Housing| Housing { damping: 77.0, ..housing };
    let thin = Housing { wall: 8e-3, ..right(true) };
    let both = housed(
        on_two(braked.clone(), ContactDamping::None),
        [damped(left(true)), damped(thin)],
        &options(0.8, 0.08),
    );
    let mut alone = on_two(braked, ContactDamping::None);
    alone.bodies[2].mobility = Mobility::Fixed;
    let (solid, seat) = fitted(&damped(left(true)), 0, Mount::at_centre(1));
    let one = CoupledMotion::new(alone, vec![solid], vec![seat], &options(0.8, 0.08)).unwrap();
    for mut housed in [both, one] {
        let mut largest = 0.0f64;
        while housed.time() < 1.5e-3 {
            for _ in 0..50 {
                housed.advance().unwrap();
            }
            let snapshot = housed.snapshot().unwrap();
            largest = worst(largest, snapshot.residual.abs() / snapshot.turned_over);
        }
        let snapshot = housed.snapshot().unwrap();
        let seats: Vec<f64> =
            snapshot.solids.iter().flat_map(|solid| &solid.seats).map(|seat| seat.work).collect();
        println!(
            "{} housings: {largest:.1e} of {:.2e} J, work {seats:?}",
            housed.solids.len(),
            snapshot.turned_over
        );
        assert!(largest <= 1e-4, "{largest:e}");
    }
}

/// Mirror images of each other stay that.
#[test]
fn symmetric_halves_move_alike() {
    let assembly = on_two(struck(0.0), ContactDamping::None);
    let mut housed = housed(assembly, [left(true), right(true)], &options(0.8, 0.25));
    while housed.time() < 1.2e-3 {
        housed.advance().unwrap();
    }
    let [one, other] = [1, 2].map(|race| housed.simulation.body(race).position);
    let size = one[2].abs();
    assert!(size > 1e-7, "{size:e}");
    let mirrored = [-other[0], other[1], other[2]];
    for i in 0..3 {
        assert!((one[i] - mirrored[i]).abs() <= 1e-9 * size, "{one:?} {other:?}");
    }
    let largest = |part: usize| {
        let moved = |u: &[f64; 4]| u[0].abs().max(u[1].abs()).max(u[2].abs());
        housed.solids[part].solid.displacement.iter().map(moved).fold(0.0, f64::max)
    };
    let size = largest(0);
    for (a, b) in
        housed.solids[0].solid.displacement.iter().zip(&housed.solids[1].solid.displacement)
    {
        for (a, b) in [(a[0], -b[0]), (a[1], b[1]), (a[2], b[2])] {
            assert!((a - b).abs() <= 1e-9 * size, "{a:e} {b:e} of {size:e}");
        }
    }
}

/// The order of the lists is that of the sums, and no more.
#[test]
fn the_order_of_the_housings_changes_nothing() {
    let housings = [left(true), Housing { around: 24, wall: 8e-3, ..right(true) }];
    let run = |order: [usize; 2]| {
        let (mut solids, mut seats) = (Vec::new(), Vec::new());
        for (place, index) in order.into_iter().enumerate() {
            let (solid, seat) = fitted(&housings[index], place, Mount::at_centre(1 + index));
            solids.push(solid);
            seats.push(seat);
        }
        seats.reverse();
        let assembly = on_two(struck(15e-3), ContactDamping::None);
        let mut housed = CoupledMotion::new(assembly, solids, seats, &options(0.02, 0.4)).unwrap();
        while housed.time() < 1e-3 {
            housed.advance().unwrap();
        }
        housed
    };
    let (mut one, mut other) = (run([0, 1]), run([1, 0]));
    assert!(one.solids[0].steps != one.solids[1].steps);
    assert_eq!(one.exchanges, other.exchanges);
    for race in [1, 2] {
        let [a, b] = [&one, &other].map(|housed| housed.simulation.body(race).position);
        for i in 0..3 {
            assert!((a[i] - b[i]).abs() <= 1e-9 * a[2].abs(), "{a:?} {b:?}");
        }
    }
    let (one, other) = (one.snapshot().unwrap(), other.snapshot().unwrap());
    for [a, b] in [[0, 1], [1, 0]] {
        let (a, b) = (&one.solids[a], &other.solids[b]);
        let [a, b] = [a, b].map(|solid| [solid.ledger.energy.strain, solid.seats[0].work]);
        for i in 0..2 {
            assert!((a[i] / b[i] - 1.0).abs() <= 1e-9, "{a:?} {b:?}");
        }
    }
}

/// A housing a thousand times as stiff and as heavy as steel, in which only the seat's own springs give way,
/// against a race that is fixed.
#[test]
fn a_stiff_housing_is_a_fixed_race() {
    let damping = ContactDamping::HuntCrossley { alpha: 2.0 };
    let start = |fixed: bool| {
        let mut assembly = on_two(struck(10e-3), damping);
        let mut parts = vec![fitted(&left(true), 0, Mount::at_centre(1))];
        if fixed {
            assembly.bodies[2].mobility = Mobility::Fixed;
        } else {
            // No bore holds a race along its axis.
            let race = assembly.bodies[2].driven_mut().unwrap();
            race.drives[0] = Drive::Motion(Profile::Constant(HALF));
            let stiff = Housing { times: [1000.0, 1000.0, 20.0], damping: 5000.0, ..right(true) };
            parts.push(fitted(&stiff, 1, Mount::at_centre(2)));
        }
        let (solids, seats) = parts.into_iter().unzip();
        CoupledMotion::new(assembly, solids, seats, &options(0.8, 0.5)).unwrap()
    };
    let run = |mut housed: CoupledMotion| {
        let mut path = Vec::new();
        let mut gives_way = 0.0f64;
        while housed.time() < 1.2e-3 {
            (0..1000).for_each(|_| housed.advance().unwrap());
            let [shaft, race] = [SHAFT, 2].map(|body| housed.simulation.body(body));
            let axis = shaft.orientation * Vector3::x();
            path.push(shaft.position[2] + HALF * axis.z);
            gives_way = gives_way.max(race.position[2].abs());
        }
        (path, gives_way)
    };
    let (mut rigid, stiff) = (start(true), start(false));
    // In coupling steps of the same length, so that what these do to the other side is the same.
    rigid.divide(stiff.coupling_step).unwrap();
    let ((rigid, none), (stiff, gives_way)) = (run(rigid), run(stiff));
    assert_eq!(none, 0.0);
    let size = rigid.iter().fold(0.0f64, |most, z| most.max(z.abs()));
    let apart = rigid.iter().zip(&stiff).map(|(a, b)| (a - b).abs()).fold(0.0, worst);
    println!("shaft's end {size:.2e} m, apart {apart:.1e}, the race gives way {gives_way:.1e}");
    assert!(gives_way > 0.0 && gives_way < 0.02 * size, "{gives_way:e} of {size:e}");
    // The end follows the race under it.
    assert!(apart <= 3.0 * gives_way, "{apart:e}");
}

/// Under a load off the middle the housings share it as a lever has it, and each bears its part as a solid by
/// Newton's method does that is pressed by the race where this has settled.
#[test]
fn they_settle_as_levers_and_solids_have_it() {
    const LOAD: f64 = 1000.0;
    const OFF: f64 = 10e-3;
    let rise = |to| Drive::Load(Profile::SmoothRamp { from: 0.0, to, start: 0.0, duration: 2e-3 });
    let mut pressed = DrivenBody { rotation: Rotation::Speed(Profile::ZERO), ..shaft() };
    (pressed.drives[2], pressed.drives[3]) = (rise(-LOAD), rise(LOAD * OFF));
    pressed.foundation_damping = [1e3, 3e3, 3e3, 5.0, 5.0];
    let damped = |housing: Housing| Housing { damping: 4000.0, ..housing };
    let housings = [damped(left(true)), damped(Housing { wall: 8e-3, ..right(true) })];
    let assembly = on_two(pressed, ContactDamping::HuntCrossley { alpha: 2.0 });
    let mut housed = housed(assembly, housings, &options(0.8, 0.5));
    while housed.time() < 15e-3 {
        housed.advance().unwrap();
    }
    let snapshot = housed.snapshot().unwrap();
    let contacts = snapshot.solids.iter().map(|solid| solid.seats[0].contact);
    let contacts: Vec<ContactSum> = contacts.collect();
    let force: f64 = contacts.iter().map(|contact| contact.force[2]).sum();
    let places = [1, 2].map(|race| housed.simulation.body(race));
    let about = |(contact, race): (&ContactSum, &BodyState)| {
        contact.moment[1] - race.position[0] * contact.force[2]
    };
    let moment: f64 = contacts.iter().zip(&places).map(about).sum();
    let [force, moment] = [force / LOAD - 1.0, moment / (LOAD * OFF) + 1.0];
    assert!(contacts[1].force[2] > 1.2 * contacts[0].force[2]);
    let mut off = [0.0f64; 2];
    for (index, race) in places.iter().enumerate() {
        let SeatState { seat, rim, .. } = &housed.solids[index].seats[0];
        let still = CylinderContact {
            path: CylinderPath {
                start: Pose { position: race.position.into(), orientation: race.orientation },
                displacement: [0.0; 3].map(Profile::Constant),
                radius: Profile::Constant(RADIUS),
            },
            width: WIDTH + 2.0 * rim,
            penalty: seat.penalty,
            nodes: seat.nodes.clone(),
        };
        let model = &housed.solids[index].solid.model;
        let options = EquilibriumOptions::default();
        let still = equilibrium_in_contact(model, 0.0, &still, None, &options).unwrap();
        off[index] = contacts[index].force[2] / still.sum.force[2] - 1.0;
    }
    println!("load off by {force:.1e}, lever by {moment:.1e}, solids by {off:?}");
    // What still moves: measured 2e-4.
    for error in [force, moment, off[0], off[1]] {
        assert!(error.abs() <= 1e-3, "{error:e}");
    }
}

/// Two bearings that know nothing of each other, in one coupling_step: each moves as it does by itself, to the bit.
#[test]
fn what_is_not_joined_does_not_feel_the_other() {
    let problem = |load: f64| {
        let mut problem = DynamicProblem {
            outer: Some(outer_race()),
            ..bearing(table_4_1(-5e-6), [0.0; 5], 100.0)
        };
        problem.inner.drives[2] =
            Drive::Load(Profile::HalfSine { base: 0.0, peak: -load, start: 1e-5, duration: 1e-3 });
        problem
    };
    let centred = Housing { at: 0.0, ..left(true) };
    let alone = |load: f64| {
        let (solid, seat) = fitted(&centred, 0, Mount::at_centre(1));
        CoupledMotion::new(problem(load), vec![solid], vec![seat], &options(0.8, 0.25)).unwrap()
    };
    let (mut first, mut second) = (alone(1500.0), alone(700.0));
    let mut assembly = problem(1500.0).assembly();
    let other = problem(700.0).assembly();
    assembly.bodies.extend(other.bodies);
    assembly.bearings.extend(other.bearings.into_iter().map(|mut bearing| {
        bearing.mounts.iter_mut().for_each(|mount| mount.body += 2);
        bearing
    }));
    let (solids, seats) = [0, 1]
        .map(|solid| fitted(&centred, solid, Mount::at_centre(1 + 2 * solid)))
        .into_iter()
        .unzip();
    let mut both = CoupledMotion::new(assembly, solids, seats, &options(0.8, 0.25)).unwrap();
    assert_eq!(both.coupling_step.to_bits(), first.coupling_step.to_bits());
    for _ in 0..1500 {
        [&mut first, &mut second, &mut both].into_iter().for_each(|one| one.advance().unwrap());
    }
    for (index, alone) in [&first, &second].into_iter().enumerate() {
        assert_eq!(both.solids[index].solid.displacement, alone.solids[0].solid.displacement);
        for body in 0..2 {
            let of = |housed: &CoupledMotion, body: usize| {
                let at = housed.simulation.system.places.body(body);
                bits(&housed.simulation.state[at..at + BODY])
            };
            assert_eq!(of(&both, 2 * index + body), of(alone, body));
        }
    }
    // What one ledger has integrated is booked by coupling steps where there are two.
    for (index, alone) in [first, second].iter_mut().enumerate() {
        let [one, other] = [alone, &mut both].map(|housed| housed.snapshot().unwrap());
        let (integrated, booked) = (one.solids[0].seats[0].work, other.solids[index].seats[0].work);
        println!("work {integrated:e} J, booked {booked:e} J");
        assert!((booked / integrated - 1.0).abs() <= 1e-9, "{integrated:e} {booked:e}");
    }
}
