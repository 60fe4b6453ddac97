//! Random bearings, loads and tilts against a solver that shares nothing with the program.

use bearing_dynamics::equilibrium::statics::solve;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;

mod samples;
pub use samples::{Disagreement, Sample, disagreement};

pub const CASE: Case = Case {
    id: "statics_independent",
    title: "Statics of 200 random bearings against an independent solver",
    section: "2.2.1, 4.2.1, (2.1), (2.16)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const SAMPLES: u64 = 200;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut worst = Disagreement::default();
    let mut iterations = 0;
    let mut evaluations = 0;
    let mut solved = 0;
    let mut without_equilibrium = 0;
    let mut seed = 0;
    while solved < SAMPLES {
        seed += 1;
        let sample = Sample::seeded(seed);
        let problem = sample.problem()?;
        // Some random loads pull an angular-contact bearing apart: both sides then say so.
        let Ok(solution) = solve(&problem) else {
            without_equilibrium += 1;
            if without_equilibrium > SAMPLES {
                return Err(CaseError::message(
                    "more than half of the samples have no equilibrium",
                ));
            }
            continue;
        };
        solved += 1;
        iterations += solution.iterations;
        evaluations += solution.contact_evaluations;
        worst = worst.max(disagreement(&sample, &solution));
    }
    let origin = "energy minimised over all coordinates at once, automatic differentiation";
    let quantities = [
        ("ball_loads", "ball load, over the largest force", worst.ball_loads),
        ("loads_at_ours", "load at our position, over the largest force", worst.loads_at_ours),
        ("unbalanced", "unbalanced load at our position, over the largest force", worst.unbalanced),
        ("position", "position, over the largest overlap", worst.position),
    ];
    for (id, quantity, worst) in quantities {
        let tolerance = if id == "position" { 2e-9 } else { 1e-10 };
        let reason = if id == "position" {
            "the softest directions (swivel of a few balls) are 1e-2 to 1e-3 as stiff as a contact, so that 1e-11 of \
             load is up to 1e-8 of overlap; these 200 come to 2e-10"
        } else {
            "a 1 µm overlap at a 30 mm radius is known to 1e-11, where statics stops; ten times that"
        };
        context.check(
            Check::new(id, &format!("largest difference in {quantity}, 200 bearings"), "1", worst)
                .independent(0.0, origin)
                .absolute(tolerance, reason),
        );
    }
    context.work("Newton iterations, 200 cold starts", iterations as u64);
    context.work("ball–race evaluations, 200 cold starts", evaluations as u64);
    context.work("samples without equilibrium", without_equilibrium);
    Ok(())
}
