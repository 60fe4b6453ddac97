//! The plan: the items of a solution, made once from its assembly.
//!
//! An item names a stage of the work, its subject in the assembly, whether it is done, and why. The step runs the items
//! that say *does* and nothing else; `bearing plan` and every summary print the same list. Code that does a stage's
//! work counts it ([`counts`]), and tests compare the counts with the items.

pub mod channels;
pub mod counts;

use crate::plan::channels::ChannelGroup;
use std::fmt;

/// A stage of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    // Start and steps.
    StartEquilibrium,
    StabilityLimit,
    IntegratorChoice,
    // Bearings.
    DistanceTest,
    BallEquilibrium,
    BallGravity,
    CentrifugalForce,
    Traction,
    ContactDamping,
    RacewayProfiles,
    Pockets,
    Guide,
    BallContact,
    // Bodies and connections.
    Evaluation,
    Equilibrium,
    Equilibria,
    Gravity,
    Motion,
    Foundation,
    Springs,
    RotatingLoad,
    Unbalance,
    /// CoupledMotion with solids in explicit steps.
    Impulses,
    Ledger,
    // Solids.
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
    // Records.
    RacesChannels,
    CageChannels,
    OrbitsChannels,
    LoadsChannels,
    CageRadiusChannels,
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
        Stage::RacewayProfiles,
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
        Stage::CageRadiusChannels,
        Stage::PocketsChannels,
        Stage::SlipChannels,
        Stage::ForcesChannels,
        Stage::MomentsChannels,
        Stage::EnergyChannels,
        Stage::Sensors,
    ];

    /// Name in plans and summaries.
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
            Stage::RacewayProfiles => "raceway profiles",
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
            Stage::Impulses => "impulses of housing fits",
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
            Stage::CageRadiusChannels => "channels: cage-radius",
            Stage::PocketsChannels => "channels: pockets",
            Stage::SlipChannels => "channels: slip",
            Stage::ForcesChannels => "channels: forces",
            Stage::MomentsChannels => "channels: moments",
            Stage::EnergyChannels => "channels: energy",
            Stage::Sensors => "sensors",
        }
    }

    /// Stage of recording a group of channels.
    pub const fn recording(group: ChannelGroup) -> Stage {
        match group {
            ChannelGroup::Races => Stage::RacesChannels,
            ChannelGroup::Cage => Stage::CageChannels,
            ChannelGroup::Orbits => Stage::OrbitsChannels,
            ChannelGroup::Loads => Stage::LoadsChannels,
            ChannelGroup::CageRadius => Stage::CageRadiusChannels,
            ChannelGroup::Pockets => Stage::PocketsChannels,
            ChannelGroup::Slip => Stage::SlipChannels,
            ChannelGroup::Forces => Stage::ForcesChannels,
            ChannelGroup::Moments => Stage::MomentsChannels,
            ChannelGroup::Energy => Stage::EnergyChannels,
        }
    }
}

/// Subject of an item: an index in a list of the assembly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    Whole,
    Bearing(usize),
    Body(usize),
    Solid(usize),
    Seat(usize),
}

/// A stage of a subject: whether it is done, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    pub stage: Stage,
    pub subject: Subject,
    /// Name of the subject, if the stage alone is ambiguous.
    pub of: Option<String>,
    pub does: bool,
    pub why: String,
    /// Number of runs in each evaluation; `None` if it varies.
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

    /// The item with its subject's name.
    #[must_use]
    pub fn named(self, of: Option<impl Into<String>>) -> Item {
        Item { of: of.map(Into::into), ..self }
    }

    /// The item with its number of runs in each evaluation.
    #[must_use]
    pub fn costing(self, cost: u64) -> Item {
        Item { cost: Some(cost), ..self }
    }

    /// Name with subject: "left: traction", "outer race motion", "housing supports", "reduced housing".
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

/// Returns whether the items include this stage of this subject as done.
pub fn does(items: &[Item], stage: Stage, subject: Subject) -> bool {
    items.iter().any(|item| item.stage == stage && item.subject == subject && item.does)
}

/// An item by its name, and its number of runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counted {
    pub name: String,
    pub does: bool,
    pub ran: u64,
}

/// Number of runs of each item, then stages that ran without an item.
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

/// Item of a scene without flexible solids.
pub fn no_solids() -> Item {
    let why = "the scene has no solid: no element stage";
    Item::skips(Stage::FlexibleBodies, Subject::Whole, why)
}
