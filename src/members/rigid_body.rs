//! Motion of a race: prescribed coordinates are imposed, the others follow from loads.

use crate::ch2_housing::bearing::cage::AxisMotion;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::Pose;
use crate::kinematics::euler::about;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};
use crate::members::body::{Body, Drive, DrivenBody, Mobility, Rotation};
use crate::members::mount::Mount;
use crate::members::state::BodyState;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// A race at one instant.
#[derive(Clone, Copy, Debug)]
pub struct BodyKinematics {
    pub state: BodyState,
    pub motion: AxisMotion,
    /// Axes of tilt_y and tilt_z: e₂ and e₃, which do not spin with the race.
    pub tilt_directions: [Vec3; 2],
    /// cos λ.
    pub cos_lambda: f64,
}

impl BodyKinematics {
    pub fn new(state: BodyState) -> BodyKinematics {
        let motion = axis_motion(&state);
        let (tilt_directions, cos_lambda) = directions(motion.axis);
        BodyKinematics { state, motion, tilt_directions, cos_lambda }
    }

    /// tilt_y = ξ and tilt_z = λ, rad.
    pub fn tilts(&self) -> [f64; 2] {
        tilts_of(self.motion.axis)
    }
}

/// Tilts ξ, λ of an axis (cos λ cos ξ, sin λ, −cos λ sin ξ).
pub fn tilts_of(axis: Vec3) -> [f64; 2] {
    [libm::atan2(-axis[2], axis[0]), libm::asin(axis[1].clamp(-1.0, 1.0))]
}

pub(crate) fn axis_motion(state: &BodyState) -> AxisMotion {
    AxisMotion {
        position: state.position,
        velocity: state.velocity,
        spin: state.spin,
        axis: state.axis(),
    }
}

/// Ry(ξ) Rz(λ) applied to Y and Z, from the axis alone and without an angle, and cos λ.
pub(crate) fn directions(axis: Vec3) -> ([Vec3; 2], f64) {
    let cos_lambda = (axis[0] * axis[0] + axis[2] * axis[2]).sqrt();
    let per_cos = 1.0 / cos_lambda;
    let (cos_xi, sin_xi, sin_lambda) = (axis[0] * per_cos, -axis[2] * per_cos, axis[1]);
    let e2 = [-sin_lambda * cos_xi, cos_lambda, sin_lambda * sin_xi];
    ([e2, [sin_xi, 0.0, cos_xi]], cos_lambda)
}

/// The race of a state, with every prescribed coordinate and rate at its value.
pub fn with_prescribed(body: &DrivenBody, t: f64, mut state: BodyState) -> BodyKinematics {
    for i in 0..3 {
        if let Drive::Motion(profile) = &body.drives[i] {
            state.position[i] = profile.value(t);
            state.velocity[i] = profile.rate(t);
        }
    }
    let given = |k: usize| match &body.drives[3 + k] {
        Drive::Motion(profile) => Some(profile),
        Drive::Load(_) => None,
    };
    let moved = given(0).is_some() || given(1).is_some();
    if moved {
        let both = given(0).is_some() && given(1).is_some();
        let mut tilts = if both { [0.0; 2] } else { tilts_of(state.axis()) };
        for (k, tilt) in tilts.iter_mut().enumerate() {
            if let Some(profile) = given(k) {
                *tilt = profile.value(t);
            }
        }
        state.orientation = with_tilts(&state.orientation, tilts);
    }
    let axis = state.axis();
    let ([e2, e3], cos_lambda) = directions(axis);
    let mut parts = [dot(state.spin, axis), dot(state.spin, e2), dot(state.spin, e3)];
    if let Some(profile) = given(0) {
        parts[1] = profile.rate(t) * cos_lambda;
    }
    if let Some(profile) = given(1) {
        parts[2] = profile.rate(t);
    }
    let speed_given = match &body.rotation {
        Rotation::Speed(profile) => {
            parts[0] = profile.value(t);
            true
        }
        Rotation::Torque(_) => false,
    };
    if moved || speed_given {
        state.spin = add_scaled(add_scaled(scale(axis, parts[0]), parts[1], e2), parts[2], e3);
    }
    let BodyState { position, velocity, spin, .. } = state;
    let motion = AxisMotion { position, velocity, spin, axis };
    BodyKinematics { state, motion, tilt_directions: [e2, e3], cos_lambda }
}

/// A body of an assembly for its state at time `t`, with prescribed motions.
pub fn body_now(body: &Body, t: f64, state: BodyState) -> BodyKinematics {
    match &body.mobility {
        Mobility::Fixed => fixed(&body.rest),
        Mobility::Driven(race) => with_prescribed(race, t, state),
        Mobility::Free(_) | Mobility::Carried => BodyKinematics::new(state),
    }
}

/// The same spin angle under new tilts.
fn with_tilts(orientation: &UnitQuaternion<f64>, tilts: [f64; 2]) -> UnitQuaternion<f64> {
    let turn = |[xi, lambda]: [f64; 2]| about(Vector3::y(), xi) * about(Vector3::z(), lambda);
    let axis: Vec3 = (orientation * Vector3::x()).into();
    let spin = turn(tilts_of(axis)).inverse() * orientation;
    let about_x = UnitQuaternion::from_quaternion(Quaternion::new(spin.w, spin.i, 0.0, 0.0));
    turn(tilts) * about_x
}

/// A fixed race at x, y, z, tilt_y, tilt_z.
pub fn fixed(at: &[f64; 5]) -> BodyKinematics {
    let mut state = BodyState::at_rest([at[0], at[1], at[2]]);
    state.orientation = about(Vector3::y(), at[3]) * about(Vector3::z(), at[4]);
    BodyKinematics::new(state)
}

/// A race at rest at a pose.
pub fn kinematics_at_rest(pose: &Pose) -> BodyKinematics {
    let mut state = BodyState::at_rest(pose.position.into());
    state.orientation = pose.orientation;
    BodyKinematics::new(state)
}

/// The race on a body at a mount.
pub fn kinematics_at_mount(body: &BodyKinematics, mount: &Mount) -> BodyKinematics {
    if mount.is_direct() {
        return *body;
    }
    let arm = scale(body.motion.axis, mount.along);
    let mut state = body.state;
    state.position = add(state.position, arm);
    state.velocity = add(state.velocity, cross(state.spin, arm));
    if mount.reversed {
        // Half a turn about Z.
        state.orientation *= UnitQuaternion::new_unchecked(Quaternion::new(0.0, 0.0, 0.0, 1.0));
    }
    BodyKinematics::new(state)
}

/// Force and moment on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// Contacts, gravity, rotating load, unbalance; N, inertial axes.
    pub force: Vec3,
    /// About the body's centre, N·m.
    pub moment: Vec3,
}

impl Wrench {
    /// Adds a force at a point to the loads about `centre`.
    pub fn add_at(&mut self, centre: Vec3, point: Vec3, force: Vec3) {
        self.force = add(self.force, force);
        self.moment = add(self.moment, cross(sub(point, centre), force));
    }

    pub fn add(&mut self, other: &Wrench) {
        self.force = add(self.force, other.force);
        self.moment = add(self.moment, other.moment);
    }
}

/// Acceleration of a race and the powers for the ledger.
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyRates {
    pub acceleration: Vec3,
    /// dω/dt in inertial axes.
    pub spin_rate: Vec3,
    /// Work done on the race by drives (loads and prescribed motions), W.
    pub drive_power: f64,
    /// Power of the dashpots of the foundation, W, ≤ 0.
    pub foundation_power: f64,
}

/// Newton's and Euler's equations for an axisymmetric body; `rest` is the unloaded position of its foundation.
pub fn rates(
    body: &DrivenBody,
    t: f64,
    race: &BodyKinematics,
    rest: Option<&[f64; 5]>,
    loads: &Wrench,
    ran: &mut Counts,
) -> BodyRates {
    let mut force = loads.force;
    let mut moment = loads.moment;
    let state = &race.state;
    let [e2, e3] = race.tilt_directions;
    let cos_lambda = race.cos_lambda;
    // Rates of the five coordinates.
    let tilt_rates = [dot(state.spin, e2) / cos_lambda, dot(state.spin, e3)];
    let mut rates = BodyRates::default();
    // ξ rotates about Y, λ about e₃: the conjugate moments, as in statics. A moment Q/cos λ about e₂ does the work Q
    // dξ.
    let conjugate = [scale(e2, 1.0 / cos_lambda), e3];
    let mut of_foundation = [0.0; 5];
    if let Some(rest) = rest {
        of_foundation = foundation(body, race, rest, &tilt_rates, &mut rates.foundation_power);
        ran.add(Stage::Foundation, 1);
    }
    for i in 0..5 {
        let rate = if i < 3 { state.velocity[i] } else { tilt_rates[i - 3] };
        let drive = match &body.drives[i] {
            Drive::Load(profile) => profile.value(t),
            Drive::Motion(_) => 0.0,
        };
        rates.drive_power += drive * rate;
        let total = of_foundation[i] + drive;
        if i < 3 {
            force[i] += total;
        } else {
            moment = add_scaled(moment, total, conjugate[i - 3]);
        }
    }
    let axis = race.motion.axis;
    let about_axis = dot(moment, axis);
    let mut axial_rate = about_axis / body.inertia.axial;
    match &body.rotation {
        Rotation::Torque(profile) => {
            let torque = profile.value(t);
            axial_rate += torque / body.inertia.axial;
            rates.drive_power += torque * dot(state.spin, axis);
        }
        Rotation::Speed(profile) => {
            let rate = profile.rate(t);
            rates.drive_power += (body.inertia.axial * rate - about_axis) * dot(state.spin, axis);
            axial_rate = rate;
        }
    }
    let across = sub(moment, scale(axis, about_axis));
    let transverse = gyroscopic(&body.inertia, axis, state.spin, across);
    rates.spin_rate =
        add(scale(transverse, 1.0 / body.inertia.transverse), scale(axis, axial_rate));
    rates.acceleration = scale(force, 1.0 / body.inertia.mass);
    impose(body, t, race, force, transverse, &mut rates);
    rates
}

/// Loads of springs and dashpots to the ground along the five coordinates, and their loss, W, ≤ 0.
fn foundation(
    body: &DrivenBody,
    race: &BodyKinematics,
    rest: &[f64; 5],
    tilt_rates: &[f64; 2],
    power: &mut f64,
) -> [f64; 5] {
    let state = &race.state;
    // Angles are needed by springs alone.
    let sprung = body.foundation_stiffness[3] != 0.0 || body.foundation_stiffness[4] != 0.0;
    let tilts = if sprung { race.tilts() } else { [rest[3], rest[4]] };
    std::array::from_fn(|i| {
        let (value, rate) = if i < 3 {
            (state.position[i], state.velocity[i])
        } else {
            (tilts[i - 3], tilt_rates[i - 3])
        };
        let spring = -body.foundation_stiffness[i] * (value - rest[i]);
        let dashpot = -body.foundation_damping[i] * rate;
        *power += dashpot * rate;
        spring + dashpot
    })
}

/// M⊥ − (Ia − It)(a·ω) ω × a, which is It dω/dt across the axis.
fn gyroscopic(inertia: &Inertia, axis: Vec3, spin: Vec3, across: Vec3) -> Vec3 {
    let momentum = (inertia.axial - inertia.transverse) * dot(axis, spin);
    add_scaled(across, -momentum, cross(spin, axis))
}

/// Acceleration and dω/dt of a free axisymmetric body, inertial axes.
pub fn free_rates(
    inertia: &Inertia,
    axis: Vec3,
    spin: Vec3,
    force: Vec3,
    moment: Vec3,
) -> (Vec3, Vec3) {
    let about_axis = dot(moment, axis);
    let across = sub(moment, scale(axis, about_axis));
    let transverse = gyroscopic(inertia, axis, spin, across);
    let spin_rate =
        add(scale(transverse, 1.0 / inertia.transverse), scale(axis, about_axis / inertia.axial));
    (scale(force, 1.0 / inertia.mass), spin_rate)
}

/// Prescribed coordinates: their acceleration is imposed, and the drive does the work.
fn impose(
    body: &DrivenBody,
    t: f64,
    race: &BodyKinematics,
    force: Vec3,
    transverse: Vec3,
    rates: &mut BodyRates,
) {
    let state = &race.state;
    for i in 0..3 {
        if let Drive::Motion(profile) = &body.drives[i] {
            let acceleration = profile.acceleration(t);
            rates.acceleration[i] = acceleration;
            rates.drive_power += (body.inertia.mass * acceleration - force[i]) * state.velocity[i];
        }
    }
    let [e2, e3] = race.tilt_directions;
    let axis = race.motion.axis;
    // sin λ and cos λ.
    let (sin, cos) = (axis[1], libm::hypot(axis[0], axis[2]));
    let (xi_rate, lambda_rate) = (dot(state.spin, e2) / cos, dot(state.spin, e3));
    let spin_about_axis = dot(state.spin, axis);
    // ω·e₂ = ξ̇ cos λ and ω·e₃ = λ̇, in directions that rotate with the tilts (not with the race): ω̇·e = d(ω·e)/dt −
    // ω·ė. The product of spin and the other tilt's rate is the gyroscopic term.
    let turning = [
        lambda_rate * spin_about_axis - 2.0 * xi_rate * lambda_rate * sin,
        xi_rate * (xi_rate * sin * cos - cos * spin_about_axis),
    ];
    for (k, direction) in [e2, e3].into_iter().enumerate() {
        if let Drive::Motion(profile) = &body.drives[3 + k] {
            let own = profile.acceleration(t) * if k == 0 { cos } else { 1.0 };
            let rate = own + turning[k];
            rates.spin_rate =
                add_scaled(rates.spin_rate, rate - dot(rates.spin_rate, direction), direction);
            let moment = body.inertia.transverse * rate - dot(transverse, direction);
            rates.drive_power += moment * dot(state.spin, direction);
        }
    }
}
