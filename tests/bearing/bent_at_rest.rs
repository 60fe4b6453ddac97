//! Shafts that bend start where statics has them: bent, and still.

use crate::bent_shafts::{STEEL, on_bearings, section};
use crate::dynamics::*;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::equilibrium::initial::at_start;
use bearing_dynamics::equilibrium::statics::StaticsError;
use bearing_dynamics::kinematics::vec3::dot;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::flexible_shaft::{ShaftLoad, Unbalance};
use bearing_dynamics::members::rigid_body::BodyKinematics;
use bearing_dynamics::members::state::{SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Simulation, Start};
use bearing_dynamics::motion::start::at_equilibrium;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;

/// Loaded askew and along the axis, by its weight too; the shaft stands still, or turns.
fn askew(speed: f64) -> Assembly {
    let mut assembly = on_bearings(Profile::Constant(speed), STEEL);
    let force = [150.0, 220.0, -700.0].map(Profile::Constant);
    let at = section(&assembly, 0.3);
    assembly.shafts[0].loads.push(ShaftLoad { section: at, force });
    assembly.gravity = [0.0, 0.0, -9.81];
    for bearing in &mut assembly.bearings {
        bearing.traction = TractionLaw::None;
    }
    assembly
}

/// Nothing is pushed: neither the body nor its shapes, nor any ball, beside the loads that are in balance there.
#[test]
fn a_bent_start_is_an_equilibrium() {
    for (unbalance, internal_damping) in [(0.0, 0.0), (2e-3, 0.0), (2e-3, 2e3), (0.0, 2e3)] {
        let mut assembly = askew(0.0);
        if unbalance + internal_damping > 0.0 {
            assembly = askew(300.0);
        }
        if unbalance > 0.0 {
            // It pulls where it is at first.
            let section = section(&assembly, 0.1);
            assembly.shafts[0].unbalances.push(Unbalance { section, size: unbalance, angle: 0.7 });
        }
        // Drags the shaft across its bend.
        assembly.shafts[0].internal_damping = internal_damping;
        let equilibrium = at_start(&assembly).unwrap();
        let still = Assembly::clone(&assembly);
        let mut state = at_equilibrium(&assembly).unwrap();
        let mut system = System::new(still, Kernel::Simd);
        let mut rates = vec![0.0; state.len()];
        // Nothing but its spin moves: a tilting axis is pushed by gyroscopic moments.
        let (shaft, at) = (&assembly.shafts[0], system.shafts[0]);
        let (count, body) = (shaft.amplitudes(), system.places.body(0));
        state[at + count..at + 2 * count].fill(0.0);
        state[body + VELOCITY..body + VELOCITY + 3].fill(0.0);
        let now = BodyKinematics::new(system.body_state(&state, 0)).motion;
        for (i, axis) in now.axis.iter().enumerate() {
            state[body + SPIN + i] = dot(now.spin, now.axis) * axis;
        }
        system.evaluate(0.0, &state, &mut rates);
        let pushes = &rates[at + count..at + 2 * count];
        // A newton on a section pushes a shape by its deflection there, a tenth to one; statics stops at 1e-11 of the load
        // and of what rounding leaves of stiffness times radius.
        let largest = pushes.iter().fold(0.0f64, |most, push| most.max(push.abs()));
        assert!(largest <= 1e-5, "{unbalance} {internal_damping}: {pushes:?}");
        let deepest = equilibrium.amplitudes[0].iter().fold(0.0f64, |most, a| most.max(a.abs()));
        assert!(deepest > 1e-5, "it bends: {deepest:e}");
    }
}

/// It stays there to the nanometre, whatever its shapes could do.
#[test]
fn a_bent_start_stays_where_it_is() {
    let assembly = askew(0.0);
    let mut simulation = Simulation::new(assembly, fixed_step(5e-7, Start::Equilibrium)).unwrap();
    let middle = section(&simulation.system.assembly, 0.2);
    let at = |simulation: &Simulation| {
        simulation.system.section_now(&simulation.state, 0, &middle).motion.position
    };
    let before = at(&simulation);
    assert!(before[2] < -3e-5, "{before:?}");
    let mut farthest = 0.0f64;
    while simulation.time < 2e-3 {
        simulation.step().unwrap();
        let now = at(&simulation);
        farthest = (0..3).fold(farthest, |most, i| most.max((now[i] - before[i]).abs()));
    }
    // Without cage and traction nothing holds the balls against their weight along their orbit: they go 20 um in this time,
    // and the bearing gives 1e-5 of the sag. A start that is not bent right rings by part of the sag itself.
    assert!(farthest <= 1e-9, "{farthest:e}");
}

/// A load pulls at a free end: the shaft is longer by F L/(E A) between the bearing that holds it and there.
#[test]
fn a_pull_along_the_axis_stretches_the_shaft() {
    let force = 2000.0;
    let mut assembly = on_bearings(Profile::Constant(0.0), STEEL);
    assembly.bearings.clear();
    let shaft = assembly.shafts[0].body;
    // All that is rigid is held: what is left is the shaft against itself.
    for drive in &mut assembly.bodies[shaft].driven_mut().unwrap().drives {
        *drive = Drive::Motion(Profile::Constant(0.0));
    }
    for (at, sign) in [(0.0, -1.0), (0.4, 1.0)] {
        let section = section(&assembly, at);
        let force = [sign * force, 0.0, 0.0].map(Profile::Constant);
        assembly.shafts[0].loads.push(ShaftLoad { section, force });
    }
    let found = at_start(&assembly).unwrap();
    let ends: Vec<f64> = assembly.shafts[0]
        .loads
        .iter()
        .map(|load| {
            let amplitudes = &found.amplitudes[0];
            let first = amplitudes.len() - load.section.stretch.len();
            let gone = load.section.stretch.iter().zip(&amplitudes[first..]);
            gone.map(|(shape, amplitude)| shape * amplitude).sum()
        })
        .collect();
    let area = std::f64::consts::PI / 4.0 * 0.03 * 0.03;
    let expected = force * 0.4 / (STEEL * area);
    let ours = ends[1] - ends[0];
    assert!((ours / expected - 1.0).abs() <= 1e-9, "{ours:e} {expected:e}");
}

/// Damping inside that drags a spinning shaft about as hard as it springs back leaves no start, and is told before bodies are
/// looked for elsewhere.
#[test]
fn a_bend_that_is_dragged_as_hard_as_it_springs_back_is_refused() {
    let mut assembly = askew(300.0);
    let more = (0..20).map(|k| 2e3 * 1.15f64.powi(k));
    let refused = more.map(|damping| {
        assembly.shafts[0].internal_damping = damping;
        at_start(&assembly).err()
    });
    let refused = refused.flatten().next();
    assert_eq!(refused, Some(StaticsError::Dragged { body: "the shaft".into() }));
}
