//! An impact on the cage by explicit steps: the lines of its spectrum against eigenvalues of the
//! same lumped mass, free and held.

use bearing_dynamics::mesh::generate::CageMesh;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::spectrum::{Spectrum, spectrum};
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{Load, SolidModel, SolidProblem};

use super::{bending_pairs, lumped_modes};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::solid_bodies::cage::LITERAL;
use crate::solids::{STEEL, Vec3, free_body, mesh_of, prescribe};

/// Coarse: the comparison is with the same mesh's eigenvalues.
const CELLS: CageMesh = CageMesh { quarter: 2, bar: 1, wall: 1 };
/// Section 5.3.3, s.
const CONTACT_TIME: f64 = 1e-4;
/// N; leaves the cage linear.
const PEAK: f64 = 10.0;
/// Recorded time of the free and the held cage, s; its reciprocal is the width of a bin.
const FREE_TIME: f64 = 0.025;
const HELD_TIME: f64 = 0.01;
/// Held nodes: the outer surface within this angle (rad) of the top.
const PATCH: f64 = 0.2;

pub fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "held_patch",
        "Section 5.3.3 holds \"the nodes on top of the cage\" and does not say which.",
        "outer surface within 0.2 rad of the top",
    );
    let mesh = mesh_of(&LITERAL.solid(&CELLS)?, Order::Quadratic)?;
    let free = free_body(&mesh, STEEL);
    free_cage(context, &mesh, &free)?;
    held_cage(context, &mesh, free)
}

/// The node of the outer surface nearest to this angle (rad) from +Y towards +Z and axial place.
fn outer_node(mesh: &TetMesh, angle: f64, x: f64) -> Result<u32, CaseError> {
    let r = LITERAL.outer_radius;
    let wanted = [x, r * angle.cos(), r * angle.sin()];
    let distance = |node: &&u32| {
        let place = mesh.nodes[**node as usize];
        (0..3).map(|i| (place[i] - wanted[i]).powi(2)).sum::<f64>()
    };
    let nodes = mesh.node_set("outer")?;
    let nearest = nodes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.copied().ok_or_else(|| CaseError::message("the cage has no outer surface"))
}

/// A number taken from model and displacements.
type Measure<'a> = dyn Fn(&SolidModel, &[[f64; 4]]) -> f64 + 'a;

/// Amplitude spectra of `measures` after an impact on `node` along `direction`.
fn ring_out(
    mut problem: SolidProblem,
    node: u32,
    direction: Vec3,
    duration: f64,
    measures: &[&Measure],
) -> Result<Vec<Spectrum>, CaseError> {
    let profile = Profile::HalfSine { base: 0.0, peak: PEAK, start: 0.0, duration: CONTACT_TIME };
    problem.loads.push(Load { forces: vec![(node, direction)], profile });
    let still = vec![[0.0; 3]; problem.nodes.len()];
    let model = SolidModel::new(problem)?;
    let method = ExplicitMethod::CentralDifferences;
    let stepping = SolidStepping::FractionOfLimit(0.9);
    let limit = ExplicitSolid::new(model.clone(), method, stepping, still.clone(), still.clone())?
        .step_size;
    // Sixteen steps a sample, and samples that fill the time exactly.
    let samples = (duration / (16.0 * limit)).ceil();
    let stepping = SolidStepping::Fixed(duration / samples / 16.0);
    let mut solid = ExplicitSolid::new(model, method, stepping, still.clone(), still)?;
    let mut series = vec![Vec::new(); measures.len()];
    for _ in 0..samples as usize {
        for (values, measure) in series.iter_mut().zip(measures) {
            values.push(measure(&solid.model, &solid.displacement));
        }
        for _ in 0..16 {
            solid.step(|_, _, _| {})?;
        }
    }
    let of = |values: &Vec<f64>| {
        spectrum(values, duration / samples)
            .ok_or_else(|| CaseError::message("too few samples for a spectrum"))
    };
    series.iter().map(of).collect()
}

/// The middle of the highest bin between two frequencies, by the parabola through its neighbours, Hz.
fn peak(spectrum: &Spectrum, from: f64, to: f64) -> f64 {
    let bin = |f: f64| (f / spectrum.bin_width) as usize;
    let highest = (bin(from)..=bin(to))
        .max_by(|a, b| spectrum.amplitude[*a].total_cmp(&spectrum.amplitude[*b]))
        .unwrap_or(0);
    let [a, b, c] = [highest - 1, highest, highest + 1].map(|bin| spectrum.amplitude[bin].ln());
    (highest as f64 + 0.5 * (a - c) / (a - 2.0 * b + c)) * spectrum.bin_width
}

/// Mass-weighted share of motion as cos 2θ: radial, or axial.
fn second_harmonic(model: &SolidModel, u: &[[f64; 4]], axial: bool) -> f64 {
    let nodes = model.problem.nodes.iter().zip(u).zip(&model.mass);
    nodes
        .map(|((place, u), mass)| {
            let angle = place[2].atan2(place[1]);
            let moved = if axial { u[0] } else { u[1] * angle.cos() + u[2] * angle.sin() };
            mass * moved * (2.0 * angle).cos()
        })
        .sum::<f64>()
        / model.mass.iter().sum::<f64>()
}

fn plotted(spectrum: &Spectrum, name: &str) -> Curve {
    let largest = spectrum.amplitude.iter().fold(0.0f64, |m, x| m.max(*x));
    let bins = spectrum.amplitude.iter().enumerate();
    let points = bins
        .map(|(bin, amplitude)| [bin as f64 * spectrum.bin_width, amplitude / largest])
        .filter(|point| point[0] >= 200.0 && point[0] <= 8000.0)
        .collect();
    Curve::new(name, points)
}

fn free_cage(
    context: &mut CaseContext,
    mesh: &TetMesh,
    problem: &SolidProblem,
) -> Result<(), CaseError> {
    let modes = lumped_modes(&SolidModel::new(problem.clone())?, 10)?;
    let exact = bending_pairs(&mesh.nodes, &modes[6..])?;
    // Obliquely on the edge of the outer surface, so that both kinds of bending answer.
    let node = outer_node(mesh, 0.0, 0.5 * LITERAL.width)?;
    let spectra = ring_out(
        problem.clone(),
        node,
        [-0.7, -0.7, 0.0],
        FREE_TIME,
        &[&|model, u| second_harmonic(model, u, false), &|model, u| {
            second_harmonic(model, u, true)
        }],
    )?;
    for (i, (key, text)) in [("in", "ovalling of the ring"), ("out", "warping out of its plane")]
        .into_iter()
        .enumerate()
    {
        let found = peak(&spectra[i], 0.7 * exact[i], 1.3 * exact[i]);
        context.check(
            Check::new(
                &format!("impact_{key}"),
                &format!("free cage after an impact, spectrum of its {text}: highest line"),
                "Hz",
                found,
            )
            .consistency(exact[i], "our explicit steps against our own eigenvalue of the same mesh and lumped mass, mean of the pair")
            .absolute(1.0 / FREE_TIME, "one bin of the spectrum"),
        );
    }
    let plot = XyPlot {
        title: "Free cage after an impact".into(),
        x: Axis::linear("frequency", "Hz"),
        y: Axis::linear("amplitude over its largest", "1"),
        curves: vec![plotted(&spectra[0], "ovalling"), plotted(&spectra[1], "warping")],
        style: Style::Lines,
    };
    context.figure(
        "free_spectrum",
        xy(&plot)?,
        "Spectra of the free literal cage after a push of 0.1 ms on its edge, coarse mesh of ten-node elements \
         (whose eigenvalues are 6 and 13 % above the converged ones).",
    );
    Ok(())
}

fn held_cage(
    context: &mut CaseContext,
    mesh: &TetMesh,
    mut problem: SolidProblem,
) -> Result<(), CaseError> {
    let top = std::f64::consts::FRAC_PI_2;
    prescribe(&mut problem, |[_, y, z]| {
        let outside = y.hypot(z) > LITERAL.outer_radius - 1e-6;
        let held = outside && (z.atan2(y) - top).abs() <= PATCH;
        if held { [Some(0.0); 3] } else { [None; 3] }
    });
    let modes = lumped_modes(&SolidModel::new(problem.clone())?, 10)?;
    let below = modes.iter().filter(|mode| mode.frequency < 5000.0).count();
    context.check(
        Check::new(
            "held_modes_below_5_khz",
            "natural frequencies of the held cage below 5 kHz, how many",
            "1",
            below as f64,
        )
        .stated(2.0, "5.3.3", "the suspended cage shows two lines")
        .at_least(1.0, "more lines than two: which of them the source shows cannot be told")
        .under("held_patch"),
    );
    let rows = modes
        .iter()
        .enumerate()
        .map(|(n, mode)| vec![(n + 1).to_string(), format!("{:.1}", mode.frequency)])
        .collect();
    context.table(
        "held_modes",
        "Natural frequencies of the cage held at the top, coarse mesh, lumped mass",
        &["mode", "Hz"],
        rows,
    );
    let node = outer_node(mesh, -0.3, 0.5 * LITERAL.width)?;
    let centre = |axis: usize| {
        move |model: &SolidModel, u: &[[f64; 4]]| {
            let sum: f64 = u.iter().zip(&model.mass).map(|(u, mass)| mass * u[axis]).sum();
            sum / model.mass.iter().sum::<f64>()
        }
    };
    let spectra = ring_out(
        problem,
        node,
        [-0.5, -0.7, 0.5],
        HELD_TIME,
        &[&centre(0), &centre(1), &centre(2)],
    )?;
    let names = ["axial", "sideways", "vertical"];
    let plot = XyPlot {
        title: "Cage held at the top after an impact".into(),
        x: Axis::linear("frequency", "Hz"),
        y: Axis::linear("amplitude over its largest", "1"),
        curves: spectra.iter().zip(names).map(|(s, name)| plotted(s, name)).collect(),
        style: Style::Lines,
    };
    context.figure(
        "held_spectrum",
        xy(&plot)?,
        "Spectra of the centre of mass of the cage held at the top, as Fig. 5.17 shows one: the patch held \
         decides the lines.",
    );
    Ok(())
}
