//! Run-ups that try a bent shaft: right, or a typed error.

use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::motion::error::SimulationError;
use bearing_dynamics::motion::simulation::Simulation;
use bearing_dynamics::output::session::{RunRequest, Session};
use bearing_dynamics::plan::channels::ChannelGroup;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};

const SHIPPED: &str = include_str!("../../scenes/rotor_run_up.toml");
const DAMPING: &str = "damping = \"100 1/s\"                      # of all motion, as (2.7)\n";
const CLEARANCE: &str = "clearance = { radial = \"0 um\" }";

/// Largest deflection of the middle, m, and the largest energy unaccounted for over what was turned over.
struct Passage {
    peak: f64,
    residual: f64,
}

/// The shipped scene with these words changed, in coarse steps.
fn changed(changes: &[(&str, &str)]) -> AssemblyScene {
    let mut text = SHIPPED.replace("end = \"0.2 s\"", "end = \"0.2 s\"\naccuracy = 0.01");
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let document = Document::read_str(&text, Format::Toml, "run_up.toml").unwrap();
    let Subject::Assembly(scene) = resolve_subject(&document).unwrap() else { panic!("bearings") };
    *scene
}

fn run_up(changes: &[(&str, &str)]) -> Result<Passage, SimulationError> {
    let scene = changed(changes);
    let run = scene.run().unwrap();
    let mut simulation = Simulation::new(scene.assembly().unwrap(), run.options)?;
    let (_, middle) = simulation.system.assembly.shafts[0].probes[0].clone();
    let mut passage = Passage { peak: 0.0, residual: 0.0 };
    let (mut stored, mut rows) = (0.0f64, 0.0);
    while simulation.time < run.end * (1.0 - 1e-12) {
        simulation.step_by(simulation.step_size.min(run.end - simulation.time))?;
        let now = simulation.system.section_now(&simulation.state, 0, &middle).state.position;
        passage.peak = passage.peak.max(now[1].hypot(now[2]));
        if simulation.time >= rows * 1e-3 {
            rows += 1.0;
            let now = simulation.snapshot();
            let work: f64 = now.ledger.iter().map(|entry| entry.abs()).sum();
            stored = stored.max(work + now.energy.bending_strain + now.energy.contact);
            passage.residual = passage.residual.max(now.residual.abs());
        }
    }
    passage.residual /= stored;
    Ok(passage)
}

/// What an accuracy is a part of is the overlap of contacts: without bearings a run would take steps as long as its rows, however wrong.
#[test]
fn an_accuracy_wants_a_bearing() {
    let scene = changed(&[]);
    let mut assembly = scene.assembly().unwrap();
    assembly.bearings.clear();
    let refused = Simulation::new(assembly, scene.run().unwrap().options);
    assert_eq!(refused.err(), Some(SimulationError::NothingToMeasure));
}

/// Columns of moments begin with what statics has of the same loads: the shaft sags, its races tilt.
#[test]
fn moments_of_a_start_are_those_of_its_equilibrium() {
    let unbalance = "unbalance = [{ at = \"0 mm\", size = \"1e-3 kg m\" }]";
    let load = "load = [{ at = \"30 mm\", y = \"400 N\", z = \"-2000 N\" }]";
    let ramp =
        "speed = { ramp = [\"0 rpm\", \"10000 rpm\"], start = \"0 s\", duration = \"0.2 s\" }";
    let scene = changed(&[
        (unbalance, load),
        (ramp, "speed = \"0 rpm\""),
        ("start = \"nominal\"", "start = \"equilibrium\""),
    ]);
    let run = scene.run().unwrap();
    let request = RunRequest {
        options: run.options,
        end: run.end,
        output_interval: run.output_interval,
        fields_interval: None,
        channels: vec![ChannelGroup::Moments],
    };
    let session = Session::start(scene.assembly().unwrap(), &request).unwrap();
    let series = session.series().unwrap();
    let still = solve_assembly(&scene.statics().unwrap(), None, &StaticOptions::default()).unwrap();
    for (bearing, name) in ["left", "right"].into_iter().enumerate() {
        for (side, race) in ["inner", "outer"].into_iter().enumerate() {
            let moment = still.bearings[bearing].moments[side];
            for (axis, stated) in ["x", "y", "z"].into_iter().zip(moment.iter()) {
                let column = format!("{name}_contact_moment_on_{race}_{axis}");
                let first = series.column(&column).unwrap()[0];
                // Statics stops at 1e-11 of the loads; rolling balls are held a little apart from where it has them.
                assert!(
                    (first - stated).abs() <= 1e-5 * moment.norm(),
                    "{column}: {first} {stated}"
                );
            }
            assert!(moment.norm() >= 1.0, "{moment}");
        }
    }
}

/// Without damping the peak is higher, and the books stay closed.
#[test]
fn a_rotor_without_damping_passes_its_critical_speed() {
    let damped = run_up(&[]).unwrap();
    let free = run_up(&[(DAMPING, "")]).unwrap();
    println!("{:e} {:e} m, {:e} {:e}", damped.peak, free.peak, damped.residual, free.residual);
    assert!(free.peak >= 1.1 * damped.peak && free.peak <= 4.0 * damped.peak, "{:e}", free.peak);
    // Steps of an accuracy of 1e-2.
    assert!(damped.residual <= 1e-2 && free.residual <= 1e-2, "{:e}", free.residual);
}

/// A hundred times the disc: far above its critical speed the heavy one turns about its centre of mass,
/// its unbalance over its mass off the axis.
#[test]
fn a_heavy_disc_passes() {
    let passage = run_up(&[("mass = \"20 kg\"", "mass = \"2000 kg\"")]).unwrap();
    println!("{:e} m, {:e}", passage.peak, passage.residual);
    assert!(passage.peak >= 1e-7 && passage.peak <= 2e-6, "{:e}", passage.peak);
    assert!(passage.residual <= 1e-2, "{:e}", passage.residual);
}

/// With 50 um of clearance balls are lost and struck again.
#[test]
fn lost_contact_is_passed() {
    let passage = run_up(&[(CLEARANCE, "clearance = { radial = \"50 um\" }")]).unwrap();
    println!("{:e} m, {:e}", passage.peak, passage.residual);
    assert!(passage.peak >= 5e-5 && passage.peak <= 1e-3, "{:e}", passage.peak);
    assert!(passage.residual <= 0.05, "{:e}", passage.residual);
}

#[test]
fn an_overhung_disc_on_unequal_bearings_passes() {
    let overhung = [
        ("inner_at = \"200 mm\"", "inner_at = \"100 mm\"\nballs = 6"),
        ("disc = [{ at = \"0 mm\"", "disc = [{ at = \"200 mm\""),
        (
            "unbalance = [{ at = \"0 mm\", size = \"1e-3",
            "unbalance = [{ at = \"200 mm\", size = \"1e-4",
        ),
    ];
    let passage = run_up(&overhung).unwrap();
    println!("{:e} m, {:e}", passage.peak, passage.residual);
    assert!(passage.peak >= 1e-6 && passage.peak <= 1e-3, "{:e}", passage.peak);
    assert!(passage.residual <= 1e-2, "{:e}", passage.residual);
}

/// 1000 N at the overhung end of a shaft of a third of the diameter bend it beyond what its theory stands for.
#[test]
fn a_shaft_that_bends_too_far_ends_the_run() {
    let unbalance = "unbalance = [{ at = \"0 mm\", size = \"1e-3 kg m\" }]";
    let thin = [
        ("outer_diameter = \"30 mm\"", "outer_diameter = \"10 mm\""),
        ("inner_at = \"200 mm\"", "inner_at = \"0 mm\""),
        (unbalance, "load = [{ at = \"200 mm\", z = \"-1000 N\" }]"),
    ];
    match run_up(&thin) {
        Err(SimulationError::BentTooFar { turn, allowed, .. }) => assert!(turn > allowed),
        Err(other) => panic!("{other}"),
        Ok(passage) => panic!("{:e} m", passage.peak),
    }
}
