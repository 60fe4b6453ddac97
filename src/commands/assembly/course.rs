//! What leaving out inertia costs where equilibria follow one another: estimates, and what is said of them.

use super::Fallible;
use super::housing::Housing;
use super::modes::natural_shapes;
use crate::commands::memory::spun;
use bearing_dynamics::output::assembly_results::key;
use bearing_dynamics::output::summary::housing::{inertia_section, largest_error};
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::excitations::{Excitation, excitations};
use bearing_dynamics::scene::housing::HousingMethod;
use bearing_dynamics::solver::clock::to_digits;
use bearing_dynamics::solver::dynamics::equilibrium::conditions;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::housing::course::{CourseProblem, CourseSeat, Moment};
use bearing_dynamics::solver::housing::course_inertia::{
    CourseInertia, CourseLooks, SeatLooks, course_inertia,
};
use bearing_dynamics::solver::housing::course_search::CourseSearch;
use bearing_dynamics::solver::housing::held_motions::swinging_housing;
use bearing_dynamics::solver::housing::inertia::{InertiaEstimate, MovingBody, estimate};
use bearing_dynamics::solver::solid::modes::Mode;
use bearing_dynamics::solver::statics::Condition;
use serde_json::{Map, Value};
use std::f64::consts::TAU;

/// Errors of leaving out inertia above which the plan warns, and above which it says no.
const WORTH_A_WORD: f64 = 0.01;
const TOO_MUCH: f64 = 0.1;

/// What inertia would add to the course of one body.
pub struct Along {
    /// "the outer race of bearing left".
    pub body: String,
    pub inertia: CourseInertia,
}

/// When the radial load on any body is largest.
fn most_loaded(scene: &AssemblyScene, course: &CourseProblem) -> f64 {
    let Some(run) = scene.run() else { return 0.0 };
    let on_axis = |condition: &Condition| match condition {
        Condition::Load(load) => load.abs(),
        // A displacement of a micrometre takes some hundred newtons.
        Condition::Displacement(way) => 1e8 * way.abs(),
    };
    let load = |t: f64| {
        let bodies = course.assembly.bodies.iter().filter_map(|body| Some((body, body.driven()?)));
        let loads = bodies.map(|(body, race)| {
            let given = conditions(&course.assembly, body, race, t);
            on_axis(&given[1]).max(on_axis(&given[2]))
        });
        loads.fold(0.0, f64::max)
    };
    const LOOKS: u32 = 400;
    let times = (0..=LOOKS).map(|i| run.end * f64::from(i) / f64::from(LOOKS));
    times.max_by(|a, b| load(*a).total_cmp(&load(*b))).unwrap_or(0.0)
}

/// Natural shapes of the housing of each seat of a course.
pub type Natural = [Vec<Mode>];

/// So many are taken: the lowest motion of a pillow block is told to 1e-5 with four.
const NATURAL: usize = 4;

/// Those of housings that are condensed as `bores`.
pub fn natural(housings: &[Housing], bores: &[CondensedBore]) -> Fallible<Vec<Vec<Mode>>> {
    let of = |(housing, bore)| Ok(natural_shapes(housing, bore, NATURAL)?.0);
    housings.iter().zip(bores).map(of).collect()
}

/// What leaving out inertia costs, about the equilibrium under the largest load.
pub fn inertia_estimate(
    scene: &AssemblyScene,
    course: &CourseProblem,
    natural: &Natural,
) -> Fallible<Option<InertiaEstimate>> {
    let mut search = CourseSearch::of(&course.seats);
    let found = course.find(&mut search, most_loaded(scene, course))?;
    Ok(estimate_at(course, natural, &search, &found))
}

/// About an equilibrium. Nothing for a race that nothing holds.
pub fn estimate_at(
    course: &CourseProblem,
    natural: &Natural,
    search: &CourseSearch,
    found: &Moment,
) -> Option<InertiaEstimate> {
    let bodies = course.moving();
    let seats = races_in_bores(course, &bodies).into_iter().zip(&course.seats);
    let housings = search.bores().iter().zip(seats).zip(natural);
    let swinging = |((bore, (race, seat)), shapes): ((_, (_, &CourseSeat)), &Vec<Mode>)| {
        swinging_housing(bore, race, shapes, seat.damping)
    };
    let housings: Vec<_> = housings.map(swinging).collect();
    let found = estimate(&found.solution.with_shapes, &bodies, &housings);
    Some(found).filter(|found| found.lowest > 0.0 && found.lowest.is_finite())
}

/// Places of the races of all seats in the list of what moves.
fn races_in_bores(course: &CourseProblem, bodies: &[MovingBody]) -> Vec<usize> {
    let of = |body: usize| bodies.iter().position(|of| of.body == body);
    course.seats.iter().filter_map(|seat| of(seat.body(&course.assembly))).collect()
}

/// Looks at a course: so many for each turn of a load, at most so many, fewest.
const LOOKS: [f64; 3] = [720.0, 2880.0, 720.0];

/// What inertia would add along the scene's run, to races in bores and bodies with names. Nothing for one in which
/// nothing moves.
pub fn along_course(
    scene: &AssemblyScene,
    course: &CourseProblem,
    natural: &Natural,
) -> Fallible<Vec<Along>> {
    let Some(run) = scene.run() else { return Ok(Vec::new()) };
    if excitations(scene).is_empty() {
        return Ok(Vec::new());
    }
    let loads = course.assembly.bodies.iter().filter_map(|body| body.rotating_load.as_ref());
    let turns = loads.map(|load| load.angle(run.end).abs()).fold(0.0, f64::max) / TAU;
    let [a_turn, most, fewest] = LOOKS;
    let bodies = course.moving();
    let races = races_in_bores(course, &bodies);
    let of = |((race, seat), shapes): ((&usize, &CourseSeat), &Vec<Mode>)| SeatLooks {
        race: *race,
        natural: shapes.clone(),
        damping: seat.damping,
    };
    let looks = CourseLooks {
        start: 0.0,
        end: run.end,
        count: (a_turn * turns).clamp(fewest, most) as usize,
        corners: course.assembly.corners(),
        seats: races.iter().zip(&course.seats).zip(natural).map(of).collect(),
        bodies,
    };
    let what = format!("inertia that the course leaves out, looked for at {} places", looks.count);
    let found = spun(what, || {
        course_inertia(&looks, &mut CourseSearch::of(&course.seats), |search, time| {
            course.find(search, time).map(|moment| moment.solution)
        })
    })?;
    let body = |place: usize| &course.assembly.bodies[looks.bodies[place].body];
    let told = |place: &usize| races.contains(place) || body(*place).label.is_some();
    let moves = |found: &CourseInertia| found.swing > 0.0 || found.displacement > 0.0;
    let all = (0..found.len()).filter(told).filter(|place| moves(&found[*place]));
    Ok(all.map(|place| Along { body: body(place).name.clone(), inertia: found[place] }).collect())
}

/// What both say, as results have it: of one bearing that of its outer race, else by body.
pub fn section(
    scene: &AssemblyScene,
    estimate: &InertiaEstimate,
    along: &[Along],
) -> Fallible<Value> {
    let excitations = excitations(scene);
    if scene.one().is_some() {
        let course = along.first().map(|along| &along.inertia);
        return Ok(inertia_section(estimate, &excitations, course)?);
    }
    let mut section = inertia_section(estimate, &excitations, None)?;
    let mut bodies = Map::new();
    for Along { body, inertia } in along {
        let own = inertia_section(estimate, &[], Some(inertia))?["along_the_course"].take();
        bodies.insert(key(body), own);
    }
    section["along_the_course"] = Value::Object(bodies);
    Ok(section)
}

/// The error estimate in words: of the body along the course that it matters most for, of others that it is worth a word for; without a
/// course, of what drives fastest.
pub fn verdicts(scene: &AssemblyScene, estimate: &InertiaEstimate, along: &[Along]) -> Vec<String> {
    let mut along: Vec<&Along> = along.iter().collect();
    along.sort_by(|a, b| b.inertia.of_displacement().total_cmp(&a.inertia.of_displacement()));
    let frequency = format!("lowest natural frequency about {} Hz", to_digits(estimate.lowest, 4));
    let first = format!("{frequency}{}", verdict(scene, estimate, along.first().copied()));
    let of =
        |along: &Along| verdict(scene, estimate, Some(along)).trim_start_matches("; ").to_string();
    let counts = |of: &&Along| !(0.0..=WORTH_A_WORD).contains(&of.inertia.of_displacement());
    let others = along.into_iter().skip(1).filter(counts);
    std::iter::once(first).chain(others.map(of)).collect()
}

/// What follows the frequency.
fn verdict(scene: &AssemblyScene, estimate: &InertiaEstimate, along: Option<&Along>) -> String {
    let excitations = excitations(scene);
    let mut said = String::new();
    let chosen = scene.housing_method() == Some(HousingMethod::QuasiStatic);
    let Some((driven, cause)) = largest_error(estimate, &excitations) else {
        said += ", and nothing drives it at a frequency of its own";
        return said;
    };
    // What counts is the body's displacement, which is what is read; of one that hardly swings, inertia may
    // change much of the swing and next to nothing of that.
    let (error, of_swing) = match along {
        Some(Along { body, inertia }) if inertia.swing <= ROUNDING * inertia.displacement => {
            said += &format!(
                "; {body} does not swing along the course, so that inertia has nothing to change"
            );
            return said;
        }
        Some(Along { body, inertia }) => {
            said += &format!("; {}", course_text(body, inertia));
            let part = inertia.of_displacement();
            said += &format!("; that is {} of its displacement", percent(part));
            (part, inertia.part(inertia.expected()))
        }
        None => {
            said += &format!(
                "; equilibria leave out inertia, {} of the displacement that goes with {} ({} Hz)",
                percent(driven),
                cause.what,
                to_digits(cause.frequency, 4)
            );
            // How much balls that pass by displace shows only along a course.
            let others: Vec<Excitation> =
                excitations.iter().filter(|other| !other.is_ripple).cloned().collect();
            let judged = largest_error(estimate, &others).map_or(0.0, |(error, _)| error);
            (judged, driven)
        }
    };
    let of_balls = along.is_none() && cause.is_ripple && driven > TOO_MUCH;
    if of_balls && !chosen {
        said += "; whether that counts shows along a course: `bearing plan` of method = \"quasi-static\" in [housing] tells it";
        return said;
    }
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
        (false, _, true) => {
            "; little enough for a course of equilibria (method = \"quasi-static\" in [housing])"
        }
    };
    said
}

/// A swing below this part of the displacement is what equilibria leave over, no motion.
const ROUNDING: f64 = 1e-8;

/// Parts of what inertia adds, over the swing of the body where that is more.
fn course_text(body: &str, course: &CourseInertia) -> String {
    let expected = course.expected();
    if expected.is_finite() && expected > course.swing {
        let length = |length: f64| format!("{} nm", to_digits(1e9 * length, 2));
        return format!(
            "{body} swings by {} along the course and would ring by about {} besides (acceleration {}, a start at rest {}, {} kinks of the \
             contact and the loads up to {}), at most {}, at {} Hz until damping takes it",
            length(course.swing),
            length(expected),
            length(course.steady),
            length(course.start),
            course.kinks,
            length(course.largest_kink),
            length(course.bound),
            to_digits(course.frequency, 3)
        );
    }
    let part = |length: f64| percent(course.part(length));
    format!(
        "of {body}'s swing of {} nm: acceleration {}, a start at rest {}, {} kinks of the contact and the loads up to {}; \
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
