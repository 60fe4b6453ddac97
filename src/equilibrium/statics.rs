//! Static equilibrium: five coordinates of each body, two of every ball.
//!
//! The equilibrium is the minimum of contact energy minus the work of the loads. Newton's method
//! with the analytic stiffness, its step bounded by a trust radius, descends on that energy from a
//! cold start; the balls are in equilibrium at every evaluation, so that the bodies'
//! coordinates are the only unknowns of the outer loop. A bearing alone is a [`StaticProblem`].

use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::HertzContact;
use crate::equilibrium::bearing_tables::{BearingState, bearing_state};
use crate::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticBearing, StaticBody};
use crate::equilibrium::model::{Evaluation, Model};
use crate::equilibrium::search::Search;
use crate::equilibrium::verdict::{FAR, Modes};
use crate::kinematics::Pose;
use crate::members::body::Condition;
use crate::members::mount::Mount;
use crate::members::rigid_body::{fixed, kinematics_at_mount};
use crate::plan::counts::StageCounts;
use crate::solids::bore_equilibrium::{BoreSearch, BoreState};
use nalgebra::{DMatrix, DVector, SMatrix, SVector, Vector3};

pub use crate::equilibrium::error::StaticsError;

/// The five coordinates of a race, in this order: x, y, z (m), tilt_y, tilt_z (rad). The tilts are
/// the Euler angles ξ and λ of (2.16) with η = 0.
pub const COORDINATE_NAMES: [&str; 5] = ["x", "y", "z", "tilt_y", "tilt_z"];

/// A bearing, the pose of its outer race and the conditions on its inner race.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticProblem {
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    /// Azimuth of ball 1 in the outer race's frame, from +Y towards +Z, rad.
    pub ball_phase: f64,
    /// kg; only used with `gravity` or `orbital_speed`.
    pub ball_mass: f64,
    /// World axes, m/s².
    pub gravity: Vector3<f64>,
    /// Speed of the ball set about the bearing axis, rad/s (centrifugal force); 0 leaves it out.
    pub orbital_speed: f64,
    /// Frame of the inner race's five coordinates and loads, in the world.
    pub frame: Pose,
    /// Pose of the outer race in the world.
    pub outer_pose: Pose,
    /// Conditions on x, y, z, tilt_y, tilt_z of the inner race in `frame`.
    pub conditions: [Condition; 5],
}

/// Tolerances of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticOptions {
    /// Load residual at which to stop, as a fraction of the largest applied or ball load. Rounding of the overlaps
    /// limits it to about 1e-12.
    pub tolerance: f64,
    pub max_iterations: usize,
}

impl Default for StaticOptions {
    fn default() -> Self {
        StaticOptions { tolerance: 1e-11, max_iterations: 200 }
    }
}

/// One loaded or unloaded contact in the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactState {
    /// N.
    pub normal_load: f64,
    /// δ of (2.1), m; zero or negative for a gap.
    pub approach: f64,
    /// Angle of the contact normal to the race's radial plane, rad; positive for a force on the inner race towards +X.
    pub contact_angle: f64,
    /// Semi-axes of the contact ellipse, m.
    pub semi_major: f64,
    pub semi_minor: f64,
    /// Largest contact pressure, Pa.
    pub peak_pressure: f64,
    /// Force on the race, in `frame`, N.
    pub force_on_race: Vector3<f64>,
}

/// One ball in the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallState {
    /// rad, in the outer race's frame.
    pub azimuth: f64,
    /// Ball centre in `frame`, m.
    pub position: Vector3<f64>,
    pub inner: ContactState,
    pub outer: ContactState,
    /// Force of the cage on the ball along the circumference (towards larger azimuth), N: it balances contacts and
    /// weight in that direction.
    pub cage_force: f64,
}

/// Determinacy of the position under the loads.
#[derive(Clone, Debug, PartialEq)]
pub enum Determinacy {
    Determinate,
    /// The position is one of many: these directions (unit vectors over the five coordinates, tilts multiplied by the
    /// pitch radius) have no stiffness.
    Indeterminate {
        free_directions: Vec<DVector<f64>>,
    },
}

/// Equilibrium of the bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticSolution {
    /// x, y, z (m), tilt_y, tilt_z (rad) of the inner race in `frame`.
    pub coordinates: SVector<f64, 5>,
    /// Loads on the inner race: N, N, N, N·m, N·m. They are energy-conjugate to the coordinates: the moments act about
    /// Y and about the race's own (tilted) Z axis.
    pub loads: SVector<f64, 5>,
    /// ∂loads/∂coordinates, symmetric, SI units.
    pub stiffness: SMatrix<f64, 5, 5>,
    /// Sum of contact forces on the inner race and their moment about its centre, in `frame`.
    pub force_on_inner: Vector3<f64>,
    pub moment_on_inner: Vector3<f64>,
    /// Sum of contact forces on the outer race and their moment about its centre, in `frame`.
    pub force_on_outer: Vector3<f64>,
    pub moment_on_outer: Vector3<f64>,
    pub balls: Vec<BallState>,
    pub determinacy: Determinacy,
    /// Number of saddles left by the search. If not zero, symmetry lets the race tip to either side: the mirrored
    /// position is an equilibrium too.
    pub saddles_left: usize,
    /// Newton iterations on the race's coordinates.
    pub iterations: usize,
    /// Evaluations of one ball on one race, distance tests included.
    pub contact_evaluations: usize,
    /// Number of runs of each stage.
    pub ran: StageCounts,
    /// Largest load residual over the free coordinates (moments divided by the pitch radius), N.
    pub residual: f64,
}

/// Equilibrium of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblySolution {
    /// x, y, z (m), tilt_y, tilt_z (rad) of each body.
    pub coordinates: Vec<SVector<f64, 5>>,
    /// Load on each body, besides its springs: N, N, N, N·m, N·m, conjugate to the coordinates; zero for fixed bodies.
    pub loads: Vec<SVector<f64, 5>>,
    /// Modal amplitudes of each flexible body, along e₂, e₃ and the axis, m.
    pub amplitudes: Vec<Vec<f64>>,
    /// ∂loads/∂coordinates over the coordinates of all loaded bodies in their order, SI units, with modes in
    /// equilibrium.
    pub stiffness: DMatrix<f64>,
    /// The same over coordinates and amplitudes, without elimination.
    pub with_shapes: DMatrix<f64>,
    pub bearings: Vec<BearingState>,
    /// State of each race in its bore.
    pub seats: Vec<BoreState>,
    /// Of all bodies but those in bores, which count as fixed.
    pub determinacy: Determinacy,
    pub saddles_left: usize,
    pub iterations: usize,
    pub contact_evaluations: usize,
    /// Number of runs of each stage.
    pub ran: StageCounts,
    pub residual: f64,
}

/// Equilibrium from a cold start.
pub fn solve(problem: &StaticProblem) -> Result<StaticSolution, StaticsError> {
    solve_from(problem, None, &StaticOptions::default())
}

/// Equilibrium from a given position (`guess`: x, y, z in m, tilt_y, tilt_z in rad), as in a sweep with the solution of
/// the previous point; `None` is a cold start.
pub fn solve_from(
    problem: &StaticProblem,
    guess: Option<&SVector<f64, 5>>,
    options: &StaticOptions,
) -> Result<StaticSolution, StaticsError> {
    check_finite(problem)?;
    let assembly = problem.assembly();
    let near = guess.map(|guess| vec![*guess, SVector::zeros()]);
    let solution = solve_assembly(&assembly, near.as_deref(), options)?;
    Ok(StaticSolution::from(solution))
}

/// The inner race, the outer race.
const RACES: [usize; 2] = [0, 1];

impl StaticProblem {
    /// The bearing as lists: the inner race under its conditions, the outer race fixed.
    pub fn assembly(&self) -> StaticAssembly<'static> {
        let inner = Loaded {
            axes: None,
            conditions: self.conditions,
            springs: [0.0; 5],
            rest: [0.0; 5],
            start: None,
            room: self.geometry.ball_radius,
        };
        let weight =
            self.frame.orientation.inverse_transform_vector(&self.gravity) * self.ball_mass;
        let bearing = StaticBearing {
            name: None,
            geometry: self.geometry,
            inner_contact: self.inner_contact,
            outer_contact: self.outer_contact,
            mounts: RACES.map(Mount::at_centre),
            azimuths: self.geometry.azimuths(self.ball_phase),
            weight,
            centrifugal: self.ball_mass * self.orbital_speed.powi(2),
        };
        let body = |name: &str, place| StaticBody { name: name.into(), place };
        StaticAssembly {
            bodies: vec![
                body("the inner race", Place::Loaded(inner)),
                body("the outer race", Place::Fixed(self.outer_pose.relative_to(&self.frame))),
            ],
            bearings: vec![bearing],
            ..StaticAssembly::default()
        }
    }
}

impl From<AssemblySolution> for StaticSolution {
    /// Solution of a bearing alone.
    fn from(mut solution: AssemblySolution) -> StaticSolution {
        let BearingState { forces, moments, balls, .. } = solution.bearings.remove(0);
        StaticSolution {
            coordinates: solution.coordinates[0],
            loads: solution.loads[0],
            stiffness: solution.stiffness.fixed_view::<5, 5>(0, 0).into_owned(),
            force_on_inner: forces[0],
            moment_on_inner: moments[0],
            force_on_outer: forces[1],
            moment_on_outer: moments[1],
            balls,
            determinacy: solution.determinacy,
            saddles_left: solution.saddles_left,
            iterations: solution.iterations,
            contact_evaluations: solution.contact_evaluations,
            ran: solution.ran,
            residual: solution.residual,
        }
    }
}

/// Equilibrium of an assembly, searched `near` coordinates of its bodies (x, y, z in m, tilts in rad); `None` is a cold
/// start.
///
/// # Errors
///
/// No equilibrium, or none found.
pub fn solve_assembly(
    assembly: &StaticAssembly,
    near: Option<&[SVector<f64, 5>]>,
    options: &StaticOptions,
) -> Result<AssemblySolution, StaticsError> {
    let seats = assembly.seats.iter();
    let mut bores: Vec<_> = seats.map(|seat| BoreSearch::new(seat.bore, seat.penalty)).collect();
    solve_assembly_in(assembly, &mut bores, near, options)
}

/// The same with the contact in the bores as earlier searches left it.
///
/// # Errors
///
/// See [`solve_assembly`].
///
/// # Panics
///
/// If there is not one for each housing fit.
pub fn solve_assembly_in<'b>(
    assembly: &StaticAssembly<'b>,
    bores: &mut [BoreSearch<'b>],
    near: Option<&[SVector<f64, 5>]>,
    options: &StaticOptions,
) -> Result<AssemblySolution, StaticsError> {
    assert_eq!(assembly.seats.len(), bores.len(), "contact in each bore");
    match solve_directly(assembly, bores, near, options) {
        // A loose bearing under a small load has a long curved valley of the energy, along which Newton's method is
        // slow. A larger load straightens it; follow that down.
        Err(StaticsError::NotConverged { .. }) if near.is_none() => {
            unload(assembly, bores, options)
        }
        result => result,
    }
}

/// Equilibrium under ever smaller multiples of the loads, down to the loads themselves.
fn unload<'b>(
    assembly: &StaticAssembly<'b>,
    bores: &mut [BoreSearch<'b>],
    options: &StaticOptions,
) -> Result<AssemblySolution, StaticsError> {
    let mut start: Option<Vec<SVector<f64, 5>>> = None;
    let mut work = (0, 0, StageCounts::default());
    let patient = StaticOptions { max_iterations: 10 * options.max_iterations, ..*options };
    for halvings in (1..=24).rev() {
        let factor = f64::powi(2.0, halvings);
        let mut loaded = assembly.clone();
        for body in &mut loaded.bodies {
            match &mut body.place {
                Place::Fixed(_) => {}
                Place::Section(of) => of.loads = of.loads.map(|load| load * factor),
                Place::Loaded(body) => {
                    for condition in &mut body.conditions {
                        if let Condition::Load(load) = condition {
                            *load *= factor;
                        }
                    }
                }
            }
        }
        // Too large loads fail; a smaller multiple starts from the last position.
        if let Ok(solution) = solve_directly(&loaded, bores, start.as_deref(), options) {
            work.0 += solution.iterations;
            work.1 += solution.contact_evaluations;
            work.2.absorb(&solution.ran);
            start = Some(solution.coordinates);
        }
    }
    let mut solution = solve_directly(assembly, bores, start.as_deref(), &patient)?;
    solution.iterations += work.0;
    solution.contact_evaluations += work.1;
    solution.ran.absorb(&work.2);
    Ok(solution)
}

fn solve_directly<'b>(
    assembly: &StaticAssembly<'b>,
    bores: &mut [BoreSearch<'b>],
    near: Option<&[SVector<f64, 5>]>,
    options: &StaticOptions,
) -> Result<AssemblySolution, StaticsError> {
    let model = Model::new(assembly);
    let mut search = Search::new(&model, options, bores);
    let mut at = search.start();
    for (body, near) in near.into_iter().flatten().enumerate() {
        // Sections follow.
        if let Some(first) = model.first_unknown(body).filter(|first| *first < at.len()) {
            at.fixed_rows_mut::<5>(first).copy_from(near);
        }
    }
    search.impose(&mut at);
    let mut here = search.evaluate(&at)?;
    if model.steps.search {
        search.descend(&mut here)?;
    }
    // A cold start on a plane of symmetry can end on a saddle, an unstable position; so leave it along the direction of
    // negative stiffness and descend again.
    let mut modes = search.modes(&here);
    for _ in 0..5 {
        let Some(direction) = search.falling_direction(&modes) else { break };
        let [one, other] = [1.0, -1.0].map(|sign| search.moved(&here.at, &(&direction * sign)));
        let (one, other) = (search.evaluate(&one)?, search.evaluate(&other)?);
        search.saddles_left += 1;
        // The first of two equal energies.
        here = if other.energy.total_cmp(&one.energy).is_lt() { other } else { one };
        search.descend(&mut here)?;
        modes = search.modes(&here);
    }
    search.check_balance(&here)?;
    search.check_seats(&here, FAR)?;
    search.check_balls(&here)?;
    check_walls(&model, &here)?;
    solution(&mut search, here, modes)
}

/// Sleeves of bushings must stay within their walls.
fn check_walls(model: &Model, here: &Evaluation) -> Result<(), StaticsError> {
    for connection in &model.assembly.connections {
        let [one, other] = connection.ends.map(|mount| {
            kinematics_at_mount(&fixed(&model.coordinates(mount.body, &here.at).into()), &mount)
        });
        let ([.., across], wall) = (connection.extension([&one, &other]), connection.wall());
        // NaN must fail.
        if across <= wall {
            continue;
        }
        let spring = connection.name.clone();
        return Err(StaticsError::ThroughWall { spring, across, wall });
    }
    Ok(())
}

fn solution(
    search: &mut Search,
    here: Evaluation,
    modes: Modes,
) -> Result<AssemblySolution, StaticsError> {
    let model = search.model;
    let bodies = 0..model.assembly.bodies.len();
    let held = &here.gradient + &search.loads;
    let loads = bodies.clone().map(|body| match model.first_unknown(body) {
        Some(first) if first < held.len() => held.fixed_rows::<5>(first).into_owned(),
        _ => SVector::zeros(),
    });
    let shafts = 0..model.assembly.shafts.len();
    Ok(AssemblySolution {
        amplitudes: shafts.map(|shaft| model.amplitudes(shaft, &here.at).to_vec()).collect(),
        coordinates: bodies.map(|body| model.coordinates(body, &here.at)).collect(),
        loads: loads.collect(),
        bearings: (0..model.bearings.len()).map(|i| bearing_state(model, &here, i)).collect(),
        seats: search.seat_states(&here)?,
        determinacy: search.determinacy(&here, modes),
        saddles_left: search.saddles_left,
        iterations: search.iterations,
        contact_evaluations: search.contact_evaluations,
        ran: std::mem::take(&mut search.ran),
        residual: search.residual(&here),
        stiffness: of_bodies(&here.stiffness, model.bodies_end()),
        with_shapes: here.stiffness,
    })
}

/// Stiffness of the first loaded body with all others free where no motion is prescribed, N/m, N, N·m: of a shaft against
/// the ground, through its bearing and a flexible housing. `None` if another body has no stiffness of its own. With
/// `slides` the outer race, the second loaded body, slides along its bore: nothing holds the shaft axially.
pub fn stiffness_to_ground(
    still: &StaticAssembly,
    solution: &AssemblySolution,
    slides: bool,
) -> Option<SMatrix<f64, 5, 5>> {
    let whole = &solution.stiffness;
    let loaded = still.bodies.iter().filter_map(|body| match &body.place {
        Place::Loaded(loaded) => Some(loaded),
        _ => None,
    });
    let free: Vec<usize> = loaded
        .enumerate()
        .skip(1)
        .flat_map(|(place, body)| {
            let is_free = move |i: &usize| body.prescribed(*i).is_none() || slides && *i == 0;
            (0..5).filter(is_free).map(move |i| 5 * place + i)
        })
        .collect();
    let own = eliminated(whole, &[0, 1, 2, 3, 4], &free)?;
    let mut own = own.fixed_view::<5, 5>(0, 0).into_owned();
    if slides {
        // But for rounding.
        own.row_mut(0).fill(0.0);
        own.column_mut(0).fill(0.0);
    }
    Some(own)
}

/// Stiffness over the `kept` coordinates with the `free` ones in equilibrium; `None` where these have no stiffness.
fn eliminated(whole: &DMatrix<f64>, kept: &[usize], free: &[usize]) -> Option<DMatrix<f64>> {
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| whole[(rows[i], columns[j])])
    };
    let cross = part(free, kept);
    let follows = part(free, free).cholesky()?.solve(&cross);
    Some(part(kept, kept) - cross.transpose() * follows)
}

/// Stiffness over the coordinates of bodies, with amplitudes in equilibrium.
fn of_bodies(whole: &DMatrix<f64>, bodies: usize) -> DMatrix<f64> {
    let own: Vec<usize> = (0..bodies).collect();
    let shapes: Vec<usize> = (bodies..whole.nrows()).collect();
    let alone = || whole.view((0, 0), (bodies, bodies)).into_owned();
    if shapes.is_empty() {
        return alone();
    }
    // In a stable equilibrium their stiffness is positive.
    eliminated(whole, &own, &shapes).unwrap_or_else(alone)
}

pub(crate) fn check_finite(problem: &StaticProblem) -> Result<(), StaticsError> {
    let loads = problem.conditions.iter().map(|condition| match condition {
        Condition::Load(value) => ("a load", *value),
        Condition::Displacement(value) => ("a displacement", *value),
    });
    let geometry = &problem.geometry;
    let others = [
        ("ball_radius", geometry.ball_radius),
        ("the inner groove's centre", geometry.inner.centre_radius + geometry.inner.centre_axial),
        ("the outer groove's centre", geometry.outer.centre_radius + geometry.outer.centre_axial),
        ("a groove radius", geometry.inner.groove_radius + geometry.outer.groove_radius),
        ("pitch_radius", geometry.pitch_radius),
        ("ball_phase", problem.ball_phase),
        ("orbital_speed", problem.orbital_speed),
        ("ball_mass", problem.ball_mass),
        ("gravity", problem.gravity.sum()),
        ("the inner contact's stiffness", problem.inner_contact.stiffness),
        ("the outer contact's stiffness", problem.outer_contact.stiffness),
        ("the outer race's position", problem.outer_pose.position.sum()),
        ("the frame's position", problem.frame.position.sum()),
    ];
    for (what, value) in loads.chain(others) {
        if !value.is_finite() {
            return Err(StaticsError::NotFinite { what, value });
        }
    }
    Ok(())
}
