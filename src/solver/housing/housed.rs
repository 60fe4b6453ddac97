//! A bearing whose outer race sits in a condensed bore, as lists for the one search for an equilibrium.
//!
//! Statics holds each ball at its azimuth by a cage that takes some 1e-5 of the load, since the inner
//! race's normals lean a little out of the outer race's meridian planes. The cage rides on the
//! outer race, so that what is put on the inner race arrives at the bore, whole.

use super::bore_equilibrium::{BoreError, BoreSearch, BoreState, Fit, RaceLoad, check_load};
use super::condensed::{CondensedBore, placed};
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, add};
use crate::solver::mount::Mount;
use crate::solver::plan::tally::Ran;
use crate::solver::static_assembly::{Loaded, Place, StaticAssembly, StaticBody, StaticSeat};
use crate::solver::statics::{
    AssemblySolution, Condition, StaticOptions, StaticProblem, StaticSolution, StaticsError,
    check_finite, solve_assembly_in,
};
use nalgebra::{SVector, Vector3, Vector4};

/// Bearing and housing in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct HousedState {
    /// The bearing with its outer race where the bore holds it.
    pub bearing: StaticSolution,
    pub bore: BoreState,
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

/// What a search goes on from with the same bits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HousedMemory {
    /// Coordinates of the inner race, once it has been found (m, rad).
    pub inner: Option<[f64; 5]>,
    /// Of the outer race: y, z (m), tilts about Y and Z (rad).
    pub outer: [f64; 4],
    /// Nodes of the bore that touched, ascending.
    pub touching: Vec<usize>,
}

/// A search that starts from what it found last.
pub struct HousedSearch<'b> {
    bore: BoreSearch<'b>,
    options: StaticOptions,
    inner: Option<[f64; 5]>,
    outer: [f64; 4],
}

/// Bodies of the lists.
const INNER: usize = 0;
const OUTER: usize = 1;

impl<'b> HousedSearch<'b> {
    pub fn new(bore: BoreSearch<'b>) -> HousedSearch<'b> {
        HousedSearch { bore, options: StaticOptions::default(), inner: None, outer: [0.0; 4] }
    }

    pub fn bore(&self) -> &BoreSearch<'b> {
        &self.bore
    }

    pub fn memory(&self) -> HousedMemory {
        let touching = self.bore.touching().to_vec();
        HousedMemory { inner: self.inner, outer: self.outer, touching }
    }

    /// Goes on from what a search in the same bore remembered.
    ///
    /// # Errors
    /// As [`BoreSearch::recall`].
    pub fn recall(&mut self, memory: &HousedMemory) -> Result<(), BoreError> {
        (self.inner, self.outer) = (memory.inner, memory.outer);
        self.bore.recall(&memory.touching)
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
        let assembly = lists(bearing, self.bore.bore(), &self.bore, fit, weight);
        let before = self.bore.changes;
        let [y, z, tilt_y, tilt_z] = self.outer;
        let near = self
            .inner
            .map(|inner| [SVector::from(inner), SVector::from([0.0, y, z, tilt_y, tilt_z])]);
        let bores = std::slice::from_mut(&mut self.bore);
        let solution = match &near {
            Some(near) => match solve_assembly_in(&assembly, bores, Some(near), &self.options) {
                Err(_) => solve_assembly_in(&assembly, bores, None, &self.options)?,
                result => result?,
            },
            None => solve_assembly_in(&assembly, bores, None, &self.options)?,
        };
        self.inner = Some(solution.coordinates[INNER].into());
        let (state, on_outer) = self.state(bearing, solution, weight);
        self.outer = state.bore.pose;
        let size = Vector4::new(1.0, 1.0, fit.radius, fit.radius);
        let pull = check_load(fit, &on_outer).map_err(in_bore)?;
        let load = pull.component_div(&size).amax().max(ball_load(&state.bearing));
        let left = (pull - Vector4::from(state.bore.load)).component_div(&size).amax();
        Ok(HousedState {
            residual: if load > 0.0 { left / load } else { left },
            contact_changes: self.bore.changes - before,
            ..state
        })
    }

    fn state(
        &self,
        bearing: &StaticProblem,
        mut solution: AssemblySolution,
        weight: Vec3,
    ) -> (HousedState, RaceLoad) {
        let bore = solution.seats.remove(0);
        let outer_pose = placed(&self.bore.bore().reach.nominal, &bore.pose);
        let problem = StaticProblem { outer_pose, ..bearing.clone() };
        let bearing = StaticSolution::from(solution);
        let on_outer = load_on_outer(self.bore.bore(), &problem, &bearing, weight);
        let state = HousedState {
            on_outer,
            residual: 0.0,
            iterations: bearing.iterations,
            contact_changes: 0,
            contact_evaluations: bearing.contact_evaluations,
            ran: bearing.ran.clone(),
            bearing,
            bore,
        };
        (state, on_outer)
    }
}

fn in_bore(source: BoreError) -> StaticsError {
    StaticsError::Seat { of: String::new(), source }
}

/// Both races of a bearing in a bore, without the bore: what a plan is made from.
pub fn without_bore(bearing: &StaticProblem, fit: &Fit) -> StaticAssembly<'static> {
    let mut assembly = bearing.assembly();
    assembly.bodies[OUTER].place = Place::Loaded(race(None, fit, &RaceLoad::default()));
    assembly
}

/// Inner race, outer race and bore, in the bearing's frame. The outer race's coordinates count from its nominal pose; it
/// is held along its axis.
fn lists<'b>(
    bearing: &StaticProblem,
    bore: &'b CondensedBore,
    search: &BoreSearch,
    fit: &Fit,
    weight: Vec3,
) -> StaticAssembly<'b> {
    let mut assembly = bearing.assembly();
    let nominal = bore.reach.nominal.relative_to(&bearing.frame);
    let weight = RaceLoad { force: bore.to_nominal(weight), moment: [0.0; 3] };
    let race = race(Some(Box::new(nominal)), fit, &weight);
    assembly.bodies[OUTER].place = Place::Loaded(race);
    let (mount, penalty) = (Mount::at_centre(OUTER), search.penalty());
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

/// Contacts with the balls, weight, and what the cage takes to keep balls at their azimuths.
fn load_on_outer(
    bore: &CondensedBore,
    problem: &StaticProblem,
    solution: &StaticSolution,
    weight: Vec3,
) -> RaceLoad {
    let race = problem.outer_pose.relative_to(&problem.frame);
    let (mut force, mut moment) = (solution.force_on_outer, solution.moment_on_outer);
    for ball in &solution.balls {
        let (sin, cos) = libm::sincos(ball.azimuth);
        let around = race.orientation * Vector3::new(0.0, -sin, cos);
        let by_cage = -around * ball.cage_force;
        force += by_cage;
        moment += (ball.position - race.position).cross(&by_cage);
    }
    let turned = |vector: Vector3<f64>| Vec3::from(problem.frame.orientation * vector);
    RaceLoad {
        force: bore.to_nominal(add(turned(force), weight)),
        moment: bore.to_nominal(turned(moment)),
    }
}

fn ball_load(solution: &StaticSolution) -> f64 {
    solution.balls.iter().fold(0.0, |most: f64, ball| most.max(ball.outer.normal_load))
}
