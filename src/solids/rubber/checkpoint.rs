//! Checkpoint of a solid of rubber, from which its steps continue with the same bits.

use crate::elements::tet10::POINTS;
use crate::kinematics::strain::Sym3;
use crate::kinematics::vec3::Vec3;
use crate::solids::rubber::model::RubberModel;
use crate::solids::rubber::steps::StepCounts;
use serde::{Deserialize, Serialize};

/// The state after an accepted step, complete.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RubberState {
    /// s.
    pub time: f64,
    /// Displacement of each node, m.
    pub displacement: Vec<Vec3>,
    /// DEV S of the network at the quadrature points, Pa.
    pub deviatoric: Vec<Sym3>,
    /// Stresses of the Maxwell elements, one point after the other, Pa.
    pub history: Vec<Sym3>,
    /// The last step (s) and the rates of displacement (m/s) and DEV S (Pa/s) in it; zero behind a corner.
    pub last: f64,
    pub velocity: Vec<Vec3>,
    pub rate: Vec<Sym3>,
    /// Forces of the elements on the nodes, N.
    pub forces: Vec<Vec3>,
    /// Work of loads and supports so far, by the trapezoidal rule over the steps, J.
    pub work: f64,
    /// Energy dissipated by dashpots so far by the law of small strain, J.
    pub dissipated: f64,
    /// Work of the Maxwell stresses beyond that law, J.
    pub beyond: f64,
    /// Velocities and accelerations of the nodes, m/s and m/s², with inertia.
    pub speed: Vec<Vec3>,
    pub acceleration: Vec<Vec3>,
}

impl RubberState {
    /// At rest.
    pub fn rest(model: &RubberModel) -> RubberState {
        let (points, nodes) = (POINTS * model.tets.len(), model.problem.nodes.len());
        let terms = model.problem.material.maxwell.len();
        RubberState {
            displacement: vec![[0.0; 3]; nodes],
            deviatoric: vec![[0.0; 6]; points],
            history: vec![[0.0; 6]; points * terms],
            velocity: vec![[0.0; 3]; nodes],
            rate: vec![[0.0; 6]; points],
            forces: vec![[0.0; 3]; nodes],
            speed: vec![[0.0; 3]; model.mass.len()],
            acceleration: vec![[0.0; 3]; model.mass.len()],
            ..RubberState::default()
        }
    }
}

/// The state of the present factors, with which a search begins.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Factored {
    /// See [`crate::solids::rubber::tangent::StepLaw`].
    pub gain: f64,
    pub inertia: f64,
    pub displacement: Vec<Vec3>,
    pub carried: Vec<Sym3>,
}

/// See [`crate::solids::rubber::steps::RubberSolid::checkpoint`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RubberCheckpoint {
    pub state: RubberState,
    /// Length of the next step, s, and the largest total deviatoric stress so far, Pa.
    pub next: f64,
    pub scale: f64,
    pub counts: StepCounts,
    pub iterations: usize,
    pub factorisations: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub factored: Option<Factored>,
}
