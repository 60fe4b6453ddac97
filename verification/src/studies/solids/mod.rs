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
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{SolidModel, SolidProblem};
use bearing_dynamics::solids::modes::{ModeOptions, modes};

use crate::case::CaseError;
use crate::pareto::{ParetoContext, Point, Stopwatch, cheapest_ways};
use crate::solids::Vec3;

/// A variant is repeated until it has taken so many seconds, or so many times.
const PATIENCE: f64 = 0.4;
const MOST_REPEATS: usize = 5;

/// A number, and the times that a force was evaluated on the way.
type Counted = (f64, Option<u64>);

/// A number from a mesh, and what it took.
pub struct Timed {
    pub series: String,
    pub nodes: usize,
    pub value: f64,
    pub evaluations: Option<u64>,
    pub seconds: f64,
    pub repeats: usize,
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
pub struct Limit {
    pub value: f64,
    /// Power of the cells' size with which the changes fall.
    pub order: f64,
    /// Error of the finest of the three.
    pub left: f64,
}

impl Limit {
    /// By Richardson: what each refinement changes falls by a constant factor. `meshes` counts those
    /// of the series.
    pub fn new(all: &[Timed], series: &str, meshes: [usize; 3]) -> Limit {
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
pub fn falls_short(points: &[&Point]) -> String {
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
pub fn frequency_by_steps(
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
