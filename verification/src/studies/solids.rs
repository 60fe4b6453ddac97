//! What a digit costs of a flexible solid: equilibrium, natural modes and explicit steps with
//! four- and ten-node elements, mesh by mesh, on a cantilever, a ring and the cage.
//!
//! A deflection comes from equilibrium. A natural frequency comes from Lanczos' modes with the
//! consistent mass, or from explicit steps with the lumped mass: the body starts undeformed with the
//! velocities of a beam's or thin ring's mode, and passes through rest again after half a period.
//! That motion holds other modes too, but weighted by the start each one counts by the square of
//! its share. Times are those from a mesh to the number; meshing is not counted.

use std::time::Instant;

use bearing_dynamics::kinematics::strain::principal;
use bearing_dynamics::mesh::generate::{CageMesh, RingMesh, ring};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solver::solid::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solver::solid::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solver::solid::model::{SolidModel, SolidProblem};
use bearing_dynamics::solver::solid::modes::{ModeOptions, modes};
use bearing_dynamics::solver::solid::stress::nodal_stresses;

use crate::case::CaseError;
use crate::oracles::lame::Ends;
use crate::oracles::ring::Plane;
use crate::pareto::{ParetoContext, Point, Study, cheapest_ways};
use crate::solid_bodies::{cage, cantilever, thick_ring, thin_ring};
use crate::solids::{
    STEEL, Vec3, constant_load, free_body, mesh_of, name_of, prescribe, surface_force,
};

pub const CANTILEVER_DEFLECTION: Study = Study {
    id: "solid_cantilever_deflection",
    title: "Cantilever, tip deflection",
    error_label: "error of the deflection",
    more_errors: &["difference from Timoshenko"],
    run: cantilever_deflection,
};

pub const CANTILEVER_FREQUENCY: Study = Study {
    id: "solid_cantilever_frequency",
    title: "Cantilever, first natural frequency",
    error_label: "error of the frequency",
    more_errors: &["difference from Timoshenko"],
    run: cantilever_frequency,
};

pub const RING_DEFLECTION: Study = Study {
    id: "solid_ring_deflection",
    title: "Thick ring under inner pressure, motion of its bore",
    error_label: "error of the bore's displacement",
    more_errors: &["error of the hoop stress at the bore"],
    run: ring_deflection,
};

pub const RING_FREQUENCY: Study = Study {
    id: "solid_ring_frequency",
    title: "Thin free ring, first natural frequency",
    error_label: "error of the frequency",
    more_errors: &[],
    run: ring_frequency,
};

pub const CAGE_DEFLECTION: Study = Study {
    id: "solid_cage_deflection",
    title: "Cage of Table 5.3, work of a pressure that ovals it",
    error_label: "error of the work",
    more_errors: &[],
    run: cage_deflection,
};

pub const CAGE_FREQUENCY: Study = Study {
    id: "solid_cage_frequency",
    title: "Free cage of Table 5.3, first natural frequency",
    error_label: "error of the frequency",
    more_errors: &[],
    run: cage_frequency,
};

/// Seconds that the repetitions of a variant may take beyond the first, and most repetitions.
const PATIENCE: f64 = 0.4;
const MOST_REPEATS: usize = 5;

/// A number, and the times that a force was evaluated on the way.
type Counted = (f64, Option<u64>);

/// Times `compute` and records it; `errors` are made of its number.
fn measure(
    context: &mut ParetoContext,
    series: String,
    mesh: &TetMesh,
    mut compute: impl FnMut() -> Result<Counted, CaseError>,
    errors: impl Fn(f64) -> Vec<f64>,
) -> Result<(), CaseError> {
    let begun = Instant::now();
    let (mut least, mut repeats) = (f64::INFINITY, 0);
    let (value, evaluations) = loop {
        let start = Instant::now();
        let found = std::hint::black_box(compute()?);
        least = least.min(start.elapsed().as_secs_f64());
        repeats += 1;
        if repeats == MOST_REPEATS || begun.elapsed().as_secs_f64() + least > PATIENCE {
            break found;
        }
    };
    let errors = errors(value);
    context.push(Point {
        repeats,
        evaluations,
        more_errors: errors[1..].to_vec(),
        ..Point::new(&series, &format!("{} nodes", mesh.nodes.len()), least, errors[0])
    });
    Ok(())
}

fn off(value: f64, reference: f64) -> f64 {
    (value / reference - 1.0).abs()
}

/// The limit of numbers on meshes that are refined twice over, and the observed order: what each
/// refinement changes falls by a constant factor.
fn richardson([coarse, middle, fine]: [f64; 3]) -> (f64, f64) {
    let factor = (middle - coarse) / (fine - middle);
    (fine + (fine - middle) / (factor - 1.0), factor.log2())
}

/// The sentences that every study ends with: the cheapest ways of all, and of each series that
/// does not come to 0.1 %, how far it comes and why.
fn conclude(context: &mut ParetoContext, whole: &str) {
    context.sentence(format!("The {}", cheapest_ways(context.points(), 0, whole)));
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
    let fall = (before.error / last.error).ln();
    let (by_nodes, by_time) =
        (fall / (nodes(last) / nodes(before)).ln(), fall / (last.seconds / before.seconds).ln());
    let name = &last.series;
    let percent = 100.0 * last.error;
    let far = format!("{name} does not come to 0.1 %: {percent:.2} % on {}", last.variant);
    if by_nodes.is_nan() || by_nodes < 0.1 {
        return format!("{far}, and the error hardly falls from one mesh to the next.");
    }
    let needed = |limit: f64| {
        let more = last.error / limit;
        let (nodes, seconds) =
            (nodes(last) * more.powf(1.0 / by_nodes), last.seconds * more.powf(1.0 / by_time));
        format!("{nodes:.0e} nodes and {seconds:.0e} s")
    };
    let one = if last.error > 1e-2 { format!("{} for 1 %, ", needed(1e-2)) } else { String::new() };
    format!(
        "{far}. Its error falls with the power {by_nodes:.2} of the nodes and {by_time:.2} of the time, so that it \
         would take about {one}{} for 0.1 %.",
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

/// First bending mode of Euler's cantilever, with the rotation of its sections.
fn beam_shape(mesh: &TetMesh) -> Vec<Vec3> {
    const ROOT: f64 = 1.875_104_068_711_961;
    let share = (ROOT.cosh() + ROOT.cos()) / (ROOT.sinh() + ROOT.sin());
    let at = |place: &Vec3| {
        let s = ROOT * place[0] / cantilever::LENGTH;
        let deflection = s.cosh() - s.cos() - (s.sinh() - s.sin()) / share;
        let slope = (s.sinh() + s.sin() - (s.cosh() - s.cos()) / share) * ROOT / cantilever::LENGTH;
        [-place[2] * slope, 0.0, deflection]
    };
    mesh.nodes.iter().map(at).collect()
}

/// A thin ring that ovals without stretching of its middle line.
fn oval_shape(mesh: &TetMesh, radius: f64) -> Vec<Vec3> {
    let at = |place: &Vec3| {
        let [_, y, z] = *place;
        let (angle, r) = (z.atan2(y), y.hypot(z));
        let radial = (2.0 * angle).cos();
        // −½ sin 2θ on the middle line, and the rotation of the sections off it.
        let hoop = (2.0 * angle).sin() * (1.5 * (r - radius) / radius - 0.5);
        let (c, s) = (angle.cos(), angle.sin());
        [0.0, radial * c - hoop * s, radial * s + hoop * c]
    };
    mesh.nodes.iter().map(at).collect()
}

const BEAM_TEN: [[usize; 3]; 5] = [[5, 1, 2], [10, 1, 2], [20, 1, 2], [40, 2, 4], [60, 3, 6]];
const BEAM_FOUR: [[usize; 3]; 5] = [[20, 1, 2], [40, 2, 4], [80, 4, 8], [120, 6, 12], [160, 8, 16]];
const BEAM_CONVERGED: [[usize; 3]; 3] = [[20, 1, 2], [40, 2, 4], [80, 4, 8]];

fn cantilever_deflection(context: &mut ParetoContext) -> Result<(), CaseError> {
    let solve = |order, cells| -> Result<(TetMesh, SolidProblem), CaseError> {
        let (mesh, mut problem) = cantilever::half_beam(order, cells)?;
        problem.loads.push(constant_load(cantilever::tip_load(&mesh)?));
        Ok((mesh, problem))
    };
    let deflection = |problem: &SolidProblem| -> Result<f64, CaseError> {
        let model = SolidModel::new(problem.clone())?;
        let found = settle(&model)?;
        Ok(cantilever::deflection(&problem.loads[0].forces, &found))
    };
    let mut converging = [0.0; 3];
    for (value, cells) in converging.iter_mut().zip(BEAM_CONVERGED) {
        *value = deflection(&solve(Order::Quadratic, cells)?.1)?;
    }
    let (converged, order) = richardson(converging);
    let timoshenko = cantilever::FORCE * cantilever::beam().tip_deflection();
    for (order, meshes) in [(Order::Linear, BEAM_FOUR), (Order::Quadratic, BEAM_TEN)] {
        for cells in meshes {
            let (mesh, problem) = solve(order, cells)?;
            let series = format!("{}, equilibrium", name_of(order));
            measure(
                context,
                series,
                &mesh,
                || Ok((deflection(&problem)?, None)),
                |value| vec![off(value, converged), off(value, timoshenko)],
            )?;
        }
    }
    conclude(context, "the deflection");
    context.sentence(reference_sentence(
        converging,
        converged,
        order,
        "m",
        timoshenko,
        "Timoshenko's beam",
    ));
    Ok(())
}

/// What the reference of a study is, and how far another one lies from it.
fn reference_sentence(
    converging: [f64; 3],
    converged: f64,
    order: f64,
    unit: &str,
    other: f64,
    whose: &str,
) -> String {
    format!(
        "Reference: tet10 on three meshes, each with cells half as large as the one before, continued to its limit \
         {converged:.6e} {unit} (observed order {order:.1}, {:.1e} beyond the finest of them); {whose} gives \
         {:+.2} % more.",
        off(converging[2], converged),
        100.0 * (other / converged - 1.0)
    )
}

fn cantilever_frequency(context: &mut ParetoContext) -> Result<(), CaseError> {
    let by_modes = |problem: &SolidProblem, mesh: &TetMesh| {
        frequency_by_modes(problem, 0, 1, &beam_shape(mesh))
    };
    let mut converging = [0.0; 3];
    for (value, cells) in converging.iter_mut().zip(BEAM_CONVERGED) {
        let (mesh, problem) = cantilever::half_beam(Order::Quadratic, cells)?;
        *value = by_modes(&problem, &mesh)?;
    }
    let (converged, order) = richardson(converging);
    let timoshenko = cantilever::beam().frequencies(1)[0];
    let errors = |value| vec![off(value, converged), off(value, timoshenko)];
    for (order, meshes) in [(Order::Linear, BEAM_FOUR), (Order::Quadratic, BEAM_TEN)] {
        for cells in meshes {
            let (mesh, problem) = cantilever::half_beam(order, cells)?;
            let series = format!("{}, modes", name_of(order));
            measure(context, series, &mesh, || Ok((by_modes(&problem, &mesh)?, None)), errors)?;
        }
    }
    for (order, meshes) in [(Order::Linear, &BEAM_FOUR[..3]), (Order::Quadratic, &BEAM_TEN[..4])] {
        for &cells in meshes {
            let (mesh, problem) = cantilever::half_beam(order, cells)?;
            let shape = beam_shape(&mesh);
            let series = format!("{}, explicit steps", name_of(order));
            let swing = || frequency_by_steps(&problem, &shape, timoshenko);
            measure(context, series, &mesh, swing, errors)?;
        }
    }
    conclude(context, "the frequency");
    context.sentence(reference_sentence(
        converging,
        converged,
        order,
        "Hz",
        timoshenko,
        "Timoshenko's beam",
    ));
    context.sentence(explicit_sentence());
    Ok(())
}

fn explicit_sentence() -> String {
    format!(
        "Explicit steps: half a period of central differences at {STEP} of the limit, lumped mass, the search for the \
         limit included."
    )
}

fn ring_deflection(context: &mut ParetoContext) -> Result<(), CaseError> {
    let radius = thick_ring::BODY.inner_radius;
    let exact = thick_ring::exact();
    let (moves, hoop) = (exact.displacement(radius, Ends::Free), exact.stresses(radius)[1]);
    let ten = [(12, 1), (16, 2), (24, 3), (40, 6)];
    let four = [(24, 3), (48, 6), (96, 12), (144, 18)];
    for (order, meshes) in [(Order::Linear, four), (Order::Quadratic, ten)] {
        for (around, radial) in meshes {
            let (mesh, problem) = thick_ring::pressed(order, around, radial, Ends::Free)?;
            let series = format!("{}, equilibrium", name_of(order));
            let solve = || {
                let model = SolidModel::new(problem.clone())?;
                let found = settle(&model)?;
                let outwards = |n: usize| thick_ring::outwards(mesh.nodes[n], found[n]);
                Ok((thick_ring::mean(&mesh, "inner", outwards)?, None))
            };
            let model = SolidModel::new(problem.clone())?;
            let stresses = nodal_stresses(&model, &settle(&model)?);
            let largest = |n: usize| principal(&stresses[n])[0];
            let stress = thick_ring::mean(&mesh, "inner", largest)?;
            measure(context, series, &mesh, solve, |value| {
                vec![off(value, moves), off(stress, hoop)]
            })?;
        }
    }
    conclude(context, "the bore's displacement");
    context.sentence(format!(
        "The {}",
        cheapest_ways(context.points(), 1, "the hoop stress at the bore")
    ));
    context.sentence("Reference: Lamé, ends free; stresses are means over the bore's nodes.");
    Ok(())
}

fn ring_frequency(context: &mut ParetoContext) -> Result<(), CaseError> {
    let exact = thin_ring::exact().frequency(2, Plane::In);
    let mean = 0.5 * (thin_ring::BODY.inner_radius + thin_ring::BODY.outer_radius);
    let body = |order, (around, radial, axial)| -> Result<(TetMesh, SolidProblem), CaseError> {
        let cells = RingMesh { around, radial, axial, radial_growth: 1.0 };
        let mesh = mesh_of(&ring(&thin_ring::BODY, &cells)?, order)?;
        let problem = free_body(&mesh, STEEL);
        Ok((mesh, problem))
    };
    let ten = [(12, 1, 1), (16, 1, 1), (24, 1, 1), (32, 1, 1), (64, 1, 2), (96, 2, 3)];
    let four = [(64, 1, 2), (96, 2, 3), (192, 4, 6), (288, 6, 9)];
    for (order, meshes) in [(Order::Linear, &four[..]), (Order::Quadratic, &ten)] {
        for &cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let shape = oval_shape(&mesh, mean);
            let series = format!("{}, modes", name_of(order));
            let solve = || Ok((frequency_by_modes(&problem, 6, 2, &shape)?, None));
            measure(context, series, &mesh, solve, |value| vec![off(value, exact)])?;
        }
    }
    for (order, meshes) in [(Order::Linear, &four[..2]), (Order::Quadratic, &ten[..5])] {
        for &cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let shape = oval_shape(&mesh, mean);
            let series = format!("{}, explicit steps", name_of(order));
            let swing = || frequency_by_steps(&problem, &shape, exact);
            measure(context, series, &mesh, swing, |value| vec![off(value, exact)])?;
        }
    }
    conclude(context, "the frequency");
    context.sentence(format!(
        "Reference: {exact:.2} Hz by Ritz' method in cylindrical coordinates, two waves in the plane."
    ));
    context.sentence(explicit_sentence());
    Ok(())
}

const CAGE_TEN: [CageMesh; 4] = [
    CageMesh { quarter: 2, bar: 1, wall: 1 },
    CageMesh { quarter: 3, bar: 2, wall: 1 },
    CageMesh { quarter: 4, bar: 2, wall: 2 },
    CageMesh { quarter: 6, bar: 3, wall: 2 },
];
const CAGE_FOUR: [CageMesh; 4] = [
    CageMesh { quarter: 2, bar: 1, wall: 1 },
    CageMesh { quarter: 4, bar: 2, wall: 2 },
    CageMesh { quarter: 8, bar: 4, wall: 4 },
    CageMesh { quarter: 10, bar: 5, wall: 5 },
];
const CAGE_CONVERGED: [CageMesh; 3] = [
    CageMesh { quarter: 2, bar: 1, wall: 1 },
    CageMesh { quarter: 4, bar: 2, wall: 2 },
    CageMesh { quarter: 8, bar: 4, wall: 4 },
];

fn cage_deflection(context: &mut ParetoContext) -> Result<(), CaseError> {
    let body = |order, cells: &CageMesh| -> Result<(TetMesh, SolidProblem), CaseError> {
        let mesh = mesh_of(&cage::LITERAL.solid(cells)?, order)?;
        let mut problem = free_body(&mesh, STEEL);
        hold_lightly(&mut problem, &mesh)?;
        let oval = |[_, y, z]: Vec3, normal: Vec3| {
            let pressure = 1e4 * (2.0 * z.atan2(y)).cos();
            normal.map(|n| pressure * n)
        };
        let load = surface_force(&mesh, mesh.surface_set("outer")?, oval);
        problem.loads.push(constant_load(load));
        Ok((mesh, problem))
    };
    let work = |problem: &SolidProblem| -> Result<f64, CaseError> {
        let model = SolidModel::new(problem.clone())?;
        let found = settle(&model)?;
        Ok(work_of_loads(&model, &found))
    };
    let mut converging = [0.0; 3];
    for (value, cells) in converging.iter_mut().zip(&CAGE_CONVERGED) {
        *value = work(&body(Order::Quadratic, cells)?.1)?;
    }
    let (converged, observed) = richardson(converging);
    for (order, meshes) in [(Order::Linear, CAGE_FOUR), (Order::Quadratic, CAGE_TEN)] {
        for cells in &meshes {
            let (mesh, problem) = body(order, cells)?;
            let series = format!("{}, equilibrium", name_of(order));
            let solve = || Ok((work(&problem)?, None));
            measure(context, series, &mesh, solve, |value| vec![off(value, converged)])?;
        }
    }
    conclude(context, "the work");
    context.sentence(format!(
        "Reference: tet10 on three meshes, each with cells half as large as the one before, continued to its limit \
         (observed order {observed:.1}, {:.1e} beyond the finest of them). Pressure as cos 2θ on the outer surface.",
        off(converging[2], converged)
    ));
    Ok(())
}

/// Three nodes hold a body whose loads balance: no support carries anything.
fn hold_lightly(problem: &mut SolidProblem, mesh: &TetMesh) -> Result<(), CaseError> {
    let outer = mesh.node_set("outer")?;
    let extreme = |along: Vec3| {
        let height = |node: &&u32| {
            let x = mesh.nodes[**node as usize];
            x[0] * along[0] + x[1] * along[1] + x[2] * along[2]
        };
        outer.iter().max_by(|a, b| height(a).total_cmp(&height(b))).copied()
    };
    let found = [[0.01, 1.0, 0.0], [0.01, -1.0, 0.0], [0.01, 0.0, 1.0]].map(extreme);
    let [Some(right), Some(left), Some(top)] = found else {
        return Err(CaseError::message("the cage has no outer surface"));
    };
    let places = [right, left, top].map(|node| mesh.nodes[node as usize]);
    prescribe(problem, |place| {
        let still = |held: bool| held.then_some(0.0);
        let [at_right, at_left, at_top] = places.map(|held| held == place);
        [still(at_right || at_left || at_top), still(at_right), still(at_right || at_left)]
    });
    Ok(())
}

fn cage_frequency(context: &mut ParetoContext) -> Result<(), CaseError> {
    let mean = 0.5 * (cage::LITERAL.inner_radius + cage::LITERAL.outer_radius);
    let body = |order, cells: &CageMesh| -> Result<(TetMesh, SolidProblem), CaseError> {
        let mesh = mesh_of(&cage::LITERAL.solid(cells)?, order)?;
        let problem = free_body(&mesh, STEEL);
        Ok((mesh, problem))
    };
    let by_modes = |problem: &SolidProblem, mesh: &TetMesh| {
        frequency_by_modes(problem, 6, 2, &oval_shape(mesh, mean))
    };
    let mut converging = [0.0; 3];
    for (value, cells) in converging.iter_mut().zip(&CAGE_CONVERGED) {
        let (mesh, problem) = body(Order::Quadratic, cells)?;
        *value = by_modes(&problem, &mesh)?;
    }
    let (converged, observed) = richardson(converging);
    let errors = |value| vec![off(value, converged)];
    for (order, meshes) in [(Order::Linear, CAGE_FOUR), (Order::Quadratic, CAGE_TEN)] {
        for cells in &meshes {
            let (mesh, problem) = body(order, cells)?;
            let series = format!("{}, modes", name_of(order));
            measure(context, series, &mesh, || Ok((by_modes(&problem, &mesh)?, None)), errors)?;
        }
    }
    for (order, meshes) in [(Order::Linear, &CAGE_FOUR[..3]), (Order::Quadratic, &CAGE_TEN[..3])] {
        for cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let shape = oval_shape(&mesh, mean);
            let series = format!("{}, explicit steps", name_of(order));
            let swing = || frequency_by_steps(&problem, &shape, converged);
            measure(context, series, &mesh, swing, errors)?;
        }
    }
    conclude(context, "the frequency");
    context.sentence(reference_sentence(
        converging,
        converged,
        observed,
        "Hz",
        OTHER_PROGRAMS,
        "two other finite-element programs, converged,",
    ));
    context.sentence(explicit_sentence());
    Ok(())
}

/// First pair in the plane, Hz, as the case `cage_modes_table_5_3` has it.
const OTHER_PROGRAMS: f64 = 2271.5;
