//! Eigenvalues over speed and unbalance response of a rotor against ROSS.

use std::process::Command;

use crate::single_shaft::{SingleShaft, Support, Unbalance, orbit, response};
use bearing_dynamics::members::beam::{Beam, BeamDisc, BeamSegment};
use bearing_dynamics::vibrations::rotor::RotorModel;
use nalgebra::Matrix4;
use serde::Deserialize;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;

pub const CASE: Case = Case {
    id: "ross_comparison",
    title: "A rotor on two bearings against ROSS",
    section: "4.2.2",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

mod run_up;
use run_up::{RunUp, compare};

const SCRIPT: &str = include_str!("rotor.py");
const KEPT: &str = include_str!("kept.json");
const ROSS: &str = "ROSS 2.3.0, elements of 10 mm";

#[derive(Debug, Deserialize)]
struct Kept {
    version: String,
    /// rad/s.
    speeds: Vec<f64>,
    /// Real and imaginary parts at each speed, by ascending imaginary part.
    eigenvalues: Vec<Vec<[f64; 2]>>,
    response: Vec<Response>,
    run_up: RunUp,
}

/// Amplitudes (m) along both lateral axes at all speeds above 0.
#[derive(Debug, Deserialize)]
struct Response {
    at: f64,
    first: Vec<f64>,
    second: Vec<f64>,
}

/// As in `rotor.py`.
fn model() -> Result<RotorModel, CaseError> {
    let segments = [(0.05, 0.03, 0.0), (0.2, 0.04, 0.01), (0.15, 0.035, 0.01), (0.1, 0.025, 0.0)];
    let segments = segments.map(|(length, outer_diameter, inner_diameter)| BeamSegment {
        length,
        outer_diameter,
        inner_diameter,
        density: 7850.0,
        youngs_modulus: 210e9,
        poisson_ratio: 0.3,
    });
    let mut beam = Beam::new(segments.to_vec());
    let discs = [(0.25, 8.0, 0.05, 0.03), (0.5, 3.0, 0.02, 0.011)];
    let discs = discs.map(|(at, mass, axial, transverse)| BeamDisc { at, mass, axial, transverse });
    beam.discs = discs.to_vec();
    let mut rotor = SingleShaft::new(beam);
    let bearings = [(0.05, [4e7, 7e7], [500.0, 800.0]), (0.4, [6e7, 9e7], [700.0, 700.0])];
    let supports = bearings.map(|(at, [ky, kz], [cy, cz])| Support {
        at,
        stiffness: Matrix4::from_diagonal(&[ky, kz, 0.0, 0.0].into()),
        damping: Matrix4::from_diagonal(&[cy, cz, 0.0, 0.0].into()),
    });
    rotor.supports = supports.to_vec();
    Ok(rotor.model()?)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let kept: Kept = serde_json::from_str(KEPT)?;
    rerun(context, &kept)?;
    let model = model()?;
    let (mut rows, mut worst) = (Vec::new(), [0.0f64; 2]);
    for (&speed, theirs) in kept.speeds.iter().zip(&kept.eigenvalues) {
        let ours = model.whirls(speed, theirs.len())?;
        if ours.len() != theirs.len() {
            return Err(CaseError::message(format!("{} modes at {speed} rad/s", ours.len())));
        }
        let mut own = 0.0f64;
        for (ours, &[re, im]) in ours.iter().zip(theirs) {
            let error = (ours.frequency() / im - 1.0).abs();
            own = if error.is_nan() { error } else { own.max(error) };
            worst[1] = worst[1].max((ours.damping_ratio() + re / re.hypot(im)).abs());
        }
        worst[0] = worst[0].max(own);
        rows.push(vec![format!("{speed}"), format!("{own:.1e}")]);
    }
    context.table(
        "lines",
        "Largest difference of eight damped frequencies",
        &["speed, rad/s", "relative"],
        rows,
    );
    context.check(
        Check::new(
            "frequencies",
            "largest relative difference of damped frequencies, ten speeds",
            "1",
            worst[0],
        )
        .independent(0.0, ROSS)
        .absolute(1e-3, "discretization error of its two-node elements, of second order in shear"),
    );
    context.check(
        Check::new(
            "damping_ratios",
            "largest difference of damping ratios, ten speeds",
            "1",
            worst[1],
        )
        .independent(0.0, ROSS)
        .absolute(1e-5, "0.1 % of the largest ratio, 0.01"),
    );
    compare_response(context, &kept, &model)?;
    compare(context, &kept.run_up)
}

fn compare_response(
    context: &mut CaseContext,
    kept: &Kept,
    model: &RotorModel,
) -> Result<(), CaseError> {
    let unbalance = Unbalance { at: 0.25, moment: 1e-3, angle: 0.0 };
    for place in &kept.response {
        let missing = || CaseError::message(format!("no station at {} m", place.at));
        let station = model.station(place.at).ok_or_else(missing)?;
        let largest = place.first.iter().chain(&place.second).copied().fold(0.0, f64::max);
        let mut worst = 0.0f64;
        for (n, &speed) in kept.speeds.iter().skip(1).enumerate() {
            let response = response(model, &[unbalance], speed);
            let response = response.ok_or_else(|| CaseError::message("undamped resonance"))?;
            let orbit = orbit(model, &response, station);
            for (ours, theirs) in
                [(orbit.y.norm(), place.first[n]), (orbit.z.norm(), place.second[n])]
            {
                let error = (ours - theirs).abs() / largest;
                worst = if error.is_nan() { error } else { worst.max(error) };
            }
        }
        let id = format!("response_{:.0}", place.at * 1e3);
        let what = format!(
            "unbalance response at {} mm: largest difference over its largest value",
            place.at * 1e3
        );
        context.check(Check::new(&id, &what, "1", worst).independent(0.0, ROSS).absolute(
            5e-3,
            "critical speeds differ by 0.01 %, and the response is steep near them",
        ));
    }
    Ok(())
}

/// Compares a new run of ROSS with the kept output where `ROSS_PYTHON` names a Python that has it.
fn rerun(context: &mut CaseContext, kept: &Kept) -> Result<(), CaseError> {
    let Some(python) = std::env::var_os("ROSS_PYTHON") else {
        let text = format!(
            "ROSS_PYTHON is not set: compared with the kept output of ROSS {} only.",
            kept.version
        );
        context.finding("ross", text);
        return Ok(());
    };
    let output = Command::new(python).args(["-c", SCRIPT, "-"]).output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let Some(line) = text.lines().last().filter(|_| output.status.success()) else {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(CaseError::message(format!("ROSS ended with {}: {said}", output.status)));
    };
    let now: Kept = serde_json::from_str(line)?;
    let all = |of: &Kept| -> Vec<f64> {
        let values = of.eigenvalues.iter().flatten().map(|[_, im]| *im);
        let response = of.response.iter().flat_map(|place| place.first.iter().chain(&place.second));
        values.chain(response.copied()).collect()
    };
    let (now_values, kept_values) = (all(&now), all(kept));
    let alike = now_values.len() == kept_values.len()
        && now_values.iter().zip(&kept_values).all(|(a, b)| (a / b - 1.0).abs() <= 1e-9)
        && now.run_up.is_like(&kept.run_up);
    if !alike {
        return Err(CaseError::message(
            "a new run of ROSS differs from the kept output by more than 1e-9",
        ));
    }
    let text = format!(
        "A new run of ROSS {} gives the kept output of {} to 1e-9.",
        now.version, kept.version
    );
    context.finding("ross", text);
    Ok(())
}
