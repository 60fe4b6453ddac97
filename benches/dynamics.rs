//! exploring
#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/common/dynamics.rs"]
mod dynamics;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::solver::dynamics::contacts::Driver;
use bearing_dynamics::solver::dynamics::model::DynamicProblem;
use bearing_dynamics::solver::dynamics::run::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::solver::dynamics::stability::step_limit;
use dynamics::{RPM, bearing, cage, inner_state};
use std::time::Instant;

fn problem(with_cage: bool) -> DynamicProblem {
    let geometry = common::table_4_1(-5e-6);
    let mut p = bearing(geometry, [0.0, 0.0, -1500.0, 0.0, 0.0], 1000.0 * RPM);
    p.traction = TractionLaw::SlideToRoll { curve: ExponentialCurve::BOUNDARY, entrainment_floor: 0.01 };
    if with_cage {
        p.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
        p.gravity = dynamics::GRAVITY;
    }
    p
}
fn simulate(p: &DynamicProblem, integrator: Integrator, stepping: Stepping, end: f64, rows: usize) -> (Vec<[f64; 3]>, f64, Simulation) {
    let options = RunOptions { start: Start::Equilibrium, integrator, stepping, driver: Driver::Lanes, energy_limit: 0.5 };
    let mut s = Simulation::new(p.clone(), options).unwrap();
    let mut out = vec![];
    let t0 = Instant::now();
    for r in 1..=rows {
        let target = end * r as f64 / rows as f64;
        loop {
            let left = target - s.time;
            let h = s.step_size;
            let step = if left <= h * (1.0 + 1e-6) { left } else if left < 2.0 * h { 0.5 * left } else { h };
            let taken = s.step_by(step).unwrap();
            if taken == left { s.time = target; break; }
        }
        out.push(inner_state(&s).position);
    }
    (out, t0.elapsed().as_secs_f64(), s)
}
fn error(a: &[[f64; 3]], b: &[[f64; 3]]) -> (f64, f64, f64) {
    let (mut e, mut ptp, mut disp) = (0.0f64, 0.0f64, 0.0f64);
    for i in 0..3 {
        let lo = b.iter().map(|x| x[i]).fold(f64::INFINITY, f64::min);
        let hi = b.iter().map(|x| x[i]).fold(-f64::INFINITY, f64::max);
        ptp = ptp.max(hi - lo);
        disp = disp.max(lo.abs().max(hi.abs()));
        for (x, y) in a.iter().zip(b) { e = e.max((x[i] - y[i]).abs()); }
    }
    (e, ptp, disp)
}
fn diagnose(p: &DynamicProblem) {
    let end = 0.02;
    let rows = 1000;
    let (reference, _, _) = simulate(p, Integrator::Rosenbrock, Stepping::Fixed(0.5e-6), end, rows);
    for i in 0..3 {
        let x: Vec<f64> = reference.iter().map(|r| r[i]).collect();
        println!("axis {i}: {:?}", x.iter().step_by(100).map(|v| format!("{:.4e}", v)).collect::<Vec<_>>());
    }
    for h in [5e-6, 10e-6, 20e-6] {
        let (a, _, _) = simulate(p, Integrator::Rosenbrock, Stepping::Fixed(h), end, rows);
        for i in 0..3 {
            let d: Vec<f64> = a.iter().zip(&reference).map(|(x, y)| x[i] - y[i]).collect();
            let wins: Vec<String> = d.chunks(200).map(|c| format!("{:.1e}", c.iter().fold(0.0f64, |m, v| m.max(v.abs())))).collect();
            let smooth: Vec<String> = d.chunks(200).map(|c| { let mean: Vec<f64> = c.windows(40).map(|w| w.iter().sum::<f64>() / 40.0).collect(); format!("{:.1e}", mean.iter().fold(0.0f64, |m, v| m.max(v.abs()))) }).collect();
            println!("h {h:.0e} axis {i} max by window {wins:?} smoothed {smooth:?}");
        }
    }
}
fn main() {
    if std::env::var("DIAG").is_ok() {
        let mut p = problem(false);
        diagnose(&p);
        p.damping = bearing_dynamics::ch2_housing::bearing::contact::ContactDamping::HuntCrossley { alpha: 0.2 };
        diagnose(&p);
        return;
    }
    let args: Vec<String> = std::env::args().collect();
    let num = |i: usize, d: f64| args.get(i).and_then(|a| a.parse().ok()).unwrap_or(d);
    let with_cage = num(1, 0.0) > 0.0;
    let end = num(2, 0.02);
    let p = problem(with_cage);
    {
        let options = RunOptions::default();
        let s = Simulation::new(p.clone(), options).unwrap();
        let mut sys = s.system;
        println!("limit {:?}", step_limit(&mut sys, 0.0, &s.state).map(|l| (l.step, l.eigenvalue)));
    }
    let rows = 100;
    let (reference, secs, s) = simulate(&p, Integrator::Rosenbrock, Stepping::Fixed(num(3, 0.5e-6)), end, rows);
    println!("reference {secs:.2} s, {:.2} us/step", secs / s.steps as f64 * 1e6);
    if num(4, 0.0) > 0.0 {
        let (a, secs, s) = simulate(&p, Integrator::RungeKutta, Stepping::Fixed(num(4, 0.15e-6)), end, rows);
        let (e, ptp, disp) = error(&a, &reference);
        println!("rk4 {secs:.2} s {:.2} us/step e {e:.2e} /ptp {:.2e} /disp {:.2e}", secs / s.steps as f64 * 1e6, e / ptp, e / disp);
    }
    for h in [1e-6, 2e-6, 4e-6, 8e-6, 12e-6, 16e-6, 24e-6, 32e-6] {
        let (a, secs, mut s) = simulate(&p, Integrator::Rosenbrock, Stepping::Fixed(h), end, rows);
        let (e, ptp, disp) = error(&a, &reference);
        let snap = s.snapshot();
        println!("h {h:.1e} {:.2} us/step {:.2} wall/sim e {e:.2e} ptp {ptp:.2e} disp {disp:.2e} /ptp {:.2e} /disp {:.2e} residual {:?}", secs / s.steps as f64 * 1e6, secs / end, e / ptp, e / disp, snap.map(|s| (s.residual, s.energy.contact, s.ledger)).ok());
    }
    for acc in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        let (a, secs, s) = simulate(&p, Integrator::Rosenbrock, Stepping::Accuracy(acc), end, rows);
        let (e, ptp, disp) = error(&a, &reference);
        println!("acc {acc:.0e} {} steps {} rejected {:.2} us/step {:.2} wall/sim e {e:.2e} /ptp {:.2e} /disp {:.2e} e/X/acc {:.2e} {:?}", s.steps, s.system.work.rejected_steps, secs / s.steps as f64 * 1e6, secs / end, e / ptp, e / disp, e / acc / s.control.as_ref().unwrap().memory.displacement, s.control.as_ref().unwrap().memory);
    }
}
