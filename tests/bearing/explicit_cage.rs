//! A cage in explicit elements: momentum, energy, and agreement with its modes.

use crate::flexible_cage::with_built_cage;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::cage::Guidance;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::kinematics::vec3::{Vec3, add, cross, norm, scale, sub};
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::members::state::{POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingOptions, SolidPart};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::scene::build::cage::{BuiltCage, CageForm};

/// Speed of the ball that strikes, m/s.
const STRIKE: f64 = 1.0;
const END: f64 = 2e-3;

/// The bearing at rest without weight, traction and guide; one ball will strike the cage.
fn struck(keys: &str) -> (Assembly, BuiltCage) {
    let (mut all, mut built) = with_built_cage(keys, 0.0, 1.0);
    all.gravity = [0.0; 3];
    all.bearings[0].traction = TractionLaw::None;
    all.bearings[0].cage.as_mut().unwrap().contacts.guidance = Guidance::Balls;
    if let CageForm::Elements(part) = &mut built.form {
        part.model.problem.gravity = [0.0; 3];
        part.model =
            bearing_dynamics::solids::model::SolidModel::new(part.model.problem.clone()).unwrap();
    }
    for body in &mut all.bodies {
        if let Some(driven) = body.driven_mut() {
            driven.rotation = Rotation::Speed(Profile::Constant(0.0));
        }
    }
    (all, built)
}

fn options(step: f64) -> RunOptions {
    RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Fixed(step),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    }
}

/// Sends ball 3 along its orbit.
fn strike(simulation: &mut Simulation) {
    let layout = simulation.system.sets[0].layout;
    let [_, y, z] = layout.ball_vector(&simulation.state, POSITION, 2);
    let along = scale([0.0, -z, y], STRIKE / y.hypot(z));
    for (i, part) in along.into_iter().enumerate() {
        simulation.state[layout.ball(VELOCITY + i) + 2] = part;
    }
}

/// What is compared: centre of the cage (m), its spin (rad/s), radial displacement of places of the land (m).
#[derive(Default)]
struct Seen {
    centre: Vec<Vec3>,
    spin: Vec<f64>,
    radial: Vec<Vec<f64>>,
}

const ROWS: usize = 20;

fn in_elements(keys: &str, finer: f64) -> (Seen, [f64; 3]) {
    let (all, built) = struck(keys);
    let CageForm::Elements(part) = &built.form else { panic!("not in elements") };
    let solids = vec![SolidPart::clone(part)];
    let coupling = CouplingOptions { ..CouplingOptions::without_housings(options(1e-6)) };
    let mut housed = CoupledMotion::new(all, solids, Vec::new(), &coupling).unwrap();
    let per_row = housed.divide(END / ROWS as f64).unwrap();
    let per_row = housed.divide(END / ROWS as f64 / (finer * per_row as f64)).unwrap()
        * (finer * per_row as f64) as u64;
    strike(&mut housed.simulation);
    let first_energy = housed.snapshot().unwrap().residual;
    let nodes = &part.cage.as_ref().unwrap().nodes;
    let centre = part.cage.as_ref().unwrap().centre;
    let momenta = |housed: &CoupledMotion| {
        let layout = housed.simulation.system.sets[0].layout;
        let state = &housed.simulation.state;
        let ball = housed.simulation.system.assembly.bearings[0].ball;
        let solid = &housed.solids[0].solid;
        let mut sum = [[0.0; 3]; 2];
        for i in 0..layout.balls {
            let [at, v, spin] =
                [POSITION, VELOCITY, SPIN].map(|of| layout.ball_vector(state, of, i));
            let p = scale(v, ball.mass);
            sum = [add(sum[0], p), add(sum[1], add(cross(at, p), scale(spin, ball.axial)))];
        }
        for (n, place) in solid.model.problem.nodes.iter().enumerate() {
            let [u, v] = [solid.displacement[n], solid.rates()[n]].map(|[x, y, z, _]| [x, y, z]);
            // Displacements are half a step ahead of velocities.
            let at = add(add(*place, u), scale(v, -0.5 * solid.step_size));
            let p = scale(v, solid.model.mass[n]);
            sum = [add(sum[0], p), add(sum[1], cross(at, p))];
        }
        sum
    };
    let first = momenta(&housed);
    let mut seen = Seen::default();
    let mut worst = [0.0f64; 3];
    for _ in 0..ROWS {
        for _ in 0..per_row {
            housed.advance().unwrap();
        }
        let now = momenta(&housed);
        // The races hold the balls across their orbit: momentum is that along X, and of all about it.
        worst[0] = worst[0].max((now[1][0] - first[1][0]).abs() / norm(first[1]));
        let energy = housed.snapshot().unwrap();
        worst[1] = worst[1].max((energy.residual - first_energy).abs());
        worst[2] = energy.turned_over;
        let body = housed.simulation.body(2);
        seen.centre.push(body.position);
        seen.spin.push(body.spin[0]);
        let solid = &housed.solids[0].solid;
        let back = body.orientation.inverse();
        let radial = |(place, node): (&Vec3, &u32)| {
            let [x, y, z, _] = solid.displacement[*node as usize];
            let [p, q, r, _] = solid.rates()[*node as usize];
            let half = 0.5 * solid.step_size;
            let moved = [x - half * p, y - half * q, z - half * r];
            let at = sub(add(add(*place, centre), moved), body.position);
            let at: Vec3 = (back * nalgebra::Vector3::from(at)).into();
            at[1].hypot(at[2]) - place[1].hypot(place[2])
        };
        seen.radial.push(nodes.land.places.iter().zip(&nodes.land.nodes).map(radial).collect());
    }
    (seen, worst)
}

fn by_modes(keys: &str, step: f64) -> Seen {
    let (all, _) = struck(keys);
    let mut simulation = Simulation::new(all, options(step)).unwrap();
    strike(&mut simulation);
    let rest = simulation.state.clone();
    let assembly = simulation.system.assembly.clone();
    let mut simulation = Simulation::from_state(assembly, options(step), rest, 0.0).unwrap();
    let per_row = (END / ROWS as f64 / step).round() as usize;
    let mut seen = Seen::default();
    for _ in 0..ROWS {
        for _ in 0..per_row {
            simulation.step().unwrap();
        }
        let body = simulation.body(2);
        seen.centre.push(body.position);
        seen.spin.push(body.spin[0]);
        let system = &simulation.system;
        let group =
            &system.assembly.bearings[0].cage.as_ref().unwrap().nodes.as_ref().unwrap().land;
        let solid = &system.assembly.floating[0];
        let [gone, _] = solid.split(system.deformed(&simulation.state, 0));
        let radial = |node: usize| {
            let mut at = group.places[node];
            for (axis, part) in at.iter_mut().enumerate() {
                for (k, gone) in gone.iter().enumerate() {
                    *part += gone * group.shapes[(3 * node + axis) * group.modes + k];
                }
            }
            at[1].hypot(at[2]) - group.places[node][1].hypot(group.places[node][2])
        };
        seen.radial.push((0..group.places.len()).map(radial).collect());
    }
    seen
}

impl Seen {
    /// Largest difference of centre, spin and deformation over the largest value of each.
    fn apart(&self, other: &Seen) -> [f64; 3] {
        let most = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, f64::max);
        let centre =
            most(&mut self.centre.iter().zip(&other.centre).map(|(a, b)| norm(sub(*a, *b))));
        let spin = most(&mut self.spin.iter().zip(&other.spin).map(|(a, b)| (a - b).abs()));
        let square = |of: &mut dyn Iterator<Item = f64>| of.map(|r| r * r).sum::<f64>().sqrt();
        let radial = || self.radial.iter().flatten().zip(other.radial.iter().flatten());
        let apart = square(&mut radial().map(|(a, b)| a - b));
        [
            centre / most(&mut self.centre.iter().map(|of| norm(*of))),
            spin / most(&mut self.spin.iter().map(|of| of.abs())),
            apart / square(&mut radial().map(|(a, _)| *a)),
        ]
    }
}

/// Errors of the reduced cage against the explicit one, at the printed stiffness and at a tenth of it, of which the local
/// yielding of single nodes takes less.
#[test]
fn a_cage_struck_by_one_ball_moves_as_its_modes_say() {
    // Halving the coupling step again moves centre, spin and deformation by less than 0.4, 0.1 and 0.8 %.
    for (stiffness, bounds) in [("2e8", [0.01, 0.01, 0.02]), ("2e7", [0.01; 3])] {
        let at = format!(
            "contact = {{ law = \"penalty\", at = \"nodes\", stiffness = \"{stiffness} N/m\" }}"
        );
        let (explicit, kept) = in_elements(&format!("{at}\nbody = \"explicit\""), 2.0);
        // Angular momentum is handed over with the motion of the balls during a coupling step left out.
        assert!(kept[0] <= 1e-6, "angular momentum changes by {}", kept[0]);
        assert!(kept[1] <= 1e-3 * kept[2], "{} J of {} J unaccounted for", kept[1], kept[2]);
        let by = |more: &str| {
            explicit.apart(&by_modes(&format!("{at}\nbody = \"reduced\"\n{more}"), 1e-6))
        };
        let few = by("modes_to = \"10 kHz\"\ncorrections = false");
        let more = by("modes_to = \"30 kHz\"\ncorrections = false");
        let most = by("modes_to = \"80 kHz\"");
        for i in 0..3 {
            assert!(most[i] <= bounds[i], "{most:?}");
            // What is left at the softer contact is the coupling step.
            assert!(most[i] < few[i] && more[i] < few[i], "{few:?} {more:?} {most:?}");
        }
    }
}

/// In the bearing at 1200 rpm: eleven balls that speed up strike the cage within some microseconds.
#[test]
fn a_cage_in_elements_spins_in_the_bearing_as_its_modes_say() {
    let speed = || {
        Rotation::Speed(Profile::SmoothRamp { from: 125.0, to: 157.0, start: 0.0, duration: 1e-3 })
    };
    let (end, rows) = (3e-3, 60);
    let accurate = RunOptions { stepping: Stepping::Accuracy(0.001), ..options(1e-6) };
    let (mut all, built) = with_built_cage("body = \"explicit\"", 1200.0, 1.0);
    all.bodies[0].driven_mut().unwrap().rotation = speed();
    let CageForm::Elements(part) = built.form else { panic!("not in elements") };
    let coupling = CouplingOptions::without_housings(accurate);
    let mut housed = CoupledMotion::new(all, vec![*part], Vec::new(), &coupling).unwrap();
    let per_row = housed.divide(end / rows as f64).unwrap();
    let (mut all, _) = with_built_cage("body = \"reduced\"\nmodes_to = \"80 kHz\"", 1200.0, 1.0);
    all.bodies[0].driven_mut().unwrap().rotation = speed();
    let mut simulation = Simulation::new(all, accurate).unwrap();
    let first = housed.simulation.body(2);
    for row in 1..=rows {
        for _ in 0..per_row {
            housed.advance().unwrap();
        }
        let time = end * row as f64 / rows as f64;
        while simulation.time < time * (1.0 - 1e-12) {
            let left = time - simulation.time;
            simulation.step_by(simulation.step_size.min(left)).unwrap();
        }
        let [explicit, reduced] = [&housed.simulation, &simulation].map(|of| of.body(2));
        let gained = 14.0;
        let spin = (explicit.spin[0] - reduced.spin[0]).abs();
        assert!(spin <= 0.02 * gained, "{spin} rad/s at {time} s");
        let turned = explicit.orientation.angle_to(&first.orientation);
        let apart = explicit.orientation.angle_to(&reduced.orientation);
        assert!(apart <= 1e-3 * turned, "{apart} of {turned} rad at {time} s");
    }
    let gained = housed.simulation.body(2).spin[0] - first.spin[0];
    assert!(gained > 10.0, "no ball has struck the cage: {gained} rad/s");
    let energy = housed.snapshot().unwrap();
    assert!(energy.residual.abs() <= 1e-3 * 0.4, "{} J", energy.residual);
}
