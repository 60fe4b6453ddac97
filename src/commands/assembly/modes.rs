//! `bearing modes` of a scene of bearings: natural modes about the equilibrium.
//!
//! Balls are massless springs. A housing contributes its displacements under the race and some of its natural modes.

use super::Fallible;
use super::housing::Housing;
use super::housings::{self, Equilibrium};
use super::lists::Lists;
use super::whirl::Spinning;
use super::{plan, record};
use crate::commands::asked::Asked;
use crate::commands::earlier::{Writes, remove_earlier};
use crate::commands::memory::{refuse_beyond, spun};
use crate::commands::warnings::of_equilibrium;
use crate::commands::{CommandResult, Outcome, print};
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::equilibrium::lists::{Place, StaticAssembly, StaticBody};
use bearing_dynamics::equilibrium::quasi_static_limit::MovingBody;
use bearing_dynamics::equilibrium::statics::Determinacy;
use bearing_dynamics::members::body::{Body, Rotation};
use bearing_dynamics::numeric::clock::to_digits;
use bearing_dynamics::output::natural_modes::{frequency, moves_most, names, write};
use bearing_dynamics::output::warnings::{lines, solid::of_contact_nodes};
use bearing_dynamics::reduction::fixed_interface_modes::{
    Natural, natural_modes_of, vibrating_housing,
};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::solids::condensation::CondensedBore;
use bearing_dynamics::solids::memory::modes_of_fixed;
use bearing_dynamics::solids::modes::Mode as NaturalMode;
use bearing_dynamics::vibrations::rotor::RotorError;
use bearing_dynamics::vibrations::small_motions::{natural_modes, whirling};
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
    let lists = Lists::made(scene, Some(with_more_modes(scene).assembly()?));
    let found = housings::equilibrium(&lists, housings::grown(&housings, &bores), None)?;
    let Equilibrium { still, moment, in_bores } = &found;
    let assembly = lists.assembly()?;
    let bodies = moving_bodies(assembly, still);
    if !bodies.iter().any(|body| body.free.contains(&true)) {
        let place = path.display();
        return Err(format!("{place}: all coordinates are prescribed: there is no mode").into());
    }
    let mut masses = Vec::new();
    let (mut first_left_out, mut of_housings) = (f64::INFINITY, Vec::new());
    if let Some((problem, search)) = in_bores {
        let seats = problem.seats.iter().zip(search.bores()).zip(&housings);
        for ((seat, bore), housing) in seats {
            let race = bodies.iter().position(|of| of.body == seat.body(assembly));
            let Some(race) = race else { continue };
            let (natural, beyond) = housing_modes(housing, bore.bore(), NATURAL)?;
            first_left_out = first_left_out.min(beyond);
            let before = housing.name.as_ref().map_or(String::new(), |name| format!("{name}_"));
            let mass = vibrating_housing(bore, &housing.setup.model, race, &natural, seat.damping);
            of_housings.push((before, mass.held.len()));
            masses.push(mass);
        }
    }
    let solution = &moment.solution;
    let mut found = natural_modes(still, solution, &bodies, &masses);
    if found.is_empty() {
        let hint = "give body.NAME.inertia";
        return Err(format!("{}: a body has no mass. Hint: {hint}", path.display()).into());
    }
    let first_left_out = assembly
        .shafts
        .iter()
        .fold(first_left_out, |least: f64, shaft| least.min(shaft.shapes.first_omitted / TAU));
    let limit = ACCURATE * first_left_out;
    found.retain(|mode| frequency(mode) <= limit);
    let names = names(still, &bodies, assembly, &of_housings);
    let mean =
        scene.circulatory().map_or("", |_| ", with the mean of `yz` and `zy` of each spring");
    let mut text = format!(
        "natural modes without rotation and damping{mean}\nmode        frequency, Hz  moves most\n"
    );
    for (index, mode) in found.iter().enumerate() {
        let most = &names[moves_most(mode)];
        let _ = writeln!(text, "{:>4} {:>20.6}  {most}", index + 1, frequency(mode));
    }
    if limit.is_finite() {
        let _ = writeln!(
            text,
            "modes above {} Hz are not listed: raise body.NAME.beam.modes_to, or housing.modes_to of a reduced housing, for more",
            to_digits(limit, 4)
        );
    }
    print(&text)?;
    let mut warnings = of_equilibrium(scene, still, solution)?;
    let rotates = bodies.iter().any(|of| has_speed(&assembly.bodies[of.body]));
    let torque = by_torque(assembly).filter(|_| !rotates);
    let (spinning, no_whirl) = match whirling(assembly, still, solution, &bodies, &masses) {
        Ok(whirling) if rotates || torque.is_none() && whirling.model.is_damped() => {
            (Some(Spinning::new(whirling, !masses.is_empty(), TAU * limit)?), None)
        }
        Ok(_) => (None, torque),
        Err(RotorError::Unstable) if !rotates => (None, torque),
        // The modes at rest are valid without whirl.
        Err(why @ RotorError::Uneven { .. }) => (None, Some(why.to_string())),
        Err(RotorError::Unstable) if solution.determinacy != Determinacy::Determinate => {
            (None, Some("the rotor has no support by a bearing load or a spring".into()))
        }
        Err(error) => return Err(error.into()),
    };
    if let Some(spinning) = &spinning {
        print(&spinning.text())?;
        warnings.extend(spinning.warnings());
    }
    if let Some(why) = &no_whirl {
        print(&format!("whirl, critical speeds and Campbell diagram not computed: {why}\n"))?;
    }
    for (housing, seat) in housings.iter().zip(&moment.solution.seats) {
        warnings.extend(of_contact_nodes(seat).map(|of| of.named(&housing.before())));
    }
    print(&lines(&warnings))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    remove_earlier(&folder)?;
    let seconds = vec![("solve".into(), start.elapsed().as_secs_f64())];
    let mut record = record(document, &lists, plan::of_statics(&lists, &housings)?, seconds);
    record.ran.clone_from(&moment.solution.ran);
    record.sections.push(("warnings".into(), json!(warnings)));
    if let Some(why) = &no_whirl {
        record.sections.push(("no_rotor".into(), json!(why)));
    }
    let mut written = Vec::new();
    if let Some(spinning) = &spinning {
        record.sections.push(("rotor".into(), spinning.section()));
        let title = scene.common().title.as_deref().unwrap_or("Campbell diagram");
        written.extend(spinning.write(&folder, title)?);
    }
    written.extend(write(&folder, &names, &found, &record)?);
    print(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}

/// Natural modes of a housing without a limit in the scene; cheaper than condensing its bore.
const NATURAL: usize = 40;
/// Modes are listed up to this fraction of the lowest frequency that the component modes of a shaft or housing omit: there
/// their frequencies are too high by less than 0.1 %; next to that frequency by a few per cent.
const ACCURATE: f64 = 0.4;

/// The scene with so many component modes of shafts that modes up to `modes_to` are listed.
fn with_more_modes(scene: &AssemblyScene) -> AssemblyScene {
    let mut scene = scene.clone();
    for beam in scene.bodies.iter_mut().filter_map(|body| body.beam.as_deref_mut()) {
        beam.kept.below /= ACCURATE;
    }
    scene
}

/// Natural modes kept for a housing (the lowest `usual` ones without a limit in the scene), and the frequency of the
/// first one left out, Hz.
pub(super) fn housing_modes(
    housing: &Housing,
    bore: &CondensedBore,
    usual: usize,
) -> Fallible<(Vec<NaturalMode>, f64)> {
    let natural = match housing.scene.housing.modes_to {
        Some(frequency) => Natural::UpTo(frequency),
        None => Natural::Lowest(usual),
    };
    let model = &housing.setup.model;
    refuse_beyond(&modes_of_fixed(bore.unknowns(), usual + 1), "")?;
    let what = format!("{}natural modes of the housing", housing.before());
    Ok(spun(what, || natural_modes_of(model, bore, natural))?)
}

/// Returns whether a body has a prescribed speed that is not always zero.
fn has_speed(body: &Body) -> bool {
    let rotation = body.driven().map(|race| &race.rotation);
    matches!(rotation, Some(Rotation::Speed(speed)) if !speed.is_zero())
}

/// Reason for no whirl: a body is driven by a torque.
fn by_torque(assembly: &Assembly) -> Option<String> {
    let turned = |body: &&Body| {
        let rotation = body.driven().map(|race| &race.rotation);
        matches!(rotation, Some(Rotation::Torque(torque)) if !torque.is_zero())
    };
    let body = assembly.bodies.iter().find(turned)?;
    Some(format!(
        "{} is driven by a torque, so that its speed is not known; write speed = \"... rpm\" instead of the torque",
        body.name
    ))
}

fn moving_bodies(assembly: &Assembly, still: &StaticAssembly) -> Vec<MovingBody> {
    let of = |(index, (still, body)): (usize, (&StaticBody, &Body))| {
        let Place::Loaded(loaded) = &still.place else { return None };
        let free = [0, 1, 2, 3, 4].map(|i| loaded.prescribed(i).is_none());
        Some(MovingBody { body: index, inertia: *body.inertia()?, free })
    };
    still.bodies.iter().zip(&assembly.bodies).enumerate().filter_map(of).collect()
}
