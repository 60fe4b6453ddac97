//! Bushing of 3.4.1 at small amplitude: five rubbers at two frequencies against polynomials of high
//! degree, and beside them what linear tetrahedra make of it.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch3_bushing::hysteresis::Hysteresis;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::sleeve::SleeveMotion;

use crate::bushings::{
    BUSHING, MODULUS, bonded, complex_factor, exact, four_nodes, of_quarter, quarter, rubber,
    shear_over_modulus,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;

pub const CASE: Case = Case {
    id: "bushing_materials_3_4_1",
    title: "Bushing of 3.4.1: stiffness and damping of five rubbers",
    section: "3.4.1, Tables 3.1 to 3.3, (3.13), (3.14)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const FREQUENCIES: [(f64, &str); 2] = [(0.1, "0p1"), (10.0, "10")];
const CELLS: [usize; 3] = [12, 6, 4];
const GRADING: f64 = 2.0;

/// Of the oracle's polynomials, and one more for the relaxed stiffness.
const DEGREE: usize = 5;

/// Factors of C_R and γ, and by how much ours is above Table 3.3: K_d and η_d at both frequencies.
struct Row {
    id: &'static str,
    modulus: f64,
    gammas: f64,
    above: [f64; 4],
}

/// The first is the rubber of Table 3.1, with which those of another C_R are compared.
const ROWS: [Row; 5] = [
    Row { id: "cr", modulus: 1.0, gammas: 1.0, above: [0.047, 1.847, 0.695, 0.574] },
    Row { id: "2cr", modulus: 2.0, gammas: 1.0, above: [0.047, 1.847, 0.696, 0.594] },
    Row { id: "half_cr", modulus: 0.5, gammas: 1.0, above: [0.048, 1.847, 0.690, 0.554] },
    Row { id: "2g", modulus: 1.0, gammas: 2.0, above: [0.387, 1.079, 0.934, 0.262] },
    Row { id: "half_g", modulus: 1.0, gammas: 0.5, above: [-0.178, 2.723, 0.377, 1.092] },
];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let mesh = quarter(&BUSHING, CELLS, GRADING)?;
    let still = exact(&BUSHING, 0.0, 0.0, DEGREE + 1).dynamic_stiffness;
    let both =
        |gammas| FREQUENCIES.map(|(frequency, _)| exact(&BUSHING, gammas, frequency, DEGREE));
    let of_table = both(1.0);
    let mut table = Vec::new();
    let mut first: Option<[Hysteresis; 2]> = None;
    let mut ellipses = [Vec::new(), Vec::new()];
    for row in &ROWS {
        let exact = if row.gammas == 1.0 { of_table } else { both(row.gammas) };
        let material = rubber(row.modulus * MODULUS, row.gammas, ChainPull::FiveTerms)?;
        let (model, _) = bonded(&mesh, material, Profile::Constant(1.0))?;
        let pulsations = [0.0, TAU * FREQUENCIES[0].0, TAU * FREQUENCIES[1].0];
        let answers = complex_stiffness(&model, 0.0, &pulsations, 1e-6)?;
        let both = [1, 2].map(|k: usize| of_quarter(&answers[k]));
        if first.is_none() {
            relaxed(context, of_quarter(&answers[0]).dynamic_stiffness, still);
            context.work("unknowns", model.unknowns.count as u64);
        }
        let reference = *first.get_or_insert(both);
        for k in 0..2 {
            let ours = both[k];
            checks(context, row, k, ours, exact[k], reference[k]);
            let oracle = row.modulus * exact[k].dynamic_stiffness;
            table.push(vec![
                row.id.to_string(),
                FREQUENCIES[k].0.to_string(),
                format!("{:.5e}", ours.dynamic_stiffness),
                format!("{oracle:.5e}"),
                format!("{:.5}", ours.damping_ratio),
                format!("{:.5}", exact[k].damping_ratio),
            ]);
            let [storage, loss] = [answers[k + 1].storage, answers[k + 1].loss];
            // 1 mm, in kN.
            let at =
                |phase: f64| [phase.sin(), 4e-6 * (storage * phase.sin() + loss * phase.cos())];
            let points = (0..=100).map(|n| at(TAU * f64::from(n) / 100.0)).collect();
            ellipses[k].push(Curve::new(row.id, points));
        }
    }
    for (curves, (id, frequency)) in
        ellipses.into_iter().zip([("fig_3_11", 0.1), ("fig_3_12", 10.0)])
    {
        let svg = xy(&XyPlot {
            title: format!("Steady cycles at {frequency} Hz"),
            x: Axis::linear("displacement", "mm"),
            y: Axis::linear("radial force", "kN"),
            style: Style::Lines,
            curves,
        })?;
        context.figure(
            id,
            svg,
            "As Figs. 3.11 and 3.12, of a bushing that is linear: loops are ellipses.",
        );
    }
    context.table(
        "rubbers",
        "Steady cycles of small amplitude: ours and the oracle",
        &["rubber", "Hz", "K_d, N/m", "oracle", "η_d", "oracle"],
        table,
    );
    meshes(context, still)?;
    locked(context, &of_table)?;
    Ok(())
}

const ORIGIN: &str = "one Fourier component, polynomials of degree 5";
const ORIGIN_FINE: &str = "one Fourier component, polynomials of degree 6";

fn relaxed(context: &mut CaseContext, ours: f64, fine: f64) {
    let reason = "mesh error 0.35 %; halved on the next finer mesh of the table";
    context.check(
        Check::new("static_oracle", "relaxed radial stiffness", "N/m", ours)
            .independent(fine, ORIGIN_FINE)
            .relative(4e-3, reason)
            .golden(GoldenTolerance::MIXED),
    );
    context.check(
        Check::new("static_others", "relaxed radial stiffness", "N/m", ours)
            .independent(9.3155e5, "two locking-free codes by others, 0.2 % apart")
            .relative(4e-3, reason),
    );
    context.check(
        Check::new(
            "oracle_converged",
            "relaxed stiffness of the oracle by degree 5",
            "N/m",
            exact(&BUSHING, 0.0, 0.0, DEGREE).dynamic_stiffness,
        )
        .converged(fine, "degree 6")
        .relative(5e-5, "error of the last layer at the singular corners, 2e-5"),
    );
}

/// Of one rubber at one frequency. The oracle's stiffness is proportional to C_R by construction, so that it is asked
/// for the rubbers of another γ alone; of another C_R it is our own proportion that is checked.
fn checks(
    context: &mut CaseContext,
    row: &Row,
    k: usize,
    ours: Hysteresis,
    exact: Hysteresis,
    reference: Hysteresis,
) {
    let (frequency, key) = FREQUENCIES[k];
    let parts = [
        (
            ("kd", "dynamic stiffness", "N/m"),
            [ours.dynamic_stiffness, exact.dynamic_stiffness, reference.dynamic_stiffness],
            (row.modulus, 4e-3),
        ),
        (
            ("eta", "damping ratio", "1"),
            [ours.damping_ratio, exact.damping_ratio, reference.damping_ratio],
            (1.0, 5e-3),
        ),
    ];
    for (i, ((part, name, unit), [ours, exact, reference], (proportion, tolerance))) in
        parts.into_iter().enumerate()
    {
        let (id, text) =
            (format!("{part}_{}_{key}", row.id), format!("{name}, {}, {frequency} Hz", row.id));
        let own = if row.modulus == 1.0 {
            let own = format!("{id}_oracle");
            context.check(
                Check::new(&own, &text, unit, ours)
                    .independent(exact, ORIGIN)
                    .relative(tolerance, "mesh error: up to 0.36 % of K_d, 0.41 % of η_d")
                    .golden(GoldenTolerance::MIXED),
            );
            own
        } else {
            let own = format!("{id}_proportion");
            let of = format!("{text}, over that of C_R");
            context.check(
                Check::new(&own, &of, "1", ours / reference)
                    .consistency(proportion, "both solved; every modulus is proportional to C_R")
                    .absolute(1e-9, "rounding of solves, and vectors that settle to 1e-6"),
            );
            own
        };
        let because = "The stated inputs do not give Table 3.3. Its numbers follow a body of which a part of the stiffness neither stiffens with the \
                       frequency nor loses energy, as if volume were held by more than the bulk modulus. Linear tetrahedra at B = 100 C_R err that way; which mesh made \
                       the printed numbers is not known.";
        let evidence = [own.as_str(), "locked_damping", "locked_rise"];
        context.check(
            Check::new(&id, &text, unit, ours)
                .published(&id)
                .relative(0.01, "three printed digits")
                .explained(Explanation::new(because, row.above[2 * k + i], 0.005, &evidence)),
        );
    }
}

/// What finer meshes leave, for the record.
fn meshes(context: &mut CaseContext, exact: f64) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    let mut errors = Vec::new();
    for cells in [[6, 4, 2], [8, 4, 3], CELLS, [16, 8, 5]] {
        let mesh = quarter(&BUSHING, cells, GRADING)?;
        let (model, _) =
            bonded(&mesh, rubber(MODULUS, 0.0, ChainPull::FiveTerms)?, Profile::Constant(1.0))?;
        let k = 4.0 * complex_stiffness(&model, 0.0, &[0.0], 1e-6)?[0].storage;
        let error = k / exact - 1.0;
        errors.push(error);
        rows.push(vec![
            format!("{cells:?}"),
            model.unknowns.count.to_string(),
            format!("{:+.3}", 100.0 * error),
        ]);
    }
    context.table(
        "meshes",
        "Relaxed stiffness on four meshes against the oracle",
        &["cells around, across, along", "unknowns", "difference, %"],
        rows,
    );
    context.check(
        Check::new(
            "static_fine",
            "relaxed stiffness on the finest mesh, difference from the oracle",
            "1",
            errors.last().copied().unwrap_or(f64::NAN),
        )
        .independent(0.0, ORIGIN_FINE)
        .absolute(2e-3, "half of the mesh error of the other checks, 0.35 %")
        .golden(GoldenTolerance::MIXED),
    );
    Ok(())
}

/// Four-node elements at the shear moduli of both frequencies. A complex modulus of phase θ turns the
/// stiffness by θ times the slope of ln K over ln μ.
fn locked(context: &mut CaseContext, exact: &[Hysteresis; 2]) -> Result<(), CaseError> {
    let mu = shear_over_modulus() * MODULUS;
    let stiffness = |shear: f64| four_nodes(&BUSHING, [12, 4, 3], shear, SleeveMotion::Radial);
    let mut rows = Vec::new();
    let mut read = Vec::new();
    for ((frequency, _), exact) in FREQUENCIES.into_iter().zip(*exact) {
        let g = complex_factor(1.0, frequency);
        let (size, phase) = (g.norm(), g.im.atan2(g.re));
        let k = stiffness(mu * size)?;
        let slope = (stiffness(1.05 * mu * size)? / k).ln() / 1.05f64.ln();
        let damping = (phase * slope).sin();
        read.push((k, damping, exact));
        rows.push(vec![
            frequency.to_string(),
            format!("{k:.3e}"),
            format!("{:.3e}", exact.dynamic_stiffness),
            format!("{damping:.3}"),
            format!("{:.3}", exact.damping_ratio),
        ]);
    }
    context.table(
        "four_nodes",
        "Four-node elements of 5 to 8 mm and the converged solution",
        &["Hz", "K_d, N/m", "converged", "η_d", "converged"],
        rows,
    );
    let [slow, fast] = [&read[0], &read[1]];
    context.check(
        Check::new(
            "locked_damping",
            "damping ratio of four-node elements at 0.1 Hz, over the converged one",
            "1",
            slow.1 / slow.2.damping_ratio,
        )
        .converged(1.0, "the oracle's damping")
        .at_most(0.25, "a good part of the stiffness is that of volume, which loses nothing; more of it on coarser meshes"),
    );
    context.check(
        Check::new(
            "locked_rise",
            "rise of stiffness from 0.1 to 10 Hz of four-node elements, over the converged rise",
            "1",
            fast.0 / slow.0 / (fast.2.dynamic_stiffness / slow.2.dynamic_stiffness),
        )
        .converged(1.0, "the oracle's rise")
        .at_most(0.1, "volume does not stiffen with the frequency"),
    );
    Ok(())
}
