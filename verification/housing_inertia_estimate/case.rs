//! What inertia changes in housing C under a turning load, by explicit steps, against the estimate
//! made of equilibria.

use std::f64::consts::TAU;

use bearing_dynamics::ch2_housing::bearing::geometry::Material;
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solver::housing::course_inertia::{
    CourseInertia, CourseLooks, SeatLooks, course_inertia,
};
use bearing_dynamics::solver::housing::housed::{OUTER, lists, moving};
use bearing_dynamics::solver::housing::reduce::lowest_shapes;
use bearing_dynamics::solver::statics::{Condition, StaticProblem};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housing_turn::{Turning, equilibria, explicit, outer_place};
use crate::housings::{self, BORE_RADIUS, WIDTH, assumptions};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "housing_inertia_estimate",
    title: "What leaving out inertia changes in housing C, against explicit steps",
    section: "2.2.4, 2.4.2",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// s a turn.
const TURNS: [f64; 3] = [4e-3, 8e-3, 16e-3];
/// Coarse, so that explicit steps take seconds.
const CELLS: [usize; 3] = [24, 2, 2];
/// Places at which both are compared, and looks of the estimate, in a turn.
const POINTS: usize = 720;
/// Natural shapes of the housing that the estimate knows.
const NATURAL: usize = 4;
/// m, with which no node of the bore lets go.
const TIGHT: f64 = 1e-6;
/// 1/s, in the housing: ringing lasts for about a millisecond.
const DAMPING: f64 = 2000.0;

/// One turn both ways.
struct Found {
    turn: f64,
    estimate: CourseInertia,
    /// Distance of the outer race's places over time, s and m.
    apart: Vec<[f64; 2]>,
    residual: f64,
}

impl Found {
    fn measured(&self) -> f64 {
        largest(self.apart.iter().map(|[_, distance]| *distance))
    }

    /// Over what is expected.
    fn ratio(&self) -> f64 {
        self.measured() / self.estimate.expected()
    }
}

struct Variant {
    turn: f64,
    interference: f64,
    damping: f64,
    /// Whether the load turns at its full speed from the outset.
    sudden: bool,
}

impl Variant {
    const fn smooth(turn: f64) -> Variant {
        Variant { turn, interference: 0.0, damping: 0.0, sudden: false }
    }
}

fn find(mesh: &TetMesh, variant: &Variant) -> Result<Found, CaseError> {
    let speed = TAU / variant.turn;
    let mut turning = if variant.sudden { Turning::steady(speed) } else { Turning::new(speed) };
    turning.interference = variant.interference;
    let end = turning.times[turning.times.len() - 1];
    turning.times = (0..=POINTS).map(|i| end * i as f64 / POINTS as f64).collect();
    turning.places = Vec::new();
    let mut model = housings::solid(mesh)?;
    let bore = housings::condensed(mesh, &model)?;
    let (natural, _) = lowest_shapes(&model, &bore, NATURAL)?;
    let looks = CourseLooks {
        start: 0.0,
        end,
        count: POINTS,
        corners: Vec::new(),
        bodies: moving(
            [
                hollow_cylinder(15e-3, 22e-3, 12e-3, Material::STEEL.density),
                hollow_cylinder(31.953e-3, BORE_RADIUS, WIDTH, Material::STEEL.density),
            ],
            [false, true, true, true, true],
        ),
        seats: vec![SeatLooks { race: OUTER, natural, damping: variant.damping }],
    };
    let mut search = housings::search(&bore);
    let (bearing, fit) = (housings::bearing()?, housings::fit(turning.interference));
    let found = course_inertia(&looks, &mut search.search, |search, time| {
        let [_, y, z] = turning.load.force(time);
        let conditions = [0.0, y, z, 0.0, 0.0].map(Condition::Load);
        let problem = StaticProblem { conditions, ..bearing.clone() };
        search.solve(&lists(&problem, &bore, Penalty::default(), &fit, [0.0; 3]))
    });
    let estimate = found?[OUTER];
    let moments = equilibria(&mut search, &turning, &turning.times, |_, _| {})?;
    let start = &moments[0].state;
    let displacement = bore.displacement(&start.bore.loads);
    model.problem.damping = variant.damping;
    let run = explicit(mesh, model, start, displacement, &turning)?;
    let apart = moments
        .iter()
        .zip(&run.outer)
        .map(|(moment, [y, z])| {
            let [v, w] = outer_place(&moment.state);
            [moment.time, (y - v).hypot(z - w)]
        })
        .collect();
    Ok(Found { turn: variant.turn, estimate, apart, residual: run.residual })
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    context.assumption(
        "race_masses",
        "No table states the races' masses; rings of steel, 15–22 mm and 12 mm wide (inner), 31.953–35.527 mm and 20 mm wide (outer).",
        "0.077 kg and 0.119 kg",
    );
    let mesh = housings::mesh('C', Order::Linear, CELLS)?;
    let mut smooth = Vec::new();
    for turn in TURNS {
        smooth.push(find(&mesh, &Variant::smooth(turn))?);
    }
    let sudden = find(&mesh, &Variant { sudden: true, ..Variant::smooth(TURNS[1]) })?;
    let damped = find(&mesh, &Variant { damping: DAMPING, ..Variant::smooth(TURNS[1]) })?;
    let tight = [2.5e-3, 5e-3]
        .map(|turn| find(&mesh, &Variant { interference: TIGHT, ..Variant::smooth(turn) }));
    let [fast, slow] = tight;
    let (fast, slow) = (fast?, slow?);
    kinked(context, &smooth);
    started(context, &sudden);
    bounded(context, "damped", "8 ms, damped", &damped);
    let ratio = damped.ratio();
    about(context, "damped", "8 ms, damped", ratio);
    tight_fit(context, &fast, &slow);
    let named: Vec<(&str, &Found)> = ["transition", "transition", "transition"]
        .into_iter()
        .zip(&smooth)
        .chain([
            ("transition, turning at once", &sudden),
            ("transition, damped", &damped),
            ("1 µm interference", &fast),
            ("1 µm interference", &slow),
        ])
        .collect();
    table(context, &named);
    context.check(
        Check::new(
            "ledger",
            "energy unaccounted for in the explicit runs, of all turned over",
            "1",
            largest(named.iter().map(|(_, found)| found.residual)),
        )
        .closed_form(0.0, "balance of energy")
        .absolute(5e-7, "of second order in the window: 7e-8 in the worst of the runs"),
    );
    figure(context, &smooth, &sudden, &slow)
}

fn bounded(context: &mut CaseContext, id: &str, what: &str, found: &Found) {
    context.check(
        Check::new(
            &format!("{id}_bound"),
            &format!("{what}: largest distance from the course of equilibria"),
            "nm",
            1e9 * found.measured(),
        )
        .consistency(
            1e9 * found.estimate.bound,
            "explicit steps against our own estimate: twice the acceleration's part and all ringings in step",
        )
        .at_most(0.0, "nothing that the theory knows goes farther")
        .golden(GoldenTolerance { relative: 1e-3, absolute: 0.0 }),
    );
    context.golden(
        &format!("{id}_expected"),
        1e9 * found.estimate.expected(),
        "nm",
        GoldenTolerance { relative: 1e-4, absolute: 0.0 },
    );
}

const RAYLEIGH: &str =
    "explicit steps against our own estimate, a sum of many ringings, Rayleigh distributed";

/// Of the size that is foretold, as far as random phases allow.
fn about(context: &mut CaseContext, id: &str, what: &str, ratio: f64) {
    let name = format!("{what}: largest distance over what is expected");
    context.check(
        Check::new(&format!("{id}_not_below"), &name, "1", ratio)
            .consistency(0.25, RAYLEIGH)
            .at_least(0.0, "6 % lie below a quarter of the root mean square; an estimate that is ten times too large fails"),
    );
    context.check(
        Check::new(&format!("{id}_not_above"), &name, "1", ratio)
            .consistency(2.0, RAYLEIGH)
            .at_most(0.0, "2 % lie above twice the root mean square"),
    );
}

fn power(fast: &Found, slow: &Found, of: impl Fn(&Found) -> f64) -> f64 {
    (of(fast) / of(slow)).ln() / (slow.turn / fast.turn).ln()
}

fn kinked(context: &mut CaseContext, smooth: &[Found]) {
    for found in smooth {
        let what = format!("{:.0} ms a turn", 1e3 * found.turn);
        let id = format!("turn_{:.0}ms", 1e3 * found.turn);
        bounded(context, &id, &what, found);
        about(context, &id, &what, found.ratio());
    }
    let ends = (&smooth[0], &smooth[smooth.len() - 1]);
    for (id, what, ours) in [
        ("power", "distance in explicit steps", power(ends.0, ends.1, Found::measured)),
        ("power_estimate", "what is expected", power(ends.0, ends.1, |f| f.estimate.expected())),
    ] {
        context.check(
            Check::new(id, &format!("{what}: power of the speed, 4 against 16 ms"), "1", ours)
                .closed_form(1.0, "Δv/ω of each kink: first power of the speed")
                .absolute(
                    0.4,
                    "phases and a slow part of the second power; without kinks it were 2, and a factor of 1.7 between the ends is left",
                ),
        );
    }
}

fn started(context: &mut CaseContext, sudden: &Found) {
    // Before the first large kinks, under a load from 0 to 45 degrees.
    let early = sudden.apart.iter().filter(|[time, _]| *time <= sudden.turn / 8.0);
    let early = largest(early.map(|[_, distance]| *distance));
    let start = sudden.estimate.start;
    bounded(context, "sudden", "8 ms, turning at once", sudden);
    context.check(
        Check::new("start", "turning at once: largest distance in the first 45°", "nm", 1e9 * early)
            .consistency(1e9 * start, "explicit steps against our own estimate: velocity of the course over ω of the natural motions")
            .relative(0.4, "all motions at their largest at once (above), first kinks and the acceleration's part (below)"),
    );
    context.check(
        Check::new(
            "start_over_smooth",
            "the start's part over what is expected of a smooth one of the same speed",
            "1",
            start / sudden.estimate.ringing,
        )
        .consistency(0.3, "two parts of our own estimate")
        .at_least(0.0, "else the check before would see kinks alone"),
    );
}

fn tight_fit(context: &mut CaseContext, fast: &Found, slow: &Found) {
    for found in [fast, slow] {
        let what = format!("1 µm interference, {:.1} ms a turn", 1e3 * found.turn);
        let id = format!("tight_{:.0}us", 1e6 * found.turn);
        bounded(context, &id, &what, found);
        about(context, &id, &what, found.ratio());
        context.work(&format!("kinks_{id}"), found.estimate.kinks as u64);
    }
    for (id, what, ours) in [
        ("tight_power", "distance in explicit steps", power(fast, slow, Found::measured)),
        ("tight_power_estimate", "what is expected", power(fast, slow, |f| f.estimate.expected())),
    ] {
        context.check(
            Check::new(id, &format!("1 µm interference, {what}: power of the speed"), "1", ours)
                .closed_form(2.0, "(f/f_n)², no node lets go: second power of the speed")
                .absolute(
                    0.4,
                    "the run-up of half a natural period rings a little; 1 were the kinks' power",
                ),
        );
    }
}

fn table(context: &mut CaseContext, all: &[(&str, &Found)]) {
    let nanometres = |length: f64| format!("{:.2}", 1e9 * length);
    let rows = all
        .iter()
        .map(|(fit, found)| {
            let e = &found.estimate;
            vec![
                fit.to_string(),
                format!("{:.1}", 1e3 * found.turn),
                nanometres(e.steady),
                nanometres(e.start),
                format!("{} / {}", e.kinks, nanometres(e.largest_kink)),
                nanometres(e.expected()),
                nanometres(e.bound),
                nanometres(found.measured()),
            ]
        })
        .collect();
    context.table(
        "parts",
        "What inertia changes of the outer race's place, nm: the estimate's parts, and the largest distance of explicit steps from equilibria",
        &[
            "fit",
            "ms a turn",
            "acceleration",
            "start at rest",
            "kinks: number / largest",
            "expected",
            "at most",
            "explicit steps",
        ],
        rows,
    );
    context.finding(
        "cause",
        "The distance goes with the first power of the speed because the course has a kink at each node of the bore that enters or leaves \
         contact: the velocity jumps, and what it jumps by rings on. With all nodes in contact the second power is left.",
    );
}

fn figure(
    context: &mut CaseContext,
    smooth: &[Found],
    sudden: &Found,
    tight: &Found,
) -> Result<(), CaseError> {
    let curve = |name: String, found: &Found| {
        let end = found.apart[found.apart.len() - 1][0];
        let points = found.apart.iter().map(|[time, apart]| [time / end, 1e9 * apart]).collect();
        Curve::new(name, points)
    };
    let mut curves: Vec<Curve> = smooth
        .iter()
        .map(|found| curve(format!("{:.0} ms a turn", 1e3 * found.turn), found))
        .collect();
    curves.push(curve("8 ms, turning at once".into(), sudden));
    curves.push(curve("5 ms, 1 µm interference".into(), tight));
    let plot = XyPlot {
        title: "Explicit steps from equilibria, housing C".into(),
        x: Axis::linear("part of the run", "1"),
        y: Axis::linear("distance of the outer race", "nm"),
        style: Style::Lines,
        curves,
    };
    context.figure(
        "apart",
        xy(&plot)?,
        "Distance of the outer race in explicit steps from its equilibria. It grows where the load passes the top and the bottom \
         of the housing, where nodes let go and come back while the race swings across; with all nodes in contact it does not.",
    );
    Ok(())
}
