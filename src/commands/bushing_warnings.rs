//! Warning about bushings displaced beyond the range of their fit.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::equilibrium::lists::StaticAssembly;
use bearing_dynamics::equilibrium::statics::AssemblySolution;
use bearing_dynamics::members::body::Mobility;
use bearing_dynamics::members::connection::Connection;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::rigid_body::{fixed, kinematics_at_mount};
use bearing_dynamics::numeric::clock::{display_time, to_digits};
use bearing_dynamics::output::recorder::Recorder;
use bearing_dynamics::output::session::Session;
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use bearing_dynamics::scene::build::assembly::{AssemblyScene, Spring};

/// Displacement of a sleeve, as a share of the wall, up to which its springs are used. They are fitted to small vibrations;
/// relaxed rubber is 2 % stiffer at a tenth of walls of 5 to 30 mm (test `springs_hold_up_to_a_tenth_of_the_wall`).
const SHARE_OF_WALL: f64 = 0.1;

/// Warning about the largest displacement of a sleeve as a `share` of its wall, and in a run its time, s.
fn beyond_fit(spring: &Spring, [share, time]: [f64; 2], in_run: bool) -> Option<Warning> {
    // An equilibrium uses the springs even of a bushing in elements.
    let of = spring.bushing.as_ref().filter(|of| !in_run || of.elements.is_none())?;
    (share > SHARE_OF_WALL).then(|| {
        let when = if in_run { format!(" at t = {} s", display_time(time)) } else { String::new() };
        let error = of.misses.iter().fold(0.0f64, |most, miss| most.max(*miss));
        let text = format!(
            "a sleeve of bushing {} moved by {} % of its wall{when}, more than {} %: its springs are fitted to small vibrations (0 to {} Hz, within \
             {} %) and are off by 2 % and more there: take a thicker wall, or write method = \"implicit\"",
            spring.name,
            to_digits(100.0 * share, 2),
            100.0 * SHARE_OF_WALL,
            display_time(of.fastest),
            to_digits(100.0 * error, 1)
        );
        Warning::new(WarningCode::BushingBeyondFit, text)
    })
}

/// Largest radial, axial or tilting displacement of a sleeve as a share of its wall; bodies at x, y, z (m) and tilts (rad).
fn share_of_wall(spring: &Spring, connection: &Connection, bodies: [[f64; 5]; 2]) -> f64 {
    let Some(of) = &spring.bushing else { return 0.0 };
    let end = |end: usize| kinematics_at_mount(&fixed(&bodies[end]), &connection.ends[end]);
    let (first, second) = (end(0), end(1));
    let [stretch, rotation, across] = connection.extension([&first, &second]);
    let lever = 0.5 * of.body.inner_diameter.hypot(of.body.length);
    stretch.max(across).max(lever * rotation) / of.body.thickness
}

pub fn of_equilibrium(
    scene: &AssemblyScene,
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> Vec<Warning> {
    let warning = |(spring, connection): (&Spring, &Connection)| {
        let bodies = connection.ends.map(|mount| solution.coordinates[mount.body].into());
        beyond_fit(spring, [share_of_wall(spring, connection, bodies), 0.0], false)
    };
    scene.springs.iter().zip(&assembly.connections).filter_map(warning).collect()
}

pub fn of_run(scene: &AssemblyScene, session: &Session) -> Vec<Warning> {
    let Some(assembly) = session.motion.assembly() else { return Vec::new() };
    let warning = |spring: &Spring| {
        let named = |of: &&Connection| of.label.as_ref() == Some(&spring.name);
        let connection = assembly.connections.iter().find(named)?;
        beyond_fit(spring, largest_share(assembly, &session.recorder, spring, connection)?, true)
    };
    scene.springs.iter().filter_map(warning).collect()
}

/// Largest share of the wall in any row, and its time, s; `None` if the table has no positions of the spring's ends.
fn largest_share(
    assembly: &Assembly,
    recorder: &Recorder,
    spring: &Spring,
    connection: &Connection,
) -> Option<[f64; 2]> {
    let [first, second] = &connection.ends;
    let ends = [columns(assembly, recorder, first)?, columns(assembly, recorder, second)?];
    let mut most = [0.0; 2];
    for row in 0..recorder.rows() {
        let values = recorder.row(row);
        let bodies = ends.map(|end| {
            let [x, y, z, tilt_y, tilt_z] = end.map_or([0.0; 5], |at| at.map(|at| values[at]));
            [x, y, z, tilt_y.to_radians(), tilt_z.to_radians()]
        });
        let share = share_of_wall(spring, connection, bodies);
        if share > most[0] {
            most = [share, values[0]];
        }
    }
    Some(most)
}

/// Columns of x, y, z (m) and both tilts (deg) of the body at an end; `Some(None)` if it is fixed at the origin.
fn columns(assembly: &Assembly, recorder: &Recorder, end: &Mount) -> Option<Option<[usize; 5]>> {
    let body = &assembly.bodies[end.body];
    if matches!(body.mobility, Mobility::Fixed) {
        return Some(None);
    }
    let race = assembly.bearings.iter().find_map(|bearing| {
        let side = bearing.mounts.iter().position(|mount| mount.body == end.body)?;
        Some(format!("{}{}", bearing.prefix(), ["inner", "outer"][side]))
    });
    let name = body.label.clone().or(race)?;
    let at = |what: &str| {
        let name = format!("{name}_{what}");
        recorder.columns().iter().position(|column| column.name == name)
    };
    Some(Some([at("x")?, at("y")?, at("z")?, at("tilt_y")?, at("tilt_z")?]))
}
