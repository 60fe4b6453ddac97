//! Thirty-six bushings at 10 Hz: dimensionless stiffness and damping over length and diameter.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch3_bushing::hysteresis::of_complex_stiffness;
use bearing_dynamics::ch3_bushing::similitude::Scale;
use bearing_dynamics::mesh::generate::Bushing;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::rubber::harmonic::complex_stiffness;

use crate::bushings::{BULK_RATIO, bonded, complex_factor, quarter, rubber, shear_over_modulus};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::bonded_bushing::{Section, radial_stiffness};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "bushing_geometries_3_4_2",
    title: "Thirty-six bushings",
    section: "3.4.2, Table 3.4, Figs. 3.14 to 3.17, (3.15)–(3.19)",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const THICKNESS: f64 = 0.02;
/// D̄ and L̄ of Table 3.4.
const RATIOS: [f64; 6] = [1.0, 2.0, 4.0, 6.0, 8.0, 10.0];
/// C_R of Table 3.1, Pa.
const MODULUS: f64 = 0.647e6;
const FREQUENCY: f64 = 10.0;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let material = rubber(MODULUS, 1.0, ChainPull::FiveTerms)?;
    let shear = complex_factor(1.0, FREQUENCY) * (shear_over_modulus() * MODULUS);
    // By diameter, then by length.
    let mut stiffness = [[0.0; 6]; 6];
    let mut relaxed = [[0.0; 6]; 6];
    let mut damping = [[0.0; 6]; 6];
    let (mut gaps, mut losses) = (Vec::new(), Vec::new());
    let mut rows = Vec::new();
    for (i, d) in RATIOS.into_iter().enumerate() {
        for (j, l) in RATIOS.into_iter().enumerate() {
            let body = Bushing {
                inner_diameter: d * THICKNESS,
                thickness: THICKNESS,
                length: l * THICKNESS,
            };
            // Cells about as long around as across the wall, and longer along longer ones.
            let (around, axial) = ([12, 12, 20, 24, 28, 32][i], [3, 4, 4, 5, 6, 7][j]);
            let mesh = quarter(&body, [around, 6, axial], 1.8)?;
            let (model, _) = bonded(&mesh, material.clone(), Profile::Constant(1.0))?;
            let answers = complex_stiffness(&model, 0.0, &[0.0, TAU * FREQUENCY], 1e-6)?;
            let [still, moving] = [0, 1].map(|k: usize| {
                of_complex_stiffness(4.0 * answers[k].storage, 4.0 * answers[k].loss)
            });
            let inner = 0.5 * d * THICKNESS;
            let section = Section { inner, outer: inner + THICKNESS, length: l * THICKNESS };
            let exact = radial_stiffness(section, shear, BULK_RATIO * MODULUS, 5, 3);
            gaps.push((moving.dynamic_stiffness / exact.norm() - 1.0).abs());
            losses.push((moving.damping_ratio - exact.im / exact.norm()).abs());
            let scale = Scale {
                modulus: MODULUS,
                diameter: body.inner_diameter,
                length: body.length,
                thickness: THICKNESS,
            };
            stiffness[i][j] = scale.dynamic_stiffness(&moving);
            relaxed[i][j] = scale.dynamic_stiffness(&still);
            damping[i][j] = moving.damping_ratio;
            rows.push(vec![
                scale.diameter_ratio().to_string(),
                scale.length_ratio().to_string(),
                format!("{:.3}", stiffness[i][j]),
                format!("{:+.2}", 100.0 * (moving.dynamic_stiffness / exact.norm() - 1.0)),
                format!("{:.4}", damping[i][j]),
                format!("{:.4}", exact.im / exact.norm()),
            ]);
        }
    }
    context.table(
        "bushings",
        "At 10 Hz; K̄_d by (3.19), which divides by length and diameter",
        &["D̄", "L̄", "K̄_d", "from the oracle, %", "η_d", "oracle"],
        rows,
    );
    context.check(
        Check::new(
            "stiffness",
            "largest difference of a dynamic stiffness, over it",
            "1",
            largest(gaps),
        )
        .independent(0.0, "one Fourier component, polynomials of degree 5")
        .absolute(0.01, "singular corners")
        .golden(GoldenTolerance::MIXED),
    );
    context.check(
        Check::new("damping", "largest difference of a damping ratio", "1", largest(losses))
            .independent(0.0, "one Fourier component, polynomials of degree 5")
            .absolute(2e-3, "as of the stiffness, of which it is a part")
            .golden(GoldenTolerance::MIXED),
    );
    trends(context, &stiffness, &relaxed, &damping);
    figures(context, &stiffness, &damping)?;
    Ok(())
}

fn smallest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

fn trends(
    context: &mut CaseContext,
    stiffness: &[[f64; 6]; 6],
    relaxed: &[[f64; 6]; 6],
    damping: &[[f64; 6]; 6],
) {
    let steps = || (0..6).flat_map(|i| (0..5).map(move |j| (i, j)));
    let longer = smallest(steps().map(|(i, j)| stiffness[i][j + 1] / stiffness[i][j] - 1.0));
    context.check(
        Check::new("longer", "least rise of K̄_d from one length to the next", "1", longer)
            .stated(0.0, "3.4.2", "a longer bushing is stiffer")
            .at_least(0.0, "an order"),
    );
    let slope =
        |i: usize, j: usize| (stiffness[i][j + 1] - stiffness[i][j]) / (RATIOS[j + 1] - RATIOS[j]);
    let levelling = smallest((0..6).map(|i| slope(i, 1) - slope(i, 4)));
    context.check(
        Check::new(
            "levelling",
            "slope of K̄_d over L̄ from 2 to 4 less that from 8 to 10, at least",
            "1",
            levelling,
        )
        .stated(0.0, "3.4.2", "the stiffening falls off as the length grows")
        .at_least(0.0, "an order"),
    );
    let softer = relaxed[5][0] / relaxed[0][0];
    context.check(
        Check::new(
            "short",
            "relaxed K̄_d of the shortest bushing, widest over narrowest",
            "1",
            softer,
        )
        .stated(1.0, "3.4.2", "diameter softens short bushings")
        .at_most(0.0, "an order"),
    );
    let stiffer = relaxed[5][5] / relaxed[0][5];
    context.check(
        Check::new(
            "long",
            "relaxed K̄_d of the longest bushing, widest over narrowest",
            "1",
            stiffer,
        )
        .stated(1.0, "3.4.2", "diameter stiffens long bushings")
        .at_least(0.0, "an order"),
    );
    let by_length = smallest(steps().map(|(i, j)| damping[i][j] - damping[i][j + 1]));
    let by_diameter = smallest(steps().map(|(j, i)| damping[i][j] - damping[i + 1][j]));
    for (id, text, least) in
        [("damping_length", "length", by_length), ("damping_diameter", "diameter", by_diameter)]
    {
        context.check(
            Check::new(id, &format!("least fall of η_d from one {text} to the next"), "1", least)
                .stated(0.0, "3.4.2", "damping falls as diameter and length grow")
                .at_least(0.0, "an order"),
        );
    }
}

fn figures(
    context: &mut CaseContext,
    stiffness: &[[f64; 6]; 6],
    damping: &[[f64; 6]; 6],
) -> Result<(), CaseError> {
    let of = |values: &[[f64; 6]; 6], over_length: bool| -> Vec<Curve> {
        (0..6)
            .map(|k| {
                let at = |n: usize| if over_length { values[k][n] } else { values[n][k] };
                let name = if over_length { "D̄" } else { "L̄" };
                let points = (0..6).map(|n| [RATIOS[n], at(n)]).collect();
                Curve::new(format!("{name} = {}", RATIOS[k]), points)
            })
            .collect()
    };
    for (id, values, over_length, label, caption) in [
        ("fig_3_14", stiffness, true, "K̄_d", "As Fig. 3.14: dynamic stiffness over length, 10 Hz."),
        ("fig_3_15", damping, true, "η_d", "As Fig. 3.15: damping over length."),
        ("fig_3_16", stiffness, false, "K̄_d", "As Fig. 3.16: dynamic stiffness over diameter."),
        ("fig_3_17", damping, false, "η_d", "As Fig. 3.17: damping over diameter."),
    ] {
        let svg = xy(&XyPlot {
            title: format!("{label} at 10 Hz"),
            x: Axis::linear(if over_length { "L̄" } else { "D̄" }, "1"),
            y: Axis::linear(label, "1"),
            style: Style::Lines,
            curves: of(values, over_length),
        })?;
        context.figure(id, svg, caption);
    }
    Ok(())
}
