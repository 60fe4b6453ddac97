//! Static equilibrium of a bearing whose outer race sits in a condensed bore.
//!
//! For a trial pose of the outer race statics finds the inner race and the balls; what the balls put
//! on the outer race has to equal what the bore takes. The bore answers exactly for every load, so
//! the race is moved to where the bore balances the load of the last pose, corrected by how the
//! bearing's load changes with the pose. Where loads drive the inner race it follows the outer one,
//! that change is next to nothing, and two or three rounds do.
//!
//! Statics holds each ball at its azimuth by a cage that takes some 1e-5 of the load, since the inner
//! race's normals lean a little out of the outer race's meridian planes. Here the cage rides on the
//! outer race, so that what is put on the inner race arrives at the bore, whole.

use super::bore_equilibrium::{
    BoreError, BoreMemory, BoreSearch, BoreState, Fit, RaceLoad, Tether, check_load,
};
use super::condensed::placed;
use crate::kinematics::vec3::{Vec3, add};
use crate::solver::statics::{
    Condition, StaticOptions, StaticProblem, StaticSolution, StaticsError, solve_from,
};
use nalgebra::{Matrix4, SMatrix, SVector, Vector3, Vector4};
use thiserror::Error;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssemblyOptions {
    /// Unbalanced load of the outer race as a part of the load on it, moments over its radius.
    pub tolerance: f64,
    pub most_rounds: usize,
    pub statics: StaticOptions,
}

impl Default for AssemblyOptions {
    fn default() -> Self {
        // Statics leaves 1e-11 of its loads.
        let statics = StaticOptions::default();
        AssemblyOptions { tolerance: 1e-10, most_rounds: 60, statics }
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum AssemblyError {
    #[error("the bearing: {0}")]
    Bearing(#[from] StaticsError),
    #[error("the outer race in its bore: {0}")]
    Bore(#[from] BoreError),
    #[error(
        "bearing and housing found no common equilibrium in {rounds} rounds: {residual:.3e} N of \
         {load:.3e} N on the outer race are unbalanced"
    )]
    NotBalanced { rounds: usize, residual: f64, load: f64 },
}

/// Bearing and housing in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyState {
    /// The bearing with its outer race where the bore holds it.
    pub bearing: StaticSolution,
    pub bore: BoreState,
    /// What acts on the outer race besides the bore, in its nominal axes, about its own centre.
    pub on_outer: RaceLoad,
    /// Unbalanced load of the outer race over the load on it.
    pub residual: f64,
    /// Solutions of the bearing, and changes of the bore's contact in all of them.
    pub rounds: usize,
    pub contact_changes: usize,
    pub contact_evaluations: usize,
}

/// What a search goes on from with the same bits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchMemory {
    /// Coordinates of the inner race, once it has been found (m, rad).
    pub inner: Option<[f64; 5]>,
    /// Of the outer race: y, z (m), tilts about Y and Z (rad).
    pub outer: [f64; 4],
    pub bore: BoreMemory,
}

/// A search that starts from what it found last.
pub struct AssemblySearch<'a> {
    bore: BoreSearch<'a>,
    options: AssemblyOptions,
    inner: Option<SVector<f64, 5>>,
    outer: [f64; 4],
}

impl<'a> AssemblySearch<'a> {
    pub fn new(bore: BoreSearch<'a>, options: AssemblyOptions) -> AssemblySearch<'a> {
        AssemblySearch { bore, options, inner: None, outer: [0.0; 4] }
    }

    pub fn bore(&self) -> &BoreSearch<'a> {
        &self.bore
    }

    pub fn memory(&self) -> SearchMemory {
        let inner = self.inner.map(Into::into);
        SearchMemory { inner, outer: self.outer, bore: self.bore.memory() }
    }

    /// Goes on from what a search in the same bore remembered.
    ///
    /// # Errors
    /// As [`BoreSearch::recall`].
    pub fn recall(&mut self, memory: &SearchMemory) -> Result<(), BoreError> {
        (self.inner, self.outer) = (memory.inner.map(SVector::from), memory.outer);
        self.bore.recall(&memory.bore)
    }

    /// Equilibrium of `bearing`, whose `outer_pose` is what is looked for, in the bore; `weight` is
    /// a further force on the outer race, N in the world.
    ///
    /// # Errors
    /// No equilibrium of either, or none of both together.
    pub fn solve(
        &mut self,
        bearing: &StaticProblem,
        fit: &Fit,
        weight: Vec3,
    ) -> Result<AssemblyState, AssemblyError> {
        let mut problem = bearing.clone();
        let nominal = self.bore.bore().reach.nominal;
        let mut held: Option<BoreState> = None;
        let (mut rounds, mut changes, mut evaluations) = (0, 0, 0);
        let (mut last, mut shift) = (f64::INFINITY, 0.0f64);
        loop {
            rounds += 1;
            problem.outer_pose = placed(&nominal, &self.outer);
            let solution = match solve_from(&problem, self.inner.as_ref(), &self.options.statics) {
                Err(_) if self.inner.is_some() => {
                    solve_from(&problem, None, &self.options.statics)?
                }
                result => result?,
            };
            self.inner = Some(solution.coordinates);
            evaluations += solution.contact_evaluations;
            let on_outer = self.load_on_outer(&problem, &solution, weight);
            let size = Vector4::new(1.0, 1.0, fit.radius, fit.radius);
            let mut pull = check_load(fit, &on_outer)?;
            let load = pull.component_div(&size).amax().max(ball_load(&solution));
            for i in 0..4 {
                // Below what statics leaves there is no load: it would drive a loose race about.
                if pull[i].abs() <= 10.0 * self.options.statics.tolerance * load * size[i] {
                    pull[i] = 0.0;
                }
            }
            let mut resisted = Matrix4::zeros();
            if let Some(bore) = held.take() {
                let left = (pull - Vector4::from(bore.load)).component_div(&size).amax();
                let residual = if load > 0.0 { left / load } else { left };
                let settled = residual <= self.options.tolerance;
                // Beyond that only rounding of positions is left: some ulps of the bearing.
                if settled || (residual <= 1e2 * self.options.tolerance && residual > 0.5 * last) {
                    return Ok(AssemblyState {
                        bearing: solution,
                        bore,
                        on_outer,
                        residual,
                        rounds,
                        contact_changes: changes,
                        contact_evaluations: evaluations,
                    });
                }
                if rounds > self.options.most_rounds || !residual.is_finite() {
                    return Err(AssemblyError::NotBalanced { rounds, residual: left, load });
                }
                // Overshot: hold the race back by as much as the bore resists.
                shift = if residual > 0.7 * last { (4.0 * shift).max(1.0) } else { 0.25 * shift };
                if shift < 1e-3 {
                    shift = 0.0;
                }
                last = residual;
                resisted = bore.stiffness * shift;
            }
            let stiffness = against_outer(&problem, &solution.stiffness) + resisted;
            let tether = Tether { stiffness, place: Vector4::from(self.outer) };
            let bore = self.bore.under_load_and_tether(fit, &pull, &tether)?;
            changes += bore.iterations;
            self.outer = bore.pose;
            held = Some(bore);
        }
    }

    /// Contacts with the balls, weight, and what the cage takes to keep balls at their azimuths.
    fn load_on_outer(
        &self,
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
        let bore = self.bore.bore();
        let turned = |vector: Vector3<f64>| Vec3::from(problem.frame.orientation * vector);
        RaceLoad {
            force: bore.to_nominal(add(turned(force), weight)),
            moment: bore.to_nominal(turned(moment)),
        }
    }
}

fn ball_load(solution: &StaticSolution) -> f64 {
    solution.balls.iter().fold(0.0, |most: f64, ball| most.max(ball.outer.normal_load))
}

/// How the bearing resists motion of its outer race along y, z and the two tilts, coordinates of the
/// inner race that loads drive following. Moving the outer race one way is moving the inner one the
/// other way; frames that are turned against each other are left out, which only slows the rounds.
fn against_outer(problem: &StaticProblem, inner: &SMatrix<f64, 5, 5>) -> Matrix4<f64> {
    let free: Vec<usize> =
        (0..5).filter(|&i| matches!(problem.conditions[i], Condition::Load(_))).collect();
    let mut stiffness = *inner;
    // Eliminate one coordinate after the other.
    for &i in &free {
        let pivot = stiffness[(i, i)];
        // A coordinate that nothing resists, or what rounding leaves of one.
        if pivot <= 1e-9 * inner[(i, i)].abs() {
            stiffness.fill_row(i, 0.0);
            stiffness.fill_column(i, 0.0);
            continue;
        }
        let column = stiffness.column(i).into_owned();
        stiffness -= column * column.transpose() / pivot;
        stiffness.fill_row(i, 0.0);
        stiffness.fill_column(i, 0.0);
    }
    stiffness.fixed_view::<4, 4>(1, 1).into_owned()
}
