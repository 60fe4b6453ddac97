//! How far the springs that stand for bushings hold, and where a run went beyond.

use bearing_dynamics::output::bushing_reach::{Beyond, beyond};
use bearing_dynamics::output::session::Session;
use bearing_dynamics::scene::assembly::{
    AssemblyScene, BushingInElements, BushingOfSpring, BushingStepping, Spring, SpringAt, SpringEnd,
};
use bearing_dynamics::scene::bushing_reach::{PART, reach};
use bearing_dynamics::solver::clock::{to_digits, told};
use bearing_dynamics::solver::solid::rubber::sleeve::SleeveMotion;

/// How far a bushing may move before the springs that stand for it stop holding; one line for each that is not solved in
/// elements.
pub fn of_bushings(scene: &AssemblyScene) -> Vec<String> {
    let said = |spring: &Spring| {
        let of = spring.bushing.as_ref()?;
        if let Some(elements) = &of.elements {
            return four_nodes(&spring.name, elements);
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

/// A bushing that does not go round the outer race that it ends at, or stands beside it.
pub fn beside_its_race(scene: &AssemblyScene, spring: &Spring) -> Option<String> {
    let of = &spring.bushing.as_ref()?.body;
    let at_race = |end: &SpringEnd| match end.at {
        SpringAt::Race { bearing, side: 1 } => Some((&scene.bearings[bearing].scene, end.along)),
        _ => None,
    };
    let (race, along) = spring.ends.iter().find_map(at_race)?;
    let sizes = &race.dimensions;
    let race_diameter = 2.0 * sizes.outer_radius.unwrap_or(race.geometry.race_radii().1);
    let race_length = sizes.length.unwrap_or(2.0 * race.geometry.ball_radius);
    let millimetres = |length: f64| told(1e3 * length);
    if of.inner_diameter < race_diameter * (1.0 - 1e-9) {
        return Some(format!(
            "the rubber of bushing {} begins at a diameter of {} mm, inside the outer race that it holds, of {} mm: check both",
            spring.name,
            millimetres(of.inner_diameter),
            millimetres(race_diameter)
        ));
    }
    let farthest = 0.5 * (of.length + race_length);
    (along.abs() > farthest).then(|| {
        format!(
            "bushing {} holds the outer race {} mm beside the race's middle, farther than both are long: check `from_at` and `to_at`, which \
             count from the middle of what they belong to, of the ground along X",
            spring.name,
            millimetres(along.abs())
        )
    })
}

/// Elements of explicit steps are stiffer than rubber, the coarser the more.
fn four_nodes(name: &str, elements: &BushingInElements) -> Option<String> {
    let is_explicit = matches!(elements.stepping, BushingStepping::Explicit { .. });
    is_explicit.then(|| {
        format!(
            "bushing {name} moves in elements of four nodes, which are stiffer than its rubber, the coarser the more: hold a \
             run with finer cells, or with method = \"implicit\", against it"
        )
    })
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

/// What a run says of its bushings: elements that are too stiff, and springs that it took beyond where they hold.
pub fn beyond_bushings(scene: &AssemblyScene, session: &Session) -> Vec<String> {
    let Some(assembly) = session.motion.assembly() else { return Vec::new() };
    let known = |of: &BushingOfSpring, motion| reach(of, motion).ok();
    let said = |beyond: Beyond| {
        let went = reaching((beyond.motion, beyond.reached))?;
        let holds = reaching((beyond.motion, beyond.holds))?;
        let wall = scene.springs[beyond.spring].bushing.as_ref()?.body.thickness;
        let through = matches!(beyond.motion, SleeveMotion::Radial) && beyond.reached >= wall;
        let through = match through {
            true => format!(
                "; its wall is {} mm, beyond it nothing but springs is there",
                to_digits(1e3 * wall, 3)
            ),
            false => String::new(),
        };
        Some(format!(
            "bushing {} went {went} at t = {} s: its springs, fitted to small vibrations, are off by {} % from {holds} on, \
             and more beyond{through}",
            scene.springs[beyond.spring].name,
            told(beyond.time),
            100.0 * PART
        ))
    };
    let of_elements = scene
        .springs
        .iter()
        .filter_map(|spring| four_nodes(&spring.name, spring.bushing.as_ref()?.elements.as_ref()?));
    let of_springs = beyond(scene, assembly, &session.recorder, known).into_iter().filter_map(said);
    of_elements.chain(of_springs).collect()
}
