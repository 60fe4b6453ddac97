//! How far the springs that stand for bushings hold, and where a run went beyond.

use bearing_dynamics::assembly::static_lists::StaticAssembly;
use bearing_dynamics::equilibrium::statics::AssemblySolution;
use bearing_dynamics::members::rigid_body;
use bearing_dynamics::members::rigid_body::kinematics_at_mount;
use bearing_dynamics::numeric::clock::{display_time, to_digits};
use bearing_dynamics::output::bushing_reach::{Beyond, beyond, farthest};
use bearing_dynamics::output::session::Session;
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use bearing_dynamics::scene::build::assembly::{AssemblyScene, BushingOfSpring, Spring};
use bearing_dynamics::scene::build::bushing_reach::{PART, reach};
use bearing_dynamics::solids::rubber::sleeve::SleeveMotion;

/// How far a bushing may move before the springs that stand for it stop holding; one line for each that is not solved in
/// elements.
pub fn of_bushings(scene: &AssemblyScene) -> Vec<String> {
    let said = |spring: &Spring| {
        let of = spring.bushing.as_ref()?;
        if of.elements.is_some() {
            return None;
        }
        let part = 100.0 * PART;
        let all = SleeveMotion::ALL.into_iter().map(|motion| reach(of, motion));
        Some(match all.collect::<Result<Vec<_>, _>>() {
            Ok(all) => {
                let reaches: Vec<String> =
                    SleeveMotion::ALL.into_iter().zip(all).filter_map(reaching).collect();
                let how = "relaxed rubber at large displacements, on a coarse mesh";
                let name = &spring.name;
                if reaches.is_empty() {
                    format!(
                        "the springs of bushing {name} are off by less than {part} % up to 30 % of its wall, by what they are at 5 %: {how}"
                    )
                } else {
                    let rest = if reaches.len() == SleeveMotion::ALL.len() {
                        ""
                    } else {
                        "; the other motions go to 30 % of its wall with less"
                    };
                    let reached = reaches.join(", ");
                    format!(
                        "the springs of bushing {name} are off by {part} % from {reached} on{rest}: {how}"
                    )
                }
            }
            Err(error) => {
                format!("how far the springs of bushing {} hold is not known: {error}", spring.name)
            }
        })
    };
    scene.springs.iter().filter_map(said).collect()
}

/// Part of a bushing's wall beyond which its springs are not those of small displacements.
const FAR_IN_WALL: f64 = 0.3;

/// Bushings that an equilibrium pushes far into their walls.
///
/// # Errors
/// One that is pushed through its wall.
pub fn pushed(
    scene: &AssemblyScene,
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> Result<Vec<Warning>, String> {
    let mut warnings = Vec::new();
    for (spring, connection) in scene.springs.iter().zip(&assembly.connections) {
        let Some(wall) = spring.bushing.as_ref().map(|of| of.body.thickness) else { continue };
        let ends = connection.ends.map(|mount| {
            kinematics_at_mount(
                &rigid_body::fixed(&solution.coordinates[mount.body].into()),
                &mount,
            )
        });
        let [gone, _] = connection.extension([&ends[0], &ends[1]]);
        refuse_through(&spring.name, gone, wall)?;
        if gone > FAR_IN_WALL * wall {
            let text = format!(
                "bushing {} is pushed by {:.3} mm into its wall of {:.3} mm, and its springs are fitted to small displacements: reduce the load, or \
                 make the bushing stiffer",
                spring.name,
                1e3 * gone,
                1e3 * wall
            );
            warnings.push(Warning::new(WarningCode::BushingBeyondFit, text));
        }
    }
    Ok(warnings)
}

fn refuse_through(name: &str, gone: f64, wall: f64) -> Result<(), String> {
    if gone < wall {
        return Ok(());
    }
    Err(format!(
        "bushing {name} is pushed by {:.3} mm, through its wall. Allowed: less than its thickness, {:.3} mm. Hint: reduce the load, or make the \
         bushing stiffer",
        1e3 * gone,
        1e3 * wall
    ))
}

/// "0.95 mm across"; nothing of a motion without end.
fn reaching((motion, amplitude): (SleeveMotion, f64)) -> Option<String> {
    amplitude.is_finite().then(|| match motion {
        SleeveMotion::Radial => format!("{} mm across", to_digits(1e3 * amplitude, 2)),
        SleeveMotion::Axial => format!("{} mm along", to_digits(1e3 * amplitude, 2)),
        SleeveMotion::Torsional => {
            format!("{} deg about its axis", to_digits(amplitude.to_degrees(), 2))
        }
        SleeveMotion::Conical => format!("{} deg tilting", to_digits(amplitude.to_degrees(), 2)),
    })
}

/// Springs of bushings that a run took beyond where they hold.
pub fn beyond_bushings(scene: &AssemblyScene, session: &Session) -> Vec<Warning> {
    let Some(assembly) = session.motion.assembly() else { return Vec::new() };
    let known = |of: &BushingOfSpring, motion| reach(of, motion).ok();
    let said = |beyond: Beyond| {
        let went = reaching((beyond.motion, beyond.reached))?;
        let holds = reaching((beyond.motion, beyond.holds))?;
        let text = format!(
            "bushing {} moves {went} at t = {} s: its springs, fitted to small vibrations, are {} % off from {holds} on",
            scene.springs[beyond.spring].name,
            display_time(beyond.time),
            100.0 * PART
        );
        Some(Warning::new(WarningCode::BushingBeyondFit, text))
    };
    beyond(scene, assembly, &session.recorder, known).into_iter().filter_map(said).collect()
}

/// Refuses a run that took a bushing through its wall.
///
/// # Errors
/// The bushing, and how far it went.
pub fn refuse_pushed_through(scene: &AssemblyScene, session: &Session) -> Result<(), String> {
    let Some(assembly) = session.motion.assembly() else { return Ok(()) };
    scene.springs.iter().try_for_each(|spring| {
        let Some(of) = &spring.bushing else { return Ok(()) };
        let Some(farthest) = farthest(assembly, &session.recorder, &spring.name) else {
            return Ok(());
        };
        refuse_through(&spring.name, farthest[0][0], of.body.thickness)
    })
}
