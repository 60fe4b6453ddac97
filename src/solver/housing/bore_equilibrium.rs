//! Equilibrium of a rigid outer race in a condensed bore, contact on one side only.
//!
//! With q the race's coordinates (y, z, tilts about Y and Z), B the outward motion of its surface at
//! the nodes for a unit of each, u = C p the nodes' own outward motion under the loads p ≥ 0, and
//! g₀ the overlap before anything moves, the penetration of (2.19) is g = g₀ + B q − C p, and
//! p = K g where g > 0. All is linear but for which nodes touch, so the equilibrium Bᵀp = load is
//! the minimum of a convex energy and has one set of loads. Nodes are let in and out of contact all at once as long as
//! that leaves fewer of them wrong, and one by one otherwise (block principal pivoting, Júdice and
//! Pires 1994), which ends for every load.

use super::condensed::{BoreNode, CondensedBore, lever, race_motion};
use crate::ch2_housing::bore_contact::Penalty;
use crate::kinematics::vec3::{Vec3, norm};
use crate::solver::clock::to_digits;
use crate::solver::dense::DenseFactor;
use crate::solver::sparse::FactorError;
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
    /// In the solid by contact, and in the penalty springs, J.
    pub elastic_energy: f64,
    pub contact_energy: f64,
    pub touching: usize,
    /// Changes of the set of touching nodes, the first one included.
    pub iterations: usize,
    pub factorisations: usize,
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

/// A linear spring between the race and a place, besides its load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tether {
    pub stiffness: Matrix4<f64>,
    pub place: Vector4<f64>,
}

/// What a search starts from besides its bore.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoreMemory {
    /// y, z (m), tilts about Y and Z (rad).
    pub pose: [f64; 4],
    /// Nodes of the bore, ascending.
    pub touching: Vec<usize>,
}

/// Nodes in contact with the factors that belong to them.
struct Contact {
    nodes: Vec<usize>,
    factor: DenseFactor,
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
    /// A lower bound of the stiffness against radial motion with all nodes in contact, N/m.
    scale: f64,
    contact: Option<Contact>,
    pose: Vector4<f64>,
    changes: usize,
    factorisations: usize,
}

/// Changes of the touching nodes after which a search gives up; a cold start takes about ten.
const MOST_CHANGES: usize = 2000;
/// Unbalanced part of the load at which the race is in equilibrium.
const BALANCED: f64 = 1e-12;
/// The same, where the race has gone too far: rounding over travels of millimetres leaves more.
const MET: f64 = 1e-6;
/// Artificial stiffness against the last pose, as a part of [`BoreSearch::scale`]: it decides where
/// nothing else does, and its force is iterated away.
const HINT: f64 = 1e-8;

impl<'a> BoreSearch<'a> {
    pub fn new(bore: &'a CondensedBore, penalty: Penalty) -> BoreSearch<'a> {
        let levers: Vec<[f64; 4]> = bore.nodes.iter().map(lever).collect();
        let softness: Vec<f64> =
            bore.nodes.iter().map(|node| 1.0 / penalty.of_node(node.area)).collect();
        // The true compliance minimises this energy over all loads of unit sum.
        let compliance = |axis: usize| {
            let sum: f64 = levers.iter().map(|b| b[axis] * b[axis]).sum();
            let loads: Vec<f64> = levers.iter().map(|b| b[axis] / sum).collect();
            let all: Vec<usize> = (0..loads.len()).collect();
            let mut moves: Vec<f64> = softness.iter().zip(&loads).map(|(c, p)| c * p).collect();
            bore.compliance.add_product(&all, &loads, &mut moves);
            moves.iter().zip(&loads).map(|(u, p)| u * p).sum::<f64>()
        };
        let scale = 1.0 / compliance(0).max(compliance(1));
        BoreSearch {
            bore,
            penalty,
            levers,
            softness,
            scale,
            contact: None,
            pose: Vector4::zeros(),
            changes: 0,
            factorisations: 0,
        }
    }

    pub fn bore(&self) -> &'a CondensedBore {
        self.bore
    }

    /// Where the race was last, and which nodes touched.
    pub fn memory(&self) -> BoreMemory {
        let touching = self.contact.as_ref().map_or_else(Vec::new, |c| c.nodes.clone());
        BoreMemory { pose: self.pose.into(), touching }
    }

    /// Goes on from what a search of the same bore remembered, with its bits.
    ///
    /// # Errors
    /// Nodes that the bore does not have, or a factor that there is not.
    pub fn recall(&mut self, memory: &BoreMemory) -> Result<(), BoreError> {
        check_finite("the race's pose", memory.pose.iter().sum())?;
        if let Some(&node) = memory.touching.iter().find(|&&node| node >= self.levers.len()) {
            return Err(BoreError::NoSuchNode { node, count: self.levers.len() });
        }
        self.pose = Vector4::from(memory.pose);
        self.make_contact(memory.touching.clone())
    }

    pub fn penalty(&self) -> Penalty {
        self.penalty
    }

    /// Change of the nodes' loads with each coordinate of the race, N/m and N/rad, while the same
    /// nodes touch as in the last equilibrium.
    pub fn loads_by_pose(&self) -> [Vec<f64>; 4] {
        let mut loads: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; self.levers.len()]);
        if let Some(contact) = &self.contact {
            for (loads, by_motion) in loads.iter_mut().zip(&contact.by_motion) {
                contact.nodes.iter().zip(by_motion).for_each(|(&i, load)| loads[i] = *load);
            }
        }
        loads
    }

    /// The race under `load`, searched for from where it was last.
    ///
    /// A loose race without load stays where it is. Loads that leave it several places get the one
    /// nearest to the last.
    ///
    /// # Errors
    /// A load that the bore cannot hold.
    pub fn under_load(&mut self, fit: &Fit, load: &RaceLoad) -> Result<BoreState, BoreError> {
        let pull = check_load(fit, load)?;
        let none = Tether { stiffness: Matrix4::zeros(), place: Vector4::zeros() };
        self.under_load_and_tether(fit, &pull, &none)
    }

    /// The race at a given pose: y, z (m), tilts (rad).
    ///
    /// # Errors
    /// [`BoreError::BeyondReach`], [`BoreError::NotFinite`].
    pub fn at_pose(&mut self, fit: &Fit, pose: [f64; 4]) -> Result<BoreState, BoreError> {
        check_finite("the race's pose", pose.iter().sum())?;
        check_finite("the race's radius", fit.radius)?;
        (self.changes, self.factorisations) = (0, 0);
        self.pose = Vector4::from(pose);
        let overlap = self.overlap(fit);
        let loads = self.settle(&overlap, |_, _| Some(Vector4::from(pose)))?;
        self.finish(&overlap, loads)
    }

    pub(super) fn under_load_and_tether(
        &mut self,
        fit: &Fit,
        pull: &Vector4<f64>,
        tether: &Tether,
    ) -> Result<BoreState, BoreError> {
        check_finite("the race's radius", fit.radius)?;
        (self.changes, self.factorisations) = (0, 0);
        let overlap = self.overlap(fit);
        let metres = self.metres(fit);
        let scale = self.scale;
        let mut hint = HINT * scale;
        let mut last = f64::INFINITY;
        for _ in 0..40 {
            let before = self.pose;
            let hold = Matrix4::from_diagonal(&metres.component_mul(&metres)) * hint;
            let loads = self.settle(&overlap, |contact, by_overlap| {
                let stiffness = contact.map_or(Matrix4::zeros(), |contact| contact.stiffness);
                // Scaled, so that tilts and metres weigh alike.
                let per = metres.map(|m| 1.0 / m);
                // A bearing that is about to leave a saddle pushes the race on: the artificial stiffness
                // has to be larger than that.
                let mut hold = hold;
                let step = loop {
                    let right = pull + tether.stiffness * tether.place + hold * before - by_overlap;
                    let whole = stiffness + tether.stiffness + hold;
                    let scaled = Matrix4::from_fn(|i, j| whole[(i, j)] * per[i] * per[j]);
                    if let Some(factor) = scaled.cholesky() {
                        break factor.solve(&right.component_mul(&per));
                    }
                    // Stiffer than the whole bore: it is not this that is missing.
                    if hold[(0, 0)].is_nan() || hold[(0, 0)] > 10.0 * scale {
                        return None;
                    }
                    hold *= 10.0;
                };
                Some(step.component_mul(&per))
            })?;
            let state = self.finish(&overlap, loads)?;
            let left = pull
                - Vector4::from(state.load)
                - tether.stiffness * (Vector4::from(state.pose) - tether.place);
            let left = left.component_div(&metres);
            let radial: f64 = state.loads.iter().sum();
            // Beside a load the loads of an interference, as far as they round.
            let size = pull.component_div(&metres).amax().max(1e-2 * radial);
            if left.amax() <= BALANCED * size {
                return Ok(state);
            }
            let travel = self.pose.component_mul(&metres);
            let worst = travel.iamax();
            // Nothing that a bore holds moves by a hundredth of its radius.
            let lost = travel.amax().is_nan() || travel.amax() > 1e-2 * metres[2];
            if lost {
                let (coordinate, travel) = (POSE_NAMES[worst], self.pose[worst]);
                let (load, force) = (pull.component_div(&metres).amax(), left.amax());
                // All of the load meets resistance, only late.
                if load > 0.0 && force <= MET * load {
                    let youngs_modulus = self.bore.youngs_modulus;
                    let radius = fit.radius;
                    return Err(BoreError::GivesWay {
                        coordinate,
                        travel,
                        load,
                        radius,
                        youngs_modulus,
                    });
                }
                return Err(BoreError::NotHeld { coordinate, travel, force });
            }
            // Rounding is what is left: of the loads, or of gaps (some ulps of the radius).
            let gaps = 8.0 * f64::EPSILON * fit.radius * self.scale;
            let rounding = (1e3 * BALANCED * size).max(gaps);
            if left.amax() > 0.5 * last && left.amax() <= rounding {
                return Ok(state);
            }
            // A load that the artificial stiffness takes: let it take less.
            if left.amax() > 1e-3 * last {
                hint *= 0.1;
            }
            last = left.amax();
        }
        let worst = self.pose.component_mul(&metres).iamax();
        Err(BoreError::NotHeld {
            coordinate: POSE_NAMES[worst],
            travel: self.pose[worst],
            force: last,
        })
    }

    /// Metres of motion at the bore per unit of each coordinate.
    fn metres(&self, fit: &Fit) -> Vector4<f64> {
        Vector4::new(1.0, 1.0, fit.radius, fit.radius)
    }

    /// R − d of every node before race and bore move, m; the solid's own loads included.
    fn overlap(&self, fit: &Fit) -> Vec<f64> {
        let bore = self.bore;
        bore.nodes.iter().zip(&bore.own).map(|(n, own)| fit.radius - n.distance - own).collect()
    }

    /// Finds the touching nodes; `pose_of` gives the race's coordinates for a set of them and
    /// (Bᵀ(C + 1/K)⁻¹ g₀) of it. Returns the loads.
    fn settle(
        &mut self,
        overlap: &[f64],
        pose_of: impl Fn(Option<&Contact>, &Vector4<f64>) -> Option<Vector4<f64>>,
    ) -> Result<Vec<f64>, BoreError> {
        const PATIENCE: usize = 10;
        let count = overlap.len();
        if self.contact.is_none() {
            let start = (0..count).filter(|&i| overlap[i] > 0.0).collect();
            self.make_contact(start)?;
        }
        let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
        loop {
            self.changes += 1;
            if self.changes > MOST_CHANGES {
                return Err(BoreError::NotSettled { changes: MOST_CHANGES });
            }
            let contact = self.contact.as_ref();
            let nodes: &[usize] = contact.map_or(&[], |contact| &contact.nodes);
            let mut on_nodes: Vec<f64> = nodes.iter().map(|&i| overlap[i]).collect();
            let mut by_overlap = Vector4::zeros();
            if let Some(contact) = contact {
                contact.factor.solve_columns(&mut on_nodes, 1);
                for (&i, load) in contact.nodes.iter().zip(&on_nodes) {
                    by_overlap += Vector4::from(self.levers[i]) * *load;
                }
            }
            let Some(pose) = pose_of(contact, &by_overlap) else {
                return Err(FactorError::NotPositiveDefinite { pivot: 0 }.into());
            };
            let mut moves = vec![0.0; count];
            let mut loads = vec![0.0; count];
            if let Some(contact) = contact {
                for (at, load) in on_nodes.iter_mut().enumerate() {
                    for (by, q) in contact.by_motion.iter().zip(pose.iter()) {
                        *load += by[at] * q;
                    }
                }
                self.bore.compliance.add_product(nodes, &on_nodes, &mut moves);
                for (&i, load) in nodes.iter().zip(&on_nodes) {
                    loads[i] = *load;
                }
            }
            // Loads of either sign that are rounding of the largest change nothing.
            let largest = on_nodes.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
            let mut inside = vec![false; count];
            nodes.iter().for_each(|&i| inside[i] = true);
            let rounding = 4.0 * f64::EPSILON * self.bore.reach.radius;
            let wrong: Vec<usize> = (0..count)
                .filter(|&i| {
                    if inside[i] {
                        loads[i].is_nan() || loads[i] < -1e-12 * largest
                    } else {
                        let motion: f64 =
                            self.levers[i].iter().zip(pose.iter()).map(|(b, q)| b * q).sum();
                        let g = overlap[i] + motion - moves[i];
                        g.is_nan() || g > rounding.max(1e-12 * largest * self.softness[i])
                    }
                })
                .collect();
            if wrong.is_empty() {
                self.pose = pose;
                loads.iter_mut().for_each(|load| *load = load.max(0.0));
                return Ok(loads);
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
        self.factorisations += 1;
        let mut right = Vec::with_capacity(4 * nodes.len());
        for axis in 0..4 {
            right.extend(nodes.iter().map(|&i| self.levers[i][axis]));
        }
        factor.solve_columns(&mut right, 4);
        let mut columns = right.chunks_exact(nodes.len()).map(<[f64]>::to_vec);
        let by_motion: [Vec<f64>; 4] = std::array::from_fn(|_| columns.next().unwrap_or_default());
        let mut stiffness = Matrix4::from_fn(|i, j| {
            let of = nodes.iter().zip(&by_motion[j]);
            of.map(|(&node, load)| self.levers[node][i] * load).sum()
        });
        stiffness = 0.5 * (stiffness + stiffness.transpose());
        self.contact = Some(Contact { nodes, factor, by_motion, stiffness });
        Ok(())
    }

    fn finish(&self, overlap: &[f64], loads: Vec<f64>) -> Result<BoreState, BoreError> {
        let bore = self.bore;
        let pose: [f64; 4] = self.pose.into();
        let all: Vec<usize> = (0..loads.len()).collect();
        let mut moves = vec![0.0; loads.len()];
        bore.compliance.add_product(&all, &loads, &mut moves);
        let motion: Vec<f64> = bore.nodes.iter().map(|node| race_motion(node, &pose)).collect();
        let penetration: Vec<f64> =
            overlap.iter().zip(&motion).zip(&moves).map(|((g, b), u)| g + b - u).collect();
        let mut load = Vector4::zeros();
        for (lever, p) in self.levers.iter().zip(&loads) {
            load += Vector4::from(*lever) * *p;
        }
        let outward: Vec<f64> = moves.iter().zip(&bore.own).map(|(u, own)| u + own).collect();
        if let Some(travel) = bore.reach.travel {
            let largest = |of: &[f64]| of.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let motion = norm([0.0, pose[0], pose[1]])
                + largest(&outward)
                + norm([0.0, pose[2], pose[3]]) * 0.5 * bore.reach.width;
            if motion.is_nan() || motion > travel {
                return Err(BoreError::BeyondReach { motion, travel });
            }
        }
        let half_work = |of: &[f64]| 0.5 * of.iter().zip(&loads).map(|(u, p)| u * p).sum::<f64>();
        let squeeze: Vec<f64> = self.softness.iter().zip(&loads).map(|(c, p)| c * p).collect();
        Ok(BoreState {
            pose,
            penetration,
            elastic_energy: half_work(&moves),
            contact_energy: half_work(&squeeze),
            outward,
            load: load.into(),
            stiffness: self.contact.as_ref().map_or(Matrix4::zeros(), |c| c.stiffness),
            touching: loads.iter().filter(|load| **load > 0.0).count(),
            loads,
            iterations: self.changes,
            factorisations: self.factorisations,
        })
    }
}

/// The load along the four coordinates.
pub(super) fn check_load(fit: &Fit, load: &RaceLoad) -> Result<Vector4<f64>, BoreError> {
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
        if moment[0].abs() > nothing * fit.radius {
            return Err(BoreError::AxialMoment { moment: moment[0] });
        }
    }
    Ok(Vector4::new(force[1], force[2], moment[1], moment[2]))
}

fn check_finite(what: &'static str, value: f64) -> Result<(), BoreError> {
    if value.is_finite() { Ok(()) } else { Err(BoreError::NotFinite { what, value }) }
}

/// Radius of the race that makes `interference` (m; negative for a clearance) in this bore: the mean
/// distance of its nodes from the axis, and that.
pub fn radius_of_fit(nodes: &[BoreNode], interference: f64) -> f64 {
    nodes.iter().map(|node| node.distance).sum::<f64>() / nodes.len() as f64 + interference
}
