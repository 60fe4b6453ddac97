//! Loads of a ball in equilibrium on a race, with the ball's own coordinates eliminated.

use crate::members::race_position::InnerRacePosition;
use crate::members::static_ball::{
    BallContacts, BallPlane, SettledBall, inner_energy, outer_energy, sight,
};
use nalgebra::{SMatrix, SVector, Vector3};

/// Adds the load of a ball in equilibrium on the inner race's five coordinates and its derivative, ∂V/∂q and ∂²V/∂q²,
/// with the ball's coordinates condensed. Returns the force on the race, N.
pub fn add_to_race(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    ball: &SettledBall,
    gradient: &mut SVector<f64, 5>,
    stiffness: &mut SMatrix<f64, 5, 5>,
) -> Vector3<f64> {
    if ball.inner_load == 0.0 {
        return Vector3::zeros();
    }
    let (slope, curvature) = race_and_ball_derivatives(plane, race, contacts, ball.position);
    let outer = outer_energy(contacts, ball.position);
    let (uu, uv, vv) = (
        curvature[(5, 5)] + outer.curvature[0],
        curvature[(5, 6)] + outer.curvature[1],
        curvature[(6, 6)] + outer.curvature[2] - plane.centrifugal,
    );
    let determinant = uu * vv - uv * uv;
    for i in 0..5 {
        gradient[i] += slope[i];
        let (iu, iv) = (curvature[(i, 5)], curvature[(i, 6)]);
        // Row of H_qu H_uu⁻¹.
        let (fu, fv) = ((iu * vv - iv * uv) / determinant, (iv * uu - iu * uv) / determinant);
        for j in i..5 {
            let condensed = curvature[(i, j)] - fu * curvature[(j, 5)] - fv * curvature[(j, 6)];
            stiffness[(i, j)] += condensed;
            if j > i {
                stiffness[(j, i)] += condensed;
            }
        }
    }
    Vector3::new(-slope[0], -slope[1], -slope[2])
}

/// First and second derivatives of the inner contact's energy with respect to the race's five
/// coordinates and the ball's two.
fn race_and_ball_derivatives(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    position: [f64; 2],
) -> (SVector<f64, 7>, SMatrix<f64, 7, 7>) {
    let seen = sight(plane, race, position);
    let inner = inner_energy(contacts, &seen);
    let (a, w) = (&race.axis, &seen.arm);
    let (h, rho) = (seen.axial, seen.radial);
    // h = a·w, and ρ² = w·w − h²; `half` is the gradient of w·w/2.
    let dh = SVector::<f64, 7>::from([
        -a.x,
        -a.y,
        -a.z,
        race.axis_xi.dot(w),
        race.axis_lambda.dot(w),
        a.dot(&plane.axial),
        a.dot(&plane.radial),
    ]);
    let half = SVector::<f64, 7>::from([
        -w.x,
        -w.y,
        -w.z,
        0.0,
        0.0,
        w.dot(&plane.axial),
        w.dot(&plane.radial),
    ]);
    let dr = (half - dh * h) / rho;
    let slope = dh * inner.slope[0] + dr * inner.slope[1];

    let [c_hh, c_hr, c_rr] = inner.curvature;
    let bend = inner.slope[1] / rho;
    let mut curvature = SMatrix::<f64, 7, 7>::zeros();
    for i in 0..7 {
        for j in i..7 {
            curvature[(i, j)] = (c_hh - bend) * dh[i] * dh[j]
                + c_hr * (dh[i] * dr[j] + dr[i] * dh[j])
                + (c_rr - bend) * dr[i] * dr[j];
        }
    }
    // ∇²(w·w/2) times V_ρ/ρ.
    for i in 0..3 {
        curvature[(i, i)] += bend;
        curvature[(i, 5)] -= bend * plane.axial[i];
        curvature[(i, 6)] -= bend * plane.radial[i];
    }
    curvature[(5, 5)] += bend;
    curvature[(6, 6)] += bend;
    // ∇²h times V_h − h V_ρ/ρ.
    let turn = inner.slope[0] - h * bend;
    for i in 0..3 {
        curvature[(i, 3)] -= turn * race.axis_xi[i];
        curvature[(i, 4)] -= turn * race.axis_lambda[i];
    }
    curvature[(3, 3)] += turn * race.axis_xi_xi.dot(w);
    curvature[(3, 4)] += turn * race.axis_xi_lambda.dot(w);
    curvature[(4, 4)] -= turn * h;
    curvature[(3, 5)] += turn * race.axis_xi.dot(&plane.axial);
    curvature[(3, 6)] += turn * race.axis_xi.dot(&plane.radial);
    curvature[(4, 5)] += turn * race.axis_lambda.dot(&plane.axial);
    curvature[(4, 6)] += turn * race.axis_lambda.dot(&plane.radial);
    (slope, curvature)
}
