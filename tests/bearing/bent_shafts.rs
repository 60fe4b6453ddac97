//! Shafts that bend, alone, on springs and on bearings, what acts on them, and how far they go off their axis.

use crate::{common, dynamics, shafts};

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::members::beam::{Beam, BeamDisc, BeamSegment};
use bearing_dynamics::members::body::{DrivenBody, GROUND, Mobility, Rotation};
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::flexible_shaft::{ElasticShaft, Section, ShaftLoad, Unbalance};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::shaft_modes::{Kept, free_shaft};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use common::table_4_1;
use dynamics::*;
use shafts::{body, seated};

/// 30 mm steel, 400 mm, in two elements, with a disc.
pub fn beam(disc: BeamDisc, youngs_modulus: f64) -> Beam {
    let segment = BeamSegment {
        length: 0.4,
        outer_diameter: 30e-3,
        inner_diameter: 0.0,
        density: 7850.0,
        youngs_modulus,
        poisson_ratio: 0.3,
    };
    Beam { discs: vec![disc], longest_element: 0.2001, ..Beam::new(vec![segment]) }
}
pub const STEEL: f64 = 210e9;
pub const OVERHUNG: BeamDisc = BeamDisc { at: 0.4, mass: 3.0, axial: 0.02, transverse: 0.011 };
pub const MIDDLE: BeamDisc = BeamDisc { at: 0.2, mass: 20.0, axial: 0.09, transverse: 0.05 };
pub const OFF_MIDDLE: BeamDisc = BeamDisc { at: 0.3, ..MIDDLE };

/// An assembly of the shaft alone, turning at `speed` (rad/s), its sections at `holds` (m from its end) asked for.
pub fn alone(beam: &Beam, kept: Kept, holds: &[f64], speed: f64) -> Assembly {
    let holds: Vec<(f64, bool)> = holds.iter().map(|at| (*at, true)).collect();
    let (rigid, shapes) = free_shaft(beam, kept, &holds, &[]).unwrap();
    let inertia = Inertia { mass: rigid.mass, axial: rigid.axial, transverse: rigid.transverse };
    let spinning = race([0.0; 5], Rotation::Speed(Profile::Constant(speed)));
    let spinning = DrivenBody { inertia, ..spinning };
    Assembly {
        bodies: vec![
            body(
                "the shaft",
                Mobility::Driven(spinning.into()),
                [rigid.centre, 0.0, 0.0, 0.0, 0.0],
            ),
            body(GROUND, Mobility::Fixed, [0.0; 5]),
        ],
        shafts: vec![ElasticShaft { shapes, ..ElasticShaft::default() }],
        ..Assembly::default()
    }
}

/// From the body's centre to `at` from the shaft's end, m.
pub fn along(assembly: &Assembly, at: f64) -> f64 {
    at - assembly.bodies[0].rest[0]
}

pub fn section(assembly: &Assembly, at: f64) -> Section {
    assembly.shafts[0].shapes.section(along(assembly, at))
}

/// Puts the shaft on springs to the ground at these places (m from its end).
pub fn on_springs(assembly: &mut Assembly, places: &[f64], stiffness: [f64; 3]) {
    for &at in places {
        let [x, y, z] = stiffness;
        let law = SpringDashpot { stiffness: [x, y, z, 0.0, 0.0, 0.0], ..Default::default() };
        let shaft = Mount { along: along(assembly, at), ..Mount::at_centre(0) };
        let ground = Mount { along: at, ..Mount::at_centre(1) };
        assembly.connections.push(Connection {
            name: "a spring".into(),
            label: None,
            ends: [ground, shaft],
            law: Law::SpringDashpot(law),
        });
    }
}

pub fn unbalanced(size: f64, assembly: &Assembly, at: f64) -> Unbalance {
    Unbalance { section: section(assembly, at), size, angle: 0.4 }
}

pub fn run(assembly: Assembly, integrator: Integrator, stepping: Stepping, end: f64) -> Simulation {
    let options =
        RunOptions { start: Start::Nominal, integrator, stepping, ..RunOptions::default() };
    let mut simulation = Simulation::new(assembly, options).unwrap();
    simulation.snapshot();
    while simulation.time < end * (1.0 - 1e-12) {
        let step = simulation.step_size.min(end - simulation.time);
        simulation.step_by(step).unwrap();
    }
    simulation.snapshot();
    simulation
}

/// Off the axis at a place, m.
pub fn off(simulation: &Simulation, at: f64) -> f64 {
    let assembly = &simulation.system.assembly;
    let section = section(assembly, at);
    let [_, y, z] = simulation.system.section_now(&simulation.state, 0, &section).state.position;
    y.hypot(z)
}

/// The rotor of 4.3.4 on two bearings, at a speed that rises.
pub fn on_bearings(speed: Profile, youngs_modulus: f64) -> Assembly {
    let beam = beam(MIDDLE, youngs_modulus);
    let mut assembly = alone(&beam, Kept { most: 4, ..Kept::ALL }, &[0.0, 0.2, 0.4], 0.0);
    assembly.bodies[0].driven_mut().unwrap().rotation = Rotation::Speed(speed);
    assembly.bodies[1].rest = [0.0; 5];
    assembly.bodies.push(body("the other outer race", Mobility::Fixed, [0.4, 0.0, 0.0, 0.0, 0.0]));
    let ends = [along(&assembly, 0.0), along(&assembly, 0.4)];
    let geometry = table_4_1(-2e-6);
    assembly.bearings = vec![
        seated(geometry, "left", ends[0], false, 1),
        seated(geometry, "right", ends[1], false, 2),
    ];
    assembly
}

pub fn rising(to: f64, within: f64) -> Profile {
    Profile::Ramp { from: 0.0, to, start: 0.0, duration: within }
}

pub fn loaded(assembly: &mut Assembly, at: f64, [y, z]: [f64; 2]) {
    let force =
        [0.0, y, z].map(|force| Profile::Ramp { from: 0.0, to: force, start: 0.0, duration: 2e-3 });
    let section = section(assembly, at);
    assembly.shafts[0].loads.push(ShaftLoad { section, force });
}
