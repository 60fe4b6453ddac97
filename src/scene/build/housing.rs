//! From a bearing in a housing and the housing's mesh to the inputs of the solver.

use crate::ch2_housing::bore_contact::{ContactNode, Frame, Penalty, contact_nodes};
use crate::kinematics::Pose;
use crate::mesh::cylinder_fit::fit_cylinder;
use crate::numeric::profile::Profile;
use crate::scene::build::about::{SetupError, list};
use crate::scene::build::bore_shape::{
    BorePlace, Flat, LARGEST_OUT_OF_ROUND, MidSideNodes, ROUND, flat, middle_nodes,
};
use crate::scene::build::solid::{SolidSetup, setup as solid_setup};
use crate::scene::build::solid_mesh::BuiltMesh;
use crate::scene::resolve::housing_scene::{FitSize, HousedScene};
use crate::scene::resolve::solid_scene::{LoadKind, SetLoad};
use crate::solids::bore_equilibrium::Fit;
use crate::solids::condensation::{Reach, is_under};
use crate::solids::model::SolidModel;
use nalgebra::Vector3;
use std::collections::BTreeSet;

/// Largest eccentricity of the bore as a fraction of its radius.
const FAR_OFF: f64 = 0.05;
/// Largest difference of the bore from the race as a fraction of the radius.
const LARGEST_FIT: f64 = 0.01;
/// Out-of-roundness as a fraction of an interference below which pressures change by no more than that fraction.
const SMALL: f64 = 0.01;

/// Allowed ratio of the area represented by the contact nodes to the bore area under the race. In a longer
/// bore, two rows of nodes at the race's edges and one between give 1.5, and 0.5 without those at the edges.
const SHARES: std::ops::RangeInclusive<f64> = 0.6..=1.6;
/// Hint for a mesh that is not at its bearing.
const MOVE: &str = "solid.mesh.origin is the point, in the mesh's coordinates, that becomes the bearing's centre, solid.mesh.axis the \
                    mesh's axis along the bore";

/// Bounding box of a surface's nodes relative to the race's centre (m), for a message.
fn extent(seen: &[[f64; 3]]) -> String {
    let [x, y, z] = [0, 1, 2].map(|i| {
        let along = || seen.iter().map(|place| 1e3 * place[i]);
        let (low, high) =
            (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max));
        format!("{low:.4} to {high:.4}")
    });
    format!("relative to the bearing's centre it is at X {x}, Y {y}, Z {z} mm")
}

/// A housing ready for its bearing.
#[derive(Clone, Debug)]
pub struct HousingSetup {
    pub solid: SolidSetup,
    pub model: SolidModel,
    /// Bore nodes with a share of its surface.
    pub nodes: Vec<ContactNode>,
    /// Radius of the best-fit cylinder through the nodes under the race, m.
    pub bore_radius: f64,
    /// Largest distance of these nodes from it, m.
    pub out_of_round: f64,
    /// Distance of its axis from the race's centre, m.
    pub off_centre: f64,
    /// Effect of the bore's shape on the results, if it is relevant.
    pub caution: Option<String>,
    /// Notes on valid but unusual input.
    pub notes: Vec<String>,
    /// Radial interference, m; negative for clearance.
    pub interference: f64,
    /// Radius of the race in the scene where the fit does not follow from it, m.
    pub race_radius: Option<f64>,
    /// Width of the outer race, m.
    pub width: f64,
    /// Nominal pose of the outer race.
    pub nominal: Pose,
}

/// # Errors
///
/// A missing set, a bore that is not around the race, an invalid model.
pub fn setup(scene: &HousedScene, built: &BuiltMesh) -> Result<HousingSetup, SetupError> {
    let mesh = &built.mesh;
    let solid = solid_setup(&scene.solid, built)?;
    let bore = scene.housing.bore.clone();
    let refused = |text: String| SetupError::key("housing.bore", text);
    let too_narrow = |text: String| Err(SetupError::key("housing.width", text));
    let known = list(&mesh.surface_sets.keys().cloned().collect::<Vec<_>>());
    let faces = mesh.surface_sets.get(&bore).ok_or_else(|| {
        refused(format!(
            "the solid has no surface \"{bore}\"; its surfaces are: {known}. Hint: the bore of a ring is \"inner\""
        ))
    })?;
    if let Some(Flat { area, normal: [x, y, z] }) = flat(mesh, faces) {
        return Err(refused(format!(
            "\"{bore}\" is flat: all its {} faces, {:.4} mm^2, have the normal ({x:.3}, {y:.3}, {z:.3}). Name a cylinder \
             about the race's axis; the solid's surfaces are: {known}",
            faces.len(),
            1e6 * area
        )));
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
        return too_narrow(format!(
            "none of the {} nodes of the bore is under the outer race, which is {:.4} mm wide and centred at x = {:.4} mm: \
             {}. Hint: {MOVE}; also check width, position and the mesh's unit",
            nodes.len(),
            1e3 * width,
            1e3 * nominal.position.x,
            extent(&seen)
        ));
    }
    let corners = place.corner_cylinder(mesh, faces);
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    let farthest = distances.iter().copied().fold(0.0, f64::max);
    let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
    // Written so that NaN is refused.
    let not_round = || {
        refused(format!(
            "nodes of \"{bore}\" are {:.4} to {:.4} mm from the bearing's axis (along X through its centre), which is not a \
             bore about it; {}. Hint: {MOVE}; also check the name of the surface",
            1e3 * nearest,
            1e3 * farthest,
            extent(&seen)
        ))
    };
    let round = farthest - nearest <= FAR_OFF * mean;
    if !round {
        return Err(not_round());
    }
    // Straight edges would make a coarse bore seem too small.
    let size = corners.map_or(mean, |corners| corners.radius);
    let sizes = &scene.bearing.dimensions;
    let given = match scene.housing.fit {
        FitSize::OuterRadius(radius) => Some(radius),
        FitSize::Interference(_) => sizes.outer_radius,
    };
    let groove = sizes.outer_race.radius;
    let race = given.unwrap_or(1.1 * groove);
    let near = match given {
        Some(given) => (size - given).abs() <= LARGEST_FIT * given,
        // Any wall behind the groove.
        None => size > groove && size < 2.0 * groove,
    };
    if !near {
        return Err(refused(format!(
            "the bore has a radius of {:.4} mm, but the outer race about {:.4} mm. Allowed: a difference of 1 %. Hint: is the \
             mesh's unit (solid.mesh.unit) mm or m? Is \"{bore}\" the right surface, and the race's outer_radius right?",
            1e3 * size,
            1e3 * race
        )));
    }
    if let Some(corners) = corners {
        let middles = middle_nodes(mesh, faces, &corners);
        if middles.straight() {
            let MidSideNodes { inside, sagitta, missing, .. } = middles;
            let text = format!(
                "housing.bore: the element edges of \"{bore}\" are straight: its mid-side nodes, which the race touches, are \
                 up to {:.3} um inside the cylinder of radius {:.4} mm through the corner nodes. Curved edges would have an \
                 arc height of {:.3} um, and {:.0} % of it is missing. Hint: mesh it with curved edges (in Gmsh \
                 Mesh.SecondOrderLinear = 0, and Mesh.HighOrderOptimize = 0 if that straightened them), or save it with \
                 first-order elements and write order = 2 in [solid.mesh]",
                1e6 * inside,
                1e3 * corners.radius,
                1e6 * sagitta,
                1e2 * missing
            );
            return Err(SetupError::of(Some("solid.mesh.file"), text));
        }
    }
    let under = nodes.iter().zip(&seen).filter(|(_, at)| is_under(at));
    let under: Vec<Vector3<f64>> = under.map(|(node, _)| Vector3::from(node.place)).collect();
    let cylinder = fit_cylinder(&under, place.axis()).ok_or_else(not_round)?;
    let radius = cylinder.radius;
    let off = under.iter().map(|at| cylinder.outside(*at).abs()).fold(0.0, f64::max);
    let limit = LARGEST_OUT_OF_ROUND * radius;
    let round = off <= limit;
    if !round {
        return Err(refused(format!(
            "nodes of \"{bore}\" are up to {:.3} um off its cylinder of radius {:.4} mm; allowed: {:.3} um, as for IT7. Hint: \
             does the set contain faces outside the bore? Are coordinates written with all digits, and mid-side nodes on the \
             curved surface?",
            1e6 * off,
            1e3 * radius,
            1e6 * limit
        )));
    }
    let off_centre = cylinder.outside(nominal.position) + radius;
    let share = share_of_seat(&nodes, &seen, width, ends[1] - ends[0]);
    let stands_for_it = SHARES.contains(&share);
    if !stands_for_it {
        let hint = match overhang(width, ends) {
            Some(beside) => format!(": {beside}; or move the mesh: {MOVE}"),
            None => {
                ". Hint: refine the mesh along the axis, or place rows of nodes at the race's edges"
                    .into()
            }
        };
        return too_narrow(format!(
            "contact nodes represent {share:.2} of the bore area under a race {:.4} mm wide; allowed: {} to {}{hint}",
            1e3 * width,
            SHARES.start(),
            SHARES.end()
        ));
    }
    if let Some(at) = one_row(&nodes, &seen, width) {
        return too_narrow(format!(
            "the {} nodes of the bore under the outer race, {:.4} mm wide, are in one row around it, {:+.4} mm from its \
             middle, which cannot resist tilt; at least two rows are needed. Hint: refine the mesh along the axis (cells.axial \
             of a generated mesh, or order = 2 in [solid.mesh]), or give a width that covers two rows",
            distances.len(),
            1e3 * width,
            1e3 * at
        ));
    }
    let interference = match scene.housing.fit {
        FitSize::Interference(interference) => interference,
        FitSize::OuterRadius(race) => race - radius,
    };
    let mut notes = Vec::new();
    notes.extend(overhang(width, ends));
    notes.extend(eccentric_bore(off_centre, interference));
    let under = nodes.iter().zip(&seen).filter(|(_, at)| is_under(at)).map(|(node, _)| node.node);
    notes.extend(fixed_nodes(&bore, under.collect(), &solid)?);
    notes.extend(rigid_rings(scene, radius, interference));
    let model = SolidModel::labelled(solid.problem.clone(), solid.labels.clone())
        .map_err(|error| SetupError::of(None, error))?;
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
        race_radius: match scene.housing.fit {
            FitSize::Interference(_) => sizes.outer_radius,
            FitSize::OuterRadius(_) => None,
        },
        width,
        nominal,
    })
}

/// Note for a race wider than the bore under it, which extends between these positions along its axis, m.
fn overhang(width: f64, [low, high]: [f64; 2]) -> Option<String> {
    let beside = (0.5 * width - high).max(0.0) + (0.5 * width + low).max(0.0);
    // A thousandth of the width is rounding of meshes and drawings.
    (beside > 1e-3 * width).then(|| {
        format!(
             "of the outer race's width of {:.4} mm, {:.4} mm are beside the bore, which extends from {:.4} to {:.4} \
             mm along the axis from the race's centre: they bear on nothing, and pressure is high at the \
             bore's edge. If that is not meant, check housing.width and outer_race.x",
            1e3 * width,
            1e3 * beside,
            1e3 * low,
            1e3 * high
        )
    })
}

/// Note for a bore whose axis is off the race's centre by more than its fit, m.
fn eccentric_bore(off: f64, interference: f64) -> Option<String> {
    /// Rounding of drawings and meshes.
    const ROUNDED: f64 = 1e-6;
    (off > interference.abs() + ROUNDED).then(|| {
        format!(
             "the bore's axis is {:.4} um off the race's centre, more than the fit: an explicit run that begins undeformed has the \
              race so deep in the wall. If that is not meant, check solid.mesh.origin",
            1e6 * off
        )
    })
}

/// Bore nodes fixed across the axis by a support.
fn fixed_nodes(
    bore: &str,
    under: BTreeSet<u32>,
    solid: &SolidSetup,
) -> Result<Option<String>, SetupError> {
    let across = solid.problem.prescribed.iter().filter(|held| held.axis > 0);
    let held: BTreeSet<u32> =
        across.map(|held| held.node).filter(|node| under.contains(node)).collect();
    let count = under.len();
    if held.len() == count {
        let text = format!(
            "all {count} nodes of \"{bore}\" under the race are fixed by [[solid.fixed]], so the bore cannot deform. Hint: fix \
             another set, or write method = \"rigid\" in [housing]"
        );
        return Err(SetupError::key("housing.bore", text));
    }
    Ok((!held.is_empty()).then(|| {
        format!(
            "{} of {count} nodes of the bore under the race are fixed by [[solid.fixed]]: \
              they carry more of the load than those of a free bore would",
            held.len()
        )
    }))
}

/// Rings are rigid: effect on a fit, compared with a thin ring.
fn rigid_rings(scene: &HousedScene, radius: f64, interference: f64) -> Option<String> {
    // Below this there is no fit, only rounding of a given outer radius.
    if interference <= 1e-9 * radius {
        return None;
    }
    let thickness = radius - scene.bearing.dimensions.outer_race.radius;
    let mean = radius - 0.5 * thickness;
    // A thin ring under outer pressure p shrinks by p r²/(E t).
    let alone =
        scene.bearing.outer_material.youngs_modulus * thickness * interference / (mean * radius);
    let ring = if thickness > 0.0 {
        format!(
            "; a thin ring as thick as from groove to outer surface, {:.3} mm, would shrink by all of the fit under \
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

/// Caution for a bore out of round (m), unless that is small compared with an interference or with the race's
/// penetration.
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

/// Axial position of the nodes under a race of `width` (m), m, if they are close together.
///
/// They resist a tilt by the second moment of their shares; their spread is 0.29 widths if even, 0.1 in two rows a
/// fifth of the width apart.
fn one_row(nodes: &[ContactNode], seen: &[[f64; 3]], width: f64) -> Option<f64> {
    const CLOSEST: f64 = 0.1;
    let under = || nodes.iter().zip(seen).filter(|(_, place)| is_under(place[0], width));
    let area: f64 = under().map(|(node, _)| node.area).sum();
    let middle = under().map(|(node, at)| node.area * at[0]).sum::<f64>() / area;
    let spread = under().map(|(node, at)| node.area * (at[0] - middle) * (at[0] - middle));
    let spread = (spread.sum::<f64>() / area).sqrt();
    // Not `<`: NaN is no row.
    (spread <= CLOSEST * width).then_some(middle)
}

/// Area of the nodes under a race of `width`, over the part of the bore (of length `length`, m) that it covers.
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

    /// Nodes of a condensed housing: all under the race.
    pub fn reach(&self) -> Reach {
        let radius = self.bore_radius + self.interference.max(0.0);
        Reach { nominal: self.nominal, radius, width: self.width, travel: None }
    }

    /// The race with its full fit.
    pub fn fit(&self, scene: &HousedScene) -> Fit {
        Fit { radius: self.bore_radius + self.interference, axial: scene.housing.axial }
    }
}

/// Checks for a condensed housing.
///
/// # Errors
///
/// A load that varies; a support with a prescribed displacement.
pub fn check_constant(scene: &HousedScene) -> Result<(), SetupError> {
    let constant = |profile: &Profile| matches!(profile, Profile::Constant(_));
    let varies = |load: &SetLoad| match &load.kind {
        LoadKind::Pressure(profile) => !constant(profile),
        LoadKind::Force(axes) => !axes.iter().flatten().all(constant),
    };
    if let Some(index) = scene.solid.loads.iter().position(varies) {
        let text = "the housing method `quasi-static` needs constant loads; write method = \"explicit\" in [housing]";
        return Err(SetupError::item("solid.load", index, "set", text));
    }
    check_supports(scene)
}

/// Checks for a linear housing represented by its bore.
///
/// # Errors
///
/// A support with a prescribed displacement.
pub fn check_supports(scene: &HousedScene) -> Result<(), SetupError> {
    for (index, held) in scene.solid.held.iter().enumerate() {
        for (axis, motion) in ["x", "y", "z"].into_iter().zip(&held.motion) {
            if motion.as_ref().is_some_and(|motion| !motion.is_zero()) {
                let text = format!(
                    "the housing methods `quasi-static` and `reduced` need supports at zero; write {axis} = true, or method = \
                     \"explicit\" in [housing]"
                );
                return Err(SetupError::item("solid.fixed", index, axis, text));
            }
        }
    }
    Ok(())
}
