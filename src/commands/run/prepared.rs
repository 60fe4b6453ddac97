//! From a scene to what moves in its run: the one place that asks what the scene is of.

use crate::commands::assembly::housings::{self, Housing, Reduced as Reductions};
use crate::commands::housed::reduced::Reduced;
use crate::commands::plan::dynamic_items;
use crate::commands::{self, housed, solid};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::output::course::CourseParts;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::output::session::{Motion, Parts, RunRequest, Session, SolidParts};
use bearing_dynamics::output::state::{self, StateFile};
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::dynamics::{DynamicsError, run_options};
use bearing_dynamics::scene::housing::{HousedScene, HousingMethod};
use bearing_dynamics::scene::solid::SolidRun;
use bearing_dynamics::scene::solid_mesh::BuiltMesh;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::scene::{Document, RunPlot, RunSettings, Scene, SolidScene, Subject};
use bearing_dynamics::solver::channels::ChannelGroup;
use bearing_dynamics::solver::dynamics::assembly::Assembly;
use bearing_dynamics::solver::dynamics::foretell::{Choice, choose};
use bearing_dynamics::solver::dynamics::run::{Integrator, RunOptions, Start};
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::plan::Stage;
use bearing_dynamics::solver::solid::model::SolidModel;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

type Fallible<T> = Result<T, Box<dyn Error>>;

/// A scene ready to run.
pub(super) enum Prepared<'s> {
    Bearings {
        scene: Box<AssemblyScene>,
        settings: RunSettings,
        /// With the housings that are reduced.
        assembly: Box<Assembly>,
        housings: Vec<Housing>,
        reduced: Option<Box<Reductions>>,
    },
    Solid {
        scene: &'s SolidScene,
        settings: SolidRun,
        mesh: Box<solid::Prepared>,
    },
    Housed {
        scene: &'s HousedScene,
        settings: RunSettings,
        mesh: Box<housed::Prepared>,
        /// Of equilibria, and the wall time that condensing took, s.
        bore: Option<(Box<CondensedBore>, f64)>,
        /// Of a housing in shapes.
        reduced: Option<Box<Reduced>>,
    },
}

/// A solid of a scene and its mesh.
#[derive(Clone, Copy)]
pub(super) struct SolidOf<'p> {
    /// `None` for the only one.
    pub name: Option<&'p str>,
    pub built: &'p BuiltMesh,
    /// Of a housing; that of a solid by itself is in the motion.
    pub model: Option<&'p SolidModel>,
}

/// What fields are made of, a vector a node.
pub(super) struct Fields {
    pub displacement: Vec<Vec3>,
    pub velocity: Option<Vec<Vec3>>,
}

pub const ONE_AFTER_THE_OTHER: &str = "several bearings do not run through equilibria one after the other; \
    `bearing statics` and `sweep` give their equilibria, and they run with method = \"reduced\" or \"explicit\" in [housing]";

/// Refuses a scene that gives no end.
pub(super) fn check_end(path: &Path, subject: &Subject) -> Fallible<()> {
    let ends = match subject {
        Subject::Bearing(scene) => run_options(scene).map(|_| ()).map_err(|e| e.to_string()),
        Subject::Assembly(scene) => {
            scene.run().map(|_| ()).ok_or_else(|| DynamicsError::NoEnd.to_string())
        }
        Subject::Solid(scene) => {
            scene.run.map(|_| ()).ok_or("a run needs `end` in [numerics]".into())
        }
        Subject::Housed(scene) => {
            let run = scene.bearing.dynamics.run.as_ref();
            run.map(|_| ()).ok_or("a run needs `end` in [numerics]".into())
        }
    };
    Ok(ends.map_err(|error| format!("{}: {error}", path.display()))?)
}

impl<'s> Prepared<'s> {
    /// Reads meshes, and condenses a housing that equilibria are to be found in.
    pub fn new(document: &Document, subject: &'s Subject) -> Fallible<Prepared<'s>> {
        const NO_END: &str = "a run needs `end` in [numerics]";
        Ok(match subject {
            Subject::Bearing(scene) => {
                Prepared::bearings(AssemblyScene::alone((**scene).clone()), Vec::new())?
            }
            Subject::Assembly(scene) => {
                Prepared::bearings((**scene).clone(), housings::prepare(document, scene)?)?
            }
            Subject::Solid(scene) => Prepared::Solid {
                settings: scene.run.ok_or(NO_END)?,
                mesh: Box::new(solid::prepare(document, scene)?),
                scene,
            },
            Subject::Housed(scene) => {
                let settings = scene.bearing.dynamics.run.clone().ok_or(NO_END)?;
                let mesh = housed::prepare(document, scene)?;
                let (mut bore, mut reduced) = (None, None);
                match scene.housing.method {
                    HousingMethod::Explicit => {}
                    HousingMethod::QuasiStatic => {
                        housed::refuse_moving(document, scene)?;
                        let start = Instant::now();
                        let condensed = Box::new(housed::condensed(&mesh)?);
                        bore = Some((condensed, start.elapsed().as_secs_f64()));
                    }
                    HousingMethod::Reduced => {
                        housed::refuse_moved_supports(document, scene)?;
                        reduced = Some(Box::new(housed::reduced::reduced(scene, &mesh)?));
                    }
                }
                Prepared::Housed { settings, mesh: Box::new(mesh), bore, reduced, scene }
            }
        })
    }

    fn bearings(scene: AssemblyScene, housings: Vec<Housing>) -> Fallible<Prepared<'s>> {
        let settings = scene.run().cloned().ok_or(DynamicsError::NoEnd)?;
        let (assembly, reduced) = match scene.housing_method() {
            None | Some(HousingMethod::Explicit) => (scene.assembly()?, None),
            Some(HousingMethod::Reduced) => {
                let reduced = housings::reduced(&scene, &housings)?;
                (reduced.assembly.clone(), Some(Box::new(reduced)))
            }
            Some(HousingMethod::QuasiStatic) => return Err(ONE_AFTER_THE_OTHER.into()),
        };
        let (scene, assembly) = (Box::new(scene), Box::new(assembly));
        Ok(Prepared::Bearings { scene, settings, assembly, housings, reduced })
    }

    /// What moves.
    pub fn parts(&self, threads: usize) -> Fallible<Parts<'_>> {
        Ok(match self {
            Prepared::Bearings { scene, housings, reduced: None, .. } if !housings.is_empty() => {
                Parts::Housed(Box::new(housings::explicit(scene, housings, threads)?))
            }
            Prepared::Bearings { assembly, .. } => Parts::from((**assembly).clone()),
            Prepared::Solid { settings, mesh, .. } => Parts::Solid(SolidParts {
                setup: &mesh.setup,
                method: settings.method,
                stepping: settings.stepping,
                threads,
            }),
            Prepared::Housed { scene, mesh, bore: Some((bore, _)), .. } => {
                let problem = static_problem(&scene.bearing)?;
                Parts::Course(Box::new(CourseParts { scene, setup: &mesh.setup, bore, problem }))
            }
            Prepared::Housed { reduced: Some(reduced), .. } => {
                Parts::Bearing(Box::new(reduced.assembly.clone()))
            }
            Prepared::Housed { scene, settings, mesh, .. } => {
                Parts::Housed(Box::new(housed::parts(scene, mesh, settings, threads)?))
            }
        })
    }

    /// What the scene asks of the run, with the integrator that the plan chooses for a bearing.
    pub fn request(&self, kept: Option<&StateFile>) -> Fallible<(RunRequest, Option<Choice>)> {
        Ok(match self {
            Prepared::Bearings { scene, settings, housings, reduced: None, .. }
                if !housings.is_empty() =>
            {
                let mut request = request(scene.common(), settings);
                request.fields_interval = housings[0].scene.housing.fields_interval;
                (request, None)
            }
            Prepared::Bearings { scene, settings, assembly, housings, .. } => {
                let (mut request, choice) = planned_request(scene, settings, assembly, kept);
                if let Some(first) = housings.first() {
                    request.fields_interval = first.scene.housing.fields_interval;
                    // Where races and housings start is in the assembly.
                    request.options.start = Start::Equilibrium;
                }
                (request, choice)
            }
            Prepared::Housed { scene, settings, reduced: Some(reduced), .. } => {
                let request = housed::request(scene, settings);
                planned(request, settings, &reduced.assembly, kept)
            }
            Prepared::Solid { settings, .. } => {
                let request = RunRequest {
                    options: RunOptions {
                        energy_limit: settings.energy_limit,
                        ..RunOptions::default()
                    },
                    end: settings.end,
                    output_interval: settings.output_interval,
                    fields_interval: Some(settings.fields_interval),
                    channels: Vec::new(),
                };
                (request, None)
            }
            Prepared::Housed { scene, settings, .. } => (housed::request(scene, settings), None),
        })
    }

    /// What a person should know of mesh and bore before results.
    pub fn notes(&self) -> Vec<String> {
        match self {
            Prepared::Bearings { housings, .. } => {
                let said = |housing: &Housing| {
                    let name =
                        housing.name.clone().map_or(String::new(), |name| format!("{name}: "));
                    let notes = housed::notes(&housing.mesh).into_iter();
                    notes.map(|note| format!("{name}{note}")).collect::<Vec<_>>()
                };
                housings.iter().flat_map(said).collect()
            }
            Prepared::Solid { mesh, .. } => solid::mesh_notes(&mesh.built),
            Prepared::Housed { mesh, .. } => housed::notes(mesh),
        }
    }

    pub fn title(&self) -> String {
        match self {
            Prepared::Bearings { scene, .. } => {
                scene.common().title.clone().unwrap_or_else(|| "Bearing".into())
            }
            Prepared::Solid { scene, .. } => solid::title(scene),
            Prepared::Housed { scene, .. } => {
                scene.bearing.title.clone().unwrap_or_else(|| "Bearing".into())
            }
        }
    }

    /// What all bearings of the scene share, if it has any.
    pub fn bearing(&self) -> Option<&Scene> {
        match self {
            Prepared::Bearings { scene, .. } => Some(scene.common()),
            Prepared::Housed { scene, .. } => Some(&scene.bearing),
            Prepared::Solid { .. } => None,
        }
    }

    /// Displacements (m) and velocities (m/s) of a solid; `None` where there is nothing yet.
    pub fn fields(&self, session: &mut Session, solid: usize) -> Option<Fields> {
        let by_shapes = match self {
            Prepared::Housed { reduced: Some(reduced), .. } => reduced.fields(&session.motion),
            Prepared::Bearings { reduced: Some(reduced), .. } => {
                housings::fields(reduced, &session.motion, solid)
            }
            _ => None,
        };
        if let Some([displacement, velocity]) = by_shapes {
            return Some(Fields { displacement, velocity: Some(velocity) });
        }
        let displacement = session.displacement(solid);
        let velocity = match &mut session.motion {
            Motion::Solid(moving) => Some(moving.solid.velocity()),
            // Between kicks the rates of a housing are those of the bearing's time.
            motion => motion
                .solids()
                .get(solid)
                .map(|solid| solid.rates().iter().map(|v| [v[0], v[1], v[2]]).collect()),
        };
        (!displacement.is_empty()).then_some(Fields { displacement, velocity })
    }

    /// The solids of the scene: by themselves, or housings.
    pub fn solids(&self) -> Vec<SolidOf<'_>> {
        match self {
            Prepared::Bearings { housings, .. } => housings
                .iter()
                .map(|Housing { name, mesh, .. }| SolidOf {
                    name: name.as_deref(),
                    built: &mesh.built,
                    model: Some(&mesh.setup.model),
                })
                .collect(),
            Prepared::Solid { mesh, .. } => {
                vec![SolidOf { name: None, built: &mesh.built, model: None }]
            }
            Prepared::Housed { mesh, .. } => {
                let model = Some(&mesh.setup.model);
                vec![SolidOf { name: None, built: &mesh.built, model }]
            }
        }
    }

    /// From when on means are taken, s.
    pub fn window_start(&self) -> f64 {
        match self {
            Prepared::Bearings { settings, .. } | Prepared::Housed { settings, .. } => {
                settings.window_start
            }
            Prepared::Solid { .. } => 0.0,
        }
    }

    /// Whether spectra are asked for.
    pub fn has_spectra(&self) -> bool {
        match self {
            Prepared::Solid { scene, .. } => scene.draw_spectrum,
            _ => self.bearing().is_some_and(|s| s.dynamics.plots.contains(&RunPlot::Spectrum)),
        }
    }

    /// Scene, plan, assumptions and defaults, as every summary has them.
    pub fn record(
        &self,
        request: &RunRequest,
        choice: Option<&Choice>,
        seconds: Vec<(String, f64)>,
    ) -> Fallible<RunRecord> {
        match self {
            Prepared::Bearings { scene, assembly, housings, reduced, .. } => {
                let defaults = commands::assembly::defaults(scene);
                let solids = housings::items(scene, housings, assembly);
                let plan = dynamic_items(scene, assembly, request, choice, solids);
                let assumptions = &scene.common().assumptions;
                let echo = commands::assembly::echo(scene)?;
                let mut record = commands::record(echo, plan, assumptions, &defaults, seconds);
                record.sections.push(("motion".into(), commands::assembly::motion(scene)?));
                record.ran.whole.add(Stage::IntegratorChoice, u64::from(choice.is_some()));
                record.ran.solids = reduced.as_ref().map_or(Vec::new(), |of| of.ran.clone());
                Ok(record)
            }
            Prepared::Solid { scene, mesh, .. } => {
                let plan = solid::plan::items(scene, mesh, solid::plan::Of::Run);
                solid::record(scene, plan, seconds)
            }
            Prepared::Housed { scene, mesh, bore, reduced, .. } => {
                let assembly = reduced.as_ref().map(|reduced| &reduced.assembly);
                let plan = housed::plan::items(scene, mesh, assembly)?;
                let mut record = housed::record(scene, plan, seconds)?;
                let condensing = bore.as_ref().map(|(bore, _)| bore.ran);
                let reducing = reduced.as_ref().map(|reduced| reduced.ran);
                record.ran.solids = condensing.or(reducing).into_iter().collect();
                Ok(record)
            }
        }
    }
}

/// What the scene asks of the run of its bearing.
pub fn request(scene: &Scene, settings: &RunSettings) -> RunRequest {
    let mut channels = settings.channels.clone();
    let plots = &scene.dynamics.plots;
    if plots.contains(&RunPlot::SlipSpin) {
        channels.extend([ChannelGroup::Slip, ChannelGroup::Orbits]);
    }
    channels.sort();
    channels.dedup();
    RunRequest {
        options: settings.options,
        end: settings.end,
        output_interval: settings.output_interval,
        fields_interval: None,
        channels,
    }
}

/// The same with the integrator that the plan chooses, where the scene leaves it to the plan.
pub fn planned_request(
    scene: &AssemblyScene,
    settings: &RunSettings,
    assembly: &Assembly,
    kept: Option<&StateFile>,
) -> (RunRequest, Option<Choice>) {
    planned(request(scene.common(), settings), settings, assembly, kept)
}

/// A run that goes on does so as it began: a later end may let another integrator look better.
fn planned(
    mut request: RunRequest,
    settings: &RunSettings,
    assembly: &Assembly,
    kept: Option<&StateFile>,
) -> (RunRequest, Option<Choice>) {
    if !settings.by_plan {
        return (request, None);
    }
    for integrator in [Integrator::Rosenbrock, Integrator::DormandPrince] {
        request.options.integrator = integrator;
        let same = |file: &StateFile| {
            file.fingerprint == state::fingerprint(&assembly.clone().into(), &request)
        };
        if kept.is_some_and(same) {
            return (request, Some(Choice::kept(assembly, integrator)));
        }
    }
    let choice = choose(assembly, &request);
    request.options.integrator = choice.integrator;
    (request, Some(choice))
}
