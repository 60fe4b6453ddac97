//! Terms of contacts, joints and drives in the matrix of a linearly implicit step and in its right-hand sides.

use crate::members::connection::MaxwellElement;
use crate::members::state::LANES;
use crate::motion::elimination::{LdltMatrix, ZERO, add_product, subtract_product, total};
use crate::motion::linearised::{JointRow, Lane, LaneContact, Linearised};

/// Weights times levers: (h²γ² k + hγ c) along the normal, hγ · slope for the others.
pub(crate) fn weigh(contact: &LaneContact, lever: &[[Lane; 6]; 4], scale: f64) -> [[Lane; 6]; 4] {
    let mut pushed = [[ZERO; 6]; 4];
    let mut normal = ZERO;
    for l in 0..LANES {
        normal[l] = scale * (contact.damping[l] + scale * contact.stiffness[l]);
    }
    for j in 0..6 {
        for l in 0..LANES {
            pushed[0][j][l] = normal[l] * lever[0][j][l];
        }
    }
    if contact.rows == 1 {
        return pushed;
    }
    let [tt, ts, tn, ss, sn, nn] = &contact.slope;
    for j in 0..6 {
        for l in 0..LANES {
            let [t, s, n] = [1, 2, 3].map(|row: usize| scale * lever[row][j][l]);
            pushed[1][j][l] = tt[l] * t + ts[l] * s + tn[l] * n;
            pushed[2][j][l] = ts[l] * t + ss[l] * s + sn[l] * n;
            pushed[3][j][l] = tn[l] * t + sn[l] * s + nn[l] * n;
        }
    }
    pushed
}

/// Restoring force of a contact along its rows for displacements and velocities of ball and hub. The rotation of a
/// frame closes contacts; sliding rotates with the frame and does not change.
#[inline(always)]
fn reaction(
    contact: &LaneContact,
    [position, drift]: [&[Lane; 3]; 2],
    moved: &[f64; 6],
    velocity: Option<(&[Lane; 6], &[f64; 6])>,
) -> [Lane; 4] {
    let mut pushes = [ZERO; 4];
    let mut approach = ZERO;
    for i in 0..3 {
        add_product(&mut approach, &contact.on_ball[0][i], &position[i]);
        add_product(&mut approach, &contact.on_ball[0][i], &drift[i]);
    }
    if contact.hub.is_some() {
        for (row, moved) in contact.on_hub[0].iter().zip(moved) {
            for l in 0..LANES {
                approach[l] += row[l] * moved;
            }
        }
    }
    for l in 0..LANES {
        pushes[0][l] = contact.stiffness[l] * approach[l];
    }
    let mut slid = [ZERO; 3];
    if contact.rows == 4 {
        let mut between = *position;
        if contact.hub.is_some() {
            let mut shift = [moved[0], moved[1], moved[2]];
            if let Some(turned) = &contact.shifts {
                for (by, turn) in turned.iter().zip(&moved[3..]) {
                    for i in 0..3 {
                        shift[i] += turn * by[i];
                    }
                }
            }
            for i in 0..3 {
                for l in 0..LANES {
                    between[i][l] -= shift[i];
                }
            }
        }
        for (slid, row) in slid.iter_mut().zip(&contact.slip_change) {
            for i in 0..3 {
                add_product(slid, &row[i], &between[i]);
            }
        }
    }
    if let Some((ball, hub)) = velocity {
        let mut closing = ZERO;
        for i in 0..3 {
            add_product(&mut closing, &contact.on_ball[0][i], &ball[i]);
        }
        for (row, slid) in slid.iter_mut().enumerate() {
            for i in 0..6 {
                add_product(slid, &contact.on_ball[1 + row][i], &ball[i]);
            }
        }
        if contact.hub.is_some() {
            for j in 0..6 {
                for l in 0..LANES {
                    closing[l] += contact.on_hub[0][j][l] * hub[j];
                }
                for (row, slid) in slid.iter_mut().enumerate() {
                    for l in 0..LANES {
                        slid[l] += contact.on_hub[1 + row][j][l] * hub[j];
                    }
                }
            }
        }
        for l in 0..LANES {
            pushes[0][l] += contact.damping[l] * closing[l];
        }
    }
    if contact.rows == 4 {
        let [tt, ts, tn, ss, sn, nn] = &contact.slope;
        for l in 0..LANES {
            let [t, s, n] = [slid[0][l], slid[1][l], slid[2][l]];
            let follows = |row: usize| contact.per_load[row][l] * pushes[0][l];
            let along = tt[l] * t + ts[l] * s + tn[l] * n - follows(0);
            let across = ts[l] * t + ss[l] * s + sn[l] * n - follows(1);
            let about = tn[l] * t + sn[l] * s + nn[l] * n - follows(2);
            [pushes[1][l], pushes[2][l], pushes[3][l]] = [along, across, about];
        }
    }
    pushes
}

/// hγ K r: subtracts the restoring forces of displacements from the right-hand sides.
pub(crate) fn spring_back(
    contact: &LaneContact,
    scale: f64,
    at: [&[Lane; 3]; 2],
    moved: &[[f64; 6]],
    right: &mut [Lane; 6],
    hubs: &mut [f64],
) {
    let of_hub = contact.hub.map_or(&[0.0; 6], |hub| &moved[hub]);
    let mut pushes = reaction(contact, at, of_hub, None);
    let rows = if contact.rows == 4 { 4 } else { 1 };
    for (row, push) in pushes.iter_mut().enumerate().take(rows) {
        for l in 0..LANES {
            push[l] *= scale;
        }
        for i in 0..6 {
            subtract_product(&mut right[i], &contact.on_ball[row][i], push);
        }
    }
    if let Some(hub) = contact.hub {
        for j in 0..6 {
            let mut sum = ZERO;
            for (row, push) in pushes.iter().enumerate().take(rows) {
                add_product(&mut sum, &contact.on_hub[row][j], push);
            }
            hubs[6 * hub + j] -= total(&sum);
        }
    }
}

/// Change of the power of drives with prescribed velocities.
pub(crate) fn drive_power(
    contact: &LaneContact,
    at: [&[Lane; 3]; 2],
    moved: &[f64; 6],
    ball: &[Lane; 6],
    hub: &[f64; 6],
) -> f64 {
    let pushes = reaction(contact, at, moved, Some((ball, hub)));
    let mut driven = ZERO;
    for (row, push) in pushes.iter().enumerate() {
        add_product(&mut driven, &contact.driven[row], push);
    }
    total(&driven)
}

pub(crate) fn add_joints(linearised: &Linearised, scale: f64, schur: &mut LdltMatrix) {
    for joint in &linearised.joints {
        for row in &joint.rows[..joint.count] {
            let spring = scale * scale * row.stiffness;
            let weight = if row.damping == 0.0 { spring } else { spring + scale * row.damping };
            add_joint(joint.hubs, row, weight, schur);
        }
    }
    // de/dt = L v − e/τ, with elongations eliminated.
    for of in &linearised.relaxing {
        let joint = &linearised.joints[of.joint];
        for (i, row) in joint.rows.iter().enumerate() {
            let follows = |element: &MaxwellElement| {
                element.stiffness[i] / (1.0 + scale / element.relaxation_time)
            };
            let stiffness: f64 = of.elements.iter().map(follows).sum();
            add_joint(joint.hubs, row, scale * scale * stiffness, schur);
        }
    }
}

fn add_joint(hubs: [Option<usize>; 2], row: &JointRow, weight: f64, schur: &mut LdltMatrix) {
    for (a, rows) in hubs.into_iter().enumerate() {
        for (b, columns) in hubs.into_iter().enumerate() {
            let (Some(rows), Some(columns)) = (rows, columns) else { continue };
            // Only the upper triangle is kept.
            if rows > columns {
                continue;
            }
            for i in 0..6 {
                for j in 0..6 {
                    *schur.at(6 * rows + i, 6 * columns + j) +=
                        row.levers[a][i] * weight * row.levers[b][j];
                }
            }
        }
    }
}

pub(crate) fn joint_forces(
    linearised: &Linearised,
    scale: f64,
    moved: &[[f64; 6]],
    hubs: &mut [f64],
) {
    for joint in &linearised.joints {
        for row in joint.rows[..joint.count].iter().filter(|row| row.stiffness != 0.0) {
            let mut push = 0.0;
            for (lever, hub) in row.levers.iter().zip(joint.hubs) {
                let Some(hub) = hub else { continue };
                push += (0..6).map(|j| lever[j] * moved[hub][j]).sum::<f64>();
            }
            push *= scale * row.stiffness;
            for (lever, hub) in row.levers.iter().zip(joint.hubs) {
                let Some(hub) = hub else { continue };
                for j in 0..6 {
                    hubs[6 * hub + j] -= lever[j] * push;
                }
            }
        }
    }
}

/// Restoring forces of the elongations of Maxwell elements in `r`.
pub(crate) fn relaxing_forces(linearised: &Linearised, scale: f64, r: &[f64], hubs: &mut [f64]) {
    for of in &linearised.relaxing {
        let joint = &linearised.joints[of.joint];
        for (k, element) in of.elements.iter().enumerate() {
            let decay = 1.0 / (1.0 + scale / element.relaxation_time);
            for (i, row) in joint.rows.iter().enumerate() {
                let push = scale * element.stiffness[i] * decay * r[of.at + 6 * k + i];
                for (lever, hub) in row.levers.iter().zip(joint.hubs) {
                    let Some(hub) = hub else { continue };
                    for j in 0..6 {
                        hubs[6 * hub + j] -= lever[j] * push;
                    }
                }
            }
        }
    }
}

/// Elongations in `w` from those in `r` and the rates of the hubs.
pub(crate) fn elongate(
    linearised: &Linearised,
    scale: f64,
    rates: &[[f64; 6]],
    r: &[f64],
    w: &mut [f64],
) {
    for of in &linearised.relaxing {
        let joint = &linearised.joints[of.joint];
        for (i, row) in joint.rows.iter().enumerate() {
            let mut rate = 0.0;
            for (lever, hub) in row.levers.iter().zip(joint.hubs) {
                let Some(hub) = hub else { continue };
                rate += (0..6).map(|j| lever[j] * rates[hub][j]).sum::<f64>();
            }
            for (k, element) in of.elements.iter().enumerate() {
                let e = of.at + 6 * k + i;
                w[e] = (r[e] + scale * rate) / (1.0 + scale / element.relaxation_time);
            }
        }
    }
}
