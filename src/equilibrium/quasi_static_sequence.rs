//! Quasi-static sequence of bearings, bodies and condensed housings: one equilibrium after the other.
//!
//! Balls orbit at the cage speed of pure rolling; inertia is omitted except for centrifugal forces of balls.
//! [`crate::equilibrium::quasi_static_limit`] estimates the omitted part.

use crate::assembly::lists::Assembly;
use crate::assembly::prescribed::{conditions, orbital_angle};
use crate::ch2_housing::bore_contact::Penalty;
use crate::equilibrium::initial::{add_reactions, static_assembly};
use crate::equilibrium::lists::{Place, StaticAssembly, StaticBody, StaticSeat};
use crate::equilibrium::quasi_static_limit::MovingBody;
use crate::equilibrium::statics::{AssemblySolution, StaticsError};
use crate::equilibrium::warm_started_search::{
    SearchMemory, WarmStartedSearch, load_of_balls, unbalanced,
};
use crate::kinematics::Pose;
use crate::kinematics::euler::quaternion;
use crate::kinematics::vec3::{Vec3, scale};
use crate::members::body::{Body, Condition, Drive};
use crate::members::flexible_shaft::{Bend, Section};
use crate::members::mount::Mount;
use crate::members::rigid_body::{BodyKinematics, fixed, kinematics_at_mount, tilts_of};
use crate::numeric::profile::Profile;
use crate::plan::Stage;
use crate::plan::counts::StageCounts;
use crate::solids::bore_equilibrium::{Axial, BoreError, Fit, RaceLoad};
use crate::solids::condensation::CondensedBore;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Bodies under varying loads, and races in housings.
#[derive(Clone)]
pub struct QuasiStaticProblem<'b> {
    pub assembly: Assembly,
    pub seats: Vec<QuasiStaticFit<'b>>,
}

/// The outer race of a bearing in the bore of its own housing.
#[derive(Clone)]
pub struct QuasiStaticFit<'b> {
    /// Name in messages and columns; `None` for the only one.
    pub name: Option<String>,
    /// Index of the bearing.
    pub bearing: usize,
    pub bore: &'b CondensedBore,
    pub penalty: Penalty,
    /// Axial support of the race.
    pub axial: Axial,
    /// Radius of the race, m: an interference grows in.
    pub radius: Profile,
    /// Damping of the housing per mass and velocity, 1/s, for the estimate of the omitted inertia.
    pub damping: f64,
}

/// Equilibrium at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct EquilibriumAt {
    /// s.
    pub time: f64,
    pub solution: AssemblySolution,
    /// Largest load residual of a race in its bore over its load.
    pub residual: f64,
    /// Changes of the contact nodes.
    pub contact_changes: usize,
}

#[derive(Clone, Debug, PartialEq, Error)]
#[error("at t = {time} s: {source}")]
pub struct QuasiStaticError {
    pub time: f64,
    pub source: StaticsError,
}

impl QuasiStaticFit<'_> {
    pub fn fit(&self, t: f64) -> Fit {
        Fit { radius: self.radius.value(t), axial: self.axial }
    }

    /// The body of the race.
    pub fn body(&self, assembly: &Assembly) -> usize {
        assembly.bearings[self.bearing].mounts[1].body
    }
}

impl<'b> QuasiStaticFit<'b> {
    /// Puts the race, with its radius at `t`, in its bore; its axial position is fixed, since the bore does not support
    /// it along the axis.
    pub fn add_to(&self, still: &mut StaticAssembly<'b>, t: f64) {
        let [inner, outer] = still.bearings[self.bearing].mounts.map(|mount| mount.body);
        if let Place::Loaded(race) = &mut still.bodies[outer].place
            && matches!(race.conditions[0], Condition::Load(_))
        {
            race.conditions[0] = Condition::Displacement(race.rest[0]);
        }
        if still.bearings.len() == 1
            && let Place::Loaded(race) = &mut still.bodies[inner].place
        {
            // Searched in the direction of its load.
            race.start = None;
        }
        still.seats.push(StaticSeat {
            name: self.name.clone(),
            mount: Mount::at_centre(outer),
            nominal: self.bore.reach.nominal,
            bore: self.bore,
            penalty: self.penalty,
            fit: self.fit(t),
        });
    }
}

impl<'b> QuasiStaticProblem<'b> {
    /// Static problem at `t`, with the balls at their rolled positions.
    pub fn at(&self, t: f64) -> StaticAssembly<'b> {
        let bearings = self.assembly.bearings.iter();
        let turned: Vec<f64> =
            bearings.map(|bearing| orbital_angle(&self.assembly, bearing, t)).collect();
        let mut still: StaticAssembly<'b> = static_assembly(&self.assembly, t, &turned);
        add_reactions(&self.assembly, t, &mut still);
        self.seats.iter().for_each(|seat| seat.add_to(&mut still, t));
        still
    }

    /// Equilibrium at `t`, searched from the last one.
    ///
    /// # Errors
    ///
    /// No equilibrium; an axial load without support.
    pub fn find(
        &self,
        search: &mut WarmStartedSearch<'b>,
        t: f64,
    ) -> Result<EquilibriumAt, QuasiStaticError> {
        self.solve(search, &self.at(t), t).map_err(|source| QuasiStaticError { time: t, source })
    }

    /// Equilibrium of these lists, made by [`QuasiStaticProblem::at`] for `t`.
    ///
    /// # Errors
    ///
    /// See [`QuasiStaticProblem::find`].
    pub fn solve(
        &self,
        search: &mut WarmStartedSearch<'b>,
        still: &StaticAssembly<'b>,
        t: f64,
    ) -> Result<EquilibriumAt, StaticsError> {
        let before = search.contact_changes();
        let solution = search.solve(still)?;
        let mut residual = 0.0f64;
        for (index, seat) in self.seats.iter().enumerate() {
            let part = self.unbalanced(&solution, index, t).map_err(|source| {
                let of =
                    seat.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
                StaticsError::Seat { of, source }
            })?;
            residual = residual.max(part);
        }
        let contact_changes = search.contact_changes() - before;
        Ok(EquilibriumAt { time: t, solution, residual, contact_changes })
    }

    fn unbalanced(&self, found: &AssemblySolution, seat: usize, t: f64) -> Result<f64, BoreError> {
        let QuasiStaticFit { bearing, bore, .. } = &self.seats[seat];
        let body = self.seats[seat].body(&self.assembly);
        let at = &found.coordinates[body];
        let position = Vector3::new(at[0], at[1], at[2]);
        let race = Pose { position, orientation: quaternion(0.0, at[3], at[4]) };
        let state = &found.bearings[*bearing];
        let [force, moment] =
            load_of_balls([state.forces[1], state.moments[1]], &state.balls, &race);
        let own = own_loads(&self.assembly, &self.assembly.bodies[body], t);
        let nominal = |of: Vector3<f64>| bore.to_nominal(Vec3::from(of));
        let on_race = RaceLoad {
            force: nominal(force + Vector3::new(own[0], own[1], own[2])),
            moment: nominal(moment + Vector3::new(0.0, own[3], own[4])),
        };
        unbalanced(&self.seats[seat].fit(t), &on_race, &found.seats[seat], &state.balls)
    }

    /// Position relative to the bearing (m) and tilts (rad) of a race.
    pub fn race(&self, found: &AssemblySolution, bearing: usize, side: usize) -> [f64; 5] {
        let of = &self.assembly.bearings[bearing];
        let mount = &of.mounts[side];
        let mut at = found.place(&self.assembly, mount.body);
        let shaft = self.assembly.shafts.iter().position(|shaft| shaft.body == mount.body);
        if shaft.is_some() || !mount.is_direct() {
            let race = match shaft {
                Some(shaft) => {
                    let section = self.assembly.shafts[shaft].shapes.section(mount.along);
                    self.section(found, shaft, &section, mount)
                }
                None => kinematics_at_mount(&fixed(&at), mount),
            };
            // In the scene's axes, also for a reversed bearing.
            let axis = scale(race.motion.axis, if mount.reversed { -1.0 } else { 1.0 });
            let ([x, y, z], [tilt_y, tilt_z]) = (race.state.position, tilts_of(axis));
            at = [x, y, z, tilt_y, tilt_z];
        }
        at[0] -= self.assembly.place_of(of);
        at
    }

    /// A section of a flexible body, with an attachment as `mount` says.
    pub fn section(
        &self,
        found: &AssemblySolution,
        shaft: usize,
        section: &Section,
        mount: &Mount,
    ) -> BodyKinematics {
        let of = &self.assembly.shafts[shaft];
        let mut entries = found.amplitudes[shaft].clone();
        entries.resize(of.entries(), 0.0);
        let body = fixed(&found.place(&self.assembly, of.body));
        section.place(&body, mount, &Bend::of(of.count(), &entries)).race
    }

    /// Returns whether a race of a bearing may move.
    pub fn moves(&self, bearing: usize, side: usize) -> bool {
        let body = self.assembly.bearings[bearing].mounts[side].body;
        self.assembly.bodies[body].moves()
    }

    /// Bodies moved by loads, with their inertia. Along the axis, where bearings are soft and nothing drives it, a body
    /// under constant load counts as fixed.
    pub fn moving(&self) -> Vec<MovingBody> {
        let still = self.at(0.0);
        let bodies = still.bodies.iter().zip(&self.assembly.bodies).enumerate();
        let of = |(index, (still, body)): (usize, (&StaticBody, &Body))| {
            let Place::Loaded(loaded) = &still.place else { return None };
            let race = body.driven()?;
            let mut free = [0, 1, 2, 3, 4].map(|i| loaded.prescribed(i).is_none());
            free[0] &= !matches!(race.drives[0], Drive::Load(Profile::Constant(_)));
            Some(MovingBody { body: index, inertia: race.inertia, free })
        };
        bodies.filter_map(of).collect()
    }
}

/// Loads along a body's coordinates in addition to contacts and springs.
fn own_loads(assembly: &Assembly, body: &Body, t: f64) -> [f64; 5] {
    let Some(race) = body.driven() else { return [0.0; 5] };
    conditions(assembly, body, race, t).map(|condition| match condition {
        Condition::Load(load) => load,
        Condition::Displacement(_) => 0.0,
    })
}

/// A quasi-static sequence at one row.
pub struct QuasiStaticSequence<'b> {
    pub problem: QuasiStaticProblem<'b>,
    search: WarmStartedSearch<'b>,
    /// Time between rows, s.
    interval: f64,
    /// Number of equilibria so far; the first is at the start.
    pub found: u64,
    /// The latest equilibrium.
    pub latest: Option<EquilibriumAt>,
    pub effort: Effort,
    /// Number of runs of each stage.
    pub ran: StageCounts,
}

/// Work of the equilibria.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Effort {
    /// Largest load residual of a race in its bore over its load.
    pub largest_residual: f64,
    /// Newton iterations, changes of the contact nodes.
    pub iterations: usize,
    pub contact_changes: usize,
}

/// Checkpoint, from which a sequence continues with the same bits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct QuasiStaticCheckpoint {
    /// s.
    pub time: f64,
    pub found: u64,
    pub effort: Effort,
    pub memory: SearchMemory,
}

impl<'b> QuasiStaticSequence<'b> {
    /// Before the first equilibrium; rows are `interval` (s) apart.
    pub fn new(problem: QuasiStaticProblem<'b>, interval: f64) -> QuasiStaticSequence<'b> {
        let search = WarmStartedSearch::of(&problem.seats);
        let effort = Effort::default();
        QuasiStaticSequence {
            problem,
            search,
            interval,
            found: 0,
            latest: None,
            effort,
            ran: StageCounts::default(),
        }
    }

    /// Time of the latest equilibrium, s.
    pub fn time(&self) -> f64 {
        self.found.saturating_sub(1) as f64 * self.interval
    }

    /// Solves for the next row.
    ///
    /// # Errors
    ///
    /// No equilibrium at its time.
    pub fn find_next(&mut self) -> Result<(), QuasiStaticError> {
        let time = self.found as f64 * self.interval;
        let moment = self.problem.find(&mut self.search, time)?;
        let effort = &mut self.effort;
        effort.largest_residual = effort.largest_residual.max(moment.residual);
        effort.iterations += moment.solution.iterations;
        effort.contact_changes += moment.contact_changes;
        self.ran.absorb(&moment.solution.ran);
        self.ran.whole.add(Stage::Equilibria, 1);
        self.latest = Some(moment);
        self.found += 1;
        Ok(())
    }

    pub fn checkpoint(&self) -> QuasiStaticCheckpoint {
        QuasiStaticCheckpoint {
            time: self.time(),
            found: self.found,
            effort: self.effort,
            memory: self.search.memory(),
        }
    }

    /// Continues from a checkpoint of the same sequence.
    ///
    /// # Errors
    ///
    /// See [`WarmStartedSearch::recall`].
    pub fn restore(&mut self, kept: &QuasiStaticCheckpoint) -> Result<(), BoreError> {
        (self.found, self.effort) = (kept.found, kept.effort);
        self.search.recall(&kept.memory)
    }

    /// Displacements of a housing in the latest equilibrium, m; empty without one.
    pub fn displacement(&self, seat: usize) -> Vec<Vec3> {
        let (Some(moment), Some(of)) = (&self.latest, self.problem.seats.get(seat)) else {
            return Vec::new();
        };
        of.bore.displacement(&moment.solution.seats[seat].loads)
    }
}
