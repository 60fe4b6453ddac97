//! Housings A to D of 2.4: plane sections (Y, Z) about a bore, extruded along X.
//!
//! Their dimensions are in a figure that is not available, so each is an input. The section is meshed by
//! lines from the bore to an outline around it; the pillow block's base is outside that outline
//! and is added as separate blocks.

use crate::mesh::error::MeshError;
use crate::mesh::generate::grading::uniform;
use crate::mesh::generate::hexahedra::Hexahedra;
use crate::mesh::generate::outline::{Path, Point, between as part_way, on_circle};
use crate::mesh::generate::solids::geometric;
use crate::mesh::generate::{
    Ring, RingMesh, Solid, between, divisions, ratio_between, ring, with_sets,
};
use crate::mesh::surface::Surface;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A housing about a bore along X, centred on the origin. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Housing {
    /// Housing A: a square cuboid, fixed on its four sides.
    Square { bore_radius: f64, side: f64, depth: f64 },
    /// Housing B: the half of a pillow block below the bore's centre and its mirror image above; fixed at
    /// the bottom and at the top.
    MirroredPillowBlock(PillowBlock),
    /// Housing C: a pillow block, fixed at the bottom.
    PillowBlock(PillowBlock),
    /// Housing D: an annulus, fixed at its outer surface.
    Annulus { bore_radius: f64, outer_radius: f64, depth: f64 },
}

/// A pillow block: a base, two necks joined to it by fillets, and an annulus of uniform thickness above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PillowBlock {
    pub bore_radius: f64,
    /// Outer radius of the annulus.
    pub outer_radius: f64,
    /// Height of the bore's centre above the bottom.
    pub centre_height: f64,
    pub base_width: f64,
    pub base_height: f64,
    /// Outer width over both necks, at most the annulus' diameter.
    pub neck_width: f64,
    /// Radius of the fillets between necks and base.
    pub fillet_radius: f64,
    /// Length along the bore.
    pub depth: f64,
}

impl PillowBlock {
    /// Assumed proportions in multiples of the bore radius: annulus 1.4, centre height 1.8,
    /// base 4.2 × 0.55, neck width 2.5, fillets 0.35.
    pub fn proportioned(bore_radius: f64, depth: f64) -> PillowBlock {
        PillowBlock {
            bore_radius,
            outer_radius: 1.4 * bore_radius,
            centre_height: 1.8 * bore_radius,
            base_width: 4.2 * bore_radius,
            base_height: 0.55 * bore_radius,
            neck_width: 2.5 * bore_radius,
            fillet_radius: 0.35 * bore_radius,
            depth,
        }
    }
}

/// Numbers of cells of a housing: `around` the bore (a few more if fillets need them), from the bore to
/// the outline and along X; radial steps grow by `radial_growth` from the bore outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HousingMesh {
    pub around: usize,
    pub radial: usize,
    pub axial: usize,
    pub radial_growth: f64,
}

impl Housing {
    /// Meshes the housing. Sets: `bore`, `fixed` (the surface that the source fixes), `x_low`, `x_high`.
    ///
    /// # Errors
    /// [`MeshError::Dimension`] for inconsistent dimensions, [`MeshError::InvertedCell`]
    /// if the bore is too close to the outline.
    pub fn solid(&self, mesh: &HousingMesh) -> Result<Solid, MeshError> {
        divisions("cells around the bore", mesh.around, 8)?;
        divisions("radial cells", mesh.radial, 1)?;
        divisions("axial cells", mesh.axial, 1)?;
        ratio_between("growth of radial steps", mesh.radial_growth, 0.01, 100.0)?;
        match *self {
            Housing::Annulus { bore_radius, outer_radius, depth } => {
                between("bore radius", bore_radius, 0.0, outer_radius)?;
                let shape = Ring { inner_radius: bore_radius, outer_radius, width: depth };
                let HousingMesh { around, radial, axial, radial_growth } = *mesh;
                let mut solid = ring(&shape, &RingMesh { around, radial, axial, radial_growth })?;
                rename(&mut solid, "inner", "bore");
                rename(&mut solid, "outer", "fixed");
                Ok(solid)
            }
            Housing::Square { bore_radius, side, depth } => square(bore_radius, side, depth, mesh),
            Housing::PillowBlock(block) => pillow_block(&block, false, mesh),
            Housing::MirroredPillowBlock(block) => pillow_block(&block, true, mesh),
        }
    }
}

fn rename(solid: &mut Solid, from: &str, to: &str) {
    if let Some(faces) = solid.mesh.surface_sets.remove(from) {
        solid.mesh.surface_sets.insert(to.to_string(), faces);
    }
    if let Some(nodes) = solid.mesh.node_sets.remove(from) {
        solid.mesh.node_sets.insert(to.to_string(), nodes);
    }
}

/// Number of steps along a run of the outline for uniform cells at the bore.
fn steps(from: Point, to: Point, around: usize) -> usize {
    let sine = from[0] * to[1] - from[1] * to[0];
    let cosine = from[0] * to[0] + from[1] * to[1];
    let angle = libm::atan2(sine.abs(), cosine);
    ((angle / TAU * around as f64).round() as usize).max(1)
}

/// Cells between the bore and the closed loop `outline`, extruded along `x`. The loop begins
/// directly below the bore; points on the bore are equally spaced, so that short runs of the
/// outline, the fillets, do not give thin wedges.
fn add_core(
    cells: &mut Hexahedra,
    bore_radius: f64,
    outline: &[Point],
    mesh: &HousingMesh,
    x: &[f64],
) {
    let parts = geometric(0.0, 1.0, mesh.radial, mesh.radial_growth);
    let around = outline.len() - 1;
    cells.add_block([mesh.axial, mesh.radial, around], |[i, j, k]| {
        let angle = TAU * k as f64 / around as f64 - FRAC_PI_2;
        let [y, z] = part_way(on_circle([0.0; 2], bore_radius, angle), outline[k], parts[j]);
        [x[i], y, z]
    });
}

fn square(bore_radius: f64, side: f64, depth: f64, mesh: &HousingMesh) -> Result<Solid, MeshError> {
    between("side of the housing", side, 0.0, f64::INFINITY)?;
    between("bore radius", bore_radius, 0.0, 0.5 * side)?;
    between("depth", depth, 0.0, f64::INFINITY)?;
    let half = 0.5 * side;
    let eighth = mesh.around.div_ceil(8);
    let mut path = Path::from([0.0, -half]);
    for corner in [[half, -half], [half, 0.0], [half, half], [0.0, half]] {
        path.line_to(corner, eighth);
    }
    let x = uniform(-0.5 * depth, 0.5 * depth, mesh.axial);
    let mut cells = Hexahedra::default();
    add_core(&mut cells, bore_radius, &path.closed_by_mirror(0), mesh, &x);
    let bore = Surface::about_x(bore_radius);
    let mut sets = ends(&x);
    sets.push(("bore", bore));
    for axis in [1, 2] {
        sets.extend([-half, half].map(|at| ("fixed", Surface::plane(axis, at))));
    }
    with_sets(cells.into_mesh()?, &sets, vec![bore])
}

fn ends(x: &[f64]) -> Vec<(&'static str, Surface)> {
    vec![("x_low", Surface::plane(0, x[0])), ("x_high", Surface::plane(0, x[x.len() - 1]))]
}

/// Points of the pillow block's section on the side +Y, about the bore's centre.
struct Section {
    /// Point where the core's outline leaves the bottom.
    foot: Point,
    fillet_centre: Point,
    fillet_radius: f64,
    /// Points where the fillet ends in the neck and the core's outline begins to follow the surface, and
    /// where the neck ends in the annulus.
    neck_low: Point,
    neck_high: Point,
    outer_radius: f64,
    bottom: f64,
    base_top: f64,
    base_half: f64,
}

fn section(block: &PillowBlock) -> Result<Section, MeshError> {
    let PillowBlock { bore_radius, outer_radius, centre_height, .. } = *block;
    between("bore radius", bore_radius, 0.0, 0.5 * block.neck_width)?;
    between("outer radius", outer_radius, bore_radius, f64::INFINITY)?;
    between("centre height", centre_height, bore_radius, f64::INFINITY)?;
    between("fillet radius", block.fillet_radius, 0.0, f64::INFINITY)?;
    between("depth", block.depth, 0.0, f64::INFINITY)?;
    let neck = 0.5 * block.neck_width;
    // A neck as wide as the annulus meets it at the height of the centre.
    between("neck width", block.neck_width, 0.0, 2.0 * outer_radius * (1.0 + 1e-12))?;
    let drop = (outer_radius * outer_radius - neck * neck).max(0.0).sqrt();
    between("base height", block.base_height, 0.0, centre_height - drop - block.fillet_radius)?;
    let least_base = 2.0 * (neck + block.fillet_radius);
    between("base width", block.base_width, least_base, f64::INFINITY)?;
    let (bottom, base_top) = (-centre_height, block.base_height - centre_height);
    let fillet_centre = [neck + block.fillet_radius, base_top + block.fillet_radius];
    let neck_low = [neck, fillet_centre[1]];
    // From the fillet's upper end the core's outline leads inwards to the bottom: half way between
    // the fillet's tangent and the line to the bore, so that neither angle is acute.
    let foot = [(neck - 0.8 * (neck_low[1] - bottom)).max(0.3 * neck), bottom];
    Ok(Section {
        foot,
        fillet_centre,
        fillet_radius: block.fillet_radius,
        neck_low,
        neck_high: [neck, -drop],
        outer_radius,
        bottom,
        base_top,
        base_half: 0.5 * block.base_width,
    })
}

impl Section {
    /// The core's outline from the bottom's middle to the height of the centre, and the number of steps
    /// from the foot to the neck.
    fn lower_outline(&self, around: usize) -> (Path, usize) {
        let mut path = Path::from([0.0, self.bottom]);
        path.line_to(self.foot, steps(path.last(), self.foot, around));
        let rising = steps(self.foot, self.neck_low, around);
        path.line_to(self.neck_low, rising);
        path.line_to(self.neck_high, steps(self.neck_low, self.neck_high, around));
        if self.neck_high[1] < 0.0 {
            let start = libm::atan2(self.neck_high[1], self.neck_high[0]);
            let level = [self.outer_radius, 0.0];
            path.arc([0.0; 2], self.outer_radius, start, 0.0, steps(self.neck_high, level, around));
        }
        (path, rising)
    }

    /// The base next to the core: under the fillet, then to its end. `signs` mirror it.
    fn add_wing(
        &self,
        cells: &mut Hexahedra,
        rising: usize,
        cell: f64,
        signs: [f64; 2],
        x: &[f64],
    ) {
        let foot_end = [self.fillet_centre[0], self.bottom];
        let count = |length: f64| ((length / cell).ceil() as usize).clamp(1, 1000);
        let bend = count(FRAC_PI_2 * self.fillet_radius).max(3);
        let angles = uniform(PI, 1.5 * PI, bend);
        let up = uniform(0.0, 1.0, rising);
        let place = |i: usize, [y, z]: Point| [x[i], signs[0] * y, signs[1] * z];
        cells.add_block([x.len() - 1, bend, rising], |[i, j, k]| {
            let low = part_way(self.foot, foot_end, j as f64 / bend as f64);
            let high = on_circle(self.fillet_centre, self.fillet_radius, angles[j]);
            place(i, part_way(low, high, up[k]))
        });
        let straight = count(self.base_half - foot_end[0]);
        let y = uniform(foot_end[0], self.base_half, straight);
        cells.add_block([x.len() - 1, straight, rising], |[i, j, k]| {
            place(i, part_way([y[j], self.bottom], [y[j], self.base_top], up[k]))
        });
    }
}

fn pillow_block(
    block: &PillowBlock,
    mirrored: bool,
    mesh: &HousingMesh,
) -> Result<Solid, MeshError> {
    let section = section(block)?;
    let x = uniform(-0.5 * block.depth, 0.5 * block.depth, mesh.axial);
    let (mut path, rising) = section.lower_outline(mesh.around);
    if mirrored {
        path = Path(path.closed_by_mirror(1));
    } else {
        let quarter = mesh.around.div_ceil(4);
        path.arc([0.0; 2], section.outer_radius, 0.0, FRAC_PI_2, quarter);
    }
    // The top is on the mirror plane up to rounding.
    if let Some(top) = path.0.last_mut() {
        top[0] = 0.0;
    }
    let mut cells = Hexahedra::default();
    add_core(&mut cells, block.bore_radius, &path.closed_by_mirror(0), mesh, &x);
    let cell = TAU * block.bore_radius / mesh.around as f64;
    let heights: &[f64] = if mirrored { &[1.0, -1.0] } else { &[1.0] };
    for &height in heights {
        for side in [1.0, -1.0] {
            section.add_wing(&mut cells, rising, cell, [side, height], &x);
        }
    }
    let bore = Surface::about_x(block.bore_radius);
    let mut sets = ends(&x);
    sets.push(("bore", bore));
    let mut curved = vec![bore, Surface::about_x(block.outer_radius)];
    for &height in heights {
        sets.push(("fixed", Surface::plane(2, height * section.bottom)));
        for side in [1.0, -1.0] {
            let [y, z] = section.fillet_centre;
            curved.push(Surface::Cylinder {
                point: [0.0, side * y, height * z],
                axis: [1.0, 0.0, 0.0],
                radius: section.fillet_radius,
            });
        }
    }
    with_sets(cells.into_mesh()?, &sets, curved)
}
