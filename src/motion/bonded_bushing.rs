//! A bushing of rubber elements bonded between two bodies, in its own steps between two exchanges of impulse.
//!
//! The bodies prescribe the displacements of the sleeve nodes and have their mass. Forces of the elements on these
//! nodes are summed over a coupling step and applied to the bodies, as those of a housing fit.

use crate::assembly::lists::Assembly;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, scale, sub};
use crate::members::connection::{Connection, Law};
use crate::members::rigid_body::Wrench;
use crate::members::state::BodyState;
use crate::motion::race_in_bore::{in_free_motion, mean_over, work_on_way};
use crate::motion::simulation::Simulation;
use crate::numeric::profile::Profile;
use crate::plan::counts::Counts;
use crate::solids::error::SolidError;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::model::Prescribed;
use crate::solids::rubber::explicit::RubberBody;
use crate::solids::rubber::harmonic::complex_stiffness;
use crate::solids::rubber::measures::RubberLedger;
use crate::solids::rubber::model::RubberModel;
use crate::solids::rubber::sleeve::SleeveMotion;
use crate::solids::rubber::steps::{RubberSolid, StepOptions};
use crate::solids::tet4_blocks::Node;
use nalgebra::Vector3;

/// A bushing in coupled motion, at its start.
#[derive(Clone, Debug)]
pub struct BondedPart<'p> {
    /// Name in columns and messages.
    pub name: String,
    /// Bodies of the outer and the inner sleeve, and the position of the bushing's middle on their axes.
    pub sleeves: [Sleeve; 2],
    /// Equivalent spring with the relaxed stiffness of the elements; the run starts from its equilibrium.
    pub spring: Connection,
    pub elements: BondedElements<'p>,
    /// Phase of a body on the bushing in a coupling step, rad.
    pub coupling_phase: f64,
}

/// Bushing nodes that move with a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Sleeve {
    /// Index of the body.
    pub body: usize,
    pub nodes: Vec<u32>,
    /// Initial position of the nodes from the body's centre, m.
    pub arms: Vec<Vec3>,
    /// Initial centre of the body, m.
    pub nominal: Vec3,
}

impl BondedPart<'_> {
    /// Sets the stiffness of the equivalent spring to the relaxed stiffness of the elements, so that the run starts in
    /// their own equilibrium. Coarse elements are too stiff.
    ///
    /// # Errors
    ///
    /// Rubber without an equilibrium.
    pub(crate) fn measure(&mut self) -> Result<(), SolidError> {
        // The first iteration vector is the solution already.
        const SETTLED: f64 = 1e-6;
        let mut model = match self.elements {
            BondedElements::Implicit { model, .. } => model.clone(),
            BondedElements::Explicit { body, .. } => body.implicit()?,
        };
        let [outer, inner] = &self.sleeves;
        let second = usize::from(inner.body == self.spring.ends[1].body);
        let along = self.spring.ends[second].along;
        let mut stiffness = [0.0; 4];
        for (motion, stiffness) in SleeveMotion::ALL.into_iter().zip(&mut stiffness) {
            let held = |node: &u32| (*node, [0.0; 3]);
            let moved = inner
                .nodes
                .iter()
                .zip(&inner.arms)
                .map(|(node, [x, y, z])| (*node, motion.displacement([x - along, *y, *z])));
            let ways = outer.nodes.iter().map(held).chain(moved);
            let component = |(node, way): (u32, Vec3)| {
                [0, 1, 2].map(|axis| Prescribed {
                    node,
                    axis,
                    profile: Profile::Constant(way[axis]),
                })
            };
            model.problem.prescribed = ways.flat_map(component).collect();
            *stiffness = complex_stiffness(&model, 0.0, &[0.0], SETTLED)?[0].storage;
        }
        let [radial, axial, torsional, conical] = stiffness;
        match &mut self.spring.law {
            Law::SpringDashpot(law) => {
                law.stiffness = [axial, radial, radial, torsional, conical, conical];
            }
            Law::Torsion(law) => law.stiffness = torsional,
        }
        Ok(())
    }

    /// Returns whether its sleeves are displaced.
    pub(crate) fn is_moved(&self, simulation: &Simulation) -> bool {
        let moved = |sleeve: &Sleeve| {
            let body = simulation.body(sleeve.body);
            sleeve.displacements(&body).any(|(_, u)| u != [0.0; 3])
        };
        self.sleeves.iter().any(moved)
    }
}

/// Integration of the rubber.
#[derive(Clone, Debug)]
pub enum BondedElements<'p> {
    /// Four-node elements in explicit steps (3.12), a fraction of the longest stable one.
    Explicit { body: &'p RubberBody, fraction: f64 },
    /// Implicit steps, at most this long (s) if a coupling step is longer.
    Implicit { model: &'p RubberModel, step: Option<f64> },
}

/// Rubber in motion.
pub enum BondedRubber<'p> {
    Explicit(Box<ExplicitSolid>),
    Implicit(Box<RubberSolid<'p>>),
}

/// A bushing at the present time.
pub struct BondedBushing<'p> {
    pub name: String,
    pub sleeves: [SleeveNow; 2],
    /// Index of the sleeve on the second body of the spring.
    pub second: usize,
    pub rubber: BondedRubber<'p>,
    /// Number of steps in a coupling step, and their length, s.
    pub steps: usize,
    pub step: f64,
    /// Longest step of the rubber, s; `None`: one step a coupling step.
    pub(crate) most: Option<f64>,
    /// Stiffness against a sudden displacement (N/m) and rotation (N·m/rad) of a body.
    pub(crate) stiffness: [f64; 2],
    pub(crate) coupling_phase: f64,
}

/// Loads of a bushing on the body of a sleeve.
pub struct SleeveNow {
    pub sleeve: Sleeve,
    /// Loads on the body about its centre, in the last step and in the one before it.
    pub loads: [Wrench; 2],
    /// Work on the body since the start, J.
    pub work: f64,
    /// In the present coupling step: the body at its beginning; impulse (N·s) and angular impulse (N·m·s) on it.
    pub(crate) from: BodyState,
    handed: Wrench,
    /// Mean accelerations of the previous coupling step, m/s² and rad/s², with which the body is extrapolated.
    pushed: [Vec3; 2],
    /// Extrapolated body at the time of the rubber.
    there: BodyState,
}

/// Energies of a bushing at one time, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BondedSnapshot {
    /// Energy stored by the network and by the springs of the Maxwell elements, and lost in their dashpots; the last
    /// two by the law of small strain.
    pub network: f64,
    pub springs: f64,
    pub dissipated: f64,
    /// Work of the Maxwell stresses beyond that law.
    pub beyond: f64,
    pub kinetic: f64,
    /// Work on both bodies since the start, and up to the time of the rubber, half a step away.
    pub work: f64,
    pub to_come: f64,
    /// On the body of each sleeve now, about its centre.
    pub loads: [Wrench; 2],
}

impl BondedSnapshot {
    pub fn held(&self) -> f64 {
        self.network + self.springs + self.kinetic
    }
}

impl Sleeve {
    /// Displacements of the nodes for this state of the body, m.
    fn displacements(&self, body: &BodyState) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let shift = sub(body.position, self.nominal);
        let turn = body.orientation.into_inner();
        self.nodes.iter().zip(&self.arms).map(move |(node, arm)| {
            // R r − r without the difference of long vectors.
            let axis = [turn.i, turn.j, turn.k];
            let once = cross(axis, *arm);
            let by = add(scale(once, 2.0 * turn.w), scale(cross(axis, once), 2.0));
            (*node, add(shift, by))
        })
    }
}

impl SleeveNow {
    fn new(sleeve: Sleeve, simulation: &Simulation) -> SleeveNow {
        let from = simulation.body(sleeve.body);
        let loads = [Wrench::default(); 2];
        let handed = Wrench::default();
        let pushed = [[0.0; 3]; 2];
        SleeveNow { sleeve, loads, work: 0.0, there: from, from, handed, pushed }
    }

    pub(crate) fn begin_coupling_step(&mut self, coupling_step: f64, body: BodyState) {
        let per_time = |now: Vec3, then: Vec3| scale(sub(now, then), 1.0 / coupling_step);
        self.pushed =
            [per_time(body.velocity, self.from.velocity), per_time(body.spin, self.from.spin)];
        self.from = body;
        self.handed = Wrench::default();
    }

    /// The body `after` s from the beginning of the coupling step, with the accelerations of the previous one.
    fn ahead(&self, after: f64) -> BodyState {
        let mut body = self.from;
        body.velocity = add_scaled(body.velocity, 0.5 * after, self.pushed[0]);
        body.spin = add_scaled(body.spin, 0.5 * after, self.pushed[1]);
        in_free_motion(&body, after)
    }

    /// Books the forces on its nodes (N) `after` s from the beginning of the coupling step, over `step` s.
    fn take(&mut self, after: f64, step: f64, pull: impl Fn(u32) -> Vec3) {
        let body = self.ahead(after);
        let mut sum = Wrench::default();
        for (node, arm) in self.sleeve.nodes.iter().zip(&self.sleeve.arms) {
            let (arm, force) = (body.orientation * Vector3::from(*arm), pull(*node));
            sum.add(&Wrench { force, moment: cross(arm.into(), force) });
        }
        self.loads = [sum, self.loads[0]];
        self.handed.force = add_scaled(self.handed.force, step, sum.force);
        self.handed.moment = add_scaled(self.handed.moment, step, sum.moment);
    }

    /// Mean load of the impulse over the coupling step, N and N·m.
    pub(crate) fn mean_load(&self, coupling_step: f64) -> Wrench {
        mean_over(&self.handed, coupling_step)
    }

    /// Books the work of that load on the body up to its state `to`.
    pub(crate) fn book(&mut self, coupling_step: f64, to: &BodyState) {
        self.work += work_on_way(&self.mean_load(coupling_step), &self.from, to);
    }

    /// Load now, half a step after that of the last step.
    fn load_now(&self) -> Wrench {
        let [last, before] = &self.loads;
        let on = |last: Vec3, before: Vec3| add_scaled(last, 0.5, sub(last, before));
        Wrench { force: on(last.force, before.force), moment: on(last.moment, before.moment) }
    }
}

impl<'p> BondedBushing<'p> {
    /// A bushing at rest around its bodies at their present positions.
    ///
    /// # Errors
    ///
    /// Rubber without an equilibrium there.
    pub(crate) fn new(
        part: BondedPart<'p>,
        simulation: &Simulation,
    ) -> Result<BondedBushing<'p>, SolidError> {
        let elements = part.elements.clone();
        let mut bushing = BondedBushing::unmoved(part, simulation)?;
        let now = || bushing.sleeves.iter();
        let at = || now().flat_map(|now| now.sleeve.displacements(&now.from));
        if at().any(|(_, u)| u != [0.0; 3]) {
            bushing.rubber = match elements {
                BondedElements::Implicit { model, .. } => {
                    let mut solid = RubberSolid::new(model, StepOptions::default())?;
                    solid.rest_with(at())?;
                    BondedRubber::Implicit(Box::new(solid))
                }
                BondedElements::Explicit { body, fraction } => {
                    let model = body.implicit()?;
                    let mut solid = RubberSolid::new(&model, StepOptions::default())?;
                    solid.rest_with(at())?;
                    let displacement = solid.displacement().to_vec();
                    let solid = ExplicitSolid::of_driven_rubber(body, fraction, displacement)?;
                    BondedRubber::Explicit(Box::new(solid))
                }
            };
        }
        bushing.first_loads();
        Ok(bushing)
    }

    /// An undeformed bushing, whatever the positions of its bodies.
    pub(crate) fn unmoved(
        part: BondedPart<'p>,
        simulation: &Simulation,
    ) -> Result<BondedBushing<'p>, SolidError> {
        let second = usize::from(part.sleeves[1].body == part.spring.ends[1].body);
        let sleeves = part.sleeves.map(|sleeve| SleeveNow::new(sleeve, simulation));
        let (rubber, most) = match part.elements {
            BondedElements::Implicit { model, step } => {
                let solid = RubberSolid::new(model, StepOptions::default())?;
                (BondedRubber::Implicit(Box::new(solid)), step)
            }
            BondedElements::Explicit { body, fraction } => {
                let still = vec![[0.0; 3]; body.nodes.len()];
                let solid = ExplicitSolid::of_driven_rubber(body, fraction, still)?;
                let step = solid.step_size;
                (BondedRubber::Explicit(Box::new(solid)), Some(step))
            }
        };
        Ok(BondedBushing {
            stiffness: sudden_stiffness(&part.spring),
            coupling_phase: part.coupling_phase,
            name: part.name,
            steps: 1,
            step: 0.0,
            sleeves,
            second,
            rubber,
            most,
        })
    }

    /// Loads of the rubber at rest, for all past steps.
    fn first_loads(&mut self) {
        let forces = self.forces();
        for now in &mut self.sleeves {
            for _ in 0..2 {
                now.take(0.0, 0.0, |node| forces[node as usize]);
            }
            now.handed = Wrench::default();
        }
    }

    /// Forces of the elements on the nodes as last evaluated, N.
    fn forces(&self) -> Vec<Vec3> {
        match &self.rubber {
            BondedRubber::Explicit(solid) => {
                solid.forces().iter().map(|f| [f[0], f[1], f[2]]).collect()
            }
            BondedRubber::Implicit(solid) => solid.state().forces.clone(),
        }
    }

    /// Sets the steps for a coupling step of this length (s), before the first one.
    pub(crate) fn step_in(&mut self, coupling_step: f64) {
        let of = |most: f64| ((coupling_step / most * (1.0 - 1e-12)).ceil() as usize).max(1);
        self.steps = self.most.map_or(1, of);
        self.step = coupling_step / self.steps as f64;
        if let BondedRubber::Explicit(solid) = &mut self.rubber {
            solid.step_size = self.step;
            solid.time = 0.5 * self.step;
        }
    }

    pub(crate) fn begin_coupling_step(&mut self, simulation: &Simulation) {
        let coupling_step = self.steps as f64 * self.step;
        for now in &mut self.sleeves {
            now.begin_coupling_step(coupling_step, simulation.body(now.sleeve.body));
        }
    }

    /// Takes the steps of a coupling step, with the bodies extrapolated. Explicit steps end half a step after the time
    /// of the bodies, implicit ones half a step before it.
    pub(crate) fn take_coupling_step(&mut self) -> Result<(), SolidError> {
        for k in 0..self.steps {
            let after = (k as f64 + 0.5) * self.step;
            self.step_to(after)?;
        }
        Ok(())
    }

    fn step_to(&mut self, after: f64) -> Result<(), SolidError> {
        let (step, sleeves) = (self.step, &mut self.sleeves);
        match &mut self.rubber {
            BondedRubber::Explicit(solid) => {
                for now in sleeves.iter_mut() {
                    let [here, next] = [after, after + step].map(|t| now.ahead(t));
                    let ways = now.sleeve.displacements(&here).zip(now.sleeve.displacements(&next));
                    solid.drive_nodes(
                        ways.map(|((node, u), (_, next))| {
                            (node, u, scale(sub(next, u), 1.0 / step))
                        }),
                    );
                    now.there = next;
                }
                solid.step(|_, _, forces: &mut [Node]| {
                    for now in sleeves.iter_mut() {
                        now.take(after, step, |node| {
                            let force = forces[node as usize];
                            [force[0], force[1], force[2]]
                        });
                    }
                })?;
            }
            BondedRubber::Implicit(solid) => {
                let ends = sleeves.each_ref().map(|now| now.ahead(after));
                let nodes = sleeves.iter().zip(&ends);
                solid
                    .driven_step(step, nodes.flat_map(|(now, at)| now.sleeve.displacements(at)))?;
                for (now, at) in sleeves.iter_mut().zip(ends) {
                    now.there = at;
                    now.take(after, step, |node| solid.state().forces[node as usize]);
                }
            }
        }
        Ok(())
    }

    /// Cost of a coupling step in evaluations of a steel element, roughly.
    pub fn effort(&self) -> u64 {
        let (elements, worth) = match &self.rubber {
            BondedRubber::Explicit(solid) => (solid.model.problem.elements.len(), 4),
            // Iterations of ten-node elements, and a solution.
            BondedRubber::Implicit(solid) => (solid.model().problem.elements.len(), 1000),
        };
        (elements * worth * self.steps) as u64
    }

    /// Number of steps of the rubber so far.
    pub fn steps_done(&self) -> u64 {
        match &self.rubber {
            BondedRubber::Explicit(solid) => solid.steps,
            BondedRubber::Implicit(solid) => solid.counts.accepted,
        }
    }

    /// Number of runs of each stage.
    pub fn ran(&self) -> Counts {
        match &self.rubber {
            BondedRubber::Explicit(solid) => solid.ran,
            BondedRubber::Implicit(solid) => *solid.ran(),
        }
    }

    pub(crate) fn forget_ran(&mut self) {
        match &mut self.rubber {
            BondedRubber::Explicit(solid) => solid.ran = Counts::default(),
            BondedRubber::Implicit(solid) => solid.forget_ran(),
        }
    }

    /// Displacement of all nodes, m, half a step from the time of the bodies.
    pub fn displacement(&self) -> Vec<Vec3> {
        match &self.rubber {
            BondedRubber::Explicit(solid) => {
                solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect()
            }
            BondedRubber::Implicit(solid) => solid.displacement().to_vec(),
        }
    }

    pub(crate) fn snapshot(&mut self, simulation: &Simulation) -> BondedSnapshot {
        let mut found = match &mut self.rubber {
            BondedRubber::Explicit(solid) => {
                let energy = solid.ledger().energy;
                let of = solid.rubber().map(|rubber| rubber.maxwell_ledger(&solid.displacement));
                let [springs, dissipated, beyond] = of.unwrap_or_default();
                let (network, kinetic) = (energy.strain, energy.kinetic);
                let held = BondedSnapshot { network, springs, kinetic, ..Default::default() };
                BondedSnapshot { dissipated, beyond, ..held }
            }
            BondedRubber::Implicit(solid) => {
                // The state was found before; an invalid one makes the ledger end the run.
                let ledger = RubberLedger::of(solid.model(), solid.state());
                let unknown = RubberLedger { network: f64::NAN, ..RubberLedger::default() };
                let found = ledger.unwrap_or(unknown);
                let RubberLedger { network, springs, dissipated, beyond, .. } = found;
                let kinetic = solid.kinetic_energy();
                let held = BondedSnapshot { network, springs, kinetic, ..Default::default() };
                BondedSnapshot { dissipated, beyond, ..held }
            }
        };
        for (now, load) in self.sleeves.iter().zip(&mut found.loads) {
            *load = now.load_now();
            let body = simulation.body(now.sleeve.body);
            found.work += now.work;
            found.to_come += work_on_way(load, &body, &now.there);
        }
        found
    }
}

/// Largest stiffness against a displacement (N/m) and a rotation (N·m/rad) before any relaxation.
fn sudden_stiffness(spring: &Connection) -> [f64; 2] {
    let law = match &spring.law {
        Law::SpringDashpot(law) => law,
        Law::Torsion(law) => return [0.0, law.stiffness],
    };
    let of = |i: usize| {
        law.stiffness[i] + law.maxwell.iter().map(|element| element.stiffness[i]).sum::<f64>()
    };
    [0..3, 3..6].map(|axes| axes.map(of).fold(0.0, f64::max))
}

/// Adds the mass of the sleeve nodes (kg, one for each node) to the bodies of the sleeves.
pub fn add_mass(assembly: &mut Assembly, sleeve: &Sleeve, mass: &[f64]) {
    let body = &mut assembly.bodies[sleeve.body];
    let Some(race) = body.driven_mut() else { return };
    for (node, [x, y, z]) in sleeve.nodes.iter().zip(&sleeve.arms) {
        let mass = mass[*node as usize];
        let around = y * y + z * z;
        race.inertia.mass += mass;
        race.inertia.axial += mass * around;
        race.inertia.transverse += mass * (x * x + 0.5 * around);
    }
}
