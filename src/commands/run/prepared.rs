//! Preparation of a run: meshes, condensed or reduced housings, and the parts that move.

use crate::commands::assembly::housing::Housing;
use crate::commands::assembly::lists::Lists;
use crate::commands::assembly::shapes::{Shapes, shapes};
use crate::commands::assembly::{self, housings, plan};
use crate::commands::echo::inertia;
use crate::commands::{rubber, solid};
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::motion::integrator_choice::{Choice, choose};
use bearing_dynamics::motion::simulation::{RunOptions, Start};
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::output::session::{
    Motion, Parts, RubberParts, RunRequest, SequenceParts, Session, SolidParts,
};
use bearing_dynamics::plan::Stage;
use bearing_dynamics::plan::channels::ChannelGroup;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::bushing::{BushingElements, take_bushings};
use bearing_dynamics::scene::build::cage::{BuiltCage, CageForm};
use bearing_dynamics::scene::build::motion::DynamicsError;
use bearing_dynamics::scene::build::shaft::{ShaftElements, take_shafts};
use bearing_dynamics::scene::resolve::housing_scene::HousingMethod;
use bearing_dynamics::scene::resolve::solid_scene::{Law, RubberScene, RunSteps, SolidRun};
use bearing_dynamics::scene::{Document, RunPlot, RunSettings, Scene, SolidScene, Subject};
use bearing_dynamics::solids::condensation::CondensedBore;
use bearing_dynamics::solids::explicit::{ExplicitMethod, SolidStepping};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::rubber::steps::Stepping;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

type Fallible<T> = Result<T, Box<dyn Error>>;

pub(super) enum Prepared<'s> {
    Bearings {
        lists: Box<Lists<'s>>,
        settings: RunSettings,
        /// With the reduced housings, without the springs of bushings and shafts in elements.
        assembly: Box<Assembly>,
        housings: Vec<Housing>,
        bushings: Vec<BushingElements>,
        shafts: Vec<ShaftElements>,
        cages: Vec<BuiltCage>,
        method: SolutionMethod,
    },
    Solid {
        scene: &'s SolidScene,
        settings: SolidRun,
        steps: (ExplicitMethod, SolidStepping),
        energy_limit: f64,
        mesh: Box<solid::Prepared>,
    },
    Rubber {
        scene: &'s SolidScene,
        rubber: &'s RubberScene,
        settings: SolidRun,
        stepping: Stepping,
        mesh: Box<rubber::Prepared>,
    },
}

pub(super) enum SolutionMethod {
    /// Steps in time, with rigid housings.
    Rigid,
    /// Coupled steps of the bearings and of housings, bushings or shafts in elements.
    Explicit,
    Reduced(Box<Shapes>),
    /// Quasi-static sequence, and the wall time of condensing, s.
    QuasiStaticSequence(Vec<CondensedBore>, f64),
}

#[derive(Clone, Copy)]
pub(super) struct SolidOf<'p> {
    /// `None` for a single solid.
    pub name: Option<&'p str>,
    pub mesh: &'p TetMesh,
    /// Model of a housing or shaft; a single solid has its model in the motion.
    pub model: Option<&'p SolidModel>,
    /// True if a race is mounted in its bore.
    pub has_bore: bool,
}

/// Displacement (m) and velocity (m/s) of each node.
pub(super) struct Fields {
    pub displacement: Vec<Vec3>,
    pub velocity: Option<Vec<Vec3>>,
}

/// Returns an error if the scene has no end time.
pub fn check_end(path: &Path, subject: &Subject) -> Fallible<()> {
    let (ends, bearing_alone) = match subject {
        Subject::Assembly(scene) => (scene.run().is_some(), scene.housing_method().is_none()),
        Subject::Solid(scene) => (scene.run.is_some(), false),
    };
    match (ends, bearing_alone) {
        (true, _) => Ok(()),
        (false, true) => Err(format!("{}: {}", path.display(), DynamicsError::NoEnd).into()),
        (false, false) => Err(format!("{}: {NO_END}", path.display()).into()),
    }
}

const NO_END: &str = "a run needs `end` in [numerics]";

impl<'s> Prepared<'s> {
    pub fn new(document: &Document, subject: &'s Subject) -> Fallible<Prepared<'s>> {
        let scene = match subject {
            Subject::Assembly(scene) => scene,
            Subject::Solid(scene) => {
                let settings = scene.run.ok_or(NO_END)?;
                return match (settings.steps, &scene.law) {
                    (RunSteps::Explicit { method, stepping, energy_limit }, _) => {
                        let mesh = Box::new(solid::prepare(document, scene)?);
                        let steps = (method, stepping);
                        Ok(Prepared::Solid { settings, steps, energy_limit, mesh, scene })
                    }
                    (RunSteps::Implicit(stepping), Law::Elastomer(rubber)) => {
                        let mesh = Box::new(rubber::prepare(document, scene, rubber)?);
                        rubber::refuse_free(Path::new(document.name()), &mesh.free)?;
                        Ok(Prepared::Rubber { settings, stepping, mesh, scene, rubber })
                    }
                    (RunSteps::Implicit(_), Law::LinearElastic { .. }) => Err(NO_END.into()),
                };
            }
        };
        let settings = scene.run().cloned().ok_or(NO_END)?;
        let housings = housings::prepare(document, scene)?;
        housings::refuse(document, scene, &housings)?;
        let lists = Box::new(Lists::of(scene));
        let in_elements = scene.has_parts_in_elements();
        let method = match scene.housing_method() {
            None if in_elements => SolutionMethod::Explicit,
            None => SolutionMethod::Rigid,
            Some(HousingMethod::Explicit) => SolutionMethod::Explicit,
            Some(HousingMethod::Reduced) => {
                SolutionMethod::Reduced(Box::new(shapes(&lists, &housings)?))
            }
            Some(HousingMethod::QuasiStatic) => {
                let start = Instant::now();
                let bores = housings::condensed(&housings)?;
                SolutionMethod::QuasiStaticSequence(bores, start.elapsed().as_secs_f64())
            }
        };
        let mut assembly = Box::new(match &method {
            SolutionMethod::Reduced(shapes) => shapes.assembly.clone(),
            _ => lists.assembly()?.clone(),
        });
        let cages = scene.add_cage_nodes(&mut assembly)?;
        let bushings = take_bushings(scene, &mut assembly)?;
        let shafts = take_shafts(scene, &mut assembly)?;
        Ok(Prepared::Bearings {
            lists,
            settings,
            assembly,
            housings,
            bushings,
            shafts,
            cages,
            method,
        })
    }

    pub fn parts(&self, threads: usize) -> Fallible<Parts<'_>> {
        Ok(match self {
            Prepared::Bearings {
                lists,
                assembly,
                housings,
                bushings,
                shafts,
                cages,
                method: SolutionMethod::Explicit,
                ..
            } => {
                let assembly = (**assembly).clone();
                let elements = (&bushings[..], &shafts[..], &cages[..]);
                let parts = housings::explicit(lists.scene, assembly, housings, elements, threads)?;
                Parts::Housed(Box::new(parts))
            }
            Prepared::Bearings {
                assembly,
                housings,
                method: SolutionMethod::QuasiStaticSequence(bores, _),
                ..
            } => {
                let problem = housings::quasi_static_problem((**assembly).clone(), housings, bores);
                let models = housings.iter().map(|housing| &housing.setup.model).collect();
                Parts::QuasiStaticSequence(Box::new(SequenceParts { problem, models }))
            }
            Prepared::Bearings { assembly, .. } => Parts::from((**assembly).clone()),
            Prepared::Solid { steps: (method, stepping), mesh, .. } => Parts::Solid(SolidParts {
                setup: &mesh.setup,
                method: *method,
                stepping: *stepping,
                threads,
            }),
            Prepared::Rubber { stepping, mesh, .. } => {
                Parts::Rubber(RubberParts { setup: &mesh.setup, stepping: *stepping })
            }
        })
    }

    /// Run request of the scene, with the integrator that the plan chooses for a bearing.
    pub fn request(&self) -> Fallible<(RunRequest, Option<Choice>)> {
        Ok(match self {
            Prepared::Bearings { lists, settings, assembly, method, .. } => {
                let mut request = request(lists.scene.common(), settings);
                match method {
                    SolutionMethod::Rigid => planned(request, settings, assembly),
                    SolutionMethod::Reduced(_) => {
                        // The assembly has the initial positions of races and housings.
                        request.options.start = Start::Equilibrium;
                        planned(request, settings, assembly)
                    }
                    SolutionMethod::Explicit | SolutionMethod::QuasiStaticSequence(..) => {
                        (request, None)
                    }
                }
            }
            Prepared::Solid { settings, .. } | Prepared::Rubber { settings, .. } => {
                let usual = RunOptions::default();
                let energy_limit = match self {
                    Prepared::Solid { energy_limit, .. } => *energy_limit,
                    _ => usual.energy_limit,
                };
                let request = RunRequest {
                    options: RunOptions { energy_limit, ..usual },
                    end: settings.end,
                    output_interval: settings.output_interval,
                    fields_interval: Some(settings.fields_interval),
                    channels: Vec::new(),
                };
                (request, None)
            }
        })
    }

    pub fn notes(&self) -> Vec<String> {
        match self {
            Prepared::Bearings { housings, .. } => {
                housings.iter().flat_map(Housing::notes).collect()
            }
            Prepared::Solid { mesh, .. } => solid::mesh_notes(&mesh.built),
            Prepared::Rubber { mesh, .. } => solid::mesh_notes(&mesh.built),
        }
    }

    pub fn title(&self) -> String {
        match self {
            Prepared::Bearings { lists, .. } => {
                lists.scene.common().title.clone().unwrap_or_else(|| "Bearing".into())
            }
            Prepared::Solid { scene, .. } | Prepared::Rubber { scene, .. } => solid::title(scene),
        }
    }

    /// Settings that all bearings of the scene share; `None` without bearings.
    pub fn bearing(&self) -> Option<&Scene> {
        match self {
            Prepared::Bearings { lists, .. } => Some(lists.scene.common()),
            Prepared::Solid { .. } | Prepared::Rubber { .. } => None,
        }
    }

    /// Displacements (m) and velocities (m/s) of a solid; `None` if there are none yet.
    pub fn fields(&self, session: &mut Session, solid: usize) -> Option<Fields> {
        if let Prepared::Bearings { method: SolutionMethod::Reduced(shapes), .. } = self
            && let Some([displacement, velocity]) = shapes.fields(&session.motion, solid)
        {
            return Some(Fields { displacement, velocity: Some(velocity) });
        }
        if let Prepared::Bearings { housings, shafts, cages, .. } = self
            && let Some(cage) = solid.checked_sub(housings.len() + shafts.len())
        {
            let reduced = cages.get(cage).and_then(|cage| cage_fields(cage, &session.motion));
            if reduced.is_some() {
                return reduced;
            }
        }
        let displacement = session.displacement(solid);
        let velocity = match &mut session.motion {
            Motion::Solid(moving) => Some(moving.solid.velocity()),
            Motion::Rubber(_) => None,
            // Between kicks the rates of a housing are at the time of the bearing.
            motion => motion
                .solids()
                .get(solid)
                .map(|solid| solid.rates().iter().map(|v| [v[0], v[1], v[2]]).collect()),
        };
        (!displacement.is_empty()).then_some(Fields { displacement, velocity })
    }

    /// Solids of the scene: a single solid, or housings and shafts.
    pub fn solids(&self) -> Vec<SolidOf<'_>> {
        fn of_housing(Housing { name, built, setup, .. }: &Housing) -> SolidOf<'_> {
            let (mesh, model) = (&built.mesh, Some(&setup.model));
            SolidOf { name: name.as_deref(), mesh, model, has_bore: true }
        }
        fn of_cage(BuiltCage { name, mesh, model, .. }: &BuiltCage) -> SolidOf<'_> {
            SolidOf { name: Some(name), mesh, model: Some(model), has_bore: false }
        }
        fn of_shaft(ShaftElements { name, mesh, part, .. }: &ShaftElements) -> SolidOf<'_> {
            SolidOf { name: Some(name), mesh, model: Some(&part.model), has_bore: false }
        }
        match self {
            Prepared::Bearings { housings, shafts, cages, .. } => {
                let is_flexible = |cage: &&BuiltCage| !matches!(cage.form, CageForm::Rigid);
                let flexible = cages.iter().filter(is_flexible);
                let all = housings.iter().map(of_housing).chain(shafts.iter().map(of_shaft));
                all.chain(flexible.map(of_cage)).collect()
            }
            Prepared::Solid { mesh, .. } => {
                vec![SolidOf { name: None, mesh: &mesh.built.mesh, model: None, has_bore: false }]
            }
            Prepared::Rubber { mesh, .. } => {
                vec![SolidOf { name: None, mesh: &mesh.built.mesh, model: None, has_bore: false }]
            }
        }
    }

    /// Start of the averaging window, s.
    pub fn window_start(&self) -> f64 {
        match self {
            Prepared::Bearings { settings, .. } => settings.window_start,
            Prepared::Solid { .. } | Prepared::Rubber { .. } => 0.0,
        }
    }

    pub fn has_spectra(&self) -> bool {
        match self {
            Prepared::Solid { scene, .. } | Prepared::Rubber { scene, .. } => scene.draw_spectrum,
            _ => self.bearing().is_some_and(|s| s.dynamics.plots.contains(&RunPlot::Spectrum)),
        }
    }

    /// Wall times of condensing and reducing, s.
    pub fn seconds(&self) -> Vec<(String, f64)> {
        match self {
            Prepared::Bearings {
                method: SolutionMethod::QuasiStaticSequence(_, condense), ..
            } => {
                vec![("condense".into(), *condense)]
            }
            Prepared::Bearings { method: SolutionMethod::Reduced(shapes), .. } => {
                let [condense, reduce] = shapes.seconds;
                vec![("condense".into(), condense), ("reduce".into(), reduce)]
            }
            _ => Vec::new(),
        }
    }

    pub fn record(
        &self,
        document: &Document,
        request: &RunRequest,
        choice: Option<&Choice>,
        seconds: Vec<(String, f64)>,
    ) -> Fallible<RunRecord> {
        match self {
            Prepared::Bearings {
                lists,
                settings,
                assembly,
                housings,
                bushings,
                shafts,
                cages,
                method,
                ..
            } => {
                let scene = lists.scene;
                let planned = match method {
                    SolutionMethod::QuasiStaticSequence(..) => {
                        plan::of_sequence(lists, housings, settings)?
                    }
                    _ => {
                        let elements = (&bushings[..], &shafts[..], &cages[..]);
                        plan::stages(scene, (housings, elements), assembly, request, choice)
                    }
                };
                let mut record = assembly::record(document, lists, planned, seconds);
                record.ran.whole.add(Stage::IntegratorChoice, u64::from(choice.is_some()));
                record.ran.solids = match method {
                    SolutionMethod::QuasiStaticSequence(bores, _) => {
                        bores.iter().map(|bore| bore.ran).collect()
                    }
                    SolutionMethod::Reduced(shapes) => shapes.ran.clone(),
                    SolutionMethod::Rigid | SolutionMethod::Explicit => Vec::new(),
                };
                record.sections.push(("body_inertia".into(), inertia(assembly)?));
                Ok(record)
            }
            Prepared::Solid { scene, mesh, .. } => {
                let plan = solid::plan::items(scene, mesh, solid::plan::Of::Run);
                Ok(solid::record(document, scene, plan, seconds))
            }
            Prepared::Rubber { scene, rubber, settings, mesh, .. } => {
                let plan = rubber::plan::items(scene, rubber, mesh, Some(settings));
                Ok(solid::record(document, scene, plan, seconds))
            }
        }
    }
}

pub fn request(scene: &Scene, settings: &RunSettings) -> RunRequest {
    let mut channels = settings.channels.clone();
    let plots = &scene.dynamics.plots;
    if plots.contains(&RunPlot::SlipSpin) {
        channels.extend([ChannelGroup::Slip, ChannelGroup::Orbits]);
    }
    if plots.contains(&RunPlot::RunUp) {
        channels.push(ChannelGroup::Races);
    }
    channels.sort();
    channels.dedup();
    RunRequest {
        options: settings.options,
        end: settings.end,
        output_interval: settings.output_interval,
        fields_interval: settings.fields_interval,
        channels,
    }
}

/// Deformation of a cage in its own axes, without its rigid motion.
fn cage_fields(cage: &BuiltCage, motion: &Motion) -> Option<Fields> {
    let CageForm::Reduced(reduction) = &cage.form else { return None };
    let simulation = motion.bearing()?;
    let system = &simulation.system;
    let nodes = system.assembly.bearings[cage.bearing].cage.as_ref()?.nodes.as_ref()?;
    let solid = &system.assembly.floating[nodes.floating];
    let modes = solid.split(system.deformed(&simulation.state, nodes.floating));
    let [displacement, velocity] = modes.map(|of| reduction.displacement(of));
    (!displacement.is_empty()).then_some(Fields { displacement, velocity: Some(velocity) })
}

/// [`request`] with the integrator that the plan chooses, if the scene gives none.
pub fn planned_request(
    scene: &AssemblyScene,
    settings: &RunSettings,
    assembly: &Assembly,
) -> (RunRequest, Option<Choice>) {
    planned(request(scene.common(), settings), settings, assembly)
}

fn planned(
    mut request: RunRequest,
    settings: &RunSettings,
    assembly: &Assembly,
) -> (RunRequest, Option<Choice>) {
    if !settings.by_plan {
        return (request, None);
    }
    let choice = choose(assembly);
    request.options.integrator = choice.integrator;
    (request, Some(choice))
}
