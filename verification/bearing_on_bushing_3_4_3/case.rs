//! The bearing of 3.4.3 on its bushing, from the shipped scene: hit by 500 N, and turning with an unbalance.

use std::f64::consts::{PI, TAU};

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use nalgebra::Complex;

use crate::bushings::{
    BEARING_ON_BUSHING, BULK_RATIO, MODULUS, complex_factor, shear_over_modulus,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{changed_scene, ran};
use crate::oracles::bonded_bushing::{Section, radial_stiffness};
use crate::oracles::misalignment::{TABLE_3_5, fitted};
use crate::oracles::swing::{Stiffness, TwoMasses};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "bearing_on_bushing_3_4_3",
    title: "Bearing on a rubber bushing, hit and unbalanced",
    section: "3.4.3, Tables 3.1, 3.5 and 3.6",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Pulse of the scene: N, s, and when it begins, s.
const HEIGHT: f64 = -500.0;
const DURATION: f64 = 0.5e-3;
const HIT: f64 = 20e-3;
/// Of the bushing, m.
const INNER_RADIUS: f64 = 35.5e-3;
const LENGTH: f64 = 20e-3;
/// 100 N at 1000 rpm.
const SPEED: f64 = 1000.0 / 60.0 * TAU;
const UNBALANCE: f64 = 9.12e-3;

struct Variant {
    id: &'static str,
    text: &'static str,
    /// m, Pa.
    thickness: f64,
    modulus: f64,
}

const VARIANTS: [Variant; 5] = [
    Variant { id: "h10", text: "H 10 mm", thickness: 10e-3, modulus: MODULUS },
    Variant { id: "h20", text: "H 20 mm", thickness: 20e-3, modulus: MODULUS },
    Variant { id: "h30", text: "H 30 mm", thickness: 30e-3, modulus: MODULUS },
    Variant { id: "soft", text: "H 10 mm, C_R halved", thickness: 10e-3, modulus: 0.5 * MODULUS },
    Variant { id: "hard", text: "H 10 mm, C_R doubled", thickness: 10e-3, modulus: 2.0 * MODULUS },
];

impl Variant {
    /// The shipped scene with these words changed.
    fn scene(&self, changes: &[(&str, &str)]) -> Result<AssemblyScene, CaseError> {
        let outer = format!("\"{} mm\"", 2e3 * (INNER_RADIUS + self.thickness));
        let rubber = format!("table = \"3.1\"\nrubber_modulus = \"{} MPa\"", 1e-6 * self.modulus);
        let own = [("\"91 mm\"", outer.as_str()), ("table = \"3.1\"", rubber.as_str())];
        let all: Vec<_> = own.iter().chain(changes).copied().collect();
        changed_scene(BEARING_ON_BUSHING, &all)
    }

    /// By the oracle, at a frequency in Hz.
    fn stiffness(&self, frequency: f64) -> Complex<f64> {
        let section =
            Section { inner: INNER_RADIUS, outer: INNER_RADIUS + self.thickness, length: LENGTH };
        let shear = complex_factor(1.0, frequency) * (shear_over_modulus() * self.modulus);
        radial_stiffness(section, shear, BULK_RATIO * self.modulus, 4, 2)
    }
}

/// Inner race and outer race with half of the balls each, and the bearing between them as it stands unloaded.
fn two_masses(assembly: &Assembly) -> TwoMasses {
    let mass = |side: usize| {
        let body = assembly.bearings[0].mounts[side].body;
        assembly.bodies[body].driven().map_or(f64::NAN, |race| race.inertia.mass)
    };
    let radius = TABLE_3_5.ball_radius;
    let balls = 8.0 * 4.0 / 3.0 * PI * radius.powi(3) * 7850.0;
    let bearing = TABLE_3_5.bearing(TABLE_3_5.stiffness(fitted), 0.0);
    let held = |z: f64| bearing.evaluate(&[0.0, 0.0, z, 0.0, 0.0]).1[2];
    let by = 1e-7;
    let between = (held(by) - held(-by)) / (2.0 * by);
    TwoMasses { masses: [mass(0) + 0.5 * balls, mass(1) + 0.5 * balls], between }
}

/// What is left to tell of a hit.
struct Hit {
    /// Time and reaction, s, N.
    course: Vec<[f64; 2]>,
    exact: Vec<[f64; 2]>,
    /// After the hit, until the reaction stays below 5 % of its peak, s.
    decay: f64,
    /// From the second time it changes its sign to the fourth, Hz.
    frequency: f64,
    peak: f64,
}

fn hit(context: &mut CaseContext, variant: &Variant) -> Result<Hit, CaseError> {
    let scene = variant.scene(&[("end = \"120 ms\"", "end = \"40 ms\"")])?;
    let columns = ran(&scene, &["time", "mount_force_z"])?;
    let masses = two_masses(&scene.assembly()?);
    let bushing = Stiffness::new(|f| variant.stiffness(f), 2.0, 20e3, 6.0);
    let after: Vec<[f64; 2]> = columns[0].iter().zip(&columns[1]).map(|(t, f)| [*t, *f]).collect();
    let after: Vec<[f64; 2]> = after.into_iter().filter(|[t, _]| *t >= HIT).collect();
    let times: Vec<f64> = after.iter().map(|[t, _]| t - HIT).collect();
    let force = masses.force_after_pulse(&bushing, [HEIGHT, DURATION], &times, [0.5, 20e3]);
    let exact: Vec<[f64; 2]> = after.iter().zip(&force).map(|([t, _], f)| [*t, *f]).collect();
    let peak = largest(force.iter().map(|f| f.abs()));
    let apart = largest(after.iter().zip(&force).map(|([_, ours], f)| (ours - f).abs() / peak));
    context.check(
        Check::new(
            &format!("reaction_{}", variant.id),
            &format!("largest difference of the reaction after the hit over its peak, {}", variant.text),
            "1",
            apart,
        )
        .independent(0.0, "two masses on the complex stiffness of degree 4, by the spectrum of the pulse")
        .under("pulse")
         .absolute(0.03, "the bearing between the masses stiffens under 500 N, which the spectrum leaves out, and the bushing has its mesh; 1.7 % on the stiffest one")
        .golden(GoldenTolerance::MIXED),
    );
    let loud = after.iter().rev().find(|[_, f]| f.abs() > 0.05 * peak);
    let decay = loud.map_or(f64::NAN, |[t, _]| t - HIT);
    let crossings: Vec<f64> = after
        .windows(2)
        .filter(|pair| pair[0][0] > HIT && pair[0][1] * pair[1][1] < 0.0)
        .map(|pair| {
            let [[t, f], [next, g]] = [pair[0], pair[1]];
            t + (next - t) * f / (f - g)
        })
        .collect();
    let frequency = match crossings[..] {
        [_, second, _, fourth, ..] => 1.0 / (fourth - second),
        _ => f64::NAN,
    };
    Ok(Hit { course: after, exact, decay, frequency, peak })
}

/// Radius of the inner race's orbit in its last turn, m.
fn orbit(context: &mut CaseContext, variant: &Variant) -> Result<f64, CaseError> {
    let scene = variant.scene(&[
        (
            "{ half_sine = \"-500 N\", base = \"0 N\", start = \"20 ms\", duration = \"0.5 ms\" }",
            "\"0 N\"",
        ),
        ("speed = \"1000 rpm\"", "speed = \"1000 rpm\"\nunbalance = \"9.12e-3 kg m\""),
        ("end = \"120 ms\"", "end = \"240 ms\""),
        ("output_interval = \"0.1 ms\"", "output_interval = \"1 ms\""),
    ])?;
    let columns = ran(&scene, &["time", "inner_y", "inner_z"])?;
    // First harmonic of the last turn of 60 ms.
    let (mut sum, mut rows) = (Complex::new(0.0, 0.0), 0.0);
    for row in (0..columns[0].len()).filter(|row| columns[0][*row] > 0.1805) {
        let place = Complex::new(columns[1][row], columns[2][row]);
        sum += place * Complex::new(0.0, -SPEED * columns[0][row]).exp();
        rows += 1.0;
    }
    let bushing = variant.stiffness(SPEED / TAU);
    let masses = two_masses(&scene.assembly()?);
    let exact = (UNBALANCE * SPEED * SPEED * masses.receptance(bushing, SPEED / TAU)[0]).norm();
    let radius = sum.norm() / rows;
    context.check(
        Check::new(
            &format!("orbit_{}", variant.id),
            &format!("radius of the inner race's orbit, {}", variant.text),
            "m",
            radius,
        )
        .independent(
            exact,
            "unbalance over the dynamic stiffness of two masses on the oracle's bushing",
        )
        .relative(0.02, "1 % mesh error of the bushing and the transient left after three turns")
        .golden(GoldenTolerance::MIXED),
    );
    Ok(radius)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for assumption in &VARIANTS[0].scene(&[])?.common().assumptions {
        context.assumption(&assumption.name, &assumption.text, "scenes/bearing_on_bushing.toml");
    }
    let hits =
        VARIANTS.iter().map(|variant| hit(context, variant)).collect::<Result<Vec<_>, _>>()?;
    let row = |(variant, hit): (&Variant, &Hit)| {
        let Hit { decay, frequency, peak, .. } = hit;
        let ms = format!("{:.2}", 1e3 * decay);
        vec![variant.text.into(), format!("{peak:.1}"), ms, format!("{frequency:.0}")]
    };
    context.table(
        "hits",
        "Reaction of the bushing after the hit",
        &["bushing", "peak, N", "below 5 % after, ms", "oscillation, Hz"],
        VARIANTS.iter().zip(&hits).map(row).collect(),
    );
    let [h10, h20, h30, soft, hard] = &hits[..] else { return Ok(()) };
    let faster = "the reaction dies out faster on a thinner bushing";
    let higher = "a thin bushing's reaction oscillates at a higher frequency";
    let alike = "a stiffer rubber does the same as a thinner bushing";
    let orders = [
        ("faster_10", "decay on 20 mm over that on 10 mm", h20.decay / h10.decay, faster),
        ("faster_20", "decay on 30 mm over that on 20 mm", h30.decay / h20.decay, faster),
        (
            "higher_10",
            "frequency on 10 mm over that on 20 mm",
            h10.frequency / h20.frequency,
            higher,
        ),
        (
            "higher_20",
            "frequency on 20 mm over that on 30 mm",
            h20.frequency / h30.frequency,
            higher,
        ),
        ("faster_hard", "decay at C_R over that at 2 C_R", h10.decay / hard.decay, alike),
        ("faster_soft", "decay at ½ C_R over that at C_R", soft.decay / h10.decay, alike),
    ];
    for (id, text, ratio, sentence) in orders {
        context.check(
            Check::new(id, text, "1", ratio)
                .stated(1.0, "3.4.3", sentence)
                .at_least(0.0, "an order"),
        );
    }
    let radii = VARIANTS[..3]
        .iter()
        .map(|variant| orbit(context, variant))
        .collect::<Result<Vec<_>, _>>()?;
    let wider = "a thinner bushing leaves a smaller orbit";
    for (id, text, ratio) in [
        ("wider_20", "orbit on 20 mm over that on 10 mm", radii[1] / radii[0]),
        ("wider_30", "orbit on 30 mm over that on 20 mm", radii[2] / radii[1]),
    ] {
        context.check(
            Check::new(id, text, "1", ratio).stated(1.0, "3.4.3", wider).at_least(0.0, "an order"),
        );
    }
    steel(context)?;
    figure(context, &hits)
}

/// What is left of the contact force a tenth of a second after the hit, with rubber and with a fixed race.
fn steel(context: &mut CaseContext) -> Result<(), CaseError> {
    let cut = BEARING_ON_BUSHING
        .find("[spring.mount]")
        .zip(BEARING_ON_BUSHING.find("[traction]"))
        .ok_or_else(|| CaseError::message("no bushing in the scene"))?;
    let springs = &BEARING_ON_BUSHING[cut.0..cut.1];
    let fixed = BEARING_ON_BUSHING
        .replace(springs, "")
        .replace("motion = \"5-dof\"\nspeed = \"0 rpm\"", "motion = \"fixed\"");
    let fixed = changed_scene(&fixed, &[])?;
    let mut left = Vec::new();
    for scene in [VARIANTS[0].scene(&[])?, fixed] {
        let columns = ran(&scene, &["time", "contact_force_on_outer_z"])?;
        let of = |from: f64, to: f64| {
            let rows = (0..columns[0].len()).filter(|row| (from..to).contains(&columns[0][*row]));
            let forces: Vec<f64> = rows.map(|row| columns[1][row]).collect();
            let mean = forces.iter().sum::<f64>() / forces.len() as f64;
            largest(forces.iter().map(|force| (force - mean).abs()))
        };
        left.push(of(0.11, 0.12) / of(0.02, 0.025));
    }
    context.check(
        Check::new(
            "left",
            "force 0.1 s after the hit over its peak, rubber over fixed",
            "1",
            left[0] / left[1],
        )
        .stated(
            0.0,
            "2.4.3",
            "rubber takes the oscillation to nearly zero in 0.1 s, steel lets it go on",
        )
        .absolute(0.2, "\"nearly zero\", read as a fifth"),
    );
    Ok(())
}

fn figure(context: &mut CaseContext, hits: &[Hit]) -> Result<(), CaseError> {
    let points = |course: &[[f64; 2]]| -> Vec<[f64; 2]> {
        course
            .iter()
            .filter(|[t, _]| *t < HIT + 10e-3)
            .map(|[t, f]| [1e3 * (t - HIT), *f])
            .collect()
    };
    let mut curves = Vec::new();
    for (variant, hit) in VARIANTS[..3].iter().zip(hits) {
        curves.push(Curve::new(variant.text, points(&hit.course)));
        curves.push(Curve::new(format!("{}, by its spectrum", variant.text), points(&hit.exact)));
    }
    let svg = xy(&XyPlot {
        title: "Reaction of the bushing after 500 N for 0.5 ms".into(),
        x: Axis::linear("time after the hit", "ms"),
        y: Axis::linear("force on the outer race", "N"),
        style: Style::Lines,
        curves,
    })?;
    context.figure(
        "reaction",
        svg,
        "As in Fig. 3.20: thinner bushings oscillate faster and settle sooner.",
    );
    Ok(())
}
