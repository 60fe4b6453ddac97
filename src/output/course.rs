//! A bearing in a condensed housing, one equilibrium a row.

use crate::kinematics::vec3::Vec3;
use crate::scene::housing::HousedScene;
use crate::scene::housing_problem::HousingSetup;
use crate::solver::dynamics::model::{Drive, Rotation};
use crate::solver::housing::bore_equilibrium::{BoreError, BoreSearch, Fit};
use crate::solver::housing::condensed::CondensedBore;
use crate::solver::housing::housed::{HousedMemory, HousedSearch, HousedState};
use crate::solver::housing::inertia::Masses;
use crate::solver::housing::quasi_static::{Course as CourseLoads, CourseError, Moment, history};
use crate::solver::plan::{Stage, tally::Ran};
use crate::solver::profile::Profile;
use crate::solver::statics::{Condition, StaticProblem};

/// What a course is made of.
#[derive(Clone)]
pub struct CourseParts<'p> {
    pub scene: &'p HousedScene,
    pub setup: &'p HousingSetup,
    pub bore: &'p CondensedBore,
    pub problem: StaticProblem,
}

/// A condensed housing over time.
pub struct Course<'p> {
    parts: CourseParts<'p>,
    search: HousedSearch<'p>,
    /// Between rows, s.
    interval: f64,
    /// Equilibria so far; the first is at the start.
    pub found: u64,
    /// The latest one.
    pub latest: Option<Moment>,
    pub effort: Effort,
    /// How often each stage ran.
    pub ran: Ran,
}

/// What equilibria took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Largest share of the load on the outer race that was left unbalanced.
    pub largest_residual: f64,
    /// Newton iterations, changes of the nodes that touch.
    pub iterations: usize,
    pub contact_changes: usize,
}

/// What a course goes on from with the same bits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CourseCheckpoint {
    /// s.
    pub time: f64,
    pub found: u64,
    pub effort: Effort,
    pub memory: HousedMemory,
    /// Nodes of the bore.
    pub nodes: usize,
}

impl<'p> Course<'p> {
    /// Before the first equilibrium; rows are `interval` (s) apart.
    pub fn new(parts: CourseParts<'p>, interval: f64) -> Course<'p> {
        let bore = BoreSearch::new(parts.bore, parts.scene.housing.penalty);
        let search = HousedSearch::new(bore);
        let effort = Effort::default();
        Course { parts, search, interval, found: 0, latest: None, effort, ran: Ran::default() }
    }

    pub fn bore(&self) -> &'p CondensedBore {
        self.parts.bore
    }

    /// Of the latest equilibrium, s.
    pub fn time(&self) -> f64 {
        self.found.saturating_sub(1) as f64 * self.interval
    }

    /// The bearing as the latest equilibrium has it.
    pub fn problem(&self) -> StaticProblem {
        let mut problem = self.parts.problem.clone();
        if let Some(moment) = &self.latest {
            problem.conditions = on_inner(self.parts.scene, moment.time);
            problem.ball_phase = moment.ball_phase;
        }
        problem
    }

    /// Solves for the next row.
    ///
    /// # Errors
    /// No equilibrium at its time.
    pub fn find_next(&mut self) -> Result<(), CourseError> {
        let time = self.found as f64 * self.interval;
        let CourseParts { scene, setup, problem, .. } = &self.parts;
        for moment in moments(scene, setup, problem, &mut self.search, time)? {
            let (state, effort) = (&moment.state, &mut self.effort);
            effort.largest_residual = effort.largest_residual.max(state.residual);
            effort.iterations += state.iterations;
            effort.contact_changes += state.contact_changes;
            self.ran.absorb(&state.ran);
            self.ran.whole.add(Stage::Equilibria, 1);
            self.latest = Some(moment);
        }
        self.found += 1;
        Ok(())
    }

    pub fn checkpoint(&self) -> CourseCheckpoint {
        CourseCheckpoint {
            time: self.time(),
            found: self.found,
            effort: self.effort,
            memory: self.search.memory(),
            nodes: self.bore().nodes.len(),
        }
    }

    /// Goes on where a checkpoint of the same course was taken.
    ///
    /// # Errors
    /// As [`BoreSearch::recall`].
    pub fn restore(&mut self, kept: &CourseCheckpoint) -> Result<(), BoreError> {
        (self.found, self.effort) = (kept.found, kept.effort);
        self.search.recall(&kept.memory)
    }

    /// Displacements of the housing in the latest equilibrium, m; of none without one.
    pub fn displacement(&self) -> Vec<Vec3> {
        let of = |moment: &Moment| self.bore().displacement(&moment.state.bore.loads);
        self.latest.as_ref().map_or_else(Vec::new, of)
    }
}

/// Weight of the outer race and constant loads on it, N in the world.
pub fn on_outer(scene: &HousedScene, t: f64) -> [f64; 3] {
    let gravity = scene.bearing.gravity;
    let Some(outer) = &scene.bearing.dynamics.outer else { return [0.0; 3] };
    [0, 1, 2].map(|i: usize| {
        let load = match &outer.drives[i] {
            Drive::Load(load) => load.value(t),
            Drive::Motion(_) => 0.0,
        };
        outer.inertia.mass * gravity[i] + load
    })
}

/// Conditions on the inner race at time `t`, a load that turns and its own weight included.
pub fn on_inner(scene: &HousedScene, t: f64) -> [Condition; 5] {
    let dynamics = &scene.bearing.dynamics;
    let turning = dynamics.rotating_load.as_ref().map_or([0.0; 3], |load| load.force(t));
    let mut conditions = scene.bearing.conditions;
    for (i, (condition, drive)) in conditions.iter_mut().zip(&dynamics.inner.drives).enumerate() {
        *condition = match drive {
            Drive::Load(load) if i < 3 => {
                let weight = dynamics.inner.inertia.mass * scene.bearing.gravity[i];
                Condition::Load(load.value(t) + turning[i] + weight)
            }
            Drive::Load(load) => Condition::Load(load.value(t)),
            Drive::Motion(motion) => Condition::Displacement(motion.value(t)),
        };
    }
    conditions
}

pub fn masses(scene: &HousedScene) -> Option<Masses> {
    let dynamics = &scene.bearing.dynamics;
    let outer = dynamics.outer.as_ref()?.inertia;
    Some(Masses { inner: dynamics.inner.inertia, outer })
}

/// The one equilibrium of `problem` at a time of the scene.
///
/// # Errors
/// No equilibrium then.
pub fn moments(
    scene: &HousedScene,
    setup: &HousingSetup,
    problem: &StaticProblem,
    search: &mut HousedSearch,
    time: f64,
) -> Result<Vec<Moment>, CourseError> {
    let radius = setup.radius(scene);
    let conditions = on_inner(scene, time);
    let constant = |condition: &Condition| match condition {
        Condition::Load(value) | Condition::Displacement(value) => Profile::Constant(*value),
    };
    let speed = match &scene.bearing.dynamics.inner.rotation {
        Rotation::Speed(speed) => speed.clone(),
        Rotation::Torque(_) => Profile::ZERO,
    };
    let course = CourseLoads {
        times: vec![time],
        conditions: conditions.each_ref().map(constant),
        rotating_load: None,
        shaft_speed: speed,
        interference: Profile::ZERO,
        weight: on_outer(scene, time),
        // As in a run: balls that go round have mass.
        centrifugal: true,
    };
    let problem = StaticProblem { conditions, ..problem.clone() };
    let fit = Fit { radius: radius.value(time), ..setup.fit(scene) };
    history(search, &problem, &fit, &course)
}

/// Position (m) and tilts (rad) of the outer race in the world.
pub fn outer_place(bore: &CondensedBore, state: &HousedState) -> [f64; 5] {
    let pose = crate::solver::housing::condensed::placed(&bore.reach.nominal, &state.bore.pose);
    let (_, tilt_y, tilt_z) = crate::kinematics::euler::angles(&pose.orientation);
    [pose.position.x, pose.position.y, pose.position.z, tilt_y, tilt_z]
}
