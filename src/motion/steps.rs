//! Stages of each evaluation of a motion, read once from the plan items.

use crate::assembly::lists::Assembly;
use crate::members::flexible_shaft::{ElasticShaft, ShaftSteps};
use crate::members::steps::{BearingSteps, BodySteps};
use crate::members::unbalance::is_coupled;
use crate::plan::{Item, Stage, Subject, does};
use crate::solids::plan::SolidSteps;

/// Stages of an assembly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Steps {
    pub gravity: bool,
    pub springs: bool,
    pub bearings: Vec<BearingSteps>,
    /// Stages of each body.
    pub bodies: Vec<BodySteps>,
    /// Moving bodies, in their order.
    pub moving: Vec<usize>,
    /// Reduced solids and their housing fits.
    pub solids: Vec<(usize, SolidSteps)>,
    pub seats: Vec<usize>,
    /// Flexible shafts.
    pub shafts: Vec<(usize, ShaftSteps)>,
}

impl Steps {
    pub fn new(items: &[Item], assembly: &Assembly) -> Steps {
        let of = |stage: Stage, subject: Subject| does(items, stage, subject);
        let bearing = |index| {
            let of = |stage| of(stage, Subject::Bearing(index));
            BearingSteps {
                traction: of(Stage::Traction),
                damping: of(Stage::ContactDamping),
                raceway_profiles: of(Stage::RacewayProfiles),
                pockets: of(Stage::Pockets),
                guide: of(Stage::Guide),
                ball_contact: of(Stage::BallContact),
            }
        };
        let body = |index| {
            let of = |stage| of(stage, Subject::Body(index));
            BodySteps {
                foundation: of(Stage::Foundation),
                rotating_load: of(Stage::RotatingLoad),
                unbalance: of(Stage::Unbalance),
                unbalance_coupled: is_coupled(&assembly.bodies[index], index, &assembly.shafts),
                floating: assembly.floating.iter().position(|solid| solid.body == index),
            }
        };
        let bodies = 0..assembly.bodies.len();
        let solid = |index| {
            let of = |stage| of(stage, Subject::Solid(index));
            let acting = SolidSteps {
                supports: false,
                loads: of(Stage::Loads),
                gravity: of(Stage::Gravity),
                damping: of(Stage::Damping),
            };
            of(Stage::Reduced).then_some((index, acting))
        };
        let shaft = |(index, shaft): (usize, &ElasticShaft)| {
            let acts = |stage| of(stage, Subject::Body(shaft.body));
            let acting = ShaftSteps { loads: acts(Stage::Loads), damping: acts(Stage::Damping) };
            acts(Stage::Reduced).then_some((index, acting))
        };
        let solids = 0..assembly.solids.len();
        let seats = 0..assembly.seats.len();
        Steps {
            gravity: of(Stage::Gravity, Subject::Whole),
            springs: of(Stage::Springs, Subject::Whole),
            bearings: (0..assembly.bearings.len()).map(bearing).collect(),
            bodies: bodies.clone().map(body).collect(),
            moving: bodies.filter(|index| of(Stage::Motion, Subject::Body(*index))).collect(),
            solids: solids.filter_map(solid).collect(),
            shafts: assembly.shafts.iter().enumerate().filter_map(shaft).collect(),
            seats: seats.filter(|index| of(Stage::Seat, Subject::Seat(*index))).collect(),
        }
    }
}
