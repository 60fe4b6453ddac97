//! A shaft whose elements take explicit steps beside what sits on it.

use bearing_dynamics::kinematics::vec3::{Vec3, add, add_scaled, cross, norm, scale, sub};
use bearing_dynamics::motion::coupling::CoupledMotion;
use bearing_dynamics::output::session::{HousedParts, Motion, Parts, RunRequest, Session, Status};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::shaft::take_shafts;
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};

const SHIPPED: &str = include_str!("../../scenes/rotor_in_elements.toml");
const LOAD: &str = "load = [{ at = \"0 mm\", y = { half_sine = \"200 N\", duration = \"3 ms\" }, z = { smooth_ramp = [\"0 N\", \"-600 N\"], duration = \"2 ms\" } }]";

fn changed(changes: &[(&str, &str)]) -> AssemblyScene {
    let coarse = [("longest_layer = \"5 mm\"", "longest_layer = \"12.5 mm\"")];
    let mut text = SHIPPED.to_string();
    for (from, to) in coarse.iter().chain(changes) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let document = Document::read_str(&text, Format::Toml, "scene.toml").unwrap();
    let Subject::Assembly(scene) = resolve_subject(&document).unwrap() else { panic!("bearings") };
    *scene
}

/// Until `end` (s); its races turn the shaft or leave it to turn.
fn session(scene: &AssemblyScene, end: f64, turned: bool) -> Session<'static> {
    let mut assembly = scene.assembly().unwrap();
    let mut shafts = take_shafts(scene, &mut assembly).unwrap();
    let joints =
        shafts.iter_mut().flat_map(|shaft| shaft.part.shaft.as_mut().unwrap().joints.iter_mut());
    for joint in joints.filter(|_| !turned) {
        (joint.law.stiffness[3], joint.law.damping[3]) = (0.0, 0.0);
    }
    let run = scene.run().unwrap();
    let shafts = shafts.into_iter().map(|shaft| shaft.part).collect();
    let parts = HousedParts::without_housings(assembly, shafts, Vec::new(), &run.options);
    let request = RunRequest {
        options: run.options,
        end,
        output_interval: 0.05e-3,
        fields_interval: None,
        channels: run.channels.clone(),
    };
    Session::start(Parts::Housed(Box::new(parts)), &request).unwrap()
}

fn exchange<'s>(session: &'s Session<'static>) -> &'s CoupledMotion<'static> {
    let Motion::Housed(housed) = &session.motion else { panic!("elements") };
    housed
}

fn ended(mut session: Session<'static>) -> Session<'static> {
    while session.advance(1000).unwrap() != Status::Complete {}
    session
}

/// Momentum and moment of momentum about the origin of elements and what sits on them, at the bodies' time.
fn momenta(housed: &CoupledMotion) -> [Vec3; 2] {
    let (mut sum, mut about) = ([0.0; 3], [0.0; 3]);
    for part in &housed.solids {
        let solid = &part.solid;
        for (node, rate) in solid.rates().iter().enumerate() {
            // Displacements are half a step ahead, along the velocity: the moment is the same.
            let place = solid.model.problem.nodes[node];
            let now = add(place, [0, 1, 2].map(|i: usize| solid.displacement[node][i]));
            let own = scale([rate[0], rate[1], rate[2]], solid.model.mass[node]);
            sum = add(sum, own);
            about = add(about, cross(now, own));
        }
        for now in part.shaft.iter().flat_map(|shaft| &shaft.joints) {
            let index = now.joint.body;
            let inertia = housed.simulation.system.assembly.bodies[index].inertia().unwrap();
            let body = housed.simulation.body(index);
            let own = scale(body.velocity, inertia.mass);
            sum = add(sum, own);
            let axis = body.axis();
            let along: f64 = axis.iter().zip(body.spin).map(|(a, b)| a * b).sum();
            let spin = add_scaled(
                scale(body.spin, inertia.transverse),
                (inertia.axial - inertia.transverse) * along,
                axis,
            );
            about = add(about, add(cross(body.position, own), spin));
        }
    }
    [sum, about]
}

/// Balls that touch nothing: the shaft is free. A blow in the middle leaves it with its impulse, and with the moment of momentum that it
/// had, spinning at 6000 rpm and bending. Races turn at a given speed, and do not turn the shaft here: a twist of its ends would be a torque.
#[test]
fn a_free_shaft_keeps_its_momenta() {
    let blow = "load = [{ at = \"0 mm\", z = { half_sine = \"-300 N\", start = \"0.1 ms\", duration = \"0.4 ms\" } }]";
    let free = "clearance = { radial = \"100 um\" }";
    let scene = changed(&[(LOAD, blow), ("clearance = { radial = \"0 um\" }", free)]);
    let start = session(&scene, 0.6e-3, false);
    let [first, _] = momenta(exchange(&start));
    let ended = ended(start);
    let housed = exchange(&ended);
    let [sum, about] = momenta(housed);
    // What the steps have summed up of the blow.
    let solid = &housed.solids[0].solid;
    let (h, steps) = (solid.step_size, solid.steps);
    let during = |t: f64| (0.1e-3..0.5e-3).contains(&t);
    let pushed = |t: f64| 300.0 * libm::sin(std::f64::consts::PI * (t - 0.1e-3) / 0.4e-3);
    let times = (0..steps).map(|k| (k as f64 + 0.5) * h).filter(|t| during(*t));
    let impulse: f64 = times.map(|t| h * pushed(t)).sum();
    assert!((impulse / (300.0 * 0.8e-3 / std::f64::consts::PI) - 1.0).abs() <= 1e-5);
    let left = norm(sub(sub(sum, first), [0.0, 0.0, -impulse]));
    assert!(left <= 1e-9 * impulse, "{sum:?} {impulse}");
    // Once the blow, which acts where the section has gone, is over.
    let [_, before] = momenta(exchange(&self::ended(session(&scene, 0.5e-3, false))));
    let turned = norm(sub(about, before));
    assert!(turned <= 1e-9 * norm(before), "{about:?} {before:?}");
}

/// The ledger of elements, joints, races and bearings closes through a load, a spin-up and an unbalance.
#[test]
fn the_ledger_of_all_parts_closes() {
    let unbalance = "unbalance = [{ at = \"0 mm\", size = \"1e-3 kg m\" }]";
    let rising = "speed = { smooth_ramp = [\"0 rpm\", \"10000 rpm\"], duration = \"1.5 ms\" }";
    let driven = [(LOAD, unbalance), ("speed = \"6000 rpm\"", rising)];
    // Of curved faces nodes have negative parts; taken for positive they put the centre 30 µm beside the axis, where a load does
    // other work as it turns.
    let ten = "order = 2, method = \"explicit\", longest_layer = \"12.5 mm\", around = 8";
    let four = "order = 1, method = \"explicit\", longest_layer = \"12.5 mm\"";
    let beside = [(LOAD, unbalance), (four, ten)];
    for changes in [&[][..], &driven, &beside] {
        let ended = ended(session(&changed(changes), 2e-3, true));
        let series = ended.series().unwrap();
        let of = |name: &str| series.column(name).unwrap().to_vec();
        let largest = |list: Vec<f64>| list.into_iter().map(f64::abs).fold(0.0, f64::max);
        let work = largest(of("shaft_work_loads")) + largest(of("shaft_work_unbalance"));
        let left = largest(of("energy_coupled_residual"));
        // CouplingSteps and steps are of second order: 1e-3 is what runs are held to, this one has 1e-5.
        assert!(work > 1e-3 && left <= 1e-4 * work, "{left} {work}");
        assert!(largest(of("shaft_heat_joints")) > 0.0);
    }
}

/// What a shaft turns over is not its spin, 51 J that stay whatever happens: a tenth of them could go missing unseen.
#[test]
fn the_spin_is_not_turned_over() {
    let start = session(&changed(&[(LOAD, "")]), 0.2e-3, true);
    let Motion::Housed(mut housed) = ended(start).motion else { panic!("elements") };
    let snapshot = housed.snapshot().unwrap();
    let kinetic = snapshot.solids[0].ledger.energy.kinetic;
    // What is left are balls, and the stretch that the spin begins with: ten-thousandths of the spin.
    assert!(
        kinetic > 45.0 && snapshot.turned_over <= 1e-3 * kinetic,
        "{kinetic} {}",
        snapshot.turned_over
    );
    // Of the drive's work and of the load's nothing is taken away.
    let pushed = ended(session(&changed(&[]), 2e-3, true));
    let series = pushed.series().unwrap();
    let work =
        series.column("shaft_work_loads").unwrap().iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let Motion::Housed(mut housed) = pushed.motion else { panic!("elements") };
    assert!(housed.snapshot().unwrap().turned_over >= work, "{work}");
}

/// With springs under the races so stiff that they are the fastest thing, steps are as short as they ask for, and energy is kept.
#[test]
fn steps_know_the_springs_of_races() {
    let stiff = "method = \"explicit\", race_stiffness = \"2e12 N/m\", race_damping = \"0 N s/m\"";
    // Discs so heavy that they do not shorten the coupling steps.
    let heavy = "mass = \"6 kg\", axial = \"20 kg m^2\", transverse = \"10 kg m^2\"";
    let disc = "mass = \"60 g\", axial = \"1.8e-5 kg m^2\", transverse = \"1e-5 kg m^2\"";
    let still = ("speed = \"6000 rpm\"", "speed = \"0 rpm\"");
    let scene = changed(&[("method = \"explicit\"", stiff), (disc, heavy), still]);
    let soft = session(&changed(&[(disc, heavy), still]), 0.1e-3, true);
    let start = session(&scene, 0.1e-3, true);
    let [soft, stiff] = [&soft, &start].map(|of| exchange(of).solids[0].solid.step_size);
    // Of nodes that have a part each of 12.5 mm of the shaft, 0.07 kg in all: √(2e12/0.07) 1/s and more.
    assert!(stiff < 0.35e-6 && stiff < 0.8 * soft, "{stiff} {soft}");
    let ended = ended(start);
    let series = ended.series().unwrap();
    let left = series.column("energy_coupled_residual").unwrap().to_vec();
    assert!(left.iter().all(|left| left.abs() <= 1e-6), "{left:?}");
}

/// Dashpots see velocities that are half a step old: where they are strong, steps and coupling steps are short enough for it.
#[test]
fn strong_dashpots_do_not_make_energy() {
    let strong = "method = \"explicit\", race_damping = \"1e5 N s/m\"";
    let scene = changed(&[("method = \"explicit\"", strong)]);
    let start = session(&scene, 0.1e-3, true);
    let [coupling_step, step] =
        [exchange(&start).coupling_step, exchange(&start).solids[0].solid.step_size];
    // 1e5 N s/m on a race of 60 g; 90 N m s/rad on 1e-5 kg m².
    assert!(coupling_step <= 0.5 * 1e-5 / 90.0 && step <= coupling_step, "{coupling_step} {step}");
    let ended = ended(start);
    let left = ended.series().unwrap().column("energy_coupled_residual").unwrap().to_vec();
    assert!(left.iter().all(|left| left.abs() <= 1e-6), "{left:?}");
}

/// A watched section is told where it is at the bodies' time: midway between where its nodes are, half a step later, and where
/// they were a step before that.
#[test]
fn a_watched_section_is_told_at_the_time_of_its_row() {
    let session = ended(session(&changed(&[]), 0.1e-3, true));
    let part = &exchange(&session).solids[0];
    let (solid, shaft) = (&part.solid, part.shaft.as_ref().unwrap());
    let three = |of: [f64; 4]| [of[0], of[1], of[2]];
    let rate = |node: u32| three(solid.rates()[node as usize]);
    let place = |steps: f64| {
        let at = |node: u32| {
            let now = three(solid.displacement[node as usize]);
            add_scaled(now, -steps * solid.step_size, rate(node))
        };
        shaft.probes[0].1.place(at, rate).centre
    };
    let (later, earlier) = (place(0.0), place(1.0));
    let centre = shaft.probe_centres(solid).next().unwrap();
    let step = norm(sub(later, earlier));
    let off = norm(sub(centre, scale(add(later, earlier), 0.5)));
    // What the section turns by in half a step, 3e-5, of the 30 µm that its area's centre may stand beside the axis.
    assert!(step > 1e-12 && off <= 1e-2 * step, "{off:e} of {step:e}");
}
