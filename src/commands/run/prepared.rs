//! From a scene to what moves in its run: the one place that asks what the scene is of.

use crate::commands::housed::reduced::Reduced;
use crate::commands::plan::dynamic_plan_lines;
use crate::commands::{self, echo, echo_run, housed, solid};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::output::course::CourseParts;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::output::session::{Parts, RunRequest, Session, SolidParts};
use bearing_dynamics::output::state::{self, StateFile};
use bearing_dynamics::scene::dynamics::{dynamic_problem, run_options};
use bearing_dynamics::scene::housing::{HousedScene, HousingMethod};
use bearing_dynamics::scene::solid::SolidRun;
use bearing_dynamics::scene::solid_mesh::BuiltMesh;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::scene::{Document, RunPlot, RunSettings, Scene, SolidScene, Subject};
use bearing_dynamics::solver::channels::ChannelGroup;
use bearing_dynamics::solver::dynamics::assembly::Assembly;
use bearing_dynamics::solver::dynamics::foretell::{Choice, choose};
use bearing_dynamics::solver::dynamics::model::DynamicProblem;
use bearing_dynamics::solver::dynamics::run::{Integrator, RunOptions};
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

type Fallible<T> = Result<T, Box<dyn Error>>;

/// A scene ready to run.
pub(super) enum Prepared<'s> {
    Bearing {
        scene: &'s Scene,
        settings: RunSettings,
        problem: Box<DynamicProblem>,
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

/// Refuses a scene that gives no end.
pub(super) fn check_end(path: &Path, subject: &Subject) -> Fallible<()> {
    let ends = match subject {
        Subject::Bearing(scene) => run_options(scene).map(|_| ()).map_err(|e| e.to_string()),
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
            Subject::Bearing(scene) => Prepared::Bearing {
                settings: run_options(scene)?,
                problem: Box::new(dynamic_problem(scene)?),
                scene,
            },
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

    /// What moves.
    pub fn parts(&self, threads: usize) -> Fallible<Parts<'_>> {
        Ok(match self {
            Prepared::Bearing { problem, .. } => Parts::from(problem.assembly()),
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
                Parts::Housed(Box::new(housed::parts(scene, &mesh.setup, settings)?))
            }
        })
    }

    /// What the scene asks of the run, with the integrator that the plan chooses for a bearing.
    pub fn request(&self, kept: Option<&StateFile>) -> Fallible<(RunRequest, Option<Choice>)> {
        Ok(match self {
            Prepared::Bearing { scene, settings, problem } => {
                planned(request(scene, settings), settings, &problem.assembly(), kept)
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
            Prepared::Bearing { .. } => Vec::new(),
            Prepared::Solid { mesh, .. } => solid::mesh_notes(&mesh.built),
            Prepared::Housed { mesh, .. } => housed::notes(mesh),
        }
    }

    pub fn title(&self) -> String {
        match self {
            Prepared::Bearing { scene, .. } => {
                scene.title.clone().unwrap_or_else(|| "Bearing".into())
            }
            Prepared::Solid { scene, .. } => solid::title(scene),
            Prepared::Housed { scene, .. } => {
                scene.bearing.title.clone().unwrap_or_else(|| "Bearing".into())
            }
        }
    }

    /// The bearing of the scene, if it has one.
    pub fn bearing(&self) -> Option<&Scene> {
        match self {
            Prepared::Bearing { scene, .. } => Some(scene),
            Prepared::Housed { scene, .. } => Some(&scene.bearing),
            Prepared::Solid { .. } => None,
        }
    }

    /// Displacements of the solid, m; empty without one.
    pub fn displacement(&self, session: &Session) -> Vec<Vec3> {
        match self {
            Prepared::Housed { reduced: Some(reduced), .. } => {
                reduced.fields(&session.motion).map_or_else(Vec::new, |[of, _]| of)
            }
            _ => session.displacement(),
        }
    }

    /// The mesh of the scene, if it has one.
    pub fn built(&self) -> Option<&BuiltMesh> {
        match self {
            Prepared::Bearing { .. } => None,
            Prepared::Solid { mesh, .. } => Some(&mesh.built),
            Prepared::Housed { mesh, .. } => Some(&mesh.built),
        }
    }

    /// From when on means are taken, s.
    pub fn window_start(&self) -> f64 {
        match self {
            Prepared::Bearing { settings, .. } | Prepared::Housed { settings, .. } => {
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
            Prepared::Bearing { scene, problem, .. } => {
                let defaults = echo_run::defaults(scene);
                let plan = dynamic_plan_lines(scene, problem, request, choice);
                let assumptions = &scene.assumptions;
                let mut record =
                    commands::record(echo::scene(scene)?, plan, assumptions, &defaults, seconds);
                record.sections.push(("motion".into(), echo_run::motion(problem)?));
                Ok(record)
            }
            Prepared::Solid { scene, mesh, .. } => {
                solid::record(scene, solid::plan::lines(scene, mesh), seconds)
            }
            Prepared::Housed { scene, mesh, .. } => {
                housed::record(scene, housed::plan::lines(scene, mesh)?, seconds)
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
    scene: &Scene,
    settings: &RunSettings,
    problem: &DynamicProblem,
    kept: Option<&StateFile>,
) -> (RunRequest, Option<Choice>) {
    planned(request(scene, settings), settings, &problem.assembly(), kept)
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
