//! Explicit steps of a solid: what happens to its energy, how fast the error falls with the step,
//! where steps turn unstable, and what damping does.

use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::bar;
use bearing_dynamics::solids::energy::strain_energy;
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{DampedMotion, SolidModel, SolidProblem};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::solids::{STEEL, Vec3, free_body, largest, mesh_of, name_of};

mod oracle;

pub const CASE: Case = Case {
    id: "solid_energy_and_steps",
    title: "Explicit steps of a solid: energy, order, stability, damping",
    section: "2.2.2, (2.7)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const ORDERS: [Order; 2] = [Order::Linear, Order::Quadratic];
const METHODS: [(ExplicitMethod, &str); 2] =
    [(ExplicitMethod::CentralDifferences, "central"), (ExplicitMethod::RungeKutta, "rk4")];
/// m
const SIZE: Vec3 = [0.04, 0.02, 0.02];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for order in ORDERS {
        uniform_energy(context, order)?;
        drift(context, order)?;
        for (method, key) in METHODS {
            observed_order(context, order, method, key)?;
            step_boundary(context, order, method, key)?;
            damping(context, order, method, key)?;
        }
    }
    Ok(())
}

fn small_bar(order: Order) -> Result<SolidProblem, CaseError> {
    Ok(free_body(&mesh_of(&bar(SIZE, [2, 1, 1])?, order)?, STEEL))
}

/// A smooth bending and stretching field, the largest component about `size`, m.
fn smooth(problem: &SolidProblem, size: f64) -> Vec<Vec3> {
    let field = |[x, y, z]: Vec3| {
        let s = std::f64::consts::TAU * x / SIZE[0];
        [
            size * (0.5 * s.cos() + 10.0 * y),
            size * s.cos(),
            size * (0.4 * (0.5 * s).cos() + 8.0 * z),
        ]
    };
    problem.nodes.iter().map(|x| field(*x)).collect()
}

fn still(problem: &SolidProblem) -> Vec<Vec3> {
    vec![[0.0; 3]; problem.nodes.len()]
}

fn uniform_energy(context: &mut CaseContext, order: Order) -> Result<(), CaseError> {
    const F: [Vec3; 3] = [[1.1, 0.05, -0.02], [0.03, 0.9, 0.04], [-0.06, 0.01, 1.05]];
    let problem = small_bar(order)?;
    let moved: Vec<_> = problem
        .nodes
        .iter()
        .map(|x| {
            let to = F.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
            [to[0] - x[0], to[1] - x[1], to[2] - x[2], 0.0]
        })
        .collect();
    let found = strain_energy(&SolidModel::new(problem)?, &moved);
    let exact =
        SIZE.iter().product::<f64>() * oracle::energy_density(F, STEEL.young, STEEL.poisson);
    let name = name_of(order);
    context.check(
        Check::new(
            &format!("uniform_{name}"),
            &format!("{name}: strain energy of a uniform large deformation"),
            "J",
            found,
        )
        .closed_form(exact, "volume times the energy by invariants of C")
        .relative(1e-13, "rounding; I₁ − 3 loses two digits"),
    );
    Ok(())
}

/// Energy over 100 000 steps, of all modes for central differences and of the slowest for
/// Runge–Kutta, which damps fast ones.
fn drift(context: &mut CaseContext, order: Order) -> Result<(), CaseError> {
    const STEPS: usize = 100_000;
    const WINDOW: usize = 10_000;
    let name = name_of(order);
    for (method, key, ratio, reason) in [
        (
            ExplicitMethod::CentralDifferences,
            "central",
            0.5,
            "asked for; the method keeps an energy near this one, so that only its wobble averaged over \
             10 000 steps is left",
        ),
        (
            ExplicitMethod::RungeKutta,
            "rk4",
            0.01,
            "asked for; a mode loses (ωh)⁶/72 of its energy a step, at this ratio 7e-12 for the fastest: \
             7e-7 over the run",
        ),
    ] {
        let problem = small_bar(order)?;
        // Strains of about 5e-5: the body is not quite linear.
        let (start, rest) = (smooth(&problem, 2e-7), still(&problem));
        let model = SolidModel::new(problem)?;
        let stepping = SolidStepping::FractionOfLimit(ratio);
        let mut solid = ExplicitSolid::new(model, method, stepping, start, rest)?;
        let mut means = [0.0; 2];
        let mut samples = [0.0; 2];
        for step in 0..STEPS {
            let window = if step < WINDOW {
                Some(0)
            } else if step >= STEPS - WINDOW {
                Some(1)
            } else {
                None
            };
            if let Some(window) = window.filter(|_| step % 3 == 0) {
                let energy = solid.energy();
                means[window] += energy.strain + energy.kinetic;
                samples[window] += 1.0;
            }
            solid.step(|_, _, _| {})?;
        }
        let drift = (means[1] / samples[1]) / (means[0] / samples[0]) - 1.0;
        context.check(
            Check::new(
                &format!("drift_{name}_{key}"),
                &format!(
                    "{name}, {key}: change of energy over 100 000 steps at {ratio} of the limit"
                ),
                "1",
                drift,
            )
            .closed_form(0.0, "no work, no damping")
            .absolute(1e-6, reason),
        );
    }
    Ok(())
}

/// A large motion (the body is not linear) to a fixed time with ever smaller steps, against the same
/// with far smaller ones.
fn observed_order(
    context: &mut CaseContext,
    order: Order,
    method: ExplicitMethod,
    key: &str,
) -> Result<(), CaseError> {
    let problem = small_bar(order)?;
    let velocity: Vec<Vec3> = smooth(&problem, 1.0).iter().map(|v| v.map(|x| 20.0 * x)).collect();
    let limit = ExplicitSolid::new(
        SolidModel::new(problem.clone())?,
        ExplicitMethod::CentralDifferences,
        SolidStepping::FractionOfLimit(0.5),
        still(&problem),
        velocity.clone(),
    )?
    .limit
    .step;
    let end = 20.0 * limit;
    let run = |method, steps: usize| -> Result<Vec<[f64; 4]>, CaseError> {
        let model = SolidModel::new(problem.clone())?;
        let stepping = SolidStepping::Fixed(end / steps as f64);
        let mut solid =
            ExplicitSolid::new(model, method, stepping, still(&problem), velocity.clone())?;
        for _ in 0..steps {
            solid.step(|_, _, _| {})?;
        }
        Ok(solid.displacement)
    };
    let exact = run(ExplicitMethod::RungeKutta, 10_240)?;
    let error = |steps| -> Result<f64, CaseError> {
        let found = run(method, steps)?;
        let gap: f64 =
            found.iter().flatten().zip(exact.iter().flatten()).map(|(a, b)| (a - b).powi(2)).sum();
        Ok(gap.sqrt())
    };
    let name = name_of(order);
    let (expected, steps) = match method {
        ExplicitMethod::CentralDifferences => (2.0, 160),
        ExplicitMethod::RungeKutta => (4.0, 640),
    };
    let (coarse, fine) = (error(steps)?, error(2 * steps)?);
    context.check(
        Check::new(
            &format!("order_{name}_{key}"),
            &format!("{name}, {key}: observed order, {steps} and twice as many steps"),
            "1",
            (coarse / fine).log2(),
        )
        .closed_form(expected, "order of the method")
        .absolute(0.1, "next term of the error, ωh ≤ 0.25 at the fastest mode")
        .golden(GoldenTolerance::MIXED),
    );
    Ok(())
}

/// The largest step that stays bounded, found by trial, against the predicted one.
fn step_boundary(
    context: &mut CaseContext,
    order: Order,
    method: ExplicitMethod,
    key: &str,
) -> Result<(), CaseError> {
    let problem = small_bar(order)?;
    // So small that the body is linear; every mode has a share.
    let mut seed = 1u64;
    let start: Vec<Vec3> = problem
        .nodes
        .iter()
        .map(|_| {
            [0; 3].map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(99);
                1e-13 * ((seed >> 40) as f64 / f64::from(1u32 << 24) - 0.5)
            })
        })
        .collect();
    let make = || -> Result<ExplicitSolid, CaseError> {
        let model = SolidModel::new(problem.clone())?;
        let stepping = SolidStepping::FractionOfLimit(1.0);
        Ok(ExplicitSolid::new(model, method, stepping, start.clone(), still(&problem))?)
    };
    let predicted = make()?.step_size;
    let grows = |ratio: f64| -> Result<bool, CaseError> {
        let mut solid = make()?;
        // Past the limit `new` would refuse it.
        solid.step_size = ratio * predicted;
        for _ in 0..2000 {
            if solid.step(|_, _, _| {}).is_err() {
                return Ok(true);
            }
        }
        let size = largest(solid.displacement.iter().flatten().map(|x| x.abs()));
        Ok(size.is_nan() || size > 1e-11)
    };
    let (mut low, mut high) = (0.5, 1.5);
    for _ in 0..9 {
        let middle = 0.5 * (low + high);
        if grows(middle)? { high = middle } else { low = middle }
    }
    let name = name_of(order);
    context.check(
        Check::new(
            &format!("boundary_{name}_{key}"),
            &format!("{name}, {key}: predicted largest step"),
            "s",
            predicted,
        )
        .consistency(
            0.5 * (low + high) * predicted,
            "predicted limit against our own trial steps, bisected until motion stays bounded",
        )
        .relative(0.01, "the bisection ends within 0.2 %, at 0.1 % below the limit")
        .golden(GoldenTolerance::MIXED),
    );
    Ok(())
}

/// Table 2.3's 77 1/s brake a body that drifts, by e^(−αt); relative to rigid motion not at all.
fn damping(
    context: &mut CaseContext,
    order: Order,
    method: ExplicitMethod,
    key: &str,
) -> Result<(), CaseError> {
    const DAMPING: f64 = 77.0;
    for (damped_motion, part, text, exact) in [
        (DampedMotion::Absolute, "absolute", "damping in space", 1.0),
        (DampedMotion::RelativeToRigid, "relative", "damping relative to rigid motion", 0.0),
    ] {
        let mut problem = small_bar(order)?;
        problem.damping = DAMPING;
        problem.damped_motion = damped_motion;
        let rest = still(&problem);
        let drift = vec![[3.0, -1.0, 2.0]; rest.len()];
        let stepping = SolidStepping::FractionOfLimit(0.5);
        let mut solid =
            ExplicitSolid::new(SolidModel::new(problem)?, method, stepping, rest, drift)?;
        for _ in 0..2000 {
            solid.step(|_, _, _| {})?;
        }
        let time = solid.time;
        let speed = solid.velocity()[0][0];
        let name = name_of(order);
        context.check(
            Check::new(
                &format!("damping_{part}_{name}_{key}"),
                &format!("{name}, {key}: {text}, ln(v₀/v) over αt"),
                "1",
                (3.0 / speed).ln() / (DAMPING * time),
            )
            .closed_form(exact, "a drifting body under a brake of αm times velocity")
            .absolute(
                if key == "central" && part == "absolute" { 5e-8 } else { 5e-11 },
                "central differences are off by (αh)²/12 and by the half step between velocity and time, 1e-8 here; else rounding \
                 of some thousand steps, 1e-11",
            ),
        );
    }
    Ok(())
}
