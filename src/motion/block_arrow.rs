//! The matrix of a linearly implicit step, M + hγ D + h²γ² K over all velocities. Balls touch hubs (races, cage) and
//! are not coupled with each other. Each ball is eliminated into its hubs, as are the modes of reduced solids; six
//! equations for each moving body remain.
//!
//! Balls are eliminated in blocks of [`LANES`], with every kernel.

use crate::ch2_housing::bearing::inertia::Inertia;
use crate::members::ball_set::BallSet;
use crate::members::state::{
    LANES, Layout, Ledger, ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate,
};
use crate::motion::block_arrow_solids::SolidBlock;
use crate::motion::block_arrow_terms::{
    add_joints, drive_power, elongate, joint_forces, relaxing_forces, spring_back, weigh,
};
use crate::motion::elimination::{
    Block, LdltMatrix, ZERO, add_product, factor_lanes, solve_columns, solve_lanes, total,
};
use crate::motion::linearised::{BallBlock, Hub, Lane, Linearised, from_basis, to_basis};
use crate::motion::linearised_shafts::Bending;
use crate::motion::system::System;
use nalgebra::Quaternion;

/// Largest number of hubs of a ball: two races and a cage.
const HUBS: usize = 3;

/// A factored matrix and its working memory.
#[derive(Clone, Debug)]
pub struct BlockArrowMatrix {
    /// Of each bearing.
    ball: Vec<Inertia>,
    /// hγ.
    scale: f64,
    /// LDLᵀ of each block's 6 × 6, upper triangle, reciprocal pivots on the diagonal.
    factors: Vec<Block>,
    /// Inverse matrix of the balls times their coupling to each hub of the block.
    eliminated: Vec<[Block; HUBS]>,
    /// True where the coupling is not zero.
    coupled: Vec<[bool; HUBS]>,
    schur: LdltMatrix,
    /// `None` without flexible bodies.
    bending: Option<Bending>,
    balls: Vec<[Lane; 6]>,
    /// Right-hand side and rates of all hubs; their displacements.
    hubs: Vec<f64>,
    moved: Vec<[f64; 6]>,
    /// Block of each reduced solid.
    solids: Vec<SolidBlock>,
}

impl BlockArrowMatrix {
    pub fn new(system: &System, linearised: &Linearised) -> BlockArrowMatrix {
        let blocks = linearised.blocks.len();
        let hubs = linearised.hubs.len();
        let size = 6 * hubs;
        let solids = (0..linearised.solids.len()).map(|k| SolidBlock::new(system, linearised, k));
        BlockArrowMatrix {
            ball: system.assembly.bearings.iter().map(|bearing| bearing.ball).collect(),
            scale: 0.0,
            factors: vec![[[ZERO; 6]; 6]; blocks],
            eliminated: vec![[[[ZERO; 6]; 6]; HUBS]; blocks],
            coupled: vec![[false; HUBS]; blocks],
            schur: LdltMatrix::new(size),
            bending: (!linearised.shafts.is_empty()).then(|| Bending::new(linearised, size)),
            balls: vec![[ZERO; 6]; blocks],
            hubs: vec![0.0; size],
            moved: vec![[0.0; 6]; hubs],
            solids: solids.collect(),
        }
    }

    /// Factors the matrix for a step with hγ = `scale`.
    pub fn factor(&mut self, linearised: &Linearised, scale: f64) {
        self.scale = scale;
        self.schur.clear();
        for (index, hub) in linearised.hubs.iter().enumerate() {
            for i in 0..6 {
                *self.schur.at(6 * index + i, 6 * index + i) =
                    hub.inertia[i] + scale * (hub.damping[i] + scale * hub.stiffness[i]);
            }
        }
        add_joints(linearised, scale, &mut self.schur);
        for (block, solid) in self.solids.iter_mut().zip(&linearised.solids) {
            block.factor(linearised, solid, scale, &mut self.schur);
        }
        for (index, block) in linearised.blocks.iter().enumerate() {
            self.factor_block(index, block);
        }
        match &mut self.bending {
            Some(bending) => bending.factor(linearised, scale, &mut self.schur),
            None => self.schur.factor(),
        }
    }

    fn factor_block(&mut self, block: usize, of: &BallBlock) {
        let scale = self.scale;
        let ball = &self.ball[of.bearing];
        let factors = &mut self.factors[block];
        for i in 0..6 {
            for j in i..6 {
                factors[i][j] = ZERO;
            }
            factors[i][i] = [if i < 3 { ball.mass } else { ball.axial }; LANES];
        }
        let mut couplings = [[[ZERO; 6]; 6]; HUBS];
        let coupled = &mut self.coupled[block];
        *coupled = [false; HUBS];
        for (slot, contact) in of.contacts.iter().enumerate() {
            if contact.rows == 0 {
                continue;
            }
            let pushed = weigh(contact, &contact.on_ball, scale);
            for i in 0..6 {
                for j in i..6 {
                    for r in 0..contact.rows {
                        add_product(&mut factors[i][j], &contact.on_ball[r][i], &pushed[r][j]);
                    }
                }
            }
            let Some(hub) = contact.hub else { continue };
            let pushed = weigh(contact, &contact.on_hub, scale);
            coupled[slot] = true;
            for i in 0..6 {
                for j in 0..6 {
                    let mut sum = ZERO;
                    for r in 0..contact.rows {
                        add_product(&mut sum, &contact.on_ball[r][i], &pushed[r][j]);
                    }
                    couplings[slot][i][j] = sum;
                }
                for j in i..6 {
                    let mut sum = ZERO;
                    for r in 0..contact.rows {
                        add_product(&mut sum, &contact.on_hub[r][i], &pushed[r][j]);
                    }
                    *self.schur.at(6 * hub + i, 6 * hub + j) += total(&sum);
                }
            }
        }
        factor_lanes(factors);
        for slot in (0..HUBS).filter(|slot| coupled[*slot]) {
            let eliminated = &mut self.eliminated[block][slot];
            *eliminated = couplings[slot];
            solve_columns(factors, eliminated);
        }
        let hub = |slot: usize| of.contacts[slot].hub.filter(|_| coupled[slot]);
        for first in 0..HUBS {
            for second in first..HUBS {
                let (Some(one), Some(other)) = (hub(first), hub(second)) else { continue };
                // Only the upper triangle is kept.
                let (rows, columns) = if one <= other { (first, second) } else { (second, first) };
                let (row, column) = (one.min(other), one.max(other));
                let eliminated = &self.eliminated[block][columns];
                for i in 0..6 {
                    let from = if row == column { i } else { 0 };
                    for j in from..6 {
                        let mut sum = ZERO;
                        for k in 0..6 {
                            add_product(&mut sum, &couplings[rows][k][i], &eliminated[k][j]);
                        }
                        *self.schur.at(6 * row + i, 6 * column + j) -= total(&sum);
                    }
                }
            }
        }
    }

    /// Solves (1 − hγ J) w = r for all entries of the state; `at` is the state of the Jacobian. The ledger and the
    /// orientation of balls do not feed back. Rates of prescribed motions follow from the rest of `w`, their other
    /// entries are those of `r`. `drift` is the motion of the rotating frames, by which contacts close too.
    pub fn solve(
        &mut self,
        linearised: &Linearised,
        sets: &[BallSet],
        at: &[f64],
        drift: &[f64],
        r: &[f64],
        w: &mut [f64],
    ) {
        w.copy_from_slice(r);
        let scale = self.scale;
        let BlockArrowMatrix {
            ball, factors, eliminated, coupled, balls, hubs, moved, solids, ..
        } = self;
        let bodies = linearised.bodies();
        hubs[6 * bodies..6 * linearised.hubs.len()].fill(0.0);
        for (index, hub) in linearised.hubs[..bodies].iter().enumerate() {
            moved[index] = displacement(hub, at, r, drift);
            let rate = to_basis(hub, vector(r, hub.at + VELOCITY), vector(r, hub.at + SPIN));
            for i in 0..6 {
                hubs[6 * index + i] =
                    hub.inertia[i] * rate[i] - scale * hub.stiffness[i] * moved[index][i];
            }
        }
        if let Some(bending) = &self.bending {
            bending.displace(linearised, r, moved);
        }
        joint_forces(linearised, scale, moved, hubs);
        relaxing_forces(linearised, scale, r, hubs);
        for (block, solid) in solids.iter_mut().zip(&linearised.solids) {
            block.subtract_forces(solid, scale, r, moved, hubs);
        }
        for (index, block) in linearised.blocks.iter().enumerate() {
            let right = &mut balls[index];
            let layout = &sets[block.bearing].layout;
            let ball = &ball[block.bearing];
            let lanes = |component: usize| {
                let from = layout.ball(component) + block.first;
                let mut lane = ZERO;
                lane.copy_from_slice(&r[from..from + LANES]);
                lane
            };
            let position: [Lane; 3] = [0, 1, 2].map(|i| lanes(POSITION + i));
            let drift = lanes_of(drift, layout, block.first);
            for i in 0..3 {
                let (force, moment) = (lanes(VELOCITY + i), lanes(SPIN + i));
                for l in 0..LANES {
                    right[i][l] = ball.mass * force[l];
                    right[3 + i][l] = ball.axial * moment[l];
                }
            }
            for contact in block.contacts.iter().filter(|contact| contact.rows > 0) {
                spring_back(contact, scale, [&position, &drift], moved, right, hubs);
            }
            for (slot, eliminated) in eliminated[index].iter().enumerate() {
                let Some(hub) = block.contacts[slot].hub.filter(|_| coupled[index][slot]) else {
                    continue;
                };
                for j in 0..6 {
                    let mut sum = ZERO;
                    for i in 0..6 {
                        add_product(&mut sum, &eliminated[i][j], &right[i]);
                    }
                    hubs[6 * hub + j] -= total(&sum);
                }
            }
            solve_lanes(&factors[index], right);
        }
        match &mut self.bending {
            Some(bending) => bending.solve(linearised, scale, r, hubs, w),
            None => self.schur.solve(hubs),
        }
        let rates: &[[f64; 6]] = hubs.as_chunks().0;
        for (moved, rate) in moved.iter_mut().zip(rates) {
            for i in 0..6 {
                moved[i] += scale * rate[i];
            }
        }
        elongate(linearised, scale, rates, r, w);
        for (block, solid) in solids.iter_mut().zip(&linearised.solids) {
            block.follow(solid, scale, r, rates, w);
        }
        let mut power = 0.0;
        for (index, (block, right)) in linearised.blocks.iter().zip(balls).enumerate() {
            let layout = &sets[block.bearing].layout;
            for (slot, eliminated) in eliminated[index].iter().enumerate() {
                let Some(hub) = block.contacts[slot].hub.filter(|_| coupled[index][slot]) else {
                    continue;
                };
                for i in 0..6 {
                    for j in 0..6 {
                        let change = rates[hub][j];
                        for l in 0..LANES {
                            right[i][l] -= eliminated[i][j][l] * change;
                        }
                    }
                }
            }
            let mut position = [ZERO; 3];
            for (i, lane) in position.iter_mut().enumerate() {
                let from = layout.ball(POSITION + i) + block.first;
                for l in 0..LANES {
                    lane[l] = r[from + l] + scale * right[i][l];
                }
            }
            let drift = lanes_of(drift, layout, block.first);
            for contact in &block.contacts[..2] {
                if let (4, Some(hub)) = (contact.rows, contact.hub) {
                    let at = [&position, &drift];
                    power += drive_power(contact, at, &moved[hub], right, &rates[hub]);
                }
            }
            // Lanes beyond the last ball do not move.
            let used = LANES.min(layout.balls - block.first.min(layout.balls));
            for i in 0..3 {
                let place = |component: usize| layout.ball(component + i) + block.first;
                let (x, v, s) = (place(POSITION), place(VELOCITY), place(SPIN));
                w[v..v + used].copy_from_slice(&right[i][..used]);
                w[s..s + used].copy_from_slice(&right[3 + i][..used]);
                w[x..x + used].copy_from_slice(&position[i][..used]);
            }
        }
        if let Some(set) = sets.first() {
            w[set.layout.ledger_entry(Ledger::Drives)] += scale * power;
        }
        for (hub, rate) in linearised.hubs[..bodies].iter().zip(rates) {
            let (linear, turning) = from_basis(hub, rate);
            let q = [0, 1, 2, 3].map(|i| at[hub.at + ORIENTATION + i]);
            let turned = quaternion_rate(q, turning);
            for i in 0..3 {
                w[hub.at + POSITION + i] = r[hub.at + POSITION + i] + scale * linear[i];
                w[hub.at + VELOCITY + i] = linear[i];
                w[hub.at + SPIN + i] = turning[i];
            }
            for i in 0..4 {
                w[hub.at + ORIENTATION + i] = r[hub.at + ORIENTATION + i] + scale * turned[i];
            }
        }
    }
}

/// Three components of a block's balls.
fn lanes_of(values: &[f64], layout: &Layout, first: usize) -> [Lane; 3] {
    let mut lanes = [ZERO; 3];
    for (i, lane) in lanes.iter_mut().enumerate() {
        let from = layout.ball(POSITION + i) + first;
        lane.copy_from_slice(&values[from..from + LANES]);
    }
    lanes
}

fn vector(of: &[f64], at: usize) -> [f64; 3] {
    [of[at], of[at + 1], of[at + 2]]
}

/// Displacement and rotation of a hub in a vector of rates or increments, with the rotation of its frame; zero for
/// prescribed parts.
fn displacement(hub: &Hub, at: &[f64], r: &[f64], drift: &[f64]) -> [f64; 6] {
    let quaternion = |of: &[f64]| {
        let from = hub.at + ORIENTATION;
        Quaternion::new(of[from], of[from + 1], of[from + 2], of[from + 3])
    };
    let turned = quaternion(r) + quaternion(drift);
    let turn = (turned * quaternion(at).conjugate()).imag() * 2.0;
    let all = to_basis(hub, vector(r, hub.at + POSITION), turn.into());
    std::array::from_fn(|i| all[i] * hub.free[i])
}
