//! Several housings in explicit steps: threads, breaks, and what ends a run.

use super::several_housings::{
    Housing, fitted, housed, left, on_two, options, right, shaft, struck,
};

use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::members::body::Mobility;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingError};
use bearing_dynamics::output::session::{
    Checkpoint, HousedParts, Motion, Parts, RunRequest, Session, Status,
};
use bearing_dynamics::output::state::{self, StateRecord, Stopped};
use bearing_dynamics::plan::channels::ChannelGroup;

fn parts(threads: usize) -> HousedParts<'static> {
    // Enough elements for two threads each.
    let fine = |housing: Housing| Housing { around: 120, damping: 77.0, ..housing };
    let housings = [fine(left(true)), fine(Housing { wall: 8e-3, ..right(true) })];
    let (solids, seats) = [0, 1]
        .map(|index| fitted(&housings[index], index, Mount::at_centre(1 + index)))
        .into_iter()
        .unzip();
    let assembly = on_two(struck(10e-3), ContactDamping::None);
    HousedParts {
        assembly,
        solids,
        seats,
        bushings: Vec::new(),
        options: options(0.8, 0.25),
        threads,
    }
}

fn request(end: f64) -> RunRequest {
    RunRequest {
        options: options(0.8, 0.25).bearing,
        end,
        output_interval: 1e-5,
        fields_interval: None,
        channels: vec![ChannelGroup::Races],
    }
}

fn run(parts: HousedParts<'static>, end: f64) -> Session<'static> {
    let mut session = Session::start(Parts::Housed(Box::new(parts)), &request(end)).unwrap();
    while session.advance(1000).unwrap() != Status::Complete {}
    session
}

fn rows(session: &Session) -> Vec<u64> {
    session.series().unwrap().data().iter().map(|value| value.to_bits()).collect()
}

/// One, two and five threads give the same bits, and so does a run that was cut in two.
#[test]
fn neither_threads_nor_a_break_change_a_bit() {
    let whole = run(parts(1), 6e-5);
    let names: Vec<&str> = whole.recorder.columns().iter().map(|c| c.name.as_str()).collect();
    for name in
        ["left_housing_force_on_outer_z", "right_bore_nodes_touching", "left_work_on_housing"]
    {
        assert!(names.contains(&name), "{names:?}");
    }
    assert_eq!(names.iter().filter(|name| **name == "energy_coupled_residual").count(), 1);
    assert!(whole.watch.largest_residual <= 1e-4 * whole.watch.turned_over);
    for threads in [2, 5] {
        let shared = run(parts(threads), 6e-5);
        assert_eq!(rows(&shared), rows(&whole), "{threads} threads");
        let (Motion::Housed(a), Motion::Housed(b)) = (&shared.motion, &whole.motion) else {
            panic!("housed");
        };
        let shares = |part: usize| {
            let solid = &a.solids[part].solid;
            solid.elements_a_step() > solid.model.problem.elements.len()
        };
        assert_eq!(shares(0) || shares(1), threads > 2, "{threads} threads");
        for (a, b) in a.solids.iter().zip(&b.solids) {
            assert_eq!(a.solid.displacement, b.solid.displacement);
            assert_eq!(a.solid.rates(), b.solid.rates());
        }
    }
    // Cut in two, on other threads.
    let folder = tempfile::tempdir().unwrap();
    let mut first = run(parts(1), 3e-5);
    let fingerprint = state::fingerprint(&Parts::Housed(Box::new(parts(1))), &request(3e-5));
    let record = StateRecord { fingerprint, stopped: Stopped::Complete, error: None, seconds: 0.0 };
    state::save(folder.path(), &mut first, &record).unwrap();
    let kept = state::read(folder.path()).unwrap().expect("a state");
    let two = Parts::Housed(Box::new(parts(2)));
    let mut second = state::resume(folder.path(), &kept, two, &request(6e-5)).unwrap();
    while second.advance(1000).unwrap() != Status::Complete {}
    assert_eq!(rows(&second), rows(&whole));
    // One that lacks a seat is no state of this run.
    let mut lacking = kept.clone();
    let Checkpoint::Housed(of, _) = &mut lacking.sound.checkpoint else { panic!("a housing") };
    of.solids[1].seats.clear();
    let refused =
        state::resume(folder.path(), &lacking, Parts::Housed(Box::new(parts(1))), &request(6e-5));
    let Err(error) = refused else { panic!("a state without a seat") };
    assert!(error.to_string().contains("damaged"), "{error}");
}

#[test]
fn what_ends_a_run_has_a_name() {
    let (solid, mut seat) = fitted(&right(true), 0, Mount::at_centre(2));
    seat.nodes.clear();
    let assembly = || on_two(shaft(), ContactDamping::None);
    let refused = CoupledMotion::new(assembly(), vec![solid], vec![seat], &options(0.8, 0.25));
    let Err(error) = refused else { panic!("a seat without nodes") };
    assert!(error.to_string().starts_with("no node of the housing right is on a face"), "{error}");
    let mut fixed = assembly();
    fixed.bodies[2].mobility = Mobility::Fixed;
    let (solid, seat) = fitted(&right(true), 0, Mount::at_centre(2));
    let refused = CoupledMotion::new(fixed, vec![solid], vec![seat], &options(0.8, 0.25));
    let Err(error) = refused else { panic!("a race that is fixed") };
    assert_eq!(error, CouplingError::FixedRace { race: "the right outer race".into() });
    let mut housed = housed(assembly(), [left(true), right(true)], &options(0.8, 0.25));
    let at = housed.simulation.system.places.body(2);
    housed.simulation.state[at] += 6e-3;
    let error = housed.advance().expect_err("a race beside its seat");
    assert!(error.to_string().starts_with("the right outer race has left its bore"), "{error}");
}
