//! `bearing plan` of bearings and what they sit on and in: what the scene's way of solving does, and what another one
//! of the housings would cost.

use super::course::{along_course, inertia_estimate, verdicts};
use super::housing::Housing;
use super::shapes::{Shapes, shapes};
use super::{Fallible, housings, still};
use crate::commands::plan_step::{note, refused, step_lines};
use crate::commands::remarks::of_springs;
use crate::commands::run::planned_request;
use crate::commands::solve::{lines, plan_lines};
use crate::commands::{CommandResult, Outcome, memory, say};
use bearing_dynamics::output::session::{HousedParts, RunRequest, table_size};
use bearing_dynamics::scene::assembly::{AssemblyScene, PlacedBearing};
use bearing_dynamics::scene::housing::HousingMethod;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::scene::{CageInRun, Document, RunSettings};
use bearing_dynamics::solver::clock::{rounded, to_digits, whole_number};
use bearing_dynamics::solver::dynamics::assembly::Assembly;
use bearing_dynamics::solver::dynamics::foretell::Choice;
use bearing_dynamics::solver::dynamics::model::Rotation;
use bearing_dynamics::solver::housing::condensed::Sizes;
use bearing_dynamics::solver::housing::exchange::SteppedSolid;
use bearing_dynamics::solver::plan;
use bearing_dynamics::solver::static_assembly::{Place, StaticAssembly};
use bearing_dynamics::solver::statics::{Condition, StaticProblem};
use std::error::Error;
use std::time::{Duration, Instant};

/// How long windows are timed for an estimate of the wall time.
const TIMED: Duration = Duration::from_millis(300);

pub fn run(document: &Document, scene: &AssemblyScene) -> CommandResult {
    let housings = housings::prepare(document, scene)?;
    let method = scene.housing_method();
    match (method, scene.run()) {
        (Some(HousingMethod::QuasiStatic), Some(_)) => housings::refuse_steps(document)?,
        (Some(HousingMethod::QuasiStatic), None) => {}
        _ => housings::refuse(document, scene, &housings)?,
    }
    let reduced = match method {
        Some(HousingMethod::Reduced) => Some(shapes(scene, &housings)?),
        _ => None,
    };
    let mut planned = match scene.run().filter(|_| method != Some(HousingMethod::QuasiStatic)) {
        Some(settings) => of_steps(scene, &housings, reduced.as_ref(), settings)?,
        None => of_equilibria(scene, &housings, scene.run().is_some())?,
    };
    planned.extend(of_springs(scene).iter().map(|said| note("spring", said)));
    for housing in &housings {
        planned.extend(housing.notes().iter().map(|said| note("housing mesh", said)));
    }
    if let Some(shapes) = &reduced {
        let of = shapes.plan(scene, &housings).into_iter();
        planned.extend(of.map(|(mark, name, said)| line(mark, name, &said)));
    }
    if !housings.is_empty() {
        planned.extend(equilibrium_lines(scene, &housings)?);
    }
    if let (Some(settings), false) = (scene.run(), housings.is_empty()) {
        if method == Some(HousingMethod::QuasiStatic) {
            planned.push(equilibria_line(settings));
        }
        planned.push(explicit_line(scene, &housings, settings));
    }
    if scene.common().rigid_housing {
        let reason = "housing.method = rigid: the outer race is fixed, no mesh is read";
        planned.push(line("skips", "housing", reason));
    }
    say(&planned.iter().map(|line| format!("{line}\n")).collect::<String>())?;
    Ok(Outcome::Done)
}

fn line(mark: &str, name: &str, said: &str) -> String {
    format!("{mark} {name:<28} {said}")
}

/// A run in steps: stages, steps and the size of its table.
fn of_steps(
    scene: &AssemblyScene,
    housings: &[Housing],
    reduced: Option<&Shapes>,
    settings: &RunSettings,
) -> Fallible<Vec<String>> {
    let assembly = match reduced {
        Some(shapes) => shapes.assembly.clone(),
        None => scene.assembly()?,
    };
    let (request, choice) = planned_request(scene, settings, &assembly, None);
    let mut planned = stages(scene, housings, &assembly, &request, choice.as_ref());
    // Races without their housings would have nothing to hold them.
    if housings.is_empty() || reduced.is_some() {
        planned.extend(step_lines(&assembly, &request));
    }
    planned.push(size_line(&assembly, &request));
    Ok(planned)
}

/// The stages of a run in steps, one line each.
pub fn stages(
    scene: &AssemblyScene,
    housings: &[Housing],
    assembly: &Assembly,
    request: &RunRequest,
    choice: Option<&Choice>,
) -> Vec<String> {
    let left_out = |placed: &PlacedBearing| match &placed.scene.dynamics.cage {
        CageInRun::Body(_) => None,
        CageInRun::LeftOut(reason) => Some(reason.clone()),
    };
    let left_out: Vec<Option<String>> = scene.bearings.iter().map(left_out).collect();
    let left_out: Vec<Option<&str>> = left_out.iter().map(Option::as_deref).collect();
    let mut all = lines(plan::dynamics(assembly, &request.options, &request.channels, &left_out));
    if let Some(choice) = choice {
        let said = format!("{}: {}", choice.integrator.name(), choice.reason());
        all.push(line("does ", "choice of the integrator", &said));
    }
    with_housings(all, scene.housing_method(), housings)
}

/// The stages of one equilibrium, or of one after the other in a run, one line each.
pub fn of_equilibria(
    scene: &AssemblyScene,
    housings: &[Housing],
    in_run: bool,
) -> Fallible<Vec<String>> {
    let still = still(scene)?;
    let all = match scene.one() {
        Some(one) => plan_lines(&of_one(one, &still)?),
        None => of_several(scene, &still)?,
    };
    let rolls = |placed: &PlacedBearing| matches!(&placed.scene.dynamics.inner.rotation, Rotation::Speed(speed) if !speed.is_zero());
    let all = match in_run && scene.bearings.iter().any(rolls) {
        true => all.into_iter().map(with_centrifugal).collect(),
        false => all,
    };
    Ok(with_housings(all, Some(HousingMethod::QuasiStatic), housings))
}

/// One bearing under all loads that it has at t = 0.
pub fn of_one(one: &PlacedBearing, still: &StaticAssembly) -> Fallible<StaticProblem> {
    let problem = static_problem(&one.scene)?;
    Ok(match &still.bodies[0].place {
        Place::Loaded(inner) => StaticProblem { conditions: inner.conditions, ..problem },
        Place::Held(_) => problem,
    })
}

/// What statics of several bearings does: that of each bearing, and one search.
fn of_several(scene: &AssemblyScene, still: &StaticAssembly) -> Fallible<Vec<String>> {
    let mut all = Vec::new();
    for placed in &scene.bearings {
        // What these say of a bearing alone.
        let shared = ["race equilibrium", "outer race motion", "flexible bodies"];
        let own = plan_lines(&static_problem(&placed.scene)?).into_iter();
        let own = own.filter(|line| !shared.iter().any(|name| line[6..].starts_with(name)));
        all.extend(own.map(|line| match &placed.name {
            Some(name) => format!("{}{name}: {}", &line[..6], &line[6..]),
            None => line,
        }));
    }
    let (free, bodies) = free_coordinates(still);
    let search = format!("{free} free coordinates of {bodies} bodies in one search");
    all.push(match free {
        0 => line("skips", "equilibrium", "all coordinates are given: one evaluation"),
        _ => line("does ", "equilibrium", &search),
    });
    all.push(match still.connections.len() {
        0 => line("skips", "springs between bodies", "none is given"),
        some => line("does ", "springs between bodies", &format!("{some} of them")),
    });
    if scene.housing_method().is_none() {
        let said = "the scene has none: no mesh, no element stage";
        all.push(line("skips", "flexible bodies", said));
    }
    Ok(all)
}

/// Coordinates that loads decide, and bodies that have any.
fn free_coordinates(still: &StaticAssembly) -> (usize, usize) {
    let free = still.bodies.iter().map(|body| match &body.place {
        Place::Held(_) => 0,
        Place::Loaded(loaded) => {
            loaded.conditions.iter().filter(|c| matches!(c, Condition::Load(_))).count()
        }
    });
    free.fold((0, 0), |(all, bodies), own| (all + own, bodies + usize::from(own > 0)))
}

/// The line that says statics leaves centrifugal force out, if this is it, for both commands.
fn with_centrifugal(of_statics: String) -> String {
    const NAME: &str = "centrifugal force on balls";
    match of_statics.strip_prefix("skips ").and_then(|said| said.split_once(NAME)) {
        Some((of, _)) if of.is_empty() || of.ends_with(": ") => {
            let said =
                "in `run`, as the cage goes round; `statics` leaves it out, it is not asked for";
            line("does ", &format!("{of}{NAME}"), said)
        }
        _ => of_statics,
    }
}

/// Stages of bearings, and of the housings that they sit in.
fn with_housings(
    of_bearings: Vec<String>,
    method: Option<HousingMethod>,
    housings: &[Housing],
) -> Vec<String> {
    let Some(method) = method.filter(|_| !housings.is_empty()) else { return of_bearings };
    // What these say of a bearing alone.
    const ALONE: [&str; 2] = ["outer race motion", "flexible bodies"];
    let mut all = of_bearings;
    all.retain(|line| !ALONE.iter().any(|name| line[6..].starts_with(name)));
    for housing in housings {
        let of = housing.before();
        let problem = &housing.setup.solid.problem;
        all.push(line("does ", "housing mesh", &format!("{of}{}", housing.mesh_text())));
        let held = problem.prescribed.len();
        all.push(line("does ", "housing supports", &format!("{of}{held} components held")));
        let (mark, said) = match (problem.damping == 0.0, method) {
            (true, _) => ("skips", "none is given"),
            (false, HousingMethod::Explicit | HousingMethod::Reduced) => {
                ("does ", "mass-proportional")
            }
            (false, HousingMethod::QuasiStatic) => {
                ("does ", "in explicit steps; nothing moves in an equilibrium")
            }
        };
        all.push(line(mark, "housing damping", &format!("{of}{said}")));
    }
    let undeformed = housings.iter().any(|housing| !housing.scene.housing.from_equilibrium);
    if method == HousingMethod::Explicit && undeformed {
        let said = "undeformed, the outer race in its first place: what the bearing carries from the start swings in";
        all.push(note("start of the housing", said));
    }
    let (name, said) = match method {
        HousingMethod::QuasiStatic => (
            "quasi-static housing",
            "condensed onto its bore; bearing and bore in one equilibrium after the other",
        ),
        HousingMethod::Explicit => (
            "explicit housing",
            "bearing and housing in steps of their own, which exchange impulses",
        ),
        HousingMethod::Reduced => (
            "reduced housing",
            "some shapes of the housing, which move with the bearing in its steps",
        ),
    };
    all.push(line("does ", name, said));
    all
}

/// How much the run is going to write.
fn size_line(assembly: &Assembly, request: &RunRequest) -> String {
    let said = match table_size(assembly.clone(), request) {
        Ok(size) => size.to_string(),
        Err(error) => refused(&error),
    };
    note("table", &said)
}

/// As many as a run solves.
fn equilibria_line(run: &RunSettings) -> String {
    let count = whole_number(run.end, run.output_interval) + 1;
    let last = rounded((count - 1) as f64 * run.output_interval);
    line("does ", "equilibria", &format!("{count} equilibria to t = {last} s, one a row"))
}

/// What condensing takes; of the quasi-static method also whether equilibria will do, which needs
/// the condensed housings. Of other methods nothing is factorised here.
fn equilibrium_lines(scene: &AssemblyScene, housings: &[Housing]) -> Fallible<Vec<String>> {
    let chosen = scene.housing_method() == Some(HousingMethod::QuasiStatic);
    let name = if chosen { "inertia left out" } else { "quasi-static instead" };
    let mark = if chosen { "does " } else { "notes" };
    let mut planned = Vec::new();
    for housing in housings {
        let of = housing.before();
        let foretold = housing.constant().and_then(|()| housing.condensing());
        let (sizes, cost) = match foretold {
            Ok((_, sizes, cost)) => (sizes, cost),
            Err(error) => return Ok(vec![note(name, &format!("not possible: {error}"))]),
        };
        planned.push(line(mark, "condensed bore", &format!("{of}{}", condensed_text(&sizes))));
        planned.push(note("condensing takes", &format!("{of}{}", memory::text(&cost))));
    }
    if !chosen {
        let said = "what leaving out inertia would change is found with the condensed housing: \
                    `plan` says it with method = \"quasi-static\" in [housing]";
        planned.push(note(name, said));
        return Ok(planned);
    }
    let bores = housings::condensed(housings)?;
    let course = housings::course(scene, housings, &bores)?;
    let Some(estimate) = inertia_estimate(scene, &course)? else {
        planned.push(note(name, "nothing holds the outer race under the largest load"));
        return Ok(planned);
    };
    let (along, missing) = match along_course(scene, &course) {
        Ok(along) => (along, String::new()),
        Err(error) => (Vec::new(), format!("; no estimate along the course: {error}")),
    };
    let said = verdicts(scene, &estimate, &along).into_iter();
    planned.extend(said.map(|said| note(name, &(said + &missing))));
    Ok(planned)
}

fn condensed_text(sizes: &Sizes) -> String {
    format!(
        "{} unknowns onto {} of {} bore nodes; {} beside the race and {} out of reach are left \
         out",
        sizes.unknowns, sizes.kept, sizes.bore, sizes.beside, sizes.out_of_reach
    )
}

/// Windows of the explicit way, and about how long they take here.
fn explicit_line(scene: &AssemblyScene, housings: &[Housing], run: &RunSettings) -> String {
    let chosen = scene.housing_method() == Some(HousingMethod::Explicit);
    // Where it starts does not matter here, and finding out takes long.
    let windows = housings::undeformed(scene, housings, 1);
    match (windows.and_then(|parts| windows_text(parts, run)), chosen) {
        (Ok(said), true) => note("step", &said),
        (Ok(said), false) => note("explicit instead", &said),
        (Err(error), true) => note("step", &refused(&*error)),
        (Err(error), false) => note("explicit instead", &format!("not possible: {error}")),
    }
}

/// Windows of explicit steps from here, and about how long they take.
fn windows_text(parts: HousedParts, run: &RunSettings) -> Result<String, Box<dyn Error>> {
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
