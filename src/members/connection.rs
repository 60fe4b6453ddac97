//! Connections between two sections of bodies, one `match` each: wrench on both ends, energy, loss, and Jacobian rows.
//!
//! A section is a [`Mount`] and the axes of its body. Both ends get opposite forces at the same point, so that momentum
//! is conserved; forces are the gradient of an energy for any rotation of the ends.

use crate::kinematics::vec3::{Vec3, add, cross, dot, sub};
use crate::members::mount::Mount;
use crate::members::rigid_body::{BodyKinematics, Wrench};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// A connection and its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Connection {
    /// Name in messages.
    pub name: String,
    /// Prefix of its columns; `None`: no columns.
    pub label: Option<String>,
    /// The law is in the axes of the first end.
    pub ends: [Mount; 2],
    pub law: Law,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Linear in the displacement of the second end relative to the first.
    SpringDashpot(SpringDashpot),
    /// Against twist about the first end's axis alone.
    Torsion(Torsion),
}

/// Six springs and dashpots along and about the axes X, Y, Z of the first end, with any number of parallel Maxwell
/// elements, as of rubber.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpringDashpot {
    /// N/m, N·m/rad; with Maxwell elements the relaxed stiffness.
    pub stiffness: [f64; 6],
    /// N·s/m, N·m·s/rad.
    pub damping: [f64; 6],
    pub cross: CrossCoupling,
    pub maxwell: Vec<MaxwellElement>,
    /// Unloaded position of the second end in the axes of the first, m.
    pub rest: Vec3,
    /// Wall thickness of a bushing, m; limit of the lateral displacement of its sleeves.
    pub wall: Option<f64>,
}

/// Coupling of the lateral displacements y and z, as of journal bearings and seals: F_y = −k_yz z − c_yz ż,
/// F_z = −k_zy y − c_zy ẏ. The mean of both stiffnesses stores energy; their difference is circulatory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CrossCoupling {
    /// k_yz, k_zy, N/m.
    pub stiffness: [f64; 2],
    /// c_yz, c_zy, N·s/m.
    pub damping: [f64; 2],
}

impl CrossCoupling {
    /// Mean and half difference of the stiffnesses, N/m.
    pub fn parts(&self) -> [f64; 2] {
        let [yz, zy] = self.stiffness;
        [0.5 * (yz + zy), 0.5 * (yz - zy)]
    }

    fn is_void(&self) -> bool {
        *self == CrossCoupling::default()
    }
}

/// Six springs, each in series with a dashpot: force K e, where the elongation e (m, rad) follows the displacement q by
/// de/dt = dq/dt − e/τ. This is (2.13) for a whole bushing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaxwellElement {
    /// N/m, N·m/rad.
    pub stiffness: [f64; 6],
    /// τ, s.
    pub relaxation_time: f64,
}

/// A spring and a dashpot against the twist of the second end about the X axis of the first; bending and displacements
/// are free. Twist is measured up to half a turn either way, and needs axes that are not opposite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Torsion {
    /// N·m/rad.
    pub stiffness: f64,
    /// N·m·s/rad.
    pub damping: f64,
}

/// Forces of a connection at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpringForces {
    /// Wrench on each end, about its own centre.
    pub on: [Wrench; 2],
    /// Stored, J.
    pub energy: f64,
    /// Power of its dashpots, W, ≤ 0, and of circulatory forces, of either sign.
    pub loss: f64,
    /// Rates of the six displacements, m/s and rad/s, for Maxwell elements.
    pub rates: [f64; 6],
}

/// A direction with stiffness or damping.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// Linear and angular relative motion per unit velocity of each end, about each end's own centre, inertial axes.
    pub on: [[Vec3; 2]; 2],
    pub stiffness: f64,
    pub damping: f64,
}

/// Largest number of rows of a connection.
pub const ROWS: usize = 6;

impl Connection {
    /// Forces on both ends, with the elongations of its Maxwell elements (m, rad; six for each element); empty for
    /// relaxed elements.
    pub fn forces(&self, ends: [&BodyKinematics; 2], elongated: &[f64]) -> SpringForces {
        match &self.law {
            Law::SpringDashpot(law) => spring_dashpot(law, ends, elongated),
            Law::Torsion(law) => torsion(law, ends),
        }
    }

    /// Directions, stiffness and damping, for the matrix of a linearly implicit step and of statics. Exact at rest; the
    /// curvature of large rotations is omitted.
    pub fn rows(&self, ends: [&BodyKinematics; 2]) -> [Row; ROWS] {
        match &self.law {
            Law::SpringDashpot(law) => spring_dashpot_rows(law, ends),
            Law::Torsion(law) => torsion_rows(law, ends),
        }
    }

    /// Largest elongation and rotation of its springs, m and rad, over directions with a spring, and lateral
    /// displacement of one end, m.
    pub fn extension(&self, ends: [&BodyKinematics; 2]) -> [f64; 3] {
        match &self.law {
            Law::SpringDashpot(law) => {
                let axes = axes(ends);
                let arm = sub(ends[1].motion.position, ends[0].motion.position);
                let turn = turn_between(ends).0;
                let far = |first: usize, gone: [f64; 3]| {
                    let held = (0..3).filter(|i| law.stiffness[first + i] != 0.0);
                    // NaN is kept.
                    held.map(|i| gone[i].abs()).fold(0.0, |most, one| {
                        if one <= most || most.is_nan() { most } else { one }
                    })
                };
                let stretch = [0, 1, 2].map(|i| dot(axes[i], arm) - law.rest[i]);
                let across = libm::hypot(stretch[1], stretch[2]);
                [far(0, stretch), far(3, turn.into()), across]
            }
            Law::Torsion(law) => {
                [0.0, if law.stiffness == 0.0 { 0.0 } else { twist(ends).0.abs() }, 0.0]
            }
        }
    }

    /// Wall thickness of a bushing, m; infinite for others.
    pub fn wall(&self) -> f64 {
        match &self.law {
            Law::SpringDashpot(law) => law.wall.unwrap_or(f64::INFINITY),
            Law::Torsion(_) => f64::INFINITY,
        }
    }

    /// The connection in an equilibrium: without circulatory forces, which no energy has.
    pub fn conservative(&self) -> Connection {
        let mut all = self.clone();
        if let Law::SpringDashpot(law) = &mut all.law {
            let [mean, _] = law.cross.parts();
            law.cross.stiffness = [mean; 2];
        }
        all
    }

    /// Coupling of its lateral displacements; `None` without any.
    pub fn cross(&self) -> Option<&CrossCoupling> {
        match &self.law {
            Law::SpringDashpot(law) => Some(&law.cross).filter(|cross| !cross.is_void()),
            Law::Torsion(_) => None,
        }
    }

    /// Its Maxwell elements.
    pub fn maxwell(&self) -> &[MaxwellElement] {
        match &self.law {
            Law::SpringDashpot(law) => &law.maxwell,
            Law::Torsion(_) => &[],
        }
    }

    /// Returns whether its springs, dashpots or Maxwell elements differ between Y and Z, along or about them.
    pub fn is_uneven(&self) -> bool {
        match &self.law {
            Law::SpringDashpot(law) => {
                let mut elements = law.maxwell.iter();
                let [[k_yz, k_zy], [c_yz, c_zy]] = [law.cross.stiffness, law.cross.damping];
                uneven(&law.stiffness)
                    || uneven(&law.damping)
                    || k_yz != -k_zy
                    || c_yz != -c_zy
                    || elements.any(|element| uneven(&element.stiffness))
            }
            Law::Torsion(_) => false,
        }
    }

    /// Returns whether it has neither stiffness nor damping and may be left out.
    pub fn is_void(&self) -> bool {
        match &self.law {
            Law::SpringDashpot(law) => {
                let pushes = law.maxwell.iter().any(|element| element.stiffness != [0.0; 6]);
                let springs = law.stiffness != [0.0; 6] || law.damping != [0.0; 6];
                !springs && law.cross.is_void() && !pushes
            }
            Law::Torsion(law) => law.stiffness == 0.0 && law.damping == 0.0,
        }
    }
}

/// Returns whether values along or about X, Y, Z differ between Y and Z.
pub fn uneven(of: &[f64; 6]) -> bool {
    of[1] != of[2] || of[4] != of[5]
}

/// Rotation of the second end relative to the first, in the axes of the first, rad, and its derivative by an angular
/// velocity in these axes.
///
/// The components about Y and Z are the smallest rotation that takes the first axis X to the second (its length the
/// angle between them); the component about X is the remaining [`twist`]: a spinning shaft rotates about X alone, by
/// any angle.
fn turn_between(ends: [&BodyKinematics; 2]) -> (Vector3<f64>, Matrix3<f64>) {
    let [first, second] = ends.map(|end| end.state.orientation);
    let (angle, along) = twist_in_first(first.inverse() * second);
    let axis = first.inverse() * (second * Vector3::x());
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let square = y * y + z * z;
    let sine = square.sqrt();
    let tilt = libm::atan2(sine, x);
    // θ/sin θ, and its slope over θ, over sin θ; by series for small tilts.
    let (factor, slope) = if tilt < 1e-2 {
        (1.0 + square / 6.0 * (1.0 + 0.45 * square), (1.0 + 0.4 * square) / 3.0)
    } else {
        (tilt / sine, (sine - tilt * x) / (sine * square))
    };
    // Rate of the axis under an angular velocity.
    let swept = -axis.cross_matrix();
    let [by_x, by_y, by_z] = [0, 1, 2].map(|i| swept.row(i).into_owned());
    let grows = ((by_y * y + by_z * z) * x - by_x * square) * slope;
    let rates = [along.transpose(), -(by_z * factor + grows * z), by_y * factor + grows * y];
    (Vector3::new(angle, -factor * z, factor * y), Matrix3::from_rows(&rates))
}

/// Axes of the first end in inertial axes.
fn axes(ends: [&BodyKinematics; 2]) -> [Vec3; 3] {
    let turn = ends[0].state.orientation;
    [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (turn * axis).into())
}

/// Rates of the second end's position and rotation relative to the first, in the axes of the first.
fn rates(ends: [&BodyKinematics; 2], axes: &[Vec3; 3]) -> (Vec3, Vector3<f64>) {
    let [first, second] = ends.map(|end| &end.motion);
    let arm = sub(second.position, first.position);
    let carried = add(first.velocity, cross(first.spin, arm));
    let along = |v: Vec3| axes.map(|axis| dot(axis, v));
    (along(sub(second.velocity, carried)), along(sub(second.spin, first.spin)).into())
}

/// See [`Connection::forces`].
pub fn spring_dashpot(
    law: &SpringDashpot,
    ends: [&BodyKinematics; 2],
    elongated: &[f64],
) -> SpringForces {
    let axes = axes(ends);
    let arm = sub(ends[1].motion.position, ends[0].motion.position);
    let (speed, turning) = rates(ends, &axes);
    let (turn, turn_rate) = turn_between(ends);
    let turned = turn_rate * turning;
    let mut pull = SpringForces::default();
    let (mut force, mut moment) = ([0.0; 3], Vector3::zeros());
    for i in 0..3 {
        let stretch = dot(axes[i], arm) - law.rest[i];
        let (spring, dashpot) = (law.stiffness[i] * stretch, law.damping[i] * speed[i]);
        force[i] = -(spring + dashpot);
        moment[i] = -(law.stiffness[3 + i] * turn[i] + law.damping[3 + i] * turned[i]);
        pull.energy += 0.5 * spring * stretch + 0.5 * law.stiffness[3 + i] * turn[i] * turn[i];
        pull.loss -= dashpot * speed[i] + law.damping[3 + i] * turned[i] * turned[i];
        (pull.rates[i], pull.rates[3 + i]) = (speed[i], turned[i]);
    }
    if !law.cross.is_void() {
        let [y, z] = [1, 2].map(|i| dot(axes[i], arm) - law.rest[i]);
        add_cross(&law.cross, [y, z], [speed[1], speed[2]], &mut force, &mut pull);
    }
    for (element, by) in law.maxwell.iter().zip(elongated.as_chunks::<6>().0) {
        for i in 0..3 {
            let tension = [i, 3 + i].map(|k| element.stiffness[k] * by[k]);
            force[i] -= tension[0];
            moment[i] -= tension[1];
            let stored = tension[0] * by[i] + tension[1] * by[3 + i];
            pull.energy += 0.5 * stored;
            pull.loss -= stored / element.relaxation_time;
        }
    }
    let moment = turn_rate.transpose() * moment;
    let world = |parts: [f64; 3]| -> Vec3 {
        [0, 1, 2].map(|i| (0..3).map(|k| axes[k][i] * parts[k]).sum())
    };
    let (force, moment) = (world(force), world(moment.into()));
    let back = |v: Vec3| v.map(|part| -part);
    pull.on[1] = Wrench { force, moment };
    pull.on[0] = Wrench { force: back(force), moment: back(add(moment, cross(arm, force))) };
    pull
}

fn add_cross(
    cross: &CrossCoupling,
    [y, z]: [f64; 2],
    [y_rate, z_rate]: [f64; 2],
    force: &mut Vec3,
    pull: &mut SpringForces,
) {
    let [[k_yz, k_zy], [c_yz, c_zy]] = [cross.stiffness, cross.damping];
    let [mean, odd] = cross.parts();
    force[1] -= k_yz * z + c_yz * z_rate;
    force[2] -= k_zy * y + c_zy * y_rate;
    pull.energy += mean * y * z;
    pull.loss -= odd * (z * y_rate - y * z_rate) + (c_yz + c_zy) * y_rate * z_rate;
}

fn spring_dashpot_rows(law: &SpringDashpot, ends: [&BodyKinematics; 2]) -> [Row; ROWS] {
    let axes = axes(ends);
    let arm = sub(ends[1].motion.position, ends[0].motion.position);
    let back = |v: Vec3| v.map(|part| -part);
    std::array::from_fn(|i| {
        let axis = axes[i % 3];
        let on = if i < 3 {
            [[back(axis), back(cross(arm, axis))], [axis, [0.0; 3]]]
        } else {
            [[[0.0; 3], back(axis)], [[0.0; 3], axis]]
        };
        Row { on, stiffness: law.stiffness[i], damping: law.damping[i] }
    })
}

/// Twist of the second end about the first one's axis, rad, and the direction (inertial axes) of the relative spin that
/// increases it.
fn twist(ends: [&BodyKinematics; 2]) -> (f64, Vec3) {
    let [first, second] = ends.map(|end| end.state.orientation);
    let (angle, along) = twist_in_first(first.inverse() * second);
    (angle, (first * along).into())
}

/// The same for a relative rotation q, with the direction in the first end's axes: φ = 2 atan(q_x/q_w).
fn twist_in_first(q: UnitQuaternion<f64>) -> (f64, Vector3<f64>) {
    let (w, x, y, z) = (q.w, q.i, q.j, q.k);
    let size = w * w + x * x;
    let angle = if w < 0.0 { libm::atan2(-x, -w) } else { libm::atan2(x, w) };
    (2.0 * angle, Vector3::new(1.0, (w * z + x * y) / size, (x * z - w * y) / size))
}

fn torsion(law: &Torsion, ends: [&BodyKinematics; 2]) -> SpringForces {
    let (angle, along) = twist(ends);
    let rate = dot(along, sub(ends[1].motion.spin, ends[0].motion.spin));
    let moment = along.map(|part| -part * (law.stiffness * angle + law.damping * rate));
    let on = |moment| Wrench { force: [0.0; 3], moment };
    SpringForces {
        on: [on(moment.map(|part| -part)), on(moment)],
        energy: 0.5 * law.stiffness * angle * angle,
        loss: -law.damping * rate * rate,
        ..SpringForces::default()
    }
}

fn torsion_rows(law: &Torsion, ends: [&BodyKinematics; 2]) -> [Row; ROWS] {
    let (_, along) = twist(ends);
    let on = [[[0.0; 3], along.map(|part| -part)], [[0.0; 3], along]];
    let mut rows = [Row::default(); ROWS];
    rows[0] = Row { on, stiffness: law.stiffness, damping: law.damping };
    rows
}
