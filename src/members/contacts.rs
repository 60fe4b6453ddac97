//! Ball–race contacts of one evaluation: detection for every pair, then traction for the loaded ones only.
//!
//! Two kernels call the same scalar laws: [`Kernel::Scalar`] contact by contact, [`Kernel::Simd`] over blocks of
//! [`LANES`] contacts. The order of operations within a contact is the same, so the bits are too.

use crate::ch2_housing::bearing::contact::{
    RaceContact, RaceLaw, damped_load, normal_load, race_contact,
};
use crate::ch2_housing::bearing::geometry::Raceway;
use crate::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use crate::ch2_housing::bearing::slices::{Slices, Sliding, TractionForce, TractionSlope};
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::kinematics::vec3::sub;
use crate::members::bearing::Bearing;
use crate::members::contact_traction::{traction_lanes, traction_plain};
use crate::members::raceway_profile;
use crate::members::raceway_profile::{ProfiledPair, RacewayProfiles};
use crate::members::rigid_body::BodyKinematics;
use crate::members::state::{LANES, Layout, POSITION, VELOCITY};
use crate::members::steps::BearingSteps;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use serde::{Deserialize, Serialize};

/// Laws that all contacts share.
#[derive(Clone, Debug)]
pub struct ContactLaws {
    /// Inner, outer.
    pub races: [RaceLaw; 2],
    pub ball_radius: f64,
    pub traction: TractionLaw,
    pub slices: Slices,
    /// RacewayProfiles of races and balls.
    pub raceway_profiles: RacewayProfiles,
}

impl ContactLaws {
    /// Laws of a bearing's contacts, for the steps that are taken.
    pub fn of(
        bearing: &Bearing,
        steps: BearingSteps,
        raceway_profiles: RacewayProfiles,
    ) -> ContactLaws {
        let geometry = &bearing.geometry;
        let radius = geometry.ball_radius;
        let [slices, across] =
            if steps.traction { [bearing.slices, bearing.points_across] } else { [1, 1] };
        let mut slices = Slices::new(slices, across);
        let curved = steps.traction && bearing.differential_sliding;
        slices.across |= curved;
        ContactLaws {
            races: [
                race_law(&geometry.inner, &bearing.inner_contact, radius, -1.0, curved),
                race_law(&geometry.outer, &bearing.outer_contact, radius, 1.0, curved),
            ],
            ball_radius: radius,
            traction: bearing.traction.clone(),
            slices,
            raceway_profiles,
        }
    }
}

fn race_law(
    raceway: &Raceway,
    hertz: &HertzContact,
    ball_radius: f64,
    outward: f64,
    differential_sliding: bool,
) -> RaceLaw {
    // Both surfaces yield alike: the radius of the pressed one is 2 r_b r_g/(r_b + r_g).
    let half_curvature = 0.25 * (1.0 / ball_radius + 1.0 / raceway.groove_radius);
    // a ∝ W^(1/3) and W = K δ^(3/2), so a = a(K)·√δ.
    RaceLaw {
        centre_axial: raceway.centre_axial,
        centre_radius: raceway.centre_radius,
        room: raceway.groove_radius - ball_radius,
        stiffness: hertz.stiffness,
        semi_major_factor: contact_ellipse(hertz, hertz.stiffness).semi_major,
        ellipticity: hertz.ellipticity,
        half_curvature: if differential_sliding { half_curvature } else { 0.0 },
        outward,
    }
}

/// Result of one evaluation, pair by pair: index = race · padded + ball.
#[derive(Clone, Debug, Default)]
pub struct ContactTable {
    pub contact: Vec<RaceContact>,
    /// N.
    pub load: Vec<f64>,
    /// Traction on the ball.
    pub traction: Vec<TractionForce>,
    pub sliding: Vec<Sliding>,
    /// Slope of traction by sliding, if requested.
    pub slope: Vec<TractionSlope>,
    /// Loaded pairs, in order.
    pub active: Vec<usize>,
    /// Pairs changed by a profile, in order; their overlap is w of [`raceway_profile`].
    pub profiled: Vec<ProfiledPair>,
}

impl ContactTable {
    pub fn new(layout: &Layout) -> ContactTable {
        let pairs = 2 * layout.padded;
        ContactTable {
            contact: vec![RaceContact::default(); pairs],
            load: vec![0.0; pairs],
            traction: vec![TractionForce::default(); pairs],
            sliding: vec![Sliding::default(); pairs],
            slope: vec![TractionSlope::default(); pairs],
            active: Vec::with_capacity(pairs),
            profiled: Vec::with_capacity(pairs),
        }
    }

    /// The pair if a profile has changed it.
    pub fn profiled(&self, pair: usize) -> Option<&ProfiledPair> {
        self.profiled.iter().find(|profiled| profiled.pair == pair)
    }
}

/// Work counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    pub evaluations: u64,
    pub distance_tests: u64,
    pub loaded_contacts: u64,
    pub slices: u64,
    pub pocket_tests: u64,
    pub guide_tests: u64,
    /// Tests of neighbouring balls.
    pub ball_tests: u64,
    /// Factorisations of the matrix of a linearly implicit step.
    pub factorisations: u64,
    /// Attempts rejected by the error control.
    pub rejected_steps: u64,
}

/// Slopes of traction in addition to forces, or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    Forces,
    ForcesAndSlopes,
}

/// Kernel of the contact loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    Scalar,
    Simd,
}

/// Inputs of the contacts of a bearing.
#[derive(Clone, Copy)]
pub struct Set<'s> {
    pub laws: &'s ContactLaws,
    pub layout: &'s Layout,
    /// Inner, outer.
    pub races: [&'s BodyKinematics; 2],
    /// Factor of the damping, s/m.
    pub damping: f64,
    pub steps: BearingSteps,
}

/// Contacts of all balls with both races.
pub fn evaluate(
    driver: Kernel,
    set: Set,
    state: &[f64],
    want: Want,
    table: &mut ContactTable,
    work: &mut Work,
    ran: &mut Counts,
) {
    let Set { laws, layout, races, .. } = set;
    match (driver, set.steps.damping) {
        (Kernel::Scalar, true) => detect_plain::<true>(&set, state, table, ran),
        (Kernel::Scalar, false) => detect_plain::<false>(&set, state, table, ran),
        (Kernel::Simd, true) => detect_lanes::<true>(&set, state, table, ran),
        (Kernel::Simd, false) => detect_lanes::<false>(&set, state, table, ran),
    }
    if set.steps.raceway_profiles {
        raceway_profile::apply(&set, state, want, table, ran);
    }
    table.active.clear();
    for race in 0..2 {
        for ball in 0..layout.balls {
            let pair = race * layout.padded + ball;
            if table.load[pair] > 0.0 || table.load[pair].is_nan() {
                table.active.push(pair);
            }
        }
    }
    work.distance_tests += 2 * layout.balls as u64;
    work.loaded_contacts += table.active.len() as u64;
    if !set.steps.traction {
        return;
    }
    let slices = (table.active.len() * laws.slices.middle.len()) as u64;
    work.slices += slices;
    ran.add(Stage::Traction, slices);
    match (driver, want) {
        (Kernel::Scalar, _) => traction_plain(laws, layout, state, races, want, table),
        (Kernel::Simd, Want::Forces) => {
            traction_lanes::<false>(laws, layout, state, races, table);
        }
        (Kernel::Simd, Want::ForcesAndSlopes) => {
            traction_lanes::<true>(laws, layout, state, races, table);
        }
    }
}

/// Load of a pair; the damping factor is not evaluated without damping.
#[inline(always)]
fn load_of<const DAMPED: bool>(law: &RaceLaw, contact: &RaceContact, factor: f64) -> f64 {
    if DAMPED {
        damped_load(law.stiffness, contact.overlap, contact.closing_speed, factor)
    } else {
        normal_load(law.stiffness, contact.overlap)
    }
}

/// Counts tested pairs, and pairs with damped loads.
fn count_pairs<const DAMPED: bool>(layout: &Layout, ran: &mut Counts) {
    let pairs = 2 * layout.balls as u64;
    ran.add(Stage::DistanceTest, pairs);
    if DAMPED {
        ran.add(Stage::ContactDamping, pairs);
    }
}

fn detect_plain<const DAMPED: bool>(
    set: &Set,
    state: &[f64],
    table: &mut ContactTable,
    ran: &mut Counts,
) {
    let Set { laws, layout, races, damping, .. } = *set;
    count_pairs::<DAMPED>(layout, ran);
    for (race, now) in races.into_iter().enumerate() {
        let motion = &now.motion;
        for ball in 0..layout.balls {
            let pair = race * layout.padded + ball;
            let contact = race_contact(
                sub(layout.ball_vector(state, POSITION, ball), motion.position),
                sub(layout.ball_vector(state, VELOCITY, ball), motion.velocity),
                motion.axis,
                motion.spin,
                &laws.races[race],
            );
            table.contact[pair] = contact;
            table.load[pair] = load_of::<DAMPED>(&laws.races[race], &contact, damping);
        }
    }
}

/// [`LANES`] values of one component, from ball `first` on.
#[inline(always)]
pub(crate) fn lane(layout: &Layout, state: &[f64], component: usize, first: usize) -> [f64; LANES] {
    let at = layout.ball(component) + first;
    let mut values = [0.0; LANES];
    values.copy_from_slice(&state[at..at + LANES]);
    values
}

fn detect_lanes<const DAMPED: bool>(
    set: &Set,
    state: &[f64],
    table: &mut ContactTable,
    ran: &mut Counts,
) {
    let Set { laws, layout, races, damping, .. } = *set;
    count_pairs::<DAMPED>(layout, ran);
    for first in (0..layout.padded).step_by(LANES) {
        let component = |c: usize| lane(layout, state, c, first);
        let position = [0, 1, 2].map(|i| component(POSITION + i));
        let velocity = [0, 1, 2].map(|i| component(VELOCITY + i));
        for (race, now) in races.into_iter().enumerate() {
            let motion = &now.motion;
            let law = &laws.races[race];
            let pair = race * layout.padded + first;
            let mut contacts = [RaceContact::default(); LANES];
            let mut loads = [0.0; LANES];
            for l in 0..LANES {
                let at = |v: &[[f64; LANES]; 3]| [v[0][l], v[1][l], v[2][l]];
                let contact = race_contact(
                    sub(at(&position), motion.position),
                    sub(at(&velocity), motion.velocity),
                    motion.axis,
                    motion.spin,
                    law,
                );
                contacts[l] = contact;
                loads[l] = load_of::<DAMPED>(law, &contact, damping);
            }
            table.contact[pair..pair + LANES].copy_from_slice(&contacts);
            table.load[pair..pair + LANES].copy_from_slice(&loads);
        }
    }
}
