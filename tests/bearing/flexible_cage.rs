//! Flexible cages: momentum and energy in a floating frame, and contacts by the nodes of the mesh.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::cage::AxisMotion;
use bearing_dynamics::ch5_cage::node_contact::depth_in_ball;
use bearing_dynamics::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use bearing_dynamics::members::body::{Body, Mobility, Rotation};
use bearing_dynamics::members::cage_nodes::{CageNodes, CageNow, Deformation};
use bearing_dynamics::members::floating_solid::FloatingSolid;
use bearing_dynamics::members::rigid_body::BodyKinematics;
use bearing_dynamics::members::state::{BODY, BodyState};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::scene::Format;
use bearing_dynamics::scene::build::cage::{BuiltCage, add_cage_nodes};
use bearing_dynamics::scene::build::motion::dynamic_problem;
use nalgebra::{UnitQuaternion, Vector3};

/// The bearing of Table 5.3 at a constant speed (rpm), with these keys of its cage and a coarse mesh.
pub(crate) fn with_cage(keys: &str, rpm: f64) -> Assembly {
    with_stiffer_cage(keys, rpm, 1.0)
}

/// The same with Young's modulus times a factor.
fn with_stiffer_cage(keys: &str, rpm: f64, factor: f64) -> Assembly {
    with_built_cage(keys, rpm, factor).0
}

pub(crate) fn with_built_cage(keys: &str, rpm: f64, factor: f64) -> (Assembly, BuiltCage) {
    let text = include_str!("../../scenes/cage_600rpm.toml");
    let speed = format!("speed = \"{rpm} rpm\"");
    let mesh = if keys.contains("mesh = ") { "" } else { MESH };
    let text = text
        .replace("contact = { law", if keys.contains("contact") { "# { law" } else { "contact = { law" })
        .replace("friction = 0.1\nreg", &format!("friction = 0.1\n{keys}\n{mesh}\nreg"))
        .replace("speed = { smooth_ramp = [\"0 rpm\", \"600 rpm\"], start = \"0 s\", duration = \"0.3 s\" }", &speed);
    assert!(text.contains(keys) && text.contains(&speed));
    let mut scene = bearing_dynamics::scene::read_str(&text, Format::Toml, "cage.toml").unwrap();
    if let Some(cage) = &mut scene.dynamics.flexible_cage {
        cage.youngs_modulus *= factor;
    }
    let mut all = dynamic_problem(&scene).unwrap().assembly();
    let built = add_cage_nodes(&mut all, [&scene.dynamics].into_iter()).unwrap();
    (all, built.into_iter().next().unwrap())
}

const MESH: &str = "mesh = { quarter = 3, bar = 1, wall = 1 }";
const REDUCED: &str = "body = \"reduced\"\ncorrections = false";

/// The flexible cage alone, spinning about a skew axis and vibrating.
fn free_cage() -> (Assembly, Vec<f64>) {
    let bearing = with_cage(REDUCED, 600.0);
    let body = Body { rest: [0.0; 5], ..bearing.bodies[2].clone() };
    assert!(matches!(body.mobility, Mobility::Free(_)));
    let floating = vec![FloatingSolid { body: 0, ..bearing.floating[0].clone() }];
    let count = floating[0].count();
    let assembly = Assembly { bodies: vec![body], floating, ..Assembly::default() };
    let start = BodyState {
        position: [1e-3, -2e-3, 3e-3],
        orientation: UnitQuaternion::from_euler_angles(0.3, -0.2, 0.5),
        velocity: [0.1, -0.2, 0.3],
        spin: [900.0, 300.0, -200.0],
    };
    let mut state = start.to_array().to_vec();
    // Tens of micrometres in each mode, in motion.
    state.extend((0..count).map(|k| 4e-6 * (1.0 + (k as f64).sin())));
    state.extend((0..count).map(|k| 0.02 * (2.0 * k as f64).cos()));
    let ledger =
        bearing_dynamics::assembly::places::Places::of(&assembly).state_len() - state.len();
    state.extend(vec![0.0; ledger]);
    (assembly, state)
}

fn fixed(step: f64) -> RunOptions {
    RunOptions {
        start: Start::Nominal,
        integrator: Integrator::RungeKutta,
        stepping: Stepping::Fixed(step),
        ..RunOptions::default()
    }
}

/// Relative change of momentum, angular momentum and energy of the free cage over 2 ms.
fn changes(step: f64) -> [f64; 3] {
    let (assembly, state) = free_cage();
    let mut simulation = Simulation::from_state(assembly, fixed(step), state, 0.0).unwrap();
    let read = |simulation: &mut Simulation| {
        let energy = simulation.snapshot().energy.total();
        let system = &simulation.system;
        let body = BodyKinematics::new(simulation.body(0));
        let solid = &system.assembly.floating[0];
        let about_centre = solid.angular_momentum(&body, system.deformed(&simulation.state, 0));
        (scale(body.state.velocity, solid.frame.mass), about_centre, energy)
    };
    let first = read(&mut simulation);
    for _ in 0..(2e-3 / step).round() as usize {
        simulation.step().unwrap();
    }
    let last = read(&mut simulation);
    assert!(first.2 > 1.0, "the cage has an energy of {} J", first.2);
    [
        norm(sub(last.0, first.0)) / norm(first.0),
        norm(sub(last.1, first.1)) / norm(first.1),
        (last.2 - first.2).abs() / first.2,
    ]
}

#[test]
fn a_free_flexible_cage_keeps_momentum_and_energy() {
    let [momentum, angular, energy] = changes(1e-7);
    assert!(momentum <= 1e-13, "{momentum}");
    assert!(angular <= 1e-10, "{angular}");
    assert!(energy <= 1e-10, "{energy}");
    // What is left is the error of Runge–Kutta: local fifth order.
    let coarse = changes(2e-6);
    let fine = changes(1e-6);
    for of in [1, 2] {
        let order = (coarse[of] / fine[of]).log2();
        assert!(order >= 3.5, "order {order} from {} to {}", coarse[of], fine[of]);
    }
}

/// A cage with contact nodes, turned, moving and deformed, and its working data.
struct Posed {
    nodes: CageNodes,
    solid: FloatingSolid,
    body: BodyKinematics,
    gone: Vec<f64>,
    speeds: Vec<f64>,
}

fn posed() -> Posed {
    let bearing = with_cage(REDUCED, 600.0);
    let nodes = bearing.bearings[0].cage.as_ref().unwrap().nodes.clone().unwrap();
    let solid = bearing.floating[0].clone();
    let body = BodyKinematics::new(BodyState {
        position: [2e-5, -4e-5, 3e-5],
        orientation: UnitQuaternion::from_euler_angles(0.7, 2e-3, -1e-3),
        velocity: [0.03, 0.05, -0.02],
        spin: [26.0, 0.4, -0.3],
    });
    let gone = (0..solid.count()).map(|k| 2e-6 * (k as f64 + 0.3).cos()).collect();
    let speeds = (0..solid.count()).map(|k| 0.01 * (k as f64).sin()).collect();
    Posed { nodes, solid, body, gone, speeds }
}

impl Posed {
    fn now(&self) -> CageNow<'_> {
        let bound = self.nodes.bound(&self.gone);
        let deformation = Deformation::Modes([&self.gone, &self.speeds]);
        CageNow { body: &self.body, deformation, bound }
    }

    /// A ball pressed into the foremost node of a pocket, turning.
    fn ball(&self, pocket: usize, depth: f64) -> AxisMotion {
        let of = &self.nodes.pockets[pocket];
        let ahead = cross([1.0, 0.0, 0.0], of.towards);
        let front = |a: &&Vec3, b: &&Vec3| dot(**a, ahead).total_cmp(&dot(**b, ahead));
        let node = *of.group.places.iter().max_by(front).unwrap();
        let local = add_scaled(node, depth - BALL, ahead);
        let turn = |v: Vec3| -> Vec3 { (self.body.state.orientation * Vector3::from(v)).into() };
        AxisMotion {
            position: add(self.body.state.position, turn(local)),
            velocity: [0.2, -0.5, 0.7],
            spin: [-140.0, 20.0, 35.0],
            axis: [1.0, 0.0, 0.0],
        }
    }
}

const BALL: f64 = 5.953e-3;

#[test]
fn only_nodes_near_a_ball_are_tested_and_none_is_missed() {
    let posed = posed();
    let mut touched = 0;
    for (pocket, of) in posed.nodes.pockets.iter().enumerate() {
        for depth in [-300e-6, -60e-6, -5e-6, 20e-6, 60e-6, 150e-6] {
            let ball = posed.ball(pocket, depth);
            let mut forces = vec![0.0; posed.solid.count()];
            let found = posed.nodes.pocket(pocket, &posed.now(), &ball, BALL, &mut forces);
            // All nodes, displaced and turned one by one.
            let (mut load, mut count) = (0.0, 0);
            for node in 0..of.group.places.len() {
                let mut place = of.group.places[node];
                for (axis, part) in place.iter_mut().enumerate() {
                    for (k, gone) in posed.gone.iter().enumerate() {
                        let at = (3 * node + axis) * posed.gone.len() + k;
                        *part += gone * of.group.shapes[at];
                    }
                }
                let turned: Vec3 = (posed.body.state.orientation * Vector3::from(place)).into();
                let point = add(posed.body.state.position, turned);
                let (depth, _) = depth_in_ball(sub(point, ball.position), BALL);
                if depth > 0.0 {
                    load += of.group.stiffness[node] * depth;
                    count += 1;
                }
            }
            assert_eq!(found.touching, count);
            let error = (found.contact.normal_load - load).abs();
            assert!(error <= 1e-9 * load.max(1.0), "{load} N, found {:?}", found.contact);
            touched += count;
            if depth < -100e-6 {
                assert_eq!(found.tested, 0, "a ball far from the wall costs no test");
            }
        }
    }
    assert!(touched > 50, "{touched} contacts");
}

#[test]
fn node_contacts_conserve_momentum_and_book_their_friction() {
    let posed = posed();
    let about = |point: Vec3, load: &bearing_dynamics::members::rigid_body::Wrench| {
        add(load.moment, cross(point, load.force))
    };
    for pocket in [0, 4, 9] {
        let ball = posed.ball(pocket, 30e-6);
        let mut forces = vec![0.0; posed.solid.count()];
        let found = posed.nodes.pocket(pocket, &posed.now(), &ball, BALL, &mut forces);
        let load = found.contact.normal_load;
        assert!(load > 100.0 && found.contact.power < 0.0);
        assert!(norm(add(found.on_other.force, found.on_cage.force)) <= 1e-12 * load);
        let sum = add(
            about(ball.position, &found.on_other),
            about(posed.body.state.position, &found.on_cage),
        );
        assert!(norm(sum) <= 1e-12 * load * 30e-3, "{sum:?} N m");
        // Work of the contact on ball, frame and modes, with the energy stored: what is left is friction.
        let power = dot(found.on_other.force, ball.velocity)
            + dot(found.on_other.moment, ball.spin)
            + dot(found.on_cage.force, posed.body.state.velocity)
            + dot(found.on_cage.moment, posed.body.state.spin)
            + forces.iter().zip(&posed.speeds).map(|(f, v)| f * v).sum::<f64>();
        let step = 1e-9;
        let energy = |by: f64| {
            let mut moved = posed.ball(pocket, 30e-6);
            moved.position = add_scaled(moved.position, by, ball.velocity);
            let state = posed.body.state;
            let turn = UnitQuaternion::from_scaled_axis(Vector3::from(scale(state.spin, by)));
            let body = BodyKinematics::new(BodyState {
                position: add_scaled(state.position, by, state.velocity),
                orientation: turn * state.orientation,
                ..state
            });
            let gone: Vec<f64> =
                posed.gone.iter().zip(&posed.speeds).map(|(q, v)| q + by * v).collect();
            let now = CageNow {
                body: &body,
                deformation: Deformation::Modes([&gone, &posed.speeds]),
                bound: posed.nodes.bound(&gone),
            };
            let mut unused = vec![0.0; gone.len()];
            posed.nodes.pocket(pocket, &now, &moved, BALL, &mut unused).energy
        };
        let stored = (energy(step) - energy(-step)) / (2.0 * step);
        let error = (power + stored - found.contact.power).abs();
        assert!(
            error <= 1e-5 * power.abs(),
            "{power} W + {stored} W, friction {} W",
            found.contact.power
        );
    }
}

#[test]
fn the_land_touches_where_the_cage_is_displaced_to() {
    let posed = posed();
    let gone = vec![0.0; posed.solid.count()];
    let room = posed.nodes.land_radius - posed.nodes.rim;
    assert!((room - 0.2e-3).abs() <= 1e-6, "{room} m");
    for angle in [0.4, 2.5, 4.7] {
        let way = [0.0, f64::cos(angle), f64::sin(angle)];
        for (beyond, loaded) in [(-3e-6, false), (3e-6, true)] {
            let body = BodyKinematics::new(BodyState::at_rest(scale(way, room + beyond)));
            let now = CageNow {
                body: &body,
                deformation: Deformation::Modes([&gone, &gone]),
                bound: 0.0,
            };
            let race = AxisMotion { axis: [1.0, 0.0, 0.0], ..AxisMotion::default() };
            let mut forces = gone.clone();
            let mut normal = [gone.clone(), gone.clone()];
            let [low, high] = posed.nodes.land(&now, &race, &mut forces, &mut normal);
            let loads = [low, high].map(|end| end.contact.normal_load);
            assert_eq!(loads.map(|load| load > 0.0), [loaded; 2], "{loads:?}");
            if loaded {
                let along = dot(low.contact.force, way) / norm(low.contact.force);
                assert!(along >= 0.98, "the race is pushed where the cage is: {along}");
                assert!((loads[0] / loads[1] - 1.0).abs() <= 0.1, "{loads:?}");
            }
        }
    }
}

/// The cage's spin (rad/s) and centre (m) over 12 ms at 1200 rpm, with the inner race jerked so that balls strike the
/// pockets.
fn motion(keys: &str, factor: f64) -> Vec<(f64, Vec3)> {
    let mut assembly = with_stiffer_cage(keys, 1200.0, factor);
    if let Some(inner) = assembly.bodies[0].driven_mut() {
        inner.rotation = Rotation::Speed(Profile::SmoothRamp {
            from: 125.0,
            to: 190.0,
            start: 0.0,
            duration: 2e-3,
        });
    }
    let options = RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Fixed(2.5e-7),
        ..RunOptions::default()
    };
    let mut simulation = Simulation::new(assembly, options).unwrap();
    let mut spins = Vec::new();
    for step in 0..48_000 {
        simulation.step().unwrap();
        if step % 400 == 0 {
            let body = simulation.body(2);
            spins.push((body.spin[0], body.position));
        }
    }
    spins
}

/// Spins are compared over 12 ms, centres over the 3 ms with the first two impacts, relative to the speed at which balls
/// strike (the jerk of the ball set): a difference of speed grows with time.
#[test]
fn a_stiff_flexible_cage_moves_as_a_rigid_one() {
    let rigid = motion("contact = { at = \"nodes\" }", 1.0);
    let stiff = motion(&format!("{REDUCED}\nmodes_to = \"1 MHz\""), 1e4);
    let highest = stiff.iter().fold(0.0f64, |most, (spin, _)| most.max(*spin));
    assert!(highest > 60.0, "no ball has struck the cage: {highest} rad/s");
    for (k, ((rigid, there), (stiff, here))) in rigid.iter().zip(&stiff).enumerate() {
        assert!((rigid - stiff).abs() <= 0.01 * highest, "{rigid} and {stiff} rad/s");
        let way = norm(*there);
        let apart = norm(sub(*there, *here));
        assert!(k > 30 || apart <= 0.01 * way, "{apart} m of {way} m at row {k}");
    }
}

#[test]
fn a_state_with_a_flexible_cage_continues_with_the_same_bits() {
    let assembly = with_cage(REDUCED, 1200.0);
    let options = RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Fixed(2e-6),
        ..RunOptions::default()
    };
    let mut whole = Simulation::new(assembly.clone(), options).unwrap();
    for _ in 0..200 {
        whole.step().unwrap();
    }
    let mut rest =
        Simulation::from_state(assembly, options, whole.state.clone(), whole.time).unwrap();
    for _ in 0..200 {
        whole.step().unwrap();
        rest.step().unwrap();
    }
    assert!(whole.state[..BODY].iter().zip(&rest.state).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!(whole.state.len(), rest.state.len());
    let same = whole.state.iter().zip(&rest.state).filter(|(a, b)| a.to_bits() == b.to_bits());
    assert_eq!(same.count(), whole.state.len());
}

/// Load of a ball pressed by `depth` (m) into the wall of a pocket with stiffness `per_area` (N/m³), N: integrated over
/// the wall between the surfaces of the ring.
fn pressed(per_area: f64, depth: f64) -> f64 {
    let [pocket, inner, outer, pitch] = [6.5e-3, 29.125e-3, 33.375e-3, 30e-3];
    let centre = pocket - BALL + depth;
    let (across, along) = (2000, 400);
    let turn = std::f64::consts::PI / across as f64;
    let mut load = 0.0;
    for i in 0..across {
        let angle = -0.5 * std::f64::consts::PI + (i as f64 + 0.5) * turn;
        let (y, x) = (pocket * angle.cos(), pocket * angle.sin());
        let (low, high) = ((inner * inner - y * y).sqrt(), (outer * outer - y * y).sqrt());
        let step = (high - low) / along as f64;
        for j in 0..along {
            let z = low + (j as f64 + 0.5) * step - pitch;
            let arm = [x, y - centre, z];
            let found = BALL - norm(arm);
            if found > 0.0 {
                load += per_area * found * step * pocket * turn;
            }
        }
    }
    load
}

#[test]
fn a_stiffness_per_area_makes_the_load_independent_of_the_mesh() {
    let per_area = 1e13;
    let loads = ["{ quarter = 8, bar = 1, wall = 8 }", "{ quarter = 12, bar = 1, wall = 12 }"].map(|mesh| {
        let keys = format!("contact = {{ law = \"penalty\", at = \"nodes\", stiffness = \"{per_area} N/m^3\" }}\nmesh = {mesh}");
        let all = with_cage(&keys, 0.0);
        let nodes = all.bearings[0].cage.as_ref().unwrap().nodes.clone().unwrap();
        let body = BodyKinematics::new(BodyState::at_rest([0.0; 3]));
        let none: &[f64] = &[];
        let now = CageNow { body: &body, deformation: Deformation::Modes([none, none]), bound: 0.0 };
        [60e-6, 150e-6].map(|depth| {
            let of = &nodes.pockets[0];
            let ahead = cross([1.0, 0.0, 0.0], of.towards);
            let at = add_scaled(scale(of.towards, 30e-3), 6.5e-3 - BALL + depth, ahead);
            let ball = AxisMotion { position: at, axis: [1.0, 0.0, 0.0], ..AxisMotion::default() };
            let found = nodes.pocket(0, &now, &ball, BALL, &mut []);
            found.contact.normal_load
        })
    });
    for (k, depth) in [60e-6, 150e-6].into_iter().enumerate() {
        let whole = pressed(per_area, depth);
        for load in [loads[0][k], loads[1][k]] {
            assert!((load / whole - 1.0).abs() <= 0.02, "{load} N for {whole} N");
        }
    }
}
