//! The bearing of Tables 5.3 and 5.4 with its cage, as in 5.4.1, at 600 rpm: the first 10 ms. The cage
//! falls through its clearance and strikes the outer race at 6.4 ms.
//!
//! Each method's reference is a converged run of another one.

use bearing_dynamics::assembly::loads::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::CageForce;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::equilibrium::statics::Condition;
use bearing_dynamics::motion::simulation::Integrator::{DormandPrince, Rosenbrock};

use super::motion::sentences;
use super::motion::{LABELS, Measures, Method, Variant, Window, errors, follow, measure};
use super::motion_sweeps::{sweep_hertz, sweep_methods, sweep_rk4, sweep_slices};
use crate::bearings::{self, ANGULAR_CONTACT, Hertz};
use crate::cage_bearing::rolling;
use crate::case::CaseError;
use crate::motion::RPM;
use crate::pareto::{ParetoContext, Study};

const MEASURES: Measures = &[1, 0, 2];
const STUDY: Study = Study {
    id: "",
    title: "",
    error_label: LABELS[1],
    more_errors: &[LABELS[0], LABELS[2]],
    run: |_| Ok(()),
};

pub const STEP: Study = Study {
    id: "cage_bearing_step",
    title: "Cage bearing (Table 5.4): step of Runge–Kutta",
    run: step,
    ..STUDY
};

pub const INTEGRATOR: Study = Study {
    id: "cage_bearing_integrator",
    title: "Cage bearing (Table 5.4): integrators",
    run: integrator,
    ..STUDY
};

const SLICES_MEASURES: Measures = &[3, 1, 0];

pub const SLICES: Study = Study {
    id: "cage_bearing_slices",
    title: "Cage bearing (Table 5.4): slices across the contact",
    error_label: LABELS[3],
    more_errors: &[LABELS[1], LABELS[0]],
    run: slices,
};

pub const HERTZ: Study = Study {
    id: "cage_bearing_hertz",
    title: "Cage bearing (Table 5.4): Hertz options",
    run: hertz,
    ..STUDY
};

const CONTACT_MEASURES: Measures = &[2, 1, 0];

pub const CONTACT: Study = Study {
    id: "cage_bearing_contact",
    title: "Cage bearing (Table 5.4): contact of the cage",
    error_label: LABELS[2],
    more_errors: &[LABELS[1], LABELS[0]],
    run: contact,
};

const WINDOW: Window = Window { end: 10e-3, rows: 50 };
/// Before the cage strikes: balls and races alone.
const CALM: Window = Window { end: 5e-3, rows: 50 };

fn problem() -> Result<DynamicProblem, CaseError> {
    rolling(600.0 * RPM)
}

/// The reference of other methods: its error is that of the impact, about 1e-4 of the swing.
fn converged() -> Method {
    Method::accurate(DormandPrince, 1e-7)
}

fn step(context: &mut ParetoContext) -> Result<(), CaseError> {
    context.keep_series_apart();
    let scene = problem()?;
    let gentle = DynamicProblem {
        traction: TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 },
        ..scene.clone()
    };
    for (series, problem, fractions) in [
        ("regularised Coulomb", gentle, [0.005, 0.02, 0.1, 0.5, 0.95, 1.06, 1.3]),
        ("default friction", scene, [0.1, 0.2, 0.4, 0.7, 0.95, 1.06, 1.3]),
    ] {
        let reference = follow(&problem, converged(), WINDOW)?;
        let limit = sweep_rk4(context, series, &problem, &fractions, WINDOW, &reference, MEASURES)?;
        let subject =
            format!("With {series}, where steps above {:.3} µs are unstable, the", 1e6 * limit);
        sentences(context, MEASURES, &subject, |point| point.series == series);
    }
    context.sentence("Reference: dormand-prince at 1e-7.");
    Ok(())
}

fn integrator(context: &mut ParetoContext) -> Result<(), CaseError> {
    let problem = problem()?;
    let by_rk4 = follow(&problem, Method::rk4(WINDOW.fitting(0.05e-6)), WINDOW)?;
    let by_explicit = follow(&problem, converged(), WINDOW)?;
    let fractions = [0.1, 0.25, 0.5, 0.95, 1.06, 1.3];
    sweep_rk4(context, "rk4", &problem, &fractions, WINDOW, &by_explicit, MEASURES)?;
    let fixed = [0.2e-6, 0.5e-6, 1e-6, 2e-6, 5e-6, 10e-6, 20e-6].map(Method::rosenbrock);
    let accuracies = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
    let controlled = accuracies.map(|accuracy| Method::accurate(Rosenbrock, accuracy));
    let explicit = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
        .map(|accuracy| Method::accurate(DormandPrince, accuracy));
    let series = [
        ("rosenbrock, fixed step", &fixed[..], &by_explicit),
        ("rosenbrock, error control", &controlled[..], &by_explicit),
        ("dormand-prince, error control", &explicit[..], &by_rk4),
    ];
    sweep_methods(context, &problem, &series, WINDOW, MEASURES)?;
    sentences(context, MEASURES, "The", |_| true);
    let [displacement, swing, ..] = errors(&by_explicit, &by_rk4);
    context.sentence(format!(
        "References: dormand-prince at 1e-7, and rk4 at 0.05 µs for dormand-prince; they differ by {swing:.1e} of the \
         swing and {displacement:.1e} of the displacement."
    ));
    Ok(())
}

fn slices(context: &mut ParetoContext) -> Result<(), CaseError> {
    let sliced = |slices| problem().map(|problem| DynamicProblem { slices, ..problem });
    sweep_slices(context, sliced, CALM, SLICES_MEASURES)?;
    context.sentence(
        "Reference: 151 slices by rk4 at half its limit. The 5 ms before the cage strikes.",
    );
    Ok(())
}

fn hertz(context: &mut ParetoContext) -> Result<(), CaseError> {
    let with = |model: Hertz| -> Result<DynamicProblem, CaseError> {
        let conditions = [Condition::Load(0.0); 5];
        let still = bearings::problem(&ANGULAR_CONTACT, model, 0.0, conditions)?;
        let (inner_contact, outer_contact) = (still.inner_contact, still.outer_contact);
        Ok(DynamicProblem { inner_contact, outer_contact, ..problem()? })
    };
    sweep_hertz(context, with, converged(), CALM, MEASURES)?;
    context.sentence(
        "Steps of rosenbrock; reference: the exact contact by dormand-prince at 1e-7. The 5 ms before the cage \
         strikes.",
    );
    Ok(())
}

fn contact(context: &mut ParetoContext) -> Result<(), CaseError> {
    let with = |force: CageForce| -> Result<DynamicProblem, CaseError> {
        let mut problem = problem()?;
        if let Some(cage) = &mut problem.cage {
            cage.contacts.force = force;
        }
        Ok(problem)
    };
    let reference = follow(&problem()?, Method::rk4(WINDOW.fitting(0.1e-6)), WINDOW)?;
    let penalty = [1e7, 5e7, 1e8, 2e8, 4e8, 1e9, 4e9]
        .map(|stiffness| (format!("{stiffness:.0e} N/m"), CageForce::Penalty { stiffness }));
    let hertz = [1e9, 1e10, 3e10, 1e11]
        .map(|stiffness| (format!("{stiffness:.0e} N/m^1.5"), CageForce::Hertz { stiffness }));
    let (implicit, explicit) =
        (Method::accurate(Rosenbrock, 1e-3), Method::accurate(DormandPrince, 1e-6));
    for (series, laws, method) in [
        ("penalty, rosenbrock 1e-3", &penalty[..], implicit),
        ("hertz, rosenbrock 1e-3", &hertz, implicit),
        ("penalty, dormand-prince 1e-6", &penalty, explicit),
        ("hertz, dormand-prince 1e-6", &hertz, explicit),
    ] {
        for (name, force) in laws {
            let (name, problem) = (name.clone(), &with(*force)?);
            let variant = Variant { series, name, problem, method, limit: None };
            measure(context, &variant, WINDOW, &reference, CONTACT_MEASURES)?;
        }
    }
    sentences(context, CONTACT_MEASURES, "The", |_| true);
    context.sentence(
        "Reference: the source's own law (5.8), penalty of 2e8 N/m, by rk4 at 0.1 µs. The error of another law is its \
         difference from that one, impact by impact.",
    );
    Ok(())
}
