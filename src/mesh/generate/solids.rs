//! Bars, the block of the contact study, rings and shafts.

use crate::mesh::error::MeshError;
use crate::mesh::generate::grading::{graded, joined, uniform};
use crate::mesh::generate::hexahedra::Hexahedra;
use crate::mesh::generate::{Solid, between, divisions, ratio_between, with_sets};
use crate::mesh::select::Region;
use crate::mesh::surface::Surface;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI, TAU};

fn cuboid(x: &[f64], y: &[f64], z: &[f64]) -> Result<Solid, MeshError> {
    let mut cells = Hexahedra::default();
    cells.add_block([x.len() - 1, y.len() - 1, z.len() - 1], |[i, j, k]| [x[i], y[j], z[k]]);
    let mut sets = Vec::new();
    let names = [["x_low", "x_high"], ["y_low", "y_high"], ["z_low", "z_high"]];
    for (axis, stations) in [x, y, z].into_iter().enumerate() {
        let ends = [stations[0], stations[stations.len() - 1]];
        for (name, end) in names[axis].into_iter().zip(ends) {
            sets.push((name, Surface::plane(axis, end)));
        }
    }
    with_sets(cells.into_mesh()?, &sets, Vec::new())
}

/// A block with nodes at all combinations of ascending stations along X, Y and Z, m.
///
/// Surface and node sets: `x_low`, `x_high` and so on.
///
/// # Errors
/// [`MeshError::Dimension`] for fewer than two stations, or stations that are not ascending.
pub fn block(stations: [&[f64]; 3]) -> Result<Solid, MeshError> {
    for along in stations {
        divisions("cells along the block", along.len().saturating_sub(1), 1)?;
        for pair in along.windows(2) {
            between("distance of two stations", pair[1] - pair[0], 0.0, f64::INFINITY)?;
        }
    }
    cuboid(stations[0], stations[1], stations[2])
}

/// A straight bar from the origin along X, its section centred on the axis; `size` in m and `counts` of cells
/// along X, Y and Z.
///
/// Surface and node sets: `x_low`, `x_high` and so on.
///
/// # Errors
/// [`MeshError::Dimension`].
pub fn bar(size: [f64; 3], counts: [usize; 3]) -> Result<Solid, MeshError> {
    for axis in 0..3 {
        between("size of the bar", size[axis], 0.0, f64::INFINITY)?;
        divisions("cells along the bar", counts[axis], 1)?;
    }
    cuboid(
        &uniform(0.0, size[0], counts[0]),
        &uniform(-0.5 * size[1], 0.5 * size[1], counts[1]),
        &uniform(-0.5 * size[2], 0.5 * size[2], counts[2]),
    )
}

/// The cuboid of 2.3.2 under a cylinder, in half contact widths b: 8 b wide (Y), 5 b high
/// (Z, top at 0), 1 b deep (X), with a fine zone of 3 b × 1.5 b below the line of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactBlock {
    /// Half contact width b, m: the largest of the study. The source does not state it.
    pub half_width: f64,
    /// Cells per b in the fine zone.
    pub cells_per_half_width: usize,
    /// Cells along the depth.
    pub depth_cells: usize,
    /// Growth ratio of steps outside the fine zone; the source does not state it (1.25 is moderate).
    pub growth: f64,
}

/// Meshes the block. Sets: `z_high` (the loaded top), `z_low` (the bottom), `x_low` and so on.
///
/// # Errors
/// [`MeshError::Dimension`].
pub fn contact_block(block: &ContactBlock) -> Result<Solid, MeshError> {
    let b = block.half_width;
    between("half contact width", b, 0.0, f64::INFINITY)?;
    divisions("cells per half contact width", block.cells_per_half_width, 1)?;
    divisions("cells along the depth", block.depth_cells, 1)?;
    let fine = b / block.cells_per_half_width as f64;
    let fine_cells = |extent: f64| (extent * block.cells_per_half_width as f64).ceil() as usize;
    let mirrored = |stations: &[f64]| stations.iter().rev().map(|y| -y).collect::<Vec<f64>>();
    let outwards = graded(1.5 * b, 4.0 * b, fine * block.growth, block.growth)?;
    let middle = uniform(-1.5 * b, 1.5 * b, fine_cells(3.0));
    let y = joined(&[mirrored(&outwards), middle, outwards]);
    let downwards = graded(-1.5 * b, -5.0 * b, fine * block.growth, block.growth)?;
    let z = joined(&[uniform(0.0, -1.5 * b, fine_cells(1.5)), downwards]);
    let z: Vec<f64> = z.into_iter().rev().collect();
    cuboid(&uniform(0.0, b, block.depth_cells), &y, &z)
}

/// An annulus or bushing about the X axis, centred on the origin. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    pub inner_radius: f64,
    pub outer_radius: f64,
    pub width: f64,
}

/// Numbers of cells of a ring; radial steps grow by `radial_growth` from the bore outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingMesh {
    pub around: usize,
    pub radial: usize,
    pub axial: usize,
    pub radial_growth: f64,
}

/// Meshes a ring. Sets: `inner`, `outer`, `x_low`, `x_high`.
///
/// # Errors
/// [`MeshError::Dimension`].
pub fn ring(ring: &Ring, mesh: &RingMesh) -> Result<Solid, MeshError> {
    between("inner radius", ring.inner_radius, 0.0, ring.outer_radius)?;
    between("outer radius", ring.outer_radius, 0.0, f64::INFINITY)?;
    between("width", ring.width, 0.0, f64::INFINITY)?;
    divisions("cells around", mesh.around, 3)?;
    divisions("radial cells", mesh.radial, 1)?;
    divisions("axial cells", mesh.axial, 1)?;
    ratio_between("growth of radial steps", mesh.radial_growth, 0.01, 100.0)?;
    let radii = geometric(ring.inner_radius, ring.outer_radius, mesh.radial, mesh.radial_growth);
    let x = uniform(-0.5 * ring.width, 0.5 * ring.width, mesh.axial);
    let mut cells = Hexahedra::default();
    cells.add_block([mesh.axial, mesh.radial, mesh.around], |[i, j, k]| {
        let angle = TAU * k as f64 / mesh.around as f64;
        [x[i], radii[j] * libm::cos(angle), radii[j] * libm::sin(angle)]
    });
    let (inner, outer) = (Surface::about_x(ring.inner_radius), Surface::about_x(ring.outer_radius));
    let ends = [Surface::plane(0, x[0]), Surface::plane(0, x[mesh.axial])];
    let sets = [("inner", inner), ("outer", outer), ("x_low", ends[0]), ("x_high", ends[1])];
    with_sets(cells.into_mesh()?, &sets, vec![inner, outer])
}

/// Stations of `count` steps from `from` to `to`, each `growth` times the previous one.
pub(super) fn geometric(from: f64, to: f64, count: usize, growth: f64) -> Vec<f64> {
    let mut sums = vec![0.0];
    let mut step = 1.0;
    for i in 0..count {
        sums.push(sums[i] + step);
        step *= growth;
    }
    let total = sums[count];
    let station = |i: usize| if i == count { to } else { from + (to - from) * sums[i] / total };
    (0..=count).map(station).collect()
}

/// A solid shaft about X with a layer of nodes at each of `stations` (ascending, m) and more between
/// them, so that no layer is longer than `longest` (m); `around` is a multiple of 8, `radial` the number of
/// cells in the ring around the square core.
///
/// Sets: `outer`, `x_low`, `x_high`, and the node sets `station_1`, `station_2`, ….
///
/// # Errors
/// [`MeshError::Dimension`].
pub fn shaft(
    radius: f64,
    stations: &[f64],
    longest: f64,
    around: usize,
    radial: usize,
) -> Result<Solid, MeshError> {
    between("radius of the shaft", radius, 0.0, f64::INFINITY)?;
    between("longest layer", longest, 0.0, f64::INFINITY)?;
    check_around(around, radial)?;
    divisions("stations of the shaft", stations.len(), 2)?;
    let mut runs = Vec::new();
    for pair in stations.windows(2) {
        let length = pair[1] - pair[0];
        between("distance of two stations", length, 0.0, f64::INFINITY)?;
        let count = (length / longest).ceil() as usize;
        divisions("layers between two stations", count, 1)?;
        runs.push(uniform(pair[0], pair[1], count));
    }
    let x = joined(&runs);
    let mut cells = Hexahedra::default();
    disc(&mut cells, radius, around / 4, radial, &x);
    let outer = Surface::about_x(radius);
    let ends = [Surface::plane(0, x[0]), Surface::plane(0, x[x.len() - 1])];
    let sets = [("outer", outer), ("x_low", ends[0]), ("x_high", ends[1])];
    let mut solid = with_sets(cells.into_mesh()?, &sets, vec![outer])?;
    for (index, &station) in stations.iter().enumerate() {
        let region =
            Region::On { surface: Surface::plane(0, station), tolerance: 1e-9 * solid.mesh.size() };
        solid.mesh.add_node_set(&format!("station_{}", index + 1), &region)?;
    }
    Ok(solid)
}

pub(super) fn check_around(around: usize, radial: usize) -> Result<(), MeshError> {
    divisions("cells around the shaft", around, 8)?;
    divisions("radial cells", radial, 1)?;
    if around.is_multiple_of(8) {
        return Ok(());
    }
    let (what, allowed) = ("cells around the shaft", "multiples of 8".to_string());
    Err(MeshError::Dimension { what, value: around as f64, unit: "", allowed })
}

/// A disc: a core of `side` × `side` cells with curved borders, half way between a square and a circle, and four
/// blocks from its sides to the rim.
pub(super) fn disc(cells: &mut Hexahedra, radius: f64, side: usize, radial: usize, x: &[f64]) {
    /// Radius of the core's corners divided by that of the shaft.
    const CORE: f64 = 0.55;
    /// Curvature of the core's border, from a square (0) to a circle (1).
    const BULGE: f64 = 0.35;
    let layers = x.len() - 1;
    // Rim and border of the core over u in [-1, 1], a quarter of the circumference.
    let on_rim = |u: f64| {
        let angle = FRAC_PI_4 * u;
        [libm::cos(angle), libm::sin(angle)]
    };
    let border = |u: f64| {
        let [c, s] = on_rim(u);
        // Between the square and its circumscribed circle, nearer the square, which keeps the corners.
        let chord = [FRAC_1_SQRT_2, u * FRAC_1_SQRT_2];
        [(c, chord[0]), (s, chord[1])]
            .map(|(round, flat)| CORE * (BULGE * round + (1.0 - BULGE) * flat))
    };
    let unit = |i: usize| -1.0 + 2.0 * i as f64 / side as f64;
    // Transfinite interpolation: the four curved borders minus the corners counted twice.
    let corner = border(1.0)[0];
    let core = |u: f64, v: f64| {
        let (right, top) = (border(v), border(u));
        let y = u * right[0] + top[1] - u * corner;
        let z = v * top[0] + right[1] - v * corner;
        [y, z]
    };
    cells.add_block([layers, side, side], |[i, j, k]| {
        let [y, z] = core(unit(j), unit(k));
        [x[i], radius * y, radius * z]
    });
    for quarter in 0..4 {
        let turn = 0.5 * PI * quarter as f64;
        let (cos, sin) = (libm::cos(turn), libm::sin(turn));
        cells.add_block([layers, side, radial], |[i, j, k]| {
            let (inside, rim) = (border(unit(j)), on_rim(unit(j)));
            let part = k as f64 / radial as f64;
            let [a, b] = [0, 1].map(|c| inside[c] + (rim[c] - inside[c]) * part);
            [x[i], radius * (cos * a - sin * b), radius * (sin * a + cos * b)]
        });
    }
}
