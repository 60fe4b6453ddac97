//! A bearing whose outer race sits in a condensed bore, by itself: one equilibrium, and equilibria along a quasi-static
//! sequence. The tests of housings use it too.

use bearing_dynamics::ch2_housing::bearing::frequencies::ratios;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticSeat};
use bearing_dynamics::equilibrium::quasi_static_limit::MovingBody;
use bearing_dynamics::equilibrium::statics::{
    AssemblySolution, StaticProblem, StaticSolution, StaticsError,
};
use bearing_dynamics::equilibrium::warm_started_search::{
    WarmStartedSearch, load_of_balls, unbalanced,
};
use bearing_dynamics::kinematics::vec3::{Vec3, add};
use bearing_dynamics::members::body::{Condition, RotatingLoad};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::bore_equilibrium::{BoreSearch, BoreState, Fit, RaceLoad};
use bearing_dynamics::solids::condensation::{CondensedBore, placed};
use nalgebra::{DMatrix, Vector3};

/// Bearing and housing in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct HousedState {
    /// The bearing with its outer race where the bore holds it.
    pub bearing: StaticSolution,
    pub bore: BoreState,
    /// Over the coordinates of the inner and of the outer race.
    pub stiffness: DMatrix<f64>,
    /// Wrench on the outer race from all but the bore, in its nominal axes, about its own centre.
    pub on_outer: RaceLoad,
    /// Unbalanced load of the outer race over the load on it.
    pub residual: f64,
    /// Newton iterations, and changes of the nodes that touch in all of them.
    pub iterations: usize,
    pub contact_changes: usize,
}

/// A search that starts from what it found last.
pub struct HousedSearch<'b> {
    pub search: WarmStartedSearch<'b>,
}

/// Bodies of the lists.
const INNER: usize = 0;
pub const OUTER: usize = 1;

impl<'b> HousedSearch<'b> {
    pub fn new(bore: &'b CondensedBore, penalty: Penalty) -> HousedSearch<'b> {
        HousedSearch { search: WarmStartedSearch::new([(bore, penalty)]) }
    }

    pub fn bore(&self) -> &BoreSearch<'b> {
        &self.search.bores()[0]
    }

    /// Equilibrium of `bearing`, whose `outer_pose` is looked for, in the bore; `weight` is a further force on the outer
    /// race, N in the world.
    ///
    /// # Errors
    /// No equilibrium of both together, a load along the axis that nothing takes.
    pub fn solve(
        &mut self,
        bearing: &StaticProblem,
        fit: &Fit,
        weight: Vec3,
    ) -> Result<HousedState, StaticsError> {
        let bore = self.bore();
        let assembly = lists(bearing, bore.bore(), bore.penalty(), fit, weight);
        let before = self.search.contact_changes();
        let solution = self.search.solve(&assembly)?;
        let contact_changes = self.search.contact_changes() - before;
        self.state(bearing, fit, solution, weight)
            .map(|state| HousedState { contact_changes, ..state })
    }

    fn state(
        &self,
        bearing: &StaticProblem,
        fit: &Fit,
        mut solution: AssemblySolution,
        weight: Vec3,
    ) -> Result<HousedState, StaticsError> {
        let bore = solution.seats.remove(0);
        let of = self.bore().bore();
        let pose = placed(&of.reach.nominal, &bore.pose).relative_to(&bearing.frame);
        let stiffness = solution.stiffness.clone();
        let found = StaticSolution::from(solution);
        let of_balls = [found.force_on_outer, found.moment_on_outer];
        let [force, moment] = load_of_balls(of_balls, &found.balls, &pose);
        let turned = |vector: Vector3<f64>| Vec3::from(bearing.frame.orientation * vector);
        let on_outer = RaceLoad {
            force: of.to_nominal(add(turned(force), weight)),
            moment: of.to_nominal(turned(moment)),
        };
        let residual = unbalanced(fit, &on_outer, &bore, &found.balls)
            .map_err(|source| StaticsError::Seat { of: String::new(), source })?;
        Ok(HousedState {
            on_outer,
            residual,
            iterations: found.iterations,
            contact_changes: 0,
            bearing: found,
            bore,
            stiffness,
        })
    }
}

/// Inner race, outer race and bore, in the bearing's frame. The outer race's coordinates count from its nominal pose; it
/// is fixed along its axis.
pub fn lists<'b>(
    bearing: &StaticProblem,
    bore: &'b CondensedBore,
    penalty: Penalty,
    fit: &Fit,
    weight: Vec3,
) -> StaticAssembly<'b> {
    let mut assembly = bearing.assembly();
    let nominal = bore.reach.nominal.relative_to(&bearing.frame);
    let [_, y, z] = bore.to_nominal(weight);
    let mut conditions = [0.0, y, z, 0.0, 0.0].map(Condition::Load);
    conditions[0] = Condition::Displacement(0.0);
    assembly.bodies[OUTER].place = Place::Loaded(Loaded {
        axes: Some(Box::new(nominal)),
        conditions,
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: fit.radius,
    });
    let mount = Mount::at_centre(OUTER);
    assembly.seats.push(StaticSeat { name: None, mount, nominal, bore, penalty, fit: *fit });
    assembly
}

/// Both races as bodies of natural motions; the inner one moves along these of its coordinates, the outer one is fixed
/// along its axis.
pub fn moving([inner, outer]: [Inertia; 2], free: [bool; 5]) -> Vec<MovingBody> {
    let held = [false, true, true, true, true];
    vec![
        MovingBody { body: INNER, inertia: inner, free },
        MovingBody { body: OUTER, inertia: outer, free: held },
    ]
}

/// What changes over time. Balls go round at the speed of the cage in pure rolling.
#[derive(Clone, Debug, PartialEq)]
pub struct QuasiStaticSequence {
    /// Ascending, s.
    pub times: Vec<f64>,
    /// On the inner race, instead of the bearing's conditions: loads stay loads and displacements displacements.
    pub conditions: [Profile; 5],
    /// Besides them, on y and z.
    pub rotating_load: Option<RotatingLoad>,
    /// Of the inner race, rad/s; its balls roll.
    pub shaft_speed: Profile,
    /// Added to the race's radius, m: the outer race grows into its fit.
    pub interference: Profile,
    /// Whether balls press outwards as they go round.
    pub centrifugal: bool,
}

/// Bearing and housing at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// s.
    pub time: f64,
    pub state: HousedState,
}

/// Equilibria at the times of a course. `fit.radius` is the race's before it grows.
///
/// # Errors
/// Those of the first time at which there is no equilibrium.
pub fn history(
    search: &mut HousedSearch,
    bearing: &StaticProblem,
    fit: &Fit,
    course: &QuasiStaticSequence,
) -> Result<Vec<Moment>, StaticsError> {
    let geometry = &bearing.geometry;
    let cage = ratios(
        geometry.ball_count,
        geometry.ball_radius,
        geometry.pitch_radius,
        geometry.contact_angle,
    )
    .cage;
    let mut problem = bearing.clone();
    let at = |&time: &f64| {
        let turning = course.rotating_load.as_ref().map_or([0.0; 3], |load| load.force(time));
        for (i, (condition, profile)) in
            problem.conditions.iter_mut().zip(&course.conditions).enumerate()
        {
            let value = profile.value(time);
            *condition = match condition {
                Condition::Load(_) => {
                    Condition::Load(value + turning.get(i).copied().unwrap_or(0.0))
                }
                Condition::Displacement(_) => Condition::Displacement(value),
            };
        }
        problem.ball_phase = bearing.ball_phase + cage * course.shaft_speed.integral(time);
        let turns = if course.centrifugal { course.shaft_speed.value(time) } else { 0.0 };
        problem.orbital_speed = cage * turns;
        let grown = Fit { radius: fit.radius + course.interference.value(time), ..*fit };
        let state = search.solve(&problem, &grown, [0.0; 3])?;
        Ok(Moment { time, state })
    };
    course.times.iter().map(at).collect()
}
