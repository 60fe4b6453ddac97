//! What a digit costs of a flexible solid: equilibrium, natural modes and explicit steps with
//! four- and ten-node elements, mesh by mesh, on a cantilever, a ring and the cage.
//!
//! A deflection comes from equilibrium. A natural frequency comes from Lanczos' modes with the
//! consistent mass, or from explicit steps with the lumped mass: the body starts undeformed with the
//! velocities of a beam's or thin ring's mode, and passes through rest again after half a period.
//! That motion holds other modes too, but weighted by the start each one counts by the square of
//! its share. Times are those from a mesh to the number; meshing is not counted.

pub mod cage;
pub mod cantilever;
pub mod ring;

use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::solver::solid::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solver::solid::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solver::solid::model::{SolidModel, SolidProblem};
use bearing_dynamics::solver::solid::modes::{ModeOptions, modes};

use crate::case::CaseError;
use crate::pareto::{ParetoContext, Point, Stopwatch, cheapest_ways};
use crate::solids::Vec3;

/// A variant is repeated until it has taken so many seconds, or so many times.
const PATIENCE: f64 = 0.4;
const MOST_REPEATS: usize = 5;

/// A number, and the times that a force was evaluated on the way.
type Counted = (f64, Option<u64>);

/// A number from a mesh, and what it took.
struct Timed {
    series: String,
    nodes: usize,
    value: f64,
    evaluations: Option<u64>,
    seconds: f64,
    repeats: usize,
}

/// Computes a number several times; the fastest counts.
fn timed(
    series: String,
    mesh: &TetMesh,
    mut compute: impl FnMut() -> Result<Counted, CaseError>,
) -> Result<Timed, CaseError> {
    let (mut seconds, mut spent, mut repeats) = (f64::INFINITY, 0.0, 0);
    let (value, evaluations) = loop {
        let watch = Stopwatch::start();
        let found = std::hint::black_box(compute()?);
        let taken = watch.seconds();
        (seconds, spent, repeats) = (seconds.min(taken), spent + taken, repeats + 1);
        if repeats == MOST_REPEATS || spent > PATIENCE {
            break found;
        }
    };
    Ok(Timed { series, nodes: mesh.nodes.len(), value, evaluations, seconds, repeats })
}

/// Records numbers; `errors` are made of each.
fn record(context: &mut ParetoContext, all: &[Timed], errors: impl Fn(f64) -> Vec<f64>) {
    for timed in all {
        let errors = errors(timed.value);
        let variant = format!("{} nodes", timed.nodes);
        context.push(Point {
            repeats: timed.repeats,
            evaluations: timed.evaluations,
            more_errors: errors[1..].to_vec(),
            ..Point::new(&timed.series, &variant, timed.seconds, errors[0])
        });
    }
}

fn off(value: f64, reference: f64) -> f64 {
    (value / reference - 1.0).abs()
}

/// What numbers on three meshes of a series tend to, each with cells half as large as the one before.
struct Limit {
    value: f64,
    /// Power of the cells' size with which the changes fall.
    order: f64,
    /// Error of the finest of the three.
    left: f64,
}

impl Limit {
    /// By Richardson: what each refinement changes falls by a constant factor. `meshes` counts those
    /// of the series.
    fn new(all: &[Timed], series: &str, meshes: [usize; 3]) -> Limit {
        let own: Vec<f64> = all.iter().filter(|t| t.series == series).map(|t| t.value).collect();
        let [coarse, middle, fine] = meshes.map(|n| own[n]);
        let factor = (middle - coarse) / (fine - middle);
        let value = fine + (fine - middle) / (factor - 1.0);
        Limit { value, order: factor.log2(), left: off(fine, value) }
    }

    fn sentence(&self, unit: &str) -> String {
        format!(
            "Reference: three meshes of tet10, each with cells half as large as the one before, continued to their limit \
             {:.6e} {unit} (observed order {:.1}; the finest of them is off by {:.1e}, by construction).",
            self.value, self.order, self.left
        )
    }
}

/// The sentences that every study ends with: the cheapest ways of all, and of each series that
/// does not come to 0.1 %, how far it comes and why.
fn conclude(context: &mut ParetoContext, whole: &str) {
    let ways = cheapest_ways(context.points(), 0, whole);
    context.sentence(format!("The {ways}"));
    let explicit: Vec<&Point> =
        context.points().iter().filter(|point| point.series.ends_with("steps")).collect();
    if !explicit.is_empty() {
        let ways = cheapest_ways(explicit, 0, whole);
        context.sentence(format!("Of explicit steps the {ways}"));
    }
    let mut names: Vec<String> = Vec::new();
    for point in context.points() {
        if !names.contains(&point.series) {
            names.push(point.series.clone());
        }
    }
    for name in names {
        let own: Vec<&Point> = context.points().iter().filter(|p| p.series == name).collect();
        if own.iter().any(|point| point.error <= 1e-3) {
            continue;
        }
        let text = falls_short(&own);
        context.sentence(text);
    }
}

/// Why meshes of a series do not come to 0.1 %, from the fall of the error over the last two of them.
fn falls_short(points: &[&Point]) -> String {
    let [.., before, last] = points else { return String::new() };
    let nodes = |point: &Point| -> f64 {
        point.variant.split(' ').next().and_then(|n| n.parse().ok()).unwrap_or(f64::NAN)
    };
    let order = (before.error / last.error).ln() / (nodes(last) / nodes(before)).ln();
    let far = format!(
        "{} does not come to 0.1 %: {:.2} % on {}, the finest mesh",
        last.series,
        100.0 * last.error,
        last.variant
    );
    if order.is_nan() || order < 0.1 {
        return format!("{far}, and its error hardly falls from one mesh to the next.");
    }
    let needed =
        |limit: f64| format!("{:.0e}", nodes(last) * (last.error / limit).powf(1.0 / order));
    let one = if last.error <= 1e-2 {
        String::new()
    } else {
        format!("{} nodes for 1 % and ", needed(1e-2))
    };
    format!(
        "{far}. Its error falls with the power {order:.2} of the nodes: at that rate it takes {one}{} nodes for 0.1 %.",
        needed(1e-3)
    )
}

/// Work of the loads over their displacements in equilibrium, J.
fn work_of_loads(model: &SolidModel, displacement: &[Vec3]) -> f64 {
    let forces = model.problem.loads.iter().flat_map(|load| &load.forces);
    forces
        .map(|(node, force)| {
            let u = displacement[*node as usize];
            force[0] * u[0] + force[1] * u[1] + force[2] * u[2]
        })
        .sum()
}

fn settle(model: &SolidModel) -> Result<Vec<Vec3>, CaseError> {
    Ok(equilibrium(model, 0.0, &EquilibriumOptions::default())?.displacement)
}

/// Mean of the elastic natural frequencies from the lowest on that belong together (one, or a pair),
/// Hz: `rigid` of the modes found before them are rigid motions.
fn frequency_by_modes(
    problem: &SolidProblem,
    rigid: usize,
    together: usize,
    shape: &[Vec3],
) -> Result<f64, CaseError> {
    let model = SolidModel::new(problem.clone())?;
    let found = modes(&model, &ModeOptions::new(rigid + together))?;
    let elastic = &found.modes[rigid..];
    // How much of the wanted shape these modes hold, by lumped mass.
    let product = |a: &[Vec3], b: &[Vec3]| -> f64 {
        let nodes = a.iter().zip(b).zip(&model.mass);
        nodes.map(|((a, b), mass)| mass * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2])).sum()
    };
    let whole = product(shape, shape);
    let share: f64 = elastic
        .iter()
        .map(|mode| product(&mode.shape, shape).powi(2) / product(&mode.shape, &mode.shape) / whole)
        .sum();
    let wanted = share > 0.5;
    if !wanted {
        return Err(CaseError::message("the lowest modes do not bend as the study means"));
    }
    Ok(elastic.iter().map(|mode| mode.frequency).sum::<f64>() / together as f64)
}

/// Part of the stability limit that explicit steps take.
const STEP: f64 = 0.9;
/// Largest velocity at the start over the largest entry of the shape, m/s: deflections of some
/// tenths of a micrometre stay linear.
const PUSH: f64 = 1e-3;

/// The frequency with which a body swings that starts with the velocities `shape`, Hz, from half a
/// period of explicit steps; `expected` (Hz) only says when to give up.
fn frequency_by_steps(
    problem: &SolidProblem,
    shape: &[Vec3],
    expected: f64,
) -> Result<Counted, CaseError> {
    let model = SolidModel::new(problem.clone())?;
    let weights: Vec<Vec3> =
        shape.iter().zip(&model.mass).map(|(v, mass)| v.map(|x| mass * x)).collect();
    let velocity = shape.iter().map(|v| v.map(|x| PUSH * x)).collect();
    let still = vec![[0.0; 3]; shape.len()];
    let (method, stepping) =
        (ExplicitMethod::CentralDifferences, SolidStepping::FractionOfLimit(STEP));
    let mut solid = ExplicitSolid::new(model, method, stepping, still, velocity)?;
    let mut before = (0.0, 0.0);
    while solid.time < 2.0 / expected {
        for _ in 0..8 {
            solid.step(|_, _, _| {})?;
        }
        let swing: f64 = weights
            .iter()
            .zip(&solid.displacement)
            .map(|(w, u)| w[0] * u[0] + w[1] * u[1] + w[2] * u[2])
            .sum();
        let now = (solid.time, swing);
        if before.1 > 0.0 && now.1 <= 0.0 {
            let half = before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1);
            return Ok((0.5 / half, Some(solid.work.evaluations)));
        }
        before = now;
    }
    Err(CaseError::message("the body did not swing back within two periods"))
}

fn explicit_sentence() -> String {
    format!(
        "Explicit steps: half a period of central differences at {STEP} of the limit, lumped mass, the search for the \
         limit included."
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::{STEEL, free_body, mesh_of};
    use bearing_dynamics::mesh::Order;
    use bearing_dynamics::mesh::generate::{RingMesh, ring};
    use bearing_dynamics::solver::solid::tangent::MassMatrix;

    fn on_mesh(series: &str, value: f64) -> Timed {
        let series = series.to_string();
        Timed { series, nodes: 1, value, evaluations: None, seconds: 1.0, repeats: 1 }
    }

    #[test]
    fn a_limit_is_what_numbers_of_its_series_tend_to() {
        let mut all = vec![on_mesh("other", 7.0)];
        // 3 + h² over h = 1, ½, ¼, and a mesh between them that is not used.
        all.extend([4.0, 3.6, 3.25, 3.0625].map(|value| on_mesh("own", value)));
        let limit = Limit::new(&all, "own", [0, 2, 3]);
        assert!((limit.value - 3.0).abs() <= 1e-14 && (limit.order - 2.0).abs() <= 1e-14);
        assert!((limit.left - 0.0625 / 3.0).abs() <= 1e-14);
    }

    #[test]
    fn what_falls_short_is_continued_at_its_rate() {
        let point = |nodes: usize, error| Point::new("slow", &format!("{nodes} nodes"), 1.0, error);
        let (a, b) = (point(100, 0.08), point(1000, 0.04));
        let said = falls_short(&[&a, &b]);
        // A tenth of the error for half a decade of nodes each: 4 % to 1 % takes a hundredfold.
        assert!(said.contains("4.00 % on 1000 nodes") && said.contains("power 0.30"), "{said}");
        assert!(said.contains("1e5 nodes for 1 % and 2e8 nodes for 0.1 %"), "{said}");
        let stuck = falls_short(&[&a, &point(1000, 0.08)]);
        assert!(stuck.contains("hardly falls"), "{stuck}");
    }

    /// The start is no mode of the mesh, yet half a period tells the frequency.
    #[test]
    fn explicit_steps_have_the_frequency_of_their_masses() {
        let cells = RingMesh { around: 48, radial: 1, axial: 1, radial_growth: 1.0 };
        let solid = ring(&crate::solid_bodies::thin_ring::BODY, &cells).unwrap();
        let mesh = mesh_of(&solid, Order::Quadratic).unwrap();
        let problem = free_body(&mesh, STEEL);
        let options = ModeOptions { mass: MassMatrix::Lumped, ..ModeOptions::new(8) };
        let found = modes(&SolidModel::new(problem.clone()).unwrap(), &options).unwrap();
        let expected = 0.5 * (found.modes[6].frequency + found.modes[7].frequency);
        let shape = ring::oval_shape(&mesh, 0.05);
        let (by_steps, evaluations) = frequency_by_steps(&problem, &shape, expected).unwrap();
        println!("{:e} off", by_steps / expected - 1.0);
        // Other modes have a share of some percent in the start, and count by its square.
        assert!((by_steps / expected - 1.0).abs() <= 5e-4, "{by_steps} {expected}");
        assert!(evaluations.is_some_and(|count| count > 1000));
    }
}
