//! Plan items of an equilibrium: each evaluation of the search.

use crate::ch2_housing::bearing::geometry::BearingKind;
use crate::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticBearing};
use crate::members::body::GROUND;
use crate::plan::{Item, Stage, Subject, does, no_solids};
use nalgebra::Vector3;

/// Reason for centrifugal forces on balls.
pub const ASKED_FOR: &str = "requested, with a speed of the inner race";

/// Items of statics; `solids` are those of flexible solids, `centrifugal` is the reason for centrifugal forces on
/// balls.
pub fn items(assembly: &StaticAssembly, solids: Vec<Item>, centrifugal: &str) -> Vec<Item> {
    let mut items = Vec::new();
    for (index, bearing) in assembly.bearings.iter().enumerate() {
        let own = of_bearing(bearing, Subject::Bearing(index), centrifugal);
        items.extend(own.into_iter().map(|item| item.named(bearing.name.clone())));
    }
    let why = "energy, load and stiffness at one position of all bodies";
    items.push(Item::does(Stage::Evaluation, Subject::Whole, why).costing(1));
    items.push(equilibrium(assembly));
    for (index, body) in assembly.bodies.iter().enumerate() {
        if matches!(body.place, Place::Fixed(_)) && body.name != GROUND {
            let of = body.name.strip_prefix("the ").unwrap_or(&body.name);
            let why = "its position is prescribed: no equations for it";
            items.push(Item::skips(Stage::Motion, Subject::Body(index), why).named(Some(of)));
        }
    }
    items.push(match springs_to_ground(assembly) {
        0 => Item::skips(Stage::Foundation, Subject::Whole, "no body has a foundation"),
        some => {
            Item::does(Stage::Foundation, Subject::Whole, format!("{some} springs to the ground"))
                .costing(some as u64)
        }
    });
    items.push(match (assembly.connections.len(), assembly.shafts.len()) {
        (0, 0) => Item::skips(Stage::Springs, Subject::Whole, "none is given"),
        (some, shafts) => {
            let and =
                if shafts == 0 { String::new() } else { format!(", {shafts} elastic shafts") };
            Item::does(Stage::Springs, Subject::Whole, format!("{some} of them{and}"))
                .costing((some + shafts) as u64)
        }
    });
    let flexible = !(solids.is_empty() && assembly.seats.is_empty());
    if !flexible {
        items.push(no_solids());
    }
    items.extend(solids);
    let seats = assembly.seats.iter().enumerate();
    items.extend(seats.map(|(i, of)| seat(i, &assembly.bodies[of.mount.body].name)));
    items
}

/// A race in the bore of a condensed solid, the `index`-th.
pub fn seat(index: usize, race: &str) -> Item {
    let why = format!("{race} in its bore: contact on one side only, in the same search");
    Item::does(Stage::Seat, Subject::Seat(index), why).costing(1)
}

fn of_bearing(bearing: &StaticBearing, subject: Subject, centrifugal: &str) -> Vec<Item> {
    let balls = bearing.geometry.ball_count;
    let angles = match bearing.geometry.kind {
        BearingKind::DeepGroove => "contact angles follow from the position of both races",
        BearingKind::AngularContact => {
            "contact angles follow from the position of both races, starting at the nominal one"
        }
    };
    let turns = bearing.centrifugal != 0.0;
    let gravity = match (bearing.weight != Vector3::zeros(), turns) {
        (true, _) => Item::does(Stage::BallGravity, subject, "gravity is given"),
        (false, true) => Item::skips(Stage::BallGravity, subject, "no gravity is given"),
        (false, false) => {
            let why = "no gravity: a ball with room is left out";
            Item::skips(Stage::BallGravity, subject, why)
        }
    };
    let outwards = match turns {
        true => Item::does(Stage::CentrifugalForce, subject, centrifugal),
        false => {
            let why = "not requested, or the bearing does not rotate";
            Item::skips(Stage::CentrifugalForce, subject, why)
        }
    };
    let tests = format!("{balls} balls, two races each; an open pair costs nothing more");
    vec![
        Item::does(Stage::DistanceTest, subject, tests).costing(balls as u64),
        Item::does(Stage::BallEquilibrium, subject, angles),
        gravity,
        outwards,
        Item::skips(Stage::Traction, subject, "statics has no sliding: no slices, no spin moment"),
        Item::skips(Stage::Pockets, subject, "statics fixes each ball at its azimuth"),
    ]
}

fn equilibrium(assembly: &StaticAssembly) -> Item {
    let (stage, subject) = (Stage::Equilibrium, Subject::Whole);
    let shapes: usize = assembly.shafts.iter().map(|shaft| shaft.springs.len()).sum();
    match free_coordinates(assembly) {
        (free, bodies) if shapes > 0 => {
            let why = format!(
                "{free} free coordinates of {bodies} bodies and {shapes} modal amplitudes in one search"
            );
            Item::does(stage, subject, why)
        }
        (0, _) => Item::skips(stage, subject, "all coordinates are prescribed: one evaluation"),
        (free, 1) => Item::does(stage, subject, format!("{free} of 5 coordinates are free")),
        (free, bodies) => {
            let why = format!("{free} free coordinates of {bodies} bodies in one search");
            Item::does(stage, subject, why)
        }
    }
}

fn loaded<'s>(assembly: &'s StaticAssembly) -> impl Iterator<Item = &'s Loaded> {
    assembly.bodies.iter().filter_map(|body| match &body.place {
        Place::Fixed(_) | Place::Section(_) => None,
        Place::Loaded(loaded) => Some(loaded),
    })
}

/// Number of coordinates that follow from loads, and of bodies that have any.
fn free_coordinates(assembly: &StaticAssembly) -> (usize, usize) {
    let free =
        loaded(assembly).map(|body| (0..5).filter(|i| body.prescribed(*i).is_none()).count());
    free.fold((0, 0), |(all, bodies), own| (all + own, bodies + usize::from(own > 0)))
}

fn springs_to_ground(assembly: &StaticAssembly) -> usize {
    loaded(assembly).flat_map(|body| body.springs).filter(|spring| *spring != 0.0).count()
}

/// Stages of each evaluation, read from the items.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StaticSteps {
    pub search: bool,
    pub foundation: bool,
    pub springs: bool,
    /// For each bearing: gravity on its balls, centrifugal force on them.
    pub ball_forces: Vec<[bool; 2]>,
    pub seats: Vec<bool>,
}

impl StaticSteps {
    pub fn new(items: &[Item], assembly: &StaticAssembly) -> StaticSteps {
        let whole = |stage| does(items, stage, Subject::Whole);
        let of_bearing = |index| {
            [Stage::BallGravity, Stage::CentrifugalForce]
                .map(|stage| does(items, stage, Subject::Bearing(index)))
        };
        let seats = 0..assembly.seats.len();
        StaticSteps {
            search: whole(Stage::Equilibrium),
            foundation: whole(Stage::Foundation),
            springs: whole(Stage::Springs),
            ball_forces: (0..assembly.bearings.len()).map(of_bearing).collect(),
            seats: seats.map(|index| does(items, Stage::Seat, Subject::Seat(index))).collect(),
        }
    }
}
