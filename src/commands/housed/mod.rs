//! The commands on a scene with a bearing in a flexible housing; here what they share.

pub mod check;
pub mod echo;
pub mod plan;
pub mod reduced;
pub mod statics;

use super::memory::watched;
use super::solid::mesh_notes;
use super::{echo_run, placed, say};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::output::course::{masses, moments, on_inner, on_outer};
use bearing_dynamics::output::fields::bore::{BoreNodeState, bore_series};
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::output::session::{HousedParts, RunRequest};
use bearing_dynamics::scene::about::About;
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::scene::housing::{HousedScene, HousingMethod};
use bearing_dynamics::scene::housing_problem::{
    HousingSetup, check_constant, check_supports, excitations, setup,
};
use bearing_dynamics::scene::solid_mesh::{BuiltMesh, build_housing};
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::scene::{DefaultUsed, Document, RunSettings};
use bearing_dynamics::solver::dynamics::assembly::{Assembly, OUTER};
use bearing_dynamics::solver::dynamics::equilibrium::static_assembly;
use bearing_dynamics::solver::dynamics::model::Drive;
use bearing_dynamics::solver::dynamics::run::{RunOptions, Start};
use bearing_dynamics::solver::housing::bore_equilibrium::BoreSearch;
use bearing_dynamics::solver::housing::condensed::{
    CondensedBore, Sizes, condense_over, cost, sizes,
};
use bearing_dynamics::solver::housing::course_inertia::{
    CourseInertia, CourseLooks, course_inertia,
};
use bearing_dynamics::solver::housing::exchange::{ExchangeOptions, SolidPart};
use bearing_dynamics::solver::housing::housed::{HousedSearch, HousedState};
use bearing_dynamics::solver::housing::inertia::{InertiaEstimate, estimate};
use bearing_dynamics::solver::housing::seat::Seat;
use bearing_dynamics::solver::mount::Mount;
use bearing_dynamics::solver::plan::Item;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::support::free_motions;
use bearing_dynamics::solver::solid::tangent::Unknowns;
use bearing_dynamics::solver::sparse::Cost;
use bearing_dynamics::solver::static_assembly::{StaticAssembly, StaticSeat};
use bearing_dynamics::solver::statics::{Condition, StaticOptions, StaticProblem, solve_assembly};
use std::error::Error;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::time::Instant;

type Fallible<T> = Result<T, Box<dyn Error>>;

/// Part of the race's radius beyond which nodes of the bore count as out of reach until something
/// has moved: many times what races move in their seats.
const REACH: f64 = 2e-3;

pub struct Prepared {
    pub built: BuiltMesh,
    pub setup: HousingSetup,
    pub mesh_seconds: f64,
}

/// Reads or makes the mesh; the document says where in the scene an error stands.
pub fn prepare(document: &Document, scene: &HousedScene) -> Fallible<Prepared> {
    let start = Instant::now();
    let mut built = build_housing(scene).map_err(|error| placed(document, error.about(), error))?;
    let setup = setup(scene, &built).map_err(|error| placed(document, error.about(), error))?;
    built.notes.extend(setup.solid.notes.iter().chain(&setup.notes).cloned());
    Ok(Prepared { built, setup, mesh_seconds: start.elapsed().as_secs_f64() })
}

/// What a reduced housing cannot have.
pub fn refuse_moved_supports(document: &Document, scene: &HousedScene) -> Fallible<()> {
    check_supports(scene).map_err(|error| placed(document, error.about(), error))
}

/// What is said of steps where nothing is stepped in time.
pub fn refuse_steps(document: &Document) -> Fallible<()> {
    const KEYS: [&str; 4] =
        ["numerics.accuracy", "numerics.step", "numerics.step_fraction", "numerics.integrator"];
    let Some(key) = KEYS.into_iter().find(|key| document.is_given(key)) else { return Ok(()) };
    let place = document.place_of(&About::key(key));
    let reason = "equilibria one after the other take no steps in time";
    let hint = "leave it out, or write method = \"reduced\" in [housing]";
    Err(format!("{place}: {key}: refused: {reason}. Hint: {hint}").into())
}

/// What a condensed housing cannot have.
pub fn refuse_moving(document: &Document, scene: &HousedScene) -> Fallible<()> {
    refuse_steps(document)?;
    check_constant(scene).map_err(|error| placed(document, error.about(), error))
}

/// A housing that can move as a whole.
pub fn refuse_free(prepared: &Prepared) -> Fallible<()> {
    let free = free_motions(&prepared.setup.solid.problem);
    if free.count == 0 {
        return Ok(());
    }
    Err(format!(
        "an equilibrium needs a housing that is held, and this one is free to move {}; add \
         [[solid.held]]",
        free.names()
    )
    .into())
}

/// What condensing the housing onto the nodes of its bore takes, from its structure alone.
pub fn condensing(prepared: &Prepared) -> Fallible<(Unknowns, Sizes, Cost)> {
    refuse_free(prepared)?;
    let setup = &prepared.setup;
    let unknowns = Unknowns::new(&setup.model);
    let sizes = sizes(&setup.model, &unknowns, &setup.nodes, &setup.reach())?;
    let cost = cost(&setup.model, &unknowns, &sizes);
    Ok((unknowns, sizes, cost))
}

/// The housing condensed onto the nodes of its bore under the race.
pub fn condensed(prepared: &Prepared) -> Fallible<CondensedBore> {
    let setup = &prepared.setup;
    let (unknowns, _, cost) = condensing(prepared)?;
    let condense = || condense_over(&setup.model, unknowns.clone(), &setup.nodes, &setup.reach());
    Ok(watched(&cost, &unknowns, INSTEAD, condense)??)
}

/// What needs no factors.
const INSTEAD: &str = ", explicit steps (method = \"explicit\" in [housing])";

pub fn search<'b>(scene: &HousedScene, bore: &'b CondensedBore) -> HousedSearch<'b> {
    let bore = BoreSearch::new(bore, scene.housing.penalty);
    HousedSearch::new(bore)
}

/// The bearing in equilibrium at time `t`, under all loads that it has then.
pub fn bearing_at(scene: &HousedScene, t: f64) -> Fallible<StaticProblem> {
    let problem = static_problem(&scene.bearing)?;
    Ok(StaticProblem { conditions: on_inner(scene, t), ..problem })
}

/// Equilibrium of both at time `t`, the race grown into its fit.
pub fn equilibrium_at(
    scene: &HousedScene,
    setup: &HousingSetup,
    search: &mut HousedSearch,
    t: f64,
) -> Fallible<(StaticProblem, HousedState)> {
    let problem = bearing_at(scene, t)?;
    let state = search.solve(&problem, &setup.fit(scene), on_outer(scene, t))?;
    Ok((problem, state))
}

/// When the radial load on the inner race is largest.
pub fn most_loaded(scene: &HousedScene) -> f64 {
    let Some(run) = &scene.bearing.dynamics.run else { return 0.0 };
    let load = |t: f64| {
        let on_axis = |condition: &Condition| match condition {
            Condition::Load(load) => load.abs(),
            // A displacement of a micrometre takes some hundred newtons.
            Condition::Displacement(way) => 1e8 * way.abs(),
        };
        let conditions = on_inner(scene, t);
        on_axis(&conditions[1]).max(on_axis(&conditions[2]))
    };
    const LOOKS: u32 = 400;
    let times = (0..=LOOKS).map(|i| run.end * f64::from(i) / f64::from(LOOKS));
    times.max_by(|a, b| load(*a).total_cmp(&load(*b))).unwrap_or(0.0)
}

/// What leaving out inertia costs, about the equilibrium under the largest load.
pub fn inertia_estimate(
    scene: &HousedScene,
    setup: &HousingSetup,
    bore: &CondensedBore,
) -> Fallible<Option<InertiaEstimate>> {
    let mut search = search(scene, bore);
    let (problem, state) = equilibrium_at(scene, setup, &mut search, most_loaded(scene))?;
    Ok(estimate_at(scene, &problem, &search, &state))
}

/// About an equilibrium. Along the axis, where the bearing is soft and nothing drives it, the inner
/// race counts as held. Nothing for a race that nothing holds.
pub fn estimate_at(
    scene: &HousedScene,
    problem: &StaticProblem,
    search: &HousedSearch,
    state: &HousedState,
) -> Option<InertiaEstimate> {
    let mut problem = problem.clone();
    let along = &scene.bearing.dynamics.inner.drives[0];
    if matches!(along, Drive::Load(Profile::Constant(_))) {
        problem.conditions[0] = Condition::Displacement(state.bearing.coordinates[0]);
    }
    let found = estimate(&problem, search, state, &masses(scene)?);
    Some(found).filter(|found| found.lowest > 0.0 && found.lowest.is_finite())
}

/// Looks at a course: so many for each turn of a load, at most so many, fewest.
const LOOKS: [f64; 3] = [720.0, 2880.0, 720.0];

/// What inertia would add along the scene's run. Nothing for one in which nothing moves.
pub fn along_course(
    scene: &HousedScene,
    setup: &HousingSetup,
    bore: &CondensedBore,
) -> Fallible<Option<CourseInertia>> {
    let dynamics = &scene.bearing.dynamics;
    let (Some(run), Some(masses)) = (&dynamics.run, masses(scene)) else { return Ok(None) };
    if excitations(scene).is_empty() {
        return Ok(None);
    }
    let turns = dynamics.rotating_load.as_ref().map_or(0.0, |load| load.angle(run.end).abs()) / TAU;
    let [a_turn, most, fewest] = LOOKS;
    let drives = &dynamics.inner.drives;
    let mut free = [0, 1, 2, 3, 4].map(|i| matches!(drives[i], Drive::Load(_)));
    // As in the estimate about one equilibrium.
    free[0] &= !matches!(drives[0], Drive::Load(Profile::Constant(_)));
    let looks = CourseLooks {
        start: 0.0,
        end: run.end,
        count: (a_turn * turns).clamp(fewest, most) as usize,
        corners: dynamic_problem(&scene.bearing)?.assembly().corners(),
        masses,
        free,
        damping: setup.solid.problem.damping,
    };
    let problem = static_problem(&scene.bearing)?;
    let mut search = search(scene, bore);
    let found = course_inertia(&looks, &mut search, |search, time| {
        let mut moments = moments(scene, setup, &problem, search, time)?;
        moments
            .pop()
            .map(|moment| moment.state)
            .ok_or("no equilibrium")
            .map_err(Box::<dyn Error>::from)
    })?;
    Ok(Some(found).filter(|found| found.swing > 0.0 || found.displacement > 0.0))
}

/// Bearing, housing and seat for explicit steps.
pub fn parts(
    scene: &HousedScene,
    prepared: &Prepared,
    run: &RunSettings,
    threads: usize,
) -> Fallible<HousedParts> {
    let setup = &prepared.setup;
    let mut assembly = dynamic_problem(&scene.bearing)?.assembly();
    let start = start_of_steps(&mut assembly, &[(0, scene, prepared)])?.pop();
    let model = setup.model.clone();
    let solid = match start {
        Some(displacement) => SolidPart { name: None, model, displacement },
        None => SolidPart::undeformed(None, model),
    };
    let (seats, options) = (vec![seat(scene, setup, OUTER, 0)], exchange_options(scene, run));
    Ok(HousedParts { assembly, solids: vec![solid], seats, options, threads })
}

/// Puts races that explicit steps start from where all is in equilibrium; how far the nodes of their housings have
/// gone there, m. Nothing where they start undeformed. With the index of each bearing.
pub fn start_of_steps(
    assembly: &mut Assembly,
    housings: &[(usize, &HousedScene, &Prepared)],
) -> Fallible<Vec<Vec<Vec3>>> {
    if !housings.iter().all(|(_, scene, _)| scene.housing.from_equilibrium) {
        return Ok(Vec::new());
    }
    let bores: Vec<CondensedBore> =
        housings.iter().map(|(.., prepared)| condensed(prepared)).collect::<Result<_, _>>()?;
    let mut still = static_assembly(assembly, 0.0, &[]);
    for ((bearing, scene, prepared), bore) in housings.iter().zip(&bores) {
        add_seat(&mut still, *bearing, scene, prepared, bore);
    }
    let found = solve_assembly(&still, None, &StaticOptions::default())?;
    let mut displacements = Vec::with_capacity(housings.len());
    for (((bearing, ..), bore), state) in housings.iter().zip(&bores).zip(&found.seats) {
        let body = assembly.bearings[*bearing].mounts[1].body;
        assembly.bodies[body].rest = found.coordinates[body].into();
        displacements.push(bore.displacement(&state.loads));
    }
    Ok(displacements)
}

/// Adds the outer race of a bearing in its bore, grown into its fit, to what is in equilibrium.
pub fn add_seat<'b>(
    still: &mut StaticAssembly<'b>,
    bearing: usize,
    scene: &HousedScene,
    prepared: &Prepared,
    bore: &'b CondensedBore,
) {
    let body = still.bearings[bearing].mounts[1].body;
    still.seats.push(StaticSeat {
        name: still.bearings[bearing].name.clone(),
        mount: Mount::at_centre(body),
        nominal: bore.reach.nominal,
        bore,
        penalty: scene.housing.penalty,
        fit: prepared.setup.fit(scene),
    });
}

/// The race of a body in the bore of explicit solid `solid`.
pub fn seat(scene: &HousedScene, setup: &HousingSetup, body: usize, solid: usize) -> Seat {
    Seat {
        name: None,
        mount: Mount::at_centre(body),
        solid,
        radius: setup.radius(scene),
        width: setup.width,
        penalty: scene.housing.penalty,
        nodes: setup.nodes.clone(),
        reach: REACH * setup.bore_radius,
    }
}

/// How housings and bearings exchange.
pub fn exchange_options(scene: &HousedScene, run: &RunSettings) -> ExchangeOptions {
    ExchangeOptions {
        solid_fraction: scene.housing.step_fraction,
        seat_phase: scene.housing.window_phase,
        // All together are balanced, not the bearings alone.
        bearing: RunOptions { energy_limit: f64::INFINITY, ..run.options },
    }
}

pub fn request(scene: &HousedScene, run: &RunSettings) -> RunRequest {
    // With the channels that a plot needs.
    let mut request = super::run::request(&scene.bearing, run);
    if scene.housing.method == HousingMethod::Reduced {
        // Where the outer race and the housing start is in the assembly.
        request.options.start = Start::Equilibrium;
    }
    RunRequest { fields_interval: scene.housing.fields_interval, ..request }
}

/// Defaults in use for bearing, seat and housing; of a course of equilibria without what only
/// motion needs.
pub fn defaults(scene: &HousedScene) -> Vec<DefaultUsed> {
    const OF_MOTION: [&str; 8] = [
        "traction",
        "contact_damping",
        "ball_contact",
        "numerics.start",
        "numerics.integrator",
        "numerics.step_fraction",
        "numerics.accuracy",
        "numerics.energy_limit",
    ];
    let mut all = echo_run::defaults(&scene.bearing);
    for used in all.iter_mut().filter(|used| used.reason.starts_with("where the outer race starts"))
    {
        used.reason = "where the outer race starts, before loads and the housing move it".into();
    }
    if scene.housing.method == HousingMethod::QuasiStatic {
        all.retain(|used| !OF_MOTION.iter().any(|part| used.key.starts_with(part)));
    }
    all.extend_from_slice(&scene.housing.defaults_used);
    all.extend_from_slice(&scene.solid.defaults_used);
    all
}

/// Scene, assumptions, defaults and plan, as every summary has them.
pub fn record(
    scene: &HousedScene,
    plan: Vec<Item>,
    seconds: Vec<(String, f64)>,
) -> Fallible<RunRecord> {
    let assumptions = &scene.bearing.assumptions;
    Ok(super::record(echo::scene(scene)?, plan, assumptions, &defaults(scene), seconds))
}

/// Nodes and elements as a person counts them.
pub fn mesh_text(built: &BuiltMesh) -> String {
    let mesh = &built.mesh;
    let nodes_each = if mesh.order() == Order::Linear { 4 } else { 10 };
    format!("{} nodes, {} elements of {nodes_each}", mesh.nodes.len(), mesh.elements.len())
}

/// How round the bore is, and where.
pub fn shape_text(setup: &HousingSetup) -> String {
    format!(
        "{:.4} um out of round, axis {:.4} um from the race's centre",
        1e6 * setup.out_of_round,
        1e6 * setup.off_centre
    )
}

/// What a person should know of mesh and bore before results.
pub fn notes(prepared: &Prepared) -> Vec<String> {
    let caution = prepared.setup.caution.iter().map(|caution| format!("caution: {caution}"));
    mesh_notes(&prepared.built).into_iter().chain(caution).collect()
}

/// Says these.
pub fn say_notes(prepared: &Prepared) -> Fallible<()> {
    notes(prepared).iter().try_for_each(|note| say(&format!("note: {note}\n")))
}

/// Writes the table of the bore's nodes.
pub fn write_bore(folder: &Path, bore: &[BoreNodeState]) -> Fallible<PathBuf> {
    let path = folder.join("bore.csv");
    bore_series(bore)?.write_csv(&path)?;
    Ok(path)
}
