//! Moment of a ball that spins about its contact normals, over the number of slices.

use core::f64::consts::PI;

use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::{Layout, SPIN};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};

use super::deep_groove;
use crate::bearings::DEEP_GROOVE;
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::motion;
use crate::oracles::hertz::{ball_on_race, effective_modulus, hamrock_brewe};

const FRICTION: f64 = 0.07;
/// Clearance −10 µm through the balls: with the balls in their nominal places both contacts of each
/// are squeezed by half of it.
const OVERLAP: f64 = 5e-6;

/// 3κWa/8 of both contacts times what `width` makes of the ratio of the semi-axes, from the printed lengths.
fn exact(width: fn(f64) -> f64) -> f64 {
    let ball = DEEP_GROOVE.ball_radius + OVERLAP;
    let modulus = effective_modulus(210e9, 0.3, 210e9, 0.3);
    [
        (DEEP_GROOVE.pitch_radius - DEEP_GROOVE.ball_radius, DEEP_GROOVE.inner_groove_radius, 1.0),
        (DEEP_GROOVE.pitch_radius + DEEP_GROOVE.ball_radius, DEEP_GROOVE.outer_groove_radius, -1.0),
    ]
    .map(|(race, groove, sign)| {
        let radii = ball_on_race(ball, race, groove, sign);
        let load = hamrock_brewe(radii, 1.0, modulus).stiffness * OVERLAP.powf(1.5);
        let ellipse = hamrock_brewe(radii, load, modulus);
        let [major, minor] = [ellipse.semi_axis_transverse, ellipse.semi_axis_rolling];
        3.0 * FRICTION * load * major / 8.0 * width(minor / major)
    })
    .iter()
    .sum()
}

/// E, complete elliptic integral of the second kind of an ellipse: ∫₀^(π/2) √(sin² θ + r² cos² θ) dθ. Equal steps over a
/// period of a smooth function have no error left.
fn of_an_ellipse(ratio: f64) -> f64 {
    let steps = 2000;
    let at = |i: usize| (PI * i as f64 / steps as f64).sin_cos();
    let sum: f64 = (0..steps).map(at).map(|(sin, cos)| sin.hypot(ratio * cos)).sum();
    0.5 * PI * sum / steps as f64
}

/// The width of the ellipse, which the source leaves out.
fn across(context: &mut CaseContext) -> Result<(), CaseError> {
    let exact = exact(of_an_ellipse);
    let mut rows = Vec::new();
    for points in [1, 2, 3, 9] {
        let (ours, coarse) = (braking(405, points)?, braking(15, points)?);
        let miss = |moment: f64| format!("{:.3}", 100.0 * (moment / exact - 1.0));
        rows.push(vec![points.to_string(), format!("{:.5}", 1e3 * ours), miss(ours), miss(coarse)]);
        if points == 1 {
            continue;
        }
        context.check(
            Check::new(
                &format!("spin_moment_{points}_across"),
                &format!("moment on a ball that spins on both contacts, 405 slices, {points} points across each"),
                "mN·m",
                1e3 * ours,
            )
            .closed_form(1e3 * exact, "3κWa/8 E(e) of both contacts, E by quadrature")
            .relative(4e-3 / (points * points) as f64, "where slip changes sign, the error of Gauss's rule falls with the square of the points: a fifth of the 2 % of one point, over that square"),
        );
    }
    context.table(
        "across",
        "Pure spin: points across each slice",
        &["points", "moment, mN·m, 405 slices", "error, %", "error of 15 slices, %"],
        rows,
    );
    Ok(())
}

/// What n equal slices of a contact in pure spin miss, relative: the middle slice turns round, the
/// others have their load's centre farther in than their middle.
fn discretisation(slices: usize) -> f64 {
    2.0 / (3.0 * (slices * slices) as f64)
}

/// Moment (N·m) that brakes a ball which spins about its contact normals at 40 rad/s.
fn braking(slices: usize, points_across: usize) -> Result<f64, CaseError> {
    let mut problem = motion::moving(&deep_groove(-2.0 * OVERLAP), 0.1, [0.0; 5], 0.0)?;
    problem.traction = TractionLaw::Constant { coefficient: FRICTION, regularisation_speed: 1e-9 };
    problem.slices = slices;
    problem.points_across = points_across;
    let layout = Layout::new(problem.geometry.ball_count, false);
    let mut state = start::nominal(&problem.assembly());
    let (sin, cos) = problem.ball_phase.sin_cos();
    let mut ball = layout.ball_state(&state, 0);
    ball.spin = [0.0, 40.0 * cos, 40.0 * sin];
    layout.set_ball(&mut state, 0, &ball);
    let inertia = problem.ball.axial;
    let mut system = System::new(problem, Kernel::Simd);
    let mut rates = vec![0.0; state.len()];
    system.evaluate(0.0, &state, &mut rates);
    let [_, y, z] = layout.ball_vector(&rates, SPIN, 0);
    Ok(-inertia * (y * cos + z * sin))
}

pub(super) fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    across(context)?;
    let exact = exact(|_| 1.0);
    let counts = [5_usize, 15, 45, 135, 405];
    let mut errors = Vec::new();
    for slices in counts {
        errors.push((braking(slices, 1)? / exact - 1.0).abs());
    }
    context.check(
        Check::new(
            "spin_moment",
            "moment on a ball that spins on both contacts, 405 slices",
            "mN·m",
            1e3 * braking(405, 1)?,
        )
        .closed_form(
            1e3 * exact,
            "3κWa/8 of both contacts, load and ellipse by the oracle's Hertz fit",
        )
        .relative(1e-5, "2/(3n²) at 405 slices is 4e-6"),
    );
    context.check(
        Check::new(
            "spin_moment_15",
            "moment on a ball that spins on both contacts, 15 slices",
            "mN·m",
            1e3 * braking(15, 1)?,
        )
        .closed_form(
            1e3 * exact * (1.0 - discretisation(15)),
            "3κWa/8 less 2/(3n²): slices that know their load exactly and their slip in the middle",
        )
        .relative(2e-5, "the next order in 1/n, 1/(15)⁴"),
    );
    for (i, pair) in errors.windows(2).enumerate().skip(1) {
        context.check(
            Check::new(
                &format!("slice_order_{i}"),
                &format!("order in the number of slices, {} to {}", counts[i], counts[i + 1]),
                "1",
                (pair[0] / pair[1]).ln() / 3_f64.ln(),
            )
            .closed_form(2.0, "midpoints of equal slices, slip changes sign in the middle of one")
            .absolute(0.01, "the next order, 1/(15)² of the first ratio"),
        );
    }
    let points = counts.iter().zip(&errors).map(|(count, error)| [*count as f64, *error]).collect();
    let svg = xy(&XyPlot {
        title: "Pure spin: error of the braking moment".into(),
        x: Axis::log("slices across the ellipse", "1"),
        y: Axis::log("error over 3κWa/8", "1"),
        style: Style::LinesAndMarkers,
        curves: vec![
            Curve::separate("constant friction, both contacts", points),
            Curve::new(
                "2/(3n²)",
                counts.map(|count| [count as f64, discretisation(count)]).to_vec(),
            ),
        ],
    })?;
    context.figure(
        "slices",
        svg,
        "Second order. Pure spin is the worst case: the slip turns round inside a slice.",
    );
    Ok(())
}
