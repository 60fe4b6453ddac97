//! From a bearing in a housing and the housing's mesh to what the solver takes, and what drives it.

use crate::ch2_housing::bore_contact::{ContactNode, Frame, contact_nodes};
use crate::kinematics::{Pose, euler};
use crate::scene::about::About;
use crate::scene::housing::{FitSize, HousedScene};
use crate::scene::solid::{LoadKind, SetLoad};
use crate::scene::solid_mesh::BuiltMesh;
use crate::scene::solid_problem::{SolidSetup, SolidSetupError, setup as solid_setup};
use crate::scene::statics::kinematic_ratios;
use crate::solver::dynamics::model::{Drive, Rotation};
use crate::solver::housing::bore_equilibrium::Fit;
use crate::solver::housing::condensed::Reach;
use crate::solver::profile::Profile;
use crate::solver::solid::model::{SolidError, SolidModel};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use thiserror::Error;

/// Part of the width by which a seat is wider than the race, as in a condensed housing: a node on the
/// rim stays under the race when the bore swells along its axis by some nanometres.
const RIM: f64 = 2e-3;
/// Part of the race's radius by which the bore may differ from it, and be out of round or centre.
const FAR_OFF: f64 = 0.05;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum HousingSetupError {
    #[error(transparent)]
    Solid(#[from] SolidSetupError),
    #[error(transparent)]
    Model(#[from] SolidError),
    #[error(
        "housing.bore: the solid has no surface called \"{bore}\"; its surfaces are: {}. Hint: a ring's \
         bore is called \"inner\"",
        list(known)
    )]
    NoBore { bore: String, known: Vec<String> },
    #[error(
        "housing.width: none of the {count} nodes of the bore lies under the outer race, which is \
         {:.4} mm wide about x = {:.4} mm. Hint: check width, position and the mesh's unit",
        1e3 * *.width, 1e3 * *.centre
    )]
    BesideTheRace { count: usize, width: f64, centre: f64 },
    #[error(
        "housing.bore: the bore has a radius of {:.4} mm, the outer race one of about {:.4} mm. Hint: was \
         the mesh's unit (solid.mesh.unit) mm or m? Is \"{bore}\" the right surface?",
        1e3 * *.radius, 1e3 * *.race
    )]
    FarFromTheRace { bore: String, radius: f64, race: f64 },
    #[error(
        "housing.bore: nodes of \"{bore}\" are {:.4} to {:.4} mm from the bearing's axis, X through its \
         centre: no bore about it. Hint: move the mesh, or check the name of the surface",
        1e3 * *.nearest, 1e3 * *.farthest
    )]
    NotRound { bore: String, nearest: f64, farthest: f64 },
    #[error("housing: the fit leaves the outer race {:.1} um larger than the bore, more than {:.1} um",
        1e6 * *.interference, 1e6 * *.limit)]
    FitTooLarge { interference: f64, limit: f64 },
    #[error(
        "solid.load: the condensed housing of `quasi-static` takes constant loads; write method = \
         \"explicit\" in [housing]"
    )]
    VaryingLoad { index: usize },
    #[error(
        "solid.held.{axis}: the condensed housing of `quasi-static` is held at zero; write \
         {axis} = true, or method = \"explicit\" in [housing]"
    )]
    MovedSupport { index: usize, axis: &'static str },
}

impl HousingSetupError {
    /// Part of the scene that it is about; of a model that cannot be set up none.
    pub fn about(&self) -> Option<About> {
        Some(match self {
            HousingSetupError::Solid(error) => error.about(),
            HousingSetupError::Model(_) => return None,
            HousingSetupError::NoBore { .. }
            | HousingSetupError::FarFromTheRace { .. }
            | HousingSetupError::NotRound { .. } => About::key("housing.bore"),
            HousingSetupError::BesideTheRace { .. } => About::key("housing.width"),
            HousingSetupError::FitTooLarge { .. } => About::key("housing.outer_radius"),
            HousingSetupError::VaryingLoad { index } => {
                About::Item { table: "solid.load", index: *index, key: "set" }
            }
            HousingSetupError::MovedSupport { index, axis: key } => {
                About::Item { table: "solid.held", index: *index, key }
            }
        })
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}

/// A housing ready for its bearing.
#[derive(Clone, Debug)]
pub struct HousingSetup {
    pub solid: SolidSetup,
    pub model: SolidModel,
    /// Nodes of the bore that carry a part of its surface.
    pub nodes: Vec<ContactNode>,
    /// Mean distance from the axis of those under the race, m.
    pub bore_radius: f64,
    /// Radial, m; negative is clearance.
    pub interference: f64,
    /// Of the outer race, m.
    pub width: f64,
    /// Outer race where its motion is measured from.
    pub nominal: Pose,
}

/// # Errors
/// A set that is not there, a bore that is not about the race, a model that cannot be set up.
pub fn setup(scene: &HousedScene, built: &BuiltMesh) -> Result<HousingSetup, HousingSetupError> {
    let mesh = &built.mesh;
    let solid = solid_setup(&scene.solid, built)?;
    let bore = scene.housing.bore.clone();
    let faces = mesh.surface_sets.get(&bore).ok_or_else(|| HousingSetupError::NoBore {
        bore: bore.clone(),
        known: mesh.surface_sets.keys().cloned().collect(),
    })?;
    let nodes = contact_nodes(mesh, faces);
    let [x, y, z, tilt_y, tilt_z] = scene.bearing.outer_race;
    let nominal = Pose {
        position: Vector3::new(x, y, z),
        orientation: euler::quaternion(0.0, tilt_y, tilt_z),
    };
    let frame = Frame::new(&nominal);
    let seen: Vec<[f64; 3]> = nodes.iter().map(|node| frame.seen(node.place)).collect();
    let ends = seen.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
        [low.min(place[0]), high.max(place[0])]
    });
    let width = scene.housing.width.unwrap_or(ends[1] - ends[0]);
    let under = seen.iter().filter(|place| place[0].abs() <= 0.5 * width * (1.0 + RIM));
    let distances: Vec<f64> = under.map(|p| (p[1] * p[1] + p[2] * p[2]).sqrt()).collect();
    if distances.is_empty() {
        return Err(HousingSetupError::BesideTheRace { count: nodes.len(), width, centre: x });
    }
    let radius = distances.iter().sum::<f64>() / distances.len() as f64;
    let sizes = &scene.bearing.dimensions;
    let given = match scene.housing.fit {
        FitSize::OuterRadius(radius) => Some(radius),
        FitSize::Interference(_) => sizes.outer_radius,
    };
    let groove = sizes.outer_race.radius;
    let race = given.unwrap_or(1.1 * groove);
    let near = match given {
        Some(given) => (radius - given).abs() <= FAR_OFF * given,
        // Any wall behind the groove.
        None => radius > groove && radius < 2.0 * groove,
    };
    if !near {
        return Err(HousingSetupError::FarFromTheRace { bore, radius, race });
    }
    let farthest = distances.iter().copied().fold(0.0, f64::max);
    let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
    // Written as it is so that a place that is not a number is refused as well.
    let round = farthest - nearest <= FAR_OFF * radius;
    if !round {
        return Err(HousingSetupError::NotRound { bore, nearest, farthest });
    }
    let interference = match scene.housing.fit {
        FitSize::Interference(interference) => interference,
        FitSize::OuterRadius(race) => race - radius,
    };
    let limit = 0.01 * radius;
    let fits = interference <= limit;
    if !fits {
        return Err(HousingSetupError::FitTooLarge { interference, limit });
    }
    let model = SolidModel::labelled(solid.problem.clone(), solid.labels.clone())?;
    Ok(HousingSetup { solid, model, nodes, bore_radius: radius, interference, width, nominal })
}

impl HousingSetup {
    /// Radius of the outer race over time, m: an interference grows in.
    pub fn radius(&self, scene: &HousedScene) -> Profile {
        let grown = self.bore_radius + self.interference;
        match scene.housing.fit_ramp {
            Some(duration) if self.interference > 0.0 => {
                Profile::SmoothRamp { from: self.bore_radius, to: grown, start: 0.0, duration }
            }
            _ => Profile::Constant(grown),
        }
    }

    /// The seat's width in which nodes are tested, m.
    pub fn seat_width(&self) -> f64 {
        self.width * (1.0 + RIM)
    }

    /// Nodes a condensed housing keeps: all under the race.
    pub fn reach(&self) -> Reach {
        let radius = self.bore_radius + self.interference.max(0.0);
        Reach { nominal: self.nominal, radius, width: self.width, travel: None }
    }

    /// The race as fully grown into its fit.
    pub fn fit(&self, scene: &HousedScene) -> Fit {
        Fit { radius: self.bore_radius + self.interference, axial: scene.housing.axial }
    }
}

/// What a condensed housing cannot have.
///
/// # Errors
/// [`HousingSetupError::VaryingLoad`], [`HousingSetupError::MovedSupport`].
pub fn check_constant(scene: &HousedScene) -> Result<(), HousingSetupError> {
    let constant = |profile: &Profile| matches!(profile, Profile::Constant(_));
    let varies = |load: &SetLoad| match &load.kind {
        LoadKind::Pressure(profile) => !constant(profile),
        LoadKind::Force(axes) => !axes.iter().flatten().all(constant),
    };
    if let Some(index) = scene.solid.loads.iter().position(varies) {
        return Err(HousingSetupError::VaryingLoad { index });
    }
    for (index, held) in scene.solid.held.iter().enumerate() {
        for (axis, motion) in ["x", "y", "z"].into_iter().zip(&held.motion) {
            if motion.as_ref().is_some_and(|motion| !motion.is_zero()) {
                return Err(HousingSetupError::MovedSupport { index, axis });
            }
        }
    }
    Ok(())
}

/// Something that drives bearing and housing, and its frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    pub what: String,
    /// Hz.
    pub frequency: f64,
}

/// All that drives a scene at a frequency of its own: what a quasi-static course must be slow against.
pub fn excitations(scene: &HousedScene) -> Vec<Excitation> {
    let bearing = &scene.bearing;
    let mut found = Vec::new();
    let mut add = |what: String, frequency: f64| {
        if frequency > 0.0 {
            found.push(Excitation { what, frequency });
        }
    };
    let names = ["x", "y", "z", "tilt_y", "tilt_z"];
    for (name, drive) in names.iter().zip(&bearing.dynamics.inner.drives) {
        let (Drive::Load(profile) | Drive::Motion(profile)) = drive;
        add(format!("inner_race.{name}"), frequency(profile));
    }
    let end = bearing.dynamics.run.as_ref().map_or(0.0, |run| run.end);
    let balls = bearing.geometry.ball_count as f64;
    let cage = kinematic_ratios(bearing).cage;
    let mut against_balls = 0.0f64;
    if let Some(load) = &bearing.dynamics.rotating_load {
        add("inner_race.rotating_load.force".into(), frequency(&load.force));
        let turning = largest(&load.speed, end) / TAU;
        add("the load's turns".into(), turning);
        against_balls = turning;
    }
    if let Rotation::Speed(speed) = &bearing.dynamics.inner.rotation {
        let shaft = largest(speed, end) / TAU;
        against_balls += cage * shaft;
    }
    add("balls passing the load".into(), balls * against_balls);
    if let Some(ramp) = scene.housing.fit_ramp {
        add("the fit that grows in".into(), 0.5 / ramp);
    }
    found
}

fn largest(profile: &Profile, end: f64) -> f64 {
    // Speeds are ramps and tables; a hundred looks find what counts here.
    let at = |i: u32| profile.value(end * f64::from(i) / 100.0).abs();
    (0..=100).map(at).fold(0.0, f64::max)
}

/// Of a swing that rises and falls as fast as the profile does, Hz; 0 for a constant one.
fn frequency(profile: &Profile) -> f64 {
    match profile {
        Profile::Constant(_) => 0.0,
        Profile::Ramp { from, to, duration, .. }
        | Profile::SmoothRamp { from, to, duration, .. } => {
            if from == to {
                0.0
            } else {
                0.5 / duration
            }
        }
        Profile::HalfSine { duration, .. } => 0.5 / duration,
        Profile::Harmonic { frequency, .. } => *frequency,
        Profile::Table { points } => {
            let steps = points.windows(2).filter(|pair| pair[0][1] != pair[1][1]);
            steps.map(|pair| 0.5 / (pair[1][0] - pair[0][0])).fold(0.0, f64::max)
        }
    }
}
