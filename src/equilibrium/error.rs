//! Errors of the equilibrium search.

use crate::solids::bore_equilibrium::BoreError;
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum StaticsError {
    #[error("{what} is {value}: every input of the static problem must be finite")]
    NotFinite { what: &'static str, value: f64 },
    #[error(
        "no equilibrium: {body} moves {travel:.3e} m along {coordinate}, farther than the {room:.3e} m \
         available. Nothing holds it in this direction, or the load is too large for what holds it. Hint: \
         prescribe a displacement or add a spring there{start}; change the direction of the load or reduce \
         it; or start a run in nominal positions (numerics.start = \"nominal\")",
        start = unsupported(coordinate)
    )]
    NoEquilibrium { body: String, coordinate: &'static str, travel: f64, room: f64 },
    #[error(
        "at this speed the force of internal damping of {body} (internal_damping) is as large as its elastic \
         force, so that the iteration does not converge. Hint: reduce the damping or the speed at the start, \
         or start in nominal positions (numerics.start = \"nominal\")"
    )]
    Dragged { body: String },
    #[error(
        "the unbalance on {body} tilts it so far that the direction of its own force changes: the iteration does not converge; take \
         less of it, a lower speed at the start, or stiffer supports, or start in nominal positions \
         (numerics.start = \"nominal\")"
    )]
    Unbalanced { body: String },
    #[error(
        "{ball} has found no equilibrium between the races: {unbalance:.1e} of the force on it is \
         unbalanced; hold or load the inner race differently, or leave the forces on balls out"
    )]
    BallNotSettled { ball: String, unbalance: f64 },
    #[error(
        "{ball} leaves its grooves: pressed {overlap:.3e} m deep at a contact angle of \
         {degrees:.1} deg, past the 90 deg where the races hold it; the load is too large for this \
         bearing, check it and its unit"
    )]
    BallOutside { ball: String, overlap: f64, degrees: f64 },
    #[error(
        "no equilibrium found in {iterations} iterations: unbalanced load {residual:.3e} N against \
         {allowed:.3e} N allowed; farthest from it is {body}, at x, y, z {position:?} m, tilts {tilts:?} rad"
    )]
    NotConverged {
        body: String,
        iterations: usize,
        residual: f64,
        allowed: f64,
        position: [f64; 3],
        tilts: [f64; 2],
    },
    #[error(
        "{spring} is pushed through the wall of its bushing: its sleeves are displaced by {across:.3e} m \
         across the axis, more than the wall of {wall:.3e} m; check loads and their units, or use a thicker \
         wall"
    )]
    ThroughWall { spring: String, across: f64, wall: f64 },
    #[error("the outer race{of} in its bore: {source}")]
    Seat { of: String, source: BoreError },
}

/// A length instead of a displacement is a frequent slip.
fn unsupported(coordinate: &str) -> String {
    let (kind, unit) =
        if coordinate.starts_with("tilt") { ("tilt", "deg") } else { ("displacement", "mm") };
    format!(
        " ({coordinate} = {{ {kind} = \"0 {unit}\" }} holds it; {coordinate} = \"0 {unit}\" of an outer race is where it starts)"
    )
}
