//! The system of 4.3 at rest and at 1000 rpm: a shaft that bends on two bearings in two pillow blocks.

use bearing_dynamics::equilibrium::lists::Place;
use bearing_dynamics::equilibrium::warm_started_search::WarmStartedSearch;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::output::series::Series;
use bearing_dynamics::solids::condensation::CondensedBore;

use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housed_shaft::Shaft;
use crate::housings::assumptions;
use crate::motion::{ROTOR_IN_PILLOW_BLOCKS, changed_scene, column, done};
use crate::solids::largest;
use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};

pub const CASE: Case = Case {
    id: "rotor_in_housings_4_3",
    title: "Flexible rotor on two bearings in two pillow blocks",
    section: "4.3.1-4.3.3, Table 4.3",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

type Change<'c> = (&'c str, &'c str);

/// Bearing 2 moved inwards by 100 mm, the load at the shaft's end, bending stiffness × 1.05 as for the column of fixed
/// races, the shear modulus as stated.
const OVERHUNG: [Change; 3] = [
    ("inner_at = \"200 mm\"", "inner_at = \"100 mm\""),
    ("load = [{ at = \"0 mm\"", "load = [{ at = \"200 mm\""),
    (
        "[body.shaft.beam]\n",
        "[body.shaft.beam]\nyoungs_modulus = \"220.5 GPa\"\npoisson_ratio = 0.365\n",
    ),
];
const FINER: Change = (
    "cells = { around = 16, radial = 1, axial = 1,",
    "cells = { around = 32, radial = 3, axial = 3,",
);
const FIT: &str = "fit = { radial = \"2.5 um\" }              # interference";
const LOAD: &str = "z = \"-3000 N\"";
/// Name of the column, the source's clearance (µm), and the fit taken for it.
const COLUMNS: [(&str, f64, &str); 3] = [
    ("tight", -5.0, "fit = { radial = \"2.5 um\" }"),
    ("even", 0.0, "fit = { radial = \"0 um\" }"),
    ("loose", 5.0, "fit = { radial = \"-2.5 um\" }"),
];

/// What Table 4.3 prints of one bearing, and how far its outer race went along Z.
#[derive(Clone, Copy, Default)]
struct Row {
    /// x, z, µm.
    displacement: [f64; 2],
    /// °.
    tilt: f64,
    /// On the inner race along x, z, N.
    force: [f64; 2],
    /// Its magnitude, N·m.
    moment: f64,
    /// µm.
    outer: f64,
}

fn rows(changes: &[Change]) -> Result<[Row; 2], CaseError> {
    let shaft = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, changes)?;
    let bores = shaft.bores()?;
    let (still, found) = shaft.statics(&bores)?;
    let assembly = shaft.scene.assembly()?;
    let mut rows = [Row::default(); 2];
    for (index, row) in rows.iter_mut().enumerate() {
        let section = still.bearings[index].mounts[0].body;
        let Place::Section(place) = &still.bodies[section].place else {
            return Err(CaseError::message("no section under the inner race"));
        };
        let straight = assembly.bodies[assembly.shafts[0].body].rest[0] + place.section.along;
        let at = &found.coordinates[section];
        let state = &found.bearings[index];
        let outer = &found.coordinates[still.bearings[index].mounts[1].body];
        *row = Row {
            displacement: [1e6 * (at[0] - straight), 1e6 * at[2]],
            tilt: at[3].to_degrees(),
            force: [state.forces[0].x, state.forces[0].z],
            moment: state.moments[0].y.abs(),
            outer: 1e6 * outer[2],
        };
    }
    Ok(rows)
}

/// A column of the table: displacements count from where a press fit alone has the races.
fn table_column(fit: &str, load: &str) -> Result<[Row; 2], CaseError> {
    let of = |load: &str| {
        let own: [Change; 3] = [(FIT, fit), (LOAD, load), FINER];
        rows(&[&OVERHUNG[..], &own[..]].concat())
    };
    let mut found = of(load)?;
    if fit == COLUMNS[0].2 {
        let unloaded = of("z = \"-1 N\"")?;
        for (row, before) in found.iter_mut().zip(unloaded) {
            row.displacement[1] -= before.displacement[1];
            row.outer -= before.outer;
        }
    }
    Ok(found)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    context.assumption(
        "mesh_stiffness_4_3",
        "The source's rotor bends less than the stated shaft, as coarse linear tetrahedra do. The factor is that of Table 4.3's column of fixed races.",
        "EI × 1.05, κGA as stated",
    );
    context.assumption(
        "diametral_housing_clearance",
        "Whether the housing's clearance is radial or diametral is not stated: half of +5 µm agrees, all of it would raise race 1 by 19 µm.",
        "half of it on each side",
    );
    context.assumption(
        "from_the_fit",
        "A press fit lifts a race in a block that is held at its foot; the table's displacements are taken to count from there.",
        "displacements since the fit",
    );
    table_4_3(context)?;
    axial_give(context)?;
    seats(context)?;
    compliance(context)
}

fn table_4_3(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut table = Vec::new();
    let mut all = Vec::new();
    for (name, clearance, fit) in COLUMNS {
        let found = table_column(fit, LOAD)?;
        for (index, row) in found.iter().enumerate() {
            let n = index + 1;
            let of = format!("bearing {n}, housing clearance {clearance:+.0} µm");
            let [x, z] = row.displacement;
            let [fx, fz] = row.force;
            for (key, what, unit, ours, tolerance, assumption, reason) in [
                (
                    "x",
                    "displacement along X",
                    "µm",
                    x,
                    0.03,
                    "mesh_stiffness_4_3",
                    "the stiffness is one factor for all columns; bores hold races along X here",
                ),
                (
                    "z",
                    "displacement along Z",
                    "µm",
                    z,
                    0.04,
                    "diametral_housing_clearance",
                    "blocks of the generator's sizes in place of lost ones",
                ),
                (
                    "fz",
                    "vertical force",
                    "N",
                    fz,
                    6e-3,
                    "mesh_stiffness_4_3",
                    "levers of the races, whose moments differ by 5 %, over 300 mm",
                ),
                (
                    "tilt",
                    "tilt",
                    "°",
                    row.tilt,
                    0.015,
                    "mesh_stiffness_4_3",
                    "as printed to a thousandth of a degree, and the stiffness",
                ),
                (
                    "m",
                    "moment",
                    "N·m",
                    row.moment,
                    0.06,
                    "housing_dimensions",
                    "blocks of the generator's sizes in place of lost ones",
                ),
            ] {
                let id = format!("{key}_{n}_{name}");
                let check = Check::new(&id, &format!("{what} of {of}"), unit, ours)
                    .published(&id)
                    .under(assumption)
                    .relative(tolerance, reason)
                    .golden(GoldenTolerance::MIXED);
                let read = match name {
                    "loose" => Some(
                        "half of the clearance on each side was chosen because these numbers follow from it",
                    ),
                    "tight" => Some(
                        "that displacements count from the fit was chosen because these numbers follow from it",
                    ),
                    _ => None,
                };
                context.check(match read {
                    Some(read) if key == "z" => check.fit(read),
                    _ => check,
                });
            }
            let id = format!("fx_{n}_{name}");
            let at = COLUMNS.iter().position(|of| of.0 == name).unwrap_or(0);
            // Larger in magnitude, either way round.
            let excess = fx.signum() * [0.0703, 0.1274, 0.1984][at];
            context.check(
                Check::new(&id, &format!("axial force of {of}"), "N", fx)
                    .published(&id)
                    .under("housing_dimensions")
                    .relative(0.06, "as of the other numbers")
                    .explained(Explanation::new(
                        "In the source friction fixes the outer races along X on compliant blocks, the less the larger the clearance; here they are axially fixed. An axially compliant outer race reduces the force; the source does not state its compliance.",
                        excess,
                        0.01,
                        &["axial_give"],
                    )),
            );
            table.push(vec![
                format!("{clearance:+.0}"),
                n.to_string(),
                format!("{x:.2}"),
                format!("{z:.2}"),
                format!("{fx:.1}"),
                format!("{fz:.1}"),
                format!("{:.4}", row.tilt),
                format!("{:.3}", row.moment),
                format!("{:.2}", row.outer),
            ]);
        }
        all.push(found);
    }
    let columns = [
        "clearance, µm",
        "bearing",
        "x, µm",
        "z, µm",
        "Fx, N",
        "Fz, N",
        "tilt, °",
        "M, N·m",
        "outer race z, µm",
    ];
    context.table("table_4_3", "Inner races under the overhung load", &columns, table);
    for index in 0..2 {
        let z = [0, 1, 2].map(|column: usize| all[column][index].displacement[1].abs());
        context.check(
            Check::new(
                &format!("softer_{}", index + 1),
                &format!("least growth of bearing {}'s displacement along Z from one column to the next", index + 1),
                "µm",
                (z[1] - z[0]).min(z[2] - z[1]),
            )
            .stated(0.0, "4.3.3", "from a fixed to a clearance fit the support stiffness reduces and the displacement increases")
            .at_least(0.1, "ten times the mesh error"),
        );
    }
    // The top carries bearing 1, the foot bearing 2; under a load upwards it is the other way round.
    let give = |rows: &[Row; 2]| {
        let per = |row: &Row| row.outer.abs() / row.force[1].abs();
        per(&rows[0]) / per(&rows[1])
    };
    let up = table_column(COLUMNS[1].2, "z = \"3000 N\"")?;
    for (id, rows, what) in
        [("top_gives", &all[1], "downwards"), ("top_gives_swapped", &up, "upwards")]
    {
        let ratio = if id == "top_gives" { give(rows) } else { 1.0 / give(rows) };
        context.check(
            Check::new(id, &format!("give of the housing whose top carries over that of the one whose foot does, load {what}"), "1", ratio)
                .stated(1.0, "4.3.3", "the top of the block is far more flexible than the bottom: much larger deformation at bearing 1")
                .at_least(2.0, "the block's shape decides how far above one"),
        );
    }
    Ok(())
}

/// Fixed races but for a spring along X: the axial force falls as they give.
fn axial_give(context: &mut CaseContext) -> Result<(), CaseError> {
    let start = ROTOR_IN_PILLOW_BLOCKS.find("[housing]").unwrap_or(0);
    let end = ROTOR_IN_PILLOW_BLOCKS.find("[traction]").unwrap_or(0);
    let housings = &ROTOR_IN_PILLOW_BLOCKS[start..end];
    let force = |stiffness: &str| -> Result<f64, CaseError> {
        let foundation = format!(
            "motion = \"5-dof\"\nfoundation = {{ stiffness = {{ x = \"{stiffness}\", y = \"1e12 N/m\", z = \"1e12 N/m\", tilt_y = \"1e9 N m/rad\", tilt_z = \"1e9 N m/rad\" }} }}\n"
        );
        let own: [Change; 2] = [(housings, ""), ("motion = \"5-dof\"\n", &foundation)];
        let scene = changed_scene(ROTOR_IN_PILLOW_BLOCKS, &[&OVERHUNG[..], &own[..]].concat())?;
        let found = solve_assembly(&scene.statics()?, None, &StaticOptions::default())?;
        Ok(found.bearings[1].forces[0].x)
    };
    let [firm, soft] = [force("1e12 N/m")?, force("1e7 N/m")?];
    context.check(
        Check::new(
            "axial_give",
            "axial force on race 1 with outer races on 10 N/µm along X, over that with fixed ones",
            "1",
            soft / firm,
        )
        .stated(
            1.0,
            "4.3.3",
            "the outer race follows the inner one better, and the axial force decreases",
        )
        .at_most(0.02, "far above rounding")
        .golden(GoldenTolerance::MIXED),
    );
    Ok(())
}

/// 4.3.2: load at mid-span, three fits of the housings: how much of the bore carries, how stiff it is sideways, and how far
/// race 1 goes sideways as balls pass.
fn seats(context: &mut CaseContext) -> Result<(), CaseError> {
    let (mut table, mut all) = (Vec::new(), Vec::new());
    for (_, clearance, fit) in COLUMNS {
        let changes: [Change; 2] = [(FIT, fit), FINER];
        let shaft = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &changes)?;
        let bores = shaft.bores()?;
        let (_, found) = shaft.statics(&bores)?;
        let state = &found.seats[0];
        let areas = bores[0].nodes.iter().zip(&state.loads);
        let (whole, carries) = areas.fold((0.0, 0.0), |(whole, carries), (node, load)| {
            (whole + node.area, carries + if *load > 0.0 { node.area } else { 0.0 })
        });
        let passing: [Change; 4] = [
            (FIT, fit),
            ("method = \"reduced\"", "method = \"quasi-static\""),
            ("end = \"2 ms\"", "end = \"20 ms\""),
            ("output_interval = \"20 us\"", "output_interval = \"0.5 ms\""),
        ];
        let shaft = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &passing)?;
        let bores = shaft.bores()?;
        let settled = done(shaft.quasi_static(&bores)?, &shaft.request()?)?.series()?;
        let y = column(&settled, "left_inner_y")?;
        let swing = swing(&y);
        let of = [
            carries / whole,
            1e-6 * state.stiffness[(0, 0)],
            1e-6 * state.stiffness[(1, 1)],
            1e9 * swing,
        ];
        let digits = [3, 1, 1, 1].iter().zip(of).map(|(digits, value)| format!("{value:.digits$}"));
        table.push([format!("{clearance:+.0}")].into_iter().chain(digits).collect());
        all.push(of);
    }
    let columns = [
        "clearance, µm",
        "part of the bore that carries",
        "stiffness along Y, N/µm",
        "along Z, N/µm",
        "swing of race 1 along Y, nm",
    ];
    context.table("seats", "Seat 1 under 3000 N at mid-span, from equilibria", &columns, table);
    for (id, i, what, sentence, most) in [
        (
            "seat_shrinks",
            0,
            "part of the bore that carries",
            "a clearance fit is a less conformal contact: a small area carries",
            0.8,
        ),
        (
            "seat_softens",
            1,
            "stiffness of the seat along Y",
            "the support's stiffness along Y is significantly reduced",
            0.5,
        ),
    ] {
        let fall = largest(all.windows(2).map(|pair| pair[1][i] / pair[0][i]));
        context.check(
            Check::new(
                &format!("{id}_each"),
                &format!("{what}, largest ratio to that with 5 µm less clearance"),
                "1",
                fall,
            )
            .stated(1.0, "4.3.2", sentence)
            .at_most(0.05, "far above the tolerance of the search"),
        );
        context.check(
            Check::new(
                id,
                &format!("{what} with +5 µm over that with −5 µm"),
                "1",
                all[2][i] / all[0][i],
            )
            .stated(1.0, "4.3.2", sentence)
            .at_most(most, "a small part; of a stiffness no more than half of it is left")
            .golden(GoldenTolerance::MIXED),
        );
    }
    context.finding(
        "sideways",
        format!(
            "As balls pass, race 1 moves sideways by {:.0}, {:.0} and {:.0} nm through equilibria with −5, 0 and +5 µm: the soft seat alone adds {:.1} %. The text's \
             instability along Y would be one of the motion.",
            all[0][3],
            all[1][3],
            all[2][3],
            100.0 * (all[2][3] / all[0][3] - 1.0)
        ),
    );
    Ok(())
}

/// From the least to the largest.
fn swing(of: &[f64]) -> f64 {
    let [least, most] = of.iter().fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)]);
    most - least
}

/// y and z of race 1 and of the middle, m.
type Way = [Vec<f64>; 4];
const OF_WAY: [&str; 4] = ["left_inner_y", "left_inner_z", "shaft_mid_y", "shaft_mid_z"];

/// The same in equilibria with each ball where a motion has it, from a row on.
fn at_the_same_angles(
    shaft: &Shaft,
    bores: &[CondensedBore],
    moved: &Series,
    first: usize,
) -> Result<Way, CaseError> {
    let course = shaft.course(bores)?;
    let mut angles = Vec::new();
    for (bearing, name) in course.assembly.bearings.iter().zip(["left", "right"]) {
        let of = |ball| column(moved, &format!("{name}_ball_{ball}_angle"));
        angles.push((1..=bearing.geometry.ball_count).map(of).collect::<Result<Vec<_>, _>>()?);
    }
    let shafts = &course.assembly.shafts;
    let (_, mid) = shafts[0].probes.first().ok_or_else(|| CaseError::message("no section"))?;
    let mut search = WarmStartedSearch::of(&course.seats);
    let mut way = Way::default();
    for (row, time) in column(moved, "time")?.into_iter().enumerate().skip(first) {
        let mut still = course.at(time);
        for (bearing, angles) in still.bearings.iter_mut().zip(&angles) {
            bearing.azimuths = angles.iter().map(|of| of[row].to_radians()).collect();
        }
        let found = search.solve(&still)?;
        let [_, y, z, ..] = course.race(&found, 0, 0);
        let section = course.section(&found, 0, mid, &Mount::at_centre(shafts[0].body));
        let [_, mid_y, mid_z] = section.state.position;
        let at = [y, z, mid_y, mid_z];
        way.iter_mut().zip(at).for_each(|(to, at)| to.push(at));
    }
    Ok(way)
}

/// How far a motion is from equilibria over one passing of a ball, m.
struct Apart {
    /// On the average.
    shift: f64,
    /// From there at most.
    about: f64,
    /// From the least to the largest of the equilibria, and of the motion.
    swing: f64,
    moved: f64,
}

/// What the swing that friction makes as it begins has died away by, at 50 1/s: e⁻⁵ of 20 nm are 0.1 nm.
const SETTLED: &str = "end = \"120 ms\"";
/// Rows of 0.5 ms, one passing of a ball at 1000 rpm.
const PASS: usize = 39;

fn apart(
    clearance: i32,
    changes: &[Change],
) -> Result<(Shaft, Vec<CondensedBore>, [Apart; 4]), CaseError> {
    let clearance = format!("clearance = {{ radial = \"{clearance} um\" }}");
    let own: [Change; 3] = [
        ("clearance = { radial = \"0 um\" }", &clearance),
        ("end = \"2 ms\"", SETTLED),
        ("output_interval = \"20 us\"", "output_interval = \"0.5 ms\""),
    ];
    let shaft = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &[&own[..], changes].concat())?;
    let moved = done(shaft.reduced()?, &shaft.request()?)?.series()?;
    let bores = shaft.bores()?;
    let first = column(&moved, "time")?.len() - PASS;
    let still = at_the_same_angles(&shaft, &bores, &moved, first)?;
    let mut all = Vec::new();
    for (name, still) in OF_WAY.into_iter().zip(still) {
        let moved = column(&moved, name)?;
        let apart: Vec<f64> = moved[first..].iter().zip(&still).map(|(a, b)| a - b).collect();
        let shift = apart.iter().sum::<f64>() / PASS as f64;
        let about = largest(apart.iter().map(|apart| (apart - shift).abs()));
        all.push(Apart { shift, about, swing: swing(&still), moved: swing(&moved[first..]) });
    }
    let all = <[Apart; 4]>::try_from(all).map_err(|_| CaseError::message("four ways"))?;
    Ok((shaft, bores, all))
}

/// Varying compliance of 4.3.1 and 4.3.2, with preload so that balls keep their places without a cage: in shapes, as the dynamics has it, and through equilibria with each ball at the same
/// angle. Rolling friction, which the dynamics needs to keep balls on their orbits and equilibria know nothing of, shifts all of it.
fn compliance(context: &mut CaseContext) -> Result<(), CaseError> {
    let rolling: Change = ("[traction]\nlaw = \"none\"\n", "");
    let mut lateral = Vec::new();
    for clearance in [-5, -10, -15] {
        let (shaft, bores, found) = apart(clearance, &[rolling])?;
        for (name, Apart { about, swing, .. }) in OF_WAY.into_iter().zip(&found) {
            let (most, reason) = match name {
                "shaft_mid_y" => (
                    3e-8,
                    "1 % of the largest shift by friction, whose moments are not quite steady; half of the motion by passing balls",
                ),
                "shaft_mid_z" => (
                    1.5e-8,
                    "less than half of the motion by passing balls, so that no motion would fail",
                ),
                _ => (1e-9, "a nanometre"),
            };
            let what = format!(
                "{name} in motion about its shift by friction, difference from equilibria at the same ball angles, whose peak-to-peak motion is {:.1} nm, {clearance} µm",
                1e9 * swing
            );
            context.check(
                Check::new(&format!("{name}_{}", -clearance), &what, "m", *about)
                    .consistency(0.0, "equilibria with each ball where the motion has it")
                    .absolute(most, reason),
            );
        }
        let [Apart { moved, .. }, ..] = &found;
        lateral.push(*moved);
        let [y, z, mid_y, mid_z] = found.map(|of| 1e9 * of.shift);
        context.finding(
            &format!("friction_{}", -clearance),
            format!("rolling friction shifts race 1 by {y:.1} nm along Y and {z:.1} nm along Z, the shaft's middle by {mid_y:.0} nm along Y and {mid_z:.0} nm along Z, {clearance} µm"),
        );
        if clearance == -10 {
            // Its curve at half its height.
            let half = "[traction]\nb = 11.14\nc = 181.46\nd = 0.05\n";
            let (.., halved) = apart(clearance, &[("[traction]\nlaw = \"none\"\n", half)])?;
            let [.., half_y, half_z] = halved;
            // In the mirror the shaft turns the other way round, and so does what friction does: along Y it is odd in its size, along Z even.
            for (axis, ratio, expected, most, reason) in [
                ("y", 1e9 * half_y.shift / mid_y, 0.5, 0.02, "terms of third order"),
                (
                    "z",
                    1e9 * half_z.shift / mid_z,
                    0.25,
                    0.04,
                    "terms of fourth order, and 10 nm that are not due to friction",
                ),
            ] {
                context.check(
                    Check::new(
                        &format!("shift_by_friction_{axis}"),
                        &format!("shift of the shaft's middle along {} with half of the friction over that with all of it, −10 µm", axis.to_uppercase()),
                        "1",
                        ratio,
                    )
                    .consistency(expected, "of the mirror's symmetry: of first order along Y, of second along Z")
                    .absolute(most, reason),
                );
            }
        }
        if clearance == -10 {
            let (_, found) = shaft.statics(&bores)?;
            let balls = found.bearings.iter().flat_map(|bearing| &bearing.balls);
            let least = balls.fold(f64::INFINITY, |least, ball| least.min(ball.inner.normal_load));
            context.check(
                Check::new(
                    "all_loaded",
                    "least load of any ball in the equilibrium at the start, −10 µm",
                    "N",
                    least,
                )
                .stated(0.0, "4.3.1", "with interference all balls are in contact")
                .at_least(10.0, "far above rounding error of an unloaded ball"),
            );
        }
    }
    let ratios = lateral.windows(2).map(|pair| pair[1] / pair[0]);
    context.check(
        Check::new(
            "lateral_falls",
            "largest ratio of the lateral peak-to-peak motion to that with 5 µm less interference",
            "1",
            largest(ratios),
        )
        .stated(1.0, "4.3.1", "the varying compliance falls with the clearance")
        .at_most(0.1, "a tenth"),
    );
    Ok(())
}
