//! A static solution that looks like one: radial load downwards, three balls in contact.
//! It obeys no equation; the output does not care.

use bearing_dynamics::equilibrium::statics::{
    BallState, ContactState, Determinacy, StaticSolution,
};
use bearing_dynamics::output::results::{RunRecord, quantity};
use bearing_dynamics::plan::{Item, Stage, Subject};
use nalgebra::{SMatrix, SVector, Vector3};
use serde_json::json;
use std::f64::consts::TAU;

pub fn contact(azimuth: f64, load: f64, outward: f64) -> ContactState {
    let normal = Vector3::new(0.02, azimuth.cos(), azimuth.sin()) * outward;
    let half = load.cbrt();
    ContactState {
        normal_load: load,
        approach: if load > 0.0 { 1.3e-7 * half * half } else { -2.1e-6 - 1e-7 * azimuth },
        contact_angle: 0.013 + 1e-3 * azimuth,
        semi_major: 7.1e-5 * half + 1e-9,
        semi_minor: 8.3e-6 * half + 1e-9,
        peak_pressure: 2.4e8 * half + 1.0,
        force_on_race: normal * load + Vector3::new(1e-3, 2e-3, 3e-3),
    }
}

pub fn solution() -> StaticSolution {
    let balls = (0..8)
        .map(|index| {
            let azimuth = 0.1 + TAU * index as f64 / 8.0;
            let load = 700.0 * (-azimuth.sin() - 0.3).max(0.0).powf(1.5);
            BallState {
                azimuth,
                position: Vector3::new(1e-6, 0.0315 * azimuth.cos(), 0.0315 * azimuth.sin()),
                inner: contact(azimuth, load, -1.0),
                outer: contact(azimuth, load * 1.0001, 1.0),
                cage_force: 0.01 * load,
            }
        })
        .collect();
    let stiffness = SMatrix::<f64, 5, 5>::from_fn(|i, j| {
        let scale = |k: usize| if k < 3 { 1e4 } else { 30.0 };
        scale(i) * scale(j) * (1.0 / (1 + i + j) as f64)
    });
    StaticSolution {
        coordinates: SVector::from([1.2e-6, -3.4e-7, -8.9e-6, 1.1e-4, -2.2e-5]),
        loads: SVector::from([12.0, 0.5, -1500.0, 0.31, -0.02]),
        stiffness,
        force_on_inner: Vector3::new(-12.0, -0.5, 1500.0),
        moment_on_inner: Vector3::new(1e-3, -0.31, 0.02),
        force_on_outer: Vector3::new(12.0, 0.5, -1500.0),
        moment_on_outer: Vector3::new(-1e-3, 0.31, -0.02),
        balls,
        determinacy: Determinacy::Determinate,
        iterations: 6,
        saddles_left: 0,
        contact_evaluations: 112,
        ran: Default::default(),
        residual: 3.1e-10,
    }
}

pub fn run() -> RunRecord {
    let stiffness = quantity("stiffness", 8.3e9, "N/m^1.5").unwrap();
    RunRecord {
        scene: json!({
            "title": "deep-groove bearing",
            "bearing": { "balls": 8, "clearance": { "radial": { "value": -5e-6, "unit": "m" } } },
            "plots": ["load-zone"],
            "cage": null,
            "centrifugal": false,
        }),
        plan: vec![
            Item::does(Stage::BallEquilibrium, Subject::Bearing(0), "of 8 balls"),
            Item::skips(Stage::Pockets, Subject::Bearing(0), "not part of the scene"),
        ],
        ran: Default::default(),
        assumptions: vec![("ball_phase".into(), "0 deg: not stated".into())],
        threads: 1,
        seconds: vec![("read".into(), 1.5e-4), ("solve".into(), 7.3e-5)],
        sections: vec![("contacts".into(), json!({ "inner": { "stiffness": stiffness } }))],
    }
}
