//! Attachment of a bearing, connection or housing fit on a section of a flexible body.

use crate::members::ball_set::onto_body;
use crate::members::flexible_shaft::{Bend, ElasticShaft, Section, SectionNow};
use crate::members::mount::Mount;
use crate::members::rigid_body::{BodyKinematics, Wrench, kinematics_at_mount};

/// One section, as last placed.
#[derive(Clone, Debug)]
pub struct SectionAttachment {
    /// Index in [`Assembly::shafts`](crate::assembly::lists::Assembly::shafts).
    pub shaft: usize,
    pub section: Section,
    pub now: SectionNow,
}

impl ElasticShaft {
    /// Amplitudes and rates in a state, whose entries of the shaft begin at `at`.
    pub fn bend<'s>(&self, at: usize, state: &'s [f64]) -> Bend<'s> {
        Bend::of(self.count(), &state[at..at + self.entries()])
    }

    /// Modal accelerations of the shaft among the rates of the state.
    pub fn pushes<'r>(&self, at: usize, rates: &'r mut [f64]) -> &'r mut [f64] {
        &mut rates[at + self.amplitudes()..at + self.entries()]
    }
}

/// Kinematics at a mount, on a section or on a rigid body.
pub fn kinematics_at_attachment(
    hold: &Option<SectionAttachment>,
    body: &BodyKinematics,
    mount: &Mount,
) -> BodyKinematics {
    hold.as_ref().map_or_else(|| kinematics_at_mount(body, mount), |hold| hold.now.race)
}

/// Shafts, their first entries in the state, and the state.
pub type Bent<'b> = (&'b [ElasticShaft], &'b [usize], &'b [f64]);

/// Wrench of loads at a mount on its body; modal forces are added to the modes.
pub fn wrench_on_body(
    (hold, mount): (&Option<SectionAttachment>, &Mount),
    (attached, body): (&BodyKinematics, &BodyKinematics),
    loads: &Wrench,
    (shafts, at, state): Bent,
    rates: &mut [f64],
) -> Wrench {
    match hold {
        None => onto_body(mount, attached, body, loads),
        Some(hold) => {
            let (shaft, at) = (&shafts[hold.shaft], at[hold.shaft]);
            let bend = shaft.bend(at, state);
            hold.section.take((body, &bend), &hold.now, loads, shaft.pushes(at, rates))
        }
    }
}
