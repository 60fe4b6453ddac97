//! Bushings: hollow cylinders between two sleeves, graded towards the corners of bonded and free surfaces.

use crate::mesh::error::MeshError;
use crate::mesh::generate::hexahedra::Hexahedra;
use crate::mesh::generate::{Solid, between, divisions, ratio_between, with_sets};
use crate::mesh::surface::Surface;
use std::f64::consts::{PI, TAU};

/// A bushing about the X axis, centred on the origin. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bushing {
    pub inner_diameter: f64,
    /// Radial thickness of the wall.
    pub thickness: f64,
    pub length: f64,
}

/// Meshed part of a bushing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    #[default]
    Whole,
    /// The quarter with X, Y ≥ 0, for a sleeve that moves along Z.
    Quarter,
}

/// Cells of the part. Stations at a fraction s (0 to 1) from the middle of the wall to a sleeve, or from the
/// middle of the length to an end, are at 1 − (1 − s)^`grading`: 1 is uniform; 2 and 3 refine
/// towards the corners, where stresses are singular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BushingMesh {
    pub around: usize,
    /// An even number.
    pub radial: usize,
    /// An even number for the whole bushing.
    pub axial: usize,
    pub grading: f64,
    pub part: Part,
}

/// Meshes a bushing. Sets: `inner`, `outer`, `x_low`, `x_high`, and the free faces, `ends`; for a quarter also `y_low`,
/// a plane of symmetry like `x_low`.
///
/// # Errors
/// [`MeshError::Dimension`].
pub fn bushing(bushing: &Bushing, mesh: &BushingMesh) -> Result<Solid, MeshError> {
    between("inner diameter", bushing.inner_diameter, 0.0, f64::INFINITY)?;
    between("thickness", bushing.thickness, 0.0, f64::INFINITY)?;
    between("length", bushing.length, 0.0, f64::INFINITY)?;
    let whole = mesh.part == Part::Whole;
    divisions("cells around", mesh.around, if whole { 3 } else { 2 })?;
    divisions("radial cells", mesh.radial, 2)?;
    divisions("axial cells", mesh.axial, if whole { 2 } else { 1 })?;
    even("radial cells", mesh.radial)?;
    if whole {
        even("axial cells", mesh.axial)?;
    }
    ratio_between("grading", mesh.grading, 0.999_999, 10.0)?;
    let (inner, outer) =
        (0.5 * bushing.inner_diameter, 0.5 * bushing.inner_diameter + bushing.thickness);
    let radii = crowded(inner, outer, mesh.radial, mesh.grading);
    let ends = 0.5 * bushing.length;
    let x = match mesh.part {
        Part::Whole => crowded(-ends, ends, mesh.axial, mesh.grading),
        Part::Quarter => crowded(-ends, ends, 2 * mesh.axial, mesh.grading).split_off(mesh.axial),
    };
    let turn = if whole { TAU } else { PI };
    let mut cells = Hexahedra::default();
    cells.add_block([mesh.axial, mesh.radial, mesh.around], |[i, j, k]| {
        let angle = turn * k as f64 / mesh.around as f64;
        // The last station of a quarter is exactly at Y = 0.
        let sine = if !whole && k == mesh.around { 0.0 } else { libm::sin(angle) };
        [x[i], radii[j] * sine, radii[j] * libm::cos(angle)]
    });
    let curved = vec![Surface::about_x(inner), Surface::about_x(outer)];
    let mut sets = vec![
        ("inner", curved[0]),
        ("outer", curved[1]),
        ("x_low", Surface::plane(0, x[0])),
        ("x_high", Surface::plane(0, x[mesh.axial])),
    ];
    sets.push(("ends", Surface::plane(0, x[mesh.axial])));
    sets.push(match whole {
        true => ("ends", Surface::plane(0, x[0])),
        false => ("y_low", Surface::plane(1, 0.0)),
    });
    with_sets(cells.into_mesh()?, &sets, curved)
}

fn even(what: &'static str, count: usize) -> Result<(), MeshError> {
    if count.is_multiple_of(2) {
        return Ok(());
    }
    let allowed = "even numbers".to_string();
    Err(MeshError::Dimension { what, value: count as f64, unit: "", allowed })
}

/// An even number of cells graded towards both ends; the middle is a station.
fn crowded(from: f64, to: f64, count: usize, grading: f64) -> Vec<f64> {
    let middle = 0.5 * (from + to);
    let station = |i: usize| {
        let away = (2.0 * i as f64 - count as f64) / count as f64;
        let share = 1.0 - libm::pow(1.0 - away.abs(), grading);
        match i {
            0 => from,
            _ if i == count => to,
            _ => middle + 0.5 * (to - from) * share.copysign(away),
        }
    };
    (0..=count).map(station).collect()
}
