//! From a shipped scene of a shaft in housings, with words changed, to its equilibrium and what a session moves in each of three ways.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::equilibrium::initial::static_assembly;
use bearing_dynamics::equilibrium::lists::StaticAssembly;
use bearing_dynamics::equilibrium::quasi_static_sequence::{QuasiStaticFit, QuasiStaticProblem};
use bearing_dynamics::equilibrium::statics::{AssemblySolution, StaticOptions, solve_assembly};
use bearing_dynamics::equilibrium::warm_started_search::WarmStartedSearch;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::motion::coupling::{CouplingOptions, SolidPart};
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::motion::reduced_start::{Housing as Start0, add_housing, put_in_equilibrium};
use bearing_dynamics::motion::simulation::{RunOptions, Start};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{HousedParts, Parts, RunRequest, SequenceParts};
use bearing_dynamics::reduction::component_modes::{LEFT_OUT, ReduceOptions, reduce};
use bearing_dynamics::reduction::load_patterns::{LargestLoads, pressed};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::housing::{HousingSetup, setup};
use bearing_dynamics::scene::build::shaft::take_shafts;
use bearing_dynamics::scene::build::solid_mesh::build_housing;
use bearing_dynamics::scene::resolve::housing_scene::HousedScene;
use bearing_dynamics::solids::condensation::{CondensedBore, condense};

use crate::case::CaseError;
use crate::motion;

/// Natural shapes of the housings up to this, Hz, unless their scene says other, and the force that shapes are made for, N.
const MODES_TO: f64 = 70e3;
const FORCE: f64 = 1300.0;

/// A housing, meshed.
pub struct Housing {
    pub scene: HousedScene,
    pub setup: HousingSetup,
}

pub struct Shaft {
    pub scene: AssemblyScene,
    pub housings: Vec<Housing>,
}

impl Shaft {
    /// A shipped scene with these words changed.
    pub fn new(shipped: &str, changes: &[(&str, &str)]) -> Result<Shaft, CaseError> {
        let scene = motion::changed_scene(shipped, changes)?;
        let mut housings = Vec::new();
        for scene in scene.bearings.iter().filter_map(|placed| placed.housed()) {
            let built = build_housing(&scene)?;
            housings.push(Housing { setup: setup(&scene, &built)?, scene });
        }
        Ok(Shaft { scene, housings })
    }

    pub fn bores(&self) -> Result<Vec<CondensedBore>, CaseError> {
        let condensed = |Housing { setup, .. }: &Housing| {
            Ok(condense(&setup.model, &setup.nodes, &setup.reach())?)
        };
        self.housings.iter().map(condensed).collect()
    }

    fn name(&self, bearing: usize) -> Option<String> {
        self.scene.bearings[bearing].name.clone()
    }

    pub fn course<'b>(
        &self,
        bores: &'b [CondensedBore],
    ) -> Result<QuasiStaticProblem<'b>, CaseError> {
        let seat = |(bearing, (of, bore)): (usize, (&Housing, &'b CondensedBore))| QuasiStaticFit {
            name: self.name(bearing),
            bearing,
            bore,
            penalty: of.scene.housing.penalty,
            axial: of.scene.housing.axial,
            radius: of.setup.radius(&of.scene),
            damping: of.setup.solid.problem.damping,
        };
        let seats = self.housings.iter().zip(bores).enumerate().map(seat).collect();
        Ok(QuasiStaticProblem { assembly: self.scene.assembly()?, seats })
    }

    /// Everything at rest under the loads at t = 0, races grown into their fits.
    pub fn statics(
        &self,
        bores: &[CondensedBore],
    ) -> Result<(StaticAssembly<'static>, AssemblySolution), CaseError> {
        let course = self.course(bores)?;
        let still = self.scene.statics()?;
        let mut lists: StaticAssembly = still.clone();
        for (of, mut seat) in self.housings.iter().zip(course.seats.clone()) {
            seat.radius = Profile::Constant(of.setup.fit(&of.scene).radius);
            seat.add_to(&mut lists, 0.0);
        }
        let found = WarmStartedSearch::of(&course.seats).solve(&lists)?;
        Ok((still, found))
    }

    pub fn quasi_static<'b>(&'b self, bores: &'b [CondensedBore]) -> Result<Parts<'b>, CaseError> {
        let models = self.housings.iter().map(|housing| &housing.setup.model).collect();
        Ok(Parts::QuasiStaticSequence(Box::new(SequenceParts {
            problem: self.course(bores)?,
            models,
        })))
    }

    pub fn reduced(&self) -> Result<Parts<'static>, CaseError> {
        let mut assembly = self.scene.assembly()?;
        let mut bores = self.bores()?;
        let rest = self.rest(&assembly, &bores)?;
        let mut reductions = Vec::new();
        for (bearing, (Housing { scene, setup }, bore)) in
            self.housings.iter().zip(&bores).enumerate()
        {
            let penalty = scene.housing.penalty;
            let loads = pressed(
                bore,
                penalty,
                &setup.fit(scene),
                &LargestLoads { force: FORCE, moment: 0.0, start: Some(&rest.seats[bearing]) },
            )?;
            let modes_to = scene.housing.modes_to.unwrap_or(MODES_TO);
            let options = ReduceOptions { modes_to, left_out: LEFT_OUT };
            let reduction = reduce(&setup.model, bore, penalty, &loads, &options)?;
            let body = assembly.bearings[bearing].mounts[1].body;
            add_housing(&mut assembly, body, &reduction, bore, setup.radius(scene), penalty);
            if let Some(seat) = assembly.seats.last_mut() {
                seat.label = self.name(bearing);
            }
            reductions.push(reduction);
        }
        let parts = self.housings.iter().zip(&reductions).zip(bores.iter_mut());
        let start = |((of, reduction), bore): ((&Housing, _), _)| Start0 {
            reduction,
            bore,
            fit: of.setup.fit(&of.scene),
            penalty: of.scene.housing.penalty,
        };
        put_in_equilibrium(&mut assembly, &mut parts.map(start).collect::<Vec<_>>())?;
        Ok(Parts::Bearing(Box::new(assembly)))
    }

    /// Of all under the loads at t = 0.
    fn rest(
        &self,
        assembly: &Assembly,
        bores: &[CondensedBore],
    ) -> Result<AssemblySolution, CaseError> {
        let mut still = static_assembly(assembly, 0.0, &[]);
        self.course(bores)?.seats.iter().for_each(|seat| seat.add_to(&mut still, 0.0));
        Ok(solve_assembly(&still, None, &StaticOptions::default())?)
    }

    /// From the equilibrium of all.
    pub fn explicit(&self, threads: usize) -> Result<HousedParts<'static>, CaseError> {
        let mut assembly: Assembly = self.scene.assembly()?;
        let bores = self.bores()?;
        let course = self.course(&bores)?;
        let found = self.rest(&assembly, &bores)?;
        let mut displacements = Vec::new();
        for (of, state) in course.seats.iter().zip(&found.seats) {
            let body = of.body(&assembly);
            assembly.bodies[body].rest = found.coordinates[body].into();
            displacements.push(of.bore.displacement(&state.loads));
        }
        self.parts(assembly, displacements, threads)
    }

    /// From undeformed housings, races in their first places.
    pub fn undeformed(&self, threads: usize) -> Result<HousedParts<'static>, CaseError> {
        self.parts(self.scene.assembly()?, Vec::new(), threads)
    }

    fn parts(
        &self,
        mut assembly: Assembly,
        displacements: Vec<Vec<Vec3>>,
        threads: usize,
    ) -> Result<HousedParts<'static>, CaseError> {
        let mut displacements = displacements.into_iter();
        let (mut solids, mut seats) = (Vec::new(), Vec::new());
        for (index, Housing { scene, setup }) in self.housings.iter().enumerate() {
            let name = self.name(index);
            solids.push(match displacements.next() {
                Some(displacement) => {
                    SolidPart::displaced(name.clone(), setup.model.clone(), displacement)
                }
                None => SolidPart::undeformed(name.clone(), setup.model.clone()),
            });
            seats.push(Seat {
                name,
                mount: Mount::at_centre(assembly.bearings[index].mounts[1].body),
                solid: index,
                radius: setup.radius(scene),
                width: setup.width,
                penalty: scene.housing.penalty,
                friction: scene.housing.friction,
                nodes: setup.nodes.clone(),
                reach: f64::INFINITY,
            });
        }
        let shafts = take_shafts(&self.scene, &mut assembly)?;
        solids.extend(shafts.into_iter().map(|shaft| shaft.part));
        let run = self.scene.run().ok_or_else(|| CaseError::message("no end"))?;
        let options = CouplingOptions {
            solid_fraction: 0.8,
            seat_phase: 0.25,
            bearing: RunOptions { energy_limit: f64::INFINITY, ..run.options },
        };
        Ok(HousedParts { assembly, solids, seats, bushings: Vec::new(), options, threads })
    }

    pub fn request(&self) -> Result<RunRequest, CaseError> {
        let asked = motion::request(&self.scene)?;
        Ok(RunRequest {
            options: RunOptions { start: Start::Equilibrium, ..asked.options },
            ..asked
        })
    }
}
