//! Cages that touch by the nodes of their mesh: the mesh, its contact nodes, and its modes in a floating frame or its
//! elements.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::cage::{CageContacts, Guidance};
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch2_housing::linear_elastic::{ElasticError, LinearElastic};
use crate::kinematics::vec3::{Vec3, add_scaled, dot, norm, scale, sub};
use crate::members::body::Mobility;
use crate::members::cage_nodes::{CageNodes, NodeGroup, PocketNodes, SECTORS, azimuth};
use crate::members::floating_solid::{FloatingSolid, RadiusGauge};
use crate::mesh::TetMesh;
use crate::mesh::error::MeshError;
use crate::mesh::measure::{Share, tributary_areas};
use crate::mesh::tet_mesh::Face;
use crate::motion::coupling::SolidPart;
use crate::motion::explicit_cage::CagePart;
use crate::reduction::floating::{FloatingReduction, Patch, reduce_floating};
use crate::scene::resolve::resolved::{CageInRun, CageMethod, Dynamics, FlexibleCage};
use crate::solids::error::SolidError;
use crate::solids::model::{SolidModel, SolidProblem};
use crate::solids::modes::ModeError;
use std::f64::consts::TAU;
use thiserror::Error;

/// Error in the mesh or the modes of a cage.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CageMeshError {
    #[error("bearing.cage.mesh: {0}")]
    Mesh(#[from] MeshError),
    #[error("bearing.cage: {0}")]
    Material(#[from] ElasticError),
    #[error("bearing.cage.mesh: {0}")]
    Solid(#[from] SolidError),
    #[error("bearing.cage.modes_to: {0}")]
    Modes(#[from] ModeError),
}

/// Mesh of a cage with its displacements by mode, for fields.
#[derive(Clone, Debug)]
pub struct BuiltCage {
    /// Index in the assembly's bearings.
    pub bearing: usize,
    /// Name of its files: "cage", with the bearing's name in front.
    pub name: String,
    pub mesh: TetMesh,
    pub model: SolidModel,
    pub form: CageForm,
}

/// How a cage with a mesh moves.
#[derive(Clone, Debug)]
pub enum CageForm {
    Rigid,
    Reduced(Box<FloatingReduction>),
    /// In explicit steps.
    Elements(Box<SolidPart>),
}

impl BuiltCage {
    /// `None` for a cage without steps of its own.
    pub fn part(&self) -> Option<&SolidPart> {
        match &self.form {
            CageForm::Elements(part) => Some(part),
            _ => None,
        }
    }
}

/// Replaces the contacts of cages whose scene asks for a mesh, bearing by bearing, by those of its nodes.
///
/// # Errors
///
/// Dimensions without a mesh, a material out of range, modes that cannot be found.
pub fn add_cage_nodes<'s>(
    all: &mut Assembly,
    scenes: impl Iterator<Item = &'s Dynamics>,
) -> Result<Vec<BuiltCage>, CageMeshError> {
    let mut built = Vec::new();
    for (bearing, dynamics) in scenes.enumerate() {
        if let (CageInRun::Body(_), Some(flexible)) = (&dynamics.cage, &dynamics.flexible_cage) {
            built.push(add(all, bearing, flexible)?);
        }
    }
    Ok(built)
}

fn add(
    all: &mut Assembly,
    bearing: usize,
    flexible: &FlexibleCage,
) -> Result<BuiltCage, CageMeshError> {
    let name = format!("{}cage", all.bearings[bearing].prefix());
    let phase = all.bearings[bearing].ball_phase;
    let gravity = all.gravity;
    let Some(caged) = &mut all.bearings[bearing].cage else {
        unreachable!("a cage in a run is a body of its bearing");
    };
    let contacts = caged.contacts;
    let mesh = flexible.shape.solid(&flexible.cells)?;
    let mut mesh = if flexible.order == 1 { mesh.mesh } else { mesh.quadratic()?.mesh };
    turn(&mut mesh, phase);
    let problem = SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material: LinearElastic::new(flexible.youngs_modulus, flexible.poisson_ratio)?,
        density: flexible.density,
        damping: flexible.damping,
        damped_motion: Default::default(),
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity,
    };
    let model = SolidModel::new(problem)?;
    let surfaces = Surfaces::new(&mesh, &contacts.guidance, contacts.pocket_radius);
    let body = caged.body;
    if flexible.method == CageMethod::Explicit {
        let total: f64 = model.mass.iter().sum();
        let weighted = model.mass.iter().zip(&mesh.nodes);
        let centre = weighted.fold([0.0; 3], |sum, (m, at)| add_scaled(sum, m / total, *at));
        let nodes = contact_nodes(&contacts, flexible, &mesh, &surfaces, (centre, &[]));
        caged.in_elements = true;
        all.bodies[body].mobility = Mobility::Carried;
        let part = SolidPart {
            cage: Some(CagePart { bearing, nodes, centre }),
            ..SolidPart::undeformed(Some(name.clone()), model.clone())
        };
        return Ok(BuiltCage {
            bearing,
            name,
            mesh,
            model,
            form: CageForm::Elements(Box::new(part)),
        });
    }
    let patches =
        if flexible.corrections { surfaces.patches(&mesh, &contacts) } else { Vec::new() };
    let reduction = reduce_floating(&model, flexible.modes_to, &patches)?;
    let index = all.floating.len();
    let with_shapes = (reduction.centre, &reduction.shapes[..]);
    let nodes = contact_nodes(&contacts, flexible, &mesh, &surfaces, with_shapes);
    caged.nodes = Some(CageNodes { floating: index, ..nodes });
    let modes = reduction.shapes.len();
    let [xx, yy, zz, ..] = reduction.frame.inertia;
    let inertia = Inertia { mass: reduction.frame.mass, axial: xx, transverse: 0.5 * (yy + zz) };
    all.bodies[body].mobility = Mobility::Free(inertia);
    let gauges = if modes > 0 { gauges(&mesh, &surfaces.outer, &reduction) } else { Vec::new() };
    all.floating.push(FloatingSolid { body, frame: reduction.frame.clone(), gauges });
    let form = if modes > 0 { CageForm::Reduced(Box::new(reduction)) } else { CageForm::Rigid };
    Ok(BuiltCage { bearing, name, mesh, model, form })
}

/// Contact nodes of a cage with this centre of mass and these displacements by mode.
fn contact_nodes(
    contacts: &CageContacts,
    flexible: &FlexibleCage,
    mesh: &TetMesh,
    surfaces: &Surfaces,
    (centre, shapes): (Vec3, &[Vec<Vec3>]),
) -> CageNodes {
    let group = |nodes: &[(u32, f64)]| {
        let list: Vec<u32> = nodes.iter().map(|(node, _)| *node).collect();
        let area = |node: u32| {
            nodes.iter().find(|(other, _)| *other == node).map_or(0.0, |(_, area)| *area)
        };
        let place = |node: u32| sub(mesh.nodes[node as usize], centre);
        let stiffness = |node: u32| flexible.penalty.of_node(area(node));
        NodeGroup::new(&list, place, stiffness, shapes)
    };
    let pockets: Vec<PocketNodes> =
        surfaces.pockets.iter().map(|nodes| PocketNodes::new(group(nodes))).collect();
    let land = group(&surfaces.land);
    let outward = if contacts.guidance == Guidance::InnerRace { -1.0 } else { 1.0 };
    let distance = |place: &Vec3| libm::hypot(place[1], place[2]);
    let rims = land.places.iter().map(distance);
    let sector = |place: &Vec3| (azimuth(*place) / TAU * SECTORS as f64) as usize;
    let sectors = (0..=SECTORS).map(|of| land.places.partition_point(|place| sector(place) < of));
    let groups = || pockets.iter().map(|pocket| &pocket.group).chain([&land]);
    let modes = shapes.len();
    CageNodes {
        floating: 0,
        largest: (0..modes)
            .map(|mode| groups().map(|group| group.largest(mode)).fold(0.0, f64::max))
            .collect(),
        sectors: sectors.collect(),
        rim: outward * rims.map(|rim| outward * rim).fold(f64::NEG_INFINITY, f64::max),
        half_length: land.places.iter().map(|place| place[0].abs()).fold(0.0, f64::max),
        land_radius: contacts.guide_radius + outward * contacts.race_clearance,
        outward,
        friction: contacts.friction,
        regularisation_speed: contacts.regularisation_speed,
        pockets,
        land,
    }
}

/// Rotates a mesh about X, so that its first pocket is at the azimuth of ball 1.
fn turn(mesh: &mut TetMesh, angle: f64) {
    let (sin, cos) = libm::sincos(angle);
    for [_, y, z] in &mut mesh.nodes {
        (*y, *z) = (*y * cos - *z * sin, *y * sin + *z * cos);
    }
}

/// Contact nodes of a cage, each with its share of the surface, m².
struct Surfaces {
    pockets: Vec<Vec<(u32, f64)>>,
    /// Ascending by azimuth.
    land: Vec<(u32, f64)>,
    /// Nodes of the outer surface.
    outer: Vec<u32>,
}

/// Radius of the patch where a ball meets its pocket, in pocket radii.
const PATCH: f64 = 0.6;

impl Surfaces {
    fn new(mesh: &TetMesh, guidance: &Guidance, pocket_radius: f64) -> Surfaces {
        let shares = |name: &str| -> Vec<(u32, f64)> {
            let areas = tributary_areas(mesh, faces(mesh, name), Share::Positive);
            (0u32..).zip(areas).filter(|(_, area)| *area > 0.0).collect()
        };
        let count = (1..).take_while(|i| mesh.surface_sets.contains_key(&pocket_name(*i))).count();
        let guide = if *guidance == Guidance::InnerRace { "inner" } else { "outer" };
        // The groove is between the lands, as wide as the pockets.
        let mut land = shares(guide);
        land.retain(|(node, _)| mesh.nodes[*node as usize][0].abs() >= pocket_radius);
        if *guidance == Guidance::Balls {
            land.clear();
        }
        let at = |node: u32| azimuth(mesh.nodes[node as usize]);
        land.sort_by(|a, b| at(a.0).total_cmp(&at(b.0)));
        Surfaces {
            pockets: (1..=count).map(|pocket| shares(&pocket_name(pocket))).collect(),
            land,
            outer: shares("outer").into_iter().map(|(node, _)| node).collect(),
        }
    }

    /// Pressure where the ball meets both walls of each pocket, ahead and behind, and radial forces on each rail at the
    /// pockets.
    fn patches(&self, mesh: &TetMesh, contacts: &CageContacts) -> Vec<Patch> {
        let place = |node: u32| mesh.nodes[node as usize];
        let mut patches = Vec::new();
        for nodes in &self.pockets {
            let group: Vec<Vec3> = nodes.iter().map(|(node, _)| place(*node)).collect();
            let towards = direction(&group);
            let ahead = [0.0, -towards[2], towards[1]];
            for sign in [1.0, -1.0] {
                let met = add_scaled(
                    scale(towards, contacts.pocket_pitch_radius),
                    sign * contacts.pocket_radius,
                    ahead,
                );
                let reach = PATCH * contacts.pocket_radius;
                let patch = nodes.iter().filter_map(|&(node, area)| {
                    let at = place(node);
                    let share = 1.0 - norm(sub(at, met)) / reach;
                    let mut out = add_scaled(at, -dot(at, towards), towards);
                    out = scale(out, 1.0 / norm(out));
                    (share > 0.0).then(|| (node, scale(out, area * share)))
                });
                patches.push(patch.collect());
            }
            for end in [-1.0, 1.0] {
                let near = |at: Vec3| dot(at, towards) / libm::hypot(at[1], at[2]);
                let width = libm::cos(0.5 * TAU / self.pockets.len() as f64);
                let patch = self.land.iter().filter_map(|&(node, area)| {
                    let at = place(node);
                    let share = (near(at) - width) / (1.0 - width);
                    let out = scale([0.0, at[1], at[2]], 1.0 / libm::hypot(at[1], at[2]));
                    (share > 0.0 && end * at[0] > 0.0).then(|| (node, scale(out, area * share)))
                });
                patches.push(patch.collect());
            }
        }
        patches.retain(|patch: &Patch| !patch.is_empty());
        patches
    }
}

fn pocket_name(pocket: usize) -> String {
    format!("pocket_{pocket}")
}

fn faces<'m>(mesh: &'m TetMesh, name: &str) -> &'m [Face] {
    mesh.surface_sets.get(name).map_or(&[], Vec::as_slice)
}

/// Unit vector across X to the middle of places.
fn direction(places: &[Vec3]) -> Vec3 {
    let sum = places.iter().fold([0.0; 3], |sum, place| add_scaled(sum, 1.0, *place));
    scale([0.0, sum[1], sum[2]], 1.0 / libm::hypot(sum[1], sum[2]))
}

impl PocketNodes {
    fn new(group: NodeGroup) -> PocketNodes {
        let towards = direction(&group.places);
        let aside = |place: &Vec3| norm(add_scaled(*place, -dot(*place, towards), towards));
        let innermost = group.places.iter().map(aside).fold(f64::INFINITY, f64::min);
        PocketNodes { group, towards, innermost }
    }
}

/// Number of azimuths at which the change of radius is recorded.
const GAUGES: usize = 36;

/// Radial displacement of the outer surface in sectors of azimuth, averaged over their nodes.
fn gauges(mesh: &TetMesh, outer: &[u32], reduction: &FloatingReduction) -> Vec<RadiusGauge> {
    let step = TAU / GAUGES as f64;
    let gauge = |index: usize| {
        let angle = step * index as f64;
        let (sin, cos) = libm::sincos(angle);
        let near = |node: &&u32| {
            let [_, y, z] = mesh.nodes[**node as usize];
            (y * cos + z * sin) / libm::hypot(y, z) >= libm::cos(0.5 * step)
        };
        let nodes: Vec<u32> = outer.iter().filter(near).copied().collect();
        let radial = |shape: &Vec<Vec3>| {
            let of = |node: &u32| {
                let ([_, y, z], [_, v, w]) = (mesh.nodes[*node as usize], shape[*node as usize]);
                (y * v + z * w) / libm::hypot(y, z)
            };
            nodes.iter().map(of).sum::<f64>() / nodes.len() as f64
        };
        let shape = reduction.shapes.iter().map(radial).collect();
        (!nodes.is_empty()).then_some(RadiusGauge { angle, shape })
    };
    (0..GAUGES).filter_map(gauge).collect()
}
