//! Classical fourth-order Runge–Kutta steps of a solid, as in the source.

use crate::plan::Stage;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::model::{Prescribed, SolidModel};
use crate::solids::rigid_motion::{RigidMotion, rigid_motion};
use crate::solids::rubber::tet_forces::History;
use crate::solids::tet4_blocks::Node;

/// Working memory of the stages.
pub(crate) struct Stages {
    displacement: Vec<Node>,
    rate: Vec<Node>,
    displacement_sum: Vec<Node>,
    rate_sum: Vec<Node>,
}

impl Stages {
    pub(crate) fn new(nodes: usize) -> Stages {
        let zeros = || vec![[0.0; 4]; nodes];
        Stages {
            displacement: zeros(),
            rate: zeros(),
            displacement_sum: zeros(),
            rate_sum: zeros(),
        }
    }
}

impl ExplicitSolid {
    /// Classical fourth-order Runge–Kutta for displacements and rates (2.7).
    pub(crate) fn runge_kutta_step(&mut self, mut contacts: impl FnMut(f64, &[Node], &mut [Node])) {
        let mut stages = self.stages.take().expect("made for this method");
        let (h, start) = (self.step_size, self.time);
        stages.displacement.copy_from_slice(&self.displacement);
        stages.rate.copy_from_slice(&self.rate);
        stages.displacement_sum.copy_from_slice(&self.displacement);
        stages.rate_sum.copy_from_slice(&self.rate);
        for (weight, ahead) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            self.evaluate(History::Trial);
            contacts(self.time, &self.displacement, &mut self.force);
            let share = h * weight / 6.0;
            self.add_load_work(share);
            let SolidModel { per_mass, problem, mass, .. } = &self.model;
            let mut rigid = RigidMotion::default();
            if self.acting.damping {
                rigid = rigid_motion(problem, mass, &self.displacement, &self.rate);
                self.ran.add(Stage::Damping, 1);
            }
            for n in 0..mass.len() {
                let rest = rigid.velocity(problem.nodes[n], self.displacement[n]);
                for i in 0..3 {
                    let rate = self.rate[n][i];
                    // A driven component is not damped.
                    let mut acceleration = 0.0;
                    if per_mass[n][i] != 0.0 {
                        let brake = problem.damping * (rate - rest[i]);
                        self.damping_work[n] -= share * mass[n] * brake * rate;
                        acceleration = self.force[n][i] * per_mass[n][i] - brake;
                    }
                    stages.displacement_sum[n][i] += share * rate;
                    stages.rate_sum[n][i] += share * acceleration;
                    self.displacement[n][i] = stages.displacement[n][i] + ahead * h * rate;
                    self.rate[n][i] = stages.rate[n][i] + ahead * h * acceleration;
                }
            }
            // Forces that drives add at this stage.
            for Prescribed { node, axis, profile } in &problem.prescribed {
                let (n, i) = (*node as usize, *axis);
                let drive = mass[n] * profile.acceleration(self.time) - self.force[n][i];
                self.external_work[n] += share * drive * profile.rate(self.time);
            }
            self.time = start + ahead * h;
            self.impose();
        }
        self.time = start + h;
        self.displacement.copy_from_slice(&stages.displacement_sum);
        self.rate.copy_from_slice(&stages.rate_sum);
        self.impose();
        self.stages = Some(stages);
    }
}
