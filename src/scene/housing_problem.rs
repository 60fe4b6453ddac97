//! From a bearing in a housing and the housing's mesh to what the solver takes, and what drives it.

use crate::ch2_housing::bore_contact::{ContactNode, Frame, Penalty, contact_nodes};
use crate::kinematics::Pose;
use crate::mesh::cylinder_fit::fit_cylinder;
use crate::scene::about::About;
use crate::scene::bore_shape::{
    BorePlace, Flat, LARGEST_OUT_OF_ROUND, MiddleNodes, ROUND, flat, middle_nodes,
};
use crate::scene::housing::{FitSize, HousedScene};
use crate::scene::solid::{LoadKind, SetLoad};
use crate::scene::solid_mesh::BuiltMesh;
use crate::scene::solid_problem::{SolidSetup, SolidSetupError, setup as solid_setup};
use crate::solver::housing::bore_equilibrium::Fit;
use crate::solver::housing::condensed::{Reach, is_under};
use crate::solver::profile::Profile;
use crate::solver::solid::model::{SolidError, SolidModel};
use nalgebra::Vector3;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use thiserror::Error;

/// What the nodes under the race may stand for, as a part of the bore that it covers: two rows of nodes at
/// its edges and one between give 1.5 in a longer bore, and 0.5 where those at its edges are missed.
const SHARES: RangeInclusive<f64> = 0.6..=1.6;
/// Part of the race's radius by which the bore may differ from it, and be out of centre.
const FAR_OFF: f64 = 0.05;
/// Part of an interference below which out-of-roundness changes pressures by no more than this part.
const SMALL: f64 = 0.01;

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
         {:.4} mm wide about x = {:.4} mm: {lies}. Hint: {MOVE}; check width, position and the mesh's unit, too",
        1e3 * *.width, 1e3 * *.centre
    )]
    BesideTheRace { count: usize, width: f64, centre: f64, lies: Lies },
    #[error(
        "housing.bore: \"{bore}\" is flat: its {faces} faces, {:.4} mm^2, all look along ({:.3}, {:.3}, {:.3}). A bore \
         is a cylinder about the race's axis. The solid's surfaces are: {}",
        1e6 * *.area, normal[0], normal[1], normal[2], list(known)
    )]
    FlatBore { bore: String, faces: usize, area: f64, normal: [f64; 3], known: Vec<String> },
    #[error(
        "housing.bore: the bore has a radius of {:.4} mm, the outer race one of about {:.4} mm. Hint: was \
         the mesh's unit (solid.mesh.unit) mm or m? Is \"{bore}\" the right surface?",
        1e3 * *.radius, 1e3 * *.race
    )]
    FarFromTheRace { bore: String, radius: f64, race: f64 },
    #[error(
        "housing.bore: nodes of \"{bore}\" are {:.4} to {:.4} mm from the bearing's axis, X through its \
         centre: no bore about it; {lies}. Hint: {MOVE}; check the name of the surface, too",
        1e3 * *.nearest, 1e3 * *.farthest
    )]
    NotRound { bore: String, nearest: f64, farthest: f64, lies: Lies },
    #[error(
        "housing.bore: the edges of \"{bore}\" are straight: its mid-side nodes, where the race touches, lie \
         up to {:.3} um inside the cylinder of radius {:.4} mm through its corners; edges this long have arcs \
         {:.3} um high, of which {:.0} % is missing. Hint: mesh it with curved edges (in Gmsh \
         Mesh.SecondOrderLinear = 0, and Mesh.HighOrderOptimize = 0 if that pulled them straight), or save \
         it with elements of first order and write order = 2 in [solid.mesh]",
        1e6 * *.inside, 1e3 * *.radius, 1e6 * *.sagitta, 1e2 * *.missing
    )]
    StraightBore { bore: String, radius: f64, inside: f64, sagitta: f64, missing: f64 },
    #[error(
        "housing.bore: nodes of \"{bore}\" are up to {:.3} um off its cylinder of radius {:.4} mm, more than \
         the {:.3} um of a bore to IT7. Hint: has the set faces beside the bore? Are its nodes written with \
         all digits, its mid-side nodes on the curved surface?",
        1e6 * *.off, 1e3 * *.radius, 1e6 * *.limit
    )]
    OutOfRound { bore: String, radius: f64, off: f64, limit: f64 },
    #[error(
        "housing.width: nodes of the bore stand for {share:.2} of the seat of a race {:.4} mm wide, and it \
         should be {} to {}{}",
        1e3 * *.width, SHARES.start(), SHARES.end(), seat_hint(.beside)
    )]
    CoarseSeat { width: f64, share: f64, beside: Option<String> },
    #[error(
        "housing.width: the {count} nodes of the bore under the outer race, {:.4} mm wide, lie in one row around it, \
         {:+.4} mm from its middle: nothing there resists its tilt, and it takes two rows at least. Hint: more rows \
         along the axis (cells.axial of a mesh that is made, or order = 2 in [solid.mesh]), or a width that has two \
         under it",
        1e3 * *.width, 1e3 * *.at
    )]
    OneRow { count: usize, width: f64, at: f64 },
    #[error(
        "housing.bore: all {count} nodes of \"{bore}\" under the race are held by [[solid.held]]: the bore cannot \
         give way, and nothing of the solid counts. Hold another set, or write method = \"rigid\" in [housing]"
    )]
    HeldBore { bore: String, count: usize },
    #[error("housing: the fit leaves the outer race {:.1} um larger than the bore, more than {:.1} um",
        1e6 * *.interference, 1e6 * *.limit)]
    FitTooLarge { interference: f64, limit: f64 },
    #[error(
        "solid.load: the condensed housing of `quasi-static` takes constant loads; write method = \
         \"explicit\" in [housing]"
    )]
    VaryingLoad { index: usize },
    #[error(
        "solid.held.{axis}: the housing of `quasi-static` and of `reduced` is held at zero; write \
         {axis} = true, or method = \"explicit\" in [housing]"
    )]
    MovedSupport { index: usize, axis: &'static str },
}

/// What to do about a mesh that is not where its bearing is.
const MOVE: &str = "solid.mesh.origin names the point of the mesh's own coordinates that comes to the bearing's centre, solid.mesh.axis the \
                    axis of the mesh that is the bore's";

fn seat_hint(beside: &Option<String>) -> String {
    match beside {
        Some(beside) => format!(": {beside}, and where the mesh lies: {MOVE}"),
        None => {
            ". Hint: refine the mesh along the axis, or let rows of nodes lie at the race's edges"
                .into()
        }
    }
}

/// Where the nodes of a surface lie from the race's centre, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lies {
    low: [f64; 3],
    high: [f64; 3],
}

impl Lies {
    fn of(seen: &[[f64; 3]]) -> Lies {
        let mut lies = Lies { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        for place in seen {
            for (i, at) in place.iter().enumerate() {
                lies.low[i] = lies.low[i].min(*at);
                lies.high[i] = lies.high[i].max(*at);
            }
        }
        lies
    }
}

impl std::fmt::Display for Lies {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let along = |i: usize| format!("{:.4} to {:.4}", 1e3 * self.low[i], 1e3 * self.high[i]);
        let [x, y, z] = [0, 1, 2].map(along);
        write!(f, "from the bearing's centre it lies at X {x}, Y {y}, Z {z} mm")
    }
}

impl HousingSetupError {
    /// Part of the scene that it is about; of a model that cannot be set up none.
    pub fn about(&self) -> Option<About> {
        Some(match self {
            HousingSetupError::Solid(error) => error.about(),
            HousingSetupError::Model(_) => return None,
            HousingSetupError::NoBore { .. }
            | HousingSetupError::FlatBore { .. }
            | HousingSetupError::FarFromTheRace { .. }
            | HousingSetupError::NotRound { .. }
            | HousingSetupError::HeldBore { .. }
            | HousingSetupError::OutOfRound { .. } => About::key("housing.bore"),
            HousingSetupError::StraightBore { .. } => About::key("solid.mesh.file"),
            HousingSetupError::BesideTheRace { .. }
            | HousingSetupError::OneRow { .. }
            | HousingSetupError::CoarseSeat { .. } => About::key("housing.width"),
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
    /// Of the cylinder that lies nearest to those under the race, m.
    pub bore_radius: f64,
    /// Largest distance of those from it, m.
    pub out_of_round: f64,
    /// Distance of its axis from the race's centre, m.
    pub off_centre: f64,
    /// What the bore's own shape does to the results, where that is worth a word.
    pub caution: Option<String>,
    /// What is no error and perhaps not meant.
    pub notes: Vec<String>,
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
    if let Some(Flat { area, normal }) = flat(mesh, faces) {
        let known = mesh.surface_sets.keys().cloned().collect();
        return Err(HousingSetupError::FlatBore { bore, faces: faces.len(), area, normal, known });
    }
    let nodes = contact_nodes(mesh, faces);
    let place = BorePlace::of(scene);
    let nominal = place.nominal;
    let frame = Frame::new(&nominal);
    let seen: Vec<[f64; 3]> = nodes.iter().map(|node| frame.seen(node.place)).collect();
    let ends = seen.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
        [low.min(place[0]), high.max(place[0])]
    });
    let width = scene.housing.width.unwrap_or(ends[1] - ends[0]);
    let is_under = |place: &[f64; 3]| is_under(place[0], width);
    let distance = |[_, y, z]: &[f64; 3]| (y * y + z * z).sqrt();
    let distances: Vec<f64> = seen.iter().filter(|at| is_under(at)).map(distance).collect();
    if distances.is_empty() {
        let centre = nominal.position.x;
        let (count, lies) = (nodes.len(), Lies::of(&seen));
        return Err(HousingSetupError::BesideTheRace { count, width, centre, lies });
    }
    let corners = place.corner_cylinder(mesh, faces);
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    let farthest = distances.iter().copied().fold(0.0, f64::max);
    let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
    // Written as it is so that a place that is not a number is refused as well.
    let round = farthest - nearest <= FAR_OFF * mean;
    if !round {
        let lies = Lies::of(&seen);
        return Err(HousingSetupError::NotRound { bore, nearest, farthest, lies });
    }
    // Straight edges would make a coarse bore look far too small.
    let size = corners.map_or(mean, |corners| corners.radius);
    let sizes = &scene.bearing.dimensions;
    let given = match scene.housing.fit {
        FitSize::OuterRadius(radius) => Some(radius),
        FitSize::Interference(_) => sizes.outer_radius,
    };
    let groove = sizes.outer_race.radius;
    let race = given.unwrap_or(1.1 * groove);
    let near = match given {
        Some(given) => (size - given).abs() <= FAR_OFF * given,
        // Any wall behind the groove.
        None => size > groove && size < 2.0 * groove,
    };
    if !near {
        return Err(HousingSetupError::FarFromTheRace { bore, radius: size, race });
    }
    if let Some(corners) = corners {
        let middles = middle_nodes(mesh, faces, &corners);
        if middles.straight() {
            let (radius, MiddleNodes { inside, sagitta, missing, .. }) = (corners.radius, middles);
            return Err(HousingSetupError::StraightBore { bore, radius, inside, sagitta, missing });
        }
    }
    let under = nodes.iter().zip(&seen).filter(|(_, at)| is_under(at));
    let under: Vec<Vector3<f64>> = under.map(|(node, _)| Vector3::from(node.place)).collect();
    let Some(cylinder) = fit_cylinder(&under, place.axis()) else {
        let lies = Lies::of(&seen);
        return Err(HousingSetupError::NotRound { bore, nearest, farthest, lies });
    };
    let radius = cylinder.radius;
    let off = under.iter().map(|at| cylinder.outside(*at).abs()).fold(0.0, f64::max);
    let limit = LARGEST_OUT_OF_ROUND * radius;
    let round = off <= limit;
    if !round {
        return Err(HousingSetupError::OutOfRound { bore, radius, off, limit });
    }
    let off_centre = cylinder.outside(nominal.position) + radius;
    let share = share_of_seat(&nodes, &seen, width, ends[1] - ends[0]);
    let stands_for_it = SHARES.contains(&share);
    if !stands_for_it {
        let beside = overhang(width, ends);
        return Err(HousingSetupError::CoarseSeat { width, share, beside });
    }
    if let Some(at) = one_row(&nodes, &seen, width) {
        return Err(HousingSetupError::OneRow { count: distances.len(), width, at });
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
    let mut notes = Vec::new();
    notes.extend(overhang(width, ends));
    notes.extend(beside_the_axis(off_centre, interference));
    let under = nodes.iter().zip(&seen).filter(|(_, at)| is_under(at)).map(|(node, _)| node.node);
    notes.extend(held_nodes(&bore, under.collect(), &solid)?);
    notes.extend(rigid_rings(scene, radius, interference));
    let model = SolidModel::labelled(solid.problem.clone(), solid.labels.clone())?;
    Ok(HousingSetup {
        solid,
        model,
        nodes,
        bore_radius: radius,
        out_of_round: off,
        off_centre,
        caution: caution(off, interference, scene.housing.penalty),
        notes,
        interference,
        width,
        nominal,
    })
}

/// A race that is wider than the seat under it, which lies between these places along its axis, m.
fn overhang(width: f64, [low, high]: [f64; 2]) -> Option<String> {
    let beside = (0.5 * width - high).max(0.0) + (0.5 * width + low).max(0.0);
    // A thousandth of the width is what meshes and drawings round.
    (beside > 1e-3 * width).then(|| {
        format!(
            "of the outer race's {:.4} mm of width {:.4} mm lie beside the bore, which goes from {:.4} to {:.4} \
             mm along the axis from the race's centre: they bear on nothing, and pressure is high at the \
             bore's edge. If that is not meant, check housing.width and outer_race.x",
            1e3 * width,
            1e3 * beside,
            1e3 * low,
            1e3 * high
        )
    })
}

/// A bore whose axis lies beside the race's centre by more than its fit, m.
fn beside_the_axis(off: f64, interference: f64) -> Option<String> {
    /// What drawings and meshes round.
    const ROUNDED: f64 = 1e-6;
    (off > interference.abs() + ROUNDED).then(|| {
        format!(
            "the bore's axis lies {:.4} um beside the race's centre, more than the fit: an explicit run that begins undeformed has the \
             race so deep in the wall. If that is not meant, check solid.mesh.origin",
            1e6 * off
        )
    })
}

/// Nodes of the bore that a support holds across the axis.
fn held_nodes(
    bore: &str,
    under: BTreeSet<u32>,
    solid: &SolidSetup,
) -> Result<Option<String>, HousingSetupError> {
    let across = solid.problem.prescribed.iter().filter(|held| held.axis > 0);
    let held: BTreeSet<u32> =
        across.map(|held| held.node).filter(|node| under.contains(node)).collect();
    let count = under.len();
    if held.len() == count {
        return Err(HousingSetupError::HeldBore { bore: bore.to_string(), count });
    }
    Ok((!held.is_empty()).then(|| {
        format!(
            "{} of {count} nodes of the bore under the race are held by [[solid.held]] and do not give way: \
             they take more of the load than a bore's would",
            held.len()
        )
    }))
}

/// Rings are rigid: what that does to a fit, beside what a ring of its thickness would do.
fn rigid_rings(scene: &HousedScene, radius: f64, interference: f64) -> Option<String> {
    // Below this no fit is asked for: rounding of a given outer radius.
    if interference <= 1e-9 * radius {
        return None;
    }
    let thickness = radius - scene.bearing.dimensions.outer_race.radius;
    let mean = radius - 0.5 * thickness;
    // A thin ring under outer pressure p becomes smaller by p r²/(E t).
    let alone =
        scene.bearing.outer_material.youngs_modulus * thickness * interference / (mean * radius);
    let ring = if thickness > 0.0 {
        format!(
            "; a thin ring as thick as from groove to seat, {:.3} mm, would give way by all of the fit under \
             {:.3} MPa, and the parts share it by their stiffness",
            1e3 * thickness,
            1e-6 * alone
        )
    } else {
        String::new()
    };
    Some(format!(
        "the races are rigid, so that the housing takes all of the fit of {:.3} um, and the bearing's clearance \
         stays: pressure and stress of the fit are upper bounds{ring}",
        1e6 * interference
    ))
}

/// Of a bore so far (m) off its cylinder, where that is not small beside an interference or, under
/// any fit, beside how far the race sinks into its seat.
fn caution(off: f64, interference: f64, penalty: Penalty) -> Option<String> {
    if off <= ROUND.max(SMALL * interference) {
        return None;
    }
    let load = match penalty {
        Penalty::PerArea(stiffness) => format!("{:.3} MPa", 1e-6 * stiffness * off),
        Penalty::PerNode(stiffness) => format!("{:.3} N a node", stiffness * off),
    };
    Some(format!(
        "the bore is {:.4} um out of round at a fit of {:+.4} um: nodes that stand out touch first, with \
         up to {load} more than on a round bore; which nodes touch, the peak pressure and stresses at the \
         bore are those of this mesh's shape, and the race's place is uncertain by about as much. If the \
         shape is not meant, write the nodes' coordinates with more digits",
        1e6 * off,
        1e6 * interference
    ))
}

/// Where along the axis the nodes under a race of `width` (m) lie, m, if that is in one place.
///
/// They resist a tilt by the second moment of what they carry; spread evenly they lie 0.29 widths from their
/// middle, in two rows as close as a fifth of the width 0.1.
fn one_row(nodes: &[ContactNode], seen: &[[f64; 3]], width: f64) -> Option<f64> {
    const CLOSEST: f64 = 0.1;
    let under = || nodes.iter().zip(seen).filter(|(_, place)| is_under(place[0], width));
    let area: f64 = under().map(|(node, _)| node.area).sum();
    let middle = under().map(|(node, at)| node.area * at[0]).sum::<f64>() / area;
    let spread = under().map(|(node, at)| node.area * (at[0] - middle) * (at[0] - middle));
    let spread = (spread.sum::<f64>() / area).sqrt();
    // Not `<`: a place that is not a number is no row.
    (spread <= CLOSEST * width).then_some(middle)
}

/// Area that the nodes under a race of `width` carry, over the part of the bore (of length `length`, m) that
/// it covers.
fn share_of_seat(nodes: &[ContactNode], seen: &[[f64; 3]], width: f64, length: f64) -> f64 {
    let under = |place: &[f64; 3]| is_under(place[0], width);
    let all: f64 = nodes.iter().map(|node| node.area).sum();
    let carried: f64 =
        nodes.iter().zip(seen).filter(|(_, place)| under(place)).map(|(node, _)| node.area).sum();
    carried / (all * (width / length).min(1.0))
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
    check_supports(scene)
}

/// What a linear housing that is taken as its bore sees it cannot have.
///
/// # Errors
/// [`HousingSetupError::MovedSupport`].
pub fn check_supports(scene: &HousedScene) -> Result<(), HousingSetupError> {
    for (index, held) in scene.solid.held.iter().enumerate() {
        for (axis, motion) in ["x", "y", "z"].into_iter().zip(&held.motion) {
            if motion.as_ref().is_some_and(|motion| !motion.is_zero()) {
                return Err(HousingSetupError::MovedSupport { index, axis });
            }
        }
    }
    Ok(())
}
