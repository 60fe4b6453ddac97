//! Groups of channels of a run. Channels that are not requested are not computed.

/// A group of columns of the time series.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChannelGroup {
    /// Position, tilts, velocity and speed of the inner race, and of the outer race if it moves.
    Races,
    /// Position, speed and angle of the cage, its load on the guiding race, and the extremes of a flexible cage's radius.
    Cage,
    /// Angle and speed of each ball around the bearing; mean contact angle on each race.
    Orbits,
    /// Normal load of each ball on both races.
    Loads,
    /// Change of a flexible cage's outer radius around it, in its own axes.
    CageRadius,
    /// Load of each ball in its pocket.
    Pockets,
    /// Slip at the middle of each contact and spin about its normal.
    Slip,
    /// Sum of contact forces on each race.
    Forces,
    /// Moment of contact forces on each race about its centre.
    Moments,
    /// Energies, work and losses since the start, and the energy residual.
    Energy,
}

impl ChannelGroup {
    pub const ALL: [ChannelGroup; 10] = [
        ChannelGroup::Races,
        ChannelGroup::Cage,
        ChannelGroup::Orbits,
        ChannelGroup::Loads,
        ChannelGroup::CageRadius,
        ChannelGroup::Pockets,
        ChannelGroup::Slip,
        ChannelGroup::Forces,
        ChannelGroup::Moments,
        ChannelGroup::Energy,
    ];

    /// All but slip, with six columns a ball, moments, and the cage's radius.
    pub const DEFAULT: [ChannelGroup; 7] = [
        ChannelGroup::Races,
        ChannelGroup::Cage,
        ChannelGroup::Orbits,
        ChannelGroup::Loads,
        ChannelGroup::Pockets,
        ChannelGroup::Forces,
        ChannelGroup::Energy,
    ];

    /// Name in scenes.
    pub const fn name(self) -> &'static str {
        match self {
            ChannelGroup::Races => "races",
            ChannelGroup::Cage => "cage",
            ChannelGroup::Orbits => "orbits",
            ChannelGroup::Loads => "loads",
            ChannelGroup::CageRadius => "cage-radius",
            ChannelGroup::Pockets => "pockets",
            ChannelGroup::Slip => "slip",
            ChannelGroup::Forces => "forces",
            ChannelGroup::Moments => "moments",
            ChannelGroup::Energy => "energy",
        }
    }

    pub fn from_name(name: &str) -> Option<ChannelGroup> {
        ChannelGroup::ALL.into_iter().find(|group| group.name() == name)
    }
}
