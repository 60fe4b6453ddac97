//! What a solution does, as a list of items made once from what is solved.
//!
//! An item names a stage of the work, what of the assembly it is of, whether it is done and why. The step runs the
//! items that say *does* and nothing else; `bearing plan` and every summary print the same list. Code that does a
//! stage's work counts it ([`counts`]), and tests hold the counts against the items.

pub mod counts;
pub mod motion;
pub mod rubber;
mod shaft;
pub mod solid;
pub mod statics;
pub mod steps;

use crate::assembly::channels::ChannelGroup;
use std::fmt;

/// Something that a solution may have to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    // Of the start and of steps.
    StartEquilibrium,
    StabilityLimit,
    IntegratorChoice,
    // Of a bearing.
    DistanceTest,
    BallEquilibrium,
    BallGravity,
    CentrifugalForce,
    Traction,
    ContactDamping,
    Dents,
    Pockets,
    Guide,
    BallContact,
    // Of bodies and of what joins them.
    Evaluation,
    Equilibrium,
    Equilibria,
    Gravity,
    Motion,
    Foundation,
    Springs,
    RotatingLoad,
    Unbalance,
    /// What seats in solids with steps of their own hand over.
    Impulses,
    Ledger,
    // Of solids.
    FlexibleBodies,
    Elements,
    Supports,
    Loads,
    Damping,
    Maxwell,
    QuasiStatic,
    Reduced,
    Explicit,
    Seat,
    BoreFriction,
    Joints,
    SolidStatics,
    Implicit,
    LinearSystem,
    Modes,
    SolidRun,
    // Of what is recorded.
    RacesChannels,
    CageChannels,
    OrbitsChannels,
    LoadsChannels,
    PocketsChannels,
    SlipChannels,
    ForcesChannels,
    MomentsChannels,
    EnergyChannels,
    Sensors,
}

impl Stage {
    pub const COUNT: usize = Stage::Sensors as usize + 1;

    /// In the order of their numbers.
    pub const ALL: [Stage; Stage::COUNT] = [
        Stage::StartEquilibrium,
        Stage::StabilityLimit,
        Stage::IntegratorChoice,
        Stage::DistanceTest,
        Stage::BallEquilibrium,
        Stage::BallGravity,
        Stage::CentrifugalForce,
        Stage::Traction,
        Stage::ContactDamping,
        Stage::Dents,
        Stage::Pockets,
        Stage::Guide,
        Stage::BallContact,
        Stage::Evaluation,
        Stage::Equilibrium,
        Stage::Equilibria,
        Stage::Gravity,
        Stage::Motion,
        Stage::Foundation,
        Stage::Springs,
        Stage::RotatingLoad,
        Stage::Unbalance,
        Stage::Impulses,
        Stage::Ledger,
        Stage::FlexibleBodies,
        Stage::Elements,
        Stage::Supports,
        Stage::Loads,
        Stage::Damping,
        Stage::Maxwell,
        Stage::QuasiStatic,
        Stage::Reduced,
        Stage::Explicit,
        Stage::Seat,
        Stage::BoreFriction,
        Stage::Joints,
        Stage::SolidStatics,
        Stage::Implicit,
        Stage::LinearSystem,
        Stage::Modes,
        Stage::SolidRun,
        Stage::RacesChannels,
        Stage::CageChannels,
        Stage::OrbitsChannels,
        Stage::LoadsChannels,
        Stage::PocketsChannels,
        Stage::SlipChannels,
        Stage::ForcesChannels,
        Stage::MomentsChannels,
        Stage::EnergyChannels,
        Stage::Sensors,
    ];

    /// As a person reads it.
    pub const fn name(self) -> &'static str {
        match self {
            Stage::StartEquilibrium => "equilibrium at the start",
            Stage::StabilityLimit => "stability limit",
            Stage::IntegratorChoice => "choice of the integrator",
            Stage::DistanceTest => "distance test",
            Stage::BallEquilibrium => "ball equilibrium",
            Stage::BallGravity => "gravity on balls",
            Stage::CentrifugalForce => "centrifugal force on balls",
            Stage::Traction => "traction",
            Stage::ContactDamping => "contact damping",
            Stage::Dents => "dents",
            Stage::Pockets => "cage",
            Stage::Guide => "cage guide",
            Stage::BallContact => "contact between balls",
            Stage::Evaluation => "evaluation",
            Stage::Equilibrium => "equilibrium",
            Stage::Equilibria => "equilibria",
            Stage::Gravity => "gravity",
            Stage::Motion => "motion",
            Stage::Foundation => "foundation",
            Stage::Springs => "springs between bodies",
            Stage::RotatingLoad => "rotating load",
            Stage::Unbalance => "unbalance",
            Stage::Impulses => "impulses of seats",
            Stage::Ledger => "ledger",
            Stage::FlexibleBodies => "flexible bodies",
            Stage::Elements => "mesh",
            Stage::Supports => "supports",
            Stage::Loads => "loads",
            Stage::Damping => "damping",
            Stage::Maxwell => "Maxwell elements",
            Stage::QuasiStatic => "quasi-static",
            Stage::Reduced => "reduced",
            Stage::Explicit => "explicit",
            Stage::Seat => "seat",
            Stage::BoreFriction => "friction in the bore",
            Stage::Joints => "races on sections",
            Stage::SolidStatics => "statics",
            Stage::Implicit => "implicit steps",
            Stage::LinearSystem => "small vibrations",
            Stage::Modes => "modes",
            Stage::SolidRun => "run",
            Stage::RacesChannels => "channels: races",
            Stage::CageChannels => "channels: cage",
            Stage::OrbitsChannels => "channels: orbits",
            Stage::LoadsChannels => "channels: loads",
            Stage::PocketsChannels => "channels: pockets",
            Stage::SlipChannels => "channels: slip",
            Stage::ForcesChannels => "channels: forces",
            Stage::MomentsChannels => "channels: moments",
            Stage::EnergyChannels => "channels: energy",
            Stage::Sensors => "sensors",
        }
    }

    /// Recording a group of channels.
    pub const fn recording(group: ChannelGroup) -> Stage {
        match group {
            ChannelGroup::Races => Stage::RacesChannels,
            ChannelGroup::Cage => Stage::CageChannels,
            ChannelGroup::Orbits => Stage::OrbitsChannels,
            ChannelGroup::Loads => Stage::LoadsChannels,
            ChannelGroup::Pockets => Stage::PocketsChannels,
            ChannelGroup::Slip => Stage::SlipChannels,
            ChannelGroup::Forces => Stage::ForcesChannels,
            ChannelGroup::Moments => Stage::MomentsChannels,
            ChannelGroup::Energy => Stage::EnergyChannels,
        }
    }
}

/// What of the assembly an item is of: an index in its list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    Whole,
    Bearing(usize),
    Body(usize),
    Solid(usize),
    Seat(usize),
}

impl Subject {
    /// Its list's number and its own, as files keep them.
    pub fn numbers(self) -> [usize; 2] {
        match self {
            Subject::Whole => [0, 0],
            Subject::Bearing(at) => [1, at],
            Subject::Body(at) => [2, at],
            Subject::Solid(at) => [3, at],
            Subject::Seat(at) => [4, at],
        }
    }

    /// `None` where there is no such list.
    pub fn from_numbers([list, at]: [usize; 2]) -> Option<Subject> {
        let of =
            [|_| Subject::Whole, Subject::Bearing, Subject::Body, Subject::Solid, Subject::Seat]
                as [fn(usize) -> Subject; 5];
        of.get(list).map(|of| of(at))
    }
}

/// One stage of one thing, whether it is done, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    pub stage: Stage,
    pub subject: Subject,
    /// The subject as a person reads it, where the stage alone does not tell.
    pub of: Option<String>,
    pub does: bool,
    pub why: String,
    /// How often it runs in each evaluation, where that is fixed.
    pub cost: Option<u64>,
}

impl Item {
    pub fn new(stage: Stage, subject: Subject, does: bool, why: impl Into<String>) -> Item {
        Item { stage, subject, of: None, does, why: why.into(), cost: None }
    }

    pub fn does(stage: Stage, subject: Subject, why: impl Into<String>) -> Item {
        Item::new(stage, subject, true, why)
    }

    pub fn skips(stage: Stage, subject: Subject, why: impl Into<String>) -> Item {
        Item::new(stage, subject, false, why)
    }

    /// The same with its subject's name.
    #[must_use]
    pub fn named(self, of: Option<impl Into<String>>) -> Item {
        Item { of: of.map(Into::into), ..self }
    }

    /// The same, which runs so often in each evaluation.
    #[must_use]
    pub fn costing(self, cost: u64) -> Item {
        Item { cost: Some(cost), ..self }
    }

    /// As a person reads it: "left: traction", "outer race motion", "housing supports", "reduced housing".
    pub fn name(&self) -> String {
        let stage = self.stage.name();
        let Some(of) = &self.of else { return stage.into() };
        match (self.subject, self.stage) {
            (_, Stage::QuasiStatic | Stage::Reduced | Stage::Explicit) => format!("{stage} {of}"),
            (_, Stage::Motion) | (Subject::Solid(_), _) => format!("{of} {stage}"),
            _ => format!("{of}: {stage}"),
        }
    }
}

/// A line of a plan.
impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mark = if self.does { "does " } else { "skips" };
        write!(f, "{mark} {:<28} {}", self.name(), self.why)
    }
}

/// Whether a list has an item that says so.
pub fn does(items: &[Item], stage: Stage, subject: Subject) -> bool {
    items.iter().any(|item| item.stage == stage && item.subject == subject && item.does)
}

/// An item by its name, and how many times it ran.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counted {
    pub name: String,
    pub does: bool,
    pub ran: u64,
}

/// How many times each item ran; after them what ran without an item, which says neither that it is done nor why.
pub fn counted(items: &[Item], ran: &counts::StageCounts) -> Vec<Counted> {
    let of = |item: &Item| {
        let count = ran.of(item.stage, item.subject);
        Counted { name: item.name(), does: item.does, ran: count }
    };
    let planned =
        |stage, subject| items.iter().any(|item| item.stage == stage && item.subject == subject);
    let unplanned = ran.list().into_iter().filter(|(stage, subject, _)| !planned(*stage, *subject));
    let without = |(stage, subject, ran): (Stage, Subject, u64)| Counted {
        name: format!("not planned: {stage:?} of {subject:?}"),
        does: false,
        ran,
    };
    items.iter().map(of).chain(unplanned.map(without)).collect()
}
