//! Friction in the bore: a race that is pressed down and pushed along, and the rotor whose bending pushes its races apart.

use std::f64::consts::TAU;

use bearing_dynamics::output::series::Series;
use bearing_dynamics::output::session::Parts;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housed_shaft::Shaft;
use crate::motion::{RACE_IN_ROUGH_BORE, ROTOR_IN_PILLOW_BLOCKS, column, done};
use crate::oracles::bore_friction::Bore;
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "bore_friction_4_2_4_2",
    title: "Friction between outer race and bore: stick, slip, loops, and the axial force of tilted races",
    section: "4.2.4.2",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

/// Of that scene: N, N/m of each node, m.
const LOAD: f64 = 200.0;
const NODE_STIFFNESS: f64 = 1e7;
const COEFFICIENT: f64 = 0.6;
const STRETCH: f64 = 2e-6;
const MASS: f64 = 0.2;
const PUSH: &str =
    "x = { load = { smooth_ramp = [\"0 N\", \"80 N\"], start = \"2 ms\", duration = \"3 ms\" } }";
const PUSHED: f64 = 80.0;

type Change<'c> = (&'c str, &'c str);

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "friction_springs",
        "The source attaches \"a large penalty\" to the springs of friction and prints no number: a spring slips from a given stretch on, and is never stiffer \
         than the contact along its normal, so that steps need not be shorter.",
        "0.1 nm; 2 µm where it is to be seen",
    );
    pressed(context)?;
    rotor(context)
}

/// Columns of a run of the pressed race, and where its bore's nodes are.
fn of_pressed(changes: &[Change]) -> Result<(Series, Bore), CaseError> {
    let scene = Shaft::new(RACE_IN_ROUGH_BORE, changes)?;
    let nodes = &scene.housings[0].setup.nodes;
    let azimuth = |[_, y, z]: [f64; 3]| z.atan2(y);
    let bore = Bore {
        azimuths: nodes.iter().map(|node| azimuth(node.place)).collect(),
        stiffness: NODE_STIFFNESS,
        coefficient: COEFFICIENT,
        stretch: STRETCH,
    };
    let session = done(Parts::Housed(Box::new(scene.undeformed(1)?)), &scene.request()?)?;
    Ok((session.series()?, bore))
}

/// The row nearest to a time, s.
fn row_at(times: &[f64], time: f64) -> usize {
    let after = times.partition_point(|t| *t < time - 1e-9);
    after.min(times.len() - 1)
}

const GIVES_WAY: &str = "compliance of the bore, 2e-4 of its contact, and small oscillations";

fn pressed(context: &mut CaseContext) -> Result<(), CaseError> {
    // Below what holds it.
    let (series, bore) = of_pressed(&[])?;
    let sink = bore.sinks(LOAD, true);
    let along = column(&series, "outer_x")?;
    let friction = column(&series, "friction_force_on_outer_x")?;
    let times = column(&series, "time")?;
    let last = times.len() - 1;
    context.check(
        Check::new(
            "sinks",
            "how far the race sinks, its springs dragging",
            "µm",
            -1e6 * column(&series, "outer_z")?[last],
        )
        .independent(1e6 * sink, "bisection on the sum over nodes")
        .relative(1e-3, GIVES_WAY),
    );
    context.check(
        Check::new(
            "stick",
            "displacement of a race under 80 N, all nodes sticking",
            "µm",
            1e6 * along[last],
        )
        .independent(1e6 * PUSHED / bore.stick_stiffness(sink), "Σ μ N over the stretch of slip")
        .relative(1e-3, GIVES_WAY)
        .golden(GoldenTolerance::REORDERED),
    );
    let stiffness = (row_at(&times, 3e-3)..=last).map(|row| -friction[row] / along[row]);
    let off = largest(stiffness.map(|k| (k / bore.stick_stiffness(sink) - 1.0).abs()));
    context.check(
        Check::new("stick_all_along", "friction over way against the sum, at worst", "1", off)
            .independent(0.0, "Σ μ N over the stretch of slip")
            .absolute(1e-3, GIVES_WAY),
    );
    context.check(
        Check::new(
            "no_heat",
            "heat of a race that sticks",
            "J",
            largest(column(&series, "heat_friction")?),
        )
        .closed_form(0.0, "nothing slips")
        .absolute(0.0, "not one node slips"),
    );

    // Above it.
    let harder = PUSH.replace("80 N", "160 N");
    let (series, _) = of_pressed(&[(PUSH, &harder), ("end = \"6 ms\"", "end = \"7 ms\"")])?;
    let sink = bore.sinks(LOAD, false);
    let (times, speeds) = (column(&series, "time")?, column(&series, "outer_velocity_x")?);
    let [from, to] = [5.5e-3, 7e-3].map(|time| row_at(&times, time));
    let gained = (speeds[to] - speeds[from]) / (times[to] - times[from]);
    context.check(
        Check::new("slide", "acceleration of a race under 160 N", "m/s²", gained)
            .independent(
                (160.0 - bore.slip_force(sink)) / MASS,
                "force less friction, over the mass",
            )
            .relative(1e-2, "the difference of 160 N and 152 N, each to 2e-4"),
    );

    // To and fro by ±10 µm.
    let way = "x = { displacement = { mean = \"-10 um\", amplitude = \"10 um\", frequency = \"250 Hz\", phase = \"90 deg\" } }";
    let (series, _) = of_pressed(&[(PUSH, way), ("end = \"6 ms\"", "end = \"12 ms\"")])?;
    let (times, heat) = (column(&series, "time")?, column(&series, "heat_friction")?);
    let friction = column(&series, "friction_force_on_outer_x")?;
    let [from, to] = [8e-3, 12e-3].map(|time| row_at(&times, time));
    context.check(
        Check::new("slip", "friction on a sliding race", "N", friction[row_at(&times, 9e-3)].abs())
            .independent(bore.slip_force(sink), "μ Σ N")
            .relative(1e-3, GIVES_WAY),
    );
    context.check(
        Check::new("heat", "heat of a cycle of ±10 µm", "mJ", 1e3 * (heat[to] - heat[from]))
            .independent(1e3 * bore.loop_area(sink, 10e-6), "4 μ Σ N (A − s)")
            .relative(1e-3, GIVES_WAY)
            .golden(GoldenTolerance::REORDERED),
    );
    let residual = largest(column(&series, "energy_coupled_residual")?.into_iter().map(f64::abs));
    context.check(
        Check::new("balance", "energy unaccounted for, over the heat", "1", residual / heat[to])
            .closed_form(0.0, "stored, dissipated and transferred energy add up")
            .absolute(1e-4, "windows and steps are of second order"),
    );
    Ok(())
}

/// Rings around both bearings in explicit steps, from the equilibrium of all; races free but for their bores.
const ROTOR: [Change; 6] = [
    ("motion = \"5-dof\"", "motion = \"6-dof\""),
    (
        "method = \"reduced\"",
        "method = \"explicit\"\nstart = \"equilibrium\"\nfriction = { law = \"stick-slip\" }",
    ),
    ("fit = { radial = \"2.5 um\" }              # interference", "fit = { radial = \"0 um\" }"),
    ("generate = \"housing-c\"", "generate = \"housing-d\""),
    (
        "cells = { around = 16, radial = 1, axial = 1,",
        "cells = { around = 32, radial = 1, axial = 2,",
    ),
    ("order = 2", "order = 1"),
];
const FRICTION: &str = "\nfriction = { law = \"stick-slip\" }";

/// What balls and friction do to a race along its axis in the second half of a run, N, and how far it has gone, µm.
struct Held {
    by_balls: [f64; 2],
    by_friction: f64,
    way: f64,
    slipping: f64,
    /// J, and m.
    heat: f64,
    farthest: f64,
}

fn of_rotor(changes: &[Change]) -> Result<Held, CaseError> {
    let scene = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &[&ROTOR[..], changes].concat())?;
    let session = done(Parts::Housed(Box::new(scene.explicit(1)?)), &scene.request()?)?;
    let series = session.series()?;
    let mean = |name: &str| -> Result<f64, CaseError> {
        let values = column(&series, name)?;
        let half = &values[values.len() / 2..];
        Ok(half.iter().sum::<f64>() / half.len() as f64)
    };
    let rough = series.column("left_friction_force_on_outer_x").is_some();
    let or_none = |name: &str| if rough { mean(name) } else { Ok(0.0) };
    Ok(Held {
        by_balls: [mean("left_contact_force_on_outer_x")?, mean("right_contact_force_on_outer_x")?],
        by_friction: or_none("left_friction_force_on_outer_x")?,
        way: 1e6 * mean("left_outer_x")?,
        slipping: or_none("left_bore_nodes_slipping")?,
        heat: series.column("left_heat_friction").map_or(0.0, |heat| largest(heat.iter().copied())),
        farthest: largest(column(&series, "left_outer_x")?.into_iter().map(f64::abs)),
    })
}

fn rotor(context: &mut CaseContext) -> Result<(), CaseError> {
    let held = of_rotor(&[("motion = \"6-dof\"", "motion = \"5-dof\""), (FRICTION, "")])?;
    let rough = of_rotor(&[])?;
    let smoother =
        of_rotor(&[("law = \"stick-slip\"", "law = \"stick-slip\", coefficient = 0.1")])?;
    let rows = [("held beside the bore", &held), ("0.6", &rough), ("0.1", &smoother)];
    let cells = |(name, of): (&str, &Held)| {
        let mut row = vec![name.to_string()];
        row.extend(of.by_balls.map(|force| format!("{force:.1}")));
        row.extend([of.by_friction, of.way, of.slipping].map(|value| format!("{value:.2}")));
        row
    };
    context.table(
        "axial_force",
        "Axial force of the tilted races, means over the second millisecond",
        &[
            "coefficient",
            "balls on race 1 (N)",
            "balls on race 2 (N)",
            "friction on race 1 (N)",
            "race 1 along X (µm)",
            "nodes of bore 1 slipping",
        ],
        rows.into_iter().map(cells).collect(),
    );
    for (n, (ours, reference)) in rough.by_balls.into_iter().zip(held.by_balls).enumerate() {
        context.check(
            Check::new(&format!("held_{}", n + 1), "axial force of the tilted race, held by friction", "N", ours)
                .consistency(reference, "the same race held along its axis")
                .relative(0.005, "races move apart by 0.3 µm until friction balances them; balls lose 2 N a micrometre")
                .under("friction_springs")
.golden(GoldenTolerance::MIXED),
        );
    }
    context.check(
        Check::new(
            "friction_holds",
            "friction on the race over the force of the balls",
            "1",
            rough.by_friction / -rough.by_balls[0],
        )
        .closed_form(1.0, "the race stays")
        .absolute(0.03, "the released race oscillates on its springs at 36 kHz; a mean value"),
    );
    // Half of the shaft's load, carried by normal loads that sum up to 4/π of it.
    let slips_at = 0.1 * 1500.0 * 2.0 / (TAU / 4.0);
    context.check(
        Check::new(
            "slides",
            "friction heat over displacement of a race that slides in a smoother bore",
            "N",
            smoother.heat / smoother.farthest,
        )
        .closed_form(slips_at, "μ Σ N of a pressure proportional to the cosine")
        .relative(
            0.05,
            "compliance of the bore changes its pressure, and the loads oscillate with the shaft",
        )
        .under("friction_springs"),
    );
    context.check(
        Check::new(
            "rests",
            "axial force of the race where it came to rest there",
            "N",
            -smoother.by_balls[0],
        )
        .closed_form(slips_at, "μ Σ N of a pressure proportional to the cosine")
        .at_most(0.0, "it slides past where friction could hold it, and stays there"),
    );
    Ok(())
}
