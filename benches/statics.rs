//! Time of one static solution: cold start, and warm from a neighbour in a sweep.

#[path = "../tests/common/mod.rs"]
mod common;

use bearing_dynamics::equilibrium::statics::{StaticOptions, solve, solve_from};
use bearing_dynamics::members::body::Condition;
use common::{FREE, problem, table_4_1};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn statics(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("statics, 8 balls, 5 free coordinates");
    for (name, clearance) in [("interference 5 um", -5e-6), ("clearance 5 um", 5e-6)] {
        let loads = [300.0, 100.0, -1500.0, 1.0, -2.0].map(Condition::Load);
        let task = problem(table_4_1(clearance), loads);
        group.bench_function(format!("cold, combined load, {name}"), |bencher| {
            bencher.iter(|| solve(black_box(&task)))
        });
        let mut neighbour = task.clone();
        neighbour.ball_phase += 0.01;
        let start = solve(&neighbour).expect("equilibrium").coordinates;
        group.bench_function(format!("warm, combined load, {name}"), |bencher| {
            bencher.iter(|| solve_from(black_box(&task), Some(&start), &StaticOptions::default()))
        });
    }
    let mut conditions = FREE;
    conditions[2] = Condition::Load(-1500.0);
    let saddle = problem(table_4_1(40e-6), conditions);
    group.bench_function("cold, radial load, 40 um clearance, leaves a saddle", |bencher| {
        bencher.iter(|| solve(black_box(&saddle)))
    });
    group.finish();
}

criterion_group!(benches, statics);
criterion_main!(benches);
