//! Races in rough bores of solids in explicit steps (4.2.4.2): what friction holds, what it loses, and that the
//! race gets what the bore gets.

use crate::{dynamics, housing_exchange};

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bore_contact::{
    ContactNode, Cylinder, Frame, Penalty, contact_nodes,
};
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::ch4_rotor::bore_friction::{BoreFriction, COEFFICIENT, STRETCH};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::{Body, Drive, DrivenBody, Mobility, Rotation};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::state::{SPIN, VELOCITY};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
use bearing_dynamics::motion::bore_friction::{Pressed, SeatFriction};
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingOptions, SolidPart};
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::plan::Stage;
use bearing_dynamics::solids::model::{DampedMotion, Prescribed, SolidModel, SolidProblem};
use dynamics::race;
use housing_exchange::*;

/// Springs softer than the contact where the race is [`TIGHT`], and as stiff.
const SOFT: BoreFriction = BoreFriction { coefficient: COEFFICIENT, stretch: 1e-7 };
pub const LAW: BoreFriction = BoreFriction { coefficient: COEFFICIENT, stretch: STRETCH };
/// Of the race over its bore, m: every node touches under the same pressure.
pub const TIGHT: f64 = 0.1e-6;
/// N/m³.
pub const STIFFNESS: f64 = 2.5e14;

/// A coarse ring of which every node is held.
pub fn rigid() -> (SolidModel, Vec<ContactNode>) {
    let shape = Ring { inner_radius: RADIUS, outer_radius: RADIUS + WALL, width: WIDTH };
    let cells = RingMesh { around: 16, radial: 1, axial: 2, radial_growth: 1.0 };
    let mesh = ring(&shape, &cells).unwrap().mesh;
    let nodes = contact_nodes(&mesh, &mesh.surface_sets["inner"]);
    let hold = |node: usize| {
        [0, 1, 2].map(|axis| Prescribed { node: node as u32, axis, profile: Profile::ZERO })
    };
    let problem = SolidProblem {
        prescribed: (0..mesh.nodes.len()).flat_map(hold).collect(),
        nodes: mesh.nodes,
        elements: mesh.elements,
        material: LinearElastic::new(2.1e11, 0.3).unwrap(),
        density: 7850.0,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    (SolidModel::new(problem).unwrap(), nodes)
}

/// A race alone.
fn alone(drives: [Drive; 5], rotation: Rotation) -> Assembly {
    let inertia = inertia::hollow_cylinder(32e-3, RADIUS, WIDTH, 7850.0);
    let race = DrivenBody { inertia, drives, ..race([0.0; 5], rotation) };
    let body = Body {
        name: "the outer race".into(),
        label: None,
        mobility: Mobility::Driven(Box::new(race)),
        rest: [0.0; 5],
        rotating_load: None,
        unbalance: 0.0,
    };
    Assembly { bodies: vec![body], ..Assembly::default() }
}

fn rough(nodes: Vec<ContactNode>, friction: Option<BoreFriction>) -> Seat {
    let (mount, radius) = (Mount::at_centre(0), Profile::Constant(RADIUS + TIGHT));
    let penalty = Penalty::PerArea(STIFFNESS);
    Seat { mount, radius, penalty, friction, ..seat(nodes, f64::INFINITY) }
}

fn in_bore(
    assembly: Assembly,
    (model, nodes): (SolidModel, Vec<ContactNode>),
    friction: Option<BoreFriction>,
    options: &CouplingOptions,
) -> CoupledMotion<'static> {
    let seat = rough(nodes, friction);
    let solids = vec![SolidPart::undeformed(None, model)];
    CoupledMotion::new(assembly, solids, vec![seat], options).unwrap()
}

const STILL: Drive = Drive::Motion(Profile::ZERO);
const UNLOADED: Drive = Drive::Load(Profile::ZERO);

/// Σ of the normal loads, N, and of areas times axial places squared.
fn pressed(nodes: &[ContactNode]) -> f64 {
    nodes.iter().map(|node| STIFFNESS * TIGHT * node.area).sum()
}

/// A race that is moved to and fro along its rigid bore: what it feels at once, its heat after each stretch of way.
#[test]
fn a_race_moved_along_its_bore_sticks_and_slips_by_the_closed_form() {
    for (law, slips_at) in [(SOFT, SOFT.stretch), (LAW, COEFFICIENT * TIGHT)] {
        let (model, nodes) = rigid();
        let limit = COEFFICIENT * pressed(&nodes);
        let (reach, leg) = (4e-7, 4e-4);
        let points = vec![[0.0, 0.0], [leg, reach], [3.0 * leg, -reach], [5.0 * leg, reach]];
        let along = Drive::Motion(Profile::Table { points });
        let moved = alone([along, STILL, STILL, STILL, STILL], Rotation::Speed(Profile::ZERO));
        let mut housed = in_bore(moved, (model, nodes), Some(law), &rated(0.8, 0.25, 1e-6));
        let (mut stick, mut slip, mut heats) = (0.0f64, 0.0f64, Vec::new());
        let mut due = [leg, 3.0 * leg, 5.0 * leg].into_iter().peekable();
        while let Some(end) = due.peek().copied() {
            housed.advance().unwrap();
            let t = housed.time();
            let snapshot = housed.snapshot().unwrap();
            let friction = &snapshot.solids[0].seats[0].friction;
            // Where displacements are.
            let at = reach * f64::min((t + 0.5 * housed.coupling_step) / leg, 1.0);
            if t < 0.95 * leg {
                let should = -limit * f64::min(at / slips_at, 1.0);
                let error = (friction.force[0] - should).abs() / limit;
                let worst = if at < slips_at { &mut stick } else { &mut slip };
                *worst = if error <= *worst { *worst } else { error };
            }
            if t >= end {
                heats.push(friction.heat);
                due.next();
            }
        }
        println!("stick {stick:.1e}, slip {slip:.1e} of μN");
        assert!(stick <= 1e-6 && slip <= 1e-6, "{stick:e} {slip:e}");
        // μN (A − s) at first, then 4 μN (A − s) in every cycle, and where a leg ends within a coupling step a part of its way.
        let unit = limit * (reach - slips_at);
        let errors = [heats[0] / unit - 1.0, (heats[2] - heats[0]) / (4.0 * unit) - 1.0];
        println!("heat {errors:?}");
        assert!(errors[0].abs() <= 5e-5 && errors[1].abs() <= 5e-5, "{errors:?}");
    }
}

/// Under half of what slips a race comes to rest and stays, along its axis and about it.
#[test]
fn a_race_at_rest_does_not_creep() {
    let (model, nodes) = rigid();
    let limit = 0.6 * pressed(&nodes);
    let up = |to| Profile::SmoothRamp { from: 0.0, to, start: 0.0, duration: 4e-4 };
    let along = Drive::Load(up(0.4 * limit));
    let drives = [along, UNLOADED, UNLOADED, UNLOADED, UNLOADED];
    let held = alone(drives, Rotation::Torque(up(0.4 * limit * RADIUS)));
    let mut housed = in_bore(held, (model, nodes), Some(LAW), &rated(0.8, 0.25, 1e-6));
    while housed.time() < 5e-4 {
        housed.advance().unwrap();
    }
    let springs = |housed: &CoupledMotion| only(housed).friction.as_ref().unwrap().springs.clone();
    let before = springs(&housed);
    let (mut first, mut last) = ([0.0; 2], [0.0; 2]);
    for step in 0..100_000 {
        housed.advance().unwrap();
        let body = housed.simulation.body(0);
        let now = [body.position[0], 2.0 * body.orientation.i * RADIUS];
        let sum = match step {
            0..10_000 => &mut first,
            90_000..100_000 => &mut last,
            _ => continue,
        };
        (0..2).for_each(|i| sum[i] += 1e-4 * now[i]);
    }
    // 0.4 of what slips in both ways, every node's stretch of the same size.
    let should = 0.4 * COEFFICIENT * TIGHT;
    println!("{first:?} {last:?} of {should:e}");
    for i in 0..2 {
        assert!((first[i] / should - 1.0).abs() <= 1e-4, "{first:?}");
        assert!((last[i] - first[i]).abs() <= 1e-6 * should, "{first:?} {last:?}");
    }
    let after = springs(&housed);
    assert_eq!(before.len(), after.len());
    for ((node, before), (other, after)) in before.iter().zip(&after) {
        assert!(node == other && before.anchor == after.anchor, "{before:?} {after:?}");
    }
    let snapshot = housed.snapshot().unwrap();
    assert_eq!(snapshot.solids[0].seats[0].friction.heat, 0.0);
}

/// What the law as printed does where springs are soft: with every change of load they push a race on that they hold against
/// a torque, at right angles to its swing.
#[test]
fn soft_springs_drive_the_swing_of_a_race_that_they_hold() {
    let share = 0.02;
    let grow = |law: BoreFriction| {
        let (model, nodes) = rigid();
        let sum: f64 = nodes.iter().map(|node| STIFFNESS * node.area).sum();
        let torque = share * COEFFICIENT * pressed(&nodes) * RADIUS;
        let up = Profile::SmoothRamp { from: 0.0, to: torque, start: 0.0, duration: 2e-5 };
        let drives = [STILL, UNLOADED, UNLOADED, STILL, STILL];
        let held = alone(drives, Rotation::Torque(up));
        let mut housed = in_bore(held, (model, nodes), Some(law), &rated(0.8, 0.1, 1e-6));
        let mass = housed.simulation.system.assembly.bodies[0].inertia().unwrap().mass;
        let first = housed.simulation.system.places.body(0) + VELOCITY + 2;
        housed.simulation.state[first] = 1e-4;
        housed.divide(1.0).unwrap();
        let mut energies = Vec::new();
        for (from, to) in [(4e-5, 8e-5), (4e-4, 4.4e-4)] {
            let (mut sum, mut count) = (0.0, 0);
            while housed.time() < to {
                housed.advance().unwrap();
                let [_, y, z] = housed.simulation.body(0).velocity;
                if housed.time() > from {
                    (sum, count) = (sum + y * y + z * z, count + 1);
                }
            }
            energies.push(sum / f64::from(count));
        }
        let tangential = sum * f64::min(COEFFICIENT * TIGHT / law.stretch, 1.0);
        let rate = (0.5 * (sum + tangential) / mass).sqrt();
        let pushed = 0.5 * COEFFICIENT * share * sum / (2.0 * mass * rate);
        (0.5 * (energies[1] / energies[0]).ln() / 3.6e-4, pushed)
    };
    let (soft, should) = grow(SOFT);
    let (stiff, _) = grow(LAW);
    println!("growth {soft:.1} 1/s of {should:.1} 1/s; as stiff as the contact {stiff:.1} 1/s");
    assert!((soft / should - 1.0).abs() <= 0.05, "{soft} {should}");
    assert!(stiff.abs() <= 0.01 * should, "{stiff}");
}

/// Beyond what its bore holds a race goes as fast as the rest of the force takes it.
#[test]
fn a_race_pushed_harder_slides() {
    let (model, nodes) = rigid();
    let limit = 0.6 * pressed(&nodes);
    let (push, begin) = (1.01 * limit, 1e-4);
    let along =
        Drive::Load(Profile::SmoothRamp { from: 0.0, to: push, start: 0.0, duration: begin });
    let drives = [along, STILL, STILL, STILL, STILL];
    let mut housed = in_bore(
        alone(drives, Rotation::Speed(Profile::ZERO)),
        (model, nodes),
        Some(LAW),
        &rated(0.8, 0.25, 1e-6),
    );
    let mass = housed.simulation.system.assembly.bodies[0].inertia().unwrap().mass;
    let mut at = Vec::new();
    for end in [begin, 2.0 * begin] {
        while housed.time() < end {
            housed.advance().unwrap();
        }
        at.push((housed.time(), housed.simulation.body(0).velocity[0]));
        assert!(housed.time() - end < 2.0 * housed.coupling_step);
    }
    let gained = (at[1].1 - at[0].1) / (at[1].0 - at[0].0);
    let should = (push - limit) / mass;
    println!("{gained:.9} of {should:.9} m/s²");
    assert!((gained / should - 1.0).abs() <= 1e-6, "{gained} {should}");
}

/// A race that becomes too small to touch: what its springs held has gone with the load that held them.
#[test]
fn a_spring_that_is_let_go_takes_nothing_along() {
    let (_, nodes) = rigid();
    let mut friction = SeatFriction::new(SOFT, nodes.len());
    let count = nodes.iter().map(|node| node.node as usize + 1).max().unwrap();
    let mut push = |radius: f64, along: f64| {
        let displacement = vec![[along, 0.0, 0.0, 0.0]; count];
        let mut forces = vec![[0.0; 4]; count];
        let pressed = Pressed {
            cylinder: &Cylinder { radius, width: 1.2 * WIDTH },
            frame: &Frame::new(&Pose::identity()),
            penalty: Penalty::PerArea(STIFFNESS),
            nodes: &nodes,
            displacement: &displacement,
        };
        let contact = friction.step(&pressed, &mut forces);
        (contact.touching, friction.sum)
    };
    push(RADIUS + TIGHT, 0.0);
    let (touching, held) = push(RADIUS + TIGHT, 5e-8);
    assert!(touching == nodes.len() && held.stored > 0.0 && held.slipping == 0);
    let (touching, gone) = push(RADIUS - TIGHT, 5e-8);
    assert_eq!((touching, gone.stored, gone.heat), (0, 0.0, 0.0));
    // The sums over the nodes are in the same order.
    assert!((gone.load_work + held.stored).abs() <= 1e-12 * held.stored, "{gone:?} {held:?}");
    // Touching again it begins anew.
    let (_, anew) = push(RADIUS + TIGHT, 9e-8);
    assert_eq!((anew.stored, anew.force), (0.0, [0.0; 3]));
}

/// As stiff as springs become, steps and coupling steps next to their limits: a race that swings and turns in its bore keeps
/// its energy.
#[test]
fn the_shortest_springs_leave_the_steps_stable() {
    let shortest = BoreFriction { stretch: 1e-12, ..LAW };
    let bores = [(rigid as fn() -> _, 0.8, 1.9), (|| housing(true, 0.0), 0.95, 0.5)];
    for (bore, fraction, phase) in bores {
        let free = alone([UNLOADED; 5], Rotation::Torque(Profile::ZERO));
        let mut housed = in_bore(free, bore(), Some(shortest), &rated(fraction, phase, 1e-6));
        let layout = housed.simulation.system.places.body(0);
        for (entry, value) in [(VELOCITY, 1e-3), (SPIN, 0.03), (SPIN + 1, 0.03), (SPIN + 2, -0.02)]
        {
            housed.simulation.state[layout + entry] = value;
        }
        housed.divide(1.0).unwrap();
        let kinetic =
            |housed: &mut CoupledMotion| housed.snapshot().unwrap().simulation.energy.kinetic;
        let first = kinetic(&mut housed);
        // In either half of the run.
        let mut most = [0.0f64; 2];
        for step in 0..20_000 {
            housed.advance().unwrap();
            let now = kinetic(&mut housed);
            let most = &mut most[step / 10_000];
            *most = if now <= *most { *most } else { now };
        }
        println!(
            "kinetic energy at most {:.3} and {:.3} of the first",
            most[0] / first,
            most[1] / first
        );
        assert!(most[1] <= 1.5 * most[0], "{most:?}");
        // Between two kicks velocities are larger than at them: their energy by 1/(1 − (phase/2)²). A ring that gives way
        // rings, pressed at once as it is.
        if phase > 1.0 {
            let allowed = 1.0 / (1.0 - 0.25 * phase * phase);
            assert!(most[1] <= 1.1 * allowed * first, "{most:?} of {first:e}");
        }
    }
}

/// The work that is counted is that of nodes that touch.
#[test]
fn every_spring_is_counted() {
    let (model, nodes) = rigid();
    let count = nodes.len() as u64;
    let still = alone([STILL, STILL, STILL, STILL, STILL], Rotation::Speed(Profile::ZERO));
    let mut housed = in_bore(still, (model, nodes), Some(LAW), &options());
    for _ in 0..10 {
        housed.advance().unwrap();
    }
    let steps = housed.solids[0].steps as u64;
    assert_eq!(housed.ran().seats[0].of(Stage::BoreFriction), 10 * steps * count);
    housed.forget_ran();
    assert_eq!(housed.ran().seats[0].of(Stage::BoreFriction), 0);
}

/// A race so light about its diameters that its tilt decides: springs of the friction hold it with what they are worth across the
/// bore beside what the contact holds along it, and coupling steps are as much shorter. One whose speed is given is not held about its axis.
#[test]
fn windows_know_what_friction_holds_tilts_with() {
    let (_, nodes) = rigid();
    let coupling_step = |friction| {
        let mut turning = alone([UNLOADED; 5], Rotation::Speed(Profile::ZERO));
        turning.bodies[0].driven_mut().unwrap().inertia.transverse = 1e-6;
        // Steps of the solid are far shorter than coupling_steps: these are of so many.
        in_bore(turning, rigid(), friction, &rated(0.02, 1.0, 1e-6)).coupling_step
    };
    let sum = |axis: usize| -> f64 {
        nodes.iter().map(|node| STIFFNESS * node.area * node.place[axis] * node.place[axis]).sum()
    };
    let (along, across) = (sum(0), f64::max(sum(1), sum(2)));
    for (friction, stiffness) in [(None, along), (Some(LAW), along + across)] {
        let longest = (1e-6 / stiffness).sqrt();
        let found = coupling_step(friction);
        // Of whole steps.
        assert!(found <= longest && found >= 0.9 * longest, "{friction:?}: {found:e} {longest:e}");
    }
}
