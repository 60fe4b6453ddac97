//! A bearing whose outer race sits in a condensed bore, as lists for the one search for an equilibrium.

use super::bore_equilibrium::{BoreError, BoreSearch, BoreState, Fit, RaceLoad, check_load};
use super::condensed::{CondensedBore, placed};
use super::course_search::{CourseSearch, load_of_balls, unbalanced};
use super::inertia::MovingBody;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::bore_contact::Penalty;
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, add};
use crate::solver::mount::Mount;
use crate::solver::plan::tally::Ran;
use crate::solver::static_assembly::{Loaded, Place, StaticAssembly, StaticBody, StaticSeat};
use crate::solver::statics::{
    AssemblySolution, Condition, StaticOptions, StaticProblem, StaticSolution, StaticsError,
    check_finite, solve_assembly_in,
};
use nalgebra::{DMatrix, SVector, Vector3};

/// Bearing and housing in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct HousedState {
    /// The bearing with its outer race where the bore holds it.
    pub bearing: StaticSolution,
    pub bore: BoreState,
    /// Over the coordinates of the inner and of the outer race.
    pub stiffness: DMatrix<f64>,
    /// What acts on the outer race besides the bore, in its nominal axes, about its own centre.
    pub on_outer: RaceLoad,
    /// Unbalanced load of the outer race over the load on it.
    pub residual: f64,
    /// Newton iterations, and changes of the nodes that touch in all of them.
    pub iterations: usize,
    pub contact_changes: usize,
    pub contact_evaluations: usize,
    /// How often each stage ran.
    pub ran: Ran,
}

/// A search that starts from what it found last.
pub struct HousedSearch<'b> {
    pub search: CourseSearch<'b>,
}

/// Bodies of the lists.
const INNER: usize = 0;
pub const OUTER: usize = 1;

impl<'b> HousedSearch<'b> {
    pub fn new(bore: &'b CondensedBore, penalty: Penalty) -> HousedSearch<'b> {
        HousedSearch { search: CourseSearch::new([(bore, penalty)]) }
    }

    pub fn bore(&self) -> &BoreSearch<'b> {
        &self.search.bores()[0]
    }

    /// Equilibrium of `bearing`, whose `outer_pose` is what is looked for, in the bore; `weight` is
    /// a further force on the outer race, N in the world.
    ///
    /// # Errors
    /// No equilibrium of both together, a load along the axis that nothing takes.
    pub fn solve(
        &mut self,
        bearing: &StaticProblem,
        fit: &Fit,
        weight: Vec3,
    ) -> Result<HousedState, StaticsError> {
        check_finite(bearing)?;
        let bore = self.bore();
        let assembly = lists(bearing, bore.bore(), bore.penalty(), fit, weight);
        let before = self.search.contact_changes();
        let solution = self.search.solve(&assembly)?;
        let state = self.state(bearing, solution, weight);
        let left = unbalanced(fit, &state.on_outer, &state.bore, &state.bearing.balls);
        Ok(HousedState {
            residual: left.map_err(in_bore)?,
            contact_changes: self.search.contact_changes() - before,
            ..state
        })
    }

    fn state(
        &self,
        bearing: &StaticProblem,
        mut solution: AssemblySolution,
        weight: Vec3,
    ) -> HousedState {
        let bore = solution.seats.remove(0);
        let of = self.bore().bore();
        let pose = placed(&of.reach.nominal, &bore.pose).relative_to(&bearing.frame);
        let stiffness = solution.stiffness.clone();
        let found = StaticSolution::from(solution);
        let of_balls = [found.force_on_outer, found.moment_on_outer];
        let [force, moment] = load_of_balls(of_balls, &found.balls, &pose);
        let turned = |vector: Vector3<f64>| Vec3::from(bearing.frame.orientation * vector);
        HousedState {
            on_outer: RaceLoad {
                force: of.to_nominal(add(turned(force), weight)),
                moment: of.to_nominal(turned(moment)),
            },
            residual: 0.0,
            iterations: found.iterations,
            contact_changes: 0,
            contact_evaluations: found.contact_evaluations,
            ran: found.ran.clone(),
            bearing: found,
            bore,
            stiffness,
        }
    }
}

pub(super) fn in_bore(source: BoreError) -> StaticsError {
    StaticsError::Seat { of: String::new(), source }
}

/// Inner race, outer race and bore, in the bearing's frame. The outer race's coordinates count from its nominal pose; it
/// is held along its axis.
pub fn lists<'b>(
    bearing: &StaticProblem,
    bore: &'b CondensedBore,
    penalty: Penalty,
    fit: &Fit,
    weight: Vec3,
) -> StaticAssembly<'b> {
    let mut assembly = bearing.assembly();
    let nominal = bore.reach.nominal.relative_to(&bearing.frame);
    let weight = RaceLoad { force: bore.to_nominal(weight), moment: [0.0; 3] };
    let race = race(Some(Box::new(nominal)), fit, &weight);
    assembly.bodies[OUTER].place = Place::Loaded(race);
    let mount = Mount::at_centre(OUTER);
    assembly.seats.push(StaticSeat { name: None, mount, nominal, bore, penalty, fit: *fit });
    assembly
}

/// A race in a bore under a load besides what else the lists put on it.
fn race(axes: Option<Box<Pose>>, fit: &Fit, load: &RaceLoad) -> Loaded {
    let [_, y, z] = load.force;
    let [_, about_y, about_z] = load.moment;
    let loads = [y, z, about_y, about_z].map(Condition::Load);
    Loaded {
        axes,
        conditions: [Condition::Displacement(0.0), loads[0], loads[1], loads[2], loads[3]],
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: fit.radius,
    }
}

/// A race alone in its bore under `load`, looked for from where it was last.
///
/// A loose race without load stays where it is. Loads that leave it several places get one near the last.
///
/// # Errors
/// A load that the bore cannot hold.
pub fn race_under_load(
    search: &mut BoreSearch,
    fit: &Fit,
    load: &RaceLoad,
) -> Result<BoreState, StaticsError> {
    check_load(fit, load).map_err(in_bore)?;
    let place = Place::Loaded(race(None, fit, load));
    let seat = StaticSeat {
        name: None,
        mount: Mount::at_centre(0),
        nominal: Pose::identity(),
        bore: search.bore(),
        penalty: search.penalty(),
        fit: *fit,
    };
    let assembly = StaticAssembly {
        bodies: vec![StaticBody { name: "the outer race".into(), place }],
        seats: vec![seat],
        ..StaticAssembly::default()
    };
    let [y, z, tilt_y, tilt_z] = search.pose();
    let near = [SVector::from([0.0, y, z, tilt_y, tilt_z])];
    let bores = std::slice::from_mut(search);
    let mut solution = solve_assembly_in(&assembly, bores, Some(&near), &StaticOptions::default())?;
    Ok(solution.seats.remove(0))
}

/// Both races as what takes part in natural motions; the inner one moves along these of its coordinates, the outer one is
/// held along its axis.
pub fn moving([inner, outer]: [Inertia; 2], free: [bool; 5]) -> Vec<MovingBody> {
    let held = [false, true, true, true, true];
    vec![
        MovingBody { body: INNER, inertia: inner, free },
        MovingBody { body: OUTER, inertia: outer, free: held },
    ]
}
