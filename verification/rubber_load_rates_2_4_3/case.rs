//! Rates of load on a bearing in a rubber bushing, from the shipped scene: 30 s of creep, and less viscous stress.

use bearing_dynamics::assembly::lists::OUTER;
use bearing_dynamics::equilibrium::initial::at_start;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use nalgebra::Complex;

use crate::bushings::{BULK_RATIO, CREEP_ON_RUBBER, MAXWELL, diluted, shear_over_modulus};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::motion::{changed_scene, ran};
use crate::oracles::bonded_bushing::{Section, radial_stiffness};
use crate::oracles::creep::OnBushing;
use crate::oracles::misalignment::{TABLE_3_5, fitted};
use crate::oracles::statics::Known;
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "rubber_load_rates_2_4_3",
    title: "Rubber bushing under three rates of load",
    section: "2.4.3, Tables 2.2, 2.3 and 3.1",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const LOAD: f64 = 250.0;
/// Of the scene, s: of its ramp and its end.
const SHIPPED: &str = "duration = \"0.5 s\"";
const END: &str = "end = \"30 s\"";
const RATES: [Rate; 3] = [
    Rate { id: "0p1", text: "250 N in 0.1 s", duration: 0.1 },
    Rate { id: "0p5", text: "250 N in 0.5 s", duration: 0.5 },
    Rate { id: "2", text: "250 N in 2 s", duration: 2.0 },
];
/// Until almost nothing creeps any more, s.
const LONG: f64 = 75.0;
/// Displacements that differ by less than this part of them are the same.
const SAME: f64 = 0.005;
/// Parts of the viscous stress, per cent, and of a sudden load the duration, s, and the end of its run.
const SHARES: [u32; 4] = [10, 25, 50, 100];
const SUDDEN: f64 = 1e-3;
const SUDDEN_END: f64 = 0.1;
/// Of the bushing of the scene, m and Pa (Table 2.3).
const SECTION: Section = Section { inner: 35.527e-3, outer: 49.738e-3, length: 20e-3 };
const MODULUS: f64 = 0.324e6;
/// Cells of the bushing for what a mesh leaves: those of the scene, 16 x 4 x 4, are the default.
const FINER: (&str, &str) =
    ("table = \"2.3\"", "table = \"2.3\"\ncells = { around = 20, radial = 6, axial = 5 }");
/// Polynomials and shrinking rectangles of the oracle: enough for 0.1 %.
const DEGREE: usize = 4;
const LAYERS: i32 = 2;
/// Points of its contour: where it creeps, and where it swings.
const CREEPING: usize = 24;
const SWINGING: usize = 48;

struct Rate {
    id: &'static str,
    text: &'static str,
    duration: f64,
}

impl Rate {
    fn scene(&self, changes: &[(&str, &str)]) -> Result<AssemblyScene, CaseError> {
        let duration = format!("duration = \"{} s\"", self.duration);
        let mut all = vec![(SHIPPED, duration.as_str())];
        all.extend(changes);
        changed_scene(CREEP_ON_RUBBER, &all)
    }
}

/// How far the races have sunk under a load.
struct QuasiStaticSequence {
    times: Vec<f64>,
    /// m, downwards.
    outer: Vec<f64>,
    inner: Vec<f64>,
}

impl QuasiStaticSequence {
    fn of(scene: &AssemblyScene) -> Result<QuasiStaticSequence, CaseError> {
        let mut columns = ran(scene, &["time", "outer_z", "inner_z"])?;
        let down = |column: &mut Vec<f64>| column.iter().map(|z| -z).collect();
        let [times, outer, inner] = &mut columns[..] else {
            return Err(CaseError::message("three columns"));
        };
        Ok(QuasiStaticSequence {
            outer: down(outer),
            inner: down(inner),
            times: std::mem::take(times),
        })
    }

    /// Row nearest to a time.
    fn row(&self, time: f64) -> usize {
        let spacing = self.times[1] - self.times[0];
        ((time / spacing).round() as usize).min(self.times.len() - 1)
    }

    fn outer_at(&self, time: f64) -> f64 {
        self.outer[self.row(time)]
    }
}

/// Table 2.3's rubber with a part of the viscous stress, as the oracle has it: N/m at s, 1/s.
fn stiffness(share: f64) -> impl Fn(Complex<f64>) -> Complex<f64> {
    move |s| {
        let factor = MAXWELL.iter().fold(Complex::new(1.0, 0.0), |sum, [gamma, tau]| {
            sum + s * *tau / (s * *tau + 1.0) * (share * gamma)
        });
        let shear = factor * (shear_over_modulus() * MODULUS);
        radial_stiffness(SECTION, shear, BULK_RATIO * MODULUS, DEGREE, LAYERS)
    }
}

/// Outer and inner race under the load for good, m downwards.
fn relaxed(changes: &[(&str, &str)]) -> Result<[f64; 2], CaseError> {
    let given = "{ ramp = [\"0 N\", \"-250 N\"], duration = \"0.5 s\" }";
    let mut all = vec![(given, "\"-250 N\"")];
    all.extend(changes);
    let found = at_start(&changed_scene(CREEP_ON_RUBBER, &all)?.assembly()?)?;
    Ok([OUTER, 0].map(|body| -found.coordinates[body][2]))
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for assumption in &RATES[1].scene(&[])?.common().assumptions {
        context.assumption(&assumption.name, &assumption.text, "scenes/creep_on_rubber.toml");
    }
    context.assumption("three_rates", "The two rates beside the scene's own.", "0.1 and 2 s");
    let long = format!("end = \"{LONG} s\"");
    let courses = [(0, END), (1, long.as_str()), (2, END)].map(|(rate, end)| {
        RATES[rate].scene(&[(END, end)]).and_then(|scene| QuasiStaticSequence::of(&scene))
    });
    let [fast, middle, slow] = courses;
    let courses = [fast?, middle?, slow?];
    let [outer, inner] = relaxed(&[])?;
    equilibrium(context, &courses[1], outer, inner)?;
    let all = creep(context, &courses, outer)?;
    together(context, &courses, outer);
    fixed(context, &courses)?;
    shares(context)?;
    figure(context, &courses, &all, outer)
}

/// What the courses go to: the relaxed equilibrium of the same scene.
fn equilibrium(
    context: &mut CaseContext,
    long: &QuasiStaticSequence,
    outer: f64,
    inner: f64,
) -> Result<(), CaseError> {
    let at_rest = stiffness(1.0)(Complex::new(0.0, 0.0)).re;
    let [finer, _] = relaxed(&[FINER])?;
    context.check(
        Check::new("relaxed", "outer race under 250 N, relaxed, on a finer mesh", "m", finer)
            .independent(LOAD / at_rest, "load over the stiffness of axisymmetric polynomials")
            .relative(0.005, "the bushing's mesh of 20 x 6 x 5 cells; 0.2 % found"),
    );
    context.check(
        Check::new("relaxed_mesh", "the same on the scene's mesh", "m", outer)
            .converged(finer, "a mesh of 20 x 6 x 5 cells")
            .relative(0.005, "what cells of a quarter of the wall leave; 0.4 % found"),
    );
    let bearing = TABLE_3_5.bearing(TABLE_3_5.stiffness(fitted), 0.0);
    let zero = Known::Value(0.0);
    let alone = bearing
        .solve(&[zero, Known::Load(0.0), Known::Load(-LOAD), zero, zero], None)
        .coordinates[2];
    context.check(
        Check::new("bearing", "inner below outer race under 250 N, relaxed", "m", inner - outer)
            .independent(-alone, "independent solver of the bearing with a fixed outer race")
            .relative(1e-6, "two solutions of the same equations"),
    );
    let last = long.outer.len() - 1;
    context.check(
        Check::new("creeps_to", "outer race 75 s after the load began", "m", long.outer[last])
            .consistency(outer, "course in time against relaxed equilibrium of the same scene")
            .relative(SAME, "after 75 s 0.4 % of the displacement is left to creep"),
    );
    let crept = (
        long.inner[last] - long.outer[last],
        long.inner[long.row(1.0)] - long.outer[long.row(1.0)],
    );
    context.check(
        Check::new(
            "bearing_creeps",
            "inner below outer race after 75 s over that after 1 s",
            "1",
            crept.0 / crept.1,
        )
        .closed_form(1.0, "steel does not creep")
        .absolute(1e-3, "accuracy of the run"),
    );
    Ok(())
}

/// Times at which courses meet the oracle, s.
fn sampled(duration: f64) -> Vec<f64> {
    let mut times = vec![0.5 * duration, duration];
    times.extend([0.2, 1.0, 4.0, 10.0].map(|after| duration + after));
    times.push(30.0);
    times
}

/// Each course by the oracle; and its points.
fn creep(
    context: &mut CaseContext,
    courses: &[QuasiStaticSequence; 3],
    outer: f64,
) -> Result<Vec<Vec<[f64; 2]>>, CaseError> {
    let on = OnBushing { mass: 0.0, stiffness: stiffness(1.0) };
    let mut all = Vec::new();
    for (rate, course) in RATES.iter().zip(courses) {
        let exact: Vec<[f64; 2]> = sampled(rate.duration)
            .into_iter()
            .map(|t| [t, on.after_ramp(LOAD, rate.duration, t, CREEPING)])
            .collect();
        let apart = largest(exact.iter().map(|[t, u]| (course.outer_at(*t) - u).abs() / u));
        context.check(
            Check::new(
                &format!("creep_{}", rate.id),
                &format!(
                    "largest difference of the outer race's displacement, {}, over it",
                    rate.text
                ),
                "1",
                apart,
            )
            .independent(0.0, "Laplace transform on axisymmetric polynomials, inverted")
            .absolute(
                0.01,
                "0.6 % of the bushing's mesh, of which two checks hold 0.5 % each; its springs and steps add nothing to that",
            ),
        );
        all.push(exact);
    }
    let first: Vec<f64> =
        RATES.iter().zip(courses).map(|(rate, course)| course.outer_at(rate.duration)).collect();
    let sentence = "before creep, the faster the load the smaller the deformation";
    for (id, text, ratio) in [
        ("slower_0p5", "as the load is reached: 0.5 s over 0.1 s", first[1] / first[0]),
        ("slower_2", "as the load is reached: 2 s over 0.5 s", first[2] / first[1]),
    ] {
        context.check(
            Check::new(id, text, "1", ratio)
                .stated(1.0, "2.4.3", sentence)
                .at_least(0.05, "an order, and a difference that a figure shows"),
        );
    }
    let row = |((rate, course), exact): ((&Rate, &QuasiStaticSequence), &Vec<[f64; 2]>)| {
        let mut row = vec![rate.text.to_string()];
        for t in [rate.duration, rate.duration + 1.0, 30.0] {
            row.push(format!("{:.2}", 100.0 * course.outer_at(t) / outer));
        }
        row.push(format!("{:.2}", 100.0 * exact[exact.len() - 1][1] * at_rest(&on) / LOAD));
        row
    };
    context.table(
        "rates",
        "Outer race, per cent of the relaxed equilibrium",
        &["load", "as it is reached", "1 s later", "after 30 s", "after 30 s, Laplace"],
        RATES.iter().zip(courses).zip(&all).map(row).collect(),
    );
    Ok(all)
}

fn at_rest<K: Fn(Complex<f64>) -> Complex<f64>>(on: &OnBushing<K>) -> f64 {
    (on.stiffness)(Complex::new(0.0, 0.0)).re
}

/// When the three displacements have come together.
fn together(context: &mut CaseContext, courses: &[QuasiStaticSequence; 3], outer: f64) {
    let rows = courses.iter().map(|course| course.times.len()).min().unwrap_or(0);
    let apart = |row: usize| {
        let here = courses.each_ref().map(|course| course.outer[row]);
        largest(here.iter().flat_map(|a| here.iter().map(move |b| (a - b).abs()))) / here[0]
    };
    let loud = (1..rows).rev().find(|row| {
        let same = apart(*row) <= SAME;
        !same
    });
    let time = loud.map_or(f64::NAN, |row| courses[0].times[row]);
    context.check(
        Check::new(
            "together",
            "time from which on displacements under the three rates are within 0.5 %",
            "s",
            time,
        )
        .published("together")
        .under("three_rates")
        .at_most(0.0, "the source states a limit"),
    );
    context.check(
        Check::new(
            "apart_30",
            "differences between the three at 30 s, over the displacement",
            "1",
            apart(rows - 1),
        )
        .stated(0.0, "2.4.3", "after 30 s the displacements converged to the same level")
        .absolute(SAME, "not seen in a figure"),
    );
    let long = &courses[1];
    let last = long.times.len() - 1;
    let left = [long.row(30.0), last].map(|row| 1.0 - long.outer[row] / outer);
    let slow = (long.times[last] - 30.0) / (left[0] / left[1]).ln();
    context.finding(
        "left",
        format!(
            "At 30 s the three agree with one another, and still lack {:.1} % of the relaxed equilibrium, {:.2} % at {LONG} s. What is left falls by e within \
             {slow:.1} s: creep under a constant load is slower than the relaxation of its slowest element, 10 s.",
            100.0 * left[0],
            100.0 * left[1]
        ),
    );
}

/// What does not relax knows no rate: the same scene with its outer race fixed.
fn fixed(context: &mut CaseContext, courses: &[QuasiStaticSequence; 3]) -> Result<(), CaseError> {
    let cut = CREEP_ON_RUBBER
        .find("[spring.mount]")
        .zip(CREEP_ON_RUBBER.find("[traction]"))
        .ok_or_else(|| CaseError::message("no bushing in the scene"))?;
    let text = CREEP_ON_RUBBER.replace(&CREEP_ON_RUBBER[cut.0..cut.1], "");
    let mut reached = Vec::new();
    for rate in &RATES {
        let duration = format!("duration = \"{} s\"", rate.duration);
        let end = format!("end = \"{} s\"", rate.duration + 0.05);
        let changes = [
            (SHIPPED, duration.as_str()),
            (END, end.as_str()),
            ("motion = \"5-dof\"\nspeed = \"0 rpm\"", "motion = \"fixed\""),
        ];
        let columns = ran(&changed_scene(&text, &changes)?, &["time", "inner_z"])?;
        reached.push(-columns[1][columns[1].len() - 1]);
    }
    let spread = |values: &[f64]| {
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        (largest - least) / largest
    };
    let words = "in an elastic material load and deflection do not depend on the rate";
    let after: Vec<f64> = RATES
        .iter()
        .zip(courses)
        .map(|(rate, course)| course.inner[course.row(rate.duration + 0.05)])
        .collect();
    context.check(
        Check::new(
            "fixed",
            "inner race as the load is reached, outer race fixed: differences between rates",
            "1",
            spread(&reached),
        )
        .stated(0.0, "2.4.3", words)
        .absolute(SAME, "not seen in a figure; 0.05 s later ringing of the kink is left"),
    );
    context.check(
        Check::new("fixed_swapped", "the same in rubber", "1", spread(&after))
            .stated(0.0, "2.4.3", words)
            .at_least(0.1, "twenty times the limit: what relaxes must not pass"),
    );
    Ok(())
}

/// Less viscous stress: a sudden load is followed sooner, and rings; rates matter less.
fn shares(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    let (mut early, mut rings, mut rates) = (Vec::new(), Vec::new(), Vec::new());
    let mut curves = Vec::new();
    for share in SHARES {
        let rubber = format!("table = \"2.3\"\n{}", diluted(0.01 * f64::from(share)));
        let swap = ("table = \"2.3\"", rubber.as_str());
        let sudden = format!("duration = \"{} ms\"", 1e3 * SUDDEN);
        let end = format!("end = \"{SUDDEN_END} s\"");
        let scene = changed_scene(
            CREEP_ON_RUBBER,
            &[
                swap,
                (SHIPPED, sudden.as_str()),
                (END, end.as_str()),
                ("output_interval = \"50 ms\"", "output_interval = \"0.1 ms\""),
            ],
        )?;
        let course = QuasiStaticSequence::of(&scene)?;
        let [whole, _] = relaxed(&[swap])?;
        let balls = 8.0 * 4.0 / 3.0 * std::f64::consts::PI * TABLE_3_5.ball_radius.powi(3) * 7850.0;
        let assembly = scene.assembly()?;
        let races = [0, OUTER]
            .map(|body| assembly.bodies[body].driven().map_or(f64::NAN, |race| race.inertia.mass));
        let on = OnBushing {
            mass: balls + races[0] + races[1],
            stiffness: stiffness(0.01 * f64::from(share)),
        };
        let exact: Vec<[f64; 2]> = [1.0, 2.0, 4.0, 7.0, 10.0, 16.0]
            .map(|ms| 1e-3 * ms)
            .into_iter()
            .map(|t| [t, on.after_ramp(LOAD, SUDDEN, t, SWINGING)])
            .collect();
        let apart = largest(exact.iter().map(|[t, u]| (course.outer_at(*t) - u).abs() / whole));
        context.check(
            Check::new(
                &format!("sudden_{share}"),
                &format!("250 N in 1 ms, {share} % of the viscous stress: largest difference of the outer race in 16 ms, over its relaxed place"),
                "1",
                apart,
            )
            .independent(0.0, "one mass of all parts on axisymmetric polynomials, by its Laplace transform")
            .absolute(0.02, "the bearing between the masses gives by a few thousandths, the bushing has its mesh and springs; weak damping adds phase over six swings"),
        );
        // How far it swings back from the farthest it has been.
        let mut farthest = 0.0f64;
        let mut back = 0.0f64;
        for u in &course.outer {
            farthest = farthest.max(*u);
            back = back.max(farthest - u);
        }
        let reached: Vec<f64> = [&RATES[0], &RATES[2]]
            .into_iter()
            .map(|rate| {
                let end = format!("end = \"{} s\"", rate.duration);
                let course = QuasiStaticSequence::of(&rate.scene(&[swap, (END, end.as_str())])?)?;
                Ok(course.outer_at(rate.duration))
            })
            .collect::<Result<_, CaseError>>()?;
        early.push(course.outer_at(0.05) / whole);
        rings.push(back / whole);
        rates.push(1.0 - reached[0] / reached[1]);
        rows.push(vec![
            format!("{share}"),
            format!("{:.1}", 100.0 * course.outer_at(0.05) / whole),
            format!("{:.2}", 100.0 * back / whole),
            format!("{:.1}", 100.0 * (1.0 - reached[0] / reached[1])),
        ]);
        let points = course.times.iter().zip(&course.outer).take_while(|(t, _)| **t <= 0.05);
        curves.push(Curve::new(
            format!("{share} %"),
            points.map(|(t, u)| [1e3 * t, 1e6 * u]).collect(),
        ));
    }
    context.table(
        "shares",
        "Parts of the viscous stress: 250 N in 1 ms, and two rates, per cent of the relaxed displacement",
        &["part, %", "50 ms after it began", "swings back by", "0.1 s short of 2 s as the load is reached, %"],
        rows,
    );
    let delays = "higher viscoelasticity delays the deformation upon a sudden load";
    let rate = "with 10 % the hyperelastic response overshadows the viscoelastic one";
    let vibrates = "less viscous stress: vibration after a rapidly applied load increases";
    for (k, pair) in SHARES.windows(2).enumerate() {
        let (less, more) = (pair[0], pair[1]);
        for (id, text, ratio, words) in [
            ("delay", "displacement after 50 ms", early[k] / early[k + 1], delays),
            ("vibration", "swing back", rings[k] / rings[k + 1], vibrates),
            ("rates", "effect of the rate, inverted", rates[k + 1] / rates[k], rate),
        ] {
            context.check(
                Check::new(
                    &format!("{id}_{less}"),
                    &format!("{text}, {less} % over {more} %"),
                    "1",
                    ratio,
                )
                .stated(1.0, "2.4.3", words)
                .at_least(0.0, "an order"),
            );
        }
    }
    let svg = xy(&XyPlot {
        title: "Outer race under 250 N within 1 ms".into(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("displacement along -Z", "um"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("shares_of_viscous_stress", svg, "As Fig. 2.27: parts of the viscous stress.");
    Ok(())
}

fn figure(
    context: &mut CaseContext,
    courses: &[QuasiStaticSequence; 3],
    exact: &[Vec<[f64; 2]>],
    outer: f64,
) -> Result<(), CaseError> {
    let mut curves = Vec::new();
    for (rate, course) in RATES.iter().zip(courses) {
        let points = course.times.iter().zip(&course.outer).take_while(|(t, _)| **t <= 30.0);
        curves.push(Curve::new(rate.text, points.step_by(2).map(|(t, u)| [*t, 1e6 * u]).collect()));
    }
    curves.push(Curve::new("relaxed", vec![[0.0, 1e6 * outer], [30.0, 1e6 * outer]]));
    let svg = xy(&XyPlot {
        title: "Outer race in a rubber bushing".into(),
        x: Axis::linear("time", "s"),
        y: Axis::linear("displacement along -Z", "um"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("creep", svg, "As Fig. 2.23: three rates of load, creep, and where it ends.");
    let points = exact[1].iter().map(|[t, u]| [*t, 1e6 * u]).collect();
    let svg = xy(&XyPlot {
        title: "250 N in 0.5 s, by its Laplace transform".into(),
        x: Axis::linear("time", "s"),
        y: Axis::linear("displacement along -Z", "um"),
        style: Style::LinesAndMarkers,
        curves: vec![Curve::new("oracle", points)],
    })?;
    context.figure("oracle", svg, "Where the course of 0.5 s meets the oracle.");
    Ok(())
}
