//! Explicit steps of a solid (2.7): central differences, or Runge–Kutta as in the source; for rubber, whose stresses
//! depend on history ([`crate::solids::rubber::explicit`]), central differences.

use crate::kinematics::vec3::Vec3;
use crate::numeric::clock::whole_steps;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::energy::{SolidEnergy, SolidLedger, strain_energy};
use crate::solids::error::SolidError;
use crate::solids::model::{Prescribed, SolidModel};
use crate::solids::plan::SolidSteps;
use crate::solids::rigid_motion::rigid_motion;
use crate::solids::rubber::tet_forces::{History, RubberForces};
use crate::solids::runge_kutta::Stages;
use crate::solids::step_limit::{SolidStepLimit, step_limit};
use crate::solids::tet4_blocks::Node;
use crate::solids::threads::Partition;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExplicitMethod {
    /// Order 2, one force evaluation a step; stable to ωh = 2.
    #[default]
    CentralDifferences,
    /// Classical fourth order, four evaluations; stable to ωh = 2.83.
    RungeKutta,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidStepping {
    /// s; refused beyond the limit.
    Fixed(f64),
    /// This fraction of the stability limit at the start.
    FractionOfLimit(f64),
}

impl SolidStepping {
    /// The step (s) of a run with rows `interval` (s) apart, and the number of steps in a row. One that follows from
    /// the stability `limit` (s) is shortened so that a whole number makes an interval; with a prescribed step the
    /// interval is rounded to whole steps.
    pub fn divide(self, interval: f64, limit: f64) -> (f64, u64) {
        match self {
            SolidStepping::FractionOfLimit(fraction) => {
                let steps = whole_steps(interval, fraction * limit);
                (interval / steps as f64, steps)
            }
            SolidStepping::Fixed(step) => (step, (interval / step).round().max(1.0) as u64),
        }
    }
}

/// Work counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolidWork {
    pub evaluations: u64,
    pub elements: u64,
}

/// A solid in motion.
pub struct ExplicitSolid {
    pub model: SolidModel,
    pub method: ExplicitMethod,
    pub time: f64,
    pub step_size: f64,
    pub steps: u64,
    pub limit: SolidStepLimit,
    pub displacement: Vec<Node>,
    /// At `time` for Runge–Kutta; half a step before it for central differences.
    pub(crate) rate: Vec<Node>,
    pub(crate) force: Vec<Node>,
    /// Work of loads and drives, and of damping (≤ 0), on each node since the start, J: by node, so that no sum depends
    /// on the number of threads.
    pub(crate) external_work: Vec<f64>,
    pub(crate) damping_work: Vec<f64>,
    pub work: SolidWork,
    /// Number of runs of each stage.
    pub ran: Counts,
    /// Planned loads and damping.
    pub(crate) acting: SolidSteps,
    pub(crate) stages: Option<Box<Stages>>,
    /// `None` for one thread.
    pub(crate) team: Option<Partition>,
    /// Forces of rubber; the material of the model is then that of its first instant at rest.
    pub(crate) rubber: Option<Box<RubberForces>>,
}

/// Vectors padded for the force loop.
pub fn padded(list: Vec<Vec3>) -> Vec<Node> {
    list.into_iter().map(|v| [v[0], v[1], v[2], 0.0]).collect()
}

impl ExplicitSolid {
    /// A solid at t = 0 with given displacements and velocities (m, m/s), one for each node.
    ///
    /// # Errors
    ///
    /// A step beyond the stability limit.
    pub fn new(
        model: SolidModel,
        method: ExplicitMethod,
        stepping: SolidStepping,
        displacement: Vec<Vec3>,
        velocity: Vec<Vec3>,
    ) -> Result<ExplicitSolid, SolidError> {
        let displacement = padded(displacement);
        let limit = step_limit(&model, &displacement, method);
        ExplicitSolid::with_limit(model, method, stepping, limit, displacement, padded(velocity))
    }

    /// As [`ExplicitSolid::new`] with a known step limit.
    ///
    /// # Errors
    ///
    /// A step beyond the stability limit.
    pub fn with_limit(
        model: SolidModel,
        method: ExplicitMethod,
        stepping: SolidStepping,
        limit: SolidStepLimit,
        displacement: Vec<Node>,
        velocity: Vec<Node>,
    ) -> Result<ExplicitSolid, SolidError> {
        let step_size = match stepping {
            SolidStepping::FractionOfLimit(fraction) => fraction * limit.step,
            SolidStepping::Fixed(step) => step,
        };
        if !(step_size > 0.0 && step_size <= limit.step) {
            return Err(SolidError::Step {
                step: step_size,
                limit: limit.step,
                element: model.labels.element(limit.element),
                at: limit.at,
            });
        }
        let mut solid = ExplicitSolid::at_rest(model, method, step_size, limit);
        solid.start(displacement, velocity);
        Ok(solid)
    }

    /// Sets displacements and velocities at t = 0.
    pub(crate) fn start(&mut self, displacement: Vec<Node>, velocity: Vec<Node>) {
        self.displacement = displacement;
        self.rate = velocity;
        self.impose();
        if let Some(rubber) = &mut self.rubber {
            rubber.relax(&self.displacement);
        }
        if self.method == ExplicitMethod::CentralDifferences {
            // Back by half a step, so that the first full kick ends half a step ahead.
            self.evaluate(History::Trial);
            let acceleration = self.acceleration();
            for (rate, acceleration) in self.rate.iter_mut().zip(acceleration) {
                for i in 0..3 {
                    rate[i] -= 0.5 * self.step_size * acceleration[i];
                }
            }
        }
    }

    /// An undeformed solid at rest at t = 0, with an unchecked step.
    pub fn at_rest(
        model: SolidModel,
        method: ExplicitMethod,
        step_size: f64,
        limit: SolidStepLimit,
    ) -> ExplicitSolid {
        let count = model.mass.len();
        let stages = (method == ExplicitMethod::RungeKutta).then(|| Box::new(Stages::new(count)));
        ExplicitSolid {
            method,
            time: 0.0,
            step_size,
            steps: 0,
            limit,
            displacement: vec![[0.0; 4]; count],
            rate: vec![[0.0; 4]; count],
            force: vec![[0.0; 4]; count],
            external_work: vec![0.0; count],
            damping_work: vec![0.0; count],
            work: SolidWork::default(),
            ran: Counts::default(),
            acting: model.acting(),
            stages,
            team: None,
            rubber: None,
            model,
        }
    }

    /// Work of loads and drives since the start, J.
    pub fn external_work(&self) -> f64 {
        self.external_work.iter().sum()
    }

    /// Work of damping since the start, J; ≤ 0 unless damping moves the body.
    pub fn damping_work(&self) -> f64 {
        self.damping_work.iter().sum()
    }

    /// Writes prescribed displacements and their rates into the state.
    pub(crate) fn impose(&mut self) {
        self.ran.add(Stage::Supports, self.model.problem.prescribed.len() as u64);
        for Prescribed { node, axis, profile } in &self.model.problem.prescribed {
            self.displacement[*node as usize][*axis] = profile.value(self.time);
            self.rate[*node as usize][*axis] = profile.rate(self.time);
        }
    }

    /// Accelerations of the free components under the present forces and damping; zero elsewhere.
    fn acceleration(&self) -> Vec<Vec3> {
        let SolidModel { per_mass, problem, mass, .. } = &self.model;
        let rigid = rigid_motion(problem, mass, &self.displacement, &self.rate);
        (0..mass.len())
            .map(|n| {
                let rest = rigid.velocity(problem.nodes[n], self.displacement[n]);
                [0, 1, 2].map(|i: usize| {
                    if per_mass[n][i] == 0.0 {
                        return 0.0;
                    }
                    self.force[n][i] * per_mass[n][i]
                        - problem.damping * (self.rate[n][i] - rest[i])
                })
            })
            .collect()
    }

    /// Forces of elements and loads at the present state.
    pub(crate) fn evaluate(&mut self, history: History) {
        self.force.fill([0.0; 4]);
        match (&mut self.rubber, &mut self.team) {
            (Some(rubber), _) => {
                rubber.set_step(self.step_size);
                rubber.add_forces(&self.displacement, &mut self.force, history);
            }
            (None, Some(team)) => team.add_internal_forces(&self.displacement, &mut self.force),
            (None, None) => self.model.add_internal_forces(&self.displacement, &mut self.force),
        }
        self.model.add_external_forces(self.acting, self.time, &mut self.force, &mut self.ran);
        self.work.evaluations += 1;
        self.work.elements += self.elements_a_step() as u64;
        self.ran.add(Stage::Elements, self.elements_a_step() as u64);
    }

    /// Takes one step. `contacts` adds further forces on the nodes for a time and displacements; their work is booked
    /// by the caller.
    ///
    /// # Errors
    ///
    /// A value that is not finite.
    pub fn step(
        &mut self,
        contacts: impl FnMut(f64, &[Node], &mut [Node]),
    ) -> Result<(), SolidError> {
        match self.method {
            ExplicitMethod::CentralDifferences => self.central_step(contacts)?,
            ExplicitMethod::RungeKutta => self.runge_kutta_step(contacts),
        }
        self.steps += 1;
        self.ran.add(Stage::Explicit, 1);
        self.watch()
    }

    /// (2.7) by central differences; without damping (2.15), (3.12).
    /// v(t+h/2) = [(1 − αh/2) v(t−h/2) + h f/m] / (1 + αh/2), then u(t+h) = u(t) + h v(t+h/2).
    fn central_step(
        &mut self,
        mut contacts: impl FnMut(f64, &[Node], &mut [Node]),
    ) -> Result<(), SolidError> {
        self.evaluate(History::Commit);
        if let Some(rubber) = self.rubber.as_ref().filter(|rubber| !rubber.is_sound()) {
            return Err(rubber.failure(&self.model, &self.displacement, self.time, self.steps));
        }
        contacts(self.time, &self.displacement, &mut self.force);
        let h = self.step_size;
        self.add_load_work(0.5 * h);
        let next = self.time + h;
        self.ran.add(Stage::Supports, self.model.problem.prescribed.len() as u64);
        for Prescribed { node, axis, profile } in &self.model.problem.prescribed {
            let (n, i) = (*node as usize, *axis);
            let rate = (profile.value(next) - self.displacement[n][i]) / h;
            let before = self.rate[n][i];
            // The drive adds the force that accelerates the node's mass.
            let drive = self.model.mass[n] * (rate - before) / h - self.force[n][i];
            self.external_work[n] += 0.5 * h * drive * (rate + before);
            self.rate[n][i] = rate;
        }
        if !self.acting.damping {
            let nodes = self.rate.iter_mut().zip(&mut self.displacement);
            let pulls = self.force.iter().zip(&self.model.per_mass);
            for ((rate, displacement), (force, per_mass)) in nodes.zip(pulls) {
                for i in 0..4 {
                    rate[i] += h * force[i] * per_mass[i];
                    displacement[i] += h * rate[i];
                }
            }
        } else {
            self.damped_kick(h);
        }
        self.add_load_work(0.5 * h);
        self.time = next;
        Ok(())
    }

    /// Kick and drift with damping. Motion relative to the body's rigid motion is damped with the mean of the
    /// velocities before and after the kick; the rigid motion takes the whole kick.
    fn damped_kick(&mut self, h: f64) {
        self.ran.add(Stage::Damping, 1);
        let SolidModel { per_mass, problem, mass, .. } = &self.model;
        let half_damping = 0.5 * h * problem.damping;
        let per_sum = 1.0 / (1.0 + half_damping);
        let rigid_before = rigid_motion(problem, mass, &self.displacement, &self.rate);
        for ((rate, force), per_mass) in self.rate.iter_mut().zip(&self.force).zip(per_mass) {
            for i in 0..3 {
                rate[i] += h * force[i] * per_mass[i];
            }
        }
        let rigid = rigid_motion(problem, mass, &self.displacement, &self.rate);
        for n in 0..mass.len() {
            let (place, displacement) = (problem.nodes[n], self.displacement[n]);
            let rest_before = rigid_before.velocity(place, displacement);
            let rest = rigid.velocity(place, displacement);
            for i in 0..3 {
                // A driven component is not damped.
                if per_mass[n][i] != 0.0 {
                    let before = self.rate[n][i] - h * self.force[n][i] * per_mass[n][i];
                    let excess = self.rate[n][i] - rest[i];
                    let braked = excess - half_damping * (before - rest_before[i]);
                    self.rate[n][i] = rest[i] + braked * per_sum;
                    let mean = 0.5 * (before + self.rate[n][i]);
                    let mean_rest = 0.5 * (rest_before[i] + rest[i]);
                    self.damping_work[n] -=
                        h * problem.damping * mass[n] * mean * (mean - mean_rest);
                }
                self.displacement[n][i] += h * self.rate[n][i];
            }
        }
    }

    /// Books the work of loads and gravity, with their forces at `time`, in `seconds` at the present rates.
    pub(crate) fn add_load_work(&mut self, seconds: f64) {
        let SolidModel { problem, mass, .. } = &self.model;
        for load in &problem.loads {
            let factor = seconds * load.profile.value(self.time);
            for (node, force) in &load.forces {
                let n = *node as usize;
                let rate = &self.rate[n];
                self.external_work[n] +=
                    factor * (force[0] * rate[0] + force[1] * rate[1] + force[2] * rate[2]);
            }
        }
        let gravity = problem.gravity;
        if self.acting.gravity {
            for (n, rate) in self.rate.iter().enumerate() {
                self.external_work[n] += seconds
                    * mass[n]
                    * (gravity[0] * rate[0] + gravity[1] * rate[1] + gravity[2] * rate[2]);
            }
        }
    }

    /// A non-finite value spreads to the whole body; checking every node finds it.
    fn watch(&self) -> Result<(), SolidError> {
        // Every few steps: the check costs as much as moving the nodes.
        if !self.steps.is_multiple_of(16) {
            return Ok(());
        }
        match self.displacement.iter().position(|u| !(u[0] + u[1] + u[2]).is_finite()) {
            None => Ok(()),
            Some(node) => Err(self.model.not_finite(node, self.time, self.steps)),
        }
    }

    /// Velocities at `time`, m/s. Central differences need a force evaluation for it.
    pub fn velocity(&mut self) -> Vec<Vec3> {
        self.velocity_with(|_, _, _| {})
    }

    /// The same under the further forces of [`ExplicitSolid::step`].
    pub fn velocity_with(
        &mut self,
        mut contacts: impl FnMut(f64, &[Node], &mut [Node]),
    ) -> Vec<Vec3> {
        let ahead = match self.method {
            ExplicitMethod::CentralDifferences => 0.5 * self.step_size,
            ExplicitMethod::RungeKutta => 0.0,
        };
        self.evaluate(History::Trial);
        contacts(self.time, &self.displacement, &mut self.force);
        let acceleration = self.acceleration();
        self.rate
            .iter()
            .zip(acceleration)
            .map(|(v, a)| [0, 1, 2].map(|i: usize| v[i] + ahead * a[i]))
            .collect()
    }

    /// Energy at `time`, J. For central differences the kinetic part is ½ v(t−h/2)·m·v(t+h/2), whose sum with the
    /// strain energy the method conserves.
    pub fn energy(&mut self) -> SolidEnergy {
        self.ledger().energy
    }

    /// Stored energy at `time` and the work until then; leaves the forces of that time in [`ExplicitSolid::forces`].
    ///
    /// Central differences book the work of each step with the mean of the rates before and after it, half a step late;
    /// the missing part is added here, so that the ledger of a linear body closes to rounding.
    pub fn ledger(&mut self) -> SolidLedger {
        self.ledger_with(|_, _, _| {})
    }

    /// The same under the further forces of [`ExplicitSolid::step`]. Their work is not included: the balance of the
    /// ledger grows by it.
    pub fn ledger_with(
        &mut self,
        mut contacts: impl FnMut(f64, &[Node], &mut [Node]),
    ) -> SolidLedger {
        let strain = match &self.rubber {
            Some(rubber) => rubber.network_energy(&self.displacement),
            None => strain_energy(&self.model, &self.displacement),
        };
        self.evaluate(History::Trial);
        contacts(self.time, &self.displacement, &mut self.force);
        let ahead = match self.method {
            ExplicitMethod::CentralDifferences => self.step_size,
            ExplicitMethod::RungeKutta => 0.0,
        };
        let mut loads = vec![[0.0; 4]; self.force.len()];
        self.model.add_external_forces(self.acting, self.time, &mut loads, &mut self.ran);
        let SolidModel { mass, per_mass, .. } = &self.model;
        let (mut kinetic, mut external, mut damping) = (0.0, 0.0, 0.0);
        for (n, acceleration) in self.acceleration().into_iter().enumerate() {
            for i in 0..3 {
                let (rate, force) = (self.rate[n][i], self.force[n][i]);
                kinetic += 0.5 * mass[n] * rate * (rate + ahead * acceleration[i]);
                external += 0.5 * ahead * loads[n][i] * rate;
                if per_mass[n][i] == 0.0 {
                    external -= 0.5 * ahead * force * rate;
                } else {
                    damping += 0.5 * ahead * (mass[n] * acceleration[i] - force) * rate;
                }
            }
        }
        SolidLedger {
            energy: SolidEnergy { strain, kinetic },
            external_work: self.external_work() + external,
            damping_work: self.damping_work() + damping,
        }
    }

    /// Velocities, m/s; for central differences half a step before `time`.
    pub fn rates(&self) -> &[Node] {
        &self.rate
    }

    /// Forces of elements and loads on the nodes as last evaluated, N.
    pub fn forces(&self) -> &[Node] {
        &self.force
    }
}
