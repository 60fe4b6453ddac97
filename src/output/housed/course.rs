//! A bearing in a condensed housing, one equilibrium a row.

use crate::output::housed::fields::BoreNodeState;
use crate::output::housed::rows::{SeatRow, seat_columns};
use crate::output::series::{Column, Series, SeriesError};
use crate::scene::housing::HousedScene;
use crate::scene::housing_problem::HousingSetup;
use crate::solver::channels::ChannelGroup;
use crate::solver::dynamics::model::{Drive, Rotation};
use crate::solver::housing::assembly::{AssemblySearch, AssemblyState};
use crate::solver::housing::bore_equilibrium::Fit;
use crate::solver::housing::condensed::CondensedBore;
use crate::solver::housing::inertia::Masses;
use crate::solver::housing::quasi_static::{Course, CourseError, Moment, history};
use crate::solver::profile::Profile;
use crate::solver::statics::{Condition, StaticProblem};
use ndarray::Array2;

/// What a scene asks of a condensed housing over time.
pub struct HousedCourse<'s> {
    scene: &'s HousedScene,
    setup: &'s HousingSetup,
    problem: StaticProblem,
    /// Between rows, s.
    pub interval: f64,
    /// Rows in all, the first at the start.
    pub count: usize,
    columns: Vec<Column>,
    values: Vec<f64>,
    loads: bool,
    /// The latest equilibrium.
    pub latest: Option<Moment>,
    /// Largest share of the load on the outer race that was left unbalanced, and effort.
    pub largest_residual: f64,
    pub rounds: usize,
    pub contact_changes: usize,
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

/// How many equilibria a course has, one a row every `interval` (s) from 0 to the whole row nearest to
/// the `end` (s).
pub fn equilibria(end: f64, interval: f64) -> usize {
    (end / interval).round().max(1.0) as usize + 1
}

pub fn masses(scene: &HousedScene) -> Option<Masses> {
    let dynamics = &scene.bearing.dynamics;
    let outer = dynamics.outer.as_ref()?.inertia;
    Some(Masses { inner: dynamics.inner.inertia, outer })
}

impl<'s> HousedCourse<'s> {
    /// Rows from 0 to the `end`, the last at the whole row nearest to it.
    pub fn new(
        scene: &'s HousedScene,
        setup: &'s HousingSetup,
        problem: StaticProblem,
        end: f64,
        interval: f64,
        channels: &[ChannelGroup],
    ) -> HousedCourse<'s> {
        let loads = channels.contains(&ChannelGroup::Loads);
        let columns = columns(problem.geometry.ball_count, loads);
        HousedCourse {
            scene,
            setup,
            problem,
            interval,
            count: equilibria(end, interval),
            columns,
            values: Vec::new(),
            loads,
            latest: None,
            largest_residual: 0.0,
            rounds: 0,
            contact_changes: 0,
        }
    }

    pub fn rows(&self) -> usize {
        self.values.len() / self.columns.len()
    }

    /// The bearing as the latest row has it.
    pub fn problem(&self) -> StaticProblem {
        let mut problem = self.problem.clone();
        if let Some(moment) = &self.latest {
            problem.conditions = on_inner(self.scene, moment.time);
            problem.ball_phase = moment.ball_phase;
        }
        problem
    }

    /// Solves the next row.
    ///
    /// # Errors
    /// No equilibrium at its time.
    pub fn next(&mut self, search: &mut AssemblySearch) -> Result<(), CourseError> {
        let time = self.rows() as f64 * self.interval;
        for moment in moments(self.scene, self.setup, &self.problem, search, time)? {
            self.record(search.bore().bore(), &moment);
            self.latest = Some(moment);
        }
        Ok(())
    }

    fn record(&mut self, bore: &CondensedBore, moment: &Moment) {
        let state = &moment.state;
        let inner = &state.bearing.coordinates;
        let [x, y, z, tilt_y, tilt_z] = outer_place(bore, state);
        let degrees = f64::to_degrees;
        self.values.push(moment.time);
        self.values.extend([inner[0], inner[1], inner[2], degrees(inner[3]), degrees(inner[4])]);
        self.values.extend([x, y, z, degrees(tilt_y), degrees(tilt_z)]);
        self.values.extend(state.bearing.force_on_inner.iter());
        self.values.extend(state.bearing.force_on_outer.iter());
        self.values.extend(SeatRow::of_equilibrium(bore, &state.bore).values());
        self.values.extend([state.bore.elastic_energy, state.bore.contact_energy]);
        if self.loads {
            for ball in &state.bearing.balls {
                self.values.extend([ball.inner.normal_load, ball.outer.normal_load]);
            }
        }
        self.largest_residual = self.largest_residual.max(state.residual);
        self.rounds += state.rounds;
        self.contact_changes += state.contact_changes;
    }

    /// All rows as a table.
    ///
    /// # Errors
    /// Never for these columns.
    pub fn series(&self) -> Result<Series, SeriesError> {
        let shape = (self.rows(), self.columns.len());
        let data = Array2::from_shape_vec(shape, self.values.clone())
            .expect("every row gives one value per column");
        Series::new(self.columns.clone(), data)
    }
}

/// The one equilibrium of `problem` at a time of the scene.
///
/// # Errors
/// No equilibrium then.
pub fn moments(
    scene: &HousedScene,
    setup: &HousingSetup,
    problem: &StaticProblem,
    search: &mut AssemblySearch,
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
    let course = Course {
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
pub fn outer_place(bore: &CondensedBore, state: &AssemblyState) -> [f64; 5] {
    let pose = crate::solver::housing::condensed::placed(&bore.reach.nominal, &state.bore.pose);
    let (_, tilt_y, tilt_z) = crate::kinematics::euler::angles(&pose.orientation);
    [pose.position.x, pose.position.y, pose.position.z, tilt_y, tilt_z]
}

/// Nodes of a condensed bore in an equilibrium.
pub fn bore_nodes(
    setup: &HousingSetup,
    bore: &CondensedBore,
    state: &AssemblyState,
) -> Vec<BoreNodeState> {
    let place = |node: u32| setup.model.problem.nodes[node as usize];
    bore.nodes
        .iter()
        .zip(&state.bore.penetration)
        .zip(bore.nodal_forces(&state.bore.loads))
        .map(|((node, penetration), (_, force))| BoreNodeState {
            node: node.node,
            place: place(node.node),
            area: node.area,
            penetration: *penetration,
            force,
        })
        .collect()
}

fn columns(balls: usize, loads: bool) -> Vec<Column> {
    let mut columns = vec![Column::new("time", "s")];
    for race in ["inner", "outer"] {
        for (name, unit) in
            [("x", "m"), ("y", "m"), ("z", "m"), ("tilt_y", "deg"), ("tilt_z", "deg")]
        {
            columns.push(Column::new(format!("{race}_{name}"), unit));
        }
    }
    for race in ["inner", "outer"] {
        let axes = ["x", "y", "z"];
        columns.extend(axes.map(|a| Column::new(format!("contact_force_on_{race}_{a}"), "N")));
    }
    columns.extend(seat_columns());
    columns.push(Column::new("energy_housing_strain", "J"));
    columns.push(Column::new("energy_seat", "J"));
    for ball in (1..=balls).filter(|_| loads) {
        columns.push(Column::new(format!("ball_{ball}_inner_load"), "N"));
        columns.push(Column::new(format!("ball_{ball}_outer_load"), "N"));
    }
    columns
}
