//! Stepped shafts: consecutive round sections, solid or hollow.

use crate::mesh::error::MeshError;
use crate::mesh::generate::hexahedra::Hexahedra;
use crate::mesh::generate::solids::{check_around, disc};
use crate::mesh::generate::{Solid, between, divisions, with_sets};
use crate::mesh::surface::Surface;
use std::f64::consts::TAU;

/// A length of one section about X. Lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftStep {
    /// Axial positions of the node layers, ascending; the first is the last of the previous step.
    pub layers: Vec<f64>,
    /// Inner radius; 0 for a solid section.
    pub inner_radius: f64,
    pub outer_radius: f64,
}

/// Difference below which radii are equal, divided by the largest radius.
const NEAR: f64 = 1e-9;
/// Fraction of the innermost radius covered by its outer ring of cells ([`disc`]).
const RING: f64 = 0.45;

/// Meshes a shaft of steps with `around` cells (a multiple of 8) around the circumference and `radial` cells in the ring around
/// the square core. The rings outside it, between the radii of all steps, have cells of that size.
///
/// Sets: `outer`, `x_low`, `x_high`.
///
/// # Errors
/// [`MeshError::Dimension`].
pub fn stepped_shaft(
    steps: &[ShaftStep],
    around: usize,
    radial: usize,
) -> Result<Solid, MeshError> {
    check_around(around, radial)?;
    divisions("steps of the shaft", steps.len(), 1)?;
    for step in steps {
        between("outer radius", step.outer_radius, 0.0, f64::INFINITY)?;
        if step.inner_radius != 0.0 {
            between("inner radius", step.inner_radius, 0.0, step.outer_radius)?;
        }
        divisions("layers of a step", step.layers.len(), 2)?;
        for pair in step.layers.windows(2) {
            between("longest layer", pair[1] - pair[0], 0.0, f64::INFINITY)?;
        }
    }
    let mut radii: Vec<f64> =
        steps.iter().flat_map(|step| [step.inner_radius, step.outer_radius]).collect();
    radii.sort_by(f64::total_cmp);
    let near = NEAR * radii[radii.len() - 1];
    radii.retain(|radius| *radius > 0.0);
    radii.dedup_by(|large, small| *large - *small <= near);

    let cell = RING * radii[0] / radial as f64;
    let mut cells = Hexahedra::default();
    for step in steps {
        if step.inner_radius == 0.0 {
            disc(&mut cells, radii[0], around / 4, radial, &step.layers);
        }
        for pair in radii.windows(2) {
            let is_inside =
                step.inner_radius <= pair[0] + near && pair[1] <= step.outer_radius + near;
            if is_inside {
                let count = ((pair[1] - pair[0]) / cell).round().max(1.0) as usize;
                divisions("radial cells", count, 1)?;
                ring(&mut cells, [pair[0], pair[1]], around, count, &step.layers);
            }
        }
    }
    let curved: Vec<Surface> = radii.iter().map(|radius| Surface::about_x(*radius)).collect();
    let last = &steps[steps.len() - 1].layers;
    let mut sets = vec![
        ("x_low", Surface::plane(0, steps[0].layers[0])),
        ("x_high", Surface::plane(0, last[last.len() - 1])),
    ];
    let mut outer: Vec<f64> = steps.iter().map(|step| step.outer_radius).collect();
    outer.sort_by(f64::total_cmp);
    outer.dedup_by(|large, small| *large - *small <= near);
    sets.extend(outer.into_iter().map(|radius| ("outer", Surface::about_x(radius))));
    with_sets(cells.into_mesh()?, &sets, curved)
}

/// A ring whose nodes at the inner radius are those of [`disc`] at its rim.
fn ring(cells: &mut Hexahedra, radii: [f64; 2], around: usize, radial: usize, x: &[f64]) {
    cells.add_block([x.len() - 1, radial, around], |[i, j, k]| {
        let angle = TAU * k as f64 / around as f64;
        let part = j as f64 / radial as f64;
        let radius = radii[0] + (radii[1] - radii[0]) * part;
        [x[i], radius * libm::cos(angle), radius * libm::sin(angle)]
    });
}
