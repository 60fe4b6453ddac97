//! What a problem needs, decided once before anything is computed: a scene pays only for what it
//! has, and can be asked why.

use super::channels::ChannelGroup;
use super::dynamics::assembly::{Assembly, BallMeeting, Bearing, Body, GROUND, Mobility};
use super::dynamics::model::{Drive, RaceBody, Rotation};
use super::dynamics::run::{Integrator, RunOptions, Start, Stepping};
use super::statics::{Condition, StaticProblem};
use crate::ch2_housing::bearing::cage::{Guidance, Pocket};
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::geometry::BearingKind;
use crate::ch2_housing::bearing::traction::TractionLaw;

/// One thing the solver could do, whether it does it, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stage {
    pub name: String,
    pub included: bool,
    pub reason: String,
}

fn stage(name: impl Into<String>, included: bool, reason: impl Into<String>) -> Stage {
    Stage { name: name.into(), included, reason: reason.into() }
}

/// Stages of a static solution.
pub fn statics(problem: &StaticProblem) -> Vec<Stage> {
    let balls = problem.geometry.ball_count;
    let unknowns = problem.conditions.iter().filter(|c| matches!(c, Condition::Load(_))).count();
    let gravity = problem.gravity.norm() > 0.0 && problem.ball_mass > 0.0;
    let centrifugal = problem.orbital_speed != 0.0 && problem.ball_mass > 0.0;
    let search = match unknowns {
        0 => stage("race equilibrium", false, "all five coordinates are given: one evaluation"),
        n => stage("race equilibrium", true, format!("{n} of 5 coordinates are free")),
    };
    let contact_angle = match problem.geometry.kind {
        BearingKind::DeepGroove => "contact angles follow from the position of both races",
        BearingKind::AngularContact => {
            "contact angles follow from the position of both races, starting at the nominal one"
        }
    };
    vec![
        stage(
            "distance test",
            true,
            format!("{balls} balls, two sightings each; a ball with room costs nothing more"),
        ),
        stage("ball equilibrium", true, contact_angle),
        search,
        if gravity {
            stage("gravity on balls", true, "gravity is given")
        } else {
            let reason = if centrifugal {
                "no gravity is given"
            } else {
                "no gravity: a ball with room is left out"
            };
            stage("gravity on balls", false, reason)
        },
        if centrifugal {
            stage("centrifugal force on balls", true, "asked for, with a speed of the inner race")
        } else {
            stage("centrifugal force on balls", false, "not asked for, or the bearing stands still")
        },
        stage("traction", false, "statics has no sliding: no slices, no spin moment"),
        stage("cage contact", false, "statics keeps each ball at its azimuth"),
        stage("outer race motion", false, "its position is given: no equations for it"),
        stage("flexible bodies", false, "the scene has none: no mesh, no element stage"),
    ]
}

/// Stages of one evaluation of a run, four a step, and of what is recorded.
///
/// `cage_left_out` is why a bearing has no cage, where the scene has one; one for each bearing.
pub fn dynamics(
    assembly: &Assembly,
    options: &RunOptions,
    channels: &[ChannelGroup],
    cage_left_out: &[Option<&str>],
) -> Vec<Stage> {
    let mut stages = vec![start(options.start), step_size(options)];
    for (index, bearing) in assembly.bearings.iter().enumerate() {
        let balls = bearing.geometry.ball_count;
        let mut own = vec![
            stage(
                "distance test",
                true,
                format!("{balls} balls, two races each; a pair with room costs nothing more"),
            ),
            traction(bearing),
            heathcote(bearing),
            contact_damping(&bearing.damping),
        ];
        own.extend(cage(bearing, cage_left_out.get(index).copied().flatten()));
        own.push(ball_contact(bearing));
        if let Some(name) = &bearing.name {
            own.iter_mut().for_each(|stage| stage.name = format!("{name}: {}", stage.name));
        }
        stages.extend(own);
    }
    stages.push(if assembly.gravity != [0.0; 3] {
        stage("gravity", true, "given; it acts on every body that moves")
    } else {
        stage("gravity", false, "none is given")
    });
    stages.extend(assembly.bodies.iter().filter_map(motion));
    stages.push(foundation(assembly));
    if assembly.bodies.iter().any(|body| body.label.is_some()) {
        stages.push(match assembly.connections.len() {
            0 => stage("springs between bodies", false, "none is given"),
            some => stage("springs between bodies", true, format!("{some} of them")),
        });
    }
    let loads = assembly.bodies.iter().any(|body| body.rotating_load.is_some());
    let unbalanced = assembly.bodies.iter().any(|body| body.unbalance != 0.0);
    for (name, given) in [("rotating load", loads), ("unbalance", unbalanced)] {
        stages.push(stage(name, given, if given { "given" } else { "none is given" }));
    }
    stages.push(stage("flexible bodies", false, "the scene has none: no mesh, no element stage"));
    stages.extend(ChannelGroup::ALL.map(|group| channel_group(assembly, channels, group)));
    stages
}

/// Of a race or another body; a cage has a stage of its own, and the ground none.
fn motion(body: &Body) -> Option<Stage> {
    let name = format!("{} motion", body.name.strip_prefix("the ").unwrap_or(&body.name));
    match &body.mobility {
        Mobility::Free(_) => None,
        Mobility::Fixed if body.name == GROUND => None,
        Mobility::Fixed => Some(stage(name, false, "fixed in space: no equations for it")),
        Mobility::Driven(race) if free_coordinates(race) == 0 => {
            Some(stage(name, false, "all six coordinates are given and imposed"))
        }
        Mobility::Driven(race) => Some(stage(name, true, race_freedom(race))),
    }
}

fn start(start: Start) -> Stage {
    match start {
        Start::Equilibrium => {
            stage("equilibrium at the start", true, "asked for; balls and cage start rolling")
        }
        Start::Nominal => stage(
            "equilibrium at the start",
            false,
            "starts in nominal positions, balls and cage rolling",
        ),
    }
}

fn step_size(options: &RunOptions) -> Stage {
    match options.stepping {
        Stepping::Accuracy(accuracy) => stage(
            "stability limit",
            false,
            format!(
                "{} takes steps as long as an accuracy of {accuracy} allows",
                options.integrator.name()
            ),
        ),
        Stepping::Fixed(step) if options.integrator != Integrator::RungeKutta => stage(
            "stability limit",
            false,
            format!("the step is given: {step:e} s; the limit is that of rk4, not looked at here"),
        ),
        Stepping::Fixed(step) => stage(
            "stability limit",
            true,
            format!(
                "the step is given: {step:e} s; it is held against the limit at the start and \
                     where contacts get stiffer"
            ),
        ),
        Stepping::FractionOfLimit(fraction) => stage(
            "stability limit",
            true,
            format!(
                "the step is {fraction} of it, from the Jacobian at the start; looked at again where \
                 contacts get stiffer"
            ),
        ),
    }
}

fn traction(problem: &Bearing) -> Stage {
    let law = match problem.traction {
        TractionLaw::None => {
            return stage("traction", false, "law none: no slices, no spin moment");
        }
        TractionLaw::Constant { .. } => "constant coefficient",
        TractionLaw::SlideToRoll { .. } => "exponential in the slide-to-roll ratio",
        TractionLaw::SlipSpeed { .. } => "exponential in the sliding speed",
        TractionLaw::Table { .. } => "tabulated over the sliding speed",
    };
    let slices = problem.slices;
    stage("traction", true, format!("{law}; {slices} slices on each loaded contact"))
}

fn heathcote(problem: &Bearing) -> Stage {
    match (problem.heathcote, &problem.traction) {
        (_, TractionLaw::None) => stage("curved contact surface", false, "no slices"),
        (true, _) => stage("curved contact surface", true, "asked for (Heathcote slip)"),
        (false, _) => {
            stage("curved contact surface", false, "not asked for: slices lie in a plane")
        }
    }
}

fn contact_damping(damping: &ContactDamping) -> Stage {
    match damping {
        ContactDamping::None => {
            stage("contact damping", false, "law none: no damping force, no contact history")
        }
        ContactDamping::HuntCrossley { .. } => stage(
            "contact damping",
            true,
            "Hunt-Crossley, of the present speed: no contact history",
        ),
        ContactDamping::LankaraniNikravesh { .. } => stage(
            "contact damping",
            true,
            "Lankarani-Nikravesh; the speed of approach is kept, once a step",
        ),
    }
}

fn cage(problem: &Bearing, left_out: Option<&str>) -> Vec<Stage> {
    let Some(cage) = &problem.cage else {
        let reason = left_out.unwrap_or("the scene has none");
        return vec![stage("cage", false, format!("{reason}: no equations, no pocket tests"))];
    };
    let balls = problem.geometry.ball_count;
    let guide = |race: &str| stage("cage guide", true, format!("{race}, at both ends of the cage"));
    vec![
        stage("cage", true, format!("{balls} pocket tests; six equations of motion")),
        match cage.contacts.guidance {
            Guidance::OuterRace => guide("on the outer race"),
            Guidance::InnerRace => guide("on the inner race"),
            Guidance::Balls if cage.contacts.pocket == Pocket::Cylindrical => stage(
                "cage guide",
                false,
                "the balls guide it: no test with a race; round pockets do not hold it across its axis",
            ),
            Guidance::Balls => {
                stage("cage guide", false, "the balls guide it: no test with a race")
            }
        },
    ]
}

fn ball_contact(problem: &Bearing) -> Stage {
    let balls = problem.geometry.ball_count;
    let name = "contact between balls";
    match problem.ball_meeting() {
        BallMeeting::Tested => {
            let reason = format!("{balls} pairs of neighbours; a pair apart costs a distance test");
            stage(name, true, reason)
        }
        BallMeeting::NoLaw => {
            stage(name, false, "law none: balls that run into each other end the run")
        }
        BallMeeting::KeptApart { gap } => {
            let gap = gap * 1e3;
            let reason = format!("pockets keep balls apart, by {gap:.3} mm at least: no test");
            stage(name, false, reason)
        }
    }
}

/// How many of its six coordinates follow from loads.
fn free_coordinates(body: &RaceBody) -> usize {
    let loads = body.drives.iter().filter(|drive| matches!(drive, Drive::Load(_))).count();
    loads + usize::from(matches!(body.rotation, Rotation::Torque(_)))
}

/// Which of a race's coordinates follow from loads.
pub fn race_freedom(body: &RaceBody) -> String {
    match free_coordinates(body) {
        6 => "all six coordinates follow from loads".into(),
        free => format!("{free} of 6 coordinates follow from loads, the others are given"),
    }
}

fn foundation(assembly: &Assembly) -> Stage {
    let stands = |body: &RaceBody| {
        body.foundation_stiffness.iter().chain(&body.foundation_damping).any(|value| *value != 0.0)
    };
    let on = assembly.bodies.iter().filter(|body| body.driven().is_some_and(stands));
    let under: Vec<&str> = on.map(|body| body.name.as_str()).collect();
    match under[..] {
        [] => stage("foundation", false, "no spring or dashpot to the ground"),
        _ => stage("foundation", true, format!("under {}", under.join(", "))),
    }
}

fn channel_group(assembly: &Assembly, asked: &[ChannelGroup], group: ChannelGroup) -> Stage {
    let name = match group {
        ChannelGroup::Races => "channels: races",
        ChannelGroup::Cage => "channels: cage",
        ChannelGroup::Orbits => "channels: orbits",
        ChannelGroup::Loads => "channels: loads",
        ChannelGroup::Pockets => "channels: pockets",
        ChannelGroup::Slip => "channels: slip",
        ChannelGroup::Forces => "channels: forces",
        ChannelGroup::Energy => "channels: energy",
    };
    let needs_cage = matches!(group, ChannelGroup::Cage | ChannelGroup::Pockets);
    if group == ChannelGroup::Energy {
        stage(name, true, "the ledger is always kept")
    } else if !asked.contains(&group) {
        stage(name, false, "not asked for: not computed")
    } else if needs_cage && assembly.bearings.iter().all(|bearing| bearing.cage.is_none()) {
        stage(name, false, "no cage takes part")
    } else {
        stage(name, true, "recorded at every output")
    }
}
