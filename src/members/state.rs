//! Layout of the state vector: one flat array of plain numbers for integrators, error control and restart.
//!
//! The balls of each bearing come first, component by component (all x, all y, …), padded to whole lanes. Bodies
//! (races, cages, shafts) follow one by one, then the modal coordinates and rates of each reduced solid, the
//! elongations of Maxwell elements, flexible shafts, floating solids, and the energy ledger.

use crate::kinematics::vec3::Vec3;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Width of the contact loops.
pub const LANES: usize = 8;

/// Position 3, quaternion 4 (scalar first), velocity 3, spin 3 (inertial axes).
pub const BODY: usize = 13;
pub const POSITION: usize = 0;
pub const ORIENTATION: usize = 3;
pub const VELOCITY: usize = 7;
pub const SPIN: usize = 10;

/// Energy taken out of or put into the bodies since the start, J.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ledger {
    Traction,
    ContactDamping,
    CageFriction,
    /// Dashpots to the ground, between bodies and of reduced solids, or all work of a housing in explicit steps on the
    /// outer race.
    Foundation,
    /// Loads, prescribed motions, and growing race radii.
    Drives,
    BallFriction,
}

pub const LEDGER: usize = 6;

/// Positions of a bearing's balls and bodies in the state vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    pub balls: usize,
    /// Balls rounded up to whole lanes; the extra ones do not move and touch nothing.
    pub padded: usize,
    pub has_cage: bool,
    /// First entries of the balls, the bodies of both races, the cage (that of the ledger if there is none) and the
    /// ledger.
    pub(crate) first: usize,
    pub(crate) races: [usize; 2],
    pub(crate) cage: usize,
    pub(crate) ledger: usize,
}

/// Number of entries of a bearing's balls.
pub(crate) fn ball_entries(balls: usize) -> usize {
    BODY * balls.next_multiple_of(LANES)
}

impl Layout {
    /// Layout of a bearing alone.
    pub fn new(balls: usize, has_cage: bool) -> Layout {
        let inner = ball_entries(balls);
        let (outer, cage) = (inner + BODY, inner + 2 * BODY);
        Layout {
            balls,
            padded: balls.next_multiple_of(LANES),
            has_cage,
            first: 0,
            races: [inner, outer],
            cage,
            ledger: if has_cage { cage + BODY } else { cage },
        }
    }

    /// Number of entries of the state.
    pub fn len(&self) -> usize {
        self.ledger() + LEDGER
    }

    pub fn is_empty(&self) -> bool {
        false
    }

    /// First entry of component `component` (0 … 12) of the balls.
    #[inline(always)]
    pub fn ball(&self, component: usize) -> usize {
        self.first + component * self.padded
    }

    /// Race (0 inner, 1 outer) and ball of a pair, as [`ContactTable`](crate::members::contacts::ContactTable) counts them.
    #[inline(always)]
    pub fn race_and_ball(&self, pair: usize) -> (usize, usize) {
        let outer = pair >= self.padded;
        (usize::from(outer), if outer { pair - self.padded } else { pair })
    }

    pub fn inner(&self) -> usize {
        self.races[0]
    }

    pub fn outer(&self) -> usize {
        self.races[1]
    }

    /// First of the cage's 13 entries, if there is one.
    pub fn cage(&self) -> usize {
        self.cage
    }

    pub fn ledger(&self) -> usize {
        self.ledger
    }

    pub fn ledger_entry(&self, entry: Ledger) -> usize {
        self.ledger() + entry as usize
    }

    /// Three components of a ball from `component` on.
    pub fn ball_vector(&self, state: &[f64], component: usize, ball: usize) -> Vec3 {
        [0, 1, 2].map(|i| state[self.ball(component + i) + ball])
    }

    pub fn set_ball(&self, state: &mut [f64], ball: usize, body: &BodyState) {
        for (component, value) in body.to_array().into_iter().enumerate() {
            state[self.ball(component) + ball] = value;
        }
    }

    pub fn ball_state(&self, state: &[f64], ball: usize) -> BodyState {
        let mut entries = [0.0; BODY];
        for (component, entry) in entries.iter_mut().enumerate() {
            *entry = state[self.ball(component) + ball];
        }
        BodyState::from_slice(&entries)
    }
}

/// State of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// m.
    pub position: Vec3,
    /// Body to inertial.
    pub orientation: UnitQuaternion<f64>,
    /// m/s.
    pub velocity: Vec3,
    /// Angular velocity in inertial axes, rad/s.
    pub spin: Vec3,
}

impl BodyState {
    pub fn at_rest(position: Vec3) -> BodyState {
        BodyState {
            position,
            orientation: UnitQuaternion::identity(),
            velocity: [0.0; 3],
            spin: [0.0; 3],
        }
    }

    /// The body of these 13 entries. Stages of Runge–Kutta change the norm of quaternions by the square of the angle;
    /// it is restored, since the length of a race's axis scales overlaps of micrometres.
    pub fn from_slice(entries: &[f64]) -> BodyState {
        let vector = |at: usize| [entries[at], entries[at + 1], entries[at + 2]];
        let q = &entries[ORIENTATION..ORIENTATION + 4];
        let square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        let q = [0, 1, 2, 3].map(|i| q[i] / square.sqrt());
        BodyState {
            position: vector(POSITION),
            orientation: UnitQuaternion::new_unchecked(Quaternion::new(q[0], q[1], q[2], q[3])),
            velocity: vector(VELOCITY),
            spin: vector(SPIN),
        }
    }

    pub fn to_array(self) -> [f64; BODY] {
        let q = self.orientation;
        let ([x, y, z], [u, v, w], [a, b, c]) = (self.position, self.velocity, self.spin);
        [x, y, z, q.w, q.i, q.j, q.k, u, v, w, a, b, c]
    }

    /// Unit vector along the body's X axis, inertial axes.
    pub fn axis(&self) -> Vec3 {
        (self.orientation * Vector3::x()).into()
    }
}

/// dq/dt = ½ ω q for an angular velocity in inertial axes.
#[inline(always)]
pub fn quaternion_rate(q: [f64; 4], spin: Vec3) -> [f64; 4] {
    let [w, i, j, k] = q;
    let [x, y, z] = spin;
    [
        -0.5 * (x * i + y * j + z * k),
        0.5 * (x * w + y * k - z * j),
        0.5 * (y * w + z * i - x * k),
        0.5 * (z * w + x * j - y * i),
    ]
}
