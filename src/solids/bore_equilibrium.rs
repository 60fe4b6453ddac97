//! What a condensed bore answers to a rigid race at a pose, contact on one side only.
//!
//! With q the race's coordinates (y, z, tilts about Y and Z), B the outward motion of its surface at
//! the nodes for a unit of each, u = C p the nodes' own outward motion under the loads p ≥ 0, and
//! g₀ the overlap before anything moves, the penetration of (2.19) is g = g₀ + B q − C p, and
//! p = K g where g > 0. All is linear but for which nodes touch: the loads p are the one minimum of a convex energy
//! whose value is ½ p·(g₀ + B q), its slope over q the load Bᵀp, its curvature Bᵀ(C + 1/K)⁻¹B over the nodes that touch.
//! Nodes are let in and out of contact all at once as long as that leaves fewer of them wrong, and one by one
//! otherwise (block principal pivoting, Júdice and Pires 1994), which ends for every pose.

use crate::ch2_housing::bore_contact::Penalty;
use crate::kinematics::vec3::{Vec3, norm};
use crate::numeric::clock::to_digits;
use crate::numeric::dense::DenseFactor;
use crate::numeric::sparse::FactorError;
use crate::solids::condensation::{CondensedBore, lever, race_motion};
use nalgebra::{Matrix4, Vector4};
use thiserror::Error;

/// The race's coordinates in the order of a pose: y, z (m), tilts about Y and Z (rad). Along its
/// axis the race is held, about it nothing acts: the contact has no friction.
pub const POSE_NAMES: [&str; 4] = ["y", "z", "tilt_y", "tilt_z"];

/// What acts on the race, in its nominal axes, about its own centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RaceLoad {
    /// N. The parts along and about X meet [`Axial`].
    pub force: Vec3,
    /// N·m.
    pub moment: Vec3,
}

/// What takes a force along the race's axis and a moment about it, which a smooth bore without
/// friction cannot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axial {
    /// Something beside the bore, a shoulder or a ring: the named assumption behind all housings.
    #[default]
    Held,
    /// Nothing: they are an error.
    Free,
}

/// The race's radius, and what holds it along its axis.
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
    #[error("a moment of {moment:.3e} N m turns the outer race in its bore, which has no friction")]
    AxialMoment { moment: f64 },
    #[error(
        "the bore does not hold the outer race: its loads have {} from its nominal place, and {} N of \
         them (of a moment: over the radius) meet no resistance. Hint: a bore without friction holds a race \
         across its axis and, along its width, against tilt: check size and direction of the loads, the fit, and \
         which parts of the solid are held",
        travel_text(coordinate, *travel),
        to_digits(*force, 3)
    )]
    NotHeld { coordinate: &'static str, travel: f64, force: f64 },
    #[error(
        "the housing gives way: it holds all {} N of the load on the outer race (of a moment: over the radius), but \
         that has {} from its nominal place, more than a hundredth of its radius of {:.4} mm: beyond small \
         displacements a condensed housing says nothing. Hint: check solid.material.youngs_modulus, which is {} \
         GPa, and its unit, the loads, and which parts of the solid are held",
        to_digits(*load, 4), travel_text(coordinate, *travel), 1e3 * *radius,
        to_digits(1e-9 * *youngs_modulus, 6)
    )]
    GivesWay { coordinate: &'static str, travel: f64, load: f64, radius: f64, youngs_modulus: f64 },
    #[error(
        "race and bore move {motion:.3e} m towards each other, beyond the {travel:.3e} m within \
         which nodes were kept; condense with a larger travel"
    )]
    BeyondReach { motion: f64, travel: f64 },
    #[error(
        "the race goes so far across its nodes that their distances do not settle in {rounds} rounds. Hint: less load, a stiffer \
         housing, or a start in nominal positions (numerics.start = \"nominal\")"
    )]
    FarAcross { rounds: usize },
    #[error("contact has not settled after {changes} changes of the nodes that touch")]
    NotSettled { changes: usize },
    #[error("node {node} of the bore is to touch; it has {count} nodes")]
    NoSuchNode { node: usize, count: usize },
    #[error(transparent)]
    Factor(#[from] FactorError),
}

/// How far a race has moved along one of [`POSE_NAMES`], m or rad.
fn travel_text(coordinate: &str, travel: f64) -> String {
    match coordinate {
        "y" | "z" => format!("moved it by {:.4} mm along {coordinate}", 1e3 * travel),
        tilt => {
            let axis = tilt.trim_start_matches("tilt_");
            format!("tilted it by {:.4} deg about {axis}", travel.to_degrees())
        }
    }
}

/// The race in its bore.
#[derive(Clone, Debug, PartialEq)]
pub struct BoreState {
    /// y, z (m), tilts about Y and Z (rad) from the nominal pose.
    pub pose: [f64; 4],
    /// Outward load on each node of the bore, N.
    pub loads: Vec<f64>,
    /// Of each node into the race, m; negative where there is a gap.
    pub penetration: Vec<f64>,
    /// Outward displacement of each node, m.
    pub outward: Vec<f64>,
    /// What the race puts on the bore along its four coordinates: N, N, N·m, N·m.
    pub load: [f64; 4],
    /// ∂load/∂pose while the same nodes touch, symmetric.
    pub stiffness: Matrix4<f64>,
    /// In the solid under contact, its own loads and weight, and in the penalty springs, J.
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

/// Of the race at a pose, its nodes eliminated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoreAnswer {
    /// In the solid by contact and in the penalty springs, J.
    pub energy: f64,
    /// What the race puts on the bore along its four coordinates: N, N, N·m, N·m.
    pub load: Vector4<f64>,
    /// ∂load/∂pose while the same nodes touch.
    pub stiffness: Matrix4<f64>,
    /// What rounding leaves of the load, N.
    pub rounding: f64,
}

/// Nodes in contact with the factors that belong to them.
struct Contact {
    nodes: Vec<usize>,
    factor: DenseFactor,
    /// What follows from them once it has been asked for.
    answer: Option<Motion>,
}

/// How loads follow the race while the same nodes touch.
#[derive(Clone)]
struct Motion {
    /// (C + 1/K)⁻¹ B, its four columns.
    by_motion: [Vec<f64>; 4],
    stiffness: Matrix4<f64>,
}

/// A search that remembers which nodes touched last, and their factors.
pub struct BoreSearch<'a> {
    bore: &'a CondensedBore,
    penalty: Penalty,
    levers: Vec<[f64; 4]>,
    /// 1/K of each node, m/N.
    softness: Vec<f64>,
    /// How much farther each node is from the race than motions along normals that stay make it, m.
    beyond: Vec<f64>,
    contact: Option<Contact>,
    pose: [f64; 4],
    /// R − d of each node with the race at its pose and the bore as its own loads leave it, m.
    overlap: Vec<f64>,
    /// Outward load on each node, and what it moves each by: N, m.
    loads: Vec<f64>,
    moves: Vec<f64>,
    /// Sets of touching nodes whose compliance has been factorised so far.
    pub changes: usize,
}

/// Changes of the touching nodes after which a search gives up; a cold start takes about ten.
const MOST_CHANGES: usize = 2000;
/// Unbalanced part of a load that is met, where the race has gone too far: rounding over travels of millimetres leaves
/// more than over micrometres.
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

    /// Takes each node to be farther from the race than motions along normals that stay make it, m.
    pub fn keep_beyond(&mut self, beyond: Vec<f64>) {
        self.beyond = beyond;
    }

    /// Nodes of the bore that touched last, ascending: all that the next answer starts from.
    pub fn touching(&self) -> &[usize] {
        self.contact.as_ref().map_or(&[], |contact| &contact.nodes)
    }

    /// Goes on from nodes that touched in the same bore, with the same bits.
    ///
    /// # Errors
    /// Nodes that the bore does not have, or a factor that there is not.
    pub fn recall(&mut self, touching: &[usize]) -> Result<(), BoreError> {
        if let Some(&node) = touching.iter().find(|&&node| node >= self.levers.len()) {
            return Err(BoreError::NoSuchNode { node, count: self.levers.len() });
        }
        self.make_contact(touching.to_vec())
    }

    /// Where the race was last: y, z (m), tilts (rad).
    pub fn pose(&self) -> [f64; 4] {
        self.pose
    }

    pub fn penalty(&self) -> Penalty {
        self.penalty
    }

    /// Change of the nodes' loads with each coordinate of the race, N/m and N/rad, while the same
    /// nodes touch as in the last answer.
    pub fn loads_by_pose(&self) -> [Vec<f64>; 4] {
        let mut loads: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; self.levers.len()]);
        if let Some(Contact { nodes, answer: Some(answer), .. }) = &self.contact {
            for (loads, by_motion) in loads.iter_mut().zip(&answer.by_motion) {
                nodes.iter().zip(by_motion).for_each(|(&i, load)| loads[i] = *load);
            }
        }
        loads
    }

    /// Change of the nodes' loads, N, where something moves the nodes outwards by so much (m) and the race stands still, while the same
    /// nodes touch as in the last answer: of the nodes by themselves, to which the bore's answer to the change adds.
    pub fn loads_against(&self, outward: &[f64]) -> Vec<f64> {
        let mut loads = vec![0.0; self.levers.len()];
        if let Some(Contact { nodes, factor, .. }) = &self.contact {
            let mut on_nodes: Vec<f64> = nodes.iter().map(|&i| -outward[i]).collect();
            factor.solve_columns(&mut on_nodes, 1);
            nodes.iter().zip(on_nodes).for_each(|(&i, load)| loads[i] = load);
        }
        loads
    }

    /// The race at a given pose: y, z (m), tilts (rad).
    ///
    /// # Errors
    /// [`BoreError::BeyondReach`], [`BoreError::NotFinite`].
    pub fn at_pose(&mut self, fit: &Fit, pose: [f64; 4]) -> Result<BoreState, BoreError> {
        self.answer(fit, pose)?;
        self.state()
    }

    /// Energy, load and stiffness at a given pose: y, z (m), tilts (rad).
    ///
    /// # Errors
    /// [`BoreError::NotFinite`], contact that does not settle.
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
        // Of the sum, and of the pose.
        let travel = norm([0.0, pose[0], pose[1]]);
        let rounding = 8.0 * f64::EPSILON * (sum + stiffness.diagonal().rows(0, 2).amax() * travel);
        Ok(BoreAnswer { energy, load, stiffness, rounding })
    }

    /// Why a race is too far from its place along coordinate `worst`, `left` of its load (N) being unbalanced.
    pub(crate) fn lost(
        &self,
        fit: &Fit,
        worst: usize,
        pose: &[f64; 4],
        left: f64,
        load: f64,
    ) -> BoreError {
        let (coordinate, travel) = (POSE_NAMES[worst], pose[worst]);
        // All of the load meets resistance, only late.
        if load > 0.0 && left <= MET * load {
            let (radius, youngs_modulus) = (fit.radius, self.bore.youngs_modulus);
            return BoreError::GivesWay { coordinate, travel, load, radius, youngs_modulus };
        }
        BoreError::NotHeld { coordinate, travel, force: left }
    }

    /// Finds the nodes that touch, their loads and what these move all by.
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
            // Loads of either sign that are rounding of the largest change nothing.
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

    /// Loads over motion of the nodes that touch.
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

    /// All about the last answer.
    ///
    /// # Errors
    /// [`BoreError::BeyondReach`].
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
                return Err(BoreError::BeyondReach { motion, travel });
            }
        }
        let half_work = |of: &[f64]| 0.5 * of.iter().zip(loads).map(|(u, p)| u * p).sum::<f64>();
        // Both displacements of the solid, and what the loads of the one do along the other.
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

/// Beyond this a race hangs in its bore, rad; its nodes no longer stand for what is under it.
const LARGEST_TILT: f64 = 0.01;

/// The load along the four coordinates.
pub(crate) fn check_load(fit: &Fit, load: &RaceLoad) -> Result<Vector4<f64>, BoreError> {
    let RaceLoad { force, moment } = load;
    check_finite("a force on the race", force.iter().sum())?;
    check_finite("a moment on the race", moment.iter().sum())?;
    let size = norm(*force).max(norm(*moment) / fit.radius);
    // What rounding of a load turned into these axes leaves.
    let nothing = 1e-9 * size;
    if fit.axial == Axial::Free {
        if force[0].abs() > nothing {
            return Err(BoreError::AxialForce { force: force[0] });
        }
        // About the axis of a race that tilts nothing turns it without friction; about X its tilting moment has a part.
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
