//! Radial stiffness of the bushing of 3.4.1 as its rubber hardly changes its volume: elements that do not lock, and
//! the source's, which does.

use bearing_dynamics::ch2_housing::elastomer::Elastomer;
use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::model::RubberModel;
use bearing_dynamics::solids::rubber::tet_forces::MeanStress;

use crate::bushings::{
    BUSHING, LOCKING, MODULUS, bonded, bonded_tets, complex_shear, quarter, section,
    shear_over_modulus,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::bonded_bushing::{incompressible_stiffness, radial_stiffness};

pub const CASE: Case = Case {
    id: "rubber_locking",
    title: "Bushing: stiffness as the bulk modulus grows",
    section: "2.2.3, 3.2.1, 3.4.1, (2.8), (3.1)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const RATIOS: [(f64, &str); 5] =
    [(1e1, "1e1"), (1e2, "1e2"), (1e3, "1e3"), (1e4, "1e4"), (1e5, "1e5")];
/// Cells around, across and along, and how they shrink towards the bonded ends.
const TEN: [usize; 3] = [12, 4, 4];
const FOUR: [usize; 3] = [12, 6, 6];
const COARSER: [usize; 3] = [8, 4, 4];
const GRADING: [f64; 2] = [2.0, 1.5];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let ten_nodes = quarter(&BUSHING, TEN, GRADING[0])?;
    let mut rows = Vec::new();
    let mut all: Vec<[f64; 4]> = Vec::new();
    for (ratio, _) in RATIOS {
        let (ten, _) = bonded(&ten_nodes, network(ratio)?, Profile::Constant(1.0))?;
        let shear = complex_shear(0.0, 0.0);
        let exact = radial_stiffness(section(&BUSHING), shear, ratio * MODULUS, 5, 3).re;
        let found = [
            exact,
            stiffness(&ten)?,
            four_nodes(ratio, FOUR, MeanStress::AroundNodes)?,
            four_nodes(ratio, FOUR, MeanStress::OfElement)?,
        ];
        let mut row = vec![format!("{ratio:.0e}")];
        row.extend(found.iter().map(|k| format!("{k:.4e}")));
        rows.push(row);
        all.push(found);
    }
    context.table(
        "ratios",
        "Relaxed radial stiffness, N/m",
        &["B/C_R", "oracle", "ten nodes", "four, volume around nodes", "four, volume of each"],
        rows,
    );
    checks(context, &all);
    let coarser = four_nodes(1e5, COARSER, MeanStress::AroundNodes)?;
    let [exact, _, around, _] = all[4];
    context.check(
        Check::new(
            "finer",
            "error of four nodes, volume around nodes, at B = 1e5 C_R, over that on cells 1.5 times as long",
            "1",
            (around / exact - 1.0) / (coarser / exact - 1.0),
        )
        .closed_form(1.0 / 2.25, "second order")
        .relative(0.3, "singular corners, and the third order")
        .golden(GoldenTolerance::MIXED),
    );
    let named = [
        "polynomials of high degree",
        "ten nodes",
        "four nodes, volume around nodes",
        "four nodes, the source's",
    ];
    let curves = named.into_iter().enumerate().map(|(k, name)| {
        let points = RATIOS.iter().zip(&all).map(|((ratio, _), of)| [*ratio, 1e-6 * of[k]]);
        Curve::new(name, points.collect())
    });
    let svg = xy(&XyPlot {
        title: "Radial stiffness as the bulk modulus grows".into(),
        x: Axis::log("bulk modulus over C_R", "1"),
        y: Axis::log("stiffness", "kN/mm"),
        style: Style::Lines,
        curves: curves.collect(),
    })?;
    context.figure(
        "locking",
        svg,
        "Elements with one volume each follow the bulk modulus; the others the bushing.",
    );
    Ok(())
}

/// Without Maxwell elements, B in C_R.
fn network(ratio: f64) -> Result<Elastomer, CaseError> {
    let network = EightChain::new(MODULUS, LOCKING, ratio * MODULUS, ChainPull::FiveTerms)?;
    Ok(Elastomer { network, maxwell: Vec::new() })
}

fn four_nodes(ratio: f64, cells: [usize; 3], mean_stress: MeanStress) -> Result<f64, CaseError> {
    let (rubber, moved) = (network(ratio)?, Profile::Constant(1.0));
    let (body, _) = bonded_tets(&BUSHING, cells, GRADING[1], rubber, mean_stress, moved)?;
    stiffness(&body.implicit()?)
}

/// Of the whole bushing, N/m.
fn stiffness(model: &RubberModel) -> Result<f64, CaseError> {
    Ok(4.0 * complex_stiffness(model, 0.0, &[0.0], 1e-6)?[0].storage)
}

fn checks(context: &mut CaseContext, all: &[[f64; 4]]) {
    for ((ratio, key), [exact, ten, around, _]) in RATIOS.into_iter().zip(all) {
        for (id, elements, ours, tolerance, reason) in [
            ("ten", "ten-node elements", *ten, 0.01, "the mesh, and singular corners: 0.8 %"),
            (
                "around",
                "four-node elements, volume around nodes",
                *around,
                0.12,
                "four nodes need more cells than ten: 10 % on this mesh, less on finer ones",
            ),
        ] {
            let text = format!("relaxed radial stiffness at B = {ratio:.0e} C_R, {elements}");
            context.check(
                Check::new(&format!("{id}_{key}"), &text, "N/m", ours)
                    .independent(*exact, "one Fourier component, polynomials of degree 5")
                    .relative(tolerance, reason)
                    .golden(GoldenTolerance::MIXED),
            );
        }
    }
    let [exact, ten, around, own] = all[4];
    let incompressible = incompressible_stiffness(section(&BUSHING))
        * shear_over_modulus()
        * MODULUS
        * BUSHING.length;
    context.check(
        Check::new(
            "closed_form",
            "relaxed radial stiffness at B = 1e5 C_R, ten-node elements",
            "N/m",
            ten,
        )
        .closed_form(incompressible, "rubber that keeps its volume, parabolic along the length")
        .relative(
            0.03,
            "the form is within 2 % of converged elements at this length; the mesh leaves 0.8 %",
        ),
    );
    context.check(
        Check::new(
            "bounded",
            "stiffness at B = 1e5 C_R over that at 1e3 C_R, four nodes, volume around nodes",
            "1",
            around / all[2][2],
        )
        .independent(exact / all[2][0], "one Fourier component, polynomials of degree 5")
        .relative(0.02, "locking would be a factor of up to a hundred"),
    );
    context.check(
        Check::new(
            "locked",
            "stiffness at B = 1e5 C_R over the oracle's, four nodes, volume of each",
            "1",
            own / exact,
        )
        .converged(1.0, "an element that does not lock")
        .at_least(100.0, "volumetric locking: stiffness grows with B"),
    );
    context.check(
        Check::new(
            "locked_source",
            "stiffness at B = 100 C_R over the oracle's, four nodes, volume of each",
            "1",
            all[1][3] / all[1][0],
        )
        .converged(1.0, "an element that does not lock")
        .at_least(0.3, "the source's element at the source's bulk modulus"),
    );
}
