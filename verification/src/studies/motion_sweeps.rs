//! Families of variants that the studies of the bearing in motion go through alike.

use bearing_dynamics::assembly::loads::DynamicProblem;
use bearing_dynamics::motion::simulation::Integrator::DormandPrince;

use super::motion::{History, Measures, Method, Variant, Window, limit, measure};
use super::motion::{best_errors, follow, from_first_to_last, sentences};
use crate::bearings::Hertz;
use crate::case::CaseError;
use crate::pareto::ParetoContext;

/// Runge–Kutta at fractions of its limit, below and beyond it, with the boundary marked.
pub fn sweep_rk4(
    context: &mut ParetoContext,
    series: &str,
    problem: &DynamicProblem,
    fractions: &[f64],
    window: Window,
    reference: &History,
    measures: Measures,
) -> Result<f64, CaseError> {
    let limit = limit(problem, window)?;
    let mut seconds_a_step = f64::INFINITY;
    for fraction in fractions {
        let step = window.fitting(fraction * limit);
        let method = Method::rk4(step);
        let name = format!("{}, {:.2} of the limit", method.variant(), step / limit);
        let variant = Variant { series, name, problem, method, limit: Some(limit) };
        let found = measure(context, &variant, window, reference, measures)?;
        if found.ended.is_none() {
            // The time of a run whose steps all are as long.
            seconds_a_step = seconds_a_step.min(found.seconds * step / window.end);
        }
    }
    let name = format!("{series}: limit of {:.3} µs", 1e6 * limit);
    context.boundary(&name, seconds_a_step * window.end / limit);
    Ok(limit)
}

/// One series after the other: its methods, and the reference that is not of their kind.
pub fn sweep_methods(
    context: &mut ParetoContext,
    problem: &DynamicProblem,
    series: &[(&str, &[Method], &History)],
    window: Window,
    measures: Measures,
) -> Result<(), CaseError> {
    for &(series, methods, reference) in series {
        for &method in methods {
            let name = method.variant();
            let variant = Variant { series, name, problem, method, limit: None };
            measure(context, &variant, window, reference, measures)?;
        }
    }
    Ok(())
}

/// Slices across the contact, against 151 of them by Runge–Kutta at half its limit.
pub fn sweep_slices(
    context: &mut ParetoContext,
    sliced: impl Fn(usize) -> Result<DynamicProblem, CaseError>,
    window: Window,
    measures: Measures,
) -> Result<(), CaseError> {
    let many = sliced(151)?;
    let fine = window.fitting(0.5 * limit(&many, window)?);
    let reference = follow(&many, Method::rk4(fine), window)?;
    for slices in [5, 7, 9, 11, 15, 21, 31, 45] {
        let variant = Variant {
            series: "dormand-prince, accuracy 1e-4",
            name: format!("{slices} slices"),
            problem: &sliced(slices)?,
            method: Method::accurate(DormandPrince, 1e-4),
            limit: None,
        };
        measure(context, &variant, window, &reference, measures)?;
    }
    sentences(context, measures, "The", |_| true);
    let spread = from_first_to_last(context.points());
    context.sentence(spread);
    Ok(())
}

/// The fit and the exact contact of Hertz in steps of rosenbrock, against the exact one by `method`.
pub fn sweep_hertz(
    context: &mut ParetoContext,
    with: impl Fn(Hertz) -> Result<DynamicProblem, CaseError>,
    method: Method,
    window: Window,
    measures: Measures,
) -> Result<(), CaseError> {
    let reference = follow(&with(Hertz::Exact)?, method, window)?;
    for (series, model) in [("hamrock-brewe", Hertz::Fit), ("exact", Hertz::Exact)] {
        for step in [1e-6, 5e-6, 20e-6] {
            let method = Method::rosenbrock(step);
            let name = method.variant();
            let variant = Variant { series, name, problem: &with(model)?, method, limit: None };
            measure(context, &variant, window, &reference, measures)?;
        }
    }
    sentences(context, measures, "The", |_| true);
    let off = best_errors(context.points(), measures, "hamrock-brewe");
    context.sentence(format!("Hamrock and Brewe's fit is off by {off}, at any step."));
    Ok(())
}
