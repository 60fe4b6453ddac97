//! One turn of a load on the bearing in a housing, by two roads: equilibria of bearing and condensed
//! housing, and explicit steps of both.

use std::f64::consts::TAU;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::OUTER;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::members::body::{Drive, RotatingLoad};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingOptions, SolidPart};
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::model::SolidModel;

use crate::case::CaseError;
use crate::housed::{HousedSearch, HousedState, Moment, QuasiStaticSequence, history};
use crate::housings::{self, BORE_RADIUS, WIDTH, angles};
use crate::motion;
use crate::pareto::Stopwatch;
use crate::solids::largest;

/// N, as in 2.4.2.
pub const LOAD: f64 = 250.0;
/// Directions of the load in a turn.
pub const POINTS: usize = 72;
/// Part of a turn's time in which the load comes to its speed: some periods of races and housing, so
/// that they do not ring.
const RUN_UP: f64 = 0.125;
/// CouplingSteps of the exchange, as the phase of the outer race on its seat in one of them, and steps of
/// the housing as a part of their limit.
const SEAT_PHASE: f64 = 0.5;
const SOLID_FRACTION: f64 = 0.9;

/// 250 N that start along +Y, come to their speed smoothly, and look at even angles from then on.
#[derive(Clone, Debug)]
pub struct Turning {
    pub load: RotatingLoad,
    /// Which of the even angles of a turn, and when, s.
    pub places: Vec<usize>,
    pub times: Vec<f64>,
    /// Between race and bore, m.
    pub interference: f64,
}

impl Turning {
    /// `speed` in rad/s.
    pub fn new(speed: f64) -> Turning {
        let duration = RUN_UP * TAU / speed;
        let rise = Profile::SmoothRamp { from: 0.0, to: speed, start: 0.0, duration };
        let load = RotatingLoad { force: Profile::Constant(LOAD), speed: rise, phase: 0.0 };
        // Half the way of the full speed is made while it is reached.
        let at = |angle: f64| 0.5 * duration + angle / speed;
        let (places, times) =
            angles(POINTS).map(at).enumerate().filter(|(_, time)| *time >= duration).unzip();
        Turning { load, places, times, interference: 0.0 }
    }

    /// The same load without its run-up, all around.
    pub fn steady(speed: f64) -> Turning {
        let load = RotatingLoad {
            force: Profile::Constant(LOAD),
            speed: Profile::Constant(speed),
            phase: 0.0,
        };
        let times = angles(POINTS).map(|angle| angle / speed).collect();
        Turning { load, places: (0..POINTS).collect(), times, interference: 0.0 }
    }
}

/// One equilibrium after the other, `visit` called after each.
pub fn equilibria(
    search: &mut HousedSearch,
    turning: &Turning,
    times: &[f64],
    mut visit: impl FnMut(&HousedSearch, &Moment),
) -> Result<Vec<Moment>, CaseError> {
    let bearing = housings::bearing()?;
    let mut moments = Vec::new();
    for &time in times {
        let course = QuasiStaticSequence {
            times: vec![time],
            conditions: [0; 5].map(|_| Profile::ZERO),
            rotating_load: Some(turning.load.clone()),
            shaft_speed: Profile::ZERO,
            interference: Profile::ZERO,
            centrifugal: false,
        };
        for moment in history(search, &bearing, &housings::fit(turning.interference), &course)? {
            visit(search, &moment);
            moments.push(moment);
        }
    }
    Ok(moments)
}

/// y and z of the outer race, m.
pub fn outer_place(state: &HousedState) -> [f64; 2] {
    [state.bore.pose[0], state.bore.pose[1]]
}

/// What an explicit run leaves.
#[derive(Clone, Debug)]
pub struct ExplicitTurn {
    /// y and z of the outer race at the times of the course, m.
    pub outer: Vec<[f64; 2]>,
    /// s, and how many of them.
    pub coupling_step: f64,
    pub coupling_steps: u64,
    pub solid_steps: usize,
    pub elements: usize,
    /// Energy unaccounted for over all that was turned over, the largest at these times.
    pub residual: f64,
    /// Of the steps alone, s.
    pub seconds: f64,
}

/// The seat of Table 2.2's outer race in a bore.
pub fn seat(mesh: &TetMesh) -> Result<Seat, CaseError> {
    Ok(Seat {
        name: None,
        mount: Mount::at_centre(OUTER),
        solid: 0,
        radius: Profile::Constant(BORE_RADIUS),
        width: WIDTH,
        penalty: Penalty::default(),
        friction: None,
        nodes: housings::bore_nodes(mesh)?,
        reach: f64::INFINITY,
    })
}

/// The coupling steps of the plain runs; the bearing takes one step in each.
pub fn options() -> CouplingOptions {
    CouplingOptions {
        solid_fraction: SOLID_FRACTION,
        seat_phase: SEAT_PHASE,
        bearing: motion::fixed_step(2e-6),
    }
}

/// From `start`, equilibrium under the load's first direction, with the displacements of its housing.
pub fn explicit(
    mesh: &TetMesh,
    model: SolidModel,
    start: &HousedState,
    displacement: Vec<[f64; 3]>,
    turning: &Turning,
) -> Result<ExplicitTurn, CaseError> {
    let [y, z, tilt_y, tilt_z] = start.bore.pose;
    let mut problem = DynamicProblem {
        rotating_load: Some(turning.load.clone()),
        outer_start: [0.0, y, z, tilt_y, tilt_z],
        ..housings::mounted([0.0; 5])?
    };
    if let Some(outer) = &mut problem.outer {
        outer.drives[0] = Drive::Motion(Profile::ZERO);
    }
    let elements = model.problem.elements.len();
    let radius = Profile::Constant(BORE_RADIUS + turning.interference);
    let seat = Seat { radius, ..seat(mesh)? };
    let mut housed = CoupledMotion::new(
        problem,
        vec![SolidPart::displaced(None, model, displacement)],
        vec![seat],
        &options(),
    )?;
    let place = |housed: &CoupledMotion| {
        let [_, y, z] = housed.simulation.body(OUTER).position;
        (housed.time(), [y, z])
    };
    let watch = Stopwatch::start();
    let (mut outer, mut residual) = (Vec::new(), 0.0);
    let mut now = place(&housed);
    for &time in &turning.times {
        let mut before = now;
        while now.0 < time {
            before = now;
            housed.advance()?;
            now = place(&housed);
        }
        // A coupling step is next to nothing of a turn; at the start there is none yet.
        let part = if now.0 > before.0 { (time - before.0) / (now.0 - before.0) } else { 0.0 };
        outer.push([0, 1].map(|i| before.1[i] + part * (now.1[i] - before.1[i])));
        let snapshot = housed.snapshot()?;
        residual = largest([residual, snapshot.residual.abs() / snapshot.turned_over]);
    }
    Ok(ExplicitTurn {
        outer,
        coupling_step: housed.coupling_step,
        coupling_steps: housed.exchanges,
        solid_steps: housed.solids[0].steps,
        elements,
        residual,
        seconds: watch.seconds(),
    })
}
