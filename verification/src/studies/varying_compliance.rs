//! The isolated bearing of 4.3.1 at 1000 rpm under 1500 N: the first 10 ms, half a ball pitch.
//!
//! Each method's reference is a converged run of another one.

use std::f64::consts::FRAC_PI_2;

use bearing_dynamics::assembly::loads::{Drive, DynamicProblem};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::equilibrium::statics::Condition;
use bearing_dynamics::motion::simulation::Integrator::{DormandPrince, Rosenbrock};
use bearing_dynamics::numeric::profile::Profile;

use super::motion::sentences;
use super::motion::{LABELS, Measures, Method, Window, errors, follow, limit};
use super::motion_sweeps::{sweep_hertz, sweep_methods, sweep_rk4, sweep_slices};
use crate::bearings::{self, DEEP_GROOVE, Hertz};
use crate::case::CaseError;
use crate::motion::{RPM, moving};
use crate::pareto::{ParetoContext, Study};

const MEASURES: Measures = &[1, 0, 3];
const STUDY: Study = Study {
    id: "",
    title: "",
    error_label: LABELS[1],
    more_errors: &[LABELS[0], LABELS[3]],
    run: |_| Ok(()),
};

pub const STEP: Study = Study {
    id: "varying_compliance_step",
    title: "Varying compliance (4.3.1): step of Runge–Kutta",
    run: step,
    ..STUDY
};

pub const INTEGRATOR: Study = Study {
    id: "varying_compliance_integrator",
    title: "Varying compliance (4.3.1): integrators, default friction",
    run: integrator,
    ..STUDY
};

/// The race hardly notices the slices; the balls do.
const SLICES_MEASURES: Measures = &[3, 1, 0];

pub const SLICES: Study = Study {
    id: "varying_compliance_slices",
    title: "Varying compliance (4.3.1): slices across the contact, default friction",
    error_label: LABELS[3],
    more_errors: &[LABELS[1], LABELS[0]],
    run: slices,
};

pub const HERTZ: Study = Study {
    id: "varying_compliance_hertz",
    title: "Varying compliance (4.3.1): Hertz options, default friction",
    run: hertz,
    ..STUDY
};

const WINDOW: Window = Window { end: 10e-3, rows: 50 };
/// Slices need no long window, and a hundred of them are slow.
const SHORT: Window = Window { end: 2e-3, rows: 20 };

const GENTLE: TractionLaw = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 };
const DEFAULT: TractionLaw =
    TractionLaw::SlideToRoll { curve: ExponentialCurve::BOUNDARY, entrainment_floor: 0.5 };

/// As the case `varying_compliance_dynamics`: a ball starts at the bottom, tilts are held.
fn problem(traction: TractionLaw) -> Result<DynamicProblem, CaseError> {
    let loads = [0.0, 0.0, -1500.0, 0.0, 0.0];
    let mut problem = moving(&DEEP_GROOVE, -FRAC_PI_2, loads, 1000.0 * RPM)?;
    for tilt in [3, 4] {
        problem.inner.drives[tilt] = Drive::Motion(Profile::ZERO);
    }
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    problem.traction = traction;
    Ok(problem)
}

fn step(context: &mut ParetoContext) -> Result<(), CaseError> {
    context.keep_series_apart();
    let laws = [
        ("no friction", TractionLaw::None),
        ("regularised Coulomb", GENTLE),
        ("default friction", DEFAULT),
    ];
    for (series, law) in laws {
        let problem = problem(law)?;
        let reference = follow(&problem, Method::rosenbrock(0.1e-6), WINDOW)?;
        let fractions = [0.25, 0.5, 0.75, 0.95, 1.06, 1.3];
        let limit = sweep_rk4(context, series, &problem, &fractions, WINDOW, &reference, MEASURES)?;
        let subject =
            format!("With {series}, where steps above {:.3} µs are unstable, the", 1e6 * limit);
        sentences(context, MEASURES, &subject, |point| point.series == series);
    }
    context.sentence("Reference: the linearly implicit integrator with steps of 0.1 µs.");
    Ok(())
}

fn integrator(context: &mut ParetoContext) -> Result<(), CaseError> {
    let problem = problem(DEFAULT)?;
    let fine = WINDOW.fitting(0.5 * limit(&problem, WINDOW)?);
    let by_rk4 = follow(&problem, Method::rk4(fine), WINDOW)?;
    let by_rosenbrock = follow(&problem, Method::rosenbrock(0.1e-6), WINDOW)?;
    sweep_rk4(context, "rk4", &problem, &[0.5, 0.95, 1.06, 1.3], WINDOW, &by_rosenbrock, MEASURES)?;
    let fixed = [0.5e-6, 1e-6, 2e-6, 5e-6, 10e-6, 20e-6, 50e-6].map(Method::rosenbrock);
    let accuracies = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
    let controlled = accuracies.map(|accuracy| Method::accurate(Rosenbrock, accuracy));
    let explicit = accuracies.map(|accuracy| Method::accurate(DormandPrince, accuracy));
    let series = [
        ("rosenbrock, fixed step", &fixed[..], &by_rk4),
        ("rosenbrock, error control", &controlled[..], &by_rk4),
        ("dormand-prince, error control", &explicit[..], &by_rosenbrock),
    ];
    sweep_methods(context, &problem, &series, WINDOW, MEASURES)?;
    sentences(context, MEASURES, "The", |_| true);
    let [displacement, swing, ..] = errors(&by_rosenbrock, &by_rk4);
    context.sentence(format!(
        "References: rosenbrock at 0.1 µs for the explicit methods, rk4 at half its limit for rosenbrock; they \
         differ by {swing:.1e} of the swing and {displacement:.1e} of the displacement."
    ));
    Ok(())
}

fn slices(context: &mut ParetoContext) -> Result<(), CaseError> {
    let sliced = |slices| problem(DEFAULT).map(|problem| DynamicProblem { slices, ..problem });
    sweep_slices(context, sliced, SHORT, SLICES_MEASURES)?;
    context.sentence("Reference: 151 slices by rk4 at half its limit. A window of 2 ms.");
    Ok(())
}

fn hertz(context: &mut ParetoContext) -> Result<(), CaseError> {
    let with = |model: Hertz| -> Result<DynamicProblem, CaseError> {
        let conditions = [Condition::Load(0.0); 5];
        let still = bearings::problem(&DEEP_GROOVE, model, -FRAC_PI_2, conditions)?;
        let (inner_contact, outer_contact) = (still.inner_contact, still.outer_contact);
        Ok(DynamicProblem { inner_contact, outer_contact, ..problem(DEFAULT)? })
    };
    let exact = Method::accurate(DormandPrince, 1e-5);
    sweep_hertz(context, with, exact, WINDOW, MEASURES)?;
    context
        .sentence("Steps of rosenbrock; reference: the exact contact by dormand-prince at 1e-5.");
    Ok(())
}
