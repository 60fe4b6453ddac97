//! Plan items of a motion: evaluation of the forces, start, steps, records.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::cage::{Guidance, Pocket};
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::ch4_rotor::bore_friction::BoreFriction;
use crate::ch5_cage::raceway_profile::RacewayProfile;
use crate::members::ball_set::neighbours;
use crate::members::bearing::{BallMeeting, Bearing};
use crate::members::body::{Body, Drive, DrivenBody, GROUND, Mobility, Rotation};
use crate::members::dent_table::Fineness;
use crate::motion::plan_shaft::bending;
use crate::motion::simulation::{Integrator, RunOptions, Start, Stepping};
use crate::numeric::clock::rounded;
use crate::plan::channels::ChannelGroup;
use crate::plan::{Item, Stage, Subject, no_solids};

/// A run of an assembly.
#[derive(Clone, Debug)]
pub struct Planned<'p> {
    pub assembly: &'p Assembly,
    pub options: &'p RunOptions,
    pub channels: &'p [ChannelGroup],
    /// For each bearing, why it has no cage although its scene has one.
    pub cage_left_out: &'p [Option<&'p str>],
    /// Items of flexible solids in steps of their own.
    pub solids: Vec<Item>,
}

/// All items of a run: start and step, one evaluation, solids, records.
pub fn items(run: Planned) -> Vec<Item> {
    let Planned { assembly, options, channels, cage_left_out, solids } = run;
    let mut items = vec![start(options.start), step_size(options)];
    items.extend(evaluation(assembly, cage_left_out));
    if solids.is_empty() && assembly.solids.is_empty() {
        items.push(no_solids());
    }
    items.extend(solids);
    items.extend(ChannelGroup::ALL.map(|group| channel_group(assembly, channels, group)));
    if !assembly.sensors.is_empty() {
        let names: Vec<&str> = assembly.sensors.iter().map(|of| of.name.as_str()).collect();
        let why = format!("{}: read at every output", names.join(", "));
        items.push(Item::does(Stage::Sensors, Subject::Whole, why));
    }
    items
}

/// Items of one evaluation of the forces, in the order of the work.
///
/// `cage_left_out` says why a bearing has no cage although its scene has one; one entry for each bearing, or none.
pub fn evaluation(assembly: &Assembly, cage_left_out: &[Option<&str>]) -> Vec<Item> {
    let mut items = Vec::new();
    for (index, bearing) in assembly.bearings.iter().enumerate() {
        let left_out = cage_left_out.get(index).copied().flatten();
        items.extend(of_bearing(bearing, Subject::Bearing(index), left_out));
    }
    items.push(springs(assembly));
    items.extend(reduced_solids(assembly));
    items.extend(assembly.shafts.iter().flat_map(|shaft| bending(shaft, assembly)));
    items.extend(assembly.floating.iter().map(|solid| {
        let why = match solid.count() {
            0 => "rigid, with the inertia of its mesh".into(),
            count => format!("{count} modes in a frame that rotates with it"),
        };
        let item = Item::does(Stage::Reduced, Subject::Body(solid.body), why).costing(1);
        item.named(Some(bare(&assembly.bodies[solid.body].name)))
    }));
    items.push(gravity(assembly));
    let bodies = || assembly.bodies.iter().enumerate();
    items.extend(bodies().filter_map(|(index, body)| motion(body, Subject::Body(index))));
    let each = |stage: Stage, none: &str, why: &str, has: &dyn Fn(&Body) -> bool| {
        let with = bodies().filter(|(_, body)| has(body));
        let found: Vec<Item> = with
            .map(|(index, body)| {
                let item = Item::does(stage, Subject::Body(index), format!("{why} {}", body.name));
                item.named(body.label.clone()).costing(1)
            })
            .collect();
        match found.is_empty() {
            true => vec![Item::skips(stage, Subject::Whole, none)],
            false => found,
        }
    };
    let ground = "springs or dashpots to the ground under";
    items.extend(each(Stage::Foundation, "no spring or dashpot to the ground", ground, &|body| {
        body.driven().is_some_and(stands_on_ground)
    }));
    items.extend(each(Stage::RotatingLoad, "none is given", "given; on", &|body| {
        body.driven().is_some() && body.rotating_load.is_some()
    }));
    let along_shafts = assembly.shafts.iter().any(|shaft| !shaft.unbalances.is_empty());
    let none = match along_shafts {
        true => "loads along flexible shafts are among their loads",
        false => "none is given",
    };
    items.extend(each(Stage::Unbalance, none, "given; of", &|body| {
        body.driven().is_some() && body.unbalance != 0.0
    }));
    let kept = "work and losses, in every evaluation";
    items.push(Item::does(Stage::Ledger, Subject::Whole, kept).costing(1));
    items
}

fn of_bearing(bearing: &Bearing, subject: Subject, left_out: Option<&str>) -> Vec<Item> {
    let balls = bearing.geometry.ball_count;
    let why = format!("{balls} balls, two races each; a pair with room costs nothing more");
    let mut items = vec![
        Item::does(Stage::DistanceTest, subject, why).costing(2 * balls as u64),
        traction(bearing, subject),
        contact_damping(bearing, subject),
    ];
    items.extend(raceway_profiles(bearing, subject));
    items.extend(cage(bearing, subject, left_out));
    items.push(ball_contact(bearing, subject));
    items.into_iter().map(|item| item.named(bearing.name.clone())).collect()
}

fn springs(assembly: &Assembly) -> Item {
    match assembly.connections.len() {
        0 => Item::skips(Stage::Springs, Subject::Whole, "none is given"),
        some => Item::does(Stage::Springs, Subject::Whole, format!("{some} of them"))
            .costing(some as u64),
    }
}

/// Reduced solids, and the races in their bores.
fn reduced_solids(assembly: &Assembly) -> Vec<Item> {
    let solids = assembly.solids.iter().enumerate().flat_map(|(index, solid)| {
        let why = "modes of the housing, which move with the bearing in its steps";
        let label = assembly.seats.iter().find(|seat| seat.solid == index);
        let label = label.and_then(|seat| seat.label.as_ref());
        let of = label.map_or_else(|| bare(&solid.name), |label| format!("housing {label}"));
        let subject = Subject::Solid(index);
        let acts = |stage, does, why: &str| {
            let why = if does { why } else { "none is given" };
            Item::new(stage, subject, does, why)
        };
        let loads = solid.loads.len();
        let weighs = solid.weight.iter().any(|weight| *weight != 0.0);
        let own = [
            Item::does(Stage::Reduced, subject, why).costing(1),
            acts(Stage::Loads, loads > 0, &format!("{loads}, on its modes")),
            acts(Stage::Gravity, weighs, "on its modes"),
            acts(Stage::Damping, solid.damping != 0.0, "mass-proportional, of all motion"),
        ];
        own.map(|item| item.named(Some(of.clone())))
    });
    let seats = assembly.seats.iter().enumerate().map(|(index, seat)| {
        let why = format!("{} in its bore, every node of it", assembly.bodies[seat.race.body].name);
        Item::does(Stage::Seat, Subject::Seat(index), why).named(seat.label.clone()).costing(1)
    });
    solids.chain(seats).collect()
}

/// A race in the bore of a solid in explicit steps: the `index`-th housing fit, its body and its name.
pub fn stepped_seat(
    assembly: &Assembly,
    index: usize,
    (body, name): (usize, Option<&str>),
    friction: Option<&BoreFriction>,
) -> impl Iterator<Item = Item> {
    let race = &assembly.bodies[body].name;
    let why = format!("{race} in its bore, in every step of the housing");
    let seat = Item::does(Stage::Seat, Subject::Seat(index), why).named(name);
    let why = format!("on {race}, the mean of each coupling step");
    let impulses = Item::does(Stage::Impulses, Subject::Body(body), why).named(name);
    let friction = friction.map(|BoreFriction { coefficient, stretch }| {
        let why = format!(
             "a spring at every contact node, which slips at {coefficient} of the normal load, elongated by {} nm or more",
            rounded(1e9 * stretch)
        );
        Item::does(Stage::BoreFriction, Subject::Seat(index), why).named(name)
    });
    [seat].into_iter().chain(friction).chain([impulses])
}

fn gravity(assembly: &Assembly) -> Item {
    if assembly.gravity == [0.0; 3] {
        return Item::skips(Stage::Gravity, Subject::Whole, "none is given");
    }
    let balls: usize = assembly.bearings.iter().map(|b| b.geometry.ball_count).sum();
    let bodies = assembly.bodies.iter().filter(|body| body.inertia().is_some()).count();
    Item::does(Stage::Gravity, Subject::Whole, "given; it acts on every body that moves")
        .costing((balls + bodies) as u64)
}

/// "outer race" for "the outer race".
fn bare(name: &str) -> String {
    name.strip_prefix("the ").unwrap_or(name).into()
}

/// Item of a race or another body; none for the ground.
fn motion(body: &Body, subject: Subject) -> Option<Item> {
    let item = match &body.mobility {
        Mobility::Free(_) => {
            Item::does(Stage::Motion, subject, "six equations, under its contacts and its weight")
        }
        Mobility::Carried => Item::does(Stage::Motion, subject, "the mean motion of its elements"),
        Mobility::Fixed if body.name == GROUND => return None,
        Mobility::Fixed => {
            let why = "fixed in space: no equations for it";
            return Some(Item::skips(Stage::Motion, subject, why).named(Some(bare(&body.name))));
        }
        Mobility::Driven(race) => Item::does(Stage::Motion, subject, race_freedom(race)),
    };
    Some(item.named(Some(bare(&body.name))).costing(1))
}

/// Start in equilibrium or not.
pub fn start(start: Start) -> Item {
    let (does, why) = match start {
        Start::Equilibrium => (true, "requested; balls and cage start rolling"),
        Start::Nominal => (false, "starts in nominal positions, balls and cage rolling"),
    };
    Item::new(Stage::StartEquilibrium, Subject::Whole, does, why)
}

fn step_size(options: &RunOptions) -> Item {
    let (does, why) = match options.stepping {
        Stepping::Accuracy(accuracy) => (
            false,
            format!(
                "{} takes steps as long as an accuracy of {accuracy} allows",
                options.integrator.name()
            ),
        ),
        Stepping::Fixed(step) if options.integrator != Integrator::RungeKutta => (
            false,
            format!("the step is given: {step:e} s; the limit is that of rk4, not evaluated here"),
        ),
        Stepping::Fixed(step) => (
            true,
            format!(
                "the step is given: {step:e} s; it is compared with the limit at the start and \
                      when contacts get stiffer"
            ),
        ),
        Stepping::FractionOfLimit(fraction) => (
            true,
            format!(
                "the step is {fraction} of it, from the Jacobian at the start; evaluated again when \
                 contacts get stiffer"
            ),
        ),
    };
    Item::new(Stage::StabilityLimit, Subject::Whole, does, why)
}

fn traction(bearing: &Bearing, subject: Subject) -> Item {
    let law = match bearing.traction {
        TractionLaw::None => {
            return Item::skips(Stage::Traction, subject, "law none: no slices, no spin moment");
        }
        TractionLaw::Constant { .. } => "constant coefficient",
        TractionLaw::SlideToRoll { .. } => "exponential in the slide-to-roll ratio",
        TractionLaw::SlipSpeed { .. } => "exponential in the sliding speed",
    };
    let slices = bearing.slices;
    let across = match bearing.points_across {
        1 => String::new(),
        points => format!(", {points} points across each"),
    };
    let curved =
        if bearing.differential_sliding { "; differential sliding in the grooves" } else { "" };
    let why = format!("{law}; {slices} slices on each loaded contact{across}{curved}");
    Item::does(Stage::Traction, subject, why)
}

fn contact_damping(bearing: &Bearing, subject: Subject) -> Item {
    let why = match bearing.damping {
        ContactDamping::None => {
            let why = "law none: no damping force";
            return Item::skips(Stage::ContactDamping, subject, why);
        }
        ContactDamping::HuntCrossley { .. } => "Hunt-Crossley, with the present speed",
    };
    let pairs = 2 * bearing.geometry.ball_count as u64;
    Item::does(Stage::ContactDamping, subject, why).costing(pairs)
}

/// Profiles of the races and balls of a bearing.
fn raceway_profiles(bearing: &Bearing, subject: Subject) -> Option<Item> {
    if bearing.raceway_profiles.is_empty() && bearing.ball_deviations.is_empty() {
        return None;
    }
    let tests = bearing.profile_tests();
    if tests == 0 {
        let why = "of no depth: Hertz's law is unchanged";
        return Some(Item::skips(Stage::RacewayProfiles, subject, why));
    }
    let felt = || bearing.raceway_profiles.iter().filter(|profile| !profile.vanishes());
    let (mut spalls, mut waves, mut shapes) = (0, 0, Vec::new());
    for profile in felt() {
        match profile {
            RacewayProfile::Dent(dent) => shapes.push(&dent.shape),
            RacewayProfile::Spall(_) => spalls += 1,
            RacewayProfile::Waviness(_) => waves += 1,
        }
    }
    let mut parts = Vec::new();
    if !shapes.is_empty() {
        let solves = shapes.iter().map(|shape| Fineness::of(shape).solves()).max().unwrap_or(0);
        let raised = shapes.iter().any(|shape| shape.shoulder_height > 0.0);
        let takes = if raised { "some ten seconds, with a shoulder" } else { "some seconds" };
        parts.push(format!(
            "dents: {}, a table for each shape first, of at most {solves} solves of a half-space ({takes})",
            shapes.len()
        ));
    }
    if spalls > 0 {
        parts.push(format!("spalls: {spalls}"));
    }
    if waves > 0 {
        parts.push(format!("waves: {waves}"));
    }
    if !bearing.has_equal_balls() {
        parts.push("balls of different size".to_string());
    }
    let why = format!("{}; the equilibrium at the start omits them", parts.join("; "));
    Some(Item::does(Stage::RacewayProfiles, subject, why).costing(tests))
}

fn cage(bearing: &Bearing, subject: Subject, left_out: Option<&str>) -> Vec<Item> {
    let Some(cage) = &bearing.cage else {
        let why = left_out.unwrap_or("the scene has none");
        let why = format!("{why}: no equations, no pocket tests");
        return vec![Item::skips(Stage::Pockets, subject, why)];
    };
    if cage.in_elements {
        let why = "in the steps of the cage's elements";
        return [Stage::Pockets, Stage::Guide].map(|of| Item::skips(of, subject, why)).to_vec();
    }
    let balls = bearing.geometry.ball_count;
    let land = match cage.contacts.guidance {
        Guidance::InnerRace => "inner",
        _ => "outer",
    };
    let by_nodes = cage.nodes.as_ref().map(|nodes| {
        let count = nodes.land.places.len();
        format!("on the {land} race, {count} nodes of the rails; only sectors near the land are searched")
    });
    let (guided, why) = match cage.contacts.guidance {
        Guidance::OuterRace => (true, "on the outer race, at both ends of the cage"),
        Guidance::InnerRace => (true, "on the inner race, at both ends of the cage"),
        Guidance::Balls if cage.contacts.pocket == Pocket::Cylindrical => (
            false,
            "the balls guide it: no test with a race; round pockets do not guide it across its axis",
        ),
        Guidance::Balls => (false, "the balls guide it: no test with a race"),
    };
    let why = by_nodes.filter(|_| guided).unwrap_or_else(|| why.to_string());
    let guide = Item { cost: guided.then_some(2), ..Item::new(Stage::Guide, subject, guided, why) };
    let why = match &cage.nodes {
        None => format!("{balls} pocket tests"),
        Some(nodes) => {
            let count = nodes.pockets.first().map_or(0, |pocket| pocket.group.places.len());
            format!(
                "{balls} pockets of {count} nodes; the nodes are tested only when the ball is near the wall"
            )
        }
    };
    vec![Item::does(Stage::Pockets, subject, why).costing(balls as u64), guide]
}

fn ball_contact(bearing: &Bearing, subject: Subject) -> Item {
    let balls = bearing.geometry.ball_count;
    let stage = Stage::BallContact;
    match bearing.ball_meeting() {
        BallMeeting::Tested => {
            let why = format!("{balls} pairs of neighbours; an open pair costs a distance test");
            Item::does(stage, subject, why).costing(neighbours(balls) as u64)
        }
        BallMeeting::NoLaw => {
            Item::skips(stage, subject, "law none: interpenetrating balls end the run")
        }
        BallMeeting::KeptApart { gap } => {
            let gap = gap * 1e3;
            let why = format!("pockets keep balls apart, by {gap:.3} mm at least: no test");
            Item::skips(stage, subject, why)
        }
    }
}

/// Number of coordinates that follow from loads.
fn free_coordinates(body: &DrivenBody) -> usize {
    let loads = body.drives.iter().filter(|drive| matches!(drive, Drive::Load(_))).count();
    loads + usize::from(matches!(body.rotation, Rotation::Torque(_)))
}

/// Describes which of a race's coordinates follow from loads.
pub fn race_freedom(body: &DrivenBody) -> String {
    match free_coordinates(body) {
        6 => "all six coordinates follow from loads".into(),
        0 => "all six coordinates are prescribed; the work of their drives is booked".into(),
        free => format!("{free} of 6 coordinates follow from loads, the others are prescribed"),
    }
}

pub(crate) fn stands_on_ground(body: &DrivenBody) -> bool {
    body.foundation_stiffness.iter().chain(&body.foundation_damping).any(|value| *value != 0.0)
}

/// Recording of a group of channels.
pub fn channel_group(assembly: &Assembly, asked: &[ChannelGroup], group: ChannelGroup) -> Item {
    let needs_cage = matches!(group, ChannelGroup::Cage | ChannelGroup::Pockets);
    let flexes = assembly.floating.iter().any(|solid| !solid.gauges.is_empty());
    let (does, why) = if group == ChannelGroup::Energy {
        (true, "the ledger is always computed")
    } else if !asked.contains(&group) {
        (false, "not requested: not computed")
    } else if group == ChannelGroup::CageRadius && !flexes {
        (false, "there is no flexible cage")
    } else if needs_cage && assembly.bearings.iter().all(|bearing| bearing.cage.is_none()) {
        (false, "there is no cage")
    } else {
        (true, "recorded at every output")
    };
    Item::new(Stage::recording(group), Subject::Whole, does, why)
}
