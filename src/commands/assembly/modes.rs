//! `bearing modes` of bearings and what they sit on and in: natural motions of the bodies about their equilibrium.
//!
//! Balls are springs without mass of their own. A housing takes part with the shapes that it has under its race, and with some of
//! its natural ones.

use super::Fallible;
use super::housing::Housing;
use super::housings::{self, Equilibrium};
use super::lists::Lists;
use super::whirl::{Spinning, rpm};
use super::{plan, record};
use crate::commands::asked::Asked;
use crate::commands::earlier::{Writes, remove_earlier};
use crate::commands::memory::{refuse_beyond, spun};
use crate::commands::remarks::of_balls_at_speed;
use crate::commands::scene_remarks::at_rest;
use crate::commands::{CommandResult, Outcome, say};
use bearing_dynamics::output::natural_motions::{frequency, moves_most, names, write};
use bearing_dynamics::output::remarks::of_narrow_contact;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::solver::clock::to_digits;
use bearing_dynamics::solver::dynamics::assembly::{Assembly, Body};
use bearing_dynamics::solver::dynamics::connection::Connection;
use bearing_dynamics::solver::dynamics::model::Rotation;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::housing::held_motions::{
    Natural, natural_shapes_of, swinging_housing,
};
use bearing_dynamics::solver::housing::inertia::{HousingMass, MovingBody};
use bearing_dynamics::solver::rotor::model::RotorError;
use bearing_dynamics::solver::solid::foretold;
use bearing_dynamics::solver::solid::modes::Mode as NaturalShape;
use bearing_dynamics::solver::static_assembly::{Place, StaticAssembly, StaticBody};
use bearing_dynamics::solver::statics::{AssemblySolution, Determinacy};
use bearing_dynamics::solver::vibrations::{Whirling, natural_motions, whirling};
use serde_json::json;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::time::Instant;

pub fn run(asked: &Asked, scene: &AssemblyScene) -> CommandResult {
    let Asked { path, document, .. } = asked;
    scene.check_smooth()?;
    let folder = asked.folder(Writes::Modes)?;
    let housings = housings::prepare(document, scene)?;
    let start = Instant::now();
    let bores = housings::condensed(&housings)?;
    let lists = Lists::of(scene);
    let found = housings::equilibrium(&lists, housings::grown(&housings, &bores), None)?;
    let Equilibrium { still, moment, in_bores } = &found;
    let assembly = lists.assembly()?;
    let bodies = taking_part(assembly, still);
    if !bodies.iter().any(|body| body.free.contains(&true)) {
        let place = path.display();
        return Err(format!("{place}: all coordinates are given: nothing is left to swing").into());
    }
    let mut masses = Vec::new();
    let (mut first_left_out, mut of_housings) = (f64::INFINITY, Vec::new());
    if let Some((course, search)) = in_bores {
        let seats = course.seats.iter().zip(search.bores()).zip(&housings);
        for ((seat, bore), housing) in seats {
            let race = bodies.iter().position(|of| of.body == seat.body(assembly));
            let Some(race) = race else { continue };
            let (natural, beyond) = natural_shapes(housing, bore.bore(), NATURAL)?;
            first_left_out = first_left_out.min(beyond);
            let before = housing.name.as_ref().map_or(String::new(), |name| format!("{name}_"));
            let mass = swinging_housing(bore, race, &natural, seat.damping);
            of_housings.push((before, mass.held.len()));
            masses.push(mass);
        }
    }
    let solution = &moment.solution;
    let found = natural_motions(still, solution, &bodies, &masses);
    if found.is_empty() {
        let hint = "give it: body.NAME.inertia";
        return Err(format!("{}: a body has no mass. Hint: {hint}", path.display()).into());
    }
    let names = names(still, &bodies, assembly, &of_housings);
    let mut text = "mode        frequency, Hz  moves most\n".to_string();
    for (index, mode) in found.iter().enumerate() {
        let most = &names[moves_most(mode)];
        let _ = writeln!(text, "{:>4} {:>20.6}  {most}", index + 1, frequency(mode));
    }
    say(&text)?;
    let mut remarks: Vec<String> = at_rest(scene).collect();
    let spinning = match spinning(assembly, still, solution, &bodies, &masses) {
        Ok(spinning) => {
            let housed = !masses.is_empty();
            spinning.map(|whirling| Spinning::new(whirling, housed)).transpose()?
        }
        // Motions at rest are what they are.
        Err(why @ RotorError::Uneven { .. }) => {
            remarks
                .push(format!("whirl, critical speeds and a Campbell diagram are not told: {why}"));
            None
        }
        Err(RotorError::Unstable) if solution.determinacy != Determinacy::Determinate => {
            remarks.push(
                "whirl, critical speeds and a Campbell diagram are not told: nothing holds what spins in this equilibrium, as bearings without load are no \
                 springs and no spring holds it to the ground; give it a load or preload"
                    .into(),
            );
            None
        }
        Err(error) => return Err(error.into()),
    };
    if spinning.is_none() {
        remarks.extend(by_torque(assembly));
    }
    remarks.extend(relaxing(assembly, spinning.is_some()).map(String::from));
    if let Some(spinning) = &spinning {
        say(&spinning.text())?;
        remarks.extend(spinning.remarks());
        remarks.extend(of_other_speed(scene, assembly, spinning.whirling.top_speed));
        remarks.extend(of_one_speed(scene, spinning.whirling.top_speed));
    }
    remarks.extend(of_balls_at_speed(scene, solution));
    remarks.extend(beyond_shapes(assembly, found.iter().map(frequency)));
    if found.iter().any(|mode| frequency(mode) == 0.0) {
        remarks.push(
            "a frequency of zero is of a motion that no contact and no spring brings back".into(),
        );
    }
    remarks.push(
        match spinning {
            None => "about the equilibrium at t = 0, nothing turning; balls are springs without mass",
            Some(_) if flung(scene) => "about the equilibrium at t = 0, which has the balls' centrifugal force, modes without what turning does besides; balls \
                        are springs without mass and contacts do not damp",
            Some(_) => "about the equilibrium at t = 0, modes with nothing turning; balls are springs without mass and contacts do not damp",
        }
        .into(),
    );
    let narrow = housings.iter().zip(&moment.solution.seats);
    remarks.extend(narrow.filter_map(|(housing, seat)| {
        Some(format!("{}{}", housing.before(), of_narrow_contact(seat)?))
    }));
    if !masses.is_empty() {
        let natural: Vec<String> = of_housings.iter().map(|(_, count)| count.to_string()).collect();
        let within = match first_left_out.is_finite() {
            true => format!(
                "; motions are told too fast, by less than 1 % up to {} Hz, eight tenths of where the first natural shape that is left out swings",
                to_digits(0.8 * first_left_out, 4)
            ),
            false => String::new(),
        };
        remarks.push(format!(
            "housings take part with the shapes that follow their races and {} natural ones (housing.modes_to of reduced ones says up to which \
             frequency){within}",
            natural.join(" and ")
        ));
    }
    remarks.iter().try_for_each(|remark| say(&format!("note: {remark}\n")))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    remove_earlier(&folder)?;
    let seconds = vec![("solve".into(), start.elapsed().as_secs_f64())];
    let mut record = record(&lists, plan::of_statics(&lists, &housings)?, seconds)?;
    record.ran.clone_from(&moment.solution.ran);
    record.sections.push(("remarks".into(), json!(remarks)));
    let mut written = Vec::new();
    if let Some(spinning) = &spinning {
        record.sections.push(("rotor".into(), spinning.section()));
        let title = scene.common().title.as_deref().unwrap_or("Campbell diagram");
        written.extend(spinning.write(&folder, title)?);
    }
    written.extend(write(&folder, &names, &found, &record)?);
    say(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}

/// Natural shapes of a housing where the scene does not say up to which frequency: a pillow block has its lowest ones among them, and
/// they cost less than condensing its bore.
const NATURAL: usize = 12;

/// Natural shapes of a housing that take part, `usual` of the lowest where the scene does not say up to which frequency, and the frequency
/// of the first one that does not, Hz.
pub(super) fn natural_shapes(
    housing: &Housing,
    bore: &CondensedBore,
    usual: usize,
) -> Fallible<(Vec<NaturalShape>, f64)> {
    let natural = match housing.scene.housing.modes_to {
        Some(frequency) => Natural::UpTo(frequency),
        None => Natural::Lowest(usual),
    };
    let model = &housing.setup.model;
    refuse_beyond(&foretold::modes_of_held(model, bore.unknowns(), usual + 1), "")?;
    let what = format!("{}natural shapes of the housing", housing.before());
    Ok(spun(what, || natural_shapes_of(model, bore, natural))?)
}

/// Whether a speed is given to a body that is not zero throughout.
fn has_speed(body: &Body) -> bool {
    let rotation = body.driven().map(|race| &race.rotation);
    matches!(rotation, Some(Rotation::Speed(speed)) if !speed.is_zero())
}

/// Why there is no whirl of what a torque turns.
fn by_torque(assembly: &Assembly) -> Option<String> {
    let turned = |body: &&Body| {
        let rotation = body.driven().map(|race| &race.rotation);
        matches!(rotation, Some(Rotation::Torque(torque)) if !torque.is_zero())
    };
    let body = assembly.bodies.iter().find(turned)?;
    Some(format!(
        "a torque turns {}, at a speed that a run finds: whirl, critical speeds and a Campbell diagram are told up to a given one; write speed = \"... rpm\" \
         in the place of the torque",
        body.name
    ))
}

/// Whirl, where a body that moves spins.
fn spinning(
    assembly: &Assembly,
    still: &StaticAssembly,
    solution: &AssemblySolution,
    bodies: &[MovingBody],
    masses: &[HousingMass],
) -> Result<Option<Whirling>, RotorError> {
    if !bodies.iter().any(|of| has_speed(&assembly.bodies[of.body])) {
        return Ok(None);
    }
    whirling(assembly, still, solution, bodies, masses).map(Some)
}

/// What a reader should know where whirl is that of the speed at the end, `top` (rad/s), and the equilibrium that of another at t = 0.
fn of_other_speed(scene: &AssemblyScene, assembly: &Assembly, top: f64) -> Option<String> {
    let speeds = assembly.bodies.iter().filter_map(|body| match &body.driven()?.rotation {
        Rotation::Speed(speed) => Some(speed.value(0.0)),
        Rotation::Torque(_) => None,
    });
    let first =
        speeds.fold(0.0, |first: f64, now| if now.abs() > first.abs() { now } else { first });
    let flung = flung(scene);
    let [first, last] = [first, top].map(|speed| to_digits(rpm(speed), 6));
    let balls = match flung {
        true => format!("the balls' centrifugal force is that at {first} rpm, too"),
        false => "the balls' centrifugal force is left out".into(),
    };
    (first != last).then(|| {
        format!(
            "whirl is at {last} rpm, where the speed ends, about the equilibrium at t = 0, where it is {first} rpm: {balls}; \
             write speed = \"{last} rpm\" for the equilibrium there{}",
            if flung { "" } else { ", with ball_forces.centrifugal = true" }
        )
    })
}

/// Whether the equilibrium has the centrifugal force of balls.
fn flung(scene: &AssemblyScene) -> bool {
    scene.bearings.iter().any(|placed| placed.scene.centrifugal)
}

/// What springs with Maxwell elements do in what is told.
fn relaxing(assembly: &Assembly, whirls: bool) -> Option<&'static str> {
    let mut with = assembly.connections.iter().filter(|of| !of.maxwell().is_empty()).peekable();
    with.peek()?;
    let turns = |of: &Connection| has_speed(&assembly.bodies[of.ends[0].body]);
    Some(match (whirls, with.any(turns)) {
        (false, _) => {
            "springs with Maxwell elements have in each of the modes the stiffness that they store at its frequency; what they damp is \
             told of whirl alone"
        }
        (true, false) => {
            "springs with Maxwell elements have in each of the modes and critical speeds the stiffness that they store at its frequency; whirl and \
             the Campbell diagram have what they damp, too"
        }
        (true, true) => {
            "springs with Maxwell elements have in each of the modes the stiffness that they store at its frequency; whirl and the Campbell diagram \
             have what they damp, too. At critical speeds those that turn have the stiffness that forward whirl once a turn finds in their axes, relaxed \
             where they turn as fast; backward ones are higher"
        }
    })
}

/// What a reader should know of other speeds than the scene's, `top` (rad/s), where bearings are stiff as that makes them.
fn of_one_speed(scene: &AssemblyScene, top: f64) -> Option<String> {
    (flung(scene) && top != 0.0).then(|| {
        format!(
            "bearings are as stiff at every speed as the balls' centrifugal force makes them at the start: critical speeds and the Campbell diagram \
             hold near {} rpm alone; give each speed of interest as the scene's",
            to_digits(rpm(top), 6)
        )
    })
}

/// Motions above what the natural shapes of the shaft with the fewest of them reach.
fn beyond_shapes(assembly: &Assembly, found: impl Iterator<Item = f64>) -> Option<String> {
    let limits = assembly.shafts.iter().map(|shaft| (shaft.shapes.cut.above / TAU, shaft.body));
    let (limit, body) = limits.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let beyond = found.filter(|frequency| *frequency > limit).count();
    (beyond > 0).then(|| {
        format!(
            "{beyond} of the modes, those above {limit:.0} Hz, reach beyond the natural shapes of {}: what is left of it there are shapes that \
             answer loads, which swing too fast (from half of that frequency on by 0.2 to 0.4 % where it was measured); body.NAME.beam.below has more natural ones",
            assembly.bodies[body].name
        )
    })
}

/// The bodies that loads move.
fn taking_part(assembly: &Assembly, still: &StaticAssembly) -> Vec<MovingBody> {
    let of = |(index, (still, body)): (usize, (&StaticBody, &Body))| {
        let Place::Loaded(loaded) = &still.place else { return None };
        let free = [0, 1, 2, 3, 4].map(|i| loaded.given(i).is_none());
        Some(MovingBody { body: index, inertia: *body.inertia()?, free })
    };
    still.bodies.iter().zip(&assembly.bodies).enumerate().filter_map(of).collect()
}
