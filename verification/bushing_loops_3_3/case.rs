//! Loops of a bonded bushing at finite amplitude in implicit steps: three frequencies, three amplitudes, and a
//! staircase beside the relaxed curve.

use std::f64::consts::{FRAC_PI_2, TAU};

use bearing_dynamics::ch2_housing::elastomer::Elastomer;
use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch3_bushing::hysteresis::{Hysteresis, of_loop};
use bearing_dynamics::ch3_bushing::similitude::Scale;
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::steps::Stepping;

use crate::bushings::{
    BUSHING_3_3, MAXWELL, MODULUS, Moved, SteadyLoop, bonded, exact, of_quarter, order, quarter,
    rubber, rubber_of_3_3, steady_loop,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;

pub const CASE: Case = Case {
    id: "bushing_loops_3_3",
    title: "Bonded bushing: loops and a staircase at finite amplitude",
    section: "3.3.1 and 3.3.2, Figs. 3.7 to 3.10, (3.13), (3.14)",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const CELLS: [usize; 3] = [12, 4, 4];
const GRADING: f64 = 1.6;
/// Of the staircase: finer meshes, and those that crowd at the free edges, lose stability there at 3 to 4 mm.
const COARSE: ([usize; 3], f64) = ([8, 4, 3], 1.0);
const FREQUENCIES: [f64; 3] = [1.0, 5.0, 10.0];
/// m.
const AMPLITUDES: [f64; 3] = [1e-3, 2e-3, 4e-3];
/// Steps a cycle.
const PER: usize = 48;
/// By how much ours is above the printed K_d and η_d at 1, 5 and 10 Hz.
const ABOVE: [[f64; 2]; 3] = [[0.358, 1.932], [0.483, 1.471], [0.525, 1.367]];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let mesh = quarter(&BUSHING_3_3, CELLS, GRADING)?;
    let material = rubber_of_3_3(context)?;
    let fast = frequencies(context, &mesh, &material)?;
    let slow = amplitudes(context, &mesh, &material, &fast)?;
    staircase(context, &quarter(&BUSHING_3_3, COARSE.0, COARSE.1)?, &material, slow)?;
    fitted(context, &mesh)?;
    Ok(())
}

fn read(of: &SteadyLoop) -> Result<Hysteresis, CaseError> {
    of_loop(&of.points).ok_or_else(|| CaseError::message("a loop without displacement or force"))
}

/// In mm and kN.
fn curve(name: String, of: &SteadyLoop) -> Curve {
    let closed = of.points.iter().chain(of.points.first());
    Curve::new(name, closed.map(|[x, f]| [1e3 * x, 1e-3 * f]).collect())
}

/// Loops of 1 mm; that of 1 Hz is handed on.
fn frequencies(
    context: &mut CaseContext,
    mesh: &TetMesh,
    material: &Elastomer,
) -> Result<SteadyLoop, CaseError> {
    let (unit, _) = bonded(mesh, material.clone(), Profile::Constant(1.0))?;
    let linear = complex_stiffness(&unit, 0.0, &FREQUENCIES.map(|f| TAU * f), 1e-6)?;
    let mut curves = Vec::new();
    let mut rows = Vec::new();
    let mut found = Vec::new();
    let mut first = None;
    for (k, frequency) in FREQUENCIES.into_iter().enumerate() {
        let moved = steady_loop(mesh, material.clone(), AMPLITUDES[0], frequency, PER)?;
        let (ours, small) = (read(&moved)?, of_quarter(&linear[k]));
        let oracle = exact(&BUSHING_3_3, 1.0, frequency, 6);
        one_frequency(context, k, ours, small, oracle);
        rows.push(vec![
            frequency.to_string(),
            format!("{:.4e}", ours.dynamic_stiffness),
            format!("{:.4e}", small.dynamic_stiffness),
            format!("{:.4e}", oracle.dynamic_stiffness),
            format!("{:.4}", ours.damping_ratio),
            format!("{:.4}", small.damping_ratio),
            format!("{:.4}", oracle.damping_ratio),
        ]);
        curves.push(curve(format!("{frequency} Hz"), &moved));
        context.work(&format!("steps of two cycles at {frequency} Hz"), moved.steps);
        found.push(ours);
        first.get_or_insert(moved);
    }
    context.table(
        "frequencies",
        "Steady loops: of 1 mm in steps, of small amplitude on the same mesh, of small amplitude by the oracle",
        &["Hz", "K_d, N/m", "small", "oracle", "η_d", "small", "oracle"],
        rows,
    );
    // The step in tan δ = (2/π) d(ln K)/d(ln ω): a rubber of this damping is stiffer by that much at ten times the frequency.
    let decade = |damping: f64| 10f64.powf(damping.asin() / FRAC_PI_2);
    let rise = found[2].dynamic_stiffness / found[0].dynamic_stiffness;
    context.check(
        Check::new("power_law", "rise of K_d from 1 to 10 Hz", "1", rise)
            .consistency(decade(found[1].damping_ratio), "our rise against the power law of our damping ratio at 5 Hz, K ∝ ω^((2/π) asin η)")
            .relative(0.03, "relaxation times of Table 3.1 stand four to a factor of ten and are not of one strength"),
    );
    let higher = found.windows(2).map(|w| w[1].dynamic_stiffness / w[0].dynamic_stiffness - 1.0);
    let lower = found.windows(2).map(|w| 1.0 - w[1].damping_ratio / w[0].damping_ratio);
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    order(
        context,
        "3.3.1 and 2.4.3",
        "stiffness grows with the frequency, damping falls slightly",
        &[
            (
                "stiffer",
                "least rise of K_d from one frequency to the next",
                least(&mut higher.into_iter()),
            ),
            (
                "less_damped",
                "least fall of η_d from one frequency to the next",
                least(&mut lower.into_iter()),
            ),
        ],
    );
    let caption = "As Fig. 3.7, with the rubber of Table 3.1: steady loops of 1 mm.";
    loops_figure(context, "fig_3_7", "Loops of 1 mm", curves, caption)?;
    first.ok_or_else(|| CaseError::message("no frequency"))
}

fn loops_figure(
    context: &mut CaseContext,
    id: &str,
    title: &str,
    curves: Vec<Curve>,
    caption: &str,
) -> Result<(), CaseError> {
    let svg = xy(&XyPlot {
        title: title.into(),
        x: Axis::linear("displacement", "mm"),
        y: Axis::linear("radial force", "kN"),
        style: Style::Lines,
        curves,
    })?;
    context.figure(id, svg, caption);
    Ok(())
}

fn one_frequency(
    context: &mut CaseContext,
    k: usize,
    ours: Hysteresis,
    small: Hysteresis,
    oracle: Hysteresis,
) {
    let frequency = FREQUENCIES[k];
    for (i, (part, text, unit, [ours, small, oracle])) in [
        ("kd", "dynamic stiffness", "N/m", [ours, small, oracle].map(|of| of.dynamic_stiffness)),
        ("eta", "damping ratio", "1", [ours, small, oracle].map(|of| of.damping_ratio)),
    ]
    .into_iter()
    .enumerate()
    {
        let id = format!("{part}_{frequency}");
        let [own, linear] = ["oracle", "linear"].map(|kind| format!("{id}_{kind}"));
        let text = format!("{text} at {frequency} Hz");
        context.check(
            Check::new(&linear, &format!("{text}, small amplitude"), unit, small)
                .independent(oracle, "one Fourier component, polynomials of degree 6")
                .under("rubber")
                .relative(8e-3, "what this mesh leaves: up to 0.6 % too soft in K_d, 0.7 % in η_d")
                .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(&own, &format!("{text}, steady loop of 1 mm"), unit, ours)
                .consistency(small, "a loop in implicit steps against the complex stiffness of the same mesh")
                .under("rubber")
                .relative(0.02, "1 mm of 8.35 mm: 1.3 % more at the tip (peak of a ramp 8679 N, linear 8565 N); 48 steps a cycle: 0.1 % of K_d, 0.6 % of η_d")
                .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(&id, &format!("{text}, steady loop of 1 mm"), unit, ours)
                .published(&id)
                .under("rubber")
                .relative(0.01, "three printed digits")
                .explained(Explanation::new(
                    "The rubber is another one, whose constants are not printed. No linear rubber has both printed columns: on a smooth \
                     spectrum a damping ratio of 0.07 goes with a rise of 11 % in stiffness a decade of frequency (check `power_law`), the most uneven one \
                     that keeps to the printed ratios has 14 %, and 17 % are printed; the rubber of Table 3.1's spectrum that has the three stiffnesses \
                     (table `fitted`) has a damping ratio of about 0.10.",
                    ABOVE[k][i],
                    0.015,
                    &[&own, &linear, "power_law", "fitted", "fitted_damping"],
                )),
        );
    }
}

/// Loops at 1 Hz of growing amplitude, and one at 0.1 Hz, which is handed on with the largest.
fn amplitudes(
    context: &mut CaseContext,
    mesh: &TetMesh,
    material: &Elastomer,
    one: &SteadyLoop,
) -> Result<[SteadyLoop; 2], CaseError> {
    let of = |k: usize| steady_loop(mesh, material.clone(), AMPLITUDES[k], 1.0, PER);
    let (two, four) = (of(1)?, of(2)?);
    let [a, b, c] = [read(one)?, read(&two)?, read(&four)?];
    let gains = [(a, b), (b, c)].map(|(a, b)| b.dynamic_stiffness / a.dynamic_stiffness - 1.0);
    context.table(
        "amplitudes",
        "Steady loops at 1 Hz",
        &["amplitude, mm", "K_d, N/m", "η_d"],
        AMPLITUDES
            .iter()
            .zip([a, b, c])
            .map(|(x, of)| {
                let (k, eta) = (of.dynamic_stiffness, of.damping_ratio);
                vec![format!("{}", 1e3 * x), format!("{k:.4e}"), format!("{eta:.4}")]
            })
            .collect(),
    );
    for (id, amplitude, of, moved) in [("kd_2mm", 2, b, &two), ("kd_4mm", 4, c, &four)] {
        context.golden(id, of.dynamic_stiffness, "N/m", GoldenTolerance::MIXED);
        context.work(&format!("steps of two cycles of {amplitude} mm"), moved.steps);
    }
    order(
        context,
        "3.3.2",
        "more linear at small displacement, clearly not so as it grows",
        &[
            ("two_stiffer", "rise of K_d from 1 to 2 mm", gains[0]),
            (
                "four_stiffer",
                "rise of K_d from 2 to 4 mm less that from 1 to 2 mm",
                gains[1] - gains[0],
            ),
        ],
    );
    let curves =
        vec![curve("1 mm".into(), one), curve("2 mm".into(), &two), curve("4 mm".into(), &four)];
    let caption = "As Fig. 3.8, with the rubber of Table 3.1.";
    loops_figure(context, "fig_3_8", "Loops at 1 Hz", curves, caption)?;
    let slow = steady_loop(mesh, material.clone(), AMPLITUDES[2], 0.1, PER)?;
    Ok([four, slow])
}

/// Up by 1 mm in 1 s and held for 14 s, five times; and the network alone.
fn staircase(
    context: &mut CaseContext,
    mesh: &TetMesh,
    material: &Elastomer,
    [fast, slow]: [SteadyLoop; 2],
) -> Result<(), CaseError> {
    const STAIRS: usize = 5;
    let mut points = vec![[0.0, 0.0]];
    for n in 0..STAIRS {
        let (t, x) = (15.0 * n as f64, 1e-3 * (n + 1) as f64);
        points.extend([[t + 1.0, x], [t + 15.0, x]]);
    }
    let (model, inner) = bonded(mesh, material.clone(), Profile::Table { points })?;
    let mut moved = Moved::new(&model, &inner, Stepping::Accuracy(1e-3))?;
    let mut course = vec![[0.0, 0.0]];
    let mut held = Vec::new();
    for n in 1..=STAIRS {
        held.push(moved.advance(15.0 * n as f64, &mut course)?);
    }
    context.work("steps of the staircase", moved.solid.counts.accepted);
    // No Maxwell elements: a second for each millimetre, whatever its length.
    let ramp = Profile::Ramp { from: 0.0, to: 5e-3, start: 0.0, duration: 5.0 };
    let alone = Elastomer { maxwell: Vec::new(), ..material.clone() };
    let (model, inner) = bonded(mesh, alone, ramp)?;
    let mut still = Moved::new(&model, &inner, Stepping::Fixed(0.5))?;
    let mut relaxed = vec![[0.0, 0.0]];
    let ends = (1..=STAIRS).map(|n| still.advance(n as f64, &mut relaxed));
    let ends = ends.collect::<Result<Vec<f64>, _>>()?;
    let rows = (0..STAIRS).map(|n| {
        let ratio = held[n] / ends[n];
        let estimate = left(n + 1);
        vec![
            (n + 1).to_string(),
            format!("{:.0}", held[n]),
            format!("{:.0}", ends[n]),
            format!("{ratio:.4}"),
            format!("{estimate:.4}"),
        ]
    });
    context.table(
        "staircase",
        "Force after 14 s of rest, and of the relaxed network",
        &["mm", "held, N", "relaxed, N", "ratio", "linear estimate"],
        rows.collect(),
    );
    context.check(
        Check::new(
            "held_1mm",
            "force after 14 s at 1 mm over the relaxed one",
            "1",
            held[0] / ends[0],
        )
        .closed_form(left(1), "what the elements of Table 3.1 have left of a step, at small strain")
        .under("rubber")
        .absolute(
            0.01,
            "stiffness falls short of proportion to the shear modulus, volume being held alike",
        )
        .golden(GoldenTolerance::MIXED),
    );
    context.golden("held_5mm", held[STAIRS - 1] / ends[STAIRS - 1], "1", GoldenTolerance::MIXED);
    let most = held.iter().zip(&ends).map(|(held, end)| held / end - 1.0).fold(0.0, f64::max);
    context.finding(
        "not_relaxed",
        format!(
            "3.3.2 takes the force after 14 s of rest for the relaxed one. With the rubber of Table 3.1 11 % are still to go at 1 mm, by every mesh, and \
             {:.0} % at 5 mm on this one: held on, the force there falls with a time of some 120 s, not the slowest element's 10 s, as a confined body \
             near the loss of its relaxed stability does. At 4 and 5 mm the number is the mesh's (1.10 to 1.16 on three), not the rubber's.",
            100.0 * most
        ),
    );
    context.finding(
        "free_edges",
        "On meshes of six cells across the wall or crowded at the free edges the relaxed network loses stability at 3.0 to 3.8 mm (the stiffness is no longer \
         positive definite): rubber folds at the pressed edges. The staircase is on eight by four by three even cells, up to 2 % stiffer than the finer ones up to there.",
    );
    let secant = |force: f64, x: f64| force / x;
    let bends = (1..STAIRS).map(|n| {
        let of = |n: usize| secant(ends[n], (n + 1) as f64);
        of(n) / of(n - 1) - 1.0
    });
    let bends: Vec<f64> = bends.collect();
    let least = bends.iter().copied().fold(f64::INFINITY, f64::min);
    order(
        context,
        "3.3.2",
        "the relaxed curve stiffens with displacement",
        &[(
            "relaxed_stiffens",
            "least rise of the relaxed secant stiffness from one millimetre to the next",
            least,
        )],
    );
    let tip = |of: &SteadyLoop| read(of).map(|of| of.dynamic_stiffness);
    let (at_four, of_relaxed) = ([tip(&fast)?, tip(&slow)?], secant(ends[3], 4e-3));
    order(
        context,
        "3.3.2",
        "a higher rate makes the loop steeper",
        &[
            (
                "rate",
                "K_d of 4 mm at 1 Hz over that at 0.1 Hz, less one",
                at_four[0] / at_four[1] - 1.0,
            ),
            (
                "rate_relaxed",
                "K_d of 4 mm at 0.1 Hz over the relaxed secant, less one",
                at_four[1] / of_relaxed - 1.0,
            ),
        ],
    );
    figure(context, &[("1 Hz", &fast), ("0.1 Hz", &slow)], &relaxed, &held)
}

/// What is left of the Maxwell elements 14 s after the last of n equal steps of 1 s, over the network, plus one.
fn left(n: usize) -> f64 {
    let of = |[gamma, tau]: &[f64; 2]| {
        let steps = (0..n).map(|m| (-(15.0 * m as f64 + 14.0) / tau).exp()).sum::<f64>();
        gamma * tau * -(-1.0 / tau).exp_m1() * steps
    };
    1.0 + MAXWELL.iter().map(of).sum::<f64>() / n as f64
}

fn figure(
    context: &mut CaseContext,
    loops: &[(&str, &SteadyLoop)],
    relaxed: &[[f64; 2]],
    held: &[f64],
) -> Result<(), CaseError> {
    let scale = Scale {
        modulus: MODULUS,
        diameter: BUSHING_3_3.inner_diameter,
        length: BUSHING_3_3.length,
        thickness: BUSHING_3_3.thickness,
    };
    let mut curves: Vec<Curve> = loops
        .iter()
        .map(|(name, of)| {
            let closed = of.points.iter().chain(of.points.first());
            Curve::new(*name, closed.map(|[x, f]| [1e3 * x, scale.force(*f)]).collect())
        })
        .collect();
    let line = relaxed.iter().map(|[t, f]| [*t, scale.force(*f)]).collect();
    curves.push(Curve::new("relaxed", line));
    let steps = held.iter().enumerate().map(|(n, f)| [(n + 1) as f64, scale.force(*f)]);
    curves.push(Curve::separate("after 14 s", steps.collect()));
    let svg = xy(&XyPlot {
        title: "Loops of 4 mm and the relaxed curve".into(),
        x: Axis::linear("displacement", "mm"),
        y: Axis::linear("force over C_R L D", "1"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("fig_3_10", svg, "As Fig. 3.10, with the rubber of Table 3.1: loops follow the relaxed curve, the steeper the faster.");
    Ok(())
}

/// A rubber whose C_R and one factor of all γ of Table 3.1 were chosen for the three printed stiffnesses.
fn fitted(context: &mut CaseContext, mesh: &TetMesh) -> Result<(), CaseError> {
    const MODULUS_FITTED: f64 = 1.079e6;
    const GAMMAS_FITTED: f64 = 0.112;
    let material = rubber(MODULUS_FITTED, GAMMAS_FITTED, ChainPull::FiveTerms)?;
    let (model, _) = bonded(mesh, material, Profile::Constant(1.0))?;
    let answers = complex_stiffness(&model, 0.0, &FREQUENCIES.map(|f| TAU * f), 1e-6)?;
    let found = answers.iter().map(of_quarter).collect::<Vec<_>>();
    let rows = FREQUENCIES.iter().zip(&found).map(|(frequency, of)| {
        vec![
            frequency.to_string(),
            format!("{:.3e}", of.dynamic_stiffness),
            format!("{:.4}", of.damping_ratio),
        ]
    });
    let title =
        "C_R = 1.079 MPa and γ of Table 3.1 times 0.112, chosen for the three printed stiffnesses";
    context.table("fitted", title, &["Hz", "K_d, N/m", "η_d"], rows.collect());
    let least = found.iter().map(|of| of.damping_ratio).fold(f64::INFINITY, f64::min);
    context.check(
        Check::new("fitted_damping", "least damping ratio of the fitted rubber", "1", least)
            .consistency(
                (FRAC_PI_2 * (found[2].dynamic_stiffness / found[0].dynamic_stiffness).log10())
                    .sin(),
                "its damping against the power law of its own rise from 1 to 10 Hz",
            )
            .relative(0.12, "least of three, over a decade in which it changes by a tenth"),
    );
    Ok(())
}
