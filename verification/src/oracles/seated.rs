//! A bearing whose rigid outer race sits in the bore of an elastic body, in equilibrium.
//!
//! All in the axes of the race's nominal place, X along its axis. Unknowns are the displacement of
//! every node of the bore, in all three directions, and the race's y, z and tilts; each node inside
//! the race has the energy ½ K (R − d)², whose exact first and second derivatives make forces and
//! Newton's matrix. The bearing is the minimum of its energy for each place of the outer race.

use nalgebra::{DMatrix, DVector};

use super::hyperdual::Jet;
use super::statics::{Coordinates, Known, OracleBearing};

type Vec3 = [f64; 3];
/// Over a node's displacement and the race's y, z, ξ, λ.
type Energy = Jet<7>;

/// A node of the bore.
#[derive(Clone, Copy, Debug)]
pub struct SeatNode {
    pub place: Vec3,
    /// Penalty K, N/m.
    pub stiffness: f64,
}

/// How the distance of a node from the race's axis is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distance {
    /// d of (2.18), of the displaced node from the axis of the displaced race.
    True,
    /// To first order in all displacements: what a solid condensed once and for all knows.
    FirstOrder,
}

pub struct Seat<'a> {
    pub nodes: Vec<SeatNode>,
    /// Of the body at these nodes, three rows each, m/N.
    pub compliance: &'a DMatrix<f64>,
    /// Of the race, m.
    pub radius: f64,
    pub distance: Distance,
}

#[derive(Clone, Debug)]
pub struct Seated {
    /// y, z (m), ξ, λ (rad) of the outer race.
    pub outer: [f64; 4],
    pub inner: Coordinates,
    /// Loads that hold the inner race.
    pub loads: Coordinates,
    /// On the bore's nodes, N.
    pub forces: Vec<Vec3>,
    /// Unbalanced at the end over the load: of the race, N.
    pub unbalanced: f64,
    pub iterations: usize,
}

impl Seat<'_> {
    /// Energy of one node; `None` outside the race.
    fn energy(&self, node: &SeatNode, u: Vec3, race: [f64; 4]) -> Option<Energy> {
        let [x, y, z] = node.place;
        let depth = match self.distance {
            Distance::True => {
                let moved = |i: usize| Energy::variable(u[i], i).shift(node.place[i]);
                let (xi, lambda) = (Energy::variable(race[2], 5), Energy::variable(race[3], 6));
                let arm = [
                    moved(0),
                    moved(1) - Energy::variable(race[0], 3),
                    moved(2) - Energy::variable(race[1], 4),
                ];
                let axis =
                    [xi.cos() * lambda.cos(), lambda.sin(), (xi.sin() * lambda.cos()).scale(-1.0)];
                let along = axis[0] * arm[0] + axis[1] * arm[1] + axis[2] * arm[2];
                let across: [Energy; 3] = std::array::from_fn(|i| arm[i] - along * axis[i]);
                let square = across[0].square() + across[1].square() + across[2].square();
                square.sqrt().scale(-1.0).shift(self.radius)
            }
            Distance::FirstOrder => {
                let distance = y.hypot(z);
                let (ny, nz) = (y / distance, z / distance);
                // Outward motion of the race's surface here less that of the node.
                let by = [0.0, -ny, -nz, ny, nz, -x * nz, x * ny];
                let values = [u[0], u[1], u[2], race[0], race[1], race[2], race[3]];
                let terms = (0..7).map(|i| Energy::variable(values[i], i).scale(by[i]));
                terms.fold(Energy::constant(self.radius - distance), |sum, term| sum + term)
            }
        };
        (depth.value > 0.0).then(|| depth.square().scale(0.5 * node.stiffness))
    }

    /// Forces on the nodes and on the race (conjugate to its coordinates), with their derivatives:
    /// the bare ones by all unknowns.
    pub(super) fn contact(&self, unknowns: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let count = self.nodes.len();
        let (mut slope, mut curvature) =
            (DVector::zeros(3 * count + 4), DMatrix::zeros(3 * count + 4, 3 * count + 4));
        let race = std::array::from_fn(|i| unknowns[3 * count + i]);
        for (n, node) in self.nodes.iter().enumerate() {
            let u = std::array::from_fn(|i| unknowns[3 * n + i]);
            let Some(energy) = self.energy(node, u, race) else { continue };
            let at = |i: usize| if i < 3 { 3 * n + i } else { 3 * count + i - 3 };
            for i in 0..7 {
                slope[at(i)] += energy.gradient[i];
                for j in 0..7 {
                    curvature[(at(i), at(j))] += energy.hessian[i][j];
                }
            }
        }
        (slope, curvature)
    }
}

/// What the bearing puts on the outer race at `outer`, along y, z and about the race's Y and Z
/// (conjugate to its tilts), with the bearing's own answer.
fn pull(
    bearing: &OracleBearing,
    known: &[Known; 5],
    outer: [f64; 4],
    start: Option<Coordinates>,
    distance: Distance,
) -> ([f64; 4], Coordinates, Coordinates) {
    let [y, z, xi, lambda] = outer;
    let ((sx, cx), (sl, cl)) = (xi.sin_cos(), lambda.sin_cos());
    let mut bearing = bearing.clone();
    bearing.outer_position = [0.0, y, z];
    bearing.outer_rotation = [[cx * cl, -cx * sl, sx], [sl, cl, 0.0], [-sx * cl, sx * sl, cx]];
    let found = bearing.solve(known, start);
    let whole = passed_on(&found.coordinates, &found.loads, [0.0, y, z]);
    let about_z = match distance {
        Distance::True => whole[3] * sx + whole[5] * cx,
        Distance::FirstOrder => whole[5],
    };
    ([whole[1], whole[2], whole[4], about_z], found.coordinates, found.loads)
}

/// Force and moment about `centre` that reach the outer race from the loads (conjugate to the coordinates) which hold
/// the inner one.
pub(super) fn passed_on(coordinates: &Coordinates, loads: &Coordinates, centre: Vec3) -> [f64; 6] {
    // The bearing as a whole passes on what is put on its inner race: the force, and the moment of
    // which two components are known and the third, about the inner race's axis, is zero.
    let [fx, fy, fz, about_y, about_own_z] = *loads;
    let (tilt_y, tilt_z) = (coordinates[3], coordinates[4]);
    let turning = about_y * tilt_z.tan();
    let moment = [
        about_own_z * tilt_y.sin() - turning * tilt_y.cos(),
        about_y,
        about_own_z * tilt_y.cos() + turning * tilt_y.sin(),
    ];
    let arm: Vec3 = std::array::from_fn(|i| coordinates[i] - centre[i]);
    [
        fx,
        fy,
        fz,
        moment[0] + arm[1] * fz - arm[2] * fy,
        moment[1] + arm[2] * fx - arm[0] * fz,
        moment[2] + arm[0] * fy - arm[1] * fx,
    ]
}

/// Equilibrium from `start`, a place of the outer race at which it touches the bore, by Newton's method.
pub fn equilibrium(
    seat: &Seat,
    bearing: &OracleBearing,
    known: &[Known; 5],
    start: [f64; 4],
) -> Seated {
    let count = seat.nodes.len();
    let size = [1.0, 1.0, seat.radius, seat.radius];
    let mut unknowns = DVector::zeros(3 * count + 4);
    (0..4).for_each(|i| unknowns[3 * count + i] = start[i]);
    let mut inner = None;
    let (mut iterations, mut last) = (0, f64::INFINITY);
    loop {
        let outer: [f64; 4] = std::array::from_fn(|i| unknowns[3 * count + i]);
        let (on_race, coordinates, loads) = pull(bearing, known, outer, inner, seat.distance);
        inner = Some(coordinates);
        let (slope, curvature) = seat.contact(&unknowns);
        // Nodes: u + C ∂E/∂u = 0; race: pull − ∂E/∂q = 0, both as lengths and forces.
        let bare = slope.rows(0, 3 * count);
        let node_gap = unknowns.rows(0, 3 * count) + seat.compliance * bare;
        let race_gap: [f64; 4] = std::array::from_fn(|i| on_race[i] - slope[3 * count + i]);
        let unbalanced = (0..4).fold(0.0, |most: f64, i| most.max((race_gap[i] / size[i]).abs()));
        let whole = bare.amax();
        // How far nodes are from where the forces on them put them, as a force of their springs.
        let stray = seat.nodes.iter().enumerate().fold(0.0, |most: f64, (n, node)| {
            most.max(node.stiffness * node_gap.rows(3 * n, 3).amax())
        });
        let left = unbalanced.max(stray);
        // Distances round by some ulps of the radius, which stiff springs make into forces.
        if iterations >= 60 || (left <= 1e-5 * whole && left >= 0.3 * last) {
            let force = |n: usize| std::array::from_fn(|i| -slope[3 * n + i]);
            let forces = (0..count).map(force).collect();
            return Seated { outer, inner: coordinates, loads, forces, unbalanced, iterations };
        }
        last = left;
        iterations += 1;

        let mut matrix = DMatrix::zeros(3 * count + 4, 3 * count + 4);
        let top = seat.compliance * curvature.rows(0, 3 * count);
        matrix.rows_mut(0, 3 * count).copy_from(&top);
        for i in 0..3 * count {
            matrix[(i, i)] += 1.0;
        }
        for column in 0..3 * count + 4 {
            for i in 0..4 {
                matrix[(3 * count + i, column)] = curvature[(3 * count + i, column)] / size[i];
            }
        }
        for j in 0..4 {
            let step = 1e-8 / size[j];
            let at = |by: f64| {
                let mut outer = outer;
                outer[j] += by;
                pull(bearing, known, outer, inner, seat.distance).0
            };
            let (ahead, behind) = (at(step), at(-step));
            for i in 0..4 {
                let by = (ahead[i] - behind[i]) / (2.0 * step);
                matrix[(3 * count + i, 3 * count + j)] -= by / size[i];
            }
        }
        let mut right = DVector::zeros(3 * count + 4);
        right.rows_mut(0, 3 * count).copy_from(&-node_gap);
        (0..4).for_each(|i| right[3 * count + i] = race_gap[i] / size[i]);
        let Some(step) = matrix.lu().solve(&right) else {
            let not_a_number = [f64::NAN; 4];
            let forces = vec![[f64::NAN; 3]; count];
            return Seated {
                outer: not_a_number,
                inner: coordinates,
                loads,
                forces,
                unbalanced,
                iterations,
            };
        };
        unknowns += step;
    }
}
