//! Stages of one bearing and of one body in each evaluation of a motion.

/// Stages of one bearing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BearingSteps {
    pub traction: bool,
    pub damping: bool,
    pub raceway_profiles: bool,
    pub pockets: bool,
    pub guide: bool,
    pub ball_contact: bool,
}

/// Stages of one body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodySteps {
    pub foundation: bool,
    pub rotating_load: bool,
    pub unbalance: bool,
    /// True if an unbalance is coupled with the spin of a body driven by a torque.
    pub unbalance_coupled: bool,
    /// Index of its floating solid.
    pub floating: Option<usize>,
}
