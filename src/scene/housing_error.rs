//! Errors of a housing and its bore.

use crate::scene::build::about::About;
use crate::scene::build::solid::SolidSetupError;
use crate::solids::error::SolidError;
use std::ops::RangeInclusive;
use thiserror::Error;

/// Allowed ratio of the area represented by the contact nodes to the bore area under the race. In a longer
/// bore, two rows of nodes at the race's edges and one between give 1.5, and 0.5 without those at the edges.
pub(crate) const SHARES: RangeInclusive<f64> = 0.6..=1.6;
#[derive(Clone, Debug, PartialEq, Error)]
pub enum HousingSetupError {
    #[error(transparent)]
    Solid(#[from] SolidSetupError),
    #[error(transparent)]
    Model(#[from] SolidError),
    #[error(
        "housing.bore: the solid has no surface \"{bore}\"; its surfaces are: {}. Hint: the bore of a ring \
         is \"inner\"",
        list(known)
    )]
    NoBore { bore: String, known: Vec<String> },
    #[error(
        "housing.width: none of the {count} nodes of the bore is under the outer race, which is \
         {:.4} mm wide and centred at x = {:.4} mm: {lies}. Hint: {MOVE}; also check width, position and the mesh's unit",
        1e3 * *.width, 1e3 * *.centre
    )]
    NoNodesUnderRace { count: usize, width: f64, centre: f64, lies: Lies },
    #[error(
        "housing.bore: \"{bore}\" is flat: all its {faces} faces, {:.4} mm^2, have the normal ({:.3}, {:.3}, {:.3}). Name \
         a cylinder about the race's axis; the solid's surfaces are: {}",
        1e6 * *.area, normal[0], normal[1], normal[2], list(known)
    )]
    FlatBore { bore: String, faces: usize, area: f64, normal: [f64; 3], known: Vec<String> },
    #[error(
        "housing.bore: the bore has a radius of {:.4} mm, but the outer race about {:.4} mm. Allowed: a difference of 1 %. \
         Hint: is the mesh's unit (solid.mesh.unit) mm or m? Is \"{bore}\" the right surface, and the race's \
         outer_radius right?",
        1e3 * *.radius, 1e3 * *.race
    )]
    FarFromTheRace { bore: String, radius: f64, race: f64 },
    #[error(
        "housing.bore: nodes of \"{bore}\" are {:.4} to {:.4} mm from the bearing's axis (along X through its \
         centre), which is not a bore about it; {lies}. Hint: {MOVE}; also check the name of the surface",
        1e3 * *.nearest, 1e3 * *.farthest
    )]
    NotRound { bore: String, nearest: f64, farthest: f64, lies: Lies },
    #[error(
        "housing.bore: the element edges of \"{bore}\" are straight: its mid-side nodes, which the race \
         touches, are up to {:.3} um inside the cylinder of radius {:.4} mm through the corner nodes. Curved \
         edges would have an arc height of {:.3} um, and {:.0} % of it is missing. Hint: mesh it with curved \
         edges (in Gmsh Mesh.SecondOrderLinear = 0, and Mesh.HighOrderOptimize = 0 if that straightened \
         them), or save it with first-order elements and write order = 2 in [solid.mesh]",
        1e6 * *.inside, 1e3 * *.radius, 1e6 * *.sagitta, 1e2 * *.missing
    )]
    StraightBore { bore: String, radius: f64, inside: f64, sagitta: f64, missing: f64 },
    #[error(
        "housing.bore: nodes of \"{bore}\" are up to {:.3} um off its cylinder of radius {:.4} mm; allowed: \
         {:.3} um, as for IT7. Hint: does the set contain faces outside the bore? Are coordinates written with \
         all digits, and mid-side nodes on the curved surface?",
        1e6 * *.off, 1e3 * *.radius, 1e6 * *.limit
    )]
    OutOfRound { bore: String, radius: f64, off: f64, limit: f64 },
    #[error(
        "housing.width: contact nodes represent {share:.2} of the bore area under a race {:.4} mm wide; \
         allowed: {} to {}{}",
        1e3 * *.width, SHARES.start(), SHARES.end(), seat_hint(.beside)
    )]
    CoarseBore { width: f64, share: f64, beside: Option<String> },
    #[error(
        "housing.width: the {count} nodes of the bore under the outer race, {:.4} mm wide, are in one row around it, \
         {:+.4} mm from its middle, which cannot resist tilt; at least two rows are needed. Hint: refine the mesh \
         along the axis (cells.axial of a generated mesh, or order = 2 in [solid.mesh]), or give a width that covers \
         two rows",
        1e3 * *.width, 1e3 * *.at
    )]
    OneRow { count: usize, width: f64, at: f64 },
    #[error(
        "housing.bore: all {count} nodes of \"{bore}\" under the race are fixed by [[solid.fixed]], so the bore cannot \
         deform. Hint: fix another set, or write method = \"rigid\" in [housing]"
    )]
    FixedBore { bore: String, count: usize },
    #[error(
        "solid.load: the housing method `quasi-static` needs constant loads; write method = \
         \"explicit\" in [housing]"
    )]
    VaryingLoad { index: usize },
    #[error(
        "solid.fixed.{axis}: the housing methods `quasi-static` and `reduced` need supports at zero; write \
         {axis} = true, or method = \"explicit\" in [housing]"
    )]
    PrescribedSupport { index: usize, axis: &'static str },
}

/// Hint for a mesh that is not at its bearing.
const MOVE: &str = "solid.mesh.origin is the point, in the mesh's coordinates, that becomes the bearing's centre, solid.mesh.axis the \
                    mesh's axis along the bore";

fn seat_hint(beside: &Option<String>) -> String {
    match beside {
        Some(beside) => format!(": {beside}; or move the mesh: {MOVE}"),
        None => {
            ". Hint: refine the mesh along the axis, or place rows of nodes at the race's edges"
                .into()
        }
    }
}

/// Bounding box of a surface's nodes relative to the race's centre, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lies {
    low: [f64; 3],
    high: [f64; 3],
}

impl Lies {
    pub(crate) fn of(seen: &[[f64; 3]]) -> Lies {
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
        write!(f, "relative to the bearing's centre it is at X {x}, Y {y}, Z {z} mm")
    }
}

impl HousingSetupError {
    /// Part of the scene that the error is about; `None` for a model that cannot be set up.
    pub fn about(&self) -> Option<About> {
        Some(match self {
            HousingSetupError::Solid(error) => error.about(),
            HousingSetupError::Model(_) => return None,
            HousingSetupError::NoBore { .. }
            | HousingSetupError::FlatBore { .. }
            | HousingSetupError::FarFromTheRace { .. }
            | HousingSetupError::NotRound { .. }
            | HousingSetupError::FixedBore { .. }
            | HousingSetupError::OutOfRound { .. } => About::key("housing.bore"),
            HousingSetupError::StraightBore { .. } => About::key("solid.mesh.file"),
            HousingSetupError::NoNodesUnderRace { .. }
            | HousingSetupError::OneRow { .. }
            | HousingSetupError::CoarseBore { .. } => About::key("housing.width"),
            HousingSetupError::VaryingLoad { index } => {
                About::Item { table: "solid.load", index: *index, key: "set" }
            }
            HousingSetupError::PrescribedSupport { index, axis: key } => {
                About::Item { table: "solid.fixed", index: *index, key }
            }
        })
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}
