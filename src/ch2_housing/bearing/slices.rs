//! Sliding of a ball on a race, and traction integrated over the contact ellipse.
//!
//! The dissertation varies the sliding speed along the major axis only (2.2.1). The ellipse is cut into slices across
//! this axis. Each slice has its own slip and the share of the normal load given by Hertz's pressure,
//! q(y) = (3W/4a)(1 − y²/a²); its friction follows from a law of [`traction`](super::traction). As an extension,
//! several points across a slice also resolve the slip that spin adds along the minor axis, and the curvature of the
//! pressed surfaces the differential sliding of a ball that rolls in a groove (Heathcote).
//!
//! The functions are scalar and branch-free, so that they vectorise.

use core::f64::consts::PI;

use super::traction::{Resistance, Steepness, TractionLaw, resistance_of, steepness_of};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};

/// Integration points of the contact ellipse: position of the slice on the major axis (y/a), offset along the minor
/// axis (x/b), and share of the normal load.
#[derive(Clone, Debug, PartialEq)]
pub struct Slices {
    pub middle: Vec<f64>,
    pub offset: Vec<f64>,
    pub share: Vec<f64>,
    /// True if points lie off the major axis, or off the tangent plane.
    pub across: bool,
}

impl Slices {
    /// `count` slices of equal width; each share is the exact integral of Hertz's pressure over the slice, so that the
    /// shares sum to one.
    ///
    /// Each slice has `across` points. The pressure along it is q(x) ∝ √(1 − (x/w)²), w = b√(1 − (y/a)²), the weight of
    /// the Gauss–Chebyshev rule of the second kind: points xⱼ = w cos(jπ/(n + 1)), shares
    /// 2 sin²(jπ/(n + 1))/(n + 1). A single point is on the major axis.
    pub fn new(count: usize, across: usize) -> Slices {
        let width = 2.0 / count as f64;
        // ∫ (3/4)(1 − η²) dη.
        let integral = |eta: f64| 0.75 * (eta - eta * eta * eta / 3.0);
        let edge = |i: usize| -1.0 + width * i as f64;
        let mut slices = Slices {
            middle: Vec::new(),
            offset: Vec::new(),
            share: Vec::new(),
            across: across > 1,
        };
        for i in 0..count {
            let middle = -1.0 + width * (i as f64 + 0.5);
            let share = integral(edge(i + 1)) - integral(edge(i));
            for j in 1..=across {
                let (part, offset) = across_slice(j, across);
                slices.middle.push(middle);
                slices.offset.push(offset * (1.0 - middle * middle).sqrt());
                slices.share.push(share * part);
            }
        }
        slices
    }
}

/// Share and position (divided by the half width) of point `j` (1 to `points`) across a slice.
fn across_slice(j: usize, points: usize) -> (f64, f64) {
    if 2 * j == points + 1 {
        // cos(π/2) is not exactly zero in floating point.
        return (2.0 / (points + 1) as f64, 0.0);
    }
    let angle = j as f64 * PI / (points + 1) as f64;
    let (sine, cosine) = libm::sincos(angle);
    (2.0 * sine * sine / (points + 1) as f64, cosine)
}

/// Motion of a rigid body, inertial axes: m, m/s, rad/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    pub position: Vec3,
    pub velocity: Vec3,
    pub spin: Vec3,
}

/// Sliding of a ball on a race at the centre of the contact, and its variation over the contact.
///
/// t is the rolling direction (about the race's axis), n the outward normal of the ball, s = n × t.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sliding {
    pub rolling_direction: Vec3,
    pub transverse_direction: Vec3,
    /// Vector from the ball centre to the contact point, m.
    pub arm_on_ball: Vec3,
    /// Vector from the race's centre to the contact point, m.
    pub arm_on_race: Vec3,
    /// Slip of the ball's surface over the race's at the centre: t and s components, m/s.
    pub slip: [f64; 2],
    /// Relative spin about t, s and n, rad/s.
    pub relative_spin: Vec3,
    /// Mean speed of both surfaces relative to the contact (entrainment speed), m/s, ≥ 0.
    pub entrainment: f64,
}

/// Sliding at a contact. `normal` is the outward normal of the ball, `axis` the race's axis and `outward` the unit
/// vector from the axis to the ball.
#[inline(always)]
pub fn sliding(
    ball: &Motion,
    race: &Motion,
    axis: Vec3,
    outward: Vec3,
    normal: Vec3,
    arm_length: f64,
) -> Sliding {
    let rolling_direction = cross(axis, outward);
    let transverse_direction = cross(normal, rolling_direction);
    let arm_on_ball = scale(normal, arm_length);
    let between = sub(ball.position, race.position);
    let arm_on_race = add(between, arm_on_ball);
    let ball_surface = add(ball.velocity, cross(ball.spin, arm_on_ball));
    let race_surface = add(race.velocity, cross(race.spin, arm_on_race));
    let slip = sub(ball_surface, race_surface);
    let relative = sub(ball.spin, race.spin);
    // The contact moves around the race with the ball.
    let contact_velocity = dot(sub(ball.velocity, race.velocity), rolling_direction)
        * (dot(arm_on_race, outward) / dot(between, outward))
        + dot(race.velocity, rolling_direction);
    let through = dot(add(ball_surface, race_surface), rolling_direction) - 2.0 * contact_velocity;
    Sliding {
        rolling_direction,
        transverse_direction,
        arm_on_ball,
        arm_on_race,
        slip: [dot(slip, rolling_direction), dot(slip, transverse_direction)],
        relative_spin: [
            dot(relative, rolling_direction),
            dot(relative, transverse_direction),
            dot(relative, normal),
        ],
        entrainment: 0.5 * through.abs(),
    }
}

/// Traction summed over the slices per unit of normal load: force on the ball along t and s, moment about n (m), and
/// dissipated power (m/s). Moments about t and s (m) arise where the contact is curved: about s, the rolling resistance
/// of differential sliding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SliceSum {
    pub rolling: f64,
    pub transverse: f64,
    pub moment: f64,
    pub moment_t: f64,
    pub moment_s: f64,
    pub power: f64,
}

/// Traction damping per unit of normal load: negated derivatives of the t and s forces and of the moment about n by
/// both slips and the relative spin. Upper triangle of a symmetric positive semidefinite matrix: tt, ts, tn, ss, sn,
/// nn.
pub type TractionSlope = [f64; 6];

/// Point of a contact, m from its centre: along the rolling direction (t), across it (s), and from the tangent plane
/// towards the ball's centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactPoint {
    pub x: f64,
    pub y: f64,
    pub depth: f64,
}

/// Slip at a point of a contact from the slip at its centre and the relative spin about t, s and n: t and s components,
/// m/s. Without `ACROSS`, `x` and `depth` are zero and ignored.
#[inline(always)]
fn slip_at<const ACROSS: bool>(slip: [f64; 2], spin: Vec3, point: ContactPoint) -> [f64; 2] {
    let ContactPoint { x, y, depth } = point;
    let [about_t, about_s, about_n] = spin;
    if ACROSS {
        // Spin × (x t + y s − depth n).
        [slip[0] - about_n * y - depth * about_s, slip[1] + about_n * x + depth * about_t]
    } else {
        [slip[0] - about_n * y, slip[1]]
    }
}

/// Adds the traction of a point with a `share` of the load. `friction` returns its [`Resistance`] from the square of
/// the sliding speed and the share. Without `ACROSS` the point is on the major axis; all finite results are the same
/// bit for bit.
#[inline(always)]
pub fn add_slice<const ACROSS: bool>(
    sum: &SliceSum,
    slip: [f64; 2],
    spin: Vec3,
    point: ContactPoint,
    share: f64,
    friction: impl Fn(f64, f64) -> Resistance,
) -> SliceSum {
    let ContactPoint { x, y, depth } = point;
    let [slip_t, slip_s] = slip_at::<ACROSS>(slip, spin, point);
    let [per_speed, power] = friction(slip_t * slip_t + slip_s * slip_s, share);
    let along = -per_speed * slip_t;
    let across = -per_speed * slip_s;
    let moment = sum.moment - y * along;
    SliceSum {
        rolling: sum.rolling + along,
        transverse: sum.transverse + across,
        // (x t + y s − depth n) × (along t + across s).
        moment: if ACROSS { moment + x * across } else { moment },
        moment_t: if ACROSS { sum.moment_t + depth * across } else { 0.0 },
        moment_s: if ACROSS { sum.moment_s - depth * along } else { 0.0 },
        power: sum.power - power,
    }
}

/// Adds the traction damping of a point whose force [`add_slice`] adds. `friction` returns its [`Steepness`] from the
/// square of the sliding speed and the share.
#[inline(always)]
pub fn add_slope<const ACROSS: bool>(
    sum: &TractionSlope,
    slip: [f64; 2],
    spin: Vec3,
    point: ContactPoint,
    share: f64,
    friction: impl Fn(f64, f64) -> Steepness,
) -> TractionSlope {
    let ContactPoint { x, y, .. } = point;
    let [slip_t, slip_s] = slip_at::<ACROSS>(slip, spin, point);
    let [secant, steep] = friction(slip_t * slip_t + slip_s * slip_s, share);
    let tt = secant + steep * slip_t * slip_t;
    let ts = steep * slip_t * slip_s;
    let ss = secant + steep * slip_s * slip_s;
    let [a, b, c, d, e, k] = *sum;
    let (tn, sn, nn) = (c - y * tt, e - y * ts, y * y * tt);
    if ACROSS {
        let nn = nn + x * (x * ss - 2.0 * y * ts);
        [a + tt, b + ts, tn + x * ts, d + ss, sn + x * ss, k + nn]
    } else {
        [a + tt, b + ts, tn, d + ss, sn, k + nn]
    }
}

/// Traction force and moment on the ball, inertial axes; the race takes the opposite force at the same point and the
/// opposite moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TractionForce {
    pub force: Vec3,
    /// Moment about the contact's centre, N·m: about the normal, and in a curved contact about t and s.
    pub moment: Vec3,
    /// Power of the traction, W, ≤ 0.
    pub power: f64,
}

#[inline(always)]
pub fn traction_force(
    sum: &SliceSum,
    sliding: &Sliding,
    normal: Vec3,
    normal_load: f64,
) -> TractionForce {
    let rolling = scale(sliding.rolling_direction, sum.rolling * normal_load);
    let mut moment = scale(normal, sum.moment * normal_load);
    if sum.moment_t != 0.0 || sum.moment_s != 0.0 {
        moment = add_scaled(moment, sum.moment_t * normal_load, sliding.rolling_direction);
        moment = add_scaled(moment, sum.moment_s * normal_load, sliding.transverse_direction);
    }
    TractionForce {
        force: add_scaled(rolling, sum.transverse * normal_load, sliding.transverse_direction),
        moment,
        power: sum.power * normal_load,
    }
}

/// Contact ellipse of a ball and a race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// m.
    pub semi_major: f64,
    /// Along the rolling direction, m. Not used for points on the major axis.
    pub semi_minor: f64,
    /// Depth of the pressed surface below the tangent plane divided by y², 1/m; zero without differential sliding.
    pub half_curvature: f64,
}

impl Patch {
    /// Position of a point given by fractions of the semi-axes.
    #[inline(always)]
    pub fn point(&self, middle: f64, offset: f64) -> ContactPoint {
        let y = middle * self.semi_major;
        ContactPoint { x: offset * self.semi_minor, y, depth: self.half_curvature * y * y }
    }
}

impl Slices {
    /// Position on the major axis, offset and share of each point, in order.
    #[inline(always)]
    pub fn points(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        let places = self.middle.iter().zip(&self.offset);
        places.zip(&self.share).map(|((middle, offset), share)| (*middle, *offset, *share))
    }
}

/// Traction summed over all slices of one contact, in order.
pub fn integrate(law: &TractionLaw, slices: &Slices, sliding: &Sliding, patch: &Patch) -> SliceSum {
    let mut sum = SliceSum::default();
    for (middle, offset, share) in slices.points() {
        let point = patch.point(middle, offset);
        let friction = |square, share| resistance_of(law, square, share, sliding.entrainment);
        sum = add_slice::<true>(&sum, sliding.slip, sliding.relative_spin, point, share, friction);
    }
    sum
}

/// Traction damping summed over all slices of one contact, in order; arguments as for [`integrate`].
pub fn integrate_slope(
    law: &TractionLaw,
    slices: &Slices,
    sliding: &Sliding,
    patch: &Patch,
) -> TractionSlope {
    let mut sum = TractionSlope::default();
    for (middle, offset, share) in slices.points() {
        let point = patch.point(middle, offset);
        let friction = |square, share| steepness_of(law, square, share, sliding.entrainment);
        sum = add_slope::<true>(&sum, sliding.slip, sliding.relative_spin, point, share, friction);
    }
    sum
}
