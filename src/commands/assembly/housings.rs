//! Flexible housings of a scene: meshes, and their part in each solution method.

use super::Fallible;
use super::housing::Housing;
use super::lists::Lists;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::assembly::prescribed::conditions;
use bearing_dynamics::equilibrium::exact_gap_iteration::solve_with_true_distances;
use bearing_dynamics::equilibrium::initial::static_assembly;
use bearing_dynamics::equilibrium::lists::StaticAssembly;
use bearing_dynamics::equilibrium::quasi_static_sequence::{
    EquilibriumAt, QuasiStaticFit, QuasiStaticProblem,
};
use bearing_dynamics::equilibrium::statics::{AssemblySolution, StaticOptions, solve_assembly};
use bearing_dynamics::equilibrium::warm_started_search::WarmStartedSearch;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::members::body::{Body, Condition, prescribed_speed};
use bearing_dynamics::members::flexible_shaft::{ElasticShaft, ShaftLoad};
use bearing_dynamics::motion::coupling::{CouplingOptions, SolidPart};
use bearing_dynamics::motion::simulation::{RunOptions, Start};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::HousedParts;
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::build::about::About;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::bushing::BushingElements;
use bearing_dynamics::scene::build::cage::BuiltCage;
use bearing_dynamics::scene::build::shaft::ShaftElements;
use bearing_dynamics::scene::resolve::housing_scene::HousingMethod;
use bearing_dynamics::solids::condensation::{CondensedBore, beyond_normals};
use nalgebra::SVector;

pub fn prepare(document: &Document, scene: &AssemblyScene) -> Fallible<Vec<Housing>> {
    let mut housings = Vec::new();
    for (bearing, placed) in scene.bearings.iter().enumerate() {
        let Some(own) = placed.housed() else { continue };
        let name = placed.name.clone();
        let scoped = name.as_ref().map(|name| document.scoped(name));
        let housing = Housing::new(scoped.as_ref().unwrap_or(document), bearing, name, own);
        let housing = match &placed.name {
            Some(name) => housing.map_err(|error| format!("{error} (housing {name})"))?,
            None => housing?,
        };
        if housing.scene.housing.method != HousingMethod::Explicit {
            // Condensing needs supports.
            housing.refuse_free()?;
        }
        housings.push(housing);
    }
    Ok(housings)
}

/// Returns an error for settings that the solution method of the scene does not allow.
pub fn refuse(document: &Document, scene: &AssemblyScene, housings: &[Housing]) -> Fallible<()> {
    let method = scene.housing_method();
    if method == Some(HousingMethod::QuasiStatic) {
        refuse_steps(document)?;
    }
    let in_elements = [
        (scene.has_bushings_in_elements(), "a bushing", "the bushing's table"),
        (scene.has_shafts_in_elements(), "a shaft", "[body.NAME.beam.mesh]"),
        (scene.has_cages_in_elements(), "a cage", "[bearing.cage] (`body`)"),
    ];
    if let Some((_, what, table)) = in_elements.into_iter().find(|(is, ..)| *is)
        && method.is_some_and(|of| of != HousingMethod::Explicit)
    {
        let place = document.place_of(&About::key("housing.method"));
        return Err(format!(
            "{place}: housing.method: refused: {what} of the scene is solved in elements, with which housings need \
             explicit steps. Hint: write method = \"explicit\" in [housing], or method = \"reduced\" in {table}"
        )
        .into());
    }
    if scene.has_shafts_in_elements() && document.is_given("numerics.start") {
        let place = document.place_of(&About::key("numerics.start"));
        return Err(format!(
            "{place}: numerics.start: refused: a shaft of the scene is solved in elements, which start undeformed, races in their initial \
             positions. Hint: leave it out, or write method = \"reduced\" in [body.NAME.beam.mesh]"
        )
        .into());
    }
    if scene.has_cages_in_elements()
        && scene.run().is_some_and(|run| run.options.start == Start::Nominal)
    {
        let place = document.place_of(&About::key("numerics.start"));
        return Err(format!(
            "{place}: numerics.start: refused: a cage solved in elements starts in equilibrium. Hint: leave it out, or write \
             body = \"reduced\" in [bearing.cage]"
        )
        .into());
    }
    let from_equilibrium = |of: &Housing| of.scene.housing.from_equilibrium;
    if scene.has_shafts_in_elements() && housings.iter().any(from_equilibrium) {
        let place = document.place_of(&About::key("housing.start"));
        return Err(format!(
            "{place}: housing.start: refused: a shaft of the scene is solved in elements, which start undeformed. Hint: \
             leave `start` out, or write method = \"reduced\" in [body.NAME.beam.mesh]"
        )
        .into());
    }
    housings.iter().try_for_each(|housing| housing.refuse(document))
}

/// Returns an error if a quasi-static scene has keys of time steps.
pub fn refuse_steps(document: &Document) -> Fallible<()> {
    const KEYS: [&str; 6] = [
        "numerics.accuracy",
        "numerics.step",
        "numerics.step_fraction",
        "numerics.integrator",
        "numerics.start",
        "numerics.energy_limit",
    ];
    let Some(key) = KEYS.into_iter().find(|key| document.is_given(key)) else { return Ok(()) };
    let place = document.place_of(&About::key(key));
    let reason = "a quasi-static sequence has no time steps";
    let hint = "leave it out, or write method = \"reduced\" in [housing]";
    Err(format!("{place}: {key}: refused: {reason}. Hint: {hint}").into())
}

pub fn condensed(housings: &[Housing]) -> Fallible<Vec<CondensedBore>> {
    housings.iter().map(Housing::condensed).collect()
}

/// Problem of a quasi-static sequence, with the races in their bores.
pub fn quasi_static_problem<'b>(
    assembly: Assembly,
    housings: &[Housing],
    bores: &'b [CondensedBore],
) -> QuasiStaticProblem<'b> {
    QuasiStaticProblem { assembly, seats: seats(housings, bores) }
}

/// Fits of the races in their bores, with their radii over time.
pub fn seats<'b>(housings: &[Housing], bores: &'b [CondensedBore]) -> Vec<QuasiStaticFit<'b>> {
    let seats = housings.iter().zip(bores);
    seats.map(|(of, bore)| of.quasi_static_fit(bore, of.setup.radius(&of.scene))).collect()
}

/// [`seats`] with the final radii of the races.
pub fn grown<'b>(housings: &[Housing], bores: &'b [CondensedBore]) -> Vec<QuasiStaticFit<'b>> {
    let seat = |(of, bore): (&Housing, &'b CondensedBore)| {
        of.quasi_static_fit(bore, Profile::Constant(of.setup.fit(&of.scene).radius))
    };
    housings.iter().zip(bores).map(seat).collect()
}

pub struct Equilibrium<'b> {
    pub still: StaticAssembly<'b>,
    pub moment: EquilibriumAt,
    /// Problem and contact search of races in bores; `None` without them.
    pub in_bores: Option<(QuasiStaticProblem<'b>, WarmStartedSearch<'b>)>,
}

/// Finds the equilibrium at t = 0, starting from the coordinates `near` if they are given.
pub fn equilibrium<'b>(
    lists: &Lists,
    seats: Vec<QuasiStaticFit<'b>>,
    near: Option<&[SVector<f64, 5>]>,
) -> Fallible<Equilibrium<'b>> {
    let mut still: StaticAssembly<'b> = super::still(lists)?;
    if seats.is_empty() {
        let solution = solve_assembly(&still, near, &StaticOptions::default())?;
        let moment = EquilibriumAt { time: 0.0, residual: 0.0, contact_changes: 0, solution };
        return Ok(Equilibrium { still, moment, in_bores: None });
    }
    seats.iter().for_each(|seat| seat.add_to(&mut still, 0.0));
    let problem = QuasiStaticProblem { assembly: lists.assembly()?.clone(), seats };
    let mut search = WarmStartedSearch::of(&problem.seats);
    search.look_near(near);
    let moment = problem.solve(&mut search, &still, 0.0)?;
    Ok(Equilibrium { still, moment, in_bores: Some((problem, search)) })
}

/// Bodies, bearings, solids, fits, bushings and shafts for explicit steps.
pub fn explicit<'p>(
    scene: &AssemblyScene,
    mut assembly: Assembly,
    housings: &[Housing],
    (bushings, shafts, cages): (&'p [BushingElements], &[ShaftElements], &[BuiltCage]),
    threads: usize,
) -> Fallible<HousedParts<'p>> {
    let start = start_of_steps(&mut assembly, housings)?;
    let mut parts = parts(scene, assembly, housings, start, threads)?;
    parts.solids.extend(shafts.iter().map(|shaft| shaft.part.clone()));
    parts.solids.extend(cages.iter().filter_map(|cage| cage.part().cloned()));
    Ok(HousedParts { bushings: bushings.iter().map(BushingElements::part).collect(), ..parts })
}

/// Bodies, bearings and undeformed housings for explicit steps, whatever start the scene gives.
pub fn undeformed(
    lists: &Lists,
    housings: &[Housing],
    threads: usize,
) -> Fallible<HousedParts<'static>> {
    parts(lists.scene, lists.assembly()?.clone(), housings, Vec::new(), threads)
}

fn parts<'p>(
    scene: &AssemblyScene,
    assembly: Assembly,
    housings: &[Housing],
    start: Vec<Vec<Vec3>>,
    threads: usize,
) -> Fallible<HousedParts<'p>> {
    let first = housings.first().map(|housing| &housing.scene.housing);
    let run = scene.run().ok_or("a run needs `end` in [numerics]")?;
    let mut start = start.into_iter();
    let (mut seats, mut solids) = (Vec::new(), Vec::new());
    for (index, housing) in housings.iter().enumerate() {
        seats.push(housing.seat(assembly.bearings[housing.bearing].mounts[1].body, index));
        let (name, model) = (housing.name.clone(), housing.setup.model.clone());
        solids.push(match start.next() {
            Some(displacement) => SolidPart::displaced(name, model, displacement),
            None => SolidPart::undeformed(name, model),
        });
    }
    // The energy balance is that of the whole scene, not of the bearings alone.
    let bearing = RunOptions { energy_limit: f64::INFINITY, ..run.options };
    let options = first.map_or(CouplingOptions::without_housings(bearing), |of| CouplingOptions {
        solid_fraction: of.step_fraction,
        seat_phase: of.coupling_phase,
        bearing,
    });
    Ok(HousedParts { assembly, solids, seats, bushings: Vec::new(), options, threads })
}

/// Moves races to the equilibrium from which explicit steps start. Returns the nodal displacements of their
/// housings there, m; empty if they start undeformed.
fn start_of_steps(assembly: &mut Assembly, housings: &[Housing]) -> Fallible<Vec<Vec<Vec3>>> {
    if housings.is_empty() || !housings.iter().all(|of| of.scene.housing.from_equilibrium) {
        return Ok(Vec::new());
    }
    let bores = condensed(housings)?;
    let seats = grown(housings, &bores);
    let mut still = static_assembly(assembly, 0.0, &[]);
    seats.iter().for_each(|seat| seat.add_to(&mut still, 0.0));
    let found = solve_with_true_distances(&still, |index, state| {
        let bore = seats[index].bore;
        let displacement = bore.displacement(&state.loads);
        let moved = bore.nodes.iter().map(|node| displacement[node.node as usize]);
        beyond_normals(bore, moved, &state.pose).collect()
    })?;
    let mut displacements = Vec::with_capacity(housings.len());
    for (seat, state) in seats.iter().zip(&found.seats) {
        let body = seat.body(assembly);
        assembly.bodies[body].rest = found.coordinates[body].into();
        displacements.push(seat.bore.displacement(&state.loads));
    }
    Ok(displacements)
}

/// Equilibrium of the bodies under the loads at t = 0, with the races in their bores.
pub fn at_start(assembly: &Assembly, seats: &[QuasiStaticFit]) -> Fallible<AssemblySolution> {
    let mut still = static_assembly(assembly, 0.0, &[]);
    seats.iter().for_each(|seat| seat.add_to(&mut still, 0.0));
    Ok(solve_assembly(&still, None, &StaticOptions::default())?)
}

/// Samples of loads between two of their corners, and the time sampled after the last corner, s.
const SAMPLES: usize = 64;
const AFTER: f64 = 1.0;

/// Largest loads on races in bores at any time, also after the end, so that an extended run keeps its reduced housings.
pub struct Largest {
    /// Radial force on all bodies except races in bores, N: the part that can cause impacts.
    pub on_bodies: f64,
    /// Radial force on all bodies and flexible shafts, with their unbalances, N.
    pub in_all: f64,
    /// Tilting moment on all bodies, N·m.
    pub moments: f64,
}

impl Largest {
    pub fn of(assembly: &Assembly, housings: &[Housing]) -> Largest {
        let in_bores: Vec<usize> =
            housings.iter().map(|of| assembly.bearings[of.bearing].mounts[1].body).collect();
        let bodies = |t: f64, included: &dyn Fn(usize) -> bool| -> [f64; 2] {
            let bodies = assembly.bodies.iter().enumerate();
            bodies
                .filter(|(index, _)| included(*index))
                .filter_map(|(_, body)| on_body(assembly, body, t))
                .fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]])
        };
        let striking = |t: f64| bodies(t, &|index| !in_bores.contains(&index))[0];
        let all = |t: f64| -> f64 {
            let shafts = assembly.shafts.iter().map(|shaft| on_shaft(assembly, shaft, t));
            shafts.fold(bodies(t, &|_| true)[0], |sum, of| sum + of)
        };
        Largest {
            on_bodies: largest(assembly, striking),
            in_all: largest(assembly, all),
            moments: largest(assembly, |t| bodies(t, &|_| true)[1]),
        }
    }
}

/// Radial force, N, and tilting moment, N·m.
fn on_body(assembly: &Assembly, body: &Body, t: f64) -> Option<[f64; 2]> {
    let loads = conditions(assembly, body, body.driven()?, t).map(|condition| match condition {
        Condition::Load(load) => load,
        Condition::Displacement(_) => 0.0,
    });
    Some([loads[1].hypot(loads[2]), loads[3].hypot(loads[4])])
}

fn on_shaft(assembly: &Assembly, shaft: &ElasticShaft, t: f64) -> f64 {
    let across = |load: &ShaftLoad| load.force[1].value(t).hypot(load.force[2].value(t));
    let speed = prescribed_speed(&assembly.bodies[shaft.body], t);
    let unbalances = shaft.unbalances.iter().map(|of| of.size * speed * speed);
    shaft.loads.iter().map(across).chain(unbalances).sum()
}

/// Largest value between corners of loads and speeds, and for [`AFTER`] after the last one.
fn largest(assembly: &Assembly, at: impl Fn(f64) -> f64) -> f64 {
    let corners = assembly.corners();
    let mut largest: f64 = at(0.0);
    let mut from = 0.0;
    for to in corners.iter().copied().chain([corners.last().unwrap_or(&0.0) + AFTER]) {
        let times = (1..=SAMPLES).map(|i| from + (to - from) * i as f64 / SAMPLES as f64);
        largest = times.map(&at).fold(largest, f64::max);
        from = to;
    }
    largest
}
