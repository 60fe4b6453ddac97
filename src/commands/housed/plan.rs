//! `bearing plan` of a bearing in its housing: what the scene's method does, and what the other one
//! would cost.

use super::{
    Prepared, along_course, bearing_at, condensed, condensing, inertia_estimate, mesh_text, notes,
    parts, prepare, reduced, refuse_moved_supports, refuse_steps, request as housed_request,
};
use crate::commands::plan::{dynamic_items, say_plan};
use crate::commands::plan_step::note;
use crate::commands::{CommandResult, Outcome, memory};
use bearing_dynamics::output::session::HousedParts;
use bearing_dynamics::output::summary::housing::largest_error;
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::RunSettings;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::scene::housing::{HousedScene, HousingMethod};
use bearing_dynamics::scene::housing_problem::{
    BALLS_PASSING, Excitation, check_constant, excitations,
};
use bearing_dynamics::solver::clock::{rounded, to_digits, whole_number};
use bearing_dynamics::solver::dynamics::assembly::{Assembly, OUTER};
use bearing_dynamics::solver::dynamics::model::Rotation;
use bearing_dynamics::solver::dynamics::run::Start;
use bearing_dynamics::solver::housing::condensed::{CondensedBore, Sizes};
use bearing_dynamics::solver::housing::course_inertia::CourseInertia;
use bearing_dynamics::solver::housing::exchange::SteppedSolid;
use bearing_dynamics::solver::housing::housed::without_bore;
use bearing_dynamics::solver::housing::inertia::InertiaEstimate;
use bearing_dynamics::solver::plan::solid::{self, Method};
use bearing_dynamics::solver::plan::statics::{self, ASKED_FOR};
use bearing_dynamics::solver::plan::{Item, Stage, Subject, motion};
use bearing_dynamics::solver::statics::StaticProblem;
use std::error::Error;
use std::time::{Duration, Instant};

/// Errors of leaving out inertia above which the plan warns, and above which it says no.
const WORTH_A_WORD: f64 = 0.01;
const TOO_MUCH: f64 = 0.1;
/// How long windows are timed for an estimate of the wall time.
const TIMED: Duration = Duration::from_millis(300);

pub fn run(document: &Document, scene: &HousedScene) -> CommandResult {
    let prepared = prepare(document, scene)?;
    let method = scene.housing.method;
    let mut reduced = None;
    if method == HousingMethod::Reduced {
        refuse_moved_supports(document, scene)?;
        reduced = Some(reduced::reduced(scene, &prepared)?);
    }
    let assembly = reduced.as_ref().map(|reduced| &reduced.assembly);
    let items = items(scene, &prepared, assembly)?;
    let mut lines: Vec<String> =
        notes(&prepared).iter().map(|said| note("housing mesh", said)).collect();
    if let Some(reduced) = &reduced {
        lines.extend(reduced::plan_notes(scene, reduced));
    }
    if method == HousingMethod::Explicit && !scene.housing.from_equilibrium {
        lines.push(note("start of the housing", UNDEFORMED));
    }
    lines.extend(equilibrium_notes(scene, &prepared)?);
    if let Some(run) = &scene.bearing.dynamics.run {
        if method == HousingMethod::QuasiStatic {
            refuse_steps(document)?;
        }
        lines.push(explicit_note(scene, &prepared, run));
    }
    say_plan(&items, &lines)?;
    Ok(Outcome::Done)
}

const UNDEFORMED: &str = "undeformed, the outer race in its first place: what the bearing carries from the start \
    swings in";

/// Items of what the scene's method does: a run, equilibria one after the other, or statics. `assembly` is that of
/// a reduced housing.
pub fn items(
    scene: &HousedScene,
    prepared: &Prepared,
    assembly: Option<&Assembly>,
) -> Result<Vec<Item>, Box<dyn Error>> {
    let Some(run) = &scene.bearing.dynamics.run else { return items_of_statics(scene, prepared) };
    if scene.housing.method == HousingMethod::QuasiStatic {
        return items_of_course(scene, prepared, run);
    }
    let own = dynamic_problem(&scene.bearing)?.assembly();
    let assembly = assembly.unwrap_or(&own);
    let mut solids = solid_items(scene, prepared, 0, "housing");
    if scene.housing.method == HousingMethod::Explicit {
        solids.extend(motion::stepped_seat(assembly, 0, (OUTER, None)));
    }
    let mut request = housed_request(scene, run);
    // Bearings roll in equilibrium with races that are held where they sit in their housings.
    request.options.start = Start::Equilibrium;
    let alone = AssemblyScene::alone(scene.bearing.clone());
    Ok(dynamic_items(&alone, assembly, &request, None, solids))
}

/// Items of the housing: what acts on it, and how it is solved for.
pub fn solid_items(scene: &HousedScene, prepared: &Prepared, index: usize, of: &str) -> Vec<Item> {
    let method = match scene.housing.method {
        HousingMethod::QuasiStatic => Method::QuasiStatic,
        HousingMethod::Reduced => Method::Reduced,
        HousingMethod::Explicit => Method::Explicit,
    };
    let problem = &prepared.setup.solid.problem;
    solid::items(problem, index, Some(of), &mesh_text(&prepared.built), &method)
}

/// Of one equilibrium of both, whichever way the housing takes in a run.
pub fn items_of_statics(
    scene: &HousedScene,
    prepared: &Prepared,
) -> Result<Vec<Item>, Box<dyn Error>> {
    Ok(equilibrium_items(scene, prepared, &bearing_at(scene, 0.0)?, ASKED_FOR))
}

fn equilibrium_items(
    scene: &HousedScene,
    prepared: &Prepared,
    problem: &StaticProblem,
    centrifugal: &str,
) -> Vec<Item> {
    let setup = &prepared.setup;
    let still = without_bore(problem, &setup.fit(scene));
    let mesh = mesh_text(&prepared.built);
    let housing = &setup.solid.problem;
    let mut solids = solid::items(housing, 0, Some("housing"), &mesh, &Method::QuasiStatic);
    solids.push(statics::seat(0, &still.bodies[OUTER].name));
    statics::items(&still, solids, centrifugal)
}

/// Of equilibria one after the other, in which balls go round and press outwards.
fn items_of_course(
    scene: &HousedScene,
    prepared: &Prepared,
    run: &RunSettings,
) -> Result<Vec<Item>, Box<dyn Error>> {
    const GO_ROUND: &str =
        "in `run`, as the cage goes round; `statics` leaves it out, it is not asked for";
    let mut problem = bearing_at(scene, 0.0)?;
    let turning = &scene.bearing.dynamics.inner.rotation;
    let turns = matches!(turning, Rotation::Speed(speed) if !speed.is_zero());
    // At any speed that it has.
    problem.orbital_speed = f64::from(u8::from(turns));
    let mut items = equilibrium_items(scene, prepared, &problem, GO_ROUND);
    let count = whole_number(run.end, run.output_interval) + 1;
    let last = rounded((count - 1) as f64 * run.output_interval);
    let why = format!("{count} equilibria to t = {last} s, one a row");
    items.push(Item::does(Stage::Equilibria, Subject::Whole, why));
    Ok(items)
}

/// What condensing takes; of the quasi-static method also whether equilibria will do, which needs
/// the condensed housing. Of an explicit scene nothing is factorised: its run needs no factors.
fn equilibrium_notes(
    scene: &HousedScene,
    prepared: &Prepared,
) -> Result<Vec<String>, Box<dyn Error>> {
    let chosen = scene.housing.method == HousingMethod::QuasiStatic;
    let name = if chosen { "inertia left out" } else { "quasi-static instead" };
    let foretold = match check_constant(scene) {
        Ok(()) => condensing(prepared).map_err(|error| error.to_string()),
        Err(error) => Err(error.to_string()),
    };
    let (sizes, cost) = match foretold {
        Ok((_, sizes, cost)) => (sizes, cost),
        Err(error) => return Ok(vec![note(name, &format!("not possible: {error}"))]),
    };
    let mut lines = vec![
        note("condensed bore", &condensed_text(&sizes)),
        note("condensing takes", &memory::text(&cost)),
    ];
    lines.push(if chosen {
        quasi_static_note(scene, prepared, &condensed(prepared)?)?
    } else {
        let said = "what leaving out inertia would change is found with the condensed housing: \
                    `plan` says it with method = \"quasi-static\" in [housing]";
        note(name, said)
    });
    Ok(lines)
}

fn condensed_text(sizes: &Sizes) -> String {
    format!(
        "{} unknowns onto {} of {} bore nodes; {} beside the race and {} out of reach are left \
         out",
        sizes.unknowns, sizes.kept, sizes.bore, sizes.beside, sizes.out_of_reach
    )
}

/// Whether equilibria will do, with the error of leaving out inertia.
fn quasi_static_note(
    scene: &HousedScene,
    prepared: &Prepared,
    bore: &CondensedBore,
) -> Result<String, Box<dyn Error>> {
    let name = "inertia left out";
    let Some(estimate) = inertia_estimate(scene, &prepared.setup, bore)? else {
        return Ok(note(name, "nothing holds the outer race under the largest load"));
    };
    let (along, missing) = match along_course(scene, &prepared.setup, bore) {
        Ok(along) => (along, String::new()),
        Err(error) => (None, format!("; no estimate along the course: {error}")),
    };
    let said = verdict(scene, &estimate, along.as_ref());
    Ok(note(name, &(said + &missing)))
}

/// The error estimate in words: along the course where there is one, else of what drives fastest.
pub fn verdict(
    scene: &HousedScene,
    estimate: &InertiaEstimate,
    along: Option<&CourseInertia>,
) -> String {
    let excitations = excitations(scene);
    let mut said = format!("lowest natural frequency about {} Hz", to_digits(estimate.lowest, 4));
    let chosen = scene.housing.method == HousingMethod::QuasiStatic;
    let Some((driven, cause)) = largest_error(estimate, &excitations) else {
        said += ", and nothing drives it at a frequency of its own";
        return said;
    };
    // What counts is the race's displacement, which is what is read; of one that hardly swings, inertia may
    // change much of the swing and next to nothing of that.
    let (error, of_swing) = match along {
        Some(course) if course.swing <= ROUNDING * course.displacement => {
            said += "; the outer race does not swing along the course, so that inertia has nothing to change";
            return said;
        }
        Some(course) => {
            said += &format!("; {}", course_text(course));
            let part = course.expected() / course.displacement.max(course.swing);
            said += &format!("; that is {} of its displacement", percent(part));
            (part, course.part(course.expected()))
        }
        None => {
            said += &format!(
                "; error of {} of the displacement that goes with {} ({} Hz)",
                percent(driven),
                cause.what,
                to_digits(cause.frequency, 4)
            );
            // How much balls that pass by displace shows only along a course.
            let others: Vec<Excitation> =
                excitations.iter().filter(|other| other.what != BALLS_PASSING).cloned().collect();
            let judged = largest_error(estimate, &others).map_or(0.0, |(error, _)| error);
            (judged, driven)
        }
    };
    // An error that is not a number is one.
    let (small, bearable) = (error <= WORTH_A_WORD, error <= TOO_MUCH);
    said += match (chosen, small, bearable) {
        (true, _, false) => {
            "; WARNING: not allowed for more than a rough look, write method = \"explicit\" in [housing]"
        }
        (true, false, true) => "; WARNING: method = \"explicit\" in [housing] has inertia",
        (true, true, true) if of_swing > TOO_MUCH => {
            "; to see how it swings write method = \"explicit\" in [housing]"
        }
        (true, true, true) => "",
        (false, _, false) => "; not allowed: inertia counts here",
        (false, _, true) => "; method = \"quasi-static\" in [housing] takes it",
    };
    said
}

/// A swing below this part of the displacement is what equilibria leave over, no motion.
const ROUNDING: f64 = 1e-8;

/// Parts of what inertia adds, over the swing of the outer race.
fn course_text(course: &CourseInertia) -> String {
    let part = |length: f64| percent(course.part(length));
    format!(
        "of the outer race's swing of {} nm: acceleration {}, a start at rest {}, {} kinks of the contact and the loads up to {}; \
         about {} together, at most {}, which rings at {} Hz until damping takes it",
        to_digits(1e9 * course.swing, 4),
        part(course.steady),
        part(course.start),
        course.kinks,
        part(course.largest_kink),
        part(course.expected()),
        part(course.bound),
        to_digits(course.frequency, 3)
    )
}

pub fn percent(part: f64) -> String {
    match part {
        part if part > 1.0 => "more than the whole".into(),
        part => format!("{} %", to_digits(100.0 * part, 2)),
    }
}

/// Windows of the explicit way, and about how long they take here.
fn explicit_note(scene: &HousedScene, prepared: &Prepared, run: &RunSettings) -> String {
    let chosen = scene.housing.method == HousingMethod::Explicit;
    let name = if chosen { "step" } else { "explicit instead" };
    match timed(scene, prepared, run) {
        Ok(said) => note(name, &said),
        Err(error) => note(name, &format!("not possible: {error}")),
    }
}

fn timed(
    scene: &HousedScene,
    prepared: &Prepared,
    run: &RunSettings,
) -> Result<String, Box<dyn Error>> {
    // Where it starts does not matter here, and finding out takes long.
    let mut anywhere = scene.clone();
    anywhere.housing.from_equilibrium = false;
    windows_text(parts(&anywhere, prepared, run, 1)?, run)
}

/// Windows of explicit steps from here, and about how long they take.
pub fn windows_text(parts: HousedParts, run: &RunSettings) -> Result<String, Box<dyn Error>> {
    let (mut housed, windows) = parts.started(run.output_interval)?;
    let all = whole_number(run.end, run.output_interval) * windows;
    let mut nodes = String::new();
    for seat in housed.seats() {
        let (tested, out_of_reach) = seat.counts();
        let of = seat.seat.suffix();
        nodes +=
            &format!("at the start {tested} bore nodes{of} tested, {out_of_reach} out of reach");
        if out_of_reach > 0 {
            let moved = to_digits(0.5e6 * seat.seat.reach, 3);
            nodes +=
                &format!(", sorted anew each time that race and bore have moved by {moved} um");
        }
        nodes += "; ";
    }
    let steps = |part: &SteppedSolid| {
        let of = part.name.as_ref().map_or(String::new(), |name| format!(" {name}"));
        let limit = part.solid.limit.step;
        format!("{} of the housing{of} (limit {limit:.3e} s)", steps(part.steps))
    };
    let solids: Vec<String> = housed.solids.iter().map(steps).collect();
    let start = Instant::now();
    let mut done = 0u64;
    while start.elapsed() < TIMED && done < all {
        for _ in 0..10 {
            housed.advance()?;
        }
        done += 10;
    }
    let seconds = start.elapsed().as_secs_f64() / done as f64 * all as f64;
    Ok(format!(
        "{all} windows of {:.3e} s to t = {} s, each {} and steps of the bearing up to {:.3e} s; {nodes}about \
         {} of wall time here",
        housed.window,
        run.end,
        solids.join(" and "),
        housed.simulation.step_size,
        duration(seconds)
    ))
}

fn steps(count: usize) -> String {
    if count == 1 { "one step".into() } else { format!("{count} steps") }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{} s", to_digits(s, 2)),
        s if s < 7200.0 => format!("{} min", to_digits(s / 60.0, 2)),
        s => format!("{} h", to_digits(s / 3600.0, 2)),
    }
}
