//! Why long bushings are stiff: rubber that leaves through the ends of a short and a long one, and the closed
//! form for rubber that keeps its volume beside both.

use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::mesh::generate::{Bushing, Part};
use bearing_dynamics::mesh::{Elements, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::rubber::sleeve::{SleeveMotion, sleeve_stiffness};
use bearing_dynamics::solids::rubber::steps::Stepping;

use crate::bushings::{
    BUSHING, MODULUS, Moved, bonded, exact, order, quarter, rubber, section, shear_over_modulus,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::bonded_bushing::radial_stiffness;
use crate::oracles::bonded_disc;

pub const CASE: Case = Case {
    id: "bushing_bulging_3_4_2",
    title: "Bulging ends of short and long bushings",
    section: "3.4.2, Fig. 3.18",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const THICKNESS: f64 = 0.02;
/// L̄, with D̄ = 2.
const LENGTHS: [(f64, [usize; 3]); 2] = [(1.0, [12, 6, 3]), (10.0, [12, 6, 8])];
/// m.
const MOVED: f64 = 1e-3;

fn body(diameter: f64, length: f64) -> Bushing {
    Bushing {
        inner_diameter: diameter * THICKNESS,
        thickness: THICKNESS,
        length: length * THICKNESS,
    }
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut left = Vec::new();
    let mut curves = Vec::new();
    for (length, cells) in LENGTHS {
        let body = body(2.0, length);
        let mesh = quarter(&body, cells, 1.6)?;
        let ramp = Profile::Ramp { from: 0.0, to: MOVED, start: 0.0, duration: 1.0 };
        let (model, inner) = bonded(&mesh, rubber(MODULUS, 0.0, ChainPull::FiveTerms)?, ramp)?;
        let mut moved = Moved::new(&model, &inner, Stepping::Fixed(0.5))?;
        moved.advance(1.0, &mut Vec::new())?;
        let along: Vec<f64> = moved.solid.displacement().iter().map(|u| u[0]).collect();
        // A quarter has half of one of two ends; what leaves on the side that is pressed.
        let out = 4.0 * through_the_end(&mesh, &along)?;
        let swept = body.inner_diameter * body.length * MOVED;
        left.push(out / swept);
        curves.push(Curve::new(format!("L̄ = {length}"), profile(&mesh, &along)));
    }
    let [short, long] = [left[0], left[1]];
    context.check(
        Check::new(
            "less_leaves",
            "part of the swept volume that leaves through the ends, long over short",
            "1",
            long / short,
        )
        .stated(1.0, "3.4.2", "bulging has less effect on long bushings, whose rubber is confined")
        .at_most(0.0, "an order")
        .golden(GoldenTolerance::MIXED),
    );
    context.check(
        Check::new("short_leaves", "what leaves through the ends of the short bushing on the pressed side, over the volume that the sleeve sweeps", "1", short)
            .stated(0.0, "3.4.2", "rubber that is pressed expands across and bulges the ends")
            .at_least(0.2, "a good part of it; rubber beside the sleeve is dragged along, so that it may be more than all")
            .golden(GoldenTolerance::MIXED),
    );
    let svg = xy(&XyPlot {
        title: "Bulge of an end, sleeve moved by 1 mm".into(),
        x: Axis::linear("from the axis along the motion", "mm"),
        y: Axis::linear("along the axis, outwards", "mm"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("fig_3_18", svg, "As Fig. 3.18: ends of a short and a long bushing on the line through the axis along the motion; the pressed side bulges, the other sinks.");
    closed_form(context)
}

/// ∫ u⁺ dA over the end, m³: of a face of six nodes the three between corners weigh a third each.
fn through_the_end(mesh: &TetMesh, along: &[f64]) -> Result<f64, CaseError> {
    let Elements::Quadratic(elements) = &mesh.elements else {
        return Err(CaseError::message("elements of ten nodes are needed"));
    };
    let end = &mesh.node_sets["x_high"];
    let mut sum = 0.0;
    for element in elements {
        let on_end = |nodes: &[u32]| -> Vec<u32> {
            nodes.iter().copied().filter(|n| end.contains(n)).collect()
        };
        let (corners, between) = (on_end(&element[..4]), on_end(&element[4..]));
        if let [a, b, c] = corners[..] {
            let [a, b, c] = [a, b, c].map(|n| mesh.nodes[n as usize]);
            let [u, v] = [b, c].map(|x| [x[1] - a[1], x[2] - a[2]]);
            let area = 0.5 * (u[0] * v[1] - u[1] * v[0]).abs();
            sum += between.iter().map(|n| along[*n as usize].max(0.0) * area / 3.0).sum::<f64>();
        }
    }
    Ok(sum)
}

/// Place along Z and displacement of the end, mm, on Y = 0.
fn profile(mesh: &TetMesh, along: &[f64]) -> Vec<[f64; 2]> {
    let plane = &mesh.node_sets["y_low"];
    let nodes = mesh.node_sets["x_high"].iter().filter(|n| plane.contains(n));
    let mut points: Vec<[f64; 2]> =
        nodes.map(|n| [1e3 * mesh.nodes[*n as usize][2], 1e3 * along[*n as usize]]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// Relaxed stiffness of rubber that hardly changes its volume beside the closed form of finite length, and the
/// trends of that form over the geometries of Table 3.4.
fn closed_form(context: &mut CaseContext) -> Result<(), CaseError> {
    const RATIOS: [f64; 6] = [1.0, 2.0, 4.0, 6.0, 8.0, 10.0];
    const STIFF: f64 = 1e4;
    let mu = shear_over_modulus() * MODULUS;
    let disc = |body: &Bushing| {
        let of = section(body);
        bonded_disc::radial_stiffness(of.inner, of.outer, of.length)
    };
    let mut rows = Vec::new();
    for (name, body, cells, tolerance) in [
        ("3_4_1", BUSHING, [12, 6, 4], 0.035),
        ("short", body(2.0, 1.0), [12, 6, 3], 0.035),
        ("wide", body(4.0, 4.0), [20, 6, 4], 0.08),
    ] {
        let mut material = rubber(MODULUS, 0.0, ChainPull::FiveTerms)?;
        material.network.bulk = STIFF * MODULUS;
        let mesh = quarter(&body, cells, 1.8)?;
        let found =
            sleeve_stiffness(&mesh, Part::Quarter, material, SleeveMotion::Radial, &[0.0], 1e-6)?;
        let ours = found[0].storage / (mu * body.length);
        let oracle = radial_stiffness(section(&body), mu.into(), STIFF * MODULUS, 5, 3).re
            / (mu * body.length);
        let form = disc(&body);
        let compressible = exact(&body, 0.0, 0.0, 5).dynamic_stiffness / (mu * body.length);
        rows.push(
            [ours, oracle, form, compressible]
                .iter()
                .map(|x| format!("{x:.3}"))
                .collect::<Vec<_>>(),
        );
        context.check(
            Check::new(
                &format!("form_{name}"),
                &format!("relaxed stiffness over μL at B = 1e4 C_R, {name}"),
                "1",
                ours,
            )
            .closed_form(form, "bushing of finite length, rubber that keeps its volume")
            .relative(tolerance, "what the form leaves between disc and plane strain: 1 to 2 % of two, 7 % of the wide one")
            .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(
                &format!("oracle_{name}"),
                &format!("relaxed stiffness over μL at B = 1e4 C_R, {name}"),
                "1",
                ours,
            )
            .independent(oracle, "one Fourier component, polynomials of degree 5")
            .relative(0.012, "what these meshes leave"),
        );
    }
    context.table(
        "closed_form",
        "Relaxed stiffness over μL: 3.4.1, short (D̄ 2, L̄ 1), wide (4, 4)",
        &["ours, B = 1e4 C_R", "oracle", "closed form", "oracle, B = 100 C_R"],
        rows,
    );
    // K̄ is K over length and diameter, times the thickness.
    let of = |d: f64, l: f64| disc(&body(d, l)) / d;
    let falls = 1.0 - of(RATIOS[5], RATIOS[0]) / of(RATIOS[0], RATIOS[0]);
    let rises = of(RATIOS[5], RATIOS[5]) / of(RATIOS[0], RATIOS[5]) - 1.0;
    order(
        context,
        "3.4.2",
        "the closed form has opposite trends over diameter for short and long bushings",
        &[
            ("trend_short", "closed form, shortest: fall from the narrowest to the widest", falls),
            ("trend_long", "closed form, longest: rise from the narrowest to the widest", rises),
        ],
    );
    Ok(())
}
