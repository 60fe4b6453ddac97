//! How far the springs that stand for a bushing of a scene hold.

use crate::mesh::generate::{BushingMesh, Part, bushing};
use crate::scene::build::assembly::BushingOfSpring;
use crate::solids::rubber::holds::{holds, lever};
use crate::solids::rubber::sleeve::SleeveMotion;

/// Part by which relaxed rubber may push back harder or softer than the springs: as much as their own mesh may miss.
pub const PART: f64 = 0.02;
/// The whole bushing, for what follows from ratios of stiffnesses on one mesh: the elements of
/// this one are too stiff against each other's strains, so that the amplitude comes out up to 30 % less than on finer ones, on the
/// safe side.
const MESH: BushingMesh =
    BushingMesh { around: 12, radial: 2, axial: 4, grading: 1.0, part: Part::Whole };

/// Of the wall: so far springs are taken to hold without a look. The difference grows with the square of the amplitude, so that rubber which is
/// off by [`PART`] here would be off by half at 5 % of its wall.
const UNASKED: f64 = 0.01;

/// Amplitude of a motion, m or rad, at which the springs stop holding by [`PART`]; infinite beyond what is looked at.
///
/// # Errors
/// Why it could not be found, in words.
pub fn reach(of: &BushingOfSpring, motion: SleeveMotion) -> Result<f64, String> {
    let solid = bushing(&of.body, &MESH).and_then(|solid| solid.quadratic());
    let solid = solid.map_err(|error| error.to_string())?;
    holds(&solid.mesh, &of.body, &of.material, motion, PART).map_err(|error| error.to_string())
}

/// Amplitude of a motion, m or rad, up to which springs are taken to hold without asking [`reach`].
pub fn unasked(of: &BushingOfSpring, motion: SleeveMotion) -> f64 {
    UNASKED * of.body.thickness / lever(motion, &of.body)
}
