//! What joins two sections of bodies besides bearings, one `match` each: the load it puts on both ends with
//! its energy and loss, and the directions in which it pushes back.
//!
//! A section is a [`Mount`] and the axes of its body. Whatever the second end gets the first gets too, with the
//! other sign and at the same point, so that momentum is kept; loads are the slopes of an energy, however far
//! the ends have turned against each other.

use crate::assembly::mount::Mount;
use crate::kinematics::vec3::{Vec3, add, cross, dot, sub};
use crate::members::rigid_body::{BodyKinematics, Wrench};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// A connection and what it joins.
#[derive(Clone, Debug, PartialEq)]
pub struct Connection {
    /// As messages name it.
    pub name: String,
    /// What its columns begin with; without it there are none.
    pub label: Option<String>,
    /// The first end's axes are those in which the law is written.
    pub ends: [Mount; 2],
    pub law: Law,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Linear in the displacement of the second end against the first.
    SpringDashpot(SpringDashpot),
    /// Against twist about the first end's axis alone.
    Torsion(Torsion),
}

/// Six springs and dashpots along and about the axes X, Y, Z of the first end, and beside them any number of
/// springs that relax, as rubber does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpringDashpot {
    /// N/m, N·m/rad; with Maxwell elements what is left when all have relaxed.
    pub stiffness: [f64; 6],
    /// N·s/m, N·m·s/rad.
    pub damping: [f64; 6],
    pub maxwell: Vec<MaxwellElement>,
    /// Place of the second end in the first one's axes where no spring pulls, m.
    pub rest: Vec3,
    /// Thickness of the wall of a bushing, m: its sleeves move across each other by less.
    pub wall: Option<f64>,
}

/// Six springs, each in series with a dashpot: K e, where the elongation e (m, rad) of the spring follows the
/// displacement q by de/dt = dq/dt − e/τ. What (2.13) does to a stress, of a whole bushing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaxwellElement {
    /// N/m, N·m/rad.
    pub stiffness: [f64; 6],
    /// τ, s.
    pub relaxation_time: f64,
}

/// A spring and a dashpot against the twist of the second end about the first one's X axis; bending and all
/// displacements are free. Twist counts up to half a turn either way, and needs axes that do not point
/// against each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Torsion {
    /// N·m/rad.
    pub stiffness: f64,
    /// N·m·s/rad.
    pub damping: f64,
}

/// What a connection does at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpringForces {
    /// On each end, about its own centre.
    pub on: [Wrench; 2],
    /// Stored, J.
    pub energy: f64,
    /// Power of its dashpots, W, ≤ 0.
    pub loss: f64,
    /// Rates of the six displacements, m/s and rad/s, where there are Maxwell elements that follow them.
    pub rates: [f64; 6],
}

/// One direction in which a connection pushes back.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// Linear and turning part of the relative motion that a unit of each end's velocity makes, about each
    /// end's own centre, inertial axes.
    pub on: [[Vec3; 2]; 2],
    pub stiffness: f64,
    pub damping: f64,
}

/// Rows that a connection can have.
pub const ROWS: usize = 6;

impl Connection {
    /// Loads on both ends where they are, the springs of its Maxwell elements `elongated` by so much (m, rad; six
    /// for each element), or relaxed where nothing is given.
    pub fn pull(&self, ends: [&BodyKinematics; 2], elongated: &[f64]) -> SpringForces {
        match &self.law {
            Law::SpringDashpot(law) => spring_dashpot(law, ends, elongated),
            Law::Torsion(law) => torsion(law, ends),
        }
    }

    /// Directions, stiffness and damping of what pushes back, for the matrix of a linearly implicit
    /// step and of statics. Exact at rest; turned ends leave out the curvature of large turns.
    pub fn rows(&self, ends: [&BodyKinematics; 2]) -> [Row; ROWS] {
        match &self.law {
            Law::SpringDashpot(law) => spring_dashpot_rows(law, ends),
            Law::Torsion(law) => torsion_rows(law, ends),
        }
    }

    /// How far its springs are stretched and turned at most, m and rad, of directions that have a spring, and how far one end is
    /// across the axis from its place, m.
    pub fn extension(&self, ends: [&BodyKinematics; 2]) -> [f64; 3] {
        match &self.law {
            Law::SpringDashpot(law) => {
                let axes = axes(ends);
                let arm = sub(ends[1].motion.position, ends[0].motion.position);
                let turn = turn_between(ends).0;
                let far = |first: usize, gone: [f64; 3]| {
                    let held = (0..3).filter(|i| law.stiffness[first + i] != 0.0);
                    // NaN stays.
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

    /// Thickness of the wall of a bushing, m; without end of others.
    pub fn wall(&self) -> f64 {
        match &self.law {
            Law::SpringDashpot(law) => law.wall.unwrap_or(f64::INFINITY),
            Law::Torsion(_) => f64::INFINITY,
        }
    }

    /// Those that it has.
    pub fn maxwell(&self) -> &[MaxwellElement] {
        match &self.law {
            Law::SpringDashpot(law) => &law.maxwell,
            Law::Torsion(_) => &[],
        }
    }

    /// Whether its springs, dashpots or Maxwell elements along the first end's Y differ from those along Z, or about them.
    pub fn is_uneven(&self) -> bool {
        match &self.law {
            Law::SpringDashpot(law) => {
                let mut elements = law.maxwell.iter();
                uneven(&law.stiffness)
                    || uneven(&law.damping)
                    || elements.any(|element| uneven(&element.stiffness))
            }
            Law::Torsion(_) => false,
        }
    }

    /// Whether nothing of it pushes or brakes, so that it may be left out.
    pub fn is_void(&self) -> bool {
        match &self.law {
            Law::SpringDashpot(law) => {
                let pushes = law.maxwell.iter().any(|element| element.stiffness != [0.0; 6]);
                law.stiffness == [0.0; 6] && law.damping == [0.0; 6] && !pushes
            }
            Law::Torsion(law) => law.stiffness == 0.0 && law.damping == 0.0,
        }
    }
}

/// Whether values along and about the axes X, Y, Z differ between Y and Z.
pub fn uneven(of: &[f64; 6]) -> bool {
    of[1] != of[2] || of[4] != of[5]
}

/// How the second end is turned against the first, in the first one's axes, rad, and how that changes with an angular
/// velocity in these axes.
///
/// Turns about Y and Z are those by the shortest way that take the first axis X to the second (its length the angle between
/// them), the turn about X is the [`twist`] that is left: a shaft that spins turns about X alone, however far.
fn turn_between(ends: [&BodyKinematics; 2]) -> (Vector3<f64>, Matrix3<f64>) {
    let [first, second] = ends.map(|end| end.state.orientation);
    let (angle, along) = twist_in_first(first.inverse() * second);
    let axis = first.inverse() * (second * Vector3::x());
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let square = y * y + z * z;
    let sine = square.sqrt();
    let tilt = libm::atan2(sine, x);
    // θ/sin θ, and its slope over θ, over sin θ; series serve small tilts.
    let (factor, slope) = if tilt < 1e-2 {
        (1.0 + square / 6.0 * (1.0 + 0.45 * square), (1.0 + 0.4 * square) / 3.0)
    } else {
        (tilt / sine, (sine - tilt * x) / (sine * square))
    };
    // Of the axis under an angular velocity.
    let swept = -axis.cross_matrix();
    let [by_x, by_y, by_z] = [0, 1, 2].map(|i| swept.row(i).into_owned());
    let grows = ((by_y * y + by_z * z) * x - by_x * square) * slope;
    let rates = [along.transpose(), -(by_z * factor + grows * z), by_y * factor + grows * y];
    (Vector3::new(angle, -factor * z, factor * y), Matrix3::from_rows(&rates))
}

/// Axes of the first end in inertial ones.
fn axes(ends: [&BodyKinematics; 2]) -> [Vec3; 3] {
    let turn = ends[0].state.orientation;
    [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (turn * axis).into())
}

/// Rate of the second end's place in the first one's axes, and of their turn, all in these axes.
fn rates(ends: [&BodyKinematics; 2], axes: &[Vec3; 3]) -> (Vec3, Vector3<f64>) {
    let [first, second] = ends.map(|end| &end.motion);
    let arm = sub(second.position, first.position);
    let carried = add(first.velocity, cross(first.spin, arm));
    let along = |v: Vec3| axes.map(|axis| dot(axis, v));
    (along(sub(second.velocity, carried)), along(sub(second.spin, first.spin)).into())
}

/// See [`Connection::pull`].
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

/// Twist of the second end about the first one's axis, rad, and the direction (inertial axes) along which
/// relative spin makes it.
fn twist(ends: [&BodyKinematics; 2]) -> (f64, Vec3) {
    let [first, second] = ends.map(|end| end.state.orientation);
    let (angle, along) = twist_in_first(first.inverse() * second);
    (angle, (first * along).into())
}

/// The same of a relative rotation q, the direction in the first end's axes: φ = 2 atan(q_x/q_w).
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
