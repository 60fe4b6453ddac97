//! Ball–race contacts of one evaluation: detection for every pair, then traction for the loaded
//! ones only.
//!
//! Two drivers call the same scalar laws: [`Driver::Plain`] contact by contact, [`Driver::Lanes`]
//! over blocks of [`LANES`] contacts. The order of operations within a contact is the same, so the
//! bits are too.

use super::dents::{self, DentOnRace, DentedPair};
use super::race::RaceNow;
use super::state::{LANES, Layout, POSITION, SPIN, VELOCITY};
use crate::ch2_housing::bearing::contact::{
    RaceContact, RaceLaw, damped_load, normal_load, race_contact,
};
use crate::ch2_housing::bearing::traction::{
    Motion, SliceSum, Slices, Sliding, TractionForce, TractionLaw, TractionSlope, add_slice,
    add_slope, coefficient, coefficient_and_slope, integrate, integrate_slope, per_entrainment,
    regularised, sliding, traction_force,
};
use crate::kinematics::vec3::{Vec3, sub};
use crate::solver::plan::Stage;
use crate::solver::plan::steps::BearingSteps;
use crate::solver::plan::tally::Tally;

/// Laws that all contacts share.
#[derive(Clone, Debug)]
pub struct ContactLaws {
    /// Inner, outer.
    pub races: [RaceLaw; 2],
    pub ball_radius: f64,
    pub traction: TractionLaw,
    pub slices: Slices,
    /// 1/(2R) of the contact surface across each groove, 1/m; zero leaves the Heathcote term out.
    pub curvature: [f64; 2],
    /// In either race.
    pub dents: Vec<DentOnRace>,
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
    /// How traction falls with more sliding, where it was asked for.
    pub slope: Vec<TractionSlope>,
    /// Loaded pairs, in order.
    pub active: Vec<usize>,
    /// Pairs that a dent has changed, in order; their overlap is w of [`dents`].
    pub dented: Vec<DentedPair>,
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
            dented: Vec::with_capacity(pairs),
        }
    }

    /// What a dent has made of a pair.
    pub fn dented(&self, pair: usize) -> Option<&DentedPair> {
        self.dented.iter().find(|dented| dented.pair == pair)
    }
}

/// Work done, for tests that pin it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    pub evaluations: u64,
    pub distance_tests: u64,
    pub loaded_contacts: u64,
    pub slices: u64,
    pub pocket_tests: u64,
    pub guide_tests: u64,
    /// Of neighbouring balls.
    pub ball_tests: u64,
    /// Of the matrix of a linearly implicit step.
    pub factorisations: u64,
    /// Attempts that the error control threw away.
    pub rejected_steps: u64,
}

impl Work {
    /// Every count in one order, as files keep them.
    pub fn counts(&mut self) -> [&mut u64; 9] {
        [
            &mut self.evaluations,
            &mut self.distance_tests,
            &mut self.loaded_contacts,
            &mut self.slices,
            &mut self.pocket_tests,
            &mut self.guide_tests,
            &mut self.ball_tests,
            &mut self.factorisations,
            &mut self.rejected_steps,
        ]
    }
}

/// Whether the slopes of traction are wanted beside the forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    Forces,
    ForcesAndSlopes,
}

/// Which driver runs the contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    Plain,
    Lanes,
}

/// What the contacts of a bearing are found from.
#[derive(Clone, Copy)]
pub struct Set<'s> {
    pub laws: &'s ContactLaws,
    pub layout: &'s Layout,
    /// Inner, outer.
    pub races: [&'s RaceNow; 2],
    /// Factor of each pair, s/m.
    pub damping: &'s [f64],
    pub steps: BearingSteps,
}

/// Contacts of all balls with both races.
pub fn evaluate(
    driver: Driver,
    set: Set,
    state: &[f64],
    want: Want,
    table: &mut ContactTable,
    work: &mut Work,
    ran: &mut Tally,
) {
    let Set { laws, layout, races, .. } = set;
    match (driver, set.steps.damping) {
        (Driver::Plain, true) => detect_plain::<true>(&set, state, table, ran),
        (Driver::Plain, false) => detect_plain::<false>(&set, state, table, ran),
        (Driver::Lanes, true) => detect_lanes::<true>(&set, state, table, ran),
        (Driver::Lanes, false) => detect_lanes::<false>(&set, state, table, ran),
    }
    if set.steps.dents {
        dents::apply(&set, state, want, table, ran);
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
    // Without a curvature the slices lie in a plane.
    if laws.curvature != [0.0; 2] {
        ran.add(Stage::CurvedSurface, slices);
    }
    match (driver, want) {
        (Driver::Plain, _) => traction_plain(laws, layout, state, races, want, table),
        (Driver::Lanes, Want::Forces) => {
            traction_lanes::<false>(laws, layout, state, races, table);
        }
        (Driver::Lanes, Want::ForcesAndSlopes) => {
            traction_lanes::<true>(laws, layout, state, races, table);
        }
    }
}

/// The load of a pair; without damping its factor is not looked at.
#[inline(always)]
fn load_of<const DAMPED: bool>(law: &RaceLaw, contact: &RaceContact, factor: f64) -> f64 {
    if DAMPED {
        damped_load(law.stiffness, contact.overlap, contact.closing_speed, factor)
    } else {
        normal_load(law.stiffness, contact.overlap)
    }
}

/// Pairs that have been looked at, and those whose loads were damped.
fn count_pairs<const DAMPED: bool>(layout: &Layout, ran: &mut Tally) {
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
    ran: &mut Tally,
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
            table.load[pair] = load_of::<DAMPED>(&laws.races[race], &contact, damping[pair]);
        }
    }
}

/// [`LANES`] values of one component, from ball `first` on.
#[inline(always)]
fn lane(layout: &Layout, state: &[f64], component: usize, first: usize) -> [f64; LANES] {
    let at = layout.ball(component) + first;
    let mut values = [0.0; LANES];
    values.copy_from_slice(&state[at..at + LANES]);
    values
}

fn detect_lanes<const DAMPED: bool>(
    set: &Set,
    state: &[f64],
    table: &mut ContactTable,
    ran: &mut Tally,
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
            let factor: &[f64] = &damping[pair..pair + LANES];
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
                loads[l] = load_of::<DAMPED>(law, &contact, factor[l]);
            }
            table.contact[pair..pair + LANES].copy_from_slice(&contacts);
            table.load[pair..pair + LANES].copy_from_slice(&loads);
        }
    }
}

/// Motion of ball and race at a pair.
#[inline(always)]
fn ball_motion(layout: &Layout, state: &[f64], ball: usize) -> Motion {
    Motion {
        position: layout.ball_vector(state, POSITION, ball),
        velocity: layout.ball_vector(state, VELOCITY, ball),
        spin: layout.ball_vector(state, SPIN, ball),
    }
}

fn race_motion(now: &RaceNow) -> Motion {
    Motion { position: now.motion.position, velocity: now.motion.velocity, spin: now.motion.spin }
}

/// Distance from the ball centre to the contact point: the overlap is shared in halves.
#[inline(always)]
fn reach(laws: &ContactLaws, overlap: f64) -> f64 {
    laws.ball_radius - 0.5 * overlap
}

#[inline(always)]
fn semi_major(laws: &ContactLaws, race: usize, overlap: f64) -> f64 {
    laws.races[race].semi_major_factor * overlap.sqrt()
}

fn sliding_of(
    laws: &ContactLaws,
    layout: &Layout,
    state: &[f64],
    races: &[Motion; 2],
    axes: &[Vec3; 2],
    pair: usize,
    contact: &RaceContact,
) -> Sliding {
    let (race, ball) = (pair / layout.padded, pair % layout.padded);
    sliding(
        &ball_motion(layout, state, ball),
        &races[race],
        axes[race],
        contact.outward,
        contact.normal,
        reach(laws, contact.overlap),
    )
}

fn traction_plain(
    laws: &ContactLaws,
    layout: &Layout,
    state: &[f64],
    races: [&RaceNow; 2],
    want: Want,
    table: &mut ContactTable,
) {
    let motions = races.map(race_motion);
    let axes = races.map(|now| now.motion.axis);
    for &pair in &table.active {
        let race = pair / layout.padded;
        let contact = &table.contact[pair];
        let sliding = sliding_of(laws, layout, state, &motions, &axes, pair, contact);
        let width = semi_major(laws, race, contact.overlap);
        let (law, slices, curvature) = (&laws.traction, &laws.slices, laws.curvature[race]);
        let sum = integrate(law, slices, &sliding, width, curvature);
        if want == Want::ForcesAndSlopes {
            table.slope[pair] = integrate_slope(law, slices, &sliding, width, curvature);
        }
        table.traction[pair] = traction_force(&sum, &sliding, contact.normal, table.load[pair]);
        table.sliding[pair] = sliding;
    }
}

fn traction_lanes<const SLOPES: bool>(
    laws: &ContactLaws,
    layout: &Layout,
    state: &[f64],
    races: [&RaceNow; 2],
    table: &mut ContactTable,
) {
    // One instance of the loop for each law, so that nothing is decided inside it. Without slopes
    // the compiler drops what only they need.
    match &laws.traction {
        TractionLaw::None => {}
        TractionLaw::SlideToRoll { curve, entrainment_floor } => {
            let (curve, floor) = (*curve, *entrainment_floor);
            let prepare = |entrainment| per_entrainment(entrainment, floor);
            let friction = |slip: f64, per_rolling: f64| {
                let (value, slope) = curve.coefficient_and_slope(slip * per_rolling);
                (value, slope * per_rolling)
            };
            lanes_of::<SLOPES>(laws, layout, state, races, table, prepare, friction);
        }
        TractionLaw::SlipSpeed { curve } => {
            let curve = *curve;
            let friction = |slip, _| curve.coefficient_and_slope(slip);
            lanes_of::<SLOPES>(laws, layout, state, races, table, |_| 0.0, friction);
        }
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            let (coefficient, speed) = (*coefficient, *regularisation_speed);
            let friction = |slip, _| regularised(coefficient, speed, slip);
            lanes_of::<SLOPES>(laws, layout, state, races, table, |_| 0.0, friction);
        }
        law @ TractionLaw::Table { .. } => {
            let friction = |slip, entrainment| {
                if SLOPES {
                    coefficient_and_slope(law, slip, entrainment)
                } else {
                    (coefficient(law, slip, entrainment), 0.0)
                }
            };
            lanes_of::<SLOPES>(
                laws,
                layout,
                state,
                races,
                table,
                |entrainment| entrainment,
                friction,
            );
        }
    }
}

#[inline(always)]
fn lanes_of<const SLOPES: bool>(
    laws: &ContactLaws,
    layout: &Layout,
    state: &[f64],
    races: [&RaceNow; 2],
    table: &mut ContactTable,
    prepare: impl Fn(f64) -> f64,
    friction: impl Fn(f64, f64) -> (f64, f64) + Copy,
) {
    let motions = races.map(race_motion);
    let axes = races.map(|now| now.motion.axis);
    let ContactTable { contact, load, traction, sliding, slope, active, .. } = table;
    for block in active.chunks(LANES) {
        let mut slip = [[0.0; LANES]; 2];
        let mut spin = [[0.0; LANES]; 3];
        let mut width = [0.0; LANES];
        let mut curvature = [0.0; LANES];
        // What the law needs of the entrainment speed; lanes without a pair slide nowhere.
        let mut rolling = [1.0; LANES];
        for (l, &pair) in block.iter().enumerate() {
            let race = pair / layout.padded;
            let here = sliding_of(laws, layout, state, &motions, &axes, pair, &contact[pair]);
            slip[0][l] = here.slip[0];
            slip[1][l] = here.slip[1];
            for i in 0..3 {
                spin[i][l] = here.relative_spin[i];
            }
            rolling[l] = prepare(here.entrainment);
            width[l] = semi_major(laws, race, contact[pair].overlap);
            curvature[l] = laws.curvature[race];
            sliding[pair] = here;
        }
        let (sums, slopes) =
            slice_lanes::<SLOPES>(laws, &slip, &spin, &width, &curvature, &rolling, friction);
        for (l, &pair) in block.iter().enumerate() {
            if SLOPES {
                slope[pair] = slopes[l];
            }
            traction[pair] =
                traction_force(&sums[l], &sliding[pair], contact[pair].normal, load[pair]);
        }
    }
}

/// All slices of a block of contacts.
#[inline(always)]
fn slice_lanes<const SLOPES: bool>(
    laws: &ContactLaws,
    slip: &[[f64; LANES]; 2],
    spin: &[[f64; LANES]; 3],
    width: &[f64; LANES],
    curvature: &[f64; LANES],
    prepared: &[f64; LANES],
    friction: impl Fn(f64, f64) -> (f64, f64) + Copy,
) -> ([SliceSum; LANES], [TractionSlope; LANES]) {
    // One array for each sum: an array of arrays would keep the loop from becoming vector code.
    let mut rolling = [0.0; LANES];
    let mut transverse = [0.0; LANES];
    let mut moment = [0.0; LANES];
    let mut about_t = [0.0; LANES];
    let mut about_s = [0.0; LANES];
    let mut power = [0.0; LANES];
    let mut tt = [0.0; LANES];
    let mut ts = [0.0; LANES];
    let mut tn = [0.0; LANES];
    let mut ss = [0.0; LANES];
    let mut sn = [0.0; LANES];
    let mut nn = [0.0; LANES];
    for (middle, share) in laws.slices.middle.iter().zip(&laws.slices.share) {
        for l in 0..LANES {
            let y = middle * width[l];
            let sagitta = y * y * curvature[l];
            let before = SliceSum {
                rolling: rolling[l],
                transverse: transverse[l],
                moment: moment[l],
                curvature_moment: [about_t[l], about_s[l]],
                power: power[l],
            };
            let here = [slip[0][l], slip[1][l]];
            let turning = [spin[0][l], spin[1][l], spin[2][l]];
            let coefficient = |speed| friction(speed, prepared[l]).0;
            let after = add_slice(&before, here, turning, y, sagitta, *share, coefficient);
            rolling[l] = after.rolling;
            transverse[l] = after.transverse;
            moment[l] = after.moment;
            [about_t[l], about_s[l]] = after.curvature_moment;
            power[l] = after.power;
            if SLOPES {
                let before = [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]];
                let friction = |speed| friction(speed, prepared[l]);
                [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]] =
                    add_slope(&before, here, turning, y, sagitta, *share, friction);
            }
        }
    }
    let mut sums = [SliceSum::default(); LANES];
    for (l, sum) in sums.iter_mut().enumerate() {
        *sum = SliceSum {
            rolling: rolling[l],
            transverse: transverse[l],
            moment: moment[l],
            curvature_moment: [about_t[l], about_s[l]],
            power: power[l],
        };
    }
    let slopes = std::array::from_fn(|l| [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]]);
    (sums, slopes)
}
