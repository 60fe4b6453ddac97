//! Traction of the loaded ball–race contacts of one evaluation, contact by contact or over blocks. Loads and positions
//! are those of [`detection`](crate::members::contacts).

use crate::ch2_housing::bearing::contact::RaceContact;
use crate::ch2_housing::bearing::slices::{
    Motion, Patch, SliceSum, Sliding, TractionSlope, add_slice, add_slope, integrate,
    integrate_slope, sliding, traction_force,
};
use crate::ch2_housing::bearing::traction::{
    Resistance, Steepness, TractionLaw, per_entrainment, resistance, rounded_resistance,
    rounded_steepness, steepness,
};
use crate::kinematics::vec3::Vec3;
use crate::members::contacts::{ContactLaws, ContactTable, Want};
use crate::members::rigid_body::BodyKinematics;
use crate::members::state::{LANES, Layout, POSITION, SPIN, VELOCITY};

/// Velocities of ball and race at a pair.
#[inline(always)]
fn ball_motion(layout: &Layout, state: &[f64], ball: usize) -> Motion {
    Motion {
        position: layout.ball_vector(state, POSITION, ball),
        velocity: layout.ball_vector(state, VELOCITY, ball),
        spin: layout.ball_vector(state, SPIN, ball),
    }
}

#[inline(always)]
fn race_motion(now: &BodyKinematics) -> Motion {
    Motion { position: now.motion.position, velocity: now.motion.velocity, spin: now.motion.spin }
}

/// Distance from the ball centre to the contact point: half of the overlap is the ball's.
#[inline(always)]
fn lever(laws: &ContactLaws, overlap: f64) -> f64 {
    laws.ball_radius - 0.5 * overlap
}

#[inline(always)]
fn patch(laws: &ContactLaws, race: usize, overlap: f64) -> Patch {
    let semi_major = laws.races[race].semi_major_factor * overlap.sqrt();
    let semi_minor = semi_major / laws.races[race].ellipticity;
    Patch { semi_major, semi_minor, half_curvature: laws.races[race].half_curvature }
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
    let (race, ball) = layout.race_and_ball(pair);
    sliding(
        &ball_motion(layout, state, ball),
        &races[race],
        axes[race],
        contact.outward,
        contact.normal,
        lever(laws, contact.overlap),
    )
}

/// Traction contact by contact.
pub(crate) fn traction_plain(
    laws: &ContactLaws,
    layout: &Layout,
    state: &[f64],
    races: [&BodyKinematics; 2],
    want: Want,
    table: &mut ContactTable,
) {
    // Pair by pair: `map` would copy the array several times.
    let motions = [race_motion(races[0]), race_motion(races[1])];
    let axes = [races[0].motion.axis, races[1].motion.axis];
    for &pair in &table.active {
        let (race, _) = layout.race_and_ball(pair);
        let contact = &table.contact[pair];
        let sliding = sliding_of(laws, layout, state, &motions, &axes, pair, contact);
        let patch = patch(laws, race, contact.overlap);
        let (law, slices) = (&laws.traction, &laws.slices);
        let sum = integrate(law, slices, &sliding, &patch);
        if want == Want::ForcesAndSlopes {
            table.slope[pair] = integrate_slope(law, slices, &sliding, &patch);
        }
        table.traction[pair] = traction_force(&sum, &sliding, contact.normal, table.load[pair]);
        table.sliding[pair] = sliding;
    }
}

/// Traction over blocks of [`LANES`] contacts.
pub(crate) fn traction_lanes<const SLOPES: bool>(
    laws: &ContactLaws,
    layout: &Layout,
    state: &[f64],
    races: [&BodyKinematics; 2],
    table: &mut ContactTable,
) {
    // One instance of the loop for each law, without branches inside. Without slopes the compiler drops their terms.
    match &laws.traction {
        TractionLaw::None => {}
        TractionLaw::SlideToRoll { curve, entrainment_floor } => {
            let (curve, floor) = (*curve, *entrainment_floor);
            let prepare = |entrainment| per_entrainment(entrainment, floor);
            let slopes = |square, share, per_rolling: f64| {
                steepness(square, share, |slip| {
                    let (value, slope) = curve.coefficient_and_slope(slip * per_rolling);
                    (value, slope * per_rolling)
                })
            };
            let friction = |square, share, per_rolling: f64| {
                resistance(square, share, |slip| curve.coefficient(slip * per_rolling))
            };
            lanes_of::<SLOPES>(laws, layout, state, races, table, prepare, (friction, slopes));
        }
        TractionLaw::SlipSpeed { curve } => {
            let curve = *curve;
            let slopes = |square, share, _| {
                steepness(square, share, |slip| curve.coefficient_and_slope(slip))
            };
            let friction =
                |square, share, _| resistance(square, share, |slip| curve.coefficient(slip));
            lanes_of::<SLOPES>(laws, layout, state, races, table, |_| 0.0, (friction, slopes));
        }
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            let (coefficient, speed) = (*coefficient, *regularisation_speed);
            let slopes = |square, share, _| rounded_steepness(square, share, coefficient, speed);
            let friction = |square, share, _| rounded_resistance(square, share, coefficient, speed);
            lanes_of::<SLOPES>(laws, layout, state, races, table, |_| 0.0, (friction, slopes));
        }
    }
}

/// `friction` returns the resistance of a slice from the squared sliding speed, its share of the load and the result of
/// `prepare` for the entrainment speed; `slopes` returns its derivative.
#[inline(always)]
fn lanes_of<const SLOPES: bool>(
    laws: &ContactLaws,
    layout: &Layout,
    state: &[f64],
    races: [&BodyKinematics; 2],
    table: &mut ContactTable,
    prepare: impl Fn(f64) -> f64,
    (friction, slopes): (
        impl Fn(f64, f64, f64) -> Resistance + Copy,
        impl Fn(f64, f64, f64) -> Steepness + Copy,
    ),
) {
    // Pair by pair: `map` would copy the array several times.
    let motions = [race_motion(races[0]), race_motion(races[1])];
    let axes = [races[0].motion.axis, races[1].motion.axis];
    let ContactTable { contact, load, traction, sliding, slope, active, .. } = table;
    for block in active.chunks(LANES) {
        let mut slip = [[0.0; LANES]; 2];
        let mut spin = [[0.0; LANES]; 3];
        let mut patches = Patches::default();
        // Values of the law that depend on the entrainment speed; lanes without a pair do not slide.
        let mut rolling = [1.0; LANES];
        for (l, &pair) in block.iter().enumerate() {
            let (race, _) = layout.race_and_ball(pair);
            let here = sliding_of(laws, layout, state, &motions, &axes, pair, &contact[pair]);
            slip[0][l] = here.slip[0];
            slip[1][l] = here.slip[1];
            for (axis, of_axis) in spin.iter_mut().enumerate() {
                of_axis[l] = here.relative_spin[axis];
            }
            rolling[l] = prepare(here.entrainment);
            patches.put(l, laws.slices.across, patch(laws, race, contact[pair].overlap));
            sliding[pair] = here;
        }
        let of_law = (friction, slopes);
        let (sums, steep) = if laws.slices.across {
            slice_lanes::<SLOPES, true>(laws, &slip, &spin, &patches, &rolling, of_law)
        } else {
            slice_lanes::<SLOPES, false>(laws, &slip, &spin, &patches, &rolling, of_law)
        };
        for (l, &pair) in block.iter().enumerate() {
            if SLOPES {
                slope[pair] = steep[l];
            }
            traction[pair] =
                traction_force(&sums[l], &sliding[pair], contact[pair].normal, load[pair]);
        }
    }
}

/// [`Patch`] of each contact of a block, an array for each number.
#[derive(Default)]
struct Patches {
    semi_major: [f64; LANES],
    semi_minor: [f64; LANES],
    half_curvature: [f64; LANES],
}

impl Patches {
    #[inline(always)]
    fn put(&mut self, lane: usize, across: bool, patch: Patch) {
        self.semi_major[lane] = patch.semi_major;
        // A division needed only by points beside the middle of a slice.
        if across {
            self.semi_minor[lane] = patch.semi_minor;
            self.half_curvature[lane] = patch.half_curvature;
        }
    }

    #[inline(always)]
    fn at(&self, lane: usize) -> Patch {
        Patch {
            semi_major: self.semi_major[lane],
            semi_minor: self.semi_minor[lane],
            half_curvature: self.half_curvature[lane],
        }
    }
}

/// All slices of a block of contacts.
#[inline(always)]
fn slice_lanes<const SLOPES: bool, const ACROSS: bool>(
    laws: &ContactLaws,
    slip: &[[f64; LANES]; 2],
    spin: &[[f64; LANES]; 3],
    patches: &Patches,
    prepared: &[f64; LANES],
    (friction, slopes): (
        impl Fn(f64, f64, f64) -> Resistance + Copy,
        impl Fn(f64, f64, f64) -> Steepness + Copy,
    ),
) -> ([SliceSum; LANES], [TractionSlope; LANES]) {
    // One array for each sum: an array of arrays prevents vectorisation.
    let mut rolling = [0.0; LANES];
    let mut transverse = [0.0; LANES];
    let mut moment = [0.0; LANES];
    let mut moment_t = [0.0; LANES];
    let mut moment_s = [0.0; LANES];
    let mut power = [0.0; LANES];
    let mut tt = [0.0; LANES];
    let mut ts = [0.0; LANES];
    let mut tn = [0.0; LANES];
    let mut ss = [0.0; LANES];
    let mut sn = [0.0; LANES];
    let mut nn = [0.0; LANES];
    for (middle, offset, share) in laws.slices.points() {
        for l in 0..LANES {
            let point = patches.at(l).point(middle, offset);
            let before = SliceSum {
                rolling: rolling[l],
                transverse: transverse[l],
                moment: moment[l],
                moment_t: moment_t[l],
                moment_s: moment_s[l],
                power: power[l],
            };
            let spins = [spin[0][l], spin[1][l], spin[2][l]];
            let here = [slip[0][l], slip[1][l]];
            let friction = |square, share| friction(square, share, prepared[l]);
            let after = add_slice::<ACROSS>(&before, here, spins, point, share, friction);
            rolling[l] = after.rolling;
            transverse[l] = after.transverse;
            moment[l] = after.moment;
            moment_t[l] = after.moment_t;
            moment_s[l] = after.moment_s;
            power[l] = after.power;
            if SLOPES {
                let before = [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]];
                let slopes = |square, share| slopes(square, share, prepared[l]);
                [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]] =
                    add_slope::<ACROSS>(&before, here, spins, point, share, slopes);
            }
        }
    }
    let mut sums = [SliceSum::default(); LANES];
    for (l, sum) in sums.iter_mut().enumerate() {
        *sum = SliceSum {
            rolling: rolling[l],
            transverse: transverse[l],
            moment: moment[l],
            moment_t: moment_t[l],
            moment_s: moment_s[l],
            power: power[l],
        };
    }
    let slopes = std::array::from_fn(|l| [tt[l], ts[l], tn[l], ss[l], sn[l], nn[l]]);
    (sums, slopes)
}
