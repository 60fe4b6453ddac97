//! All that steps of a solid of rubber go on from with the same bits.

use crate::elements::tet10::POINTS;
use crate::kinematics::strain::Sym3;
use crate::kinematics::vec3::Vec3;
use crate::solids::rubber::model::RubberModel;
use crate::solids::rubber::steps::StepCounts;

/// The state after an accepted step: nothing else is kept from step to step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RubberState {
    /// s.
    pub time: f64,
    /// m, one for each node.
    pub displacement: Vec<Vec3>,
    /// DEV S of the network at the quadrature points, Pa.
    pub deviatoric: Vec<Sym3>,
    /// Stresses of the Maxwell elements, one point after the other, Pa.
    pub history: Vec<Sym3>,
    /// The last step (s) and the rates of displacement (m/s) and DEV S (Pa/s) in it; a step of zero behind
    /// a corner.
    pub last: f64,
    pub velocity: Vec<Vec3>,
    pub rate: Vec<Sym3>,
    /// Forces of the elements on the nodes, N.
    pub forces: Vec<Vec3>,
    /// Work of loads and supports so far, by the trapezium rule over the steps, J.
    pub work: f64,
    /// What the dashpots have taken so far by the law of small strain, J.
    pub dissipated: f64,
    /// What the stresses of the Maxwell elements did beyond that law, J.
    pub beyond: f64,
    /// Of the nodes, m/s and m/s², where they have inertia.
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

/// The state that the factors at hand are of: a search begins with them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Factored {
    /// See [`crate::solids::rubber::tangent::StepLaw`].
    pub gain: f64,
    pub inertia: f64,
    pub displacement: Vec<Vec3>,
    pub carried: Vec<Sym3>,
}

/// See [`crate::solids::rubber::steps::RubberSolid::checkpoint`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RubberCheckpoint {
    pub state: RubberState,
    /// What the next step should be, s, and the largest total deviatoric stress so far, Pa.
    pub next: f64,
    pub scale: f64,
    pub counts: StepCounts,
    pub iterations: usize,
    pub factorisations: usize,
    pub factored: Option<Factored>,
}

impl RubberCheckpoint {
    /// The long parts, one behind the other.
    pub fn numbers(&self) -> Vec<f64> {
        let state = &self.state;
        let of_nodes = [&state.displacement, &state.velocity, &state.forces];
        let of_points = [&state.deviatoric, &state.rate, &state.history];
        let mut numbers: Vec<f64> = Vec::new();
        of_nodes.iter().for_each(|part| numbers.extend(part.as_flattened()));
        of_points.iter().for_each(|part| numbers.extend(part.as_flattened()));
        if let Some(factored) = &self.factored {
            numbers.extend(factored.displacement.as_flattened());
            numbers.extend(factored.carried.as_flattened());
        }
        numbers
    }

    /// How many [`RubberCheckpoint::numbers`] there are of a body of so many nodes, quadrature points and
    /// Maxwell elements.
    pub fn length(&self, [nodes, points, terms]: [usize; 3]) -> usize {
        let factored = if self.factored.is_some() { 3 * nodes + 6 * points } else { 0 };
        9 * nodes + 6 * points * (2 + terms) + factored
    }

    /// Takes the long parts from where [`RubberCheckpoint::numbers`] left them; `None` if they are not
    /// as many as those of a body of so many nodes, quadrature points and Maxwell elements.
    #[must_use]
    pub fn with_numbers(mut self, [nodes, points, terms]: [usize; 3], all: &[f64]) -> Option<Self> {
        let mut rest = all;
        let mut next = |count: usize| rest.split_off(..count);
        let state = &mut self.state;
        for part in [&mut state.displacement, &mut state.velocity, &mut state.forces] {
            *part = next(3 * nodes)?.as_chunks().0.to_vec();
        }
        for (part, count) in [
            (&mut state.deviatoric, points),
            (&mut state.rate, points),
            (&mut state.history, points * terms),
        ] {
            *part = next(6 * count)?.as_chunks().0.to_vec();
        }
        if let Some(factored) = &mut self.factored {
            factored.displacement = next(3 * nodes)?.as_chunks().0.to_vec();
            factored.carried = next(6 * points)?.as_chunks().0.to_vec();
        }
        rest.is_empty().then_some(self)
    }
}
