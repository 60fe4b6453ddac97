//! Scenes of bearings in motion: what is written becomes what is simulated.

use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::scene::dynamics::{dynamic_problem, run_options};
use bearing_dynamics::scene::{self, CageInRun};
use bearing_dynamics::solver::dynamics::run::{Simulation, Start, Stepping};
use std::path::{Path, PathBuf};

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

#[test]
fn the_settling_scene_is_frictionless_and_damped() {
    let scene = scene::read_file(&shipped("settling.toml")).unwrap();
    let problem = dynamic_problem(&scene).unwrap();
    assert_eq!(problem.traction, TractionLaw::None);
    assert_eq!(problem.damping, ContactDamping::HuntCrossley { alpha: 1.0 });
    assert!(problem.cage.is_none() && problem.outer.is_none());
    let CageInRun::LeftOut(reason) = &scene.dynamics.cage else { panic!("there is a cage") };
    assert_eq!(reason, "the scene has no cage");
    let run = run_options(&scene).unwrap();
    assert_eq!((run.end, run.output_interval, run.window_start), (0.05, 5e-5, 0.025));
    assert_eq!(run.options.start, Start::Nominal);
    assert_eq!(run.options.stepping, Stepping::FractionOfLimit(0.5));
    Simulation::new(problem, run.options).unwrap();
}
