//! Response of a condensed bore to a rigid race at a pose, with unilateral contact.
//!
//! Let q be the race's coordinates (y, z, tilts about Y and Z), B the outward displacement of its surface at the nodes
//! per unit of each, u = C p the nodes' own outward displacement under the loads p ≥ 0, and g₀ the initial overlap. The
//! penetration of (2.19) is g = g₀ + B q − C p, and p = K g where g > 0. All is linear except for the set of contact
//! nodes: the loads p are the unique minimum of a convex energy with the value ½ p·(g₀ + B q), the gradient Bᵀp over q,
//! and the curvature Bᵀ(C + 1/K)⁻¹B over the contact nodes. Nodes enter and leave contact all at once as long as that
//! leaves fewer of them wrong, and one by one otherwise (block principal pivoting, Júdice and Pires 1994), which ends
//! for every pose.

use crate::ch2_housing::bore_contact::Penalty;
use crate::kinematics::vec3::{Vec3, norm};
use crate::numeric::clock::to_digits;
use crate::numeric::dense::DenseFactor;
use crate::numeric::sparse::FactorError;
use crate::solids::condensation::{CondensedBore, lever, race_motion};
use nalgebra::{Matrix4, Vector4};
use thiserror::Error;

/// The race's coordinates in the order of a pose: y, z (m), tilts about Y and Z (rad). Its axial position is fixed;
/// about its axis nothing acts, since the contact has no friction.
pub const POSE_NAMES: [&str; 4] = ["y", "z", "tilt_y", "tilt_z"];

/// Wrench on the race, in its nominal axes, about its own centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RaceLoad {
    /// N. Components along X are for [`Axial`].
    pub force: Vec3,
    /// N·m.
    pub moment: Vec3,
}

/// Support of the race against axial forces and moments about its axis, which a smooth bore cannot carry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axial {
    /// A support beside the bore, such as a shoulder or a ring: the named assumption of all housings.
    #[default]
    Fixed,
    /// None: such loads are an error.
    Free,
}

/// Radius of the race, and its axial support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Outer radius of the race, m: the bore's radius plus the interference.
    pub radius: f64,
    pub axial: Axial,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum BoreError {
    #[error("{what} is {value}; it must be finite")]
    NotFinite { what: &'static str, value: f64 },
    #[error(
        "an axial force of {force:.3e} N is on the outer race: a smooth bore without friction cannot \
         take it; hold the race axially or turn the load"
    )]
    AxialForce { force: f64 },
    #[error(
        "the outer race has a load of {moment:.3e} N m about its axis, and the bore has no friction to resist \
     it; remove that moment"
    )]
    AxialMoment { moment: f64 },
    #[error(
         "the bore does not hold the outer race: its loads have {} from its nominal position, and nothing \
          resists {} N of them (a moment counts as moment divided by radius). Hint: a bore without friction \
          holds a race across its axis and, along its width, against tilt: check size and direction of the \
          loads, the fit, and which parts of the solid are fixed",
        travel_text(coordinate, *travel),
        to_digits(*force, 3)
    )]
    NotHeld { coordinate: &'static str, travel: f64, force: f64 },
    #[error(
         "the housing is too flexible: it carries the full load of {} N on the outer race (a moment counts as \
          moment divided by radius), but this has {} from its nominal position, more than a hundredth of the \
          radius of {:.4} mm. A condensed housing is valid for small displacements only. Hint: check \
          solid.material.youngs_modulus, which is {} GPa, and its unit, the loads, and which parts of the \
          solid are fixed",
        to_digits(*load, 4), travel_text(coordinate, *travel), 1e3 * *radius,
        to_digits(1e-9 * *youngs_modulus, 6)
    )]
    GivesWay { coordinate: &'static str, travel: f64, load: f64, radius: f64, youngs_modulus: f64 },
    #[error(
        "race and bore move {motion:.3e} m towards each other, farther than the {travel:.3e} m for which \
         nodes were kept; condense with a larger travel"
    )]
    BeyondRange { motion: f64, travel: f64 },
    #[error(
        "the lateral displacement of the race is so large that the gaps of its nodes do not converge in {rounds} rounds. Hint: less load, a stiffer \
         housing, or a start in nominal positions (numerics.start = \"nominal\")"
    )]
    FarAcross { rounds: usize },
    #[error(
        "contact does not converge: the set of contact nodes still changes after {changes} iterations"
    )]
    NotSettled { changes: usize },
    #[error("the contact list names bore node {node}, but the bore has only {count} nodes")]
    NoSuchNode { node: usize, count: usize },
    #[error(transparent)]
    Factor(#[from] FactorError),
}

/// Displacement of a race along one of [`POSE_NAMES`], m or rad, as text.
fn travel_text(coordinate: &str, travel: f64) -> String {
    match coordinate {
        "y" | "z" => format!("moved it by {:.4} mm along {coordinate}", 1e3 * travel),
        tilt => {
            let axis = tilt.trim_start_matches("tilt_");
            format!("tilted it by {:.4} deg about {axis}", travel.to_degrees())
        }
    }
}

/// A race in its bore.
#[derive(Clone, Debug, PartialEq)]
pub struct BoreState {
    /// y, z (m), tilts about Y and Z (rad) from the nominal pose.
    pub pose: [f64; 4],
    /// Outward load on each node of the bore, N.
    pub loads: Vec<f64>,
    /// Penetration of each node into the race, m; negative for a gap.
    pub penetration: Vec<f64>,
    /// Outward displacement of each node, m.
    pub outward: Vec<f64>,
    /// Load of the race on the bore along its four coordinates: N, N, N·m, N·m.
    pub load: [f64; 4],
    /// ∂load/∂pose for constant contact nodes, symmetric.
    pub stiffness: Matrix4<f64>,
    /// Energy in the solid under contact, its own loads and weight, and in the penalty springs, J.
    pub elastic_energy: f64,
    pub contact_energy: f64,
    pub touching: usize,
}

impl BoreState {
    /// Load over the node's share of the bore, Pa.
    pub fn pressure(&self, bore: &CondensedBore) -> Vec<f64> {
        self.loads.iter().zip(&bore.nodes).map(|(load, node)| load / node.area).collect()
    }

    /// Largest penetration, m; zero without contact.
    pub fn deepest(&self) -> f64 {
        self.penetration.iter().fold(0.0, |most: f64, g| most.max(*g))
    }
}

/// Response to the race at a pose, with bore nodes eliminated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoreAnswer {
    /// Energy of contact in the solid and in the penalty springs, J.
    pub energy: f64,
    /// Load of the race on the bore along its four coordinates: N, N, N·m, N·m.
    pub load: Vector4<f64>,
    /// ∂load/∂pose for constant contact nodes.
    pub stiffness: Matrix4<f64>,
    /// Rounding of the load, N.
    pub rounding: f64,
}

/// Contact nodes with the factors of their compliance.
struct Contact {
    nodes: Vec<usize>,
    factor: DenseFactor,
    /// Computed from the factors on request.
    answer: Option<Motion>,
}

/// Derivative of the loads by the race's coordinates for constant contact nodes.
#[derive(Clone)]
struct Motion {
    /// (C + 1/K)⁻¹ B, its four columns.
    by_motion: [Vec<f64>; 4],
    stiffness: Matrix4<f64>,
}

/// A search that keeps the last contact nodes and their factors.
pub struct BoreSearch<'a> {
    bore: &'a CondensedBore,
    penalty: Penalty,
    levers: Vec<[f64; 4]>,
    /// 1/K of each node, m/N.
    softness: Vec<f64>,
    /// Additional gap of each node compared with displacements along fixed normals, m.
    beyond: Vec<f64>,
    contact: Option<Contact>,
    pose: [f64; 4],
    /// R − d of each node with the race at its pose and the bore displaced by its own loads, m.
    overlap: Vec<f64>,
    /// Outward load on each node, N, and the displacement by it, m.
    loads: Vec<f64>,
    moves: Vec<f64>,
    /// Number of sets of contact nodes factorised so far.
    pub changes: usize,
}

/// Limit of these; a cold start takes about ten.
const MOST_CHANGES: usize = 2000;
/// Unbalanced fraction of a load that counts as carried by a race that has moved too far: rounding grows with
/// displacements of millimetres.
pub(crate) const MET: f64 = 1e-6;

impl<'a> BoreSearch<'a> {
    pub fn new(bore: &'a CondensedBore, penalty: Penalty) -> BoreSearch<'a> {
        let levers: Vec<[f64; 4]> = bore.nodes.iter().map(lever).collect();
        let softness: Vec<f64> =
            bore.nodes.iter().map(|node| 1.0 / penalty.of_node(node.area)).collect();
        let count = bore.nodes.len();
        BoreSearch {
            bore,
            penalty,
            levers,
            softness,
            beyond: vec![0.0; count],
            contact: None,
            pose: [0.0; 4],
            overlap: vec![0.0; count],
            loads: vec![0.0; count],
            moves: vec![0.0; count],
            changes: 0,
        }
    }

    pub fn bore(&self) -> &'a CondensedBore {
        self.bore
    }

    /// Sets the additional gap of each node compared with displacements along fixed normals, m.
    pub fn keep_beyond(&mut self, beyond: Vec<f64>) {
        self.beyond = beyond;
    }

    /// Last contact nodes, ascending; the next answer depends on them alone.
    pub fn touching(&self) -> &[usize] {
        self.contact.as_ref().map_or(&[], |contact| &contact.nodes)
    }

    /// Continues from contact nodes of the same bore, with the same bits.
    ///
    /// # Errors
    ///
    /// Nodes that the bore does not have; a singular compliance.
    pub fn recall(&mut self, touching: &[usize]) -> Result<(), BoreError> {
        if let Some(&node) = touching.iter().find(|&&node| node >= self.levers.len()) {
            return Err(BoreError::NoSuchNode { node, count: self.levers.len() });
        }
        self.make_contact(touching.to_vec())
    }

    /// Last pose of the race: y, z (m), tilts (rad).
    pub fn pose(&self) -> [f64; 4] {
        self.pose
    }

    pub fn penalty(&self) -> Penalty {
        self.penalty
    }

    /// Derivative of the nodes' loads by each coordinate of the race, N/m and N/rad, for the contact nodes of the last
    /// answer.
    pub fn loads_by_pose(&self) -> [Vec<f64>; 4] {
        let mut loads: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; self.levers.len()]);
        if let Some(Contact { nodes, answer: Some(answer), .. }) = &self.contact {
            for (loads, by_motion) in loads.iter_mut().zip(&answer.by_motion) {
                nodes.iter().zip(by_motion).for_each(|(&i, load)| loads[i] = *load);
            }
        }
        loads
    }

    /// Change of the nodes' loads, N, by outward displacements of the nodes (m) at a fixed race, for the contact nodes
    /// of the last answer and without the bore's own response.
    pub fn loads_against(&self, outward: &[f64]) -> Vec<f64> {
        let mut loads = vec![0.0; self.levers.len()];
        if let Some(Contact { nodes, factor, .. }) = &self.contact {
            let mut on_nodes: Vec<f64> = nodes.iter().map(|&i| -outward[i]).collect();
            factor.solve_columns(&mut on_nodes, 1);
            nodes.iter().zip(on_nodes).for_each(|(&i, load)| loads[i] = load);
        }
        loads
    }

    /// State of the race at a given pose: y, z (m), tilts (rad).
    ///
    /// # Errors
    ///
    /// [`BoreError::BeyondRange`], [`BoreError::NotFinite`].
    pub fn at_pose(&mut self, fit: &Fit, pose: [f64; 4]) -> Result<BoreState, BoreError> {
        self.answer(fit, pose)?;
        self.state()
    }

    /// Energy, load and stiffness at a given pose: y, z (m), tilts (rad).
    ///
    /// # Errors
    ///
    /// [`BoreError::NotFinite`]; contact that does not converge.
    pub fn answer(&mut self, fit: &Fit, pose: [f64; 4]) -> Result<BoreAnswer, BoreError> {
        check_finite("the race's pose", pose.iter().sum())?;
        check_finite("the race's radius", fit.radius)?;
        self.pose = pose;
        for (i, node) in self.bore.nodes.iter().enumerate() {
            let before = fit.radius - node.distance - self.bore.own[i] - self.beyond[i];
            self.overlap[i] = before + race_motion(node, &pose);
        }
        self.settle()?;
        let stiffness = self.motion().map_or(Matrix4::zeros(), |motion| motion.stiffness);
        let (mut energy, mut load, mut sum) = (0.0, Vector4::zeros(), 0.0);
        for ((lever, p), g) in self.levers.iter().zip(&self.loads).zip(&self.overlap) {
            load += Vector4::from(*lever) * *p;
            energy += 0.5 * p * g;
            sum += p;
        }
        // Rounding of the sum, and of the pose.
        let travel = norm([0.0, pose[0], pose[1]]);
        let rounding = 8.0 * f64::EPSILON * (sum + stiffness.diagonal().rows(0, 2).amax() * travel);
        Ok(BoreAnswer { energy, load, stiffness, rounding })
    }

    /// Error of a race too far from its position along coordinate `worst`, with the residual load `left` (N).
    pub(crate) fn lost(
        &self,
        fit: &Fit,
        worst: usize,
        pose: &[f64; 4],
        left: f64,
        load: f64,
    ) -> BoreError {
        let (coordinate, travel) = (POSE_NAMES[worst], pose[worst]);
        // All of the load is carried, only at a large displacement.
        if load > 0.0 && left <= MET * load {
            let (radius, youngs_modulus) = (fit.radius, self.bore.youngs_modulus);
            return BoreError::GivesWay { coordinate, travel, load, radius, youngs_modulus };
        }
        BoreError::NotHeld { coordinate, travel, force: left }
    }

    /// Finds the contact nodes, their loads and displacements.
    fn settle(&mut self) -> Result<(), BoreError> {
        const PATIENCE: usize = 10;
        let count = self.overlap.len();
        if self.contact.is_none() {
            let start = (0..count).filter(|&i| self.overlap[i] > 0.0).collect();
            self.make_contact(start)?;
        }
        let (mut fewest, mut patience, mut changes) = (usize::MAX, PATIENCE, 0);
        loop {
            changes += 1;
            if changes > MOST_CHANGES {
                return Err(BoreError::NotSettled { changes: MOST_CHANGES });
            }
            self.moves.fill(0.0);
            self.loads.fill(0.0);
            // Loads that are rounding of the largest change no contact.
            let mut largest = 0.0f64;
            let mut inside = vec![false; count];
            if let Some(Contact { nodes, factor, .. }) = &self.contact {
                let mut on_nodes: Vec<f64> = nodes.iter().map(|&i| self.overlap[i]).collect();
                factor.solve_columns(&mut on_nodes, 1);
                self.bore.compliance.add_product(nodes, &on_nodes, &mut self.moves);
                for (&i, load) in nodes.iter().zip(&on_nodes) {
                    (self.loads[i], inside[i]) = (*load, true);
                    largest = largest.max(load.abs());
                }
            }
            let rounding = 4.0 * f64::EPSILON * self.bore.reach.radius;
            let wrong: Vec<usize> = (0..count)
                .filter(|&i| {
                    if inside[i] {
                        self.loads[i].is_nan() || self.loads[i] < -1e-12 * largest
                    } else {
                        let g = self.overlap[i] - self.moves[i];
                        g.is_nan() || g > rounding.max(1e-12 * largest * self.softness[i])
                    }
                })
                .collect();
            if wrong.is_empty() {
                self.loads.iter_mut().for_each(|load| *load = load.max(0.0));
                return Ok(());
            }
            let mut flipped = &wrong[..];
            if wrong.len() < fewest {
                (fewest, patience) = (wrong.len(), PATIENCE);
            } else if patience > 0 {
                patience -= 1;
            } else {
                flipped = &wrong[wrong.len() - 1..];
            }
            flipped.iter().for_each(|&i| inside[i] = !inside[i]);
            self.make_contact((0..count).filter(|&i| inside[i]).collect())?;
        }
    }

    fn make_contact(&mut self, nodes: Vec<usize>) -> Result<(), BoreError> {
        if nodes.is_empty() {
            self.contact = None;
            return Ok(());
        }
        let softness: Vec<f64> = nodes.iter().map(|&i| self.softness[i]).collect();
        let factor = self.bore.compliance.factor(&nodes, &softness)?;
        self.changes += 1;
        self.contact = Some(Contact { nodes, factor, answer: None });
        Ok(())
    }

    /// Derivative of the loads for the contact nodes.
    fn motion(&mut self) -> Option<&Motion> {
        let Contact { nodes, factor, answer } = self.contact.as_mut()?;
        Some(answer.get_or_insert_with(|| {
            let mut right = Vec::with_capacity(4 * nodes.len());
            for axis in 0..4 {
                right.extend(nodes.iter().map(|&i| self.levers[i][axis]));
            }
            factor.solve_columns(&mut right, 4);
            let mut columns = right.chunks_exact(nodes.len()).map(<[f64]>::to_vec);
            let by_motion: [Vec<f64>; 4] =
                std::array::from_fn(|_| columns.next().unwrap_or_default());
            let stiffness = Matrix4::from_fn(|i, j| {
                let of = nodes.iter().zip(&by_motion[j]);
                of.map(|(&node, load)| self.levers[node][i] * load).sum()
            });
            Motion { by_motion, stiffness: 0.5 * (stiffness + stiffness.transpose()) }
        }))
    }

    /// Full state of the last answer.
    ///
    /// # Errors
    ///
    /// [`BoreError::BeyondRange`].
    pub fn state(&mut self) -> Result<BoreState, BoreError> {
        let stiffness = self.motion().map_or(Matrix4::zeros(), |motion| motion.stiffness);
        let (bore, pose, loads) = (self.bore, self.pose, &self.loads);
        let penetration: Vec<f64> =
            self.overlap.iter().zip(&self.moves).map(|(g, u)| g - u).collect();
        let mut load = Vector4::zeros();
        for (lever, p) in self.levers.iter().zip(loads) {
            load += Vector4::from(*lever) * *p;
        }
        let outward: Vec<f64> = self.moves.iter().zip(&bore.own).map(|(u, own)| u + own).collect();
        if let Some(travel) = bore.reach.travel {
            let largest = |of: &[f64]| of.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let motion = norm([0.0, pose[0], pose[1]])
                + largest(&outward)
                + norm([0.0, pose[2], pose[3]]) * 0.5 * bore.reach.width;
            if motion.is_nan() || motion > travel {
                return Err(BoreError::BeyondRange { motion, travel });
            }
        }
        let half_work = |of: &[f64]| 0.5 * of.iter().zip(loads).map(|(u, p)| u * p).sum::<f64>();
        // Cross term of the displacements by own loads and by contact.
        let both: f64 = bore.own.iter().zip(loads).map(|(own, p)| own * p).sum();
        let squeeze: Vec<f64> = self.softness.iter().zip(loads).map(|(c, p)| c * p).collect();
        Ok(BoreState {
            pose,
            penetration,
            elastic_energy: bore.own_energy + both + half_work(&self.moves),
            contact_energy: half_work(&squeeze),
            outward,
            load: load.into(),
            stiffness,
            touching: loads.iter().filter(|load| **load > 0.0).count(),
            loads: loads.clone(),
        })
    }
}

/// Largest tilt of a race in its bore, rad, at which its nodes represent the bore under it.
const LARGEST_TILT: f64 = 0.01;

/// The load along the four coordinates.
pub(crate) fn check_load(fit: &Fit, load: &RaceLoad) -> Result<Vector4<f64>, BoreError> {
    let RaceLoad { force, moment } = load;
    check_finite("a force on the race", force.iter().sum())?;
    check_finite("a moment on the race", moment.iter().sum())?;
    let size = norm(*force).max(norm(*moment) / fit.radius);
    // Rounding of a load rotated into these axes.
    let nothing = 1e-9 * size;
    if fit.axial == Axial::Free {
        if force[0].abs() > nothing {
            return Err(BoreError::AxialForce { force: force[0] });
        }
        // A tilted race without friction has no moment about its own axis; its tilting moment has a component about X.
        let of_tilts = LARGEST_TILT * libm::hypot(moment[1], moment[2]);
        if moment[0].abs() > nothing * fit.radius + of_tilts {
            return Err(BoreError::AxialMoment { moment: moment[0] });
        }
    }
    Ok(Vector4::new(force[1], force[2], moment[1], moment[2]))
}

fn check_finite(what: &'static str, value: f64) -> Result<(), BoreError> {
    if value.is_finite() { Ok(()) } else { Err(BoreError::NotFinite { what, value }) }
}
