//! What is planned is what is done: each stage that a plan does has run as often as it says, and nothing else has run.
//!
//! Stages are counted by the code that does their work.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::{Assembly, INNER, OUTER};
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::equilibrium::lists::Place;
use bearing_dynamics::equilibrium::plan as statics;
use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::members::body::{Condition, RotatingLoad};
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::contacts::{Kernel, Want};
use bearing_dynamics::members::housing_fit::Seat;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::reduced_solid::{ModalLoad, ReducedSolid, Surface, SurfaceNode};
use bearing_dynamics::motion::plan::{Planned, items};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::plan::channels::ChannelGroup;
use bearing_dynamics::plan::counts::StageCounts;
use bearing_dynamics::plan::{Item, Stage, Subject, counted};
use common::{FREE, problem, table_4_1};
use dynamics::*;
use nalgebra::Vector3;

/// Every item ran as often as its cost says, at least once without one, never where it is skipped; nothing ran
/// without an item.
fn check(what: &str, plan: &[Item], ran: &StageCounts) {
    // Of a motion, and of a search for an equilibrium.
    let of = |stage| ran.of(stage, Subject::Whole);
    let evaluations = of(Stage::Ledger) + of(Stage::Evaluation);
    assert!(evaluations > 0, "{what}");
    for item in plan {
        let count = ran.of(item.stage, item.subject);
        match (item.does, item.cost) {
            (true, Some(cost)) => assert_eq!(count, cost * evaluations, "{what}: {item}"),
            (true, None) => assert!(count > 0, "{what}: {item}"),
            (false, _) => assert_eq!(count, 0, "{what}: {item}"),
        }
    }
    let unplanned: Vec<_> = counted(plan, ran).into_iter().skip(plan.len()).collect();
    assert!(unplanned.is_empty(), "{what}: {unplanned:?}");
}

/// A bearing with everything that it can have.
fn everything() -> DynamicProblem {
    let geometry = table_4_1(-20e-6);
    let mut all = bearing(geometry, [50.0, 0.0, -800.0, 0.0, 0.0], 1000.0 * RPM);
    all.traction = CONSTANT;
    all.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    all.gravity = GRAVITY;
    all.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
    let mut outer = free_race();
    outer.foundation_stiffness = [1e8, 1e8, 1e8, 1e4, 1e4];
    outer.foundation_damping = [1e3; 5];
    all.outer = Some(outer);
    let (force, speed) = (Profile::Constant(10.0), Profile::Constant(300.0));
    all.rotating_load = Some(RotatingLoad { force, speed, phase: 0.0 });
    all.unbalance = 1e-5;
    all
}

/// The same with a spring between the races and with a reduced ring round the outer one.
fn with_ring() -> Assembly {
    let mut assembly = everything().assembly();
    let law = SpringDashpot { stiffness: [1e6; 6], damping: [1.0; 6], ..SpringDashpot::default() };
    assembly.connections.push(Connection {
        name: "a spring".into(),
        label: None,
        ends: [INNER, OUTER].map(Mount::at_centre),
        law: Law::SpringDashpot(law),
    });
    let node = |turn: f64| SurfaceNode {
        node: 0,
        place: [0.0, 36e-3 * turn.cos(), 36e-3 * turn.sin()],
        normal: [0.0, turn.cos(), turn.sin()],
        area: 1e-4,
    };
    let nodes: Vec<SurfaceNode> = (0..8).map(|i| node(f64::from(i) * 0.785)).collect();
    let shapes = nodes.iter().map(|node| node.normal[1]).collect();
    assembly.solids.push(ReducedSolid {
        name: "the housing".into(),
        frequencies: vec![1e4],
        damping: 100.0,
        weight: vec![-9.81],
        loads: vec![ModalLoad { forces: vec![3.0], profile: Profile::Constant(1.0) }],
        surfaces: vec![Surface { nodes, shapes }],
        start: vec![0.0],
    });
    assembly.seats.push(Seat {
        name: "the bore".into(),
        label: None,
        race: Mount::at_centre(OUTER),
        solid: 0,
        surface: 0,
        radius: Profile::Constant(36.001e-3),
        width: 12e-3,
        rim: 1e-5,
        penalty: Penalty::PerArea(1e13),
        nominal: [0.0; 3],
        axis: [1.0, 0.0, 0.0],
    });
    assembly
}

type Change = fn(&mut Assembly);

/// Features, each taken out of an assembly that has all.
const WITHOUT: [(&str, Change); 15] = [
    ("nothing", |_| {}),
    ("traction", |a| a.bearings[0].traction = TractionLaw::None),
    ("damping", |a| a.bearings[0].damping = ContactDamping::None),
    ("a guide", |a| {
        if let Some(cage) = &mut a.bearings[0].cage {
            cage.contacts.guidance = Guidance::Balls;
        }
    }),
    ("a law between balls", |a| a.bearings[0].ball_contact = None),
    ("pockets that keep balls apart", |a| {
        if let Some(cage) = &mut a.bearings[0].cage {
            cage.contacts.pocket_radius *= 1.6;
        }
    }),
    ("gravity", |a| a.gravity = [0.0; 3]),
    ("a foundation", |a| {
        if let Some(outer) = a.bodies[OUTER].driven_mut() {
            (outer.foundation_stiffness, outer.foundation_damping) = ([0.0; 5], [0.0; 5]);
        }
    }),
    ("a rotating load", |a| a.bodies[INNER].rotating_load = None),
    ("an unbalance", |a| a.bodies[INNER].unbalance = 0.0),
    ("springs", |a| a.connections.clear()),
    ("weight of the ring", |a| a.solids[0].weight = vec![0.0]),
    ("a load on the ring", |a| a.solids[0].loads.clear()),
    ("damping of the ring", |a| a.solids[0].damping = 0.0),
    ("a ring", |a| {
        a.seats.clear();
        a.solids.clear();
    }),
];

#[test]
fn an_evaluation_does_what_is_planned_and_nothing_else() {
    for (what, take_out) in WITHOUT {
        let mut assembly = with_ring();
        take_out(&mut assembly);
        for driver in [Kernel::Scalar, Kernel::Simd] {
            let mut system = System::new(assembly.clone(), driver);
            let state = start::nominal(&assembly);
            let mut rates = vec![0.0; state.len()];
            for want in [Want::Forces, Want::ForcesAndSlopes, Want::Forces] {
                system.evaluate_with(want, 0.0, &state, &mut rates);
            }
            check(what, &system.plan, &system.ran);
        }
    }
}

/// What is taken out is planned out: the list of samples is one of features.
#[test]
fn each_feature_has_its_item() {
    let done = |assembly: Assembly| {
        let plan = System::new(assembly, Kernel::Simd).plan;
        plan.iter().filter(|item| item.does).count()
    };
    let whole = done(with_ring());
    for (what, take_out) in &WITHOUT[1..] {
        let mut assembly = with_ring();
        take_out(&mut assembly);
        let left = done(assembly);
        match *what {
            // Its balls are kept apart anyway.
            "a law between balls" => assert_eq!(left, whole),
            "pockets that keep balls apart" => assert_eq!(left, whole + 1),
            _ => assert!(left < whole, "{what}: {left} of {whole}"),
        }
    }
}

/// Of a whole run: start, steps, records of both integrators.
#[test]
fn a_run_does_what_is_planned_and_nothing_else() {
    let by_accuracy = (Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let by_limit = (Integrator::RungeKutta, Stepping::FractionOfLimit(0.5));
    for (integrator, stepping) in [by_accuracy, by_limit] {
        for start in [Start::Equilibrium, Start::Nominal] {
            let options =
                RunOptions { start, integrator, stepping, energy_limit: 1e9, ..Default::default() };
            let assembly = everything().assembly();
            let mut simulation = Simulation::new(assembly.clone(), options).unwrap();
            (0..5).for_each(|_| simulation.step().unwrap());
            let (assembly, options) = (&assembly, &options);
            let (channels, solids): (&[ChannelGroup], _) = (&[], Vec::new());
            let planned = Planned { assembly, options, channels, cage_left_out: &[], solids };
            let mut plan = items(planned);
            // The ledger is recorded with a session, of which this is none.
            plan.retain(|item| item.stage != Stage::EnergyChannels);
            check(integrator.name(), &plan, &simulation.system.ran);
        }
    }
}

/// A bearing alone has no connection, no solid, no seat and one race that stands still: nothing of them runs.
#[test]
fn a_bearing_alone_runs_over_nothing_that_it_does_not_have() {
    let alone = bearing(table_4_1(-20e-6), [0.0, 0.0, -800.0, 0.0, 0.0], 1000.0 * RPM);
    let mut simulation = simulation(&alone, 1e-6, Start::Nominal);
    run(&mut simulation, 10);
    let system = &simulation.system;
    let evaluations = system.work.evaluations;
    assert!(evaluations >= 40);
    let whole = Subject::Whole;
    let (bearing, inner) = (Subject::Bearing(0), Subject::Body(INNER));
    let expected = [
        (Stage::Ledger, whole, evaluations),
        (Stage::DistanceTest, bearing, 16 * evaluations),
        (Stage::BallContact, bearing, 8 * evaluations),
        (Stage::Motion, inner, evaluations),
    ];
    assert_eq!(system.ran.list(), expected);
}

#[test]
fn statics_does_what_is_planned_and_nothing_else() {
    let loaded = {
        let mut conditions = FREE;
        conditions[2] = Condition::Load(-800.0);
        conditions
    };
    let held = [0.0, 0.0, -5e-6, 0.0, 0.0].map(Condition::Displacement);
    for (what, conditions, gravity, speed, sprung) in [
        ("loaded", loaded, 0.0, 0.0, false),
        ("held", held, 0.0, 0.0, false),
        ("weight", loaded, -9.81, 0.0, false),
        ("weight of a held one", held, -9.81, 0.0, false),
        ("in orbit", loaded, 0.0, 50.0, false),
        ("on springs", loaded, -9.81, 50.0, true),
    ] {
        let mut task = problem(table_4_1(-5e-6), conditions);
        task.gravity = Vector3::new(0.0, 0.0, gravity);
        task.orbital_speed = speed;
        let mut assembly = task.assembly();
        if sprung {
            let law = SpringDashpot { stiffness: [1e6; 6], ..SpringDashpot::default() };
            assembly.connections.push(Connection {
                name: "a spring".into(),
                label: None,
                ends: [INNER, OUTER].map(Mount::at_centre),
                law: Law::SpringDashpot(law),
            });
            if let Place::Loaded(inner) = &mut assembly.bodies[INNER].place {
                inner.springs = [1e6, 0.0, 0.0, 1e3, 1e3];
            }
        }
        let plan = statics::items(&assembly, Vec::new(), statics::ASKED_FOR);
        let solution = solve_assembly(&assembly, None, &StaticOptions::default()).unwrap();
        check(what, &plan, &solution.ran);
    }
}
