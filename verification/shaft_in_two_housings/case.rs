//! A rigid shaft on two bearings in two housings, by equilibria, in shapes and in explicit steps.

use std::f64::consts::TAU;
use std::time::Instant;

use bearing_dynamics::equilibrium::quasi_static_limit::lowest_frequency;
use bearing_dynamics::equilibrium::warm_started_search::WarmStartedSearch;
use bearing_dynamics::members::state::VELOCITY;
use bearing_dynamics::motion::simulation::Simulation;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::session::{Motion, Parts, Session};
use bearing_dynamics::reduction::component_modes::lowest_modes;
use bearing_dynamics::reduction::fixed_interface_modes::vibrating_housing;
use bearing_dynamics::solids::condensation::CondensedBore;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::housed_shaft::Shaft;
use crate::housings::{SHAFT_IN_TWO_HOUSINGS, assumptions};
use crate::motion::{column, done};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "shaft_in_two_housings",
    title: "A shaft on two bearings in two housings: equilibria, modes and explicit steps",
    section: "2.2.4, 4.2",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const BLOW: &str = "z = { load = { half_sine = \"-2000 N\", base = \"-300 N\", start = \"0.2 ms\", duration = \"0.5 ms\" } }";
/// N, and s for the one period.
const MEAN: f64 = -800.0;
const AMPLITUDE: f64 = -500.0;
const PERIOD: f64 = 12e-3;
const SLOW: &str = "z = { load = { mean = \"-800 N\", amplitude = \"-500 N\", frequency = \"83.33333333333333 Hz\", phase = \"-90 deg\" } }";
const TRACTION: (&str, &str) = ("[traction]\nlaw = \"none\"\n", "");
/// Loads on the way, N.
const LOADS: [f64; 4] = [-300.0, -520.0, -1100.0, -700.0];
/// What is compared: the shaft, and the races in their housings.
const PLACES: [&str; 3] = ["shaft_z", "left_outer_z", "right_outer_z"];

/// One way through the slow blow.
struct Way {
    /// m, of each of [`PLACES`].
    places: Vec<Vec<f64>>,
    times: Vec<f64>,
    seconds: f64,
}

impl Way {
    fn new(session: &Session, start: Instant) -> Result<Way, CaseError> {
        let seconds = start.elapsed().as_secs_f64();
        let series = session.series()?;
        let places = PLACES.iter().map(|name| column(&series, name));
        let places = places.collect::<Result<_, _>>()?;
        Ok(Way { places, times: column(&series, "time")?, seconds })
    }

    fn swing(&self, place: usize) -> f64 {
        let of = &self.places[place];
        largest(of.iter().copied()) - of.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Largest distance from another way over the swing.
    fn off(&self, other: &Way, place: usize) -> f64 {
        let pairs = self.places[place].iter().zip(&other.places[place]);
        largest(pairs.map(|(a, b)| (a - b).abs())) / self.swing(place)
    }
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    context.assumption(
        "shaft",
        "The source has no rigid shaft in two housings: bearings of Table 4.1 160 mm apart, a shaft of 1.39 kg.",
        "scenes/shaft_in_two_housings.toml",
    );
    statics(context)?;
    blow(context)
}

/// A course under a load that takes four values, against statics of each.
fn statics(context: &mut CaseContext) -> Result<(), CaseError> {
    let table: Vec<String> = LOADS
        .iter()
        .enumerate()
        .map(|(row, load)| format!("[\"{row} ms\", \"{load} N\"]"))
        .collect();
    let table = format!("z = {{ load = {{ table = [{}] }} }}", table.join(", "));
    let slow = [
        (BLOW, table.as_str()),
        ("speed = \"1000 rpm\"\n", ""),
        ("method = \"reduced\"", "method = \"quasi-static\""),
        ("end = \"2 ms\"", "end = \"3 ms\""),
        ("output_interval = \"5 us\"", "output_interval = \"1 ms\""),
    ];
    let shaft = Shaft::new(SHAFT_IN_TWO_HOUSINGS, &slow)?;
    let bores = shaft.bores()?;
    let session = done(shaft.quasi_static(&bores)?, &shaft.request()?)?;
    let series = session.series()?;
    let mut apart = 0.0f64;
    for (row, load) in LOADS.iter().enumerate() {
        let constant = format!("z = {{ load = \"{load} N\" }}");
        let still = Shaft::new(
            SHAFT_IN_TWO_HOUSINGS,
            &[&[(BLOW, constant.as_str())], &slow[1..]].concat(),
        )?;
        let course = still.course(&bores)?;
        let mut lists = still.scene.statics()?;
        course.seats.iter().for_each(|seat| seat.add_to(&mut lists, 0.0));
        let found = WarmStartedSearch::of(&course.seats).solve(&lists)?;
        let bodies = &course.assembly.bodies;
        for name in PLACES {
            let body = match name {
                "shaft_z" => bodies.iter().position(|body| body.label.is_some()).unwrap_or(0),
                "left_outer_z" => course.seats[0].body(&course.assembly),
                _ => course.seats[1].body(&course.assembly),
            };
            let (at, here) = (found.coordinates[body][2], column(&series, name)?[row]);
            apart = largest([apart, ((here - at) / at).abs()]);
        }
    }
    context.check(
        Check::new(
            "course_statics",
            "places of shaft and races in a course, off those of statics",
            "1",
            apart,
        )
        .consistency(0.0, "one equilibrium after the other against each found cold")
        .absolute(1e-9, "both end at 1e-11 of the load"),
    );
    Ok(())
}

fn blow(context: &mut CaseContext) -> Result<(), CaseError> {
    let with = |method: &'static str| {
        [
            (BLOW, SLOW),
            TRACTION,
            ("method = \"reduced\"", method),
            ("end = \"2 ms\"", "end = \"12 ms\""),
            ("output_interval = \"5 us\"", "output_interval = \"50 us\""),
        ]
    };
    let shaft = Shaft::new(SHAFT_IN_TWO_HOUSINGS, &with("method = \"quasi-static\""))?;
    let bores = shaft.bores()?;
    let start = Instant::now();
    let session = done(shaft.quasi_static(&bores)?, &shaft.request()?)?;
    let course = Way::new(&session, start)?;
    let expected = frequency_ratio_squared(&shaft, &bores)?;

    let shaft = Shaft::new(SHAFT_IN_TWO_HOUSINGS, &with("method = \"reduced\""))?;
    let start = Instant::now();
    let shapes = Way::new(&done(shaft.reduced()?, &shaft.request()?)?, start)?;

    let shaft =
        Shaft::new(SHAFT_IN_TWO_HOUSINGS, &with("method = \"explicit\"\nstart = \"equilibrium\""))?;
    let start = Instant::now();
    let parts = Parts::Housed(Box::new(shaft.explicit(1)?));
    let before = momentum_at_start(&shaft)?;
    let session = done(parts, &shaft.request()?)?;
    let steps = Way::new(&session, start)?;

    for (place, name) in PLACES.iter().enumerate() {
        let part = course.off(&shapes, place) / expected;
        let what = format!(
            "{name}: distance of equilibria from the reduced run over its oscillation, over (f/f_n)²"
        );
        let source = "largest acceleration of the blow over ω² of the lowest natural frequency";
        context.check(
            Check::new(&format!("{name}_inertia"), &what, "1", part)
                .consistency(1.5, source)
                .at_most(0.0, "half of it again rings from the corner of the acceleration"),
        );
        context.check(
            Check::new(&format!("{name}_inertia_seen"), &what, "1", part)
                .consistency(0.25, source)
                .at_least(0.0, "other motions are faster than the lowest, some by less than twice"),
        );
        for (id, other, way) in [("shapes", &shapes, "shapes"), ("course", &course, "equilibria")] {
            context.check(
                Check::new(
                    &format!("{name}_{id}"),
                    &format!("{name}: {way} off explicit steps, over the oscillation"),
                    "1",
                    steps.off(other, place),
                )
                .independent(0.0, "explicit steps of every element")
                .absolute(5e-3, "half a per cent of the oscillation"),
            );
        }
    }
    momentum(context, &session, before)?;
    threads(context, &with("method = \"explicit\"\nstart = \"equilibrium\""))?;
    let rows = [("equilibria", &course), ("shapes", &shapes), ("explicit steps", &steps)];
    let rows = rows.map(|(name, way)| {
        let mut row = vec![name.to_string(), format!("{:.1}", way.seconds)];
        row.extend((0..PLACES.len()).map(|place| format!("{:.2e}", way.off(&steps, place))));
        row
    });
    context.table(
        "cost",
        "A pulse of 12 ms: wall time, and the largest distance from explicit steps over the peak-to-peak motion",
        &["way", "s", PLACES[0], PLACES[1], PLACES[2]],
        rows.to_vec(),
    );
    let curve = |name: &str, way: &Way| {
        let apart = way.places[0].iter().zip(&steps.places[0]).map(|(a, b)| 1e9 * (a - b));
        Curve::new(
            name,
            way.times.iter().map(|t| 1e3 * t).zip(apart).map(|(t, x)| [t, x]).collect(),
        )
    };
    let plot = XyPlot {
        title: "Shaft in two housings: off explicit steps".into(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("place of the shaft", "nm"),
        style: Style::Lines,
        curves: vec![curve("equilibria", &course), curve("shapes", &shapes)],
    };
    context.figure("apart", xy(&plot)?, "What equilibria and shapes leave out of the shaft's way.");
    Ok(())
}

/// (f/f_n)² of the blow's period and the lowest natural frequency, about the equilibrium under the largest load.
fn frequency_ratio_squared(shaft: &Shaft, bores: &[CondensedBore]) -> Result<f64, CaseError> {
    let course = shaft.course(bores)?;
    let mut search = WarmStartedSearch::of(&course.seats);
    let found = course.find(&mut search, 0.5 * PERIOD)?;
    let bodies = course.moving();
    let mut masses = Vec::new();
    for ((bore, seat), housing) in search.bores().iter().zip(&course.seats).zip(&shaft.housings) {
        let body = seat.body(&course.assembly);
        let race = bodies.iter().position(|of| of.body == body).unwrap_or(0);
        // As many natural modes as the command takes.
        let (natural, _) = lowest_modes(&housing.setup.model, seat.bore, 4)?;
        masses.push(vibrating_housing(bore, &housing.setup.model, race, &natural, seat.damping));
    }
    let lowest = lowest_frequency(&found.solution.with_shapes, &bodies, &masses);
    Ok((PERIOD * lowest.unwrap_or(f64::NAN)).powi(-2))
}

/// Of bodies and balls along z, N·s.
fn momentum_of(simulation: &Simulation) -> f64 {
    let system = &simulation.system;
    let bodies = system.assembly.bodies.iter().enumerate();
    let of_bodies: f64 = bodies
        .map(|(index, body)| {
            body.inertia().map_or(0.0, |own| own.mass * simulation.body(index).velocity[2])
        })
        .sum();
    let of_balls: f64 = system
        .sets
        .iter()
        .zip(&system.assembly.bearings)
        .flat_map(|(set, bearing)| {
            (0..bearing.geometry.ball_count).map(|ball| {
                bearing.ball.mass * set.layout.ball_vector(&simulation.state, VELOCITY, ball)[2]
            })
        })
        .sum();
    of_bodies + of_balls
}

fn momentum_at_start(shaft: &Shaft) -> Result<f64, CaseError> {
    let session = Session::start(Parts::Housed(Box::new(shaft.explicit(1)?)), &shaft.request()?)?;
    let simulation = session.motion.bearing().ok_or_else(|| CaseError::message("no bearing"))?;
    Ok(momentum_of(simulation))
}

fn momentum(context: &mut CaseContext, session: &Session, before: f64) -> Result<(), CaseError> {
    let Motion::Housed(housed) = &session.motion else {
        return Err(CaseError::message("no windows"));
    };
    let time = housed.time();
    let omega = TAU / PERIOD;
    // ∫ (mean + amplitude sin(ω t − 90°)) dt
    let load = MEAN * time - AMPLITUDE / omega * (omega * time).sin();
    let housings: f64 = housed.seats().map(|seat| seat.impulse[2]).sum();
    let gap = momentum_of(&housed.simulation) - before - load - housings;
    context.check(
        Check::new(
            "momentum",
            "of shaft, races and balls, beyond what load and housings gave",
            "1",
            gap.abs() / load.abs(),
        )
        .closed_form(0.0, "Newton's second and third laws")
        .absolute(
            1e-9,
            "sums of 1e5 windows round to 1e-12; the load's integral by steps of 1e-7 s",
        ),
    );
    let part = session.watch.largest_residual / session.watch.turned_over;
    context.check(
        Check::new(
            "ledger",
            "energy unaccounted for in explicit steps, of all turned over",
            "1",
            part,
        )
        .closed_form(
            0.0,
            "balance of energy, an entry for each housing, seat, contact, damping and drive",
        )
        .absolute(1e-4, "of second order in the window"),
    );
    Ok(())
}

/// Two solids on two threads.
fn threads(context: &mut CaseContext, words: &[(&str, &str)]) -> Result<(), CaseError> {
    let mut short = words.to_vec();
    short.retain(|(from, _)| !from.starts_with("end"));
    short.push(("end = \"2 ms\"", "end = \"0.3 ms\""));
    let shaft = Shaft::new(SHAFT_IN_TWO_HOUSINGS, &short)?;
    let bits = |threads: usize| -> Result<Vec<u64>, CaseError> {
        let parts = Parts::Housed(Box::new(shaft.explicit(threads)?));
        let series = done(parts, &shaft.request()?)?.series()?;
        Ok(series.data().iter().map(|value| value.to_bits()).collect())
    };
    let (one, two) = (bits(1)?, bits(2)?);
    let different =
        one.iter().zip(&two).filter(|(a, b)| a != b).count() + one.len().abs_diff(two.len());
    context.check(
        Check::new(
            "threads",
            "numbers of two threads that differ from those of one",
            "1",
            different as f64,
        )
        .closed_form(0.0, "sums in fixed order")
        .absolute(0.0, "bits"),
    );
    Ok(())
}
