//! What can be wrong with a housing and its bore.

use crate::scene::build::about::About;
use crate::scene::build::solid::SolidSetupError;
use crate::solids::model::SolidError;
use std::ops::RangeInclusive;
use thiserror::Error;

/// What the nodes under the race may stand for, as a part of the bore that it covers: two rows of nodes at
/// its edges and one between give 1.5 in a longer bore, and 0.5 where those at its edges are missed.
pub(crate) const SHARES: RangeInclusive<f64> = 0.6..=1.6;
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
        "housing.bore: all {count} nodes of \"{bore}\" under the race are held by [[solid.fixed]]: the bore cannot \
         give way, and nothing of the solid counts. AttachedStation another set, or write method = \"rigid\" in [housing]"
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
        "solid.fixed.{axis}: the housing of `quasi-static` and of `reduced` is held at zero; write \
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
                About::Item { table: "solid.fixed", index: *index, key }
            }
        })
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}
